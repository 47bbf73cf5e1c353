/* Files of several parts, of contexts that know nothing of each other: each process has a body of its own.
 *
 *   test_files FOLDER
 *
 * The loader of the library is taken apart: a piece goes to mpm_state_load(), several are looked at. */
#define _XOPEN_SOURCE 700
#include <mpm/mpm_mpi.h>

#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "head.h"
#include "meet.h"
#include "read_vtk.h"

enum { PATH = 600, MOST = 64 };

typedef struct world {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
} world;

static const char *folder;
static int rank, size;
static int64_t calls, fail_at, held; /* of the allocator that libmpm-mpi gets */

static void *take(void *user, size_t bytes, size_t alignment) {
  (void)user;
  if (++calls == fail_at) return NULL;
  ++held;
  return aligned_alloc(alignment, bytes);
}

static void give_back(void *user, void *memory, size_t bytes, size_t alignment) {
  (void)user, (void)bytes, (void)alignment;
  --held;
  free(memory);
}

static const char *in_folder(const char *name) {
  static char path[4][PATH];
  static int32_t turn;
  turn = (turn + 1) % 4;
  snprintf(path[turn], PATH, "%s/%s", folder, name);
  return path[turn];
}

/* A row of bodies, four cells apart, of different sizes and speeds; from the first to before the last. */
static void create(world *w, int32_t dim, int32_t open_knots, int32_t first, int32_t last) {
  const mpm_param law[] = {{"E", 1e4}, {"nu", 0.3}, {"density", 1000.0}};
  mpm_grid_desc g;
  mpm_stepper_desc s;
  MUST(!mpm_grid_desc_init(&g, sizeof g) && !mpm_stepper_desc_init(&s, sizeof s));
  g.dim = dim;
  g.boundary_basis = open_knots;
  for (int32_t k = 0; k < dim; ++k)
    g.cells[k] = k == dim - 1 ? 8 * (size + 1) : 12, g.spacing[k] = 0.1 * (k + 1), g.origin[k] = k - 0.3;
  s.gravity[0] = -1.0;
  MUST(!mpm_context_create(NULL, &w->context) && !mpm_grid_create(w->context, &g, &w->grid));
  MUST(!mpm_material_create(w->context, "neo_hookean", law, 3, &w->material));
  MUST(!mpm_particles_create(w->context, w->grid, w->material, &w->set));
  for (int32_t i = first; i < last; ++i) {
    double lower[3], upper[3], v[3] = {0.3, 0.1 * i, 0.2};
    const int32_t per_cell[] = {2, 2, 2};
    for (int32_t k = 0; k < dim; ++k) {
      const double at = k == dim - 1 ? 8.0 * i + 3.0 : 4.0;
      lower[k] = g.origin[k] + g.spacing[k] * at;
      upper[k] = g.origin[k] + g.spacing[k] * (at + 2.0 + (k == 0 ? i % 3 : 0));
    }
    int64_t id = 0, n = 0;
    MUST(!mpm_particles_fill_box(w->set, lower, upper, per_cell, &id, &n));
    for (int64_t k = 0; k < n; ++k) {
      const int64_t one = id + k;
      MUST(!mpm_particles_set(w->set, "velocity", MPM_F64, dim, 1, &one, v));
    }
  }
  MUST(!mpm_stepper_create(w->context, w->grid, &s, &w->stepper) && !mpm_stepper_add(w->stepper, w->set));
}

static void destroy(world *w) {
  MUST(!mpm_stepper_destroy(w->stepper) && !mpm_particles_destroy(w->set) &&
       !mpm_material_destroy(w->material));
  MUST(!mpm_grid_destroy(w->grid) && !mpm_context_destroy(w->context));
}

static void steps(world *w, int32_t n) {
  for (int32_t i = 0; i < n; ++i) MUST(!mpm_step(w->stepper, 1e-3, NULL));
}

static mpm_mpi *open_world(void) {
  mpm_context_desc desc;
  mpm_mpi *mpi;
  MUST(!mpm_context_desc_init(&desc, sizeof desc));
  desc.alloc = take;
  desc.release = give_back;
  fail_at = 0;
  MUST(!mpm_mpi_open(MPI_COMM_WORLD, &desc, &mpi));
  return mpi;
}

static int exists(const char *path) {
  struct stat is;
  return !stat(path, &is);
}

/* ---- particles */

/* The part's own file by the library, whose data the file of all has. */
static void compare_piece(const vtk_text *all, int32_t piece, int32_t part) {
  char name[40];
  snprintf(name, sizeof name, "alone_%d.vtp", (int)part);
  vtk_text alone = vtk_load(in_folder(name));
  const char *ours = vtk_element(all, "Piece", piece), *theirs = vtk_element(&alone, "Piece", 0);
  char points[40];
  MUST(ours && theirs);
  snprintf(points, sizeof points, "%s", vtk_attribute(ours, "NumberOfPoints"));
  MUST(!strcmp(points, vtk_attribute(theirs, "NumberOfPoints")));
  int32_t arrays = 0;
  for (const char *at = theirs; (at = strstr(at, "<DataArray ")); ++at, ++arrays) {
    char array[80];
    snprintf(array, sizeof array, "%s", vtk_attribute(at, "Name"));
    int64_t n, m;
    const char *a = vtk_array(&alone, theirs, array, &n), *b = vtk_array(all, ours, array, &m);
    MUST(n == m && !memcmp(a, b, (size_t)n));
  }
  MUST(arrays > 8);
  vtk_drop(&alone);
}

