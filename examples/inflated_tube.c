/* A thick rubber tube is inflated: one quarter of its section in plane strain, the rest by symmetry planes,
 * in quasi-static steps under a pressure that follows the inner face.
 *
 *   inflated_tube [directory]
 *
 * prints pressure and radius of the inner face beside the exact curve of incompressible rubber (Green &
 * Zerna, Theoretical Elasticity, 1954: p / mu = ln(a / b) + (a^2 - b^2) / (2 a^2 b^2), with the stretches a
 * and b of the inner and the outer face), and writes into the directory (default: here) a picture,
 * inflated_tube.svg. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "body.h"

enum { STEPS = 20, CORNERS = 48 };
static const double inner = 1.0, outer = 2.0, h = 0.1, E = 1e6, nu = 0.49;
/* There is no equilibrium beyond mu ln(outer / inner) = 233 kPa: the wall becomes thin too fast. */
static const double most = 200e3;

static mpm_status in_ring(void *user, int32_t dim, int64_t n, int64_t ld, const double *x, uint8_t *inside) {
  (void)user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) {
    const double r = hypot(x[i], x[ld + i]);
    inside[i] = r >= inner && r <= outer;
  }
  return MPM_OK;
}

/* The inner face, clockwise around the hole's quarter: the material is on the left. */
static mpm_status add_face(mpm_surface *face) {
  double at[2 * (CORNERS + 1)];
  for (int k = 0; k <= CORNERS; ++k) {
    const double angle = acos(0.0) * (1.0 - (double)k / CORNERS);
    at[k] = inner * cos(angle);
    at[CORNERS + 1 + k] = inner * sin(angle);
  }
  return mpm_surface_add_polyline(face, CORNERS + 1, at, 0, 0.5 * h, NULL, NULL);
}

/* The mean radius of the markers. */
static mpm_status radius_of(const mpm_surface *face, double *radius) {
  const int64_t n = mpm_surface_count(face);
  double *x = malloc(2 * (size_t)n * sizeof *x), sum = 0.0;
  if (!x) return MPM_E_NOMEM;
  const mpm_status status = mpm_surface_get(face, "position", MPM_F64, 2, n, NULL, x);
  for (int64_t i = 0; !status && i < n; ++i) sum += hypot(x[i], x[n + i]);
  free(x);
  *radius = sum / (double)n;
  return status;
}

/* The pressure at which incompressible rubber has this stretch of the inner face. */
static double exact_pressure(double a) {
  const double ratio = inner / outer, b = sqrt(1.0 + ratio * ratio * (a * a - 1.0));
  return E / (2.0 * (1.0 + nu)) * (log(a / b) + (a * a - b * b) / (2.0 * a * a * b * b));
}

/* Domains of the particles, coloured by the largest stretch. */
static void draw_section(FILE *out, int panel, const body *tube, double pressure) {
  const svg_frame f = {20.0 + 300.0 * panel, 40.0, 280.0, 280.0, 0.0, 3.0, 0.0, 3.0};
  double *value = malloc(5 * (size_t)tube->n * sizeof *value);
  if (!value) return;
  double *a = value + tube->n, *b = a + 2 * tube->n;
  for (int64_t i = 0; i < tube->n; ++i) {
    double F[2][2], C = 0.0;
    for (int c = 0; c < 2; ++c)
      for (int k = 0; k < 2; ++k) F[c][k] = tube->F[(3 * c + k) * tube->n + i];
    for (int c = 0; c < 4; ++c) C += F[c / 2][c % 2] * F[c / 2][c % 2];
    const double J = F[0][0] * F[1][1] - F[0][1] * F[1][0];
    value[i] = sqrt(0.5 * (C + sqrt(fmax(C * C - 4.0 * J * J, 0.0)))) - 1.0;
    for (int c = 0; c < 2; ++c) {
      a[c * tube->n + i] = 0.25 * h * F[c][0];
      b[c * tube->n + i] = 0.25 * h * F[c][1];
    }
  }
  char text[64];
  snprintf(text, sizeof text, "<tspan font-weight=\"bold\">%.0f kPa</tspan>", 1e-3 * pressure);
  svg_text(out, f.left + 0.5 * f.width, f.top - 10.0, "middle", "", text);
  svg_panel(out, &f);
  svg_clip(out, &f);
  svg_tiles(out, &f, tube->n, tube->x, a, b, value, 1.3);
  svg_end_clip(out);
  free(value);
}

