/* The block of sliding.h on an elastic slab of its own law, held below: the exact answers stay those of
 * Coulomb, whatever the slab does; when the block stops, block and slab spring back by millimetres. The
 * spacing is refined, and the slab lies at two places of its cell. */
#include "sliding.h"

int main(int argc, char **argv) {
  verify_begin("contact_slab", argc, argv);
  FILE *table = verify_csv("contact_slab");
  slide_heading(table);
  static const double place[2] = {0.0, 0.37}, tolerance[3] = {0.06, 0.03, 0.02};
  for (int32_t k = 0; k < (verify_quick() ? 1 : 3); ++k) {
    const double h = 0.1 / (double)(1 << k);
    char name[40];
    snprintf(name, sizeof name, "h = %g", h);
    const slide_series series = {.name = name,
                                 .support = ON_BODY,
                                 .basis = MPM_BSPLINE2,
                                 .places = 2,
                                 .place = place,
                                 .h = h,
                                 .slab = 0.2,
                                 .sliding = tolerance[k],
                                 .creep = 2e-3,
                                 .stopping = tolerance[k]};
    slide_gates(&series, table);
  }
  fclose(table);
  return verify_end();
}
