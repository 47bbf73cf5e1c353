/* Contact in implicit steps. A cylinder, radius 0.5, E = 1e5, nu = 0.3, is pressed between rigid planes by
 * quasi-static steps, and by explicit ones with damping: half of it, on a plane of symmetry, without
 * friction (Hertz, in plane strain). A block on a slope of 30 degrees comes to rest on it by quasi-static
 * steps, and is let go in dynamic ones. */
#include "discs.h"

static const double R = 0.5, E = 1e5, nu = 0.3;

/* ---- the cylinder -------------------------------------------------------------------------------------- */
typedef struct press {
  double force, width, /* force: of all of it; half the width, by the moment of forces, over Hertz */
      traction,        /* in the middle, of what planes give nodes, over Hertz */
      stress;          /* of particles below the middle, over Hertz */
  double off, equal;   /* half the width less that of Hertz, in cells; both planes' forces, relative */
} press;

/* The mean pressure in the second cell below the middle of the contact, over 1 / sqrt(1 + z^2 / a^2), which
 * is that of Hertz at its depth over the one in the middle: in the last cell nodes are held on both sides,
 * and nothing strains. */
static double stress_in_the_middle(const verify_world *w, double plane, double h, double a) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *stress = verify_get(w, w->set[0], "stress", 6), *x = verify_get(w, w->set[0], "position", 2);
  double sum = 0.0, count = 0.0;
  for (int64_t i = 0; i < n; ++i)
    if (x[i] < h && x[n + i] > plane + h && x[n + i] < plane + 2.0 * h) sum -= stress[n + i], count += 1.0;
  free(stress);
  free(x);
  return sum / count * hypot(1.0, 1.5 * h / a);
}

/* Nodes and what the lower plane gives them. */
typedef struct lower_nodes {
  mpm_view view[3];
  int64_t n;
  const double *x, *force, *area; /* x, force: [dim][n] */
} lower_nodes;

static lower_nodes map_nodes(const verify_world *w) {
  static const char *const field[3] = {"position", "contact_force", "contact_area"};
  lower_nodes nodes;
  for (int32_t i = 0; i < 3; ++i) {
    nodes.view[i] = (mpm_view){.struct_size = sizeof(mpm_view)};
    verify_ok(w, mpm_grid_map(w->stepper, 0, field[i], MPM_READ, &nodes.view[i]));
  }
  nodes.n = nodes.view[0].count;
  nodes.x = nodes.view[0].data, nodes.force = nodes.view[1].data, nodes.area = nodes.view[2].data;
  return nodes;
}

static void release_nodes(const verify_world *w, lower_nodes *nodes) {
  for (int32_t i = 0; i < 3; ++i) verify_ok(w, mpm_view_release(&nodes->view[i]));
}

/* Half the width that the pressure of Hertz has with the second moment of these forces: the mean of x^2 is a
 * quarter of its square. Ghosts count where their mirrors do. The area of nodes would go by
 * whole cells. */
static double width_by_moment(const verify_world *w) {
  lower_nodes at = map_nodes(w);
  double force = 0.0, moment = 0.0;
  for (int64_t i = 0; i < at.n; ++i) {
    const double f = at.force[at.n + i];
    if (at.x[at.n + i] > R || !(f > 0.0)) continue;
    force += f;
    moment += f * at.x[i] * at.x[i];
  }
  release_nodes(w, &at);
  return 2.0 * sqrt(moment / force);
}

/* The force on the nodes beside the middle of the lower contact over their area. Rows of nodes at two heights
 * share both, and not in the same way. */
static double traction_in_the_middle(const verify_world *w, double h) {
  lower_nodes at = map_nodes(w);
  double force = 0.0, area = 0.0;
  for (int64_t i = 0; i < at.n; ++i) {
    if (at.x[i] < 0.0 || at.x[i] > 1.5 * h || at.x[at.n + i] > R || !(at.force[at.n + i] > 0.0)) continue;
    force += at.force[at.n + i];
    area += at.area[i];
  }
  release_nodes(w, &at);
  return force / area;
}

