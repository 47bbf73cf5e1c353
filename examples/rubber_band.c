/* A rubber band lies under pins and is pushed out between them by discs, to almost three times its length:
 * once as it is, so that it comes apart when its particles are farther from each other than the basis
 * reaches, and once with particles that are split where it is drawn out. One stretch from disc to pin, the
 * rest by symmetry planes; explicit steps.
 *
 *   rubber_band [directory]
 *
 * prints the force on a disc beside that of a band that does not resist bending, and how many particles there
 * are, and writes into the directory (default: here) a picture of both, rubber_band.svg. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "body.h"

enum { SHOTS = 3, LOOKS = 12 };
/* In metres: from disc to pin, the band, the radius of discs and pins, cells, the way of the discs; and their
 * speed in m/s. */
static const double length = 1.0, thick = 0.2, bottom = 0.44, radius = 0.2, h = 0.04, way = 2.75, speed = 3.0;
static const double E = 1e6, nu = 0.4, density = 1e3;

typedef struct outcome {
  double bears, stretch, force,
      off; /* the way to which the disc is borne; at the end: the stretch, the force of half
                                        the band, and how far it is from that of a thin band */
  int64_t particles;
} outcome;

/* A band that does not resist bending, under the same tension from disc to pin: returns the force of half of
 * it on a disc that has gone so far. */
static double thin_band(double gone, double *stretch) {
  const double mu = E / (2.0 + 2.0 * nu), lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
  double across = 1.0, angle = 0.0; /* F22; of the band between disc and pin, with the level */
  for (int k = 0; k < 30; ++k) {
    const double reach = 2.0 * radius + across * thick; /* from centre to centre where they face each other */
    const double rise = gone - 2.0 * radius - thick, apart = hypot(length, rise);
    angle = atan2(rise, length) + asin(reach / apart);
    *stretch = (sqrt(apart * apart - reach * reach) + reach * angle) / length;
    double low = 0.0, high = 1.0; /* no stress across: lambda ln J + mu (F22^2 - 1) = 0 */
    for (int i = 0; i < 60; ++i) {
      across = 0.5 * (low + high);
      if (lambda * log(*stretch * across) + mu * (across * across - 1.0) > 0.0)
        high = across;
      else
        low = across;
    }
  }
  return thick * mu * (*stretch * *stretch - across * across) / *stretch * sin(angle);
}

/* The larger stretch of the plane. */
static double stretch_of(const body *b, int64_t i) {
  double F[4], C = 0.0;
  for (int c = 0; c < 4; ++c) F[c] = b->F[(3 * (c / 2) + c % 2) * b->n + i], C += F[c] * F[c];
  const double J = F[0] * F[3] - F[1] * F[2];
  return sqrt(0.5 * (C + sqrt(fmax(C * C - 4.0 * J * J, 0.0))));
}

/* Domains of the particles and of their mirror images, coloured by the stretch, and the disc. size[2][n]:
 * edges of the domains before they were deformed; NULL where none was split. */
static int draw(FILE *out, const svg_frame *f, const body *b, const double *size, double disc) {
  double *value = malloc(7 * (size_t)b->n * sizeof *value);
  if (!value) return -1;
  double *a = value + b->n, *e = a + 2 * b->n, *x = e + 2 * b->n;
  svg_disc(out, f, 0.0, disc, radius);
  for (int side = -1; side <= 1; side += 2) svg_disc(out, f, side * length, bottom + thick + radius, radius);
  for (int side = -1; side <= 1; side += 2) {
    for (int64_t i = 0; i < b->n; ++i) {
      value[i] = stretch_of(b, i) - 1.0;
      for (int c = 0; c < 2; ++c) {
        const double sign = c == 0 ? side : 1.0;
        x[c * b->n + i] = sign * b->x[c * b->n + i];
        a[c * b->n + i] = 0.5 * sign * (size ? size[i] : 0.5 * h) * b->F[3 * c * b->n + i];
        e[c * b->n + i] = 0.5 * sign * (size ? size[b->n + i] : 0.5 * h) * b->F[(3 * c + 1) * b->n + i];
      }
    }
    svg_tiles(out, f, b->n, x, a, e, value, 3.0);
  }
  free(value);
  return 0;
}

typedef struct scene {
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *set;
  mpm_stepper *stepper;
  mpm_obstacle *disc, *pin;
} scene;

