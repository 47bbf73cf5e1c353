/* Contact of bodies: what it keeps, what it reports, what it refuses; its numbers are verified by the cases
 * contact_... of the verification. */
#include "body.h"
#include "io/state.h"

enum { THIRD = 1 << 4, ROUND = 1 << 5 };

/* Boxes of one set each that move against each other along x and slide along the other axes; with THIRD three
 * of them, that all meet; with ROUND through the seam of a periodic axis. */
typedef struct boxes {
  int32_t dim, flags, concurrency, random_order;
  method method;
  mpm_contact_desc contact;
} boxes;

static const double spacing = 0.25, box_speed = 2.0, box_dt = 1e-3;

static mpm_contact_desc contact_desc(double friction) {
  mpm_contact_desc d;
  ck_assert_int_eq(mpm_contact_desc_init(&d, sizeof d), MPM_OK);
  d.friction = friction;
  return d;
}

static void open_boxes(world *w, const boxes *of) {
  const int32_t dim = of->dim, bodies = of->flags & THIRD ? 3 : 2;
  const double h = spacing, shift = of->flags & ROUND ? 6.0 * h : 0.0, length = 12.0 * h;
  /* the lower corners in cells; the third lies on top of both */
  static const double low[3][3] = {{3, 3, 3}, {6, 3.5, 3.5}, {4, 6, 4}};
  world_desc desc = world_with(&of->method, dim, 12, h);
  desc.context.concurrency = of->concurrency ? of->concurrency : 1;
  desc.random_order = of->random_order;
  desc.grid.periodic[0] = (of->flags & ROUND) != 0;
  desc.sets = 1;
  world_open(w, &desc);
  for (int32_t m = 0; m < bodies; ++m) {
    mpm_particles *set = m ? world_add_set(w, NULL) : w->set[0];
    double lower[3], upper[3], v[3];
    for (int32_t k = 0; k < dim; ++k) {
      lower[k] = h * low[m][k];
      upper[k] = lower[k] + 3.0 * h;
      v[k] = (m == 0 ? 1.0 : m == 1 ? -1.0 : k == 1 ? -1.0 : 0.3) * (k ? 0.5 : 1.0) * box_speed;
    }
    const int64_t n = world_fill(w, set, lower, upper, 2);
    double *x = fetch(w, set, "position", dim);
    for (int64_t i = 0; i < n; ++i) {
      x[i] += shift;
      if (x[i] >= length) x[i] -= length;
    }
    put(w, set, "position", dim, x);
    free(x);
    ck_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
    ck_ok(w, mpm_stepper_set_body(w->stepper, set, 3 - m));
  }
  ck_ok(w, mpm_stepper_set_contact(w->stepper, MPM_BODY_ANY, MPM_BODY_ANY, &of->contact));
}

static mpm_contact_info contact_of(const world *w, int32_t a, int32_t b) {
  mpm_contact_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_stepper_contact_info(w->stepper, a, b, &info));
  return info;
}

static void momentum_of(const world *w, const mpm_particles *set, double *p) {
  const int64_t n = mpm_particles_count(set);
  double *v = fetch(w, set, "velocity", w->dim), *m = fetch(w, set, "mass", 1);
  for (int32_t c = 0; c < w->dim; ++c) p[c] = weighted_sum(n, m, v + c * n);
  free(v);
  free(m);
}

/* ---- what contact keeps -------------------------------------------------------------------------------- */
/* What bodies gain is what they report to have got, in each step and in all; contact never gives energy. */
static void follow_impulses(world *w, const char *name) {
  const int32_t bodies = w->sets;
  double start[3][3], p[3][3], scale = 0.0;
  for (int32_t m = 0; m < bodies; ++m) momentum_of(w, w->set[m], start[m]);
  for (int32_t m = 0; m < bodies; ++m) scale += fabs(start[m][0]);
  const double energy = world_info(w).kinetic_energy;
  int64_t closed = 0;
  for (int32_t i = 0; i < 60; ++i) {
    double before[3][3];
    for (int32_t m = 0; m < bodies; ++m) momentum_of(w, w->set[m], before[m]);
    const int32_t staged = i % 3 == 0 && w->desc.stepper.scheme != MPM_NEWMARK;
    const mpm_step_info info = staged ? world_staged_step(w, box_dt) : world_step(w, box_dt);
    ck_between(name, info.contact_dissipation, -1e-12 * energy, energy);
    double dissipation = 0.0;
    for (int32_t m = 0; m < bodies; ++m) {
      const mpm_contact_info got = contact_of(w, MPM_BODY_ANY, 3 - m);
      momentum_of(w, w->set[m], p[m]);
      for (int32_t c = 0; c < w->dim; ++c) {
        ck_within(name, p[m][c] - before[m][c], box_dt * got.force[c], 1e-11 * scale);
        ck_within(name, p[m][c] - start[m][c], got.impulse[c], 1e-11 * scale);
      }
      dissipation += 0.5 * got.dissipation;
    }
    ck_within(name, dissipation, info.contact_dissipation, 1e-12 * energy);
    closed += info.contact_nodes;
  }
  ck_assert_int_gt(closed, 0);
}

START_TEST(momentum_and_energy) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t flags = 0; flags <= (ROUND | THIRD); flags += THIRD) {
      if ((dim == 1 && (how->remedy || flags & THIRD)) || (flags == (ROUND | THIRD) && how->staggered))
        continue;
      world w;
      /* where three bodies meet with friction, there may be no implicit step */
      const double friction = how->scheme == MPM_NEWMARK && flags & THIRD ? 0.0 : 0.3;
      open_boxes(&w, &(boxes){.dim = dim, .flags = flags, .method = *how, .contact = contact_desc(friction)});
      follow_impulses(&w, how->name);
      world_close(&w);
    }
}
END_TEST

/* Nodes before and after contact, by the hooks around it: what they lose of their energy is the
 * dissipation. */
