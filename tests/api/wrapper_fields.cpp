// The C++ wrapper: particles, their fields as copies and views, files and saved states.
#include "wrapper.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

namespace {

void adding_and_removing() {
  const mpm::context context;
  const mpm::grid grid(context, box(2));
  const mpm::material rubber(context, "neo_hookean", {{"E", 1e5}, {"nu", 0.25}, {"density", 500.0}});
  mpm::particles set(grid, rubber);
  const std::vector<double> x{1.0, 2.0, 3.0, 1.5, 1.5, 1.5}, v{1, 2, 3, 4, 5, 6}, volume{0.01, 0.02, 0.03};
  mpm::new_particles three;
  three.position = x;
  three.volume = volume;
  CHECK(set.add(three) == 0);
  three.velocity = v;
  three.size = v;
  const std::array<int64_t, 3> ids{30, 10, 20};
  three.ids = ids;
  CHECK(set.add(three) == 30 && set.count() == 6);
  CHECK(set.get("velocity", ids) == v && set.get("size", ids) == v);
  CHECK((set.get("mass") == std::vector<double>{5.0, 10.0, 15.0, 10.0, 15.0, 5.0}));
  CHECK((set.get<int64_t>("id") == std::vector<int64_t>{0, 1, 2, 10, 20, 30}));
  three.velocity = volume;
  CHECK(refused(MPM_E_ARG, "velocity has 3 values, must have 6", [&] { set.add(three); }));
  set.remove({1, 20});
  CHECK(set.count() == 4);
  set.remove({});
  CHECK(refused(MPM_E_NOT_FOUND, "20", [&] { set.remove({0, 20}); }) && set.count() == 4);

  mpm::particles filled(grid, rubber);
  const mpm::id_range square = filled.fill_box({1.0, 1.0}, {2.0, 2.0}, {2, 2});
  CHECK(square.first == 0 && square.count == 64);
  const mpm::id_range ball = filled.fill_ball({3.0, 3.0}, 0.5, {2, 2});
  CHECK(ball.first == 64 && ball.count > 40 && ball.count < 60);
  const double slope = 1.0;
  const mpm::id_range half = filled.fill({1.0, 1.0}, {2.0, 2.0}, {1, 1},
                                         [&](const double *p) { return p[0] - p[1] > 1e-9 * slope; });
  CHECK(half.count == 6 && filled.count() == 64 + ball.count + 6);
  mpm::particles enclosed(grid, rubber);
  const mpm::id_range triangle =
      enclosed.fill_mesh({1.0, 2.0, 1.0, 1.01, 1.0, 2.01}, std::vector<int64_t>{0, 1, 1, 2, 2, 0}, {2, 2});
  CHECK(triangle.first == 0 && triangle.count > 24 && triangle.count < 40);
  CHECK(refused(MPM_E_ARG, "corner has 3 values, must have 2", [&] {
    enclosed.fill_mesh({1.0, 2.0, 1.0, 1.0, 1.0, 2.0}, std::vector<int64_t>{0, 1, 1}, {2, 2});
  }));
  CHECK(refused(MPM_E_ARG, "elements is 0", [&] { enclosed.fill_mesh({1.0, 2.0}, {}, {2, 2}); }));
  CHECK(refused(MPM_E_ARG, "upper has 3 values, must have 2", [&] {
    filled.fill_box({1.0, 1.0}, {2.0, 2.0, 2.0}, {2, 2});
  }));
  CHECK(refused(MPM_E_ARG, "per_cell has 1", [&] { filled.fill_ball({1.0, 1.0}, 2.0, {2}); }));
  const int64_t before = filled.count();
  const auto odd = thrown_by<std::string>([&] {
    filled.fill({1.0, 1.0}, {2.0, 2.0}, {1, 1}, [](const double *) -> bool { throw std::string("odd"); });
  });
  CHECK(odd && *odd == "odd" && filled.count() == before);
}

void copies(world &w) {
  bool stress_is_read_only = false;
  for (const mpm::field_info &f : w.set.fields())
    if (f.name == "stress") stress_is_read_only = f.type == MPM_F64 && f.components == 6 && !f.writable;
  CHECK(stress_is_read_only);
  w.set.set_all("velocity", {1.0, -2.0});
  const std::vector<double> v = w.set.get("velocity");
  CHECK(v.size() == 128 && v[0] == 1.0 && v[63] == 1.0 && v[64] == -2.0 && v[127] == -2.0);
  w.set.set("velocity", {3, 5}, {0.5, 0.25, 0.125, 0.0625});
  CHECK((w.set.get("velocity", {5, 3}) == std::vector<double>{0.25, 0.5, 0.0625, 0.125}));
  w.set.set("velocity", v);
  CHECK(w.set.get("velocity") == v);
  CHECK(w.set.get("velocity", mpm::span<const int64_t>()).empty());
  w.set.set("velocity", {}, std::vector<double>());
  CHECK(w.set.get("velocity") == v);
  CHECK(w.set.get("state").empty());

  w.set.add_field<int64_t>("grain");
  w.set.add_field<uint8_t>("colour", 3);
  w.set.set_all("colour", std::array<uint8_t, 3>{1, 2, 3});
  CHECK(w.set.get<uint8_t>("colour")[64] == 2);
  w.set.set("grain", {7}, std::vector<int64_t>{9});
  CHECK(w.set.get<int64_t>("grain")[7] == 9 && w.set.get<int64_t>("grain")[8] == 0);

  const std::vector<float> packed = w.set.get_f32({"velocity", "colour"});
  CHECK(packed.size() == 5 * 64 && packed[0] == 1.0f && packed[1] == -2.0f && packed[4] == 3.0f);
  CHECK(packed[15] == 1.0f && packed[16] == -2.0f && packed[17] == 1.0f);
  std::array<float, 64> ids{};
  w.set.get_f32({"id"}, ids, MPM_LIBRARY_ORDER);
  std::sort(ids.begin(), ids.end());
  CHECK(ids[0] == 0.0f && ids[63] == 63.0f);
  CHECK(w.set.get_f32({"state"}).empty());
  CHECK(refused(MPM_E_ARG, "out has 64 values, must have 128", [&] { w.set.get_f32({"velocity"}, ids); }));
  CHECK(refused(MPM_E_NOT_FOUND, "velocity", [&] { w.set.get_f32({"velocty"}); }));
  CHECK(refused(MPM_E_NOT_FOUND, "velocity", [&] { w.set.get_f32({"id", "velocty"}, ids); }));
  CHECK(refused(MPM_E_ARG, "order is 0", [&] { w.set.get_f32({"velocity"}, 0); }));

  const std::vector<unsigned char> all = w.set.pack();
  std::vector<unsigned char> some = w.set.pack({3, 1});
  CHECK(refused(MPM_E_ARG, "id 1 is in use", [&] { w.set.unpack(some); }));
  w.set.remove({1, 3});
  w.set.unpack(some);
  CHECK(w.set.count() == 64 && w.set.pack() == all);
  some.back() ^= 1;
  CHECK(refused(MPM_E_FORMAT, "damaged", [&] { w.set.unpack(some); }));
  CHECK(refused(MPM_E_NOT_FOUND, "id 99", [&] { w.set.pack({99}); }));

  CHECK(refused(MPM_E_ARG, "count is 0", [&] { w.set.get_f32({}); }));

  CHECK(refused(MPM_E_NOT_FOUND, "velocity", [&] { w.set.get("velocty"); }));
  CHECK(refused(MPM_E_NOT_FOUND, "velocity", [&] { w.set.set("velocty", v); }));
  CHECK(refused(MPM_E_ARG, "grain", [&] { w.set.get("grain"); }));
  CHECK(refused(MPM_E_ARG, "velocity has 2 values, must have 128", [&] {
    w.set.set("velocity", std::vector<double>{1.0, 2.0});
  }));
  CHECK(refused(MPM_E_ARG, "velocity has 2 values, must have 4", [&] {
    w.set.set("velocity", {3, 5}, {1.0, 2.0});
  }));
  CHECK(refused(MPM_E_ARG, "", [&] { w.set.set_all("velocity", {1.0}); }));
  CHECK(refused(MPM_E_UNSUPPORTED, "stress", [&] {
    w.set.set_all("stress", {1.0, 1.0, 1.0, 0.0, 0.0, 0.0});
  }));
  CHECK(refused(MPM_E_NOT_FOUND, "7777", [&] { w.set.get("mass", {7777}); }));
  CHECK(refused(MPM_E_ARG, "K0", [&] { w.set.set_geostatic(1, -10.0, 100.0, -1.0); }));
  CHECK(refused(MPM_E_UNSUPPORTED, "neo_hookean", [&] { w.set.reset_reference(); }));
  CHECK(w.set.get("velocity") == v);
}

void views(world &w) {
  {
    const auto id = w.set.map<const int64_t>("id");
    const auto x = w.set.map<const double>("position");
    auto v = w.set.map<double>("velocity");
    CHECK(v.components() == 2 && v.size() >= 64 && v.raw().access == (MPM_READ | MPM_WRITE));
    CHECK(x.raw().access == MPM_READ);
    for (int64_t i = 0; i < v.size(); ++i)
      if (id(i) >= 0) v(i, 0) = 10.0 * x(i, 0), v(i, 1) = -x(i, 1);
    CHECK(refused(MPM_E_STATE, "view", [&] { (void)w.stepper.step(1e-5); }));
    auto moved = std::move(v);
    moved.release();
    CHECK(refused(MPM_E_STATE, "released", [&] { moved.release(); }));
    CHECK(refused(MPM_E_STATE, "released", [&] { v.release(); }));
  }
  const auto x = w.set.get("position"), v = w.set.get("velocity");
  CHECK(v[5] == 10.0 * x[5] && v[69] == -x[69]);
  CHECK(w.stepper.step(1e-5)); // all views are back
  CHECK(refused(MPM_E_ARG, "\"id\" holds int64_t, not double", [&] { w.set.map<const double>("id"); }));
  CHECK(refused(MPM_E_UNSUPPORTED, "stress", [&] { w.set.map<double>("stress"); }));
  CHECK(refused(MPM_E_NOT_FOUND, "position", [&] { w.set.map<const double>("positon"); }));
  CHECK(w.stepper.step(1e-5));

  // Bad values: release() says so; a destructor does not throw, and the next step says so.
  {
    auto m = w.set.map<double>("mass");
    const double good = m(0);
    m(0) = std::nan("");
    CHECK(refused(MPM_E_ARG, "mass", [&] { m.release(); }));
    {
      auto again = w.set.map<double>("mass");
      again(0) = -1.0;
    }
    CHECK(refused(MPM_E_STATE, "mass", [&] { (void)w.stepper.step(1e-5); }));
    w.set.map<double>("mass")(0) = good;
    CHECK(w.stepper.step(1e-5));
  }
  const auto mass = w.stepper.map<const double>("mass");
  double sum = 0.0;
  for (int64_t i = 0; i < mass.size(); ++i) sum += mass(i);
  CHECK(mass.components() == 1 && std::abs(sum - 500.0) < 1e-9);
  CHECK(w.stepper.map<const int64_t>("index").components() == 2);
  const auto owned = w.stepper.map<const uint8_t>("owned");
  for (int64_t i = 0; i < owned.size(); ++i) CHECK(owned(i) == 1);
  CHECK(refused(MPM_E_NOT_FOUND, "body", [&] { w.stepper.map<const double>("mass", 1); }));
}

// What dies in a callback, where the library takes nothing back, is given back after the call.
void given_up_in_callbacks() {
  world w;
  w.stepper.set_force([](const mpm_particle_batch &, double *) {});
  CHECK(w.stepper.step(1e-5)); // memory for what callbacks are shown stays
  const int64_t before = w.context.memory().bytes;
  {
    auto other = std::make_unique<mpm::particles>(w.grid, w.rubber);
    other->fill_box({3.0, 3.0}, {4.0, 4.0}, {2, 2});
    auto view = std::make_unique<mpm::view<double>>(other->map<double>("velocity"));
    bool refuses = false;
    w.stepper.set_force([&](const mpm_particle_batch &, double *) {
      if (view) refuses = refused(MPM_E_STATE, "", [&] { view->release(); });
      view.reset();
    });
    CHECK(w.stepper.step(1e-5) && refuses && !view);
    other->remove({other->get<int64_t>("id")[0]}); // which a lent view would bar

    view = std::make_unique<mpm::view<double>>(other->map<double>("velocity"));
    auto small = std::make_unique<mpm::grid>(w.context, box(2));
    w.stepper.set_force(
        [&](const mpm_particle_batch &, double *) { small.reset(), other.reset(), view.reset(); });
    CHECK(w.stepper.step(1e-5) && !other);
  }
  w.stepper.set_force(nullptr);
  CHECK(w.context.memory().bytes == before);
}

std::string text_of(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void files(world &w, const std::string &scratch) {
  const uint64_t before = w.stepper.hash();
  const std::vector<unsigned char> state = w.stepper.save();
  w.stepper.save_file(scratch + "/wrapper.state");
  CHECK(w.stepper.step(1e-5) && w.stepper.hash() != before);
  const uint64_t after = w.stepper.hash();
  w.stepper.load(state);
  CHECK(w.stepper.hash() == before && w.stepper.step(1e-5) && w.stepper.hash() == after);
  w.stepper.load_file(scratch + "/wrapper.state");
  CHECK(w.stepper.hash() == before);
  CHECK(refused(MPM_E_FORMAT, "", [&] { w.stepper.load({}); }));
  CHECK(w.stepper.step(1e-5) && w.stepper.hash() == after);
  w.stepper.load_pieces({state});
  CHECK(w.stepper.hash() == before);
  CHECK(refused(MPM_E_ARG, "no part", [&] { w.stepper.load_pieces({}); }));
  CHECK(refused(MPM_E_FORMAT, "piece[1]", [&] { w.stepper.load_pieces({state, {}}); }));
  CHECK(refused(MPM_E_IO, "nowhere", [&] { w.stepper.load_file(scratch + "/nowhere"); }));

  CHECK(refused(MPM_E_STATE, "nodal", [&] { w.stepper.write_grid(scratch + "/wrapper.vti"); }));
  CHECK(w.stepper.step(1e-5));
  w.stepper.write_grid(scratch + "/wrapper.vti", {"velocity"});
  const std::string vti = text_of(scratch + "/wrapper.vti");
  CHECK(vti.find("\"velocity\"") != std::string::npos && vti.find("\"force\"") == std::string::npos);

  std::string taken;
  const auto take = [&](mpm::span<const unsigned char> bytes) { taken.append(bytes.begin(), bytes.end()); };
  w.stepper.write_grid_to(0, take, {"velocity"});
  CHECK(taken == vti);
  taken.clear();
  w.stepper.save_to(take);
  const std::vector<unsigned char> saved = w.stepper.save();
  CHECK(taken == std::string(saved.begin(), saved.end()));
  taken.clear();
  w.set.write_file(scratch + "/wrapper.vtp");
  w.set.write_to(take);
  CHECK(taken == text_of(scratch + "/wrapper.vtp"));
  taken.clear();
  w.set.write_to(take, {"grain"});
  CHECK(taken.find("\"grain\"") != std::string::npos && taken.find("\"stress\"") == std::string::npos);
  CHECK(refused(MPM_E_ARG, "write is NULL", [&] { w.set.write_to(nullptr); }));
  CHECK(refused(MPM_E_ARG, "write is NULL", [&] { w.stepper.save_to(nullptr); }));
  CHECK(refused(MPM_E_NOT_FOUND, "velocity", [&] { w.set.write_to(take, {"velocty"}); }));
  CHECK(refused(MPM_E_NOT_FOUND, "body is 1", [&] { w.stepper.write_grid_to(1, take); }));
  CHECK(refused(MPM_E_CALLBACK, "returned -5 after 0 bytes",
                [&] { w.stepper.save_to([](mpm::span<const unsigned char>) { return mpm_status{-5}; }); }));

  mpm::series series(w.context, scratch + "/wrapper.pvd");
  w.set.write_file(scratch + "/wrapper.vtp", {"velocity", "grain"});
  series.append(0.5, "wrapper.vtp");
  CHECK(text_of(scratch + "/wrapper.pvd").find("timestep=\"0.5\"") != std::string::npos);
  const std::string vtp = text_of(scratch + "/wrapper.vtp");
  CHECK(vtp.find("\"grain\"") != std::string::npos && vtp.find("\"stress\"") == std::string::npos);
  w.set.write_file(scratch + "/wrapper.vtp");
  CHECK(text_of(scratch + "/wrapper.vtp").find("\"stress\"") != std::string::npos);
  CHECK(refused(MPM_E_NOT_FOUND, "velocity", [&] { w.set.write_file(scratch + "/x.vtp", {"velocty"}); }));
  CHECK(refused(MPM_E_IO, "", [&] { mpm::series none(w.context, scratch + "/no/such/folder.pvd"); }));
}

} // namespace

void test_fields(const std::string &scratch) {
  adding_and_removing();
  world w;
  copies(w);
  views(w);
  given_up_in_callbacks();
  files(w, scratch);
}
