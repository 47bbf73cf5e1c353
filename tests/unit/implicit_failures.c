/* What may go wrong in an implicit step: each has its status and sentence, leaves the state as it was, and
 * the next step is possible. */
#include "implicit.h"
#include "tables.h"

typedef struct block {
  world w;
  world_desc desc;
  mpm_particles *set;
  double dt;
} block;

/* A block on a fixed floor under gravity, one step old. */
static void open_block(block *b, int32_t quasi_static) {
  b->desc = implicit_default(2, 8, 0.1, implicit_basis(1));
  b->desc.stepper.quasi_static = quasi_static;
  b->desc.stepper.gravity[1] = -20.0;
  b->dt = 0.02;
  b->set = world_open(&b->w, &b->desc);
  implicit_block(&b->w, b->set, 0.0, 0.4, NULL);
  ck_ok(&b->w, mpm_stepper_set_wall(b->w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  ck_ok(&b->w, mpm_stepper_set_wall(b->w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  world_step(&b->w, b->dt);
}

static void configure(block *b) {
  ck_ok(&b->w, mpm_stepper_configure(b->w.stepper, &b->desc.stepper));
}

/* The step fails so, and changes nothing. */
static mpm_step_info fails(block *b, mpm_status wanted, const char *text) {
  mpm_step_info info = {.struct_size = sizeof info};
  const uint64_t before = world_hash(&b->w);
  ck_refused(&b->w, mpm_step(b->w.stepper, b->dt, &info), wanted, text);
  ck_assert_int_eq(info.cause, wanted);
  ck_assert(world_hash(&b->w) == before);
  return info;
}

/* The particle that is named is within a cell and a half of the node. */
static void beside(const block *b, const mpm_step_info *info) {
  ck_assert_int_eq(info->set, 0);
  const int64_t along = 11, node[2] = {info->node / along - 1, info->node % along - 1}; /* from -1 to 9 */
  for (int32_t c = 0; c < 2; ++c)
    ck_within("particle beside the node", fetch1(&b->w, b->set, "position", 2, c, info->particle),
              0.1 * (double)node[c], 0.15);
}

/* Counts what is logged of unstable equilibria. */
static void hear_unstable(void *user, int32_t level, const char *text) {
  if (level == MPM_LOG_WARNING && strstr(text, "is not stable")) ++*(int32_t *)user;
}

static mpm_status press_top(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  for (int64_t i = 0; i < b->n; ++i) {
    if (b->position[b->ld + i] < 3.99) continue;
    prescribed[i] = prescribed[b->ld + i] = 1;
    velocity[i] = 0.0, velocity[b->ld + i] = *(const double *)user;
  }
  return MPM_OK;
}

/* Ends the step after each number of iterations that is too small, and returns how often it says so. */
static int32_t says_of_touches(block *b, const char *text) {
  int32_t said = 0, more = 1;
  for (int32_t n = 1; more && n < 20; ++n) {
    const saved_state before = world_save(&b->w);
    b->desc.stepper.newton_max_iterations = n;
    configure(b);
    more = mpm_step(b->w.stepper, b->dt, NULL) != MPM_OK;
    said += more && strstr(mpm_last_error(b->w.context), text) != NULL;
    show("%d: %s\n", (int)n, more ? mpm_last_error(b->w.context) : "done");
    world_load(&b->w, &before);
    free(before.data);
  }
  return said;
}

/* Touches of a block that slides over a floor with friction close and slip anew while Newton's method is
 * under way. */
START_TEST(touches_that_change) {
  block b;
  b.desc = implicit_default(2, 16, 0.1, implicit_basis(2));
  b.desc.stepper.gravity[0] = 12.0, b.desc.stepper.gravity[1] = -20.0;
  b.dt = 0.02;
  b.set = world_open(&b.w, &b.desc);
  world_fill(&b.w, b.set, (const double[]){0.4, 0.0}, (const double[]){0.8, 0.4}, 2);
  ck_ok(&b.w, mpm_stepper_set_wall(b.w.stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.5));
  ck_assert_int_gt(says_of_touches(&b, "bodies go on to part and touch again: use mpm_advance"), 0);
  mpm_advance_desc go = advance_desc(b.dt);
  go.dt_first = b.dt;
  for (int32_t n = 3; n > 0;
       --n) { /* mpm_advance() gets through, and where it does not, does not advise itself */
    const saved_state before = world_save(&b.w);
    b.desc.stepper.newton_max_iterations = n;
    configure(&b);
    go.max_cuts = n > 1 ? 10 : 1;
    const mpm_status status = mpm_advance(b.w.stepper, &go, NULL);
    if (n > 1)
      ck_ok(&b.w, status);
    else
      ck_refused(&b.w, status, MPM_NOT_CONVERGED, "bodies go on to part and touch again: use less friction");
    world_load(&b.w, &before);
    free(before.data);
  }
  world_close(&b.w);
}
END_TEST

/* A straight column beyond Euler's load is in balance, but would buckle. The host is told once, and anew
 * after it has been relieved. */
START_TEST(column_that_would_buckle) {
  /* 4 pi^2 E' I / L^2 = 3.5 with E' = 1000 / .91; a step of .02 adds E' A .02 / L = 1.4 */
  enum { BEYOND_EULER = 3 };
  const double lower[] = {0.875, 0.0}, upper[] = {1.125, 4.0};
  double speed = -0.02;
  int32_t told = 0;
  world w;
  world_desc desc = implicit_default(2, 16, 0.125, implicit_basis(2));
  desc.grid.cells[1] = 36;
  desc.grid.total_lagrangian = 1;
  desc.stepper.quasi_static = 1;
  desc.stepper.linear_solver = MPM_SOLVER_LDLT;
  desc.law.E = 1000.0, desc.law.density = 1.0;
  desc.context.log = hear_unstable, desc.context.log_user = &told;
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, press_top, &speed));
  for (int32_t k = 1; k <= 6; ++k) {
    world_step(&w, 1.0);
    ck_assert_int_eq(told, k >= BEYOND_EULER);
  }
  speed = 0.1;
  world_step(&w, 1.0);
  speed = -0.1;
  world_step(&w, 1.0);
  ck_assert_int_eq(told, 2);
  world_close(&w);
}
END_TEST

/* Nothing holds it: singular, and the node is named. With inertia it falls. */
START_TEST(free_body) {
  block b;
  open_block(&b, 1);
  for (int32_t face = MPM_X_MIN; face <= MPM_Y_MIN; face += 2)
    ck_ok(&b.w, mpm_stepper_set_wall(b.w.stepper, face, MPM_WALL_NONE, 0.0));
  const mpm_step_info info = fails(&b, MPM_SINGULAR, "hold the body in every direction");
  ck_assert_int_ge(info.node, 0);
  beside(&b, &info);
  ck_assert_double_eq(info.dt_suggested, 0.6 * b.dt);
  b.desc.stepper.quasi_static = 0;
  b.desc.stepper.gravity[1] = 5.0;
  configure(&b);
  world_step(&b.w, 1e-3);
  world_close(&b.w);
}
END_TEST

/* Of many unknowns: what rounding leaves of its motions is no solution. What it leaves depends on whether
 * coordinates are whole numbers, and on the load. */
START_TEST(large_free_body) {
  const double h = _i / 2 ? 1.0 : 0.1;
  block b = {.desc = implicit_default(3, 20, h, implicit_basis(_i % 2)), .dt = h};
  b.desc.stepper.quasi_static = 1;
  b.desc.law.E = _i / 4 ? 1e5 : 1e4;
  b.desc.law.density = _i / 4 ? 1e3 : 1.0;
  b.desc.stepper.gravity[2] = -0.1;
  b.set = world_open(&b.w, &b.desc);
  implicit_block(&b.w, b.set, 2.0 * h, 18.0 * h, NULL);
  for (int32_t choice = MPM_SOLVER_AUTO; choice <= MPM_SOLVER_LDLT; choice += MPM_SOLVER_LDLT) {
    b.desc.stepper.linear_solver = choice;
    configure(&b);
    ck_assert_int_ge(fails(&b, MPM_SINGULAR, "singular").node, 0);
  }
  world_close(&b.w);
}
END_TEST

/* A rigid body in the air: nothing moves it while it weighs nothing, and nothing carries its weight. */
START_TEST(free_rigid_body) {
  block b = {.desc = implicit_default(2, 8, 0.1, implicit_basis(1)), .dt = 0.01};
  b.desc.law = (world_law){.model = "rigid", .density = 1e3};
  b.desc.stepper.quasi_static = 1;
  b.set = world_open(&b.w, &b.desc);
  implicit_block(&b.w, b.set, 0.3, 0.5, NULL);
  ck_ok(&b.w, mpm_particles_set_all(b.set, "prescribed", MPM_U8, 2, (const uint8_t[]){0, 0}));
  world_step(&b.w, b.dt);
  b.desc.stepper.gravity[1] = -5.0;
  configure(&b);
  ck_assert_int_ge(fails(&b, MPM_SINGULAR, "rigid particles").node, 0);
  ck_ok(&b.w, mpm_particles_set_all(b.set, "prescribed", MPM_U8, 2, (const uint8_t[]){0, 1}));
  world_step(&b.w, b.dt);
  world_close(&b.w);
}
END_TEST

START_TEST(too_few_iterations) {
  block b;
  open_block(&b, 0);
  b.desc.stepper.newton_max_iterations = 1;
  configure(&b);
  const mpm_step_info info = fails(&b, MPM_NOT_CONVERGED, "after 1 iterations");
  ck_assert_msg(strstr(last_error_of(&b.w), "smaller dt"), "%s", last_error_of(&b.w));
  beside(&b, &info);
  ck_assert_int_eq(info.newton_iterations, 1);
  ck_assert_double_gt(info.residual, 0.0);
  double r[IMPLICIT_HISTORY];
  ck_assert_int_eq(implicit_history(&b.w, r), 2);
  ck_assert_double_eq(r[1], info.residual);
  b.desc.stepper.newton_max_iterations = 20;
  configure(&b);
  world_step(&b.w, b.dt);
  world_close(&b.w);
}
END_TEST

/* Near its end the iteration is told from one that goes nowhere. */
/* Conjugate gradients that end early, or meet a matrix that is not for them, name the place of the worst
 * balance; MPM_SOLVER_AUTO takes a factor then. */
START_TEST(linear_solver_in_trouble) {
  block b;
  open_block(&b, 0);
  b.desc.stepper.linear_solver = MPM_SOLVER_CG;
  b.desc.stepper.linear_max_iterations = 3;
  configure(&b);
  mpm_step_info info = fails(&b, MPM_NOT_CONVERGED, "after 3 iterations the residual is ");
  ck_assert_ptr_nonnull(strstr(last_error_of(&b.w), "take MPM_SOLVER_AUTO"));
  beside(&b, &info);
  b.desc.stepper.linear_solver = MPM_SOLVER_AUTO;
  configure(&b);
  world_step(&b.w, b.dt);
  b.desc.stepper.linear_solver = MPM_SOLVER_CG;
  b.desc.stepper.linear_max_iterations = 0;
  b.desc.stepper.gravity[1] = -20000.0;
  configure(&b);
  b.dt = 0.2;
  info = fails(&b, MPM_SINGULAR, "the matrix is not positive definite: use MPM_SOLVER_LDLT");
  ck_assert_ptr_nonnull(strstr(last_error_of(&b.w), "of what is out of balance is at node"));
  beside(&b, &info);
  world_close(&b.w);
}
END_TEST

/* On the linear basis shorter quasi-static steps need not help. */
START_TEST(steps_of_the_linear_basis) {
  for (int32_t lagrangian = 0; lagrangian < 2; ++lagrangian) {
    world w;
    world_desc desc = implicit_default(2, 8, 0.1, implicit_basis(0));
    desc.grid.basis = MPM_LINEAR;
    desc.grid.total_lagrangian = lagrangian;
    desc.stepper.quasi_static = 1;
    desc.stepper.gravity[1] = -20.0;
    desc.stepper.newton_max_iterations = 1;
    mpm_particles *set = world_open(&w, &desc);
    implicit_block(&w, set, 0.0, 0.4, NULL);
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
    ck_refused(&w, mpm_step(w.stepper, 0.02, NULL), MPM_NOT_CONVERGED,
               lagrangian ? ": use a smaller dt, or mpm_advance" : "total_lagrangian = 1 or a smooth basis");
    mpm_advance_desc go = advance_desc(0.02);
    go.max_cuts = 1;
    ck_refused(&w, mpm_advance(w.stepper, &go, NULL), MPM_NOT_CONVERGED,
               lagrangian ? ": smaller steps were tried" : "take total_lagrangian = 1, or a smooth basis");
    world_close(&w);
  }
}
END_TEST

START_TEST(one_iteration_less) {
  block b;
  open_block(&b, 1);
  b.desc.stepper.gravity[1] = -120.0;
  configure(&b);
  const saved_state before = world_save(&b.w);
  const mpm_step_info info = world_step(&b.w, b.dt);
  world_load(&b.w, &before);
  free(before.data);
  b.desc.stepper.newton_max_iterations = info.newton_iterations - 1;
  configure(&b);
  fails(&b, MPM_NOT_CONVERGED, "it falls fast: raise newton_max_iterations");
  /* mpm_advance() does not advise to take it, and a load that does not go with dt stays */
  mpm_advance_desc go = advance_desc(2.0 * b.dt);
  go.max_cuts = 1;
  go.dt_first = b.dt;
  b.desc.stepper.newton_max_iterations = 1;
  configure(&b);
  ck_refused(&b.w, mpm_advance(b.w.stepper, &go, NULL), MPM_NOT_CONVERGED, "smaller steps were tried");
  b.desc.stepper.newton_max_iterations = 20;
  configure(&b);
  world_step(&b.w, b.dt);
  world_close(&b.w);
}
END_TEST

/* Nodes in the middle are sent through the floor: no increment keeps the material from turning inside out. */
static mpm_status crush(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    if (b->position[b->ld + i] > 0.25) {
      prescribed[b->ld + i] = 1;
      velocity[b->ld + i] = -0.6 / b->dt;
    }
  return MPM_OK;
}

START_TEST(inverted) {
  block b;
  open_block(&b, 1);
  ck_ok(&b.w, mpm_stepper_set_velocity_bc(b.w.stepper, crush, NULL));
  mpm_step_info info = {.struct_size = sizeof info};
  const uint64_t before = world_hash(&b.w);
  const mpm_status status = mpm_step(b.w.stepper, b.dt, &info);
  ck_assert_msg(status == MPM_INVERTED || status == MPM_NOT_CONVERGED || status == MPM_SINGULAR, "%s",
                mpm_status_name(status));
  ck_assert(world_hash(&b.w) == before);
  ck_ok(&b.w, mpm_stepper_set_velocity_bc(b.w.stepper, NULL, NULL));
  world_step(&b.w, b.dt);
  world_close(&b.w);
}
END_TEST

/* ---- callbacks ---- */
typedef struct trouble {
  mpm_status stress, tangent;
  int32_t nan;
} trouble;

static mpm_status soft(void *user, const mpm_material_batch *b) {
  const trouble *t = user;
  for (int64_t p = 0; p < b->n; ++p) {
    const double *F = b->F + p;
    const double J = F[0] * F[4 * b->ld] - F[b->ld] * F[3 * b->ld];
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + p] = c < 3 ? 1e4 * (J - 1.0) : 0.0;
    b->stress_new[3 * b->ld + p] = 5e3 * (F[b->ld] + F[3 * b->ld]);
    b->stress_new[p] += 5e3 * (F[0] - F[4 * b->ld]);
    b->stress_new[b->ld + p] -= 5e3 * (F[0] - F[4 * b->ld]);
    b->wave_speed[p] = 10.0;
  }
  return b->dt > 0.0 ? t->stress : MPM_OK;
}

static mpm_status bad_tangent(void *user, const mpm_material_batch *b, double *tangent, int32_t *symmetric) {
  const trouble *t = user;
  for (int64_t i = 0; i < 36 * b->ld; ++i) tangent[i] = i / b->ld % 7 ? 0.0 : 1e4;
  if (t->nan) tangent[0] = (double)NAN;
  *symmetric = 1;
  return t->tangent;
}

START_TEST(law_in_trouble) {
  block b;
  open_block(&b, 0);
  trouble t = {MPM_OK, MPM_OK, 0};
  const world_law law = {.density = 1e3, .stress = soft, .tangent = bad_tangent, .user = &t};
  mpm_particles *other = world_add_set(&b.w, &law);
  const double lower[] = {0.5, 0.0}, upper[] = {0.7, 0.2};
  world_fill(&b.w, other, lower, upper, 2);
  t.stress = 7;
  ck_assert_int_eq(fails(&b, MPM_CUT_DT, "material callback returned 7").callback_status, 7);
  t.stress = -3;
  ck_assert_int_eq(fails(&b, MPM_E_CALLBACK, "material callback returned -3").callback_status, -3);
  t.stress = MPM_OK;
  t.tangent = 4;
  ck_assert_int_eq(fails(&b, MPM_CUT_DT, "tangent callback returned 4").set, 1);
  t.tangent = -1;
  fails(&b, MPM_E_CALLBACK, "tangent callback returned -1");
  t.tangent = MPM_OK;
  t.nan = 1;
  ck_assert_int_eq(fails(&b, MPM_NONFINITE, "tangent is not finite").set, 1);
  t.nan = 0;
  b.desc.stepper.newton_max_iterations = 10; /* that tangent is only about right */
  configure(&b);
  b.dt = 0.03;
  ck_assert_int_eq(fails(&b, MPM_NOT_CONVERGED, "as with a tangent callback that is not the derivative").set,
                   1);
  b.desc.stepper.newton_max_iterations = 200;
  configure(&b);
  world_step(&b.w, b.dt);
  world_close(&b.w);
}
END_TEST

static mpm_status say(void *user, const mpm_particle_batch *b, double *add) {
  (void)b, (void)add;
  return *(const mpm_status *)user;
}

START_TEST(force_in_trouble) {
  block b;
  open_block(&b, 0);
  mpm_status says = 2;
  ck_ok(&b.w, mpm_stepper_set_acceleration(b.w.stepper, say, &says));
  fails(&b, MPM_CUT_DT, "acceleration callback returned 2");
  says = -2;
  fails(&b, MPM_E_CALLBACK, "acceleration callback returned -2");
  says = MPM_OK;
  world_step(&b.w, b.dt);
  world_close(&b.w);
}
END_TEST

/* ---- the host's solver ---- */
typedef struct own_solver {
  mpm_status says;
  int32_t nan, wrong, calls;
} own_solver;

/* Conjugate gradients on the rows that the library lends. */
static mpm_status solve(void *user, const mpm_operator *matrix, const double *rhs, double *x,
                        double tolerance, int64_t *iterations) {
  own_solver *own = user;
  mpm_operator_info info = {.struct_size = sizeof info};
  const int64_t *start;
  const int32_t *column;
  const double *value;
  ck_ok(NULL, mpm_operator_get_info(matrix, &info));
  ck_ok(NULL, mpm_operator_csr(matrix, &start, &column, &value));
  ck_assert_int_eq(info.symmetric, 1);
  ck_assert_int_eq(start[info.rows], info.nonzeros);
  ++own->calls;
  const int64_t n = info.rows;
  double *memory = calloc((size_t)(4 * n), sizeof *memory);
  double *r = memory, *p = r + n, *q = p + n, *diagonal = q + n, gamma = 0.0, norm = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    for (int64_t e = start[i]; e < start[i + 1]; ++e)
      if (column[e] == i) diagonal[i] = value[e];
    x[i] = 0.0;
    r[i] = rhs[i];
    p[i] = r[i] / diagonal[i];
    gamma += r[i] * p[i];
    norm += r[i] * r[i];
  }
  const double enough = 1e-4 * tolerance * tolerance * norm;
  for (*iterations = 0; *iterations < 20000 && norm > enough; ++*iterations) {
    double curvature = 0.0, next = 0.0;
    ck_ok(NULL, mpm_operator_apply(matrix, p, q));
    for (int64_t i = 0; i < n; ++i) curvature += p[i] * q[i];
    norm = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      x[i] += gamma / curvature * p[i];
      r[i] -= gamma / curvature * q[i];
      norm += r[i] * r[i];
      next += r[i] * r[i] / diagonal[i];
    }
    for (int64_t i = 0; i < n; ++i) p[i] = r[i] / diagonal[i] + next / gamma * p[i];
    gamma = next;
  }
  free(memory);
  if (own->nan) x[0] = (double)NAN;
  if (own->wrong) x[0] += 1.0;
  return own->says;
}

