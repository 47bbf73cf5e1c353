/**
 * @file types.h
 * Version, status codes, constants, views and handles. The general contract (status, units, structs, arrays,
 * slots, times, threads) stands in mpm.h and holds for every declaration of the library.
 */
#ifndef MPM_TYPES_H
#define MPM_TYPES_H

#include <stdint.h>

/** Version of these headers, 0xMMmmpp (major, minor, patch). Compare with mpm_version(). */
#define MPM_VERSION 0x000100

/** Marks every exported function. Define it before the first include to replace the default. */
#ifndef MPM_API
#if defined(__GNUC__) || defined(__clang__)
#define MPM_API __attribute__((visibility("default")))
#else
#define MPM_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** Services of the host: memory, threads, log; counts the objects made with it. See context.h. */
typedef struct mpm_context mpm_context;
/** Background grid: dimension, bounds, spacing, basis, periodic axes. See grid.h. */
typedef struct mpm_grid mpm_grid;
/** One constitutive law with its parameters, shared by any number of sets. See material.h. */
typedef struct mpm_material mpm_material;
/** A set of particles of one material. See particles.h. */
typedef struct mpm_particles mpm_particles;
/** One time loop: a grid, particle sets, a scheme, walls and forces. See stepper.h. */
typedef struct mpm_stepper mpm_stepper;
/** The linear system of an implicit step, lent to a host solver. See stepper.h. */
typedef struct mpm_operator mpm_operator;

/** Result of a call: one of the values below. 0 done; > 0 not done; < 0 refused or failed. */
typedef int32_t mpm_status;

/** Status values. Positive ones leave the state as it was; 1..5 may be cured by a smaller dt. */
enum {
  MPM_OK = 0,             /**< done */
  MPM_CUT_DT = 1,         /**< a callback or a law asked for a smaller step */
  MPM_INVERTED = 2,       /**< det F <= 0 at a particle */
  MPM_NONFINITE = 3,      /**< NaN or infinity appeared */
  MPM_NOT_CONVERGED = 4,  /**< the Newton iteration did not converge */
  MPM_SINGULAR = 5,       /**< the linear system is singular, or indefinite beyond repair */
  MPM_OFF_GRID = 6,       /**< a particle would leave through a face that does not let it */
  MPM_CANCELLED = 7,      /**< by the progress callback */
  MPM_E_ARG = -1,         /**< an argument is NULL, out of range or inconsistent */
  MPM_E_NOMEM = -2,       /**< the allocator returned NULL */
  MPM_E_STATE = -3,       /**< not allowed now: objects alive, views out, a step begun */
  MPM_E_CALLBACK = -4,    /**< a callback returned < 0, or the host's executor failed */
  MPM_E_UNSUPPORTED = -5, /**< a combination or an extension that this library does not offer */
  MPM_E_NOT_FOUND = -6,   /**< no such name, id or index; the error text lists the nearest names */
  MPM_E_IO = -7,          /**< a file could not be opened, read or written */
  MPM_E_FORMAT = -8,      /**< data damaged, of another kind, or saved from an unlike setup */
  MPM_E_INTERNAL = -99    /**< a fault of the library itself */
};

/** Basis of the grid; h is the cell edge. */
enum {
  MPM_LINEAR = 1,   /**< piecewise linear, 2h wide: Steffen et al. 2008, eqs 17-18 */
  MPM_BSPLINE2 = 2, /**< quadratic B-spline, 3h wide: Steffen et al. 2008, eq. 21; MPoint theory, eqs 24-27 */
  MPM_BSPLINE3 = 3, /**< cubic B-spline, 4h wide: Steffen et al. 2008, eqs 22-23 */
  MPM_GIMP = 16,    /**< GIMP, edges "size", at most a cell: Steffen et al. 2008, eqs 26-29 */
  MPM_UGIMP = 17,   /**< GIMP, one size for all: smoothing * spacing */
  MPM_CPGIMP = 18   /**< GIMP, edges "size" * |F_ii|, at most a cell; depends on the axes */
};

