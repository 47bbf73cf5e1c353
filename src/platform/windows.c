/* Windows, by mingw-w64 or clang. Paths are UTF-8 here and UTF-16 for the system. */
#include "platform/platform.h"

#if MPMI_WINDOWS
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <malloc.h>
#include <process.h>
#include <string.h>
#include <sys/stat.h>
#include <wchar.h>

/* ---- the machine ---- */
void *mpmi_system_alloc(size_t bytes, size_t alignment) {
  return _aligned_malloc(bytes, alignment);
}

void mpmi_system_release(void *memory, size_t bytes, size_t alignment) {
  (void)bytes, (void)alignment;
  _aligned_free(memory);
}

int64_t mpmi_nanoseconds(void) {
  LARGE_INTEGER ticks, per_second;
  QueryPerformanceCounter(&ticks);
  QueryPerformanceFrequency(&per_second);
  const int64_t seconds = ticks.QuadPart / per_second.QuadPart, rest = ticks.QuadPart % per_second.QuadPart;
  return seconds * 1000000000 + rest * 1000000000 / per_second.QuadPart;
}

int64_t mpmi_process(void) {
  return (int64_t)GetCurrentProcessId();
}

/* ---- threads ---- */
#if MPMI_HAS_THREADS
typedef struct windows_thread {
  HANDLE handle;
  void *(*body)(void *);
  void *argument;
} windows_thread;
typedef struct monitor {
  SRWLOCK lock;
  CONDITION_VARIABLE condition[2];
} monitor;
_Static_assert(sizeof(windows_thread) <= sizeof(mpmi_system_thread), "a thread needs more room");
_Static_assert(sizeof(monitor) <= sizeof(mpmi_monitor), "a monitor needs more room");

int32_t mpmi_processors(void) {
  SYSTEM_INFO info;
  GetSystemInfo(&info);
  return info.dwNumberOfProcessors < 1 ? 1 : (int32_t)info.dwNumberOfProcessors;
}

static unsigned __stdcall run_body(void *argument) {
  windows_thread *thread = argument;
  thread->body(thread->argument);
  return 0;
}

int32_t mpmi_thread_start(mpmi_system_thread *thread, void *(*body)(void *), void *argument) {
  windows_thread *t = (windows_thread *)(void *)thread;
  t->body = body;
  t->argument = argument;
  t->handle = (HANDLE)_beginthreadex(NULL, 0, run_body, t, 0, NULL);
  return t->handle != NULL;
}

void mpmi_thread_join(mpmi_system_thread *thread) {
  HANDLE handle = ((windows_thread *)(void *)thread)->handle;
  WaitForSingleObject(handle, INFINITE);
  CloseHandle(handle);
}

static monitor *windows_monitor(mpmi_monitor *m) {
  return (monitor *)(void *)m;
}

void mpmi_monitor_begin(mpmi_monitor *m) {
  InitializeSRWLock(&windows_monitor(m)->lock);
  for (int32_t k = 0; k < 2; ++k) InitializeConditionVariable(&windows_monitor(m)->condition[k]);
}

void mpmi_monitor_end(mpmi_monitor *m) {
  (void)m;
}

void mpmi_lock(mpmi_monitor *m) {
  AcquireSRWLockExclusive(&windows_monitor(m)->lock);
}

void mpmi_unlock(mpmi_monitor *m) {
  ReleaseSRWLockExclusive(&windows_monitor(m)->lock);
}

void mpmi_wait(mpmi_monitor *m, int32_t condition) {
  SleepConditionVariableSRW(&windows_monitor(m)->condition[condition], &windows_monitor(m)->lock, INFINITE,
                            0);
}

void mpmi_wake_one(mpmi_monitor *m, int32_t condition) {
  WakeConditionVariable(&windows_monitor(m)->condition[condition]);
}

void mpmi_wake_all(mpmi_monitor *m, int32_t condition) {
  WakeAllConditionVariable(&windows_monitor(m)->condition[condition]);
}
#endif

/* ---- files ---- */
#if MPMI_HAS_FILES
enum { ATTEMPTS = 100, SYSTEM_ERROR = 1 << 24 };
static const DWORD share_all = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

/* The number of the system's last error, apart from those of the C library. */
static int system_error(void) {
  return SYSTEM_ERROR + (int)GetLastError();
}

static int widen(const char *path, wchar_t *wide) {
  return MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, MPMI_PATH) ? 0 : system_error();
}

static int narrow(const wchar_t *wide, char *path) {
  return WideCharToMultiByte(CP_UTF8, WC_ERR_INVALID_CHARS, wide, -1, path, MPMI_PATH, NULL, NULL)
             ? 0
             : system_error();
}

static HANDLE open_handle(const wchar_t *wide, DWORD access, DWORD flags) {
  return CreateFileW(wide, access, share_all, NULL, OPEN_EXISTING, flags, NULL);
}

/* Where a path leads, links followed; a path that leads to nothing stays as it is. */
static int follow_links(const char *path, char *target) {
  wchar_t wide[MPMI_PATH];
  int error = widen(path, wide);
  if (error) return error;
  HANDLE old = open_handle(wide, FILE_READ_ATTRIBUTES, FILE_FLAG_BACKUP_SEMANTICS);
  if (old == INVALID_HANDLE_VALUE) return narrow(wide, target);
  BY_HANDLE_FILE_INFORMATION info;
  const DWORD other = FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_DEVICE;
  if (GetFileType(old) != FILE_TYPE_DISK ||
      (GetFileInformationByHandle(old, &info) && info.dwFileAttributes & other)) {
    error = MPMI_NOT_REGULAR;
  } else {
    const DWORD length = GetFinalPathNameByHandleW(old, wide, MPMI_PATH, FILE_NAME_NORMALIZED);
    error = length && length < MPMI_PATH ? narrow(wide, target) : system_error();
  }
  CloseHandle(old);
  return error;
}

