/**
 * @file types.h
 * Version, status codes, constants, views and handles. The general contract (status, units, structs, arrays,
 * slots, times, threads) stands in mpm.h and holds for every declaration of the library.
 */
#ifndef MPM_TYPES_H
#define MPM_TYPES_H

/* Parsers that know the types of these two already, as cffi's and LuaJIT's do, are given the declarations by
 * cc -E -P -DMPM_NO_INCLUDES -DMPM_API= -Iinclude include/mpm/mpm.h */
#ifndef MPM_NO_INCLUDES
#include <stddef.h>
#include <stdint.h>
#endif

/** Version of these headers as 0xMMmmpp (major, minor, patch), to be compared with mpm_version(). */
#define MPM_VERSION 0x000100

/** Marks every exported function. A host may define it before the first include to replace the default. On
 * Windows a host that links to the DLL may define MPM_DLL, which saves a jump for each call; one that links
 * statically must not. */
#ifndef MPM_API
#if defined(_WIN32) && defined(MPM_BUILD)
#define MPM_API __declspec(dllexport)
#elif defined(_WIN32) && defined(MPM_DLL)
#define MPM_API __declspec(dllimport)
#elif defined(_WIN32)
#define MPM_API
#elif defined(__GNUC__) || defined(__clang__)
#define MPM_API __attribute__((visibility("default")))
#else
#define MPM_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** A context holds the services of the host (memory, threads, log) and the text of the last error. Every
 * other object is made with one. See context.h. */
typedef struct mpm_context mpm_context;
/** A background grid has a dimension, bounds, spacings, a basis and periodic axes. See grid.h. */
typedef struct mpm_grid mpm_grid;
/** A material is one constitutive law with its parameters. Any number of sets share it. See material.h. */
typedef struct mpm_material mpm_material;
/** A set holds particles of one material on one grid. See particles.h. */
typedef struct mpm_particles mpm_particles;
/** A stepper is one time loop with a grid, sets of particles, a scheme, walls and forces. See stepper.h. */
typedef struct mpm_stepper mpm_stepper;
/** The linear system of an implicit step, which the library lends to the host's solver. See operator.h. */
typedef struct mpm_operator mpm_operator;

/** The result of a call is one of the values below: 0 says that it was done, a positive value that it was not
 * done, a negative value that it was refused or failed. */
typedef int32_t mpm_status;

/** Status values. After a positive one the state is as it was before the call. A smaller dt may cure 1..5. */
enum mpm_status_value {
  MPM_OK = 0,             /**< the call did what it was asked to */
  MPM_CUT_DT = 1,         /**< a callback, a law or contact asked for a smaller step */
  MPM_INVERTED = 2,       /**< det F <= 0 at a particle */
  MPM_NONFINITE = 3,      /**< a NaN or an infinity appeared */
  MPM_NOT_CONVERGED = 4,  /**< the Newton iteration did not converge */
  MPM_SINGULAR = 5,       /**< the linear system is singular, or indefinite beyond repair */
  MPM_OFF_GRID = 6,       /**< a particle would leave through a face that does not let it */
  MPM_CANCELLED = 7,      /**< the progress callback ended the call */
  MPM_E_ARG = -1,         /**< an argument is NULL, out of range or inconsistent */
  MPM_E_NOMEM = -2,       /**< the allocator returned NULL */
  MPM_E_STATE = -3,       /**< not allowed now: objects live, views are out, or a step is begun */
  MPM_E_CALLBACK = -4,    /**< a callback returned < 0, or the host's executor failed */
  MPM_E_UNSUPPORTED = -5, /**< this version does not offer the combination or the extension */
  MPM_E_NOT_FOUND = -6,   /**< there is no such name, id or index; the text lists the nearest names */
  MPM_E_IO = -7,          /**< a file could not be opened, read or written */
  MPM_E_FORMAT = -8,      /**< data are damaged, of another kind, or from an unlike setup */
  MPM_E_INTERNAL = -99    /**< the library itself is at fault */
};

