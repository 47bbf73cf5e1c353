/* Setting up a scene: a body of at least four blocks (1-D: two) that soon meets the upper walls. */
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double spacing[3] = {0.1, 0.11, 0.09}, origin[3] = {-0.3, 0.2, 0.1};

/* Returns where the grid begins: with rings at the axis. */
static double corner(const scene *is, int32_t axis) {
  return is->geometry == MPM_AXISYMMETRIC && axis == 0 ? 0.0 : origin[axis];
}

static const double speed = 10.0, explicit_dt = 1.6e-3, implicit_dt = 4e-3; /* 0.16 and 0.4 cells */

void must_be_ok(const world *w, mpm_status status, const char *call) {
  if (!status) return;
  if (status == MPM_E_UNSUPPORTED && w->how && w->how->refusal)
    snprintf(w->how->refusal, REFUSAL, "%s", mpm_last_error(w->context));
  else
    fprintf(stderr, "%s: %s: %s: %s\n", w->is->name, call, mpm_status_name(status),
            mpm_last_error(w->context));
  give_up();
}

/* The body: first cell, cells, and the cells of the grid on each axis. It stands across the edge of blocks,
 * and where an axis is periodic, across the seam. */
static void extent(const scene *is, int64_t *first, int64_t *count, int64_t *cells) {
  static const int64_t body[3][3][3] = {
      {{58, 20, 80}}, {{12, 7, 24}, {13, 7, 20}}, {{4, 3, 10}, {5, 3, 8}, {5, 3, 8}}};
  static const int64_t large[3] = {40, 19, 6}, seam[3][2] = {{120, 132}, {30, 36}, {11, 13}};
  for (int32_t k = 0; k < is->dim; ++k) {
    const int64_t *b = body[is->dim - 1][k];
    /* implicit steps in 3-D are dear: a smaller body */
    count[k] = is->large ? large[is->dim - 1]
                         : b[1] - (is->dim == 3 && is->scheme == MPM_NEWMARK && !is->quasi_static);
    cells[k] = b[2];
    first[k] = b[0] + b[1] - count[k];
    if (k == 0 && is->quasi_static) first[k] = cells[k] - count[k];
    if (first[k] < 0) first[k] = 0;
    if (k == 0 && is->wall[MPM_X_MAX] == MPM_WALL_OPEN) cells[k] = first[k] + count[k] + 1;
    if (!is->periodic[k]) continue;
    first[k] = seam[is->dim - 1][0];
    cells[k] = seam[is->dim - 1][1];
  }
}

static mpm_grid_desc describe_grid(const scene *is) {
  int64_t first[3], count[3];
  mpm_grid_desc d;
  mpm_grid_desc_init(&d, sizeof d);
  d.dim = is->dim;
  d.geometry = is->geometry;
  d.total_lagrangian = is->total;
  d.basis = is->basis;
  d.boundary_basis = is->boundary;
  d.smoothing = is->smoothing;
  extent(is, first, count, d.cells);
  for (int32_t k = 0; k < is->dim; ++k) {
    d.origin[k] = corner(is, k);
    d.spacing[k] = spacing[k];
    d.periodic[k] = is->periodic[k];
  }
  return d;
}

mpm_stepper_desc describe_stepper(const scene *is) {
  mpm_stepper_desc d;
  mpm_stepper_desc_init(&d, sizeof d);
  d.scheme = is->scheme;
  d.quasi_static = is->quasi_static;
  d.transfer = is->transfer;
  d.xpic_order = is->xpic_order;
  d.xpic_every = is->xpic_every;
  d.flip = is->flip;
  d.pic_damping = is->pic_damping;
  d.position_order = is->position_order;
  d.staggered = is->staggered;
  d.projected_positions = is->projected;
  d.mass_damping = is->damped ? 20.0 : 0.0;
  d.local_damping = is->damped && is->scheme != MPM_NEWMARK ? 0.1 : 0.0;
  d.locking_remedy = is->remedy;
  d.reference_positions = is->reference;
  d.boundary_zero_acceleration = is->zero_acceleration;
  d.linear_solver = is->solver;
  const double weight = is->quasi_static ? 0.2 : 1.0;
  d.gravity[0] = is->geometry == MPM_AXISYMMETRIC ? 0.0 : 20.0 * weight;
  d.gravity[1] = -30.0 * weight;
  d.gravity[2] = 10.0 * weight;
  return d;
}

