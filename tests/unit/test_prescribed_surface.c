/* Surfaces that prescribe how the material moves: what nodes and bodies do, and what it costs. */
#include "prescribed_surfaces.h"
#include "tables.h"

/* ---- what all methods keep ----------------------------------------------------------------------------- */
/* The impulse of the surface is the momentum that the block gains, beside that of gravity, and its work is
 * the impulse times the velocity where that is the same everywhere. */
START_TEST(impulse_is_momentum) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t normal_only = 0; normal_only < 2; ++normal_only) {
      if (dim == 1 && how->remedy) continue;
      world w;
      world_desc desc = world_with(how, dim, CELLS, spacing);
      desc.stepper.gravity[0] = 3.0;
      open_block_with(&w, &desc);
      mpm_surface_desc d = prescribing(normal_only);
      d.velocity[0] = 0.5, d.velocity[1] = -0.25, d.velocity[2] = 0.125;
      mpm_surface *s = put_surface(&w, &d);
      add_closed(&w, s, 0.62);
      const double dt = 2e-4, mass = mass_of(&w, w.set[0]);
      double sum[3] = {0.0, 0.0, 0.0}, time = 0.0;
      for (int32_t step = 0; step < 4; ++step) {
        const mpm_step_info before = world_info(&w), after = world_step(&w, dt);
        /* staggered velocities change over the mean of two steps, which here is dt all the same */
        const double *r = reaction_of(&w, s), scale = mass * 3.0 + fabs(r[0]) + fabs(r[1]) + fabs(r[2]);
        for (int32_t k = 0; k < dim; ++k) {
          const double gained = after.momentum[k] - before.momentum[k] - (k ? 0.0 : dt * mass * 3.0);
          ck_within(how->name, gained, dt * r[k], 1e-11 * dt * scale);
          sum[k] += dt * r[k];
        }
        time += dt;
        double *of_markers = markers(s, "reaction", dim);
        for (int32_t k = 0; k < dim; ++k)
          ck_within(how->name, sum_of(mpm_surface_count(s), of_markers + k * mpm_surface_count(s)), r[k],
                    1e-12 * scale);
        free(of_markers);
      }
      double impulse[3];
      ck_ok(&w, mpm_stepper_surface_impulse(w.stepper, s, impulse));
      for (int32_t k = 0; k < dim; ++k) ck_within(how->name, impulse[k], sum[k], 1e-12 * mass * time);
      ck_assert(fabs(impulse[0]) > 1e-3 * mass * time);
      drop_surface(&w, s);
      world_close(&w);
    }
}
END_TEST

/* So it is on grids of every kind: rings along their axis, sheets, total Lagrangian ones; in steps with
 * friction walls and with several bodies, too. */
