/* Saved bytes that are changed as a fuzzer says. */
#ifndef CHANGE_H
#define CHANGE_H

#include "fuzz.h"

/* A change at a place of saved bytes, or far from it: a word, a byte, a copy of other words, words put in or
 * taken out. */
static inline int64_t fuzz_change(fuzz_input *in, uint8_t *data, int64_t bytes, int64_t room) {
  const int32_t what = fuzz_below(in, 8);
  const int64_t words = bytes / 8;
  if (words < 8) return bytes;
  const int64_t at = 8 * (int64_t)(fuzz_word(in, 2) % (uint64_t)words),
                n = 8 * (1 + (int64_t)fuzz_below(in, 16));
  const double real = fuzz_double(in);
  const int64_t integer = fuzz_integer(in), other = 8 * (integer % words + (integer < 0 ? words - 1 : 0));
  switch (what) {
  case 0:
  case 1:
    memcpy(data + at, &integer, 8);
    return bytes;
  case 2:
    memcpy(data + at, &real, 8);
    return bytes;
  case 3:
  case 4:
    data[at + n % 8] = (uint8_t)integer;
    return bytes;
  case 5:
    if (at + n <= bytes && other >= 0 && other + n <= bytes) memmove(data + at, data + other, (size_t)n);
    return bytes;
  case 6:
    if (bytes + n > room) return bytes;
    memmove(data + at + n, data + at, (size_t)(bytes - at));
    return bytes + n;
  default:
    if (at + n > bytes) return bytes;
    memmove(data + at, data + at + n, (size_t)(bytes - at - n));
    return bytes - n;
  }
}

#endif
