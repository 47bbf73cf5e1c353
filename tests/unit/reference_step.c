/* Steps by the book: MPoint theory eqs 28-44 (USL), Guilkey eqs 2-10 (USF), with the transfers of the
 * literature and no walls. Sums over nodes are over all nodes that a particle touches. */
#include "reference.h"

enum { MOST_ON_AXIS = 80, MOST_TOUCHED = 125 };

typedef struct touch {
  int32_t count, node[MOST_TOUCHED];
  double w[MOST_TOUCHED], g[MOST_TOUCHED][3], away[MOST_TOUCHED][3]; /* away: x_i - x_p */
  double moment[3];
} touch;

typedef struct sums {
  reference *r;
  reference_cloud *c;
  int32_t dim, nodes;
  touch *at;    /* [n] */
  double *mass; /* [nodes] */
  double (*v)[3], (*a)[3], (*v_new)[3];
} sums;

static double get(const reference_cloud *c, const double *field, int32_t component, int64_t p) {
  return field[component * c->n + p];
}

reference_cloud reference_take(const world *w, const mpm_particles *set) {
  reference_cloud c = {.n = mpm_particles_count(set)};
  c.x = fetch(w, set, "position", w->dim);
  c.v = fetch(w, set, "velocity", w->dim);
  c.a = calloc((size_t)(c.n * w->dim), sizeof *c.a);
  c.C = fetch(w, set, "velocity_gradient", 9);
  c.F = fetch(w, set, "deformation_gradient", 9);
  c.stress = fetch(w, set, "stress", 6);
  c.m = fetch(w, set, "mass", 1);
  c.V0 = fetch(w, set, "initial_volume", 1);
  c.size = fetch(w, set, "size", w->dim);
  c.J_bar = NULL;
  return c;
}

void reference_drop(reference_cloud *c) {
  free(c->x), free(c->v), free(c->a), free(c->C), free(c->F);
  free(c->stress), free(c->m), free(c->V0), free(c->size), free(c->J_bar);
}

static void tensor_of(const reference_cloud *c, const double *field, int64_t p, double *T) {
  for (int32_t i = 0; i < 9; ++i) T[i] = get(c, field, i, p);
}

static double volume_of(const reference_cloud *c, int64_t p) {
  double F[9];
  tensor_of(c, c->F, p, F);
  return determinant(F) * c->V0[p];
}

void reference_stress(double E, double nu, const double *F, double *stress) {
  static const int32_t row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
  const double mu = E / (2.0 * (1.0 + nu)), lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu), J = determinant(F);
  for (int32_t s = 0; s < 6; ++s) {
    double b = 0.0;
    for (int32_t k = 0; k < 3; ++k) b += F[3 * row[s] + k] * F[3 * column[s] + k];
    stress[s] = (s < 3 ? lambda * log(J) + mu * (b - 1.0) : mu * b) / J;
  }
}

mpm_status reference_law_stress(void *user, const mpm_material_batch *b) {
  const reference_law *law = user;
  for (int64_t p = 0; p < b->n; ++p) {
    double F[9], stress[6];
    for (int32_t c = 0; c < 9; ++c) F[c] = b->F[c * b->ld + p];
    reference_stress(law->E, law->nu, F, stress);
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + p] = stress[c];
    b->wave_speed[p] = law->wave_speed;
  }
  return MPM_OK;
}