START_TEST(host_solver) {
  block b, same;
  open_block(&b, 0);
  open_block(&same, 0);
  b.desc.stepper.linear_solver = MPM_SOLVER_HOST;
  configure(&b);
  fails(&b, MPM_E_STATE, "mpm_stepper_set_linear_solver");
  own_solver own = {MPM_OK, 0, 0, 0};
  ck_ok(&b.w, mpm_stepper_set_linear_solver(b.w.stepper, solve, &own));
  own.says = 3;
  ck_assert_int_eq(fails(&b, MPM_CUT_DT, "returned 3").callback_status, 3);
  own.says = -3;
  fails(&b, MPM_E_CALLBACK, "returned -3");
  own.says = MPM_OK;
  own.nan = 1;
  fails(&b, MPM_NONFINITE, "not finite");
  own.nan = 0;
  own.wrong = 1;
  const mpm_step_info far = fails(&b, MPM_NOT_CONVERGED, "of what is out of balance is at node");
  beside(&b, &far);
  own.wrong = own.calls = 0;
  const mpm_step_info info = world_step(&b.w, b.dt);
  world_step(&same.w, same.dt);
  ck_assert_int_eq(info.linear_solver, MPM_SOLVER_HOST);
  ck_assert_int_eq(own.calls, info.newton_iterations);
  ck_assert_int_gt(info.linear_iterations, 0);
  const int64_t n = mpm_particles_count(b.set);
  double *x = fetch(&b.w, b.set, "position", 2), *y = fetch(&same.w, same.set, "position", 2);
  for (int64_t i = 0; i < 2 * n; ++i) ck_within("position", x[i], y[i], 1e-9);
  free(x), free(y);
  world_close(&b.w);
  world_close(&same.w);
}
END_TEST

