/* Splitting and merging of particles: what is kept, what is reported, and that nothing else matters. */
#include "combinations.h"
#include "reference.h"

static mpm_adaption_desc adaption_desc(void) {
  mpm_adaption_desc desc;
  ck_assert(mpm_adaption_desc_init(&desc, sizeof desc) == MPM_OK);
  return desc;
}

static mpm_adaption_info told(const world *w, const mpm_particles *set) {
  mpm_adaption_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_stepper_adaption_info(w->stepper, set, &info));
  return info;
}

/* Every edge is halved, however short. */
static mpm_adaption_desc split_all(void) {
  mpm_adaption_desc desc = adaption_desc();
  desc.least_edge = 1e-6;
  desc.split_edge = 2e-6;
  return desc;
}

/* Pairs are alike whatever they are. */
static mpm_adaption_desc merge_all(void) {
  mpm_adaption_desc desc = adaption_desc();
  desc.max_per_cell = 1;
  desc.merge_distance = 2.0;
  desc.merge_tolerance = 1e6;
  return desc;
}

static world_desc described(const method *how, int32_t dim) {
  world_desc desc = world_with(how, dim, 8, 0.25);
  desc.stepper.reference_positions = 1;
  return desc;
}

static mpm_particles *open_cloud(world *w, const method *how, int32_t dim, uint64_t seed, int64_t n) {
  const world_desc desc = described(how, dim);
  dice d = {seed};
  mpm_particles *set = world_open(w, &desc);
  add_cloud(w, set, &d, n, 0.25, 0.6, 1.4, 0.5);
  if (carries_matrix(how->transfer)) add_affine(w, set, &d, 3.0);
  return set;
}

/* ---- what is kept ------------------------------------------------------------------------------------- */
/* Sums over a set that splitting and merging may not change, or only by as much as is reported. */
typedef struct sums {
  double mass, initial_volume, volume, centre[3], force[3], amount;
  mpm_step_info info;
} sums;

static void equip(const world *w, mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  double *amount = malloc((size_t)n * sizeof *amount), *force = malloc((size_t)(3 * n) * sizeof *force);
  for (int64_t p = 0; p < n; ++p) amount[p] = 1.0 + noise_at((uint64_t)p);
  for (int64_t i = 0; i < 3 * n; ++i) force[i] = noise_at((uint64_t)i + 5);
  ck_ok(w, mpm_particles_add_field(set, "amount", MPM_F64, 1));
  ck_ok(w, mpm_particles_add_field(set, "density", MPM_F64, 1));
  ck_ok(w, mpm_particles_add_field(set, "kind", MPM_I64, 1));
  ck_ok(w, mpm_particles_set_extensive(set, "amount", 1));
  put(w, set, "amount", 1, amount);
  put(w, set, "density", 1, amount);
  put(w, set, "applied_force", w->dim, force);
  int64_t *kind = fetch_ids(w, set);
  ck_ok(w, mpm_particles_set(set, "kind", MPM_I64, 1, n, NULL, kind));
  free(kind);
  free(amount);
  free(force);
}

static sums sum_up(world *w, mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  double *m = fetch(w, set, "mass", 1), *V0 = fetch(w, set, "initial_volume", 1),
         *V = fetch(w, set, "volume", 1), *x = fetch(w, set, "position", w->dim),
         *f = fetch(w, set, "applied_force", w->dim), *amount = fetch(w, set, "amount", 1);
  sums s = {.mass = sum_of(n, m),
            .initial_volume = sum_of(n, V0),
            .volume = sum_of(n, V),
            .amount = sum_of(n, amount)};
  for (int32_t k = 0; k < w->dim; ++k) {
    s.centre[k] = weighted_sum(n, m, x + k * n) / s.mass;
    s.force[k] = sum_of(n, f + k * n);
  }
  s.info = world_info(w);
  free(m), free(V0), free(V), free(x), free(f), free(amount);
  return s;
}

