#define _GNU_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */
#include "processes.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum {
  SLOT_BYTES = 1 << 25, /* of address space; memory is taken as it is used */
  VALUES = 1 << 20,
  PATIENCE = 600 /* seconds: a part may compute for long, on a busy machine */
};

/* From one process to another. There are two, for a process may be one exchange ahead of the other. */
typedef struct slot {
  int32_t full, exchange;
  int64_t round, bytes;
  _Alignas(64) unsigned char data[SLOT_BYTES];
} slot;

/* What the processes bring to a collective call. */
typedef struct meeting {
  int64_t arrived; /* since the beginning, so that nobody has to begin anew */
  int64_t values[VALUES];
} meeting;

typedef struct arena {
  pthread_mutex_t lock;
  pthread_cond_t changed;
  int32_t parts, broken;
  meeting meeting[2];
  slot way[PROCESSES_MOST][PROCESSES_MOST][2]; /* [to][from] */
} arena;

static struct {
  arena *all;
  int32_t part;
  mpm_transport transport;
  int64_t round;                                       /* collective calls that have begun */
  int64_t sent[PROCESSES_MOST], taken[PROCESSES_MOST]; /* messages to and from each of the others */
  int32_t exchange, partners, partner[PROCESSES_MOST];
  int32_t received;
  mpm_message in[PROCESSES_MOST];
} here;

static mpm_status fail(const char *why) {
  if (!here.all->broken) fprintf(stderr, "part %d: %s\n", (int)here.part, why);
  here.all->broken = 1;
  pthread_cond_broadcast(&here.all->changed);
  return MPM_E_CALLBACK;
}

static void lock(void) {
  pthread_mutex_lock(&here.all->lock);
}

static mpm_status leave(mpm_status status) {
  pthread_mutex_unlock(&here.all->lock);
  return status;
}

static mpm_status sleep_here(void) {
  struct timespec until;
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_sec += PATIENCE;
  if (here.all->broken) return MPM_E_CALLBACK;
  if (pthread_cond_timedwait(&here.all->changed, &here.all->lock, &until)) return fail("waits for ever");
  return here.all->broken ? MPM_E_CALLBACK : MPM_OK;
}

/* Two exchanges on, everybody has taken what lay here. */
static void forget_received(void) {
  for (int32_t i = 0; i < here.received; ++i) {
    const int32_t from = here.in[i].part;
    here.all->way[here.part][from][(here.taken[from] - 1) & 1].full = 0;
  }
  here.received = 0;
}

static mpm_status put(int32_t exchange, const mpm_message *out) {
  slot *s = &here.all->way[out->part][here.part][here.sent[out->part]++ & 1];
  if (s->full) return fail("sends more than anybody takes");
  if (out->bytes > SLOT_BYTES) return fail("sends too long a message");
  if (out->bytes) memcpy(s->data, out->data, (size_t)out->bytes);
  s->full = 1, s->exchange = exchange, s->round = here.round, s->bytes = out->bytes;
  return MPM_OK;
}

static mpm_status send_to(void *user, int32_t exchange, int32_t count, const mpm_message *out,
                          const int64_t *most) {
  mpm_status status = MPM_OK;
  (void)user, (void)most;
  lock();
  forget_received();
  here.exchange = exchange;
  here.partners = count;
  for (int32_t i = 0; i < count && !status; ++i) {
    here.partner[i] = out[i].part;
    status = put(exchange, &out[i]);
  }
  if (exchange == MPM_EXCHANGE_SPARSE) ++here.all->meeting[here.round & 1].arrived;
  pthread_cond_broadcast(&here.all->changed);
  return leave(status);
}

/* All have come to this collective call. */
static mpm_status wait_for_all(void) {
  const meeting *m = &here.all->meeting[here.round & 1];
  const int64_t due = (here.round / 2 + 1) * here.all->parts;
  mpm_status status = MPM_OK;
  while (!status && m->arrived < due) status = sleep_here();
  return status;
}

static mpm_status take(int32_t from) {
  slot *s = &here.all->way[here.part][from][here.taken[from]++ & 1];
  if (s->exchange != here.exchange) return fail("receives what is of another exchange");
  here.in[here.received++] = (mpm_message){.part = from, .bytes = s->bytes, .data = s->data};
  return MPM_OK;
}

/* Something of this exchange lies here; of sparse ones another process may be one ahead. */
static int32_t comes_from(int32_t from) {
  const slot *s = &here.all->way[here.part][from][here.taken[from] & 1];
  return s->full &&
         (here.exchange == MPM_EXCHANGE_KNOWN || (s->exchange == here.exchange && s->round == here.round));
}

