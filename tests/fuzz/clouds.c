/* Small clouds of particles with any options that the headers name, and what a host may do with them: steps
 * in all forms, particles that come and go, fields written, states saved and loaded, memory that runs out.
 * Any status is an answer; numbers that are not finite, particles or mass that come from nowhere and time
 * that goes astray are not. */
#include <unistd.h>

#include "fuzz.h"
#include "stepper/stepper.h"

enum { SETS = 3, OBSTACLES = 3, SURFACES = 2, MOST_ACTIONS = 24, MOST_PARTICLES = 200 };

typedef struct cloud {
  fuzz_input in;
  fuzz_memory memory;
  mpm_context *context;
  mpm_grid *grid;
  mpm_grid_desc g;
  int32_t sets, repairable; /* the host has written bad values */
  mpm_material *material[SETS];
  mpm_particles *set[SETS];
  mpm_stepper *stepper;
  mpm_obstacle *obstacle[OBSTACLES]; /* some NULL */
  mpm_surface *surface[SURFACES];    /* the same */
  int64_t count, removed;            /* of all sets; through open walls */
  double mass, t;
  int32_t callback_status;
} cloud;

/* ---- callbacks ----------------------------------------------------------------------------------------- */
static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  const cloud *c = user;
  for (int32_t k = 0; k < b->dim; ++k)
    for (int64_t i = 0; i < b->n; ++i) add[k * b->ld + i] += b->mass[i] * (1.0 - b->position[k * b->ld + i]);
  return c->callback_status;
}

static mpm_status hold(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    if ((b->index[i] & 3) != 1) continue;
    prescribed[i] = 1;
    velocity[i] = 0.25;
  }
  return 0;
}

static mpm_status hook(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)user;
  for (int64_t i = 0; i < b->n * (b->dim > 0); ++i) velocity[i] *= 0.99, force[i] += 1e-3 * b->mass[i];
  return 0;
}

static mpm_status watch(void *user, const mpm_step_info *info) {
  (void)info;
  return ((const cloud *)user)->callback_status;
}

/* A fluid of sorts: pressure from J, and a state that counts. */
static mpm_status host_law(void *user, const mpm_material_batch *b) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    const double *F = b->F + i;
    const int64_t l = b->ld;
    const double J = F[0] * (F[4 * l] * F[8 * l] - F[5 * l] * F[7 * l]) -
                     F[l] * (F[3 * l] * F[8 * l] - F[5 * l] * F[6 * l]) +
                     F[2 * l] * (F[3 * l] * F[7 * l] - F[4 * l] * F[6 * l]);
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * l + i] = c < 3 ? 1e3 * (J - 1.0) : 0.0;
    b->state_new[i] = b->state[i] + b->dt;
    b->wave_speed[i] = 10.0;
    b->kinematic_viscosity[i] = 1e-3;
    b->energy[i] = 500.0 * (J - 1.0) * (J - 1.0);
  }
  return 0;
}

/* ---- options ------------------------------------------------------------------------------------------- */
static void open_grid(cloud *c) {
  static const int32_t basis[] = {MPM_LINEAR, MPM_BSPLINE2, MPM_BSPLINE3, MPM_GIMP, MPM_UGIMP, MPM_CPGIMP};
  MUST(!mpm_grid_desc_init(&c->g, sizeof c->g));
  c->g.dim = 1 + fuzz_below(&c->in, 3);
  c->g.basis = basis[fuzz_below(&c->in, 6)];
  c->g.boundary_basis = fuzz_below(&c->in, 4) == 0;
  c->g.smoothing = fuzz_between(&c->in, 0.01, 1.0);
  const int32_t periodic = fuzz_below(&c->in, 8);
  for (int32_t k = 0; k < c->g.dim; ++k) {
    c->g.periodic[k] = periodic >> k & 1;
    c->g.cells[k] = 1 + fuzz_below(&c->in, c->g.dim == 3 ? 14 : 36);
    c->g.spacing[k] = fuzz_between(&c->in, 0.25, 1.0);
    c->g.origin[k] = fuzz_between(&c->in, -2.0, 2.0);
  }
  if (c->g.dim == 2) c->g.geometry = fuzz_below(&c->in, 3);
  if (c->g.geometry == MPM_AXISYMMETRIC)
    c->g.origin[0] = fmax(c->g.origin[0], 0.0); /* half of them begin at the axis */
  if (!fuzz_status(c->context, mpm_grid_create(c->context, &c->g, &c->grid))) return;
  c->g.basis = c->g.basis == MPM_LINEAR ? MPM_LINEAR : MPM_BSPLINE2;
  c->g.boundary_basis = MPM_BOUNDARY_GHOST;
  c->g.geometry = MPM_PLANE_STRAIN;
  MUST(!mpm_grid_create(c->context, &c->g, &c->grid));
}

static mpm_material *host_material(cloud *c) {
  mpm_material *material;
  mpm_material_desc d;
  MUST(!mpm_material_desc_init(&d, sizeof d));
  d.density = 10.0;
  d.stress = host_law;
  d.state_count = 1;
  MUST(!mpm_material_create_custom(c->context, &d, &material));
  return material;
}

