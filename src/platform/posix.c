/* POSIX: Linux, macOS, the BSDs, and Emscripten. */
#define _POSIX_C_SOURCE   200809L
#define _DEFAULT_SOURCE   1 /* flock, madvise and the number of processors, which POSIX does not have */
#define _DARWIN_C_SOURCE  1
#define _NETBSD_SOURCE    1
#define __BSD_VISIBLE     1
#define _FILE_OFFSET_BITS 64
#include "platform/platform.h"

#if MPMI_POSIX
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#if MPMI_HAS_THREADS
#include <pthread.h>
#include <signal.h>
#endif

/* ---- the machine ---- */
/* Large arrays lie in large pages where the system has them, because a step walks along dozens of arrays at a
 * time, more than a processor's table of small pages holds. Large pages are asked for where the array fills
 * them, so that it takes no more memory than with small ones. All would begin at the same address within a
 * page, and their streams meet in the same sets of the caches: each begins some lines later, by its page. */
enum { LARGE_PAGE = 1 << 21, LINE = 64, STAGGER = 32 * LINE };

static int32_t is_large(size_t bytes, size_t alignment) {
  return bytes >= LARGE_PAGE && alignment <= LINE;
}

void *mpmi_system_alloc(size_t bytes, size_t alignment) {
  void *memory;
  if (!is_large(bytes, alignment)) return posix_memalign(&memory, alignment, bytes) ? NULL : memory;
  if (posix_memalign(&memory, LARGE_PAGE, bytes + STAGGER)) return NULL;
#if defined(MADV_HUGEPAGE)
  (void)madvise(memory, bytes / LARGE_PAGE * LARGE_PAGE, MADV_HUGEPAGE); /* a wish, which may fail */
#endif
  const uintptr_t page = (uintptr_t)memory / LARGE_PAGE, lines = 1 + page * 5 % (STAGGER / LINE - 1);
  char *start = (char *)memory + LINE * lines;
  memcpy(start - sizeof memory, &memory, sizeof memory);
  return start;
}

void mpmi_system_release(void *memory, size_t bytes, size_t alignment) {
  if (memory && is_large(bytes, alignment)) memcpy(&memory, (char *)memory - sizeof memory, sizeof memory);
  free(memory);
}

int64_t mpmi_nanoseconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

int64_t mpmi_process(void) {
  return (int64_t)getpid();
}

/* ---- threads ---- */
#if MPMI_HAS_THREADS
typedef struct monitor {
  pthread_mutex_t mutex;
  pthread_cond_t condition[2];
} monitor;
_Static_assert(sizeof(monitor) <= sizeof(mpmi_monitor), "a monitor needs more room");
_Static_assert(_Alignof(monitor) <= _Alignof(mpmi_monitor), "a monitor needs more alignment");
_Static_assert(sizeof(pthread_t) <= sizeof(mpmi_system_thread), "a thread needs more room");

int32_t mpmi_processors(void) {
  const long processors = sysconf(_SC_NPROCESSORS_ONLN);
  return processors < 1 ? 1 : processors > INT32_MAX ? INT32_MAX : (int32_t)processors;
}

int32_t mpmi_thread_start(mpmi_system_thread *thread, void *(*body)(void *), void *argument) {
  /* Signals belong to the host's threads: a new one inherits a mask that blocks them all. */
  sigset_t all, old;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &old);
  const int error = pthread_create((pthread_t *)(void *)thread, NULL, body, argument);
  pthread_sigmask(SIG_SETMASK, &old, NULL);
  return !error;
}

void mpmi_thread_join(mpmi_system_thread *thread) {
  pthread_join(*(pthread_t *)(void *)thread, NULL);
}

static monitor *posix_monitor(mpmi_monitor *m) {
  return (monitor *)(void *)m;
}

void mpmi_monitor_begin(mpmi_monitor *m) {
  pthread_mutex_init(&posix_monitor(m)->mutex, NULL);
  for (int32_t k = 0; k < 2; ++k) pthread_cond_init(&posix_monitor(m)->condition[k], NULL);
}

void mpmi_monitor_end(mpmi_monitor *m) {
  for (int32_t k = 0; k < 2; ++k) pthread_cond_destroy(&posix_monitor(m)->condition[k]);
  pthread_mutex_destroy(&posix_monitor(m)->mutex);
}

void mpmi_lock(mpmi_monitor *m) {
  pthread_mutex_lock(&posix_monitor(m)->mutex);
}

