/* Sine, cosine and tangent. x = k pi / 2 + r with |r| <= pi / 4; the series of Taylor are cut after r^19 and
 * r^20. */
#include <math.h>

#include "simd/elementary.h"
#include "simd/rounding.h"
#include "simd/twofold.h"

/* Three parts of pi / 2 with 33 bits each, whose products with k < 2^20 are exact, and what is left: pi / 2
 * to 150 bits, so that r has all of its digits beside every multiple of pi / 2. */
static const double two_over_pi = 0x1.45f306dc9c883p-1;
static const double part_1 = 0x1.921fb54400000p+0, part_2 = 0x1.0b4611a600000p-34,
                    part_3 = 0x1.3198a2e000000p-69, part_4 = 0x1.b839a252049c1p-104;

typedef struct turned {
  mpmi_twofold r;
  int32_t quarter; /* k modulo 4 */
} turned;

static turned turn(double x) {
  const double k = mpmi_round(x * two_over_pi);
  const mpmi_twofold second = mpmi_exact_sum(x - k * part_1, -k * part_2);
  const mpmi_twofold third = mpmi_exact_sum(second.high, -k * part_3);
  turned t;
  t.r = mpmi_exact_sum(third.high, (second.low + third.low) - k * part_4);
  t.quarter = (int32_t)k & 3;
  return t;
}

/* sin r = r + r z (-1/3! + z/5! - ...) with z = r^2. */
static mpmi_twofold sine(mpmi_twofold r) {
  const double z = r.high * r.high;
  double sum = 0.0;
  for (int32_t n = 18; n >= 2; n -= 2) sum = (1.0 + z * sum) / -(double)(n * (n + 1));
  return mpmi_ordered_sum(r.high, r.high * (z * sum) + r.low * (1.0 - 0.5 * z));
}

/* cos r = 1 - z / 2 + z^2 / 2 (1/12 - ...). */
static mpmi_twofold cosine(mpmi_twofold r) {
  const mpmi_twofold square = mpmi_exact_product(r.high, r.high);
  const double z = square.high;
  double sum = 0.0;
  for (int32_t n = 19; n >= 3; n -= 2) sum = (1.0 + z * sum) / -(double)(n * (n + 1));
  const mpmi_twofold most = mpmi_ordered_sum(1.0, -0.5 * z);
  return mpmi_ordered_sum(most.high, most.low - (0.5 * square.low + 0.5 * z * (z * sum) + r.high * r.low));
}

/* Small angles are their own sines and tangents; what is no angle gives NaN. */
static int32_t is_plain(double x, double *value) {
  if (fabs(x) < 0x1p-27 || x != x) {
    *value = x;
    return 1;
  }
  *value = (double)NAN;
  return fabs(x) > 0x1p20;
}

/* sin(x + quarters pi / 2). */
static double turned_sine(double x, int32_t quarters) {
  const turned t = turn(x);
  const int32_t quarter = (t.quarter + quarters) & 3;
  const mpmi_twofold value = quarter & 1 ? cosine(t.r) : sine(t.r);
  return quarter & 2 ? -value.high : value.high;
}

double mpmi_sin(double x) {
  double value;
  return is_plain(x, &value) ? value : turned_sine(x, 0);
}

double mpmi_cos(double x) {
  double value;
  if (is_plain(x, &value)) return value == value ? 1.0 : value;
  return turned_sine(x, 1);
}

double mpmi_tan(double x) {
  double value;
  if (is_plain(x, &value)) return value;
  const turned t = turn(x);
  const mpmi_twofold s = sine(t.r), c = cosine(t.r), minus_c = {-c.high, -c.low};
  return (t.quarter & 1 ? mpmi_twofold_quotient(minus_c, s) : mpmi_twofold_quotient(s, c)).high;
}
