/* Free obstacles. They hit a free elastic block, off its centre and with friction; they come to rest on an
 * elastic bed, and float on a fluid; and a body of three unlike moments of inertia turns by itself. */
#include "verify.h"

#include <string.h>

/* ---- momenta of a rigid body --------------------------------------------------------------------------- */
/* v turned by a unit quaternion, or back. */
static void turned(const double *q, double sign, const double *v, double *out) {
  const double w = q[0], u[3] = {sign * q[1], sign * q[2], sign * q[3]};
  double t[3];
  for (int32_t k = 0; k < 3; ++k) {
    const int32_t a = (k + 1) % 3, b = (k + 2) % 3;
    t[k] = 2.0 * (u[a] * v[b] - u[b] * v[a]);
  }
  for (int32_t k = 0; k < 3; ++k) {
    const int32_t a = (k + 1) % 3, b = (k + 2) % 3;
    out[k] = v[k] + w * t[k] + u[a] * t[b] - u[b] * t[a];
  }
}

static void times(const double *A, const double *v, double *out) {
  for (int32_t i = 0; i < 3; ++i) out[i] = A[3 * i] * v[0] + A[3 * i + 1] * v[1] + A[3 * i + 2] * v[2];
}

/* Angular momentum about the centre of a body turned by q. */
static void spin_momentum(const double *inertia, const double *q, const double *spin, double *out) {
  double of_body[3], momentum[3];
  turned(q, -1.0, spin, of_body);
  times(inertia, of_body, momentum);
  turned(q, 1.0, momentum, out);
}

typedef struct totals {
  double momentum[3], angular[3], energy;
} totals;

/* Of the material and the obstacle. */
static totals sum_up(const mpm_step_info *info, const mpm_obstacle_desc *d, const mpm_obstacle *body) {
  double c[3], q[4], v[3], spin[3], own[3];
  if (mpm_obstacle_get_pose(body, c, q, v, spin)) exit(2);
  spin_momentum(d->inertia, q, spin, own);
  totals it = {.energy = info->kinetic_energy + info->affine_kinetic_energy + info->strain_energy};
  for (int32_t k = 0; k < 3; ++k) {
    const int32_t a = (k + 1) % 3, b = (k + 2) % 3;
    it.momentum[k] = info->momentum[k] + d->mass * v[k];
    it.angular[k] = info->angular_momentum[k] + d->mass * (c[a] * v[b] - c[b] * v[a]) + own[k];
    it.energy += 0.5 * d->mass * v[k] * v[k] + 0.5 * spin[k] * own[k];
  }
  return it;
}

static void set_box(mpm_obstacle_desc *d, int32_t dim, const double *half, double mass) {
  d->mass = mass;
  for (int32_t k = 0; k < 3; ++k) {
    d->size[k] = half[k];
    if (dim == 2 && k < 2) continue;
    d->inertia[4 * k] = mass / 3.0 * (pow(half[(k + 1) % 3], 2) + pow(half[(k + 2) % 3], 2));
  }
}

static void set_disc(mpm_obstacle_desc *d, double radius, double mass) {
  d->mass = mass;
  d->size[0] = radius;
  d->inertia[8] = 0.5 * mass * radius * radius;
}

/* ---- against a free block ------------------------------------------------------------------------------ */
typedef struct strike {
  const char *name;
  int32_t dim, shape;
  double ratio, offset, friction, turn, spin[3]; /* ratio: of masses */
} strike;

static double most(double so_far, const double *a, const double *b, double scale) {
  for (int32_t k = 0; k < 3; ++k) so_far = fmax(so_far, fabs(a[k] - b[k]) / scale);
  return so_far;
}

