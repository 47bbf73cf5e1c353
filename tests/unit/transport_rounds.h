/* Rounds of random exchanges, reductions and gatherings, which prove a transport of any kind. Needs neither
 * Check nor the library. */
#ifndef TRANSPORT_ROUNDS_H
#define TRANSPORT_ROUNDS_H

#include <mpm/parallel.h>

typedef struct rounds_desc {
  uint64_t seed;   /* the same on all parts, as everything here */
  int32_t rounds;  /* how many exchanges, every third of them sparse */
  int64_t largest; /* message in bytes */
} rounds_desc;

enum { ROUNDS_TEXT = 200 };

/* Runs them on this part. Returns 0; or -1, when a call failed or brought what it should not: then text
 * [ROUNDS_TEXT] says what. */
int rounds_run(const mpm_transport *transport, const rounds_desc *desc, char *text);

#endif
