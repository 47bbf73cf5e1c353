/* What walls do to nodes, for every basis, at faces, edges and corners,
 * and on grids of one to three cells. */
#include "walls.h"
#include "tables.h"

enum { CLOUD = 160 };
static const double time_step = 1e-5;

typedef struct nodes {
  int64_t n, *index;
  double *v, *mass, *gap, *normal; /* gap, normal: to the nearest friction wall that is a plane */
  int32_t dim;
} nodes;

/* Velocity of the node with this index, or NULL. */
static const double *velocity_at(const nodes *a, const int64_t *at) {
  for (int64_t i = 0; i < a->n; ++i) {
    int32_t same = 1;
    for (int32_t k = 0; k < a->dim; ++k) same &= a->index[k * a->n + i] == at[k];
    if (same) return a->v + i;
  }
  return NULL;
}

/* Returns 1 for a node of the linear basis with a tenth of the mass of one beside it, or less: it goes with
 * that, whatever it touches. */
static int32_t may_be_led(const mpm_grid_desc *grid, const nodes *a, int64_t i) {
  int32_t light = 0;
  for (int64_t j = 0; j < a->n && grid->basis == MPM_LINEAR; ++j) {
    int64_t farthest = 0;
    for (int32_t k = 0; k < a->dim; ++k) {
      const int64_t apart = llabs(a->index[k * a->n + i] - a->index[k * a->n + j]);
      farthest = apart > farthest ? apart : farthest;
    }
    light |= farthest == 1 && a->mass[i] <= 0.1 * a->mass[j];
  }
  return light;
}

/* Does a wall on face hold component c? */
static int32_t holds(const wall_setup *walls, int32_t face, int32_t c) {
  return walls->kind[face] == MPM_WALL_FIXED || (walls->kind[face] == MPM_WALL_SLIP && face / 2 == c);
}

/* The node that a ghost or image follows on one axis, and with which signs. */
static int64_t followed(const mpm_grid_desc *grid, const wall_setup *walls, int32_t k, int64_t at,
                        int32_t *sign) {
  const int64_t cells = grid->cells[k];
  if (grid->periodic[k]) return (at + 4 * cells) % cells;
  if (grid->boundary_basis == MPM_BOUNDARY_OPEN_KNOT || (at >= 0 && at <= cells)) return at;
  const int32_t face = 2 * k + (at > 0);
  if (!wall_is_linear(walls->kind[face])) return at;
  for (int32_t c = 0; c < grid->dim; ++c)
    if (holds(walls, face, c)) sign[c] = -sign[c];
  return at < 0 ? -at : 2 * cells - at;
}

static int64_t check_planes(const char *name, const mpm_grid_desc *grid, const wall_setup *walls,
                            const nodes *a, int64_t i) {
  int64_t checked = 0;
  for (int32_t face = 0; face < 2 * a->dim; ++face) {
    const int32_t k = face / 2, kind = walls->kind[face];
    const int64_t plane = wall_face_node(grid, face), at = a->index[k * a->n + i];
    if (grid->periodic[k]) continue;
    for (int32_t c = 0; at == plane && c < a->dim; ++c) {
      if (!holds(walls, face, c)) continue;
      ck_within(name, a->v[c * a->n + i], 0.0, 0.0);
      ++checked;
    }
    const double outward = face % 2 ? 1.0 : -1.0;
    if (kind == MPM_WALL_FRICTION && outward * a->normal[k * a->n + i] > 0.5 && !may_be_led(grid, a, i)) {
      /* nothing moves farther than to the wall */
      const double most = fmax(0.0, a->gap[i]) / time_step;
      ck_between(name, outward * a->v[k * a->n + i], -(double)INFINITY, most + 1e-12 * (1.0 + most));
      ++checked;
    }
    if (kind != MPM_WALL_FRICTION_NODES) continue;
    /* nothing moves into a friction wall: a node on its plane, or the mean of ghost and mirror image */
    double inward = a->v[k * a->n + i];
    if (at != plane) {
      const int32_t is_ghost =
          grid->boundary_basis != MPM_BOUNDARY_OPEN_KNOT && at == plane + (face % 2 ? 1 : -1);
      if (!is_ghost) continue;
      int64_t mirror[3] = {0, 0, 0};
      for (int32_t j = 0; j < a->dim; ++j) mirror[j] = a->index[j * a->n + i];
      mirror[k] = 2 * plane - at;
      const double *other = velocity_at(a, mirror);
      if (!other && walls->periodic) continue; /* on an image, as below */
      ck_assert_ptr_nonnull(other);
      inward += other[k * a->n];
    }
    if (face % 2) inward = -inward;
    ck_between(name, inward, -1e-13, 100.0);
    ++checked;
  }
  return checked;
}

