/* The values of a loaded set must fulfil certain conditions so that a step can work with them, because
 * kernels do not look twice. */
#include "io/state.h"
#include "layout/tile.h"

static void check_ids(mpmi_archive *a, mpm_particles *fresh) {
  const int64_t *id = mpmi_i64(fresh, MPMI_ID, 0);
  int64_t live = 0, good = 1;
  for (int64_t s = 0; s < fresh->slots; ++s) {
    live += id[s] >= 0;
    good &= id[s] >= -1 && id[s] < fresh->next_id;
  }
  if (!good || live != fresh->count) {
    mpmi_archive_damaged(a, "its ids make no sense");
    return;
  }
  const mpm_status status = mpmi_index_build(fresh);
  mpmi_index_drop(fresh);
  if (status == MPM_E_STATE)
    mpmi_archive_damaged(a, "an id stands there twice");
  else
    a->status = status;
}

/* Makes holes inert whatever the state says, because bad values would spread over the nodes. */
static void restore_holes(mpm_particles *fresh) {
  const int64_t *id = mpmi_i64(fresh, MPMI_ID, 0);
  for (int64_t s = 0; s < fresh->slots; ++s)
    if (id[s] < 0) mpmi_make_holes(fresh, s, s + 1);
}

enum { ANY, NOT_NEGATIVE, POSITIVE };

/* Particles need finite values, and some fields a sign; holes need finite values only. */
static void check_field(mpmi_archive *a, const mpm_particles *fresh, int32_t f, int32_t sign) {
  const mpmi_field *field = &fresh->field[f];
  const int64_t *id = mpmi_i64(fresh, MPMI_ID, 0);
  int64_t bad = 0;
  for (int32_t c = 0; c < field->components && field->present; ++c) {
    const double *x = mpmi_f64(fresh, f, 0) + c * fresh->ld;
    for (int64_t s = 0; s < fresh->slots; ++s) {
      const int32_t finite = x[s] - x[s] == 0.0;
      bad += !finite || (id[s] >= 0 && !(sign == ANY || x[s] > 0.0 || (sign == NOT_NEGATIVE && x[s] == 0.0)));
    }
  }
  char what[MPMI_NAME + 32];
  snprintf(what, sizeof what, "values of %s make no sense", field->name);
  if (bad) mpmi_archive_damaged(a, what);
}

static void check_prescribed(mpmi_archive *a, const mpm_particles *fresh) {
  const mpmi_field *field = &fresh->field[MPMI_PRESCRIBED];
  int64_t bad = 0;
  for (int32_t c = 0; c < field->components && field->present; ++c)
    for (int64_t s = 0; s < fresh->slots; ++s)
      bad += ((const uint8_t *)field->data[0])[c * fresh->ld + s] > 1;
  if (bad) mpmi_archive_damaged(a, "values of prescribed make no sense");
}

/* Holes must lie inside too, because kernels compute on them. */
static void check_inside(mpmi_archive *a, const mpm_particles *fresh) {
  int64_t outside = 0;
  for (int32_t k = 0; k < fresh->grid->dim; ++k) {
    const double *x = mpmi_places(fresh, 0) + k * fresh->ld;
    const double low = fresh->grid->desc.origin[k], high = fresh->grid->upper[k];
    for (int64_t s = 0; s < fresh->slots; ++s) outside += !(x[s] >= low && x[s] <= high);
  }
  if (outside) mpmi_archive_damaged(a, "a position lies outside the grid");
}

/* Counts go on from here, and must start far from where they would overflow. */
static void check_images(mpmi_archive *a, const mpm_particles *fresh) {
  const mpmi_field *field = &fresh->field[MPMI_IMAGE];
  int64_t far = 0;
  for (int32_t c = 0; c < field->components && field->present; ++c)
    for (int64_t s = 0; s < fresh->slots; ++s) {
      const int64_t image = mpmi_i64(fresh, MPMI_IMAGE, 0)[c * fresh->ld + s];
      far += image > INT64_MAX / 2 || image < -(INT64_MAX / 2);
    }
  if (far) mpmi_archive_damaged(a, "values of image make no sense");
}

/* Every stencil, that of a hole too, must lie in the tile of its block. The function that the kernels use
 * says where it lies. */
static void check_tiles(mpmi_archive *a, const mpm_particles *fresh, const mpmi_state_blocks *blocks,
                        const int64_t *start) {
  const mpm_grid *grid = fresh->grid;
  const mpmi_weights_fn weights = mpmi_kernels_of(fresh->context->isa)->weights[grid->family][1];
  const int32_t last = MPMI_BLOCK_EDGE(grid->dim) + 2 * MPMI_RING - 1;
  mpmi_weights W;
  mpmi_axis axis[3];
  int64_t astray = 0;
  for (int64_t b = 0; b < blocks->count; ++b) {
    const int64_t *place = blocks->place[b];
    const int32_t coord[3] = {(int32_t)place[0], (int32_t)place[1], (int32_t)place[2]};
    mpmi_block_axes(grid, coord, axis);
    for (int64_t s = start[b]; s < start[b + 1]; s += MPMI_CHUNK)
      for (int32_t k = 0; k < grid->dim; ++k) {
        const mpmi_points points = {.x = {mpmi_places(fresh, 0) + k * fresh->ld}};
        weights(&axis[k], 0, &points, s, MPMI_CHUNK, &W);
        for (int32_t p = 0; p < MPMI_CHUNK; ++p) astray += W.node[p] < 0 || W.node[p] > last;
      }
  }
  if (astray) mpmi_archive_damaged(a, "a particle is far from its block");
}

void mpmi_state_check_set(mpmi_archive *a, mpm_particles *fresh, const mpmi_state_blocks *blocks,
                          const int64_t *start) {
  if (fresh->slots == 0) return;
  static const struct {
    int32_t field, sign;
  } demand[] = {{MPMI_POSITION, ANY},
                {MPMI_VELOCITY, ANY},
                {MPMI_ACCELERATION, ANY},
                {MPMI_MASS, NOT_NEGATIVE},
                {MPMI_VOLUME, POSITIVE},
                {MPMI_INITIAL_VOLUME, POSITIVE},
                {MPMI_SIZE, POSITIVE},
                {MPMI_DILATION_RATIO, POSITIVE},
                {MPMI_F, ANY},
                {MPMI_L, ANY},
                {MPMI_STRESS, ANY},
                {MPMI_STATE, ANY},
                {MPMI_REFERENCE, ANY},
                {MPMI_APPLIED_FORCE, ANY}};
  restore_holes(fresh);
  mpmi_particles_make_volumes(fresh, 0);
  check_ids(a, fresh);
  for (size_t i = 0; i < sizeof demand / sizeof *demand; ++i)
    check_field(a, fresh, demand[i].field, demand[i].sign);
  check_prescribed(a, fresh);
  check_inside(a, fresh);
  check_images(a, fresh);
  if (blocks && !a->status) check_tiles(a, fresh, blocks, start);
}
