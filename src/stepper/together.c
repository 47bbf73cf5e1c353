#include "stepper/together.h"
#include "context/structs.h"
#include "particles/values.h"
#include "stepper/fingerprint.h"

#include <string.h>

mpm_status mpmi_together(const mpm_stepper *s, mpm_status status) {
  return mpmi_is_shared(s) ? mpmi_agree(s->context, status) : status;
}

/* ---- before a step ------------------------------------------------------------------------------------- */
mpm_status mpmi_together_offers(mpm_stepper *s) {
  const int32_t solver = s->settings.desc.linear_solver;
  if (!mpmi_is_shared(s) || !mpmi_is_implicit(&s->settings)) return MPM_OK;
  if (solver != MPM_SOLVER_MULTIGRID_CG && solver != MPM_SOLVER_LDLT) return MPM_OK;
  return mpmi_fail(
      s->context, MPM_E_UNSUPPORTED,
      "a problem in several parts does not have %s: use MPM_SOLVER_CG, MPM_SOLVER_GMRES or MPM_SOLVER_HOST",
      solver == MPM_SOLVER_LDLT ? "MPM_SOLVER_LDLT" : "MPM_SOLVER_MULTIGRID_CG");
}

/* The flags of sets that count on all parts once they are set on one. */
static const uint32_t flag[] = {MPMI_DIRTY_ORDER, MPMI_DIRTY_PLACE,        MPMI_DIRTY_STRESS,
                                MPMI_DIRTY_SUMS,  MPMI_DIRTY_ACCELERATION, MPMI_DIRTY_IDS};
enum { FLAGS = sizeof flag / sizeof flag[0], OWN_WORDS = 12, MOST_NUMBERS = 7 };
/* What parts tell each other of a set. That of the first sets goes with the rest, and of others apart. */
enum { SET_WORDS = FLAGS + 2, FIRST_SETS = 4, SETS_AT = OWN_WORDS + 2 * MOST_NUMBERS };

static void put_set(int64_t *word, const mpm_particles *set) {
  for (int32_t i = 0; i < FLAGS; ++i) word[i] = (set->dirty & flag[i]) != 0;
  word[FLAGS] = mpmi_ordered_bits(set->mass_max);
  word[FLAGS + 1] = set->next_id;
}

static void take_set(const int64_t *word, mpm_particles *set) {
  for (int32_t i = 0; i < FLAGS; ++i)
    if (word[i]) set->dirty |= flag[i];
  set->mass_max = mpmi_of_ordered_bits(word[FLAGS]);
  set->next_id = word[FLAGS + 1];
}

/* Whole words of a double, as they are and the other way round, so that the largest of both say whether all
 * are alike. */
void mpmi_put_number(int64_t *word, double number) {
  memcpy(&word[0], &number, sizeof number);
  word[1] = ~word[0];
}

/* Returns a number that is another where surfaces or their markers are. */
static double count_markers(const mpmi_surfaces *list) {
  double number = 0.0;
  for (int64_t i = 0; i < list->count; ++i) number = 3.0 * number + 1.0 + (double)list->surface[i]->now.count;
  return number;
}

mpm_status mpmi_check_alike(const mpm_stepper *s, int32_t count, const char *const *name,
                            const double *number, const int64_t *word) {
  for (int32_t i = 0; i < count; ++i)
    if (word[2 * i] != ~word[2 * i + 1])
      return mpmi_fail(s->context, MPM_E_ARG,
                       "%s is %g here, and another number on another part: give all the same", name[i],
                       number[i]);
  return MPM_OK;
}

mpm_status mpmi_together_begin(mpm_stepper *s, mpm_status status, int32_t count, const char *const *name,
                               const double *number) {
  mpm_context *c = s->context;
  mpmi_layout *layout = &s->layout;
  if (!mpmi_is_shared(s)) return status;
  int64_t word[SETS_AT + FIRST_SETS * SET_WORDS] = {0};
  mpmi_put_number(word, (double)layout->member_count);
  word[2] = !s->history.has_sums;
  word[3] = layout->walls_changed;
  word[4] = layout->parts->is_stale;
  word[5] = s->settings.progress != NULL;
  for (int32_t m = 0; m < layout->member_count; ++m)
    word[6] |= layout->member[m].set->field[MPMI_PRESCRIBED].present;
  for (int32_t i = 0; i < count; ++i) mpmi_put_number(&word[OWN_WORDS + 2 * i], number[i]);
  word[7] = status != MPM_OK;
  word[8] = mpmi_fingerprint(s);
  word[9] = ~word[8];
  mpmi_put_number(&word[10], count_markers(&s->settings.surfaces));
  for (int32_t m = 0; m < layout->member_count && m < FIRST_SETS; ++m)
    put_set(&word[SETS_AT + SET_WORDS * m], layout->member[m].set);
  const mpm_status lost = mpmi_reduce_parts(c, MPM_REDUCE_MAX, sizeof word / sizeof word[0], word);
  if (lost) return lost;
  if (word[7]) return mpmi_agree(c, status);
  if (word[0] != ~word[1])
    return mpmi_fail(c, MPM_E_STATE,
                     "the stepper has other numbers of sets on other parts: add the same to all");
  if (word[8] != ~word[9])
    return mpmi_fail(
        c, MPM_E_STATE,
        "the stepper is set up otherwise on another part: give it the same grid, laws, description, walls, "
        "bodies, contact, heat, adaption, obstacles, surfaces, callbacks and linear solver on all");
  if (word[10] != ~word[11])
    return mpmi_fail(c, MPM_E_STATE,
                     "surfaces have other numbers of markers on other parts: all parts have all markers");
  if ((status = mpmi_check_alike(s, count, name, number, word + OWN_WORDS))) return status;
  if (word[2]) s->history.has_sums = 0;
  layout->walls_changed |= word[3] != 0;
  layout->parts->is_stale |= word[4] != 0;
  layout->parts->asks = word[5] != 0;
  layout->parts->prescribes = word[6] != 0;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    mpm_particles *set = layout->member[m].set;
    int64_t *of = &word[SETS_AT + SET_WORDS * (m < FIRST_SETS ? m : 0)];
    if (m >= FIRST_SETS) {
      put_set(of, set);
      if ((status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, SET_WORDS, of))) return status;
    }
    take_set(of, set);
  }
  return MPM_OK;
}

