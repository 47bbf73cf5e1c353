/* What the library needs of the system beyond ISO C11: aligned memory, processors, a clock, threads, files
 * that appear whole. Nothing outside this folder includes a header of an operating system.
 *
 * posix.c and windows.c serve these systems; none.c gives what is left: everything by ISO C alone where the
 * system is neither, no threads with MPM_NO_THREADS, no files with MPM_NO_FILES. Each is compiled everywhere
 * and is empty where it does not apply. */
#ifndef MPMI_PLATFORM_H
#define MPMI_PLATFORM_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#if defined(MPM_NO_SYSTEM) || defined(__wasi__)
#define MPMI_POSIX   0
#define MPMI_WINDOWS 0
#elif defined(_WIN32)
#define MPMI_POSIX   0
#define MPMI_WINDOWS 1
#else
#define MPMI_POSIX   1
#define MPMI_WINDOWS 0
#endif
#if defined(MPM_NO_THREADS) || !(MPMI_POSIX || MPMI_WINDOWS)
#define MPMI_HAS_THREADS 0
#else
#define MPMI_HAS_THREADS 1
#endif
#if defined(MPM_NO_FILES)
#define MPMI_HAS_FILES 0
#else
#define MPMI_HAS_FILES 1
#endif

/* ---- the machine ---- */
/* Memory at a multiple of alignment, a power of two; NULL where there is none. It is released with the same
 * bytes and alignment. */
void *mpmi_system_alloc(size_t bytes, size_t alignment);
void mpmi_system_release(void *memory, size_t bytes, size_t alignment);
int32_t mpmi_processors(void); /* at least 1; 1 where there are no threads */
/* 1 for processors that work on registers of 512 bits, if they have any, in two steps of 256, as Zen 4 does
 * (processor.c). */
int32_t mpmi_works_by_halves(void);
int64_t mpmi_nanoseconds(void); /* of a clock that only goes forward, where the system has one */
/* Differs between a process and those that it forks. */
int64_t mpmi_process(void);

/* ---- threads ---- */
/* Room for the system's own types, whose headers stay out of this one. */
typedef union mpmi_system_thread {
  void *align;
  unsigned char room[32];
} mpmi_system_thread;
/* A lock and two conditions to wait for under it. */
typedef union mpmi_monitor {
  void *align;
  int64_t align_integers;
  unsigned char room[192];
} mpmi_monitor;
enum { MPMI_WORK, MPMI_DONE };

/* Starts a thread that takes no signals. Thread and argument stay where they are until it ends. Returns
 * whether there is one. */
int32_t mpmi_thread_start(mpmi_system_thread *thread, void *(*body)(void *), void *argument);
void mpmi_thread_join(mpmi_system_thread *thread);
void mpmi_monitor_begin(mpmi_monitor *monitor);
void mpmi_monitor_end(mpmi_monitor *monitor);
void mpmi_lock(mpmi_monitor *monitor);
void mpmi_unlock(mpmi_monitor *monitor);
void mpmi_wait(mpmi_monitor *monitor, int32_t condition); /* under the lock; may return for no reason */
void mpmi_wake_one(mpmi_monitor *monitor, int32_t condition);
void mpmi_wake_all(mpmi_monitor *monitor, int32_t condition);

/* ---- files ---- */
/* Paths are UTF-8. Errors are 0 or a number that mpmi_error_text() knows: the system's, or one of these. */
enum { MPMI_NO_FILES = -1, MPMI_NOT_REGULAR = -2, MPMI_STORAGE_FAILED = -3 };
enum { MPMI_PATH = 4096 };

/* A file that takes the place of another when it is complete. It is written beside it, under a name of its
 * own that is locked until then, so that what a process leaves behind that dies can be told from what another
 * one writes. */
typedef struct mpmi_replacement {
  FILE *stream;
  intptr_t lock;
  char target[MPMI_PATH];    /* where a path leads, links followed */
  char temporary[MPMI_PATH]; /* target and a suffix */
} mpmi_replacement;

/* Opens a file for a path. What earlier writers of this path left behind is removed if none of them lives. */
int mpmi_replacement_open(mpmi_replacement *file, const char *path);
/* Puts the file in its place, with the old one's mode and owner; or removes it, if there was an error. With
 * durable it waits for the storage. Returns the first error. */
int mpmi_replacement_close(mpmi_replacement *file, int error, int32_t durable);

int mpmi_file_read(const char *path, FILE **file,
                   int64_t *bytes);                  /* MPMI_NOT_REGULAR for devices and folders */
int mpmi_file_create(const char *path, FILE **file); /* takes away what an old one held */
int mpmi_file_skip(FILE *file, int64_t bytes);       /* leaves a gap of zeros */
/* These two pass by the stream's buffer. */
int mpmi_file_write_at(FILE *file, int64_t at, const void *data, size_t bytes);
int mpmi_file_cut(FILE *file, int64_t bytes);
void mpmi_error_text(int error, char *text, size_t capacity);
const char *mpmi_own_error(int error); /* of the three above; NULL for the system's */

#endif
