/* The transport between threads, and the rounds that prove a transport: both must notice what is wrong. */
#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "parts.h"
#include "transport_rounds.h"

typedef struct run {
  rounds_desc desc;
  int status[PARTS_MOST];
  char text[PARTS_MOST][ROUNDS_TEXT];
} run;

static void live(int32_t part, const mpm_transport *transport, void *user) {
  run *r = user;
  r->status[part] = rounds_run(transport, &r->desc, r->text[part]);
}

START_TEST(rounds) {
  static const int32_t parts[] = {1, 2, 3, 5, 8};
  for (size_t i = 0; i < sizeof parts / sizeof *parts; ++i)
    for (int32_t jitter = 0; jitter < 200; jitter += 100) {
      run r = {.desc = {.seed = i, .rounds = 60, .largest = jitter ? 3000 : 1000000}};
      parts_plan plan = {.jitter = jitter, .seed = (uint32_t)i};
      ck_assert_msg(!parts_run(parts[i], live, &r, &plan), "%s", plan.text);
      for (int32_t part = 0; part < parts[i]; ++part) {
        ck_assert_msg(!r.status[part], "%s", r.text[part]);
        ck_assert_int_ge(plan.calls[part], 120);
        ck_assert(parts[i] == 1 ? !plan.messages[part] : plan.messages[part] > 20);
      }
    }
}
END_TEST

/* Whatever call fails, on whatever part, all parts hear of it and come to an end. */
START_TEST(planned_failures) {
  enum { PARTS = 3, ROUNDS = 12 };
  static const int32_t kinds[] = {PARTS_SEND, PARTS_RECEIVE, PARTS_REDUCE, PARTS_GATHER, PARTS_ANY};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
    int32_t seen = 0;
    for (int64_t at = 1;; ++at) {
      run r = {.desc = {.seed = 7, .rounds = ROUNDS, .largest = 1000}};
      parts_plan plan = {
          .fail_part = (int32_t)(at % PARTS), .fail_kinds = kinds[k], .fail_at = at, .jitter = 20};
      if (!parts_run(PARTS, live, &r, &plan)) break;
      ++seen;
      char wanted[PARTS_TEXT];
      snprintf(wanted, sizeof wanted, "part %d: call %lld fails as planned", (int)plan.fail_part,
               (long long)plan.calls[plan.fail_part]);
      ck_assert_str_eq(plan.text, wanted);
      ck_assert_int_eq(r.status[plan.fail_part], -1);
      if (kinds[k] == PARTS_SEND) ck_assert_ptr_nonnull(strstr(r.text[plan.fail_part], "send (-4)"));
    }
    ck_assert_int_ge(seen, kinds[k] == PARTS_GATHER ? 1 : kinds[k] == PARTS_REDUCE ? 3 : ROUNDS);
  }
}
END_TEST

/* What parts do that they must not, and the sentence for it. */
typedef enum misuse {
  NONE,
  TWO_SENDS,
  NO_SEND,
  REDUCE_EARLY,
  GATHER_EARLY,
  END_EARLY,
  EXCHANGE_3,
  TO_ITSELF,
  TO_NOBODY,
  DESCENDING,
  NEGATIVE,
  NO_DATA,
  MOST_IN_SPARSE,
  NO_MOST,
  NEGATIVE_MOST,
  TOO_MANY,
  NO_OUT,
  MORE_THAN_MOST,
  CHANGED,
  UNLIKE_EXCHANGES,
  UNLIKE_REDUCTIONS,
  UNLIKE_COUNTS,
  OP_3,
  GATHER_NOWHERE,
  ALONE,
  UNANSWERED,
  OVERTAKES,
  MISUSES
} misuse;

static const char *const sentences[MISUSES] = {
    [TWO_SENDS] = "sends before it has received",
    [NO_SEND] = "receives without having sent",
    [REDUCE_EARLY] = "reduces before it has received",
    [GATHER_EARLY] = "gathers before it has received",
    [END_EARLY] = "ends before it has received",
    [EXCHANGE_3] = "exchange 3",
    [TO_ITSELF] = "message 0 is for part 0",
    [TO_NOBODY] = "message 1 is for part 3",
    [DESCENDING] = "message 1 is for part 1",
    [NEGATIVE] = "message for part 1 has -1 bytes",
    [NO_DATA] = "message for part 1 has 4 bytes",
    [MOST_IN_SPARSE] = "most is wrong",
    [NO_MOST] = "most is wrong",
    [NEGATIVE_MOST] = "at most -1 bytes",
    [TOO_MANY] = "3 messages",
    [NO_OUT] = "out is NULL",
    [MORE_THAN_MOST] = "part 0 sent 4 bytes, at most 3 were expected",
    [CHANGED] = "data for part 1 changed before they were received",
    [UNLIKE_EXCHANGES] = "part 0 sent in exchange 2, here it is 1",
    [UNLIKE_REDUCTIONS] = "collective call 0 is of kind ",
    [UNLIKE_COUNTS] = "collective call 0 is of kind ",
    [OP_3] = "reduces 1 values by 3",
    [GATHER_NOWHERE] = "gathers into NULL",
    [ALONE] = "waits for ever",
    [UNANSWERED] = "waits for ever",
    [OVERTAKES] = "waits for ever",
};

