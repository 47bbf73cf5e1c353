#include "grid/constraints.h"

#include <string.h>

void mpmi_constraints_init(mpmi_constraints *c, mpm_context *context) {
  memset(c, 0, sizeof *c);
  c->context = context;
}

void mpmi_constraints_free(mpmi_constraints *c) {
  mpm_context *context = c->context;
  MPMI_FREE_ARRAY(context, c->tie, c->tie_capacity);
  MPMI_FREE_ARRAY(context, c->follower, c->follower_capacity);
  MPMI_FREE_ARRAY(context, c->contact, c->contact_capacity);
  MPMI_FREE_ARRAY(context, c->tie_of, c->map_capacity);
  mpmi_constraints_init(c, context);
}

/* An axis_role says how one axis binds a node. */
typedef struct axis_role {
  int64_t master;
  int32_t face;     /* wall that binds it, or -1 */
  int32_t mirrored; /* 1: a ghost, with sign -1 in the components that the wall reverses */
} axis_role;

static int32_t is_linear_wall(const mpmi_wall *wall) {
  return mpmi_wall_kind_of(wall->kind)->holds != MPMI_HOLDS_NOTHING;
}

static axis_role role_on_axis(const mpm_grid *grid, const mpmi_wall *wall, int32_t axis, int64_t node) {
  const int64_t cells = grid->desc.cells[axis];
  axis_role role = {node, -1, 0};
  if (grid->desc.periodic[axis]) {
    role.master = node % cells + (node % cells < 0 ? cells : 0);
    return role;
  }
  const int32_t low = 2 * axis, high = 2 * axis + 1;
  if (grid->ghosts && node == -1 && is_linear_wall(wall + low)) {
    role = (axis_role){1, low, 1};
  } else if (grid->ghosts && node == cells + 1 && is_linear_wall(wall + high)) {
    role = (axis_role){cells - 1, high, 1};
  }
  return role;
}

/* Returns the wall on whose plane a node lies, or -1. */
static int32_t plane_face(const mpm_grid *grid, const mpmi_wall *wall, int32_t axis, int64_t node) {
  if (grid->desc.periodic[axis]) return -1;
  for (int32_t face = 2 * axis; face < 2 * axis + 2; ++face)
    if (node == mpmi_face_node(grid, face) && is_linear_wall(wall + face)) return face;
  return -1;
}

static int32_t wall_takes(const mpmi_wall *wall, int32_t face, int32_t component) {
  return mpmi_wall_kind_of(wall[face].kind)->holds == MPMI_HOLDS_ALL || face / 2 == component;
}

typedef struct node_role {
  int64_t master[3];
  double sign[3];
  int32_t face[3]; /* wall that takes the reaction of a component, or -1 */
  int32_t follows;
} node_role;

/* The reaction of a component goes to the wall that faces it, else to the first that binds it. */
static void take(node_role *role, const mpmi_wall *wall, int32_t face, int32_t dim) {
  for (int32_t c = 0; c < dim; ++c)
    if (wall_takes(wall, face, c) && (role->face[c] < 0 || face / 2 == c)) role->face[c] = face;
}

static node_role role_of(const mpm_grid *grid, const mpmi_wall *wall, const int64_t *index) {
  node_role role = {{0, 0, 0}, {1.0, 1.0, 1.0}, {-1, -1, -1}, 0};
  for (int32_t k = 0; k < grid->dim; ++k) {
    axis_role axis = role_on_axis(grid, wall, k, index[k]);
    role.master[k] = axis.master;
    if (axis.master != index[k]) role.follows = 1;
    if (axis.face < 0) continue;
    take(&role, wall, axis.face, grid->dim);
    for (int32_t c = 0; c < grid->dim; ++c)
      if (axis.mirrored && wall_takes(wall, axis.face, c)) role.sign[c] = -role.sign[c];
  }
  return role;
}

