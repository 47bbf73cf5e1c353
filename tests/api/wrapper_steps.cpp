// The C++ wrapper: steps, what they return and throw, steps in parts, and what the stepper reports.
#include "wrapper.h"

#include <cmath>

namespace {

void outcomes() {
  world w;
  mpm::step_info info;
  const double dt = w.stepper.stable_dt();
  CHECK(dt > 0.0 && w.stepper.step(0.4 * dt, info));
  CHECK(info.cause == MPM_OK && info.step == 1 && info.t == 0.4 * dt && w.stepper.info().t == info.t);
  CHECK(refused(MPM_E_ARG, "dt", [&] { (void)w.stepper.step(-1.0); }));

  // Off the grid: an event, not an error; the state is as it was.
  w.set.set_all("velocity", {1e4, 0.0});
  const uint64_t before = w.stepper.hash();
  const mpm::outcome off = w.stepper.step(1.0, info);
  CHECK(!off && off.status() == MPM_OFF_GRID && !off.retryable() && info.cause == MPM_OFF_GRID);
  CHECK(off.message().find("particle " + std::to_string(info.particle)) != std::string::npos);
  CHECK(w.stepper.hash() == before);

  world still;
  mpm::advance_desc go(0.01);
  go.cfl = 0.4;
  go.max_steps = 1;
  CHECK(still.stepper.advance(go, info) && info.step == 1 && info.t < 0.01);
  CHECK(still.stepper.advance(mpm::advance_desc(0.01)) && still.stepper.info().t == 0.01);
  CHECK(refused(MPM_E_ARG, "t_end", [&] { (void)still.stepper.advance(mpm::advance_desc(0.0)); }));
  still.stepper.set_time(2.0, 7);
  CHECK(still.stepper.info().t == 2.0 && still.stepper.info().step == 7);
  CHECK(refused(MPM_E_ARG, "step", [&] { still.stepper.set_time(2.0, -1); }));
}

void descriptors() {
  mpm::stepper_desc desc;
  CHECK(desc.scheme == MPM_USL && desc.flip == 1.0 && desc.struct_size == sizeof(mpm_stepper_desc));
  world w;
  desc.scheme = MPM_MUSL;
  desc.gravity[1] = -10.0;
  w.stepper.configure(desc);
  mpm::step_info info;
  CHECK(w.stepper.step(1e-4, info) && std::abs(info.momentum[1] + 500.0 * 10.0 * 1e-4) < 1e-12);
  desc.flip = 7.0;
  CHECK(refused(MPM_E_ARG, "flip", [&] { w.stepper.configure(desc); }));
  CHECK(refused(MPM_E_ARG, "flip", [&] { mpm::stepper wrong(w.grid, desc); }));
  CHECK(w.stepper.profile().total > 0.0 && w.stepper.profile(true).total > 0.0 &&
        w.stepper.profile().total == 0.0);
}

void walls() {
  mpm::stepper_desc desc;
  desc.gravity[1] = -10.0;
  const mpm::context context;
  const mpm::grid grid(context, box(2));
  const mpm::material rubber(context, "neo_hookean", {{"E", 1e5}, {"nu", 0.25}, {"density", 500.0}});
  mpm::particles set(grid, rubber);
  set.fill_box({1.0, 0.0}, {2.0, 1.0}, {2, 2});
  mpm::stepper stepper(grid, desc);
  stepper.add(set);
  CHECK(refused(MPM_E_STATE, "stepper", [&] { stepper.add(set); }));
  stepper.set_wall(MPM_Y_MIN, MPM_WALL_SLIP);
  CHECK(refused(MPM_E_ARG, "face", [&] { stepper.set_wall(MPM_Z_MIN, MPM_WALL_SLIP); }));
  mpm::step_info info;
  CHECK(stepper.step(1e-4, info));
  const auto force = stepper.wall_reaction(MPM_Y_MIN);
  // The momentum that gravity gives and the floor leaves.
  CHECK(force[1] > 0.0 && force[2] == 0.0 && std::abs((force[1] - 5000.0) * 1e-4 - info.momentum[1]) < 1e-9);
  CHECK(refused(MPM_E_ARG, "face", [&] { stepper.wall_reaction(9); }));
  CHECK(stepper.step(1e-4, info));
  const auto impulse = stepper.wall_impulse(MPM_Y_MIN);
  CHECK(impulse[1] > force[1] * 1e-4 && std::abs(impulse[1] - 5000.0 * info.t - info.momentum[1]) < 1e-9);
  CHECK(refused(MPM_E_ARG, "face", [&] { stepper.wall_impulse(9); }));
  mpm::particles platen(grid, rubber);
  platen.fill_box({1.0, 0.5}, {2.0, 1.0}, {2, 2});
  platen.set_all("prescribed", std::array<uint8_t, 2>{1, 1});
  platen.set_all("velocity", std::array<double, 2>{0.0, -1.0});
  stepper.add(platen);
  CHECK(stepper.step(1e-4, info));
  double pushed[2] = {0.0, 0.0};
  CHECK(mpm_stepper_particles_impulse(stepper.handle(), platen.handle(), pushed) == MPM_OK &&
        pushed[1] < 0.0);
  CHECK(stepper.particles_impulse(platen)[1] == pushed[1] && stepper.particles_impulse(platen)[2] == 0.0);
  CHECK(stepper.particles_impulse(set)[1] == 0.0);
}

void bodies() {
  const mpm::context context;
  const mpm::grid grid(context, box(2));
  const mpm::material rubber(context, "neo_hookean", {{"E", 1e5}, {"nu", 0.25}, {"density", 500.0}});
  mpm::particles left(grid, rubber), right(grid, rubber);
  left.fill_box({1.0, 1.0}, {2.0, 2.0}, {2, 2});
  right.fill_box({2.0, 1.0}, {3.0, 2.0}, {2, 2});
  left.set_all("velocity", {1.0, 0.0});
  mpm::stepper stepper(grid);
  stepper.add(left), stepper.add(right);
  stepper.set_body(right, 1);
  CHECK(stepper.body(left) == 0 && stepper.body(right) == 1);
  CHECK(refused(MPM_E_ARG, "body", [&] { stepper.set_body(left, -1); }));
  mpm::contact_desc desc;
  CHECK(desc.kind == MPM_CONTACT_UNILATERAL && desc.struct_size == sizeof(mpm_contact_desc));
  desc.friction = 0.2;
  stepper.set_contact(0, 1, desc);
  int asked = 0;
  stepper.set_friction([&](const mpm_contact_batch &b, double *friction) {
    ++asked;
    for (int64_t i = 0; i < b.n; ++i) friction[i] = 0.4;
  });
  CHECK(refused(MPM_E_STATE, "step", [&] { stepper.contact(0, 1); }));
  CHECK(stepper.step(1e-4) && asked > 0);
  const mpm::contact_info touch = stepper.contact(0, 1);
  CHECK(touch.touching == 1 && touch.force[0] > 0.0 && stepper.contact(1, 0).force[0] == -touch.force[0]);
  CHECK(stepper.map<const double>("contact_force", 1).size() > 0);
  stepper.set_friction([](const mpm_contact_batch &, double *) { throw 7; });
  CHECK(thrown_by<int>([&] { (void)stepper.step(1e-4); }) == 7);
  stepper.set_friction(nullptr);
  desc.friction = -1.0;
  CHECK(refused(MPM_E_ARG, "friction", [&] { stepper.set_contact(0, 1, desc); }));
  stepper.reset_contact(0, 1);
  CHECK(stepper.step(1e-4));
}

void parts() {
  world whole, staged;
  mpm::step_info info;
  whole.set.set_all("velocity", {1.0, 2.0}), staged.set.set_all("velocity", {1.0, 2.0});
  CHECK(whole.stepper.step(1e-4));
  {
    mpm::staged_step step = staged.stepper.begin(1e-4);
    CHECK(step.begun() && step.update_grid() && step.end(info));
    CHECK(info.step == 1 && staged.stepper.hash() == whole.stepper.hash());
    CHECK(refused(MPM_E_STATE, "over", [&] { (void)step.end(); }));
    CHECK(refused(MPM_E_STATE, "over", [&] { (void)step.update_grid(); }));
  }
  // Nodal velocities of a staged step are the host's to change: momentum shows it.
  {
    mpm::staged_step step = staged.stepper.begin(1e-4);
    CHECK(step.begun() && step.update_grid());
    auto v = staged.stepper.map<double>("velocity");
    for (int64_t i = 0; i < v.size(); ++i) v(i, 0) += 3.0;
    v.release();
    CHECK(step.end(info) && std::abs(info.momentum[0] - 500.0 * 4.0) < 1e-9);
  }
  // Dropped by destruction, by an exception of the host, by abort, by a part in the wrong order.
  const uint64_t before = staged.stepper.hash();
  {
    const mpm::staged_step step = staged.stepper.begin(1e-4);
    CHECK(refused(MPM_E_STATE, "under way", [&] { (void)staged.stepper.step(1e-4); }));
    CHECK(refused(MPM_E_STATE, "", [&] { staged.stepper.begin(1e-4); }));
  }
  CHECK(staged.stepper.hash() == before);
  CHECK(thrown_by<int>([&] {
          const mpm::staged_step step = staged.stepper.begin(1e-4);
          throw 5;
        }) == 5);
  mpm::staged_step step = staged.stepper.begin(1e-4);
  CHECK(refused(MPM_E_STATE, "", [&] { (void)step.end(); }));
  CHECK(step.update_grid());
  step.abort();
  step = staged.stepper.begin(1e-4);
  step = whole.stepper.begin(1e-4); // drops the other
  CHECK(staged.stepper.hash() == before && staged.stepper.step(1e-4));
  CHECK(refused(MPM_E_ARG, "dt", [&] { staged.stepper.begin(0.0); }) && staged.stepper.step(1e-4));

  // A part that fails says so, and drops the step.
  world flying;
  flying.set.set_all("velocity", {1e4, 0.0});
  mpm::staged_step far = flying.stepper.begin(1.0);
  CHECK(far.begun() && far.update_grid());
  const mpm::outcome off = far.end();
  CHECK(off.status() == MPM_OFF_GRID && !off.message().empty() && flying.stepper.info().t == 0.0);
  CHECK(flying.stepper.step(1e-7));
}

} // namespace

void test_steps() {
  outcomes();
  descriptors();
  walls();
  bodies();
  parts();
}
