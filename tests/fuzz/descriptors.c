/* Descriptors and parameters with any values, and structs of any size: a status with a sentence, or an object
 * that can be used. */
#include <stddef.h>

#include "fuzz.h"
#include "material/material.h"

enum { I32, I64, F64 };
typedef struct member {
  size_t at;
  int32_t kind, count;
} member;
#define MEMBER(type, name, kind, count)                                                                      \
  { offsetof(type, name), kind, count }

static const member of_context[] = {MEMBER(mpm_context_desc, concurrency, I32, 3)};
static const member of_grid[] = {MEMBER(mpm_grid_desc, dim, I32, 7), MEMBER(mpm_grid_desc, cells, I64, 3),
                                 MEMBER(mpm_grid_desc, origin, F64, 7),
                                 MEMBER(mpm_grid_desc, total_lagrangian, I32, 2)};
static const member of_stepper[] = {MEMBER(mpm_stepper_desc, scheme, I32, 9),
                                    MEMBER(mpm_stepper_desc, flip, F64, 11),
                                    MEMBER(mpm_stepper_desc, newton_max_iterations, I32, 2),
                                    MEMBER(mpm_stepper_desc, linear_tolerance, F64, 1),
                                    MEMBER(mpm_stepper_desc, linear_max_iterations, I32, 2),
                                    MEMBER(mpm_stepper_desc, local_damping, F64, 2),
                                    MEMBER(mpm_stepper_desc, xpic_every, I32, 1)};
static const member of_advance[] = {MEMBER(mpm_advance_desc, max_cuts, I32, 1),
                                    MEMBER(mpm_advance_desc, t_end, F64, 5)};
static const member of_balance[] = {MEMBER(mpm_balance_desc, measure, I32, 1),
                                    MEMBER(mpm_balance_desc, limit, F64, 2)};
static const member of_material[] = {MEMBER(mpm_material_desc, state_count, I32, 3),
                                     MEMBER(mpm_material_desc, density, F64, 1)};

/* A struct in memory of its own of the size that it claims, so that a byte beyond is noticed. */
static void *make(fuzz_input *in, const void *defaults, size_t known, const member *list, int32_t members) {
  static const uint32_t sizes[] = {0, 3, 4, 8, UINT16_MAX, 1 << 16, (1 << 16) + 1, UINT32_MAX, INT32_MAX};
  const int32_t kind = fuzz_below(in, 64);
  uint32_t size = (uint32_t)known;
  if (kind < 9) size = sizes[kind];
  if (kind >= 9 && kind < 12) size = (uint32_t)known + fuzz_byte(in);
  if (kind >= 12 && kind < 14) size = (uint32_t)known - fuzz_byte(in) % (uint32_t)known;
  size_t bytes = size < 1 << 16 ? size : 1 << 16; /* which no struct of this interface exceeds */
  if (bytes < sizeof size) bytes = sizeof size;
  uint8_t *made = calloc(1, bytes);
  memcpy(made, defaults, known < bytes ? known : bytes);
  memcpy(made, &size, sizeof size);
  if (kind == 11 && bytes > known) made[known + fuzz_byte(in) % (bytes - known)] = 1;
  for (int32_t changes = fuzz_below(in, 6); changes > 0; --changes) {
    const member *m = &list[fuzz_below(in, members)];
    const int32_t which = fuzz_below(in, m->count);
    const size_t width = m->kind == I32 ? 4 : 8, at = m->at + (size_t)which * width;
    const double real = m->kind == F64 ? fuzz_double(in) : 0.0;
    const int64_t wide = m->kind != F64 ? fuzz_integer(in) : 0;
    const int32_t narrow = (int32_t)wide;
    if (at + width > bytes) continue;
    memcpy(made + at,
           m->kind == F64   ? (const void *)&real
           : m->kind == I64 ? (const void *)&wide
                            : &narrow,
           width);
  }
  return made;
}
#define MAKE(in, defaults, list)                                                                             \
  make(in, &(defaults), sizeof(defaults), list, (int32_t)(sizeof(list) / sizeof *(list)))

static void inits(fuzz_input *in) {
  static mpm_status (*const init[])(void *, uint32_t) = {
      (mpm_status(*)(void *, uint32_t))(void *)mpm_context_desc_init,
      (mpm_status(*)(void *, uint32_t))(void *)mpm_grid_desc_init,
      (mpm_status(*)(void *, uint32_t))(void *)mpm_stepper_desc_init,
      (mpm_status(*)(void *, uint32_t))(void *)mpm_advance_desc_init,
      (mpm_status(*)(void *, uint32_t))(void *)mpm_material_desc_init};
  const int32_t which = fuzz_below(in, 5);
  const uint32_t size = (uint32_t)fuzz_word(in, 1 + fuzz_below(in, 2));
  void *memory = malloc(size + (size == 0));
  (void)(init[which](memory, size));
  free(memory);
}