/* has_matrix: angular momentum is kept, too. */
static void check_sums(const char *name, const sums *a, const sums *b, const mpm_adaption_info *told_of,
                       int32_t has_matrix) {
  const double scale = fabs(a->info.kinetic_energy) + fabs(a->info.affine_kinetic_energy), momentum = a->mass;
  ck_within(name, b->mass, a->mass, 1e-13 * a->mass);
  ck_within(name, b->initial_volume, a->initial_volume, 1e-13 * a->initial_volume);
  ck_within(name, b->volume, a->volume, 1e-13 * a->volume);
  ck_within(name, b->amount, a->amount, 1e-13 * a->amount);
  for (int32_t k = 0; k < 3; ++k) {
    ck_within(name, b->centre[k], a->centre[k], 1e-13);
    ck_within(name, b->force[k], a->force[k], 1e-11);
    ck_within(name, b->info.momentum[k], a->info.momentum[k], 1e-12 * momentum);
    ck_within(name, a->info.angular_momentum[k] - b->info.angular_momentum[k],
              told_of->angular_momentum_loss[k], 1e-12 * momentum);
    if (has_matrix) ck_within(name, told_of->angular_momentum_loss[k], 0.0, 1e-13 * momentum);
  }
  ck_within(name, a->info.kinetic_energy - b->info.kinetic_energy, told_of->kinetic_loss, 1e-12 * scale);
  ck_within(name, a->info.affine_kinetic_energy - b->info.affine_kinetic_energy, told_of->affine_loss,
            1e-12 * scale);
  ck_within(name, a->info.strain_energy - b->info.strain_energy, told_of->strain_loss,
            1e-12 * (fabs(a->info.strain_energy) + 1.0));
}

START_TEST(splits_keep_sums) {
  const method *how = &methods[_i % ALL_METHODS];
  const int32_t dim = 1 + _i / ALL_METHODS, parts = 1 << dim;
  if (how->remedy && dim == 1) return;
  world w;
  mpm_particles *set = open_cloud(&w, how, dim, (uint64_t)_i + 1, 40);
  equip(&w, set);
  const mpm_adaption_desc desc = split_all();
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &desc));
  const sums before = sum_up(&w, set);
  double *F = fetch(&w, set, "deformation_gradient", 9), *size = fetch(&w, set, "size", dim),
         *stress = fetch(&w, set, "stress", 6), *density = fetch(&w, set, "density", 1);
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  const sums after = sum_up(&w, set);
  const mpm_adaption_info info = told(&w, set);
  ck_assert_int_eq(info.splits, 40);
  ck_assert_int_eq(info.added, 40 * (parts - 1));
  ck_assert_int_eq(mpm_particles_count(set), 40 * parts);
  check_sums(how->name, &before, &after, &info, carries_matrix(how->transfer));
  if (!carries_matrix(how->transfer))
    ck_within(how->name, info.kinetic_loss, 0.0, 1e-12 * before.info.kinetic_energy);
  const int64_t n = mpm_particles_count(set);
  double *F2 = fetch(&w, set, "deformation_gradient", 9), *size2 = fetch(&w, set, "size", dim),
         *stress2 = fetch(&w, set, "stress", 6), *density2 = fetch(&w, set, "density", 1),
         *x = fetch(&w, set, "position", dim), *X = fetch(&w, set, "reference_position", dim);
  int64_t *kind = fetch_as(&w, set, "kind", MPM_I64, 1);
  for (int64_t p = 0; p < n; ++p) {
    const int64_t parent = p < 40 ? p : (p - 40) / (parts - 1); /* ids are in the order of the parents' */
    ck_assert_int_eq(kind[p], parent);
    ck_holds(density2[p] == density[parent]);
    for (int32_t c = 0; c < 9; ++c) ck_holds(F2[c * n + p] == F[c * 40 + parent]);
    for (int32_t c = 0; c < 6; ++c) ck_holds(stress2[c * n + p] == stress[c * 40 + parent]);
    for (int32_t k = 0; k < dim; ++k) {
      double way = 0.0; /* from the particle that keeps the id, by F from the reference */
      for (int32_t c = 0; c < dim; ++c) way += F2[(3 * k + c) * n + p] * (X[c * n + p] - X[c * n + parent]);
      ck_within(how->name, x[k * n + p] - x[k * n + parent], way, 1e-13);
      ck_holds(size2[k * n + p] == 0.5 * size[k * 40 + parent]);
      ck_within(how->name, fabs(X[k * n + p] - X[k * n + parent]), 0.0, 0.5001 * size[k * 40 + parent]);
    }
  }
  free(F), free(size), free(stress), free(density), free(F2), free(size2), free(stress2), free(density2);
  free(x), free(X), free(kind);
  world_close(&w);
}
END_TEST

