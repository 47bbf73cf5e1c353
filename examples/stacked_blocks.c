/* Three elastic blocks, a body each, stand on each other until a disc pushes them over.
 *
 *   stacked_blocks [directory]
 *
 * The tower settles under its weight in implicit quasi-static steps, then stands in explicit ones, and at
 * 0.3 s the disc, an obstacle that moves as it is told, sets out. Prints where the blocks are and what the
 * floor carries, and draws four moments (stacked_blocks.svg) into the directory (default: here). */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>

#include "body.h"

enum { BLOCKS = 3, SHADES = 6, SAMPLES = 46, SHOTS = 4 };
static const double h = 0.04, wide = 0.32, tall = 0.4, density = 1000.0, g = 10.0, friction = 0.5;
static const double radius = 0.15, speed = 1.0, t_push = 0.3, t_end = 1.15;
static const double pressure_shown = 8e3;

typedef struct tower {
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_stepper *stepper;
  mpm_stepper_desc method;
  mpm_obstacle *floor, *disc;
  body block[BLOCKS];
} tower;

static mpm_status add_blocks(mpm_context *ctx, tower *w) {
  const int32_t per_cell[2] = {2, 2};
  for (int k = 0; k < BLOCKS; ++k) {
    const double lower[2] = {0.0, k * tall}, upper[2] = {wide, (k + 1) * tall};
    mpm_particles *set;
    mpm_status status;
    if ((status = mpm_particles_create(ctx, w->grid, w->rubber, &set)) ||
        (status = mpm_particles_fill_box(set, lower, upper, per_cell, NULL, NULL)) ||
        (status = mpm_stepper_add(w->stepper, set)) || (status = mpm_stepper_set_body(w->stepper, set, k)))
      return status;
    w->block[k].set = set;
  }
  return MPM_OK;
}

static mpm_status add_obstacles(mpm_context *ctx, tower *w, const mpm_contact_desc *rough) {
  mpm_obstacle_desc d;
  mpm_status status;
  if ((status = mpm_obstacle_desc_init(&d, sizeof d))) return status;
  d.shape = MPM_SHAPE_PLANE;
  d.contact = rough;
  if ((status = mpm_obstacle_create(ctx, &d, &w->floor)) ||
      (status = mpm_stepper_add_obstacle(w->stepper, w->floor)))
    return status;
  d.shape = MPM_SHAPE_SPHERE; /* in 2-D a disc */
  d.motion = MPM_MOTION_PRESCRIBED;
  d.size[0] = radius;
  d.position[0] = -radius - 0.02;
  d.position[1] = 1.1;
  if ((status = mpm_obstacle_create(ctx, &d, &w->disc))) return status;
  return mpm_stepper_add_obstacle(w->stepper, w->disc);
}

static mpm_status build(mpm_context *ctx, tower *w) {
  const mpm_param elastic[] = {{"E", 1e6}, {"nu", 0.3}, {"density", density}};
  mpm_grid_desc gd;
  mpm_contact_desc rough;
  mpm_status status;
  if ((status = mpm_grid_desc_init(&gd, sizeof gd)) ||
      (status = mpm_stepper_desc_init(&w->method, sizeof w->method)) ||
      (status = mpm_contact_desc_init(&rough, sizeof rough)))
    return status;
  gd.dim = 2;
  gd.basis = MPM_BSPLINE2;
  gd.cells[0] = 60;
  gd.cells[1] = 44;
  gd.origin[0] = -0.6;
  gd.origin[1] = -4.0 * h;
  for (int c = 0; c < 2; ++c) gd.spacing[c] = h;
  w->method.scheme = MPM_NEWMARK;
  w->method.quasi_static = 1;
  w->method.gravity[1] = -g;
  rough.friction = friction;
  if ((status = mpm_grid_create(ctx, &gd, &w->grid)) ||
      (status = mpm_material_create(ctx, "neo_hookean", elastic, 3, &w->rubber)) ||
      (status = mpm_stepper_create(ctx, w->grid, &w->method, &w->stepper)) ||
      (status = mpm_stepper_set_contact(w->stepper, MPM_BODY_ANY, MPM_BODY_ANY, &rough)) ||
      (status = add_blocks(ctx, w)))
    return status;
  return add_obstacles(ctx, w, &rough);
}

