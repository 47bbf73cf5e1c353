/* Making, configuring and taking apart steppers. */
#include "particles/values.h"
#include "stepper/newton.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const mpm_stepper_desc defaults = {.struct_size = sizeof(mpm_stepper_desc),
                                          .scheme = MPM_USL,
                                          .transfer = MPM_FLIP,
                                          .xpic_order = 2,
                                          .position_order = 1,
                                          .flip = 1.0,
                                          .newmark_beta = 0.25,
                                          .newmark_gamma = 0.5,
                                          .newton_tolerance_displacement = 1e-8,
                                          .newton_tolerance_energy = 1e-14,
                                          .newton_tolerance_residual = 1e-8,
                                          .newton_max_iterations = 20,
                                          .linear_solver = MPM_SOLVER_AUTO};

mpm_status mpm_stepper_desc_init(mpm_stepper_desc *desc, uint32_t struct_size) {
  return mpmi_init_struct("mpm_stepper_desc", &defaults, sizeof defaults, desc, struct_size);
}

static mpm_status known_scheme(mpm_context *c, int32_t scheme) {
  switch (scheme) {
  case MPM_USL:
  case MPM_USF:
  case MPM_MUSL:
  case MPM_NEWMARK:
    return MPM_OK;
  default:
    return mpmi_fail(c, MPM_E_ARG, "scheme is %d: it must be an MPM_USL ... MPM_NEWMARK", (int)scheme);
  }
}

static mpm_status known_transfer(mpm_context *c, const mpm_grid *grid, const mpm_stepper_desc *d) {
  if (d->transfer < MPM_FLIP || d->transfer > MPM_APIC_MLS)
    return mpmi_fail(c, MPM_E_ARG, "transfer is %d: it must be an MPM_FLIP ... MPM_APIC_MLS",
                     (int)d->transfer);
  if (d->transfer == MPM_APIC_MLS && !(grid->moment > 0.0))
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "transfer MPM_APIC_MLS needs a quadratic or cubic B-spline with ghost or periodic "
                     "boundaries: use MPM_APIC with this grid");
  if (d->transfer == MPM_XPIC && (d->xpic_order < 1 || d->xpic_order > 5))
    return mpmi_fail(c, MPM_E_ARG, "xpic_order is %d: it must be 1 ... 5", (int)d->xpic_order);
  return MPM_OK;
}

/* Options beside scheme, transfer and forces. */
static mpm_status known_options(mpm_context *c, const mpm_grid *grid, const mpm_stepper_desc *d) {
  if (d->quasi_static != 0 && d->quasi_static != 1)
    return mpmi_fail(c, MPM_E_ARG, "quasi_static is %d: it must be 0 or 1", (int)d->quasi_static);
  if (d->quasi_static && d->scheme != MPM_NEWMARK)
    return mpmi_fail(c, MPM_E_UNSUPPORTED, "quasi_static = 1 needs implicit steps: use scheme MPM_NEWMARK");
  if (!isfinite(d->pic_damping) || d->pic_damping < 0.0)
    return mpmi_fail(c, MPM_E_ARG, "pic_damping is %g: it must be finite and >= 0", d->pic_damping);
  if (d->position_order != 1 && d->position_order != 2)
    return mpmi_fail(c, MPM_E_ARG, "position_order is %d: it must be 1 or 2", (int)d->position_order);
  if (d->staggered != 0 && d->staggered != 1)
    return mpmi_fail(c, MPM_E_ARG, "staggered is %d: it must be 0 or 1", (int)d->staggered);
  if (d->locking_remedy != MPM_LOCKING_NONE && d->locking_remedy != MPM_LOCKING_CELL_AVERAGE)
    return mpmi_fail(c, MPM_E_ARG, "locking_remedy is %d: it must be 0 or 1", (int)d->locking_remedy);
  if (d->locking_remedy && grid->dim == 1)
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "locking_remedy has no meaning in 1-D, where dilation is all there is: use "
                     "MPM_LOCKING_NONE");
  if (d->staggered && d->position_order == 2)
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "staggered steps are of second order with position_order = 1: use that");
  return MPM_OK;
}

