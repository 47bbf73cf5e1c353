/* What tests of whole runs share: a run of two sets with every kind of wall, gravity and host callbacks,
 * opened call by call so that any of them may fail and be repeated; a host that counts memory, lets
 * allocations fail, and runs tasks in any order; what has to be equal of two runs. */
#ifndef RUN_SUPPORT_H
#define RUN_SUPPORT_H

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <stdio.h>
#include <string.h>

#include <mpm/mpm.h>

/* The macros of <math.h> are floats. */
#define RUN_NAN      ((double)NAN)
#define RUN_INFINITY ((double)INFINITY)

/* The call succeeds, or the test ends with the library's sentence. */
#define run_ok(r_, call)                                                                                     \
  do {                                                                                                       \
    const mpm_status status_ = (call);                                                                       \
    if (status_) ck_abort_msg(#call ": %s: %s", mpm_status_name(status_), mpm_last_error((r_)->context));    \
  } while (0)

/* The call is refused with this status, and the sentence names what is at fault. */
#define run_refused(r_, call, wanted_, text_)                                                                \
  do {                                                                                                       \
    const mpm_status status_ = (call);                                                                       \
    if (status_ != (wanted_) || !strstr(mpm_last_error((r_)->context), text_))                               \
      ck_abort_msg(#call ": %s, wanted " #wanted_ ": \"%s\" in \"%s\"", mpm_status_name(status_), text_,     \
                   mpm_last_error((r_)->context));                                                           \
  } while (0)

/* Memory from the host: filled with NaN, counted; the allocation with number fail_at fails, from 1. */
typedef struct run_memory {
  int64_t held, calls, fail_at;
} run_memory;

typedef struct run_options {
  int32_t dim, basis, boundary_basis, scheme, transfer;
  int32_t xpic_order;           /* 0: the default */
  int32_t position_order;       /* 0: the default */
  int32_t staggered, remedy;    /* remedy: not in 1-D */
  double flip, pic_damping;     /* flip 0: 1 */
  int32_t large;                /* at least 27 blocks with particles; else a few */
  int32_t periodic;             /* the x axis is; else FIXED (1-D) or NONE below and OPEN above */
  int32_t velocity_bc;          /* a callback holds some nodes */
  int32_t led;                  /* hooks at all stages, and prescribed particles in set 1 */
  int32_t empty;                /* no particles are added */
  int32_t shuffled;             /* particles are added in another order */
  int32_t concurrency;          /* 0: 1 */
  int32_t isa;                  /* MPM_ISA_... */
  int32_t own_order;            /* the host's executor runs the tasks, in random order */
  mpm_parallel_for_fn executor; /* or this one does */
  void *executor_user;
  mpm_stress_fn stress; /* the law of set 1; NULL: "j2" */
  run_memory *memory;   /* NULL: the library's */
} run_options;

typedef struct run {
  run_options options;
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material[2];
  mpm_particles *set[2];
  mpm_stepper *stepper;
  int32_t stage;      /* calls of run_open() done */
  uint64_t dice;      /* of the executor */
  void *user;         /* the test's */
  mpm_step_info info; /* of the last run_steps() */
} run;

/* What run_open() needs beside the options: h = 0.1 and nearly so on the other axes. */
#define RUN_DT 1e-3

/* Combinations of basis, scheme and transfer for suites that go through them; all are in options.h. */
typedef struct run_method {
  int32_t basis, scheme, transfer;
  double flip;
  int32_t boundary_basis, xpic_order, position_order, staggered, remedy;
} run_method;
/* The first of them are plain; the others have every further option at least once. */
enum { RUN_METHODS = 10, RUN_ALL = RUN_METHODS + 11 };
extern const run_method run_methods[RUN_ALL];
void run_use(run_options *options, const run_method *method);

/* Opens a run, or goes on where a failed call left it. */
mpm_status run_try_open(run *r);
void run_open(run *r, const run_options *options);
/* Closes as much as was opened. */
void run_close(run *r);
void run_steps(run *r, int32_t n);
void run_step_of(run *r, double dt);

/* The same in every run: uniform in [-1, 1]. */
double run_noise(uint64_t seed);

uint64_t run_hash(const run *r);
/* Every field of a set by ascending id, one after the other; to be freed. */
char *run_fields(const run *r, int32_t m, size_t *bytes);
/* All fields of both sets are the same bits; `what` is named if not. */
typedef struct run_state {
  char *field[2];
  size_t bytes[2];
  uint64_t hash;
} run_state;
run_state run_take(const run *r);
void run_same(const run *r, const run_state *was, const char *what); /* frees nothing */
void run_drop(run_state *state);

/* One field by ascending id, [components][count]; to be freed. */
double *run_get(const run *r, int32_t m, const char *field, int32_t components);
void run_put(const run *r, int32_t m, const char *field, int32_t components, const double *values);
/* One value of one particle. */
double run_get1(const run *r, int32_t m, const char *field, int32_t components, int32_t c, int64_t id);
/* A field of the active nodes, [components][*n]; to be freed. */
double *run_nodes(run *r, const char *field, int32_t components, int64_t *n);

/* Neo-Hookean law as a callback, with the stretch it sees last as its state where state_count is 1. */
mpm_status run_neo_hookean(void *user, const mpm_material_batch *batch);
/* Of E, nu and density of both laws. */
extern const double run_E, run_nu, run_density;

#endif