static mpm_status add_energy(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  double *energy = user;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t i = 0; i < b->n; ++i) {
      const double v = velocity[c * b->ld + i] + box_dt * force[c * b->ld + i] / b->mass[i];
      *energy += 0.5 * b->mass[i] * v * v;
    }
  return MPM_OK;
}
static mpm_status take_energy(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  double *energy = user;
  (void)force;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t i = 0; i < b->n; ++i) {
      const double v = velocity[c * b->ld + i];
      *energy -= 0.5 * b->mass[i] * v * v;
    }
  return MPM_OK;
}

START_TEST(energy_of_nodes) {
  for (int32_t flags = 0; flags <= THIRD; flags += THIRD) {
    world w;
    double lost = 0.0, most = 0.0;
    open_boxes(&w, &(boxes){.dim = _i, .flags = flags, .method = methods[0], .contact = contact_desc(0.3)});
    const double energy = world_info(&w).kinetic_energy;
    ck_ok(&w, mpm_stepper_set_node_hook(w.stepper, MPM_AFTER_FORCES, add_energy, &lost));
    ck_ok(&w, mpm_stepper_set_node_hook(w.stepper, MPM_AFTER_VELOCITY, take_energy, &lost));
    for (int32_t step = 0; step < 20; ++step) {
      lost = 0.0;
      const mpm_step_info info = world_step(&w, box_dt);
      ck_within("energy of nodes", info.contact_dissipation, lost, 1e-12 * energy);
      most = fmax(most, lost);
    }
    ck_assert_double_gt(most, 1e-4 * energy);
    world_close(&w);
  }
}
END_TEST

/* The particles of a cloud have the mass of its node, wherever the bodies lie in their blocks. */
START_TEST(clouds_have_the_mass_of_nodes) {
  const method *how = broad_methods[_i];
  if (how->scheme == MPM_NEWMARK) return;
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t flags = 0; flags <= ROUND; flags += ROUND) {
      if (dim == 1 && how->remedy) continue;
      world w;
      open_boxes(&w, &(boxes){.dim = dim, .flags = flags, .method = *how, .contact = contact_desc(0.0)});
      int64_t seen = 0;
      for (int32_t move = 0; move < 6; ++move) { /* diagonally, past the corners of blocks */
        for (int32_t m = 0; m < 2 && move; ++m) {
          const int64_t n = mpm_particles_count(w.set[m]);
          double *x = fetch(&w, w.set[m], "position", dim);
          for (int64_t i = 0; i < n * dim; ++i) x[i] += (move < 4 ? 0.5 : -1.7) * spacing;
          put(&w, w.set[m], "position", dim, x);
          free(x);
        }
        world_step(&w, 1e-6);
        const mpmi_contact_nodes *contact = &w.stepper->nodes.contact;
        for (int64_t i = 0; i < contact->cloud_count; ++i) {
          const mpmi_cloud *cloud = &contact->cloud[i];
          double mass = 0.0;
          for (int64_t e = cloud->first; e < cloud->first + cloud->count; ++e) {
            const mpmi_cloud_entry *entry = &contact->entry[e];
            mass += entry->volume /
                    mpmi_f64(w.stepper->layout.member[entry->member].set, MPMI_VOLUME, 0)[entry->slot] *
                    mpmi_f64(w.stepper->layout.member[entry->member].set, MPMI_MASS, 0)[entry->slot];
          }
          const double wanted = *mpmi_mass(&w.stepper->nodes.solved, cloud->slot);
          ck_within(how->name, mass, wanted, 1e-4 * wanted); /* volumes have changed in the step */
          seen += cloud->count;
        }
      }
      ck_assert_int_gt(seen, 0);
      world_close(&w);
    }
}
END_TEST

/* Steps in parts are whole steps. */
START_TEST(steps_in_parts) {
  const method *how = broad_methods[_i];
  if (how->scheme == MPM_NEWMARK || how->transfer == MPM_APIC_MLS) return;
  world w[2];
  mpm_contact_desc d = contact_desc(0.3);
  d.normal = _i % 2 ? MPM_NORMAL_DISCRIMINANT : MPM_NORMAL_LOGISTIC;
  for (int32_t i = 0; i < 2; ++i) {
    open_boxes(&w[i], &(boxes){.dim = 2, .flags = THIRD, .method = *how, .contact = d});
    for (int32_t step = 0; step < 12; ++step) {
      if (i)
        world_staged_step(&w[i], box_dt);
      else
        world_step(&w[i], box_dt);
    }
  }
  ck_assert_uint_eq(world_hash(&w[0]), world_hash(&w[1]));
  for (int32_t i = 0; i < 2; ++i) world_close(&w[i]);
}
END_TEST

/* A tool that moves as it is told does the work of its force: on a body that it pushes, and with a smooth
 * rule of its own the energies balance. */
START_TEST(work_of_a_tool) {
  const method *how = &methods[_i];
  world w;
  open_boxes(&w, &(boxes){.dim = 2, .method = *how, .contact = contact_desc(0.2)});
  const uint8_t all[2] = {1, 1};
  const double v[2] = {box_speed, 0.3 * box_speed}, rest[2] = {0.0, 0.0};
  ck_ok(&w, mpm_particles_set_all(w.set[0], "prescribed", MPM_U8, 2, all));
  ck_ok(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, 2, v));
  ck_ok(&w, mpm_particles_set_all(w.set[1], "velocity", MPM_F64, 2, rest));
  double work = 0.0;
  for (int32_t step = 0; step < 30; ++step) {
    const mpm_step_info info = world_step(&w, box_dt);
    const mpm_contact_info on_block = contact_of(&w, 3, 2);
    work += box_dt * (on_block.force[0] * v[0] + on_block.force[1] * v[1]);
    ck_within(how->name, info.external_work_total, work, 1e-10 * fabs(work) + 1e-12);
    ck_assert_double_ge(info.dissipation, -5e-3 * fabs(work)); /* without the affine part */
  }
  ck_assert_double_gt(work, 0.0);
  world_close(&w);
}
END_TEST

