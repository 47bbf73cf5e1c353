/* Bodies of revolution: their fills, gradient, forces, surfaces and refusals. */
#include "geometry.h"
#include "old_format.h"
#include "surfaces.h"

/* The methods that go through these are all that rings offer. */
static int32_t fits_rings(const method *how) {
  return how->transfer != MPM_APIC_MLS;
}

/* Do particles deform by the velocities that nodes have at the end of the step? */
static int32_t strains_by_nodes(const method *how) {
  return fits_rings(how) && how->scheme == MPM_USL;
}

static world_desc rings_with(const method *how, int64_t cells, double h) {
  world_desc d = world_with(how, 2, cells, h);
  d.grid.geometry = MPM_AXISYMMETRIC;
  return d;
}

static world_desc rings(int64_t cells, double h) {
  world_desc d = world_default(2, cells, h);
  d.grid.geometry = MPM_AXISYMMETRIC;
  return d;
}

/* ---- volumes ------------------------------------------------------------------------------------------- */
/* A fill has the mass of the body of revolution, per radian, to the last digits: r is linear in a cell. */
START_TEST(fills_have_their_mass) {
  for (int32_t per_axis = 1; per_axis <= 4; ++per_axis)
    for (int32_t far = 0; far < 2; ++far) {
      world w;
      world_desc desc = rings(12, 0.25);
      desc.grid.origin[0] = 3.0 * far;
      mpm_particles *set = world_open(&w, &desc);
      const double a = 3.0 * far + 0.5, low[] = {a, 1.0}, high[] = {a + 1.0, 2.5};
      world_fill(&w, set, low, high, per_axis);
      const double wanted = 1e3 * 0.5 * ((a + 1.0) * (a + 1.0) - a * a) * 1.5;
      ck_within("mass", mass_of(&w, set), wanted, 1e-13 * wanted);
      world_close(&w);
    }
}
END_TEST

/* ---- the gradient -------------------------------------------------------------------------------------- */
static void grow(const double *x, double *v) {
  for (int32_t k = 0; k < 3; ++k) v[k] = x[k];
}

/* In v = (r, z) a sphere stays a sphere: all stretches are alike, down to the axis. */
START_TEST(stretches_of_a_sphere) {
  const method *how = broad_methods[_i];
  if (!strains_by_nodes(how)) return;
  world w;
  const world_desc desc = rings_with(how, 12, 0.25);
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.0, 1.0}, high[] = {1.6, 1.6};
  const int64_t n = world_fill(&w, set, low, high, how->basis == MPM_LINEAR ? 2 : 5);
  const double dt = 1e-3;
  step_with(&w, dt, grow);
  double *F = fetch(&w, set, "deformation_gradient", 9), *x = fetch(&w, set, "position", 2);
  for (int64_t p = 0; p < n; ++p) {
    if (x[n + p] < 1.15 || x[n + p] > 1.45 || x[p] > 1.3) continue; /* nodes beyond it are empty */
    if (is_gimp(how->basis) && x[p] < 0.3) continue; /* a domain across the axis is no mirrored pair */
    ck_within(how->name, F[8 * n + p], F[p], 2e-15);
    ck_within(how->name, F[4 * n + p], F[p], 2e-15);
    ck_within(how->name, F[p], 1.0 + dt, 2e-15);
  }
  free(F);
  free(x);
  world_close(&w);
}
END_TEST

/* ---- forces -------------------------------------------------------------------------------------------- */
static void wild(const double *x, double *v) {
  for (int32_t k = 0; k < 2; ++k)
    v[k] = 1e-3 * noise_at((uint64_t)(llround(x[0] * 64.0) * 1000 + llround(x[1] * 64.0) * 2 + k + 70));
}

static void set_wild_stress(const world *w, mpm_particles *set, int64_t n) {
  double *values = calloc((size_t)(6 * n), sizeof *values);
  for (int64_t i = 0; i < 4 * n; ++i) values[i] = 1e3 * noise_at((uint64_t)i + 3);
  put(w, set, "stress", 6, values);
  free(values);
}

/* The forces of particles do the power of their stress: sum f v = - sum V sigma : L, for whatever stress and
 * velocity of the nodes. */
