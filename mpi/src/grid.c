/* Nodal fields as one image in layers. The boxes of the parts overlap, and hold zeros where other parts have
 * their nodes; so the box of all nodes is cut into layers across its longest axis, one for each writer, and
 * nodes with their values go to the writers whose layers they are in. Planes between two layers belong to
 * both. */
#include "head.h"

#include <stdlib.h>
#include <string.h>

enum { FIELDS = 32, DIM = 3 };

/* A node on its way: its place in the image, then the values of all fields. */
typedef struct record {
  int64_t place;
} record;

typedef struct image {
  mpm_mpi *m;
  mpm_stepper *stepper;
  mpmx_place at;
  mpmx_file file;
  mpmx_head head;
  mpm_status failed; /* in taking the head */
  int32_t fields;
  mpmx_array field[FIELDS];
  size_t record; /* bytes of one */
  int32_t dim;
  int64_t nodes;  /* of this part */
  int64_t *index; /* [nodes][DIM] */
  char *values;   /* [nodes] records */
  size_t index_bytes, values_bytes;
  int64_t low[DIM], high[DIM]; /* of the box, inclusive */
  int32_t axis, layers;
  /* what goes where, in records */
  int *count, *begin; /* [2][parts] each: sent, received */
  size_t count_bytes;
  char *sent, *received;
  size_t sent_bytes, received_bytes;
  int64_t got;
  int64_t *order; /* [got] received records by place */
  size_t order_bytes;
} image;

static mpm_status no_memory(mpm_mpi *m) {
  return mpmx_fail(m, MPM_E_NOMEM, "there is no memory for the nodes");
}

static mpm_status refused(mpm_mpi *m, const char *call, mpm_status status) {
  return status ? mpmx_fail(m, status, "%s: %s, %s", call, mpm_status_name(status), mpm_status_text(status))
                : MPM_OK;
}

/* ---- what the library would write: its fields, and the axes, in its own digits */

static mpm_status take_head(void *user, const void *data, int64_t bytes) {
  image *w = user;
  int64_t taken;
  w->failed = mpmx_head_take(w->m, &w->head, data, bytes, &taken);
  return w->failed ? w->failed : w->head.whole;
}

static mpm_status read_head(image *w, const mpm_mpi_output *as) {
  mpm_mpi *m = w->m;
  const mpm_status status = mpm_write_grid_to(w->stepper, 0, take_head, w, as->count, as->fields);
  if (w->failed) return w->failed;
  /* it is told to end when the head is there */
  if (!w->head.whole) return refused(m, "mpm_write_grid_to", status ? status : MPM_E_INTERNAL);
  if (!strstr(w->head.text, "<ImageData "))
    return mpmx_fail(
        m, MPM_E_UNSUPPORTED,
        "nodes of open knots are not evenly spaced: mpm_write_grid() writes those of a part into a .vtr");
  for (const char *next = w->head.text;
       w->fields < FIELDS && mpmx_head_next(&next, NULL, &w->field[w->fields]);)
    w->record += (size_t)w->field[w->fields].components * (size_t)w->field[w->fields].size, ++w->fields;
  /* records are whole numbers of doubles */
  w->record = sizeof(record) + (w->record + 7) / 8 * 8;
  return MPM_OK;
}

/* The fields of all parts, in the order of the library, where the host names none: a part on which no
 * bodies meet has kept none of contact, and one part would have them. */
static mpm_status read_heads(image *w, const mpm_mpi_output *as) {
  static const char *const name[] = {"index",        "mass",         "velocity",      "force",
                                     "acceleration", "reaction",     "contact_force", "contact_normal",
                                     "contact_gap",  "contact_area", "temperature"};
  enum { NAMES = sizeof name / sizeof *name };
  mpm_mpi *m = w->m;
  mpm_status status = mpmx_agree(m, read_head(w, as));
  if (status || as->count) return status;
  uint64_t own = 0;
  for (int32_t f = 0; f < w->fields; ++f)
    for (int32_t k = 0; k < NAMES; ++k)
      if (!strcmp(w->field[f].name, name[k])) own |= (uint64_t)1 << k;
  uint64_t all = own;
  status = mpmx_mpi(m, MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_UINT64_T, MPI_BOR, m->comm), MPM_E_CALLBACK,
                    "MPI_Allreduce");
  if (status || all == own) return status;
  const char *wanted[NAMES];
  mpm_mpi_output named = *as;
  named.fields = wanted;
  for (int32_t k = 0; k < NAMES; ++k)
    if (all >> k & 1) wanted[named.count++] = name[k];
  mpmx_head_free(m, &w->head);
  w->fields = 0;
  w->record = 0;
  return read_head(w, &named);
}

