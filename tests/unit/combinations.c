#include "combinations.h"

const int32_t choice_first[CHOICES] = {1, 0, 0, 0, 1, 0, 0, 0, 0};
const int32_t choice_end[CHOICES] = {4, BASES, SCHEMES, TRANSFERS, 3, 2, 2, LAWS, 2};

int32_t choice_ready(int32_t what, int32_t value) {
  switch (what) {
  case CHOOSE_BASIS:
    return basis_ready(&basis_options[value]);
  case CHOOSE_SCHEME:
    return scheme_ready(&scheme_options[value]);
  case CHOOSE_TRANSFER:
    return transfer_ready(&transfer_options[value]);
  case CHOOSE_ORDER:
    return option_ready(OPTION_POSITION_ORDER, value);
  case CHOOSE_STAGGERED:
    return option_ready(OPTION_STAGGERED, value);
  case CHOOSE_REMEDY:
    return option_ready(OPTION_LOCKING, value);
  case CHOOSE_LAW:
    return law_ready(value);
  default:
    return 1;
  }
}

static int32_t is_fluid(int32_t law) {
  return law_options[law].model && !strcmp(law_options[law].model, "newtonian_fluid");
}

static int32_t is_mls(int32_t transfer) {
  return transfer_options[transfer].transfer == MPM_APIC_MLS;
}

const char *refusal_of(const combination *c) {
  const int32_t *is = c->choice;
  if (is_mls(is[CHOOSE_TRANSFER]) && !fits_mls(&basis_options[is[CHOOSE_BASIS]])) return "MPM_APIC_MLS";
  if (is[CHOOSE_STAGGERED] && is[CHOOSE_ORDER] == 2) return "staggered";
  if (basis_options[is[CHOOSE_BASIS]].basis == MPM_CPGIMP && is_fluid(is[CHOOSE_LAW])) return "MPM_CPGIMP";
  if (is[CHOOSE_REMEDY] && is[CHOOSE_DIM] == 1) return "locking_remedy";
  return NULL;
}

int32_t pair_refused(int32_t what, int32_t value, int32_t other, int32_t other_value) {
  /* values that nothing refuses beside the two */
  combination c = {{2, 1, 0, 0, 1, 0, 0, 0, 0}};
  c.choice[what] = value;
  c.choice[other] = other_value;
  return refusal_of(&c) != NULL;
}

/* ---- the list ---- */
typedef struct listing {
  combination *item;
  int32_t count, capacity;
  uint64_t seed;
  int32_t value[CHOICES][TRANSFERS], values[CHOICES]; /* those that are ready */
} listing;

static void append(listing *l, const combination *c) {
  if (l->count == l->capacity) {
    l->capacity = 2 * l->capacity + 256;
    l->item = realloc(l->item, (size_t)l->capacity * sizeof *l->item);
  }
  l->item[l->count++] = *c;
}

/* Other choices than those given, until nothing is against it; 0 if there are none. */
static int32_t complete(listing *l, combination *c, const int32_t *given) {
  dice random = {l->seed++};
  for (int32_t trial = 0; trial < 1000; ++trial) {
    for (int32_t k = 0; k < CHOICES; ++k) {
      const int32_t at = (int32_t)throw_between(&random, 0.0, l->values[k]);
      if (!given[k]) c->choice[k] = l->value[k][at];
    }
    if (!refusal_of(c)) return 1;
  }
  return 0;
}

static void list_methods(listing *l) {
  const int32_t given[CHOICES] = {1, 1, 1, 1, 0, 0, 0, 0, 0};
  int32_t at[4];
  combination c = {{0}};
  for (at[0] = 0; at[0] < l->values[0]; ++at[0])
    for (at[1] = 0; at[1] < l->values[1]; ++at[1])
      for (at[2] = 0; at[2] < l->values[2]; ++at[2])
        for (at[3] = 0; at[3] < l->values[3]; ++at[3]) {
          for (int32_t k = 0; k < 4; ++k) c.choice[k] = l->value[k][at[k]];
          if (complete(l, &c, given)) append(l, &c);
        }
}

static int32_t listed(const listing *l, int32_t a, int32_t value, int32_t b, int32_t other) {
  for (int32_t i = 0; i < l->count; ++i)
    if (l->item[i].choice[a] == value && l->item[i].choice[b] == other) return 1;
  return 0;
}

static void list_pairs(listing *l) {
  for (int32_t a = 0; a < CHOICES; ++a)
    for (int32_t b = a + 1; b < CHOICES; ++b)
      for (int32_t i = 0; i < l->values[a] * l->values[b]; ++i) {
        const int32_t value = l->value[a][i / l->values[b]], other = l->value[b][i % l->values[b]];
        int32_t given[CHOICES] = {0};
        combination c = {{0}};
        given[a] = given[b] = 1;
        c.choice[a] = value;
        c.choice[b] = other;
        if (!listed(l, a, value, b, other) && complete(l, &c, given)) append(l, &c);
      }
}

combination *list_combinations(int32_t *count) {
  listing l = {.seed = 1};
  for (int32_t k = 0; k < CHOICES; ++k)
    for (int32_t value = choice_first[k]; value < choice_end[k]; ++value)
      if (choice_ready(k, value)) l.value[k][l.values[k]++] = value;
  list_methods(&l);
  list_pairs(&l);
  *count = l.count;
  return l.item;
}

/* ---- what it is ---- */
const char *name_of(const combination *c, char *text, size_t size) {
  const int32_t *is = c->choice;
  snprintf(text, size, "%d-D %s, %s, %s, %s%s%s%s%s", (int)is[CHOOSE_DIM],
           basis_options[is[CHOOSE_BASIS]].name, scheme_options[is[CHOOSE_SCHEME]].name,
           transfer_options[is[CHOOSE_TRANSFER]].name, law_options[is[CHOOSE_LAW]].name,
           is[CHOOSE_ORDER] == 2 ? ", order 2" : "", is[CHOOSE_STAGGERED] ? ", staggered" : "",
           is[CHOOSE_REMEDY] ? ", remedy" : "", is[CHOOSE_PERIODIC] ? ", periodic" : "");
  return text;
}

void describe_combination(const combination *c, mpm_grid_desc *grid, mpm_stepper_desc *stepper) {
  const int32_t *is = c->choice;
  const basis_option *basis = &basis_options[is[CHOOSE_BASIS]];
  const transfer_option *transfer = &transfer_options[is[CHOOSE_TRANSFER]];
  ck_assert_int_eq(mpm_grid_desc_init(grid, sizeof *grid), MPM_OK);
  ck_assert_int_eq(mpm_stepper_desc_init(stepper, sizeof *stepper), MPM_OK);
  grid->dim = is[CHOOSE_DIM];
  grid->basis = basis->basis;
  grid->boundary_basis = basis->boundary;
  grid->smoothing = basis->smoothing;
  grid->periodic[0] = is[CHOOSE_PERIODIC];
  for (int32_t k = 0; k < 3; ++k) grid->cells[k] = 8, grid->spacing[k] = 0.25;
  stepper->scheme = scheme_options[is[CHOOSE_SCHEME]].scheme;
  stepper->transfer = transfer->transfer;
  stepper->xpic_order = transfer->xpic_order;
  stepper->flip = transfer->flip;
  stepper->pic_damping = transfer->pic_damping;
  stepper->position_order = is[CHOOSE_ORDER];
  stepper->staggered = is[CHOOSE_STAGGERED];
  stepper->locking_remedy = is[CHOOSE_REMEDY];
}
