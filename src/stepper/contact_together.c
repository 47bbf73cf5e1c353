/* What the parts of a problem tell each other of contact: before a step which pairs of bodies ever were near
 * each other, and the particles around shared nodes; after it what the pairs have done to each other. */
#include "stepper/together.h"

#include <math.h>
#include <string.h>

/* Returns 1 where there may be contact, on all parts alike. */
static int32_t may_touch(const mpm_stepper *s) {
  int32_t bodies = 0;
  for (int32_t m = 1; m < s->layout.member_count; ++m)
    bodies |= s->layout.member[m].body != s->layout.member[0].body;
  return bodies || s->settings.obstacles.count || mpmi_has_friction_planes(&s->settings);
}

/* ---- pairs --------------------------------------------------------------------------------------------- */
/* All parts get to know the pairs of all. */
static mpm_status unite_pairs(mpm_stepper *s) {
  mpmi_parts *parts = s->layout.parts;
  mpmi_pair_records *pairs = &s->history.pairs;
  mpm_status status = MPM_OK;
  mpmi_arrivals in;
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) {
    parts->out[r].used = 0;
    for (int64_t i = 0; i < pairs->count && r != s->context->transport.part && !status; ++i) {
      const int32_t pair[2] = {pairs->record[i].a, pairs->record[i].b};
      void *at = mpmi_buffer_take(s->context, &parts->out[r], sizeof pair);
      if (at)
        memcpy(at, pair, sizeof pair);
      else
        status = MPM_E_NOMEM;
    }
  }
  const mpm_status lost = mpmi_parts_exchange(parts, &in);
  if (lost) return lost;
  for (int32_t i = 0; i < in.count; ++i)
    for (int64_t at = 0; at + (int64_t)(2 * sizeof(int32_t)) <= in.message[i].bytes && !status;
         at += (int64_t)(2 * sizeof(int32_t))) {
      int32_t pair[2];
      memcpy(pair, (const char *)in.message[i].data + at, sizeof pair);
      status = mpmi_pair_add(pairs, s->context, pair[0], pair[1]);
    }
  return mpmi_agree(s->context, status);
}

/* ---- particles ----------------------------------------------------------------------------------------- */
/* Marks the blocks at sites. A node that follows one of them by a wall or a period has a site there, too: a
 * body that comes near has all blocks around its own, with those of the masters of what follows in them. */
static void mark_sites(const mpm_stepper *s, uint8_t *mark) {
  const mpmi_contact_nodes *contact = &s->nodes.contact;
  for (int64_t i = 0; i < contact->site_count; ++i)
    memset(mark + contact->site[i].blocks.first, 1, (size_t)contact->site[i].blocks.count);
}

/* Marks the boundary blocks beside them, whose particles others need; returns 1 where there are some. */
static int32_t mark_given(const mpm_stepper *s, const uint8_t *site, uint8_t *mark) {
  const mpmi_blocks *b = &s->layout.blocks;
  const mpmi_parts *parts = s->layout.parts;
  int32_t any = 0;
  for (int64_t i = 0; i < parts->boundary_count; ++i) {
    const int64_t block = parts->boundary[i];
    uint8_t beside = 0;
    for (int32_t n = 0; n < b->neighbours; ++n)
      if (b->neighbour[block][n] != MPMI_NO_BLOCK) beside |= site[b->neighbour[block][n]];
    mark[block] = beside;
    any |= beside;
  }
  return any;
}

mpm_status mpmi_together_touching(mpm_stepper *s) {
  if (!mpmi_is_shared(s) || !may_touch(s)) return MPM_OK;
  mpm_context *c = s->context;
  const int64_t blocks = s->layout.blocks.count;
  const size_t bytes = mpmi_bytes(blocks + 1, 1);
  uint8_t *mark = mpmi_alloc_zeroed(c, bytes);
  /* what is to be done by all where it is on one */
  int64_t word[] = {!mark, s->history.pairs.grown, 0, s->nodes.contact.anywhere};
  if (mark) {
    mark_sites(s, mark);
    word[2] = mark_given(s, mark, s->layout.parts->given);
  }
  mpmi_guests_clear(s->layout.parts);
  mpm_status status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, 4, word);
  s->nodes.contact.anywhere = word[3] != 0;
  s->layout.parts->some_given = word[2] != 0;
  if (!status && word[0]) status = mpmi_agree(c, mark ? MPM_OK : MPM_E_NOMEM);
  if (!status && word[1]) status = unite_pairs(s);
  if (!status && word[1]) {
    mpmi_pair_records *pairs = &s->history.pairs;
    mpmi_pairs_begin(pairs);
    status = mpmi_agree(c, mpmi_tally_prepare(&s->work.tally, c, s->layout.member_count, pairs->count));
    pairs->grown = status != MPM_OK;
  }
  if (!status && word[2]) status = mpmi_layout_exchange_guests(&s->layout, c, 0);
  mpmi_free(c, mark, bytes);
  return status;
}

/* ---- sums of pairs ------------------------------------------------------------------------------------- */
enum { TOGETHER = 16, COUNTS = 4, EXTREMES = 2 };

static void put_counts(const mpmi_pair_sums *now, int64_t *count, int64_t *extreme) {
  count[0] = now->nodes;
  count[1] = now->closed;
  count[2] = now->stuck;
  count[3] = now->ambiguous;
  extreme[0] = mpmi_ordered_bits(now->pressure_max);
  extreme[1] = mpmi_ordered_bits(-now->gap);
}

static void take_counts(mpmi_pair_sums *now, const int64_t *count, const int64_t *extreme) {
  now->nodes = count[0];
  now->closed = count[1];
  now->stuck = count[2];
  now->ambiguous = count[3];
  now->pressure_max = mpmi_of_ordered_bits(extreme[0]);
  now->gap = -mpmi_of_ordered_bits(extreme[1]);
}

mpm_status mpmi_together_touched(mpm_stepper *s) {
  if (!mpmi_is_shared(s) || !may_touch(s)) return MPM_OK;
  mpmi_pair_records *pairs = &s->history.pairs;
  int64_t count[TOGETHER * COUNTS], extreme[TOGETHER * EXTREMES], nodes = s->step.info.contact_nodes;
  mpm_status status = mpmi_reduce_parts(s->context, MPM_REDUCE_SUM, 1, &nodes);
  s->step.info.contact_nodes = nodes;
  for (int64_t first = 0; first < pairs->count && !status; first += TOGETHER) {
    const int64_t left = pairs->count - first, some = left < TOGETHER ? left : TOGETHER;
    for (int64_t i = 0; i < some; ++i)
      put_counts(&pairs->record[first + i].now, count + COUNTS * i, extreme + EXTREMES * i);
    if ((status = mpmi_reduce_parts(s->context, MPM_REDUCE_SUM, COUNTS * some, count)) ||
        (status = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, EXTREMES * some, extreme)))
      break;
    for (int64_t i = 0; i < some; ++i)
      take_counts(&pairs->record[first + i].now, count + COUNTS * i, extreme + EXTREMES * i);
  }
  return status;
}
