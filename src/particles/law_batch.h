/* One batch of particles on its way through a constitutive law has these buffers, and the public batch
 * shows them to the law. */
#ifndef MPMI_LAW_BATCH_H
#define MPMI_LAW_BATCH_H

#include "particles/particles.h"

/* A batch is short enough for the first-level cache where the law is ours, and long where calling the host
 * costs. */
enum { MPMI_BATCH_OWN = 64, MPMI_BATCH_HOST = 256 };
_Static_assert((int)MPMI_BATCH_OWN % (int)MPMI_CHUNK == 0 && (int)MPMI_BATCH_HOST % (int)MPMI_CHUNK == 0,
               "batches hold whole chunks");

/* A lookup says where a batch lies in its set; the `lookup` of callbacks points to it. */
typedef struct mpmi_lookup {
  const mpm_particles *set;
  int64_t begin;
} mpmi_lookup;

/* What the host's law gave and must not give, or why a built-in one refuses; cause MPM_OK: nothing. */
typedef struct mpmi_law_fault {
  mpm_status cause;
  int64_t particle; /* id */
  const char *what;
} mpmi_law_fault;

typedef struct mpmi_law_batch {
  int64_t ld;
  double *F, *F_inc, *L, *stress, *state, *stress_new, *state_new, *wave_speed, *viscosity, *energy, *growth,
      *position;
  /* growth: by how much temperature has let the volume grow, of sets that expand */
  mpm_material_batch batch;
  mpmi_lookup lookup;
  mpmi_law_fault fault; /* of the last run */
  int32_t stored;       /* 1: F and the new stress are those of the set, with its rows */
  int32_t squares;      /* 1: leaves the squares of wave speeds that a built-in law gives */
} mpmi_law_batch;

int64_t mpmi_law_batch_length(const mpm_material *material);
/* Returns the bytes of the buffers for a material, a multiple of 64. */
size_t mpmi_law_batch_bytes(const mpm_material *material);
/* Lays the buffers out in 64-byte aligned memory and presets them to a state that does not change: F_inc =
 * I, L = 0. */
void mpmi_law_batch_bind(mpmi_law_batch *b, const mpm_material *material, void *memory);
/* Fills the batch with n slots from `begin`: old stress and state, position, ids, and t and dt of the
 * step. */
void mpmi_law_batch_load(mpmi_law_batch *b, const mpm_particles *set, int64_t begin, int64_t n, double t,
                         double dt);
/* Loads F from storage, to evaluate the state as it is. */
void mpmi_law_batch_load_F(mpmi_law_batch *b, const mpm_particles *set, int64_t begin, int64_t n);
/* Lets lane p of a batch see the deformation without what expands to temperature T. */
void mpmi_expand_lane(mpmi_law_batch *b, const mpm_particles *set, int64_t p, double T);
/* Does that to the slots from `begin` on, as they are. */
void mpmi_expand_state(mpmi_law_batch *b, const mpm_particles *set, int64_t begin, int64_t n);
/* Does it in a step, to the new temperatures, and takes what expands in it out of L and, where they are made,
 * the increments of F. */
void mpmi_expand_step(mpmi_law_batch *b, const mpm_particles *set, int64_t begin, int64_t n, double dt,
                      int32_t has_increments);

/* Runs the law, and looks at what one of the host's gave and whom a built-in one refuses; a fault's cause is
 * returned as the status.
 * Afterwards the new stress and state may be stored in copy `copy` of a set's fields. */
mpm_status mpmi_law_batch_run(mpmi_law_batch *b, const mpm_material *material, int32_t dim);
void mpmi_law_batch_store(const mpmi_law_batch *b, mpm_particles *set, int32_t copy, int64_t begin,
                          int64_t n);
/* Takes a copy of the stress that the set has for the new one. */
void mpmi_law_batch_recall(mpmi_law_batch *b, const mpm_particles *set, int32_t copy, int64_t begin,
                           int64_t n);

/* ---- plane_stress.c ----------------------------------------------------------------------------------- */
/* Runs the law as the grid of a set wants it: in its dimensions, with a hoop, or so that the stress across
 * the plane vanishes. Then F has another entry 33 than before; MPM_CUT_DT: there is none. */
mpm_status mpmi_law_batch_run_in(mpmi_law_batch *b, const mpm_particles *set);
/* Takes out of a tangent [81][ld] what F33 does beside the plane: c_ijkl -= c_ij33 c_33kl / c_3333. */
void mpmi_condense_tangent(double *tangent, int64_t ld, int64_t n);

#endif