/* Any law, with stresses of about 1e3 and whatever else in reach of its default or 1. */
static mpm_material *open_material(cloud *c) {
  const int32_t models = mpm_material_model_count(), which = fuzz_below(&c->in, models + 1);
  mpm_material *material;
  mpm_param param[16];
  int32_t count = 0;
  if (which == models) return host_material(c);
  const char *model = mpm_material_model_name(which), *unit;
  double usual, low, high;
  for (; count < 16; ++count) {
    mpm_param *p = &param[count];
    if (mpm_material_model_param(model, count, &p->name, &unit, NULL, &usual, &low, &high)) break;
    const double scale = !isnan(usual) && usual != 0.0 ? usual : !strcmp(unit, "stress") ? 1e3 : 1.0;
    p->value = scale * fuzz_between(&c->in, 0.1, 2.0);
    if (!strcmp(p->name, "nu")) p->value = fuzz_between(&c->in, -0.5, 0.49);
    p->value = p->value < low ? low : p->value > high ? high : p->value;
  }
  if (!fuzz_status(c->context, mpm_material_create(c->context, model, param, count, &material)))
    return material;
  return host_material(c);
}

static mpm_stepper_desc draw_stepper(cloud *c) {
  static const int32_t scheme[] = {MPM_USL, MPM_USF, MPM_MUSL, MPM_NEWMARK};
  mpm_stepper_desc d;
  MUST(!mpm_stepper_desc_init(&d, sizeof d));
  d.scheme = scheme[fuzz_below(&c->in, 4)];
  d.transfer = 1 + fuzz_below(&c->in, 8);
  d.xpic_order = 1 + fuzz_below(&c->in, 5);
  d.xpic_every = fuzz_below(&c->in, 3);
  const uint32_t bits = (uint32_t)fuzz_word(&c->in, 2);
  d.position_order = 1 + (int32_t)(bits & 1);
  d.locking_remedy = (bits >> 1 & 3) == 3;
  d.reference_positions = bits >> 3 & 1;
  d.quasi_static = (bits >> 4 & 7) == 7;
  d.staggered = (bits >> 7 & 3) == 3;
  d.boundary_zero_acceleration = bits >> 9 & 1;
  d.projected_positions = bits >> 14 & 1;
  d.pic_damping = (bits >> 10 & 3) == 3 ? 10.0 : 0.0;
  if (bits >> 15 & 1) d.local_damping = d.scheme == MPM_NEWMARK ? 0.0 : 0.7;
  if (bits >> 15 & 1) d.mass_damping = d.quasi_static ? 0.0 : 20.0;
  d.flip = bits >> 12 & 1 ? fuzz_between(&c->in, 0.0, 1.0) : 1.0;
  d.gravity[c->g.dim - 1] = bits >> 13 & 1 ? -10.0 : 0.0;
  return d;
}

/* What is not offered yet is left at its default, one after the other, so that the rest is still tried. */
static mpm_stepper_desc supported(cloud *c, mpm_stepper_desc d) {
  mpm_stepper_desc usual;
  mpm_stepper *trial = NULL;
  MUST(!mpm_stepper_desc_init(&usual, sizeof usual));
  for (int32_t i = 0; fuzz_status(c->context, mpm_stepper_create(c->context, c->grid, &d, &trial)); ++i) {
    MUST(i < 9);
    if (i == 0) d.projected_positions = usual.projected_positions;
    if (i == 0) d.locking_remedy = usual.locking_remedy;
    if (i == 1) d.staggered = usual.staggered;
    if (i == 2) d.quasi_static = usual.quasi_static;
    if (i == 3) d.position_order = usual.position_order;
    if (i == 4) d.pic_damping = usual.pic_damping;
    if (i == 5) d.scheme = usual.scheme;
    if (i == 6) d.transfer = d.transfer % 2 ? MPM_FLIP : MPM_APIC;
    if (i == 7) d = usual;
  }
  MUST(!mpm_stepper_destroy(trial));
  return d;
}

static void draw_wall(cloud *c) {
  const int32_t face = fuzz_below(&c->in, 6), kind = fuzz_below(&c->in, 6);
  fuzz_status(c->context, mpm_stepper_set_wall(c->stepper, face, kind, fuzz_between(&c->in, 0.0, 1.0)));
}

static void draw_bodies(cloud *c) {
  mpm_contact_desc d;
  MUST(!mpm_contact_desc_init(&d, sizeof d));
  d.kind = fuzz_below(&c->in, 3);
  d.normal = fuzz_below(&c->in, 4);
  d.direction[0] = 1.0;
  d.detection = fuzz_below(&c->in, 3);
  d.friction = fuzz_between(&c->in, 0.0, 1.0);
  d.adhesion = fuzz_between(&c->in, 0.0, 10.0);
  d.offset = fuzz_between(&c->in, -0.1, 0.1);
  fuzz_status(c->context, mpm_stepper_set_body(c->stepper, c->set[c->sets - 1], fuzz_below(&c->in, 3)));
  fuzz_status(c->context,
              mpm_stepper_set_contact(c->stepper, fuzz_below(&c->in, 4) - 1, fuzz_below(&c->in, 4) - 1,
                                      fuzz_below(&c->in, 8) ? &d : NULL));
}

