#include "layout/sorted_layout.h"
#include "parallel/migration.h"
#include "particles/values.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Light nodes look at others and give to them (boundary/light_nodes.c): a leader is two steps away, and takes
 * from others as far away, whose own leaders count, and what lies beside these; and so on once more. Where
 * bodies touch there are two rounds after contact, too. */
static const int32_t light_margin = 9, touching_margin = 8;

/* Implicit steps look beyond the nodes of a part's own particles: an inner row has what its outer ones couple
 * with, four nodes away, and that again the inner ones that it moves with, found by the stiffness in reach
 * (implicit/extension.c). The remedy against locking may come later. */
static int32_t implicit_margin(const mpm_grid *grid) {
  const int32_t extends = 4, couples = grid->width - 1 + grid->centred;
  return 2 * extends + couples + grid->width - 1;
}

mpm_status mpmi_layout_create(mpmi_layout *layout, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  mpmi_blocks_init(&layout->blocks, settings->grid);
  mpmi_blocks_init(&layout->next_blocks, settings->grid);
  mpmi_constraints_init(&layout->constraints, c);
  mpmi_constraints_init(&layout->next_constraints, c);
  layout->bound_memory =
      mpmi_alloc_zeroed(c, mpmi_bytes((settings->tasks + 1) * MPMI_WORKLISTS, sizeof(int64_t)));
  if (!layout->bound_memory) return MPM_E_NOMEM;
  if (mpmi_is_whole(c)) return MPM_OK;
  const mpm_status status = mpmi_parts_create(c, settings->grid, &layout->parts);
  if (status) return status;
  mpmi_layout_widen(layout, mpmi_is_implicit(settings) ? MPMI_WIDE_FOR_IMPLICIT : 0);
  return MPM_OK;
}

void mpmi_layout_set_margins(mpmi_parts *parts, uint32_t wide_for) {
  const mpm_grid *grid = parts->grid;
  const int32_t touches = (wide_for & MPMI_WIDE_FOR_TOUCHES) != 0, implicit = implicit_margin(grid);
  parts->margin = parts->meeting_margin = 0;
  if (grid->family == MPMI_FAMILY_BSPLINE1) {
    parts->margin = light_margin + touches * touching_margin;
    parts->meeting_margin = touches * touching_margin;
  }
  parts->names_owners = (wide_for & MPMI_WIDE_FOR_IMPLICIT) != 0;
  if (parts->names_owners && parts->margin < implicit) parts->margin = implicit;
  if (wide_for & MPMI_WIDE_FOR_MARKERS) parts->margin += mpmi_marker_margin(grid);
}

void mpmi_layout_widen(mpmi_layout *layout, uint32_t wide_for) {
  layout->wide_for |= wide_for;
  for (int32_t m = 0; m < layout->member_count; ++m) layout->member[m].set->dirty |= MPMI_DIRTY_PLACE;
  if (layout->parts) mpmi_layout_set_margins(layout->parts, layout->wide_for);
}

void mpmi_layout_touches(mpmi_layout *layout, const mpmi_settings *settings) {
  if (settings->grid->family == MPMI_FAMILY_BSPLINE1 && !(layout->wide_for & MPMI_WIDE_FOR_TOUCHES))
    mpmi_layout_widen(layout, MPMI_WIDE_FOR_TOUCHES);
}

void mpmi_layout_free(mpmi_layout *layout, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  mpmi_blocks_free(&layout->blocks);
  mpmi_blocks_free(&layout->next_blocks);
  mpmi_constraints_free(&layout->constraints);
  mpmi_constraints_free(&layout->next_constraints);
  MPMI_FREE_ARRAY(c, layout->met, layout->met_capacity);
  MPMI_FREE_ARRAY(c, layout->groups.group, layout->groups.capacity);
  MPMI_FREE_ARRAY(c, layout->next_groups.group, layout->next_groups.capacity);
  MPMI_FREE_ARRAY(c, layout->list_memory, layout->list_capacity);
  MPMI_FREE_ARRAY(c, layout->next_list_memory, layout->next_list_capacity);
  mpmi_free(c, layout->bound_memory, mpmi_bytes((settings->tasks + 1) * MPMI_WORKLISTS, sizeof(int64_t)));
  MPMI_FREE_ARRAY(c, layout->member, layout->member_capacity);
  MPMI_FREE_ARRAY(c, layout->densities, layout->densities_capacity);
  if (layout->parts) mpmi_guests_free(layout->parts);
  mpmi_parts_destroy(layout->parts);
}

