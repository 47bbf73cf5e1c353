/* Everything that depends on where the particles are: blocks, order of the slots, constrained nodes, cut of
 * the work. */
#include "stepper/stepper.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Room for half as much again: bodies spread, and a step in steady state must not allocate. */
static int64_t roomy(int64_t wanted, int64_t capacity) {
  return wanted > capacity ? wanted + wanted / 4 : 0;
}

mpm_status mpmi_reserve_roomy(mpm_context *context, void **at, int64_t *capacity, int64_t wanted,
                              size_t size) {
  return mpmi_reserve(context, at, capacity, roomy(wanted, *capacity), size);
}

static int64_t slots_in_block(const mpm_stepper *s, int32_t next, int64_t block) {
  int64_t slots = 0;
  for (int32_t m = 0; m < s->member_count; ++m) {
    const int64_t *start = next ? s->member[m].next.start : s->member[m].now.start;
    slots += start[block + 1] - start[block];
  }
  return slots;
}

static int32_t colour_of(const mpm_grid *grid, const int32_t *coord) {
  int32_t colour = 0;
  for (int32_t k = 0; k < grid->dim; ++k) colour = 2 * colour + (coord[k] & 1);
  return colour;
}

/* Contiguous ranges of about equal numbers of slots. Results do not depend on where the cuts are. */
static void set_bounds(const mpm_stepper *s, mpmi_cut *cut) {
  int64_t total = 0, so_far = 0;
  for (int64_t i = 0; i < cut->count; ++i) total += slots_in_block(s, 1, cut->list[i]);
  int32_t task = 0;
  cut->bound[0] = 0;
  for (int64_t i = 0; i < cut->count; ++i) {
    while (task + 1 < s->tasks && so_far * s->tasks >= total * (task + 1)) cut->bound[++task] = i;
    so_far += slots_in_block(s, 1, cut->list[i]);
  }
  while (task < s->tasks) cut->bound[++task] = cut->count;
}

static void cut_work(mpm_stepper *s) {
  const mpmi_blocks *b = &s->next_blocks;
  int32_t *at = s->list_memory;
  int64_t *bound = s->bound_memory;
  for (int32_t c = -1; c < MPMI_COLOURS; ++c) {
    mpmi_cut *cut = c < 0 ? &s->cut : &s->colour[c];
    *cut = (mpmi_cut){at, 0, bound};
    for (int64_t i = 0; i < b->count; ++i)
      if (slots_in_block(s, 1, i) > 0 && (c < 0 || colour_of(s->grid, b->coord[i]) == c))
        cut->list[cut->count++] = (int32_t)i;
    set_bounds(s, cut);
    at += cut->count;
    bound += s->tasks + 1;
  }
}

static void swap_in_next(mpm_stepper *s) {
  const mpmi_blocks blocks = s->blocks;
  s->blocks = s->next_blocks;
  s->next_blocks = blocks;
  const mpmi_constraints constraints = s->constraints;
  s->constraints = s->next_constraints;
  s->next_constraints = constraints;
  for (int32_t m = 0; m < s->member_count; ++m) {
    const mpmi_arrangement arrangement = s->member[m].now;
    s->member[m].now = s->member[m].next;
    s->member[m].next = arrangement;
  }
}

static mpm_status reserve_ties(mpm_stepper *s, const mpmi_constraints *constraints) {
  return mpmi_reserve(s->context, (void **)&s->tie_state, &s->tie_state_capacity,
                      roomy(MPMI_TIE_STATE * constraints->tie_count, s->tie_state_capacity),
                      sizeof *s->tie_state);
}

mpm_status mpmi_stepper_adopt(mpm_stepper *s) {
  const int64_t blocks = s->next_blocks.count;
  mpm_status status;
  if ((status = mpmi_reserve(s->context, (void **)&s->block_sums, &s->block_sums_capacity,
                             roomy(blocks, s->block_sums_capacity), sizeof *s->block_sums)) ||
      (status = mpmi_constraints_build(&s->next_constraints, &s->next_blocks, s->wall)) ||
      (status = reserve_ties(s, &s->next_constraints)) ||
      /* last, because the present cuts point into this memory; some of it without blocks, too */
      (status = mpmi_reserve(s->context, (void **)&s->list_memory, &s->list_capacity,
                             roomy(2 * blocks + 1, s->list_capacity), sizeof *s->list_memory)))
    return status;
  cut_work(s);
  swap_in_next(s);
  ++s->topology;
  s->walls_changed = 0;
  s->nodes_valid = 0;
  return MPM_OK;
}

