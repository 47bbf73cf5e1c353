#include "methods.h"

#include <stdio.h>
#include <string.h>

const basis_option basis_options[BASES] = {{MPM_LINEAR, MPM_BOUNDARY_GHOST, 0.5, "linear"},
                                           {MPM_BSPLINE2, MPM_BOUNDARY_GHOST, 0.5, "quadratic"},
                                           {MPM_BSPLINE3, MPM_BOUNDARY_GHOST, 0.5, "cubic"},
                                           {MPM_BSPLINE2, MPM_BOUNDARY_OPEN_KNOT, 0.5, "open quadratic"},
                                           {MPM_BSPLINE3, MPM_BOUNDARY_OPEN_KNOT, 0.5, "open cubic"},
                                           {MPM_GIMP, MPM_BOUNDARY_GHOST, 0.5, "GIMP"},
                                           {MPM_UGIMP, MPM_BOUNDARY_GHOST, 0.3, "uGIMP"},
                                           {MPM_CPGIMP, MPM_BOUNDARY_GHOST, 0.5, "cpGIMP"}};

const scheme_option scheme_options[SCHEMES] = {{MPM_USL, "USL"}, {MPM_MUSL, "MUSL"}, {MPM_USF, "USF"}};

const transfer_option transfer_options[TRANSFERS] = {{MPM_FLIP, 2, 0, 1.0, 0.0, "FLIP"},
                                                     {MPM_FLIP, 2, 0, 0.9, 0.0, "FLIP 0.9"},
                                                     {MPM_FLIP, 2, 0, 0.0, 0.0, "PIC"},
                                                     {MPM_APIC, 2, 0, 1.0, 0.0, "APIC"},
                                                     {MPM_APIC_MLS, 2, 0, 1.0, 0.0, "MLS"},
                                                     {MPM_FLIP, 2, 0, 0.95, 5.0, "FLIP damped"},
                                                     {MPM_TPIC, 2, 0, 1.0, 0.0, "TPIC"},
                                                     {MPM_TFLIP, 2, 0, 1.0, 0.0, "TFLIP"},
                                                     {MPM_TFLIP, 2, 0, 0.9, 5.0, "TFLIP 0.9 damped"},
                                                     {MPM_AFLIP, 2, 0, 1.0, 0.0, "AFLIP"},
                                                     {MPM_AFLIP, 2, 0, 0.9, 5.0, "AFLIP 0.9 damped"},
                                                     {MPM_XPIC, 1, 0, 1.0, 0.0, "XPIC(1)"},
                                                     {MPM_XPIC, 2, 0, 1.0, 0.0, "XPIC(2)"},
                                                     {MPM_XPIC, 3, 0, 1.0, 0.0, "XPIC(3)"},
                                                     {MPM_XPIC, 5, 0, 1.0, 0.0, "XPIC(5)"},
                                                     {MPM_FMPM, 2, 0, 1.0, 0.0, "FMPM(2)"},
                                                     {MPM_FMPM, 4, 0, 1.0, 0.0, "FMPM(4)"},
                                                     {MPM_FMPM, 3, 2, 0.9, 5.0, "FMPM(3) every other"},
                                                     {MPM_XPIC, 2, 2, 1.0, 0.0, "XPIC(2) every other"}};

const law_option law_options[LAWS] = {{"neo_hookean", "neo-Hookean"},
                                      {"linear_elastic", "linear elastic"},
                                      {"neo_hookean_decoupled", "decoupled"},
                                      {"j2", "J2"},
                                      {"newtonian_fluid", "fluid"},
                                      {"rigid", "rigid"},
                                      {"drucker_prager", "Drucker-Prager"},
                                      {"mohr_coulomb", "Mohr-Coulomb"},
                                      {"herschel_bulkley", "Herschel-Bulkley"},
                                      {"snow", "snow"},
                                      {"mu_i", "mu(I)"},
                                      {"cam_clay", "Cam-clay"},
                                      {NULL, "host law"}};

#define BOTH_SCHEMES(b, t, f, name)                                                                          \
  {METHOD(b, USL, t, f, name " USL")}, {                                                                     \
    METHOD(b, MUSL, t, f, name " MUSL")                                                                      \
  }
