/* Meetings: nodes at one index that several bodies have, each with mass. Nodes that are tied together
 * count as their master, with the mass of all. */
#include "contact/contact.h"
#include "layout/tasks.h"

#include <math.h>

mpm_status mpmi_contact_prepare(const mpmi_layout *layout, const mpmi_settings *settings,
                                mpmi_pair_records *records) {
  const int32_t *body = layout->blocks.body;
  for (int64_t g = 0; g < layout->groups.count; ++g) {
    const mpmi_block_group group = layout->groups.group[g];
    for (int32_t i = group.first; i < group.first + group.count; ++i)
      for (int32_t j = i + 1; j < group.first + group.count; ++j) {
        const mpm_status status = mpmi_pair_add(records, settings->context, body[i], body[j]);
        if (status) return status;
      }
  }
  return MPM_OK;
}

/* ---- meetings and parties ------------------------------------------------------------------------------ */
static int32_t takes_part(const mpmi_contact_search *search, int64_t slot) {
  const mpmi_layout *layout = search->step->layout;
  return mpmi_constraints_is_free(&layout->constraints, slot) &&
         mpmi_mass_moving(layout, search->nodes, search->values, slot) > layout->mass_cut;
}

/* Goes through the meetings of a group; returns how many there are and adds the number of their parties. With
 * `fill` they are written from `meeting` and `party` on. */
static int64_t visit_group(const mpmi_contact_search *search, mpmi_block_group group, int32_t fill,
                           int64_t meeting, int64_t *party) {
  const mpmi_blocks *b = &search->step->layout->blocks;
  mpmi_contact_nodes *contact = search->contact;
  int64_t meetings = 0;
  for (int32_t n = 0; n < b->nodes; ++n) {
    int64_t parties = 0;
    for (int64_t i = group.first; i < group.first + group.count; ++i)
      parties += takes_part(search, i * b->nodes + n);
    if (parties < 2) continue;
    if (fill) contact->meeting[meeting + meetings] = (mpmi_meeting){*party, parties, 0, 0};
    ++meetings;
    for (int64_t i = group.first; i < group.first + group.count && fill; ++i) {
      const int64_t slot = i * b->nodes + n;
      if (!takes_part(search, slot)) continue;
      contact->party[*party] =
          (mpmi_party){.slot = slot, .body = b->body[i], .meeting = meeting + meetings - 1};
      ++*party;
    }
    if (!fill) *party += parties;
  }
  return meetings;
}

static void count_task(void *data, int64_t k) {
  const mpmi_contact_search *search = data;
  const mpmi_block_groups *groups = &search->step->layout->groups;
  const mpmi_share share = mpmi_share_of(search->step->settings, groups->count, k);
  for (int64_t g = share.begin; g < share.end; ++g) {
    int64_t *of = search->contact->group_count + 2 * g;
    of[1] = 0;
    of[0] = visit_group(search, groups->group[g], 0, 0, &of[1]);
  }
}

static void fill_task(void *data, int64_t k) {
  const mpmi_contact_search *search = data;
  const mpmi_block_groups *groups = &search->step->layout->groups;
  const mpmi_share share = mpmi_share_of(search->step->settings, groups->count, k);
  for (int64_t g = share.begin; g < share.end; ++g) {
    int64_t party = search->contact->group_count[2 * g + 1];
    visit_group(search, groups->group[g], 1, search->contact->group_count[2 * g], &party);
  }
}

