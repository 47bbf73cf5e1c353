/* Copies of fields by id, in and out, and what is refused on the way. */
#include "particles/values.h"
#include "sets.h"

static world w;

static void open_set(void) {
  sets_open(&w, 3, "linear_elastic", 20);
}

static void close_set(void) {
  sets_close(&w);
}

static mpm_status no_stress(void *user, const mpm_material_batch *batch) {
  (void)user, (void)batch;
  return MPM_OK;
}

/* A law of the host's with two state variables. */
static void open_with_state(void) {
  static const double initial[] = {0.5, -2.0};
  world_desc d = w.desc;
  d.law = (world_law){.density = 1.0, .stress = no_stress, .state_count = 2, .state_initial = initial};
  world_close(&w);
  world_open(&w, &d);
  sets_add(&w, 20, NULL);
}

/* A value that the field takes, different for each item and component; entries the dimension lacks stay as
 * they are. */
static double sample(int32_t field, int32_t c, int64_t i) {
  double value = 0.25 + 0.01 * (double)i + 0.001 * c;
  if (mpmi_stored_component(w.set[0], field, c) < 0) return mpmi_unstored_value(field, c);
  return field == MPMI_F && c % 4 == 0 ? 1.0 + value : value;
}

START_TEST(there_and_back) {
  static const int32_t fields[] = {
      MPMI_POSITION, MPMI_VELOCITY, MPMI_ACCELERATION, MPMI_MASS,         MPMI_INITIAL_VOLUME, MPMI_SIZE,
      MPMI_F,        MPMI_L,        MPMI_STRESS,       MPMI_APPLIED_FORCE};
  static const int64_t ids[] = {13, 2, 19, 0, 7};
  for (int32_t dim = 1; dim <= 3; ++dim) {
    sets_open(&w, dim, "linear_elastic", 20);
    for (int j = 0; j < 10; ++j) {
      const mpmi_field *field = &w.set[0]->field[fields[j]];
      int32_t n = field->full_components;
      double before[20 * 9], after[20 * 9], value[5 * 9], back[5 * 9];
      ck_ok(&w, mpm_particles_get(w.set[0], field->name, MPM_F64, n, 20, NULL, before));
      for (int32_t c = 0; c < n; ++c)
        for (int i = 0; i < 5; ++i) value[5 * c + i] = sample(fields[j], c, i);
      ck_ok(&w, mpm_particles_set(w.set[0], field->name, MPM_F64, n, 5, ids, value));
      ck_ok(&w, mpm_particles_get(w.set[0], field->name, MPM_F64, n, 5, ids, back));
      ck_assert_int_eq(memcmp(value, back, sizeof(double) * 5 * (size_t)n), 0);
      ck_ok(&w, mpm_particles_get(w.set[0], field->name, MPM_F64, n, 20, NULL, after));
      for (int32_t c = 0; c < n; ++c)
        for (int i = 0; i < 5; ++i) before[20 * c + ids[i]] = value[5 * c + i];
      ck_assert_int_eq(memcmp(before, after, sizeof(double) * 20 * (size_t)n), 0);
      ck_ok(&w, mpm_particles_set(w.set[0], field->name, MPM_F64, n, 20, NULL, before));
      for (int32_t c = 0; c < n; ++c) back[c] = value[5 * c];
      ck_ok(&w, mpm_particles_set_all(w.set[0], field->name, MPM_F64, n, back));
      for (int32_t c = 0; c < n; ++c) ck_assert_double_eq(sets_get(&w, field->name, n, c, 1), back[c]);
      sets_check_slots(&w);
    }
  }
}
END_TEST

START_TEST(sets_for_all) {
  ck_ok(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, 3, (double[]){1, 2, 3}));
  for (int64_t id = 0; id < 20; ++id)
    for (int32_t k = 0; k < 3; ++k) ck_assert_double_eq(sets_get(&w, "velocity", 3, k, id), 1.0 + k);
  ck_refused(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, 3, (double[]){1, 2, NOT_A_NUMBER}),
             MPM_E_ARG, "velocity of all particles, component 2, is nan");
  ck_refused(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, 3, NULL), MPM_E_ARG, "NULL");
  ck_refused(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, 2, (double[]){1, 2}), MPM_E_ARG,
             "velocity is F64 with 3 components, not F64 with 2");
  ck_refused(&w, mpm_particles_set_all(w.set[0], "speed", MPM_F64, 1, (double[]){1}), MPM_E_NOT_FOUND,
             "speed");
  ck_assert_int_eq(mpm_particles_set_all(NULL, "mass", MPM_F64, 1, (double[]){1}), MPM_E_ARG);
  sets_check_slots(&w); /* inert slots are passed over */
}
END_TEST

