/* The host's solver in several parts. It gathers the rows of all parts, puts them into an order that does not
 * depend on the parts, and solves there: whatever comes of a scene then has the bits of one part, if each
 * part lends the rows that one part would have. */
#include "implicit.h"
#include "shared.h"

#include <pthread.h>

/* ---- what parts lend ----------------------------------------------------------------------------------- */
/* What goes wrong with the solver on one part, in its call number `at`. */
enum { NOTHING, RETURNS, IS_NAN, IS_WRONG, COUNTS_BADLY, APPLIES_NULL, LEAVES, OLD_STRUCT };
typedef struct fault {
  int32_t what, part, at;
  mpm_status returns; /* of RETURNS on `part`; on the part after it it is one more than twice that */
} fault;

typedef struct lent {
  mpm_operator_info info;
  const int64_t *start;
  const int32_t *column;
  const double *value, *rhs;
  double *solution, *y; /* y: the matrix times the right-hand side */
} lent;

/* A row of all parts by what does not depend on them. */
typedef struct place {
  int64_t node, number;
  int32_t component, part;
  int64_t local;
} place;

/* All parts write what they lend, and the first one solves. One problem is played at a time. */
static struct {
  lent of[MOST_PARTS];
  fault fault;
  int32_t wrong; /* what the first part has found */
  int64_t iterations;
} common;

/* Where the transport fails, the others keep what they lend until the first part has read it. */
static struct {
  pthread_mutex_t lock;
  pthread_cond_t over;
  int32_t reads;
} first_part = {.lock = PTHREAD_MUTEX_INITIALIZER, .over = PTHREAD_COND_INITIALIZER};

static void set_reading(int32_t reads) {
  pthread_mutex_lock(&first_part.lock);
  first_part.reads = reads;
  pthread_cond_broadcast(&first_part.over);
  pthread_mutex_unlock(&first_part.lock);
}

static void wait_for_reading(void) {
  pthread_mutex_lock(&first_part.lock);
  while (first_part.reads) pthread_cond_wait(&first_part.over, &first_part.lock);
  pthread_mutex_unlock(&first_part.lock);
}

/* The solver of a part. */
typedef struct member {
  const mpm_transport *transport; /* NULL: there is one part */
  int32_t part, parts, calls, fails;
  int64_t pattern_id, patterns;
} member;

/* All parts come here, and learn the largest number. */
static mpm_status meet(const member *m, int64_t number) {
  if (m->transport && m->transport->reduce(m->transport->user, MPM_REDUCE_MAX, 1, &number)) return -1;
  return (mpm_status)number;
}

/* ---- the system of all parts --------------------------------------------------------------------------- */
typedef struct entry {
  int64_t column;
  double value;
} entry;

typedef struct whole {
  int64_t n;
  place *row;     /* [n] by node and component */
  int64_t *at;    /* [n] by number: its place among these */
  int64_t *start; /* [n + 1] */
  entry *entry;   /* columns are places, and ascend in a row */
  double *diagonal, *rhs, *x;
} whole;

static int by_node(const void *a, const void *b) {
  const place *x = a, *y = b;
  if (x->node != y->node) return x->node < y->node ? -1 : 1;
  return x->component - y->component;
}

static int by_column(const void *a, const void *b) {
  const int64_t x = ((const entry *)a)->column, y = ((const entry *)b)->column;
  return (x > y) - (x < y);
}

/* Numbers must be a permutation, part by part; what parts tell of a row of another one must be what its owner
 * tells. Returns 0, or which of these is not so. */
static int32_t number_rows(whole *w, int32_t parts) {
  int64_t n = 0;
  for (int32_t r = 0; r < parts; ++r) {
    const mpm_operator_info *i = &common.of[r].info, *first = &common.of[0].info;
    if (i->first_row != n || i->all_rows != w->n || i->owned_rows > i->rows || i->ld < i->rows) return 11;
    if (i->pattern_id != first->pattern_id || i->symmetric != first->symmetric) return 12;
    for (int64_t k = 0; k < i->owned_rows; ++k, ++n) {
      if (i->number[k] != n || n >= w->n) return 13;
      w->row[n] = (place){i->node[k], n, i->component[k], r, k};
    }
  }
  if (n != w->n) return 14;
  for (int32_t r = 0; r < parts; ++r) {
    const mpm_operator_info *i = &common.of[r].info;
    for (int64_t k = i->owned_rows; k < i->rows; ++k) {
      if (i->number[k] < 0 || i->number[k] >= n) return 15;
      const place *of = &w->row[i->number[k]];
      const lent *owner = &common.of[of->part];
      if (of->part == r || of->node != i->node[k] || of->component != i->component[k]) return 16;
      for (int32_t c = 0; c < i->block; ++c)
        if (i->position[c * i->ld + k] != owner->info.position[c * owner->info.ld + of->local]) return 17;
    }
  }
  qsort(w->row, (size_t)n, sizeof *w->row, by_node);
  for (int64_t k = 0; k < n; ++k) {
    if (k && !by_node(&w->row[k - 1], &w->row[k])) return 18;
    w->at[w->row[k].number] = k;
  }
  return 0;
}

