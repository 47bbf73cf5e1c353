/* Every combination of options that has a meaning works, and every other is refused with a sentence
 * that says what to use instead. Each is stepped on a body whose motion is known: a translation
 * across cells, and a patch of uniform deformation and stress in an affine velocity field under
 * gravity. With MPM_FULL=1 in the environment the list is whole and the bodies have 27 blocks and
 * more; without, it is a sample on small ones. */
#include "combinations.h"
#include "reference.h"

static const double h = 0.25, E = 100.0, nu = 0.3, density = 1e3;
static combination *list;
static int32_t listed, full;
static reference_law host_law;

/* ---- the world of a combination ---- */
typedef struct body {
  world w;
  mpm_particles *set;
  const combination *c;
  int32_t dim, periodic;
  int64_t cells; /* of the body along each axis */
  double low[3];
  char name[128];
} body;

static world_desc describe(const combination *c) {
  world_desc d = describe_combination(c);
  host_law = (reference_law){E, nu, sqrt(2.0 * E / density)};
  d.law = (world_law){.model = law_options[c->choice[CHOOSE_LAW]].model,
                      .E = E,
                      .nu = nu,
                      .density = density,
                      .yield_stress = 0.01 * E,
                      .hardening = 0.1 * E,
                      .stress = reference_law_stress,
                      .user = &host_law};
  return d;
}

/* `before` and `after`: free cells on both sides of the body, but for a periodic axis. */
static void open_body(body *b, const combination *c, int64_t cells, int32_t per_cell, int64_t before,
                      int64_t after, const double *g) {
  world_desc d = describe(c);
  double low[3], high[3];
  memcpy(d.stepper.gravity, g, sizeof d.stepper.gravity);
  for (int32_t k = 0; k < d.grid.dim; ++k) {
    const int32_t around = d.grid.periodic[k];
    d.grid.cells[k] = around ? cells : before + cells + after;
    low[k] = around ? 0.0 : h * (double)before;
    high[k] = low[k] + h * (double)cells;
  }
  memset(b, 0, sizeof *b);
  b->c = c;
  b->dim = d.grid.dim;
  b->periodic = c->choice[CHOOSE_PERIODIC];
  b->cells = cells;
  memcpy(b->low, low, sizeof low);
  name_of(c, b->name, sizeof b->name);
  b->set = world_open(&b->w, &d);
  world_fill(&b->w, b->set, low, high, per_cell);
}

static const char *model_of(const body *b) {
  const char *model = law_options[b->c->choice[CHOOSE_LAW]].model;
  return model ? model : "host";
}

static int32_t has_law(const body *b, const char *model) {
  return !strcmp(model_of(b), model);
}

/* Momentum on an axis, and a scale for it. */
static double momentum_of(const body *b, const double *m, const double *v, int32_t k, double *scale) {
  const int64_t n = mpm_particles_count(b->set);
  double sum = 0.0;
  for (int64_t p = 0; p < n; ++p) sum += m[p] * v[k * n + p], *scale += m[p] * fabs(v[k * n + p]);
  return sum;
}

/* The grid has the particles' mass; where an axis is periodic nodes are listed with their images. */
static void check_nodal_mass(body *b, const double *m) {
  int64_t nodes;
  double *mass = fetch_nodes(&b->w, "mass", &nodes);
  const double total = sum_of(mpm_particles_count(b->set), m);
  if (!b->periodic) ck_within(b->name, sum_of(nodes, mass), total, 1e-12 * total);
  free(mass);
}

/* ---- translation ---- */
/* Puts a surface into the body that prescribes how it moves anyway, whole or along the normals alone. */
static mpm_surface *put_prescribing(body *b, const double *v, int32_t normal_only) {
  mpm_surface_desc d;
  mpm_surface *s;
  ck_assert_int_eq(mpm_surface_desc_init(&d, sizeof d), MPM_OK);
  d.prescribes = normal_only ? MPM_PRESCRIBES_NORMAL : MPM_PRESCRIBES_VELOCITY;
  memcpy(d.velocity, v, sizeof d.velocity);
  ck_ok(&b->w, mpm_surface_create(b->w.context, b->w.grid, &d, &s));
  for (int32_t i = 0; i < 4; ++i) {
    const double x[3] = {h * (0.4 + 0.9 * i), h * (0.3 + 0.8 * i), h * 1.7}, area[3] = {-0.05, 0.1, 0.02};
    ck_ok(&b->w, mpm_surface_add(s, 1, x, area, NULL));
  }
  ck_ok(&b->w, mpm_stepper_add_surface(b->w.stepper, s));
  return s;
}

