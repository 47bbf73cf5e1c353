/* What a host may do with a cloud of particles (cloud.h): steps in all forms, particles that come and go,
 * fields written, states saved and loaded, memory that runs out. Any status is an answer; numbers that are
 * not finite, particles or mass that come from nowhere and time that goes astray are not. */
#include <unistd.h>

#include "cloud.h"
#include "stepper/stepper.h"

/* ---- what must hold ------------------------------------------------------------------------------------ */
static int64_t count_all(const cloud *c) {
  int64_t n = 0;
  for (int32_t m = 0; m < c->sets; ++m) n += mpm_particles_count(c->set[m]);
  return n;
}

/* Particles that came by splitting, less those that merging took. */
static int64_t came_all(const cloud *c) {
  int64_t n = 0;
  for (int32_t m = 0; m < c->stepper->layout.member_count; ++m)
    n += c->stepper->adaption[m].sums.added - c->stepper->adaption[m].sums.merges;
  return n;
}

/* A field of all particles; to be freed. */
static void *get(cloud *c, const mpm_particles *set, const char *field, int32_t type, int32_t components) {
  const int64_t n = mpm_particles_count(set), fail_at = fuzz_no_failure(&c->memory);
  void *values = malloc(sizeof(double) * (size_t)(n * components + 1));
  MUST(!mpm_particles_get(set, field, type, components, n, NULL, values));
  c->memory.fail_at = fail_at;
  return values;
}

static double mass_all(cloud *c) {
  double sum = 0.0;
  for (int32_t m = 0; m < c->sets; ++m) {
    double *mass = get(c, c->set[m], "mass", MPM_F64, 1);
    for (int64_t i = 0; i < mpm_particles_count(c->set[m]); ++i) sum += mass[i];
    free(mass);
  }
  return sum;
}

static uint64_t hash_of(cloud *c) {
  uint64_t hash = 0;
  const int64_t fail_at = fuzz_no_failure(&c->memory);
  MUST(!mpm_state_hash(c->stepper, &hash) || c->repairable);
  c->memory.fail_at = fail_at;
  return hash;
}

static void inside_grid(cloud *c, const mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  const char *where = c->g.total_lagrangian ? "reference_position" : "position";
  double *x = get(c, set, where, MPM_F64, c->g.dim);
  for (int64_t i = 0; i < n * c->g.dim; ++i) {
    const int64_t k = i / n;
    MUST(x[i] >= c->g.origin[k] && x[i] <= c->g.origin[k] + (double)c->g.cells[k] * c->g.spacing[k]);
  }
  free(x);
}

static void check_state(cloud *c) {
  for (int32_t m = 0; m < c->sets; ++m) {
    if (!c->repairable) fuzz_finite(c->set[m]);
    inside_grid(c, c->set[m]);
  }
  MUST(count_all(c) == c->count);
  MUST(fabs(mass_all(c) - c->mass) <= 1e-12 * (c->mass + 1.0));
}

/* After calls whose steps were not followed one by one. */
static void look_anew(cloud *c) {
  c->memory.fail_at = 0;
  c->t = c->stepper->history.t;
  c->removed = c->stepper->history.removed;
  c->count = count_all(c);
  c->came = came_all(c);
  c->mass = mass_all(c);
}

/* After one or several steps: particles are lost through open walls only, and are counted. */
static void check_steps(cloud *c, const mpm_step_info *info) {
  const int64_t lost = info->removed - c->removed, count = count_all(c);
  MUST(lost >= 0 && count == c->count - lost + came_all(c) - c->came);
  const double mass = mass_all(c);
  MUST(lost ? mass <= c->mass * (1.0 + 1e-12) : fabs(mass - c->mass) <= 1e-12 * (c->mass + 1.0));
  c->count = count;
  c->came = came_all(c);
  c->mass = mass;
  c->removed = info->removed;
  c->t = info->t;
}

