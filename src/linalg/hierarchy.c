#include "linalg/hierarchy.h"

#include <string.h>

/* A level of COARSEST unknowns or less is factored and not coarsened. Where the next level would have more
 * than the share WORTH of the nodes, so is a level of FACTORED unknowns or less. */
enum { COARSEST = 800, FACTORED = 50 * COARSEST };
static const double WORTH = 0.7;

void mpmi_hierarchy_init(mpmi_hierarchy *h, mpm_context *context, int32_t alternating) {
  memset(h, 0, sizeof *h);
  for (int32_t l = 0; l < MPMI_MOST_LEVELS; ++l) mpmi_matrix_init(&h->level[l].own, context);
  mpmi_factor_init(&h->coarsest, context);
  h->level[0].next.alternating = alternating;
}

void mpmi_hierarchy_free(mpmi_hierarchy *h, mpm_context *context) {
  for (int32_t l = 0; l < MPMI_MOST_LEVELS; ++l) {
    mpmi_level *level = &h->level[l];
    mpmi_matrix_free(&level->own);
    mpmi_smoother_free(&level->smoother, context);
    mpmi_free(context, level->next.slab, (size_t)level->next.slab_capacity);
  }
  mpmi_factor_free(&h->coarsest);
  MPMI_FREE_ARRAY(context, h->rhs, h->coarsest_capacity);
}

mpm_status mpmi_hierarchy_analyse(mpmi_hierarchy *h, mpmi_level_memory *w, const mpmi_matrix *A) {
  mpm_status status = MPM_OK;
  h->coarsest.analysed = 0;
  h->level[0].A = A;
  for (h->levels = 1; h->levels < MPMI_MOST_LEVELS; ++h->levels) {
    mpmi_level *level = &h->level[h->levels - 1], *next = level + 1;
    if (mpmi_matrix_unknowns(level->A) <= COARSEST) break;
    if ((status = mpmi_coarsen(w, level, next, &level->next))) return status;
    if ((double)next->own.rows > WORTH * (double)level->A->rows && mpmi_matrix_unknowns(level->A) <= FACTORED)
      break;
    if (!level->next.alternating && (status = mpmi_smoother_analyse(&level->smoother, level->A)))
      return status;
  }
  const mpmi_matrix *last = h->level[h->levels - 1].A;
  const int64_t n = mpmi_matrix_unknowns(last);
  if ((status = mpmi_reserve(w->context, (void **)&h->rhs, &h->coarsest_capacity, 2 * n, sizeof *h->rhs)))
    return status;
  h->x = h->rhs + n;
  return mpmi_factor_analyse(&h->coarsest, last);
}

mpm_status mpmi_hierarchy_prepare(mpmi_hierarchy *h, mpmi_level_memory *w, const mpmi_matrix *A,
                                  int64_t *row) {
  mpm_status status = MPM_OK;
  *row = -1;
  h->level[0].A = A;
  for (int32_t l = 0; l + 1 < h->levels; ++l) {
    mpmi_level *level = &h->level[l];
    level[1].own.symmetric = A->symmetric;
    int64_t bad = -1;
    if (!level->next.alternating && (status = mpmi_smoother_numbers(&level->smoother, level->A, &bad)) && !l)
      *row = bad;
    if (status || (status = mpmi_galerkin(w, level->A, &level->next, &level[1].own))) return status;
  }
  const mpmi_matrix *last = h->level[h->levels - 1].A;
  int64_t bad = -1;
  if ((status = mpmi_factor_analyse(&h->coarsest, last))) return status; /* the symmetry may have changed */
  if ((status = mpmi_factor_numbers(&h->coarsest, last, &bad)) && h->levels == 1) *row = bad;
  if (status) return status;
  return A->symmetric && h->coarsest.negative ? MPM_SINGULAR : MPM_OK;
}
