/* What the host adds to a scene: forces, prescribed velocities, hooks, laws, a linear solver. Of the C
 * library's functions only the square root, which is exact, so that its version changes no hash. */
#include "scene.h"

#include <math.h>
#include <stdlib.h>

static mpm_status add_force(void *user, const mpm_particle_batch *b, double *add) {
  const void *heat;
  int64_t stride;
  (void)user;
  if (mpm_batch_field(b->lookup, "heat", &heat, &stride)) return -1;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t p = 0; p < b->n; ++p) {
      const double moved =
          b->reference_position ? b->position[c * b->ld + p] - b->reference_position[c * b->ld + p] : 1.0;
      add[c * b->ld + p] += b->mass[p] * ((const double *)heat)[p] * (moved + b->t) / (1.0 + b->volume[p]);
    }
  return 0;
}

static mpm_status add_acceleration(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) add[p] += 20.0 + 900.0 * b->t - 0.5 * b->velocity[p];
  return 0;
}

/* Holds the last component of one node in 7. */
static mpm_status hold_some(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const int64_t last = b->dim - 1;
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    if ((b->index[i] + b->index[last * b->ld + i]) % 7 != 3) continue;
    prescribed[last * b->ld + i] = 1;
    velocity[last * b->ld + i] = (last ? 0.5 : 8.0) + 10.0 * b->t + 0.1 * b->position[i];
  }
  return 0;
}

static mpm_status lead(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t p = 0; p < b->n; ++p)
      add[c * b->ld + p] += (c ? 0.8 : 0.98) * b->velocity[c * b->ld + p] + 3.0 * b->dt;
  return 0;
}

static mpm_status hook(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    if (b->index[i] % 5 == 0) velocity[i] *= 0.995;
    force[(b->dim - 1) * b->ld + i] += 5.0 * b->mass[i] * b->position[i];
  }
  return 0;
}

/* ---- laws ----
 * tau = mu (b - J I) + lambda (J - 1) J I, of the energy mu / 2 (tr b - 3 - 2 (J - 1)) + lambda / 2 (J -
 * 1)^2.
 */
static const double mu = 1.2e5, lambda = 1.6e5, density = 1e3;
static const int32_t row_of[6] = {0, 1, 2, 0, 1, 0}, column_of[6] = {0, 1, 2, 1, 2, 2};

static double determinant(const mpm_material_batch *b, int64_t i) {
  double F[9];
  for (int32_t e = 0; e < 9; ++e) F[e] = b->F[e * b->ld + i];
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
         F[2] * (F[3] * F[7] - F[4] * F[6]);
}

static mpm_status stress(void *user, const mpm_material_batch *b) {
  const int32_t knows_energy = user != NULL;
  for (int64_t i = 0; i < b->n; ++i) {
    const double J = determinant(b, i);
    double trace = 0.0;
    for (int32_t c = 0; c < 6; ++c) {
      double left = 0.0;
      for (int32_t k = 0; k < 3; ++k)
        left += b->F[(3 * row_of[c] + k) * b->ld + i] * b->F[(3 * column_of[c] + k) * b->ld + i];
      if (c < 3) trace += left;
      b->stress_new[c * b->ld + i] = (mu * left + (c < 3 ? (lambda * (J - 1.0) - mu) * J : 0.0)) / J;
    }
    b->wave_speed[i] = sqrt((lambda + 2.0 * mu) / density);
    if (knows_energy)
      b->energy[i] = 0.5 * mu * (trace - 3.0 - 2.0 * (J - 1.0)) + 0.5 * lambda * (J - 1.0) * (J - 1.0);
    if (b->state_count) b->state_new[i] = b->state[i] + b->dt * (J - 1.0) * b->L[i];
  }
  return 0;
}

/* d tau / dL less its Lie part: lambda (2 J - 1) J I I - mu J I I + 2 (mu J - lambda (J - 1) J) of the
 * symmetric identity. */
static mpm_status tangent(void *user, const mpm_material_batch *b, double *out, int32_t *symmetric) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    const double J = determinant(b, i);
    const double volumetric = (lambda * (2.0 * J - 1.0) - mu) * J, shear = (mu - lambda * (J - 1.0)) * J;
    for (int32_t r = 0; r < 6; ++r)
      for (int32_t c = 0; c < 6; ++c)
        out[(6 * r + c) * b->ld + i] =
            (r < 3 && c < 3 ? volumetric : 0.0) + (r == c ? (r < 3 ? 2.0 : 1.0) * shear : 0.0);
  }
  *symmetric = 1;
  return 0;
}