/* The same for the same step, so that a loaded state goes on as before. */
static mpm_status rub(void *user, const mpm_contact_batch *b, double *friction) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) friction[i] = fabs(b->normal[i]);
  return b->n % 64 == 63 ? 1 : MPM_OK;
}

static mpm_status bowl(void *user, const mpm_distance_batch *b) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    double squared = 0.0;
    for (int32_t k = 0; k < b->dim; ++k) squared += b->position[k * b->ld + i] * b->position[k * b->ld + i];
    const double r = sqrt(squared);
    b->distance[i] = 0.4 - r;
    for (int32_t k = 0; k < b->dim; ++k)
      b->normal[k * b->ld + i] = r > 0.0 ? -b->position[k * b->ld + i] / r : k == 0;
    if (b->velocity) b->velocity[i] = 0.1;
  }
  return b->n % 128 == 127 ? 1 : MPM_OK;
}

static mpm_status swing(void *user, double t, double dt, double *velocity, double *angular_velocity) {
  (void)user, (void)dt;
  velocity[0] = 0.3 - t;
  angular_velocity[2] *= 0.9;
  return MPM_OK;
}

/* Makes an obstacle, or moves or drops one that there is. */
static void draw_obstacle(cloud *c) {
  static const int32_t shapes[] = {MPM_SHAPE_PLANE,   MPM_SHAPE_SPHERE, MPM_SHAPE_CYLINDER,
                                   MPM_SHAPE_CAPSULE, MPM_SHAPE_BOX,    MPM_SHAPE_DISTANCE};
  mpm_obstacle **o = &c->obstacle[fuzz_below(&c->in, OBSTACLES)];
  double v[4] = {1.0, 0.0, 0.0, 0.0};
  for (int32_t k = 0; k < c->g.dim; ++k) v[k] = fuzz_between(&c->in, -0.5, 1.5);
  if (*o) {
    const int32_t what = fuzz_below(&c->in, 4);
    if (what == 0) fuzz_status(c->context, mpm_obstacle_set_pose(*o, v, NULL, NULL, NULL));
    if (what == 1) fuzz_status(c->context, mpm_obstacle_set_pose(*o, NULL, v, v, NULL));
    if (what == 2) fuzz_status(c->context, mpm_obstacle_set_load(*o, v, v));
    if (what == 3 && !fuzz_status(c->context, mpm_stepper_remove_obstacle(c->stepper, *o))) {
      MUST(!mpm_obstacle_destroy(*o));
      *o = NULL;
    }
    return;
  }
  mpm_obstacle_desc d;
  mpm_contact_desc rule;
  MUST(!mpm_obstacle_desc_init(&d, sizeof d) && !mpm_contact_desc_init(&rule, sizeof rule));
  rule.kind = fuzz_below(&c->in, 3);
  rule.friction = fuzz_between(&c->in, 0.0, 1.0);
  rule.adhesion = fuzz_between(&c->in, 0.0, 10.0);
  rule.offset = fuzz_between(&c->in, -0.1, 0.1);
  d.contact = &rule;
  d.shape = shapes[fuzz_below(&c->in, 6)];
  d.motion = fuzz_below(&c->in, 3);
  d.inside = fuzz_below(&c->in, 2);
  d.distance = bowl;
  d.mass = fuzz_between(&c->in, 0.01, 100.0);
  for (int32_t k = 0; k < 3; ++k) {
    d.size[k] = fuzz_between(&c->in, 0.05, 0.6);
    d.position[k] = v[k];
    d.inertia[4 * k] = fuzz_between(&c->in, 0.01, 1.0);
    if (k < c->g.dim && d.motion) d.velocity[k] = fuzz_between(&c->in, -1.0, 1.0);
  }
  if (d.motion && c->g.dim > 1) d.angular_velocity[2] = fuzz_between(&c->in, -5.0, 5.0);
  if (fuzz_status(c->context, mpm_obstacle_create(c->context, &d, o))) return;
  if (d.motion == MPM_MOTION_PRESCRIBED && d.inside) MUST(!mpm_obstacle_set_motion(*o, swing, c));
  if (!fuzz_status(c->context, mpm_stepper_add_obstacle(c->stepper, *o))) return;
  MUST(!mpm_obstacle_destroy(*o));
  *o = NULL;
}

static mpm_status drag(void *user, const mpm_marker_batch *b, double *add) {
  const cloud *c = user;
  for (int64_t i = 0; i < b->n * b->dim; ++i) add[i] -= 10.0 * b->velocity[i];
  return c->callback_status;
}

