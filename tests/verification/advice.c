/* What a step that Newton's method does not bring to an end advises, and whether that helps: each failure is
 * provoked, its sentence must be the one for such a case, and what it says is done. A cantilever under its
 * own weight in quasi-static steps, 3.5 long and 0.5 deep, E = 8e5, nu = 0.3; for short steps a slender one.
 */
#include "loading.h"

#include <string.h>

static const double E = 8e5, nu = 0.3, density = 1000.0, length = 3.5, depth = 0.5;

/* Plane strain, Cauchy stresses linear in the logarithm of J and in b - I. */
static mpm_status stress_of(void *user, const mpm_material_batch *b) {
  (void)user;
  const double mu = E / (2.0 * (1.0 + nu)), lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
  for (int64_t p = 0; p < b->n; ++p) {
    double F[9], J, *const stress = b->stress_new;
    for (int32_t k = 0; k < 9; ++k) F[k] = b->F[k * b->ld + p];
    J = F[0] * F[4] - F[1] * F[3];
    const double xx = F[0] * F[0] + F[1] * F[1], yy = F[3] * F[3] + F[4] * F[4],
                 xy = F[0] * F[3] + F[1] * F[4], all = lambda * log(J);
    stress[p] = (mu * (xx - 1.0) + all) / J;
    stress[b->ld + p] = (mu * (yy - 1.0) + all) / J;
    stress[2 * b->ld + p] = all / J;
    stress[3 * b->ld + p] = mu * xy / J;
    stress[4 * b->ld + p] = stress[5 * b->ld + p] = 0.0;
  }
  return MPM_OK;
}

/* That of small strains in a material that is three times as stiff. */
static mpm_status tangent_of(void *user, const mpm_material_batch *b, double *tangent, int32_t *symmetric) {
  (void)user;
  const double mu = 3.0 * E / (2.0 * (1.0 + nu)), lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
  memset(tangent, 0, (size_t)(36 * b->ld) * sizeof *tangent);
  for (int64_t p = 0; p < b->n; ++p)
    for (int32_t i = 0; i < 6; ++i) {
      for (int32_t j = 0; j < 3 && i < 3; ++j) tangent[(6 * i + j) * b->ld + p] = lambda;
      tangent[7 * i * b->ld + p] += i < 3 ? 2.0 * mu : mu;
    }
  *symmetric = 1;
  return MPM_OK;
}

enum { ELASTIC, YIELDS, OF_HOST, MISLED }; /* the law; MISLED: that of the host with that tangent */

typedef struct beam {
  verify_world w;
  verify_setup setup;
  load weight;
} beam;

static mpm_material *add_law(verify_world *w, int32_t law) {
  const mpm_param metal[] = {
      {"E", E}, {"nu", nu}, {"density", density}, {"yield_stress", 2e4}, {"hardening", 2e4}};
  if (law == ELASTIC) return verify_elastic(w, "neo_hookean", E, nu, density);
  if (law == YIELDS) return verify_material(w, "j2", metal, 5);
  mpm_material_desc d;
  verify_ok(w, mpm_material_desc_init(&d, sizeof d));
  d.density = density;
  d.stress = stress_of;
  if (law == MISLED) d.tangent = tangent_of;
  mpm_material **out = &w->material[w->materials++];
  verify_ok(w, mpm_material_create_custom(w->context, &d, out));
  return *out;
}

static void describe(beam *b, double h, int64_t columns, int64_t rows) {
  b->setup = verify_defaults(2, 1, h);
  b->setup.grid.cells[0] = columns;
  b->setup.grid.cells[1] = rows;
  b->setup.stepper.scheme = MPM_NEWMARK;
  b->setup.stepper.quasi_static = 1;
}

