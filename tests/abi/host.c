/* A host that passes every versioned struct of the interface to the library and prints what it gets to the
 * last bit. tests/api/releases.sh compiles it against headers of several releases. With APPENDED the headers
 * have a field "appended" at the end of every such struct, and an argument makes the host set it in a
 * descriptor, which it then expects to be refused. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mpm/mpm.h>

enum { GUARD = 64, GUARD_BYTE = 0x5b, MOST_STRUCTS = 32 };

/* Structs have the size of this host's headers to the byte, and a guard behind them. */
static struct { unsigned char *guard; } made[MOST_STRUCTS];
static int made_count;

static void *make(size_t size) {
  unsigned char *memory = calloc(1, size + GUARD);
  if (!memory || made_count == MOST_STRUCTS) abort();
  const uint32_t struct_size = (uint32_t)size;
  memcpy(memory, &struct_size, sizeof struct_size);
  made[made_count++].guard = memset(memory + size, GUARD_BYTE, GUARD);
  return memory;
}
#define MAKE(type) ((type *)make(sizeof(type)))

static void check_guards(void) {
  for (int k = 0; k < made_count; ++k)
    for (int i = 0; i < GUARD; ++i)
      if (made[k].guard[i] != GUARD_BYTE) {
        printf("struct %d: the library wrote beyond its end\n", k);
        exit(1);
      }
}

static mpm_context *context;
static const char *set_appended = "";

static void ok(mpm_status status, const char *call) {
  if (status == MPM_OK) return;
  printf("%s: %s: %s\n", call, mpm_status_name(status), mpm_last_error(context));
  exit(1);
}
#define OK(call) ok(call, #call)

