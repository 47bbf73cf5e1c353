/* States are saved in files and loaded from files. */
#include <errno.h>

#include "context/transport.h"
#include "io/state.h"
#include "platform/platform.h"

/* The header has the checksum and so comes last; until then its place is empty. */
static mpm_status write_state(const mpm_stepper *stepper, mpmi_output *out) {
  mpmi_state_header header = {"", 0, 0, 0, 0};
  uint64_t mark;
  mpmi_archive a;
  mpmi_output_write(out, &header, sizeof header);
  mpmi_archive_begin(&a, stepper->context, MPMI_TO_OUTPUT);
  a.output = out;
  mpmi_state_write(&a, stepper);
  const mpm_status status = mpmi_state_mark(&a, &mark);
  mpmi_state_write_end(&a, mark);
  header = mpmi_state_header_of(&a);
  mpmi_output_rewind(out);
  mpmi_output_write(out, &header, sizeof header);
  return status;
}

mpm_status mpm_state_save_file(const mpm_stepper *stepper, const char *path) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  mpm_context *context = stepper->context;
  mpmi_output out;
  mpm_status status = mpmi_state_settle(stepper, mpmi_check_path(context, path));
  if (status) return status;
  status = mpmi_output_open(&out, context, &(mpmi_target){.path = path});
  const mpm_status opened = status;
  if (!(status = mpmi_agree(context, status))) status = write_state(stepper, &out);
  if (!status) return mpmi_agree(context, mpmi_output_close(&out, 1));
  if (!opened) mpmi_output_drop(&out);
  return status;
}

/* Reads and checks the header before there is a buffer, because a file that is no state may have any size. */
static mpm_status check_head(mpm_context *context, const char *path, FILE *file, int64_t bytes) {
  mpmi_state_header header = {"", 0, 0, 0, 0};
  if (bytes >= (int64_t)sizeof header && fread(&header, sizeof header, 1, file) != 1)
    return mpmi_io_error(context, "read", path, MPMI_STORAGE_FAILED);
  header = mpmi_state_turn_header(header);
  return mpmi_state_check_header(context, &header, bytes, 0);
}

static mpm_status load(mpm_stepper *s, const char *path, FILE *file, int64_t bytes) {
  unsigned char *buffer = mpmi_alloc(s->context, (size_t)bytes);
  if (!buffer) return MPM_E_NOMEM;
  rewind(file);
  errno = 0;
  mpm_status status;
  if (fread(buffer, 1, (size_t)bytes, file) == (size_t)bytes)
    status = mpmi_state_load(s, buffer, bytes);
  else
    status = mpmi_io_error(s->context, "read", path, errno ? errno : MPMI_STORAGE_FAILED);
  mpmi_free(s->context, buffer, (size_t)bytes);
  return status;
}

mpm_status mpm_state_load_file(mpm_stepper *stepper, const char *path) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  mpm_status status = mpmi_check_path(stepper->context, path);
  if (status) return status;
  FILE *file;
  int64_t bytes;
  const int error = mpmi_file_read(path, &file, &bytes);
  if (error) return mpmi_io_error(stepper->context, "read", path, error);
  status = check_head(stepper->context, path, file, bytes);
  if (!status) status = load(stepper, path, file, bytes);
  fclose(file);
  return status;
}