int main(int argc, char **argv) {
  char path[1024];
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *set;
  mpm_stepper *stepper;
  mpm_surface *face;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_surface_desc load;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&g, sizeof g) ||
      mpm_stepper_desc_init(&s, sizeof s) || mpm_surface_desc_init(&load, sizeof load))
    goto failed;
  g.dim = 2;
  g.cells[0] = g.cells[1] = 32;
  g.spacing[0] = g.spacing[1] = h;
  s.scheme = MPM_NEWMARK;
  s.transfer = MPM_FLIP;
  s.quasi_static = 1;
  s.locking_remedy = 1;
  load.max_spacing = 0.5 * h;

  const mpm_param law[] = {{"E", E}, {"nu", nu}, {"density", 1e3}};
  const double lower[] = {0.0, 0.0}, upper[] = {outer, outer};
  const int32_t per_cell[] = {2, 2};
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", law, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &set) ||
      mpm_particles_fill(set, lower, upper, per_cell, in_ring, NULL, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_stepper_add(stepper, set) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_surface_create(ctx, grid, &load, &face) || add_face(face) || mpm_stepper_add_surface(stepper, face))
    goto failed;
  body tube;
  if (body_open(&tube, set)) return 1;
  printf("A tube of %.0f and %.0f m, %lld particles and %lld markers in a quarter\n\n", inner, outer,
         (long long)tube.n, (long long)mpm_surface_count(face));
  printf(" p/kPa   radius/m   p of the exact curve/kPa   deviation\n");
  snprintf(path, sizeof path, "%s/inflated_tube.svg", argc > 1 ? argv[1] : ".");
  FILE *out = svg_open(path, 920, 710);
  double stretch[STEPS + 1], pressure[STEPS + 1], exact[STEPS + 1], worst = 0.0, start;
  if (radius_of(face, &start)) goto failed;
  stretch[0] = 1.0;
  pressure[0] = exact[0] = 0.0;
  mpm_step_info now = {.struct_size = sizeof now};
  for (int k = 1; k <= STEPS; ++k) {
    load.pressure = most * k / STEPS;
    double radius;
    if (mpm_surface_configure(face, &load) || mpm_step(stepper, 1.0, &now) || radius_of(face, &radius) ||
        body_read(&tube))
      goto failed;
    stretch[k] = radius / start;
    pressure[k] = 1e-3 * load.pressure;
    exact[k] = 1e-3 * exact_pressure(stretch[k]);
    worst = fmax(worst, fabs(pressure[k] / exact[k] - 1.0));
    if (k % 4 == 0)
      printf("%6.0f %10.4f %26.1f %10.1f %%\n", pressure[k], radius, exact[k],
             100.0 * (pressure[k] / exact[k] - 1.0));
    if (k == 8 || k == 16 || k == 20) draw_section(out, k / 8 - (k < 20), &tube, load.pressure);
  }
  svg_colour_bar(out, 300.0, 352.0, 320.0, 1.3, "largest stretch - 1");
  const svg_frame curve = {80.0, 430.0, 780.0, 220.0, 1.0, ceil(10.0 * stretch[STEPS]) / 10.0, 0.0, 220.0};
  svg_axes(out, &curve, "radius of the inner face over that at the start", "pressure / kPa");
  svg_curve(out, &curve, STEPS + 1, stretch, exact, "#8c959f");
  svg_curve(out, &curve, STEPS + 1, stretch, pressure, "#0969da");
  const char *const label[2] = {"fill=\"#8c959f\"", "fill=\"#0969da\""};
  svg_text(out, curve.left + 20.0, curve.top + 26.0, "start", label[0], "exact, incompressible");
  svg_text(out, curve.left + 20.0, curve.top + 46.0, "start", label[1], "particles");
  if (svg_close(out)) {
    fprintf(stderr, "inflated_tube: cannot write %s\n", path);
    return 1;
  }
  body_close(&tube);
  if (mpm_stepper_destroy(stepper) || mpm_surface_destroy(face) || mpm_particles_destroy(set) ||
      mpm_material_destroy(rubber) || mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten: %s\nresult: stretch %.3f, pressure within %.1f %% of the exact curve\n", path,
         stretch[STEPS], 100.0 * worst);
  return 0;

failed:
  fprintf(stderr, "inflated_tube: %s\n", mpm_last_error(ctx));
  return 1;
}
