/* Contact of bodies at the nodes that they share, and with obstacles and friction walls (docs/theory.md,
 * contact): an impulse that closes the gap and never more, with Coulomb friction; ties; and the projections
 * without forces, which keep to what was found. An impulse acts on the nodes of one meeting alone, so that
 * meetings are independent of each other but for those of free obstacles, which are swept one after the
 * other. */
#include "boundary/surface_holds.h"
#include "contact/contact.h"
#include "simd/vector3.h"

#include <float.h>
#include <math.h>

/* Touches of one meeting are swept until what is left is this share of the first sweep. */
static const double settled = 1e-13;
/* What changes velocities by less than this share of their sizes is settled, too. */
static const double rounding = 4.0 * DBL_EPSILON;
enum { SWEEPS = 30, SWEEPS_OF_FREE = 1000 }; /* 30 are too few for a light obstacle on heavy nodes */

/* ---- parties ------------------------------------------------------------------------------------------- */
/* A surface counts by itself where it is free, and has no mass of its own else. */
static void weigh_party(const mpmi_bound *bound, mpmi_party *party, int32_t keeps) {
  if (party->surface >= 0) return;
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const int32_t tie = constraints->tie_of[party->slot];
  const double mass = mpmi_moving_mass(bound, party->slot);
  party->site = mpmi_surface_direction_at(bound, party->slot);
  for (int32_t c = 0; c < 3; ++c) {
    const int32_t held = c >= bound->dim || mpmi_held_by(bound->nodes, party->slot, c) ||
                         (tie >= 0 && constraints->tie[tie].zero[c]);
    party->inverse_mass[c] = held || !(mass > bound->step->layout->mass_cut) ? 0.0 : 1.0 / mass;
    if (!keeps) party->given[c] = party->pressed[c] = 0.0;
  }
}

/* Two parties as an impulse sees them: the velocity of the second relative to the first, and the change of
 * that for a unit impulse, by component; that of a free obstacle comes on top and couples components. */
typedef struct encounter {
  mpmi_party *party[2];
  mpmi_rigid_surface *surface, *free; /* the first party, or NULL */
  const mpmi_surface_site *site;      /* what the parties' sites are numbers of, or NULL: they have none */
  double velocity[3], compliance[3], of_surface[3];
  double speed; /* the sizes of both velocities, by which rounding is known */
} encounter;

/* Returns the velocity of a body at its node, or that of the copy of another part's. */
static double *party_velocity(const mpmi_bound *bound, mpmi_party *party) {
  return party->slot == MPMI_COPIED_PARTY ? party->copy : mpmi_velocity(bound->values, party->slot);
}

/* With keeps nothing pushes a free obstacle: its velocity is that of the step. */
static encounter encounter_of(mpmi_bound *bound, const mpmi_touch *touch, int32_t keeps) {
  const mpmi_contact_nodes *contact = &bound->nodes->contact;
  encounter e = {.party = {&contact->party[touch->party[0]], &contact->party[touch->party[1]]}};
  if (e.party[0]->surface >= 0) {
    e.surface = &contact->surface[e.party[0]->surface];
    mpmi_surface_velocity(e.surface, e.party[0]->arm, e.of_surface);
    if (!keeps && mpmi_is_free(e.surface)) e.free = e.surface;
  }
  if (e.party[0]->site >= 0 || e.party[1]->site >= 0) e.site = bound->nodes->surface_sites.site;
  for (int32_t c = 0; c < bound->dim; ++c) {
    if (e.surface) e.of_surface[c] += e.party[0]->own_velocity[c];
    const double first = e.surface ? e.of_surface[c] : party_velocity(bound, e.party[0])[c];
    const double second = party_velocity(bound, e.party[1])[c];
    e.velocity[c] = second - first;
    e.speed += fabs(first) + fabs(second);
    e.compliance[c] = e.party[0]->inverse_mass[c] + e.party[1]->inverse_mass[c];
  }
  return e;
}

