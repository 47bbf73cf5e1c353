/**
 * @file material.h
 * Constitutive laws: those built in, which are found by name, and those that the host writes as callbacks
 * over batches of particles.
 */
#ifndef MPM_MATERIAL_H
#define MPM_MATERIAL_H

#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Makes a material from a built-in law. In the table stresses are Cauchy stresses, and J = det F.
 *
 * | model                   | parameters                              | law                                 |
 * |-------------------------|-----------------------------------------|-------------------------------------|
 * | "linear_elastic"        | E, nu, density                          | hypoelastic: with F_inc = V R,      |
 * |                         |                                         | stress' = R stress R^T + C : ln V   |
 * | "neo_hookean"           | E, nu, density                          | Steffen et al. 2008, eq. 46         |
 * | "neo_hookean_decoupled" | mu, kappa, density                      | Guilkey & Weiss 2003, eq. 20        |
 * | "j2"                    | E, nu, density, yield_stress, hardening | linear_elastic with von Mises yield |
 * |                         |                                         | and linear isotropic hardening      |
 * | "newtonian_fluid"       | density, bulk_modulus, gamma,           | p = bulk_modulus / gamma            |
 * |                         | viscosity, tension                      | (J^-gamma - 1), dynamic viscosity;  |
 * |                         |                                         | tension 0 cuts off p < 0            |
 * | "rigid"                 | density                                 | no stress; moves as prescribed      |
 * | "drucker_prager"        | E, nu, density, phi, psi, cohesion,     | elastic in the logarithmic strain;  |
 * |                         | cone, tension_cutoff, hardening,        | yields at q = M p + k: sand, gravel |
 * |                         | cohesion_residual, close_gaps           | and other soils; opens in tension   |
 * | "mohr_coulomb"          | those of drucker_prager without cone    | the same by the planes of           |
 * |                         |                                         | Mohr-Coulomb; phi = 0 is Tresca     |
 * | "herschel_bulkley"      | density, bulk_modulus, gamma,           | p of newtonian_fluid; elastic in    |
 * |                         | shear_modulus, yield_shear,             | shear up to yield_shear, then flow: |
 * |                         | consistency, n, tension                 | + consistency (shear rate)^n        |
 * | "snow"                  | E, nu, density, hardening,              | Stomakhin et al. 2013: elastic      |
 * |                         | critical_compression, critical_stretch, | stretches within bounds, hardens by |
 * |                         | hardening_max                           | compaction                          |
 * | "mu_i"                  | E, nu, density, mu_s, mu_2, I_0,        | Jop et al. 2006: grains that flow   |
 * |                         | grain_diameter, grain_density           | with friction mu(I); no tension     |
 * | "cam_clay"              | density, kappa, lambda, M, mu0, alpha,  | modified Cam-clay in the logarithmic|
 * |                         | p_ref, pc0, p_min                       | strain; needs an initial stress     |
 *
 * params are count pairs of name and value in any order, which are copied; parameters that are not named take
 * their defaults. mpm_material_model_param() lists units, defaults and ranges. *out is NULL unless MPM_OK is
 * returned. MPM_E_NOT_FOUND: there is no such model or parameter. MPM_E_ARG: a value is out of range, a name
 * is given twice, values do not go together, or a parameter without default is missing.
 */
MPM_API mpm_status mpm_material_create(mpm_context *context, const char *model, const mpm_param *params,
                                       int32_t count, mpm_material **out);

/** The number of built-in laws. Any thread, any time. */
MPM_API int32_t mpm_material_model_count(void);

/** The name of the built-in law with number index, 0 <= index < mpm_material_model_count(), or NULL for
 * another index. The text is static. Any thread, any time. */
MPM_API const char *mpm_material_model_name(int32_t index);

/**
 * Describes the parameter with number index (from 0) of a built-in law: its name, its unit as a dimension
 * (such as "stress"), one line of text, its default (NaN if it must be given) and its range [low, high].
 * Texts are static, and output pointers may be NULL. MPM_E_NOT_FOUND: there is no such model, or index is
 * past the last parameter. Any thread, any time.
 */
MPM_API mpm_status mpm_material_model_param(const char *model, int32_t index, const char **name,
                                            const char **unit, const char **text, double *value_default,
                                            double *low, double *high);

/**
 * The number of state variables of a particle of a built-in law, or -1 where there is no such model. They
 * are the components of the field "state". Any thread, any time.
 */
