/* Heat in a step: temperatures of particles go to the nodes, which conduct; particles take the increments.
 *
 *   stage.c     the order of it; what goes in and out
 *   nodes.c     sums on nodes, nodes that are tied, nodes on faces with a prescribed temperature
 *   particles.c what particles give to nodes and take from them
 *   rate.c      the stable step of explicit conduction
 *   implicit.c  the end of the step by conjugate gradients
 *   surfaces.c  what comes through surfaces
 *
 * A face with a prescribed temperature is to heat what a slip wall is to the normal velocity: 0 on its plane
 * and odd beyond it, counted from the prescribed value. So nodes are tied by the same rules. */
#ifndef MPMI_HEAT_H
#define MPMI_HEAT_H

#include "context/exact_sum.h"
#include "layout/nodes.h"
#include "layout/step.h"
#include "layout/visit.h"

/* Four values of each node: sums over the particles, the second of which becomes the temperature. */
enum { MPMI_HEAT_CAPACITY, MPMI_HEAT_TEMPERATURE, MPMI_HEAT_POWER, MPMI_HEAT_MASS };
/* And four of what is conducted: power that leaves the node, the diagonal of the conductance, the increment
 * of the temperature, and the conductance of films, of which explicit conduction makes the share of the
 * difference to the ambient that they take in the step. */
enum { MPMI_HEAT_OUTFLOW, MPMI_HEAT_DIAGONAL, MPMI_HEAT_INCREMENT, MPMI_HEAT_FILM };

/* Where heat came from: energies. */
typedef struct mpmi_heat_sums {
  double gained, walls[6], sources, surfaces, dissipated;
} mpmi_heat_sums;
/* Where they stand among the sums. */
enum {
  MPMI_HEAT_GAINED,
  MPMI_HEAT_WALLS,
  MPMI_HEAT_SOURCES = MPMI_HEAT_WALLS + 6,
  MPMI_HEAT_SURFACES,
  MPMI_HEAT_DISSIPATED,
  MPMI_HEAT_SUMS
};
_Static_assert(sizeof(mpmi_heat_sums) == MPMI_HEAT_SUMS * sizeof(double), "sums have names and places");

/* What one step leaves to the next, and to reports. All members have 8 bytes: saved states hold it. */
typedef struct mpmi_heat_history {
  mpmi_heat_sums last, total;
  double prescribed[6]; /* of the faces in the last step */
  double acted[6];      /* 1: the face had a prescribed temperature then */
  int64_t iterations;
} mpmi_heat_history;

/* Sums over the particles of a block. */
typedef struct mpmi_heat_part {
  double gained, sources;
} mpmi_heat_part;

/* Memory of the heat of a stepper. */
typedef struct mpmi_heat {
  mpmi_nodal nodes, flow;
  mpmi_wall wall[6]; /* what faces are to heat: slip walls where they prescribe a temperature, or none */
  mpmi_constraints ties;
  int64_t version, walls; /* of the layout, and of the kinds of faces, for which they were found */
  double *met;            /* [ties] of nodes on faces: the temperature that the material had there */
  int64_t tie_capacity;
  double *tile; /* [tasks] tiles of one value per node */
  int64_t tile_capacity, tile_size;
  int32_t wants_diagonal; /* of the conductance, which changes with the step only */
  mpmi_heat_part *part;   /* [blocks] */
  int64_t part_capacity;
  /* With implicit conduction: slots of the nodes that are free, vectors of these, temperatures of all
   * nodes. */
  int64_t *row;
  double *vector, *start;
  int64_t rows, row_capacity, vector_capacity, start_capacity;
  mpmi_whole_sum *product; /* [tasks] scratch of products of vectors */
  int64_t product_capacity;
  mpmi_whole_sum sum[MPMI_HEAT_SUMS]; /* of the step under way, as far as they are not by block */
  mpmi_heat_sums sums;                /* what they have come to, once the step is made */
  int64_t iterations;
  int32_t checks_films; /* explicit conduction with films: they bound the step */
} mpmi_heat;

typedef struct mpmi_heat_job {
  mpmi_step *step;
  mpmi_heat *heat;
  const mpmi_heat_history *history;
} mpmi_heat_job;

/* Refuses a step that explicit conduction is not stable with, on all parts alike (collective). */
mpm_status mpmi_heat_check_dt(const mpmi_step *step);
/* Conducts for the step under way: brings temperatures to the nodes and finds what flows between them; */
mpm_status mpmi_heat_begin(mpmi_step *step, mpmi_heat *heat, const mpmi_heat_history *history);
/* and finds new temperatures, which it leaves in the rows of the members. */
mpm_status mpmi_heat_end(mpmi_step *step, mpmi_heat *heat, const mpmi_heat_history *history);
/* Returns how many sums on nodes mpmi_heat_begin() makes; with explicit conduction there are no others. */
int64_t mpmi_heat_exchanges(const mpmi_step *step, const mpmi_heat_history *history);
/* Adds up where heat came from in the step, on all parts (collective). */
mpm_status mpmi_heat_add_up(const mpmi_step *step, mpmi_heat *heat);
/* Returns the temperature that a particle will have by the step, with the heat of dissipation. */
double mpmi_heat_new_temperature(const mpmi_heat_rule *rule, const mpmi_member_rows *rows,
                                 const mpm_particles *set, int64_t slot);
