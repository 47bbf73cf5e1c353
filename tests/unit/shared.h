/* Scenes that are played in one part and in several, and have to come to the same bits. Parts are threads
 * (parts.h), where Check's macros may not be used: every part keeps what it has found, which is compared
 * afterwards. */
#ifndef SHARED_H
#define SHARED_H

#include "combinations.h"
#include "parts.h"

enum { MOST_PARTS = 5, STEPS = 16, SAMPLE = 120 };

typedef struct outcome {
  mpm_status status;
  char text[400];
  uint64_t hash;
  mpm_step_info info;
  double reaction[6][3], stable_dt;
  int64_t total, own;
  int64_t failed_particle; /* of a step that had to fail */
  mpm_step_info failed;    /* the info of one */
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
/* Walls, a body and its velocities. */
mpm_status set_up_body(world *w, const scene *is);

/* One part of a scene, for parts_run(). */
void live(int32_t part, const mpm_transport *transport, void *user);
/* Plays the scene in one part, and then in several. Returns what it has come to. */
mpm_status check_scene(const scene *is, const char *name, int32_t parts);

/* Adds the cases of shared_implicit.c. */
void add_shared_implicit(Suite *suite);

#endif
