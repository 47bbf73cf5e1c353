/* Surfaces: what their markers give to nodes, how they move and stretch, how they are split; that steps that
 * fail leave them alone, and that states hold them. */
#include "body.h"
#include "io/state.h"

/* ---- a block and a line around it ---------------------------------------------------------------------- */
enum { EDGES = 24, CELLS = 12 };
static const double spacing = 0.25;

/* Opens a block in the middle of a grid without walls. */
static mpm_particles *open_block_with(world *w, const world_desc *desc) {
  mpm_particles *set = world_open(w, desc);
  const double low[] = {0.9, 0.85, 0.9}, high[] = {2.1, 2.1, 2.15};
  world_fill(w, set, low, high, 2);
  return set;
}

static mpm_particles *open_block(world *w, const method *how, int32_t dim) {
  const world_desc desc = world_with(how, dim, CELLS, spacing);
  return open_block_with(w, &desc);
}

static mpm_surface_desc load_desc(void) {
  mpm_surface_desc d;
  ck_assert_int_eq(mpm_surface_desc_init(&d, sizeof d), MPM_OK);
  return d;
}

static mpm_surface *put_surface(world *w, const mpm_surface_desc *d) {
  mpm_surface *s;
  ck_ok(w, mpm_surface_create(w->context, w->grid, d, &s));
  ck_ok(w, mpm_stepper_add_surface(w->stepper, s));
  return s;
}

static void drop_surface(world *w, mpm_surface *s) {
  ck_ok(w, mpm_stepper_remove_surface(w->stepper, s));
  ck_ok(w, mpm_surface_destroy(s));
}

/* Adds the polygon of 24 corners on a circle around the middle; it crosses the faces of the block. */
static void add_circle(const world *w, mpm_surface *s, double radius, double longest) {
  double at[2 * EDGES];
  for (int32_t i = 0; i < EDGES; ++i) {
    at[i] = 1.5 + radius * cos(2.0 * PI * i / EDGES);
    at[EDGES + i] = 1.5 + radius * sin(2.0 * PI * i / EDGES);
  }
  ck_ok(w, mpm_surface_add_polyline(s, EDGES, at, 1, longest, NULL, NULL));
}

static double area_of_circle(double radius) {
  return 0.5 * EDGES * radius * radius * sin(2.0 * PI / EDGES);
}

/* Adds an octahedron around the middle. */
static void add_octahedron(const world *w, mpm_surface *s, double radius, double longest) {
  double at[18];
  int64_t corner[24];
  for (int32_t i = 0; i < 18; ++i) at[i] = 1.5;
  for (int32_t i = 0; i < 6; ++i) at[i / 2 * 6 + i] += i % 2 ? -radius : radius;
  for (int32_t f = 0; f < 8; ++f) {
    const int32_t odd = (f & 1) ^ (f >> 1 & 1) ^ (f >> 2 & 1);
    corner[3 * f] = f & 1;
    corner[3 * f + 1 + odd] = 2 + (f >> 1 & 1);
    corner[3 * f + 2 - odd] = 4 + (f >> 2 & 1);
  }
  ck_ok(w, mpm_surface_add_triangles(s, 6, at, 8, corner, longest, NULL, NULL));
}

static void add_closed(const world *w, mpm_surface *s, double radius) {
  if (w->dim == 2) add_circle(w, s, radius, 0.1);
  if (w->dim == 3) add_octahedron(w, s, radius, 0.3);
  const double ends[] = {1.5 - radius, 1.5 + radius}, areas[] = {-1.0, 1.0};
  if (w->dim == 1) ck_ok(w, mpm_surface_add(s, 2, ends, areas, NULL));
}

/* Returns a field of all markers; the caller frees it. */
static double *markers(const mpm_surface *s, const char *field, int32_t components) {
  const int64_t n = mpm_surface_count(s);
  double *out = malloc((size_t)(n * components + 1) * sizeof *out);
  ck_assert_int_eq(mpm_surface_get(s, field, MPM_F64, components, n, NULL, out), MPM_OK);
  return out;
}

/* Sums of vectors at points: force, and in 2-D and 3-D its moment about the middle. */
typedef struct resultant {
  double force[3], moment[3], scale;
} resultant;

static resultant resultant_of(int32_t dim, int64_t n, const double *x, const double *f) {
  resultant sum = {{0.0}, {0.0}, 0.0};
  for (int64_t i = 0; i < n; ++i) {
    double arm[3] = {0.0, 0.0, 0.0}, v[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < dim; ++k) {
      arm[k] = x[k * n + i] - 1.5;
      v[k] = f[k * n + i];
      sum.force[k] += v[k];
      sum.scale += fabs(v[k]);
    }
    for (int32_t k = 0; k < 3; ++k)
      sum.moment[k] += arm[(k + 1) % 3] * v[(k + 2) % 3] - arm[(k + 2) % 3] * v[(k + 1) % 3];
  }
  return sum;
}

/* What all surfaces give to the nodes, in a step that is then dropped. The block is at rest and has no
 * stress. */
static resultant on_nodes(world *w) {
  int64_t n;
  ck_ok(w, mpm_step_begin(w->stepper, 1e-4));
  double *f = fetch_nodes(w, "force", &n), *x = fetch_nodes(w, "position", &n);
  const resultant sum = resultant_of(w->dim, n, x, f);
  free(f);
  free(x);
  ck_ok(w, mpm_step_abort(w->stepper));
  return sum;
}

static int32_t is_explicit(const method *how) {
  return how->scheme != MPM_NEWMARK;
}

/* A closed surface under pressure has neither force nor moment, inside the block and across its faces. */
START_TEST(closed_under_pressure) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3 && is_explicit(how); ++dim) {
    if (dim == 1 && how->remedy) continue;
    for (int32_t out = 0; out < 2; ++out) {
      world w;
      open_block(&w, how, dim);
      mpm_surface_desc d = load_desc();
      d.pressure = 1000.0;
      mpm_surface *s = put_surface(&w, &d);
      add_closed(&w, s, out ? 0.62 : 0.3);
      const resultant sum = on_nodes(&w);
      ck_assert(sum.scale > 100.0);
      for (int32_t k = 0; k < 3; ++k) {
        ck_within(how->name, sum.force[k], 0.0, 1e-12 * sum.scale);
        ck_within(how->name, sum.moment[k], 0.0, 1e-12 * sum.scale);
      }
      drop_surface(&w, s);
      world_close(&w);
    }
  }
}
END_TEST

/* Tractions keep force and moment of their markers, also where markers see nodes without mass; and a whole
 * step gives the body their impulse. */
