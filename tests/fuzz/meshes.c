/* Meshes of any points and corners fill particle sets and become the markers of surfaces: a status with a
 * sentence and nothing added, or as many particles and markers as are said; memory may run out anywhere. */
#include "fuzz.h"

enum { MOST_POINTS = 24, MOST_ELEMENTS = 40 };

typedef struct mesh {
  int64_t points, elements;
  double position[3 * MOST_POINTS];
  int64_t corner[3 * MOST_ELEMENTS];
} mesh;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static mpm_grid *open_grid(fuzz_input *in, mpm_context *context, int32_t *dim) {
  mpm_grid_desc d;
  mpm_grid *grid;
  MUST(!mpm_grid_desc_init(&d, sizeof d));
  d.dim = *dim = 2 + fuzz_below(in, 2);
  d.geometry = d.dim == 2 ? fuzz_below(in, 3) : MPM_PLANE_STRAIN;
  d.total_lagrangian = fuzz_below(in, 4) == 0;
  for (int32_t k = 0; k < d.dim; ++k) {
    d.cells[k] = 1 + fuzz_below(in, 6);
    d.spacing[k] = 0.25 * (1 + fuzz_below(in, 4));
  }
  MUST(!mpm_grid_create(context, &d, &grid));
  return grid;
}

/* Points on a coarse lattice, so that many coincide and faces are flat; some lie anywhere. */
static void draw_mesh(fuzz_input *in, int32_t dim, mesh *m) {
  m->points = 1 + fuzz_below(in, MOST_POINTS);
  m->elements = 1 + fuzz_below(in, MOST_ELEMENTS);
  for (int64_t i = 0; i < dim * m->points; ++i)
    m->position[i] = fuzz_below(in, 16) ? 0.25 * fuzz_below(in, 12) - 0.25 : fuzz_double(in);
  for (int64_t i = 0; i < dim * m->elements; ++i)
    m->corner[i] = fuzz_below(in, 64) ? fuzz_below(in, (int32_t)m->points) : fuzz_integer(in);
}

static void fill(fuzz_input *in, mpm_context *context, mpm_grid *grid, fuzz_memory *memory, const mesh *m) {
  mpm_particles *set;
  mpm_material *material;
  const mpm_param param[] = {{"E", 1e3}, {"nu", 0.3}, {"density", 1.0}};
  const int32_t per_cell[3] = {1 + fuzz_below(in, 3), 1 + fuzz_below(in, 3), 1 + fuzz_below(in, 3)};
  MUST(!mpm_material_create(context, "neo_hookean", param, 3, &material));
  MUST(!mpm_particles_create(context, grid, material, &set));
  for (int32_t times = 0; times < 2; ++times) {
    const int64_t had = mpm_particles_count(set);
    int64_t first = -1, count = -1;
    memory->calls = 0;
    memory->fail_at = fuzz_below(in, 4) ? 0 : 1 + fuzz_below(in, 40);
    const mpm_status status =
        fuzz_status(context, mpm_particles_fill_mesh(set, m->points, m->position, m->elements, m->corner,
                                                     per_cell, &first, &count));
    fuzz_no_failure(memory);
    MUST(mpm_particles_count(set) == had + (status ? 0 : count));
  }
  fuzz_finite(set);
  MUST(!mpm_particles_destroy(set));
  MUST(!mpm_material_destroy(material));
}

static void cover(fuzz_input *in, mpm_context *context, mpm_grid *grid, int32_t dim, fuzz_memory *memory,
                  const mesh *m) {
  mpm_surface *surface;
  MUST(!mpm_surface_create(context, grid, NULL, &surface));
  const double spacing = fuzz_below(in, 8) ? fuzz_between(in, 0.05, 2.0) : fuzz_double(in);
  int64_t count = -1;
  memory->calls = 0;
  memory->fail_at = fuzz_below(in, 4) ? 0 : 1 + fuzz_below(in, 40);
  const mpm_status status =
      fuzz_status(context, dim == 2 ? mpm_surface_add_polyline(surface, m->points, m->position,
                                                               fuzz_below(in, 2), spacing, NULL, &count)
                                    : mpm_surface_add_triangles(surface, m->points, m->position, m->elements,
                                                                m->corner, spacing, NULL, &count));
  fuzz_no_failure(memory);
  MUST(mpm_surface_count(surface) == (status ? 0 : count));
  MUST(!mpm_surface_destroy(surface));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_input in = {data, data + size};
  fuzz_memory memory;
  mesh m;
  mpm_context *context = fuzz_context(&memory, 1);
  int32_t dim;
  mpm_grid *grid = open_grid(&in, context, &dim);
  draw_mesh(&in, dim, &m);
  fill(&in, context, grid, &memory, &m);
  cover(&in, context, grid, dim, &memory, &m);
  MUST(!mpm_grid_destroy(grid));
  fuzz_close(context, &memory);
  return 0;
}
