#include "io/archive.h"
#include "io/byte_order.h"
#include "context/mix.h"

#include <string.h>

enum { WORD = 8, LANES = 4 };

void mpmi_checksum_begin(mpmi_checksum *sum) {
  *sum = (mpmi_checksum){{MPMI_MIX_A, MPMI_MIX_B, MPMI_MIX_C, ~MPMI_MIX_A}, 0};
}

/* The step is one to one in the word for a given lane, and one to one in the lane for a given word. So no
 * change of a single word can go unnoticed. */
static uint64_t step_lane(uint64_t lane, const unsigned char *at) {
  uint64_t word;
  memcpy(&word, at, sizeof word);
  return mpmi_rotate(lane + mpmi_little_64(word) * MPMI_MIX_B, 31) * MPMI_MIX_A;
}

void mpmi_checksum_add(mpmi_checksum *sum, const void *data, int64_t bytes) {
  const unsigned char *at = data;
  int64_t words = bytes / WORD;
  for (; words > 0 && sum->words % LANES; --words, at += WORD) {
    uint64_t *lane = &sum->lane[sum->words++ % LANES];
    *lane = step_lane(*lane, at);
  }
  uint64_t a = sum->lane[0], b = sum->lane[1], c = sum->lane[2], d = sum->lane[3];
  for (; words >= LANES; words -= LANES, at += LANES * WORD, sum->words += LANES) {
    a = step_lane(a, at);
    b = step_lane(b, at + WORD);
    c = step_lane(c, at + 2 * WORD);
    d = step_lane(d, at + 3 * WORD);
  }
  sum->lane[0] = a, sum->lane[1] = b, sum->lane[2] = c, sum->lane[3] = d;
  for (; words > 0; --words, at += WORD) {
    uint64_t *lane = &sum->lane[sum->words++ % LANES];
    *lane = step_lane(*lane, at);
  }
}

uint64_t mpmi_checksum_end(const mpmi_checksum *sum) {
  const uint64_t *lane = sum->lane;
  uint64_t h =
      mpmi_rotate(lane[0], 1) + mpmi_rotate(lane[1], 7) + mpmi_rotate(lane[2], 12) + mpmi_rotate(lane[3], 18);
  return mpmi_avalanche(h ^ sum->words * MPMI_MIX_C);
}

void mpmi_archive_begin(mpmi_archive *a, mpm_context *context, int32_t mode) {
  memset(a, 0, sizeof *a);
  a->context = context;
  a->mode = mode;
  a->name = "the state";
  mpmi_checksum_begin(&a->checksum);
}

mpm_status mpmi_archive_damaged(mpmi_archive *a, const char *what) {
  if (!a->status)
    a->status = mpmi_fail(a->context, MPM_E_FORMAT, "%s is damaged: %s%s", a->name, a->where, what);
  return a->status;
}

static int64_t padded(int64_t bytes) {
  return (bytes + WORD - 1) / WORD * WORD;
}

const void *mpmi_archive_take(mpmi_archive *a, int64_t bytes) {
  if (a->status) return NULL;
  if (bytes < 0 || bytes > a->size || padded(bytes) > a->size - a->at) {
    mpmi_archive_damaged(a, "it ends too early");
    return NULL;
  }
  const void *taken = a->from + a->at;
  a->at += padded(bytes);
  return taken;
}

/* Writes whole words. */
static void put(mpmi_archive *a, const void *data, int64_t bytes) {
  if (a->mode == MPMI_TO_OUTPUT && mpmi_output_failed(a->output)) return;
  if (a->mode != MPMI_MEASURE && bytes > 0) mpmi_checksum_add(&a->checksum, data, bytes);
  if (a->mode == MPMI_TO_MEMORY && bytes > 0) memcpy(a->to + a->at, data, (size_t)bytes);
  if (a->mode == MPMI_TO_OUTPUT && bytes > 0) mpmi_output_write(a->output, data, (size_t)bytes);
  a->at += bytes;
}

