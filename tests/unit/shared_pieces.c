/* Pieces of a state that are no state, and calls that fail on one part: all parts refuse them alike, and have
 * what they had before, bit by bit. */
#include "shared.h"
#include "shared_states.h"

enum { PARTS = FAULTY, TEXT = 400, MOST = 8 };

typedef struct given {
  int32_t count;
  const unsigned char *data[MOST];
  int64_t bytes[MOST];
} given;

/* What all parts have, and what each of them finds. */
typedef struct attempt {
  saved_state piece[PARTS], later[PARTS]; /* of two steps */
  given of[PARTS];                        /* what the parts give */
  int64_t fail_at[PARTS];                 /* the allocation of the call that fails */
  int64_t calls[PARTS];                   /* how many it has */
  int32_t saves, unlike; /* saves again, in so many ways; the call of part 1 is wrong in so many ways */
  const char *folder;
  mpm_status status[PARTS];
  char text[PARTS][TEXT];
  int32_t changed[PARTS];
  int64_t held[PARTS];
  uint64_t hash[PARTS];
} attempt;

static world_desc small_world(void) {
  world_desc desc = world_default(2, 48, 1.0 / 48.0);
  desc.sets = 2;
  return desc;
}

static mpm_status set_up(world *w) {
  static const double low[2][2] = {{0.2, 0.2}, {0.5, 0.5}}, high[2][2] = {{0.6, 0.6}, {0.8, 0.7}};
  static const double speed[] = {6.0, 3.0};
  static const int32_t per_cell[] = {2, 2};
  mpm_status status = MPM_OK;
  for (int32_t face = 0; face < 4 && !status; ++face)
    status = mpm_stepper_set_wall(w->stepper, face, MPM_WALL_SLIP, 0.0);
  for (int32_t m = 0; m < 2 && !status; ++m) {
    status = mpm_particles_fill_box(w->set[m], low[m], high[m], per_cell, NULL, NULL);
    if (!status && mpm_particles_count(w->set[m]))
      status = mpm_particles_set_all(w->set[m], "velocity", MPM_F64, 2, speed);
  }
  return status;
}

static mpm_status steps(world *w, int32_t n) {
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < n && !status; ++i) status = mpm_step(w->stepper, 6e-4, NULL);
  return status;
}

static mpm_status save(world *w, saved_state *to) {
  mpm_status status = mpm_state_size(w->stepper, &to->bytes);
  if (status) return status;
  to->data = malloc((size_t)to->bytes);
  return mpm_state_save(w->stepper, to->data, to->bytes);
}

static mpm_status open(world *w, const mpm_transport *transport) {
  memset(w, 0, sizeof *w);
  w->desc = small_world();
  w->desc.context.transport = transport;
  mpm_status status = world_try_open(w);
  return status ? status : set_up(w);
}

/* ---- making them --------------------------------------------------------------------------------------- */
static void make(int32_t part, const mpm_transport *transport, void *user) {
  attempt *a = user;
  world w;
  mpm_status status = open(&w, transport);
  if (!status) status = steps(&w, 6);
  if (!status) status = save(&w, &a->piece[part]);
  if (!status) status = steps(&w, 3);
  if (!status) status = save(&w, &a->later[part]);
  if (!status) status = mpm_state_hash(w.stepper, &a->hash[part]);
  a->status[part] = world_try_close(&w) && !status ? (mpm_status)MPM_E_INTERNAL : status;
}

static attempt prepared;

static void make_pieces(void) {
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  memset(&prepared, 0, sizeof prepared);
  ck_assert_msg(!parts_run(PARTS, make, &prepared, &plan), "%s", plan.text);
  for (int32_t r = 0; r < PARTS; ++r) ck_assert_int_eq(prepared.status[r], MPM_OK);
}

static void drop_pieces(void) {
  for (int32_t r = 0; r < PARTS; ++r) free(prepared.piece[r].data), free(prepared.later[r].data);
}

