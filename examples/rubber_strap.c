/* A rubber strap with a hole, a sheet in plane stress, is drawn to three times its length: one quarter of
 * it, the rest by symmetry planes, in quasi-static steps on a total Lagrangian grid, whose cells hold the
 * strap as it was.
 *
 *   rubber_strap [directory] [0]
 *
 * prints the force, how wide the hole is, and the largest stretch, and writes into the directory (default:
 * here) a picture, rubber_strap.svg. With 0 the grid is that of present positions, on which the strap does
 * not come so far. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body.h"

enum { STEPS = 40 };
static const double length = 2.0, width = 1.0, hole = 0.4, h = 0.1, E = 1e6, nu = 0.45, last = 3.0;

static mpm_status beside_hole(void *user, int32_t dim, int64_t n, int64_t ld, const double *x,
                              uint8_t *inside) {
  (void)user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) inside[i] = hypot(x[i], x[ld + i]) >= hole;
  return MPM_OK;
}

/* The clamp: nodes with a weight at the end of the strap move along with it. Where nodes stand in space, that
 * is where the end is at that time. */
typedef struct clamp {
  double speed;
  int total;
} clamp;

static mpm_status hold(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const clamp *by = user;
  const double end = length + (by->total ? 0.0 : by->speed * b->t);
  for (int64_t i = 0; i < b->n; ++i)
    if (b->position[i] > end - 1.01 * h) {
      prescribed[i] = prescribed[b->ld + i] = 1;
      velocity[i] = by->speed;
      velocity[b->ld + i] = 0.0;
    }
  return MPM_OK;
}

/* The larger stretch of the plane. */
static double stretch_of(const body *b, int64_t i) {
  double F[4], C = 0.0;
  for (int c = 0; c < 4; ++c) F[c] = b->F[(3 * (c / 2) + c % 2) * b->n + i], C += F[c] * F[c];
  const double J = F[0] * F[3] - F[1] * F[2];
  return sqrt(0.5 * (C + sqrt(fmax(C * C - 4.0 * J * J, 0.0))));
}

/* Domains of the particles and of their mirror images, coloured by the stretch. */
static void draw_strap(FILE *out, int panel, const body *b, double stretch) {
  const svg_frame f = {20.0, 40.0 + 190.0 * panel, 900.0, 150.0, -length * last, length * last, -1.0, 1.0};
  double *value = malloc(7 * (size_t)b->n * sizeof *value);
  if (!value) return;
  double *a = value + b->n, *e = a + 2 * b->n, *x = e + 2 * b->n;
  char text[80];
  snprintf(text, sizeof text, "<tspan font-weight=\"bold\">%.0f times the length</tspan>", stretch);
  svg_text(out, f.left, f.top - 10.0, "start", "", text);
  for (int corner = 0; corner < 4; ++corner) {
    const double sign[2] = {corner & 1 ? -1.0 : 1.0, corner & 2 ? -1.0 : 1.0};
    for (int64_t i = 0; i < b->n; ++i) {
      value[i] = stretch_of(b, i) - 1.0;
      for (int c = 0; c < 2; ++c) {
        x[c * b->n + i] = sign[c] * b->x[c * b->n + i];
        a[c * b->n + i] = sign[c] * 0.25 * h * b->F[3 * c * b->n + i];
        e[c * b->n + i] = sign[c] * 0.25 * h * b->F[(3 * c + 1) * b->n + i];
      }
    }
    svg_tiles(out, &f, b->n, x, a, e, value, 4.0);
  }
  free(value);
}

/* Sums up the force that holds the nodes of the clamp: of half the strap. */
static mpm_status force_of(mpm_stepper *s, double *force) {
  mpm_view at = {.struct_size = sizeof at}, f = {.struct_size = sizeof f};
  mpm_status status = mpm_grid_map(s, 0, "position", MPM_READ, &at);
  if (status) return status;
  if ((status = mpm_grid_map(s, 0, "reaction", MPM_READ, &f))) {
    mpm_view_release(&at);
    return status;
  }
  *force = 0.0;
  for (int64_t i = 0; i < at.count; ++i)
    if (((const double *)at.data)[i * at.item_stride] > 0.5 * length)
      *force += ((const double *)f.data)[i * f.item_stride];
  if ((status = mpm_view_release(&at))) return status;
  return mpm_view_release(&f);
}