START_TEST(merges_keep_sums) {
  const method *how = &methods[_i % ALL_METHODS];
  const int32_t dim = 1 + _i / ALL_METHODS;
  if (how->remedy && dim == 1) return;
  world w;
  mpm_particles *set = open_cloud(&w, how, dim, (uint64_t)_i + 7, 300);
  equip(&w, set);
  const mpm_adaption_desc desc = merge_all();
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &desc));
  const sums before = sum_up(&w, set);
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  const sums after = sum_up(&w, set);
  const mpm_adaption_info info = told(&w, set);
  ck_assert_int_eq(info.splits, 0);
  ck_assert_int_ge(info.merges, dim == 1 ? 140 : dim == 2 ? 80 : 40);
  ck_assert_int_eq(mpm_particles_count(set), 300 - info.merges);
  check_sums(how->name, &before, &after, &info, carries_matrix(how->transfer));
  ck_holds(info.kinetic_loss > 0.0);
  world_step(&w, 1e-6);
  world_close(&w);
}
END_TEST

/* The loss of one pair by hand: m1 m2 / (2 M) |v1 - v2|^2, and (m1 m2 / M) (x1 - x2) x (v1 - v2). */
START_TEST(pair_by_hand) {
  world w;
  const world_desc desc = described(&methods[0], 3);
  mpm_particles *set = world_open(&w, &desc);
  const double x[] = {1.0, 1.1, 1.0, 1.0, 1.0, 1.05}, v[] = {0.2, -0.1, 0.3, 0.1, 0.0, 0.4},
               volume[] = {1e-3, 2e-3};
  ck_ok(&w, mpm_particles_add(set, 2, x, v, volume, NULL, NULL, NULL));
  const mpm_adaption_desc all = merge_all();
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &all));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  const mpm_adaption_info info = told(&w, set);
  const double m[] = {1.0, 2.0}, mu = m[0] * m[1] / 3.0, dx[] = {-0.1, 0.0, -0.05}, dv[] = {0.3, 0.2, -0.4};
  ck_assert_int_eq(info.merges, 1);
  ck_assert_int_eq(mpm_particles_count(set), 1);
  ck_within("kinetic", info.kinetic_loss, 0.5 * mu * (dv[0] * dv[0] + dv[1] * dv[1] + dv[2] * dv[2]), 1e-15);
  for (int32_t r = 0; r < 3; ++r) {
    const int32_t a = (r + 1) % 3, b = (r + 2) % 3;
    ck_within("spin", info.angular_momentum_loss[r], mu * (dx[a] * dv[b] - dx[b] * dv[a]), 1e-15);
  }
  int64_t *id = fetch_ids(&w, set);
  ck_assert_int_eq(id[0], 1); /* the heavier one stays */
  ck_within("x", fetch1(&w, set, "position", 3, 0, 1), (1.0 + 2.2) / 3.0, 1e-15);
  ck_within("size",
            fetch1(&w, set, "size", 3, 0, 1) * fetch1(&w, set, "size", 3, 1, 1) *
                fetch1(&w, set, "size", 3, 2, 1),
            3e-3, 1e-17);
  free(id);
  world_close(&w);
}
END_TEST

