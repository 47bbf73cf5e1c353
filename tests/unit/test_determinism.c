/* Results do not depend on threads, executor or order of filling, for every method; instruction sets agree
 * to round-off. Bodies of many blocks that move through them, lose particles and are sorted anew. With
 * MPM_FULL=1 in the environment the list is all that the library offers, in 3-D with walls and a periodic
 * axis in turn; without, a sample of it. Each scene runs on every count of threads and on each instruction
 * set. */
#include "body.h"
#include "tables.h"

enum { REMOVED_AT = 6, COMPARED_AT = 10 };

/* Positions, velocities and stresses of both sets; the least share of a node until then, and the rounding of
 * positions at the end of the longest axis, in cells. */
typedef struct sample {
  double share, rounding;
  int64_t n[2];
  double *value[2][3];
} sample;
static const struct {
  const char *name;
  int32_t components; /* 0: dim */
} sampled[3] = {{"position", 0}, {"velocity", 0}, {"stress", 6}};

static int32_t components_of(int32_t dim, int32_t f) {
  return sampled[f].components ? sampled[f].components : dim;
}

static sample take_sample(const world *r, double share) {
  sample s = {.share = share};
  for (int32_t k = 0; k < r->dim; ++k) s.rounding = fmax(s.rounding, 0x1p-53 * (double)r->desc.grid.cells[k]);
  for (int32_t m = 0; m < 2; ++m) {
    s.n[m] = mpm_particles_count(r->set[m]);
    for (int32_t f = 0; f < 3; ++f)
      s.value[m][f] = fetch(r, r->set[m], sampled[f].name, components_of(r->dim, f));
  }
  return s;
}

static void drop_sample(sample *s) {
  for (int32_t m = 0; m < 2; ++m)
    for (int32_t f = 0; f < 3; ++f) free(s->value[m][f]);
}

/* Instruction sets round otherwise, by 1e-12 in the end. On the linear basis no kernel magnifies that, but
 * the method does where a particle hardly touches a node: a share eta of another node's mass has the rounding
 * of a position, in cells, by 1 / eta, and its force over its mass as well (theory, 7.1). What is more than
 * 1e-12 is up to 5e-7 of that (MPM_SHOW=1). */
static double tolerance_of(const sample *s) {
  return fmax(1e-12, 1e-6 * s->rounding / (s->share * s->share));
}

static void ck_agree(const body_desc *of, const sample *a, const sample *b) {
  const int32_t dim = of->dim;
  const double tolerance = tolerance_of(a);
  double apart = 0.0;
  for (int32_t m = 0; m < 2; ++m) {
    ck_assert_int_eq(a->n[m], b->n[m]);
    for (int32_t f = 0; f < 3; ++f) {
      const int64_t n = a->n[m] * components_of(dim, f);
      const double scale = largest(n, a->value[m][f]);
      ck_assert_double_gt(scale, 0.0);
      for (int64_t i = 0; i < n; ++i) {
        ck_within(sampled[f].name, b->value[m][f][i], a->value[m][f][i], tolerance * scale);
        apart = fmax(apart, fabs(b->value[m][f][i] - a->value[m][f][i]) / scale);
      }
    }
  }
  show("%d-D, %s: %.2g apart, %.2g of rounding over the square of the least share, %.2g\n", (int)dim,
       of->method.name, apart, apart * a->share * a->share / a->rounding, a->share);
}

static void remove_some(world *r) {
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r->set[m]);
    int64_t *ids = fetch_ids(r, r->set[m]), some = 0;
    for (int64_t i = 0; i < n; ++i)
      if (ids[i] % 13 == 4) ids[some++] = ids[i];
    ck_assert_int_gt(some, 3);
    ck_ok(r, mpm_particles_remove(r->set[m], some, ids));
    free(ids);
  }
}

/* Returns the least mass of a node as a share of that of the heaviest one beside it, where that is more than
 * the share with which the node would be led (theory, 7.1). Nodes a period apart are one. */
