/* The step under way: made when a step starts and dropped when it ends. What stages learn that outlives the
 * step goes into the particles' second copies, or is taken from here when the step is committed. */
#ifndef MPMI_STEP_H
#define MPMI_STEP_H

#include "layout/member_rows.h"
#include "layout/tally.h"

/* What ends a step early. Failures of tasks are collected, and the first decides so that reports repeat: that
 * of the smallest (set, particle), then of the smallest node. */
typedef struct mpmi_failure {
  mpm_status cause;
  int32_t callback_status, set;
  int64_t particle, node;
  const char *what;
  int32_t body; /* of the node */
} mpmi_failure;

/* What one task has to tell at the end. */
typedef struct mpmi_task_report {
  mpmi_failure failure;
  int32_t left_cover, left_tile;     /* a particle left the cover of its block, its loose tile */
  int32_t removes;                   /* one left through an open wall */
  int32_t holes_restored;            /* sums over the particles may not be finite */
  int64_t active;                    /* nodes in its share that are heavier than the cut */
  int64_t light, first_light;        /* lighter ones with mass, and where their list begins */
  double contact_change;             /* largest change of a velocity by contact of bodies */
  mpmi_whole_sum host_work, damping; /* of the nodes in its share */
  double law_seconds, weights_seconds;
} mpmi_task_report;

/* Memory that one task works in. */
typedef struct mpmi_scratch {
  double *tile;        /* one block's nodes to gather from, or sums to be added */
  double *sum_tile;    /* sums made while `tile` is gathered from; implicit steps only */
  double *gathered;    /* v, dv, C of one batch */
  double *cells;       /* tile of cell sums, for the locking remedy */
  void *batch_memory;  /* memory of the law */
  int64_t blocks_seen; /* for sampling the weights */
} mpmi_scratch;

/* What friction walls did to particles that came through between nodes (motion.c). */
typedef struct mpmi_stops {
  double impulse[6]; /* by face, along its axis */
  double energy;     /* kinetic energy that it took */
} mpmi_stops;

/* Memory of all tasks. Nothing in it but blocks_seen outlives a step. */
typedef struct mpmi_workspace {
  mpmi_scratch *scratch;    /* [tasks] */
  mpmi_task_report *report; /* [tasks] */
  void *scratch_memory;
  size_t scratch_bytes;
  mpmi_step_rows rows;
  mpmi_sums *block_sums;   /* [blocks] energies and momenta of the new state; rates, the largest of the blocks
                              that a task has had so far */
  mpmi_stops *block_stops; /* [blocks], where there are friction walls */
  int64_t block_sums_capacity, block_stops_capacity;
  mpmi_tally tally;
} mpmi_workspace;

/* Seconds by stage, in the order of mpm_profile. */
enum {
  MPMI_TIME_SORT,
  MPMI_TIME_P2G,
  MPMI_TIME_GRID,
  MPMI_TIME_G2P,
  MPMI_TIME_LAW,
  MPMI_TIME_CALLBACKS,
  MPMI_TIME_TOTAL,
  MPMI_TIME_WEIGHTS,
  MPMI_TIME_ASSEMBLY,
  MPMI_TIME_FACTOR,
  MPMI_TIME_SOLVE,
  MPMI_TIMES
};
typedef struct mpmi_profile {
  double seconds[MPMI_TIMES];
  int32_t sampled; /* the host has asked once: law and weights are sampled, too */
} mpmi_profile;

enum { MPMI_IDLE, MPMI_RUNNING, MPMI_BEGUN, MPMI_SOLVED }; /* phases */