/* Returns a change of the relative velocity, and 0 where it may be rounding: sweeps would never end. */
static double beyond_rounding(const encounter *e, double change) {
  return change > rounding * e->speed ? change : 0.0;
}

/* Finds by how much an impulse changes the relative velocity, but for a free obstacle. */
static void yield_to(const encounter *e, const double *impulse, double *change) {
  for (int32_t c = 0; c < 3; ++c) change[c] = e->compliance[c] * impulse[c];
  for (int32_t i = 0; i < 2 && e->site; ++i) {
    double left[3] = {impulse[0], impulse[1], impulse[2]};
    mpmi_surface_take_out(e->site, e->party[i]->site, left);
    for (int32_t c = 0; c < 3; ++c) change[c] -= e->party[i]->inverse_mass[c] * (impulse[c] - left[c]);
  }
}

static double of_free(const encounter *e, const double *n) {
  return e->free ? mpmi_rigid_compliance(e->free, e->party[0]->arm, n) : 0.0;
}

static double weighted(const encounter *e, const double *n) {
  if (e->site) {
    double change[3];
    yield_to(e, n, change);
    return mpmi_inner(n, change) + of_free(e, n);
  }
  return n[0] * n[0] * e->compliance[0] + n[1] * n[1] * e->compliance[1] + n[2] * n[2] * e->compliance[2] +
         of_free(e, n);
}

/* Gives an impulse to the second party, and its opposite to the first; returns the energy that it takes. */
static double give(mpmi_bound *bound, mpmi_touch *touch, const encounter *e, const double *impulse,
                   int32_t keeps) {
  const double back[3] = {-impulse[0], -impulse[1], -impulse[2]};
  double taken = 0.0, change[3], to[2][3];
  yield_to(e, impulse, change);
  for (int32_t i = 0; i < 2; ++i) {
    for (int32_t c = 0; c < 3; ++c) to[i][c] = i ? impulse[c] : back[c];
    mpmi_surface_take_out(e->site, e->site ? e->party[i]->site : -1, to[i]);
  }
  for (int32_t c = 0; c < bound->dim; ++c) {
    for (int32_t i = 0; i < 2; ++i) {
      const double by = to[i][c] * e->party[i]->inverse_mass[c];
      if (!(by < 0.0 || by > 0.0)) continue;
      if (e->party[i]->slot == MPMI_COPIED_PARTY) {
        e->party[i]->copy[c] += by;
      } else if (e->surface && e->surface->face >= 0) {
        mpmi_press_node(bound, e->party[i]->slot, c, by); /* a reaction of walls */
        if (!keeps) e->party[i]->pressed[c] += by;
      } else {
        mpmi_push_node(bound, e->party[i]->slot, c, by);
        if (!keeps) e->party[i]->given[c] += by;
      }
    }
    taken -= impulse[c] * (e->velocity[c] + 0.5 * change[c]);
  }
  if (keeps || !e->surface) return taken;
  const double half = 0.5 * of_free(e, impulse);
  touch->work -= half;
  for (int32_t c = 0; c < bound->dim; ++c)
    if (e->free || e->compliance[c] > 0.0) touch->work += impulse[c] * e->of_surface[c];
  if (e->free) mpmi_rigid_push(e->free, e->party[0]->arm, back);
  return taken - half;
}

/* Returns what a compliance must exceed: along a direction that a surface holds rounding is left of it. */
static double least_compliance(const encounter *e) {
  return e->site ? MPMI_NEARLY_HELD * fmax(fmax(e->compliance[0], e->compliance[1]), e->compliance[2]) : 0.0;
}

/* ---- one touch ----------------------------------------------------------------------------------------- */
static void tie_by(mpmi_bound *bound, mpmi_touch *touch, const encounter *e, const double *impulse) {
  touch->dissipation += give(bound, touch, e, impulse, 0);
  const double along = mpmi_inner(impulse, touch->normal);
  touch->normal_impulse += along;
  for (int32_t c = 0; c < bound->dim; ++c) touch->tangential[c] += impulse[c] - along * touch->normal[c];
}