/** B-splines at the faces of the grid: Steffen et al. 2008, section 3.2. */
enum {
  MPM_BOUNDARY_GHOST = 0, /**< the same splines everywhere, with nodes outside the faces */
  /** Knots repeated at the faces, degree + 1 times: one function alone is 1 there. No nodes outside; nodes
   * stand at the Greville points, cells + degree of them along an axis. Periodic axes keep plain splines. */
  MPM_BOUNDARY_OPEN_KNOT = 1
};

/** Time integration scheme. */
enum {
  MPM_USL = 1,  /**< explicit, stress last: MPoint theory, eqs 28-44; Steffen et al. 2008, eqs 1-10 */
  MPM_USF = 2,  /**< explicit, stress first, strain from the velocities at the start of the step: Guilkey, An
                   Introduction to the MPM, eqs 2-10 */
  MPM_MUSL = 3, /**< as MPM_USL, with velocities projected again before the stress update */
  MPM_NEWMARK = 16 /**< implicit: Guilkey & Weiss 2003, eqs 11-16, generalised to any beta and gamma */
};

/** Transfer of velocity between particles and grid. */
enum {
  MPM_FLIP = 1,    /**< FLIP, PIC and their blend by flip: MPoint theory, eqs 34-36 */
  MPM_APIC = 2,    /**< affine, Jiang et al. 2015; inertia per axis and particle, any basis */
  MPM_TPIC = 3,    /**< velocity gradient in the projection (MPoint theory, eq. 29), PIC update (eq. 35) */
  MPM_TFLIP = 4,   /**< velocity gradient in the projection (MPoint theory, eq. 29), FLIP blend (eq. 36) */
  MPM_AFLIP = 5,   /**< affine projection with the FLIP blend */
  MPM_XPIC = 6,    /**< XPIC(m), Hammerquist & Nairn 2017; m is xpic_order */
  MPM_APIC_MLS = 7 /**< affine, moving least squares, Hu et al. 2018: constant inertia, one fused matrix;
                      quadratic and cubic B-splines with ghosts or periodic axes */
};

/** Instruction set of the kernels. Results of two sets agree to round-off, those of one set bit by bit. */
enum {
  MPM_ISA_BEST = 0,     /**< the best that processor and library have */
  MPM_ISA_BASELINE = 1, /**< what the library was compiled for */
  MPM_ISA_AVX2 = 2,     /**< x86-64 AVX2 with FMA */
  MPM_ISA_AVX512 = 3    /**< x86-64 AVX-512 (F, DQ, VL) */
};

/** Level of a log text. */
enum {
  MPM_LOG_WARNING = 1, /**< something that the host should look at */
  MPM_LOG_INFO = 2,    /**< rare events: choices made at creation, growth of storage */
  MPM_LOG_DEBUG = 3    /**< per step */
};

/** Remedy against volumetric locking: MPoint theory, eqs 47-53, carried to the deformation gradient. */
enum {
  MPM_LOCKING_NONE = 0,        /**< none */
  MPM_LOCKING_CELL_AVERAGE = 1 /**< the law sees the dilation averaged over the cell, weighted by volume */
};

/** Form of a law's tangent; the value is the number of components. See mpm_tangent_fn. */
enum {
  MPM_TANGENT_MINOR_SYMMETRIC = 36, /**< Voigt, 6 x 6 */
  MPM_TANGENT_GENERAL = 81          /**< 9 x 9 */
};

/** Faces of the grid. */
enum {
  MPM_X_MIN = 0, /**< lower face across x */
  MPM_X_MAX = 1, /**< upper face across x */
  MPM_Y_MIN = 2, /**< lower face across y */
  MPM_Y_MAX = 3, /**< upper face across y */
  MPM_Z_MIN = 4, /**< lower face across z */
  MPM_Z_MAX = 5  /**< upper face across z */
};

