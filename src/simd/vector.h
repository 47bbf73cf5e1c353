/* The values of one node, or of one particle as nodes receive them, in whole registers of the instruction
 * set: four doubles, or eight as two halves. */
#ifndef MPMI_VECTOR_H
#define MPMI_VECTOR_H

#include "simd/isa.h"
#include "simd/lanes.h"
#include "simd/shuffle.h"

/* Hides from the compiler what an address is the sum of: it would add that up anew for each node of a
 * stencil, or hand every load two registers, which takes some processors two steps. */
#define MPMI_SETTLE(address) __asm__("" : "+r"(address))

#if MPMI_WIDTH >= 4
typedef double mpmi_v4 __attribute__((vector_size(32)));

/* Returns v, a product, rounded: the compiler would make a multiply-add of its sum with something, of which
 * processors do less at a time than of additions and multiply-adds beside each other. */
MPMI_INLINE mpmi_v4 mpmi_round4(mpmi_v4 v) {
#if MPMI_WIDTH == 8
  __asm__("" : "+v"(v));
#elif defined(__AVX2__)
  __asm__("" : "+x"(v));
#endif
  return v;
}

MPMI_INLINE mpmi_v4 mpmi_zero4(void) {
  return (mpmi_v4){0.0, 0.0, 0.0, 0.0};
}
MPMI_INLINE mpmi_v4 mpmi_load4(const double *a) {
  mpmi_v4 r;
  __builtin_memcpy(&r, a, sizeof r);
  return r;
}
MPMI_INLINE void mpmi_store4(double *a, mpmi_v4 v) {
  __builtin_memcpy(a, &v, sizeof v);
}
MPMI_INLINE mpmi_v4 mpmi_scale4(double s, mpmi_v4 v) {
  return s * v;
}
MPMI_INLINE mpmi_v4 mpmi_fma4(mpmi_v4 a, double s, mpmi_v4 v) {
  return a + s * v;
}
MPMI_INLINE mpmi_v4 mpmi_sum4(mpmi_v4 a, mpmi_v4 b) {
  return a + b;
}
MPMI_INLINE mpmi_v4 mpmi_difference4(mpmi_v4 a, mpmi_v4 b) {
  return a - b;
}
MPMI_INLINE void mpmi_transpose4(mpmi_v4 *a, mpmi_v4 *b, mpmi_v4 *c, mpmi_v4 *d) {
  mpmi_v4 ab_even = MPMI_SHUFFLE(*a, *b, 0, 4, 2, 6), ab_odd = MPMI_SHUFFLE(*a, *b, 1, 5, 3, 7);
  mpmi_v4 cd_even = MPMI_SHUFFLE(*c, *d, 0, 4, 2, 6), cd_odd = MPMI_SHUFFLE(*c, *d, 1, 5, 3, 7);
  *a = MPMI_SHUFFLE(ab_even, cd_even, 0, 1, 4, 5);
  *b = MPMI_SHUFFLE(ab_odd, cd_odd, 0, 1, 4, 5);
  *c = MPMI_SHUFFLE(ab_even, cd_even, 2, 3, 6, 7);
  *d = MPMI_SHUFFLE(ab_odd, cd_odd, 2, 3, 6, 7);
}

/* The first two values of each, and the last two. */
MPMI_INLINE mpmi_v4 mpmi_pair4(mpmi_v4 a, mpmi_v4 b) {
  return MPMI_SHUFFLE(a, b, 0, 1, 4, 5);
}
MPMI_INLINE mpmi_v4 mpmi_last_pair4(mpmi_v4 a, mpmi_v4 b) {
  return MPMI_SHUFFLE(a, b, 2, 3, 6, 7);
}
MPMI_INLINE mpmi_v4 mpmi_set4(double a, double b, double c, double d) {
  return (mpmi_v4){a, b, c, d};
}
/* a + s v with one factor for the first two values and another for the last two. */
MPMI_INLINE mpmi_v4 mpmi_fma_pair4(mpmi_v4 a, double first, double last, mpmi_v4 v) {
  return a + (mpmi_v4){first, first, last, last} * v;
}