/* ---- what a host does ---------------------------------------------------------------------------------- */
static double draw_dt(cloud *c) {
  static const double share[] = {0.3, 0.1, 0.5, 0.9, 1.5, 4.0, 1e-3, 0.3};
  double dt;
  if (fuzz_status(c->context, mpm_stable_dt(c->stepper, &dt)) || !(dt < 1.0)) dt = 1e-2;
  return dt * FUZZ_PICK(&c->in, share);
}

static void step(cloud *c) {
  mpm_step_info info = {.struct_size = sizeof info};
  const double dt = draw_dt(c);
  const uint64_t before = hash_of(c);
  c->callback_status = fuzz_below(&c->in, 32) == 1;
  const mpm_status status = fuzz_status(c->context, mpm_step(c->stepper, dt, &info));
  c->callback_status = 0;
  if (status) {
    MUST(hash_of(c) == before);
    return;
  }
  MUST(info.t == c->t + dt && info.dt == dt);
  check_steps(c, &info);
}

static void advance(cloud *c) {
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_advance_desc d;
  MUST(!mpm_advance_desc_init(&d, sizeof d));
  d.t_end = c->t + 4.0 * draw_dt(c);
  d.cfl = fmax(0.0, fuzz_between(&c->in, -0.3, 1.0)); /* 0: the library chooses */
  d.max_steps = 8;
  const double t = c->t;
  const mpm_status status = fuzz_status(c->context, mpm_advance(c->stepper, &d, &info));
  info.t = c->stepper->history.t;
  info.removed = c->stepper->history.removed;
  MUST(info.t >= t && info.t <= d.t_end && (status || info.t > t || d.t_end == t));
  check_steps(c, &info);
}

/* Shifts a nodal field a little between the parts of a step. */
static void write_nodes(cloud *c, const char *field) {
  mpm_view v = {.struct_size = sizeof v};
  if (fuzz_status(c->context, mpm_grid_map(c->stepper, 0, field, MPM_READ | MPM_WRITE, &v))) return;
  const double shift = fuzz_between(&c->in, -0.1, 0.1);
  for (int64_t i = 0; i < v.count; ++i)
    for (int32_t k = 0; k < v.components; ++k)
      ((double *)v.data)[i * v.item_stride + k * v.component_stride] += shift;
  MUST(!mpm_view_release(&v));
}

static void staged(cloud *c) {
  mpm_step_info info = {.struct_size = sizeof info};
  const uint64_t before = hash_of(c);
  const double dt = draw_dt(c);
  const int32_t how = fuzz_below(&c->in, 16);
  mpm_status status = fuzz_status(c->context, mpm_step_begin(c->stepper, dt));
  if (!status && how & 1) write_nodes(c, "force");
  if (!status && how & 2) write_nodes(c, "velocity");
  if (!status && how != 4) status = fuzz_status(c->context, mpm_step_grid(c->stepper));
  if (!status && how & 8) write_nodes(c, "velocity");
  if (!status && (how == 4 || how == 12)) {
    MUST(!fuzz_status(c->context, mpm_step_abort(c->stepper)));
    MUST(hash_of(c) == before);
    return;
  }
  if (!status) status = fuzz_status(c->context, mpm_step_end(c->stepper, &info));
  if (status) {
    MUST(hash_of(c) == before);
    return;
  }
  MUST(info.t == c->t + dt);
  check_steps(c, &info);
}

static mpm_particles *draw_set(cloud *c) {
  return c->set[fuzz_below(&c->in, c->sets)];
}

