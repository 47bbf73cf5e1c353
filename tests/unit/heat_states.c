/* Heat beside the numbers that it gives: threads, states, failures, refusals, and where there is nothing. */
#include "heat.h"
#include "tables.h"

static world_desc warm_world(const method *how, int32_t dim, int32_t concurrency) {
  world_desc desc = world_with(how, dim, 8, 0.25);
  desc.law.E = 1e3;
  desc.context.concurrency = concurrency;
  return desc;
}

static void describe_again(const world *w, mpm_particles *set, int32_t implicit) {
  mpm_heat_desc heat = heat_desc(2.0, 300.0);
  heat.source = warm_middle;
  heat.expansion = 1e-4;
  heat.reference_temperature = 300.0;
  heat.dissipated_share = 0.9;
  ck_ok(w, mpm_stepper_set_heat(w->stepper, set, &heat));
  if (implicit) ck_ok(w, mpm_stepper_set_conduction(w->stepper, MPM_CONDUCTION_IMPLICIT, 1e-10));
  equip_faces(w);
}

/* Threads, and a state that is saved in the middle, make no difference to a bit. */
START_TEST(threads_and_states) {
  const method *how = broad_methods[_i % BROAD];
  const int32_t dim = 1 + _i / BROAD % 3, implicit = _i / BROAD / 3;
  if (dim == 1 && how->remedy) return;
  world one, many;
  const world_desc desc = warm_world(how, dim, 1), other = warm_world(how, dim, 3);
  mpm_particles *a = open_cloud(&one, &desc, 3), *b = open_cloud(&many, &other, 3);
  describe_again(&one, a, implicit);
  describe_again(&many, b, implicit);
  const double dt = fmin(0.1 * world_stable_dt(&one), 1e-3);
  for (int32_t i = 0; i < 3; ++i) world_step(&one, dt), world_step(&many, dt);
  ck_assert_uint_eq(world_hash(&one), world_hash(&many));
  ck_assert_uint_eq(world_step_again(&one, dt), (world_step(&many, dt), world_hash(&many)));
  const saved_state state = world_save(&one);
  world_load(&many, &state);
  world_step(&one, dt), world_step(&many, dt);
  ck_assert_uint_eq(world_hash(&one), world_hash(&many));
  const mpm_heat_info x = heat_told(&one), y = heat_told(&many);
  ck_assert_mem_eq(&x, &y, sizeof x);
  free(state.data);
  world_close(&one);
  world_close(&many);
}
END_TEST

static mpm_status refuse(void *user, const mpm_step_info *info) {
  (void)info;
  return *(int32_t *)user;
}

static mpm_status bad_source(void *user, const mpm_particle_batch *b, double *power) {
  const int32_t kind = *(int32_t *)user;
  for (int64_t i = 0; i < b->n; ++i) power[i] = kind == 1 && b->id[i] == 7 ? NOT_A_NUMBER : 0.0;
  return kind == 2 ? 5 : kind == 3 ? -5 : 0;
}

/* A step that fails changes nothing. */
START_TEST(roll_back) {
  const int32_t implicit = _i;
  int32_t kind = 0, answer = -1;
  world w;
  const world_desc desc = warm_world(broad_methods[0], 2, 2);
  mpm_particles *set = open_cloud(&w, &desc, 8);
  describe_again(&w, set, implicit);
  const double dt = fmin(0.1 * world_stable_dt(&w), 1e-3);
  world_step(&w, dt);
  world_bits was = world_take(&w);
  const mpm_heat_info before = heat_told(&w);
  ck_ok(&w, mpm_stepper_set_progress(w.stepper, refuse, &answer));
  ck_refused(&w, mpm_step(w.stepper, dt, NULL), MPM_E_CALLBACK, "progress");
  ck_ok(&w, mpm_stepper_set_progress(w.stepper, NULL, NULL));
  world_same(&w, &was, "refused by the host");
  mpm_heat_desc heat = heat_desc(2.0, 300.0);
  heat.expansion = 1e-4, heat.reference_temperature = 300.0;
  heat.source = bad_source, heat.user = &kind;
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  kind = 1;
  ck_refused(&w, mpm_step(w.stepper, dt, NULL), MPM_NONFINITE, "power of the heat source not finite");
  kind = 2;
  ck_refused(&w, mpm_step(w.stepper, dt, NULL), MPM_CUT_DT, "the heat source");
  kind = 3;
  ck_refused(&w, mpm_step(w.stepper, dt, NULL), MPM_E_CALLBACK, "the heat source");
  world_same(&w, &was, "refused by the source");
  const double huge = 1e308;
  kind = 0;
  ck_ok(&w, mpm_step_begin(w.stepper, dt));
  ck_ok(&w, mpm_step_abort(w.stepper));
  world_same(&w, &was, "aborted");
  const mpm_heat_info after = heat_told(&w);
  ck_assert_mem_eq(&before, &after, sizeof before);
  if (!implicit)
    ck_refused(&w, mpm_step(w.stepper, 10.0, NULL), MPM_CUT_DT, "explicit conduction is stable up to");
  world_same(&w, &was, "too long");
  ck_ok(&w, mpm_particles_set_all(set, "temperature", MPM_F64, 1, &huge));
  bits_drop(&was);
  was = world_take(&w);
  ck_assert_int_ne(mpm_step(w.stepper, dt, NULL), MPM_OK);
  world_same(&w, &was, "temperatures that overflow");
  bits_drop(&was);
  world_close(&w);
}
END_TEST

