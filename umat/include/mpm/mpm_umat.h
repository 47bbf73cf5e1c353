/**
 * @file mpm_umat.h
 * libmpm-umat, a companion of libmpm: a UMAT or a VUMAT, in the calling conventions of Abaqus, as a material.
 * The library takes the address of the subroutine, and so does not care who compiled it, from which language,
 * and whether it is linked or was loaded with dlopen(). The contract of mpm.h (status, structs, threads)
 * holds here too, with one exception: the memory of a material is the C library's, not the context's.
 *
 * docs/umat.md says how tensors, frames and arguments are carried over, and what to look out for.
 */
#ifndef MPM_UMAT_H
#define MPM_UMAT_H

#include <mpm/mpm.h>
#include <stddef.h>

/** Marks every exported function of libmpm-umat. A host may define it before the first include. */
#ifndef MPM_UMAT_API
#if defined(__GNUC__) || defined(__clang__)
#define MPM_UMAT_API __attribute__((visibility("default")))
#else
#define MPM_UMAT_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** What mpm_step_info.callback_status is after a subroutine has left its call. */
enum mpm_umat_value {
  MPM_UMAT_EXIT = -1001 /**< it has called XIT, XPLB_EXIT or STDB_ABQERR with LOP = -3 */
};

/**
 * The type of a UMAT as Fortran compilers see it: all arguments by reference, then the length of CMNAME. A
 * host that links one declares it with
 *
 *     extern mpm_umat_subroutine umat_;
 *
 * A UMAT in C must take cmname_length, too. Symmetric tensors have 11 22 33 12 13 23, with engineering shear
 * strains, and matrices are stored by columns.
 */
typedef void mpm_umat_subroutine(double *stress, double *statev, double *ddsdde, double *sse, double *spd,
                                 double *scd, double *rpl, double *ddsddt, double *drplde, double *drpldt,
                                 const double *stran, const double *dstran, const double *time,
                                 const double *dtime, const double *temp, const double *dtemp,
                                 const double *predef, const double *dpred, const char *cmname,
                                 const int *ndi, const int *nshr, const int *ntens, const int *nstatv,
                                 const double *props, const int *nprops, const double *coords,
                                 const double *drot, double *pnewdt, const double *celent,
                                 const double *dfgrd0, const double *dfgrd1, const int *noel, const int *npt,
                                 const int *layer, const int *kspt, const int *jstep, const int *kinc,
                                 size_t cmname_length);
/** The address of a UMAT. */
typedef mpm_umat_subroutine *mpm_umat_fn;

/**
 * The type of a VUMAT in double precision, likewise. Arrays are [components][nblock]: symmetric tensors have
 * 11 22 33 12 23 31 with tensor shear strains, deformation gradients 11 22 33 12 23 31 21 32 13.
 */
typedef void mpm_vumat_subroutine(
    const int *nblock, const int *ndir, const int *nshr, const int *nstatev, const int *nfieldv,
    const int *nprops, const int *lanneal, const double *step_time, const double *total_time,
    const double *dt, const char *cmname, const double *coord_mp, const double *char_length,
    const double *props, const double *density, const double *strain_inc, const double *rel_spin_inc,
    const double *temp_old, const double *stretch_old, const double *defgrad_old, const double *field_old,
    const double *stress_old, const double *state_old, const double *ener_intern_old,
    const double *ener_inelas_old, const double *temp_new, const double *stretch_new,
    const double *defgrad_new, const double *field_new, double *stress_new, double *state_new,
    double *ener_intern_new, double *ener_inelas_new, size_t cmname_length);
/** The address of a VUMAT. */
typedef mpm_vumat_subroutine *mpm_vumat_fn;

