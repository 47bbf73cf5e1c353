/* Nodal fields in files: every byte of the image, sparse boxes, and what is refused.
 * VTK reads such files elsewhere. */
#define _POSIX_C_SOURCE   200809L
#define _FILE_OFFSET_BITS 64
#include "io.h"

#include <sys/stat.h>
#include <unistd.h>

static const char *const all[] = {"index", "position",     "mass",    "velocity",
                                  "force", "acceleration", "reaction"};
enum { ALL = 7, HEAD = 1 << 13 };

/* A file of nodal fields: its head as text, and what is read from that. */
typedef struct image {
  char path[640], head[HEAD];
  FILE *file;
  int64_t data; /* first byte of the appended data */
  long long low[3], high[3];
} image;

static void open_image(image *f) {
  f->file = fopen(f->path, "rb");
  ck_assert_ptr_nonnull(f->file);
  const size_t bytes = fread(f->head, 1, HEAD - 1, f->file);
  f->head[bytes] = '\0'; /* text functions end at the first zero, which the data begin with */
  const char *data = strstr(f->head, "encoding=\"raw\">\n_"), *extent = strstr(f->head, "<Piece Extent=\"");
  ck_assert_ptr_nonnull(data);
  ck_assert_ptr_nonnull(extent);
  f->data = data - f->head + (int64_t)strlen("encoding=\"raw\">\n_");
  ck_assert_int_eq(sscanf(extent, "<Piece Extent=\"%lld %lld %lld %lld %lld %lld\"", &f->low[0], &f->high[0],
                          &f->low[1], &f->high[1], &f->low[2], &f->high[2]),
                   6);
}

static int64_t points(const image *f) {
  return (f->high[0] - f->low[0] + 1) * (f->high[1] - f->low[1] + 1) * (f->high[2] - f->low[2] + 1);
}

/* First byte of an array, or -1; its components. */
static int64_t find_array(const image *f, const char *name, int32_t *components) {
  char tag[64];
  int n = 0;
  long long offset = -1;
  snprintf(tag, sizeof tag, "Name=\"%s\"", name);
  const char *at = strstr(f->head, tag);
  if (!at) return -1;
  ck_assert_int_eq(
      sscanf(at + strlen(tag), " NumberOfComponents=\"%d\" format=\"appended\" offset=\"%lld\"", &n, &offset),
      2);
  *components = n;
  uint64_t bytes = 0;
  fseeko(f->file, f->data + offset, SEEK_SET);
  ck_assert_uint_eq(fread(&bytes, sizeof bytes, 1, f->file), 1);
  ck_assert_uint_eq(bytes, (uint64_t)points(f) * (uint64_t)n * 8);
  return f->data + offset + (int64_t)sizeof bytes;
}

static void read_tuple(const image *f, int64_t array, int64_t point, int32_t components, void *out) {
  fseeko(f->file, array + 8 * point * components, SEEK_SET);
  ck_assert_uint_eq(fread(out, 8, (size_t)components, f->file), (size_t)components);
}

static mpm_view map(const world *w, const char *field) {
  mpm_view v = {.struct_size = sizeof v};
  ck_ok(w, mpm_grid_map(w->stepper, 0, field, MPM_READ, &v));
  return v;
}

/* Where the nodes of the stepper lie in the image, in the order of its views; to be freed. */
static int64_t *places(const image *f, const world *w, int64_t *count) {
  mpm_view v = map(w, "index");
  int64_t *place = calloc((size_t)v.count + 1, sizeof *place);
  for (int64_t i = 0; i < v.count; ++i)
    for (int32_t k = v.components - 1; k >= 0; --k) {
      const int64_t index = ((const int64_t *)v.data)[i + k * v.component_stride];
      if (index < f->low[k] || index > f->high[k]) ck_abort_msg("a node lies outside the box");
      place[i] = place[i] * (f->high[k] - f->low[k] + 1) + index - f->low[k];
    }
  *count = v.count;
  ck_ok(w, mpm_view_release(&v));
  return place;
}

/* The named field at every active node; with `zeros`, zero at all other points. Returns whether it is there.
 */
