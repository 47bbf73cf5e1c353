/* Surfaces that load a body in several parts. */
#include "shared.h"

enum { EDGES = 40 };

/* ---- surfaces ------------------------------------------------------------------------------------------ */
/* A load that differs from marker to marker. */
static mpm_status push_by_place(void *user, const mpm_marker_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    for (int32_t k = 0; k < b->dim; ++k) add[k * b->ld + i] += 400.0 * sin(9.0 * b->position[i] + k);
  return MPM_OK;
}

/* It lies inside the body, and its corners come near the outline. */
mpm_status add_around(const world *w, mpm_surface *s, double middle, double radius, double spacing) {
  if (w->dim == 1) {
    const double x[] = {middle - radius, middle + radius}, area[] = {-1.0, 1.0};
    return mpm_surface_add(s, 2, x, area, NULL);
  }
  double x[3 * EDGES];
  int64_t corner[24];
  for (int32_t i = 0; i < 3 * EDGES; ++i) x[i] = middle;
  if (w->dim == 2) {
    for (int32_t i = 0; i < EDGES; ++i) {
      x[i] += radius * cos(2.0 * PI * i / EDGES);
      x[EDGES + i] += radius * sin(2.0 * PI * i / EDGES);
    }
    return mpm_surface_add_polyline(s, EDGES, x, 1, spacing, NULL, NULL);
  }
  for (int32_t i = 0; i < 6; ++i) x[i / 2 * 6 + i] += i % 2 ? -radius : radius;
  for (int32_t f = 0; f < 8; ++f) {
    const int32_t odd = (f & 1) ^ (f >> 1 & 1) ^ (f >> 2 & 1);
    corner[3 * f] = f & 1;
    corner[3 * f + 1 + odd] = 2 + (f >> 1 & 1);
    corner[3 * f + 2 - odd] = 4 + (f >> 2 & 1);
  }
  return mpm_surface_add_triangles(s, 6, x, 8, corner, spacing, NULL, NULL);
}

mpm_status add_loads(world *w, double middle, double radius, mpm_surface **out) {
  mpm_surface_desc d;
  const double h = w->desc.grid.spacing[0];
  mpm_status status = mpm_surface_desc_init(&d, sizeof d);
  d.pressure = 500.0;
  d.traction[0] = 200.0;
  d.dead_traction[0] = -100.0;
  d.max_spacing = 0.5 * h;
  if (!status) status = mpm_surface_create(w->context, w->grid, &d, out);
  if (!status) status = mpm_surface_set_traction(*out, push_by_place, NULL);
  if (!status) status = add_around(w, *out, middle, radius, h);
  return status ? status : mpm_stepper_add_surface(w->stepper, *out);
}

/* A velocity that differs from marker to marker. */
static mpm_status drag_by_place(void *user, const mpm_marker_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    for (int32_t k = 0; k < b->dim; ++k) add[k * b->ld + i] += 0.02 * sin(9.0 * b->position[i] + k + b->t);
  return MPM_OK;
}

mpm_status add_holder(world *w, double middle, double radius, int32_t prescribes, mpm_surface **out) {
  mpm_surface_desc d;
  mpm_status status = mpm_surface_desc_init(&d, sizeof d);
  d.prescribes = prescribes;
  d.velocity[0] = 0.02;
  d.dead_traction[0] = 50.0;
  d.penalty = 10.0;
  if (!status) status = mpm_surface_create(w->context, w->grid, &d, out);
  if (!status) status = mpm_surface_set_velocity(*out, drag_by_place, NULL);
  if (!status) status = add_around(w, *out, middle, radius, 0.7 * w->desc.grid.spacing[0]);
  return status ? status : mpm_stepper_add_surface(w->stepper, *out);
}

mpm_status drop_loads(world *w, mpm_surface *s) {
  const mpm_status status = mpm_stepper_remove_surface(w->stepper, s);
  return status ? status : mpm_surface_destroy(s);
}