/** A UMAT or a VUMAT as a material. Fill the struct with mpm_umat_desc_init(). */
typedef struct mpm_umat_desc {
  uint32_t struct_size; /**< sizeof(mpm_umat_desc) of the caller */
  /** Number of state variables of the subroutine, 0 to 63; with stran 0 to 57. They are the first components
   * of the field "state"; then come STRAN, if it is kept, in the order of the field "stress" with engineering
   * shear strains, and the number of steps that the particle has made. */
  int32_t nstatv;
  int32_t nprops; /**< number of PROPS */
  /** The dimension of the grid, for COORDS; 0 (default): COORDS are zeros. It must be that of the grid, since
   * a law cannot ask; for mpm_material_update() it is 3. */
  int32_t dim;
  /** 1 (default): calls are made one at a time, in the whole process, as subroutines with SAVE or COMMON
   * need. 0: the subroutine may be called on several threads at once. */
  int32_t serial;
  /** 1: DDSDDE belongs to the Kirchhoff stress, as Abaqus's manual has it: (1/J) d(J stress)/d(strain).
   * 0 (default): to the Cauchy stress, as in most UMATs, which are written for small strains. UMAT only. */
  int32_t kirchhoff;
  int32_t stran; /**< 1: STRAN is kept, turned and summed; 0 (default): STRAN is zeros. UMAT only */
  /** 1: implicit steps difference the stresses, and do not look at DDSDDE. 0 (default): they take DDSDDE. A
   * VUMAT, which has none, is always differenced. */
  int32_t differenced;
  double density;               /**< mass per initial volume, > 0; the host must set it */
  const double *props;          /**< [nprops], copied */
  const double *statev_initial; /**< [nstatv] state of a new particle, copied; NULL (default): zeros */
  const char *cmname;           /**< CMNAME, up to 80 characters, copied; NULL (default): blanks */
  /** The largest elastic modulus that the subroutine will have, for uniaxial strain: it bounds the step of
   * explicit schemes. 0 (default): that of the unstressed particle with its initial state, for which the
   * subroutine is called when the material is made, with DTIME = 1 and COORDS = 0. */
  double wave_modulus;
  double celent;      /**< CELENT or charLength: the spacing of the grid, say; 0 by default */
  double temperature; /**< TEMP, the same for all particles; 0 by default */
  /** Takes a sentence on a particle, whose id it gives (-1: the one that asks for the modulus): that the
   * subroutine has called XIT, what it says by STDB_ABQERR, and, once for a material, that DDSDDE is beyond
   * wave_modulus. NULL (default): they are dropped. (mt) The text is valid during the call. */
  void (*message)(void *user, int64_t particle, const char *text);
  void *message_user; /**< first argument of message */
} mpm_umat_desc;

/** Fills desc with the defaults; the host must set density, and props as the subroutine needs them.
 * struct_size is sizeof(mpm_umat_desc) of the caller; no byte beyond is written. MPM_E_ARG: it is smaller
 * than the first released struct. Any thread, any time. */
MPM_UMAT_API mpm_status mpm_umat_desc_init(mpm_umat_desc *desc, uint32_t struct_size);

/**
 * Makes a material of a UMAT, which stays loaded while the material lives. desc is copied. *out is NULL
 * unless MPM_OK is returned; the material ends with mpm_material_destroy().
 *
 * With F_inc = V R the UMAT gets R stress R^T, DSTRAN = ln V and DROT = R; it is always called in three
 * dimensions, NTENS = 6. PNEWDT < 1 asks for a smaller step (MPM_CUT_DT). A stress or a state variable that
 * is not finite is MPM_NONFINITE with the id of the particle. XIT ends the step with MPM_E_CALLBACK. With
 * dt = 0 the UMAT is not called.
 *
 * MPM_E_ARG: a value is bad, or wave_modulus is 0 and the UMAT has no finite modulus > 0 for the unstressed
 * particle. MPM_E_STATE: the call is made by a subroutine. MPM_E_UNSUPPORTED: desc sets a field that this
 * version of the library does not know.
 */
MPM_UMAT_API mpm_status mpm_umat_material(mpm_context *context, mpm_umat_fn fn, const mpm_umat_desc *desc,
                                          mpm_material **out);

/**
 * Makes a material of a VUMAT in double precision, likewise. With F = R U at both ends of the step, stress
 * and strain increment are those seen by an observer who turns with R: R^T stress R, and R^T (ln V) R with
 * the R of the end and F_inc = V R_inc. Particles come in blocks of up to 32. Without wave_modulus the VUMAT
 * is asked for the stress of small strains at stepTime = totalTime = 0, as Abaqus does. kirchhoff and stran
 * are refused (MPM_E_UNSUPPORTED).
 */
MPM_UMAT_API mpm_status mpm_vumat_material(mpm_context *context, mpm_vumat_fn fn, const mpm_umat_desc *desc,
                                           mpm_material **out);

/** Leaves the UMAT or VUMAT that is being called on this thread, and never returns to it: what XIT of the
 * library's utilities does. What the subroutine has allocated stays so. Where none is being called it does
 * nothing. From a subroutine only, on the thread on which that was called. */
MPM_UMAT_API void mpm_umat_exit(void);

/** Gives a text to the message callback of the material whose subroutine is being called on this thread, with
 * the particle's id: what STDB_ABQERR of the library's utilities does. Where none is being called it does
 * nothing. From a subroutine only. */
MPM_UMAT_API void mpm_umat_message(const char *text);

#ifdef __cplusplus
}
#endif

#endif
