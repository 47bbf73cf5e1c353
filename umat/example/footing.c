/* A rigid footing is pressed into clay whose law is a UMAT in Fortran (soil.f90): once of the same strength
 * everywhere, where Prandtl's load is (2 + pi) c, and once growing with depth, which the UMAT knows from
 * COORDS.
 * Plane strain, half of the strip, smooth, quasi-static steps with the UMAT's DDSDDE.
 *
 *   footing [directory]
 *
 * prints loads over settlements, and draws footing.svg into the directory (default: here). */
#include <mpm/mpm_umat.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "svg.h"

extern mpm_umat_subroutine umat_;

enum { STEPS = 24, PER_B = 12, CLAYS = 2, MOST = 4 * (5 * PER_B / 2) * (5 * PER_B / 2) };
static const double B = 1.0, c = 1.0, E = 1e3, nu = 0.3, settlement = 0.02;
static const double growth[CLAYS] = {0.0, 2.0}; /* of the strength, in c / B */

typedef struct outcome {
  int64_t n;
  double load[STEPS + 1], x[2 * MOST], F[9 * MOST], plastic[MOST];
} outcome;

static void heard(void *user, int64_t particle, const char *text) {
  (void)user;
  fprintf(stderr, "footing: particle %lld: %s\n", (long long)particle, text);
}

static mpm_status sink(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) add[b->ld + i] -= settlement * B / STEPS;
  return MPM_OK;
}

static mpm_status make_clay(mpm_context *context, double grows, mpm_material **out) {
  const double props[5] = {E, nu, c, grows, 2.5 * B};
  mpm_umat_desc d;
  const mpm_status status = mpm_umat_desc_init(&d, sizeof d);
  if (status) return status;
  d.density = 1.0;
  d.nprops = 5;
  d.props = props;
  d.nstatv = 1;
  d.dim = 2; /* for COORDS */
  d.cmname = "CLAY";
  d.message = heard;
  return mpm_umat_material(context, umat_, &d, out);
}

/* Loads over c B / 2, of which Prandtl's is 2 + pi. */
static mpm_status press(mpm_context *context, double grows, outcome *o) {
  const double h = B / PER_B, depth = 2.5 * B;
  const int32_t per_cell[] = {2, 2};
  const mpm_param density = {"density", 1.0};
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_advance_desc go;
  mpm_grid *grid;
  mpm_material *clay, *steel;
  mpm_particles *ground, *strip;
  mpm_stepper *stepper;
  mpm_status status = mpm_grid_desc_init(&g, sizeof g);
  if (!status) status = mpm_stepper_desc_init(&s, sizeof s);
  if (!status) status = mpm_advance_desc_init(&go, sizeof go);
  g.dim = 2;
  g.basis = MPM_LINEAR;
  g.cells[0] = 5 * PER_B / 2;
  g.cells[1] = 5 * PER_B / 2 + 3;
  g.spacing[0] = g.spacing[1] = h;
  s.scheme = MPM_NEWMARK;
  s.quasi_static = 1;
  s.locking_remedy = MPM_LOCKING_CELL_AVERAGE; /* clay that yields keeps its volume */
  if (!status) status = mpm_grid_create(context, &g, &grid);
  if (!status) status = make_clay(context, grows, &clay);
  if (!status) status = mpm_material_create(context, "rigid", &density, 1, &steel);
  if (!status) status = mpm_particles_create(context, grid, clay, &ground);
  if (!status) status = mpm_particles_create(context, grid, steel, &strip);
  if (!status)
    status = mpm_particles_fill_box(ground, (const double[]){0.0, 0.0}, (const double[]){2.5 * B, depth},
                                    per_cell, NULL, &o->n);
  if (!status)
    status = mpm_particles_fill_box(strip, (const double[]){0.0, depth}, (const double[]){0.5 * B, depth + h},
                                    per_cell, NULL, NULL);
  if (!status) status = mpm_stepper_create(context, grid, &s, &stepper);
  if (!status) status = mpm_stepper_add(stepper, ground);
  if (!status) status = mpm_stepper_add(stepper, strip);
  if (!status) status = mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0);
  if (!status) status = mpm_stepper_set_wall(stepper, MPM_X_MAX, MPM_WALL_SLIP, 0.0);
  if (!status) status = mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0);
  if (!status) status = mpm_stepper_set_motion(stepper, strip, sink, NULL);
  if (!status) status = mpm_particles_set_all(strip, "prescribed", MPM_U8, 2, (const uint8_t[]){0, 1});
  o->load[0] = 0.0;
  for (int k = 1; k <= STEPS && !status; ++k) {
    double force[2] = {0.0, 0.0};
    go.t_end = k;
    status = mpm_advance(stepper, &go, NULL);
    if (!status) status = mpm_stepper_particles_reaction(stepper, strip, force);
    o->load[k] = -force[1] / (0.5 * B * c);
  }
  if (!status) status = mpm_particles_get(ground, "position", MPM_F64, 2, o->n, NULL, o->x);
  if (!status) status = mpm_particles_get(ground, "deformation_gradient", MPM_F64, 9, o->n, NULL, o->F);
  if (!status) { /* the plastic strain, and the steps that libmpm-umat counts */
    static double state[2 * MOST];
    status = mpm_particles_get(ground, "state", MPM_F64, 2, o->n, NULL, state);
    for (int64_t i = 0; i < o->n; ++i) o->plastic[i] = state[i];
  }
  if (!status) status = mpm_stepper_destroy(stepper);
  if (!status) status = mpm_particles_destroy(strip);
  if (!status) status = mpm_particles_destroy(ground);
  if (!status) status = mpm_material_destroy(steel);
  if (!status) status = mpm_material_destroy(clay);
  if (!status) status = mpm_grid_destroy(grid);
  return status;
}