static void check_power(const world_desc *desc, const char *name) {
  world w;
  world_desc d = *desc;
  d.law.model = "linear_elastic";
  mpm_particles *set = world_open(&w, &d);
  const double low[] = {0.7, 0.7}, high[] = {1.3, 1.4};
  const int64_t n = world_fill(&w, set, low, high, 2);
  set_wild_stress(&w, set, n);
  double *stress = fetch(&w, set, "stress", 6), *volume = fetch(&w, set, "volume", 1);
  int64_t nodes = 0, count = 0;
  ck_ok(&w, mpm_step_begin(w.stepper, 1.0));
  double *f = fetch_nodes(&w, "force", &nodes);
  ck_ok(&w, mpm_step_abort(w.stepper));
  step_with(&w, 1.0, wild);
  double *at = fetch_nodes(&w, "position", &count), *F = fetch(&w, set, "deformation_gradient", 9);
  ck_assert_int_eq(nodes, count);
  double of_nodes = 0.0, of_particles = 0.0, scale = 0.0;
  for (int64_t i = 0; i < nodes; ++i) {
    const double x[2] = {at[i], at[nodes + i]};
    double v[3];
    wild(x, v);
    for (int32_t k = 0; k < 2; ++k) of_nodes += f[k * nodes + i] * v[k];
  }
  for (int64_t p = 0; p < n; ++p) {
    const double rate[4] = {F[p] - 1.0, F[4 * n + p] - 1.0, F[8 * n + p] - 1.0, F[n + p] + F[3 * n + p]};
    for (int32_t c = 0; c < 4; ++c) {
      of_particles += volume[p] * stress[c * n + p] * rate[c];
      scale += fabs(volume[p] * stress[c * n + p] * rate[c]);
    }
  }
  ck_within(name, of_nodes, -of_particles, 1e-11 * scale);
  free(stress);
  free(volume);
  free(f);
  free(at);
  free(F);
  world_close(&w);
}

START_TEST(forces_do_the_power_of_stresses) {
  const method *how = broad_methods[_i];
  if (!strains_by_nodes(how) || how->remedy) return;
  const world_desc desc = rings_with(how, 8, 0.25);
  check_power(&desc, how->name);
}
END_TEST

/* Where the two stresses across the axis are equal, the body inside pulls at nothing. (Nodes that reach over
 * the axis have an error of quadrature, of second order.) */
START_TEST(uniform_stress_has_no_force) {
  const method *how = broad_methods[_i];
  if (!fits_rings(how) || !is_explicit(how) || how->scheme == MPM_USF || is_gimp(how->basis)) return;
  for (int32_t per_axis = 1; per_axis <= 4; ++per_axis) {
    world w;
    world_desc desc = rings_with(how, 12, 0.25);
    desc.law.model = "linear_elastic";
    mpm_particles *set = world_open(&w, &desc);
    const double low[] = {0.0, 0.5}, high[] = {2.5, 2.5};
    const int64_t n = world_fill(&w, set, low, high, per_axis);
    double *stress = calloc((size_t)(6 * n), sizeof *stress);
    for (int64_t p = 0; p < n; ++p) stress[p] = stress[2 * n + p] = 1e3, stress[n + p] = 400.0;
    put(&w, set, "stress", 6, stress);
    int64_t nodes;
    ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
    double *f = fetch_nodes(&w, "force", &nodes), *x = fetch_nodes(&w, "position", &nodes), most = 0.0;
    int32_t inside = 0;
    for (int64_t i = 0; i < 2 * nodes; ++i) most = fmax(most, fabs(f[i]));
    for (int64_t i = 0; i < nodes; ++i) {
      if (x[i] < 0.9 || x[i] > 1.6 || x[nodes + i] < 1.3 || x[nodes + i] > 1.7) continue;
      ck_within(how->name, f[i], 0.0, 1e-14 * most);
      ck_within(how->name, f[nodes + i], 0.0, 1e-14 * most);
      ++inside;
    }
    ck_assert_int_ge(inside, 3);
    free(f);
    free(x);
    free(stress);
    ck_ok(&w, mpm_step_abort(w.stepper));
    world_close(&w);
  }
}
END_TEST

/* ---- every combination --------------------------------------------------------------------------------- */
static combination *list;
static int32_t listed;

