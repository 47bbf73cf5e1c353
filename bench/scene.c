#define _POSIX_C_SOURCE 200809L
#include "scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const mpm_param parameters[] = {
    {"E", 1.0}, {"nu", 0.3}, {"density", 1.0}, {"yield_stress", 0.02}, {"hardening", 0.1}};
static const mpm_param of_soil[] = {
    {"E", 1.0}, {"nu", 0.3}, {"density", 1.0}, {"phi", 20.0}, {"cohesion", 0.01}};
static const mpm_param of_mud[] = {{"bulk_modulus", 0.8333333333333334},
                                   {"shear_modulus", 0.38461538461538464},
                                   {"density", 1.0},
                                   {"yield_shear", 0.01},
                                   {"consistency", 0.01},
                                   {"n", 0.6}};
static const mpm_param of_snow[] = {{"E", 1.0}, {"nu", 0.3}, {"density", 1.0}};
static const mpm_param of_grains[] = {
    {"E", 1.0},    {"nu", 0.3},  {"density", 1.0},         {"mu_s", 0.4},
    {"mu_2", 0.7}, {"I_0", 0.3}, {"grain_diameter", 0.01}, {"grain_density", 2.0}};
/* At this pressure the bulk modulus is that of the others. */
#define CLAY_PRESSURE 0.016666666666666666
static const mpm_param of_clay[] = {{"kappa", 0.02},
                                    {"lambda", 0.2},
                                    {"M", 1.0},
                                    {"mu0", 0.38461538461538464},
                                    {"density", 1.0},
                                    {"p_ref", CLAY_PRESSURE},
                                    {"pc0", 1.2 * CLAY_PRESSURE}};
/* Laws that yield; kept: how many values of state a step reads; pressure: what they start with. */
typedef struct plastic_law {
  const char *law;
  const mpm_param *params;
  int32_t count, kept;
  double pressure;
} plastic_law;
static const plastic_law plastic_laws[] = {{"j2", parameters, 5, 1, 0.0},
                                           {"drucker_prager", of_soil, 5, 2, 0.0},
                                           {"mohr_coulomb", of_soil, 5, 2, 0.0},
                                           {"herschel_bulkley", of_mud, 6, 0, 0.0},
                                           {"snow", of_snow, 3, 6, 0.0},
                                           {"mu_i", of_grains, 8, 2, 0.0},
                                           {"cam_clay", of_clay, 7, 2, CLAY_PRESSURE}};

static const plastic_law *plastic_law_of(const bench_case *of) {
  for (size_t k = 0; k < sizeof plastic_laws / sizeof *plastic_laws; ++k)
    if (!strcmp(of->law, plastic_laws[k].law)) return &plastic_laws[k];
  return NULL;
}
static const double sound = 1.1602387022306428; /* of the law: sqrt((lambda + 2 mu) / density) */

static double uniform(uint64_t *state) {
  *state ^= *state << 13;
  *state ^= *state >> 7;
  *state ^= *state << 17;
  return (double)(*state >> 11) * 0x1p-53;
}

static void shuffle(int64_t n, int64_t *order, uint64_t *dice) {
  for (int64_t i = 0; i < n; ++i) order[i] = i;
  for (int64_t i = n - 1; i > 0; --i) {
    const int64_t j = (int64_t)(uniform(dice) * (double)(i + 1)), swap = order[i];
    order[i] = order[j];
    order[j] = swap;
  }
}

/* A lattice of side^dim particles, 2^dim per cell, from `corner` on; the first part[k] of them on
 * each axis are those of another body. */
typedef struct lattice {
  int32_t dim;
  int64_t side, part[3];
  int32_t jittered;
  double corner;
} lattice;

static lattice lattice_of(const bench_case *of, int64_t side, double corner) {
  const int32_t divided = of->extras == BENCH_CORNER || of->extras == BENCH_HALVES;
  lattice l = {.dim = of->dim,
               .side = side,
               .part = {0, 0, 0},
               .corner = corner,
               .jittered = of->extras != BENCH_TOTAL_LATTICE};
  for (int32_t k = 0; k < of->dim && divided; ++k)
    l.part[k] = of->extras == BENCH_CORNER ? 18 : k ? side : side / 4 * 2;
  return l;
}