typedef struct pressing {
  verify_world w;
  mpm_obstacle *anvil, *ram;
  double h, place; /* of the anvil */
} pressing;

static press look(pressing *on, const char *name, double deep, FILE *table) {
  const double h = on->h, stiffness = E / (1.0 - nu * nu);
  mpm_contact_info info[2] = {{.struct_size = sizeof *info}, {.struct_size = sizeof *info}};
  verify_ok(&on->w, mpm_obstacle_contact_info(on->anvil, MPM_BODY_ANY, &info[0]));
  verify_ok(&on->w, mpm_obstacle_contact_info(on->ram, MPM_BODY_ANY, &info[1]));
  const double force = 2.0 * info[0].normal_force, half = sqrt(4.0 * force * R / (PI * stiffness));
  const double pressure = sqrt(force * stiffness / (PI * R));
  const double width = width_by_moment(&on->w);
  const press out = {.force = force,
                     .width = width / half,
                     .off = (width - half) / h,
                     .traction = traction_in_the_middle(&on->w, h) / pressure,
                     .stress = stress_in_the_middle(&on->w, on->place, h, half) / pressure,
                     .equal = fabs(info[1].normal_force / info[0].normal_force - 1.0)};
  fprintf(table, "%s,%.0f,%.5f,%.5f,%.5f,%.5f,%.5f,%.2e\n", name, R / h, deep / R, half / h, out.width,
          out.traction, out.stress, out.equal);
  return out;
}

