#include "context/exact_sum.h"

void mpmi_exact_join(mpmi_whole_sum *to, const mpmi_whole_sum *from) {
  for (int32_t i = 0; i < MPMI_EXACT_DIGITS; ++i) to->digit[i] += from->digit[i];
  for (int32_t i = 0; i < 3; ++i) to->spoilt[i] += from->spoilt[i];
  if (from->top > to->top) to->top = from->top;
}

mpmi_exact_part mpmi_exact_take(const mpmi_whole_sum *sum, int32_t top) {
  mpmi_exact_part part = {{sum->spoilt[0], sum->spoilt[1], sum->spoilt[2]}, {0}};
  for (int32_t i = 0; i < MPMI_EXACT_KEPT; ++i)
    if (top - MPMI_EXACT_KEPT + i >= 0) part.digit[i] = sum->digit[top - MPMI_EXACT_KEPT + i];
  return part;
}

/* Returns 2^exponent, in two factors where it alone is beyond the range of normal numbers. */
static double scaled(double x, int32_t exponent) {
  const int32_t first = exponent < -1000 ? exponent + 200 : exponent;
  const uint64_t bits = (uint64_t)(first + 1023) << 52;
  double factor;
  memcpy(&factor, &bits, sizeof factor);
  x *= factor;
  return first == exponent ? x : x * 0x1p-200;
}

/* Returns a normalized number of digits with a sign of its own. Three digits and a bit that says whether
 * anything follows are rounded once. */
static double round_digits(const uint32_t *digit, int32_t count, int32_t place) {
  int32_t top = count;
  while (top > 0 && !digit[top - 1]) --top;
  if (!top) return 0.0;
  uint64_t rest = 0;
  for (int32_t i = 0; i < top - 3; ++i) rest |= digit[i];
  const uint64_t high = (uint64_t)digit[top - 1] << 32 | (top > 1 ? digit[top - 2] : 0);
  const uint64_t low = (top > 2 ? digit[top - 3] : 0) | (rest != 0);
  /* 64 bits from the highest one on; what is cut off is kept as the last of them */
  int32_t shift = 0;
  while (!(high << shift >> 63)) ++shift;
  uint64_t kept = high << shift | (shift ? low << 32 >> (64 - shift) : 0);
  kept |= (low << 32 << shift) != 0;
  return scaled((double)kept, 32 * (place + top - 2) - shift - 1074);
}

double mpmi_exact_value(const mpmi_exact_part *part, int32_t top) {
  const double infinite = 1.0 / 0.0;
  if (part->spoilt[2] || (part->spoilt[0] && part->spoilt[1])) return infinite - infinite;
  if (part->spoilt[0] || part->spoilt[1]) return part->spoilt[0] ? infinite : -infinite;
  int64_t sum[MPMI_EXACT_KEPT + 1] = {0}, carry = 0;
  for (int32_t i = 0; i < MPMI_EXACT_KEPT; ++i) sum[i] = part->digit[i];
  for (int32_t i = 0; i <= MPMI_EXACT_KEPT; ++i) {
    sum[i] += carry;
    carry = sum[i] >> 32;
    if (i < MPMI_EXACT_KEPT) sum[i] &= 0xffffffff;
  }
  const int32_t negative = sum[MPMI_EXACT_KEPT] < 0;
  uint32_t digit[MPMI_EXACT_KEPT + 1];
  carry = negative;
  for (int32_t i = 0; i <= MPMI_EXACT_KEPT; ++i) { /* of minus the sum, where that is negative */
    const int64_t one = (negative ? ~sum[i] & 0xffffffff : sum[i] & 0xffffffff) + carry;
    digit[i] = (uint32_t)one;
    carry = one >> 32;
  }
  const double value = round_digits(digit, MPMI_EXACT_KEPT + 1, top - MPMI_EXACT_KEPT);
  return negative ? -value : value;
}

double mpmi_exact_total(const mpmi_whole_sum *sum) {
  const mpmi_exact_part part = mpmi_exact_take(sum, sum->top);
  return mpmi_exact_value(&part, sum->top);
}
