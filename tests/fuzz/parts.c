/* A problem in two or three parts, as threads, does what it does in one, whatever a host asks of it: the same
 * statuses, states and infos, bit by bit, and no part waits for ever. */
#include "../unit/parts.c"
#include "fuzz.h"

enum { MOST_ACTIONS = 12, MOST_OF_PARTS = 3, MOST_PARTICLES = 1500 };

/* What a host does; every part reads it by itself. */
typedef struct action {
  uint8_t what, a, b, c, d;
} action;

typedef struct story {
  int32_t parts, dim, count;
  mpm_grid_desc grid;
  mpm_stepper_desc stepper;
  int32_t law;
  action list[MOST_ACTIONS];
} story;

/* What came of it on one part. */
typedef struct record {
  mpm_status status[MOST_ACTIONS];
  uint64_t hash[MOST_ACTIONS];
  mpm_step_info info;
  int64_t total;
} record;

typedef struct problem {
  const story *of;
  int32_t part, parts;
  fuzz_memory memory;
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
  double length;
} problem;

typedef struct run {
  const story *of;
  record of_part[MOST_OF_PARTS];
} run;

/* ---- the host's functions, which answer alike on all parts --------------------------------------------- */
static mpm_status push_particles(void *user, const mpm_particle_batch *batch, double *add) {
  (void)user;
  for (int64_t i = 0; i < batch->n; ++i)
    add[i] += 0.5 * batch->mass[i] * (batch->position[i] > 0.5 ? 1.0 : -2.0);
  return MPM_OK;
}

static mpm_status hold_nodes(void *user, const mpm_node_batch *batch, uint8_t *held, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < batch->n; ++i)
    if (batch->position[i] < 0.4) held[i] = 1, velocity[i] = 0.25;
  return MPM_OK;
}

static mpm_status push_nodes(void *user, const mpm_node_batch *batch, double *velocity, double *force) {
  (void)user, (void)velocity;
  for (int64_t i = 0; i < batch->n; ++i) force[i] += batch->mass[i] * batch->position[i];
  return MPM_OK;
}

/* ---- actions ------------------------------------------------------------------------------------------- */
static double share(uint8_t byte, double low, double high) {
  return low + (high - low) * byte / 255.0;
}

static double dt_of(const problem *p, uint8_t byte) {
  static const double shares[] = {0.3, 0.1, 0.5, 0.2, 0.8, 2.0, 30.0, 1e-3};
  double dt;
  if (fuzz_status(p->context, mpm_stable_dt(p->stepper, &dt)) || !(dt < 1e-2)) dt = 1e-3;
  return dt * shares[byte % 8];
}

static mpm_status fill(const problem *p, const action *is) {
  int64_t n;
  double low[3], high[3];
  static const int32_t per_cell[] = {2, 2, 2};
  MUST(!mpm_particles_total(p->set, &n));
  if (n > MOST_PARTICLES / 2) return MPM_OK;
  const uint8_t at[] = {is->a, is->b, is->c};
  for (int32_t k = 0; k < 3; ++k) {
    low[k] = share(at[k], 0.0, 0.8) * p->length;
    high[k] = low[k] + share(is->d, 0.05, p->of->dim == 1 ? 0.6 : p->of->dim == 2 ? 0.35 : 0.3) * p->length;
  }
  return mpm_particles_fill_box(p->set, low, high, per_cell, NULL, NULL);
}

/* One part adds, by numbers that follow or by some of its own, which may be in use on any part. */
static mpm_status add(const problem *p, const action *is) {
  enum { MOST = 8 };
  double x[3 * MOST], v[3 * MOST], volume[MOST];
  int64_t ids[MOST];
  const int64_t n = p->part == is->a % p->parts ? 1 + is->b % MOST : 0;
  for (int64_t i = 0; i < n; ++i) {
    for (int32_t k = 0; k < p->of->dim; ++k) {
      x[k * n + i] = p->length * (share(is->c, 0.1, 0.85) + 0.01 * (double)(i % 4) + 0.003 * k);
      v[k * n + i] = share(is->d, -5.0, 5.0);
    }
    volume[i] = 1e-4;
    ids[i] = 10000 * (1 + is->d % 4) + i;
  }
  return mpm_particles_add(p->set, n, x, v, volume, NULL, is->b & 8 ? ids : NULL, NULL);
}

/* The ids of the particles here that a rule chooses, to be freed. */
static int64_t *chosen(const problem *p, const action *is, int64_t *some) {
  const int64_t n = mpm_particles_count(p->set), modulus = 1 + is->a % 7;
  int64_t *ids = malloc(sizeof *ids * (size_t)(n + 1));
  MUST(!mpm_particles_get(p->set, "id", MPM_I64, 1, n, NULL, ids));
  *some = 0;
  for (int64_t i = 0; i < n; ++i)
    if (ids[i] % modulus == is->b % modulus) ids[(*some)++] = ids[i];
  return ids;
}

