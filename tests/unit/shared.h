/* Scenes that are played in one part and in several, and have to come to the same bits. Parts are threads
 * (parts.h), where Check's macros may not be used: every part keeps what it has found, which is compared
 * afterwards. */
#ifndef SHARED_H
#define SHARED_H

#include "combinations.h"
#include "parts.h"
#include "tables.h"

enum { MOST_PARTS = 5, STEPS = 16, SAMPLE = 120 };

/* Cells along an axis in 2-D: blocks are 16 wide, and parts have few. */
enum { WIDE = 24 };

typedef struct outcome {
  mpm_status status;
  char text[400];
  uint64_t hash;
  mpm_step_info info;
  double reaction[6][3], stable_dt;
  mpm_heat_info heat; /* of steppers whose sets have heat */
  uint64_t markers;   /* of what markers of surfaces have */
  int64_t total, own;
  int64_t failed_particle;     /* of a step that had to fail */
  mpm_contact_info contact[4]; /* what a scene has asked for */
  double seen[24];             /* likewise */
  mpm_step_info failed;        /* the info of one */
  uint64_t node_sum;           /* of index and mass of the nodes that are owned, in any order */
  int64_t nodes, in_hook;      /* how many these are; how many a hook has been shown */
  mpm_parallel_info parallel;
} outcome;

typedef struct scene scene;
typedef mpm_status (*scene_fn)(world *w, const scene *is);
typedef mpm_status (*run_fn)(world *w, const scene *is, outcome *found);
struct scene {
  world_desc desc;
  scene_fn set_up;
  run_fn run; /* NULL: STEPS steps */
  double speed;
  uint64_t seed; /* of what a scene throws dice for */
  int32_t heat;  /* its sets have heat; 2: which is conducted implicitly */
  int32_t heard; /* the sentence that is asked for is to be heard */
  outcome found[MOST_PARTS];
};

/* A scene on a square of edge 1, or what it is in other dimensions. */
scene scene_of(int32_t dim, int64_t cells, scene_fn set_up);
/* Makes the grid as fine as it takes for a body to span several blocks along each axis. */
void refine(world_desc *desc);
/* Velocities that follow from the positions: a spin and a drift, so that particles change their blocks. */
mpm_status set_velocities(world *w, mpm_particles *set, double speed);
mpm_status fill_middle(world *w, mpm_particles *set, double from, double to);
mpm_status set_walls(world *w);
mpm_status run_steps(world *w);
/* A body that flies through the grid takes the blocks of all parts in turn. */
mpm_status fly_through(world *w, const scene *is, outcome *found);
/* Each part saves its piece, and takes it up again. */
mpm_status save_and_load(world *w);
/* Walls, a body and its velocities. */
mpm_status set_up_body(world *w, const scene *is);

/* One part of a scene, for parts_run(). */
void live(int32_t part, const mpm_transport *transport, void *user);
/* Plays the scene in several parts, each of which must come to its end. */
void check_parts(scene *is, int32_t parts);
/* ---- faults ---- */
/* Number `at` (from 1; 0: none) of what can fail on one of three parts, and how many have been tried. */
enum { FAULTY = 3 };
typedef struct planned {
  int32_t part;
  int64_t at, tried;
} planned;
/* Goes on to the next one of calls[FAULTY]; 0: that was the last. With MPM_FULL in the environment these are
 * all on every part, but of hundreds, which iterations of a solver repeat, the first 300 and 150 of the
 * others; else the parts take turns, and the faults lie closer together the larger `density` is. */
int32_t next_fault(planned *f, int64_t density, const int64_t *calls);
int32_t faults_are_full(void);
/* Says how many there were, where they were all. */
void tell_faults(const planned *f, const char *what);
/* A case for tests of such faults: it has the tag "faults", and "wide" if it is. */
TCase *faults_case(Suite *suite, const char *name, int32_t wide);

/* Wherever the transport fails on one of three parts, every part returns and gives its memory back. More than
 * `least` calls can fail. */
void check_lost_transport(const scene *is, int64_t density, int64_t least);

/* Wherever memory fails on one of three parts, a call fails on all, and goes through when it is made again.
 * No part waits, and nothing is lost. What parts do notes calls that failed, and their memory. */
typedef struct hungry {
  scene is;
  int32_t loads;          /* with a surface */
  planned fault;          /* the allocation that fails */
  int64_t calls[FAULTY];  /* how many allocations each part has made */
  int32_t failed[FAULTY]; /* how many calls of each part */
  host_memory memory[FAULTY];
  /* For live_hungrily(): what the part does, as often as `acts` says; MPM_E_NOMEM leaves all as it was. */
  mpm_status (*act)(world *w, int32_t part, int32_t number);
  int32_t acts;
} hungry;
void check_hunger(const hungry *as, parts_fn lives);
/* Makes a call once more that has failed with this status, and counts that in failed[part]. */
#define AGAIN(of, part, status, fault, call)                                                                 \
  do {                                                                                                       \
    (status) = (call);                                                                                       \
    (of)->failed[part] += (status) == (fault);                                                               \
  } while ((status) == (fault) && (of)->failed[part] == 1)
