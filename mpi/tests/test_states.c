/* A problem in as many parts as there are processes, which saves its state every five steps:
 *
 *   test_states explicit|implicit STATE FROM LAST [dies STEP|fails]
 *   test_states explicit|implicit - - LAST
 *
 * It goes on from the file FROM, or from the beginning where that is -, up to step LAST. A process is killed
 * in step STEP; or each step is refused by the last process alone before it is made. It says from which step
 * it goes on, and the hash of the state in the end. Some processes have two threads. A block flies in
 * explicit steps; in implicit ones it falls on another, with friction.
 *
 * Without STATE the problem has no transport, and one thread: what it says is wanted of all others. */
#define _POSIX_C_SOURCE 200809L
#include <mpm/mpm_mpi.h>

#include <inttypes.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include "meet.h"

typedef struct world {
  mpm_mpi *mpi;
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set[2];
  int32_t sets;
  mpm_stepper *stepper;
  mpm_status answer; /* of the force callback on this process */
} world;

static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  const world *w = user;
  for (int64_t i = 0; i < b->n; ++i) add[b->ld + i] -= 2.0 * b->mass[i] * b->position[i];
  return w->answer;
}

static void add_block(world *w, int32_t fills, const double low[2], const double high[2],
                      const double speed[2]) {
  const int32_t per_cell[] = {2, 2}, body = w->sets++;
  mpm_particles **set = &w->set[body];
  MUST(!mpm_particles_create(w->context, w->grid, w->material, set));
  if (fills) {
    MUST(!mpm_particles_fill_box(*set, low, high, per_cell, NULL, NULL));
    MUST(!mpm_particles_set_all(*set, "velocity", MPM_F64, 2, speed));
  }
  MUST(!mpm_stepper_add(w->stepper, *set));
  if (body) MUST(!mpm_stepper_set_body(w->stepper, *set, body));
}

static void open_world(world *w, int32_t is_implicit, int32_t is_alone, int32_t fills) {
  const mpm_param law[] = {{"E", 1e5}, {"nu", 0.3}, {"density", 1000.0}};
  mpm_context_desc c;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_contact_desc meets;
  const int32_t cells = is_implicit ? 32 : 64;
  MUST(!mpm_context_desc_init(&c, sizeof c) && !mpm_grid_desc_init(&g, sizeof g));
  MUST(!mpm_stepper_desc_init(&s, sizeof s) && !mpm_contact_desc_init(&meets, sizeof meets));
  *w = (world){.mpi = NULL};
  if (!is_alone) {
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    c.concurrency = 2 - rank % 2;
    MUST(!mpm_mpi_open(MPI_COMM_WORLD, &c, &w->mpi));
  }
  g.dim = 2;
  for (int32_t k = 0; k < 2; ++k) g.cells[k] = cells, g.spacing[k] = 1.0 / cells;
  s.transfer = is_implicit ? MPM_FLIP : MPM_APIC;
  s.scheme = is_implicit ? MPM_NEWMARK : MPM_MUSL;
  /* what MPM_SOLVER_AUTO is with a transport and friction; without a transport it would be a factor */
  if (is_alone && is_implicit) s.linear_solver = MPM_SOLVER_GMRES;
  MUST(!mpm_context_create(&c, &w->context) && !mpm_grid_create(w->context, &g, &w->grid));
  MUST(!mpm_material_create(w->context, "neo_hookean", law, 3, &w->material));
  MUST(!mpm_stepper_create(w->context, w->grid, &s, &w->stepper));
  MUST(!mpm_stepper_set_force(w->stepper, push, w));
  if (is_implicit) {
    meets.friction = 0.3;
    add_block(w, fills, (double[]){0.0625, 0.125}, (double[]){0.9375, 0.375}, (double[]){0.0, 0.0});
    add_block(w, fills, (double[]){0.25, 0.375}, (double[]){0.625, 0.5625}, (double[]){0.5, -1.0});
    MUST(!mpm_stepper_set_contact(w->stepper, 0, 1, &meets));
  } else {
    add_block(w, fills, (double[]){0.2, 0.2}, (double[]){0.7, 0.6}, (double[]){6.0, 3.0});
  }
  for (int32_t face = 0; face < 4; ++face) MUST(!mpm_stepper_set_wall(w->stepper, face, MPM_WALL_SLIP, 0.0));
}

static void close_world(world *w) {
  MUST(!mpm_stepper_destroy(w->stepper));
  for (int32_t m = 0; m < w->sets; ++m) MUST(!mpm_particles_destroy(w->set[m]));
  MUST(!mpm_material_destroy(w->material) && !mpm_grid_destroy(w->grid));
  MUST(!mpm_context_destroy(w->context) && !mpm_mpi_close(w->mpi));
}