MPM_API int32_t mpm_material_state_count(const char *model);

/**
 * Describes the state variable with number index (from 0) of a built-in law: its name, such as
 * "plastic_strain", its unit as a dimension and one line of text. Texts are static, and output pointers
 * may be NULL. MPM_E_NOT_FOUND: there is no such model, or index is past the last variable. Any thread,
 * any time.
 */
MPM_API mpm_status mpm_material_state_name(const char *model, int32_t index, const char **name,
                                           const char **unit, const char **text);

/**
 * Particles that a law is asked about. Arrays are [components][ld], of which the first n items of each
 * component count. Tensors are full: F, F_inc and L have component 3 * row + column, stresses xx yy zz xy yz
 * xz. In callbacks the memory belongs to the library and is valid during the call, and output arrays do not
 * overlap input arrays.
 */
typedef struct mpm_material_batch {
  uint32_t struct_size;        /**< sizeof(mpm_material_batch) of the library; see mpm.h */
  int32_t state_count;         /**< number of state variables of a particle */
  int64_t n;                   /**< number of particles, inert slots included */
  int64_t ld;                  /**< distance from component c to c + 1, in elements; >= n */
  double t;                    /**< time at the end of the step */
  double dt;                   /**< size of the step; 0: the state as it is, see mpm_stress_fn */
  const int64_t *id;           /**< [ld] ids, < 0 for inert slots */
  const double *F;             /**< [9][ld] deformation gradient at the end of the step */
  const double *F_inc;         /**< [9][ld] deformation gradient of this step alone: F = F_inc F_old */
  const double *L;             /**< [9][ld] velocity gradient (F_inc - I) / dt, 1/time; 0 when dt is 0 */
  const double *stress;        /**< [6][ld] Cauchy stress before the step */
  const double *state;         /**< [state_count][ld] state variables before the step */
  double *stress_new;          /**< [6][ld] out: Cauchy stress after the step */
  double *state_new;           /**< [state_count][ld] out: state variables after the step */
  double *wave_speed;          /**< [ld] out: speed of the fastest elastic wave now, length/time */
  double *kinematic_viscosity; /**< [ld] out, preset 0: length^2/time, limits the explicit dt */
  double *energy;              /**< [ld] out, preset NaN (not known): strain energy per initial volume */
  const double *position;      /**< [dim][ld] position at the start of the step */
  const void *lookup;          /**< argument of mpm_batch_field() */
} mpm_material_batch;

/**
 * Lends a field of the set that a batch belongs to, built in or the host's own. It is aligned with the batch
 * and valid during the callback: component c of item i is (*data)[c * *component_stride + i], in elements of
 * the field's type. Nothing is copied, so tensors have their stored components, as in views. lookup is that
 * of the batch. May be called from any thread on which a callback runs. MPM_E_NOT_FOUND: there is no such
 * field. MPM_E_STATE: the field is optional, and the set does not have it now.
 */
MPM_API mpm_status mpm_batch_field(const void *lookup, const char *field, const void **data,
                                   int64_t *component_stride);

/**
 * A law (mt). It reads the state before the step and the deformation of the step, and writes stress_new,
 * state_new and wave_speed of all n items, and kinematic_viscosity and energy where it has them. A wave speed
 * or a viscosity below 0 stops the step or the call that asked (MPM_E_CALLBACK), and an infinite energy or
 * any other value that is not finite is MPM_NONFINITE; both name the particle. The law may be
 * called several times for one step, and nothing that it writes counts before the step is committed: it keeps
 * no state of its own.
 *
 * With dt = 0, F_inc = I and L = 0 the library asks for stress, wave speed and energy of the state as it is:
 * the law returns the stress that belongs to that state.
 *
 * Returns 0, a value > 0 to ask for a smaller dt (MPM_CUT_DT), or a value < 0 to stop (MPM_E_CALLBACK).
 */
typedef mpm_status (*mpm_stress_fn)(void *user, const mpm_material_batch *batch);