START_TEST(combination_works) {
  check_geometry(&list[_i], MPM_AXISYMMETRIC, 0);
}
END_TEST

/* ---- implicit steps ------------------------------------------------------------------------------------ */
static world_desc implicit_rings(const basis_option *basis, int32_t remedy, const char *model) {
  const method how = method_of(basis, &(scheme_option){MPM_NEWMARK, "Newmark"}, &transfer_options[0]);
  world_desc d = rings_with(&how, 12, 0.25);
  d.stepper.flip = 1.0;
  d.stepper.pic_damping = 0.0;
  d.stepper.locking_remedy = remedy;
  d.stepper.transfer = MPM_FLIP;
  d.law =
      (world_law){.model = model, .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 4e3, .hardening = 1e4};
  return d;
}

/* A ring that stands on a floor is pressed together from outside by a tenth of its stiffness, or so that it
 * yields: Newton's iteration has the tangent of its forces, and takes few steps. */
START_TEST(tangents_of_rings) {
  static const char *const models[] = {"neo_hookean", "j2", "linear_elastic"};
  const basis_option *basis = &basis_options[_i / 6];
  const int32_t remedy = _i / 3 % 2;
  world w;
  world_desc desc = implicit_rings(basis, remedy, models[_i % 3]);
  desc.stepper.quasi_static = 1;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.75, 0.0}, high[] = {1.5, 1.0};
  world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  mpm_surface_desc d = load_desc();
  d.pressure = _i % 3 == 1 ? 2e3 : 1e4;
  mpm_surface *s = put_surface(&w, &d);
  for (int32_t k = 0; k < 8; ++k) {
    const double at[] = {1.5, 0.0625 + 0.125 * k}, area[] = {1.5 * 0.125, 0.0};
    ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
  }
  const mpm_step_info info = world_step(&w, 1.0);
  show("%s, %s, remedy %d: %d iterations\n", basis->name, models[_i % 3], (int)remedy,
       (int)info.newton_iterations);
  ck_assert_int_le(info.newton_iterations, 6);
  double reaction[3], *f = markers(s, "force", 2);
  ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, reaction));
  ck_within("along the axis", reaction[1], -sum_of(8, f + 8), 1e-6 * 1e4);
  free(f);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

static uint64_t implicit_hash(const basis_option *basis, int32_t remedy, const char *model,
                              int32_t concurrency) {
  world w;
  world_desc desc = implicit_rings(basis, remedy, model);
  desc.context.concurrency = concurrency;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.0, 0.5}, high[] = {1.0, 1.5};
  const int64_t n = world_fill(&w, set, low, high, 2);
  double *v = malloc((size_t)(2 * n + 1) * sizeof *v), *x = fetch(&w, set, "position", 2);
  for (int64_t i = 0; i < n; ++i) v[i] = x[i], v[n + i] = -0.5 * x[n + i];
  put(&w, set, "velocity", 2, v);
  free(v);
  free(x);
  for (int32_t k = 0; k < 3; ++k) world_step(&w, 2e-3);
  const uint64_t hash = world_step_again(&w, 2e-3);
  world_close(&w);
  return hash;
}

START_TEST(implicit_threads) {
  static const char *const models[] = {"neo_hookean", "j2", "newtonian_fluid"};
  const basis_option *basis = &basis_options[_i / 2];
  const char *model = models[_i % 3];
  if (basis->basis == MPM_CPGIMP && keeps_volume_alone(model)) return;
  ck_assert_uint_eq(implicit_hash(basis, _i % 2, model, 1), implicit_hash(basis, _i % 2, model, 3));
}
END_TEST

/* ---- surfaces ------------------------------------------------------------------------------------------ */
/* Under a pressure p a closed ring is pushed outwards with p times its area in the plane, per radian, and not
 * along the axis. Its radii stretch with it. */