static double least_share(world *w) {
  const mpm_grid_desc *grid = &w->desc.grid;
  int64_t n, nodes[3] = {1, 1, 1};
  for (int32_t k = 0; k < w->dim; ++k) nodes[k] = grid->cells[k] + !grid->periodic[k];
  const int64_t all = nodes[0] * nodes[1] * nodes[2];
  int64_t *index = fetch_node_indices(w, &n);
  double *mass = fetch_nodes(w, "mass", &n), *at = calloc((size_t)all, sizeof *at), least = 1.0;
  for (int64_t i = 0; i < n; ++i) {
    int64_t place = 0;
    for (int32_t k = w->dim; k-- > 0;) place = place * nodes[k] + index[k * n + i] % nodes[k];
    at[place] += mass[i];
  }
  for (int64_t i = 0; i < 27 * all; ++i) {
    const int64_t of = i / 27, by[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1};
    int64_t near = 0, stride = 1, inside = at[of] > 0.0;
    for (int32_t k = 0; k < 3; ++k) {
      const int64_t to = of / stride % nodes[k] + by[k], period = grid->periodic[k] ? nodes[k] : 0;
      inside = inside && (period || (to >= 0 && to < nodes[k]));
      near += stride * (period ? (to + period) % period : to);
      stride *= nodes[k];
    }
    if (inside && at[of] > 1e-5 * at[near]) least = fmin(least, at[of] / at[near]);
  }
  free(index), free(mass), free(at);
  return least;
}

/* Light nodes can end a run of the linear basis with so few particles: then the state that is left is the end
 * of the story, and 0 is returned. With share it becomes the least of a node. */
static int32_t go_on(world *r, int32_t steps, double *share) {
  if (r->desc.body.method.basis != MPM_LINEAR) {
    world_steps(r, steps);
    return 1;
  }
  for (int32_t i = 0; i < steps; ++i) {
    const mpm_status status = mpm_step(r->stepper, BODY_DT, &r->info);
    if (status == MPM_INVERTED) return 0;
    ck_ok(r, status);
    if (share) *share = fmin(*share, least_share(r));
  }
  return 1;
}

/* The whole story of one run; at: receives the fields after COMPARED_AT steps, or NULL. */
static uint64_t tell(const body_desc *options, sample *at) {
  world r;
  body_open(&r, options);
  double share = 1.0, *const shares = at ? &share : NULL;
  int32_t lasts = go_on(&r, REMOVED_AT, shares);
  if (lasts) {
    ck_assert_int_ge(world_blocks(&r), 27);
    remove_some(&r);
    lasts = go_on(&r, COMPARED_AT - REMOVED_AT, shares);
  }
  if (at) *at = take_sample(&r, share);
  lasts = lasts && go_on(&r, options->dim == 2 ? 10 : 14, NULL); /* far enough for three sorts more */
  if (lasts) {
    ck_assert_int_ge(r.info.resorts, 4); /* the first sort is one of them */
    if (options->periodic)
      ck_assert_int_eq(r.info.removed, 0);
    else
      ck_assert_int_gt(r.info.removed, 0);
    ck_assert(isfinite(r.info.strain_energy) && r.info.strain_energy > 0.0);
  }
  const uint64_t hash = world_hash(&r);
  world_close(&r);
  return hash;
}

static const int32_t threads[] = {1, 2, 3, 4, 7};
enum { COUNTS = sizeof threads / sizeof *threads };

static void ck_same(body_desc o, int32_t concurrency, int32_t random_order, uint64_t alone) {
  o.concurrency = concurrency;
  o.random_order = random_order;
  ck_assert_msg(tell(&o, NULL) == alone, "%d threads%s give another hash than one", (int)concurrency,
                random_order ? ", tasks in another order," : "");
}

/* One instruction set on one thread and, by an executor that takes tasks at random, on most; with care on
 * each count, every other one by the pool, which the next scene has the other way round. */
