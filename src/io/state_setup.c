/* The setup is the part of a state that must be the same in the stepper that loads it. */
#include "io/state.h"

#include <string.h>

static void same_axis(mpmi_archive *a, const char *what, int32_t axis, int64_t here) {
  char name[MPMI_TEXT];
  snprintf(name, sizeof name, "%s[%d]", what, (int)axis);
  mpmi_archive_same_int(a, name, here);
}

static void same_axis_real(mpmi_archive *a, const char *what, int32_t axis, double here) {
  char name[MPMI_TEXT];
  snprintf(name, sizeof name, "%s[%d]", what, (int)axis);
  mpmi_archive_same_real(a, name, here);
}

static void setup_grid(mpmi_archive *a, const mpm_grid_desc *d) {
  mpmi_archive_same_int(a, "dim", d->dim);
  mpmi_archive_same_int(a, "basis", d->basis);
  mpmi_archive_same_int(a, "boundary_basis", d->boundary_basis);
  for (int32_t k = 0; k < d->dim; ++k) {
    same_axis(a, "cells", k, d->cells[k]);
    same_axis(a, "periodic", k, d->periodic[k]);
    same_axis_real(a, "origin", k, d->origin[k]);
    same_axis_real(a, "spacing", k, d->spacing[k]);
  }
  mpmi_archive_same_real(a, "smoothing", d->basis == MPM_UGIMP ? d->smoothing : 0.0);
}

/* Compares what belongs to the scheme. The host may change forces, damping, boundary conditions and
 * tolerances. */
static void setup_scheme(mpmi_archive *a, const mpm_stepper_desc *d) {
  mpmi_archive_same_int(a, "scheme", d->scheme);
  mpmi_archive_same_int(a, "transfer", d->transfer);
  mpmi_archive_same_int(a, "xpic_order", mpmi_transfer_of(d->transfer)->most_order ? d->xpic_order : 0);
  mpmi_archive_same_int(a, "position_order", d->position_order);
  mpmi_archive_same_int(a, "locking_remedy", d->locking_remedy);
  mpmi_archive_same_int(a, "reference_positions", d->reference_positions);
  mpmi_archive_same_int(a, "quasi_static", d->quasi_static);
  mpmi_archive_same_int(a, "staggered", d->staggered);
}

/* Compares what setups may have from format 3 on; in older states it is 0. */
static void later_int(mpmi_archive *a, uint32_t format, const char *what, int32_t here) {
  if (format > 2)
    mpmi_archive_same_int(a, what, here);
  else if (here && !a->status)
    a->status = mpmi_fail(a->context, MPM_E_FORMAT, "the state is of an unlike setup: %s is 0 there, %d here",
                          what, (int)here);
}

static void setup_later(mpmi_archive *a, uint32_t format, const mpm_stepper *s) {
  later_int(a, format, "projected_positions", s->settings.desc.projected_positions);
  later_int(a, format, "geometry", s->grid->desc.geometry);
  later_int(a, format, "total_lagrangian", s->grid->desc.total_lagrangian);
}

void mpmi_state_archive_law(mpmi_archive *a, const mpm_material *material) {
  const mpmi_law *law = material->law;
  mpmi_archive_same_text(a, "law", law ? law->name : "custom");
  mpmi_archive_same_int(a, "state_count", material->state_count);
  for (int32_t k = 0; law && k < law->param_count; ++k)
    mpmi_archive_same_real(a, law->param[k].name, material->value[k]);
  mpmi_archive_same_real(a, "density", material->density);
}

static void archive_field(mpmi_archive *a, mpmi_state_field *field) {
  mpmi_archive_bytes(a, field->name, sizeof field->name);
  mpmi_archive_words(a, &field->type, sizeof *field - sizeof field->name);
}

void mpmi_state_write_field(mpmi_archive *a, const mpmi_field *field) {
  mpmi_state_field saved = {{0}, field->type, field->components, field->present};
  memcpy(saved.name, field->name, strlen(field->name));
  archive_field(a, &saved);
}

static void write_field_list(mpmi_archive *a, const mpm_particles *set) {
  int64_t count = set->field_count;
  mpmi_archive_words(a, &count, sizeof count);
  for (int32_t f = 0; f < set->field_count; ++f) mpmi_state_write_field(a, &set->field[f]);
}