/* Stops the whole relative velocity; returns the largest component of it that could be stopped. Free
 * obstacles and surfaces along which a body slides couple components: these are stopped one by one. */
static double tie(mpmi_bound *bound, mpmi_touch *touch) {
  encounter e = encounter_of(bound, touch, 0);
  double impulse[3] = {0.0, 0.0, 0.0}, stopped = 0.0;
  for (int32_t c = 0; c < bound->dim; ++c) {
    const double unit[3] = {c == 0, c == 1, c == 2}, compliance = weighted(&e, unit);
    if (!(compliance > least_compliance(&e))) continue;
    impulse[c] = -e.velocity[c] / compliance;
    stopped = fmax(stopped, beyond_rounding(&e, fabs(e.velocity[c])));
    if (!e.free && !e.site) continue;
    tie_by(bound, touch, &e, impulse);
    impulse[c] = 0.0;
    e = encounter_of(bound, touch, 0);
  }
  if (!e.free && !e.site) tie_by(bound, touch, &e, impulse);
  touch->closed = touch->stuck = e.free || weighted(&e, (const double[]){1.0, 1.0, 1.0}) > 0.0;
  touch->ambiguous = !touch->closed;
  return stopped;
}

/* Returns the tangential impulse after this sweep, by Coulomb's law, in `after`. */
static void rub(const mpmi_touch *touch, const encounter *e, double approach, double most, double most_stuck,
                double *after, int32_t *stuck) {
  double slip[3], squared = 0.0, size = 0.0;
  for (int32_t c = 0; c < 3; ++c) {
    slip[c] = e->velocity[c] - approach * touch->normal[c];
    squared += slip[c] * slip[c];
    after[c] = touch->tangential[c];
  }
  const double compliance = squared > 0.0 ? weighted(e, slip) / squared : 0.0;
  for (int32_t c = 0; c < 3; ++c) {
    if (compliance > 0.0) after[c] -= slip[c] / compliance;
    size += after[c] * after[c];
  }
  size = sqrt(size);
  *stuck = size <= most_stuck;
  for (int32_t c = 0; c < 3 && !*stuck; ++c) after[c] *= most / size;
}

/* Brings the normal impulse to a value. */
static double press(mpmi_bound *bound, mpmi_touch *touch, const encounter *e, double normal) {
  double impulse[3];
  for (int32_t c = 0; c < 3; ++c) impulse[c] = (normal - touch->normal_impulse) * touch->normal[c];
  touch->normal_impulse = normal;
  return give(bound, touch, e, impulse, 0);
}

/* Gives what an impulse of this sweep adds to friction, and what is left of the normal one. */
static double give_friction(mpmi_bound *bound, mpmi_touch *touch, const encounter *e, double normal,
                            const double *tangential) {
  double impulse[3], change[3], moved[3], rubbed = 0.0;
  for (int32_t c = 0; c < 3; ++c) {
    change[c] = tangential[c] - touch->tangential[c];
    impulse[c] = (normal - touch->normal_impulse) * touch->normal[c] + change[c];
  }
  touch->dissipation += give(bound, touch, e, impulse, 0);
  yield_to(e, impulse, moved);
  for (int32_t c = 0; c < bound->dim; ++c) {
    rubbed = fmax(rubbed, fabs(change[c]) * e->compliance[c]);
    touch->friction_work -= change[c] * (e->velocity[c] + 0.5 * moved[c]);
    touch->tangential[c] = tangential[c];
  }
  if (!e->free) return rubbed;
  touch->friction_work -= 0.5 * of_free(e, change);
  const double size = sqrt(mpmi_inner(change, change));
  return size > 0.0 ? weighted(e, change) / size : 0.0;
}

