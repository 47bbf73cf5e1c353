/* A lattice of particles fills a shape, and every shape takes the same path: the points of a box are
 * offered to a function in batches, its answers are kept as one bit each, and the chosen points are then
 * written straight into the set. */
#include <math.h>
#include <string.h>

#include "particles/add.h"

enum { BATCH = 4096, MOST_PER_CELL = 64 };

static const double most_points = 4294967296.0;

/* A lattice has the points [begin, begin + n) of those with `per` points along each axis of a cell, last
 * axis fastest. */
typedef struct lattice {
  const mpm_grid *grid;
  int64_t per[3], begin[3], n[3], points;
  int64_t from, to; /* of the points, those that this part offers: all where there is one */
  double volume;
} lattice;

static double coordinate(const lattice *on, int32_t axis, int64_t i) {
  const mpm_grid_desc *desc = &on->grid->desc;
  double in_cell = ((double)(i % on->per[axis]) + 0.5) / (double)on->per[axis];
  return desc->origin[axis] + ((double)(i / on->per[axis]) + in_cell) * desc->spacing[axis];
}

/* Returns the first point of an axis that is not below x. */
static int64_t first_from(const lattice *on, int32_t axis, double x) {
  const mpm_grid *grid = on->grid;
  int64_t all = grid->desc.cells[axis] * on->per[axis];
  double guess = (x - grid->desc.origin[axis]) * grid->inverse_spacing[axis] * (double)on->per[axis] - 2.0;
  int64_t i = guess > 0 ? (int64_t)fmin(guess, (double)all) : 0;
  while (i < all && coordinate(on, axis, i) < x) ++i;
  return i;
}

static mpm_status lay_lattice(mpm_particles *set, const double *lower, const double *upper,
                              const int32_t *per_cell, lattice *on) {
  const mpm_grid *grid = set->grid;
  double points = 1.0;
  on->grid = grid;
  on->volume = 1.0;
  for (int32_t k = 0; k < grid->dim; ++k) {
    if (per_cell[k] < 1 || per_cell[k] > MOST_PER_CELL)
      return mpmi_fail(set->context, MPM_E_ARG, "per_cell[%d] is %d, must be 1 to %d", (int)k,
                       (int)per_cell[k], (int)MOST_PER_CELL);
    on->per[k] = per_cell[k];
    on->begin[k] = first_from(on, k, lower[k]);
    on->n[k] = first_from(on, k, upper[k]) - on->begin[k];
    on->volume *= grid->desc.spacing[k] / per_cell[k];
    points *= (double)on->n[k];
  }
  if (points > most_points)
    return mpmi_fail(set->context, MPM_E_ARG, "the box holds %g lattice points, more than %g", points,
                     most_points);
  /* of rings, at the largest radius */
  const double most = on->volume * (mpmi_is_axisymmetric(grid) ? grid->upper[0] : 1.0);
  if (!(on->volume > 0) || !isfinite(most) || !isfinite(most * set->material->density))
    return mpmi_fail(set->context, MPM_E_ARG,
                     "a lattice cell has volume %g: that or its mass is out of range", on->volume);
  on->points = (int64_t)points;
  const mpm_transport *t = &set->context->transport;
  on->from = on->points / t->parts * t->part + on->points % t->parts * t->part / t->parts;
  on->to = on->points / t->parts * (t->part + 1) + on->points % t->parts * (t->part + 1) / t->parts;
  return MPM_OK;
}

/* Writes the positions of the points [first, first + n), with components ld apart. */
static void points_at(const lattice *on, int64_t first, int64_t n, double *position, int64_t ld) {
  int64_t at[3] = {0, 0, 0}, rest = first;
  int32_t dim = on->grid->dim;
  for (int32_t k = dim - 1; k >= 0; --k) {
    at[k] = rest % on->n[k];
    rest /= on->n[k];
  }
  for (int64_t i = 0; i < n; ++i) {
    for (int32_t k = 0; k < dim; ++k) position[k * ld + i] = coordinate(on, k, on->begin[k] + at[k]);
    for (int32_t k = dim - 1; k >= 0 && ++at[k] == on->n[k]; --k) at[k] = 0;
  }
}

/* A sieve is the scratch of a fill: a batch of points, and a bit for every point of the lattice. */
typedef struct sieve {
  double *position; /* [dim][BATCH] */
  uint8_t *inside;  /* [BATCH] */
  uint8_t *taken;   /* [to - from] as bits */
  int64_t count;    /* how many bits are set */
} sieve;

static int64_t batch_length(const lattice *on, int64_t first) {
  return on->to - first < BATCH ? on->to - first : BATCH;
}

