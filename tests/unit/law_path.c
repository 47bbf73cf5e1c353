#include "law_path.h"

#include "simd/elementary.h"

path path_of(const char *model, const mpm_param *params, int32_t count) {
  path s = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  s.material = law_material(MPM_ISA_BEST, model, params, count);
  return s;
}

void path_like(path *s, const path *other) {
  mpm_material *material = s->material;
  *s = *other;
  s->material = material;
}

void start(path *s, double mean) {
  for (int k = 0; k < 9; ++k) s->F[k] = k % 4 == 0;
  for (int k = 0; k < 6; ++k) s->stress[k] = k < 3 ? mean : 0.0;
  memset(s->state, 0, sizeof s->state);
}

mpm_status attempt(path *s, const double *F_inc) {
  double F[9] = {0};
  for (int i = 0; i < 9; ++i)
    for (int k = 0; k < 3; ++k) F[i] += F_inc[i / 3 * 3 + k] * s->F[3 * k + i % 3];
  mpm_material_batch b = {.struct_size = sizeof b,
                          .state_count = s->material->state_count,
                          .n = 1,
                          .ld = 1,
                          .dt = s->dt > 0.0 ? s->dt : 1.0,
                          .F = F,
                          .F_inc = F_inc,
                          .stress = s->stress,
                          .state = s->state,
                          .stress_new = s->stress,
                          .state_new = s->state,
                          .wave_speed = &s->wave,
                          .energy = &s->energy};
  const mpm_status status = mpm_material_update(s->material, &b, s->tangent, NULL);
  if (!status) memcpy(s->F, F, sizeof F);
  return status;
}

void advance(path *s, const double *F_inc) {
  ck_ok(s->material->context, attempt(s, F_inc));
}

void stretch(path *s, double x, double y, double z) {
  advance(s, (const double[]){mpmi_exp(x), 0, 0, 0, mpmi_exp(y), 0, 0, 0, mpmi_exp(z)});
}

void shear(path *s, double by, int32_t steps) {
  for (int32_t i = 0; i < steps; ++i) advance(s, (const double[]){1, by / steps, 0, 0, 1, 0, 0, 0, 1});
}

double jacobian_of(const path *s) {
  return s->F[0] * (s->F[4] * s->F[8] - s->F[5] * s->F[7]) -
         s->F[1] * (s->F[3] * s->F[8] - s->F[5] * s->F[6]) +
         s->F[2] * (s->F[3] * s->F[7] - s->F[4] * s->F[6]);
}

/* By Newton for the strain across. */
void triaxial(path *s, double axial, int32_t steps) {
  const double held = s->stress[0];
  double across = 0.0;
  for (int32_t i = 0; i < steps; ++i) {
    path end = *s;
    for (int32_t k = 0; k < 50; ++k) {
      const double h = 1e-7;
      path more = *s;
      end = *s;
      stretch(&end, across, across, axial / steps);
      stretch(&more, across + h, across + h, axial / steps);
      if (fabs(end.stress[0] - held) < 1e-9 * fabs(held)) break;
      across -= (end.stress[0] - held) * h / (more.stress[0] - end.stress[0]);
    }
    ck_within("stress across", end.stress[0], held, 1e-8 * fabs(held));
    *s = end;
  }
}

void ck_number(const char *what, double value, double wanted) {
  ck_within(what, value, wanted, 1e-9 * fabs(wanted) + 1e-9);
}

int sym_of(int i, int j) {
  return i == j ? i : i + j == 1 ? 3 : i + j == 3 ? 4 : 5;
}

double wide(uint64_t *seed, double low, double high) {
  return low + (high - low) * (double)(0.5L + 0.5L * uniform(seed));
}

invariants invariants_of(const path *s) {
  const double J = jacobian_of(s), p = -J * (s->stress[0] + s->stress[1] + s->stress[2]) / 3.0;
  double square = 0.0;
  for (int c = 0; c < 6; ++c) square += (c < 3 ? 1.0 : 2.0) * pow(J * s->stress[c] + (c < 3 ? p : 0.0), 2.0);
  return (invariants){p, sqrt(1.5 * square)};
}

double dissipated(const path *end, const path *trial, double shear, double bulk, double *digits) {
  const double J = jacobian_of(end);
  const invariants now = invariants_of(end), tried = invariants_of(trial);
  double work = 0.0;
  for (int c = 0; c < 6; ++c) {
    const double p = c < 3 ? now.p : 0.0, p_trial = c < 3 ? tried.p : 0.0, s = J * end->stress[c] + p;
    work += (c < 3 ? 1.0 : 2.0) * s * (J * trial->stress[c] + p_trial - s) / (2.0 * shear);
  }
  const double size = fabs(now.p) + now.q + fabs(tried.p) + tried.q;
  *digits = 1e-14 * size * (1.0 + size / shear); /* of strains, and of the stress */
  return work + now.p * ((tried.p - now.p) / bulk + end->state[1]);
}

