/* How the host wants blocks to be given to parts. */
#include "context/structs.h"
#include "stepper/together.h"

static const mpm_balance_desc defaults_of_balance = {.struct_size = sizeof(mpm_balance_desc)};
static const double most_of_a_block = 1e6;

mpm_status mpm_balance_desc_init(mpm_balance_desc *desc, uint32_t struct_size) {
  return mpmi_init_struct("mpm_balance_desc", &defaults_of_balance, sizeof defaults_of_balance, desc,
                          struct_size);
}

static mpm_status check_balance(mpm_context *c, const mpm_balance_desc *d) {
  if (d->measure < 0 || d->measure > 1)
    return mpmi_fail(c, MPM_E_ARG, "measure is %d: it must be 0 or 1", (int)d->measure);
  if (!(d->limit == 0.0 || d->limit >= 1.0))
    return mpmi_fail(c, MPM_E_ARG, "limit is %g: it must be 0, or at least 1", d->limit);
  if (!(d->block_weight >= 0.0 && d->block_weight <= most_of_a_block))
    return mpmi_fail(c, MPM_E_ARG, "block_weight is %g: it must lie in [0, %g]", d->block_weight,
                     most_of_a_block);
  return MPM_OK;
}

mpm_status mpm_stepper_set_balance(mpm_stepper *s, const mpm_balance_desc *desc) {
  MPMI_ENTER(s, MPMI_STEPPER);
  static const char *const name[] = {"measure", "limit", "block_weight"};
  mpm_balance_desc d = defaults_of_balance;
  mpm_status status = mpmi_stepper_idle(s);
  if (!status && desc) status = mpmi_read_struct(s->context, "mpm_balance_desc", desc, sizeof d, &d);
  if (!status) status = check_balance(s->context, &d);
  if ((status = mpmi_together(s, status)) || !mpmi_is_shared(s)) return status;
  const double number[] = {d.measure, d.limit, d.block_weight};
  int64_t word[6];
  for (int32_t i = 0; i < 3; ++i) mpmi_put_number(word + 2 * i, number[i]);
  if ((status = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, 6, word)) ||
      (status = mpmi_check_alike(s, 3, name, number, word)))
    return status;
  s->layout.parts->balance = mpmi_balance_of(&d);
  return MPM_OK;
}
