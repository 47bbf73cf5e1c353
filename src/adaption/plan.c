/* What a set that adapts is about to do: all that may fail, in turn. */
#include "adaption/adaption.h"

static mpm_status plan_alone(const mpmi_adapting *of) {
  mpmi_adaption *a = of->a;
  mpm_status status = mpmi_adaption_choose(a, of->set, of->copy);
  if (!status) status = mpmi_adaption_rank(of, &a->added);
  if (status) return status;
  mpmi_adaption_limit(of, of->set->count);
  if ((status = mpmi_adaption_merge_states(a, of->set, of->copy, of->t)) ||
      (status = mpmi_adaption_ask(a, of->set, of->copy)) || (status = mpmi_adaption_rank(of, &a->added)))
    return status;
  a->split_total = a->splits;
  a->pair_total = a->pairs;
  return mpmi_adaption_reserve(a, of->set, of->copy);
}

mpm_status mpmi_adaption_plan(const mpmi_adapting *of) {
  mpmi_adaption *a = of->a;
  a->own = of->set->slots;
  a->splits = a->pairs = a->strays = a->gone_count = a->added = 0;
  a->skips = 0;
  return of->parts ? mpmi_adaption_plan_together(of) : plan_alone(of);
}