/* It has pushed nothing, and its markers have flown as the body has. */
static void drop_prescribing(body *b, mpm_surface *s, const double *v, double time) {
  const int64_t n = mpm_surface_count(s);
  double *u = calloc((size_t)(n * b->dim), sizeof *u), impulse[3];
  ck_assert_int_eq(n, 4);
  ck_ok(&b->w, mpm_surface_get(s, "displacement", MPM_F64, b->dim, n, NULL, u));
  ck_ok(&b->w, mpm_stepper_surface_impulse(b->w.stepper, s, impulse));
  for (int32_t k = 0; k < b->dim; ++k) {
    ck_within(b->name, impulse[k], 0.0, 1e-10 * density);
    for (int64_t i = 0; i < n; ++i) ck_within(b->name, u[k * n + i], v[k] * time, 1e-12);
  }
  free(u);
  ck_ok(&b->w, mpm_stepper_remove_surface(b->w.stepper, s));
  ck_ok(&b->w, mpm_surface_destroy(s));
}

/* A block that starts on the lower faces flies stress-free through several cells on each axis. Of three
 * bodies two have a surface that prescribes this. */
static void check_translation(const combination *c, int32_t number) {
  enum { FLIGHT = 12 };
  const double v[3] = {0.96, 0.8, 0.7}, dt = 0.08, none[3] = {0.0, 0.0, 0.0};
  body b;
  open_body(&b, c, 4, 2, 0, 6, none);
  ck_ok(&b.w, mpm_particles_set_all(b.set, "velocity", MPM_F64, b.dim, v));
  const int64_t n = mpm_particles_count(b.set);
  double *x0 = fetch(&b.w, b.set, "position", b.dim), *m0 = fetch(&b.w, b.set, "mass", 1);
  mpm_surface *s = number % 3 ? put_prescribing(&b, v, number % 3 == 1) : NULL;
  for (int32_t i = 0; i < FLIGHT; ++i) world_step(&b.w, dt);
  if (s) drop_prescribing(&b, s, v, FLIGHT * dt);
  check_nodal_mass(&b, m0);
  double *x = fetch(&b.w, b.set, "position", b.dim), *m = fetch(&b.w, b.set, "mass", 1);
  double *u = fetch(&b.w, b.set, "velocity", b.dim), *stress = fetch(&b.w, b.set, "stress", 6);
  int64_t *image = fetch_as(&b.w, b.set, "image", MPM_I64, b.dim);
  if (memcmp(m, m0, (size_t)n * sizeof *m)) ck_abort_msg("%s: masses have changed", b.name);
  for (int32_t k = 0; k < b.dim; ++k)
    for (int64_t p = 0; p < n; ++p) {
      const int64_t i = k * n + p;
      const double flown = x[i] - x0[i] + (double)image[i] * h * (double)b.w.desc.grid.cells[k];
      ck_within(b.name, u[i], v[k], 1e-12);
      ck_within(b.name, flown, v[k] * FLIGHT * dt, 1e-12);
    }
  ck_within(b.name, largest(6 * n, stress) / E, 0.0, 1e-12);
  free(x0), free(m0), free(x), free(m), free(u), free(stress), free(image);
  world_close(&b.w);
}

/* ---- patch ---- */
static const double F_patch[9] = {1.1, 0.05, -0.04, 0.03, 0.95, 0.06, 0.02, -0.05, 1.05};
static const double L_patch[9] = {0.3, -0.5, 0.2, 0.4, -0.2, 0.6, -0.1, 0.7, 0.15};
static const double stress_patch[6] = {2.0, -1.0, 0.5, 0.7, -0.3, 0.4};
static const double gravity[3] = {1.0, -3.0, 2.0};
static const double swelling = 1.02; /* of a fluid, which knows its volume only */