int32_t is_offered(const scene *is) {
  world w = {.is = is};
  const mpm_grid_desc g = describe_grid(is);
  const mpm_stepper_desc s = describe_stepper(is);
  must(&w, mpm_context_create(NULL, &w.context));
  mpm_status status = mpm_grid_create(w.context, &g, &w.grid);
  if (!status) status = mpm_stepper_create(w.context, w.grid, &s, &w.stepper);
  if (status != MPM_E_UNSUPPORTED) must(&w, status);
  close_world(&w);
  return !status;
}

static void make_material(world *w, int32_t m) {
  static const mpm_param solid[] = {
      {"E", 3e5}, {"nu", 0.3}, {"density", 1e3}, {"yield_stress", 8e3}, {"hardening", 5e4}};
  static const mpm_param decoupled[] = {{"mu", 1.2e5}, {"kappa", 2.4e5}, {"density", 1e3}};
  static const mpm_param fluid[] = {
      {"density", 1e3}, {"bulk_modulus", 3e5}, {"gamma", 7.0}, {"tension", 1.0}, {"viscosity", 60.0}};
  static const mpm_param soil[] = {{"E", 3e5},   {"nu", 0.3},       {"density", 1e3},  {"phi", 30.0},
                                   {"psi", 5.0}, {"cohesion", 8e3}, {"hardening", 5e4}};
  static const mpm_param mud[] = {{"density", 1e3},     {"bulk_modulus", 3e5},  {"shear_modulus", 1e5},
                                  {"yield_shear", 3e3}, {"consistency", 100.0}, {"n", 0.6}};
  static const mpm_param grains[] = {
      {"E", 3e5},    {"nu", 0.3},  {"density", 1e3},         {"mu_s", 0.4},
      {"mu_2", 0.7}, {"I_0", 0.3}, {"grain_diameter", 0.01}, {"grain_density", 2.5e3}};
  static const mpm_param clay[] = {{"density", 1e3}, {"kappa", 0.02}, {"lambda", 0.12}, {"M", 1.05},
                                   {"mu0", 1e5},     {"p_ref", 4e3},  {"pc0", 6e3}};
  mpm_material **out = &w->material[m];
  switch (w->is->law[m]) {
  case LAW_NEO_HOOKEAN:
    must(w, mpm_material_create(w->context, "neo_hookean", solid, 3, out));
    break;
  case LAW_LINEAR_ELASTIC:
    must(w, mpm_material_create(w->context, "linear_elastic", solid, 3, out));
    break;
  case LAW_J2:
    must(w, mpm_material_create(w->context, "j2", solid, 5, out));
    break;
  case LAW_DECOUPLED:
    must(w, mpm_material_create(w->context, "neo_hookean_decoupled", decoupled, 3, out));
    break;
  case LAW_FLUID:
  case LAW_VISCOUS_FLUID:
    must(w,
         mpm_material_create(w->context, "newtonian_fluid", fluid, w->is->law[m] == LAW_FLUID ? 3 : 5, out));
    break;
  case LAW_SOIL:
    must(w, mpm_material_create(w->context, "drucker_prager", soil, 7, out));
    break;
  case LAW_MOHR_COULOMB:
    must(w, mpm_material_create(w->context, "mohr_coulomb", soil, 7, out));
    break;
  case LAW_MUD:
    must(w, mpm_material_create(w->context, "herschel_bulkley", mud, 6, out));
    break;
  case LAW_SNOW:
    must(w, mpm_material_create(w->context, "snow", solid, 3, out));
    break;
  case LAW_GRAINS:
    must(w, mpm_material_create(w->context, "mu_i", grains, 8, out));
    break;
  case LAW_CLAY:
    must(w, mpm_material_create(w->context, "cam_clay", clay, 7, out));
    break;
  case LAW_RIGID:
    must(w, mpm_material_create(w->context, "rigid", fluid, 1, out));
    break;
  default:
    must(w, make_host_law(w->context, w->is->law[m], out));
  }
}