/* Products that overflow while the temperatures do not are no solution. */
START_TEST(overflow_is_no_solution) {
  world w;
  const world_desc desc = world_default(2, 8, 0.25);
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 0.5, 1.0);
  const mpm_heat_desc heat = _i ? heat_desc(1.0, 1e10) : heat_desc(1e10, 1.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
  if (_i) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-9));
  double *T = malloc((size_t)n * sizeof *T);
  for (int64_t p = 0; p < n; ++p) T[p] = p == 3 ? 1e305 : 0.0;
  put(&w, set, "temperature", 1, T);
  world_bits was = world_take(&w);
  ck_refused(&w, mpm_step(w.stepper, 1e-4, NULL), MPM_NONFINITE,
             _i ? "what flows between nodes is not finite"
                : "stands for is not finite at particle 3 of set 0");
  world_same(&w, &was, "overflow");
  bits_drop(&was);
  free(T);
  world_close(&w);
}
END_TEST

/* Each allocation fails once; the call says so, changes nothing, and succeeds after that. */
START_TEST(memory_runs_out) {
  const int32_t implicit = _i;
  for (int64_t at = 1; at < 400; ++at) {
    world w;
    const world_desc desc = warm_world(broad_methods[0], 2, 1);
    mpm_particles *set = world_open(&w, &desc);
    world_fill_cube(&w, set, 0.0, 1.4);
    mpm_heat_desc heat = heat_desc(2.0, 300.0);
    heat.expansion = 1e-4;
    if (implicit) ck_ok(&w, mpm_stepper_set_conduction(w.stepper, MPM_CONDUCTION_IMPLICIT, 1e-10));
    equip_faces(&w);
    world_bits was = world_take(&w);
    int32_t failed = 0;
    w.memory.fail_at = w.memory.calls + at;
    mpm_status status = mpm_stepper_set_heat(w.stepper, set, &heat);
    if (status) w.memory.fail_at = 0;
    if (status) {
      ck_assert_int_eq(status, MPM_E_NOMEM);
      world_same(&w, &was, "described without memory");
      ++failed;
      ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &heat));
    }
    bits_drop(&was);
    const int64_t left = w.memory.fail_at ? w.memory.fail_at - w.memory.calls : 0;
    w.memory.fail_at = 0;
    was = world_take(&w);
    w.memory.fail_at = left > 0 ? w.memory.calls + left : 0;
    status = failed ? MPM_OK : mpm_step(w.stepper, 1e-4, NULL);
    w.memory.fail_at = 0;
    if (status) {
      ck_assert_int_eq(status, MPM_E_NOMEM);
      world_same(&w, &was, "stepped without memory");
      ++failed;
    }
    bits_drop(&was);
    world_step(&w, 1e-4);
    world_close(&w);
    if (!failed) return;
  }
  ck_abort_msg("allocations never end");
}
END_TEST

