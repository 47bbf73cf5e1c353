/**
 * @file heat.h
 * Heat: temperature is a field of particles, which the grid conducts.
 *
 * A set that is described here has the fields "temperature" and, if it expands, "stress_temperature". They
 * are fields of type MPM_F64 with one component like those that mpm_particles_add_field() adds: the host
 * reads and writes them, they travel with the particles and are saved with them. A set that had such fields
 * of the host's before keeps their values. "stress_temperature" is the temperature at which the law was
 * last asked for the stress.
 *
 * Each step begins with the heat: temperatures go to the nodes by capacity, the nodes conduct, and
 * particles take the increments of the nodes' temperatures and not these themselves, so that nothing is
 * smoothed by the transfer. The law then sees the new temperature. Sets of one body share their nodes and
 * conduct into each other; heat does not cross between bodies, nor into sets that are not described. A
 * rigid motion carries temperatures as they are, splitting keeps them, and merged particles have the mean
 * by mass, so that heat is kept to rounding.
 *
 * Units are the host's: temperatures may count from any zero. Amounts are those of the grid: of a plane grid
 * per thickness, of MPM_AXISYMMETRIC per radian. Particles that leave through an open wall take their heat
 * with them.
 *
 * @par Sources
 * Increments in the place of values: Brackbill & Ruppel, J. Comput. Phys. 65 (1986), for velocities; for
 * temperatures, and what faces do: docs/theory.md. Expansion splits the deformation gradient: Stojanovic,
 * Djuric & Vujosevic, Arch. Mech. Stos. 16 (1964).
 */
#ifndef MPM_HEAT_H
#define MPM_HEAT_H

#include <mpm/stepper.h>
#include <mpm/surface.h>
#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How the nodes conduct. */
enum mpm_conduction_value {
  /** By the temperatures at the start of the step. Steps longer than 1 / (2 diffusivity sum 1 / h_k^2), h_k
   * the spacings, are refused with MPM_CUT_DT, and mpm_stable_dt() takes the bound into account; with
   * total_lagrangian = 1 spacings are those that the deformation has made of them. So are steps in which a
   * film of mpm_surface_set_heat() would take more from a particle than its difference to the ambient, of
   * which mpm_stable_dt() knows nothing. */
  MPM_CONDUCTION_EXPLICIT = 0,
  /** By those at its end (backward Euler), found by conjugate gradients: any step will do. */
  MPM_CONDUCTION_IMPLICIT = 1
};

/** What a face of the grid does to heat. */
enum mpm_heat_wall_value {
  MPM_HEAT_WALL_INSULATED = 0,  /**< lets none through */
  MPM_HEAT_WALL_TEMPERATURE = 1 /**< material at it has a prescribed temperature */
};

/** Heat sources: writes power[i], [ld], power per present volume, at the time batch->t: the start of the
 * step, and with implicit conduction its end. It runs as mpm_particle_fn does, on all threads, and returns as
 * that does. A value that is not finite ends the step: MPM_NONFINITE. */
typedef mpm_status (*mpm_heat_fn)(void *user, const mpm_particle_batch *batch, double *power);

/** The heat of a set. Fill it with mpm_heat_desc_init(). */
typedef struct mpm_heat_desc {
  uint32_t struct_size; /**< sizeof(mpm_heat_desc) of the caller */
  int32_t reserved;     /**< 0 */
  double specific_heat; /**< energy / (mass temperature), > 0. Must be given. */
  double conductivity;  /**< power / (length temperature), >= 0. Default 0: no heat is conducted. */
  double expansion;     /**< linear, 1/temperature. Default 0. The law sees F / exp(expansion (T - T0)). */
  /** T0, at which F = I is free of stress. Default 0. Particles that are added have this temperature. */
  double reference_temperature;
  /** Share of the work that the material dissipates which becomes heat, 0 to 1. Default 0. It is the work of
   * the stress less the change of strain energy; it heats the particle itself, at the end of the step. */
  double dissipated_share;
  mpm_heat_fn source; /**< NULL (default): there is none */
  void *user;         /**< is passed to source */
} mpm_heat_desc;