void mpmi_unlock(mpmi_monitor *m) {
  pthread_mutex_unlock(&posix_monitor(m)->mutex);
}

void mpmi_wait(mpmi_monitor *m, int32_t condition) {
  pthread_cond_wait(&posix_monitor(m)->condition[condition], &posix_monitor(m)->mutex);
}

void mpmi_wake_one(mpmi_monitor *m, int32_t condition) {
  pthread_cond_signal(&posix_monitor(m)->condition[condition]);
}

void mpmi_wake_all(mpmi_monitor *m, int32_t condition) {
  pthread_cond_broadcast(&posix_monitor(m)->condition[condition]);
}
#endif

/* ---- files ---- */
#if MPMI_HAS_FILES
enum { ATTEMPTS = 100, MOST_LINKS = 40 };

/* Copies the path without the links that it ends in; what they lead to need not exist yet. Links among the
 * folders are the system's affair. */
static int follow_links(const char *path, char *target) {
  if (strlen(path) >= MPMI_PATH) return ENAMETOOLONG;
  strcpy(target, path);
  struct stat info;
  for (int32_t links = 0; !lstat(target, &info) && S_ISLNK(info.st_mode); ++links) {
    char next[MPMI_PATH];
    const ssize_t bytes = readlink(target, next, sizeof next - 1);
    if (bytes < 0) return errno;
    if (links == MOST_LINKS) return ELOOP;
    next[bytes] = '\0';
    const char *slash = strrchr(target, '/');
    const size_t folder = slash && *next != '/' ? (size_t)(slash + 1 - target) : 0;
    if (folder + (size_t)bytes >= MPMI_PATH) return ENAMETOOLONG;
    memcpy(target + folder, next, (size_t)bytes + 1);
  }
  return 0;
}

static int32_t leads_to(const char *name, int file) {
  struct stat named, opened;
  return !lstat(name, &named) && !fstat(file, &opened) && named.st_dev == opened.st_dev &&
         named.st_ino == opened.st_ino;
}

/* Emscripten says that it locks, and does not; and where it should make a second descriptor it opens the file
 * again as it was opened, O_EXCL included. */
#if defined(__EMSCRIPTEN__)
static int32_t lock(int file) {
  (void)file;
  errno = ENOLCK;
  return 0;
}
static int second_descriptor(int file, const char *name) {
  (void)file;
  return open(name, O_WRONLY | O_CLOEXEC);
}
#else
static int32_t lock(int file) {
  return !flock(file, LOCK_EX | LOCK_NB);
}
static int second_descriptor(int file, const char *name) {
  (void)name;
  return fcntl(file, F_DUPFD_CLOEXEC, 0);
}
#endif

/* Removes the temporary file of a writer that has died, if there is one under this name. While the lock is
 * held the name cannot come to lead to another file, because only who has the lock removes or renames. */
