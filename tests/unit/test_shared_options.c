/* One problem in several parts has the bits that it has in one: total Lagrangian grids, heat, surfaces,
 * implicit steps, friction walls of nodes and adaption, which have files of their own. */
#include "shared.h"

Suite *shared_options_suite(void) {
  Suite *suite = suite_create("shared_options");
  add_shared_options(suite);
  add_shared_heat(suite);
  add_shared_surfaces(suite);
  add_shared_implicit(suite);
  add_shared_rubbing(suite);
  add_shared_prescribing(suite);
  add_shared_adaption(suite);
  return suite;
}