static int32_t check_field(const image *f, const world *w, const char *name, int32_t zeros) {
  int32_t components;
  const int64_t array = find_array(f, name, &components);
  if (array < 0) return 0;
  int64_t n;
  int64_t *place = places(f, w, &n), is[3], wanted[3];
  unsigned char *seen = zeros ? calloc(1, (size_t)points(f) + 1) : NULL;
  mpm_view v = map(w, name);
  ck_assert_int_eq(components, v.components > 1 ? 3 : 1);
  for (int64_t i = 0; i < n; ++i) {
    memset(wanted, 0, sizeof wanted);
    for (int32_t c = 0; c < v.components; ++c)
      memcpy(&wanted[c], (const char *)v.data + 8 * (i + c * v.component_stride), 8);
    read_tuple(f, array, place[i], components, is);
    if (memcmp(is, wanted, 8 * (size_t)components)) ck_abort_msg("%s of node %d differs", name, (int)i);
    if (seen) ck_assert_int_eq(seen[place[i]]++, 0);
  }
  for (int64_t p = 0; seen && p < points(f); ++p) {
    if (seen[p]) continue;
    read_tuple(f, array, p, components, is);
    for (int32_t c = 0; c < components; ++c)
      if (is[c]) ck_abort_msg("%s is not zero where there is no node", name);
  }
  ck_ok(w, mpm_view_release(&v));
  free(seen);
  free(place);
  return 1;
}

/* All fields of two bodies in every dimension and kind of step; what fills the box between them is zero. */
START_TEST(every_number) {
  const int32_t dim = 1 + _i % 3, mls = _i / 3 % 2, staged = _i / 6;
  io_setup setup = io_plain(dim);
  setup.transfer = mls ? MPM_APIC_MLS : MPM_FLIP;
  setup.periodic = dim == 3;
  world w;
  io_open(&w, &setup);
  world_steps(&w, 2);
  if (staged) ck_ok(&w, mpm_step_begin(w.stepper, 0.004));
  static image f;
  scratch_path("all.vti", f.path, sizeof f.path);
  ck_ok(&w, mpm_write_grid(w.stepper, f.path, 0, NULL));
  open_image(&f);
  int64_t n;
  free(places(&f, &w, &n));
  ck_assert_int_ge(points(&f), n + (dim > 1)); /* there is a gap */
  for (int32_t k = 0; k < ALL; ++k) {
    const int32_t kept = k != 1 && !(mls && !staged && (k == 4 || k == 5));
    ck_assert_int_eq(check_field(&f, &w, all[k], 1), kept);
  }
  char text[80];
  snprintf(text, sizeof text, "Origin=\"-35 %s", dim == 1 ? "0 0\"" : dim == 2 ? "-1 0\"" : "-1 -1\"");
  ck_assert_ptr_nonnull(strstr(f.head, text));
  fclose(f.file);
  static const char *const some[] = {"velocity", "position"};
  ck_ok(&w, mpm_write_grid(w.stepper, f.path, 2, some));
  open_image(&f);
  for (int32_t k = 0; k < ALL; ++k) ck_assert_int_eq(check_field(&f, &w, all[k], 1), k == 1 || k == 3);
  fclose(f.file);
  if (staged) ck_ok(&w, mpm_step_abort(w.stepper));
  world_close(&w);
}
END_TEST

/* 40000 x 40000 nodes, of which 18 are active: memory and time are theirs. */
START_TEST(sparse_box) {
  static const char *const some[] = {"mass", "velocity"};
  world w;
  io_open_apart(&w, 2, 40000);
  static image f;
  scratch_path("sparse.vti", f.path, sizeof f.path);
  int64_t before, peak;
  ck_ok(&w, mpm_context_memory(w.context, &before, NULL));
  ck_ok(&w, mpm_write_grid(w.stepper, f.path, 2, some));
  ck_ok(&w, mpm_context_memory(w.context, NULL, &peak));
  ck_assert_int_lt(peak - before, 100000);
  open_image(&f);
  ck_assert_int_gt(points(&f), INT64_C(1500000000));
  ck_assert_int_eq(check_field(&f, &w, "mass", 0), 1);
  ck_assert_int_eq(check_field(&f, &w, "velocity", 0), 1);
  int32_t components;
  const int64_t array = find_array(&f, "velocity", &components);
  for (int64_t p = 100; p < points(&f) - 100; p += 15485863) { /* nowhere near the particles */
    double v[3];
    read_tuple(&f, array, p, 3, v);
    ck_assert(v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0);
  }
  struct stat info;
  ck_assert_int_eq(fstat(fileno(f.file), &info), 0);
  ck_assert_int_gt(info.st_size, points(&f) * 32);
  fclose(f.file);
  unlink(f.path);
  world_close(&w);
}
END_TEST

START_TEST(box_beyond_a_file) {
  static const char *const some[] = {"mass"};
  world w;
  char path[640];
  scratch_path("beyond.vti", path, sizeof path);
  unlink(path);
  io_open_apart(&w, 3, 2000000);
  ck_refused(&w, mpm_write_grid(w.stepper, path, 1, some), MPM_E_ARG, "mpm_grid_map()");
  ck_assert_int_ne(access(path, F_OK), 0);
  world_close(&w);
  io_open_apart(&w, 3, 900000); /* offsets could name it, but no file is as long */
  ck_refused(&w, mpm_write_grid(w.stepper, path, 1, some), MPM_E_IO, "beyond.vti");
  ck_assert_int_ne(access(path, F_OK), 0);
  world_close(&w);
}
END_TEST

