/* Wall-clock time for profiles. */
#include "context/context.h"
#include "platform/platform.h"

double mpmi_seconds(void) {
  return 1e-9 * (double)mpmi_nanoseconds();
}
