/* Fluids and rigid particles in the time loop: what becomes of F, and flows that are known: Couette's
 * start-up and a column at rest. The laws themselves are tested in material_fluid.c. */
#include "world.h"
#include "material/deformation.h"
#include "simd/flags.h"

static const mpm_param water[] = {
    {"density", 1e3}, {"bulk_modulus", 1e5}, {"gamma", 7.0}, {"viscosity", 20.0}};

static world_desc fluid_desc(int32_t dim, const method *how) {
  world_desc desc = world_default(dim, 8, 0.1);
  if (how) world_use(&desc, how);
  desc.law = (world_law){.model = "newtonian_fluid", .params = water, .param_count = 4};
  return desc;
}

/* All nodes move as v = A (x - 0.4). */
typedef struct lead {
  double A[9];
} lead;

static mpm_status lead_nodes(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const lead *l = user;
  for (int32_t k = 0; k < b->dim; ++k)
    for (int64_t i = 0; i < b->n; ++i) {
      double v = 0.0;
      for (int32_t c = 0; c < b->dim; ++c) v += l->A[3 * k + c] * (b->position[c * b->ld + i] - 0.4);
      prescribed[k * b->ld + i] = 1;
      velocity[k * b->ld + i] = v;
    }
  return MPM_OK;
}

/* F of particle p: round ones, sheared ones, and some that the host has turned by half a turn. */
static void some_F(dice *d, int32_t dim, int64_t p, double *F) {
  for (int32_t e = 0; e < 9; ++e) {
    const int32_t inside = e / 3 < dim && e % 3 < dim;
    F[e] = (e % 4 == 0) + (inside && p % 3 ? throw_between(d, -0.15, 0.15) : 0.0);
  }
  if (dim == 2 && p % 3 == 2) F[8] = 1.1;
  for (int32_t e = 0; p % 3 == 2 && dim > 1 && e < 6; ++e)
    if (e % 3 < 2) F[e] = -F[e];
}

START_TEST(volume_alone) {
  const int32_t dim = 1 + _i % 3;
  const method *how = &methods[_i / 3 * 5];
  const double dt = 1e-3;
  lead l;
  dice d = {77};
  world w;
  world_desc desc = fluid_desc(dim, how);
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 0.2, 0.6);
  double *F = malloc((size_t)(9 * n) * sizeof *F), *J = malloc((size_t)n * sizeof *J), inc[9];
  for (int64_t p = 0; p < n; ++p) {
    double one[9];
    some_F(&d, dim, p, one);
    for (int32_t e = 0; e < 9; ++e) F[e * n + p] = one[e];
    J[p] = determinant(one);
  }
  put(&w, set, "deformation_gradient", 9, F);
  double *v0 = fetch(&w, set, "initial_volume", 1);
  for (int32_t e = 0; e < 9; ++e) {
    const int32_t inside = e / 3 < dim && e % 3 < dim;
    l.A[e] = inside ? throw_between(&d, -2.0, 2.0) : 0.0;
    inc[e] = (e % 4 == 0) + dt * l.A[e];
  }
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, lead_nodes, &l));
  for (int32_t step = 1; step <= 40; ++step) {
    world_step(&w, dt);
    double *now = fetch(&w, set, "deformation_gradient", 9), *volume = fetch(&w, set, "volume", 1);
    double *stress = fetch(&w, set, "stress", 6);
    for (int64_t p = 0; p < n; ++p) {
      J[p] *= determinant(inc);
      const double f = dim == 1 ? J[p] : cbrt(J[p]), pressure = 1e5 / 7.0 * (pow(J[p], -7.0) - 1.0);
      for (int32_t e = 0; e < 9; ++e)
        if (e % 4)
          ck_assert(now[e * n + p] == 0.0);
        else
          ck_within(how->name, now[e * n + p], dim == 1 && e ? 1.0 : f, 1e-13);
      ck_within(how->name, volume[p], J[p] * v0[p], 2e-13 * v0[p]);
      const double f0 = now[p], exact = dim == 1 ? f0 : f0 * f0 * f0;
      ck_within(how->name, volume[p], exact * v0[p], 4e-16 * volume[p]);
      const double mean = (stress[p] + stress[n + p] + stress[2 * n + p]) / 3.0;
      ck_within(how->name, mean, -pressure, 1e-11 * (1e5 + pressure));
      for (int32_t c = 3; c < 6; ++c) { /* xy yz xz */
        const int32_t row = c == 4, column = c == 3 ? 1 : 2;
        const double rate = 0.5 * (l.A[3 * row + column] + l.A[3 * column + row]);
        ck_within(how->name, stress[c * n + p], 40.0 * rate,
                  40.0 * 3.0 * 36.0 * dt); /* ln V = dt rate + O(dt^2) */
      }
    }
    free(now), free(volume), free(stress);
  }
  free(F), free(J), free(v0);
  world_close(&w);
}
END_TEST

