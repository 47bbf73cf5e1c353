/* The hash of a physical state is a sum over particles, so that neither their order nor the cut of the
 * work matters. */
#include "context/transport.h"
#include "context/mix.h"
#include "particles/values.h"
#include "stepper/stepper.h"

#include <string.h>

enum { PIECES = 64, PORTION = 256 };

typedef struct hash_job {
  const mpm_particles *set;
  uint64_t set_seed, field_seed[MPMI_MAX_FIELDS];
  uint64_t sum[PIECES];
} hash_job;

static uint64_t bits(double x) {
  uint64_t word;
  memcpy(&word, &x, sizeof word);
  return word;
}

/* Fields are told apart by name, so that the order in which the host added its own does not matter. */
static uint64_t seed_of(const char *name) {
  uint64_t h = MPMI_MIX_C;
  for (; *name; ++name) h = mpmi_absorb(h, (unsigned char)*name);
  return mpmi_avalanche(h);
}

/* Fields that every set has count whatever their values. Others count only where they differ from what
 * they read as when absent, so that presence alone makes no difference. */
static int32_t always_counts(int32_t field) {
  switch (field) {
  case MPMI_POSITION:
  case MPMI_VELOCITY:
  case MPMI_MASS:
  case MPMI_VOLUME:
  case MPMI_INITIAL_VOLUME:
  case MPMI_F:
  case MPMI_STRESS:
  case MPMI_STATE:
    return 1;
  default:
    return 0;
  }
}

static void load_words(const mpmi_field *field, const char *row, int64_t begin, int64_t n, uint64_t *word) {
  const size_t size = mpmi_type_size(field->type);
  if (size == sizeof *word)
    memcpy(word, row + (size_t)begin * size, (size_t)n * size);
  else
    for (int64_t i = 0; i < n; ++i) word[i] = ((const uint8_t *)row)[begin + i];
}

/* Loads what the field reads as when it is absent, in the bits of component c. */
static void load_defaults(const mpm_particles *set, int32_t f, int32_t c, int64_t begin, int64_t n,
                          uint64_t *word) {
  if (f == MPMI_SIZE && c > 0) return; /* the size is the same for every component, and costs a root */
  for (int64_t i = 0; i < n; ++i)
    word[i] = f == MPMI_SIZE || f == MPMI_REFERENCE ? bits(mpmi_absent_value(set, f, c, begin + i)) : 0;
}

static void add_field(const hash_job *job, int32_t f, int64_t begin, int64_t n, uint64_t *total) {
  const mpm_particles *set = job->set;
  const mpmi_field *field = &set->field[f];
  uint64_t h[PORTION], word[PORTION], absent[PORTION], differs[PORTION];
  for (int64_t i = 0; i < n; ++i) h[i] = job->field_seed[f];
  for (int64_t i = 0; i < n; ++i) differs[i] = always_counts(f) ? 1 : 0;
  for (int32_t c = 0; c < field->components; ++c) {
    load_words(field, (const char *)field->data[0] + (size_t)(c * set->ld) * mpmi_type_size(field->type),
               begin, n, word);
    for (int64_t i = 0; i < n; ++i) h[i] = mpmi_absorb(h[i], word[i]);
    if (always_counts(f)) continue;
    load_defaults(set, f, c, begin, n, absent);
    for (int64_t i = 0; i < n; ++i) differs[i] |= word[i] ^ absent[i];
  }
  for (int64_t i = 0; i < n; ++i)
    if (differs[i]) total[i] += mpmi_avalanche(h[i]);
}

static void hash_piece(void *data, int64_t k) {
  hash_job *job = data;
  const mpm_particles *set = job->set;
  const int64_t portions = (set->slots + PORTION - 1) / PORTION;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  uint64_t sum = 0;
  for (int64_t portion = portions * k / PIECES; portion < portions * (k + 1) / PIECES; ++portion) {
    const int64_t begin = portion * PORTION, n = set->slots - begin < PORTION ? set->slots - begin : PORTION;
    uint64_t total[PORTION] = {0};
    for (int32_t f = 0; f < set->field_count; ++f)
      if (f != MPMI_ID && set->field[f].present) add_field(job, f, begin, n, total);
    for (int64_t i = 0; i < n; ++i)
      if (id[begin + i] >= 0)
        sum += mpmi_avalanche(mpmi_absorb(mpmi_absorb(job->set_seed, (uint64_t)id[begin + i]), total[i]));
  }
  job->sum[k] = sum;
}

