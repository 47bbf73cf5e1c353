/* Strain: deformation gradient, volume and stress of particles from the velocity gradient that a batch has
 * gathered, by the kernels of material/deformation.c (MPoint theory eqs 38 to 40). */
#include "stages/batch.h"
#include "layout/tile.h"
#include "particles/thermal.h"
#include "stages/stages.h"

#include <string.h>

/* Reading the clock costs as much as the law of a few particles: one batch in so many stands for all. */
enum { TIMED_BATCHES = 16 };

/* Rings have nine entries of F, of which four are no fields of the set. They begin from this. */
static const double nothing[MPMI_BATCH_HOST];

static int32_t looks_at_F_alone(const mpm_material *material) {
  return material->law && mpmi_material_stress_from_F(material) && !material->state_count &&
         mpmi_material_kinematics(material) == MPMI_F_DEFORMS;
}

/* Expansion and dissipation look at more. */
static int32_t needs_F_alone(const mpmi_settings *settings, const mpm_particles *set, int32_t m) {
  return looks_at_F_alone(set->material) && !mpmi_dissipates(settings, m) && !mpmi_expands(set);
}

/* Laws that look at F alone take its rows as a set stores them, and need no copy of F and stress. */
static int32_t works_in_place(const mpmi_settings *settings, const mpm_particles *set, int32_t m) {
  return needs_F_alone(settings, set, m) && !mpmi_is_axisymmetric(set->grid) &&
         !mpmi_is_plane_stress(set->grid) && !settings->desc.locking_remedy && !mpmi_is_implicit(settings);
}

/* Sums need the roots of few wave speeds; sheets and stiffness of springs need those of all. */
int32_t mpmi_takes_squares(const mpmi_settings *settings, const mpm_material *material) {
  return material->law && !mpmi_is_implicit(settings) && !mpmi_is_plane_stress(settings->grid);
}

/* A total Lagrangian grid makes the gradient over reference positions that over the present ones once it is
 * known, unless nothing but F is asked for. */
static int32_t deforms_at_once(const mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  const mpm_material *material = b->set->material;
  if (!b->pass->deforms || mpmi_is_implicit(settings) || mpmi_is_axisymmetric(settings->grid)) return 0;
  if (mpmi_is_total_lagrangian(settings->grid))
    return needs_F_alone(settings, b->set, b->m) && !settings->desc.locking_remedy;
  return mpmi_material_kinematics(material) == MPMI_F_DEFORMS;
}

/* An MLS transfer that gathers increments finds C, which is the velocity gradient as well. */
static int32_t finds_only_C(const mpmi_batch *b) {
  return b->step->settings->transfer->moments == MPMI_NEED_MLS && b->form == MPMI_GATHER_BOTH_AFFINE;
}

/* ---- before the batches of a set ---------------------------------------------------------------------- */
/* Tells whether anything reads the rows of the gradient after the gather. */
static int32_t reads_gradient(const mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  if (b->pass->moves && !b->pass->deforms) return finds_only_C(b);
  return !b->gather.deform || !needs_F_alone(settings, b->set, b->m) || settings->desc.locking_remedy;
}

static void bind_gradient(mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  const int32_t reads = reads_gradient(b), matrix = mpmi_gathers_C(b->form);
  for (int32_t e = 0; e < 9 && (!reads || finds_only_C(b)); ++e) b->gather.L[e] = NULL;
  b->keeps = MPMI_KEEPS_NOTHING;
  if (!b->set->field[MPMI_L].present) return;
  if (!(mpmi_is_affine(settings) ? b->pass->moves : b->pass->deforms)) return;
  b->keeps = finds_only_C(b) || (reads && !matrix) ? MPMI_KEEPS_COPY : MPMI_KEEPS_DIRECTLY;
}

void mpmi_strain_bind(mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  const mpm_grid *grid = settings->grid;
  b->law.stored = works_in_place(settings, b->set, b->m);
  if (b->law.stored) b->law.batch.ld = b->set->ld;
  b->law.squares = mpmi_takes_squares(settings, b->set->material);
  b->deform =
      (mpmi_deform){.dt = b->step->dt,
                    .total = mpmi_is_total_lagrangian(grid) && deforms_at_once(b),
                    .ld = b->law.ld,
                    .L = b->law.L,
                    .F = b->law.stored ? NULL : b->law.F,
                    .F_inc = b->set->material->law && !mpmi_is_implicit(settings) ? NULL : b->law.F_inc};
  mpmi_sums_bind(b);
  if (deforms_at_once(b) && !finds_only_C(b)) b->gather.deform = &b->deform;
  bind_gradient(b);
}

void mpmi_strain_enter(mpmi_batch *b) {
  if (b->step->settings->desc.locking_remedy)
    mpmi_tile_load(b->step->settings->kernels, &b->step->layout->blocks, b->block, &b->nodes->sums,
                   MPMI_TAKE_HALF, b->scratch->cells);
}

/* ---- a batch ------------------------------------------------------------------------------------------ */
void mpmi_gradient_aim(mpmi_batch *b) {
  const int32_t dim = b->set->grid->dim;
  if (b->keeps != MPMI_KEEPS_DIRECTLY) return;
  double **to = mpmi_gathers_C(b->form) ? b->gather.C : b->gather.L;
  for (int32_t c = 0; c < mpmi_gradient_components(dim); ++c)
    to[mpmi_gradient_map(dim)[c]] = mpmi_component_row(b->set, MPMI_L, 1, c) + b->begin;
}

