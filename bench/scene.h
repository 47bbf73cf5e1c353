/* The body that is timed: a jittered cube of particles, added in random order, that rotates and strains in
 * the middle of a grid; and what can be varied about it. */
#ifndef BENCH_SCENE_H
#define BENCH_SCENE_H

#include <mpm/mpm.h>

enum { BENCH_MOST_OBSTACLES = 10 };
enum {
  BENCH_FREE,
  BENCH_WALLS,
  BENCH_FORCE,
  BENCH_HOST_LAW,
  BENCH_OPEN_KNOTS,
  BENCH_SECOND_ORDER, /* positions */
  BENCH_REMEDY,       /* against locking */
  BENCH_OBSTACLES,    /* ten, which nothing comes near */
  BENCH_CORNER, /* a corner of the body, nine cells wide, is another body in contact: 999 shared nodes */
  BENCH_HALVES, /* one half of the body is another body in contact */
  BENCH_TOTAL,  /* a total Lagrangian grid */
  BENCH_TOTAL_LATTICE, /* the same without jitter, as fills place particles */
  BENCH_HEAT,          /* the body conducts, in explicit steps */
  BENCH_HEAT_IMPLICIT
};

typedef struct bench_case {
  const char *name;
  int32_t dim, basis, scheme, transfer;
  const char *law;
  double cfl;     /* share of mpm_stable_dt */
  double speed;   /* of the fastest particle, over the speed of sound */
  int32_t steps;  /* of one timing: long enough for a re-sort */
  int32_t extras; /* BENCH_... */
} bench_case;

typedef struct bench_options {
  int64_t particles;
  int32_t threads;
  double spread;   /* bounds of the grid over the size of the body, 3 or more */
  int64_t markers; /* of a surface through the middle of the body that prescribes; 0: there is none */
} bench_options;

typedef struct bench_scene {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *body, *part; /* part: what is another body, or NULL */
  mpm_stepper *stepper;
  mpm_obstacle *obstacle[BENCH_MOST_OBSTACLES];
  mpm_surface *surface; /* or NULL */
  int64_t particles;
  int64_t allocations; /* asked of the host so far */
} bench_scene;

/* On failure the context's last error says why; bench_close() takes what is there. */
mpm_status bench_open(bench_scene *scene, const bench_case *of, const bench_options *options);
void bench_close(bench_scene *scene);
/* Useful floating-point operations and bytes of particle fields per particle and
 * step, counted in the source. */
double bench_flops(const bench_case *of);
/* Nodes in the stencil of a particle. */
double bench_nodes(const bench_case *of);
double bench_bytes(const bench_case *of);
/* Returns 1 for a plastic law. */
int32_t bench_yields(const bench_case *of);

#endif
