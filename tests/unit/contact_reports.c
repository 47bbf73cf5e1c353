/* What contact of bodies shows: nodal fields, views, sums, which rule holds, and what it refuses. */
#include "boxes.h"

static double *body_nodes(world *w, int32_t body, const char *field, int64_t *n) {
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(w, mpm_grid_map(w->stepper, body, field, MPM_READ, &view));
  double *copy = calloc((size_t)(view.count * view.components + 1), sizeof *copy);
  for (int64_t i = 0; i < view.count * view.components; ++i) copy[i] = ((const double *)view.data)[i];
  *n = view.count;
  ck_ok(w, mpm_view_release(&view));
  return copy;
}

/* Nodal forces of contact add up to the report; force, reaction and contact_force to mass times acceleration,
 * in implicit steps over all nodes that move as one: their ties share contact by mass. */
START_TEST(nodal_fields) {
  for (int32_t kind = 0; kind < 4; ++kind) {
    const int32_t implicit = kind / 2;
    method how = methods[1];
    if (implicit) how.scheme = MPM_NEWMARK;
    world w;
    open_boxes(
        &w, &(boxes){.dim = _i, .flags = kind % 2 ? ROUND : 0, .method = how, .contact = contact_desc(0.3)});
    /* in implicit steps light nodes bounce: to the third step in which they touch */
    for (int32_t touched = 0, step = 0; touched < (implicit ? 3 : 10); ++step) {
      ck_assert_int_lt(step, 40);
      world_step(&w, box_dt);
      touched += !implicit || contact_of(&w, 2, 3).touching;
    }
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
      for (int32_t c = 0; c < _i; ++c) {
        double left = 0.0;
        for (int64_t i = c * n; i < (c + 1) * n; ++i)
          left += all[i] + reaction[i] + force[i] - mass[i % n] * a[i];
        ck_within("balance of all", left, 0.0, 1e-9 * scale);
        ck_within("sum", sum_of(n, force + c * n), info.force[c], 1e-12 * scale);
      }
      for (int64_t i = 0; i < n; ++i) {
        double squared = 0.0;
        for (int32_t c = 0; c < _i; ++c) {
          const double sum = all[c * n + i] + reaction[c * n + i] + force[c * n + i];
          if (!implicit)
            ck_within("balance", sum, mass[i] * a[c * n + i], 1e-11 * (scale + fabs(all[c * n + i])));
          squared += normal[c * n + i] * normal[c * n + i];
        }
        ck_holds(isinf(gap[i]) || fabs(squared - 1.0) < 1e-12);
        ck_holds(area[i] >= 0.0);
        met += squared > 0.5;
      }
      ck_assert_int_ge(met, info.nodes);
      if (implicit) {
        double *of = fetch(&w, w.set[m], "acceleration", _i), *own = fetch(&w, w.set[m], "mass", 1);
        const int64_t count = mpm_particles_count(w.set[m]);
        for (int32_t c = 0; c < _i; ++c) {
          for (int64_t i = 0; i < count; ++i) of[c * count + i] *= own[i];
          ck_within("accelerations", sum_of(count, of + c * count), info.force[c], 1e-9 * scale);
        }
        free(of), free(own);
      }
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

/* ---- what is logged ----------------------------------------------------------------------------------- */
typedef struct heard {
  int32_t overlaps, large;
  char text[200];
} heard;

static void hear(void *user, int32_t level, const char *text) {
  heard *to = user;
  const int32_t overlap = strstr(text, "overlap") != NULL,
                large = strstr(text, "more than 0.6 of the edge") != NULL;
  to->overlaps += overlap && level == MPM_LOG_WARNING;
  to->large += large && level == MPM_LOG_INFO;
  if (overlap || large) snprintf(to->text, sizeof to->text, "%s", text);
}

/* Bodies that overlap by more than half a cell are told once, and again when they have parted meanwhile;
 * particles with more than 0.6 of a cell's edge are counted. An overlap of less is noise. */
START_TEST(overlaps_are_told) {
  static const double overlap[3] = {0.75, 0.3, 0.75};
  const double h = 0.25, lower[2] = {3.0 * h, 3.0 * h}, upper[2] = {6.0 * h, 6.0 * h};
  heard told = {.overlaps = 0};
  world w;
  world_desc desc = world_with(&methods[1], 2, 14, h);
  desc.context.log = hear;
  desc.context.log_user = &told;
  desc.sets = 1;
  world_open(&w, &desc);
  double shift[2] = {0.0};
  for (int32_t m = 0; m < 2; ++m) {
    mpm_particles *set = m ? world_add_set(&w, NULL) : w.set[0];
    world_fill(&w, set, lower, upper, _i < 2 ? 2 : 1);
    ck_ok(&w, mpm_stepper_set_body(w.stepper, set, m));
  }
  shift[0] = (3.0 - overlap[_i]) * h;
  const int64_t n = mpm_particles_count(w.set[1]);
  double *x = fetch(&w, w.set[1], "position", 2);
  for (int32_t step = 0; step < 8; ++step) {
    /* in the fourth and fifth step they are apart */
    const double by = step == 0 ? shift[0] : step == 3 ? 4.0 * h : step == 5 ? -4.0 * h : 0.0;
    for (int64_t p = 0; p < n; ++p) x[p] += by;
    put(&w, w.set[1], "position", 2, x);
    world_step(&w, 1e-4);
  }
  free(x);
  ck_assert_int_eq(told.overlaps, _i == 1 ? 0 : 2);
  ck_assert_int_eq(told.large > 0, _i == 2);
  if (_i == 2) ck_assert_msg(strstr(told.text, "overlap") || strstr(told.text, "18 of 18"), "%s", told.text);
  world_close(&w);
}
END_TEST

/* Where both bodies are all around a node, or lie alike, there is no normal but rounding: such nodes are left
 * out, whatever looks for it. */
START_TEST(at_one_place) {
  static const int32_t normals[3] = {MPM_NORMAL_LOGISTIC, MPM_NORMAL_DISCRIMINANT, MPM_NORMAL_GRADIENT};
  world w;
  boxes of = {.dim = 2, .method = methods[1], .contact = contact_desc(0.3)};
  of.contact.normal = normals[_i];
  open_boxes(&w, &of);
  double *x = fetch(&w, w.set[0], "position", 2);
  for (int64_t p = 0; p < 2 * mpm_particles_count(w.set[0]); ++p) x[p] *= 1.0 + 1e-14;
  put(&w, w.set[1], "position", 2, x);
  free(x);
  world_step(&w, box_dt);
  const mpm_contact_info info = contact_of(&w, 2, 3);
  ck_assert_int_gt(info.nodes, 20);
  ck_assert_int_eq(info.ambiguous, info.nodes);
  ck_assert_int_eq(info.closed, 0);
  ck_assert_double_eq(info.normal_force, 0.0);
  world_close(&w);
}
END_TEST

void add_contact_reports(Suite *suite) {
  TCase *reports = tcase_create("reports");
  tcase_add_loop_test(reports, nodal_fields, 1, 4);
  tcase_add_test(reports, views_of_bodies);
  tcase_add_test(reports, sums_start_anew);
  tcase_add_test(reports, closest_rule);
  tcase_add_test(reports, refusals);
  tcase_add_loop_test(reports, overlaps_are_told, 0, 3);
  tcase_add_loop_test(reports, at_one_place, 0, 3);
  suite_add_tcase(suite, reports);
}
