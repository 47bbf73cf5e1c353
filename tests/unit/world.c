#include "world.h"

#include "stepper/stepper.h"

mpm_context *context_of_world(const world *w) {
  return w->context;
}

const mpm_context *context_itself(const void *context) {
  return context;
}

/* ---- the host's services ---- */
static void *counted_alloc(void *user, size_t bytes, size_t alignment) {
  host_memory *m = user;
  if (++m->calls == m->fail_at) return NULL;
  void *lent = aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (!lent) return NULL;
  memset(lent, m->filling ? m->filling : 0xff, bytes);
  m->held += (int64_t)bytes;
  return lent;
}

static void counted_release(void *user, void *lent, size_t bytes, size_t alignment) {
  host_memory *m = user;
  (void)alignment;
  m->held -= (int64_t)bytes;
  free(lent);
}

void memory_lend(mpm_context_desc *desc, host_memory *m) {
  desc->alloc = counted_alloc;
  desc->release = counted_release;
  desc->alloc_user = m;
}

mpm_context *context_with(int32_t concurrency, int32_t isa, host_memory *m) {
  mpm_context_desc desc = context_desc();
  mpm_context *context;
  desc.concurrency = concurrency;
  desc.isa = isa;
  if (m) memory_lend(&desc, m);
  const mpm_status status = mpm_context_create(&desc, &context);
  if (status == MPM_E_UNSUPPORTED) return NULL;
  ck_ok(NULL, status);
  return context;
}

int32_t has_isa(int32_t isa) {
  mpm_context *context = context_with(1, isa, NULL);
  if (context) ck_ok(context, mpm_context_destroy(context));
  return context != NULL;
}

static mpm_status in_random_order(void *user, int64_t count, mpm_task_fn task, void *task_data) {
  world *w = user;
  int64_t *order = malloc((size_t)count * sizeof *order);
  for (int64_t i = 0; i < count; ++i) {
    const int64_t at = (int64_t)(mixed(w->dice++) % (uint64_t)(i + 1));
    order[i] = order[at];
    order[at] = i;
  }
  for (int64_t i = 0; i < count; ++i) task(task_data, order[i]);
  free(order);
  return 0;
}

const char *scratch_path(const char *name, char *path, size_t size) {
  const char *scratch = getenv("MPM_SCRATCH");
  snprintf(path, size, "%s/%s", scratch ? scratch : ".", name);
  return path;
}

/* ---- descriptions ---- */
mpm_context_desc context_desc(void) {
  mpm_context_desc d;
  ck_ok(NULL, mpm_context_desc_init(&d, sizeof d));
  return d;
}

mpm_grid_desc grid_desc(int32_t dim, int64_t cells, double spacing) {
  mpm_grid_desc d;
  ck_ok(NULL, mpm_grid_desc_init(&d, sizeof d));
  d.dim = dim;
  for (int32_t k = 0; k < dim; ++k) d.cells[k] = cells, d.spacing[k] = spacing;
  return d;
}

mpm_stepper_desc stepper_desc(void) {
  mpm_stepper_desc d;
  ck_ok(NULL, mpm_stepper_desc_init(&d, sizeof d));
  return d;
}

mpm_material_desc material_desc(double density, mpm_stress_fn stress, void *user) {
  mpm_material_desc d;
  ck_ok(NULL, mpm_material_desc_init(&d, sizeof d));
  d.density = density;
  d.stress = stress;
  d.user = user;
  return d;
}

mpm_advance_desc advance_desc(double t_end) {
  mpm_advance_desc d;
  ck_ok(NULL, mpm_advance_desc_init(&d, sizeof d));
  d.t_end = t_end;
  return d;
}

