/**
 * @file contact.h
 * Contact between bodies: which sets are a body, how two bodies meet, and what came of it.
 *
 * Sets of one body share one velocity field, and so stick together; each body has its own nodes. Where the
 * nodes of two bodies both have mass, the bodies may touch: the gap between them is measured from their
 * particles, and an impulse acts on the nodes that closes the gap and never more, with Coulomb friction. It
 * has no stiffness and keeps no state from step to step. In implicit steps a node that parts and touches
 * again and again in the iterations is held in that step, and may be pulled. By default all sets are in
 * body 0, and there is no contact.
 *
 * @par Sources
 * Several velocity fields with Coulomb friction: Bardenhagen et al., CMES 2(4), 2001. The normal by logistic
 * regression, and the gap from the edges of particles: Nairn, Hammerquist and Smith, Comput. Methods Appl.
 * Mech. Engrg. 362, 2020. The impulse of a step as a unilateral constraint: Moreau, in Nonsmooth Mechanics
 * and Applications, 1988. docs/theory.md has the equations.
 */
#ifndef MPM_CONTACT_H
#define MPM_CONTACT_H

#include <mpm/stepper.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How two bodies meet: mpm_contact_desc.kind. */
enum mpm_contact_value {
  MPM_CONTACT_UNILATERAL = 0, /**< they push each other and never pull, with Coulomb friction (default) */
  MPM_CONTACT_NONE = 1,       /**< they pass through each other */
  MPM_CONTACT_TIED = 2        /**< neither slip nor separation at nodes that both have */
};
/** How the normal at a node is found: mpm_contact_desc.normal. One plane parts two bodies at a node: what is
 * thinner than two cells and lies between two faces of one other body is gripped by it. */
enum mpm_normal_value {
  MPM_NORMAL_LOGISTIC = 0,     /**< of the plane that separates the particles best: logistic regression */
  MPM_NORMAL_DISCRIMINANT = 1, /**< of Fisher's linear discriminant: one pass, for smooth surfaces */
  MPM_NORMAL_GRADIENT = 2,     /**< of the mean gradient of volume: for comparison with other codes */
  MPM_NORMAL_FIXED = 3         /**< mpm_contact_desc.direction */
};
/** How it is found that bodies touch: mpm_contact_desc.detection. */
enum mpm_detection_value {
  MPM_DETECT_DEFAULT = 0, /**< MPM_DETECT_GAP, but MPM_DETECT_VELOCITY with MPM_NORMAL_GRADIENT, whose
                               directions are too far off to measure a gap along them */
  MPM_DETECT_GAP = 1,     /**< by the gap between their particles */
  MPM_DETECT_VELOCITY = 2 /**< by velocity alone: wherever they share a node and approach each other */
};
/** In place of a body: all of them. */
enum mpm_body_value {
  MPM_BODY_ANY = -1 /**< any body that has no closer rule; all of them in reports */
};

/** How two bodies meet. Fill it with mpm_contact_desc_init(). */
typedef struct mpm_contact_desc {
  uint32_t struct_size;   /**< sizeof(mpm_contact_desc) of the caller */
  int32_t kind;           /**< an MPM_CONTACT_...; default MPM_CONTACT_UNILATERAL */
  int32_t normal;         /**< an MPM_NORMAL_...; default MPM_NORMAL_LOGISTIC */
  int32_t detection;      /**< an MPM_DETECT_...; default MPM_DETECT_DEFAULT */
  double friction;        /**< Coulomb's coefficient of sliding, >= 0; default 0 */
  double friction_static; /**< that of sticking, >= friction; 0 (default): the same as friction */
  double adhesion; /**< largest tensile traction while the gap is closed, stress, >= 0; default 0. Not with
                               detection by velocity, which knows no gap */
  double offset;   /**< distance that the surfaces keep, length; < 0: overlap is let be; default 0. Bodies see
                               each other from about a cell on: more than that they do not keep */
  double direction[3]; /**< MPM_NORMAL_FIXED: unit normal, from the first body to the second */
} mpm_contact_desc;

/** What two bodies did to each other in the last step, and since then. The caller sets struct_size. Forces
 * are means over the step. */
typedef struct mpm_contact_info {
  uint32_t struct_size; /**< sizeof(mpm_contact_info) of the caller */
  int32_t touching;     /**< 1: an impulse was given */
  int64_t nodes;        /**< nodes at which both have mass */
  int64_t closed;       /**< of these, with an impulse */
  int64_t stuck;        /**< of these, without slip */
  int64_t ambiguous;    /**< nodes that were left out: there is no normal, or both bodies are held */
  double force[3];      /**< on the second body, force */
  double torque[3];     /**< of the same about the origin; in 2-D in component 2; of
                               MPM_AXISYMMETRIC without meaning */
  double normal_force;  /**< sum of the nodes' normal forces, >= 0 without adhesion */
  double area;          /**< of closed nodes, length^(dim - 1); of MPM_AXISYMMETRIC times radius */
  double pressure_max; /**< largest normal force over area of a node, stress: rows of nodes on both sides of a
                              surface share them unevenly, and it may be twice what the surface has */
  double gap;          /**< smallest gap that was measured, length; < 0: overlap; infinity if none was */
  double dissipation;  /**< friction and closing in the step; see contact_dissipation of mpm_step_info */
  double friction_work; /**< of it, by friction */
  double impulse[3];    /**< on the second body over all committed steps since the stepper was made or
                              mpm_stepper_set_time() was called, mass length/time */
} mpm_contact_info;

