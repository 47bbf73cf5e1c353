/* A host in C, which an installation has to serve: it opens, writes, saves, loads and closes. */
#include <mpm/mpm_mpi.h>
#include <stdio.h>

int main(int argc, char **argv) {
  int level;
  char path[1000];
  mpm_context_desc desc;
  mpm_mpi *mpi;
  mpm_context *context;
  mpm_grid_desc g;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
  const mpm_param law[] = {{"E", 1e4}, {"nu", 0.3}, {"density", 1000.0}};
  const double lower[] = {1.0}, upper[] = {3.0};
  const int32_t per_cell[] = {2};
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  if (argc < 2 || mpm_context_desc_init(&desc, sizeof desc) || mpm_mpi_open(MPI_COMM_WORLD, &desc, &mpi))
    return 1;
  const mpm_transport *transport = desc.transport;
  if (mpm_context_create(&desc, &context) || mpm_grid_desc_init(&g, sizeof g)) return 1;
  g.dim = 1;
  g.cells[0] = 8;
  g.spacing[0] = 1.0;
  snprintf(path, sizeof path, "%s/host.pvtp", argv[1]);
  if (mpm_grid_create(context, &g, &grid) || mpm_material_create(context, "neo_hookean", law, 3, &material) ||
      mpm_particles_create(context, grid, material, &set) ||
      mpm_particles_fill_box(set, lower, upper, per_cell, NULL, NULL) ||
      mpm_mpi_write_particles(mpi, set, path, NULL))
    return 1;
  snprintf(path, sizeof path, "%s/host.state", argv[1]);
  if (mpm_stepper_create(context, grid, NULL, &stepper) || mpm_stepper_add(stepper, set) ||
      mpm_mpi_save(mpi, stepper, path) || mpm_mpi_load(mpi, stepper, path) || mpm_stepper_destroy(stepper))
    return 1;
  if (!transport->part) printf("%d parts\n", (int)transport->parts);
  if (mpm_particles_destroy(set) || mpm_material_destroy(material) || mpm_grid_destroy(grid) ||
      mpm_context_destroy(context) || mpm_mpi_close(mpi))
    return 1;
  return MPI_Finalize();
}
