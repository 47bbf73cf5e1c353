/* The stages of a step, in its order. */
#ifndef MPMI_STAGES_H
#define MPMI_STAGES_H

#include "layout/projection.h"
#include "layout/step.h"
#include "layout/visit.h"
#include "particles/law_batch.h"

/* ---- forces.c ---------------------------------------------------------------------------------------- */
/* Collects the external forces at time t in the members' rows. */
mpm_status mpmi_forces_stage(mpmi_step *step, double t);

/* ---- places.c ---------------------------------------------------------------------------------------- */
/* Tells whether the host has seen positions since the last step, through a view or in the batches of its
 * callbacks: then it may have written there, whatever it was asked not to do. */
int32_t mpmi_were_shown(const mpmi_step *step, int32_t m);
/* Whether all particles of set m in a block are within its cover; if not, one is noted as the
 * failure of the task. Only a host that writes to what it was lent for reading can bring them elsewhere. */
int32_t mpmi_is_in_place(mpmi_step *step, const mpmi_visit *visit, int32_t m);
/* The same of all blocks and sets, for a step under way in which the host could read positions. */
mpm_status mpmi_places_check(mpmi_step *step);

/* ---- p2g.c ------------------------------------------------------------------------------------------- */
/* Projects all particles onto the nodes of a projection: their sums are made anew. */
mpm_status mpmi_p2g_stage(mpmi_step *step, const mpmi_projection *projection, mpmi_nodes *nodes);

/* ---- node_update.c ----------------------------------------------------------------------------------- */
/* Turns momenta into velocities and forces into increments, on every node as if it were free. */
mpm_status mpmi_node_update_stage(mpmi_step *step, const mpmi_projection *projection, mpmi_nodes *nodes);

/* ---- node_places.c ----------------------------------------------------------------------------------- */
/* Finds where the nodes of a total Lagrangian grid have come to, where obstacles want to know that. */
mpm_status mpmi_node_places_stage(mpmi_step *step, mpmi_nodes *nodes);

/* ---- xpic.c ------------------------------------------------------------------------------------------ */
/* Leaves the corrections in the second copy of the particles' velocities. */
mpm_status mpmi_xpic_stage(mpmi_step *step, mpmi_nodes *nodes);

/* ---- locking.c --------------------------------------------------------------------------------------- */
/* Averages over cells the dilation that these nodal velocities make, into the nodes' sums, for the pass that
 * deforms. */
mpm_status mpmi_locking_stage(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);

/* Scales the deformation that the law is about to see, and gives the particles their new ratio; cells: tile
 * of cell sums. */
void mpmi_locking_apply(const mpmi_settings *settings, const double *cells, const mpmi_axis *axis,
                        mpm_particles *set, mpmi_law_batch *b, int64_t begin, int64_t n, double dt);

/* ---- cells.c ----------------------------------------------------------------------------------------- */
/* Finds the place of each particle's cell in the tile, of whole chunks. */
void mpmi_cell_places(const mpm_grid *grid, const mpmi_axis *axis, const mpmi_points *points, int64_t begin,
                      int64_t n, int32_t *place);

typedef struct mpmi_cell_job {
  mpmi_step *step;
  mpmi_nodal *cells;                /* the sums */
  const struct mpmi_cell_work *sum; /* what is summed up */
  int32_t copy;                     /* of stress and dilation ratio */
} mpmi_cell_job;
/* What is done with particles and their cells in a tile. */
typedef struct mpmi_cell_work {
  int32_t (*takes)(const mpmi_cell_job *job, const mpmi_visit *visit,
                   int32_t m); /* whether a set takes part */
  void (*chunk)(const mpmi_cell_job *job, int32_t m, int64_t begin, int64_t n, const int32_t *place,
                double *tile);
} mpmi_cell_work;
/* Goes through the particles of a block, chunk by chunk. */
void mpmi_cells_visit(const mpmi_cell_job *job, const mpmi_visit *visit, const mpmi_cell_work *work,
                      double *tile);
/* Makes the sums of a job. */
mpm_status mpmi_cells_sum(mpmi_cell_job *job);

/* ---- cell_pressure.c --------------------------------------------------------------------------------- */
/* Whether a member has a stress for the forces on nodes beside that of its particles. */
int32_t mpmi_has_nodal_stress(const mpmi_settings *settings, const mpmi_layout *layout);

