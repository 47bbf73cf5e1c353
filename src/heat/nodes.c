/* Temperatures and increments of nodes: nodes that go together, and what prescribed faces do. */
#include "heat/heat.h"
#include "layout/tasks.h"
#include "parallel/parts.h"

#include <math.h>

/* ---- ties ---------------------------------------------------------------------------------------------- */
mpm_status mpmi_heat_tie(const mpmi_heat_job *job) {
  const mpmi_heat_rules *rules = &job->step->settings->heat;
  const mpm_grid *grid = job->step->settings->grid;
  mpmi_heat *heat = job->heat;
  if (heat->version == job->step->layout->version && heat->walls == rules->walls) return MPM_OK;
  for (int32_t face = 0; face < 2 * grid->dim; ++face)
    heat->wall[face].kind =
        rules->wall[face].kind == MPM_HEAT_WALL_TEMPERATURE ? MPM_WALL_SLIP : MPM_WALL_NONE;
  heat->version = -1;
  mpm_status status = mpmi_constraints_build(&heat->ties, &job->step->layout->blocks, heat->wall);
  if (!status)
    status =
        MPMI_RESERVE_MORE(job->step->settings->context, heat->met, heat->tie_capacity, heat->ties.tie_count);
  if (status) return status;
  heat->version = job->step->layout->version;
  heat->walls = rules->walls;
  return MPM_OK;
}

int32_t mpmi_heat_face(const mpmi_heat_job *job, const mpmi_tie *tie) {
  for (int32_t k = 0; k < job->step->settings->grid->dim; ++k)
    if (tie->zero[k]) return tie->face[k];
  return -1;
}

double mpmi_heat_sign(const mpmi_follower *follower) {
  return follower->sign[0] * follower->sign[1] * follower->sign[2];
}

/* A value on the plane of a face, next to a tie. */
typedef double (*plane_fn)(const mpmi_heat_job *job, const mpmi_tie *tie, int32_t face);

/* Returns what a follower has beside its master's value, which the sign turns: an odd one twice the value on
 * the plane that mirrors it. On two cells a master has mirrors at either face. */
static double base_of(const mpmi_heat_job *job, const mpmi_tie *tie, const mpmi_follower *follower,
                      plane_fn value) {
  if (mpmi_heat_sign(follower) > 0.0) return 0.0;
  double sum = 0.0, odd = 0.0;
  int64_t index[3];
  mpmi_blocks_index(&job->step->layout->blocks, follower->slot, index);
  for (int32_t k = 0; k < job->step->settings->grid->dim; ++k)
    if (follower->sign[k] < 0.0) sum += value(job, tie, 2 * k + (index[k] > 0)), odd += 1.0;
  return 2.0 * sum / odd;
}

/* ---- faces that begin to prescribe --------------------------------------------------------------------- */
/* Returns 1 for the image of a node on a periodic axis: particles around the seam give to either. */
static int32_t is_image(const mpmi_follower *follower) {
  return follower->sign[0] > 0.0 && follower->sign[1] > 0.0 && follower->sign[2] > 0.0;
}

/* Finds the mean temperature around a node and its images, and where that is along an axis. Returns 0 where
 * there is none. */
static int32_t find_mean(const mpmi_heat *heat, int64_t slot, int32_t axis, double *T, double *x) {
  if (slot < 0) return 0;
  const mpmi_tie *tie = heat->ties.tie_of[slot] < 0 ? NULL : &heat->ties.tie[heat->ties.tie_of[slot]];
  const double *node = mpmi_heat_node(heat, tie ? tie->master : slot);
  double capacity = node[MPMI_HEAT_CAPACITY], heat_there = node[MPMI_HEAT_TEMPERATURE],
         place = mpmi_heat_flow(heat, tie ? tie->master : slot)[axis];
  for (int64_t i = tie ? tie->first : 0; tie && i < tie->first + tie->count; ++i) {
    const mpmi_follower *f = &heat->ties.follower[i];
    if (!is_image(f)) continue;
    capacity += mpmi_heat_node(heat, f->slot)[MPMI_HEAT_CAPACITY];
    heat_there += mpmi_heat_node(heat, f->slot)[MPMI_HEAT_TEMPERATURE];
    place += mpmi_heat_flow(heat, f->slot)[axis];
  }
  if (!(capacity > 0.0)) return 0;
  *T = heat_there / capacity;
  *x = place / capacity;
  return 1;
}

