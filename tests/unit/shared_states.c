/* States of one problem in several parts: saved by any number of parts and loaded by any other, a problem
 * goes on as if it had not stopped. Parts are threads (parts.h), where Check's macros may not be used: every
 * part keeps what it has found, which is compared afterwards. */
#include "old_format.h"
#include "parts.h"
#include "shared_states.h"
#include "world.h"

enum { MOST_PARTS = 5, MOST_STEPS = 40, MOST_PIECES = 8, TEXT = 400 };

/* What is saved, and how it goes on. */
enum { SAVE = 1, LOAD = 2, BOTH = 3 }; /* BOTH: neither; all steps at once */

typedef struct outcome {
  mpm_status status;
  char text[TEXT];
  uint64_t loaded_hash, hash;
  mpm_step_info loaded, info;
  double reaction[6][3];
  int64_t sorts[MOST_STEPS + 1]; /* after so many steps */
  uint64_t hashes[MOST_STEPS + 1];
  mpm_step_info infos[MOST_STEPS + 1];
  int64_t own; /* particles of this part after loading */
} outcome;

typedef struct story story;
typedef mpm_status (*story_fn)(world *w, const story *is, int32_t part);
typedef mpm_status (*event_fn)(world *w, const story *is, int32_t part, int32_t step);
struct story {
  world_desc desc;
  story_fn set_up;
  event_fn event; /* before a step; or NULL */
  double speed, dt;
  int32_t steps, saved_at, what, parts;
  int32_t stamp; /* of the host's fields to begin with */
  saved_state piece[MOST_PIECES];
  int32_t pieces;
  mpm_surface *surface[MOST_PARTS];
  mpm_obstacle *obstacle[MOST_PARTS];
  outcome found[MOST_PARTS];
};

static mpm_status fill(world *w, mpm_particles *set, double from, double to) {
  const double size = w->desc.grid.spacing[0] * (double)w->desc.grid.cells[0];
  const double low[] = {from * size, from * size, from * size}, high[] = {to * size, to * size, to * size};
  const int32_t per_cell[] = {2, 2, 2};
  return mpm_particles_fill_box(set, low, high, per_cell, NULL, NULL);
}

/* A spin and a drift, so that particles change their blocks; host fields that follow from the ids. */
static mpm_status give_values(world *w, mpm_particles *set, const story *is) {
  const int64_t n = mpm_particles_count(set);
  const int32_t dim = w->dim;
  double *x = calloc((size_t)(n * dim + 1), 2 * sizeof *x), *v = x + n * dim;
  int64_t *id = calloc((size_t)n + 1, sizeof *id);
  uint8_t *colour = calloc((size_t)n + 1, 3);
  const double middle = 0.5 * w->desc.grid.spacing[0] * (double)w->desc.grid.cells[0];
  mpm_status status = mpm_particles_get(set, "position", MPM_F64, dim, n, NULL, x);
  if (!status) status = mpm_particles_get(set, "id", MPM_I64, 1, n, NULL, id);
  for (int64_t p = 0; p < n && !status; ++p) {
    const double across = dim > 1 ? x[n + p] - middle : 0.0;
    v[p] = is->speed * (1.0 + across);
    if (dim > 1) v[n + p] = is->speed * (0.4 - x[p] + middle);
    if (dim > 2) v[2 * n + p] = -0.3 * is->speed;
    for (int32_t c = 0; c < 3; ++c) colour[c * n + p] = (uint8_t)(id[p] * is->stamp + c);
    id[p] = 3 * id[p] + is->stamp;
  }
  if (!status) status = mpm_particles_set(set, "velocity", MPM_F64, dim, n, NULL, v);
  if (!status) status = mpm_particles_add_field(set, "label", MPM_I64, 1);
  if (!status) status = mpm_particles_add_field(set, "colour", MPM_U8, 3);
  if (!status) status = mpm_particles_set(set, "label", MPM_I64, 1, n, NULL, id);
  if (!status) status = mpm_particles_set(set, "colour", MPM_U8, 3, n, NULL, colour);
  free(x), free(id), free(colour);
  return status;
}

