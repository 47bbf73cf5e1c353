/* The ids of particles that come by splitting: they follow each other in the order of the particles that are
 * split, by id. Of several parts each has its share of the range of ids, counts what is split there on all
 * parts, and tells the others how many come before. */
#include "adaption/adaption.h"
#include "context/radix.h"

static int64_t added_by(const mpmi_splitting *split) {
  return mpmi_parts_of(split->edges) - 1;
}

static int64_t rank_alone(mpmi_adaption *a) {
  int64_t added = 0;
  for (int64_t i = 0; i < a->splits; ++i) {
    a->split[i].before = added;
    added += added_by(&a->split[i]);
  }
  return added;
}

/* A particle of some part that is split, and what it adds. */
typedef struct told_split {
  int64_t id, added;
} told_split;

static int32_t counter_of(const mpmi_adapting *of, int64_t id) {
  return (int32_t)(id / (of->set->next_id / mpmi_part_count(of->parts) + 1));
}

static mpm_status tell_splits(const mpmi_adapting *of) {
  mpmi_messages_clear(of->parts);
  for (int64_t i = 0; i < of->a->splits; ++i) {
    const mpmi_splitting *split = &of->a->split[i];
    const told_split told = {split->id, added_by(split)};
    const int32_t to = counter_of(of, split->id);
    if (to == of->set->context->transport.part) continue;
    void *at = mpmi_buffer_take(of->set->context, &of->parts->out[to], sizeof told);
    if (!at) return MPM_E_NOMEM;
    memcpy(at, &told, sizeof told);
  }
  return MPM_OK;
}

/* What this part counts: of its own particles first, then of those of other parts as they have come. */
typedef struct counting {
  int64_t n, total;
  told_split *list;
  int64_t *before; /* [n] so many come of those with lower ids */
  uint64_t *key;   /* [2 n] and order[2 n]: to sort by */
  uint32_t *order;
  size_t bytes; /* of all in one piece */
} counting;

static mpm_status open_counting(const mpmi_adapting *of, const mpmi_arrivals *in, counting *c) {
  mpm_context *context = of->set->context;
  const int32_t me = context->transport.part;
  int64_t n = of->a->splits;
  for (int32_t i = 0; i < in->count; ++i) n += in->message[i].bytes / (int64_t)sizeof(told_split);
  if (n > UINT32_MAX)
    return mpmi_fail(context, MPM_E_UNSUPPORTED, "%lld particles are more than one part counts at once",
                     (long long)n);
  const size_t each = sizeof(told_split) + 3 * sizeof(int64_t) + 2 * sizeof(uint32_t);
  *c = (counting){.bytes = mpmi_bytes(n + 1, each)};
  c->list = mpmi_alloc(context, c->bytes);
  if (!c->list) return MPM_E_NOMEM;
  c->before = (int64_t *)(c->list + n);
  c->key = (uint64_t *)(c->before + n);
  c->order = (uint32_t *)(c->key + 2 * n);
  for (int64_t i = 0; i < of->a->splits; ++i)
    if (counter_of(of, of->a->split[i].id) == me)
      c->list[c->n++] = (told_split){of->a->split[i].id, added_by(&of->a->split[i])};
  for (int32_t i = 0; i < in->count; ++i)
    for (int64_t at = 0; at + (int64_t)sizeof(told_split) <= in->message[i].bytes;
         at += (int64_t)sizeof(told_split))
      memcpy(&c->list[c->n++], (const char *)in->message[i].data + at, sizeof(told_split));
  return MPM_OK;
}

static void close_counting(const mpmi_adapting *of, counting *c) {
  mpmi_free(of->set->context, c->list, c->bytes);
}

static void count(counting *c) {
  for (int64_t i = 0; i < c->n; ++i) c->key[i] = (uint64_t)c->list[i].id;
  mpmi_radix_sort(c->n, c->key, c->order, c->key + c->n, c->order + c->n);
  c->total = 0;
  for (int64_t i = 0; i < c->n; ++i) {
    c->before[c->order[i]] = c->total;
    c->total += c->list[c->order[i]].added;
  }
}

/* Finds how many come before those that this part counts, and how many there are on all parts. */
static mpm_status add_parts(const mpmi_adapting *of, int64_t own, int64_t *before, int64_t *total) {
  mpm_context *c = of->set->context;
  const mpm_status status = mpmi_gather_parts(c, own, of->parts->owner_count);
  *before = *total = 0;
  for (int32_t r = 0; r < mpmi_part_count(of->parts) && !status; ++r) {
    if (r < c->transport.part) *before += of->parts->owner_count[r];
    *total += of->parts->owner_count[r];
  }
  return status;
}

