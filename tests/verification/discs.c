#include "discs.h"

const double disc_radius = 0.2, disc_speed = 0.14142135623730951;
const char *const disc_reference = "own FEM, 23040 elements; set tolerance";
static const double distance = 0.42426406871192851;

void disc_fill(const verify_world *w, mpm_particles *set, const double *centre, double radius,
               const double *v, double spacing) {
  enum { MOST = 1 << 16 };
  const int32_t n = (int32_t)ceil(radius / spacing);
  double *x = verify_array(2 * MOST), *volume = verify_array(MOST);
  int64_t count = 0;
  for (int32_t pass = 0; pass < 2; ++pass) {
    int64_t at = 0;
    for (int32_t i = -n; i < n; ++i)
      for (int32_t j = -n; j < n; ++j) {
        const double place[2] = {(i + 0.5) * spacing, (j + 0.5) * spacing};
        if (place[0] * place[0] + place[1] * place[1] > radius * radius) continue;
        for (int32_t c = 0; c < 2 && pass; ++c) x[c * count + at] = centre[c] + place[c];
        ++at;
      }
    count = at;
  }
  for (int64_t i = 0; i < count; ++i) volume[i] = PI * radius * radius / (double)count;
  verify_ok(w, mpm_particles_add(set, count, x, NULL, volume, NULL, NULL, NULL));
  verify_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  free(x);
  free(volume);
}

void disc_fill_shells(const verify_world *w, mpm_particles *set, const double *centre, double radius,
                      const double *v, int32_t half, double spacing) {
  const int32_t n = (int32_t)floor(radius / spacing + 0.5), first = half ? 0 : -n;
  const int64_t count = 2LL * n * (n - first);
  double *x = verify_array(2 * count), *volume = verify_array(count);
  int64_t at = 0;
  for (int32_t i = first; i < n; ++i)
    for (int32_t j = -n; j < n; ++j, ++at) {
      const double p[2] = {(i + 0.5) * spacing, (j + 0.5) * spacing};
      const double share = fmax(fabs(p[0]), fabs(p[1])) / hypot(p[0], p[1]);
      for (int c = 0; c < 2; ++c) x[c * count + at] = centre[c] + share * p[c];
      volume[at] = share * spacing * share * spacing;
    }
  verify_ok(w, mpm_particles_add(set, count, x, NULL, volume, NULL, NULL, NULL));
  verify_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  free(x);
  free(volume);
}

double disc_spin(const verify_world *w, const mpm_particles *set, const double *e, double *velocity) {
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 2), *v = verify_get(w, set, "velocity", 2), centre[4] = {0.0};
  for (int64_t i = 0; i < n; ++i)
    for (int c = 0; c < 2; ++c)
      centre[c] += x[c * n + i] / (double)n, centre[2 + c] += v[c * n + i] / (double)n;
  double angular = 0.0, inertia = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    const double a = x[i] - centre[0], b = x[n + i] - centre[1];
    angular += a * (v[n + i] - centre[3]) - b * (v[i] - centre[2]);
    inertia += a * a + b * b;
  }
  *velocity = centre[2] * e[0] + centre[3] * e[1];
  free(x);
  free(v);
  return angular / inertia;
}

double disc_outlines_meet(int cells, double angle) {
  const double spacing = 0.5 / cells, e[2] = {fabs(cos(angle)), fabs(sin(angle))};
  const int32_t n = (int32_t)ceil(disc_radius / spacing);
  double most = 0.0;
  for (int32_t i = 0; i < n; ++i)
    for (int32_t j = 0; j < n; ++j)
      if (hypot(i + 0.5, j + 0.5) * spacing <= disc_radius)
        most = fmax(most, spacing * ((i + 1) * e[0] + (j + 1) * e[1]));
  return (distance - most) / disc_speed;
}

/* Prescribed particles four cells deep below the plane y = shift[1] h. */
static void lay_rigid_body(verify_world *w, const disc_hit *a, double h) {
  static const uint8_t all[2] = {1, 1};
  const double low[2] = {-12.0 * ceil(0.04 / h) * h, -4.0 * h}, high[2] = {-low[0], 0.0};
  mpm_particles *body = verify_set(w, w->material[0]);
  verify_fill_box(w, body, low, high, 2);
  verify_place(w, body, 0.0, (const double[]){a->shift[0] * h, a->shift[1] * h});
  verify_ok(w, mpm_particles_set_all(body, "prescribed", MPM_U8, 2, all));
  verify_ok(w, mpm_stepper_set_body(w->stepper, body, 1));
}

