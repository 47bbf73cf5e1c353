// The C++ wrapper: surfaces, their functions and lives.
#include "wrapper.h"

#include <cmath>
#include <memory>

namespace {

void loads_and_fields() {
  world w;
  mpm::surface_desc desc;
  CHECK(desc.struct_size == sizeof(mpm_surface_desc) && desc.max_spacing == 0.0);
  desc.pressure = 100.0;
  mpm::surface s(w.grid, desc);
  const mpm::id_range made = s.add_polyline({1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 2.0, 2.0}, true, 0.25);
  CHECK(made.first == 0 && made.count == 16 && s.count() == 16);
  CHECK(s.add({1.5, 1.5}) == 16);
  const std::vector<double> x = s.get("position"), area = s.get("area");
  CHECK(x.size() == 34 && x[16] == 1.5 && area[16] == 0.0 && area[17 + 0] == -0.25);
  CHECK(s.get<int64_t>("id")[3] == 3);
  const int64_t last = 16;
  s.remove({&last, 1});
  s.set("pressure", std::vector<double>(16, 5.0));
  CHECK(s.get("pressure")[15] == 5.0);
  CHECK(s.refine(0.13) == 16);
  CHECK(refused(MPM_E_ARG, "pressure", [&] {
    mpm::surface_desc bad;
    bad.pressure = std::nan("");
    s.configure(bad);
  }));
  CHECK(refused(MPM_E_UNSUPPORTED, "polyline", [&] { s.add_triangles({0.0, 0.0, 0.0}, {0, 0, 0}, 1.0); }));
  w.stepper.add(s);
  CHECK(refused(MPM_E_STATE, "this stepper", [&] { w.stepper.add(s); }));
  CHECK(w.stepper.step(1e-4));
  CHECK(s.get("force")[0] != s.get("force")[32]);
  w.stepper.remove(s);
}

void functions() {
  world w;
  mpm::surface s(w.grid);
  s.add({1.5, 1.5}, {0.25, 0.0});
  w.stepper.add(s);
  int calls = 0;
  s.set_traction([&](const mpm_marker_batch &b, double *add) {
    ++calls;
    for (int64_t i = 0; i < b.n; ++i) add[i] += 40.0;
  });
  CHECK(w.stepper.step(1e-4));
  CHECK(calls == 1 && std::fabs(s.get("force")[0] - 10.0) < 1e-12);
  s.set_traction([](const mpm_marker_batch &, double *) { throw std::string("no"); });
  CHECK(thrown_by<std::string>([&] { static_cast<void>(w.stepper.step(1e-4)); }) == "no");
  s.set_traction(nullptr);
  CHECK(w.stepper.step(1e-4));
}

void prescribes() {
  world w;
  mpm::surface_desc desc;
  CHECK(desc.prescribes == MPM_PRESCRIBES_NOTHING && desc.penalty == 100.0);
  desc.prescribes = MPM_PRESCRIBES_VELOCITY;
  mpm::surface s(w.grid, desc);
  s.add({1.5, 1.5}, {0.25, 0.0});
  w.stepper.add(s);
  CHECK(refused(MPM_E_STATE, "no step", [&] { static_cast<void>(w.stepper.surface_reaction(s)); }));
  s.set_velocity([&](const mpm_marker_batch &b, double *add) {
    for (int64_t i = 0; i < b.n; ++i) add[i] += 2.0;
  });
  CHECK(w.stepper.step(1e-4));
  const auto force = w.stepper.surface_reaction(s), impulse = w.stepper.surface_impulse(s);
  CHECK(force[0] != 0.0 && force[2] == 0.0 &&
        std::fabs(impulse[0] - 1e-4 * force[0]) < 1e-12 * std::fabs(force[0]));
  CHECK(s.get("reaction")[0] == force[0] && std::fabs(s.get("displacement")[0] - 2e-4) < 1e-15);
  s.set_velocity([](const mpm_marker_batch &, double *) { throw std::string("no"); });
  CHECK(thrown_by<std::string>([&] { static_cast<void>(w.stepper.step(1e-4)); }) == "no");
  s.set_velocity(nullptr);
  CHECK(w.stepper.step(1e-4));
}

/* Whatever is destroyed first, the rest lives on. */
void lives() {
  auto w = std::make_unique<world>();
  auto s = std::make_unique<mpm::surface>(w->grid);
  s->add({1.5, 1.5});
  w->stepper.add(*s);
  s.reset(); // the stepper keeps it
  CHECK(w->stepper.step(1e-4));
  mpm::surface other(w->grid);
  w->stepper.add(other);
  w.reset();
  CHECK(other.count() == 0);
}

} // namespace

void test_surfaces() {
  loads_and_fields();
  functions();
  prescribes();
  lives();
}
