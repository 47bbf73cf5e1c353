/* What UMATs and VUMATs share: the description, and the way into a subroutine and out of it. */
#ifndef MPMU_SUBROUTINE_H
#define MPMU_SUBROUTINE_H

#include <mpm/mpm_umat.h>
#include <stdatomic.h>

enum { MPMU_CMNAME = 80, MPMU_STATES = 64, MPMU_SYM = 6 };

/* A material: the description with copies of its arrays. The last of the particle's states is the number of
 * steps that it has made. */
typedef struct mpmu_law {
  mpm_umat_desc desc;
  mpm_umat_fn umat;
  mpm_vumat_fn vumat;
  double *props;
  char cmname[MPMU_CMNAME];
  int32_t state_count;
  atomic_flag told; /* that DDSDDE is beyond wave_modulus */
} mpmu_law;

/* Places of states in the field "state". */
static inline int32_t mpmu_stran_of(const mpmu_law *law) {
  return law->desc.nstatv;
}
static inline int32_t mpmu_steps_of(const mpmu_law *law) {
  return law->state_count - 1;
}

/* Reads and checks a description and makes a law of it, which is released by mpmu_law_free(). `name` is that
 * of the public call, for sentences. */
mpm_status mpmu_law_make(mpm_context *context, const char *name, const mpm_umat_desc *desc, mpmu_law **out);
void mpmu_law_free(void *law);
/* Makes the material, or releases the law. */
mpm_status mpmu_law_hand_over(mpm_context *context, mpmu_law *law, mpm_stress_fn stress,
                              mpm_tangent_fn tangent, mpm_material **out);
/* Writes the wave speeds, and the stress and state that are there to where the subroutine is not called:
 * inert slots, and all of them with dt = 0. */
void mpmu_answer_of_state(const mpmu_law *law, const mpm_material_batch *batch);
/* Formats a sentence, and refuses with it. */
mpm_status mpmu_refuse(mpm_context *context, mpm_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* A call of a subroutine that is under way, for one particle after the other. */
typedef struct mpmu_call {
  const mpmu_law *law;
  int64_t particle;        /* id of the one that is looked at now */
  void (*run)(void *work); /* calls the subroutine; sets `particle` */
  void *work;
} mpmu_call;
/* Runs it, alone in the process where the law is serial. MPM_OK, or MPM_UMAT_EXIT once the subroutine has
 * left by mpm_umat_exit(); the host has been told then. */
mpm_status mpmu_enter(mpmu_call *call);
/* Whether a subroutine is being called on this thread. */
int mpmu_is_inside(void);

#endif
