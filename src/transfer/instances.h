/* Every specialisation of scatter and gather that exists; define SCATTER or GATHER before including.
 * name = kernel, dim, width, form. */
#ifdef SCATTER
#if MPMI_WIDTH == 8
#define SCATTER_HALVES(dim, width)                                                                           \
  SCATTER(dim, width, MPMI_SCATTER_8_HALVES, scatter_##dim##_##width##_8_halves)
#else
#define SCATTER_HALVES(dim, width)
#endif
#define SCATTER_FORMS(dim, width)                                                                            \
  SCATTER_HALVES(dim, width)                                                                                 \
  SCATTER(dim, width, MPMI_SCATTER_4, scatter_##dim##_##width##_4)                                           \
  SCATTER(dim, width, MPMI_SCATTER_4_AFFINE, scatter_##dim##_##width##_4_affine)                             \
  SCATTER(dim, width, MPMI_SCATTER_4_UNEVEN, scatter_##dim##_##width##_4_uneven)                             \
  SCATTER(dim, width, MPMI_SCATTER_8, scatter_##dim##_##width##_8)                                           \
  SCATTER(dim, width, MPMI_SCATTER_8_AFFINE, scatter_##dim##_##width##_8_affine)
SCATTER_FORMS(1, 2)
SCATTER_FORMS(1, 3)
SCATTER_FORMS(1, 4)
SCATTER_FORMS(2, 2)
SCATTER_FORMS(2, 3)
SCATTER_FORMS(2, 4)
SCATTER_FORMS(3, 2)
SCATTER_FORMS(3, 3)
SCATTER_FORMS(3, 4)
#undef SCATTER_FORMS
#undef SCATTER_HALVES
#undef SCATTER
#endif
#ifdef GATHER
#define GATHER_FORMS(dim, width)                                                                             \
  GATHER(dim, width, MPMI_GATHER_PLAIN, gather_##dim##_##width##_plain)                                      \
  GATHER(dim, width, MPMI_GATHER_AFFINE, gather_##dim##_##width##_affine)                                    \
  GATHER(dim, width, MPMI_GATHER_MLS, gather_##dim##_##width##_mls)                                          \
  GATHER(dim, width, MPMI_GATHER_BOTH, gather_##dim##_##width##_both)                                        \
  GATHER(dim, width, MPMI_GATHER_BOTH_AFFINE, gather_##dim##_##width##_both_affine)
GATHER_FORMS(1, 2)
GATHER_FORMS(1, 3)
GATHER_FORMS(1, 4)
GATHER_FORMS(2, 2)
GATHER_FORMS(2, 3)
GATHER_FORMS(2, 4)
GATHER_FORMS(3, 2)
GATHER_FORMS(3, 3)
GATHER_FORMS(3, 4)
#undef GATHER_FORMS
#undef GATHER
#endif
