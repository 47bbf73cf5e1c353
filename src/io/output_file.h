/* Files are written beside their path and renamed when they are complete. So the path holds the old
 * contents or the new. */
#ifndef MPMI_OUTPUT_FILE_H
#define MPMI_OUTPUT_FILE_H

#include <stdio.h>

#include "context/context.h"

typedef struct mpmi_output {
  mpm_context *context;
  FILE *stream; /* for text; closing the file looks for its errors */
  int error;    /* number of the first error, or 0 */
  const char *path;
  struct mpmi_replacement *file;
} mpmi_output;

/* Opens a file for writing: MPM_E_IO names path and cause. `path` must live as long as the file is open. */
mpm_status mpmi_output_open(mpmi_output *out, mpm_context *context, const char *path);
void mpmi_output_write(mpmi_output *out, const void *data, size_t bytes);
/* Writes zeros. Long runs take no room on storage that knows holes. More data must follow. */
void mpmi_output_zeros(mpmi_output *out, int64_t bytes);
void mpmi_output_rewind(mpmi_output *out); /* what follows is written from the first byte on */
/* Completes the file under its path, or removes what was written: MPM_E_IO. With `durable` it waits for
 * the storage. */
mpm_status mpmi_output_close(mpmi_output *out, int32_t durable);
/* Refuses a path that is NULL or "": MPM_E_ARG. */
mpm_status mpmi_check_path(mpm_context *context, const char *path);
/* Fails with MPM_E_IO and the text "cannot <verb> <path>: <text of error>"; with MPM_E_UNSUPPORTED in a build
 * without files. */
mpm_status mpmi_io_error(mpm_context *context, const char *verb, const char *path, int error);
/* Prints the shortest decimal that reads back as the same finite value, with a point in any locale; text
 * has MPMI_REAL bytes. */
enum { MPMI_REAL = 40 };
void mpmi_print_real(double value, char *text);

#endif