/* Around what memory may fail in: allocations count from `before`. */
void begin_hunger(const hungry *h, world *w, int32_t part, int64_t before);
void end_hunger(hungry *h, world *w, int32_t part, int64_t before);
/* The life of a part: the scene is set up, and each act that memory runs out in is done once more. */
void live_hungrily(int32_t part, const mpm_transport *transport, void *user);

/* Plays the scene in one part, which has a transport where its linear solver depends on that, and then in
 * several. Returns what it has come to. */
mpm_status check_scene(const scene *is, const char *name, int32_t parts);

/* An implicit step by conjugate gradients, quasi-static or by Newmark's rule. Which options it has: bits of
 * `speed`, which is no velocity there: some particles are led, some nodes are held, a force pulls, bodies
 * move at first. */
enum { LEADS = 1, HOLDS = 2, PULLS = 4, MOVES = 8 };
scene implicit_scene(int32_t dim, const basis_option *basis, int32_t quasi_static);
/* Some particles of a set are prescribed. */
mpm_status lead_some(mpm_particles *set, int32_t dim);
/* An implicit step that no part can make, and then others. */
mpm_status fail_implicitly(world *w, const scene *is, outcome *found);

/* Such a step by GMRES. */
scene gmres_scene(int32_t dim, const basis_option *basis, int32_t quasi_static);

/* The scene must come to its end. */
void check_made(const scene *is, const char *name, int32_t parts);

/* ---- contact ---- */
/* Throws how bodies or an obstacle touch; in implicit steps there is no adhesion. */
mpm_contact_desc throw_rule(dice *d, int32_t dim, int32_t implicit);
/* Throws an obstacle and adds it; in implicit steps none is free. */
mpm_status throw_obstacle(world *w, dice *d, mpm_obstacle **out);
int32_t throw_of(dice *d, int32_t n); /* one of 0 ... n - 1 */
mpm_status take_obstacle(world *w, mpm_obstacle *obstacle,
                         mpm_status status); /* out of the stepper, and frees it */

/* ---- options ---- */
enum { OPTIONS_SAMPLE = 48 };
/* Lists the combinations for the tests of a case. */
void add_option_list(TCase *to);
/* Describes one of OPTIONS_SAMPLE combinations as a scene, and names it; 0: it is not an explicit one that is
 * offered. */
int32_t describe_option(scene *is, int32_t at, int32_t total, char *name, size_t size);

/* A body with heat in the corner of the grid, from which faces conduct; and what is described of it before
 * there are particles. */
scene warm_scene(int32_t cells, int32_t implicit);
mpm_status equip_heat(world *w, const scene *is);
/* Faces begin and end to prescribe temperatures, in implicit steps. */
mpm_status warm_slowly(world *w, const scene *is, outcome *found);

/* A closed surface that loads the material all around a place, and is split as it comes; takes it out. */
mpm_status add_loads(world *w, double middle, double radius, mpm_surface **out);
mpm_status drop_loads(world *w, mpm_surface *s);
/* A callback about markers that returns the status that user points to. */
mpm_status refuse_markers(void *user, const mpm_marker_batch *b, double *add);
/* Makes a step that is to end with this status and these words. */
mpm_status expect_step(world *w, double dt, mpm_status wanted, const char *words);
/* Adds such a surface without loads. */
mpm_status add_around(const world *w, mpm_surface *s, double middle, double radius, double spacing);
/* One of the same shape that prescribes how the material moves. */
mpm_status add_holder(world *w, double middle, double radius, int32_t prescribes, mpm_surface **out);
/* Mixes what all markers of a surface have. */
mpm_status mix_markers(const world *w, const mpm_surface *s, uint64_t *hash);

/* Add the cases of shared_options.c, shared_heat.c and shared_surfaces.c. */
void add_shared_options(Suite *suite);
void add_shared_heat(Suite *suite);
void add_shared_surfaces(Suite *suite);
/* Add the cases of shared_rubbing.c, shared_prescribing.c and shared_adaption.c. */
void add_shared_rubbing(Suite *suite);
void add_shared_prescribing(Suite *suite);
void add_shared_adaption(Suite *suite);
/* Add the cases of shared_implicit.c, shared_steps.c and shared_touching.c. */
void add_shared_implicit(Suite *suite);
void add_shared_steps(Suite *suite);
void add_shared_touching(Suite *suite);
TCase *shared_calls_case(Suite *suite); /* adds the faults */
TCase *shared_balance_case(void);
TCase *shared_timed_case(void);
TCase *shared_threads_case(void);
void add_shared_callbacks(Suite *suite); /* those of shared_callbacks.c */

#endif
