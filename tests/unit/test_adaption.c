/* Splitting and merging of particles: what is kept, what is reported, and that nothing else matters. */
#include "adaption.h"

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

/* ---- what is chosen ------------------------------------------------------------------------------------ */
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

/* Pairs just nearer than the bound are merged, and those just farther are not, along axes and across them. */
START_TEST(how_near) {
  static const double way[4][2] = {{0.24, 0.0}, {0.0, -0.24}, {0.17, 0.17}, {-0.14, 0.19}};
  world_desc desc = described(&methods[0], 2);
  for (int32_t k = 0; k < 8; ++k) {
    const double h = 0.25, more = k < 4 ? 1.0 : 1.1, x = 1.125, y = 1.125;
    const double position[4] = {x, x + more * way[k % 4][0] * h, y, y + more * way[k % 4][1] * h},
                 volume[2] = {0.01, 0.01};
    world w;
    mpm_particles *set = world_open(&w, &desc);
    ck_ok(&w, mpm_particles_add(set, 2, position, NULL, volume, NULL, NULL, NULL));
    mpm_adaption_desc d = adaption_desc();
    d.every = 0;
    d.max_per_cell = 1;
    ck_ok(&w, mpm_stepper_set_adaption(w.stepper, set, &d));
    ck_ok(&w, mpm_stepper_adapt(w.stepper));
    ck_assert_msg(mpm_particles_count(set) == (k < 4 ? 1 : 2), "pair %d", (int)k);
    world_close(&w);
  }
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
  double *m = fetch(&w, set, "mass", 1), slow = 0.0;
  for (int64_t p = 0; p < left; ++p) {
    ck_holds(v[left + p] == 0.25 || v[left + p] == 0.5);
    if (v[left + p] == 0.25) slow += m[p];
  }
  ck_within("mass of the slow", slow, 0.5 * mass_of(&w, set), 1e-9); /* half of them, and still */
  free(v), free(m);
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
  tcase_add_loop_test(parts, splits_keep_sums, 0, 3 * ALL_METHODS);
  tcase_add_loop_test(parts, merges_keep_sums, 0, 3 * ALL_METHODS);
  tcase_add_test(parts, pair_by_hand);
  tcase_add_loop_test(parts, there_and_back, 0, 3 * ALL_METHODS);
  tcase_add_loop_test(parts, state_is_kept, 0, 9 * LAWS);
  tcase_add_test(parts, limits);
  tcase_add_test(parts, faces);
  tcase_add_test(parts, rings);
  tcase_add_test(parts, ties);
  tcase_add_test(parts, how_near);
  tcase_add_loop_test(parts, prescribed_stay, 0, METHODS);
  tcase_add_test(parts, no_mean);
  tcase_add_test(parts, odd_sizes);
  tcase_add_test(parts, refusals);
  suite_add_tcase(suite, parts);
  add_adaption_steps(suite);
  return suite;
}