disc_outcome disc_collide(const disc_hit *a, FILE *history) {
  const double h = 1.0 / a->cells, e[2] = {cos(a->angle), sin(a->angle)}, side[2] = {-e[1], e[0]};
  const double R = disc_radius, speed = disc_speed, mass = 1000.0 * PI * R * R;
  const int discs = a->against == ON_BODY && !a->rigid ? 2 : 1;
  verify_setup setup = verify_defaults(2, (int64_t)ceil(1.5 / h), h);
  setup.grid.basis = a->basis;
  setup.grid.origin[0] = setup.grid.origin[1] = -ceil(0.75 / h) * h;
  if (a->against == ON_WALL) setup.grid.origin[1] = 0.0;
  setup.stepper.scheme = a->scheme;
  setup.stepper.transfer = a->transfer;
  verify_world w;
  verify_open(&w, &setup);
  for (int i = 0; i < discs; ++i) {
    const double sign = i ? 1.0 : -1.0;
    double centre[2], v[2];
    for (int c = 0; c < 2; ++c) {
      centre[c] = sign * (distance * e[c] - 0.5 * a->offset * R * side[c]) + a->shift[c] * h;
      v[c] = -sign * speed * e[c];
    }
    mpm_particles *disc = verify_set(&w, verify_elastic(&w, "neo_hookean", 1000.0, 0.3, 1000.0));
    if (a->shells)
      disc_fill_shells(&w, disc, centre, R, v, 0, 0.5 * h);
    else
      disc_fill(&w, disc, centre, R, v, 0.5 * h);
    verify_ok(&w, mpm_stepper_set_body(w.stepper, disc, i));
  }
  if (a->rigid) lay_rigid_body(&w, a, h);
  support other = {.kind = a->against};
  support_lay(&w, &other, a->friction, a->angle + 0.5 * PI,
              (const double[]){a->shift[0] * h, a->shift[1] * h});

  mpm_step_info now = verify_info(&w);
  const mpm_step_info first = now;
  const double start = now.kinetic_energy;
  mpm_contact_info info = {.struct_size = sizeof info};
  disc_outcome out = {.touch = -1.0, .least = HUGE_VAL};
  double sample = 0.0, steady = 0.0;
  for (;;) {
    const double energy = (now.kinetic_energy + now.affine_kinetic_energy + now.strain_energy) / start;
    double p[2] = {now.momentum[0], now.momentum[1]};
    for (int c = 0; c < 2 && discs == 1; ++c) p[c] -= first.momentum[c] + info.impulse[c];
    if (now.kinetic_energy < out.least) out.least = now.kinetic_energy, out.when = now.t;
    out.energy = fmax(out.energy, energy);
    out.energy_end = energy;
    out.momentum = fmax(out.momentum, hypot(p[0], p[1]) / (mass * speed));
    out.angular =
        fmax(out.angular, fabs(now.angular_momentum[2] - first.angular_momentum[2]) / (mass * speed * R));
    out.dissipation =
        fmin(out.dissipation, (discs == 1 ? info.dissipation : now.contact_dissipation) / start);
    if (history && now.t >= sample) {
      fprintf(history, "%.5f,%.6e,%.6e,%.6e\n", now.t, now.kinetic_energy, now.strain_energy, energy);
      sample += 0.02;
    }
    if (now.t >= 3.6 - 1e-12) break;
    double dt;
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin((a->cfl > 0.0 ? a->cfl : 0.4) * dt, 3.6 - now.t));
    info = support_info(&w, &other);
    const double force = hypot(info.force[0], info.force[1]);
    steady += (force - steady) * fmin(1.0, now.dt / 0.03);
    out.force = fmax(out.force, force);
    out.steady = fmax(out.steady, steady);
    if (!info.touching) continue;
    out.part = now.t;
    if (out.touch < 0.0) out.touch = now.t;
  }
  out.least *= 2.0 / discs;
  for (int i = 0; i < discs; ++i) {
    double v;
    const double spin = disc_spin(&w, w.set[i], e, &v);
    out.rebound += (i ? v : -v) / speed / discs;
    if (fabs(spin) >= fabs(out.spin)) out.spin = spin;
  }
  verify_close(&w);
  return out;
}
