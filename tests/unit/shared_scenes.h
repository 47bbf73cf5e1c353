/* Scenes that are played in one part and in several, which must come to the same bits. Parts are threads
 * (parts.h), where Check's macros may not be used: every part keeps what it has found, which is compared
 * afterwards. */
#ifndef SHARED_SCENES_H
#define SHARED_SCENES_H

#include "parts.h"
#include "world.h"

enum { MOST_PARTS = 5, STEPS = 16 };

/* Cells along an axis in 2-D: blocks are 16 wide, and parts have few. */
enum { WIDE = 24 };

typedef struct outcome {
  mpm_status status;
  char text[400];
  uint64_t hash;
  mpm_step_info info;
  double reaction[6][3], stable_dt;
  int64_t total, own;
  int64_t failed_particle;     /* of a step that had to fail */
  mpm_contact_info contact[4]; /* what a scene has asked for */
  double seen[24];             /* likewise */
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
  outcome found[MOST_PARTS];
};

/* A scene of one set in a box of edge 1, with the default method. */
scene scene_of(int32_t dim, int64_t cells, scene_fn set_up);
/* Velocities that follow from the positions: a spin and a drift, so that particles change their blocks. */
mpm_status set_velocities(world *w, mpm_particles *set, double speed);
/* Fills a square or cube, given as shares of the grid's width. */
mpm_status fill_middle(world *w, mpm_particles *set, double from, double to);
/* Slip at upper faces and hold at lower ones, where there is no period. */
mpm_status set_walls(world *w);
mpm_status run_steps(world *w);
/* What a part does; user: the scene. */
void live(int32_t part, const mpm_transport *transport, void *user);
/* Plays the scene in one part, and then in several, and compares. */
void check_scene(const scene *is, const char *name, int32_t parts);

#endif