/* ---- what is refused ---- */
static mpm_status hook(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)user, (void)b, (void)velocity, (void)force;
  return MPM_OK;
}

static void refuses(block *b, const mpm_stepper_desc *d, mpm_status wanted, const char *text) {
  ck_refused(&b->w, mpm_stepper_configure(b->w.stepper, d), wanted, text);
}

START_TEST(refused) {
  block b;
  open_block(&b, 0);
  mpm_stepper_desc d = b.desc.stepper;
#define REFUSED(member, value, status, text)                                                                 \
  do {                                                                                                       \
    d = b.desc.stepper;                                                                                      \
    d.member = value;                                                                                        \
    refuses(&b, &d, status, text);                                                                           \
  } while (0)
  REFUSED(transfer, MPM_APIC, MPM_E_UNSUPPORTED, "use transfer MPM_FLIP");
  REFUSED(flip, 0.9, MPM_E_UNSUPPORTED, "flip = 1");
  REFUSED(pic_damping, 1.0, MPM_E_UNSUPPORTED, "pic_damping = 0");
  REFUSED(staggered, 1, MPM_E_UNSUPPORTED, "staggered = 0");
  REFUSED(linear_solver, 57, MPM_E_ARG, "linear_solver is 57");
  REFUSED(newmark_beta, 0.0, MPM_E_ARG, "newmark_beta is 0");
  REFUSED(newmark_gamma, -0.5, MPM_E_ARG, "newmark_gamma is -0.5");
  REFUSED(newton_tolerance_residual, (double)NAN, MPM_E_ARG, "newton_tolerance_residual is");
  REFUSED(newton_tolerance_displacement, -1.0, MPM_E_ARG, "newton_tolerance_displacement is -1");
  REFUSED(newton_tolerance_energy, 2.0, MPM_E_ARG, "newton_tolerance_energy is 2");
  REFUSED(newton_residual_floor, -1.0, MPM_E_ARG, "newton_residual_floor is -1");
  REFUSED(linear_tolerance, 1.5, MPM_E_ARG, "linear_tolerance is 1.5");
  REFUSED(newton_max_iterations, 0, MPM_E_ARG, "newton_max_iterations is 0");
  REFUSED(linear_max_iterations, -1, MPM_E_ARG, "linear_max_iterations is -1");
#undef REFUSED
  d = b.desc.stepper;
  d.scheme = MPM_USL;
  d.quasi_static = 1;
  refuses(&b, &d, MPM_E_UNSUPPORTED, "use scheme MPM_NEWMARK");
  ck_assert_int_eq(mpm_step_begin(b.w.stepper, b.dt), MPM_E_UNSUPPORTED);
  ck_assert_int_eq(mpm_stepper_set_node_hook(b.w.stepper, MPM_AFTER_P2G, hook, NULL), MPM_E_UNSUPPORTED);
  ck_assert_int_eq(mpm_stepper_set_wall(b.w.stepper, MPM_X_MAX, MPM_WALL_FRICTION_NODES, 0.3),
                   MPM_E_UNSUPPORTED);
  /* set before, they stand in the way of the scheme */
  d = b.desc.stepper;
  d.scheme = MPM_USL;
  ck_ok(&b.w, mpm_stepper_configure(b.w.stepper, &d));
  ck_ok(&b.w, mpm_stepper_set_node_hook(b.w.stepper, MPM_AFTER_P2G, hook, NULL));
  refuses(&b, &b.desc.stepper, MPM_E_UNSUPPORTED, "no node hooks");
  ck_ok(&b.w, mpm_stepper_set_node_hook(b.w.stepper, MPM_AFTER_P2G, NULL, NULL));
  ck_ok(&b.w, mpm_stepper_set_wall(b.w.stepper, MPM_X_MAX, MPM_WALL_FRICTION_NODES, 0.3));
  refuses(&b, &b.desc.stepper, MPM_E_UNSUPPORTED, "face 1 is one");
  ck_ok(&b.w, mpm_stepper_set_wall(b.w.stepper, MPM_X_MAX, MPM_WALL_NONE, 0.0));
  configure(&b);
  world_step(&b.w, b.dt);
  world_close(&b.w);
}
END_TEST