typedef struct misused {
  misuse what;
  mpm_status last[PARTS_MOST];
} misused;

/* Parts 0 and 1 exchange; part 2 stands by in known exchanges. Part 0 does it wrong. */
static void misuse_it(int32_t part, const mpm_transport *t, void *user) {
  misused *u = user;
  const misuse what = part ? NONE : u->what;
  char data[] = "abc", other[] = "d";
  mpm_message out[3] = {{.part = part ? 0 : 1, .bytes = 4, .data = data},
                        {.part = 2, .bytes = 2, .data = other}};
  int64_t most[3] = {4, 4, 4}, value = 1, all[PARTS_MOST];
  int32_t count = part < 2, exchange = MPM_EXCHANGE_KNOWN, got;
  const mpm_message *in;
  mpm_status *last = &u->last[part];
  if (u->what == UNLIKE_REDUCTIONS || u->what == UNLIKE_COUNTS || u->what == ALONE) {
    if (what == ALONE) return;
    const int64_t values = what == UNLIKE_COUNTS ? 0 : 1;
    *last = t->reduce(t->user, what == UNLIKE_REDUCTIONS ? MPM_REDUCE_SUM : MPM_REDUCE_MAX, values, &value);
    return;
  }
  if (u->what == OVERTAKES && part) *last = t->gather(t->user, value, all);
  if (what == NO_SEND) *last = t->receive(t->user, &got, &in);
  if (what == EXCHANGE_3) exchange = 3;
  if (what == UNLIKE_EXCHANGES || what == MOST_IN_SPARSE) exchange = MPM_EXCHANGE_SPARSE;
  if (what == TO_ITSELF) out[0].part = 0;
  if (what == TO_NOBODY) out[1].part = 3;
  if (what == DESCENDING) out[0].part = 2, out[1].part = 1;
  if (what == TO_NOBODY || what == DESCENDING) count = 2;
  if (what == TOO_MANY) count = 3;
  if (what == NEGATIVE) out[0].bytes = -1;
  if (what == NO_DATA) out[0].data = NULL;
  if (what == NEGATIVE_MOST) most[0] = -1;
  if (u->what == MORE_THAN_MOST && part == 1) most[0] = 3;
  if (what == UNANSWERED) count = 2;
  const int with_most = exchange == MPM_EXCHANGE_KNOWN ? what != NO_MOST : what == MOST_IN_SPARSE;
  if (!*last) *last = t->send(t->user, exchange, count, what == NO_OUT ? NULL : out, with_most ? most : NULL);
  if (*last || what == END_EARLY) return;
  if (what == TWO_SENDS) *last = t->send(t->user, exchange, count, out, most);
  if (what == REDUCE_EARLY) *last = t->reduce(t->user, MPM_REDUCE_MAX, 1, &value);
  if (what == GATHER_EARLY) *last = t->gather(t->user, value, all);
  if (what == CHANGED) data[0] = 'x';
  if (!*last) *last = t->receive(t->user, &got, &in);
  if (what == OP_3) *last = t->reduce(t->user, 3, 1, &value);
  if (what == GATHER_NOWHERE) *last = t->gather(t->user, 1, NULL);
  if (what == OVERTAKES) *last = t->gather(t->user, value, all);
  /* Who has what it waits for may be done before part 0 ends; a collective call shows it the end. */
  if (!*last && u->what == END_EARLY) *last = t->reduce(t->user, MPM_REDUCE_MAX, 1, &value);
}

START_TEST(wrong_use) {
  for (misuse what = NONE; what < MISUSES; ++what) {
    misused u = {.what = what};
    parts_plan plan = {0};
    const int failed = parts_run(3, misuse_it, &u, &plan);
    ck_assert_int_eq(failed, what == NONE ? 0 : -1);
    if (what == NONE) ck_assert_str_eq(plan.text, "");
    if (what != NONE) ck_assert_msg(strstr(plan.text, sentences[what]), "%d: %s", what, plan.text);
    int32_t told = 0;
    for (int32_t part = 0; part < 3; ++part) told += u.last[part] == MPM_E_CALLBACK;
    ck_assert_int_eq(told > 0, what != NONE);
  }
  misused u = {.what = NONE};
  ck_assert_int_eq(parts_run(0, misuse_it, &u, NULL), -1);
  ck_assert_int_eq(parts_run(PARTS_MOST + 1, misuse_it, &u, NULL), -1);
  ck_assert_int_eq(parts_run(3, misuse_it, &u, NULL), 0);
}
END_TEST

