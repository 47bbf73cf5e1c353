/* What is written goes into a file, or to a callback of the host. A file is written beside its path and
 * renamed when it is complete, so the path holds the old contents or the new. */
#ifndef MPMI_OUTPUT_H
#define MPMI_OUTPUT_H

#include <stdio.h>

#include "context/context.h"

typedef struct mpmi_target {
  const char *path;   /* of the file; NULL where the host takes the bytes */
  mpm_write_fn write; /* the host's callback, if there is no path */
  void *user;
} mpmi_target;

typedef struct mpmi_output {
  mpm_context *context;
  mpmi_target to;
  struct mpmi_replacement *file; /* NULL where the host takes the bytes */
  int error;                     /* of the file: number of the first error, or 0 */
  unsigned char *piece;          /* bytes that the host gets next */
  size_t held;                   /* how many of them there are */
  int64_t given;                 /* bytes that the host has taken */
  mpm_status returned;           /* with which the host has refused more, or 0 */
} mpmi_output;

/* Returns 1 once nothing more is written; closing says why. */
static inline int32_t mpmi_output_failed(const mpmi_output *out) {
  return out->error || out->returned;
}

/* These refuse a path that is NULL or "", and a callback that is NULL: MPM_E_ARG. */
mpm_status mpmi_check_path(mpm_context *context, const char *path);
mpm_status mpmi_check_write(mpm_context *context, mpm_write_fn write);

/* Opens an output that those have let pass. MPM_E_IO names path and cause. A path must live as long as the
 * output is open. */
mpm_status mpmi_output_open(mpmi_output *out, mpm_context *context, const mpmi_target *to);
void mpmi_output_write(mpmi_output *out, const void *data, size_t bytes);
/* Prints less than 1024 characters. */
void mpmi_output_print(mpmi_output *out, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Writes zeros. Long runs take no room on storage that knows holes. More data must follow. */
void mpmi_output_zeros(mpmi_output *out, int64_t bytes);
void mpmi_output_rewind(mpmi_output *out); /* of a file: what follows is written from the first byte on */
/* Completes the file under its path, or removes what was written: MPM_E_IO. With `durable` it waits for
 * the storage. The host gets what is left: MPM_E_CALLBACK. */
mpm_status mpmi_output_close(mpmi_output *out, int32_t durable);
/* Removes what was written, or gives the host no more. */
void mpmi_output_drop(mpmi_output *out);

/* Fails with MPM_E_IO and the text "cannot <verb> <path>: <text of error>"; with MPM_E_UNSUPPORTED in a build
 * without files. */
mpm_status mpmi_io_error(mpm_context *context, const char *verb, const char *path, int error);
/* Prints the shortest decimal that reads back as the same finite value, with a point in any locale; text
 * has MPMI_REAL bytes. */
enum { MPMI_REAL = 40 };
void mpmi_print_real(double value, char *text);

#endif
