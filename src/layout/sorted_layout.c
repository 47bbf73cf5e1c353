#include "layout/sorted_layout.h"
#include "layout/axes.h"

#include <float.h>
#include <math.h>

mpm_status mpmi_layout_create(mpmi_layout *layout, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  mpmi_blocks_init(&layout->blocks, settings->grid);
  mpmi_blocks_init(&layout->next_blocks, settings->grid);
  mpmi_constraints_init(&layout->constraints, c);
  mpmi_constraints_init(&layout->next_constraints, c);
  layout->bound_memory =
      mpmi_alloc_zeroed(c, mpmi_bytes((settings->tasks + 1) * MPMI_WORKLISTS, sizeof(int64_t)));
  return layout->bound_memory ? MPM_OK : MPM_E_NOMEM;
}

void mpmi_layout_free(mpmi_layout *layout, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  mpmi_blocks_free(&layout->blocks);
  mpmi_blocks_free(&layout->next_blocks);
  mpmi_constraints_free(&layout->constraints);
  mpmi_constraints_free(&layout->next_constraints);
  mpmi_free(c, layout->list_memory, mpmi_bytes(layout->list_capacity, sizeof *layout->list_memory));
  mpmi_free(c, layout->bound_memory, mpmi_bytes((settings->tasks + 1) * MPMI_WORKLISTS, sizeof(int64_t)));
  mpmi_free(c, layout->member, mpmi_bytes(layout->member_capacity, sizeof *layout->member));
}

static void swap_constraints(mpmi_layout *layout) {
  const mpmi_constraints constraints = layout->constraints;
  layout->constraints = layout->next_constraints;
  layout->next_constraints = constraints;
  layout->walls_changed = 0;
  ++layout->version;
}

static void swap_in_next(mpmi_layout *layout) {
  const mpmi_blocks blocks = layout->blocks;
  layout->blocks = layout->next_blocks;
  layout->next_blocks = blocks;
  swap_constraints(layout);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpmi_arrangement arrangement = layout->member[m].now;
    layout->member[m].now = layout->member[m].next;
    layout->member[m].next = arrangement;
  }
}

mpm_status mpmi_layout_adopt(mpmi_layout *layout, const mpmi_settings *settings) {
  const int64_t blocks = layout->next_blocks.count;
  mpm_status status;
  if ((status = mpmi_constraints_build(&layout->next_constraints, &layout->next_blocks, settings->wall)) ||
      /* last, because the present worklists point into this memory; some of it without blocks, too */
      (status = mpmi_reserve_more(settings->context, (void **)&layout->list_memory, &layout->list_capacity,
                                  2 * blocks + 1, sizeof *layout->list_memory)))
    return status;
  mpmi_worklists_make(layout->worklist, settings, &layout->next_blocks, layout->member, layout->member_count,
                      layout->list_memory, layout->bound_memory);
  swap_in_next(layout);
  return MPM_OK;
}

static void find_largest_masses(mpmi_layout *layout) {
  for (int32_t m = 0; m < layout->member_count; ++m) {
    mpm_particles *set = layout->member[m].set;
    const double *mass = mpmi_f64(set, MPMI_MASS, 0);
    set->mass_max = 0.0;
    for (int64_t p = 0; p < set->slots; ++p)
      if (mass[p] > set->mass_max) set->mass_max = mass[p];
  }
}

/* Below this a node is too light to divide by its mass. Of the linear basis force stays where mass vanishes;
 * of the smooth ones it vanishes too, and a node in the corner of a cubic stencil weighs (d^3 / 6)^3.
 * Implicit steps do not divide: stiffness moves the lightest node. */
static void find_mass_cut(mpmi_layout *layout, const mpmi_settings *settings) {
  const int32_t divides = settings->grid->family == MPMI_FAMILY_BSPLINE1 && !mpmi_is_implicit(settings);
  const double share = divides ? 1e-12 : 1e-40;
  layout->mass_cut = DBL_MIN; /* the inverse of a lighter one may not be finite */
  for (int32_t m = 0; m < layout->member_count; ++m)
    if (share * layout->member[m].set->mass_max > layout->mass_cut)
      layout->mass_cut = share * layout->member[m].set->mass_max;
}

/* GIMP takes domains wider than a cell as one cell: the host should know how many there are. */
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

static mpm_status sort_anew(mpmi_layout *layout, const mpmi_settings *settings) {
  mpm_status status;
  mpmi_blocks_clear(&layout->next_blocks);
  for (int32_t m = 0; m < layout->member_count; ++m)
    if ((status = mpmi_sort_blocks(layout->member[m].set, &layout->next_blocks))) return status;
  if ((status = mpmi_blocks_order(&layout->next_blocks))) return status;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    mpmi_member *member = &layout->member[m];
    if ((status = mpmi_sort_plan(member->set, &layout->next_blocks, &member->sorting, &member->next)))
      return status;
  }
  if ((status = mpmi_layout_adopt(layout, settings))) return status;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    mpmi_member *member = &layout->member[m];
    mpmi_sort_apply(member->set, &layout->blocks, &member->sorting, &member->now);
  }
  find_largest_masses(layout);
  count_wide_domains(layout, settings);
  ++layout->sorts;
  return MPM_OK;
}

static mpm_status find_ties(mpmi_layout *layout, const mpmi_settings *settings) {
  const mpm_status status =
      mpmi_constraints_build(&layout->next_constraints, &layout->blocks, settings->wall);
  if (!status) swap_constraints(layout);
  return status;
}

mpm_status mpmi_layout_sort(mpmi_layout *layout, const mpmi_settings *settings) {
  int32_t moved = layout->blocks.count == 0;
  for (int32_t m = 0; m < layout->member_count; ++m)
    moved |= (layout->member[m].set->dirty & (MPMI_DIRTY_PLACE | MPMI_DIRTY_ORDER)) != 0;
  return moved ? sort_anew(layout, settings) : MPM_OK;
}

mpm_status mpmi_layout_prepare(mpmi_layout *layout, const mpmi_settings *settings) {
  const mpm_status status = mpmi_layout_sort(layout, settings);
  if (status) return status;
  find_mass_cut(layout, settings);
  return layout->walls_changed ? find_ties(layout, settings) : MPM_OK;
}
