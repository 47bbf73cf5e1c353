/* Two elastic disks fly at each other, collide and rebound (Sulsky, Chen and Schreyer, 1994): as two bodies,
 * which touch when they meet, and once more in one body, where they feel each other through the grid before.
 *
 *   two_disks [directory]
 *
 * prints the energies and writes into the directory (default: here), of the two bodies particles for ParaView
 * (two_disks.pvd) and the history (energy.csv), and pictures of the disks (two_disks.svg) and of the energies
 * (two_disks_energy.svg). */
#include <mpm/mpm.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "svg.h"

enum { SAMPLES = 360, ROW_EVERY = 20, FILE_EVERY = 10, SHOTS = 3, BEFORE = 150 };
static const double t_end = 3.6, speed = 0.1, h = 1.0 / 40.0;

static const char *in_directory(const char *directory, const char *name) {
  static char path[1024];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  return path;
}

/* What a picture needs; arrays are [components][n], by ascending id. */
typedef struct disk {
  int64_t n;
  double *x, *v, *F, *stress;
} disk;
typedef struct snapshot {
  double t;
  disk disk[2];
} snapshot;

static int snapshot_create(snapshot *s, mpm_particles *const set[2]) {
  for (int k = 0; k < 2; ++k) {
    disk *d = &s->disk[k];
    const int64_t n = d->n = mpm_particles_count(set[k]);
    if (!(d->x = malloc((2 + 2 + 9 + 6) * (size_t)n * sizeof *d->x))) return -1;
    d->v = d->x + 2 * n;
    d->F = d->v + 2 * n;
    d->stress = d->F + 9 * n;
  }
  return 0;
}

static mpm_status snapshot_take(snapshot *s, mpm_particles *const set[2], double t) {
  mpm_status status = MPM_OK;
  s->t = t;
  for (int k = 0; k < 2 && !status; ++k) {
    const disk *d = &s->disk[k];
    if ((status = mpm_particles_get(set[k], "position", MPM_F64, 2, d->n, NULL, d->x)) ||
        (status = mpm_particles_get(set[k], "velocity", MPM_F64, 2, d->n, NULL, d->v)) ||
        (status = mpm_particles_get(set[k], "deformation_gradient", MPM_F64, 9, d->n, NULL, d->F)))
      return status;
    status = mpm_particles_get(set[k], "stress", MPM_F64, 6, d->n, NULL, d->stress);
  }
  return status;
}

/* Mean over a disk; its particles have equal masses, so this is also the mean by mass. */
static void disk_mean(const disk *d, const double *value, double out[2]) {
  out[0] = out[1] = 0.0;
  for (int64_t i = 0; i < d->n; ++i)
    for (int c = 0; c < 2; ++c) out[c] += value[c * d->n + i] / (double)d->n;
}

static double mises(const disk *d, int64_t i) {
  const double *c = d->stress + i; /* xx yy zz xy yz xz */
  const int64_t n = d->n;
  const double xy = c[0] - c[n], yz = c[n] - c[2 * n], zx = c[2 * n] - c[0];
  const double shear = c[3 * n] * c[3 * n] + c[4 * n] * c[4 * n] + c[5 * n] * c[5 * n];
  return sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * shear);
}

static const double stress_shown = 300.0; /* only the few particles in the contact go beyond */

/* A particle is the deformed image of a square of half a cell; the arrow is the mean velocity. */
static int draw_disk(FILE *out, const svg_frame *f, const disk *d) {
  double *value = malloc(5 * (size_t)d->n * sizeof *value), x[2], v[2];
  if (!value) return -1;
  double *a = value + d->n, *b = a + 2 * d->n;
  for (int64_t i = 0; i < d->n; ++i) value[i] = mises(d, i);
  svg_edges(d->n, 0.5 * h, d->F, 0, a);
  svg_edges(d->n, 0.5 * h, d->F, 1, b);
  svg_tiles(out, f, d->n, d->x, a, b, value, stress_shown);
  disk_mean(d, d->x, x);
  disk_mean(d, d->v, v);
  svg_arrow(out, f, x[0], x[1], 400.0 * v[0], -400.0 * v[1], "#ffffff");
  free(value);
  return 0;
}

