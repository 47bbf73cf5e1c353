/* The ways to the other parts of a problem: the host's four functions, their failures, and what parts agree
 * on. With one part nothing is called, and everybody agrees. */
#ifndef MPMI_TRANSPORT_H
#define MPMI_TRANSPORT_H

#include "context/context.h"
#include "context/exact_sum.h"

static inline int32_t mpmi_is_whole(const mpm_context *context) {
  return context->transport.parts == 1;
}

/* Returns 1 where the host has given a transport: one part, too, then chooses what several would. */
static inline int32_t mpmi_has_transport(const mpm_context *context) {
  return context->transport.send != NULL;
}

/* The host's functions. MPM_E_CALLBACK: one has failed, now or before. */
mpm_status mpmi_send(mpm_context *context, int32_t exchange, int32_t count, const mpm_message *out,
                     const int64_t *most);
mpm_status mpmi_receive(mpm_context *context, int32_t *count, const mpm_message **in);
/* Lets a transport move that does so only when it is called, between send and receive. */
void mpmi_poll(mpm_context *context);
mpm_status mpmi_reduce_parts(mpm_context *context, int32_t operation, int64_t count, int64_t *values);
mpm_status mpmi_gather_parts(mpm_context *context, int64_t value, int64_t *all);

/* All parts meet with the status that each has. Returns MPM_OK when all have that; else the status of the
 * first part that has another, with its sentence. */
mpm_status mpmi_agree(mpm_context *context, mpm_status status);
/* All parts take over the status and the text of one of them. */
mpm_status mpmi_take_over(mpm_context *context, int32_t part, mpm_status status);
/* Makes the totals of exact sums over all parts. */
mpm_status mpmi_total_parts(mpm_context *context, int64_t count, const mpmi_whole_sum *sum, double *total);
/* Words that go along with sums, because each reduction takes as long as the way to the other parts: some
 * become the largest of all parts, some their sum. */
enum { MPMI_MOST_RIDERS = 4 };
typedef struct mpmi_riders {
  int32_t largest_count, sum_count;
  int64_t largest[MPMI_MOST_RIDERS], sum[MPMI_MOST_RIDERS];
} mpmi_riders;
mpm_status mpmi_total_parts_with(mpm_context *context, int64_t count, const mpmi_whole_sum *sum,
                                 double *total, mpmi_riders *riders);

/* Integers in the order of numbers, so that the largest of numbers is one of integers. */
static inline int64_t mpmi_ordered_bits(double x) {
  int64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits < 0 ? bits ^ INT64_MAX : bits;
}
static inline double mpmi_of_ordered_bits(int64_t bits) {
  double x;
  if (bits < 0) bits ^= INT64_MAX;
  memcpy(&x, &bits, sizeof x);
  return x;
}

#endif
