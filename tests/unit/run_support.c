#include "run_support.h"
#include "options.h"

#define METHOD(b, s, t, f) .basis = MPM_##b, .scheme = MPM_##s, .transfer = MPM_##t, .flip = f
#define OPEN_KNOTS         .boundary_basis = MPM_BOUNDARY_OPEN_KNOT
const run_method run_methods[RUN_ALL] = {
    {METHOD(BSPLINE2, USL, FLIP, 0.97)},
    {METHOD(BSPLINE2, MUSL, FLIP, 1.0)},
    {METHOD(BSPLINE2, USL, APIC, 1.0)},
    {METHOD(BSPLINE2, MUSL, APIC, 1.0)},
    {METHOD(BSPLINE2, USL, APIC_MLS, 1.0)},
    {METHOD(BSPLINE2, MUSL, APIC_MLS, 1.0)},
    {METHOD(LINEAR, USL, FLIP, 0.97)},
    {METHOD(LINEAR, MUSL, FLIP, 1.0)},
    {METHOD(LINEAR, USL, APIC, 1.0)},
    {METHOD(LINEAR, MUSL, APIC, 1.0)},
    {METHOD(BSPLINE3, USF, FLIP, 0.9), .remedy = 1},
    {METHOD(BSPLINE3, MUSL, TFLIP, 1.0), OPEN_KNOTS, .staggered = 1},
    {METHOD(BSPLINE2, USF, APIC, 1.0), OPEN_KNOTS, .position_order = 2},
    {METHOD(GIMP, USF, XPIC, 1.0), .xpic_order = 3},
    {METHOD(UGIMP, USL, XPIC, 1.0), .xpic_order = 2, .remedy = 1, .staggered = 1},
    {METHOD(CPGIMP, MUSL, AFLIP, 0.95), .remedy = 1, .position_order = 2},
    {METHOD(BSPLINE2, USF, TPIC, 1.0), .staggered = 1},
    {METHOD(BSPLINE3, USL, APIC_MLS, 1.0), .position_order = 2},
    {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0)},
    {METHOD(LINEAR, NEWMARK, FLIP, 1.0), .remedy = 1},
    {METHOD(CPGIMP, NEWMARK, FLIP, 1.0)},
};

const double run_E = 5e4, run_nu = 0.3, run_density = 1e3;
static const double spacing[3] = {0.1, 0.11, 0.09}, origin[3] = {-0.3, 0.2, 0.1};
static const double speed = 17.5; /* about 0.18 cells in a step */

void run_use(run_options *options, const run_method *method) {
  options->basis = method->basis;
  options->scheme = method->scheme;
  options->transfer = method->transfer;
  options->flip = method->flip;
  options->boundary_basis = method->boundary_basis;
  options->xpic_order = method->xpic_order;
  options->position_order = method->position_order;
  options->staggered = method->staggered;
  options->remedy = method->remedy;
}

static uint64_t mixed(uint64_t x) {
  x += UINT64_C(0x9e3779b97f4a7c15);
  x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
  return x ^ x >> 31;
}

double run_noise(uint64_t seed) {
  return (double)(mixed(seed) >> 11) * 0x1p-52 - 1.0;
}

/* ---- the host's services ------------------------------------------------------------------------------- */
static void *counted_alloc(void *user, size_t bytes, size_t alignment) {
  run_memory *m = user;
  if (++m->calls == m->fail_at) return NULL;
  void *memory = aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory) memset(memory, 0xff, bytes);
  m->held += (int64_t)bytes;
  return memory;
}

static void counted_release(void *user, void *memory, size_t bytes, size_t alignment) {
  run_memory *m = user;
  (void)alignment;
  m->held -= (int64_t)bytes;
  free(memory);
}

static mpm_status in_random_order(void *user, int64_t count, mpm_task_fn task, void *task_data) {
  run *r = user;
  int64_t *order = malloc((size_t)count * sizeof *order);
  for (int64_t i = 0; i < count; ++i) {
    const int64_t at = (int64_t)(mixed(r->dice++) % (uint64_t)(i + 1));
    order[i] = order[at];
    order[at] = i;
  }
  for (int64_t i = 0; i < count; ++i) task(task_data, order[i]);
  free(order);
  return 0;
}

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