/* ---- giving them --------------------------------------------------------------------------------------- */
static mpm_status call(world *w, const attempt *a, int32_t part) {
  const given *of = &a->of[part];
  const void *piece[MOST];
  for (int32_t i = 0; i < of->count; ++i) piece[i] = of->data[i];
  int64_t bytes[MOST];
  memcpy(bytes, of->bytes, sizeof bytes);
  if (part == 1) switch (a->unlike) {
    case 1:
      return mpm_state_load_pieces(w->stepper, -1, piece, bytes);
    case 2:
      return mpm_state_load_pieces(w->stepper, 1, NULL, bytes);
    case 3:
      return mpm_state_load_pieces(w->stepper, 1, piece, NULL);
    case 4:
      piece[0] = NULL;
      break;
    case 5:
      bytes[0] = -1;
      break;
    default:
      break;
    }
  return mpm_state_load_pieces(w->stepper, of->count, piece, bytes);
}

/* Loads, which is to fail, and compares what is saved before and after; then goes on. */
static void try_them(int32_t part, const mpm_transport *transport, void *user) {
  attempt *a = user;
  world w;
  saved_state before = {0}, after = {0};
  mpm_status status = open(&w, transport);
  if (!status) status = steps(&w, 5);
  if (!status) status = save(&w, &before);
  const int64_t calls = w.memory.calls;
  if (a->fail_at[part]) w.memory.fail_at = calls + a->fail_at[part];
  if (!status) {
    status = a->status[part] = call(&w, a, part);
    a->calls[part] = w.memory.calls - calls;
    w.memory.fail_at = 0;
    snprintf(a->text[part], TEXT, "%s", status ? mpm_last_error(w.context) : "");
    status = save(&w, &after);
    a->changed[part] =
        status || after.bytes != before.bytes || memcmp(after.data, before.data, (size_t)after.bytes);
    if (!status) status = steps(&w, 4);
    if (!status) status = mpm_state_hash(w.stepper, &a->hash[part]);
  } else {
    a->status[part] = status;
  }
  if (status) a->hash[part] = 0;
  free(before.data), free(after.data);
  if (world_try_close(&w) || w.memory.held) a->changed[part] = 2;
}

static void give(attempt *a, int32_t part, const saved_state *piece) {
  given *of = &a->of[part];
  of->data[of->count] = piece->data;
  of->bytes[of->count++] = piece->bytes;
}

/* All parts have this status, and the sentence; nothing has changed, and they go on alike. */
static void refused(attempt *a, mpm_status wanted, const char *words) {
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  ck_assert_msg(!parts_run(PARTS, try_them, a, &plan), "%s: %s", words, plan.text);
  for (int32_t r = 0; r < PARTS; ++r) {
    ck_assert_msg(a->status[r] == wanted, "%s: part %d: %s: %s", words, r, mpm_status_name(a->status[r]),
                  a->text[r]);
    ck_assert_msg(strstr(a->text[r], words) != NULL, "part %d: \"%s\" in \"%s\"", r, words, a->text[r]);
    ck_assert_msg(!a->changed[r] == !!wanted, "%s: part %d has changed: %d", words, r, a->changed[r]);
    ck_assert_msg(a->hash[r] && a->hash[r] == a->hash[0], "%s: part %d goes on in another way", words, r);
  }
}

static attempt fresh_attempt(void) {
  attempt a;
  memset(&a, 0, sizeof a);
  return a;
}