/* Returns by how much the friction of sliding slows the approach, for a unit normal impulse. Between free
 * nodes it is nothing. At a node that is held along an axis both impulses act along what is left to it:
 * each alone would stop it, and the normal one is to do what friction leaves. */
static double help_of_friction(const mpmi_touch *touch, const encounter *e, double approach, double most) {
  double slip[3], change[3], squared = 0.0;
  for (int32_t c = 0; c < 3; ++c) {
    slip[c] = e->velocity[c] - approach * touch->normal[c];
    squared += slip[c] * slip[c];
  }
  if (!(touch->friction > 0.0 && squared > 0.0)) return 0.0;
  yield_to(e, slip, change);
  const double helps = -touch->friction * mpmi_inner(touch->normal, change) / sqrt(squared);
  return helps > MPMI_NEARLY_HELD * most ? helps : 0.0;
}

/* Lets the bodies push each other. Impulses of further sweeps are added to those of the first, and only the
 * sum must push. Returns by how much velocities changed. */
static double push(mpmi_bound *bound, mpmi_touch *touch) {
  const mpm_contact_desc *rule = touch->rule;
  encounter e = encounter_of(bound, touch, 0);
  const double compliance = weighted(&e, touch->normal);
  const double most = fmax(fmax(e.compliance[0], e.compliance[1]), e.compliance[2]);
  double approach = mpmi_inner(e.velocity, touch->normal), rubbing[3];
  if (!(compliance > MPMI_NEARLY_HELD * most)) {
    touch->ambiguous = 1; /* both are held along the normal */
    return 0.0;
  }
  /* after an impulse the gap is 0 but for rounding, on which adhesion must not hang */
  const double hair = rule->adhesion > 0.0 ? 1e-6 * bound->step->settings->grid->h_min : 0.0;
  const int32_t apart = !mpmi_detects_by_velocity(rule) && touch->gap > hair;
  const double closing = apart ? touch->gap / bound->step->dt : 0.0;
  const double pull = apart ? 0.0 : rule->adhesion * touch->area * bound->step->velocity_dt;
  const double helps = e.free ? 0.0 : help_of_friction(touch, &e, approach, most);
  double normal = touch->normal_impulse - (approach + closing) / compliance;
  if (helps > 0.0) {
    yield_to(&e, touch->tangential, rubbing);
    normal = (compliance * touch->normal_impulse + mpmi_inner(touch->normal, rubbing) - helps * pull -
              approach - closing) /
             (compliance + helps);
  }
  normal = fmax(-pull, normal);
  const double moved = fabs(normal - touch->normal_impulse) * compliance;
  if (e.free) { /* it turns, too, and slips otherwise than before */
    touch->dissipation += press(bound, touch, &e, normal);
    e = encounter_of(bound, touch, 0);
    approach = mpmi_inner(e.velocity, touch->normal);
  }
  double tangential[3];
  rub(touch, &e, approach, touch->friction * (normal + pull), touch->friction_static * (normal + pull),
      tangential, &touch->stuck);
  /* with adhesion friction may act where nothing pushes */
  touch->closed = normal > 0.0 || normal < 0.0 || mpmi_inner(tangential, tangential) > 0.0;
  touch->stuck &= touch->closed;
  const double rubbed = give_friction(bound, touch, &e, normal, tangential);
  touch->normal_impulse = normal;
  return beyond_rounding(&e, fmax(moved, rubbed));
}

