/* Grids are described and checked here; so are the numbering of nodes, bounds and periods. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "context/structs.h"
#include "grid/grid.h"

enum { MOST_CELLS = 6 << 20 }; /* block coordinates have 21 bits per axis, and a block has up to 6 cells */

/* A position more periods away than this has no digits worth having once it is wrapped. */
static const double most_periods = 2147483648.0;

mpm_status mpm_grid_desc_init(mpm_grid_desc *desc, uint32_t struct_size) {
  mpm_grid_desc defaults;
  memset(&defaults, 0, sizeof defaults);
  defaults.struct_size = sizeof defaults;
  defaults.dim = 3;
  defaults.basis = MPM_BSPLINE2;
  defaults.boundary_basis = MPM_BOUNDARY_GHOST;
  defaults.smoothing = 0.5;
  return mpmi_init_struct("mpm_grid_desc", &defaults, sizeof defaults, desc, struct_size);
}

/* What a basis is made of: its family of functions, also with open knots, and the domains of particles. */
typedef struct basis {
  int32_t family, open_family, domains;
} basis;
static const basis bases[] = {
    [MPM_LINEAR] = {MPMI_FAMILY_BSPLINE1, MPMI_FAMILY_BSPLINE1, MPMI_DOMAINS_NONE},
    [MPM_BSPLINE2] = {MPMI_FAMILY_BSPLINE2, MPMI_FAMILY_OPEN_BSPLINE2, MPMI_DOMAINS_NONE},
    [MPM_BSPLINE3] = {MPMI_FAMILY_BSPLINE3, MPMI_FAMILY_OPEN_BSPLINE3, MPMI_DOMAINS_NONE},
    [MPM_GIMP] = {MPMI_FAMILY_GIMP, MPMI_FAMILY_GIMP, MPMI_DOMAINS_OWN},
    [MPM_UGIMP] = {MPMI_FAMILY_GIMP, MPMI_FAMILY_GIMP, MPMI_DOMAINS_ALIKE},
    [MPM_CPGIMP] = {MPMI_FAMILY_GIMP, MPMI_FAMILY_GIMP, MPMI_DOMAINS_STRETCHED},
};

/* Returns the row of MPM_LINEAR ... MPM_CPGIMP, or NULL for other values. */
static const basis *basis_of(int32_t value) {
  const int32_t count = (int32_t)(sizeof bases / sizeof *bases);
  const int32_t known = value >= MPM_LINEAR && value < count && (value <= MPM_BSPLINE3 || value >= MPM_GIMP);
  return known ? &bases[value] : NULL;
}

static mpm_status check_basis(mpm_context *context, const mpm_grid_desc *desc) {
  const basis *row = basis_of(desc->basis);
  if (!row)
    return mpmi_fail(context, MPM_E_ARG, "mpm_grid_desc: basis is %d, which is none of the constants",
                     (int)desc->basis);
  if (desc->boundary_basis != MPM_BOUNDARY_GHOST && desc->boundary_basis != MPM_BOUNDARY_OPEN_KNOT)
    return mpmi_fail(context, MPM_E_ARG,
                     "mpm_grid_desc: boundary_basis is %d, which is none of the constants",
                     (int)desc->boundary_basis);
  if (desc->boundary_basis == MPM_BOUNDARY_OPEN_KNOT && row->open_family == row->family)
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "mpm_grid_desc: boundary_basis MPM_BOUNDARY_OPEN_KNOT is for MPM_BSPLINE2 and "
                     "MPM_BSPLINE3: use one of them, or MPM_BOUNDARY_GHOST with basis %d",
                     (int)desc->basis);
  return MPM_OK;
}

