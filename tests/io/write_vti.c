/* Writes nodal fields for vtk_read.py, and beside each file what it must contain: every value as
 * mpm_grid_map() gives it. Usage: write_vti directory */
#include <mpm/mpm.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static mpm_context *context;

static void check(mpm_status status, int line) {
  if (!status) return;
  fprintf(stderr, "write_vti.c:%d: %s: %s\n", line, mpm_status_name(status), mpm_last_error(context));
  exit(1);
}
#define OK(call) check(call, __LINE__)

/* One line for each component: name, type, components, number of nodes, component, values. */
static void expect_field(mpm_stepper *stepper, FILE *out, const char *name) {
  mpm_view v = {.struct_size = sizeof v};
  if (mpm_grid_map(stepper, 0, name, MPM_READ, &v)) return; /* a step that did not keep it */
  for (int32_t c = 0; c < v.components; ++c) {
    fprintf(out, "%s %s %d %lld %d", name, v.type == MPM_I64 ? "I64" : "F64", (int)v.components,
            (long long)v.count, (int)c);
    for (int64_t i = 0; i < v.count; ++i) {
      const int64_t at = i * v.item_stride + c * v.component_stride;
      if (v.type == MPM_I64) fprintf(out, " %lld", (long long)((const int64_t *)v.data)[at]);
      if (v.type == MPM_F64) fprintf(out, " %a", ((const double *)v.data)[at]);
    }
    fputc('\n', out);
  }
  OK(mpm_view_release(&v));
}

static void write_image(mpm_stepper *stepper, const char *directory, const char *name, int32_t count,
                        const char *const *fields) {
  static const char *const all[] = {"index", "position",     "mass",    "velocity",
                                    "force", "acceleration", "reaction"};
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  OK(mpm_write_grid(stepper, path, count, fields));
  snprintf(path, sizeof path, "%s/%s.expect", directory, name);
  FILE *out = fopen(path, "w");
  if (!out) exit(1);
  for (int32_t i = 0; i < 7; ++i) expect_field(stepper, out, all[i]);
  fclose(out);
}

/* Two bodies apart, one in a corner, walls and a periodic axis:
 * ghosts and images are active, and there are gaps. */
static mpm_stepper *open_scene(int32_t dim, int32_t open_knots, int32_t transfer, mpm_grid **grid,
                               mpm_material **material, mpm_particles **set) {
  mpm_stepper *stepper;
  mpm_grid_desc g;
  OK(mpm_grid_desc_init(&g, sizeof g));
  g.dim = dim;
  for (int32_t k = 0; k < dim; ++k)
    g.cells[k] = 40 - 10 * k, g.spacing[k] = 0.1 + 0.03 * k, g.origin[k] = -1.0 / (k + 3);
  g.periodic[0] = dim == 2;
  g.basis = open_knots ? (dim == 2 ? MPM_BSPLINE2 : MPM_BSPLINE3) : dim == 1 ? MPM_LINEAR : MPM_BSPLINE2;
  g.boundary_basis = open_knots ? MPM_BOUNDARY_OPEN_KNOT : MPM_BOUNDARY_GHOST;
  OK(mpm_grid_create(context, &g, grid));
  const mpm_param params[] = {{"E", 1e5}, {"nu", 0.3}, {"density", 1e3}};
  OK(mpm_material_create(context, "neo_hookean", params, 3, material));
  OK(mpm_particles_create(context, *grid, *material, set));
  mpm_stepper_desc s;
  OK(mpm_stepper_desc_init(&s, sizeof s));
  s.transfer = transfer;
  s.gravity[dim - 1] = -9.81;
  OK(mpm_stepper_create(context, *grid, &s, &stepper));
  OK(mpm_stepper_add(stepper, *set));
  for (int32_t face = dim == 2 ? 2 : 0; face < 2 * dim; ++face)
    OK(mpm_stepper_set_wall(stepper, face, face % 2 ? MPM_WALL_FIXED : MPM_WALL_FRICTION_NODES, 0.2));
  double lower[2][3], upper[2][3];
  const int32_t per_cell[] = {2, 2, 2};
  for (int32_t k = 0; k < dim; ++k) {
    lower[0][k] = g.origin[k];
    upper[0][k] = g.origin[k] + 3.2 * g.spacing[k];
    lower[1][k] = g.origin[k] + 15.0 * g.spacing[k];
    upper[1][k] = g.origin[k] + 17.5 * g.spacing[k];
  }
  for (int32_t b = 0; b < 2; ++b) OK(mpm_particles_fill_box(*set, lower[b], upper[b], per_cell, NULL, NULL));
  return stepper;
}

int main(int argc, char **argv) {
  static const char *const some[] = {"reaction", "position", "mass"};
  static const int32_t transfer[2][3] = {{MPM_FLIP, MPM_APIC_MLS, MPM_APIC}, {MPM_FLIP, MPM_TPIC, MPM_APIC}};
  if (argc != 2) return 2;
  OK(mpm_context_create(NULL, &context));
  for (int32_t i = 0; i < 6; ++i) {
    const int32_t dim = 1 + i % 3, open_knots = i / 3;
    const char *const suffix = open_knots ? "vtr" : "vti";
    mpm_grid *grid;
    mpm_material *material;
    mpm_particles *set;
    mpm_stepper *stepper = open_scene(dim, open_knots, transfer[open_knots][dim - 1], &grid, &material, &set);
    char name[64];
    for (int32_t k = 0; k < 5; ++k) OK(mpm_step(stepper, 1e-3, NULL));
    snprintf(name, sizeof name, "all_%d.%s", (int)dim, suffix);
    write_image(stepper, argv[1], name, 0, NULL);
    snprintf(name, sizeof name, "some_%d.%s", (int)dim, suffix);
    write_image(stepper, argv[1], name, 3, some);
    OK(mpm_step_begin(stepper, 1e-3));
    snprintf(name, sizeof name, "begun_%d.%s", (int)dim, suffix);
    write_image(stepper, argv[1], name, 0, NULL);
    OK(mpm_step_grid(stepper));
    OK(mpm_step_end(stepper, NULL));
    while (mpm_particles_count(set)) {
      int64_t id;
      mpm_view v = {.struct_size = sizeof v};
      OK(mpm_particles_map(set, "id", MPM_READ, &v));
      for (int64_t i = 0; (id = ((const int64_t *)v.data)[i]) < 0;) ++i;
      OK(mpm_view_release(&v));
      OK(mpm_particles_remove(set, 1, &id));
    }
    OK(mpm_step(stepper, 1e-3, NULL));
    snprintf(name, sizeof name, "empty_%d.%s", (int)dim, suffix);
    write_image(stepper, argv[1], name, 0, NULL);
    OK(mpm_stepper_destroy(stepper));
    OK(mpm_particles_destroy(set));
    OK(mpm_material_destroy(material));
    OK(mpm_grid_destroy(grid));
  }
  OK(mpm_context_destroy(context));
  return 0;
}