double tangent_off(const path *from, const double *F_inc, regime_fn regime_of, int32_t *smooth) {
  static const double at[4] = {-2.0, -1.0, 1.0, 2.0}, by[4] = {1.0, -8.0, 8.0, -1.0};
  const double h = 1e-6;
  path end = *from;
  advance(&end, F_inc);
  const double J = jacobian_of(&end);
  const int32_t regime = regime_of(from, &end);
  double worst = 0.0;
  *smooth = 1;
  for (int kl = 0; kl < 9; ++kl) {
    const int k = kl / 3, l = kl % 3;
    double slope[6] = {0.0};
    for (int side = 0; side < 4; ++side) {
      double G[9];
      path other = *from;
      memcpy(G, F_inc, sizeof G);
      for (int c = 0; c < 3; ++c) G[3 * k + c] += at[side] * h * F_inc[3 * l + c];
      if (attempt(&other, G)) *smooth = 0;
      for (int c = 0; c < 6; ++c) slope[c] += by[side] / (12.0 * h) * jacobian_of(&other) * other.stress[c];
      if (regime_of(from, &other) != regime) *smooth = 0;
    }
    for (int ij = 0; ij < 9; ++ij) {
      const int i = ij / 3, j = ij % 3;
      double wanted = slope[sym_of(i, j)];
      if (i == k) wanted -= J * end.stress[sym_of(j, l)];
      if (j == k) wanted -= J * end.stress[sym_of(i, l)];
      worst = fmax(worst, fabs(end.tangent[9 * ij + kl] - wanted));
    }
  }
  return worst;
}

void ck_frame(const path *from, const double *F_inc, uint64_t *seed) {
  const tensor q = random_rotation(seed, 3);
  path s = *from, turned = *from;
  double other[9] = {0};
  for (int c = 0; c < 9; ++c)
    for (int i = 0; i < 3; ++i) other[c] += (double)q.m[c / 3][i] * F_inc[3 * i + c % 3];
  advance(&s, F_inc);
  advance(&turned, other);
  tensor t = {{{0}}};
  for (int c = 0; c < 9; ++c) t.m[c / 3][c % 3] = s.stress[sym_of(c / 3, c % 3)];
  t = multiply(q, multiply(t, transpose(q)));
  for (int c = 0; c < 6; ++c)
    ck_within("turned", turned.stress[c], (double)t.m[sym_row[c]][sym_column[c]], 1e-7);
  for (int c = 0; c < s.material->state_count; ++c)
    ck_within("state", turned.state[c], s.state[c], 1e-13 * (1.0 + fabs(s.state[c])));
}

static void ck_dimension(const mpm_material *m, int32_t dim, real mean, real stress, const double *state,
                         uint64_t *seed) {
  static tangent_batch flat, full;
  sample_clear(&flat.s, 0.5);
  sample_clear(&full.s, 0.5);
  for (int i = 0; i < ITEMS; ++i) {
    const tensor g = random_tensor(seed, dim, i % 2 ? 1e-2L : 1e-4L), f = combine(1, identity(), 1, g);
    const tensor t = combine(1, random_stress(seed, dim, stress), mean, identity());
    sample *const both[2] = {&flat.s, &full.s};
    for (int k = 0; k < 2; ++k) {
      sample_set_increment(both[k], i, g, f);
      sample_set_stress(both[k], k ? 3 : dim, i, t);
      for (int c = 0; c < m->state_count; ++c) both[k]->state[c * LD + i] = i % 5 ? 0.0 : state[c];
    }
  }
  tangent_run(&flat, m, dim);
  tangent_run(&full, m, 3);
  for (int i = 0; i < ITEMS; ++i) {
    ck_holds(sample_error(&flat.s, dim, i, sample_stress(&full.s, 3, i)) <= 1e-7L);
    for (int c = 0; c < m->state_count; ++c)
      ck_within("state", flat.s.state_new[c * LD + i], full.s.state_new[c * LD + i],
                1e-14 * (1.0 + fabs(full.s.state_new[c * LD + i])));
    ck_within("wave", flat.s.wave_speed[i], full.s.wave_speed[i], 1e-11 * full.s.wave_speed[i]);
    ck_within("energy", flat.s.energy[i], full.s.energy[i], 1e-7);
    for (int row = 0; row < 81; ++row)
      if (flat.c[row * LD + i] != sample_unset)
        ck_within("tangent", flat.c[row * LD + i], full.c[row * LD + i], 1e-7 * 4e7);
  }
}

void ck_dimensions(int32_t loop, const char *model, const mpm_param *params, int32_t count, real mean,
                   real stress, const double *state, uint64_t seed) {
  const int32_t dim = loop_dim(loop);
  mpm_material *m = law_material(loop_isa(loop), model, params, count);
  if (!m) return;
  for (int32_t round = 0; dim < 3 && round < 50; ++round) ck_dimension(m, dim, mean, stress, state, &seed);
  law_material_free(m);
}

void ck_frames(sample_fn draw, uint64_t seed) {
  for (int32_t k = 0; k < 500; ++k) {
    double F_inc[9];
    const path s = draw(&seed, F_inc);
    ck_frame(&s, F_inc, &seed);
    law_material_free(s.material);
  }
}

void random_increment(uint64_t *seed, double *F_inc) {
  const tensor g = random_tensor(seed, 3, uniform(seed) > 0 ? 0.02L : 1e-3L);
  for (int c = 0; c < 9; ++c) F_inc[c] = (double)((c % 4 == 0) + g.m[c / 3][c % 3]);
}