int main(int argc, char **argv) {
  const int total = !(argc > 2 && strcmp(argv[2], "0") == 0);
  char path[1024];
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *set;
  mpm_stepper *stepper;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&g, sizeof g) ||
      mpm_stepper_desc_init(&s, sizeof s))
    goto failed;
  g.dim = 2;
  g.geometry = MPM_PLANE_STRESS;
  g.total_lagrangian = total;
  g.cells[0] = (int64_t)lround((total ? 1.2 : 1.2 * last) * length / h);
  g.cells[1] = (int64_t)lround(1.2 * width / h);
  g.spacing[0] = g.spacing[1] = h;
  s.scheme = MPM_NEWMARK;
  s.transfer = MPM_FLIP;
  s.quasi_static = 1;

  clamp by = {(last - 1.0) * length, total};
  const mpm_param law[] = {{"E", E}, {"nu", nu}, {"density", 1e3}};
  const double lower[] = {0.0, 0.0}, upper[] = {length, width};
  const int32_t per_cell[] = {2, 2};
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", law, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &set) ||
      mpm_particles_fill(set, lower, upper, per_cell, beside_hole, NULL, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_stepper_add(stepper, set) ||
      mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0) ||
      mpm_stepper_set_velocity_bc(stepper, hold, &by))
    goto failed;
  body strap;
  if (body_open(&strap, set) || body_read(&strap)) goto failed;
  int64_t top = 0, side = 0; /* the particles at the edge of the hole, across and along */
  for (int64_t i = 0; i < strap.n; ++i) {
    const double *x = strap.x, *y = strap.x + strap.n;
    if (x[i] < 0.3 * h && (x[top] > 0.3 * h || y[i] < y[top])) top = i;
    if (y[i] < 0.3 * h && (y[side] > 0.3 * h || x[i] < x[side])) side = i;
  }
  printf("A strap of %.0f by %.0f m with a hole of %.1f m, %lld particles in a quarter\n\n", 2.0 * length,
         2.0 * width, 2.0 * hole, (long long)strap.n);
  printf(" length   force/kN per m   hole along/m   across/m   largest stretch\n");
  snprintf(path, sizeof path, "%s/rubber_strap.svg", argc > 1 ? argv[1] : ".");
  FILE *out = svg_open(path, 940, 670);
  draw_strap(out, 0, &strap, 1.0);
  mpm_step_info now = {.struct_size = sizeof now};
  double force = 0.0, stretch = 1.0, most = 1.0;
  mpm_status status = MPM_OK;
  for (int k = 1; k <= STEPS && !status; ++k) {
    status = mpm_step(stepper, 1.0 / STEPS, &now);
    if (status) break;
    stretch = 1.0 + (last - 1.0) * k / STEPS;
    if (body_read(&strap) || force_of(stepper, &force)) goto failed;
    most = 1.0;
    for (int64_t i = 0; i < strap.n; ++i) most = fmax(most, stretch_of(&strap, i));
    if (k % (STEPS / 4) == 0)
      printf("%7.2f %16.1f %14.3f %10.3f %17.3f\n", stretch, 2e-3 * force, 2.0 * strap.x[side],
             2.0 * strap.x[strap.n + top], most);
    if (k % (STEPS / 2) == 0) draw_strap(out, 2 * k / STEPS, &strap, stretch);
  }
  if (status) printf("\nNo further than %.2f: %s\n", stretch, mpm_last_error(ctx));
  svg_colour_bar(out, 310.0, 620.0, 320.0, 4.0, "largest stretch - 1");
  if (svg_close(out)) {
    fprintf(stderr, "rubber_strap: cannot write %s\n", path);
    return 1;
  }
  body_close(&strap);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(set) || mpm_material_destroy(rubber) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten: %s\nresult: drawn to %.2f, force %.1f kN per m, largest stretch %.3f\n", path, stretch,
         2e-3 * force, most);
  return 0;

failed:
  fprintf(stderr, "rubber_strap: %s\n", mpm_last_error(ctx));
  return 1;
}
