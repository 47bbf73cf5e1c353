/* Writes particle sets and a series for vtk_read.py, and beside each file what it must contain: every value
 * as the library gives it by id. Usage: write_vtp directory */
#include <mpm/mpm.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check(mpm_context *context, mpm_status status, int line) {
  if (!status) return;
  fprintf(stderr, "write_vtp.c:%d: %s: %s\n", line, mpm_status_name(status), mpm_last_error(context));
  exit(1);
}
#define OK(call) check(context, call, __LINE__)

typedef struct scene {
  int32_t dim;
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
} scene;

static void print_value(FILE *out, int32_t type, const void *values, int64_t i) {
  if (type == MPM_F64) fprintf(out, " %a", ((const double *)values)[i]);
  if (type == MPM_I64) fprintf(out, " %lld", (long long)((const int64_t *)values)[i]);
  if (type == MPM_U8) fprintf(out, " %d", ((const uint8_t *)values)[i]);
}

/* One line for each component: name, type, components, number of particles, component, values. */
static void expect_field(const scene *on, FILE *out, const char *name, int32_t type, int32_t components) {
  static const char *const type_name[] = {"", "F64", "I64", "U8"};
  mpm_context *context = on->context;
  const int64_t n = mpm_particles_count(on->set);
  void *values = malloc(sizeof(double) * (size_t)(n * components + 1));
  OK(mpm_particles_get(on->set, name, type, components, n, NULL, values));
  for (int32_t c = 0; c < components; ++c) {
    fprintf(out, "%s %s %d %lld %d", name, type_name[type], (int)components, (long long)n, (int)c);
    for (int64_t i = 0; i < n; ++i) print_value(out, type, values, c * n + i);
    fputc('\n', out);
  }
  free(values);
}

/* The steppers here ask for none of the fields that only some keep. */
static int is_kept(const char *field, int32_t components) {
  return components && strcmp(field, "reference_position") && strcmp(field, "dilation_ratio");
}

/* The file, and beside it what must be in it: the named fields, or all that the set has. */
static void write_set(const scene *on, const char *directory, const char *name, int32_t count,
                      const char *const *fields) {
  mpm_context *context = on->context;
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  OK(mpm_write_particles(on->set, path, count, fields));
  snprintf(path, sizeof path, "%s/%s.expect", directory, name);
  FILE *out = fopen(path, "w");
  if (!out) exit(1);
  const char *field;
  int32_t type, components;
  for (int32_t f = 0; !mpm_particles_field_info(on->set, f, &field, &type, &components, NULL); ++f) {
    int32_t wanted = !count || !strcmp(field, "position"); /* the points */
    for (int32_t i = 0; i < count; ++i) wanted |= !strcmp(field, fields[i]);
    if (wanted && is_kept(field, components)) expect_field(on, out, field, type, components);
  }
  fclose(out);
}

static scene open_scene(int32_t dim, const char *law) {
  scene on = {.dim = dim};
  mpm_context *context = NULL;
  OK(mpm_context_create(NULL, &context));
  on.context = context;
  mpm_grid_desc g;
  OK(mpm_grid_desc_init(&g, sizeof g));
  g.dim = dim;
  for (int32_t k = 0; k < dim; ++k) g.cells[k] = 12, g.spacing[k] = 0.25 + 0.1 * k, g.origin[k] = -1.0;
  g.periodic[0] = dim == 2;
  OK(mpm_grid_create(context, &g, &on.grid));
  const mpm_param params[] = {
      {"E", 1e5}, {"nu", 0.3}, {"density", 1e3}, {"yield_stress", 1e3}, {"hardening", 1e3}};
  OK(mpm_material_create(context, law, params, law[0] == 'j' ? 5 : 3, &on.material));
  OK(mpm_particles_create(context, on.grid, on.material, &on.set));
  OK(mpm_particles_add_field(on.set, "colour", MPM_U8, 3));
  OK(mpm_particles_add_field(on.set, "label", MPM_I64, 1));
  OK(mpm_particles_add_field(on.set, "heat", MPM_F64, 2));
  mpm_stepper_desc s;
  OK(mpm_stepper_desc_init(&s, sizeof s));
  s.transfer = dim == 3 ? MPM_APIC : MPM_FLIP;
  s.gravity[0] = -9.81;
  OK(mpm_stepper_create(context, on.grid, &s, &on.stepper));
  OK(mpm_stepper_add(on.stepper, on.set));
  for (int32_t face = dim == 2 ? 2 : 0; face < 2 * dim; ++face)
    OK(mpm_stepper_set_wall(on.stepper, face, MPM_WALL_FIXED, 0.0));
  return on;
}

