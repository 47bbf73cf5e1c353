/* The end of a step: the second copies become the state, or are dropped. */
#include "stepper/stepper.h"

#include <string.h>

static int32_t written_by_step(int32_t field) {
  switch (field) {
  case MPMI_POSITION:
  case MPMI_VELOCITY:
  case MPMI_ACCELERATION:
  case MPMI_F:
  case MPMI_L:
  case MPMI_STRESS:
  case MPMI_STATE:
  case MPMI_DILATION_RATIO:
  case MPMI_IMAGE:
    return 1;
  default:
    return 0;
  }
}

/* Particles that went through an open wall become holes. The hole stays where the particle was before the
 * step, inside its tile. */
static void remove_outside(mpm_stepper *s, mpm_particles *set) {
  const mpm_grid *grid = s->grid;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int64_t slot = 0; slot < set->slots; ++slot) {
    int32_t outside = 0;
    for (int32_t k = 0; id[slot] >= 0 && k < grid->dim; ++k) {
      const double x = mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + slot];
      outside |= x < grid->desc.origin[k] || x > grid->upper[k];
    }
    if (!outside) continue;
    for (int32_t k = 0; k < grid->dim; ++k)
      mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + slot] =
          mpmi_f64(set, MPMI_POSITION, 1)[k * set->ld + slot];
    mpmi_make_hole(set, slot);
    --set->count;
    ++s->removed;
    s->energies.valid = 0;
    mpmi_index_drop(set);
  }
}

static void add_up_blocks(mpm_stepper *s) {
  mpmi_sums sums = {0};
  for (int64_t i = 0; i < s->cut.count; ++i) mpmi_add_sums(&sums, &s->block_sums[s->cut.list[i]]);
  s->energies = (mpmi_energies){1, sums};
}

void mpmi_commit(mpm_stepper *s, double dt) {
  int32_t left = 0, removes = 0, restored = 0;
  for (int32_t k = 0; k < s->tasks; ++k) {
    left |= s->scratch[k].left_tile;
    removes |= s->scratch[k].removes;
    restored |= s->scratch[k].holes_restored;
  }
  const mpmi_sums before = s->energies.sums;
  mpmi_prescribed_commit(s);
  add_up_blocks(s);
  const mpmi_sums *after = &s->energies.sums;
  for (int32_t m = 0; m < s->member_count; ++m) {
    mpm_particles *set = s->member[m].set;
    for (int32_t f = 0; f < set->field_count; ++f) {
      mpmi_field *field = &set->field[f];
      if (!field->present || !written_by_step(f)) continue;
      void *swap = field->data[0];
      field->data[0] = field->data[1];
      field->data[1] = swap;
    }
    if (left) set->dirty |= MPMI_DIRTY_PLACE;
    set->dirty &= ~(uint32_t)(MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION);
    if (!mpmi_is_implicit(s) || s->desc.quasi_static) set->dirty |= MPMI_DIRTY_ACCELERATION;
  }
  s->t += dt;
  ++s->step;
  const double work = after->work + s->prescribed_work;
  s->last.external_work = work;
  s->last.dissipation = before.kinetic + before.strain + work - after->kinetic - after->strain;
  memcpy(s->impulse_by_face, s->impulse_in_step, sizeof s->impulse_by_face);
  s->reaction_dt = s->velocity_dt;
  s->previous_dt = s->desc.staggered ? dt : 0.0;
  s->has_reactions = 1;
  if (restored) s->energies.valid = 0;
  if (removes)
    for (int32_t m = 0; m < s->member_count; ++m) remove_outside(s, s->member[m].set);
}

void mpmi_make_volumes(mpm_stepper *s, int32_t copy) {
  const int32_t dim = s->grid->dim;
  for (int32_t m = 0; m < s->member_count; ++m) {
    mpm_particles *set = s->member[m].set;
    if (!set->slots) continue;
    const double *F[9];
    for (int32_t c = 0; c < mpmi_tensor_components(dim); ++c)
      F[c] = mpmi_f64(set, MPMI_F, copy) + c * set->ld;
    s->kernels->volume[dim](F, mpmi_f64(set, MPMI_INITIAL_VOLUME, 0), mpmi_f64(set, MPMI_VOLUME, 0),
                            set->slots);
  }
}

/* Only volumes were overwritten: F is still there to make them again. */
void mpmi_roll_back(mpm_stepper *s) {
  mpmi_make_volumes(s, 0);
}