static mpm_status set_walls(world *w, int32_t low, int32_t high) {
  mpm_status status = MPM_OK;
  for (int32_t face = 0; face < 2 * w->dim && !status; ++face)
    if (!w->desc.grid.periodic[face / 2])
      status = mpm_stepper_set_wall(w->stepper, face, face % 2 ? high : low, 0.0);
  return status;
}

static mpm_status set_up(world *w, const story *is, int32_t part) {
  (void)part;
  mpm_status status = set_walls(w, MPM_WALL_FIXED, MPM_WALL_SLIP);
  for (int32_t m = 0; m < w->sets && !status; ++m) status = fill(w, w->set[m], 0.2 + 0.4 * m, 0.6 + 0.2 * m);
  for (int32_t m = 0; m < w->sets && !status; ++m) status = give_values(w, w->set[m], is);
  return status;
}

/* ---- what is played ------------------------------------------------------------------------------------ */
static mpm_status steps(world *w, const story *is, int32_t part, int32_t from, int32_t to, outcome *found) {
  mpm_status status = MPM_OK;
  for (int32_t i = from; i < to && !status; ++i) {
    if (is->event && (i > from || from == 0)) status = is->event(w, is, part, i);
    if (!status) status = mpm_step(w->stepper, is->dt * (0.2 + 0.1 * (i % 3)), &w->info);
    if (is->what != BOTH || status) continue;
    found->infos[i + 1].struct_size = sizeof found->infos[i + 1];
    status = mpm_stepper_info(w->stepper, &found->infos[i + 1]);
    if (!status) status = mpm_state_hash(w->stepper, &found->hashes[i + 1]);
    found->sorts[i + 1] = found->infos[i + 1].resorts;
  }
  return status;
}

static mpm_status save(world *w, saved_state *to) {
  mpm_status status = mpm_state_size(w->stepper, &to->bytes);
  if (status) return status;
  to->data = malloc((size_t)to->bytes);
  return mpm_state_save(w->stepper, to->data, to->bytes);
}

/* The pieces that fall to a part: it gives those from first on. */
static mpm_status load(world *w, const story *is, int32_t part) {
  const int32_t first = is->pieces * part / is->parts, last = is->pieces * (part + 1) / is->parts;
  const void *piece[MOST_PIECES];
  int64_t bytes[MOST_PIECES];
  for (int32_t i = first; i < last; ++i) {
    piece[i - first] = is->piece[i].data;
    bytes[i - first] = is->piece[i].bytes;
  }
  return mpm_state_load_pieces(w->stepper, last - first, piece, bytes);
}

static mpm_status play(world *w, story *is, int32_t part, outcome *found) {
  mpm_status status = is->set_up(w, is, part);
  w->info.struct_size = sizeof w->info;
  if (is->what == BOTH && !status) {
    if (!(is->dt > 0.0)) status = mpm_stable_dt(w->stepper, &is->dt);
    if (!status) status = steps(w, is, part, 0, is->steps, found);
  } else if (is->what == SAVE && !status) {
    status = steps(w, is, part, 0, is->saved_at, found);
    if (!status && is->event && is->saved_at) status = is->event(w, is, part, is->saved_at);
    if (!status) status = save(w, &is->piece[part]);
  } else if (!status) {
    status = mpm_step(w->stepper, 0.1 * is->dt, NULL); /* it has a history of its own, which goes */
    if (!status) status = load(w, is, part);
    found->loaded.struct_size = sizeof found->loaded;
    if (!status) status = mpm_stepper_info(w->stepper, &found->loaded);
    if (!status) status = mpm_state_hash(w->stepper, &found->loaded_hash);
    for (int32_t m = 0; m < w->sets; ++m) found->own += mpm_particles_count(w->set[m]);
    if (!status) status = steps(w, is, part, is->saved_at, is->steps, found);
  }
  found->info.struct_size = sizeof found->info;
  if (!status) status = mpm_stepper_info(w->stepper, &found->info);
  if (!status) status = mpm_state_hash(w->stepper, &found->hash);
  for (int32_t face = 0; face < 2 * w->dim && !status && found->info.step > 0; ++face)
    status = mpm_stepper_wall_reaction(w->stepper, face, found->reaction[face]);
  return status;
}