static mpm_status choose(mpm_context *context, const lattice *on, mpm_inside_fn inside, void *user,
                         sieve *through) {
  for (int64_t first = on->from; first < on->to; first += BATCH) {
    int64_t n = batch_length(on, first);
    points_at(on, first, n, through->position, BATCH);
    memset(through->inside, 0, BATCH);
    const mpm_status status =
        mpmi_from_host(inside(user, on->grid->dim, n, BATCH, through->position, through->inside));
    if (status)
      return mpmi_fail(context, MPM_E_CALLBACK, "the function that tells what is inside returned %d",
                       (int)status);
    for (int64_t i = 0; i < n; ++i) {
      if (!through->inside[i]) continue;
      through->taken[(first - on->from + i) / 8] |= (uint8_t)(1u << i % 8);
      through->count++;
    }
  }
  return MPM_OK;
}

static int32_t edges_differ(const lattice *on) {
  double shortest = HUGE_VAL, longest = 0.0;
  for (int32_t k = 0; k < on->grid->dim; ++k) {
    double edge = on->grid->desc.spacing[k] / (double)on->per[k];
    shortest = fmin(shortest, edge);
    longest = fmax(longest, edge);
  }
  return longest - shortest > 1e-12 * longest;
}

static void write_points(mpm_particles *set, const lattice *on, const sieve *through, int64_t slot) {
  double *position = mpmi_f64(set, MPMI_POSITION, 0);
  int64_t to = slot;
  for (int64_t first = on->from; first < on->to; first += BATCH) {
    int64_t n = batch_length(on, first);
    points_at(on, first, n, through->position, BATCH);
    for (int64_t i = 0; i < n; ++i) {
      if (!(through->taken[(first - on->from + i) / 8] >> i % 8 & 1)) continue;
      for (int32_t k = 0; k < on->grid->dim; ++k)
        position[k * set->ld + to] = through->position[k * BATCH + i];
      ++to;
    }
  }
}

/* Makes particles of the points, for which there is room. */
static void write_particles(mpm_particles *set, const lattice *on, const sieve *through, int32_t with_size,
                            int64_t first_id) {
  const int64_t n = through->count, slot = mpmi_append_begin(set, n);
  write_points(set, on, through, slot);
  for (int64_t s = slot; s < slot + n; ++s)
    mpmi_f64(set, MPMI_INITIAL_VOLUME, 0)[s] =
        on->volume * (mpmi_is_axisymmetric(on->grid) ? mpmi_f64(set, MPMI_POSITION, 0)[s] : 1.0);
  for (int32_t k = 0; k < on->grid->dim && with_size; ++k)
    for (int64_t s = slot; s < slot + n; ++s)
      mpmi_f64(set, MPMI_SIZE, 0)[k * set->ld + s] = on->grid->desc.spacing[k] / (double)on->per[k];
  mpmi_append_finish(set, slot, n, with_size, NULL, first_id);
}

static mpm_status append_points(mpm_particles *set, const lattice *on, const sieve *through,
                                mpm_status status, mpmi_numbers *numbers) {
  int32_t with_size = edges_differ(on);
  const int64_t n = through->count;
  if (!status && n) status = mpmi_check_room(set, n);
  if (!status && n) status = mpmi_append_reserve(set, n, with_size, 0);
  if ((status = mpmi_number(set, n, NULL, status, numbers))) return status;
  if (n) write_particles(set, on, through, with_size, numbers->first);
  set->next_id = numbers->next; /* other parts may have added some */
  return MPM_OK;
}

static mpm_status fill(mpm_particles *set, const lattice *on, mpm_inside_fn inside, void *user,
                       int64_t *first_id, int64_t *count) {
  mpm_context *context = set->context;
  size_t position_bytes = mpmi_bytes(on->grid->dim * BATCH, sizeof(double));
  size_t taken_bytes = mpmi_bytes((on->to - on->from) / 8 + 1, 1);
  mpmi_numbers numbers;
  sieve through = {0};
  through.position = mpmi_alloc(context, position_bytes);
  if (through.position) through.inside = mpmi_alloc(context, BATCH);
  if (through.inside) through.taken = mpmi_alloc_zeroed(context, taken_bytes);
  mpm_status status = through.taken ? choose(context, on, inside, user, &through) : MPM_E_NOMEM;
  status = append_points(set, on, &through, status, &numbers);
  mpmi_free(context, through.taken, taken_bytes);
  mpmi_free(context, through.inside, BATCH);
  mpmi_free(context, through.position, position_bytes);
  if (status) return status;
  if (first_id) *first_id = numbers.first;
  if (count) *count = through.count;
  return MPM_OK;
}

