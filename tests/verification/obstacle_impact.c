/* The disc of discs.h hits the plane of an obstacle, a friction wall and a body of prescribed particles.
 * Another disc is pressed between two plates, of which one comes nearer and stops. */
#include "discs.h"

/* A series of hits. Whether they touch in time is asked where the rim of the lattice is flat. */
typedef struct hits {
  const char *name;
  int32_t against, cells, count;
  double shift[4][2], degrees[4]; /* shift: along the surface and out of it, in cells */
  double rebound, spread;         /* least rebound; bound of its spread, 0: none */
  const char *reason;             /* NULL, or why the least rebound is not met */
} hits;

static void keep(double *range, double value) {
  range[0] = fmin(range[0], value);
  range[1] = fmax(range[1], value);
}

static void impact(const hits *series, FILE *table) {
  double touch[2] = {HUGE_VAL, 0.0}, rebound[2] = {HUGE_VAL, 0.0}, force[2] = {HUGE_VAL, 0.0};
  double momentum = 0.0, energy = 0.0, least = 0.0, spin = 0.0;
  const int32_t count = verify_quick() ? 1 : series->count;
  for (int32_t k = 0; k < count; ++k) {
    const disc_hit a = {.against = series->against,
                        .cells = series->cells,
                        .rigid = series->against == ON_BODY,
                        .scheme = MPM_MUSL,
                        .transfer = MPM_FLIP,
                        .basis = MPM_BSPLINE2,
                        .shift = {series->shift[k][0], series->shift[k][1]},
                        .angle = (series->degrees[k] - 90.0) * PI / 180.0};
    const disc_outcome o = disc_collide(&a, NULL);
    fprintf(table, "%s,%d,%g,%g,%g,%.4f,%.4f,%.5f,%.4f,%.5f,%.5f,%.5f,%.2e,%.4f,%.3f,%.3f,%.1e\n",
            series->name, a.cells, a.shift[0], a.shift[1], series->degrees[k], o.touch, o.part, o.least,
            o.when, o.rebound, o.energy, o.energy_end, o.momentum, o.spin, o.force, o.steady, o.dissipation);
    if (!(series->degrees[k] > 0.0)) keep(touch, o.touch);
    keep(rebound, o.rebound);
    keep(force, o.steady);
    momentum = fmax(momentum, o.momentum);
    energy = fmax(energy, o.energy);
    least = fmin(least, o.dissipation);
    spin = fmax(spin, fabs(o.spin));
  }
  char name[80];
  snprintf(name, sizeof name, "%s, h = 1/%d", series->name, series->cells);
  verify_progress("%s", name);
  verify_gate_of(name, "momentum less impulse / that of the disc", momentum, 0.0, 1e-11, "conservation");
  verify_gate_of(name, "largest energy / first", energy, 0.0, 1.0005,
                 "contact takes energy and never gives any");
  verify_gate_of(name, "least dissipation of a step", least, -1e-12, 0.0, "contact takes energy");
  verify_gate_of(name, "first touch (1.586)", touch[0], 1.576, 1.596, disc_reference);
  verify_gate_of(name, "last touch (1.586)", touch[1], 1.576, 1.596, disc_reference);
  if (series->reason && !verify_quick()) {
    char what[120];
    snprintf(what, sizeof what, "%s: least rebound / speed (FEM 0.909)", name);
    verify_expected_failure(what, rebound[0], series->rebound, 0.919, disc_reference, series->reason);
  } else {
    verify_gate_of(name, "least rebound / speed (FEM 0.909)", rebound[0], series->rebound, 0.919,
                   disc_reference);
  }
  if (!(series->spread > 0.0) || verify_quick()) return;
  const char *source = "independence of the grid; set tolerance";
  verify_gate_of(name, "largest rebound / speed (FEM 0.909)", rebound[1], series->rebound, 0.919,
                 disc_reference);
  verify_gate_of(name, "spread of the rebound", rebound[1] - rebound[0], 0.0, series->spread, source);
  verify_gate_of(name, "largest over least peak force, means over 0.03", force[1] / force[0], 1.0, 1.04,
                 source);
  verify_gate_of(name, "largest spin, rad/s", spin, 0.0, 0.05, source);
}

