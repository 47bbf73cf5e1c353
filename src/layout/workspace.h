/* Memory that the tasks of a step work in, and what they have to tell. */
#ifndef MPMI_WORKSPACE_H
#define MPMI_WORKSPACE_H

#include "layout/failure.h"
#include "layout/sorted_layout.h"

/* What one task has to tell at the end. */
typedef struct mpmi_task_report {
  mpmi_failure failure;
  int32_t left_tile, removes; /* a particle left its loose tile; one left through an open wall */
  int32_t holes_restored;     /* sums over the particles may not be finite */
  int64_t active;             /* nodes with mass in its share */
  double law_seconds, weights_seconds;
} mpmi_task_report;

/* Memory that one task works in. */
typedef struct mpmi_scratch {
  double *tile;        /* of one block: of the nodes that particles take from, or of sums */
  double *sum_tile;    /* of sums that are made while particles take; of implicit steps */
  double *gathered;    /* v, dv, C of one batch */
  double *cells;       /* tile of cell sums, for the locking remedy */
  void *batch_memory;  /* of the law */
  int64_t blocks_seen; /* for sampling the weights */
} mpmi_scratch;

/* Memory of all tasks. Nothing in it but blocks_seen outlives a step. */
typedef struct mpmi_workspace {
  mpmi_scratch *scratch;    /* [tasks] */
  mpmi_task_report *report; /* [tasks] */
  void *scratch_memory;
  size_t scratch_bytes;
  mpmi_sums *block_sums; /* [blocks] energies, momenta and rates of the new state */
  double *block_work;    /* [blocks] work of the host on nodes */
  int64_t block_sums_capacity, block_work_capacity;
} mpmi_workspace;

mpm_status mpmi_workspace_create(mpmi_workspace *work, const mpmi_settings *settings);
void mpmi_workspace_free(mpmi_workspace *work, const mpmi_settings *settings);
/* Memory for a step with the present layout. */
mpm_status mpmi_workspace_prepare(mpmi_workspace *work, const mpmi_settings *settings,
                                  const mpmi_layout *layout);
/* Forgets what tasks have told. */
void mpmi_reports_clear(mpmi_workspace *work, int32_t tasks);

#endif