/* Averages pressures over cells: writes the members' nodal stress, by the volumes that particles have and a
 * copy of their stress and dilation ratio. The nodes' sums are made anew. */
mpm_status mpmi_cell_pressure_stage(mpmi_step *step, mpmi_nodes *nodes, int32_t copy);

/* ---- marker_nodes.c ---------------------------------------------------------------------------------- */
/* A field on nodes that markers give to and take from: the masses that carry it, which are not folded, which
 * nodes go together in it, and the walls that mirror it. */
typedef struct mpmi_marker_field {
  const mpmi_nodal *masses;
  const mpmi_constraints *ties;
  const mpmi_wall *wall;
} mpmi_marker_field;
/* Finds the nodes around the markers of a surface that take part in a field. */
mpm_status mpmi_surface_find(mpmi_step *step, mpm_surface *surface, const mpmi_marker_field *field);

/* ---- surfaces.c -------------------------------------------------------------------------------------- */
/* Finds what the markers of surfaces that prescribe ask for in the step. */
mpm_status mpmi_surfaces_aim(mpmi_step *step);
/* Asks the host for tractions at time t, and finds the forces of all markers on their present areas. */
mpm_status mpmi_surfaces_load(mpmi_step *step, double t);
/* Finds the nodes around the markers of all surfaces, and refuses loads that no node would take: of several
 * parts each knows of some. */
mpm_status mpmi_surfaces_find(mpmi_step *step, const mpmi_nodal *masses);
/* Does the same, and adds the forces to the sums that particles have made there. */
mpm_status mpmi_surfaces_give(mpmi_step *step, mpmi_nodes *nodes);
/* Returns the first of the nodes around a marker that take something, or -1. */
int64_t mpmi_marker_first_slot(const mpm_surface *surface, int64_t marker);
/* Returns 1 on the one part that tells the others of a marker, after mpmi_surfaces_find(): it owns that
 * node. */
int32_t mpmi_owns_marker(const mpmi_step *step, const mpm_surface *surface, int64_t marker);
/* Refuses loads that no node of any part would take, on all parts alike (collective). */
mpm_status mpmi_surfaces_carried(mpmi_step *step);
/* Stretches all markers with the velocities of these nodes, from what they were at the start of the step, and
 * finds the forces on their new areas. */
mpm_status mpmi_surfaces_stretch(mpmi_step *step, const mpmi_nodal *from);
/* Finds all forces per present area in fixed directions on a marker. */
void mpmi_marker_tractions(const mpm_surface *surface, int64_t marker, double *traction);
/* Moves all markers with the velocities of these nodes, and splits those that have become too long
 * (collective). meets: parts know the outcome of contact on nodes in their own tiles alone. */
mpm_status mpmi_surfaces_move(mpmi_step *step, const mpmi_nodal *from, int32_t meets);

/* ---- motion.c ---------------------------------------------------------------------------------------- */
/* Returns 1 when a position beyond a face on axis k stands on a wall, and puts it there: by rounding, or
 * where it came through between the nodes of a friction wall. */
int32_t mpmi_is_on_wall(const mpmi_settings *settings, int32_t k, double *x);
/* Counts what friction walls did to particles themselves in with the step's impulses and dissipation. */
void mpmi_stops_report(mpmi_step *step);

/* ---- dissipation.c ----------------------------------------------------------------------------------- */
/* Asks the laws of sets whose dissipation becomes heat for their energy as they are. */
mpm_status mpmi_dissipation_prepare(mpmi_step *step);

/* ---- g2p.c ------------------------------------------------------------------------------------------- */
/* Moves and deforms: velocity and position, deformation gradient and stress. That is all of USL. */
mpm_status mpmi_g2p_move_and_deform(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);
/* Moves alone: velocity and position. */
mpm_status mpmi_g2p_move(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);
/* Deforms alone: deformation gradient and stress. */
mpm_status mpmi_g2p_deform(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);
/* Interpolate the nodes' vectors into the second copy of the particles' velocities; or of the accelerations
 * of the sets that do not know them. */
mpm_status mpmi_g2p_velocities(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);
mpm_status mpmi_g2p_accelerations(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);

#endif
