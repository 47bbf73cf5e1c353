#include "body.h"

const double body_E = 5e4, body_nu = 0.3, body_density = 1e3;
const double body_spacing[3] = {0.1, 0.11, 0.09}, body_origin[3] = {-0.3, 0.2, 0.1};
const int64_t body_cells[3][3] = {{142}, {38, 18}, {11, 11, 7}};
static const double speed = 17.5; /* about 0.18 cells in a step */

/* ---- callbacks ---- */

static mpm_status add_force(void *user, const mpm_particle_batch *b, double *add) {
  const void *heat;
  int64_t stride;
  (void)user;
  if (mpm_batch_field(b->lookup, "heat", &heat, &stride)) return -1;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t p = 0; p < b->n; ++p) add[c * b->ld + p] += b->mass[p] * ((const double *)heat)[p];
  return 0;
}

static mpm_status add_acceleration(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) add[p] += 1.0 + 20.0 * b->t - 0.1 * b->velocity[p];
  return 0;
}

/* Holds the x component of one node in 16. */
static mpm_status hold_some(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    if (b->index[i] % 16 != 5) continue;
    prescribed[i] = 1;
    velocity[i] = 0.9 * speed;
  }
  return 0;
}

/* Particles of set 1 slow down where they are led, soon across the walls. */
static mpm_status lead(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t p = 0; p < b->n; ++p) add[c * b->ld + p] += (c ? 0.8 : 0.999) * b->velocity[c * b->ld + p];
  return 0;
}

static mpm_status hook(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    if (b->index[i] % 5 == 0) velocity[i] *= 0.999;
    force[(b->dim - 1) * b->ld + i] += 0.5 * b->mass[i] * b->position[i];
  }
  return 0;
}

/* ---- the body ---- */
/* Gives the first cell and the number of cells on each axis. */
static void extent(const body_desc *o, int64_t *first, int64_t *count) {
  static const int64_t cells[2][3][3][2] = {
      {{{0, 140}}, {{10, 26}, {0, 18}}, {{4, 5}, {0, 8}, {0, 7}}},
      {{{0, 1750}}, {{15, 66}, {0, 66}}, {{4, 10}, {0, 13}, {0, 13}}},
  };
  for (int32_t k = 0; k < o->dim; ++k) {
    first[k] = cells[o->large != 0][o->dim - 1][k][0];
    count[k] = cells[o->large != 0][o->dim - 1][k][1];
  }
}

static void place(const body_desc *o, const int64_t *cell, int64_t id, double *x, double *v) {
  for (int32_t k = 0; k < o->dim; ++k) {
    const uint64_t seed = (uint64_t)(6 * id + 2 * k);
    x[k] = body_origin[k] + body_spacing[k] * ((double)cell[k] + 0.5 + 0.3 * noise_at(seed));
    v[k] = speed * ((k == 0 ? 1.0 : k == 1 ? -0.1 : 0.05) + 0.01 * noise_at(seed + 1));
  }
}

