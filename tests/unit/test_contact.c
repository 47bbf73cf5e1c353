/* Contact of bodies: what it keeps, what it reports, what it refuses; its numbers are verified by the cases
 * contact_... of the verification. */
#include "boxes.h"
#include "contact/contact.h"

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
  const int32_t steps = w->dim == 3 && w->desc.stepper.scheme == MPM_NEWMARK ? 15 : 60;
  for (int32_t i = 0; i < steps; ++i) {
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
      /* sliding in 3-D makes an unsymmetric system, which takes long for three bodies */
      const double friction = how->scheme == MPM_NEWMARK && flags & THIRD && dim == 3 ? 0.0 : 0.3;
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

static double mass_of_cloud(const world *w, const mpmi_cloud *cloud) {
  double mass = 0.0;
  for (int64_t e = cloud->first; e < cloud->first + cloud->count; ++e) {
    const mpmi_cloud_entry *entry = &w->stepper->nodes.contact.entry[e];
    const mpm_particles *set = w->stepper->layout.member[entry->member].set;
    mass +=
        entry->volume / mpmi_f64(set, MPMI_VOLUME, 0)[entry->slot] * mpmi_f64(set, MPMI_MASS, 0)[entry->slot];
  }
  return mass;
}

/* The mass that a cubic spline gives the node of a party and its images, by all particles of the body. */
static double mass_by_spline(const world *w, const mpmi_party *party) {
  const mpmi_layout *layout = &w->stepper->layout;
  const mpmi_cloud cloud = {.slot = party->slot};
  const mpmi_cloud_frame frame = mpmi_cloud_frame_of(&layout->blocks, &cloud);
  double mass = 0.0;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_particles *set = layout->member[m].set;
    for (int64_t p = 0; p < set->slots && layout->member[m].body == party->body; ++p) {
      if (mpmi_i64(set, MPMI_ID, 0)[p] < 0) continue;
      double x[3], weight = 1.0;
      mpmi_cloud_place(&frame, mpmi_f64(set, MPMI_POSITION, 0), set->ld, p, x);
      for (int32_t k = 0; k < frame.dim; ++k) {
        const double far = fmax(0.0, 2.0 - fabs(x[k])), near = fmax(0.0, 1.0 - fabs(x[k]));
        weight *= (far * far * far - 4.0 * near * near * near) / 6.0;
      }
      mass += weight * mpmi_f64(set, MPMI_MASS, 0)[p];
    }
  }
  return mass;
}

/* The particles of a cloud have the mass of its node, wherever the bodies lie in their blocks. GIMP and the
 * linear basis are narrower than clouds: there those of a party have what a cubic spline would give it. */
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
        const int32_t family = w.grid->family;
        const int32_t narrow = family == MPMI_FAMILY_BSPLINE1 || family == MPMI_FAMILY_GIMP;
        for (int64_t i = 0; i < contact->party_count; ++i) {
          const mpmi_party *party = &contact->party[i];
          double sum = 0.0;
          for (int64_t c = party->first_cloud; c < party->first_cloud + party->cloud_count; ++c) {
            const double mass = mass_of_cloud(&w, &contact->cloud[c]);
            const double wanted = *mpmi_mass(&w.stepper->nodes.solved, contact->cloud[c].slot);
            if (!narrow) ck_within(how->name, mass, wanted, 1e-4 * wanted); /* volumes change in the step */
            sum += mass;
            seen += contact->cloud[c].count;
          }
          const double wanted = narrow ? mass_by_spline(&w, party) : sum;
          ck_within(how->name, sum, wanted, 1e-4 * wanted);
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
  static const int32_t threads[4] = {1, 2, 5, 4};
  uint64_t hash[4];
  mpm_contact_info info[4];
  for (int32_t i = 0; i < 4; ++i) {
    world w;
    open_boxes(&w, &(boxes){.dim = 2 + _i % 2,
                            .flags = THIRD,
                            .method = *how,
                            .contact = contact_desc(friction),
                            .concurrency = threads[i],
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

Suite *contact_suite(void);
Suite *contact_suite(void) {
  Suite *suite = suite_create("contact");
  TCase *law = tcase_create("law"), *options = tcase_create("options"), *bits = tcase_create("bits");
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
  tcase_add_loop_test(law, threads_and_order, 0, BROAD);
  tcase_add_loop_test(bits, saved_in_contact, 0, BROAD);
  tcase_add_loop_test(bits, name_of_a_body, 0, METHODS);
  tcase_set_tags(law, "long");
  tcase_set_timeout(law, 60);
  tcase_set_timeout(options, 60);
  tcase_set_timeout(bits, 60);
  suite_add_tcase(suite, law);
  suite_add_tcase(suite, options);
  suite_add_tcase(suite, bits);
  add_contact_reports(suite);
  add_contact_steps(suite);
  return suite;
}
