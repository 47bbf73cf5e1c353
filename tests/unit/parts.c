#define _POSIX_C_SOURCE 200809L /* nanosleep */
#include "parts.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* A message on its way. The bytes follow at a multiple of 64. */
typedef struct packet {
  struct packet *next;
  int32_t exchange;
  int64_t round, bytes;
  void *memory; /* of malloc */
  unsigned char *data;
} packet;

typedef struct queue {
  packet *first, **last;
} queue;

typedef struct world world;

typedef struct member {
  world *all;
  int32_t part;
  mpm_transport transport;
  pthread_t thread;
  parts_fn fn;
  void *user;
  int64_t round; /* collective calls that are done; a sparse exchange is one of them */
  int64_t seen;  /* the change of the world at which this part found nothing to do; -1: it does not wait */
  int64_t failable;
  int32_t ended;
  /* the exchange under way: 0, or MPM_EXCHANGE_... */
  int32_t exchange, partners;
  int32_t partner[PARTS_MOST];
  int64_t most[PARTS_MOST];
  int32_t sent;
  mpm_message out[PARTS_MOST];
  uint64_t sum[PARTS_MOST];
  /* what the last exchange brought */
  int32_t received;
  mpm_message in[PARTS_MOST];
  packet *held[PARTS_MOST];
} member;

/* What the parts bring to a collective call. There are two, because a part may be one call ahead. */
typedef struct meeting {
  int64_t round;
  int32_t arrived, what;
  int64_t count, room;
  int64_t *values;
} meeting;

struct world {
  pthread_mutex_t lock;
  pthread_cond_t changed;
  int64_t change; /* how often something has happened that a part may wait for */
  int32_t parts, broken;
  meeting meetings[2];
  parts_plan *plan;
  member members[PARTS_MOST];
  queue way[PARTS_MOST][PARTS_MOST]; /* [to][from] */
};

enum { GATHERS = 16, REDUCES = 32, MEETS_SPARSE = 64 };

static void happen(world *w) {
  ++w->change;
  pthread_cond_broadcast(&w->changed);
}

__attribute__((format(printf, 2, 3))) static mpm_status fail(member *m, const char *format, ...) {
  world *w = m->all;
  if (!w->broken) {
    char text[PARTS_TEXT];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    snprintf(w->plan->text, sizeof w->plan->text, "part %d: %.180s", (int)m->part, text);
    w->broken = 1;
    happen(w);
  }
  return MPM_E_CALLBACK;
}

/* Sleeps until something happens. Where all parts that still run have found nothing to do since the last
 * change, there will be no other one. */
static mpm_status sleep_here(member *m) {
  world *w = m->all;
  m->seen = w->change;
  int32_t awake = 0;
  for (int32_t i = 0; i < w->parts; ++i) awake += !w->members[i].ended && w->members[i].seen != w->change;
  if (!awake) return fail(m, "waits for ever");
  pthread_cond_wait(&w->changed, &w->lock);
  m->seen = -1;
  return w->broken ? MPM_E_CALLBACK : 0;
}