START_TEST(tractions_keep_force_and_moment) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3 && is_explicit(how); ++dim) {
    if (dim == 1 && how->remedy) continue;
    world w;
    open_block(&w, how, dim);
    mpm_surface_desc d = load_desc();
    for (int32_t k = 0; k < 3; ++k) d.traction[k] = 300.0 - 200.0 * k, d.dead_traction[k] = 50.0 * k;
    mpm_surface *s = put_surface(&w, &d);
    for (int32_t k = 0; k < 5; ++k) { /* on a face, and a little beyond it and before it */
      const double x[3] = {2.07 + 0.02 * k, 1.1 + 0.17 * k, 1.2}, a[3] = {0.04, 0.01, 0.02};
      ck_ok(&w, mpm_surface_add(s, 1, x, a, NULL));
    }
    const double dt = 1e-4;
    const resultant sum = on_nodes(&w);
    const double before = world_info(&w).momentum[0];
    const mpm_step_info info = world_step(&w, dt);
    double *f = markers(s, "force", dim), *area = markers(s, "reference_area", 1);
    double x[15], wanted = 0.0;
    for (int32_t k = 0; k < 5; ++k) {
      const double at[3] = {2.07 + 0.02 * k, 1.1 + 0.17 * k, 1.2};
      for (int32_t c = 0; c < dim; ++c) x[c * 5 + k] = at[c];
      wanted += (d.traction[0] + d.dead_traction[0]) * area[k];
    }
    const resultant given = resultant_of(dim, 5, x, f);
    ck_within(how->name, given.force[0], wanted, 1e-12 * given.scale);
    for (int32_t k = 0; k < 3; ++k) {
      ck_within(how->name, sum.force[k], given.force[k], 1e-12 * given.scale);
      ck_within(how->name, sum.moment[k], given.moment[k], 1e-12 * given.scale);
    }
    ck_within(how->name, info.momentum[0] - before, dt * given.force[0], 1e-11 * dt * given.scale);
    free(f);
    free(area);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* Water: pressure that grows with the depth lifts by the weight of what the surface encloses. */
typedef struct water {
  double level, weight;
  int32_t answer;
  double t, dt;
} water;

static mpm_status push_by_depth(void *user, const mpm_marker_batch *b, double *add) {
  water *of = user;
  of->t = b->t;
  of->dt = b->dt;
  for (int64_t i = 0; i < b->n; ++i) {
    double size = 0.0;
    for (int32_t k = 0; k < b->dim; ++k) size += b->area[k * b->ld + i] * b->area[k * b->ld + i];
    const double p = of->weight * (of->level - b->position[b->ld + i]) / sqrt(size);
    for (int32_t k = 0; k < b->dim; ++k) add[k * b->ld + i] -= p * b->area[k * b->ld + i];
  }
  return of->answer;
}

START_TEST(buoyancy) {
  const method *how = broad_methods[_i];
  if (!is_explicit(how)) return;
  world w;
  open_block(&w, how, 2);
  mpm_surface *s = put_surface(&w, NULL);
  water of = {3.0, 9810.0, 0, 0.0, 0.0};
  add_circle(&w, s, 0.4, 0.1);
  ck_ok(&w, mpm_surface_set_traction(s, push_by_depth, &of));
  const double lift = of.weight * area_of_circle(0.4);
  resultant sum = on_nodes(&w);
  ck_within(how->name, sum.force[1], lift, 1e-12 * sum.scale);
  ck_within(how->name, sum.force[0], 0.0, 1e-12 * sum.scale);
  ck_holds(of.t == 0.0 && of.dt == 1e-4);
  ck_ok(&w, mpm_surface_set_traction(s, NULL, NULL));
  double *x = markers(s, "position", 2);
  const int64_t n = mpm_surface_count(s);
  for (int64_t i = 0; i < n; ++i) x[i] = of.weight * (of.level - x[n + i]);
  ck_ok(&w, mpm_surface_set(s, "pressure", MPM_F64, 1, n, NULL, x)); /* the same by the markers' own */
  sum = on_nodes(&w);
  ck_within(how->name, sum.force[1], lift, 1e-12 * sum.scale);
  free(x);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* A node that hardly any particle reaches takes hardly any force: its acceleration is of the size of the
 * others'. */
START_TEST(light_nodes_take_little) {
  world w;
  const world_desc desc = world_default(2, CELLS, spacing);
  world_open(&w, &desc);
  const double edge = 1.5 * spacing - 0.02 * spacing,
               volume = 0.25 * spacing * spacing; /* a hundredth of a cell */
  for (int32_t i = 0; i < 8; ++i)
    for (int32_t k = 0; k < 8; ++k) {
      const double x[2] = {2.0 + 2.0 * spacing - edge - 0.5 * spacing * i, 1.0 + 0.5 * spacing * (k + 0.5)};
      ck_ok(&w, mpm_particles_add(w.set[0], 1, x, NULL, &volume, NULL, NULL, NULL));
    }
  mpm_surface_desc d = load_desc();
  d.pressure = 1000.0;
  mpm_surface *s = put_surface(&w, &d);
  const double at[2] = {2.0 + 2.0 * spacing - edge + 0.25 * spacing, 1.5}, area[2] = {0.1, 0.0};
  ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
  int64_t n;
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
  double *f = fetch_nodes(&w, "force", &n), *m = fetch_nodes(&w, "mass", &n), most = 0.0, least = INFINITE;
  for (int64_t i = 0; i < n; ++i) {
    if (fabs(f[i]) > 0.0 && m[i] < least) least = m[i];
    most = fmax(most, fabs(f[i]) / m[i]);
  }
  ck_within("total", sum_of(n, f), -100.0, 1e-11);
  ck_assert(least < 1e-3 * 1e3 * spacing * spacing);
  ck_between("largest acceleration", most, 0.0, 20.0 * 100.0 / (1e3 * spacing * spacing));
  free(f);
  free(m);
  ck_ok(&w, mpm_step_abort(w.stepper));
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* ---- motion -------------------------------------------------------------------------------------------- */
/* Makes a step in which the nodes get this velocity in the end. */
static mpm_step_info step_with(world *w, double dt, void (*field)(const double *x, double *v)) {
  ck_ok(w, mpm_step_begin(w->stepper, dt));
  ck_ok(w, mpm_step_grid(w->stepper));
  mpm_view x = {.struct_size = sizeof x}, v = {.struct_size = sizeof v};
  ck_ok(w, mpm_grid_map(w->stepper, 0, "position", MPM_READ, &x));
  ck_ok(w, mpm_grid_map(w->stepper, 0, "velocity", MPM_WRITE, &v));
  for (int64_t i = 0; i < x.count; ++i) {
    double at[3] = {1.5, 1.5, 1.5}, to[3]; /* there is nothing across a plane */
    for (int32_t k = 0; k < w->dim; ++k)
      at[k] = ((const double *)x.data)[k * x.component_stride + i * x.item_stride];
    field(at, to);
    for (int32_t k = 0; k < w->dim; ++k)
      ((double *)v.data)[k * v.component_stride + i * v.item_stride] = to[k];
  }
  ck_ok(w, mpm_view_release(&x));
  ck_ok(w, mpm_view_release(&v));
  mpm_step_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_step_end(w->stepper, &info));
  return info;
}

static void away(const double *x, double *v) {
  for (int32_t k = 0; k < 3; ++k) v[k] = x[k] - 1.5;
}

static const double rates[3][3] = {{0.4, -0.3, 0.1}, {0.5, -0.2, 0.3}, {-0.1, 0.2, 0.6}};
static void linear(const double *x, double *v) {
  for (int32_t k = 0; k < 3; ++k)
    v[k] = rates[k][0] * (x[0] - 1.5) + rates[k][1] * (x[1] - 1.5) + rates[k][2] * (x[2] - 1.5);
}

static int32_t moves_by_nodes(const method *how) {
  return is_explicit(how) && how->position_order != 2 && !how->projected;
}

/* Against v = x - c pressure has the power -dim p V: also across faces, where nodes are missing. */
START_TEST(power_of_pressure) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 2; dim <= 3 && moves_by_nodes(how); ++dim) {
    world w;
    open_block(&w, how, dim);
    mpm_surface_desc d = load_desc();
    d.pressure = 1000.0;
    mpm_surface *s = put_surface(&w, &d);
    add_closed(&w, s, 0.62);
    const double dt = 1e-3, volume = dim == 2 ? area_of_circle(0.62) : 4.0 / 3.0 * pow(0.62, 3.0);
    const mpm_step_info info = step_with(&w, dt, away);
    double *v = markers(s, "velocity", dim), *f = markers(s, "force", dim), power = 0.0;
    for (int64_t i = 0; i < dim * mpm_surface_count(s); ++i) power += v[i] * f[i];
    ck_within(how->name, power, -dim * 1000.0 * volume, 1e-11 * 1000.0);
    show("%s %dd: work %g of %g\n", how->name, dim, info.external_work, power * dt);
    ck_within(how->name, info.external_work, power * dt, 1e-11 * fabs(power * dt));
    free(v);
    free(f);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* In a linear field markers move and stretch with F = 1 + dt grad v, and area vectors with det F F^-T. */
START_TEST(linear_fields_are_exact) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 2; dim <= 3 && moves_by_nodes(how); ++dim) {
    world w;
    open_block(&w, how, dim);
    mpm_surface *s = put_surface(&w, NULL);
    add_closed(&w, s, 0.62);
    const int64_t n = mpm_surface_count(s);
    const double dt = 0.02;
    double *x = markers(s, "position", dim), *a = markers(s, "area", dim);
    step_with(&w, dt, linear);
    double *y = markers(s, "position", dim), *b = markers(s, "area", dim),
           *u = markers(s, "displacement", dim);
    double F[9];
    for (int32_t e = 0; e < 9; ++e) F[e] = (e % 4 ? 0.0 : 1.0);
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c) F[3 * r + c] += dt * rates[r][c];
    for (int64_t i = 0; i < n; ++i)
      for (int32_t k = 0; k < dim; ++k) {
        double back = 0.0, moved = 0.0; /* F^T a' = det F a */
        for (int32_t c = 0; c < dim; ++c) {
          back += F[3 * c + k] * b[c * n + i];
          moved += dt * rates[k][c] * (x[c * n + i] - 1.5);
        }
        ck_within(how->name, back, determinant(F) * a[k * n + i], 1e-13);
        ck_within(how->name, u[k * n + i], moved, 1e-14);
        ck_within(how->name, y[k * n + i], x[k * n + i] + moved, 1e-14);
      }
    free(x), free(a), free(y), free(b), free(u);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

static void wavy(const double *x, double *v) {
  v[0] = sin(2.0 * x[0] + 3.0 * x[1]);
  v[1] = cos(3.0 * x[0] - x[1]);
  v[2] = 0.0;
}

/* An edge is stretched as the line between two markers close to each other: Nanson's relation by
 * differences. */
START_TEST(nanson_by_differences) {
  const method *how = broad_methods[_i];
  if (!moves_by_nodes(how) || how->basis == MPM_LINEAR || how->basis == MPM_UGIMP) return; /* kinks */
  world w;
  open_block(&w, how, 2);
  mpm_surface *s = put_surface(&w, NULL);
  const double d = 1e-5, length = 0.1, angle = 0.7, e[2] = {cos(angle), sin(angle)};
  for (int32_t k = 0; k < 6; ++k) {
    const double at[2] = {1.2 + 0.113 * k, 1.3 + 0.077 * k}, area[2] = {length * e[1], -length * e[0]};
    const double pair[4] = {at[0] - d * e[0], at[0] + d * e[0], at[1] - d * e[1], at[1] + d * e[1]};
    ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
    ck_ok(&w, mpm_surface_add(s, 2, pair, NULL, NULL));
  }
  step_with(&w, 0.05, wavy);
  const int64_t n = mpm_surface_count(s);
  double *x = markers(s, "position", 2), *a = markers(s, "area", 2);
  for (int64_t i = 0; i < n; i += 3) {
    ck_within(how->name, a[i] / length, (x[n + i + 2] - x[n + i + 1]) / (2.0 * d), 1e-8);
    ck_within(how->name, -a[n + i] / length, (x[i + 2] - x[i + 1]) / (2.0 * d), 1e-8);
  }
  free(x);
  free(a);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* A body that flies as one takes its markers along, over a seam too. */
START_TEST(flight_across_a_seam) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3 && is_explicit(how); ++dim) {
    if (dim == 1 && how->remedy) continue;
    world w;
    world_desc desc = world_with(how, dim, CELLS, spacing);
    desc.grid.periodic[0] = 1;
    mpm_particles *set = open_block_with(&w, &desc);
    const double v[3] = {25.0, 0.5, -0.25}, dt = 2e-3;
    ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
    mpm_surface_desc d = load_desc();
    d.pressure = 10.0;
    mpm_surface *s = put_surface(&w, &d);
    add_closed(&w, s, 0.62);
    const int64_t n = mpm_surface_count(s);
    double *x = markers(s, "position", dim);
    const double momentum = world_info(&w).momentum[0], mass = momentum / v[0];
    enum { STEPS = 60 }; /* 3 lengths of 25 * 2e-3 * 60: one period */
    for (int32_t i = 0; i < STEPS; ++i) world_step(&w, dt);
    double *y = markers(s, "position", dim), *u = markers(s, "displacement", dim);
    ck_within(how->name, world_info(&w).momentum[0], momentum, 1e-11 * mass * v[0]);
    for (int64_t i = 0; i < n; ++i)
      for (int32_t k = 0; k < dim; ++k) {
        const double way = v[k] * dt * STEPS, turns = k ? 0.0 : 3.0;
        /* the pressure deforms the block a little */
        ck_within(how->name, u[k * n + i], way, 1e-3);
        ck_within(how->name, y[k * n + i], x[k * n + i] + u[k * n + i] - turns, 1e-12);
      }
    free(x), free(y), free(u);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* Markers of a body that falls fall as its particles do, of whatever order positions are. */
START_TEST(falls_with_its_particles) {
  const method *how = broad_methods[_i];
  world w;
  world_desc desc = world_with(how, 2, CELLS, spacing);
  desc.stepper.gravity[1] = -9.81;
  mpm_particles *set = open_block_with(&w, &desc);
  mpm_surface *s = put_surface(&w, NULL);
  add_circle(&w, s, 0.62, 0.1);
  const double from = fetch1(&w, set, "position", 2, 1, 0), dt = 4e-3;
  for (int32_t i = 0; i < 25; ++i) world_step(&w, dt);
  const double way = fetch1(&w, set, "position", 2, 1, 0) - from;
  const int64_t n = mpm_surface_count(s);
  double *u = markers(s, "displacement", 2);
  ck_assert(way < -0.04);
  for (int64_t i = 0; i < n; ++i) ck_within(how->name, u[n + i], way, 1e-12);
  free(u);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* Half a block on a slip wall under pressure is half of the whole one. */
START_TEST(half_on_a_slip_wall) {
  const method *how = broad_methods[_i];
  /* functions of open knots are others at a face than within */
  if (!is_explicit(how) || how->boundary == MPM_BOUNDARY_OPEN_KNOT) return;
  double *x[2], *f[2];
  for (int32_t half = 0; half < 2; ++half) {
    world w;
    world_desc desc = world_with(how, 2, CELLS, spacing);
    desc.grid.origin[0] = half ? 0.0 : -1.5;
    mpm_particles *set = world_open(&w, &desc);
    if (half) ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
    const double low[] = {half ? 0.0 : -0.75, 1.0}, high[] = {0.75, 2.0};
    world_fill(&w, set, low, high, 2);
    mpm_surface_desc d = load_desc();
    d.pressure = 3000.0;
    mpm_surface *s = put_surface(&w, &d);
    /* markers 0 to 2 are those of the half */
    const double at[2][10] = {{0.05, 0.3, 0.6, -0.05, -0.3, -0.6, 0.75, -0.75, 0.0, 0.0},
                              {2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 1.5, 1.5, 1.5, 1.5}};
    const int32_t whole[8] = {0, 1, 2, 6, 3, 4, 5, 7};
    for (int32_t k = 0; k < (half ? 4 : 8); ++k) {
      const double p[2] = {at[0][whole[k]], at[1][whole[k]]};
      const int32_t side = whole[k] >= 6;
      const double a[2] = {side ? (p[0] > 0.0 ? 0.2 : -0.2) : 0.0, side ? 0.0 : 0.2};
      ck_ok(&w, mpm_surface_add(s, 1, p, a, NULL));
    }
    for (int32_t i = 0; i < 20; ++i) world_step(&w, 5e-4);
    x[half] = markers(s, "position", 2);
    f[half] = markers(s, "velocity", 2);
    drop_surface(&w, s);
    world_close(&w);
  }
  for (int32_t i = 0; i < 4; ++i)
    for (int32_t k = 0; k < 2; ++k) {
      ck_within(how->name, x[1][k * 4 + i], x[0][k * 8 + i], 1e-11);
      ck_within(how->name, f[1][k * 4 + i], f[0][k * 8 + i], 1e-9);
    }
  for (int32_t half = 0; half < 2; ++half) free(x[half]), free(f[half]);
}
END_TEST

/* A dead load on a marker is a force on the particle where it lies: next to a slip wall, in every scheme. */
START_TEST(as_a_force_on_a_particle) {
  const method *how = broad_methods[_i];
  if (is_gimp(how->basis)) return; /* particles have domains of their own */
  double *x[2];
  int64_t n = 0;
  for (int32_t by_marker = 0; by_marker < 2; ++by_marker) {
    world w;
    world_desc desc = world_with(how, 2, CELLS, spacing);
    mpm_particles *set = world_open(&w, &desc);
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
    const double low[] = {0.0, 1.0}, high[] = {1.0, 2.0}, wanted[] = {0.0625, 1.5625};
    n = world_fill(&w, set, low, high, 2);
    double *at = fetch(&w, set, "position", 2);
    for (int64_t i = 0; i < n; ++i) {
      const double from[2] = {at[i], at[n + i]}, area[2] = {0.2, 0.0},
                   force[2] = {-3000.0 * 0.2, 2000.0 * 0.2};
      if (fabs(from[0] - wanted[0]) + fabs(from[1] - wanted[1]) > 1e-6) continue;
      if (!by_marker) {
        ck_ok(&w, mpm_particles_set(set, "applied_force", MPM_F64, 2, 1, &i, force));
        continue;
      }
      mpm_surface_desc d = load_desc();
      d.dead_traction[0] = -3000.0, d.dead_traction[1] = 2000.0;
      ck_ok(&w, mpm_surface_add(put_surface(&w, &d), 1, from, area, NULL));
    }
    free(at);
    for (int32_t i = 0; i < 8; ++i) world_step(&w, 5e-4);
    x[by_marker] = fetch(&w, set, "position", 2);
    mpm_surface *s = by_marker ? w.stepper->settings.surfaces.surface[0] : NULL;
    if (s) drop_surface(&w, s);
    world_close(&w);
  }
  for (int64_t i = 0; i < 2 * n; ++i)
    ck_within(how->name, x[1][i], x[0][i], is_explicit(how) ? 1e-12 : 1e-10);
  free(x[0]);
  free(x[1]);
}
END_TEST

/* A ring under inner pressure swings: nothing moves it as a whole, and its energy is that of the work. */
START_TEST(ring_under_pressure) {
  world w;
  world_desc desc = world_default(2, 24, 0.125);
  world_open(&w, &desc);
  double at[2 * 64], inside = 0.5, outside = 1.0;
  for (double y = -outside; y < outside; y += 0.0625)
    for (double x = -outside; x < outside; x += 0.0625) {
      const double p[2] = {1.5 + x + 0.03125, 1.5 + y + 0.03125}, volume = 0.0625 * 0.0625;
      const double r = sqrt((p[0] - 1.5) * (p[0] - 1.5) + (p[1] - 1.5) * (p[1] - 1.5));
      if (r < inside || r > outside) continue;
      ck_ok(&w, mpm_particles_add(w.set[0], 1, p, NULL, &volume, NULL, NULL, NULL));
    }
  for (int32_t i = 0; i < 64; ++i) { /* clockwise: the material is outside of it */
    at[i] = 1.5 + inside * cos(2.0 * PI * i / 64);
    at[64 + i] = 1.5 - inside * sin(2.0 * PI * i / 64);
  }
  mpm_surface_desc d = load_desc();
  d.pressure = 2000.0;
  mpm_surface *s = put_surface(&w, &d);
  ck_ok(&w, mpm_surface_add_polyline(s, 64, at, 1, 0.0625, NULL, NULL));
  const double dt = 0.3 * world_stable_dt(&w);
  double most = 0.0, gained = 0.0;
  for (int32_t i = 0; i < 10000; ++i) {
    const mpm_step_info info = world_step(&w, dt);
    const double energy = info.kinetic_energy + info.strain_energy;
    most = energy > most ? energy : most;
    gained = energy - info.external_work_total > gained ? energy - info.external_work_total : gained;
  }
  const mpm_step_info info = world_info(&w);
  const double mass = mass_of(&w, w.set[0]);
  show("ring: energy at most %g, at the end %g, work %g, gained %g, momentum %g %g\n", most,
       info.kinetic_energy + info.strain_energy, info.external_work_total, gained, info.momentum[0],
       info.momentum[1]);
  ck_between("most", most, 1.0, 3.0 * most);
  for (int32_t k = 0; k < 2; ++k) ck_within("momentum", info.momentum[k], 0.0, 1e-12 * mass);
  ck_between("energy is that of the work", gained, 0.0, 0.05 * most);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* ---- faces of the grid --------------------------------------------------------------------------------- */
START_TEST(beyond_the_grid) {
  world w;
  mpm_particles *set = open_block(&w, &methods[0], 2);
  const double v[2] = {100.0, 0.0};
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_surface *s = put_surface(&w, NULL), *first = put_surface(&w, NULL);
  drop_surface(&w, first);
  for (int32_t k = 0; k < 3; ++k) {
    const double at[2] = {1.4 + 0.3 * k, 1.5};
    ck_ok(&w, mpm_surface_add(s, 1, at, NULL, NULL));
  }
  const double place[2] = {2.99, 1.5};
  const int64_t two = 2;
  ck_ok(&w, mpm_surface_set(s, "position", MPM_F64, 2, 1, &two, place));
  mpm_step_info info = {.struct_size = sizeof info};
  /* there is no material around it: it stays, as it carries nothing */
  ck_ok(&w, mpm_step(w.stepper, 1e-6, &info));
  const double near[2] = {2.15, 1.5};
  ck_ok(&w, mpm_surface_set(s, "position", MPM_F64, 2, 1, &two, near));
  world_bits was = world_take(&w);
  ck_refused(&w, mpm_step(w.stepper, 0.0087, &info), MPM_OFF_GRID,
             "marker 2 of surface 0 would leave the grid through MPM_X_MAX");
  ck_assert_int_eq(info.cause, MPM_OFF_GRID);
  world_same(&w, &was, "markers too");
  bits_drop(&was);
  /* through an open wall it goes for good */
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_OPEN, 0.0));
  ck_ok(&w, mpm_step(w.stepper, 0.0087, &info));
  ck_assert_int_eq(mpm_surface_count(s), 2);
  double out[2];
  ck_refused(&w, mpm_surface_get(s, "position", MPM_F64, 2, 1, &two, out), MPM_E_NOT_FOUND, "id 2");
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* ---- splitting ----------------------------------------------------------------------------------------- */
/* Sums that splitting keeps: of areas, and of areas times positions. */
static void moments_of(const mpm_surface *s, int32_t dim, double *sum) {
  const int64_t n = mpm_surface_count(s);
  double *x = markers(s, "position", dim), *a = markers(s, "area", dim), *A = markers(s, "reference_area", 1);
  for (int32_t k = 0; k < 16; ++k) sum[k] = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    sum[0] += A[i];
    for (int32_t k = 0; k < dim; ++k) {
      sum[1 + k] += a[k * n + i];
      for (int32_t c = 0; c < dim; ++c) sum[4 + 3 * k + c] += a[k * n + i] * x[c * n + i];
    }
  }
  free(x), free(a), free(A);
}

START_TEST(splitting_keeps_area_and_moment) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w;
    open_block(&w, &methods[0], dim);
    mpm_surface *s = put_surface(&w, NULL);
    add_closed(&w, s, 0.62);
    const double square[] = {1.1, 1.2, 1.3}, area[] = {0.3, -0.4, 0.1};
    ck_ok(&w, mpm_surface_add(s, 1, square, area, NULL));
    const int64_t before = mpm_surface_count(s), last = before - 1;
    const double own = 7.0;
    ck_ok(&w, mpm_surface_set(s, "pressure", MPM_F64, 1, 1, &last, &own));
    double was[16], is[16], p;
    moments_of(s, dim, was);
    int64_t added = -1;
    ck_ok(&w, mpm_surface_refine(s, 0.04, &added));
    moments_of(s, dim, is);
    ck_assert_int_eq(mpm_surface_count(s), before + added);
    ck_assert(dim == 1 ? added == 0 : added > before);
    for (int32_t k = 0; k < 16; ++k) ck_within("moment", is[k], was[k], 1e-12);
    const int64_t child = before + added - 1; /* of the last one */
    ck_ok(&w, mpm_surface_get(s, "pressure", MPM_F64, 1, 1, &child, &p));
    ck_holds(p == own);
    ck_ok(&w, mpm_surface_refine(s, 0.04, &added)); /* all are short now */
    ck_assert_int_eq(added, 0);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* With max_spacing markers are split as the material stretches. */
START_TEST(stretched_markers_are_split) {
  for (int32_t dim = 2; dim <= 3; ++dim) {
    world w;
    open_block(&w, &methods[0], dim);
    mpm_surface_desc d = load_desc();
    d.max_spacing = dim == 2 ? 0.07 : 0.09;
    mpm_surface *s = put_surface(&w, &d);
    add_closed(&w, s, 0.45);
    step_with(&w, 1e-6, away); /* triangles have edges of up to 0.3 */
    const int64_t before = mpm_surface_count(s);
    for (int32_t i = 0; i < 4; ++i) step_with(&w, 0.1, away);
    ck_assert_msg(mpm_surface_count(s) > before, "%d-D: %lld", (int)dim, (long long)before);
    double sum[16], volume = 0.0;
    moments_of(s, dim, sum);
    for (int32_t k = 0; k < dim; ++k) volume += sum[4 + 4 * k] / dim;
    const double wanted = dim == 2 ? area_of_circle(0.45) : 4.0 / 3.0 * pow(0.45, 3.0);
    ck_within("volume", volume, wanted * pow(1.1, 4.0 * dim), 1e-4 * wanted);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* ---- bodies, failures, states -------------------------------------------------------------------------- */
/* A surface loads the body that it belongs to, though another one lies at the same place. */
START_TEST(one_of_two_bodies) {
  for (int32_t body = 0; body < 2; ++body) {
    world w;
    open_block(&w, &methods[0], 2);
    mpm_contact_desc rule;
    ck_ok(&w, mpm_contact_desc_init(&rule, sizeof rule));
    rule.kind = MPM_CONTACT_NONE;
    mpm_particles *other = world_add_set(&w, NULL);
    const double low[] = {0.9, 0.9}, high[] = {2.1, 2.1};
    world_fill(&w, other, low, high, 2);
    ck_ok(&w, mpm_stepper_set_body(w.stepper, other, 1));
    ck_ok(&w, mpm_stepper_set_contact(w.stepper, MPM_BODY_ANY, MPM_BODY_ANY, &rule));
    mpm_surface_desc d = load_desc();
    d.body = body;
    d.traction[0] = 100.0;
    mpm_surface *s = put_surface(&w, &d);
    add_circle(&w, s, 0.3, 0.1);
    world_step(&w, 1e-3);
    for (int32_t m = 0; m < 2; ++m) {
      double *v = fetch(&w, w.set[m], "velocity", 2);
      ck_assert((largest(mpm_particles_count(w.set[m]), v) > 0.0) == (m == body));
      free(v);
    }
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

static void same_markers(const mpm_surface *s, const mpmi_markers *was) {
  ck_assert_int_eq(s->now.count, was->count);
  ck_assert_int_eq(s->now.next_id, was->next_id);
  ck_assert(memcmp(s->now.at, was->at, (size_t)was->count * sizeof *was->at) == 0);
}

static mpmi_markers copy_of(const mpm_surface *s) {
  mpmi_markers copy = s->now;
  copy.at = malloc((size_t)copy.count * sizeof *copy.at);
  memcpy(copy.at, s->now.at, (size_t)copy.count * sizeof *copy.at);
  return copy;
}

START_TEST(failures_leave_no_trace) {
  world w;
  open_block(&w, &methods[0], 2);
  mpm_surface_desc d = load_desc();
  d.pressure = 1000.0;
  d.max_spacing = 0.08;
  mpm_surface *s = put_surface(&w, &d);
  add_circle(&w, s, 0.62, 0.1);
  world_step(&w, 1e-3);
  const mpmi_markers was = copy_of(s);
  world_bits bits = world_take(&w);
  water of = {3.0, 10.0, 0, 0.0, 0.0};
  ck_ok(&w, mpm_surface_set_traction(s, push_by_depth, &of));
  mpm_step_info info = {.struct_size = sizeof info};
  of.answer = -3;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_E_CALLBACK, "of surface 0 returned -3");
  ck_assert_int_eq(info.callback_status, -3);
  of.answer = 2;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_CUT_DT, "returned 2");
  of.answer = 0;
  of.weight = NOT_A_NUMBER;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_NONFINITE, "has a load that is not finite");
  of.weight = 10.0;
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-3));
  ck_refused(&w, mpm_surface_configure(s, &d), MPM_E_STATE, "staged step");
  ck_refused(&w, mpm_surface_refine(s, 0.1, NULL), MPM_E_STATE, "staged step");
  ck_refused(&w, mpm_surface_set(s, "pressure", MPM_F64, 1, 0, NULL, NULL), MPM_E_STATE, "staged step");
  ck_ok(&w, mpm_step_grid(w.stepper));
  ck_ok(&w, mpm_step_abort(w.stepper));
  same_markers(s, &was);
  world_same(&w, &bits, "particles");
  const double far[2] = {0.1, 0.1}, area[2] = {1.0, 0.0};
  int64_t lost;
  ck_ok(&w, mpm_surface_add(s, 1, far, area, &lost));
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_E_STATE, "no material around it");
  ck_ok(&w, mpm_surface_remove(s, 1, &lost));
  ck_ok(&w, mpm_step(w.stepper, 1e-3, &info));
  free(was.at);
  bits_drop(&bits);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

static mpm_surface *loaded_world(world *w, int32_t concurrency, int32_t scatter) {
  world_desc desc = world_with(&methods[0], 3, CELLS, spacing);
  desc.context.concurrency = concurrency;
  desc.random_order = scatter;
  open_block_with(w, &desc);
  mpm_surface_desc d = load_desc();
  d.pressure = 20000.0;
  d.traction[1] = 3000.0;
  d.max_spacing = 0.1;
  mpm_surface *s = put_surface(w, &d);
  add_closed(w, s, 0.62);
  return s;
}

START_TEST(threads_change_no_bit) {
  uint64_t wanted = 0;
  for (int32_t k = 0; k < 3; ++k) {
    world w;
    mpm_surface *s = loaded_world(&w, k == 0 ? 1 : k + 1, k == 2);
    for (int32_t i = 0; i < 10; ++i) world_step(&w, 1e-3);
    if (!k) wanted = world_hash(&w);
    ck_holds(world_hash(&w) == wanted);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

START_TEST(states_hold_markers) {
  world a, b;
  mpm_surface *s = loaded_world(&a, 1, 0), *t = loaded_world(&b, 1, 0);
  for (int32_t i = 0; i < 4; ++i) world_step(&a, 1e-3);
  const double own[1] = {3.0};
  const int64_t three = 3;
  ck_ok(&a, mpm_surface_set(s, "pressure", MPM_F64, 1, 1, &three, own));
  ck_assert(mpm_surface_count(s) > mpm_surface_count(t));
  saved_state state = world_save(&a);
  world_load(&b, &state);
  const mpmi_markers was = copy_of(s);
  same_markers(t, &was);
  free(was.at);
  for (int32_t i = 0; i < 4; ++i) {
    world_step(&a, 1e-3);
    world_step(&b, 1e-3);
    ck_holds(world_hash(&a) == world_hash(&b));
  }
  /* whatever is cut or spoiled is refused, and changes nothing */
  const mpmi_markers kept = copy_of(t);
  const uint64_t hash = world_hash(&b);
  ck_ok(&b, mpm_stepper_remove_surface(b.stepper, t));
  ck_refused(&b, mpm_state_load(b.stepper, state.data, state.bytes), MPM_E_FORMAT,
             "number of surfaces is 1 there, 0 here");
  ck_ok(&b, mpm_stepper_add_surface(b.stepper, t));
  mpm_surface_desc d = load_desc();
  d.body = 3;
  ck_ok(&b, mpm_surface_configure(t, &d));
  ck_refused(&b, mpm_state_load(b.stepper, state.data, state.bytes), MPM_E_FORMAT, "body is 0 there, 3 here");
  same_markers(t, &kept);
  ck_holds(world_hash(&b) == hash);
  free(kept.at);
  free(state.data);
  drop_surface(&a, s);
  drop_surface(&b, t);
  world_close(&a);
  world_close(&b);
}
END_TEST

/* Runs a small story in which one allocation fails; returns how many there were, 0 where it came through. */
static int64_t story(int64_t fail_at, uint64_t *hash) {
  world w;
  mpm_surface *s = NULL;
  open_block(&w, &methods[0], 2);
  const int64_t start = w.memory.calls;
  mpm_surface_desc d = load_desc();
  d.pressure = 2e4;
  d.max_spacing = 0.05;
  const double corner[8] = {1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 2.0, 2.0};
  water of = {3.0, 10.0, 0, 0.0, 0.0};
  const int64_t zero = 0;
  int32_t done = 0, tries = 0;
  w.memory.fail_at = fail_at ? start + fail_at : 0;
  while (done < 8) {
    mpm_status status = MPM_OK;
    if (done == 0) status = mpm_surface_create(w.context, w.grid, &d, &s);
    if (done == 1) status = mpm_stepper_add_surface(w.stepper, s);
    if (done == 2) status = mpm_surface_add_polyline(s, 4, corner, 1, 0.2, NULL, NULL);
    if (done == 3) status = mpm_surface_set_traction(s, push_by_depth, &of);
    if (done == 4 || done == 7) status = mpm_step(w.stepper, 2e-3, NULL);
    if (done == 5) status = mpm_surface_refine(s, 0.03, NULL);
    if (done == 6) status = mpm_surface_remove(s, 1, &zero);
    ck_assert(status == MPM_OK || (status == MPM_E_NOMEM && fail_at && !tries++));
    if (!status) ++done;
  }
  const int64_t calls = w.memory.calls - start;
  w.memory.fail_at = 0;
  *hash = world_hash(&w);
  drop_surface(&w, s);
  world_close(&w);
  return calls;
}

START_TEST(every_allocation_fails_once) {
  uint64_t wanted, hash;
  const int64_t calls = story(0, &wanted);
  ck_assert(calls > 5);
  for (int64_t k = 1; k <= calls; ++k) {
    story(k, &hash);
    ck_assert_msg(hash == wanted, "without allocation %lld the story is another", (long long)k);
  }
}
END_TEST

/* ---- implicit steps ------------------------------------------------------------------------------------ */
/* Opens a block of 4 cells an edge that stands on a floor, in quasi-static steps or in dynamic ones. */
static mpm_surface *implicit_block(world *w, int32_t dim, int32_t quasi_static, const mpm_surface_desc *d) {
  const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  world_desc desc = world_with(&how, dim, CELLS, spacing);
  desc.stepper.quasi_static = quasi_static;
  world_open(w, &desc);
  const double low[] = {0.0, 1.0, 1.0}, high[] = {1.0, 2.0, 2.0};
  world_fill(w, w->set[0], low, high, 2);
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  return put_surface(w, d);
}

/* A face of the block at x = 1. */
static void add_face(const world *w, mpm_surface *s) {
  const int32_t n = w->dim == 1 ? 1 : w->dim == 2 ? 8 : 64;
  for (int32_t i = 0; i < n; ++i) {
    const double x[3] = {1.0, 1.0625 + 0.125 * (i % 8), 1.0625 + 0.125 * (i / 8 % 8)},
                 a[3] = {1.0 / n, 0.0, 0.0};
    ck_ok(w, mpm_surface_add(s, 1, x, a, NULL));
  }
}

/* The wall takes the whole load, dead or alive; and a load that turns takes few iterations, because its
 * stiffness is that of its force. */
START_TEST(equilibrium_under_loads) {
  const int32_t dim = 1 + _i % 3, follows = _i / 3;
  world w;
  mpm_surface_desc d = load_desc();
  if (follows)
    d.pressure = 8000.0;
  else
    d.dead_traction[0] = -3000.0, d.dead_traction[1] = 2000.0;
  mpm_surface *s = implicit_block(&w, dim, 1, &d);
  add_face(&w, s);
  const mpm_step_info info = world_step(&w, 1.0);
  double reaction[3], given[3] = {0.0, 0.0, 0.0}, work = 0.0;
  ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, reaction));
  double *f = markers(s, "force", dim), *u = markers(s, "displacement", dim);
  const int64_t n = mpm_surface_count(s);
  for (int64_t i = 0; i < n; ++i)
    for (int32_t k = 0; k < dim; ++k) given[k] += f[k * n + i], work += f[k * n + i] * u[k * n + i];
  for (int32_t k = 0; k < dim; ++k) ck_within("reaction", reaction[k], -given[k], 1e-5 * 8000.0);
  if (!follows) ck_within("dead", given[0], -3000.0, 1e-9 * 3000.0);
  if (follows && dim == 1) ck_within("along", given[0], -8000.0, 1e-9 * 8000.0);
  ck_within("work", info.external_work, work, 1e-9 * fabs(work));
  show("%d-D, follows %d: %d iterations, solver %d, work %g, force %g %g\n", (int)dim, (int)follows,
       (int)info.newton_iterations, (int)info.linear_solver, work, given[0], given[1]);
  ck_assert_int_le(info.newton_iterations, 7);
  /* LDL^T is for symmetric matrices, and in 1-D areas do not turn */
  ck_assert((info.linear_solver == MPM_SOLVER_LDLT) == (!follows || dim == 1));
  free(f);
  free(u);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* Newton's method converges quadratically with all that follows: the last ratio of residuals says so. */
START_TEST(stiffness_of_what_follows) {
  world w;
  mpm_surface_desc d = load_desc();
  d.pressure = 6000.0;
  d.traction[1] = 9000.0;
  mpm_surface *s = implicit_block(&w, 2, _i, &d);
  add_face(&w, s);
  const mpm_step_info info = world_step(&w, 0.05);
  double residual[32];
  int32_t count;
  ck_ok(&w, mpm_stepper_residuals(w.stepper, 32, residual, &count));
  for (int32_t i = 0; i < count; ++i) show("%d: %g\n", (int)i, residual[i]);
  ck_assert_int_le(info.newton_iterations, 7);
  ck_assert_int_ge(count, 4);
  int32_t quadratic = 0; /* from below 1e-3 in one step to its square */
  for (int32_t i = 1; i < count; ++i)
    quadratic |= residual[i - 1] < 3e-2 && residual[i - 1] > 1e-6 &&
                 residual[i] < 10.0 * residual[i - 1] * residual[i - 1] + 1e-13;
  ck_assert(quadratic);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* An implicit step of small size is an explicit one: the same momentum goes in. */
START_TEST(implicit_momentum) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
    world w;
    open_block(&w, &how, dim);
    mpm_surface_desc d = load_desc();
    d.traction[0] = 100.0;
    mpm_surface *s = put_surface(&w, &d);
    add_closed(&w, s, 0.62);
    const double dt = 1e-4;
    double *A = markers(s, "reference_area", 1);
    const double force = 100.0 * sum_of(mpm_surface_count(s), A);
    for (int32_t i = 0; i < 4; ++i) world_step(&w, dt);
    ck_within("momentum", world_info(&w).momentum[0], 4.0 * dt * force, 1e-5 * dt * force);
    ck_assert(mpm_surface_count(s) > 0);
    free(A);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* ---- what is refused ----------------------------------------------------------------------------------- */
START_TEST(refusals) {
  world w, flat;
  open_block(&w, &methods[0], 3);
  open_block(&flat, &methods[0], 2);
  mpm_surface *s = NULL, *second;
  mpm_surface_desc d = load_desc();
  d.body = -1;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "body is -1");
  ck_holds(!s);
  d = load_desc();
  d.pressure = NOT_A_NUMBER;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "pressure is");
  d = load_desc();
  d.max_spacing = -1.0;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "max_spacing is -1");
  d = load_desc();
  d.dead_traction[1] = INFINITE;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "dead_traction[1] is inf");
  ck_refused(&w, mpm_surface_create(w.context, flat.grid, NULL, &s), MPM_E_ARG, "another context");
  ck_refused(&w, mpm_surface_create(w.context, w.grid, NULL, NULL), MPM_E_ARG, "out is NULL");
  s = put_surface(&w, NULL);
  ck_refused(&w, mpm_stepper_add_surface(w.stepper, s), MPM_E_STATE, "already belongs to this stepper");
  ck_refused(&w, mpm_surface_destroy(s), MPM_E_STATE, "mpm_stepper_remove_surface() first");
  const double in[3] = {1.0, 1.0, 1.0}, out[3] = {1.0, 4.0, 1.0}, bad[3] = {0.0, NOT_A_NUMBER, 0.0};
  const double huge[3] = {1e300, 1e300, 1e300};
  ck_refused(&w, mpm_surface_add(s, 1, out, NULL, NULL), MPM_E_ARG, "marker 0: position[1] is 4");
  ck_refused(&w, mpm_surface_add(s, 1, in, bad, NULL), MPM_E_ARG, "marker 0: area[1] is");
  ck_refused(&w, mpm_surface_add(s, 1, in, huge, NULL), MPM_E_ARG, "beyond the range");
  ck_refused(&w, mpm_surface_add(s, -1, in, NULL, NULL), MPM_E_ARG, "n is -1");
  ck_refused(&w, mpm_surface_add(s, 1, NULL, NULL, NULL), MPM_E_ARG, "position is NULL");
  ck_refused(&w, mpm_surface_add_polyline(s, 1, in, 0, 1.0, NULL, NULL), MPM_E_UNSUPPORTED,
             "mpm_surface_add_triangles()");
  ck_assert_int_eq(mpm_surface_count(s), 0);
  const double corners[9] = {1.0, 2.0, 1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0};
  const int64_t wrong[3] = {0, 1, 3}, right[3] = {0, 1, 2};
  ck_refused(&w, mpm_surface_add_triangles(s, 3, corners, 1, wrong, 0.1, NULL, NULL), MPM_E_ARG,
             "triangle 0: corner 3 does not exist");
  ck_refused(&w, mpm_surface_add_triangles(s, 3, corners, 1, right, 0.0, NULL, NULL), MPM_E_ARG,
             "spacing is 0");
  ck_refused(&w, mpm_surface_add_triangles(s, 3, corners, 1, right, 1e-9, NULL, NULL), MPM_E_ARG,
             "into more than");
  int64_t first = -1, count = -1;
  ck_ok(&w, mpm_surface_add_triangles(s, 3, corners, 1, right, 0.5, &first, &count));
  ck_holds(first == 0 && count == 9 && mpm_surface_count(s) == 9);
  double v[3];
  int64_t ids[2] = {4, 4}, got[9];
  ck_ok(&w, mpm_surface_get(s, "id", MPM_I64, 1, 9, NULL, got));
  ck_holds(got[0] == 0 && got[8] == 8);
  ck_refused(&w, mpm_surface_get(s, "stress", MPM_F64, 1, 1, ids, v), MPM_E_NOT_FOUND, "no field");
  ck_refused(&w, mpm_surface_get(s, "area", MPM_F64, 2, 1, ids, v), MPM_E_ARG, "with 3 components");
  ck_refused(&w, mpm_surface_get(s, "area", MPM_F64, 3, 1, NULL, v), MPM_E_ARG, "has 9 markers");
  ck_refused(&w, mpm_surface_set(s, "velocity", MPM_F64, 3, 1, ids, in), MPM_E_ARG, "cannot be set");
  ck_refused(&w, mpm_surface_set(s, "position", MPM_F64, 3, 1, ids, out), MPM_E_ARG, "position[1] is 4");
  ck_refused(&w, mpm_surface_set(s, "traction", MPM_F64, 3, 1, ids, bad), MPM_E_ARG, "traction[1] is");
  ck_refused(&w, mpm_surface_remove(s, 2, ids), MPM_E_ARG, "given twice");
  ids[1] = 99;
  ck_refused(&w, mpm_surface_remove(s, 2, ids), MPM_E_NOT_FOUND, "id 99");
  ck_refused(&w, mpm_surface_refine(s, NOT_A_NUMBER, NULL), MPM_E_ARG, "spacing is");
  ck_assert_int_eq(mpm_surface_count(s), 9);
  ck_ok(&flat, mpm_surface_create(flat.context, flat.grid, NULL, &second));
  ck_refused(&flat, mpm_surface_add_triangles(second, 3, corners, 1, right, 0.5, NULL, NULL),
             MPM_E_UNSUPPORTED, "mpm_surface_add_polyline()");
  ck_refused(&flat, mpm_surface_add_polyline(second, 2, corners, 2, 0.5, NULL, NULL), MPM_E_ARG,
             "closed is 2");
  ck_refused(&w, mpm_stepper_add_surface(w.stepper, second), MPM_E_ARG, "another context");
  ck_refused(&flat, mpm_stepper_remove_surface(flat.stepper, second), MPM_E_NOT_FOUND, "not in this stepper");
  ck_ok(&flat, mpm_surface_destroy(second));
  ck_ok(&w, mpm_surface_destroy(NULL));
  drop_surface(&w, s);
  world_close(&flat);
  world_close(&w);
}
END_TEST

