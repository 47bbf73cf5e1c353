/* Fields packed into floats: every field in both orders, what floats cannot hold, and what is refused. */
#include <float.h>

#include "io.h"
#include "sets.h"

static world w;

/* All fields of a set that there are, by name. */
typedef struct names {
  int32_t count;
  const char *name[MPMI_MAX_FIELDS];
} names;

static names all_fields(const mpm_particles *set) {
  names all = {0};
  const char *name;
  for (int32_t f = 0; !mpm_particles_field_info(set, f, &name, NULL, NULL, NULL); ++f)
    if (set->field[f].present || (f != MPMI_REFERENCE && f != MPMI_DILATION_RATIO))
      all.name[all.count++] = name;
  return all;
}

/* The ids in the order that is asked for, to be freed. A view of them stays out until it is released. */
static int64_t *ids_in(const mpm_particles *set, int32_t order, mpm_view *view) {
  *view = (mpm_view){.struct_size = sizeof *view};
  ck_ok(&w, mpm_particles_map((mpm_particles *)(uintptr_t)set, "id", MPM_READ, view));
  if (order == MPM_BY_ID) return fetch_ids(&w, set);
  int64_t *ids = malloc((size_t)view->count * sizeof *ids), n = 0;
  for (int64_t i = 0; i < view->count; ++i)
    if (((const int64_t *)view->data)[i] >= 0) ids[n++] = ((const int64_t *)view->data)[i];
  ck_assert_int_eq(n, mpm_particles_count(set));
  return ids;
}

static float element(const void *data, int32_t type, int64_t i) {
  return type == MPM_F64   ? (float)((const double *)data)[i]
         : type == MPM_I64 ? (float)((const int64_t *)data)[i]
                           : (float)((const uint8_t *)data)[i];
}

/* What is packed must be what mpm_particles_get() gives, and nothing is written behind it. */
static void check_pack(const mpm_particles *set, const names *of, int32_t order) {
  const int64_t n = mpm_particles_count(set);
  int32_t stride = 0, first = 0;
  for (int32_t i = 0; i < of->count; ++i)
    stride += set->field[mpmi_find_field(set, of->name[i])].full_components;
  const size_t values = (size_t)(n * stride);
  float *out = malloc((values + 1) * sizeof *out);
  for (size_t i = 0; i <= values; ++i) out[i] = -7.5f;
  mpm_view view;
  int64_t *ids = ids_in(set, order, &view);
  ck_ok(&w, mpm_particles_get_f32(set, of->count, of->name, order, n, out));
  for (int32_t i = 0; i < of->count; ++i) {
    const mpmi_field *field = &set->field[mpmi_find_field(set, of->name[i])];
    void *wanted = malloc((size_t)(n * field->full_components + 1) * sizeof(double));
    ck_ok(&w, mpm_particles_get(set, field->name, field->type, field->full_components, n, ids, wanted));
    for (int64_t p = 0; p < n; ++p)
      for (int32_t c = 0; c < field->full_components; ++c) {
        const float is = out[p * stride + first + c], value = element(wanted, field->type, c * n + p);
        if (memcmp(&is, &value, sizeof is))
          ck_abort_msg("order %d, %s of particle %d, component %d: %g, wanted %g", (int)order, field->name,
                       (int)ids[p], (int)c, (double)is, (double)value);
      }
    first += field->full_components;
    free(wanted);
  }
  ck_assert(!memcmp(&out[values], &(float){-7.5f}, sizeof *out));
  ck_ok(&w, mpm_view_release(&view));
  free(ids);
  free(out);
}

/* Fields of all types, optional ones there and absent, of bodies that were sorted; alone, together and in
 * another order. */
START_TEST(every_field) {
  io_setup setup = io_plain(1 + _i % 3);
  setup.periodic = setup.references = _i / 3;
  io_open(&w, &setup);
  const double push[] = {1.0 / 3.0, 2.0 / 3.0, 0.1};
  const double far[] = {30.0, 0.3, 0.3};
  const int64_t first = 0;
  int32_t sorted = 0, holes = 0;
  for (int32_t k = 0; k < 4; ++k) {
    for (int32_t m = 0; m < 2; ++m) {
      const mpm_particles *set = w.set[m];
      const names all = all_fields(set);
      names back = {.count = all.count};
      for (int32_t i = 0; i < all.count; ++i) back.name[i] = all.name[all.count - 1 - i];
      sorted += !mpmi_ids_ascend(set);
      holes += set->slots > set->count;
      for (int32_t order = MPM_BY_ID; order <= MPM_LIBRARY_ORDER; ++order) {
        for (int32_t i = 0; i < all.count; ++i) check_pack(set, &(names){1, {all.name[i]}}, order);
        check_pack(set, &all, order);
        check_pack(set, &back, order);
      }
    }
    /* the first particle goes into the last block */
    if (k == 0) ck_ok(&w, mpm_particles_set(w.set[0], "position", MPM_F64, w.dim, 1, &first, far));
    if (k == 1) ck_ok(&w, mpm_particles_set_all(w.set[0], "applied_force", MPM_F64, w.dim, push));
    if (k == 2) ck_ok(&w, mpm_particles_set_all(w.set[0], "size", MPM_F64, w.dim, push));
    world_steps(&w, 5);
  }
  ck_assert(sorted && holes);
  world_close(&w);
}
END_TEST

