/* Every specialisation of scatter and gather that exists; define SCATTER or GATHER before including.
 * name = kernel, dim, width, form. */
#ifdef SCATTER
#define SCATTER_4(dim, width)                                                                                \
  SCATTER(dim, width, MPMI_SCATTER_4, scatter_##dim##_##width##_4)                                           \
  SCATTER(dim, width, MPMI_SCATTER_4_AFFINE, scatter_##dim##_##width##_4_affine)                             \
  SCATTER(dim, width, MPMI_SCATTER_4_UNEVEN, scatter_##dim##_##width##_4_uneven)
#define SCATTER_FLAT(dim, width)                                                                             \
  SCATTER_4(dim, width)                                                                                      \
  SCATTER(dim, width, MPMI_SCATTER_FLAT, scatter_##dim##_##width##_flat)                                     \
  SCATTER(dim, width, MPMI_SCATTER_FLAT_AFFINE, scatter_##dim##_##width##_flat_affine)                       \
  SCATTER(dim, width, MPMI_SCATTER_FLAT_UNEVEN, scatter_##dim##_##width##_flat_uneven)
#define SCATTER_8(dim, width)                                                                                \
  SCATTER_4(dim, width)                                                                                      \
  SCATTER(dim, width, MPMI_SCATTER_8, scatter_##dim##_##width##_8)                                           \
  SCATTER(dim, width, MPMI_SCATTER_8_AFFINE, scatter_##dim##_##width##_8_affine)                             \
  SCATTER(dim, width, MPMI_SCATTER_8_UNEVEN, scatter_##dim##_##width##_8_uneven)
SCATTER_FLAT(1, 2)
SCATTER_FLAT(1, 3)
SCATTER_FLAT(1, 4)
SCATTER_FLAT(2, 2)
SCATTER_FLAT(2, 3)
SCATTER_FLAT(2, 4)
SCATTER_8(3, 2)
SCATTER_8(3, 3)
SCATTER_8(3, 4)
#if MPMI_WIDTH == 8
#define SCATTER_HALVES(width)                                                                                \
  SCATTER(3, width, MPMI_SCATTER_8_HALVES, scatter_3_##width##_8_halves)                                     \
  SCATTER(3, width, MPMI_SCATTER_8_AFFINE_HALVES, scatter_3_##width##_8_affine_halves)
SCATTER_HALVES(2)
SCATTER_HALVES(3)
SCATTER_HALVES(4)
#undef SCATTER_HALVES
#endif
#undef SCATTER_8
#undef SCATTER_FLAT
#undef SCATTER_4
#undef SCATTER
#endif
#ifdef GATHER
#define GATHER_FORMS(dim, width)                                                                             \
  GATHER(dim, width, MPMI_GATHER_MEAN, gather_##dim##_##width##_mean)                                        \
  GATHER(dim, width, MPMI_GATHER_PLAIN, gather_##dim##_##width##_plain)                                      \
  GATHER(dim, width, MPMI_GATHER_AFFINE, gather_##dim##_##width##_affine)                                    \
  GATHER(dim, width, MPMI_GATHER_AFFINE_VARIED, gather_##dim##_##width##_affine_varied)                      \
  GATHER(dim, width, MPMI_GATHER_MLS, gather_##dim##_##width##_mls)                                          \
  GATHER(dim, width, MPMI_GATHER_CHANGE, gather_##dim##_##width##_change)                                    \
  GATHER(dim, width, MPMI_GATHER_BOTH, gather_##dim##_##width##_both)                                        \
  GATHER(dim, width, MPMI_GATHER_BOTH_AFFINE, gather_##dim##_##width##_both_affine)                          \
  GATHER(dim, width, MPMI_GATHER_BOTH_AFFINE_VARIED, gather_##dim##_##width##_both_affine_varied)
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
