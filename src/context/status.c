/* The version of the library, and the names of statuses. */
#include "context/context.h"

uint32_t mpm_version(void) {
  return MPM_VERSION;
}

/* In one line for each, for hosts that have nothing else to show. */
const char *mpm_status_text(mpm_status status) {
  switch (status) {
  case MPM_OK:
    return "the call did what it was asked to";
  case MPM_CUT_DT:
    return "a callback or a law asked for a smaller step; the state is as it was";
  case MPM_INVERTED:
    return "a particle would have been turned inside out; the state is as it was, and a smaller step may do";
  case MPM_NONFINITE:
    return "a value was not finite; the state is as it was, and a smaller step may do";
  case MPM_NOT_CONVERGED:
    return "the Newton iteration did not converge; the state is as it was, and a smaller step may do";
  case MPM_SINGULAR:
    return "the linear system was singular or indefinite; the state is as it was, and a smaller step may do";
  case MPM_OFF_GRID:
    return "a particle would have left the grid through a face that does not let it; the state is as it was";
  case MPM_CANCELLED:
    return "the progress callback ended the call; the state is as it was";
  case MPM_E_ARG:
    return "an argument or a handle is NULL, destroyed, of another kind, out of range or inconsistent";
  case MPM_E_NOMEM:
    return "memory or threads were not to be had";
  case MPM_E_STATE:
    return "the call is not allowed now: objects live, views are out or were given back, a step is begun, or "
           "another "
           "call on the context is under way";
  case MPM_E_CALLBACK:
    return "a callback returned a negative status, or the host's executor failed";
  case MPM_E_UNSUPPORTED:
    return "this version does not offer the combination or the extension";
  case MPM_E_NOT_FOUND:
    return "there is no such name, id or index";
  case MPM_E_IO:
    return "a file could not be opened, read or written";
  case MPM_E_FORMAT:
    return "data are damaged, of another kind, or from an unlike setup";
  case MPM_E_INTERNAL:
    return "the library itself is at fault";
  default:
    return "unknown status";
  }
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