/* Two particles on each axis in a cell, off their lattice but where that is asked for; the body moves, turns,
 * and all of it differs. */
static void place(const scene *is, const int64_t *at, const int64_t *first, int64_t id, double *x,
                  double *v) {
  double middle[3] = {0.0, 0.0, 0.0};
  for (int32_t k = 0; k < is->dim; ++k) {
    const uint64_t seed = (uint64_t)(6 * id + 2 * k);
    const double off = is->lattice ? 0.25 : is->quasi_static ? 0.13 : 0.25 + 0.1 * noise(seed);
    const double cell = (double)first[k] + 0.5 * (double)at[k] + off;
    x[k] = corner(is, k) + spacing[k] * cell;
    middle[k] = 0.1 * (double)at[k] - 0.3;
  }
  const double turn[3] = {0.1 * middle[2] - 0.2 * middle[1], 0.2 * middle[0], -0.1 * middle[0]};
  static const double along[3] = {1.0, 0.2, 0.1};
  const double share = is->quasi_static ? 0.0 : speed;
  for (int32_t k = 0; k < is->dim; ++k)
    v[k] = share * (along[k] + turn[k] + 0.01 * noise((uint64_t)(6 * id + 2 * k + 1)));
}

void sum_parts(world *w, int64_t count, int64_t *values) {
  const mpm_transport *between = w->how->transport;
  if (between) must(w, between->reduce(between->user, MPM_REDUCE_SUM, count, values));
}

/* Particles of this part are a range of the list: the parts one after the other have them as one part has. */
static void add_particles(world *w, int32_t m) {
  const scene *is = w->is;
  int64_t first[3], cells[3], count[3] = {1, 1, 1}, all = 1, n = 0;
  double volume = 1.0;
  extent(is, first, count, cells);
  for (int32_t k = 0; k < is->dim; ++k) {
    volume *= 0.5 * spacing[k];
    count[k] *= 2;
    all *= count[k];
  }
  double *memory = calloc((size_t)(16 * all), sizeof *memory);
  int64_t *ids = calloc((size_t)all, sizeof *ids);
  if (!memory || !ids) exit(1);
  double *at = memory, *speeds = memory + 3 * all, *x = memory + 6 * all, *v = memory + 9 * all;
  double *size = memory + 12 * all, *volumes = memory + 15 * all;
  const mpm_transport *between = w->how->transport;
  int64_t *const whole = &w->all[m];
  for (int64_t i = 0; i < all; ++i) {
    const int64_t cell[3] = {i % count[0], i / count[0] % count[1], i / count[0] / count[1]};
    const int32_t second = is->with & WITH_BODIES ? 2 * cell[0] >= count[0] : i % 3 == 1;
    if (is->law[1] && second != m) continue; /* side by side, or both everywhere */
    ids[*whole] = 2 * i + 1;
    place(is, cell, first, ids[*whole], &at[3 * *whole], &speeds[3 * *whole]);
    ++*whole;
  }
  const int64_t from = between ? *whole * between->part / between->parts : 0;
  n = (between ? *whole * (between->part + 1) / between->parts : *whole) - from;
  w->first[m] = from;
  ids += from, at += 3 * from, speeds += 3 * from;
  for (int64_t i = 0; i < n; ++i) {
    volumes[i] = volume * (1.0 + 0.05 * noise((uint64_t)(7000 + ids[i])));
    for (int32_t k = 0; k < is->dim; ++k) {
      x[k * n + i] = at[3 * i + k];
      v[k * n + i] = speeds[3 * i + k];
      size[k * n + i] = 0.5 * spacing[k];
    }
  }
  const int32_t sized = is->basis >= MPM_GIMP && !(is->with & WITH_SPARE_SIZE);
  must(w, mpm_particles_add(w->set[m], n, x, v, volumes, sized ? size : NULL, ids, NULL));
  free(memory);
  free(ids - from);
}