#else
/* 128-bit registers: compilers split wider vectors badly, so they come in two halves. */
typedef double mpmi_v2 __attribute__((vector_size(16)));
typedef struct mpmi_v4 {
  mpmi_v2 low, high;
} mpmi_v4;

/* Returns v rounded, as above. */
MPMI_INLINE mpmi_v4 mpmi_round4(mpmi_v4 v) {
#if defined(__aarch64__)
  __asm__("" : "+w"(v.low), "+w"(v.high));
#endif
  return v;
}

MPMI_INLINE mpmi_v4 mpmi_zero4(void) {
  return (mpmi_v4){{0.0, 0.0}, {0.0, 0.0}};
}
MPMI_INLINE mpmi_v4 mpmi_load4(const double *a) {
  mpmi_v4 r;
  __builtin_memcpy(&r.low, a, sizeof r.low);
  __builtin_memcpy(&r.high, a + 2, sizeof r.high);
  return r;
}
MPMI_INLINE void mpmi_store4(double *a, mpmi_v4 v) {
  __builtin_memcpy(a, &v.low, sizeof v.low);
  __builtin_memcpy(a + 2, &v.high, sizeof v.high);
}
MPMI_INLINE mpmi_v4 mpmi_scale4(double s, mpmi_v4 v) {
  return (mpmi_v4){s * v.low, s * v.high};
}
MPMI_INLINE mpmi_v4 mpmi_fma4(mpmi_v4 a, double s, mpmi_v4 v) {
  return (mpmi_v4){a.low + s * v.low, a.high + s * v.high};
}
MPMI_INLINE mpmi_v4 mpmi_sum4(mpmi_v4 a, mpmi_v4 b) {
  return (mpmi_v4){a.low + b.low, a.high + b.high};
}
MPMI_INLINE mpmi_v4 mpmi_difference4(mpmi_v4 a, mpmi_v4 b) {
  return (mpmi_v4){a.low - b.low, a.high - b.high};
}
MPMI_INLINE void mpmi_transpose4(mpmi_v4 *a, mpmi_v4 *b, mpmi_v4 *c, mpmi_v4 *d) {
  const mpmi_v4 ta = *a, tb = *b, tc = *c, td = *d;
  a->low = MPMI_SHUFFLE(ta.low, tb.low, 0, 2);
  a->high = MPMI_SHUFFLE(tc.low, td.low, 0, 2);
  b->low = MPMI_SHUFFLE(ta.low, tb.low, 1, 3);
  b->high = MPMI_SHUFFLE(tc.low, td.low, 1, 3);
  c->low = MPMI_SHUFFLE(ta.high, tb.high, 0, 2);
  c->high = MPMI_SHUFFLE(tc.high, td.high, 0, 2);
  d->low = MPMI_SHUFFLE(ta.high, tb.high, 1, 3);
  d->high = MPMI_SHUFFLE(tc.high, td.high, 1, 3);
}
MPMI_INLINE mpmi_v4 mpmi_pair4(mpmi_v4 a, mpmi_v4 b) {
  return (mpmi_v4){a.low, b.low};
}
MPMI_INLINE mpmi_v4 mpmi_last_pair4(mpmi_v4 a, mpmi_v4 b) {
  return (mpmi_v4){a.high, b.high};
}
MPMI_INLINE mpmi_v4 mpmi_set4(double a, double b, double c, double d) {
  return (mpmi_v4){{a, b}, {c, d}};
}
MPMI_INLINE mpmi_v4 mpmi_fma_pair4(mpmi_v4 a, double first, double last, mpmi_v4 v) {
  return (mpmi_v4){a.low + first * v.low, a.high + last * v.high};
}
#endif

/* The values of a node: four (LOW) or eight (BOTH). Operands whose lower half, or the factor of it, is zero
 * may be taken as HIGH. The part is always a constant. */
enum { MPMI_LOW = 1, MPMI_HIGH = 2, MPMI_BOTH = 3 };

