/* Nodal fields are written as VTK image data over the box of the active nodes, or as a rectilinear grid
 * where open knots space nodes unevenly. Nodes are visited in the order of the image, with zeros between
 * them, so that memory follows the material and not the box. */
#include "context/radix.h"
#include "io/vtk_file.h"
#include "stepper/node_view.h"
#include "stepper/stepper.h"

#include <string.h>

enum { BUFFER = 4096 };
enum { COORDINATES = -1 }; /* and less: coordinates of an axis; the numbers of fields are not negative */

typedef struct image {
  mpm_stepper *s;
  mpmi_vtk_file file;
  int32_t uneven;          /* 1: nodes are not all one spacing apart */
  int64_t low[3], size[3]; /* of the box, in nodes; size 1 on axes that do not exist */
  int64_t points;          /* nodes of the box */
  int64_t first, active;   /* those of the body in the stepper's list of active nodes */
  int64_t n;               /* active nodes, listed by ascending place */
  int64_t *slot;           /* [n] */
  uint64_t *place;         /* [n] in the image, x fastest */
  size_t bytes;            /* memory of both lists */
} image;

static int32_t shown_components(const mpm_stepper *s, int32_t field) {
  return mpmi_node_fields[field].scalar ? 1 : s->grid->dim > 1 ? 3 : 1;
}

static const char *const axis_names[] = {"x", "y", "z"};

static mpm_status choose_arrays(image *w, int32_t count, const char *const *fields) {
  const mpm_stepper *s = w->s;
  mpm_status status = mpmi_vtk_check_names(s->context, count, fields);
  for (int32_t i = 0; i < count && !status; ++i) {
    int32_t f;
    status = mpmi_node_require(s->context, fields[i], &f);
    if (!status) status = mpmi_node_check_kept(s, f);
    if (!status)
      status = mpmi_vtk_add_named(&w->file, mpmi_node_fields[f].name, f, mpmi_node_fields[f].type,
                                  shown_components(s, f), w->points);
  }
  for (int32_t f = 0; f < MPMI_NODE_FIELDS && !count && !status; ++f) {
    /* The points of the image are the positions, and only what the step has kept can be shown; owned is there
     * for sums. */
    if (f == MPMI_NODE_POSITION || f == MPMI_NODE_OWNED || !mpmi_node_keeps(s, f)) continue;
    if (f >= MPMI_NODE_CONTACT_FORCE && f <= MPMI_NODE_CONTACT_AREA && !s->nodes.contact.listed) continue;
    mpmi_vtk_add(&w->file, mpmi_node_fields[f].name, f, mpmi_node_fields[f].type, shown_components(s, f),
                 w->points);
  }
  for (int32_t k = 0; k < 3 && w->uneven; ++k)
    mpmi_vtk_add(&w->file, axis_names[k], COORDINATES - k, MPM_F64, 1, w->size[k]);
  return status;
}

static void find_box(image *w) {
  const mpm_stepper *s = w->s;
  int64_t high[3] = {0, 0, 0};
  for (int64_t i = 0; i < w->active; ++i) {
    int64_t index[3] = {0, 0, 0};
    mpmi_blocks_index(&s->layout.blocks, s->active[w->first + i], index);
    for (int32_t k = 0; k < 3; ++k) {
      if (i == 0 || index[k] < w->low[k]) w->low[k] = index[k];
      if (i == 0 || index[k] > high[k]) high[k] = index[k];
    }
  }
  w->points = 1; /* does not overflow: grids have no more nodes than 63 bits can number */
  for (int32_t k = 0; k < 3; ++k) {
    w->size[k] = w->active ? high[k] - w->low[k] + 1 : 0;
    w->points *= w->size[k];
  }
}

static mpm_status check_box(const image *w) {
  if (mpmi_vtk_fits(&w->file)) return MPM_OK;
  return mpmi_fail(
      w->s->context, MPM_E_ARG,
      "the box of the active nodes has %lld x %lld x %lld nodes, more than a file can hold: read "
      "the fields with mpm_grid_map()",
      (long long)w->size[0], (long long)w->size[1], (long long)w->size[2]);
}

