/* Meetings: nodes at one index that several bodies have, each with mass, or one body and a surface that binds
 * the node. Nodes that are tied together count as their master, with the mass of all. */
#include "contact/contact.h"
#include "layout/tasks.h"

#include <math.h>

/* ---- meetings and parties ------------------------------------------------------------------------------ */
static int32_t takes_part(const mpmi_contact_search *search, int64_t slot) {
  const mpmi_layout *layout = search->step->layout;
  return mpmi_constraints_is_free(&layout->constraints, slot) &&
         mpmi_mass_moving(layout, search->nodes, search->values, slot) > layout->mass_cut;
}

/* Returns the value of a row of a near surface at a node of its site. */
static double near_value(const mpmi_contact_search *search, int64_t near, int32_t row, int32_t n) {
  const int32_t nodes = search->step->layout->blocks.nodes;
  return search->contact->near_value[(near * MPMI_NEAR_ROWS + row) * nodes + n];
}

static mpmi_party party_of_surface(const mpmi_contact_search *search, int64_t near, int32_t n) {
  const mpmi_blocks *b = &search->step->layout->blocks;
  const mpmi_near *of = &search->contact->near_surface[near];
  const mpmi_rigid_surface *surface = &search->contact->surface[of->surface];
  mpmi_party party = {.slot = -1, .body = mpmi_code_of(surface), .surface = of->surface, .site = -1};
  double x[3] = {0.0, 0.0, 0.0};
  mpmi_contact_position(b, search->contact, (int64_t)of->block * b->nodes + n, x);
  mpmi_surface_arm(surface, x, party.arm);
  for (int32_t k = 0; k < 3; ++k) {
    party.normal[k] = near_value(search, near, MPMI_NEAR_NORMAL + k, n);
    party.own_velocity[k] = near_value(search, near, MPMI_NEAR_VELOCITY + k, n);
  }
  return party;
}

/* Goes through the meetings of a site; returns how many there are and adds the number of their parties. With
 * `fill` they are written from `meeting` and `party` on: bodies, then surfaces. */
static int64_t visit_site(const mpmi_contact_search *search, const mpmi_site *site, int32_t fill,
                          int64_t meeting, int64_t *party) {
  const mpmi_blocks *b = &search->step->layout->blocks;
  mpmi_contact_nodes *contact = search->contact;
  const int64_t end = site->blocks.first + site->blocks.count;
  const int64_t end_near = site->first_near + site->near_count;
  const mpmi_parts *parts = search->step->layout->parts;
  const int32_t leads = !mpmi_is_implicit(search->step->settings); /* light nodes, across parts */
  int64_t meetings = 0;
  for (int32_t n = 0; n < b->nodes; ++n) {
    int64_t bodies = 0, surfaces = 0;
    int32_t counts = 0, own = 0; /* here, and not only for other parts */
    for (int64_t i = site->blocks.first; i < end; ++i) {
      if (end - i + bodies + site->near_count < 2) break; /* too few are left for a meeting */
      if (!takes_part(search, i * b->nodes + n)) continue;
      own |= mpmi_meets_node(parts, i * b->nodes + n);
      counts |= own || (leads && mpmi_meets_at_node(parts, i * b->nodes + n));
      ++bodies;
    }
    for (int64_t i = site->first_near; i < end_near && counts; ++i)
      surfaces += near_value(search, i, MPMI_NEAR_DISTANCE, n) < (double)INFINITY;
    if (!counts || bodies + surfaces < 2) continue;
    const int64_t number = meeting + meetings++;
    if (fill)
      contact->meeting[number] = (mpmi_meeting){.first_party = *party,
                                                .party_count = bodies + surfaces,
                                                .key = b->key[site->blocks.first],
                                                .place = n,
                                                .own = own};
    for (int64_t i = site->blocks.first; i < end && fill; ++i) {
      const int64_t slot = i * b->nodes + n;
      if (!takes_part(search, slot)) continue;
      contact->party[*party] =
          (mpmi_party){.slot = slot, .body = b->body[i], .surface = -1, .site = -1, .meeting = number};
      ++*party;
    }
    for (int64_t i = site->first_near; i < end_near && fill; ++i) {
      if (!(near_value(search, i, MPMI_NEAR_DISTANCE, n) < (double)INFINITY)) continue;
      contact->party[*party] = party_of_surface(search, i, n);
      contact->party[*party].meeting = number;
      ++*party;
    }
    if (!fill) *party += bodies + surfaces;
  }
  return meetings;
}

