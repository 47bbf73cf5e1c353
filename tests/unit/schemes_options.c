/* Options of a step with closed forms: falls, damping, the lowest order of XPIC, angular momentum, and what a
 * law is given by the remedy against locking. */
#include "reference.h"
#include "schemes.h"

static const double h = 0.25;

static world_desc described(int32_t dim, const basis_option *b, int32_t scheme, int32_t transfer) {
  world_desc d = world_default(dim, 8, h);
  d.law.E = 1e3;
  use_basis(b, &d.grid);
  d.stepper.scheme = scheme;
  d.stepper.transfer = transfer;
  return d;
}

/* Constant acceleration: positions of second order are exact, and so are those of velocities that live half a
 * step back, whatever dt does; v + g dt_v with dt_v the mean of two steps keeps them there. */
START_TEST(falls_are_exact) {
  const basis_option *basis = &basis_options[_i % BASES];
  const int32_t staggered = _i / BASES;
  const double g[3] = {1.0, -9.81, 2.0}, v0[3] = {0.4, 2.0, -0.3};
  for (int32_t scheme = 0; scheme < SCHEMES; ++scheme)
    for (int32_t transfer = 0; transfer < TRANSFERS; ++transfer) {
      world_desc d = described(2, basis, scheme_options[scheme].scheme, transfer_options[transfer].transfer);
      d.stepper.xpic_order = transfer_options[transfer].xpic_order;
      d.stepper.xpic_every = transfer_options[transfer].xpic_every;
      d.stepper.staggered = staggered;
      d.stepper.position_order = staggered ? 1 : 2;
      memcpy(d.stepper.gravity, g, sizeof g);
      if (d.stepper.transfer == MPM_APIC_MLS && !fits_mls(basis)) continue;
      world w;
      mpm_particles *set = world_open(&w, &d);
      const int64_t n = world_fill_cube(&w, set, 0.5, 1.0);
      const double first = 0.005;
      double start[3], t = 0.0, *x0 = fetch(&w, set, "position", 2);
      for (int32_t k = 0; k < 2; ++k) start[k] = v0[k] - (staggered ? 0.5 * first * g[k] : 0.0);
      ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, start));
      double dt = first;
      for (int32_t i = 0; i < 20; ++i) {
        dt = first * (1.0 + 0.5 * (i % 3));
        world_step(&w, dt);
        t += dt;
      }
      double *x = fetch(&w, set, "position", 2), *v = fetch(&w, set, "velocity", 2);
      for (int64_t i = 0; i < 2 * n; ++i) {
        const int64_t k = i / n;
        ck_within(basis->name, x[i], x0[i] + v0[k] * t + 0.5 * g[k] * t * t, 1e-12);
        ck_within(basis->name, v[i], v0[k] + g[k] * (staggered ? t - 0.5 * dt : t), 1e-11);
      }
      free(x0), free(x), free(v);
      world_close(&w);
    }
}
END_TEST

/* Velocities after steps of a random cloud, by ascending id; to be freed. */
static double *after_steps(const world_desc *d, int32_t steps, double dt, int64_t *count) {
  world w;
  mpm_particles *set = world_open(&w, d);
  dice random = {42};
  add_cloud(&w, set, &random, 60, h, 0.5, 1.5, 1.0);
  if (carries_matrix(d->stepper.transfer)) add_affine(&w, set, &random, 1.0);
  for (int32_t i = 0; i < steps; ++i) world_step(&w, dt);
  double *v = fetch(&w, set, "velocity", w.dim);
  *count = mpm_particles_count(set) * w.dim;
  world_close(&w);
  return v;
}

