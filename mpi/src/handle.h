/* What the files of libmpm-mpi share: the handle, its memory and its sentences. Names begin with mpmx_. */
#ifndef MPMX_HANDLE_H
#define MPMX_HANDLE_H

#include <mpm/mpm_mpi.h>

#include <stddef.h>
#include <stdint.h>

enum { MPMX_TEXT = 512, MPMX_ALIGNMENT = 64 };

/* Tags on the duplicate. Sparse exchanges have two in turn, because a process may be one ahead. */
enum { MPMX_TAG_KNOWN = 1, MPMX_TAG_SPARSE = 2, MPMX_TAG_STREAM = 4 };

/* Memory that grows; what it holds is lost when it does, but where a function says otherwise. */
typedef struct mpmx_buffer {
  void *data;
  size_t bytes;
} mpmx_buffer;

/* The exchange under way, and the messages of the last one. */
typedef struct mpmx_exchange {
  int32_t kind;         /* MPM_EXCHANGE_..., or 0 */
  int32_t known, sends; /* requests: first what is received of known partners, then what is sent */
  mpmx_buffer requests; /* MPI_Request */
  mpmx_buffer statuses; /* MPI_Status, as many */
  mpmx_buffer indices;  /* int, as many */
  mpmx_buffer in; /* mpm_message; data of known partners are in the arena, others have memory of their own */
  int32_t count;  /* messages in `in` */
  int32_t owned;  /* 1: each message has memory of its own */
  mpmx_buffer arena;
  int32_t parity;          /* of sparse exchanges */
  int32_t open;            /* of known ones: requests that are not done */
  int32_t barrier_entered; /* of sparse ones: all that this part sent has been received */
  int32_t finished;        /* all is done */
  MPI_Request barrier;
} mpmx_exchange;

struct mpm_mpi {
  MPI_Comm comm;
  int32_t part, parts;
  mpm_transport transport;
  void *(*alloc)(void *user, size_t bytes, size_t alignment);
  void (*release)(void *user, void *memory, size_t bytes, size_t alignment);
  void *alloc_user;
  mpm_status failed; /* of the transport: every further call returns it */
  mpmx_exchange exchange;
  /* Those who give to one writer, for so many writers; -1: there is none yet. */
  int32_t group_writers, writer, writers;
  MPI_Comm group;
  char text[MPMX_TEXT];
};

void *mpmx_alloc(mpm_mpi *m, size_t bytes);
void mpmx_free(mpm_mpi *m, void *memory, size_t bytes);
/* Makes it at least so large. Returns MPM_E_NOMEM with a sentence. */
mpm_status mpmx_grow(mpm_mpi *m, mpmx_buffer *buffer, size_t bytes);
void mpmx_drop(mpm_mpi *m, mpmx_buffer *buffer);

/* Makes it the sentence of the handle, after the number of the part, and returns status. */
mpm_status mpmx_fail(mpm_mpi *m, mpm_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Returns MPM_OK for MPI_SUCCESS; else status, with the name of the call and what MPI says. */
mpm_status mpmx_mpi(mpm_mpi *m, int code, mpm_status status, const char *call);

/* One outcome for all (collective): that of the lowest part whose status is not MPM_OK, with its sentence. */
mpm_status mpmx_agree(mpm_mpi *m, mpm_status status);
/* The same for numbers that must be equal everywhere: status `unlike` and the sentence, if they are not. */
mpm_status mpmx_agree_on(mpm_mpi *m, mpm_status status, uint64_t number, mpm_status unlike,
                         const char *sentence);

uint64_t mpmx_hash(uint64_t hash, const void *data, size_t bytes);
enum { MPMX_HASH = 0x2b5f }; /* to start with */

/* A type and a count for so many bytes, which may be more than an int counts. */
typedef struct mpmx_type {
  MPI_Datatype type;
  int count, made;
} mpmx_type;
int mpmx_type_make(int64_t bytes, mpmx_type *out);
void mpmx_type_free(mpmx_type *type);
/* More bytes than these are no single count. Tests make it small. */
#ifndef MPMX_PIECE
#define MPMX_PIECE (1 << 30)
#endif

/* The transport. */
mpm_status mpmx_send(void *user, int32_t exchange, int32_t count, const mpm_message *out,
                     const int64_t *most);
mpm_status mpmx_receive(void *user, int32_t *count, const mpm_message **in);
mpm_status mpmx_reduce(void *user, int32_t op, int64_t count, int64_t *values);
mpm_status mpmx_gather(void *user, int64_t value, int64_t *all);
void mpmx_poll(void *user);
/* Ends what a failure has left under way. */
void mpmx_exchange_free(mpm_mpi *m);

#endif