/* A law of the host that gives what the bytes say. */
typedef struct law {
  double stress, speed, viscosity;
  mpm_status status;
} law;

static mpm_status any_stress(void *user, const mpm_material_batch *b) {
  const law *l = user;
  for (int64_t i = 0; i < b->n; ++i) {
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + i] = l->stress * (double)(c + 1);
    for (int32_t c = 0; c < b->state_count; ++c) b->state_new[c * b->ld + i] = b->state[c * b->ld + i];
    b->wave_speed[i] = l->speed;
    b->kinematic_viscosity[i] = l->viscosity;
  }
  return l->status;
}

static mpm_material *custom(fuzz_input *in, mpm_context *context, law *l) {
  mpm_material *material = NULL;
  mpm_material_desc d;
  MUST(!mpm_material_desc_init(&d, sizeof d));
  *l = (law){fuzz_double(in), fuzz_double(in), fuzz_double(in), 0};
  if (fuzz_below(in, 8) == 0) l->status = fuzz_below(in, 3) - 1;
  d.density = 1e3;
  d.stress = any_stress;
  d.user = l;
  double initial[64];
  for (int32_t i = 0; i < 64; ++i) initial[i] = i < 2 ? fuzz_double(in) : 0.0;
  if (fuzz_below(in, 4) == 0) d.state_initial = initial;
  void *made = MAKE(in, d, of_material);
  fuzz_status(context, mpm_material_create_custom(context, made, &material));
  free(made);
  return material;
}

/* A law by name, or a name that is none, with parameters near or far from what is allowed. */
static mpm_material *built_in(fuzz_input *in, mpm_context *context) {
  static const char *const other[] = {"",      "neo_hookean_decoupled", "newtonian_fluid", "rigid", "j2 ",
                                      "linear"};
  const int32_t models = mpm_material_model_count(), which = fuzz_below(in, models + 6);
  const char *model = which < models ? mpm_material_model_name(which) : other[which - models];
  mpm_param param[16];
  int32_t count = 0;
  double low, high, usual;
  while (count < 12 &&
         !mpm_material_model_param(model, count, &param[count].name, NULL, NULL, &usual, &low, &high)) {
    param[count].value = !isnan(usual) ? usual : low < 0.0 ? 0.3 : 1e3 + count; /* mu_2 above mu_s */
    if (fuzz_below(in, 4) == 0) param[count].value = fuzz_double(in);
    if (fuzz_below(in, 16) == 0) param[count].value = fuzz_below(in, 2) ? low : high;
    ++count;
  }
  if (fuzz_below(in, 16) == 0) param[count++] = (mpm_param){"E", 1.0};
  if (fuzz_below(in, 16) == 0) param[count++] = (mpm_param){NULL, 1.0};
  if (fuzz_below(in, 16) == 0) count = (int32_t)fuzz_integer(in) % (count + 1);
  mpm_material *material = NULL;
  fuzz_status(context, mpm_material_create(context, model, param, count, &material));
  return material;
}