/* Adds to a surface, changes it, or drops it. */
static void change_surface(cloud *c, mpm_surface **s, const mpm_surface_desc *d) {
  double x[3 * 4], a[3 * 4], *out;
  const int64_t corner[6] = {0, 1, 2, 2, 1, 3}, id = fuzz_below(&c->in, 8);
  for (int32_t k = 0; k < 12; ++k) {
    x[k] = fuzz_between(&c->in, -0.1, 1.1);
    a[k] = fuzz_between(&c->in, -0.2, 0.2);
  }
  double step = fuzz_between(&c->in, -0.01, 0.3);
  if (step > 0.0 && step < 0.02) step = 0.02; /* not millions of markers */
  switch (fuzz_below(&c->in, 8)) {
  case 0:
    fuzz_status(c->context, mpm_surface_add_polyline(*s, 4, x, fuzz_below(&c->in, 2), step, NULL, NULL));
    break;
  case 1:
    fuzz_status(c->context, mpm_surface_add_triangles(*s, 4, x, 2, corner, step, NULL, NULL));
    break;
  case 2:
    fuzz_status(c->context, mpm_surface_refine(*s, fuzz_between(&c->in, 0.02, 0.3), NULL));
    break;
  case 3:
    fuzz_status(c->context, mpm_surface_remove(*s, 1, &id));
    break;
  case 4:
    fuzz_status(c->context, mpm_surface_set(*s, "traction", MPM_F64, c->g.dim, 1, &id, a));
    break;
  case 5:
    fuzz_status(c->context, mpm_surface_configure(*s, d));
    break;
  case 6:
    if (fuzz_status(c->context, mpm_stepper_remove_surface(c->stepper, *s))) break;
    MUST(!mpm_surface_destroy(*s));
    *s = NULL;
    return;
  default:
    fuzz_status(c->context, mpm_surface_add(*s, 4, x, a, NULL));
  }
  const int64_t n = mpm_surface_count(*s) * c->g.dim;
  MUST((out = calloc((size_t)n + 1, sizeof *out)));
  MUST(!mpm_surface_get(*s, "area", MPM_F64, c->g.dim, mpm_surface_count(*s), NULL, out));
  for (int64_t i = 0; i < n; ++i) MUST(isfinite(out[i]));
  free(out);
}

static void draw_surface(cloud *c) {
  mpm_surface **s = &c->surface[fuzz_below(&c->in, SURFACES)];
  mpm_surface_desc d;
  MUST(!mpm_surface_desc_init(&d, sizeof d));
  d.pressure = fuzz_between(&c->in, -50.0, 50.0);
  d.traction[0] = fuzz_between(&c->in, -10.0, 10.0);
  d.dead_traction[1] = fuzz_between(&c->in, -10.0, 10.0);
  d.max_spacing = fuzz_below(&c->in, 2) ? fuzz_between(&c->in, -0.01, 0.3) : 0.0;
  d.body = fuzz_below(&c->in, 4) ? 0 : fuzz_below(&c->in, 3) - 1;
  if (*s) {
    change_surface(c, s, &d);
    return;
  }
  if (fuzz_status(c->context, mpm_surface_create(c->context, c->grid, &d, s))) return;
  if (fuzz_below(&c->in, 2)) MUST(!mpm_surface_set_traction(*s, drag, c));
  if (!fuzz_status(c->context, mpm_stepper_add_surface(c->stepper, *s))) return;
  MUST(!mpm_surface_destroy(*s));
  *s = NULL;
}

static void open_stepper(cloud *c) {
  const mpm_stepper_desc d = supported(c, draw_stepper(c));
  MUST(!mpm_stepper_create(c->context, c->grid, &d, &c->stepper));
  for (int32_t m = 0; m < c->sets; ++m) MUST(!mpm_stepper_add(c->stepper, c->set[m]));
  for (int32_t i = 0; i < 2 * c->g.dim; ++i) draw_wall(c);
  const uint32_t with = fuzz_byte(&c->in);
  if (with & 1) fuzz_status(c->context, mpm_stepper_set_force(c->stepper, push, c));
  if (with & 2) fuzz_status(c->context, mpm_stepper_set_acceleration(c->stepper, push, c));
  if (with & 4) fuzz_status(c->context, mpm_stepper_set_velocity_bc(c->stepper, hold, c));
  if (with & 8) fuzz_status(c->context, mpm_stepper_set_progress(c->stepper, watch, c));
  if (with & 16)
    fuzz_status(c->context, mpm_stepper_set_node_hook(c->stepper, 1 + fuzz_below(&c->in, 3), hook, c));
  if (with & 32) fuzz_status(c->context, mpm_stepper_set_motion(c->stepper, c->set[0], push, c));
  if (with & 64) draw_bodies(c);
  if (with & 128) fuzz_status(c->context, mpm_stepper_set_friction(c->stepper, rub, c));
}

/* ---- what must hold ------------------------------------------------------------------------------------ */
static int64_t count_all(const cloud *c) {
  int64_t n = 0;
  for (int32_t m = 0; m < c->sets; ++m) n += mpm_particles_count(c->set[m]);
  return n;
}

/* A field of all particles; to be freed. */
static void *get(cloud *c, const mpm_particles *set, const char *field, int32_t type, int32_t components) {
  const int64_t n = mpm_particles_count(set), fail_at = fuzz_no_failure(&c->memory);
  void *values = malloc(sizeof(double) * (size_t)(n * components + 1));
  MUST(!mpm_particles_get(set, field, type, components, n, NULL, values));
  c->memory.fail_at = fail_at;
  return values;
}