static void collide(const strike *a, FILE *table) {
  const double h = 0.05, half = 0.2, speed = 0.5, density = 1000.0, shift[3] = {0.013, 0.007, 0.021};
  const double low[3] = {-half, -half, -half}, high[3] = {half, half, half};
  const double block_mass = density * pow(2.0 * half, a->dim);
  verify_setup setup = verify_defaults(a->dim, 60, h);
  for (int32_t k = 0; k < a->dim; ++k) setup.grid.origin[k] = -1.5;
  setup.stepper.transfer = MPM_APIC;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *block = verify_set(&w, verify_elastic(&w, "neo_hookean", 1e4, 0.3, density));
  verify_fill_box(&w, block, low, high, 2);
  verify_place(&w, block, 0.0, shift);
  mpm_contact_desc contact;
  mpm_obstacle_desc d = verify_obstacle_defaults(&contact, a->shape, MPM_MOTION_FREE, a->friction, a->turn);
  if (a->shape == MPM_SHAPE_BOX)
    set_box(&d, a->dim, (const double[]){0.15, 0.1, 0.08}, a->ratio * block_mass);
  else
    set_disc(&d, 0.15, a->ratio * block_mass);
  d.position[0] = shift[0] - half - 0.22, d.position[1] = shift[1] + a->offset;
  if (a->dim == 3) d.position[2] = 0.03;
  d.velocity[0] = speed;
  memcpy(d.angular_velocity, a->spin, sizeof a->spin);
  const mpm_obstacle *body = verify_obstacle(&w, &d);

  mpm_step_info now = verify_info(&w);
  const totals start = sum_up(&now, &d, body);
  mpm_contact_info info = {.struct_size = sizeof info};
  double exchanged = 0.0, energy = 0.0, least = 0.0;
  double change[3] = {0.0}; /* of momentum, of angular momentum, of the block's less the impulse */
  while (now.t < 1.0) {
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin(0.4 * dt, 1.0 - now.t + 1e-12));
    verify_ok(&w, mpm_obstacle_contact_info(body, MPM_BODY_ANY, &info));
    const totals is = sum_up(&now, &d, body);
    exchanged += now.dt * hypot(hypot(info.force[0], info.force[1]), info.force[2]);
    change[0] = most(change[0], is.momentum, start.momentum, 1.0);
    change[1] = most(change[1], is.angular, start.angular, 2.0 * half);
    change[2] = most(change[2], now.momentum, info.impulse, 1.0);
    energy = fmax(energy, is.energy / start.energy);
    least = fmin(least, info.dissipation / start.energy);
  }
  const double reduced = d.mass * block_mass / (d.mass + block_mass) * speed;
  fprintf(table, "%s,%g,%.5f,%.2e,%.2e,%.2e,%.6f\n", a->name, a->ratio, exchanged / reduced,
          change[0] / exchanged, change[1] / exchanged, change[2] / exchanged, energy);
  verify_gate_of(a->name, "change of momentum / impulse", change[0] / exchanged, 0.0, 1e-11, "conservation");
  verify_gate_of(a->name, "change of angular momentum / (width times impulse)", change[1] / exchanged, 0.0,
                 1e-11, "conservation");
  verify_gate_of(a->name, "momentum of the block less impulse / impulse", change[2] / exchanged, 0.0, 1e-11,
                 "conservation");
  verify_gate_of(a->name, "largest energy / first", energy, 0.0, 1.0005,
                 "contact takes energy and never gives any");
  verify_gate_of(a->name, "least dissipation of a step / energy", least, -1e-12, 0.0, "contact takes energy");
  if (!(a->offset > 0.0))
    verify_gate_of(a->name, "impulse / that of bodies that stay together", exchanged / reduced, 1.0, 2.0,
                   "restitution between 0 and 1");
  verify_progress("%s", a->name);
  verify_close(&w);
}

/* ---- at rest ------------------------------------------------------------------------------------------- */
static const double gravity = 10.0;

static mpm_status resist(void *user, const mpm_particle_batch *b, double *add) {
  const double *drag = user;
  for (int32_t c = 0; c < 2; ++c)
    for (int64_t i = 0; i < b->n; ++i) add[c * b->ld + i] -= *drag * b->velocity[c * b->ld + i];
  return MPM_OK;
}

typedef struct rest {
  double force, speed, position[3], tilt; /* mean force of the last second, and largest speed */
} rest;

