#include "walls.h"

method wall_method_of(int32_t i) {
  static const struct {
    int32_t scheme, transfer;
    double flip, damping;
  } ways[WALL_WAYS] = {{MPM_USL, MPM_FLIP, 1.0, 0.0},     {MPM_MUSL, MPM_FLIP, 0.9, 0.0},
                       {MPM_USF, MPM_FLIP, 1.0, 0.0},     {MPM_MUSL, MPM_APIC, 1.0, 0.0},
                       {MPM_USL, MPM_TFLIP, 0.9, 5.0},    {MPM_USL, MPM_XPIC, 1.0, 0.0},
                       {MPM_USF, MPM_APIC_MLS, 1.0, 0.0}, {MPM_MUSL, MPM_FMPM, 1.0, 0.0}};
  const int32_t way = i % WALL_WAYS;
  const basis_option *basis = &basis_options[i / WALL_WAYS];
  const scheme_option *scheme = NULL;
  const transfer_option *chosen = NULL;
  int32_t transfer = ways[way].transfer;
  if (transfer == MPM_APIC_MLS && !fits_mls(basis)) transfer = MPM_AFLIP;
  for (int32_t k = 0; k < SCHEMES; ++k)
    if (scheme_options[k].scheme == ways[way].scheme) scheme = &scheme_options[k];
  for (int32_t k = 0; k < TRANSFERS; ++k) {
    const transfer_option *t = &transfer_options[k];
    /* exact: these are the numbers of the table */
    if (t->transfer == transfer && !(t->flip < ways[way].flip) && !(t->flip > ways[way].flip) &&
        !(t->pic_damping < ways[way].damping) && !(t->pic_damping > ways[way].damping))
      chosen = t;
  }
  ck_assert_ptr_nonnull(scheme);
  ck_assert_ptr_nonnull(chosen);
  return method_of(basis, scheme, chosen);
}

enum {
  N = MPM_WALL_NONE,
  O = MPM_WALL_OPEN,
  F = MPM_WALL_FIXED,
  S = MPM_WALL_SLIP,
  C = MPM_WALL_FRICTION,
  K = MPM_WALL_FRICTION_NODES
};
const wall_setup wall_setups[WALL_SETUPS] = {
    {{N, N, N, N, N, N}, 0}, {{O, O, O, O, O, O}, 0}, {{F, F, F, F, F, F}, 0}, {{S, S, S, S, S, S}, 0},
    {{C, C, C, C, C, C}, 0}, {{F, S, C, F, S, C}, 0}, {{S, C, K, S, F, N}, 0}, {{K, F, S, C, O, S}, 0},
    {{N, C, F, O, C, S}, 0}, {{F, S, N, N, C, S}, 1}, {{K, S, N, N, F, C}, 1}, {{C, C, N, N, S, F}, 1},
    {{K, K, K, K, K, K}, 0}};

void wall_describe(const wall_setup *setup, mpm_grid_desc *grid) {
  if (grid->dim > 1) grid->periodic[1] = setup->periodic;
}

void wall_set(world *w, const wall_setup *setup, double friction) {
  for (int32_t face = 0; face < 2 * w->dim; ++face)
    if (!setup->periodic || face / 2 != 1)
      ck_ok(w, mpm_stepper_set_wall(w->stepper, face, setup->kind[face], friction));
}

int32_t wall_is_linear(int32_t kind) {
  return kind == MPM_WALL_FIXED || kind == MPM_WALL_SLIP;
}

int64_t wall_face_node(const mpm_grid_desc *grid, int32_t face) {
  const int64_t cells = grid->cells[face / 2];
  if (grid->boundary_basis != MPM_BOUNDARY_OPEN_KNOT) return face % 2 ? cells : 0;
  return face % 2 ? cells + 1 : grid->basis == MPM_BSPLINE3 ? -1 : 0;
}
