/* The methods that tests go through are listed here: every value of each option with the name that tests
 * print, and whole methods made of them. */
#ifndef METHODS_H
#define METHODS_H

#include <mpm/mpm.h>

typedef struct basis_option {
  int32_t basis, boundary;
  double smoothing;
  const char *name;
} basis_option;
enum { BASES = 8 };
extern const basis_option basis_options[BASES];

typedef struct scheme_option {
  int32_t scheme;
  const char *name;
} scheme_option;
enum { SCHEMES = 3 };
extern const scheme_option scheme_options[SCHEMES];

typedef struct transfer_option {
  int32_t transfer, xpic_order, xpic_every;
  double flip, pic_damping;
  const char *name;
} transfer_option;
enum { TRANSFERS = 19 };
extern const transfer_option transfer_options[TRANSFERS];

typedef struct law_option {
  const char *model; /* NULL: the host's */
  const char *name;
} law_option;
enum { LAWS = 13 };
extern const law_option law_options[LAWS];

/* A value that is 0 stands for the default of the library, except flip and pic_damping. */
typedef struct method {
  int32_t basis, scheme, transfer;
  double flip;
  char name[64];
  int32_t boundary, xpic_order, position_order, staggered, remedy, projected; /* no remedy in 1-D */
  double smoothing, pic_damping;
  int32_t xpic_every;
} method;
#define METHOD(b, s, t, flip_, name_)                                                                        \
  .basis = MPM_##b, .scheme = MPM_##s, .transfer = MPM_##t, .flip = flip_, .name = name_

/* The first METHODS are FLIP, a blend, PIC and the affine transfers on two bases, by USL and MUSL in turn;
 * the rest have every further option at least once. */
enum { METHODS = 18, ALL_METHODS = METHODS + 16 };
extern const method methods[ALL_METHODS];
/* Bodies that move go through these: the first are plain, the others have the further options. */
enum { PLAIN = 10, BROAD = PLAIN + 14 };
extern const method *const broad_methods[BROAD];

/* Makes a method of one value of each kind. */
method method_of(const basis_option *b, const scheme_option *s, const transfer_option *t);
void method_use(const method *how, mpm_grid_desc *grid, mpm_stepper_desc *stepper);
void use_basis(const basis_option *b, mpm_grid_desc *grid);

/* Has the transfer orders, xpic_order? */
int32_t has_orders(int32_t transfer);
/* Does the transfer carry a matrix per particle into its projection? */
int32_t carries_matrix(int32_t transfer);
int32_t is_affine(const method *how);
/* Can the basis have MPM_APIC_MLS? */
int32_t fits_mls(const basis_option *basis);
int32_t is_gimp(int32_t basis);
/* Has the law an F that dilates only? */
int32_t keeps_volume_alone(const char *model);

#endif