static void swap_constraints(mpmi_layout *layout) {
  const mpmi_constraints constraints = layout->constraints;
  layout->constraints = layout->next_constraints;
  layout->next_constraints = constraints;
  layout->walls_changed = 0;
  layout->cover_is_old = 1; /* and with it what is known of nodes that no stencil meets */
  ++layout->version;
}

static void swap_in_next(mpmi_layout *layout) {
  const mpmi_blocks blocks = layout->blocks;
  layout->blocks = layout->next_blocks;
  layout->next_blocks = blocks;
  const mpmi_block_groups groups = layout->groups;
  layout->groups = layout->next_groups;
  layout->next_groups = groups;
  swap_constraints(layout);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpmi_arrangement arrangement = layout->member[m].now;
    layout->member[m].now = layout->member[m].next;
    layout->member[m].next = arrangement;
  }
}

static int64_t slots_in_block(const mpmi_layout *layout, int64_t block) {
  int64_t slots = 0;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const int64_t *start = layout->member[m].next.start;
    slots += start[block + 1] - start[block];
  }
  return slots;
}

/* Cuts a list into contiguous ranges of about equal numbers of slots; results do not depend on where they
 * end. */
static void set_bounds(const mpmi_layout *layout, int32_t tasks, mpmi_worklist *list) {
  int64_t total = 0, so_far = 0;
  for (int64_t i = 0; i < list->count; ++i) total += slots_in_block(layout, list->block[i]);
  int32_t task = 0;
  list->bound[0] = 0;
  for (int64_t i = 0; i < list->count; ++i) {
    while (task + 1 < tasks && so_far * tasks >= total * (task + 1)) list->bound[++task] = i;
    so_far += slots_in_block(layout, list->block[i]);
  }
  while (task < tasks) list->bound[++task] = list->count;
}

/* Makes the worklists of next_blocks and the next arrangements. */
static void make_worklists(mpmi_layout *layout, const mpmi_settings *settings) {
  const mpmi_blocks *blocks = &layout->next_blocks;
  int32_t *memory = layout->list_memory;
  for (int32_t l = 0; l < MPMI_WORKLISTS; ++l) {
    mpmi_worklist *list = &layout->worklist[l];
    *list = (mpmi_worklist){memory, 0, layout->bound_memory + (settings->tasks + 1) * l};
    for (int64_t i = 0; i < blocks->count; ++i)
      if (slots_in_block(layout, i) > 0 &&
          (l == 0 || mpmi_colour_of(blocks->grid->dim, blocks->coord[i]) == l - 1))
        list->block[list->count++] = (int32_t)i;
    set_bounds(layout, settings->tasks, list);
    memory += list->count;
  }
}

/* Lists the places where several bodies have blocks, which stand side by side; returns how many there are,
 * and fills `group` unless it is NULL. */
static int64_t list_groups(const mpmi_blocks *b, mpmi_block_group *group) {
  int64_t groups = 0, count;
  for (int64_t first = 0; first < b->count; first += count) {
    for (count = 1; first + count < b->count && b->key[first + count] == b->key[first] &&
                    memcmp(b->coord[first + count], b->coord[first], sizeof *b->coord) == 0;)
      ++count;
    if (count < 2) continue;
    if (group) group[groups] = (mpmi_block_group){(int32_t)first, (int32_t)count};
    ++groups;
  }
  return groups;
}

mpm_status mpmi_layout_plan(mpmi_layout *layout, const mpmi_settings *settings) {
  const int64_t blocks = layout->next_blocks.count, groups = list_groups(&layout->next_blocks, NULL);
  mpmi_block_groups *next = &layout->next_groups;
  mpm_status status;
  if ((status = mpmi_constraints_build(&layout->next_constraints, &layout->next_blocks, settings->wall)) ||
      (status = MPMI_RESERVE_MORE(settings->context, next->group, next->capacity, groups)) ||
      /* + 1 so that it exists without blocks */
      (status = MPMI_RESERVE_MORE(settings->context, layout->next_list_memory, layout->next_list_capacity,
                                  2 * blocks + 1)))
    return status;
  next->count = list_groups(&layout->next_blocks, next->group);
  return MPM_OK;
}

void mpmi_layout_adopt(mpmi_layout *layout, const mpmi_settings *settings) {
  int32_t *memory = layout->list_memory;
  const int64_t capacity = layout->list_capacity;
  layout->list_memory = layout->next_list_memory;
  layout->list_capacity = layout->next_list_capacity;
  layout->next_list_memory = memory;
  layout->next_list_capacity = capacity;
  make_worklists(layout, settings);
  swap_in_next(layout);
}

