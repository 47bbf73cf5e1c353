// The C++ wrapper: heat.
#include "wrapper.h"

#include <string>
#include <vector>

void test_heat() {
  world w;
  mpm::heat_desc desc;
  CHECK(desc.struct_size == sizeof(mpm_heat_desc) && desc.specific_heat == 0.0);
  CHECK(refused(MPM_E_ARG, "specific_heat", [&] { w.stepper.set_heat(w.set, desc); }));
  CHECK(refused(MPM_E_STATE, "mpm_stepper_set_heat", [&] { w.stepper.heat(); }));
  desc.specific_heat = 2.0;
  desc.reference_temperature = 20.0;
  int64_t asked = 0;
  w.stepper.set_heat(w.set, desc, [&](const mpm_particle_batch &b, double *power) {
    for (int64_t i = 0; i < b.n; ++i) asked += b.id[i] >= 0, power[i] = 3.0;
  });
  w.stepper.set_conduction(MPM_CONDUCTION_IMPLICIT);
  w.stepper.set_heat_wall(MPM_X_MIN, MPM_HEAT_WALL_INSULATED);
  CHECK(refused(MPM_E_ARG, "kind is 7", [&] { w.stepper.set_heat_wall(MPM_X_MIN, 7); }));
  CHECK(w.set.get("temperature")[0] == 20.0);
  const double before = w.stepper.heat().heat;
  w.stepper.step(1e-6).or_throw();
  const mpm::heat_info info = w.stepper.heat();
  CHECK(asked == w.set.count() && info.sources > 0.0 && info.heat > before);
  w.stepper.set_heat(w.set, desc, [](const mpm_particle_batch &, double *) { throw std::string("hot"); });
  CHECK(thrown_by<std::string>([&] { w.stepper.step(1e-6).or_throw(); }) == "hot");
  w.stepper.reset_heat(w.set);
  w.stepper.step(1e-6).or_throw();
}
