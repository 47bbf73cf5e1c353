/* Merging: a pair becomes one particle. Masses, volumes and amounts add; position and velocity are the
 * means by mass, and the matrix of the transfer takes what the motion about the mean has of angular
 * momentum:
 *
 *   M D C = sum_k m_k ((v_k - v) (x) (x_k - x) + C_k D_k),  D the second moment of the basis at the mean.
 *
 * F is the mean by initial volume, which turns with the body as F does, scaled so that the volumes add;
 * stress is the mean by volume and state that by initial volume, but where stress follows from F the law
 * is asked. */
#include <math.h>

#include "adaption/adaption.h"
#include "material/dilation.h"
#include "particles/add.h"
#include "particles/thermal.h"
#include "particles/law_batch.h"
#include "simd/elementary.h"

/* ---- what a pair becomes ------------------------------------------------------------------------------ */
enum { LANES = 3 }; /* of a pair in a batch: both particles, and the one that they become */

typedef struct asking {
  mpmi_adaption *a;
  const mpm_particles *set;
  int32_t copy;
  mpmi_law_batch law;
  int64_t *id;                  /* [law.ld] */
  double *ratio;                /* [law.ld] of dilations */
  double volume[2], initial[2]; /* of the pair that is looked at */
} asking;

/* Returns det F of stored components. */
static double determinant_of(int32_t dim, const double *F) {
  double full[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  for (int32_t c = 0; c < mpmi_tensor_components(dim); ++c) full[mpmi_tensor_map(dim)[c]] = F[c];
  return 1.0 + mpmi_J_minus_1(3, mpmi_load_F_minus_1(3, full, 1, 0));
}

/* Makes the volumes add: by the axes of the plane in plane strain and in sheets, by all three else. Returns 0
 * where the mean is no deformation. */
static int32_t scale(const mpm_particles *set, double volume, double initial_volume, double *F) {
  const int32_t dim = set->grid->dim;
  const int32_t dilates = mpmi_material_kinematics(set->material) == MPMI_F_DILATES;
  const int32_t whole = dim == 3 || mpmi_is_axisymmetric(set->grid) || (dilates && dim == 2);
  const double J = determinant_of(dim, F), more = volume / (initial_volume * J);
  if (!(J > 0.0 && isfinite(more))) return 0;
  const double by = dim == 1 ? more : whole ? mpmi_cbrt(more) : sqrt(more);
  for (int32_t c = 0; c < mpmi_tensor_components(dim); ++c)
    if (whole || dim == 1 || c < 4) F[c] *= by;
  return 1;
}

/* Returns the mean of a row by two weights. */
static double mean(const double *row, const mpmi_merging *pair, const double *weight) {
  return (weight[0] * row[pair->stays] + weight[1] * row[pair->goes]) / (weight[0] + weight[1]);
}

static const double *mean_state(asking *of, int64_t i) {
  const mpm_particles *set = of->set;
  mpmi_merging *pair = &of->a->pair[i];
  double *F = of->a->merged + i * mpmi_merged_rows(set);
  const int32_t entries = mpmi_tensor_components(set->grid->dim);
  const int32_t rows = mpmi_stress_components(set->grid->dim);
  const int64_t slot[2] = {pair->stays, pair->goes};
  for (int32_t k = 0; k < 2; ++k) {
    of->volume[k] = mpmi_f64(set, MPMI_VOLUME, 0)[slot[k]];
    of->initial[k] = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0)[slot[k]];
  }
  for (int32_t c = 0; c < entries; ++c) F[c] = mean(mpmi_row_of(set, MPMI_F, of->copy, c), pair, of->initial);
  pair->bad = !scale(set, of->volume[0] + of->volume[1], of->initial[0] + of->initial[1], F);
  for (int32_t c = 0; c < rows; ++c)
    F[entries + c] = mean(mpmi_row_of(set, MPMI_STRESS, of->copy, c), pair, of->volume);
  for (int32_t c = 0; c < set->material->state_count; ++c)
    F[entries + rows + c] = mean(mpmi_row_of(set, MPMI_STATE, of->copy, c), pair, of->initial);
  return F;
}

static double dilation_of(const asking *of, int64_t slot) {
  return of->set->field[MPMI_DILATION_RATIO].present
             ? mpmi_row_of(of->set, MPMI_DILATION_RATIO, of->copy, 0)[slot]
             : 1.0;
}

