/* mpm_grid_map(): what is lent, when, and that its fields fit together. */
#include "stepper_parts.h"

static body_desc numbered(int32_t i) {
  body_desc o = {.dim = 1 + i / PLAIN, .velocity_bc = i % 2, .method = *broad_methods[i % PLAIN]};
  return o;
}
enum { COMBINATIONS = 3 * PLAIN };

START_TEST(refused_requests) {
  world r;
  mpm_view v = {.struct_size = sizeof v}, small = {.struct_size = 8};
  body_open(&r, &(body_desc){.dim = 2});
#define REFUSED(status, text, ...) ck_refused(&r, mpm_grid_map(r.stepper, __VA_ARGS__), status, text)
  REFUSED(MPM_E_STATE, "no nodal fields", 0, "mass", MPM_READ, &v);
  world_steps(&r, 1);
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
  ck_ok(&r, mpm_step_begin(r.stepper, BODY_DT));
  static const char *const read_only[] = {"index", "position", "mass", "acceleration", "reaction"};
  for (int32_t i = 0; i < 5; ++i) {
    REFUSED(MPM_E_ARG, read_only[i], 0, read_only[i], MPM_WRITE, &v);
    REFUSED(MPM_E_ARG, "cannot be written", 0, read_only[i], MPM_READ | MPM_WRITE, &v);
  }
  ck_ok(&r, mpm_step_grid(r.stepper));
  REFUSED(MPM_E_STATE, "mpm_step_begin", 0, "force", MPM_WRITE, &v);
  ck_ok(&r, mpm_step_abort(r.stepper));
  REFUSED(MPM_E_STATE, "no nodal fields", 0, "mass", MPM_READ, &v);
#undef REFUSED
  ck_assert_ptr_null(v.data);
  world_close(&r);
}
END_TEST

/* Energies are summed up in the order of the blocks: when the host has added a particle and asks for them,
 * the particles are sorted, and the nodes of the last step are no more. */
START_TEST(nodes_end_with_their_layout) {
  world r;
  mpm_view v = {.struct_size = sizeof v};
  body_open(&r, &(body_desc){.dim = 2});
  world_steps(&r, 1);
  int64_t *ids = fetch_ids(&r, r.set[0]);
  double x[2];
  const double velocity[2] = {0.0, 0.0}, volume = 1e-4;
  for (int32_t k = 0; k < 2; ++k) x[k] = fetch1(&r, r.set[0], "position", 2, k, ids[0]);
  ck_ok(&r, mpm_particles_add(r.set[0], 1, x, velocity, &volume, NULL, NULL, NULL));
  ck_ok(&r, mpm_grid_map(r.stepper, 0, "mass", MPM_READ, &v));
  ck_ok(&r, mpm_view_release(&v));
  world_info(&r);
  ck_refused(&r, mpm_grid_map(r.stepper, 0, "mass", MPM_READ, &v), MPM_E_STATE, "no nodal fields");
  world_steps(&r, 1);
  ck_ok(&r, mpm_grid_map(r.stepper, 0, "mass", MPM_READ, &v));
  ck_ok(&r, mpm_view_release(&v));
  free(ids);
  world_close(&r);
}
END_TEST

/* Fused nodes of whole MLS steps have no force of their own. */
START_TEST(fused_nodes) {
  world r;
  mpm_view v = {.struct_size = sizeof v};
  body_open(&r, &(body_desc){.dim = 2, .method.transfer = MPM_APIC_MLS});
  world_steps(&r, 1);
  ck_refused(&r, mpm_grid_map(r.stepper, 0, "force", MPM_READ, &v), MPM_E_UNSUPPORTED, "staged step");
  ck_refused(&r, mpm_grid_map(r.stepper, 0, "acceleration", MPM_READ, &v), MPM_E_UNSUPPORTED, "staged step");
  ck_ok(&r, mpm_grid_map(r.stepper, 0, "reaction", MPM_READ, &v));
  ck_ok(&r, mpm_view_release(&v));
  world_close(&r);
}
END_TEST

