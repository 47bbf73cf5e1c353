#include "meet.h"

#include <stdint.h>

static faulty call_that_fails = NO_FAULT;
static int calls_before, failed;
int pretended_version;
unsigned pretended_later;

void fail_in(faulty call, int after) {
  call_that_fails = call;
  calls_before = after;
  failed = 0;
}

int has_failed(void) {
  return failed;
}

/* MPI_THREAD_FUNNELED lets one thread call MPI, however many work for a part. */
static int fails(faulty call) {
  int is_main = 0;
  MUST(!PMPI_Is_thread_main(&is_main) && is_main);
  if (call != call_that_fails || failed || calls_before--) return 0;
  failed = 1;
  return 1;
}

uint32_t __real_mpm_version(void);
uint32_t __wrap_mpm_version(void);
uint32_t __wrap_mpm_version(void) {
  return __real_mpm_version() + pretended_later;
}

int MPI_Get_version(int *version, int *minor) {
  const int code = PMPI_Get_version(version, minor);
  if (pretended_version) *version = pretended_version;
  return code;
}

#define FAULTY(call, name, parameters, arguments)                                                            \
  int MPI_##name parameters {                                                                                \
    return fails(call) ? MPI_ERR_OTHER : PMPI_##name arguments;                                              \
  }

FAULTY(F_COMM_DUP, Comm_dup, (MPI_Comm c, MPI_Comm *d), (c, d))
FAULTY(F_COMM_SPLIT, Comm_split, (MPI_Comm c, int colour, int key, MPI_Comm *d), (c, colour, key, d))
FAULTY(F_BCAST, Bcast, (void *b, int n, MPI_Datatype t, int root, MPI_Comm c), (b, n, t, root, c))
FAULTY(F_ALLREDUCE, Allreduce, (const void *s, void *r, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c),
       (s, r, n, t, o, c))
FAULTY(F_ALLREDUCE, Iallreduce,
       (const void *s, void *r, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c, MPI_Request *q),
       (s, r, n, t, o, c, q))
FAULTY(F_ALLGATHER, Iallgather,
       (const void *s, int n, MPI_Datatype t, void *r, int rn, MPI_Datatype rt, MPI_Comm c, MPI_Request *q),
       (s, n, t, r, rn, rt, c, q))
FAULTY(F_ALLGATHER, Allgather,
       (const void *s, int n, MPI_Datatype t, void *r, int rn, MPI_Datatype rt, MPI_Comm c),
       (s, n, t, r, rn, rt, c))
FAULTY(F_ISEND, Isend, (const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request *r),
       (b, n, t, to, tag, c, r))
FAULTY(F_IRECV, Irecv, (void *b, int n, MPI_Datatype t, int from, int tag, MPI_Comm c, MPI_Request *r),
       (b, n, t, from, tag, c, r))
FAULTY(F_ISSEND, Issend, (const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request *r),
       (b, n, t, to, tag, c, r))
FAULTY(F_IPROBE, Iprobe, (int from, int tag, MPI_Comm c, int *flag, MPI_Status *s), (from, tag, c, flag, s))
FAULTY(F_IBARRIER, Ibarrier, (MPI_Comm c, MPI_Request *r), (c, r))
FAULTY(F_TESTSOME, Testsome, (int n, MPI_Request *r, int *done, int *i, MPI_Status *s), (n, r, done, i, s))
FAULTY(F_GET_ELEMENTS, Get_elements_x, (const MPI_Status *s, MPI_Datatype t, MPI_Count *n), (s, t, n))
FAULTY(F_FILE_OPEN, File_open, (MPI_Comm c, const char *path, int mode, MPI_Info i, MPI_File *f),
       (c, path, mode, i, f))
FAULTY(F_FILE_WRITE, File_write_at_all,
       (MPI_File f, MPI_Offset o, const void *b, int n, MPI_Datatype t, MPI_Status *s), (f, o, b, n, t, s))
FAULTY(F_FILE_READ, File_read_at_all,
       (MPI_File f, MPI_Offset o, void *b, int n, MPI_Datatype t, MPI_Status *s), (f, o, b, n, t, s))
FAULTY(F_FILE_SYNC, File_sync, (MPI_File f), (f))
FAULTY(F_FILE_CLOSE, File_close, (MPI_File * f), (f))