/* Setting the F of one particle does not take the others' viscous stress. */
START_TEST(viscous_stress_stays) {
  lead l = {{0.0, 3.0, 0.0, 1.0}};
  world w;
  const world_desc desc = fluid_desc(2, NULL);
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 0.2, 0.6);
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, lead_nodes, &l));
  for (int32_t i = 0; i < 3; ++i) world_step(&w, 1e-3);
  const double F[9] = {0.9, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  int64_t *ids = fetch_ids(&w, set);
  double *was = fetch(&w, set, "stress", 6);
  ck_ok(&w, mpm_particles_set(set, "deformation_gradient", MPM_F64, 9, 1, &ids[0], F));
  double *now = fetch(&w, set, "stress", 6);
  ck_within("shear", was[3 * n], 80.0, 5.0);
  for (int64_t p = 0; p < n; ++p) {
    ck_within("shear", now[3 * n + p], was[3 * n + p], 1e-13);
    ck_within("difference", now[p] - now[n + p], was[p] - was[n + p], 1e-10);
    if (p) ck_within("mean", now[p], was[p], 1e-10);
  }
  const double pressure = -(now[0] + now[n] + now[2 * n]) / 3.0;
  ck_within("pressure", pressure, 1e5 / 7.0 * (pow(0.9, -7.0) - 1.0), 1e-9);
  ck_refused(&w, mpm_particles_set(set, "stress", MPM_F64, 6, 1, &ids[0], was), MPM_E_UNSUPPORTED, "");
  free(ids), free(was), free(now);
  world_close(&w);
}
END_TEST

/* ---- the same bits on any number of threads, and after saving and loading ---- */
static void splash(world *w, int32_t dim, const method *how, int32_t concurrency, int32_t filled) {
  const double lower[3] = {0.15, 0.15, 0.15}, upper[3] = {1.9, 0.7, 0.6};
  world_desc desc = fluid_desc(dim, how);
  desc.context.concurrency = concurrency;
  desc.grid.cells[0] = 40;
  desc.grid.spacing[0] = 0.05;
  desc.stepper.gravity[dim - 1] = -9.81;
  mpm_particles *set = world_open(w, &desc);
  world_walls(w, MPM_WALL_SLIP, 0.0);
  if (!filled) return;
  const int64_t n = world_fill(w, set, lower, upper, 2);
  dice d = {3};
  double *v = malloc((size_t)(dim * n) * sizeof *v), *F = calloc((size_t)(9 * n), sizeof *F), one[9];
  for (int64_t i = 0; i < dim * n; ++i) v[i] = throw_between(&d, -1.0, 1.0);
  for (int64_t p = 0; p < n; ++p) {
    some_F(&d, dim, p % 7 ? 0 : p / 7, one);
    for (int32_t e = 0; e < 9; ++e) F[e * n + p] = one[e];
  }
  put(w, set, "velocity", dim, v);
  put(w, set, "deformation_gradient", 9, F);
  free(v), free(F);
}

START_TEST(same_bits) {
  const int32_t dim = 2 + _i / 4;
  const method *how = &methods[_i % 4 * 3];
  uint64_t first = 0;
  for (int32_t threads = 1; threads <= 4; ++threads) {
    world w;
    splash(&w, dim, how, threads, 1);
    for (int32_t i = 0; i < 40; ++i) world_step(&w, 5e-4);
    if (threads == 1) first = world_hash(&w);
    ck_assert_msg(world_hash(&w) == first, "%s on %d threads", how->name, (int)threads);
    world_close(&w);
  }
  world was, then;
  splash(&was, dim, how, 1, 1);
  splash(&then, dim, how, 2, 0);
  for (int32_t i = 0; i < 15; ++i) world_step(&was, 5e-4);
  world_copy(&was, &then);
  for (int32_t i = 0; i < 25; ++i) world_step(&then, 5e-4);
  ck_assert(world_hash(&then) == first);
  world_close(&was);
  world_close(&then);
}
END_TEST

