/* Splitting: the particles that come of one share its mass and volume, and lie in the middle of the parts
 * of its domain.
 *
 * With transfers that carry a matrix velocities follow it, v_c = v + C (d_c - d), d the mean of the
 * distances d_c. Then sum_c m_c d_c x v_c is the angular momentum that the matrix gives to the distances,
 * with S = sum_c (m_c / m) d_c (x) (d_c - d), and the rest is left to the matrices: C_c D' = C (D - S),
 * where D is the second moment of the basis at the particle and D' the mean of those where its parts are. */
#include <math.h>

#include "adaption/adaption.h"
#include "particles/add.h"

enum { MOST_PARTS = 8 };

typedef struct parts {
  int32_t count;
  int64_t slot[MOST_PARTS];
  double share[MOST_PARTS]; /* of mass and volume */
  double away[MOST_PARTS][3], reference[MOST_PARTS][3];
} parts;

static void find_parts(const mpm_particles *set, const mpmi_splitting *split, int64_t first_new, parts *p) {
  const int32_t dim = set->grid->dim;
  const double *size = mpmi_f64(set, MPMI_SIZE, 0) + split->slot;
  *p = (parts){.count = 1};
  for (int32_t a = 0; a < dim; ++a) {
    if (!(split->edges & 1 << a)) continue;
    double edge[3];
    mpmi_domain_edge(set, 0, split->slot, a, edge);
    for (int32_t i = 0; i < p->count; ++i) {
      const int32_t other = i + p->count;
      memcpy(p->away[other], p->away[i], sizeof p->away[i]);
      memcpy(p->reference[other], p->reference[i], sizeof p->reference[i]);
      for (int32_t k = 0; k < dim; ++k) p->away[i][k] -= 0.25 * edge[k];
      for (int32_t k = 0; k < dim; ++k) p->away[other][k] += 0.25 * edge[k];
      p->reference[i][a] = -0.25 * size[a * set->ld];
      p->reference[other][a] = 0.25 * size[a * set->ld];
    }
    p->count *= 2;
  }
  /* rings have volumes by their radii before they were deformed */
  const double section = mpmi_is_axisymmetric(set->grid) ? size[0] * size[set->ld] : 0.0;
  const double radius = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0)[split->slot] / (section > 0.0 ? section : 1.0);
  for (int32_t i = 0; i < p->count; ++i) {
    p->slot[i] = i ? first_new + i - 1 : split->slot;
    double more = section > 0.0 ? p->reference[i][0] / radius : 0.0;
    if (fabs(more) > 0.5) more = more > 0.0 ? 0.5 : -0.5; /* the host's sizes need not fit its volumes */
    p->share[i] = (1.0 + more) / p->count;
  }
}

/* Gives a part everything that the particle has, and of amounts its share. */
static void give_fields(mpm_particles *set, int64_t from, int64_t to, double share) {
  for (int32_t f = 0; f < set->field_count; ++f) {
    mpmi_field *field = &set->field[f];
    if (!field->present || f == MPMI_ID) continue;
    const size_t size = mpmi_type_size(field->type);
    char *data = field->data[0];
    for (int32_t c = 0; c < field->components; ++c) {
      char *at = data + (size_t)(c * set->ld) * size;
      if (field->extensive)
        ((double *)(void *)at)[to] = share * ((double *)(void *)at)[from];
      else
        memmove(at + (size_t)to * size, at + (size_t)from * size, size);
    }
  }
}

static void place(mpm_particles *set, const mpmi_splitting *split, const parts *p, int32_t i) {
  const int64_t slot = p->slot[i];
  for (int32_t k = 0; k < set->grid->dim; ++k) {
    mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + slot] += p->away[i][k];
    if (set->field[MPMI_REFERENCE].present)
      mpmi_f64(set, MPMI_REFERENCE, 0)[k * set->ld + slot] += p->reference[i][k];
    if (split->edges & 1 << k) mpmi_f64(set, MPMI_SIZE, 0)[k * set->ld + slot] *= 0.5;
  }
  mpmi_wrap_slot(set, MPMI_POSITION, slot);
}

