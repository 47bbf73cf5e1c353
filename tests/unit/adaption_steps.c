/* Adaption in steps: in every combination of options, in parts, from states, without memory, and by the
 * word of the host. */
#include "adaption.h"
#include "combinations.h"
#include "tables.h"

/* ---- steps -------------------------------------------------------------------------------------------- */
static mpm_adaption_desc busy_desc(void) {
  mpm_adaption_desc desc = adaption_desc();
  desc.every = 2;
  desc.split_edge = 0.45;
  desc.min_per_cell = 2;
  desc.max_per_cell = 5;
  desc.merge_distance = 0.6;
  desc.merge_tolerance = 0.5;
  return desc;
}

static void start(world *w, mpm_particles *set) {
  const double low[] = {0.1, 0.4, 0.6}, high[] = {1.3, 1.5, 1.4};
  const int64_t n = world_fill(w, set, low, high, 2);
  double *v = malloc((size_t)(w->dim * n + 1) * sizeof *v);
  for (int64_t i = 0; i < w->dim * n; ++i) v[i] = 0.3 * noise_at((uint64_t)i);
  put(w, set, "velocity", w->dim, v);
  free(v);
  const mpm_adaption_desc desc = busy_desc();
  ck_ok(w, mpm_stepper_set_adaption(w->stepper, set, &desc));
}

static combination *list;
static int32_t listed;

static uint64_t hash_of(const combination *c, int32_t concurrency, int64_t *done) {
  world w;
  world_desc desc = describe_combination(c);
  desc.context.concurrency = concurrency;
  desc.law =
      (world_law){.model = "j2", .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e3, .hardening = 1e4};
  mpm_particles *set = world_open(&w, &desc);
  start(&w, set);
  const double dt = fmin(0.2 * world_stable_dt(&w), 1e-2);
  for (int32_t step = 0; step < 5; ++step) w.info = world_step(&w, dt);
  const mpm_adaption_info info = told(&w, set);
  *done += info.splits + info.merges;
  const uint64_t hash = world_step_again(&w, dt);
  world_close(&w);
  return hash;
}

/* In every combination of options sets adapt at the end of a step, with the same bits on any number of
 * threads and after a state was loaded. */
START_TEST(combination_works) {
  char name[256];
  int64_t done = 0;
  if (hash_of(&list[_i], 1, &done) != hash_of(&list[_i], 3, &done))
    ck_abort_msg("%s: the threads matter", name_of(&list[_i], name, sizeof name));
  ck_assert_msg(done > 0, "%s: nothing adapts", name_of(&list[_i], name, sizeof name));
}
END_TEST

static mpm_particles *open_busy(world *w, int32_t dim, const method *how, const equip_fn *with) {
  world_desc desc = described(how, dim);
  desc.equip = with;
  mpm_particles *set = world_open(w, &desc);
  start(w, set);
  return set;
}

/* A step in parts ends as a whole one, and a state has what was done. */
START_TEST(parts_and_states) {
  world a, b, c;
  mpm_particles *set = open_busy(&a, 2, &methods[_i], NULL);
  mpm_particles *in_parts = open_busy(&b, 2, &methods[_i], NULL),
                *loaded = open_busy(&c, 2, &methods[_i], NULL);
  for (int32_t step = 0; step < 4; ++step) {
    world_step(&a, 1e-3);
    world_staged_step(&b, 1e-3);
  }
  world_bits bits = world_take(&a);
  if (methods[_i].transfer != MPM_APIC_MLS)
    world_same(&b, &bits, "in parts"); /* whose force is fused in whole steps */
  const mpm_adaption_info info = told(&a, set), other = told(&b, in_parts);
  ck_holds(info.splits > 0 && info.merges > 0);
  if (methods[_i].transfer != MPM_APIC_MLS) ck_holds(!memcmp(&info, &other, sizeof info));
  world_copy(&a, &c);
  world_same(&c, &bits, "loaded");
  const mpm_adaption_info from_state = told(&c, loaded);
  ck_holds(!memcmp(&info, &from_state, sizeof info));
  ck_ok(&a, mpm_stepper_set_time(a.stepper, 0.0, 0));
  ck_assert_int_eq(told(&a, set).splits, 0);
  bits_drop(&bits);
  world_close(&a);
  world_close(&b);
  world_close(&c);
}
END_TEST

