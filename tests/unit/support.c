#include "support.h"

#define BOTH_SCHEMES(basis, transfer, flip, name)                                                            \
  {basis, MPM_USL, transfer, flip, name " USL"}, {                                                           \
    basis, MPM_MUSL, transfer, flip, name " MUSL"                                                            \
  }
const method methods[METHODS] = {
    BOTH_SCHEMES(MPM_BSPLINE2, MPM_FLIP, 1.0, "quadratic FLIP"),
    BOTH_SCHEMES(MPM_BSPLINE2, MPM_FLIP, 0.9, "quadratic blend"),
    BOTH_SCHEMES(MPM_BSPLINE2, MPM_FLIP, 0.0, "quadratic PIC"),
    BOTH_SCHEMES(MPM_BSPLINE2, MPM_APIC, 1.0, "quadratic APIC"),
    BOTH_SCHEMES(MPM_BSPLINE2, MPM_APIC_MLS, 1.0, "quadratic MLS"),
    BOTH_SCHEMES(MPM_LINEAR, MPM_FLIP, 1.0, "linear FLIP"),
    BOTH_SCHEMES(MPM_LINEAR, MPM_FLIP, 0.9, "linear blend"),
    BOTH_SCHEMES(MPM_LINEAR, MPM_FLIP, 0.0, "linear PIC"),
    BOTH_SCHEMES(MPM_LINEAR, MPM_APIC, 1.0, "linear APIC"),
};

world_desc world_default(int32_t dim, int64_t cells, double h) {
  world_desc desc = {.model = "neo_hookean", .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e3};
  ck_assert_int_eq(mpm_grid_desc_init(&desc.grid, sizeof desc.grid), MPM_OK);
  ck_assert_int_eq(mpm_stepper_desc_init(&desc.stepper, sizeof desc.stepper), MPM_OK);
  desc.grid.dim = dim;
  for (int32_t k = 0; k < dim; ++k) {
    desc.grid.cells[k] = cells;
    desc.grid.spacing[k] = h;
  }
  return desc;
}

void world_use(world_desc *desc, const method *how) {
  desc->grid.basis = how->basis;
  desc->stepper.scheme = how->scheme;
  desc->stepper.transfer = how->transfer;
  desc->stepper.flip = how->flip;
}

void world_open(world *w, const world_desc *desc) {
  const mpm_param params[] = {{"E", desc->E},
                              {"nu", desc->nu},
                              {"density", desc->density},
                              {"yield_stress", desc->yield_stress},
                              {"hardening", desc->hardening}};
  mpm_context_desc context;
  memset(w, 0, sizeof *w);
  ck_assert_int_eq(mpm_context_desc_init(&context, sizeof context), MPM_OK);
  if (desc->concurrency) context.concurrency = desc->concurrency;
  ck_assert_int_eq(mpm_context_create(&context, &w->context), MPM_OK);
  ck_ok(w, mpm_grid_create(w->context, &desc->grid, &w->grid));
  ck_ok(w, mpm_material_create(w->context, desc->model, desc->params ? desc->params : params,
                               desc->params                ? desc->param_count
                               : strcmp(desc->model, "j2") ? 3
                                                           : 5,
                               &w->material));
  ck_ok(w, mpm_stepper_create(w->context, w->grid, &desc->stepper, &w->stepper));
  w->dim = desc->grid.dim;
}

mpm_particles *world_add_set(world *w) {
  mpm_particles **set = &w->set[w->sets++];
  ck_ok(w, mpm_particles_create(w->context, w->grid, w->material, set));
  ck_ok(w, mpm_stepper_add(w->stepper, *set));
  return *set;
}

void world_close(world *w) {
  ck_ok(w, mpm_stepper_destroy(w->stepper));
  for (int32_t i = 0; i < w->sets; ++i) ck_ok(w, mpm_particles_destroy(w->set[i]));
  ck_ok(w, mpm_material_destroy(w->material));
  ck_ok(w, mpm_grid_destroy(w->grid));
  ck_ok(w, mpm_context_destroy(w->context));
}

