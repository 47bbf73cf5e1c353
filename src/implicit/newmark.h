/* One implicit step by Newmark's rule (Guilkey & Weiss 2003, eqs 14-16, for any beta and gamma), or
 * quasi-static without inertia:
 *
 *   particles -> nodes   M, v0 = sum w m v_p / M, a0 = sum w m a_p / M, external forces of its end
 *
 *   nodes                f_int(u) + M a1 = f_ext + f_contact,
 *                        a1 = (u - dt v0 - dt^2 (1/2 - beta) a0) / (beta dt^2)
 *
 *   nodes -> particles   x_p += sum w u,  a_p' = sum w a1,  v_p += dt ((1 - gamma) a_p + gamma a_p') */
#ifndef MPMI_NEWMARK_H
#define MPMI_NEWMARK_H

#include "implicit/balance.h"

/* Makes one implicit step up to its commit. */
mpm_status mpmi_newmark_step(mpmi_balance *balance);
/* Returns the dt to try after a step that went well, in so many iterations. */
double mpmi_next_dt(int32_t iterations, double dt);

#endif
