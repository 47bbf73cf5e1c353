/* mpm_grid_map(): what is lent, when, and that its fields fit together. */
#include "stepper_parts.h"

static run_options numbered(int32_t i) {
  run_options o = {.dim = 1 + i / RUN_METHODS, .velocity_bc = i % 2};
  run_use(&o, &run_methods[i % RUN_METHODS]);
  return o;
}
enum { COMBINATIONS = 3 * RUN_METHODS };

START_TEST(refused_requests) {
  run r;
  mpm_view v = {.struct_size = sizeof v}, small = {.struct_size = 8};
  run_open(&r, &(run_options){.dim = 2});
#define REFUSED(status, text, ...) run_refused(&r, mpm_grid_map(r.stepper, __VA_ARGS__), status, text)
  REFUSED(MPM_E_STATE, "no nodal fields", 0, "mass", MPM_READ, &v);
  run_steps(&r, 1);
  REFUSED(MPM_E_ARG, "field is NULL", 0, NULL, MPM_READ, &v);
  REFUSED(MPM_E_ARG, "view is NULL", 0, "mass", MPM_READ, NULL);
  REFUSED(MPM_E_ARG, "struct_size is 8", 0, "mass", MPM_READ, &small);
  REFUSED(MPM_E_NOT_FOUND, "body is 1", 1, "mass", MPM_READ, &v);
  REFUSED(MPM_E_NOT_FOUND, "body is -1", -1, "mass", MPM_READ, &v);
  REFUSED(MPM_E_NOT_FOUND, "velocity", 0, "velocty", MPM_READ, &v);
  REFUSED(MPM_E_NOT_FOUND, "\"stress\"", 0, "stress", MPM_READ, &v);
  REFUSED(MPM_E_ARG, "access is 0", 0, "mass", 0, &v);
  REFUSED(MPM_E_ARG, "access is 4", 0, "mass", 4, &v);
  REFUSED(MPM_E_STATE, "staged step", 0, "velocity", MPM_WRITE, &v);
  REFUSED(MPM_E_STATE, "mpm_step_begin", 0, "force", MPM_READ | MPM_WRITE, &v);
  run_ok(&r, mpm_step_begin(r.stepper, RUN_DT));
  static const char *const read_only[] = {"index", "position", "mass", "acceleration", "reaction"};
  for (int32_t i = 0; i < 5; ++i) {
    REFUSED(MPM_E_ARG, read_only[i], 0, read_only[i], MPM_WRITE, &v);
    REFUSED(MPM_E_ARG, "cannot be written", 0, read_only[i], MPM_READ | MPM_WRITE, &v);
  }
  run_ok(&r, mpm_step_grid(r.stepper));
  REFUSED(MPM_E_STATE, "mpm_step_begin", 0, "force", MPM_WRITE, &v);
  run_ok(&r, mpm_step_abort(r.stepper));
  REFUSED(MPM_E_STATE, "no nodal fields", 0, "mass", MPM_READ, &v);
#undef REFUSED
  ck_assert_ptr_null(v.data);
  run_close(&r);
}
END_TEST

/* Fused nodes of whole MLS steps have no force of their own. */
START_TEST(fused_nodes) {
  run r;
  mpm_view v = {.struct_size = sizeof v};
  run_open(&r, &(run_options){.dim = 2, .transfer = MPM_APIC_MLS});
  run_steps(&r, 1);
  run_refused(&r, mpm_grid_map(r.stepper, 0, "force", MPM_READ, &v), MPM_E_UNSUPPORTED, "staged step");
  run_refused(&r, mpm_grid_map(r.stepper, 0, "acceleration", MPM_READ, &v), MPM_E_UNSUPPORTED, "staged step");
  run_ok(&r, mpm_grid_map(r.stepper, 0, "reaction", MPM_READ, &v));
  run_ok(&r, mpm_view_release(&v));
  run_close(&r);
}
END_TEST