/* Particles are added in another order, with the same ids. */
START_TEST(order_of_adding) {
  enum { N = 200 };
  world w[2];
  uint64_t hash[2];
  for (int32_t turned = 0; turned < 2; ++turned) {
    const world_desc desc = described(&methods[2], 2);
    mpm_particles *set = world_open(&w[turned], &desc);
    double x[2 * N], v[2 * N], volume[N];
    int64_t id[N];
    for (int32_t i = 0; i < N; ++i) {
      const int32_t at = turned ? (i * 77) % N : i;
      id[i] = at;
      for (int32_t k = 0; k < 2; ++k) {
        x[k * N + i] = 1.0 + 0.3 * noise_at((uint64_t)(2 * at + k));
        v[k * N + i] = 0.2 * noise_at((uint64_t)(2 * at + k + 999));
      }
      volume[i] = 1e-3 * (1.0 + 0.1 * noise_at((uint64_t)at + 55));
    }
    ck_ok(&w[turned], mpm_particles_add(set, N, x, v, volume, NULL, id, NULL));
    mpm_adaption_desc adapt = busy_desc();
    adapt.split_edge = 0.12;
    adapt.least_edge = 0.06;
    ck_ok(&w[turned], mpm_stepper_set_adaption(w[turned].stepper, set, &adapt));
    for (int32_t step = 0; step < 5; ++step) world_step(&w[turned], 1e-4);
    ck_holds(told(&w[turned], set).splits > 0 && told(&w[turned], set).merges > 0);
    hash[turned] = world_hash(&w[turned]);
  }
  ck_assert_uint_eq(hash[0], hash[1]);
  world_close(&w[0]);
  world_close(&w[1]);
}
END_TEST

/* Memory runs out anywhere: the step has not been made, and its repetition has the bits of one without. */
START_TEST(memory_runs_out) {
  world w, same;
  open_busy(&same, 2, &methods[_i], NULL);
  mpm_particles *set = open_busy(&w, 2, &methods[_i], NULL);
  int64_t failures = 0;
  for (int32_t step = 0; step < 4; ++step) {
    world_step(&same, 1e-3);
    for (int64_t at = 1;; ++at) {
      const uint64_t was = world_hash(&w);
      w.memory.fail_at = w.memory.calls + at;
      const mpm_status status = mpm_step(w.stepper, 1e-3, &w.info);
      w.memory.fail_at = 0;
      if (!status) break;
      ck_assert_int_eq(status, MPM_E_NOMEM);
      ck_assert_uint_eq(world_hash(&w), was);
      ++failures;
    }
    ck_assert_uint_eq(world_hash(&w), world_hash(&same));
  }
  ck_holds(told(&w, set).splits > 0 && failures > 5);
  world_close(&w);
  world_close(&same);
}
END_TEST

/* ---- the host's word ---------------------------------------------------------------------------------- */
typedef struct voice {
  int64_t asked[2], refused;
  mpm_status answer;
  int32_t dim;
} voice;

static mpm_status say(void *user, const mpm_adaption_batch *batch, uint8_t *accept) {
  voice *of = user;
  for (int64_t i = 0; i < batch->n; ++i) {
    const int64_t id = batch->id[i];
    if (!accept[i] || (i && batch->id[i - 1] >= id) ||
        (batch->other != NULL) != (batch->what == MPM_ADAPT_MERGE))
      return -1;
    for (int32_t k = 0; k < of->dim; ++k)
      if (!(batch->position[k * batch->ld + i] > 0.0)) return -1;
    accept[i] = id % 2 == 0;
    of->refused += id % 2;
  }
  of->asked[batch->what] += batch->n;
  return of->answer;
}

