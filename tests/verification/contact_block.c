/* The block of sliding.h on a rigid floor of prescribed particles, at several places of it in its cell, with
 * every basis but uGIMP. */
#include "sliding.h"

int main(int argc, char **argv) {
  verify_begin("contact_block", argc, argv);
  FILE *table = verify_csv("contact_block");
  slide_heading(table);
  static const int32_t basis[5] = {MPM_BSPLINE2, MPM_LINEAR, MPM_BSPLINE3, MPM_GIMP, MPM_CPGIMP};
  for (int32_t b = 0; b < (verify_quick() ? 1 : 5); ++b) {
    slide_series series = {.name = slide_basis(basis[b]),
                           .support = ON_BODY,
                           .basis = basis[b],
                           .places = 5,
                           .sliding = 0.02,
                           .creep = 1e-3,
                           .stopping = 0.03,
                           .weight = 0.02};
    if (basis[b] == MPM_LINEAR)
      series.creeps =
          "it hops on, as an elastic block without damping does that is pushed hard enough; where one light "
          "row binds it, less is enough (contact_release)";
    if (basis[b] == MPM_LINEAR || basis[b] == MPM_CPGIMP)
      series.hops = "let go from the friction that held it, the block still swings across the slope at the "
                    "end, with as much of the momentum that its weight gives";
    slide_gates(&series, table);
  }
  fclose(table);
  return verify_end();
}
