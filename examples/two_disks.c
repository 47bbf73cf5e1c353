/* Two elastic disks fly at each other, collide and rebound (Sulsky, Chen and Schreyer, 1994).
 *
 *   two_disks [directory]
 *
 * prints the energies and writes into the directory (default: here): particles for ParaView (two_disks.pvd),
 * the history (energy.csv), and pictures of the disks (two_disks.svg) and of the energies
 * (two_disks_energy.svg). */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "svg.h"

enum { SAMPLES = 360, ROW_EVERY = 20, FILE_EVERY = 10 };
static const double t_end = 3.6, speed = 0.1, h = 1.0 / 40.0;

static const char *in_directory(const char *directory, const char *name) {
  static char path[1024];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  return path;
}

/* What a picture needs; arrays are [components][n], by ascending id. */
typedef struct snapshot {
  double t;
  int64_t n, first_disk; /* the particles [0, first_disk) are the first disk */
  double *x, *v, *F, *stress;
} snapshot;

static int snapshot_create(snapshot *s, int64_t n, int64_t first_disk) {
  s->n = n;
  s->first_disk = first_disk;
  s->x = malloc((2 + 2 + 9 + 6) * (size_t)n * sizeof *s->x);
  if (!s->x) return -1;
  s->v = s->x + 2 * n;
  s->F = s->v + 2 * n;
  s->stress = s->F + 9 * n;
  return 0;
}

static mpm_status snapshot_take(snapshot *s, const mpm_particles *disks, double t) {
  s->t = t;
  mpm_status status = mpm_particles_get(disks, "position", MPM_F64, 2, s->n, NULL, s->x);
  if (!status) status = mpm_particles_get(disks, "velocity", MPM_F64, 2, s->n, NULL, s->v);
  if (!status) status = mpm_particles_get(disks, "deformation_gradient", MPM_F64, 9, s->n, NULL, s->F);
  if (!status) status = mpm_particles_get(disks, "stress", MPM_F64, 6, s->n, NULL, s->stress);
  return status;
}

/* Mean over a disk; its particles have equal masses, so this is also the mean by mass. */
static void disk_mean(const snapshot *s, int disk, const double *value, double out[2]) {
  const int64_t begin = disk ? s->first_disk : 0, end = disk ? s->n : s->first_disk;
  out[0] = out[1] = 0.0;
  for (int64_t i = begin; i < end; ++i)
    for (int c = 0; c < 2; ++c) out[c] += value[c * s->n + i] / (double)(end - begin);
}

static double mises(const snapshot *s, int64_t i) {
  const double *c = s->stress + i; /* xx yy zz xy yz xz */
  const int64_t n = s->n;
  const double xy = c[0] - c[n], yz = c[n] - c[2 * n], zx = c[2 * n] - c[0];
  const double shear = c[3 * n] * c[3 * n] + c[4 * n] * c[4 * n] + c[5 * n] * c[5 * n];
  return sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * shear);
}

static int draw_disks(const char *path, const snapshot shot[3]) {
  static const char *const caption[3] = {"approach", "largest strain energy", "after the rebound"};
  const int64_t n = shot[0].n;
  double *value = malloc(5 * (size_t)n * sizeof *value);
  if (!value) return -1;
  double *a = value + n, *b = a + 2 * n;
  const double value_max = 300.0; /* only the few particles in the contact go beyond */

  FILE *out = svg_open(path, 960, 424);
  for (int k = 0; k < 3; ++k) {
    const snapshot *s = &shot[k];
    const svg_frame f = {20.0 + 310.0 * k, 44.0, 300.0, 300.0, 0.0, 1.0, 0.0, 1.0};
    for (int64_t i = 0; i < n; ++i) {
      value[i] = mises(s, i);
      for (int c = 0; c < 2; ++c) { /* a particle is the deformed image of a square of half a cell */
        a[c * n + i] = 0.25 * h * s->F[3 * c * n + i];
        b[c * n + i] = 0.25 * h * s->F[(3 * c + 1) * n + i];
      }
    }
    char text[128];
    snprintf(text, sizeof text, "<tspan font-weight=\"bold\">t = %.2f s</tspan> &#160;%s", s->t, caption[k]);
    svg_text(out, f.left + 150.0, 30.0, "middle", "", text);
    svg_panel(out, &f);
    svg_tiles(out, &f, n, s->x, a, b, value, value_max);
    for (int disk = 0; disk < 2; ++disk) {
      double x[2], v[2];
      disk_mean(s, disk, s->x, x);
      disk_mean(s, disk, s->v, v);
      svg_arrow(out, &f, x[0], x[1], 400.0 * v[0], -400.0 * v[1], "#ffffff");
    }
  }
  svg_colour_bar(out, 320.0, 382.0, 320.0, value_max, "von Mises stress / Pa (300 and more)");
  free(value);
  return svg_close(out);
}