START_TEST(refused) {
  io_setup setup = io_plain(2);
  world w;
  io_open(&w, &setup);
  mpm_context *c = w.context;
  char path[640];
  scratch_path("refused.vti", path, sizeof path);
  unlink(path);
  const char *const bad[] = {"mass", "velocty"}, *const twice[] = {"mass", "force", "mass"},
                    *const none[] = {NULL}, *const force[] = {"force"},
                    *const acceleration[] = {"acceleration"};
  ck_assert_int_eq(mpm_write_grid(NULL, path, 0, NULL), MPM_E_ARG);
  ck_refused(c, mpm_write_grid(w.stepper, path, 0, NULL), MPM_E_STATE, "no nodal fields");
  world_steps(&w, 1);
  ck_refused(c, mpm_write_grid(w.stepper, NULL, 0, NULL), MPM_E_ARG, "path");
  ck_refused(c, mpm_write_grid(w.stepper, "", 0, NULL), MPM_E_ARG, "path");
  ck_refused(c, mpm_write_grid(w.stepper, path, -1, bad), MPM_E_ARG, "count is -1");
  ck_refused(c, mpm_write_grid(w.stepper, path, 1, NULL), MPM_E_ARG, "fields");
  ck_refused(c, mpm_write_grid(w.stepper, path, 1, none), MPM_E_ARG, "NULL");
  ck_refused(c, mpm_write_grid(w.stepper, path, 2, bad), MPM_E_NOT_FOUND, "nearest: velocity");
  ck_refused(c, mpm_write_grid(w.stepper, path, 3, twice), MPM_E_ARG, "\"mass\" is named twice");
  ck_refused(c, mpm_write_grid(w.stepper, "no/such/place.vti", 0, NULL), MPM_E_IO, "no/such/place.vti");
  ck_assert_int_ne(access(path, F_OK), 0);
  ck_refused(c, mpm_write_grid(w.stepper, "refused.vtr", 0, NULL), MPM_E_ARG, "end with .vti");
  for (int64_t k = 1; k <= 3; ++k) { /* the list of nodes; places; order; the file's name */
    w.memory.calls = 0;
    w.memory.fail_at = k;
    ck_assert_int_eq(mpm_write_grid(w.stepper, path, 0, NULL), MPM_E_NOMEM);
    ck_assert_int_ne(access(path, F_OK), 0);
  }
  w.memory.fail_at = 0;
  ck_ok(&w, mpm_write_grid(w.stepper, path, 0, NULL));
  mpm_stepper_desc desc = w.desc.stepper;
  desc.transfer = MPM_APIC_MLS;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &desc));
  ck_ok(&w, mpm_write_grid(w.stepper, path, 1, force)); /* the last step was another */
  world_steps(&w, 1);
  ck_refused(c, mpm_write_grid(w.stepper, path, 1, force), MPM_E_UNSUPPORTED, "MPM_APIC");
  ck_refused(c, mpm_write_grid(w.stepper, path, 1, acceleration), MPM_E_UNSUPPORTED, "staged step");
  ck_ok(&w, mpm_write_grid(w.stepper, path, 0, NULL));
  ck_assert_ptr_nonnull(strstr(mpm_last_error(c), "staged step")); /* of the call that failed */
  world_close(&w);
}
END_TEST

/* Nodal fields are those of the last step whatever has happened to the particles since. */
START_TEST(fields_of_the_last_step) {
  const io_setup setup = io_plain(2);
  world w;
  io_open(&w, &setup);
  world_steps(&w, 3);
  static image f;
  scratch_path("last.vti", f.path, sizeof f.path);
  mpm_view kept = map(&w, "force"); /* the list of nodes is in use */
  ck_ok(&w, mpm_write_grid(w.stepper, f.path, 0, NULL));
  ck_ok(&w, mpm_view_release(&kept));
  open_image(&f);
  ck_assert_int_eq(check_field(&f, &w, "force", 1), 1);
  const int64_t gone[] = {0, 1, 2};
  double dt;
  ck_ok(&w, mpm_particles_remove(w.set[0], 3, gone));
  ck_ok(&w, mpm_stable_dt(w.stepper, &dt));
  ck_assert_int_eq(check_field(&f, &w, "force", 1), 1);
  fclose(f.file);
  world_close(&w);
}
END_TEST