static double of_dim(int32_t dim, const double *tensor, int32_t c, double diagonal) {
  return c / 3 < dim && c % 3 < dim ? tensor[c] : c % 4 == 0 ? diagonal : 0.0;
}

typedef struct patch {
  double L[9], F[9], F_new[9]; /* F_new: after the step */
  double J_new;
} patch;

/* F and L of the patch. Along a periodic axis velocities repeat themselves: L has no such column. */
static patch make_patch(const body *b, double dt) {
  patch q;
  const int32_t fluid = keeps_volume_alone(model_of(b));
  for (int32_t c = 0; c < 9; ++c) {
    q.L[c] = b->periodic && c % 3 == 0 ? 0.0 : of_dim(b->dim, L_patch, c, 0.0);
    q.F[c] = of_dim(b->dim, F_patch, c, 1.0);
    if (fluid) q.F[c] = c % 4 ? 0.0 : b->dim == 1 ? 1.0 : swelling;
  }
  for (int32_t c = 0; c < 9; ++c) {
    q.F_new[c] = q.F[c];
    for (int32_t k = 0; k < 3; ++k) q.F_new[c] += dt * q.L[c / 3 * 3 + k] * q.F[3 * k + c % 3];
  }
  q.J_new = determinant(q.F_new);
  return q;
}

static void set_patch(const body *b, const patch *q) {
  const int64_t n = mpm_particles_count(b->set);
  double *x = fetch(&b->w, b->set, "position", b->dim), *v = calloc((size_t)(n * b->dim), sizeof *v);
  for (int32_t c = 0; c < 9; ++c)
    for (int64_t p = 0; p < n && c / 3 < b->dim && c % 3 < b->dim; ++p)
      v[c / 3 * n + p] += q->L[c] * (x[c % 3 * n + p] - b->low[c % 3] - 0.5 * h * (double)b->cells);
  ck_ok(&b->w, mpm_particles_set_all(b->set, "deformation_gradient", MPM_F64, 9, q->F));
  put(&b->w, b->set, "velocity", b->dim, v);
  if (carries_matrix(transfer_options[b->c->choice[CHOOSE_TRANSFER]].transfer))
    ck_ok(&b->w, mpm_particles_set_all(b->set, "velocity_gradient", MPM_F64, 9, q->L));
  const int32_t clay = has_law(b, "cam_clay");
  if (has_law(b, "linear_elastic") || has_law(b, "j2") || has_law(b, "herschel_bulkley") ||
      has_law(b, "mu_i") || clay) {
    double stress[6];
    for (int32_t c = 0; c < 6; ++c)
      stress[c] = b->dim == 3 || c < 3 || (b->dim == 2 && c == 3) ? stress_patch[c] : 0.0;
    for (int32_t c = 0; c < 3; ++c) stress[c] -= clay ? 0.01 * E : 0.0;
    ck_ok(&b->w, mpm_particles_set_all(b->set, "stress", MPM_F64, 6, stress));
  }
  free(x), free(v);
}

/* How far from the edge of the body its edge is felt, in cells. What a particle knows at the end of a step
 * comes by hops, from particles to nodes and back; the first brings the missing neighbours of nodes at the
 * edge, where neither the projected velocity is that of the field nor stress in balance. */
typedef struct depths {
  double motion, deformation, stress;
} depths;

static depths depths_of(const combination *c) {
  const basis_option *basis = &basis_options[c->choice[CHOOSE_BASIS]];
  const transfer_option *transfer = &transfer_options[c->choice[CHOOSE_TRANSFER]];
  const int32_t scheme = scheme_options[c->choice[CHOOSE_SCHEME]].scheme;
  const double hop = 2.0 * reference_reach(basis);
  const int32_t filters = has_orders(transfer->transfer) ? transfer->xpic_order : 1;
  /* USF: forces come from a stress that has already been through a hop, and through a cell with the remedy */
  const double forces = scheme == MPM_USF ? 2.0 * hop + c->choice[CHOOSE_REMEDY] : hop;
  depths d;
  d.motion = fmax(forces, hop * filters);
  d.deformation = scheme == MPM_MUSL ? d.motion + hop : hop;
  d.stress = d.deformation + c->choice[CHOOSE_REMEDY];
  return d;
}

