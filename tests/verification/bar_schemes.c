/* The manufactured bar of Steffen et al. 2008 on a fine grid, error against CFL number by explicit scheme:
 * what each does with the noise of particles that cross cells. */
#include "bar.h"

enum { STEPS = 5 };

int main(int argc, char **argv) {
  verify_begin("bar_schemes", argc, argv);
  bar bars[VERIFY_SCHEMES];
  for (int32_t i = 0; i < VERIFY_SCHEMES; ++i) {
    const verify_scheme *by = &verify_schemes[i];
    bars[i] = (bar){.name = by->name,
                    .basis = MPM_BSPLINE2,
                    .scheme = by->scheme,
                    .projected = by->projected,
                    .per_cell = 6};
  }
  const int32_t cells = verify_quick() ? 128 : 256;
  static const double at_01[2][VERIFY_PROJECTED] = {{2.09e-5, 7.22e-5, 6.34e-5}, {5.28e-5, 1.12e-4, 7.92e-5}};
  const double *wanted = at_01[verify_quick()]; /* errors at CFL 0.1 */
  double error[VERIFY_SCHEMES][STEPS];
  char what[80];
  FILE *csv = verify_csv("bar_schemes");
  fputs("cfl,USL,USF,MUSL,MUSL projected", csv);
  for (int32_t k = 0; k < STEPS; ++k) {
    const double cfl = 0.05 * (1 << k), dt = 0.01 / ceil(0.01 * bar_speed * cells / cfl - 1e-9);
    fprintf(csv, "\n%g", cfl);
    for (int32_t i = 0; i < VERIFY_SCHEMES; ++i) {
      error[i][k] = bar_error(&bars[i], cells, 0.05, dt, 0.01);
      fprintf(csv, ",%.6g", error[i][k]);
    }
  }
  fputc('\n', csv);
  fclose(csv);
  for (int32_t i = 0; i < VERIFY_SCHEMES; ++i) {
    snprintf(what, sizeof what, "error, %s, CFL 0.1", bars[i].name);
    if (i < VERIFY_PROJECTED)
      verify_gate(what, error[i][1], 0.98 * wanted[i], 1.02 * wanted[i], "an independent implementation");
    else
      verify_gate(what, error[i][1], 0.0, 1.5 * error[VERIFY_MUSL][1], "no worse than MUSL; judgement");
    const double ratio = error[i][3] / error[i][0];
    const char *source = "Steffen et al. 2008, fig. 9: below its limit the CFL number does not matter";
    snprintf(what, sizeof what, "error at CFL 0.4 over CFL 0.05, %s", bars[i].name);
    const int32_t grows = i == VERIFY_USF || i == VERIFY_MUSL;
    verify_judge(what, ratio, 0.0, 1.5, source,
                 grows ? "said of USL; an independent implementation of USF and MUSL has the same errors"
                       : NULL);
  }
  /* A tenth of the displacement crosses few cells. */
  for (int32_t i = 0; i < VERIFY_SCHEMES; ++i) {
    const double dt = 0.01 / (0.01 * bar_speed * cells / 0.4);
    snprintf(what, sizeof what, "error / A at CFL 0.4, A = 0.005 over A = 0.05 of USL, %s", bars[i].name);
    verify_gate(what, 10.0 * bar_error(&bars[i], cells, 0.005, dt, 0.01) / error[0][3], 0.0, 2.0,
                "no noise to grow where particles hardly cross cells");
  }
  return verify_end();
}
