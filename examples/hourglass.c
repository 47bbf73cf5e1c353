/* Sand runs through the neck of an hourglass: two boxes, fixed obstacles with friction, make its funnel. In
 * plane strain.
 *
 *   hourglass [directory [cells in the neck]]
 *
 * Prints the share of the sand that has passed the neck against time. Other than with water the rate hardly
 * depends on how much is still above: the last line compares that from 20 to 50 % with that from 50 to
 * 80 %, and gives the former over density sqrt(g) D^(3/2), with D the width of the neck. Writes a film strip
 * (hourglass.svg) into the directory (default: here), coloured by where the sand was at first.
 *
 * What to expect: 8 cells in the neck, the default, take half a minute, 4 take seconds. The coefficient is
 * 0.43, 0.85, 0.95 and 1.09 with 4, 8, 10 and 16 cells, as if the neck were two cells narrower: next to an
 * obstacle sand moves with what the nodes there may do. */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "film.h"

static const double width = 0.2, neck = 0.04, chamber = 0.2; /* chamber: height of the neck */
static const double fill = 0.36, top = 0.42, thick = 0.01;   /* thick: half of that of the boxes */
static const double density = 2000.0, E = 2e5, nu = 0.3, phi = 30.0, friction = 0.4, g = 9.81, t_most = 6.0;
enum { SAMPLES = 240, LAYERS = 6 };

/* Height of the funnel at x: 45 degrees. */
static double funnel(double x) {
  return chamber + fmax(0.0, fabs(x - 0.5 * width) - 0.5 * neck);
}

static mpm_status above(void *user, int32_t dim, int64_t n, int64_t ld, const double *x, uint8_t *inside) {
  const double *gap = user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) inside[i] = x[ld + i] > funnel(x[i]) + *gap;
  return MPM_OK;
}

/* Boxes whose upper faces end at the neck. */
static mpm_status add_funnel(mpm_context *ctx, mpm_stepper *stepper, mpm_obstacle *box[2]) {
  const double half = 0.5 * (width - neck) / sqrt(2.0) + thick, across = sqrt(0.5);
  for (int k = 0; k < 2; ++k) {
    const double out = k ? 1.0 : -1.0; /* away from the middle */
    mpm_contact_desc contact;
    mpm_obstacle_desc desc;
    mpm_status status;
    if ((status = mpm_contact_desc_init(&contact, sizeof contact)) ||
        (status = mpm_obstacle_desc_init(&desc, sizeof desc)))
      return status;
    contact.friction = friction;
    desc.contact = &contact;
    desc.shape = MPM_SHAPE_BOX;
    desc.size[0] = half;
    desc.size[1] = thick;
    desc.position[0] = 0.5 * width + out * (0.5 * neck + across * (half + thick));
    desc.position[1] = chamber + across * (half - thick);
    desc.orientation[0] = cos(out * acos(-1.0) / 8.0);
    desc.orientation[3] = sin(out * acos(-1.0) / 8.0);
    if ((status = mpm_obstacle_create(ctx, &desc, &box[k])) ||
        (status = mpm_stepper_add_obstacle(stepper, box[k])))
      return status;
  }
  return MPM_OK;
}

static void draw_funnel(FILE *out, const svg_frame *f, const void *user) {
  const double deep = thick * sqrt(2.0), edge = 0.5 * (width - neck);
  (void)user;
  for (int k = 0; out && k < 2; ++k) {
    const double wall = k ? width : 0.0, side = k ? -1.0 : 1.0;
    fprintf(out, "<path fill=\"#8c959f\" d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fL%.1f %.1fz\"/>\n", svg_x(f, wall),
            svg_y(f, chamber + edge), svg_x(f, wall + side * edge), svg_y(f, chamber),
            svg_x(f, wall + side * (edge - 0.5 * deep)), svg_y(f, chamber - 0.5 * deep), svg_x(f, wall),
            svg_y(f, chamber + edge - deep));
  }
}

