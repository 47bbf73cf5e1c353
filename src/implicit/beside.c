/* The nodes and rows beside one. A slip wall is a plane of symmetry: half of a body on it is looked at as the
 * whole one, whose other half is its mirror image. */
#include "implicit/beside.h"

/* Returns 1 where a wall is a plane of symmetry. Open knots have none: they differ on its two sides. */
static int32_t mirrors(const mpmi_settings *settings, int32_t face) {
  return settings->grid->family < MPMI_FAMILY_OPEN_BSPLINE2 &&
         mpmi_wall_kind_of(settings->wall[face].kind)->holds == MPMI_HOLDS_NORMAL;
}

/* Returns how many nodes beyond the plane of a face a node is. */
static int64_t beyond(const mpm_grid *grid, int32_t face, int64_t index) {
  return face % 2 ? index - mpmi_face_node(grid, face) : mpmi_face_node(grid, face) - index;
}

int64_t mpmi_node_beside(const mpmi_balance *balance, int64_t slot, const int32_t *offset, int32_t *mirror) {
  const mpmi_settings *settings = balance->settings;
  int64_t index[3] = {0};
  int32_t to[3] = {0, 0, 0};
  for (int32_t k = 0; k < 3; ++k) mirror[k] = -1;
  mpmi_blocks_index(&balance->layout->blocks, slot, index);
  for (int32_t k = 0; k < settings->grid->dim; ++k) {
    to[k] = offset[k];
    for (int32_t face = 2 * k; face < 2 * k + 2; ++face) {
      const int64_t far = mirrors(settings, face) ? beyond(settings->grid, face, index[k] + to[k]) : 0;
      if (far <= 0) continue;
      to[k] += (int32_t)(face % 2 ? -2 * far : 2 * far);
      mirror[k] = face;
    }
  }
  return mpmi_blocks_around(&balance->layout->blocks, slot, to);
}

/* Returns 1 when a node lies on the plane of a slip wall across an axis. */
static int32_t lies_on_symmetry_plane(const mpmi_balance *balance, int64_t slot, int32_t axis) {
  const mpmi_settings *settings = balance->settings;
  int64_t index[3] = {0};
  int32_t is = 0;
  mpmi_blocks_index(&balance->layout->blocks, slot, index);
  for (int32_t face = 2 * axis; face < 2 * axis + 2; ++face)
    is |= mirrors(settings, face) && beyond(settings->grid, face, index[axis]) == 0;
  return is;
}

double mpmi_copies_of(const mpmi_balance *balance, int64_t slot) {
  double copies = 1.0;
  for (int32_t k = 0; k < balance->settings->grid->dim; ++k)
    if (lies_on_symmetry_plane(balance, slot, k)) copies *= 2.0;
  return copies;
}

int32_t mpmi_is_zero(const mpmi_balance *balance, int64_t slot, int32_t c) {
  return lies_on_symmetry_plane(balance, slot, c) && mpmi_holder_of(balance, slot, c) == MPMI_ROW_WALL;
}

double mpmi_whole_mass(const mpmi_balance *balance, int64_t row) {
  return balance->newton->mass[row] * balance->newton->copies[row];
}

/* Returns 1 when a component of a row takes part: where it is free, or 0 only for the body is symmetric. */
static int32_t takes_part(const mpmi_balance *balance, int64_t row, int32_t c) {
  const mpmi_matrix *A = &balance->newton->matrix;
  return !mpmi_is_held(A->held[row * A->block + c]) || mpmi_is_zero(balance, balance->newton->master[row], c);
}

/* Returns 1 when the matrix tells that the node at an offset from a row's has no more than some whole mass:
 * a look at its row, before all that finds the node. Of several parts, rows of others may have no entries. */
static int32_t is_lighter(const mpmi_balance *balance, int64_t row, int32_t offset, double above) {
  const mpmi_newton *newton = balance->newton;
  const int64_t active = newton->active_of[newton->master[row]];
  const int32_t entry = mpmi_is_kept(newton, row) ? newton->place[active * newton->offsets + offset] : -1;
  return entry >= 0 && !(mpmi_whole_mass(balance, newton->matrix.column[entry]) > above);
}

int64_t mpmi_next_beside(const mpmi_balance *balance, int64_t row, int32_t c, double above, int32_t *at,
                         double *sign) {
  const mpmi_newton *newton = balance->newton;
  const int64_t from = newton->master[row];
  while (*at < newton->offsets) {
    int32_t offset[3], mirror[3];
    const int32_t number = (*at)++;
    if (is_lighter(balance, row, number, above)) continue;
    mpmi_offset_of(balance, number, offset);
    const int64_t slot = mpmi_node_beside(balance, from, offset, mirror);
    const int32_t active = slot < 0 ? -1 : newton->active_of[slot];
    if (active < 0) continue;
    const mpmi_active_node *node = &newton->active[active];
    if (node->row == row || !(mpmi_whole_mass(balance, node->row) > above) ||
        (c >= 0 && !takes_part(balance, node->row, c)))
      continue;
    *sign = c < 0 ? 1.0 : mirror[c] < 0 ? node->sign[c] : -node->sign[c];
    return node->row;
  }
  return -1;
}

double mpmi_heaviest_beside(const mpmi_balance *balance, int64_t row, int32_t c) {
  double most = 0.0, sign;
  int32_t at = 0;
  int64_t other;
  while ((other = mpmi_next_beside(balance, row, c, most, &at, &sign)) >= 0)
    most = mpmi_whole_mass(balance, other);
  return most;
}