#if MPMI_WIDTH == 8
/* The halves of a register, and a register of two halves. */
MPMI_INLINE mpmi_v4 mpmi_low_half(mpmi_lanes v) {
#if defined(__clang__) || __GNUC__ >= 12
  return __builtin_shufflevector(v, v, 0, 1, 2, 3);
#else
  mpmi_v4 half;
  __builtin_memcpy(&half, &v, sizeof half);
  return half;
#endif
}
MPMI_INLINE mpmi_v4 mpmi_high_half(mpmi_lanes v) {
#if defined(__clang__) || __GNUC__ >= 12
  return __builtin_shufflevector(v, v, 4, 5, 6, 7);
#else
  mpmi_v4 half;
  __builtin_memcpy(&half, (const char *)&v + sizeof half, sizeof half);
  return half;
#endif
}
MPMI_INLINE mpmi_lanes mpmi_of_halves(mpmi_v4 low, mpmi_v4 high) {
#if defined(__clang__) || __GNUC__ >= 12
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#else
  mpmi_lanes v;
  __builtin_memcpy(&v, &low, sizeof low);
  __builtin_memcpy((char *)&v + sizeof low, &high, sizeof high);
  return v;
#endif
}

/* A node of eight of which the lower half counts alone is worked with in half of the register: `four` is
 * always that half of `eight`, which costs nothing. Parts that begin with HALVES are two halves in registers
 * of their own, `four` and `high`, and have no `eight`. */
enum { MPMI_HALF = MPMI_LOW, MPMI_HALVES_HIGH = 6, MPMI_HALVES_BOTH = 7 };
/* Returns the upper half of a part. */
MPMI_INLINE int32_t mpmi_high_part(int32_t part) {
  return part >= MPMI_HALVES_HIGH ? MPMI_HALVES_HIGH : MPMI_HIGH;
}
typedef struct mpmi_node {
  mpmi_v4 four, high;
  mpmi_lanes eight;
} mpmi_node;
/* Weights that differ between the halves: momentum takes moments of the basis where force takes gradients. */
typedef mpmi_lanes mpmi_pair;