void mpmi_strain_aim(mpmi_batch *b) {
  const mpmi_step *step = b->step;
  mpm_particles *set = b->set;
  const int32_t rings = mpmi_is_axisymmetric(set->grid);
  for (int32_t e = 0; e < 9 && rings; ++e) {
    b->deform.F_old[e] = nothing;
    b->deform.F_new[e] = b->law.F + e * b->law.ld;
  }
  for (int32_t c = 0; c < mpmi_tensor_components(set->grid->dim); ++c) {
    const int32_t e = rings ? mpmi_tensor_map(2)[c] : c;
    b->deform.F_old[e] = mpmi_component_row(set, MPMI_F, 0, c) + b->begin;
    b->deform.F_new[e] = mpmi_component_row(set, MPMI_F, 1, c) + b->begin;
  }
  b->deform.initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + b->begin;
  b->deform.volume = mpmi_f64(set, MPMI_VOLUME, 0) + b->begin;
  if (b->law.stored) {
    b->law.batch.F = b->deform.F_new[0];
    b->law.batch.stress_new = mpmi_component_row(set, MPMI_STRESS, 1, 0) + b->begin;
    b->sums_job.checked[0] = b->law.batch.stress_new;
  }
  mpmi_law_batch_load(&b->law, set, b->begin, b->n, step->t + step->dt, step->dt);
  mpmi_gradient_aim(b);
}

void mpmi_gradient_keep(mpmi_batch *b) {
  const int32_t dim = b->set->grid->dim;
  if (finds_only_C(b)) memcpy(b->law.L, b->C, (size_t)(9 * b->law.ld) * sizeof(double));
  if (b->keeps != MPMI_KEEPS_COPY) return;
  for (int32_t c = 0; c < mpmi_gradient_components(dim); ++c)
    memcpy(mpmi_component_row(b->set, MPMI_L, 1, c) + b->begin,
           b->law.L + mpmi_gradient_map(dim)[c] * b->law.ld, (size_t)b->n * sizeof(double));
}

/* Makes the volumes of a batch of stored components of F, as they are made again later: with those bits. */
static uint32_t make_volumes(const mpmi_batch *b) {
  const double *F[9] = {NULL};
  mpmi_point_at(b->set, MPMI_F, 1, b->begin, F);
  return b->step->settings->deformation->volume[b->set->grid->dim](F, b->deform.initial_volume,
                                                                   b->deform.volume, b->n);
}

int32_t mpmi_strain_deform(mpmi_batch *b) {
  const mpmi_deformation *by = b->step->settings->deformation;
  const int32_t kinematics = mpmi_material_kinematics(b->set->material);
  uint32_t flags = b->taken.deformed;
  if (mpmi_is_total_lagrangian(b->set->grid) && !b->deform.total) mpmi_gradient_present(b);
  if (!b->gather.deform) flags = by->deform[kinematics][mpmi_strain_dim(b->set->grid)](&b->deform, b->n);
  if (mpmi_is_axisymmetric(b->set->grid)) flags |= make_volumes(b);
  b->flags |= flags;
  return !flags;
}

/* Takes F33 from the law, which has found it, and the volume that it makes. */
static void take_thickness(mpmi_batch *b) {
  memcpy(b->deform.F_new[4], b->law.F + 8 * b->law.ld, (size_t)b->n * sizeof(double));
  b->flags |= make_volumes(b);
}

void mpmi_take_reference_speeds(const mpmi_settings *settings, const mpm_particles *set, int32_t copy,
                                int64_t begin, int64_t n, mpmi_law_batch *law) {
  const double *F[9] = {NULL};
  mpmi_point_at(set, MPMI_F, copy, begin, F);
  settings->pull_back->speeds[set->grid->dim](F, law->squares, law->wave_speed,
                                              mpmi_may_be_viscous(set->material) ? law->viscosity : NULL, n);
}

void mpmi_strain_law(mpmi_batch *b) {
  const mpmi_step *step = b->step;
  if (step->settings->desc.locking_remedy)
    mpmi_locking_apply(step->settings, b->scratch->cells, b->gather.axis, b->set, &b->law, b->begin, b->n,
                       step->dt);
  if (mpmi_expands(b->set))
    mpmi_expand_step(&b->law, b->set, b->begin, b->n, step->dt, b->deform.F_inc != NULL);
  const int32_t timed = step->profile->sampled && b->batches++ % TIMED_BATCHES == 0;
  const double started = timed ? mpmi_seconds() : 0.0;
  const mpm_status status = mpmi_law_batch_run_in(&b->law, b->set);
  if (timed) b->report->law_seconds += (double)TIMED_BATCHES * (mpmi_seconds() - started);
  if (b->law.fault.cause) {
    const mpmi_law_fault *fault = &b->law.fault;
    mpmi_failure_take(&b->report->failure,
                      mpmi_particle_failure(fault->cause, b->m, fault->particle, fault->what));
    return;
  }
  if (status) {
    mpmi_failure_take(&b->report->failure, mpmi_callback_failure(status, b->m, "the material callback"));
    return;
  }
  if (mpmi_dissipates(step->settings, b->m)) mpmi_dissipation_find(b);
  if (mpmi_is_plane_stress(b->set->grid)) take_thickness(b);
  if (mpmi_is_total_lagrangian(b->set->grid))
    mpmi_take_reference_speeds(step->settings, b->set, 1, b->begin, b->n, &b->law);
  if (!b->law.stored) mpmi_law_batch_store(&b->law, b->set, 1, b->begin, b->n);
  b->law_ran = 1;
}

void mpmi_make_volumes(const mpmi_layout *layout, int32_t copy) {
  for (int32_t m = 0; m < layout->member_count; ++m) mpmi_particles_make_volumes(layout->member[m].set, copy);
}