static void set_fields(world *w, int32_t m) {
  const int32_t with = w->is->with, dim = w->is->dim, last = w->is->law[1] ? 1 : 0;
  const int64_t n = mpm_particles_count(w->set[m]);
  static const double zeros[9];
  double *value = calloc((size_t)(3 * n + 1), sizeof *value);
  uint8_t *flags = calloc((size_t)(3 * n + 1), 1);
  if (!value || !flags) exit(1);
  const int64_t from = w->first[m], all = w->all[m];
  for (int64_t i = 0; i < 3 * n; ++i) value[i] = 40.0 * noise((uint64_t)(900 + i / n * all + from + i % n));
  must(w, mpm_particles_set(w->set[m], "heat", MPM_F64, 1, n, NULL, value));
  static const double pressure[6] = {-4e3, -4e3, -4e3, 0.0, 0.0, 0.0};
  if (w->is->law[m] == LAW_CLAY) must(w, mpm_particles_set_all(w->set[m], "stress", MPM_F64, 6, pressure));
  if (with & WITH_APPLIED_FORCE)
    must(w, mpm_particles_set(w->set[m], "applied_force", MPM_F64, dim, n, NULL, value));
  if (with & WITH_KEPT) {
    must(w, mpm_particles_set_all(w->set[m], "acceleration", MPM_F64, dim, zeros));
    must(w, mpm_particles_set_all(w->set[m], "velocity_gradient", MPM_F64, 9, zeros));
  }
  for (int64_t i = 0; i < n * dim; ++i) { /* one particle in eight, on one axis or all */
    const int64_t p = from + i % n;
    flags[i] = p % 8 == 3 && (p % 16 == 3 || i / n == p % dim);
  }
  if (with & WITH_PRESCRIBED && m == last)
    must(w, mpm_particles_set(w->set[m], "prescribed", MPM_U8, dim, n, NULL, flags));
  free(value);
  free(flags);
}

/* They stand at the upper ends of the body, which moves there: a fixed plane, a driven box and a free ball;
 * in 1-D planes, of which the material is inside. */
static void add_obstacles(world *w) {
  const scene *is = w->is;
  int64_t first[3], count[3], cells[3];
  mpm_contact_desc rule;
  extent(is, first, count, cells);
  must(w, mpm_contact_desc_init(&rule, sizeof rule));
  rule.friction = 0.3;
  for (int32_t i = 0; i < 3; ++i) {
    static const int32_t shapes[3] = {MPM_SHAPE_PLANE, MPM_SHAPE_BOX, MPM_SHAPE_SPHERE};
    const int32_t end = is->dim == 1 ? 0 : i % is->dim ? i % is->dim : i ? 1 : 0; /* the axis */
    mpm_obstacle_desc d;
    must(w, mpm_obstacle_desc_init(&d, sizeof d));
    d.contact = &rule;
    d.shape = is->dim == 1 ? MPM_SHAPE_PLANE : shapes[i];
    d.motion = MPM_MOTION_FIXED + i;
    if (is->scheme == MPM_NEWMARK && i == 2) d.motion = MPM_MOTION_PRESCRIBED;
    d.inside = is->dim == 1;
    for (int32_t c = 0; c < is->dim; ++c)
      d.position[c] = corner(is, c) + spacing[c] * ((double)first[c] + 0.5 * (double)count[c]);
    d.position[end] += spacing[end] * (0.5 * (double)count[end] + (end ? 0.02 : 1.4));
    for (int32_t c = 0; c < 3; ++c) d.size[c] = spacing[end];
    if (d.shape == MPM_SHAPE_PLANE && is->dim > 1) d.orientation[0] = d.orientation[3] = sqrt(0.5);
    if (d.shape != MPM_SHAPE_PLANE) d.position[end] += spacing[end];
    if (is->dim == 2 && i) d.position[0] += (i == 1 ? -2.0 : 2.0) * spacing[0];
    if (i) d.velocity[end] = -0.1 * speed;
    if (i && is->dim > 1) d.angular_velocity[2] = 0.2;
    d.mass = 50.0;
    for (int32_t c = 0; c < 3; ++c) d.inertia[4 * c] = 0.1 * (1.0 + c);
    must(w, mpm_obstacle_create(w->context, &d, &w->obstacle[i]));
    must(w, mpm_stepper_add_obstacle(w->stepper, w->obstacle[i]));
  }
}