static void check_particles(const char *path, int32_t writers) {
  vtk_text index = vtk_load(path);
  MUST(vtk_element(&index, "PDataArray", 5));
  int32_t part = 0, files = 0;
  for (const char *source; (source = vtk_element(&index, "Piece", files)); ++files) {
    vtk_text file = vtk_load(in_folder(vtk_attribute(source, "Source")));
    for (int32_t k = 0; vtk_element(&file, "Piece", k); ++k) {
      /* the second part has nothing to show */
      part += part == 1;
      compare_piece(&file, k, part++);
    }
    static const char end[] = "\n  </AppendedData>\n</VTKFile>\n";
    MUST(!strcmp(file.bytes + file.count - strlen(end), end));
    vtk_drop(&file);
  }
  MUST(part == size || (part == 1 && size == 2));
  MUST(files == writers - (writers == size && size > 1));
  vtk_drop(&index);
}

static void test_particles(mpm_mpi *mpi) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w = {0};
    /* the second part has nothing */
    create(&w, dim, 0, rank, rank == 1 ? rank : rank + 1);
    if (rank != 1) steps(&w, 3);
    char name[40];
    snprintf(name, sizeof name, "alone_%d.vtp", rank);
    MUST(!mpm_write_particles(w.set, in_folder(name), 0, NULL));
    MPI_Barrier(MPI_COMM_WORLD);
    for (int32_t writers = 0; writers <= size; ++writers) {
      mpm_mpi_output as = {.struct_size = sizeof as, .writers = writers};
      const mpm_status status =
          mpm_mpi_write_particles(mpi, w.set, in_folder("set.pvtp"), writers || dim == 2 ? &as : NULL);
      if (status) fprintf(stderr, "%s\n", mpm_mpi_last_error(mpi));
      MUST(!status);
      if (!rank) check_particles(in_folder("set.pvtp"), writers ? writers : 1);
      MPI_Barrier(MPI_COMM_WORLD);
    }
    static const char *const two[] = {"velocity", "id"};
    mpm_mpi_output as = {.struct_size = sizeof as, .writers = 1, .count = 2, .fields = two};
    MUST(!mpm_mpi_write_particles(mpi, w.set, in_folder("two & \"<\".pvtp"), &as));
    if (!rank) {
      vtk_text index = vtk_load(in_folder("two & \"<\".pvtp"));
      MUST(!strcmp(vtk_attribute(vtk_element(&index, "Piece", 0), "Source"),
                   "two &amp; &quot;&lt;&quot;/two &amp; &quot;&lt;&quot;_0.vtp"));
      MUST(vtk_element(&index, "PDataArray", 2) && !vtk_element(&index, "PDataArray", 3));
      MUST(exists(in_folder("two & \"<\"/two & \"<\"_0.vtp")));
      vtk_drop(&index);
    }
    /* for VTK to read */
    if (dim == 3) MUST(!mpm_mpi_write_particles(mpi, w.set, in_folder("shown.pvtp"), NULL));
    destroy(&w);
  }
}

/* ---- nodes */

static void read_extent(const char *text, long long at[6]) {
  MUST(sscanf(text, "%lld %lld %lld %lld %lld %lld", at, at + 1, at + 2, at + 3, at + 4, at + 5) == 6);
}

/* Every value of a layer is that of the whole image, and the layers are all of it. */
static void check_grid(const char *path, const char *whole_path, int32_t writers) {
  vtk_text index = vtk_load(path), whole = vtk_load(whole_path);
  const char *image = vtk_element(&whole, "ImageData", 0), *ours = vtk_element(&index, "PImageData", 0);
  long long box[6], part[6], planes = 0, across = 0;
  static const char *const same[] = {"WholeExtent", "Origin", "Spacing"};
  for (int32_t i = 0; i < 3; ++i) {
    char value[400];
    snprintf(value, sizeof value, "%s", vtk_attribute(image, same[i]));
    MUST(!strcmp(value, vtk_attribute(ours, same[i])));
  }
  read_extent(vtk_attribute(image, "WholeExtent"), box);
  int32_t layers = 0;
  for (const char *piece; (piece = vtk_element(&index, "Piece", layers)); ++layers) {
    read_extent(vtk_attribute(piece, "Extent"), part);
    for (int32_t k = 0; k < 3; ++k) {
      if (part[2 * k] == box[2 * k] && part[2 * k + 1] == box[2 * k + 1] && writers > 1) continue;
      across = k;
      MUST(part[2 * k] == (layers ? planes : box[2 * k]));
      planes = part[2 * k + 1];
    }
    vtk_text file = vtk_load(in_folder(vtk_attribute(piece, "Source")));
    int32_t arrays = 0;
    for (const char *at = strstr(image, "<DataArray "); at; at = strstr(at + 1, "<DataArray "), ++arrays) {
      char name[80];
      snprintf(name, sizeof name, "%s", vtk_attribute(at, "Name"));
      const int64_t tuple = 8 * atoll(vtk_attribute(at, "NumberOfComponents"));
      int64_t n, m, used = 0;
      const char *a = vtk_array(&whole, image, name, &n), *b = vtk_array(&file, file.bytes, name, &m);
      for (long long z = part[4]; z <= part[5]; ++z)
        for (long long y = part[2]; y <= part[3]; ++y, used += tuple * (part[1] - part[0] + 1)) {
          const long long place =
              ((z - box[4]) * (box[3] - box[2] + 1) + y - box[2]) * (box[1] - box[0] + 1) + part[0] - box[0];
          MUST(!memcmp(a + place * tuple, b + used, (size_t)(tuple * (part[1] - part[0] + 1))));
        }
      MUST(used == m && n >= m);
    }
    MUST(arrays >= 4);
    vtk_drop(&file);
  }
  MUST(planes == box[2 * across + 1]);
  MUST(layers == writers);
  vtk_drop(&index);
  vtk_drop(&whole);
}