/* Sets the field that the library may not know, where the argument names the struct. */
#ifdef APPENDED
#define APPEND(struct_name, at)                                                                              \
  if (strcmp(set_appended, #struct_name) == 0) (at)->appended = 1.0
#else
#define APPEND(struct_name, at) (void)set_appended
#endif

static void show(const char *name, int32_t n, const double *value) {
  printf("%s", name);
  for (int32_t i = 0; i < n; ++i) printf(" %a", value[i]);
  puts("");
}

static void *host_alloc(void *user, size_t bytes, size_t alignment) {
  ++*(int64_t *)user;
  return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}
static void host_release(void *user, void *memory, size_t bytes, size_t alignment) {
  (void)bytes, (void)alignment;
  --*(int64_t *)user;
  free(memory);
}
static mpm_status host_parallel_for(void *user, int64_t count, mpm_task_fn task, void *task_data) {
  ++*(int64_t *)user;
  for (int64_t k = count - 1; k >= 0; --k) task(task_data, k);
  return 0;
}
static void host_log(void *user, int32_t level, const char *text) {
  *(int64_t *)user += level > 0 && text[0] != '\0';
}
static void host_released(void *user) {
  ++*(int64_t *)user;
}

/* The library's struct may be shorter than this host's, but not shorter than that of the first release. */
#define EXPECT_AT_LEAST(batch, last)                                                                         \
  if ((batch)->struct_size < (size_t)((const char *)(&(batch)->last + 1) - (const char *)(batch))) return -1

/* A fluid of the host. */
static mpm_status host_stress(void *user, const mpm_material_batch *b) {
  EXPECT_AT_LEAST(b, lookup);
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    const double J = b->F[i] * (b->F[4 * b->ld + i] * b->F[8 * b->ld + i]) -
                     b->F[b->ld + i] * b->F[3 * b->ld + i] * b->F[8 * b->ld + i];
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + i] = c < 3 ? 1e5 * (J - 1.0) : 0.0;
    b->state_new[i] = b->dt > 0.0 ? b->state[i] + b->dt : b->state[i];
    b->wave_speed[i] = 10.0;
  }
  return 0;
}
static mpm_status host_force(void *user, const mpm_particle_batch *b, double *add) {
  EXPECT_AT_LEAST(b, lookup);
  const double *tag;
  int64_t stride;
  if (mpm_batch_field(b->lookup, "tag", (const void **)(void *)&tag, &stride)) return -1;
  for (int64_t i = 0; i < b->n; ++i) add[b->ld + i] += b->mass[i] * (tag[i] - b->position[i]);
  *(double *)user = b->t + b->dt;
  return 0;
}
static mpm_status host_motion(void *user, const mpm_particle_batch *b, double *add) {
  EXPECT_AT_LEAST(b, lookup);
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) add[b->ld + i] -= 0.1;
  return 0;
}
static mpm_status host_velocity(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  EXPECT_AT_LEAST(b, mass);
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    if (b->position[b->ld + i] < 0.05) prescribed[i] = 1, velocity[i] = 0.01;
  return 0;
}
static mpm_status host_hook(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  EXPECT_AT_LEAST(b, mass);
  (void)user, (void)velocity;
  for (int64_t i = 0; i < b->n; ++i) force[i] += 1e-3 * b->mass[i];
  return 0;
}
#ifdef MPM_OBSTACLE_H /* not in 0.1.0 */
/* A surface that is far from everything. */
static mpm_status host_distance(void *user, const mpm_distance_batch *b) {
  EXPECT_AT_LEAST(b, velocity);
  ++*(int64_t *)user;
  for (int64_t i = 0; i < b->n; ++i) {
    b->distance[i] = 1e3;
    for (int32_t c = 0; c < b->dim; ++c) b->normal[c * b->ld + i] = c == 0;
  }
  return 0;
}
#endif
#ifdef MPM_SURFACE_H /* not in 0.1.0 */
static mpm_status host_traction(void *user, const mpm_marker_batch *b, double *add) {
  EXPECT_AT_LEAST(b, velocity);
  *(int64_t *)user += b->n;
  for (int64_t i = 0; i < b->n; ++i) add[i] += 0.0 * b->area[i];
  return 0;
}
#endif
static mpm_status host_progress(void *user, const mpm_step_info *info) {
  EXPECT_AT_LEAST(info, angular_momentum);
  ++*(int64_t *)user;
  return 0;
}
/* Jacobi's iteration: slow, short, and the same in every bit. */
static mpm_status host_solve(void *user, const mpm_operator *matrix, const double *rhs, double *x,
                             double tolerance, int64_t *iterations) {
  mpm_operator_info *info = user;
  const int64_t *start;
  const int32_t *column;
  const double *value;
  if (mpm_operator_get_info(matrix, info) || mpm_operator_csr(matrix, &start, &column, &value)) return -1;
  const int64_t n = info->rows;
  double *y = malloc((size_t)n * sizeof *y);
  double error = 1.0, norm = 0.0;
  if (!y || start[n] != info->nonzeros || !info->node || !info->component || !info->position) return -1;
  for (int64_t i = 0; i < n; ++i) norm += rhs[i] * rhs[i];
  for (*iterations = 0; *iterations < 20000 && error > 1e-4 * tolerance * tolerance * norm; ++*iterations) {
    error = 0.0;
    if (mpm_operator_apply(matrix, x, y)) return -1;
    for (int64_t i = 0; i < n; ++i) {
      double diagonal = 0.0;
      for (int64_t e = start[i]; e < start[i + 1]; ++e)
        if (column[e] == i) diagonal = value[e];
      const double residual = rhs[i] - y[i];
      error += residual * residual;
      x[i] += 0.4 * residual / diagonal;
    }
  }
  free(y);
  return error > 1e-4 * tolerance * tolerance * norm ? MPM_CUT_DT : 0;
}