/* ---- weights of the step ---- */
static void touch_nodes(sums *s, int64_t p) {
  const mpm_grid_desc *grid = &s->r->grid;
  touch *t = &s->at[p];
  double w[3][MOST_ON_AXIS], g[3][MOST_ON_AXIS], away[3][MOST_ON_AXIS];
  int32_t count[3] = {1, 1, 1};
  for (int32_t k = 0; k < 3; ++k) w[k][0] = 1.0, g[k][0] = away[k][0] = 0.0, t->moment[k] = 0.0;
  for (int32_t k = 0; k < s->dim; ++k) {
    const reference_axis axis = reference_axis_of(grid, k);
    const double x = get(s->c, s->c->x, k, p);
    const double edge = reference_edge(grid, k, get(s->c, s->c->size, k, p), get(s->c, s->c->F, 4 * k, p));
    count[k] = (int32_t)(reference_last(&axis) - reference_first(&axis)) + 1;
    ck_assert_int_le(count[k], MOST_ON_AXIS);
    for (int32_t i = 0; i < count[k]; ++i) {
      const int64_t index = reference_first(&axis) + i;
      reference_function(&axis, index, x, edge, &w[k][i], &g[k][i]);
      away[k][i] = reference_node(&axis, index) - x;
      t->moment[k] += w[k][i] * away[k][i] * away[k][i];
    }
  }
  t->count = 0;
  for (int32_t node = 0; node < count[0] * count[1] * count[2]; ++node) {
    const int32_t i[3] = {node / (count[1] * count[2]), node / count[2] % count[1], node % count[2]};
    int32_t none = 0;
    for (int32_t k = 0; k < s->dim; ++k) none |= w[k][i[k]] == 0.0 && g[k][i[k]] == 0.0;
    if (none) continue;
    const int32_t q = t->count++;
    ck_assert_int_lt(q, MOST_TOUCHED);
    t->node[q] = node;
    t->w[q] = w[0][i[0]] * w[1][i[1]] * w[2][i[2]];
    for (int32_t k = 0; k < 3; ++k) {
      t->g[q][k] = k < s->dim ? g[k][i[k]] : 0.0;
      for (int32_t j = 0; j < 3; ++j)
        if (j != k) t->g[q][k] *= w[j][i[j]];
      t->away[q][k] = away[k][i[k]];
    }
    if (s->r->stepper.transfer != MPM_APIC_MLS) continue;
    for (int32_t k = 0; k < s->dim; ++k) t->g[q][k] = t->w[q] * t->away[q][k] / t->moment[k];
  }
  s->nodes = count[0] * count[1] * count[2];
}

/* ---- between particles and nodes ---- */
/* nodal mean of v, with the matrix of the transfer */
static void project(const sums *s, const double *v, int32_t matrix, double (*out)[3]) {
  memset(out, 0, (size_t)s->nodes * sizeof *out);
  for (int64_t p = 0; p < s->c->n; ++p)
    for (int32_t q = 0; q < s->at[p].count; ++q)
      for (int32_t k = 0; k < s->dim; ++k) {
        double value = get(s->c, v, k, p);
        for (int32_t j = 0; j < s->dim && matrix; ++j)
          value += get(s->c, s->c->C, 3 * k + j, p) * s->at[p].away[q][j];
        out[s->at[p].node[q]][k] += s->c->m[p] * s->at[p].w[q] * value;
      }
  for (int32_t i = 0; i < s->nodes; ++i)
    for (int32_t k = 0; k < s->dim; ++k) out[i][k] = s->mass[i] > 0.0 ? out[i][k] / s->mass[i] : 0.0;
}

static double interpolate(const sums *s, int64_t p, double (*v)[3], int32_t k) {
  double sum = 0.0;
  for (int32_t q = 0; q < s->at[p].count; ++q) sum += s->at[p].w[q] * v[s->at[p].node[q]][k];
  return sum;
}

static void gradient(const sums *s, int64_t p, double (*v)[3], double *L) {
  for (int32_t c = 0; c < 9; ++c) {
    L[c] = 0.0;
    for (int32_t q = 0; q < s->at[p].count && c / 3 < s->dim && c % 3 < s->dim; ++q)
      L[c] += v[s->at[p].node[q]][c / 3] * s->at[p].g[q][c % 3];
  }
}

static void sum_masses(sums *s) {
  for (int64_t p = 0; p < s->c->n; ++p)
    for (int32_t q = 0; q < s->at[p].count; ++q) s->mass[s->at[p].node[q]] += s->c->m[p] * s->at[p].w[q];
}

