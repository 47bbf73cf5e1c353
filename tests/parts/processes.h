/* Parts of one problem as processes of one machine, for programs that keep what they know in variables of
 * their own: a transport through memory that the processes share. */
#ifndef PROCESSES_H
#define PROCESSES_H

#include <mpm/parallel.h>

enum { PROCESSES_MOST = 8 };

/* Goes on in n processes of one group, children of this one, each with its number in *part. Returns the
 * transport of the process in each of them, and NULL in this one when all have ended: then *status is the
 * exit status of the first, or 3 where one was ended by a signal, came to another one or waited in vain. */
const mpm_transport *processes_start(int32_t n, int *status);

#endif