/* A body that flies out: refused where nothing is said of the face,
 * removed particle by particle where it is open. */
START_TEST(off_the_grid) {
  for (int32_t open = 0; open < 2; ++open) {
    block b;
    const double v[] = {3.0, 0.0};
    b.desc = implicit_default(2, 8, 0.1, implicit_basis(1));
    b.dt = 0.05;
    b.set = world_open(&b.w, &b.desc);
    implicit_block(&b.w, b.set, 0.4, 0.6, v);
    if (open) ck_ok(&b.w, mpm_stepper_set_wall(b.w.stepper, MPM_X_MAX, MPM_WALL_OPEN, 0.0));
    world_step(&b.w, b.dt);
    if (open) {
      const int64_t n = mpm_particles_count(b.set);
      ck_assert_int_eq(world_step(&b.w, b.dt).removed, n / 2);
      ck_assert_int_eq(mpm_particles_count(b.set), n / 2);
      ck_assert_int_eq(world_step(&b.w, 0.2 * b.dt).removed, n / 2 + n / 4);
    } else {
      ck_assert_int_ge(fails(&b, MPM_OFF_GRID, "leave the grid through MPM_X_MAX at particle").particle, 0);
    }
    world_close(&b.w);
  }
}
END_TEST

/* mpm_advance cuts where the iteration fails, grows again, and ends where it should. */
START_TEST(advance) {
  block b;
  open_block(&b, 0);
  b.desc.stepper.newton_max_iterations = 3;
  configure(&b);
  mpm_advance_desc go = advance_desc(0.2);
  mpm_step_info info = {.struct_size = sizeof info};
  ck_ok(&b.w, mpm_advance(b.w.stepper, &go, &info));
  ck_assert_double_eq(info.t, 0.2);
  ck_assert_int_gt(info.step, 3);
  b.desc.stepper.newton_max_iterations = 20;
  configure(&b);
  const int64_t before = info.step;
  go.t_end = 0.4;
  ck_ok(&b.w, mpm_advance(b.w.stepper, &go, &info));
  ck_assert_double_eq(info.t, 0.4);
  ck_assert_int_lt(info.step - before, before);
  world_close(&b.w);
}
END_TEST