START_TEST(pressure_on_a_ring) {
  const method *how = broad_methods[_i];
  if (!fits_rings(how) || !is_explicit(how)) return;
  world w;
  const world_desc desc = rings_with(how, CELLS, spacing);
  open_block_with(&w, &desc);
  mpm_surface_desc d = load_desc();
  d.pressure = -1000.0;
  mpm_surface *s = put_surface(&w, &d);
  add_circle(&w, s, 0.3, 0.1);
  int64_t n;
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
  double *f = fetch_nodes(&w, "force", &n);
  const double plane = area_of_circle(0.3);
  ck_within(how->name, sum_of(n, f), 1000.0 * plane, 1e-11 * 1000.0);
  ck_within(how->name, sum_of(n, f + n), 0.0, 1e-11 * 1000.0);
  ck_ok(&w, mpm_step_abort(w.stepper));
  free(f);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

START_TEST(areas_follow_the_ring) {
  const double dt = 1e-3, grown = (1.0 + dt) * (1.0 + dt);
  world w;
  const world_desc desc = rings(CELLS, spacing);
  open_block_with(&w, &desc);
  mpm_surface *s = put_surface(&w, NULL);
  add_circle(&w, s, 0.3, 0.1);
  const double at[] = {1.5, 1.5}, area[] = {0.3, -0.2}, on_axis[] = {0.0, 1.5};
  ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
  const int64_t n = mpm_surface_count(s);
  double *before = markers(s, "area", 2);
  ck_within("as given", before[n - 1], 0.3, 1e-15);
  ck_within("as given", before[2 * n - 1], -0.2, 1e-15);
  step_with(&w, dt, grow);
  double *after = markers(s, "area", 2);
  for (int64_t i = 0; i < 2 * n; ++i) ck_within("area", after[i], grown * before[i], 1e-13);
  /* halves of a marker have the area of the whole */
  double *referred = markers(s, "reference_area", 1);
  int64_t added;
  ck_ok(&w, mpm_surface_refine(s, 0.03, &added));
  ck_assert_int_gt(added, n);
  const int64_t all = mpm_surface_count(s);
  double *halves = markers(s, "area", 2);
  ck_within("sum", sum_of(all, halves), sum_of(n, after), 1e-13);
  double *halves_reference = markers(s, "reference_area", 1);
  ck_within("reference", sum_of(all, halves_reference), sum_of(n, referred), 1e-13);
  for (int64_t i = 0; i < all; ++i)
    ck_within("reference", halves_reference[i], hypot(halves[i], halves[all + i]) / grown, 1e-13);
  ck_within("sum", sum_of(all, halves + all), sum_of(n, after + n), 1e-13);
  ck_refused(&w, mpm_surface_add(s, 1, on_axis, area, NULL), MPM_E_ARG, "lies on the axis");
  /* at r its edge is as wide as 2 r at the most: else a half of it would lie beyond the axis */
  const double near_axis[] = {0.1, 1.5}, wide[] = {0.0, 0.021}, fits[] = {0.0, 0.02};
  ck_refused(&w, mpm_surface_add(s, 1, near_axis, wide, NULL), MPM_E_ARG, "edge is 0.21 wide");
  ck_ok(&w, mpm_surface_add(s, 1, near_axis, fits, NULL));
  ck_refused(&w, mpm_surface_set(s, "area", MPM_F64, 2, 1, &(int64_t){all}, wide), MPM_E_ARG,
             "reaches beyond the axis");
  free(before);
  free(after);
  free(halves);
  free(referred);
  free(halves_reference);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* ---- contact ------------------------------------------------------------------------------------------- */
/* A block of 0.75 by 0.75 whose lower face is at y = 1 moves along y above, or on, a plane. */
typedef struct floor_case {
  int32_t geometry;
  double origin, speed, level, adhesion;
} floor_case;

static mpm_obstacle *open_on_floor(world *w, const floor_case *of) {
  world_desc desc = world_default(2, 12, 0.25);
  desc.grid.geometry = of->geometry;
  desc.grid.origin[0] = of->origin;
  mpm_particles *set = world_open(w, &desc);
  const double low[] = {of->origin, 1.0}, high[] = {of->origin + 0.75, 1.75}, v[] = {0.0, of->speed};
  world_fill(w, set, low, high, 2);
  ck_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_obstacle_desc d;
  mpm_contact_desc contact;
  mpm_obstacle *floor;
  ck_ok(w, mpm_contact_desc_init(&contact, sizeof contact));
  ck_ok(w, mpm_obstacle_desc_init(&d, sizeof d));
  contact.adhesion = of->adhesion;
  d.contact = &contact;
  d.shape = MPM_SHAPE_PLANE;
  d.position[0] = of->origin + 1.0;
  d.position[1] = of->level;
  ck_ok(w, mpm_obstacle_create(w->context, &d, &floor));
  ck_ok(w, mpm_stepper_add_obstacle(w->stepper, floor));
  return floor;
}

static mpm_contact_info step_on_floor(world *w, mpm_obstacle *floor) {
  mpm_contact_info info = {.struct_size = sizeof info};
  world_step(w, 1e-3);
  ck_ok(w, mpm_obstacle_contact_info(floor, MPM_BODY_ANY, &info));
  return info;
}

static void close_on_floor(world *w, mpm_obstacle *floor) {
  ck_ok(w, mpm_stepper_remove_obstacle(w->stepper, floor));
  ck_ok(w, mpm_obstacle_destroy(floor));
  world_close(w);
}

/* Returns after how many steps a falling block touches the floor. */
static int32_t steps_to_contact(int32_t geometry, double origin) {
  const floor_case of = {geometry, origin, -1.0, 0.93, 0.0};
  world w;
  mpm_obstacle *floor = open_on_floor(&w, &of);
  int32_t steps = 1;
  while (!(step_on_floor(&w, floor).normal_force > 0.0) && steps < 200) ++steps;
  close_on_floor(&w, floor);
  return steps;
}

/* The half-width of a ring is that of its section, wherever the axis is. */
START_TEST(rings_touch_as_slabs_do) {
  const int32_t slab = steps_to_contact(MPM_PLANE_STRAIN, 0.0);
  ck_assert_int_lt(slab, 200);
  ck_assert_int_gt(slab, 50);
  ck_assert_int_eq(steps_to_contact(MPM_AXISYMMETRIC, 0.0), slab);
  ck_assert_int_eq(steps_to_contact(MPM_AXISYMMETRIC, 40.0), slab);
}
END_TEST

/* Returns the largest force over the area of the face of a block that is pulled off the floor. */
static double adhesion_of(int32_t geometry, double origin) {
  const floor_case of = {geometry, origin, 0.02, 1.0, 50.0};
  world w;
  mpm_obstacle *floor = open_on_floor(&w, &of);
  double most = 0.0;
  for (int32_t k = 0; k < 40; ++k) most = fmax(most, fabs(step_on_floor(&w, floor).force[1]));
  close_on_floor(&w, floor);
  const double end = origin + 0.75, slab = 0.75, ring = 0.5 * (end * end - origin * origin);
  return most / (geometry == MPM_AXISYMMETRIC ? ring : slab);
}

START_TEST(adhesion_goes_by_the_area) {
  const double slab = adhesion_of(MPM_PLANE_STRAIN, 0.0);
  show("adhesion %g, %g, %g\n", slab, adhesion_of(MPM_AXISYMMETRIC, 0.0),
       adhesion_of(MPM_AXISYMMETRIC, 40.0));
  ck_between("slab", slab, 30.0, 50.001);
  ck_within("rings", adhesion_of(MPM_AXISYMMETRIC, 0.0), slab, 0.08 * slab);
  ck_within("wide rings", adhesion_of(MPM_AXISYMMETRIC, 40.0), slab, 0.01 * slab);
}
END_TEST

/* Rings keep their section as the field "size" while they move along the radius; begun anew, it is as F has
 * stretched it. */
START_TEST(sections_stay) {
  world w;
  world_desc desc = rings(12, 0.25);
  desc.law.model = "linear_elastic";
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.5, 1.0}, high[] = {1.0, 1.5};
  const int64_t n = world_fill(&w, set, low, high, 2);
  for (int32_t k = 0; k < 20; ++k) step_with(&w, 5e-3, grow);
  double *size = fetch(&w, set, "size", 2), *F = fetch(&w, set, "deformation_gradient", 9);
  for (int64_t i = 0; i < 2 * n; ++i) ck_within("as filled", size[i], 0.125, 1e-15);
  ck_ok(&w, mpm_particles_reset_reference(set));
  free(size);
  size = fetch(&w, set, "size", 2);
  for (int64_t p = 0; p < n; ++p) {
    ck_within("begun anew", size[p], 0.125 * F[p], 1e-14);
    ck_within("begun anew", size[n + p], 0.125 * F[4 * n + p], 1e-14);
  }
  free(size);
  free(F);
  world_close(&w);
}
END_TEST

/* Where two bodies meet face to face along the axis, nothing pushes them along the radius. */
START_TEST(normals_do_not_lean) {
  world w;
  const world_desc desc = rings(12, 0.25);
  mpm_particles *set[2] = {world_open(&w, &desc), world_add_set(&w, NULL)};
  mpm_contact_desc d;
  ck_ok(&w, mpm_contact_desc_init(&d, sizeof d));
  d.normal = MPM_NORMAL_GRADIENT;
  for (int32_t m = 0; m < 2; ++m) {
    const double low[] = {0.0, 0.75 + 0.75 * m}, high[] = {1.0, 1.5 + 0.75 * m}, v[] = {0.0, m ? -1.0 : 1.0};
    world_fill(&w, set[m], low, high, 2);
    ck_ok(&w, mpm_particles_set_all(set[m], "velocity", MPM_F64, 2, v));
    ck_ok(&w, mpm_stepper_set_body(w.stepper, set[m], m));
  }
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 1, &d));
  world_step(&w, 1e-3);
  mpm_contact_info info = {.struct_size = sizeof info};
  ck_ok(&w, mpm_stepper_contact_info(w.stepper, 0, 1, &info));
  ck_holds(info.normal_force > 0.0);
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(set[m]);
    double *v = fetch(&w, set[m], "velocity", 2), *x = fetch(&w, set[m], "position", 2);
    for (int64_t p = 0; p < n; ++p)
      if (x[p] < 0.25) ck_within("radial velocity", v[p], 0.0, 1e-12); /* the rim is round */
    free(v);
    free(x);
  }
  world_close(&w);
}
END_TEST

