/* What holds nodes in an implicit step: the residual of their balance is the force of the constraint. It is
 * booked as boundary.c does: to the host and to prescribed particles what acts on the components that they
 * hold, the rest of a tie to the wall that binds it. */
#include "stepper/boundary.h"
#include "stepper/newton.h"

#include <string.h>

/* Force of constraints on one node, its own inertia among what they balance. */
static double reaction_on(const mpm_stepper *s, const mpmi_active_node *node, int32_t c, double dt) {
  const mpmi_newton *w = s->newton;
  const int64_t at = (int64_t)node->row * s->grid->dim + c;
  double force = w->force[4 * node->slot + c] - w->external[4 * node->slot + c];
  if (mpmi_is_dynamic(s))
    force += s->node[8 * node->slot + 3] * node->sign[c] * mpmi_newmark_acceleration(s, dt, at);
  return force;
}

/* One component of one row: the nodes that move with it. */
static void book_row(mpm_stepper *s, int64_t row, int32_t c, double dt) {
  const mpmi_newton *w = s->newton;
  double total = 0.0, along = 0.0;
  for (int64_t m = w->members_start[row]; m < w->members_start[row + 1]; ++m) {
    const mpmi_active_node *node = &w->active[w->members[m]];
    const double impulse = dt * reaction_on(s, node, c, dt);
    s->impulse[6 * node->slot + c] = impulse;
    if (s->node[8 * node->slot + 3] > 0.0)
      s->impulse[6 * node->slot + 3 + c] = impulse / s->node[8 * node->slot + 3];
    total += impulse;
    along += node->sign[c] * impulse;
  }
  const int64_t slot = w->active[w->members[w->members_start[row]]].slot;
  const int32_t tie = s->constraints.tie_of[slot];
  const int64_t master = tie < 0 ? slot : s->constraints.tie[tie].master;
  if (s->holds && s->held[3 * master + c])
    s->prescribed_work += along * s->held_value[3 * master + c];
  else if (tie < 0)
    s->impulse[6 * slot + c] = s->impulse[6 * slot + 3 + c] =
        0.0; /* nothing holds it: this is what the iterations have left */
  else if (s->constraints.tie[tie].face[c] >= 0)
    s->impulse_in_step[s->constraints.tie[tie].face[c]][c] += total;
}

mpm_status mpmi_book_reactions(mpm_stepper *s, double dt) {
  const mpmi_newton *w = s->newton;
  if (!s->impulses) return MPM_OK;
  memset(s->impulse, 0, (size_t)(6 * s->blocks.count * s->blocks.nodes) * sizeof *s->impulse);
  for (int64_t r = 0; r < w->matrix.rows; ++r)
    for (int32_t c = 0; c < s->grid->dim; ++c) book_row(s, r, c, dt);
  if (!s->prescription.any) return MPM_OK;
  const mpmi_boundary f = {.s = s, .nodes = s->node, .dt = dt, .values = 8, .dim = s->grid->dim};
  return mpmi_prescribed_share(&f);
}
