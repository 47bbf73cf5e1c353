#include "linalg.h"

/* The same in every run: uniform in [-1, 1]. */
static double noise(uint64_t seed) {
  uint64_t z = (seed + 1) * UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
  return (double)(int64_t)(z ^ z >> 31) / 9223372036854775808.0;
}

static int64_t wrapped(const springs *of, int64_t axis, int64_t index) {
  if (axis || !of->periodic) return index;
  return (index + of->n[0]) % of->n[0];
}

/* Row of a node of the grid, or -1. */
static int64_t row_at(const springs *of, const int64_t *row, const int64_t *index) {
  int64_t at = 0;
  for (int32_t k = 0; k < of->dim; ++k) {
    const int64_t i = wrapped(of, k, index[k]);
    if (i < 0 || i >= of->n[k]) return -1;
    at = at * of->n[k] + i;
  }
  return row[at];
}

static void add_sorted(int32_t *list, int64_t *count, int32_t value) {
  int64_t at = *count;
  for (int64_t i = 0; i < *count; ++i)
    if (list[i] == value) return;
  for (; at > 0 && list[at - 1] > value; --at) list[at] = list[at - 1];
  list[at] = value;
  ++*count;
}

/* Columns of a row, ascending. */
static int64_t columns_of(const springs *of, const int64_t *row, const int64_t *index, int32_t *out) {
  int64_t count = 0;
  int64_t span[3] = {0, 0, 0};
  for (int32_t k = 0; k < (of->chains ? 1 : of->dim); ++k) span[k] = of->reach;
  for (int64_t dx = -span[0]; dx <= span[0]; ++dx)
    for (int64_t dy = -span[1]; dy <= span[1]; ++dy)
      for (int64_t dz = -span[2]; dz <= span[2]; ++dz) {
        const int64_t other[3] = {index[0] + dx, index[1] + dy, index[2] + dz};
        const int64_t j = row_at(of, row, other);
        if (j >= 0) add_sorted(out, &count, (int32_t)j);
      }
  return count;
}

static void spring(const springs *of, const mpmi_matrix *A, int64_t i, int64_t j, double block[3][3],
                   double *flow) {
  double e[3], length = 0.0;
  for (int32_t k = 0; k < 3; ++k) {
    e[k] = (double)(A->index[j][k] - A->index[i][k]);
    if (k == 0 && of->periodic && fabs(e[0]) > (double)of->reach)
      e[0] += e[0] > 0.0 ? -(double)of->n[0] : (double)of->n[0];
    length += e[k] * e[k];
  }
  const uint64_t low = (uint64_t)(i < j ? i : j), high = (uint64_t)(i < j ? j : i);
  const double stiffness = (1.0 + 0.5 * noise(low * 100003 + high)) / length;
  for (int32_t r = 0; r < 3; ++r)
    for (int32_t c = 0; c < 3; ++c) block[r][c] = stiffness * (e[r] * e[c] / length + (r == c ? 0.3 : 0.0));
  for (int32_t c = 0; c < 3; ++c)
    if (e[c] * e[c] == length) block[c][c] += of->stiff * stiffness;
  *flow = of->convection * e[0] / length;
}

static void set_values(mpmi_matrix *A, const springs *of) {
  const int32_t block = A->block;
  for (int64_t i = 0; i < A->rows; ++i) {
    double *diagonal = NULL;
    for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e) {
      memset(A->value + e * block * block, 0, (size_t)(block * block) * sizeof *A->value);
      if (A->column[e] == i) diagonal = A->value + e * block * block;
    }
    for (int32_t c = 0; c < block; ++c) diagonal[c * block + c] = of->mass;
    for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e) {
      double between[3][3], flow;
      if (A->column[e] == i) continue;
      spring(of, A, i, A->column[e], between, &flow);
      for (int32_t r = 0; r < block; ++r)
        for (int32_t c = 0; c < block; ++c) {
          A->value[(e * block + r) * block + c] = (r == c ? flow : 0.0) - between[r][c];
          diagonal[r * block + c] += between[r][c];
        }
    }
  }
}

/* Light nodes: S A S. */
static void make_light(mpmi_matrix *A, double light) {
  const int64_t area = A->block * A->block;
  for (int64_t i = 0; i < A->rows; ++i)
    for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e)
      for (int64_t c = 0; c < area; ++c)
        A->value[e * area + c] *= (i % 7 == 3 ? light : 1.0) * (A->column[e] % 7 == 3 ? light : 1.0);
}