START_TEST(host_is_asked) {
  world w;
  voice host = {.dim = 2};
  mpm_particles *set = open_busy(&w, 2, &methods[0], NULL);
  mpm_adaption_desc desc = busy_desc();
  desc.every = 1;
  desc.accept = say;
  desc.user = &host;
  desc.min_per_cell = 0;
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &desc));
  const int64_t n = mpm_particles_count(set);
  world_step(&w, 1e-3);
  const mpm_adaption_info info = told(&w, set);
  ck_assert_int_eq(host.asked[MPM_ADAPT_SPLIT], n);
  ck_assert_int_eq(info.splits, (n + 1) / 2);
  for (int32_t step = 0; step < 3; ++step) world_step(&w, 1e-3);
  ck_holds(host.asked[MPM_ADAPT_MERGE] > 0 && told(&w, set).merges > 0);
  ck_holds(told(&w, set).merges < host.asked[MPM_ADAPT_MERGE]);
  const uint64_t was = world_hash(&w);
  host.answer = -7;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, NULL), MPM_E_CALLBACK, "the adaption callback returned -7");
  ck_refused(&w, mpm_stepper_adapt(w.stepper), MPM_E_CALLBACK, "the adaption callback returned -7");
  host.answer = 3;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, NULL), MPM_CUT_DT, "the adaption callback returned 3");
  ck_assert_uint_eq(world_hash(&w), was);
  host.answer = MPM_OK;
  world_step(&w, 1e-3);
  world_close(&w);
}
END_TEST

/* A state from before sets adapted has no sizes; they are found. */
START_TEST(state_without_sizes) {
  world a, b;
  const world_desc desc = described(&methods[0], 2);
  mpm_particles *set = world_open(&a, &desc), *other = world_open(&b, &desc);
  world_fill_cube(&a, set, 0.5, 1.0);
  world_fill_cube(&b, other, 0.5, 1.0);
  const mpm_adaption_desc all = split_all();
  ck_ok(&b, mpm_stepper_set_adaption(b.stepper, other, &all));
  world_copy(&a, &b);
  ck_ok(&b, mpm_stepper_adapt(b.stepper));
  ck_assert_int_eq(mpm_particles_count(other), 4 * mpm_particles_count(set));
  world_close(&a);
  world_close(&b);
}
END_TEST

/* Nodal fields are those of the step, also when sums of the state were asked for. */
START_TEST(nodal_fields_stay) {
  world w;
  mpm_particles *set = open_busy(&w, 2, &methods[0], NULL);
  mpm_adaption_desc desc = split_all();
  desc.every = 1;
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &desc));
  world_step(&w, 1e-3);
  ck_holds(told(&w, set).splits > 0);
  world_stable_dt(&w);
  world_info(&w);
  int64_t n;
  double *mass = fetch_nodes(&w, "mass", &n);
  ck_within("mass", sum_of(n, mass), mass_of(&w, set), 1e-9);
  free(mass);
  world_close(&w);
}
END_TEST

/* Particles that leave through an open wall in the step are not split, nor are they merged, with what stays
 * behind or with each other. */
START_TEST(open_wall) {
  world w;
  const world_desc desc = described(&methods[0], 2);
  mpm_particles *set = world_open(&w, &desc);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_OPEN, 0.0));
  const double low[] = {1.5, 0.5}, high[] = {2.0, 1.0}, v[] = {4.0, 0.0};
  const int64_t left = world_fill(&w, set, low, high, 2) - 4;
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_adaption_desc adapt = _i ? merge_all() : split_all();
  adapt.every = 1;
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  w.info = world_step(&w, 0.02);
  const mpm_adaption_info info = told(&w, set);
  ck_assert_int_eq(w.info.removed, 4);
  ck_assert_int_eq(info.splits, _i ? 0 : left);
  ck_assert_int_eq(info.merges, _i ? 6 : 0); /* of two one, of four two, in two rows of cells */
  ck_assert_int_eq(mpm_particles_count(set), left + info.added - info.merges);
  world_close(&w);
}
END_TEST

void add_adaption_steps(Suite *suite) {
  TCase *steps = tcase_create("steps");
  if (!list) list = list_combinations(&listed);
  tcase_add_loop_test(steps, parts_and_states, 0, METHODS);
  tcase_add_test(steps, order_of_adding);
  tcase_add_loop_test(steps, memory_runs_out, 0, 3);
  tcase_add_test(steps, host_is_asked);
  tcase_add_test(steps, state_without_sizes);
  tcase_add_test(steps, nodal_fields_stay);
  tcase_add_loop_test(steps, open_wall, 0, 2);
  suite_add_tcase(suite, steps);
  TCase *all = tcase_create("combinations");
  add_table(all, wide_case(suite, "more combinations"), combination_works, listed);
  tcase_set_timeout(all, 60);
  suite_add_tcase(suite, all);
}