/**
 * The tangent of a law (mt), for implicit steps. It is called after the law on the same batch, with the law's
 * outputs in place, and writes tangent[component * ld + i], a stress, in the form that tangent_form names.
 * With tau = J stress and the variation dF = L F, c is the derivative of the Lie derivative of tau:
 * c_ijkl = d tau_ij / d L_kl - delta_ik tau_jl - delta_jk tau_il.
 *
 * - MPM_TANGENT_MINOR_SYMMETRIC has component 6 * row + column, where rows and columns are xx yy zz xy yz
 *   xz, and columns are for engineering shear.
 * - MPM_TANGENT_GENERAL has component 9 * (3 * i + j) + 3 * k + l.
 *
 * Into *symmetric the callback writes 1 if c has major symmetry (c_ijkl = c_klij) at every item, 0 otherwise.
 * Returns as mpm_stress_fn does.
 */
typedef mpm_status (*mpm_tangent_fn)(void *user, const mpm_material_batch *batch, double *tangent,
                                     int32_t *symmetric);

/** A law of the host. Fill the struct with mpm_material_desc_init(). */
typedef struct mpm_material_desc {
  uint32_t struct_size;   /**< sizeof(mpm_material_desc) of the caller */
  int32_t state_count;    /**< number of state variables of a particle, 0 to 64; default 0 */
  int32_t tangent_form;   /**< MPM_TANGENT_MINOR_SYMMETRIC (default) or MPM_TANGENT_GENERAL */
  int32_t reserved;       /**< 0 */
  double density;         /**< mass per initial volume, > 0; the host must set it */
  mpm_stress_fn stress;   /**< the law; the host must set it */
  mpm_tangent_fn tangent; /**< NULL (default): stresses are differenced, in the general form */
  void *user;             /**< first argument of stress, tangent and release_user */
  /** Called with user when the material is destroyed, not when create fails; may be NULL (default). */
  void (*release_user)(void *user);
  const double *state_initial; /**< [state_count] state of a new particle, copied; NULL (default): zeros */
} mpm_material_desc;

/** Fills desc with the defaults; the host must set density and stress. struct_size is
 * sizeof(mpm_material_desc) of the caller; no byte beyond is written. MPM_E_ARG: it is smaller than the first
 * released struct. Any thread, any time. */
MPM_API mpm_status mpm_material_desc_init(mpm_material_desc *desc, uint32_t struct_size);

/** Makes a material from a law of the host. desc is copied. *out is NULL unless MPM_OK is returned.
 * MPM_E_ARG: a value is bad, or stress is NULL. */
MPM_API mpm_status mpm_material_create_custom(mpm_context *context, const mpm_material_desc *desc,
                                              mpm_material **out);

/**
 * Runs a material, built in or the host's, without a grid: what a step does to its particles, for n items
 * of the caller. It is how parameters are fitted to tests of the laboratory.
 *
 * The caller fills batch: struct_size, state_count (that of the material), n, ld, t, dt, F (at the end of
 * the step), F_inc, stress and state before the step, and the arrays for stress_new and state_new, all in
 * the forms of mpm_material_batch. These may be NULL: id (items then have ids from 0; items with ids < 0
 * are inert, and what their outputs hold is not said), L (made of F_inc and dt; what is given must be
 * (F_inc - I) / dt), position ([3][ld]; zeros), wave_speed, kinematic_viscosity and energy (not wanted),
 * state and state_new of a law without state. lookup is not used: a law of the host gets NULL. Outputs may
 * be the arrays of inputs: stress_new that of stress, say. With dt = 0 the answer is the state as it is, see
 * mpm_stress_fn, whatever F_inc and L are.
 *
 * tangent is NULL or [81][ld], and receives the tangent of the step in the general form of mpm_tangent_fn;
 * dt must be > 0 then. Into *symmetric goes 1 if it has major symmetry at every item, else 0; it may be
 * NULL, and is left alone without a tangent.
 *
 * Bits are those of a 3-D step on the same instruction set. The calling thread does all the work, as for
 * other calls of the context. MPM_E_ARG: an array is NULL, a number is out of range, or L and F_inc
 * disagree. MPM_NONFINITE: a value that is given or that comes out is not finite. MPM_INVERTED: det F or
 * det F_inc is not positive. MPM_CUT_DT and MPM_E_CALLBACK: as in a step. What is wrong with an item names
 * it, what a law returned the items that it was asked about. After a failure items before these may have
 * been written.
 */
MPM_API mpm_status mpm_material_update(const mpm_material *material, const mpm_material_batch *batch,
                                       double *tangent, int32_t *symmetric);

/** Frees the material and calls release_user. NULL is fine. MPM_E_STATE while sets of it live. */
MPM_API mpm_status mpm_material_destroy(mpm_material *material);

#ifdef __cplusplus
}
#endif

#endif