static void test_grid(mpm_mpi *mpi) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w = {0}, all = {0};
    create(&w, dim, 0, rank, rank + 1);
    MUST(mpm_mpi_write_grid(mpi, w.stepper, in_folder("nodes.pvti"), NULL) == MPM_E_STATE);
    MUST_SAY(mpm_mpi_last_error(mpi), "part 0: mpm_write_grid_to: MPM_E_STATE");
    steps(&w, 2);
    if (!rank) {
      create(&all, dim, 0, 0, size);
      steps(&all, 2);
      MUST(!mpm_write_grid(all.stepper, in_folder("whole.vti"), 0, NULL));
      if (dim == 3) MUST(!mpm_write_grid(all.stepper, in_folder("shown_whole.vti"), 0, NULL));
      destroy(&all);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    for (int32_t writers = 0; writers <= size; ++writers) {
      mpm_mpi_output as = {.struct_size = sizeof as, .writers = writers};
      MUST(!mpm_mpi_write_grid(mpi, w.stepper, in_folder("nodes.pvti"), &as));
      if (!rank) check_grid(in_folder("nodes.pvti"), in_folder("whole.vti"), writers ? writers : 1);
      MPI_Barrier(MPI_COMM_WORLD);
    }
    if (dim == 3) {
      const mpm_mpi_output as = {.struct_size = sizeof as, .writers = size};
      MUST(!mpm_mpi_write_grid(mpi, w.stepper, in_folder("shown.pvti"), &as));
    }
    destroy(&w);
  }
  /* all have the same nodes: each is there once */
  world w = {0};
  create(&w, 2, 0, 0, 1);
  steps(&w, 1);
  if (!rank) MUST(!mpm_write_grid(w.stepper, in_folder("whole.vti"), 0, NULL));
  MPI_Barrier(MPI_COMM_WORLD);
  mpm_mpi_output as = {.struct_size = sizeof as, .writers = size};
  MUST(!mpm_mpi_write_grid(mpi, w.stepper, in_folder("nodes.pvti"), &as));
  if (!rank) check_grid(in_folder("nodes.pvti"), in_folder("whole.vti"), size);
  destroy(&w);
  create(&w, 2, MPM_BOUNDARY_OPEN_KNOT, rank, rank + 1);
  steps(&w, 1);
  MUST(mpm_mpi_write_grid(mpi, w.stepper, in_folder("knots.pvti"), NULL) == MPM_E_UNSUPPORTED);
  MUST_SAY(mpm_mpi_last_error(mpi), "mpm_write_grid() writes those of a part into a .vtr");
  MUST(!exists(in_folder("knots.pvti")));
  destroy(&w);
  /* nowhere a particle: an image of nothing */
  create(&w, 2, 0, 0, 0);
  steps(&w, 1);
  MUST(!mpm_mpi_write_grid(mpi, w.stepper, in_folder("none.pvti"), NULL));
  if (!rank) {
    vtk_text index = vtk_load(in_folder("none.pvti"));
    MUST(!strcmp(vtk_attribute(vtk_element(&index, "PImageData", 0), "WholeExtent"), "0 -1 0 -1 0 -1"));
    vtk_drop(&index);
  }
  destroy(&w);
}

/* A second body, which on the part of the first lies beside it and is nowhere else. */
static mpm_particles *add_neighbour(world *w, int32_t lies) {
  const int32_t per_cell[] = {2, 2};
  mpm_particles *set;
  mpm_contact_desc rule;
  MUST(!mpm_contact_desc_init(&rule, sizeof rule));
  MUST(!mpm_particles_create(w->context, w->grid, w->material, &set) && !mpm_stepper_add(w->stepper, set));
  MUST(!mpm_stepper_set_body(w->stepper, set, 1) && !mpm_stepper_set_contact(w->stepper, 0, 1, &rule));
  const double lower[] = {-0.3 + 0.1 * 6.0, 0.7 + 0.2 * 3.0}, upper[] = {-0.3 + 0.1 * 8.0, 0.7 + 0.2 * 5.0};
  if (lies) MUST(!mpm_particles_fill_box(set, lower, upper, per_cell, NULL, NULL));
  return set;
}

