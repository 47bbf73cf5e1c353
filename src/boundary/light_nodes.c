/* Light nodes: those that have hardly any mass beside a neighbour's. On the linear basis the gradient of a
 * node, and so its force, stays finite where a particle hardly touches it and its mass vanishes: force over
 * mass would be as large as the mass is small. A light node goes with heavier ones, by linear extrapolation
 * along lines of nodes, and gives them its force by the transposed rule (docs/theory.md, 7.1): a particle
 * that hardly reaches into a cell strains and pulls as if it had stayed in the cell beside. */
#include "boundary/light_leaders.h"
#include "boundary/surface_holds.h"

#include <float.h>

/* What nodes give leaders that they share is seen in the second round, without which slivers grow by USL. The
 * margin of parts, light_margin in layout/sorted_layout.c, is for so many. */
enum { ROUNDS = 2 };

/* To wake a task costs as much as some of them. */
enum { FEW_LIGHT_NODES = 64 };

typedef struct light_job {
  mpmi_bound *bound;
  mpmi_light_search search;
} light_job;

/* ---- finding ------------------------------------------------------------------------------------------- */
/* The list holds slots of nodes with mass. Returns the node that moves for one of them: itself if it is free,
 * its master if that has no mass and this image is the first that has; else -1, because another entry of the
 * list stands for the master. */
static int64_t listed_by(const mpmi_bound *bound, int64_t slot) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  if (mpmi_constraints_is_free(constraints, slot)) return slot;
  const mpmi_tie *tie = &constraints->tie[constraints->tie_of[slot]];
  int64_t first = tie->first;
  if (*mpmi_mass(bound->values, tie->master) > DBL_MIN) return -1;
  while (!(*mpmi_mass(bound->values, constraints->follower[first].slot) > DBL_MIN)) ++first;
  return constraints->follower[first].slot == slot ? tie->master : -1;
}

/* A node that is not light after all, or that none leads, moves by its own force. */
static void go_alone(const mpmi_bound *bound, int64_t slot) {
  for (int32_t c = 0; c < bound->dim && mpmi_has_increments(bound->values); ++c)
    mpmi_velocity(bound->values, slot)[c] += mpmi_increment(bound->values, slot)[c];
}

/* Resolves an entry of the list to the node to be led, or to none. */
static void find(const light_job *job, mpmi_light_node *node) {
  const mpmi_bound *bound = job->bound;
  const int64_t slot = listed_by(bound, node->slot);
  node->slot = -1;
  node->count = node->acts = node->kept = 0;
  if (slot < 0 || mpmi_moving_mass(bound, slot) > bound->step->layout->light_cut) return;
  node->slot = slot;
  mpmi_light_find_lines(&job->search, node);
  if (!node->count) {
    go_alone(bound, slot);
    node->slot = -1;
  }
  node->acts = node->count > 0;
  for (int32_t c = 0; c < bound->dim && node->slot >= 0; ++c) {
    node->before[c] = mpmi_velocity(bound->values, slot)[c];
    node->gain[c] = mpmi_increment_of(bound, slot, c);
  }
}

/* ---- rounds -------------------------------------------------------------------------------------------- */
static const mpmi_leader *leaders_of(const mpmi_bound *bound, const mpmi_light_node *node) {
  return bound->nodes->leader + node->first;
}

/* Returns 1 for a node in the plane of a wall that rubs nodes. */
static int32_t rubs(const mpmi_bound *bound, int64_t slot, int32_t face) {
  return mpmi_wall_kind_of(bound->step->settings->wall[face].kind)->rubs == MPMI_RUBS_NODES &&
         mpmi_light_in_plane(bound, slot, face);
}

/* Returns 1 where a node goes with its own force into a wall that bears. */
static int32_t is_pressed(const mpmi_bound *bound, const mpmi_light_node *node, int32_t face) {
  const int32_t k = face / 2;
  return (face % 2 ? 1.0 : -1.0) * (node->before[k] + node->gain[k]) > 0.0 && rubs(bound, node->slot, face);
}

/* Returns the components, as bits, that do not go with leaders: a wall takes their force. */
static int32_t borne_of(const light_job *job, const mpmi_light_node *node) {
  const mpmi_bound *bound = job->bound;
  int32_t borne = node->kept | mpmi_light_held(&job->search, node->slot);
  for (int32_t face = 0; face < 2 * bound->dim; ++face)
    if (is_pressed(bound, node, face))
      borne |= bound->step->settings->wall[face].friction > 0.0 ? 7 : 1 << face / 2;
  return borne;
}

/* Adds to sum[3] a share of what a leader has of a vector: nothing where a wall will hold it. */
static void add_share(const mpmi_leader *of, const double *vector, int32_t dim, double *sum) {
  for (int32_t c = 0; c < dim; ++c)
    if (!(of->held >> c & 1)) sum[c] += of->share * vector[c];
}

