/* What the test programs of libmpm-mpi share: checks on every process, and MPI that fails when it is told
 * to. */
#ifndef MEET_H
#define MEET_H

#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

/* A process for which something is not so says what, and ends all. */
#define MUST(that)                                                                                           \
  do {                                                                                                       \
    if (that) break;                                                                                         \
    int rank_ = -1;                                                                                          \
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank_);                                                                  \
    fprintf(stderr, "%s:%d: on process %d: %s\n", __FILE__, __LINE__, rank_, #that);                         \
    fflush(stderr);                                                                                          \
    MPI_Abort(MPI_COMM_WORLD, 1);                                                                            \
  } while (0)
#define MUST_SAY(text, words)                                                                                \
  do {                                                                                                       \
    if (strstr(text, words)) break;                                                                          \
    fprintf(stderr, "\"%s\" does not say \"%s\"\n", text, words);                                            \
    MUST(!"the sentence is another one");                                                                    \
  } while (0)

/* The calls of MPI that can be made to fail, by its profiling interface. */
typedef enum faulty {
  NO_FAULT,
  F_COMM_DUP,
  F_BCAST,
  F_ALLREDUCE,
  F_ALLGATHER,
  F_ISEND,
  F_IRECV,
  F_ISSEND,
  F_IPROBE,
  F_IBARRIER,
  F_TESTSOME,
  F_GET_ELEMENTS,
  F_FILE_OPEN,
  F_FILE_WRITE,
  F_FILE_READ,
  F_FILE_SYNC,
  F_FILE_CLOSE,
  F_COMM_SPLIT,
  FAULTS
} faulty;

/* Of that call the next but `after` fails, without having done anything. */
void fail_in(faulty call, int after);
/* Whether it has. */
int has_failed(void);
/* What MPI_Get_version() says; 0: the truth. */
extern int pretended_version;
/* What is added to mpm_version(). */
extern unsigned pretended_later;

#endif