/* ---- the body ------------------------------------------------------------------------------------------ */
/* First cell and number of cells on each axis. */
static void extent(const run_options *o, int64_t *first, int64_t *count) {
  static const int64_t cells[2][3][3][2] = {
      {{{0, 140}}, {{10, 26}, {0, 18}}, {{4, 5}, {0, 8}, {0, 7}}},
      {{{0, 1750}}, {{15, 66}, {0, 66}}, {{4, 10}, {0, 13}, {0, 13}}},
  };
  for (int32_t k = 0; k < o->dim; ++k) {
    first[k] = cells[o->large != 0][o->dim - 1][k][0];
    count[k] = cells[o->large != 0][o->dim - 1][k][1];
  }
}

static mpm_status make_context(run *r) {
  const run_options *o = &r->options;
  mpm_context_desc d;
  ck_assert_int_eq(mpm_context_desc_init(&d, sizeof d), MPM_OK);
  d.concurrency = o->concurrency ? o->concurrency : 1;
  d.isa = o->isa;
  d.parallel_for = o->own_order ? in_random_order : o->executor;
  d.parallel_user = o->own_order ? r : o->executor_user;
  if (o->memory) {
    d.alloc = counted_alloc;
    d.release = counted_release;
    d.alloc_user = o->memory;
  }
  return mpm_context_create(&d, &r->context);
}

static mpm_status make_grid(run *r) {
  const run_options *o = &r->options;
  int64_t first[3], count[3];
  mpm_grid_desc d;
  ck_assert_int_eq(mpm_grid_desc_init(&d, sizeof d), MPM_OK);
  extent(o, first, count);
  d.dim = o->dim;
  d.basis = o->basis ? o->basis : MPM_BSPLINE2;
  d.boundary_basis = o->boundary_basis;
  d.periodic[0] = o->periodic;
  for (int32_t k = 0; k < o->dim; ++k) {
    d.origin[k] = origin[k];
    d.spacing[k] = spacing[k];
    d.cells[k] = first[k] + count[k];
  }
  d.cells[0] += 2; /* soon crossed */
  if (o->dim == 3) d.cells[1] += 3;
  return mpm_grid_create(r->context, &d, &r->grid);
}

static mpm_status make_material(run *r, int32_t m) {
  const mpm_param params[] = {
      {"E", run_E}, {"nu", run_nu}, {"density", run_density}, {"yield_stress", 1e3}, {"hardening", 1e4}};
  if (m == 0) return mpm_material_create(r->context, "neo_hookean", params, 3, &r->material[0]);
  if (!r->options.stress) return mpm_material_create(r->context, "j2", params, 5, &r->material[1]);
  mpm_material_desc d;
  ck_assert_int_eq(mpm_material_desc_init(&d, sizeof d), MPM_OK);
  d.density = run_density;
  d.state_count = 1;
  d.stress = r->options.stress;
  d.user = r;
  return mpm_material_create_custom(r->context, &d, &r->material[1]);
}

static void place(const run_options *o, const int64_t *cell, int64_t id, double *x, double *v) {
  for (int32_t k = 0; k < o->dim; ++k) {
    const uint64_t seed = (uint64_t)(6 * id + 2 * k);
    x[k] = origin[k] + spacing[k] * ((double)cell[k] + 0.5 + 0.3 * run_noise(seed));
    v[k] = speed * ((k == 0 ? 1.0 : k == 1 ? -0.1 : 0.05) + 0.01 * run_noise(seed + 1));
  }
}

