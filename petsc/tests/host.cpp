// A host in C++, which an installation has to serve: it makes a solver, lends it to a stepper, and is refused.
#include <mpm/mpm_petsc.hpp>
#include <petscsys.h>

#include <iostream>

static int run() {
  mpm::petsc opened(MPI_COMM_SELF), solver(std::move(opened));
  mpm::context context;
  mpm::grid_desc g;
  mpm::stepper_desc s;
  g.dim = 2;
  for (int k = 0; k < 2; ++k) g.cells[k] = 10, g.spacing[k] = 0.1;
  s.scheme = MPM_NEWMARK;
  s.linear_solver = MPM_SOLVER_HOST;
  s.gravity[1] = -9.81;
  mpm::grid grid(context, g);
  mpm::material material(context, "neo_hookean", {{"E", 1e5}, {"nu", 0.3}, {"density", 1000.0}});
  mpm::particles set(grid, material);
  const double lower[] = {0.2, 0.2}, upper[] = {0.6, 0.5};
  const int32_t per_cell[] = {2, 2};
  if (mpm_particles_fill_box(set.handle(), lower, upper, per_cell, nullptr, nullptr)) return 1;
  mpm::stepper stepper(grid, s);
  stepper.add(set);
  stepper.set_wall(MPM_Y_MIN, MPM_WALL_FIXED);
  solver.attach(stepper);
  if (!stepper.step(1e-2)) return 1;
  const mpm_petsc_info info = solver.info();
  std::cout << info.solves << " solves, " << info.patterns << " patterns" << solver.last_error() << "\n";
  if (opened.handle() || !solver.handle()) return 1;
  try {
    mpm::petsc none(MPI_COMM_NULL);
    return 1;
  } catch (const mpm::error &e) {
    if (e.status() != MPM_E_ARG) return 1;
  }
  return info.solves > 0 && info.reason > 0 ? 0 : 1;
}

int main(int argc, char **argv) {
  int failed = 1;
  if (PetscInitialize(&argc, &argv, nullptr, nullptr)) return 1;
  try {
    failed = run();
  } catch (const mpm::error &e) {
    std::cerr << e.what() << "\n";
  }
  return PetscFinalize() || failed;
}