START_TEST(lent_and_released) {
  run r;
  mpm_view v[9];
  run_open(&r, &(run_options){.dim = 3});
  run_steps(&r, 1);
  static const char *const field[] = {"index", "position",     "mass",     "velocity",
                                      "force", "acceleration", "reaction", "mass"};
  for (int32_t i = 0; i < 8; ++i) {
    v[i] = (mpm_view){.struct_size = sizeof v[i]};
    run_ok(&r, mpm_grid_map(r.stepper, 0, field[i], MPM_READ, &v[i]));
    ck_assert_uint_eq(v[i].struct_size, sizeof v[i]);
    ck_assert_int_eq(v[i].type, i == 0 ? MPM_I64 : MPM_F64);
    ck_assert_int_eq(v[i].components, i == 2 || i == 7 ? 1 : 3);
    ck_assert_int_eq(v[i].access, MPM_READ);
    ck_assert_int_eq(v[i].count, r.info.active_nodes);
    ck_assert_ptr_nonnull(v[i].owner);
  }
  v[8] = (mpm_view){.struct_size = sizeof v[8]};
  run_refused(&r, mpm_grid_map(r.stepper, 0, "mass", MPM_READ, &v[8]), MPM_E_STATE, "8 views");
  mpm_view copy = v[3];
  run_ok(&r, mpm_view_release(&v[3]));
  ck_assert_ptr_null(v[3].data);
  ck_assert_ptr_null(v[3].owner);
  ck_assert_int_eq(mpm_view_release(&v[3]), MPM_E_STATE);
  ck_assert_int_eq(mpm_view_release(&copy), MPM_E_STATE);
  run_ok(&r, mpm_grid_map(r.stepper, 0, "velocity", MPM_READ, &v[3]));
  for (int32_t i = 0; i < 8; ++i) run_ok(&r, mpm_view_release(&v[i]));
  run_steps(&r, 1);
  run_close(&r);
}
END_TEST

/* Values that are not finite are refused at release, and nothing is written. */
START_TEST(bad_values) {
  static const char *const field[] = {"velocity", "force"};
  run r, other;
  run_open(&r, &(run_options){.dim = 2});
  run_open(&other, &(run_options){.dim = 2});
  for (int32_t i = 0; i < 2; ++i) {
    mpm_view v = {.struct_size = sizeof v};
    run_ok(&r, mpm_step_begin(r.stepper, RUN_DT));
    run_ok(&r, mpm_grid_map(r.stepper, 0, field[i], MPM_WRITE, &v));
    for (int64_t k = 0; k < v.count; ++k) ((double *)v.data)[k] = k == 5 ? RUN_NAN : 1e5;
    run_refused(&r, mpm_view_release(&v), MPM_E_ARG, "is nan at node");
    ck_assert_ptr_null(v.data);
    run_ok(&r, mpm_step_grid(r.stepper));
    run_ok(&r, mpm_step_end(r.stepper, NULL));
    run_steps(&other, 1);
    ck_assert(run_hash(&r) == run_hash(&other));
  }
  run_close(&r);
  run_close(&other);
}
END_TEST

static double sum_of(const double *value, int64_t n) {
  double sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += value[i];
  return sum;
}

/* sum m, or sum m v_c where v is not NULL */
static double particle_sum(const run *r, int32_t c, int32_t with_velocity) {
  double sum = 0.0;
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r->set[m]);
    double *mass = run_get(r, m, "mass", 1), *v = run_get(r, m, "velocity", r->options.dim);
    for (int64_t i = 0; i < n; ++i) sum += mass[i] * (with_velocity ? v[c * n + i] : 1.0);
    free(mass);
    free(v);
  }
  return sum;
}

/* Index and position fit the grid; no node comes twice. inside: it is no ghost, nor next to a face. */
static void check_places(run *r, int64_t n, int32_t *inside) {
  const int32_t dim = r->options.dim;
  static const double spacing[3] = {0.1, 0.11, 0.09}, origin[3] = {-0.3, 0.2, 0.1};
  static const int64_t cells[3][3] = {{142}, {38, 18}, {11, 11, 7}};
  mpm_view index = {.struct_size = sizeof index};
  run_ok(r, mpm_grid_map(r->stepper, 0, "index", MPM_READ, &index));
  const int64_t *at = index.data;
  double *x = run_nodes(r, "position", dim, &n);
  for (int64_t i = 0; i < n; ++i) {
    inside[i] = 1;
    for (int32_t k = 0; k < dim; ++k) {
      const int64_t here = at[k * index.component_stride + i];
      inside[i] &= here > 1 && here < cells[dim - 1][k] - 1;
      parts_close(x[k * n + i], origin[k] + spacing[k] * (double)here, 1e-12, "position of a node");
      parts_holds(here >= (r->options.basis == MPM_LINEAR ? 0 : -1));
    }
    for (int64_t j = 0; j < i; ++j) {
      int32_t same = 1;
      for (int32_t k = 0; k < dim; ++k)
        same &= at[k * index.component_stride + i] == at[k * index.component_stride + j];
      parts_holds(!same);
    }
  }
  free(x);
  run_ok(r, mpm_view_release(&index));
}

