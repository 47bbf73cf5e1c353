/* volumes SIDE CELLS [STEPS]: what parts send each other. A cube of SIDE * CELLS cells a side with 8
 * particles in each flies a tenth of a cell per step on SIDE^3 parts, threads of this process. Of each part:
 * particles, blocks and those at the edge, neighbours, ghosts, and what it sends in the step that sends least
 * and in the one that sends most; at the end the means of all parts and the largest. 3-D, quadratic, MPM_USL,
 * MPM_FLIP: one sum on nodes in a step. */
#include "parts.h"

#include <mpm/mpm.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { COLUMNS = 7 };

typedef struct job {
  int64_t side, cells, steps;
  int64_t row[PARTS_MOST][COLUMNS];
  int32_t failed[PARTS_MOST];
} job;

static mpm_status fill(const job *j, mpm_context *context, mpm_grid *grid, mpm_material **law,
                       mpm_particles **set) {
  static const mpm_param solid[] = {{"E", 100.0}, {"nu", 0.3}, {"density", 1e3}};
  static const int32_t per_cell[3] = {2, 2, 2};
  static const double velocity[3] = {1.0, 1.0, 1.0};
  const double edge = (double)(j->side * j->cells), lower[3] = {8.0, 8.0, 8.0};
  const double upper[3] = {8.0 + edge, 8.0 + edge, 8.0 + edge};
  mpm_status status = mpm_material_create(context, "neo_hookean", solid, 3, law);
  if (!status) status = mpm_particles_create(context, grid, *law, set);
  if (!status) status = mpm_particles_fill_box(*set, lower, upper, per_cell, NULL, NULL);
  if (!status) status = mpm_particles_set_all(*set, "velocity", MPM_F64, 3, velocity);
  return status;
}

static mpm_status make_steps(const job *j, mpm_stepper *stepper, int64_t *row) {
  mpm_parallel_info info = {.struct_size = sizeof info};
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < j->steps && !status; ++i) {
    status = mpm_step(stepper, 0.1, NULL); /* sound takes 27 steps through a cell */
    if (!status) status = mpm_stepper_parallel_info(stepper, 1, &info);
    if (i == 0 || info.bytes_nodes < row[5]) row[5] = info.bytes_nodes;
    if (i == 0 || info.bytes_nodes > row[6]) row[6] = info.bytes_nodes;
  }
  row[1] = info.blocks;
  row[2] = info.boundary;
  row[3] = info.neighbours;
  row[4] = info.ghosts;
  return status;
}

static void run_part(int32_t part, const mpm_transport *transport, void *user) {
  job *j = user;
  mpm_context *context = NULL;
  mpm_grid *grid = NULL;
  mpm_material *law = NULL;
  mpm_particles *set = NULL;
  mpm_stepper *stepper = NULL;
  mpm_context_desc c;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_status status = mpm_context_desc_init(&c, sizeof c);
  if (!status) status = mpm_grid_desc_init(&g, sizeof g);
  if (!status) status = mpm_stepper_desc_init(&s, sizeof s);
  if (status) abort();
  c.transport = transport;
  for (int32_t k = 0; k < 3; ++k) {
    g.spacing[k] = 1.0;
    g.cells[k] = j->side * j->cells + 16 + j->steps / 10;
  }
  status = mpm_context_create(&c, &context);
  if (!status) status = mpm_grid_create(context, &g, &grid);
  if (!status) status = mpm_stepper_create(context, grid, &s, &stepper);
  if (!status) status = fill(j, context, grid, &law, &set);
  if (!status) status = mpm_stepper_add(stepper, set);
  if (!status) status = make_steps(j, stepper, j->row[part]);
  if (status) fprintf(stderr, "part %d: %s\n", (int)part, context ? mpm_last_error(context) : "no context");
  j->row[part][0] = mpm_particles_count(set);
  j->failed[part] = status != MPM_OK || mpm_stepper_destroy(stepper) || mpm_particles_destroy(set) ||
                    mpm_material_destroy(law) || mpm_grid_destroy(grid);
  mpm_context_destroy(context);
}

static void print(const char *name, const double *value) {
  printf("%-8s", name);
  for (int32_t k = 0; k < COLUMNS; ++k)
    printf(k < 5 ? " %10.0f" : " %10.3f", k < 5 ? value[k] : 1e-6 * value[k]);
  printf("\n");
}

int main(int argc, char **argv) {
  job *j = calloc(1, sizeof *j);
  parts_plan plan = {.fail_part = 0};
  if (!j || argc < 3) return 1;
  j->side = atoi(argv[1]);
  j->cells = atoi(argv[2]);
  j->steps = argc > 3 ? atoi(argv[3]) : 20;
  const int32_t parts = (int32_t)(j->side * j->side * j->side);
  if (j->side < 1 || parts > PARTS_MOST || j->cells < 2 || j->steps < 1) return 1;
  int failed = parts_run(parts, run_part, j, &plan);
  double mean[COLUMNS] = {0.0}, most[COLUMNS] = {0.0};
  printf("%-8s %10s %10s %10s %10s %10s %10s %10s\n", "part", "particles", "blocks", "at edge", "neighbours",
         "ghosts", "least/MB", "most/MB");
  for (int32_t p = 0; p < parts; ++p) {
    double row[COLUMNS];
    char name[16];
    for (int32_t k = 0; k < COLUMNS; ++k) {
      row[k] = (double)j->row[p][k];
      mean[k] += row[k] / parts;
      if (row[k] > most[k]) most[k] = row[k];
    }
    snprintf(name, sizeof name, "%d", (int)p);
    print(name, row);
    failed |= j->failed[p];
  }
  print("mean", mean);
  print("largest", most);
  if (failed) fprintf(stderr, "volumes: failed. %s\n", plan.text);
  free(j);
  return failed != 0;
}
