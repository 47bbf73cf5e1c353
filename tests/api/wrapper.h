/* What the tests of the C++ wrapper share: a check that counts, and a small world. */
#ifndef WRAPPER_H
#define WRAPPER_H

#include <mpm/mpm.hpp>

#include <cstdio>
#include <optional>
#include <string>

extern int failures;

#define CHECK(condition)                                                                                     \
  do {                                                                                                       \
    if (!(condition)) {                                                                                      \
      std::printf("%s:%d:F: %s\n", __FILE__, __LINE__, #condition);                                          \
      ++failures;                                                                                            \
    }                                                                                                        \
  } while (0)

/* What a call throws: its exception of type E, or none. */
template <class E, class F> std::optional<E> thrown_by(F call) {
  try {
    call();
  } catch (const E &e) {
    return e;
  }
  return std::nullopt;
}

/* A call throws mpm::error with a status and a text that contains the given piece. */
template <class F> bool refused(mpm_status status, const std::string &piece, F call) {
  const auto e = thrown_by<mpm::error>(call);
  if (!e) return false;
  const bool good = e->status() == status && std::string(e->what()).find(piece) != std::string::npos;
  if (!good) std::printf("it threw: %s\n", e->what());
  return good;
}

/* False if this version of the library does not offer what the call asks for. */
template <class F> bool offered(F call) {
  const auto e = thrown_by<mpm::error>(call);
  if (e && e->status() == MPM_E_UNSUPPORTED) return false;
  CHECK(!e);
  return true;
}

inline mpm::grid_desc box(int dim) {
  mpm::grid_desc g;
  g.dim = dim;
  for (int k = 0; k < 3; ++k) g.cells[k] = 16, g.spacing[k] = 0.25;
  return g;
}

/* 64 particles of rubber, at rest in the middle of a plane. */
struct world {
  mpm::context context;
  mpm::grid grid{context, box(2)};
  mpm::material rubber{context, "neo_hookean", {{"E", 1e5}, {"nu", 0.25}, {"density", 500.0}}};
  mpm::particles set{grid, rubber};
  mpm::stepper stepper;

  explicit world(const mpm_stepper_desc &desc = mpm::stepper_desc(), mpm::context_desc services = {})
      : context(std::move(services)), stepper(grid, desc) {
    set.fill_box({1.0, 1.0}, {2.0, 2.0}, {2, 2});
    stepper.add(set);
  }
};

void test_objects();
void test_fields(const std::string &scratch);
void test_callbacks();
void test_steps();
void test_obstacles();
void test_surfaces();
void test_adaption();
void test_heat();

#endif