/* Deep: by how much each plane comes nearer in a second. */
static void open_press(pressing *on, int32_t cells, int32_t scheme, double deep) {
  const double h = on->h = R / cells, by[2] = {0.0, on->place = 0.3 * R / cells};
  const double centre[2] = {0.0, R + by[1]}, rest[2] = {0.0, 0.0};
  verify_setup setup = verify_defaults(2, cells + 4, h);
  setup.grid.cells[1] = 2 * cells + 8;
  setup.grid.origin[1] = -4.0 * h;
  setup.stepper.scheme = scheme;
  setup.stepper.quasi_static = scheme == MPM_NEWMARK;
  verify_open(&on->w, &setup);
  mpm_particles *body = verify_set(&on->w, verify_elastic(&on->w, "neo_hookean", E, nu, 1000.0));
  disc_fill_shells(&on->w, body, centre, R, rest, 1, 0.5 * h);
  verify_ok(&on->w, mpm_stepper_set_wall(on->w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  mpm_contact_desc rule;
  mpm_obstacle_desc plane = verify_obstacle_defaults(&rule, MPM_SHAPE_PLANE, MPM_MOTION_PRESCRIBED, 0.0, 0.0);
  plane.position[1] = by[1];
  on->anvil = verify_obstacle(&on->w, &plane);
  plane.position[1] = by[1] + 2.0 * R;
  plane.inside = 1;
  plane.velocity[1] = -2.0 * deep;
  on->ram = verify_obstacle(&on->w, &plane);
}

static const double deepest = 0.03;

static press press_cylinder(int32_t cells, FILE *table) {
  enum { STEPS = 10 };
  const double deep = deepest * R / STEPS;
  pressing on;
  press out = {.force = 0.0};
  double iterations = 0.0;
  open_press(&on, cells, MPM_NEWMARK, deep);
  for (int32_t i = 0; i < STEPS; ++i) {
    iterations += (double)verify_step(&on.w, 1.0).newton_iterations / STEPS;
    out = look(&on, "cylinder", deep * (i + 1), table);
  }
  verify_progress("cylinder, R = %d h: %.1f iterations per step", (int)cells, iterations);
  verify_close(&on.w);
  return out;
}

/* In as long as sound takes to go through it forty times, and at rest for half as long; of the velocities a
 * hundredth goes in every step. */
static press press_damped(int32_t cells, FILE *table) {
  const double duration = 80.0 * R / sqrt(1.35 * E / 1000.0);
  pressing on;
  open_press(&on, cells, MPM_USL, deepest * R / duration);
  const int64_t n = mpm_particles_count(on.w.set[0]);
  double t = 0.0, dt;
  for (int32_t stops = 0; t < 1.5 * duration; t += dt) {
    verify_ok(&on.w, mpm_stable_dt(on.w.stepper, &dt));
    dt = fmin(0.4 * dt, (stops ? 1.5 * duration : duration) - t);
    verify_step(&on.w, dt);
    double *v = verify_get(&on.w, on.w.set[0], "velocity", 2);
    for (int64_t i = 0; i < 2 * n; ++i) v[i] *= 0.99;
    verify_put(&on.w, on.w.set[0], "velocity", 2, v);
    free(v);
    if (stops || t + dt < duration) continue;
    stops = 1;
    double place[3], turn[4], moves[3], spin[3];
    verify_ok(&on.w, mpm_obstacle_get_pose(on.ram, place, turn, moves, spin));
    moves[1] = 0.0;
    verify_ok(&on.w, mpm_obstacle_set_pose(on.ram, place, turn, moves, spin));
  }
  const press out = look(&on, "cylinder explicit", deepest * R, table);
  verify_progress("cylinder by explicit steps, R = %d h", (int)cells);
  verify_close(&on.w);
  return out;
}

/* ---- the block ----------------------------------------------------------------------------------------- */
typedef struct slide {
  const char *name;
  int32_t support;
  double friction, cfl;
} slide;

static double mean_way(const verify_world *w, double from) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *x = verify_get(w, w->set[0], "position", 2), sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += x[i] / (double)n;
  free(x);
  return sum - from;
}

typedef struct slide_end {
  double way, exact, energy, dissipation, iterations;
} slide_end;

/* It settles by three steps with friction that holds it; then gravity pulls it down the slope for 0.5 s. */
static slide_end slide_block(const slide *a) {
  const double h = 0.05, angle = PI / 6.0, g = 10.0, lift = a->support == ON_WALL ? 0.0 : 0.37 * h;
  verify_setup setup = verify_defaults(2, 1, h);
  setup.grid.cells[0] = 44;
  setup.grid.cells[1] = 24;
  setup.grid.origin[0] = -0.4;
  setup.grid.origin[1] = a->support == ON_WALL ? 0.0 : -0.4;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.gravity[0] = g * sin(angle);
  setup.stepper.gravity[1] = -g * cos(angle);
  setup.stepper.quasi_static = 1;
  verify_world w;
  verify_open(&w, &setup);
  const double zero[2] = {0.0, 0.0}, top[2] = {0.8, 0.4}, by[2] = {0.0, lift};
  mpm_particles *block = verify_set(&w, verify_elastic(&w, "neo_hookean", 1e6, 0.3, 1000.0));
  verify_fill_box(&w, block, zero, top, 2);
  verify_place(&w, block, 0.0, by);
  if (a->support == ON_BODY) {
    const uint8_t all[2] = {1, 1};
    const double low[2] = {-0.3, -0.2}, high[2] = {1.7, 0.0};
    mpm_particles *ground = verify_set(&w, w.material[0]);
    verify_fill_box(&w, ground, low, high, 2);
    verify_place(&w, ground, 0.0, by);
    verify_ok(&w, mpm_particles_set_all(ground, "prescribed", MPM_U8, 2, all));
    verify_ok(&w, mpm_stepper_set_body(w.stepper, ground, 1));
  }
  support on = {.kind = a->support};
  const double dt = a->cfl * h / sqrt(1e6 * 1.346 / 1000.0);
  support_lay(&w, &on, 10.0, 0.0, by);
  for (int32_t i = 0; i < 3; ++i) verify_step(&w, dt);
  support_lay(&w, &on, a->friction, 0.0, by);
  setup.stepper.quasi_static = 0;
  verify_ok(&w, mpm_stepper_configure(w.stepper, &setup.stepper));
  verify_ok(&w, mpm_particles_set_all(block, "velocity", MPM_F64, 2, zero));
  verify_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 0));
  const double start = mean_way(&w, 0.0);
  mpm_step_info now = verify_info(&w);
  const double first = now.strain_energy;
  slide_end out = {.energy = -HUGE_VAL};
  int32_t steps = 0;
  while (now.t < 0.5) {
    now = verify_step(&w, dt);
    out.iterations += now.newton_iterations;
    ++steps;
    const double total = now.kinetic_energy + now.strain_energy;
    out.energy = fmax(out.energy, (total - first - now.external_work_total) / fmax(total, first));
    out.dissipation = fmin(out.dissipation, now.contact_dissipation / fmax(total, first));
  }
  out.iterations /= steps;
  out.way = mean_way(&w, start);
  out.exact = 0.5 * g * fmax(0.0, sin(angle) - a->friction * cos(angle)) * now.t * now.t;
  verify_progress("%s, friction %g, CFL %g: %.1f iterations per step", a->name, a->friction, a->cfl,
                  out.iterations);
  verify_close(&w);
  return out;
}

