/* Plane stress: the law runs in 3-D, and F33, of which the grid knows nothing, is found so that the stress
 * across the plane vanishes. Across the plane a law is as stiff as its wave speed says; from the second
 * answer on the slope is that between the last two, and what lies on both sides of the root keeps it in
 * between. */
#include <math.h>

#include "particles/law_batch.h"
#include "particles/thermal.h"

enum { MOST_CALLS = 25, MOST_CALLS_AT_REST = 100, THICKNESS = 8 };
/* The stress that is left, over the stiffness. */
static const double tolerance = 1e-12;
/* A step thins or thickens a sheet by this factor at most; of an F of the host nothing is known. */
static const double most_growth = 5.0, most_growth_at_rest = 1e6;
/* Where a law does not say how stiff it is, its answer to this is asked for. */
static const double probe = 1e-6;

/* One particle on its way. */
typedef struct sheet {
  double start, low, high;    /* F33 at the start of the step; between these the root lies */
  double last_F, last_stress; /* of the answer before; NaN: there is none */
  double slope;               /* 0: not known */
  int32_t found;
} sheet;

/* Gives the law another F33: F, F_inc and L have it. */
static void set_F33(mpmi_law_batch *b, int64_t p, double F33, double start) {
  const int64_t at = THICKNESS * b->ld + p;
  const double growth = F33 / start;
  b->F[at] = F33;
  b->F_inc[at] = growth;
  b->L[at] = b->batch.dt > 0.0 ? (growth - 1.0) / b->batch.dt : 0.0;
}

/* Takes an answer and gives the law the next F33. The stress grows with F33. NaN is reported with the other
 * stresses. */
static void improve(mpmi_law_batch *b, int64_t p, double stiffness, sheet *s) {
  const double F33 = b->F[THICKNESS * b->ld + p], stress = b->stress_new[2 * b->ld + p];
  const double slope = (stress - s->last_stress) / (F33 - s->last_F);
  if (slope > 0.0 && isfinite(slope)) s->slope = slope;
  s->found = !(fabs(stress) > tolerance * fmax(stiffness, s->slope * F33));
  if (s->found) return;
  if (stress < 0.0)
    s->low = F33;
  else
    s->high = F33;
  s->last_F = F33;
  s->last_stress = stress;
  double next = s->slope > 0.0 ? F33 - stress / s->slope : F33 * (stress < 0.0 ? 1.0 + probe : 1.0 - probe);
  if (!(next > s->low && next < s->high)) next = sqrt(s->low) * sqrt(s->high);
  set_F33(b, p, next, s->start);
}

/* Returns 1 when the law at hand says what the stress of another F33 would be. With dt = 0 that is a law
 * whose stress follows from F; of others the stress is as it was given. */
static int32_t can_answer(const mpmi_law_batch *b, const mpm_material *material) {
  if (mpmi_material_kinematics(material) == MPMI_F_STAYS) return 0;
  return b->batch.dt > 0.0 || (material->law && mpmi_material_stress_from_F(material));
}

/* Returns how many sheets there are, or -1 where one has no thickness. */
static int64_t begin_sheets(mpmi_law_batch *b, sheet *sheets) {
  const double most = b->batch.dt > 0.0 ? most_growth : most_growth_at_rest;
  int64_t left = 0;
  for (int64_t p = 0; p < b->batch.n; ++p) {
    const double F33 = b->F[THICKNESS * b->ld + p];
    sheets[p] = (sheet){.start = F33,
                        .low = F33 / most,
                        .high = F33 * most,
                        .last_F = (double)NAN,
                        .last_stress = (double)NAN,
                        .found = b->batch.id[p] < 0};
    if (!sheets[p].found && F33 <= 0.0) {
      b->fault = (mpmi_law_fault){MPM_E_ARG, b->batch.id[p], "a sheet with F33 <= 0 has no thickness"};
      return -1;
    }
    set_F33(b, p, F33, F33); /* of the batch before there is another */
    left += !sheets[p].found;
  }
  return left;
}

static mpm_status give_up(mpmi_law_batch *b, int64_t p) {
  b->fault = (mpmi_law_fault){b->batch.dt > 0.0 ? MPM_CUT_DT : MPM_E_ARG, b->batch.id[p],
                              "no thickness leaves the plane without a stress across it"};
  return b->fault.cause;
}

static mpm_status run_sheets(mpmi_law_batch *b, const mpm_material *material) {
  const int32_t most_calls = b->batch.dt > 0.0 ? MOST_CALLS : MOST_CALLS_AT_REST;
  sheet sheets[MPMI_BATCH_HOST];
  b->fault.cause = MPM_OK;
  int64_t left = can_answer(b, material) ? begin_sheets(b, sheets) : 0;
  if (left < 0) return b->fault.cause;
  mpm_status status = mpmi_law_batch_run(b, material, 3);
  for (int32_t calls = 1; left && !status; ++calls) {
    left = 0;
    for (int64_t p = 0; p < b->batch.n; ++p) {
      const double stiffness = material->density * b->wave_speed[p] * b->wave_speed[p];
      if (sheets[p].found) continue;
      if (calls == 1) sheets[p].slope = stiffness / sheets[p].start;
      improve(b, p, stiffness, &sheets[p]);
      if (!sheets[p].found && calls >= most_calls) return give_up(b, p);
      left += !sheets[p].found;
    }
    if (left) status = mpmi_law_batch_run(b, material, 3);
  }
  return status;
}

mpm_status mpmi_law_batch_run_in(mpmi_law_batch *b, const mpm_particles *set) {
  if (mpmi_is_plane_stress(set->grid)) return run_sheets(b, set->material);
  if (!mpmi_expands(set)) return mpmi_law_batch_run(b, set->material, mpmi_strain_dim(set->grid));
  /* what expands does so along all axes, and its energy is that of the volume to which it has grown */
  const mpm_status status = mpmi_law_batch_run(b, set->material, 3);
  for (int64_t p = 0; p < b->batch.n; ++p) b->energy[p] *= b->growth[p];
  return status;
}

void mpmi_condense_tangent(double *tangent, int64_t ld, int64_t n) {
  for (int32_t i = 0; i < 2; ++i)
    for (int32_t j = 0; j < 2; ++j)
      for (int32_t k = 0; k < 2; ++k)
        for (int32_t l = 0; l < 2; ++l)
          for (int64_t p = 0; p < n; ++p) {
            const double across = tangent[80 * ld + p];
            const double by = tangent[(9 * (3 * i + j) + 8) * ld + p] * tangent[(72 + 3 * k + l) * ld + p];
            if (across > 0.0 || across < 0.0) tangent[(9 * (3 * i + j) + 3 * k + l) * ld + p] -= by / across;
          }
}