MPMI_INLINE mpmi_node mpmi_node_of4(mpmi_v4 four) {
  return (mpmi_node){four, {0.0}, {0.0}};
}
MPMI_INLINE mpmi_node mpmi_node_of_halves(mpmi_v4 low, mpmi_v4 high) {
  return (mpmi_node){low, high, {0.0}};
}
MPMI_INLINE mpmi_node mpmi_node_of8(mpmi_lanes eight) {
  return (mpmi_node){mpmi_low_half(eight), {0.0}, eight};
}
MPMI_INLINE mpmi_node mpmi_node_zero(void) {
  return (mpmi_node){{0.0}, {0.0}, {0.0}};
}
MPMI_INLINE mpmi_node mpmi_node_load(int32_t part, const double *a) {
  if (part == MPMI_HALVES_BOTH) return mpmi_node_of_halves(mpmi_load4(a), mpmi_load4(a + 4));
  return part == MPMI_LOW ? mpmi_node_of4(mpmi_load4(a)) : mpmi_node_of8(mpmi_lanes_load(a));
}
/* Loads two halves from where each of them is. */
MPMI_INLINE mpmi_node mpmi_node_load_halves(const double *low, const double *high) {
  return mpmi_node_of_halves(mpmi_load4(low), mpmi_load4(high));
}
/* Loads the upper half alone; the lower half is zero. */
MPMI_INLINE mpmi_node mpmi_node_load_high(int32_t part, const double *a) {
  if (part == MPMI_HALVES_HIGH) return mpmi_node_of_halves(mpmi_zero4(), mpmi_load4(a));
  return mpmi_node_of8(mpmi_of_halves(mpmi_zero4(), mpmi_load4(a)));
}
MPMI_INLINE void mpmi_node_store(int32_t part, double *a, mpmi_node v) {
  if (part == MPMI_LOW || part == MPMI_HALVES_BOTH) mpmi_store4(a, v.four);
  if (part == MPMI_HALVES_BOTH) mpmi_store4(a + 4, v.high);
  if (part == MPMI_HIGH || part == MPMI_BOTH) mpmi_lanes_store(a, v.eight);
}
MPMI_INLINE mpmi_v4 mpmi_node_low(int32_t part, mpmi_node a) {
  (void)part;
  return a.four;
}
MPMI_INLINE mpmi_v4 mpmi_node_high(mpmi_node a) {
  return mpmi_high_half(a.eight);
}
MPMI_INLINE mpmi_node mpmi_node_scale(int32_t part, double s, mpmi_node a) {
  if (part == MPMI_HALVES_BOTH) return mpmi_node_of_halves(s * a.four, s * a.high);
  if (part == MPMI_HALVES_HIGH) return mpmi_node_of_halves(a.four, s * a.high);
  return part == MPMI_LOW ? mpmi_node_of4(s * a.four) : mpmi_node_of8(s * a.eight);
}
MPMI_INLINE mpmi_node mpmi_node_fma(int32_t part, mpmi_node a, double s, mpmi_node b) {
  if (part == MPMI_HALVES_BOTH) return mpmi_node_of_halves(a.four + s * b.four, a.high + s * b.high);
  if (part == MPMI_HALVES_HIGH) return mpmi_node_of_halves(a.four, a.high + s * b.high);
  return part == MPMI_LOW ? mpmi_node_of4(a.four + s * b.four) : mpmi_node_of8(a.eight + s * b.eight);
}
MPMI_INLINE mpmi_node mpmi_node_sum(int32_t part, mpmi_node a, mpmi_node b) {
  return part == MPMI_LOW ? mpmi_node_of4(a.four + b.four) : mpmi_node_of8(a.eight + b.eight);
}
MPMI_INLINE mpmi_node mpmi_node_difference(int32_t part, mpmi_node a, mpmi_node b) {
  return part == MPMI_LOW ? mpmi_node_of4(a.four - b.four) : mpmi_node_of8(a.eight - b.eight);
}
/* Returns v, a product, rounded. */
MPMI_INLINE mpmi_node mpmi_node_round(int32_t part, mpmi_node v) {
  if (part == MPMI_LOW) return mpmi_node_of4(mpmi_round4(v.four));
  __asm__("" : "+v"(v.eight));
  return mpmi_node_of8(v.eight);
}
/* a + b and a - b in the lower half; the upper one is that of a. b is rounded first. */
MPMI_INLINE mpmi_node mpmi_node_add_low(int32_t part, mpmi_node a, mpmi_node b) {
  if (part == MPMI_LOW) return mpmi_node_of4(a.four + mpmi_round4(b.four));
  if (part == MPMI_HALVES_BOTH) return mpmi_node_of_halves(a.four + mpmi_round4(b.four), a.high);
  return mpmi_node_of8(_mm512_mask_add_pd(a.eight, 0x0f, a.eight, mpmi_node_round(part, b).eight));
}
MPMI_INLINE mpmi_node mpmi_node_subtract_low(int32_t part, mpmi_node a, mpmi_node b) {
  if (part == MPMI_LOW) return mpmi_node_of4(a.four - mpmi_round4(b.four));
  if (part == MPMI_HALVES_BOTH) return mpmi_node_of_halves(a.four - mpmi_round4(b.four), a.high);
  return mpmi_node_of8(_mm512_mask_sub_pd(a.eight, 0x0f, a.eight, mpmi_node_round(part, b).eight));
}
MPMI_INLINE mpmi_pair mpmi_pair_of(double low, double high) {
  return (mpmi_pair){low, low, low, low, high, high, high, high};
}
MPMI_INLINE mpmi_node mpmi_node_fma_pair(int32_t part, mpmi_node a, mpmi_pair s, mpmi_node b) {
  if (part == MPMI_HALVES_HIGH) return mpmi_node_of_halves(a.four, a.high + s[4] * b.high);
  return mpmi_node_of8(a.eight + s * b.eight);
}

#else
enum { MPMI_HALF = MPMI_LOW, MPMI_HALVES_HIGH = MPMI_HIGH, MPMI_HALVES_BOTH = MPMI_BOTH };
MPMI_INLINE int32_t mpmi_high_part(int32_t part) {
  (void)part;
  return MPMI_HIGH;
}
typedef struct mpmi_node {
  mpmi_v4 low, high;
} mpmi_node;
typedef struct mpmi_pair {
  double low, high;
} mpmi_pair;

