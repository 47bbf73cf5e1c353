/* Views of a set: memory lent, given back, and what the host may have done to it meanwhile. */
#include "body.h"
#include "particles/values.h"
#include "sets.h"
#include "tables.h"

static world w;

static void open_set(void) {
  sets_open(&w, 2, "linear_elastic", 20);
}

static void close_set(void) {
  ck_assert_int_eq(w.set[0]->mapped, 0);
  sets_close(&w);
}

static mpm_view mapped(const char *field, int32_t access) {
  mpm_view view;
  memset(&view, 0xff, sizeof view);
  view.struct_size = sizeof view;
  ck_ok(&w, mpm_particles_map(w.set[0], field, access, &view));
  return view;
}

START_TEST(shows_the_storage) {
  mpm_view F = mapped("deformation_gradient", MPM_READ), id = mapped("id", MPM_READ);
  ck_assert_uint_eq(F.struct_size, sizeof F);
  ck_assert_int_eq(F.type, MPM_F64);
  ck_assert_int_eq(id.type, MPM_I64);
  ck_assert_int_eq(F.components, 5);
  ck_assert_int_eq(F.access, MPM_READ);
  ck_assert_int_eq(F.count, 32);
  ck_assert_int_eq(F.item_stride, 1);
  ck_assert_int_eq(F.component_stride, w.set[0]->ld);
  ck_assert_ptr_eq(F.data, w.set[0]->field[MPMI_F].data[0]);
  ck_assert_ptr_nonnull(F.owner);
  for (int64_t i = 0; i < 32; ++i) ck_assert_int_eq(((int64_t *)id.data)[i], i < 20 ? i : -1);
  ck_ok(&w, mpm_view_release(&F));
  ck_ok(&w, mpm_view_release(&id));
  ck_assert_ptr_null(F.data);
  ck_assert_ptr_null(F.owner);
}
END_TEST

START_TEST(bad_requests) {
  mpm_view view = {.struct_size = sizeof view}, small = {.struct_size = 48};
  ck_assert_int_eq(mpm_particles_map(NULL, "mass", MPM_READ, &view), MPM_E_ARG);
  ck_assert_int_eq(mpm_particles_map((mpm_particles *)w.grid, "mass", MPM_READ, &view), MPM_E_ARG);
#define REFUSED(status, text, ...) ck_refused(&w, mpm_particles_map(w.set[0], __VA_ARGS__), status, text)
  REFUSED(MPM_E_ARG, "view is NULL", "mass", MPM_READ, NULL);
  REFUSED(MPM_E_ARG, "struct_size is 48", "mass", MPM_READ, &small);
  REFUSED(MPM_E_ARG, "access is 0", "mass", 0, &view);
  REFUSED(MPM_E_ARG, "access is 4", "mass", 4, &view);
  REFUSED(MPM_E_ARG, "field is NULL", NULL, MPM_READ, &view);
  REFUSED(MPM_E_NOT_FOUND, "nearest: mass", "mas", MPM_READ, &view);
  REFUSED(MPM_E_NOT_FOUND, "no state", "state", MPM_READ, &view);
  REFUSED(MPM_E_ARG, "id is not", "id", MPM_WRITE, &view);
  REFUSED(MPM_E_ARG, "volume is not", "volume", MPM_READ | MPM_WRITE, &view);
  REFUSED(MPM_E_ARG, "image is not", "image", MPM_WRITE, &view);
  REFUSED(MPM_E_STATE, "reference_positions = 1", "reference_position", MPM_READ, &view);
#undef REFUSED
  ck_assert_ptr_null(view.data);
  ck_assert_int_eq(w.set[0]->mapped, 0);
}
END_TEST

START_TEST(stress_that_follows_from_F) {
  sets_open(&w, 2, "neo_hookean", 20);
  mpm_view view = {.struct_size = sizeof view};
  ck_refused(&w, mpm_particles_map(w.set[0], "stress", MPM_WRITE, &view), MPM_E_UNSUPPORTED,
             "deformation_gradient");
  view = mapped("stress", MPM_READ);
  ck_ok(&w, mpm_view_release(&view));
}
END_TEST

