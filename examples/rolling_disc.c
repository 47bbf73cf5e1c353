/* An elastic disc rolls down an elastic slope of 30 degrees.
 *
 *   rolling_disc [directory [cells]]
 *
 * Disc and slope are bodies of the same rubber, which meet with friction; the lowest particles of the slope
 * are held. The cells are counted along the disc's radius, 20 by default. Prints the way of the disc beside
 * that of a rigid one, and its turn and spin beside those of one that does not slip, and draws four moments
 * (rolling_disc.svg) into the directory (default: here).
 *
 * What to expect: with 10, 12, 16 and 20 cells the way is 0.969, 0.987, 0.992 and 0.992 of the rigid one's.
 * The particles of the disc are a lattice, so that its rim has steps, which roll less well the larger they
 * are. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "body.h"

#define PI 3.14159265358979323846
enum { SHOTS = 4, SAMPLES = 4 * (SHOTS - 1), SHADES = 8 };
static const double angle = PI / 6.0, radius = 0.4, depth = 0.3;
static const double before = 0.5, beyond = 3.3; /* the slope, from where the disc starts */
static const double density = 1000.0, g = 10.0, friction = 0.5, t_end = 1.3;
static const double pressure_shown = 3e4;

typedef struct slide {
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_stepper *stepper;
  mpm_stepper_desc method;
  double h;
  body disc, slope;
} slide;

/* Components of a vector: down the slope, and away from it. */
static double down(const double v[2]) {
  return v[0] * cos(angle) - v[1] * sin(angle);
}

static double off(const double v[2]) {
  return v[0] * sin(angle) + v[1] * cos(angle);
}

/* A lattice along the slope: its surface has no steps, which one along the cells would have. The two lowest
 * layers are held. */
static mpm_status fill_slope(mpm_particles *set, double h) {
  enum { HELD = 2 };
  const double d = 0.5 * h;
  const int64_t along = (int64_t)((before + beyond) / d + 0.5), deep = (int64_t)(depth / d + 0.5),
                n = along * deep;
  double *x = malloc(3 * (size_t)n * sizeof *x); /* two coordinates, and the volume */
  uint8_t *held = malloc(2 * (size_t)n * sizeof *held);
  mpm_status status = MPM_E_NOMEM;
  for (int64_t i = 0; x && held && i < n; ++i) {
    const double s = ((double)(i / deep) + 0.5) * d - before, z = ((double)(i % deep) + 0.5) * d - depth;
    x[i] = s * cos(angle) + z * sin(angle);
    x[n + i] = z * cos(angle) - s * sin(angle);
    x[2 * n + i] = d * d;
    held[i] = held[n + i] = i % deep < HELD;
  }
  if (x && held) status = mpm_particles_add(set, n, x, NULL, x + 2 * n, NULL, NULL, NULL);
  if (!status) status = mpm_particles_set(set, "prescribed", MPM_U8, 2, n, NULL, held);
  free(x);
  free(held);
  return status;
}

static mpm_status add_body(mpm_context *ctx, slide *w, body *b, int32_t number) {
  mpm_status status;
  if ((status = mpm_particles_create(ctx, w->grid, w->rubber, &b->set)) ||
      (status = mpm_stepper_add(w->stepper, b->set)))
    return status;
  return mpm_stepper_set_body(w->stepper, b->set, number);
}

static mpm_status build(mpm_context *ctx, slide *w) {
  const mpm_param elastic[] = {{"E", 5e5}, {"nu", 0.3}, {"density", density}};
  const double centre[2] = {radius * sin(angle), radius * cos(angle)}, lower[2] = {-0.9, -2.4},
               upper[2] = {3.4, 1.1};
  const int32_t per_cell[2] = {2, 2};
  mpm_grid_desc gd;
  mpm_contact_desc rough;
  mpm_status status;
  if ((status = mpm_grid_desc_init(&gd, sizeof gd)) ||
      (status = mpm_stepper_desc_init(&w->method, sizeof w->method)) ||
      (status = mpm_contact_desc_init(&rough, sizeof rough)))
    return status;
  gd.dim = 2;
  gd.basis = MPM_BSPLINE2;
  for (int c = 0; c < 2; ++c) {
    gd.spacing[c] = w->h;
    gd.origin[c] = lower[c];
    gd.cells[c] = (int32_t)((upper[c] - lower[c]) / w->h + 0.5);
  }
  w->method.scheme = MPM_MUSL;
  w->method.transfer = MPM_APIC; /* less noise in the stress of a body that turns */
  w->method.gravity[1] = -g;
  rough.friction = friction;
  if ((status = mpm_grid_create(ctx, &gd, &w->grid)) ||
      (status = mpm_material_create(ctx, "neo_hookean", elastic, 3, &w->rubber)) ||
      (status = mpm_stepper_create(ctx, w->grid, &w->method, &w->stepper)) ||
      (status = add_body(ctx, w, &w->slope, 0)) || (status = add_body(ctx, w, &w->disc, 1)) ||
      (status = mpm_stepper_set_contact(w->stepper, 0, 1, &rough)) ||
      (status = fill_slope(w->slope.set, w->h)))
    return status;
  return mpm_particles_fill_ball(w->disc.set, centre, radius, per_cell, NULL, NULL);
}