static mpm_status take_out(const problem *p, const action *is) {
  int64_t some;
  int64_t *ids = chosen(p, is, &some);
  const mpm_status status = mpm_particles_remove(p->set, some, ids);
  free(ids);
  return status;
}

static mpm_status repack(const problem *p, const action *is) {
  int64_t some, bytes;
  int64_t *ids = chosen(p, is, &some);
  MUST(!mpm_particles_packed_size(p->set, some, &bytes));
  void *packed = malloc((size_t)bytes);
  MUST(!mpm_particles_pack(p->set, some, ids, packed, bytes));
  MUST(!mpm_particles_remove(p->set, some, ids) && !mpm_particles_unpack(p->set, packed, bytes));
  free(packed), free(ids);
  return MPM_OK;
}

static mpm_status set_some(const problem *p, const action *is) {
  int64_t some;
  int64_t *ids = chosen(p, is, &some);
  uint8_t *flags = malloc((size_t)(3 * some + 1));
  double *v = malloc(sizeof *v * (size_t)(3 * some + 1));
  for (int64_t i = 0; i < some * p->of->dim; ++i) {
    flags[i] = is->c & 1;
    v[i] = share(is->d, -8.0, 8.0);
  }
  const mpm_status status =
      is->c & 2 ? mpm_particles_set(p->set, "prescribed", MPM_U8, p->of->dim, some, ids, flags)
                : mpm_particles_set(p->set, "velocity", MPM_F64, p->of->dim, some, ids, v);
  free(ids), free(flags), free(v);
  return status;
}

static mpm_status set_functions(const problem *p, const action *is) {
  mpm_status status = mpm_stepper_set_force(p->stepper, is->a & 1 ? push_particles : NULL, NULL);
  if (!status) status = mpm_stepper_set_velocity_bc(p->stepper, is->a & 2 ? hold_nodes : NULL, NULL);
  if (!status)
    status = mpm_stepper_set_node_hook(p->stepper, 1 + is->b % 3, is->a & 4 ? push_nodes : NULL, NULL);
  return status;
}

static mpm_status set_balance(const problem *p, const action *is) {
  mpm_balance_desc d;
  MUST(!mpm_balance_desc_init(&d, sizeof d));
  d.measure = is->a & 1;
  d.limit = is->a & 2 ? share(is->b, 0.9, 2.0) : 0.0;
  d.block_weight = is->a & 4 ? share(is->c, -1.0, 100.0) : 0.0;
  return mpm_stepper_set_balance(p->stepper, &d);
}

static mpm_status write_forces(const problem *p, double shift) {
  mpm_view v = {.struct_size = sizeof v};
  const mpm_status status = mpm_grid_map(p->stepper, 0, "force", MPM_READ | MPM_WRITE, &v);
  if (status) return status;
  for (int64_t i = 0; i < v.count * v.components; ++i) ((double *)v.data)[i] += shift;
  return mpm_view_release(&v);
}

static mpm_status staged(const problem *p, const action *is) {
  mpm_status status = mpm_step_begin(p->stepper, dt_of(p, is->a));
  if (!status && is->b & 1) MUST(!write_forces(p, share(is->c, -0.1, 0.1)));
  if (!status) status = mpm_step_grid(p->stepper);
  if (!status && is->b % 8 == 2) return mpm_step_abort(p->stepper);
  return status ? status : mpm_step_end(p->stepper, NULL);
}

static mpm_status advance(const problem *p, const action *is) {
  mpm_advance_desc d;
  mpm_step_info info = {.struct_size = sizeof info};
  MUST(!mpm_advance_desc_init(&d, sizeof d));
  MUST(!mpm_stepper_info(p->stepper, &info));
  d.t_end = info.t + 3.0 * dt_of(p, is->a);
  d.max_steps = 6;
  return mpm_advance(p->stepper, &d, &info);
}

static mpm_status configure(const problem *p, const action *is) {
  mpm_stepper_desc d = p->of->stepper;
  d.gravity[0] = share(is->a, -20.0, 20.0);
  d.flip = share(is->b, 0.0, 1.0);
  d.mass_damping = is->c & 1 ? 3.0 : 0.0;
  return mpm_stepper_configure(p->stepper, &d);
}

static mpm_status act(const problem *p, const action *is) {
  switch (is->what % 16) {
  case 0:
  case 1:
    return fill(p, is);
  case 2:
    return add(p, is);
  case 3:
    return take_out(p, is);
  case 4:
    return repack(p, is);
  case 5:
    return set_some(p, is);
  case 6:
    return set_functions(p, is);
  case 7:
    return mpm_stepper_set_wall(p->stepper, is->a % (2 * p->of->dim), is->b % 4, 0.0);
  case 8:
    return set_balance(p, is);
  case 9:
    return staged(p, is);
  case 10:
  case 11:
    return advance(p, is);
  case 12:
    return configure(p, is);
  default:
    return mpm_step(p->stepper, dt_of(p, is->a), NULL);
  }
}

