/* The number by which parts see that their steppers are set up alike: the same for the same, and another one
 * for whatever decides what a step does. */
#include "world.h"

#include "stepper/fingerprint.h"

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
  ck_ok(context, mpm_stepper_set_wall(s, MPM_Y_MIN, p->wall, 0.0));
  if (p->force) ck_ok(context, mpm_stepper_set_force(s, push, NULL));
  if (p->friction) ck_ok(context, mpm_stepper_set_friction(s, rub, NULL));
  const int64_t number = mpmi_fingerprint(s);
  ck_ok(context, mpm_stepper_destroy(s));
  for (int32_t m = 0; m < p->sets; ++m) ck_ok(context, mpm_particles_destroy(set[m]));
  ck_ok(context, mpm_material_destroy(law));
  ck_ok(context, mpm_grid_destroy(grid));
  return number;
}

/* Changes one thing; 0: there is no such thing. */
static int32_t change(problem *p, int32_t what) {
  switch (what) {
  case 0:
    p->grid.cells[1] = 13;
    return 1;
  case 1:
    p->grid.spacing[0] = 0.25;
    return 1;
  case 2:
    p->grid.origin[1] = -0.5;
    return 1;
  case 3:
    p->grid.basis = MPM_BSPLINE3;
    return 1;
  case 4:
    p->grid.periodic[0] = 1;
    return 1;
  case 5:
    p->grid.boundary_basis = MPM_BOUNDARY_OPEN_KNOT;
    return 1;
  case 6:
    p->grid.smoothing = 0.25;
    return 1;
  case 7:
    p->E = 2e5;
    return 1;
  case 8:
    p->law = 1;
    return 1;
  case 9:
    p->body = 2;
    return 1;
  case 10:
    p->contact.friction = 0.3;
    return 1;
  case 11:
    p->contact.kind = MPM_CONTACT_TIED;
    return 1;
  case 12:
    p->heat.conductivity = 2.0;
    return 1;
  case 13:
    p->heat.expansion = 1e-5;
    return 1;
  case 14:
    p->conduction = MPM_CONDUCTION_IMPLICIT;
    return 1;
  case 15:
    p->wall_temperature = 301.0;
    return 1;
  case 16:
    p->force = 1;
    return 1;
  case 17:
    p->friction = 1;
    return 1;
  case 18:
    p->wall = MPM_WALL_SLIP;
    return 1;
  case 19:
    p->stepper.flip = 0.9;
    return 1;
  case 20:
    p->sets = 1;
    return 1;
  default:
    return 0;
  }
}

START_TEST(another) {
  int64_t number[32];
  problem p = plain();
  int32_t count = 1;
  number[0] = number_of(&p);
  ck_assert(number_of(&p) == number[0]);
  for (int32_t what = 0; change(&p, what); ++what) {
    if (what != 4) number[count++] = number_of(&p); /* a periodic axis has no heated wall */
    p = plain();
  }
  for (int32_t i = 0; i < count; ++i)
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