/* Without a line for its velocity a node keeps its own, and all where a wall bears it. */
static void look(const light_job *job, mpmi_light_node *node) {
  const mpmi_bound *bound = job->bound;
  const mpmi_leader *leader = leaders_of(bound, node);
  const int32_t both = mpmi_has_increments(bound->values), borne = borne_of(job, node);
  double led[3] = {0.0, 0.0, 0.0}, led_gain[3] = {0.0, 0.0, 0.0};
  for (int32_t k = 0; k < node->count; ++k) {
    add_share(&leader[k], mpmi_velocity(bound->values, leader[k].slot), bound->dim, led);
    if (both) add_share(&leader[k], mpmi_increment(bound->values, leader[k].slot), bound->dim, led_gain);
  }
  for (int32_t c = 0; c < bound->dim; ++c) {
    const double before = node->before[c], gain = node->gain[c];
    node->led_gain[c] = borne >> c & 1 ? gain : led_gain[c];
    node->led_before[c] = borne >> c & 1 || node->lone ? before : led[c] - led_gain[c];
  }
}

/* Gives the leaders so much of the momentum that a node has apart from them that it goes with them after
 * that, where no other gives to them, too. */
static void give_rest(mpmi_bound *bound, mpmi_light_node *node) {
  const mpmi_leader *leader = leaders_of(bound, node);
  const double mass = mpmi_moving_mass(bound, node->slot);
  double momentum[3], gained[3];
  for (int32_t c = 0; c < bound->dim; ++c) {
    const double before = node->part * (node->before[c] - node->led_before[c]);
    const double gain = node->part * (node->gain[c] - node->led_gain[c]);
    momentum[c] = mass * (before + gain);
    gained[c] = mass * gain;
    node->before[c] -= before;
    node->gain[c] -= gain;
  }
  for (int32_t k = 0; k < node->count; ++k) {
    const double by = leader[k].share / mpmi_moving_mass(bound, leader[k].slot);
    for (int32_t c = 0; c < bound->dim; ++c)
      mpmi_shift_node(bound, leader[k].slot, c, by * momentum[c], by * gained[c]);
  }
}

/* Sets v~ and dv of a light node, which had its own dv beside v until now. */
static void set(mpmi_bound *bound, int64_t slot, int32_t c, double velocity, double increment) {
  double *v = mpmi_velocity(bound->values, slot);
  const double own = mpmi_increment_of(bound, slot, c);
  mpmi_shift_node(bound, slot, c, velocity - (v[c] + own), increment - own);
  v[c] = velocity; /* without the rounding of the shift */
  if (mpmi_has_increments(bound->values)) mpmi_increment(bound->values, slot)[c] = increment;
}

static void follow(mpmi_bound *bound, const mpmi_light_node *node) {
  for (int32_t c = 0; c < bound->dim; ++c)
    set(bound, node->slot, c, node->before[c] + node->gain[c], node->gain[c]);
}

/* ---- all of them --------------------------------------------------------------------------------------- */
static mpmi_share share_of(const light_job *job, int64_t k) {
  return mpmi_share_of(job->bound->step->settings, job->bound->nodes->light_count, k);
}

static void find_task(void *data, int64_t k) {
  const light_job *job = data;
  const mpmi_share share = share_of(job, k);
  for (int64_t n = share.begin; n < share.end; ++n) find(job, &job->bound->nodes->light[n]);
}

static void fill_task(void *data, int64_t k) {
  const light_job *job = data;
  const mpmi_nodes *nodes = job->bound->nodes;
  const mpmi_share share = share_of(job, k);
  for (int64_t n = share.begin; n < share.end; ++n)
    if (nodes->light[n].count)
      mpmi_light_fill(&job->search, &nodes->light[n], nodes->leader + nodes->light[n].first);
}

static void look_task(void *data, int64_t k) {
  const light_job *job = data;
  const mpmi_share share = share_of(job, k);
  for (int64_t n = share.begin; n < share.end; ++n)
    if (job->bound->nodes->light[n].acts) look(job, &job->bound->nodes->light[n]);
}

static mpm_status run(light_job *job, mpm_task_fn task) {
  const mpmi_settings *settings = job->bound->step->settings;
  if (job->bound->nodes->light_count >= FEW_LIGHT_NODES)
    return mpmi_run_tasks(settings, 0, settings->tasks, task, job);
  for (int64_t k = 0; k < settings->tasks; ++k) task(job, k);
  return MPM_OK;
}

