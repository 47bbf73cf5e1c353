/* Wherever a callback of one part refuses, every part returns with that, nothing is lost, and the call goes
 * through when it is made again. */
#include "reference.h"
#include "shared.h"

static const double E = 1e5, nu = 0.3;

/* What the callbacks of a part count; number refuse_at refuses. */
typedef struct counter {
  reference_law law;
  int64_t calls, refuse_at;
} counter;

/* Counts calls of the callbacks of each part, one of which is to refuse. */
typedef struct refusing {
  scene is;
  planned fault;
  int64_t calls[FAULTY];
  int32_t failed[FAULTY];
} refusing;

static mpm_status count(counter *of) {
  return ++of->calls == of->refuse_at ? -7 : MPM_OK;
}

static mpm_status stress(void *user, const mpm_material_batch *batch) {
  counter *of = user;
  const mpm_status status = count(of);
  return status ? status : reference_law_stress(&of->law, batch);
}

/* That of small strains. */
static mpm_status tangent(void *user, const mpm_material_batch *batch, double *c, int32_t *symmetric) {
  const double mu = E / (2.0 + 2.0 * nu), lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  for (int32_t k = 0; k < 36; ++k) {
    const int32_t row = k / 6, column = k % 6, normal = row < 3 && column < 3;
    const double value = (normal ? lambda : 0.0) + (row == column ? (row < 3 ? 2.0 * mu : mu) : 0.0);
    for (int64_t i = 0; i < batch->n; ++i) c[k * batch->ld + i] = value;
  }
  *symmetric = 1;
  return count(user);
}

static mpm_status push(void *user, const mpm_particle_batch *batch, double *force) {
  for (int64_t p = 0; p < batch->n; ++p) force[p] += 0.5 * batch->mass[p];
  return count(user);
}

static mpm_status lift(void *user, const mpm_particle_batch *batch, double *acceleration) {
  for (int64_t p = 0; p < batch->n; ++p) acceleration[batch->ld + p] += 0.25;
  return count(user);
}

static mpm_status lead(void *user, const mpm_particle_batch *batch, double *velocity) {
  for (int64_t p = 0; p < batch->n; ++p) velocity[p] += 0.1;
  return count(user);
}

static mpm_status hold(void *user, const mpm_node_batch *batch, uint8_t *held, double *velocity) {
  (void)velocity;
  for (int64_t i = 0; i < batch->n; ++i) held[i] = batch->position[i] > 0.65;
  return count(user);
}

static mpm_status hook(void *user, const mpm_node_batch *batch, double *velocity, double *force) {
  (void)batch, (void)velocity, (void)force;
  return count(user);
}

static mpm_status watch(void *user, const mpm_step_info *info) {
  (void)info;
  return count(user);
}

static mpm_status drive(void *user, double t, double dt, double *velocity, double *spin) {
  (void)t, (void)dt, (void)spin;
  velocity[1] = -0.5;
  return count(user);
}

/* A plate above the body. */
static mpm_status distance(void *user, const mpm_distance_batch *batch) {
  for (int64_t i = 0; i < batch->n; ++i) {
    batch->distance[i] = -batch->position[batch->ld + i];
    batch->normal[i] = 0.0;
    batch->normal[batch->ld + i] = -1.0;
  }
  return count(user);
}

static mpm_status add_plate(world *w, counter *of, mpm_obstacle **out) {
  mpm_obstacle_desc d;
  mpm_status status = mpm_obstacle_desc_init(&d, sizeof d);
  d.shape = MPM_SHAPE_DISTANCE;
  d.motion = MPM_MOTION_PRESCRIBED;
  d.distance = distance;
  d.user = of;
  d.position[0] = 0.45;
  d.position[1] = 0.71;
  if (!status) status = mpm_obstacle_create(w->context, &d, out);
  if (!status) status = mpm_stepper_add_obstacle(w->stepper, *out);
  return status ? status : mpm_obstacle_set_motion(*out, drive, of);
}