START_TEST(many_items) { /* more than are copied at a time */
  sets_add(&w, 1000, NULL);
  static double x[3 * 1020], back[3 * 1020];
  static int64_t ids[1020];
  for (int i = 0; i < 1020; ++i) ids[i] = (i * 7) % 1020;
  for (int i = 0; i < 3 * 1020; ++i) x[i] = 1e-3 * i - 0.5;
  ck_ok(&w, mpm_particles_set(w.set[0], "velocity", MPM_F64, 3, 1020, ids, x));
  ck_ok(&w, mpm_particles_get(w.set[0], "velocity", MPM_F64, 3, 1020, NULL, back));
  for (int i = 0; i < 1020; ++i)
    for (int c = 0; c < 3; ++c) ck_assert_double_eq(back[1020 * c + ids[i]], x[1020 * c + i]);
}
END_TEST

START_TEST(copy_misuse) {
  double value[60] = {0};
  const int64_t one = 1, unknown = 99;
  for (int set = 0; set < 2; ++set) {
#define CALL(p, field, type, components, n, ids, values)                                                     \
  (set ? mpm_particles_set(p, field, type, components, n, ids, values)                                       \
       : mpm_particles_get(p, field, type, components, n, ids, values))
#define REFUSED(status, text, ...) ck_refused(&w, CALL(w.set[0], __VA_ARGS__), status, text)
    REFUSED(MPM_E_ARG, "field is NULL", NULL, MPM_F64, 3, 1, &one, value);
    REFUSED(MPM_E_NOT_FOUND, "nearest: velocity", "velocty", MPM_F64, 3, 1, &one, value);
    REFUSED(MPM_E_ARG, "not I64 with 3", "velocity", MPM_I64, 3, 1, &one, value);
    REFUSED(MPM_E_ARG, "not ? with 3", "velocity", 77, 3, 1, &one, value);
    REFUSED(MPM_E_ARG, "not F64 with 1", "velocity", MPM_F64, 1, 1, &one, value);
    REFUSED(MPM_E_ARG, "with 9 components, not F64 with 6", "deformation_gradient", MPM_F64, 6, 1, &one,
            value);
    REFUSED(MPM_E_ARG, "n is -1", "velocity", MPM_F64, 3, -1, &one, value);
    REFUSED(MPM_E_ARG, "the set has 20 particles", "velocity", MPM_F64, 3, 19, NULL, value);
    REFUSED(MPM_E_NOT_FOUND, "id 99", "velocity", MPM_F64, 3, 1, &unknown, value);
    REFUSED(MPM_E_ARG, "NULL", "velocity", MPM_F64, 3, 1, &one, NULL);
    REFUSED(MPM_E_STATE, "reference_positions = 1", "reference_position", MPM_F64, 3, 1, &one, value);
    ck_assert_int_eq(CALL(NULL, "mass", MPM_F64, 1, 1, &one, value), MPM_E_ARG);
    ck_assert_int_eq(CALL((mpm_particles *)w.grid, "mass", MPM_F64, 1, 1, &one, value), MPM_E_ARG);
    ck_ok(&w, CALL(w.set[0], "velocity", MPM_F64, 3, 0, &one, NULL));
    ck_ok(&w, CALL(w.set[0], "state", MPM_F64, 0, 20, NULL, NULL));
#undef REFUSED
#undef CALL
  }
  ck_assert_int_eq(w.set[0]->field[MPMI_STATE].present, 0);
}
END_TEST