/* Brings the disc to rest under the part of its weight that presses it on the slope, by kinetic damping:
 * where the kinetic energy has a peak, forces are near balance, and all velocities are set to 0. */
static mpm_status settle(slide *w) {
  enum { PEAKS = 2 };
  const double rest[2] = {0.0, 0.0};
  mpm_stepper_desc pressed = w->method; /* without matrices, which would keep a motion of their own */
  mpm_step_info now = {.struct_size = sizeof now};
  mpm_advance_desc go;
  mpm_status status = mpm_advance_desc_init(&go, sizeof go);
  go.t_end = t_end;
  go.max_steps = 1;
  pressed.transfer = MPM_FLIP;
  pressed.gravity[0] = -g * cos(angle) * sin(angle);
  pressed.gravity[1] = -g * cos(angle) * cos(angle);
  if (!status) status = mpm_stepper_configure(w->stepper, &pressed);
  for (int peak = 0; peak < PEAKS && !status; ++peak) {
    double before_step = -1.0;
    now.kinetic_energy = 0.0;
    while (!status && now.kinetic_energy > before_step) {
      before_step = now.kinetic_energy;
      status = mpm_advance(w->stepper, &go, &now);
    }
    if (!status) status = mpm_particles_set_all(w->disc.set, "velocity", MPM_F64, 2, rest);
    if (!status) status = mpm_particles_set_all(w->slope.set, "velocity", MPM_F64, 2, rest);
  }
  if (!status) status = mpm_stepper_configure(w->stepper, &w->method);
  return status ? status : mpm_stepper_set_time(w->stepper, 0.0, 0);
}

static mpm_status take_down(slide *w) {
  mpm_status status = mpm_stepper_destroy(w->stepper);
  if (status || (status = mpm_particles_destroy(w->disc.set)) ||
      (status = mpm_particles_destroy(w->slope.set)) || (status = mpm_material_destroy(w->rubber)))
    return status;
  body_close(&w->disc);
  body_close(&w->slope);
  return mpm_grid_destroy(w->grid);
}

/* Angle, to the right, by which the disc has turned from x0 to x about its centre, up to whole turns. */
static double turned(const body *disc, const double *x0) {
  const int64_t n = disc->n;
  const double *x = disc->x;
  double c0[2], c[2], sine = 0.0, cosine = 0.0;
  body_mean(disc, x0, c0);
  body_mean(disc, x, c);
  for (int64_t i = 0; i < n; ++i) {
    const double u = x0[i] - c0[0], v = x0[n + i] - c0[1], p = x[i] - c[0], q = x[n + i] - c[1];
    sine += v * p - u * q;
    cosine += u * p + v * q;
  }
  return atan2(sine, cosine);
}

/* Quarters of the disc, as it stood at the start, have two colours by turns. */
static void colour_disc(body *disc) {
  double centre[2];
  body_mean(disc, disc->x, centre);
  for (int64_t i = 0; i < disc->n; ++i)
    disc->colour[i] = (disc->x[i] > centre[0]) != (disc->x[disc->n + i] > centre[1]);
}

/* A particle of the slope keeps the shade of the highest pressure of the moments that are drawn. */
static void colour_slope(body *slope) {
  for (int64_t i = 0; i < slope->n; ++i) {
    const double *s = slope->stress + i, pressure = -(s[0] + s[slope->n] + s[2 * slope->n]) / 3.0;
    const int shade = (int)(SHADES * fmin(fmax(0.0, pressure) / pressure_shown, 0.999));
    if (shade > slope->colour[i]) slope->colour[i] = shade;
  }
}

static void draw_disc(FILE *out, const svg_frame *f, slide *w, double t) {
  static int blue[2][3] = {{31, 111, 235}, {164, 206, 255}};
  double centre[2];
  char text[64];
  body_draw(out, f, &w->disc, 0.5 * w->h, 2, blue);
  body_mean(&w->disc, w->disc.x, centre);
  snprintf(text, sizeof text, "t = %.2f s", t);
  svg_text(out, svg_x(f, centre[0]) + 0.8 * radius * f->width / (f->x_max - f->x_min) + 8.0,
           svg_y(f, centre[1] + 0.8 * radius), "start", "font-weight=\"bold\"", text);
}