/* The lock is on a byte behind all that is written. */
static BOOL lock_handle(HANDLE file) {
  OVERLAPPED at;
  memset(&at, 0, sizeof at);
  at.OffsetHigh = 0x7fffffff;
  return LockFileEx(file, LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY, 0, 1, 0, &at);
}

/* Removes the temporary file of a writer that has died, if there is one under this name. */
static void remove_abandoned(const wchar_t *wide) {
  HANDLE file = open_handle(wide, GENERIC_READ | GENERIC_WRITE, 0);
  if (file == INVALID_HANDLE_VALUE) return;
  if (lock_handle(file)) DeleteFileW(wide);
  CloseHandle(file);
}

static int descriptor_of(const wchar_t *wide, int flags, FILE **stream) {
  const int file = _wopen(wide, flags | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE);
  if (file < 0) return errno;
  *stream = _fdopen(file, flags & (_O_WRONLY | _O_RDWR) ? "wb" : "rb");
  if (*stream) return 0;
  const int error = errno;
  _close(file);
  return error;
}

int mpmi_replacement_open(mpmi_replacement *r, const char *path) {
  int error = follow_links(path, r->target);
  if (error) return error;
  const size_t length = strlen(r->target);
  if (length + sizeof ".tmp00" > MPMI_PATH) return ENAMETOOLONG;
  memcpy(r->temporary, r->target, length + 1);
  wchar_t wide[MPMI_PATH];
  for (int32_t k = 0; k < ATTEMPTS; ++k) {
    snprintf(r->temporary + length, MPMI_PATH - length, ".tmp%d", (int)k);
    error = widen(r->temporary, wide);
    if (error) return error;
    remove_abandoned(wide);
    error = descriptor_of(wide, _O_WRONLY | _O_CREAT | _O_EXCL, &r->stream);
    if (error == EEXIST || error == EACCES) continue; /* another writer has it */
    if (error) return error;
    HANDLE lock = open_handle(wide, GENERIC_READ | GENERIC_WRITE, 0);
    r->lock = (intptr_t)lock;
    if (lock != INVALID_HANDLE_VALUE && lock_handle(lock)) return 0;
    /* Between its creation and the lock another writer has taken the file for abandoned. */
    if (lock != INVALID_HANDLE_VALUE) CloseHandle(lock);
    fclose(r->stream);
  }
  return error ? error : EEXIST;
}

int mpmi_replacement_close(mpmi_replacement *r, int error, int32_t durable) {
  if (fflush(r->stream) && !error) error = errno;
  if (!error && durable && _commit(_fileno(r->stream))) error = errno;
  if (fclose(r->stream) && !error) error = errno;
  wchar_t from[MPMI_PATH], to[MPMI_PATH];
  int wrong = widen(r->temporary, from);
  if (!wrong) wrong = widen(r->target, to);
  if (!error) error = wrong;
  const DWORD how = MOVEFILE_REPLACE_EXISTING | (durable ? MOVEFILE_WRITE_THROUGH : 0);
  if (!error && !MoveFileExW(from, to, how)) error = system_error();
  if (error && !wrong) DeleteFileW(from);
  CloseHandle((HANDLE)r->lock);
  return error;
}

int mpmi_file_read(const char *path, FILE **file, int64_t *bytes) {
  wchar_t wide[MPMI_PATH];
  int error = widen(path, wide);
  if (error) return error;
  struct _stati64 info;
  if (_wstati64(wide, &info)) return errno;
  if (!(info.st_mode & _S_IFREG)) return MPMI_NOT_REGULAR;
  error = descriptor_of(wide, _O_RDONLY, file);
  if (!error) *bytes = _filelengthi64(_fileno(*file));
  return error;
}

int mpmi_file_create(const char *path, FILE **file) {
  wchar_t wide[MPMI_PATH];
  const int error = widen(path, wide);
  return error ? error : descriptor_of(wide, _O_WRONLY | _O_CREAT | _O_TRUNC, file);
}

int mpmi_file_skip(FILE *file, int64_t bytes) {
  return _fseeki64(file, bytes, SEEK_CUR) ? errno : 0;
}

int mpmi_file_write_at(FILE *file, int64_t at, const void *data, size_t bytes) {
  const char *from = data;
  if (_lseeki64(_fileno(file), at, SEEK_SET) < 0) return errno;
  while (bytes) {
    const int written = _write(_fileno(file), from, bytes < 1u << 30 ? (unsigned)bytes : 1u << 30);
    if (written <= 0) return written ? errno : MPMI_STORAGE_FAILED;
    from += written;
    bytes -= (size_t)written;
  }
  return 0;
}

int mpmi_file_cut(FILE *file, int64_t bytes) {
  return _chsize_s(_fileno(file), bytes);
}

void mpmi_error_text(int error, char *text, size_t capacity) {
  const char *own = mpmi_own_error(error);
  if (own) {
    snprintf(text, capacity, "%s", own);
  } else if (error < SYSTEM_ERROR) {
    if (strerror_s(text, capacity, error)) snprintf(text, capacity, "error %d", error);
  } else {
    wchar_t wide[256] = L"";
    const DWORD flags =
        FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS | FORMAT_MESSAGE_MAX_WIDTH_MASK;
    FormatMessageW(flags, NULL, (DWORD)(error - SYSTEM_ERROR), 0, wide, 256, NULL);
    if (!*wide || !WideCharToMultiByte(CP_UTF8, 0, wide, -1, text, (int)capacity, NULL, NULL))
      snprintf(text, capacity, "error %d of the system", error - SYSTEM_ERROR);
  }
}
#endif
#endif
