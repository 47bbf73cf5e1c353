#include "exact.h"
Suite *exact_suite(void);
Suite *exact_suite(void) {
  Suite *suite = suite_create("exact");
  suite_add_tcase(suite, basis_case());
  suite_add_tcase(suite, conservation_case());
  suite_add_tcase(suite, rotation_case());
  suite_add_tcase(suite, patch_case());
  return suite;
}