static mpm_status check_axis(mpm_context *context, const mpm_grid_desc *desc, int32_t axis) {
  double spacing = desc->spacing[axis], origin = desc->origin[axis];
  int64_t cells = desc->cells[axis];
  if (desc->periodic[axis] != 0 && desc->periodic[axis] != 1)
    return mpmi_fail(context, MPM_E_ARG, "mpm_grid_desc: periodic[%d] is %d, must be 0 or 1", (int)axis,
                     (int)desc->periodic[axis]);
  if (cells < 1 || cells > MOST_CELLS)
    return mpmi_fail(context, MPM_E_ARG,
                     "mpm_grid_desc: cells[%d] is %lld, must be 1 to %d (block coordinates have 21 bits)",
                     (int)axis, (long long)cells, (int)MOST_CELLS);
  if (!isfinite(spacing) || !(spacing > 0) || !isfinite(1.0 / spacing))
    return mpmi_fail(context, MPM_E_ARG, "mpm_grid_desc: spacing[%d] is %g, must be > 0 and finite",
                     (int)axis, spacing);
  if (!isfinite(origin))
    return mpmi_fail(context, MPM_E_ARG, "mpm_grid_desc: origin[%d] is %g, must be finite", (int)axis,
                     origin);
  double upper = origin + (double)cells * spacing;
  if (!isfinite(upper) || !(origin + spacing > origin) || !(upper - spacing < upper))
    return mpmi_fail(context, MPM_E_ARG,
                     "mpm_grid_desc: spacing[%d] = %g does not resolve positions between %g and %g",
                     (int)axis, spacing, origin, upper);
  return MPM_OK;
}

/* Counts the nodes along an axis with one layer of ghosts on either side, whatever the basis. */
static int64_t axis_nodes(const mpm_grid *grid, int32_t axis) {
  return grid->desc.cells[axis] + 3;
}

static mpm_status check_node_numbers(mpm_context *context, const mpm_grid *grid) {
  int64_t nodes = 1;
  for (int32_t k = 0; k < grid->dim; ++k)
    if (__builtin_mul_overflow(nodes, axis_nodes(grid, k), &nodes))
      return mpmi_fail(context, MPM_E_ARG,
                       "mpm_grid_desc: cells (%lld, %lld, %lld) make more nodes than 63 bits can number",
                       (long long)grid->desc.cells[0], (long long)grid->desc.cells[1],
                       (long long)grid->desc.cells[2]);
  return MPM_OK;
}

static mpm_status check_geometry(mpm_context *context, const mpm_grid_desc *desc) {
  static const char *const name[] = {"MPM_PLANE_STRAIN", "MPM_AXISYMMETRIC", "MPM_PLANE_STRESS"};
  if (desc->geometry < MPM_PLANE_STRAIN || desc->geometry > MPM_PLANE_STRESS)
    return mpmi_fail(context, MPM_E_ARG, "mpm_grid_desc: geometry is %d, which is none of the constants",
                     (int)desc->geometry);
  if (desc->geometry != MPM_PLANE_STRAIN && desc->dim != 2)
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "mpm_grid_desc: %s is for dim 2: use that, or geometry MPM_PLANE_STRAIN with dim %d",
                     name[desc->geometry], (int)desc->dim);
  if (desc->geometry != MPM_AXISYMMETRIC) return MPM_OK;
  if (desc->periodic[0])
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "mpm_grid_desc: the radius of MPM_AXISYMMETRIC has no period: use periodic[0] = 0");
  if (!(desc->origin[0] >= 0.0))
    return mpmi_fail(context, MPM_E_ARG,
                     "mpm_grid_desc: origin[0] is %g, must be >= 0: it is a radius of MPM_AXISYMMETRIC",
                     desc->origin[0]);
  if (desc->origin[0] > 0.0 && desc->origin[0] < 1e-6 * desc->spacing[0])
    return mpmi_fail(
        context, MPM_E_ARG,
        "mpm_grid_desc: origin[0] is %g, which is nearly the axis of MPM_AXISYMMETRIC: use 0, or "
        "a radius",
        desc->origin[0]);
  return MPM_OK;
}