static double difference(const double *a, const double *b, int64_t n) {
  double most = 0.0;
  for (int64_t i = 0; i < n; ++i) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

START_TEST(xpic_of_order_one_is_pic) {
  int64_t n;
  for (int32_t b = 0; b < BASES; ++b)
    for (int32_t s = 0; s < SCHEMES; ++s) {
      world_desc d = described(2, &basis_options[b], scheme_options[s].scheme, MPM_XPIC);
      d.stepper.xpic_order = 1;
      double *x = after_steps(&d, 5, 1e-3, &n);
      d.stepper.transfer = MPM_FLIP;
      d.stepper.flip = 0.0;
      double *y = after_steps(&d, 5, 1e-3, &n);
      ck_within(basis_options[b].name, difference(x, y, n), 0.0, 1e-11);
      d.stepper.flip = 1.0;
      double *z = after_steps(&d, 5, 1e-3, &n);
      ck_assert_double_gt(difference(x, z, n), 1e-3);
      free(x), free(y), free(z);
    }
}
END_TEST

/* A rate of damping is a blend of flip (1 - beta dt), never below PIC; two halves of a step damp like one, to
 * first order, where two blends damp twice. */
START_TEST(damping_is_a_rate) {
  static const int32_t transfers[3] = {MPM_FLIP, MPM_TFLIP, MPM_AFLIP};
  const double dt = 1e-3, beta = 40.0, flip = 0.8;
  world_desc d = described(2, &basis_options[1], MPM_USL, transfers[_i]);
  int64_t n;
  d.stepper.pic_damping = beta;
  d.stepper.flip = flip;
  double *damped = after_steps(&d, 4, dt, &n);
  d.stepper.pic_damping = 0.0;
  d.stepper.flip = flip * (1.0 - beta * dt);
  double *blended = after_steps(&d, 4, dt, &n);
  ck_within("damping", difference(damped, blended, n), 0.0, 1e-13);
  free(damped), free(blended);
  /* beyond 1 / dt: PIC */
  d.stepper.flip = flip;
  d.stepper.pic_damping = 1.5 / dt;
  damped = after_steps(&d, 2, dt, &n);
  d.stepper.pic_damping = 0.0;
  d.stepper.flip = 0.0;
  blended = after_steps(&d, 2, dt, &n);
  ck_within("damping", difference(damped, blended, n), 0.0, 1e-13);
  free(damped), free(blended);
  /* What damping takes off in the time of one step, by one step and by two of half the size. The forces of
   * the cloud act alike on both, but for terms of order dt^2. */
  double taken[2][2];
  for (int32_t level = 0; level < 2; ++level)
    for (int32_t halves = 0; halves < 2; ++halves) {
      const double span = dt / (1 << level);
      d.stepper.flip = 1.0;
      d.stepper.pic_damping = beta;
      damped = after_steps(&d, 1 + halves, span / (1 + halves), &n);
      d.stepper.pic_damping = 0.0;
      blended = after_steps(&d, 1 + halves, span / (1 + halves), &n);
      taken[level][halves] = difference(damped, blended, n);
      free(damped), free(blended);
    }
  for (int32_t level = 0; level < 2; ++level) {
    ck_assert_double_gt(taken[level][0], 1e-3 / (1 << level));
    ck_within("damping", taken[level][1] / taken[level][0], 1.0, 0.05);
  }
}
END_TEST

/* ---- angular momentum ---- */
typedef struct spin {
  double momentum, energy; /* about z; of the affine part */
} spin;

/* With the affine part that belongs to the moments of the basis at `at`. */
static spin spin_of(const mpm_grid_desc *grid, int64_t n, const double *m, const double *at, const double *x,
                    const double *v, const double *C, const double *size, const double *F) {
  spin s = {0.0, 0.0};
  for (int64_t p = 0; p < n; ++p) {
    double D[2] = {0.0, 0.0}, w, g;
    for (int32_t k = 0; k < 2; ++k) {
      const reference_axis axis = reference_axis_of(grid, k);
      const double edge = reference_edge(grid, k, size[k * n + p], F[4 * k * n + p]);
      for (int64_t i = reference_first(&axis); i <= reference_last(&axis); ++i) {
        reference_function(&axis, i, at[k * n + p], edge, &w, &g);
        D[k] += w * pow(reference_node(&axis, i) - at[k * n + p], 2.0);
      }
      s.energy += 0.5 * m[p] * D[k] * (C[k * n + p] * C[k * n + p] + C[(3 + k) * n + p] * C[(3 + k) * n + p]);
    }
    s.momentum += m[p] * (x[p] * v[n + p] - x[n + p] * v[p] + D[0] * C[3 * n + p] - D[1] * C[n + p]);
  }
  return s;
}

/* A step of APIC keeps the angular momentum, affine parts included, for every basis and up
 * to the faces: those that it starts with and those that it leaves both belong to the
 * moments at the positions where it starts. */
START_TEST(apic_keeps_angular_momentum) {
  const basis_option *basis = &basis_options[_i];
  for (int32_t scheme = 0; scheme < SCHEMES; ++scheme) {
    world_desc d = described(2, basis, scheme_options[scheme].scheme, MPM_APIC);
    world w;
    mpm_particles *set = world_open(&w, &d);
    dice random = {5};
    add_cloud(&w, set, &random, 80, h, 0.0, 2.0, 1.0);
    add_affine(&w, set, &random, 5.0);
    const double edges[2] = {0.6 * h, 0.4 * h};
    ck_ok(&w, mpm_particles_set_all(set, "size", MPM_F64, 2, edges));
    for (int32_t step = 0; step < 3; ++step) {
      double scale = 0.0;
      reference_cloud a = reference_take(&w, set);
      world_step(&w, 1e-4);
      reference_cloud b = reference_take(&w, set);
      const spin before = spin_of(&d.grid, a.n, a.m, a.x, a.x, a.v, a.C, a.size, a.F),
                 after = spin_of(&d.grid, a.n, a.m, a.x, b.x, b.v, b.C, a.size, a.F),
                 now = spin_of(&d.grid, a.n, a.m, b.x, b.x, b.v, b.C, b.size, b.F);
      for (int64_t p = 0; p < a.n; ++p) scale += a.m[p] * (fabs(a.v[p]) + fabs(a.v[a.n + p]));
      ck_within(basis->name, after.momentum, before.momentum, 1e-12 * scale);
      ck_within(basis->name, w.info.affine_kinetic_energy, now.energy, 1e-12 * now.energy);
      ck_within(basis->name, w.info.angular_momentum[2], now.momentum, 1e-12 * scale);
      reference_drop(&a), reference_drop(&b);
    }
    world_close(&w);
  }
}
END_TEST

/* ---- the remedy ---- */
enum { MOST_SEEN = 256 };
typedef struct witness {
  int64_t n;
  double F[MOST_SEEN][9], F_inc[MOST_SEEN][9];
} witness;

/* Writes down what it is given. */
static mpm_status watch(void *user, const mpm_material_batch *b) {
  witness *seen = user;
  for (int64_t p = 0; p < b->n; ++p) {
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + p] = 0.0;
    b->wave_speed[p] = 1.0;
    if (b->id[p] < 0 || b->id[p] >= MOST_SEEN || b->dt <= 0.0) continue;
    ++seen->n;
    for (int32_t c = 0; c < 9; ++c) {
      seen->F[b->id[p]][c] = b->F[c * b->ld + p];
      seen->F_inc[b->id[p]][c] = b->F_inc[c * b->ld + p];
    }
  }
  return MPM_OK;
}

