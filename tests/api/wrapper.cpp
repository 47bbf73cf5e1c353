// The C++ wrapper: objects in any order of destruction, fields, views, files. Its argument is a folder to
// write to.
#include "wrapper.h"

#include <cmath>
#include <cstring>
#include <memory>

int failures = 0;

namespace {

template <class T>
constexpr bool moves_only = std::is_nothrow_move_constructible_v<T> &&std::is_nothrow_move_assignable_v<T> &&
                            !std::is_copy_constructible_v<T> && !std::is_copy_assignable_v<T>;
static_assert(moves_only<mpm::context> && moves_only<mpm::grid> && moves_only<mpm::material> &&
              moves_only<mpm::particles> && moves_only<mpm::obstacle> && moves_only<mpm::surface> &&
              moves_only<mpm::stepper> && moves_only<mpm::series> && moves_only<mpm::view<double>> &&
              moves_only<mpm::staged_step>);

/* Memory of the library goes through these, so that a leak is seen. */
mpm::context_desc counted(int64_t &blocks) {
  mpm::context_desc desc;
  desc.on_alloc = [&blocks](std::size_t bytes, std::size_t alignment) {
    ++blocks;
    return ::operator new(bytes, std::align_val_t(alignment));
  };
  desc.on_release = [&blocks](void *memory, std::size_t, std::size_t alignment) {
    --blocks;
    ::operator delete(memory, std::align_val_t(alignment));
  };
  return desc;
}

void destruction_in_any_order() {
  int64_t blocks = 0;
  {
    auto w = std::make_unique<world>(mpm::stepper_desc(), counted(blocks));
    CHECK(blocks > 0);
    // Parents first: what is left still works, and frees all in the end.
    mpm::stepper stepper = std::move(w->stepper);
    w.reset();
    CHECK(stepper.step(0.1 * stepper.stable_dt()));
    auto velocity = stepper.map<const double>("velocity");
    { const mpm::stepper gone = std::move(stepper); }
    CHECK(velocity.size() > 0 && velocity(0, 0) == 0.0);
  }
  CHECK(blocks == 0);
  {
    auto w = std::make_unique<world>(mpm::stepper_desc(), counted(blocks));
    auto x = w->set.map<double>("position");
    auto stage = std::make_unique<std::optional<mpm::staged_step>>();
    x.release();
    stage->emplace(w->stepper.begin(1e-4));
    CHECK((*stage)->begun());
    w.reset(); // a step under way keeps the stepper
    CHECK(blocks > 0 && (*stage)->update_grid());
  }
  CHECK(blocks == 0);
  {
    std::optional<world> w(std::in_place, mpm::stepper_desc(), counted(blocks));
    std::optional<mpm::staged_step> step(w->stepper.begin(1e-4));
    const auto mass = w->stepper.map<const double>("mass");
    step.reset(); // cannot drop the step while the view is out
    w.reset();
    CHECK(mass.size() > 0);
  }
  CHECK(blocks == 0);
  {
    world w(mpm::stepper_desc(), counted(blocks));
    world other(mpm::stepper_desc(), counted(blocks));
    other = std::move(w); // frees what it held
    CHECK(other.set.count() == 64 && other.stepper.step(1e-4));
    CHECK(!w.set && w.set.handle() == nullptr);
    CHECK(refused(MPM_E_ARG, "moved from", [&] { w.set.count(); }));
    CHECK(refused(MPM_E_ARG, "moved from", [&] { w.stepper.stable_dt(); }));
    other.stepper.remove(other.set);
    CHECK(refused(MPM_E_NOT_FOUND, "not in this stepper", [&] { other.stepper.remove(other.set); }));
    other.stepper.add(other.set);
  }
  CHECK(blocks == 0);
}

void services() {
  mpm::context_desc bad;
  bad.concurrency = -1;
  CHECK(refused(MPM_E_ARG, "concurrency is -1", [&] { mpm::context c(bad); }));
  char place[8];
  bad.error_text = place, bad.error_bytes = sizeof place;
  CHECK(refused(MPM_E_ARG, "mpm_con", [&] { mpm::context c(bad); }));
  CHECK(place == std::string("mpm_con"));
  CHECK(mpm::status_text(MPM_E_NOMEM) == std::string("memory or threads were not to be had"));
  mpm::context_desc half;
  half.on_alloc = [](std::size_t, std::size_t) -> void * { return nullptr; };
  CHECK(refused(MPM_E_ARG, "alloc is set without release", [&] { mpm::context c(half); }));
  half.on_release = [](void *, std::size_t, std::size_t) {};
  CHECK(refused(MPM_E_NOMEM, "bytes refused", [&] { mpm::context c(half); }));
  half.on_alloc = [](std::size_t, std::size_t) -> void * { throw 1; };
  CHECK(refused(MPM_E_NOMEM, "bytes refused", [&] { mpm::context c(half); }));

  std::string text;
  mpm::context_desc told;
  told.on_log = [&](int32_t level, const char *line) {
    if (level == MPM_LOG_INFO) text += line;
    throw 1;
  };
  const mpm::context context(told);
  CHECK(text.find("instruction set") != std::string::npos);
  const mpm::memory_use use = context.memory();
  CHECK(use.bytes > 0 && use.peak_bytes >= use.bytes);
  CHECK(mpm::version() == MPM_VERSION);
  CHECK(std::strcmp(mpm::status_name(MPM_E_IO), "MPM_E_IO") == 0);
}

void grids_and_materials() {
  const mpm::context context;
  mpm::grid_desc g = box(2);
  CHECK(g.struct_size == sizeof(mpm_grid_desc) && g.basis == MPM_BSPLINE2);
  CHECK(mpm::grid(context, g).dim() == 2);
  g.cells[1] = 0;
  CHECK(refused(MPM_E_ARG, "cells", [&] { mpm::grid wrong(context, g); }));
  CHECK(refused(MPM_E_NOT_FOUND, "neo_hookean", [&] { mpm::material m(context, "neo_hooke", {}); }));
  CHECK(refused(MPM_E_ARG, "nu", [&] {
    mpm::material m(context, "neo_hookean", {{"E", 1e5}, {"nu", 0.75}, {"density", 1.0}});
  }));
  const auto models = mpm::models();
  CHECK(static_cast<int32_t>(models.size()) == mpm_material_model_count() && models.size() >= 3);
  const auto j2 = mpm::model_parameters("j2");
  CHECK(j2.size() == 5 && j2[0].name == "E" && j2[0].unit == "stress" && std::isnan(j2[0].value_default));
  CHECK(j2[1].name == "nu" && j2[1].high <= 0.5 && j2[1].high > 0.49 && !j2[1].text.empty());
  CHECK(refused(MPM_E_NOT_FOUND, "j3", [] { mpm::model_parameters("j3"); }));
  const auto state = mpm::model_state("j2");
  CHECK(state.size() == 1 && state[0].name == "plastic_strain" && !state[0].unit.empty());
  CHECK(mpm::model_state("neo_hookean").empty());
  CHECK(refused(MPM_E_NOT_FOUND, "j3", [] { mpm::model_state("j3"); }));
  const mpm::material rubber(context, "neo_hookean", {{"E", 1e5}, {"nu", 0.25}, {"density", 1.0}});
  const double F[9] = {1, 0.5, 0, 0, 1, 0, 0, 0, 1};
  double stress[6] = {};
  std::vector<double> tangent(81);
  mpm_material_batch batch{};
  batch.n = batch.ld = 1;
  batch.dt = 1.0;
  batch.F = batch.F_inc = F;
  batch.stress = batch.stress_new = stress;
  rubber.update(batch);
  CHECK(std::abs(stress[3] - 2e4) < 1e-9); /* mu times the shear */
  CHECK(rubber.update(batch, tangent) && tangent[0] > 0.0);
  tangent.pop_back();
  CHECK(refused(MPM_E_ARG, "tangent has 80 values, must have 81", [&] { rubber.update(batch, tangent); }));
  batch.state_count = 1;
  CHECK(refused(MPM_E_ARG, "state_count", [&] { rubber.update(batch); }));
  mpm::law law;
  law.density = 1.0;
  CHECK(refused(MPM_E_ARG, "stress", [&] { mpm::material m(context, law); }));
  law.stress = [](const mpm_material_batch &) {};
  law.state_count = 2;
  law.state_initial = {1.0};
  CHECK(
      refused(MPM_E_ARG, "state_initial has 1 values, must have 2", [&] { mpm::material m(context, law); }));
}

void one_status_each() {
  const mpm::error plain(MPM_E_IO, "");
  CHECK(std::string(plain.what()) == "MPM_E_IO" && plain.status() == MPM_E_IO);
  CHECK(std::string(mpm::error(MPM_E_IO, "disk").what()) == "MPM_E_IO: disk");
  const mpm::outcome done, cut(MPM_CUT_DT, "too long"), gone(MPM_OFF_GRID, "left");
  CHECK(done && !done.retryable() && done.message().empty());
  done.or_throw();
  CHECK(!cut && cut.retryable() && cut.status() == MPM_CUT_DT);
  CHECK(mpm::outcome(MPM_SINGULAR, "").retryable());
  CHECK(!gone && !gone.retryable() && gone.message() == "left");
  CHECK(refused(MPM_OFF_GRID, "left", [&] { gone.or_throw(); }));
}

} // namespace

void test_objects() {
  destruction_in_any_order();
  services();
  grids_and_materials();
  one_status_each();
}

int main(int argc, char **argv) {
  try {
    test_objects();
    test_fields(argc > 1 ? argv[1] : ".");
    test_callbacks();
    test_steps();
    test_obstacles();
    test_surfaces();
    test_adaption();
    test_heat();
  } catch (const std::exception &e) {
    std::printf("wrapper.cpp:0:E: %s\n", e.what());
    return 1;
  }
  std::puts(failures ? "failed" : "ok");
  return failures != 0;
}