/** Basis functions of the grid. Here h is the edge of a cell. */
enum mpm_basis_value {
  MPM_LINEAR = 1, /**< piecewise linear functions, 2h wide: Steffen et al. 2008, eqs 17-18 */
  /** Quadratic B-splines, 3h wide: Steffen et al. 2008, eq. 21; MPoint theory, eqs 24-27. */
  MPM_BSPLINE2 = 2,
  MPM_BSPLINE3 = 3, /**< cubic B-splines, 4h wide: Steffen et al. 2008, eqs 22-23 */
  MPM_GIMP = 16,    /**< GIMP on domains of edges "size", at most a cell: Steffen et al. 2008, eqs 26-29 */
  MPM_UGIMP = 17,   /**< GIMP on domains that all have edges of smoothing * spacing */
  MPM_CPGIMP = 18   /**< GIMP on domains of edges "size" * |F_ii|, at most a cell; depends on the axes */
};

/** What B-splines do at the faces of the grid: Steffen et al. 2008, section 3.2. */
enum mpm_boundary_basis_value {
  MPM_BOUNDARY_GHOST = 0, /**< splines are the same everywhere, with nodes outside the faces */
  /** Knots are repeated degree + 1 times at the faces, where one function alone is then 1. There are no nodes
   * outside: the cells + degree nodes of an axis stand at the Greville points. Periodic axes keep plain
   * splines. */
  MPM_BOUNDARY_OPEN_KNOT = 1
};

/** What lies across the plane of a 2-D grid. */
enum mpm_geometry_value {
  MPM_PLANE_STRAIN = 0, /**< a slab of unit thickness that keeps its thickness */
  /** A body of revolution: axis 0 is the radius r >= 0, axis 1 the axis z. What is extensive (volume,
   * mass, force, energy) is that of one radian: of the whole ring it is 2 pi times as much. The axis
   * r = 0 is a slip wall by itself. Sulsky & Schreyer 1996, section 3; Nairn & Guilkey 2015. Since 0.2.0. */
  MPM_AXISYMMETRIC = 1,
  /** A sheet of unit thickness at the start, without a stress across it: F33, which the library finds,
   * makes it thinner and thicker. Solids alone, without the locking remedy. Since 0.2.0. */
  MPM_PLANE_STRESS = 2
};

/** Time integration scheme. */
enum mpm_scheme_value {
  /** Explicit, with stresses updated last: MPoint theory, eqs 28-44; Steffen et al. 2008, eqs 1-10. */
  MPM_USL = 1,
  /** Explicit, with stresses updated first, by the strain from the velocities at the start of the step:
   * Guilkey, An Introduction to the MPM, eqs 2-10. */
  MPM_USF = 2,
  /** As MPM_USL, but velocities are projected a second time before stresses are updated. */
  MPM_MUSL = 3,
  /** Implicit, by Newmark's rule: Guilkey & Weiss 2003, eqs 11-16, generalised to any beta and gamma. */
  MPM_NEWMARK = 16
};

/** Transfer of velocity between particles and grid. */
enum mpm_transfer_value {
  MPM_FLIP = 1,  /**< FLIP, PIC, and their blend by the field flip: MPoint theory, eqs 34-36 */
  MPM_APIC = 2,  /**< affine, with the inertia of each axis and particle, for any basis: Jiang et al. 2015 */
  MPM_TPIC = 3,  /**< projects the velocity gradient too (MPoint theory, eq. 29); PIC update (eq. 35) */
  MPM_TFLIP = 4, /**< projects the velocity gradient too (MPoint theory, eq. 29); FLIP blend (eq. 36) */
  MPM_AFLIP = 5, /**< affine projection with the FLIP blend */
  MPM_XPIC = 6,  /**< XPIC(m), where m is xpic_order: Hammerquist & Nairn 2017 */
  /** Affine by moving least squares, with constant inertia and one fused matrix, for quadratic and cubic
   * B-splines with ghosts or periodic axes: Hu et al. 2018. */
  MPM_APIC_MLS = 7,
  /** FMPM(k), where k is xpic_order: nodal velocities by the first k terms of a series for the inverse of the
   * full mass matrix: Nairn & Hammerquist 2021. Since 0.2.0. */
  MPM_FMPM = 8
};

