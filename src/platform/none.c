/* What is done without a system: threads and files that a build leaves out, and where the system is neither
 * POSIX nor Windows everything else by ISO C alone. */
#include "platform/platform.h"

#include <string.h>

const char *mpmi_own_error(int error) {
  return error == MPMI_NO_FILES         ? "this build has no files"
         : error == MPMI_NOT_REGULAR    ? "it is not a regular file"
         : error == MPMI_STORAGE_FAILED ? "the storage failed without saying why"
                                        : NULL;
}

/* ---- threads ---- */
#if !MPMI_HAS_THREADS
int32_t mpmi_processors(void) {
  return 1;
}

int32_t mpmi_thread_start(mpmi_system_thread *thread, void *(*body)(void *), void *argument) {
  (void)thread, (void)body, (void)argument;
  return 0;
}

void mpmi_thread_join(mpmi_system_thread *thread) {
  (void)thread;
}
void mpmi_monitor_begin(mpmi_monitor *m) {
  (void)m;
}
void mpmi_monitor_end(mpmi_monitor *m) {
  (void)m;
}
void mpmi_lock(mpmi_monitor *m) {
  (void)m;
}
void mpmi_unlock(mpmi_monitor *m) {
  (void)m;
}
void mpmi_wait(mpmi_monitor *m, int32_t condition) {
  (void)m, (void)condition;
}
void mpmi_wake_one(mpmi_monitor *m, int32_t condition) {
  (void)m, (void)condition;
}
void mpmi_wake_all(mpmi_monitor *m, int32_t condition) {
  (void)m, (void)condition;
}
#endif

/* ---- the machine ---- */
#if !MPMI_POSIX && !MPMI_WINDOWS
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <time.h>

void *mpmi_system_alloc(size_t bytes, size_t alignment) {
  return bytes > SIZE_MAX - alignment ? NULL
                                      : aligned_alloc(alignment, (bytes + alignment - 1) & ~(alignment - 1));
}

void mpmi_system_release(void *memory, size_t bytes, size_t alignment) {
  (void)bytes, (void)alignment;
  free(memory);
}

int64_t mpmi_nanoseconds(void) {
  struct timespec now;
  timespec_get(&now, TIME_UTC);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

int64_t mpmi_process(void) {
  return 0; /* ISO C knows no processes that fork */
}
#endif

/* ---- files ---- */
#if !MPMI_HAS_FILES
int mpmi_replacement_open(mpmi_replacement *r, const char *path) {
  (void)r, (void)path;
  return MPMI_NO_FILES;
}

int mpmi_replacement_close(mpmi_replacement *r, int error, int32_t durable) {
  (void)r, (void)error, (void)durable;
  return MPMI_NO_FILES;
}

int mpmi_file_read(const char *path, FILE **file, int64_t *bytes) {
  (void)path, (void)file, (void)bytes;
  return MPMI_NO_FILES;
}

int mpmi_file_create(const char *path, FILE **file) {
  (void)path, (void)file;
  return MPMI_NO_FILES;
}

int mpmi_file_skip(FILE *file, int64_t bytes) {
  (void)file, (void)bytes;
  return MPMI_NO_FILES;
}

int mpmi_file_write_at(FILE *file, int64_t at, const void *data, size_t bytes) {
  (void)file, (void)at, (void)data, (void)bytes;
  return MPMI_NO_FILES;
}

int mpmi_file_cut(FILE *file, int64_t bytes) {
  (void)file, (void)bytes;
  return MPMI_NO_FILES;
}

void mpmi_error_text(int error, char *text, size_t capacity) {
  snprintf(text, capacity, "%s", mpmi_own_error(error) ? mpmi_own_error(error) : "unknown error");
}

#elif !MPMI_POSIX && !MPMI_WINDOWS
enum { ATTEMPTS = 100 };

static int error_number(void) {
  return errno ? errno : MPMI_STORAGE_FAILED;
}

/* ISO C knows neither links nor owners, modes nor locks: what a process leaves behind that dies stays. */
int mpmi_replacement_open(mpmi_replacement *r, const char *path) {
  const size_t length = strlen(path);
  if (length + sizeof ".tmp00" > MPMI_PATH) return MPMI_STORAGE_FAILED;
  memcpy(r->target, path, length + 1);
  memcpy(r->temporary, path, length);
  r->stream = NULL;
  for (int32_t k = 0; k < ATTEMPTS && !r->stream; ++k) {
    snprintf(r->temporary + length, MPMI_PATH - length, ".tmp%d", (int)k);
    errno = 0;
    r->stream = fopen(r->temporary, "wbx");
  }
  return r->stream ? 0 : error_number();
}

int mpmi_replacement_close(mpmi_replacement *r, int error, int32_t durable) {
  (void)durable;
  errno = 0;
  if (fclose(r->stream) && !error) error = error_number();
  errno = 0;
  if (!error && rename(r->temporary, r->target)) error = error_number();
  if (error) remove(r->temporary);
  return error;
}

int mpmi_file_read(const char *path, FILE **file, int64_t *bytes) {
  errno = 0;
  *file = fopen(path, "rb");
  if (!*file) return error_number();
  *bytes = fseek(*file, 0, SEEK_END) ? -1 : ftell(*file);
  if (*bytes < 0 || *bytes == LONG_MAX) { /* folders have that length */
    fclose(*file);
    return MPMI_NOT_REGULAR;
  }
  rewind(*file);
  return 0;
}

int mpmi_file_create(const char *path, FILE **file) {
  errno = 0;
  *file = fopen(path, "wb");
  return *file ? 0 : error_number();
}

int mpmi_file_skip(FILE *file, int64_t bytes) {
  errno = 0;
  for (; bytes > 0; bytes -= 1 << 30)
    if (fseek(file, bytes < 1 << 30 ? (long)bytes : 1L << 30, SEEK_CUR)) return error_number();
  return 0;
}

int mpmi_file_write_at(FILE *file, int64_t at, const void *data, size_t bytes) {
  errno = 0;
  if (at > LONG_MAX || fseek(file, (long)at, SEEK_SET) || fwrite(data, 1, bytes, file) != bytes ||
      fflush(file))
    return error_number();
  return 0;
}

int mpmi_file_cut(FILE *file, int64_t bytes) {
  (void)file, (void)bytes;
  return MPMI_STORAGE_FAILED; /* ISO C does not shorten files */
}

void mpmi_error_text(int error, char *text, size_t capacity) {
  const char *own = mpmi_own_error(error);
  snprintf(text, capacity, "%s", own ? own : strerror(error));
}
#endif