START_TEST(lent_and_released) {
  world r;
  mpm_view v[9];
  body_open(&r, &(body_desc){.dim = 3});
  world_steps(&r, 1);
  static const char *const field[] = {"index", "position",     "mass",     "velocity",
                                      "force", "acceleration", "reaction", "mass"};
  for (int32_t i = 0; i < 8; ++i) {
    v[i] = (mpm_view){.struct_size = sizeof v[i]};
    ck_ok(&r, mpm_grid_map(r.stepper, 0, field[i], MPM_READ, &v[i]));
    ck_assert_uint_eq(v[i].struct_size, sizeof v[i]);
    ck_assert_int_eq(v[i].type, i == 0 ? MPM_I64 : MPM_F64);
    ck_assert_int_eq(v[i].components, i == 2 || i == 7 ? 1 : 3);
    ck_assert_int_eq(v[i].access, MPM_READ);
    ck_assert_int_eq(v[i].count, r.info.active_nodes);
    ck_assert_ptr_nonnull(v[i].owner);
  }
  v[8] = (mpm_view){.struct_size = sizeof v[8]};
  ck_refused(&r, mpm_grid_map(r.stepper, 0, "mass", MPM_READ, &v[8]), MPM_E_STATE, "8 views");
  mpm_view copy = v[3];
  ck_ok(&r, mpm_view_release(&v[3]));
  ck_assert_ptr_null(v[3].data);
  ck_assert_ptr_null(v[3].owner);
  ck_assert_int_eq(mpm_view_release(&v[3]), MPM_E_STATE);
  ck_assert_int_eq(mpm_view_release(&copy), MPM_E_STATE);
  ck_ok(&r, mpm_grid_map(r.stepper, 0, "velocity", MPM_READ, &v[3]));
  for (int32_t i = 0; i < 8; ++i) ck_ok(&r, mpm_view_release(&v[i]));
  world_steps(&r, 1);
  world_close(&r);
}
END_TEST

/* Values that are not finite are refused at release, and nothing is written. */
START_TEST(bad_values) {
  static const char *const field[] = {"velocity", "force"};
  world r, other;
  body_open(&r, &(body_desc){.dim = 2});
  body_open(&other, &(body_desc){.dim = 2});
  for (int32_t i = 0; i < 2; ++i) {
    mpm_view v = {.struct_size = sizeof v};
    ck_ok(&r, mpm_step_begin(r.stepper, BODY_DT));
    ck_ok(&r, mpm_grid_map(r.stepper, 0, field[i], MPM_WRITE, &v));
    for (int64_t k = 0; k < v.count; ++k) ((double *)v.data)[k] = k == 5 ? NOT_A_NUMBER : 1e5;
    ck_refused(&r, mpm_view_release(&v), MPM_E_ARG, "is nan at node");
    ck_assert_ptr_null(v.data);
    ck_ok(&r, mpm_step_grid(r.stepper));
    ck_ok(&r, mpm_step_end(r.stepper, NULL));
    world_steps(&other, 1);
    ck_assert(world_hash(&r) == world_hash(&other));
  }
  world_close(&r);
  world_close(&other);
}
END_TEST

/* Sums m v_c over all particles. */
static double particle_momentum(const world *r, int32_t c) {
  double sum = 0.0;
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r->set[m]);
    double *mass = fetch(r, r->set[m], "mass", 1), *v = fetch(r, r->set[m], "velocity", r->dim);
    sum += weighted_sum(n, mass, v + c * n);
    free(mass), free(v);
  }
  return sum;
}

static double particle_mass(const world *r) {
  return mass_of(r, r->set[0]) + mass_of(r, r->set[1]);
}