static void add(cloud *c) {
  enum { MOST = 16 };
  double x[3 * MOST], v[3 * MOST], volume[MOST], size[3 * MOST], cell = 1.0;
  int64_t ids[MOST], first;
  mpm_particles *set = draw_set(c);
  const int64_t n = 1 + fuzz_below(&c->in, MOST), was = mpm_particles_count(set);
  const uint32_t how = fuzz_byte(&c->in);
  if (c->count + n > MOST_PARTICLES) return;
  for (int32_t k = 0; k < c->g.dim; ++k) {
    const double length = (double)c->g.cells[k] * c->g.spacing[k], at = fuzz_between(&c->in, 0.0, 1.0);
    const double spread = how & 1 ? 1.0 : 1.0 / (double)c->g.cells[k],
                 speed = fuzz_between(&c->in, -8.0, 8.0);
    for (int64_t i = 0; i < n; ++i) {
      double place = at + spread * ((double)((i * 37 + k * 11) % 16) / 16.0 - 0.5);
      if (!c->g.periodic[k] || !(how & 2)) place = place < 0.0 ? 0.0 : place > 1.0 ? 1.0 : place;
      x[k * n + i] = c->g.origin[k] + place * length;
      v[k * n + i] = speed + (double)(i % 3);
      size[k * n + i] = c->g.spacing[k] * fuzz_between(&c->in, 0.05, 1.0);
    }
    cell *= c->g.spacing[k];
  }
  for (int64_t i = 0; i < n; ++i) volume[i] = 0.25 * cell * (1.0 + (double)(i % 4));
  for (int64_t i = 0; i < n; ++i) ids[i] = (int64_t)fuzz_word(&c->in, how & 4 ? 1 : 0) + 7 * i;
  const mpm_status status =
      fuzz_status(c->context, mpm_particles_add(set, n, x, how & 8 ? v : NULL, volume, how & 16 ? size : NULL,
                                                how & 4 ? ids : NULL, &first));
  MUST(mpm_particles_count(set) == was + (status ? 0 : n));
  c->count = count_all(c);
  c->mass = mass_all(c);
}

/* Every `stride`-th particle of a set; 1: all. */
static void remove_some(cloud *c) {
  mpm_particles *set = draw_set(c);
  const int64_t n = mpm_particles_count(set), stride = 1 + fuzz_below(&c->in, 4);
  int64_t *ids = get(c, set, "id", MPM_I64, 1), gone = 0;
  for (int64_t i = 0; i < n; i += stride) ids[gone++] = ids[i];
  if (fuzz_below(&c->in, 8) == 1) ids[0] = 99999;
  const mpm_status status = fuzz_status(c->context, mpm_particles_remove(set, gone, ids));
  MUST(mpm_particles_count(set) == n - (status ? 0 : gone));
  c->count = count_all(c);
  c->mass = mass_all(c);
  free(ids);
}

/* A state is saved; the step after it gives the same bits when it is loaded. */
static void save_and_load(cloud *c) {
  int64_t bytes;
  const double dt = draw_dt(c);
  if (fuzz_status(c->context, mpm_state_size(c->stepper, &bytes))) return;
  void *state = malloc((size_t)bytes);
  if (!fuzz_status(c->context, mpm_state_save(c->stepper, state, bytes))) {
    const uint64_t saved = hash_of(c);
    const int64_t fails = c->memory.fail_at;
    const mpm_status first = fuzz_status(c->context, mpm_step(c->stepper, dt, NULL));
    const uint64_t ahead = hash_of(c);
    const mpm_status loaded = fuzz_status(c->context, mpm_state_load(c->stepper, state, bytes));
    MUST(!loaded || loaded == MPM_E_NOMEM);
    if (!loaded) {
      c->repairable = 0;
      MUST(hash_of(c) == saved);
      const mpm_status second = fuzz_status(c->context, mpm_step(c->stepper, dt, NULL));
      MUST(fails || (first == second && hash_of(c) == ahead));
    }
    look_anew(c);
  }
  free(state);
}

