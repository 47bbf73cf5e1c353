/* The library in hosts that it does not know: whatever their floating-point environment is, whatever their
 * callbacks call, and with a sentence for everything that fails. */
#include "host_parts.h"

Suite *host_suite(void) {
  Suite *suite = suite_create("host");
  suite_add_tcase(suite, host_environment_case());
  suite_add_tcase(suite, host_callbacks_case());
  suite_add_tcase(suite, host_reentry_case());
  suite_add_tcase(suite, host_texts_case());
  return suite;
}