/* ---- by the law --------------------------------------------------------------------------------------- */
static void load_lane(asking *of, int64_t lane, int64_t slot, const double *merged) {
  const mpm_particles *set = of->set;
  mpmi_law_batch *b = &of->law;
  const int32_t dim = set->grid->dim, entries = mpmi_tensor_components(dim),
                rows = mpmi_stress_components(dim);
  for (int32_t c = 0; c < entries; ++c)
    b->F[mpmi_tensor_map(dim)[c] * b->ld + lane] =
        merged ? merged[c] : mpmi_row_of(set, MPMI_F, of->copy, c)[slot];
  for (int32_t c = 0; c < rows; ++c)
    b->stress[c * b->ld + lane] =
        merged ? merged[entries + c] : mpmi_row_of(set, MPMI_STRESS, of->copy, c)[slot];
  for (int32_t c = 0; c < set->material->state_count; ++c)
    b->state[c * b->ld + lane] =
        merged ? merged[entries + rows + c] : mpmi_row_of(set, MPMI_STATE, of->copy, c)[slot];
  of->id[lane] = mpmi_i64(set, MPMI_ID, 0)[slot];
  of->ratio[lane] = dilation_of(of, slot);
}

static void load_pair(asking *of, int64_t lane, int64_t i) {
  const mpmi_merging *pair = &of->a->pair[i];
  const double *merged = mean_state(of, i);
  load_lane(of, lane, pair->stays, NULL);
  load_lane(of, lane + 1, pair->goes, NULL);
  load_lane(of, lane + 2, pair->stays, pair->bad ? NULL : merged);
  const double ratio[2] = {of->ratio[lane], of->ratio[lane + 1]};
  of->ratio[lane + 2] =
      (of->volume[0] * ratio[0] + of->volume[1] * ratio[1]) / (of->volume[0] + of->volume[1]);
}

/* A step has the temperatures of its particles in rows; copies have theirs in the field. */
static double stress_temperature(const asking *of, int64_t slot) {
  return mpmi_stress_temperature(of->set, slot < of->a->own ? of->copy : 0)[slot];
}

static void expand_pair(asking *of, int64_t lane, const mpmi_merging *pair) {
  const double *mass = mpmi_f64(of->set, MPMI_MASS, 0), of_pair[2] = {mass[pair->stays], mass[pair->goes]};
  const double T[2] = {stress_temperature(of, pair->stays), stress_temperature(of, pair->goes)};
  mpmi_expand_lane(&of->law, of->set, lane, T[0]);
  mpmi_expand_lane(&of->law, of->set, lane + 1, T[1]);
  mpmi_expand_lane(&of->law, of->set, lane + 2,
                   (of_pair[0] * T[0] + of_pair[1] * T[1]) / (of_pair[0] + of_pair[1]));
}

/* Returns the norm of what a field has in a slot, less what it has in another; -1: that is nothing. */
static double norm_of(const asking *of, int32_t field, int32_t components, int64_t slot, int64_t less) {
  double square = 0.0;
  for (int32_t c = 0; c < components; ++c) {
    const double *row = mpmi_row_of(of->set, field, of->copy, c);
    const double value = row[slot] - (less < 0 ? 0.0 : row[less]);
    square += value * value;
  }
  return sqrt(square);
}

/* Returns 1 where stress and velocity of a pair are alike. Differences are compared with this wave speed and
 * the pressure that belongs to it; where it is unknown, < 0, those of stresses with the stresses. */
static int32_t behave_alike(const asking *of, const mpmi_merging *pair, double speed) {
  const int32_t dim = of->set->grid->dim, rows = mpmi_stress_components(dim);
  const double tolerance = of->a->desc.merge_tolerance;
  const double unlike = norm_of(of, MPMI_STRESS, rows, pair->stays, pair->goes);
  if (speed < 0.0)
    return unlike <= tolerance * fmax(norm_of(of, MPMI_STRESS, rows, pair->stays, -1),
                                      norm_of(of, MPMI_STRESS, rows, pair->goes, -1));
  const double density =
      mpmi_f64(of->set, MPMI_MASS, 0)[pair->stays] / mpmi_f64(of->set, MPMI_VOLUME, 0)[pair->stays];
  return unlike <= tolerance * density * speed * speed &&
         norm_of(of, MPMI_VELOCITY, dim, pair->stays, pair->goes) <= tolerance * speed;
}