static uint64_t mix(uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

static uint64_t sum_of(const void *data, int64_t bytes) {
  const unsigned char *byte = data;
  uint64_t sum = (uint64_t)bytes;
  for (int64_t i = 0; i < bytes; ++i) sum = (sum ^ byte[i]) * 0x100000001b3u;
  return sum;
}

/* Every call but poll begins here, and leaves with the lock held. */
static mpm_status begin(member *m, int32_t kind) {
  world *w = m->all;
  parts_plan *plan = w->plan;
  const int64_t call = ++plan->calls[m->part];
  if (plan->jitter > 0) {
    const uint64_t drawn = mix(mix(plan->seed + (uint64_t)m->part * 0x9e3779b97f4a7c15u) + (uint64_t)call);
    const struct timespec late = {.tv_nsec = 1000 * (long)(drawn % (uint64_t)(plan->jitter + 1))};
    nanosleep(&late, NULL);
  }
  pthread_mutex_lock(&w->lock);
  if (w->broken) return MPM_E_CALLBACK;
  if (m->part == plan->fail_part && plan->fail_kinds & kind && ++m->failable == plan->fail_at)
    return fail(m, "call %lld fails as planned", (long long)call);
  return 0;
}

static mpm_status leave(member *m, mpm_status status) {
  pthread_mutex_unlock(&m->all->lock);
  return status;
}

static void drop(packet *p) {
  /* who still reads it finds no plausible value */
  if (p->bytes) memset(p->data, 0xa5, (size_t)p->bytes);
  free(p->memory);
  free(p);
}

static void forget_received(member *m) {
  for (int32_t i = 0; i < m->received; ++i) drop(m->held[i]);
  m->received = 0;
}

/* Comes to a collective call; *out is where its values are. */
static mpm_status arrive(member *m, int32_t what, int64_t count, meeting **out) {
  world *w = m->all;
  meeting *here = &w->meetings[m->round & 1];
  *out = here;
  if (here->round != m->round) {
    if (here->room < count) {
      int64_t *grown = realloc(here->values, (size_t)count * sizeof *grown);
      if (!grown) return fail(m, "no memory");
      here->values = grown;
      here->room = count;
    }
    here->round = m->round;
    here->arrived = 0;
    here->what = what;
    here->count = count;
  }
  if (here->what != what || here->count != count)
    return fail(m, "collective call %lld is of kind %d with %lld values, elsewhere %d with %lld",
                (long long)m->round, (int)what, (long long)count, (int)here->what, (long long)here->count);
  return 0;
}

static void arrived(member *m, meeting *here) {
  ++here->arrived;
  happen(m->all);
}

static mpm_status wait_for_all(member *m, const meeting *here) {
  mpm_status status = 0;
  while (!status && here->arrived < m->all->parts) status = sleep_here(m);
  return status;
}

static mpm_status put(member *m, int32_t exchange, const mpm_message *out) {
  world *w = m->all;
  packet *p = malloc(sizeof *p);
  void *memory = malloc((size_t)out->bytes + 64);
  if (!p || !memory) {
    free(p);
    free(memory);
    return fail(m, "no memory");
  }
  unsigned char *data = memory;
  data += (64 - ((uintptr_t)data & 63)) & 63;
  *p = (packet){.exchange = exchange, .round = m->round, .bytes = out->bytes, .memory = memory, .data = data};
  if (out->bytes) memcpy(data, out->data, (size_t)out->bytes);
  queue *q = &w->way[out->part][m->part];
  *q->last = p;
  q->last = &p->next;
  ++w->plan->messages[m->part];
  w->plan->bytes[m->part] += out->bytes;
  return 0;
}

static mpm_status check_send(member *m, int32_t exchange, int32_t count, const mpm_message *out,
                             const int64_t *most) {
  if (m->exchange) return fail(m, "sends before it has received");
  if (exchange != MPM_EXCHANGE_KNOWN && exchange != MPM_EXCHANGE_SPARSE)
    return fail(m, "exchange %d", (int)exchange);
  if (count < 0 || count >= m->all->parts) return fail(m, "%d messages", (int)count);
  if (count && !out) return fail(m, "out is NULL");
  if (exchange == MPM_EXCHANGE_SPARSE ? !!most : count && !most) return fail(m, "most is wrong");
  for (int32_t i = 0; i < count; ++i) {
    const mpm_message *o = &out[i];
    if (o->part < 0 || o->part >= m->all->parts || o->part == m->part || (i && out[i - 1].part >= o->part))
      return fail(m, "message %d is for part %d", (int)i, (int)o->part);
    if (o->bytes < 0 || (o->bytes && !o->data) || o->reserved)
      return fail(m, "message for part %d has %lld bytes", (int)o->part, (long long)o->bytes);
    if (most && most[i] < 0) return fail(m, "at most %lld bytes", (long long)most[i]);
  }
  return 0;
}

static mpm_status send_to(void *user, int32_t exchange, int32_t count, const mpm_message *out,
                          const int64_t *most) {
  member *m = user;
  mpm_status status = begin(m, PARTS_SEND);
  if (status) return leave(m, status);
  forget_received(m);
  status = check_send(m, exchange, count, out, most);
  meeting *here = NULL;
  if (!status && exchange == MPM_EXCHANGE_SPARSE) status = arrive(m, MEETS_SPARSE, 0, &here);
  for (int32_t i = 0; i < count && !status; ++i) {
    m->out[i] = out[i];
    m->sum[i] = sum_of(out[i].data, out[i].bytes);
    if (most) m->most[i] = most[i];
    m->partner[i] = out[i].part;
    status = put(m, exchange, &out[i]);
  }
  if (status) return leave(m, status);
  m->exchange = exchange;
  m->sent = count;
  m->partners = exchange == MPM_EXCHANGE_KNOWN ? count : 0;
  if (here) arrived(m, here);
  happen(m->all);
  return leave(m, 0);
}

static mpm_status take(member *m, int32_t from) {
  queue *q = &m->all->way[m->part][from];
  packet *p = q->first;
  q->first = p->next;
  if (!q->first) q->last = &q->first;
  m->held[m->received] = p;
  m->in[m->received] = (mpm_message){.part = from, .bytes = p->bytes, .data = p->data};
  ++m->received;
  if (p->exchange != m->exchange)
    return fail(m, "part %d sent in exchange %d, here it is %d", (int)from, (int)p->exchange,
                (int)m->exchange);
  return 0;
}

static mpm_status take_known(member *m) {
  mpm_status status = 0;
  for (int32_t i = 0; i < m->partners && !status; ++i) {
    const queue *q = &m->all->way[m->part][m->partner[i]];
    while (!status && !q->first) status = sleep_here(m);
    if (!status) status = take(m, m->partner[i]);
    if (!status && m->in[i].bytes > m->most[i])
      status = fail(m, "part %d sent %lld bytes, at most %lld were expected", (int)m->partner[i],
                    (long long)m->in[i].bytes, (long long)m->most[i]);
  }
  return status;
}

static mpm_status take_sparse(member *m) {
  world *w = m->all;
  mpm_status status = wait_for_all(m, &w->meetings[m->round & 1]);
  for (int32_t from = 0; from < w->parts && !status; ++from) {
    const packet *p = w->way[m->part][from].first;
    if (p && p->exchange == MPM_EXCHANGE_SPARSE && p->round == m->round) status = take(m, from);
  }
  ++m->round;
  return status;
}

static mpm_status receive_from(void *user, int32_t *count, const mpm_message **in) {
  member *m = user;
  mpm_status status = begin(m, PARTS_RECEIVE);
  if (status) return leave(m, status);
  if (!m->exchange) return leave(m, fail(m, "receives without having sent"));
  status = m->exchange == MPM_EXCHANGE_KNOWN ? take_known(m) : take_sparse(m);
  for (int32_t i = 0; i < m->sent && !status; ++i)
    if (sum_of(m->out[i].data, m->out[i].bytes) != m->sum[i])
      status = fail(m, "data for part %d changed before they were received", (int)m->out[i].part);
  m->exchange = 0;
  *count = m->received;
  *in = m->in;
  return leave(m, status);
}

static mpm_status reduce_all(void *user, int32_t op, int64_t count, int64_t *values) {
  member *m = user;
  mpm_status status = begin(m, PARTS_REDUCE);
  if (status) return leave(m, status);
  if (m->exchange) return leave(m, fail(m, "reduces before it has received"));
  if ((op != MPM_REDUCE_MAX && op != MPM_REDUCE_SUM) || count < 0 || (count && !values))
    return leave(m, fail(m, "reduces %lld values by %d", (long long)count, (int)op));
  meeting *here;
  status = arrive(m, REDUCES + op, count, &here);
  if (status) return leave(m, status);
  for (int64_t i = 0; i < count; ++i) {
    int64_t *value = &here->values[i];
    if (!here->arrived)
      *value = values[i];
    else if (op == MPM_REDUCE_SUM)
      *value = (int64_t)((uint64_t)*value + (uint64_t)values[i]);
    else if (*value < values[i])
      *value = values[i];
  }
  arrived(m, here);
  status = wait_for_all(m, here);
  if (!status && count) memcpy(values, here->values, (size_t)count * sizeof *values);
  ++m->round;
  return leave(m, status);
}

static mpm_status gather_all(void *user, int64_t value, int64_t *all) {
  member *m = user;
  mpm_status status = begin(m, PARTS_GATHER);
  if (status) return leave(m, status);
  if (m->exchange) return leave(m, fail(m, "gathers before it has received"));
  if (!all) return leave(m, fail(m, "gathers into NULL"));
  meeting *here;
  status = arrive(m, GATHERS, m->all->parts, &here);
  if (status) return leave(m, status);
  here->values[m->part] = value;
  arrived(m, here);
  status = wait_for_all(m, here);
  if (!status) memcpy(all, here->values, (size_t)m->all->parts * sizeof *all);
  ++m->round;
  return leave(m, status);
}

/* Nothing moves when called. It gives others the processor, so that they are seen to overtake. */
static void poll_none(void *user) {
  (void)user;
  const struct timespec moment = {0};
  nanosleep(&moment, NULL);
}

static void *live(void *argument) {
  member *m = argument;
  m->fn(m->part, &m->transport, m->user);
  pthread_mutex_lock(&m->all->lock);
  if (m->exchange) fail(m, "ends before it has received");
  m->ended = 1;
  happen(m->all);
  pthread_mutex_unlock(&m->all->lock);
  return NULL;
}

static void make_member(world *w, int32_t part, parts_fn fn, void *user) {
  member *m = &w->members[part];
  m->all = w;
  m->part = part;
  m->fn = fn;
  m->user = user;
  m->seen = -1;
  m->transport = (mpm_transport){.struct_size = sizeof m->transport,
                                 .part = part,
                                 .parts = w->parts,
                                 .send = send_to,
                                 .receive = receive_from,
                                 .reduce = reduce_all,
                                 .gather = gather_all,
                                 .poll = poll_none,
                                 .user = m};
  for (int32_t from = 0; from < w->parts; ++from) w->way[part][from].last = &w->way[part][from].first;
}

static void empty(world *w) {
  for (int32_t to = 0; to < w->parts; ++to) {
    forget_received(&w->members[to]);
    for (int32_t from = 0; from < w->parts; ++from)
      for (packet *p = w->way[to][from].first, *next; p; p = next) {
        next = p->next;
        drop(p);
      }
  }
  for (int32_t i = 0; i < 2; ++i) free(w->meetings[i].values);
}

int parts_run(int32_t n, parts_fn fn, void *user, parts_plan *plan) {
  parts_plan none = {0};
  world *w = n > 0 && n <= PARTS_MOST ? calloc(1, sizeof *w) : NULL;
  if (!w) return -1;
  w->plan = plan ? plan : &none;
  w->parts = n;
  w->meetings[0].round = w->meetings[1].round = -1;
  for (int32_t i = 0; i < n; ++i) w->plan->calls[i] = w->plan->messages[i] = w->plan->bytes[i] = 0;
  w->plan->text[0] = '\0';
  pthread_mutex_init(&w->lock, NULL);
  pthread_cond_init(&w->changed, NULL);
  for (int32_t i = 0; i < n; ++i) make_member(w, i, fn, user);
  int32_t started = 0;
  pthread_mutex_lock(&w->lock);
  while (started < n && !pthread_create(&w->members[started].thread, NULL, live, &w->members[started]))
    ++started;
  for (int32_t i = started; i < n; ++i) {
    w->members[i].ended = 1;
    fail(&w->members[i], "has no thread");
  }
  pthread_mutex_unlock(&w->lock);
  for (int32_t i = 0; i < started; ++i) pthread_join(w->members[i].thread, NULL);
  empty(w);
  pthread_cond_destroy(&w->changed);
  pthread_mutex_destroy(&w->lock);
  const int broken = w->broken;
  free(w);
  return broken ? -1 : 0;
}
