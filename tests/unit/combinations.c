#include "combinations.h"

const int32_t choice_first[CHOICES] = {1, 0, 0, 0, 1, 0, 0, 0, 0};
const int32_t choice_end[CHOICES] = {4, BASES, SCHEMES, TRANSFERS, 3, 2, 2, LAWS, 2};

static int32_t is_mls(int32_t transfer) {
  return transfer_options[transfer].transfer == MPM_APIC_MLS;
}

const char *refusal_of(const combination *c) {
  const int32_t *is = c->choice;
  if (is_mls(is[CHOOSE_TRANSFER]) && !fits_mls(&basis_options[is[CHOOSE_BASIS]])) return "MPM_APIC_MLS";
  if (is[CHOOSE_STAGGERED] && is[CHOOSE_ORDER] == 2) return "staggered";
  if (basis_options[is[CHOOSE_BASIS]].basis == MPM_CPGIMP &&
      keeps_volume_alone(law_options[is[CHOOSE_LAW]].model))
    return "MPM_CPGIMP";
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
} listing;

static void append(listing *l, const combination *c) {
  if (l->count == l->capacity) {
    l->capacity = 2 * l->capacity + 256;
    l->item = realloc(l->item, (size_t)l->capacity * sizeof *l->item);
  }
  l->item[l->count++] = *c;
}

static int32_t values_of(int32_t what) {
  return choice_end[what] - choice_first[what];
}

/* Other choices than those given, until nothing is against it; 0 if there are none. */
static int32_t complete(listing *l, combination *c, const int32_t *given) {
  dice random = {l->seed++};
  for (int32_t trial = 0; trial < 1000; ++trial) {
    for (int32_t k = 0; k < CHOICES; ++k) {
      const int32_t at = (int32_t)throw_between(&random, 0.0, values_of(k));
      if (!given[k]) c->choice[k] = choice_first[k] + at;
    }
    if (!refusal_of(c)) return 1;
  }
  return 0;
}

static void list_methods(listing *l) {
  const int32_t given[CHOICES] = {1, 1, 1, 1, 0, 0, 0, 0, 0};
  combination c = {{0}};
  int32_t *is = c.choice;
  for (is[0] = choice_first[0]; is[0] < choice_end[0]; ++is[0])
    for (is[1] = choice_first[1]; is[1] < choice_end[1]; ++is[1])
      for (is[2] = choice_first[2]; is[2] < choice_end[2]; ++is[2])
        for (is[3] = choice_first[3]; is[3] < choice_end[3]; ++is[3])
          if (complete(l, &c, given)) append(l, &c);
}

static int32_t listed(const listing *l, int32_t a, int32_t value, int32_t b, int32_t other) {
  for (int32_t i = 0; i < l->count; ++i)
    if (l->item[i].choice[a] == value && l->item[i].choice[b] == other) return 1;
  return 0;
}

static void list_pairs(listing *l) {
  for (int32_t a = 0; a < CHOICES; ++a)
    for (int32_t b = a + 1; b < CHOICES; ++b)
      for (int32_t i = 0; i < values_of(a) * values_of(b); ++i) {
        const int32_t value = choice_first[a] + i / values_of(b), other = choice_first[b] + i % values_of(b);
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

world_desc describe_combination(const combination *c) {
  const int32_t *is = c->choice;
  const method how = method_of(&basis_options[is[CHOOSE_BASIS]], &scheme_options[is[CHOOSE_SCHEME]],
                               &transfer_options[is[CHOOSE_TRANSFER]]);
  world_desc d = world_with(&how, is[CHOOSE_DIM], 8, 0.25);
  d.grid.periodic[0] = is[CHOOSE_PERIODIC];
  d.stepper.position_order = is[CHOOSE_ORDER];
  d.stepper.staggered = is[CHOOSE_STAGGERED];
  d.stepper.locking_remedy = is[CHOOSE_REMEDY];
  return d;
}