static void find_largest_masses(mpm_stepper *s) {
  for (int32_t m = 0; m < s->member_count; ++m) {
    mpm_particles *set = s->member[m].set;
    const double *mass = mpmi_f64(set, MPMI_MASS, 0);
    set->mass_max = 0.0;
    for (int64_t p = 0; p < set->slots; ++p)
      if (mass[p] > set->mass_max) set->mass_max = mass[p];
  }
}

/* Below this a node is too light to divide by its mass. Of the linear basis force stays where mass vanishes;
 * of the smooth ones it vanishes too, and a node in the corner of a cubic stencil weighs (d^3 / 6)^3.
 * Implicit steps do not divide: stiffness moves the lightest node. */
static void find_mass_cut(mpm_stepper *s) {
  const double share = s->grid->family == MPMI_FAMILY_BSPLINE1 && !mpmi_is_implicit(s) ? 1e-12 : 1e-40;
  s->mass_cut = DBL_MIN; /* of what is lighter, the inverse may not be finite */
  for (int32_t m = 0; m < s->member_count; ++m)
    if (share * s->member[m].set->mass_max > s->mass_cut) s->mass_cut = share * s->member[m].set->mass_max;
}

/* GIMP takes domains wider than a cell as one cell: the host should know how many there are. */
static void count_wide_domains(mpm_stepper *s) {
  const mpm_grid *grid = s->grid;
  if (!mpmi_has_domains(grid)) return;
  int64_t wide = 0, live = 0;
  for (int32_t m = 0; m < s->member_count; ++m) {
    const mpm_particles *set = s->member[m].set;
    const mpmi_points points = mpmi_points_of(set, 0);
    const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
    live += set->count;
    for (int64_t p = 0; p < set->slots; ++p) {
      int32_t over = 0;
      for (int32_t k = 0; k < grid->dim; ++k) {
        const double stretch = points.stretch[k] ? fabs(points.stretch[k][p]) : 1.0;
        over |= points.size[k][p] * stretch > grid->desc.spacing[k] * (1.0 + 1e-12);
      }
      wide += over && id[p] >= 0;
    }
  }
  if (wide != s->wide_domains)
    mpmi_log(s->context, MPM_LOG_INFO,
             "stepper: %lld of %lld particles have domains wider than a cell, which GIMP takes as one cell",
             (long long)wide, (long long)live);
  s->wide_domains = wide;
}

static mpm_status sort_anew(mpm_stepper *s) {
  mpm_status status;
  mpmi_blocks_clear(&s->next_blocks);
  for (int32_t m = 0; m < s->member_count; ++m)
    if ((status = mpmi_sort_blocks(s->member[m].set, &s->next_blocks))) return status;
  if ((status = mpmi_blocks_order(&s->next_blocks))) return status;
  for (int32_t m = 0; m < s->member_count; ++m)
    if ((status =
             mpmi_sort_plan(s->member[m].set, &s->next_blocks, &s->member[m].sorting, &s->member[m].next)))
      return status;
  if ((status = mpmi_stepper_adopt(s))) return status;
  for (int32_t m = 0; m < s->member_count; ++m)
    mpmi_sort_apply(s->member[m].set, &s->blocks, &s->member[m].sorting, &s->member[m].now);
  find_largest_masses(s);
  count_wide_domains(s);
  ++s->resorts;
  return MPM_OK;
}

static mpm_status rebuild_constraints(mpm_stepper *s) {
  mpm_status status;
  if ((status = mpmi_constraints_build(&s->next_constraints, &s->blocks, s->wall)) ||
      (status = reserve_ties(s, &s->next_constraints)))
    return status;
  const mpmi_constraints constraints = s->constraints;
  s->constraints = s->next_constraints;
  s->next_constraints = constraints;
  s->walls_changed = 0;
  ++s->topology;
  return MPM_OK;
}