enum { RING, SHEET, TOTAL_LAGRANGIAN, FRICTION_WALLS, BODIES, KINDS };
START_TEST(impulse_on_every_grid) {
  const int32_t kind = _i % KINDS, implicit = _i / KINDS % 2, normal_only = _i / KINDS / 2;
  method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  if (!implicit) how.scheme = MPM_USL;
  world w;
  world_desc desc = world_with(&how, 2, CELLS, spacing);
  if (kind == RING) desc.grid.geometry = MPM_AXISYMMETRIC;
  if (kind == SHEET) desc.grid.geometry = MPM_PLANE_STRESS;
  desc.grid.total_lagrangian = kind == TOTAL_LAGRANGIAN;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.9, kind == FRICTION_WALLS ? 0.0 : 0.9}, high[] = {2.1, 2.1};
  world_fill(&w, set, low, high, 2);
  if (kind == FRICTION_WALLS) world_walls(&w, MPM_WALL_FRICTION, 0.3);
  if (kind == BODIES) {
    mpm_particles *other = world_add_set(&w, NULL);
    const double from[] = {0.9, 2.1}, to[] = {2.1, 2.6}, down[] = {0.0, -2.0};
    world_fill(&w, other, from, to, 2);
    ck_ok(&w, mpm_particles_set_all(other, "velocity", MPM_F64, 2, down));
    ck_ok(&w, mpm_stepper_set_body(w.stepper, other, 1));
  }
  mpm_surface_desc d = prescribing(normal_only);
  d.velocity[0] = 0.2, d.velocity[1] = -0.4;
  mpm_surface *s = put_surface(&w, &d);
  for (int32_t k = 0; k < 10; ++k) { /* a line across the block */
    const double x[2] = {0.96 + 0.12 * k, 1.3 + 0.03 * k}, a[2] = {0.03, -0.12};
    ck_ok(&w, mpm_surface_add(s, 1, x, a, NULL));
  }
  const double dt = 2e-4;
  for (int32_t step = 0; step < 5; ++step) {
    const mpm_step_info before = world_info(&w), after = world_step(&w, dt);
    const double *r = reaction_of(&w, s);
    double walls[2] = {0.0, 0.0};
    for (int32_t face = 0; face < 4 && kind == FRICTION_WALLS; ++face) {
      double force[2];
      ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, face, force));
      for (int32_t k = 0; k < 2; ++k) walls[k] += force[k];
    }
    for (int32_t k = kind == RING; k < 2; ++k)
      ck_within("momentum", after.momentum[k] - before.momentum[k], dt * (r[k] + walls[k]),
                1e-9 * dt * (fabs(r[0]) + fabs(r[1]) + fabs(walls[1])));
    ck_holds(fabs(r[1]) > 1.0);
    ck_holds(isfinite(after.external_work));
  }
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* A block that moves as a closed surface around it says feels nothing and stays rigid; markers move as they
 * prescribe. */
START_TEST(rigid_motion) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t normal_only = 0; normal_only < 2; ++normal_only) {
      if (dim == 1 && how->remedy) continue;
      world w;
      mpm_particles *set = open_block(&w, how, dim);
      const double v[3] = {2.0, -1.0, 0.5}, dt = 1e-3;
      ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
      mpm_surface_desc d = prescribing(normal_only);
      memcpy(d.velocity, v, sizeof v);
      mpm_surface *s = put_surface(&w, &d);
      add_closed(&w, s, 0.62);
      const int64_t n = mpm_surface_count(s), count = mpm_particles_count(set);
      double *x = fetch(&w, set, "position", dim);
      for (int32_t step = 0; step < 10; ++step) world_step(&w, dt);
      double *y = fetch(&w, set, "position", dim), *u = markers(s, "displacement", dim),
             *g = markers(s, "gap", dim);
      for (int32_t k = 0; k < dim; ++k) {
        for (int64_t i = 0; i < count; ++i)
          ck_within(how->name, y[k * count + i] - x[k * count + i], 10.0 * dt * v[k], 1e-11);
        for (int64_t i = 0; i < n; ++i) ck_within(how->name, u[k * n + i], 10.0 * dt * v[k], 1e-14);
        for (int64_t i = 0; i < n; ++i) ck_within(how->name, g[k * n + i], 0.0, 1e-12);
      }
      free(x), free(y), free(u), free(g);
      drop_surface(&w, s);
      world_close(&w);
    }
}
END_TEST

/* Work is the impulse times the velocity where it is the same everywhere, and none where the surface rests.
 * */
START_TEST(work_of_a_surface) {
  const method *how = broad_methods[_i];
  for (int32_t moves = 0; moves < 2; ++moves)
    for (int32_t normal_only = 0; normal_only < 2; ++normal_only) {
      world w;
      mpm_particles *set = open_block(&w, how, 2);
      const double v[2] = {1.0, 0.5}, dt = 2e-4;
      ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
      mpm_surface_desc d = prescribing(normal_only);
      d.velocity[0] = moves ? 3.0 : 0.0;
      d.velocity[1] = moves ? -1.0 : 0.0;
      mpm_surface *s = put_surface(&w, &d);
      add_circle(&w, s, 0.4, 0.1);
      const mpm_step_info info = world_step(&w, dt);
      if (is_explicit(how)) {
        const double *r = reaction_of(&w, s), power = r[0] * d.velocity[0] + r[1] * d.velocity[1];
        if (!normal_only || !moves) ck_within(how->name, info.external_work, dt * power, 1e-9);
        if (!moves) ck_holds(fabs(r[0]) > 1.0);
      } else { /* springs give way: the work is that on the material at the markers */
        double *r = markers(s, "reaction", 2), *u = markers(s, "velocity", 2), power = 0.0;
        for (int64_t i = 0; i < 2 * mpm_surface_count(s); ++i) power += r[i] * u[i];
        ck_within(how->name, info.external_work, dt * power, 1e-9 + 1e-9 * fabs(dt * power));
        free(r), free(u);
      }
      drop_surface(&w, s);
      world_close(&w);
    }
}
END_TEST