static mpm_status map(image *w, const char *name, mpm_view *view) {
  *view = (mpm_view){.struct_size = sizeof *view};
  return refused(w->m, "mpm_grid_map", mpm_grid_map(w->stepper, 0, name, MPM_READ, view));
}

static mpm_status read_indices(image *w) {
  mpm_view view;
  mpm_status status = map(w, "index", &view);
  if (status) return status;
  w->dim = view.components;
  w->nodes = view.count;
  w->index_bytes = (size_t)w->nodes * DIM * sizeof *w->index;
  w->values_bytes = (size_t)w->nodes * w->record;
  w->index = mpmx_alloc(w->m, w->index_bytes);
  w->values = mpmx_alloc(w->m, w->values_bytes);
  if (!w->index || !w->values) status = no_memory(w->m);
  const int64_t *data = view.data;
  for (int64_t i = 0; i < w->nodes && !status; ++i)
    for (int32_t k = 0; k < DIM; ++k)
      w->index[DIM * i + k] = k < w->dim ? data[i * view.item_stride + k * view.component_stride] : 0;
  mpm_view_release(&view);
  return status;
}

/* Vectors have three components in the image, and those that do not exist are 0. */
static void copy_values(const image *w, const mpmx_array *a, const mpm_view *view, size_t at) {
  for (int64_t i = 0; i < w->nodes; ++i) {
    char *to = w->values + (size_t)i * w->record + at;
    for (int32_t c = 0; c < view->components && c < a->components; ++c) {
      const int64_t from = i * view->item_stride + c * view->component_stride;
      memcpy(to + (size_t)c * (size_t)a->size, (const char *)view->data + (size_t)from * (size_t)a->size,
             (size_t)a->size);
    }
  }
}

static mpm_status read_values(image *w) {
  mpm_status status = read_indices(w);
  if (status) return status;
  memset(w->values, 0, w->values_bytes);
  size_t at = sizeof(record);
  for (int32_t f = 0; f < w->fields && !status; ++f) {
    mpm_view view;
    status = map(w, w->field[f].name, &view);
    if (status) return status;
    if (view.count != w->nodes)
      status = mpmx_fail(w->m, MPM_E_INTERNAL, "\"%.60s\" has %lld nodes, \"index\" has %lld",
                         w->field[f].name, (long long)view.count, (long long)w->nodes);
    else
      copy_values(w, &w->field[f], &view, at);
    mpm_view_release(&view);
    at += (size_t)w->field[f].components * (size_t)w->field[f].size;
  }
  return status;
}

/* ---- layers */

static mpm_status find_box(image *w) {
  int64_t ends[2 * DIM]; /* maxima: the highest, and the lowest with the other sign */
  for (int32_t k = 0; k < 2 * DIM; ++k) ends[k] = INT64_MIN;
  for (int64_t i = 0; i < w->nodes; ++i)
    for (int32_t k = 0; k < DIM; ++k) {
      const int64_t at = w->index[DIM * i + k];
      if (at > ends[k]) ends[k] = at;
      if (-at > ends[DIM + k]) ends[DIM + k] = -at;
    }
  const mpm_status status =
      mpmx_mpi(w->m, MPI_Allreduce(MPI_IN_PLACE, ends, 2 * DIM, MPI_INT64_T, MPI_MAX, w->m->comm),
               MPM_E_CALLBACK, "MPI_Allreduce");
  if (status) return status;
  const int32_t none = ends[0] == INT64_MIN;
  for (int32_t k = 0; k < DIM; ++k) {
    w->high[k] = none ? -1 : ends[k];
    w->low[k] = none ? 0 : -ends[DIM + k];
    if (w->high[k] - w->low[k] > w->high[w->axis] - w->low[w->axis]) w->axis = k;
  }
  const int64_t cells = w->high[w->axis] - w->low[w->axis];
  w->layers = cells < w->m->writers ? (int32_t)(cells < 1 ? 1 : cells) : w->m->writers;
  /* places of nodes and bytes of arrays are numbers of 63 bits */
  int64_t points = 24;
  for (int32_t k = 0; k < DIM; ++k)
    if (__builtin_mul_overflow(points, w->high[k] - w->low[k] + 1, &points))
      return mpmx_fail(
          w->m, MPM_E_ARG,
          "the box of the active nodes has %lld x %lld x %lld nodes, more than a file can hold: read "
          "the fields with mpm_grid_map()",
          (long long)(w->high[0] - w->low[0] + 1), (long long)(w->high[1] - w->low[1] + 1),
          (long long)(w->high[2] - w->low[2] + 1));
  return MPM_OK;
}

