/* Ids that the host gives to particles of several parts. Which part has which id is known to nobody: ids that
 * are new go to the part that they are hashed to, which sees whether one comes twice, and those that may be
 * in use are asked of all parts. */
#include "particles/shared_ids.h"
#include "context/radix.h"
#include "context/transport.h"

#include <string.h>

/* Ids on their way: those for part r stand at first[r] ... first[r + 1]. */
typedef struct letters {
  mpm_particles *set;
  int64_t n, *id, *first;
  mpm_message *message;
  size_t id_bytes, first_bytes, message_bytes;
} letters;

static mpm_status letters_open(letters *l, mpm_particles *set, int64_t n) {
  mpm_context *c = set->context;
  const int64_t parts = c->transport.parts;
  *l = (letters){.set = set, .n = n};
  l->id_bytes = mpmi_bytes(n + 1, sizeof *l->id);
  l->first_bytes = mpmi_bytes(parts + 2, sizeof *l->first);
  l->message_bytes = mpmi_bytes(parts, sizeof *l->message);
  l->id = mpmi_alloc(c, l->id_bytes);
  l->first = l->id ? mpmi_alloc_zeroed(c, l->first_bytes) : NULL;
  l->message = l->first ? mpmi_alloc(c, l->message_bytes) : NULL;
  return l->message ? MPM_OK : MPM_E_NOMEM;
}

static void letters_close(letters *l) {
  mpm_context *c = l->set->context;
  mpmi_free(c, l->id, l->id_bytes);
  mpmi_free(c, l->first, l->first_bytes);
  mpmi_free(c, l->message, l->message_bytes);
}

static int32_t home_of(const letters *l, int64_t id) {
  const uint64_t parts = (uint64_t)l->set->context->transport.parts;
  return (int32_t)(((uint64_t)id * 0x9e3779b97f4a7c15u >> 32) % parts);
}

/* Sends each part what is for it, and takes what comes. */
static mpm_status post(letters *l, int32_t *count, const mpm_message **in) {
  const int32_t parts = l->set->context->transport.parts, me = l->set->context->transport.part;
  int32_t out = 0;
  for (int32_t r = 0; r < parts; ++r) {
    const int64_t bytes = (l->first[r + 1] - l->first[r]) * (int64_t)sizeof *l->id;
    if (r != me && bytes)
      l->message[out++] = (mpm_message){.part = r, .bytes = bytes, .data = l->id + l->first[r]};
  }
  const mpm_status lost = mpmi_send(l->set->context, MPM_EXCHANGE_SPARSE, out, l->message, NULL);
  return lost ? lost : mpmi_receive(l->set->context, count, in);
}

static int64_t ids_in(const mpm_message *message) {
  return message->bytes / (int64_t)sizeof(int64_t);
}

/* ---- given twice --------------------------------------------------------------------------------------- */
static void sort_by_home(letters *l, const int64_t *ids) {
  const int32_t parts = l->set->context->transport.parts;
  for (int64_t i = 0; i < l->n; ++i) ++l->first[home_of(l, ids[i]) + 2];
  for (int32_t r = 1; r <= parts; ++r) l->first[r + 1] += l->first[r];
  for (int64_t i = 0; i < l->n; ++i) l->id[l->first[home_of(l, ids[i]) + 1]++] = ids[i];
}

/* Finds the lowest id that has come twice, or INT64_MAX. */
static mpm_status find_twice(const letters *l, int32_t count, const mpm_message *in, int64_t *twice) {
  mpm_context *c = l->set->context;
  const int32_t me = c->transport.part;
  int64_t n = l->first[me + 1] - l->first[me], at = n;
  for (int32_t i = 0; i < count; ++i) n += ids_in(&in[i]);
  if (n > UINT32_MAX)
    return mpmi_fail(c, MPM_E_UNSUPPORTED, "%lld ids are more than one part compares at once", (long long)n);
  const size_t bytes = mpmi_bytes(n + 1, 3 * sizeof(int64_t) + 2 * sizeof(uint32_t));
  int64_t *all = mpmi_alloc(c, bytes);
  if (!all) return MPM_E_NOMEM;
  uint64_t *key = (uint64_t *)(all + n);
  uint32_t *order = (uint32_t *)(key + 2 * n);
  memcpy(all, l->id + l->first[me], (size_t)at * sizeof *all);
  for (int32_t i = 0; i < count; at += ids_in(&in[i++]))
    if (in[i].bytes) memcpy(all + at, in[i].data, (size_t)ids_in(&in[i]) * sizeof *all);
  if (n) memcpy(key, all, (size_t)n * sizeof *all);
  mpmi_radix_sort(n, key, order, key + n, order + n);
  for (int64_t i = n - 1; i > 0; --i)
    if (all[order[i]] == all[order[i - 1]]) *twice = all[order[i]];
  mpmi_free(c, all, bytes);
  return MPM_OK;
}