static mpm_status take_down(tower *w) {
  mpm_status status;
  if ((status = mpm_stepper_destroy(w->stepper)) || (status = mpm_obstacle_destroy(w->floor)) ||
      (status = mpm_obstacle_destroy(w->disc)))
    return status;
  for (int k = 0; k < BLOCKS; ++k) {
    if ((status = mpm_particles_destroy(w->block[k].set))) return status;
    body_close(&w->block[k]);
  }
  if ((status = mpm_material_destroy(w->rubber))) return status;
  return mpm_grid_destroy(w->grid);
}

/* A second step finds the friction of the first shortening, and changes little. */
static mpm_status settle(tower *w) {
  mpm_status status = MPM_OK;
  for (int step = 0; step < 2 && !status; ++step) status = mpm_step(w->stepper, 1.0, NULL);
  /* quasi-static velocities are those of settling within the step */
  const double rest[2] = {0.0, 0.0};
  for (int k = 0; k < BLOCKS && !status; ++k)
    status = mpm_particles_set_all(w->block[k].set, "velocity", MPM_F64, 2, rest);
  w->method.scheme = MPM_MUSL;
  w->method.quasi_static = 0;
  w->method.transfer = MPM_APIC; /* less noise in the stress of bodies that turn */
  if (!status) status = mpm_stepper_configure(w->stepper, &w->method);
  return status ? status : mpm_stepper_set_time(w->stepper, 0.0, 0);
}

/* Each block has a hue, the darker the higher the pressure. */
static mpm_status draw(FILE *out, int panel, const char *caption, double t, tower *w) {
  static const int hue[BLOCKS][3] = {{31, 111, 235}, {209, 72, 12}, {26, 127, 55}};
  const svg_frame f = {12.0 + 236.0 * panel, 36.0, 228.0, 1.5 / 1.9 * 228.0, -0.5, 1.4, -0.08, 1.42};
  int rgb[BLOCKS * SHADES][3];
  char text[128];
  double x[3];
  const mpm_status status = mpm_obstacle_get_pose(w->disc, x, NULL, NULL, NULL);
  if (status) return status;
  snprintf(text, sizeof text, "<tspan font-weight=\"bold\">t = %.2f s</tspan> &#160;%s", t, caption);
  svg_text(out, f.left + 0.5 * f.width, 25.0, "middle", "", text);
  svg_panel(out, &f);
  if (out)
    fprintf(out, "<path d=\"M%.1f %.1fh%.1f\" stroke=\"" SVG_INK "\"/>\n", f.left, svg_y(&f, 0.0), f.width);
  for (int k = 0; k < BLOCKS * SHADES; ++k)
    for (int c = 0; c < 3; ++c) {
      const double dark = 0.45 + 0.55 * (k % SHADES) / (SHADES - 1);
      rgb[k][c] = (int)(255.0 + dark * (0.7 * hue[k / SHADES][c] - 255.0));
    }
  for (int k = 0; k < BLOCKS; ++k) {
    body *b = &w->block[k];
    for (int64_t i = 0; i < b->n; ++i) {
      const double *s = b->stress + i, pressure = -(s[0] + s[b->n] + s[2 * b->n]) / 3.0;
      const double shade = SHADES * fmax(0.0, pressure) / pressure_shown;
      b->colour[i] = SHADES * k + (shade < SHADES ? (int)shade : SHADES - 1);
    }
    body_draw(out, &f, b, 0.5 * h, BLOCKS * SHADES, rgb);
  }
  svg_disc(out, &f, x[0], x[1], radius);
  return MPM_OK;
}

/* What is found in all the steps. */
typedef struct record {
  double weight, energy; /* at the start */
  double uneven;         /* of the floor's force at rest, over the weight */
  double momentum;       /* that no impulse gave, over that of the weight */
  double gain;           /* largest energy that no work gave */
  double least;          /* contact_dissipation of a step */
} record;

/* Goes to t in single steps, each of which is looked at. */
static mpm_status go_to(tower *w, double t, record *r, mpm_step_info *now) {
  mpm_advance_desc go;
  mpm_contact_info floor = {.struct_size = sizeof floor}, disc = {.struct_size = sizeof disc};
  mpm_status status = mpm_advance_desc_init(&go, sizeof go);
  go.t_end = t;
  go.cfl = 0.4;
  go.max_steps = 1;
  while (now->t < t && !status) {
    if ((status = mpm_advance(w->stepper, &go, now)) ||
        (status = mpm_obstacle_contact_info(w->floor, MPM_BODY_ANY, &floor)) ||
        (status = mpm_obstacle_contact_info(w->disc, MPM_BODY_ANY, &disc)))
      return status;
    const double energy = now->kinetic_energy + now->strain_energy,
                 x = floor.impulse[0] + disc.impulse[0] - now->momentum[0],
                 y = floor.impulse[1] + disc.impulse[1] - now->momentum[1] - r->weight * now->t;
    if (now->t <= t_push) r->uneven = fmax(r->uneven, fabs(floor.force[1] / r->weight - 1.0));
    r->momentum = fmax(r->momentum, hypot(x, y) / (r->weight * now->t));
    r->gain = fmax(r->gain, energy - r->energy - now->external_work_total);
    r->least = fmin(r->least, now->contact_dissipation);
  }
  return status;
}