MPMI_INLINE mpmi_node mpmi_node_zero(void) {
  return (mpmi_node){mpmi_zero4(), mpmi_zero4()};
}
MPMI_INLINE mpmi_node mpmi_node_load(int32_t part, const double *a) {
  return (mpmi_node){part & MPMI_LOW ? mpmi_load4(a) : mpmi_zero4(),
                     part & MPMI_HIGH ? mpmi_load4(a + 4) : mpmi_zero4()};
}
MPMI_INLINE mpmi_node mpmi_node_load_halves(const double *low, const double *high) {
  return (mpmi_node){mpmi_load4(low), mpmi_load4(high)};
}
MPMI_INLINE mpmi_node mpmi_node_load_high(int32_t part, const double *a) {
  (void)part;
  return (mpmi_node){mpmi_zero4(), mpmi_load4(a)};
}
MPMI_INLINE void mpmi_node_store(int32_t part, double *a, mpmi_node v) {
  if (part & MPMI_LOW) mpmi_store4(a, v.low);
  if (part & MPMI_HIGH) mpmi_store4(a + 4, v.high);
}
MPMI_INLINE mpmi_v4 mpmi_node_low(int32_t part, mpmi_node a) {
  (void)part;
  return a.low;
}
MPMI_INLINE mpmi_v4 mpmi_node_high(mpmi_node a) {
  return a.high;
}
MPMI_INLINE mpmi_node mpmi_node_scale(int32_t part, double s, mpmi_node a) {
  if (part & MPMI_LOW) a.low = mpmi_scale4(s, a.low);
  if (part & MPMI_HIGH) a.high = mpmi_scale4(s, a.high);
  return a;
}
MPMI_INLINE mpmi_node mpmi_node_fma(int32_t part, mpmi_node a, double s, mpmi_node b) {
  if (part & MPMI_LOW) a.low = mpmi_fma4(a.low, s, b.low);
  if (part & MPMI_HIGH) a.high = mpmi_fma4(a.high, s, b.high);
  return a;
}
MPMI_INLINE mpmi_node mpmi_node_sum(int32_t part, mpmi_node a, mpmi_node b) {
  if (part & MPMI_LOW) a.low = mpmi_sum4(a.low, b.low);
  if (part & MPMI_HIGH) a.high = mpmi_sum4(a.high, b.high);
  return a;
}
MPMI_INLINE mpmi_node mpmi_node_round(int32_t part, mpmi_node v) {
  if (part & MPMI_LOW) v.low = mpmi_round4(v.low);
  if (part & MPMI_HIGH) v.high = mpmi_round4(v.high);
  return v;
}
MPMI_INLINE mpmi_node mpmi_node_difference(int32_t part, mpmi_node a, mpmi_node b) {
  if (part & MPMI_LOW) a.low = mpmi_difference4(a.low, b.low);
  if (part & MPMI_HIGH) a.high = mpmi_difference4(a.high, b.high);
  return a;
}
MPMI_INLINE mpmi_node mpmi_node_add_low(int32_t part, mpmi_node a, mpmi_node b) {
  (void)part;
  return (mpmi_node){mpmi_sum4(a.low, mpmi_round4(b.low)), a.high};
}
MPMI_INLINE mpmi_node mpmi_node_subtract_low(int32_t part, mpmi_node a, mpmi_node b) {
  (void)part;
  return (mpmi_node){mpmi_difference4(a.low, mpmi_round4(b.low)), a.high};
}
MPMI_INLINE mpmi_pair mpmi_pair_of(double low, double high) {
  return (mpmi_pair){low, high};
}
MPMI_INLINE mpmi_node mpmi_node_fma_pair(int32_t part, mpmi_node a, mpmi_pair s, mpmi_node b) {
  if (part & MPMI_LOW) a.low = mpmi_fma4(a.low, s.low, b.low);
  if (part & MPMI_HIGH) a.high = mpmi_fma4(a.high, s.high, b.high);
  return a;
}
#endif

#endif