static void live(int32_t part, const mpm_transport *transport, void *user) {
  story *is = user;
  outcome *found = &is->found[part];
  world w;
  memset(&w, 0, sizeof w);
  w.desc = is->desc;
  w.desc.context.transport = transport;
  found->status = world_try_open(&w);
  if (!found->status) found->status = play(&w, is, part, found);
  if (found->status) snprintf(found->text, sizeof found->text, "%s", mpm_last_error(w.context));
  if (is->surface[part] &&
      (mpm_stepper_remove_surface(w.stepper, is->surface[part]) || mpm_surface_destroy(is->surface[part])))
    found->status = MPM_E_INTERNAL;
  if (is->obstacle[part] && (mpm_stepper_remove_obstacle(w.stepper, is->obstacle[part]) ||
                             mpm_obstacle_destroy(is->obstacle[part])))
    found->status = MPM_E_INTERNAL;
  is->surface[part] = NULL, is->obstacle[part] = NULL;
  if (world_try_close(&w) && !found->status) found->status = MPM_E_INTERNAL;
}

static void run(story *is, int32_t what, int32_t parts, const char *name) {
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  memset(is->found, 0, sizeof is->found);
  is->what = what;
  is->parts = parts;
  if (parts == 1)
    live(0, NULL, is);
  else if (parts_run(parts, live, is, &plan))
    ck_abort_msg("%s, %d parts: %s", name, parts, plan.text);
  for (int32_t r = 0; r < parts; ++r)
    if (is->found[r].status)
      ck_abort_msg("%s, part %d of %d: %s: %s", name, r, parts, mpm_status_name(is->found[r].status),
                   is->found[r].text);
  if (what == SAVE) is->pieces = parts;
}

static void drop_pieces(story *is) {
  for (int32_t i = 0; i < is->pieces; ++i) free(is->piece[i].data);
  is->pieces = 0;
}

static const int32_t part_numbers[] = {1, 2, 3, 5};

/* Saves by so many parts and loads by all numbers of them. */
static void check_restart(const story *of, const outcome *all, int32_t by, const char *name) {
  story is = *of;
  run(&is, SAVE, by, name);
  is.stamp = 5;
  for (int32_t k = 0; k < 4; ++k) {
    const int32_t parts = part_numbers[k];
    run(&is, LOAD, parts, name);
    for (int32_t r = 0; r < parts; ++r) {
      const outcome *b = &is.found[r];
      if (b->loaded_hash != all->hashes[is.saved_at] && !is.event)
        ck_abort_msg("%s, saved by %d, part %d of %d: another state is loaded", name, by, r, parts);
      if (!is.event && memcmp(&b->loaded, &all->infos[is.saved_at], sizeof b->loaded))
        ck_abort_msg("%s, saved by %d, part %d of %d: another info is loaded, %lld sorts, %lld", name, by, r,
                     parts, (long long)b->loaded.resorts, (long long)all->infos[is.saved_at].resorts);
      if (b->hash != all->hash)
        ck_abort_msg("%s, saved by %d after %d steps, part %d of %d: another state, %lld sorts, %lld", name,
                     by, is.saved_at, r, parts, (long long)b->info.resorts, (long long)all->info.resorts);
      if (memcmp(&b->info, &all->info, sizeof b->info))
        ck_abort_msg(
            "%s, saved by %d, part %d of %d: another info: kinetic energy %.17g, %.17g; sorts %lld, %lld; "
            "active nodes %lld, %lld",
            name, by, r, parts, b->info.kinetic_energy, all->info.kinetic_energy, (long long)b->info.resorts,
            (long long)all->info.resorts, (long long)b->info.active_nodes, (long long)all->info.active_nodes);
      if (memcmp(b->reaction, all->reaction, sizeof b->reaction))
        ck_abort_msg("%s, saved by %d, part %d of %d: other reactions", name, by, r, parts);
    }
  }
  drop_pieces(&is);
}