/* What came of one particle and is put together again is that particle, its matrix as well. */
START_TEST(there_and_back) {
  const method *how = &methods[_i % ALL_METHODS];
  const int32_t dim = 1 + _i / ALL_METHODS;
  if (how->remedy && dim == 1) return;
  world w;
  const world_desc desc = described(how, dim);
  mpm_particles *set = world_open(&w, &desc);
  const double x[] = {1.1, 1.13, 1.11}, v[] = {0.3, -0.2, 0.1};
  double size[] = {0.04, 0.05, 0.06};
  size[_i % dim] = 0.2;
  const double volume = size[0] * (dim > 1 ? size[1] : 1.0) * (dim > 2 ? size[2] : 1.0);
  ck_ok(&w, mpm_particles_add(set, 1, x, v, &volume, size, NULL, NULL));
  dice d = {9};
  if (carries_matrix(how->transfer)) add_affine(&w, set, &d, 2.0);
  mpm_adaption_desc adapt = adaption_desc();
  adapt.split_edge = 0.5; /* of the longest edge alone */
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  world_bits was = world_take(&w);
  double *C = fetch(&w, set, "velocity_gradient", 9);
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_eq(mpm_particles_count(set), 2);
  adapt = merge_all();
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_eq(mpm_particles_count(set), 1);
  for (int32_t k = 0; k < dim; ++k) {
    ck_within(how->name, fetch1(&w, set, "position", dim, k, 0), x[k], 1e-15);
    ck_within(how->name, fetch1(&w, set, "velocity", dim, k, 0), v[k], 1e-15);
    ck_within(how->name, fetch1(&w, set, "size", dim, k, 0), size[k], 1e-15);
    ck_within(how->name, fetch1(&w, set, "reference_position", dim, k, 0), x[k], 1e-15);
  }
  for (int32_t c = 0; c < 9; ++c)
    ck_within(how->name, fetch1(&w, set, "velocity_gradient", 9, c, 0), C[c], 1e-12);
  ck_within(how->name, fetch1(&w, set, "mass", 1, 0, 0), 1e3 * volume, 1e-13);
  free(C);
  bits_drop(&was);
  world_close(&w);
}
END_TEST

/* Two particles in the same state become one in that state, by every law, on every kind of grid. */
START_TEST(state_is_kept) {
  const int32_t dim = 1 + _i / LAWS % 3, geometry = _i / LAWS / 3;
  const char *model = law_options[_i % LAWS].model;
  if (geometry != MPM_PLANE_STRAIN && dim != 2) return;
  if (!model || !strcmp(model, "rigid")) return;
  const int32_t soft = !strcmp(model, "cam_clay") || !strcmp(model, "snow") || !strcmp(model, "mu_i") ||
                       keeps_volume_alone(model);
  if (geometry == MPM_PLANE_STRESS && soft) return;
  world w;
  world_desc desc = world_default(dim, 8, 0.25);
  desc.grid.geometry = geometry;
  desc.law =
      (world_law){.model = model, .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e3, .hardening = 1e4};
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.5, 0.5, 0.5}, high[] = {1.0, 1.0, 1.0};
  world_fill(&w, set, low, high, 2);
  const int64_t n = mpm_particles_count(set);
  double *stress = calloc((size_t)(6 * n), sizeof *stress), *F = calloc((size_t)(9 * n), sizeof *F);
  for (int64_t p = 0; p < n; ++p) {
    F[p] = keeps_volume_alone(model) ? 0.99 : 0.97;
    F[4 * n + p] = dim > 1 ? 0.99 : 1.0;
    F[8 * n + p] = dim > 2 || geometry == MPM_AXISYMMETRIC ? 0.99 : 1.0;
    if (keeps_volume_alone(model)) F[4 * n + p] = F[8 * n + p] = dim == 1 ? 1.0 : 0.99;
    for (int32_t c = 0; c < 3; ++c) stress[c * n + p] = -1e3;
  }
  if (!(keeps_volume_alone(model) && dim == 2)) put(&w, set, "deformation_gradient", 9, F);
  if (!strcmp(model, "cam_clay")) put(&w, set, "stress", 6, stress);
  world_step(&w, 1e-7);
  double *before = fetch(&w, set, "stress", 6);
  double *volumes = fetch(&w, set, "volume", 1);
  const double V = sum_of(n, volumes);
  free(volumes);
  const mpm_adaption_desc all = merge_all();
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &all));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  const int64_t left = mpm_particles_count(set);
  ck_assert_int_eq(left, n / 2);
  double *after = fetch(&w, set, "stress", 6), *volume = fetch(&w, set, "volume", 1);
  int64_t *id = fetch_ids(&w, set);
  ck_within(model, sum_of(left, volume), V, 1e-13 * V);
  for (int64_t p = 0; p < left; ++p)
    for (int32_t c = 0; c < 6; ++c)
      ck_within(model, after[c * left + p], before[c * n + id[p]], 1e-3 + 1e-6 * fabs(before[c * n + id[p]]));
  world_step(&w, 1e-7);
  free(stress), free(F), free(before), free(after), free(volume), free(id);
  world_close(&w);
}
END_TEST

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