static void slope_gates(FILE *table) {
  static const char *const name[3] = {"on a body", "on a plane", "on a wall"};
  const char *coulomb = "Coulomb's law; set tolerance";
  for (int32_t kind = ON_BODY; kind <= ON_WALL; ++kind)
    for (int32_t k = 0; k < (verify_quick() ? 1 : 4); ++k) {
      const slide a = {name[kind], kind, k % 2 ? 0.7 : 0.3, k < 2 ? 4.0 : 1.0};
      const slide_end o = slide_block(&a);
      char what[96];
      fprintf(table, "%s,%g,%g,%.6f,%.6f,%.3e,%.2f\n", a.name, a.friction, a.cfl, o.way, o.exact, o.energy,
              o.iterations);
      snprintf(what, sizeof what, "%s, CFL %g, friction %g", a.name, a.cfl, a.friction);
      if (k % 2)
        verify_gate_of(what, "creep in 0.5 s, m", fabs(o.way), 0.0, kind == ON_BODY ? 1e-3 : 2.5e-3, coulomb);
      else
        verify_gate_of(what, "way / exact", o.way / o.exact, kind == ON_BODY ? 0.98 : 0.985,
                       kind == ON_BODY ? 1.02 : 1.015, coulomb);
      verify_gate_of(what, "least dissipation of a step / energy", o.dissipation, -1e-12, 0.0,
                     "contact takes energy and never gives any");
    }
}

int main(int argc, char **argv) {
  verify_begin("contact_implicit", argc, argv);
  FILE *table = verify_csv("contact_implicit"), *slopes = verify_csv("contact_implicit_slope");
  fprintf(table, "case,cells,depth,half_width,width,traction,stress,balance\n");
  fprintf(slopes, "support,friction,cfl,way,exact,energy,iterations\n");
  const char *hertz = "Hertz, plane strain; set tolerance";
  const int32_t cells = verify_quick() ? 20 : 40;
  for (int32_t damped = 0; damped < 2; ++damped) {
    const char *name = damped ? "cylinder by explicit steps" : "cylinder";
    const press o = damped ? press_damped(cells, table) : press_cylinder(cells, table);
    char what[3][100];
    snprintf(what[0], sizeof *what, "%s: half the width, by the moment of forces, less that of Hertz, cells",
             name);
    snprintf(what[1], sizeof *what, "%s: stress in the second cell below the middle / Hertz", name);
    snprintf(what[2], sizeof *what, "%s: pressure in the middle / Hertz", name);
    if (!verify_quick()) {
      verify_gate(what[0], o.off, -0.5, 0.5, hertz);
      verify_gate(what[2], o.traction, 0.92, 1.08, hertz);
      verify_expected_failure(
          what[1], o.stress, 0.92, 1.08, hertz,
          "nodes on both sides of the plane are held, and the cells next to it strain unevenly");
    }
    verify_gate_of(name, "forces of both planes, relative difference", o.equal, 0.0, damped ? 1e-3 : 1e-6,
                   "equilibrium");
  }
  slope_gates(slopes);
  fclose(table);
  fclose(slopes);
  return verify_end();
}