/* Every other cell has a particle (1-D: every cell); every third of them is in set 1. */
static mpm_status add_particles(run *r, int32_t m) {
  const run_options *o = &r->options;
  int64_t first[3] = {0, 0, 0}, count[3] = {1, 1, 1}, n = 0, cells = 1, number = 0;
  if (o->empty) return MPM_OK;
  extent(o, first, count);
  double volume = 1.0;
  for (int32_t k = 0; k < o->dim; ++k) {
    cells *= count[k];
    volume *= spacing[k];
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
  /* in two portions when shuffled */
  for (int64_t begin = 0, part; begin < n && !status; begin += part) {
    part = o->shuffled && begin == 0 ? n / 3 : n - begin;
    for (int64_t i = 0; i < part; ++i) {
      for (int32_t k = 0; k < o->dim; ++k) {
        position[k * part + i] = at[begin + i][k];
        velocity[k * part + i] = v[begin + i][k];
        size[k * part + i] = 0.7 * spacing[k];
      }
      position[6 * n + i] = volume;
    }
    status = mpm_particles_add(r->set[m], part, position, velocity, position + 6 * n,
                               is_gimp(o->basis) ? size : NULL, ids + begin, NULL);
  }
  free(position);
  free(ids);
  free(v);
  free(at);
  return status;
}

static mpm_status set_heat(run *r, int32_t m) {
  const int64_t n = mpm_particles_count(r->set[m]);
  double *heat = malloc((size_t)n * sizeof *heat + 1);
  for (int64_t i = 0; i < n; ++i) heat[i] = 3.0 * run_noise((uint64_t)(100 + i));
  const mpm_status status = mpm_particles_set(r->set[m], "heat", MPM_F64, 1, n, NULL, heat);
  free(heat);
  return status;
}

/* One particle in eight of set 1, on one axis or all. */
static mpm_status set_prescribed(run *r) {
  const int64_t n = mpm_particles_count(r->set[1]);
  uint8_t *flags = malloc((size_t)(n * r->options.dim) + 1);
  for (int64_t i = 0; i < n * r->options.dim; ++i)
    flags[i] = i % n % 8 == 3 && (i % n % 16 == 3 || i / n == i % n % r->options.dim);
  const mpm_status status =
      mpm_particles_set(r->set[1], "prescribed", MPM_U8, r->options.dim, n, NULL, flags);
  free(flags);
  return status;
}

static mpm_status make_stepper(run *r) {
  mpm_stepper_desc d;
  ck_assert_int_eq(mpm_stepper_desc_init(&d, sizeof d), MPM_OK);
  d.scheme = r->options.scheme ? r->options.scheme : MPM_USL;
  d.transfer = r->options.transfer ? r->options.transfer : MPM_FLIP;
  if (r->options.flip > 0.0) d.flip = r->options.flip;
  if (r->options.xpic_order) d.xpic_order = r->options.xpic_order;
  if (r->options.position_order) d.position_order = r->options.position_order;
  d.staggered = r->options.staggered;
  d.locking_remedy = r->options.remedy && r->options.dim > 1;
  d.pic_damping = r->options.pic_damping;
  d.gravity[0] = 2.0;
  d.gravity[1] = -10.0;
  d.gravity[2] = 1.0;
  return mpm_stepper_create(r->context, r->grid, &d, &r->stepper);
}

static mpm_status set_walls(run *r) {
  const run_options *o = &r->options;
  mpm_status status = MPM_OK;
  if (!o->periodic) {
    status = mpm_stepper_set_wall(r->stepper, MPM_X_MAX, MPM_WALL_OPEN, 0.0);
    if (!status && o->dim == 1) status = mpm_stepper_set_wall(r->stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0);
  }
  const int32_t implicit = o->scheme == MPM_NEWMARK;
  if (!status && o->dim > 1)
    status = mpm_stepper_set_wall(r->stepper, MPM_Y_MIN, implicit ? MPM_WALL_SLIP : MPM_WALL_FRICTION, 0.3);
  if (!status && o->dim == 2) status = mpm_stepper_set_wall(r->stepper, MPM_Y_MAX, MPM_WALL_SLIP, 0.0);
  if (!status && o->dim == 3) status = mpm_stepper_set_wall(r->stepper, MPM_Z_MIN, MPM_WALL_SLIP, 0.0);
  if (!status && o->dim == 3) status = mpm_stepper_set_wall(r->stepper, MPM_Z_MAX, MPM_WALL_FIXED, 0.0);
  return status;
}

static mpm_status set_callbacks(run *r) {
  mpm_status status = mpm_stepper_set_force(r->stepper, add_force, r);
  if (!status) status = mpm_stepper_set_acceleration(r->stepper, add_acceleration, r);
  if (!status && r->options.velocity_bc) status = mpm_stepper_set_velocity_bc(r->stepper, hold_some, r);
  const int32_t hooks = r->options.led && r->options.scheme != MPM_NEWMARK;
  for (int32_t stage = MPM_AFTER_P2G; stage <= MPM_AFTER_VELOCITY && hooks && !status; ++stage)
    status = mpm_stepper_set_node_hook(r->stepper, stage, hook, NULL);
  if (!status && r->options.led) status = mpm_stepper_set_motion(r->stepper, r->set[1], lead, NULL);
  return status;
}

static mpm_status next_call(run *r) {
  const int32_t m = r->stage % 2;
  switch (r->stage) {
  case 0:
    return make_context(r);
  case 1:
    return make_grid(r);
  case 2:
  case 3:
    return make_material(r, m);
  case 4:
  case 5:
    return mpm_particles_create(r->context, r->grid, r->material[m], &r->set[m]);
  case 6:
  case 7:
    return mpm_particles_add_field(r->set[m], "heat", MPM_F64, 1);
  case 8:
  case 9:
    return add_particles(r, m);
  case 10:
  case 11:
    return set_heat(r, m);
  case 12:
    return make_stepper(r);
  case 13:
    return set_walls(r);
  case 14:
  case 15:
    return mpm_stepper_add(r->stepper, r->set[m]);
  case 16:
    return r->options.led ? set_prescribed(r) : MPM_OK;
  default:
    return set_callbacks(r);
  }
}

mpm_status run_try_open(run *r) {
  for (; r->stage <= 17; ++r->stage) {
    const mpm_status status = next_call(r);
    if (status) return status;
  }
  return MPM_OK;
}

void run_open(run *r, const run_options *options) {
  memset(r, 0, sizeof *r);
  r->options = *options;
  const mpm_status status = run_try_open(r);
  if (status)
    ck_abort_msg("stage %d: %s: %s", (int)r->stage, mpm_status_name(status), mpm_last_error(r->context));
}

void run_close(run *r) {
  run_ok(r, mpm_stepper_destroy(r->stepper));
  for (int32_t m = 0; m < 2; ++m) run_ok(r, mpm_particles_destroy(r->set[m]));
  for (int32_t m = 0; m < 2; ++m) run_ok(r, mpm_material_destroy(r->material[m]));
  run_ok(r, mpm_grid_destroy(r->grid));
  run_ok(r, mpm_context_destroy(r->context));
  memset(r, 0, sizeof *r);
}

void run_step_of(run *r, double dt) {
  r->info.struct_size = sizeof r->info;
  run_ok(r, mpm_step(r->stepper, dt, &r->info));
}

void run_steps(run *r, int32_t n) {
  for (int32_t i = 0; i < n; ++i) run_step_of(r, RUN_DT);
}

/* ---- what has to be equal ------------------------------------------------------------------------------ */
uint64_t run_hash(const run *r) {
  uint64_t hash = 0;
  run_ok(r, mpm_state_hash(r->stepper, &hash));
  return hash;
}

char *run_fields(const run *r, int32_t m, size_t *bytes) {
  const mpm_particles *set = r->set[m];
  const int64_t n = mpm_particles_count(set);
  char *all = NULL;
  *bytes = 0;
  const char *name;
  int32_t type, components;
  for (int32_t f = 0; mpm_particles_field_info(set, f, &name, &type, &components, NULL) == MPM_OK; ++f) {
    const size_t size = ((type == MPM_U8 ? 1 : 8) * (size_t)(components * n) + 7) / 8 * 8;
    all = realloc(all, *bytes + size + 1);
    memset(all + *bytes, 0, size);
    const mpm_status status = mpm_particles_get(set, name, type, components, n, NULL, all + *bytes);
    if (status == MPM_E_STATE) continue; /* "reference_position" that nobody keeps */
    run_ok(r, status);
    *bytes += size;
  }
  return all;
}

run_state run_take(const run *r) {
  run_state state = {{NULL, NULL}, {0, 0}, run_hash(r)};
  for (int32_t m = 0; m < 2; ++m) state.field[m] = run_fields(r, m, &state.bytes[m]);
  return state;
}

void run_same(const run *r, const run_state *was, const char *what) {
  run_state is = run_take(r);
  for (int32_t m = 0; m < 2; ++m) {
    ck_assert_msg(is.bytes[m] == was->bytes[m], "%s: set %d has %zu bytes, had %zu", what, (int)m,
                  is.bytes[m], was->bytes[m]);
    ck_assert_msg(memcmp(is.field[m], was->field[m], is.bytes[m]) == 0, "%s: fields of set %d have changed",
                  what, (int)m);
  }
  ck_assert_msg(is.hash == was->hash, "%s: the hash has changed", what);
  run_drop(&is);
}

void run_drop(run_state *state) {
  for (int32_t m = 0; m < 2; ++m) free(state->field[m]);
}

double *run_get(const run *r, int32_t m, const char *field, int32_t components) {
  const int64_t n = mpm_particles_count(r->set[m]);
  double *value = malloc((size_t)(components * n + 1) * sizeof *value);
  run_ok(r, mpm_particles_get(r->set[m], field, MPM_F64, components, n, NULL, value));
  return value;
}

void run_put(const run *r, int32_t m, const char *field, int32_t components, const double *values) {
  const int64_t n = mpm_particles_count(r->set[m]);
  run_ok(r, mpm_particles_set(r->set[m], field, MPM_F64, components, n, NULL, values));
}

double run_get1(const run *r, int32_t m, const char *field, int32_t components, int32_t c, int64_t id) {
  double value[81];
  run_ok(r, mpm_particles_get(r->set[m], field, MPM_F64, components, 1, &id, value));
  return value[c];
}

double *run_nodes(run *r, const char *field, int32_t components, int64_t *n) {
  mpm_view view = {.struct_size = sizeof view};
  run_ok(r, mpm_grid_map(r->stepper, 0, field, MPM_READ, &view));
  ck_assert_int_eq(view.components, components);
  ck_assert_int_eq(view.type, MPM_F64);
  *n = view.count;
  double *value = malloc((size_t)(components * *n + 1) * sizeof *value);
  for (int32_t c = 0; c < components; ++c)
    for (int64_t i = 0; i < *n; ++i)
      value[c * *n + i] = ((double *)view.data)[i * view.item_stride + c * view.component_stride];
  run_ok(r, mpm_view_release(&view));
  return value;
}

mpm_status run_neo_hookean(void *user, const mpm_material_batch *b) {
  static const int32_t row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
  const double mu = run_E / (2.0 * (1.0 + run_nu)), lambda = 2.0 * mu * run_nu / (1.0 - 2.0 * run_nu);
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    double F[9];
    for (int32_t e = 0; e < 9; ++e) F[e] = b->F[e * b->ld + i];
    const double J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                     F[2] * (F[3] * F[7] - F[4] * F[6]);
    double trace = 0.0;
    for (int32_t c = 0; c < 6; ++c) {
      const double *a = F + 3 * row[c], *d = F + 3 * column[c];
      const double unit = c < 3 ? 1.0 : 0.0, left = a[0] * d[0] + a[1] * d[1] + a[2] * d[2];
      b->stress_new[c * b->ld + i] = (lambda * log(J) * unit + mu * (left - unit)) / J;
      if (c < 3) trace += left;
    }
    b->wave_speed[i] = sqrt((lambda + 2.0 * mu) / run_density);
    b->energy[i] = 0.5 * lambda * log(J) * log(J) - mu * log(J) + 0.5 * mu * (trace - 3.0);
    if (b->state_count) b->state_new[i] = J;
  }
  return 0;
}