/** Instruction set of the kernels. Results of two sets agree to round-off, those of one set to the bit. */
enum mpm_isa_value {
  MPM_ISA_BEST = 0,     /**< the best one that both the processor and the library have */
  MPM_ISA_BASELINE = 1, /**< the one that the library was compiled for */
  MPM_ISA_AVX2 = 2,     /**< AVX2 with FMA, on x86-64 */
  MPM_ISA_AVX512 = 3,   /**< AVX-512 (F, DQ, VL), on x86-64 */
  MPM_ISA_NEON = 4,     /**< NEON with FMA, on aarch64 */
  /** the baseline by its promise: the same bits on every platform (mpm.h, Results) */
  MPM_ISA_PORTABLE = MPM_ISA_BASELINE
};

/** Level of a log text. */
enum mpm_log_value {
  MPM_LOG_WARNING = 1, /**< the host should look at it */
  MPM_LOG_INFO = 2,    /**< a rare event: a choice made at creation, or growth of storage */
  MPM_LOG_DEBUG = 3    /**< a text in every step */
};

/** Remedy against volumetric locking: MPoint theory, eqs 47-53, carried to the deformation gradient. */
enum mpm_locking_value {
  MPM_LOCKING_NONE = 0, /**< there is no remedy */
  /** The law sees the dilation averaged over the cell, weighted by volume. Of sets whose law makes pressure
   * by shear ("drucker_prager", "mohr_coulomb", "cam_clay") that is the mean of such sets alone, and forces
   * have their pressure averaged over the cell, which does the same work (Hughes 1980). */
  MPM_LOCKING_CELL_AVERAGE = 1
};

/** Form of a law's tangent. The value is the number of components. See mpm_tangent_fn. */
enum mpm_tangent_value {
  MPM_TANGENT_MINOR_SYMMETRIC = 36, /**< 6 x 6 components, in Voigt's notation */
  MPM_TANGENT_GENERAL = 81          /**< 9 x 9 components */
};

/** Faces of the grid. */
enum mpm_face_value {
  MPM_X_MIN = 0, /**< lower face across x */
  MPM_X_MAX = 1, /**< upper face across x */
  MPM_Y_MIN = 2, /**< lower face across y */
  MPM_Y_MAX = 3, /**< upper face across y */
  MPM_Z_MIN = 4, /**< lower face across z */
  MPM_Z_MAX = 5  /**< upper face across z */
};

/** What a face of the grid does. */
enum mpm_wall_value {
  MPM_WALL_NONE = 0,  /**< default: a step in which a particle would leave fails with MPM_OFF_GRID; none with
                           total_lagrangian = 1, where "position" may leave the box */
  MPM_WALL_OPEN = 1,  /**< a particle that leaves is removed; refused with total_lagrangian = 1 */
  MPM_WALL_FIXED = 2, /**< velocities at the face are zero: it pushes and pulls */
  MPM_WALL_SLIP = 3,  /**< a symmetry plane: it pushes and pulls, without tangential force */
  /** the plane of the face as a fixed obstacle with Coulomb friction (obstacle.h): it pushes, never pulls.
   * What comes through between nodes, by less than half a cell, it stops particle by particle */
  MPM_WALL_FRICTION = 4,
  /** contact of the nodes on the face with Coulomb friction: MPM_WALL_FRICTION as it was in 0.1.0. Material
   * feels it about a cell and a half before its particles are there; with total_lagrangian = 1 it is that of
   * the material that was there */
  MPM_WALL_FRICTION_NODES = 5
};

/** What a surface prescribes of the motion of the material at its markers. See mpm_surface_desc. */
enum mpm_prescribes_value {
  MPM_PRESCRIBES_NOTHING = 0,  /**< default: the material carries the markers along */
  MPM_PRESCRIBES_VELOCITY = 1, /**< all components: the material sticks to the surface */
  MPM_PRESCRIBES_NORMAL = 2    /**< that along the area vector: the material slides without friction */
};

/** Where in an explicit step a node hook runs. */
enum mpm_stage_value {
  MPM_AFTER_P2G = 1,     /**< mass and velocity are projected, forces are not yet known */
  MPM_AFTER_FORCES = 2,  /**< internal and external forces are complete */
  MPM_AFTER_VELOCITY = 3 /**< velocity is updated, and walls and prescribed velocities have acted on it */
};

/** Access to mapped memory. The values may be combined with |. */
enum mpm_access_value {
  MPM_READ = 1, /**< the host reads */
  MPM_WRITE = 2 /**< the host writes */
};

