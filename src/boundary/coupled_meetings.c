/* Meetings that a free obstacle couples. Impulses at one node change the obstacle's velocity at all others:
 * the meetings are swept one after the other, in the order of their nodes. Where a problem has several parts,
 * each of them sweeps all, so that all know the obstacle's motion: those of other parts come as copies with
 * the velocities of their nodes, and are dropped after that. */
#include "boundary/bound.h"

#include <string.h>

/* A meeting of another part: its place, then its parties and touches. */
typedef struct meeting_head {
  uint64_t key;
  int64_t place, parties, touches;
} meeting_head;

/* ---- copies -------------------------------------------------------------------------------------------- */
/* Appends a meeting to the messages for all other parts. Its parties bring their velocities, and its touches
 * number them from 0. */
static mpm_status pack_meeting(const mpmi_bound *bound, mpmi_parts *parts, const mpmi_meeting *meeting) {
  const mpmi_contact_nodes *contact = &bound->nodes->contact;
  const meeting_head head = {meeting->key, meeting->place, meeting->party_count, meeting->touch_count};
  const size_t bytes =
      sizeof head + (size_t)head.parties * sizeof(mpmi_party) + (size_t)head.touches * sizeof(mpmi_touch);
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) {
    if (r == parts->context->transport.part) continue;
    char *at = mpmi_buffer_take(parts->context, &parts->out[r], (int64_t)bytes);
    if (!at) return MPM_E_NOMEM;
    memcpy(at, &head, sizeof head);
    at += sizeof head;
    for (int64_t p = 0; p < head.parties; ++p, at += sizeof(mpmi_party)) {
      mpmi_party party = contact->party[meeting->first_party + p];
      for (int32_t c = 0; c < 3 && party.surface < 0; ++c)
        party.copy[c] = c < bound->dim ? mpmi_velocity(bound->values, party.slot)[c] : 0.0;
      memcpy(at, &party, sizeof party);
    }
    for (int64_t t = 0; t < head.touches; ++t, at += sizeof(mpmi_touch)) {
      mpmi_touch touch = contact->touch[meeting->first_touch + t];
      for (int32_t i = 0; i < 2; ++i) touch.party[i] -= meeting->first_party;
      memcpy(at, &touch, sizeof touch);
    }
  }
  return MPM_OK;
}

static const mpm_contact_desc *find_rule(const mpmi_bound *bound, const mpmi_party *a, const mpmi_party *b) {
  double sign;
  return a->surface >= 0 ? &bound->nodes->contact.surface[a->surface].rule
                         : mpmi_contact_rule_of(&bound->step->settings->contact, a->body, b->body, &sign);
}

/* Appends the meeting that stands at `at` to those of this part. */
static mpm_status take_meeting(mpmi_bound *bound, const meeting_head *head, const char *at) {
  mpm_context *c = bound->step->settings->context;
  mpmi_contact_nodes *contact = &bound->nodes->contact;
  const int64_t first = contact->party_count;
  mpm_status status =
      MPMI_RESERVE_NEXT(c, contact->meeting, contact->meeting_capacity, contact->meeting_count);
  if (status) return status;
  contact->meeting[contact->meeting_count++] = (mpmi_meeting){.key = head->key,
                                                              .place = (int32_t)head->place,
                                                              .first_party = first,
                                                              .party_count = head->parties,
                                                              .first_touch = contact->touch_count,
                                                              .touch_count = head->touches,
                                                              .coupled = 1};
  for (int64_t p = 0; p < head->parties; ++p, at += sizeof(mpmi_party)) {
    if ((status = MPMI_RESERVE_NEXT(c, contact->party, contact->party_capacity, contact->party_count)))
      return status;
    mpmi_party *party = &contact->party[contact->party_count++];
    memcpy(party, at, sizeof *party);
    if (party->surface < 0) party->slot = MPMI_COPIED_PARTY;
  }
  for (int64_t t = 0; t < head->touches; ++t, at += sizeof(mpmi_touch)) {
    if ((status = MPMI_RESERVE_NEXT(c, contact->touch, contact->touch_capacity, contact->touch_count)))
      return status;
    mpmi_touch *touch = &contact->touch[contact->touch_count++];
    memcpy(touch, at, sizeof *touch);
    for (int32_t i = 0; i < 2; ++i) touch->party[i] += first;
    touch->rule = find_rule(bound, &contact->party[touch->party[0]], &contact->party[touch->party[1]]);
  }
  return MPM_OK;
}