static mpm_status equip(world *w, counter *of, mpm_obstacle **plate) {
  const int32_t implicit = w->desc.stepper.scheme == MPM_NEWMARK;
  mpm_status status = mpm_stepper_set_force(w->stepper, push, of);
  if (!status) status = mpm_stepper_set_acceleration(w->stepper, lift, of);
  if (!status) status = mpm_stepper_set_velocity_bc(w->stepper, hold, of);
  if (!status) status = mpm_stepper_set_motion(w->stepper, w->set[0], lead, of);
  if (!status) status = mpm_stepper_set_progress(w->stepper, watch, of);
  for (int32_t stage = MPM_AFTER_P2G; stage <= MPM_AFTER_VELOCITY && !status && !implicit; ++stage)
    status = mpm_stepper_set_node_hook(w->stepper, stage, hook, of);
  return status ? status : add_plate(w, of, plate);
}

static void live_refusing(int32_t part, const mpm_transport *transport, void *user) {
  refusing *all = user;
  outcome *found = &all->is.found[part];
  const planned *fault = &all->fault;
  counter mine = {.law = {E, nu, 20.0}};
  mpm_obstacle *plate = NULL;
  double dt = 0.0;
  world w;
  memset(&w, 0, sizeof w);
  w.desc = all->is.desc;
  w.desc.law = (world_law){.density = 1e3, .stress = stress, .user = &mine};
  if (w.desc.stepper.scheme == MPM_NEWMARK) w.desc.law.tangent = tangent;
  w.desc.context.transport = transport;
  mpm_status status = world_try_open(&w);
  if (!status) status = equip(&w, &mine, &plate);
  if (!status) status = fill_middle(&w, w.set[0], 0.2, 0.7);
  if (!status) status = lead_some(w.set[0], 2);
  mine.refuse_at = part == fault->part && fault->at ? mine.calls + fault->at : 0;
  const int64_t before = mine.calls;
  if (!status) AGAIN(all, part, status, MPM_E_CALLBACK, mpm_stable_dt(w.stepper, &dt));
  for (int32_t i = 0; i < 3 && !status; ++i)
    AGAIN(all, part, status, MPM_E_CALLBACK, mpm_step(w.stepper, 0.3 * dt, NULL));
  all->calls[part] = mine.calls - before;
  if (!status) status = mpm_state_hash(w.stepper, &found->hash);
  found->status = status;
  if (status) snprintf(found->text, sizeof found->text, "%s", mpm_last_error(w.context));
  if (plate) take_obstacle(&w, plate, MPM_OK);
  world_try_close(&w);
}

START_TEST(callbacks_refuse) {
  static refusing r;
  parts_plan plan;
  int64_t calls[FAULTY];
  uint64_t hash = 0;
  planned f = {0};
  const int32_t implicit = _i;
  do {
    memset(&r, 0, sizeof r);
    memset(&plan, 0, sizeof plan);
    r.is = scene_of(2, 2 * WIDE, NULL);
    r.is.desc.stepper.scheme = implicit ? MPM_NEWMARK : MPM_MUSL;
    if (implicit) r.is.desc.stepper.linear_solver = MPM_SOLVER_CG;
    r.fault = f;
    ck_assert_msg(!parts_run(FAULTY, live_refusing, &r, &plan), "call %lld: %s", (long long)f.at, plan.text);
    if (!f.at) {
      memcpy(calls, r.calls, sizeof calls);
      hash = r.is.found[0].hash;
    }
    for (int32_t p = 0; p < FAULTY; ++p) {
      ck_assert_msg(!r.is.found[p].status && r.failed[p] == (f.at != 0),
                    "call %lld of part %d, part %d: %s (%s), %d calls failed", (long long)f.at, (int)f.part,
                    p, mpm_status_name(r.is.found[p].status), r.is.found[p].text, r.failed[p]);
      ck_assert_msg(r.is.found[p].hash == hash, "call %lld of part %d, part %d: another state",
                    (long long)f.at, (int)f.part, p);
    }
  } while (next_fault(&f, implicit ? 4 : 12, calls));
  ck_assert_int_gt(calls[1], 30);
  tell_faults(&f, "callbacks");
}
END_TEST

void add_shared_callbacks(Suite *suite) {
  TCase *faults = faults_case(suite, "faults of callbacks", 0);
  tcase_add_loop_test(faults, callbacks_refuse, 0, 2);
}