static mpm_status find_parties(mpmi_contact_search *search) {
  const mpmi_settings *settings = search->step->settings;
  mpm_context *c = settings->context;
  mpmi_contact_nodes *contact = search->contact;
  const int64_t groups = search->step->layout->groups.count;
  mpm_status status = MPMI_RESERVE_MORE(c, contact->group_count, contact->group_capacity, 2 * groups);
  if (!status) status = mpmi_run_tasks(settings, 0, settings->tasks, count_task, search);
  if (status) return status;
  int64_t meetings = 0, parties = 0;
  for (int64_t g = 0; g < groups; ++g) {
    int64_t *of = contact->group_count + 2 * g;
    const int64_t has[2] = {of[0], of[1]};
    of[0] = meetings;
    of[1] = parties;
    meetings += has[0];
    parties += has[1];
  }
  contact->meeting_count = meetings;
  contact->party_count = parties;
  if ((status = MPMI_RESERVE_MORE(c, contact->meeting, contact->meeting_capacity, meetings)) ||
      (status = MPMI_RESERVE_MORE(c, contact->party, contact->party_capacity, parties)))
    return status;
  return mpmi_run_tasks(settings, 0, settings->tasks, fill_task, search);
}

/* ---- touches ------------------------------------------------------------------------------------------- */
/* Goes through the touches of all meetings; returns how many there are, and writes them with `fill`. */
static int64_t visit_pairs(const mpmi_contact_search *search, int32_t fill) {
  const mpmi_contact_rules *rules = &search->step->settings->contact;
  mpmi_contact_nodes *contact = search->contact;
  int64_t touches = 0;
  for (int64_t m = 0; m < contact->meeting_count; ++m) {
    mpmi_meeting *meeting = &contact->meeting[m];
    const int64_t end = meeting->first_party + meeting->party_count;
    meeting->first_touch = touches;
    for (int64_t a = meeting->first_party; a < end; ++a)
      for (int64_t b = a + 1; b < end; ++b) {
        mpmi_party *first = &contact->party[a], *second = &contact->party[b];
        double sign;
        const mpm_contact_desc *rule = mpmi_contact_rule_of(rules, first->body, second->body, &sign);
        if (rule->kind == MPM_CONTACT_NONE) continue;
        if (fill)
          contact->touch[touches] =
              (mpmi_touch){.party = {a, b},
                           .rule = rule,
                           .record = mpmi_pair_find(search->step->pairs, first->body, second->body),
                           .direction_sign = sign,
                           .gap = (double)INFINITY};
        first->cloud_count = second->cloud_count = 1; /* it needs them */
        ++touches;
      }
    meeting->touch_count = touches - meeting->first_touch;
  }
  return touches;
}

/* ---- clouds of masters and of the nodes that follow them ----------------------------------------------- */
/* On which axes a follower is the mirror image of its master: those that are not periodic, where their
 * indices differ. */
static int32_t mirrored_axes(const mpmi_blocks *b, int64_t master, int64_t follower) {
  int64_t of_master[3], index[3];
  int32_t axes = 0;
  mpmi_blocks_index(b, master, of_master);
  mpmi_blocks_index(b, follower, index);
  for (int32_t k = 0; k < b->grid->dim; ++k)
    if (!b->grid->desc.periodic[k] && index[k] != of_master[k]) axes |= 1 << k;
  return axes;
}

/* The axes across which a master is its own mirror image: it lies on a wall that holds it there. */
static int32_t own_images(const mpmi_blocks *b, const mpmi_tie *tie) {
  int64_t index[3];
  int32_t axes = 0;
  mpmi_blocks_index(b, tie->master, index);
  for (int32_t k = 0; k < b->grid->dim; ++k)
    if (tie->zero[k] &&
        (index[k] == mpmi_face_node(b->grid, 2 * k) || index[k] == mpmi_face_node(b->grid, 2 * k + 1)))
      axes |= 1 << k;
  return axes;
}

/* Lists the images of a cloud: one for each set of these axes but the empty one. Returns how many there are.
 */
static int64_t list_images(mpmi_cloud *cloud, int64_t source, int32_t axes, int32_t fill) {
  int64_t images = 0;
  for (int32_t set = 1; set < 8; ++set) {
    if (set & ~axes) continue;
    ++images;
    if (!fill) continue;
    cloud[images] = cloud[0];
    cloud[images].source = source;
    cloud[images].mirrored ^= set;
  }
  return images;
}