mpm_status mix_markers(const world *w, const mpm_surface *s, uint64_t *hash) {
  static const char *const field[] = {"position", "area",     "displacement",  "velocity",
                                      "force",    "reaction", "reference_area"};
  enum { VECTORS = 6, FIELDS };
  const int64_t n = mpm_surface_count(s);
  double *value = calloc((size_t)(3 * n + 1), sizeof *value);
  mpm_status status = MPM_OK;
  *hash = *hash * 31 + (uint64_t)n;
  for (int32_t f = 0; f < FIELDS && !status; ++f) {
    const int32_t components = f < VECTORS ? w->dim : 1;
    status = mpm_surface_get(s, field[f], MPM_F64, components, n, NULL, value);
    for (int64_t i = 0; i < components * n && !status; ++i) {
      uint64_t word;
      memcpy(&word, &value[i], sizeof word);
      *hash = (*hash ^ word) * 0x100000001b3u;
      *hash ^= *hash >> 29;
    }
  }
  free(value);
  return status;
}

/* ---- bits ---------------------------------------------------------------------------------------------- */
/* Two surfaces, the second of which comes when the body has moved for a while, and the first goes. */
static mpm_status load(world *w, const scene *is, outcome *found) {
  double dt;
  mpm_surface *s[2] = {NULL, NULL};
  (void)is;
  mpm_status status = add_loads(w, 0.45, 0.2, &s[0]), mixed = MPM_OK;
  const int64_t had = status ? 0 : mpm_surface_count(s[0]);
  if (!status) status = mpm_stable_dt(w->stepper, &dt);
  for (int32_t i = 0; i < STEPS && !status; ++i) {
    if (i == 6) status = add_loads(w, 0.5, 0.15, &s[1]);
    if (i == 12) {
      mixed = mix_markers(w, s[0], &found->markers);
      if (w->dim > 1 && mpm_surface_count(s[0]) <= had) return MPM_E_INTERNAL; /* some were split */
      status = drop_loads(w, s[0]);
      s[0] = NULL;
    }
    if (!status) status = mpm_step(w->stepper, dt * (0.2 + 0.1 * (i % 3)), &w->info);
  }
  if (!status) status = mixed;
  if (!status) status = mix_markers(w, s[1], &found->markers);
  for (int32_t i = 0; i < 2; ++i)
    if (s[i]) drop_loads(w, s[i]);
  return status;
}

