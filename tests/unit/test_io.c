/* Saved states, hashes, files for visualisation. */
#include "io_world.h"

Suite *io_suite(void) {
  Suite *suite = suite_create("io");
  suite_add_tcase(suite, io_state_case());
  suite_add_tcase(suite, io_unlike_case());
  suite_add_tcase(suite, io_damage_case());
  suite_add_tcase(suite, io_hash_case());
  suite_add_tcase(suite, io_file_case());
  suite_add_tcase(suite, io_output_case());
  suite_add_tcase(suite, io_grid_case());
  return suite;
}