/* Takes the rows, with columns in the order of places. */
static int32_t take_rows(whole *w) {
  int64_t count = 0;
  for (int64_t k = 0; k < w->n; ++k) {
    const place *row = &w->row[k];
    const lent *of = &common.of[row->part];
    const int64_t begin = of->start[row->local], end = of->start[row->local + 1];
    w->start[k] = count;
    for (int64_t e = begin; e < end; ++e) {
      if (of->column[e] < 0 || of->column[e] >= of->info.rows) return 21;
      if (e > begin && of->column[e] <= of->column[e - 1]) return 22;
      w->entry[count + e - begin] = (entry){w->at[of->info.number[of->column[e]]], of->value[e]};
      if (w->entry[count + e - begin].column == k) w->diagonal[k] = of->value[e];
    }
    qsort(w->entry + count, (size_t)(end - begin), sizeof *w->entry, by_column);
    count += end - begin;
    w->rhs[k] = of->rhs[row->local];
    w->x[k] = of->solution[row->local];
  }
  w->start[w->n] = count;
  return 0;
}

static void multiply(const whole *w, const double *x, double *y) {
  for (int64_t k = 0; k < w->n; ++k) {
    y[k] = 0.0;
    for (int64_t e = w->start[k]; e < w->start[k + 1]; ++e) y[k] += w->entry[e].value * x[w->entry[e].column];
  }
}