mpm_status mpmi_usable(mpm_particles *set) {
  return mpmi_particles_check_suspects(set) ? MPM_E_STATE : MPM_OK;
}

/* Fields that the scheme carries, brought up to date and free of bad values. */
static mpm_status prepare_sets(mpm_stepper *s) {
  for (int32_t m = 0; m < s->member_count; ++m) {
    mpm_particles *set = s->member[m].set;
    mpm_status status;
    if (set->mapped)
      return mpmi_fail(s->context, MPM_E_STATE, "set %d has %d mapped views: release them before stepping",
                       (int)m, (int)set->mapped);
    if ((status = mpmi_particles_check_suspects(set)) || (status = mpmi_particles_refresh(set)))
      return status;
    if (mpmi_is_affine(s) && !set->field[MPMI_L].present && (status = mpmi_field_make_present(set, MPMI_L)))
      return status;
  }
  return MPM_OK;
}

/* v, dv and C of a batch. */
enum { GATHERED_ROWS = 3 + 3 + 9 };

static size_t tile_bytes(const mpm_stepper *s) {
  const size_t bytes = 8 * sizeof(double) * (size_t)mpmi_tile_nodes(s->grid);
  return (bytes + MPMI_ALIGNMENT - 1) / MPMI_ALIGNMENT * MPMI_ALIGNMENT;
}

static mpm_status prepare_scratch(mpm_stepper *s) {
  size_t batch = 0, length = 0;
  for (int32_t m = 0; m < s->member_count; ++m) {
    const mpm_material *material = s->member[m].set->material;
    const size_t bytes = mpmi_law_batch_bytes(material), rows = (size_t)mpmi_law_batch_length(material);
    batch = bytes > batch ? bytes : batch;
    length = rows > length ? rows : length;
  }
  const size_t gathered = GATHERED_ROWS * length * sizeof(double), tile = tile_bytes(s);
  const size_t cells = s->desc.locking_remedy ? tile : 0;
  const size_t bytes = (tile + cells + gathered + batch) * (size_t)s->tasks;
  if (bytes > s->scratch_bytes) {
    char *memory = mpmi_alloc(s->context, bytes);
    if (!memory) return MPM_E_NOMEM;
    mpmi_free(s->context, s->scratch_memory, s->scratch_bytes);
    s->scratch_memory = memory;
    s->scratch_bytes = bytes;
  }
  for (int32_t k = 0; k < s->tasks; ++k) {
    char *at = (char *)s->scratch_memory + (size_t)k * (tile + cells + gathered + batch);
    s->scratch[k].cells = (double *)(void *)at;
    s->scratch[k].cells_bytes = cells;
    at += cells;
    s->scratch[k].tile = (double *)(void *)at;
    s->scratch[k].gathered = (double *)(void *)(at + tile);
    s->scratch[k].batch_memory = at + tile + gathered;
  }
  return MPM_OK;
}

/* Can a wall, or the host, give nodes an impulse that has to be remembered? */
static int32_t gives_impulses(const mpm_stepper *s) {
  return s->holds || s->constraints.tie_count || s->constraints.contact_count;
}

static mpm_status prepare_nodes(mpm_stepper *s) {
  const int64_t slots = s->blocks.count * s->blocks.nodes;
  mpm_status status;
  s->values = mpmi_is_mls(s) && !s->staged && !mpmi_has_hooks(s) && s->desc.position_order == 1 ? 4 : 8;
  if ((status = mpmi_reserve(s->context, (void **)&s->node, &s->node_capacity,
                             roomy(slots * s->values, s->node_capacity), sizeof *s->node)))
    return status;
  if ((s->desc.scheme == MPM_MUSL || mpmi_deforms_first(s) || mpmi_corrects(s)) &&
      (status = mpmi_reserve(s->context, (void **)&s->again, &s->again_capacity,
                             roomy(slots * 4, s->again_capacity), sizeof *s->again)))
    return status;
  if ((mpmi_corrects(s) || s->desc.locking_remedy) &&
      (status = mpmi_reserve(s->context, (void **)&s->extra, &s->extra_capacity,
                             roomy(slots * 4, s->extra_capacity), sizeof *s->extra)))
    return status;
  s->impulses = gives_impulses(s);
  if (s->impulses && (status = mpmi_reserve(s->context, (void **)&s->impulse, &s->impulse_capacity,
                                            roomy(slots * 6, s->impulse_capacity), sizeof *s->impulse)))
    return status;
  if (s->holds && slots * 3 > s->held_capacity) {
    const int64_t wanted = roomy(slots * 3, 0);
    uint8_t *held = mpmi_alloc(s->context, (size_t)wanted);
    double *value = held ? mpmi_alloc(s->context, mpmi_bytes(wanted, sizeof *value)) : NULL;
    if (!value) {
      mpmi_free(s->context, held, (size_t)wanted);
      return MPM_E_NOMEM;
    }
    mpmi_free(s->context, s->held, (size_t)s->held_capacity);
    mpmi_free(s->context, s->held_value, mpmi_bytes(s->held_capacity, sizeof *value));
    s->held = held;
    s->held_value = value;
    s->held_capacity = wanted;
  }
  return MPM_OK;
}

