/* The stepper: one grid, its nodes, many sets, one scheme. What it is made of has a room of its own:
 *
 *   layout/     what the host has set; the sorted layout; the nodes of a velocity field; the step under way;
 *               sums over particles on nodes
 *   contact/    where bodies and surfaces meet
 *   boundary/   the conditions on nodal velocities
 *   stages/     particles to nodes, the nodes' own part, nodes to particles
 *   adaption/   splitting and merging of particles
 *   implicit/   Newton's method for the displacements of the nodes
 *   stepper/    the handle; steps as sequences of stages; commit, roll-back and reports */
#ifndef MPMI_STEPPER_H
#define MPMI_STEPPER_H

#include "context/checks.h"
#include "adaption/adaption.h"
#include "contact/contact.h"
#include "heat/heat.h"
#include "layout/nodes.h"
#include "layout/step.h"

/* What the prescribed particles of a set did to the material: impulses in the last step, and in all steps
 * since the set was added or the time was set. */
typedef struct mpmi_reaction {
  double impulse[3], impulse_total[3];
} mpmi_reaction;

/* Sums over all committed steps since the stepper was made or its time was set. */
typedef struct mpmi_totals {
  double impulse_by_face[6][3], external_work, damping_dissipation;
} mpmi_totals;

/* What one step leaves to the next, and to reports: the state beside that of the particles. */
typedef struct mpmi_history {
  double t;
  int64_t step, removed;
  double previous_dt;   /* dt of the last step, for the next one's mean; 0: none */
  double controller_dt; /* the most that mpm_advance takes for dt; 0: no such bound */
  int32_t has_sums;     /* the sums are those of the present state */
  mpmi_sums sums;
  mpm_step_info last; /* info of the last step */
  int32_t has_reactions;
  double impulse_by_face[6][3], reaction_dt; /* on the walls in the last step */
  mpmi_reaction *reaction;                   /* [sets] */
  int64_t reaction_capacity;
  mpmi_totals totals;
  mpmi_pair_records pairs; /* of bodies that ever were near each other */
  mpmi_heat_history heat;
} mpmi_history;

enum { MPMI_NODE_VIEWS = 8 };

/* A step that takes one thread less than this, in seconds, is as soon over on one: what particles and nodes
 * have is in the caches of the thread that had them last. Results do not depend on it. */
#define MPMI_SHORT_STEP 70e-6
/* Whether steps take one thread less than `bound`, as far as is known, and then are made by one. `left` more
 * that take several threads less come before one step shows how long one thread takes. Where that is not
 * short, the next `wait` is twice as long. */
enum { MPMI_SHORT_STEPS = 64, MPMI_MOST_STEPS = 4096 };
typedef struct mpmi_pace {
  double bound;
  int32_t is_short, left, wait;
} mpmi_pace;

struct mpm_stepper {
  uint32_t magic;
  int32_t mapped; /* views of nodal fields that are out */
  mpm_context *context;
  mpm_grid *grid;
  mpmi_settings settings;
  mpmi_layout layout;
  mpmi_nodes nodes;
  mpmi_workspace work;
  struct mpmi_newton *newton; /* memory of implicit steps, or NULL */
  mpmi_heat *heat;            /* memory of heat, or NULL: no set was ever described */
  mpmi_adaption *adaption;    /* [sets] */
  int64_t adaption_capacity;
  mpmi_profile profile;
  mpmi_step step; /* the one under way, if any */
  mpmi_history history;
  mpmi_pace pace;
  int64_t told_version, told_large; /* layout in which large particles were counted; how many there were */
  int32_t told_unstable;            /* the last equilibrium was told not to be stable */
  mpmi_view_record view[MPMI_NODE_VIEWS];
  void *view_memory[MPMI_NODE_VIEWS];
  size_t view_bytes[MPMI_NODE_VIEWS];
  int64_t *active; /* slots of active nodes shown by the views */
  int64_t active_count, active_capacity;
};