START_TEST(released_once) {
  mpm_view view = mapped("mass", MPM_READ), copy = view, empty = {.struct_size = sizeof empty};
  ck_assert_int_eq(mpm_view_release(NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_view_release(&empty), MPM_E_STATE);
  mpm_view moved = view;
  moved.data = (double *)moved.data + 1;
  ck_assert_int_eq(mpm_view_release(&moved), MPM_E_STATE);
  ck_assert_int_eq(w.set[0]->mapped, 1);
  ck_ok(&w, mpm_view_release(&view));
  ck_assert_int_eq(mpm_view_release(&view), MPM_E_STATE);
  ck_assert_int_eq(mpm_view_release(&copy), MPM_E_STATE);
  ck_assert_int_eq(w.set[0]->mapped, 0);
}
END_TEST

START_TEST(as_many_as_there_are_records) {
  mpm_view view[MPMI_MAX_VIEWS], one_more = {.struct_size = sizeof one_more};
  for (int i = 0; i < MPMI_MAX_VIEWS; ++i) view[i] = mapped("velocity", i % 2 ? MPM_READ : MPM_WRITE);
  ck_refused(&w, mpm_particles_map(w.set[0], "velocity", MPM_READ, &one_more), MPM_E_STATE, "64 views");
  ck_ok(&w, mpm_view_release(&view[17]));
  view[17] = mapped("mass", MPM_READ);
  for (int i = 0; i < MPMI_MAX_VIEWS; ++i) ck_ok(&w, mpm_view_release(&view[i]));
}
END_TEST

START_TEST(nothing_moves_meanwhile) {
  double x[] = {0, 0}, one[] = {1};
  int64_t id = 3;
  mpm_view view = mapped("mass", MPM_READ);
  sets_counts was = sets_take(&w);
#define REFUSED(call) ck_refused(&w, call, MPM_E_STATE, "1 views of the set are out")
  REFUSED(mpm_particles_add(w.set[0], 1, x, NULL, one, NULL, NULL, NULL));
  REFUSED(mpm_particles_fill_box(w.set[0], x, one, (int32_t[]){1, 1}, NULL, NULL));
  REFUSED(mpm_particles_fill_ball(w.set[0], x, 1.0, (int32_t[]){1, 1}, NULL, NULL));
  REFUSED(mpm_particles_remove(w.set[0], 1, &id));
  REFUSED(mpm_particles_add_field(w.set[0], "heat", MPM_F64, 1));
  REFUSED(mpm_particles_set(w.set[0], "mass", MPM_F64, 1, 1, &id, one));
  REFUSED(mpm_particles_set_all(w.set[0], "mass", MPM_F64, 1, one));
  REFUSED(mpm_particles_destroy(w.set[0]));
#undef REFUSED
  sets_unchanged(&w, was);
  ck_assert_double_eq(sets_get(&w, "volume", 1, 0, 3), 0.5); /* reading is fine */
  ck_assert_ptr_eq(view.data, w.set[0]->field[MPMI_MASS].data[0]);
  ck_ok(&w, mpm_view_release(&view));
}
END_TEST

START_TEST(optional_fields_appear) {
  static const char *const optional[] = {"acceleration", "size",          "velocity_gradient",
                                         "prescribed",   "applied_force", "image"};
  for (int i = 0; i < 6; ++i) {
    const mpmi_field *field = &w.set[0]->field[mpmi_find_field(w.set[0], optional[i])];
    ck_assert_int_eq(field->present, 0);
    mpm_view view = mapped(optional[i], MPM_READ);
    ck_assert_int_eq(field->present, 1);
    ck_assert_ptr_eq(view.data, field->data[0]);
    ck_assert_int_eq(field->data[1] != NULL, field->two_copies);
    ck_ok(&w, mpm_view_release(&view));
  }
  ck_assert_double_eq(sets_get(&w, "size", 2, 1, 7), 1.0);
  w.memory.fail_at = w.memory.calls + 1;
  mpmi_field_make_absent(w.set[0], MPMI_L);
  mpm_view view = {.struct_size = sizeof view};
  ck_refused(&w, mpm_particles_map(w.set[0], "velocity_gradient", MPM_READ, &view), MPM_E_NOMEM, "memory");
  w.memory.fail_at = w.memory.calls + 2; /* its second copy */
  ck_refused(&w, mpm_particles_map(w.set[0], "velocity_gradient", MPM_READ, &view), MPM_E_NOMEM, "memory");
  ck_assert_int_eq(w.set[0]->field[MPMI_L].present, 0);
  ck_assert_int_eq(w.set[0]->mapped, 0);
}
END_TEST

START_TEST(written_values_count) {
  static const struct {
    const char *field;
    uint32_t dirty;
  } list[] = {{"position", MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS},
              {"velocity", MPMI_DIRTY_SUMS},
              {"mass", MPMI_DIRTY_SUMS},
              {"stress", MPMI_DIRTY_SUMS},
              {"deformation_gradient", MPMI_DIRTY_STRESS | MPMI_DIRTY_SUMS},
              {"initial_volume", MPMI_DIRTY_STRESS | MPMI_DIRTY_SUMS}};
  for (int i = 0; i < 6; ++i) {
    w.set[0]->dirty = 0;
    mpm_view view = mapped(list[i].field, MPM_READ);
    ck_ok(&w, mpm_view_release(&view));
    ck_assert_uint_eq(w.set[0]->dirty, 0);
    view = mapped(list[i].field, MPM_READ | MPM_WRITE);
    double *value = view.data;
    /* Every slot, the inert ones too; F stays invertible. */
    for (int32_t c = 0; c < view.components; ++c)
      for (int64_t s = 0; s < view.count; ++s)
        value[c * view.component_stride + s] = 0.5 + (c == 0 || c == 3 || c == 4);
    ck_ok(&w, mpm_view_release(&view));
    ck_assert_uint_eq(w.set[0]->dirty, list[i].dirty);
    sets_check_slots(&w);
    ck_assert_double_eq(sets_get(&w, list[i].field,
                                 w.set[0]->field[mpmi_find_field(w.set[0], list[i].field)].full_components, 0,
                                 5),
                        1.5);
  }
  ck_assert_double_eq(w.set[0]->mass_max, 1.5);
}
END_TEST

START_TEST(bad_values_bar_the_set) {
  static const struct {
    const char *field, *text;
    double bad, good;
  } list[] = {{"position", "position of the particle with id 6, component 0, is 4.5", 4.5, 0.5},
              {"velocity", "velocity of the particle with id 6, component 0, is nan", NOT_A_NUMBER, 0.0},
              {"mass", "mass of the particle with id 6 is -1", -1.0, 1.0},
              {"mass", "mass of the particle with id 6 is inf", INFINITE, 1.0},
              {"initial_volume", "initial_volume of the particle with id 6 is 0", 0.0, 1.0},
              {"deformation_gradient", "particle with id 6 has determinant -1", -1.0, 1.0},
              {"stress", "component 0, is inf", INFINITE, 0.0}};
  for (int i = 0; i < 7; ++i) {
    int32_t field = mpmi_find_field(w.set[0], list[i].field), n = w.set[0]->field[field].full_components;
    mpm_view view = mapped(list[i].field, MPM_WRITE);
    ((double *)view.data)[6] = list[i].bad;
    ck_refused(&w, mpm_view_release(&view), MPM_E_ARG, list[i].text);
    ck_assert_ptr_null(view.data);
    ck_assert_int_eq(w.set[0]->mapped, 0);
    ck_assert_uint_eq(w.set[0]->suspect, 1u << field);
    ck_refused(&w, mpmi_particles_check_suspects(w.set[0]), MPM_E_ARG, list[i].text);
    ck_assert_uint_eq(w.set[0]->suspect, 1u << field);
    if (i % 2) { /* repaired by a copy, or by another view */
      double value[9];
      ck_ok(&w, mpm_particles_get(w.set[0], list[i].field, MPM_F64, n, 1, (int64_t[]){6}, value));
      value[0] = list[i].good;
      ck_ok(&w, mpm_particles_set(w.set[0], list[i].field, MPM_F64, n, 1, (int64_t[]){6}, value));
      ck_ok(&w, mpmi_particles_check_suspects(w.set[0]));
    } else {
      view = mapped(list[i].field, MPM_WRITE);
      ((double *)view.data)[6] = list[i].good;
      ck_ok(&w, mpm_view_release(&view));
    }
    ck_assert_uint_eq(w.set[0]->suspect, 0);
    ck_ok(&w, mpmi_particles_check_suspects(w.set[0]));
    ck_assert_double_le(w.set[0]->mass_max, 1e4);
  }
}
END_TEST

START_TEST(nothing_is_computed_from_bad_values) {
  mpm_view view = mapped("deformation_gradient", MPM_WRITE);
  ((double *)view.data)[6] = NOT_A_NUMBER;
  ck_assert_int_eq(mpm_view_release(&view), MPM_E_ARG);
  double volume;
  ck_refused(&w, mpm_particles_get(w.set[0], "volume", MPM_F64, 1, 1, (int64_t[]){3}, &volume), MPM_E_ARG,
             "id 6");
  view = (mpm_view){.struct_size = sizeof view};
  ck_refused(&w, mpm_particles_map(w.set[0], "stress", MPM_READ, &view), MPM_E_ARG, "id 6");
  ck_assert_int_eq(w.set[0]->mapped, 0);
  double identity[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  ck_ok(&w, mpm_particles_set(w.set[0], "deformation_gradient", MPM_F64, 9, 1, (int64_t[]){6}, identity));
  ck_assert_double_eq(sets_get(&w, "volume", 1, 0, 3), 0.5);
}
END_TEST

START_TEST(the_hosts_fields) {
  ck_ok(&w, mpm_particles_add_field(w.set[0], "heat", MPM_F64, 1));
  ck_ok(&w, mpm_particles_add_field(w.set[0], "label", MPM_U8, 2));
  mpm_view view = mapped("label", MPM_WRITE);
  ck_assert_int_eq(view.type, MPM_U8);
  for (int64_t s = 0; s < view.count; ++s)
    for (int64_t c = 0; c < 2; ++c)
      ((uint8_t *)view.data)[c * view.component_stride + s] = (uint8_t)(s + 100 * c);
  ck_ok(&w, mpm_view_release(&view));
  uint8_t label[2];
  ck_ok(&w, mpm_particles_get(w.set[0], "label", MPM_U8, 2, 1, (int64_t[]){9}, label));
  ck_assert_int_eq(label[0], 9);
  ck_assert_int_eq(label[1], 109);
  view = mapped("heat", MPM_WRITE);
  ((double *)view.data)[2] = NOT_A_NUMBER;
  ck_refused(&w, mpm_view_release(&view), MPM_E_ARG, "heat of the particle with id 2 is nan");
  ck_assert_uint_eq(w.set[0]->suspect, 0); /* nothing of the step reads it */
}
END_TEST

START_TEST(positions_are_wrapped) {
  mpm_grid_desc grid = sets_grid(2);
  grid.periodic[0] = 1; /* [-1, 4] */
  sets_open_on(&w, &grid, "linear_elastic", 20);
  mpm_view view = mapped("position", MPM_WRITE);
  ((double *)view.data)[4] = 11.5;
  ck_ok(&w, mpm_view_release(&view));
  ck_assert_double_eq(sets_get(&w, "position", 2, 0, 4), 1.5);
  int64_t image[2];
  ck_ok(&w, mpm_particles_get(w.set[0], "image", MPM_I64, 2, 1, (int64_t[]){4}, image));
  ck_assert_int_eq(image[0], 2);
  ck_assert_int_eq(image[1], 0);
}
END_TEST

START_TEST(an_empty_set) {
  ck_ok(&w, mpm_particles_destroy(w.set[0]));
  ck_ok(&w, mpm_particles_create(w.context, w.grid, w.material[0], &w.set[0]));
  mpm_view view = mapped("position", MPM_READ | MPM_WRITE);
  ck_assert_int_eq(view.count, 0);
  ck_ok(&w, mpm_view_release(&view));
  view = mapped("size", MPM_READ);
  ck_ok(&w, mpm_view_release(&view));
  ck_ok(&w, mpm_particles_get(w.set[0], "size", MPM_F64, 2, 0, NULL, NULL));
  ck_ok(&w, mpm_particles_set(w.set[0], "size", MPM_F64, 2, 0, NULL, NULL));
  ck_ok(&w, mpm_particles_set_all(w.set[0], "size", MPM_F64, 2, (double[]){1, 2}));
  sets_add(&w, 3, NULL);
  ck_assert_double_eq(sets_get(&w, "size", 2, 1, 1), 0.5);
}
END_TEST

/* Between mpm_step_begin() and its end the set is read, not changed. */
START_TEST(staged_steps) {
  mpm_stepper *stepper;
  double one[] = {1}, x[] = {0, 0};
  int64_t id = 3;
  ck_ok(&w, mpm_stepper_create(w.context, w.grid, NULL, &stepper));
  ck_ok(&w, mpm_stepper_add(stepper, w.set[0]));
  ck_ok(&w, mpm_particles_set_all(w.set[0], "mass", MPM_F64, 1, one));
  ck_ok(&w, mpm_step_begin(stepper, 1e-6));
  mpm_view view = {.struct_size = sizeof view};
#define REFUSED(call) ck_refused(&w, call, MPM_E_STATE, "staged step")
  REFUSED(mpm_particles_add(w.set[0], 1, x, NULL, one, NULL, NULL, NULL));
  REFUSED(mpm_particles_fill_box(w.set[0], x, one, (int32_t[]){1, 1}, NULL, NULL));
  REFUSED(mpm_particles_fill_ball(w.set[0], x, 1.0, (int32_t[]){1, 1}, NULL, NULL));
  REFUSED(mpm_particles_remove(w.set[0], 1, &id));
  REFUSED(mpm_particles_add_field(w.set[0], "heat", MPM_F64, 1));
  REFUSED(mpm_particles_set(w.set[0], "mass", MPM_F64, 1, 1, &id, one));
  REFUSED(mpm_particles_set_all(w.set[0], "mass", MPM_F64, 1, one));
  REFUSED(mpm_particles_map(w.set[0], "mass", MPM_WRITE, &view));
  REFUSED(mpm_particles_map(w.set[0], "applied_force", MPM_READ, &view));
#undef REFUSED
  view = mapped("mass", MPM_READ);
  ck_assert_double_eq(sets_get(&w, "mass", 1, 0, 3), 1.0);
  ck_ok(&w, mpm_view_release(&view));
  ck_ok(&w, mpm_step_abort(stepper));
  ck_ok(&w, mpm_particles_set_all(w.set[0], "mass", MPM_F64, 1, one));
  ck_refused(&w, mpm_particles_destroy(w.set[0]), MPM_E_STATE, "mpm_stepper_remove");
  ck_ok(&w, mpm_stepper_remove(stepper, w.set[0]));
  ck_ok(&w, mpm_stepper_destroy(stepper));
}
END_TEST

/* ---- what a view for reading was changed to ------------------------------------------------------------ */
static const struct {
  const char *field;
  double value;
} spoilt[] = {{"position", 1e30},
              {"position", -5.0},
              {"position", NOT_A_NUMBER},
              {"position", 0.9},
              {"mass", -1.0},
              {"mass", NOT_A_NUMBER},
              {"mass", 0.0},
              {"volume", NOT_A_NUMBER},
              {"id", 77777},
              {"id", -1},
              {"id", 3},
              {"velocity", INFINITE},
              {"stress", 1e300},
              {"deformation_gradient", -1.0}};
enum { SPOILT = sizeof spoilt / sizeof *spoilt };

/* Five slots, a hole or not, take the value; the library may notice it now. */
static void spoil(world *b, int32_t k, mpm_particles *set) {
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(b, mpm_particles_map(set, spoilt[k].field, MPM_READ, &view));
  for (int64_t i = 0; i < 5; ++i) {
    if (view.type == MPM_I64)
      ((int64_t *)view.data)[i] = (int64_t)spoilt[k].value;
    else
      ((double *)view.data)[i] = spoilt[k].value;
  }
  const mpm_status status = mpm_view_release(&view);
  ck_assert(status == MPM_OK || status == MPM_E_STATE);
  if (status) ck_assert_ptr_nonnull(strstr(mpm_last_error(b->context), "lent for reading"));
  ck_assert_int_eq(set->mapped, 0);
}

/* Nothing that is written there makes a step read or write where it must not; positions are named. */
START_TEST(spoilt_views_for_reading) {
  static const int32_t scheme[] = {MPM_USL, MPM_USF, MPM_MUSL, MPM_NEWMARK};
  const int32_t k = _i % SPOILT;
  for (int32_t s = 0; s < 4; ++s)
    for (int32_t other = 0; other < 2; ++other) {
      world b;
      body_open(&b, &(body_desc){.dim = 2, .method.scheme = scheme[s]});
      mpm_stepper_desc d = body_stepper(&b);
      d.locking_remedy = other;
      ck_ok(&b, mpm_stepper_configure(b.stepper, &d));
      if (!other) { /* no callback is shown positions */
        ck_ok(&b, mpm_stepper_set_force(b.stepper, NULL, NULL));
        ck_ok(&b, mpm_stepper_set_acceleration(b.stepper, NULL, NULL));
      }
      world_steps(&b, 2);
      const int64_t n = mpm_particles_count(b.set[0]);
      double *x = fetch(&b, b.set[0], "position", 2);
      spoil(&b, k, b.set[0]);
      for (int32_t again = 0; again < 4; ++again) {
        const mpm_status status = mpm_step(b.stepper, BODY_DT, NULL);
        if (k < 3) {
          ck_assert_int_eq(status, MPM_E_STATE);
          ck_assert_ptr_nonnull(strstr(mpm_last_error(b.context), "written through a view for reading"));
        }
      }
      const double v[2] = {0.0, 0.0};
      mpm_particles_set_all(b.set[0], "velocity", MPM_F64, 2, v);
      mpm_particles_add(b.set[1], 1, (double[]){x[0], x[n]}, NULL, (double[]){1e-6}, NULL, NULL, NULL);
      mpm_step(b.stepper, BODY_DT, NULL); /* sorts */
      if (k < 4) {                        /* positions can be set right */
        ck_ok(&b, mpm_particles_set(b.set[0], "position", MPM_F64, 2, n, NULL, x));
        world_steps(&b, 1);
      }
      free(x);
      world_close(&b);
    }
}
END_TEST

/* Also between the parts of a step. */
START_TEST(spoilt_in_a_staged_step) {
  for (int32_t part = 0; part < 2; ++part) {
    world b;
    body_open(&b, &(body_desc){.dim = 2, .method.scheme = MPM_USL});
    world_steps(&b, 1);
    ck_ok(&b, mpm_step_begin(b.stepper, BODY_DT));
    if (part) ck_ok(&b, mpm_step_grid(b.stepper));
    spoil(&b, 0, b.set[0]);
    ck_refused(&b, part ? mpm_step_end(b.stepper, NULL) : mpm_step_grid(b.stepper), MPM_E_STATE,
               "written through a view for reading");
    world_close(&b);
  }
}
END_TEST

Suite *views_suite(void) {
  Suite *suite = suite_create("views");
  TCase *tests = tcase_create("views");
  tcase_add_checked_fixture(tests, open_set, close_set);
  tcase_add_test(tests, shows_the_storage);
  tcase_add_test(tests, bad_requests);
  tcase_add_test(tests, stress_that_follows_from_F);
  tcase_add_test(tests, released_once);
  tcase_add_test(tests, as_many_as_there_are_records);
  tcase_add_test(tests, nothing_moves_meanwhile);
  tcase_add_test(tests, optional_fields_appear);
  tcase_add_test(tests, written_values_count);
  tcase_add_test(tests, bad_values_bar_the_set);
  tcase_add_test(tests, nothing_is_computed_from_bad_values);
  tcase_add_test(tests, the_hosts_fields);
  tcase_add_test(tests, positions_are_wrapped);
  tcase_add_test(tests, an_empty_set);
  tcase_add_test(tests, staged_steps);
  add_sparse(tests, spoilt_views_for_reading, SPOILT, 3);
  tcase_add_test(tests, spoilt_in_a_staged_step);
  suite_add_tcase(suite, tests);
  return suite;
}