/* Lists the clouds of a party from `first` on, and returns how many there are. */
static int64_t list_party(const mpmi_contact_search *search, int64_t p, int64_t first, int32_t fill) {
  const mpmi_layout *layout = search->step->layout;
  const mpmi_constraints *constraints = &layout->constraints;
  mpmi_contact_nodes *contact = search->contact;
  const int64_t master = contact->party[p].slot;
  const int32_t tie = constraints->tie_of[master];
  const int64_t followers = tie < 0 ? 0 : constraints->tie[tie].count;
  const int32_t axes = tie < 0 ? 0 : own_images(&layout->blocks, &constraints->tie[tie]);
  int64_t count = 0;
  for (int64_t i = -1; i < followers; ++i) {
    const int64_t follower = i < 0 ? -1 : constraints->tie[tie].first + i;
    const int64_t slot = i < 0 ? master : constraints->follower[follower].slot;
    mpmi_cloud *cloud = fill ? &contact->cloud[first + count] : NULL;
    if (fill)
      *cloud = (mpmi_cloud){.slot = slot,
                            .party = p,
                            .source = first + count,
                            .follower = follower,
                            .mirrored = i < 0 ? 0 : mirrored_axes(&layout->blocks, master, slot)};
    count += 1 + list_images(cloud, first + count, axes, fill);
  }
  return count;
}

static int64_t list_clouds(const mpmi_contact_search *search, int32_t fill) {
  mpmi_contact_nodes *contact = search->contact;
  int64_t clouds = 0;
  for (int64_t p = 0; p < contact->party_count; ++p) {
    mpmi_party *party = &contact->party[p];
    if (!party->cloud_count) continue;
    const int64_t count = list_party(search, p, clouds, fill);
    if (fill) {
      party->first_cloud = clouds;
      party->cloud_count = count;
    }
    clouds += count;
  }
  return clouds;
}

/* Forgets the clouds of the last step, and writes those of this one. */
static mpm_status map_clouds(const mpmi_contact_search *search) {
  const mpmi_layout *layout = search->step->layout;
  mpmi_contact_nodes *contact = search->contact;
  const int64_t slots = mpmi_slots(layout);
  if (contact->mapped != layout->version) {
    const mpm_status status =
        MPMI_RESERVE_MORE(search->step->settings->context, contact->cloud_of, contact->map_capacity, slots);
    if (status) return status;
    for (int64_t i = 0; i < slots; ++i) contact->cloud_of[i] = -1;
    contact->mapped = layout->version;
  } else {
    for (int64_t i = 0; i < contact->cloud_count; ++i) contact->cloud_of[contact->cloud[i].slot] = -1;
  }
  contact->cloud_count = 0;
  return MPM_OK;
}

mpm_status mpmi_meetings_find(mpmi_contact_search *search) {
  mpm_context *c = search->step->settings->context;
  mpmi_contact_nodes *contact = search->contact;
  mpm_status status = map_clouds(search);
  if (!status) status = find_parties(search);
  if (status) return status;
  contact->touch_count = visit_pairs(search, 0);
  status = MPMI_RESERVE_MORE(c, contact->touch, contact->touch_capacity, contact->touch_count);
  if (status) return status;
  visit_pairs(search, 1);
  const int64_t clouds = list_clouds(search, 0);
  if (clouds > INT32_MAX)
    return mpmi_fail(c, MPM_E_NOMEM, "bodies meet at %lld nodes, more than %d", (long long)clouds, INT32_MAX);
  status = MPMI_RESERVE_MORE(c, contact->cloud, contact->cloud_capacity, clouds);
  if (status) return status;
  list_clouds(search, 1);
  contact->cloud_count = clouds;
  for (int64_t i = 0; i < clouds; ++i)
    if (contact->cloud[i].source == i) contact->cloud_of[contact->cloud[i].slot] = (int32_t)i;
  return MPM_OK;
}