/* Markers on the upper end of the body along the last axis, where nodes without mass are near. */
static void add_surface(world *w, int32_t empty) {
  const scene *is = w->is;
  const int32_t up = is->dim - 1;
  int64_t first[3], count[3], cells[3];
  mpm_surface_desc d;
  extent(is, first, count, cells);
  must(w, mpm_surface_desc_init(&d, sizeof d));
  d.pressure = 2e4;
  d.traction[0] = 1e3;
  d.dead_traction[up] = -1e3;
  d.max_spacing = 0.6 * spacing[0];
  if (is->with & (WITH_HOLDING | WITH_SLIDING)) {
    d.prescribes = is->with & WITH_HOLDING ? MPM_PRESCRIBES_VELOCITY : MPM_PRESCRIBES_NORMAL;
    d.velocity[0] = is->quasi_static ? 0.5 : (is->dim > 1 ? 0.9 : 0.5) * speed;
    d.velocity[up] += is->dim > 1 ? -0.5 : 0.0;
  }
  must(w, mpm_surface_create(w->context, w->grid, &d, &w->surface));
  for (int32_t i = 0; i < 6 && !empty; ++i) {
    double x[3], a[3] = {0.0, 0.0, 0.0};
    for (int32_t c = 0; c < is->dim; ++c)
      x[c] = corner(is, c) + spacing[c] * ((double)first[c] + 0.5 + 0.15 * i);
    x[up] = corner(is, up) + spacing[up] * ((double)(first[up] + count[up]) - 0.1);
    a[up] = 0.5 * spacing[0];
    if (is->dim > 1 && is->with & WITH_SLIDING) a[0] = 0.1 * (i - 2) * spacing[0];
    must(w, mpm_surface_add(w->surface, 1, x, a, NULL));
  }
  must(w, mpm_stepper_add_surface(w->stepper, w->surface));
}

static void add_adaption(world *w) {
  mpm_adaption_desc d;
  must(w, mpm_adaption_desc_init(&d, sizeof d));
  d.every = 2;
  d.split_edge = 0.45;
  d.min_per_cell = 2;
  d.max_per_cell = 5;
  d.merge_distance = 0.6;
  d.merge_tolerance = 0.5;
  must(w, mpm_particles_set_extensive(w->set[0], "heat", 1));
  must(w, mpm_stepper_set_adaption(w->stepper, w->set[0], &d));
}