/* ---- nodes of explicit steps --------------------------------------------------------------------------- */
/* Nodes around a flat surface that rests keep their velocity along it and lose that across. */
START_TEST(slides_along) {
  const method *how = broad_methods[_i];
  if (!is_explicit(how) || how->scheme == MPM_USF) return; /* USF has a stress by then */
  world w;
  mpm_particles *set = open_block(&w, how, 2);
  const double v[2] = {1.0, 2.0}, angle = 0.5236, n[2] = {-sin(angle), cos(angle)};
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  const mpm_surface_desc d = prescribing(1);
  mpm_surface *s = put_surface(&w, &d);
  for (int32_t k = 0; k < 5; ++k) {
    const double x[2] = {1.5 + 0.1 * (k - 2) * n[1], 1.5 - 0.1 * (k - 2) * n[0]},
                 a[2] = {0.1 * n[0], 0.1 * n[1]};
    ck_ok(&w, mpm_surface_add(s, 1, x, a, NULL));
  }
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
  ck_ok(&w, mpm_step_grid(w.stepper));
  int64_t count, held = 0;
  double *u = fetch_nodes(&w, "velocity", &count);
  for (int64_t i = 0; i < count; ++i) {
    const double across = u[i] * n[0] + u[count + i] * n[1], along = u[i] * n[1] - u[count + i] * n[0];
    ck_within(how->name, along, v[0] * n[1] - v[1] * n[0], 1e-12);
    if (fabs(across) > 1e-12) ck_within(how->name, across, v[0] * n[0] + v[1] * n[1], 1e-12);
    held += fabs(across) <= 1e-12;
  }
  ck_assert(held >= 4 && held < count);
  free(u);
  ck_ok(&w, mpm_step_abort(w.stepper));
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* A body that turns in a round surface is not stopped: the normals of nodes point to the middle, wherever
 * they lie beside the surface. */
START_TEST(slides_round) {
  const int32_t dim = 2 + _i;
  world w;
  world_desc desc = world_default(dim, 24, 0.125);
  desc.stepper.transfer = MPM_APIC;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.75, 0.75, 0.75}, high[] = {2.25, 2.25, 2.25}, radius = 0.6;
  const int64_t n = world_fill(&w, set, low, high, 2);
  double *x = fetch(&w, set, "position", dim), *v = calloc((size_t)(dim * n), sizeof *v);
  for (int64_t i = 0; i < n; ++i) v[i] = 1.5 - x[n + i], v[n + i] = x[i] - 1.5;
  put(&w, set, "velocity", dim, v);
  const double L[9] = {0.0, -1.0, 0.0, 1.0};
  ck_ok(&w, mpm_particles_set_all(set, "velocity_gradient", MPM_F64, 9, L));
  const mpm_surface_desc d = prescribing(1);
  mpm_surface *s = put_surface(&w, &d);
  enum { AROUND = 64, UP = 32 };
  for (int32_t i = 0; i < AROUND; ++i)
    for (int32_t k = 0; k < (dim == 2 ? 1 : UP); ++k) {
      const double a = 2.0 * PI * (i + 0.5) / AROUND, b = dim == 2 ? 0.0 : PI * ((k + 0.5) / UP - 0.5);
      const double r[3] = {cos(a) * cos(b), sin(a) * cos(b), sin(b)};
      const double size = 0.06 * (dim == 2 ? 1.0 : 0.1 * cos(b));
      double at[3], area[3];
      for (int32_t c = 0; c < 3; ++c) at[c] = 1.5 + radius * r[c], area[c] = size * r[c];
      ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
    }
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
  ck_ok(&w, mpm_step_grid(w.stepper));
  int64_t count;
  double *u = fetch_nodes(&w, "velocity", &count), *at = fetch_nodes(&w, "position", &count), most = 0.0,
         *pull = fetch_nodes(&w, "reaction", &count);
  int64_t held = 0;
  for (int64_t i = 0; i < count; ++i) {
    const double arm[2] = {at[i] - 1.5, at[count + i] - 1.5}, r = sqrt(arm[0] * arm[0] + arm[1] * arm[1]);
    const double off = r > 0.0 ? (u[i] * arm[0] + u[count + i] * arm[1]) / r : 0.0;
    held += pull[i] != 0.0 || pull[count + i] != 0.0;
    if (pull[i] != 0.0 || pull[count + i] != 0.0) most = fmax(most, fabs(off) / radius);
  }
  show("%d-D: %lld nodes slide, off by %g of the speed\n", (int)dim, (long long)held, most);
  ck_assert(held > 60);
  ck_between("off the circle", most, 0.0, 4e-3);
  free(x), free(v), free(u), free(at), free(pull);
  ck_ok(&w, mpm_step_abort(w.stepper));
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* Two faces that meet hold a node whole, each by what is left of its normal; beside them a wall and the host
 * come first. */
START_TEST(faces_that_meet) {
  world w;
  mpm_particles *set = open_block(&w, &methods[0], 2);
  const double v[2] = {1.0, 2.0};
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_surface_desc d = prescribing(1);
  mpm_surface *s[2];
  for (int32_t k = 0; k < 2; ++k) {
    const double x[2] = {1.5, 1.5}, a[2] = {k ? 0.06 : 0.1, k ? 0.08 : 0.0};
    d.velocity[0] = k ? 1.0 : 0.5, d.velocity[1] = k ? -2.0 : 7.0;
    s[k] = put_surface(&w, &d);
    ck_ok(&w, mpm_surface_add(s[k], 1, x, a, NULL));
  }
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
  ck_ok(&w, mpm_step_grid(w.stepper));
  int64_t count, held = 0;
  double *u = fetch_nodes(&w, "velocity", &count), *x = fetch_nodes(&w, "position", &count);
  for (int64_t i = 0; i < count; ++i) {
    if (fabs(u[i] - 0.5) > 1e-12) continue;
    ++held; /* u . (1, 0) = .5, u . (.6, .8) = .6 - 1.6 */
    ck_within("the other normal", 0.6 * u[i] + 0.8 * u[count + i], -1.0, 1e-12);
  }
  ck_assert(held > 0 && held < count);
  free(u), free(x);
  ck_ok(&w, mpm_step_abort(w.stepper));
  /* together their impulses are the momentum */
  const mpm_step_info before = world_info(&w), after = world_step(&w, 1e-4);
  double sum[2] = {0.0, 0.0};
  for (int32_t k = 0; k < 2; ++k) {
    const double *r = reaction_of(&w, s[k]);
    for (int32_t c = 0; c < 2; ++c) sum[c] += 1e-4 * r[c];
  }
  for (int32_t c = 0; c < 2; ++c)
    ck_within("momentum", after.momentum[c] - before.momentum[c], sum[c], 1e-12 * mass_of(&w, set));
  for (int32_t k = 0; k < 2; ++k) drop_surface(&w, s[k]);
  world_close(&w);
}
END_TEST

/* What the host holds it keeps, and prescribed particles keep what they hold; the whole momentum is still
 * told. */
static mpm_status hold_x(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) prescribed[i] = 1, velocity[i] = 4.0;
  return MPM_OK;
}