START_TEST(bad_values_are_not_stored) {
  const int64_t ids[] = {4, 11};
  static const struct {
    const char *field, *text;
    int32_t components, c;
    double bad;
  } list[] = {{"position", "position of the particle with id 11, component 1, is 3.6", 3, 1, 3.6},
              {"position", "is nan", 3, 2, NOT_A_NUMBER},
              {"velocity", "velocity of the particle with id 11, component 0, is inf", 3, 0, INFINITE},
              {"acceleration", "is nan", 3, 0, NOT_A_NUMBER},
              {"mass", "mass of the particle with id 11 is -1", 1, 0, -1.0},
              {"mass", "mass of the particle with id 11 is 0", 1, 0, 0.0},
              {"mass", "is nan", 1, 0, NOT_A_NUMBER},
              {"initial_volume", "is 0, must be > 0", 1, 0, 0.0},
              {"size", "component 2, is 0, must be > 0", 3, 2, 0.0},
              {"deformation_gradient", "particle with id 11 has determinant -1", 9, 4, -1.0},
              {"deformation_gradient", "has determinant 0", 9, 0, 0.0},
              {"deformation_gradient", "component 5, is -inf", 9, 5, -INFINITE},
              {"velocity_gradient", "component 8, is nan", 9, 8, NOT_A_NUMBER},
              {"stress", "component 3, is inf", 6, 3, INFINITE},
              {"applied_force", "component 0, is nan", 3, 0, NOT_A_NUMBER},
              {"heat", "heat of the particle with id 11 is nan", 1, 0, NOT_A_NUMBER}};
  ck_ok(&w, mpm_particles_add_field(w.set[0], "heat", MPM_F64, 1));
  w.set[0]->dirty = 0;
  for (int i = 0; i < (int)(sizeof list / sizeof *list); ++i) {
    int32_t field = mpmi_find_field(w.set[0], list[i].field), n = list[i].components;
    int32_t present = w.set[0]->field[field].present;
    double before[9], after[9], value[18];
    ck_ok(&w, mpm_particles_get(w.set[0], list[i].field, MPM_F64, n, 1, ids, before));
    for (int32_t c = 0; c < n; ++c) value[2 * c] = value[2 * c + 1] = field == MPMI_F ? c % 4 == 0 : 0.5;
    value[2 * list[i].c + 1] = list[i].bad;
    ck_refused(&w, mpm_particles_set(w.set[0], list[i].field, MPM_F64, n, 2, ids, value), MPM_E_ARG,
               list[i].text);
    ck_ok(&w, mpm_particles_get(w.set[0], list[i].field, MPM_F64, n, 1, ids, after));
    ck_assert_int_eq(memcmp(before, after, sizeof(double) * (size_t)n), 0);
    ck_assert_int_eq(w.set[0]->field[field].present, present);
  }
  ck_assert_uint_eq(w.set[0]->dirty, 0);
}
END_TEST