static void fill(const scene *on) {
  mpm_context *context = on->context;
  const double lower[] = {-0.5, -0.3, 0.0}, upper[] = {0.7, 0.9, 1.0}, speed[] = {3.0, -1.0, 2.0};
  const int32_t per_cell[] = {4, 4, 3};
  const int64_t gone[] = {1, 4};
  OK(mpm_particles_fill_box(on->set, lower, upper, per_cell, NULL, NULL));
  OK(mpm_particles_set_all(on->set, "velocity", MPM_F64, on->dim, speed));
  OK(mpm_particles_remove(on->set, 2, gone));
  const int64_t n = mpm_particles_count(on->set);
  for (int64_t id = 0, found = 0; found < n; ++id) {
    const uint8_t colour[] = {(uint8_t)id, 200, (uint8_t)(255 - id)};
    const int64_t label = id * 1000000007 * (id % 2 ? -1 : 1);
    const double heat[] = {1.0 / (double)(id + 1), -1e-300 * (double)id};
    if (mpm_particles_set(on->set, "label", MPM_I64, 1, 1, &id, &label)) continue;
    OK(mpm_particles_set(on->set, "colour", MPM_U8, 3, 1, &id, colour));
    OK(mpm_particles_set(on->set, "heat", MPM_F64, 2, 1, &id, heat));
    ++found;
  }
}

static void close_scene(scene *on) {
  mpm_context *context = on->context;
  OK(mpm_stepper_destroy(on->stepper));
  OK(mpm_particles_destroy(on->set));
  OK(mpm_material_destroy(on->material));
  OK(mpm_grid_destroy(on->grid));
  if (mpm_context_destroy(context)) exit(1);
}

/* Each field alone, in use or not, built in or the host's. */
static void write_one_by_one(const scene *on, const char *directory) {
  const char *field;
  int32_t components;
  for (int32_t f = 0; !mpm_particles_field_info(on->set, f, &field, NULL, &components, NULL); ++f) {
    char name[96];
    if (!is_kept(field, components)) continue;
    snprintf(name, sizeof name, "one_%s_%d.vtp", field, (int)on->dim);
    write_set(on, directory, name, 1, &field);
  }
}

static void write_dimension(const char *directory, int32_t dim) {
  static const char *const some[] = {"applied_force",     "stress",   "label",      "deformation_gradient",
                                     "velocity_gradient", "position", "prescribed", "size"};
  scene on = open_scene(dim, dim == 1 ? "neo_hookean" : "j2");
  mpm_context *context = on.context;
  char name[64];
  snprintf(name, sizeof name, "empty_%d.vtp", (int)dim);
  write_set(&on, directory, name, 0, NULL);
  fill(&on);
  snprintf(name, sizeof name, "new_%d.vtp", (int)dim);
  write_set(&on, directory, name, 0, NULL);
  for (int32_t k = 0; k < 20; ++k) OK(mpm_step(on.stepper, 1e-3, NULL));
  snprintf(name, sizeof name, "all_%d.vtp", (int)dim);
  write_set(&on, directory, name, 0, NULL);
  snprintf(name, sizeof name, "some_%d.vtp", (int)dim);
  write_set(&on, directory, name, (int32_t)(sizeof some / sizeof *some), some);
  write_one_by_one(&on, directory);
  close_scene(&on);
}

static void write_series(const char *directory) {
  scene on = open_scene(2, "neo_hookean");
  mpm_context *context = on.context;
  mpm_series *series;
  char path[1024], name[64];
  fill(&on);
  snprintf(path, sizeof path, "%s/run.pvd", directory);
  OK(mpm_series_open(context, path, &series));
  for (int32_t k = 0; k < 3; ++k) {
    mpm_step_info info = {.struct_size = sizeof info};
    snprintf(name, sizeof name, "a <run> & \"%d'.vtp", (int)k);
    OK(mpm_step(on.stepper, 1e-3, &info));
    write_set(&on, directory, name, 0, NULL);
    OK(mpm_series_append(series, info.t, name));
    printf("%.17g\n", info.t);
  }
  OK(mpm_series_close(series));
  close_scene(&on);
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  for (int32_t dim = 1; dim <= 3; ++dim) write_dimension(argv[1], dim);
  write_series(argv[1]);
  return 0;
}