/* Kicks the body out of the grid in every step that is longer than a limit. */
typedef struct kick {
  double limit;
  int32_t tries;
} kick;
static mpm_status kick_in_long_steps(void *user, const mpm_particle_batch *batch, double *add) {
  kick *is = user;
  ++is->tries;
  for (int64_t p = 0; p < batch->n; ++p) add[p] += batch->dt > is->limit ? 1e6 : 0.0;
  return 0;
}

/* mpm_advance cuts where a particle leaves the grid in implicit steps, as often as it comes through. */
START_TEST(advance_within_the_grid) {
  block b;
  kick is = {.limit = 0.01};
  b.desc = implicit_default(2, 8, 0.1, implicit_basis(1));
  b.desc.context.concurrency = 1;
  b.dt = 0.02;
  b.set = world_open(&b.w, &b.desc);
  implicit_block(&b.w, b.set, 0.3, 0.5, NULL);
  ck_ok(&b.w, mpm_stepper_set_acceleration(b.w.stepper, kick_in_long_steps, &is));
  fails(&b, MPM_OFF_GRID, "leave the grid through MPM_X_MAX at particle");
  mpm_advance_desc go = advance_desc(0.5);
  mpm_step_info info = {.struct_size = sizeof info};
  ck_ok(&b.w, mpm_advance(b.w.stepper, &go, &info));
  ck_assert_double_eq(info.t, 0.5);
  ck_assert_int_gt(info.step, 50);
  /* the host bounds cuts as for any other cause */
  go.t_end = 1.0;
  go.dt_first = 0.02;
  go.max_cuts = 1;
  ck_refused(&b.w, mpm_advance(b.w.stepper, &go, &info), MPM_OFF_GRID, "gave up after 1 cuts");
  ck_assert_double_eq(info.t, 0.5);
  world_close(&b.w);
}
END_TEST