/* Every option of contact on a plain method, in 2-D and 3-D. */
START_TEST(options_of_contact) {
  static const double fixed[3] = {-1.0, 0.0, 0.0}; /* body 3 is on the left of body 2 */
  for (int32_t kind = MPM_CONTACT_UNILATERAL; kind <= MPM_CONTACT_TIED; ++kind)
    for (int32_t normal = MPM_NORMAL_LOGISTIC; normal <= MPM_NORMAL_FIXED; ++normal)
      for (int32_t detection = MPM_DETECT_DEFAULT; detection <= MPM_DETECT_VELOCITY; ++detection) {
        mpm_contact_desc d = contact_desc(0.2);
        d.kind = kind;
        d.normal = normal;
        d.detection = detection;
        d.friction_static = 0.4;
        if (normal == MPM_NORMAL_FIXED) memcpy(d.direction, fixed, sizeof fixed);
        world w;
        open_boxes(&w, &(boxes){.dim = _i, .method = methods[1], .contact = d});
        if (kind != MPM_CONTACT_NONE) {
          follow_impulses(&w, "options");
        } else {
          for (int32_t step = 0; step < 20; ++step) world_step(&w, box_dt);
          ck_assert_int_eq(contact_of(&w, 2, 3).nodes, 0);
        }
        world_close(&w);
      }
}
END_TEST

/* Tied bodies move as one where particles take the velocity of the nodes. */
START_TEST(tied_is_one) {
  for (int32_t i = 0; i < 3; ++i) {
    method how = methods[0];
    how.scheme = i == 2 ? MPM_MUSL : MPM_USL;
    how.transfer = i == 1 ? MPM_APIC : MPM_FLIP;
    how.flip = 0.0;
    mpm_contact_desc d = contact_desc(0.0);
    d.kind = MPM_CONTACT_TIED;
    world two, one;
    open_boxes(&two, &(boxes){.dim = _i, .method = how, .contact = d});
    open_boxes(&one, &(boxes){.dim = _i, .method = how, .contact = d});
    ck_ok(&one, mpm_stepper_set_body(one.stepper, one.set[0], 2));
    for (int32_t step = 0; step < 20; ++step) {
      world_step(&two, box_dt);
      world_step(&one, box_dt);
    }
    ck_assert_int_gt(contact_of(&two, 2, 3).stuck, 0);
    world_agree(how.name, &two, &one, "velocity", _i, 1e-11);
    world_agree(how.name, &two, &one, "stress", 6, 1e-9);
    world_close(&two);
    world_close(&one);
  }
}
END_TEST

/* Adhesion holds bodies that part, up to its traction times the area; a static friction above the other one
 * holds longer. */
START_TEST(adhesion) {
  mpm_contact_desc d = contact_desc(0.0);
  d.adhesion = 100.0;
  world w;
  open_boxes(&w, &(boxes){.dim = _i, .method = methods[1], .contact = d});
  for (int32_t m = 0; m < 2; ++m) {
    double v[3] = {m ? 1.0 : -1.0, 0.0, 0.0}; /* they part */
    ck_ok(&w, mpm_particles_set_all(w.set[m], "velocity", MPM_F64, _i, v));
  }
  world_step(&w, box_dt);
  const mpm_contact_info info = contact_of(&w, 3, 2); /* from left to right */
  ck_assert_int_gt(info.closed, 0);
  ck_assert_double_lt(info.force[0], 0.0);
  ck_within("adhesion", info.normal_force, -d.adhesion * info.area, 1e-9 * d.adhesion * info.area);
  ck_assert_double_le(info.pressure_max, 0.0);
  world_close(&w);
}
END_TEST

/* Cells four times as long as they are high: particles side by side are farther apart than the height of a
 * cell, and bodies that meet face to face do so at every node between them. */
START_TEST(unequal_spacings) {
  const double h = spacing;
  world w;
  world_desc desc = world_with(&methods[1], _i, 12, h);
  for (int32_t k = 0; k < _i - 1; ++k) desc.grid.spacing[k] = 4.0 * h;
  world_open(&w, &desc);
  for (int32_t m = 0; m < 2; ++m) {
    mpm_particles *set = m ? world_add_set(&w, NULL) : w.set[0];
    double lower[3], upper[3], v[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < _i; ++k) {
      const int32_t across = k == _i - 1;
      lower[k] = across ? h * (m ? 6.0 : 3.0) : 16.0 * h;
      upper[k] = across ? h * (m ? 9.0 : 6.0) : 32.0 * h;
    }
    v[_i - 1] = m ? -box_speed : box_speed;
    world_fill(&w, set, lower, upper, 2);
    ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, _i, v));
    ck_ok(&w, mpm_stepper_set_body(w.stepper, set, m));
  }
  for (int32_t i = 0; i < 20; ++i) world_step(&w, box_dt);
  const mpm_contact_info info = contact_of(&w, 0, 1);
  double area = 1.0;
  for (int32_t k = 0; k < _i - 1; ++k) area *= 16.0 * h;
  ck_within("area", info.area, area, 0.05 * area);
  world_close(&w);
}
END_TEST

/* Half of two bodies that collide symmetrically, on a slip wall in the plane of symmetry, is half of the
 * whole: particles beyond the wall are seen there. The upper faces of the one slide on the other as well. */