/* Values of a field scaled or replaced, through a view. */
static void write_view(cloud *c) {
  static const char *const field[] = {"velocity",
                                      "deformation_gradient",
                                      "velocity_gradient",
                                      "applied_force",
                                      "acceleration",
                                      "state",
                                      "stress",
                                      "size",
                                      "initial_volume",
                                      "temperature"};
  mpm_view v = {.struct_size = sizeof v};
  mpm_particles *set = draw_set(c);
  const char *name = FUZZ_PICK(&c->in, field);
  if (fuzz_status(c->context, mpm_particles_map(set, name, MPM_READ | MPM_WRITE, &v))) return;
  const double factor = fuzz_between(&c->in, 0.8, 1.2);
  for (int64_t i = 0; i < v.count; ++i)
    for (int32_t k = 0; k < v.components; ++k)
      ((double *)v.data)[i * v.item_stride + k * v.component_stride] *= factor;
  if (v.count && fuzz_below(&c->in, 32) == 1) ((double *)v.data)[0] = (double)NAN;
  fuzz_status(c->context, mpm_step(c->stepper, 1e-3, NULL)); /* refused: a view is out */
  c->repairable |= fuzz_status(c->context, mpm_view_release(&v)) != MPM_OK;
}

static void set_fields(cloud *c) {
  const double value[9] = {fuzz_between(&c->in, -1.0, 1.0), 0.1, 0.2};
  const uint8_t axes[3] = {1, (uint8_t)fuzz_below(&c->in, 2), 0};
  mpm_particles *set = draw_set(c);
  static const char *const vector[] = {"applied_force", "velocity", "acceleration", "size",
                                       "reference_position"};
  fuzz_status(c->context, mpm_particles_set_all(set, FUZZ_PICK(&c->in, vector), MPM_F64, c->g.dim, value));
  const int32_t further = fuzz_below(&c->in, 4), axis = fuzz_below(&c->in, 3);
  if (further == 1) fuzz_status(c->context, mpm_particles_set_all(set, "prescribed", MPM_U8, c->g.dim, axes));
  if (further == 2)
    fuzz_status(c->context, mpm_particles_set_geostatic(set, axis, value[0], value[0] < 0.0 ? 1e3 : -1e3,
                                                        fuzz_between(&c->in, 0.0, 2.0), 0.0));
  if (further == 3) fuzz_status(c->context, mpm_particles_reset_reference(set));
}

/* Fields as floats, into memory that holds no more than they need. */
static void pack(cloud *c) {
  static const char *const field[] = {"position", "velocity", "stress",     "state", "id",
                                      "colour",   "size",     "prescribed", "image", "reference_position"};
  const mpm_particles *set = draw_set(c);
  const int32_t count = 1 + fuzz_below(&c->in, 3);
  const int64_t n = mpm_particles_count(set);
  const char *names[3];
  size_t bytes = 0;
  for (int32_t i = 0; i < count; ++i) {
    names[i] = FUZZ_PICK(&c->in, field);
    const int32_t f = mpmi_find_field(set, names[i]);
    if (f >= 0) bytes += (size_t)n * (size_t)set->field[f].full_components * sizeof(float);
  }
  float *out = malloc(bytes);
  MUST(out || !bytes);
  fuzz_status(c->context, mpm_particles_get_f32(set, count, names, fuzz_below(&c->in, 3), n, out));
  free(out);
}

/* Particles leave as bytes and come back, all or none, with every bit; what memory denies is tried again. */
static void pack_and_unpack(cloud *c) {
  mpm_particles *set = draw_set(c);
  const int64_t n = mpm_particles_count(set), stride = 1 + fuzz_below(&c->in, 3);
  int64_t *ids = get(c, set, "id", MPM_I64, 1), some = 0, bytes = 0, size;
  for (int64_t i = 0; i < n; i += stride) ids[some++] = ids[i];
  MUST(!mpm_particles_packed_size(set, some, &bytes));
  void *packed = malloc((size_t)bytes), *again = malloc((size_t)bytes);
  if (!fuzz_status(c->context, mpm_particles_pack(set, some, ids, packed, bytes))) {
    MUST(mpm_particles_unpack(set, packed, bytes) == MPM_E_ARG || !some || c->memory.fail_at);
    if (!fuzz_status(c->context, mpm_particles_remove(set, some, ids))) {
      mpm_status status;
      while ((status = fuzz_status(c->context, mpm_particles_unpack(set, packed, bytes))) == MPM_E_NOMEM)
        MUST(mpm_particles_count(set) == n - some);
      MUST(!status && mpm_particles_count(set) == n);
      fuzz_no_failure(&c->memory);
      MUST(!mpm_particles_packed_size(set, some, &size) && size == bytes);
      MUST(!mpm_particles_pack(set, some, ids, again, bytes));
      MUST(!memcmp(packed, again, (size_t)bytes));
    }
  }
  c->count = count_all(c);
  c->mass = mass_all(c);
  free(ids), free(packed), free(again);
}

