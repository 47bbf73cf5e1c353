/* The number by which parts see that their steppers are set up alike: the same for the same, and another one
 * for whatever decides what a step does. */
#include "world.h"

#include "stepper/fingerprint.h"

#include <stddef.h>
#include <string.h>

typedef struct problem {
  mpm_grid_desc grid;
  mpm_stepper_desc stepper;
  mpm_contact_desc contact;
  mpm_heat_desc heat;
  double E, wall_temperature;
  int32_t law, body, conduction, force, friction, wall, sets;
} problem;

static mpm_context *context;

static problem plain(void) {
  problem p = {.E = 1e5, .wall_temperature = 300.0, .sets = 2, .body = 1};
  ck_assert_int_eq(mpm_grid_desc_init(&p.grid, sizeof p.grid), MPM_OK);
  ck_assert_int_eq(mpm_stepper_desc_init(&p.stepper, sizeof p.stepper), MPM_OK);
  ck_assert_int_eq(mpm_contact_desc_init(&p.contact, sizeof p.contact), MPM_OK);
  ck_assert_int_eq(mpm_heat_desc_init(&p.heat, sizeof p.heat), MPM_OK);
  p.grid.dim = 2;
  p.heat.specific_heat = 1000.0;
  for (int32_t k = 0; k < 2; ++k) p.grid.cells[k] = 12, p.grid.spacing[k] = 0.5;
  return p;
}

static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  (void)user, (void)b, (void)add;
  return MPM_OK;
}
static mpm_status rub(void *user, const mpm_contact_batch *b, double *coefficient) {
  (void)user, (void)b, (void)coefficient;
  return MPM_OK;
}

static int64_t number_of(const problem *p) {
  static const char *const model[] = {"neo_hookean", "linear_elastic"};
  const mpm_param param[] = {{"E", p->E}, {"nu", 0.3}, {"density", 1e3}};
  mpm_grid *grid;
  mpm_material *law;
  mpm_particles *set[2] = {NULL, NULL};
  mpm_stepper *s;
  ck_ok(context, mpm_grid_create(context, &p->grid, &grid));
  ck_ok(context, mpm_material_create(context, model[p->law], param, 3, &law));
  ck_ok(context, mpm_stepper_create(context, grid, &p->stepper, &s));
  for (int32_t m = 0; m < p->sets; ++m) {
    ck_ok(context, mpm_particles_create(context, grid, law, &set[m]));
    ck_ok(context, mpm_stepper_add(s, set[m]));
    ck_ok(context, mpm_stepper_set_body(s, set[m], m ? p->body : 0));
    ck_ok(context, mpm_stepper_set_heat(s, set[m], &p->heat));
  }
  ck_ok(context, mpm_stepper_set_contact(s, 0, 1, &p->contact));
  ck_ok(context, mpm_stepper_set_conduction(s, p->conduction, 1e-8));
  ck_ok(context, mpm_stepper_set_heat_wall(s, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, p->wall_temperature));
  ck_ok(context, mpm_stepper_set_wall(s, MPM_X_MAX, p->wall, 0.0));
  if (p->force) ck_ok(context, mpm_stepper_set_force(s, push, NULL));
  if (p->friction) ck_ok(context, mpm_stepper_set_friction(s, rub, NULL));
  const int64_t number = mpmi_fingerprint(s);
  ck_ok(context, mpm_stepper_destroy(s));
  for (int32_t m = 0; m < p->sets; ++m) ck_ok(context, mpm_particles_destroy(set[m]));
  ck_ok(context, mpm_material_destroy(law));
  ck_ok(context, mpm_grid_destroy(grid));
  return number;
}

/* One thing that is changed, and to what. */
typedef struct change {
  size_t at;
  enum { INT32, INT64, DOUBLE } type;
  double value;
} change;

#define CHANGE(member, type, value)                                                                          \
  { offsetof(problem, member), type, value }
static const change changes[] = {CHANGE(grid.cells[1], INT64, 13),
                                 CHANGE(grid.spacing[0], DOUBLE, 0.25),
                                 CHANGE(grid.origin[1], DOUBLE, -0.5),
                                 CHANGE(grid.basis, INT32, MPM_BSPLINE3),
                                 CHANGE(grid.periodic[1], INT32, 1),
                                 CHANGE(grid.boundary_basis, INT32, MPM_BOUNDARY_OPEN_KNOT),
                                 CHANGE(grid.smoothing, DOUBLE, 0.25),
                                 CHANGE(E, DOUBLE, 2e5),
                                 CHANGE(law, INT32, 1),
                                 CHANGE(body, INT32, 2),
                                 CHANGE(contact.friction, DOUBLE, 0.3),
                                 CHANGE(contact.kind, INT32, MPM_CONTACT_TIED),
                                 CHANGE(heat.conductivity, DOUBLE, 2.0),
                                 CHANGE(heat.expansion, DOUBLE, 1e-5),
                                 CHANGE(conduction, INT32, MPM_CONDUCTION_IMPLICIT),
                                 CHANGE(wall_temperature, DOUBLE, 301.0),
                                 CHANGE(force, INT32, 1),
                                 CHANGE(friction, INT32, 1),
                                 CHANGE(wall, INT32, MPM_WALL_SLIP),
                                 CHANGE(stepper.flip, DOUBLE, 0.9),
                                 CHANGE(sets, INT32, 1)};
enum { CHANGES = sizeof changes / sizeof changes[0] };

static problem changed(const change *c) {
  problem p = plain();
  const int32_t narrow = (int32_t)c->value;
  const int64_t wide = narrow;
  const void *const value[] = {&narrow, &wide, &c->value};
  memcpy((char *)&p + c->at, value[c->type], c->type == INT32 ? sizeof narrow : sizeof wide);
  return p;
}

START_TEST(another) {
  int64_t number[CHANGES + 1];
  problem p = plain();
  number[CHANGES] = number_of(&p);
  ck_assert(number_of(&p) == number[CHANGES]);
  for (int32_t i = 0; i < CHANGES; ++i) {
    p = changed(&changes[i]);
    number[i] = number_of(&p);
  }
  for (int32_t i = 0; i <= CHANGES; ++i)
    for (int32_t j = 0; j < i; ++j) ck_assert_msg(number[i] != number[j], "%d and %d", i, j);
}
END_TEST

static void set_up(void) {
  context = context_with(1, MPM_ISA_BASELINE, NULL);
}
static void tear_down(void) {
  ck_assert_int_eq(mpm_context_destroy(context), MPM_OK);
}

Suite *fingerprint_suite(void) {
  Suite *suite = suite_create("fingerprint");
  TCase *tests = tcase_create("fingerprint");
  tcase_add_checked_fixture(tests, set_up, tear_down);
  tcase_add_test(tests, another);
  suite_add_tcase(suite, tests);
  return suite;
}
