/* Sub-steps to a given time: cut on failure, grown on success. */
#include "context/structs.h"
#include "stepper/together.h"

#include <float.h>
#include <math.h>

static const mpm_advance_desc defaults = {.struct_size = sizeof(mpm_advance_desc)};

/* A step that failed is cut to 0.6, one that went well lets the next be twice as long: proven in practice. */
static const double CUT = 0.6, GROW = 2.0;
/* What max_cuts = 0 means: no cause that a smaller dt cures needs as many. And how often a particle may leave
 * the grid before the time comes to where one of these steps would have ended. */
enum { MOST_CUTS = 60, MOST_LEAVES = 20 };

/* Largest shares of the stable dt at which bodies stay bounded, slivers and compression on the linear basis
 * aside, as measured: `make verify CASES=stable_share`. */
static double stable_share(const mpm_grid *grid, int32_t scheme) {
  const int32_t usl = scheme == MPM_USL;
  switch (grid->desc.basis) {
  case MPM_LINEAR:
    return usl ? 0.6 : 0.9;
  case MPM_BSPLINE2:
    return usl ? 0.6 : 1.0;
  case MPM_BSPLINE3:
    return usl ? 0.9 : 1.0;
  case MPM_CPGIMP:
    return usl ? 0.4 : scheme == MPM_USF ? 0.5 : 0.7;
  default: /* other GIMP, domains from a quarter of a cell on */
    return usl ? 0.4 : 0.7;
  }
}

static double share_of(const mpm_stepper *s, const mpm_advance_desc *d) {
  return d->cfl > 0.0 ? d->cfl : stable_share(s->settings.grid, s->settings.desc.scheme) / 1.5;
}

mpm_status mpm_advance_desc_init(mpm_advance_desc *desc, uint32_t struct_size) {
  return mpmi_init_struct("mpm_advance_desc", &defaults, sizeof defaults, desc, struct_size);
}

static mpm_status check(mpm_stepper *s, const mpm_advance_desc *d) {
  mpm_context *c = s->context;
  if (!isfinite(d->t_end) || d->t_end < s->history.t)
    return mpmi_fail(c, MPM_E_ARG, "t_end is %g: it must be finite and not before the present time %g",
                     d->t_end, s->history.t);
  if (!(d->cfl >= 0.0 && d->cfl <= 1.0))
    return mpmi_fail(c, MPM_E_ARG, "cfl is %g: it must lie in [0, 1]", d->cfl);
  mpm_status status;
  if ((status = mpmi_check_magnitude(c, "dt_first", d->dt_first)) ||
      (status = mpmi_check_magnitude(c, "dt_min", d->dt_min)) ||
      (status = mpmi_check_magnitude(c, "dt_max", d->dt_max)))
    return status;
  if (d->dt_max > 0.0 && d->dt_min > d->dt_max)
    return mpmi_fail(c, MPM_E_ARG, "dt_min is %g, more than dt_max = %g", d->dt_min, d->dt_max);
  status = mpmi_check_count(c, "max_cuts", d->max_cuts);
  return status ? status : mpmi_check_count(c, "max_steps", d->max_steps);
}

/* Chooses the sub-step that the bounds allow, cut so that no sliver remains before t_end. */
static mpm_status choose(mpm_stepper *s, const mpm_advance_desc *d, double *dt, int32_t *last) {
  const double left = d->t_end - s->history.t;
  *dt = left;
  if (!mpmi_is_implicit(&s->settings)) {
    const mpm_status status = mpmi_tell_stable_dt(s, dt);
    if (status) return status;
    *dt *= share_of(s, d);
  }
  if (s->history.controller_dt > 0.0 && s->history.controller_dt < *dt) *dt = s->history.controller_dt;
  if (d->dt_max > 0.0 && d->dt_max < *dt) *dt = d->dt_max;
  *last = left <= *dt * (1.0 + 1e-9);
  if (*last)
    *dt = left;
  else if (left < 2.0 * *dt && 0.5 * left >= d->dt_min)
    *dt = 0.5 * left;
  return MPM_OK;
}

/* Lets the controller's dt grow: explicit until it no longer bounds the stable dt, implicit as the iterations
 * went, and never down, because a step cut by t_end says nothing of longer ones. */