/** Where heat came from, in the last step and in all steps since the first set was described or the time was
 * set: gained = sum of walls + sources + surfaces + dissipated, to rounding, and with implicit conduction to
 * the tolerance. All are energies. */
typedef struct mpm_heat_info {
  uint32_t struct_size;    /**< sizeof(mpm_heat_info) of the caller */
  int32_t iterations;      /**< of the last step's conjugate gradients */
  double heat;             /**< sum of mass specific_heat temperature now, of all sets that are described */
  double gained;           /**< what particles took up in the last step */
  double walls[6];         /**< through the faces, from MPM_X_MIN, into the material */
  double sources;          /**< of the callbacks */
  double surfaces;         /**< through surfaces, into the material */
  double dissipated;       /**< dissipated work that became heat */
  double gained_total;     /**< the same in all steps, and so with those below */
  double walls_total[6];   /**< through the faces */
  double sources_total;    /**< of the callbacks */
  double surfaces_total;   /**< through surfaces */
  double dissipated_total; /**< dissipated work */
} mpm_heat_info;

/** Fills desc with the defaults. struct_size is sizeof(mpm_heat_desc) of the caller; no byte beyond is
 * written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time. */
MPM_API mpm_status mpm_heat_desc_init(mpm_heat_desc *desc, uint32_t struct_size);

/** Describes the heat of a set of the stepper, for the steps that follow; NULL: it has none any more, and
 * its fields stay as fields of the host. Not part of a saved state, but the fields are: the host describes
 * before it loads. MPM_E_NOT_FOUND: the set is not in the stepper. MPM_E_ARG: particles is NULL, a value is
 * bad, or the set has a field "temperature" or "stress_temperature" of another type or with more
 * components. MPM_E_UNSUPPORTED: expansion is not 0 on MPM_PLANE_STRESS or with the law "rigid";
 * dissipated_share is not 0 with "rigid" or a law of the host. MPM_E_STATE: a step is under way, a view of
 * the set is out, or the set has no room for another field. */
MPM_API mpm_status mpm_stepper_set_heat(mpm_stepper *stepper, mpm_particles *particles,
                                        const mpm_heat_desc *desc);

/** Chooses how the nodes conduct, from MPM_CONDUCTION_EXPLICIT (as made) on. tolerance: of the residual of
 * conjugate gradients, relative to the right-hand side; > 0 and < 1; not read with explicit conduction.
 * MPM_E_ARG: a value is bad. MPM_E_STATE: a step is under way. */
MPM_API mpm_status mpm_stepper_set_conduction(mpm_stepper *stepper, int32_t conduction, double tolerance);

/** Says what a face does to heat, whatever kind of wall it has. kind: MPM_HEAT_WALL_...; the temperature is
 * not read of insulated ones, which all faces are from the start. Call it again where the temperature
 * changes: that change, at first from what the material there has, reaches the particles in the next step;
 * material that comes to the face later is heated by conduction alone. Where two such faces meet, that of the
 * lower axis prescribes the edge. Not part of a saved state.
 * MPM_E_ARG: a value is bad, or the axis is periodic. MPM_E_UNSUPPORTED: the face is the axis of
 * MPM_AXISYMMETRIC, through which nothing flows. MPM_E_STATE: a step is under way. */
MPM_API mpm_status mpm_stepper_set_heat_wall(mpm_stepper *stepper, int32_t face, int32_t kind,
                                             double temperature);

/** Heats what lies below a surface, per area of its markers: flux + film (ambient - temperature of the
 * material), power/area into the material; film is >= 0. All 0 (as made): no heat. Not part of a saved
 * state. MPM_E_ARG: a value is bad. MPM_E_STATE: a step is under way. */
MPM_API mpm_status mpm_surface_set_heat(mpm_surface *surface, double flux, double film, double ambient);

/** Tells where heat came from. MPM_E_ARG: info is NULL. MPM_E_STATE: a step is under way, or no set was ever
 * described. */
MPM_API mpm_status mpm_stepper_heat_info(const mpm_stepper *stepper, mpm_heat_info *info);

#ifdef __cplusplus
}
#endif

#endif
