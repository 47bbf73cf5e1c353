/* Saving brings the sets up to date, then writes everything after the header, and last the header, which has
 * the checksum. A callback wants the header first: the checksum is then found before anything is written. */
#include "context/transport.h"
#include "io/byte_order.h"
#include "io/state.h"

#include <stddef.h>
#include <string.h>

static mpm_status check_between_steps(const mpm_stepper *s) {
  if (s->step.phase != MPMI_IDLE)
    return mpmi_fail(s->context, MPM_E_STATE, "a step is under way: end or abort it before saving");
  return MPM_OK;
}

mpm_status mpmi_state_settle_set(mpm_particles *set, const char *name, const char *before) {
  for (int32_t i = 0; i < MPMI_MAX_VIEWS; ++i)
    if (set->view[i].live && set->view[i].access & MPM_WRITE)
      return mpmi_fail(set->context, MPM_E_STATE, "%s of %s is mapped for writing: release it before %s",
                       set->field[set->view[i].field].name, name, before);
  /* Bad values written through a view bar saving as they bar a step; the text says which. */
  if (mpmi_particles_check_suspects(set)) return MPM_E_STATE;
  /* Volume and stress follow from F and may be out of date. The host must not see that, const or not. */
  return mpmi_particles_refresh(set);
}

mpm_status mpmi_state_settle(const mpm_stepper *s, mpm_status status) {
  if (!status) status = check_between_steps(s);
  for (int32_t m = 0; m < s->layout.member_count && !status; ++m) {
    char name[MPMI_TEXT];
    snprintf(name, sizeof name, "set %d", (int)m);
    status = mpmi_state_settle_set(s->layout.member[m].set, name, "saving");
  }
  return mpmi_agree(s->context, status);
}

/* The info is all words but for what begins it. */
void mpmi_state_archive_numbers(mpmi_archive *a, uint32_t format, mpmi_state_numbers *n) {
  enum {
    SUMS_2 = offsetof(mpmi_state_numbers, sums) + offsetof(mpmi_sums, affine),
    SUMS_3 = offsetof(mpmi_state_numbers, last),
    HALVES = offsetof(mpm_step_info, step),
    INFO_2 = offsetof(mpm_step_info, external_work_total),
    INFO_3 = offsetof(mpm_step_info, body),
    LATER = offsetof(mpm_step_info, damping_dissipation)
  };
  const int64_t info = format == 2 ? INFO_2 : INFO_3;
  mpmi_archive_words(a, n, format == 2 ? SUMS_2 : SUMS_3);
  mpmi_archive_halves(a, &n->last, HALVES);
  mpmi_archive_words(a, &n->last.step, info - HALVES);
  if (format > 2) mpmi_archive_halves(a, &n->last.body, LATER - INFO_3);
  if (format > 2) mpmi_archive_words(a, &n->last.damping_dissipation, sizeof n->last - LATER);
  if (format > 2) mpmi_archive_words(a, &n->totals, sizeof n->totals);
  if (format > 2) mpmi_archive_words(a, &n->heat, sizeof n->heat);
}

void mpmi_state_archive_set_numbers(mpmi_archive *a, uint32_t format, mpmi_state_set_numbers *n) {
  enum { NUMBERS_2 = offsetof(mpmi_state_set_numbers, impulse_total) };
  mpmi_archive_words(a, n, format == 2 ? NUMBERS_2 : (int64_t)sizeof *n);
}

void mpmi_state_archive_row(mpmi_archive *a, int32_t type, void *row, int64_t bytes) {
  if (mpmi_type_size(type) == 1)
    mpmi_archive_bytes(a, row, bytes);
  else
    mpmi_archive_words(a, row, bytes);
}

mpmi_state_header mpmi_state_turn_header(mpmi_state_header h) {
  h.byte_order = mpmi_little_32(h.byte_order);
  h.format = mpmi_little_32(h.format);
  h.bytes = (int64_t)mpmi_little_64((uint64_t)h.bytes);
  h.checksum = mpmi_little_64(h.checksum);
  return h;
}