/* Is the particle at x far enough inside? */
static int32_t is_inside(const body *b, const double *x, int64_t p, double depth) {
  const int64_t n = mpm_particles_count(b->set);
  for (int32_t k = b->periodic; k < b->dim; ++k) {
    const double from = (x[k * n + p] - b->low[k]) / h;
    if (from < depth || from > (double)b->cells - depth) return 0;
  }
  return 1;
}

static void check_motion(const body *b, double dt, double depth, const double *x0, const double *v0,
                         double scale) {
  const int64_t n = mpm_particles_count(b->set);
  double *x = fetch(&b->w, b->set, "position", b->dim), *v = fetch(&b->w, b->set, "velocity", b->dim);
  /* with g all along the step, positions of second order know half of it */
  const double fallen = b->c->choice[CHOOSE_ORDER] == 2 ? 0.5 : 1.0;
  for (int32_t k = 0; k < b->dim; ++k)
    for (int64_t p = 0; p < n; ++p) {
      if (!is_inside(b, x0, p, depth)) continue;
      const int64_t i = k * n + p;
      ck_within(b->name, v[i], v0[i] + dt * gravity[k], 1e-13 * scale);
      ck_within(b->name, x[i], x0[i] + dt * (v0[i] + fallen * dt * gravity[k]), 1e-12);
    }
  free(x), free(v);
}

static void check_deformation(const body *b, const patch *q, double depth, const double *x0) {
  const int64_t n = mpm_particles_count(b->set);
  double *F = fetch(&b->w, b->set, "deformation_gradient", 9), *V = fetch(&b->w, b->set, "volume", 1);
  double *V0 = fetch(&b->w, b->set, "initial_volume", 1);
  for (int64_t p = 0; p < n; ++p) {
    if (!is_inside(b, x0, p, depth)) continue;
    ck_within(b->name, V[p] / V0[p], q->J_new, 1e-13);
    for (int32_t c = 0; c < 9 && !keeps_volume_alone(model_of(b)); ++c)
      ck_within(b->name, F[c * n + p], q->F_new[c], 1e-13);
  }
  free(F), free(V), free(V0);
}

static void check_stress(const body *b, const patch *q, double depth, const double *x0) {
  const int64_t n = mpm_particles_count(b->set);
  double *stress = fetch(&b->w, b->set, "stress", 6), wanted[6];
  int64_t first = -1;
  for (int64_t p = 0; p < n; ++p) {
    if (!is_inside(b, x0, p, depth)) continue;
    if (first < 0) {
      first = p;
      for (int32_t c = 0; c < 6; ++c) wanted[c] = stress[c * n + p];
      if (has_law(b, "neo_hookean") || has_law(b, "host")) reference_stress(E, nu, q->F_new, wanted);
    }
    for (int32_t c = 0; c < 6; ++c) ck_within(b->name, stress[c * n + p], wanted[c], 1e-11 * E);
  }
  free(stress);
}

/* Uniform F and stress on a lattice, v = L x: inside the body nothing but gravity accelerates it, F becomes
 * (I + dt L) F, and stress stays uniform. All bases reproduce linear fields and all transfers project them
 * exactly from a lattice that is symmetric about every node, those that carry a matrix from any. */