/* ---- the kernel ---- */
enum { ITEMS = 32 };
typedef struct deforming {
  _Alignas(64) double L[9 * ITEMS], F[9 * ITEMS], old[9][ITEMS], now[9][ITEMS], volume0[ITEMS], volume[ITEMS];
  mpmi_deform job;
  int32_t stored;
} deforming;

/* Stored components by dimension: 0; 0 1 3 4 8; all. */
static void set_item(deforming *d, int32_t dim, int64_t p, const double *F) {
  int32_t c = 0;
  for (int32_t e = 0; e < 9; ++e)
    if (dim == 3 || (dim == 2 && (e == 0 || e == 1 || e == 3 || e == 4 || e == 8)) || e == 0)
      d->old[c++][p] = F[e];
  d->stored = c;
}

static void deforming_clear(deforming *d, int32_t dim, dice *toss) {
  memset(d, 0, sizeof *d);
  d->job = (mpmi_deform){.dt = 0.5, .ld = ITEMS, .L = d->L, .F = d->F};
  for (int32_t e = 0; e < 9; ++e) {
    d->job.F_old[e] = d->old[e];
    d->job.F_new[e] = d->now[e];
  }
  for (int64_t p = 0; p < ITEMS; ++p) {
    const double f = throw_between(toss, 0.9, 1.1), F[9] = {f, 0.0, 0.0, 0.0, f, 0.0, 0.0, 0.0, f};
    set_item(d, dim, p, F);
    d->volume0[p] = 2.0;
    for (int32_t e = 0; e < 9; ++e)
      if (e / 3 < dim && e % 3 < dim) d->L[e * ITEMS + p] = throw_between(toss, -0.3, 0.3);
  }
}

static uint32_t run_kernel(deforming *d, const mpmi_deformation *kernels, int32_t dim) {
  d->job.initial_volume = d->volume0;
  d->job.volume = d->volume;
  return kernels->deform[MPMI_F_DILATES][dim](&d->job, ITEMS);
}

START_TEST(kernel) {
  const int32_t dim = 1 + _i % 3, isa = MPM_ISA_BASELINE + _i / 3;
  if (!has_isa(isa)) return;
  const mpmi_deformation *kernels = mpmi_deformation_of(isa);
  static deforming a, b;
  const double turned[9] = {-1.1, 0.0, 0.0, 0.0, -1.2, 0.0, 0.0, 0.0, 0.9};
  dice first = {5}, second = {5};
  deforming_clear(&a, dim, &first);
  deforming_clear(&b, dim, &second);
  /* a neighbour that is not round changes no bit of the others */
  if (dim > 1) set_item(&b, dim, 7, turned);
  ck_assert_uint_eq(run_kernel(&a, kernels, dim), 0);
  ck_assert_uint_eq(run_kernel(&b, kernels, dim), 0);
  for (int64_t p = 0; p < ITEMS; ++p)
    for (int32_t c = 0; c < a.stored && p != 7; ++c) ck_assert(a.now[c][p] == b.now[c][p]);
  for (int64_t p = 0; p < ITEMS; ++p) {
    double inc[9], f = a.old[0][p];
    for (int32_t e = 0; e < 9; ++e) inc[e] = (e % 4 == 0) + 0.5 * a.L[e * ITEMS + p];
    const double J = determinant(inc) * (dim == 1 ? f : f * f * f);
    ck_within("volume", a.volume[p], 2.0 * J, 4e-15);
    ck_within("f of the law's batch", a.F[p], a.now[0][p], 0.0);
    if (p != 7 || dim == 1) continue;
    ck_within("volume", b.volume[p], 2.0 * determinant(inc) * determinant(turned), 4e-15);
    ck_assert(b.now[0][p] == b.now[a.stored - 1][p] && b.now[1][p] == 0.0);
  }
  /* what does not move keeps its bits, for ever */
  memset(a.L, 0, sizeof a.L);
  ck_assert_uint_eq(run_kernel(&a, kernels, dim), 0);
  for (int32_t c = 0; c < a.stored; ++c) ck_assert_mem_eq(a.now[c], a.old[c], sizeof a.now[c]);
  /* inverted, flattened, not a number, beyond doubles */
  const struct {
    double xx, yy;
    uint32_t flags;
  } bad[] = {{-4.0, 0.0, MPMI_NOT_POSITIVE},
             {-2.0, 0.0, MPMI_NOT_POSITIVE},
             {(double)NAN, 0.0, MPMI_NONFINITE},
             {(double)INFINITY, 0.0, MPMI_NONFINITE},
             {1e200, 1e200, dim == 1 ? 0 : MPMI_NONFINITE}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
    a.L[3] = bad[i].xx;
    if (dim > 1) a.L[4 * ITEMS + 3] = bad[i].yy;
    ck_assert_uint_eq(run_kernel(&a, kernels, dim) & bad[i].flags, bad[i].flags);
  }
}
END_TEST