/* Returns 1 when any node of the block can be bound: it reaches a plane, a ghost or a periodic image. */
static int32_t block_is_bound(const mpmi_blocks *b, const mpmi_wall *wall, int64_t block) {
  const mpm_grid *grid = b->grid;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const int64_t first = (int64_t)b->coord[block][k] * b->edge, last = first + b->edge - 1;
    const int64_t cells = grid->desc.cells[k];
    if (grid->desc.periodic[k]) {
      if (first < 0 || last >= cells) return 1;
    } else if ((mpmi_is_solid(&wall[2 * k]) && first <= 1) ||
               (mpmi_is_solid(&wall[2 * k + 1]) && last >= cells - 1)) {
      return 1;
    }
  }
  return 0;
}

/* A walk over all bound nodes is made once to count and once to fill. */
typedef struct walk {
  const mpmi_blocks *blocks;
  const mpmi_wall *wall;
  mpmi_constraints *out;
  int32_t fill;
  int64_t ties, followers, contacts;
} walk;

static int32_t body_of(const walk *w, int64_t slot) {
  return w->blocks->body[slot / w->blocks->nodes];
}

static int32_t tie_at(walk *w, int64_t master) {
  int32_t *of = w->out->tie_of + master;
  if (*of < 0) {
    *of = (int32_t)w->ties++;
    if (w->fill) {
      w->out->tie[*of] = (mpmi_tie){master, 0, 0, {0, 0, 0}, {0, 0, 0}, {-1, -1, -1}};
    }
  }
  return *of;
}

static void hold_on_planes(walk *w, mpmi_tie *tie, const int64_t *index) {
  const mpm_grid *grid = w->blocks->grid;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const int32_t face = plane_face(grid, w->wall, k, index[k]);
    if (face < 0) continue;
    tie->across[k] = 1;
    node_role taken = {{0}, {0}, {tie->face[0], tie->face[1], tie->face[2]}, 0};
    take(&taken, w->wall, face, grid->dim);
    for (int32_t c = 0; c < grid->dim; ++c) {
      tie->face[c] = taken.face[c];
      if (wall_takes(w->wall, face, c)) tie->zero[c] = 1;
    }
  }
}

static int32_t on_plane(walk *w, const int64_t *index) {
  for (int32_t k = 0; k < w->blocks->grid->dim; ++k)
    if (plane_face(w->blocks->grid, w->wall, k, index[k]) >= 0) return 1;
  return 0;
}

static void visit_linear(walk *w, int64_t slot, const int64_t *index) {
  const mpm_grid *grid = w->blocks->grid;
  const node_role role = role_of(grid, w->wall, index);
  if (!role.follows) {
    if (!on_plane(w, index)) return;
    const int32_t at = tie_at(w, slot);
    if (w->fill) hold_on_planes(w, &w->out->tie[at], index);
    return;
  }
  const int64_t master = mpmi_blocks_node(w->blocks, body_of(w, slot), role.master);
  if (master < 0) return; /* nothing can reach this ghost, because its mirror has no storage */
  const int32_t at = tie_at(w, master);
  w->out->tie_of[slot] = at;
  ++w->followers;
  if (!w->fill) return;
  mpmi_tie *tie = &w->out->tie[at];
  ++tie->count;
  hold_on_planes(w, tie, role.master);
  for (int32_t c = 0; c < grid->dim; ++c)
    if (role.face[c] >= 0 && (tie->face[c] < 0 || role.face[c] / 2 == c)) tie->face[c] = role.face[c];
}

/* Places the followers of each tie side by side, in the order of their slots. */
static void place_follower(walk *w, int64_t slot, const int64_t *index) {
  const node_role role = role_of(w->blocks->grid, w->wall, index);
  if (!role.follows || w->out->tie_of[slot] < 0) return;
  mpmi_tie *tie = &w->out->tie[w->out->tie_of[slot]];
  mpmi_follower *d = &w->out->follower[tie->first + tie->count++];
  d->slot = slot;
  memcpy(d->sign, role.sign, sizeof d->sign);
}

