/* Surfaces that prescribe velocities, in implicit steps (docs/theory.md, 18.6): springs between markers and
 * material, of the stiffness k = beta A, beta = penalty modulus / h, and the stretch
 *
 *   d = d0 + sum w_i u_i - dt g
 *
 * with the stretch d0 at the start of the step, and the force -k d, whose stiffness is k w_a w_b 1. Where the
 * material slides, with the normal n of the marker and its change H along the surface, they are
 *
 *   d = n . d0 + n . m + m . H m / 2,   m = sum w_i u_i - dt g,   -k d n',   k w_a w_b (n' (x) n' + d H),
 *   n' = n + H m
 *
 * As contact it acts wholly at the end of the step: the accelerations at its start have nothing of it. */
#include "implicit/active_set.h"
#include "implicit/surface_springs.h"
#include "context/transport.h"
#include "stages/stages.h"

#include <math.h>
#include <string.h>

static int32_t reaches_material(const mpmi_marker_nodes *around, int64_t marker) {
  int32_t reaches = 0;
  for (int64_t n = marker * around->nodes; n < (marker + 1) * around->nodes; ++n)
    reaches |= around->slot[n] >= 0;
  return reaches;
}

mpm_status mpmi_springs_find(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  double any = 0.0;
  balance->newton->has_springs = balance->newton->springs_measure = 0;
  if (!mpmi_surfaces_prescribe(list)) return MPM_OK;
  for (int64_t i = 0; i < list->count; ++i) {
    mpm_surface *s = list->surface[i];
    for (int64_t k = 0; k < s->next.count && mpmi_surface_prescribes(s); ++k) {
      const int32_t springs = s->aim[k].stiffness < 0.0 && mpmi_marker_size(&s->next.at[k], s->grid) > 0.0 &&
                              reaches_material(&s->around, k);
      if (springs) any = 1.0;
      if (!springs) s->aim[k].stiffness = 0.0;
    }
  }
  const mpm_status status = mpmi_largest_of_parts(balance, 1, &any);
  balance->newton->has_springs = any > 0.0;
  return status;
}

/* ---- stiffness ----------------------------------------------------------------------------------------- */
/* Returns the largest density times wave speed squared of the particles of a body, as the law has just given
 * them. */
static double largest_modulus(const mpmi_balance *balance, int32_t body) {
  double most = 0.0;
  for (int32_t m = 0; m < balance->layout->member_count; ++m) {
    const mpm_particles *set = balance->layout->member[m].set;
    const double *mass = mpmi_f64(set, MPMI_MASS, 0), *volume = mpmi_f64(set, MPMI_VOLUME, 0);
    const double *speed = balance->step->work->rows.of[m].wave_speed;
    const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
    if (balance->layout->member[m].body != body) continue;
    for (int64_t p = 0; p < set->slots; ++p)
      if (id[p] >= 0) most = fmax(most, mass[p] / volume[p] * speed[p] * speed[p]);
  }
  return most;
}

/* Gives the springs of a surface their stiffness; of several parts each knows some of the springs. */
static mpm_status stiffen_surface(mpmi_balance *balance, mpm_surface *s) {
  double most[2] = {0.0, s->desc.modulus}; /* whether there are springs, and the modulus */
  for (int64_t k = 0; k < s->next.count; ++k)
    if (s->aim[k].stiffness < 0.0) most[0] = 1.0;
  if (!(most[1] > 0.0)) most[1] = largest_modulus(balance, s->desc.body);
  const mpm_status status = mpmi_largest_of_parts(balance, 2, most);
  if (status) return status;
  if (most[0] > 0.0 && !(most[1] > 0.0))
    return mpmi_fail(balance->settings->context, MPM_SINGULAR,
                     "surface %d prescribes how body %d moves, whose particles have no wave speed from which "
                     "its stiffness follows: set mpm_surface_desc.modulus",
                     (int)s->number, (int)s->desc.body);
  for (int64_t k = 0; k < s->next.count; ++k)
    if (s->aim[k].stiffness < 0.0)
      s->aim[k].stiffness =
          s->desc.penalty * most[1] / s->grid->h_min * mpmi_marker_size(&s->next.at[k], s->grid);
  return MPM_OK;
}

int32_t mpmi_springs_lack_stiffness(const mpmi_balance *balance) {
  return balance->newton->has_springs && !balance->newton->springs_measure;
}

mpm_status mpmi_springs_begin(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < list->count && !status; ++i)
    if (mpmi_surface_prescribes(list->surface[i])) status = stiffen_surface(balance, list->surface[i]);
  balance->newton->springs_measure = !status;
  return status;
}