/* A host that takes so many bytes of an output, and looks at all of them. */
static mpm_status swallow(void *user, const void *data, int64_t bytes) {
  static volatile unsigned char seen;
  int64_t *left = user;
  MUST(bytes > 0 && bytes <= 65536);
  for (int64_t i = 0; i < bytes; ++i) seen = (unsigned char)(seen ^ ((const unsigned char *)data)[i]);
  *left -= bytes;
  return *left < 0;
}

static void write_streams(cloud *c) {
  int64_t left = 4000 * (int64_t)fuzz_byte(&c->in);
  const mpm_status status =
      fuzz_status(c->context, mpm_write_grid_to(c->stepper, fuzz_below(&c->in, 2), swallow, &left, 0, NULL));
  MUST((status == MPM_E_CALLBACK) == (left < 0));
  left = 4000 * (int64_t)fuzz_byte(&c->in);
  fuzz_status(c->context, mpm_write_particles_to(draw_set(c), swallow, &left, 0, NULL));
  fuzz_status(c->context, mpm_state_save_to(c->stepper, swallow, &left));
}

static void write_files(cloud *c) {
  char path[64];
  snprintf(path, sizeof path, "/tmp/mpm-fuzz-%ld", (long)getpid());
  fuzz_status(c->context, mpm_write_grid(c->stepper, path, 0, NULL));
  fuzz_status(c->context, mpm_write_particles(draw_set(c), path, 0, NULL));
  fuzz_status(c->context, mpm_state_save_file(c->stepper, path));
  unlink(path);
}

/* A set leaves the stepper and comes back, last in order. */
static void leave_and_return(cloud *c) {
  mpm_particles *set = draw_set(c);
  if (fuzz_status(c->context, mpm_stepper_remove(c->stepper, set))) return;
  if (fuzz_below(&c->in, 2)) fuzz_status(c->context, mpm_step(c->stepper, 1e-4, NULL));
  c->memory.fail_at = 0;
  MUST(!mpm_stepper_add(c->stepper, set));
  look_anew(c);
}

static mpm_status choose(void *user, const mpm_adaption_batch *batch, uint8_t *accept) {
  const cloud *c = user;
  for (int64_t i = 0; i < batch->n; ++i) accept[i] = batch->id[i] % 3 != 0;
  return c->callback_status;
}

static void draw_adaption(cloud *c) {
  mpm_particles *set = draw_set(c);
  mpm_adaption_desc d;
  mpm_adaption_info info = {.struct_size = sizeof info};
  MUST(!mpm_adaption_desc_init(&d, sizeof d));
  d.every = fuzz_below(&c->in, 4);
  d.split_edge = fuzz_between(&c->in, 0.0, 2.0);
  d.least_edge = fuzz_between(&c->in, 0.0, 0.5);
  d.min_per_cell = fuzz_below(&c->in, 4);
  d.max_per_cell = fuzz_below(&c->in, 8);
  d.merge_distance = fuzz_between(&c->in, 0.0, 2.0);
  d.merge_tolerance = fuzz_between(&c->in, -0.1, 2.0);
  d.most_particles = MOST_PARTICLES;
  if (fuzz_below(&c->in, 4) == 0) d.accept = choose, d.user = c;
  fuzz_status(c->context, mpm_stepper_set_adaption(c->stepper, set, fuzz_below(&c->in, 8) ? &d : NULL));
  if (fuzz_below(&c->in, 2)) fuzz_status(c->context, mpm_stepper_adapt(c->stepper));
  fuzz_status(c->context, mpm_stepper_adaption_info(c->stepper, set, &info));
  MUST(isfinite(info.kinetic_loss) && isfinite(info.affine_loss) && isfinite(info.strain_loss));
  const double mass = mass_all(c);
  MUST(fabs(mass - c->mass) <= 1e-12 * (c->mass + 1.0));
  look_anew(c);
}