static double mass_all(cloud *c) {
  double sum = 0.0;
  for (int32_t m = 0; m < c->sets; ++m) {
    double *mass = get(c, c->set[m], "mass", MPM_F64, 1);
    for (int64_t i = 0; i < mpm_particles_count(c->set[m]); ++i) sum += mass[i];
    free(mass);
  }
  return sum;
}

static uint64_t hash_of(cloud *c) {
  uint64_t hash = 0;
  const int64_t fail_at = fuzz_no_failure(&c->memory);
  MUST(!mpm_state_hash(c->stepper, &hash) || c->repairable);
  c->memory.fail_at = fail_at;
  return hash;
}

static void inside_grid(cloud *c, const mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  double *x = get(c, set, "position", MPM_F64, c->g.dim);
  for (int64_t i = 0; i < n * c->g.dim; ++i) {
    const int64_t k = i / n;
    MUST(x[i] >= c->g.origin[k] && x[i] <= c->g.origin[k] + (double)c->g.cells[k] * c->g.spacing[k]);
  }
  free(x);
}

static void check_state(cloud *c) {
  for (int32_t m = 0; m < c->sets; ++m) {
    if (!c->repairable) fuzz_finite(c->set[m]);
    inside_grid(c, c->set[m]);
  }
  MUST(count_all(c) == c->count);
  MUST(fabs(mass_all(c) - c->mass) <= 1e-12 * (c->mass + 1.0));
}

/* After calls whose steps were not followed one by one. */
static void look_anew(cloud *c) {
  c->memory.fail_at = 0;
  c->t = c->stepper->history.t;
  c->removed = c->stepper->history.removed;
  c->count = count_all(c);
  c->mass = mass_all(c);
}

/* After one or several steps: particles are lost through open walls only, and are counted. */
static void check_steps(cloud *c, const mpm_step_info *info) {
  const int64_t lost = info->removed - c->removed, count = count_all(c);
  MUST(lost >= 0 && count == c->count - lost);
  const double mass = mass_all(c);
  MUST(lost ? mass <= c->mass : fabs(mass - c->mass) <= 1e-12 * (c->mass + 1.0));
  c->count = count;
  c->mass = mass;
  c->removed = info->removed;
  c->t = info->t;
}

/* ---- what a host does ---------------------------------------------------------------------------------- */
static double draw_dt(cloud *c) {
  static const double share[] = {0.3, 0.1, 0.5, 0.9, 1.5, 4.0, 1e-3, 0.3};
  double dt;
  if (fuzz_status(c->context, mpm_stable_dt(c->stepper, &dt)) || !(dt < 1.0)) dt = 1e-2;
  return dt * share[fuzz_below(&c->in, 8)];
}

static void step(cloud *c) {
  mpm_step_info info = {.struct_size = sizeof info};
  const double dt = draw_dt(c);
  const uint64_t before = hash_of(c);
  c->callback_status = fuzz_below(&c->in, 32) == 1;
  const mpm_status status = fuzz_status(c->context, mpm_step(c->stepper, dt, &info));
  c->callback_status = 0;
  if (status) {
    MUST(hash_of(c) == before);
    return;
  }
  MUST(info.t == c->t + dt && info.dt == dt);
  check_steps(c, &info);
}

static void advance(cloud *c) {
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_advance_desc d;
  MUST(!mpm_advance_desc_init(&d, sizeof d));
  d.t_end = c->t + 4.0 * draw_dt(c);
  d.cfl = fmax(0.0, fuzz_between(&c->in, -0.3, 1.0)); /* 0: the library chooses */
  d.max_steps = 8;
  const double t = c->t;
  const mpm_status status = fuzz_status(c->context, mpm_advance(c->stepper, &d, &info));
  info.t = c->stepper->history.t;
  info.removed = c->stepper->history.removed;
  MUST(info.t >= t && info.t <= d.t_end && (status || info.t > t || d.t_end == t));
  check_steps(c, &info);
}

/* Shifts a nodal field a little between the parts of a step. */
static void write_nodes(cloud *c, const char *field) {
  mpm_view v = {.struct_size = sizeof v};
  if (fuzz_status(c->context, mpm_grid_map(c->stepper, 0, field, MPM_READ | MPM_WRITE, &v))) return;
  const double shift = fuzz_between(&c->in, -0.1, 0.1);
  for (int64_t i = 0; i < v.count; ++i)
    for (int32_t k = 0; k < v.components; ++k)
      ((double *)v.data)[i * v.item_stride + k * v.component_stride] += shift;
  MUST(!mpm_view_release(&v));
}