static void visit_contact(walk *w, int32_t face, int64_t slot, const int64_t *index) {
  const mpm_grid *grid = w->blocks->grid;
  const int32_t axis = face / 2;
  const int64_t plane = mpmi_face_node(grid, face), ghost = face % 2 ? plane + 1 : plane - 1;
  const int32_t is_ghost = grid->ghosts && index[axis] == ghost;
  if ((index[axis] != plane && !is_ghost) || !mpmi_constraints_is_free(w->out, slot)) return;
  mpmi_contact contact = {slot, -1, face};
  if (is_ghost) {
    int64_t mirror[3] = {index[0], index[1], index[2]};
    mirror[axis] = 2 * plane - ghost;
    contact.partner = mpmi_blocks_node(w->blocks, body_of(w, slot), mirror);
    if (contact.partner < 0) return;
  }
  if (w->fill) w->out->contact[w->contacts] = contact;
  ++w->contacts;
}

enum { VISIT_LINEAR, VISIT_PLACE, VISIT_CONTACTS };
static void visit_all(walk *w, int32_t what, int32_t face) {
  const mpmi_blocks *b = w->blocks;
  int64_t index[3] = {0, 0, 0};
  for (int64_t block = 0; block < b->count; ++block) {
    if (!block_is_bound(b, w->wall, block)) continue;
    for (int32_t n = 0; n < b->nodes; ++n) {
      const int64_t slot = block * b->nodes + n;
      mpmi_blocks_index(b, slot, index);
      if (what == VISIT_LINEAR) visit_linear(w, slot, index);
      if (what == VISIT_PLACE) place_follower(w, slot, index);
      if (what == VISIT_CONTACTS) visit_contact(w, face, slot, index);
    }
  }
}

static void clear_map(mpmi_constraints *c, const mpmi_blocks *b) {
  const int64_t slots = b->count * b->nodes;
  for (int64_t i = 0; i < slots; ++i) c->tie_of[i] = -1;
}

static void visit_contacts(walk *w) {
  w->contacts = 0;
  for (int32_t face = 0; face < 2 * w->blocks->grid->dim; ++face)
    if (mpmi_wall_kind_of(w->wall[face].kind)->rubs == MPMI_RUBS_NODES &&
        !w->blocks->grid->desc.periodic[face / 2])
      visit_all(w, VISIT_CONTACTS, face);
}

mpm_status mpmi_constraints_build(mpmi_constraints *c, const mpmi_blocks *b, const mpmi_wall *wall) {
  mpm_context *context = c->context;
  mpm_status status = MPMI_RESERVE_MORE(context, c->tie_of, c->map_capacity, b->count * b->nodes);
  if (status) return status;
  walk w = {b, wall, c, 0, 0, 0, 0};
  clear_map(c, b);
  visit_all(&w, VISIT_LINEAR, 0);
  if ((status = MPMI_RESERVE_MORE(context, c->tie, c->tie_capacity, w.ties)) ||
      (status = MPMI_RESERVE_MORE(context, c->follower, c->follower_capacity, w.followers)))
    return status;
  clear_map(c, b);
  w = (walk){b, wall, c, 1, 0, 0, 0};
  visit_all(&w, VISIT_LINEAR, 0);
  c->tie_count = w.ties;
  c->follower_count = w.followers;
  int64_t first = 0;
  for (int64_t i = 0; i < c->tie_count; ++i) {
    c->tie[i].first = first;
    first += c->tie[i].count;
    c->tie[i].count = 0;
  }
  visit_all(&w, VISIT_PLACE, 0);
  w.fill = 0;
  visit_contacts(&w);
  if ((status = MPMI_RESERVE_MORE(context, c->contact, c->contact_capacity, w.contacts))) return status;
  w.fill = 1;
  visit_contacts(&w);
  c->contact_count = w.contacts;
  return MPM_OK;
}

int32_t mpmi_constraints_is_free(const mpmi_constraints *c, int64_t slot) {
  return c->tie_of[slot] < 0 || c->tie[c->tie_of[slot]].master == slot;
}