/* When a share of the sand had passed, linear between samples. */
static double time_of(double share, int count, const double *t, const double *passed) {
  int k = 1;
  while (k < count - 1 && passed[k] < share) ++k;
  return t[k - 1] + (t[k] - t[k - 1]) * (share - passed[k - 1]) / (passed[k] - passed[k - 1]);
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const int cells = argc > 2 ? atoi(argv[2]) : 8;
  if (cells < 3 || cells > 64) {
    fprintf(stderr, "hourglass: cells in the neck must be 3 to 64\n");
    return 1;
  }
  const double h = neck / cells;
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *sand;
  mpm_stepper *stepper;
  mpm_obstacle *box[2];
  mpm_grid_desc gd;
  mpm_stepper_desc sd;
  mpm_advance_desc go;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&gd, sizeof gd) ||
      mpm_stepper_desc_init(&sd, sizeof sd) || mpm_advance_desc_init(&go, sizeof go))
    goto failed;
  gd.dim = 2;
  gd.spacing[0] = gd.spacing[1] = h;
  gd.cells[0] = 5 * cells;
  gd.cells[1] = (int64_t)ceil(top / h);
  sd.scheme = MPM_MUSL;
  sd.transfer = MPM_APIC;
  sd.gravity[1] = -g;

  const mpm_param params[] = {
      {"E", E}, {"nu", nu}, {"density", density}, {"phi", phi}, {"cone", 2.0}}; /* 2: plane strain */
  const double lower[] = {0.0, chamber}, upper[] = {width, fill};
  const int32_t per_cell[] = {2, 2};
  double gap = 0.5 * h;
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "drucker_prager", params, 5, &material) ||
      mpm_particles_create(ctx, grid, material, &sand) ||
      mpm_particles_fill(sand, lower, upper, per_cell, above, &gap, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &sd, &stepper) || mpm_stepper_add(stepper, sand) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_FRICTION, friction) ||
      mpm_stepper_set_wall(stepper, MPM_X_MAX, MPM_WALL_FRICTION, friction) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0) || add_funnel(ctx, stepper, box))
    goto failed;

  const int64_t n = mpm_particles_count(sand);
  film strip = film_of(n, 0.5 * h);
  double *x = malloc(3 * (size_t)n * sizeof *x), *layer = x + 2 * n;
  static double t[SAMPLES + 1], passed[SAMPLES + 1];
  static const double shown[] = {0.01, 0.2, 0.5, 0.8, 0.95};
  int shots = 0, bad = 0, count = 0;
  if (!x) {
    fprintf(stderr, "hourglass: out of memory\n");
    return 1;
  }
  if (mpm_particles_get(sand, "position", MPM_F64, 2, n, NULL, x)) goto failed;
  for (int64_t i = 0; i < n; ++i) layer[i] = floor(LAYERS * (x[n + i] - chamber) / (fill - chamber)) + 0.5;
  printf("%" PRId64 " particles of sand, %d cells in the neck\n\n  t/s   passed\n", n, cells);
  mpm_step_info now = {.struct_size = sizeof now};
  go.cfl = 0.4;
  for (int k = 0; k <= SAMPLES && (k == 0 || passed[k - 1] < 0.97) && !bad; ++k) {
    go.t_end = t_most * k / SAMPLES;
    if (k > 0 && mpm_advance(stepper, &go, &now)) goto failed;
    if (mpm_particles_get(sand, "position", MPM_F64, 2, n, NULL, x)) goto failed;
    t[k] = now.t;
    passed[k] = 0.0;
    for (int64_t i = 0; i < n; ++i) passed[k] += x[n + i] < chamber ? 1.0 / (double)n : 0.0;
    count = k + 1;
    if (k % 10 == 0) printf("%5.2f %8.3f\n", t[k], passed[k]);
    fprintf(stderr, "\rt = %.2f s, step %" PRId64 ", %.0f %% have passed ", now.t, now.step,
            100.0 * passed[k]);
    if (shots < 5 && passed[k] >= shown[shots]) {
      const int at = film_frame(&strip, now.t);
      bad = at < 0;
      for (int64_t i = 0; !bad && i < n; ++i) {
        strip.x[at][i] = x[i];
        strip.x[at][n + i] = x[n + i];
        strip.value[at][i] = layer[i];
      }
      ++shots;
    }
  }
  fprintf(stderr, "\n");
  const film_view view = {.x_max = width,
                          .y_max = top,
                          .columns = 5,
                          .panel = 172.0,
                          .value_max = LAYERS,
                          .scenery = draw_funnel};
  char path[1024];
  snprintf(path, sizeof path, "%s/hourglass.svg", directory);
  if (bad || film_draw(&strip, &view, path)) {
    fprintf(stderr, "hourglass: cannot write into %s\n", directory);
    return 1;
  }
  double mass = (double)n * density * 0.25 * h * h, rate[2];
  for (int k = 0; k < 2; ++k)
    rate[k] =
        0.3 * mass / (time_of(0.5 + 0.3 * k, count, t, passed) - time_of(0.2 + 0.3 * k, count, t, passed));
  film_close(&strip);
  free(x);
  for (int k = 0; k < 2; ++k)
    if (mpm_stepper_remove_obstacle(stepper, box[k]) || mpm_obstacle_destroy(box[k])) goto failed;
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(sand) || mpm_material_destroy(material) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten to %s: hourglass.svg\n", directory);
  printf("result: passed %.3f at t = %.2f s; rate %.2f kg/m/s, later %.3f of it; coefficient %.3f\n",
         passed[count - 1], t[count - 1], rate[0], rate[1] / rate[0],
         rate[0] / (density * sqrt(g) * pow(neck, 1.5)));
  return 0;

failed:
  fprintf(stderr, "\nhourglass: %s\n", mpm_last_error(ctx));
  return 1;
}