/* Makes new temperatures, and those that the stress belongs to, the state, with the heat of dissipation; adds
 * to the history. Cannot fail. */
void mpmi_heat_commit(const mpmi_step *step, const mpmi_heat *heat, mpmi_heat_history *history);
/* The step under way has no temperatures any more. */
void mpmi_heat_forget(const mpmi_layout *layout);
/* Finds the inverse of the longest step that explicit conduction is stable with, 0 where there is none
 * (collective). */
mpm_status mpmi_heat_rate(const mpmi_settings *settings, const mpmi_layout *layout, double *rate);
/* Adds the heat in a set. */
void mpmi_heat_of(const mpmi_heat_rule *rule, const mpm_particles *set, mpmi_whole_sum *sum);
void mpmi_heat_free(mpmi_heat *heat, const mpmi_settings *settings);

static inline int32_t mpmi_has_heat(const mpmi_step *step, int32_t m) {
  return step->settings->heat.set[m].on;
}
static inline double *mpmi_heat_node(const mpmi_heat *heat, int64_t slot) {
  return mpmi_nodal_at(&heat->nodes, slot);
}
static inline double *mpmi_heat_flow(const mpmi_heat *heat, int64_t slot) {
  return mpmi_nodal_at(&heat->flow, slot);
}

/* ---- particles.c ------------------------------------------------------------------------------------- */
/* Returns how many doubles the tiles of a task take. */
int64_t mpmi_heat_tile_size(const mpmi_settings *settings);
/* Sums capacity, heat, power and mass of the particles on the nodes. */
mpm_status mpmi_heat_project(const mpmi_heat_job *job);
/* Sums capacity times position, in the place of what flows. */
mpm_status mpmi_heat_places(const mpmi_heat_job *job);
/* Finds what the nodes' temperatures conduct, and the diagonal where it is asked for, which is 0 else. */
mpm_status mpmi_heat_conduct(const mpmi_heat_job *job, int32_t diagonal);
/* Adds the increments of the nodes to the particles' temperatures. */
mpm_status mpmi_heat_gather(const mpmi_heat_job *job);

/* ---- nodes.c ----------------------------------------------------------------------------------------- */
/* Finds the ties, where the layout or the faces have changed. */
mpm_status mpmi_heat_tie(const mpmi_heat_job *job);
/* Returns the face that prescribes the temperature of a tie, or -1. */
int32_t mpmi_heat_face(const mpmi_heat_job *job, const mpmi_tie *tie);
/* Returns the sign with which a follower takes increments. */
double mpmi_heat_sign(const mpmi_follower *follower);
/* Returns 1 where some face prescribes temperatures from this step on. */
int32_t mpmi_heat_begins(const mpmi_step *step, const mpmi_heat_history *history);
/* Finds what temperatures material has at such faces. */
mpm_status mpmi_heat_meet(const mpmi_heat_job *job);
/* Turns the sums of the nodes into temperatures. */
mpm_status mpmi_heat_temperatures(const mpmi_heat_job *job);
/* Gives nodes the change of what faces prescribe: those on the plane once, mirrors twice. */
void mpmi_heat_prescribe(const mpmi_heat_job *job);
/* Finds the increments of the other nodes from the powers that there are. */
mpm_status mpmi_heat_advance(const mpmi_heat_job *job);
/* Takes increments into the temperatures, and counts what came through the faces. */
mpm_status mpmi_heat_settle(const mpmi_heat_job *job);

/* ---- implicit.c -------------------------------------------------------------------------------------- */
/* Finds the increments so that they are those of what flows at the end, where the flow then is. Fails on all
 * parts, after as many exchanges, or on none. */
mpm_status mpmi_heat_solve(const mpmi_heat_job *job);

/* ---- surfaces.c -------------------------------------------------------------------------------------- */
/* Finds the nodes around the markers of surfaces that heat, and adds the power that they give whatever the
 * temperature of the nodes is. */
mpm_status mpmi_heat_surfaces(const mpmi_heat_job *job);
/* Returns 1 when surfaces heat; when some of them have films. */
int32_t mpmi_heat_has_surfaces(const mpmi_settings *settings);
int32_t mpmi_heat_has_films(const mpmi_settings *settings);
/* Of several parts: refuses markers that heat where no part has material (collective). */
mpm_status mpmi_heat_surfaces_check(const mpmi_heat_job *job);
/* Adds what films take at the temperatures on the nodes to the outflow, and to the diagonal (collective). */
mpm_status mpmi_heat_films(const mpmi_heat_job *job);
/* Returns the power that surfaces give at these temperatures, which films have seen. */
double mpmi_heat_surface_power(const mpmi_heat_job *job);

#endif
