/* Explicit steps in three parts, with the host in between where it wants: particles to nodes, the nodes' own
 * part, nodes to particles. USL, USF and MUSL are an order of stages (table in docs/theory.md). */
#include "stepper/stepper.h"
#include "boundary/boundary.h"
#include "boundary/prescribed.h"
#include "boundary/surface_holds.h"
#include "stages/stages.h"

/* Makes a projection beside the one with the forces of the step, up to its boundary conditions. */
static mpm_status project(mpmi_step *step, mpmi_nodes *nodes, int32_t projection, double *clock) {
  const mpmi_projection *of = &mpmi_projections[projection];
  mpm_status status = mpmi_p2g_stage(step, of, nodes);
  mpmi_lap(step, MPMI_TIME_P2G, clock);
  if (!status) status = mpmi_node_update_stage(step, of, nodes);
  if (!status) status = mpmi_boundary_stage(step, of, nodes, 0.0);
  mpmi_lap(step, MPMI_TIME_GRID, clock);
  return status;
}

/* Strains the particles by the velocities of a projection, and computes their stress. */
static mpm_status deform(mpmi_step *step, mpmi_nodes *nodes, double *clock) {
  const mpm_status status = mpmi_g2p_deform(step, nodes, &nodes->projected);
  mpmi_lap(step, MPMI_TIME_G2P, clock);
  return status;
}

/* Returns 1 where the strain of USF needs to know which contacts are closed. Of several parts one alone may
 * have nodes on a wall. */
static int32_t finds_contacts_first(const mpmi_step *step, const mpmi_nodes *nodes) {
  const int32_t on_walls = step->layout->parts ? mpmi_has_friction_nodes(step->settings)
                                               : step->layout->constraints.contact_count > 0;
  return on_walls || nodes->contact.anywhere;
}

/* Strains the particles of USF by the velocities at the start of the step. */
static mpm_status deform_first(mpmi_step *step, mpmi_nodes *nodes, double *clock) {
  mpm_status status = MPM_OK;
  if (finds_contacts_first(step, nodes)) status = project(step, nodes, MPMI_PROJECT_CONTACT, clock);
  if (!status) status = project(step, nodes, MPMI_PROJECT_STRAIN, clock);
  return status ? status : deform(step, nodes, clock);
}

mpm_status mpmi_explicit_begin(mpmi_step *step, mpmi_nodes *nodes) {
  double clock = mpmi_seconds();
  mpm_status status = mpmi_forces_stage(step, step->t);
  if (!status) status = mpmi_surfaces_aim(step);
  if (!status) status = mpmi_surfaces_load(step, step->t);
  if (!status) status = mpmi_prescribed_stage(step);
  mpmi_lap(step, MPMI_TIME_CALLBACKS, &clock);
  if (!status) status = mpmi_node_places_stage(step, nodes);
  if (!status && step->settings->desc.scheme == MPM_USF) status = deform_first(step, nodes, &clock);
  if (!status) status = mpmi_p2g_stage(step, &mpmi_projections[MPMI_PROJECT_FORCES], nodes);
  mpmi_lap(step, MPMI_TIME_P2G, &clock);
  return status;
}

mpm_status mpmi_explicit_grid(mpmi_step *step, mpmi_nodes *nodes) {
  const mpmi_projection *forces = &mpmi_projections[MPMI_PROJECT_FORCES];
  double clock = mpmi_seconds();
  mpm_status status = mpmi_node_update_stage(step, forces, nodes);
  if (!status) status = mpmi_boundary_stage(step, forces, nodes, 1.0);
  if (!status && step->layout->parts)
    step->info.active_nodes = mpmi_count_owned(step->layout, &nodes->solved);
  if (!status && step->layout->parts) step->layout->parts->has_counted = 1;
  mpmi_lap(step, MPMI_TIME_GRID, &clock);
  return status;
}

mpm_status mpmi_explicit_end(mpmi_step *step, mpmi_nodes *nodes) {
  const mpmi_settings *settings = step->settings;
  double clock = mpmi_seconds();
  mpm_status status = mpmi_corrects(step) ? mpmi_xpic_stage(step, nodes) : MPM_OK;
  if (!status)
    status = settings->desc.scheme == MPM_USL ? mpmi_g2p_move_and_deform(step, nodes, &nodes->solved)
                                              : mpmi_g2p_move(step, nodes, &nodes->solved);
  mpmi_lap(step, MPMI_TIME_G2P, &clock);
  if (!status && settings->desc.scheme == MPM_MUSL) {
    status = project(step, nodes, MPMI_PROJECT_MOVED, &clock);
    if (!status) status = deform(step, nodes, &clock);
  }
  if (!status) mpmi_surface_holds_report(step, nodes);
  mpmi_move_samples(step, MPMI_TIME_G2P);
  return status;
}