START_TEST(limits) {
  world w;
  const world_desc desc = described(&methods[0], 2);
  mpm_particles *set = world_open(&w, &desc);
  world_fill_cube(&w, set, 0.5, 1.0);
  const int64_t n = mpm_particles_count(set);
  mpm_adaption_desc adapt = split_all();
  adapt.most_particles = n + 6; /* two splits in four, and not a third */
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_eq(mpm_particles_count(set), n + 6);
  adapt.most_particles = 0;
  adapt.least_edge = 0.3; /* edges are half a cell long, and some a quarter */
  adapt.split_edge = 0.6;
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_eq(mpm_particles_count(set), n + 6);
  adapt.split_edge = 0.0;
  adapt.min_per_cell = 9; /* cells have four particles, whose halves would be too short */
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_eq(mpm_particles_count(set), n + 6);
  adapt.least_edge = 0.2;
  adapt.min_per_cell =
      6; /* cells have four particles: two of them are halved along x, those with whole edges */
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_eq(mpm_particles_count(set), 4 * 6 + 4);
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, NULL));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_eq(mpm_particles_count(set), 4 * 6 + 4);
  world_close(&w);
}
END_TEST

/* Across a periodic seam parts are wrapped; at other faces particles wait until there is room. */
START_TEST(faces) {
  for (int32_t periodic = 0; periodic < 2; ++periodic) {
    world w;
    world_desc desc = described(&methods[0], 2);
    desc.grid.periodic[0] = periodic;
    mpm_particles *set = world_open(&w, &desc);
    const double x[] = {0.01, 1.0}, volume = 0.01;
    ck_ok(&w, mpm_particles_add(set, 1, x, NULL, &volume, NULL, NULL, NULL));
    mpm_adaption_desc adapt = split_all();
    ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
    ck_ok(&w, mpm_stepper_adapt(w.stepper));
    ck_assert_int_eq(mpm_particles_count(set), periodic ? 4 : 1);
    if (periodic) {
      double *at = fetch(&w, set, "position", 2), *X = fetch(&w, set, "reference_position", 2);
      ck_within("wrapped", at[0], 2.0 - 0.015, 1e-14);
      ck_within("not wrapped", X[0], -0.015, 1e-14);
      free(at), free(X);
    }
    world_close(&w);
  }
}
END_TEST

/* Rings have mass by their radius, before and after. */
START_TEST(rings) {
  world w;
  world_desc desc = described(&methods[0], 2);
  desc.grid.geometry = MPM_AXISYMMETRIC;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.25, 0.5}, high[] = {1.0, 1.0};
  const int64_t n = world_fill(&w, set, low, high, 1);
  const mpm_adaption_desc adapt = split_all();
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_eq(mpm_particles_count(set), 4 * n);
  double *m = fetch(&w, set, "mass", 1), *x = fetch(&w, set, "position", 2),
         *size = fetch(&w, set, "size", 2);
  for (int64_t p = 0; p < 4 * n; ++p)
    ck_within("mass", m[p], 1e3 * x[p] * size[p] * size[4 * n + p], 1e-13 * m[p]);
  ck_within("all", sum_of(4 * n, m), 1e3 * 0.5 * (1.0 - 0.0625) * 0.5, 1e-10);
  free(m), free(x), free(size);
  world_close(&w);
}
END_TEST

