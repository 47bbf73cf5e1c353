// The C++ wrapper: a block of rubber stands in a frictionless mould and settles under its own weight, which
// is switched on at t = 0. A force callback, a lambda, takes the motion out. Prints the settlement beside
// that of elasticity.
#include <mpm/mpm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

const double width = 0.5, height = 1.0, h = 0.125;
const double E = 1e6, nu = 0.25, density = 1e3, g = 10.0;

int run() {
  const mpm::context context;

  mpm::grid_desc box; // starts with the defaults
  box.dim = 2;
  box.cells[0] = 4, box.cells[1] = 10;
  box.spacing[0] = box.spacing[1] = h;
  const mpm::grid grid(context, box);

  mpm::particles block(grid,
                       mpm::material(context, "neo_hookean", {{"E", E}, {"nu", nu}, {"density", density}}));
  block.fill_box({0.0, 0.0}, {width, height}, {2, 2});
  const std::vector<double> start = block.get("position");
  const auto count = static_cast<std::size_t>(block.count());

  mpm::stepper_desc how;
  how.gravity[1] = -g;
  mpm::stepper stepper(grid, how);
  stepper.add(block);
  for (const int32_t face : {MPM_X_MIN, MPM_X_MAX, MPM_Y_MIN}) stepper.set_wall(face, MPM_WALL_SLIP);

  // Nearly critical for the slowest oscillation of the column.
  const double modulus = E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
  const double damping = 3.0 * std::sqrt(modulus / density) / height;
  stepper.set_force([damping](const mpm_particle_batch &b, double *add) {
    for (int64_t i = 0; i < b.n; ++i)
      for (int32_t c = 0; c < b.dim; ++c) add[c * b.ld + i] -= damping * b.mass[i] * b.velocity[c * b.ld + i];
  });

  std::printf("A block of %lld particles settles in a mould\n\n", static_cast<long long>(block.count()));
  std::printf("  t/s   kinetic/J   strain/J   floor/N\n");
  mpm::step_info now;
  for (int k = 1; k <= 5; ++k) {
    const mpm::outcome done = stepper.advance(mpm::advance_desc(0.1 * k), now);
    if (!done) { // a step that cannot be made is no exception: a host may have an answer to it
      std::fprintf(stderr, "cpp_block: stopped at t = %g: %s\n", now.t, done.message().c_str());
      return 1;
    }
    std::printf("%5.2f %11.3e %10.4f %9.1f\n", now.t, now.kinetic_energy, now.strain_energy,
                stepper.wall_reaction(MPM_Y_MIN)[1]);
  }

  // Statics of the column, of small strain: u = -density g / modulus (height y - y^2 / 2).
  const std::vector<double> end = block.get("position");
  const double most = density * g * height * height / (2.0 * modulus);
  double settled = 0.0, error = 0.0;
  for (std::size_t p = 0; p < count; ++p) {
    const double y = start[count + p], u = end[count + p] - y;
    settled = std::max(settled, -u);
    error = std::max(error, std::abs(u + 2.0 * most / height * (y - y * y / (2.0 * height))));
  }
  const double floor = stepper.wall_reaction(MPM_Y_MIN)[1], weight = density * g * width * height;
  std::printf("\nresult: settlement %.3f mm, from theory by %.2f %%; floor from weight by %.4f %%\n",
              1e3 * settled, 100.0 * error / most, 100.0 * std::abs(floor / weight - 1.0));
  return 0; // everything is freed here, in whatever order
}

} // namespace

int main() {
  try {
    return run();
  } catch (const std::exception &e) { // mpm::error has the status, too
    std::fprintf(stderr, "cpp_block: %s\n", e.what());
    return 1;
  }
}
