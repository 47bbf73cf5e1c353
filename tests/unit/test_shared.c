/* One problem in several parts has the bits that it has in one. Parts are threads here (parts.h), where
 * Check's macros may not be used: every part keeps what it has found, which is compared afterwards. */
#include "combinations.h"
#include "parts.h"

enum { MOST_PARTS = 5, STEPS = 16, SAMPLE = 120 };

typedef struct outcome {
  mpm_status status;
  char text[400];
  uint64_t hash;
  mpm_step_info info;
  double reaction[6][3], stable_dt;
  int64_t total, own;
  mpm_parallel_info parallel;
} outcome;

typedef struct scene scene;
typedef mpm_status (*scene_fn)(world *w, const scene *is);
struct scene {
  world_desc desc;
  scene_fn set_up, run; /* run: NULL for STEPS steps */
  double speed;
  int32_t spread; /* 1: the last part adds all particles */
  outcome found[MOST_PARTS];
};

/* Velocities that follow from the positions: a spin and a drift, so that particles change their blocks. */
static mpm_status set_velocities(world *w, mpm_particles *set, double speed) {
  const int64_t n = mpm_particles_count(set);
  const int32_t dim = w->dim;
  double *x = calloc((size_t)(n * dim + 1), 2 * sizeof *x), *v = x + n * dim;
  const double middle = 0.5 * w->desc.grid.spacing[0] * (double)w->desc.grid.cells[0];
  mpm_status status = mpm_particles_get(set, "position", MPM_F64, dim, n, NULL, x);
  for (int64_t p = 0; p < n && !status; ++p) {
    const double across = dim > 1 ? x[n + p] - middle : 0.0;
    v[p] = speed * (1.0 + across);
    if (dim > 1) v[n + p] = speed * (0.4 - x[p] + middle);
    if (dim > 2) v[2 * n + p] = -0.3 * speed;
  }
  if (!status) status = mpm_particles_set(set, "velocity", MPM_F64, dim, n, NULL, v);
  free(x);
  return status;
}

static mpm_status fill_middle(world *w, mpm_particles *set, double from, double to) {
  const double size = w->desc.grid.spacing[0] * (double)w->desc.grid.cells[0];
  const double low[] = {from * size, from * size, from * size}, high[] = {to * size, to * size, to * size};
  const int32_t per_cell[] = {2, 2, 2};
  return mpm_particles_fill_box(set, low, high, per_cell, NULL, NULL);
}

static mpm_status set_walls(world *w) {
  mpm_status status = MPM_OK;
  for (int32_t face = 0; face < 2 * w->dim && !status; ++face)
    if (!w->desc.grid.periodic[face / 2])
      status = mpm_stepper_set_wall(w->stepper, face, face % 2 ? MPM_WALL_SLIP : MPM_WALL_FIXED, 0.0);
  return status;
}

static mpm_status run_steps(world *w, const scene *is) {
  double dt;
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  (void)is;
  for (int32_t i = 0; i < STEPS && !status; ++i)
    status = mpm_step(w->stepper, dt * (0.2 + 0.1 * (i % 3)), &w->info);
  return status;
}

static mpm_status play(world *w, scene *is, outcome *found) {
  mpm_status status = world_try_open(w);
  w->info.struct_size = sizeof w->info;
  if (!status) status = is->set_up(w, is);
  if (!status) status = is->run ? is->run(w, is) : run_steps(w, is);
  found->info.struct_size = sizeof found->info;
  found->parallel.struct_size = sizeof found->parallel;
  mpm_status read = mpm_stepper_info(w->stepper, &found->info);
  if (!read) read = mpm_state_hash(w->stepper, &found->hash);
  if (!read) read = mpm_stable_dt(w->stepper, &found->stable_dt);
  if (!read) read = mpm_particles_total(w->set[0], &found->total);
  if (!read) read = mpm_stepper_parallel_info(w->stepper, 0, &found->parallel);
  for (int32_t face = 0; face < 2 * w->dim && !read && found->info.step > 0; ++face)
    read = mpm_stepper_wall_reaction(w->stepper, face, found->reaction[face]);
  found->own = mpm_particles_count(w->set[0]);
  return status ? status : read;
}