START_TEST(others_come_first) {
  for (int32_t normal_only = 0; normal_only < 2; ++normal_only) {
    world w;
    mpm_particles *set = open_block(&w, &methods[0], 2);
    const double v[2] = {1.0, 2.0};
    ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
    mpm_surface_desc d = prescribing(normal_only);
    d.velocity[1] = -3.0;
    mpm_surface *s = put_surface(&w, &d);
    const double x[2] = {1.5, 1.5}, a[2] = {0.06, 0.08};
    ck_ok(&w, mpm_surface_add(s, 1, x, a, NULL));
    ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, hold_x, NULL));
    ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
    ck_ok(&w, mpm_step_grid(w.stepper));
    int64_t count, held = 0;
    double *u = fetch_nodes(&w, "velocity", &count);
    /* along (.6, .8) the surface wants -2.4: with the host's 4 that is .6 * 4 + .8 * -6 */
    for (int64_t i = 0; i < count; ++i) {
      ck_within("the host's", u[i], 4.0, 1e-13);
      held += fabs(u[count + i] - (normal_only ? -6.0 : -3.0)) < 1e-12;
    }
    ck_assert(held > 0 && held < count);
    free(u);
    ck_ok(&w, mpm_step_abort(w.stepper));
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* Half a block on a slip wall under a surface is half of the whole one, and so are impulses. */
START_TEST(half_on_a_wall) {
  const method *how = broad_methods[_i];
  if (how->boundary == MPM_BOUNDARY_OPEN_KNOT) return;
  /* rows at the rim go with rows inside, which are not the same ones beside a wall */
  if (!is_explicit(how) && how->basis == MPM_BSPLINE2) return;
  double force[2][2], *x[2];
  for (int32_t half = 0; half < 2; ++half) {
    world w;
    world_desc desc = world_with(how, 2, CELLS, spacing);
    desc.grid.origin[0] = half ? 0.0 : -1.5;
    desc.stepper.gravity[1] = -9.81;
    desc.stepper.newton_tolerance_residual = 1e-11;
    desc.stepper.quasi_static = !is_explicit(how);
    mpm_particles *set = world_open(&w, &desc);
    if (half) ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
    const double low[] = {half ? 0.0 : -0.75, 1.0}, high[] = {0.75, 2.0};
    world_fill(&w, set, low, high, 2);
    mpm_surface_desc d = prescribing(0);
    d.velocity[1] = -1.0;
    mpm_surface *s = put_surface(&w, &d);
    for (int32_t k = 0; k < (half ? 6 : 12); ++k) {
      const int32_t at = k / 2;
      const double p[2] = {(k % 2 && !half ? -1.0 : 1.0) * (half ? 0.0625 + 0.125 * k : 0.0625 + 0.125 * at),
                           2.0};
      const double area[2] = {0.0, 0.125};
      ck_ok(&w, mpm_surface_add(s, 1, p, area, NULL));
    }
    for (int32_t i = 0; i < 10; ++i) world_step(&w, 5e-4);
    memcpy(force[half], reaction_of(&w, s), sizeof force[half]);
    x[half] = markers(s, "velocity", 2);
    drop_surface(&w, s);
    world_close(&w);
  }
  ck_within(how->name, 2.0 * force[1][1], force[0][1], 1e-7 * fabs(force[0][1]));
  ck_within(how->name, force[0][0], 0.0, 1e-7 * fabs(force[0][1]));
  for (int32_t i = 0; i < 6; ++i) /* those on the right of the whole have even numbers */
    ck_within(how->name, x[1][6 + i], x[0][12 + 2 * i], 1e-8);
  free(x[0]), free(x[1]);
}
END_TEST