/* A basin, 0.4 deep, into which a free obstacle is dropped, up to the time `end`. Drag acts on both. */
static rest drop(const mpm_param *params, int32_t count, const char *law, double width, double drag,
                 double end, const mpm_obstacle_desc *d) {
  const double h = 0.05;
  verify_setup setup = verify_defaults(2, (int64_t)floor(width / h + 0.5), h);
  setup.stepper.gravity[1] = -gravity;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *basin = verify_set(&w, verify_material(&w, law, params, count));
  verify_fill_box(&w, basin, (const double[]){0.0, 0.0}, (const double[]){width, 0.4}, 2);
  for (int32_t face = MPM_X_MIN; face <= MPM_Y_MIN; ++face)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_acceleration(w.stepper, resist, &drag));
  mpm_obstacle *body = verify_obstacle(&w, d);
  mpm_step_info now = verify_info(&w);
  mpm_contact_info info = {.struct_size = sizeof info};
  rest out = {.speed = 0.0};
  double q[4], v[3], spin[3], force[3], torque[3], before = 0.0, since = 0.0;
  while (now.t < end) {
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin(0.4 * dt, end - now.t + 1e-12));
    verify_ok(&w, mpm_obstacle_contact_info(body, MPM_BODY_ANY, &info));
    verify_ok(&w, mpm_obstacle_get_pose(body, out.position, q, v, spin));
    for (int32_t k = 0; k < 3; ++k) {
      force[k] = -drag * d->mass * v[k];
      torque[k] = -drag * d->inertia[8] * spin[k];
    }
    verify_ok(&w, mpm_obstacle_set_load(body, force, torque));
    if (now.t < end - 1.0)
      before = info.impulse[1], since = now.t;
    else
      out.speed = fmax(out.speed, hypot(v[0], v[1]));
  }
  out.force = -(info.impulse[1] - before) / (now.t - since);
  out.tilt = 2.0 * fabs(atan2(q[3], q[0]));
  verify_close(&w);
  return out;
}

static void on_bed(double ratio, FILE *table) {
  const mpm_param bed[] = {{"E", 1e5}, {"nu", 0.3}, {"density", 1000.0}};
  const double radius = 0.2, gap = 0.01, mass = ratio * 1000.0 * 0.05 * 0.05;
  mpm_contact_desc contact;
  mpm_obstacle_desc d = verify_obstacle_defaults(&contact, MPM_SHAPE_SPHERE, MPM_MOTION_FREE, 0.3, 0.0);
  set_disc(&d, radius, mass);
  d.position[0] = 0.613, d.position[1] = 0.4 + radius + gap;
  const rest is = drop(bed, 3, "neo_hookean", 1.2, 20.0, 4.0, &d);
  const double speed = is.speed / sqrt(2.0 * gravity * gap);
  fprintf(table, "bed,%g,%.6f,%.2e,%.5f,,\n", ratio, is.force / (mass * gravity), speed, is.position[1]);
  char name[80];
  snprintf(name, sizeof name, "disc on a bed, mass / (density h^2) = %g", ratio);
  verify_gate_of(name, "force / weight", is.force / (mass * gravity), 0.99, 1.01, "equilibrium");
  verify_gate_of(name, "speed in the last second / that of the drop", speed, 0.0, 0.01,
                 "it rests; set tolerance");
  verify_progress("%s", name);
}

/* The box displaces its weight, and the level rises by what it displaces. */
static void afloat(double ratio, FILE *table) {
  const double width = 1.0, depth = 0.4, half[3] = {0.2, 0.1, 1.0}, gap = 0.01;
  const mpm_param water[] = {{"density", 1000.0},
                             {"bulk_modulus", 1000.0 * 400.0 * gravity * depth},
                             {"viscosity", 1e-3},
                             {"tension", 0.0}};
  mpm_contact_desc contact;
  mpm_obstacle_desc d = verify_obstacle_defaults(&contact, MPM_SHAPE_BOX, MPM_MOTION_FREE, 0.0, 0.0);
  const double mass = ratio * 1000.0 * 4.0 * half[0] * half[1], draught = ratio * 2.0 * half[1];
  set_box(&d, 2, half, mass);
  d.position[0] = 0.5, d.position[1] = depth + half[1] + gap;
  const rest is = drop(water, 4, "newtonian_fluid", width, 10.0, 4.0, &d);
  const double due = depth + half[1] - draught * (1.0 - 2.0 * half[0] / width);
  const double speed = is.speed / sqrt(2.0 * gravity * gap);
  fprintf(table, "afloat,%g,%.6f,%.2e,%.5f,%.5f,%.5f\n", ratio, is.force / (mass * gravity), speed,
          is.position[1], due, is.tilt);
  char name[80];
  snprintf(name, sizeof name, "box afloat, density ratio %g", ratio);
  verify_gate_of(name, "force / weight", is.force / (mass * gravity), 0.99, 1.01, "equilibrium");
  verify_gate_of(name, "height less that of Archimedes / h", (is.position[1] - due) / 0.05, -0.5, 0.5,
                 "Archimedes; gaps are known to half a cell");
  verify_gate_of(name, "tilt, rad", is.tilt, 0.0, 0.05, "it floats stably; set tolerance");
  verify_progress("%s", name);
}

