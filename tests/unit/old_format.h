/* Turns a state that the library has saved into one of format 2, which is that of 0.1.0. */
#ifndef OLD_FORMAT_H
#define OLD_FORMAT_H

#include <string.h>

#include "io/state.h"

/* Takes words out, and returns the bytes that are left. */
static inline int64_t cut_words(uint8_t *state, int64_t at, int64_t words, int64_t bytes) {
  memmove(state + at, state + at + 8 * words, (size_t)(bytes - at - 8 * words));
  return bytes - 8 * words;
}

/* Takes out what format 2 does not have: projected positions, the geometry, the kind of grid, the energies of
 * the affine part and of damping, the sums over steps, heat, bodies, obstacles and surfaces. */
static inline int64_t contents_of_format_2(const mpm_stepper *s, uint8_t *state, int64_t bytes) {
  enum {
    SUMS = offsetof(mpmi_state_numbers, sums) + offsetof(mpmi_sums, affine),
    INFO = offsetof(mpm_step_info, external_work_total),
    SET = offsetof(mpmi_state_set_numbers, impulse_total),
    NEW = (int)(sizeof(mpmi_state_set_numbers) - SET) / 8
  };
  mpmi_archive setup;
  mpmi_archive_begin(&setup, s->context, MPMI_MEASURE);
  mpmi_state_setup(&setup, s, 2, NULL);
  int64_t at = (int64_t)sizeof(mpmi_state_header) + setup.at + SUMS;
  bytes = cut_words(state, (int64_t)sizeof(mpmi_state_header) + setup.at, 3, bytes);
  bytes = cut_words(state, at, 1, bytes);
  bytes = cut_words(state, at += INFO, 7 + (int64_t)((sizeof(mpmi_totals) + sizeof(mpmi_heat_history)) / 8),
                    bytes);
  for (int32_t m = 0; m < s->layout.member_count; ++m) bytes = cut_words(state, at += SET, NEW, bytes);
  mpmi_archive contact;
  mpmi_archive_begin(&contact, s->context, MPMI_MEASURE);
  mpmi_state_write_contact(&contact, s);
  mpmi_state_write_obstacles(&contact, s);
  mpmi_state_write_surfaces(&contact, s);
  bytes = cut_words(state, at, contact.at / 8, bytes);
  const int64_t blocks = mpmi_state_is_sorted(s) ? mpmi_state_count_blocks(s) : 0;
  for (int64_t b = 0; b < blocks; ++b) bytes = cut_words(state, at += 3 * 8, 1, bytes);
  return bytes;
}

/* Writes a header that belongs to the contents. */
static inline void seal_state(uint8_t *state, uint32_t format, int64_t bytes) {
  mpmi_state_header header = {MPMI_STATE_MAGIC, MPMI_STATE_BYTE_ORDER, format, bytes, 0};
  mpmi_checksum sum;
  memcpy(header.magic, MPMI_STATE_MAGIC, sizeof header.magic);
  mpmi_checksum_begin(&sum);
  mpmi_checksum_add(&sum, state + sizeof header, bytes - (int64_t)sizeof header);
  header.checksum = mpmi_checksum_end(&sum);
  header = mpmi_state_turn_header(header);
  memcpy(state, &header, sizeof header);
}

#endif
