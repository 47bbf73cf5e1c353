/* Steffen et al. 2008, fig. 7 and section 4.3: how far a body of constant density 1 on [0, 1] reaches on the
 * grid, by basis, and what of its mass lies on nodes outside a boundary that is aligned with the grid. */
#include "verify.h"

enum { CELLS = 10, PER_CELL = 4, MARGIN = 4, BASES = 6, OFFSETS = 32 };

typedef struct basis {
  const char *name;
  int32_t kind, boundary;
  double half_width, length; /* over h; length: of the domains of GIMP */
} basis;

static const double h = 1.0 / CELLS, smoothing = 0.5;
static const basis bases[BASES] = {
    {"linear", MPM_LINEAR, 0, 1.0, 0.0},
    {"quadratic", MPM_BSPLINE2, 0, 1.5, 0.0},
    {"cubic", MPM_BSPLINE3, 0, 2.0, 0.0},
    {"uGIMP, l = h/2", MPM_UGIMP, 0, 1.25, 0.5},
    {"cpGIMP", MPM_CPGIMP, 0, 1.0 + 0.5 / PER_CELL, 1.0 / PER_CELL},
    {"quadratic, open knots", MPM_BSPLINE2, 1, 0.0, 0.0},
};

/* Basis function of a node, r cells from it: eqs 17, 21 and 29 of the source, and the cubic B-spline. */
static double shape(const basis *b, double r) {
  const double s = fabs(r), l = b->length;
  if (s >= b->half_width) return 0.0;
  if (b->kind == MPM_LINEAR) return 1.0 - s;
  if (b->kind == MPM_BSPLINE2) return s < 0.5 ? 0.75 - s * s : 0.5 * (1.5 - s) * (1.5 - s);
  if (b->kind == MPM_BSPLINE3)
    return s < 1.0 ? 2.0 / 3.0 - s * s * (1.0 - 0.5 * s) : (2.0 - s) * (2.0 - s) * (2.0 - s) / 6.0;
  if (s < 0.5 * l) return 1.0 - (4.0 * s * s + l * l) / (4.0 * l);
  return s < 1.0 - 0.5 * l ? 1.0 - s : (1.0 + 0.5 * l - s) * (1.0 + 0.5 * l - s) / (2.0 * l);
}

/* What the particles give to the nodes below 0, over rho h. */
static double outer_mass(const basis *b) {
  double sum = 0.0;
  for (int32_t p = 0; p < CELLS * PER_CELL; ++p)
    for (int32_t i = 1; i <= MARGIN; ++i) sum += shape(b, (p + 0.5) / PER_CELL + i) / PER_CELL;
  return sum;
}

/* The body's lower end is `offset` cells above a node. Returns the distance of the lowest node with mass from
 * it, and the mass on nodes below; nodes[i] tells which of the nodes -MARGIN ... CELLS + MARGIN have mass. */
static double project(const basis *b, double offset, double *mass_below, uint8_t *nodes) {
  const int32_t margin = b->boundary ? 0 : MARGIN; /* open knots end at the body's ends */
  verify_setup setup = verify_defaults(1, CELLS + 2 * margin, h);
  setup.grid.basis = b->kind;
  setup.grid.boundary_basis = b->boundary;
  setup.grid.smoothing = smoothing;
  setup.grid.origin[0] = -margin * h;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", 1.0, 0.0, 1.0));
  double x[CELLS * PER_CELL], volume[CELLS * PER_CELL];
  for (int32_t p = 0; p < CELLS * PER_CELL; ++p)
    x[p] = (offset + (p + 0.5) / PER_CELL) * h, volume[p] = h / PER_CELL;
  verify_ok(&w, mpm_particles_add(set, CELLS * PER_CELL, x, NULL, volume, NULL, NULL, NULL));
  mpm_view mass = {.struct_size = sizeof mass}, position = mass;
  verify_ok(&w, mpm_step_begin(w.stepper, 1e-6));
  verify_ok(&w, mpm_grid_map(w.stepper, 0, "mass", MPM_READ, &mass));
  verify_ok(&w, mpm_grid_map(w.stepper, 0, "position", MPM_READ, &position));
  double lowest = 0.0;
  *mass_below = 0.0;
  for (int64_t i = 0; i < mass.count; ++i) {
    const double m = ((const double *)mass.data)[i * mass.item_stride],
                 at = ((const double *)position.data)[i * position.item_stride];
    if (m <= 1e-14) continue;
    lowest = fmin(lowest, at - offset * h);
    if (at < -1e-9) *mass_below += m;
    if (nodes && !b->boundary) nodes[lround(at / h) + MARGIN] = 1;
  }
  verify_ok(&w, mpm_view_release(&mass));
  verify_ok(&w, mpm_view_release(&position));
  verify_ok(&w, mpm_step_abort(w.stepper));
  verify_close(&w);
  return -lowest;
}

/* rho(x) = sum rho_i phi_i(x), where rho_i, mass over volume of a node, is 1 on every node with mass. */
static void write_fields(uint8_t nodes[BASES][CELLS + 2 * MARGIN + 1]) {
  FILE *csv = verify_csv("boundary_density");
  fprintf(csv, "x,exact,%s,%s,%s", bases[0].name, bases[1].name, bases[2].name);
  for (int32_t k = -80; k <= CELLS * 20 + 80; ++k) {
    const double x = k / 20.0;
    fprintf(csv, "\n%.4g,%d", x * h, x >= 0.0 && x <= CELLS);
    for (int32_t b = 0; b < 3; ++b) {
      double density = 0.0;
      for (int32_t i = 0; i <= CELLS + 2 * MARGIN; ++i)
        density += nodes[b][i] * shape(&bases[b], x - (i - MARGIN));
      fprintf(csv, ",%.5g", density);
    }
  }
  fputc('\n', csv);
  fclose(csv);
}

int main(int argc, char **argv) {
  verify_begin("boundary_density", argc, argv);
  const char *section = "Steffen et al. 2008, section 4.3";
  uint8_t nodes[BASES][CELLS + 2 * MARGIN + 1] = {{0}};
  char what[80];
  for (int32_t i = 0; i < BASES; ++i) {
    const basis *b = &bases[i];
    double mass, ignored, reach = 0.0;
    project(b, 0.0, &mass, nodes[i]);
    snprintf(what, sizeof what, "aligned: mass on outer nodes / (rho h), %s", b->name);
    verify_gate(what, mass / h, outer_mass(b) - 1e-12, outer_mass(b) + 1e-12,
                "basis functions at the particles");
    if (b->boundary) continue;
    for (int32_t k = 0; k < OFFSETS; ++k)
      reach = fmax(reach, project(b, (double)k / OFFSETS, &ignored, NULL));
    /* the first particle is half a width inside; the offsets are 1 / OFFSETS apart */
    const double farthest = b->half_width - 0.5 / PER_CELL;
    snprintf(what, sizeof what, "reach / h of the grid beyond the body, any offset, %s", b->name);
    verify_gate(what, reach / h, farthest - 1.5 / OFFSETS, farthest + 1e-9, section);
  }
  write_fields(nodes);
  return verify_end();
}