static void one_isa(body_desc o, int32_t care, int32_t turn, sample *at) {
  const uint64_t alone = tell(&o, at);
  for (int32_t i = care ? 1 : COUNTS - 1; i < COUNTS; ++i)
    ck_same(o, threads[i], !care || (i + turn) % 2, alone);
  if (!care) return;
  o.shuffled = 1;
  o.concurrency = 2;
  ck_assert_msg(tell(&o, NULL) == alone, "another order of filling gives another hash");
}

/* Whether the library takes the combination; what fails otherwise than by a refusal will fail in its run. */
static int32_t offers(int32_t dim, int32_t basis, int32_t boundary, int32_t scheme, int32_t transfer) {
  world w = {.desc = world_default(dim, 8, 1.0)};
  w.desc.grid.basis = basis;
  w.desc.grid.boundary_basis = boundary;
  w.desc.stepper.scheme = scheme;
  w.desc.stepper.transfer = transfer;
  const mpm_status status = world_try_open(&w);
  world_close(&w);
  return status != MPM_E_UNSUPPORTED && status != MPM_E_ARG;
}

static int32_t full;
static body_desc list[3 * (4 * BASES * SCHEMES * TRANSFERS + PLAIN)];
static int32_t listed;

/* With gravity, walls and callbacks; the remedy, positions of second order and staggering have no part in how
 * work is cut and stay away. */
static int32_t list_method(int32_t dim, const basis_option *b, const scheme_option *s,
                           const transfer_option *t, int32_t periodic) {
  if (t->transfer == MPM_APIC_MLS && !fits_mls(b)) return 0;
  body_desc o = {.dim = dim, .large = 1, .periodic = periodic, .method = method_of(b, s, t)};
  o.method.smoothing = 0.0; /* uGIMP has the default here */
  if (t->flip <= 0.0) o.method.flip = 0.05;
  list[listed++] = o;
  return 1;
}

/* Along walls and with a periodic axis; a sample has each basis with some schemes and transfers in turn,
 * which other dimensions and bases pair otherwise. */
static void list_methods(int32_t dim) {
  enum { EACH = 3 };
  _Static_assert(TRANSFERS % 2, "a stride of 4 reaches every transfer: with an even number take another");
  _Static_assert(SCHEMES * TRANSFERS % 2, "a basis has as many scenes with walls as the next one has not");
  for (int32_t i = 0; i < BASES * SCHEMES * TRANSFERS && full; ++i)
    for (int32_t periodic = 0; periodic < 2; ++periodic)
      if (dim < 3 || periodic == i % 2)
        list_method(dim, &basis_options[i / TRANSFERS / SCHEMES], &scheme_options[i / TRANSFERS % SCHEMES],
                    &transfer_options[i % TRANSFERS], periodic);
  for (int32_t b = 0; b < BASES && !full; ++b) {
    int32_t had = 0;
    for (int32_t i = 7 * b + 3 * dim; had < EACH && i < 7 * b + 3 * dim + 3 * TRANSFERS; ++i)
      had += list_method(dim, &basis_options[b], &scheme_options[(i + had) % SCHEMES],
                         &transfer_options[4 * i % TRANSFERS], (had + b) % 2);
  }
  /* with hooks and prescribed particles */
  for (int32_t i = 0; i < (full ? PLAIN : 2); ++i) {
    body_desc o = {.dim = dim, .large = 1, .periodic = i % 2, .led = 1, .method = *broad_methods[i]};
    list[listed++] = o;
  }
}

START_TEST(same_bits) {
  body_desc o = list[_i];
  sample first = {1.0, 0.0, {0, 0}, {{NULL}}};
  int32_t tried = 0;
  for (int32_t isa = MPM_ISA_NEON; isa >= MPM_ISA_BASELINE; --isa) {
    if (!has_isa(isa)) continue;
    sample other;
    o.isa = isa;
    one_isa(o, !tried, _i, tried ? &other : &first);
    if (!tried++) continue;
    ck_agree(&o, &first, &other);
    drop_sample(&other);
  }
  ck_assert_int_ge(tried, 1);
  drop_sample(&first);
}
END_TEST