/* Lists of pieces: three for each part, of which -1 is none; from 10 on those of the later step. */
START_TEST(what_is_no_state) {
  static const struct {
    int32_t list[PARTS][3];
    mpm_status status;
    const char *words;
  } tries[] = {{{{0, -1}, {1, -1}, {2, -1}}, MPM_OK, ""},
               {{{-1}, {0, 1, 2}, {-1}}, MPM_OK, ""},
               {{{-1}, {-1}, {-1}}, MPM_E_ARG, "no part gives a piece"},
               {{{0, -1}, {-1}, {2, -1}}, MPM_E_ARG, "piece 1 of the state is missing: it has 3"},
               {{{-1}, {1, -1}, {2, -1}}, MPM_E_ARG, "piece 0 of the state is missing"},
               {{{0, 1, -1}, {-1}, {-1}}, MPM_E_ARG, "piece 2 of the state is missing"},
               {{{0, -1}, {0, -1}, {2, -1}}, MPM_E_ARG, "piece 0 of the state is given twice"},
               {{{0, 1, -1}, {2, 2, -1}, {-1}}, MPM_E_ARG, "piece 2 of the state is given twice"},
               {{{0, -1}, {2, -1}, {1, -1}}, MPM_E_ARG, "piece 2 of the state comes before piece 1"},
               {{{0, -1}, {1, -1}, {12, -1}}, MPM_E_ARG, "of different states: the first and number 3 of 3"},
               {{{10, -1}, {1, -1}, {2, -1}}, MPM_E_ARG, "of different states: the first and number 2 of 3"}};
  for (size_t i = 0; i < sizeof tries / sizeof *tries; ++i) {
    attempt a = fresh_attempt();
    for (int32_t r = 0; r < PARTS; ++r)
      for (int32_t k = 0; k < 3 && tries[i].list[r][k] >= 0; ++k) {
        const int32_t number = tries[i].list[r][k];
        give(&a, r, number < 10 ? &prepared.piece[number] : &prepared.later[number - 10]);
      }
    refused(&a, tries[i].status, tries[i].words);
    for (int32_t r = 1; r < PARTS; ++r) ck_assert_str_eq(a.text[r], a.text[0]);
  }
}
END_TEST

static attempt in_order(void) {
  attempt a = fresh_attempt();
  for (int32_t r = 0; r < PARTS; ++r) give(&a, r, &prepared.piece[r]);
  return a;
}

/* A byte of the piece of part 1 is another one, or it is cut. */
START_TEST(damaged_pieces) {
  saved_state *piece = &prepared.piece[1];
  for (int64_t i = 0; i < piece->bytes; i += 1 + i / 3) {
    attempt a = in_order();
    piece->data[i] ^= 4;
    refused(&a, MPM_E_FORMAT, "piece[0]: ");
    piece->data[i] ^= 4;
    ck_assert_msg(!strncmp(a.text[2], "part 1: piece[0]: ", 18), "%s", a.text[2]);
    ck_assert_str_eq(a.text[0], a.text[2]);
  }
  for (int64_t left = piece->bytes - 8; left >= 0; left = left / 2 - 1) {
    attempt a = in_order();
    a.of[1].bytes[0] = left;
    refused(&a, MPM_E_FORMAT, "piece[0]: ");
  }
  attempt whole = in_order();
  refused(&whole, MPM_OK, "");
}
END_TEST

/* One part is called otherwise than the others. */
START_TEST(unlike_calls) {
  static const char *const words[] = {"count is -1", "piece is NULL", "bytes is NULL", "piece[0] is NULL",
                                      "bytes[0] is -1"};
  for (int32_t i = 0; i < 5; ++i) {
    attempt a = in_order();
    a.unlike = i + 1;
    refused(&a, MPM_E_ARG, words[i]);
  }
}
END_TEST

/* Wherever memory fails on one part. */
START_TEST(memory_runs_out) {
  attempt all = in_order();
  refused(&all, MPM_OK, "");
  planned f = {0};
  while (next_fault(&f, 36, all.calls)) {
    attempt a = in_order();
    a.fail_at[f.part] = f.at;
    refused(&a, MPM_E_NOMEM, "");
  }
  ck_assert_int_gt(all.calls[1], 40);
  tell_faults(&f, "memory");
}
END_TEST