/* Every other cell has a particle (1-D: every cell); every third of them is in set 1. */
static mpm_status add_particles(world *w, int32_t m) {
  const body_desc *o = &w->desc.body;
  int64_t first[3] = {0, 0, 0}, count[3] = {1, 1, 1}, n = 0, cells = 1, number = 0;
  if (o->empty) return MPM_OK;
  extent(o, first, count);
  double volume = 1.0;
  for (int32_t k = 0; k < o->dim; ++k) {
    cells *= count[k];
    volume *= body_spacing[k];
  }
  double(*at)[3] = malloc((size_t)cells * sizeof *at), (*v)[3] = malloc((size_t)cells * sizeof *v);
  int64_t *ids = malloc((size_t)cells * sizeof *ids);
  for (int64_t i = 0; i < cells; ++i) {
    const int64_t cell[3] = {first[0] + i % count[0], first[1] + i / count[0] % count[1],
                             first[2] + i / count[0] / count[1]};
    if (o->dim > 1 && (cell[0] + cell[1] + cell[2]) % 2) continue;
    if ((number++ % 3 == 1) != m) continue;
    ids[n] = 3 * i + 1;
    place(o, cell, ids[n], at[n], v[n]);
    ++n;
  }
  for (int64_t i = n - 1; o->shuffled && i > 0; --i) {
    const int64_t other = (int64_t)(mixed((uint64_t)i) % (uint64_t)(i + 1));
    double swap[3];
    const int64_t id = ids[i];
    ids[i] = ids[other], ids[other] = id;
    memcpy(swap, at[i], sizeof swap), memcpy(at[i], at[other], sizeof swap),
        memcpy(at[other], swap, sizeof swap);
    memcpy(swap, v[i], sizeof swap), memcpy(v[i], v[other], sizeof swap), memcpy(v[other], swap, sizeof swap);
  }
  double *position = malloc((size_t)(10 * n) * sizeof *position), *velocity = position + 3 * n;
  double *size = position + 7 * n; /* of domains: a share of the cell */
  mpm_status status = MPM_OK;
  /* a shuffled body is added in two portions */
  for (int64_t begin = 0, part; begin < n && !status; begin += part) {
    part = o->shuffled && begin == 0 ? n / 3 : n - begin;
    for (int64_t i = 0; i < part; ++i) {
      for (int32_t k = 0; k < o->dim; ++k) {
        position[k * part + i] = at[begin + i][k];
        velocity[k * part + i] = v[begin + i][k];
        size[k * part + i] = 0.7 * body_spacing[k];
      }
      position[6 * n + i] = volume;
    }
    status = mpm_particles_add(w->set[m], part, position, velocity, position + 6 * n,
                               is_gimp(o->method.basis) ? size : NULL, ids + begin, NULL);
  }
  free(position);
  free(ids);
  free(v);
  free(at);
  return status;
}

static mpm_status add_heat(world *w, int32_t m) {
  return mpm_particles_add_field(w->set[m], "heat", MPM_F64, 1);
}

static mpm_status set_heat(world *w, int32_t m) {
  const int64_t n = mpm_particles_count(w->set[m]);
  double *heat = malloc((size_t)n * sizeof *heat + 1);
  for (int64_t i = 0; i < n; ++i) heat[i] = 3.0 * noise_at((uint64_t)(100 + i));
  const mpm_status status = mpm_particles_set(w->set[m], "heat", MPM_F64, 1, n, NULL, heat);
  free(heat);
  return status;
}

/* One particle in eight of set 1 is prescribed, on one axis or on all. */
static mpm_status set_prescribed(world *w) {
  if (!w->desc.body.led) return MPM_OK;
  const int64_t n = mpm_particles_count(w->set[1]);
  uint8_t *flags = malloc((size_t)(n * w->desc.body.dim) + 1);
  for (int64_t i = 0; i < n * w->desc.body.dim; ++i)
    flags[i] = i % n % 8 == 3 && (i % n % 16 == 3 || i / n == i % n % w->desc.body.dim);
  const mpm_status status =
      mpm_particles_set(w->set[1], "prescribed", MPM_U8, w->desc.body.dim, n, NULL, flags);
  free(flags);
  return status;
}

static mpm_status set_walls(world *w) {
  const body_desc *o = &w->desc.body;
  mpm_status status = MPM_OK;
  if (!o->periodic) {
    status = mpm_stepper_set_wall(w->stepper, MPM_X_MAX, MPM_WALL_OPEN, 0.0);
    if (!status && o->dim == 1) status = mpm_stepper_set_wall(w->stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0);
  }
  const int32_t implicit = o->method.scheme == MPM_NEWMARK;
  if (!status && o->dim > 1)
    status = mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, implicit ? MPM_WALL_SLIP : MPM_WALL_FRICTION, 0.3);
  if (!status && o->dim == 2) status = mpm_stepper_set_wall(w->stepper, MPM_Y_MAX, MPM_WALL_SLIP, 0.0);
  if (!status && o->dim == 3) status = mpm_stepper_set_wall(w->stepper, MPM_Z_MIN, MPM_WALL_SLIP, 0.0);
  if (!status && o->dim == 3) status = mpm_stepper_set_wall(w->stepper, MPM_Z_MAX, MPM_WALL_FIXED, 0.0);
  return status;
}