int32_t mpmi_state_may_lack(const mpm_grid *grid, int32_t field) {
  if (field == MPMI_SIZE) return !mpmi_has_sizes(grid);
  if (field == MPMI_REFERENCE) return !mpmi_is_total_lagrangian(grid);
  return field == MPMI_ACCELERATION || field == MPMI_DILATION_RATIO || field == MPMI_L ||
         field == MPMI_PRESCRIBED || field == MPMI_APPLIED_FORCE;
}

mpm_status mpmi_state_refuse_field(mpmi_archive *a, const char *name, const char *what) {
  return mpmi_fail(a->context, MPM_E_FORMAT, "%s is of an unlike setup: %sfield \"%s\" %s", a->name, a->where,
                   name, what);
}

void mpmi_state_read_field(mpmi_archive *a, const mpm_particles *set, mpmi_state_set *to, uint64_t *found) {
  mpmi_state_field saved;
  archive_field(a, &saved);
  if (a->status) return;
  saved.name[MPMI_NAME - 1] = '\0';
  const int32_t f = mpmi_find_field(set, saved.name);
  if (f < 0) {
    a->status = mpmi_state_refuse_field(a, saved.name, "is there, but not here");
    return;
  }
  const mpmi_field *field = &set->field[f];
  char what[MPMI_NAME + 32];
  snprintf(what, sizeof what, "type of %s", field->name);
  if (saved.type != field->type || saved.components != field->components) {
    if (saved.components != field->components)
      snprintf(what, sizeof what, "number of components of %s", field->name);
    const int64_t there = saved.components != field->components ? saved.components : saved.type;
    const int32_t here = saved.components != field->components ? field->components : field->type;
    a->status = mpmi_fail(a->context, MPM_E_FORMAT, "%s is of an unlike setup: %s%s is %lld there, %d here",
                          a->name, a->where, what, (long long)there, (int)here);
  } else if (saved.present < 0 || saved.present > 1 || *found & UINT64_C(1) << f) {
    mpmi_archive_damaged(a, "its list of fields makes no sense");
  } else if (!mpmi_state_may_lack(set->grid, f) && saved.present != field->present) {
    a->status = mpmi_state_refuse_field(a, saved.name,
                                        saved.present ? "is there, but not here" : "is here, but not there");
  }
  *found |= UINT64_C(1) << f;
  to->present |= (uint64_t)(saved.present & 1) << f;
  to->field[to->field_count++] = f;
}

static void read_fields(mpmi_archive *a, const mpm_particles *set, mpmi_state_set *to) {
  int64_t count = 0;
  to->field_count = 0;
  to->present = 0;
  uint64_t found = 0;
  mpmi_archive_words(a, &count, sizeof count);
  if (count < 0 || count > MPMI_MAX_FIELDS) mpmi_archive_damaged(a, "its list of fields makes no sense");
  for (int64_t i = 0; i < count && !a->status; ++i) mpmi_state_read_field(a, set, to, &found);
  for (int32_t f = 0; f < set->field_count && !a->status; ++f)
    if (!(found & UINT64_C(1) << f))
      a->status = mpmi_state_refuse_field(a, set->field[f].name, "is here, but not there");
}
_Static_assert(MPMI_MAX_FIELDS <= 64, "one bit for each field");

void mpmi_state_setup(mpmi_archive *a, const mpm_stepper *s, uint32_t format, mpmi_state_set *set) {
  /* Library version and instruction set are for information only. */
  int64_t version = MPM_VERSION, isa = s->context->isa;
  mpmi_archive_words(a, &version, sizeof version);
  mpmi_archive_words(a, &isa, sizeof isa);
  setup_grid(a, &s->grid->desc);
  setup_scheme(a, &s->settings.desc);
  mpmi_archive_same_int(a, "number of sets", s->layout.member_count);
  for (int32_t m = 0; m < s->layout.member_count && !a->status; ++m) {
    snprintf(a->where, sizeof a->where, "set %d: ", (int)m);
    mpmi_state_archive_law(a, s->layout.member[m].set->material);
    if (set)
      read_fields(a, s->layout.member[m].set, &set[m]);
    else
      write_field_list(a, s->layout.member[m].set);
  }
  a->where[0] = '\0';
  setup_later(a, format, s);
}