static mpm_status check_desc(mpm_context *context, const mpm_grid_desc *desc) {
  if (desc->dim < 1 || desc->dim > 3)
    return mpmi_fail(context, MPM_E_ARG, "mpm_grid_desc: dim is %d, must be 1, 2 or 3", (int)desc->dim);
  mpm_status status = check_basis(context, desc);
  for (int32_t k = 0; k < desc->dim && !status; ++k) status = check_axis(context, desc, k);
  if (status) return status;
  if (!(desc->smoothing > 0 && desc->smoothing <= 1))
    return mpmi_fail(context, MPM_E_ARG, "mpm_grid_desc: smoothing is %g, must be in (0, 1]",
                     desc->smoothing);
  if (desc->total_lagrangian != 0 && desc->total_lagrangian != 1)
    return mpmi_fail(context, MPM_E_ARG, "mpm_grid_desc: total_lagrangian is %d, must be 0 or 1",
                     (int)desc->total_lagrangian);
  return check_geometry(context, desc);
}

/* By family: width, below, centred, ghosts, and the second moment where it is constant. */
static const struct {
  int32_t width, below, centred, ghosts;
  double moment;
} families[MPMI_FAMILIES] = {
    [MPMI_FAMILY_BSPLINE1] = {2, 0, 0, 0, 0.0},       [MPMI_FAMILY_BSPLINE2] = {3, 1, 1, 1, 1.0 / 4.0},
    [MPMI_FAMILY_BSPLINE3] = {4, 1, 0, 1, 1.0 / 3.0}, [MPMI_FAMILY_GIMP] = {3, 1, 1, 1, 0.0},
    [MPMI_FAMILY_OPEN_BSPLINE2] = {3, 0, 0, 0, 0.0},  [MPMI_FAMILY_OPEN_BSPLINE3] = {4, 1, 0, 0, 0.0},
};

static int32_t family_of(const mpm_grid_desc *desc) {
  const basis *row = basis_of(desc->basis);
  int32_t faces = 0;
  for (int32_t k = 0; k < desc->dim; ++k) faces |= !desc->periodic[k];
  return faces && desc->boundary_basis == MPM_BOUNDARY_OPEN_KNOT ? row->open_family : row->family;
}

static void derive(mpm_grid *grid) {
  mpm_grid_desc *desc = &grid->desc;
  /* Axes that do not exist have one cell of unit thickness, whatever the host left there. */
  for (int32_t k = desc->dim; k < 3; ++k) {
    desc->periodic[k] = 0;
    desc->cells[k] = 1;
    desc->origin[k] = 0.0;
    desc->spacing[k] = 1.0;
  }
  grid->dim = desc->dim;
  grid->family = family_of(desc);
  grid->domains = basis_of(desc->basis)->domains;
  grid->width = families[grid->family].width;
  grid->below = families[grid->family].below;
  grid->centred = families[grid->family].centred;
  grid->ghosts = families[grid->family].ghosts;
  grid->moment = families[grid->family].moment;
  grid->h_min = desc->spacing[0];
  for (int32_t k = 0; k < 3; ++k) {
    grid->upper[k] = desc->origin[k] + (double)desc->cells[k] * desc->spacing[k];
    grid->inverse_spacing[k] = 1.0 / desc->spacing[k];
    if (k < desc->dim && desc->spacing[k] < grid->h_min) grid->h_min = desc->spacing[k];
  }
}

mpm_status mpm_grid_create(mpm_context *context, const mpm_grid_desc *desc, mpm_grid **out) {
  if (out) *out = NULL;
  MPMI_ENTER_CONTEXT(context);
  if (!out) return mpmi_fail(context, MPM_E_ARG, "mpm_grid_create: out is NULL");
  mpm_grid made;
  memset(&made, 0, sizeof made);
  mpm_status status = mpmi_read_struct(context, "mpm_grid_desc", desc, sizeof made.desc, &made.desc);
  if (!status) status = check_desc(context, &made.desc);
  if (status) return status;
  made.magic = MPMI_GRID;
  made.context = context;
  derive(&made);
  status = check_node_numbers(context, &made);
  if (status) return status;
  mpm_grid *grid = mpmi_alloc(context, sizeof *grid);
  if (!grid) return MPM_E_NOMEM;
  memcpy(grid, &made, sizeof made);
  context->children++;
  *out = grid;
  return MPM_OK;
}