START_TEST(what_the_dimension_lacks) {
  static const double identity[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (int32_t dim = 1; dim <= 2; ++dim) {
    sets_open(&w, dim, "linear_elastic", 20);
    for (int32_t field = MPMI_F; field <= MPMI_STRESS; ++field) {
      const mpmi_field *at = &w.set[0]->field[field];
      for (int32_t c = 0; c < at->full_components; ++c) {
        double value[9] = {0};
        if (field == MPMI_F) memcpy(value, identity, sizeof value);
        value[c] += 0.125;
        mpm_status status = mpm_particles_set_all(w.set[0], at->name, MPM_F64, at->full_components, value);
        if (mpmi_stored_component(w.set[0], field, c) < 0)
          ck_refused(&w, status, MPM_E_ARG, "in this dimension");
        else
          ck_ok(&w, status);
      }
    }
  }
  double F[9];
  ck_ok(&w, mpm_particles_set_all(w.set[0], "deformation_gradient", MPM_F64, 9,
                                  (double[]){2, 0.5, 0, 0.25, 3, 0, 0, 0, 1.5}));
  ck_ok(&w, mpm_particles_get(w.set[0], "deformation_gradient", MPM_F64, 9, 1, (int64_t[]){3}, F));
  ck_assert_int_eq(memcmp(F, (double[]){2, 0.5, 0, 0.25, 3, 0, 0, 0, 1.5}, sizeof F), 0);
  ck_assert_double_eq(mpmi_f64(w.set[0], MPMI_F, 0)[4 * w.set[0]->ld + 3], 1.5);
}
END_TEST

START_TEST(not_for_the_host) {
  int64_t zero[] = {0, 0, 0};
  double one[] = {1, 1, 1, 1, 1, 1};
  ck_refused(&w, mpm_particles_set_all(w.set[0], "id", MPM_I64, 1, zero), MPM_E_ARG, "id is not");
  ck_refused(&w, mpm_particles_set_all(w.set[0], "image", MPM_I64, 3, zero), MPM_E_ARG, "image is not");
  ck_refused(&w, mpm_particles_set_all(w.set[0], "volume", MPM_F64, 1, one), MPM_E_ARG, "volume is not");
  ck_ok(&w, mpm_particles_set_all(w.set[0], "stress", MPM_F64, 6, one));
  sets_open(&w, 3, "neo_hookean", 20);
  int32_t writable;
  ck_ok(&w, mpm_particles_field_info(w.set[0], MPMI_STRESS, NULL, NULL, NULL, &writable));
  ck_assert_int_eq(writable, 0);
  ck_refused(&w, mpm_particles_set_all(w.set[0], "stress", MPM_F64, 6, one), MPM_E_UNSUPPORTED,
             "deformation_gradient");
}
END_TEST

/* Flags are 0 or 1, and take memory once one is 1. */
START_TEST(prescribed_flags) {
  uint8_t flags[60];
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&w, mpm_particles_set_all(w.set[0], "prescribed", MPM_U8, 3, (uint8_t[]){0, 0, 0}));
  ck_refused(&w, mpm_particles_set_all(w.set[0], "prescribed", MPM_U8, 3, (uint8_t[]){0, 0, 2}), MPM_E_ARG,
             "prescribed of all particles, component 2, is 2, must be 0 or 1");
  ck_assert_int_eq(w.set[0]->field[MPMI_PRESCRIBED].present, 0);
  ck_ok(&w, mpm_particles_set(w.set[0], "prescribed", MPM_U8, 3, 1, (int64_t[]){2}, (uint8_t[]){1, 0, 1}));
  ck_refused(w.context,
             mpm_particles_set(w.set[0], "prescribed", MPM_U8, 3, 1, (int64_t[]){2}, (uint8_t[]){0, 255, 0}),
             MPM_E_ARG, "prescribed of the particle with id 2, component 1, is 255");
  ck_ok(&w, mpm_particles_get(w.set[0], "prescribed", MPM_U8, 3, 20, NULL, flags));
  for (int32_t i = 0; i < 60; ++i) ck_assert_int_eq(flags[i], i == 2 || i == 42);
  ck_ok(&w, mpm_particles_map(w.set[0], "prescribed", MPM_READ | MPM_WRITE, &view));
  ((uint8_t *)view.data)[5 + view.component_stride] = 7;
  ck_refused(&w, mpm_view_release(&view), MPM_E_ARG, "is 7, must be 0 or 1");
  ck_refused(&w, mpmi_particles_check_suspects(w.set[0]), MPM_E_ARG, "is 7, must be 0 or 1");
  ck_ok(&w, mpm_particles_set_all(w.set[0], "prescribed", MPM_U8, 3, (uint8_t[]){0, 1, 0}));
  ck_ok(&w, mpmi_particles_check_suspects(w.set[0]));
  ck_ok(&w, mpm_particles_get(w.set[0], "prescribed", MPM_U8, 3, 20, NULL, flags));
  for (int32_t i = 0; i < 60; ++i) ck_assert_int_eq(flags[i], i / 20 == 1);
}
END_TEST

/* Particles of a rigid law are prescribed unless the host says otherwise. */
START_TEST(rigid_particles_are_prescribed) {
  uint8_t flags[69];
  const mpmi_law *law = w.material[0]->law;
  mpmi_law rigid = *law;
  rigid.kinematics = MPMI_F_STAYS;
  ck_ok(&w, mpm_particles_get(w.set[0], "prescribed", MPM_U8, 3, 20, NULL, flags));
  for (int32_t i = 0; i < 60; ++i) ck_assert_int_eq(flags[i], 0);
  w.material[0]->law = &rigid;
  sets_add(&w, 3, NULL);
  w.material[0]->law = law;
  ck_ok(&w, mpm_particles_get(w.set[0], "prescribed", MPM_U8, 3, 23, NULL, flags));
  for (int32_t i = 0; i < 69; ++i) ck_assert_int_eq(flags[i], i % 23 >= 20);
}
END_TEST