void springs_build(mpmi_matrix *A, mpm_context *context, const springs *of) {
  int64_t n[3] = {1, 1, 1}, rows = 0, entries = 0;
  for (int32_t k = 0; k < of->dim; ++k) n[k] = of->n[k];
  int64_t *row = malloc((size_t)(n[0] * n[1] * n[2]) * sizeof *row);
  for (int64_t at = 0; at < n[0] * n[1] * n[2]; ++at)
    row[at] = of->holes && at % of->holes == of->holes - 1 ? -1 : rows++;
  int64_t width = 1;
  for (int32_t k = 0; k < of->dim; ++k) width *= 2 * of->reach + 1;
  mpmi_matrix_init(A, context);
  ck_ok(A->context, mpmi_matrix_reserve(A, rows, rows * width, of->block));
  A->symmetric = of->convection == 0.0;
  A->pattern_id = 1;
  A->period[0] = of->periodic ? n[0] : 0;
  for (int64_t at = 0; at < n[0] * n[1] * n[2]; ++at) {
    const int64_t i = row[at];
    if (i < 0) continue;
    const int64_t index[3] = {at / (n[1] * n[2]), at / n[2] % n[1], at % n[2]};
    for (int32_t k = 0; k < 3; ++k) {
      A->index[i][k] = index[k] - (k < of->dim ? of->below : 0);
      A->position[3 * i + k] = 0.1 * (double)index[k];
    }
    A->number[i] = 1000 + 7 * i;
    A->row_start[i] = entries;
    entries += columns_of(of, row, index, A->column + entries);
    for (int32_t c = 0; c < A->block; ++c)
      A->held[i * A->block + c] =
          (of->clamped && index[0] == 0) || (of->rollers && i % 11 == 5 && c == (i / 11) % A->block);
  }
  A->row_start[rows] = entries;
  set_values(A, of);
  if (of->light > 0.0) make_light(A, of->light);
  ck_ok(A->context, mpmi_matrix_eliminate(A));
  free(row);
}

double *noise_vector(const mpmi_matrix *A, uint64_t seed) {
  const int64_t n = mpmi_matrix_unknowns(A);
  double *x = malloc((size_t)n * sizeof *x);
  for (int64_t i = 0; i < n; ++i) x[i] = A->held[i] ? 0.0 : noise(seed * 1000003 + (uint64_t)i);
  return x;
}

double *rhs_for(const mpmi_matrix *A, const double *x) {
  double *b = malloc((size_t)mpmi_matrix_unknowns(A) * sizeof *b);
  ck_ok(A->context, mpmi_matrix_apply(A, x, b));
  return b;
}

double distance(int64_t n, const double *a, const double *b) {
  double away = 0.0, length = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    away += (a[i] - b[i]) * (a[i] - b[i]);
    length += b[i] * b[i];
  }
  return sqrt(away / length);
}

double *dense_of(const mpmi_matrix *A) {
  const int64_t n = mpmi_matrix_unknowns(A), block = A->block;
  double *a = calloc((size_t)(n * n), sizeof *a);
  for (int64_t i = 0; i < A->rows; ++i)
    for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e)
      for (int64_t r = 0; r < block; ++r)
        for (int64_t c = 0; c < block; ++c)
          a[(i * block + r) * n + A->column[e] * block + c] = A->value[(e * block + r) * block + c];
  return a;
}

void dense_solve(int64_t n, double *a, double *b) {
  for (int64_t k = 0; k < n; ++k) {
    int64_t pivot = k;
    for (int64_t r = k + 1; r < n; ++r)
      if (fabs(a[r * n + k]) > fabs(a[pivot * n + k])) pivot = r;
    for (int64_t c = 0; c < n; ++c) {
      const double swapped = a[k * n + c];
      a[k * n + c] = a[pivot * n + c];
      a[pivot * n + c] = swapped;
    }
    const double swapped = b[k];
    b[k] = b[pivot];
    b[pivot] = swapped;
    for (int64_t r = k + 1; r < n; ++r) {
      const double factor = a[r * n + k] / a[k * n + k];
      for (int64_t c = k; c < n; ++c) a[r * n + c] -= factor * a[k * n + c];
      b[r] -= factor * b[k];
    }
  }
  for (int64_t k = n - 1; k >= 0; --k) {
    for (int64_t c = k + 1; c < n; ++c) b[k] -= a[k * n + c] * b[c];
    b[k] /= a[k * n + k];
  }
}

static void turn(int64_t n, double *a, int64_t p, int64_t q) {
  const double off = a[p * n + q];
  if (fabs(off) < 1e-300) return;
  const double theta = (a[q * n + q] - a[p * n + p]) / (2.0 * off);
  const double t = (theta < 0.0 ? -1.0 : 1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
  const double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
  for (int64_t k = 0; k < n; ++k) {
    const double x = a[k * n + p], y = a[k * n + q];
    a[k * n + p] = c * x - s * y;
    a[k * n + q] = s * x + c * y;
  }
  for (int64_t k = 0; k < n; ++k) {
    const double x = a[p * n + k], y = a[q * n + k];
    a[p * n + k] = c * x - s * y;
    a[q * n + k] = s * x + c * y;
  }
}

int64_t dense_negative(int64_t n, double *a) {
  for (int32_t sweep = 0; sweep < 12; ++sweep)
    for (int64_t p = 0; p < n; ++p)
      for (int64_t q = p + 1; q < n; ++q) turn(n, a, p, q);
  int64_t negative = 0;
  for (int64_t k = 0; k < n; ++k) {
    ck_assert_double_gt(fabs(a[k * n + k]), 1e-6); /* too close to call */
    negative += a[k * n + k] < 0.0;
  }
  return negative;
}

mpmi_solve_job job_of(const mpmi_matrix *A, const double *b, double *x, int32_t choice) {
  memset(x, 0, (size_t)mpmi_matrix_unknowns(A) * sizeof *x);
  return (mpmi_solve_job){
      .matrix = A, .rhs = b, .x = x, .choice = choice, .tolerance = 1e-10, .expects_positive = 1};
}