mpm_status mpm_grid_destroy(mpm_grid *grid) {
  if (!grid) return MPM_OK;
  MPMI_ENTER(grid, MPMI_GRID);
  mpm_context *context = grid->context;
  if (grid->children)
    return mpmi_fail(context, MPM_E_STATE, "%d sets and steppers on the grid still live: destroy them first",
                     (int)grid->children);
  grid->magic = 0;
  context->children--;
  mpmi_free(context, grid, sizeof *grid);
  return MPM_OK;
}

int64_t mpmi_face_node(const mpm_grid *grid, int32_t face) {
  const int64_t cells = grid->desc.cells[face / 2];
  if (!mpmi_is_open(grid, face / 2)) return face % 2 ? cells : 0;
  return face % 2 ? cells + 1 : -grid->below;
}

double mpmi_node_position(const mpm_grid *grid, int32_t axis, int64_t index) {
  const double cells = (double)grid->desc.cells[axis];
  double place = (double)index;
  if (grid->family >= MPMI_FAMILY_OPEN_BSPLINE2) {
    /* The node stands at the mean of the inner knots of its function. Knots are the integers, moved onto
     * the face where they would lie beyond it. */
    const int32_t knots = grid->width - 1, open = mpmi_is_open(grid, axis);
    double sum = 0.0;
    for (int32_t j = 0; j < knots; ++j) {
      double knot = (double)(index + j - 1);
      if (open) knot = knot < 0.0 ? 0.0 : knot > cells ? cells : knot;
      sum += knot;
    }
    place = sum / knots;
  }
  return grid->desc.origin[axis] + place * grid->desc.spacing[axis];
}

/* The last axis is the fastest; the first node of an axis is the lower ghost. */
int64_t mpmi_node_number(const mpm_grid *grid, const int64_t *index) {
  int64_t number = 0;
  for (int32_t k = 0; k < grid->dim; ++k) number = number * axis_nodes(grid, k) + index[k] + 1;
  return number;
}

int32_t mpmi_node_exists(const mpm_grid *grid, const int64_t *index) {
  int32_t exists = 1;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const int64_t first = -grid->below, last_anchor = grid->desc.cells[k] - 1 + grid->centred;
    const int32_t inside = index[k] >= first && index[k] < last_anchor + first + grid->width;
    exists &= inside || grid->desc.periodic[k];
  }
  return exists;
}

/* Returns the position in [lower, upper) that is congruent to x; *periods is how many periods x was away. */
static double wrapped(double x, double lower, double upper, int64_t *periods) {
  double crossed = floor((x - lower) / (upper - lower));
  double place = x - crossed * (upper - lower);
  if (place >= upper) { /* rounding does this where x lies just below a face */
    place = lower;
    crossed += 1.0;
  }
  *periods = (int64_t)crossed;
  return place < lower ? lower : place;
}

const char *mpmi_grid_demand(const mpm_grid *grid, int32_t axis, char *text) {
  const double lower = grid->desc.origin[axis], upper = grid->upper[axis];
  if (grid->desc.periodic[axis])
    snprintf(text, MPMI_GRID_TEXT, "within %.0f periods of %.12g, the lower end of a periodic axis",
             most_periods, lower);
  else
    snprintf(text, MPMI_GRID_TEXT, "inside the grid, in [%.12g, %.12g]", lower, upper);
  return text;
}

int32_t mpmi_grid_place(const mpm_grid *grid, double *position, int64_t stride, int64_t *image,
                        int64_t image_stride) {
  for (int32_t k = 0; k < grid->dim; ++k) {
    double x = position[k * stride], lower = grid->desc.origin[k], upper = grid->upper[k];
    int32_t near = fabs(x - lower) < most_periods * (upper - lower); /* false for NaN */
    if (grid->desc.periodic[k] ? !near : !(x >= lower && x <= upper)) return k;
  }
  for (int32_t k = 0; k < grid->dim; ++k) {
    double *x = position + k * stride, lower = grid->desc.origin[k], upper = grid->upper[k];
    if (!grid->desc.periodic[k] || (*x >= lower && *x < upper)) continue;
    int64_t periods;
    *x = wrapped(*x, lower, upper, &periods);
    if (image) image[k * image_stride] += periods;
  }
  return -1;
}
