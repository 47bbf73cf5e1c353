#define _POSIX_C_SOURCE 200809L
#include "ceilings.h"

#include <stdint.h>
#include <stdlib.h>
#include <time.h>

static double seconds_of(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double bench_seconds(void) {
  return seconds_of(CLOCK_MONOTONIC);
}

double bench_processor_seconds(void) {
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

/* Ten independent chains: more than latency times units on every processor of today. */
enum { CHAINS = 10, ROUNDS = 4000000, TRIES = 5 };

#define PEAK(name, target, bytes)                                                                            \
  typedef double name##_vector __attribute__((vector_size(bytes)));                                          \
  target static double name(void) {                                                                          \
    name##_vector a[CHAINS], x = {0.0}, y = {0.0};                                                           \
    double best = 0.0;                                                                                       \
    x += 0.999;                                                                                              \
    y += 1e-3;                                                                                               \
    for (int32_t t = 0; t < TRIES; ++t) {                                                                    \
      for (int32_t c = 0; c < CHAINS; ++c) a[c] = y * c;                                                     \
      const double from = bench_seconds();                                                                   \
      for (int32_t r = 0; r < ROUNDS; ++r) {                                                                 \
        a[0] = a[0] * x + y, a[1] = a[1] * x + y, a[2] = a[2] * x + y, a[3] = a[3] * x + y;                  \
        a[4] = a[4] * x + y, a[5] = a[5] * x + y, a[6] = a[6] * x + y, a[7] = a[7] * x + y;                  \
        a[8] = a[8] * x + y, a[9] = a[9] * x + y;                                                            \
      }                                                                                                      \
      const double took = bench_seconds() - from;                                                            \
      volatile double used = (a[0] + a[1] + a[2] + a[3] + a[4] + a[5] + a[6] + a[7] + a[8] + a[9])[0];       \
      (void)used;                                                                                            \
      const double rate = 2.0 * CHAINS * ROUNDS * ((bytes) / 8.0) / took * 1e-9;                             \
      best = rate > best ? rate : best;                                                                      \
    }                                                                                                        \
    return best;                                                                                             \
  }

PEAK(peak_128, , 16)
#if defined(__x86_64__)
PEAK(peak_256, __attribute__((target("avx2,fma"))), 32)
PEAK(peak_512, __attribute__((target("avx512f"))), 64)
#endif

double bench_fma_peak(void) {
  double best = peak_128();
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    const double wide = peak_256();
    best = wide > best ? wide : best;
  }
  if (__builtin_cpu_supports("avx512f")) {
    const double wide = peak_512();
    best = wide > best ? wide : best;
  }
#endif
  return best;
}

double bench_update_bandwidth(void) {
  const int64_t n = INT64_C(1) << 25;
  double *a = malloc((size_t)n * sizeof *a), best = 0.0;
  if (!a) return 0.0;
  for (int64_t i = 0; i < n; ++i) a[i] = (double)i;
  for (int32_t t = 0; t < TRIES; ++t) {
    const double from = bench_seconds();
    for (int64_t i = 0; i < n; ++i) a[i] = a[i] * 0.999 + 1.0;
    const double rate = 2.0 * (double)n * sizeof *a / (bench_seconds() - from) * 1e-9;
    best = rate > best ? rate : best;
  }
  volatile double used = a[n / 2];
  (void)used;
  free(a);
  return best;
}
