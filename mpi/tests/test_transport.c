/* The transport over MPI by itself, on any number of processes.
 *
 *   test_transport rounds [largest]   random exchanges, reductions, gatherings
 *   test_transport wrong              what is refused, and goes on
 *   test_transport open               what mpm_mpi_open() refuses; started without threads
 *   test_transport faults             calls of MPI that fail, memory that runs out
 *   test_transport most               more bytes than were announced
 *   test_transport long BYTES         one message of so many bytes each way
 *   test_transport dies               a process ends in an exchange: the others are ended by MPI */
#include <mpm/mpm_mpi.h>
#include <string.h>
#include <unistd.h>

#include "meet.h"
#include "transport_rounds.h"

typedef struct services {
  int64_t calls, fail_at, open; /* fail_at: from 1; 0: never */
  char log[600];
} services;

static void *take(void *user, size_t bytes, size_t alignment) {
  services *s = user;
  if (++s->calls == s->fail_at) return NULL;
  ++s->open;
  return aligned_alloc(alignment, bytes);
}

static void give_back(void *user, void *memory, size_t bytes, size_t alignment) {
  services *s = user;
  (void)bytes;
  (void)alignment;
  --s->open;
  free(memory);
}

static void keep_log(void *user, int32_t level, const char *text) {
  services *s = user;
  if (level == MPM_LOG_WARNING) snprintf(s->log, sizeof s->log, "%s", text);
}

static void describe(mpm_context_desc *desc, services *s) {
  *s = (services){0};
  MUST(!mpm_context_desc_init(desc, sizeof *desc));
  desc->alloc = take;
  desc->release = give_back;
  desc->alloc_user = s;
  desc->log = keep_log;
  desc->log_user = s;
}

static mpm_mpi *open_world(services *s, const mpm_transport **transport) {
  mpm_context_desc desc;
  mpm_mpi *mpi = NULL;
  describe(&desc, s);
  MUST(!mpm_mpi_open(MPI_COMM_WORLD, &desc, &mpi));
  MUST(mpi && desc.transport && !*s->log);
  *transport = desc.transport;
  MUST(!strcmp(mpm_mpi_last_error(mpi), ""));
  return mpi;
}

static void test_rounds(int64_t largest) {
  services s;
  const mpm_transport *t;
  mpm_mpi *mpi = open_world(&s, &t);
  int rank, size;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  MUST(t->part == rank && t->parts == size && t->struct_size == sizeof *t && t->poll);
  for (uint64_t seed = 0; seed < 4; ++seed) {
    char text[ROUNDS_TEXT] = "";
    const rounds_desc desc = {.seed = seed, .rounds = 60, .largest = seed % 2 ? 2000 : largest};
    const int failed = rounds_run(t, &desc, text);
    if (failed) fprintf(stderr, "%s: %s\n", text, mpm_mpi_last_error(mpi));
    MUST(!failed);
  }
  /* more values than a piece has, where pieces are small */
  enum { VALUES = 2500 };
  static int64_t values[VALUES];
  for (int64_t i = 0; i < VALUES; ++i) values[i] = i * (rank + 1);
  MUST(!t->reduce(t->user, MPM_REDUCE_MAX, VALUES, values));
  for (int64_t i = 0; i < VALUES; ++i) MUST(values[i] == i * size);
  for (int64_t i = 0; i < VALUES; ++i) values[i] = i + rank;
  MUST(!t->reduce(t->user, MPM_REDUCE_SUM, VALUES, values));
  for (int64_t i = 0; i < VALUES; ++i) MUST(values[i] == i * size + size * (size - 1) / 2);
  MUST(!mpm_mpi_close(mpi));
  MUST(s.open == 0 && s.calls > 0);
}

