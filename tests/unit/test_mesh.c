/* Bodies in meshes: which lattice points a mesh winds round, beside direct sums and shapes that are known. */
#include "particles/mesh.h"
#include "sets.h"

static world w;

enum { MOST = 40000 };

/* A mesh that tests put together. Points are [MOST][3] here, and [dim][n] for the library. */
typedef struct shape {
  int32_t dim;
  int64_t points, elements;
  double at[MOST][3], position[3 * MOST];
  int64_t corner[3 * MOST];
} shape;
static shape s, one;

static void start(shape *of, int32_t dim) {
  of->dim = dim;
  of->points = of->elements = 0;
}

static int64_t point(shape *of, double x, double y, double z) {
  ck_assert_int_lt(of->points, MOST);
  of->at[of->points][0] = x;
  of->at[of->points][1] = y;
  of->at[of->points][2] = z;
  return of->points++;
}

static void element(shape *of, int64_t a, int64_t b, int64_t c) {
  int64_t *to = of->corner + of->dim * of->elements++;
  ck_assert_int_lt(of->elements, MOST);
  to[0] = a;
  to[1] = b;
  if (of->dim == 3) to[2] = c;
}

static void turn_elements(shape *of, int64_t from) {
  for (int64_t e = from; e < of->elements; ++e) {
    int64_t *c = of->corner + of->dim * e, first = c[0];
    c[0] = c[1];
    c[1] = first;
  }
}

/* Two triangles a face, every one with corners of its own, as files of triangles have them. */
static void add_box(shape *of, const double *lower, const double *upper) {
  static const int face[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                 {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
  for (int f = 0; f < 6; ++f)
    for (int half = 0; half < 2; ++half) {
      int64_t p[3];
      for (int j = 0; j < 3; ++j) {
        const int v = face[f][j == 0 ? 0 : j + half];
        p[j] = point(of, (v & 1 ? upper : lower)[0], (v & 2 ? upper : lower)[1], (v & 4 ? upper : lower)[2]);
      }
      element(of, p[0], p[2], p[1]);
    }
}

/* A torus round z, of n x m quadrilaterals; as a knot's surface winds, no axis is special to it. */
static void add_torus(shape *of, int n, int m, double R, double r, const double *centre) {
  const int64_t first = of->points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double a = 2.0 * acos(-1.0) * i / n, b = 2.0 * acos(-1.0) * (j + 0.3) / m;
      const double along = R + r * cos(b), x = along * cos(a), y = along * sin(a), z = r * sin(b);
      point(of, centre[0] + 0.8 * x - 0.6 * z, centre[1] + y, centre[2] + 0.6 * x + 0.8 * z);
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int64_t p = first + i * m + j, q = first + (i + 1) % n * m + j, u = first + i * m + (j + 1) % m,
                    v = first + (i + 1) % n * m + (j + 1) % m;
      element(of, p, q, v);
      element(of, p, v, u);
    }
}

static void add_polygon(shape *of, int n, const double (*corner)[2]) {
  for (int i = 0; i < n; ++i) {
    const int64_t from = point(of, corner[i][0], corner[i][1], 0.0);
    element(of, from, point(of, corner[(i + 1) % n][0], corner[(i + 1) % n][1], 0.0), 0);
  }
}

static void lay_out(shape *of, double scale) {
  for (int64_t i = 0; i < of->points; ++i)
    for (int32_t k = 0; k < of->dim; ++k) of->position[k * of->points + i] = scale * of->at[i][k];
}

static void open_grid(int32_t dim, int64_t cells, double spacing) {
  mpm_grid_desc grid = grid_desc(dim, cells, spacing);
  sets_open_on(&w, &grid, "linear_elastic", 0);
}

static int64_t filled(shape *of, int32_t per_cell) {
  const int32_t per[] = {per_cell, per_cell, per_cell};
  int64_t first = -1, count = -1, before = mpm_particles_count(w.set[0]);
  lay_out(of, 1.0);
  ck_ok(&w, mpm_particles_fill_mesh(w.set[0], of->points, of->position, of->elements, of->corner, per, &first,
                                    &count));
  ck_assert_int_eq(mpm_particles_count(w.set[0]), before + count);
  if (count) ck_assert_int_eq(first, before);
  return count;
}

/* The winding number by the sum over all elements, in long double and by other formulas: the angle between
 * two directions in 2-D, the spherical excess by its three corner angles in 3-D. */
static double direct(const shape *of, const double *x) {
  long double sum = 0.0L;
  for (int64_t e = 0; e < of->elements; ++e) {
    long double d[3][3];
    for (int32_t j = 0; j < of->dim; ++j) {
      long double length = 0.0L;
      for (int32_t k = 0; k < of->dim; ++k) {
        d[j][k] = (long double)of->at[of->corner[of->dim * e + j]][k] - (long double)x[k];
        length += d[j][k] * d[j][k];
      }
      for (int32_t k = 0; k < of->dim; ++k) d[j][k] /= sqrtl(length);
    }
    if (of->dim == 2) {
      long double turn = atan2l(d[1][1], d[1][0]) - atan2l(d[0][1], d[0][0]);
      if (turn > acosl(-1.0L)) turn -= 2 * acosl(-1.0L);
      if (turn < -acosl(-1.0L)) turn += 2 * acosl(-1.0L);
      sum += turn / (2 * acosl(-1.0L));
      continue;
    }
    const long double volume = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) +
                               d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
                               d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
    if (volume == 0) continue; /* flat, or seen from its plane */
    long double excess = -acosl(-1.0L);
    for (int j = 0; j < 3; ++j) {
      const long double *a = d[j], *b = d[(j + 1) % 3], *c = d[(j + 2) % 3];
      long double ab = 0, ac = 0, bc = 0;
      for (int k = 0; k < 3; ++k) {
        ab += a[k] * b[k];
        ac += a[k] * c[k];
        bc += b[k] * c[k];
      }
      excess += atan2l(fabsl(volume), bc - ab * ac);
    }
    sum += copysignl(excess, volume) / (4 * acosl(-1.0L));
  }
  return (double)sum;
}

