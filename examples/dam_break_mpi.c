/* A block of water collapses in a tank, on any number of processes:
 *
 *   mpirun -n 4 dam_break_mpi [CELLS [FRAMES [STATE]]]
 *
 * CELLS are those along the height of the block (default 20: 64 000 particles), FRAMES those that it is
 * followed for (40, each 0.02 s), STATE a file to go on from. It writes water_0000.pvtp ... for ParaView,
 * every ten frames water.state, and prints energies and a hash of the state, which are the same for any
 * number of processes. The picture water_parts.svg shows who has which particles before and after blocks of
 * the grid were given to other processes. The lines for MPI are marked with a +: without them it is a
 * program for one process. */
#include <mpm/mpm_mpi.h> /* + */

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "parts_film.h" /* + */

static const double frame_time = 0.02, height = 1.0;

int main(int argc, char **argv) {
  int rank = 0, level, failed = 1;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level); /* + */
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);                       /* + */
  const int cells = argc > 1 ? atoi(argv[1]) : 20, frames = argc > 2 ? atoi(argv[2]) : 40;
  char why[1024] = "";
  mpm_context_desc cd;
  mpm_grid_desc gd;
  mpm_stepper_desc sd;
  mpm_advance_desc go;
  mpm_mpi *mpi = NULL; /* + */
  mpm_context *ctx = NULL;
  mpm_grid *grid = NULL;
  mpm_material *material = NULL;
  mpm_particles *water = NULL;
  mpm_stepper *stepper = NULL;
  parts_film seen = {.rank = 0}; /* + */
  if (mpm_context_desc_init(&cd, sizeof cd) || mpm_grid_desc_init(&gd, sizeof gd) ||
      mpm_stepper_desc_init(&sd, sizeof sd) || mpm_advance_desc_init(&go, sizeof go))
    goto end;
  cd.error_text = why;
  cd.error_bytes = sizeof why;
  if (mpm_mpi_open(MPI_COMM_WORLD, &cd, &mpi)) goto end; /* + */
  if (mpm_context_create(&cd, &ctx)) goto end;

  /* a tank three blocks long, one wide and two high */
  const int64_t tank[] = {3, 1, 2};
  for (int k = 0; k < 3; ++k) {
    gd.spacing[k] = height / cells;
    gd.cells[k] = tank[k] * cells;
  }
  sd.transfer = MPM_APIC;
  sd.gravity[2] = -9.81;
  go.cfl = 0.4;
  /* sound ten times as fast as the water gets */
  const mpm_param law[] = {{"density", 1000.0}, {"bulk_modulus", 2e6}, {"viscosity", 1e-3}, {"tension", 0.0}};
  const double lower[] = {0.0, 0.0, 0.0}, upper[] = {height, height, height};
  const int32_t per_cell[] = {2, 2, 2};
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "newtonian_fluid", law, 4, &material) ||
      mpm_particles_create(ctx, grid, material, &water) ||
      mpm_particles_fill_box(water, lower, upper, per_cell, NULL, NULL) ||
      parts_film_open(&seen, water, 0.5 * height / cells, 0.5 * height / cells) || /* + */
      mpm_stepper_create(ctx, grid, &sd, &stepper) || mpm_stepper_add(stepper, water))
    goto end;
  for (int32_t face = MPM_X_MIN; face <= MPM_Z_MAX; ++face)
    if (mpm_stepper_set_wall(stepper, face, MPM_WALL_SLIP, 0.0)) goto end;
  if (argc > 3 && mpm_mpi_load(mpi, stepper, argv[3])) goto end; /* + */

  mpm_parallel_info part = {.struct_size = sizeof part}; /* + */
  mpm_step_info now = {.struct_size = sizeof now};
  if (mpm_stepper_info(stepper, &now)) goto end;
  for (int frame = (int)(now.t / frame_time + 0.5); frame < frames; ++frame) {
    char path[40];
    snprintf(path, sizeof path, "water_%04d.pvtp", frame);
    if (mpm_mpi_write_particles(mpi, water, path, NULL)) goto end;              /* + */
    if (frame % 10 == 9 && mpm_mpi_save(mpi, stepper, "water.state")) goto end; /* + */
    go.t_end = frame_time * (frame + 1);
    /* the same steps on all processes, and the same outcome */
    if (mpm_advance(stepper, &go, &now)) goto end;
    if (mpm_stepper_parallel_info(stepper, 0, &part) || parts_film_shoot(&seen, water, now.t, part.cuts))
      goto end; /* + */
    if (!rank)
      printf("t %.2f  step %" PRId64 "  kinetic energy %.17g\n", now.t, now.step, now.kinetic_energy);
  }
  uint64_t hash;
  if (mpm_state_hash(stepper, &hash)) goto end;
  if (!rank) printf("result: hash of the state %016" PRIx64 "\n", hash);
  if (parts_film_draw(&seen, "water_parts.svg", 3.0 * height, 1.2 * height) ||
      mpm_stepper_parallel_info(stepper, 0, &part))
    goto end; /* + */
  printf("part %d: %" PRId64 " particles in %" PRId64 " blocks, %" PRId64
         " at the edge; %d neighbours with %" PRId64 " ghosts; per step %.0f kB sent; %" PRId64
         " particles left, imbalance %.2f; %.2f s packing, %.2f waiting, %.2f reducing\n",
         rank, mpm_particles_count(water), part.blocks, part.boundary, (int)part.neighbours, part.ghosts,
         1e-3 * (double)part.bytes_nodes / (double)now.step, part.moved, part.imbalance, part.seconds_packing,
         part.seconds_waiting, part.seconds_reducing);
  failed = 0;

end:
  if (failed)
    fprintf(stderr, "process %d: %s %s %s\n", rank, why, ctx ? mpm_last_error(ctx) : "",
            mpi ? mpm_mpi_last_error(mpi) : "");
  if (failed) MPI_Abort(MPI_COMM_WORLD, 1); /* + */
  failed = mpm_stepper_destroy(stepper) || mpm_particles_destroy(water) || mpm_material_destroy(material) ||
           mpm_grid_destroy(grid) || mpm_context_destroy(ctx);
  parts_film_close(&seen); /* + */
  mpm_mpi_close(mpi);      /* + */
  MPI_Finalize();          /* + */
  return failed;
}