typedef struct mpmi_step {
  int32_t phase;  /* MPMI_IDLE: there is no step, and nothing else here counts */
  int32_t takes;  /* how new velocities follow from the nodes, MPMI_TAKES_... */
  int32_t staged; /* in parts, with the host in between: nodes keep force apart from momentum */
  const mpmi_settings *settings;
  const mpmi_layout *layout;
  mpmi_workspace *work;
  mpmi_profile *profile;    /* of all steps */
  mpmi_pair_records *pairs; /* of bodies, with what they do to each other in the step */
  double t, dt;
  double velocity_dt; /* time over which forces change velocities: dt, or staggered the mean of two steps */
  mpmi_failure failure;
  double impulse_by_face[6][3]; /* on the walls */
  double host_work;             /* of prescribed velocities, prescribed particles and hooks */
  int32_t is_cut;               /* where it fails, mpm_advance() makes it shorter by itself */
  int32_t whole_increments;     /* implicit: nodes give particles the whole change of their velocity */
  int64_t negative_pivots;      /* implicit: of the last system, where a factor has told; else 0 or -1 */
  mpm_step_info info;           /* what the step reports if it is made, as far as it is known */
  /* Shows the host the info and asks whether to go on; anything but MPM_OK ends the step. */
  mpm_status (*ask_progress)(struct mpm_stepper *stepper);
  /* Lets all parts know whether one of them has failed (stepper/together.c). */
  mpm_status (*vote)(struct mpm_stepper *stepper, mpm_status status, int64_t exchanges);
  struct mpm_stepper *stepper;
} mpmi_step;

/* Returns the share of FLIP in a step that blends, 0 in others: MPoint theory, eqs 58 and 59. */
static inline double mpmi_flip_share(const mpmi_step *step) {
  if (step->takes != MPMI_TAKES_BLEND) return 0.0;
  const double kept = 1.0 - step->settings->desc.pic_damping * step->velocity_dt;
  return kept > 0.0 ? step->settings->desc.flip * kept : 0.0;
}
/* Returns 1 when the step projects corrections. */
static inline int32_t mpmi_corrects(const mpmi_step *step) {
  return step->takes != MPMI_TAKES_BLEND && mpmi_is_corrected(step->settings);
}

mpmi_failure mpmi_no_failure(void);
/* Replaces `first` by `other` if that comes before it. */
void mpmi_failure_take(mpmi_failure *first, mpmi_failure other);
/* Return what went wrong at a particle of set m, at the node of a slot, and in a callback of the host; it was
 * called for set m, or with -1 for none. */
mpmi_failure mpmi_particle_failure(mpm_status cause, int32_t m, int64_t id, const char *what);
mpmi_failure mpmi_node_failure(mpm_status cause, const mpmi_blocks *blocks, int64_t slot, const char *what);
mpmi_failure mpmi_callback_failure(mpm_status returned, int32_t m, const char *what);
/* Turns a callback's status into a cause: > 0 cuts dt, < 0 stops. */
mpm_status mpmi_callback_cause(mpm_status status);
void mpmi_failures_clear(mpmi_step *step);
/* Returns the status of the step from the first failure among the tasks, and writes its sentence; MPM_OK when
 * none failed. */
mpm_status mpmi_step_failure(mpmi_step *step);

mpm_status mpmi_workspace_create(mpmi_workspace *work, const mpmi_settings *settings);
void mpmi_workspace_free(mpmi_workspace *work, const mpmi_settings *settings);
/* Makes room for a step with the present layout. */
mpm_status mpmi_workspace_prepare(mpmi_workspace *work, const mpmi_settings *settings,
                                  const mpmi_layout *layout);
/* Forgets what tasks have told. */
void mpmi_reports_clear(mpmi_workspace *work, int32_t tasks);

/* Adds the seconds since *from to a stage and restarts the clock. */
void mpmi_lap(mpmi_step *step, int32_t stage, double *from);
/* Moves the time of laws, which run inside a stage's tasks, from that stage to the law's entry, and adds that
 * of the weights. */
void mpmi_move_samples(mpmi_step *step, int32_t stage);
/* Now and then makes the weights of the slots [begin, end) once more, to know how long that takes. */
void mpmi_sample_weights(mpmi_step *step, int32_t task, const mpmi_axis *axis, int32_t need,
                         const mpmi_points *points, int64_t begin, int64_t end);

#endif
