// The C++ wrapper: sets that adapt.
#include "wrapper.h"

#include <string>
#include <vector>

void test_adaption() {
  world w;
  mpm::adaption_desc desc;
  CHECK(desc.struct_size == sizeof(mpm_adaption_desc) && desc.every == 10 && desc.split_edge == 0.0);
  desc.split_edge = 0.3;
  w.set.add_field<double>("heat");
  w.set.set_extensive("heat");
  w.set.set("heat", std::vector<double>(static_cast<std::size_t>(w.set.count()), 1.0));
  const int64_t n = w.set.count();
  int64_t asked = 0;
  w.stepper.set_adaption(w.set, desc, [&](const mpm_adaption_batch &b, uint8_t *accept) {
    asked += b.n;
    for (int64_t i = 0; i < b.n; ++i) accept[i] = b.id[i] == 0;
  });
  w.stepper.adapt();
  CHECK(asked == n && w.set.count() == n + 3);
  CHECK(w.set.get("heat")[0] == 0.25);
  const mpm::adaption_info info = w.stepper.adaption(w.set);
  CHECK(info.splits == 1 && info.added == 3 && info.merges == 0);
  w.stepper.set_adaption(w.set, desc, [](const mpm_adaption_batch &, uint8_t *) { throw std::string("no"); });
  CHECK(thrown_by<std::string>([&] { w.stepper.adapt(); }) == "no");
  CHECK(w.set.count() == n + 3);
  w.stepper.set_adaption(w.set, desc);
  w.stepper.adapt();
  CHECK(w.set.count() > 2 * n);
  const int64_t most = w.set.count();
  w.stepper.reset_adaption(w.set);
  w.stepper.adapt();
  CHECK(w.set.count() == most);
  desc.least_edge = 0.0;
  CHECK(refused(MPM_E_ARG, "least_edge", [&] { w.stepper.set_adaption(w.set, desc); }));
}
