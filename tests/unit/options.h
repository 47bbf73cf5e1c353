/* The options of the explicit method, each with the name that tests print, and which of them
 * the library does not have yet. A test that goes through a table here skips what is not ready
 * and needs no change when it comes. */
#ifndef OPTIONS_H
#define OPTIONS_H

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
  int32_t transfer, xpic_order;
  double flip, pic_damping;
  const char *name;
} transfer_option;
enum { TRANSFERS = 15 };
extern const transfer_option transfer_options[TRANSFERS];

typedef struct law_option {
  const char *model; /* NULL: the host's, run_neo_hookean of run_support.h */
  const char *name;
} law_option;
enum { LAWS = 7 };
extern const law_option law_options[LAWS];

/* Kinds of values in the list of what is not there yet. */
enum {
  OPTION_BASIS = 1,
  OPTION_BOUNDARY,
  OPTION_SCHEME,
  OPTION_TRANSFER,
  OPTION_LAW, /* index into law_options */
  OPTION_POSITION_ORDER,
  OPTION_STAGGERED,
  OPTION_LOCKING,
  OPTION_PIC_DAMPING
};
typedef struct option_value {
  int32_t kind, value;
} option_value;
/* Ends with kind 0. */
extern const option_value options_not_yet[];

int32_t option_ready(int32_t kind, int32_t value);
int32_t basis_ready(const basis_option *basis);
int32_t scheme_ready(const scheme_option *scheme);
int32_t transfer_ready(const transfer_option *transfer);
int32_t law_ready(int32_t law);
/* Of a stepper: scheme, transfer, position order, staggering, remedy and damping. */
int32_t stepper_ready(const mpm_stepper_desc *desc);

/* Does the transfer carry a matrix per particle into its projection? */
int32_t carries_matrix(int32_t transfer);
/* Can the basis have MPM_APIC_MLS? */
int32_t fits_mls(const basis_option *basis);
int32_t is_gimp(int32_t basis);

#endif