static void product(const double *A, const double *B, double *C) {
  for (int32_t c = 0; c < 9; ++c) {
    C[c] = 0.0;
    for (int32_t k = 0; k < 3; ++k) C[c] += A[c / 3 * 3 + k] * B[3 * k + c % 3];
  }
}

/* The law sees (J_bar / J)^(1/d) F, J_bar grown by the mean dilation of its cell; F itself and the volume
 * stay true. What it sees of one step is the increment between what it has seen. */
START_TEST(remedy_averages_the_cell) {
  const int32_t dim = 2 + _i % 2;
  const double dt = 1e-2;
  world_desc d = described(dim, &basis_options[1], scheme_options[_i / 2].scheme, MPM_FLIP);
  d.stepper.locking_remedy = MPM_LOCKING_CELL_AVERAGE;
  world w;
  witness seen = {0};
  d.law = (world_law){.density = 1e3, .stress = watch, .user = &seen};
  mpm_particles *set = world_open(&w, &d);
  enum { CLOUD = 100 };
  dice random = {3};
  double x[3 * CLOUD], v[3 * CLOUD], V[CLOUD], J_bar[CLOUD], F_last[CLOUD][9];
  for (int32_t p = 0; p < CLOUD; ++p) {
    V[p] = throw_between(&random, 0.5, 1.5) * 1e-3;
    J_bar[p] = 1.0;
    for (int32_t c = 0; c < 9; ++c) F_last[p][c] = c % 4 == 0;
    for (int32_t k = 0; k < dim; ++k) {
      x[k * CLOUD + p] = throw_between(&random, 0.55, 1.2);
      v[k * CLOUD + p] = throw_between(&random, -0.5, 0.5);
    }
  }
  ck_ok(&w, mpm_particles_add(set, CLOUD, x, v, V, NULL, NULL, NULL));
  int64_t *ids = fetch_ids(&w, set);
  for (int32_t step = 0; step < 5; ++step) {
    double *at = fetch(&w, set, "position", dim), *old = fetch(&w, set, "deformation_gradient", 9);
    double *volume = fetch(&w, set, "volume", 1);
    seen.n = 0;
    world_step(&w, dt);
    ck_assert_int_ge(seen.n, CLOUD);
    double *F = fetch(&w, set, "deformation_gradient", 9), *V1 = fetch(&w, set, "volume", 1), J[2][CLOUD];
    for (int32_t p = 0; p < CLOUD; ++p)
      for (int32_t i = 0; i < 2; ++i) {
        double T[9];
        for (int32_t c = 0; c < 9; ++c) T[c] = (i ? F : old)[c * CLOUD + p];
        J[i][p] = determinant(T);
      }
    double grown[CLOUD];
    for (int32_t p = 0; p < CLOUD; ++p) {
      double above = 0.0, below = 0.0;
      for (int32_t q = 0; q < CLOUD; ++q) {
        int32_t same = 1;
        for (int32_t k = 0; k < dim; ++k)
          same &= floor(at[k * CLOUD + q] / h) == floor(at[k * CLOUD + p] / h);
        if (same) above += volume[q] * J[1][q] / J[0][q], below += volume[q];
      }
      grown[p] = above / below;
    }
    double changed = 0.0;
    for (int32_t p = 0; p < CLOUD; ++p) {
      const double *is = seen.F[ids[p]];
      J_bar[p] *= grown[p];
      const double factor = pow(J_bar[p] / J[1][p], 1.0 / dim);
      changed = fmax(changed, fabs(factor - 1.0));
      ck_within("true volume", V1[p], J[1][p] * V[p], 1e-15);
      double increment[9];
      product(seen.F_inc[ids[p]], F_last[p], increment);
      for (int32_t c = 0; c < 9; ++c) {
        const double scaled = c / 3 < dim && c % 3 < dim ? factor : 1.0;
        ck_within("what the law sees", is[c], scaled * F[c * CLOUD + p], 1e-12);
        ck_within("its increment", increment[c], is[c], 1e-12);
        F_last[p][c] = is[c];
      }
    }
    ck_assert_double_gt(changed, 1e-4);
    free(at), free(old), free(volume), free(F), free(V1);
  }
  free(ids);
  world_close(&w);
}
END_TEST

