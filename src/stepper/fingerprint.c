/* How a stepper is set up, as one number: parts that differ there would wait for each other, or compute
 * different problems. */
#include "stepper/fingerprint.h"

#include <string.h>

static uint64_t fold_word(uint64_t h, uint64_t word) {
  return (h ^ word) * 0x100000001b3u ^ h >> 29;
}

static uint64_t fold_number(uint64_t h, double number) {
  uint64_t word;
  memcpy(&word, &number, sizeof word);
  return fold_word(h, word);
}

/* Folds in what has no pointers and no holes. */
static uint64_t fold_words(uint64_t h, const void *of, size_t bytes) {
  for (size_t at = 0; at < bytes; at += sizeof(uint64_t)) {
    uint64_t word;
    memcpy(&word, (const char *)of + at, sizeof word);
    h = fold_word(h, word);
  }
  return h;
}

static uint64_t fold_grid(uint64_t h, const mpm_grid_desc *d) {
  const int32_t kind[] = {d->dim,         d->basis,       d->boundary_basis, d->geometry,
                          d->periodic[0], d->periodic[1], d->periodic[2],    d->total_lagrangian};
  for (size_t i = 0; i < sizeof kind / sizeof kind[0]; ++i) h = fold_word(h, (uint64_t)kind[i]);
  for (int32_t k = 0; k < d->dim; ++k)
    h = fold_number(fold_number(fold_word(h, (uint64_t)d->cells[k]), d->origin[k]), d->spacing[k]);
  return fold_number(h, d->smoothing);
}

/* The parameters of a built-in law; of the host's own its density alone. */
static uint64_t fold_law(uint64_t h, const mpm_material *law) {
  h = fold_number(fold_word(h, (uint64_t)law->state_count), law->density);
  for (const char *c = law->law ? law->law->name : ""; *c; ++c) h = fold_word(h, (uint64_t)*c);
  return law->law ? fold_words(h, law->value, (size_t)law->law->param_count * sizeof *law->value) : h;
}

static uint64_t fold_adaption(uint64_t h, const mpmi_adaption *a) {
  const double number[] = {a->desc.split_edge, a->desc.least_edge, a->desc.merge_distance,
                           a->desc.merge_tolerance, (double)a->desc.most_particles};
  h = fold_word(fold_word(h, (uint64_t)a->on), (uint64_t)(a->on ? a->desc.every : 0));
  if (!a->on) return h;
  h = fold_word(fold_word(h, (uint64_t)a->desc.min_per_cell), (uint64_t)a->desc.max_per_cell);
  for (int32_t i = 0; i < 5; ++i) h = fold_number(h, number[i]);
  return h;
}

static uint64_t fold_set(uint64_t h, const mpm_stepper *s, int32_t m) {
  const mpmi_settings *settings = &s->settings;
  h = fold_word(fold_law(h, s->layout.member[m].set->material), (uint64_t)s->layout.member[m].body);
  h = fold_word(fold_adaption(h, &s->adaption[m]), settings->motion[m].fn != NULL);
  if (!settings->heat.any || !settings->heat.set[m].on) return h;
  const mpm_heat_desc *d = &settings->heat.set[m].desc;
  const double number[] = {d->specific_heat, d->conductivity, d->expansion, d->reference_temperature,
                           d->dissipated_share};
  for (int32_t i = 0; i < 5; ++i) h = fold_number(h, number[i]);
  return fold_word(h, d->source != NULL);
}

static uint64_t fold_heat(uint64_t h, const mpm_stepper *s) {
  const mpmi_heat_rules *heat = &s->settings.heat;
  h = fold_number(fold_word(fold_word(h, (uint64_t)heat->any), (uint64_t)heat->conduction), heat->tolerance);
  for (int32_t face = 0; face < 2 * s->grid->dim; ++face)
    h = fold_number(fold_word(h, (uint64_t)heat->wall[face].kind), heat->wall[face].temperature);
  return h;
}

static uint64_t fold_contact(uint64_t h, const mpmi_settings *settings) {
  _Static_assert(sizeof(mpm_contact_desc) % sizeof(uint64_t) == 0, "the description is whole words");
  for (int64_t i = 0; i < settings->contact.count; ++i) {
    const mpmi_contact_rule *rule = &settings->contact.rule[i];
    h = fold_word(fold_word(h, (uint64_t)rule->a), (uint64_t)rule->b);
    h = fold_words(h, &rule->desc, sizeof rule->desc);
  }
  for (int64_t i = 0; i < settings->obstacles.count; ++i)
    h = fold_word(h, (uint64_t)(64 * settings->obstacles.obstacle[i]->desc.shape +
                                settings->obstacles.obstacle[i]->desc.motion));
  return fold_word(h, settings->friction != NULL);
}

int64_t mpmi_fingerprint(const mpm_stepper *s) {
  const mpmi_settings *settings = &s->settings;
  _Static_assert(sizeof settings->desc % sizeof(uint64_t) == 0, "the description is whole words");
  uint64_t h = fold_words(0xcbf29ce484222325u, &settings->desc, sizeof settings->desc);
  h = fold_grid(h, &s->grid->desc);
  for (int32_t face = 0; face < 2 * s->grid->dim; ++face)
    h = fold_number(fold_word(h, (uint64_t)settings->wall[face].kind), settings->wall[face].friction);
  for (int32_t m = 0; m < s->layout.member_count; ++m) h = fold_set(h, s, m);
  h = fold_contact(fold_heat(h, s), settings);
  for (int64_t i = 0; i < settings->surfaces.count; ++i) {
    const mpm_surface *surface = settings->surfaces.surface[i];
    h = fold_word(h, (uint64_t)(4 * surface->desc.prescribes + 2 * (surface->heat.flux != 0.0) +
                                (surface->heat.film > 0.0)));
  }
  for (int32_t i = 0; i < 3; ++i) h = fold_word(h, settings->hook[i] != NULL);
  h = fold_word(fold_word(h, settings->acceleration != NULL), settings->force != NULL);
  if (settings->desc.linear_solver == MPM_SOLVER_HOST) h = fold_word(h, settings->solver != NULL);
  return (int64_t)(fold_word(h, settings->velocity_bc != NULL) >> 2);
}