static uint64_t place_of(const image *w, int64_t slot) {
  int64_t index[3] = {0, 0, 0}, place = 0;
  mpmi_blocks_index(&w->s->layout.blocks, slot, index);
  for (int32_t k = 2; k >= 0; --k) place = place * w->size[k] + index[k] - w->low[k];
  return (uint64_t)place;
}

static mpm_status sort_nodes(image *w) {
  const mpm_stepper *s = w->s;
  mpm_context *context = s->context;
  if (w->active > UINT32_MAX)
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "%lld active nodes are too many for one image: read the fields with mpm_grid_map()",
                     (long long)w->active);
  w->n = w->active;
  w->bytes = mpmi_bytes(w->n, sizeof *w->slot + sizeof *w->place);
  const size_t order_bytes = mpmi_bytes(w->n, 2 * sizeof(uint32_t));
  w->slot = mpmi_alloc(context, w->bytes);
  uint32_t *order = w->slot ? mpmi_alloc(context, order_bytes) : NULL;
  if (!order) {
    mpmi_free(context, w->slot, w->bytes);
    return MPM_E_NOMEM;
  }
  w->place = (uint64_t *)w->slot + w->n;
  for (int64_t i = 0; i < w->n; ++i) w->place[i] = place_of(w, s->active[w->first + i]);
  mpmi_radix_sort(w->n, w->place, order, (uint64_t *)w->slot, order + w->n);
  for (int64_t i = 0; i < w->n; ++i) {
    w->slot[i] = s->active[w->first + order[i]];
    w->place[i] = place_of(w, w->slot[i]);
  }
  mpmi_free(context, order, order_bytes);
  return MPM_OK;
}

static const char *kind_of(const image *w) {
  return w->uneven ? "RectilinearGrid" : "ImageData";
}

static void write_head(image *w) {
  const mpm_grid_desc *grid = &w->s->grid->desc;
  mpmi_output *out = &w->file.out;
  char extent[160], number[6][MPMI_REAL];
  int32_t used = 0;
  for (int32_t k = 0; k < 3; ++k) {
    used += snprintf(extent + used, sizeof extent - (size_t)used, k ? " %lld %lld" : "%lld %lld",
                     (long long)w->low[k], (long long)(w->low[k] + w->size[k] - 1));
    mpmi_print_real(grid->origin[k], number[k]);
    mpmi_print_real(grid->spacing[k], number[3 + k]);
  }
  mpmi_output_print(out, "  <%s WholeExtent=\"%s\"", kind_of(w), extent);
  if (!w->uneven)
    mpmi_output_print(out, " Origin=\"%s %s %s\" Spacing=\"%s %s %s\"", number[0], number[1], number[2],
                      number[3], number[4], number[5]);
  mpmi_output_print(out, ">\n    <Piece Extent=\"%s\">\n      <PointData>\n", extent);
  const int32_t fields = w->file.count - (w->uneven ? 3 : 0);
  mpmi_vtk_tags(&w->file, 0, fields);
  mpmi_output_print(out, "      </PointData>\n");
  if (!w->uneven) return;
  mpmi_output_print(out, "      <Coordinates>\n");
  mpmi_vtk_tags(&w->file, fields, w->file.count);
  mpmi_output_print(out, "      </Coordinates>\n");
}

static void write_coordinates(image *w, int32_t axis) {
  const mpm_grid *grid = w->s->grid;
  double buffer[BUFFER];
  for (int64_t begin = 0, n; begin < w->size[axis]; begin += n) {
    n = w->size[axis] - begin < BUFFER ? w->size[axis] - begin : BUFFER;
    for (int64_t i = 0; i < n; ++i)
      buffer[i] = axis < grid->dim ? mpmi_node_position(grid, axis, w->low[axis] + begin + i) : 0.0;
    mpmi_output_write(&w->file.out, buffer, (size_t)n * sizeof *buffer);
  }
}

