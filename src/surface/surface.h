/* Surfaces: markers that move with the material and load it, or prescribe how it moves.
 *
 *   handle.c   making, loads, options
 *   markers.c  markers come, go and are split
 *   shapes.c   markers along lines and on triangles
 *   fields.c   their fields, by name
 *
 * A marker is a parallelogram with its centre at the marker: the vectors of its edges are what the material
 * stretches, and the area vector is their product. That is Nanson's relation without a determinant. */
#ifndef MPMI_SURFACE_MARKERS_H
#define MPMI_SURFACE_MARKERS_H

#include "grid/blocks.h"
#include "particles/particles.h"

#include <string.h>

/* All members have 8 bytes: saved states hold markers as they are. */
typedef struct mpmi_marker {
  int64_t id;
  double position[3];
  /* In 2-D edge[0] is the only one, with the material on its left; in 1-D edge[0][0] is the area. Of rings
   * edge[1] is that of one radian: (0, 0, r). */
  double edge[2][3];
  double reference_area, displacement[3], velocity[3], force[3];
  double reference[3], reference_edge[2][3];      /* position and edges when it was added or set */
  double pressure, traction[3], dead_traction[3]; /* its own, beside those of the surface */
  /* Of a surface that prescribes: its own velocity, beside that of the surface; the force of what is
   * prescribed, in the last step; by how much the spring of implicit steps is stretched. */
  double prescribed_velocity[3], reaction[3], gap[3];
} mpmi_marker;

/* Markers of a surface at most: no sum or product of counts overflows. */
enum { MPMI_MOST_MARKERS = 1 << 28 };

/* Markers by ascending id. */
typedef struct mpmi_markers {
  int64_t count, capacity, next_id;
  mpmi_marker *at;
} mpmi_markers;

/* The nodes of the markers in a step, `nodes` of them for each: slots, or -1 for those that take nothing;
 * weights, with which forces go to nodes and velocities come back; and gradients, [dim] for each. Where the
 * surface prescribes also the shape functions as they are. */
typedef struct mpmi_marker_nodes {
  int64_t slot_capacity, weight_capacity;
  int32_t nodes;
  int64_t *slot;
  double *weight, *gradient, *plain;
} mpmi_marker_nodes;

/* What a marker prescribes in a step: its velocity, the normal along which alone it counts where the
 * material may slide; and of its spring in implicit steps the stiffness, and how the normal changes along
 * the surface. */
typedef struct mpmi_marker_aim {
  double velocity[3], normal[3], stiffness, curvature[3][3];
} mpmi_marker_aim;

/* Words in which a part tells the others how a marker moves: velocity and its gradient. Then, for each of the
 * nodes around markers, those of its velocity, and of a surface that prescribes those of the impulse that it
 * had there. */
enum { MPMI_MARKER_MOTION = 12, MPMI_MARKER_VECTOR = 3 };

/* The impulses of what a surface prescribes, on the material: in the last step, and since it was added. */
typedef struct mpmi_surface_impulses {
  double last[3], total[3];
} mpmi_surface_impulses;
/* Heat through a surface, per area of its markers: flux + film (ambient - T). */
typedef struct mpmi_surface_heat {
  double flux, film, ambient;
} mpmi_surface_heat;

struct mpm_surface {
  uint32_t magic;
  int32_t number; /* in its stepper */
  mpm_context *context;
  mpm_grid *grid;
  struct mpm_stepper *stepper; /* that has it, or NULL */
  const mpmi_owner *owner;     /* what the stepper says of itself */
  mpm_surface_desc desc;
  mpm_traction_fn traction;
  void *traction_user;
  mpm_marker_velocity_fn velocity;
  void *velocity_user;
  mpmi_surface_heat heat;
  mpmi_markers now, next; /* next: at the end of the step under way */
  mpmi_marker_nodes around;
  mpmi_surface_impulses impulses;
  double impulse[3];    /* in the step under way */
  mpmi_marker_aim *aim; /* [markers], in the step under way; there only where the surface prescribes */
  int32_t *site;        /* for each of the nodes around, or -1: see boundary/surface_holds.c */
  int64_t aim_capacity, site_capacity;
  double *batch; /* what the callback sees and gives */
  double *asked; /* the tractions in it in the step under way, or NULL */
  int64_t *batch_id;
  int64_t batch_capacity, id_capacity;
  int64_t *told; /* of several parts: what they tell each other of markers */
  int64_t told_capacity;
};

/* Surfaces of a stepper, in the order of adding. */
typedef struct mpmi_surfaces {
  int64_t count, capacity;
  mpm_surface **surface;
} mpmi_surfaces;

