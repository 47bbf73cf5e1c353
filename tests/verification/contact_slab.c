/* The block of sliding.h on an elastic slab of its own law, held below: the exact answers stay those of
 * Coulomb, whatever the slab does; when the block stops, block and slab spring back by millimetres. The
 * spacing is refined, and the slab lies at two places of its cell. */
#include "sliding.h"

static const double thickness = 0.2;

int main(int argc, char **argv) {
  verify_begin("contact_slab", argc, argv);
  FILE *table = verify_csv("contact_slab");
  fprintf(table, "case,cells,shift,way,exact,friction,weight,stopped,range\n");
  const char *source = "Coulomb's law; set tolerance";
  for (int32_t k = 0; k < (verify_quick() ? 1 : 3); ++k) {
    const double h = 0.1 / (double)(1 << k), tolerance = k == 0 ? 0.06 : k == 1 ? 0.03 : 0.02;
    double low = HUGE_VAL, high = 0.0, creep = 0.0, least = HUGE_VAL, most = 0.0, range = 0.0, balance = 0.0;
    for (int32_t place = 0; place < 2; ++place) {
      slide a = {.support = ON_BODY,
                 .basis = MPM_BSPLINE2,
                 .settled = 1,
                 .h = h,
                 .slab = thickness,
                 .angle = PI / 6.0,
                 .friction = 0.3,
                 .shift = place ? 0.37 : 0.0,
                 .end = 0.5};
      const double exact = 0.5 * slide_gravity * (sin(a.angle) - a.friction * cos(a.angle)) * 0.25;
      slide_outcome o = slide_run(&a);
      fprintf(table, "slides,%g,%g,%.6f,%.6f,%.5f,%.5f,,\n", 1.0 / h, a.shift, o.way, exact, o.friction,
              o.weight);
      low = fmin(low, o.way / exact);
      high = fmax(high, o.way / exact);
      balance = fmax(balance, o.balance);
      a.friction = 0.7;
      o = slide_run(&a);
      fprintf(table, "rests,%g,%g,%.6f,0,%.5f,%.5f,,\n", 1.0 / h, a.shift, o.way, o.friction, o.weight);
      creep = fmax(creep, fabs(o.way));
      a.friction = 0.3, a.angle = 0.0, a.speed = 1.5, a.end = 1.5;
      o = slide_run(&a);
      fprintf(table, "stops,%g,%g,%.6f,0.375,%.5f,%.5f,%.5f,%.6f\n", 1.0 / h, a.shift, o.way, o.friction,
              o.weight, o.stopped_at, o.range);
      least = fmin(least, o.way / 0.375), most = fmax(most, o.way / 0.375);
      range = fmax(range, o.range);
      verify_progress("h = %g, at %g h", h, a.shift);
    }
    char name[40];
    snprintf(name, sizeof name, "h = %g", h);
    verify_gate_of(name, "slides down the slope, least way / exact", low, 1.0 - tolerance, 1.0 + tolerance,
                   source);
    verify_gate_of(name, "slides down the slope, largest way / exact", high, 1.0 - tolerance, 1.0 + tolerance,
                   source);
    verify_gate_of(name, "impulse less weight and momentum / weight", balance, 0.0, 1e-11, "conservation");
    verify_gate_of(name, "rests on the slope, creep in 0.5 s, m", creep, 0.0, 2e-3, source);
    verify_gate_of(name, "stops on the level, least way / exact", least, 1.0 - tolerance, 1.0 + tolerance,
                   source);
    verify_gate_of(name, "stops on the level, largest way / exact", most, 1.0 - tolerance, 1.0 + tolerance,
                   source);
    verify_gate_of(name, "rests on the level, moves from 1 to 1.5 s, m", range, 0.0, 1e-3, source);
  }
  fclose(table);
  return verify_end();
}