START_TEST(half_on_a_wall) {
  const double h = spacing;
  world w[2];
  for (int32_t half = 0; half < 2; ++half) {
    world_desc desc = world_with(&methods[_i], 2, 12, h);
    if (half) {
      desc.grid.origin[1] = 6.0 * h;
      desc.grid.cells[1] = 6;
    }
    desc.sets = 1;
    world_open(&w[half], &desc);
    world_add_set(&w[half], NULL);
    for (int32_t m = 0; m < 2; ++m) {
      const double lower[2] = {(m ? 6.0 : 3.0) * h, half ? 6.0 * h : (m ? 3.5 : 4.0) * h},
                   upper[2] = {lower[0] + 3.0 * h, (m ? 8.5 : 8.0) * h};
      const double v[2] = {m ? -box_speed : box_speed, 0.0};
      world_fill(&w[half], w[half].set[m], lower, upper, 2);
      ck_ok(&w[half], mpm_particles_set_all(w[half].set[m], "velocity", MPM_F64, 2, v));
      ck_ok(&w[half], mpm_stepper_set_body(w[half].stepper, w[half].set[m], m));
    }
    const mpm_contact_desc d = contact_desc(0.3);
    ck_ok(&w[half], mpm_stepper_set_contact(w[half].stepper, 0, 1, &d));
  }
  ck_ok(&w[1], mpm_stepper_set_wall(w[1].stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  for (int32_t step = 0; step < 25; ++step)
    for (int32_t half = 0; half < 2; ++half) world_step(&w[half], box_dt);
  const mpm_contact_info all = contact_of(&w[0], 0, 1), part = contact_of(&w[1], 0, 1);
  ck_assert_double_gt(all.force[0], 0.0);
  ck_within(methods[_i].name, w[1].info.momentum[0], 0.5 * w[0].info.momentum[0], 1e-9);
  ck_within(methods[_i].name, w[1].info.kinetic_energy, 0.5 * w[0].info.kinetic_energy,
            1e-9 * w[0].info.kinetic_energy);
  ck_within(methods[_i].name, part.gap, all.gap, 1e-9 * h);
  for (int32_t half = 0; half < 2; ++half) world_close(&w[half]);
}
END_TEST

/* ---- the host's friction ------------------------------------------------------------------------------- */
typedef struct asked {
  int64_t nodes, pairs;
  int32_t answer;
  double friction;
} asked;

static mpm_status give_friction(void *user, const mpm_contact_batch *b, double *friction) {
  asked *a = user;
  ck_holds(b->struct_size == sizeof *b && b->body_a == 2 && b->body_b == 3 && b->ld >= b->n && b->n > 0);
  for (int64_t i = 0; i < b->n; ++i) {
    double squared = 0.0, along = 0.0;
    for (int32_t c = 0; c < b->dim; ++c) {
      const double n = b->normal[c * b->ld + i];
      squared += n * n;
      along += n * b->slip[c * b->ld + i];
      ck_holds(isfinite(b->position[c * b->ld + i]));
    }
    ck_holds(fabs(squared - 1.0) < 1e-12 && fabs(along) < 1e-12 * box_speed);
    ck_holds(b->area[i] >= 0.0 && b->pressure[i] >= 0.0 && b->gap[i] <= spacing);
    ck_holds(friction[i] == 0.1);
    friction[i] = a->friction;
  }
  a->nodes += b->n;
  ++a->pairs;
  return a->answer;
}

START_TEST(friction_callback) {
  world w, same;
  const boxes of = {.dim = 2, .method = methods[_i], .contact = contact_desc(0.1)};
  boxes with = of;
  with.contact.friction = 0.6;
  asked a = {.friction = 0.6};
  open_boxes(&w, &of);
  open_boxes(&same, &with);
  ck_ok(&w, mpm_stepper_set_friction(w.stepper, give_friction, &a));
  for (int32_t i = 0; i < 10; ++i) {
    world_step(&w, box_dt);
    world_step(&same, box_dt);
  }
  ck_assert_int_gt(a.nodes, 0);
  ck_assert_uint_eq(world_hash(&w), world_hash(&same));
  /* a refusal and bad answers leave everything as it was */
  const world_bits was = world_take(&w);
  const mpm_contact_info info = contact_of(&w, 2, 3);
  a.answer = 7;
  ck_assert_int_eq(mpm_step(w.stepper, box_dt, &w.info), MPM_CUT_DT);
  ck_assert_int_eq(w.info.callback_status, 7);
  a.answer = -1;
  ck_refused(&w, mpm_step(w.stepper, box_dt, &w.info), MPM_E_CALLBACK, "the friction callback returned -1");
  a.answer = 0;
  a.friction = NOT_A_NUMBER;
  ck_assert_int_eq(mpm_step(w.stepper, box_dt, &w.info), MPM_NONFINITE);
  ck_assert_int_ge(w.info.node, 0);
  ck_assert_int_eq(w.info.body, 2);
  a.friction = -1.0;
  ck_refused(&w, mpm_step(w.stepper, box_dt, &w.info), MPM_E_CALLBACK, "is negative at node");
  world_same(&w, &was, "after refusals");
  const mpm_contact_info now = contact_of(&w, 2, 3);
  ck_assert_mem_eq(&now, &info, sizeof now);
  bits_drop((world_bits *)&was);
  ck_ok(&w, mpm_stepper_set_friction(w.stepper, NULL, NULL));
  world_close(&w);
  world_close(&same);
}
END_TEST

/* ---- same bits ----------------------------------------------------------------------------------------- */
START_TEST(threads_and_order) {
  const method *how = broad_methods[_i];
  const double friction = how->scheme == MPM_NEWMARK ? 0.0 : 0.3;
  uint64_t hash[4];
  mpm_contact_info info[4];
  for (int32_t i = 0; i < 4; ++i) {
    world w;
    open_boxes(&w, &(boxes){.dim = 2 + _i % 2,
                            .flags = THIRD,
                            .method = *how,
                            .contact = contact_desc(friction),
                            .concurrency = i == 3 ? 4 : 1 + 2 * i,
                            .random_order = i == 3});
    for (int32_t step = 0; step < 20; ++step) world_step(&w, box_dt);
    hash[i] = world_hash(&w);
    info[i] = contact_of(&w, 2, 3);
    world_close(&w);
    ck_assert_uint_eq(hash[i], hash[0]);
    ck_assert_mem_eq(&info[i], &info[0], sizeof info[0]);
  }
}
END_TEST

/* Saved in the middle of contact and loaded into a stepper without bodies and rules. */
START_TEST(saved_in_contact) {
  const method *how = broad_methods[_i];
  boxes of = {.dim = 2, .flags = THIRD | ROUND, .method = *how, .contact = contact_desc(0.3)};
  boxes plain = of;
  plain.contact = contact_desc(0.0);
  of.contact.friction_static = 0.5;
  of.contact.adhesion = 1.0;
  if (how->scheme == MPM_NEWMARK) of.contact = contact_desc(0.0);
  of.contact.offset = 1e-3;
  world w, other;
  open_boxes(&w, &of);
  open_boxes(&other, &plain);
  for (int32_t m = 0; m < 3; ++m) ck_ok(&other, mpm_stepper_set_body(other.stepper, other.set[m], 0));
  mpm_contact_desc none = contact_desc(0.0);
  none.kind = MPM_CONTACT_NONE;
  ck_ok(&other, mpm_stepper_set_contact(other.stepper, 1, 9, &none));
  for (int32_t step = 0; step < 8; ++step) world_step(&w, box_dt);
  ck_assert_double_gt(fabs(contact_of(&w, 2, 3).impulse[0]), 0.0);
  world_copy(&w, &other);
  for (int32_t m = 0; m < 3; ++m) {
    int32_t body;
    ck_ok(&other, mpm_stepper_body(other.stepper, other.set[m], &body));
    ck_assert_int_eq(body, 3 - m);
  }
  mpm_contact_info was = contact_of(&w, 3, 1), now = contact_of(&other, 3, 1);
  ck_assert_mem_eq(&now, &was, sizeof now);
  unsigned char bytes[2][4096];
  memset(bytes, 0, sizeof bytes);
  for (int32_t i = 0; i < 2; ++i) {
    mpmi_archive a;
    mpmi_archive_begin(&a, w.context, MPMI_TO_MEMORY);
    a.to = bytes[i];
    mpmi_state_write_contact(&a, i ? other.stepper : w.stepper);
    ck_assert_int_le(a.at, sizeof bytes[i]);
  }
  ck_assert_mem_eq(bytes[0], bytes[1], sizeof bytes[0]);
  for (int32_t step = 0; step < 8; ++step) {
    world_step(&w, box_dt);
    world_step(&other, box_dt);
    was = contact_of(&w, 2, MPM_BODY_ANY);
    now = contact_of(&other, 2, MPM_BODY_ANY);
    ck_assert_mem_eq(&now, &was, sizeof now);
    same_info(&w, &other);
  }
  ck_assert_uint_eq(world_hash(&w), world_hash(&other));
  world_close(&w);
  world_close(&other);
}
END_TEST

/* The number of a body is a name: all in body 4095 is all in body 0. */
START_TEST(name_of_a_body) {
  uint64_t hash[2];
  for (int32_t i = 0; i < 2; ++i) {
    world w;
    open_boxes(&w, &(boxes){.dim = 2, .method = methods[_i], .contact = contact_desc(0.3)});
    for (int32_t m = 0; m < 2; ++m) ck_ok(&w, mpm_stepper_set_body(w.stepper, w.set[m], i ? 4095 : 0));
    for (int32_t step = 0; step < 10; ++step) world_step(&w, box_dt);
    ck_assert_int_eq(w.info.contact_nodes, 0);
    hash[i] = world_hash(&w);
    world_close(&w);
  }
  ck_assert_uint_eq(hash[0], hash[1]);
}
END_TEST

/* ---- reports ------------------------------------------------------------------------------------------- */
static double *body_nodes(world *w, int32_t body, const char *field, int64_t *n) {
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(w, mpm_grid_map(w->stepper, body, field, MPM_READ, &view));
  double *copy = calloc((size_t)(view.count * view.components + 1), sizeof *copy);
  for (int64_t i = 0; i < view.count * view.components; ++i) copy[i] = ((const double *)view.data)[i];
  *n = view.count;
  ck_ok(w, mpm_view_release(&view));
  return copy;
}

/* Nodal forces of contact add up to the report; force, reaction and contact_force to mass times
 * acceleration. */
START_TEST(nodal_fields) {
  for (int32_t flags = 0; flags <= ROUND; flags += ROUND) {
    world w;
    open_boxes(&w, &(boxes){.dim = _i, .flags = flags, .method = methods[1], .contact = contact_desc(0.3)});
    for (int32_t step = 0; step < 10; ++step) world_step(&w, box_dt);
    for (int32_t m = 0; m < 2; ++m) {
      const mpm_contact_info info = contact_of(&w, MPM_BODY_ANY, 3 - m);
      int64_t n;
      double *force = body_nodes(&w, 3 - m, "contact_force", &n), *all = body_nodes(&w, 3 - m, "force", &n),
             *reaction = body_nodes(&w, 3 - m, "reaction", &n), *mass = body_nodes(&w, 3 - m, "mass", &n),
             *a = body_nodes(&w, 3 - m, "acceleration", &n), *gap = body_nodes(&w, 3 - m, "contact_gap", &n),
             *normal = body_nodes(&w, 3 - m, "contact_normal", &n),
             *area = body_nodes(&w, 3 - m, "contact_area", &n);
      const double scale = info.normal_force;
      int64_t met = 0;
      ck_assert_double_gt(scale, 0.0);
      for (int32_t c = 0; c < _i; ++c)
        ck_within("sum", sum_of(n, force + c * n), info.force[c], 1e-12 * scale);
      for (int64_t i = 0; i < n; ++i) {
        double squared = 0.0;
        for (int32_t c = 0; c < _i; ++c) {
          const double sum = all[c * n + i] + reaction[c * n + i] + force[c * n + i];
          ck_within("balance", sum, mass[i] * a[c * n + i], 1e-11 * (scale + fabs(all[c * n + i])));
          squared += normal[c * n + i] * normal[c * n + i];
        }
        ck_holds(isinf(gap[i]) || fabs(squared - 1.0) < 1e-12);
        ck_holds(area[i] >= 0.0);
        met += squared > 0.5;
      }
      ck_assert_int_ge(met, info.nodes);
      free(force), free(all), free(reaction), free(mass), free(a), free(gap), free(normal), free(area);
    }
    char path[256];
    ck_ok(&w, mpm_write_body_grid(w.stepper, 3, scratch_path("contact.vti", path, sizeof path), 0, NULL));
    ck_refused(&w, mpm_write_grid(w.stepper, path, 0, NULL), MPM_E_NOT_FOUND, "body is 0");
    mpm_view view = {.struct_size = sizeof view};
    ck_refused(&w, mpm_grid_map(w.stepper, 1, "mass", MPM_READ, &view), MPM_E_NOT_FOUND, "body is 1");
    world_close(&w);
  }
}
END_TEST

/* Views of two bodies at a time, written back each to its own nodes. */
START_TEST(views_of_bodies) {
  world w;
  open_boxes(&w, &(boxes){.dim = 2, .method = methods[1], .contact = contact_desc(0.0)});
  ck_ok(&w, mpm_step_begin(w.stepper, box_dt));
  mpm_view view[2];
  for (int32_t m = 0; m < 2; ++m) {
    view[m] = (mpm_view){.struct_size = sizeof *view};
    ck_ok(&w, mpm_grid_map(w.stepper, 3 - m, "velocity", MPM_READ | MPM_WRITE, &view[m]));
  }
  for (int32_t m = 0; m < 2; ++m)
    for (int64_t i = 0; i < view[m].count * 2; ++i) ((double *)view[m].data)[i] = m ? 5.0 : -7.0;
  for (int32_t m = 1; m >= 0; --m) ck_ok(&w, mpm_view_release(&view[m]));
  for (int32_t m = 0; m < 2; ++m) {
    int64_t n;
    double *v = body_nodes(&w, 3 - m, "velocity", &n);
    for (int64_t i = 0; i < 2 * n; ++i) ck_within("velocity", v[i], m ? 5.0 : -7.0, 1e-12);
    free(v);
  }
  ck_ok(&w, mpm_step_abort(w.stepper));
  world_close(&w);
}
END_TEST

START_TEST(sums_start_anew) {
  world w;
  open_boxes(&w, &(boxes){.dim = 2, .method = methods[1], .contact = contact_desc(0.3)});
  ck_refused(
      &w,
      mpm_stepper_contact_info(w.stepper, 2, 3, &(mpm_contact_info){.struct_size = sizeof(mpm_contact_info)}),
      MPM_E_STATE, "no step");
  for (int32_t step = 0; step < 10; ++step) world_step(&w, box_dt);
  const mpm_contact_info a = contact_of(&w, 2, 3), b = contact_of(&w, 3, 2);
  ck_assert_double_ne(a.impulse[0], 0.0);
  ck_assert_int_eq(a.touching, 1);
  for (int32_t c = 0; c < 3; ++c) {
    ck_assert_double_eq(a.force[c], -b.force[c]);
    ck_assert_double_eq(a.impulse[c], -b.impulse[c]);
    ck_assert_double_eq(a.torque[c], -b.torque[c]);
  }
  ck_assert_double_gt(a.torque[2] * a.torque[2], 0.0);
  ck_assert_double_eq(a.normal_force, b.normal_force);
  ck_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 0));
  ck_assert_double_eq(contact_of(&w, 2, 3).impulse[0], 0.0);
  const mpm_contact_info far = contact_of(&w, 7, 8);
  ck_assert_int_eq(far.nodes, 0);
  ck_assert(isinf(far.gap));
  world_close(&w);
}
END_TEST