/* When to save: in the step that sorted last, two steps before it (particles are in their rings), and one
 * step before it (they have left them, and are about to be sorted). */
static int32_t moment(const outcome *all, int32_t steps_made, int32_t kind) {
  int32_t last = 0;
  for (int32_t i = 2; i < steps_made - 1; ++i)
    if (all->sorts[i] > all->sorts[i - 1]) last = i;
  return last > 2 ? last - kind : steps_made / 2;
}

static story story_of(int32_t dim, int64_t cells) {
  story is;
  memset(&is, 0, sizeof is);
  is.desc = world_default(dim, cells, 1.0 / (double)cells);
  is.set_up = set_up;
  is.speed = 8.0;
  is.steps = 20;
  is.stamp = 1;
  return is;
}

/* Some become prescribed, so that only parts that have them keep the field. */
static mpm_status prescribe_some(world *w, const story *is, int32_t part, int32_t step) {
  (void)part;
  return step == is->saved_at - 1 ? prescribe_sevenths(w->set[0]) : MPM_OK;
}

/* Particles are added by one part, and others are removed, right before it is saved. */
static mpm_status come_and_go(world *w, const story *is, int32_t part, int32_t step) {
  if (step != is->saved_at && step != 3) return MPM_OK;
  const double x[] = {0.31 + 0.01 * step, 0.27}, v[] = {is->speed, 0.0}, volume[] = {1e-4};
  const int64_t id[] = {100000 + step}, gone[] = {500 + step};
  const int32_t adds = is->parts == 1 || part == step % is->parts;
  mpm_status status = mpm_particles_add(w->set[0], adds, x, v, volume, NULL, id, NULL);
  if (status) return status;
  status = mpm_particles_remove(w->set[0], 1, gone);
  return status == MPM_E_NOT_FOUND ? MPM_OK : status;
}

static mpm_status set_up_open(world *w, const story *is, int32_t part) {
  (void)part;
  mpm_status status = set_walls(w, MPM_WALL_OPEN, MPM_WALL_OPEN);
  if (!status) status = fill(w, w->set[0], 0.5, 0.99);
  return status ? status : give_values(w, w->set[0], is);
}

static mpm_status set_up_small(world *w, const story *is, int32_t part) {
  (void)part;
  mpm_status status = fill(w, w->set[0], 0.4, 0.5);
  return status ? status : give_values(w, w->set[0], is);
}

/* Two bodies that meet with friction, walls that rub, and a ball that they push away. */
static mpm_status set_up_bodies(world *w, const story *is, int32_t part) {
  story *to = (story *)(uintptr_t)is;
  mpm_contact_desc rule;
  mpm_obstacle_desc ball;
  mpm_status status = mpm_contact_desc_init(&rule, sizeof rule);
  rule.friction = 0.3;
  if (!status) status = mpm_obstacle_desc_init(&ball, sizeof ball);
  ball.shape = MPM_SHAPE_SPHERE;
  ball.motion = MPM_MOTION_FREE;
  ball.mass = 20.0;
  ball.inertia[8] = 0.2;
  ball.position[0] = 0.72, ball.position[1] = 0.5;
  ball.size[0] = 0.08;
  ball.contact = &rule;
  for (int32_t face = 0; face < 4 && !status; ++face)
    status = mpm_stepper_set_wall(w->stepper, face, MPM_WALL_FRICTION, 0.3);
  for (int32_t m = 0; m < 2 && !status; ++m) {
    const double low[] = {m ? 0.45 : 0.2, 0.05}, high[] = {m ? 0.65 : 0.45, m ? 0.6 : 0.4};
    const int32_t per_cell[] = {2, 2};
    status = mpm_particles_fill_box(w->set[m], low, high, per_cell, NULL, NULL);
    if (!status) status = give_values(w, w->set[m], is);
    if (!status) status = mpm_stepper_set_body(w->stepper, w->set[m], m);
  }
  if (!status) status = mpm_stepper_set_contact(w->stepper, 0, 1, &rule);
  if (!status) status = mpm_obstacle_create(w->context, &ball, &to->obstacle[part]);
  return status ? status : mpm_stepper_add_obstacle(w->stepper, to->obstacle[part]);
}