/* Returns the temperature at a face by a line through the means of two nodes: the one on the face has
 * particles on one side of it alone, and of a field that is linear its mean is that of their middle. */
static double temperature_at(const mpmi_heat_job *job, const mpmi_tie *tie, int32_t face) {
  const mpm_grid *grid = job->step->settings->grid;
  const int32_t axis = face / 2;
  const double plane = face % 2 ? grid->upper[axis] : grid->desc.origin[axis];
  int32_t offset[3] = {0, 0, 0};
  double T = job->step->settings->heat.wall[face].temperature, x = plane, T_in, x_in;
  offset[axis] = face % 2 ? -1 : 1;
  const int64_t inner = mpmi_blocks_beside(&job->step->layout->blocks, tie->master, offset);
  if (!find_mean(job->heat, tie->master, axis, &T, &x) || !find_mean(job->heat, inner, axis, &T_in, &x_in))
    return T;
  const double apart = x_in - x;
  if (!(fabs(apart) > 1e-6 * grid->desc.spacing[axis])) return T;
  return T + (T_in - T) * (plane - x) / apart;
}

static int32_t begins(const mpmi_step *step, const mpmi_heat_history *history, int32_t face) {
  return face >= 0 && step->settings->heat.wall[face].kind == MPM_HEAT_WALL_TEMPERATURE &&
         !(history->acted[face] > 0.0);
}

int32_t mpmi_heat_begins(const mpmi_step *step, const mpmi_heat_history *history) {
  int32_t any = 0;
  for (int32_t face = 0; face < 2 * step->settings->grid->dim; ++face) any |= begins(step, history, face);
  return any;
}

mpm_status mpmi_heat_meet(const mpmi_heat_job *job) {
  const mpmi_constraints *ties = &job->heat->ties;
  const int32_t any = mpmi_heat_begins(job->step, job->history);
  const mpm_status status = any ? mpmi_heat_places(job) : MPM_OK;
  for (int64_t i = 0; i < ties->tie_count && any && !status; ++i) {
    const int32_t face = mpmi_heat_face(job, &ties->tie[i]);
    if (begins(job->step, job->history, face)) job->heat->met[i] = temperature_at(job, &ties->tie[i], face);
  }
  return status;
}

/* ---- temperatures -------------------------------------------------------------------------------------- */
static void untied_temperatures(void *data, int64_t task) {
  const mpmi_heat_job *job = data;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), task);
  for (int64_t slot = share.begin; slot < share.end; ++slot) {
    double *node = mpmi_heat_node(job->heat, slot);
    if (job->heat->ties.tie_of[slot] >= 0) continue;
    node[MPMI_HEAT_TEMPERATURE] =
        node[MPMI_HEAT_CAPACITY] > 0.0 ? node[MPMI_HEAT_TEMPERATURE] / node[MPMI_HEAT_CAPACITY] : 0.0;
  }
}

static double prescribed(const mpmi_heat_job *job, const mpmi_tie *tie, int32_t face) {
  (void)tie;
  return job->step->settings->heat.wall[face].temperature;
}

/* Sets a tie: by the mean of its nodes with their signs, or as it is prescribed. */
static void tied_temperatures(const mpmi_heat_job *job, const mpmi_tie *tie) {
  const mpmi_constraints *ties = &job->heat->ties;
  const int32_t face = mpmi_heat_face(job, tie);
  double *master = mpmi_heat_node(job->heat, tie->master);
  double capacity = master[MPMI_HEAT_CAPACITY], sum = master[MPMI_HEAT_TEMPERATURE];
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i) {
    const double *node = mpmi_heat_node(job->heat, ties->follower[i].slot);
    const double base = base_of(job, tie, &ties->follower[i], prescribed);
    capacity += node[MPMI_HEAT_CAPACITY];
    sum +=
        mpmi_heat_sign(&ties->follower[i]) * (node[MPMI_HEAT_TEMPERATURE] - node[MPMI_HEAT_CAPACITY] * base);
  }
  const double mean = capacity > 0.0 ? sum / capacity : 0.0;
  master[MPMI_HEAT_TEMPERATURE] = face >= 0 ? job->step->settings->heat.wall[face].temperature : mean;
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i) {
    const mpmi_follower *f = &ties->follower[i];
    mpmi_heat_node(job->heat, f->slot)[MPMI_HEAT_TEMPERATURE] =
        face >= 0 ? master[MPMI_HEAT_TEMPERATURE]
                  : base_of(job, tie, f, prescribed) + mpmi_heat_sign(f) * mean;
  }
}

