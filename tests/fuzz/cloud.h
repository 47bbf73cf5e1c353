/* A cloud: small sets of particles, a grid, materials, a stepper, obstacles and surfaces, with any options
 * that the headers name, drawn from an input; and the callbacks that it has. */
#ifndef CLOUD_H
#define CLOUD_H

#include "fuzz.h"

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
  int64_t count, removed, came;      /* of all sets; through open walls; by adaption */
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
  c->g.basis = FUZZ_PICK(&c->in, basis);
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
  c->g.total_lagrangian = fuzz_below(&c->in, 4) == 0;
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
  d.scheme = FUZZ_PICK(&c->in, scheme);
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
  d.shape = FUZZ_PICK(&c->in, shapes);
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
  switch (fuzz_below(&c->in, 9)) {
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
  case 7:
    fuzz_status(c->context, mpm_surface_set(*s, "prescribed_velocity", MPM_F64, c->g.dim, 1, &id, a));
    if (!fuzz_status(c->context, mpm_stepper_surface_reaction(c->stepper, *s, x)))
      for (int32_t k = 0; k < c->g.dim; ++k) MUST(isfinite(x[k]));
    break;
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
  d.prescribes = fuzz_below(&c->in, 5) - 1; /* one that there is not, and nothing twice as often */
  d.prescribes = d.prescribes > 2 ? 0 : d.prescribes;
  for (int32_t k = 0; k < 3; ++k) d.velocity[k] = fuzz_between(&c->in, -1.0, 1.0);
  if (fuzz_below(&c->in, 2)) d.penalty = fuzz_between(&c->in, -1.0, 1e4);
  if (fuzz_below(&c->in, 2)) d.modulus = fuzz_between(&c->in, -1.0, 1e3);
  if (*s) {
    change_surface(c, s, &d);
    return;
  }
  if (fuzz_status(c->context, mpm_surface_create(c->context, c->grid, &d, s))) return;
  if (fuzz_below(&c->in, 2)) MUST(!mpm_surface_set_traction(*s, drag, c));
  if (fuzz_below(&c->in, 2)) MUST(!mpm_surface_set_velocity(*s, drag, c));
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

#endif