mpm_status mpmi_together_refreshed(mpm_stepper *s, mpm_status status) {
  return mpmi_is_shared(s) && mpmi_layout_is_moved(&s->layout) ? mpmi_agree(s->context, status) : status;
}

/* ---- after it ------------------------------------------------------------------------------------------ */
/* Takes part in the exchanges that are left, so that no part waits. */
static mpm_status catch_up(mpm_stepper *s, mpm_status status, int64_t exchanges) {
  mpmi_parts *parts = s->layout.parts;
  while (status && !s->context->apart) {
    if (parts->accords < parts->accords_due && parts->accord[parts->accords].after == parts->exchanges) {
      mpmi_accord_break(parts);
    } else if (parts->exchanges < exchanges) {
      mpmi_tiles_send(parts, 8, s->layout.blocks.cover, status);
      mpmi_tiles_receive(parts, 8, status);
    } else {
      break;
    }
  }
  if (!status && parts->exchanges != exchanges)
    return mpmi_fail(s->context, MPM_E_INTERNAL, "a step had %lld exchanges and not %lld",
                     (long long)parts->exchanges, (long long)exchanges);
  return status;
}

/* Finds the part with the first failure: that before the earliest exchange, and among those the smallest set,
 * particle, node and part, as among tasks. Those that only repeat what a partner has told come last. */
static mpm_status find_first(mpm_stepper *s, mpm_status status, int64_t came_to, int32_t *part) {
  const mpmi_failure *f = &s->step.failure;
  const int64_t key[] = {s->layout.parts->is_echo ? INT64_MAX : came_to, f->set, f->particle, f->node,
                         s->context->transport.part};
  enum { KEYS = sizeof key / sizeof key[0] };
  int32_t is_first = status != MPM_OK;
  for (int32_t i = 0; i < KEYS; ++i) {
    int64_t best = is_first ? -key[i] : INT64_MIN;
    const mpm_status lost = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, 1, &best);
    if (lost) return lost;
    is_first &= best == -key[i];
    *part = (int32_t)-best;
  }
  return MPM_OK;
}

/* Takes over how the step has failed on a part. */
static mpm_status take_failure(mpm_stepper *s, mpm_status status, int32_t part) {
  mpmi_failure *f = &s->step.failure;
  int64_t word[] = {f->callback_status, f->set, f->particle, f->node, f->body};
  enum { WORDS = sizeof word / sizeof word[0] };
  for (int32_t i = 0; i < WORDS && part != s->context->transport.part; ++i) word[i] = INT64_MIN;
  const mpm_status lost = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, WORDS, word);
  if (lost) return lost;
  f->callback_status = (int32_t)word[0];
  f->set = (int32_t)word[1];
  f->particle = word[2];
  f->node = word[3];
  f->body = (int32_t)word[4];
  return mpmi_take_over(s->context, part, status);
}

mpm_status mpmi_together_active(mpm_stepper *s) {
  int64_t active[] = {s->layout.parts->has_counted, s->step.info.active_nodes};
  const mpm_status status = mpmi_reduce_parts(s->context, MPM_REDUCE_SUM, 2, active);
  s->step.info.active_nodes =
      active[0] == s->context->transport.parts ? active[1] : s->history.last.active_nodes;
  return status;
}

mpm_status mpmi_together_ready(mpm_stepper *s, mpm_status status) {
  if (!mpmi_is_shared(s)) return status;
  const mpmi_failure *f = &s->step.failure;
  const int32_t parts = s->context->transport.parts;
  /* where parts have agreed before, one alone knows where it was */
  const int32_t knows = f->particle >= 0 || f->node >= 0 || f->callback_status;
  int64_t first = status ? (1 + knows) * parts - s->context->transport.part : 0;
  const mpm_status lost = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, 1, &first);
  if (lost || !first) return lost;
  status = take_failure(s, status, (int32_t)((first > parts ? 2 * parts : parts) - first));
  const mpm_status counted = mpmi_together_active(s);
  return counted ? counted : status;
}