/* ---- by itself ----------------------------------------------------------------------------------------- */
static const double tensor[9] = {2.0, 0.3, 0.1, 0.3, 1.2, 0.2, 0.1, 0.2, 2.6};

/* Euler's equations by the angular momentum L, which stays: q' = (0, spin) q / 2 with I spin = L. */
static void euler(const double *L, const double *q, double *rate) {
  const double *A = tensor;
  double inverse[9], of_body[3], spin_of_body[3], w[3];
  double determinant = 0.0;
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) {
      const int32_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, e = (i + 2) % 3;
      inverse[3 * i + j] = A[3 * a + c] * A[3 * b + e] - A[3 * a + e] * A[3 * b + c];
    }
  for (int32_t k = 0; k < 3; ++k) determinant += A[k] * inverse[3 * k];
  turned(q, -1.0, L, of_body);
  times(inverse, of_body, spin_of_body);
  turned(q, 1.0, spin_of_body, w);
  for (int32_t k = 0; k < 3; ++k) w[k] *= 0.5 / determinant;
  rate[0] = -w[0] * q[1] - w[1] * q[2] - w[2] * q[3];
  for (int32_t k = 0; k < 3; ++k) {
    const int32_t a = (k + 1) % 3, b = (k + 2) % 3;
    rate[1 + k] = q[0] * w[k] + w[a] * q[1 + b] - w[b] * q[1 + a];
  }
}