/* A model is given those constants of the law that it has as parameters. */
mpm_status law_create(mpm_context *context, const world_law *of, mpm_material **out) {
  if (!of->model) {
    mpm_material_desc d;
    const mpm_status status = mpm_material_desc_init(&d, sizeof d);
    if (status) return status;
    d.density = of->density;
    d.stress = of->stress;
    d.tangent = of->tangent;
    d.state_count = of->state_count;
    d.state_initial = of->state_initial;
    d.user = of->user;
    return mpm_material_create_custom(context, &d, out);
  }
  if (of->params) return mpm_material_create(context, of->model, of->params, of->param_count, out);
  const mpm_param known[] = {{"density", of->density},
                             {"E", of->E},
                             {"nu", of->nu},
                             {"yield_stress", of->yield_stress},
                             {"hardening", of->hardening},
                             {"mu", of->E / (2.0 * (1.0 + of->nu))},
                             {"kappa", of->E / (3.0 * (1.0 - 2.0 * of->nu))},
                             {"bulk_modulus", of->E},
                             {"viscosity", 1e-2 * of->E},
                             {"phi", 25.0},
                             {"psi", 5.0},
                             {"cohesion", of->yield_stress},
                             {"shear_modulus", of->E / (2.0 * (1.0 + of->nu))},
                             {"yield_shear", of->yield_stress},
                             {"consistency", 1e-2 * of->E},
                             {"mu_s", 0.4},
                             {"mu_2", 0.7},
                             {"I_0", 0.3},
                             {"grain_diameter", 0.01},
                             {"grain_density", 2.5e3},
                             {"lambda", 0.12},
                             {"M", 1.05},
                             {"mu0", of->E},
                             {"p_ref", of->yield_stress},
                             {"pc0", 2.0 * of->yield_stress}};
  mpm_param given[sizeof known / sizeof *known];
  int32_t count = 0;
  const char *name;
  for (int32_t i = 0; !mpm_material_model_param(of->model, i, &name, NULL, NULL, NULL, NULL, NULL); ++i)
    for (size_t k = 0; k < sizeof known / sizeof *known; ++k)
      if (!strcmp(known[k].name, name)) given[count++] = known[k];
  for (int32_t i = 0; i < count; ++i) /* there it is a slope */
    if (!strcmp(of->model, "cam_clay") && !strcmp(given[i].name, "kappa")) given[i].value = 0.02;
  return mpm_material_create(context, of->model, given, count, out);
}

world_desc world_default(int32_t dim, int64_t cells, double h) {
  return (world_desc){
      .context = context_desc(),
      .grid = grid_desc(dim, cells, h),
      .stepper = stepper_desc(),
      .law = {.model = "neo_hookean", .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e3},
      .sets = 1};
}

world_desc world_with(const method *how, int32_t dim, int64_t cells, double h) {
  world_desc d = world_default(dim, cells, h);
  world_use(&d, how);
  return d;
}

void world_use(world_desc *desc, const method *how) {
  method_use(how, &desc->grid, &desc->stepper);
}

/* ---- open and close ---- */
static mpm_status open_context(world *w) {
  mpm_context_desc d = w->desc.context;
  if (!d.alloc) memory_lend(&d, &w->memory);
  if (w->desc.random_order) {
    d.parallel_for = in_random_order;
    d.parallel_user = w;
  }
  return mpm_context_create(&d, &w->context);
}

static mpm_status open_set(world *w, int32_t m) {
  mpm_material *material = w->material[m] ? w->material[m] : w->material[0];
  return mpm_particles_create(w->context, w->grid, material, &w->set[m]);
}

/* Makes the call unless it has been made. */
#define NEXT(call)                                                                                           \
  do {                                                                                                       \
    if (number++ < w->opened) break;                                                                         \
    const mpm_status status_ = (call);                                                                       \
    if (status_) return status_;                                                                             \
    ++w->opened;                                                                                             \
  } while (0)

mpm_status world_try_open(world *w) {
  const world_desc *d = &w->desc;
  int32_t number = 0;
  w->info.struct_size = sizeof w->info;
  w->dim = d->grid.dim;
  w->sets = d->sets;
  NEXT(open_context(w));
  NEXT(mpm_grid_create(w->context, &d->grid, &w->grid));
  NEXT(law_create(w->context, &d->law, &w->material[0]));
  if (d->other_law.model || d->other_law.stress) NEXT(law_create(w->context, &d->other_law, &w->material[1]));
  for (int32_t m = 0; m < d->sets; ++m) NEXT(open_set(w, m));
  for (const fill_fn *fill = d->fill; fill && *fill; ++fill)
    for (int32_t m = 0; m < d->sets; ++m) NEXT((*fill)(w, m));
  if (d->bare) return MPM_OK;
  NEXT(mpm_stepper_create(w->context, w->grid, &d->stepper, &w->stepper));
  for (int32_t m = 0; m < d->sets; ++m) NEXT(mpm_stepper_add(w->stepper, w->set[m]));
  for (const equip_fn *equip = d->equip; equip && *equip; ++equip) NEXT((*equip)(w));
  return MPM_OK;
}

