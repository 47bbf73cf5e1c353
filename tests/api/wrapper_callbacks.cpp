// The C++ wrapper: functions of the host, and exceptions that they throw through the library.
#include "wrapper.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <set>
#include <stdexcept>
#include <thread>

namespace {

void forces() {
  world w;
  const double rate = 3.0;
  int calls = 0;
  w.stepper.set_acceleration([&](const mpm_particle_batch &b, double *add) {
    CHECK(b.particles == w.set.handle());
    ++calls;
    for (int64_t i = 0; i < b.n; ++i) add[i] += rate;
  });
  w.stepper.set_force([](const mpm_particle_batch &b, double *add) {
    for (int64_t i = 0; i < b.n; ++i) add[b.ld + i] += 2.0 * b.mass[i];
    return MPM_OK;
  });
  mpm::step_info info;
  CHECK(w.stepper.step(1e-3, info) && calls > 0);
  CHECK(std::abs(info.momentum[0] - 500.0 * 3e-3) < 1e-12 &&
        std::abs(info.momentum[1] - 500.0 * 2e-3) < 1e-12);
  w.stepper.set_acceleration(nullptr);
  w.stepper.set_force(nullptr);
  const int before = calls;
  CHECK(w.stepper.step(1e-3, info) && calls == before && std::abs(info.momentum[0] - 500.0 * 3e-3) < 1e-12);

  // A wish for a smaller dt is returned, with the status in the info; a refusal is thrown.
  w.stepper.set_force([](const mpm_particle_batch &, double *) -> mpm_status { return 17; });
  const mpm::outcome cut = w.stepper.step(1e-3, info);
  CHECK(cut.status() == MPM_CUT_DT && cut.retryable() && info.callback_status == 17 &&
        !cut.message().empty());
  w.stepper.set_force([](const mpm_particle_batch &, double *) -> mpm_status { return -17; });
  CHECK(refused(MPM_E_CALLBACK, "-17", [&] { (void)w.stepper.step(1e-3, info); }) &&
        info.callback_status == -17);
}

void boundary_and_progress() {
  world w;
  w.stepper.set_velocity_bc([](const mpm_node_batch &b, uint8_t *prescribed, double *velocity) {
    for (int64_t i = 0; i < b.n; ++i) prescribed[i] = 1, velocity[i] = 0.5;
  });
  int seen = 0;
  w.stepper.set_progress([&](const mpm_step_info &now) {
    ++seen;
    return mpm_status(now.step > 2);
  });
  mpm::step_info info;
  CHECK(w.stepper.step(1e-3, info) && std::abs(info.momentum[0] - 250.0) < 1e-9);
  const mpm::outcome stopped = w.stepper.advance(mpm::advance_desc(1.0), info);
  CHECK(stopped.status() == MPM_CANCELLED && !stopped.retryable() && info.step == 2 && seen == 3);
  w.stepper.set_progress([](const mpm_step_info &) { throw std::logic_error("seen enough"); });
  const auto e = thrown_by<std::logic_error>([&] { (void)w.stepper.advance(mpm::advance_desc(1.0)); });
  CHECK(e && std::string(e->what()) == "seen enough");
}

void hooks() {
  world w;
  std::string order;
  bool all = true;
  for (const int32_t stage : {MPM_AFTER_VELOCITY, MPM_AFTER_P2G, MPM_AFTER_FORCES})
    all = offered([&] {
            w.stepper.set_node_hook(stage,
                                    [&order, stage](const mpm_node_batch &b, double *velocity, double *) {
                                      order += std::to_string(stage);
                                      if (stage != MPM_AFTER_VELOCITY) return;
                                      for (int64_t i = 0; i < b.n; ++i) velocity[i] += 2.0;
                                    });
          }) &&
          all;
  const auto e = thrown_by<mpm::error>(
      [&] { w.stepper.set_node_hook(9, [](const mpm_node_batch &, double *, double *) {}); });
  CHECK(e && (e->status() == MPM_E_ARG || e->status() == MPM_E_UNSUPPORTED));
  if (!all) return;
  mpm::step_info info;
  CHECK(w.stepper.step(1e-3, info) && order.front() == '1' && order.back() == '3');
  CHECK(std::abs(info.momentum[0] - 1000.0) < 1e-9);
  w.stepper.set_node_hook(MPM_AFTER_P2G, [](const mpm_node_batch &, double *, double *) { throw 7; });
  CHECK(thrown_by<int>([&] { (void)w.stepper.step(1e-3); }) == 7);
}

void motion() {
  world w;
  if (!offered([&] { w.set.set_all("prescribed", std::array<uint8_t, 2>{1, 1}); })) return;
  const double speed = 0.5;
  const auto move = [&](const mpm_particle_batch &b, double *add) {
    for (int64_t i = 0; i < b.n; ++i) add[i] += speed;
  };
  w.stepper.set_motion(w.set, move);
  mpm::step_info info;
  CHECK(w.stepper.step(1e-3, info) && std::abs(info.momentum[0] - 250.0) < 1e-9);
  CHECK(std::abs(w.stepper.particles_reaction(w.set)[0] * 1e-3) < 1e-9); /* on no other material */
  w.stepper.set_motion(w.set, [](const mpm_particle_batch &, double *) { throw 8; });
  CHECK(thrown_by<int>([&] { (void)w.stepper.step(1e-3); }) == 8);
  w.stepper.set_motion(w.set, nullptr);
  CHECK(w.stepper.step(1e-3));
}

/* Conjugate gradients of the host, for implicit steps. */
void linear_solver() {
  world w;
  int calls = 0;
  const auto solve = [&](const mpm::linear_system &system, int64_t &iterations) {
    const mpm::csr_matrix matrix = system.csr();
    const auto n = static_cast<std::size_t>(system.info().rows);
    CHECK(matrix.row_start.size() == n + 1 && matrix.column.size() == matrix.value.size());
    CHECK(system.number().size() == n && system.number()[n - 1] == system.info().all_rows - 1);
    CHECK(system.info().owned_rows == system.info().rows && system.info().first_row == 0);
    std::vector<double> r(system.rhs().begin(), system.rhs().end()), q(n);
    const mpm::span<double> x = system.solution();
    const auto dot = [n](const auto &a, const auto &b) {
      double sum = 0.0;
      for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
      return sum;
    };
    system.apply(x, q);
    for (std::size_t i = 0; i < n; ++i) r[i] -= q[i];
    std::vector<double> p = r;
    double rr = dot(r, r);
    const double goal = 1e-24 * dot(system.rhs(), system.rhs());
    for (iterations = 0; rr > goal && iterations < 10 * static_cast<int64_t>(n); ++iterations) {
      system.apply(p, q);
      const double alpha = rr / dot(p, q), old = rr;
      for (std::size_t i = 0; i < n; ++i) x[i] += alpha * p[i], r[i] -= alpha * q[i];
      rr = dot(r, r);
      for (std::size_t i = 0; i < n; ++i) p[i] = r[i] + rr / old * p[i];
    }
    ++calls;
    return rr > goal ? MPM_CUT_DT : MPM_OK;
  };
  mpm::stepper_desc implicit;
  implicit.scheme = MPM_NEWMARK;
  implicit.linear_solver = MPM_SOLVER_HOST;
  implicit.gravity[1] = -10.0;
  if (!offered([&] { w.stepper.set_linear_solver(solve); }) ||
      !offered([&] { w.stepper.configure(implicit); }))
    return;
  mpm::step_info info;
  CHECK(w.stepper.step(1e-3, info) && calls > 0 && calls == info.newton_iterations);
  CHECK(std::abs(info.momentum[1] + 500.0 * 10.0 * 1e-3) < 1e-6);
  CHECK(static_cast<int>(w.stepper.residuals().size()) == calls + 1);
  w.stepper.set_linear_solver([](const mpm::linear_system &, int64_t &) { throw 9; });
  CHECK(thrown_by<int>([&] { (void)w.stepper.step(1e-3); }) == 9);
}

mpm::law spring(double stiffness) {
  mpm::law law;
  law.density = 500.0;
  law.state_count = 1;
  law.state_initial = {4.0};
  law.stress = [stiffness](const mpm_material_batch &b) {
    for (int64_t i = 0; i < b.n; ++i) {
      for (int c = 0; c < 6; ++c) b.stress_new[c * b.ld + i] = 0.0;
      b.stress_new[i] = stiffness * std::log(b.F[i]);
      b.state_new[i] = b.state[i] + b.dt;
      b.wave_speed[i] = std::sqrt(stiffness / 500.0);
    }
  };
  return law;
}

void laws() {
  auto gone = std::make_shared<int>(1);
  const std::weak_ptr<int> watch = gone;
  {
    const mpm::context context;
    const mpm::grid grid(context, box(2));
    mpm::law law = spring(1e5);
    law.tangent = [gone](const mpm_material_batch &, double *, bool &symmetric) { symmetric = true; };
    gone.reset();
    std::optional<mpm::particles> set;
    set.emplace(grid, mpm::material(context, std::move(law)));
    set->fill_box({1.0, 1.0}, {2.0, 2.0}, {2, 2});
    set->set_all("deformation_gradient", {1.1, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
    CHECK(std::abs(set->get("stress")[7] - 1e5 * std::log(1.1)) < 1e-6 && set->get("state")[7] == 4.0);
    mpm::stepper stepper(grid);
    stepper.add(*set);
    CHECK(std::abs(stepper.stable_dt() - 0.25 / std::sqrt(200.0)) < 1e-12);
    CHECK(stepper.step(1e-3) && set->get("state")[7] == 4.0 + 1e-3);
    CHECK(!watch.expired());
  }
  CHECK(watch.expired()); // the functions go with the material
}

void fields_in_callbacks() {
  world w;
  w.set.add_field<double>("heat", 2);
  w.set.set_all("heat", {1.0, 7.0});
  w.stepper.set_acceleration([](const mpm_particle_batch &b, double *add) {
    const auto heat = mpm::batch_field<double>(b.lookup, "heat");
    for (int64_t i = 0; i < b.n; ++i) add[i] += heat(i, 1);
  });
  mpm::step_info info;
  CHECK(w.stepper.step(1e-3, info) && std::abs(info.momentum[0] - 500.0 * 7e-3) < 1e-12);
  w.stepper.set_acceleration(
      [](const mpm_particle_batch &b, double *) { mpm::batch_field<double>(b.lookup, "cold"); });
  CHECK(refused(MPM_E_NOT_FOUND, "\"cold\"", [&] { (void)w.stepper.step(1e-3); }));
}

/* Of all the exceptions thrown at once, the one that comes out is that of the first failure: that which one
 * thread finds, also where it is thrown last. */
std::string exception_on_threads(int32_t concurrency, const std::string &late) {
  mpm::context_desc services;
  services.concurrency = concurrency;
  const mpm::context context(services);
  mpm::grid_desc wide = box(2); // of several blocks: a task for each thread
  wide.cells[0] = 64;
  const mpm::grid grid(context, wide);
  std::atomic<bool> armed{false};
  mpm::law law = spring(1e5);
  law.stress = [&, inner = law.stress](const mpm_material_batch &b) {
    int64_t least = -1;
    for (int64_t i = 0; i < b.n; ++i)
      if (b.id[i] >= 0 && (least < 0 || b.id[i] < least)) least = b.id[i];
    if (!armed || b.dt == 0.0) return inner(b);
    const std::string text = "batch of " + std::to_string(least);
    if (text == late) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    throw std::runtime_error(text);
  };
  mpm::particles set(grid, mpm::material(context, law));
  set.fill_box({0.5, 0.5}, {15.5, 3.5}, {2, 2});
  mpm::stepper stepper(grid);
  stepper.add(set);
  CHECK(stepper.step(1e-5));
  const uint64_t before = stepper.hash();
  armed = true;
  std::set<std::string> reported;
  for (int k = 0; k < 20; ++k) {
    const auto e = thrown_by<std::runtime_error>([&] { (void)stepper.step(1e-5); });
    CHECK(e);
    if (e) reported.insert(e->what());
    const auto parted = thrown_by<std::runtime_error>([&] {
      mpm::staged_step step = stepper.begin(1e-5);
      CHECK(step.begun() && step.update_grid());
      (void)step.end();
    });
    CHECK(parted);
    if (parted) reported.insert(parted->what());
  }
  CHECK(reported.size() == 1);
  CHECK(stepper.hash() == before);
  armed = false;
  CHECK(stepper.step(1e-5)); // nothing of it is left
  return reported.empty() ? "" : *reported.begin();
}

void exceptions() {
  struct own {
    int value;
  };
  world w;
  const uint64_t before = w.stepper.hash();
  w.stepper.set_force([](const mpm_particle_batch &, double *) { throw own{42}; });
  const auto e = thrown_by<own>([&] { (void)w.stepper.step(1e-3); });
  CHECK(e && e->value == 42 && w.stepper.hash() == before);
  CHECK(thrown_by<own>([&] { (void)w.stepper.advance(mpm::advance_desc(1.0)); }));
  CHECK(thrown_by<own>([&] { w.stepper.begin(1e-3); }));
  w.stepper.set_force(nullptr);
  w.stepper.set_velocity_bc([](const mpm_node_batch &, uint8_t *, double *) { throw own{43}; });
  const auto f = thrown_by<own>([&] { (void)w.stepper.step(1e-3); });
  CHECK(f && f->value == 43);
  // A part that throws has dropped the step.
  mpm::staged_step dropped = w.stepper.begin(1e-3);
  CHECK(thrown_by<own>([&] { (void)dropped.update_grid(); }));
  CHECK(refused(MPM_E_STATE, "over", [&] { (void)dropped.update_grid(); }));
  w.stepper.set_velocity_bc(nullptr);
  CHECK(w.stepper.step(1e-3));

  // A law is asked by calls that are not steps, too.
  mpm::law law = spring(1e5);
  bool armed = false;
  law.stress = [&, inner = law.stress](const mpm_material_batch &b) {
    if (armed) throw own{44};
    return inner(b);
  };
  mpm::particles set(w.grid, mpm::material(w.context, law));
  set.fill_box({3.0, 3.0}, {3.5, 3.5}, {2, 2});
  w.stepper.add(set);
  set.set_all("deformation_gradient", {1.1, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  armed = true;
  const auto refuses = [](auto call) {
    const auto e = thrown_by<own>(call);
    return e && e->value == 44;
  };
  CHECK(refuses([&] { set.get("stress"); }));
  CHECK(refuses([&] { set.map<const double>("stress"); }));
  CHECK(refuses([&] { w.stepper.stable_dt(); }));
  CHECK(refuses([&] { w.stepper.info(); }));
  CHECK(refuses([&] { w.stepper.save(); }));
  armed = false;
  CHECK(set.get("stress")[0] > 0.0);

  // So are functions that take an output.
  const auto full = [](mpm::span<const unsigned char>) { throw own{44}; };
  CHECK(refuses([&] { set.write_to(full); }));
  CHECK(refuses([&] { w.stepper.save_to(full); }));
  CHECK(w.stepper.step(1e-5));
  CHECK(refuses([&] { w.stepper.write_grid_to(0, full); }));
}

void executor() {
  int64_t tasks = 0;
  bool broken = false;
  mpm::context_desc services;
  services.concurrency = 2;
  services.on_parallel_for = [&](int64_t count, const std::function<void(int64_t)> &task) {
    if (broken) throw std::domain_error("no threads");
    std::thread odd([&] {
      for (int64_t k = 1; k < count; k += 2) task(k);
    });
    for (int64_t k = 0; k < count; k += 2) task(k);
    odd.join();
    tasks += count;
  };
  world one, two(mpm::stepper_desc(), services);
  one.set.set_all("velocity", {1.0, 2.0}), two.set.set_all("velocity", {1.0, 2.0});
  CHECK(one.stepper.step(1e-3) && two.stepper.step(1e-3) && tasks > 0);
  CHECK(one.stepper.hash() == two.stepper.hash());
  broken = true;
  const auto e = thrown_by<std::domain_error>([&] { (void)two.stepper.step(1e-3); });
  CHECK(e && std::string(e->what()) == "no threads" && one.stepper.hash() == two.stepper.hash());
}

} // namespace

void test_callbacks() {
  forces();
  boundary_and_progress();
  hooks();
  motion();
  linear_solver();
  laws();
  fields_in_callbacks();
  exceptions();
  const std::string first = exception_on_threads(1, "");
  CHECK(exception_on_threads(3, first) == first);
  executor();
}
