/* A scene: a small body under a method and options of the library, how it is stepped, and the hash of what
 * came of it. Everything goes through the public interface. */
#ifndef HASHES_SCENE_H
#define HASHES_SCENE_H

#include <mpm/mpm.h>

/* Laws of a set. */
enum {
  LAW_NONE,
  LAW_NEO_HOOKEAN,
  LAW_LINEAR_ELASTIC,
  LAW_J2,
  LAW_DECOUPLED,
  LAW_FLUID,
  LAW_VISCOUS_FLUID,
  LAW_RIGID,
  LAW_HOST,         /* with a state variable and its energy; the library differences its tangent */
  LAW_HOST_TANGENT, /* with a tangent and without an energy */
  LAW_SOIL,
  LAW_MOHR_COULOMB,
  LAW_MUD,
  LAW_SNOW,
  LAW_GRAINS,
  LAW_CLAY,
  LAWS
};

/* What the host adds, as bits. */
enum {
  WITH_FORCE = 1,
  WITH_ACCELERATION = 2,
  WITH_APPLIED_FORCE = 4,
  WITH_VELOCITY = 8,
  WITH_PRESCRIBED = 16,   /* some particles of the last set */
  WITH_MOTION = 32,       /* of the prescribed ones */
  WITH_HOOK = 64,         /* AFTER_P2G; the next two bits are the other stages */
  WITH_KEPT = 512,        /* acceleration and velocity gradient are kept */
  WITH_SPARE_SIZE = 1024, /* GIMP: sizes as the library finds them */
  WITH_BODIES = 2048,     /* the sets stand side by side and rub against each other */
  WITH_OBSTACLES = 4096,  /* one of each motion: fixed, driven, free */
  WITH_SURFACE = 8192,    /* markers at the upper end of the body, under loads of all kinds */
  WITH_ADAPTION = 16384,  /* the first set is split and merged every other step */
  WITH_HOLDING = 32768,   /* the surface prescribes how the material moves, */
  WITH_SLIDING = 65536,   /* or the normal component alone, along normals that differ */
  WITH_HEAT = 131072,     /* all sets have heat, faces and the surface give some */
  WITH_IMPLICIT_HEAT = 262144
};

/* How it is stepped. */
enum {
  STORY_PLAIN,
  STORY_STAGED_VELOCITY, /* in parts, with nodal velocities written */
  STORY_STAGED_FORCE,
  STORY_SAVED,   /* half-way saved, and loaded into a simulation set up alike */
  STORY_ADVANCE, /* by mpm_advance() */
  STORY_FAILING, /* half-way a step is far too large, and repeated */
  STORY_CHANGED  /* half-way particles come and go, and another method takes over */
};

typedef struct scene {
  char name[96];
  int32_t dim, geometry, total, lattice, basis, boundary, scheme, quasi_static, transfer, xpic_order,
      xpic_every;
  double smoothing, flip, pic_damping;
  int32_t law[2]; /* of the sets; LAW_NONE for no second one */
  int32_t position_order, staggered, remedy, reference, zero_acceleration, projected, damped;
  int32_t wall[6];
  int32_t periodic[3];
  int32_t large; /* enough rows for several levels of multigrid */
  int32_t with, solver, story, steps, concurrency;
} scene;

/* A scene is told as a whole, or in halves with its state in a file between them, which may be on different
 * machines: the second one gives the hash of the whole. Or it is told on several parts, each of which calls
 * run_scene() and gives the hash of the whole. */
enum { WHOLE, FIRST_HALF, SECOND_HALF, REFUSAL = 256 };
typedef struct errand {
  int32_t isa, half;
  const char *file;
  const mpm_transport *transport; /* NULL: one part */
  char *refusal; /* [REFUSAL] what the library refuses is written here; NULL: to the standard error */
} errand;

typedef struct world {
  const scene *is;
  const errand *how;
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material[2];
  mpm_particles *set[2];
  mpm_stepper *stepper;
  mpm_obstacle *obstacle[3];
  mpm_surface *surface;
  mpm_step_info info;
  int64_t first[2],
      all[2]; /* particles of each set: number of the first one of this part, and of all parts */
  double dt;  /* of a middling step */
  uint64_t hash;
} world;

/* Ends the scene with the library's sentence unless the call succeeds. */
#define must(w_, call) must_be_ok((w_), (call), #call)
void must_be_ok(const world *w, mpm_status status, const char *call);

/* Whether the library offers the grid and the method of the scene. */
int32_t is_offered(const scene *is);
/* empty: without particles. */
void open_world(world *w, const scene *is, const errand *how, int32_t empty);
void close_world(world *w);
mpm_stepper_desc describe_stepper(const scene *is);
/* Replaces values by their sums over all parts. */
void sum_parts(world *w, int64_t count, int64_t *values);
/* Tells the story of a scene; 0 if it failed, which is on the standard error and leaves behind what was open.
 */
int32_t run_scene(const scene *is, const errand *how, uint64_t *hash);
/* Ends the scene that is told as failed; the program where none is. */
_Noreturn void give_up(void);

/* The same everywhere: uniform in [-1, 1]. */
double noise(uint64_t seed);

/* host.c: what the host adds, by the bits of the scene, and its laws. */
void set_callbacks(world *w);
mpm_status make_host_law(mpm_context *context, int32_t law, mpm_material **out);

/* digest.c */
void mix(uint64_t *hash, uint64_t word);
void mix_double(uint64_t *hash, double value);
void mix_info(uint64_t *hash, const mpm_step_info *info);
/* State, reactions, nodal fields of the last step, history of the residual. */
void mix_world(world *w);

/* list.c: all scenes, in an order that stays. To be freed. */
scene *list_scenes(int32_t *count);

#endif