START_TEST(absent_fields_read_as_defaults) {
  static const char *const zero[] = {"acceleration", "applied_force", "velocity_gradient"};
  for (int i = 0; i < 3; ++i)
    for (int32_t c = 0; c < (i < 2 ? 3 : 9); ++c)
      ck_assert_double_eq(sets_get(&w, zero[i], i < 2 ? 3 : 9, c, 7), 0.0);
  ck_assert_double_eq_tol(sets_get(&w, "size", 3, 1, 7), 1.0, 1e-15); /* volume 0.125 * 8 */
  int64_t image[60];
  uint8_t prescribed[60];
  memset(image, 1, sizeof image);
  memset(prescribed, 1, sizeof prescribed);
  ck_ok(&w, mpm_particles_get(w.set[0], "image", MPM_I64, 3, 20, NULL, image));
  ck_ok(&w, mpm_particles_get(w.set[0], "prescribed", MPM_U8, 3, 20, NULL, prescribed));
  for (int i = 0; i < 60; ++i) ck_assert(image[i] == 0 && prescribed[i] == 0);
  for (int32_t i = 0; i < MPMI_BUILTIN_FIELDS; ++i)
    if (i == MPMI_SIZE || i == MPMI_L || i == MPMI_ACCELERATION)
      ck_assert_int_eq(w.set[0]->field[i].present, 0);
  /* Becoming present changes nothing. */
  ck_ok(&w, mpm_particles_set(w.set[0], "size", MPM_F64, 3, 1, (int64_t[]){3}, (double[]){1, 2, 3}));
  ck_assert_double_eq_tol(sets_get(&w, "size", 3, 1, 7), 1.0, 1e-15);
  ck_assert_double_eq(sets_get(&w, "size", 3, 1, 3), 2.0);
}
END_TEST

START_TEST(reference_positions) {
  mpm_grid_desc grid = sets_grid(2);
  grid.periodic[1] = 1; /* period 4.5 */
  sets_open_on(&w, &grid, "linear_elastic", 20);
  ck_ok(&w, mpm_particles_set(w.set[0], "position", MPM_F64, 2, 1, (int64_t[]){4}, (double[]){1, 8}));
  ck_assert_double_eq(sets_get(&w, "position", 2, 1, 4), -1.0);
  ck_ok(&w, mpmi_field_make_present(w.set[0], MPMI_REFERENCE));
  ck_assert_double_eq(sets_get(&w, "reference_position", 2, 1, 4), 8.0);
  ck_ok(&w, mpm_particles_add(w.set[0], 1, (double[]){0, -7}, NULL, (double[]){1}, NULL, NULL, NULL));
  ck_assert_double_eq(sets_get(&w, "reference_position", 2, 1, 20), -7.0);
  ck_ok(&w,
        mpm_particles_set(w.set[0], "reference_position", MPM_F64, 2, 1, (int64_t[]){4}, (double[]){50, 60}));
  ck_assert_double_eq(sets_get(&w, "reference_position", 2, 0, 4), 50.0);
  mpmi_field_make_absent(w.set[0], MPMI_REFERENCE);
  ck_assert_ptr_null(w.set[0]->field[MPMI_REFERENCE].data[0]);
}
END_TEST

START_TEST(positions_are_wrapped) {
  mpm_grid_desc grid = sets_grid(1); /* [-1, 4] */
  grid.periodic[0] = 1;
  sets_open_on(&w, &grid, "linear_elastic", 20);
  static const int64_t ids[] = {5, 5};
  int64_t image;
  ck_ok(&w, mpm_particles_set(w.set[0], "position", MPM_F64, 1, 2, ids, (double[]){4.5, 9.25}));
  ck_assert_double_eq(sets_get(&w, "position", 1, 0, 5), -0.75);
  ck_ok(&w, mpm_particles_get(w.set[0], "image", MPM_I64, 1, 1, ids, &image));
  ck_assert_int_eq(image, 3); /* the later of two values stands, the images of both are counted */
  ck_ok(&w, mpm_particles_set_all(w.set[0], "position", MPM_F64, 1, (double[]){-1.5}));
  ck_ok(&w, mpm_particles_get(w.set[0], "image", MPM_I64, 1, 1, ids, &image));
  ck_assert_int_eq(image, 2);
}
END_TEST