/* Pressure on a ring in the body. */
static mpm_status set_up_surface(world *w, const story *is, int32_t part) {
  enum { EDGES = 24 };
  story *to = (story *)(uintptr_t)is;
  const double h = w->desc.grid.spacing[0];
  double x[2 * EDGES];
  mpm_surface_desc d;
  mpm_status status = mpm_surface_desc_init(&d, sizeof d);
  d.pressure = 500.0;
  d.max_spacing = 0.5 * h;
  for (int32_t i = 0; i < EDGES; ++i) {
    x[i] = 0.4 + 0.15 * cos(2.0 * PI * i / EDGES);
    x[EDGES + i] = 0.4 + 0.15 * sin(2.0 * PI * i / EDGES);
  }
  if (!status) status = set_up(w, is, part);
  if (!status) status = mpm_surface_create(w->context, w->grid, &d, &to->surface[part]);
  if (!status) status = mpm_surface_add_polyline(to->surface[part], EDGES, x, 1, h, NULL, NULL);
  return status ? status : mpm_stepper_add_surface(w->stepper, to->surface[part]);
}

enum { STORIES = 14, MOMENTS = 3 };

static story tell(int32_t kind, const char **name) {
  story is = story_of(2, 96);
  static const char *const names[STORIES] = {
      "USL, FLIP", "USF, APIC, two sets", "MUSL, XPIC, periodic", "prescribed", "come and go", "open walls",
      "3-D, MUSL", "staggered",           "few blocks",           "1-D, AFLIP", "light nodes", "bodies, ball",
      "surface",   "total Lagrangian"};
  *name = names[kind];
  switch (kind) {
  case 1:
    is.desc.stepper.scheme = MPM_USF;
    is.desc.stepper.transfer = MPM_APIC;
    is.desc.sets = 2;
    break;
  case 2:
    is.desc.stepper.scheme = MPM_MUSL;
    is.desc.stepper.transfer = MPM_XPIC;
    is.desc.stepper.xpic_order = 2;
    is.desc.grid.periodic[0] = is.desc.grid.periodic[1] = 1;
    is.desc.grid.cells[1] -= 7; /* a period that is no multiple of a block */
    break;
  case 3:
    is.desc.stepper.locking_remedy = 1;
    is.event = prescribe_some;
    break;
  case 4:
    is.event = come_and_go;
    break;
  case 5:
    is.set_up = set_up_open;
    is.speed = 40.0;
    break;
  case 6:
    is = story_of(3, 20);
    is.desc.stepper.scheme = MPM_MUSL;
    is.desc.stepper.transfer = MPM_APIC;
    is.speed = 14.0;
    break;
  case 7:
    is.desc.stepper.staggered = 1;
    is.desc.stepper.reference_positions = 1;
    break;
  case 8:
    is.set_up = set_up_small;
    break;
  case 9:
    is = story_of(1, 400);
    is.desc.stepper.transfer = MPM_AFLIP;
    break;
  case 10:
    is.desc.grid.basis = MPM_LINEAR;
    is.desc.sets = 2;
    break;
  case 11:
    is.desc.sets = 2;
    is.set_up = set_up_bodies;
    break;
  case 12:
    is.set_up = set_up_surface;
    break;
  case 13:
    is.desc.grid.total_lagrangian = 1;
    break;
  default:
    break;
  }
  return is;
}