/* Returns C D' for all parts. */
static void share_matrix(const mpmi_motion_of *whole, const parts *p, const double *mean, double (*rest)[3]) {
  double S[3][3] = {{0.0}};
  for (int32_t i = 0; i < p->count; ++i)
    for (int32_t k = 0; k < 3; ++k)
      for (int32_t l = 0; l < 3; ++l) S[l][k] += p->share[i] * p->away[i][k] * (p->away[i][l] - mean[l]);
  for (int32_t r = 0; r < 3; ++r)
    for (int32_t k = 0; k < 3; ++k) {
      rest[r][k] = whole->C[r][k] * whole->D[k];
      for (int32_t l = 0; l < 3; ++l) rest[r][k] -= whole->C[r][l] * S[l][k];
    }
}

static void set_motions(mpmi_adaption *a, const mpmi_settings *settings, mpm_particles *set,
                        const mpmi_motion_of *whole, const parts *p) {
  const double least = 1e-12 * set->grid->h_min * set->grid->h_min;
  double here[MOST_PARTS][3] = {{0.0}}, mean[3] = {0.0}, D[3] = {0.0}, rest[3][3];
  for (int32_t i = 0; i < p->count; ++i) {
    if (mpmi_is_affine(settings)) mpmi_second_moments(settings, set, p->slot[i], here[i]);
    for (int32_t k = 0; k < 3; ++k) {
      mean[k] += p->share[i] * p->away[i][k];
      D[k] += p->share[i] * here[i][k];
    }
  }
  share_matrix(whole, p, mean, rest);
  mpmi_count_motion(set->grid, whole, whole->x, 1.0, a->lost);
  for (int32_t i = 0; i < p->count; ++i) {
    mpmi_motion_of part = *whole;
    part.mass = p->share[i] * whole->mass;
    for (int32_t r = 0; r < 3; ++r)
      for (int32_t k = 0; k < 3 && !mpmi_keeps_velocity(set, p->slot[i], r); ++k) {
        part.v[r] += whole->C[r][k] * (p->away[i][k] - mean[k]);
        if (D[k] > least) part.C[r][k] = rest[r][k] / D[k];
      }
    mpmi_write_motion(settings, set, p->slot[i], &part);
    for (int32_t k = 0; k < 3; ++k) {
      part.D[k] = here[i][k];
      part.x[k] = whole->x[k] + p->away[i][k];
    }
    mpmi_count_motion(set->grid, &part, whole->x, -1.0, a->lost);
  }
}

static int64_t count_added(const mpmi_adaption *a) {
  int64_t added = 0;
  for (int64_t i = 0; i < a->splits; ++i) added += mpmi_parts_of(a->split[i].edges) - 1;
  return added;
}

mpm_status mpmi_adaption_reserve(const mpmi_adaption *a, mpm_particles *set, int32_t copy) {
  const int64_t added = count_added(a);
  return added ? mpmi_append_reserve(set, added, 0, copy) : MPM_OK;
}

/* The free slots are known to be there: room has been made. */
void mpmi_adaption_split(mpmi_adaption *a, const mpmi_settings *settings, mpm_particles *set) {
  const int64_t added = count_added(a);
  parts p;
  if (!added) return;
  int64_t next = mpmi_append_apart(set, added);
  for (int64_t i = 0; i < a->splits; ++i) {
    const mpmi_splitting *split = &a->split[i];
    const mpmi_motion_of whole = mpmi_motion_in(settings, set, split->slot);
    find_parts(set, split, next, &p);
    for (int32_t k = p.count - 1; k >= 0; --k) give_fields(set, split->slot, p.slot[k], p.share[k]);
    for (int32_t k = 0; k < p.count; ++k) {
      place(set, split, &p, k);
      if (k) mpmi_i64(set, MPMI_ID, 0)[p.slot[k]] = set->next_id + split->before + k - 1;
    }
    set_motions(a, settings, set, &whole, &p);
    next += p.count - 1;
  }
  set->count += added;
}