void mpmi_archive_bytes(mpmi_archive *a, void *data, int64_t bytes) {
  if (a->mode == MPMI_FROM_MEMORY) {
    const void *taken = mpmi_archive_take(a, bytes);
    if (taken && bytes > 0) memcpy(data, taken, (size_t)bytes);
    return;
  }
  const int64_t whole = bytes / WORD * WORD;
  put(a, data, whole);
  if (whole == bytes) return;
  unsigned char last[WORD] = {0};
  if (a->mode != MPMI_MEASURE) memcpy(last, (unsigned char *)data + whole, (size_t)(bytes - whole));
  put(a, last, WORD);
}

/* Turns whole words, of 8 bytes or as pairs of 4, from the machine's byte order into the archive's, or
 * back. */
static void turn(void *data, int64_t bytes, int32_t unit) {
  unsigned char *at = data;
  for (int64_t i = 0; i < bytes; i += unit) {
    uint64_t word;
    uint32_t half;
    if (unit == WORD) {
      memcpy(&word, at + i, sizeof word);
      word = mpmi_little_64(word);
      memcpy(at + i, &word, sizeof word);
    } else {
      memcpy(&half, at + i, sizeof half);
      half = mpmi_little_32(half);
      memcpy(at + i, &half, sizeof half);
    }
  }
}

static void archive_numbers(mpmi_archive *a, void *data, int64_t bytes, int32_t unit) {
  if (!MPMI_BIG_ENDIAN || a->mode == MPMI_MEASURE || a->mode == MPMI_FROM_MEMORY) {
    mpmi_archive_bytes(a, data, bytes);
    if (MPMI_BIG_ENDIAN && a->mode == MPMI_FROM_MEMORY && !a->status) turn(data, bytes, unit);
    return;
  }
  unsigned char turned[64 * WORD]; /* what is written stays as it is */
  for (int64_t done = 0; done < bytes; done += (int64_t)sizeof turned) {
    const int64_t part = bytes - done < (int64_t)sizeof turned ? bytes - done : (int64_t)sizeof turned;
    memcpy(turned, (const unsigned char *)data + done, (size_t)part);
    turn(turned, part, unit);
    mpmi_archive_bytes(a, turned, part);
  }
}

void mpmi_archive_words(mpmi_archive *a, void *data, int64_t bytes) {
  archive_numbers(a, data, bytes, WORD);
}

void mpmi_archive_halves(mpmi_archive *a, void *data, int64_t bytes) {
  archive_numbers(a, data, bytes, WORD / 2);
}

/* Returns 1 while the archive compares. Writing and measuring leave the value as it is. */
static int32_t reads(const mpmi_archive *a) {
  return a->mode == MPMI_FROM_MEMORY && !a->status;
}

void mpmi_archive_same_int(mpmi_archive *a, const char *what, int64_t here) {
  int64_t saved = here;
  mpmi_archive_words(a, &saved, sizeof saved);
  if (reads(a) && saved != here)
    a->status = mpmi_fail(a->context, MPM_E_FORMAT, "%s is of an unlike setup: %s%s is %lld there, %lld here",
                          a->name, a->where, what, (long long)saved, (long long)here);
}

void mpmi_archive_same_real(mpmi_archive *a, const char *what, double here) {
  double saved = here;
  mpmi_archive_words(a, &saved, sizeof saved);
  if (reads(a) && !(saved == here))
    a->status =
        mpmi_fail(a->context, MPM_E_FORMAT, "%s is of an unlike setup: %s%s is %.17g there, %.17g here",
                  a->name, a->where, what, saved, here);
}

void mpmi_archive_same_text(mpmi_archive *a, const char *what, const char *here) {
  char saved[MPMI_TEXT] = {0};
  if (a->mode != MPMI_FROM_MEMORY) strncpy(saved, here, MPMI_TEXT - 1);
  mpmi_archive_bytes(a, saved, sizeof saved);
  saved[MPMI_TEXT - 1] = '\0';
  if (reads(a) && strcmp(saved, here) != 0)
    a->status =
        mpmi_fail(a->context, MPM_E_FORMAT, "%s is of an unlike setup: %s%s is \"%s\" there, \"%s\" here",
                  a->name, a->where, what, saved, here);
}
