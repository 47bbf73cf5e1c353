#include "options.h"

/* What the library refuses today for no reason but that it is not written. Take out what has come; a test
 * sees to it that nothing stays here that is there. */
const option_value options_not_yet[] = {{0, 0}};

const basis_option basis_options[BASES] = {{MPM_LINEAR, MPM_BOUNDARY_GHOST, 0.5, "linear"},
                                           {MPM_BSPLINE2, MPM_BOUNDARY_GHOST, 0.5, "quadratic"},
                                           {MPM_BSPLINE3, MPM_BOUNDARY_GHOST, 0.5, "cubic"},
                                           {MPM_BSPLINE2, MPM_BOUNDARY_OPEN_KNOT, 0.5, "open quadratic"},
                                           {MPM_BSPLINE3, MPM_BOUNDARY_OPEN_KNOT, 0.5, "open cubic"},
                                           {MPM_GIMP, MPM_BOUNDARY_GHOST, 0.5, "GIMP"},
                                           {MPM_UGIMP, MPM_BOUNDARY_GHOST, 0.3, "uGIMP"},
                                           {MPM_CPGIMP, MPM_BOUNDARY_GHOST, 0.5, "cpGIMP"}};

const scheme_option scheme_options[SCHEMES] = {{MPM_USL, "USL"}, {MPM_MUSL, "MUSL"}, {MPM_USF, "USF"}};

const transfer_option transfer_options[TRANSFERS] = {{MPM_FLIP, 2, 1.0, 0.0, "FLIP"},
                                                     {MPM_FLIP, 2, 0.9, 0.0, "FLIP 0.9"},
                                                     {MPM_FLIP, 2, 0.0, 0.0, "PIC"},
                                                     {MPM_APIC, 2, 1.0, 0.0, "APIC"},
                                                     {MPM_APIC_MLS, 2, 1.0, 0.0, "MLS"},
                                                     {MPM_FLIP, 2, 0.95, 5.0, "FLIP damped"},
                                                     {MPM_TPIC, 2, 1.0, 0.0, "TPIC"},
                                                     {MPM_TFLIP, 2, 1.0, 0.0, "TFLIP"},
                                                     {MPM_TFLIP, 2, 0.9, 5.0, "TFLIP 0.9 damped"},
                                                     {MPM_AFLIP, 2, 1.0, 0.0, "AFLIP"},
                                                     {MPM_AFLIP, 2, 0.9, 5.0, "AFLIP 0.9 damped"},
                                                     {MPM_XPIC, 1, 1.0, 0.0, "XPIC(1)"},
                                                     {MPM_XPIC, 2, 1.0, 0.0, "XPIC(2)"},
                                                     {MPM_XPIC, 3, 1.0, 0.0, "XPIC(3)"},
                                                     {MPM_XPIC, 5, 1.0, 0.0, "XPIC(5)"}};

const law_option law_options[LAWS] = {{"neo_hookean", "neo-Hookean"},
                                      {"linear_elastic", "linear elastic"},
                                      {"neo_hookean_decoupled", "decoupled"},
                                      {"j2", "J2"},
                                      {"newtonian_fluid", "fluid"},
                                      {"rigid", "rigid"},
                                      {NULL, "host law"}};

int32_t option_ready(int32_t kind, int32_t value) {
  for (const option_value *o = options_not_yet; o->kind; ++o)
    if (o->kind == kind && o->value == value) return 0;
  return 1;
}

int32_t basis_ready(const basis_option *b) {
  return option_ready(OPTION_BASIS, b->basis) && option_ready(OPTION_BOUNDARY, b->boundary);
}

int32_t scheme_ready(const scheme_option *s) {
  return option_ready(OPTION_SCHEME, s->scheme);
}

int32_t transfer_ready(const transfer_option *t) {
  return option_ready(OPTION_TRANSFER, t->transfer) && option_ready(OPTION_PIC_DAMPING, t->pic_damping > 0.0);
}

int32_t law_ready(int32_t law) {
  return option_ready(OPTION_LAW, law);
}

int32_t stepper_ready(const mpm_stepper_desc *d) {
  return option_ready(OPTION_SCHEME, d->scheme) && option_ready(OPTION_TRANSFER, d->transfer) &&
         option_ready(OPTION_POSITION_ORDER, d->position_order) &&
         option_ready(OPTION_STAGGERED, d->staggered) && option_ready(OPTION_LOCKING, d->locking_remedy) &&
         option_ready(OPTION_PIC_DAMPING, d->pic_damping > 0.0);
}

int32_t carries_matrix(int32_t transfer) {
  return transfer != MPM_FLIP && transfer != MPM_XPIC;
}

int32_t fits_mls(const basis_option *b) {
  return (b->basis == MPM_BSPLINE2 || b->basis == MPM_BSPLINE3) && b->boundary == MPM_BOUNDARY_GHOST;
}

int32_t is_gimp(int32_t basis) {
  return basis == MPM_GIMP || basis == MPM_UGIMP || basis == MPM_CPGIMP;
}