/* Options of implicit steps, and what they do not go with. */
static mpm_status known_implicit(mpm_context *c, const mpm_stepper_desc *d) {
  const struct {
    const char *name;
    double value, low, high;
  } bound[] = {{"newmark_beta", d->newmark_beta, 1e-6, 1.0},
               {"newmark_gamma", d->newmark_gamma, 0.0, 1.0},
               {"newton_tolerance_displacement", d->newton_tolerance_displacement, 0.0, 1.0},
               {"newton_tolerance_energy", d->newton_tolerance_energy, 0.0, 1.0},
               {"newton_tolerance_residual", d->newton_tolerance_residual, 0.0, 1.0},
               {"newton_residual_floor", d->newton_residual_floor, 0.0, DBL_MAX},
               {"linear_tolerance", d->linear_tolerance, 0.0, 1.0}};
  for (size_t i = 0; i < sizeof bound / sizeof *bound; ++i)
    if (!(bound[i].value >= bound[i].low && bound[i].value <= bound[i].high))
      return mpmi_fail(c, MPM_E_ARG, "%s is %g: it must lie in [%g, %g]", bound[i].name, bound[i].value,
                       bound[i].low, bound[i].high);
  if (d->newton_max_iterations < 1 || d->newton_max_iterations > 10000)
    return mpmi_fail(c, MPM_E_ARG, "newton_max_iterations is %d: it must be 1 ... 10000",
                     (int)d->newton_max_iterations);
  if (d->linear_max_iterations < 0)
    return mpmi_fail(c, MPM_E_ARG, "linear_max_iterations is %d: it must be >= 0",
                     (int)d->linear_max_iterations);
  if ((d->linear_solver < MPM_SOLVER_AUTO || d->linear_solver > MPM_SOLVER_GMRES) &&
      d->linear_solver != MPM_SOLVER_HOST)
    return mpmi_fail(c, MPM_E_ARG, "linear_solver is %d: it must be an MPM_SOLVER_AUTO ... MPM_SOLVER_HOST",
                     (int)d->linear_solver);
  if (d->scheme != MPM_NEWMARK) return MPM_OK;
  if (d->transfer != MPM_FLIP || d->flip != 1.0 || d->pic_damping != 0.0)
    return mpmi_fail(
        c, MPM_E_UNSUPPORTED,
        "scheme MPM_NEWMARK has its own update of particles: use transfer MPM_FLIP with flip = 1 "
        "and pic_damping = 0; newmark_gamma above 1/2 damps");
  if (d->staggered)
    return mpmi_fail(c, MPM_E_UNSUPPORTED, "scheme MPM_NEWMARK has velocities at t_n: use staggered = 0");
  return MPM_OK;
}

static mpm_status read_desc(mpm_context *c, const mpm_grid *grid, const mpm_stepper_desc *desc,
                            mpm_stepper_desc *out) {
  *out = defaults;
  mpm_status status = desc ? mpmi_read_struct(c, "mpm_stepper_desc", desc, sizeof *out, out) : MPM_OK;
  if (status || (status = known_scheme(c, out->scheme)) || (status = known_transfer(c, grid, out)) ||
      (status = known_options(c, grid, out)) || (status = known_implicit(c, out)))
    return status;
  if (!(out->flip >= 0.0 && out->flip <= 1.0))
    return mpmi_fail(c, MPM_E_ARG, "flip is %g: it must lie in [0, 1]", out->flip);
  for (int32_t k = 0; k < grid->dim; ++k)
    if (!isfinite(out->gravity[k]))
      return mpmi_fail(c, MPM_E_ARG, "gravity[%d] is %g: it must be finite", (int)k, out->gravity[k]);
  for (int32_t k = grid->dim; k < 3; ++k) out->gravity[k] = 0.0;
  if (out->boundary_zero_acceleration != 0 && out->boundary_zero_acceleration != 1)
    return mpmi_fail(c, MPM_E_ARG, "boundary_zero_acceleration is %d: it must be 0 or 1",
                     (int)out->boundary_zero_acceleration);
  if (out->reserved) return mpmi_fail(c, MPM_E_ARG, "reserved is %d: it must be 0", (int)out->reserved);
  if (out->reference_positions != 0 && out->reference_positions != 1)
    return mpmi_fail(c, MPM_E_ARG, "reference_positions is %d: it must be 0 or 1",
                     (int)out->reference_positions);
  return MPM_OK;
}