static mpm_status receive_from(void *user, int32_t *count, const mpm_message **in) {
  mpm_status status = MPM_OK;
  (void)user;
  lock();
  if (here.exchange == MPM_EXCHANGE_KNOWN) {
    for (int32_t i = 0; i < here.partners && !status; ++i) {
      while (!status && !comes_from(here.partner[i])) status = sleep_here();
      if (!status) status = take(here.partner[i]);
    }
  } else {
    status = wait_for_all();
    for (int32_t from = 0; from < here.all->parts && !status; ++from)
      if (comes_from(from)) status = take(from);
    ++here.round;
  }
  *count = here.received;
  *in = here.in;
  return leave(status);
}

/* Comes to a collective call with values, and waits; *all is where those of all have come together. */
static mpm_status meet(int32_t op, int64_t count, int64_t first, const int64_t *values, int64_t **all) {
  meeting *m = &here.all->meeting[here.round & 1];
  const int32_t is_first = m->arrived == here.round / 2 * here.all->parts;
  if (first + count > VALUES) return fail("brings too many values");
  for (int64_t i = 0; i < count; ++i) {
    int64_t *value = &m->values[first + i];
    if (!op || is_first)
      *value = values[i];
    else if (op == MPM_REDUCE_SUM)
      *value = (int64_t)((uint64_t)*value + (uint64_t)values[i]);
    else if (*value < values[i])
      *value = values[i];
  }
  ++m->arrived;
  pthread_cond_broadcast(&here.all->changed);
  const mpm_status status = wait_for_all();
  ++here.round;
  *all = m->values;
  return status;
}

static mpm_status reduce_all(void *user, int32_t op, int64_t count, int64_t *values) {
  int64_t *all = NULL;
  (void)user;
  lock();
  const mpm_status status = meet(op, count, 0, values, &all);
  if (!status && count) memcpy(values, all, (size_t)count * sizeof *values);
  return leave(status);
}

static mpm_status gather_all(void *user, int64_t value, int64_t *into) {
  int64_t *all = NULL;
  (void)user;
  lock();
  const mpm_status status = meet(0, 1, here.part, &value, &all);
  if (!status) memcpy(into, all, (size_t)here.all->parts * sizeof *into);
  return leave(status);
}

static arena *make_arena(int32_t n) {
  arena *a = mmap(NULL, sizeof *a, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  pthread_mutexattr_t of_lock;
  pthread_condattr_t of_changed;
  if (a == MAP_FAILED) return NULL;
  pthread_mutexattr_init(&of_lock);
  pthread_condattr_init(&of_changed);
  pthread_mutexattr_setpshared(&of_lock, PTHREAD_PROCESS_SHARED);
  pthread_condattr_setpshared(&of_changed, PTHREAD_PROCESS_SHARED);
  pthread_mutex_init(&a->lock, &of_lock);
  pthread_cond_init(&a->changed, &of_changed);
  a->parts = n;
  return a;
}

/* Ends all where one has come to an end that is not that of the others. */
static int wait_for_end(int32_t n, pid_t *child) {
  int first = -1, bad = 0;
  for (int32_t i = 0; i < n; ++i) {
    int now = 0;
    const pid_t ended = wait(&now);
    const int status = ended > 0 && WIFEXITED(now) ? WEXITSTATUS(now) : 3;
    bad |= status == 3 || (first >= 0 && status != first);
    first = status;
    for (int32_t k = 0; k < n; ++k) {
      if (child[k] == ended) child[k] = 0;
      if (bad && child[k]) kill(child[k], SIGKILL);
    }
  }
  return bad ? 3 : first;
}

const mpm_transport *processes_start(int32_t n, int *status) {
  pid_t child[PROCESSES_MOST];
  *status = 3;
  here.all = n > 0 && n <= PROCESSES_MOST ? make_arena(n) : NULL;
  if (!here.all) return NULL;
  for (int32_t i = 0; i < n; ++i) {
    child[i] = fork();
    if (child[i] < 0) {
      while (i-- > 0) kill(child[i], SIGKILL);
      return NULL;
    }
    if (child[i]) continue;
    here.part = i;
    here.transport = (mpm_transport){.struct_size = sizeof here.transport,
                                     .part = i,
                                     .parts = n,
                                     .send = send_to,
                                     .receive = receive_from,
                                     .reduce = reduce_all,
                                     .gather = gather_all};
    return &here.transport;
  }
  *status = wait_for_end(n, child);
  return NULL;
}