/* Where the law and the geometry have no expansion, there is none. */
static void add_heat(world *w, const scene *is) {
  const int32_t implicit = (is->with & WITH_IMPLICIT_HEAT) != 0;
  mpm_heat_desc d;
  must(w, mpm_heat_desc_init(&d, sizeof d));
  d.specific_heat = 3.0;
  d.conductivity = 40.0;
  d.reference_temperature = 10.0;
  for (int32_t m = 0; m < 2; ++m) {
    if (!w->set[m]) continue;
    d.expansion = 1e-4;
    d.dissipated_share = 0.9;
    if (mpm_stepper_set_heat(w->stepper, w->set[m], &d)) {
      d.expansion = d.dissipated_share = 0.0;
      must(w, mpm_stepper_set_heat(w->stepper, w->set[m], &d));
    }
  }
  must(w, mpm_stepper_set_conduction(w->stepper, implicit, 1e-8));
  for (int32_t face = 0; face < 2 * is->dim; face += 3)
    if (!is->periodic[face / 2] && !(face == MPM_X_MIN && is->geometry == MPM_AXISYMMETRIC))
      must(w, mpm_stepper_set_heat_wall(w->stepper, face, MPM_HEAT_WALL_TEMPERATURE, 30.0 + face));
  must(w, mpm_surface_set_heat(w->surface, 5.0, 2.0, 50.0));
}

void open_world(world *w, const scene *is, const errand *how, int32_t empty) {
  const mpm_grid_desc g = describe_grid(is);
  const mpm_stepper_desc s = describe_stepper(is);
  mpm_context_desc c;
  mpm_context_desc_init(&c, sizeof c);
  c.isa = how->isa;
  c.transport = how->transport;
  c.concurrency = is->concurrency;
  *w = (world){.is = is, .how = how, .dt = is->scheme == MPM_NEWMARK ? implicit_dt : explicit_dt};
  mpm_status made = mpm_context_create(&c, &w->context);
  if (made == MPM_E_UNSUPPORTED) { /* a build without threads, which must give the same bits */
    c.concurrency = 1;
    made = mpm_context_create(&c, &w->context);
  }
  must(w, made);
  must(w, mpm_grid_create(w->context, &g, &w->grid));
  must(w, mpm_stepper_create(w->context, w->grid, &s, &w->stepper));
  for (int32_t m = 0; m < 2 && is->law[m]; ++m) {
    make_material(w, m);
    must(w, mpm_particles_create(w->context, w->grid, w->material[m], &w->set[m]));
    must(w, mpm_particles_add_field(w->set[m], "heat", MPM_F64, 1));
    if (!empty) add_particles(w, m);
    if (!empty) set_fields(w, m);
    must(w, mpm_stepper_add(w->stepper, w->set[m]));
    if (is->with & WITH_BODIES) must(w, mpm_stepper_set_body(w->stepper, w->set[m], m));
  }
  if (is->with & WITH_BODIES) {
    mpm_contact_desc contact;
    must(w, mpm_contact_desc_init(&contact, sizeof contact));
    contact.friction = 0.3;
    must(w, mpm_stepper_set_contact(w->stepper, 0, 1, &contact));
  }
  if (is->with & WITH_OBSTACLES) add_obstacles(w);
  if (is->with & WITH_SURFACE) add_surface(w, empty);
  if (is->with & WITH_ADAPTION) add_adaption(w);
  if (is->with & WITH_HEAT) add_heat(w, is);
  for (int32_t face = 0; face < 2 * is->dim; ++face)
    if (!is->periodic[face / 2] && !(face == MPM_X_MIN && is->geometry == MPM_AXISYMMETRIC))
      must(w, mpm_stepper_set_wall(w->stepper, face, is->wall[face],
                                   is->wall[face] >= MPM_WALL_FRICTION ? 0.3 : 0.0));
  set_callbacks(w);
}

void close_world(world *w) {
  must(w, mpm_stepper_destroy(w->stepper));
  for (int32_t i = 0; i < 3; ++i) must(w, mpm_obstacle_destroy(w->obstacle[i]));
  must(w, mpm_surface_destroy(w->surface));
  for (int32_t m = 0; m < 2; ++m) must(w, mpm_particles_destroy(w->set[m]));
  for (int32_t m = 0; m < 2; ++m) must(w, mpm_material_destroy(w->material[m]));
  must(w, mpm_grid_destroy(w->grid));
  mpm_context_destroy(w->context);
}