static double dot(int64_t n, const double *a, const double *b) {
  double sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

/* The stabilised method of biconjugate gradients, scaled by the diagonal: van der Vorst 1992. */
static int32_t bicgstab(const whole *w, double tolerance, int64_t *iterations) {
  enum { VECTORS = 8, MOST = 20000 };
  const int64_t n = w->n;
  double *v = calloc((size_t)n + 1, VECTORS * sizeof *v), *vector[VECTORS];
  for (int32_t i = 0; i < VECTORS; ++i) vector[i] = v + i * n;
  double *r = vector[0], *shadow = vector[1], *p = vector[2], *q = vector[3], *s = vector[4], *t = vector[5];
  double *ready = vector[6], *other = vector[7], rho = 1.0, alpha = 1.0, omega = 1.0;
  const double wanted = tolerance * sqrt(dot(n, w->rhs, w->rhs));
  multiply(w, w->x, r);
  for (int64_t i = 0; i < n; ++i) shadow[i] = r[i] = w->rhs[i] - r[i];
  for (*iterations = 0; sqrt(dot(n, r, r)) > wanted && *iterations < MOST; ++*iterations) {
    const double next = dot(n, shadow, r), beta = next / rho * (alpha / omega);
    for (int64_t i = 0; i < n; ++i)
      p[i] = r[i] + beta * (p[i] - omega * q[i]), ready[i] = p[i] / w->diagonal[i];
    multiply(w, ready, q);
    rho = next;
    alpha = rho / dot(n, shadow, q);
    for (int64_t i = 0; i < n; ++i) s[i] = r[i] - alpha * q[i], other[i] = s[i] / w->diagonal[i];
    multiply(w, other, t);
    omega = dot(n, t, s) / dot(n, t, t);
    for (int64_t i = 0; i < n; ++i) {
      w->x[i] += alpha * ready[i] + omega * other[i];
      r[i] = s[i] - omega * t[i];
    }
  }
  free(v);
  return *iterations == MOST ? 31 : 0;
}

/* The products that parts have made of the right-hand side are those of the whole matrix. */
static int32_t compare_products(const whole *w) {
  double *y = calloc((size_t)w->n + 1, sizeof *y), most = 0.0;
  int32_t wrong = 0;
  multiply(w, w->rhs, y);
  for (int64_t k = 0; k < w->n; ++k) most = fmax(most, fabs(y[k]));
  for (int64_t k = 0; k < w->n; ++k)
    if (!(fabs(common.of[w->row[k].part].y[w->row[k].local] - y[k]) <= 1e-12 * most)) wrong = 41;
  free(y);
  return wrong;
}

static int32_t solve_all(int32_t parts, double tolerance) {
  whole w = {.n = common.of[0].info.all_rows};
  int64_t nonzeros = 0;
  for (int32_t r = 0; r < parts; ++r) nonzeros += common.of[r].info.nonzeros;
  w.row = calloc((size_t)w.n + 1, sizeof *w.row);
  w.at = calloc((size_t)w.n + 1, sizeof *w.at);
  w.start = calloc((size_t)w.n + 1, sizeof *w.start);
  w.entry = calloc((size_t)nonzeros + 1, sizeof *w.entry);
  w.diagonal = calloc((size_t)w.n + 1, 3 * sizeof *w.diagonal);
  w.rhs = w.diagonal + w.n;
  w.x = w.rhs + w.n;
  int32_t wrong = number_rows(&w, parts);
  if (!wrong) wrong = take_rows(&w);
  if (!wrong && w.start[w.n] != nonzeros) wrong = 23;
  if (!wrong) wrong = compare_products(&w);
  if (!wrong) wrong = bicgstab(&w, tolerance, &common.iterations);
  for (int64_t k = 0; k < w.n && !wrong; ++k) common.of[w.row[k].part].solution[w.row[k].local] = w.x[k];
  free(w.row), free(w.at), free(w.start), free(w.entry), free(w.diagonal);
  return wrong;
}

/* ---- the solver ---------------------------------------------------------------------------------------- */
/* Returns what is wrong with what this part is lent. */
enum { UNKNOWN = 1 };
static int32_t borrow(member *m, const mpm_operator *matrix, lent *mine) {
  mpm_operator_info *info = &mine->info;
  memset(info, 0, sizeof *info);
  info->struct_size = sizeof *info;
  if (mpm_operator_get_info(matrix, info)) return UNKNOWN;
  if (mpm_operator_csr(matrix, &mine->start, &mine->column, &mine->value)) return 2;
  if (mine->start[info->owned_rows] != info->nonzeros || mine->start[info->rows] != info->nonzeros) return 3;
  if (m->parts == 1 && (info->first_row || info->owned_rows != info->rows || info->all_rows != info->rows))
    return 4;
  if (info->pattern_id < 0 || info->pattern_id >= INT64_C(1) << 53) return 5;
  m->patterns += info->pattern_id != m->pattern_id;
  m->pattern_id = info->pattern_id;
  return 0;
}

/* A host that knows nothing of parts is told so where there are several. */
static int32_t try_old_struct(const member *m, const mpm_operator *matrix) {
  mpm_operator_info info;
  memset(&info, 0x55, sizeof info);
  info.struct_size = 72;
  const mpm_status status = mpm_operator_get_info(matrix, &info);
  if (m->parts > 1) return status == MPM_E_UNSUPPORTED ? 0 : 6;
  return !status && info.struct_size == 72 && info.rows > 0 && info.all_rows == 0x5555555555555555 ? 0 : 7;
}

static mpm_status solve(void *user, const mpm_operator *matrix, const double *rhs, double *solution,
                        double tolerance, int64_t *iterations) {
  member *m = user;
  lent *mine = &common.of[m->part];
  const fault *f = &common.fault;
  const int32_t here = f->what && ++m->calls == f->at ? m->part - f->part : -1, fails = here == 0;
  mine->rhs = rhs;
  mine->solution = solution;
  if (fails && f->what == LEAVES) return 7; /* and the others go on */
  int32_t wrong = borrow(m, matrix, mine);
  if (wrong == UNKNOWN) return -UNKNOWN;
  if (!wrong && f->what == OLD_STRUCT) wrong = try_old_struct(m, matrix);
  mine->y = calloc((size_t)mine->info.owned_rows + 1, sizeof *mine->y);
  mpm_status status = mpm_operator_apply(matrix, fails && f->what == APPLIES_NULL ? NULL : rhs, mine->y);
  if (status) {
    free(mine->y);
    return -100 + status;
  }
  if (!m->part) set_reading(1); /* before others may know that it comes */
  status = meet(m, wrong);
  if (!m->part && !status) common.wrong = solve_all(m->parts, tolerance);
  if (!m->part) set_reading(0);
  if (!status) status = meet(m, m->part ? 0 : common.wrong);
  if (status) wait_for_reading();
  free(mine->y);
  *iterations = m->part ? 0 : common.iterations; /* the largest counts */
  if (status) return status > 0 ? -status : status;
  if (f->what == RETURNS && here == 1) return 2 * f->returns + 1;
  if (!fails) return MPM_OK;
  for (int64_t r = 0; r < mine->info.owned_rows && f->what == IS_WRONG; ++r) solution[r] += 1.0;
  if (f->what == IS_NAN) solution[mine->info.owned_rows / 2] = NOT_A_NUMBER;
  if (f->what == COUNTS_BADLY) *iterations = -3;
  return f->what == RETURNS ? f->returns : MPM_OK;
}

static member member_of(const world *w) {
  member m = {.transport = w->desc.context.transport, .parts = 1, .pattern_id = -1};
  mpm_context_part(w->context, &m.part, &m.parts);
  return m;
}

/* ---- all bits are those of one part -------------------------------------------------------------------- */
static mpm_status run_by_host(world *w, const scene *is, outcome *found) {
  member m = member_of(w);
  mpm_status status = mpm_stepper_set_linear_solver(w->stepper, solve, &m);
  for (int32_t i = 0; i < (w->dim < 3 ? 4 : 2) && !status; ++i)
    status = mpm_step(w->stepper, (0.3 + 0.1 * (i % 2)) * is->desc.grid.spacing[0], &w->info);
  const mpm_status dropped = mpm_stepper_set_linear_solver(w->stepper, NULL, NULL);
  found->seen[0] = (double)m.patterns;
  return status ? status : dropped;
}

static const mpm_param flows[] = {{"density", 1e3}, {"E", 1e5},   {"nu", 0.3},
                                  {"phi", 30.0},    {"psi", 0.0}, {"cohesion", 4e3}};

/* The last two are symmetric. */
static world_law law_of(int32_t i) {
  static const char *const model[] = {"j2", "drucker_prager", "linear_elastic", "neo_hookean",
                                      "herschel_bulkley"};
  world_law law = {.model = model[i % 5], .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e3};
  if (i % 5 == 1) law.params = flows, law.param_count = 6;
  return law;
}

static scene host_scene(int32_t dim, const basis_option *basis, int32_t quasi_static, int32_t law) {
  scene is = implicit_scene(dim, basis, quasi_static);
  is.desc.stepper.linear_solver = MPM_SOLVER_HOST;
  is.desc.stepper.linear_tolerance = 1e-8;
  is.desc.law = law_of(law);
  is.run = run_by_host;
  return is;
}

enum { TABLE = 24 };
START_TEST(table) {
  static const int32_t parts[] = {2, 3, 5, 1};
  const int32_t dim = 1 + (_i + _i / 3) % 3, quasi_static = _i / 9 % 2;
  const basis_option *basis = implicit_basis(_i / 2 % IMPLICIT_BASES);
  scene is = host_scene(dim, basis, quasi_static, _i + _i / 5);
  char name[200];
  if (basis->basis == MPM_CPGIMP) is.desc.law = law_of(3);
  is.desc.grid.periodic[0] = dim > 1 && _i % 4 == 1;
  is.desc.context.concurrency = 1 + _i / 2 % 2;
  is.desc.stepper.locking_remedy = dim > 1 && _i % 4 > 1 ? MPM_LOCKING_CELL_AVERAGE : MPM_LOCKING_NONE;
  is.speed += _i % 8;
  memset(&common, 0, sizeof common);
  snprintf(name, sizeof name, "%d: %d-D %s %s %s, options %d", _i, dim, basis->name, is.desc.law.model,
           quasi_static ? "quasi-static" : "Newmark", (int)is.speed);
  check_made(&is, name, parts[(_i + _i / 4) % 4]);
}
END_TEST

/* ---- the library's conjugate gradients come to the same ---------- */
START_TEST(as_conjugate_gradients) {
  scene by_host = host_scene(2, implicit_basis(1), _i, 3), by_cg = implicit_scene(2, implicit_basis(1), _i);
  parts_plan plan;
  memset(&common, 0, sizeof common);
  memset(&plan, 0, sizeof plan);
  by_host.desc.stepper.linear_tolerance = by_cg.desc.stepper.linear_tolerance = 1e-10;
  by_cg.desc.law = law_of(3);
  live(0, NULL, &by_cg);
  ck_assert_msg(!parts_run(3, live, &by_host, &plan), "%s", plan.text);
  const mpm_step_info *wanted = &by_cg.found[0].info;
  for (int32_t r = 0; r < 3; ++r) {
    const mpm_step_info *is = &by_host.found[r].info;
    ck_assert_msg(!by_host.found[r].status, "part %d: %s", r, by_host.found[r].text);
    ck_assert_int_eq(is->linear_solver, MPM_SOLVER_HOST);
    ck_assert_int_eq(is->newton_iterations, wanted->newton_iterations);
    ck_within("strain energy", is->strain_energy, wanted->strain_energy, 1e-8 * wanted->strain_energy);
    ck_within("residual", is->residual, wanted->residual, 1e-8);
  }
}
END_TEST

/* ---- what goes wrong on one part ----------------------------------------------------------------------- */
/* A step that goes wrong, and then others; seen: what is asked for of the first. */
static mpm_status fail_and_go_on(world *w, const scene *is, outcome *found) {
  const double dt = 0.3 * is->desc.grid.spacing[0];
  member m = member_of(w);
  uint64_t before, after;
  mpm_status status = mpm_stepper_set_linear_solver(w->stepper, solve, &m);
  if (!status) status = mpm_state_hash(w->stepper, &before);
  if (status) return status;
  found->failed.struct_size = sizeof found->failed;
  const mpm_status failed = mpm_step(w->stepper, dt, &found->failed);
  snprintf(found->text, sizeof found->text, "%s", mpm_last_error(w->context));
  found->seen[0] = failed;
  found->seen[1] = found->failed.callback_status;
  if ((status = mpm_state_hash(w->stepper, &after))) return status;
  if (before != after) return MPM_E_INTERNAL;
  for (int32_t i = 0; i < 2 && !status; ++i) status = mpm_step(w->stepper, dt, &w->info);
  const mpm_status dropped = mpm_stepper_set_linear_solver(w->stepper, NULL, NULL);
  return status ? status : dropped;
}

static const struct {
  fault fault;
  mpm_status status, returned;
  const char *words;
} faults[] = {
    {{RETURNS, 1, 1, 5}, MPM_CUT_DT, 5, "the linear solver returned 5"},
    {{RETURNS, 2, 2, 3}, MPM_CUT_DT, 3, "the linear solver returned 3"},
    {{RETURNS, 0, 1, -4}, MPM_E_CALLBACK, -4, "the linear solver returned -4"},
    {{RETURNS, 1, 1, -1}, MPM_E_CALLBACK, -1, "the linear solver returned -1"},
    {{IS_NAN, 1, 1, 0}, MPM_NONFINITE, 0, "the solution of the linear solver is not finite at node"},
    {{IS_WRONG, 2, 1, 0}, MPM_NOT_CONVERGED, 0, "the linear solver left a residual of"},
    {{COUNTS_BADLY, 0, 1, 0}, MPM_E_CALLBACK, 0, "counted -3 iterations"},
    {{APPLIES_NULL, 2, 1, 0}, MPM_E_CALLBACK, -100 + MPM_E_ARG, "the linear solver returned -101"},
    {{LEAVES, 1, 1, 0}, MPM_E_CALLBACK, -100 + MPM_E_STATE, "the linear solver returned -103"}};
enum { FAULTS = sizeof faults / sizeof *faults };

START_TEST(fails_on_one_part) {
  scene is = host_scene(2, implicit_basis(1), 0, 3), one;
  memset(&common, 0, sizeof common);
  common.fault = faults[_i].fault;
  is.run = fail_and_go_on;
  one = is;
  check_parts(&is, 3);
  common.fault.part = 0;
  live(0, NULL, &one);
  ck_assert_msg(!one.found[0].status, "%s", one.found[0].text);
  for (int32_t r = 0; r < 3; ++r) {
    const outcome *of = &is.found[r];
    ck_assert_msg(of->seen[0] == faults[_i].status && of->seen[1] == faults[_i].returned,
                  "fault %d, part %d: %d, %d: %s", _i, r, (int)of->seen[0], (int)of->seen[1], of->text);
    ck_assert_msg(strstr(of->text, faults[_i].words) != NULL, "fault %d, part %d: %s", _i, r, of->text);
    ck_assert_int_eq(of->failed.cause, faults[_i].status);
    ck_assert_int_eq(of->failed.node, is.found[0].failed.node);
    ck_assert_uint_eq(of->hash, one.found[0].hash); /* of what follows */
  }
  const int32_t has_place = faults[_i].status == MPM_NONFINITE || faults[_i].status == MPM_NOT_CONVERGED;
  ck_assert_int_eq(is.found[0].failed.node >= 0, has_place);
}
END_TEST

/* ---- what parts must have alike ------------------------------------------------------------------------ */
/* One part has no solver; then none has; then all have one that an old host would write. */
static mpm_status set_up_unlike(world *w, const scene *is, outcome *found) {
  const double dt = 0.3 * is->desc.grid.spacing[0];
  member m = member_of(w);
  (void)found;
  mpm_status status = m.part == 1 ? MPM_OK : mpm_stepper_set_linear_solver(w->stepper, solve, &m);
  if (status) return status;
  if (m.parts > 1 && (mpm_step(w->stepper, dt, &w->info) != MPM_E_STATE ||
                      !strstr(mpm_last_error(w->context), "linear solver on all")))
    return MPM_E_INTERNAL;
  if ((status = mpm_stepper_set_linear_solver(w->stepper, NULL, NULL))) return status;
  if (mpm_step(w->stepper, dt, &w->info) != MPM_E_STATE ||
      !strstr(mpm_last_error(w->context), "mpm_stepper_set_linear_solver"))
    return MPM_E_INTERNAL;
  if (!(status = mpm_stepper_set_linear_solver(w->stepper, solve, &m)))
    status = mpm_step(w->stepper, dt, &w->info);
  const mpm_status dropped = mpm_stepper_set_linear_solver(w->stepper, NULL, NULL);
  return status ? status : dropped;
}

START_TEST(unlike_parts) {
  scene is = host_scene(2, implicit_basis(1), 0, 3);
  memset(&common, 0, sizeof common);
  common.fault.what = OLD_STRUCT;
  is.run = set_up_unlike;
  check_parts(&is, 3);
  live(0, NULL, &is);
  ck_assert_msg(!is.found[0].status, "%s", is.found[0].text);
}
END_TEST

START_TEST(transport_fails) {
  const scene is = host_scene(2, implicit_basis(0), 0, 0);
  memset(&common, 0, sizeof common);
  check_lost_transport(&is, 2, 300);
}
END_TEST

/* ---- memory -------------------------------------------------------------------------------------------- */
/* Memory that fails in mpm_operator_csr() is a failure of the solver, and others of the step. */
static void live_hungry(int32_t part, const mpm_transport *transport, void *user) {
  hungry *h = user;
  const double dt = 0.3 * h->is.desc.grid.spacing[0];
  world w;
  memset(&w, 0, sizeof w);
  w.desc = h->is.desc;
  w.desc.context.transport = transport;
  mpm_status status = world_try_open(&w);
  member m = member_of(&w);
  if (!status) status = mpm_stepper_set_linear_solver(w.stepper, solve, &m);
  if (!status) status = h->is.set_up(&w, &h->is);
  const int64_t opened = w.memory.calls;
  begin_hunger(h, &w, part, opened);
  for (int32_t i = 0; i < 2 && !status; ++i) {
    status = mpm_step(w.stepper, dt, NULL);
    if (status != MPM_E_NOMEM && status != MPM_E_CALLBACK) continue;
    if (!h->failed[part]++) --i, status = MPM_OK;
  }
  end_hunger(h, &w, part, opened);
  if (!status) status = mpm_state_hash(w.stepper, &h->is.found[part].hash);
  h->is.found[part].status = status;
  world_try_close(&w);
  h->memory[part] = w.memory;
}

START_TEST(memory_runs_out) {
  static hungry h;
  memset(&h, 0, sizeof h);
  memset(&common, 0, sizeof common);
  h.is = host_scene(2, implicit_basis(0), 0, 0);
  check_hunger(&h, live_hungry);
}
END_TEST

Suite *shared_host_solver_suite(void) {
  Suite *suite = suite_create("shared_host_solver");
  TCase *all = tcase_create("bits");
  tcase_set_timeout(all, 240);
  tcase_add_loop_test(all, as_conjugate_gradients, 0, 2);
  TCase *wide = wide_case(suite, "more bits");
  add_table(all, wide, table, TABLE);
  suite_add_tcase(suite, all);
  TCase *failures = tcase_create("failures");
  tcase_set_timeout(failures, 240);
  tcase_add_loop_test(failures, fails_on_one_part, 0, FAULTS);
  tcase_add_test(failures, unlike_parts);
  suite_add_tcase(suite, failures);
  TCase *lost = faults_case(suite, "faults", 0);
  tcase_add_test(lost, transport_fails);
  tcase_add_test(lost, memory_runs_out);
  return suite;
}
