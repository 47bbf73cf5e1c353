/* CALL XPLB_EXIT, of VUMATs: ends the call of the subroutine and with it the step, not the process.
 * Elsewhere, where nobody waits for it, it ends the process with failure, as it says. */
#include <mpm/mpm_umat.h>
#include <stdlib.h>

_Noreturn void xplb_exit_(void);

_Noreturn void xplb_exit_(void) {
  mpm_umat_exit();
  exit(EXIT_FAILURE);
}
