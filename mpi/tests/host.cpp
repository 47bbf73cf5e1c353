// A host in C++, which an installation has to serve: it opens, writes, is refused and closes.
#include <mpm/mpm_mpi.hpp>

#include <iostream>

static int run(const std::string &folder) {
  mpm::context_desc services;
  mpm::mpi opened(MPI_COMM_WORLD, services), world(std::move(opened));
  mpm::context context(services);
  const mpm_transport &transport = *services.transport;
  mpm::grid_desc g;
  g.dim = 1;
  g.cells[0] = 8;
  g.spacing[0] = 1.0;
  mpm::grid grid(context, g);
  mpm::material material(context, "neo_hookean", {{"E", 1e4}, {"nu", 0.3}, {"density", 1000.0}});
  mpm::particles set(grid, material);
  const double lower[] = {1.0}, upper[] = {3.0};
  const int32_t per_cell[] = {2};
  if (mpm_particles_fill_box(set.handle(), lower, upper, per_cell, nullptr, nullptr)) return 1;
  world.write(set, folder + "/host.pvtp", {1, {"velocity", "id"}});
  mpm::stepper stepper(grid);
  stepper.add(set);
  world.save(stepper, folder + "/host.state");
  world.load(stepper, folder + "/host.state");
  try {
    world.write(set, folder + "/host.vtp");
    return 1;
  } catch (const mpm::error &e) {
    if (e.status() != MPM_E_ARG || !std::string(e.what()).find(".pvtp")) return 1;
  }
  if (opened.handle() || !world.handle()) return 1;
  if (!transport.part) std::cout << transport.parts << " parts\n";
  return 0;
}

int main(int argc, char **argv) {
  int level;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  int failed = argc < 2;
  try {
    if (!failed) failed = run(argv[1]);
    mpm::context_desc services;
    mpm::mpi none(MPI_COMM_NULL, services);
    failed = 1;
  } catch (const mpm::error &e) {
    if (e.status() != MPM_E_ARG || std::string(e.what()).find("MPI_COMM_NULL") == std::string::npos)
      failed = 1;
  }
  MPI_Finalize();
  return failed;
}
