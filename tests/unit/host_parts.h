/* Parts of test_host.c. */
#ifndef HOST_PARTS_H
#define HOST_PARTS_H

#include "body.h"

TCase *host_environment_case(void);
TCase *host_callbacks_case(void);
TCase *host_reentry_case(void);
TCase *host_texts_case(void);

/* ---- a host that sets every callback (host_callbacks.c) ---- */
enum {
  FROM_LAW,
  FROM_TANGENT,
  FROM_INSIDE,
  FROM_WRITE,
  FROM_LOG,
  FROM_PROGRESS,
  FROM_FORCE,
  FROM_ACCELERATION,
  FROM_VELOCITY,
  FROM_HOOK,
  FROM_FRICTION,
  FROM_MOTION,
  FROM_SOLVER,
  FROM_EXECUTOR,
  FROM_ALLOC,
  FROM_RELEASE,
  FROM_RELEASE_USER,
  KINDS
};
/* What callbacks do besides their work; NULL: nothing. Counts the calls of each kind. */
typedef struct visits {
  void (*visit)(int32_t kind);
  int64_t seen[KINDS];
} visits;
extern visits host_visits;

/* A body of a host's law with a prescribed one beside it, and all callbacks that the scheme can have. */
void every_callback_open(world *w, int32_t scheme);
/* Goes through all calls that ask the host, and returns a hash of what they gave. */
uint64_t every_callback_story(world *w);

#endif