/* ---- refusals ------------------------------------------------------------------------------------------ */
START_TEST(refusals) {
  mpm_context *c = context_with(1, 0, NULL);
  mpm_grid *grid;
  mpm_stepper *s;
  mpm_grid_desc d = grid_desc(3, 8, 0.25);
  d.geometry = MPM_AXISYMMETRIC;
  ck_refused(c, mpm_grid_create(c, &d, &grid), MPM_E_UNSUPPORTED, "is for dim 2");
  d.dim = 2;
  d.periodic[0] = 1;
  ck_refused(c, mpm_grid_create(c, &d, &grid), MPM_E_UNSUPPORTED, "periodic[0] = 0");
  d.periodic[0] = 0;
  d.origin[0] = -0.25;
  ck_refused(c, mpm_grid_create(c, &d, &grid), MPM_E_ARG, "origin[0] is -0.25");
  d.origin[0] = 1e-17;
  ck_refused(c, mpm_grid_create(c, &d, &grid), MPM_E_ARG, "is nearly the axis");
  d.origin[0] = 0.0;
  ck_ok(c, mpm_grid_create(c, &d, &grid));
  mpm_stepper_desc of = stepper_desc();
  of.gravity[0] = 1.0;
  ck_refused(c, mpm_stepper_create(c, grid, &of, &s), MPM_E_UNSUPPORTED, "gravity[0] is 1");
  of.gravity[0] = 0.0;
  of.transfer = MPM_APIC_MLS;
  ck_refused(c, mpm_stepper_create(c, grid, &of, &s), MPM_E_UNSUPPORTED, "use MPM_APIC");
  of.transfer = MPM_APIC;
  ck_ok(c, mpm_stepper_create(c, grid, &of, &s));
  ck_refused(c, mpm_stepper_set_wall(s, MPM_X_MIN, MPM_WALL_FIXED, 0.0), MPM_E_UNSUPPORTED, "is the axis");
  ck_ok(c, mpm_stepper_set_wall(s, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  ck_ok(c, mpm_stepper_set_wall(s, MPM_X_MAX, MPM_WALL_FIXED, 0.0));
  ck_ok(c, mpm_stepper_destroy(s));
  ck_ok(c, mpm_grid_destroy(grid));
  d.origin[0] = 1.0; /* of a tube, this face is no axis */
  ck_ok(c, mpm_grid_create(c, &d, &grid));
  ck_ok(c, mpm_stepper_create(c, grid, &of, &s));
  ck_ok(c, mpm_stepper_set_wall(s, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  ck_ok(c, mpm_stepper_destroy(s));
  ck_ok(c, mpm_grid_destroy(grid));
  ck_ok(c, mpm_context_destroy(c));
}
END_TEST

/* A state loads into its own geometry alone. */
START_TEST(states_know_their_geometry) {
  static const struct {
    int32_t from, to;
    const char *why;
  } unlike[] = {{MPM_PLANE_STRAIN, MPM_PLANE_STRESS, "geometry is 0 there, 2 here"},
                {MPM_AXISYMMETRIC, MPM_PLANE_STRAIN, "geometry is 1 there, 0 here"},
                {MPM_PLANE_STRAIN, MPM_AXISYMMETRIC, "\"size\" is here, but not there"}};
  for (int32_t k = 0; k < 3; ++k) {
    world a, b;
    world_desc desc = world_default(2, 8, 0.25);
    desc.grid.geometry = unlike[k].from;
    world_fill_cube(&a, world_open(&a, &desc), 0.7, 1.3);
    const saved_state state = world_save(&a);
    desc.grid.geometry = unlike[k].to;
    world_open(&b, &desc);
    ck_refused(&b, mpm_state_load(b.stepper, state.data, state.bytes), MPM_E_FORMAT, unlike[k].why);
    free(state.data);
    world_close(&a);
    world_close(&b);
  }
}
END_TEST

/* A state in which rings lack their sections is damaged. */
START_TEST(states_have_sections) {
  world w;
  const world_desc desc = rings(8, 0.25);
  world_fill_cube(&w, world_open(&w, &desc), 0.7, 1.3);
  const saved_state state = world_save(&w);
  int32_t changed = 0;
  for (int64_t at = 0; at + (int64_t)sizeof(mpmi_state_field) <= state.bytes; at += 8) {
    mpmi_state_field field;
    memcpy(&field, state.data + at, sizeof field);
    if (memcmp(field.name, "size", 5)) continue;
    memset(state.data + at + offsetof(mpmi_state_field, present), 0, sizeof field.present);
    ++changed;
  }
  ck_assert_int_eq(changed, 1);
  seal_state(state.data, MPMI_STATE_FORMAT, state.bytes);
  ck_refused(&w, mpm_state_load(w.stepper, state.data, state.bytes), MPM_E_FORMAT,
             "\"size\" is here, but not there");
  free(state.data);
  world_close(&w);
}
END_TEST

Suite *rings_suite(void);
Suite *rings_suite(void) {
  Suite *suite = suite_create("rings");
  TCase *parts = tcase_create("parts");
  if (!list) list = list_combinations(&listed);
  tcase_add_test(parts, fills_have_their_mass);
  tcase_add_loop_test(parts, stretches_of_a_sphere, 0, BROAD);
  tcase_add_loop_test(parts, forces_do_the_power_of_stresses, 0, BROAD);
  tcase_add_loop_test(parts, uniform_stress_has_no_force, 0, BROAD);
  tcase_add_loop_test(parts, pressure_on_a_ring, 0, BROAD);
  tcase_add_test(parts, areas_follow_the_ring);
  tcase_add_test(parts, rings_touch_as_slabs_do);
  tcase_add_test(parts, normals_do_not_lean);
  tcase_add_test(parts, adhesion_goes_by_the_area);
  tcase_add_test(parts, sections_stay);
  tcase_add_test(parts, refusals);
  tcase_add_test(parts, states_know_their_geometry);
  tcase_add_test(parts, states_have_sections);
  suite_add_tcase(suite, parts);
  TCase *implicit = tcase_create("implicit");
  tcase_add_loop_test(implicit, tangents_of_rings, 0, 6 * BASES);
  tcase_add_loop_test(implicit, implicit_threads, 0, 2 * BASES);
  suite_add_tcase(suite, implicit);
  TCase *all = tcase_create("combinations");
  tcase_add_loop_test(all, combination_works, 0, listed);
  tcase_set_timeout(all, 60);
  suite_add_tcase(suite, all);
  return suite;
}