static void test_wrong(void) {
  services s;
  const mpm_transport *t;
  mpm_mpi *mpi = open_world(&s, &t);
  const int32_t other = t->part ? 0 : 1, pair = t->parts > 1 && t->part < 2;
  char data[] = "abc";
  mpm_message out[2] = {{.part = other, .bytes = 4, .data = data}, {.part = other, .bytes = 0}};
  int64_t most[2] = {4, 0}, value = 7, *all = calloc((size_t)t->parts, sizeof *all);
  int32_t count;
  const mpm_message *in;
  MUST(all);
#define REFUSED(status, call, words)                                                                         \
  do {                                                                                                       \
    MUST((call) == (status));                                                                                \
    MUST_SAY(mpm_mpi_last_error(mpi), words);                                                                \
  } while (0)
  REFUSED(MPM_E_STATE, t->receive(t->user, &count, &in), "receive: nothing was sent before");
  REFUSED(MPM_E_ARG, t->send(t->user, 3, 0, out, most), "exchange is 3");
  REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_KNOWN, -1, out, most), "-1 messages");
  REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_KNOWN, t->parts, out, most), "messages");
  REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_SPARSE, 0, out, most), "most belongs to known");
  if (t->parts > 1) {
    REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_KNOWN, 1, NULL, most), "out is NULL");
    REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_KNOWN, 1, out, NULL), "most belongs to known");
    out[0].part = t->part;
    REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_KNOWN, 1, out, most), "message 0 is for part");
    out[0].part = t->parts;
    REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_KNOWN, 1, out, most), "message 0 is for part");
    out[0].part = -1;
    REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_KNOWN, 1, out, most), "message 0 is for part -1");
    out[0].part = other;
    out[0].bytes = -1;
    REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_SPARSE, 1, out, NULL), "-1 bytes");
    out[0].bytes = 4;
    out[0].data = NULL;
    REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_SPARSE, 1, out, NULL), "4 bytes for part");
    out[0].data = data;
    most[0] = -1;
    REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_KNOWN, 1, out, most), "4 bytes for part");
    most[0] = 4;
  }
  if (t->parts > 2)
    REFUSED(MPM_E_ARG, t->send(t->user, MPM_EXCHANGE_KNOWN, 2, out, most), "message 1 is for part");
  REFUSED(MPM_E_ARG, t->reduce(t->user, 3, 1, &value), "op 3");
  REFUSED(MPM_E_ARG, t->reduce(t->user, MPM_REDUCE_MAX, -1, &value), "-1 values");
  REFUSED(MPM_E_ARG, t->reduce(t->user, MPM_REDUCE_SUM, 1, NULL), "values is NULL");
  REFUSED(MPM_E_ARG, t->gather(t->user, 1, NULL), "all is NULL");
  /* after all that the exchange is as it would have been */
  MUST(!t->send(t->user, MPM_EXCHANGE_KNOWN, pair, out, most));
  REFUSED(MPM_E_STATE, t->send(t->user, MPM_EXCHANGE_KNOWN, pair, out, most), "has not been received");
  REFUSED(MPM_E_STATE, t->reduce(t->user, MPM_REDUCE_MAX, 1, &value), "has not been received");
  REFUSED(MPM_E_STATE, t->gather(t->user, 1, all), "has not been received");
  REFUSED(MPM_E_STATE, mpm_mpi_close(mpi), "has not been received");
  REFUSED(MPM_E_ARG, t->receive(t->user, NULL, &in), "count or in is NULL");
  REFUSED(MPM_E_ARG, t->receive(t->user, &count, NULL), "count or in is NULL");
  MUST(!t->receive(t->user, &count, &in));
  MUST(count == pair && (!pair || !strcmp(in[0].data, "abc")));
  MUST(!t->reduce(t->user, MPM_REDUCE_SUM, 1, &value) && value == 7 * t->parts);
  MUST(!t->gather(t->user, t->part, all));
  for (int32_t i = 0; i < t->parts; ++i) MUST(all[i] == i);
  free(all);
  MUST(!mpm_mpi_close(mpi));
  MUST(!mpm_mpi_close(NULL));
  MUST_SAY(mpm_mpi_last_error(NULL), "error_text");
}

static void refuse_open(MPI_Comm comm, mpm_context_desc *desc, mpm_status status, const char *words) {
  char text[400] = "";
  mpm_mpi *mpi = (mpm_mpi *)desc;
  desc->error_text = text;
  desc->error_bytes = sizeof text;
  MUST(mpm_mpi_open(comm, desc, &mpi) == status);
  MUST(!mpi && !desc->transport);
  MUST_SAY(text, words);
  MUST_SAY(((const services *)desc->log_user)->log, words);
}