mpm_status mpm_stepper_create(mpm_context *context, mpm_grid *grid, const mpm_stepper_desc *desc,
                              mpm_stepper **out) {
  if (out) *out = NULL;
  if (!context || context->magic != (uint32_t)MPMI_CONTEXT) return MPM_E_ARG;
  context->error[0] = '\0';
  if (!out) return mpmi_fail(context, MPM_E_ARG, "out is NULL");
  if (!grid || grid->magic != (uint32_t)MPMI_GRID || grid->context != context)
    return mpmi_fail(context, MPM_E_ARG, "grid is NULL, destroyed or of another context");
  mpm_stepper_desc d;
  mpm_status status = read_desc(context, grid, desc, &d);
  if (status) return status;
  mpm_stepper *s = mpmi_alloc_zeroed(context, sizeof *s);
  if (!s) return MPM_E_NOMEM;
  s->context = context;
  s->grid = grid;
  s->desc = d;
  s->kernels = mpmi_kernels_of(context->isa);
  s->tasks = context->concurrency;
  s->last.set = -1;
  s->last.particle = s->last.node = -1;
  mpmi_failure_clear(&s->failure);
  mpmi_blocks_init(&s->blocks, grid);
  mpmi_blocks_init(&s->next_blocks, grid);
  mpmi_constraints_init(&s->constraints, context);
  mpmi_constraints_init(&s->next_constraints, context);
  s->scratch = mpmi_alloc_zeroed(context, mpmi_bytes(s->tasks, sizeof *s->scratch));
  if (s->scratch)
    s->bound_memory =
        mpmi_alloc_zeroed(context, mpmi_bytes((s->tasks + 1) * (MPMI_COLOURS + 1), sizeof(int64_t)));
  if (!s->bound_memory) {
    mpmi_free(context, s->scratch, mpmi_bytes(s->tasks, sizeof *s->scratch));
    mpmi_free(context, s, sizeof *s);
    return MPM_E_NOMEM;
  }
  s->magic = MPMI_STEPPER;
  ++context->children;
  ++grid->children;
  *out = s;
  return MPM_OK;
}

double mpmi_flip_share(const mpm_stepper *s) {
  if (!mpmi_is_blend(s)) return 0.0;
  const double kept = 1.0 - s->desc.pic_damping * s->velocity_dt; /* MPoint theory eq. 59 */
  return kept > 0.0 ? s->desc.flip * kept : 0.0;
}

mpm_status mpmi_stepper_idle(mpm_stepper *s) {
  if (s->phase != MPMI_IDLE)
    return mpmi_fail(s->context, MPM_E_STATE, "a step is under way: end or abort it first");
  return MPM_OK;
}

/* Fields that exist as long as a stepper keeps them. */
static mpm_status keep_fields(mpm_particles *set, const mpm_stepper_desc *d) {
  mpm_status status = MPM_OK;
  if (d->reference_positions) status = mpmi_field_make_present(set, MPMI_REFERENCE);
  if (!status && d->scheme == MPM_NEWMARK) status = mpmi_field_make_present(set, MPMI_ACCELERATION);
  if (!status && d->locking_remedy) status = mpmi_field_make_present(set, MPMI_DILATION_RATIO);
  if (status && !set->stepper) mpmi_field_make_absent(set, MPMI_REFERENCE);
  return status;
}

/* Drops those that d does not ask for, all of them when it is NULL. */
static void drop_fields(mpm_particles *set, const mpm_stepper_desc *d) {
  if (!d || !d->reference_positions) mpmi_field_make_absent(set, MPMI_REFERENCE);
  if ((d && d->locking_remedy) || !set->field[MPMI_DILATION_RATIO].present) return;
  mpmi_field_make_absent(set, MPMI_DILATION_RATIO);
  mpmi_field_written(set, MPMI_F); /* the law sees F as it is again */
}

static void forget_member(mpm_stepper *s, int32_t m) {
  mpmi_member *member = &s->member[m];
  mpmi_arrangement_free(&member->now);
  mpmi_arrangement_free(&member->next);
  mpmi_sorting_free(&member->sorting, s->context);
  mpmi_free(s->context, member->force, mpmi_bytes(member->force_ld * s->grid->dim, sizeof *member->force));
  drop_fields(member->set, NULL);
  mpmi_prescribed_forget(s, member);
  member->set->stepper = NULL;
  member->set->dirty |= MPMI_DIRTY_PLACE;
  for (int32_t i = m + 1; i < s->member_count; ++i) s->member[i - 1] = s->member[i];
  --s->member_count;
  s->energies.valid = 0;
}

