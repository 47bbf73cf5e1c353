/* A state holds how bodies meet, and what they have done to each other. */
#include "io/state.h"

/* A rule as the state has it. */
typedef struct saved_rule {
  int64_t a, b, kind, normal, detection;
  double friction, friction_static, adhesion, offset, direction[3];
} saved_rule;

typedef struct saved_pair {
  int64_t a, b;
  mpmi_pair_sums last;
  double impulse_total[3];
} saved_pair;
_Static_assert(sizeof(saved_rule) == 12 * 8 && sizeof(saved_pair) == (5 + 16) * 8, "part of the format");

void mpmi_state_write_contact(mpmi_archive *a, const mpm_stepper *s) {
  const mpmi_contact_rules *rules = &s->settings.contact;
  const mpmi_pair_records *pairs = &s->history.pairs;
  int64_t counts[2] = {rules->count, pairs->count};
  mpmi_archive_words(a, counts, sizeof counts);
  for (int64_t i = 0; i < rules->count; ++i) {
    const mpm_contact_desc *d = &rules->rule[i].desc;
    saved_rule rule = {.a = rules->rule[i].a,
                       .b = rules->rule[i].b,
                       .kind = d->kind,
                       .normal = d->normal,
                       .detection = d->detection,
                       .friction = d->friction,
                       .friction_static = d->friction_static,
                       .adhesion = d->adhesion,
                       .offset = d->offset,
                       .direction = {d->direction[0], d->direction[1], d->direction[2]}};
    mpmi_archive_words(a, &rule, sizeof rule);
  }
  for (int64_t i = 0; i < pairs->count; ++i) {
    const mpmi_pair_record *record = &pairs->record[i];
    saved_pair pair = {.a = record->a, .b = record->b, .last = record->last};
    for (int32_t c = 0; c < 3; ++c) pair.impulse_total[c] = record->impulse_total[c];
    mpmi_archive_words(a, &pair, sizeof pair);
  }
}

static int32_t is_body(int64_t body, int64_t lowest) {
  return body >= lowest && body < MPMI_MAX_BODIES;
}

static int32_t is_int(int64_t value) {
  return value >= 0 && value <= INT32_MAX;
}

/* Lists of pairs are in order. */
static int32_t comes_after(int64_t a, int64_t b, int32_t last_a, int32_t last_b) {
  return a > last_a || (a == last_a && b > last_b);
}

static mpm_status read_rule(mpmi_archive *a, const mpm_grid *grid, mpmi_contact_rules *rules) {
  saved_rule rule = {0};
  mpmi_archive_words(a, &rule, sizeof rule);
  if (a->status) return a->status;
  if (!is_body(rule.a, MPM_BODY_ANY) || !is_body(rule.b, rule.a) || (rule.a == rule.b && rule.a >= 0) ||
      !is_int(rule.kind) || !is_int(rule.normal) || !is_int(rule.detection) ||
      (rules->count &&
       !comes_after(rule.a, rule.b, rules->rule[rules->count - 1].a, rules->rule[rules->count - 1].b)))
    return mpmi_archive_damaged(a, "a rule of contact makes no sense");
  mpm_contact_desc d = {.struct_size = sizeof d,
                        .kind = (int32_t)rule.kind,
                        .normal = (int32_t)rule.normal,
                        .detection = (int32_t)rule.detection,
                        .friction = rule.friction,
                        .friction_static = rule.friction_static,
                        .adhesion = rule.adhesion,
                        .offset = rule.offset,
                        .direction = {rule.direction[0], rule.direction[1], rule.direction[2]}};
  if (mpmi_contact_desc_check(grid, (int32_t)rule.a, (int32_t)rule.b, &d))
    return mpmi_archive_damaged(a, "a rule of contact makes no sense");
  return mpmi_contact_rules_set(rules, a->context, (int32_t)rule.a, (int32_t)rule.b, &d);
}

/* lowest: the code of the last surface. */
static mpm_status read_pair(mpmi_archive *a, int32_t lowest, mpmi_pair_records *pairs) {
  saved_pair pair = {.a = 0};
  mpmi_archive_words(a, &pair, sizeof pair);
  if (a->status) return a->status;
  if (pair.a < lowest || pair.a == MPM_BODY_ANY || pair.a >= MPMI_MAX_BODIES ||
      !is_body(pair.b, pair.a < 0 ? 0 : pair.a + 1) ||
      (pairs->count &&
       !comes_after(pair.a, pair.b, pairs->record[pairs->count - 1].a, pairs->record[pairs->count - 1].b)))
    return mpmi_archive_damaged(a, "a pair of bodies makes no sense");
  const mpm_status status = mpmi_pair_add(pairs, a->context, (int32_t)pair.a, (int32_t)pair.b);
  if (status) return status;
  mpmi_pair_record *record = &pairs->record[pairs->count - 1];
  record->last = pair.last;
  for (int32_t c = 0; c < 3; ++c) record->impulse_total[c] = pair.impulse_total[c];
  return MPM_OK;
}

mpm_status mpmi_state_read_contact(mpmi_archive *a, const mpm_stepper *s, mpmi_contact_rules *rules,
                                   mpmi_pair_records *pairs) {
  int64_t counts[2] = {0, 0};
  mpmi_archive_words(a, counts, sizeof counts);
  for (int64_t i = 0; i < counts[0] && !a->status; ++i) {
    const mpm_status status = read_rule(a, s->grid, rules);
    if (status) return status;
  }
  for (int64_t i = 0; i < counts[1] && !a->status; ++i) {
    const mpm_status status = read_pair(a, mpmi_code_of_obstacle(s->settings.obstacles.count) + 1, pairs);
    if (status) return status;
  }
  if (!a->status && (counts[0] < 0 || counts[1] < 0))
    mpmi_archive_damaged(a, "its rules of contact make no sense");
  return a->status;
}