static mpm_status open_scene(mpm_context *ctx, const mpm_grid_desc *g, int split, scene *s) {
  mpm_status status;
  mpm_stepper_desc how;
  mpm_obstacle_desc disc, pin;
  mpm_adaption_desc adapt;
  if ((status = mpm_stepper_desc_init(&how, sizeof how)) ||
      (status = mpm_obstacle_desc_init(&disc, sizeof disc)) ||
      (status = mpm_adaption_desc_init(&adapt, sizeof adapt)))
    return status;
  how.transfer = MPM_APIC_MLS;
  disc.shape = MPM_SHAPE_SPHERE; /* in 2-D a disc */
  disc.motion = MPM_MOTION_PRESCRIBED;
  disc.size[0] = radius;
  disc.position[1] = bottom - radius;
  disc.velocity[1] = speed;
  pin = disc;
  pin.motion = MPM_MOTION_FIXED;
  pin.position[0] = length;
  pin.position[1] = bottom + thick + radius;
  pin.velocity[1] = 0.0;
  adapt.split_edge = 0.52; /* two particles per cell and axis have edges of 0.5 */

  const mpm_param law[] = {{"E", E}, {"nu", nu}, {"density", density}};
  const double lower[] = {0.0, bottom}, upper[] = {length, bottom + thick};
  const int32_t per_cell[] = {2, 2};
  if ((status = mpm_grid_create(ctx, g, &s->grid)) ||
      (status = mpm_material_create(ctx, "neo_hookean", law, 3, &s->rubber)) ||
      (status = mpm_particles_create(ctx, s->grid, s->rubber, &s->set)) ||
      (status = mpm_particles_fill_box(s->set, lower, upper, per_cell, NULL, NULL)) ||
      (status = mpm_stepper_create(ctx, s->grid, &how, &s->stepper)) ||
      (status = mpm_stepper_add(s->stepper, s->set)) ||
      (status = mpm_stepper_set_wall(s->stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0)) ||
      (status = mpm_stepper_set_wall(s->stepper, MPM_X_MAX, MPM_WALL_SLIP, 0.0)) ||
      (status = mpm_stepper_set_wall(s->stepper, MPM_Y_MAX, MPM_WALL_OPEN, 0.0)) ||
      (status = mpm_stepper_set_wall(s->stepper, MPM_Y_MIN, MPM_WALL_OPEN, 0.0)) ||
      (status = mpm_obstacle_create(ctx, &disc, &s->disc)) ||
      (status = mpm_stepper_add_obstacle(s->stepper, s->disc)) ||
      (status = mpm_obstacle_create(ctx, &pin, &s->pin)) ||
      (status = mpm_stepper_add_obstacle(s->stepper, s->pin)))
    return status;
  return split ? mpm_stepper_set_adaption(s->stepper, s->set, &adapt) : MPM_OK;
}

static mpm_status close_scene(scene *s) {
  mpm_status status;
  if ((status = mpm_stepper_remove_obstacle(s->stepper, s->disc)) ||
      (status = mpm_obstacle_destroy(s->disc)) ||
      (status = mpm_stepper_remove_obstacle(s->stepper, s->pin)) || (status = mpm_obstacle_destroy(s->pin)) ||
      (status = mpm_stepper_destroy(s->stepper)) || (status = mpm_particles_destroy(s->set)) ||
      (status = mpm_material_destroy(s->rubber)))
    return status;
  return mpm_grid_destroy(s->grid);
}

/* Reads the band, which may have more particles than before, and draws it. */
static mpm_status look(const scene *s, int split, FILE *out, const svg_frame *f) {
  body b;
  if (body_open(&b, s->set)) {
    body_close(&b);
    return MPM_E_NOMEM;
  }
  double *size = malloc(2 * (size_t)b.n * sizeof *size), disc[3];
  mpm_status status = size ? body_read(&b) : MPM_E_NOMEM;
  if (!status && split) status = mpm_particles_get(s->set, "size", MPM_F64, 2, b.n, NULL, size);
  if (!status) status = mpm_obstacle_get_pose(s->disc, disc, NULL, NULL, NULL);
  if (!status && draw(out, f, &b, split ? size : NULL, disc[1])) status = MPM_E_NOMEM;
  free(size);
  body_close(&b);
  return status;
}

