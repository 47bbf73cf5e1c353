/* Sums whose bits depend neither on the order of their terms nor on who adds which: every term is cut at the
 * same places of a fixed-point number that is as long as the range of doubles, and integers are added. Sums
 * that were made apart are joined by adding their digits. */
#ifndef MPMI_EXACT_SUM_H
#define MPMI_EXACT_SUM_H

#include <stdint.h>
#include <string.h>

/* Digit i counts 2^(32 i - 1074). A term gives less than 2^33 to a digit, so that 2^30 terms fit. */
enum { MPMI_EXACT_DIGITS = 66, MPMI_EXACT_KEPT = 5 };

typedef struct mpmi_whole_sum {
  int32_t top;       /* above the highest digit that any term has reached */
  int64_t spoilt[3]; /* how many terms were infinite, minus infinite, not a number */
  int64_t digit[MPMI_EXACT_DIGITS];
} mpmi_whole_sum;

/* What is left of a sum to make a number of: as many digits as matter. */
typedef struct mpmi_exact_part {
  int64_t spoilt[3], digit[MPMI_EXACT_KEPT];
} mpmi_exact_part;

static inline void mpmi_exact_clear(mpmi_whole_sum *sum) {
  memset(sum, 0, sizeof *sum);
}

static inline void mpmi_exact_add(mpmi_whole_sum *sum, double term) {
  uint64_t bits;
  memcpy(&bits, &term, sizeof bits);
  const int32_t exponent = (int32_t)(bits >> 52 & 0x7ff);
  const uint64_t fraction = bits & 0xfffffffffffffu;
  if (exponent == 0x7ff) {
    ++sum->spoilt[fraction ? 2 : bits >> 63];
    return;
  }
  if (!(bits << 1)) return;
  const uint64_t mantissa = exponent ? fraction | (uint64_t)1 << 52 : fraction;
  const int32_t place = exponent ? exponent - 1 : 0, at = place / 32, shift = place % 32;
  const uint64_t low = (mantissa & 0xffffffffu) << shift, high = (mantissa >> 32) << shift;
  const int64_t sign = bits >> 63 ? -1 : 1;
  sum->digit[at] += sign * (int64_t)(low & 0xffffffffu);
  sum->digit[at + 1] += sign * (int64_t)((low >> 32) + (high & 0xffffffffu));
  sum->digit[at + 2] += sign * (int64_t)(high >> 32);
  if (at + 3 > sum->top) sum->top = at + 3;
}

/* Adds the terms of another sum. */
void mpmi_exact_join(mpmi_whole_sum *to, const mpmi_whole_sum *from);
/* Takes the digits below `top`, which is that of all that will be added together. */
mpmi_exact_part mpmi_exact_take(const mpmi_whole_sum *sum, int32_t top);
/* Returns the number, within half a unit in the last place of the sum or 2^-64 of its largest term. */
double mpmi_exact_value(const mpmi_exact_part *part, int32_t top);
/* Does both for a sum that is whole. */
double mpmi_exact_total(const mpmi_whole_sum *sum);

#endif