mpm_step_info world_info(const world *w) {
  mpm_step_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_stepper_info(w->stepper, &info));
  return info;
}

mpm_step_info world_step(world *w, double dt) {
  mpm_step_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_step(w->stepper, dt, &info));
  return info;
}

double world_stable_dt(world *w) {
  double dt;
  ck_ok(w, mpm_stable_dt(w->stepper, &dt));
  return dt;
}

double *fetch(const world *w, const mpm_particles *set, const char *field, int32_t components) {
  const int64_t n = mpm_particles_count(set);
  double *values = malloc((size_t)(n * components + 1) * sizeof *values);
  ck_ok(w, mpm_particles_get(set, field, MPM_F64, components, n, NULL, values));
  return values;
}

void put(const world *w, mpm_particles *set, const char *field, int32_t components, const double *values) {
  ck_ok(w, mpm_particles_set(set, field, MPM_F64, components, mpm_particles_count(set), NULL, values));
}

static void *fetch_view(world *w, const char *field, int64_t *n) {
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(w, mpm_grid_map(w->stepper, 0, field, MPM_READ, &view));
  char *values = malloc((size_t)(view.count * view.components + 1) * 8); /* doubles or 64-bit integers */
  for (int32_t c = 0; c < view.components; ++c)
    for (int64_t i = 0; i < view.count; ++i)
      memcpy(values + 8 * (c * view.count + i),
             (const char *)view.data + 8 * (i * view.item_stride + c * view.component_stride), 8);
  *n = view.count;
  ck_ok(w, mpm_view_release(&view));
  return values;
}

double *fetch_nodes(world *w, const char *field, int64_t *n) {
  return fetch_view(w, field, n);
}

int64_t *fetch_node_indices(world *w, int64_t *n) {
  return fetch_view(w, "index", n);
}

double weighted_sum(int64_t n, const double *mass, const double *a) {
  double sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += mass[i] * a[i];
  return sum;
}

double largest(int64_t n, const double *a) {
  double most = 0.0;
  for (int64_t i = 0; i < n; ++i)
    if (!(fabs(a[i]) <= most)) most = fabs(a[i]);
  return most;
}

double throw_between(dice *d, double low, double high) {
  uint64_t z = d->state += 0x9e3779b97f4a7c15u; /* splitmix64 */
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return low + (high - low) * ((double)(z >> 11) / 9007199254740992.0);
}

void add_cloud(const world *w, mpm_particles *set, dice *d, int64_t n, double h, double low, double high,
               double speed) {
  double *x = malloc((size_t)n * 16 * sizeof *x), *v = x + 3 * n, *volume = v + 3 * n, *F = volume + n;
  for (int64_t p = 0; p < n; ++p) {
    for (int32_t k = 0; k < w->dim; ++k) {
      x[k * n + p] = h * (floor(throw_between(d, low, high) / h * 16.0) + 0.5) / 16.0;
      v[k * n + p] = throw_between(d, -speed, speed);
    }
    volume[p] = throw_between(d, 0.5, 1.5) * pow(high - low, w->dim) / (double)n;
    for (int32_t c = 0; c < 9; ++c) {
      const int32_t row = c / 3, column = c % 3;
      F[c * n + p] =
          (row == column) + (row < w->dim && column < w->dim ? throw_between(d, -0.02, 0.02) : 0.0);
    }
  }
  ck_ok(w, mpm_particles_add(set, n, x, v, volume, NULL, NULL, NULL));
  put(w, set, "deformation_gradient", 9, F);
  free(x);
}

void add_affine(const world *w, mpm_particles *set, dice *d, double rate) {
  const int64_t n = mpm_particles_count(set);
  double *C = calloc((size_t)n * 9, sizeof *C);
  for (int64_t p = 0; p < n; ++p)
    for (int32_t c = 0; c < 9; ++c)
      if (c / 3 < w->dim && c % 3 < w->dim) C[c * n + p] = throw_between(d, -rate, rate);
  put(w, set, "velocity_gradient", 9, C);
  free(C);
}