/* A row for each collision. */
static int draw_disks(const char *path, const snapshot shot[2][SHOTS]) {
  static const char *const caption[SHOTS] = {"before they meet", "largest strain energy",
                                             "after the rebound"};
  static const char *const row[2] = {"as two bodies", "in one body"};
  FILE *out = svg_open(path, 960, 748);
  int failed = 0;
  for (int r = 0; r < 2; ++r)
    for (int k = 0; k < SHOTS; ++k) {
      const snapshot *s = &shot[r][k];
      const svg_frame f = {20.0 + 310.0 * k, 44.0 + 334.0 * r, 300.0, 290.0, 0.0, 1.0, 0.0, 290.0 / 300.0};
      char text[160];
      snprintf(text, sizeof text, "<tspan font-weight=\"bold\">%s%st = %.2f s</tspan> &#160;%s",
               k ? "" : row[r], k ? "" : ", ", s->t, caption[k]);
      svg_text(out, f.left + 150.0, f.top - 14.0, "middle", "", text);
      svg_panel(out, &f);
      for (int d = 0; d < 2; ++d) failed |= draw_disk(out, &f, &s->disk[d]);
    }
  svg_colour_bar(out, 320.0, 708.0, 320.0, stress_shown, "von Mises stress / Pa (300 and more)");
  return svg_close(out) || failed ? -1 : 0;
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

/* A collision; where it is written to, or NULL. */
typedef struct collision {
  mpm_particles *set[2];
  mpm_stepper *stepper;
  mpm_series *series;
  FILE *csv;
} collision;

static mpm_status write_files(const collision *c, const char *directory, int k, double t) {
  static const char *const fields[] = {"velocity", "stress", "deformation_gradient"};
  mpm_status status = MPM_OK;
  for (int d = 0; d < 2 && !status; ++d) {
    char name[32];
    snprintf(name, sizeof name, "disk_%c_%04d.vtp", 'a' + d, k / FILE_EVERY);
    status = mpm_write_particles(c->set[d], in_directory(directory, name), 3, fields);
    if (!status) status = mpm_series_append(c->series, t, name);
  }
  return status;
}

/* The numbers of the result line. */
typedef struct outcome {
  double least_kinetic, when, rebound, drift, momentum;
} outcome;

static mpm_status run(const collision *c, const char *directory, history *past, snapshot shot[SHOTS],
                      outcome *out) {
  mpm_step_info now = {.struct_size = sizeof now};
  mpm_advance_desc go;
  mpm_status status = mpm_advance_desc_init(&go, sizeof go);
  if (!status) status = mpm_stepper_info(c->stepper, &now);
  go.cfl = 0.4;
  *out = (outcome){.least_kinetic = HUGE_VAL};
  double most_strain = -1.0;
  for (int k = 0; k <= SAMPLES && !status; ++k) {
    go.t_end = t_end * k / SAMPLES;
    if (k > 0 && (status = mpm_advance(c->stepper, &go, &now))) break;
    past->t[k] = now.t;
    past->kinetic[k] = now.kinetic_energy;
    past->strain[k] = now.strain_energy;
    past->total[k] = now.kinetic_energy + now.strain_energy;
    const double momentum = hypot(now.momentum[0], now.momentum[1]),
                 change = past->total[k] / past->total[0] - 1.0;
    out->momentum = fmax(out->momentum, momentum);
    if (fabs(change) > fabs(out->drift)) out->drift = change;
    if (past->kinetic[k] < out->least_kinetic) out->least_kinetic = past->kinetic[k], out->when = now.t;
    if (k == BEFORE) status = snapshot_take(&shot[0], c->set, now.t);
    if (!status && past->strain[k] > most_strain) {
      most_strain = past->strain[k];
      status = snapshot_take(&shot[1], c->set, now.t);
    }
    if (!c->csv) continue;
    fprintf(c->csv, "%.4f,%.9e,%.9e,%.9e,%.3e,%.3e\n", past->t[k], past->kinetic[k], past->strain[k],
            past->total[k], now.momentum[0], now.momentum[1]);
    if (k % ROW_EVERY == 0)
      printf("%6.2f %11.6f %11.6f %11.6f %14.1e\n", past->t[k], past->kinetic[k], past->strain[k],
             past->total[k], momentum);
    if (k % FILE_EVERY == 0 && !status) {
      status = write_files(c, directory, k, now.t);
      progress(&now);
    }
  }
  if (!status) status = snapshot_take(&shot[2], c->set, now.t);
  double back[2];
  disk_mean(&shot[2].disk[0], shot[2].disk[0].v, back);
  out->rebound = hypot(back[0], back[1]);
  return status;
}

/* Makes the disks and their stepper; with `bodies` each is one of its own. */
static mpm_status set_up(mpm_context *ctx, mpm_grid *grid, mpm_material *rubber, int bodies, collision *c) {
  static const double centre[2][2] = {{0.2, 0.2}, {0.8, 0.8}};
  static const int32_t per_cell[] = {2, 2};
  mpm_stepper_desc s;
  mpm_status status = mpm_stepper_desc_init(&s, sizeof s);
  s.scheme = MPM_MUSL;
  s.transfer = MPM_FLIP;
  s.projected_positions = 1; /* keeps as much energy, and nothing grows where the disks are stretched */
  if (!status) status = mpm_stepper_create(ctx, grid, &s, &c->stepper);
  for (int d = 0; d < 2 && !status; ++d) {
    const double v[2] = {d ? -speed : speed, d ? -speed : speed};
    if ((status = mpm_particles_create(ctx, grid, rubber, &c->set[d])) ||
        (status = mpm_particles_fill_ball(c->set[d], centre[d], 0.2, per_cell, NULL, NULL)) ||
        (status = mpm_particles_set_all(c->set[d], "velocity", MPM_F64, 2, v)) ||
        (status = mpm_stepper_add(c->stepper, c->set[d])))
      return status;
    if (bodies) status = mpm_stepper_set_body(c->stepper, c->set[d], d);
  }
  return status;
}

static mpm_status take_down(collision *c) {
  mpm_status status = mpm_stepper_destroy(c->stepper);
  for (int d = 0; d < 2 && !status; ++d) status = mpm_particles_destroy(c->set[d]);
  return status;
}

static void say(const char *which, const outcome *o) {
  printf("%s: least kinetic energy %.4f J at t = %.2f s, rebound speed %.4f m/s (FEM 0.1286), "
         "energy drift %+.2f %%, momentum at most %.0e\n",
         which, o->least_kinetic, o->when, o->rebound, 100.0 * o->drift, o->momentum);
}

int main(int argc, char **argv) {
  const char *directory = argc > 1 ? argv[1] : ".";
  mpm_context *ctx = NULL;
  mpm_grid *grid;
  mpm_material *rubber;
  mpm_grid_desc g;
  if (mpm_context_create(NULL, &ctx) || mpm_grid_desc_init(&g, sizeof g)) goto failed;

  /* The disks touch the unit box at the start: the grid is two cells wider on every side. */
  g.dim = 2;
  g.basis = MPM_BSPLINE2;
  for (int c = 0; c < 2; ++c) {
    g.cells[c] = 44;
    g.spacing[c] = h;
    g.origin[c] = -2.0 * h;
  }
  const mpm_param elastic[] = {{"E", 1000.0}, {"nu", 0.3}, {"density", 1000.0}};
  if (mpm_grid_create(ctx, &g, &grid) || mpm_material_create(ctx, "neo_hookean", elastic, 3, &rubber))
    goto failed;

  static history past[2];
  static snapshot shot[2][SHOTS];
  outcome out[2];
  for (int one = 0; one < 2; ++one) {
    collision c = {.csv = NULL};
    if (set_up(ctx, grid, rubber, !one, &c)) goto failed;
    for (int k = 0; k < SHOTS; ++k)
      if (snapshot_create(&shot[one][k], c.set)) {
        fprintf(stderr, "two_disks: out of memory\n");
        return 1;
      }
    if (!one) {
      if (mpm_series_open(ctx, in_directory(directory, "two_disks.pvd"), &c.series)) goto failed;
      if (!(c.csv = fopen(in_directory(directory, "energy.csv"), "w"))) {
        fprintf(stderr, "two_disks: cannot write into %s\n", directory);
        return 1;
      }
      printf("Two elastic disks, %" PRId64 " particles, cells of 1/40 m\n\n", 2 * shot[0][0].disk[0].n);
      printf("   t/s   kinetic/J    strain/J     total/J   |momentum|/(kg m/s)\n");
      fprintf(c.csv, "t,kinetic,strain,total,momentum_x,momentum_y\n");
    }
    if (run(&c, directory, &past[one], shot[one], &out[one])) goto failed;
    if (!one) {
      const int csv_failed = ferror(c.csv);
      if (mpm_series_close(c.series)) goto failed;
      if (fclose(c.csv) || csv_failed) {
        fprintf(stderr, "two_disks: cannot write into %s\n", directory);
        return 1;
      }
      fprintf(stderr, "\n");
    }
    if (take_down(&c)) goto failed;
  }
  if (draw_disks(in_directory(directory, "two_disks.svg"), (const snapshot(*)[SHOTS])shot) ||
      draw_energies(in_directory(directory, "two_disks_energy.svg"), &past[0])) {
    fprintf(stderr, "two_disks: cannot write into %s\n", directory);
    return 1;
  }
  for (int r = 0; r < 2; ++r)
    for (int k = 0; k < SHOTS; ++k)
      for (int d = 0; d < 2; ++d) free(shot[r][k].disk[d].x);
  if (mpm_material_destroy(rubber) || mpm_grid_destroy(grid) || mpm_context_destroy(ctx)) goto failed;

  printf("\nwritten to %s: two_disks.pvd with disk_*.vtp (open in ParaView), energy.csv,\n"
         "two_disks.svg, two_disks_energy.svg\n",
         directory);
  say("in one body", &out[1]);
  say("result", &out[0]);
  return 0;

failed:
  fprintf(stderr, "\ntwo_disks: %s\n", mpm_last_error(ctx));
  return 1;
}
