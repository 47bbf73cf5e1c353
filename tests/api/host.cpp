// A host program in C++17: a block drifts and is pushed, on two threads, by a callback that is a lambda.
#include <mpm/mpm.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

mpm_context *ctx = nullptr;

void require(bool good, const char *what) {
  if (good) return;
  std::fprintf(stderr, "%s: %s\n", what, mpm_last_error(ctx));
  std::exit(1);
}

void must(mpm_status status, const char *what) {
  require(status == MPM_OK, (std::string(what) + ": " + mpm_status_name(status)).c_str());
}

} // namespace

int main() {
  mpm_context_desc services;
  must(mpm_context_desc_init(&services, sizeof services), "services");
  services.concurrency = 2;
  must(mpm_context_create(&services, &ctx), "context");

  mpm_grid_desc g;
  must(mpm_grid_desc_init(&g, sizeof g), "grid desc");
  g.dim = 3;
  g.basis = MPM_BSPLINE2;
  for (int axis = 0; axis < 3; ++axis) {
    g.spacing[axis] = 0.25;
    g.cells[axis] = 16;
  }
  mpm_grid *grid = nullptr;
  must(mpm_grid_create(ctx, &g, &grid), "grid");
  const mpm_param elastic[] = {{"E", 1e5}, {"nu", 0.25}, {"density", 500.0}};
  mpm_material *material = nullptr;
  must(mpm_material_create(ctx, "neo_hookean", elastic, 3, &material), "material");
  mpm_particles *set = nullptr;
  must(mpm_particles_create(ctx, grid, material, &set), "set");
  const double lower[] = {1.0, 1.0, 1.0}, upper[] = {2.0, 2.0, 2.0}, drift[] = {1.0, -0.5, 0.25};
  const int32_t per_cell[] = {2, 2, 2};
  must(mpm_particles_fill_box(set, lower, upper, per_cell, nullptr, nullptr), "fill");
  must(mpm_particles_set_all(set, "velocity", MPM_F64, 3, drift), "velocity");

  mpm_stepper_desc s;
  must(mpm_stepper_desc_init(&s, sizeof s), "stepper desc");
  mpm_stepper *stepper = nullptr;
  must(mpm_stepper_create(ctx, grid, &s, &stepper), "stepper");
  must(mpm_stepper_add(stepper, set), "add");
  // A body acceleration along x, by a lambda without captures.
  const auto push = [](void *user, const mpm_particle_batch *batch, double *add) -> mpm_status {
    for (int64_t p = 0; p < batch->n; ++p) add[p] += *static_cast<const double *>(user);
    return MPM_OK;
  };
  double rate = 3.0;
  must(mpm_stepper_set_acceleration(stepper, push, &rate), "acceleration");

  mpm_advance_desc advance;
  must(mpm_advance_desc_init(&advance, sizeof advance), "advance desc");
  advance.t_end = 0.05;
  advance.cfl = 0.4;
  mpm_step_info info{};
  info.struct_size = sizeof info;
  must(mpm_advance(stepper, &advance, &info), "advance");

  const double mass = 500.0;
  const double expected[] = {mass * (1.0 + rate * 0.05), mass * -0.5, mass * 0.25};
  for (int axis = 0; axis < 3; ++axis)
    require(std::abs(info.momentum[axis] - expected[axis]) <= 1e-9 * mass, "momentum");
  std::vector<double> x(3 * 512);
  must(mpm_particles_get(set, "position", MPM_F64, 3, 512, nullptr, x.data()), "get");
  double mean = 0.0;
  for (int p = 0; p < 512; ++p) mean += x[static_cast<std::size_t>(p)] / 512;
  require(std::abs(mean - (1.5 + 0.05)) < 0.01, "mean position");

  must(mpm_stepper_destroy(stepper), "destroy");
  must(mpm_particles_destroy(set), "destroy");
  must(mpm_material_destroy(material), "destroy");
  must(mpm_grid_destroy(grid), "destroy");
  must(mpm_context_destroy(ctx), "destroy");
  std::puts("ok");
}