typedef struct history {
  double t[SAMPLES + 1], kinetic[SAMPLES + 1], strain[SAMPLES + 1], total[SAMPLES + 1];
} history;

static int draw_energies(const char *path, const history *past) {
  static const char *const name[3] = {"total", "kinetic", "strain"};
  static const char *const colour[3] = {SVG_INK, "#1f6feb", "#d1480c"};
  const double *const curve[3] = {past->total, past->kinetic, past->strain};
  const svg_frame f = {78.0, 20.0, 862.0, 286.0, 0.0, t_end, 0.0, 3.0};
  FILE *out = svg_open(path, 960, 370);
  svg_axes(out, &f, "time / s", "energy / J per metre of thickness");
  for (int k = 0; k < 3; ++k) {
    char style[64];
    snprintf(style, sizeof style, "fill=\"%s\" font-weight=\"bold\"", colour[k]);
    svg_curve(out, &f, SAMPLES + 1, past->t, curve[k], colour[k]);
    svg_text(out, svg_x(&f, 0.35), svg_y(&f, curve[k][0]) - 9.0 + (k == 1 ? 26.0 : 0.0), "start", style,
             name[k]);
  }
  return svg_close(out);
}

/* In place, on stderr: the table goes to stdout undisturbed. */
static void progress(const mpm_step_info *now) {
  char bar[41];
  for (int i = 0; i < 40; ++i) bar[i] = 40.0 * now->t / t_end > i + 0.5 ? '#' : '.';
  bar[40] = '\0';
  fprintf(stderr, "\r[%s] t = %.2f of %.2f s, step %" PRId64 " ", bar, now->t, t_end, now->step);
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_particles *disks;
  mpm_stepper *stepper;
  mpm_series *series;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&g, sizeof g) ||
      mpm_stepper_desc_init(&s, sizeof s))
    goto failed;

  /* The disks touch the unit box at the start: the grid is two cells wider on every side. */
  g.dim = 2;
  g.basis = MPM_BSPLINE2;
  for (int c = 0; c < 2; ++c) {
    g.cells[c] = 44;
    g.spacing[c] = h;
    g.origin[c] = -2.0 * h;
  }
  s.scheme = MPM_MUSL;
  s.transfer = MPM_FLIP;

  const mpm_param elastic[] = {{"E", 1000.0}, {"nu", 0.3}, {"density", 1000.0}};
  const double centre[2][2] = {{0.2, 0.2}, {0.8, 0.8}};
  const int32_t per_cell[] = {2, 2};
  int64_t first_disk;
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", elastic, 3, &rubber) ||
      mpm_particles_create(ctx, grid, rubber, &disks) ||
      mpm_particles_fill_ball(disks, centre[0], 0.2, per_cell, NULL, &first_disk) ||
      mpm_particles_fill_ball(disks, centre[1], 0.2, per_cell, NULL, NULL) ||
      mpm_stepper_create(ctx, grid, &s, &stepper) || mpm_stepper_add(stepper, disks))
    goto failed;

  const int64_t n = mpm_particles_count(disks);
  snapshot start, closest, end;
  if (snapshot_create(&start, n, first_disk) || snapshot_create(&closest, n, first_disk) ||
      snapshot_create(&end, n, first_disk)) {
    fprintf(stderr, "two_disks: out of memory\n");
    return 1;
  }
  for (int64_t i = 0; i < n; ++i) start.v[i] = start.v[n + i] = i < first_disk ? speed : -speed;
  if (mpm_particles_set(disks, "velocity", MPM_F64, 2, n, NULL, start.v) ||
      snapshot_take(&start, disks, 0.0) ||
      mpm_series_open(ctx, in_directory(directory, "two_disks.pvd"), &series))
    goto failed;
  FILE *csv = fopen(in_directory(directory, "energy.csv"), "w");
  if (!csv) {
    fprintf(stderr, "two_disks: cannot write into %s\n", directory);
    return 1;
  }

  printf("Two elastic disks, %" PRId64 " particles, cells of 1/40 m\n\n", n);
  printf("   t/s   kinetic/J    strain/J     total/J   |momentum|/(kg m/s)\n");
  fprintf(csv, "t,kinetic,strain,total,momentum_x,momentum_y\n");
  static history past;
  mpm_step_info now = {.struct_size = sizeof now};
  mpm_advance_desc go;
  if (mpm_advance_desc_init(&go, sizeof go) || mpm_stepper_info(stepper, &now)) goto failed;
  go.cfl = 0.4;
  double momentum_max = 0.0, drift = 0.0;
  int slowest = 0, tightest = 0; /* samples of least kinetic and largest strain energy */
  for (int k = 0; k <= SAMPLES; ++k) {
    go.t_end = t_end * k / SAMPLES;
    if (k > 0 && mpm_advance(stepper, &go, &now)) goto failed;
    past.t[k] = now.t;
    past.kinetic[k] = now.kinetic_energy;
    past.strain[k] = now.strain_energy;
    past.total[k] = now.kinetic_energy + now.strain_energy;
    const double momentum = hypot(now.momentum[0], now.momentum[1]),
                 change = past.total[k] / past.total[0] - 1.0;
    momentum_max = fmax(momentum_max, momentum);
    if (fabs(change) > fabs(drift)) drift = change;
    if (past.kinetic[k] < past.kinetic[slowest]) slowest = k;
    if (past.strain[k] > past.strain[tightest]) {
      tightest = k;
      if (snapshot_take(&closest, disks, now.t)) goto failed;
    }
    fprintf(csv, "%.4f,%.9e,%.9e,%.9e,%.3e,%.3e\n", past.t[k], past.kinetic[k], past.strain[k], past.total[k],
            now.momentum[0], now.momentum[1]);
    if (k % ROW_EVERY == 0)
      printf("%6.2f %11.6f %11.6f %11.6f %14.1e\n", past.t[k], past.kinetic[k], past.strain[k], past.total[k],
             momentum);
    if (k % FILE_EVERY == 0) {
      static const char *const fields[] = {"velocity", "stress", "deformation_gradient"};
      char name[32];
      snprintf(name, sizeof name, "particles_%04d.vtp", k / FILE_EVERY);
      if (mpm_write_particles(disks, in_directory(directory, name), 3, fields) ||
          mpm_series_append(series, now.t, name))
        goto failed;
      progress(&now);
    }
  }
  fprintf(stderr, "\n");

  double back[2];
  if (snapshot_take(&end, disks, now.t) || mpm_series_close(series)) goto failed;
  disk_mean(&end, 0, end.v, back);
  const snapshot shot[3] = {start, closest, end};
  const int csv_failed = ferror(csv);
  if (fclose(csv) || csv_failed || draw_disks(in_directory(directory, "two_disks.svg"), shot) ||
      draw_energies(in_directory(directory, "two_disks_energy.svg"), &past)) {
    fprintf(stderr, "two_disks: cannot write into %s\n", directory);
    return 1;
  }
  free(start.x);
  free(closest.x);
  free(end.x);
  if (mpm_stepper_destroy(stepper) || mpm_particles_destroy(disks) || mpm_material_destroy(rubber) ||
      mpm_grid_destroy(grid) || mpm_context_destroy(ctx))
    goto failed;

  printf("\nwritten to %s: two_disks.pvd with particles_*.vtp (open in ParaView), energy.csv,\n"
         "two_disks.svg, two_disks_energy.svg\n",
         directory);
  printf("result: least kinetic energy %.4f J at t = %.2f s, rebound speed %.4f m/s (FEM 0.1286), "
         "energy drift %+.2f %%, momentum at most %.0e\n",
         past.kinetic[slowest], past.t[slowest], hypot(back[0], back[1]), 100.0 * drift, momentum_max);
  return 0;

failed:
  fprintf(stderr, "\ntwo_disks: %s\n", mpm_last_error(ctx));
  return 1;
}