/* ---- order --------------------------------------------------------------------------------------------- */
static int32_t stands_before(const mpmi_meeting *a, const mpmi_meeting *b) {
  return a->key < b->key || (a->key == b->key && a->place < b->place);
}

/* Merges the last meetings, from `begin` on and in order among themselves, into the list of coupled ones.
 * Those that this part has already stay out. */
static mpm_status merge_meetings(mpmi_bound *bound, int64_t begin) {
  mpmi_contact_nodes *contact = &bound->nodes->contact;
  const int64_t own = contact->coupled_count, more = contact->meeting_count - begin;
  const mpm_status status = MPMI_RESERVE_MORE(bound->step->settings->context, contact->merged,
                                              contact->merged_capacity, own + more);
  if (status) return status;
  int64_t count = 0;
  for (int64_t i = 0, j = begin; i < own || j < contact->meeting_count;) {
    const mpmi_meeting *a = i < own ? &contact->meeting[contact->coupled[i]] : NULL;
    const mpmi_meeting *b = j < contact->meeting_count ? &contact->meeting[j] : NULL;
    if (a && b && !stands_before(a, b) && !stands_before(b, a))
      ++j;
    else if (a && (!b || stands_before(a, b)))
      contact->merged[count++] = contact->coupled[i++];
    else
      contact->merged[count++] = j++;
  }
  int64_t *list = contact->coupled;
  const int64_t capacity = contact->coupled_capacity;
  contact->coupled = contact->merged;
  contact->coupled_capacity = contact->merged_capacity;
  contact->merged = list;
  contact->merged_capacity = capacity;
  contact->coupled_count = count;
  return MPM_OK;
}

static mpm_status take_meetings(mpmi_bound *bound, const mpm_message *in) {
  const char *at = in->data, *end = at + in->bytes;
  const int64_t begin = bound->nodes->contact.meeting_count;
  while (end - at >= (ptrdiff_t)sizeof(meeting_head)) {
    meeting_head head;
    memcpy(&head, at, sizeof head);
    at += sizeof head;
    const int64_t room = (end - at) / (int64_t)sizeof(mpmi_party);
    if (head.parties < 2 || head.touches < 1 || head.parties > room || head.touches > room ||
        head.parties * (int64_t)sizeof(mpmi_party) + head.touches * (int64_t)sizeof(mpmi_touch) > end - at)
      return mpmi_fail(bound->step->settings->context, MPM_E_INTERNAL,
                       "meetings of part %d make no sense here", (int)in->part);
    const mpm_status status = take_meeting(bound, &head, at);
    if (status) return status;
    at += head.parties * (int64_t)sizeof(mpmi_party) + head.touches * (int64_t)sizeof(mpmi_touch);
  }
  return merge_meetings(bound, begin);
}

/* ---- all of them --------------------------------------------------------------------------------------- */
static mpm_status list_own(mpmi_bound *bound) {
  mpmi_contact_nodes *contact = &bound->nodes->contact;
  const mpm_status status = MPMI_RESERVE_MORE(bound->step->settings->context, contact->coupled,
                                              contact->coupled_capacity, contact->meeting_count);
  for (int64_t m = 0; m < contact->meeting_count && !status; ++m)
    if (contact->meeting[m].coupled && contact->meeting[m].touch_count)
      contact->coupled[contact->coupled_count++] = m;
  return status;
}

mpm_status mpmi_coupled_gather(mpmi_bound *bound) {
  mpmi_parts *parts = bound->step->layout->parts;
  const mpmi_contact_nodes *contact = &bound->nodes->contact;
  bound->nodes->contact.coupled_count = 0;
  if (!contact->anywhere || !mpmi_has_free_obstacles(bound->step->settings)) return MPM_OK;
  mpm_status status = list_own(bound);
  if (!parts) return status;
  mpmi_arrivals in;
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) parts->out[r].used = 0;
  for (int64_t i = 0; i < contact->coupled_count && !status; ++i) {
    const mpmi_meeting *meeting = &contact->meeting[contact->coupled[i]];
    if (mpmi_owns_node(parts, contact->party[meeting->first_party].slot))
      status = pack_meeting(bound, parts, meeting);
  }
  for (int32_t r = 0; r < mpmi_part_count(parts) && status; ++r) parts->out[r].used = 0;
  const mpm_status lost = mpmi_parts_exchange(parts, &in);
  mpmi_accord_gathered(parts);
  for (int32_t i = 0; i < in.count && !lost && !status; ++i) status = take_meetings(bound, &in.message[i]);
  return lost ? lost : status;
}
