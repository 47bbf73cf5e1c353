/**
 * @file adaption.h
 * Splitting and merging: particles of a set are halved where material is drawn out, so that it does not
 * come apart where particles lie too far from each other, and put together where there are more than are
 * needed.
 *
 * A particle that is split gives its mass, volume and forces to two, four or eight particles in its
 * domain, the parallelepiped that its deformation gradient makes of the edges in "size". Everything else
 * they have from it, and the edges that were halved. With transfers that carry a matrix velocities follow
 * the matrix, and what the particles' distances then have of its momentum is taken out of it. A pair that
 * is merged becomes one particle in the middle of its mass. Mass, volume and momentum are kept to
 * rounding, and the angular momentum too, of pairs only with transfers that carry a matrix. What is lost
 * of it, and of energy, mpm_adaption_info tells. Prescribed particles keep
 * their velocities on prescribed axes, and what momentum a matrix has there is lost. The volume of merged
 * sheets (MPM_PLANE_STRESS) is that of the thickness that the law finds.
 *
 * Sets adapt at the end of steps: the step has been made with the particles as they were, and either both
 * are done or neither. The info of that step has the energies before, mpm_stepper_info() those after it.
 * It costs one pass over the particles, on one thread, and results do not depend on the number of threads.
 * Nodal fields are those of the step.
 *
 * @par Sources
 * Splitting by size: Ma, Zhang & Huang, CMES 39 (2009); Homel, Brannon & Guilkey, Int. J. Numer. Meth.
 * Engng 106 (2016). What the matrices must give: derived in docs/theory.md.
 */
#ifndef MPM_ADAPTION_H
#define MPM_ADAPTION_H

#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What a batch of mpm_adaption_fn is about. */
enum mpm_adapt_value {
  MPM_ADAPT_SPLIT = 0, /**< particles that are to be split */
  MPM_ADAPT_MERGE = 1  /**< pairs that are to become one particle */
};

/** Particles that are to be split, or pairs that are to be merged. Arrays belong to the library and are valid
 * during the call. */
typedef struct mpm_adaption_batch {
  uint32_t struct_size;   /**< sizeof(mpm_adaption_batch) of the library; see mpm.h */
  int32_t what;           /**< MPM_ADAPT_SPLIT or MPM_ADAPT_MERGE */
  int64_t n;              /**< how many */
  int64_t ld;             /**< distance from component c to c + 1 of position, in elements; >= n */
  int32_t dim;            /**< dimension of the grid */
  int32_t reserved;       /**< 0 */
  const int64_t *id;      /**< [ld] ids, ascending; of pairs that of the particle that stays */
  const int64_t *other;   /**< [ld] ids of the particles that go; NULL where particles are split */
  const double *position; /**< [dim][ld] of the particle, or of the one that stays */
} mpm_adaption_batch;

/** Says which of them are left as they are: accept[i], [ld], is 1, and the callback writes 0 to keep the
 * i-th from it. It runs on the thread of the call. Returns as mpm_particle_fn does. */
typedef mpm_status (*mpm_adaption_fn)(void *user, const mpm_adaption_batch *batch, uint8_t *accept);

/** How a set adapts. Fill it with mpm_adaption_desc_init(), after which nothing is split and nothing merged.
 * Lengths are counted in cells: an edge (a, b, c) has the length |(a/h_x, b/h_y, c/h_z)|. */
typedef struct mpm_adaption_desc {
  uint32_t struct_size; /**< sizeof(mpm_adaption_desc) of the caller */
  int32_t every; /**< steps from one adaption to the next; default 10; 0: by mpm_stepper_adapt() alone */
  /** Edges of domains that are longer than this are halved. 0 (default): none are. With quadratic splines,
   * two particles per cell and axis and a transfer that carries a matrix, 0.52 keeps material together
   * however far it is drawn. */
  double split_edge;
  /** No edge becomes shorter than this by splitting. Default 0.125. */
  double least_edge;
  /** In a cell that has particles, but fewer of the set than this, they are split along their longest edges
   * until there are so many. 0 (default): not. For fluids, whose deformation gradient has no shape. */
  int32_t min_per_cell;
  /** In a cell with more particles of the set pairs are merged until there are so many: in the order of ids,
   * each particle with the nearest that is alike. 0 (default): none are. At least twice min_per_cell. */
  int32_t max_per_cell;
  /** Pairs lie no further apart than this. Default 0.25. */
  double merge_distance;
  /** Pairs are alike when their deformation gradients differ by at most this share of the larger one, in the
   * norm of Frobenius, their stresses by this share of density c^2, and their velocities by this share of c,
   * the wave speed of the law; with laws of the host, stresses by this share of the larger one, and
   * velocities are not looked at. Default 0.02. */
  double merge_tolerance;
  /** Nothing is split beyond this number of particles in the set. 0 (default): there is no such bound. */
  int64_t most_particles;
  mpm_adaption_fn accept; /**< NULL (default): all are accepted */
  void *user;             /**< is passed to accept */
} mpm_adaption_desc;

/** What adaption has done to a set, in all steps since it was first described for it or the time was set. */
typedef struct mpm_adaption_info {
  uint32_t struct_size; /**< sizeof(mpm_adaption_info) of the caller */
  int32_t reserved;     /**< 0 */
  int64_t splits;       /**< particles that were split */
  int64_t added;        /**< particles that came by it */
  int64_t merges;       /**< pairs that became one */
  double
      kinetic_loss;   /**< kinetic energy before, less that after: >= 0 of merges; splits with a matrix < 0 */
  double affine_loss; /**< the same of the matrices: what they give to velocities, and what is lost */
  double strain_loss; /**< the same of the strain energy, in merges; laws of the host are not counted */
  /** Angular momentum before, less that after: of merges without a matrix. 0 of MPM_AXISYMMETRIC. */
  double angular_momentum_loss[3];
} mpm_adaption_info;

/** Fills desc with the defaults. struct_size is sizeof(mpm_adaption_desc) of the caller; no byte beyond is
 * written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time. */
MPM_API mpm_status mpm_adaption_desc_init(mpm_adaption_desc *desc, uint32_t struct_size);

/** Describes how a set of the stepper adapts, for the steps that follow; NULL: no longer. The set then
 * keeps the field "size". Not part of a saved state: the host sets it again. MPM_E_NOT_FOUND: the set is
 * not in the stepper. MPM_E_ARG: a value is bad or particles is NULL; an edge could be split that would be
 * shorter than least_edge (split_edge < 2 least_edge), or max_per_cell < 2 min_per_cell.
 * MPM_E_UNSUPPORTED: total_lagrangian = 1, where material does not come apart, or the law is "rigid".
 * MPM_E_STATE: a step is under way, or a view of the set is out. */
MPM_API mpm_status mpm_stepper_set_adaption(mpm_stepper *stepper, mpm_particles *particles,
                                            const mpm_adaption_desc *desc);

/** Adapts all sets that are described, now and whatever `every` is. Sets are unchanged on failure.
 * MPM_E_CALLBACK, MPM_CUT_DT: accept returned an error. MPM_E_STATE: a step is under way, a view of a set is
 * out, or a value that was written through one is bad. */
MPM_API mpm_status mpm_stepper_adapt(mpm_stepper *stepper);

/** Tells what adaption has done to a set. MPM_E_NOT_FOUND: it is not in the stepper. MPM_E_ARG: particles or
 * info is NULL. */
MPM_API mpm_status mpm_stepper_adaption_info(const mpm_stepper *stepper, const mpm_particles *particles,
                                             mpm_adaption_info *info);

#ifdef __cplusplus
}
#endif

#endif
