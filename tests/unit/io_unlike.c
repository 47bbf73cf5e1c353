/* States of other setups: refused, with the first difference and both values. */
#include "io_world.h"

static void check_mismatch(const io_buffer *saved, const io_setup *setup, const mpm_grid_desc *grid,
                           int32_t fields, const char *text) {
  io_world w;
  io_open_context(&w, 1);
  ck_ok(mpm_grid_create(w.f.context, grid, &w.f.grid));
  io_open_sets(&w);
  if (fields == 0) io_add_fields(&w);
  if (fields == 1) ck_ok(mpm_particles_add_field(w.set[0], "colour", MPM_U8, 3)); /* and no temperature */
  if (fields >= 2) {
    ck_ok(mpm_particles_add_field(w.set[0], "colour", MPM_U8, fields == 2 ? 4 : 3));
    ck_ok(mpm_particles_add_field(w.set[0], "temperature", fields == 3 ? MPM_I64 : MPM_F64, 1));
    ck_ok(mpm_particles_add_field(w.set[1], "grain", MPM_I64, 2));
  }
  if (fields == 4) ck_ok(mpm_particles_add_field(w.set[1], "extra", MPM_I64, 2));
  io_open_stepper(&w, setup);
  const uint64_t before = io_hash(&w);
  ck_refused(w.f.context, mpm_state_load(w.stepper, saved->data, saved->bytes), MPM_E_FORMAT, text);
  ck_assert_uint_eq(io_hash(&w), before);
  io_close(&w);
}

START_TEST(unlike_setups_are_named) {
  const io_setup setup = io_plain(2);
  const mpm_grid_desc grid = io_grid(&setup);
  io_world a;
  io_open(&a, &setup);
  const io_buffer saved = io_save(&a);
  io_close(&a);
  io_setup s = io_plain(3);
  mpm_grid_desc g = io_grid(&s);
  check_mismatch(&saved, &s, &g, 0, "dim is 2 there, 3 here");
  s = setup;
  g = grid;
  g.basis = MPM_LINEAR;
  check_mismatch(&saved, &s, &g, 0, "basis is 2 there, 1 here");
  g = grid;
  g.cells[1] = 11;
  check_mismatch(&saved, &s, &g, 0, "cells[1] is 9 there, 11 here");
  g = grid;
  g.spacing[0] = 0.75;
  check_mismatch(&saved, &s, &g, 0, "spacing[0] is 0.5 there, 0.75 here");
  g = grid;
  g.origin[1] = -2.0;
  check_mismatch(&saved, &s, &g, 0, "origin[1] is -1 there, -2 here");
  g = grid;
  g.periodic[0] = s.periodic = 1;
  check_mismatch(&saved, &s, &g, 0, "periodic[0] is 0 there, 1 here");
  s = setup;
  s.scheme = MPM_MUSL;
  check_mismatch(&saved, &s, &grid, 0, "scheme is 1 there, 3 here");
  s = setup;
  s.transfer = MPM_APIC;
  check_mismatch(&saved, &s, &grid, 0, "transfer is 1 there, 2 here");
  s = setup;
  s.references = 1;
  check_mismatch(&saved, &s, &grid, 0, "reference_positions is 0 there, 1 here");
  check_mismatch(&saved, &setup, &grid, 1, "set 0: field \"temperature\" is there, but not here");
  check_mismatch(&saved, &setup, &grid, 2, "set 0: number of components of colour is 3 there, 4 here");
  check_mismatch(&saved, &setup, &grid, 3, "set 0: type of temperature is 1 there, 2 here");
  check_mismatch(&saved, &setup, &grid, 4, "set 1: field \"extra\" is here, but not there");
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

/* One set of the given law in a stepper of its own. */
static void open_single(io_world *w, const char *model, double young, int32_t state_count, int32_t sets) {
  const io_setup setup = io_plain(1);
  const mpm_grid_desc grid = io_grid(&setup);
  const mpm_param params[] = {{"E", young}, {"nu", 0.3}, {"density", 2e3}};
  const mpm_stepper_desc desc = io_stepper_desc(&setup);
  mpm_material_desc custom;
  ck_ok(mpm_material_desc_init(&custom, sizeof custom));
  custom.density = 2e3;
  custom.stress = some_stress;
  custom.state_count = state_count;
  io_open_context(w, 1);
  ck_ok(mpm_grid_create(w->f.context, &grid, &w->f.grid));
  if (model)
    ck_ok(mpm_material_create(w->f.context, model, params, 3, &w->material[0]));
  else
    ck_ok(mpm_material_create_custom(w->f.context, &custom, &w->material[0]));
  w->material[1] = NULL;
  for (int32_t m = 0; m < WORLD_SETS; ++m)
    ck_ok(mpm_particles_create(w->f.context, w->f.grid, w->material[0], &w->set[m]));
  ck_ok(mpm_stepper_create(w->f.context, w->f.grid, &desc, &w->stepper));
  for (int32_t m = 0; m < sets; ++m) ck_ok(mpm_stepper_add(w->stepper, w->set[m]));
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
  io_world a, b;
  open_single(&a, "neo_hookean", 1e6, 0, 1);
  io_buffer saved = io_save(&a);
  for (size_t i = 0; i < sizeof other / sizeof *other; ++i) {
    open_single(&b, other[i].model, other[i].young, other[i].state_count, other[i].sets);
    ck_refused(b.f.context, mpm_state_load(b.stepper, saved.data, saved.bytes), MPM_E_FORMAT, other[i].text);
    io_close(&b);
  }
  free(saved.data);
  io_close(&a);
  open_single(&a, NULL, 0, 2, 1);
  open_single(&b, NULL, 0, 3, 1);
  saved = io_save(&a);
  ck_refused(b.f.context, mpm_state_load(b.stepper, saved.data, saved.bytes), MPM_E_FORMAT,
             "set 0: state_count is 2 there, 3 here");
  free(saved.data);
  io_close(&a);
  io_close(&b);
}
END_TEST

TCase *io_unlike_case(void) {
  TCase *tests = tcase_create("unlike setups");
  tcase_add_test(tests, unlike_setups_are_named);
  tcase_add_test(tests, unlike_laws_are_named);
  return tests;
}