static void staged(cloud *c) {
  mpm_step_info info = {.struct_size = sizeof info};
  const uint64_t before = hash_of(c);
  const double dt = draw_dt(c);
  const int32_t how = fuzz_below(&c->in, 16);
  mpm_status status = fuzz_status(c->context, mpm_step_begin(c->stepper, dt));
  if (!status && how & 1) write_nodes(c, "force");
  if (!status && how & 2) write_nodes(c, "velocity");
  if (!status && how != 4) status = fuzz_status(c->context, mpm_step_grid(c->stepper));
  if (!status && how & 8) write_nodes(c, "velocity");
  if (!status && (how == 4 || how == 12)) {
    MUST(!fuzz_status(c->context, mpm_step_abort(c->stepper)));
    MUST(hash_of(c) == before);
    return;
  }
  if (!status) status = fuzz_status(c->context, mpm_step_end(c->stepper, &info));
  if (status) {
    MUST(hash_of(c) == before);
    return;
  }
  MUST(info.t == c->t + dt);
  check_steps(c, &info);
}

static mpm_particles *draw_set(cloud *c) {
  return c->set[fuzz_below(&c->in, c->sets)];
}

static void add(cloud *c) {
  enum { MOST = 16 };
  double x[3 * MOST], v[3 * MOST], volume[MOST], size[3 * MOST], cell = 1.0;
  int64_t ids[MOST], first;
  mpm_particles *set = draw_set(c);
  const int64_t n = 1 + fuzz_below(&c->in, MOST), was = mpm_particles_count(set);
  const uint32_t how = fuzz_byte(&c->in);
  if (c->count + n > MOST_PARTICLES) return;
  for (int32_t k = 0; k < c->g.dim; ++k) {
    const double length = (double)c->g.cells[k] * c->g.spacing[k], at = fuzz_between(&c->in, 0.0, 1.0);
    const double spread = how & 1 ? 1.0 : 1.0 / (double)c->g.cells[k],
                 speed = fuzz_between(&c->in, -8.0, 8.0);
    for (int64_t i = 0; i < n; ++i) {
      double place = at + spread * ((double)((i * 37 + k * 11) % 16) / 16.0 - 0.5);
      if (!c->g.periodic[k] || !(how & 2)) place = place < 0.0 ? 0.0 : place > 1.0 ? 1.0 : place;
      x[k * n + i] = c->g.origin[k] + place * length;
      v[k * n + i] = speed + (double)(i % 3);
      size[k * n + i] = c->g.spacing[k] * fuzz_between(&c->in, 0.05, 1.0);
    }
    cell *= c->g.spacing[k];
  }
  for (int64_t i = 0; i < n; ++i) volume[i] = 0.25 * cell * (1.0 + (double)(i % 4));
  for (int64_t i = 0; i < n; ++i) ids[i] = (int64_t)fuzz_word(&c->in, how & 4 ? 1 : 0) + 7 * i;
  const mpm_status status =
      fuzz_status(c->context, mpm_particles_add(set, n, x, how & 8 ? v : NULL, volume, how & 16 ? size : NULL,
                                                how & 4 ? ids : NULL, &first));
  MUST(mpm_particles_count(set) == was + (status ? 0 : n));
  c->count = count_all(c);
  c->mass = mass_all(c);
}

/* Every `stride`-th particle of a set; 1: all. */
static void remove_some(cloud *c) {
  mpm_particles *set = draw_set(c);
  const int64_t n = mpm_particles_count(set), stride = 1 + fuzz_below(&c->in, 4);
  int64_t *ids = get(c, set, "id", MPM_I64, 1), gone = 0;
  for (int64_t i = 0; i < n; i += stride) ids[gone++] = ids[i];
  if (fuzz_below(&c->in, 8) == 1) ids[0] = 99999;
  const mpm_status status = fuzz_status(c->context, mpm_particles_remove(set, gone, ids));
  MUST(mpm_particles_count(set) == n - (status ? 0 : gone));
  c->count = count_all(c);
  c->mass = mass_all(c);
  free(ids);
}

/* A state is saved; the step after it gives the same bits when it is loaded. */
static void save_and_load(cloud *c) {
  int64_t bytes;
  const double dt = draw_dt(c);
  if (fuzz_status(c->context, mpm_state_size(c->stepper, &bytes))) return;
  void *state = malloc((size_t)bytes);
  if (!fuzz_status(c->context, mpm_state_save(c->stepper, state, bytes))) {
    const uint64_t saved = hash_of(c);
    const int64_t fails = c->memory.fail_at;
    const mpm_status first = fuzz_status(c->context, mpm_step(c->stepper, dt, NULL));
    const uint64_t ahead = hash_of(c);
    const mpm_status loaded = fuzz_status(c->context, mpm_state_load(c->stepper, state, bytes));
    MUST(!loaded || loaded == MPM_E_NOMEM);
    if (!loaded) {
      c->repairable = 0;
      MUST(hash_of(c) == saved);
      const mpm_status second = fuzz_status(c->context, mpm_step(c->stepper, dt, NULL));
      MUST(fails || (first == second && hash_of(c) == ahead));
    }
    look_anew(c);
  }
  free(state);
}