/* More particles than are packed at a time, with ids that are all over the place, and some removed. */
START_TEST(many_particles) {
  static int64_t ids[3000], gone[100];
  for (int64_t i = 0; i < 3000; ++i) ids[i] = i * 1777 % 3000 * 5;
  for (int64_t i = 0; i < 100; ++i) gone[i] = ids[i * 29];
  sets_open(&w, 2, "linear_elastic", 0);
  for (int32_t k = 0; k < 3; ++k) {
    for (int32_t order = MPM_BY_ID; order <= MPM_LIBRARY_ORDER; ++order)
      check_pack(w.set[0], &(names){4, {"volume", "position", "deformation_gradient", "id"}}, order);
    if (k == 0) sets_add(&w, 3000, ids);
    if (k == 1) ck_ok(&w, mpm_particles_remove(w.set[0], 100, gone));
  }
  sets_close(&w);
}
END_TEST

/* Stress and volume follow from F, and are those of the F that was set last. */
START_TEST(stress_is_up_to_date) {
  static const double stretch[] = {1.5, 0, 0, 0, 1, 0, 0, 0, 1};
  float out[20 * 7];
  sets_open(&w, 3, "neo_hookean", 20);
  for (int32_t order = MPM_BY_ID; order <= MPM_LIBRARY_ORDER; ++order) {
    const double F[] = {1.0 + order, 0, 0, 0, 1, 0, 0, 0, 1};
    ck_ok(&w, mpm_particles_set_all(w.set[0], "deformation_gradient", MPM_F64, 9, stretch));
    ck_ok(&w, mpm_particles_set_all(w.set[0], "deformation_gradient", MPM_F64, 9, F));
    ck_ok(&w, mpm_particles_get_f32(w.set[0], 2, (const char *const[]){"volume", "stress"}, order, 20, out));
    for (int32_t i = 0; i < 20; ++i) {
      ck_assert(out[7 * i] == (float)(0.125 * (i + 1) * (1.0 + order)));
      ck_assert(out[7 * i + 1] == (float)sets_get(&w, "stress", 6, 0, i));
      ck_assert(out[7 * i + 1] > 0.0f);
    }
  }
  sets_close(&w);
}
END_TEST

START_TEST(what_floats_cannot_hold) {
  const double most = (double)FLT_MAX, step = ldexp(1.0, 103); /* half of what the largest float ends on */
  const struct {
    double value;
    float wanted;
  } real[] = {{1.0 + 0x1p-24, 1.0f},
              {1.0 + 0x1.8p-24, 1.0f + FLT_EPSILON},
              {most, FLT_MAX},
              {most + 0.99 * step, FLT_MAX},
              {most + step, (float)INFINITE},
              {-1e300, -(float)INFINITE},
              {1e-46, 0.0f},
              {0x1p-149, 0x1p-149f}};
  const struct {
    int64_t value;
    float wanted;
  } whole[] = {{16777216, 16777216.0f},
               {16777217, 16777216.0f},
               {16777219, 16777220.0f},
               {-16777217, -16777216.0f},
               {INT64_MAX, 9223372036854775808.0f},
               {INT64_MIN, -9223372036854775808.0f}};
  enum { REAL = sizeof real / sizeof *real, WHOLE = sizeof whole / sizeof *whole };
  float out[20];
  sets_open(&w, 1, "linear_elastic", 20);
  ck_ok(&w, mpm_particles_add_field(w.set[0], "label", MPM_I64, 1));
  for (int32_t order = MPM_BY_ID; order <= MPM_LIBRARY_ORDER; ++order) {
    for (int64_t i = 0; i < REAL; ++i)
      ck_ok(&w, mpm_particles_set(w.set[0], "velocity", MPM_F64, 1, 1, &i, &real[i].value));
    for (int64_t i = 0; i < WHOLE; ++i)
      ck_ok(&w, mpm_particles_set(w.set[0], "label", MPM_I64, 1, 1, &i, &whole[i].value));
    ck_ok(&w, mpm_particles_get_f32(w.set[0], 1, (const char *const[]){"velocity"}, order, 20, out));
    for (int32_t i = 0; i < REAL; ++i) ck_assert(!memcmp(&out[i], &real[i].wanted, sizeof *out));
    ck_ok(&w, mpm_particles_get_f32(w.set[0], 1, (const char *const[]){"label"}, order, 20, out));
    for (int32_t i = 0; i < WHOLE; ++i) ck_assert(!memcmp(&out[i], &whole[i].wanted, sizeof *out));
  }
  sets_close(&w);
}
END_TEST

