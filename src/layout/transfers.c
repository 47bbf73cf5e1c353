#include "layout/transfers.h"
#include "transfer/kernels.h"

#include <stddef.h>

static const mpmi_transfer transfers[] = {
    [MPM_FLIP] = {"FLIP", MPMI_CARRIES_NOTHING, MPMI_TAKES_BLEND, 0, 0, 0},
    [MPM_APIC] = {"APIC", MPMI_CARRIES_MATRIX, MPMI_TAKES_VELOCITY, 0, MPMI_NEED_MOMENT, 0},
    [MPM_XPIC] = {"XPIC", MPMI_CARRIES_NOTHING, MPMI_TAKES_CORRECTED, 5, 0, 0},
    [MPM_TPIC] = {"TPIC", MPMI_CARRIES_GRADIENT, MPMI_TAKES_VELOCITY, 0, MPMI_NEED_MOMENT, 0},
    [MPM_TFLIP] = {"TFLIP", MPMI_CARRIES_GRADIENT, MPMI_TAKES_BLEND, 0, MPMI_NEED_MOMENT, 0},
    [MPM_AFLIP] = {"AFLIP", MPMI_CARRIES_MATRIX, MPMI_TAKES_BLEND, 0, MPMI_NEED_MOMENT, 0},
    [MPM_APIC_MLS] = {"MLS", MPMI_CARRIES_MATRIX, MPMI_TAKES_VELOCITY, 0, MPMI_NEED_MLS, 1},
    [MPM_FMPM] = {"FMPM", MPMI_CARRIES_NOTHING, MPMI_TAKES_FULL, 32, 0, 0},
};

const mpmi_transfer *mpmi_transfer_of(int32_t transfer) {
  const int32_t count = (int32_t)(sizeof transfers / sizeof *transfers);
  return transfer > 0 && transfer < count && transfers[transfer].name ? &transfers[transfer] : NULL;
}