/* Wherever the transport fails, every part returns. */
START_TEST(transport_fails) {
  parts_plan plan;
  attempt all = in_order();
  int64_t calls[PARTS], last = 0;
  memset(&plan, 0, sizeof plan);
  ck_assert_int_eq(parts_run(PARTS, try_them, &all, &plan), 0);
  memcpy(calls, plan.calls, sizeof calls);
  planned f = {0};
  while (next_fault(&f, 24, calls)) {
    attempt a = in_order();
    memset(&plan, 0, sizeof plan);
    plan.fail_part = f.part;
    plan.fail_kinds = PARTS_ANY;
    plan.fail_at = f.at;
    ck_assert_int_ne(parts_run(PARTS, try_them, &a, &plan), 0);
    for (int32_t r = 0; r < PARTS; ++r) {
      ck_assert_msg(a.status[r] == MPM_OK || a.status[r] == MPM_E_CALLBACK,
                    "call %lld of part %d, part %d: %s", (long long)f.at, (int)f.part, r,
                    mpm_status_name(a.status[r]));
      ck_assert_int_ne(a.changed[r], 2);
    }
    if (a.status[0] && last < f.at) last = f.at;
  }
  ck_assert(last > 0 && last < calls[0]);
  tell_faults(&f, "the transport");
}
END_TEST

/* ---- a sort that fails --------------------------------------------------------------------------------- */
/* Memory fails for one part in some step, while particles move to other parts; what is saved then goes on as
 * if it had not. */
static void fail_and_save(int32_t part, const mpm_transport *transport, void *user) {
  attempt *a = user;
  world w;
  mpm_status status = open(&w, transport);
  if (!status) status = steps(&w, 5);
  const int64_t calls = w.memory.calls;
  if (!status && a->fail_at[part]) w.memory.fail_at = calls + a->fail_at[part];
  for (int32_t i = 0; i < 12 && !status; ++i) status = mpm_step(w.stepper, 6e-4, NULL);
  a->calls[part] = w.memory.calls - calls;
  w.memory.fail_at = 0;
  a->status[part] = status;
  if (!status || status == MPM_E_NOMEM) status = save(&w, &a->piece[part]);
  a->changed[part] = status != MPM_OK;
  if (world_try_close(&w) || w.memory.held) a->changed[part] = 2;
}

START_TEST(saved_after_a_failed_sort) {
  const world_desc desc = small_world();
  uint64_t hash = 0;
  int64_t resorts = 0;
  attempt all = fresh_attempt();
  planned f = {0};
  do {
    const long long at = f.at;
    const int part = f.part;
    attempt a = fresh_attempt();
    parts_plan plan;
    memset(&plan, 0, sizeof plan);
    a.fail_at[part] = at;
    ck_assert_msg(!parts_run(PARTS, fail_and_save, &a, &plan), "allocation %lld of part %d: %s", at, part,
                  plan.text);
    const void *piece[PARTS];
    int64_t bytes[PARTS];
    for (int32_t r = 0; r < PARTS; ++r) {
      ck_assert_msg(!a.changed[r] && a.status[r] == (at ? MPM_E_NOMEM : MPM_OK),
                    "allocation %lld of part %d, part %d: %s, %d", at, part, r, mpm_status_name(a.status[r]),
                    a.changed[r]);
      piece[r] = a.piece[r].data, bytes[r] = a.piece[r].bytes;
    }
    world w;
    world_open(&w, &desc);
    ck_ok(&w, set_up(&w));
    ck_ok(&w, mpm_state_load_pieces(w.stepper, PARTS, piece, bytes));
    mpm_step_info info = world_info(&w);
    while (info.step < 17) info = world_step(&w, 6e-4);
    if (!at) hash = world_hash(&w), resorts = info.resorts, all = a;
    ck_assert_msg(world_hash(&w) == hash && info.resorts == resorts,
                  "allocation %lld of part %d: another state, %lld sorts, %lld", at, part,
                  (long long)info.resorts, (long long)resorts);
    world_close(&w);
    for (int32_t r = 0; r < PARTS; ++r) free(a.piece[r].data);
  } while (next_fault(&f, INT64_MAX, all.calls));
  ck_assert(all.calls[1] > 5 && resorts > 2);
  tell_faults(&f, "memory");
}
END_TEST