static void remove_abandoned(const char *name) {
  const int file = open(name, O_RDWR | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return;
  struct stat info;
  if (!fstat(file, &info) && S_ISREG(info.st_mode) && lock(file) && leads_to(name, file)) unlink(name);
  close(file);
}

/* Between its creation and this lock another writer may have taken the file for abandoned. Storage that knows
 * no locks gives none, and then no file of it is found abandoned either. */
static int32_t keep_for_me(int file, const char *name) {
  return lock(file) ? leads_to(name, file) : errno != EWOULDBLOCK;
}

static void name_temporary(mpmi_replacement *r, int32_t k) {
  const size_t length = strlen(r->target);
  snprintf(r->temporary + length, sizeof r->temporary - length, ".tmp%d", (int)k);
}

/* Creates a file under the first name that no other writer has; -1 where none can be had. */
static int create_temporary(mpmi_replacement *r, mode_t mode) {
  int file = -1;
  int32_t k = -1;
  while (file < 0 && ++k < ATTEMPTS) {
    name_temporary(r, k);
    remove_abandoned(r->temporary);
    file = open(r->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file < 0 && errno != EEXIST) return -1;
    if (file >= 0 && !keep_for_me(file, r->temporary)) {
      close(file);
      file = -1;
      errno = EEXIST;
    }
  }
  struct stat info;
  for (int32_t next = k + 1; next < ATTEMPTS;
       ++next) { /* of writers that wrote side by side with one that lived */
    name_temporary(r, next);
    if (lstat(r->temporary, &info)) break;
    remove_abandoned(r->temporary);
  }
  name_temporary(r, k);
  return file;
}

int mpmi_replacement_open(mpmi_replacement *r, const char *path) {
  int error = follow_links(path, r->target);
  if (error) return error;
  const size_t length = strlen(r->target);
  if (length + sizeof ".tmp00" > MPMI_PATH) return ENAMETOOLONG;
  memcpy(r->temporary, r->target, length + 1);
  struct stat old;
  const int32_t exists = !stat(r->target, &old);
  /* Renaming over a device or a pipe would put a file in its place. */
  if (exists && !S_ISREG(old.st_mode)) return MPMI_NOT_REGULAR;
  /* What is to have the old one's mode is nobody else's to read until it has it. */
  const int file = create_temporary(r, exists ? 0600 : 0666);
  if (file < 0) return errno;
  r->lock = second_descriptor(file, r->temporary); /* holds the lock when the stream is closed */
  r->stream = r->lock < 0 ? NULL : fdopen(file, "wb");
  if (r->stream) return 0;
  error = errno;
  unlink(r->temporary);
  close(file);
  if (r->lock >= 0) close((int)r->lock);
  return error;
}

/* Gives the new file the old one's owner, group and mode, as far as the system lets us. Where the group
 * cannot be kept, the new one gets no rights that all others do not have. */
static void keep_owner_and_mode(int file, const char *target) {
  struct stat from, now;
  if (stat(target, &from) || fstat(file, &now)) return;
  mode_t mode = from.st_mode & 07777;
  if ((from.st_uid != now.st_uid || from.st_gid != now.st_gid) && fchown(file, from.st_uid, from.st_gid)) {
    mode &= 0777;
    if (from.st_gid != now.st_gid && fchown(file, (uid_t)-1, from.st_gid))
      mode &= (mode_t)~070 | (mode & 07) << 3;
  }
  if (fchmod(file, mode)) {
    /* Storage without modes has none to keep. */
  }
}

/* The new name is on the storage once the folder is. Not every system offers that, so it is no error if it
 * fails. */
static void sync_folder(char *name) {
  char *slash = strrchr(name, '/');
  if (slash) slash[slash == name] = '\0';
  const int folder = open(slash ? name : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);
  close(folder);
}

int mpmi_replacement_close(mpmi_replacement *r, int error, int32_t durable) {
  if (fflush(r->stream) && !error) error = errno;
  if (!error) keep_owner_and_mode((int)r->lock, r->target);
  if (!error && durable && fsync((int)r->lock)) error = errno;
  if (fclose(r->stream) && !error) error = errno;
  if (!error && rename(r->temporary, r->target)) error = errno;
  if (error) unlink(r->temporary);
  close((int)r->lock);
  if (!error && durable) sync_folder(r->temporary);
  return error;
}

int mpmi_file_read(const char *path, FILE **file, int64_t *bytes) {
  const int opened = open(path, O_RDONLY | O_CLOEXEC);
  if (opened < 0) return errno;
  struct stat info;
  int error = fstat(opened, &info) ? errno : S_ISREG(info.st_mode) ? 0 : MPMI_NOT_REGULAR;
  *file = error ? NULL : fdopen(opened, "rb");
  if (!error && !*file) error = errno;
  if (error)
    close(opened);
  else
    *bytes = info.st_size;
  return error;
}

int mpmi_file_create(const char *path, FILE **file) {
  const int opened = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (opened < 0) return errno;
  *file = fdopen(opened, "wb");
  if (*file) return 0;
  const int error = errno;
  close(opened);
  return error;
}

int mpmi_file_skip(FILE *file, int64_t bytes) {
  if (!fseeko(file, bytes, SEEK_CUR)) return 0;
  return errno == EINVAL || errno == EOVERFLOW ? EFBIG : errno; /* a file cannot be that long */
}

int mpmi_file_write_at(FILE *file, int64_t at, const void *data, size_t bytes) {
  const char *from = data;
  while (bytes) {
    const ssize_t written = pwrite(fileno(file), from, bytes, at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written ? errno : EIO;
    from += written;
    at += written;
    bytes -= (size_t)written;
  }
  return 0;
}

int mpmi_file_cut(FILE *file, int64_t bytes) {
  return ftruncate(fileno(file), bytes) ? errno : 0;
}

void mpmi_error_text(int error, char *text, size_t capacity) {
  const char *own = mpmi_own_error(error);
  if (own)
    snprintf(text, capacity, "%s", own);
  else if (strerror_r(error, text, capacity))
    snprintf(text, capacity, "error %d", error);
}
#endif
#endif