/** Type of a field's elements. */
enum mpm_type_value {
  MPM_F64 = 1, /**< double */
  MPM_I64 = 2, /**< int64_t */
  MPM_U8 = 3   /**< uint8_t */
};

/** Order of the particles in mpm_particles_get_f32(). */
enum mpm_order_value {
  MPM_BY_ID = 1,        /**< by ascending id */
  MPM_LIBRARY_ORDER = 2 /**< as they lie in memory, without inert slots; changes when they are sorted anew */
};

/** Linear solver of an implicit step. */
enum mpm_solver_value {
  MPM_SOLVER_AUTO = 0,         /**< the library chooses by size, stencil, symmetry and inertia; with a
                                  transport as parallel.h says */
  MPM_SOLVER_CG = 1,           /**< conjugate gradients, for symmetric positive definite systems */
  MPM_SOLVER_MULTIGRID_CG = 2, /**< conjugate gradients with geometric multigrid, for the same systems */
  MPM_SOLVER_LDLT = 3,         /**< a direct solver, for symmetric systems that may be indefinite */
  MPM_SOLVER_GMRES = 4,        /**< GMRES, for systems that are not symmetric */
  MPM_SOLVER_HOST = 100        /**< the callback of mpm_stepper_set_linear_solver() */
};

/** A named number. The library reads the name during the call only. The struct is closed: it has no
 * struct_size and gets no further fields. */
typedef struct mpm_param {
  const char *name; /**< one of the names that mpm_material_model_param() lists */
  double value;     /**< the value, in the host's units */
} mpm_param;

/**
 * Memory of the library, lent to the host until mpm_view_release(). Component c of item i is
 * ((T *)data)[i * item_stride + c * component_stride], where T is the type that `type` names. The host sets
 * struct_size before the call that fills the view, and changes no field afterwards.
 */
typedef struct mpm_view {
  uint32_t struct_size;     /**< sizeof(mpm_view) of the caller */
  int32_t type;             /**< MPM_F64, MPM_I64 or MPM_U8 */
  int32_t components;       /**< stored components of an item; tensors may be compact, see particles.h */
  int32_t access;           /**< MPM_READ, MPM_WRITE or both, as asked for */
  int64_t count;            /**< number of items, inert slots included */
  int64_t item_stride;      /**< distance from item i to item i + 1, in elements */
  int64_t component_stride; /**< distance from component c to component c + 1, in elements */
  void *data;               /**< address of component 0 of item 0; NULL once released */
  void *owner;              /**< for the library's use; NULL once released */
} mpm_view;

/** The version of the library that runs, as 0xMMmmpp, to be compared with MPM_VERSION. May be called from any
 * thread at any time. */
MPM_API uint32_t mpm_version(void);

/** The name of a status constant, such as "MPM_E_ARG", or "unknown status" for any other value. The text is
 * static, and the pointer is never NULL. May be called from any thread at any time. */
MPM_API const char *mpm_status_name(mpm_status status);

/** What a status says, in a sentence without names and values: for calls that have no context to keep a text,
 * as those on NULL. Static, and never NULL: see mpm_last_error() for more. May be called from any thread at
 * any time. */
MPM_API const char *mpm_status_text(mpm_status status);

/**
 * Gives back the memory of a view that mpm_particles_map() or mpm_grid_map() filled. Afterwards its data and
 * owner are NULL. What the host wrote through a view with MPM_WRITE takes effect now. Memory of a view
 * without it is not to be changed: whatever is written there harms no step beyond its numbers, and a library
 * built with MPM_DEBUG notices.
 *
 * - MPM_E_ARG: view is NULL, or the host wrote values that are not finite or give det F <= 0. In the second
 *   case the view is released all the same, and the set refuses to step (MPM_E_STATE) until the values are
 *   repaired; bad nodal values are dropped.
 * - MPM_E_STATE: the view is not lent, or no longer; or, with MPM_DEBUG, it was lent for reading and its
 *   memory has changed: it is then released all the same. A view that was never filled has no context to keep
 *   a text.
 */
MPM_API mpm_status mpm_view_release(mpm_view *view);

#ifdef __cplusplus
}
#endif

#endif