/* Answers, in the order in which they have told. */
static mpm_status answer(const mpmi_adapting *of, const counting *c, int64_t own, int64_t before,
                         const int32_t *part, const int64_t *told, int32_t count) {
  int64_t place = own;
  mpmi_messages_clear(of->parts);
  for (int32_t i = 0; i < count; ++i) {
    int64_t *at = mpmi_buffer_take(of->set->context, &of->parts->out[part[i]], told[i] * (int64_t)sizeof *at);
    if (!at) return MPM_E_NOMEM;
    for (int64_t k = 0; k < told[i]; ++k) at[k] = before + c->before[place++];
  }
  return MPM_OK;
}

/* Takes the answers of other parts, and those that this part knows itself. */
static void take_answers(const mpmi_adapting *of, const counting *c, int64_t before,
                         const mpmi_arrivals *in) {
  const int32_t me = of->set->context->transport.part;
  int64_t own = 0;
  for (int64_t i = 0; i < of->a->splits; ++i)
    if (counter_of(of, of->a->split[i].id) == me) of->a->split[i].before = before + c->before[own++];
  for (int32_t m = 0; m < in->count; ++m) {
    int64_t at = 0;
    for (int64_t i = 0; i < of->a->splits && at < in->message[m].bytes; ++i) {
      if (counter_of(of, of->a->split[i].id) != in->message[m].part) continue;
      memcpy(&of->a->split[i].before, (const char *)in->message[m].data + at, sizeof(int64_t));
      at += (int64_t)sizeof(int64_t);
    }
  }
}

static int64_t count_own(const mpmi_adapting *of) {
  int64_t own = 0;
  for (int64_t i = 0; i < of->a->splits; ++i)
    own += counter_of(of, of->a->split[i].id) == of->set->context->transport.part;
  return own;
}

static mpm_status meet(const mpmi_adapting *of, counting *c, int32_t *part, int64_t *told, int64_t *total) {
  mpm_context *context = of->set->context;
  mpmi_arrivals in;
  int64_t before;
  mpm_status status = mpmi_agree(context, tell_splits(of));
  if (status || (status = mpmi_parts_exchange(of->parts, &in))) return status;
  const int32_t senders = in.count;
  for (int32_t i = 0; i < senders; ++i) {
    part[i] = in.message[i].part;
    told[i] = in.message[i].bytes / (int64_t)sizeof(told_split);
  }
  if ((status = mpmi_agree(context, open_counting(of, &in, c)))) return status;
  count(c);
  if ((status = add_parts(of, c->total, &before, total)) ||
      (status = mpmi_agree(context, answer(of, c, count_own(of), before, part, told, senders))) ||
      (status = mpmi_parts_exchange(of->parts, &in)))
    return status;
  take_answers(of, c, before, &in);
  return MPM_OK;
}

mpm_status mpmi_adaption_rank(const mpmi_adapting *of, int64_t *total) {
  if (!of->parts) {
    *total = rank_alone(of->a);
    return MPM_OK;
  }
  mpm_context *context = of->set->context;
  const size_t part_bytes = mpmi_bytes(mpmi_part_count(of->parts), sizeof(int32_t)),
               told_bytes = mpmi_bytes(mpmi_part_count(of->parts), sizeof(int64_t));
  int32_t *part = mpmi_alloc(context, part_bytes);
  int64_t *told = part ? mpmi_alloc(context, told_bytes) : NULL;
  counting c = {0};
  mpm_status status = mpmi_agree(context, told ? MPM_OK : MPM_E_NOMEM);
  if (!status) status = meet(of, &c, part, told, total);
  close_counting(of, &c);
  mpmi_free(context, told, told_bytes);
  mpmi_free(context, part, part_bytes);
  return status;
}

void mpmi_adaption_limit(const mpmi_adapting *of, int64_t particles) {
  mpmi_adaption *a = of->a;
  const int64_t most = a->desc.most_particles, room = MPMI_MAX_SLOTS - MPMI_PAD - of->set->slots;
  int64_t here = 0, kept = 0;
  for (; kept < a->splits; ++kept) {
    const int64_t added = a->split[kept].before + added_by(&a->split[kept]);
    here += added_by(&a->split[kept]);
    if ((most > 0 && particles + added > most) || here > room || added > INT64_MAX - of->set->next_id) break;
  }
  a->splits = kept;
}