static void check_nodes(const method *how, const wall_setup *walls, int32_t dim, int64_t cells) {
  char name[96];
  world w;
  world_desc desc = world_with(how, dim, cells, 0.1);
  wall_describe(walls, &desc.grid);
  snprintf(name, sizeof name, "%s, %d-D, walls %d, %d cells", how->name, (int)dim, (int)(walls - wall_setups),
           (int)cells);
  mpm_particles *set = world_open(&w, &desc);
  dice d = {7};
  add_cloud(&w, set, &d, CLOUD, 0.1, 0.0, 0.1 * (double)cells, 1.0);
  wall_set(&w, walls, 0.4);
  ck_ok(&w, mpm_step_begin(w.stepper, time_step));
  ck_ok(&w, mpm_step_grid(w.stepper));
  nodes a = {.dim = dim};
  a.index = fetch_node_indices(&w, &a.n);
  a.v = fetch_nodes(&w, "velocity", &a.n);
  a.mass = fetch_nodes(&w, "mass", &a.n);
  a.gap = fetch_nodes(&w, "contact_gap", &a.n);
  a.normal = fetch_nodes(&w, "contact_normal", &a.n);
  ck_ok(&w, mpm_step_abort(w.stepper));
  int64_t checked = 0;
  for (int64_t i = 0; i < a.n; ++i) {
    int64_t master[3] = {0, 0, 0};
    int32_t sign[3] = {1, 1, 1}, follows = 0;
    for (int32_t k = 0; k < dim; ++k) {
      const int64_t at = a.index[k * a.n + i];
      master[k] = followed(&desc.grid, walls, k, at, sign);
      follows |= master[k] != at && !desc.grid.periodic[k];
    }
    if (!follows) checked += check_planes(name, &desc.grid, walls, &a, i);
    const double *other = velocity_at(&a, master);
    if (!other && walls->periodic) continue; /* all mass of a period may be on its image */
    ck_assert_ptr_nonnull(other);
    for (int32_t c = 0; c < dim; ++c) ck_within(name, a.v[c * a.n + i], sign[c] * other[c * a.n], 1e-15);
    ++checked;
  }
  if (walls->kind[0] >= MPM_WALL_FIXED) ck_assert_int_gt(checked, 0);
  free(a.index), free(a.v), free(a.mass), free(a.gap), free(a.normal);
  world_close(&w);
}

START_TEST(nodes_obey_walls) {
  const method how = wall_method_of(_i);
  for (int32_t setup = 2; setup < WALL_SETUPS; ++setup)
    for (int32_t dim = 1; dim <= 3; ++dim) check_nodes(&how, &wall_setups[setup], dim, 6);
}
END_TEST

/* Where every node is near two walls of an axis. */
START_TEST(tiny_grids_obey_walls) {
  const method how = wall_method_of(_i);
  for (int32_t setup = 2; setup < WALL_SETUPS; ++setup)
    for (int32_t dim = 1; dim <= 3; ++dim)
      for (int64_t cells = 1; cells <= 3; ++cells) check_nodes(&how, &wall_setups[setup], dim, cells);
}
END_TEST

/* Material on the plane of a wall stands still in what the wall holds; along a slip wall all momentum is
 * kept. PIC shows it: its particles have the velocity of the nodes. */
START_TEST(material_on_walls_stands) {
  const basis_option *basis = &basis_options[_i / 2];
  const int32_t kind = _i % 2 ? MPM_WALL_SLIP : MPM_WALL_FIXED;
  enum { SOME = 60 };
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w;
    world_desc desc = world_default(dim, 5, 0.1);
    use_basis(basis, &desc.grid);
    for (int32_t k = 1; k < dim; ++k) desc.grid.periodic[k] = kind == MPM_WALL_SLIP;
    desc.stepper.flip = 0.0;
    mpm_particles *set = world_open(&w, &desc);
    dice d = {19};
    add_cloud(&w, set, &d, CLOUD, 0.1, 0.0, 0.5, 1.0);
    /* some are on the lower or the upper face of the first axis, and of the second: edges and corners too */
    double *x = fetch(&w, set, "position", dim);
    for (int64_t p = 0; p < SOME; ++p) {
      x[p] = p % 2 ? 0.5 : 0.0;
      if (dim > 1 && kind == MPM_WALL_FIXED && p % 5 == 0) x[CLOUD + p] = p % 3 ? 0.5 : 0.0;
    }
    put(&w, set, "position", dim, x);
    /* without stress: its force on a node where it has no mass would be lost */
    static const double none[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, none));
    world_walls(&w, kind, 0.0);
    const mpm_step_info before = world_info(&w), after = world_step(&w, 1e-5);
    double *v = fetch(&w, set, "velocity", dim), *now = fetch(&w, set, "position", dim);
    /* with open knots one node alone acts there; with the linear basis another has a weight of 2^-60; else
     * two cancel */
    const int32_t alone = basis->boundary == MPM_BOUNDARY_OPEN_KNOT;
    const double rest = alone ? 0.0 : basis->basis == MPM_LINEAR ? 0x1p-59 : 1e-16;
    for (int64_t p = 0; p < SOME; ++p)
      for (int32_t c = 0; c < dim; ++c)
        if (c == 0 || kind == MPM_WALL_FIXED) {
          /* by one wall or the other */
          ck_within(basis->name, v[c * CLOUD + p], 0.0, rest);
          if (c == 0) ck_within(basis->name, now[p], x[p], alone ? 0.0 : 1e-20);
        }
    for (int32_t c = 1; c < dim && kind == MPM_WALL_SLIP; ++c)
      ck_within(basis->name, after.momentum[c], before.momentum[c], 1e-12);
    free(x), free(v), free(now);
    world_close(&w);
  }
}
END_TEST

