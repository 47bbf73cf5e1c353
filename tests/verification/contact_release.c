/* The block of sliding.h on a slope of 30 degrees, stuck there by friction 10 and let go with friction 0.7,
 * beside finite elements of our own: how far an elastic block without damping goes until it rests, or whether
 * it does. */
#include "sliding.h"

enum { ELEMENT = 8, SETTLING = 2000 };
static const double width = 0.8, height = 0.4, density = 1000.0, young = 1e6, poisson = 0.3;

/* ---- elements: bilinear, small strain, lumped mass, contact at the nodes of the lower face ------------- */
typedef struct mesh {
  int32_t cells[2]; /* each square */
  double h, stiffness[ELEMENT][ELEMENT], *mass, *moved, *velocity, *force;
} mesh;

static int32_t node_of(const mesh *m, int32_t i, int32_t j) {
  return j * (m->cells[0] + 1) + i;
}

/* Nodes of an element go round: corner k lies at (right[k], upper[k]). */
static const int32_t right[4] = {0, 1, 1, 0}, upper[4] = {0, 0, 1, 1};

static void stiffen(mesh *m) {
  const double shear = 0.5 * young / (1.0 + poisson);
  const double lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), wave = lame + 2.0 * shear;
  const double D[3][3] = {{wave, lame, 0.0}, {lame, wave, 0.0}, {0.0, 0.0, shear}};
  for (int32_t point = 0; point < 4; ++point) {
    const double x = (right[point] ? 1.0 : -1.0) / sqrt(3.0), y = (upper[point] ? 1.0 : -1.0) / sqrt(3.0);
    double B[3][ELEMENT] = {{0.0}};
    for (int32_t k = 0; k < 4; ++k) {
      const double sx = right[k] ? 1.0 : -1.0, sy = upper[k] ? 1.0 : -1.0;
      const double dx = 0.5 * sx * (1.0 + sy * y) / m->h, dy = 0.5 * sy * (1.0 + sx * x) / m->h;
      B[0][2 * k] = B[2][2 * k + 1] = dx;
      B[1][2 * k + 1] = B[2][2 * k] = dy;
    }
    for (int32_t i = 0; i < ELEMENT; ++i)
      for (int32_t j = 0; j < ELEMENT; ++j)
        for (int32_t p = 0; p < 3; ++p)
          for (int32_t q = 0; q < 3; ++q)
            m->stiffness[i][j] += B[p][i] * D[p][q] * B[q][j] * 0.25 * m->h * m->h;
  }
}

static mesh mesh_open(int32_t across) {
  mesh m = {.cells = {2 * across, across}, .h = height / across};
  const size_t nodes = (size_t)(m.cells[0] + 1) * (size_t)(m.cells[1] + 1);
  m.mass = calloc(7 * nodes, sizeof *m.mass);
  if (!m.mass) exit(2);
  m.moved = m.mass + nodes;
  m.velocity = m.moved + 2 * nodes;
  m.force = m.velocity + 2 * nodes;
  stiffen(&m);
  for (int32_t j = 0; j < m.cells[1]; ++j)
    for (int32_t i = 0; i < m.cells[0]; ++i)
      for (int32_t k = 0; k < 4; ++k)
        m.mass[node_of(&m, i + right[k], j + upper[k])] += 0.25 * density * m.h * m.h;
  return m;
}

/* Forces are those of the strain, and of its rate by so many seconds. */
static void find_forces(mesh *m, double seconds) {
  const int32_t nodes = (m->cells[0] + 1) * (m->cells[1] + 1);
  for (int32_t i = 0; i < 2 * nodes; ++i) m->force[i] = 0.0;
  for (int32_t j = 0; j < m->cells[1]; ++j)
    for (int32_t i = 0; i < m->cells[0]; ++i) {
      int32_t at[ELEMENT];
      double strained[ELEMENT];
      for (int32_t k = 0; k < ELEMENT; ++k) {
        at[k] = 2 * node_of(m, i + right[k / 2], j + upper[k / 2]) + k % 2;
        strained[k] = m->moved[at[k]] + seconds * m->velocity[at[k]];
      }
      for (int32_t k = 0; k < ELEMENT; ++k)
        for (int32_t l = 0; l < ELEMENT; ++l) m->force[at[k]] -= m->stiffness[k][l] * strained[l];
    }
}

static void step(mesh *m, double dt, double friction, double seconds, double keeps) {
  const int32_t nodes = (m->cells[0] + 1) * (m->cells[1] + 1);
  const double gravity[2] = {slide_gravity * sin(PI / 6.0), -slide_gravity * cos(PI / 6.0)};
  find_forces(m, seconds);
  for (int32_t n = 0; n < nodes; ++n) {
    double *v = m->velocity + 2 * n;
    for (int32_t c = 0; c < 2; ++c) v[c] += dt * (m->force[2 * n + c] / m->mass[n] + gravity[c]);
    const double gap = m->moved[2 * n + 1], push = -(v[1] + fmax(gap, 0.0) / dt);
    if (n <= m->cells[0] && push > 0.0) {
      v[1] += push;
      v[0] -= copysign(fmin(fabs(v[0]), friction * push), v[0]);
    }
    for (int32_t c = 0; c < 2; ++c) m->moved[2 * n + c] += dt * (v[c] *= keeps);
  }
}

static double way_of(const mesh *m) {
  const int32_t nodes = (m->cells[0] + 1) * (m->cells[1] + 1);
  double way = 0.0;
  for (int32_t n = 0; n < nodes; ++n) way += m->mass[n] * m->moved[2 * n] / (density * width * height);
  return way;
}