/* Sums up over all parts, which add modulo 2^64 as the sum does. */
static mpm_status hash_set(const mpm_particles *set, int32_t number, uint64_t *hash) {
  hash_job job = {.set = set, .set_seed = mpmi_avalanche((uint64_t)number + MPMI_MIX_B)};
  for (int32_t f = 0; f < set->field_count; ++f) job.field_seed[f] = seed_of(set->field[f].name);
  if (set->slots) mpmi_parallel_for_sure(set->context, PIECES, hash_piece, &job);
  uint64_t sum = 0;
  for (int32_t k = 0; k < PIECES; ++k) sum += job.sum[k];
  int64_t all[] = {(int64_t)sum, set->count};
  const mpm_status status = mpmi_reduce_parts(set->context, MPM_REDUCE_SUM, 2, all);
  *hash = mpmi_avalanche(mpmi_absorb(job.set_seed + (uint64_t)all[0], (uint64_t)all[1]));
  return status;
}

static uint64_t hash_pose(uint64_t h, const mpmi_pose *pose) {
  for (int32_t k = 0; k < 3; ++k)
    h = mpmi_absorb(mpmi_absorb(h, bits(pose->centre[k])), bits(pose->velocity[k]));
  for (int32_t k = 0; k < 3; ++k) h = mpmi_absorb(h, bits(pose->spin[k]));
  for (int32_t k = 0; k < 4; ++k) h = mpmi_absorb(h, bits(pose->orientation[k]));
  return h;
}

/* Springs of surfaces that prescribe are a part of the state that others do not have. */
static uint64_t hash_markers(uint64_t h, const mpmi_markers *markers, int32_t prescribes) {
  h = mpmi_absorb(h, (uint64_t)markers->count);
  for (int64_t i = 0; i < markers->count; ++i) {
    const mpmi_marker *m = &markers->at[i];
    h = mpmi_absorb(h, (uint64_t)m->id);
    for (int32_t k = 0; k < 3; ++k)
      h = mpmi_absorb(mpmi_absorb(mpmi_absorb(h, bits(m->position[k])), bits(m->edge[0][k])),
                      bits(m->edge[1][k]));
    for (int32_t k = 0; k < 3 && prescribes; ++k)
      h = mpmi_absorb(mpmi_absorb(h, bits(m->gap[k])), bits(m->prescribed_velocity[k]));
  }
  return h;
}

mpm_status mpm_state_hash(const mpm_stepper *stepper, uint64_t *hash) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  if (!hash) return mpmi_agree(stepper->context, mpmi_fail(stepper->context, MPM_E_ARG, "hash is NULL"));
  uint64_t h = mpmi_absorb(
      mpmi_absorb(mpmi_absorb(MPMI_MIX_A, bits(stepper->history.t)), (uint64_t)stepper->history.step),
      (uint64_t)stepper->layout.member_count);
  for (int32_t m = 0; m < stepper->layout.member_count; ++m) {
    mpm_particles *set = stepper->layout.member[m].set;
    /* Volume and stress follow from F and may be out of date. The host must not see that, const or not. */
    uint64_t of_set;
    mpm_status status = mpmi_agree(stepper->context, mpmi_settle(set, MPMI_STRESS));
    if (!status) status = hash_set(set, m, &of_set);
    if (status) return status;
    h = mpmi_absorb(h, of_set);
  }
  const mpmi_obstacles *obstacles = &stepper->settings.obstacles;
  for (int64_t i = 0; i < obstacles->count; ++i) h = hash_pose(h, &obstacles->obstacle[i]->pose);
  const mpmi_surfaces *surfaces = &stepper->settings.surfaces;
  for (int64_t i = 0; i < surfaces->count; ++i) {
    const mpm_surface *surface = surfaces->surface[i];
    h = hash_markers(h, &surface->now, mpmi_surface_prescribes(surface));
  }
  *hash = mpmi_avalanche(h);
  return MPM_OK;
}
