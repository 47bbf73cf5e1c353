/* Saved states, hashes, files for visualisation. */
#include "io.h"

#include "sets.h"

io_setup io_plain(int32_t dim) {
  return (io_setup){.dim = dim, .transfer = MPM_FLIP, .scheme = MPM_USL, .concurrency = 1};
}

static mpm_status add_fields(world *w, int32_t m) {
  if (m) return mpm_particles_add_field(w->set[1], "grain", MPM_I64, 2);
  const mpm_status status = mpm_particles_add_field(w->set[0], "colour", MPM_U8, 3);
  return status ? status : mpm_particles_add_field(w->set[0], "temperature", MPM_F64, 1);
}

/* The bodies are on a collision course, and values in the host's fields tell the particles apart. */
static mpm_status fill(world *w, int32_t m) {
  static const double lower[2][3] = {{-0.5, 0.0, 0.0}, {2.0, 0.0, 0.0}};
  static const double upper[2][3] = {{1.0, 1.0, 1.0}, {3.0, 1.5, 1.0}};
  static const double speed[2][3] = {{12.0, 5.0, 3.0}, {-9.0, 2.0, 4.0}};
  const int32_t per_cell[] = {3, 2, 2};
  ck_ok(w, mpm_particles_fill_box(w->set[m], lower[m], upper[m], per_cell, NULL, NULL));
  ck_ok(w, mpm_particles_set_all(w->set[m], "velocity", MPM_F64, w->dim, speed[m]));
  for (int64_t id = 0; id < mpm_particles_count(w->set[m]); ++id) {
    const uint8_t colour[] = {(uint8_t)id, (uint8_t)(id / 3), 255};
    const double temperature = 0.1 * (double)id;
    const int64_t grain[] = {id * id, -id};
    if (m) {
      ck_ok(w, mpm_particles_set(w->set[1], "grain", MPM_I64, 2, 1, &id, grain));
      continue;
    }
    ck_ok(w, mpm_particles_set(w->set[0], "colour", MPM_U8, 3, 1, &id, colour));
    ck_ok(w, mpm_particles_set(w->set[0], "temperature", MPM_F64, 1, 1, &id, &temperature));
  }
  return MPM_OK;
}

static mpm_status set_walls(world *w) {
  world_walls(w, MPM_WALL_SLIP, 0.0);
  return MPM_OK;
}

world_desc io_bare_desc(const mpm_grid_desc *grid) {
  world_desc d = world_default(grid->dim, 1, 1.0);
  d.grid = *grid;
  d.stepper.gravity[0] = -3.0;
  d.law = (world_law){.model = "neo_hookean", .E = 1e6, .nu = 0.3, .density = 2e3};
  d.other_law =
      (world_law){.model = "j2", .E = 2e6, .nu = 0.2, .density = 1e3, .yield_stress = 1e4, .hardening = 1e4};
  d.sets = 2;
  d.dt = 0.004;
  d.memory.filling = 0xa5; /* this is neither a number that spreads nor the id of an inert slot */
  return d;
}

world_desc io_desc(const io_setup *setup) {
  static const fill_fn filled[] = {add_fields, fill, NULL}, empty[] = {add_fields, NULL};
  static const equip_fn equip[] = {set_walls, NULL};
  mpm_grid_desc grid = sets_grid(setup->dim);
  grid.cells[0] = 140; /* several blocks */
  grid.origin[0] = -35.0;
  grid.periodic[0] = setup->periodic;
  world_desc d = io_bare_desc(&grid);
  d.stepper.scheme = setup->scheme;
  d.stepper.transfer = setup->transfer;
  d.stepper.reference_positions = setup->references;
  d.context.concurrency = setup->concurrency;
  d.fill = setup->empty ? empty : filled;
  d.equip = equip;
  return d;
}

void io_open(world *w, const io_setup *setup) {
  const world_desc d = io_desc(setup);
  world_open(w, &d);
}

void io_open_apart(world *w, int32_t dim, int64_t cells) {
  const mpm_grid_desc grid = grid_desc(dim, cells, 1.0);
  const world_desc d = io_bare_desc(&grid);
  world_open(w, &d);
  for (int32_t m = 0; m < 2; ++m) {
    const double near = 3.3, far = (double)cells - 4.3;
    const double x[] = {m ? far : near, m ? near : far, m ? far : near}, v[] = {1.0, 2.0, 3.0}, volume = 1.0;
    ck_ok(w, mpm_particles_add(w->set[m], 1, x, v, &volume, NULL, NULL, NULL));
  }
  world_step(w, 1e-4);
}

Suite *io_suite(void) {
  Suite *suite = suite_create("io");
  suite_add_tcase(suite, io_state_case());
  suite_add_tcase(suite, io_unlike_case());
  suite_add_tcase(suite, io_damage_case());
  suite_add_tcase(suite, io_hash_case());
  suite_add_tcase(suite, io_file_case());
  suite_add_tcase(suite, io_replace_case());
  suite_add_tcase(suite, io_output_case());
  suite_add_tcase(suite, io_grid_case());
  suite_add_tcase(suite, io_stream_case());
  return suite;
}
