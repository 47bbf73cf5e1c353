/* Splitting and merging of particles. First everything is found and computed that may fail, from the state
 * that a step has made or from the present one; then it is done to the present state, which cannot fail. */
#ifndef MPMI_ADAPTION_H
#define MPMI_ADAPTION_H

#include "context/transport.h"
#include "layout/step.h"
#include "particles/builtin_fields.h"

#include <math.h>
#include <string.h>

/* A particle that is split: bit k of `edges` for its edge k. */
typedef struct mpmi_splitting {
  int64_t id, slot;
  int32_t edges;
  int64_t before; /* so many particles come of those with lower ids that are split, on all parts */
} mpmi_splitting;

/* Returns how many particles come of one whose edges are halved. */
static inline int32_t mpmi_parts_of(int32_t edges) {
  return 1 << ((edges & 1) + (edges >> 1 & 1) + (edges >> 2 & 1));
}

/* A pair that is merged: the slots of the particle that stays and of the one that goes. */
typedef struct mpmi_merging {
  int64_t id, other;
  int64_t stays, goes;
  int32_t bad; /* 1: their deformations have no mean */
  double strain_loss;
} mpmi_merging;

/* What it has done: see mpm_adaption_info. */
typedef struct mpmi_adaption_sums {
  int64_t splits, added, merges;
  double kinetic, affine, strain, angular[3];
} mpmi_adaption_sums;

/* The sums of an adaption that are no counts, as they are made. */
enum { MPMI_LOST_KINETIC, MPMI_LOST_AFFINE, MPMI_LOST_STRAIN, MPMI_LOST_ANGULAR, MPMI_LOST = 6 };

/* A particle of another part, of which this one has a copy: where it is. */
typedef struct mpmi_stray {
  int32_t part;
  int64_t slot;
} mpmi_stray;

/* How a set adapts, and what is about to be done to it. */
typedef struct mpmi_adaption {
  int32_t on, planned;
  mpm_adaption_desc desc;
  mpmi_adaption_sums sums; /* since it was first described, or the time was set */
  mpmi_whole_sum lost[MPMI_LOST];
  int64_t added, split_total, pair_total; /* on all parts: particles that come, those that are split, pairs */
  int64_t own;                            /* slots of the set: copies of particles of other parts follow */
  int64_t strays, stray_capacity;
  mpmi_stray *stray;
  int64_t gone_count, gone_capacity; /* slots of particles that go, merged with others on another part */
  int64_t *gone;
  int32_t skips; /* particles are left out that are `away`, by slot: others choose for them */
  uint8_t *away;
  int64_t away_capacity;
  mpmi_splitting *split;
  int64_t splits, split_capacity;
  mpmi_merging *pair;
  int64_t pairs, pair_capacity;
  double *merged; /* [pairs][mpmi_merged_rows()] F, stress and state of the particles that pairs become */
  int64_t merged_capacity;
  uint64_t *key; /* memory for sorting: two of each particle */
  uint32_t *order;
  int64_t key_capacity, order_capacity;
  uint8_t *taken; /* by slot: into how many parts the particle is split; 1: it is merged */
  int64_t taken_capacity;
} mpmi_adaption;

/* Returns the row of a component in the state that `copy` 1 has of a step, or that copy 0 has. */
static inline const double *mpmi_row_of(const mpm_particles *set, int32_t field, int32_t copy, int32_t c) {
  return mpmi_f64(set, field, set->field[field].two_copies ? copy : 0) + c * set->ld;
}

/* Edge a of a particle's domain, in lengths. */
static inline void mpmi_domain_edge(const mpm_particles *set, int32_t copy, int64_t slot, int32_t a,
                                    double *edge) {
  const int32_t dim = set->grid->dim;
  const double length = mpmi_row_of(set, MPMI_SIZE, copy, a)[slot];
  for (int32_t k = 0; k < dim; ++k)
    edge[k] = length * mpmi_row_of(set, MPMI_F, copy, mpmi_stored_entry(dim, k, a))[slot];
}
/* Returns the length of an edge in cells. */
double mpmi_edge_in_cells(const mpm_grid *grid, const double *edge);

/* Returns 1 where the velocity of a particle is prescribed on an axis: it stays what it is. */
static inline int32_t mpmi_keeps_velocity(const mpm_particles *set, int64_t slot, int32_t axis) {
  const mpmi_field *field = &set->field[MPMI_PRESCRIBED];
  return field->present && axis < set->grid->dim && ((const uint8_t *)field->data[0])[axis * set->ld + slot];
}