/* ---- arguments ----------------------------------------------------------------------------------------- */
START_TEST(refusals) {
  world w;
  world_desc desc = world_default(2, 8, 0.25);
  desc.grid.periodic[1] = 1;
  mpm_particles *set = world_open(&w, &desc);
  world_fill_cube(&w, set, 0.5, 1.0);
  mpm_stepper *s = w.stepper;
  mpm_heat_info info = {.struct_size = sizeof info};
  ck_refused(&w, mpm_stepper_heat_info(s, &info), MPM_E_STATE, "mpm_stepper_set_heat");
  mpm_heat_desc d = heat_desc(0.0, 1.0);
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_ARG, "specific_heat is 0");
  d = heat_desc(INFINITE, 1.0);
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_ARG, "specific_heat is inf");
  d = heat_desc(1.0, -1.0);
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_ARG, "conductivity is -1");
  d = heat_desc(1.0, NOT_A_NUMBER);
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_ARG, "conductivity is");
  d = heat_desc(1.0, 1.0);
  d.expansion = INFINITE;
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_ARG, "expansion is inf");
  d = heat_desc(1.0, 1.0);
  d.reference_temperature = NOT_A_NUMBER;
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_ARG, "reference_temperature");
  d = heat_desc(1.0, 1.0);
  d.dissipated_share = 1.5;
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_ARG, "dissipated_share is 1.5");
  d = heat_desc(1.0, 1.0);
  d.struct_size = 8;
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_ARG, "struct_size");
  d = heat_desc(1.0, 1.0);
  ck_refused(&w, mpm_stepper_set_heat(s, NULL, &d), MPM_E_ARG, "particles is NULL");
  ck_ok(&w, mpm_particles_add_field(set, "temperature", MPM_I64, 1));
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_ARG, "a field \"temperature\"");
  ck_refused(&w, mpm_stepper_set_conduction(s, 2, 1e-9), MPM_E_ARG, "conduction is 2");
  ck_refused(&w, mpm_stepper_set_conduction(s, MPM_CONDUCTION_IMPLICIT, 0.0), MPM_E_ARG, "tolerance is 0");
  ck_refused(&w, mpm_stepper_set_conduction(s, MPM_CONDUCTION_IMPLICIT, 1.0), MPM_E_ARG, "tolerance is 1");
  ck_refused(&w, mpm_stepper_set_heat_wall(s, 4, 0, 0.0), MPM_E_ARG, "face is 4");
  ck_refused(&w, mpm_stepper_set_heat_wall(s, -1, 0, 0.0), MPM_E_ARG, "face is -1");
  ck_refused(&w, mpm_stepper_set_heat_wall(s, 0, 2, 0.0), MPM_E_ARG, "kind is 2");
  ck_refused(&w, mpm_stepper_set_heat_wall(s, 0, 1, INFINITE), MPM_E_ARG, "temperature is inf");
  ck_refused(&w, mpm_stepper_set_heat_wall(s, 2, 1, 1.0), MPM_E_ARG, "periodic");
  mpm_surface_desc of = load_desc();
  mpm_surface *surface = put_surface(&w, &of);
  ck_refused(&w, mpm_surface_set_heat(surface, NOT_A_NUMBER, 0.0, 0.0), MPM_E_ARG, "flux is");
  ck_refused(&w, mpm_surface_set_heat(surface, 0.0, -1.0, 0.0), MPM_E_ARG, "film is -1");
  ck_refused(&w, mpm_surface_set_heat(surface, 0.0, 0.0, INFINITE), MPM_E_ARG, "ambient");
  drop_surface(&w, surface);
  ck_ok(&w, mpm_step_begin(s, 1e-5));
  ck_refused(&w, mpm_stepper_set_heat(s, set, &d), MPM_E_STATE, "a step is under way");
  ck_refused(&w, mpm_stepper_set_conduction(s, 0, 0.0), MPM_E_STATE, "a step is under way");
  ck_refused(&w, mpm_stepper_set_heat_wall(s, 0, 0, 0.0), MPM_E_STATE, "a step is under way");
  ck_ok(&w, mpm_step_abort(s));
  world_close(&w);
  desc.grid.geometry = MPM_AXISYMMETRIC;
  desc.grid.periodic[1] = 0;
  world_open(&w, &desc);
  ck_refused(&w, mpm_stepper_set_heat_wall(w.stepper, MPM_X_MIN, 1, 1.0), MPM_E_UNSUPPORTED, "is the axis");
  world_close(&w);
  desc.grid.geometry = MPM_PLANE_STRESS;
  set = world_open(&w, &desc);
  d = heat_desc(1.0, 1.0);
  d.expansion = 1e-5;
  ck_refused(&w, mpm_stepper_set_heat(w.stepper, set, &d), MPM_E_UNSUPPORTED, "do not expand");
  world_close(&w);
  desc.grid.geometry = MPM_PLANE_STRAIN;
  desc.law = (world_law){.model = "rigid", .density = 1e3};
  set = world_open(&w, &desc);
  ck_refused(&w, mpm_stepper_set_heat(w.stepper, set, &d), MPM_E_UNSUPPORTED, "does not expand");
  d = heat_desc(1.0, 1.0);
  d.dissipated_share = 1.0;
  ck_refused(&w, mpm_stepper_set_heat(w.stepper, set, &d), MPM_E_UNSUPPORTED, "dissipates nothing");
  world_close(&w);
}
END_TEST