/* First plane of a layer, which is the last one of that below. */
static int64_t plane(const image *w, int32_t layer) {
  return w->low[w->axis] + (w->high[w->axis] - w->low[w->axis]) * layer / w->layers;
}

/* The layers that a plane is in: one, or two. */
static int32_t layer_of(const image *w, int64_t at, int32_t *also) {
  const int64_t cells = w->high[w->axis] - w->low[w->axis];
  int32_t layer = cells ? (int32_t)((at - w->low[w->axis]) * w->layers / cells) : 0;
  if (layer >= w->layers) layer = w->layers - 1;
  while (layer > 0 && plane(w, layer) > at) --layer;
  while (layer + 1 < w->layers && plane(w, layer + 1) <= at) ++layer;
  *also = layer > 0 && plane(w, layer) == at ? layer - 1 : -1;
  return layer;
}

static void extent(const image *w, int32_t layer, int64_t low[DIM], int64_t high[DIM]) {
  for (int32_t k = 0; k < DIM; ++k) {
    low[k] = k == w->axis ? plane(w, layer) : w->low[k];
    high[k] = k == w->axis ? plane(w, layer + 1) : w->high[k];
  }
}

static int64_t place_in(const image *w, int32_t layer, const int64_t *index) {
  int64_t low[DIM], high[DIM], place = 0;
  extent(w, layer, low, high);
  for (int32_t k = DIM; k-- > 0;) place = place * (high[k] - low[k] + 1) + index[k] - low[k];
  return place;
}

/* ---- to the writers */

/* The parts that write the layers, in their order. */
static mpm_status find_writers(image *w, int *writer_of) {
  int member = 0;
  MPI_Comm_rank(w->m->group, &member);
  const int mine = member ? -1 : w->m->writer;
  int *all = w->count; /* free until the counts are made */
  const mpm_status status = mpmx_mpi(w->m, MPI_Allgather(&mine, 1, MPI_INT, all, 1, MPI_INT, w->m->comm),
                                     MPM_E_CALLBACK, "MPI_Allgather");
  for (int32_t i = 0; i < w->m->parts && !status; ++i)
    if (all[i] >= 0) writer_of[all[i]] = i;
  return status;
}

/* Counts the records for each writer; with `to` puts them there. */
static void sort_out(image *w, const int *writer_of, int64_t *at, int32_t put) {
  for (int64_t i = 0; i < w->nodes; ++i) {
    const int64_t *index = w->index + DIM * i;
    int32_t layer[2];
    layer[0] = layer_of(w, index[w->axis], &layer[1]);
    for (int32_t k = 0; k < 2; ++k) {
      if (layer[k] < 0) continue;
      const int64_t place = at[writer_of[layer[k]]]++;
      if (!put) continue;
      char *to = w->sent + (size_t)place * w->record;
      memcpy(to, w->values + (size_t)i * w->record, w->record);
      const int64_t in = place_in(w, layer[k], index);
      memcpy(to, &in, sizeof in);
    }
  }
}

static mpm_status count_records(image *w, const int *writer_of, int64_t *at, int64_t *all) {
  mpm_mpi *m = w->m;
  int *sends = w->count;
  for (int32_t i = 0; i < m->parts; ++i) at[i] = 0;
  sort_out(w, writer_of, at, 0);
  *all = 0;
  for (int32_t i = 0; i < m->parts; ++i) {
    const int64_t n = at[i];
    at[i] = *all;
    if (*all + n > INT32_MAX)
      return mpmx_fail(m, MPM_E_UNSUPPORTED,
                       "a part has too many nodes for one image: write each with mpm_write_grid()");
    w->begin[i] = (int)*all;
    sends[i] = (int)n;
    *all += n;
  }
  return MPM_OK;
}