static void accelerate(const sums *s, double dt) {
  static const int32_t voigt[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
  memset(s->a, 0, (size_t)s->nodes * sizeof *s->a);
  for (int64_t p = 0; p < s->c->n; ++p) {
    const double V = volume_of(s->c, p);
    for (int32_t q = 0; q < s->at[p].count; ++q)
      for (int32_t k = 0; k < s->dim; ++k) {
        double force = s->at[p].w[q] * s->c->m[p] * s->r->stepper.gravity[k];
        for (int32_t j = 0; j < s->dim; ++j)
          force -= V * get(s->c, s->c->stress, voigt[3 * k + j], p) * s->at[p].g[q][j];
        s->a[s->at[p].node[q]][k] += force;
      }
  }
  for (int32_t i = 0; i < s->nodes; ++i)
    for (int32_t k = 0; k < s->dim; ++k) {
      s->a[i][k] = s->mass[i] > 0.0 ? s->a[i][k] / s->mass[i] : 0.0;
      s->v_new[i][k] = s->v[i][k] + dt * s->a[i][k];
    }
}

/* ---- stages ---- */
/* F of the step that the law sees: dilation averaged over the cell where the remedy is on. */
static void average_dilation(const sums *s, const double *dilation, const double *V) {
  const mpm_grid_desc *grid = &s->r->grid;
  int64_t *cell = calloc((size_t)s->c->n, sizeof *cell);
  for (int64_t p = 0; p < s->c->n; ++p)
    for (int32_t k = 0; k < s->dim; ++k)
      cell[p] =
          1000 * cell[p] + (int64_t)floor((get(s->c, s->c->x, k, p) - grid->origin[k]) / grid->spacing[k]);
  for (int64_t p = 0; p < s->c->n; ++p) {
    double above = 0.0, below = 0.0;
    for (int64_t q = 0; q < s->c->n; ++q)
      if (cell[q] == cell[p]) above += V[q] * dilation[q], below += V[q];
    s->c->J_bar[p] *= above / below;
  }
  free(cell);
}

static void deform(const sums *s, double (*v)[3], double dt) {
  reference_cloud *c = s->c;
  double *dilation = malloc((size_t)(2 * c->n) * sizeof *dilation), *V = dilation + c->n;
  for (int64_t p = 0; p < c->n; ++p) {
    double L[9], F[9], now[9], increment[9];
    gradient(s, p, v, L);
    tensor_of(c, c->F, p, F);
    V[p] = volume_of(c, p);
    for (int32_t i = 0; i < 9; ++i) increment[i] = (i % 4 == 0) + dt * L[i];
    for (int32_t i = 0; i < 9; ++i) {
      now[i] = 0.0;
      for (int32_t k = 0; k < 3; ++k) now[i] += increment[i / 3 * 3 + k] * F[3 * k + i % 3];
      c->F[i * c->n + p] = now[i];
    }
    dilation[p] = determinant(increment);
  }
  if (c->J_bar) average_dilation(s, dilation, V);
  for (int64_t p = 0; p < c->n; ++p) {
    double F[9], stress[6];
    tensor_of(c, c->F, p, F);
    const double factor = c->J_bar ? pow(c->J_bar[p] / determinant(F), 1.0 / s->dim) : 1.0;
    for (int32_t i = 0; i < 9; ++i)
      if (i / 3 < s->dim && i % 3 < s->dim) F[i] *= factor;
    reference_stress(s->r->E, s->r->nu, F, stress);
    for (int32_t i = 0; i < 6; ++i) c->stress[i * c->n + p] = stress[i];
  }
  free(dilation);
}

/* V - (I - S S+)^m V, particle values [dim][n] */
static double *filtered(const sums *s, const double *v, int32_t m) {
  const size_t bytes = (size_t)(s->c->n * s->dim) * sizeof(double);
  double *rest = malloc(bytes), *result = malloc(bytes),
         (*nodes)[3] = malloc((size_t)s->nodes * sizeof *nodes);
  memcpy(rest, v, bytes);
  for (int32_t i = 0; i < m; ++i) {
    project(s, rest, 0, nodes);
    for (int32_t k = 0; k < s->dim; ++k)
      for (int64_t p = 0; p < s->c->n; ++p) rest[k * s->c->n + p] -= interpolate(s, p, nodes, k);
  }
  for (int64_t i = 0; i < s->c->n * s->dim; ++i) result[i] = v[i] - rest[i];
  free(rest), free(nodes);
  return result;
}

/* Sum over the first terms of the series (I - S+ S)^l v, of nodal velocities. */
static double (*full_velocities(const sums *s, int32_t terms))[3] {
  const size_t bytes = (size_t)s->nodes * sizeof(double[3]);
  double(*sum)[3] = calloc(1, bytes), (*term)[3] = malloc(bytes), (*again)[3] = malloc(bytes);
  double *v = malloc((size_t)(s->c->n * s->dim) * sizeof *v);
  memcpy(term, s->v_new, bytes);
  for (int32_t l = 0; l < terms; ++l) {
    for (int64_t i = 0; i < s->nodes; ++i)
      for (int32_t k = 0; k < s->dim; ++k) sum[i][k] += term[i][k];
    for (int64_t p = 0; p < s->c->n; ++p)
      for (int32_t k = 0; k < s->dim; ++k) v[k * s->c->n + p] = interpolate(s, p, term, k);
    project(s, v, 0, again);
    for (int64_t i = 0; i < s->nodes; ++i)
      for (int32_t k = 0; k < s->dim; ++k) term[i][k] -= again[i][k];
  }
  free(term), free(again), free(v);
  return sum;
}

static void affine_matrix(const sums *s, int64_t p, double *C) {
  const touch *t = &s->at[p];
  for (int32_t c = 0; c < 9; ++c) {
    C[c] = 0.0;
    for (int32_t q = 0; q < t->count && c / 3 < s->dim && c % 3 < s->dim; ++q)
      C[c] += t->w[q] * s->v_new[t->node[q]][c / 3] * t->away[q][c % 3] / t->moment[c % 3];
  }
}

/* Velocities and positions; x_new is kept apart, because weights belong to the
 * old ones. dt_v: of velocities. */
static void move(const sums *s, double dt, double dt_v, double *x_new) {
  const mpm_stepper_desc *d = &s->r->stepper;
  reference_cloud *c = s->c;
  const int32_t between = d->xpic_every > 1 && (s->r->steps + 1) % d->xpic_every;
  double *kept = d->transfer == MPM_XPIC && !between ? filtered(s, c->v, d->xpic_order) : NULL;
  double(*full)[3] = d->transfer == MPM_FMPM && !between ? full_velocities(s, d->xpic_order) : NULL;
  double share = 0.0; /* of FLIP */
  if (d->transfer == MPM_FLIP || d->transfer == MPM_TFLIP || d->transfer == MPM_AFLIP || between)
    share = d->flip * fmax(0.0, 1.0 - d->pic_damping * dt_v);
  for (int64_t p = 0; p < c->n; ++p) {
    double matrix[9];
    for (int32_t k = 0; k < s->dim; ++k) {
      const int64_t i = k * c->n + p;
      const double v_new = interpolate(s, p, s->v_new, k), v_old = interpolate(s, p, s->v, k);
      const double a = interpolate(s, p, s->a, k), before = c->v[i];
      c->v[i] = kept   ? kept[i] + dt_v * a
                : full ? interpolate(s, p, full, k)
                       : v_new + share * (before - v_old);
      c->a[i] = (c->v[i] - before) / dt_v;
      x_new[i] = c->x[i] + (d->projected_positions ? 0.0 : dt * v_new) -
                 (d->position_order == 2 ? 0.5 * dt * dt * a : 0.0);
    }
    if (d->transfer == MPM_TPIC || d->transfer == MPM_TFLIP)
      gradient(s, p, s->v_new, matrix);
    else
      affine_matrix(s, p, matrix);
    for (int32_t i = 0; i < 9 && carries_matrix(d->transfer); ++i) c->C[i * c->n + p] = matrix[i];
  }
  free(kept), free(full);
}

static void prepare(sums *s) {
  s->at = malloc((size_t)s->c->n * sizeof *s->at);
  for (int64_t p = 0; p < s->c->n; ++p) touch_nodes(s, p);
  const size_t nodes = (size_t)s->nodes;
  s->mass = calloc(nodes, sizeof *s->mass);
  s->v = calloc(nodes, sizeof *s->v);
  s->a = calloc(nodes, sizeof *s->a);
  s->v_new = calloc(nodes, sizeof *s->v_new);
  sum_masses(s);
}

void reference_step(reference *r, reference_cloud *c, double dt) {
  const mpm_stepper_desc *d = &r->stepper;
  const int32_t matrix = carries_matrix(d->transfer);
  sums s = {.r = r, .c = c, .dim = r->grid.dim};
  if (d->locking_remedy && !c->J_bar) {
    c->J_bar = malloc((size_t)c->n * sizeof *c->J_bar);
    for (int64_t p = 0; p < c->n; ++p) c->J_bar[p] = volume_of(c, p) / c->V0[p];
  }
  const double dt_v = d->staggered && r->last_dt > 0.0 ? 0.5 * (r->last_dt + dt) : dt;
  const size_t bytes = (size_t)(c->n * s.dim) * sizeof(double);
  double *x_new = malloc(bytes);
  prepare(&s);
  project(&s, c->v, matrix, s.v);
  if (d->scheme == MPM_USF) deform(&s, s.v, dt);
  accelerate(&s, dt_v);
  move(&s, dt, dt_v, x_new);
  if (d->scheme == MPM_USL) deform(&s, s.v_new, dt);
  if (d->scheme == MPM_MUSL) {
    project(&s, c->v, matrix, s.v);
    deform(&s, s.v, dt);
    for (int64_t p = 0; p < c->n && d->projected_positions; ++p)
      for (int32_t k = 0; k < s.dim; ++k) x_new[k * c->n + p] += dt * interpolate(&s, p, s.v, k);
  }
  memcpy(c->x, x_new, bytes);
  r->last_dt = dt;
  ++r->steps;
  free(x_new), free(s.at), free(s.mass), free(s.v), free(s.a), free(s.v_new);
}