static int32_t in_lists(int32_t basis, int32_t boundary, int32_t scheme, int32_t transfer) {
  int32_t has_basis = 0, has_scheme = 0, has_transfer = 0, mls = 1;
  for (int32_t i = 0; i < BASES; ++i)
    if (basis_options[i].basis == basis && basis_options[i].boundary == boundary) {
      has_basis = 1;
      mls = fits_mls(&basis_options[i]);
    }
  for (int32_t i = 0; i < SCHEMES; ++i) has_scheme |= scheme_options[i].scheme == scheme;
  for (int32_t i = 0; i < TRANSFERS; ++i) has_transfer |= transfer_options[i].transfer == transfer;
  return has_basis && has_scheme && has_transfer && (transfer != MPM_APIC_MLS || mls);
}

/* The lists of methods.h have what the library offers, by asking for each value that has a name. */
START_TEST(lists_are_complete) {
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t basis = 1; basis <= MPM_CPGIMP; ++basis)
      for (int32_t boundary = MPM_BOUNDARY_GHOST; boundary <= MPM_BOUNDARY_OPEN_KNOT; ++boundary)
        for (int32_t scheme = 1; scheme < MPM_NEWMARK; ++scheme)
          for (int32_t transfer = 1; transfer <= MPM_APIC_MLS; ++transfer)
            if (offers(dim, basis, boundary, scheme, transfer) != in_lists(basis, boundary, scheme, transfer))
              ck_abort_msg(
                  "basis %d with boundary %d, scheme %d, transfer %d is in one only: library or lists",
                  (int)basis, (int)boundary, (int)scheme, (int)transfer);
}
END_TEST

/* The hash tells runs apart. */
START_TEST(hash_differs) {
  body_desc o = {.dim = 2};
  world a, b;
  body_open(&a, &o);
  body_open(&b, &o);
  world_steps(&a, 3);
  world_steps(&b, 3);
  ck_assert(world_hash(&a) == world_hash(&b));
  world_step(&a, BODY_DT);
  world_step(&b, BODY_DT * (1.0 + 1e-15));
  ck_assert(world_hash(&a) != world_hash(&b));
  world_close(&a);
  world_close(&b);
}
END_TEST

/* MPM_ISA_BEST is one of the sets, and a pool is as good as an executor of the host on it. */
START_TEST(best_isa_is_one_of_them) {
  body_desc o = {.dim = 3, .large = 1};
  const uint64_t best = tell(&o, NULL);
  int32_t same = 0;
  for (o.isa = MPM_ISA_BASELINE; o.isa <= MPM_ISA_NEON; ++o.isa)
    if (has_isa(o.isa)) same += tell(&o, NULL) == best;
  ck_assert_int_ge(same, 1);
}
END_TEST

Suite *determinism_suite(void) {
  Suite *suite = suite_create("determinism");
  full = getenv("MPM_FULL") != NULL;
  listed = 0;
  static const char *const cases[3] = {"1-D", "2-D", "3-D"};
  TCase *wide = wide_case(suite, "more of them");
  for (int32_t dim = 1; dim <= 3; ++dim) {
    const int32_t first = listed;
    list_methods(dim);
    TCase *tests = tcase_create(cases[dim - 1]);
    tcase_set_tags(tests, "long");
    tcase_set_timeout(tests, 900);
    add_part(tests, wide, same_bits, first, listed, full ? 1 : 3);
    suite_add_tcase(suite, tests);
  }
  TCase *hashes = tcase_create("hashes");
  tcase_set_tags(hashes, "long");
  tcase_set_timeout(hashes, 900);
  tcase_add_test(hashes, lists_are_complete);
  tcase_add_test(hashes, hash_differs);
  tcase_add_test(hashes, best_isa_is_one_of_them);
  suite_add_tcase(suite, hashes);
  return suite;
}