/* Values of a field scaled or replaced, through a view. */
static void write_view(cloud *c) {
  static const char *const field[] = {"velocity",
                                      "deformation_gradient",
                                      "velocity_gradient",
                                      "applied_force",
                                      "acceleration",
                                      "state",
                                      "stress",
                                      "size",
                                      "initial_volume"};
  mpm_view v = {.struct_size = sizeof v};
  mpm_particles *set = draw_set(c);
  const char *name = field[fuzz_below(&c->in, 9)];
  if (fuzz_status(c->context, mpm_particles_map(set, name, MPM_READ | MPM_WRITE, &v))) return;
  const double factor = fuzz_between(&c->in, 0.8, 1.2);
  for (int64_t i = 0; i < v.count; ++i)
    for (int32_t k = 0; k < v.components; ++k)
      ((double *)v.data)[i * v.item_stride + k * v.component_stride] *= factor;
  if (v.count && fuzz_below(&c->in, 32) == 1) ((double *)v.data)[0] = (double)NAN;
  fuzz_status(c->context, mpm_step(c->stepper, 1e-3, NULL)); /* refused: a view is out */
  c->repairable |= fuzz_status(c->context, mpm_view_release(&v)) != MPM_OK;
}

static void set_fields(cloud *c) {
  const double value[9] = {fuzz_between(&c->in, -1.0, 1.0), 0.1, 0.2};
  const uint8_t axes[3] = {1, (uint8_t)fuzz_below(&c->in, 2), 0};
  mpm_particles *set = draw_set(c);
  static const char *const vector[] = {"applied_force", "velocity", "acceleration", "size",
                                       "reference_position"};
  fuzz_status(c->context,
              mpm_particles_set_all(set, vector[fuzz_below(&c->in, 5)], MPM_F64, c->g.dim, value));
  const int32_t further = fuzz_below(&c->in, 4), axis = fuzz_below(&c->in, 3);
  if (further == 1) fuzz_status(c->context, mpm_particles_set_all(set, "prescribed", MPM_U8, c->g.dim, axes));
  if (further == 2)
    fuzz_status(c->context, mpm_particles_set_geostatic(set, axis, value[0], value[0] < 0.0 ? 1e3 : -1e3,
                                                        fuzz_between(&c->in, 0.0, 2.0), 0.0));
  if (further == 3) fuzz_status(c->context, mpm_particles_reset_reference(set));
}

/* Fields as floats, into memory that holds no more than they need. */
static void pack(cloud *c) {
  static const char *const field[] = {"position", "velocity", "stress",     "state", "id",
                                      "colour",   "size",     "prescribed", "image", "reference_position"};
  const mpm_particles *set = draw_set(c);
  const int32_t count = 1 + fuzz_below(&c->in, 3);
  const int64_t n = mpm_particles_count(set);
  const char *names[3];
  size_t bytes = 0;
  for (int32_t i = 0; i < count; ++i) {
    names[i] = field[fuzz_below(&c->in, 10)];
    const int32_t f = mpmi_find_field(set, names[i]);
    if (f >= 0) bytes += (size_t)n * (size_t)set->field[f].full_components * sizeof(float);
  }
  float *out = malloc(bytes);
  MUST(out || !bytes);
  fuzz_status(c->context, mpm_particles_get_f32(set, count, names, fuzz_below(&c->in, 3), n, out));
  free(out);
}

/* A host that takes so many bytes of an output, and looks at all of them. */
static mpm_status swallow(void *user, const void *data, int64_t bytes) {
  static volatile unsigned char seen;
  int64_t *left = user;
  MUST(bytes > 0 && bytes <= 65536);
  for (int64_t i = 0; i < bytes; ++i) seen = (unsigned char)(seen ^ ((const unsigned char *)data)[i]);
  *left -= bytes;
  return *left < 0;
}

static void write_streams(cloud *c) {
  int64_t left = 4000 * (int64_t)fuzz_byte(&c->in);
  const mpm_status status =
      fuzz_status(c->context, mpm_write_grid_to(c->stepper, fuzz_below(&c->in, 2), swallow, &left, 0, NULL));
  MUST((status == MPM_E_CALLBACK) == (left < 0));
  left = 4000 * (int64_t)fuzz_byte(&c->in);
  fuzz_status(c->context, mpm_write_particles_to(draw_set(c), swallow, &left, 0, NULL));
  fuzz_status(c->context, mpm_state_save_to(c->stepper, swallow, &left));
}

static void write_files(cloud *c) {
  char path[64];
  snprintf(path, sizeof path, "/tmp/mpm-fuzz-%ld", (long)getpid());
  fuzz_status(c->context, mpm_write_grid(c->stepper, path, 0, NULL));
  fuzz_status(c->context, mpm_write_particles(draw_set(c), path, 0, NULL));
  fuzz_status(c->context, mpm_state_save_file(c->stepper, path));
  unlink(path);
}

/* A set leaves the stepper and comes back, last in order. */
static void leave_and_return(cloud *c) {
  mpm_particles *set = draw_set(c);
  if (fuzz_status(c->context, mpm_stepper_remove(c->stepper, set))) return;
  if (fuzz_below(&c->in, 2)) fuzz_status(c->context, mpm_step(c->stepper, 1e-4, NULL));
  c->memory.fail_at = 0;
  MUST(!mpm_stepper_add(c->stepper, set));
  look_anew(c);
}