/* A stepper that goes lets its surfaces go. */
START_TEST(outlives_its_stepper) {
  world w;
  open_block(&w, &methods[0], 2);
  mpm_surface *s = put_surface(&w, NULL);
  ck_ok(&w, mpm_stepper_destroy(w.stepper));
  w.stepper = NULL;
  ck_ok(&w, mpm_surface_destroy(s));
  world_close(&w);
}
END_TEST

Suite *surface_suite(void);
Suite *surface_suite(void) {
  Suite *suite = suite_create("surface");
  TCase *loads = tcase_create("loads"), *motion = tcase_create("motion"), *other = tcase_create("other"),
        *implicit = tcase_create("implicit");
  tcase_add_loop_test(loads, closed_under_pressure, 0, BROAD);
  tcase_add_loop_test(loads, tractions_keep_force_and_moment, 0, BROAD);
  tcase_add_loop_test(loads, buoyancy, 0, BROAD);
  tcase_add_test(loads, light_nodes_take_little);
  tcase_add_loop_test(motion, power_of_pressure, 0, BROAD);
  tcase_add_loop_test(motion, linear_fields_are_exact, 0, BROAD);
  tcase_add_loop_test(motion, nanson_by_differences, 0, BROAD);
  tcase_add_loop_test(motion, flight_across_a_seam, 0, BROAD);
  tcase_add_loop_test(motion, falls_with_its_particles, 0, BROAD);
  tcase_add_loop_test(motion, half_on_a_slip_wall, 0, BROAD);
  tcase_add_loop_test(motion, as_a_force_on_a_particle, 0, BROAD);
  tcase_add_test(motion, ring_under_pressure);
  tcase_add_test(other, beyond_the_grid);
  tcase_add_test(other, splitting_keeps_area_and_moment);
  tcase_add_test(other, stretched_markers_are_split);
  tcase_add_test(other, one_of_two_bodies);
  tcase_add_test(other, failures_leave_no_trace);
  tcase_add_test(other, threads_change_no_bit);
  tcase_add_test(other, states_hold_markers);
  tcase_add_test(other, every_allocation_fails_once);
  tcase_add_loop_test(implicit, equilibrium_under_loads, 0, 6);
  tcase_add_loop_test(implicit, stiffness_of_what_follows, 0, 2);
  tcase_add_test(implicit, implicit_momentum);
  tcase_add_test(other, refusals);
  tcase_add_test(other, outlives_its_stepper);
  tcase_set_timeout(loads, 60);
  tcase_set_timeout(motion, 60);
  tcase_set_timeout(other, 60);
  tcase_set_timeout(implicit, 60);
  suite_add_tcase(suite, loads);
  suite_add_tcase(suite, motion);
  suite_add_tcase(suite, other);
  suite_add_tcase(suite, implicit);
  return suite;
}