static mpm_status set_callbacks(world *w) {
  mpm_status status = mpm_stepper_set_force(w->stepper, add_force, NULL);
  if (!status) status = mpm_stepper_set_acceleration(w->stepper, add_acceleration, NULL);
  if (!status && w->desc.body.velocity_bc) status = mpm_stepper_set_velocity_bc(w->stepper, hold_some, NULL);
  const int32_t hooks = w->desc.body.led && w->desc.body.method.scheme != MPM_NEWMARK;
  for (int32_t stage = MPM_AFTER_P2G; stage <= MPM_AFTER_VELOCITY && hooks && !status; ++stage)
    status = mpm_stepper_set_node_hook(w->stepper, stage, hook, NULL);
  if (!status && w->desc.body.led) status = mpm_stepper_set_motion(w->stepper, w->set[1], lead, NULL);
  return status;
}

/* ---- the world ---- */
world_desc world_of_body(const body_desc *of) {
  static const fill_fn fill[] = {add_heat, add_particles, set_heat, NULL};
  static const equip_fn equip[] = {set_walls, set_prescribed, set_callbacks, NULL};
  int64_t first[3], count[3];
  method how = of->method;
  world_desc d = world_default(of->dim, 1, 1.0);
  if (!(how.flip > 0.0)) how.flip = 1.0;
  world_use(&d, &how);
  extent(of, first, count);
  for (int32_t k = 0; k < of->dim; ++k) {
    d.grid.origin[k] = body_origin[k];
    d.grid.spacing[k] = body_spacing[k];
    d.grid.cells[k] = first[k] + count[k];
  }
  d.grid.cells[0] += 2; /* the body soon crosses these and leaves */
  if (of->dim == 3) d.grid.cells[1] += 3;
  d.grid.periodic[0] = of->periodic;
  memcpy(d.stepper.gravity, (const double[]){2.0, -10.0, 1.0}, sizeof d.stepper.gravity);
  d.context.concurrency = of->concurrency ? of->concurrency : 1;
  d.context.isa = of->isa;
  d.random_order = of->random_order;
  d.law = (world_law){.model = "neo_hookean", .E = body_E, .nu = body_nu, .density = body_density};
  d.other_law = d.law;
  d.other_law.model = of->stress ? NULL : "j2";
  d.other_law.yield_stress = 1e3;
  d.other_law.hardening = 1e4;
  d.other_law.stress = of->stress;
  d.other_law.state_count = 1;
  d.sets = 2;
  d.dt = BODY_DT;
  d.fill = fill;
  d.equip = equip;
  d.body = *of;
  return d;
}

void body_open(world *w, const body_desc *of) {
  const world_desc d = world_of_body(of);
  world_open(w, &d);
}

mpm_stepper_desc body_stepper(const world *w) {
  mpm_stepper_desc d = stepper_desc();
  d.scheme = w->desc.stepper.scheme;
  d.transfer = w->desc.stepper.transfer;
  return d;
}

void body_calm(world *w) {
  const mpm_stepper_desc d = body_stepper(w);
  ck_ok(w, mpm_stepper_configure(w->stepper, &d));
  ck_ok(w, mpm_stepper_set_force(w->stepper, NULL, NULL));
  ck_ok(w, mpm_stepper_set_acceleration(w->stepper, NULL, NULL));
  ck_ok(w, mpm_stepper_set_velocity_bc(w->stepper, NULL, NULL));
  world_walls(w, MPM_WALL_NONE, 0.0);
}

mpm_status host_neo_hookean(void *user, const mpm_material_batch *b) {
  static const int32_t row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
  const double mu = body_E / (2.0 * (1.0 + body_nu)), lambda = 2.0 * mu * body_nu / (1.0 - 2.0 * body_nu);
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    double F[9];
    for (int32_t e = 0; e < 9; ++e) F[e] = b->F[e * b->ld + i];
    const double J = determinant(F);
    double trace = 0.0;
    for (int32_t c = 0; c < 6; ++c) {
      const double *a = F + 3 * row[c], *d = F + 3 * column[c];
      const double unit = c < 3 ? 1.0 : 0.0, left = a[0] * d[0] + a[1] * d[1] + a[2] * d[2];
      b->stress_new[c * b->ld + i] = (lambda * log(J) * unit + mu * (left - unit)) / J;
      if (c < 3) trace += left;
    }
    b->wave_speed[i] = sqrt((lambda + 2.0 * mu) / body_density);
    b->energy[i] = 0.5 * lambda * log(J) * log(J) - mu * log(J) + 0.5 * mu * (trace - 3.0);
    if (b->state_count) b->state_new[i] = J;
  }
  return 0;
}