/* ---- forces -------------------------------------------------------------------------------------------- */
/* A spring as it is: the displacement of the material at the marker, the same relative to the marker, what
 * it is stretched by, and where material slides the length of that and the normal. */
typedef struct spring {
  double moved[3], past[3], stretch[3], length, normal[3];
} spring;

static void find_stretch(const mpmi_balance *balance, const mpm_surface *s, int64_t k, spring *to) {
  const mpmi_marker_nodes *around = &s->around;
  const mpmi_marker_aim *aim = &s->aim[k];
  const double dt = balance->step->dt;
  const int32_t dim = s->grid->dim;
  *to = (spring){.length = 0.0};
  for (int64_t n = k * around->nodes; n < (k + 1) * around->nodes; ++n)
    for (int32_t c = 0; c < dim && around->slot[n] >= 0; ++c)
      to->moved[c] += around->weight[n] * dt * mpmi_velocity(&balance->nodes->solved, around->slot[n])[c];
  for (int32_t c = 0; c < dim; ++c) {
    to->past[c] = to->moved[c] - dt * aim->velocity[c];
    to->stretch[c] = s->now.at[k].gap[c] + to->past[c];
    to->length += aim->normal[c] * to->stretch[c];
  }
  if (s->desc.prescribes != MPM_PRESCRIBES_NORMAL) return;
  for (int32_t c = 0; c < dim; ++c) {
    const double turned = mpmi_inner(aim->curvature[c], to->past);
    to->length += 0.5 * turned * to->past[c];
    to->normal[c] = aim->normal[c] + turned;
  }
  for (int32_t c = 0; c < dim; ++c) to->stretch[c] = to->length * to->normal[c];
}

void mpmi_springs_pull(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  double *to = newton->vector[MPMI_SPRINGS];
  memset(to, 0, (size_t)(newton->matrix.rows * dim) * sizeof *to);
  for (int64_t i = 0; i < list->count && newton->has_springs; ++i) {
    const mpm_surface *s = list->surface[i];
    for (int64_t k = 0; k < s->next.count && mpmi_surface_prescribes(s); ++k) {
      spring is;
      if (!(s->aim[k].stiffness > 0.0)) continue;
      find_stretch(balance, s, k, &is);
      for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes; ++n) {
        if (s->around.slot[n] < 0) continue;
        const mpmi_active_node *node = &newton->active[newton->active_of[s->around.slot[n]]];
        for (int32_t c = 0; c < dim; ++c)
          to[(int64_t)node->row * dim + c] -=
              node->sign[c] * s->around.weight[n] * s->aim[k].stiffness * is.stretch[c];
      }
    }
  }
}

/* Adds the block of two nodes of a spring. */
static void add_block(mpmi_newton *newton, const mpm_surface *s, int64_t k, const spring *is, int64_t a,
                      int64_t b) {
  const mpmi_active_node *A = &newton->active[newton->active_of[s->around.slot[a]]];
  const mpmi_active_node *B = &newton->active[newton->active_of[s->around.slot[b]]];
  const mpmi_marker_aim *aim = &s->aim[k];
  const int32_t dim = s->grid->dim, whole = s->desc.prescribes == MPM_PRESCRIBES_VELOCITY;
  const double by = aim->stiffness * s->around.weight[a] * s->around.weight[b];
  if (!mpmi_is_kept(newton, A->row)) return;
  const int64_t entry = mpmi_matrix_entry(&newton->matrix, A->row, B->row);
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) {
      const double part =
          whole ? (i == j ? 1.0 : 0.0) : is->normal[i] * is->normal[j] + is->length * aim->curvature[i][j];
      newton->matrix.value[(entry * dim + i) * dim + j] += A->sign[i] * B->sign[j] * by * part;
    }
}

static void stiffen_marker_spring(mpmi_balance *balance, const mpm_surface *s, int64_t k) {
  const int64_t first = k * s->around.nodes, end = first + s->around.nodes;
  spring is;
  find_stretch(balance, s, k, &is);
  for (int64_t a = first; a < end; ++a)
    for (int64_t b = first; b < end && s->around.slot[a] >= 0; ++b)
      if (s->around.slot[b] >= 0) add_block(balance->newton, s, k, &is, a, b);
}

void mpmi_springs_stiffen(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  for (int64_t i = 0; i < list->count && balance->newton->has_springs; ++i) {
    const mpm_surface *s = list->surface[i];
    for (int64_t k = 0; k < s->next.count && mpmi_surface_prescribes(s); ++k)
      if (s->aim[k].stiffness > 0.0) stiffen_marker_spring(balance, s, k);
  }
}