/* Numbers in [0, 1) that are the same in each run. */
static double any(uint64_t *seed) {
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(*seed >> 11) * 0x1p-53;
}

/* Patches may be replaced by fans: the sum is that over all elements, in holes' neighbourhoods too. */
static void winding_is_the_sum(const char *name, double wanted) {
  mpmi_mesh mesh;
  lay_out(&s, 1.0);
  ck_ok(&w, mpmi_mesh_open(w.context, s.dim, s.points, s.position, s.elements, s.corner, &mesh));
  ck_assert_int_ge(mesh.patch[0].sides, 0); /* the holes, if any, have a fan */
  ck_assert_int_gt(mesh.sides, 0);
  uint64_t seed = 7;
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    double x[3], scaled[3];
    for (int k = 0; k < 3; ++k) {
      x[k] = 0.2 + 3.6 * any(&seed);
      scaled[k] = x[k] * mesh.scale;
    }
    const double exact = direct(&s, x);
    worst = fmax(worst, fabs(mpmi_mesh_winding(&mesh, scaled) - exact));
    if (wanted == wanted) ck_assert_double_le(fabs(exact - wanted * floor(exact / wanted + 0.5)), 1e-9);
  }
  mpmi_mesh_close(&mesh);
  show("%s: %g from the sum\n", name, worst);
  ck_assert_double_le(worst, 1e-11);
}

START_TEST(fans_for_patches) {
  const double centre[] = {2.0, 2.0, 2.0}, inner[] = {2.1, 2.05, 1.9};
  open_grid(3, 4, 1.0);
  start(&s, 3);
  add_torus(&s, 40, 20, 1.1, 0.5, centre);
  winding_is_the_sum("torus", 1.0);
  turn_elements(&s, 0);
  winding_is_the_sum("inside out", 1.0);
  add_torus(&s, 12, 7, 1.0, 0.4, inner);
  winding_is_the_sum("two", 1.0);
  for (int64_t e = 100; e < 160; ++e) /* a large hole */
    for (int j = 0; j < 3; ++j) s.corner[3 * e + j] = s.corner[3 * e];
  winding_is_the_sum("with a hole", NOT_A_NUMBER);
  open_grid(2, 4, 1.0);
  start(&s, 2);
  double outline[600][2];
  for (int i = 0; i < 600; ++i) {
    const double a = 2.0 * acos(-1.0) * i / 600.0, r = 1.1 + 0.5 * sin(9.0 * a);
    outline[i][0] = 2.0 + r * cos(a);
    outline[i][1] = 2.0 + r * sin(a);
  }
  add_polygon(&s, 600, (const double(*)[2])outline);
  winding_is_the_sum("outline", 1.0);
  s.elements -= 30;
  winding_is_the_sum("open outline", NOT_A_NUMBER);
}
END_TEST