static mpm_status exchange(image *w) {
  mpm_mpi *m = w->m;
  const size_t parts = (size_t)m->parts;
  w->count_bytes = 4 * parts * sizeof(int) + parts * sizeof(int64_t) + (size_t)m->writers * sizeof(int);
  int64_t *at = mpmx_alloc(m, w->count_bytes), all = 0;
  mpm_status status = mpmx_agree(m, at ? MPM_OK : no_memory(m));
  if (status) {
    mpmx_free(m, at, w->count_bytes);
    return status;
  }
  w->count = (int *)(at + parts);
  w->begin = w->count + 2 * parts;
  int *writer_of = w->begin + 2 * parts;
  status = mpmx_agree(m, find_writers(w, writer_of));
  if (!status) status = mpmx_agree(m, count_records(w, writer_of, at, &all));
  if (!status)
    status = mpmx_mpi(m, MPI_Alltoall(w->count, 1, MPI_INT, w->count + parts, 1, MPI_INT, m->comm),
                      MPM_E_CALLBACK, "MPI_Alltoall");
  for (size_t i = 0; i < parts && !status; ++i) {
    w->begin[parts + i] = (int)w->got;
    w->got += w->count[parts + i];
    if (w->got > INT32_MAX)
      status = mpmx_fail(m, MPM_E_UNSUPPORTED, "a writer would have too many nodes: ask for more writers");
  }
  if (!status) {
    w->sent_bytes = (size_t)all * w->record;
    w->received_bytes = (size_t)w->got * w->record;
    w->order_bytes = (size_t)w->got * 2 * sizeof *w->order;
    w->sent = mpmx_alloc(m, w->sent_bytes);
    w->received = mpmx_alloc(m, w->received_bytes);
    w->order = mpmx_alloc(m, w->order_bytes);
    if (!w->sent || !w->received || !w->order) status = no_memory(m);
  }
  status = mpmx_agree(m, status);
  MPI_Datatype type = MPI_DATATYPE_NULL;
  if (!status) {
    sort_out(w, writer_of, at, 1);
    status = mpmx_mpi(m, MPI_Type_contiguous((int)w->record, MPI_BYTE, &type), MPM_E_CALLBACK,
                      "MPI_Type_contiguous");
    if (!status) status = mpmx_mpi(m, MPI_Type_commit(&type), MPM_E_CALLBACK, "MPI_Type_commit");
    if (!status)
      status = mpmx_mpi(m,
                        MPI_Alltoallv(w->sent, w->count, w->begin, type, w->received, w->count + parts,
                                      w->begin + parts, type, m->comm),
                        MPM_E_CALLBACK, "MPI_Alltoallv");
    if (type != MPI_DATATYPE_NULL) MPI_Type_free(&type);
  }
  mpmx_free(m, at, w->count_bytes);
  return status;
}

/* ---- files */

static int by_place(const void *a, const void *b) {
  const int64_t *x = a, *y = b;
  if (x[0] != y[0]) return x[0] < y[0] ? -1 : 1;
  return (x[1] > y[1]) - (x[1] < y[1]);
}

/* Nodes of several parts are alike on all of them: the first is taken. */
static void order_nodes(image *w) {
  for (int64_t i = 0; i < w->got; ++i) {
    memcpy(&w->order[2 * i], w->received + (size_t)i * w->record, sizeof *w->order);
    w->order[2 * i + 1] = i;
  }
  if (w->got) qsort(w->order, (size_t)w->got, 2 * sizeof *w->order, by_place);
  int64_t kept = 0;
  for (int64_t i = 0; i < w->got; ++i) {
    if (kept && w->order[2 * kept - 2] == w->order[2 * i]) continue;
    w->order[2 * kept] = w->order[2 * i];
    w->order[2 * kept + 1] = w->order[2 * i + 1];
    ++kept;
  }
  w->got = kept;
}

static void print_extent(mpmx_file *file, const char *name, const int64_t low[DIM], const int64_t high[DIM]) {
  mpmx_file_print(file, " %s=\"%lld %lld %lld %lld %lld %lld\"", name, (long long)low[0], (long long)high[0],
                  (long long)low[1], (long long)high[1], (long long)low[2], (long long)high[2]);
}

static void print_axes(const image *w, mpmx_file *file) {
  static const char *const names[] = {"Origin", "Spacing"};
  const char *element = strstr(w->head.text, "<ImageData ");
  char value[160];
  for (int32_t i = 0; i < 2; ++i)
    if (mpmx_attribute(element, names[i], value, sizeof value))
      mpmx_file_print(file, " %s=\"%s\"", names[i], value);
}

static void write_data(image *w, const mpmx_array *a, size_t at, int64_t points) {
  const size_t tuple = (size_t)a->components * (size_t)a->size;
  const uint64_t bytes = (uint64_t)points * tuple;
  mpmx_file_write(&w->file, &bytes, sizeof bytes);
  int64_t end = 0;
  for (int64_t i = 0; i < w->got; ++i) {
    mpmx_file_zeros(&w->file, (w->order[2 * i] - end) * (int64_t)tuple);
    mpmx_file_write(&w->file, w->received + (size_t)w->order[2 * i + 1] * w->record + at, tuple);
    end = w->order[2 * i] + 1;
  }
  mpmx_file_zeros(&w->file, (points - end) * (int64_t)tuple);
}

