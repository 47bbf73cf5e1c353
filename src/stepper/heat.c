/* What the host says of heat, and what it is told. */
#include "context/checks.h"
#include "context/structs.h"
#include "layout/members.h"
#include "particles/thermal.h"
#include "stepper/together.h"

#include <math.h>

static mpm_heat_desc default_desc(void) {
  return (mpm_heat_desc){.struct_size = sizeof(mpm_heat_desc)};
}

mpm_status mpm_heat_desc_init(mpm_heat_desc *desc, uint32_t struct_size) {
  const mpm_heat_desc defaults = default_desc();
  return mpmi_init_struct("mpm_heat_desc", &defaults, sizeof defaults, desc, struct_size);
}

/* ---- sets ---------------------------------------------------------------------------------------------- */
static mpm_status check_desc(mpm_context *c, const mpm_heat_desc *d) {
  if (!(d->specific_heat > 0.0) || !isfinite(d->specific_heat))
    return mpmi_fail(c, MPM_E_ARG, "specific_heat is %g: it must be finite and > 0", d->specific_heat);
  if (!isfinite(d->expansion) || !isfinite(d->reference_temperature))
    return mpmi_fail(c, MPM_E_ARG, "expansion is %g and reference_temperature %g: they must be finite",
                     d->expansion, d->reference_temperature);
  if (!(d->dissipated_share >= 0.0 && d->dissipated_share <= 1.0))
    return mpmi_fail(c, MPM_E_ARG, "dissipated_share is %g: it must be 0 to 1", d->dissipated_share);
  return mpmi_check_magnitude(c, "conductivity", d->conductivity);
}

static mpm_status check_set(const mpm_particles *set, const mpm_heat_desc *d) {
  const int32_t rigid = mpmi_material_kinematics(set->material) == MPMI_F_STAYS;
  if (d->expansion != 0.0 && rigid)
    return mpmi_fail(set->context, MPM_E_UNSUPPORTED,
                     "a rigid set does not expand: leave expansion 0, or use another law");
  if (d->expansion != 0.0 && mpmi_is_plane_stress(set->grid))
    return mpmi_fail(set->context, MPM_E_UNSUPPORTED,
                     "sheets in plane stress do not expand: leave expansion 0, or use a 3-D grid");
  if (d->dissipated_share > 0.0 && rigid)
    return mpmi_fail(set->context, MPM_E_UNSUPPORTED,
                     "a rigid set dissipates nothing: leave dissipated_share 0, or use another law");
  if (d->dissipated_share > 0.0 && !set->material->law)
    return mpmi_fail(
        set->context, MPM_E_UNSUPPORTED,
        "what a law of the host dissipates is not known: leave dissipated_share 0, and give its heat "
        "by source");
  return MPM_OK;
}

static void find_any(mpm_stepper *s) {
  s->settings.heat.any = 0;
  for (int32_t m = 0; m < s->layout.member_count; ++m) s->settings.heat.any |= s->settings.heat.set[m].on;
}

void mpmi_heat_take_off(mpm_stepper *s, int32_t m) {
  if (s->settings.heat.set[m].on) mpmi_thermal_drop(s->layout.member[m].set);
  s->settings.heat.set[m].on = 0;
  find_any(s);
  if (s->settings.heat.any) return;
  /* who has heat later meets the faces anew */
  for (int32_t face = 0; face < 6; ++face)
    s->history.heat.acted[face] = s->history.heat.prescribed[face] = 0.0;
}

mpm_status mpm_stepper_set_heat(mpm_stepper *s, mpm_particles *particles, const mpm_heat_desc *desc) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  mpm_heat_desc d;
  mpm_status status = mpmi_stepper_idle(s);
  if (!status) status = mpmi_members_find(&s->layout, &s->settings, particles, &m);
  if (!status && desc) status = mpmi_read_struct(s->context, "mpm_heat_desc", desc, sizeof d, &d);
  if (!status && desc) status = check_desc(s->context, &d);
  if (!status && desc) status = check_set(particles, &d);
  if (!status) status = mpmi_particles_changeable(particles);
  if (status) return status;
  if (!desc) {
    mpmi_heat_take_off(s, m);
    return MPM_OK;
  }
  if (!s->heat && !(s->heat = mpmi_alloc_zeroed(s->context, sizeof *s->heat))) return MPM_E_NOMEM;
  if (!s->settings.heat.any) s->heat->version = -1;
  if ((status = mpmi_thermal_make(particles, d.expansion, d.reference_temperature))) return status;
  s->settings.heat.set[m] = (mpmi_heat_rule){1, d};
  find_any(s);
  return MPM_OK;
}