/** What a face of the grid does. */
enum {
  MPM_WALL_NONE = 0,    /**< default: leaving fails the step with MPM_OFF_GRID */
  MPM_WALL_OPEN = 1,    /**< a particle that leaves is removed */
  MPM_WALL_FIXED = 2,   /**< no slip, holds both ways */
  MPM_WALL_SLIP = 3,    /**< symmetry plane, holds both ways, no tangential force */
  MPM_WALL_FRICTION = 4 /**< contact: pushes, never pulls; Coulomb friction */
};

/** Where in an explicit step a node hook runs. */
enum {
  MPM_AFTER_P2G = 1,     /**< mass and velocity projected, forces not yet known */
  MPM_AFTER_FORCES = 2,  /**< internal and external forces complete */
  MPM_AFTER_VELOCITY = 3 /**< velocity updated, walls and prescribed velocities applied */
};

/** Access to mapped memory; may be combined with |. */
enum {
  MPM_READ = 1, /**< the host reads */
  MPM_WRITE = 2 /**< the host writes */
};

/** Type of a field's elements. */
enum {
  MPM_F64 = 1, /**< double */
  MPM_I64 = 2, /**< int64_t */
  MPM_U8 = 3   /**< uint8_t */
};

/** Linear solver of an implicit step. */
enum {
  MPM_SOLVER_AUTO = 0,         /**< the cheapest by size, stencil, symmetry and inertia */
  MPM_SOLVER_CG = 1,           /**< conjugate gradients, diagonally scaled; symmetric positive definite */
  MPM_SOLVER_MULTIGRID_CG = 2, /**< conjugate gradients with geometric multigrid: the same matrices */
  MPM_SOLVER_LDLT = 3,         /**< direct; symmetric, may be indefinite */
  MPM_SOLVER_GMRES = 4,        /**< for systems that are not symmetric */
  MPM_SOLVER_HOST = 100        /**< the callback of mpm_stepper_set_linear_solver() */
};

/** A named number. The name is read during the call only. */
typedef struct mpm_param {
  const char *name; /**< as listed by mpm_material_model_param() */
  double value;     /**< in the host's units */
} mpm_param;

/**
 * Memory of the library, lent to the host until mpm_view_release():
 * element (i, c) = ((T *)data)[i * item_stride + c * component_stride].
 * The host sets struct_size before the call that fills the view and
 * changes no field afterwards.
 */
typedef struct mpm_view {
  uint32_t struct_size;     /**< sizeof(mpm_view) of the caller */
  int32_t type;             /**< MPM_F64, MPM_I64 or MPM_U8 */
  int32_t components;       /**< stored components per item; tensors may be compact, see particles.h */
  int32_t access;           /**< MPM_READ, MPM_WRITE or both, as asked for */
  int64_t count;            /**< items, inert slots included */
  int64_t item_stride;      /**< from item i to i + 1, in elements */
  int64_t component_stride; /**< from component c to c + 1, in elements */
  void *data;               /**< element (0, 0) */
  void *owner;              /**< the library's; NULL once released */
} mpm_view;

/** Version of the library that runs, 0xMMmmpp; compare with MPM_VERSION. Any thread, any time. */
MPM_API uint32_t mpm_version(void);

/** Name of a status constant, such as "MPM_E_ARG"; "unknown status" for any other value. Static text,
 * never NULL. Any thread, any time. */
MPM_API const char *mpm_status_name(mpm_status status);

/**
 * Gives back the memory of a view made by mpm_particles_map() or mpm_grid_map(); afterwards data and owner
 * are NULL. A view with MPM_WRITE takes effect now. MPM_E_ARG if the host wrote values that are not finite or
 * give det F <= 0: the view is released all the same, and the set refuses to step (MPM_E_STATE) until they
 * are repaired. MPM_E_STATE if the view is not, or no longer, lent.
 */
MPM_API mpm_status mpm_view_release(mpm_view *view);

#ifdef __cplusplus
}
#endif

#endif
