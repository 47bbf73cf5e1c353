/* The description of a stepper: its defaults, and what it may ask for. */
#include "stepper/stepper.h"
#include "context/structs.h"
#include "layout/transfers.h"

#include <float.h>

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
  const mpmi_transfer *transfer = mpmi_transfer_of(d->transfer);
  if (!transfer)
    return mpmi_fail(c, MPM_E_ARG, "transfer is %d: it must be an MPM_FLIP ... MPM_FMPM", (int)d->transfer);
  if (transfer->fused && !(grid->moment > 0.0))
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "transfer MPM_APIC_MLS needs a quadratic or cubic B-spline with ghost or periodic "
                     "boundaries: use MPM_APIC with this grid");
  if (transfer->most_order && (d->xpic_order < 1 || d->xpic_order > transfer->most_order))
    return mpmi_fail(c, MPM_E_ARG, "xpic_order is %d: it must be 1 ... %d", (int)d->xpic_order,
                     (int)transfer->most_order);
  const mpm_status status = mpmi_check_count(c, "xpic_every", d->xpic_every);
  if (status) return status;
  if (transfer->takes == MPMI_TAKES_FULL && d->xpic_every > 2 && d->xpic_order > 1 &&
      (d->scheme == MPM_USF || d->scheme == MPM_MUSL))
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "xpic_every is %d: with MPM_FMPM in schemes MPM_USF and MPM_MUSL waves grow where it is "
                     "above 2: use 2, scheme MPM_USL, or transfer MPM_XPIC",
                     (int)d->xpic_every);
  return MPM_OK;
}

/* Checks the options beside scheme, transfer and forces. */
static mpm_status known_options(mpm_context *c, const mpm_grid *grid, const mpm_stepper_desc *d) {
  mpm_status status;
  if ((status = mpmi_check_switch(c, "quasi_static", d->quasi_static)) ||
      (status = mpmi_check_magnitude(c, "pic_damping", d->pic_damping)) ||
      (status = mpmi_check_switch(c, "staggered", d->staggered)) ||
      (status = mpmi_check_switch(c, "locking_remedy", d->locking_remedy)) ||
      (status = mpmi_check_magnitude(c, "mass_damping", d->mass_damping)) ||
      (status = mpmi_check_switch(c, "projected_positions", d->projected_positions)))
    return status;
  if (d->quasi_static && d->scheme != MPM_NEWMARK)
    return mpmi_fail(c, MPM_E_UNSUPPORTED, "quasi_static = 1 needs implicit steps: use scheme MPM_NEWMARK");
  if (d->position_order != 1 && d->position_order != 2)
    return mpmi_fail(c, MPM_E_ARG, "position_order is %d: it must be 1 or 2", (int)d->position_order);
  if (d->locking_remedy && grid->dim == 1)
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "locking_remedy has no meaning in 1-D, where dilation is all there is: use "
                     "MPM_LOCKING_NONE");
  if (!(d->local_damping >= 0.0 && d->local_damping < 1.0))
    return mpmi_fail(c, MPM_E_ARG, "local_damping is %g: it must lie in [0, 1)", d->local_damping);
  if (d->mass_damping > 0.0 && d->quasi_static)
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "quasi_static = 1 has no inertia that mass_damping could act on: use mass_damping = 0");
  if (d->projected_positions && d->scheme != MPM_MUSL)
    return mpmi_fail(
        c, MPM_E_UNSUPPORTED,
        "projected_positions = 1 needs the second projection of scheme MPM_MUSL: use that, or 0");
  if (d->staggered && d->position_order == 2)
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "staggered steps are of second order with position_order = 1: use that");
  return MPM_OK;
}

/* Checks the options of implicit steps, and what they do not go with. */
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
  const mpm_status status = mpmi_check_count(c, "linear_max_iterations", d->linear_max_iterations);
  if (status) return status;
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
  if (d->local_damping > 0.0)
    return mpmi_fail(
        c, MPM_E_UNSUPPORTED,
        "scheme MPM_NEWMARK has no local_damping, whose force jumps where a velocity changes its "
        "sign: use mass_damping, or quasi_static = 1 to find equilibrium");
  if (d->staggered)
    return mpmi_fail(c, MPM_E_UNSUPPORTED, "scheme MPM_NEWMARK has velocities at t_n: use staggered = 0");
  return MPM_OK;
}

/* Refuses what rings and sheets do not offer. */
static mpm_status known_geometry(mpm_context *c, const mpm_grid *grid, const mpm_stepper_desc *d) {
  if (mpmi_is_plane_stress(grid) && d->locking_remedy)
    return mpmi_fail(
        c, MPM_E_UNSUPPORTED,
        "locking_remedy = 1 has no meaning where the grid is MPM_PLANE_STRESS: sheets do not lock: "
        "use 0");
  if (!mpmi_is_axisymmetric(grid)) return MPM_OK;
  if (mpmi_transfer_of(d->transfer)->fused)
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "transfer MPM_APIC_MLS has no hoop force, and the grid is MPM_AXISYMMETRIC: use "
                     "MPM_APIC");
  if (d->gravity[0] != 0.0)
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "gravity[0] is %g, but the grid is MPM_AXISYMMETRIC: weight acts along the axis alone: "
                     "use gravity[1], and a force callback for what acts along the radius",
                     d->gravity[0]);
  return MPM_OK;
}

mpm_status mpmi_description_read(mpm_context *c, const mpm_grid *grid, const mpm_stepper_desc *desc,
                                 mpm_stepper_desc *out) {
  *out = defaults;
  mpm_status status = desc ? mpmi_read_struct(c, "mpm_stepper_desc", desc, sizeof *out, out) : MPM_OK;
  if (status || (status = known_scheme(c, out->scheme)) || (status = known_transfer(c, grid, out)) ||
      (status = known_options(c, grid, out)) || (status = known_implicit(c, out)) ||
      (status = known_geometry(c, grid, out)))
    return status;
  if (!(out->flip >= 0.0 && out->flip <= 1.0))
    return mpmi_fail(c, MPM_E_ARG, "flip is %g: it must lie in [0, 1]", out->flip);
  if ((status = mpmi_check_vector(c, "gravity", out->gravity, grid->dim)) ||
      (status = mpmi_check_switch(c, "boundary_zero_acceleration", out->boundary_zero_acceleration)) ||
      (status = mpmi_check_switch(c, "reference_positions", out->reference_positions)))
    return status;
  for (int32_t k = grid->dim; k < 3; ++k) out->gravity[k] = 0.0;
  return MPM_OK;
}