/* ---- rules --------------------------------------------------------------------------------------------- */
/* The closest rule counts: of the pair, of a body, of all. */
START_TEST(closest_rule) {
  world w;
  open_boxes(&w, &(boxes){.dim = 2, .method = methods[1], .contact = contact_desc(0.0)});
  mpm_contact_desc none = contact_desc(0.0), some = contact_desc(0.0);
  none.kind = MPM_CONTACT_NONE;
  const struct {
    int32_t a, b;
    const mpm_contact_desc *desc;
    int32_t meets;
  } story[] = {{MPM_BODY_ANY, MPM_BODY_ANY, &none, 0},
               {3, MPM_BODY_ANY, &some, 1},
               {MPM_BODY_ANY, 2, &none, 0},
               {3, 2, &some, 1},
               {2, 3, NULL, 0},
               {2, MPM_BODY_ANY, NULL, 1},
               {MPM_BODY_ANY, 3, NULL, 0},
               {MPM_BODY_ANY, MPM_BODY_ANY, NULL, 1}};
  for (size_t i = 0; i < sizeof story / sizeof *story; ++i) {
    ck_ok(&w, mpm_stepper_set_contact(w.stepper, story[i].a, story[i].b, story[i].desc));
    world_step(&w, 1e-6);
    if ((contact_of(&w, 2, 3).nodes > 0) != story[i].meets) ck_abort_msg("rule %d", (int)i);
  }
  world_close(&w);
}
END_TEST