/* Keeps a touch as it was found, in a projection without forces: a closed one stays closed both ways. */
static double keep(mpmi_bound *bound, mpmi_touch *touch) {
  if (!touch->was_closed) return 0.0;
  const encounter e = encounter_of(bound, touch, 1);
  const double compliance = weighted(&e, touch->normal), approach = mpmi_inner(e.velocity, touch->normal);
  double impulse[3] = {0.0, 0.0, 0.0}, stopped = 0.0;
  for (int32_t c = 0; c < bound->dim; ++c) {
    const double unit[3] = {c == 0, c == 1, c == 2}, alone = touch->was_stuck ? weighted(&e, unit) : 0.0;
    if (touch->was_stuck && alone > least_compliance(&e)) {
      impulse[c] = -e.velocity[c] / alone;
      stopped = fmax(stopped, fabs(e.velocity[c]));
    } else if (!touch->was_stuck && compliance > least_compliance(&e)) {
      impulse[c] = -approach / compliance * touch->normal[c];
      stopped = fabs(approach);
    }
  }
  give(bound, touch, &e, impulse, 1);
  return beyond_rounding(&e, stopped);
}

/* ---- meetings ------------------------------------------------------------------------------------------ */
typedef struct contact_job {
  mpmi_bound *bound;
  int32_t keeps, round; /* MPMI_FIRST_ROUND ... */
} contact_job;

/* Returns 1 where leaders take part that light nodes have given to. */
static int32_t was_given(const mpmi_contact_nodes *contact, const mpmi_meeting *meeting) {
  int32_t leads = 0;
  for (int64_t p = 0; p < meeting->party_count; ++p) leads |= contact->party[meeting->first_party + p].leads;
  return leads;
}

/* Returns 1 where a light node takes part that goes with others. */
static int32_t is_led(const mpmi_contact_nodes *contact, const mpmi_touch *touch) {
  return contact->party[touch->party[0]].stays || contact->party[touch->party[1]].stays;
}

static double act_once(const contact_job *job, mpmi_touch *touch) {
  const int32_t last = job->round == MPMI_LAST_ROUND;
  if (job->keeps) return keep(job->bound, touch);
  if (touch->open || (last && is_led(&job->bound->nodes->contact, touch))) return 0.0;
  const double changed =
      touch->rule->kind == MPM_CONTACT_TIED ? tie(job->bound, touch) : push(job->bound, touch);
  if (last) return changed;
  touch->was_closed = touch->closed;
  touch->was_stuck = touch->stuck;
  return changed;
}

/* A touch between nodes that are free is settled at once. */
static int32_t is_settled_at_once(const mpmi_contact_nodes *contact, const mpmi_touch *touch, int32_t dim) {
  for (int32_t i = 0; i < 2; ++i) {
    const double *inverse = contact->party[touch->party[i]].inverse_mass;
    if (contact->party[touch->party[i]].site >= 0) return 0;
    for (int32_t c = 1; c < dim; ++c)
      if (inverse[c] < inverse[0] || inverse[c] > inverse[0]) return 0;
  }
  return 1;
}

static void begin_meeting(const contact_job *job, const mpmi_meeting *meeting) {
  mpmi_contact_nodes *contact = &job->bound->nodes->contact;
  if (job->round != MPMI_FIRST_ROUND) return;
  for (int64_t p = 0; p < meeting->party_count && job->keeps; ++p)
    weigh_party(job->bound, &contact->party[meeting->first_party + p], 1);
  for (int64_t i = 0; i < meeting->touch_count && !job->keeps; ++i) {
    mpmi_touch *touch = &contact->touch[meeting->first_touch + i];
    touch->closed = touch->stuck = touch->was_closed = touch->was_stuck = 0;
    touch->normal_impulse = touch->dissipation = touch->friction_work = touch->work = 0.0;
    touch->tangential[0] = touch->tangential[1] = touch->tangential[2] = 0.0;
  }
}

static double sweep_once(const contact_job *job, int64_t first, int64_t count) {
  const mpmi_contact_nodes *contact = &job->bound->nodes->contact;
  double most = 0.0;
  for (int64_t i = first; i < first + count; ++i) most = fmax(most, act_once(job, &contact->touch[i]));
  return most;
}