/* MPI_THREAD_SINGLE, as MPI_Init() gives. */
static void test_open(void) {
  services s;
  mpm_context_desc desc;
  mpm_mpi *mpi;
  int rank, size, level;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  MPI_Query_thread(&level);
  describe(&desc, &s);
  MUST(mpm_mpi_open(MPI_COMM_WORLD, NULL, &mpi) == MPM_E_ARG && !mpi);
  MUST(mpm_mpi_open(MPI_COMM_WORLD, &desc, NULL) == MPM_E_ARG);
  refuse_open(MPI_COMM_NULL, &desc, MPM_E_ARG, "MPI_COMM_NULL");
  desc.struct_size = offsetof(mpm_context_desc, transport);
  refuse_open(MPI_COMM_WORLD, &desc, MPM_E_ARG, "mpm_context_desc_init");
  desc.struct_size = sizeof desc;
  if (level == MPI_THREAD_SINGLE) {
    desc.concurrency = 2;
    refuse_open(MPI_COMM_WORLD, &desc, MPM_E_UNSUPPORTED, "part 0: concurrency is 2");
    /* one process is enough; the others hear of it */
    desc.concurrency = rank == size - 1 ? 0 : 1;
    char words[40];
    snprintf(words, sizeof words, "part %d: concurrency is 0", size - 1);
    refuse_open(MPI_COMM_WORLD, &desc, MPM_E_UNSUPPORTED, words);
    desc.concurrency = 1;
  }
  pretended_version = 2;
  refuse_open(MPI_COMM_WORLD, &desc, MPM_E_UNSUPPORTED, "MPI is version 2.");
  pretended_version = 0;
  if (size > 1) {
    pretended_later = rank == 1;
    refuse_open(MPI_COMM_WORLD, &desc, MPM_E_UNSUPPORTED, "part 1: this process runs libmpm 0x");
    pretended_later = 0;
    MPI_Comm half, between;
    MPI_Comm_split(MPI_COMM_WORLD, rank ? 1 : 0, 0, &half);
    MPI_Intercomm_create(half, 0, MPI_COMM_WORLD, rank ? 0 : 1, 9, &between);
    refuse_open(between, &desc, MPM_E_ARG, "intercommunicator");
    MPI_Comm_free(&between);
    MPI_Comm_free(&half);
  }
  s.fail_at = rank == size - 1 ? s.calls + 1 : 0;
  refuse_open(MPI_COMM_WORLD, &desc, MPM_E_NOMEM, "there is no memory");
  MUST(s.open == 0);
  /* the communicator of the host has kept its own handler of errors */
  MPI_Comm own;
  MPI_Errhandler is;
  MPI_Comm_dup(MPI_COMM_WORLD, &own);
  MUST(!mpm_mpi_open(own, &desc, &mpi));
  MPI_Comm_get_errhandler(own, &is);
  MUST(is == MPI_ERRORS_ARE_FATAL);
  MPI_Comm_free(&own);
  MUST(!mpm_mpi_close(mpi));
  MUST(!mpm_mpi_open_f(MPI_Comm_c2f(MPI_COMM_WORLD), &desc, &mpi));
  MUST(!mpm_mpi_close(mpi));
  MUST(s.open == 0);
}

/* One sparse exchange with the neighbour above, or a known one with both, and what else there is. Who fails
 * in a barrier before it has taken a message would let the sender wait: there are none then. */
static mpm_status make_calls(const mpm_transport *t, int32_t exchange, int32_t empty) {
  char data[100] = "";
  mpm_message out[2];
  int64_t most[2] = {100, 100}, value = 1, all[64];
  const int32_t up = (t->part + 1) % t->parts, down = (t->part + t->parts - 1) % t->parts;
  int32_t count = 0, got;
  const mpm_message *in;
  for (int32_t i = 0; i < t->parts && !empty; ++i)
    if (i != t->part && (i == up || (i == down && exchange == MPM_EXCHANGE_KNOWN)))
      out[count++] = (mpm_message){.part = i, .bytes = 100, .data = data};
  mpm_status status = t->send(t->user, exchange, count, out, exchange == MPM_EXCHANGE_KNOWN ? most : NULL);
  if (!status) t->poll(t->user);
  if (!status) status = t->receive(t->user, &got, &in);
  if (!status) status = t->reduce(t->user, MPM_REDUCE_MAX, 1, &value);
  return status ? status : t->gather(t->user, value, all);
}

