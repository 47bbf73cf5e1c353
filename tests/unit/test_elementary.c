/* The library's own elementary functions: against those of long double where that has more digits than
 * double, and bit for bit against what they are on every platform. */
#include <check.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "simd/elementary.h"

static uint64_t scrambled(uint64_t x) {
  x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
  return x ^ x >> 31;
}

static double of_bits(uint64_t bits) {
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

static uint64_t bits_of(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

/* The i-th number within [low, high]; every fourth one has any exponent, and lies outside only where no such
 * one is found. */
static double argument(uint64_t i, double low, double high) {
  const uint64_t word = scrambled(UINT64_C(0x9e3779b97f4a7c15) * (i + 1));
  const double any = of_bits(word);
  if (i % 4 == 3 && any >= low && any <= high) return any;
  return low + (high - low) * ((double)(word >> 11) * 0x1p-53);
}

typedef struct function {
  const char *name;
  double (*own)(double);
  long double (*reference)(long double);
  double low, high;
  uint64_t bits; /* of the values of SOME arguments */
} function;
typedef struct function_of_two {
  const char *name;
  double (*own)(double, double);
  long double (*reference)(long double, long double);
  double low[2], high[2];
  uint64_t bits;
} function_of_two;

enum { SOME = 2000, MANY = 40000, FUNCTIONS = 18, FUNCTIONS_OF_TWO = 6 };

static const function functions[FUNCTIONS] = {
    {"exp", mpmi_exp, expl, -1.0, 1.0, UINT64_C(0x4ca7fca54765a184)},
    {"exp", mpmi_exp, expl, -745.0, 709.7, UINT64_C(0x8341d795dd2f79e7)},
    {"expm1", mpmi_expm1, expm1l, -1.0, 1.0, UINT64_C(0x5da1d9be86f4bf96)},
    {"expm1", mpmi_expm1, expm1l, -41.0, 60.0, UINT64_C(0xd210dffe584bb99b)},
    {"expm1", mpmi_expm1, expm1l, 0.3, 0.5, UINT64_C(0x5e63c7a72302d2af)},
    {"log", mpmi_ln, logl, 0.5, 2.0, UINT64_C(0x80e4b76bc85b264c)},
    {"log", mpmi_ln, logl, 0.0, DBL_MAX, UINT64_C(0x8ec484a52d9ca7f5)},
    {"log1p", mpmi_log1p, log1pl, -0.5, 0.5, UINT64_C(0xed756508af5692ab)},
    {"log1p", mpmi_log1p, log1pl, -1.0, 10.0, UINT64_C(0x77f2baf2c2369236)},
    {"log1p", mpmi_log1p, log1pl, -1.0, DBL_MAX, UINT64_C(0xe8ca0feff394c7c8)},
    {"cbrt", mpmi_cbrt, cbrtl, -8.0, 8.0, UINT64_C(0x7486004b2f8ec65d)},
    {"cbrt", mpmi_cbrt, cbrtl, 0.0, DBL_MAX, UINT64_C(0x4719bd57a18f5f90)},
    {"sin", mpmi_sin, sinl, -4.0, 4.0, UINT64_C(0x90823d3b4501e897)},
    {"sin", mpmi_sin, sinl, -0x1p20, 0x1p20, UINT64_C(0xfc5f91efd14903f4)},
    {"cos", mpmi_cos, cosl, -4.0, 4.0, UINT64_C(0xbc2edee23835feda)},
    {"cos", mpmi_cos, cosl, -0x1p20, 0x1p20, UINT64_C(0x3f505984cff11da4)},
    {"tan", mpmi_tan, tanl, -4.0, 4.0, UINT64_C(0xf3dc4a128727630a)},
    {"tan", mpmi_tan, tanl, -0x1p20, 0x1p20, UINT64_C(0x186d13d8bf8c359c)},
};
static const function_of_two functions_of_two[FUNCTIONS_OF_TWO] = {
    {"pow", mpmi_pow, powl, {0.0, -100.0}, {10.0, 100.0}, UINT64_C(0xeecb0d85b5dbe9de)},
    {"pow", mpmi_pow, powl, {0.9, -6000.0}, {1.1, 6000.0}, UINT64_C(0xd1f3c68e5708ca9e)},
    {"pow", mpmi_pow, powl, {0.0, -3.0}, {1e300, 3.0}, UINT64_C(0x9af63c4ece9f4e15)},
    {"hypot", mpmi_hypot, hypotl, {-1.0, -1.0}, {1.0, 1.0}, UINT64_C(0xf705f50de963f6c9)},
    {"hypot", mpmi_hypot, hypotl, {0.0, 0.0}, {1e300, 1e300}, UINT64_C(0x76a6f99a1d9b09b6)},
    {"hypot", mpmi_hypot, hypotl, {0.0, 0.0}, {1e-300, 1e-300}, UINT64_C(0x94c28346ba2e3111)},
};

/* ---- against long double ---- */

/* Off by how many units in the last place of the true value. */
static double error_of(double own, long double truth) {
  const double rounded = (double)truth;
  if (own == rounded) return 0.0; /* infinite ones as well */
  int exponent;
  frexp(rounded, &exponent);
  return (double)fabsl((long double)own - truth) / ldexp(1.0, exponent < -1021 ? -1074 : exponent - 53);
}

static void ck_near(const char *name, double x, double y, double own, long double truth) {
  const double error = error_of(own, truth);
  ck_assert_msg(error <= 1.0, "%s(%a, %a) is %a, off by %g units in the last place of %La", name, x, y, own,
                error, truth);
}

START_TEST(within_a_unit) {
  if (LDBL_MANT_DIG < 64) return;
  const function *f = &functions[_i];
  for (uint64_t i = 0; i < MANY; ++i) {
    const double x = argument(i, f->low, f->high);
    ck_near(f->name, x, 0.0, f->own(x), f->reference((long double)x));
  }
  /* one after another, where binades and quarters of a turn begin */
  static const double beginnings[] = {0.34657359027997264,
                                      0.7071067811865476,
                                      1.0,
                                      1.4142135623730951,
                                      0.7853981633974483,
                                      1.5707963267948966,
                                      3.141592653589793,
                                      36.7,
                                      0x1p-27,
                                      0x1p-54};
  for (size_t k = 0; k < sizeof beginnings / sizeof *beginnings; ++k)
    for (uint64_t i = 0; i < 400; ++i) {
      const double x = of_bits(bits_of(beginnings[k]) - 200 + i);
      if (x >= f->low && x <= f->high) ck_near(f->name, x, 0.0, f->own(x), f->reference((long double)x));
    }
}
END_TEST

START_TEST(of_two_within_a_unit) {
  if (LDBL_MANT_DIG < 64) return;
  const function_of_two *f = &functions_of_two[_i];
  for (uint64_t i = 0; i < MANY; ++i) {
    const double x = argument(2 * i, f->low[0], f->high[0]), y = argument(2 * i + 1, f->low[1], f->high[1]);
    ck_near(f->name, x, y, f->own(x, y), f->reference((long double)x, (long double)y));
  }
}
END_TEST

/* Beside multiples of pi / 2, where an argument has lost all digits but those that a long pi keeps. */
START_TEST(quarters_of_a_turn) {
  if (LDBL_MANT_DIG < 64) return;
  for (int32_t k = 1; k < 660000; k += 1 + k / 64) {
    const double x = k * 1.5707963267948966;
    ck_near("sin", x, 0.0, mpmi_sin(x), sinl((long double)x));
    ck_near("cos", x, 0.0, mpmi_cos(x), cosl((long double)x));
    ck_near("tan", x, 0.0, mpmi_tan(x), tanl((long double)x));
  }
}
END_TEST

/* ---- special values: those of C ---- */
static const double special[] = {0.0,
                                 -0.0,
                                 0.5,
                                 -0.5,
                                 1.0,
                                 -1.0,
                                 2.0,
                                 -2.0,
                                 3.0,
                                 -3.0,
                                 1e300,
                                 -1e300,
                                 1e-310,
                                 -1e-310,
                                 (double)INFINITY,
                                 -(double)INFINITY,
                                 (double)NAN,
                                 0x1p53,
                                 -0x1p53,
                                 0x1.fffffffffffffp52,
                                 -0x1.fffffffffffffp52};
enum { SPECIAL = sizeof special / sizeof *special };

static void ck_like(const char *name, double x, double y, double own, double libm) {
  if (libm != libm) {
    ck_assert_msg(own != own, "%s(%a, %a) is %a and no number in C", name, x, y, own);
  } else if (libm == 0.0 || isinf(libm)) {
    ck_assert_msg(own == libm && !signbit(own) == !signbit(libm), "%s(%a, %a) is %a, %a in C", name, x, y,
                  own, libm);
  } else {
    ck_assert_msg(fabs(own - libm) <= fabs(libm) * 4e-16 + 0x1p-1073, "%s(%a, %a) is %a, %a in C", name, x, y,
                  own, libm);
  }
}

START_TEST(special_values) {
  for (int32_t i = 0; i < SPECIAL; ++i) {
    const double x = special[i];
    ck_like("exp", x, 0.0, mpmi_exp(x), exp(x));
    ck_like("expm1", x, 0.0, mpmi_expm1(x), expm1(x));
    ck_like("log", x, 0.0, mpmi_ln(x), log(x));
    ck_like("log1p", x, 0.0, mpmi_log1p(x), log1p(x));
    ck_like("cbrt", x, 0.0, mpmi_cbrt(x), cbrt(x));
    const int32_t no_angle = fabs(x) > 0x1p20;
    ck_like("sin", x, 0.0, mpmi_sin(x), no_angle ? (double)NAN : sin(x));
    ck_like("cos", x, 0.0, mpmi_cos(x), no_angle ? (double)NAN : cos(x));
    ck_like("tan", x, 0.0, mpmi_tan(x), no_angle ? (double)NAN : tan(x));
    for (int32_t k = 0; k < SPECIAL; ++k) {
      ck_like("pow", x, special[k], mpmi_pow(x, special[k]), pow(x, special[k]));
      ck_like("hypot", x, special[k], mpmi_hypot(x, special[k]), hypot(x, special[k]));
    }
  }
}
END_TEST

/* ---- the same bits everywhere ---- */
static void fold(uint64_t *hash, double value) {
  *hash = scrambled((*hash ^ bits_of(value)) + UINT64_C(0x9e3779b97f4a7c15));
}

START_TEST(known_bits) {
  for (int32_t k = 0; k < FUNCTIONS; ++k) {
    const function *f = &functions[k];
    uint64_t hash = 0;
    for (uint64_t i = 0; i < SOME; ++i) fold(&hash, f->own(argument(i, f->low, f->high)));
    ck_assert_msg(hash == f->bits, "%s on [%g, %g]: bits 0x%016" PRIx64, f->name, f->low, f->high, hash);
  }
  for (int32_t k = 0; k < FUNCTIONS_OF_TWO; ++k) {
    const function_of_two *f = &functions_of_two[k];
    uint64_t hash = 0;
    for (uint64_t i = 0; i < SOME; ++i)
      fold(&hash, f->own(argument(2 * i, f->low[0], f->high[0]), argument(2 * i + 1, f->low[1], f->high[1])));
    ck_assert_msg(hash == f->bits, "%s of two: bits 0x%016" PRIx64, f->name, hash);
  }
}
END_TEST

Suite *elementary_suite(void) {
  Suite *suite = suite_create("elementary");
  TCase *tests = tcase_create("functions");
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, within_a_unit, 0, FUNCTIONS);
  tcase_add_loop_test(tests, of_two_within_a_unit, 0, FUNCTIONS_OF_TWO);
  tcase_add_test(tests, quarters_of_a_turn);
  tcase_add_test(tests, special_values);
  tcase_add_test(tests, known_bits);
  suite_add_tcase(suite, tests);
  return suite;
}