static void look(cloud *c) {
  static const char *const field[] = {"mass",  "force",         "reaction",       "acceleration", "velocity",
                                      "index", "contact_force", "contact_normal", "contact_area"};
  mpm_view v = {.struct_size = sizeof v};
  mpm_contact_info contact = {.struct_size = sizeof contact};
  double force[3];
  const int32_t body = fuzz_below(&c->in, 8) ? 0 : fuzz_below(&c->in, 3);
  if (!fuzz_status(c->context, mpm_grid_map(c->stepper, body, field[fuzz_below(&c->in, 9)], MPM_READ, &v))) {
    for (int64_t i = 0; i < v.count && v.type == MPM_F64; ++i)
      for (int32_t k = 0; k < v.components; ++k)
        MUST(isfinite(((double *)v.data)[i * v.item_stride + k * v.component_stride]));
    MUST(!mpm_view_release(&v));
  }
  fuzz_status(c->context, mpm_stepper_contact_info(c->stepper, fuzz_below(&c->in, 4) - 1, 1, &contact));
  for (int32_t i = 0; i < OBSTACLES; ++i) {
    if (!c->obstacle[i] || fuzz_status(c->context, mpm_obstacle_contact_info(c->obstacle[i], -1, &contact)))
      continue;
    for (int32_t k = 0; k < 3; ++k) MUST(isfinite(contact.force[k]) && isfinite(contact.torque[k]));
  }
  fuzz_status(c->context, mpm_stepper_wall_reaction(c->stepper, fuzz_below(&c->in, 6), force));
  fuzz_status(c->context, mpm_stepper_particles_reaction(c->stepper, c->set[0], force));
  fuzz_status(c->context, mpm_stepper_wall_impulse(c->stepper, fuzz_below(&c->in, 6), force));
  fuzz_status(c->context, mpm_stepper_particles_impulse(c->stepper, c->set[c->sets - 1], force));
}

static void act(cloud *c) {
  const int32_t what = fuzz_below(&c->in, 32);
  c->memory.calls = 0;
  c->memory.fail_at = what == 31 ? 1 + fuzz_below(&c->in, 24) : 0; /* in the action that follows */
  switch (what == 31 ? fuzz_below(&c->in, 31) : what) {
  case 0:
  case 1:
  case 2:
    add(c);
    break;
  case 3:
    remove_some(c);
    break;
  case 4:
  case 5:
    advance(c);
    break;
  case 6:
  case 7:
  case 8:
    staged(c);
    break;
  case 9:
  case 10:
    save_and_load(c);
    break;
  case 11:
  case 12:
    write_view(c);
    break;
  case 13:
    set_fields(c);
    break;
  case 14:
    write_files(c);
    break;
  case 15:
    leave_and_return(c);
    break;
  case 16: {
    const mpm_stepper_desc d = draw_stepper(c);
    fuzz_status(c->context, mpm_stepper_configure(c->stepper, &d));
    break;
  }
  case 17:
    draw_wall(c);
    break;
  case 18:
    look(c);
    break;
  case 19:
    draw_bodies(c);
    break;
  case 20:
  case 21:
    draw_obstacle(c);
    break;
  case 22:
    pack(c);
    break;
  case 23:
    write_streams(c);
    break;
  case 24:
  case 25:
    draw_surface(c);
    break;
  default:
    step(c);
  }
  c->memory.fail_at = 0;
}

static void close_cloud(cloud *c) {
  MUST(!mpm_stepper_destroy(c->stepper));
  for (int32_t i = 0; i < OBSTACLES; ++i) MUST(!mpm_obstacle_destroy(c->obstacle[i]));
  for (int32_t i = 0; i < SURFACES; ++i) MUST(!mpm_surface_destroy(c->surface[i]));
  for (int32_t m = 0; m < c->sets; ++m) MUST(!mpm_particles_destroy(c->set[m]));
  for (int32_t m = 0; m < c->sets; ++m) MUST(!mpm_material_destroy(c->material[m]));
  MUST(!mpm_grid_destroy(c->grid));
  fuzz_close(c->context, &c->memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  cloud c;
  memset(&c, 0, sizeof c);
  c.in = (fuzz_input){data, data + size};
  c.context = fuzz_context(&c.memory, 1 + (fuzz_below(&c.in, 16) == 1));
  open_grid(&c);
  for (int32_t sets = 1 + fuzz_below(&c.in, SETS); c.sets < sets; ++c.sets) {
    c.material[c.sets] = open_material(&c);
    while (mpm_particles_create(c.context, c.grid, c.material[c.sets], &c.set[c.sets])) {
      MUST(!mpm_material_destroy(c.material[c.sets])); /* not on this grid */
      c.material[c.sets] = host_material(&c);
    }
  }
  MUST(!mpm_particles_add_field(c.set[0], "colour", MPM_U8, 3));
  MUST(!mpm_particles_add_field(c.set[0], "heat", MPM_F64, 1));
  open_stepper(&c);
  add(&c);
  for (int32_t i = 0; i < MOST_ACTIONS && fuzz_left(&c.in); ++i) {
    act(&c);
    check_state(&c);
  }
  close_cloud(&c);
  return 0;
}