/* ---- callbacks and failures ---------------------------------------------------------------------------- */
typedef struct spin {
  int32_t answer;
  double rate, t, dt;
} spin;

static mpm_status turn(void *user, const mpm_marker_batch *b, double *add) {
  spin *of = user;
  of->t = b->t, of->dt = b->dt;
  for (int64_t i = 0; i < b->n; ++i) {
    add[i] -= of->rate * (b->position[b->ld + i] - 1.5);
    add[b->ld + i] += of->rate * (b->position[i] - 1.5);
  }
  return of->answer;
}

/* A ring of markers turns the block inside of it: velocities of surface, marker and callback add up. */
START_TEST(velocities_add_up) {
  for (int32_t implicit = 0; implicit < 2; ++implicit) {
    const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
    world w;
    open_block(&w, implicit ? &how : &methods[0], 2);
    mpm_surface_desc d = prescribing(0);
    d.velocity[0] = 1.0;
    mpm_surface *s = put_surface(&w, &d);
    add_circle(&w, s, 0.5, 0.1);
    const int64_t n = mpm_surface_count(s);
    spin of = {0, 2.0, -1.0, 0.0};
    double *own = calloc((size_t)(2 * n), sizeof *own), *x = markers(s, "position", 2);
    own[n] = 0.5; /* of marker 0 along y */
    ck_ok(&w, mpm_surface_set(s, "prescribed_velocity", MPM_F64, 2, n, NULL, own));
    ck_ok(&w, mpm_surface_set_velocity(s, turn, &of));
    world_step(&w, 1e-3);
    ck_holds(of.t == 0.0 && of.dt == 1e-3);
    double *u = markers(s, "displacement", 2);
    for (int64_t i = 0; i < n; ++i) {
      ck_within("along x", u[i], 1e-3 * (1.0 - 2.0 * (x[n + i] - 1.5)), 1e-15);
      ck_within("along y", u[n + i], 1e-3 * ((i ? 0.0 : 0.5) + 2.0 * (x[i] - 1.5)), 1e-15);
    }
    free(own), free(x), free(u);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

START_TEST(failures_leave_no_trace) {
  for (int32_t implicit = 0; implicit < 2; ++implicit) {
    const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
    world w;
    open_block(&w, implicit ? &how : &methods[0], 2);
    mpm_surface_desc d = prescribing(0);
    d.velocity[0] = 0.1;
    mpm_surface *s = put_surface(&w, &d);
    add_circle(&w, s, 0.62, 0.1);
    world_step(&w, 1e-3);
    double *was = markers(s, "position", 2), force[3], impulse[3], now[3];
    const int64_t n = mpm_surface_count(s);
    memcpy(force, reaction_of(&w, s), sizeof force);
    ck_ok(&w, mpm_stepper_surface_impulse(w.stepper, s, impulse));
    world_bits bits = world_take(&w);
    spin of = {-3, 1.0, 0.0, 0.0};
    ck_ok(&w, mpm_surface_set_velocity(s, turn, &of));
    mpm_step_info info = {.struct_size = sizeof info};
    ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_E_CALLBACK,
               "the velocity callback of surface 0 returned -3");
    ck_assert_int_eq(info.callback_status, -3);
    of.answer = 4;
    ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_CUT_DT, "returned 4");
    of.answer = 0, of.rate = NOT_A_NUMBER;
    ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_NONFINITE,
               "marker 0 of surface 0 prescribes a velocity that is not finite");
    of.rate = 1e7;
    ck_assert(mpm_step(w.stepper, 1e-3, &info) != MPM_OK);
    double *is = markers(s, "position", 2);
    ck_holds(memcmp(was, is, (size_t)(2 * n) * sizeof *was) == 0);
    ck_holds(memcmp(force, reaction_of(&w, s), 2 * sizeof *force) == 0);
    ck_ok(&w, mpm_stepper_surface_impulse(w.stepper, s, now));
    ck_holds(memcmp(impulse, now, 2 * sizeof *now) == 0);
    world_same(&w, &bits, "particles");
    ck_ok(&w, mpm_surface_set_velocity(s, NULL, NULL));
    ck_ok(&w, mpm_step(w.stepper, 1e-3, &info));
    ck_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 0));
    ck_ok(&w, mpm_stepper_surface_impulse(w.stepper, s, now));
    ck_holds(now[0] == 0.0 && now[1] == 0.0);
    free(was), free(is);
    bits_drop(&bits);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

