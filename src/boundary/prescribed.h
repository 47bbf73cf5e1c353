/* Prescribed particles: platens, pistons, rigid tools. On the axes where its field "prescribed" is 1 a
 * particle moves with a given mean velocity, and so do the nodes that it touches.
 *
 *   prescribed.c         which they are, their velocities, their motion, what they report
 *   prescribed_nodes.c   the nodes that they hold, and their share of the nodes' impulses
 *
 * With the nodal mass M_ic = sum w_ip m_p of those that are prescribed on axis c, a node that nothing before
 * them holds gets v_ic = sum w_ip m_p u_pc / M_ic. Of its impulse I_ic a particle has the share m_p w_ip /
 * M_ic. From that, and from its external forces, it takes the momentum m_p (v' - v_p) that it would gain as
 * any other particle; the rest is what the material gets. */
#ifndef MPMI_PRESCRIBED_H
#define MPMI_PRESCRIBED_H

#include "layout/nodes.h"
#include "layout/step.h"

/* Flags of a block. */
enum {
  MPMI_WITH_PRESCRIBED = 1,
  MPMI_TOUCHED = 2 /* has nodes that such particles touch, or masters of those: its sums are in use */
};

static inline int32_t mpmi_block_is(const mpmi_nodes *nodes, int64_t block, int32_t flag) {
  return nodes->prescription.block[block] & flag;
}

/* Returns 1 when the particle in a slot is prescribed on axis c; a hole never is. The member must have such
 * particles. */
static inline int32_t mpmi_is_prescribed(const mpm_particles *set, int64_t slot, int32_t c) {
  return ((const uint8_t *)set->field[MPMI_PRESCRIBED].data[0])[c * set->ld + slot];
}

/* Returns the mean velocities of the step, [dim][ld of the set]. */
static inline const double *mpmi_mean_velocity(const mpmi_step *step, int32_t m) {
  const double *mean = step->work->rows.of[m].mean;
  return mean ? mean : mpmi_f64(step->layout->member[m].set, MPMI_VELOCITY, 0);
}

static inline mpmi_prescribed_part *mpmi_part_of(const mpmi_layout *layout, const mpmi_nodes *nodes,
                                                 int64_t block, int32_t m) {
  return &nodes->prescription.part[block * layout->member_count + m];
}

/* Finds the prescribed particles, and makes room for their sums on the nodes. */
mpm_status mpmi_prescribed_prepare(mpmi_layout *layout, mpmi_nodes *nodes, const mpmi_settings *settings);
/* Asks the host for the mean velocities of the step where there is a motion. */
mpm_status mpmi_prescribed_stage(mpmi_step *step);
/* Moves the prescribed particles of a batch, which was moved as any other, as they must move; returns flags
 * of mpmi_move. */
uint32_t mpmi_prescribed_move(const mpmi_step *step, mpmi_nodes *nodes, int32_t m, int64_t block,
                              const mpmi_move *move, int64_t begin, int64_t n);
/* Adds the impulse of a set's prescribed particles on the material, and the work of moving them, to the
 * step's. */
void mpmi_prescribed_report(const mpmi_step *step, const mpmi_nodes *nodes, int32_t m);

#endif