START_TEST(fields_fit_together) {
  const run_options o = numbered(_i);
  run r;
  int64_t n;
  run_open(&r, &o);
  run_steps(&r, 2);
  run_ok(&r, mpm_step_begin(r.stepper, RUN_DT));
  double *mass = run_nodes(&r, "mass", 1, &n), *before = run_nodes(&r, "velocity", o.dim, &n);
  double *force = run_nodes(&r, "force", o.dim, &n), *a = run_nodes(&r, "acceleration", o.dim, &n);
  double *none = run_nodes(&r, "reaction", o.dim, &n);
  const double all = particle_sum(&r, 0, 0);
  int32_t *inside = malloc((size_t)n * sizeof *inside);
  check_places(&r, n, inside);
  parts_close(sum_of(mass, n), all, 1e-12 * all, "mass");
  double lightest = 1e300, largest_v = 0.0, largest_f = 0.0;
  for (int64_t i = 0; i < n; ++i) lightest = fmin(lightest, mass[i]);
  ck_assert_double_gt(lightest, 0.0);
  for (int32_t c = 0; c < o.dim; ++c) {
    double momentum = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      momentum += mass[i] * before[c * n + i];
      parts_close(a[c * n + i] * mass[i], force[c * n + i], 1e-13 * fabs(force[c * n + i]), "m a");
      parts_holds(none[c * n + i] == 0.0);
      largest_v = fmax(largest_v, fabs(before[c * n + i]));
      largest_f = fmax(largest_f, fabs(force[c * n + i]));
    }
    parts_close(momentum, particle_sum(&r, c, 1), 1e-12 * all * largest_v, "momentum");
  }
  run_ok(&r, mpm_step_grid(r.stepper));
  double *after = run_nodes(&r, "velocity", o.dim, &n), *same = run_nodes(&r, "force", o.dim, &n);
  double *total = run_nodes(&r, "acceleration", o.dim, &n), *reaction = run_nodes(&r, "reaction", o.dim, &n);
  double booked[3] = {0.0, 0.0, 0.0};
  for (int32_t c = 0; c < o.dim; ++c)
    for (int64_t i = 0; i < n; ++i) {
      const int64_t k = c * n + i;
      const double scale = largest_f + mass[i] * largest_v / RUN_DT;
      parts_close(same[k], force[k], 1e-10 * scale, "force after the update");
      booked[c] += reaction[k];
      if (!inside[i]) continue; /* at a wall nodes and ghosts move together */
      parts_close(mass[i] * total[k], force[k] + reaction[k], 1e-10 * scale, "m a = f + reaction");
      parts_close(after[k] - before[k], RUN_DT * total[k],
                  1e-11 * (fabs(after[k]) + fabs(before[k]) + largest_v), "dv");
    }
  run_ok(&r, mpm_step_end(r.stepper, NULL));
  double *last = run_nodes(&r, "velocity", o.dim, &n); /* of the step that is done */
  ck_assert_int_eq(memcmp(last, after, (size_t)(n * o.dim) * sizeof *last), 0);
  if (!o.velocity_bc) /* else the callback takes its share */
    for (int32_t c = 0; c < o.dim; ++c) {
      double walls = 0.0, scale = 1.0, f[3];
      for (int32_t face = 0; face < 2 * o.dim; ++face) {
        run_ok(&r, mpm_stepper_wall_reaction(r.stepper, face, f));
        walls += f[c];
        scale += fabs(f[c]);
      }
      parts_close(booked[c], walls, 1e-10 * scale, "reactions");
    }
  double *const arrays[] = {mass, before, force, a, none, after, same, total, reaction, last};
  for (int32_t i = 0; i < 10; ++i) free(arrays[i]);
  free(inside);
  run_close(&r);
}
END_TEST

/* On a periodic axis every node is shown once, where it is, with all of its mass. */
START_TEST(periodic_nodes) {
  run_options o = {.dim = 1 + _i, .periodic = 1};
  run r;
  int64_t n, cells = o.dim == 1 ? 142 : o.dim == 2 ? 38 : 11;
  run_open(&r, &o);
  for (int32_t round = 0; round < 3; ++round) {
    run_steps(&r, 4);
    double *mass = run_nodes(&r, "mass", 1, &n), *x = run_nodes(&r, "position", o.dim, &n);
    const double all = particle_sum(&r, 0, 0);
    parts_close(sum_of(mass, n), all, 1e-12 * all, "mass");
    for (int64_t i = 0; i < n; ++i)
      ck_assert_msg(x[i] >= -0.3 - 0.11 && x[i] <= -0.3 + 0.1 * (double)cells + 0.11,
                    "a node at %g is outside the period of %lld cells from -0.3", x[i], (long long)cells);
    free(mass);
    free(x);
  }
  run_close(&r);
}
END_TEST

TCase *stepper_nodes_case(void) {
  TCase *tests = tcase_create("nodes");
  tcase_set_timeout(tests, 120);
  tcase_add_test(tests, refused_requests);
  tcase_add_test(tests, fused_nodes);
  tcase_add_test(tests, lent_and_released);
  tcase_add_test(tests, bad_values);
  tcase_add_loop_test(tests, fields_fit_together, 0, COMBINATIONS);
  tcase_add_loop_test(tests, periodic_nodes, 0, 3);
  return tests;
}
