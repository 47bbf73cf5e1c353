#include "transport_rounds.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What one part knows: everything that is sent follows from seed, round, sender and receiver. */
typedef struct rounds {
  const mpm_transport *t;
  const rounds_desc *desc;
  int32_t round;
  mpm_message *out;
  int64_t *most, *all;
  char *text;
} rounds;

static uint64_t mix(uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

static uint64_t draw(const rounds *r, int32_t what, int32_t from, int32_t to) {
  return mix(mix(mix(r->desc->seed + (uint64_t)r->round) + (uint64_t)what) +
             ((uint64_t)(uint32_t)from << 32 | (uint32_t)to));
}

enum { MEETS, SIZE, SLACK, BYTES, VALUES, GATHERED };

static int is_sparse(const rounds *r) {
  return r->round % 3 == 2;
}

/* Partners of a known exchange are partners both ways; the receiver of a sparse one need not answer. */
static int sends(const rounds *r, int32_t from, int32_t to) {
  if (from == to) return 0;
  if (is_sparse(r)) return draw(r, MEETS, from, to) % 3 == 0;
  return draw(r, MEETS, from < to ? from : to, from < to ? to : from) % 3 != 0;
}

/* A quarter is empty, a quarter of any size up to the largest, the others small. */
static int64_t size(const rounds *r, int32_t from, int32_t to) {
  const uint64_t drawn = draw(r, SIZE, from, to);
  if (drawn % 4 == 0) return 0;
  const uint64_t small = drawn % 4 == 1 ? (uint64_t)r->desc->largest : (uint64_t)(r->desc->largest % 300);
  return (int64_t)(mix(drawn) % (small + 1));
}

static unsigned char byte(uint64_t stream, int64_t i) {
  return (unsigned char)((stream + (uint64_t)i * 0x9e3779b97f4a7c15u) >> 53);
}

static void write_bytes(unsigned char *data, uint64_t stream, int64_t bytes) {
  for (int64_t i = 0; i < bytes; ++i) data[i] = byte(stream, i);
}

static int has_bytes(const unsigned char *data, uint64_t stream, int64_t bytes) {
  for (int64_t i = 0; i < bytes; ++i)
    if (data[i] != byte(stream, i)) return 0;
  return 1;
}

static int failed(const rounds *r, const char *what, int64_t value) {
  snprintf(r->text, ROUNDS_TEXT, "part %d, round %d: %s (%lld)", (int)r->t->part, (int)r->round, what,
           (long long)value);
  return -1;
}

static int start(rounds *r) {
  const int32_t part = r->t->part;
  int32_t count = 0, no_memory = 0;
  for (int32_t to = 0; to < r->t->parts; ++to) {
    if (!sends(r, part, to)) continue;
    const int64_t bytes = size(r, part, to);
    r->out[count] = (mpm_message){.part = to, .bytes = bytes, .data = bytes ? malloc((size_t)bytes) : NULL};
    no_memory |= bytes && !r->out[count].data;
    if (r->out[count].data) write_bytes(r->out[count].data, draw(r, BYTES, part, to), bytes);
    r->most[count++] = size(r, to, part) + (int64_t)(draw(r, SLACK, to, part) % 2 * 100);
  }
  for (int32_t i = count; i < r->t->parts; ++i) r->out[i] = (mpm_message){0};
  if (no_memory) return failed(r, "no memory", count);
  const mpm_status status = r->t->send(r->t->user, is_sparse(r) ? MPM_EXCHANGE_SPARSE : MPM_EXCHANGE_KNOWN,
                                       count, r->out, is_sparse(r) ? NULL : r->most);
  return status ? failed(r, "send", status) : 0;
}

static int compare(const rounds *r, int32_t count, const mpm_message *in) {
  int32_t taken = 0;
  for (int32_t from = 0; from < r->t->parts; ++from) {
    if (!sends(r, from, r->t->part)) continue;
    if (taken == count) return failed(r, "too few messages", count);
    const mpm_message *m = &in[taken++];
    if (m->part != from || m->reserved) return failed(r, "a message of the wrong part", m->part);
    if (m->bytes != size(r, from, r->t->part)) return failed(r, "a message of the wrong size", m->bytes);
    if ((uintptr_t)m->data % 64) return failed(r, "data at no multiple of 64", from);
    if (!has_bytes(m->data, draw(r, BYTES, from, r->t->part), m->bytes))
      return failed(r, "wrong bytes", from);
  }
  return taken == count ? 0 : failed(r, "too many messages", count);
}

/* Values of each part at the ends of the range and anywhere; some rounds have none. */
static int64_t value_of(const rounds *r, int32_t part, int64_t i) {
  const uint64_t drawn = draw(r, VALUES + (int32_t)i * 8, part, 0);
  return drawn % 5 == 0 ? INT64_MIN : drawn % 5 == 1 ? INT64_MAX : (int64_t)mix(drawn);
}

static int reduce(const rounds *r) {
  enum { MOST = 65 };
  int64_t values[MOST];
  const int64_t count = (int64_t)(draw(r, VALUES, -1, -1) % MOST);
  const int32_t op = r->round % 2 ? MPM_REDUCE_MAX : MPM_REDUCE_SUM;
  for (int64_t i = 0; i < count; ++i) values[i] = value_of(r, r->t->part, i);
  const mpm_status status = r->t->reduce(r->t->user, op, count, values);
  if (status) return failed(r, "reduce", status);
  for (int64_t i = 0; i < count; ++i) {
    int64_t wanted = value_of(r, 0, i);
    for (int32_t part = 1; part < r->t->parts; ++part) {
      const int64_t value = value_of(r, part, i);
      if (op == MPM_REDUCE_SUM) wanted = (int64_t)((uint64_t)wanted + (uint64_t)value);
      if (op == MPM_REDUCE_MAX && wanted < value) wanted = value;
    }
    if (values[i] != wanted) return failed(r, "a wrong reduction", i);
  }
  return 0;
}

static int gather(const rounds *r) {
  const mpm_status status = r->t->gather(r->t->user, (int64_t)draw(r, GATHERED, r->t->part, 0), r->all);
  if (status) return failed(r, "gather", status);
  for (int32_t part = 0; part < r->t->parts; ++part)
    if (r->all[part] != (int64_t)draw(r, GATHERED, part, 0)) return failed(r, "a wrong value gathered", part);
  return 0;
}

static int one_round(rounds *r) {
  int status = start(r);
  const int32_t polls = (int32_t)(draw(r, SLACK, -1, r->t->part) % 4);
  for (int32_t i = 0; i < polls && !status && r->t->poll; ++i) r->t->poll(r->t->user);
  int32_t count = -1;
  const mpm_message *in = NULL;
  if (!status && r->t->receive(r->t->user, &count, &in)) status = failed(r, "receive", count);
  for (int32_t i = 0; i < r->t->parts; ++i) free(r->out[i].data);
  if (!status) status = compare(r, count, in);
  if (!status && draw(r, VALUES, 0, 0) % 2) status = reduce(r);
  if (!status && draw(r, GATHERED, 0, 0) % 4 == 0) status = gather(r);
  /* what came is still there */
  return status ? status : compare(r, count, in);
}

int rounds_run(const mpm_transport *transport, const rounds_desc *desc, char *text) {
  const size_t parts = (size_t)transport->parts;
  rounds r = {.t = transport,
              .desc = desc,
              .text = text,
              .out = calloc(parts, sizeof *r.out),
              .most = calloc(parts, sizeof *r.most),
              .all = calloc(parts, sizeof *r.all)};
  int status = r.out && r.most && r.all ? 0 : failed(&r, "no memory", 0);
  for (; r.round < desc->rounds && !status; ++r.round) status = one_round(&r);
  free(r.out);
  free(r.most);
  free(r.all);
  return status;
}
