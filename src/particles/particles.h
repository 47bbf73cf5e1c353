/* A particle set keeps fields by name in component arrays, in an order that follows the blocks of the grid.
 *
 * Slots [0, slots) hold the particles and inert holes (id -1, mass 0, F = I). Component c of slot s of a
 * field is data[0][c * ld + s]. Fields that a step changes have a second copy data[1]: a step reads copy 0,
 * writes copy 1 and swaps at commit; a sort writes the same copy. */
#ifndef MPMI_PARTICLES_H
#define MPMI_PARTICLES_H

#include "grid/grid.h"
#include "material/material.h"
#include "simd/chunk.h"
#include "simd/tensor.h"

enum { MPMI_PAD = 16 }; /* every block's slot range is a multiple of this */
_Static_assert((int)MPMI_PAD % (int)MPMI_CHUNK == 0, "blocks hold whole chunks");

/* Built-in fields have the order of the public table; the host's own follow. */
enum {
  MPMI_ID,
  MPMI_POSITION,
  MPMI_VELOCITY,
  MPMI_ACCELERATION,
  MPMI_MASS,
  MPMI_VOLUME,
  MPMI_INITIAL_VOLUME,
  MPMI_SIZE,
  MPMI_F,
  MPMI_L,
  MPMI_STRESS,
  MPMI_STATE,
  MPMI_REFERENCE,
  MPMI_PRESCRIBED,
  MPMI_APPLIED_FORCE,
  MPMI_IMAGE,
  MPMI_DILATION_RATIO,
  MPMI_BUILTIN_FIELDS
};
enum { MPMI_MAX_FIELDS = 64, MPMI_MAX_VIEWS = 64, MPMI_NAME = 48 };

typedef struct mpmi_field {
  char name[MPMI_NAME];
  int32_t type;            /* MPM_F64 ... */
  int32_t components;      /* how many are stored */
  int32_t full_components; /* how many get, set and callbacks show */
  int32_t writable;        /* the host may write it */
  int32_t two_copies;      /* a step writes it: data[1] exists whenever data[0] does */
  int32_t present;         /* takes part in sorting and saving; optional fields start absent */
  int32_t extensive;       /* an amount: parts of a particle share it, and amounts of a pair add */
  void *data[2];           /* [components][ld] */
} mpmi_field;

/* These flags say what has changed since the last step or refresh. */
enum {
  MPMI_DIRTY_ORDER = 1,  /* particles were added: the next sort orders blocks by id */
  MPMI_DIRTY_PLACE = 2,  /* positions changed, or a particle left its loose tile: sort before the next step */
  MPMI_DIRTY_STRESS = 4, /* F or initial_volume was set: volume and stress must be brought up to date */
  MPMI_DIRTY_SUMS = 8,   /* energies, momenta and the stable dt are not those of the current state */
  MPMI_DIRTY_ACCELERATION = 16, /* accelerations are not those of an implicit step, nor given by the host */
  MPMI_DIRTY_IDS = 32 /* particles came by splitting: the next sort, which may wait, orders blocks by id */
};

/* A record stands for a view that is out, of a set or of the nodes of a stepper. */
typedef struct mpmi_view_record mpmi_view_record;
struct mpmi_view_record {
  int32_t live, field, access;
  mpm_context *context; /* stays when the view is given back, for the text of a second time */
  void *data;
  void *lender;      /* the set or the stepper */
  int64_t first;     /* of nodes: the first of the stepper's list of active nodes */
  int64_t items;     /* the same: how many */
  uint64_t print;    /* with MPM_DEBUG: of the memory as it was lent */
  int32_t has_print; /* lent for reading while nothing was lent for writing */
  mpm_status (*release)(mpmi_view_record *record, mpm_view *view);
};

/* A set, an obstacle or a surface asks these questions of the stepper that holds it. */
typedef struct mpmi_owner {
  int32_t (*in_step)(const mpm_stepper *stepper);     /* is a step under way, whole or staged? */
  double (*time)(const mpm_stepper *stepper);         /* the present time */
  int32_t (*has_markers)(const mpm_stepper *stepper); /* has it surfaces with markers? */
} mpmi_owner;

/* Temperatures (particles/thermal.h). The fields are among those of the host, 0: there is none. */
typedef struct mpmi_thermal {
  int32_t temperature, stress_temperature;
  double expansion, reference;
  const double *next; /* [slots] temperatures at the end of the step under way, or NULL */
} mpmi_thermal;

struct mpm_particles {
  uint32_t magic;
  int32_t mapped; /* live views */
  int32_t lent;   /* a view has shown positions since the last step: the host may have written there */
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_stepper *stepper;    /* holds the set, or NULL */
  const mpmi_owner *owner; /* set where there is a stepper */
  int64_t count;           /* live particles */
  int64_t slots;           /* slots in use, a multiple of MPMI_PAD */
  int64_t ld;              /* capacity of every component array */
  int64_t next_id;
  uint32_t dirty;   /* MPMI_DIRTY_... */
  uint32_t suspect; /* bit per built-in field: bad values were written through a view; step refuses */
  /* Largest particle mass seen since the last sort, 0 without any: the scale of nodal masses. */
  double mass_max;
  mpmi_thermal thermal;
  int32_t field_count;
  mpmi_field field[MPMI_MAX_FIELDS];
  mpmi_view_record view[MPMI_MAX_VIEWS];
  /* The lookup from id to slot is built when asked for, and dropped when slots move (lookup.c). */
  struct mpmi_id_slot {
    int64_t id, slot;
  } * index; /* [count] ascending by id, or NULL */
  int64_t index_capacity;
};

