/* A body from an STL file falls on a floor: jelly in 3-D.
 *
 *   stl_body [directory [file.stl [cells]]]
 *
 * scales the body to .6 m, fills it with particles on a grid of 40 (or `cells`) cells for 1 m, prints volumes
 * and how the body falls, and draws three moments, seen from the front (stl_body.svg), into the directory
 * (default: here). Without a file it writes one, a knot (knot.stl). */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "stl.h"
#include "svg.h"

enum { ALONG = 160, ROUND = 20, SHOTS = 3 };
static const double size = 0.6, shown = 2.0, t_end = 0.6, g = 9.81;

/* ---- a file ---- */
/* The middle line of a trefoil knot. */
static void middle_line(double t, double x[3]) {
  x[0] = sin(t) + 2.0 * sin(2.0 * t);
  x[1] = cos(t) - 2.0 * cos(2.0 * t);
  x[2] = -sin(3.0 * t);
}

static void cross(const double a[3], const double b[3], double c[3]) {
  double length = 0.0;
  for (int k = 0; k < 3; ++k) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
  for (int k = 0; k < 3; ++k) length += c[k] * c[k];
  for (int k = 0; k < 3; ++k) c[k] /= sqrt(length);
}

static void knot_point(int i, int j, double x[3]) {
  const double pi = acos(-1.0), t = 2.0 * pi * (i % ALONG) / ALONG, b = 2.0 * pi * (j % ROUND) / ROUND;
  const double axis[3] = {0.0, 0.0, 1.0};
  double at[3], next[3], along[3], u[3], v[3];
  middle_line(t, at);
  middle_line(t + 1e-6, next);
  for (int k = 0; k < 3; ++k) along[k] = next[k] - at[k];
  cross(along, axis, u);
  cross(u, along, v);
  for (int k = 0; k < 3; ++k) x[k] = at[k] + 0.62 * (cos(b) * u[k] + sin(b) * v[k]);
}

static int write_knot(const char *path) {
  FILE *out = fopen(path, "w");
  if (!out) return -1;
  fputs("solid knot\n", out);
  for (int n = 0; n < 2 * ALONG * ROUND; ++n) {
    const int i = n / 2 / ROUND, j = n / 2 % ROUND;
    const int corner[2][3][2] = {{{i, j}, {i + 1, j + 1}, {i + 1, j}}, {{i, j}, {i, j + 1}, {i + 1, j + 1}}};
    fputs("facet normal 0 0 0\nouter loop\n", out);
    for (int k = 0; k < 3; ++k) {
      double x[3];
      knot_point(corner[n % 2][k][0], corner[n % 2][k][1], x);
      fprintf(out, "vertex %.9g %.9g %.9g\n", x[0], x[1], x[2]);
    }
    fputs("endloop\nendfacet\n", out);
  }
  fputs("endsolid knot\n", out);
  const int failed = ferror(out);
  return fclose(out) || failed ? -1 : 0;
}

/* ---- the mesh ---- */
/* Scales a mesh into the room over the floor. */
static void place(stl_mesh *m) {
  const int64_t n = 3 * m->triangles;
  double low[3], high[3], longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    low[k] = high[k] = m->position[n * k];
    for (int64_t i = 0; i < n; ++i) {
      low[k] = fmin(low[k], m->position[n * k + i]);
      high[k] = fmax(high[k], m->position[n * k + i]);
    }
    longest = fmax(longest, high[k] - low[k]);
  }
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < n; ++i) {
      const double from_middle = m->position[n * k + i] - 0.5 * (low[k] + high[k]);
      m->position[n * k + i] = 0.5 + (k == 1 ? 0.1 : 0.0) + size / longest * from_middle;
    }
}

/* By the divergence theorem. */
static double volume_of(const stl_mesh *m) {
  const int64_t n = 3 * m->triangles;
  double sum = 0.0;
  for (int64_t i = 0; i < m->triangles; ++i) {
    double d[3][3];
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) d[j][k] = m->position[n * k + 3 * i + j] - 0.5;
    for (int k = 0; k < 3; ++k)
      sum += d[0][k] * (d[1][(k + 1) % 3] * d[2][(k + 2) % 3] - d[1][(k + 2) % 3] * d[2][(k + 1) % 3]) / 6.0;
  }
  return fabs(sum);
}