/* Particles that leave through an open wall in the step are not split. */
START_TEST(open_wall) {
  world w;
  const world_desc desc = described(&methods[0], 2);
  mpm_particles *set = world_open(&w, &desc);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_OPEN, 0.0));
  const double low[] = {1.5, 0.5}, high[] = {2.0, 1.0}, v[] = {4.0, 0.0};
  const int64_t n = world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_adaption_desc adapt = split_all();
  adapt.every = 1;
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  w.info = world_step(&w, 0.02);
  ck_assert_int_eq(w.info.removed, 4);
  ck_assert_int_eq(told(&w, set).splits, n - 4);
  ck_assert_int_eq(mpm_particles_count(set), n - 4 + told(&w, set).added);
  world_close(&w);
}
END_TEST

/* Nor are they merged, with what stays behind or with each other. */
START_TEST(open_wall_and_pairs) {
  world w;
  const world_desc desc = described(&methods[0], 2);
  mpm_particles *set = world_open(&w, &desc);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_OPEN, 0.0));
  const double low[] = {1.5, 0.5}, high[] = {2.0, 1.0}, v[] = {4.0, 0.0};
  world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_adaption_desc adapt = merge_all();
  adapt.every = 1;
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  w.info = world_step(&w, 0.02);
  ck_assert_int_eq(w.info.removed, 4);
  ck_assert_int_eq(told(&w, set).merges, 6); /* of two particles one, of four two, in two rows of cells */
  ck_assert_int_eq(mpm_particles_count(set), 6);
  world_close(&w);
}
END_TEST

/* Of two neighbours that are equally near the one with the lower id is taken. */
START_TEST(ties) {
  world w;
  const world_desc desc = described(&methods[0], 2);
  mpm_particles *set = world_open(&w, &desc);
  world_fill_cube(&w, set, 0.5, 0.75);
  ck_assert_int_eq(mpm_particles_count(set), 4);
  mpm_adaption_desc adapt = merge_all();
  adapt.max_per_cell = 3;
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  int64_t *id = fetch_ids(&w, set);
  ck_holds(mpm_particles_count(set) == 3 && id[0] == 0 && id[1] == 2 && id[2] == 3);
  free(id);
  world_close(&w);
}
END_TEST

/* Prescribed particles keep their velocities; pairs of unlike ones stay apart. */
START_TEST(prescribed_stay) {
  const method *how = &methods[_i];
  world w;
  const world_desc desc = described(how, 2);
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 0.5, 1.0);
  const uint8_t axes[] = {0, 1};
  const double held[] = {0.0, 0.25};
  dice d = {3};
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, held));
  if (carries_matrix(how->transfer)) add_affine(&w, set, &d, 2.0);
  ck_ok(&w, mpm_particles_set_all(set, "prescribed", MPM_U8, 2, axes));
  const mpm_adaption_desc apart = split_all(), together = merge_all();
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &apart));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  ck_assert_int_eq(mpm_particles_count(set), 4 * n);
  double *v = fetch(&w, set, "velocity", 2);
  for (int64_t p = 0; p < 4 * n; ++p) {
    ck_holds(v[4 * n + p] == 0.25);
    v[4 * n + p] = p % 2 ? 0.25 : 0.5;
  }
  put(&w, set, "velocity", 2, v);
  ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &together));
  ck_ok(&w, mpm_stepper_adapt(w.stepper));
  free(v);
  const int64_t left = mpm_particles_count(set);
  ck_holds(left < 4 * n);
  v = fetch(&w, set, "velocity", 2);
  for (int64_t p = 0; p < left; ++p) ck_holds(v[left + p] == 0.25 || v[left + p] == 0.5);
  free(v);
  world_close(&w);
}
END_TEST