START_TEST(state_of_a_law) {
  open_with_state();
  ck_assert_double_eq(sets_get(&w, "state", 2, 0, 3), 0.5);
  ck_assert_double_eq(sets_get(&w, "state", 2, 1, 3), -2.0);
  ck_assert_ptr_nonnull(w.set[0]->field[MPMI_STATE].data[1]);
  ck_ok(&w, mpm_particles_set(w.set[0], "state", MPM_F64, 2, 1, (int64_t[]){3}, (double[]){4, 5}));
  ck_ok(&w, mpm_particles_remove(w.set[0], 1,
                                 (int64_t[]){7})); /* inert again: the initial state, as close_set() checks */
  ck_assert_double_eq(sets_get(&w, "state", 2, 1, 3), 5.0);
}
END_TEST

START_TEST(what_follows_is_marked) {
  static const struct {
    const char *field;
    int32_t components;
    uint32_t dirty;
  } list[] = {{"position", 3, MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS},
              {"velocity", 3, MPMI_DIRTY_SUMS},
              {"mass", 1, MPMI_DIRTY_SUMS},
              {"stress", 6, MPMI_DIRTY_SUMS},
              {"velocity_gradient", 9, MPMI_DIRTY_SUMS},
              {"deformation_gradient", 9, MPMI_DIRTY_STRESS | MPMI_DIRTY_SUMS},
              {"initial_volume", 1, MPMI_DIRTY_STRESS | MPMI_DIRTY_SUMS}};
  const double value[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (int i = 0; i < 7; ++i) {
    w.set[0]->dirty = 0;
    ck_ok(&w, mpm_particles_set_all(w.set[0], list[i].field, MPM_F64, list[i].components, value));
    ck_assert_uint_eq(w.set[0]->dirty, list[i].dirty);
  }
  ck_ok(&w, mpm_particles_set(w.set[0], "mass", MPM_F64, 1, 2, (int64_t[]){3, 4}, (double[]){2, 7}));
  ck_assert_double_eq(w.set[0]->mass_max, 7.0);
  ck_ok(&w, mpm_particles_set(w.set[0], "mass", MPM_F64, 1, 1, (int64_t[]){4}, (double[]){0.5}));
  ck_assert_double_eq(w.set[0]->mass_max, 2.0);
}
END_TEST

START_TEST(volume_and_stress_follow) {
  static const double stretch[] = {1.5, 0, 0, 0, 1, 0, 0, 0, 1};
  sets_open(&w, 3, "neo_hookean", 20);
  ck_ok(&w, mpm_particles_set(w.set[0], "deformation_gradient", MPM_F64, 9, 1, (int64_t[]){7}, stretch));
  ck_assert_double_eq(sets_get(&w, "volume", 1, 0, 7), 1.5);
  ck_assert_double_gt(sets_get(&w, "stress", 6, 0, 7), 0.0);
  ck_assert_double_eq(sets_get(&w, "stress", 6, 0, 6), 0.0);
  ck_ok(&w, mpm_particles_set(w.set[0], "initial_volume", MPM_F64, 1, 1, (int64_t[]){7}, (double[]){4}));
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&w, mpm_particles_map(w.set[0], "volume", MPM_READ, &view));
  ck_assert_double_eq(((double *)view.data)[7], 6.0);
  ck_ok(&w, mpm_view_release(&view));
}
END_TEST

Suite *copies_suite(void) {
  Suite *suite = suite_create("copies");
  TCase *tests = tcase_create("copies");
  tcase_add_checked_fixture(tests, open_set, close_set);
  tcase_add_test(tests, there_and_back);
  tcase_add_test(tests, sets_for_all);
  tcase_add_test(tests, many_items);
  tcase_add_test(tests, copy_misuse);
  tcase_add_test(tests, bad_values_are_not_stored);
  tcase_add_test(tests, what_the_dimension_lacks);
  tcase_add_test(tests, not_for_the_host);
  tcase_add_test(tests, prescribed_flags);
  tcase_add_test(tests, rigid_particles_are_prescribed);
  tcase_add_test(tests, absent_fields_read_as_defaults);
  tcase_add_test(tests, reference_positions);
  tcase_add_test(tests, positions_are_wrapped);
  tcase_add_test(tests, state_of_a_law);
  tcase_add_test(tests, what_follows_is_marked);
  tcase_add_test(tests, volume_and_stress_follow);
  suite_add_tcase(suite, tests);
  suite_add_tcase(suite, copies_f32_case());
  return suite;
}