/* ---- Couette's flow ---- */
typedef struct plates {
  double height, speed;
} plates;

/* The lower plate stands, the upper one slides. */
static mpm_status slide(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const plates *at = user;
  for (int64_t i = 0; i < b->n; ++i) {
    const double y = b->position[b->ld + i];
    if (y > 1e-9 && y < at->height - 1e-9) continue;
    prescribed[i] = prescribed[b->ld + i] = 1;
    velocity[i] = y > 0.5 * at->height ? at->speed : 0.0;
    velocity[b->ld + i] = 0.0;
  }
  return MPM_OK;
}

/* u/U = y/H + sum 2/(n pi) (-1)^n sin(n pi y/H) exp(-nu (n pi/H)^2 t) */
static double couette(double y, double nu_t) {
  double u = y;
  for (int32_t n = 1; n < 60; ++n)
    u += 2.0 / (n * PI) * (n % 2 ? -1.0 : 1.0) * sin(n * PI * y) * exp(-nu_t * n * n * PI * PI);
  return u;
}

START_TEST(starting_plate) {
  const double nu = 0.1, H = 1.0, lower[2] = {0.0, 0.0}, upper[2] = {0.2, H};
  const mpm_param oil[] = {{"density", 1.0}, {"bulk_modulus", 1.0}, {"viscosity", nu}};
  plates at = {H, 0.01};
  world w;
  world_desc desc = fluid_desc(2, &methods[16 + _i]); /* linear APIC, USL and MUSL */
  desc.law.params = oil, desc.law.param_count = 3;
  desc.grid.cells[0] = 4;
  desc.grid.cells[1] = 20;
  desc.grid.spacing[0] = desc.grid.spacing[1] = 0.05;
  desc.grid.periodic[0] = 1;
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, slide, &at));
  static const double times[] = {0.5, 1.0, 2.0, 8.0};
  double t = 0.0;
  for (int32_t k = 0; k < 4; ++k) {
    const double limit = 0.05 * 0.05 / (4.0 * nu);
    const int32_t steps = (int32_t)ceil((times[k] - t) / (0.5 * limit));
    for (int32_t i = 0; i < steps; ++i) world_step(&w, (times[k] - t) / steps);
    t = times[k];
    double *x = fetch(&w, set, "position", 2), *v = fetch(&w, set, "velocity", 2), worst = 0.0;
    double *stress = fetch(&w, set, "stress", 6), most = 0.0;
    for (int64_t p = 0; p < n; ++p) {
      worst = fmax(worst, fabs(v[p] / at.speed - couette(x[n + p] / H, nu * t)));
      most = fmax(most, fabs(stress[3 * n + p] / (nu * at.speed / H) - 1.0));
    }
    show("Couette %s t = %g: velocity off by %.4f U, final shear stress by %.4f\n", methods[16 + _i].name, t,
         worst, most);
    ck_between("velocity", worst, 0.0, 0.002);
    if (k == 3) ck_between("shear stress of the steady flow", most, 0.0, 0.002);
    free(x), free(v), free(stress);
  }
  ck_within("stable dt", world_stable_dt(&w), 0.05 * 0.05 / (4.0 * nu), 1e-4);
  world_close(&w);
}
END_TEST