mpm_status make_host_law(mpm_context *context, int32_t law, mpm_material **out) {
  static int32_t knows_energy = 1;
  static const double start = 0.25;
  mpm_material_desc d;
  mpm_material_desc_init(&d, sizeof d);
  d.density = density;
  d.stress = stress;
  if (law == LAW_HOST) {
    d.user = &knows_energy;
    d.state_count = 1;
    d.state_initial = &start;
  } else {
    d.tangent = tangent;
  }
  return mpm_material_create_custom(context, &d, out);
}

/* ---- the host's linear solver: conjugate gradients scaled by the diagonal ---- */
typedef struct vectors {
  double *scale, *residual, *scaled, *direction, *image;
} vectors;

static double product(const double *a, const double *b, int64_t n) {
  double sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

static void find_scale(const mpm_operator *matrix, int64_t n, double *scale) {
  const int64_t *start;
  const int32_t *column;
  const double *value;
  if (mpm_operator_csr(matrix, &start, &column, &value)) exit(1);
  for (int64_t r = 0; r < n; ++r)
    for (int64_t k = start[r]; k < start[r + 1]; ++k)
      if (column[k] == r) scale[r] = 1.0 / value[k];
}

static mpm_status iterate(const mpm_operator *matrix, int64_t n, const vectors *v, double *x, double bound,
                          int64_t *iterations) {
  double old = 0.0;
  for (*iterations = 0; *iterations < 10 * n; ++*iterations) {
    if (product(v->residual, v->residual, n) <= bound) return 0;
    for (int64_t i = 0; i < n; ++i) v->scaled[i] = v->scale[i] * v->residual[i];
    const double now = product(v->residual, v->scaled, n), share = *iterations ? now / old : 0.0;
    for (int64_t i = 0; i < n; ++i) v->direction[i] = v->scaled[i] + share * v->direction[i];
    if (mpm_operator_apply(matrix, v->direction, v->image)) return -1;
    const double length = now / product(v->direction, v->image, n);
    for (int64_t i = 0; i < n; ++i) {
      x[i] += length * v->direction[i];
      v->residual[i] -= length * v->image[i];
    }
    old = now;
  }
  return 1;
}

static mpm_status solve(void *user, const mpm_operator *matrix, const double *rhs, double *solution,
                        double tolerance, int64_t *iterations) {
  mpm_operator_info info = {.struct_size = sizeof info};
  (void)user;
  if (mpm_operator_get_info(matrix, &info)) return -1;
  const int64_t n = info.rows;
  double *memory = calloc((size_t)(5 * n) + 1, sizeof *memory);
  if (!memory) return -1;
  const vectors v = {memory, memory + n, memory + 2 * n, memory + 3 * n, memory + 4 * n};
  find_scale(matrix, n, v.scale);
  mpm_status status = mpm_operator_apply(matrix, solution, v.image);
  for (int64_t i = 0; i < n; ++i) v.residual[i] = rhs[i] - v.image[i];
  const double bound = tolerance * tolerance * product(rhs, rhs, n);
  if (!status) status = iterate(matrix, n, &v, solution, bound, iterations);
  free(memory);
  return status;
}

void set_callbacks(world *w) {
  const scene *is = w->is;
  mpm_stepper *s = w->stepper;
  const int32_t last = w->set[1] != NULL;
  if (is->with & WITH_FORCE) must(w, mpm_stepper_set_force(s, add_force, NULL));
  if (is->with & WITH_ACCELERATION) must(w, mpm_stepper_set_acceleration(s, add_acceleration, NULL));
  if (is->with & WITH_VELOCITY) must(w, mpm_stepper_set_velocity_bc(s, hold_some, NULL));
  if (is->with & WITH_MOTION) must(w, mpm_stepper_set_motion(s, w->set[last], lead, NULL));
  for (int32_t stage = MPM_AFTER_P2G; stage <= MPM_AFTER_VELOCITY; ++stage)
    if (is->with & WITH_HOOK << (stage - MPM_AFTER_P2G))
      must(w, mpm_stepper_set_node_hook(s, stage, hook, NULL));
  if (is->solver == MPM_SOLVER_HOST) must(w, mpm_stepper_set_linear_solver(s, solve, NULL));
}
