/* The version of the library, and the names of statuses. */
#include "context/context.h"

uint32_t mpm_version(void) {
  return MPM_VERSION;
}

#define NAME(status)                                                                                         \
  case status:                                                                                               \
    return #status

const char *mpm_status_name(mpm_status status) {
  switch (status) {
    NAME(MPM_OK);
    NAME(MPM_CUT_DT);
    NAME(MPM_INVERTED);
    NAME(MPM_NONFINITE);
    NAME(MPM_NOT_CONVERGED);
    NAME(MPM_SINGULAR);
    NAME(MPM_OFF_GRID);
    NAME(MPM_CANCELLED);
    NAME(MPM_E_ARG);
    NAME(MPM_E_NOMEM);
    NAME(MPM_E_STATE);
    NAME(MPM_E_CALLBACK);
    NAME(MPM_E_UNSUPPORTED);
    NAME(MPM_E_NOT_FOUND);
    NAME(MPM_E_IO);
    NAME(MPM_E_FORMAT);
    NAME(MPM_E_INTERNAL);
  default:
    return "unknown status";
  }
}
