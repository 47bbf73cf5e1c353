// A host in C++ with a UMAT and a VUMAT in Fortran, by an installation of the library.
#include <cmath>
#include <cstdio>
#include <mpm/mpm.hpp>
#include <mpm/mpm_umat.hpp>

extern "C" {
mpm_umat_subroutine umat_elastic_;
mpm_vumat_subroutine vumat_neo_hookean_;
}

static double stretched(const mpm::material &material, double by) {
  double F[9] = {by, 0, 0, 0, 1, 0, 0, 0, 1}, stress[6] = {}, state[1] = {};
  mpm_material_batch b{};
  b.state_count = 1, b.n = b.ld = 1, b.dt = 1.0, b.F = b.F_inc = F;
  b.stress = b.stress_new = stress, b.state = b.state_new = state;
  material.update(b);
  return stress[0];
}

int main() {
  mpm::context context;
  mpm::umat_desc desc;
  desc.density = 2e3;
  desc.properties = {1e7, 0.25};
  desc.name = "SOIL";
  const double elastic = stretched(mpm::umat_material(context, umat_elastic_, desc), 1.01);
  desc.properties = {1e7, 0.25, 10.0};
  const double rubber = stretched(mpm::vumat_material(context, vumat_neo_hookean_, desc), 1.01);
  if (std::abs(elastic - 1.2e7 * std::log(1.01)) > 1e-6) return 1;
  if (std::abs(rubber - (4e6 * std::log(1.01) + 4e6 * (1.01 * 1.01 - 1.0)) / 1.01) > 1e-6) return 2;
  desc.nstatv = 2;
  desc.initial_state = {1.0};
  int refused = 0;
  try {
    mpm::umat_material(context, umat_elastic_, desc);
  } catch (const mpm::error &) {
    ++refused; // one state for two
  }
  desc.initial_state.clear();
  desc.density = -1.0;
  try {
    mpm::umat_material(context, umat_elastic_, desc);
  } catch (const mpm::error &e) {
    refused += e.status() == MPM_E_ARG && std::string(e.what()).find("density = -1") != std::string::npos;
  }
  try {
    context.refuse(MPM_E_UNSUPPORTED, "not today");
  } catch (const mpm::error &e) {
    refused +=
        e.status() == MPM_E_UNSUPPORTED && std::string(e.what()).find("not today") != std::string::npos;
  }
  std::printf("result: stress %10.2f, %d refusals\n", elastic, refused);
  return refused == 3 ? 0 : 3;
}
