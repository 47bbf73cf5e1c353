/* One problem in several parts has the bits that it has in one: total Lagrangian grids, heat, surfaces and
 * implicit steps, which have a file of their own each. */
#include "shared.h"

Suite *shared_options_suite(void) {
  Suite *suite = suite_create("shared_options");
  add_shared_options(suite);
  add_shared_heat(suite);
  add_shared_surfaces(suite);
  add_shared_implicit(suite);
  return suite;
}
