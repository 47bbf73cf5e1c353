/* What a step costs with a UMAT in Fortran beside the same law built in: 3-D, quadratic splines, FLIP, one
 * thread.
 *
 *   speed [most]
 *
 * prints processor time by particle and step, and fails where the ratio is beyond `most`. */
#include <mpm/mpm_umat.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

extern mpm_umat_subroutine umat_j2_;
extern mpm_vumat_subroutine vumat_j2_;

enum { BUILT_IN, UMAT, VUMAT, KINDS, STEPS = 10, ROUNDS = 3 };
static const double E = 70e9, nu = 0.3, density = 2700.0, yield = 300e6, hardening = 1e9;

static mpm_status make(mpm_context *context, int kind, mpm_material **out) {
  const mpm_param params[] = {
      {"E", E}, {"nu", nu}, {"density", density}, {"yield_stress", yield}, {"hardening", hardening}};
  const double props[4] = {E, nu, yield, hardening};
  if (kind == BUILT_IN) return mpm_material_create(context, "j2", params, 5, out);
  mpm_umat_desc d;
  const mpm_status status = mpm_umat_desc_init(&d, sizeof d);
  d.density = density, d.nprops = 4, d.props = props, d.nstatv = 1;
  if (status) return status;
  return kind == UMAT ? mpm_umat_material(context, umat_j2_, &d, out)
                      : mpm_vumat_material(context, vumat_j2_, &d, out);
}

/* Nanoseconds by particle and step, or 0. */
static double measure(mpm_context *context, int kind) {
  mpm_grid_desc g;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
  const double lower[] = {0.4, 0.4, 0.0}, upper[] = {2.0, 2.0, 1.6}, velocity[] = {0.0, 0.0, -200.0};
  const int32_t per_cell[] = {2, 2, 2};
  int64_t n = 0;
  double dt = 0.0;
  mpm_status status = mpm_grid_desc_init(&g, sizeof g);
  g.dim = 3;
  for (int k = 0; k < 3; ++k) g.cells[k] = 24, g.spacing[k] = 0.1;
  if (status || mpm_grid_create(context, &g, &grid) || make(context, kind, &material) ||
      mpm_particles_create(context, grid, material, &set) ||
      mpm_particles_fill_box(set, lower, upper, per_cell, NULL, &n) ||
      mpm_particles_set_all(set, "velocity", MPM_F64, 3, velocity) ||
      mpm_stepper_create(context, grid, NULL, &stepper) || mpm_stepper_add(stepper, set) ||
      mpm_stepper_set_wall(stepper, MPM_Z_MIN, MPM_WALL_SLIP, 0.0) || mpm_stable_dt(stepper, &dt))
    return 0.0;
  for (int k = 0; k < 20 && !status; ++k)
    status = mpm_step(stepper, 0.4 * dt, NULL); /* until some of it yields */
  const clock_t begin = clock();
  for (int k = 0; k < STEPS && !status; ++k) status = mpm_step(stepper, 0.4 * dt, NULL);
  const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
  if (status || mpm_stepper_destroy(stepper) || mpm_particles_destroy(set) ||
      mpm_material_destroy(material) || mpm_grid_destroy(grid))
    return 0.0;
  return 1e9 * seconds / (double)n / STEPS;
}

int main(int count, char **argument) {
  static const char *const name[KINDS] = {"j2, built in", "UMAT", "VUMAT"};
  double least[KINDS] = {0.0};
  mpm_context *context = NULL;
  if (mpm_context_create(NULL, &context)) return 1;
  for (int round = 0; round < ROUNDS; ++round)
    for (int kind = 0; kind < KINDS; ++kind) {
      const double now = measure(context, kind);
      if (now == 0.0) {
        fprintf(stderr, "speed: %s\n", mpm_last_error(context));
        return 1;
      }
      if (round == 0 || now < least[kind]) least[kind] = now;
    }
  for (int kind = 0; kind < KINDS; ++kind)
    printf("speed: %-12s %6.0f ns by particle and step, %.2f of the law built in\n", name[kind], least[kind],
           least[kind] / least[BUILT_IN]);
  mpm_context_destroy(context);
  return count > 1 && least[UMAT] > strtod(argument[1], NULL) * least[BUILT_IN];
}