/* A box as a mesh, with corners of its own for each triangle, either way round and at any scale. */
START_TEST(boxes) {
  const double lower[] = {0.6, 1.1, 0.7}, upper[] = {2.4, 2.9, 3.3};
  const int32_t per[] = {3, 2, 1};
  for (int scale = -300; scale <= 300; scale += 150) {
    const double h = ldexp(1.0, scale);
    int64_t wanted, count;
    const double low[] = {h * lower[0], h * lower[1], h * lower[2]},
                 high[] = {h * upper[0], h * upper[1], h * upper[2]};
    open_grid(3, 4, h);
    ck_ok(&w, mpm_particles_fill_box(w.set[0], low, high, per, NULL, &wanted));
    start(&s, 3);
    add_box(&s, lower, upper);
    for (int turned = 0; turned < 2; ++turned, turn_elements(&s, 0)) {
      lay_out(&s, h);
      ck_ok(&w,
            mpm_particles_fill_mesh(w.set[0], s.points, s.position, s.elements, s.corner, per, NULL, &count));
      ck_assert_int_eq(count, wanted);
      for (int64_t id = 0; id < wanted; ++id)
        for (int k = 0; k < 3; ++k) {
          ck_assert_double_eq(sets_get(&w, "position", 3, k, id),
                              sets_get(&w, "position", 3, k, wanted * (1 + turned) + id));
          ck_assert_double_eq(sets_get(&w, "size", 3, k, id),
                              sets_get(&w, "size", 3, k, wanted * (1 + turned) + id));
        }
    }
    sets_check_slots(&w);
  }
}
END_TEST

/* Zeros of both signs are one coordinate, and a mesh may be far larger than the grid. */
START_TEST(zeros_and_giants) {
  const double lower[] = {0.0, 0.0, 0.0}, upper[] = {2.0, 2.0, 2.0}, low[] = {-1e300, -1e300, -1e300},
               high[] = {1e300, 1e300, 1e300};
  mpmi_mesh mesh;
  open_grid(3, 4, 1.0);
  start(&s, 3);
  add_box(&s, lower, upper);
  lay_out(&s, 1.0);
  for (int64_t i = 0; i < 3 * s.points; ++i)
    if (s.position[i] == 0.0) s.position[i] = i % 2 ? 0.0 : -0.0;
  ck_ok(&w, mpmi_mesh_open(w.context, s.dim, s.points, s.position, s.elements, s.corner, &mesh));
  ck_assert_int_eq(mesh.points, 8);
  ck_assert_int_eq(mesh.patch[0].sides, 0);
  mpmi_mesh_close(&mesh);
  start(&s, 3);
  add_box(&s, low, high);
  ck_assert_int_eq(filled(&s, 2), 512);
}
END_TEST