/* Takes what the law makes of the pair in a lane; returns 0 where they are not alike. */
static int32_t take_lane(asking *of, int64_t lane, int64_t i) {
  const mpm_particles *set = of->set;
  const mpmi_law_batch *b = &of->law;
  mpmi_merging *pair = &of->a->pair[i];
  const int32_t dim = set->grid->dim, entries = mpmi_tensor_components(dim);
  double *merged = of->a->merged + i * mpmi_merged_rows(set), loss = 0.0;
  if (pair->bad || !behave_alike(of, pair, fmin(b->wave_speed[lane], b->wave_speed[lane + 1]))) return 0;
  if (mpmi_material_stress_from_F(set->material) || mpmi_material_mean_from_F(set->material))
    for (int32_t c = 0; c < mpmi_stress_components(dim); ++c)
      merged[entries + c] = b->stress_new[c * b->ld + lane + 2];
  if (mpmi_is_plane_stress(set->grid)) merged[4] = b->F[8 * b->ld + lane + 2];
  const double initial[2] = {mpmi_f64(set, MPMI_INITIAL_VOLUME, 0)[pair->stays],
                             mpmi_f64(set, MPMI_INITIAL_VOLUME, 0)[pair->goes]};
  loss = initial[0] * b->energy[lane] + initial[1] * b->energy[lane + 1] -
         (initial[0] + initial[1]) * b->energy[lane + 2];
  pair->strain_loss = isfinite(loss) ? loss : 0.0;
  return isfinite(b->wave_speed[lane + 2]) != 0;
}

/* Keeps the pairs that are alike of n from the `begin`-th on, behind the `kept` ones, without those that the
 * law refuses. */
static int64_t ask_law(asking *of, int64_t begin, int64_t n, int64_t kept) {
  mpmi_law_batch *b = &of->law;
  for (int64_t p = 0; p < b->ld; ++p) {
    of->id[p] = -1; /* holes, but for the lanes of these pairs */
    b->growth[p] = 1.0;
  }
  for (int64_t i = 0; i < n; ++i) load_pair(of, LANES * i, begin + i);
  b->batch.n = (LANES * n + MPMI_CHUNK - 1) / MPMI_CHUNK * MPMI_CHUNK; /* laws take whole chunks */
  b->batch.id = of->id;
  if (of->set->field[MPMI_DILATION_RATIO].present)
    mpmi_dilation_of(of->set->context->isa)
        ->scale[mpmi_strain_dim(of->set->grid)](b->F, b->ld, of->ratio, b->batch.n);
  for (int64_t i = 0; i < n && mpmi_expands(of->set); ++i)
    expand_pair(of, LANES * i, &of->a->pair[begin + i]);
  if (mpmi_law_batch_run_in(b, of->set)) {
    for (int64_t i = 0; i < n && n > 1; ++i)
      kept = ask_law(of, begin + i, 1, kept); /* one of them is refused */
    return kept;
  }
  for (int64_t i = 0; i < n; ++i)
    if (take_lane(of, LANES * i, begin + i)) mpmi_keep_merging(of->a, of->set, begin + i, kept++);
  return kept;
}

static int64_t ask_nobody(asking *of) {
  int64_t kept = 0;
  for (int64_t i = 0; i < of->a->pairs; ++i) {
    const mpmi_merging *pair = &of->a->pair[i];
    mean_state(of, i);
    if (!pair->bad && behave_alike(of, pair, -1.0)) mpmi_keep_merging(of->a, of->set, i, kept++);
  }
  return kept;
}

