/* A table leads from ids to slots. It ascends by id, is built when asked for, and dropped when particles
 * come, go or move. */
#include "context/radix.h"
#include "particles/particles.h"

typedef struct mpmi_id_slot id_slot;

/* Holes get a key above every id, so that they sort to the end. */
static void build(const mpm_particles *set, uint64_t *key, uint32_t *order, uint64_t *key_scratch,
                  uint32_t *order_scratch, id_slot *index) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int64_t s = 0; s < set->slots; ++s) key[s] = (uint64_t)(id[s] < 0 ? set->next_id : id[s]);
  mpmi_radix_sort(set->slots, key, order, key_scratch, order_scratch);
  for (int64_t i = 0; i < set->count; ++i) index[i] = (id_slot){id[order[i]], order[i]};
}

int32_t mpmi_ids_ascend(const mpm_particles *set) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  int64_t last = -1;
  for (int64_t s = 0; s < set->slots; ++s) {
    if (id[s] < 0) continue;
    if (id[s] < last) return 0;
    last = id[s];
  }
  return 1;
}

/* A host that writes ids through a view for reading makes them neither unique nor as many as particles. */
static int32_t is_sound(const mpm_particles *set, int64_t listed) {
  int64_t last = -1;
  for (int64_t i = 0; i < listed; ++i) {
    if (set->index[i].id <= last || set->index[i].id >= set->next_id) return 0;
    last = set->index[i].id;
  }
  return listed == set->count;
}

/* Ids that ascend with the slots are sorted already, and need no scratch. */
static mpm_status list(mpm_particles *set) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  set->index = mpmi_alloc(set->context, mpmi_bytes(set->count, sizeof *set->index));
  if (!set->index) return MPM_E_NOMEM;
  set->index_capacity = 0;
  int64_t listed = 0;
  for (int64_t s = 0; s < set->slots; ++s) {
    if (id[s] >= 0 && listed < set->count) set->index[listed] = (id_slot){id[s], s};
    listed += id[s] >= 0;
  }
  set->index_capacity = listed;
  return MPM_OK;
}

mpm_status mpmi_refuse_ids(const mpm_particles *set) {
  return mpmi_fail(
      set->context, MPM_E_STATE,
      "the ids of the set are not those of its %lld particles: a view for reading was written to",
      (long long)set->count);
}

static mpm_status check_index(mpm_particles *set) {
  const int64_t listed = set->index_capacity;
  set->index_capacity = set->count;
  if (listed <= set->count && is_sound(set, listed)) return MPM_OK;
  mpmi_index_drop(set);
  return mpmi_refuse_ids(set);
}

mpm_status mpmi_index_build(mpm_particles *set) {
  if (set->index) return MPM_OK;
  if (mpmi_ids_ascend(set)) {
    const mpm_status status = list(set);
    return status ? status : check_index(set);
  }
  mpm_context *context = set->context;
  size_t key_bytes = mpmi_bytes(2 * set->slots, sizeof(uint64_t));
  size_t order_bytes = mpmi_bytes(2 * set->slots, sizeof(uint32_t));
  uint64_t *key = mpmi_alloc(context, key_bytes);
  uint32_t *order = key ? mpmi_alloc(context, order_bytes) : NULL;
  id_slot *index = order ? mpmi_alloc(context, mpmi_bytes(set->count, sizeof *index)) : NULL;
  if (index) {
    build(set, key, order, key + set->slots, order + set->slots, index);
    set->index = index;
    set->index_capacity = set->count;
  }
  mpmi_free(context, order, order_bytes);
  mpmi_free(context, key, key_bytes);
  return index ? check_index(set) : MPM_E_NOMEM;
}

void mpmi_index_drop(mpm_particles *set) {
  MPMI_FREE_ARRAY(set->context, set->index, set->index_capacity);
  set->index = NULL;
  set->index_capacity = 0;
}

int64_t mpmi_index_find(const mpm_particles *set, int64_t id) {
  const id_slot *index = set->index;
  int64_t low = 0, high = set->index_capacity;
  if (high == 0 || id < index[0].id) return -1;
  int64_t ahead = id - index[0].id;
  if (ahead < high && index[ahead].id == id) return index[ahead].slot; /* ids have no gaps */
  while (low < high) {
    int64_t middle = low + (high - low) / 2;
    if (index[middle].id < id)
      low = middle + 1;
    else
      high = middle;
  }
  return low < set->index_capacity && index[low].id == id ? index[low].slot : -1;
}