static mpm_status find_centres(tower *w, double at[BLOCKS][2]) {
  mpm_status status = MPM_OK;
  for (int k = 0; k < BLOCKS && !status; ++k) {
    status = body_read(&w->block[k]);
    if (!status) body_mean(&w->block[k], w->block[k].x, at[k]);
  }
  return status;
}

int main(int argc, char **argv) {
  static const char *const caption[SHOTS] = {"at rest", "pushed", "falling", "down"};
  static const int shot[SHOTS] = {12, 20, 36, SAMPLES}; /* samples that are drawn */
  const char *directory = argc > 1 ? argv[1] : ".";
  const double push[3] = {speed, 0.0, 0.0};
  mpm_context *ctx = NULL;
  tower w;
  mpm_step_info now = {.struct_size = sizeof now};
  if (mpm_context_create(NULL, &ctx) || build(ctx, &w)) goto failed;
  for (int k = 0; k < BLOCKS; ++k)
    if (body_open(&w.block[k], w.block[k].set)) {
      fprintf(stderr, "stacked_blocks: out of memory\n");
      return 1;
    }
  double start[BLOCKS][2], at[BLOCKS][2];
  if (settle(&w) || mpm_stepper_info(w.stepper, &now) || find_centres(&w, start)) goto failed;
  record r = {.weight = BLOCKS * wide * tall * density * g,
              .energy = now.kinetic_energy + now.strain_energy,
              .gain = -HUGE_VAL,
              .least = HUGE_VAL};
  char path[1024], text[128];
  snprintf(path, sizeof path, "%s/stacked_blocks.svg", directory);
  FILE *out = svg_open(path, 960, 250);
  printf("  t/s  floor/weight  kinetic/J  strain/J   centres of the blocks: x y/m\n");
  for (int k = 1, panel = 0; k <= SAMPLES; ++k) {
    mpm_contact_info floor = {.struct_size = sizeof floor};
    if (go_to(&w, t_end * k / SAMPLES, &r, &now) || find_centres(&w, at) ||
        mpm_obstacle_contact_info(w.floor, MPM_BODY_ANY, &floor))
      goto failed;
    if (k == shot[0] && mpm_obstacle_set_pose(w.disc, NULL, NULL, push, NULL)) goto failed;
    if (k == shot[panel]) {
      if (draw(out, panel, caption[panel], now.t, &w)) goto failed;
      ++panel;
    }
    if (k % 4 && k < SAMPLES) continue;
    printf("%5.2f %13.6f %10.3f %9.3f ", now.t, floor.force[1] / r.weight, now.kinetic_energy,
           now.strain_energy);
    for (int b = 0; b < BLOCKS; ++b) printf(" %6.3f %.3f", at[b][0], at[b][1]);
    printf("\n");
  }
  snprintf(text, sizeof text, "each block a hue, dark where the pressure is %.0f Pa and more",
           pressure_shown);
  svg_text(out, 480.0, 236.0, "middle", "", text);
  if (svg_close(out)) {
    fprintf(stderr, "stacked_blocks: cannot write into %s\n", directory);
    return 1;
  }
  if (take_down(&w) || mpm_context_destroy(ctx)) goto failed;
  printf("\nwritten to %s: stacked_blocks.svg\n", directory);
  printf("result: floor within %.0e of the weight at rest, blocks moved by %.3f, %.3f and %.3f m, "
         "momentum off by %.0e, energy gained %.0e J, contact dissipation at least %.0e J\n",
         r.uneven, at[0][0] - start[0][0], at[1][0] - start[1][0], at[2][0] - start[2][0], r.momentum, r.gain,
         r.least);
  return 0;

failed:
  fprintf(stderr, "stacked_blocks: %s\n", mpm_last_error(ctx));
  return 1;
}