/* ---- between two plates -------------------------------------------------------------------------------- */
static const double press = 0.02, moving = 4.0, stop = 8.0; /* way of the plate, its time, the end */

static double way_of_plate(double t) {
  const double s = fmin(t / moving, 1.0);
  return press * (s - sin(2.0 * PI * s) / (2.0 * PI));
}

static mpm_status move_plate(void *user, double t, double dt, double *velocity, double *angular_velocity) {
  (void)user, (void)angular_velocity;
  velocity[1] = -(way_of_plate(t + dt) - way_of_plate(t)) / dt;
  return MPM_OK;
}

/* Torque on the disc about the origin; that of the report is on the plate, about its centre. */
static double turning(const mpm_contact_info *info, const double *centre) {
  return centre[0] * info->force[1] - centre[1] * info->force[0] - info->torque[2];
}

static void plates(const char *name, int32_t kind, int32_t scheme, int32_t transfer, FILE *history) {
  const double h = 1.0 / 40.0, R = disc_radius, middle[2] = {0.5, R}, mass = 1000.0 * PI * R * R;
  verify_setup setup = verify_defaults(2, 40, h);
  if (kind == ON_PLANE) setup.grid.origin[1] = -0.3 - 0.37 * h;
  setup.stepper.scheme = scheme;
  setup.stepper.transfer = transfer;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *disc = verify_set(&w, verify_elastic(&w, "neo_hookean", 1000.0, 0.3, 1000.0));
  disc_fill(&w, disc, middle, R, (const double[]){0.0, 0.0}, 0.5 * h);
  support under = {.kind = kind};
  support_lay(&w, &under, 0.3, 0.0, (const double[]){0.5, 0.0});
  mpm_contact_desc contact;
  mpm_obstacle_desc desc =
      verify_obstacle_defaults(&contact, MPM_SHAPE_PLANE, MPM_MOTION_PRESCRIBED, 0.3, PI);
  desc.position[0] = 0.5, desc.position[1] = 2.0 * R;
  mpm_obstacle *plate = verify_obstacle(&w, &desc);
  verify_ok(&w, mpm_obstacle_set_motion(plate, move_plate, NULL));

  mpm_step_info now = verify_info(&w);
  mpm_contact_info over = {.struct_size = sizeof over}, below = over;
  double change = 0.0, turned = 0.0, astray = 0.0, given = 0.0, hold[2] = {0.0}, work = 0.0, energy = 0.0;
  double torque = 0.0, spun = 0.0, at[3], from[3], moved = 0.0;
  const double low[3] = {0.5, 0.0, 0.0};
  while (now.t < stop - 1e-12) {
    double dt;
    verify_ok(&w, mpm_obstacle_get_pose(plate, from, NULL, NULL, NULL));
    verify_ok(&w, mpm_stable_dt(w.stepper, &dt));
    now = verify_step(&w, fmin(0.4 * dt, stop - now.t));
    verify_ok(&w, mpm_obstacle_contact_info(plate, MPM_BODY_ANY, &over));
    below = support_info(&w, &under);
    verify_ok(&w, mpm_obstacle_get_pose(plate, at, NULL, NULL, NULL));
    given += now.dt * fabs(over.force[1]);
    for (int32_t c = 0; c < 2; ++c)
      change = fmax(change, fabs(now.momentum[c] - over.impulse[c] - below.impulse[c]));
    torque += now.dt * (turning(&over, from) + turning(&below, low));
    spun += now.dt * fabs(over.force[1]) * R;
    turned = fmax(turned, fabs(now.angular_momentum[2] - torque));
    moved = fmax(moved, fabs(at[1] - 2.0 * R + way_of_plate(now.t)));
    astray = fmax(astray, fabs(over.force[0]) + fabs(below.force[0]));
    work += over.force[1] * (at[1] - from[1]);
    energy = now.kinetic_energy + now.affine_kinetic_energy + now.strain_energy;
    if (now.t > moving) hold[0] += now.dt * over.force[1], hold[1] += now.dt * below.force[1];
    if (history)
      fprintf(history, "%.5f,%.6e,%.6e,%.6e,%.6e\n", now.t, at[1], over.force[1], below.force[1], energy);
  }
  verify_gate_of(name, "momentum less both impulses / impulse of the plate", change / given, 0.0, 1e-11,
                 "conservation");
  if (transfer == MPM_APIC && kind == ON_PLANE)
    verify_gate_of(name, "angular momentum less both torques / that of the plate's force", turned / spun, 0.0,
                   1e-11, "conservation");
  verify_gate_of(name, "lower over upper force while the plate stands - 1", fabs(hold[1] / hold[0] + 1.0),
                 0.0, 0.01, "equilibrium; what is left of the motion");
  verify_gate_of(name, "plate astray / way", moved / press, 0.0, 1e-12, "the velocity is that of the host");
  if (transfer == MPM_FLIP)
    verify_gate_of(name, "energy of the disc / work of the plate", energy / work, 0.9, 1.01,
                   "contact gives no energy; MUSL keeps it within 1 %");
  verify_progress("%s: force %.4f, sideways %.1e, speed left %.1e", name, -hold[0] / (stop - moving), astray,
                  fabs(now.momentum[1]) / mass);
  verify_close(&w);
}

