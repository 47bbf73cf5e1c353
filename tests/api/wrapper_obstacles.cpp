// The C++ wrapper: obstacles that are fixed, move, or are pushed about; their functions, reports and lives.
#include "wrapper.h"

#include <cmath>
#include <memory>

namespace {

/* The block of a world, which moves down at 1 onto something. */
struct falling : world {
  explicit falling(mpm::context_desc services = {}) : world(mpm::stepper_desc(), std::move(services)) {
    set.set_all("velocity", {0.0, -1.0});
  }
};

mpm::obstacle_desc plane(double height) {
  mpm::obstacle_desc desc(MPM_SHAPE_PLANE);
  desc.position[1] = height;
  return desc;
}

mpm::obstacle_desc ball(double mass) {
  mpm::obstacle_desc desc(MPM_SHAPE_SPHERE);
  desc.motion = MPM_MOTION_FREE;
  desc.size[0] = 0.5;
  desc.position[0] = 1.5, desc.position[1] = 0.52;
  desc.mass = mass;
  desc.inertia[8] = 0.125 * mass;
  return desc;
}

void fixed() {
  falling w;
  mpm::obstacle_desc desc = plane(1.0);
  CHECK(desc.struct_size == sizeof(mpm_obstacle_desc) && desc.orientation[0] == 1.0 && !desc.contact);
  mpm::contact_desc rough;
  rough.friction = 0.5;
  desc.contact = &rough;
  mpm::obstacle floor(w.context, desc);
  CHECK(refused(MPM_E_STATE, "in no stepper", [&] { floor.contact(); }));
  CHECK(refused(MPM_E_NOT_FOUND, "not in this stepper", [&] { w.stepper.remove(floor); }));
  w.stepper.add(floor);
  CHECK(refused(MPM_E_STATE, "belongs to this stepper", [&] { w.stepper.add(floor); }));
  CHECK(refused(MPM_E_STATE, "no step", [&] { floor.contact(); }));
  mpm::step_info info;
  CHECK(w.stepper.step(1e-4, info));
  const mpm::contact_info touch = floor.contact(), of_body = floor.contact(0);
  CHECK(touch.touching == 1 && touch.force[1] > 0.0 && of_body.force[1] == touch.force[1]);
  CHECK(std::abs(touch.impulse[1] - 500.0 - info.momentum[1]) < 1e-9); // of the block, 500 before
  CHECK(floor.contact(1).touching == 0 && std::isinf(floor.contact(1).gap));
  CHECK(refused(MPM_E_ARG, "body is 5000", [&] { floor.contact(5000); }));

  CHECK(refused(MPM_E_UNSUPPORTED, "MPM_MOTION_PRESCRIBED", [&] {
    floor.set_pose({}, {}, {1.0, 0.0, 0.0});
  }));
  CHECK(refused(MPM_E_UNSUPPORTED, "load", [&] { floor.set_load({1.0, 0.0, 0.0}); }));
  CHECK(refused(MPM_E_ARG, "position has 2 values, must have 3", [&] { floor.set_pose({0.0, 1.0}); }));
  CHECK(refused(MPM_E_ARG, "unit quaternion", [&] { floor.set_pose({}, {1.0, 1.0, 0.0, 0.0}); }));
  rough.friction = -1.0;
  CHECK(refused(MPM_E_ARG, "friction", [&] { floor.set_contact(rough); }));
  CHECK(refused(MPM_E_ARG, "friction", [&] { mpm::obstacle bad(w.context, desc); }));
  CHECK(refused(MPM_E_ARG, "shape", [&] { mpm::obstacle bad(w.context, mpm::obstacle_desc()); }));
  rough.friction = 0.0;
  rough.kind = MPM_CONTACT_NONE;
  floor.set_contact(rough);
  CHECK(w.stepper.step(1e-4) && floor.contact().touching == 0);
  floor.reset_contact();
  CHECK(w.stepper.step(1e-4) && floor.contact().touching == 1);
  w.stepper.remove(floor);
  CHECK(refused(MPM_E_STATE, "in no stepper", [&] { floor.contact(); }));
  CHECK(w.stepper.step(1e-4));
}

void prescribed() {
  world w;
  mpm::obstacle_desc desc = plane(1.0);
  desc.motion = MPM_MOTION_PRESCRIBED;
  mpm::obstacle press(w.context, desc);
  w.stepper.add(press);
  press.set_pose({}, {}, {0.0, 2.0, 0.0});
  CHECK(w.stepper.step(1e-4) && press.contact().force[1] > 0.0);
  CHECK(std::abs(press.pose().position[1] - 1.0002) < 1e-12 && press.pose().velocity[1] == 2.0);
  CHECK(press.pose().orientation[0] == 1.0 && press.pose().angular_velocity[2] == 0.0);
  // The function is kept, with what it holds.
  const auto calls = std::make_shared<int>(0);
  press.set_motion([calls](double t, double dt, double *velocity, double *angular_velocity) {
    ++*calls;
    velocity[1] = 3.0 * (t + 0.5 * dt);
    angular_velocity[2] = 0.0;
  });
  CHECK(calls.use_count() == 2);
  const double before = press.pose().position[1], middle = w.stepper.info().t + 0.5e-4;
  CHECK(w.stepper.step(1e-4) && *calls == 1 && press.pose().velocity[1] == 3.0 * middle);
  CHECK(std::abs(press.pose().position[1] - before - 3.0 * middle * 1e-4) < 1e-15);
  // What it throws comes out of the step, and nothing has moved.
  press.set_motion([](double, double, double *, double *) { throw 7; });
  CHECK(calls.use_count() == 1);
  const uint64_t hash = w.stepper.hash();
  const double there = press.pose().position[1];
  CHECK(thrown_by<int>([&] { (void)w.stepper.step(1e-4); }) == 7);
  CHECK(w.stepper.hash() == hash && press.pose().position[1] == there);
  press.set_motion([](double, double, double *, double *) -> mpm_status { return MPM_CUT_DT; });
  CHECK(w.stepper.step(1e-4).status() == MPM_CUT_DT);
  press.set_motion([](double, double, double *, double *angular_velocity) { angular_velocity[0] = 1.0; });
  CHECK(refused(MPM_E_CALLBACK, "out of the grid's axes", [&] { (void)w.stepper.step(1e-4); }));
  press.set_motion(nullptr);
  CHECK(w.stepper.step(1e-4) && press.pose().velocity[1] == 3.0 * middle);
  mpm::obstacle floor(w.context, plane(0.5));
  CHECK(refused(MPM_E_UNSUPPORTED, "MPM_MOTION_PRESCRIBED",
                [&] { floor.set_motion([](double, double, double *, double *) {}); }));
}

void free_ones() {
  falling w;
  mpm::obstacle light(w.context, ball(10.0));
  w.stepper.add(light);
  mpm::step_info info;
  double given = 0.0;
  for (int k = 0; k < 20; ++k) {
    CHECK(w.stepper.step(1e-4, info));
    given += light.contact().force[1] * 1e-4;
  }
  const mpm::pose pushed = light.pose();
  CHECK(pushed.velocity[1] < 0.0 && pushed.position[1] < 0.52 && pushed.position[2] == 0.0);
  CHECK(std::abs(10.0 * pushed.velocity[1] + given) < 1e-9); // momentum of the ball
  // The ball has the energy that the material has lost to it, whatever was given and taken back in sweeps.
  const double energy =
      5.0 * (pushed.velocity[0] * pushed.velocity[0] + pushed.velocity[1] * pushed.velocity[1]) +
      0.625 * pushed.angular_velocity[2] * pushed.angular_velocity[2];
  CHECK(energy > 0.0 && std::abs(info.external_work_total + energy) < 1e-12 * energy);
  w.stepper.remove(light);
  // Alone it moves by its load.
  light.set_pose({0.5, 3.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  light.set_load({20.0, 0.0, 0.0}, {0.0, 0.0, 2.5});
  light.set_load({}, {0.0, 0.0, 5.0});
  w.stepper.add(light);
  CHECK(w.stepper.step(1e-4));
  CHECK(std::abs(light.pose().velocity[0] - 2e-4) < 1e-15 &&
        std::abs(light.pose().angular_velocity[2] - 4e-4) < 1e-15);
  CHECK(refused(MPM_E_ARG, "torque has 1 values", [&] { light.set_load({}, {1.0}); }));
  CHECK(refused(MPM_E_ARG, "force[0]", [&] { light.set_load({std::nan(""), 0.0, 0.0}); }));
  CHECK(refused(MPM_E_ARG, "mass", [&] { mpm::obstacle bad(w.context, ball(-1.0)); }));
  // A saved state has the pose and the load.
  const auto state = w.stepper.save();
  const mpm::pose saved = light.pose();
  CHECK(w.stepper.step(1e-4));
  const uint64_t after = w.stepper.hash();
  light.set_load({0.0, 0.0, 0.0});
  w.stepper.load(state);
  CHECK(light.pose().position == saved.position && light.pose().velocity == saved.velocity);
  CHECK(w.stepper.step(1e-4) && w.stepper.hash() == after);
}

/* A floor of the host's own shape, which says that it is a plane. */
mpm::obstacle_desc own_floor(std::shared_ptr<int> calls) {
  mpm::obstacle_desc desc(MPM_SHAPE_DISTANCE);
  desc.position[1] = 1.0;
  desc.on_distance = [calls](const mpm_distance_batch &b) {
    ++*calls;
    for (int64_t i = 0; i < b.n; ++i) {
      b.distance[i] = b.position[b.ld + i];
      b.normal[i] = 0.0, b.normal[b.ld + i] = 1.0;
    }
  };
  return desc;
}

void distances() {
  falling exact, asked;
  mpm::obstacle floor(exact.context, plane(1.0));
  const auto calls = std::make_shared<int>(0);
  auto own = std::make_unique<mpm::obstacle>(asked.context, own_floor(calls));
  CHECK(calls.use_count() == 2);
  exact.stepper.add(floor), asked.stepper.add(*own);
  CHECK(exact.stepper.step(1e-4) && asked.stepper.step(1e-4) && *calls > 0);
  CHECK(own->contact().force[1] == floor.contact().force[1]);
  CHECK(exact.set.get("velocity") == asked.set.get("velocity"));
  own.reset(); // the stepper keeps the obstacle, and that its function
  CHECK(calls.use_count() == 2 && asked.stepper.step(1e-4));

  falling w;
  mpm::obstacle_desc desc(MPM_SHAPE_DISTANCE);
  CHECK(refused(MPM_E_ARG, "distance is NULL", [&] { mpm::obstacle bad(w.context, desc); }));
  desc.position[1] = 1.0;
  desc.on_distance = [](const mpm_distance_batch &) { throw 9; };
  mpm::obstacle throwing(w.context, desc);
  w.stepper.add(throwing);
  CHECK(thrown_by<int>([&] { (void)w.stepper.step(1e-4); }) == 9);
  w.stepper.remove(throwing);
  desc.on_distance = [](const mpm_distance_batch &b) {
    for (int64_t i = 0; i < b.n; ++i) b.distance[i] = b.normal[i] = b.normal[b.ld + i] = 0.0;
  };
  mpm::obstacle flat(w.context, desc);
  w.stepper.add(flat);
  CHECK(refused(MPM_E_CALLBACK, "length 1", [&] { (void)w.stepper.step(1e-4); }));
}

void lives() {
  int64_t blocks = 0;
  mpm::context_desc counted;
  counted.on_alloc = [&blocks](std::size_t bytes, std::size_t alignment) {
    ++blocks;
    return ::operator new(bytes, std::align_val_t(alignment));
  };
  counted.on_release = [&blocks](void *memory, std::size_t, std::size_t alignment) {
    --blocks;
    ::operator delete(memory, std::align_val_t(alignment));
  };
  const auto calls = std::make_shared<int>(0);
  {
    auto w = std::make_unique<falling>(counted);
    mpm::obstacle floor(w->context, own_floor(calls));
    w->stepper.add(floor);
    w.reset(); // the obstacle keeps its context, and is free again
    CHECK(blocks > 0 && floor.pose().position[1] == 1.0);
    CHECK(refused(MPM_E_STATE, "in no stepper", [&] { floor.contact(); }));
    mpm::obstacle moved = std::move(floor);
    CHECK(!floor && refused(MPM_E_ARG, "moved from", [&] { floor.pose(); }));
    CHECK(moved && moved.handle());
  }
  CHECK(blocks == 0 && calls.use_count() == 1);
  {
    falling w(counted);
    auto floor = std::make_unique<mpm::obstacle>(w.context, own_floor(calls));
    w.stepper.add(*floor);
    mpm::obstacle gone = std::move(*floor);
    CHECK(refused(MPM_E_ARG, "NULL", [&] { w.stepper.add(*floor); }));
    w.stepper.remove(gone);
    w.stepper.add(gone);
  }
  CHECK(blocks == 0 && calls.use_count() == 1);
  {
    const mpm::context elsewhere;
    falling w;
    mpm::obstacle foreign(elsewhere, plane(1.0));
    CHECK(refused(MPM_E_ARG, "another context", [&] { w.stepper.add(foreign); }));
    mpm::obstacle_desc desc(MPM_SHAPE_CAPSULE);
    desc.size[0] = desc.size[1] = 1.0;
    mpm::obstacle capsule(w.context, desc);
    CHECK(refused(MPM_E_UNSUPPORTED, "2-D grid", [&] { w.stepper.add(capsule); }));
  }
}

} // namespace

void test_obstacles() {
  fixed();
  prescribed();
  free_ones();
  distances();
  lives();
}