static mpm_status warm(void *user, const mpm_particle_batch *batch, double *power) {
  const cloud *c = user;
  for (int64_t i = 0; i < batch->n; ++i) power[i] = 10.0 * (double)(batch->id[i] % 5);
  return c->callback_status;
}

static void draw_heat(cloud *c) {
  mpm_particles *set = draw_set(c);
  mpm_heat_desc d;
  mpm_heat_info info = {.struct_size = sizeof info};
  MUST(!mpm_heat_desc_init(&d, sizeof d));
  d.specific_heat = fuzz_between(&c->in, -0.1, 10.0);
  d.conductivity = fuzz_between(&c->in, -0.1, 100.0);
  d.expansion = fuzz_below(&c->in, 2) ? 0.0 : fuzz_between(&c->in, -1e-3, 1e-3);
  d.reference_temperature = fuzz_between(&c->in, -10.0, 300.0);
  d.dissipated_share = fuzz_below(&c->in, 2) ? 0.0 : fuzz_between(&c->in, -0.1, 1.1);
  if (fuzz_below(&c->in, 4) == 0) d.source = warm, d.user = c;
  fuzz_status(c->context, mpm_stepper_set_heat(c->stepper, set, fuzz_below(&c->in, 8) ? &d : NULL));
  fuzz_status(c->context,
              mpm_stepper_set_conduction(c->stepper, fuzz_below(&c->in, 3), fuzz_between(&c->in, -0.1, 1.1)));
  fuzz_status(c->context,
              mpm_stepper_set_heat_wall(c->stepper, fuzz_below(&c->in, 7) - 1, fuzz_below(&c->in, 3),
                                        fuzz_between(&c->in, -100.0, 500.0)));
  for (int32_t i = 0; i < SURFACES; ++i)
    if (c->surface[i])
      fuzz_status(c->context,
                  mpm_surface_set_heat(c->surface[i], fuzz_between(&c->in, -10.0, 10.0),
                                       fuzz_between(&c->in, -0.1, 10.0), fuzz_between(&c->in, 0.0, 300.0)));
  if (!fuzz_status(c->context, mpm_stepper_heat_info(c->stepper, &info)))
    MUST(isfinite(info.heat) && isfinite(info.gained_total));
  look_anew(c);
}

static void look(cloud *c) {
  static const char *const field[] = {"mass",         "force",      "reaction",      "acceleration",
                                      "velocity",     "index",      "contact_force", "contact_normal",
                                      "contact_area", "temperature"};
  mpm_view v = {.struct_size = sizeof v};
  mpm_contact_info contact = {.struct_size = sizeof contact};
  double force[3];
  const int32_t body = fuzz_below(&c->in, 8) ? 0 : fuzz_below(&c->in, 3);
  if (!fuzz_status(c->context, mpm_grid_map(c->stepper, body, FUZZ_PICK(&c->in, field), MPM_READ, &v))) {
    for (int64_t i = 0; i < v.count && v.type == MPM_F64; ++i)
      for (int32_t k = 0; k < v.components; ++k)
        MUST(isfinite(((double *)v.data)[i * v.item_stride + k * v.component_stride]));
    MUST(!mpm_view_release(&v));
  }
  fuzz_status(c->context, mpm_stepper_contact_info(c->stepper, fuzz_below(&c->in, 4) - 1, 1, &contact));
  for (int32_t i = 0; i < OBSTACLES; ++i) {
    if (!c->obstacle[i] || fuzz_status(c->context, mpm_obstacle_contact_info(c->obstacle[i], -1, &contact)))
      continue;
    for (int32_t k = 0; k < 3; ++k) MUST(isfinite(contact.force[k]) && isfinite(contact.torque[k]));
  }
  fuzz_status(c->context, mpm_stepper_wall_reaction(c->stepper, fuzz_below(&c->in, 6), force));
  fuzz_status(c->context, mpm_stepper_particles_reaction(c->stepper, c->set[0], force));
  fuzz_status(c->context, mpm_stepper_wall_impulse(c->stepper, fuzz_below(&c->in, 6), force));
  fuzz_status(c->context, mpm_stepper_particles_impulse(c->stepper, c->set[c->sets - 1], force));
}

