/* CALL XPLB_ABQERR(LOP, STRING, INTV, REALV, CHARV), of VUMATs */
#include "report.h"

void xplb_abqerr_(const int *lop, const char *string, const int *intv, const double *realv, const char *charv,
                  size_t string_length, size_t charv_length);

void xplb_abqerr_(const int *lop, const char *string, const int *intv, const double *realv, const char *charv,
                  size_t string_length, size_t charv_length) {
  (void)charv_length;
  mpmu_report(*lop, string, string_length, intv, realv, charv);
}