mpm_particles *world_open(world *w, const world_desc *desc) {
  memset(w, 0, sizeof *w);
  w->desc = *desc;
  w->memory = desc->memory;
  ck_ok(w, world_try_open(w));
  return w->set[0];
}

mpm_particles *world_add_set(world *w, const world_law *of) {
  const int32_t m = w->sets++;
  if (of) ck_ok(w, law_create(w->context, of, &w->material[m]));
  ck_ok(w, open_set(w, m));
  ck_ok(w, mpm_stepper_add(w->stepper, w->set[m]));
  return w->set[m];
}

mpm_status world_try_close(world *w) {
  mpm_status status = mpm_stepper_destroy(w->stepper);
  for (int32_t m = 0; m < w->sets && !status; ++m) status = mpm_particles_destroy(w->set[m]);
  for (int32_t m = 0; m < MOST_SETS && !status; ++m) status = mpm_material_destroy(w->material[m]);
  if (!status) status = mpm_grid_destroy(w->grid);
  return status ? status : mpm_context_destroy(w->context);
}

void world_close(world *w) {
  ck_ok(w, world_try_close(w));
  ck_assert_int_eq(w->memory.held, 0);
  memset(w, 0, sizeof *w);
}

/* ---- steps ---- */
mpm_step_info world_info(const world *w) {
  mpm_step_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_stepper_info(w->stepper, &info));
  return info;
}

/* Contact gives no energy in any step: of the largest there was, and that went in or out, no more than
 * rounding. */
static mpm_step_info see_step(world *w) {
  const mpm_step_info *now = &w->info;
  const double energy = now->kinetic_energy + fabs(now->strain_energy) + fabs(now->external_work_total);
  /* without a trap where a law tells no energy */
  if (isgreater(energy, w->most_energy)) w->most_energy = energy;
  if (isless(now->contact_dissipation, 0.0))
    ck_between("contact takes energy", now->contact_dissipation, -1e-12 * w->most_energy, 0.0);
  return *now;
}

mpm_step_info world_step(world *w, double dt) {
  ck_ok(w, mpm_step(w->stepper, dt, &w->info));
  return see_step(w);
}

mpm_step_info world_staged_step(world *w, double dt) {
  ck_ok(w, mpm_step_begin(w->stepper, dt));
  ck_ok(w, mpm_step_grid(w->stepper));
  ck_ok(w, mpm_step_end(w->stepper, &w->info));
  return see_step(w);
}

void world_steps(world *w, int32_t n) {
  for (int32_t i = 0; i < n; ++i) world_step(w, w->desc.dt);
}

double world_stable_dt(world *w) {
  double dt;
  ck_ok(w, mpm_stable_dt(w->stepper, &dt));
  return dt;
}

int64_t world_blocks(const world *w) {
  return w->stepper->layout.worklist[0].count;
}

void world_walls(world *w, int32_t kind, double friction) {
  for (int32_t face = 0; face < 2 * w->dim; ++face)
    if (!w->desc.grid.periodic[face / 2]) ck_ok(w, mpm_stepper_set_wall(w->stepper, face, kind, friction));
}

int64_t world_fill(world *w, mpm_particles *set, const double *lower, const double *upper, int32_t per_axis) {
  const int32_t per_cell[3] = {per_axis, per_axis, per_axis};
  ck_ok(w, mpm_particles_fill_box(set, lower, upper, per_cell, NULL, NULL));
  return mpm_particles_count(set);
}

int64_t world_fill_cube(world *w, mpm_particles *set, double low, double high) {
  const double lower[3] = {low, low, low}, upper[3] = {high, high, high};
  return world_fill(w, set, lower, upper, 2);
}

mpm_status prescribe_sevenths(mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  int64_t *id = calloc((size_t)n + 1, sizeof *id);
  uint8_t *flags = calloc((size_t)n + 1, 2);
  mpm_status status = mpm_particles_get(set, "id", MPM_I64, 1, n, NULL, id);
  for (int64_t p = 0; p < n; ++p) flags[p] = id[p] % 7 == 0 && id[p] < 200;
  if (!status) status = mpm_particles_set(set, "prescribed", MPM_U8, 2, n, NULL, flags);
  free(id), free(flags);
  return status;
}
