/* Parts of one problem as threads of one process: a transport without MPI, which checks what it is used for.
 * Needs neither Check nor the library. Check's macros may not be used on the threads of the parts. */
#ifndef PARTS_H
#define PARTS_H

#include <mpm/parallel.h>

enum { PARTS_MOST = 64, PARTS_TEXT = 200 };

/* The calls of the transport that can fail, as mpm_transport has them. */
enum { PARTS_SEND = 1, PARTS_RECEIVE = 2, PARTS_REDUCE = 4, PARTS_GATHER = 8, PARTS_ANY = 15 };

/* What goes wrong on purpose, and what there is to know afterwards. With zeros nothing fails. */
typedef struct parts_plan {
  /* Of this part the call number fail_at (from 1; 0: none) among those of the kinds in fail_kinds fails. */
  int32_t fail_part, fail_kinds;
  int64_t fail_at;
  /* Calls begin late by up to so many microseconds, differently each time. */
  int32_t jitter;
  uint32_t seed;
  /* Filled: calls of all kinds that each part has made, polls not among them; messages and bytes that it has
   * sent; the first failure in a sentence, "" if there is none. */
  int64_t calls[PARTS_MOST], messages[PARTS_MOST], bytes[PARTS_MOST];
  char text[PARTS_TEXT];
} parts_plan;

typedef void (*parts_fn)(int32_t part, const mpm_transport *transport, void *user);

/* Calls fn(part, transport, user) on n threads, 1 to PARTS_MOST, and joins them. plan may be NULL. Returns 0,
 * or -1: a thread could not be had, or something has failed, which plan->text names. After the first failure
 * every call of every part fails with MPM_E_CALLBACK. Failures are those of the plan; wrong use (arguments,
 * order of calls, more bytes than announced, data that change before they are received, collective calls that
 * differ, known exchanges on one side only); and parts that wait for each other for ever. */
int parts_run(int32_t n, parts_fn fn, void *user, parts_plan *plan);

#endif