/* Index and position fit the grid; no node comes twice. inside: it is no ghost, nor next to a face. */
static void check_places(world *r, int64_t n, int32_t *inside) {
  const int32_t dim = r->dim;
  int64_t *at = fetch_node_indices(r, &n);
  double *x = fetch_nodes(r, "position", &n);
  for (int64_t i = 0; i < n; ++i) {
    inside[i] = 1;
    for (int32_t k = 0; k < dim; ++k) {
      const int64_t here = at[k * n + i];
      inside[i] &= here > 1 && here < body_cells[dim - 1][k] - 1;
      ck_within("position of a node", x[k * n + i], body_origin[k] + body_spacing[k] * (double)here, 1e-12);
      ck_holds(here >= (r->desc.grid.basis == MPM_LINEAR ? 0 : -1));
    }
    for (int64_t j = 0; j < i; ++j) {
      int32_t same = 1;
      for (int32_t k = 0; k < dim; ++k) same &= at[k * n + i] == at[k * n + j];
      ck_holds(!same);
    }
  }
  free(at), free(x);
}

/* Marks, on the linear basis, what may be a light node or lead one: these pass on forces. */
static void mark_leaders(world *r, int64_t n, const double *mass, int32_t *lead) {
  int64_t *at = fetch_node_indices(r, &n);
  for (int64_t i = 0; i < n; ++i) lead[i] = 0;
  for (int64_t i = 0; i < n && r->desc.grid.basis == MPM_LINEAR; ++i) {
    if (mass[i] > 0.1 * largest(n, mass)) continue;
    for (int64_t j = 0; j < n; ++j) {
      int32_t near = 1;
      for (int32_t k = 0; k < r->dim; ++k) near &= llabs(at[k * n + i] - at[k * n + j]) <= 2;
      lead[j] |= near;
    }
  }
  free(at);
}

START_TEST(fields_fit_together) {
  const body_desc o = numbered(_i);
  world r;
  int64_t n;
  body_open(&r, &o);
  world_steps(&r, 2);
  ck_ok(&r, mpm_step_begin(r.stepper, BODY_DT));
  double *mass = fetch_nodes(&r, "mass", &n), *before = fetch_nodes(&r, "velocity", &n);
  double *force = fetch_nodes(&r, "force", &n), *a = fetch_nodes(&r, "acceleration", &n);
  double *none = fetch_nodes(&r, "reaction", &n);
  const double all = particle_mass(&r);
  int32_t *inside = malloc((size_t)n * sizeof *inside);
  int32_t *lead = malloc((size_t)n * sizeof *lead);
  check_places(&r, n, inside);
  mark_leaders(&r, n, mass, lead);
  ck_within("mass", sum_of(n, mass), all, 1e-12 * all);
  const double largest_v = largest(n * o.dim, before), largest_f = largest(n * o.dim, force);
  for (int64_t i = 0; i < n; ++i) ck_holds(mass[i] > 0.0);
  for (int32_t c = 0; c < o.dim; ++c) {
    for (int64_t i = 0; i < n; ++i) {
      ck_within("m a", a[c * n + i] * mass[i], force[c * n + i], 1e-13 * fabs(force[c * n + i]));
      ck_holds(none[c * n + i] == 0.0);
    }
    ck_within("momentum", weighted_sum(n, mass, before + c * n), particle_momentum(&r, c),
              1e-12 * all * largest_v);
  }
  ck_ok(&r, mpm_step_grid(r.stepper));
  double *after = fetch_nodes(&r, "velocity", &n), *same = fetch_nodes(&r, "force", &n);
  double *total = fetch_nodes(&r, "acceleration", &n), *reaction = fetch_nodes(&r, "reaction", &n);
  double sum[3] = {0.0, 0.0, 0.0};
  for (int32_t c = 0; c < o.dim; ++c) {
    double passed[2] = {0.0, 0.0};
    for (int64_t i = 0; i < n; ++i) {
      const int64_t k = c * n + i;
      const double scale = largest_f + mass[i] * largest_v / BODY_DT;
      passed[0] += force[k], passed[1] += same[k];
      if (!lead[i]) ck_within("force after the update", same[k], force[k], 1e-10 * scale);
      sum[c] += reaction[k];
      if (!inside[i]) continue; /* at a wall nodes and ghosts move together */
      ck_within("m a = f + reaction", mass[i] * total[k], (lead[i] ? same : force)[k] + reaction[k],
                1e-10 * scale);
      if (!lead[i])
        ck_within("dv", after[k] - before[k], BODY_DT * total[k],
                  1e-11 * (fabs(after[k]) + fabs(before[k]) + largest_v));
    }
    ck_within("all forces after the update", passed[1], passed[0],
              1e-10 * (double)n * (largest_f + largest(n, mass) * largest_v / BODY_DT));
  }
  ck_ok(&r, mpm_step_end(r.stepper, NULL));
  double *last = fetch_nodes(&r, "velocity", &n); /* of the step that is done */
  ck_assert_int_eq(memcmp(last, after, (size_t)(n * o.dim) * sizeof *last), 0);
  if (!o.velocity_bc) /* else the callback takes its share */
    for (int32_t c = 0; c < o.dim; ++c) {
      double walls = 0.0, scale = 1.0, f[3];
      for (int32_t face = 0; face < 2 * o.dim; ++face) {
        ck_ok(&r, mpm_stepper_wall_reaction(r.stepper, face, f));
        walls += f[c];
        scale += fabs(f[c]);
      }
      ck_within("reactions", sum[c], walls, 1e-10 * scale);
    }
  double *const arrays[] = {mass, before, force, a, none, after, same, total, reaction, last};
  for (int32_t i = 0; i < 10; ++i) free(arrays[i]);
  free(inside), free(lead);
  world_close(&r);
}
END_TEST