/* Returns the status of the first failure of all parts; word: largest numbers of all parts, the first of
 * which says whether there is any. */
static mpm_status settle(mpm_stepper *s, mpm_status status, int64_t exchanges, int64_t count, int64_t *word) {
  const int64_t came_to = s->layout.parts->exchanges;
  int32_t part = 0;
  mpmi_time_add(s->layout.parts);
  status = catch_up(s, status, exchanges);
  word[0] = status != MPM_OK;
  mpm_status lost = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, count, word);
  if (!lost && word[0]) lost = find_first(s, status, came_to, &part);
  if (lost || !word[0]) return lost;
  return take_failure(s, status, part);
}

mpm_status mpmi_together_vote(mpm_stepper *s, mpm_status status, int64_t exchanges) {
  int64_t word[1];
  status = settle(s, status, exchanges, 1, word);
  s->layout.parts->exchanges = s->layout.parts->is_echo = 0;
  return status;
}

mpm_status mpmi_together_end(mpm_stepper *s, mpm_status status, int64_t exchanges) {
  if (!mpmi_is_shared(s)) return status;
  mpmi_task_report *report = &s->work.report[0];
  int64_t word[] = {0, 0, 0, 0};
  for (int32_t k = 0; k < s->settings.tasks; ++k) {
    word[1] |= s->work.report[k].left_tile;
    word[2] |= s->work.report[k].removes;
    word[3] |= s->work.report[k].holes_restored;
  }
  status = settle(s, status, exchanges, 4, word);
  if (status) {
    const mpm_status lost = mpmi_together_active(s);
    return lost ? lost : status;
  }
  report->left_tile |= word[1] != 0;
  report->removes |= word[2] != 0;
  report->holes_restored |= word[3] != 0;
  return MPM_OK;
}

/* Counts the particles whose new position lies beyond the grid. */
static int64_t count_leaving(const mpm_stepper *s) {
  int64_t count = 0;
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    const mpm_particles *set = s->layout.member[m].set;
    for (int64_t slot = 0; slot < set->slots; ++slot)
      count += mpmi_i64(set, MPMI_ID, 0)[slot] >= 0 && mpmi_is_beyond(set, 1, slot);
  }
  return count;
}

mpm_status mpmi_together_rates(mpm_stepper *s, mpmi_sums *rates) {
  int64_t rate[] = {mpmi_ordered_bits(rates->rate), mpmi_ordered_bits(rates->viscous_rate)};
  const mpm_status status = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, 2, rate);
  rates->rate = mpmi_of_ordered_bits(rate[0]);
  rates->viscous_rate = mpmi_of_ordered_bits(rate[1]);
  return status;
}

mpm_status mpmi_together_total(mpm_stepper *s, mpmi_sums *rates) {
  const mpmi_tally *tally = &s->work.tally;
  if (!mpmi_is_shared(s)) return mpmi_total_parts(s->context, tally->count, tally->sum, tally->total);
  const int64_t leaving = s->work.report[0].removes ? count_leaving(s) : 0;
  mpmi_riders riders = {2,
                        2,
                        {mpmi_ordered_bits(rates->rate), mpmi_ordered_bits(rates->viscous_rate)},
                        {s->step.info.active_nodes, leaving}};
  const mpm_status status =
      mpmi_total_parts_with(s->context, tally->count, tally->sum, tally->total, &riders);
  if (status) return status;
  rates->rate = mpmi_of_ordered_bits(riders.largest[0]);
  rates->viscous_rate = mpmi_of_ordered_bits(riders.largest[1]);
  s->step.info.active_nodes = riders.sum[0];
  s->layout.parts->leave_elsewhere = riders.sum[1] - leaving;
  return MPM_OK;
}

/* ---- what it costs ------------------------------------------------------------------------------------- */
mpm_status mpm_stepper_parallel_info(mpm_stepper *s, int32_t reset, mpm_parallel_info *info) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (!info) return mpmi_fail(s->context, MPM_E_ARG, "info is NULL");
  mpm_parallel_info now = {.imbalance = 1.0};
  if (mpmi_is_shared(s)) {
    now = s->layout.parts->info;
    now.seconds_reducing = s->context->reducing;
  } else {
    now.blocks = s->layout.worklist[0].count;
  }
  now.struct_size = sizeof now;
  const mpm_status status = mpmi_write_struct(s->context, "mpm_parallel_info", &now, sizeof now, info);
  if (status || !reset) return status;
  if (mpmi_is_shared(s)) {
    mpm_parallel_info *counts = &s->layout.parts->info;
    counts->bytes_nodes = counts->bytes_moved = counts->moved = counts->cuts = 0;
    counts->seconds_packing = counts->seconds_waiting = 0.0;
  }
  s->context->reducing = 0.0;
  return MPM_OK;
}
