/* The built-in laws. A new law is a file law_NAME.c, which defines
 * const mpmi_law KERNEL(law_NAME), and a line here. */
#ifndef MPMI_LAWS_H
#define MPMI_LAWS_H

#include "material/law.h"

/* In the order of the public list. */
#define MPMI_LAWS(LAW)                                                                                       \
  LAW(neo_hookean)                                                                                           \
  LAW(linear_elastic)                                                                                        \
  LAW(j2)                                                                                                    \
  LAW(neo_hookean_decoupled)                                                                                 \
  LAW(newtonian_fluid)                                                                                       \
  LAW(rigid)                                                                                                 \
  LAW(drucker_prager)                                                                                        \
  LAW(mohr_coulomb)                                                                                          \
  LAW(cam_clay)                                                                                              \
  LAW(herschel_bulkley)                                                                                      \
  LAW(snow)                                                                                                  \
  LAW(mu_i)

#define MPMI_LAW_PLACE(name)   MPMI_LAW_##name,
#define MPMI_DECLARE_LAW(name) MPMI_DECLARE_TABLES(mpmi_law, mpmi_law_##name);
enum { MPMI_LAWS(MPMI_LAW_PLACE) MPMI_LAW_COUNT };
MPMI_LAWS(MPMI_DECLARE_LAW)

/* A law with the kernels of an instruction set, by its place in the list; NULL where there is none. */
const mpmi_law *mpmi_law_of(int32_t isa, int32_t place);

#endif