static void draw_slope(FILE *out, const svg_frame *f, slide *w) {
  int grey[SHADES][3];
  for (int k = 0; k < SHADES; ++k)
    for (int c = 0; c < 3; ++c) grey[k][c] = 205 - (c ? 155 : 20) * k / (SHADES - 1);
  body_draw(out, f, &w->slope, 0.5 * w->h, SHADES, grey);
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  const int cells = argc > 2 ? atoi(argv[2]) : 20;
  const double share = g * sin(angle), a = share / 1.5; /* a third goes into the spin */
  mpm_context *ctx = NULL;
  slide w = {.h = radius / (cells > 0 ? cells : 1)};
  mpm_step_info now = {.struct_size = sizeof now};
  mpm_contact_info touch = {.struct_size = sizeof touch};
  mpm_advance_desc go;
  if (cells < 4) {
    fprintf(stderr, "rolling_disc: the radius has at least 4 cells\n");
    return 1;
  }
  if (mpm_context_create(NULL, &ctx) || build(ctx, &w) || mpm_advance_desc_init(&go, sizeof go)) goto failed;
  double *x0 = malloc(2 * (size_t)mpm_particles_count(w.disc.set) * sizeof *x0);
  if (!x0 || body_open(&w.disc, w.disc.set) || body_open(&w.slope, w.slope.set)) {
    fprintf(stderr, "rolling_disc: out of memory\n");
    return 1;
  }
  if (settle(&w) || body_read(&w.disc) || mpm_stepper_info(w.stepper, &now)) goto failed;
  colour_disc(&w.disc);
  w.slope.row[0] = sin(angle);
  w.slope.row[1] = cos(angle);
  for (int64_t i = 0; i < 2 * w.disc.n; ++i) x0[i] = w.disc.x[i];
  const double energy = now.kinetic_energy + now.strain_energy;
  double start[2], way = 0.0, turn = 0.0, mass = 0.0;
  body_mean(&w.disc, x0, start);
  for (int64_t i = 0; i < w.disc.n; ++i) mass += w.disc.mass[i];

  char path[1024], text[128];
  snprintf(path, sizeof path, "%s/rolling_disc.svg", directory);
  const svg_frame f = {12.0, 12.0, 936.0, 936.0 * 2.9 / 4.2, -0.75, 3.45, -2.05, 0.85};
  FILE *out = svg_open(path, 960, 671);
  svg_panel(out, &f);
  printf("   t/s    way/m  rigid/m   turn R/m   speed/(m/s)   spin R/(m/s)\n");
  for (int k = 0; k <= SAMPLES; ++k) { /* at equal distances of a rigid disc */
    double centre[2], v[2];
    go.t_end = t_end * sqrt((double)k / SAMPLES);
    if ((k && mpm_advance(w.stepper, &go, &now)) || body_read(&w.disc) || body_read(&w.slope)) goto failed;
    body_mean(&w.disc, w.disc.x, centre);
    body_mean(&w.disc, w.disc.v, v);
    way = down((const double[]){centre[0] - start[0], centre[1] - start[1]});
    turn += remainder(turned(&w.disc, x0) - turn, 2.0 * PI);
    printf("%6.3f %8.4f %8.4f %10.4f %13.4f %14.4f\n", now.t, way, 0.5 * a * now.t * now.t, turn * radius,
           down(v), 0.0 - body_spin(&w.disc) * radius);
    if (k % (SAMPLES / (SHOTS - 1))) continue;
    colour_slope(&w.slope);
    draw_disc(out, &f, &w, now.t);
  }
  draw_slope(out, &f, &w);
  snprintf(text, sizeof text, "slope: red where the pressure was %.0f kPa or more", 1e-3 * pressure_shown);
  svg_text(out, f.left + 14.0, f.top + f.height - 16.0, "start", "", text);
  if (svg_close(out)) {
    fprintf(stderr, "rolling_disc: cannot write into %s\n", directory);
    return 1;
  }
  /* forces are those on the second body, the disc */
  if (mpm_stepper_contact_info(w.stepper, 0, 1, &touch)) goto failed;
  free(x0);
  if (take_down(&w) || mpm_context_destroy(ctx)) goto failed;
  printf("\nwritten to %s: rolling_disc.svg\n", directory);
  const double pressed = off(touch.impulse) / (mass * g * cos(angle) * now.t),
               held_back = -down(touch.impulse) / (mass * (share - a) * now.t),
               lost = energy + now.external_work_total - now.kinetic_energy - now.strain_energy;
  printf("result: way %.4f of the rigid one's, turn %.4f of the way, friction %.4f, normal force %.4f, "
         "energy lost %.2f %%\n",
         way / (0.5 * a * now.t * now.t), turn * radius / way, held_back, pressed,
         100.0 * lost / now.external_work_total);
  return 0;

failed:
  fprintf(stderr, "rolling_disc: %s\n", mpm_last_error(ctx));
  return 1;
}