/* ---- one part ------------------------------------------------------------------------------------------ */
START_TEST(one_part_is_told) {
  world w;
  const world_desc desc = small_world();
  world_open(&w, &desc);
  ck_ok(&w, set_up(&w));
  const void *piece[PARTS];
  int64_t bytes[PARTS];
  char path[300];
  uint64_t hash;
  for (int32_t r = 0; r < PARTS; ++r) piece[r] = prepared.later[r].data, bytes[r] = prepared.later[r].bytes;
  ck_refused(&w, mpm_state_load(w.stepper, piece[1], bytes[1]), MPM_E_FORMAT, "mpm_state_load_pieces()");
  FILE *out = fopen(scratch_path("piece.state", path, sizeof path), "wb");
  ck_assert(out && fwrite(piece[1], 1, (size_t)bytes[1], out) == (size_t)bytes[1] && !fclose(out));
  ck_refused(&w, mpm_state_load_file(w.stepper, path), MPM_E_FORMAT, "mpm_state_load_pieces()");
  remove(path);
  ck_refused(&w, mpm_state_load_pieces(w.stepper, 0, NULL, NULL), MPM_E_ARG, "no part gives a piece");
  ck_refused(&w, mpm_state_load_pieces(w.stepper, 2, piece, bytes), MPM_E_ARG,
             "piece 2 of the state is missing");
  ck_ok(&w, mpm_state_load_pieces(w.stepper, PARTS, piece, bytes));
  ck_ok(&w, mpm_state_hash(w.stepper, &hash));
  ck_assert_uint_eq(hash, prepared.hash[0]);
  /* its own state is one piece */
  saved_state own = world_save(&w);
  world_step(&w, 6e-4);
  ck_ok(&w, mpm_state_load_pieces(w.stepper, 1, (const void *[]){own.data}, &own.bytes));
  ck_assert_uint_eq(world_hash(&w), hash);
  ck_refused(&w,
             mpm_state_load_pieces(w.stepper, 2, (const void *[]){own.data, own.data},
                                   (const int64_t[]){own.bytes, own.bytes}),
             MPM_E_ARG, "given twice");
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
  ck_refused(&w, mpm_state_load_pieces(w.stepper, 1, (const void *[]){own.data}, &own.bytes), MPM_E_STATE,
             "a step is under way");
  ck_ok(&w, mpm_step_abort(w.stepper));
  free(own.data);
  world_close(&w);
}
END_TEST

/* ---- files and callbacks ------------------------------------------------------------------------------- */
enum { TO_FILES = 1, TO_CALLBACKS, TO_NOWHERE, REFUSED, TOO_SMALL, LOADS, STAGED, WAYS };

typedef struct taken {
  unsigned char *data;
  int64_t bytes;
  int32_t refuses;
} taken;

static mpm_status take(void *user, const void *data, int64_t bytes) {
  taken *t = user;
  if (t->refuses) return 7;
  t->data = realloc(t->data, (size_t)(t->bytes + bytes));
  memcpy(t->data + t->bytes, data, (size_t)bytes);
  t->bytes += bytes;
  return MPM_OK;
}

static int32_t file_has(const char *path, const saved_state *wanted) {
  FILE *in = fopen(path, "rb");
  if (!in) return 0;
  unsigned char *data = malloc((size_t)wanted->bytes + 1);
  const int32_t same = fread(data, 1, (size_t)wanted->bytes + 1, in) == (size_t)wanted->bytes &&
                       !memcmp(data, wanted->data, (size_t)wanted->bytes);
  fclose(in);
  free(data);
  return same;
}