static inline int32_t mpmi_surface_prescribes(const mpm_surface *surface) {
  return surface->desc.prescribes != MPM_PRESCRIBES_NOTHING;
}
/* Returns 1 when some surface with markers prescribes how the material moves. */
static inline int32_t mpmi_surfaces_prescribe(const mpmi_surfaces *list) {
  for (int64_t i = 0; i < list->count; ++i)
    if (mpmi_surface_prescribes(list->surface[i]) && list->surface[i]->now.count) return 1;
  return 0;
}

/* Returns where in the grid a marker is: what its weights are made of. */
static inline const double *mpmi_marker_place_of(const mpmi_marker *marker, const mpm_grid *grid) {
  return mpmi_is_total_lagrangian(grid) ? marker->reference : marker->position;
}

/* What parts tell each other of a surface: how many words these are; velocity and impulse at one of the nodes
 * around its markers. */
static inline int64_t mpmi_surface_told_words(const mpm_surface *s) {
  const int64_t vectors = (1 + mpmi_surface_prescribes(s)) * s->around.nodes;
  return s->next.count * (MPMI_MARKER_MOTION + MPMI_MARKER_VECTOR * vectors);
}
static inline int64_t *mpmi_surface_told_velocity(const mpm_surface *s, int64_t node) {
  return s->told + MPMI_MARKER_MOTION * s->next.count + MPMI_MARKER_VECTOR * node;
}
static inline int64_t *mpmi_surface_told_impulse(const mpm_surface *s, int64_t node) {
  return mpmi_surface_told_velocity(s, s->next.count * s->around.nodes + node);
}
/* Adds an impulse at one of the nodes around a marker to what the surface and the marker report. */
static inline void mpmi_surface_impulse_add(mpm_surface *s, int64_t marker, const double *impulse,
                                            double velocity_dt) {
  for (int32_t c = 0; c < s->grid->dim; ++c) {
    s->impulse[c] += impulse[c];
    s->next.at[marker].reaction[c] += impulse[c] / velocity_dt;
  }
}

/* ---- markers.c --------------------------------------------------------------------------------------- */
/* Returns MPM_E_STATE while a staged step is under way. */
mpm_status mpmi_surface_changeable(const mpm_surface *surface);
/* Finds the area vector of a marker, and its length. */
void mpmi_marker_area(const mpmi_marker *marker, const mpm_grid *grid, double *area);
double mpmi_marker_size(const mpmi_marker *marker, const mpm_grid *grid);
/* Gives a marker the edges of a square (2-D: an edge) with this area vector, which becomes the reference. */
void mpmi_marker_set_area(mpmi_marker *marker, const mpm_grid *grid, const double *area);
/* Refuses the area of a ring that has no radius. */
mpm_status mpmi_marker_check_area(const mpm_surface *surface, int64_t which, double radius,
                                  const double *area);
/* Gives a marker of rings the radius at which it stands. */
void mpmi_marker_set_radius(mpmi_marker *marker, const mpm_grid *grid);
/* Makes position and edges as they are the reference. */
void mpmi_marker_set_reference(mpmi_marker *marker);
/* Refuses a position outside the grid, and wraps one that is inside. `which` counts markers in the text. */
mpm_status mpmi_marker_place(const mpm_surface *surface, int64_t which, double *position);
/* Refuses a count of the host that no surface could have. */
mpm_status mpmi_surface_check_count(const mpm_surface *surface, const char *what, int64_t n);
/* Makes room for so many more markers. Those that are there stay, and on failure nothing has changed. */
mpm_status mpmi_markers_reserve(mpm_context *c, mpmi_markers *markers, int64_t more);
/* Adds a marker for which there is room: it gets the next id. */
mpmi_marker *mpmi_markers_append(mpmi_markers *markers, const mpmi_marker *marker);
/* Splits markers with edges longer than the spacing, once each or until none is longer. On failure some are
 * split and others are not: so work on a copy. */
mpm_status mpmi_markers_split(mpm_context *c, const mpm_grid *grid, mpmi_markers *markers, double spacing,
                              int32_t once);
/* Makes `to` a copy, in memory that it has or gets. */
mpm_status mpmi_markers_copy(mpm_context *c, const mpmi_markers *from, mpmi_markers *to);
void mpmi_markers_free(mpm_context *c, mpmi_markers *markers);
/* Returns the place of the marker with an id, or -1. */
int64_t mpmi_markers_find(const mpmi_markers *markers, int64_t id);

#endif