/* Energy, momenta and the stable step are summed up while a step passes over the particles, where the law may
 * have run before the particles moved. They must be those of the state that the step leaves: describing the
 * stepper once more makes it forget them, and they are made again from the particles. */
/* One step, then a wall, then another step; with `anew` the particles are sorted in between. */
static double *ratios_beside_new_wall(int32_t anew) {
  enum { SIDE = 6, CLOUD = SIDE * SIDE };
  world_desc d = described(2, &basis_options[1], MPM_USL, MPM_XPIC);
  d.stepper.xpic_order = 2;
  d.stepper.locking_remedy = MPM_LOCKING_CELL_AVERAGE;
  world w;
  mpm_particles *set = world_open(&w, &d);
  dice random = {11};
  double x[2 * CLOUD], v[2 * CLOUD], V[CLOUD];
  for (int32_t p = 0; p < CLOUD; ++p) {
    V[p] = 0.25 * h * h;
    x[p] = h * (3.25 + 0.5 * (p % SIDE)), x[CLOUD + p] = h * (1.25 + 0.5 * (p / SIDE));
    for (int32_t k = 0; k < 2; ++k) v[k * CLOUD + p] = throw_between(&random, -0.5, 0.5);
  }
  ck_ok(&w, mpm_particles_add(set, CLOUD, x, v, V, NULL, NULL, NULL));
  world_step(&w, 1e-3);
  double *at = fetch(&w, set, "position", 2);
  if (anew) ck_ok(&w, mpm_particles_set(set, "position", MPM_F64, 2, CLOUD, NULL, at));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  world_step(&w, 1e-3);
  double *ratio = fetch(&w, set, "dilation_ratio", 1);
  free(at);
  world_close(&w);
  return ratio;
}