/* The particles of the part, or all others, one random place of the lattice after the other. */
static mpm_status place(mpm_particles *set, const lattice *l, int32_t part) {
  const int32_t dim = l->dim;
  const int64_t side = l->side;
  uint64_t dice = 88172645463325252u;
  int64_t n = 1;
  for (int32_t k = 0; k < dim; ++k) n *= side;
  double *x = malloc((size_t)(n * dim) * sizeof *x), *volume = malloc((size_t)n * sizeof *volume);
  int64_t *order = malloc((size_t)n * sizeof *order);
  mpm_status status = MPM_E_NOMEM;
  if (x && volume && order) {
    shuffle(n, order, &dice);
    int64_t count = 0;
    for (int64_t i = 0; i < n; ++i) {
      double at[3];
      int32_t in_part = 1;
      for (int32_t k = 0; k < dim; ++k, order[i] /= side) {
        at[k] =
            l->corner + 0.5 * ((double)(order[i] % side) + (l->jittered ? 0.25 + 0.5 * uniform(&dice) : 0.5));
        in_part &= order[i] % side < l->part[k];
      }
      if (in_part != part) continue;
      for (int32_t k = 0; k < dim; ++k) x[k * n + count] = at[k];
      volume[count++] = pow(0.5, dim);
    }
    free(order); /* before the set grows: the peak of memory is to be the library's */
    order = NULL;
    for (int32_t k = 1; k < dim; ++k) memmove(x + k * count, x + k * n, (size_t)count * sizeof *x);
    status = mpm_particles_add(set, count, x, NULL, volume, NULL, NULL, NULL);
  }
  free(x), free(volume), free(order);
  return status;
}

/* A velocity linear in place, in pieces. */
static mpm_status set_velocities(mpm_particles *set, const bench_case *of, const lattice *l) {
  enum { PIECE = 4096 };
  static double x[3 * PIECE], v[3 * PIECE];
  static int64_t id[PIECE];
  const double half = 0.25 * (double)l->side;
  const int64_t n = mpm_particles_count(set);
  mpm_status status = MPM_OK;
  for (int64_t begin = 0; begin < n && !status; begin += PIECE) {
    const int64_t count = n - begin < PIECE ? n - begin : PIECE;
    for (int64_t i = 0; i < count; ++i) id[i] = begin + i;
    if ((status = mpm_particles_get(set, "position", MPM_F64, of->dim, count, id, x))) break;
    for (int64_t i = 0; i < count; ++i) {
      double at[3] = {0.0, 0.0, 0.0};
      for (int32_t k = 0; k < of->dim; ++k) at[k] = (x[k * count + i] - l->corner) / half - 1.0;
      const double rate[3] = {0.15 * at[2] - 0.85 * at[1], 0.7 * at[0] - 0.3 * at[2],
                              0.25 * at[0] + 0.15 * at[1]};
      for (int32_t k = 0; k < of->dim; ++k)
        v[k * count + i] = of->speed * sound * (of->dim > 1 ? rate[k] : 0.6 + 0.4 * at[0]);
    }
    status = mpm_particles_set(set, "velocity", MPM_F64, of->dim, count, id, v);
  }
  return status;
}

/* Temperatures that change along the first axis. With this conductivity the steps of the motion are as long
 * as explicit conduction allows, to a third. */
static mpm_status add_heat(bench_scene *scene, const bench_case *of) {
  enum { PIECE = 4096 };
  static double x[3 * PIECE], T[PIECE];
  static int64_t id[PIECE];
  const int64_t n = mpm_particles_count(scene->body);
  mpm_heat_desc d;
  mpm_status status = mpm_heat_desc_init(&d, sizeof d);
  d.specific_heat = 1.0;
  d.conductivity = 0.2;
  if (!status) status = mpm_stepper_set_heat(scene->stepper, scene->body, &d);
  if (!status && of->extras == BENCH_HEAT_IMPLICIT)
    status = mpm_stepper_set_conduction(scene->stepper, MPM_CONDUCTION_IMPLICIT, 1e-8);
  for (int64_t begin = 0; begin < n && !status; begin += PIECE) {
    const int64_t count = n - begin < PIECE ? n - begin : PIECE;
    for (int64_t i = 0; i < count; ++i) id[i] = begin + i;
    if ((status = mpm_particles_get(scene->body, "position", MPM_F64, of->dim, count, id, x))) break;
    for (int64_t i = 0; i < count; ++i) T[i] = sin(0.3 * x[i]);
    status = mpm_particles_set(scene->body, "temperature", MPM_F64, 1, count, id, T);
  }
  return status;
}

