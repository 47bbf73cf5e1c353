/* Particles as the host's callbacks see them, in batches that are long because calling costs. */
#ifndef MPMI_PARTICLE_BATCH_H
#define MPMI_PARTICLE_BATCH_H

#include "layout/step.h"
#include "particles/law_batch.h"

/* The callback fills add, [dim][ld] from the batch's first slot on; its refusal and what else is wrong goes
 * into the failure. */
typedef void (*mpmi_particle_batch_fn)(void *user, int32_t m, const mpm_particle_batch *batch, int64_t begin,
                                       mpmi_failure *failure);

/* Runs fn over all batches of member m, at time t, by all tasks. */
mpm_status mpmi_particle_batches(mpmi_step *step, int32_t m, double t, int32_t calls_host,
                                 mpmi_particle_batch_fn fn, void *user);

/* Calls the host and takes note of a refusal. */
mpm_status mpmi_call_particle_fn(mpm_particle_fn fn, void *user, const char *what, int32_t m,
                                 const mpm_particle_batch *batch, double *add, mpmi_failure *failure);

#endif