static void write_array(image *w, const mpmi_vtk_array *a) {
  const int64_t tuple = a->components * (int64_t)mpmi_type_size(a->type), most = BUFFER / a->components;
  double buffer[BUFFER]; /* holds I64 as well, which has the same size */
  int64_t end = 0;
  mpmi_vtk_start_array(&w->file, a);
  if (a->field <= COORDINATES) {
    write_coordinates(w, COORDINATES - a->field);
    return;
  }
  for (int64_t i = 0, run; i < w->n && !mpmi_output_failed(&w->file.out); i += run) {
    const int64_t begin = (int64_t)w->place[i];
    for (run = 1; run < most && i + run < w->n && (int64_t)w->place[i + run] == begin + run;) ++run;
    memset(buffer, 0, (size_t)(run * tuple)); /* axes that do not exist stay 0 */
    mpmi_node_values(w->s, a->field, w->slot + i, run, a->components, 1, buffer);
    mpmi_output_zeros(&w->file.out, (begin - end) * tuple);
    mpmi_output_write(&w->file.out, buffer, (size_t)(run * tuple));
    end = begin + run;
  }
  mpmi_output_zeros(&w->file.out, (w->points - end) * tuple);
}

/* Readers choose by the suffix what they expect in a file. */
static mpm_status check_suffix(const image *w, const char *path) {
  const char *suffix = path ? strrchr(path, '.') : NULL;
  if (!suffix || strcmp(suffix, w->uneven ? ".vti" : ".vtr")) return MPM_OK;
  return mpmi_fail(w->s->context, MPM_E_ARG,
                   w->uneven
                       ? "\"%s\": nodes of open knots are not evenly spaced, which makes the file a "
                         "rectilinear grid: let its name end with .vtr"
                       : "\"%s\": the nodes are evenly spaced, which makes the file image data: let its "
                         "name end with .vti",
                   path);
}

static mpm_status write_body(mpm_stepper *stepper, int32_t body, const mpmi_target *to, int32_t count,
                             const char *const *fields) {
  mpm_context *context = stepper->context;
  image w = {.s = stepper,
             .file = {.context = context},
             .uneven = stepper->grid->family >= MPMI_FAMILY_OPEN_BSPLINE2};
  mpm_status status = check_suffix(&w, to->path);
  if (!status) status = mpmi_nodes_ready(stepper);
  if (!status) status = mpmi_nodes_list(stepper, body, &w.first, &w.active);
  if (status) return status;
  find_box(&w);
  status = choose_arrays(&w, count, fields);
  if (!status) status = check_box(&w);
  if (!status) status = sort_nodes(&w);
  if (status) return status;
  status = mpmi_vtk_open(&w.file, to, kind_of(&w));
  if (!status) {
    write_head(&w);
    mpmi_vtk_start_data(&w.file, kind_of(&w));
    for (int32_t i = 0; i < w.file.count; ++i) write_array(&w, &w.file.list[i]);
    status = mpmi_vtk_close(&w.file);
  }
  mpmi_free(context, w.slot, w.bytes);
  return status;
}

static mpm_status write_file(mpm_stepper *stepper, int32_t body, const char *path, int32_t count,
                             const char *const *fields) {
  const mpm_status status = mpmi_check_path(stepper->context, path);
  return status ? status : write_body(stepper, body, &(mpmi_target){.path = path}, count, fields);
}

mpm_status mpm_write_grid(mpm_stepper *stepper, const char *path, int32_t count, const char *const *fields) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  return write_file(stepper, 0, path, count, fields);
}

mpm_status mpm_write_body_grid(mpm_stepper *stepper, int32_t body, const char *path, int32_t count,
                               const char *const *fields) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  return write_file(stepper, body, path, count, fields);
}

mpm_status mpm_write_grid_to(mpm_stepper *stepper, int32_t body, mpm_write_fn write, void *user,
                             int32_t count, const char *const *fields) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  const mpm_status status = mpmi_check_write(stepper->context, write);
  return status ? status
                : write_body(stepper, body, &(mpmi_target){.write = write, .user = user}, count, fields);
}