/* What moves out by itself is cut as well, but not for ever; an explicit step is not. */
START_TEST(advance_out_of_the_grid) {
  for (int32_t explicit = 0; explicit < 2; ++explicit) {
    block b;
    kick is = {.limit = (double)INFINITY};
    const double v[] = {3.0, 0.0};
    b.desc = implicit_default(2, 8, 0.1, implicit_basis(1));
    b.desc.context.concurrency = 1;
    if (explicit) b.desc.stepper.scheme = MPM_MUSL;
    b.set = world_open(&b.w, &b.desc);
    implicit_block(&b.w, b.set, 0.4, 0.6, v);
    ck_ok(&b.w, mpm_stepper_set_acceleration(b.w.stepper, kick_in_long_steps, &is));
    const double before = 0.2 / 3.0; /* when the face is reached, but for half the distance of particles */
    mpm_advance_desc go = advance_desc(0.2);
    mpm_step_info info = {.struct_size = sizeof info};
    ck_refused(&b.w, mpm_advance(b.w.stepper, &go, &info), MPM_OFF_GRID, "leave the grid through MPM_X_MAX");
    ck_assert_int_eq(info.cause, MPM_OFF_GRID);
    ck_assert_int_ge(info.particle, 0);
    ck_assert_int_eq(info.set, 0);
    ck_between("time before the face", info.t, 0.8 * before, before + 0.026 / 3.0);
    const int64_t committed = info.step;
    const int32_t failed = is.tries - (int32_t)committed;
    if (explicit)
      ck_assert_int_eq(failed, 1);
    else
      ck_between("steps that failed", failed, 15, 30);
    world_close(&b.w);
  }
}
END_TEST