/* Fills a beam, which is held at the left and weighs g. */
static void hang(beam *b, mpm_material *law, const double *lower, const double *upper, double g) {
  verify_fill_box(&b->w, verify_set(&b->w, law), lower, upper, 2);
  verify_ok(&b->w, mpm_stepper_set_wall(b->w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  b->weight = (load){g, 1.0};
  verify_ok(&b->w, mpm_stepper_set_acceleration(b->w.stepper, loading_weigh, &b->weight));
}

static void open_beam(beam *b, double g, int32_t law) {
  const double h = depth / 4.0, lower[] = {0.0, 40.0 * h}, upper[] = {length, 44.0 * h};
  describe(b, h, 34, 48);
  verify_open(&b->w, &b->setup);
  hang(b, add_law(&b->w, law), lower, upper, g);
}

static void change(beam *b, int32_t iterations) {
  b->setup.stepper.newton_max_iterations = iterations;
  verify_ok(&b->w, mpm_stepper_configure(b->w.stepper, &b->setup.stepper));
}

static const char *const source = "the sentence, and what comes of it";

/* A step that fails with these words. */
static void fails(beam *b, const char *name, double dt, mpm_status wanted, const char *words) {
  mpm_step_info info = {.struct_size = sizeof info};
  const mpm_status status = mpm_step(b->w.stepper, dt, &info);
  const int32_t said = status && strstr(mpm_last_error(b->w.context), words);
  verify_progress("%s: %s", name, mpm_last_error(b->w.context));
  verify_gate_of(name, "status", status, wanted, wanted, source);
  verify_gate_of(name, "the sentence has the advice", said, 1.0, 1.0, source);
}

static void passes(beam *b, const char *name, double dt) {
  mpm_step_info info = {.struct_size = sizeof info};
  verify_gate_of(name, "status once it is followed", mpm_step(b->w.stepper, dt, &info), MPM_OK, MPM_OK,
                 source);
}

/* One iteration less than are needed. */
static void end_early(void) {
  const char *name = "an iteration that ends early";
  beam b;
  open_beam(&b, 0.9, ELASTIC);
  const int32_t needed = (int32_t)verify_step(&b.w, 0.1).newton_iterations;
  verify_close(&b.w);
  open_beam(&b, 0.9, ELASTIC);
  change(&b, needed - 1);
  fails(&b, name, 0.1, MPM_NOT_CONVERGED, "raise newton_max_iterations");
  change(&b, needed);
  passes(&b, name, 0.1);
  verify_close(&b.w);
}

/* A law of the host with the tangent of another one; without it the library differences the law. */
static void mislead(void) {
  const char *name = "a tangent callback that is not the derivative";
  for (int32_t tangent = 1; tangent >= 0; --tangent) {
    beam b;
    open_beam(&b, 0.9, tangent ? MISLED : OF_HOST);
    if (tangent)
      fails(&b, name, 0.1, MPM_NOT_CONVERGED, "not the derivative of the stress");
    else
      passes(&b, name, 0.1);
    verify_close(&b.w);
  }
}

/* More load than a step can take at once: the iteration wanders, or finds a balance far away. */
static void overload(const char *name, double g, int32_t law, mpm_status wanted, const char *words) {
  beam b;
  open_beam(&b, g, law);
  fails(&b, name, 1.0, wanted, words);
  mpm_advance_desc go;
  verify_ok(&b.w, mpm_advance_desc_init(&go, sizeof go));
  go.dt_first = go.dt_max = go.t_end = 1.0;
  mpm_step_info info = {.struct_size = sizeof info};
  verify_gate_of(name, "status of mpm_advance", mpm_advance(b.w.stepper, &go, &info), MPM_OK, MPM_OK, source);
  verify_gate_of(name, "time that it comes to", info.t, 1.0, 1.0, source);
  verify_close(&b.w);
}

/* A beam that nothing holds. */
static void let_go(void) {
  const char *name = "a body that nothing holds";
  for (int32_t cure = 0; cure < 2; ++cure) {
    beam b;
    open_beam(&b, 0.01, ELASTIC);
    verify_ok(&b.w, mpm_stepper_set_wall(b.w.stepper, MPM_X_MIN, MPM_WALL_NONE, 0.0));
    fails(&b, name, 0.1, MPM_SINGULAR, "hold the body in every direction");
    if (cure)
      verify_ok(&b.w, mpm_stepper_set_wall(b.w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
    else
      b.setup.stepper.quasi_static = 0;
    change(&b, 20);
    passes(&b, cure ? "the same, held" : "the same with quasi_static = 0", 0.1);
    verify_close(&b.w);
  }
}

static void choose(beam *b, int32_t linear_solver, int32_t iterations) {
  b->setup.stepper.linear_solver = linear_solver;
  b->setup.stepper.linear_max_iterations = iterations;
  verify_ok(&b->w, mpm_stepper_configure(b->w.stepper, &b->setup.stepper));
}

/* Iterations of the linear solver that end early, and a dynamic step so long that its matrix is none for
 * conjugate gradients. */
static void solve_badly(void) {
  const char *name = "a linear solver that ends early";
  beam b;
  open_beam(&b, 0.9, ELASTIC);
  choose(&b, MPM_SOLVER_CG, 5);
  fails(&b, name, 0.1, MPM_NOT_CONVERGED, "take MPM_SOLVER_AUTO");
  choose(&b, MPM_SOLVER_AUTO, 5);
  passes(&b, name, 0.1);
  verify_close(&b.w);
  name = "a dynamic step that is too long for conjugate gradients";
  open_beam(&b, 100.0, ELASTIC);
  b.setup.stepper.quasi_static = 0;
  b.setup.stepper.newmark_gamma = 1.0;
  b.setup.stepper.newmark_beta = 0.5625;
  choose(&b, MPM_SOLVER_CG, 0);
  fails(&b, name, 1.0, MPM_SINGULAR, "not positive definite: use MPM_SOLVER_LDLT or MPM_SOLVER_AUTO");
  passes(&b, "the same, shorter", 0.05);
  verify_close(&b.w);
}

/* A slender beam of eight linear cells with two particles in each, that is let down by short steps: it sinks
 * further by each, and stops before the load is there. On a total Lagrangian grid it does not. */
static void sink(void) {
  const char *name = "short steps of the linear basis";
  const int32_t steps = 640;
  for (int32_t lagrangian = 0; lagrangian < 2; ++lagrangian) {
    const double h = 0.25 / 8.0, lower[] = {0.0, 52.0 * h}, upper[] = {2.4, 60.0 * h};
    beam b;
    describe(&b, h, 83, 70);
    b.setup.grid.basis = MPM_LINEAR;
    b.setup.grid.total_lagrangian = lagrangian;
    verify_open(&b.w, &b.setup);
    hang(&b, verify_elastic(&b.w, "neo_hookean", 1.5e6, 0.25, density), lower, upper, 2.2);
    mpm_step_info info = {.struct_size = sizeof info};
    int32_t done = 0;
    mpm_status status = MPM_OK;
    while (done < steps && !(status = mpm_step(b.w.stepper, 1.0 / steps, &info))) ++done;
    if (lagrangian) {
      verify_gate_of(name, "load that a total Lagrangian grid comes to", (double)done / steps, 1.0, 1.0,
                     source);
    } else {
      const int32_t said =
          status && strstr(mpm_last_error(b.w.context), "total_lagrangian = 1 or a smooth basis");
      verify_progress("%s: %s", name, mpm_last_error(b.w.context));
      verify_gate_of(name, "status", status, MPM_NOT_CONVERGED, MPM_NOT_CONVERGED, source);
      verify_gate_of(name, "the sentence has the advice", said, 1.0, 1.0, source);
    }
    verify_close(&b.w);
  }
}

int main(int argc, char **argv) {
  verify_begin("advice", argc, argv);
  end_early();
  mislead();
  overload("a step that is too long", 2.0, YIELDS, MPM_NOT_CONVERGED, "use a smaller dt, or mpm_advance");
  overload("a step that finds a balance far away", 300.0, ELASTIC, MPM_OFF_GRID, "would leave the grid");
  let_go();
  solve_badly();
  if (!verify_quick()) sink();
  return verify_end();
}
