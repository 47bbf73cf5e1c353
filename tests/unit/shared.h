/* Parts of test_shared.c: a scene is played in one part and in several, and what they find is compared. */
#ifndef SHARED_H
#define SHARED_H

#include "parts.h"
#include "world.h"

enum { MOST_PARTS = 5, STEPS = 16 };

typedef struct outcome {
  mpm_status status;
  char text[400];
  uint64_t hash;
  mpm_step_info info;
  double reaction[6][3], stable_dt;
  int64_t total, own;
  int64_t failed_particle; /* of a step that had to fail */
  uint64_t node_sum;       /* of index and mass of the nodes that are owned, in any order */
  int64_t nodes, in_hook;  /* how many these are; how many a hook has been shown */
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
  outcome found[MOST_PARTS];
};

/* Plays the scene in user, of which this is a part; its outcome goes to found[part]. */
void live(int32_t part, const mpm_transport *transport, void *user);
/* Plays it in one part, and then in several, which must find the same. */
void check_scene(const scene *is, const char *name, int32_t parts);

/* Cells along an axis in 2-D: blocks are 16 wide, and parts have few. */
enum { wide = 24 };
scene scene_of(int32_t dim, int64_t cells, scene_fn set_up);
/* Walls and a body in the middle, which spins and drifts. */
mpm_status set_up_combination(world *w, const scene *is);
mpm_status fill_middle(world *w, mpm_particles *set, double from, double to);
mpm_status set_velocities(world *w, mpm_particles *set, double speed);
/* What is played: STEPS steps; and a flight through the grid. */
mpm_status run_steps(world *w);
mpm_status fly(world *w, const scene *is, outcome *found);

TCase *shared_calls_case(void);
TCase *shared_balance_case(void);

#endif
