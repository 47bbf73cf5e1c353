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
  MPMI_FREE_ARRAY(c, contact->near, contact->near_capacity);
  MPMI_FREE_ARRAY(c, contact->group_count, contact->group_capacity);
  MPMI_FREE_ARRAY(c, contact->work, contact->work_capacity);
}

int64_t mpmi_pair_find(const mpmi_pair_records *records, int32_t a, int32_t b) {
  const int64_t at = mpmi_pair_place(records->record, sizeof *records->record, records->count, a, b);
  return at < records->count && records->record[at].a == a && records->record[at].b == b ? at : -1;
}

mpm_status mpmi_pair_add(mpmi_pair_records *records, mpm_context *context, int32_t a, int32_t b) {
  if (mpmi_pair_find(records, a, b) >= 0) return MPM_OK;
  if (records->count == records->capacity) {
    const int64_t capacity = records->capacity ? 2 * records->capacity : 4;
    mpmi_pair_record *record = mpmi_alloc(context, mpmi_bytes(capacity, sizeof *record));
    if (!record) return MPM_E_NOMEM;
    if (records->count) memcpy(record, records->record, (size_t)records->count * sizeof *record);
    MPMI_FREE_ARRAY(context, records->record, records->capacity);
    records->record = record;
    records->capacity = capacity;
  }
  const int64_t at = mpmi_pair_place(records->record, sizeof *records->record, records->count, a, b);
  memmove(records->record + at + 1, records->record + at,
          (size_t)(records->count - at) * sizeof *records->record);
  ++records->count;
  records->record[at] = (mpmi_pair_record){.a = a, .b = b, .last.gap = (double)INFINITY};
  return MPM_OK;
}