mpm_status mpmi_heat_temperatures(const mpmi_heat_job *job) {
  const mpmi_constraints *ties = &job->heat->ties;
  const mpmi_settings *settings = job->step->settings;
  const mpm_status status =
      mpmi_run_tasks(settings, 0, settings->tasks, untied_temperatures, (void *)(uintptr_t)job);
  for (int64_t i = 0; i < ties->tie_count && !status; ++i) tied_temperatures(job, &ties->tie[i]);
  return status;
}

/* ---- increments ---------------------------------------------------------------------------------------- */
static void untied_increments(void *data, int64_t task) {
  const mpmi_heat_job *job = data;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), task);
  for (int64_t slot = share.begin; slot < share.end; ++slot) {
    const double *node = mpmi_heat_node(job->heat, slot);
    double *flow = mpmi_heat_flow(job->heat, slot);
    if (job->heat->ties.tie_of[slot] >= 0) continue;
    flow[MPMI_HEAT_INCREMENT] =
        node[MPMI_HEAT_CAPACITY] > 0.0
            ? job->step->dt * (node[MPMI_HEAT_POWER] - flow[MPMI_HEAT_OUTFLOW]) / node[MPMI_HEAT_CAPACITY]
            : 0.0;
    flow[MPMI_HEAT_FILM] = node[MPMI_HEAT_CAPACITY] > 0.0
                               ? job->step->dt * flow[MPMI_HEAT_FILM] / node[MPMI_HEAT_CAPACITY]
                               : 0.0;
  }
}

/* Gives all nodes of a tie an increment, with their signs or without. */
static void spread(const mpmi_heat_job *job, const mpmi_tie *tie, double increment, int32_t signs) {
  const mpmi_constraints *ties = &job->heat->ties;
  mpmi_heat_flow(job->heat, tie->master)[MPMI_HEAT_INCREMENT] = increment;
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i) {
    const double sign = signs ? mpmi_heat_sign(&ties->follower[i]) : 1.0;
    mpmi_heat_flow(job->heat, ties->follower[i].slot)[MPMI_HEAT_INCREMENT] = sign * increment;
  }
}

/* Films take this share from all nodes of a tie. */
static void spread_films(const mpmi_heat_job *job, const mpmi_tie *tie, double share) {
  mpmi_heat_flow(job->heat, tie->master)[MPMI_HEAT_FILM] = share;
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i)
    mpmi_heat_flow(job->heat, job->heat->ties.follower[i].slot)[MPMI_HEAT_FILM] = share;
}

static double power_of(const mpmi_heat *heat, int64_t slot) {
  return mpmi_heat_node(heat, slot)[MPMI_HEAT_POWER] - mpmi_heat_flow(heat, slot)[MPMI_HEAT_OUTFLOW];
}

static void tied_increment(const mpmi_heat_job *job, const mpmi_tie *tie) {
  const mpmi_constraints *ties = &job->heat->ties;
  double capacity = mpmi_heat_node(job->heat, tie->master)[MPMI_HEAT_CAPACITY],
         power = power_of(job->heat, tie->master),
         film = mpmi_heat_flow(job->heat, tie->master)[MPMI_HEAT_FILM];
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i) {
    const mpmi_follower *f = &ties->follower[i];
    capacity += mpmi_heat_node(job->heat, f->slot)[MPMI_HEAT_CAPACITY];
    power += mpmi_heat_sign(f) * power_of(job->heat, f->slot);
    film += mpmi_heat_flow(job->heat, f->slot)[MPMI_HEAT_FILM];
  }
  spread_films(job, tie, capacity > 0.0 ? job->step->dt * film / capacity : 0.0);
  spread(job, tie, capacity > 0.0 ? job->step->dt * power / capacity : 0.0, 1);
}

mpm_status mpmi_heat_advance(const mpmi_heat_job *job) {
  const mpmi_settings *settings = job->step->settings;
  const mpmi_constraints *ties = &job->heat->ties;
  for (int64_t i = 0; i < ties->tie_count; ++i) {
    if (mpmi_heat_face(job, &ties->tie[i]) < 0)
      tied_increment(job, &ties->tie[i]);
    else
      spread_films(job, &ties->tie[i], 0.0);
  }
  return mpmi_run_tasks(settings, 0, settings->tasks, untied_increments, (void *)(uintptr_t)job);
}