/* What no process can load says so on all of them, and leaves the state as it was. */
static void refuses(world *w, const char *path, int rank) {
  char damaged[700];
  uint64_t before, after;
  snprintf(damaged, sizeof damaged, "%s.damaged", path);
  if (!rank) {
    FILE *in = fopen(path, "rb"), *out = fopen(damaged, "wb");
    MUST(in && out);
    int byte;
    for (long at = 0; (byte = fgetc(in)) != EOF; ++at) fputc(at == 5000 ? byte ^ 1 : byte, out);
    MUST(!fclose(in) && !fclose(out));
  }
  MPI_Barrier(MPI_COMM_WORLD);
  MUST(!mpm_state_hash(w->stepper, &before));
  MUST(mpm_mpi_load(w->mpi, w->stepper, damaged) == MPM_E_FORMAT);
  MUST_SAY(mpm_mpi_last_error(w->mpi), "mpm_state_load_pieces: MPM_E_FORMAT");
  MUST_SAY(mpm_last_error(w->context), "the state is damaged: its checksum is wrong");
  MUST(!mpm_state_hash(w->stepper, &after) && before == after);
  MPI_Barrier(MPI_COMM_WORLD);
  if (!rank) remove(damaged);
}

/* What the last process alone refuses, or wants smaller, all refuse with its sentence; nothing changes. */
static void refuse_step(world *w, double dt, int rank, int last) {
  const mpm_status answer[] = {-3, 7}, wanted[] = {MPM_E_CALLBACK, MPM_CUT_DT};
  const char *words[] = {"the force callback returned -3", "the force callback returned 7"};
  char text[1000], with_part[1050];
  for (int k = 0; k < 2; ++k) {
    mpm_step_info info = {.struct_size = sizeof info};
    uint64_t before, after;
    MUST(!mpm_state_hash(w->stepper, &before));
    if (rank == last) w->answer = answer[k];
    MUST(mpm_step(w->stepper, dt, &info) == wanted[k]);
    w->answer = MPM_OK;
    MUST(info.callback_status == answer[k]);
    snprintf(text, sizeof text, "%s", mpm_last_error(w->context));
    MPI_Bcast(text, sizeof text, MPI_CHAR, last, MPI_COMM_WORLD);
    MUST_SAY(text, words[k]);
    snprintf(with_part, sizeof with_part, "part %d: %s", last, strstr(text, words[k]));
    MUST(rank == last || !strcmp(mpm_last_error(w->context), with_part));
    MUST(!mpm_state_hash(w->stepper, &after) && before == after);
  }
}

int main(int argc, char **argv) {
  int rank, size, level;
  world w;
  uint64_t hash;
  mpm_step_info now = {.struct_size = sizeof now};
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  MUST(argc >= 5 && level >= MPI_THREAD_FUNNELED);
  const int32_t is_implicit = !strcmp(argv[1], "implicit"), is_alone = !strcmp(argv[2], "-");
  const int32_t from = strcmp(argv[3], "-") != 0, fails = argc > 5 && !strcmp(argv[5], "fails");
  const int64_t last = atoi(argv[4]), dies = argc > 6 ? atoi(argv[6]) : -1;
  open_world(&w, is_implicit, is_alone, !from);
  if (from) {
    MUST(!mpm_mpi_load(w.mpi, w.stepper, argv[3]));
    refuses(&w, argv[3], rank);
  }
  MUST(!mpm_stepper_info(w.stepper, &now));
  if (!rank) printf("from step %" PRId64 "\n", now.step);
  while (now.step < last) {
    const double dt = (is_implicit ? 4e-4 : 2e-4) * (double)(1 + now.step % 3);
    if (now.step + 1 == dies && rank == size - 1) raise(SIGKILL);
    if (fails) refuse_step(&w, dt, rank, size - 1);
    MUST(!mpm_step(w.stepper, dt, &now));
    if (now.step % 5 == 0 && !is_alone) MUST(!mpm_mpi_save(w.mpi, w.stepper, argv[2]));
  }
  MUST(!is_implicit || now.contact_nodes > 0);
  MUST(!mpm_state_hash(w.stepper, &hash));
  if (!rank)
    printf("result: %016" PRIx64 ", %" PRId64 " sorts, kinetic energy %.17g\n", hash, now.resorts,
           now.kinetic_energy);
  close_world(&w);
  return MPI_Finalize();
}
