/* The block of sliding.h on a rigid floor of prescribed particles, at several places of it in its cell. */
#include "sliding.h"

int main(int argc, char **argv) {
  verify_begin("contact_block", argc, argv);
  FILE *table = verify_csv("contact_block");
  slide_heading(table);
  const int32_t basis[3] = {MPM_BSPLINE2, MPM_LINEAR, MPM_BSPLINE3}, kinds = verify_quick() ? 1 : 3;
  for (int32_t b = 0; b < kinds; ++b) {
    const slide_series series = {.name = slide_basis(basis[b]),
                                 .support = ON_BODY,
                                 .basis = basis[b],
                                 .places = 5,
                                 .sliding = 0.02,
                                 .creep = 1e-3,
                                 .stopping = 0.03,
                                 .weight = 0.02,
                                 .trembles = basis[b] == MPM_LINEAR
                                                 ? "forces jump where particles cross cells of the linear "
                                                   "basis: the block trembles at some places of the floor"
                                                 : NULL};
    slide_gates(&series, table);
  }
  fclose(table);
  return verify_end();
}