static void act(cloud *c) {
  const int32_t what = fuzz_below(&c->in, 32);
  c->memory.calls = 0;
  c->memory.fail_at = what == 31 ? 1 + fuzz_below(&c->in, 24) : 0; /* in the action that follows */
  switch (what == 31 ? fuzz_below(&c->in, 31) : what) {
  case 0:
  case 1:
  case 2:
    add(c);
    break;
  case 3:
    remove_some(c);
    break;
  case 4:
  case 5:
    advance(c);
    break;
  case 6:
  case 7:
  case 8:
    staged(c);
    break;
  case 9:
  case 10:
    save_and_load(c);
    break;
  case 11:
  case 12:
    write_view(c);
    break;
  case 13:
    set_fields(c);
    break;
  case 14:
    write_files(c);
    break;
  case 15:
    leave_and_return(c);
    break;
  case 16: {
    const mpm_stepper_desc d = draw_stepper(c);
    fuzz_status(c->context, mpm_stepper_configure(c->stepper, &d));
    break;
  }
  case 17:
    draw_wall(c);
    break;
  case 18:
    look(c);
    break;
  case 19:
    draw_bodies(c);
    break;
  case 20:
  case 21:
    draw_obstacle(c);
    break;
  case 22:
    pack(c);
    break;
  case 23:
    write_streams(c);
    break;
  case 24:
  case 25:
    draw_surface(c);
    break;
  case 26:
    draw_adaption(c);
    break;
  case 27:
    draw_heat(c);
    break;
  case 28:
    pack_and_unpack(c);
    break;
  default:
    step(c);
  }
  c->memory.fail_at = 0;
}

static void close_cloud(cloud *c) {
  MUST(!mpm_stepper_destroy(c->stepper));
  for (int32_t i = 0; i < OBSTACLES; ++i) MUST(!mpm_obstacle_destroy(c->obstacle[i]));
  for (int32_t i = 0; i < SURFACES; ++i) MUST(!mpm_surface_destroy(c->surface[i]));
  for (int32_t m = 0; m < c->sets; ++m) MUST(!mpm_particles_destroy(c->set[m]));
  for (int32_t m = 0; m < c->sets; ++m) MUST(!mpm_material_destroy(c->material[m]));
  MUST(!mpm_grid_destroy(c->grid));
  fuzz_close(c->context, &c->memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  cloud c;
  memset(&c, 0, sizeof c);
  c.in = (fuzz_input){data, data + size};
  c.context = fuzz_context(&c.memory, 1 + (fuzz_below(&c.in, 16) == 1));
  open_grid(&c);
  for (int32_t sets = 1 + fuzz_below(&c.in, SETS); c.sets < sets; ++c.sets) {
    c.material[c.sets] = open_material(&c);
    while (mpm_particles_create(c.context, c.grid, c.material[c.sets], &c.set[c.sets])) {
      MUST(!mpm_material_destroy(c.material[c.sets])); /* not on this grid */
      c.material[c.sets] = host_material(&c);
    }
  }
  MUST(!mpm_particles_add_field(c.set[0], "colour", MPM_U8, 3));
  MUST(!mpm_particles_add_field(c.set[0], "heat", MPM_F64, 1));
  open_stepper(&c);
  add(&c);
  for (int32_t i = 0; i < MOST_ACTIONS && fuzz_left(&c.in); ++i) {
    act(&c);
    check_state(&c);
  }
  close_cloud(&c);
  return 0;
}
