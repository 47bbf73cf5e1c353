#include "context/transport.h"

#include <string.h>

static mpm_status lost(mpm_context *context) {
  return mpmi_fail(context, MPM_E_CALLBACK, "the transport has failed before: the other parts are lost");
}

static mpm_status answered(mpm_context *context, const char *name, mpm_status returned) {
  const mpm_status status = mpmi_from_host(returned);
  if (!status) return MPM_OK;
  context->apart = 1;
  return mpmi_fail(context, MPM_E_CALLBACK, "the transport's %s returned %d: the other parts are lost", name,
                   (int)status);
}

mpm_status mpmi_send(mpm_context *context, int32_t exchange, int32_t count, const mpm_message *out,
                     const int64_t *most) {
  const mpm_transport *t = &context->transport;
  if (context->apart) return lost(context);
  return answered(context, "send", t->send(t->user, exchange, count, out, most));
}

mpm_status mpmi_receive(mpm_context *context, int32_t *count, const mpm_message **in) {
  const mpm_transport *t = &context->transport;
  if (context->apart) return lost(context);
  return answered(context, "receive", t->receive(t->user, count, in));
}

void mpmi_poll(mpm_context *context) {
  const mpm_transport *t = &context->transport;
  if (!t->poll || context->apart) return;
  t->poll(t->user);
  mpmi_environment_mend();
}

mpm_status mpmi_reduce_parts(mpm_context *context, int32_t operation, int64_t count, int64_t *values) {
  const mpm_transport *t = &context->transport;
  if (mpmi_is_whole(context)) return MPM_OK;
  if (context->apart) return lost(context);
  const double started = mpmi_seconds();
  const mpm_status returned = t->reduce(t->user, operation, count, values);
  context->reducing += mpmi_seconds() - started;
  return answered(context, "reduce", returned);
}

mpm_status mpmi_gather_parts(mpm_context *context, int64_t value, int64_t *all) {
  const mpm_transport *t = &context->transport;
  all[0] = value;
  if (mpmi_is_whole(context)) return MPM_OK;
  if (context->apart) return lost(context);
  const double started = mpmi_seconds();
  const mpm_status returned = t->gather(t->user, value, all);
  context->reducing += mpmi_seconds() - started;
  return answered(context, "gather", returned);
}

mpm_status mpmi_take_over(mpm_context *context, int32_t part, mpm_status status) {
  enum { WORDS = MPMI_SENTENCE / sizeof(int64_t) };
  const int32_t mine = part == context->transport.part;
  int64_t word[1 + WORDS];
  char text[MPMI_SENTENCE];
  for (int32_t i = 0; i < 1 + WORDS; ++i) word[i] = INT64_MIN;
  if (mine) {
    memset(text, 0, sizeof text);
    strncpy(text, mpm_last_error(context), sizeof text - 1);
    word[0] = status;
    memcpy(word + 1, text, sizeof text);
  }
  const mpm_status failed = mpmi_reduce_parts(context, MPM_REDUCE_MAX, 1 + WORDS, word);
  if (failed || mine) return failed ? failed : status;
  memcpy(text, word + 1, sizeof text);
  text[sizeof text - 1] = '\0';
  /* a failure that parts have agreed on before names its part already */
  if (!strncmp(text, "part ", 5)) return mpmi_fail(context, (mpm_status)word[0], "%s", text);
  return mpmi_fail(context, (mpm_status)word[0], "part %d: %s", (int)part, text);
}

mpm_status mpmi_agree(mpm_context *context, mpm_status status) {
  const int32_t parts = context->transport.parts;
  if (parts == 1) return status;
  int64_t first = status ? parts - context->transport.part : 0;
  const mpm_status failed = mpmi_reduce_parts(context, MPM_REDUCE_MAX, 1, &first);
  if (failed || !first) return failed;
  return mpmi_take_over(context, parts - (int32_t)first, status);
}

/* The parts' sums go in portions, first how far up they reach and then their digits; riders go before
 * these. */
enum { PORTION = 64, WORDS = sizeof(mpmi_exact_part) / sizeof(int64_t) };

static mpm_status total_portion(mpm_context *context, int64_t count, const mpmi_whole_sum *sum, double *total,
                                mpmi_riders *riders) {
  int64_t top[MPMI_MOST_RIDERS + PORTION], word[MPMI_MOST_RIDERS + PORTION * WORDS];
  int64_t *const own_top = top + riders->largest_count, *const own = word + riders->sum_count;
  mpmi_exact_part part;
  mpm_status status;
  memcpy(top, riders->largest, sizeof riders->largest);
  for (int64_t i = 0; i < count; ++i) own_top[i] = sum[i].top;
  if ((status = mpmi_reduce_parts(context, MPM_REDUCE_MAX, riders->largest_count + count, top)))
    return status;
  memcpy(word, riders->sum, sizeof riders->sum);
  for (int64_t i = 0; i < count; ++i) {
    part = mpmi_exact_take(&sum[i], (int32_t)own_top[i]);
    memcpy(own + i * WORDS, &part, sizeof part);
  }
  if ((status = mpmi_reduce_parts(context, MPM_REDUCE_SUM, riders->sum_count + count * WORDS, word)))
    return status;
  memcpy(riders->largest, top, (size_t)riders->largest_count * sizeof *top);
  memcpy(riders->sum, word, (size_t)riders->sum_count * sizeof *word);
  for (int64_t i = 0; i < count; ++i) {
    memcpy(&part, own + i * WORDS, sizeof part);
    total[i] = mpmi_exact_value(&part, (int32_t)own_top[i]);
  }
  return MPM_OK;
}

mpm_status mpmi_total_parts_with(mpm_context *context, int64_t count, const mpmi_whole_sum *sum,
                                 double *total, mpmi_riders *riders) {
  mpmi_riders none = {0};
  mpm_status status = MPM_OK;
  if (mpmi_is_whole(context)) {
    for (int64_t i = 0; i < count; ++i) total[i] = mpmi_exact_total(&sum[i]);
    return MPM_OK;
  }
  for (int64_t at = 0; at < count && !status; at += PORTION, riders = &none)
    status =
        total_portion(context, count - at < PORTION ? count - at : PORTION, sum + at, total + at, riders);
  return status;
}

mpm_status mpmi_total_parts(mpm_context *context, int64_t count, const mpmi_whole_sum *sum, double *total) {
  mpmi_riders none = {0};
  return mpmi_total_parts_with(context, count, sum, total, &none);
}

mpm_status mpm_context_part(const mpm_context *context, int32_t *part, int32_t *parts) {
  if (!context || context->magic != MPMI_CONTEXT) return MPM_E_ARG;
  if (part) *part = context->transport.part;
  if (parts) *parts = context->transport.parts;
  return MPM_OK;
}