/* A step or two of particles without a grid, of any size and with anything missing. */
static void drive(fuzz_input *in, mpm_context *context, const mpm_material *material) {
  enum { MOST = 70, STATE = 64 };
  static double F[9 * MOST], F_inc[9 * MOST], stress[6 * MOST], state[STATE * MOST], energy[MOST],
      c[81 * MOST];
  static int64_t id[MOST];
  mpm_material_batch b = {.struct_size = fuzz_below(in, 16) ? sizeof b : (uint32_t)fuzz_below(in, sizeof b),
                          .state_count = material ? material->state_count : 0,
                          .n = fuzz_below(in, MOST + 1),
                          .ld = MOST,
                          .dt = fuzz_below(in, 4) ? 0.25 : fuzz_double(in),
                          .F = F,
                          .F_inc = F_inc,
                          .stress = stress,
                          .state = state,
                          .stress_new = stress,
                          .state_new = state,
                          .energy = energy};
  memset(state, 0, sizeof state);
  for (int64_t i = 0; i < MOST; ++i) id[i] = i;
  for (int32_t e = 0; e < 9; ++e)
    for (int64_t i = 0; i < MOST; ++i) F[e * MOST + i] = F_inc[e * MOST + i] = e % 4 ? 0.0 : 1.0;
  for (int32_t changes = fuzz_below(in, 9); changes > 0; --changes) {
    double *const of[] = {F, F_inc, stress, state};
    of[fuzz_below(in, 4)][fuzz_below(in, 6 * MOST)] +=
        fuzz_below(in, 4) ? fuzz_between(in, -0.5, 0.5) : fuzz_double(in);
  }
  if (fuzz_below(in, 4) == 0) b.id = id, id[fuzz_below(in, MOST)] = fuzz_integer(in);
  if (fuzz_below(in, 16) == 0) b.n = fuzz_integer(in), b.ld = b.n > MOST ? b.n - 1 : MOST;
  if (fuzz_below(in, 16) == 0) b.stress = NULL;
  if (fuzz_below(in, 16) == 0) b.state_count = fuzz_below(in, 4);
  int32_t symmetric = 0;
  for (int32_t step = 0; step < 2; ++step) {
    const mpm_status status = mpm_material_update(material, &b, fuzz_below(in, 2) ? c : NULL, &symmetric);
    fuzz_status(context, status);
    for (int64_t i = 0; i < b.n && !status; ++i) MUST(isfinite(stress[i]) || (b.id && id[i] < 0));
  }
}

static mpm_context *open_context(fuzz_input *in, fuzz_memory *memory) {
  mpm_context *context = NULL;
  mpm_context_desc d;
  MUST(!mpm_context_desc_init(&d, sizeof d));
  *memory = (fuzz_memory){0, 0, 0};
  d.alloc = fuzz_alloc;
  d.release = fuzz_release;
  d.alloc_user = memory;
  if (fuzz_below(in, 4)) return fuzz_context(memory, 1);
  void *made = MAKE(in, d, of_context);
  mpm_context_desc *is = made;
  if (is->struct_size >= sizeof d && is->concurrency > 3) is->concurrency = 4096 + is->concurrency % 4096;
  const mpm_status status = mpm_context_create(made, &context);
  MUST((status == MPM_OK) == (context != NULL));
  free(made);
  return context;
}

typedef struct world {
  mpm_context *context;
  mpm_grid *grid;
  mpm_grid_desc g;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
} world;

/* A particle or two somewhere in the grid; values of all sizes. */
static void add(fuzz_input *in, world *w) {
  double x[6], v[6], volume[2], size[6];
  const int64_t n = 1 + fuzz_below(in, 2);
  double cell = 1.0;
  for (int32_t k = 0; k < w->g.dim; ++k) cell *= w->g.spacing[k];
  for (int64_t i = 0; i < n; ++i) {
    volume[i] = fuzz_below(in, 8) ? 0.25 * cell : fuzz_double(in);
    for (int32_t k = 0; k < w->g.dim; ++k) {
      const double share = fuzz_between(in, 0.0, 1.0);
      x[k * n + i] = w->g.origin[k] + share * (double)w->g.cells[k] * w->g.spacing[k];
      if (fuzz_below(in, 16) == 0) x[k * n + i] = fuzz_double(in);
      v[k * n + i] = fuzz_below(in, 4) ? fuzz_between(in, -1.0, 1.0) : fuzz_double(in);
      size[k * n + i] = fuzz_below(in, 4) ? 0.5 * w->g.spacing[k] : fuzz_double(in);
    }
  }
  fuzz_status(w->context,
              mpm_particles_add(w->set, n, x, v, volume, fuzz_below(in, 2) ? size : NULL, NULL, NULL));
}

