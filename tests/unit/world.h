/* The world of the tests is a context, a grid, laws, sets and a stepper, opened from one description. Here is
 * also how tests spell a call that succeeds or is refused, and what they read, write and compare. */
#ifndef WORLD_H
#define WORLD_H

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mpm/mpm.h>

#include "methods.h"

#define PI 3.14159265358979323846

/* The macros of <math.h> are floats. */
#define NOT_A_NUMBER ((double)NAN)
#define INFINITE     ((double)INFINITY)

typedef struct world world;

/* ---- calls ---- */
mpm_context *context_of_world(const world *w);
const mpm_context *context_itself(const void *context);

/* This is the library's sentence about the last call that failed; `of` is a world, a context or NULL. */
#define last_error_of(of)                                                                                    \
  mpm_last_error(_Generic((of), world *                                                                      \
                          : context_of_world, const world *                                                  \
                          : context_of_world, mpm_context *                                                  \
                          : context_itself, void *                                                           \
                          : context_itself)(of))

/* The call must succeed; else the test prints the call, its status and the library's sentence. */
#define ck_ok(of, call)                                                                                      \
  do {                                                                                                       \
    const mpm_status status_ = (call);                                                                       \
    if (status_) ck_abort_msg("%s: %s: %s", #call, mpm_status_name(status_), last_error_of(of));             \
  } while (0)

/* The call must be refused with this status, and the library's sentence must contain the text. */
#define ck_refused(of, call, wanted, text)                                                                   \
  do {                                                                                                       \
    const mpm_status status_ = (call), wanted_ = (wanted);                                                   \
    if (status_ != wanted_ || !strstr(last_error_of(of), text))                                              \
      ck_abort_msg("%s: %s, wanted %s: \"%s\" in \"%s\"", #call, mpm_status_name(status_),                   \
                   mpm_status_name(wanted_), text, last_error_of(of));                                       \
  } while (0)

/* ---- values ---- */
/* Inner loops use this, because Check's own macros tell the parent process of every pass. */
#define ck_holds(condition)                                                                                  \
  do {                                                                                                       \
    if (!(condition)) ck_abort_msg("not true: %s", #condition);                                              \
  } while (0)

/* The value must differ from the wanted one by no more than the tolerance; NaN fails. */
#define ck_within(name, value, wanted, tolerance)                                                            \
  do {                                                                                                       \
    const double value_ = (value), wanted_ = (wanted), tolerance_ = (tolerance);                             \
    if (!(fabs(value_ - wanted_) <= tolerance_))                                                             \
      ck_abort_msg("%s: %s = %.17g, wanted %.17g within %g", name, #value, value_, wanted_, tolerance_);     \
  } while (0)

/* The value must lie between low and high; NaN fails. */
#define ck_between(name, value, low, high)                                                                   \
  do {                                                                                                       \
    const double value_ = (value), low_ = (low), high_ = (high);                                             \
    if (!(value_ >= low_ && value_ <= high_))                                                                \
      ck_abort_msg("%s: %s = %.17g, wanted in [%g, %g]", name, #value, value_, low_, high_);                 \
  } while (0)

/* Measured numbers are printed for those who set MPM_SHOW in the environment. */
#define show(...)                                                                                            \
  do {                                                                                                       \
    if (getenv("MPM_SHOW")) printf(__VA_ARGS__), fflush(stdout);                                             \
  } while (0)

/* ---- the host's services ---- */
/* The host's memory is counted, and holds no numbers when it is new. Allocation number fail_at, from 1,
 * fails. */
typedef struct host_memory {
  int64_t held, calls, fail_at;
  uint8_t filling; /* of new memory; 0: NaN */
} host_memory;
void memory_lend(mpm_context_desc *desc, host_memory *m);

/* The context has the defaults but for these; it is NULL if the processor lacks the instruction set. */
mpm_context *context_with(int32_t concurrency, int32_t isa, host_memory *m);

int32_t has_isa(int32_t isa);

/* Writes the path of a file in the folder for scratch files, and returns it. */
const char *scratch_path(const char *name, char *path, size_t size);

/* ---- descriptions ---- */
/* These are the library's descriptors with its defaults. */
mpm_context_desc context_desc(void);
mpm_grid_desc grid_desc(int32_t dim, int64_t cells, double spacing); /* alike on all axes, at the origin */
mpm_stepper_desc stepper_desc(void);
mpm_material_desc material_desc(double density, mpm_stress_fn stress, void *user);
mpm_advance_desc advance_desc(double t_end);

typedef struct world_law {
  const char *model; /* NULL: the host's */
  double E, nu, density, yield_stress, hardening;
  const mpm_param *params; /* in place of these */
  int32_t param_count;
  mpm_stress_fn stress; /* the host's law */
  mpm_tangent_fn tangent;
  int32_t state_count;
  const double *state_initial;
  void *user;
} world_law;
mpm_status law_create(mpm_context *context, const world_law *of, mpm_material **out);

/* body.c makes this body of two sets, which moves along x through gravity, every kind of wall and callbacks.
 */
typedef struct body_desc {
  int32_t dim;
  method method;       /* 0: the defaults of the library, FLIP without PIC */
  int32_t large;       /* at least 27 blocks with particles; else a few */
  int32_t periodic;    /* the x axis is; else FIXED (1-D) or NONE below and OPEN above */
  int32_t velocity_bc; /* a callback holds some nodes */
  int32_t led;         /* hooks at all stages, and prescribed particles in set 1 */
  int32_t empty;       /* no particles are added */
  int32_t shuffled;    /* particles are added in another order */
  int32_t concurrency; /* 0: 1 */
  int32_t isa;
  int32_t random_order; /* the host's executor runs the tasks, in random order */
  mpm_stress_fn stress; /* the law of set 1; NULL: "j2" */
} body_desc;

/* These calls fill a set or equip the stepper. Any of them may fail and be repeated. */
typedef mpm_status (*fill_fn)(world *w, int32_t set);
typedef mpm_status (*equip_fn)(world *w);

typedef struct world_desc {
  mpm_context_desc context;
  mpm_grid_desc grid;
  mpm_stepper_desc stepper;
  world_law law, other_law; /* other_law: of set 1, if it has a model or a stress */
  int32_t sets;             /* that are opened with the world */
  int32_t bare;             /* without a stepper */
  int32_t random_order;
  host_memory memory;  /* to begin with; not where context has an alloc of its own */
  double dt;           /* of world_steps() */
  const fill_fn *fill; /* lists that end with NULL */
  const equip_fn *equip;
  body_desc body;
} world_desc;

/* The grid is a cube of `cells` cells of edge h at the origin; the law of its one set is neo-Hookean with E =
 * 1e5, nu = 0.3 and density = 1e3. */
world_desc world_default(int32_t dim, int64_t cells, double h);
world_desc world_with(const method *how, int32_t dim, int64_t cells, double h); /* the same with a method */
void world_use(world_desc *desc, const method *how);

/* ---- the world ---- */
enum { MOST_SETS = 6 };
struct world {
  world_desc desc;
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material[MOST_SETS]; /* of the sets; NULL: as that of the first */
  mpm_particles *set[MOST_SETS];
  mpm_stepper *stepper;
  int32_t dim, sets;
  int32_t opened; /* calls of world_try_open() done */
  uint64_t dice;  /* of the executor */
  host_memory memory;
  mpm_step_info info; /* of the last step */
  double most_energy; /* of the particles, or given to them and taken, that steps have had */
};

/* Opens a world of which only desc and memory are set, or goes on where a failed call left it. */
mpm_status world_try_open(world *w);
/* Opens a world, or ends the test; returns the first set. */
mpm_particles *world_open(world *w, const world_desc *desc);
/* Adds one more set to the stepper; it has the law of the first where `of` is NULL. */
mpm_particles *world_add_set(world *w, const world_law *of);
mpm_status world_try_close(world *w);
void world_close(world *w); /* closes what is open; no memory is left */

mpm_step_info world_info(const world *w);
mpm_step_info world_step(world *w, double dt); /* in which contact may give no energy */
mpm_step_info world_staged_step(world *w, double dt);
void world_steps(world *w, int32_t n); /* of desc.dt */
double world_stable_dt(world *w);
int64_t world_blocks(const world *w); /* with particles, after a step */

/* Sets walls of one kind on all faces but those of periodic axes. */
void world_walls(world *w, int32_t kind, double friction);
/* Fills a box with per_axis particles per cell and axis; returns how many the set then has. */
int64_t world_fill(world *w, mpm_particles *set, const double *lower, const double *upper, int32_t per_axis);
/* Does the same from low to high on every axis, with two particles per cell and axis. */
int64_t world_fill_cube(world *w, mpm_particles *set, double low, double high);

/* ---- fields ---- */
/* Prescribes both components of every seventh particle with an id below 200, in 2-D. */
mpm_status prescribe_sevenths(mpm_particles *set);
/* These return a whole field by ascending id, as [components][count]. The caller frees it. */
double *fetch(const world *w, const mpm_particles *set, const char *field, int32_t components);
void *fetch_as(const world *w, const mpm_particles *set, const char *field, int32_t type, int32_t components);
int64_t *fetch_ids(const world *w, const mpm_particles *set);
void put(const world *w, mpm_particles *set, const char *field, int32_t components, const double *values);
/* Returns one value of one particle. */
double fetch1(const world *w, const mpm_particles *set, const char *field, int32_t components, int32_t c,
              int64_t id);
/* These return a field of the active nodes as [components][*n]. The caller frees it. */
double *fetch_nodes(world *w, const char *field, int64_t *n);
int64_t *fetch_node_indices(world *w, int64_t *n);

double mass_of(const world *w, const mpm_particles *set); /* of all particles */
double sum_of(int64_t n, const double *a);
double weighted_sum(int64_t n, const double *mass, const double *a); /* sum m a */
double largest(int64_t n, const double *a);                          /* of |a|; NaN if any of them is */
double determinant(const double *F);                                 /* of nine components in a row */

/* ---- states ---- */
uint64_t world_hash(const world *w);
/* Returns every field of a set by ascending id, one after the other. The caller frees it. */
char *world_fields(const world *w, int32_t m, size_t *bytes);
/* All bits of all fields of all sets, kept to be compared with later ones. */
typedef struct world_bits {
  char *field[MOST_SETS];
  size_t bytes[MOST_SETS];
  uint64_t hash;
} world_bits;
world_bits world_take(const world *w);
void world_same(const world *w, const world_bits *was, const char *what); /* frees nothing */
void bits_drop(world_bits *bits);

/* A field of the sets that both worlds have must agree, relative to its largest value. */
void world_agree(const char *name, const world *a, const world *b, const char *field, int32_t components,
                 double tolerance);
void same_info(const world *a, const world *b); /* of the steppers, byte by byte */

typedef struct saved_state {
  unsigned char *data;
  int64_t bytes;
} saved_state;
saved_state world_save(const world *w); /* data to be freed */
void world_load(world *w, const saved_state *state);
void world_copy(const world *from, world *to); /* saves the one into the other */
/* Takes a step, and once more from the state before it, with the same bits; returns their hash. */
uint64_t world_step_again(world *w, double dt);

/* ---- what is random and the same in every run ---- */
uint64_t mixed(uint64_t seed);
double noise_at(uint64_t seed); /* uniform in [-1, 1] */

/* A sequence of numbers that are uniform in [low, high). */
typedef struct dice {
  uint64_t state;
} dice;
double throw_between(dice *d, double low, double high);

/* Adds n particles at random places of the box low ... high on every axis, with random velocities up to
 * `speed`, volumes and small random deformations. Places are odd multiples of h / 32, so that no node is so
 * light that it is cut. */
void add_cloud(const world *w, mpm_particles *set, dice *d, int64_t n, double h, double low, double high,
               double speed);
/* Sets random affine matrices with entries up to `rate`. */
void add_affine(const world *w, mpm_particles *set, dice *d, double rate);

#endif