mpm_status mpmi_adaption_merge_states(mpmi_adaption *a, const mpm_particles *set, int32_t copy, double t) {
  asking of = {.a = a, .set = set, .copy = copy};
  mpm_context *context = set->context;
  if (!a->pairs) return MPM_OK;
  const mpm_status status =
      MPMI_RESERVE_MORE(context, a->merged, a->merged_capacity, a->pairs * mpmi_merged_rows(set));
  if (status) return status;
  if (!set->material->law) {
    a->pairs = ask_nobody(&of);
    return MPM_OK;
  }
  const size_t law_bytes = mpmi_law_batch_bytes(set->material);
  const int64_t lanes = mpmi_law_batch_length(set->material), each = lanes / LANES;
  const size_t bytes = law_bytes + mpmi_bytes(2 * lanes, sizeof(double));
  char *memory = mpmi_alloc(context, bytes);
  if (!memory) return MPM_E_NOMEM;
  mpmi_law_batch_bind(&of.law, set->material, memory);
  of.ratio = (double *)(void *)(memory + law_bytes);
  of.id = (int64_t *)(void *)(of.ratio + lanes);
  for (int64_t p = 0; p < lanes; ++p) of.ratio[p] = 1.0;
  of.law.batch.t = t;
  int64_t kept = 0;
  for (int64_t i = 0; i < a->pairs; i += each)
    kept = ask_law(&of, i, a->pairs - i < each ? a->pairs - i : each, kept);
  a->pairs = kept;
  mpmi_free(context, memory, bytes);
  return MPM_OK;
}

void mpmi_keep_merging(mpmi_adaption *a, const mpm_particles *set, int64_t i, int64_t at) {
  const int64_t rows = mpmi_merged_rows(set);
  a->pair[at] = a->pair[i];
  memmove(a->merged + at * rows, a->merged + i * rows, (size_t)rows * sizeof(double));
}

/* ---- doing it ----------------------------------------------------------------------------------------- */
/* Makes one domain of two: it is longer along the edge that points most from one particle to the other. */
static void join_domains(mpm_particles *set, const mpmi_merging *pair) {
  const int32_t dim = set->grid->dim;
  const double extent[2] = {mpmi_initial_extent(set, pair->stays), mpmi_initial_extent(set, pair->goes)};
  double *size = mpmi_f64(set, MPMI_SIZE, 0), way[3], edge[3], most = -1.0, across = 1.0;
  int32_t along = 0;
  for (int32_t k = 0; k < dim; ++k) {
    const double *x = mpmi_f64(set, MPMI_POSITION, 0) + k * set->ld;
    way[k] = x[pair->goes] - x[pair->stays];
  }
  for (int32_t a = 0; a < dim; ++a) {
    double length = 0.0, share = 0.0;
    mpmi_domain_edge(set, 0, pair->stays, a, edge);
    for (int32_t k = 0; k < dim; ++k) share += edge[k] * way[k], length += edge[k] * edge[k];
    if (fabs(share) > most * length) most = fabs(share) / length, along = a;
  }
  for (int32_t a = 0; a < dim; ++a) {
    size[a * set->ld + pair->stays] = mean(size + a * set->ld, pair, extent);
    if (a != along) across *= size[a * set->ld + pair->stays];
  }
  size[along * set->ld + pair->stays] = (extent[0] + extent[1]) / across;
}

/* Heat is kept by the mean by mass. */
static int32_t is_temperature(const mpm_particles *set, int32_t field) {
  return field > 0 && (field == set->thermal.temperature || field == set->thermal.stress_temperature);
}

/* Sums amounts, takes the means of what else is of type F64, and leaves the rest as the heavier one has
 * it. */
static void join_fields(mpm_particles *set, const mpmi_merging *pair, const double *initial) {
  static const int32_t by_mass[] = {MPMI_ACCELERATION, MPMI_REFERENCE};
  const double mass[2] = {mpmi_f64(set, MPMI_MASS, 0)[pair->stays], mpmi_f64(set, MPMI_MASS, 0)[pair->goes]};
  for (int32_t f = 0; f < 2; ++f)
    for (int32_t c = 0; c < set->field[by_mass[f]].components && set->field[by_mass[f]].present; ++c) {
      double *row = mpmi_f64(set, by_mass[f], 0) + c * set->ld;
      row[pair->stays] = mean(row, pair, mass);
    }
  for (int32_t f = 0; f < set->field_count; ++f) {
    const mpmi_field *field = &set->field[f];
    if (!field->present || field->type != MPM_F64) continue;
    if (!field->extensive && f < MPMI_BUILTIN_FIELDS && f != MPMI_L) continue;
    for (int32_t c = 0; c < field->components; ++c) {
      double *row = mpmi_f64(set, f, 0) + c * set->ld;
      row[pair->stays] = field->extensive ? row[pair->stays] + row[pair->goes]
                                          : mean(row, pair, is_temperature(set, f) ? mass : initial);
    }
  }
}