START_TEST(refusals) {
  world w, other;
  open_block(&w, &methods[0], 2);
  open_block(&other, &methods[0], 2);
  mpm_surface *s = NULL;
  mpm_surface_desc d = load_desc();
  ck_holds(d.penalty == 100.0 && d.modulus == 0.0 && d.prescribes == MPM_PRESCRIBES_NOTHING);
  d.prescribes = 3;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG,
             "prescribes is 3, must be 0 ... 2");
  d = prescribing(0);
  d.penalty = 0.0;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "penalty is 0");
  d = prescribing(0);
  d.modulus = NOT_A_NUMBER;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "modulus is");
  d = prescribing(0);
  d.velocity[1] = INFINITE;
  ck_refused(&w, mpm_surface_create(w.context, w.grid, &d, &s), MPM_E_ARG, "velocity[1] is inf");
  d = prescribing(0);
  s = put_surface(&w, &d);
  add_circle(&w, s, 0.5, 0.1);
  double out[3];
  ck_refused(&w, mpm_stepper_surface_reaction(w.stepper, s, out), MPM_E_STATE, "no step has been made yet");
  ck_refused(&w, mpm_stepper_surface_reaction(w.stepper, s, NULL), MPM_E_ARG, "force is NULL");
  ck_refused(&w, mpm_stepper_surface_impulse(w.stepper, NULL, out), MPM_E_ARG, "surface is NULL");
  ck_refused(&w, mpm_stepper_surface_impulse(w.stepper, s, NULL), MPM_E_ARG, "impulse is NULL");
  mpm_surface *lone;
  ck_ok(&w, mpm_surface_create(w.context, w.grid, NULL, &lone));
  ck_refused(&w, mpm_stepper_surface_impulse(w.stepper, lone, out), MPM_E_NOT_FOUND, "not in this stepper");
  const int64_t zero = 0;
  ck_refused(&w, mpm_surface_set(s, "reaction", MPM_F64, 2, 1, &zero, out), MPM_E_ARG, "cannot be set");
  ck_refused(&w, mpm_surface_set(s, "gap", MPM_F64, 2, 1, &zero, out), MPM_E_ARG, "cannot be set");
  const double bad[2] = {0.0, NOT_A_NUMBER};
  ck_refused(&w, mpm_surface_set(s, "prescribed_velocity", MPM_F64, 2, 1, &zero, bad), MPM_E_ARG,
             "prescribed_velocity[1] is");
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-3));
  ck_refused(&w, mpm_surface_set_velocity(s, NULL, NULL), MPM_E_STATE, "staged step");
  ck_ok(&w, mpm_step_abort(w.stepper));
  ck_ok(&w, mpm_surface_destroy(lone));
  drop_surface(&w, s);
  world_close(&other);
  world_close(&w);
}
END_TEST