START_TEST(refusals) {
  world w;
  open_boxes(&w, &(boxes){.dim = 2, .method = methods[1], .contact = contact_desc(0.0)});
  mpm_stepper *s = w.stepper;
  mpm_contact_info info = {.struct_size = sizeof info};
  int32_t body;
  ck_refused(&w, mpm_stepper_set_body(s, w.set[0], -1), MPM_E_ARG, "body is -1: it must be 0 ... 4095");
  ck_refused(&w, mpm_stepper_set_body(s, w.set[0], 4096), MPM_E_ARG, "body is 4096");
  ck_refused(&w, mpm_stepper_set_body(s, NULL, 0), MPM_E_ARG, "particles is NULL");
  ck_refused(&w, mpm_stepper_body(s, w.set[0], NULL), MPM_E_ARG, "body is NULL");
  ck_refused(&w, mpm_stepper_body(s, NULL, &body), MPM_E_ARG, "particles is NULL");
  ck_refused(&w, mpm_stepper_contact_info(s, 1, 1, &info), MPM_E_ARG, "name two bodies");
  ck_refused(&w, mpm_stepper_contact_info(s, MPM_BODY_ANY, MPM_BODY_ANY, &info), MPM_E_ARG, "name one");
  ck_refused(&w, mpm_stepper_contact_info(s, 1, 4096, &info), MPM_E_ARG, "body is 4096");
  ck_refused(&w, mpm_stepper_contact_info(s, 1, 2, NULL), MPM_E_ARG, "info is NULL");
  const struct {
    mpm_contact_desc desc;
    const char *text;
  } bad[] = {
      {{.kind = 3}, "kind is 3"},
      {{.kind = -1}, "kind is -1"},
      {{.normal = 4}, "normal is 4"},
      {{.detection = 3}, "detection is 3"},
      {{.friction = -1.0}, "friction is -1: it must be finite and >= 0"},
      {{.friction = NOT_A_NUMBER}, "friction is"},
      {{.friction = 0.5, .friction_static = 0.4}, "friction_static is 0.4, less than friction 0.5"},
      {{.adhesion = INFINITE}, "adhesion is inf"},
      {{.offset = INFINITE}, "offset is inf"},
      {{.normal = MPM_NORMAL_FIXED, .direction = {0.9, 0.0, 0.0}}, "has length 0.9"},
      {{.normal = MPM_NORMAL_FIXED}, "direction of the contact of bodies 2 and 3 has length 0: it must be 1"},
      {{.normal = MPM_NORMAL_FIXED, .direction = {0.0, 0.0, 1.0}}, "direction[2] is 1: a 2-D grid"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
    mpm_contact_desc d = bad[i].desc;
    d.struct_size = sizeof d;
    ck_refused(&w, mpm_stepper_set_contact(s, 2, 3, &d), MPM_E_ARG, bad[i].text);
  }
  const mpm_contact_desc good = contact_desc(0.0);
  ck_refused(&w, mpm_stepper_set_contact(s, 2, 2, &good), MPM_E_ARG, "no contact with itself");
  ck_refused(&w, mpm_stepper_set_contact(s, -2, 2, &good), MPM_E_ARG, "body is -2");
  ck_refused(&w, mpm_stepper_set_contact(s, 2, 5000, &good), MPM_E_ARG, "body is 5000");
  ck_assert_int_eq(mpm_contact_desc_init(NULL, sizeof good), MPM_E_ARG);
  mpm_contact_desc sticky = contact_desc(0.0);
  sticky.adhesion = 1.0;
  sticky.normal = MPM_NORMAL_GRADIENT;
  ck_refused(&w, mpm_stepper_set_contact(s, 2, 3, &sticky), MPM_E_UNSUPPORTED, "use MPM_DETECT_GAP");
  world_step(&w, box_dt);
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&w, mpm_grid_map(s, 3, "mass", MPM_READ, &view));
  ck_refused(&w, mpm_stepper_set_body(s, w.set[0], 1), MPM_E_STATE, "views of nodal fields");
  ck_ok(&w, mpm_view_release(&view));
  ck_ok(&w, mpm_stepper_set_body(s, w.set[0], 1));
  ck_refused(&w, mpm_grid_map(s, 1, "mass", MPM_READ, &view), MPM_E_STATE, "no nodal fields");
  ck_ok(&w, mpm_step_begin(s, box_dt));
  ck_refused(&w, mpm_stepper_set_body(s, w.set[0], 2), MPM_E_STATE, "under way");
  ck_refused(&w, mpm_stepper_set_contact(s, 2, 3, &good), MPM_E_STATE, "under way");
  ck_refused(&w, mpm_stepper_set_friction(s, NULL, NULL), MPM_E_STATE, "under way");
  ck_ok(&w, mpm_step_abort(s));
  world_close(&w);
}
END_TEST