/* Overlaps are filled once, cavities stay empty, and what reaches beyond the grid is left out. */
START_TEST(shells) {
  const double a[] = {0.55, 0.55, 0.55}, b[] = {2.55, 2.55, 2.55}, c[] = {1.55, 1.55, 1.55},
               d[] = {3.55, 3.55, 3.55}, far[] = {-3.0, -3.0, -3.0};
  open_grid(3, 4, 1.0);
  start(&one, 3);
  add_box(&one, a, b);
  const int64_t first = filled(&one, 4);
  start(&one, 3);
  add_box(&one, c, d);
  const int64_t second = filled(&one, 4);
  start(&one, 3);
  add_box(&one, c, b);
  const int64_t common = filled(&one, 4);
  start(&s, 3);
  add_box(&s, a, b);
  add_box(&s, c, d);
  ck_assert_int_eq(filled(&s, 4), first + second - common);
  start(&s, 3);
  add_box(&s, a, d);
  const int64_t whole = filled(&s, 4), cavity = s.elements;
  add_box(&s, c, b);
  turn_elements(&s, cavity);
  ck_assert_int_eq(filled(&s, 4), whole - common);
  start(&s, 3);
  add_box(&s, far, b);
  int64_t inside;
  const double corner[] = {0, 0, 0};
  ck_ok(&w, mpm_particles_fill_box(w.set[0], corner, b, (int32_t[]){4, 4, 4}, NULL, &inside));
  ck_assert_int_eq(filled(&s, 4), inside);
}
END_TEST

/* Over eight places of a torus, its particles have the mesh's volume, which the divergence theorem gives. */
START_TEST(volumes) {
  enum { PLACES = 8 };
  uint64_t seed = 3;
  double volume = 0.0, mean = 0.0;
  for (int place = 0; place < PLACES; ++place) {
    const double centre[] = {1.9 + 0.2 * any(&seed), 1.9 + 0.2 * any(&seed), 1.9 + 0.2 * any(&seed)};
    start(&s, 3);
    add_torus(&s, 60, 30, 1.1, 0.5, centre);
    volume = 0.0;
    for (int64_t e = 0; e < s.elements; ++e) {
      const double *p = s.at[s.corner[3 * e]], *q = s.at[s.corner[3 * e + 1]], *r = s.at[s.corner[3 * e + 2]];
      volume += (p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                 p[2] * (q[0] * r[1] - q[1] * r[0])) /
                6.0;
    }
    open_grid(3, 20, 0.2);
    mean += (double)filled(&s, 2) * 1e-3 / PLACES;
  }
  ck_between("torus", volume, 5.2, 2.0 * acos(-1.0) * acos(-1.0) * 1.1 * 0.25);
  show("volume %g, particles %g\n", volume, mean);
  ck_within("mean", mean / volume, 1.0, 1e-3);
}
END_TEST

/* Each lattice point has the answer of the sum, also where it was taken from a neighbour. */
START_TEST(points) {
  const double centre[] = {2.03, 1.98, 2.01};
  int64_t wanted = 0;
  start(&s, 3);
  add_torus(&s, 20, 10, 1.1, 0.5, centre);
  for (int i = 0; i < 8000; ++i) {
    const double x[] = {0.2 * (i / 400) + 0.1, 0.2 * (i / 20 % 20) + 0.1, 0.2 * (i % 20) + 0.1};
    wanted += direct(&s, x) > 0.5;
  }
  open_grid(3, 20, 0.2);
  ck_assert_int_gt(wanted, 500);
  ck_assert_int_eq(filled(&s, 1), wanted);
}
END_TEST

/* A triangle that is missing changes nothing away from it. Many that are missing leave a body. */
START_TEST(holes) {
  const double centre[] = {2.0, 2.0, 2.0};
  open_grid(3, 20, 0.2);
  start(&s, 3);
  add_torus(&s, 60, 30, 1.1, 0.5, centre);
  const int64_t whole = filled(&s, 2);
  s.elements--;
  ck_assert_int_eq(filled(&s, 2), whole);
  for (int64_t e = 0; e < s.elements; e += 97) memcpy(s.corner + 3 * e, s.corner + 3, 3 * sizeof *s.corner);
  const int64_t torn = filled(&s, 2);
  ck_between("torn", (double)torn, 0.99 * (double)whole, 1.01 * (double)whole);
}
END_TEST

/* By the crossings of a ray, which know nothing of angles. */
static int crosses(const double (*p)[2], int n, double x, double y) {
  int inside = 0;
  for (int i = 0, j = n - 1; i < n; j = i++)
    if ((p[i][1] > y) != (p[j][1] > y) &&
        x < (p[j][0] - p[i][0]) * (y - p[i][1]) / (p[j][1] - p[i][1]) + p[i][0])
      inside = !inside;
  return inside;
}