static void check_patch(const combination *c) {
  static const int64_t large[4] = {0, 1740, 80, 20}, small[4] = {0, 60, 24, 20};
  const double dt = 1e-4;
  const int64_t cells = full ? large[c->choice[CHOOSE_DIM]] : small[c->choice[CHOOSE_DIM]];
  const depths d = depths_of(c);
  body b;
  open_body(&b, c, cells, c->choice[CHOOSE_DIM] == 3 || full ? 1 : 2, 4, 4, gravity);
  const patch q = make_patch(&b, dt);
  if (has_law(&b, "rigid")) { /* has neither deformation nor stress */
    world_close(&b.w);
    return;
  }
  set_patch(&b, &q);
  const int64_t n = mpm_particles_count(b.set);
  double *x0 = fetch(&b.w, b.set, "position", b.dim), *v0 = fetch(&b.w, b.set, "velocity", b.dim);
  double *m0 = fetch(&b.w, b.set, "mass", 1);
  world_step(&b.w, dt);
  if (full) ck_assert_int_ge(world_blocks(&b.w), 27);
  check_nodal_mass(&b, m0);
  double *m = fetch(&b.w, b.set, "mass", 1), *v = fetch(&b.w, b.set, "velocity", b.dim);
  const double total = sum_of(n, m);
  if (memcmp(m, m0, (size_t)n * sizeof *m)) ck_abort_msg("%s: masses have changed", b.name);
  for (int32_t k = 0; k < b.dim; ++k) {
    double scale = 0.0;
    const double before = momentum_of(&b, m, v0, k, &scale), after = momentum_of(&b, m, v, k, &scale);
    ck_within(b.name, after, before + dt * total * gravity[k], 1e-12 * (scale + total));
  }
  check_motion(&b, dt, d.motion, x0, v0, 1.0 + largest(n * b.dim, v0));
  check_deformation(&b, &q, d.deformation, x0);
  check_stress(&b, &q, d.stress, x0);
  free(x0), free(v0), free(m0), free(m), free(v);
  world_close(&b.w);
}

/* ---- tests ---- */
enum { SAMPLE = 240, AT_ONCE = 6 };
static int32_t list_sample(void) {
  return full || listed < SAMPLE ? listed : SAMPLE;
}

/* The k-th of those to be stepped; a sample is spread over the list. */
static const combination *chosen(int32_t k) {
  return &list[(int64_t)k * listed / list_sample()];
}

START_TEST(combination_works) {
  for (int32_t k = _i * AT_ONCE; k < (_i + 1) * AT_ONCE && k < list_sample(); ++k) {
    /* without a pressure there is no clay, and under one it does not keep its shape */
    if (strcmp(law_options[chosen(k)->choice[CHOOSE_LAW]].name, "Cam-clay")) check_translation(chosen(k), k);
    check_patch(chosen(k));
  }
}
END_TEST

/* Every two values are together in some combination, but those that are refused. */
START_TEST(every_pair_is_listed) {
  for (int32_t a = 0; a < CHOICES; ++a)
    for (int32_t b = a + 1; b < CHOICES; ++b)
      for (int32_t value = choice_first[a]; value < choice_end[a]; ++value)
        for (int32_t other = choice_first[b]; other < choice_end[b]; ++other) {
          int32_t times = 0;
          for (int32_t i = 0; i < listed; ++i)
            times += list[i].choice[a] == value && list[i].choice[b] == other;
          if ((times > 0) == pair_refused(a, value, b, other))
            ck_abort_msg("choice %d = %d with %d = %d: %d times", (int)a, (int)value, (int)b, (int)other,
                         (int)times);
        }
}
END_TEST

/* The inside of the patch is not empty where it should not be: in 1-D and 2-D for every combination, in 3-D
 * for all but the higher orders of XPIC and FMPM. */
START_TEST(patches_have_an_inside) {
  for (int32_t i = 0; i < listed; ++i) {
    const depths d = depths_of(&list[i]);
    const int32_t dim = list[i].choice[CHOOSE_DIM];
    const int32_t filters = transfer_options[list[i].choice[CHOOSE_TRANSFER]].xpic_order;
    const int32_t deep =
        has_orders(transfer_options[list[i].choice[CHOOSE_TRANSFER]].transfer) && filters > 1;
    const double half = dim == 1 ? 870.0 : dim == 2 ? 40.0 : 10.0;
    if (dim < 3 || !deep) ck_assert_double_lt(d.motion, half);
    if (dim < 3 || !deep) ck_assert_double_lt(d.deformation, half);
  }
}
END_TEST

/* Whatever is refused is refused by a call before the first step, with a sentence that names what to use. */
static void expect_refusal(const combination *c, const char *why) {
  char name[128];
  world w = {.desc = describe(c)};
  name_of(c, name, sizeof name);
  mpm_status status = world_try_open(&w);
  if (status != MPM_E_UNSUPPORTED || !strstr(mpm_last_error(w.context), "use"))
    ck_abort_msg("%s (%s): %s: \"%s\"", name, why, mpm_status_name(status), mpm_last_error(w.context));
  /* and so where a stepper that exists is asked for it */
  if (w.set[0]) {
    ck_ok(&w, mpm_stepper_create(w.context, w.grid, NULL, &w.stepper));
    status = mpm_stepper_configure(w.stepper, &w.desc.stepper);
    if (status != MPM_E_UNSUPPORTED || !strstr(mpm_last_error(w.context), "use"))
      ck_abort_msg("configure %s (%s): %s: \"%s\"", name, why, mpm_status_name(status),
                   mpm_last_error(w.context));
  }
  world_close(&w);
}

