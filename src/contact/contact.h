/* Who meets whom, and where: what contact finds out from particles and nodal masses before impulses act.
 *
 *   sites.c          blocks of several bodies, and blocks near surfaces: obstacles and friction walls
 *   meetings.c       nodes at which several bodies have mass, or one that a surface binds
 *   clouds.c         the particles around these nodes
 *   gaps.c           normal, gap and area of each touch of two bodies
 *   surface_gaps.c   the same where a surface takes part
 *   half_width       how far a particle reaches in a direction
 */
#ifndef MPMI_CONTACT_FINDING_H
#define MPMI_CONTACT_FINDING_H

#include "contact/half_width.h"
#include "layout/nodes.h"
#include "layout/step.h"

/* What is asked about nodes in one projection. */
typedef struct mpmi_contact_search {
  mpmi_step *step;
  mpmi_nodes *nodes;
  const mpmi_nodal *values; /* of the projection, with ties folded */
  mpmi_contact_nodes *contact;
  int32_t copy;  /* of the particles' fields: 0 at the start of the step, 1 where nodes and they have moved */
  int64_t moved; /* so many cells at most */
} mpmi_contact_search;

/* Lists meetings, parties, touches and the clouds that they need, without particles. */
mpm_status mpmi_meetings_find(mpmi_contact_search *search);
/* Fills the clouds. */
mpm_status mpmi_clouds_fill(mpmi_contact_search *search);
/* Finds normal, gap and area of each touch for the present velocities. */
mpm_status mpmi_gaps_find(mpmi_contact_search *search);

/* Does the same where a surface takes part; this does not depend on velocities. */
mpm_status mpmi_surface_gaps_find(mpmi_contact_search *search);
/* Finds the gaps of those touches once more that are asked for it, by the particles of the clouds and the
 * surfaces where they are at the end of the step: those of bodies, along the normals that they have then, and
 * those with surfaces. */
mpm_status mpmi_gaps_find_after(mpmi_contact_search *search);
mpm_status mpmi_surface_gaps_find_after(mpmi_contact_search *search);
/* Returns 1 when the first party of a touch is a surface. */
static inline int32_t mpmi_is_of_surface(const mpmi_contact_nodes *contact, const mpmi_touch *touch) {
  return contact->party[touch->party[0]].surface >= 0;
}

/* Particles are looked at as far as this from the line through the node along the normal, in cells, axis by
 * axis, and beside rounding: those farther off belong to another part of the surface. */
#define MPMI_CONTACT_REACH (0.75 * (1.0 + 1e-9))

/* Below this share of the mobility that a touch has across its normal, it has none along it: a node held by a
 * wall would be thrown along the wall. */
#define MPMI_NEARLY_HELD 1e-2

/* Where the particles of a cloud are seen from: its node, and the axes on which it is a mirror image. */
typedef struct mpmi_cloud_frame {
  int32_t dim;
  double node[3], period[3],
      scale[3]; /* period: 0 where an axis has none; scale: to cells, < 0 if mirrored */
} mpmi_cloud_frame;

mpmi_cloud_frame mpmi_cloud_frame_of(const mpmi_blocks *b, const mpmi_cloud *cloud);

/* Lets the node go along with its body, as the master of the cloud's party sees it. */
static inline void mpmi_cloud_frame_move(mpmi_cloud_frame *of, const double *way) {
  for (int32_t k = 0; k < of->dim; ++k) of->node[k] += of->scale[k] < 0.0 ? -way[k] : way[k];
}

/* Finds the place of a particle from the node of a cloud, in cells, as the master of the cloud's party sees
 * it: along one axis, or from the positions of its set along all of them. */
static inline double mpmi_cloud_coordinate(const mpmi_cloud_frame *of, int32_t k, double position) {
  double from = position - of->node[k];
  if (of->period[k] > 0.0) from -= of->period[k] * rint(from / of->period[k]);
  return from * of->scale[k];
}
static inline void mpmi_cloud_place(const mpmi_cloud_frame *of, const double *position, int64_t ld,
                                    int64_t slot, double *x) {
  for (int32_t k = 0; k < of->dim; ++k) x[k] = mpmi_cloud_coordinate(of, k, position[k * ld + slot]);
}
/* Returns the mean radius of a party's rings at the node, by which areas are those of one radian; else 1. */
double mpmi_party_radius(const mpmi_layout *layout, const mpmi_contact_nodes *contact,
                         const mpmi_party *party);
/* Finds where a node is: where it stands in the grid, or on a total Lagrangian one where it has come to. */
void mpmi_contact_position(const mpmi_blocks *b, const mpmi_contact_nodes *contact, int64_t slot, double *at);

/* Finds surfaces and sites of the step that is about to begin, and makes records for those that may meet. */
mpm_status mpmi_contact_prepare(const mpmi_layout *layout, const mpmi_settings *settings,
                                mpmi_contact_nodes *contact, mpmi_pair_records *records);
/* Returns 1 when all of a block, so many nodes wider, is farther than `beyond` from a surface. */
int32_t mpmi_block_is_far(const mpmi_blocks *b, int64_t block, int64_t margin,
                          const mpmi_rigid_surface *surface, double beyond);
/* Sets free surfaces to their velocities without contact. */
void mpmi_rigid_surfaces_predict(mpmi_contact_nodes *contact, const mpmi_settings *settings,
                                 double velocity_dt);
/* Returns 1 when the host is asked for distances. */
int32_t mpmi_asks_distances(const mpmi_contact_nodes *contact);
/* Finds distances and normals of the surfaces that are near sites, at their nodes. */
mpm_status mpmi_sites_measure(mpmi_contact_search *search);

#endif
