/* Hands out aligned pieces of one allocation; with no memory it only adds up how much they take. */
#ifndef MPMI_CARVER_H
#define MPMI_CARVER_H

#include "context/context.h"

typedef struct mpmi_carver {
  char *memory;
  size_t used;
} mpmi_carver;

static inline void *mpmi_carve(mpmi_carver *from, int64_t count, size_t size) {
  void *at = from->memory ? from->memory + from->used : NULL;
  from->used += (mpmi_bytes(count, size) + MPMI_ALIGNMENT - 1) / MPMI_ALIGNMENT * MPMI_ALIGNMENT;
  return at;
}

#endif