mpm_status mpmi_explicit_move_surfaces(mpmi_step *step, mpmi_nodes *nodes) {
  return mpmi_surfaces_move(step, mpmi_moves_last(step->settings) ? &nodes->projected : &nodes->solved,
                            nodes->contact.anywhere);
}

/* ---- how many sums on nodes that makes ---------- */
/* Sums of cells come before forces and strains; those of prescribed particles in the projection that asks who
 * holds nodes. */
static int64_t of_projection(const mpmi_step *step, const mpmi_nodes *nodes, int32_t projection) {
  const mpmi_projection *of = &mpmi_projections[projection];
  return 1 + (of->forces && mpmi_has_nodal_stress(step->settings, step->layout)) +
         (mpmi_asks_host(step->settings, of) && nodes->prescription.any);
}

/* Nodes of total Lagrangian grids are placed first. */
static int64_t placing(const mpmi_step *step, const mpmi_nodes *nodes) {
  return mpmi_places_nodes(step->settings, nodes) ? of_projection(step, nodes, MPMI_PROJECT_DISPLACEMENT) : 0;
}

int64_t mpmi_explicit_exchanges(const mpmi_step *step, const mpmi_nodes *nodes, int32_t phase) {
  const mpmi_settings *settings = step->settings;
  const int64_t strain = settings->desc.locking_remedy != 0;
  const int64_t holds =
      mpmi_asks_host(settings, &mpmi_projections[MPMI_PROJECT_FORCES]) && nodes->prescription.any;
  const int32_t correction = step->takes == MPMI_TAKES_FULL ? MPMI_PROJECT_FULL : MPMI_PROJECT_CORRECTION;
  int64_t count = of_projection(step, nodes, MPMI_PROJECT_FORCES) - holds;
  count += placing(step, nodes);
  if (settings->desc.scheme == MPM_USF) count += of_projection(step, nodes, MPMI_PROJECT_STRAIN) + strain;
  if (settings->desc.scheme == MPM_USF && finds_contacts_first(step, nodes))
    count += of_projection(step, nodes, MPMI_PROJECT_CONTACT);
  if (phase == MPMI_BEGUN) return count;
  count += holds; /* they are found with the conditions of the nodes */
  if (phase == MPMI_SOLVED) return count;
  if (mpmi_corrects(step)) count += (settings->desc.xpic_order - 1) * of_projection(step, nodes, correction);
  if (settings->desc.scheme == MPM_USL) count += strain;
  if (settings->desc.scheme == MPM_MUSL) count += of_projection(step, nodes, MPMI_PROJECT_MOVED) + strain;
  return count;
}

/* Notes that a projection is there, after so many exchanges. */
static void note_accord(const mpmi_step *step, const mpmi_nodes *nodes, int64_t after, int32_t phase,
                        int32_t finds) {
  mpmi_parts *parts = step->layout->parts;
  const mpmi_accord accord = {after, phase,
                              finds && nodes->contact.anywhere && mpmi_has_free_obstacles(step->settings),
                              mpmi_has_friction_nodes(step->settings)};
  if (accord.gathers || accord.sweeps) parts->accord[parts->accord_count++] = accord;
}

void mpmi_explicit_accords(const mpmi_step *step, const mpmi_nodes *nodes) {
  const int32_t scheme = step->settings->desc.scheme;
  mpmi_parts *parts = step->layout->parts;
  int64_t after = placing(step, nodes);
  parts->accords = parts->accord_count = parts->accords_due = parts->has_gathered = 0;
  if (scheme == MPM_USF) {
    if (finds_contacts_first(step, nodes)) {
      after += of_projection(step, nodes, MPMI_PROJECT_CONTACT);
      note_accord(step, nodes, after, MPMI_BEGUN, 1);
    }
    note_accord(step, nodes, after + of_projection(step, nodes, MPMI_PROJECT_STRAIN), MPMI_BEGUN, 0);
  }
  after = mpmi_explicit_exchanges(step, nodes, MPMI_SOLVED);
  note_accord(step, nodes, after, MPMI_SOLVED, 1);
  if (scheme != MPM_MUSL) return;
  after = mpmi_explicit_exchanges(step, nodes, MPMI_IDLE) - (step->settings->desc.locking_remedy != 0);
  note_accord(step, nodes, after, MPMI_IDLE, 0);
}
