#include "layout/contact_nodes.h"

#include <math.h>
#include <string.h>

void mpmi_contact_nodes_free(mpmi_contact_nodes *contact, mpm_context *c) {
  MPMI_FREE_ARRAY(c, contact->meeting, contact->meeting_capacity);
  MPMI_FREE_ARRAY(c, contact->party, contact->party_capacity);
  MPMI_FREE_ARRAY(c, contact->touch, contact->touch_capacity);
  MPMI_FREE_ARRAY(c, contact->cloud, contact->cloud_capacity);
  MPMI_FREE_ARRAY(c, contact->entry, contact->entry_capacity);
  MPMI_FREE_ARRAY(c, contact->cloud_of, contact->map_capacity);
  MPMI_FREE_ARRAY(c, contact->surface, contact->surface_capacity);
  MPMI_FREE_ARRAY(c, contact->site, contact->site_capacity);
  MPMI_FREE_ARRAY(c, contact->near_surface, contact->near_capacity);
  MPMI_FREE_ARRAY(c, contact->near_value, contact->value_capacity);
  MPMI_FREE_ARRAY(c, contact->in_reach, contact->reach_capacity);
  MPMI_FREE_ARRAY(c, contact->reached, contact->reached_capacity);
  MPMI_FREE_ARRAY(c, contact->site_sum, contact->sum_capacity);
  MPMI_FREE_ARRAY(c, contact->by_surface, contact->by_surface_capacity);
  MPMI_FREE_ARRAY(c, contact->clearance, contact->clearance_capacity);
  MPMI_FREE_ARRAY(c, contact->clearance_first, contact->first_capacity);
  MPMI_FREE_ARRAY(c, contact->coupled, contact->coupled_capacity);
  MPMI_FREE_ARRAY(c, contact->merged, contact->merged_capacity);
  MPMI_FREE_ARRAY(c, contact->work, contact->work_capacity);
  MPMI_FREE_ARRAY(c, contact->place, contact->place_capacity);
}

int64_t mpmi_pair_find(const mpmi_pair_records *records, int32_t a, int32_t b) {
  const int64_t at = mpmi_pair_place(records->record, sizeof *records->record, records->count, a, b);
  return at < records->count && records->record[at].a == a && records->record[at].b == b ? at : -1;
}

mpm_status mpmi_pair_add(mpmi_pair_records *records, mpm_context *context, int32_t a, int32_t b) {
  if (mpmi_pair_find(records, a, b) >= 0) return MPM_OK;
  if (MPMI_RESERVE_NEXT(context, records->record, records->capacity, records->count)) return MPM_E_NOMEM;
  const int64_t at = mpmi_pair_place(records->record, sizeof *records->record, records->count, a, b);
  memmove(records->record + at + 1, records->record + at,
          (size_t)(records->count - at) * sizeof *records->record);
  ++records->count;
  records->grown = 1;
  records->record[at] = (mpmi_pair_record){.a = a, .b = b, .last.gap = (double)INFINITY};
  return MPM_OK;
}

void mpmi_pairs_drop(mpmi_pair_records *records, int32_t code) {
  int64_t kept = 0;
  for (int64_t i = 0; i < records->count; ++i) {
    mpmi_pair_record record = records->record[i];
    if (record.a == code) continue;
    if (record.a < code) ++record.a;
    records->record[kept++] = record;
  }
  records->count = kept;
}