static mpm_status find_leaders(light_job *job) {
  mpmi_nodes *nodes = job->bound->nodes;
  mpm_status status = run(job, find_task);
  int64_t count = 0;
  for (int64_t n = 0; n < nodes->light_count && !status; ++n) {
    nodes->light[n].first = count;
    count += nodes->light[n].count;
  }
  if (!status)
    status =
        MPMI_RESERVE_MORE(job->bound->step->settings->context, nodes->leader, nodes->leader_capacity, count);
  return status ? status : run(job, fill_task);
}

/* All light nodes are looked at before any of them is changed: no result depends on their order. */
static mpm_status lead(light_job *job) {
  mpmi_bound *bound = job->bound;
  const mpmi_nodes *nodes = bound->nodes;
  mpm_status status = MPM_OK;
  for (int32_t round = 0; round < ROUNDS && !status; ++round) {
    status = run(job, look_task);
    for (int64_t n = 0; n < nodes->light_count && !status; ++n)
      if (nodes->light[n].acts) give_rest(bound, &nodes->light[n]);
  }
  for (int64_t n = 0; n < nodes->light_count && !status; ++n)
    if (nodes->light[n].acts) follow(bound, &nodes->light[n]);
  return status;
}

mpm_status mpmi_light_nodes_lead(mpmi_bound *bound) {
  if (!bound->nodes->light_count) return MPM_OK;
  light_job job = {bound, mpmi_light_search_of(bound)};
  const mpm_status status = find_leaders(&job);
  return status ? status : lead(&job);
}

/* ---- once more ----------------------------------------------------------------------------------------- */
enum { ALL = 7 }; /* components, as bits */

static mpmi_party *party_at(const mpmi_contact_nodes *contact, int64_t slot) {
  const int64_t cloud = contact->cloud_of[slot];
  return cloud < 0 ? NULL : &contact->party[contact->cloud[cloud].party];
}

/* Tells which parties closed ties hold, and forgets who leads. */
static void mark_tied(const mpmi_contact_nodes *contact) {
  for (int64_t p = 0; p < contact->party_count; ++p)
    contact->party[p].tied = contact->party[p].leads = contact->party[p].stays = 0;
  for (int64_t i = 0; i < contact->touch_count; ++i) {
    const mpmi_touch *touch = &contact->touch[i];
    if (touch->rule->kind != MPM_CONTACT_TIED || !touch->was_closed) continue;
    for (int32_t k = 0; k < 2; ++k) contact->party[touch->party[k]].tied = 1;
  }
}

/* Returns the components, as bits, of a node that its holder has set, or a surface along which it slides, a
 * wall that rubs it, or a tie. */
static int32_t set_by_others(const mpmi_bound *bound, int64_t slot) {
  const mpmi_party *party = party_at(&bound->nodes->contact, slot);
  int32_t set = 0;
  if ((party && party->tied) || mpmi_surface_direction_at(bound, slot) >= 0) return ALL;
  for (int32_t face = 0; face < 2 * bound->dim; ++face)
    if (rubs(bound, slot, face)) return ALL;
  for (int32_t c = 0; c < bound->dim; ++c)
    if (mpmi_held_by(bound->nodes, slot, c)) set |= 1 << c;
  return set;
}

/* Finds anew what a node has to give, where it or one that leads it may touch something. The forces are a
 * part of its velocity by now. */
static void begin_again(mpmi_bound *bound, mpmi_light_node *node) {
  const mpmi_contact_nodes *contact = &bound->nodes->contact;
  const mpmi_leader *leader = leaders_of(bound, node);
  mpmi_party *party = party_at(contact, node->slot);
  int32_t touches = party != NULL;
  node->kept = set_by_others(bound, node->slot);
  for (int32_t k = 0; k < node->count; ++k) {
    touches |= party_at(contact, leader[k].slot) != NULL;
    node->kept |= set_by_others(bound, leader[k].slot);
  }
  node->acts = touches && (~node->kept & ((1 << bound->dim) - 1));
  if (!node->acts) return;
  if (party) party->stays = 1;
  for (int32_t k = 0; k < node->count; ++k)
    if ((party = party_at(contact, leader[k].slot))) party->leads = 1;
  for (int32_t c = 0; c < bound->dim; ++c) {
    double *v = mpmi_velocity(bound->values, node->slot);
    node->gain[c] = mpmi_increment_of(bound, node->slot, c);
    v[c] -= node->gain[c];
    node->before[c] = v[c];
  }
}

mpm_status mpmi_light_nodes_lead_again(mpmi_bound *bound) {
  const mpmi_nodes *nodes = bound->nodes;
  if (!nodes->light_count || !nodes->contact.touch_count) return MPM_OK;
  light_job job = {bound, mpmi_light_search_of(bound)};
  mark_tied(&nodes->contact);
  for (int64_t n = 0; n < nodes->light_count; ++n)
    if (nodes->light[n].count) begin_again(bound, &nodes->light[n]);
  const mpm_status status = lead(&job);
  return status ? status : mpmi_ties_hold_walls(bound);
}