static void live(int32_t part, const mpm_transport *transport, void *user) {
  scene *is = user;
  outcome *found = &is->found[part];
  world w;
  memset(&w, 0, sizeof w);
  w.desc = is->desc;
  w.desc.context.transport = transport;
  found->status = play(&w, is, found);
  if (found->status) snprintf(found->text, sizeof found->text, "%s", mpm_last_error(w.context));
  if (world_try_close(&w) && !found->status) found->status = MPM_E_INTERNAL;
}

/* Plays the scene in one part, and then in several. */
static void check_scene(const scene *is, const char *name, int32_t parts) {
  scene one = *is, many = *is;
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  live(0, NULL, &one);
  if (parts_run(parts, live, &many, &plan)) ck_abort_msg("%s, %d parts: %s", name, parts, plan.text);
  const outcome *a = &one.found[0];
  for (int32_t r = 0; r < parts; ++r) {
    const outcome *b = &many.found[r];
    if (a->status != b->status)
      ck_abort_msg("%s, part %d of %d: %s (%s) and not %s (%s)", name, r, parts, mpm_status_name(b->status),
                   b->text, mpm_status_name(a->status), a->text);
    if (a->hash != b->hash)
      ck_abort_msg("%s, part %d of %d: another state after %lld steps, %lld sorts", name, r, parts,
                   (long long)b->info.step, (long long)b->info.resorts);
    if (memcmp(&a->info, &b->info, sizeof a->info) != 0)
      ck_abort_msg("%s, part %d of %d: kinetic energy %.17g, %.17g; active nodes %lld, %lld; work %g, %g",
                   name, r, parts, a->info.kinetic_energy, b->info.kinetic_energy,
                   (long long)a->info.active_nodes, (long long)b->info.active_nodes, a->info.external_work,
                   b->info.external_work);
    if (memcmp(a->reaction, b->reaction, sizeof a->reaction) != 0)
      ck_abort_msg("%s, part %d of %d: other reactions", name, r, parts);
    ck_assert_msg(a->stable_dt == b->stable_dt && a->total == b->total, "%s, part %d of %d: %g, %g", name, r,
                  parts, a->stable_dt, b->stable_dt);
  }
}

/* ---- combinations -------------------------------------------------------------------------------------- */
static mpm_status set_up_combination(world *w, const scene *is) {
  mpm_status status = set_walls(w);
  if (!status) status = fill_middle(w, w->set[0], 0.2, 0.7);
  return status ? status : set_velocities(w, w->set[0], is->speed);
}

static combination *list;
static int32_t list_count;

static void set_up_list(void) {
  list = list_combinations(&list_count);
}
static void tear_down_list(void) {
  free(list);
}

/* Blocks are 64, 16 and 6 nodes wide: a body spans several along each axis. */
static const int32_t cells_of[] = {0, 300, 56, 20};

static int32_t describe(scene *is, const combination *c) {
  if (refusal_of(c) || scheme_options[c->choice[CHOOSE_SCHEME]].scheme == MPM_NEWMARK) return 0;
  memset(is, 0, sizeof *is);
  is->desc = describe_combination(c);
  for (int32_t k = 0; k < is->desc.grid.dim; ++k) {
    is->desc.grid.cells[k] = cells_of[is->desc.grid.dim];
    is->desc.grid.spacing[k] = 1.0 / (double)is->desc.grid.cells[k];
  }
  is->set_up = set_up_combination;
  is->speed = 8.0;
  return 1;
}

START_TEST(combinations_in_parts) {
  scene is;
  char name[300];
  const combination *c = &list[(int64_t)_i * list_count / SAMPLE + (_i * 7) % (list_count / SAMPLE)];
  if (!describe(&is, c)) return;
  check_scene(&is, name_of(c, name, sizeof name), 2 + _i % 4);
}
END_TEST

Suite *shared_suite(void) {
  Suite *suite = suite_create("shared");
  TCase *all = tcase_create("combinations");
  tcase_set_timeout(all, 120);
  tcase_add_unchecked_fixture(all, set_up_list, tear_down_list);
  tcase_add_loop_test(all, combinations_in_parts, 0, SAMPLE);
  suite_add_tcase(suite, all);
  return suite;
}