static inline double *mpmi_f64(const mpm_particles *set, int32_t field, int32_t copy) {
  return (double *)set->field[field].data[copy];
}
static inline int64_t *mpmi_i64(const mpm_particles *set, int32_t field, int32_t copy) {
  return (int64_t *)set->field[field].data[copy];
}
/* Points at the rows of a field of type MPM_F64, from a slot on. */
static inline void mpmi_point_at(const mpm_particles *set, int32_t field, int32_t copy, int64_t slot,
                                 const double **row) {
  for (int32_t c = 0; c < set->field[field].components; ++c)
    row[c] = mpmi_f64(set, field, copy) + c * set->ld + slot;
}
/* Returns the field that says where in the grid particles are: what weights are made of. */
static inline int32_t mpmi_place_field(const mpm_grid *grid) {
  return mpmi_is_total_lagrangian(grid) ? (int32_t)MPMI_REFERENCE : (int32_t)MPMI_POSITION;
}
/* Returns these places, of which those of a total Lagrangian grid have one copy. */
static inline double *mpmi_places(const mpm_particles *set, int32_t copy) {
  return mpmi_is_total_lagrangian(set->grid) ? mpmi_f64(set, MPMI_REFERENCE, 0)
                                             : mpmi_f64(set, MPMI_POSITION, copy);
}
size_t mpmi_type_size(int32_t type);
/* Returns the index of a field by name, or -1. */
int32_t mpmi_find_field(const mpm_particles *set, const char *name);

/* Tensors store components by dimension: entry c of a compact tensor is entry map[c] of the full one. */
int32_t mpmi_tensor_components(int32_t dim);   /* F: 1, 5, 9 */
const int32_t *mpmi_tensor_map(int32_t dim);   /* F: {0}, {0 1 3 4 8}, {0..8} */
int32_t mpmi_gradient_components(int32_t dim); /* L: 1, 4, 9 */
const int32_t *mpmi_gradient_map(int32_t dim); /* L: {0}, {0 1 3 4}, {0..8} */

/* Returns the volume that a particle had before it was deformed: in the plane, per thickness; of rings, which
 * keep their size, the area that they had in the (r, z) plane. */
static inline double mpmi_initial_extent(const mpm_particles *set, int64_t slot) {
  const double *size = mpmi_f64(set, MPMI_SIZE, 0);
  if (!mpmi_is_axisymmetric(set->grid)) return mpmi_f64(set, MPMI_INITIAL_VOLUME, 0)[slot];
  return size[slot] * size[set->ld + slot];
}

/* These change the storage (fields.c). They do all or nothing: on failure the set is unchanged. */
mpm_status mpmi_particles_reserve(mpm_particles *set, int64_t slots); /* ld >= slots */
/* The same while the second copies hold what a step has found. */
mpm_status mpmi_particles_reserve_in_step(mpm_particles *set, int64_t slots);
/* Slots from `slots` on are slack in all fields (context/slack.h). */
void mpmi_particles_watch(const mpm_particles *set, int64_t slots);
mpm_status mpmi_field_make_present(mpm_particles *set, int32_t field); /* with default values */
void mpmi_field_make_absent(mpm_particles *set, int32_t field);
/* Writes the values that a field reads as when it is absent into slots [begin, end), so that a field that
 * becomes present changes nothing. */
void mpmi_field_write_absent(mpm_particles *set, int32_t field, int64_t begin, int64_t end);
/* Writes inert slots [begin, end) into copy `copy` of every present field; position is that of the hole. */
void mpmi_fill_holes(mpm_particles *set, int32_t copy, int64_t begin, int64_t end, const double *position);
/* Turns the particles in slots [begin, end) into holes: copy 0 of all fields but their positions. The caller
 * counts them. */
void mpmi_make_holes(mpm_particles *set, int64_t begin, int64_t end);
/* Returns the value that an absent optional field has for the particle in `slot`, component c of the full
 * layout. */
double mpmi_absent_value(const mpm_particles *set, int32_t field, int32_t c, int64_t slot);
/* Returns the leading dimension for at least `slots` slots: a multiple of MPMI_PAD whose stride does not
 * alias in the caches. */
int64_t mpmi_leading_dimension(int64_t slots);

/* These find slots by id (lookup.c). */
mpm_status mpmi_index_build(mpm_particles *set);   /* does nothing when it is there */
int32_t mpmi_ids_ascend(const mpm_particles *set); /* 1: ids ascend with the slots */
/* Refuses ids that are not as many as particles, or not unique: MPM_E_STATE. */
mpm_status mpmi_refuse_ids(const mpm_particles *set);
void mpmi_index_drop(mpm_particles *set);
int64_t mpmi_index_find(const mpm_particles *set, int64_t id); /* slot, or -1; index must be built */

/* Checks the values of the fields in `suspect` and clears the mask when they are good (values.c);
 * otherwise MPM_E_ARG names field, value and particle id. */
mpm_status mpmi_particles_check_suspects(mpm_particles *set);
/* Brings volume and stress up to date after F or initial_volume was set (refresh.c). */
mpm_status mpmi_particles_refresh(mpm_particles *set);
/* Makes volumes from a copy of F, by the one function that makes them, so that they can be made again with
 * the same bits. */
void mpmi_particles_make_volumes(mpm_particles *set, int32_t copy);
/* Refuses when the set is mapped or in the middle of a staged step: MPM_E_STATE. */
mpm_status mpmi_particles_changeable(mpm_particles *set);
/* Views of particles or of nodes (view.c): the check of the host's struct, then what it is told. */
mpm_status mpmi_view_check(mpm_context *context, const mpm_view *view);
void mpmi_view_fill(mpm_view *view, int32_t type, int32_t components, int32_t access, int64_t count,
                    int64_t ld, void *data, mpmi_view_record *record);

#endif