/* Returns the way in half a second of a block that settled as that of slide_run() does. */
static double finite_elements(int32_t across, double keeps, double push, double seconds) {
  mesh m = mesh_open(across);
  const double speed = sqrt(young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson) * density));
  const double dt = 0.4 * m.h / speed;
  for (int32_t i = 0; i < SETTLING; ++i) step(&m, dt, 10.0, seconds, i < SETTLING * 4 / 5 ? keeps : 0.95);
  const double start = way_of(&m);
  for (int32_t n = 0; n < (m.cells[0] + 1) * (m.cells[1] + 1); ++n) m.velocity[2 * n] += push;
  for (double t = 0.0; t < 0.5; t += dt) step(&m, dt, 0.7, seconds, 1.0);
  const double way = way_of(&m) - start;
  free(m.mass);
  return way;
}

/* ---- the block ----------------------------------------------------------------------------------------- */
static const double gently = 0.96, roughly = 0.99, viscous = 1e-4; /* the last: seconds */
static const char *const source = "own finite elements";

static double block(int32_t basis, double place, double keeps, double push) {
  return slide_run(&(slide){.support = ON_BODY,
                            .basis = basis,
                            .settled = 1,
                            .keeps = keeps,
                            .push = push,
                            .h = 0.05,
                            .angle = PI / 6.0,
                            .friction = 0.7,
                            .shift = place,
                            .end = 0.5})
      .way;
}

/* What a rigid block does that is pushed. */
static double rigid(double push) {
  return 0.5 * push * push / (slide_gravity * (0.7 * cos(PI / 6.0) - sin(PI / 6.0)));
}

/* Returns the way of a block with little viscosity that is pushed by 0.05 (0), or 0.1 (1). In small this is
 * of the coarse elements, and nothing is said of them. */
static void judge_elements(FILE *table, double *way) {
  static const double push[2] = {0.05, 0.1};
  for (int32_t k = 0; k < 2 && verify_quick(); ++k) way[k] = finite_elements(8, gently, push[k], viscous);
  if (verify_quick()) return;
  const double rough[2] = {finite_elements(8, roughly, 0.0, 0.0), finite_elements(16, roughly, 0.0, 0.0)};
  const double calm = finite_elements(16, gently, 0.0, 0.0);
  verify_judge("elements, h = 1/20, let go while it swings: creep, m", rough[0], 1e-3, 2e-3, source, NULL);
  verify_judge("elements, h = 1/40, let go while it swings: creep, m", rough[1], 1e-3, 2e-3, source, NULL);
  verify_judge("elements, h = 1/40, settled: creep, m", calm, 0.0, 1e-3, source, NULL);
  fprintf(table, "elements,0,0,%.6f\n", calm);
  for (int32_t k = 0; k < 2; ++k) {
    char what[120];
    const double coarse = finite_elements(8, gently, push[k], viscous);
    way[k] = finite_elements(16, gently, push[k], viscous);
    snprintf(what, sizeof what, "elements, pushed by %g: way, h = 1/20 over h = 1/40", push[k]);
    verify_judge(what, coarse / way[k], 0.95, 1.05, "they converge", NULL);
    snprintf(what, sizeof what, "elements, pushed by %g: way / that of a rigid block", push[k]);
    verify_judge(what, way[k] / rigid(push[k]), k ? 10.0 : 1.0, k ? 20.0 : 2.0, source, NULL);
    fprintf(table, "elements,0,%g,%.6f\n", push[k], way[k]);
  }
}

static void judge_block(FILE *table, const char *name, int32_t basis, double place, const double *elements) {
  const char *light =
      basis == MPM_LINEAR && place > 0.2 && place < 0.25
          ? "the one row that is bound has half a node's mass there, and the block lifts off earlier"
          : NULL;
  char what[120];
  const double settled = block(basis, place, gently, 0.0), pushed = block(basis, place, gently, 0.05);
  snprintf(what, sizeof what, "%s, floor at %g h: settled, creep in 0.5 s, m", name, place);
  verify_judge(what, fabs(settled), 0.0, 5e-4, "Coulomb's law; set tolerance", NULL);
  snprintf(what, sizeof what, "%s, floor at %g h: pushed by 0.05, way / elements'", name, place);
  verify_judge(what, pushed / elements[0], 0.75, 1.5, "own finite elements; set tolerance", light);
  fprintf(table, "%s,%g,0,%.6f\n%s,%g,0.05,%.6f\n", name, place, settled, name, place, pushed);
  if (basis == MPM_LINEAR) {
    const double hops = block(basis, place, gently, 0.1);
    snprintf(what, sizeof what, "%s, floor at %g h: pushed by 0.1, way / elements'", name, place);
    verify_judge(what, hops / elements[1], 0.7, 1.6, "own finite elements; set tolerance", NULL);
    fprintf(table, "%s,%g,0.1,%.6f\n", name, place, hops);
  }
  verify_progress("%s, at %g h", name, place);
}

int main(int argc, char **argv) {
  verify_begin("contact_release", argc, argv);
  FILE *table = verify_csv("contact_release");
  fprintf(table, "name,shift,push,way\n");
  double elements[2];
  judge_elements(table, elements);
  static const double place[5] = {0.02, 0.1, 0.24, 0.5, 0.9};
  static const int32_t basis[4] = {MPM_LINEAR, MPM_BSPLINE2, MPM_BSPLINE3, MPM_GIMP};
  for (int32_t b = 0; b < (verify_quick() ? 2 : 4); ++b)
    for (int32_t k = 0; k < (verify_quick() ? 1 : 5); ++k)
      judge_block(table, slide_basis(basis[b]), basis[b], place[k], elements);
  fclose(table);
  return verify_end();
}