START_TEST(outlines) {
  enum { CORNERS = 80 };
  double outline[CORNERS][2];
  open_grid(2, 40, 0.1);
  for (int teeth = 3; teeth < 12; teeth += 4) {
    int64_t wanted = 0;
    for (int i = 0; i < CORNERS; ++i) {
      const double a = 2.0 * acos(-1.0) * i / CORNERS, r = 1.2 + 0.6 * sin(teeth * a);
      outline[i][0] = 2.0 + r * cos(a);
      outline[i][1] = 2.0 + r * sin(a);
    }
    start(&s, 2);
    add_polygon(&s, CORNERS, (const double(*)[2])outline);
    for (int i = 0; i < 120; ++i)
      for (int j = 0; j < 120; ++j)
        wanted += crosses((const double(*)[2])outline, CORNERS, (i + 0.5) / 30.0, (j + 0.5) / 30.0);
    ck_assert_int_gt(wanted, 3000);
    ck_assert_int_eq(filled(&s, 3), wanted);
    s.elements--;
    ck_between("gap", (double)filled(&s, 3), 0.98 * (double)wanted, 1.02 * (double)wanted);
  }
}
END_TEST

START_TEST(bad_meshes) {
  const double x[] = {0.5, 2.5, 0.5, 0.5, 0.5, 0.5, 2.5, 0.5, 0.5, 0.5, 0.5, 2.5};
  const int64_t corner[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const int32_t per[] = {2, 2, 2};
  double bad[12];
  int64_t first = 7, count = 7;
  open_grid(3, 4, 1.0);
  sets_counts was = sets_take(&w);
#define REFUSED(n, position, elements, of, cells, status, text)                                              \
  ck_refused(&w, mpm_particles_fill_mesh(w.set[0], n, position, elements, of, cells, &first, &count),        \
             status, text)
  REFUSED(4, NULL, 4, corner, per, MPM_E_ARG, "position is NULL");
  REFUSED(4, x, 4, NULL, per, MPM_E_ARG, "corner is NULL");
  REFUSED(4, x, 4, corner, NULL, MPM_E_ARG, "per_cell is NULL");
  REFUSED(0, x, 4, corner, per, MPM_E_ARG, "n is 0");
  REFUSED(-4, x, 4, corner, per, MPM_E_ARG, "n is -4");
  REFUSED((int64_t)1 << 31, x, 4, corner, per, MPM_E_ARG, "n is 2147483648");
  REFUSED(4, x, 0, corner, per, MPM_E_ARG, "elements is 0");
  REFUSED(4, x, INT64_MAX, corner, per, MPM_E_ARG, "elements is 9223372036854775807");
  REFUSED(4, x, 4, ((int64_t[]){0, 2, 1, 0, 1, 4, 0, 3, 2, 1, 2, 3}), per, MPM_E_ARG,
          "triangle 1: corner 4 does not exist, there are 4");
  REFUSED(4, x, 4, ((int64_t[]){0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, -3}), per, MPM_E_ARG, "corner -3");
  REFUSED(4, x, 1, corner, per, MPM_E_ARG, "the mesh reaches from 0.5 to 0.5 on axis 2");
  REFUSED(4, x, 4, corner, ((int32_t[]){2, 0, 2}), MPM_E_ARG, "per_cell[1] is 0");
  memcpy(bad, x, sizeof bad);
  bad[5] = NOT_A_NUMBER;
  REFUSED(4, bad, 4, corner, per, MPM_E_ARG, "point 1: position[1] is nan");
  bad[5] = -HUGE_VAL;
  REFUSED(4, bad, 4, corner, per, MPM_E_ARG, "point 1: position[1] is -inf");
  bad[5] = 1.7e308, bad[6] = -1.7e308;
  REFUSED(4, bad, 4, corner, per, MPM_E_ARG, "out of range");
  for (int i = 0; i < 12; ++i) bad[i] = x[i] + 10.0;
  REFUSED(4, bad, 4, corner, per, MPM_E_ARG, "beyond the grid");
  ck_assert_int_eq(first, 7);
  ck_assert_int_eq(count, 7);
  sets_unchanged(&w, was);
  ck_assert_int_eq(mpm_particles_fill_mesh(NULL, 4, x, 4, corner, per, NULL, NULL), MPM_E_ARG);
  ck_ok(&w, mpm_particles_fill_mesh(w.set[0], 4, x, 4, corner, per, NULL, NULL));
  open_grid(1, 4, 1.0);
  REFUSED(4, x, 4, corner, per, MPM_E_UNSUPPORTED, "use mpm_particles_fill_box()");
  open_grid(2, 4, 1.0);
  REFUSED(4, x, 4, ((int64_t[]){0, 1, 1, 2, 2, 3, 3, 9}), per, MPM_E_ARG, "edge 3: corner 9");
}
END_TEST

START_TEST(every_failing_allocation) {
  const double centre[] = {2.0, 2.0, 2.0};
  const int32_t per[] = {2, 2, 2};
  open_grid(3, 4, 1.0);
  start(&s, 3);
  add_torus(&s, 20, 10, 1.1, 0.5, centre);
  lay_out(&s, 1.0);
  int64_t failures = 0;
  for (mpm_status status = MPM_E_NOMEM; status; ++failures) {
    sets_counts was = sets_take(&w);
    w.memory.calls = 0;
    w.memory.fail_at = failures + 1;
    status = mpm_particles_fill_mesh(w.set[0], s.points, s.position, s.elements, s.corner, per, NULL, NULL);
    w.memory.fail_at = 0;
    if (!status) break;
    ck_refused(&w, status, MPM_E_NOMEM, "out of memory");
    sets_unchanged(&w, was);
    ck_assert_int_eq(w.memory.held, was.held);
  }
  ck_assert_int_gt(failures, 12);
  ck_assert_int_gt(mpm_particles_count(w.set[0]), 0);
}
END_TEST

/* Any triangles at all, flat, equal, on the lattice itself: an answer, and the same one again. */
START_TEST(any_triangles) {
  uint64_t seed = 11;
  for (int round = 0; round < 300; ++round) {
    const int32_t dim = 2 + round % 2;
    open_grid(dim, 4, 1.0);
    start(&s, dim);
    const int n = 1 + (int)(30.0 * any(&seed));
    for (int i = 0; i < n; ++i)
      point(&s, floor(9.0 * any(&seed)) / 2.0, floor(9.0 * any(&seed)) / 2.0, floor(9.0 * any(&seed)) / 2.0);
    const int m = 1 + (int)(60.0 * any(&seed));
    for (int e = 0; e < m; ++e)
      element(&s, (int64_t)(n * any(&seed)), (int64_t)(n * any(&seed)), (int64_t)(n * any(&seed)));
    lay_out(&s, 1.0);
    int64_t count[2] = {-1, -1};
    const int32_t per[] = {2, 2, 2};
    mpm_status status[2];
    for (int k = 0; k < 2; ++k)
      status[k] =
          mpm_particles_fill_mesh(w.set[0], s.points, s.position, s.elements, s.corner, per, NULL, &count[k]);
    ck_assert_int_eq(status[0], status[1]);
    ck_assert_int_eq(count[0], count[1]);
    if (status[0]) ck_refused(&w, status[0], MPM_E_ARG, "it has no volume");
    sets_check_slots(&w);
  }
}
END_TEST

static void close_world(void) {
  sets_close(&w);
}

static void no_world(void) {}

Suite *mesh_suite(void) {
  Suite *suite = suite_create("mesh");
  TCase *tests = tcase_create("mesh");
  tcase_add_checked_fixture(tests, no_world, close_world);
  tcase_add_test(tests, fans_for_patches);
  tcase_add_test(tests, boxes);
  tcase_add_test(tests, zeros_and_giants);
  tcase_add_test(tests, shells);
  tcase_add_test(tests, volumes);
  tcase_add_test(tests, points);
  tcase_add_test(tests, holes);
  tcase_add_test(tests, outlines);
  tcase_add_test(tests, bad_meshes);
  tcase_add_test(tests, every_failing_allocation);
  tcase_add_test(tests, any_triangles);
  suite_add_tcase(suite, tests);
  return suite;
}