static void join_motions(mpmi_adaption *a, const mpmi_settings *settings, mpm_particles *set,
                         const mpmi_merging *pair, const mpmi_motion_of *of) {
  const double least = 1e-12 * set->grid->h_min * set->grid->h_min;
  mpmi_motion_of one = {.mass = of[0].mass + of[1].mass};
  double sum[3][3] = {{0.0}};
  for (int32_t k = 0; k < 3; ++k) {
    one.x[k] = (of[0].mass * of[0].x[k] + of[1].mass * of[1].x[k]) / one.mass;
    one.v[k] = mpmi_keeps_velocity(set, pair->stays, k)
                   ? of[0].v[k]
                   : (of[0].mass * of[0].v[k] + of[1].mass * of[1].v[k]) / one.mass;
  }
  for (int32_t k = 0; k < set->grid->dim; ++k)
    mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + pair->stays] = one.x[k];
  for (int32_t i = 0; i < 2; ++i)
    for (int32_t r = 0; r < 3; ++r)
      for (int32_t k = 0; k < 3; ++k)
        sum[r][k] +=
            of[i].mass * ((of[i].v[r] - one.v[r]) * (of[i].x[k] - one.x[k]) + of[i].C[r][k] * of[i].D[k]);
  if (mpmi_is_affine(settings)) mpmi_second_moments(settings, set, pair->stays, one.D);
  for (int32_t r = 0; r < 3; ++r)
    for (int32_t k = 0; k < 3; ++k)
      one.C[r][k] = one.D[k] > least && !mpmi_keeps_velocity(set, pair->stays, r)
                        ? sum[r][k] / (one.mass * one.D[k])
                        : of[0].C[r][k];
  mpmi_write_motion(settings, set, pair->stays, &one);
  for (int32_t i = 0; i < 2; ++i) mpmi_count_motion(set->grid, &of[i], one.x, 1.0, a->lost);
  mpmi_count_motion(set->grid, &one, one.x, -1.0, a->lost);
}

static void write_state(mpm_particles *set, int64_t slot, const double *merged) {
  const int32_t dim = set->grid->dim;
  for (int32_t c = 0; c < mpmi_tensor_components(dim); ++c)
    mpmi_f64(set, MPMI_F, 0)[c * set->ld + slot] = *merged++;
  for (int32_t c = 0; c < mpmi_stress_components(dim); ++c)
    mpmi_f64(set, MPMI_STRESS, 0)[c * set->ld + slot] = *merged++;
  for (int32_t c = 0; c < set->material->state_count; ++c)
    mpmi_f64(set, MPMI_STATE, 0)[c * set->ld + slot] = *merged++;
}

static void drop(mpm_particles *set, int64_t slot) {
  mpmi_make_holes(set, slot, slot + 1);
  --set->count;
}

void mpmi_adaption_merge(mpmi_adaption *a, const mpmi_settings *settings, mpm_particles *set) {
  for (int64_t i = 0; i < a->pairs; ++i) {
    const mpmi_merging *pair = &a->pair[i];
    const mpmi_motion_of of[2] = {mpmi_motion_in(settings, set, pair->stays),
                                  mpmi_motion_in(settings, set, pair->goes)};
    const double *V0 = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0), *V = mpmi_f64(set, MPMI_VOLUME, 0);
    const double initial[2] = {V0[pair->stays], V0[pair->goes]}, volume[2] = {V[pair->stays], V[pair->goes]};
    if (set->field[MPMI_DILATION_RATIO].present) {
      double *ratio = mpmi_f64(set, MPMI_DILATION_RATIO, 0);
      ratio[pair->stays] = mean(ratio, pair, volume);
    }
    join_domains(set, pair);
    join_fields(set, pair, initial);
    write_state(set, pair->stays, a->merged + i * mpmi_merged_rows(set));
    join_motions(a, settings, set, pair, of); /* moments of GIMP follow from domains */
    mpmi_exact_add(&a->lost[MPMI_LOST_STRAIN], pair->strain_loss);
    if (mpmi_f64(set, MPMI_MASS, 0)[pair->stays] > set->mass_max)
      set->mass_max = mpmi_f64(set, MPMI_MASS, 0)[pair->stays];
    if (pair->goes < a->own) drop(set, pair->goes); /* else it is a copy */
  }
  for (int64_t i = 0; i < a->gone_count; ++i) drop(set, a->gone[i]);
}