/* Two particles that are turned against each other have no mean. */
START_TEST(no_mean) {
  for (int32_t hosts = 0; hosts < 2; ++hosts) {
    static reference_law host_law = {1e5, 0.3, 15.0};
    world w;
    world_desc desc = described(&methods[0], 2);
    if (hosts) desc.law = (world_law){.density = 1e3, .stress = reference_law_stress, .user = &host_law};
    mpm_particles *set = world_open(&w, &desc);
    const double x[] = {1.05, 1.1, 1.1, 1.1}, volume[] = {1e-3, 1e-3};
    const double F[] = {1.0,  -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0,
                        -1.0, 0.0,  0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0};
    ck_ok(&w, mpm_particles_add(set, 2, x, NULL, volume, NULL, NULL, NULL));
    put(&w, set, "deformation_gradient", 9, F);
    const mpm_adaption_desc all = merge_all();
    ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &all));
    ck_ok(&w, mpm_stepper_adapt(w.stepper));
    ck_assert_int_eq(mpm_particles_count(set), 2);
    world_close(&w);
  }
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

/* Sizes that do not fit the volume make no negative masses; parts that are ordered already count in a
 * cell. */
START_TEST(odd_sizes) {
  for (int32_t round = 0; round < 2; ++round) {
    world w;
    world_desc desc = described(&methods[0], 2);
    desc.grid.geometry = round ? MPM_AXISYMMETRIC : MPM_PLANE_STRAIN;
    mpm_particles *set = world_open(&w, &desc);
    const double x[] = {1.05, 1.15, 1.1, 1.1}, volume[] = {1e-3, 1e-3}, size[] = {0.25, 0.1, 0.1, 0.1};
    ck_ok(&w, mpm_particles_add(set, 2, x, NULL, volume, size, NULL, NULL));
    mpm_adaption_desc adapt = adaption_desc();
    adapt.split_edge = 0.6;
    adapt.min_per_cell = 3;
    ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &adapt));
    ck_ok(&w, mpm_stepper_adapt(w.stepper));
    ck_assert_int_eq(mpm_particles_count(set), 3);
    double *m = fetch(&w, set, "mass", 1);
    for (int64_t p = 0; p < 3; ++p) ck_holds(m[p] > 0.0);
    ck_within("mass", sum_of(3, m), 2.0, 1e-12);
    free(m);
    world_close(&w);
  }
}
END_TEST