/* Returns MPM_E_STATE while a step is under way. */
static inline mpm_status mpmi_stepper_idle(const mpm_stepper *s) {
  if (s->step.phase == MPMI_IDLE) return MPM_OK;
  return mpmi_fail(s->context, MPM_E_STATE, "a step is under way: end or abort it first");
}
static inline mpm_status mpmi_check_face(const mpm_stepper *s, int32_t face) {
  if (face >= 0 && face < 2 * s->grid->dim) return MPM_OK;
  return mpmi_fail(s->context, MPM_E_ARG, "face is %d: a %d-D grid has 0 ... %d", (int)face,
                   (int)s->grid->dim, 2 * (int)s->grid->dim - 1);
}

/* What sets, obstacles and surfaces ask of the stepper that has them (reports.c). */
extern const mpmi_owner mpmi_stepper_owns;

/* ---- description.c ----------------------------------------------------------------------------------- */
/* Reads the host's description, or the defaults for NULL, and checks it for a grid. */
mpm_status mpmi_description_read(mpm_context *c, const mpm_grid *grid, const mpm_stepper_desc *desc,
                                 mpm_stepper_desc *out);

/* ---- contact_settings.c ------------------------------------------------------------------------------ */
/* Refuses bodies that touch in implicit steps; with_body: of a set that is about to be added, or -1. */
mpm_status mpmi_check_bodies(const mpm_stepper *s, const mpm_stepper_desc *desc, int32_t with_body);
/* Checks the values of a rule, whose bodies are named in the refusal. */
mpm_status mpmi_contact_desc_check(const mpm_grid *grid, int32_t a, int32_t b, const mpm_contact_desc *desc);

/* ---- contact_reports.c ------------------------------------------------------------------------------- */
/* Empty what a step will write; make it what the last step did, which cannot fail; forget sums over steps. */
void mpmi_pairs_begin(mpmi_pair_records *pairs);
/* Takes what the sums of the step have come to. */
void mpmi_pairs_total(mpmi_pair_records *pairs, const mpmi_tally *tally);
void mpmi_pairs_commit(mpmi_pair_records *pairs);
void mpmi_pairs_forget(mpmi_pair_records *pairs);
/* Adds what a pair did to a report; sign is -1 where the body that is asked about is the first one. */
void mpmi_pair_tell(const mpmi_pair_record *record, double sign, double dt, mpm_contact_info *info);

/* ---- host_settings.c --------------------------------------------------------------------------------- */
/* Returns MPM_E_STATE where a loaded state had motion callbacks that the host has not set again. */
mpm_status mpmi_motions_are_set(const mpm_stepper *s);

/* ---- obstacles.c ------------------------------------------------------------------------------------- */
/* Lets all obstacles go. */
void mpmi_obstacles_release(mpm_stepper *s);
/* Finds velocities for the step that begins, at first without contact; finds the poses after it, which may
 * fail; and makes these the state, which cannot. */
mpm_status mpmi_obstacles_begin(mpmi_step *step, mpmi_contact_nodes *contact);
mpm_status mpmi_obstacles_end(const mpmi_step *step, const mpmi_contact_nodes *contact);
void mpmi_obstacles_commit(const mpmi_obstacles *list);

/* ---- surfaces.c -------------------------------------------------------------------------------------- */
/* Lets all surfaces go. */
void mpmi_surfaces_release(mpm_stepper *s);
/* Makes room for a step, and copies of the markers for it to work on; makes these the state, which cannot
 * fail. */
mpm_status mpmi_surfaces_prepare(const mpmi_settings *settings);
void mpmi_surfaces_commit(const mpmi_surfaces *list);
/* Forgets sums over steps. */
void mpmi_surfaces_forget(const mpmi_surfaces *list);

/* ---- state_sums.c ------------------------------------------------------------------------------------ */
/* Brings the sums of the history up to date; failure takes the refusal of a law, and may be NULL. */
mpm_status mpmi_state_sums(mpm_stepper *s, mpmi_failure *failure);
/* Finds the largest stable step: Courant's condition, and those of viscosity, heat and obstacles
 * (collective). */
mpm_status mpmi_stable_dt(const mpm_stepper *s, double *dt);
/* Returns MPM_E_STATE when a set has views out of the given access, or holds bad values. */
mpm_status mpmi_check_sets(mpm_stepper *s, int32_t access);

