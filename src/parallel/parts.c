#include "parallel/parts.h"

#include <string.h>

mpm_status mpmi_parts_create(mpm_context *c, const mpm_grid *grid, mpmi_parts **out) {
  const int64_t count = c->transport.parts;
  mpmi_parts *parts = mpmi_alloc_zeroed(c, sizeof *parts);
  *out = parts;
  if (!parts) return MPM_E_NOMEM;
  parts->context = c;
  parts->grid = grid;
  parts->is_stale = 1;
  parts->info.imbalance = 1.0;
  parts->balance = mpmi_balance_of(NULL);
  parts->first = mpmi_alloc_zeroed(c, mpmi_bytes(count + 1, sizeof *parts->first));
  parts->owner_count = mpmi_alloc_zeroed(c, mpmi_bytes(count, sizeof *parts->owner_count));
  parts->out = mpmi_alloc_zeroed(c, mpmi_bytes(count, sizeof *parts->out));
  parts->message = mpmi_alloc_zeroed(c, mpmi_bytes(count, sizeof *parts->message));
  parts->most = mpmi_alloc_zeroed(c, mpmi_bytes(count, sizeof *parts->most));
  return parts->first && parts->owner_count && parts->out && parts->message && parts->most ? MPM_OK
                                                                                           : MPM_E_NOMEM;
}

void mpmi_parts_destroy(mpmi_parts *parts) {
  if (!parts) return;
  mpm_context *c = parts->context;
  const int64_t count = c->transport.parts;
  for (int64_t r = 0; r < count && parts->out; ++r)
    MPMI_FREE_ARRAY(c, parts->out[r].at, parts->out[r].capacity);
  MPMI_FREE_ARRAY(c, parts->gone.at, parts->gone.capacity);
  MPMI_FREE_ARRAY(c, parts->first, count + 1);
  MPMI_FREE_ARRAY(c, parts->owner_count, count);
  MPMI_FREE_ARRAY(c, parts->out, count);
  MPMI_FREE_ARRAY(c, parts->body, parts->body_capacity);
  MPMI_FREE_ARRAY(c, parts->guest_of, parts->guest_capacity);
  MPMI_FREE_ARRAY(c, parts->given, parts->given_capacity);
  MPMI_FREE_ARRAY(c, parts->message, count);
  MPMI_FREE_ARRAY(c, parts->most, count);
  MPMI_FREE_ARRAY(c, parts->partner, parts->partner_capacity);
  MPMI_FREE_ARRAY(c, parts->sent, parts->sent_capacity);
  MPMI_FREE_ARRAY(c, parts->ghost, parts->ghost_capacity);
  MPMI_FREE_ARRAY(c, parts->flags, parts->flags_capacity);
  MPMI_FREE_ARRAY(c, parts->lowest, parts->lowest_capacity);
  MPMI_FREE_ARRAY(c, parts->partial, parts->partial_capacity);
  MPMI_FREE_ARRAY(c, parts->mark, parts->mark_capacity);
  MPMI_FREE_ARRAY(c, parts->is_boundary, parts->is_boundary_capacity);
  MPMI_FREE_ARRAY(c, parts->is_inner, parts->is_inner_capacity);
  MPMI_FREE_ARRAY(c, parts->is_early, parts->is_early_capacity);
  MPMI_FREE_ARRAY(c, parts->is_late, parts->is_late_capacity);
  MPMI_FREE_ARRAY(c, parts->near, parts->near_capacity);
  MPMI_FREE_ARRAY(c, parts->boundary, parts->boundary_capacity);
  MPMI_FREE_ARRAY(c, parts->tile, parts->tile_capacity);
  mpmi_free(c, parts, sizeof *parts);
}

void mpmi_parts_replace(mpmi_parts **present, mpmi_parts **next) {
  mpmi_parts *old = *present, *now = *next;
  const mpm_parallel_info *before = &old->info;
  mpm_parallel_info *info = &now->info;
  info->bytes_nodes += before->bytes_nodes;
  info->bytes_moved += before->bytes_moved;
  info->moved += before->moved;
  info->cuts += before->cuts;
  info->seconds_packing += before->seconds_packing;
  info->seconds_waiting += before->seconds_waiting;
  now->guests = old->guests; /* memory that is used again */
  now->guest_count = old->guest_count;
  old->guests = NULL;
  old->guest_count = 0;
  *present = now;
  *next = old;
}

mpm_status mpmi_parts_note_body(mpmi_parts *parts, int32_t body) {
  for (int32_t i = 0; i < parts->body_count; ++i)
    if (parts->body[i] == body) return MPM_OK;
  const mpm_status status =
      MPMI_RESERVE_NEXT(parts->context, parts->body, parts->body_capacity, parts->body_count);
  if (!status) parts->body[parts->body_count++] = body;
  return status;
}

void *mpmi_buffer_take(mpm_context *context, mpmi_buffer *buffer, int64_t bytes) {
  const int64_t wanted = buffer->used + bytes;
  if (wanted > buffer->capacity || !buffer->at) {
    const int64_t capacity = wanted + wanted / 2 + 1024;
    char *more = mpmi_alloc(context, mpmi_bytes(capacity, 1));
    if (!more) return NULL;
    if (buffer->used) memcpy(more, buffer->at, (size_t)buffer->used);
    MPMI_FREE_ARRAY(context, buffer->at, buffer->capacity);
    buffer->at = more;
    buffer->capacity = capacity;
  }
  char *at = buffer->at + buffer->used;
  buffer->used = wanted;
  return at;
}

mpm_status mpmi_parts_exchange(mpmi_parts *parts, mpmi_arrivals *in) {
  int32_t count = 0;
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) {
    const mpmi_buffer *out = &parts->out[r];
    if (out->used) parts->message[count++] = (mpm_message){.part = r, .bytes = out->used, .data = out->at};
  }
  const mpm_status status = mpmi_send(parts->context, MPM_EXCHANGE_SPARSE, count, parts->message, NULL);
  return status ? status : mpmi_parts_receive(parts, in);
}

mpm_status mpmi_parts_receive(mpmi_parts *parts, mpmi_arrivals *in) {
  const double started = mpmi_seconds();
  const mpm_status lost = mpmi_receive(parts->context, &in->count, &in->message);
  parts->info.seconds_waiting += mpmi_seconds() - started;
  return lost;
}

/* ---- what blocks weigh --------------------------------------------------------------------------------- */
mpm_balance_desc mpmi_balance_of(const mpm_balance_desc *desc) {
  mpm_balance_desc d = {.struct_size = sizeof d};
  if (desc) d = *desc;
  if (d.block_weight == 0.0) d.block_weight = MPMI_BLOCK_WEIGHT;
  return d;
}

/* Stands still while this part waits for others. */
static double working_clock(const mpmi_parts *parts) {
  return mpmi_seconds() - parts->info.seconds_waiting - parts->context->reducing;
}

void mpmi_time_begin(mpmi_parts *parts) {
  if (parts) parts->since = working_clock(parts);
}

void mpmi_time_add(mpmi_parts *parts) {
  if (!parts) return;
  const double now = working_clock(parts);
  if (now > parts->since) parts->busy += now - parts->since;
  parts->since = now;
}

void mpmi_time_reset(mpmi_parts *parts) {
  parts->busy = 0.0;
  mpmi_time_begin(parts);
}
