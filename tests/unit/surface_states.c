/* Surfaces: splitting, bodies, steps that fail, states, and what is refused. */
#include "surfaces.h"

/* ---- splitting ----------------------------------------------------------------------------------------- */
/* Sums that splitting keeps: of areas, and of areas times positions. */
static void moments_of(const mpm_surface *s, int32_t dim, double *sum) {
  const int64_t n = mpm_surface_count(s);
  double *x = markers(s, "position", dim), *a = markers(s, "area", dim), *A = markers(s, "reference_area", 1);
  for (int32_t k = 0; k < 16; ++k) sum[k] = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    sum[0] += A[i];
    for (int32_t k = 0; k < dim; ++k) {
      sum[1 + k] += a[k * n + i];
      for (int32_t c = 0; c < dim; ++c) sum[4 + 3 * k + c] += a[k * n + i] * x[c * n + i];
    }
  }
  free(x), free(a), free(A);
}

START_TEST(splitting_keeps_area_and_moment) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w;
    open_block(&w, &methods[0], dim);
    mpm_surface *s = put_surface(&w, NULL);
    add_closed(&w, s, 0.62);
    const double square[] = {1.1, 1.2, 1.3}, area[] = {0.3, -0.4, 0.1};
    ck_ok(&w, mpm_surface_add(s, 1, square, area, NULL));
    const int64_t before = mpm_surface_count(s), last = before - 1;
    const double own = 7.0;
    ck_ok(&w, mpm_surface_set(s, "pressure", MPM_F64, 1, 1, &last, &own));
    double was[16], is[16], p;
    moments_of(s, dim, was);
    int64_t added = -1;
    ck_ok(&w, mpm_surface_refine(s, 0.04, &added));
    moments_of(s, dim, is);
    ck_assert_int_eq(mpm_surface_count(s), before + added);
    ck_assert(dim == 1 ? added == 0 : added > before);
    for (int32_t k = 0; k < 16; ++k) ck_within("moment", is[k], was[k], 1e-12);
    const int64_t child = before + added - 1; /* of the last one */
    ck_ok(&w, mpm_surface_get(s, "pressure", MPM_F64, 1, 1, &child, &p));
    ck_holds(p == own);
    ck_ok(&w, mpm_surface_refine(s, 0.04, &added)); /* all are short now */
    ck_assert_int_eq(added, 0);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* Halves of a marker whose edge reaches beyond a face are put back onto it, with all of the area. */