static void show_info(const mpm_step_info *i) {
  const double values[] = {i->t,
                           i->dt,
                           i->dt_suggested,
                           i->residual,
                           i->kinetic_energy,
                           i->strain_energy,
                           i->external_work,
                           i->dissipation,
                           i->momentum[0],
                           i->momentum[1],
                           i->momentum[2],
                           i->angular_momentum[0],
                           i->angular_momentum[1],
                           i->angular_momentum[2]};
  printf("info %d %d %d %d %d %lld %lld %lld %lld %lld %lld %lld", i->cause, i->callback_status,
         i->newton_iterations, i->linear_solver, i->set, (long long)i->step, (long long)i->active_nodes,
         (long long)i->removed, (long long)i->resorts, (long long)i->particle, (long long)i->node,
         (long long)i->linear_iterations);
  show("", 14, values);
}

static void show_view(const char *name, mpm_view *view) {
  double sum = 0.0;
  for (int64_t i = 0; i < view->count; ++i)
    for (int32_t c = 0; c < view->components; ++c)
      sum +=
          (double)(1 + c) * ((const double *)view->data)[i * view->item_stride + c * view->component_stride];
  printf("%s: type %d components %d access %d count %lld sum %a\n", name, view->type, view->components,
         view->access, (long long)view->count, sum);
  OK(mpm_view_release(view));
  if (view->data || view->owner) exit(1);
}