/* ---- in use -------------------------------------------------------------------------------------------- */
/* Every part gets the ids that may be in use. */
static mpm_status post_to_all(letters *l, const int64_t *ids, int64_t free_id, int32_t *count,
                              const mpm_message **in) {
  const int32_t parts = l->set->context->transport.parts, me = l->set->context->transport.part;
  int64_t some = 0;
  int32_t out = 0;
  for (int64_t i = 0; i < l->n; ++i)
    if (ids[i] < free_id) l->id[some++] = ids[i];
  for (int32_t r = 0; r < parts && some; ++r)
    if (r != me)
      l->message[out++] = (mpm_message){.part = r, .bytes = some * (int64_t)sizeof *l->id, .data = l->id};
  const mpm_status lost = mpmi_send(l->set->context, MPM_EXCHANGE_SPARSE, out, l->message, NULL);
  return lost ? lost : mpmi_receive(l->set->context, count, in);
}

/* Finds the lowest id that this part has already, or INT64_MAX. */
static mpm_status find_used(const letters *l, int32_t count, const mpm_message *in, int64_t *used) {
  const mpm_status status = count ? mpmi_index_build(l->set) : MPM_OK;
  for (int32_t i = 0; i < count && !status; ++i)
    for (int64_t k = 0; k < ids_in(&in[i]); ++k) {
      int64_t id;
      memcpy(&id, (const char *)in[i].data + k * (int64_t)sizeof id, sizeof id);
      if (id < *used && mpmi_index_find(l->set, id) >= 0) *used = id;
    }
  return status;
}

/* ---- both ---------------------------------------------------------------------------------------------- */
static mpm_status check(letters *l, const int64_t *ids, int64_t lowest, int64_t free_id, int64_t numbered) {
  mpm_context *c = l->set->context;
  int64_t found[2] = {INT64_MAX, INT64_MAX};
  int32_t count = 0;
  const mpm_message *in = NULL;
  sort_by_home(l, ids);
  mpm_status status, lost = post(l, &count, &in);
  if (lost) return lost;
  status = find_twice(l, count, in, &found[0]);
  for (int64_t i = 0; i < l->n; ++i)
    if (ids[i] >= free_id && ids[i] - free_id < numbered && ids[i] < found[0]) found[0] = ids[i];
  if (lowest < free_id) {
    if ((lost = post_to_all(l, ids, free_id, &count, &in))) return lost;
    if (!status) status = find_used(l, count, in, &found[1]);
  }
  if ((status = mpmi_agree(c, status))) return status;
  for (int32_t i = 0; i < 2; ++i) found[i] = -found[i];
  if ((status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, 2, found))) return status;
  if (found[0] > -INT64_MAX)
    return mpmi_fail(c, MPM_E_ARG, "id %lld is given twice, on two parts", (long long)-found[0]);
  if (found[1] > -INT64_MAX)
    return mpmi_fail(c, MPM_E_ARG, "id %lld is in use on another part", (long long)-found[1]);
  return MPM_OK;
}

mpm_status mpmi_check_shared_ids(mpm_particles *set, int64_t n, const int64_t *ids, int64_t lowest,
                                 int64_t free_id, int64_t numbered) {
  letters l;
  mpm_status status = mpmi_agree(set->context, letters_open(&l, set, n));
  if (!status) status = check(&l, ids, lowest, free_id, numbered);
  letters_close(&l);
  return status;
}
