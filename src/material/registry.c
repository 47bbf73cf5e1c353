/* The table of built-in laws: parameters, derived constants and kernels. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "material/laws.h"

/* Open ranges are written with their outermost members, so that low and high themselves are accepted. */
#define POSITIVE      DBL_MIN, DBL_MAX, "must be finite and > 0", 0
#define NOT_NEGATIVE  0.0, DBL_MAX, "must be finite and >= 0", 0
#define AT_LEAST_ONE  1.0, DBL_MAX, "must be finite and >= 1", 0
#define ZERO_OR_ONE   0.0, 1.0, "must be 0 or 1", 1
#define MUST_BE_GIVEN ((double)NAN)
#define PARAM_E                                                                                              \
  { "E", "stress", "Young's modulus", MUST_BE_GIVEN, POSITIVE }
#define PARAM_NU                                                                                             \
  {                                                                                                          \
    "nu", "1", "Poisson's ratio", MUST_BE_GIVEN, -1.0 + DBL_EPSILON / 2, 0.5 - DBL_EPSILON / 4,              \
        "must be > -1 and < 0.5", 0                                                                          \
  }
#define PARAM_DENSITY                                                                                        \
  { "density", "mass/length^3", "mass per initial volume", MUST_BE_GIVEN, POSITIVE }

enum { E, NU, DENSITY, YIELD_STRESS, HARDENING };

static void prepare_elastic(const double *value, double *constants) {
  double mu = value[E] / (2.0 * (1.0 + value[NU]));
  double lambda = 2.0 * mu * value[NU] / (1.0 - 2.0 * value[NU]);
  double bulk = value[E] / (3.0 * (1.0 - 2.0 * value[NU]));
  constants[MPMI_C_LAMBDA] = lambda;
  constants[MPMI_C_MU] = mu;
  constants[MPMI_C_DENSITY_INVERSE] = 1.0 / value[DENSITY];
  constants[MPMI_C_P_WAVE_SQUARED] = (bulk + 4.0 / 3.0 * mu) / value[DENSITY];
  constants[MPMI_C_MEAN_ENERGY] = 1.0 / (2.0 * bulk);
  constants[MPMI_C_SHEAR_ENERGY] = 1.0 / (4.0 * mu);
}

enum { DECOUPLED_MU, DECOUPLED_KAPPA, DECOUPLED_DENSITY };

static void prepare_decoupled(const double *value, double *constants) {
  constants[MPMI_C_BULK] = value[DECOUPLED_KAPPA];
  constants[MPMI_C_MU] = value[DECOUPLED_MU];
  constants[MPMI_C_DENSITY_INVERSE] = 1.0 / value[DECOUPLED_DENSITY];
}

enum { FLUID_DENSITY, FLUID_BULK, FLUID_GAMMA, FLUID_VISCOSITY, FLUID_TENSION };

static void prepare_fluid(const double *value, double *constants) {
  const double gamma_minus_1 = value[FLUID_GAMMA] - 1.0;
  constants[MPMI_C_BULK] = value[FLUID_BULK];
  constants[MPMI_C_BULK_BY_GAMMA] = value[FLUID_BULK] / value[FLUID_GAMMA];
  /* (J^(1 - gamma) - 1) / (gamma - 1) is -ln J to the last digit for one so small */
  constants[MPMI_C_GAMMA_MINUS_1] = gamma_minus_1 > 0.0 ? gamma_minus_1 : 1e-100;
  constants[MPMI_C_VISCOSITY] = value[FLUID_VISCOSITY];
  constants[MPMI_C_LARGEST_J_MINUS_1] = value[FLUID_TENSION] > 0.0 ? DBL_MAX : 0.0;
  constants[MPMI_C_DENSITY_INVERSE] = 1.0 / value[FLUID_DENSITY];
}

static void prepare_j2(const double *value, double *constants) {
  prepare_elastic(value, constants);
  constants[MPMI_C_YIELD] = value[YIELD_STRESS];
  constants[MPMI_C_HARDENING] = value[HARDENING];
  constants[MPMI_C_RETURN] = 1.0 / (3.0 * constants[MPMI_C_MU] + value[HARDENING]);
}