static void save_in_a_way(int32_t part, const mpm_transport *transport, void *user) {
  attempt *a = user;
  world w;
  saved_state is = {0};
  char name[64], path[300], nowhere[340];
  taken t = {.refuses = a->saves == REFUSED && part == 1};
  mpm_status status = open(&w, transport);
  if (!status) status = steps(&w, 6);
  if (!status) status = save(&w, &is);
  a->changed[part] = status != MPM_OK;
  snprintf(name, sizeof name, "pieces_%d.state", part);
  scratch_path(name, path, sizeof path);
  snprintf(nowhere, sizeof nowhere, "%s/nowhere", path);
  remove(path);
  switch (a->saves) {
  case TO_FILES:
    status = mpm_state_save_file(w.stepper, path);
    a->changed[part] |= !file_has(path, &is);
    break;
  case TO_NOWHERE:
    status = mpm_state_save_file(w.stepper, part == 1 ? nowhere : path);
    a->changed[part] |= file_has(path, &is);
    break;
  case TO_CALLBACKS:
    status = mpm_state_save_to(w.stepper, take, &t);
    a->changed[part] |= t.bytes != is.bytes || memcmp(t.data, is.data, (size_t)is.bytes);
    break;
  case REFUSED:
    status = mpm_state_save_to(w.stepper, take, &t);
    break;
  case TOO_SMALL:
    status = mpm_state_save(w.stepper, is.data, is.bytes - (part == 1 ? 8 : 0));
    break;
  case LOADS:
    status = mpm_state_load(w.stepper, is.data, is.bytes);
    break;
  default:
    a->changed[part] |= mpm_step_begin(w.stepper, 1e-4) != MPM_OK;
    status = mpm_state_size(w.stepper, &is.bytes);
    snprintf(a->text[part], TEXT, "%s", mpm_last_error(w.context));
    a->changed[part] |= mpm_step_abort(w.stepper) != MPM_OK;
    break;
  }
  a->status[part] = status;
  if (a->saves != STAGED) snprintf(a->text[part], TEXT, "%s", status ? mpm_last_error(w.context) : "");
  remove(path);
  free(is.data), free(t.data);
  if (world_try_close(&w) || w.memory.held) a->changed[part] = 2;
}

START_TEST(saved_in_all_ways) {
  static const struct {
    mpm_status status;
    const char *words;
  } wanted[WAYS] = {[TO_FILES] = {MPM_OK, ""},
                    [TO_CALLBACKS] = {MPM_OK, ""},
                    [TO_NOWHERE] = {MPM_E_IO, "cannot write"},
                    [REFUSED] = {MPM_E_CALLBACK, "returned 7"},
                    [TOO_SMALL] = {MPM_E_ARG, "capacity is"},
                    [LOADS] = {MPM_E_UNSUPPORTED, "mpm_state_load_pieces()"},
                    [STAGED] = {MPM_E_STATE, "a step is under way"}};
  for (int32_t way = TO_FILES; way < WAYS; ++way) {
    attempt a = fresh_attempt();
    parts_plan plan;
    memset(&plan, 0, sizeof plan);
    a.saves = way;
    ck_assert_msg(!parts_run(PARTS, save_in_a_way, &a, &plan), "%d: %s", way, plan.text);
    for (int32_t r = 0; r < PARTS; ++r)
      ck_assert_msg(
          a.status[r] == wanted[way].status && strstr(a.text[r], wanted[way].words) && !a.changed[r],
          "way %d, part %d: %s: %s, %d", way, r, mpm_status_name(a.status[r]), a.text[r], a.changed[r]);
  }
}
END_TEST

TCase *shared_pieces_case(Suite *suite) {
  TCase *pieces = tcase_create("pieces");
  tcase_set_timeout(pieces, 300);
  tcase_add_checked_fixture(pieces, make_pieces, drop_pieces);
  tcase_add_test(pieces, what_is_no_state);
  tcase_add_test(pieces, damaged_pieces);
  tcase_add_test(pieces, unlike_calls);
  tcase_add_test(pieces, one_part_is_told);
  tcase_add_test(pieces, saved_in_all_ways);
  TCase *faults = faults_case(suite, "faults", 0);
  tcase_add_checked_fixture(faults, make_pieces, drop_pieces);
  tcase_add_test(faults, memory_runs_out);
  tcase_add_test(faults, transport_fails);
  tcase_add_test(faults, saved_after_a_failed_sort);
  return pieces;
}
