/* What tests read from a world, write into it and compare. */
#include "world.h"

void *fetch_as(const world *w, const mpm_particles *set, const char *field, int32_t type,
               int32_t components) {
  const int64_t n = mpm_particles_count(set);
  void *values = malloc((size_t)(n * components + 1) * 8); /* the largest type */
  ck_ok(w, mpm_particles_get(set, field, type, components, n, NULL, values));
  return values;
}

double *fetch(const world *w, const mpm_particles *set, const char *field, int32_t components) {
  return fetch_as(w, set, field, MPM_F64, components);
}

int64_t *fetch_ids(const world *w, const mpm_particles *set) {
  return fetch_as(w, set, "id", MPM_I64, 1);
}

void put(const world *w, mpm_particles *set, const char *field, int32_t components, const double *values) {
  ck_ok(w, mpm_particles_set(set, field, MPM_F64, components, mpm_particles_count(set), NULL, values));
}

double fetch1(const world *w, const mpm_particles *set, const char *field, int32_t components, int32_t c,
              int64_t id) {
  double value[81];
  ck_ok(w, mpm_particles_get(set, field, MPM_F64, components, 1, &id, value));
  return value[c];
}

static void *fetch_view(world *w, const char *field, int32_t type, int64_t *n) {
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(w, mpm_grid_map(w->stepper, 0, field, MPM_READ, &view));
  ck_assert_int_eq(view.type, type);
  const int32_t scalar = !strcmp(field, "mass") || !strcmp(field, "contact_gap") ||
                         !strcmp(field, "contact_area") || !strcmp(field, "temperature");
  ck_assert_int_eq(view.components, scalar ? 1 : w->dim);
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
  return fetch_view(w, field, MPM_F64, n);
}

int64_t *fetch_node_indices(world *w, int64_t *n) {
  return fetch_view(w, "index", MPM_I64, n);
}

double mass_of(const world *w, const mpm_particles *set) {
  double *mass = fetch(w, set, "mass", 1);
  const double sum = sum_of(mpm_particles_count(set), mass);
  free(mass);
  return sum;
}

double sum_of(int64_t n, const double *a) {
  double sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += a[i];
  return sum;
}

double weighted_sum(int64_t n, const double *mass, const double *a) {
  double sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += mass[i] * a[i];
  return sum;
}

double largest(int64_t n, const double *a) {
  double most = 0.0;
  for (int64_t i = 0; i < n && !isnan(most); ++i)
    if (!(fabs(a[i]) <= most)) most = fabs(a[i]);
  return most;
}

double determinant(const double *F) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
         F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/* ---- states ---- */
uint64_t world_hash(const world *w) {
  uint64_t hash = 0;
  ck_ok(w, mpm_state_hash(w->stepper, &hash));
  return hash;
}

char *world_fields(const world *w, int32_t m, size_t *bytes) {
  const mpm_particles *set = w->set[m];
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
    ck_ok(w, status);
    *bytes += size;
  }
  return all;
}

world_bits world_take(const world *w) {
  world_bits bits = {.hash = world_hash(w)};
  for (int32_t m = 0; m < w->sets; ++m) bits.field[m] = world_fields(w, m, &bits.bytes[m]);
  return bits;
}

void world_same(const world *w, const world_bits *was, const char *what) {
  world_bits is = world_take(w);
  for (int32_t m = 0; m < w->sets; ++m) {
    ck_assert_msg(is.bytes[m] == was->bytes[m], "%s: set %d has %zu bytes, had %zu", what, (int)m,
                  is.bytes[m], was->bytes[m]);
    ck_assert_msg(memcmp(is.field[m], was->field[m], is.bytes[m]) == 0, "%s: fields of set %d have changed",
                  what, (int)m);
  }
  ck_assert_msg(is.hash == was->hash, "%s: the hash has changed", what);
  bits_drop(&is);
}

void bits_drop(world_bits *bits) {
  for (int32_t m = 0; m < MOST_SETS; ++m) free(bits->field[m]);
}

void world_agree(const char *name, const world *a, const world *b, const char *field, int32_t components,
                 double tolerance) {
  for (int32_t m = 0; m < a->sets && m < b->sets; ++m) {
    const int64_t n = mpm_particles_count(a->set[m]);
    ck_assert_int_eq(n, mpm_particles_count(b->set[m]));
    double *x = fetch(a, a->set[m], field, components), *y = fetch(b, b->set[m], field, components);
    const double scale = largest(n * components, x);
    for (int64_t i = 0; i < n * components; ++i)
      if (!(fabs(x[i] - y[i]) <= tolerance * scale))
        ck_abort_msg("%s: %s of set %d: %g apart of %g", name, field, (int)m, fabs(x[i] - y[i]), scale);
    free(x), free(y);
  }
}

void same_info(const world *a, const world *b) {
  const mpm_step_info x = world_info(a), y = world_info(b);
  ck_assert_mem_eq(&x, &y, sizeof x);
}

saved_state world_save(const world *w) {
  saved_state state;
  ck_ok(w, mpm_state_size(w->stepper, &state.bytes));
  state.data = malloc((size_t)state.bytes);
  ck_ok(w, mpm_state_save(w->stepper, state.data, state.bytes));
  return state;
}

void world_load(world *w, const saved_state *state) {
  ck_ok(w, mpm_state_load(w->stepper, state->data, state->bytes));
}

void world_copy(const world *from, world *to) {
  const saved_state state = world_save(from);
  world_load(to, &state);
  free(state.data);
}

uint64_t world_step_again(world *w, double dt) {
  const saved_state state = world_save(w);
  world_step(w, dt);
  const uint64_t hash = world_hash(w);
  world_load(w, &state);
  world_step(w, dt);
  ck_assert_uint_eq(world_hash(w), hash);
  free(state.data);
  return hash;
}

/* ---- what is random and the same in every run ---- */
uint64_t mixed(uint64_t seed) { /* splitmix64 */
  seed += UINT64_C(0x9e3779b97f4a7c15);
  seed = (seed ^ seed >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  seed = (seed ^ seed >> 27) * UINT64_C(0x94d049bb133111eb);
  return seed ^ seed >> 31;
}

double noise_at(uint64_t seed) {
  return (double)(mixed(seed) >> 11) * 0x1p-52 - 1.0;
}

double throw_between(dice *d, double low, double high) {
  const double part = (double)(mixed(d->state) >> 11) / 9007199254740992.0;
  d->state += UINT64_C(0x9e3779b97f4a7c15);
  return low + (high - low) * part;
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