/* Finds what densities bodies have: nodes are not light that have little mass for that of their particles. */
static mpm_status find_densities(mpmi_layout *layout, const mpmi_settings *settings) {
  int64_t bodies = 0;
  for (int32_t m = 0; m < layout->member_count; ++m)
    if (layout->member[m].body >= bodies) bodies = layout->member[m].body + 1;
  const mpm_status status =
      MPMI_RESERVE_MORE(settings->context, layout->densities, layout->densities_capacity, bodies);
  if (status) return status;
  for (int64_t body = 0; body < bodies; ++body) layout->densities[body] = (mpmi_densities){DBL_MAX, 0.0};
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_particles *set = layout->member[m].set;
    mpmi_densities *of = &layout->densities[layout->member[m].body];
    if (!(set->mass_max > 0.0)) continue;
    of->least = fmin(of->least, set->material->density);
    of->most = fmax(of->most, set->material->density);
  }
  return MPM_OK;
}

/* Returns the most that a node of a full body has, where particles are not pressed into half of their volume;
 * at least that of two of the heaviest along each axis, for masses that hosts set. */
static double full_mass(const mpmi_layout *layout, const mpmi_settings *settings, double heaviest) {
  double densest = 0.0, cell = 1.0;
  for (int32_t m = 0; m < layout->member_count; ++m)
    densest = fmax(densest, layout->member[m].set->material->density);
  for (int32_t k = 0; k < settings->grid->dim; ++k) cell *= settings->grid->desc.spacing[k];
  return fmax(2.0 * densest * cell, heaviest * (double)(1 << settings->grid->dim));
}

/* Finds the mass cut: a node that is lighter is not divided by its mass, and nothing holds it. The lightest
 * that a particle can make is that in the corner of a 3-D cell, 2^-180 of it on the linear basis. There force
 * over mass grows as mass vanishes, and steps that divide by it look among the nodes up to the light cut for
 * those that must go with others. */
static mpm_status find_mass_cut(mpmi_layout *layout, const mpmi_settings *settings) {
  double heaviest = 0.0;
  for (int32_t m = 0; m < layout->member_count; ++m)
    if (layout->member[m].set->count || layout->parts) /* the mass is that of all parts */
      heaviest = fmax(heaviest, layout->member[m].set->mass_max);
  layout->mass_cut = fmax(DBL_MIN, 1e-60 * heaviest); /* the inverse of a lighter one may not be finite */
  layout->light_cut = layout->mass_cut;
  if (settings->grid->family == MPMI_FAMILY_BSPLINE1 && !mpmi_is_implicit(settings))
    layout->light_cut = fmax(layout->mass_cut, MPMI_LIGHT_SHARE * full_mass(layout, settings, heaviest));
  return find_densities(layout, settings);
}

mpmi_points mpmi_points_of(const mpm_particles *set, int32_t copy) {
  const mpm_grid *grid = set->grid;
  mpmi_points points = {{NULL}, {NULL}, {NULL}};
  int32_t stored = 0;
  if (!set->ld) return points; /* nothing was ever added */
  for (int32_t k = 0; k < grid->dim; ++k) {
    points.x[k] = mpmi_places(set, copy) + k * set->ld;
    if (mpmi_has_domains(grid)) points.size[k] = mpmi_f64(set, MPMI_SIZE, 0) + k * set->ld;
    while (mpmi_tensor_map(grid->dim)[stored] != 4 * k) ++stored;
    if (grid->domains == MPMI_DOMAINS_STRETCHED && !mpmi_is_total_lagrangian(grid))
      points.stretch[k] = mpmi_f64(set, MPMI_F, copy) + stored * set->ld;
  }
  return points;
}

/* Counts the domains that are wider than a cell, which GIMP takes as one cell, and tells the host. */
static void count_wide_domains(mpmi_layout *layout, const mpmi_settings *settings) {
  const mpm_grid *grid = settings->grid;
  if (!mpmi_has_domains(grid)) return;
  int64_t wide = 0, live = 0;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_particles *set = layout->member[m].set;
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
  if (wide != layout->wide_domains)
    mpmi_log(settings->context, MPM_LOG_INFO,
             "stepper: %lld of %lld particles have domains wider than a cell, which GIMP takes as one cell",
             (long long)wide, (long long)live);
  layout->wide_domains = wide;
}

