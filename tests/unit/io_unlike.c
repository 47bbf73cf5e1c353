/* States of other setups: refused, with the first difference and both values. */
#include "io.h"

enum { SAME, FEWER, WIDER, RETYPED, MORE }; /* how the fields of the host differ */
static int32_t fields;

static mpm_status add_unlike(world *w, int32_t m) {
  if (m && fields != FEWER) ck_ok(w, mpm_particles_add_field(w->set[1], "grain", MPM_I64, 2));
  if (m) return fields == MORE ? mpm_particles_add_field(w->set[1], "extra", MPM_I64, 2) : MPM_OK;
  ck_ok(w, mpm_particles_add_field(w->set[0], "colour", MPM_U8, fields == WIDER ? 4 : 3));
  if (fields == FEWER) return MPM_OK;
  return mpm_particles_add_field(w->set[0], "temperature", fields == RETYPED ? MPM_I64 : MPM_F64, 1);
}

static void check_mismatch(const saved_state *saved, const world_desc *like, int32_t with, const char *text) {
  static const fill_fn fill[] = {add_unlike, NULL};
  world w;
  world_desc d = *like;
  fields = with;
  d.fill = fill;
  world_open(&w, &d);
  const uint64_t before = world_hash(&w);
  ck_refused(&w, mpm_state_load(w.stepper, saved->data, saved->bytes), MPM_E_FORMAT, text);
  ck_assert_uint_eq(world_hash(&w), before);
  world_close(&w);
}

static world_desc with_scheme(const world_desc *like, int32_t scheme, int32_t projected) {
  world_desc d = *like;
  d.stepper.scheme = scheme;
  d.stepper.projected_positions = projected;
  return d;
}

START_TEST(unlike_setups_are_named) {
  const io_setup setup = io_plain(2), space = io_plain(3);
  const world_desc good = io_desc(&setup);
  world_desc d = io_desc(&space);
  world a;
  world_open(&a, &good);
  const saved_state saved = world_save(&a);
  world_close(&a);
  check_mismatch(&saved, &d, SAME, "dim is 2 there, 3 here");
#define UNLIKE(member, value, text)                                                                          \
  d = good;                                                                                                  \
  d.member = value;                                                                                          \
  check_mismatch(&saved, &d, SAME, text)
  UNLIKE(grid.basis, MPM_LINEAR, "basis is 2 there, 1 here");
  UNLIKE(grid.cells[1], 11, "cells[1] is 9 there, 11 here");
  UNLIKE(grid.spacing[0], 0.75, "spacing[0] is 0.5 there, 0.75 here");
  UNLIKE(grid.origin[1], -2.0, "origin[1] is -1 there, -2 here");
  UNLIKE(grid.periodic[0], 1, "periodic[0] is 0 there, 1 here");
  UNLIKE(stepper.scheme, MPM_MUSL, "scheme is 1 there, 3 here");
  UNLIKE(stepper.transfer, MPM_APIC, "transfer is 1 there, 2 here");
  UNLIKE(stepper.reference_positions, 1, "reference_positions is 0 there, 1 here");
#undef UNLIKE
  const world_desc musl = with_scheme(&good, MPM_MUSL, 0), projected = with_scheme(&good, MPM_MUSL, 1);
  world_open(&a, &musl);
  const saved_state by_musl = world_save(&a);
  world_close(&a);
  check_mismatch(&by_musl, &projected, SAME, "projected_positions is 0 there, 1 here");
  free(by_musl.data);
  check_mismatch(&saved, &good, FEWER, "set 0: field \"temperature\" is there, but not here");
  check_mismatch(&saved, &good, WIDER, "set 0: number of components of colour is 3 there, 4 here");
  check_mismatch(&saved, &good, RETYPED, "set 0: type of temperature is 1 there, 2 here");
  check_mismatch(&saved, &good, MORE, "set 1: field \"extra\" is here, but not there");
  free(saved.data);
}
END_TEST

static mpm_status some_stress(void *user, const mpm_material_batch *b) {
  (void)user;
  for (int32_t c = 0; c < 6; ++c)
    for (int64_t i = 0; i < b->n; ++i) b->stress_new[c * b->ld + i] = 0.0;
  for (int64_t i = 0; i < b->n; ++i) b->wave_speed[i] = 1.0;
  for (int64_t i = 0; i < b->n * b->state_count; ++i) b->state_new[i] = 0.0;
  return MPM_OK;
}

/* Opens two sets of the given law, of which so many are in the stepper. */
static void open_single(world *w, const char *model, double young, int32_t state_count, int32_t sets) {
  const io_setup setup = io_plain(1);
  world_desc d = io_desc(&setup);
  d.law = (world_law){.model = model,
                      .E = young,
                      .nu = 0.3,
                      .density = 2e3,
                      .stress = some_stress,
                      .state_count = state_count};
  d.other_law = (world_law){.model = NULL};
  d.fill = NULL;
  d.equip = NULL;
  world_open(w, &d);
  for (int32_t m = sets; m < 2; ++m) ck_ok(w, mpm_stepper_remove(w->stepper, w->set[m]));
}

START_TEST(unlike_laws_are_named) {
  static const struct {
    const char *model;
    double young;
    int32_t state_count, sets;
    const char *text;
  } other[] = {{"neo_hookean", 2e6, 0, 1, "set 0: E is 1000000 there, 2000000 here"},
               {"linear_elastic", 1e6, 0, 1, "set 0: law is \"neo_hookean\" there, \"linear_elastic\" here"},
               {NULL, 0, 2, 1, "set 0: law is \"neo_hookean\" there, \"custom\" here"},
               {"neo_hookean", 1e6, 0, 2, "number of sets is 1 there, 2 here"},
               {"neo_hookean", 1e6, 0, 0, "number of sets is 1 there, 0 here"}};
  world a, b;
  open_single(&a, "neo_hookean", 1e6, 0, 1);
  saved_state saved = world_save(&a);
  for (size_t i = 0; i < sizeof other / sizeof *other; ++i) {
    open_single(&b, other[i].model, other[i].young, other[i].state_count, other[i].sets);
    ck_refused(&b, mpm_state_load(b.stepper, saved.data, saved.bytes), MPM_E_FORMAT, other[i].text);
    world_close(&b);
  }
  free(saved.data);
  world_close(&a);
  open_single(&a, NULL, 0, 2, 1);
  open_single(&b, NULL, 0, 3, 1);
  saved = world_save(&a);
  ck_refused(&b, mpm_state_load(b.stepper, saved.data, saved.bytes), MPM_E_FORMAT,
             "set 0: state_count is 2 there, 3 here");
  free(saved.data);
  world_close(&a);
  world_close(&b);
}
END_TEST

TCase *io_unlike_case(void) {
  TCase *tests = tcase_create("unlike setups");
  tcase_add_test(tests, unlike_setups_are_named);
  tcase_add_test(tests, unlike_laws_are_named);
  return tests;
}