START_TEST(loads_combine) {
  scene is;
  char name[300];
  if (!describe_option(&is, _i, _i % 2, name, sizeof name)) return;
  is.set_up = set_up_body;
  is.run = load;
  is.speed = 8.0;
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* Markers that cross a period and leave through an open wall. */
static mpm_status set_up_flight(world *w, const scene *is) {
  mpm_status status = MPM_OK;
  for (int32_t face = 2; face < 4 && !status; ++face)
    status = mpm_stepper_set_wall(w->stepper, face, MPM_WALL_OPEN, 0.0);
  if (!status) status = fill_middle(w, w->set[0], 0.5, 0.99);
  return status ? status : set_velocities(w, w->set[0], is->speed);
}

static mpm_status fly(world *w, const scene *is, outcome *found) {
  double dt;
  mpm_surface *s = NULL;
  (void)is;
  mpm_status status = add_loads(w, 0.72, 0.2, &s);
  int64_t most = 0;
  if (!status) status = mpm_stable_dt(w->stepper, &dt);
  for (int32_t i = 0; i < 100 && !status; ++i) {
    status = mpm_step(w->stepper, 0.3 * dt, &w->info);
    most = mpm_surface_count(s) > most ? mpm_surface_count(s) : most;
  }
  if (!status) status = mix_markers(w, s, &found->markers);
  if (!status && mpm_surface_count(s) >= most) status = MPM_E_INTERNAL; /* none has left */
  if (s) drop_loads(w, s);
  return status;
}

START_TEST(markers_fly) {
  scene is = scene_of(2, 96, set_up_flight);
  is.desc.grid.periodic[0] = 1;
  is.desc.grid.cells[0] = is.desc.grid.cells[1] = 89; /* a period that is no multiple of a block */
  is.desc.grid.basis = _i % 2 ? MPM_LINEAR : MPM_BSPLINE2;
  is.desc.stepper.scheme = _i % 2 ? MPM_MUSL : MPM_USL;
  is.run = fly;
  is.speed = 40.0;
  check_made(&is, "flight", 2 + _i);
}
END_TEST

/* ---- failures ------------------------------------------------------------------------------------------ */
mpm_status refuse_markers(void *user, const mpm_marker_batch *b, double *add) {
  (void)b, (void)add;
  return *(mpm_status *)user;
}

mpm_status expect_step(world *w, double dt, mpm_status wanted, const char *words) {
  const mpm_status status = mpm_step(w->stepper, dt, &w->info);
  if (status == wanted && strstr(mpm_last_error(w->context), words) && w->info.cause == wanted) return MPM_OK;
  fprintf(stderr, "%s: %s\n", mpm_status_name(status), mpm_last_error(w->context));
  return MPM_E_INTERNAL;
}

/* All parts fail as one does, and go on from the state before. */
static mpm_status fail_loads(world *w, const scene *is, outcome *found) {
  double dt = 0.0;
  mpm_surface *s = NULL;
  mpm_status answer = MPM_OK;
  int32_t part = 0, parts = 1;
  (void)is;
  mpm_context_part(w->context, &part, &parts);
  mpm_status status = add_loads(w, 0.45, 0.2, &s);
  if (!status) status = mpm_stable_dt(w->stepper, &dt);
  dt *= 0.3;
  for (int32_t i = 0; i < 4 && !status; ++i) status = mpm_step(w->stepper, dt, &w->info);
  if (!status) status = mpm_surface_set_traction(s, refuse_markers, &answer);
  if (part == parts - 1) answer = -3; /* one of them says no */
  if (!status) status = expect_step(w, dt, MPM_E_CALLBACK, "the traction callback of surface 0 returned -3");
  answer = MPM_OK;
  const double x[] = {0.9, 0.9}, area[] = {0.01, 0.0};
  int64_t id;
  if (!status) status = mpm_surface_add(s, 1, x, area, &id);
  if (!status) status = expect_step(w, dt, MPM_E_STATE, "has a load and no material around it");
  if (!status && mpm_step_begin(w->stepper, dt) != MPM_E_STATE) status = MPM_E_INTERNAL;
  if (!status) status = mpm_surface_remove(s, 1, &id);
  const double huge = 1e300;
  id = 0;
  if (!status) status = mpm_surface_set(s, "pressure", MPM_F64, 1, 1, &id, &huge);
  if (!status && mpm_step(w->stepper, dt, &w->info) == MPM_OK) status = MPM_E_INTERNAL;
  const double none = 0.0;
  if (!status) status = mpm_surface_set(s, "pressure", MPM_F64, 1, 1, &id, &none);
  for (int32_t i = 0; i < 4 && !status; ++i) status = mpm_step(w->stepper, dt, &w->info);
  if (!status) status = mix_markers(w, s, &found->markers);
  if (!status && parts > 1) { /* markers that only one part has */
    if (part == 1) status = mpm_surface_add(s, 1, x, NULL, NULL);
    if (!status) status = expect_step(w, dt, MPM_E_STATE, "other numbers of markers");
    if (status == MPM_OK) w->info.cause = MPM_OK;
  }
  if (s) drop_loads(w, s);
  return status;
}

START_TEST(loads_fail_together) {
  scene is = scene_of(2, 96, set_up_body);
  is.run = fail_loads;
  check_made(&is, "failures", 2 + _i);
}
END_TEST

/* Loads on a body with heat. */
static mpm_status load_warm(world *w, const scene *is, outcome *found) {
  mpm_surface *s = NULL;
  (void)is;
  mpm_status status = add_loads(w, 0.3, 0.2, &s);
  if (!status) status = run_steps(w);
  if (!status) status = mix_markers(w, s, &found->markers);
  if (s) drop_loads(w, s);
  return status;
}

START_TEST(loads_on_warm_bodies) {
  scene is = warm_scene(96, _i % 2);
  is.run = load_warm;
  check_made(&is, "warm and loaded", 2 + _i);
}
END_TEST

void add_shared_surfaces(Suite *suite) {
  TCase *surfaces = tcase_create("surfaces");
  tcase_set_timeout(surfaces, 120);
  add_option_list(surfaces);
  TCase *wide = wide_case(suite, "more surfaces");
  add_option_list(wide);
  add_table(surfaces, wide, loads_combine, OPTIONS_SAMPLE);
  tcase_add_loop_test(surfaces, markers_fly, 0, 4);
  tcase_add_loop_test(surfaces, loads_fail_together, 0, 4);
  tcase_add_loop_test(surfaces, loads_on_warm_bodies, 0, 4);
  suite_add_tcase(suite, surfaces);
}
