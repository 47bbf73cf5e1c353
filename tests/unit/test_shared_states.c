/* States of one problem in several parts: what is saved and loaded, and pieces that are no state. */
#include "shared_states.h"

Suite *shared_states_suite(void) {
  Suite *suite = suite_create("shared_states");
  suite_add_tcase(suite, shared_states_case(suite));
  suite_add_tcase(suite, shared_pieces_case(suite));
  return suite;
}