START_TEST(refusals_say_what_to_use) {
  int32_t refused = 0;
  combination c;
  int32_t *is = c.choice;
  is[CHOOSE_DIM] = _i;
  for (is[CHOOSE_BASIS] = 0; is[CHOOSE_BASIS] < BASES; ++is[CHOOSE_BASIS])
    for (is[CHOOSE_SCHEME] = 0; is[CHOOSE_SCHEME] < SCHEMES; ++is[CHOOSE_SCHEME])
      for (is[CHOOSE_TRANSFER] = 0; is[CHOOSE_TRANSFER] < TRANSFERS; ++is[CHOOSE_TRANSFER])
        for (int32_t rest = 0; rest < 8 * LAWS; ++rest) {
          is[CHOOSE_ORDER] = 1 + rest % 2;
          is[CHOOSE_STAGGERED] = rest / 2 % 2;
          is[CHOOSE_REMEDY] = rest / 4 % 2;
          is[CHOOSE_LAW] = rest / 8;
          is[CHOOSE_PERIODIC] = (rest + is[CHOOSE_BASIS]) % 2;
          /* a grid without faces has no open knots: nothing need be refused */
          if (_i == 1 && is[CHOOSE_PERIODIC] && basis_options[is[CHOOSE_BASIS]].boundary) continue;
          const char *why = refusal_of(&c);
          if (!why || (!full && refused++ % 7)) continue;
          expect_refusal(&c, why);
        }
  ck_assert_int_gt(full || refused, 0);
}
END_TEST

/* Open knots are for B-splines of order two and three. */
START_TEST(open_knots_want_splines) {
  static const int32_t others[] = {MPM_LINEAR, MPM_GIMP, MPM_UGIMP, MPM_CPGIMP};
  for (size_t i = 0; i < sizeof others / sizeof *others; ++i) {
    world w = {.desc = world_default(3, 8, h)};
    w.desc.grid.basis = others[i];
    w.desc.grid.boundary_basis = MPM_BOUNDARY_OPEN_KNOT;
    ck_refused(&w, world_try_open(&w), MPM_E_UNSUPPORTED, "use");
    world_close(&w);
  }
}
END_TEST

/* No two methods of the list have the same name, so that a message says which one failed. */
START_TEST(names_tell_methods_apart) {
  for (int32_t i = 0; i < ALL_METHODS; ++i) {
    ck_assert_int_gt((int)strlen(methods[i].name), 0);
    for (int32_t k = 0; k < i; ++k) ck_assert_str_ne(methods[i].name, methods[k].name);
  }
}
END_TEST

Suite *combinations_suite(void) {
  Suite *suite = suite_create("combinations");
  full = getenv("MPM_FULL") != NULL;
  if (!list) list = list_combinations(&listed);
  TCase *rules = tcase_create("rules");
  tcase_set_timeout(rules, 300.0);
  tcase_add_test(rules, every_pair_is_listed);
  tcase_add_test(rules, patches_have_an_inside);
  tcase_add_loop_test(rules, refusals_say_what_to_use, 1, 4);
  tcase_add_test(rules, open_knots_want_splines);
  tcase_add_test(rules, names_tell_methods_apart);
  suite_add_tcase(suite, rules);
  /* in two parts, for as many processes */
  static const char *const parts[2] = {"first half", "second half"};
  const int32_t tests = (list_sample() + AT_ONCE - 1) / AT_ONCE;
  for (int32_t i = 0; i < 2; ++i) {
    TCase *tc = tcase_create(parts[i]);
    tcase_set_tags(tc, "long");
    tcase_set_timeout(tc, 300.0);
    tcase_add_loop_test(tc, combination_works, i * tests / 2, (i + 1) * tests / 2);
    suite_add_tcase(suite, tc);
  }
  return suite;
}