/* Returns the change of the temperature that a face prescribes, at a node on its plane. */
static double change_at(const mpmi_heat_job *job, int32_t face, int64_t slot) {
  const double now = job->step->settings->heat.wall[face].temperature;
  if (job->history->acted[face] > 0.0) return now - job->history->prescribed[face];
  const int32_t tie = slot < 0 ? -1 : job->heat->ties.tie_of[slot];
  return tie < 0 ? 0.0 : now - job->heat->met[tie];
}

static double change_beside(const mpmi_heat_job *job, const mpmi_tie *tie, int32_t face) {
  int32_t offset[3] = {0, 0, 0};
  offset[face / 2] = face % 2 ? 1 : -1;
  return change_at(job, face, mpmi_blocks_beside(&job->step->layout->blocks, tie->master, offset));
}

/* Mirrors change with the planes that they are mirrored at. */
static void move_mirrors(const mpmi_heat_job *job, const mpmi_tie *tie) {
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i) {
    const mpmi_follower *f = &job->heat->ties.follower[i];
    mpmi_heat_flow(job->heat, f->slot)[MPMI_HEAT_INCREMENT] += base_of(job, tie, f, change_beside);
  }
}

void mpmi_heat_prescribe(const mpmi_heat_job *job) {
  const mpmi_constraints *ties = &job->heat->ties;
  for (int64_t i = 0; i < ties->tie_count; ++i) {
    const mpmi_tie *tie = &ties->tie[i];
    const int32_t face = mpmi_heat_face(job, tie);
    if (face >= 0)
      spread(job, tie, change_at(job, face, tie->master), 0);
    else
      move_mirrors(job, tie);
  }
}

/* ---- the end ------------------------------------------------------------------------------------------- */
/* Returns what a node takes up beyond what flows to it. */
static double taken_up(const mpmi_heat_job *job, int64_t slot) {
  return mpmi_heat_node(job->heat, slot)[MPMI_HEAT_CAPACITY] *
             mpmi_heat_flow(job->heat, slot)[MPMI_HEAT_INCREMENT] -
         job->step->dt * power_of(job->heat, slot);
}

/* Returns the face through which a tie gets what it takes up, or -1. */
static int32_t feeding_face(const mpmi_heat_job *job, const mpmi_tie *tie) {
  const int32_t face = mpmi_heat_face(job, tie);
  for (int32_t k = 0; face < 0 && k < job->step->settings->grid->dim; ++k)
    if (tie->face[k] >= 0) return tie->face[k];
  return face;
}

/* Temperatures of nodes have counted the change of what is prescribed from the start of the step. */
static void raise_tie(const mpmi_heat *heat, const mpmi_tie *tie) {
  const double rise = mpmi_heat_flow(heat, tie->master)[MPMI_HEAT_INCREMENT];
  mpmi_heat_node(heat, tie->master)[MPMI_HEAT_TEMPERATURE] += rise;
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i) {
    const mpmi_follower *f = &heat->ties.follower[i];
    mpmi_heat_node(heat, f->slot)[MPMI_HEAT_TEMPERATURE] += mpmi_heat_sign(f) * rise;
  }
}

static void untied_rises(void *data, int64_t task) {
  const mpmi_heat_job *job = data;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), task);
  for (int64_t slot = share.begin; slot < share.end; ++slot)
    if (job->heat->ties.tie_of[slot] < 0)
      mpmi_heat_node(job->heat, slot)[MPMI_HEAT_TEMPERATURE] +=
          mpmi_heat_flow(job->heat, slot)[MPMI_HEAT_INCREMENT];
}

mpm_status mpmi_heat_settle(const mpmi_heat_job *job) {
  const mpmi_settings *settings = job->step->settings;
  const mpmi_constraints *ties = &job->heat->ties;
  for (int64_t i = 0; i < ties->tie_count; ++i) {
    const mpmi_tie *tie = &ties->tie[i];
    const int32_t face = feeding_face(job, tie);
    double heat = taken_up(job, tie->master);
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d)
      heat += taken_up(job, ties->follower[d].slot);
    if (face >= 0 && mpmi_owns_node(job->step->layout->parts, tie->master))
      mpmi_exact_add(&job->heat->sum[MPMI_HEAT_WALLS + face], heat);
    if (mpmi_heat_face(job, tie) < 0) raise_tie(job->heat, tie);
  }
  return mpmi_run_tasks(settings, 0, settings->tasks, untied_rises, (void *)(uintptr_t)job);
}