#define OPEN_KNOTS .boundary = MPM_BOUNDARY_OPEN_KNOT
const method methods[ALL_METHODS] = {
    BOTH_SCHEMES(BSPLINE2, FLIP, 1.0, "quadratic FLIP"),
    BOTH_SCHEMES(BSPLINE2, FLIP, 0.9, "quadratic blend"),
    BOTH_SCHEMES(BSPLINE2, FLIP, 0.0, "quadratic PIC"),
    BOTH_SCHEMES(BSPLINE2, APIC, 1.0, "quadratic APIC"),
    BOTH_SCHEMES(BSPLINE2, APIC_MLS, 1.0, "quadratic MLS"),
    BOTH_SCHEMES(LINEAR, FLIP, 1.0, "linear FLIP"),
    BOTH_SCHEMES(LINEAR, FLIP, 0.9, "linear blend"),
    BOTH_SCHEMES(LINEAR, FLIP, 0.0, "linear PIC"),
    BOTH_SCHEMES(LINEAR, APIC, 1.0, "linear APIC"),
    {METHOD(BSPLINE2, USL, FLIP, 0.97, "quadratic FLIP 0.97 USL")},
    {METHOD(LINEAR, USL, FLIP, 0.97, "linear FLIP 0.97 USL")},
    {METHOD(BSPLINE3, USF, FLIP, 0.9, "cubic blend USF, remedy"), .remedy = 1},
    {METHOD(BSPLINE3, MUSL, TFLIP, 1.0, "open cubic TFLIP MUSL, staggered"), OPEN_KNOTS, .staggered = 1},
    {METHOD(BSPLINE2, USF, APIC, 1.0, "open quadratic APIC USF, order 2"), OPEN_KNOTS, .position_order = 2},
    {METHOD(GIMP, USF, XPIC, 1.0, "GIMP XPIC(3) USF"), .xpic_order = 3},
    {METHOD(UGIMP, USL, XPIC, 1.0, "uGIMP XPIC(2) USL, remedy, staggered"), .xpic_order = 2, .remedy = 1,
     .staggered = 1},
    {METHOD(CPGIMP, MUSL, AFLIP, 0.95, "cpGIMP AFLIP MUSL, remedy, order 2"), .remedy = 1,
     .position_order = 2},
    {METHOD(BSPLINE2, USF, TPIC, 1.0, "quadratic TPIC USF, staggered"), .staggered = 1},
    {METHOD(BSPLINE3, USL, APIC_MLS, 1.0, "cubic MLS USL, order 2"), .position_order = 2},
    {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "quadratic Newmark")},
    {METHOD(LINEAR, NEWMARK, FLIP, 1.0, "linear Newmark, remedy"), .remedy = 1},
    {METHOD(CPGIMP, NEWMARK, FLIP, 1.0, "cpGIMP Newmark")},
    {METHOD(BSPLINE2, MUSL, FLIP, 1.0, "quadratic FLIP MUSL, projected positions"), .projected = 1},
    {METHOD(BSPLINE2, USL, FMPM, 1.0, "quadratic FMPM(4) USL, order 2"), .xpic_order = 4,
     .position_order = 2},
    {METHOD(BSPLINE3, MUSL, FMPM, 0.95, "cubic FMPM(3) every other MUSL"), .xpic_order = 3, .xpic_every = 2},
};

const method *const broad_methods[BROAD] = {
    &methods[18], &methods[1],  &methods[6],  &methods[7],  &methods[8],  &methods[9],
    &methods[19], &methods[11], &methods[16], &methods[17], &methods[20], &methods[21],
    &methods[22], &methods[23], &methods[24], &methods[25], &methods[26], &methods[27],
    &methods[31], &methods[28], &methods[29], &methods[30], &methods[32], &methods[33]};

method method_of(const basis_option *b, const scheme_option *s, const transfer_option *t) {
  method how = {.basis = b->basis,
                .boundary = b->boundary,
                .smoothing = b->smoothing,
                .scheme = s->scheme,
                .transfer = t->transfer,
                .xpic_order = t->xpic_order,
                .xpic_every = t->xpic_every,
                .flip = t->flip,
                .pic_damping = t->pic_damping};
  snprintf(how.name, sizeof how.name, "%s %s %s", b->name, s->name, t->name);
  return how;
}

void use_basis(const basis_option *b, mpm_grid_desc *grid) {
  grid->basis = b->basis;
  grid->boundary_basis = b->boundary;
  grid->smoothing = b->smoothing;
}

void method_use(const method *how, mpm_grid_desc *grid, mpm_stepper_desc *stepper) {
  if (how->basis) grid->basis = how->basis;
  grid->boundary_basis = how->boundary;
  if (how->smoothing > 0.0) grid->smoothing = how->smoothing;
  if (how->scheme) stepper->scheme = how->scheme;
  if (how->transfer) stepper->transfer = how->transfer;
  if (how->xpic_order) stepper->xpic_order = how->xpic_order;
  stepper->xpic_every = how->xpic_every;
  if (how->position_order) stepper->position_order = how->position_order;
  stepper->flip = how->flip;
  stepper->pic_damping = how->pic_damping;
  stepper->staggered = how->staggered;
  stepper->projected_positions = how->projected;
  stepper->locking_remedy = how->remedy && grid->dim > 1;
}

int32_t has_orders(int32_t transfer) {
  return transfer == MPM_XPIC || transfer == MPM_FMPM;
}

int32_t carries_matrix(int32_t transfer) {
  return transfer != MPM_FLIP && !has_orders(transfer);
}

int32_t is_affine(const method *how) {
  return how->transfer == MPM_APIC || how->transfer == MPM_APIC_MLS;
}

int32_t fits_mls(const basis_option *b) {
  return (b->basis == MPM_BSPLINE2 || b->basis == MPM_BSPLINE3) && b->boundary == MPM_BOUNDARY_GHOST;
}

int32_t keeps_volume_alone(const char *model) {
  return model && (!strcmp(model, "newtonian_fluid") || !strcmp(model, "herschel_bulkley"));
}

int32_t is_gimp(int32_t basis) {
  return basis == MPM_GIMP || basis == MPM_UGIMP || basis == MPM_CPGIMP;
}
