/* Exponentials, logarithms and roots. The polynomials are those of the kernels (vector_math.h); what these
 * lose by rounding is kept here in second doubles. */
#include "simd/elementary.h"

#include <float.h>
#include <math.h>

#include "simd/twofold.h"
#include "simd/vector_math.h"

static const double least_normal = 0x1p-1022,
                    of_subnormal = 0x1p54; /* makes a subnormal number a normal one */

/* ---- exponentials ----
 * x = k ln 2 + r with |r| <= ln 2 / 2: e^r = 1 + r.high + half_square + tail. */
typedef struct reduced {
  double k;
  mpmi_twofold r;
  double half_square, tail;
} reduced;

static reduced reduce(mpmi_twofold x) {
  reduced a;
  a.k = mpmi_round(x.high * MPMI_LOG2_E);
  a.r = mpmi_exact_sum(x.high - a.k * MPMI_LN2_HIGH, x.low - a.k * MPMI_LN2_LOW);
  const mpmi_twofold square = mpmi_exact_product(a.r.high, a.r.high);
  a.half_square = 0.5 * square.high;
  a.tail =
      a.r.low + (a.r.low * a.r.high + (0.5 * square.low + square.high * (mpmi_exp_series(a.r.high) - 0.5)));
  return a;
}

/* 2^k for a whole k from -1022 to 1023. */
static double power_of_2(double k) {
  return mpmi_from_bits((uint64_t)((int64_t)k + 1023) << 52);
}

/* For x from -746 to 710: so the two powers are normal numbers, and only the last product is rounded. */
static double exp_of(mpmi_twofold x) {
  const reduced a = reduce(x);
  const mpmi_twofold sum = mpmi_ordered_sum(1.0, a.r.high);
  const double half = mpmi_floor(0.5 * a.k);
  return (sum.high + (sum.low + (a.half_square + a.tail))) * power_of_2(half) * power_of_2(a.k - half);
}

double mpmi_exp(double x) {
  if (x != x) return x;
  if (x > 710.0) return (double)INFINITY;
  return x < -746.0 ? 0.0 : exp_of((mpmi_twofold){x, 0.0});
}

double mpmi_expm1(double x) {
  if (x != x || fabs(x) < 0x1p-54) return x;
  if (x < -40.0) return -1.0;
  if (x > 40.0) return mpmi_exp(x) - 1.0;
  const reduced a = reduce((mpmi_twofold){x, 0.0});
  const double power = power_of_2(a.k);
  const mpmi_twofold less = mpmi_exact_sum(power, -1.0), most = mpmi_exact_sum(less.high, power * a.r.high);
  const mpmi_twofold more = mpmi_ordered_sum(most.high, power * a.half_square);
  return more.high + (most.low + (more.low + (less.low + power * a.tail)));
}

/* ---- logarithms ---- */
static mpmi_binade split(double x) {
  if (x >= least_normal) return mpmi_split_binade(x);
  mpmi_binade b = mpmi_split_binade(x * of_subnormal);
  b.k -= 54.0;
  return b;
}

/* k ln 2 + log(1 + f) + small, as in mpmi_log_reduced(). */
static double log_of(double k, double f, double small) {
  const double s = f / (2.0 + f), half_square = 0.5 * f * f;
  const double rest = s * (half_square + mpmi_log_series(s * s));
  const mpmi_twofold sum = mpmi_exact_sum(k * MPMI_LN2_HIGH, f);
  return sum.high + (sum.low - (half_square - (rest + (k * MPMI_LN2_LOW + small))));
}

double mpmi_ln(double x) {
  if (!(x > 0.0)) return x == 0.0 ? -(double)INFINITY : (double)NAN;
  if (x > DBL_MAX) return x;
  const mpmi_binade b = split(x);
  return log_of(b.k, b.f, 0.0);
}

double mpmi_log1p(double x) {
  if (!(x > -1.0)) return x == -1.0 ? -(double)INFINITY : (double)NAN;
  if (x > DBL_MAX || fabs(x) < 0x1p-54) return x;
  const mpmi_twofold sum = mpmi_exact_sum(1.0, x);
  const mpmi_binade b = mpmi_split_binade(sum.high);
  return b.k == 0.0 ? log_of(0.0, x, 0.0) : log_of(b.k, b.f, sum.low / sum.high);
}

/* ---- powers ---- */

/* log x to 65 bits: 2 artanh s = 2 s (1 + z / 3 + z^2 / 5 + ...) with s = f / (2 + f) and z = s^2 < 0.0295,
 * after 16 terms. */