static void test_faults(void) {
  static const struct {
    faulty call;
    int32_t exchange, pairs; /* pairs: only where there are other processes */
    const char *words;
  } faults[] = {{F_ISEND, MPM_EXCHANGE_KNOWN, 1, "MPI_Isend: "},
                {F_IRECV, MPM_EXCHANGE_KNOWN, 1, "MPI_Irecv: "},
                {F_TESTSOME, MPM_EXCHANGE_KNOWN, 1, "MPI_Testsome: "},
                {F_GET_ELEMENTS, MPM_EXCHANGE_KNOWN, 1, "MPI_Get_elements_x: "},
                {F_ISSEND, MPM_EXCHANGE_SPARSE, 1, "MPI_Isend: "},
                {F_IPROBE, MPM_EXCHANGE_SPARSE, 0, "MPI_Iprobe: "},
                {F_IBARRIER, MPM_EXCHANGE_SPARSE, 0, "MPI_Ibarrier: "},
                {F_ALLREDUCE, MPM_EXCHANGE_KNOWN, 0, "MPI_Iallreduce: "},
                {F_ALLGATHER, MPM_EXCHANGE_KNOWN, 0, "MPI_Iallgather: "}};
  services s;
  mpm_context_desc desc;
  describe(&desc, &s);
  fail_in(F_COMM_DUP, 0);
  refuse_open(MPI_COMM_WORLD, &desc, MPM_E_CALLBACK, "MPI_Comm_dup: ");
  for (int after = 0; after < 3; ++after) {
    fail_in(F_ALLREDUCE, after);
    refuse_open(MPI_COMM_WORLD, &desc, MPM_E_CALLBACK, "MPI_Allreduce: ");
  }
  fail_in(F_BCAST, 0);
  refuse_open(MPI_COMM_WORLD, &desc, MPM_E_CALLBACK, "MPI_Bcast: ");
  fail_in(NO_FAULT, 0);
  MUST(s.open == 0);
  for (size_t i = 0; i < sizeof faults / sizeof *faults; ++i) {
    const mpm_transport *t;
    mpm_mpi *mpi = open_world(&s, &t);
    if (t->parts > 1 || !faults[i].pairs) {
      fail_in(faults[i].call, 0);
      MUST(make_calls(t, faults[i].exchange, faults[i].call == F_IBARRIER) == MPM_E_CALLBACK);
      MUST(has_failed());
      fail_in(NO_FAULT, 0);
      MUST_SAY(mpm_mpi_last_error(mpi), faults[i].words);
      /* what comes after is refused without a wait */
      MUST(make_calls(t, MPM_EXCHANGE_KNOWN, 0) == MPM_E_CALLBACK);
      MUST_SAY(mpm_mpi_last_error(mpi), faults[i].words);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    MUST(!mpm_mpi_close(mpi));
    MUST(s.open == 0);
  }
  for (int32_t exchange = MPM_EXCHANGE_KNOWN; exchange <= MPM_EXCHANGE_SPARSE; ++exchange)
    for (int64_t at = 1, done = 0; !done; ++at) {
      const mpm_transport *t;
      mpm_mpi *mpi = open_world(&s, &t);
      s.fail_at = s.calls + at;
      const mpm_status status = make_calls(t, exchange, 0);
      MUST(status == (s.calls >= s.fail_at ? MPM_E_NOMEM : MPM_OK));
      if (status) MUST_SAY(mpm_mpi_last_error(mpi), "there is no memory for ");
      done = !status;
      MUST(!done || at > 4);
      MPI_Barrier(MPI_COMM_WORLD);
      MUST(!mpm_mpi_close(mpi));
      MUST(s.open == 0);
    }
}

static void test_most(void) {
  services s;
  const mpm_transport *t;
  mpm_mpi *mpi = open_world(&s, &t);
  char data[200] = "";
  const int64_t most = t->part ? 100 : 200;
  const mpm_message out = {.part = t->part ? 0 : 1, .bytes = t->part ? 10 : 101, .data = data};
  int32_t count;
  const mpm_message *in;
  const int32_t pair = t->parts > 1 && t->part < 2;
  /* MPICH asks this handler where an error belongs to several requests */
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  MUST(!t->send(t->user, MPM_EXCHANGE_KNOWN, pair, &out, &most));
  const mpm_status status = t->receive(t->user, &count, &in);
  if (t->part == 1) {
    MUST(status == MPM_E_CALLBACK);
    MUST_SAY(mpm_mpi_last_error(mpi), "part 1: MPI_Testsome: ");
  } else {
    MUST(!status && count == pair && (!pair || in[0].bytes == 10));
  }
  /* closing is not collective after a failure: so it is left */
  MPI_Barrier(MPI_COMM_WORLD);
}

static void test_long(int64_t bytes) {
  services s;
  const mpm_transport *t;
  mpm_mpi *mpi = open_world(&s, &t);
  MUST(t->parts == 2);
  unsigned char *data = malloc((size_t)bytes);
  MUST(data);
  for (int32_t exchange = MPM_EXCHANGE_KNOWN; exchange <= MPM_EXCHANGE_SPARSE; ++exchange) {
    for (int64_t i = 0; i < bytes; ++i) data[i] = (unsigned char)((i >> 20) + i + t->part + exchange);
    /* one way, so that there is memory for it */
    const int64_t sent = t->part ? 5 : bytes;
    const mpm_message out = {.part = 1 - t->part, .bytes = sent, .data = data};
    const int64_t most = t->part ? bytes : 5;
    int32_t count;
    const mpm_message *in;
    MUST(!t->send(t->user, exchange, 1, &out, exchange == MPM_EXCHANGE_KNOWN ? &most : NULL));
    MUST(!t->receive(t->user, &count, &in));
    MUST(count == 1 && in[0].bytes == (t->part ? bytes : 5));
    const unsigned char *got = in[0].data;
    for (int64_t i = 0; i < in[0].bytes; ++i)
      MUST(got[i] == (unsigned char)((i >> 20) + i + 1 - t->part + exchange));
  }
  free(data);
  MUST(!mpm_mpi_close(mpi));
}

static void test_dies(void) {
  services s;
  const mpm_transport *t;
  open_world(&s, &t);
  if (t->part == t->parts - 1) _exit(3);
  make_calls(t, MPM_EXCHANGE_SPARSE, 0);
  MUST(t->parts == 1);
}

int main(int argc, char **argv) {
  const char *what = argc > 1 ? argv[1] : "";
  int level = MPI_THREAD_SINGLE, rank;
  services s;
  mpm_context_desc desc;
  describe(&desc, &s);
  mpm_mpi *mpi;
  if (mpm_mpi_open(0, &desc, &mpi) != MPM_E_STATE || !strstr(s.log, "not started")) return 1;
  if (!strcmp(what, "open"))
    MPI_Init(&argc, &argv);
  else
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (!strcmp(what, "rounds"))
    test_rounds(argc > 2 ? atoll(argv[2]) : 1000000);
  else if (!strcmp(what, "wrong"))
    test_wrong();
  else if (!strcmp(what, "open"))
    test_open();
  else if (!strcmp(what, "faults"))
    test_faults();
  else if (!strcmp(what, "most"))
    test_most();
  else if (!strcmp(what, "long") && argc > 2)
    test_long(atoll(argv[2]));
  else if (!strcmp(what, "dies"))
    test_dies();
  else
    MUST(!"the first argument names a test");
  describe(&desc, &s);
  const int opened = mpm_mpi_open(MPI_COMM_WORLD, &desc, &mpi);
  MPI_Finalize();
  /* what was left open is freed all the same */
  if (opened || mpm_mpi_close(mpi) != MPM_E_STATE || s.open) return 1;
  if (mpm_mpi_open(MPI_COMM_WORLD, &desc, &mpi) != MPM_E_STATE || !strstr(s.log, "has ended")) return 1;
  return 0;
}