static int draw(const char *path, const outcome *all) {
  static const char *const name[CLAYS] = {"c everywhere", "c + 2 c · depth / B"};
  static const char *const colour[CLAYS] = {"#1f6feb", "#d1480c"};
  static double a[2 * MOST], b[2 * MOST], at[STEPS + 1];
  const svg_frame loads = {720.0, 46.0, 320.0, 300.0, 0.0, 100.0 * settlement, 0.0, 10.0};
  FILE *out = svg_open(path, 1060, 420);
  for (int k = 0; k < CLAYS; ++k) {
    const outcome *o = &all[k];
    const svg_frame f = {20.0 + 325.0 * k, 46.0, 310.0, 300.0, 0.0, 1.55, 1.1, 2.6};
    svg_panel(out, &f);
    svg_edges(o->n, 0.5 * B / PER_B, o->F, 0, a);
    svg_edges(o->n, 0.5 * B / PER_B, o->F, 1, b);
    if (out)
      fprintf(
          out,
          "<clipPath id=\"panel%d\"><rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"/></clipPath>"
          "<g clip-path=\"url(#panel%d)\">\n",
          k, f.left, f.top, f.width, f.height, k);
    svg_tiles(out, &f, o->n, o->x, a, b, o->plastic, 0.1);
    if (out)
      fprintf(out, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"#8c959f\"/></g>\n",
              svg_x(&f, 0.0), svg_y(&f, 2.6), svg_x(&f, 0.5 * B) - f.left,
              svg_y(&f, (2.5 - settlement) * B) - svg_y(&f, 2.6));
    svg_text(out, f.left + 0.5 * f.width, f.top - 16.0, "middle", "font-weight=\"bold\"", name[k]);
  }
  svg_colour_bar(out, 170.0, 372.0, 340.0, 0.1, "equivalent plastic strain (0.1 and more)");
  svg_axes(out, &loads, "settlement / B, per cent", "load / (c B)");
  for (int i = 0; i <= STEPS; ++i) at[i] = 100.0 * settlement * i / STEPS;
  for (int k = 0; k < CLAYS; ++k) {
    char style[64];
    snprintf(style, sizeof style, "fill=\"%s\" font-weight=\"bold\"", colour[k]);
    svg_curve(out, &loads, STEPS + 1, at, all[k].load, colour[k]);
    svg_text(out, loads.left + loads.width - 8.0, svg_y(&loads, all[k].load[STEPS]) - 10.0, "end", style,
             name[k]);
  }
  const double prandtl[] = {2.0 + 3.14159265358979323846, 2.0 + 3.14159265358979323846};
  svg_curve(out, &loads, 2, (const double[]){0.0, 100.0 * settlement}, prandtl, "#8c959f");
  svg_text(out, loads.left + loads.width - 8.0, svg_y(&loads, prandtl[0]) + 18.0, "end", "fill=\"#57606a\"",
           "2 + π");
  return svg_close(out);
}

int main(int count, char **argument) {
  static outcome all[CLAYS];
  char path[1024];
  mpm_context *context = NULL;
  if (mpm_context_create(NULL, &context)) return 1;
  for (int k = 0; k < CLAYS; ++k)
    if (press(context, growth[k] * c / B, &all[k])) {
      fprintf(stderr, "footing: %s\n", mpm_last_error(context));
      return 1;
    }
  printf("settlement / B     load / (c B): c everywhere     growing with depth\n");
  for (int i = 0; i <= STEPS; i += 3)
    printf("%14.4f %32.3f %22.3f\n", settlement * i / STEPS, all[0].load[i], all[1].load[i]);
  snprintf(path, sizeof path, "%s/footing.svg", count > 1 ? argument[1] : ".");
  if (mpm_context_destroy(context) || draw(path, all)) return 1;
  printf("\nresult: load %.3f c B, Prandtl's is %.3f; %.3f where the strength grows with depth\n",
         all[0].load[STEPS], 2.0 + 3.14159265358979323846, all[1].load[STEPS]);
  return 0;
}