mpm_status mpm_stepper_destroy(mpm_stepper *s) {
  if (!s) return MPM_OK;
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE, "%d views of nodal fields are out: release them first",
                     (int)s->mapped);
  for (int32_t m = 0; m < s->member_count; ++m)
    if (s->member[m].set->mapped)
      return mpmi_fail(s->context, MPM_E_STATE, "set %d is mapped: release its views first", (int)m);
  while (s->member_count) forget_member(s, s->member_count - 1);
  mpm_context *context = s->context;
  mpmi_stepper_free_topology(s);
  mpmi_newton_free(s);
  for (int32_t i = 0; i < 8; ++i) mpmi_free(context, s->view_memory[i], s->view_bytes[i]);
  mpmi_free(context, s->active, mpmi_bytes(s->active_capacity, sizeof *s->active));
  mpmi_free(context, s->member, mpmi_bytes(s->member_capacity, sizeof *s->member));
  mpmi_free(context, s->bound_memory, mpmi_bytes((s->tasks + 1) * (MPMI_COLOURS + 1), sizeof(int64_t)));
  mpmi_free(context, s->scratch, mpmi_bytes(s->tasks, sizeof *s->scratch));
  --s->grid->children;
  --context->children;
  s->magic = 0;
  mpmi_free(context, s, sizeof *s);
  return MPM_OK;
}

static int32_t in_step(const mpm_stepper *s) {
  return s->phase != MPMI_IDLE;
}

static double present_time(const mpm_stepper *s) {
  return s->t;
}

static const mpmi_owner owner_of_sets = {in_step, present_time};

static mpm_status grow_members(mpm_stepper *s) {
  if (s->member_count < s->member_capacity) return MPM_OK;
  const int32_t capacity = s->member_capacity ? 2 * s->member_capacity : 4;
  mpmi_member *member = mpmi_alloc_zeroed(s->context, mpmi_bytes(capacity, sizeof *member));
  if (!member) return MPM_E_NOMEM;
  if (s->member_count) memcpy(member, s->member, (size_t)s->member_count * sizeof *member);
  mpmi_free(s->context, s->member, mpmi_bytes(s->member_capacity, sizeof *s->member));
  s->member = member;
  s->member_capacity = capacity;
  return MPM_OK;
}

mpm_status mpm_stepper_add(mpm_stepper *s, mpm_particles *set) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (!set || set->magic != (uint32_t)MPMI_PARTICLES || set->context != s->context)
    return mpmi_fail(s->context, MPM_E_ARG, "particles is NULL, destroyed or of another context");
  if (set->grid != s->grid)
    return mpmi_fail(s->context, MPM_E_ARG, "the set was made on another grid than the stepper");
  if (set->stepper)
    return mpmi_fail(s->context, MPM_E_STATE, "the set already belongs to %s stepper",
                     set->stepper == s ? "this" : "another");
  if (set->mapped) return mpmi_fail(s->context, MPM_E_STATE, "the set is mapped: release its views first");
  if ((status = grow_members(s)) || (status = keep_fields(set, &s->desc))) return status;
  mpmi_member *member = &s->member[s->member_count++];
  memset(member, 0, sizeof *member);
  member->set = set;
  mpmi_arrangement_init(&member->now, s->context);
  mpmi_arrangement_init(&member->next, s->context);
  set->stepper = s;
  set->owner = &owner_of_sets;
  set->dirty |= MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS;
  s->nodes_valid = 0;
  return MPM_OK;
}

mpm_status mpm_stepper_remove(mpm_stepper *s, mpm_particles *set) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  for (int32_t m = 0; m < s->member_count; ++m) {
    if (s->member[m].set != set) continue;
    if (set->mapped) return mpmi_fail(s->context, MPM_E_STATE, "the set is mapped: release its views first");
    forget_member(s, m);
    /* cuts counted the slots of this set: sort anew */
    mpmi_blocks_clear(&s->blocks);
    s->nodes_valid = 0;
    return MPM_OK;
  }
  return mpmi_fail(s->context, MPM_E_NOT_FOUND, "the set is not in this stepper");
}

/* What the host has set and implicit steps do not have. */
static mpm_status without_explicit_parts(mpm_stepper *s) {
  if (mpmi_has_hooks(s))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "scheme MPM_NEWMARK has no node hooks: unset them, or use an explicit scheme");
  for (int32_t f = 0; f < 2 * s->grid->dim; ++f)
    if (s->wall[f].kind == MPM_WALL_FRICTION)
      return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                       "scheme MPM_NEWMARK has no friction walls, and face %d is one: use MPM_WALL_SLIP or "
                       "MPM_WALL_FIXED, or an explicit scheme",
                       (int)f);
  return MPM_OK;
}