/* A constant force, as a host would add one. */
static mpm_status add_constant(void *user, const mpm_particle_batch *batch, double *add) {
  (void)user;
  for (int32_t c = 0; c < batch->dim; ++c)
    for (int64_t i = 0; i < batch->n; ++i) add[c * batch->ld + i] += 1e-6;
  return MPM_OK;
}

/* The library's neo-Hookean law (Steffen et al. 2008, eq. 46), as a host would write it. */
static mpm_status host_law(void *user, const mpm_material_batch *b) {
  const double *constants = user, lambda = constants[0], mu = constants[1];
  const int64_t ld = b->ld;
  for (int64_t i = 0; i < b->n; ++i) {
    const double *F = b->F + i;
    const double a = F[0], d = F[ld], e = F[2 * ld], f = F[3 * ld], g = F[4 * ld], h = F[5 * ld],
                 p = F[6 * ld], q = F[7 * ld], r = F[8 * ld];
    const double J = a * (g * r - h * q) - d * (f * r - h * p) + e * (f * q - g * p), inverse = 1.0 / J;
    const double log_J = log(J), pressure = (lambda * log_J - mu) * inverse, shear = mu * inverse;
    const double xx = a * a + d * d + e * e, yy = f * f + g * g + h * h, zz = p * p + q * q + r * r;
    double *stress = b->stress_new + i;
    stress[0] = pressure + shear * xx;
    stress[ld] = pressure + shear * yy;
    stress[2 * ld] = pressure + shear * zz;
    stress[3 * ld] = shear * (a * f + d * g + e * h);
    stress[4 * ld] = shear * (f * p + g * q + h * r);
    stress[5 * ld] = shear * (a * p + d * q + e * r);
    b->wave_speed[i] = sqrt(lambda + mu + mu * fmax(xx, fmax(yy, zz)));
    b->energy[i] = 0.5 * lambda * log_J * log_J + mu * (0.5 * (xx + yy + zz - 3.0) - log_J);
  }
  return MPM_OK;
}

static mpm_status make_material(bench_scene *scene, const bench_case *of) {
  static double constants[2] = {0.3 / (1.3 * 0.4), 1.0 / 2.6}; /* lambda, mu */
  const plastic_law *plastic = plastic_law_of(of);
  if (plastic)
    return mpm_material_create(scene->context, of->law, plastic->params, plastic->count, &scene->material);
  if (of->extras != BENCH_HOST_LAW)
    return mpm_material_create(scene->context, of->law, parameters, 3, &scene->material);
  mpm_material_desc desc;
  mpm_material_desc_init(&desc, sizeof desc);
  desc.density = 1.0;
  desc.stress = host_law;
  desc.user = constants;
  return mpm_material_create_custom(scene->context, &desc, &scene->material);
}

static mpm_status add_set(bench_scene *scene, const bench_case *of, const lattice *l, int32_t part,
                          mpm_particles **set) {
  mpm_status status = mpm_particles_create(scene->context, scene->grid, scene->material, set);
  if (!status) status = place(*set, l, part);
  if (!status) status = set_velocities(*set, of, l);
  const plastic_law *plastic = plastic_law_of(of);
  const double p = plastic ? plastic->pressure : 0.0, stress[6] = {-p, -p, -p, 0.0, 0.0, 0.0};
  if (!status && p > 0.0) status = mpm_particles_set_all(*set, "stress", MPM_F64, 6, stress);
  if (!status) status = mpm_stepper_add(scene->stepper, *set);
  if (!status && part) status = mpm_stepper_set_body(scene->stepper, *set, part);
  scene->particles += mpm_particles_count(*set);
  return status;
}

/* Beyond the body along each axis. */
static mpm_status add_obstacles(bench_scene *scene, const bench_case *of, const lattice *l) {
  mpm_contact_desc contact;
  mpm_obstacle_desc d;
  mpm_status status = mpm_contact_desc_init(&contact, sizeof contact);
  if (!status) status = mpm_obstacle_desc_init(&d, sizeof d);
  for (int32_t i = 0; i < BENCH_MOST_OBSTACLES && !status; ++i) {
    d.contact = &contact;
    d.shape = MPM_SHAPE_SPHERE;
    d.size[0] = 2.0;
    for (int32_t k = 0; k < of->dim; ++k)
      d.position[k] = l->corner + (0.1 * i + 0.05) * 0.5 * (double)l->side;
    d.position[i % of->dim] = i % 2 ? 4.0 : 2.0 * l->corner + 0.5 * (double)l->side - 4.0;
    status = mpm_obstacle_create(scene->context, &d, &scene->obstacle[i]);
    if (!status) status = mpm_stepper_add_obstacle(scene->stepper, scene->obstacle[i]);
  }
  return status;
}