/* ---- the problem --------------------------------------------------------------------------------------- */
static void open_problem(problem *p, const mpm_transport *transport) {
  static const char *const laws[] = {"neo_hookean", "j2", "linear_elastic"};
  static const mpm_param params[] = {
      {"E", 1e4}, {"nu", 0.3}, {"density", 1e3}, {"yield_stress", 1e3}, {"hardening", 1e3}};
  const int32_t j2 = p->of->law == 1;
  p->context = fuzz_context_of_part(&p->memory, 1, transport);
  MUST(!mpm_context_part(p->context, &p->part, &p->parts));
  MUST(!mpm_grid_create(p->context, &p->of->grid, &p->grid));
  MUST(!mpm_material_create(p->context, laws[p->of->law], params, j2 ? 5 : 3, &p->material));
  MUST(!mpm_particles_create(p->context, p->grid, p->material, &p->set));
  MUST(!mpm_stepper_create(p->context, p->grid, &p->of->stepper, &p->stepper));
  MUST(!mpm_stepper_add(p->stepper, p->set));
  p->length = p->of->grid.spacing[0] * (double)p->of->grid.cells[0];
}

static void live_in_part(int32_t part, const mpm_transport *transport, void *user) {
  run *of = user;
  record *found = &of->of_part[part];
  problem p;
  memset(&p, 0, sizeof p);
  p.of = of->of;
  open_problem(&p, transport);
  for (int32_t i = 0; i < p.of->count; ++i) {
    found->status[i] = fuzz_status(p.context, act(&p, &p.of->list[i]));
    MUST(!mpm_state_hash(p.stepper, &found->hash[i]));
  }
  found->info.struct_size = sizeof found->info;
  MUST(!mpm_stepper_info(p.stepper, &found->info));
  MUST(!mpm_particles_total(p.set, &found->total));
  fuzz_finite(p.set);
  MUST(!mpm_stepper_destroy(p.stepper));
  MUST(!mpm_particles_destroy(p.set));
  MUST(!mpm_material_destroy(p.material));
  MUST(!mpm_grid_destroy(p.grid));
  fuzz_close(p.context, &p.memory);
}

/* Blocks are 64, 16 and 6 nodes wide. */
static void draw_story(fuzz_input *in, story *s) {
  static const int32_t bases[] = {MPM_BSPLINE2, MPM_LINEAR, MPM_BSPLINE3, MPM_GIMP};
  static const int32_t schemes[] = {MPM_USL, MPM_MUSL, MPM_USF};
  static const int32_t transfers[] = {MPM_FLIP, MPM_APIC, MPM_XPIC, MPM_TPIC, MPM_AFLIP};
  static const int64_t cells[] = {0, 200, 44, 16};
  memset(s, 0, sizeof *s);
  s->parts = 2 + fuzz_below(in, 2);
  s->dim = 1 + fuzz_below(in, 3);
  MUST(!mpm_grid_desc_init(&s->grid, sizeof s->grid));
  MUST(!mpm_stepper_desc_init(&s->stepper, sizeof s->stepper));
  s->grid.dim = s->dim;
  const int32_t periodic = fuzz_below(in, 8);
  for (int32_t k = 0; k < s->dim; ++k) {
    s->grid.cells[k] = cells[s->dim];
    s->grid.spacing[k] = 1.0 / (double)cells[s->dim];
    s->grid.periodic[k] = periodic >> k & 1;
  }
  s->grid.basis = FUZZ_PICK(in, bases);
  s->stepper.scheme = FUZZ_PICK(in, schemes);
  s->stepper.transfer = FUZZ_PICK(in, transfers);
  s->stepper.xpic_order = 2;
  s->stepper.locking_remedy = s->dim > 1 && fuzz_below(in, 4) == 1;
  s->law = fuzz_below(in, 3);
  while (s->count < MOST_ACTIONS && fuzz_left(in)) {
    action *a = &s->list[s->count++];
    a->what = (uint8_t)fuzz_byte(in), a->a = (uint8_t)fuzz_byte(in), a->b = (uint8_t)fuzz_byte(in);
    a->c = (uint8_t)fuzz_byte(in), a->d = (uint8_t)fuzz_byte(in);
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static run one, many;
  fuzz_input in = {data, data + size};
  story s;
  parts_plan plan;
  draw_story(&in, &s);
  memset(&one, 0, sizeof one);
  memset(&many, 0, sizeof many);
  memset(&plan, 0, sizeof plan);
  one.of = many.of = &s;
  live_in_part(0, NULL, &one);
  if (parts_run(s.parts, live_in_part, &many, &plan)) {
    fprintf(stderr, "%s\n", plan.text);
    fuzz_fail("parts go on to the end", __FILE__, __LINE__);
  }
  for (int32_t r = 0; r < s.parts; ++r)
    MUST(!memcmp(&one.of_part[0], &many.of_part[r], sizeof one.of_part[0]));
  return 0;
}