/* ---- open knots: nodes at Greville points ---- */
static void open_knots(world *w, int32_t dim, int32_t basis) {
  mpm_grid_desc grid = grid_desc(dim, 9, 0.1);
  grid.basis = basis;
  grid.boundary_basis = MPM_BOUNDARY_OPEN_KNOT;
  for (int32_t k = 0; k < dim; ++k)
    grid.spacing[k] = 0.1 + 0.07 * k, grid.origin[k] = k - 0.3, grid.periodic[k] = k == 1;
  double upper[3];
  for (int32_t k = 0; k < 3; ++k) upper[k] = grid.origin[k] + (k ? 6.0 : 9.0) * grid.spacing[k];
  const world_desc d = io_bare_desc(&grid);
  world_open(w, &d);
  world_fill(w, w->set[0], grid.origin, upper, 2);
  world_step(w, 1e-5);
}

/* First byte of the coordinates along an axis. */
static int64_t find_coordinates(const image *f, int32_t axis) {
  static const char *const name[] = {"Name=\"x\"", "Name=\"y\"", "Name=\"z\""};
  const char *at = strstr(f->head, "<Coordinates>");
  long long offset = -1;
  ck_assert_ptr_nonnull(at);
  at = strstr(at, name[axis]);
  ck_assert_ptr_nonnull(at);
  ck_assert_int_eq(sscanf(at + strlen(name[axis]),
                          " NumberOfComponents=\"1\" format=\"appended\" offset=\"%lld\"", &offset),
                   1);
  uint64_t bytes = 0;
  fseeko(f->file, f->data + offset, SEEK_SET);
  ck_assert_uint_eq(fread(&bytes, sizeof bytes, 1, f->file), 1);
  ck_assert_uint_eq(bytes, (uint64_t)(f->high[axis] - f->low[axis] + 1) * sizeof(double));
  return f->data + offset + (int64_t)sizeof bytes;
}

/* Points stand where the nodes do, to the bit, and fields are the nodes' own. */
START_TEST(open_knots_are_rectilinear) {
  const int32_t dim = 1 + _i % 3, cubic = _i / 3;
  world w;
  open_knots(&w, dim, cubic ? MPM_BSPLINE3 : MPM_BSPLINE2);
  static image f;
  scratch_path("open.vti", f.path, sizeof f.path);
  unlink(f.path);
  ck_refused(&w, mpm_write_grid(w.stepper, f.path, 0, NULL), MPM_E_ARG, ".vtr");
  ck_assert_int_ne(access(f.path, F_OK), 0);
  scratch_path("open.vtr", f.path, sizeof f.path);
  ck_ok(&w, mpm_write_grid(w.stepper, f.path, 0, NULL));
  open_image(&f);
  ck_assert_ptr_nonnull(strstr(f.head, "<VTKFile type=\"RectilinearGrid\""));
  ck_assert_ptr_null(strstr(f.head, "Spacing"));
  for (int32_t k = 0; k < ALL; ++k) ck_assert_int_eq(check_field(&f, &w, all[k], 1), k != 1);
  mpm_view index = map(&w, "index"), position = map(&w, "position");
  for (int32_t k = 0; k < 3; ++k) {
    const int64_t array = find_coordinates(&f, k);
    double x = 1.0, last;
    read_tuple(&f, array, 0, 1, &x);
    if (k >= dim) ck_assert(x == 0.0);
    for (int64_t p = 1; p <= f.high[k] - f.low[k]; ++p, x = last) {
      read_tuple(&f, array, p, 1, &last);
      ck_assert_double_gt(last, x);
    }
    for (int64_t i = 0; i < index.count && k < dim; ++i) {
      read_tuple(&f, array, ((const int64_t *)index.data)[i + k * index.component_stride] - f.low[k], 1, &x);
      ck_assert(x == ((const double *)position.data)[i + k * position.component_stride]);
    }
  }
  /* the body reaches from face to face: cubic functions are -1 ... 10 at 0, 1/3, 1 ... 8 2/3, 9 cells */
  double second;
  read_tuple(&f, find_coordinates(&f, 0), 1, 1, &second);
  ck_assert_double_eq_tol(second, -0.3 + 0.1 * (cubic ? 1.0 / 3.0 : 0.5), 1e-15);
  ck_assert_int_eq(f.low[0], cubic ? -1 : 0);
  ck_assert_int_eq(f.high[0], 10);
  ck_ok(&w, mpm_view_release(&position));
  ck_ok(&w, mpm_view_release(&index));
  fclose(f.file);
  world_close(&w);
}
END_TEST

TCase *io_grid_case(void) {
  TCase *tests = tcase_create("grid output");
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, every_number, 0, 12);
  tcase_add_test(tests, sparse_box);
  tcase_add_test(tests, box_beyond_a_file);
  tcase_add_test(tests, refused);
  tcase_add_test(tests, fields_of_the_last_step);
  tcase_add_loop_test(tests, open_knots_are_rectilinear, 0, 6);
  return tests;
}