TCase *implicit_large_case(TCase *wide) {
  TCase *tests = tcase_create("large");
  tcase_set_tags(tests, "long");
  tcase_set_timeout(tests, 60.0);
  add_table(tests, wide, large_free_body, 6);
  return tests;
}

typedef struct watcher {
  int32_t calls, iterations, stop; /* the host refuses after this iteration */
} watcher;

static mpm_status watch(void *user, const mpm_step_info *info) {
  watcher *w = user;
  ++w->calls;
  if (info->newton_iterations < w->iterations || info->residual < 0.0) return -1;
  w->iterations = info->newton_iterations;
  return info->newton_iterations == w->stop;
}

/* The host sees every iteration and the end, and ends the step at any of them. */
START_TEST(watched) {
  block b;
  watcher w = {0};
  mpm_step_info info = {.struct_size = sizeof info};
  open_block(&b, 1);
  b.desc.stepper.gravity[1] = -200.0;
  configure(&b);
  ck_ok(&b.w, mpm_stepper_set_progress(b.w.stepper, watch, &w));
  for (w.stop = 1; w.stop <= 2; ++w.stop) {
    w.iterations = 0;
    info = fails(&b, MPM_CANCELLED, "the progress callback returned 1");
    ck_assert_int_eq(info.newton_iterations, w.stop);
    ck_assert_int_eq(info.callback_status, 1);
  }
  w = (watcher){0};
  ck_ok(&b.w, mpm_step(b.w.stepper, b.dt, &info));
  ck_assert_int_gt(info.newton_iterations, 2);
  ck_assert_int_eq(w.calls, info.newton_iterations + 1);
  world_close(&b.w);
}
END_TEST

TCase *implicit_failures_case(void) {
  TCase *tests = tcase_create("failures");
  tcase_set_timeout(tests, 60.0);
  tcase_add_test(tests, free_body);
  tcase_add_test(tests, free_rigid_body);
  tcase_add_test(tests, too_few_iterations);
  tcase_add_test(tests, linear_solver_in_trouble);
  tcase_add_test(tests, steps_of_the_linear_basis);
  tcase_add_test(tests, one_iteration_less);
  tcase_add_test(tests, inverted);
  tcase_add_test(tests, law_in_trouble);
  tcase_add_test(tests, force_in_trouble);
  tcase_add_test(tests, host_solver);
  tcase_add_test(tests, refused);
  tcase_add_test(tests, off_the_grid);
  tcase_add_test(tests, watched);
  tcase_add_test(tests, column_that_would_buckle);
  tcase_add_test(tests, touches_that_change);
  tcase_add_test(tests, advance);
  tcase_add_test(tests, advance_within_the_grid);
  tcase_add_test(tests, advance_out_of_the_grid);
  return tests;
}