/* ---- nodes and faces ----------------------------------------------------------------------------------- */
mpm_status mpm_stepper_set_conduction(mpm_stepper *s, int32_t conduction, double tolerance) {
  MPMI_ENTER(s, MPMI_STEPPER);
  const mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (conduction < MPM_CONDUCTION_EXPLICIT || conduction > MPM_CONDUCTION_IMPLICIT)
    return mpmi_fail(s->context, MPM_E_ARG,
                     "conduction is %d: it must be MPM_CONDUCTION_EXPLICIT or MPM_CONDUCTION_IMPLICIT",
                     (int)conduction);
  if (conduction == MPM_CONDUCTION_IMPLICIT && !(tolerance > 0.0 && tolerance < 1.0))
    return mpmi_fail(s->context, MPM_E_ARG, "tolerance is %g: it must be > 0 and < 1", tolerance);
  s->settings.heat.conduction = conduction;
  s->settings.heat.tolerance = tolerance;
  return MPM_OK;
}

mpm_status mpm_stepper_set_heat_wall(mpm_stepper *s, int32_t face, int32_t kind, double temperature) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status || (status = mpmi_check_face(s, face))) return status;
  if (kind < MPM_HEAT_WALL_INSULATED || kind > MPM_HEAT_WALL_TEMPERATURE)
    return mpmi_fail(s->context, MPM_E_ARG,
                     "kind is %d: it must be MPM_HEAT_WALL_INSULATED or MPM_HEAT_WALL_TEMPERATURE",
                     (int)kind);
  if (kind == MPM_HEAT_WALL_TEMPERATURE && !isfinite(temperature))
    return mpmi_fail(s->context, MPM_E_ARG, "temperature is %g: it must be finite", temperature);
  if (kind == MPM_HEAT_WALL_TEMPERATURE && s->grid->desc.periodic[face / 2])
    return mpmi_fail(s->context, MPM_E_ARG, "face %d belongs to a periodic axis: heat goes through it",
                     (int)face);
  if (kind == MPM_HEAT_WALL_TEMPERATURE && mpmi_is_axis_face(s->grid, face))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "face %d is the axis of an MPM_AXISYMMETRIC grid, through which nothing flows: leave it "
                     "insulated",
                     (int)face);
  s->settings.heat.walls += s->settings.heat.wall[face].kind != kind;
  s->settings.heat.wall[face] = (mpmi_heat_wall){kind, kind ? temperature : 0.0};
  return MPM_OK;
}

mpm_status mpm_surface_set_heat(mpm_surface *s, double flux, double film, double ambient) {
  MPMI_ENTER(s, MPMI_SURFACE);
  mpm_status status = mpmi_surface_changeable(s);
  if (status) return status;
  if (!isfinite(flux) || !isfinite(ambient))
    return mpmi_fail(s->context, MPM_E_ARG, "flux is %g and ambient %g: they must be finite", flux, ambient);
  if ((status = mpmi_check_magnitude(s->context, "film", film))) return status;
  s->heat = (mpmi_surface_heat){flux, film, ambient};
  return MPM_OK;
}

/* ---- reports ------------------------------------------------------------------------------------------- */
mpm_status mpm_stepper_heat_info(const mpm_stepper *s, mpm_heat_info *info) {
  MPMI_ENTER(s, MPMI_STEPPER);
  const mpmi_heat_history *of = &s->history.heat;
  mpm_heat_info now = {.struct_size = sizeof now,
                       .iterations = (int32_t)of->iterations,
                       .gained = of->last.gained,
                       .sources = of->last.sources,
                       .surfaces = of->last.surfaces,
                       .dissipated = of->last.dissipated,
                       .gained_total = of->total.gained,
                       .sources_total = of->total.sources,
                       .surfaces_total = of->total.surfaces,
                       .dissipated_total = of->total.dissipated};
  mpm_status status = mpmi_stepper_idle(s);
  if (!status && !s->heat)
    status = mpmi_fail(s->context, MPM_E_STATE, "no set has heat: describe one by mpm_stepper_set_heat");
  if (!status) status = mpmi_check_out_struct(s->context, "mpm_heat_info", sizeof now, info);
  if ((status = mpmi_together(s, status))) return status;
  for (int32_t face = 0; face < 6; ++face) {
    now.walls[face] = of->last.walls[face];
    now.walls_total[face] = of->total.walls[face];
  }
  mpmi_whole_sum heat;
  mpmi_exact_clear(&heat);
  for (int32_t m = 0; m < s->layout.member_count; ++m)
    mpmi_heat_of(&s->settings.heat.set[m], s->layout.member[m].set, &heat);
  if ((status = mpmi_total_parts(s->context, 1, &heat, &now.heat))) return status;
  return mpmi_write_struct(s->context, "mpm_heat_info", &now, sizeof now, info);
}