/* ---- reports.c --------------------------------------------------------------------------------------- */
/* Fills in the info of the state and of a step: the last one, or the one under way. */
void mpmi_fill_info(const mpm_stepper *s, const mpm_step_info *last, mpm_step_info *info);
/* Gives the host the info of a call that ends with this status, which stays the status of the call unless
 * only the writing fails. info may be NULL. */
mpm_status mpmi_give_info(const mpm_stepper *s, mpm_status status, mpm_step_info *info);
/* Makes the check that writing makes, for calls that must know before they do anything. */
mpm_status mpmi_check_info(const mpm_stepper *s, const mpm_step_info *info);
/* The largest stable step of the present state, or why there is none. */
mpm_status mpmi_tell_stable_dt(mpm_stepper *s, double *dt);

/* ---- explicit.c -------------------------------------------------------------------------------------- */
/* Brings particles to nodes, with their forces. */
mpm_status mpmi_explicit_begin(mpmi_step *step, mpmi_nodes *nodes);
/* Solves for the velocities of the nodes, under walls and prescribed velocities. */
mpm_status mpmi_explicit_grid(mpmi_step *step, mpmi_nodes *nodes);
/* Returns how many sums on nodes an explicit step has made when it has come to a phase; MPMI_IDLE: to its
 * end. */
int64_t mpmi_explicit_exchanges(const mpmi_step *step, const mpmi_nodes *nodes, int32_t phase);
/* Finds when in the step parts settle contact together. */
void mpmi_explicit_accords(const mpmi_step *step, const mpmi_nodes *nodes);
/* Brings nodes back to particles. USL: everything from the updated nodal velocity. MUSL: L from the velocity
 * that the new particles give the nodes. USF has its strain already. */
mpm_status mpmi_explicit_end(mpmi_step *step, mpmi_nodes *nodes);
/* Moves surfaces with the nodes, once that is done on all parts (collective). */
mpm_status mpmi_explicit_move_surfaces(mpmi_step *step, mpmi_nodes *nodes);

/* ---- heat.c ------------------------------------------------------------------------------------------ */
/* The heat of a set is no longer described. */
void mpmi_heat_take_off(mpm_stepper *s, int32_t m);

/* ---- adaption.c -------------------------------------------------------------------------------------- */
/* A step begins at whose end sets may adapt (collective, as what follows). */
mpm_status mpmi_adaption_begin(mpm_stepper *s);
/* Finds what sets are split and merged at the end of the step under way, and makes room for it. */
mpm_status mpmi_adaption_prepare(mpm_stepper *s);
/* Does it to the present state; cannot fail. */
void mpmi_adaption_carry_out(mpm_stepper *s);

/* ---- commit.c ---------------------------------------------------------------------------------------- */
/* Commits the step; cannot fail. Adds the host's work to the balance. */
void mpmi_commit(mpm_stepper *s, const mpmi_sums *sums);
/* Before that: adds up what the step will report, on all parts, and gives the sums of the new state. */
mpm_status mpmi_add_up(mpm_stepper *s, mpmi_sums *sums);
/* Makes the volumes again, which alone were overwritten. */
void mpmi_roll_back(mpm_stepper *s);

/* ---- contact_warnings.c ------------------------------------------------------------------------------ */
/* Logs what is new since the last step. */
void mpmi_contact_warn(mpm_stepper *s);

/* ---- stability_warning.c ----------------------------------------------------------------------------- */
/* Tells the host of a quasi-static step that has ended in an equilibrium that is not stable, where the step
 * before had not. */
void mpmi_stability_warn(mpm_stepper *s);

/* ---- make_step.c ------------------------------------------------------------------------------------- */
/* Makes a whole step, unless checks before it have come to another status than MPM_OK. is_cut: the step is
 * mpm_advance()'s own. On failure the particles are as before, and the info of the last step says why. */
mpm_status mpmi_make_step(mpm_stepper *s, mpm_status status, double dt, int32_t is_cut);

#endif