/* Up to the faces nothing is lost: nodes have the mass of the particles, and an affine velocity field, given
 * with its gradient, is that of the nodes where they stand, and again that of the particles. */
START_TEST(faces_keep_affine_fields) {
  static const double A[9] = {0.7, -1.1, 0.4, 0.9, -0.3, 0.8, -0.6, 0.5, 1.2}, b[3] = {0.3, -0.2, 0.1};
  const basis_option *basis = &basis_options[_i];
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int64_t cells = 1; cells <= 5; ++cells) {
      world w;
      world_desc desc = world_default(dim, cells, 0.1);
      use_basis(basis, &desc.grid);
      desc.stepper.transfer = MPM_TPIC;
      mpm_particles *set = world_open(&w, &desc);
      dice d = {23};
      add_cloud(&w, set, &d, CLOUD, 0.1, 0.0, 0.1 * (double)cells, 0.0);
      double *x = fetch(&w, set, "position", dim), *v = calloc((size_t)(dim * CLOUD), sizeof *v), L[9];
      for (int32_t k = 0; k < dim; ++k) x[k * CLOUD + k] = 0.0, x[k * CLOUD + 5 + k] = 0.1 * (double)cells;
      for (int32_t k = 0; k < dim; ++k)
        for (int64_t p = 0; p < CLOUD; ++p) {
          v[k * CLOUD + p] = b[k];
          for (int32_t j = 0; j < dim; ++j) v[k * CLOUD + p] += A[3 * k + j] * x[j * CLOUD + p];
        }
      for (int32_t c = 0; c < 9; ++c) L[c] = c / 3 < dim && c % 3 < dim ? A[c] : 0.0;
      static const double none[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
      put(&w, set, "position", dim, x);
      put(&w, set, "velocity", dim, v);
      ck_ok(&w, mpm_particles_set_all(set, "velocity_gradient", MPM_F64, 9, L));
      ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, none));
      world_walls(&w, MPM_WALL_OPEN, 0.0);
      const double total = mass_of(&w, set);
      world_step(&w, 1e-9);
      int64_t n;
      double *of_nodes = fetch_nodes(&w, "mass", &n), *at = fetch_nodes(&w, "position", &n);
      double *v_nodes = fetch_nodes(&w, "velocity", &n);
      ck_within(basis->name, sum_of(n, of_nodes), total, 1e-13 * total);
      for (int64_t i = 0; i < n; ++i)
        for (int32_t k = 0; k < dim; ++k) {
          double wanted = b[k];
          for (int32_t j = 0; j < dim; ++j) wanted += A[3 * k + j] * at[j * n + i];
          ck_within(basis->name, v_nodes[k * n + i], wanted, 1e-12);
        }
      for (int64_t id = 0; id < CLOUD; ++id) {
        double after[3];
        if (mpm_particles_get(set, "velocity", MPM_F64, dim, 1, &id, after))
          continue; /* it was on a face and left */
        for (int32_t k = 0; k < dim; ++k) ck_within(basis->name, after[k], v[k * CLOUD + id], 1e-12);
      }
      ck_assert_int_ge(mpm_particles_count(set), CLOUD - 2 * dim);
      free(x), free(v), free(of_nodes), free(at), free(v_nodes);
      world_close(&w);
    }
}
END_TEST

TCase *walls_nodes_case(TCase *wide) {
  TCase *tc = tcase_create("nodes");
  tcase_set_timeout(tc, 60.0);
  add_table(tc, wide, nodes_obey_walls, WALL_METHODS);
  add_table(tc, wide, tiny_grids_obey_walls, WALL_METHODS);
  tcase_add_loop_test(tc, faces_keep_affine_fields, 0, BASES);
  tcase_add_loop_test(tc, material_on_walls_stands, 0, 2 * BASES);
  return tc;
}
