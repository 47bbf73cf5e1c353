/* Files that are written beside their path and renamed when complete: the path holds the old contents or the
 * new. */
#ifndef MPMI_OUTPUT_FILE_H
#define MPMI_OUTPUT_FILE_H

#include <stdio.h>

#include "context/context.h"

typedef struct mpmi_output {
  mpm_context *context;
  FILE *stream; /* for text; errors are looked at when the file is closed */
  int error;    /* number of the first error, or 0 */
  const char *path;
  char *temporary;
  size_t temporary_bytes;
} mpmi_output;

/* MPM_E_IO with path and cause. `path` must live as long as the file is open. */
mpm_status mpmi_output_open(mpmi_output *out, mpm_context *context, const char *path);
void mpmi_output_write(mpmi_output *out, const void *data, size_t bytes);
/* Zeros; long runs of them take no room on the storage where it knows holes. More data must follow. */
void mpmi_output_zeros(mpmi_output *out, int64_t bytes);
void mpmi_output_rewind(mpmi_output *out); /* writes on at the first byte */
/* Completes the file under its path, or removes what was written: MPM_E_IO. durable: waits for the storage.
 */
mpm_status mpmi_output_close(mpmi_output *out, int32_t durable);
/* MPM_E_ARG when path is NULL or "". */
mpm_status mpmi_check_path(mpm_context *context, const char *path);
/* MPM_E_IO: "cannot <verb> <path>: <text of error>". */
mpm_status mpmi_io_error(mpm_context *context, const char *verb, const char *path, int error);
/* Shortest decimal that reads back as a finite value, with a point in any locale; text has MPMI_REAL bytes.
 */
enum { MPMI_REAL = 40 };
void mpmi_print_real(double value, char *text);

#endif
