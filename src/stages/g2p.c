/* G2P: the named passes from nodes to particles, which gather by the kernels of transfer/gather.c. */
#include "stages/stages.h"
#include "stages/batch.h"

#include <string.h>

static void bind_both(mpmi_batch *b) {
  mpmi_motion_bind(b);
  mpmi_strain_bind(b);
}

static void enter_both(mpmi_batch *b) {
  mpmi_motion_enter(b);
  mpmi_strain_enter(b);
}

static void aim_both(mpmi_batch *b) {
  mpmi_motion_aim(b);
  mpmi_strain_aim(b);
}

static void aim_motion(mpmi_batch *b) {
  mpmi_motion_aim(b);
  mpmi_gradient_aim(b);
}

static void take_both(mpmi_batch *b) {
  mpmi_motion_take(b);
  mpmi_gradient_keep(b);
  if (mpmi_strain_deform(b)) mpmi_strain_law(b);
  if (b->law_ran) mpmi_batch_sums(b, MPMI_SUMS_LAW | MPMI_SUMS_MOTION);
}

/* Moves a batch. Where the law has run already, this is the last pass and sums up the motion. */
static void take_motion(mpmi_batch *b) {
  const int32_t last = mpmi_deforms_first(b->step->settings);
  if (last) mpmi_wave_speed_fetch(b);
  mpmi_motion_take(b);
  mpmi_gradient_keep(b);
  if (last) mpmi_batch_sums(b, MPMI_SUMS_MOTION);
}

static void take_strain(mpmi_batch *b) {
  const int32_t first = mpmi_deforms_first(b->step->settings);
  mpmi_gradient_keep(b);
  if (mpmi_strain_deform(b)) mpmi_strain_law(b);
  if (!b->law_ran) return;
  if (first) mpmi_wave_speed_leave(b);
  mpmi_batch_sums(b, first ? MPMI_SUMS_LAW : MPMI_SUMS_LAW | MPMI_SUMS_MOTION);
}

static void take_strain_and_place(mpmi_batch *b) {
  mpmi_motion_take(b);
  take_strain(b);
}

static void take_means(mpmi_batch *b, int32_t field) {
  for (int32_t k = 0; k < b->set->grid->dim; ++k)
    memcpy(mpmi_component_row(b->set, field, 1, k) + b->begin, b->v_bar + k * b->law.ld,
           (size_t)b->n * sizeof(double));
}

static void take_velocities(mpmi_batch *b) {
  take_means(b, MPMI_VELOCITY);
}

static void take_accelerations(mpmi_batch *b) {
  if (b->set->dirty & MPMI_DIRTY_ACCELERATION) take_means(b, MPMI_ACCELERATION);
}

static const mpmi_pass both = {
    .moves = 1, .deforms = 1, .bind = bind_both, .enter = enter_both, .aim = aim_both, .take = take_both};
static const mpmi_pass motion = {
    .moves = 1, .bind = bind_both, .enter = mpmi_motion_enter, .aim = aim_motion, .take = take_motion};
static const mpmi_pass strain = {.deforms = 1,
                                 .bind = mpmi_strain_bind,
                                 .enter = mpmi_strain_enter,
                                 .aim = mpmi_strain_aim,
                                 .take = take_strain};
static const mpmi_pass strain_and_place = {.deforms = 1,
                                           .places = 1,
                                           .bind = bind_both,
                                           .enter = enter_both,
                                           .aim = aim_both,
                                           .take = take_strain_and_place};
static const mpmi_pass velocities = {.plain = 1, .take = take_velocities};
static const mpmi_pass accelerations = {.plain = 1, .take = take_accelerations};

/* Runs a pass; the locking remedy measures the dilation before one that deforms. */
static mpm_status run(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from, const mpmi_pass *pass) {
  const int32_t remedy = pass->deforms && step->settings->desc.locking_remedy;
  const mpm_status status = remedy ? mpmi_locking_stage(step, nodes, from) : MPM_OK;
  return status ? status : mpmi_pass_run(step, nodes, from, pass, NULL);
}

mpm_status mpmi_g2p_move_and_deform(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from) {
  return run(step, nodes, from, &both);
}

mpm_status mpmi_g2p_move(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from) {
  return run(step, nodes, from, &motion);
}

mpm_status mpmi_g2p_deform(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from) {
  return run(step, nodes, from, mpmi_moves_last(step->settings) ? &strain_and_place : &strain);
}

mpm_status mpmi_g2p_velocities(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from) {
  return run(step, nodes, from, &velocities);
}

mpm_status mpmi_g2p_accelerations(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from) {
  return run(step, nodes, from, &accelerations);
}
