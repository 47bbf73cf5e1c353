/* Total Lagrangian grids in several parts, and how combinations become scenes with an option more. */
#include "shared.h"

static combination *list;
static int32_t list_count;

static void set_up_list(void) {
  list = list_combinations(&list_count);
}
static void tear_down_list(void) {
  free(list);
}

void add_option_list(TCase *to) {
  tcase_add_unchecked_fixture(to, set_up_list, tear_down_list);
}

int32_t describe_option(scene *is, int32_t at, int32_t total, char *name, size_t size) {
  const combination *c = &list[(int64_t)at * list_count / OPTIONS_SAMPLE];
  memset(is, 0, sizeof *is);
  if (refusal_of(c) || scheme_options[c->choice[CHOOSE_SCHEME]].scheme == MPM_NEWMARK) return 0;
  is->desc = describe_combination(c);
  if (total && keeps_volume_alone(is->desc.law.model)) return 0;
  is->desc.grid.total_lagrangian = total;
  refine(&is->desc);
  name_of(c, name, size);
  return 1;
}

void check_made(const scene *is, const char *name, int32_t parts) {
  const mpm_status status = check_scene(is, name, parts);
  ck_assert_msg(status == MPM_OK, "%s: %s", name, mpm_status_name(status));
}

/* ---- total Lagrangian grids ---------------------------------------------------------------------------- */
START_TEST(total_combinations) {
  scene is;
  char name[300];
  if (!describe_option(&is, _i, 1, name, sizeof name)) return;
  is.set_up = set_up_body;
  is.speed = 8.0;
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* Displacements begin anew where the body is, and particles come where it has been; only then are they sorted
 * again. */
static mpm_status begin_anew(world *w, const scene *is, outcome *found) {
  double dt;
  int32_t part = 0, parts = 1;
  (void)is, (void)found;
  mpm_context_part(w->context, &part, &parts);
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  for (int32_t i = 0; i < 60 && !status; ++i) {
    if (i == 40) status = mpm_particles_reset_reference(w->set[0]);
    const double x[] = {0.51, 0.73}, v[] = {1.0, 0.0}, volume[] = {1e-4};
    const int64_t id[] = {100000};
    if (i == 50) status = mpm_particles_add(w->set[0], part == parts / 2, x, v, volume, NULL, id, NULL);
    if (!status) status = mpm_step(w->stepper, 0.3 * dt, &w->info);
    if (!status && i == 39 && w->info.resorts != 1) return MPM_E_INTERNAL;
  }
  return status;
}

START_TEST(total_begun_anew) {
  static const int32_t transfers[] = {MPM_FLIP, MPM_APIC, MPM_XPIC};
  scene is = scene_of(2, 96, set_up_body);
  is.desc.grid.total_lagrangian = 1;
  is.desc.law.model = "linear_elastic";
  is.desc.stepper.transfer = transfers[_i % 3];
  is.desc.stepper.xpic_order = 2;
  is.desc.stepper.scheme = _i % 2 ? MPM_MUSL : MPM_USL;
  is.run = begin_anew;
  check_made(&is, "begun anew", 2 + _i);
}
END_TEST

void add_shared_options(Suite *suite) {
  TCase *total = tcase_create("lagrangian");
  tcase_set_timeout(total, 120);
  add_option_list(total);
  TCase *wide = wide_case(suite, "more lagrangian");
  add_option_list(wide);
  add_table(total, wide, total_combinations, OPTIONS_SAMPLE);
  tcase_add_loop_test(total, total_begun_anew, 0, 4);
  suite_add_tcase(suite, total);
}