/* ---- threads and states -------------------------------------------------------------------------------- */
static mpm_surface *story_world(world *w, const method *how, int32_t concurrency, int32_t scatter) {
  world_desc desc = world_with(how, 2, CELLS, spacing);
  desc.context.concurrency = concurrency;
  desc.random_order = scatter;
  desc.stepper.gravity[1] = -9.81;
  open_block_with(w, &desc);
  mpm_surface_desc d = prescribing(1);
  d.velocity[0] = 0.5;
  mpm_surface *s = put_surface(w, &d);
  add_circle(w, s, 0.5, 0.1);
  return s;
}

START_TEST(threads_change_no_bit) {
  const method newmark = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  const method *how = _i ? &newmark : &methods[0];
  uint64_t wanted = 0;
  for (int32_t k = 0; k < 3; ++k) {
    world w;
    mpm_surface *s = story_world(&w, how, k == 0 ? 1 : k + 1, k == 2);
    for (int32_t i = 0; i < 10; ++i) world_step(&w, 1e-3);
    if (!k) wanted = world_hash(&w);
    ck_holds(world_hash(&w) == wanted);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

START_TEST(states_hold_what_is_prescribed) {
  const method newmark = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  const method *how = _i ? &newmark : &methods[0];
  world a, b;
  mpm_surface *s = story_world(&a, how, 1, 0), *t = story_world(&b, how, 1, 0);
  const double own[2] = {0.25, -0.5};
  const int64_t three = 3;
  const uint64_t before = world_hash(&a);
  ck_ok(&a, mpm_surface_set(s, "prescribed_velocity", MPM_F64, 2, 1, &three, own));
  ck_holds(world_hash(&a) != before);
  for (int32_t i = 0; i < 4; ++i) world_step(&a, 1e-3);
  saved_state state = world_save(&a);
  world_load(&b, &state);
  free(state.data);
  for (int32_t i = 0; i < 4; ++i) {
    double x[3], y[3];
    memcpy(x, reaction_of(&a, s), sizeof x);
    memcpy(y, reaction_of(&b, t), sizeof y);
    ck_holds(x[0] == y[0] && x[1] == y[1]);
    ck_ok(&a, mpm_stepper_surface_impulse(a.stepper, s, x));
    ck_ok(&b, mpm_stepper_surface_impulse(b.stepper, t, y));
    ck_holds(x[0] == y[0] && x[1] == y[1]);
    world_step(&a, 1e-3);
    world_step(&b, 1e-3);
    ck_holds(world_hash(&a) == world_hash(&b));
  }
  drop_surface(&a, s);
  drop_surface(&b, t);
  world_close(&a);
  world_close(&b);
}
END_TEST

static mpm_status hold_and_turn(world *w, mpm_surface **s, int32_t done) {
  static spin of = {0, 1.0, 0.0, 0.0};
  static const double corner[8] = {1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 2.0, 2.0};
  const mpm_surface_desc d = prescribing(0);
  switch (done) {
  case 0:
    return mpm_surface_create(w->context, w->grid, &d, s);
  case 1:
    return mpm_stepper_add_surface(w->stepper, *s);
  case 2:
    return mpm_surface_add_polyline(*s, 4, corner, 1, 0.2, NULL, NULL);
  case 3:
    return mpm_surface_set_velocity(*s, turn, &of);
  default:
    return mpm_step(w->stepper, 2e-3, NULL);
  }
}

START_TEST(every_allocation_fails_once) {
  const method newmark = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  fail_every_allocation(_i ? &newmark : &methods[0], 6, hold_and_turn);
}
END_TEST

Suite *prescribed_surface_suite(void);
Suite *prescribed_surface_suite(void) {
  Suite *suite = suite_create("prescribed_surface");
  TCase *kept = tcase_create("kept"), *nodes = tcase_create("nodes"), *other = tcase_create("other");
  add_sparse(kept, impulse_is_momentum, BROAD, 3);
  tcase_add_loop_test(kept, impulse_on_every_grid, 0, 4 * KINDS);
  add_sparse(kept, rigid_motion, BROAD, 5);
  tcase_add_loop_test(kept, work_of_a_surface, 0, BROAD);
  tcase_set_timeout(kept, 60);
  suite_add_tcase(suite, kept);
  tcase_add_loop_test(nodes, slides_along, 0, BROAD);
  tcase_add_loop_test(nodes, slides_round, 0, 2);
  tcase_add_test(nodes, faces_that_meet);
  tcase_add_test(nodes, others_come_first);
  tcase_add_loop_test(nodes, half_on_a_wall, 0, BROAD);
  tcase_set_timeout(nodes, 60);
  suite_add_tcase(suite, nodes);
  tcase_add_test(other, velocities_add_up);
  tcase_add_test(other, failures_leave_no_trace);
  tcase_add_test(other, refusals);
  tcase_add_loop_test(other, threads_change_no_bit, 0, 2);
  tcase_add_loop_test(other, states_hold_what_is_prescribed, 0, 2);
  tcase_add_loop_test(other, every_allocation_fails_once, 0, 2);
  tcase_set_timeout(other, 60);
  suite_add_tcase(suite, other);
  add_prescribed_implicit(suite);
  add_prescribed_corners(suite);
  return suite;
}