/* Inserts the blocks with particles. */
static mpm_status insert_blocks(void *user) {
  mpmi_layout *layout = user;
  mpm_status status = MPM_OK;
  mpmi_blocks_clear(&layout->next_blocks);
  for (int32_t m = 0; m < layout->member_count && !status; ++m)
    status = mpmi_sort_blocks(layout->member[m].set, layout->member[m].body, &layout->next_blocks);
  return status;
}

static mpm_status sort_anew(mpmi_layout *layout, const mpmi_settings *settings, mpmi_moving_set *moving) {
  mpm_status status = insert_blocks(layout);
  if (layout->parts)
    status = mpmi_share_out(layout->parts, &layout->next_blocks, moving, layout->member_count,
                            moving ? status : (mpm_status)MPM_E_NOMEM, insert_blocks, layout);
  if (status || (status = mpmi_blocks_order(&layout->next_blocks))) return status;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    mpmi_member *member = &layout->member[m];
    if ((status = mpmi_sort_plan(member->set, &layout->next_blocks, &member->sorting, &member->next)))
      return status;
  }
  if ((status = mpmi_layout_plan(layout, settings))) return status;
  mpmi_layout_adopt(layout, settings);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    mpmi_member *member = &layout->member[m];
    mpmi_sort_apply(member->set, &layout->blocks, &member->sorting, &member->now);
  }
  for (int32_t m = 0; m < layout->member_count; ++m) mpmi_find_masses(layout->member[m].set);
  count_wide_domains(layout, settings);
  ++layout->sorts;
  return MPM_OK;
}

/* Sorts with the other parts. */
static mpm_status sort_together(mpmi_layout *layout, const mpmi_settings *settings) {
  const int32_t count = layout->member_count;
  const size_t bytes = mpmi_bytes(count + 1, sizeof(mpmi_moving_set));
  const int64_t sorts = layout->sorts;
  mpmi_moving_set *moving = mpmi_alloc(settings->context, bytes);
  for (int32_t m = 0; m < count && moving; ++m)
    moving[m] = (mpmi_moving_set){
        .set = layout->member[m].set, .body = layout->member[m].body, .sorting = &layout->member[m].sorting};
  mpm_status status = sort_anew(layout, settings, moving);
  status = mpmi_share_end(layout->parts, &layout->blocks, moving, count, status);
  if (status) layout->sorts = sorts; /* it counts where it has come to its end on all parts */
  mpmi_free(settings->context, moving, bytes);
  return status;
}

static mpm_status find_ties(mpmi_layout *layout, const mpmi_settings *settings) {
  const mpm_status status =
      mpmi_constraints_build(&layout->next_constraints, &layout->blocks, settings->wall);
  if (!status) swap_constraints(layout);
  return status;
}

mpm_status mpmi_layout_exchange_guests(const mpmi_layout *layout, mpm_context *context, int32_t copy) {
  const size_t bytes = mpmi_bytes(layout->member_count, sizeof(mpmi_host_set));
  mpmi_host_set *sets = mpmi_alloc(context, bytes);
  for (int32_t m = 0; m < layout->member_count && sets; ++m)
    sets[m] = (mpmi_host_set){layout->member[m].set, &layout->member[m].now};
  mpm_status status = mpmi_agree(context, sets ? MPM_OK : MPM_E_NOMEM);
  if (!status) status = mpmi_guests_exchange(layout->parts, sets, layout->member_count, copy);
  mpmi_free(context, sets, bytes);
  return status;
}

int32_t mpmi_layout_is_moved(const mpmi_layout *layout) {
  int32_t moved = layout->parts ? layout->parts->is_stale : layout->blocks.count == 0;
  for (int32_t m = 0; m < layout->member_count; ++m)
    moved |= (layout->member[m].set->dirty & (MPMI_DIRTY_PLACE | MPMI_DIRTY_ORDER)) != 0;
  return moved;
}

mpm_status mpmi_layout_sort(mpmi_layout *layout, const mpmi_settings *settings) {
  if (!mpmi_layout_is_moved(layout)) return MPM_OK;
  return layout->parts ? sort_together(layout, settings) : sort_anew(layout, settings, NULL);
}

mpm_status mpmi_layout_prepare(mpmi_layout *layout, const mpmi_settings *settings) {
  mpm_status status = mpmi_layout_sort(layout, settings);
  if (status) return status;
  status = find_mass_cut(layout, settings);
  if (!status && layout->walls_changed) status = find_ties(layout, settings);
  if (status || !layout->parts) return status;
  return mpmi_share_nodes(layout->parts, &layout->blocks, &layout->constraints, layout->version);
}
