/* Threads: the same simulation on the calling thread, on the library's pool, on a pool that belongs to the
 * host, and on an executor that takes the tasks in a random order. The state afterwards is the same to the
 * last bit, which a hash of it shows. */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>

/* ---- a pool of the host: three sleeping threads beside the calling one -------------------------------- */

enum { HELPERS = 3 };
typedef struct host_pool {
  pthread_mutex_t lock;
  pthread_cond_t work, done;
  pthread_t helper[HELPERS];
  mpm_task_fn task;
  void *task_data;
  int64_t next, count, finished;
  int quit;
} host_pool;

/* Runs tasks until none is left to start. The lock is held on entry and on return. */
static void take_tasks(host_pool *pool) {
  while (pool->next < pool->count) {
    const int64_t k = pool->next++;
    pthread_mutex_unlock(&pool->lock);
    pool->task(pool->task_data, k);
    pthread_mutex_lock(&pool->lock);
    if (++pool->finished == pool->count) pthread_cond_signal(&pool->done);
  }
}

static void *helper_main(void *argument) {
  host_pool *pool = argument;
  pthread_mutex_lock(&pool->lock);
  while (!pool->quit) {
    if (pool->next < pool->count)
      take_tasks(pool);
    else
      pthread_cond_wait(&pool->work, &pool->lock);
  }
  pthread_mutex_unlock(&pool->lock);
  return NULL;
}

static mpm_status on_pool(void *user, int64_t count, mpm_task_fn task, void *task_data) {
  host_pool *pool = user;
  pthread_mutex_lock(&pool->lock);
  pool->task = task;
  pool->task_data = task_data;
  pool->next = pool->finished = 0;
  pool->count = count;
  pthread_cond_broadcast(&pool->work);
  take_tasks(pool);
  while (pool->finished < count) pthread_cond_wait(&pool->done, &pool->lock);
  pthread_mutex_unlock(&pool->lock);
  return MPM_OK;
}

static int pool_start(host_pool *pool) {
  if (pthread_mutex_init(&pool->lock, NULL) || pthread_cond_init(&pool->work, NULL) ||
      pthread_cond_init(&pool->done, NULL))
    return -1;
  for (int i = 0; i < HELPERS; ++i)
    if (pthread_create(&pool->helper[i], NULL, helper_main, pool)) return -1;
  return 0;
}

static void pool_stop(host_pool *pool) {
  pthread_mutex_lock(&pool->lock);
  pool->quit = 1;
  pthread_cond_broadcast(&pool->work);
  pthread_mutex_unlock(&pool->lock);
  for (int i = 0; i < HELPERS; ++i) pthread_join(pool->helper[i], NULL);
  pthread_cond_destroy(&pool->done);
  pthread_cond_destroy(&pool->work);
  pthread_mutex_destroy(&pool->lock);
}

/* ---- tasks in random order ---------------------------------------------------------------------------- */

static int64_t common_divisor(int64_t a, int64_t b) {
  return b ? common_divisor(b, a % b) : a;
}

/* k -> (start + stride k) mod count meets every task once when stride and count have no common divisor. */
static mpm_status in_random_order(void *user, int64_t count, mpm_task_fn task, void *task_data) {
  uint32_t *random = user;
  int64_t stride, start;
  do {
    *random = *random * 1664525u + 1013904223u;
    stride = 1 + (*random >> 8) % count;
    start = (*random >> 4) % count;
  } while (count > 1 && common_divisor(count, stride) != 1);
  for (int64_t k = 0; k < count; ++k) task(task_data, (start + stride * k) % count);
  return MPM_OK;
}

/* ---- the simulation: an elastic ball is thrown on the floor ------------------------------------------- */

/* A callback marked (mt) may run on several threads at once: it touches nothing but its batch. */
static mpm_status wind(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) add[p] += 2.0 * b->position[2 * b->ld + p];
  return MPM_OK;
}

static int simulate(const char *label, const mpm_context_desc *services, uint64_t *hash) {
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *ball;
  mpm_stepper *stepper;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  if (mpm_context_create(services, &ctx) || mpm_grid_desc_init(&g, sizeof g) ||
      mpm_stepper_desc_init(&s, sizeof s))
    goto failed;
  g.dim = 3;
  g.basis = MPM_BSPLINE2;
  for (int c = 0; c < 3; ++c) {
    g.cells[c] = 32;
    g.spacing[c] = 1.0 / 32.0;
  }
  s.scheme = MPM_MUSL;
  s.gravity[2] = -10.0;
  const mpm_param elastic[] = {{"E", 1e4}, {"nu", 0.3}, {"density", 100.0}};
  const double centre[] = {0.5, 0.5, 0.27}, down[] = {1.0, 0.0, -4.0};
  const int32_t per_cell[] = {2, 2, 2};
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", elastic, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &ball) ||
      mpm_particles_fill_ball(ball, centre, 0.25, per_cell, NULL, NULL) ||
      mpm_particles_set_all(ball, "velocity", MPM_F64, 3, down) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_stepper_add(stepper, ball) ||
      mpm_stepper_set_wall(stepper, MPM_Z_MIN, MPM_WALL_FRICTION, 0.3) ||
      mpm_stepper_set_acceleration(stepper, wind, NULL))
    goto failed;
  mpm_step_info now = {.struct_size = sizeof now};
  for (int k = 0; k < 40; ++k)
    if (mpm_step(stepper, 1e-3, &now)) goto failed;
  if (mpm_state_hash(stepper, hash)) goto failed;
  printf("%-36s %6" PRId64 " particles, strain energy %.9g, hash %016" PRIx64 "\n", label,
         mpm_particles_count(ball), now.strain_energy, *hash);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(ball) || mpm_material_destroy(rubber) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  return 0;

failed:
  fprintf(stderr, "host_threads: %s: %s\n", label, mpm_last_error(ctx));
  return -1;
}

int main(void) {
  mpm_context_desc own_pool, host, shuffled;
  static host_pool pool;
  uint32_t random = 1;
  uint64_t hash[4];
  if (mpm_context_desc_init(&own_pool, sizeof own_pool) || mpm_context_desc_init(&host, sizeof host) ||
      mpm_context_desc_init(&shuffled, sizeof shuffled) || pool_start(&pool)) {
    fprintf(stderr, "host_threads: cannot start\n");
    return 1;
  }
  own_pool.concurrency = 4;
  host.concurrency = 1 + HELPERS;
  host.parallel_for = on_pool;
  host.parallel_user = &pool;
  shuffled.concurrency = 7;
  shuffled.parallel_for = in_random_order;
  shuffled.parallel_user = &random;

  if (simulate("calling thread", NULL, &hash[0]) ||
      simulate("library's pool, 4 threads", &own_pool, &hash[1]) ||
      simulate("host's pool, 4 threads", &host, &hash[2]) ||
      simulate("host's executor, random order", &shuffled, &hash[3]))
    return 1;
  pool_stop(&pool);

  int equal = 0;
  for (int i = 0; i < 4; ++i) equal += hash[i] == hash[0];
  printf("\nresult: %d of 4 states equal bit by bit\n", equal);
  return equal == 4 ? 0 : 1;
}