int main(int argc, char **argv) {
  int64_t held = 0, runs = 0, logged = 0, released = 0, progress = 0;
  double last_t = 0.0;
  if (argc > 1) set_appended = argv[1];

  mpm_context_desc *services = MAKE(mpm_context_desc);
  OK(mpm_context_desc_init(services, sizeof *services));
  services->concurrency = 3;
  services->serial_callbacks = 1;
  services->alloc = host_alloc;
  services->release = host_release;
  services->alloc_user = &held;
  services->parallel_for = host_parallel_for;
  services->parallel_user = &runs;
  services->log = host_log;
  services->log_user = &logged;
  APPEND(mpm_context_desc, services);
  OK(mpm_context_create(services, &context));

  mpm_grid_desc *box = MAKE(mpm_grid_desc);
  mpm_grid *grid;
  OK(mpm_grid_desc_init(box, sizeof *box));
  box->dim = 2;
  box->cells[0] = box->cells[1] = 12;
  box->spacing[0] = box->spacing[1] = 0.1;
  APPEND(mpm_grid_desc, box);
  OK(mpm_grid_create(context, box, &grid));

  const mpm_param elastic[] = {{"E", 1e5}, {"nu", 0.3}, {"density", 1e3}};
  mpm_material_desc *fluid = MAKE(mpm_material_desc);
  mpm_material *material[2];
  const double state = 0.25;
  OK(mpm_material_create(context, "neo_hookean", elastic, 3, &material[0]));
  OK(mpm_material_desc_init(fluid, sizeof *fluid));
  fluid->density = 1e3;
  fluid->stress = host_stress;
  fluid->state_count = 1;
  fluid->state_initial = &state;
  fluid->user = &released;
  fluid->release_user = host_released;
  APPEND(mpm_material_desc, fluid);
  OK(mpm_material_create_custom(context, fluid, &material[1]));

  mpm_particles *set[2];
  const double lower[] = {0.2, 0.15, 0.6, 0.15}, upper[] = {0.5, 0.45, 0.9, 0.45};
  const int32_t per_cell[] = {2, 2};
  for (int m = 0; m < 2; ++m) {
    const double tag = 0.125 * (1 + m);
    OK(mpm_particles_create(context, grid, material[m], &set[m]));
    OK(mpm_particles_fill_box(set[m], lower + 2 * m, upper + 2 * m, per_cell, NULL, NULL));
    OK(mpm_particles_add_field(set[m], "tag", MPM_F64, 1));
    OK(mpm_particles_set_all(set[m], "tag", MPM_F64, 1, &tag));
  }
  const int64_t held_ids[] = {0, 1};
  const uint8_t prescribed[] = {0, 0, 1, 1};
  OK(mpm_particles_set(set[1], "prescribed", MPM_U8, 2, 2, held_ids, prescribed));

  mpm_stepper_desc *how = MAKE(mpm_stepper_desc);
  mpm_stepper *stepper;
  OK(mpm_stepper_desc_init(how, sizeof *how));
  how->gravity[1] = -9.81;
  how->transfer = MPM_APIC;
  APPEND(mpm_stepper_desc, how);
  OK(mpm_stepper_create(context, grid, how, &stepper));
  for (int m = 0; m < 2; ++m) OK(mpm_stepper_add(stepper, set[m]));
  OK(mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  OK(mpm_stepper_set_force(stepper, host_force, &last_t));
  OK(mpm_stepper_set_motion(stepper, set[1], host_motion, NULL));
  OK(mpm_stepper_set_velocity_bc(stepper, host_velocity, NULL));
  OK(mpm_stepper_set_node_hook(stepper, MPM_AFTER_FORCES, host_hook, NULL));
  OK(mpm_stepper_set_progress(stepper, host_progress, &progress));

  mpm_step_info *info = MAKE(mpm_step_info);
#ifdef MPM_CONTACT_H /* not in 0.1.0; the rule says what holds without it */
  mpm_contact_desc *contact = MAKE(mpm_contact_desc);
  OK(mpm_contact_desc_init(contact, sizeof *contact));
  APPEND(mpm_contact_desc, contact);
  OK(mpm_stepper_set_contact(stepper, 0, 1, contact));
#endif
#ifdef MPM_OBSTACLE_H
  mpm_obstacle_desc *far = MAKE(mpm_obstacle_desc);
  mpm_obstacle *obstacle;
  int64_t asked = 0;
  OK(mpm_obstacle_desc_init(far, sizeof *far));
  far->shape = MPM_SHAPE_DISTANCE;
  far->distance = host_distance;
  far->user = &asked;
  far->contact = contact;
  APPEND(mpm_obstacle_desc, far);
  OK(mpm_obstacle_create(context, far, &obstacle));
  OK(mpm_stepper_add_obstacle(stepper, obstacle));
#endif
#ifdef MPM_SURFACE_H
  mpm_surface_desc *idle = MAKE(mpm_surface_desc);
  mpm_surface *surface;
  const double inside[3] = {0.5, 0.5, 0.5};
  int64_t markers = 0;
  OK(mpm_surface_desc_init(idle, sizeof *idle));
  APPEND(mpm_surface_desc, idle);
  OK(mpm_surface_create(context, grid, idle, &surface));
  OK(mpm_surface_set_traction(surface, host_traction, &markers));
  OK(mpm_surface_add(surface, 1, inside, NULL, NULL));
  OK(mpm_stepper_add_surface(stepper, surface));
#endif
#ifdef MPM_ADAPTION_H
  mpm_adaption_desc *patient = MAKE(mpm_adaption_desc);
  OK(mpm_adaption_desc_init(patient, sizeof *patient));
  patient->every = 1;
  patient->split_edge = 100.0; /* nothing is that long */
  APPEND(mpm_adaption_desc, patient);
  OK(mpm_stepper_set_adaption(stepper, set[0], patient));
#endif
#ifdef MPM_PARALLEL_H
  mpm_balance_desc *even = MAKE(mpm_balance_desc);
  OK(mpm_balance_desc_init(even, sizeof *even));
  even->limit = 2.0; /* there is one part */
  APPEND(mpm_balance_desc, even);
  OK(mpm_stepper_set_balance(stepper, even));
#endif
#ifdef MPM_HEAT_H
  mpm_heat_desc *warm = MAKE(mpm_heat_desc);
  OK(mpm_heat_desc_init(warm, sizeof *warm));
  warm->specific_heat = 1.0; /* nothing is conducted, and the state keeps its fields */
  APPEND(mpm_heat_desc, warm);
  OK(mpm_stepper_set_heat(stepper, set[0], warm));
#endif
  mpm_advance_desc *until = MAKE(mpm_advance_desc);
  double dt;
  uint64_t hash;
  for (int k = 0; k < 5; ++k) {
    OK(mpm_stable_dt(stepper, &dt));
    OK(mpm_step(stepper, 0.4 * dt, info));
    show_info(info);
  }
  OK(mpm_advance_desc_init(until, sizeof *until));
  until->t_end = info->t + 0.004;
  APPEND(mpm_advance_desc, until);
  OK(mpm_advance(stepper, until, info));
  show_info(info);
  OK(mpm_step_begin(stepper, 0.5 * dt));
  OK(mpm_step_grid(stepper));
  OK(mpm_step_end(stepper, info));
  show_info(info);
  mpm_view *view = MAKE(mpm_view);
  OK(mpm_particles_map(set[1], "velocity", MPM_READ, view));
  show_view("velocity", view);
  OK(mpm_grid_map(stepper, 0, "reaction", MPM_READ, view));
  show_view("reaction", view);

#ifdef MPM_ADAPTION_H
  mpm_adaption_info *adapted = MAKE(mpm_adaption_info);
  OK(mpm_stepper_adaption_info(stepper, set[0], adapted));
  if (adapted->splits || adapted->merges) return 1;
#endif
#ifdef MPM_HEAT_H
  mpm_heat_info *heated = MAKE(mpm_heat_info);
  OK(mpm_stepper_heat_info(stepper, heated));
  if (heated->gained < 0.0 || heated->gained > 0.0) return 1;
#endif
#ifdef MPM_SURFACE_H
  if (!markers) return 1;
  OK(mpm_stepper_remove_surface(stepper, surface));
  OK(mpm_surface_destroy(surface));
#endif
#ifdef MPM_OBSTACLE_H
  mpm_contact_info *touch = MAKE(mpm_contact_info);
  OK(mpm_obstacle_contact_info(obstacle, MPM_BODY_ANY, touch));
  if (touch->touching || !asked) return 1;
  OK(mpm_stepper_remove_obstacle(stepper, obstacle));
  OK(mpm_obstacle_destroy(obstacle));
#endif
  how->scheme = MPM_NEWMARK;
  how->transfer = MPM_FLIP;
  how->linear_solver = MPM_SOLVER_HOST;
  mpm_operator_info *system = MAKE(mpm_operator_info);
  OK(mpm_stepper_set_node_hook(stepper, MPM_AFTER_FORCES, NULL, NULL));
  OK(mpm_stepper_set_linear_solver(stepper, host_solve, system));
  OK(mpm_stepper_configure(stepper, how));
  OK(mpm_step(stepper, 0.5 * dt, info));
  show_info(info);
  printf("system: block %d symmetric %d definite %d rows %lld nonzeros %lld\n", system->block,
         system->symmetric, system->positive_definite, (long long)system->rows, (long long)system->nonzeros);

  mpm_profile *profile = MAKE(mpm_profile);
  OK(mpm_stepper_profile(stepper, 1, profile));
  if (!(profile->total > 0.0 && profile->weights >= 0.0)) return 1;
  OK(mpm_stepper_info(stepper, info));
  show_info(info);
  OK(mpm_state_hash(stepper, &hash));
  printf("hash %016llx progress %lld last %a runs %d logged %d\n", (unsigned long long)hash,
         (long long)progress, last_t, runs > 0, logged > 0);

  OK(mpm_stepper_destroy(stepper));
  for (int m = 0; m < 2; ++m) OK(mpm_particles_destroy(set[m]));
  for (int m = 0; m < 2; ++m) OK(mpm_material_destroy(material[m]));
  OK(mpm_grid_destroy(grid));
  OK(mpm_context_destroy(context));
  printf("held %lld released %lld\n", (long long)held, (long long)released);
  check_guards();
  return 0;
}