static void write_numbers(mpmi_archive *a, const mpm_stepper *s) {
  mpmi_state_numbers n = {.t = s->history.t,
                          .previous_dt = s->history.previous_dt,
                          .controller_dt = s->history.controller_dt,
                          .mass_cut = s->layout.mass_cut,
                          .reaction_dt = s->history.reaction_dt,
                          .step = s->history.step,
                          .resorts = s->layout.sorts,
                          .removed = s->history.removed,
                          .energies_valid = s->history.has_sums != 0,
                          .has_reactions = s->history.has_reactions != 0,
                          .blocks = mpmi_state_is_sorted(s) ? mpmi_state_count_blocks(s) : -1,
                          .sums = s->history.sums,
                          .last = s->history.last,
                          .totals = s->history.totals,
                          .heat = s->history.heat};
  memcpy(n.impulse_by_face, s->history.impulse_by_face, sizeof n.impulse_by_face);
  mpmi_state_archive_numbers(a, MPMI_STATE_FORMAT, &n);
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    const mpm_particles *set = s->layout.member[m].set;
    mpmi_state_set_numbers of_set = {.count = set->count,
                                     .slots = set->slots,
                                     .next_id = set->next_id,
                                     .dirty = set->dirty,
                                     .mass_max = set->mass_max,
                                     .body = s->layout.member[m].body,
                                     .adaption = s->adaption[m].sums,
                                     .has_motion =
                                         s->settings.motion[m].fn || s->settings.motion[m].is_awaited};
    memcpy(of_set.reaction, s->history.reaction[m].impulse, sizeof of_set.reaction);
    memcpy(of_set.impulse_total, s->history.reaction[m].impulse_total, sizeof of_set.impulse_total);
    mpmi_state_archive_set_numbers(a, MPMI_STATE_FORMAT, &of_set);
  }
}

static void write_fields(mpmi_archive *a, const mpm_particles *set) {
  for (int32_t f = 0; f < set->field_count; ++f) {
    const mpmi_field *field = &set->field[f];
    const int64_t size = (int64_t)mpmi_type_size(field->type);
    for (int32_t c = 0; c < field->components && field->present && set->slots > 0; ++c)
      mpmi_state_archive_row(a, field->type, (char *)field->data[0] + c * set->ld * size, set->slots * size);
  }
}

void mpmi_state_write(mpmi_archive *a, const mpm_stepper *s) {
  mpmi_state_setup(a, s, MPMI_STATE_FORMAT, NULL);
  write_numbers(a, s);
  mpmi_state_write_obstacles(a, s);
  mpmi_state_write_contact(a, s);
  mpmi_state_write_surfaces(a, s);
  if (mpmi_state_is_sorted(s)) mpmi_state_write_blocks(a, s);
  for (int32_t m = 0; m < s->layout.member_count; ++m) write_fields(a, s->layout.member[m].set);
}

mpm_status mpmi_state_mark(const mpmi_archive *a, uint64_t *mark) {
  int64_t sum = (int64_t)mpmi_checksum_end(&a->checksum);
  const mpm_status status = mpmi_reduce_parts(a->context, MPM_REDUCE_SUM, 1, &sum);
  *mark = (uint64_t)sum;
  return status;
}

void mpmi_state_write_end(mpmi_archive *a, uint64_t mark) {
  const mpm_transport *t = &a->context->transport;
  mpmi_state_end end = {t->part, t->parts, mark};
  if (!mpmi_is_whole(a->context)) mpmi_archive_words(a, &end, sizeof end);
}

