/* Batches of particles on their way through a pass from nodes to particles. A pass gathers from the nodes of
 * a velocity field, block by block, and does with each batch what it is for. It reads copy 0 of the
 * particles' fields and writes copy 1; only volume has one copy (strain.c). */
#ifndef MPMI_BATCH_H
#define MPMI_BATCH_H

#include "layout/nodes.h"
#include "layout/reached.h"
#include "layout/step.h"
#include "particles/law_batch.h"

typedef struct mpmi_batch mpmi_batch;

/* What a pass is for. */
typedef struct mpmi_pass {
  int32_t moves;   /* velocity and position of the particles: gathers what the transfer takes for that */
  int32_t deforms; /* deformation gradient and stress */
  int32_t places;  /* position, where the pass that moves has left it to one that deforms */
  int32_t plain;   /* gathers mean velocities whatever the transfer is */
  void (*bind)(mpmi_batch *b);  /* a set comes; or NULL */
  void (*enter)(mpmi_batch *b); /* a block comes; or NULL */
  void (*aim)(mpmi_batch *b);   /* a batch is about to be gathered; or NULL */
  void (*take)(mpmi_batch *b);  /* a batch has been gathered */
} mpmi_pass;

struct mpmi_batch {
  mpmi_step *step;
  mpmi_nodes *nodes;
  const mpmi_nodal *from; /* the nodes that are gathered from */
  const mpmi_pass *pass;
  void *user; /* of the pass */
  mpmi_scratch *scratch;
  mpmi_task_report *report;
  int32_t task, form, need; /* of the gather */
  /* The member whose particles are at hand, or -1; its set; and what the kernels are given: */
  int32_t m;
  mpm_particles *set;
  mpmi_law_batch law;
  mpmi_gather gather;
  mpmi_move move;
  mpmi_deform deform;
  mpmi_sums_job sums_job;
  int32_t rings;          /* the gradient has a hoop part, which is not gathered */
  double *v_bar, *dv, *C; /* rows of what is gathered, beside the gradient, which goes to the law */
  int32_t keeps;          /* the set keeps the gradient: MPMI_KEEPS_... */
  /* The block at hand: */
  int64_t block;
  mpmi_sums *sums;
  mpmi_spans next;     /* of the block that comes next */
  double largest_rate; /* of the blocks so far */
  /* The batch at hand: */
  int64_t begin, n;
  mpmi_taken taken; /* what moving and deforming returned where the gather has done that */
  uint32_t flags;   /* what the kernels returned: it tells of particles that want a closer look */
  int32_t law_ran;  /* the law has answered for this batch */
  int64_t batches;  /* seen so far, to sample their times */
};

/* Returns component c of a field, at slot 0. */
static inline double *mpmi_component_row(const mpm_particles *set, int32_t field, int32_t copy, int32_t c) {
  return mpmi_f64(set, field, copy) + c * set->ld;
}

/* Runs a pass over all particles; returns MPM_OK, or the failure of the first particle. */
mpm_status mpmi_pass_run(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from, const mpmi_pass *pass,
                         void *user);
/* Do the same block by block, for those who add to nodes meanwhile: a task begins once and then takes
 * blocks. */
void mpmi_pass_begin(mpmi_batch *b, mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from,
                     const mpmi_pass *pass, void *user, int32_t task);
void mpmi_pass_block(mpmi_batch *b, int64_t block, int64_t next);
/* Returns 1 when there is a law of the host's: then its callback may have to stay on one thread. */
int32_t mpmi_has_host_law(const mpmi_layout *layout);

/* Takes note of the failure of the particle in a slot. */
void mpmi_batch_fail(mpmi_batch *b, mpm_status cause, int64_t slot, const char *what);

/* Makes the law's gradient, which a total Lagrangian grid gives over reference positions, that over the
 * present ones. */
void mpmi_gradient_present(mpmi_batch *b);

/* ---- motion.c ---------------------------------------------------------------------------------------- */
/* These prepare motion for a set and for a block. */
void mpmi_motion_bind(mpmi_batch *b);
void mpmi_motion_enter(mpmi_batch *b);
/* Points at the particles of the batch, before it is gathered. */
void mpmi_motion_aim(mpmi_batch *b);
/* Completes new velocities and positions of the batch; prescribed particles move as they must. */
void mpmi_motion_take(mpmi_batch *b);

/* ---- strain.c ---------------------------------------------------------------------------------------- */
/* These prepare strain and sums for a set, and strain for a block. */
void mpmi_strain_bind(mpmi_batch *b);
void mpmi_strain_enter(mpmi_batch *b);
/* Points at the particles of the batch, loads what the law sees of them, tells where the gradient goes. */
void mpmi_strain_aim(mpmi_batch *b);

/* The gradient goes to the law's rows, to those of the set, or nowhere. What an affine transfer carries comes
 * with the velocities, in the pass that moves, and is kept; otherwise that of the strain is kept where the
 * host wants it: copied, or stored by the gather where nobody else reads it. */
enum { MPMI_KEEPS_NOTHING, MPMI_KEEPS_COPY, MPMI_KEEPS_DIRECTLY };
void mpmi_gradient_aim(mpmi_batch *b);
void mpmi_gradient_keep(mpmi_batch *b);
/* Completes deformation gradient and volume; returns 0 where they are no state that a law can be asked
 * about. */
int32_t mpmi_strain_deform(mpmi_batch *b);
/* Runs the law there; b->law_ran tells whether it has answered. */
void mpmi_strain_law(mpmi_batch *b);
/* Returns 1 where the squares of wave speeds will do, which a law of the library finds before its roots. */
int32_t mpmi_takes_squares(const mpmi_settings *settings, const mpm_material *material);
/* Makes wave speeds and viscosities of a batch of a total Lagrangian grid, which the law gave for slots of a
 * set from `begin` on, those over reference positions; copy: of F. */
void mpmi_take_reference_speeds(const mpmi_settings *settings, const mpm_particles *set, int32_t copy,
                                int64_t begin, int64_t n, mpmi_law_batch *law);

/* Makes volumes, which have one copy, from a copy of F: after a step that failed, and where the host looks on
 * in between. */
void mpmi_make_volumes(const mpmi_layout *layout, int32_t copy);

/* ---- dissipation.c ----------------------------------------------------------------------------------- */
/* Finds what the particles of a batch dissipate, whose law has just run. */
void mpmi_dissipation_find(mpmi_batch *b);

/* ---- batch_sums.c ------------------------------------------------------------------------------------ */
/* Prepares the sums over the particles of a set. */
void mpmi_sums_bind(mpmi_batch *b);

/* Where the law runs before the particles move, the sums over the motion want its wave speed: these leave it
 * in the member's row meanwhile, and fetch it from there. */
void mpmi_wave_speed_leave(const mpmi_batch *b);
void mpmi_wave_speed_fetch(mpmi_batch *b);

/* Adds energies, momenta and rates of the batch to those of its block; what: MPMI_SUMS_LAW,
 * MPMI_SUMS_MOTION. */
void mpmi_batch_sums(mpmi_batch *b, int32_t what);

/* Gives the job the second moments of the basis at n particles from slot `begin`, for the affine part of the
 * angular momentum; copy: of their positions. buffer: [3][ld]. */
void mpmi_sums_moments(const mpmi_settings *settings, const mpm_particles *set, int32_t copy, int64_t begin,
                       int64_t n, int64_t ld, double *buffer, mpmi_sums_job *job);

#endif