/* ---- a column at rest ---- */
/* A column that has its hydrostatic pressure from the start stays: p = rho g depth. */
START_TEST(column_at_rest) {
  const double g = 9.81, H = 1.0, rho = 1e3, K = 400.0 * rho * g * H; /* c = 20 sqrt(g H) */
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.4, H};
  const mpm_param params[] = {{"density", rho}, {"bulk_modulus", K}, {"tension", 0.0}};
  world w;
  world_desc desc = fluid_desc(2, &methods[_i]);
  desc.law.params = params, desc.law.param_count = 3;
  desc.grid.cells[0] = 8;
  desc.grid.cells[1] = 24;
  desc.grid.spacing[0] = desc.grid.spacing[1] = 0.05;
  desc.stepper.gravity[1] = -g;
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill(&w, set, lower, upper, 2);
  for (int32_t face = 0; face < 3; ++face)
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));
  double *x = fetch(&w, set, "position", 2), *F = calloc((size_t)(9 * n), sizeof *F);
  for (int64_t p = 0; p < n; ++p) {
    const double J = pow(1.0 + 7.0 * rho * g * (H - x[n + p]) / K, -1.0 / 7.0);
    F[p] = F[8 * n + p] = 1.0;
    F[4 * n + p] = J; /* the fluid takes the volume */
  }
  put(&w, set, "deformation_gradient", 9, F);
  free(x), free(F);
  double mean = 0.0;
  int32_t counted = 0;
  for (int32_t step = 0; step < 600; ++step) {
    world_step(&w, 0.3 * world_stable_dt(&w));
    double *now = fetch(&w, set, "position", 2), *stress = fetch(&w, set, "stress", 6), p_middle = 0.0;
    int64_t middle = 0;
    for (int64_t p = 0; p < n; ++p)
      if (fabs(now[n + p] - 0.5 * H) < 0.05) {
        p_middle -= (stress[p] + stress[n + p] + stress[2 * n + p]) / 3.0 / (rho * g * (H - now[n + p]));
        ++middle;
      }
    mean += p_middle / (double)middle;
    ++counted;
    free(now), free(stress);
  }
  show("column %s: pressure at mid-depth %.4f of rho g depth on average\n", methods[_i].name, mean / counted);
  ck_within(methods[_i].name, mean / counted, 1.0, 0.02);
  world_close(&w);
}
END_TEST

/* ---- rigid particles ---- */
START_TEST(rigid_set) {
  const int32_t dim = 1 + _i % 3;
  dice d = {9};
  lead l = {{0.5, 0.1, 0.2, 0.3, -0.4, 0.1, 0.2, 0.1, 0.3}};
  world w;
  world_desc desc = fluid_desc(dim, &methods[_i / 3]);
  desc.law = (world_law){.model = "rigid", .density = 7.8e3};
  mpm_particles *set = world_open(&w, &desc);
  const int64_t n = world_fill_cube(&w, set, 0.2, 0.6);
  double dt = world_stable_dt(&w);
  ck_assert(isinf(dt) && dt > 0.0); /* nothing moves, and there are no waves */
  const mpm_advance_desc to = advance_desc(0.01);
  mpm_step_info info = {.struct_size = sizeof info};
  ck_ok(&w, mpm_advance(w.stepper, &to, &info));
  ck_assert(info.t == to.t_end && info.strain_energy == 0.0);
  double *F = malloc((size_t)(9 * n) * sizeof *F), one[9];
  for (int64_t p = 0; p < n; ++p) {
    some_F(&d, dim, p, one);
    for (int32_t e = 0; e < 9; ++e) F[e * n + p] = one[e];
  }
  put(&w, set, "deformation_gradient", 9, F);
  double *volume = fetch(&w, set, "volume", 1);
  const uint8_t free_axes[3] = {0, 0, 0}; /* led by nodes, not prescribed as rigid particles are */
  ck_ok(&w, mpm_particles_set_all(set, "prescribed", MPM_U8, dim, free_axes));
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, lead_nodes, &l));
  for (int32_t i = 0; i < 20; ++i) info = world_step(&w, 5e-3);
  double *now = fetch(&w, set, "deformation_gradient", 9), *volume_now = fetch(&w, set, "volume", 1);
  double *stress = fetch(&w, set, "stress", 6), *v = fetch(&w, set, "velocity", dim);
  ck_assert_mem_eq(now, F, (size_t)(9 * n) * sizeof *F);
  ck_assert_mem_eq(volume_now, volume, (size_t)n * sizeof *volume);
  for (int64_t i = 0; i < 6 * n; ++i) ck_assert(stress[i] == 0.0);
  dt = world_stable_dt(&w);
  ck_within("dt of moving particles", dt, 0.1 / largest(dim * n, v), 1e-12);
  ck_within("dt_suggested", info.dt_suggested, dt, 0.0);
  const double zero[6] = {0.0};
  ck_refused(&w, mpm_particles_set_all(set, "stress", MPM_F64, 6, zero), MPM_E_UNSUPPORTED, "rigid");
  free(F), free(volume), free(now), free(volume_now), free(stress), free(v);
  world_close(&w);
}
END_TEST