/* A transport that falsifies what another brings. */
typedef enum falsehood {
  TRUE,
  BIT,
  ORDER,
  MISSING,
  LENGTH,
  ALIGNMENT,
  SENDER,
  SUM,
  GATHER,
  FALSEHOODS
} falsehood;

typedef struct liar {
  const mpm_transport *t;
  falsehood lie;
  int32_t part;
  mpm_message in[PARTS_MOST];
  _Alignas(64) unsigned char moved[4096];
} liar;

static mpm_status lie_send(void *user, int32_t exchange, int32_t count, const mpm_message *out,
                           const int64_t *most) {
  liar *l = user;
  return l->t->send(l->t->user, exchange, count, out, most);
}

static mpm_status lie_receive(void *user, int32_t *count, const mpm_message **in) {
  liar *l = user;
  const mpm_message *got;
  const mpm_status status = l->t->receive(l->t->user, count, &got);
  if (status || l->part || *count < 2) {
    if (!status) *in = got;
    return status;
  }
  const size_t n = (size_t)*count;
  memcpy(l->in, got, n * sizeof *got);
  *in = l->in;
  mpm_message *last = &l->in[n - 1];
  if (l->lie == BIT && last->bytes) ((unsigned char *)last->data)[last->bytes - 1] ^= 1;
  if (l->lie == ORDER) last[0] = got[n - 2], last[-1] = got[n - 1];
  if (l->lie == MISSING) --*count;
  if (l->lie == LENGTH) ++last->bytes;
  if (l->lie == SENDER) last->part = 0;
  if (l->lie == ALIGNMENT && last->bytes < 4000) {
    if (last->bytes) memcpy(l->moved + 8, last->data, (size_t)last->bytes);
    last->data = l->moved + 8;
  }
  return 0;
}

static mpm_status lie_reduce(void *user, int32_t op, int64_t count, int64_t *values) {
  liar *l = user;
  const mpm_status status = l->t->reduce(l->t->user, op, count, values);
  if (!status && count && l->lie == SUM && !l->part) ++values[count - 1];
  return status;
}

static mpm_status lie_gather(void *user, int64_t value, int64_t *all) {
  liar *l = user;
  const mpm_status status = l->t->gather(l->t->user, value, all);
  if (!status && l->lie == GATHER && !l->part) ++all[l->t->parts - 1];
  return status;
}

typedef struct lying_run {
  run run;
  falsehood lie;
} lying_run;

static void live_lying(int32_t part, const mpm_transport *t, void *user) {
  lying_run *r = user;
  liar l = {.t = t, .lie = r->lie, .part = part};
  mpm_transport false_one = *t;
  false_one.send = lie_send;
  false_one.receive = lie_receive;
  false_one.reduce = lie_reduce;
  false_one.gather = lie_gather;
  false_one.poll = NULL;
  false_one.user = &l;
  r->run.status[part] = rounds_run(&false_one, &r->run.desc, r->run.text[part]);
}

START_TEST(rounds_notice) {
  static const char *const words[FALSEHOODS] = {"",
                                                "wrong bytes",
                                                "the wrong part",
                                                "too few",
                                                "the wrong size",
                                                "multiple of 64",
                                                "the wrong part",
                                                "a wrong reduction",
                                                "a wrong value gathered"};
  for (falsehood lie = TRUE; lie < FALSEHOODS; ++lie) {
    lying_run r = {.run = {.desc = {.seed = 1, .rounds = 30, .largest = 4000}}, .lie = lie};
    parts_plan plan = {0};
    const int failed = parts_run(4, live_lying, &r, &plan);
    ck_assert_int_eq(failed, lie == TRUE ? 0 : -1);
    ck_assert_int_eq(r.run.status[0], failed);
    if (lie != TRUE) ck_assert_msg(strstr(r.run.text[0], words[lie]), "%d: %s", lie, r.run.text[0]);
  }
}
END_TEST

Suite *parts_suite(void) {
  Suite *suite = suite_create("parts");
  TCase *tests = tcase_create("parts");
  tcase_set_timeout(tests, 60);
  tcase_add_test(tests, rounds);
  tcase_add_test(tests, planned_failures);
  tcase_add_test(tests, wrong_use);
  tcase_add_test(tests, rounds_notice);
  suite_add_tcase(suite, tests);
  return suite;
}