/* What implicit steps do not offer, whichever call comes last. */
START_TEST(implicit_bodies) {
  world w;
  open_boxes(&w, &(boxes){.dim = 2, .method = methods[1], .contact = contact_desc(0.0)});
  mpm_stepper_desc implicit = stepper_desc();
  implicit.scheme = MPM_NEWMARK;
  mpm_contact_desc none = contact_desc(0.0), pulls = contact_desc(0.0);
  none.kind = MPM_CONTACT_NONE;
  pulls.adhesion = 1.0;
  const char *text = "has adhesion, which MPM_NEWMARK does not offer";
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 2, 3, &pulls));
  ck_refused(&w, mpm_stepper_configure(w.stepper, &implicit), MPM_E_UNSUPPORTED, text);
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 2, 3, NULL));
  ck_ok(&w, mpm_stepper_set_friction(w.stepper, give_friction, NULL));
  ck_refused(&w, mpm_stepper_configure(w.stepper, &implicit), MPM_E_UNSUPPORTED, "no friction callback");
  ck_ok(&w, mpm_stepper_set_friction(w.stepper, NULL, NULL));
  ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  ck_refused(&w, mpm_stepper_set_friction(w.stepper, give_friction, NULL), MPM_E_UNSUPPORTED,
             "no friction callback");
  ck_refused(&w, mpm_stepper_set_contact(w.stepper, 2, 3, &pulls), MPM_E_UNSUPPORTED, text);
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 1, 3, &pulls)); /* there is no body 1 yet */
  ck_refused(&w, mpm_stepper_set_body(w.stepper, w.set[1], 1), MPM_E_UNSUPPORTED, text);
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 3, &pulls));
  ck_ok(&w, mpm_stepper_remove(w.stepper, w.set[1]));
  ck_refused(&w, mpm_stepper_add(w.stepper, w.set[1]), MPM_E_UNSUPPORTED, text);
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 3, &none));
  ck_ok(&w, mpm_stepper_add(w.stepper, w.set[1]));
  ck_ok(&w, mpm_step(w.stepper, box_dt, NULL));
  /* multigrid knows one body alone */
  implicit.linear_solver = MPM_SOLVER_MULTIGRID_CG;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  ck_refused(&w, mpm_stepper_set_body(w.stepper, w.set[1], 2), MPM_E_UNSUPPORTED, "is for one body");
  implicit.linear_solver = MPM_SOLVER_AUTO;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  ck_ok(&w, mpm_stepper_set_body(w.stepper, w.set[1], 2));
  ck_ok(&w, mpm_step(w.stepper, box_dt, NULL));
  implicit.linear_solver = MPM_SOLVER_MULTIGRID_CG;
  ck_refused(&w, mpm_stepper_configure(w.stepper, &implicit), MPM_E_UNSUPPORTED, "is for one body");
  world_close(&w);
}
END_TEST