/* A rigid set that shares cells with a fluid takes no part in the averages of
 * the remedy: its ratio stays 1. */
START_TEST(rigid_set_and_remedy) {
  world w;
  world_desc desc = fluid_desc(2, &methods[0]);
  mpm_particles *column = world_open(&w, &desc);
  world_fill_cube(&w, column, 0.2, 0.6);
  mpm_particles *rigid = world_add_set(&w, &(world_law){.model = "rigid", .density = 8e3});
  const double lower[2] = {0.55, 0.2}, upper[2] = {0.8, 0.6};
  const int64_t n = world_fill(&w, rigid, lower, upper, 2);
  const double speed[2] = {-0.3, 0.0};
  ck_ok(&w, mpm_particles_set_all(rigid, "velocity", MPM_F64, 2, speed));
  mpm_stepper_desc d = stepper_desc();
  d.locking_remedy = MPM_LOCKING_CELL_AVERAGE;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &d));
  for (int32_t i = 0; i < 20; ++i) world_step(&w, 1e-4);
  double *ratio = fetch(&w, rigid, "dilation_ratio", 1), *other = fetch(&w, column, "dilation_ratio", 1);
  double apart = 0.0;
  for (int64_t p = 0; p < n; ++p) ck_assert(ratio[p] == 1.0);
  for (int64_t p = 0; p < mpm_particles_count(column); ++p) apart = fmax(apart, fabs(other[p] - 1.0));
  ck_assert_msg(apart > 1e-7, "the remedy has done nothing: %g", apart);
  free(ratio), free(other);
  world_close(&w);
}
END_TEST

/* Domains of particles follow from F, of which a fluid has the volume only. */
START_TEST(refused_basis) {
  world w;
  world_desc desc = fluid_desc(2, NULL);
  world_open(&w, &desc);
  desc.grid.basis = MPM_CPGIMP;
  mpm_grid *grid;
  const mpm_status status = mpm_grid_create(w.context, &desc.grid, &grid);
  if (!status) {
    mpm_particles *set;
    ck_refused(&w, mpm_particles_create(w.context, grid, w.material[0], &set), MPM_E_UNSUPPORTED,
               "newtonian_fluid");
    ck_assert_ptr_null(set);
    ck_ok(&w, mpm_grid_destroy(grid));
  } else {
    ck_assert_int_eq(status, MPM_E_UNSUPPORTED);
  }
  world_close(&w);
}
END_TEST

Suite *fluid_suite(void) {
  Suite *suite = suite_create("fluid");
  TCase *tc = tcase_create("fluid");
  tcase_set_timeout(tc, 60.0);
  tcase_add_loop_test(tc, volume_alone, 0, 9);
  tcase_add_test(tc, viscous_stress_stays);
  tcase_add_loop_test(tc, kernel, 0, 12);
  tcase_add_loop_test(tc, rigid_set, 0, 6);
  tcase_add_test(tc, rigid_set_and_remedy);
  tcase_add_loop_test(tc, same_bits, 0, 8);
  tcase_add_test(tc, refused_basis);
  suite_add_tcase(suite, tc);
  TCase *flow = tcase_create("flow");
  tcase_set_timeout(flow, 60.0);
  tcase_set_tags(flow, "long");
  tcase_add_loop_test(flow, starting_plate, 0, 2);
  tcase_add_loop_test(flow, column_at_rest, 0, 8);
  suite_add_tcase(suite, flow);
  return suite;
}