static void step(fuzz_input *in, world *w) {
  mpm_step_info *info = calloc(1, 1 << 16);
  mpm_advance_desc go;
  double dt;
  info->struct_size = fuzz_below(in, 8) ? (uint32_t)sizeof *info : (uint32_t)fuzz_integer(in);
  if (fuzz_status(w->context, mpm_stable_dt(w->stepper, &dt))) dt = 1e-3;
  MUST(dt > 0.0);
  if (fuzz_below(in, 8) == 0) dt = fuzz_double(in);
  fuzz_status(w->context, mpm_step(w->stepper, 0.5 * dt, info));
  fuzz_status(w->context, mpm_stepper_info(w->stepper, info));
  MUST(!mpm_advance_desc_init(&go, sizeof go));
  go.t_end = dt < 1e300 ? dt : 1.0;
  go.max_steps = 4;
  void *made = MAKE(in, go, of_advance);
  mpm_advance_desc *is = made;
  if (is->struct_size >= sizeof go && (is->max_steps < 1 || is->max_steps > 16)) is->max_steps = 16;
  fuzz_status(w->context, mpm_advance(w->stepper, made, info));
  free(made);
  fuzz_finite(w->set);
  mpm_profile *profile = calloc(1, 1 << 16);
  profile->struct_size = fuzz_below(in, 4) ? (uint32_t)sizeof *profile : (uint32_t)fuzz_integer(in);
  fuzz_status(w->context, mpm_stepper_profile(w->stepper, fuzz_below(in, 2), profile));
  free(profile);
  mpm_view view = {.struct_size =
                       fuzz_below(in, 4) ? (uint32_t)sizeof view : fuzz_byte(in) % (uint32_t)sizeof view};
  if (!fuzz_status(w->context, mpm_particles_map(w->set, "stress", 1 + fuzz_below(in, 4), &view)))
    fuzz_status(w->context, mpm_view_release(&view));
  if (!fuzz_status(w->context, mpm_grid_map(w->stepper, 0, "velocity", fuzz_below(in, 4), &view)))
    fuzz_status(w->context, mpm_view_release(&view));
  free(info);
}

static void use_stepper(fuzz_input *in, world *w) {
  mpm_stepper_desc d;
  MUST(!mpm_stepper_desc_init(&d, sizeof d));
  void *made = MAKE(in, d, of_stepper);
  const mpm_status status =
      fuzz_status(w->context, mpm_stepper_create(w->context, w->grid, made, &w->stepper));
  free(made);
  MUST((status == MPM_OK) == (w->stepper != NULL));
  if (!w->stepper) MUST(!mpm_stepper_create(w->context, w->grid, NULL, &w->stepper));
  MUST(!mpm_stepper_add(w->stepper, w->set));
  fuzz_status(w->context, mpm_stepper_set_wall(w->stepper, (int32_t)fuzz_integer(in),
                                               (int32_t)fuzz_integer(in), fuzz_double(in)));
  fuzz_status(w->context,
              mpm_stepper_set_time(w->stepper, fuzz_below(in, 4) ? 0.0 : fuzz_double(in), fuzz_integer(in)));
  step(in, w);
  mpm_balance_desc balance;
  MUST(!mpm_balance_desc_init(&balance, sizeof balance));
  made = MAKE(in, balance, of_balance);
  fuzz_status(w->context, mpm_stepper_set_balance(w->stepper, made));
  free(made);
  made = MAKE(in, d, of_stepper);
  if (!fuzz_status(w->context, mpm_stepper_configure(w->stepper, made))) step(in, w);
  free(made);
  MUST(!mpm_stepper_destroy(w->stepper));
}

static void use_material(fuzz_input *in, world *w) {
  MUST(!mpm_grid_desc_init(&w->g, sizeof w->g));
  w->g.dim = 1 + fuzz_below(in, 3);
  for (int32_t k = 0; k < 3; ++k) w->g.cells[k] = 8, w->g.spacing[k] = 0.5;
  mpm_grid_desc *made = MAKE(in, w->g, of_grid);
  const mpm_status status = fuzz_status(w->context, mpm_grid_create(w->context, made, &w->grid));
  MUST((status == MPM_OK) == (w->grid != NULL));
  if (!status) memcpy(&w->g, made, made->struct_size < sizeof w->g ? made->struct_size : sizeof w->g);
  free(made);
  if (!w->grid) MUST(!mpm_grid_create(w->context, &w->g, &w->grid));
  if (!fuzz_status(w->context, mpm_particles_create(w->context, w->grid, w->material, &w->set))) {
    add(in, w);
    fuzz_finite(w->set);
    use_stepper(in, w);
    MUST(!mpm_particles_destroy(w->set));
  }
  MUST(!mpm_grid_destroy(w->grid));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_input in = {data, data + size};
  fuzz_memory memory;
  world w;
  memset(&w, 0, sizeof w);
  law l;
  inits(&in);
  w.context = open_context(&in, &memory);
  if (!w.context) {
    MUST(memory.held == 0);
    return 0;
  }
  w.material = fuzz_below(&in, 3) ? built_in(&in, w.context) : custom(&in, w.context, &l);
  if (w.material) {
    use_material(&in, &w);
    drive(&in, w.context, w.material);
    MUST(!mpm_material_destroy(w.material));
  }
  fuzz_close(w.context, &memory);
  return 0;
}