/* Shapes may reach over the faces, as symmetry planes want it: what lies inside the grid is filled. */
static mpm_status check_box(const mpm_particles *set, const double *lower, const double *upper) {
  const mpm_grid *grid = set->grid;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double first = grid->desc.origin[k], last = grid->upper[k];
    for (int32_t i = 0; i < 2; ++i)
      if (!isfinite(i ? upper[k] : lower[k]))
        return mpmi_fail(set->context, MPM_E_ARG, "%s[%d] is %g, must be finite", i ? "upper" : "lower",
                         (int)k, i ? upper[k] : lower[k]);
    if (!(lower[k] < upper[k]))
      return mpmi_fail(set->context, MPM_E_ARG, "lower[%d] is %g, must be below upper[%d] = %g", (int)k,
                       lower[k], (int)k, upper[k]);
    if (upper[k] < first || lower[k] > last)
      return mpmi_fail(
          set->context, MPM_E_ARG,
          "the box lies beyond the grid: from %.12g to %.12g on axis %d, where that has [%.12g, %.12g]",
          lower[k], upper[k], (int)k, first, last);
  }
  return MPM_OK;
}

static mpm_status check_centre(const mpm_particles *set, const double *centre) {
  const mpm_grid *grid = set->grid;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double lower = grid->desc.origin[k], upper = grid->upper[k], slack = 1e-12 * (upper - lower);
    if (centre[k] >= lower - slack && centre[k] <= upper + slack) continue;
    return mpmi_fail(set->context, MPM_E_ARG,
                     "centre[%d] is %.12g, must be inside the grid, in [%.12g, %.12g]", (int)k, centre[k],
                     lower, upper);
  }
  return MPM_OK;
}

mpm_status mpmi_fill_part(mpm_particles *set, const double *lower, const double *upper,
                          const int32_t *per_cell, mpm_inside_fn inside, void *user, int64_t *first_id,
                          int64_t *count) {
  lattice on;
  mpm_status status = check_box(set, lower, upper);
  if (!status) status = lay_lattice(set, lower, upper, per_cell, &on);
  return status ? mpmi_agree(set->context, status) : fill(set, &on, inside, user, first_id, count);
}

mpm_status mpm_particles_fill(mpm_particles *particles, const double *lower, const double *upper,
                              const int32_t *per_cell, mpm_inside_fn inside, void *user, int64_t *first_id,
                              int64_t *count) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status && (!lower || !upper || !per_cell || !inside))
    status = mpmi_fail(particles->context, MPM_E_ARG, "%s is NULL",
                       !lower   ? "lower"
                       : !upper ? "upper"
                       : inside ? "per_cell"
                                : "inside");
  if (status) return mpmi_agree(particles->context, status); /* the other parts must not wait for this one */
  return mpmi_fill_part(particles, lower, upper, per_cell, inside, user, first_id, count);
}

static mpm_status inside_box(void *user, int32_t dim, int64_t n, int64_t ld, const double *position,
                             uint8_t *inside) {
  (void)user, (void)dim, (void)ld, (void)position;
  memset(inside, 1, (size_t)n);
  return MPM_OK;
}

mpm_status mpm_particles_fill_box(mpm_particles *particles, const double *lower, const double *upper,
                                  const int32_t *per_cell, int64_t *first_id, int64_t *count) {
  return mpm_particles_fill(particles, lower, upper, per_cell, inside_box, NULL, first_id, count);
}

typedef struct ball {
  const double *centre;
  double radius;
} ball;

static mpm_status inside_ball(void *user, int32_t dim, int64_t n, int64_t ld, const double *position,
                              uint8_t *inside) {
  const ball *shape = user;
  for (int64_t i = 0; i < n; ++i) {
    double square = 0.0;
    for (int32_t k = 0; k < dim; ++k) {
      double d = position[k * ld + i] - shape->centre[k];
      square += d * d;
    }
    inside[i] = square < shape->radius * shape->radius;
  }
  return MPM_OK;
}

mpm_status mpm_particles_fill_ball(mpm_particles *particles, const double *centre, double radius,
                                   const int32_t *per_cell, int64_t *first_id, int64_t *count) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status && (!centre || !per_cell))
    status = mpmi_fail(particles->context, MPM_E_ARG, "%s is NULL", centre ? "per_cell" : "centre");
  if (!status && (!(radius > 0) || !isfinite(radius)))
    status = mpmi_fail(particles->context, MPM_E_ARG, "radius is %g, must be > 0 and finite", radius);
  if (!status) status = check_centre(particles, centre);
  if (status) return mpmi_agree(particles->context, status);
  double lower[3], upper[3];
  for (int32_t k = 0; k < particles->grid->dim; ++k) {
    lower[k] = centre[k] - radius;
    upper[k] = centre[k] + radius;
  }
  lattice on;
  ball shape = {centre, radius};
  status = lay_lattice(particles, lower, upper, per_cell, &on);
  return status ? mpmi_agree(particles->context, status)
                : fill(particles, &on, inside_ball, &shape, first_id, count);
}