/* ---- the picture ---- */
/* Squares of the particles that are seen from the front: the nearest in each cell of a raster. */
static int draw(FILE *out, int panel, int64_t n, const double *x, const double *v, double h, double t) {
  const int wide = (int)(1.0 / h);
  const svg_frame f = {16.0 + 316.0 * panel, 40.0, 300.0, 300.0, 0.0, 1.0, 0.0, 1.0};
  int64_t *front = malloc((size_t)(wide * wide) * sizeof *front), m = 0;
  double *at = malloc(3 * (size_t)(wide * wide) * sizeof *at);
  char text[64];
  if (front && at) {
    for (int k = 0; k < wide * wide; ++k) front[k] = -1;
    for (int64_t i = 0; i < n; ++i) {
      const int column = (int)(x[i] / h), row = (int)(x[n + i] / h), k = row * wide + column;
      if (column < 0 || column >= wide || row < 0 || row >= wide) continue;
      if (front[k] < 0 || x[2 * n + i] > x[2 * n + front[k]]) front[k] = i;
    }
    for (int k = 0; k < wide * wide; ++k) m += front[k] >= 0;
    int64_t to = 0;
    for (int k = 0; k < wide * wide; ++k) {
      if (front[k] < 0) continue;
      at[to] = x[front[k]];
      at[m + to] = x[n + front[k]];
      at[2 * m + to] = v[front[k]];
      ++to;
    }
    snprintf(text, sizeof text, "<tspan font-weight=\"bold\">t = %.2f s</tspan>", t);
    svg_text(out, f.left + 150.0, 28.0, "middle", "", text);
    svg_panel(out, &f);
    svg_clip(out, &f);
    svg_squares(out, &f, m, at, 1.25 * h, at + 2 * m, shown);
    svg_end_clip(out);
  }
  const int failed = !front || !at;
  free(front);
  free(at);
  return failed ? -1 : 0;
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  char path[1024], made[1024];
  const int cells = argc > 3 ? atoi(argv[3]) : 40;
  stl_mesh mesh;
  snprintf(made, sizeof made, "%s/knot.stl", directory);
  if (argc < 3 && write_knot(made)) {
    fprintf(stderr, "stl_body: cannot write %s\n", made);
    return 1;
  }
  if (stl_read(&mesh, argc > 2 ? argv[2] : made)) {
    fprintf(stderr, "stl_body: cannot read %s\n", argc > 2 ? argv[2] : made);
    return 1;
  }
  place(&mesh);

  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *jelly;
  mpm_particles *body;
  mpm_stepper *stepper;
  mpm_grid_desc gd;
  mpm_stepper_desc sd;
  mpm_advance_desc go;
  mpm_step_info now = {.struct_size = sizeof now};
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&gd, sizeof gd) ||
      mpm_stepper_desc_init(&sd, sizeof sd) || mpm_advance_desc_init(&go, sizeof go))
    goto failed;
  gd.dim = 3;
  for (int k = 0; k < 3; ++k) {
    gd.cells[k] = cells;
    gd.spacing[k] = 1.0 / cells;
  }
  sd.gravity[1] = -g;
  const mpm_param law[] = {{"E", 2.5e5}, {"nu", 0.3}, {"density", 1e3}};
  const int32_t per_cell[] = {2, 2, 2};
  int64_t n = 0;
  if (mpm_grid_create(ctx, &gd, &grid) || mpm_material_create(ctx, "neo_hookean", law, 3, &jelly) ||
      mpm_particles_create(ctx, grid, jelly, &body) ||
      mpm_particles_fill_mesh(body, 3 * mesh.triangles, mesh.position, mesh.triangles, mesh.corner, per_cell,
                              NULL, &n) ||
      mpm_stepper_create(ctx, grid, &sd, &stepper) || mpm_stepper_add(stepper, body) ||
      mpm_stepper_set_wall(stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.4))
    goto failed;
  const double volume = volume_of(&mesh), of_particles = (double)n * pow(0.5 / cells, 3);
  printf("%lld triangles enclose %.5f m^3, %lld particles have %.5f m^3\n\n", (long long)mesh.triangles,
         volume, (long long)n, of_particles);
  stl_close(&mesh);

  double *x = malloc(7 * (size_t)n * sizeof *x), lowest = 0.0, bounce = 0.0;
  if (!x) {
    fprintf(stderr, "stl_body: out of memory\n");
    return 1;
  }
  double *v = x + 3 * n, *speed = v + 3 * n;
  snprintf(path, sizeof path, "%s/stl_body.svg", directory);
  FILE *out = svg_open(path, 964, 410);
  printf("   t/s   lowest/m   mean height/m   mean velocity/(m/s)\n");
  for (int k = 0; k <= 12; ++k) {
    go.t_end = t_end * k / 12;
    if (k && mpm_advance(stepper, &go, &now)) goto failed;
    if (mpm_particles_get(body, "position", MPM_F64, 3, n, NULL, x) ||
        mpm_particles_get(body, "velocity", MPM_F64, 3, n, NULL, v))
      goto failed;
    double low = HUGE_VAL, height = 0.0, falls = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      low = fmin(low, x[n + i]);
      height += x[n + i] / (double)n;
      falls += v[n + i] / (double)n;
      speed[i] = sqrt(v[i] * v[i] + v[n + i] * v[n + i] + v[2 * n + i] * v[2 * n + i]);
    }
    lowest = k ? fmin(lowest, low) : low;
    bounce = fmax(bounce, falls);
    printf("%6.2f %10.4f %15.4f %21.4f\n", now.t, low, height, falls);
    if (k % 4 == 0 && k < 12 && draw(out, k / 4, n, x, speed, 0.5 / cells, now.t)) goto failed;
  }
  svg_colour_bar(out, 322.0, 372.0, 320.0, shown, "speed / (m/s)");
  if (svg_close(out)) {
    fprintf(stderr, "stl_body: cannot write %s\n", path);
    return 1;
  }
  free(x);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(body) || mpm_material_destroy(jelly) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;
  printf("\nwritten to %s: stl_body.svg\n", directory);
  printf("result: %lld particles, volume within %.3f %%, lowest %.4f m, thrown back with %.3f m/s\n",
         (long long)n, 100.0 * fabs(of_particles / volume - 1.0), lowest, bounce);
  return 0;

failed:
  fprintf(stderr, "stl_body: %s\n", mpm_last_error(ctx));
  return 1;
}
