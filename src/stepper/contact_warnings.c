/* What the host is told of contact when it changes: bodies that overlap, and particles too large to tell
 * where a surface is. */
#include "stepper/stepper.h"

/* Overlaps deeper than this, in spacings, are told, and particles that are larger than one with this edge. */
static const double deep = 0.5, large = 0.6;

/* Contact pushes no overlap out, and so one that was there at first stays. */
static void tell_overlaps(mpm_stepper *s) {
  for (int64_t i = 0; i < s->history.pairs.count; ++i) {
    mpmi_pair_record *pair = &s->history.pairs.record[i];
    const int32_t overlaps = pair->last.gap < -deep * s->grid->h_min;
    if (overlaps && !pair->told && pair->a >= 0)
      mpmi_log(s->context, MPM_LOG_WARNING,
               "bodies %d and %d overlap by %g, more than half a cell: contact keeps them from going on, and "
               "does not push them apart",
               (int)pair->a, (int)pair->b, -pair->last.gap);
    else if (overlaps && !pair->told)
      mpmi_log(
          s->context, MPM_LOG_WARNING,
          "body %d overlaps an obstacle by %g, more than half a cell: contact keeps it from going on, and "
          "does not push it out",
          (int)pair->b, -pair->last.gap);
    pair->told = overlaps;
  }
}

/* Volumes of rings go with their radius, and tell nothing of their section. */
static void tell_large_particles(mpm_stepper *s) {
  double most = 1.0;
  int64_t count = 0, live = 0;
  if (s->layout.version == s->told_version || mpmi_is_axisymmetric(s->grid)) return;
  s->told_version = s->layout.version;
  for (int32_t k = 0; k < s->grid->dim; ++k) most *= large * s->grid->desc.spacing[k];
  for (int32_t m = 0; m < s->layout.member_count && s->history.pairs.count; ++m) {
    const mpm_particles *set = s->layout.member[m].set;
    const double *volume = mpmi_f64(set, MPMI_VOLUME, 0);
    const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
    live += set->count;
    for (int64_t p = 0; p < set->slots; ++p) count += id[p] >= 0 && volume[p] > most;
  }
  if (count != s->told_large && count)
    mpmi_log(
        s->context, MPM_LOG_INFO,
        "%lld of %lld particles have more than 0.6 of the edge of a cell: gaps between bodies need two or "
        "more across a cell",
        (long long)count, (long long)live);
  s->told_large = count;
}

void mpmi_contact_warn(mpm_stepper *s) {
  if (!s->history.pairs.count) return;
  tell_overlaps(s);
  tell_large_particles(s);
}