mpm_status mpm_stepper_configure(mpm_stepper *s, const mpm_stepper_desc *desc) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (!desc) return mpmi_fail(s->context, MPM_E_ARG, "desc is NULL");
  mpm_stepper_desc d;
  if ((status = read_desc(s->context, s->grid, desc, &d)) ||
      (status = d.scheme == MPM_NEWMARK ? without_explicit_parts(s) : MPM_OK))
    return status;
  for (int32_t m = 0; m < s->member_count; ++m)
    if (s->member[m].set->mapped)
      return mpmi_fail(s->context, MPM_E_STATE, "set %d is mapped: release its views first", (int)m);
  for (int32_t m = 0; m < s->member_count && !status; ++m) status = keep_fields(s->member[m].set, &d);
  /* those not wanted, or not to be had for all sets */
  for (int32_t m = 0; m < s->member_count; ++m) drop_fields(s->member[m].set, status ? &s->desc : &d);
  if (status) return status;
  if (!d.staggered || !s->desc.staggered) s->previous_dt = 0.0;
  s->desc = d;
  s->energies.valid = 0; /* the angular momentum depends on the transfer */
  return MPM_OK;
}

mpm_status mpm_stepper_set_time(mpm_stepper *s, double t, int64_t step) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (!isfinite(t)) return mpmi_fail(s->context, MPM_E_ARG, "t is %g: it must be finite", t);
  if (step == INT64_MAX)
    return mpmi_fail(s->context, MPM_E_ARG, "step is %lld: there is none after it", (long long)step);
  if (step < 0) return mpmi_fail(s->context, MPM_E_ARG, "step is %lld: it must be >= 0", (long long)step);
  s->t = t;
  s->step = step;
  return MPM_OK;
}

mpm_status mpm_stepper_set_wall(mpm_stepper *s, int32_t face, int32_t kind, double friction) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (face < 0 || face >= 2 * s->grid->dim)
    return mpmi_fail(s->context, MPM_E_ARG, "face is %d: a %d-D grid has 0 ... %d", (int)face,
                     (int)s->grid->dim, 2 * (int)s->grid->dim - 1);
  if (kind < MPM_WALL_NONE || kind > MPM_WALL_FRICTION)
    return mpmi_fail(s->context, MPM_E_ARG, "kind is %d: it must be an MPM_WALL_NONE ... MPM_WALL_FRICTION",
                     (int)kind);
  if (s->grid->desc.periodic[face / 2] && kind != MPM_WALL_NONE)
    return mpmi_fail(s->context, MPM_E_ARG, "face %d belongs to a periodic axis and can have no wall",
                     (int)face);
  if (kind == MPM_WALL_FRICTION && !(friction >= 0.0 && isfinite(friction)))
    return mpmi_fail(s->context, MPM_E_ARG, "friction is %g: it must be finite and >= 0", friction);
  if (kind == MPM_WALL_FRICTION && mpmi_is_implicit(s))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "scheme MPM_NEWMARK has no friction walls: use MPM_WALL_SLIP or MPM_WALL_FIXED, or an "
                     "explicit scheme");
  if (s->wall[face].kind != kind) s->walls_changed = 1;
  s->wall[face] = (mpmi_wall){kind, kind == MPM_WALL_FRICTION ? friction : 0.0};
  return MPM_OK;
}

#define SETTER(name, type, member)                                                                           \
  mpm_status name(mpm_stepper *s, type fn, void *user) {                                                     \
    MPMI_ENTER(s, MPMI_STEPPER);                                                                             \
    mpm_status status = mpmi_stepper_idle(s);                                                                \
    if (status) return status;                                                                               \
    s->member = fn;                                                                                          \
    s->member##_user = user;                                                                                 \
    return MPM_OK;                                                                                           \
  }
SETTER(mpm_stepper_set_acceleration, mpm_particle_fn, acceleration)
SETTER(mpm_stepper_set_force, mpm_particle_fn, force)
SETTER(mpm_stepper_set_velocity_bc, mpm_velocity_fn, velocity_bc)
SETTER(mpm_stepper_set_progress, mpm_progress_fn, progress)
SETTER(mpm_stepper_set_linear_solver, mpm_solve_fn, solver)

mpm_status mpm_stepper_wall_reaction(const mpm_stepper *s, int32_t face, double *force) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (!force) return mpmi_fail(s->context, MPM_E_ARG, "force is NULL");
  if (face < 0 || face >= 2 * s->grid->dim)
    return mpmi_fail(s->context, MPM_E_ARG, "face is %d: a %d-D grid has 0 ... %d", (int)face,
                     (int)s->grid->dim, 2 * (int)s->grid->dim - 1);
  if (!s->has_reactions) return mpmi_fail(s->context, MPM_E_STATE, "no step has been made yet");
  for (int32_t k = 0; k < s->grid->dim; ++k) force[k] = s->impulse_by_face[face][k] / s->reaction_dt;
  return MPM_OK;
}