static const mpmi_law laws[MPMI_LAW_COUNT] = {
    [MPMI_LAW_NEO_HOOKEAN] = {.name = "neo_hookean",
                              .index = MPMI_LAW_NEO_HOOKEAN,
                              .stress_from_F = 1,
                              .param_count = 3,
                              .param = {PARAM_E, PARAM_NU, PARAM_DENSITY},
                              .prepare = prepare_elastic},
    [MPMI_LAW_LINEAR_ELASTIC] = {.name = "linear_elastic",
                                 .index = MPMI_LAW_LINEAR_ELASTIC,
                                 .param_count = 3,
                                 .param = {PARAM_E, PARAM_NU, PARAM_DENSITY},
                                 .prepare = prepare_elastic},
    [MPMI_LAW_J2] =
        {.name = "j2",
         .index = MPMI_LAW_J2,
         .state_count = 1,
         .param_count = 5,
         .param = {PARAM_E,
                   PARAM_NU,
                   PARAM_DENSITY,
                   {"yield_stress", "stress", "initial yield stress in tension", MUST_BE_GIVEN, POSITIVE},
                   {"hardening", "stress", "slope of the yield stress over the equivalent plastic strain",
                    0.0, NOT_NEGATIVE}},
         .prepare = prepare_j2},
    [MPMI_LAW_NEO_HOOKEAN_DECOUPLED] = {.name = "neo_hookean_decoupled",
                                        .index = MPMI_LAW_NEO_HOOKEAN_DECOUPLED,
                                        .stress_from_F = 1,
                                        .param_count = 3,
                                        .param = {{"mu", "stress", "shear modulus", MUST_BE_GIVEN, POSITIVE},
                                                  {"kappa", "stress", "bulk modulus", MUST_BE_GIVEN,
                                                   POSITIVE},
                                                  PARAM_DENSITY},
                                        .prepare = prepare_decoupled},
    [MPMI_LAW_NEWTONIAN_FLUID] =
        {.name = "newtonian_fluid",
         .index = MPMI_LAW_NEWTONIAN_FLUID,
         .stress_from_F = 1,
         .kinematics = MPMI_F_DILATES,
         .param_count = 5,
         .param = {PARAM_DENSITY,
                   {"bulk_modulus", "stress", "bulk modulus at the initial volume", MUST_BE_GIVEN, POSITIVE},
                   {"gamma", "1", "exponent of the volume: pressure = bulk_modulus / gamma (J^-gamma - 1)",
                    7.0, AT_LEAST_ONE},
                   {"viscosity", "stress*time", "dynamic viscosity", 0.0, NOT_NEGATIVE},
                   {"tension", "1", "1: pressure may be negative; 0: it is cut off at 0", 1.0, ZERO_OR_ONE}},
         .prepare = prepare_fluid},
    [MPMI_LAW_RIGID] = {.name = "rigid",
                        .index = MPMI_LAW_RIGID,
                        .stress_from_F = 1,
                        .kinematics = MPMI_F_STAYS,
                        .param_count = 1,
                        .param = {PARAM_DENSITY}},
};

#define KERNELS(kind, isa)                                                                                   \
  {                                                                                                          \
    [MPMI_LAW_NEO_HOOKEAN] = mpmi_##kind##_neo_hookean_##isa,                                                \
    [MPMI_LAW_LINEAR_ELASTIC] = mpmi_##kind##_linear_elastic_##isa, [MPMI_LAW_J2] = mpmi_##kind##_j2_##isa,  \
    [MPMI_LAW_NEO_HOOKEAN_DECOUPLED] = mpmi_##kind##_neo_hookean_decoupled_##isa,                            \
    [MPMI_LAW_NEWTONIAN_FLUID] = mpmi_##kind##_newtonian_fluid_##isa,                                        \
    [MPMI_LAW_RIGID] = mpmi_##kind##_rigid_##isa                                                             \
  }

mpmi_law_fn mpmi_law_kernel(int32_t isa, int32_t law) {
  static const mpmi_law_fn baseline[MPMI_LAW_COUNT] = KERNELS(law, baseline);
#if MPMI_HAS_X86
  static const mpmi_law_fn avx2[MPMI_LAW_COUNT] = KERNELS(law, avx2);
  static const mpmi_law_fn avx512[MPMI_LAW_COUNT] = KERNELS(law, avx512);
  if (isa == MPM_ISA_AVX2) return avx2[law];
  if (isa == MPM_ISA_AVX512) return avx512[law];
#endif
  (void)isa;
  return baseline[law];
}

mpmi_tangent_fn mpmi_tangent_kernel(int32_t isa, int32_t law) {
  static const mpmi_tangent_fn baseline[MPMI_LAW_COUNT] = KERNELS(tangent, baseline);
#if MPMI_HAS_X86
  static const mpmi_tangent_fn avx2[MPMI_LAW_COUNT] = KERNELS(tangent, avx2);
  static const mpmi_tangent_fn avx512[MPMI_LAW_COUNT] = KERNELS(tangent, avx512);
  if (isa == MPM_ISA_AVX2) return avx2[law];
  if (isa == MPM_ISA_AVX512) return avx512[law];
#endif
  (void)isa;
  return baseline[law];
}

const mpmi_law *mpmi_law_by_index(int32_t index) {
  return index >= 0 && index < MPMI_LAW_COUNT ? &laws[index] : NULL;
}

const mpmi_law *mpmi_law_by_name(const char *name) {
  for (int32_t i = 0; i < MPMI_LAW_COUNT; ++i)
    if (!strcmp(laws[i].name, name)) return &laws[i];
  return NULL;
}

int32_t mpm_material_model_count(void) {
  return MPMI_LAW_COUNT;
}

const char *mpm_material_model_name(int32_t index) {
  const mpmi_law *law = mpmi_law_by_index(index);
  return law ? law->name : NULL;
}

mpm_status mpm_material_model_param(const char *model, int32_t index, const char **name, const char **unit,
                                    const char **text, double *value_default, double *low, double *high) {
  if (!model || index < 0) return MPM_E_ARG;
  const mpmi_law *law = mpmi_law_by_name(model);
  if (!law) return MPM_E_NOT_FOUND;
  if (index >= law->param_count) return MPM_E_NOT_FOUND;
  const mpmi_law_param *param = &law->param[index];
  if (name) *name = param->name;
  if (unit) *unit = param->unit;
  if (text) *text = param->text;
  if (value_default) *value_default = param->value;
  if (low) *low = param->low;
  if (high) *high = param->high;
  return MPM_OK;
}