static void runge_kutta(const double *L, double *q, double dt) {
  static const double share[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
  double rate[4] = {0.0}, at[4], sum[4] = {0.0};
  for (int32_t stage = 0; stage < 4; ++stage) {
    for (int32_t k = 0; k < 4; ++k) at[k] = q[k] + share[stage] * dt * rate[k];
    euler(L, at, rate);
    for (int32_t k = 0; k < 4; ++k) sum[k] += weight[stage] * rate[k];
  }
  double length = 0.0;
  for (int32_t k = 0; k < 4; ++k) q[k] += dt / 6.0 * sum[k], length += q[k] * q[k];
  for (int32_t k = 0; k < 4; ++k) q[k] /= sqrt(length);
}

static void tumble(FILE *table) {
  enum { LEVELS = 3 };
  const double end = 4.0, inch[3] = {0.1, 0.1, 0.1};
  double dts[LEVELS], drift[LEVELS], attitude[LEVELS], change = 0.0, astray = 0.0;
  for (int32_t level = 0; level < LEVELS; ++level) {
    const double dt = 0.02 / (1 << level);
    verify_setup setup = verify_defaults(3, 20, 1.0);
    verify_world w;
    verify_open(&w, &setup);
    mpm_particles *far = verify_set(&w, verify_elastic(&w, "neo_hookean", 1.0, 0.0, 1.0));
    verify_fill_box(&w, far, (const double[]){1.0, 1.0, 1.0}, (const double[]){2.0, 2.0, 2.0}, 1);
    mpm_contact_desc contact;
    mpm_obstacle_desc d = verify_obstacle_defaults(&contact, MPM_SHAPE_BOX, MPM_MOTION_FREE, 0.0, 0.0);
    set_box(&d, 3, inch, 1.5);
    memcpy(d.inertia, tensor, sizeof tensor);
    const double spin[3] = {0.3, 2.0, 0.2}, velocity[3] = {0.1, 0.05, -0.02};
    for (int32_t k = 0; k < 3; ++k) {
      d.position[k] = 10.0;
      d.velocity[k] = velocity[k];
      d.angular_velocity[k] = spin[k];
    }
    const mpm_obstacle *body = verify_obstacle(&w, &d);
    double q[4] = {1.0, 0.0, 0.0, 0.0}, L[3], own[3], at[3], turn[4], now_spin[3];
    spin_momentum(tensor, q, spin, L);
    const double size = sqrt(L[0] * L[0] + L[1] * L[1] + L[2] * L[2]);
    const double energy = 0.5 * (L[0] * spin[0] + L[1] * spin[1] + L[2] * spin[2]);
    drift[level] = attitude[level] = 0.0, dts[level] = dt;
    for (int32_t step = 1; step * dt <= end + 1e-9; ++step) {
      verify_step(&w, dt);
      for (int32_t i = 0; i < 8; ++i) runge_kutta(L, q, dt / 8.0);
      verify_ok(&w, mpm_obstacle_get_pose(body, at, turn, NULL, now_spin));
      spin_momentum(tensor, turn, now_spin, own);
      change = most(change, own, L, size);
      const double is = 0.5 * (own[0] * now_spin[0] + own[1] * now_spin[1] + own[2] * now_spin[2]);
      drift[level] = fmax(drift[level], fabs(is / energy - 1.0));
      double same = 0.0, opposite = 0.0;
      for (int32_t k = 0; k < 4; ++k) same += pow(turn[k] - q[k], 2), opposite += pow(turn[k] + q[k], 2);
      attitude[level] = fmax(attitude[level], 2.0 * sqrt(fmin(same, opposite)));
      for (int32_t k = 0; k < 3; ++k) astray = fmax(astray, fabs(at[k] - 10.0 - velocity[k] * step * dt));
    }
    fprintf(table, "%g,%.3e,%.3e\n", dt, drift[level], attitude[level]);
    verify_close(&w);
  }
  verify_gate("tumbles: change of angular momentum", change, 0.0, 1e-12, "conservation");
  verify_gate("tumbles: centre astray", astray, 0.0, 1e-12, "conservation");
  verify_gate("tumbles: order of the drift of energy", verify_slope(LEVELS, dts, drift), 1.8, HUGE_VAL,
              "order 2");
  verify_gate("tumbles: order of the attitude", verify_slope(LEVELS, dts, attitude), 1.8, HUGE_VAL,
              "Euler's equations by Runge and Kutta; order 2");
}

int main(int argc, char **argv) {
  verify_begin("obstacle_free", argc, argv);
  FILE *hits = verify_csv("obstacle_free_hits"), *rests = verify_csv("obstacle_free_rests"),
       *turns = verify_csv("obstacle_free_tumble");
  fprintf(hits, "case,ratio,impulse,momentum,angular,block,energy\n");
  fprintf(rests, "case,ratio,force,speed,height,due,tilt\n");
  fprintf(turns, "dt,energy,attitude\n");
  static const strike strikes[6] = {
      {"disc hits the middle", 2, MPM_SHAPE_SPHERE, 1.0, 0.0, 0.3, 0.0, {0.0}},
      {"disc of mass ratio 0.01", 2, MPM_SHAPE_SPHERE, 0.01, 0.11, 0.3, 0.0, {0.0}},
      {"disc of mass ratio 1", 2, MPM_SHAPE_SPHERE, 1.0, 0.11, 0.3, 0.0, {0.0}},
      {"disc of mass ratio 100", 2, MPM_SHAPE_SPHERE, 100.0, 0.11, 0.3, 0.0, {0.0}},
      {"rectangle that turns", 2, MPM_SHAPE_BOX, 1.0, 0.05, 0.3, 0.4, {0.0, 0.0, 2.0}},
      {"box that tumbles", 3, MPM_SHAPE_BOX, 1.0, 0.05, 0.3, 0.4, {1.0, -0.5, 0.7}}};
  for (int32_t k = 0; k < 6; ++k) collide(&strikes[k], hits);
  for (int32_t k = 0; k < 3; ++k) on_bed(pow(100.0, k - 1), rests);
  static const double densities[3] = {0.5, 0.1, 0.01};
  for (int32_t k = 0; k < (verify_quick() ? 1 : 3); ++k) afloat(densities[k], rests);
  tumble(turns);
  fclose(hits);
  fclose(rests);
  fclose(turns);
  return verify_end();
}
