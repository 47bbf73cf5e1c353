/* The kernels that carry quantities between particles and nodes: one table of them for each instruction set.
 *
 * Kernels work on the slots of one block, chunk by chunk, with the block's tile: a private copy of the
 * block's nodes plus halo. Tile nodes hold `values` doubles: 4 [px py pz m] or 8 [px py pz m fx fy fz 0] when
 * scattering, and [vx vy vz m], [vx vy dvx dvy] or [vx vy vz m dvx dvy dvz 0] when gathering, where v is the
 * updated nodal velocity and dv its change over the step. The last axis runs fastest.
 *
 * They are specialised by dim x stencil width x form x instruction set. A basis family enters through its
 * weights alone. */
#ifndef MPMI_KERNELS_H
#define MPMI_KERNELS_H

#include "transfer/box.h"
#include "transfer/gather.h"
#include "transfer/move.h"
#include "transfer/scalars.h"
#include "transfer/scatter.h"
#include "transfer/separation.h"
#include "transfer/stiffness.h"
#include "transfer/sums.h"
#include "transfer/update.h"

typedef struct mpmi_kernels {
  mpmi_weights_fn weights[MPMI_FAMILIES][4];                          /* by family of the basis, dim */
  mpmi_scatter_fn scatter[4][MPMI_MAX_WIDTH + 1][MPMI_SCATTER_FORMS]; /* by dim, width, form */
  mpmi_gather_fn gather[4][MPMI_MAX_WIDTH + 1][MPMI_GATHER_FORMS];
  mpmi_add_box_fn add_box;
  mpmi_add_flat_box_fn add_flat_box;
  mpmi_fetch_box_fn fetch_box;
  mpmi_load_box_fn load_box;
  mpmi_update_fn update;
  mpmi_move_fn move[4], look[4];
  mpmi_sums_fn sums[4];
  mpmi_push_fn push[4];
  mpmi_force_scatter_fn force_scatter[4][MPMI_MAX_WIDTH + 1];
  mpmi_stiffness_fn stiffness[4];
  mpmi_give_values_fn give_values[4][MPMI_MAX_WIDTH + 1]; /* by dim, width */
  mpmi_take_values_fn take_values[4][MPMI_MAX_WIDTH + 1];
  mpmi_conduct_fn conduct[4][MPMI_MAX_WIDTH + 1];
  mpmi_separate_fn discriminate[4], fit[4];
  mpmi_project_fn project[4];
} mpmi_kernels;

MPMI_DECLARE_TABLES(mpmi_kernels, mpmi_kernels);

static inline const mpmi_kernels *mpmi_kernels_of(int32_t isa) {
  return MPMI_TABLE_OF(isa, mpmi_kernels);
}

#endif