/** Nodes at which two bodies touch, for mpm_friction_fn. Arrays belong to the library. */
typedef struct mpm_contact_batch {
  uint32_t struct_size;   /**< sizeof(mpm_contact_batch) of the library; see mpm.h */
  int32_t dim;            /**< dimension of the grid */
  int32_t body_a;         /**< the first body, the lower number */
  int32_t body_b;         /**< the second body */
  int64_t n;              /**< number of nodes */
  int64_t ld;             /**< distance from component c to c + 1, in elements; >= n */
  double t;               /**< time at the start of the step */
  double dt;              /**< size of the step */
  const double *position; /**< [dim][ld] of the nodes */
  const double *normal;   /**< [dim][ld] unit normal, from the first body to the second */
  const double *gap;      /**< [ld] length */
  const double *area;     /**< [ld] length^(dim - 1); of MPM_AXISYMMETRIC times radius */
  const double *slip;     /**< [dim][ld] tangential velocity of the second body relative to the first, before
                               the impulse */
  const double *pressure; /**< [ld] normal traction of the frictionless impulse, stress */
} mpm_contact_batch;

/** Sets the coefficients of friction of nodes (mt): friction[ld], preset to that of the pair of bodies,
 * may be changed to any finite value >= 0; it then also is that of sticking. It is asked once in a step,
 * with MPM_USF twice: first with the forces of the old stress. Returns as mpm_particle_fn does. */
typedef mpm_status (*mpm_friction_fn)(void *user, const mpm_contact_batch *batch, double *friction);

/** Puts a set into a body: 0 <= body < 4096, at first 0. Between steps, also with particles in it. Sets of
 * one body share one velocity field. MPM_E_NOT_FOUND: the set is not in this stepper. MPM_E_ARG: there is no
 * such body. MPM_E_UNSUPPORTED: with MPM_NEWMARK, bodies that touch with adhesion, or by
 * MPM_SOLVER_MULTIGRID_CG; with total_lagrangian = 1 another body than 0, because bodies touch at nodes that
 * both have. MPM_E_STATE during a staged step, or while a view of nodal fields is out; there are no nodal
 * fields then until the next step. */
MPM_API mpm_status mpm_stepper_set_body(mpm_stepper *stepper, mpm_particles *particles, int32_t body);

/** Gives the body of a set. MPM_E_NOT_FOUND: it is not in this stepper. */
MPM_API mpm_status mpm_stepper_body(const mpm_stepper *stepper, const mpm_particles *particles,
                                    int32_t *body);

/** Fills desc with the defaults. struct_size is sizeof(mpm_contact_desc) of the caller; no byte beyond is
 * written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time. */
MPM_API mpm_status mpm_contact_desc_init(mpm_contact_desc *desc, uint32_t struct_size);

/** Sets how two bodies meet; desc is copied. The order of the bodies matters for `direction` alone. With
 * MPM_BODY_ANY for one body: how the other meets those that have no rule of their own with it; for both:
 * how all meet that have no closer rule. Of the rules of two bodies each with MPM_BODY_ANY, that of the
 * lower number counts. A later call replaces an earlier one for the same pair; NULL takes the rule back.
 * Without any rule the defaults of mpm_contact_desc_init() hold. A saved state holds the rules. MPM_E_ARG:
 * a value is bad. MPM_E_UNSUPPORTED: adhesion with detection by velocity; with MPM_NEWMARK, adhesion, or
 * MPM_SOLVER_MULTIGRID_CG, of bodies that there are. MPM_E_STATE during a staged step. */
MPM_API mpm_status mpm_stepper_set_contact(mpm_stepper *stepper, int32_t body_a, int32_t body_b,
                                           const mpm_contact_desc *desc);

/** Sets the callback for coefficients of friction. NULL takes it away. The host sets it again after it has
 * loaded a state into another stepper. MPM_E_UNSUPPORTED with MPM_NEWMARK. */
MPM_API mpm_status mpm_stepper_set_friction(mpm_stepper *stepper, mpm_friction_fn fn, void *user);

/** Gives what two bodies did in the last step; for body_a MPM_BODY_ANY the sum over all others, on body_b;
 * the other way round what they suffered. Bodies that never were near each other have zeros, and an infinite
 * gap. MPM_E_ARG: the bodies are the same or there is no such body. MPM_E_STATE before the first step. */
MPM_API mpm_status mpm_stepper_contact_info(const mpm_stepper *stepper, int32_t body_a, int32_t body_b,
                                            mpm_contact_info *info);

#ifdef __cplusplus
}
#endif

#endif