void mpmi_adaption_free(mpmi_adaption *a, mpm_context *context);

/* A set that adapts, member m of a stepper: from the state in `copy`, at time t. step: that makes it, or
 * NULL. */
typedef struct mpmi_adapting {
  mpmi_adaption *a;
  mpm_particles *set;
  mpmi_parts *parts; /* NULL: there is one */
  const mpmi_settings *settings;
  const mpmi_step *step;
  int32_t m, copy;
  double t;
} mpmi_adapting;

/* Finds and computes all that is to be done, and makes room for it, on all parts or none (collective). */
mpm_status mpmi_adaption_plan(const mpmi_adapting *of);
/* Does the same where there are several parts (strays.c). */
mpm_status mpmi_adaption_plan_together(const mpmi_adapting *of);

/* Returns the cell along an axis in which a position is. */
static inline int64_t mpmi_cell_along(const mpm_grid *grid, int32_t axis, double x) {
  const double at = floor((x - grid->desc.origin[axis]) * grid->inverse_spacing[axis]);
  const double last = (double)grid->desc.cells[axis] - 1.0;
  return (int64_t)(at > last ? last : at > 0.0 ? at : 0.0);
}
/* Returns 1 for particles, but not for those that an open wall lets go: they are not there any more once the
 * step is made. */
int32_t mpmi_adapts_slot(const mpm_particles *set, int32_t copy, int64_t slot);
/* Finds what is to be done: fills in the lists, in the order of ids (choose.c). */
mpm_status mpmi_adaption_choose(mpmi_adaption *a, const mpm_particles *set, int32_t copy);
/* Finds how many particles come before those of each that is split, and how many there are on all parts
 * (ranks.c, collective). */
mpm_status mpmi_adaption_rank(const mpmi_adapting *of, int64_t *total);
/* Ends the list, which has ranks, where the set would get too large; it has so many on all parts. */
void mpmi_adaption_limit(const mpmi_adapting *of, int64_t particles);
/* Computes what pairs become, and drops pairs that are not alike by the law or that it refuses (merge.c). */
mpm_status mpmi_adaption_merge_states(mpmi_adaption *a, const mpm_particles *set, int32_t copy, double t);
/* Asks the host, whose answers thin out the lists (accept.c). */
mpm_status mpmi_adaption_ask(mpmi_adaption *a, const mpm_particles *set, int32_t copy);
/* Moves the i-th pair, with what it becomes, to another place in the list, before it. */
void mpmi_keep_merging(mpmi_adaption *a, const mpm_particles *set, int64_t i, int64_t at);
/* Makes room for the particles that come, in both copies where `copy` is 1 (split.c). */
mpm_status mpmi_adaption_reserve(const mpmi_adaption *a, mpm_particles *set, int32_t copy);

/* Do it to the present state (split.c, merge.c): first pairs, for new particles take the place of copies. */
void mpmi_adaption_merge(mpmi_adaption *a, const mpmi_settings *settings, mpm_particles *set);
void mpmi_adaption_split(mpmi_adaption *a, const mpmi_settings *settings, mpm_particles *set);

/* ---- momenta.c ---------------------------------------------------------------------------------------- */
/* A particle's motion, with the matrix that the transfer carries and the second moments of the basis
 * there. */
typedef struct mpmi_motion_of {
  double mass, x[3], v[3], C[3][3], D[3];
} mpmi_motion_of;
/* Reads the motion of a slot; C and D are 0 where the transfer carries no matrix. */
mpmi_motion_of mpmi_motion_in(const mpmi_settings *settings, const mpm_particles *set, int64_t slot);
void mpmi_second_moments(const mpmi_settings *settings, const mpm_particles *set, int64_t slot, double *D);
void mpmi_write_motion(const mpmi_settings *settings, mpm_particles *set, int64_t slot,
                       const mpmi_motion_of *motion);
/* Adds a particle's energies and its angular momentum about a centre, times sign, to what is lost. */
void mpmi_count_motion(const mpm_grid *grid, const mpmi_motion_of *motion, const double *centre, double sign,
                       mpmi_whole_sum *lost);

/* Doubles of a merged particle: F, stress, state. */
static inline int64_t mpmi_merged_rows(const mpm_particles *set) {
  return mpmi_tensor_components(set->grid->dim) + mpmi_stress_components(set->grid->dim) +
         set->material->state_count;
}

#endif