START_TEST(pack_misuse) {
  float out[20 * 4];
  const char *const good[] = {"velocity", "mass"}, *const bad[] = {"mass", "velocty"}, *const none[] = {NULL};
  const char *const twice[] = {"mass", "id", "mass"}, *const state[] = {"state"},
                    *const reference[] = {"reference_position"};
  sets_open(&w, 3, "linear_elastic", 20);
  const mpm_particles *set = w.set[0];
  for (int32_t order = MPM_BY_ID; order <= MPM_LIBRARY_ORDER; ++order) {
#define REFUSED(status, text, ...) ck_refused(&w, mpm_particles_get_f32(set, __VA_ARGS__), status, text)
    REFUSED(MPM_E_ARG, "count is 0", 0, good, order, 20, out);
    REFUSED(MPM_E_ARG, "count is -1", -1, good, order, 20, out);
    REFUSED(MPM_E_ARG, "fields is NULL", 1, NULL, order, 20, out);
    REFUSED(MPM_E_ARG, "field is NULL", 1, none, order, 20, out);
    REFUSED(MPM_E_NOT_FOUND, "\"velocty\"; nearest: velocity", 2, bad, order, 20, out);
    REFUSED(MPM_E_ARG, "\"mass\" is named twice", 3, twice, order, 20, out);
    REFUSED(MPM_E_STATE, "reference_positions = 1", 1, reference, order, 20, out);
    REFUSED(MPM_E_ARG, "n is 19, but the set has 20", 2, good, order, 19, out);
    REFUSED(MPM_E_ARG, "n is 21, but the set has 20", 2, good, order, 21, out);
    REFUSED(MPM_E_ARG, "out is NULL", 2, good, order, 20, NULL);
    ck_assert_int_eq(mpm_particles_get_f32(NULL, 2, good, order, 20, out), MPM_E_ARG);
    ck_ok(&w, mpm_particles_get_f32(set, 1, state, order, 20, NULL)); /* it has no components */
    ck_ok(&w, mpm_particles_get_f32(set, 2, good, order, 20, out));
  }
  REFUSED(MPM_E_ARG, "order is 0", 2, good, 0, 20, out);
  REFUSED(MPM_E_ARG, "order is 3, must be MPM_BY_ID or MPM_LIBRARY_ORDER", 2, good, 3, 20, out);
#undef REFUSED
  sets_open(&w, 3, "linear_elastic", 0);
  for (int32_t order = MPM_BY_ID; order <= MPM_LIBRARY_ORDER; ++order)
    ck_ok(&w, mpm_particles_get_f32(w.set[0], 2, good, order, 0, NULL));
  sets_close(&w);
}
END_TEST

/* Ids that were written through a view for reading do not lead beyond the buffer. */
START_TEST(spoilt_ids) {
  sets_open(&w, 1, "linear_elastic", 20);
  const mpm_particles *set = w.set[0];
  int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  float out[21];
  for (int32_t more = 0; more < 2; ++more) {
    int64_t *at = more ? &id[set->slots - 1] : &id[3];
    const int64_t was = *at;
    ck_assert_int_eq(was < 0, more);
    *at = more ? 20 : -1;
    out[20] = -7.5f;
    ck_refused(&w, mpm_particles_get_f32(set, 1, (const char *const[]){"mass"}, MPM_LIBRARY_ORDER, 20, out),
               MPM_E_STATE, "the ids of the set are not those of its 20 particles");
    ck_assert(out[20] == -7.5f);
    *at = was;
    ck_ok(&w, mpm_particles_get_f32(set, 1, (const char *const[]){"mass"}, MPM_LIBRARY_ORDER, 20, out));
  }
  sets_close(&w);
}
END_TEST

TCase *copies_f32_case(void) {
  TCase *tests = tcase_create("f32");
  tcase_add_loop_test(tests, every_field, 0, 6);
  tcase_add_test(tests, many_particles);
  tcase_add_test(tests, stress_is_up_to_date);
  tcase_add_test(tests, what_floats_cannot_hold);
  tcase_add_test(tests, pack_misuse);
  tcase_add_test(tests, spoilt_ids);
  return tests;
}