/* Nodes that no particle reached had no part in the first step; beside the new wall they follow those that
 * some reach, and nothing of that may come into the sums over cells. */
START_TEST(remedy_beside_a_new_wall) {
  double *kept = ratios_beside_new_wall(0), *sorted = ratios_beside_new_wall(1);
  for (int32_t p = 0; p < 36; ++p) ck_within("dilation ratio", kept[p], sorted[p], 1e-13);
  free(kept), free(sorted);
}
END_TEST

START_TEST(sums_are_those_of_the_state) {
  const basis_option *basis = &basis_options[_i % BASES];
  const int32_t s = _i / BASES, scheme = s < SCHEMES ? scheme_options[s].scheme : MPM_NEWMARK;
  world_desc d = described(2, basis, scheme, scheme == MPM_NEWMARK ? MPM_FLIP : MPM_APIC);
  for (int32_t k = 0; k < 2; ++k) d.grid.cells[k] = 40;
  world w;
  mpm_particles *set = world_open(&w, &d);
  dice random = {7};
  add_cloud(&w, set, &random, 500, h, 0.5, 9.5, 1.0);
  const double dt = 0.1 * world_stable_dt(&w);
  for (int32_t i = 0; i < 3; ++i) {
    const mpm_step_info in_step = world_step(&w, dt);
    const double stable = world_stable_dt(&w), energy = in_step.kinetic_energy + in_step.strain_energy;
    ck_assert_int_gt(world_blocks(&w), 1); /* each task keeps the values of its last batch */
    ck_assert_double_gt(in_step.strain_energy, 0.0);
    ck_ok(&w, mpm_stepper_configure(w.stepper, &w.desc.stepper));
    const mpm_step_info anew = world_info(&w);
    ck_within(basis->name, in_step.kinetic_energy, anew.kinetic_energy, 1e-13 * energy);
    ck_within(basis->name, in_step.strain_energy, anew.strain_energy, 1e-13 * energy);
    ck_within(basis->name, in_step.affine_kinetic_energy, anew.affine_kinetic_energy, 1e-13 * energy);
    ck_within(basis->name, stable, world_stable_dt(&w), 1e-13 * stable);
    for (int32_t k = 0; k < 3; ++k) {
      ck_within(basis->name, in_step.momentum[k], anew.momentum[k], 1e-12 * energy);
      ck_within(basis->name, in_step.angular_momentum[k], anew.angular_momentum[k], 1e-11 * energy);
    }
  }
  world_close(&w);
}
END_TEST

TCase *schemes_options_case(void) {
  TCase *tc = tcase_create("options");
  tcase_set_timeout(tc, 60.0);
  tcase_add_loop_test(tc, falls_are_exact, 0, 2 * BASES);
  tcase_add_test(tc, xpic_of_order_one_is_pic);
  tcase_add_loop_test(tc, damping_is_a_rate, 0, 3);
  tcase_add_loop_test(tc, apic_keeps_angular_momentum, 0, BASES);
  tcase_add_loop_test(tc, remedy_averages_the_cell, 0, 2 * SCHEMES);
  tcase_add_test(tc, remedy_beside_a_new_wall);
  tcase_add_loop_test(tc, sums_are_those_of_the_state, 0, (SCHEMES + 1) * BASES);
  return tc;
}