static mpm_status prepare_forces(mpm_stepper *s) {
  for (int32_t m = 0; m < s->member_count; ++m) {
    mpmi_member *member = &s->member[m];
    const int32_t wanted = s->acceleration || s->force || member->set->field[MPMI_APPLIED_FORCE].present;
    if (wanted && member->force && member->force_ld == member->set->ld) continue;
    double *force = NULL;
    if (wanted &&
        !(force = mpmi_alloc(s->context, mpmi_bytes(member->set->ld * s->grid->dim, sizeof *force))))
      return MPM_E_NOMEM;
    mpmi_free(s->context, member->force, mpmi_bytes(member->force_ld * s->grid->dim, sizeof *force));
    member->force = force;
    member->force_ld = wanted ? member->set->ld : 0;
  }
  return MPM_OK;
}

mpm_status mpmi_stepper_sort(mpm_stepper *s) {
  int32_t moved = s->blocks.count == 0;
  for (int32_t m = 0; m < s->member_count; ++m)
    moved |= (s->member[m].set->dirty & (MPMI_DIRTY_PLACE | MPMI_DIRTY_ORDER)) != 0;
  return moved ? sort_anew(s) : MPM_OK;
}

mpm_status mpmi_stepper_prepare(mpm_stepper *s) {
  mpm_status status;
  if ((status = prepare_sets(s)) || (status = mpmi_stepper_sort(s))) return status;
  find_mass_cut(s);
  if (s->walls_changed && (status = rebuild_constraints(s))) return status;
  if ((status = mpmi_boundary_prepare(s)) || (status = prepare_scratch(s)) || (status = prepare_nodes(s)) ||
      (status = prepare_forces(s)))
    return status;
  return MPM_OK;
}

void mpmi_stepper_free_topology(mpm_stepper *s) {
  mpm_context *c = s->context;
  mpmi_blocks_free(&s->blocks);
  mpmi_blocks_free(&s->next_blocks);
  mpmi_constraints_free(&s->constraints);
  mpmi_constraints_free(&s->next_constraints);
  mpmi_boundary_free(s);
  mpmi_free(c, s->list_memory, mpmi_bytes(s->list_capacity, sizeof *s->list_memory));
  mpmi_free(c, s->block_sums, mpmi_bytes(s->block_sums_capacity, sizeof *s->block_sums));
  mpmi_free(c, s->tie_state, mpmi_bytes(s->tie_state_capacity, sizeof *s->tie_state));
  mpmi_free(c, s->scratch_memory, s->scratch_bytes);
  mpmi_free(c, s->node, mpmi_bytes(s->node_capacity, sizeof *s->node));
  mpmi_free(c, s->again, mpmi_bytes(s->again_capacity, sizeof *s->again));
  mpmi_free(c, s->extra, mpmi_bytes(s->extra_capacity, sizeof *s->extra));
  mpmi_free(c, s->impulse, mpmi_bytes(s->impulse_capacity, sizeof *s->impulse));
  mpmi_free(c, s->held, (size_t)s->held_capacity);
  mpmi_free(c, s->held_value, mpmi_bytes(s->held_capacity, sizeof *s->held_value));
}