static void let_grow(mpm_stepper *s, double dt) {
  if (mpmi_is_implicit(&s->settings)) {
    s->history.controller_dt = fmax(s->history.controller_dt, s->history.last.dt_suggested);
    return;
  }
  if (s->history.controller_dt > 0.0) s->history.controller_dt *= GROW;
  if (s->history.controller_dt > 1e6 * dt) s->history.controller_dt = 0.0;
}

/* Steps in which particles would leave the grid. */
typedef struct leaves {
  int32_t count;
  double end; /* the earliest at which one of them would have ended */
} leaves;

/* Returns 1 where causes of this kind are answered by a smaller dt. */
static int32_t is_cut(const mpm_stepper *s, mpm_status status) {
  return (status >= MPM_CUT_DT && status <= MPM_SINGULAR) ||
         (status == MPM_OFF_GRID && mpmi_is_implicit(&s->settings));
}

/* Returns 1 where this one may be answered so. What leaves the grid in an implicit step may only have come to
 * a balance far away, or through a touch that stayed open. What moves out by itself is out at the end of all
 * these steps, and so the time does not come to the end of any. */
static int32_t a_cut_may_help(const mpm_stepper *s, mpm_status status, double dt, leaves *left) {
  if (status == MPM_OFF_GRID) {
    const double end = s->history.t + dt;
    if (s->history.t >= left->end) *left = (leaves){0, end};
    left->end = fmin(left->end, end);
    return left->count++ < MOST_LEAVES;
  }
  /* the first matrix of a quasi-static step does not depend on dt */
  return status != MPM_SINGULAR || !s->settings.desc.quasi_static || s->history.last.newton_iterations > 1;
}

/* The next call starts from the dt that was cut first. */
static mpm_status give_up(mpm_stepper *s, mpm_status status, int32_t cuts, double first, double dt) {
  s->history.controller_dt = first;
  return mpmi_fail(s->context, status, "gave up after %d cuts of dt from %g to %g: %s", (int)cuts, first, dt,
                   mpm_last_error(s->context));
}

static mpm_status sub_steps(mpm_stepper *s, const mpm_advance_desc *d) {
  const int32_t most = d->max_cuts ? d->max_cuts : MOST_CUTS;
  int32_t cuts = 0;
  double first = 0.0;
  leaves left = {0, -HUGE_VAL};
  if (d->dt_first > 0.0) s->history.controller_dt = d->dt_first;
  for (int64_t step = 0; s->history.t < d->t_end && (!d->max_steps || step < d->max_steps);) {
    double dt;
    int32_t last;
    mpm_status status = choose(s, d, &dt, &last);
    if (status) return status;
    /* nothing is left that the clock can show; a step that is too small for it is refused below */
    if (s->history.t + dt == s->history.t && s->history.t + 0.5 * (d->t_end - s->history.t) == s->history.t) {
      s->history.t = d->t_end;
      return MPM_OK;
    }
    status = mpmi_make_step(s, MPM_OK, dt, 1);
    if (!status) {
      if (last) s->history.t = d->t_end;
      let_grow(s, dt);
      ++step;
      cuts = 0;
      continue;
    }
    if (!is_cut(s, status)) return status;
    if (!cuts) first = dt;
    const double smaller = CUT * dt;
    /* cutting ends where numbers lose digits: the smallest would be cut to itself */
    if (!a_cut_may_help(s, status, dt, &left) || cuts == most || smaller < d->dt_min || smaller < DBL_MIN ||
        s->history.t + smaller == s->history.t)
      return cuts ? give_up(s, status, cuts, first, dt) : status;
    ++cuts;
    s->history.controller_dt = smaller;
  }
  return MPM_OK;
}

mpm_status mpm_advance(mpm_stepper *s, const mpm_advance_desc *desc, mpm_step_info *info) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_advance_desc d = defaults;
  mpm_status status = desc ? mpmi_check_info(s, info) : mpmi_fail(s->context, MPM_E_ARG, "desc is NULL");
  if (!status) status = mpmi_read_struct(s->context, "mpm_advance_desc", desc, sizeof d, &d);
  if (!status) status = check(s, &d);
  if (!status) status = mpmi_stepper_idle(s);
  static const char *const name[] = {"t_end", "cfl", "dt_first", "dt_min", "dt_max", "max_cuts", "max_steps"};
  const double number[] = {
      d.t_end, d.cfl, d.dt_first, d.dt_min, d.dt_max, (double)d.max_cuts, (double)d.max_steps};
  status = mpmi_together_begin(s, status, 7, name, number);
  return status ? status : mpmi_give_info(s, sub_steps(s, &d), info);
}