/* ---- the end of the step ------------------------------------------------------------------------------- */
/* A mirrored ghost turns a force round on its way to the node that moves: what is lost of it the wall has. */
static void tell_walls(mpmi_balance *balance, const mpm_surface *s, int64_t k, const double *force) {
  const mpmi_constraints *constraints = &balance->layout->constraints;
  const mpmi_newton *newton = balance->newton;
  const double share = mpmi_contact_share(balance);
  for (int64_t n = k * s->around.nodes; n < (k + 1) * s->around.nodes; ++n) {
    if (s->around.slot[n] < 0 || constraints->tie_of[s->around.slot[n]] < 0) continue;
    const mpmi_tie *tie = &constraints->tie[constraints->tie_of[s->around.slot[n]]];
    const mpmi_active_node *node = &newton->active[newton->active_of[s->around.slot[n]]];
    for (int32_t c = 0; c < s->grid->dim; ++c) {
      if (tie->face[c] < 0 || mpmi_held_by(balance->nodes, tie->master, c)) continue;
      const double given = share * s->around.weight[n] * force[c];
      mpmi_exact_add(&balance->step->work->tally.sum[MPMI_TALLY_FACES + 3 * tie->face[c] + c],
                     -balance->step->dt * (1.0 - node->sign[c]) * given);
    }
  }
}

/* A marker along which material has slid meets other material, which has not stretched its spring: that of
 * the way of one cell is all that stays. What is stretched by normals that are not quite right stays small
 * so. */
static double kept_of(const mpm_surface *s, const spring *is) {
  const double along = mpmi_inner(is->normal, is->past);
  double square = 0.0;
  if (s->desc.prescribes != MPM_PRESCRIBES_NORMAL) return 1.0;
  for (int32_t c = 0; c < 3; ++c)
    square += (is->past[c] - along * is->normal[c]) * (is->past[c] - along * is->normal[c]);
  const double kept = 1.0 - sqrt(square) / s->grid->h_min;
  return kept > 0.0 ? kept : 0.0;
}

/* What a spring came to, as the parts tell each other. */
typedef struct spring_end {
  double stiffness, kept, stretch[3], moved[3];
} spring_end;
enum { END_WORDS = sizeof(spring_end) / sizeof(int64_t) };
_Static_assert((int)END_WORDS <= (int)MPMI_MARKER_MOTION, "there is room for it");

static void find_end(const mpmi_balance *balance, const mpm_surface *s, int64_t k, spring_end *to) {
  spring is = {.length = 0.0};
  if (s->aim[k].stiffness > 0.0) find_stretch(balance, s, k, &is);
  *to = (spring_end){.stiffness = s->aim[k].stiffness, .kept = kept_of(s, &is)};
  memcpy(to->stretch, is.stretch, sizeof to->stretch);
  memcpy(to->moved, is.moved, sizeof to->moved);
}

/* Lets all parts know what the springs of a surface came to: of each one part adds its bits to zeros. */
static mpm_status tell_ends(const mpmi_balance *balance, mpm_surface *s) {
  for (int64_t k = 0; k < s->next.count; ++k) {
    spring_end end = {.stiffness = 0.0};
    if (mpmi_owns_marker(balance->step, s, k)) find_end(balance, s, k, &end);
    memcpy(&s->told[END_WORDS * k], &end, sizeof end);
  }
  return s->next.count ? mpmi_reduce_parts(s->context, MPM_REDUCE_SUM, END_WORDS * s->next.count, s->told)
                       : MPM_OK;
}

static void finish_surface(mpmi_balance *balance, mpm_surface *s) {
  const double share = mpmi_contact_share(balance), dt = balance->step->dt;
  for (int64_t k = 0; k < s->next.count; ++k) {
    mpmi_marker *m = &s->next.at[k];
    spring_end is;
    double force[3];
    if (balance->layout->parts)
      memcpy(&is, &s->told[END_WORDS * k], sizeof is);
    else
      find_end(balance, s, k, &is);
    for (int32_t c = 0; c < 3; ++c) {
      m->gap[c] = is.kept * is.stretch[c];
      force[c] = -is.stiffness * is.stretch[c];
      m->reaction[c] = share * force[c];
      s->impulse[c] += dt * m->reaction[c];
      balance->step->host_work += m->reaction[c] * is.moved[c];
    }
    if (is.stiffness > 0.0 && mpmi_owns_marker(balance->step, s, k)) tell_walls(balance, s, k, force);
  }
}

mpm_status mpmi_springs_finish(mpmi_balance *balance) {
  const mpmi_surfaces *list = &balance->settings->surfaces;
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < list->count && !status; ++i) {
    mpm_surface *s = list->surface[i];
    if (!mpmi_surface_prescribes(s)) continue;
    if (balance->layout->parts) status = tell_ends(balance, s);
    if (!status) finish_surface(balance, s);
  }
  return status;
}
