/* The host's coefficients of friction. It sees touches in batches of one pair of bodies, which do not depend
 * on how tasks share them. */
#include "boundary/surface_holds.h"
#include "contact/contact.h"

#include <math.h>

enum { RANGE = 256 };

typedef struct touch_list {
  int64_t n, touch[RANGE];
  double position[3 * RANGE], normal[3 * RANGE], slip[3 * RANGE], gap[RANGE], area[RANGE], pressure[RANGE];
  double friction[RANGE];
} touch_list;

static void show_touch(const mpmi_bound *bound, const mpmi_touch *touch, touch_list *list) {
  const mpmi_blocks *b = &bound->step->layout->blocks;
  const mpmi_party *party = bound->nodes->contact.party;
  const int64_t slot[2] = {party[touch->party[0]].slot, party[touch->party[1]].slot}, at = list->n;
  double u[3] = {0.0, 0.0, 0.0}, place[3], approach = 0.0, compliance = 0.0;
  double left[2][3];
  for (int32_t i = 0; i < 2; ++i) {
    for (int32_t k = 0; k < 3; ++k) left[i][k] = touch->normal[k];
    mpmi_surface_take_out(bound->nodes->surface_sites.site, party[touch->party[i]].site, left[i]);
  }
  mpmi_contact_position(b, &bound->nodes->contact, slot[0], place);
  for (int32_t k = 0; k < bound->dim; ++k) {
    u[k] = mpmi_velocity(bound->values, slot[1])[k] - mpmi_velocity(bound->values, slot[0])[k];
    approach += u[k] * touch->normal[k];
    for (int32_t i = 0; i < 2; ++i)
      compliance += party[touch->party[i]].inverse_mass[k] * touch->normal[k] * left[i][k];
    list->position[k * RANGE + at] = place[k];
    list->normal[k * RANGE + at] = touch->normal[k];
  }
  for (int32_t k = 0; k < bound->dim; ++k) list->slip[k * RANGE + at] = u[k] - approach * touch->normal[k];
  const int32_t apart = touch->gap > 0.0 && !mpmi_detects_by_velocity(touch->rule);
  const double closing = apart ? touch->gap / bound->step->dt : 0.0;
  const double impulse = compliance > 0.0 ? -(approach + closing) / compliance : 0.0;
  list->gap[at] = touch->gap;
  list->area[at] = touch->area;
  list->pressure[at] =
      impulse > 0.0 && touch->area > 0.0 ? impulse / (touch->area * bound->step->velocity_dt) : 0.0;
  list->friction[at] = touch->friction;
}

static void take_answers(mpmi_bound *bound, const touch_list *list, mpmi_failure *failure) {
  mpmi_contact_nodes *contact = &bound->nodes->contact;
  for (int64_t i = 0; i < list->n; ++i) {
    mpmi_touch *touch = &contact->touch[list->touch[i]];
    const double value = list->friction[i];
    if (value >= 0.0 && isfinite(value)) {
      if (value < touch->friction || value > touch->friction) touch->friction_static = value;
      touch->friction = value;
      continue;
    }
    const mpmi_party *party = &contact->party[touch->party[0]];
    mpmi_failure found = mpmi_node_failure(
        value < 0.0 ? MPM_E_CALLBACK : MPM_NONFINITE, &bound->step->layout->blocks, party->slot,
        value < 0.0 ? "the friction of the callback is negative" : "the friction of the callback not finite");
    found.body = party->body;
    mpmi_failure_take(failure, found);
  }
}

/* Asks about the touches of one pair of bodies in [begin, end). */
static void ask_pair(mpmi_bound *bound, int64_t begin, int64_t end, int64_t record, mpmi_failure *failure) {
  const mpmi_settings *settings = bound->step->settings;
  const mpmi_contact_nodes *contact = &bound->nodes->contact;
  const mpmi_pair_record *pair = &bound->step->pairs->record[record];
  touch_list list;
  list.n = 0;
  for (int64_t i = begin; i < end; ++i) {
    const mpmi_touch *touch = &contact->touch[i];
    if (touch->record != record || touch->open || touch->rule->kind != MPM_CONTACT_UNILATERAL || pair->a < 0)
      continue;
    list.touch[list.n] = i;
    show_touch(bound, touch, &list);
    ++list.n;
  }
  if (!list.n) return;
  const mpm_contact_batch batch = {.struct_size = sizeof batch,
                                   .dim = bound->dim,
                                   .body_a = pair->a,
                                   .body_b = pair->b,
                                   .n = list.n,
                                   .ld = RANGE,
                                   .t = bound->step->t,
                                   .dt = bound->step->dt,
                                   .position = list.position,
                                   .normal = list.normal,
                                   .gap = list.gap,
                                   .area = list.area,
                                   .slip = list.slip,
                                   .pressure = list.pressure};
  const mpm_status status =
      mpmi_from_host(settings->friction(settings->friction_user, &batch, list.friction));
  if (status)
    mpmi_failure_take(failure, mpmi_callback_failure(status, -1, "the friction callback"));
  else
    take_answers(bound, &list, failure);
}

static void ask_range(mpmi_bound *bound, int64_t begin, int64_t end, mpmi_failure *failure) {
  const mpmi_contact_nodes *contact = &bound->nodes->contact;
  for (int64_t i = begin; i < end; ++i) {
    int32_t asked = 0;
    for (int64_t j = begin; j < i; ++j) asked |= contact->touch[j].record == contact->touch[i].record;
    if (!asked) ask_pair(bound, begin, end, contact->touch[i].record, failure);
  }
}

static void ask_task(void *data, int64_t k) {
  mpmi_bound *bound = data;
  const int64_t count = bound->nodes->contact.touch_count;
  const mpmi_share share = mpmi_share_of(bound->step->settings, (count + RANGE - 1) / RANGE, k);
  for (int64_t r = share.begin; r < share.end; ++r)
    ask_range(bound, r * RANGE, (r + 1) * RANGE < count ? (r + 1) * RANGE : count,
              &bound->step->work->report[k].failure);
}

mpm_status mpmi_ask_friction(mpmi_bound *bound) {
  const mpmi_settings *settings = bound->step->settings;
  if (!settings->friction || !bound->nodes->contact.touch_count) return MPM_OK;
  const mpm_status status = mpmi_run_tasks(settings, 1, settings->tasks, ask_task, bound);
  return status ? status : mpmi_step_failure(bound->step);
}