static void count_task(void *data, int64_t k) {
  const mpmi_contact_search *search = data;
  const mpmi_contact_nodes *contact = search->contact;
  const mpmi_share share = mpmi_share_of(search->step->settings, contact->site_count, k);
  for (int64_t g = share.begin; g < share.end; ++g) {
    int64_t *of = contact->site_sum + 2 * g;
    of[1] = 0;
    of[0] = visit_site(search, &contact->site[g], 0, 0, &of[1]);
  }
}

static void fill_task(void *data, int64_t k) {
  const mpmi_contact_search *search = data;
  const mpmi_contact_nodes *contact = search->contact;
  const mpmi_share share = mpmi_share_of(search->step->settings, contact->site_count, k);
  for (int64_t g = share.begin; g < share.end; ++g) {
    int64_t party = contact->site_sum[2 * g + 1];
    visit_site(search, &contact->site[g], 1, contact->site_sum[2 * g], &party);
  }
}

static mpm_status find_parties(mpmi_contact_search *search) {
  const mpmi_settings *settings = search->step->settings;
  mpm_context *c = settings->context;
  mpmi_contact_nodes *contact = search->contact;
  const int64_t sites = contact->site_count;
  mpm_status status = MPMI_RESERVE_MORE(c, contact->site_sum, contact->sum_capacity, 2 * sites);
  if (!status) status = mpmi_run_tasks(settings, 0, settings->tasks, count_task, search);
  if (status) return status;
  int64_t meetings = 0, parties = 0;
  for (int64_t g = 0; g < sites; ++g) {
    int64_t *of = contact->site_sum + 2 * g;
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
/* Two parties that may act on each other; a is a surface or the lower body. Returns 0 where they do not. */
static int32_t find_pair(const mpmi_contact_search *search, int64_t a, int64_t b, mpmi_touch *touch) {
  const mpmi_contact_nodes *contact = search->contact;
  const mpmi_party *first = &contact->party[a], *second = &contact->party[b];
  *touch = (mpmi_touch){.party = {a, b}, .direction_sign = 1.0, .gap = (double)INFINITY};
  touch->rule = first->surface >= 0 ? &contact->surface[first->surface].rule
                                    : mpmi_contact_rule_of(&search->step->settings->contact, first->body,
                                                           second->body, &touch->direction_sign);
  if (touch->rule->kind == MPM_CONTACT_NONE) return 0;
  touch->record = mpmi_pair_find(search->step->pairs, first->body, second->body);
  return 1;
}

static int32_t is_independent(const mpmi_contact_nodes *contact, const mpmi_meeting *meeting) {
  if (meeting->touch_count < 2) return 1;
  const mpmi_touch *touch = contact->touch + meeting->first_touch;
  for (int64_t i = 0; i < meeting->touch_count; ++i)
    for (int64_t j = i + 1; j < meeting->touch_count; ++j)
      for (int32_t side = 0; side < 2; ++side)
        if (touch[j].party[side] == touch[i].party[1] ||
            (touch[j].party[side] == touch[i].party[0] && contact->party[touch[i].party[0]].surface < 0))
          return 0;
  return 1;
}

/* Goes through the touches of all meetings, those of bodies first; returns how many there are, and writes
 * them with `fill`. */
static int64_t visit_pairs(const mpmi_contact_search *search, int32_t fill) {
  mpmi_contact_nodes *contact = search->contact;
  int64_t touches = 0;
  for (int64_t m = 0; m < contact->meeting_count; ++m) {
    mpmi_meeting *meeting = &contact->meeting[m];
    const int64_t end = meeting->first_party + meeting->party_count;
    int64_t bodies = meeting->first_party;
    while (bodies < end && contact->party[bodies].surface < 0) ++bodies;
    meeting->first_touch = touches;
    for (int64_t i = meeting->first_party; i < end; ++i)
      for (int64_t j = i < bodies ? i + 1 : meeting->first_party; j < bodies; ++j) {
        mpmi_touch touch;
        if (!find_pair(search, i, j, &touch)) continue;
        if (fill) contact->touch[touches] = touch;
        contact->party[i].cloud_count = contact->party[j].cloud_count = 1; /* the touch needs their clouds */
        const int32_t surface = contact->party[i].surface;
        meeting->coupled |= surface >= 0 && mpmi_is_free(&contact->surface[surface]);
        ++touches;
      }
    meeting->touch_count = touches - meeting->first_touch;
    if (fill) meeting->independent = is_independent(contact, meeting);
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

/* Returns 1 when a wall holds that node of a body which lies on the plane of a face next to `index`. */
static int32_t holds_across(const mpmi_contact_search *search, int32_t body, const int64_t *index,
                            int32_t face) {
  const mpmi_blocks *b = &search->step->layout->blocks;
  const mpmi_constraints *constraints = &search->step->layout->constraints;
  int64_t at[3] = {index[0], index[1], index[2]};
  at[face / 2] = mpmi_face_node(b->grid, face);
  const int64_t slot = mpmi_blocks_node(b, body, at);
  const int32_t tie = slot < 0 ? -1 : constraints->tie_of[slot];
  return tie >= 0 && constraints->tie[tie].zero[face / 2] != 0;
}

/* Finds the image, behind walls that hold, of a node a cell off them. Each digit of `set`, to base 3, says of
 * an axis whether the image lies there, behind the lower wall or behind the upper one. Returns its slot, or
 * -1; mirrored: bits of the axes. */
static int64_t image_beyond(const mpmi_contact_search *search, int64_t slot, int32_t set, int32_t *mirrored) {
  const mpmi_blocks *b = &search->step->layout->blocks;
  const mpm_grid *grid = b->grid;
  const int32_t body = b->body[slot / b->nodes];
  int64_t index[3], at[3];
  mpmi_blocks_index(b, slot, index);
  for (int32_t k = 0; k < 3; ++k) at[k] = index[k];
  *mirrored = 0;
  for (int32_t k = 0; set; ++k, set /= 3) {
    if (!(set % 3)) continue;
    if (k >= grid->dim || grid->desc.periodic[k]) return -1;
    const int32_t upper = set % 3 - 1, face = 2 * k + upper;
    const int64_t plane = mpmi_face_node(grid, face);
    if (index[k] != plane + (upper ? -1 : 1) || !holds_across(search, body, index, face)) return -1;
    at[k] = 2 * plane - index[k];
    *mirrored |= 1 << k;
  }
  return mpmi_blocks_node(b, body, at);
}

/* Lists a cloud and its images, and returns how many there are. The linear basis has no ghosts, but its
 * clouds reach beyond walls that hold as those of smooth bases do. */
static int64_t list_node(const mpmi_contact_search *search, const mpmi_cloud *node, int64_t first,
                         int32_t own, int32_t fill) {
  const mpm_grid *grid = search->step->layout->blocks.grid;
  const int32_t sets = grid->family == MPMI_FAMILY_BSPLINE1 ? 27 : 1;
  int64_t count = 0;
  for (int32_t set = 0; set < sets; ++set) {
    int32_t mirrored = 0;
    const int64_t slot = set ? image_beyond(search, node->slot, set, &mirrored) : node->slot;
    if (slot < 0) continue;
    mpmi_cloud *cloud = fill ? &search->contact->cloud[first + count] : NULL;
    if (fill) {
      *cloud = *node;
      cloud->slot = slot;
      cloud->source = first + count;
      cloud->mirrored ^= mirrored;
      if (set) cloud->follower = -1;
    }
    count += 1 + list_images(cloud, first + count, own, fill);
  }
  return count;
}

/* Lists the clouds of a party from `first` on, and returns how many there are. */
static int64_t list_party(const mpmi_contact_search *search, int64_t p, int64_t first, int32_t fill) {
  const mpmi_layout *layout = search->step->layout;
  const mpmi_constraints *constraints = &layout->constraints;
  const int64_t master = search->contact->party[p].slot;
  const int32_t tie = constraints->tie_of[master];
  const int64_t followers = tie < 0 ? 0 : constraints->tie[tie].count;
  const int32_t axes = tie < 0 ? 0 : own_images(&layout->blocks, &constraints->tie[tie]);
  int64_t count = 0;
  for (int64_t i = -1; i < followers; ++i) {
    const int64_t follower = i < 0 ? -1 : constraints->tie[tie].first + i;
    const int64_t slot = i < 0 ? master : constraints->follower[follower].slot;
    const mpmi_cloud node = {.slot = slot,
                             .party = p,
                             .follower = follower,
                             .mirrored = i < 0 ? 0 : mirrored_axes(&layout->blocks, master, slot)};
    count += list_node(search, &node, first + count, axes, fill);
  }
  return count;
}

static int64_t list_clouds(const mpmi_contact_search *search, int32_t fill) {
  mpmi_contact_nodes *contact = search->contact;
  int64_t clouds = 0;
  for (int64_t p = 0; p < contact->party_count; ++p) {
    mpmi_party *party = &contact->party[p];
    if (!party->cloud_count || party->surface >= 0) continue;
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
    return mpmi_fail(c, MPM_E_NOMEM, "bodies and surfaces meet at %lld nodes, more than %d",
                     (long long)clouds, INT32_MAX);
  status = MPMI_RESERVE_MORE(c, contact->cloud, contact->cloud_capacity, clouds);
  if (status) return status;
  list_clouds(search, 1);
  contact->cloud_count = clouds;
  for (int64_t i = 0; i < clouds; ++i)
    if (contact->cloud[i].source == i) contact->cloud_of[contact->cloud[i].slot] = (int32_t)i;
  return MPM_OK;
}