/* Sweeps touches until they are settled; returns by how much the first sweep changed velocities. */
static double sweep_touches(const contact_job *job, int64_t begin, int64_t count) {
  const mpmi_contact_nodes *contact = &job->bound->nodes->contact;
  const int32_t once = count == 1 && is_settled_at_once(contact, &contact->touch[begin], job->bound->dim);
  double first = 0.0;
  for (int32_t sweep = 0; sweep < SWEEPS; ++sweep) {
    const double most = sweep_once(job, begin, count);
    if (!sweep) first = most;
    if (!(most > settled * first) || once) break;
  }
  return first;
}

/* Touches that share no body are settled by themselves, as if the others were not there. In a projection
 * without forces nothing couples meetings. */
static double sweep_meeting(const contact_job *job, const mpmi_meeting *meeting) {
  double first = 0.0;
  if (!meeting->touch_count || (meeting->coupled && !job->keeps)) return 0.0;
  if (job->round == MPMI_LAST_ROUND && !(meeting->own && was_given(&job->bound->nodes->contact, meeting)))
    return 0.0;
  begin_meeting(job, meeting);
  if (!meeting->independent) return sweep_touches(job, meeting->first_touch, meeting->touch_count);
  for (int64_t i = 0; i < meeting->touch_count; ++i)
    first = fmax(first, sweep_touches(job, meeting->first_touch + i, 1));
  return first;
}

/* Sweeps the meetings of free obstacles together, in their order. */
static double sweep_listed(const contact_job *job) {
  const mpmi_contact_nodes *contact = &job->bound->nodes->contact;
  double first = 0.0;
  for (int64_t i = 0; i < contact->coupled_count; ++i)
    begin_meeting(job, &contact->meeting[contact->coupled[i]]);
  for (int32_t sweep = 0; sweep < SWEEPS_OF_FREE; ++sweep) {
    double most = 0.0;
    for (int64_t i = 0; i < contact->coupled_count; ++i) {
      const mpmi_meeting *meeting = &contact->meeting[contact->coupled[i]];
      most = fmax(most, sweep_once(job, meeting->first_touch, meeting->touch_count));
    }
    if (!sweep) first = most;
    if (!(most > settled * first)) break;
  }
  return first;
}

/* Does so with those of other parts, which are gone afterwards. */
static mpm_status sweep_coupled(const contact_job *job, double *first) {
  mpmi_contact_nodes *contact = &job->bound->nodes->contact;
  const int64_t meetings = contact->meeting_count, parties = contact->party_count,
                touches = contact->touch_count;
  const mpm_status status = mpmi_coupled_gather(job->bound);
  if (!status) *first = sweep_listed(job);
  contact->meeting_count = meetings;
  contact->party_count = parties;
  contact->touch_count = touches;
  return status;
}

static void sweep_task(void *data, int64_t k) {
  const contact_job *job = data;
  const mpmi_contact_nodes *contact = &job->bound->nodes->contact;
  const mpmi_share share = mpmi_share_of(job->bound->step->settings, contact->meeting_count, k);
  double most = 0.0;
  for (int64_t m = share.begin; m < share.end; ++m)
    most = fmax(most, sweep_meeting(job, &contact->meeting[m]));
  job->bound->step->work->report[k].contact_change = most;
}

mpm_status mpmi_body_contacts_find(mpmi_bound *bound) {
  mpmi_contact_nodes *contact = &bound->nodes->contact;
  mpmi_contact_search search = {
      .step = bound->step, .nodes = bound->nodes, .values = bound->values, .contact = contact};
  mpm_status status = MPM_OK;
  mpmi_rigid_surfaces_predict(contact, bound->step->settings, bound->step->velocity_dt);
  if (!contact->site_count) return MPM_OK;
  if (!contact->listed) {
    status = mpmi_sites_measure(&search);
    if (!status) status = mpmi_meetings_find(&search);
    if (!status && contact->touch_count) status = mpmi_clouds_fill(&search);
    if (!status && contact->touch_count) status = mpmi_surface_gaps_find(&search);
    contact->listed = !status;
  }
  if (status || !contact->touch_count) return status;
  if ((status = mpmi_gaps_find(&search))) return status;
  for (int64_t p = 0; p < contact->party_count; ++p) weigh_party(bound, &contact->party[p], 0);
  return mpmi_ask_friction(bound);
}