int main(int argc, char **argv) {
  verify_begin("obstacle_impact", argc, argv);
  FILE *table = verify_csv("obstacle_impact"), *history = verify_csv("obstacle_impact_plates");
  fprintf(table,
          "case,cells,shift_x,shift_y,angle,touch,part,least,when,rebound,energy,energy_end,momentum,spin,"
          "force,steady,dissipation\n");
  fprintf(history, "t,plate,upper,lower,energy\n");
  const char *on_nodes =
      "the wall lies on a row of nodes, so that two rows are bound, on it and a cell above; with "
      "one alone blocks at rest creep";
  const hits series[8] = {
      {"plane",
       ON_PLANE,
       40,
       4,
       {{0.0, 0.3}, {0.0, 0.05}, {0.0, 0.55}, {0.0, 0.8}},
       {0.0},
       0.84,
       0.012,
       NULL},
      {"friction wall", ON_WALL, 40, 1, {{0.0}}, {0.0}, 0.84, 0.0, NULL},
      {"turned plane",
       ON_PLANE,
       40,
       4,
       {{0.0, 0.3}, {0.0, 0.3}, {0.0, 0.3}, {0.0, 0.3}},
       {0.0, 20.0, 33.0, 45.0},
       0.82,
       0.035,
       NULL},
      {"disc shifted along a friction wall",
       ON_WALL,
       40,
       3,
       {{0.0}, {0.3}, {0.75}},
       {0.0},
       0.84,
       0.012,
       on_nodes},
      {"plane", ON_PLANE, 80, 1, {{0.0, 0.3}}, {0.0}, 0.885, 0.0, NULL},
      {"friction wall", ON_WALL, 80, 1, {{0.0}}, {0.0}, 0.885, 0.0, NULL},
      {"rigid body",
       ON_BODY,
       40,
       4,
       {{0.0, 0.1}, {0.3, 0.3}, {0.37, 0.6}, {0.5, 0.9}},
       {0.0},
       0.84,
       0.03,
       "an independent implementation of the method has 0.851, 0.841, 0.852, 0.832 at the four places"},
      {"rigid body", ON_BODY, 80, 2, {{0.0, 0.1}, {0.3, 0.3}}, {0.0}, 0.885, 0.012, NULL}};
  for (int32_t k = 0; k < (verify_quick() ? 2 : 8); ++k) impact(&series[k], table);
  plates("driven and fixed plane", ON_PLANE, MPM_MUSL, MPM_FLIP, history);
  plates("driven and fixed plane, APIC", ON_PLANE, MPM_USL, MPM_APIC, NULL);
  plates("driven plane and wall", ON_WALL, MPM_MUSL, MPM_FLIP, NULL);
  plates("driven plane and wall, APIC", ON_WALL, MPM_USL, MPM_APIC, NULL);
  fclose(table);
  fclose(history);
  return verify_end();
}