/* Where bodies meet on one part only, the image has what contact keeps, as that of one part has. */
static void test_meeting(mpm_mpi *mpi) {
  world w = {0}, all = {0};
  create(&w, 2, 0, rank, rank + 1);
  mpm_particles *set = add_neighbour(&w, rank == 0);
  steps(&w, 2);
  if (!rank) {
    create(&all, 2, 0, 0, size);
    mpm_particles *other = add_neighbour(&all, 1);
    steps(&all, 2);
    MUST(!mpm_write_grid(all.stepper, in_folder("whole.vti"), 0, NULL));
    vtk_text whole = vtk_load(in_folder("whole.vti"));
    MUST(strstr(whole.bytes, "contact_force"));
    vtk_drop(&whole);
    MUST(!mpm_stepper_remove(all.stepper, other) && !mpm_particles_destroy(other));
    destroy(&all);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  const mpm_mpi_output as = {.struct_size = sizeof as, .writers = size};
  MUST(!mpm_mpi_write_grid(mpi, w.stepper, in_folder("nodes.pvti"), &as));
  if (!rank) check_grid(in_folder("nodes.pvti"), in_folder("whole.vti"), size);
  MPI_Barrier(MPI_COMM_WORLD);
  MUST(!mpm_stepper_remove(w.stepper, set) && !mpm_particles_destroy(set));
  destroy(&w);
}

/* ---- states */

static struct {
  int32_t count;
  uint64_t hash[MOST];
} loaded;

static uint64_t sum(const void *data, int64_t bytes) {
  uint64_t hash = 7;
  for (int64_t i = 0; i < bytes; ++i) hash = (hash ^ ((const unsigned char *)data)[i]) * 0x100000001b3u;
  return hash;
}

mpm_status __wrap_mpm_state_load_pieces(mpm_stepper *stepper, int32_t count, const void *const *piece,
                                        const int64_t *bytes);
mpm_status __wrap_mpm_state_load_pieces(mpm_stepper *stepper, int32_t count, const void *const *piece,
                                        const int64_t *bytes) {
  MUST(count <= MOST);
  loaded.count = count;
  for (int32_t i = 0; i < count; ++i) {
    MUST((uintptr_t)piece[i] % 64 == 0);
    loaded.hash[i] = sum(piece[i], bytes[i]);
  }
  return count == 1 ? mpm_state_load(stepper, piece[0], bytes[0]) : MPM_OK;
}

static uint64_t hash_of(const world *w) {
  uint64_t hash;
  MUST(!mpm_state_hash(w->stepper, &hash));
  return hash;
}

/* The communicator of the first n processes; MPI_COMM_NULL on the others. */
static MPI_Comm first_processes(int n) {
  MPI_Comm out;
  MPI_Comm_split(MPI_COMM_WORLD, rank < n ? 0 : MPI_UNDEFINED, rank, &out);
  return out;
}

static mpm_mpi *open_comm(MPI_Comm comm) {
  mpm_context_desc desc;
  mpm_mpi *mpi;
  MUST(!mpm_context_desc_init(&desc, sizeof desc));
  MUST(!mpm_mpi_open(comm, &desc, &mpi));
  return mpi;
}

static void test_state(mpm_mpi *mpi) {
  world w = {0};
  create(&w, 3, 0, rank, rank + 1);
  steps(&w, 3);
  int64_t bytes;
  MUST(!mpm_state_size(w.stepper, &bytes));
  void *piece = malloc((size_t)bytes);
  MUST(piece && !mpm_state_save(w.stepper, piece, bytes));
  uint64_t all[MOST], own = sum(piece, bytes);
  MPI_Allgather(&own, 1, MPI_UINT64_T, all, 1, MPI_UINT64_T, MPI_COMM_WORLD);
  MUST(!mpm_mpi_save(mpi, w.stepper, in_folder("all.state")));
  MUST(!exists(in_folder("all.state.writing")));
  const uint64_t then = hash_of(&w);
  steps(&w, 2);
  MUST(hash_of(&w) != then);
  MUST(!mpm_mpi_load(mpi, w.stepper, in_folder("all.state")));
  MUST(hash_of(&w) == then && loaded.count == 1);
  steps(&w, 2);
  /* as many processes as there are pieces or fewer: runs in order of parts */
  for (int n = 1; n <= size; ++n) {
    MPI_Comm comm = first_processes(n);
    if (comm == MPI_COMM_NULL) continue;
    mpm_mpi *few = open_comm(comm);
    loaded.count = -1;
    MUST(!mpm_mpi_load(few, w.stepper, in_folder("all.state")));
    const int first = size * rank / n, last = size * (rank + 1) / n;
    MUST(loaded.count == last - first);
    for (int i = first; i < last; ++i) MUST(loaded.hash[i - first] == all[i]);
    MUST(!mpm_mpi_close(few));
    MPI_Comm_free(&comm);
  }
  /* more processes than pieces: one of them has it */
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Comm one = first_processes(1);
  if (one != MPI_COMM_NULL) {
    mpm_mpi *alone = open_comm(one);
    MUST(!mpm_mpi_save(alone, w.stepper, in_folder("one.state")));
    MUST(!mpm_mpi_close(alone));
    MPI_Comm_free(&one);
    MUST(!mpm_state_save_file(w.stepper, in_folder("serial.state")));
  }
  MPI_Barrier(MPI_COMM_WORLD);
  for (int32_t i = 0; i < 2; ++i) {
    MUST(!mpm_mpi_load(mpi, w.stepper, in_folder(i ? "serial.state" : "one.state")));
    MUST(loaded.count == (rank == size - 1));
  }
  /* a link stays one, and the mode of the file as it was */
  if (!rank) MUST(!chmod(in_folder("all.state"), 0640) && !symlink("all.state", in_folder("link")));
  MPI_Barrier(MPI_COMM_WORLD);
  MUST(!mpm_mpi_save(mpi, w.stepper, in_folder("link")));
  struct stat is;
  MUST(!lstat(in_folder("link"), &is) && S_ISLNK(is.st_mode));
  MUST(!lstat(in_folder("all.state"), &is) && S_ISREG(is.st_mode) && (is.st_mode & 0777) == 0640);
  free(piece);
  destroy(&w);
}

/* Every byte of header and table matters; and every length. */
static void test_damage(mpm_mpi *mpi) {
  world w = {0};
  create(&w, 1, 0, rank, rank + 1);
  steps(&w, 1);
  MUST(!mpm_mpi_save(mpi, w.stepper, in_folder("sound.state")));
  const uint64_t then = hash_of(&w);
  steps(&w, 1);
  const uint64_t now = hash_of(&w);
  vtk_text sound = vtk_load(in_folder("sound.state"));
  const int64_t header = 40 + 16 * size;
  for (int64_t k = 0; k < header + 8; ++k) {
    const int64_t cut = k < header ? sound.count : k == header ? 0 : sound.count / (k - header + 1) - 1;
    if (!rank) {
      FILE *out = fopen(in_folder("damaged.state"), "wb");
      MUST(out);
      if (k < header) sound.bytes[k] ^= 1;
      MUST(fwrite(sound.bytes, 1, (size_t)cut, out) == (size_t)cut && !fclose(out));
      if (k < header) sound.bytes[k] ^= 1;
    }
    MPI_Barrier(MPI_COMM_WORLD);
    loaded.count = -1;
    const mpm_status status = mpm_mpi_load(mpi, w.stepper, in_folder("damaged.state"));
    MUST(status == MPM_E_FORMAT);
    /* what has no mark may be a state of one part, which the library looks at */
    if (k >= 8 && k < header) MUST(loaded.count == -1);
    MUST(hash_of(&w) == now);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  vtk_drop(&sound);
  MUST(!mpm_mpi_load(mpi, w.stepper, in_folder("sound.state")) && hash_of(&w) == then);
  destroy(&w);
}

static void put_number(char *to, uint64_t value, int32_t bytes) {
  for (int32_t i = 0; i < bytes; ++i) to[i] = (char)(value >> 8 * i);
}

/* A header whose sum is right, and which is not: the number at that place is another one. */
static void test_forged(mpm_mpi *mpi) {
  world w = {0};
  create(&w, 1, 0, rank, rank + 1);
  steps(&w, 1);
  MUST(!mpm_mpi_save(mpi, w.stepper, in_folder("sound.state")));
  const uint64_t now = hash_of(&w);
  vtk_text sound = vtk_load(in_folder("sound.state"));
  const uint64_t whole = (uint64_t)sound.count, table = 40 + 16 * (uint64_t)size;
  const uint64_t first = (table + 63) / 64 * 64;
  const struct {
    int64_t place;
    int32_t bytes;
    uint64_t value;
    const char *words;
  } forged[] = {{8, 4, 2, "the format is 2"},
                {16, 8, 0, "with 0 pieces"},
                {16, 8, whole, "pieces"},
                {24, 8, whole + 1, "the header says"},
                {32, 8, 0, "the table of pieces is damaged"},
                {40, 8, 0, "piece 0 is not in the file"},
                {40, 8, first + 8, "piece 0 is not in the file"},
                {40, 8, (whole + 63) / 64 * 64, "piece 0 is not in the file"},
                {48, 8, whole, "piece 0 is not in the file"},
                {48, 8, UINT64_MAX, "piece 0 is not in the file"},
                {48, 8, whole - first, size > 1 ? "piece 1 is not in the file" : NULL}};
  for (size_t i = 0; i < sizeof forged / sizeof *forged; ++i) {
    if (!forged[i].words) continue;
    if (!rank) {
      vtk_text copy = vtk_load(in_folder("sound.state"));
      put_number(copy.bytes + forged[i].place, forged[i].value, forged[i].bytes);
      const uint64_t right = mpmx_hash(mpmx_hash(MPMX_HASH, copy.bytes, 32), copy.bytes + 40, table - 40);
      if (forged[i].place != 32) put_number(copy.bytes + 32, right, 8);
      FILE *out = fopen(in_folder("forged.state"), "wb");
      MUST(out && fwrite(copy.bytes, 1, (size_t)copy.count, out) == (size_t)copy.count && !fclose(out));
      vtk_drop(&copy);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    loaded.count = -1;
    MUST(mpm_mpi_load(mpi, w.stepper, in_folder("forged.state")) == MPM_E_FORMAT);
    MUST_SAY(mpm_mpi_last_error(mpi), forged[i].words);
    MUST(loaded.count == -1 && hash_of(&w) == now);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  vtk_drop(&sound);
  destroy(&w);
}

/* A head that comes in two pieces, cut anywhere, with data that look like text behind it. */
static void test_head(mpm_mpi *mpi) {
  static const char text[] = "<Piece NumberOfPoints=\"1\">\n"
                             "<DataArray type=\"UInt8\" Name=\"a\" NumberOfComponents=\"3\" offset=\"7\"/>\n"
                             "  <AppendedData encoding=\"raw\">\n_"
                             "data_<AppendedData";
  const int64_t all = (int64_t)sizeof text - 1, head = (int64_t)(strstr(text, "data_") - text);
  for (int64_t cut = 0; cut <= all; ++cut) {
    mpmx_head h = {0};
    int64_t taken = -1;
    MUST(!mpmx_head_take(mpi, &h, text, cut, &taken));
    MUST(h.whole == (cut >= head) && taken == (cut < head ? cut : head));
    if (!h.whole) {
      MUST(!mpmx_head_take(mpi, &h, text + cut, all - cut, &taken));
      MUST(h.whole && taken == head - cut);
    }
    MUST((int64_t)h.used == head && (int64_t)strlen(h.text) == head);
    mpmx_array a;
    const char *at = h.text;
    MUST(mpmx_head_next(&at, NULL, &a) && !strcmp(a.name, "a") && a.components == 3 && a.size == 1 &&
         a.offset == 7);
    MUST(!mpmx_head_next(&at, NULL, &a) && mpmx_head_data(&h, 2) == 7 + 8 + 6);
    mpmx_head_free(mpi, &h);
  }
}

/* ---- what is refused, and what fails */

/* All the calls that write, in turn; then the one that reads. */
enum { WRITE_SET, WRITE_NODES, SAVE, LOAD, FILES };
static const char *const names[FILES] = {"set.pvtp", "nodes.pvti", "all.state", "all.state"};

static mpm_status call(mpm_mpi *mpi, const world *w, int32_t which, const char *path,
                       const mpm_mpi_output *as) {
  switch (which) {
  case WRITE_SET:
    return mpm_mpi_write_particles(mpi, w ? w->set : NULL, path, as);
  case WRITE_NODES:
    return mpm_mpi_write_grid(mpi, w ? w->stepper : NULL, path, as);
  case SAVE:
    return mpm_mpi_save(mpi, w ? w->stepper : NULL, path);
  default:
    return mpm_mpi_load(mpi, w ? w->stepper : NULL, path);
  }
}

/* The same status and sentence on all, which the last part has caused. */
static void last_refuses(mpm_mpi *mpi, const world *w, int32_t which, const char *path,
                         const mpm_mpi_output *as, mpm_status status, const char *words) {
  const int last = rank == size - 1;
  const mpm_mpi_output plain = {.struct_size = sizeof plain};
  const world *mine = last ? w : w ? w : NULL;
  MUST(call(mpi, mine, which, last ? path : in_folder(names[which]), last ? as : &plain) == status);
  MUST_SAY(mpm_mpi_last_error(mpi), words);
  char part[20];
  snprintf(part, sizeof part, "part %d: ", size - 1);
  MUST(!strncmp(mpm_mpi_last_error(mpi), part, strlen(part)));
}

static void test_refusals(mpm_mpi *mpi) {
  world w = {0};
  create(&w, 2, 0, rank, rank + 1);
  steps(&w, 1);
  static const char *const unknown[] = {"nothing"}, *const hole[] = {NULL},
                           *const twice[] = {"velocity", "velocity"};
  mpm_mpi_output as = {.struct_size = sizeof as};
  MUST(mpm_mpi_write_particles(NULL, w.set, "x.pvtp", NULL) == MPM_E_ARG);
  MUST(mpm_mpi_write_grid(NULL, w.stepper, "x.pvti", NULL) == MPM_E_ARG);
  MUST(mpm_mpi_save(NULL, w.stepper, "x") == MPM_E_ARG && mpm_mpi_load(NULL, w.stepper, "x") == MPM_E_ARG);
  for (int32_t which = 0; which < FILES; ++which) {
    const world *none = rank == size - 1 ? NULL : &w;
    MUST(call(mpi, none, which, in_folder(names[which]), NULL) == MPM_E_ARG);
    MUST_SAY(mpm_mpi_last_error(mpi), " is NULL");
    last_refuses(mpi, &w, which, NULL, &as, MPM_E_ARG, "path is NULL");
    last_refuses(mpi, &w, which, "", &as, MPM_E_ARG, "path is empty");
    if (size > 1) {
      MUST(call(mpi, &w, which, in_folder(rank ? "one.pvtp" : "other.pvtp"), NULL) == MPM_E_ARG);
      MUST_SAY(mpm_mpi_last_error(mpi), "between the parts");
    }
    MUST(call(mpi, &w, which, in_folder("nowhere/a.pvtp") + 0, NULL) != MPM_OK);
  }
  for (int32_t which = WRITE_SET; which <= WRITE_NODES; ++which) {
    const char *path = in_folder(names[which]);
    MUST(call(mpi, &w, which, in_folder(names[!which]), NULL) == MPM_E_ARG);
    MUST_SAY(mpm_mpi_last_error(mpi), which ? "is to end with .pvti" : "is to end with .pvtp");
    MUST(call(mpi, &w, which, which ? ".pvti" : ".pvtp", NULL) == MPM_E_ARG);
    as = (mpm_mpi_output){.struct_size = sizeof as - 1};
    last_refuses(mpi, &w, which, path, &as, MPM_E_ARG, "struct_size is 23, must be at least 24");
    as.struct_size = 0xfffffff0u; /* nothing is read beyond it */
    last_refuses(mpi, &w, which, path, &as, MPM_E_ARG, "struct_size is 4294967280");
    struct {
      mpm_mpi_output known;
      int64_t later;
    } longer = {{.struct_size = sizeof longer}, 0};
    MUST(!call(mpi, &w, which, path, &longer.known));
    longer.later = 1;
    last_refuses(mpi, &w, which, path, &longer.known, MPM_E_UNSUPPORTED,
                 "does not know the field at byte 24");
    as = (mpm_mpi_output){.struct_size = sizeof as, .writers = size + 1};
    last_refuses(mpi, &w, which, path, &as, MPM_E_ARG, "writers is ");
    as.writers = -1;
    last_refuses(mpi, &w, which, path, &as, MPM_E_ARG, "writers is -1");
    as = (mpm_mpi_output){.struct_size = sizeof as, .count = -1};
    last_refuses(mpi, &w, which, path, &as, MPM_E_ARG, "count is -1");
    as.count = 1;
    last_refuses(mpi, &w, which, path, &as, MPM_E_ARG, "fields is NULL");
    as.fields = hole;
    last_refuses(mpi, &w, which, path, &as, MPM_E_ARG, "fields[0] is NULL");
    as = (mpm_mpi_output){.struct_size = sizeof as, .reserved = 1};
    last_refuses(mpi, &w, which, path, &as, MPM_E_UNSUPPORTED, "reserved is 1");
    as = (mpm_mpi_output){.struct_size = sizeof as, .count = 1, .fields = unknown};
    MUST(call(mpi, &w, which, path, &as) == MPM_E_NOT_FOUND);
    MUST_SAY(mpm_mpi_last_error(mpi), "MPM_E_NOT_FOUND");
    as = (mpm_mpi_output){.struct_size = sizeof as, .count = 2, .fields = twice};
    MUST(call(mpi, &w, which, path, &as) == MPM_E_ARG);
    MUST(call(mpi, &w, which, in_folder(which ? "nowhere/a.pvti" : "nowhere/a.pvtp"), NULL) == MPM_E_IO);
    MUST_SAY(mpm_mpi_last_error(mpi), "cannot make the folder");
  }
  MUST(mpm_mpi_load(mpi, w.stepper, in_folder("nowhere")) == MPM_E_IO);
  MUST_SAY(mpm_mpi_last_error(mpi), "cannot read");
  /* whatever the host has done about files that do not open; that stays as it was */
  MPI_Errhandler handler;
  MPI_File_set_errhandler(MPI_FILE_NULL, MPI_ERRORS_ARE_FATAL);
  MUST(mpm_mpi_save(mpi, w.stepper, in_folder("nowhere/a")) == MPM_E_IO);
  MPI_File_get_errhandler(MPI_FILE_NULL, &handler);
  MUST(handler == MPI_ERRORS_ARE_FATAL);
  MPI_File_set_errhandler(MPI_FILE_NULL, MPI_ERRORS_RETURN);
  /* what stands before a colon is the name of a file system to some */
  MUST(!mpm_mpi_save(mpi, w.stepper, in_folder("run_12:30.state")));
  MUST(exists(in_folder("run_12:30.state")) && !mpm_mpi_load(mpi, w.stepper, in_folder("run_12:30.state")));
  /* a folder is not replaced, and nothing is left beside it */
  MUST(mpm_mpi_save(mpi, w.stepper, folder) == MPM_E_IO);
  char left[PATH];
  snprintf(left, sizeof left, "%s.writing", folder);
  MUST(!exists(left));
  /* in a staged step no state is saved, on any part */
  if (rank == size - 1) MUST(!mpm_step_begin(w.stepper, 1e-3));
  last_refuses(mpi, &w, SAVE, in_folder("all.state"), NULL, MPM_E_STATE, "mpm_state_size: MPM_E_STATE");
  if (rank == size - 1) MUST(!mpm_step_abort(w.stepper));
  /* fields that only one part has */
  if (!rank) MUST(!mpm_particles_add_field(w.set, "label", MPM_U8, 3));
  const mpm_status status = mpm_mpi_write_particles(mpi, w.set, in_folder("set.pvtp"), NULL);
  MUST(status == (size > 1 ? MPM_E_UNSUPPORTED : MPM_OK));
  if (status) MUST_SAY(mpm_mpi_last_error(mpi), "name those that are to be written");
  destroy(&w);
}

/* What is at path afterwards is what was there before, and nothing lies beside it. */
static void unchanged(const vtk_text *before, int32_t which) {
  MPI_Barrier(MPI_COMM_WORLD);
  if (!rank) {
    vtk_text after = vtk_load(in_folder(names[which]));
    MUST(after.count == before->count && !memcmp(after.bytes, before->bytes, (size_t)after.count));
    vtk_drop(&after);
    static const char *const left[] = {"all.state.writing", "set.pvtp.writing", "nodes.pvti.writing",
                                       "set/set_0.vtp.writing", "nodes/nodes_0.vti.writing"};
    for (size_t i = 0; i < sizeof left / sizeof *left; ++i) MUST(!exists(in_folder(left[i])));
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

static void test_failures(void) {
  static const struct {
    faulty call;
    int32_t which;
    mpm_status status;
  } faults[] = {{F_FILE_OPEN, SAVE, MPM_E_IO},
                {F_FILE_WRITE, SAVE, MPM_E_IO},
                {F_FILE_SYNC, SAVE, MPM_E_IO},
                {F_FILE_CLOSE, SAVE, MPM_E_IO},
                {F_FILE_OPEN, LOAD, MPM_E_IO},
                {F_FILE_READ, LOAD, MPM_E_IO},
                {F_FILE_CLOSE, LOAD, MPM_E_IO},
                {F_BCAST, SAVE, MPM_E_CALLBACK},
                {F_ALLGATHER, SAVE, MPM_E_CALLBACK},
                {F_ALLGATHER, WRITE_NODES, MPM_E_CALLBACK},
                {F_COMM_SPLIT, WRITE_SET, MPM_E_CALLBACK}};
  world w = {0};
  create(&w, 3, 0, rank, rank + 1);
  steps(&w, 1);
  mpm_mpi *mpi = open_world();
  const mpm_mpi_output by_all = {.struct_size = sizeof by_all, .writers = size},
                       by_one = {.struct_size = sizeof by_one, .writers = 1};
  for (int32_t which = 0; which < FILES; ++which) {
    MUST(!call(mpi, &w, which, in_folder(names[which]), &by_all));
    vtk_text before = {0};
    if (!rank) before = vtk_load(in_folder(names[which]));
    if (which < LOAD) steps(&w, 1);
    for (size_t i = 0; i < sizeof faults / sizeof *faults; ++i) {
      /* with one process there is one division, which is there already */
      if (faults[i].which != which || (faults[i].call == F_COMM_SPLIT && size == 1)) continue;
      fail_in(faults[i].call, 0);
      MUST(call(mpi, &w, which, in_folder(names[which]), &by_one) == faults[i].status);
      MUST(has_failed());
      fail_in(NO_FAULT, 0);
      unchanged(&before, which);
    }
    /* memory runs out on the last part, at each place; one writer takes from it, or it is one itself */
    for (int32_t writers = 1; writers <= 2; ++writers) {
      int32_t seen = 0;
      for (int64_t at = 1;; ++at) {
        const int64_t held_before = held;
        fail_at = rank == size - 1 ? calls + at : 0;
        const mpm_status status =
            call(mpi, &w, which, in_folder(names[which]), writers == 1 ? &by_one : &by_all);
        fail_at = 0;
        MUST(held == held_before);
        if (!status) break;
        if (status != MPM_E_NOMEM)
          fprintf(stderr, "%d at %lld: %s\n", (int)which, (long long)at, mpm_mpi_last_error(mpi));
        MUST(status == MPM_E_NOMEM);
        MUST_SAY(mpm_mpi_last_error(mpi), "there is no memory");
        ++seen;
        if (writers == 1) unchanged(&before, which);
      }
      MUST(seen >= 3);
    }
    if (!rank) vtk_drop(&before);
  }
  MUST(!mpm_mpi_close(mpi));
  MUST(held == 0);
  destroy(&w);
}

/* A disk that is full, in the form of files that may not grow. */
static void test_full(mpm_mpi *mpi) {
  world w = {0};
  create(&w, 3, 0, rank, rank + 1);
  steps(&w, 1);
  signal(SIGXFSZ, SIG_IGN);
  struct rlimit before, small;
  MUST(!getrlimit(RLIMIT_FSIZE, &before));
  small = before;
  small.rlim_cur = 3000;
  for (int32_t which = WRITE_SET; which <= WRITE_NODES; ++which) {
    MUST(!call(mpi, &w, which, in_folder(names[which]), NULL));
    vtk_text old = {0};
    if (!rank) old = vtk_load(in_folder(names[which]));
    MPI_Barrier(MPI_COMM_WORLD);
    MUST(!setrlimit(RLIMIT_FSIZE, &small));
    const mpm_status status = call(mpi, &w, which, in_folder(names[which]), NULL);
    MUST(!setrlimit(RLIMIT_FSIZE, &before));
    MUST(status == MPM_E_IO);
    MUST_SAY(mpm_mpi_last_error(mpi), "File too large");
    unchanged(&old, which);
    if (!rank) vtk_drop(&old);
  }
  destroy(&w);
}

int main(int argc, char **argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  MUST(argc > 1);
  folder = argv[1];
  mpm_mpi *mpi = open_world();
  test_particles(mpi);
  test_grid(mpi);
  test_meeting(mpi);
  test_state(mpi);
  test_damage(mpi);
  test_forged(mpi);
  test_head(mpi);
  test_refusals(mpi);
  MUST(!mpm_mpi_close(mpi));
  MUST(held == 0);
  test_failures();
  mpi = open_world();
  test_full(mpi);
  MUST(!mpm_mpi_close(mpi));
  MPI_Finalize();
  return 0;
}