/* Nothing is left to conduct, or nothing is free: there are no particles, or faces hold all nodes. */
START_TEST(nothing_is_free) {
  world w;
  world_desc desc = world_default(1, 1, 1.0);
  desc.grid.basis = MPM_LINEAR;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.0}, high[] = {1.0};
  world_fill(&w, set, low, high, 4);
  const mpm_heat_desc d = heat_desc(2.0, 1.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &d));
  ck_ok(&w,
        mpm_stepper_set_conduction(w.stepper, _i ? MPM_CONDUCTION_IMPLICIT : MPM_CONDUCTION_EXPLICIT, 1e-12));
  hold_ends(&w, 3.0);
  for (int32_t i = 0; i < 2; ++i) world_step(&w, 1e-3);
  double *T = fetch(&w, set, "temperature", 1);
  for (int64_t p = 0; p < 4; ++p) ck_within("held", T[p], 3.0, 1e-12);
  free(T);
  const int64_t all[] = {0, 1, 2, 3};
  ck_ok(&w, mpm_particles_remove(set, 4, all));
  for (int32_t i = 0; i < 2; ++i) world_step(&w, 1e-3);
  mpm_heat_info info = {.struct_size = sizeof info};
  ck_ok(&w, mpm_stepper_heat_info(w.stepper, &info));
  ck_assert(info.gained == 0.0 && info.heat == 0.0);
  world_close(&w);
}
END_TEST

static mpm_particles *open_cube(world *w) {
  const world_desc desc = world_default(2, 8, 0.25);
  mpm_particles *set = world_open(w, &desc);
  world_fill_cube(w, set, 0.5, 1.0);
  return set;
}

/* Without a description nothing is there; with one that is taken back fields stay. */
START_TEST(comes_and_goes) {
  world w;
  mpm_particles *set = open_cube(&w);
  mpm_heat_desc d = heat_desc(2.0, 1.0);
  d.reference_temperature = 12.0;
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &d));
  ck_assert(fetch1(&w, set, "temperature", 1, 0, 0) == 12.0);
  ck_refused(&w, mpm_particles_set_extensive(set, "temperature", 1), MPM_E_ARG, "is the temperature");
  const int64_t more = world_fill_cube(&w, set, 1.0, 1.25);
  ck_assert(fetch1(&w, set, "temperature", 1, 0, more - 1) == 12.0);
  world_step(&w, 1e-5);
  int64_t n;
  double *T = fetch_nodes(&w, "temperature", &n);
  for (int64_t i = 0; i < n; ++i) ck_within("node", T[i], 12.0, 1e-13);
  free(T);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, NULL));
  mpm_view view = {.struct_size = sizeof view};
  ck_refused(&w, mpm_grid_map(w.stepper, 0, "temperature", MPM_READ, &view), MPM_E_UNSUPPORTED,
             "no set had heat");
  world_step(&w, 1e-5);
  ck_assert(fetch1(&w, set, "temperature", 1, 0, 0) == 12.0);
  world_close(&w);
}
END_TEST

/* What the last step gave is nothing once no set has heat; totals stay. */
START_TEST(last_step_without_heat) {
  world w;
  mpm_particles *set = open_cube(&w);
  mpm_heat_desc d = heat_desc(2.0, 1.0);
  d.source = warm_middle;
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, &d));
  world_step(&w, 1e-5);
  const mpm_heat_info first = heat_told(&w);
  ck_assert(first.gained != 0.0 && first.sources != 0.0);
  ck_ok(&w, mpm_stepper_set_heat(w.stepper, set, NULL));
  world_step(&w, 1e-5);
  const mpm_heat_info last = heat_told(&w);
  ck_assert(last.gained == 0.0 && last.sources == 0.0);
  ck_assert(last.gained_total == first.gained_total && last.sources_total == first.sources_total);
  world_close(&w);
}
END_TEST

void add_heat_states(Suite *suite) {
  TCase *states = tcase_create("states");
  add_table(states, wide_case(suite, "more states"), threads_and_states, 6 * BROAD);
  tcase_add_loop_test(states, roll_back, 0, 2);
  tcase_add_loop_test(states, overflow_is_no_solution, 0, 2);
  tcase_add_loop_test(states, memory_runs_out, 0, 2);
  tcase_add_test(states, refusals);
  tcase_add_loop_test(states, nothing_is_free, 0, 2);
  tcase_add_test(states, comes_and_goes);
  tcase_add_test(states, last_step_without_heat);
  tcase_set_timeout(states, 120);
  suite_add_tcase(suite, states);
}