/* All solvers of a symmetric system, and of one that sliding makes unsymmetric, find the same step. */
START_TEST(implicit_solvers) {
  static const int32_t solver[] = {MPM_SOLVER_LDLT, MPM_SOLVER_CG, MPM_SOLVER_GMRES, MPM_SOLVER_AUTO};
  for (int32_t slides = 0; slides < 2; ++slides) {
    world w[4];
    for (int32_t i = 2 * slides; i < 4; ++i) {
      open_boxes(&w[i], &(boxes){.dim = _i, .method = methods[1], .contact = contact_desc(0.3 * slides)});
      mpm_stepper_desc implicit = stepper_desc();
      implicit.scheme = MPM_NEWMARK;
      implicit.linear_solver = solver[i];
      ck_ok(&w[i], mpm_stepper_configure(w[i].stepper, &implicit));
      for (int32_t step = 0; step < 5; ++step) world_step(&w[i], 4.0 * box_dt);
      ck_assert_double_gt(fabs(contact_of(&w[i], 2, 3).impulse[0]), 0.0);
      if (i > 2 * slides) world_agree("solvers", &w[i], &w[2 * slides], "velocity", _i, 1e-7);
    }
    for (int32_t i = 2 * slides; i < 4; ++i) world_close(&w[i]);
  }
}
END_TEST

/* A step in which bodies slide by more than half a cell is cut, and mpm_advance gets through. */
START_TEST(implicit_slip) {
  world w;
  open_boxes(&w, &(boxes){.dim = 2, .method = methods[1], .contact = contact_desc(0.0)});
  mpm_stepper_desc implicit = stepper_desc();
  implicit.scheme = MPM_NEWMARK;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  const double v[2] = {0.1 * box_speed, 10.0 * box_speed};
  ck_ok(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, 2, v));
  const uint64_t was = world_hash(&w);
  ck_refused(&w, mpm_step(w.stepper, 0.6 * spacing / v[1], &w.info), MPM_CUT_DT, "more than half a cell");
  ck_assert_int_ge(w.info.node, 0);
  ck_assert_uint_eq(world_hash(&w), was);
  mpm_advance_desc advance;
  ck_ok(&w, mpm_advance_desc_init(&advance, sizeof advance));
  advance.t_end = advance.dt_first = 0.6 * spacing / v[1];
  ck_ok(&w, mpm_advance(w.stepper, &advance, NULL));
  world_close(&w);
}
END_TEST

/* ---- memory -------------------------------------------------------------------------------------------- */
/* Every allocation of steps in contact fails once; the state stays, and the next try succeeds. */
START_TEST(memory_runs_out) {
  world w, same;
  const boxes of = {.dim = 2, .flags = THIRD, .method = methods[1], .contact = contact_desc(0.3)};
  open_boxes(&same, &of);
  open_boxes(&w, &of);
  mpm_stepper_desc implicit = stepper_desc();
  implicit.scheme = MPM_NEWMARK;
  if (_i) ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  if (_i) ck_ok(&same, mpm_stepper_configure(same.stepper, &implicit));
  int64_t failures = 0;
  for (int32_t step = 0; step < 6; ++step) {
    world_step(&same, box_dt);
    for (int64_t at = 1;; ++at) {
      const uint64_t was = world_hash(&w);
      w.memory.fail_at = w.memory.calls + at;
      const mpm_status status = mpm_step(w.stepper, box_dt, &w.info);
      w.memory.fail_at = 0;
      if (!status) break;
      ck_assert_int_eq(status, MPM_E_NOMEM);
      ck_assert_uint_eq(world_hash(&w), was);
      ++failures;
    }
  }
  ck_assert_int_gt(failures, 10);
  ck_assert_uint_eq(world_hash(&w), world_hash(&same));
  world_close(&w);
  world_close(&same);
}
END_TEST

Suite *contact_suite(void);
Suite *contact_suite(void) {
  Suite *suite = suite_create("contact");
  TCase *law = tcase_create("law"), *options = tcase_create("options"), *bits = tcase_create("bits"),
        *reports = tcase_create("reports");
  tcase_add_loop_test(law, momentum_and_energy, 0, BROAD);
  tcase_add_loop_test(options, energy_of_nodes, 1, 4);
  tcase_add_loop_test(options, steps_in_parts, 0, BROAD);
  tcase_add_loop_test(options, work_of_a_tool, 0, METHODS);
  tcase_add_loop_test(law, clouds_have_the_mass_of_nodes, 0, BROAD);
  tcase_add_loop_test(law, options_of_contact, 1, 4);
  tcase_add_loop_test(options, tied_is_one, 1, 4);
  tcase_add_loop_test(options, adhesion, 1, 4);
  tcase_add_loop_test(options, unequal_spacings, 2, 4);
  tcase_add_loop_test(options, half_on_a_wall, 0, METHODS);
  tcase_add_loop_test(options, friction_callback, 0, METHODS);
  tcase_add_loop_test(bits, threads_and_order, 0, BROAD);
  tcase_add_loop_test(bits, saved_in_contact, 0, BROAD);
  tcase_add_loop_test(bits, name_of_a_body, 0, METHODS);
  tcase_add_loop_test(reports, nodal_fields, 1, 4);
  tcase_add_test(reports, views_of_bodies);
  tcase_add_test(reports, sums_start_anew);
  tcase_add_test(reports, closest_rule);
  tcase_add_test(reports, refusals);
  tcase_add_test(reports, implicit_bodies);
  tcase_add_loop_test(reports, implicit_solvers, 1, 4);
  tcase_add_test(reports, implicit_slip);
  tcase_add_loop_test(reports, memory_runs_out, 0, 2);
  tcase_set_tags(law, "long");
  tcase_set_timeout(law, 60);
  tcase_set_timeout(options, 60);
  tcase_set_timeout(bits, 60);
  suite_add_tcase(suite, law);
  suite_add_tcase(suite, options);
  suite_add_tcase(suite, bits);
  suite_add_tcase(suite, reports);
  return suite;
}