mpm_status mpmi_body_contacts_find_after(mpmi_bound *bound, double moved) {
  enum { FARTHEST = 1 << 20 }; /* that is beyond all blocks */
  mpmi_contact_search search = {.step = bound->step,
                                .nodes = bound->nodes,
                                .values = bound->values,
                                .contact = &bound->nodes->contact,
                                .copy = 1,
                                .moved = (int64_t)fmin(moved, FARTHEST)};
  const mpm_status status = mpmi_surface_gaps_find_after(&search);
  return status ? status : mpmi_gaps_find_after(&search);
}

mpm_status mpmi_body_contacts_act(mpmi_bound *bound, int32_t keeps, int32_t round, double *most) {
  const mpmi_settings *settings = bound->step->settings;
  contact_job job = {bound, keeps, round};
  *most = 0.0;
  mpm_status status = MPM_OK;
  if (mpmi_bodies_touch(bound)) status = mpmi_run_tasks(settings, 0, settings->tasks, sweep_task, &job);
  if (!status && !keeps && round != MPMI_LAST_ROUND) status = sweep_coupled(&job, most);
  if (status || !mpmi_bodies_touch(bound)) return status;
  for (int32_t k = 0; k < settings->tasks; ++k)
    *most = fmax(*most, bound->step->work->report[k].contact_change);
  return MPM_OK;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* Work of the host on nodes, in the exact sum of the step. */
static void add_host_work(const mpmi_bound *bound, double work) {
  mpmi_exact_add(&bound->step->work->tally.sum[MPMI_TALLY_WORK], work);
}

/* What holds a component of a node takes the impulse on it, and does work where it moves the node. */
static void add_work(mpmi_bound *bound, const mpmi_party *party, double sign, const double *impulse) {
  for (int32_t c = 0; c < bound->dim && party->surface < 0; ++c)
    if (mpmi_held_by(bound->nodes, party->slot, c))
      add_host_work(bound, -sign * impulse[c] * bound->nodes->held_value[party->slot][c]);
}

/* Surfaces that prescribe push back: what contact gives to what they hold is a part of their impulse. books:
 * the work counts here. */
static void tell_sites(mpmi_bound *bound, const mpmi_party *party, double sign, const double *impulse,
                       int32_t books) {
  if (party->surface >= 0 || !mpmi_surfaces_hold(bound->step->settings)) return;
  mpmi_surface_sites *sites = &bound->nodes->surface_sites;
  for (int32_t at = sites->last[party->slot]; at >= 0; at = sites->site[at].before) {
    mpmi_surface_site *site = &sites->site[at];
    const double along = site->slides ? mpmi_inner(site->vector, impulse) : 0.0;
    if (books) add_host_work(bound, -sign * along * site->value);
    for (int32_t c = 0; c < bound->dim; ++c)
      site->impulse[c] -= sign * (site->holds[c] ? impulse[c] : along * site->vector[c]);
  }
}

/* The impulse is on the second party. Bodies are turned about the origin, a surface about its centre, by the
 * opposite. */
static void add_torque(const mpmi_bound *bound, const mpmi_party *first, const mpmi_party *second,
                       const double *impulse, mpmi_whole_sum *sums) {
  double x[3] = {0.0, 0.0, 0.0}, about[3];
  if (first->surface < 0)
    mpmi_contact_position(&bound->step->layout->blocks, &bound->nodes->contact, second->slot, x);
  for (int32_t k = 0; k < 3 && first->surface >= 0; ++k) x[k] = -first->arm[k];
  mpmi_cross(x, impulse, about);
  for (int32_t c = 0; c < 3; ++c) mpmi_exact_add(&sums[MPMI_PAIR_MOMENT + c], about[c]);
}

/* sums: of the pair where this part books what happens at the node, else NULL. */
static void add_impulse(mpmi_bound *bound, const mpmi_touch *touch, mpmi_whole_sum *sums) {
  const mpmi_tally *tally = &bound->step->work->tally;
  const mpmi_contact_nodes *contact = &bound->nodes->contact;
  const mpmi_party *pair[2] = {&contact->party[touch->party[0]], &contact->party[touch->party[1]]};
  const mpmi_rigid_surface *surface = pair[0]->surface < 0 ? NULL : &contact->surface[pair[0]->surface];
  double impulse[3];
  for (int32_t c = 0; c < 3; ++c) {
    const int32_t moves = pair[0]->inverse_mass[c] > 0.0 || pair[1]->inverse_mass[c] > 0.0 ||
                          (c < bound->dim && surface && mpmi_is_free(surface));
    impulse[c] = moves ? touch->normal_impulse * touch->normal[c] + touch->tangential[c] : 0.0;
  }
  tell_sites(bound, pair[0], -1.0, impulse, sums != NULL);
  tell_sites(bound, pair[1], 1.0, impulse, sums != NULL);
  if (!sums) return;
  for (int32_t c = 0; c < 3; ++c) {
    mpmi_exact_add(&sums[MPMI_PAIR_IMPULSE + c], impulse[c]);
    if (surface && surface->face >= 0)
      mpmi_exact_add(&tally->sum[MPMI_TALLY_FACES + 3 * surface->face + c], impulse[c]);
  }
  add_work(bound, pair[0], -1.0, impulse);
  add_work(bound, pair[1], 1.0, impulse);
  add_torque(bound, pair[0], pair[1], impulse, sums);
  mpmi_exact_add(&sums[MPMI_PAIR_NORMAL], touch->normal_impulse);
  mpmi_exact_add(&sums[MPMI_PAIR_AREA], touch->area);
  const double force = touch->normal_impulse / bound->step->velocity_dt;
  double *most = &bound->step->pairs->record[touch->record].now.pressure_max;
  if (touch->area > 0.0) *most = fmax(*most, force / touch->area);
}

void mpmi_body_contacts_sum(mpmi_bound *bound) {
  const mpmi_contact_nodes *contact = &bound->nodes->contact;
  const mpmi_tally *tally = &bound->step->work->tally;
  mpm_step_info *info = &bound->step->info;
  for (int64_t m = 0; m < contact->meeting_count; ++m) {
    const mpmi_meeting *meeting = &contact->meeting[m];
    int32_t closed = 0;
    const int32_t books =
        mpmi_owns_node(bound->step->layout->parts, contact->party[meeting->first_party].slot);
    for (int64_t i = meeting->first_touch; i < meeting->first_touch + meeting->touch_count; ++i) {
      const mpmi_touch *touch = &contact->touch[i];
      if (!books) {
        if (touch->closed) add_impulse(bound, touch, NULL);
        continue;
      }
      mpmi_pair_sums *counts = &bound->step->pairs->record[touch->record].now;
      mpmi_whole_sum *sums = mpmi_tally_pair(tally, touch->record);
      ++counts->nodes;
      counts->closed += touch->closed;
      counts->stuck += touch->stuck;
      counts->ambiguous += touch->ambiguous;
      counts->gap = fmin(counts->gap, touch->gap);
      mpmi_exact_add(&sums[MPMI_PAIR_DISSIPATION], touch->dissipation);
      mpmi_exact_add(&sums[MPMI_PAIR_FRICTION_WORK], touch->friction_work);
      mpmi_exact_add(&tally->sum[MPMI_TALLY_CONTACT], touch->dissipation);
      closed |= touch->closed;
      add_host_work(bound, touch->work);
      if (touch->closed) add_impulse(bound, touch, sums);
    }
    info->contact_nodes += closed;
  }
}