/* On a periodic axis every node is shown once, where it is, with all of its mass. */
START_TEST(periodic_nodes) {
  body_desc o = {.dim = 1 + _i, .periodic = 1};
  world r;
  int64_t n, cells = o.dim == 1 ? 142 : o.dim == 2 ? 38 : 11;
  body_open(&r, &o);
  for (int32_t round = 0; round < 3; ++round) {
    world_steps(&r, 4);
    double *mass = fetch_nodes(&r, "mass", &n), *x = fetch_nodes(&r, "position", &n);
    const double all = particle_mass(&r);
    ck_within("mass", sum_of(n, mass), all, 1e-12 * all);
    for (int64_t i = 0; i < n; ++i)
      ck_assert_msg(x[i] >= -0.3 - 0.11 && x[i] <= -0.3 + 0.1 * (double)cells + 0.11,
                    "a node at %g is outside the period of %lld cells from -0.3", x[i], (long long)cells);
    free(mass);
    free(x);
  }
  world_close(&r);
}
END_TEST

/* One part owns all its nodes. */
START_TEST(owned_nodes) {
  world r;
  mpm_view v = {.struct_size = sizeof v};
  body_open(&r, &(body_desc){.dim = 2, .periodic = _i});
  world_steps(&r, 1);
  ck_ok(&r, mpm_grid_map(r.stepper, 0, "owned", MPM_READ, &v));
  ck_assert(v.type == MPM_U8 && v.components == 1 && v.count == r.info.active_nodes);
  for (int64_t i = 0; i < v.count; ++i) ck_holds(((const uint8_t *)v.data)[i] == 1);
  ck_ok(&r, mpm_view_release(&v));
  ck_refused(&r, mpm_grid_map(r.stepper, 0, "owned", MPM_WRITE, &v), MPM_E_ARG, "cannot be written");
  world_close(&r);
}
END_TEST

TCase *stepper_nodes_case(void) {
  TCase *tests = tcase_create("nodes");
  tcase_set_timeout(tests, 120);
  tcase_add_test(tests, refused_requests);
  tcase_add_test(tests, nodes_end_with_their_layout);
  tcase_add_test(tests, fused_nodes);
  tcase_add_test(tests, lent_and_released);
  tcase_add_test(tests, bad_values);
  tcase_add_loop_test(tests, fields_fit_together, 0, COMBINATIONS);
  tcase_add_loop_test(tests, periodic_nodes, 0, 3);
  tcase_add_loop_test(tests, owned_nodes, 0, 2);
  return tests;
}
