/* Block matrices get their memory here, rows and columns of held unknowns are removed, and single blocks
 * inverted. */
#include "linalg/matrix.h"

#include <math.h>
#include <string.h>

#include "linalg/vectors.h"

enum { ARRAYS = 7, SLACK = 8 }; /* a SLACKth more room than asked for, because active nodes come and go */

typedef struct array {
  void **at;
  int64_t count;
  size_t size;
} array;

/* Lists the arrays with their sizes for the present capacities and block. */
static void arrays_of(mpmi_matrix *A, array *list) {
  const int64_t rows = A->row_capacity, entries = A->entry_capacity;
  const size_t block = (size_t)A->block;
  const array all[ARRAYS] = {{(void **)&A->row_start, rows + 1, sizeof *A->row_start},
                             {(void **)&A->column, entries, sizeof *A->column},
                             {(void **)&A->value, entries, block * block * sizeof *A->value},
                             {(void **)&A->held, rows, block * sizeof *A->held},
                             {(void **)&A->index, rows, sizeof *A->index},
                             {(void **)&A->number, rows, sizeof *A->number},
                             {(void **)&A->position, rows, 3 * sizeof *A->position}};
  memcpy(list, all, sizeof all);
}

void mpmi_matrix_init(mpmi_matrix *A, mpm_context *context) {
  memset(A, 0, sizeof *A);
  A->context = context;
  A->block = 1;
}

static void free_arrays(mpmi_matrix *A) {
  array list[ARRAYS];
  arrays_of(A, list);
  for (int32_t i = 0; i < ARRAYS; ++i) {
    mpmi_free(A->context, *list[i].at, mpmi_bytes(list[i].count, list[i].size));
    *list[i].at = NULL;
  }
  A->rows = A->row_capacity = A->entry_capacity = 0;
}

void mpmi_matrix_free(mpmi_matrix *A) {
  free_arrays(A);
  mpmi_matrix_init(A, A->context);
}

mpm_status mpmi_matrix_reserve(mpmi_matrix *A, int64_t rows, int64_t entries, int32_t block) {
  if (!A->row_start || block != A->block || rows > A->row_capacity || entries > A->entry_capacity) {
    free_arrays(A);
    A->block = block;
    A->row_capacity = rows + rows / SLACK;
    A->entry_capacity = entries + entries / SLACK;
    array list[ARRAYS];
    arrays_of(A, list);
    for (int32_t i = 0; i < ARRAYS; ++i) {
      *list[i].at = mpmi_alloc(A->context, mpmi_bytes(list[i].count, list[i].size));
      if (*list[i].at) continue;
      free_arrays(A);
      return MPM_E_NOMEM;
    }
  }
  A->rows = rows;
  return MPM_OK;
}

typedef struct eliminate_job {
  mpmi_matrix *A;
  mpmi_ranges ranges;
} eliminate_job;

static void eliminate_task(void *data, int64_t k) {
  const eliminate_job *job = data;
  mpmi_matrix *A = job->A;
  const int32_t block = A->block;
  for (int64_t i = mpmi_range_begin(&job->ranges, k); i < mpmi_range_begin(&job->ranges, k + 1); ++i)
    for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e) {
      const int64_t j = A->column[e];
      double *value = A->value + e * block * block;
      for (int32_t r = 0; r < block; ++r)
        for (int32_t c = 0; c < block; ++c)
          if (A->held[i * block + r] || A->held[j * block + c])
            value[r * block + c] = i == j && r == c ? 1.0 : 0.0;
    }
}

mpm_status mpmi_matrix_eliminate(mpmi_matrix *A) {
  eliminate_job job = {A, mpmi_ranges_of(A->rows, mpmi_matrix_unknowns(A))};
  return mpmi_run_ranges(A->context, &job.ranges, eliminate_task, &job);
}

/* The method is that of Gauss and Jordan, with row pivoting. */
int32_t mpmi_invert_block(int32_t n, double a[3][3]) {
  double inverse[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  for (int32_t c = 0; c < n; ++c) {
    int32_t pivot = c;
    for (int32_t r = c + 1; r < n; ++r)
      if (fabs(a[r][c]) > fabs(a[pivot][c])) pivot = r;
    if (!(fabs(a[pivot][c]) > 0.0)) return 0;
    for (int32_t k = 0; k < n; ++k) {
      const double row = a[pivot][k], inverse_row = inverse[pivot][k];
      a[pivot][k] = a[c][k];
      inverse[pivot][k] = inverse[c][k];
      a[c][k] = row;
      inverse[c][k] = inverse_row;
    }
    const double scale = 1.0 / a[c][c];
    for (int32_t k = 0; k < n; ++k) a[c][k] *= scale, inverse[c][k] *= scale;
    for (int32_t r = 0; r < n; ++r) {
      const double factor = a[r][c];
      for (int32_t k = 0; k < n && r != c; ++k) {
        a[r][k] -= factor * a[c][k];
        inverse[r][k] -= factor * inverse[c][k];
      }
    }
  }
  memcpy(a, inverse, sizeof inverse);
  return 1;
}