START_TEST(halves_stay_in_the_grid) {
  for (int32_t dim = 2; dim <= 3; ++dim) {
    world w;
    open_block(&w, &methods[0], dim);
    const mpm_grid_desc *grid = &w.desc.grid;
    mpm_surface *s = put_surface(&w, NULL);
    const double low = grid->origin[0], high = low + (double)grid->cells[0] * grid->spacing[0],
                 beside = 0.1 * grid->spacing[0];
    const double x[] = {low + beside, high - beside, 1.1, 1.1, 1.2, 1.2}, area[] = {0, 0, 1, 1, 0, 0};
    int64_t added = 0;
    ck_ok(&w, mpm_surface_add(s, 2, x, area, NULL));
    ck_ok(&w, mpm_surface_refine(s, 0.3, &added));
    ck_assert_int_ge(added, 2);
    const int64_t n = mpm_surface_count(s);
    double *at = markers(s, "position", dim), *A = markers(s, "reference_area", 1), sum = 0.0;
    int32_t on_faces = 0;
    for (int64_t i = 0; i < n; ++i) {
      ck_assert(at[i] >= low && at[i] <= high);
      on_faces |= at[i] <= low ? 1 : at[i] >= high ? 2 : 0;
      sum += A[i];
    }
    ck_assert_int_eq(on_faces, 3);
    ck_within("area", sum, 2.0, 1e-12);
    free(at), free(A);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* With max_spacing markers are split as the material stretches. */
START_TEST(stretched_markers_are_split) {
  for (int32_t dim = 2; dim <= 3; ++dim) {
    world w;
    open_block(&w, &methods[0], dim);
    mpm_surface_desc d = load_desc();
    d.max_spacing = dim == 2 ? 0.07 : 0.09;
    mpm_surface *s = put_surface(&w, &d);
    add_closed(&w, s, 0.45);
    step_with(&w, 1e-6, away); /* triangles have edges of up to 0.3 */
    const int64_t before = mpm_surface_count(s);
    for (int32_t i = 0; i < 4; ++i) step_with(&w, 0.1, away);
    ck_assert_msg(mpm_surface_count(s) > before, "%d-D: %lld", (int)dim, (long long)before);
    double sum[16], volume = 0.0;
    moments_of(s, dim, sum);
    for (int32_t k = 0; k < dim; ++k) volume += sum[4 + 4 * k] / dim;
    const double wanted = dim == 2 ? area_of_circle(0.45) : 4.0 / 3.0 * pow(0.45, 3.0);
    ck_within("volume", volume, wanted * pow(1.1, 4.0 * dim), 1e-4 * wanted);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* ---- bodies, failures, states -------------------------------------------------------------------------- */
/* A surface loads the body that it belongs to, though another one lies at the same place. */
START_TEST(one_of_two_bodies) {
  for (int32_t body = 0; body < 2; ++body) {
    world w;
    open_block(&w, &methods[0], 2);
    mpm_contact_desc rule;
    ck_ok(&w, mpm_contact_desc_init(&rule, sizeof rule));
    rule.kind = MPM_CONTACT_NONE;
    mpm_particles *other = world_add_set(&w, NULL);
    const double low[] = {0.9, 0.9}, high[] = {2.1, 2.1};
    world_fill(&w, other, low, high, 2);
    ck_ok(&w, mpm_stepper_set_body(w.stepper, other, 1));
    ck_ok(&w, mpm_stepper_set_contact(w.stepper, MPM_BODY_ANY, MPM_BODY_ANY, &rule));
    mpm_surface_desc d = load_desc();
    d.body = body;
    d.traction[0] = 100.0;
    mpm_surface *s = put_surface(&w, &d);
    add_circle(&w, s, 0.3, 0.1);
    world_step(&w, 1e-3);
    for (int32_t m = 0; m < 2; ++m) {
      double *v = fetch(&w, w.set[m], "velocity", 2);
      ck_assert((largest(mpm_particles_count(w.set[m]), v) > 0.0) == (m == body));
      free(v);
    }
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

static void same_markers(const mpm_surface *s, const mpmi_markers *was) {
  ck_assert_int_eq(s->now.count, was->count);
  ck_assert_int_eq(s->now.next_id, was->next_id);
  ck_assert(memcmp(s->now.at, was->at, (size_t)was->count * sizeof *was->at) == 0);
}

static mpmi_markers copy_of(const mpm_surface *s) {
  mpmi_markers copy = s->now;
  copy.at = malloc((size_t)copy.count * sizeof *copy.at);
  memcpy(copy.at, s->now.at, (size_t)copy.count * sizeof *copy.at);
  return copy;
}

START_TEST(failures_leave_no_trace) {
  world w;
  open_block(&w, &methods[0], 2);
  mpm_surface_desc d = load_desc();
  d.pressure = 1000.0;
  d.max_spacing = 0.08;
  mpm_surface *s = put_surface(&w, &d);
  add_circle(&w, s, 0.62, 0.1);
  world_step(&w, 1e-3);
  const mpmi_markers was = copy_of(s);
  world_bits bits = world_take(&w);
  water of = {3.0, 10.0, 0, 0.0, 0.0};
  ck_ok(&w, mpm_surface_set_traction(s, push_by_depth, &of));
  mpm_step_info info = {.struct_size = sizeof info};
  of.answer = -3;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_E_CALLBACK, "of surface 0 returned -3");
  ck_assert_int_eq(info.callback_status, -3);
  of.answer = 2;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_CUT_DT, "returned 2");
  of.answer = 0;
  of.weight = NOT_A_NUMBER;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_NONFINITE, "has a load that is not finite");
  of.weight = 10.0;
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-3));
  ck_refused(&w, mpm_surface_configure(s, &d), MPM_E_STATE, "staged step");
  ck_refused(&w, mpm_surface_refine(s, 0.1, NULL), MPM_E_STATE, "staged step");
  ck_refused(&w, mpm_surface_set(s, "pressure", MPM_F64, 1, 0, NULL, NULL), MPM_E_STATE, "staged step");
  ck_ok(&w, mpm_step_grid(w.stepper));
  ck_ok(&w, mpm_step_abort(w.stepper));
  same_markers(s, &was);
  world_same(&w, &bits, "particles");
  const double far[2] = {0.1, 0.1}, area[2] = {1.0, 0.0};
  int64_t lost;
  ck_ok(&w, mpm_surface_add(s, 1, far, area, &lost));
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_E_STATE, "no material around it");
  ck_ok(&w, mpm_surface_remove(s, 1, &lost));
  ck_ok(&w, mpm_step(w.stepper, 1e-3, &info));
  free(was.at);
  bits_drop(&bits);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

static mpm_surface *loaded_world(world *w, int32_t concurrency, int32_t scatter) {
  world_desc desc = world_with(&methods[0], 3, CELLS, spacing);
  desc.context.concurrency = concurrency;
  desc.random_order = scatter;
  open_block_with(w, &desc);
  mpm_surface_desc d = load_desc();
  d.pressure = 20000.0;
  d.traction[1] = 3000.0;
  d.max_spacing = 0.1;
  mpm_surface *s = put_surface(w, &d);
  add_closed(w, s, 0.62);
  return s;
}

START_TEST(threads_change_no_bit) {
  uint64_t wanted = 0;
  for (int32_t k = 0; k < 3; ++k) {
    world w;
    mpm_surface *s = loaded_world(&w, k == 0 ? 1 : k + 1, k == 2);
    for (int32_t i = 0; i < 10; ++i) world_step(&w, 1e-3);
    if (!k) wanted = world_hash(&w);
    ck_holds(world_hash(&w) == wanted);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

START_TEST(states_hold_markers) {
  world a, b;
  mpm_surface *s = loaded_world(&a, 1, 0), *t = loaded_world(&b, 1, 0);
  for (int32_t i = 0; i < 4; ++i) world_step(&a, 1e-3);
  const double own[1] = {3.0};
  const int64_t three = 3;
  ck_ok(&a, mpm_surface_set(s, "pressure", MPM_F64, 1, 1, &three, own));
  ck_assert(mpm_surface_count(s) > mpm_surface_count(t));
  saved_state state = world_save(&a);
  world_load(&b, &state);
  const mpmi_markers was = copy_of(s);
  same_markers(t, &was);
  free(was.at);
  for (int32_t i = 0; i < 4; ++i) {
    world_step(&a, 1e-3);
    world_step(&b, 1e-3);
    ck_holds(world_hash(&a) == world_hash(&b));
  }
  /* whatever is cut or spoiled is refused, and changes nothing */
  const mpmi_markers kept = copy_of(t);
  const uint64_t hash = world_hash(&b);
  ck_ok(&b, mpm_stepper_remove_surface(b.stepper, t));
  ck_refused(&b, mpm_state_load(b.stepper, state.data, state.bytes), MPM_E_FORMAT,
             "number of surfaces is 1 there, 0 here");
  ck_ok(&b, mpm_stepper_add_surface(b.stepper, t));
  mpm_surface_desc d = load_desc();
  d.body = 3;
  ck_ok(&b, mpm_surface_configure(t, &d));
  ck_refused(&b, mpm_state_load(b.stepper, state.data, state.bytes), MPM_E_FORMAT, "body is 0 there, 3 here");
  same_markers(t, &kept);
  ck_holds(world_hash(&b) == hash);
  free(kept.at);
  free(state.data);
  drop_surface(&a, s);
  drop_surface(&b, t);
  world_close(&a);
  world_close(&b);
}
END_TEST

static mpm_status load_and_refine(world *w, mpm_surface **s, int32_t done) {
  static water of = {3.0, 10.0, 0, 0.0, 0.0};
  static const double corner[8] = {1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 2.0, 2.0};
  const int64_t zero = 0;
  mpm_surface_desc d = load_desc();
  d.pressure = 2e4;
  d.max_spacing = 0.05;
  switch (done) {
  case 0:
    return mpm_surface_create(w->context, w->grid, &d, s);
  case 1:
    return mpm_stepper_add_surface(w->stepper, *s);
  case 2:
    return mpm_surface_add_polyline(*s, 4, corner, 1, 0.2, NULL, NULL);
  case 3:
    return mpm_surface_set_traction(*s, push_by_depth, &of);
  case 5:
    return mpm_surface_refine(*s, 0.03, NULL);
  case 6:
    return mpm_surface_remove(*s, 1, &zero);
  default:
    return mpm_step(w->stepper, 2e-3, NULL);
  }
}

START_TEST(every_allocation_fails_once) {
  fail_every_allocation(&methods[0], 8, load_and_refine);
}
END_TEST

/* ---- what is refused ----------------------------------------------------------------------------------- */
START_TEST(refusals) {
  world w, flat;
  open_block(&w, &methods[0], 3);
  open_block(&flat, &methods[0], 2);
  mpm_surface *s = NULL, *second;
  mpm_surface_desc d = load_desc();
  d.body = -1;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "body is -1");
  ck_holds(!s);
  d = load_desc();
  d.pressure = NOT_A_NUMBER;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "pressure is");
  d = load_desc();
  d.max_spacing = -1.0;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "max_spacing is -1");
  d = load_desc();
  d.dead_traction[1] = INFINITE;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "dead_traction[1] is inf");
  ck_refused(&w, mpm_surface_create(w.context, flat.grid, NULL, &s), MPM_E_ARG, "another context");
  ck_refused(&w, mpm_surface_create(w.context, w.grid, NULL, NULL), MPM_E_ARG, "out is NULL");
  s = put_surface(&w, NULL);
  ck_refused(&w, mpm_stepper_add_surface(w.stepper, s), MPM_E_STATE, "already belongs to this stepper");
  ck_refused(&w, mpm_surface_destroy(s), MPM_E_STATE, "mpm_stepper_remove_surface() first");
  const double in[3] = {1.0, 1.0, 1.0}, out[3] = {1.0, 4.0, 1.0}, bad[3] = {0.0, NOT_A_NUMBER, 0.0};
  const double huge[3] = {1e300, 1e300, 1e300};
  ck_refused(&w, mpm_surface_add(s, 1, out, NULL, NULL), MPM_E_ARG, "marker 0: position[1] is 4");
  ck_refused(&w, mpm_surface_add(s, 1, in, bad, NULL), MPM_E_ARG, "marker 0: area[1] is");
  ck_refused(&w, mpm_surface_add(s, 1, in, huge, NULL), MPM_E_ARG, "beyond the range");
  ck_refused(&w, mpm_surface_add(s, -1, in, NULL, NULL), MPM_E_ARG, "n is -1");
  ck_refused(&w, mpm_surface_add(s, 1, NULL, NULL, NULL), MPM_E_ARG, "position is NULL");
  ck_refused(&w, mpm_surface_add(s, INT64_MAX, in, NULL, NULL), MPM_E_ARG, "at most 268435456");
  ck_refused(&w, mpm_surface_add_polyline(s, 1, in, 0, 1.0, NULL, NULL), MPM_E_UNSUPPORTED,
             "mpm_surface_add_triangles()");
  ck_assert_int_eq(mpm_surface_count(s), 0);
  const double corners[9] = {1.0, 2.0, 1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0};
  const int64_t wrong[3] = {0, 1, 3}, right[3] = {0, 1, 2};
  ck_refused(&w, mpm_surface_add_triangles(s, 3, corners, 1, wrong, 0.1, NULL, NULL), MPM_E_ARG,
             "triangle 0: corner 3 does not exist");
  ck_refused(&w, mpm_surface_add_triangles(s, 3, corners, 1, right, 0.0, NULL, NULL), MPM_E_ARG,
             "spacing is 0");
  ck_refused(&w, mpm_surface_add_triangles(s, 3, corners, 1, right, 1e-9, NULL, NULL), MPM_E_ARG,
             "into more than");
  int64_t first = -1, count = -1;
  ck_ok(&w, mpm_surface_add_triangles(s, 3, corners, 1, right, 0.5, &first, &count));
  ck_holds(first == 0 && count == 9 && mpm_surface_count(s) == 9);
  for (int64_t n = INT64_MAX; n > 1 << 28; n /= 2) {
    ck_refused(&w, mpm_surface_add(s, n, in, NULL, NULL), MPM_E_ARG, "at most 268435456");
    ck_refused(&w, mpm_surface_add_triangles(s, n, corners, 1, right, 0.5, NULL, NULL), MPM_E_ARG, "n is");
    ck_refused(&w, mpm_surface_add_triangles(s, 3, corners, n, right, 0.5, NULL, NULL), MPM_E_ARG,
               "triangles is");
  }
  ck_refused(&w, mpm_surface_add(s, (1 << 28) - 8, in, NULL, NULL), MPM_E_ARG, "more markers are too many");
  double v[3];
  int64_t ids[2] = {4, 4}, got[9];
  ck_ok(&w, mpm_surface_get(s, "id", MPM_I64, 1, 9, NULL, got));
  ck_holds(got[0] == 0 && got[8] == 8);
  ck_refused(&w, mpm_surface_get(s, "stress", MPM_F64, 1, 1, ids, v), MPM_E_NOT_FOUND, "no field");
  ck_refused(&w, mpm_surface_get(s, "area", MPM_F64, 2, 1, ids, v), MPM_E_ARG, "with 3 components");
  ck_refused(&w, mpm_surface_get(s, "area", MPM_F64, 3, 1, NULL, v), MPM_E_ARG, "has 9 markers");
  ck_refused(&w, mpm_surface_set(s, "velocity", MPM_F64, 3, 1, ids, in), MPM_E_ARG, "cannot be set");
  ck_refused(&w, mpm_surface_set(s, "position", MPM_F64, 3, 1, ids, out), MPM_E_ARG, "position[1] is 4");
  ck_refused(&w, mpm_surface_set(s, "traction", MPM_F64, 3, 1, ids, bad), MPM_E_ARG, "traction[1] is");
  ck_refused(&w, mpm_surface_remove(s, 2, ids), MPM_E_ARG, "given twice");
  ids[1] = 99;
  ck_refused(&w, mpm_surface_remove(s, 2, ids), MPM_E_NOT_FOUND, "id 99");
  ck_refused(&w, mpm_surface_refine(s, NOT_A_NUMBER, NULL), MPM_E_ARG, "spacing is");
  ck_refused(&w, mpm_surface_refine(s, 1e-12, NULL), MPM_E_ARG, "a spacing of 1e-12 makes more than");
  ck_assert_int_eq(mpm_surface_count(s), 9);
  ck_ok(&flat, mpm_surface_create(flat.context, flat.grid, NULL, &second));
  ck_refused(&flat, mpm_surface_add_triangles(second, 3, corners, 1, right, 0.5, NULL, NULL),
             MPM_E_UNSUPPORTED, "mpm_surface_add_polyline()");
  ck_refused(&flat, mpm_surface_add_polyline(second, 2, corners, 2, 0.5, NULL, NULL), MPM_E_ARG,
             "closed is 2");
  for (int32_t n = 1; n <= 2; ++n)
    ck_refused(&flat, mpm_surface_add_polyline(second, n, corners, 1, 0.5, NULL, NULL), MPM_E_ARG,
               "has no inside: give closed = 0 or at least three points");
  ck_refused(&flat, mpm_surface_add_polyline(second, INT64_MAX, corners, 0, 0.5, NULL, NULL), MPM_E_ARG,
             "n is 9223372036854775807");
  ck_assert_int_eq(mpm_surface_count(second), 0);
  ck_ok(&flat, mpm_surface_add_polyline(second, 0, NULL, 1, 0.5, &first, &count));
  ck_assert_int_eq(count, 0);
  ck_ok(&flat, mpm_surface_add_polyline(second, 3, corners, 1, 0.5, &first, &count));
  ck_assert_int_eq(count, 7);
  ck_refused(&w, mpm_stepper_add_surface(w.stepper, second), MPM_E_ARG, "another context");
  ck_refused(&flat, mpm_stepper_remove_surface(flat.stepper, second), MPM_E_NOT_FOUND, "not in this stepper");
  ck_ok(&flat, mpm_surface_destroy(second));
  ck_ok(&w, mpm_surface_destroy(NULL));
  drop_surface(&w, s);
  world_close(&flat);
  world_close(&w);
}
END_TEST

/* A stepper that goes lets its surfaces go. */
START_TEST(outlives_its_stepper) {
  world w;
  open_block(&w, &methods[0], 2);
  mpm_surface *s = put_surface(&w, NULL);
  ck_ok(&w, mpm_stepper_destroy(w.stepper));
  w.stepper = NULL;
  ck_ok(&w, mpm_surface_destroy(s));
  world_close(&w);
}
END_TEST

void add_surface_states(Suite *suite) {
  TCase *other = tcase_create("other");
  tcase_add_test(other, splitting_keeps_area_and_moment);
  tcase_add_test(other, halves_stay_in_the_grid);
  tcase_add_test(other, stretched_markers_are_split);
  tcase_add_test(other, one_of_two_bodies);
  tcase_add_test(other, failures_leave_no_trace);
  tcase_add_test(other, threads_change_no_bit);
  tcase_add_test(other, states_hold_markers);
  tcase_add_test(other, every_allocation_fails_once);
  tcase_add_test(other, refusals);
  tcase_add_test(other, outlives_its_stepper);
  tcase_set_timeout(other, 60);
  suite_add_tcase(suite, other);
}