/* Holds the middle of the body along y: half as wide as that, and in 3-D a helix as deep. */
static mpm_status add_surface(bench_scene *scene, const bench_case *of, const lattice *l, int64_t markers) {
  mpm_surface_desc d;
  mpm_status status = mpm_surface_desc_init(&d, sizeof d);
  d.prescribes = MPM_PRESCRIBES_NORMAL;
  if (!status) status = mpm_surface_create(scene->context, scene->grid, &d, &scene->surface);
  const double half = 0.125 * (double)l->side, middle = l->corner + 2.0 * half;
  for (int64_t i = 0; i < markers && !status; ++i) {
    const double at = (2.0 * (double)i + 1.0) / (double)markers - 1.0;
    const double x[3] = {middle + half * at, middle, middle + half * (fmod(16.0 * at + 16.0, 2.0) - 1.0)};
    double area[3] = {0.0, 2.0 * half / (double)markers, 0.0};
    if (of->dim == 1) area[0] = 1.0;
    status = mpm_surface_add(scene->surface, 1, x, area, NULL);
  }
  return status ? status : mpm_stepper_add_surface(scene->stepper, scene->surface);
}

static mpm_status add_extras(bench_scene *scene, const bench_case *of, const lattice *l) {
  mpm_status status = MPM_OK;
  mpm_contact_desc contact;
  if (of->extras == BENCH_OBSTACLES) status = add_obstacles(scene, of, l);
  if (scene->part && !(status = mpm_contact_desc_init(&contact, sizeof contact)))
    status = mpm_stepper_set_contact(scene->stepper, 0, 1, &contact);
  if (of->extras == BENCH_HEAT || of->extras == BENCH_HEAT_IMPLICIT) status = add_heat(scene, of);
  if (of->extras == BENCH_FORCE) status = mpm_stepper_set_force(scene->stepper, add_constant, NULL);
  for (int32_t face = 0; face < 2 * of->dim && of->extras == BENCH_WALLS && !status; ++face)
    status = mpm_stepper_set_wall(scene->stepper, face, MPM_WALL_SLIP, 0.0);
  return status;
}

static void *counted_alloc(void *user, size_t bytes, size_t alignment) {
  void *memory;
  ++*(int64_t *)user;
  return posix_memalign(&memory, alignment, bytes) ? NULL : memory;
}
static void counted_release(void *user, void *memory, size_t bytes, size_t alignment) {
  (void)user, (void)bytes, (void)alignment;
  free(memory);
}

mpm_status bench_open(bench_scene *scene, const bench_case *of, const bench_options *options) {
  *scene = (bench_scene){0};
  mpm_context_desc services;
  mpm_context_desc_init(&services, sizeof services);
  services.concurrency = options->threads;
  services.alloc = counted_alloc;
  services.release = counted_release;
  services.alloc_user = &scene->allocations;
  mpm_status status = mpm_context_create(&services, &scene->context);
  if (status) return status;
  const int64_t side = (int64_t)llround(pow((double)options->particles, 1.0 / of->dim));
  const double cells = ceil(0.5 * (double)side);
  /* with walls the body lies in a corner of its grid, two cells from the faces */
  const double corner = of->extras == BENCH_WALLS ? 2.0 : floor(0.5 * (options->spread - 1.0) * cells);
  mpm_grid_desc g;
  mpm_grid_desc_init(&g, sizeof g);
  g.dim = of->dim;
  g.basis = of->basis;
  g.boundary_basis = of->extras == BENCH_OPEN_KNOTS ? MPM_BOUNDARY_OPEN_KNOT : MPM_BOUNDARY_GHOST;
  g.total_lagrangian = of->extras == BENCH_TOTAL || of->extras == BENCH_TOTAL_LATTICE;
  for (int32_t k = 0; k < of->dim; ++k) {
    g.spacing[k] = 1.0;
    g.cells[k] = of->extras == BENCH_WALLS ? (int64_t)cells + 4 : (int64_t)(options->spread * cells);
  }
  mpm_stepper_desc s;
  mpm_stepper_desc_init(&s, sizeof s);
  s.scheme = of->scheme;
  s.transfer = of->transfer;
  s.position_order = of->extras == BENCH_SECOND_ORDER ? 2 : 1;
  s.locking_remedy = of->extras == BENCH_REMEDY;
  const lattice l = lattice_of(of, side, corner);
  if ((status = mpm_grid_create(scene->context, &g, &scene->grid)) || (status = make_material(scene, of)) ||
      (status = mpm_stepper_create(scene->context, scene->grid, &s, &scene->stepper)) ||
      (status = add_set(scene, of, &l, 0, &scene->body)) ||
      (l.part[0] && (status = add_set(scene, of, &l, 1, &scene->part))))
    return status;
  status = add_extras(scene, of, &l);
  return status || !options->markers ? status : add_surface(scene, of, &l, options->markers);
}