mpmi_state_header mpmi_state_header_of(const mpmi_archive *a) {
  mpmi_state_header header = {"", MPMI_STATE_BYTE_ORDER, MPMI_STATE_FORMAT, (int64_t)sizeof header + a->at,
                              mpmi_checksum_end(&a->checksum)};
  memcpy(header.magic, mpmi_is_whole(a->context) ? MPMI_STATE_MAGIC : MPMI_PIECE_MAGIC, sizeof header.magic);
  return mpmi_state_turn_header(header);
}

static int64_t measure(const mpm_stepper *s) {
  mpmi_archive a;
  mpmi_archive_begin(&a, s->context, MPMI_MEASURE);
  mpmi_state_write(&a, s);
  mpmi_state_write_end(&a, 0);
  return (int64_t)sizeof(mpmi_state_header) + a.at;
}

mpm_status mpm_state_size(const mpm_stepper *stepper, int64_t *bytes) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  mpm_context *context = stepper->context;
  mpm_status status = bytes ? MPM_OK : mpmi_fail(context, MPM_E_ARG, "bytes is NULL");
  if (!status) status = check_between_steps(stepper);
  status = mpmi_agree(context, status);
  if (!status) *bytes = measure(stepper);
  return status;
}

mpm_status mpm_state_save(const mpm_stepper *stepper, void *buffer, int64_t capacity) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  mpm_context *context = stepper->context;
  mpm_status status = buffer ? MPM_OK : mpmi_fail(context, MPM_E_ARG, "buffer is NULL");
  if ((status = mpmi_state_settle(stepper, status))) return status;
  const int64_t bytes = measure(stepper);
  if (capacity < bytes)
    status = mpmi_fail(context, MPM_E_ARG, "capacity is %lld, but the state takes %lld bytes",
                       (long long)capacity, (long long)bytes);
  if ((status = mpmi_agree(context, status))) return status;
  uint64_t mark;
  mpmi_archive a;
  mpmi_archive_begin(&a, context, MPMI_TO_MEMORY);
  a.to = (unsigned char *)buffer + sizeof(mpmi_state_header);
  mpmi_state_write(&a, stepper);
  if ((status = mpmi_state_mark(&a, &mark))) return status;
  mpmi_state_write_end(&a, mark);
  const mpmi_state_header header = mpmi_state_header_of(&a);
  memcpy(buffer, &header, sizeof header);
  return MPM_OK;
}

static mpm_status foresee_header(const mpm_stepper *s, mpmi_state_header *header, uint64_t *mark) {
  mpmi_archive a;
  mpmi_archive_begin(&a, s->context, MPMI_TO_CHECKSUM);
  mpmi_state_write(&a, s);
  const mpm_status status = mpmi_state_mark(&a, mark);
  mpmi_state_write_end(&a, *mark);
  *header = mpmi_state_header_of(&a);
  return status;
}

mpm_status mpm_state_save_to(const mpm_stepper *stepper, mpm_write_fn write, void *user) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  mpm_context *context = stepper->context;
  mpmi_state_header header;
  uint64_t mark;
  mpmi_output out;
  mpm_status status = mpmi_state_settle(stepper, mpmi_check_write(context, write));
  if (status) return status;
  status = mpmi_output_open(&out, context, &(mpmi_target){.write = write, .user = user});
  const mpm_status opened = status;
  if (!(status = mpmi_agree(context, status))) status = foresee_header(stepper, &header, &mark);
  if (status) {
    if (!opened) mpmi_output_drop(&out);
    return status;
  }
  mpmi_output_write(&out, &header, sizeof header);
  mpmi_archive a;
  mpmi_archive_begin(&a, context, MPMI_TO_OUTPUT);
  a.output = &out;
  mpmi_state_write(&a, stepper);
  mpmi_state_write_end(&a, mark);
  status = mpmi_output_close(&out, 0);
  if (!status && mpmi_state_header_of(&a).checksum != header.checksum)
    status = mpmi_fail(context, MPM_E_STATE,
                       "the state changed while it was saved: a view for reading was written to");
  return mpmi_agree(context, status);
}