static mpmi_twofold long_log(double x) {
  const mpmi_binade b = split(x);
  const mpmi_twofold s = mpmi_twofold_quotient((mpmi_twofold){b.f, 0.0}, mpmi_ordered_sum(2.0, b.f));
  const mpmi_twofold z = mpmi_twofold_product(s, s), third = {1.0 / 3.0, 0x1p-54 / 3.0};
  double inner = 0.0;
  for (int32_t n = 31; n >= 5; n -= 2) inner = inner * z.high + 1.0 / n;
  mpmi_twofold outer = mpmi_ordered_sum(third.high, z.high * inner);
  outer.low += third.low;
  const mpmi_twofold share = mpmi_twofold_product(z, outer), more = mpmi_twofold_product(s, share);
  mpmi_twofold half = mpmi_ordered_sum(s.high, more.high);
  half.low += s.low + more.low;
  const mpmi_twofold sum = mpmi_exact_sum(b.k * MPMI_LN2_HIGH, 2.0 * half.high);
  return mpmi_ordered_sum(sum.high, sum.low + (2.0 * half.low + b.k * MPMI_LN2_LOW));
}

/* x^y for 0 < x < infinity. */
static double pow_of(double x, double y) {
  if (x == 1.0) return 1.0;
  if (fabs(y) > 0x1p65) return (x > 1.0) == (y > 0.0) ? (double)INFINITY : 0.0;
  const mpmi_twofold log_x = long_log(x);
  mpmi_twofold product = mpmi_exact_product(y, log_x.high);
  if (product.high > 710.0) return (double)INFINITY;
  if (product.high < -746.0) return 0.0;
  product.low += y * log_x.low;
  return exp_of(product);
}

double mpmi_pow(double x, double y) {
  if (y == 0.0 || x == 1.0) return 1.0;
  if (x != x || y != y) return x + y;
  const int32_t whole = floor(y) == y, odd = whole && fabs(y) < 0x1p53 && floor(0.5 * y) != 0.5 * y;
  const double sign = odd ? copysign(1.0, x) : 1.0, size = fabs(x);
  if (size == 0.0) return sign * (y > 0.0 ? 0.0 : (double)INFINITY);
  if (size > DBL_MAX) return sign * (y > 0.0 ? (double)INFINITY : 0.0);
  return x < 0.0 && !whole ? (double)NAN : sign * pow_of(size, y);
}

/* ---- roots ---- */

/* Bits of a double, as a number, grow nearly like its logarithm: a third of them and two thirds of those of
 * 1, less 3.4 % of a binade, are those of the root within 3.2 %. Two of Halley's steps make that 1e-13. The
 * last one starts from the 26 upper bits, whose square is exact. */
static const uint64_t two_thirds_of_1 = UINT64_C(0x2a9f74bc6a7ef9dc);

double mpmi_cbrt(double x) {
  if (x != x || x == 0.0 || fabs(x) > DBL_MAX) return x;
  const double scale = fabs(x) < least_normal ? of_subnormal : fabs(x) > 0x1p1000 ? 0x1p-54 : 1.0;
  const double size = fabs(x) * scale;
  double t = mpmi_from_bits(mpmi_bits_of(size) / 3 + two_thirds_of_1);
  for (int32_t i = 0; i < 2; ++i) {
    const double cube = t * t * t;
    t *= (cube + 2.0 * size) / (2.0 * cube + size);
  }
  t = mpmi_upper_half(t);
  const double quotient = size / (t * t);
  t += t * ((quotient - t) / (2.0 * t + quotient));
  return copysign(scale > 1.0 ? t * 0x1p-18 : scale < 1.0 ? t * 0x1p18 : t, x);
}

double mpmi_hypot(double x, double y) {
  const double a = mpmi_max(fabs(x), fabs(y)), b = mpmi_min(fabs(x), fabs(y));
  if (fabs(x) > DBL_MAX || fabs(y) > DBL_MAX) return (double)INFINITY;
  if (x != x || y != y) return x + y;
  if (a * 0x1p-60 >= b) return a + b;
  const double scale = a > 0x1p480 ? 0x1p-600 : b < 0x1p-400 ? 0x1p600 : 1.0, back = 1.0 / scale;
  const mpmi_twofold aa = mpmi_exact_product(a * scale, a * scale),
                     bb = mpmi_exact_product(b * scale, b * scale);
  const mpmi_twofold sum = mpmi_ordered_sum(aa.high, bb.high);
  const double root = sqrt(sum.high);
  const mpmi_twofold square = mpmi_exact_product(root, root);
  const double rest = ((sum.high - square.high) - square.low) + (sum.low + (aa.low + bb.low));
  return (root + rest / (2.0 * root)) * back;
}