/* Older libraries, beside which cases are run, lack functions: only a case that needs one calls it. */
void bench_close(bench_scene *scene) {
  mpm_stepper_destroy(scene->stepper);
  if (scene->surface) mpm_surface_destroy(scene->surface);
  for (int32_t i = 0; i < BENCH_MOST_OBSTACLES && scene->obstacle[i]; ++i)
    mpm_obstacle_destroy(scene->obstacle[i]);
  mpm_particles_destroy(scene->part);
  mpm_particles_destroy(scene->body);
  mpm_material_destroy(scene->material);
  mpm_grid_destroy(scene->grid);
  mpm_context_destroy(scene->context);
}

static int32_t has_orders(const bench_case *of) {
  return of->transfer == MPM_XPIC || of->transfer == MPM_FMPM;
}

static int32_t is_affine(const bench_case *of) {
  return of->transfer != MPM_FLIP && !has_orders(of);
}

static int32_t width_of(const bench_case *of) {
  return of->basis == MPM_LINEAR ? 2 : of->basis == MPM_BSPLINE3 ? 4 : 3;
}

double bench_nodes(const bench_case *of) {
  return pow(width_of(of), of->dim);
}

/* The factored sums of the transfers, unused components of vectors left out, then what is done per particle:
 * weights, packing, F, volume, law, energies. */
double bench_flops(const bench_case *of) {
  const int32_t d = of->dim, width = width_of(of);
  const int32_t mls = of->transfer == MPM_APIC_MLS, apic = is_affine(of) && !mls;
  double scatter = 0.0, gather = 0.0;
  for (int32_t axis = d - 1; axis >= 0; --axis) {
    const double each = pow(width, axis + 1); /* nodes, rows or planes */
    const int32_t behind = d - 1 - axis;      /* columns that are already slopes */
    if (mls) {
      scatter += each * (axis == d - 1 ? 3.0 : 2.5) * (d + 1);
      gather += each * (3.0 * d + 2.0 * d * behind);
    } else {
      scatter += each * (2.0 * (d + 1 + d) + 2.0 * d + (apic ? 2.0 * d : 0.0) + d * behind);
      gather += each * (2.0 * (apic ? d : 2 * d) + 2.0 * d + (apic ? 2.0 * d : 0.0) +
                        2.0 * d * behind * (apic ? 2 : 1));
    }
  }
  if (of->scheme != MPM_USL) scatter *= 1.5, gather *= 1.6; /* one more projection and one more gather */
  if (has_orders(of)) scatter *= 1.5, gather *= 2.2;
  if (of->extras == BENCH_REMEDY) gather *= 1.6;
  return scatter + gather + 2.0 * 22.0 * d + d * (d + 4.0) + 2.0 * d * d * d + 14.0 + 30.0 * d + 40.0;
}

int32_t bench_yields(const bench_case *of) {
  return plastic_law_of(of) != NULL;
}

/* P2G reads x, v, m, V, stress (and C); G2P reads x, v, F, m, V0 and writes x, v, F, V, stress (and C); MUSL
 * and USF, XPIC, FMPM and the remedy read and write some of it again. */
double bench_bytes(const bench_case *of) {
  const int32_t d = of->dim, F = d == 1 ? 1 : d == 2 ? 5 : 9, stress = d == 1 ? 3 : d == 2 ? 4 : 6;
  int32_t values = (2 * d + 2 + stress) + (2 * d + F + 2) + (2 * d + F + 1 + stress);
  if (is_affine(of)) values += 2 * d * d;
  if (plastic_law_of(of)) values += stress + 2 * plastic_law_of(of)->kept;
  if (of->scheme != MPM_USL) values += 2 * d + 1 + d;
  if (has_orders(of)) values += 3 * (2 * d);
  if (of->extras == BENCH_REMEDY) values += d + 3;
  return 8.0 * values;
}