START_TEST(saved_and_loaded) {
  const char *name;
  story is = tell(_i / MOMENTS, &name);
  static outcome all;
  is.saved_at = is.steps / 2; /* events know it */
  run(&is, BOTH, 1, name);
  const int32_t at = moment(&is.found[0], is.steps, _i % MOMENTS);
  if (is.event && at != is.saved_at) {
    is.saved_at = at;
    run(&is, BOTH, 1, name);
  }
  is.saved_at = at;
  all = is.found[0];
  show("%s: saved after %d of %d steps, sorts %lld, %lld, %lld\n", name, at, is.steps,
       (long long)all.sorts[at > 0 ? at - 1 : 0], (long long)all.sorts[at], (long long)all.sorts[at + 1]);
  for (int32_t k = 0; k < 4; ++k) check_restart(&is, &all, part_numbers[k], name);
}
END_TEST

/* Nothing at all. */
static mpm_status set_up_nothing(world *w, const story *is, int32_t part) {
  (void)part;
  return give_values(w, w->set[0], is);
}

START_TEST(no_particles) {
  story is = story_of(2, 48);
  static outcome all;
  is.set_up = set_up_nothing;
  is.dt = 1e-4;
  is.saved_at = 8;
  run(&is, BOTH, 1, "nothing");
  all = is.found[0];
  for (int32_t k = 0; k < 4; ++k) check_restart(&is, &all, part_numbers[k], "nothing");
}
END_TEST

/* Turns the state of one part into one of format 2, as 0.1.0 saved it. */
static mpm_status save_old(world *w, const story *is, int32_t part) {
  story *to = (story *)(uintptr_t)is;
  (void)part;
  mpm_status status = save(w, &to->piece[0]);
  if (status) return status;
  to->piece[0].bytes = contents_of_format_2(w->stepper, to->piece[0].data, to->piece[0].bytes);
  seal_state(to->piece[0].data, 2, to->piece[0].bytes);
  to->pieces = 1;
  return MPM_OK;
}

static mpm_status save_old_at(world *w, const story *is, int32_t part, int32_t step) {
  return step == 8 && is->what == BOTH ? save_old(w, is, part) : MPM_OK;
}

START_TEST(released_formats) {
  story is = story_of(2, 48);
  is.saved_at = 8;
  is.event = save_old_at;
  run(&is, BOTH, 1, "format 2");
  const uint64_t loaded = is.found[0].hashes[8], hash = is.found[0].hash;
  is.event = NULL;
  for (int32_t k = 0; k < 4; ++k) {
    run(&is, LOAD, part_numbers[k], "format 2");
    for (int32_t r = 0; r < part_numbers[k]; ++r) {
      ck_assert_uint_eq(is.found[r].loaded_hash, loaded);
      ck_assert_uint_eq(is.found[r].hash, hash);
    }
  }
  drop_pieces(&is);
}
END_TEST

/* A state is shared out when it is loaded, and not with the next sort alone. */
START_TEST(blocks_are_shared_out) {
  story is = story_of(2, 96);
  int64_t most = 0, all = 0;
  is.saved_at = 8;
  run(&is, BOTH, 1, "shares");
  run(&is, SAVE, 1, "shares");
  run(&is, LOAD, 3, "shares");
  for (int32_t r = 0; r < 3; ++r) {
    all += is.found[r].own;
    if (is.found[r].own > most) most = is.found[r].own;
  }
  ck_assert_int_lt(most, 6 * all / 10);
  drop_pieces(&is);
}
END_TEST

TCase *shared_states_case(Suite *suite) {
  TCase *states = tcase_create("states");
  tcase_set_timeout(states, 300);
  TCase *wide = tcase_create("more states");
  tcase_set_tags(wide, "wide");
  tcase_set_timeout(wide, 300);
  suite_add_tcase(suite, wide);
  for (int32_t i = 0; i < STORIES * MOMENTS; ++i)
    tcase_add_loop_test((i + i / MOMENTS) % MOMENTS ? wide : states, saved_and_loaded, i, i + 1);
  tcase_add_test(states, no_particles);
  tcase_add_test(states, released_formats);
  tcase_add_test(states, blocks_are_shared_out);
  return states;
}