/* Pushes the band out, and draws a row of the picture. */
static mpm_status push(mpm_context *ctx, int split, FILE *out, outcome *now) {
  scene s;
  mpm_grid_desc g;
  mpm_status status = mpm_grid_desc_init(&g, sizeof g);
  if (status) return status;
  g.dim = 2;
  g.cells[0] = (int64_t)lround(length / h);
  g.cells[1] = (int64_t)lround((bottom + way + 3.0 * thick) / h);
  g.spacing[0] = g.spacing[1] = h;
  if ((status = open_scene(ctx, &g, split, &s))) return status;
  printf("%s\n way/m   stretch   force/kN per m   a thin band   particles\n",
         split ? "Particles are split" : "Particles are left as they are");
  double impulse = 0.0, most = 0.0;
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_contact_info on = {.struct_size = sizeof on};
  mpm_advance_desc go;
  if ((status = mpm_advance_desc_init(&go, sizeof go))) return status;
  for (int k = 0; k <= LOOKS && !status; ++k) {
    const double gone = way * k / LOOKS;
    const int shot = k * (SHOTS - 1) / LOOKS, drawn = k * (SHOTS - 1) % LOOKS == 0;
    const svg_frame f = {20.0 + 310.0 * shot, 44.0 + 580.0 * split, 290.0, 530.0, -1.0, 1.0, 0.0, 3.65};
    go.t_end = gone / speed;
    if (k > 0) status = mpm_advance(s.stepper, &go, &info);
    if (!status && k > 0) status = mpm_obstacle_contact_info(s.disc, MPM_BODY_ANY, &on);
    if (status) break;
    now->force = (on.impulse[1] - impulse) * speed * LOOKS / way;
    impulse = on.impulse[1];
    now->particles = mpm_particles_count(s.set);
    most = fmax(most, now->force);
    const int torn = now->force < 0.5 * most;
    if (!torn) now->bears = gone;
    const double thin = k > 0 ? thin_band(gone - 0.5 * way / LOOKS, &now->stretch) : 0.0;
    now->off = k > 0 ? now->force / thin - 1.0 : 0.0;
    if (k > 0 && k % (LOOKS / 6) == 0)
      printf("%6.2f %9.2f %16.1f %13.1f %11lld\n", gone, now->stretch, 2e-3 * now->force, 2e-3 * thin,
             (long long)now->particles);
    if (!drawn) continue;
    char text[96];
    snprintf(text, sizeof text, "<tspan font-weight=\"bold\">%s, %.1f m</tspan>",
             split ? "split" : "as they are", gone);
    svg_text(out, f.left, f.top - 10.0, "start", "", text);
    svg_panel(out, &f);
    svg_clip(out, &f);
    status = look(&s, split, out, &f);
    svg_end_clip(out);
    if (torn) break; /* it flies off */
  }
  printf("\n");
  return status ? status : close_scene(&s);
}

int main(int argc, char **argv) {
  char path[1024];
  mpm_context *ctx = NULL;
  outcome torn = {0}, whole = {0};
  if (mpm_context_create(NULL, &ctx)) goto failed;
  snprintf(path, sizeof path, "%s/rubber_band.svg", argc > 1 ? argv[1] : ".");
  printf("A rubber band, %.2f m thick, from disc to pin %.0f m\n\n", thick, length);
  FILE *out = svg_open(path, 950, 1250);
  if (push(ctx, 0, out, &torn) || push(ctx, 1, out, &whole)) {
    svg_close(out);
    goto failed;
  }
  svg_colour_bar(out, 315.0, 1210.0, 320.0, 3.0, "largest stretch - 1");
  if (svg_close(out)) {
    fprintf(stderr, "rubber_band: cannot write %s\n", path);
    return 1;
  }
  if (mpm_context_destroy(ctx)) goto failed;
  printf(
      "written: %s\n"
      "result: split, drawn to %.2f with %.1f kN per m, %+.1f %% of a thin band's, by %lld particles; left, "
      "it comes apart after %.2f m\n",
      path, whole.stretch, 2e-3 * whole.force, 100.0 * whole.off, (long long)whole.particles, torn.bears);
  return 0;

failed:
  fprintf(stderr, "rubber_band: %s\n", mpm_last_error(ctx));
  return 1;
}