static mpm_status write_layer(image *w) {
  mpm_mpi *m = w->m;
  int member = 0;
  MPI_Comm_rank(m->group, &member);
  if (member || m->writer >= w->layers) return MPM_OK;
  mpm_status status = mpmx_file_open(m, &w->file, w->at.piece);
  if (status) return status;
  order_nodes(w);
  int64_t low[DIM], high[DIM], points = 1, offset = 0;
  extent(w, m->writer, low, high);
  for (int32_t k = 0; k < DIM; ++k) points *= high[k] - low[k] + 1;
  mpmx_file *file = &w->file;
  mpmx_print_start(file, "ImageData");
  mpmx_file_print(file, "  <ImageData");
  print_extent(file, "WholeExtent", low, high);
  print_axes(w, file);
  mpmx_file_print(file, ">\n    <Piece");
  print_extent(file, "Extent", low, high);
  mpmx_file_print(file, ">\n      <PointData>\n");
  for (int32_t f = 0; f < w->fields; ++f) {
    const mpmx_array *a = &w->field[f];
    mpmx_file_print(
        file,
        "        <DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" "
        "offset=\"%lld\"/>\n",
        a->type, a->name, (int)a->components, (long long)offset);
    offset += (int64_t)sizeof(uint64_t) + points * a->components * a->size;
  }
  mpmx_file_print(file, "      </PointData>\n    </Piece>\n  </ImageData>\n" MPMX_DATA_FOLLOW);
  size_t at = sizeof(record);
  for (int32_t f = 0; f < w->fields; ++f) {
    write_data(w, &w->field[f], at, points);
    at += (size_t)w->field[f].components * (size_t)w->field[f].size;
  }
  mpmx_file_print(file, MPMX_DATA_END);
  return mpmx_file_close(m, file, 0);
}

static mpm_status write_index(image *w) {
  mpm_mpi *m = w->m;
  mpmx_file index;
  if (m->part) return MPM_OK;
  const mpm_status status = mpmx_file_open(m, &index, w->at.index);
  if (status) return status;
  mpmx_print_start(&index, "PImageData");
  mpmx_file_print(&index, "  <PImageData GhostLevel=\"0\"");
  print_extent(&index, "WholeExtent", w->low, w->high);
  print_axes(w, &index);
  mpmx_file_print(&index, ">\n");
  mpmx_head_index(&w->head, "PointData", &index);
  for (int32_t i = 0; i < w->layers; ++i) {
    int64_t low[DIM], high[DIM];
    extent(w, i, low, high);
    mpmx_file_print(&index, "    <Piece");
    print_extent(&index, "Extent", low, high);
    mpmx_print_source(&index, &w->at, i, ".vti");
  }
  mpmx_file_print(&index, "  </PImageData>\n</VTKFile>\n");
  return mpmx_file_close(m, &index, 0);
}

static mpm_status write_image(image *w, const mpm_mpi_output *as) {
  mpm_mpi *m = w->m;
  mpm_status status = read_heads(w, as);
  status =
      mpmx_agree_on(m, status, status ? 0 : mpmx_head_hash(&w->head), MPM_E_UNSUPPORTED,
                    "the fields that the step has kept differ between the parts: name those that are to be "
                    "written");
  if (!status) status = mpmx_agree(m, read_values(w));
  if (!status) status = mpmx_agree(m, find_box(w));
  if (!status) status = mpmx_agree(m, exchange(w));
  if (!status) status = mpmx_agree(m, write_layer(w));
  return status ? status : mpmx_agree(m, write_index(w));
}

mpm_status mpm_mpi_write_grid(mpm_mpi *m, mpm_stepper *stepper, const char *path,
                              const mpm_mpi_output *given) {
  if (!m) return MPM_E_ARG;
  mpm_mpi_output as;
  mpm_status status =
      mpmx_output_begin(m, stepper ? MPM_OK : mpmx_fail(m, MPM_E_ARG, "stepper is NULL"), given, path, &as);
  if (status) return status;
  image w = {.m = m, .stepper = stepper};
  status = mpmx_place_make(m, &w.at, path, ".pvti", ".vti");
  if (!status) status = write_image(&w, &as);
  mpmx_place_free(m, &w.at);
  mpmx_head_free(m, &w.head);
  mpmx_free(m, w.index, w.index_bytes);
  mpmx_free(m, w.values, w.values_bytes);
  mpmx_free(m, w.sent, w.sent_bytes);
  mpmx_free(m, w.received, w.received_bytes);
  mpmx_free(m, w.order, w.order_bytes);
  return status;
}