START_TEST(refusals) {
  world w;
  world_desc desc = described(&methods[0], 2);
  mpm_particles *set = world_open(&w, &desc);
  mpm_adaption_desc d = adaption_desc();
  mpm_stepper *s = w.stepper;
  ck_assert(d.split_edge == 0.0 && d.min_per_cell == 0 && d.max_per_cell == 0 && d.every == 10);
  ck_refused(&w, mpm_stepper_set_adaption(s, NULL, &d), MPM_E_ARG, "particles is NULL");
#define BAD(field, value, text)                                                                              \
  d = adaption_desc(), d.field = value;                                                                      \
  ck_refused(&w, mpm_stepper_set_adaption(s, set, &d), MPM_E_ARG, text)
  BAD(every, -1, "every is -1");
  BAD(split_edge, -1.0, "split_edge is -1");
  BAD(split_edge, 0.2, "at least twice as long");
  BAD(least_edge, 0.0, "least_edge is 0");
  BAD(merge_distance, NOT_A_NUMBER, "merge_distance is nan");
  BAD(merge_tolerance, -0.1, "merge_tolerance is -0.1");
  BAD(min_per_cell, -1, "min_per_cell is -1");
  BAD(max_per_cell, -1, "max_per_cell -1");
  BAD(most_particles, -1, "most_particles is -1");
  d = adaption_desc();
  d.min_per_cell = 3, d.max_per_cell = 5;
  ck_refused(&w, mpm_stepper_set_adaption(s, set, &d), MPM_E_ARG, "at least twice as many");
  mpm_view view = {.struct_size = sizeof view};
  d = adaption_desc();
  world_fill_cube(&w, set, 0.5, 1.0);
  ck_ok(&w, mpm_particles_map(set, "velocity", MPM_READ, &view));
  ck_refused(&w, mpm_stepper_set_adaption(s, set, &d), MPM_E_STATE, "view");
  ck_refused(&w, mpm_stepper_adapt(s), MPM_E_STATE, "before they adapt");
  ck_ok(&w, mpm_view_release(&view));
  ck_refused(&w, mpm_particles_set_extensive(set, "mass", 1), MPM_E_ARG, "a field of the library");
  ck_ok(&w, mpm_particles_add_field(set, "kind", MPM_I64, 1));
  ck_refused(&w, mpm_particles_set_extensive(set, "kind", 1), MPM_E_ARG, "of another type");
  ck_ok(&w, mpm_particles_add_field(set, "heat", MPM_F64, 1));
  ck_refused(&w, mpm_particles_set_extensive(set, "heat", 2), MPM_E_ARG, "extensive is 2");
  ck_refused(&w, mpm_particles_set_extensive(set, "cold", 1), MPM_E_NOT_FOUND, "cold");
  ck_ok(&w, mpm_step_begin(s, 1e-4));
  ck_refused(&w, mpm_stepper_set_adaption(s, set, &d), MPM_E_STATE, "a step is under way");
  ck_refused(&w, mpm_stepper_adapt(s), MPM_E_STATE, "a step is under way");
  ck_ok(&w, mpm_step_abort(s));
  mpm_adaption_info info = {.struct_size = sizeof info};
  ck_refused(&w, mpm_stepper_adaption_info(s, NULL, &info), MPM_E_ARG, "particles is NULL");
  ck_refused(&w, mpm_stepper_adaption_info(s, set, NULL), MPM_E_ARG, "NULL");
  world_close(&w);
  desc.grid.total_lagrangian = 1;
  set = world_open(&w, &desc);
  ck_refused(&w, mpm_stepper_set_adaption(w.stepper, set, &d), MPM_E_UNSUPPORTED, "does not come apart");
  world_close(&w);
  desc.grid.total_lagrangian = 0;
  desc.law = (world_law){.model = "rigid", .density = 1e3};
  set = world_open(&w, &desc);
  ck_refused(&w, mpm_stepper_set_adaption(w.stepper, set, &d), MPM_E_UNSUPPORTED, "a rigid set");
  world_close(&w);
}
END_TEST

Suite *adaption_suite(void);
Suite *adaption_suite(void) {
  Suite *suite = suite_create("adaption");
  TCase *parts = tcase_create("parts");
  if (!list) list = list_combinations(&listed);
  tcase_add_loop_test(parts, splits_keep_sums, 0, 3 * ALL_METHODS);
  tcase_add_loop_test(parts, merges_keep_sums, 0, 3 * ALL_METHODS);
  tcase_add_test(parts, pair_by_hand);
  tcase_add_loop_test(parts, there_and_back, 0, 3 * ALL_METHODS);
  tcase_add_loop_test(parts, state_is_kept, 0, 9 * LAWS);
  tcase_add_loop_test(parts, parts_and_states, 0, METHODS);
  tcase_add_test(parts, order_of_adding);
  tcase_add_loop_test(parts, memory_runs_out, 0, 3);
  tcase_add_test(parts, host_is_asked);
  tcase_add_test(parts, limits);
  tcase_add_test(parts, faces);
  tcase_add_test(parts, rings);
  tcase_add_test(parts, open_wall);
  tcase_add_test(parts, open_wall_and_pairs);
  tcase_add_test(parts, ties);
  tcase_add_loop_test(parts, prescribed_stay, 0, METHODS);
  tcase_add_test(parts, no_mean);
  tcase_add_test(parts, state_without_sizes);
  tcase_add_test(parts, nodal_fields_stay);
  tcase_add_test(parts, odd_sizes);
  tcase_add_test(parts, refusals);
  suite_add_tcase(suite, parts);
  TCase *all = tcase_create("combinations");
  tcase_add_loop_test(all, combination_works, 0, listed);
  tcase_set_timeout(all, 60);
  suite_add_tcase(suite, all);
  return suite;
}
