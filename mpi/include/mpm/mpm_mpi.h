/**
 * @file mpm_mpi.h
 * libmpm-mpi, a companion of libmpm: one problem on the processes of an MPI communicator. It gives a context
 * its transport (parallel.h), and writes and reads files of all parts. Link with mpm-mpi (pkg-config).
 *
 * It takes MPI 3.0 or later and one context per process. Where a process has more than one thread
 * (mpm_context_desc.concurrency is not 1), MPI is to be started by MPI_Init_thread() with
 * MPI_THREAD_FUNNELED. All calls are made on the thread that started MPI, or with MPI_THREAD_SERIALIZED and
 * above on any one.
 *
 * The contract of mpm.h (status, structs, arrays) holds here too. Calls marked (collective) are made on all
 * processes of the communicator in the same order and with alike arguments, and return the same status on all
 * of them; if some fail, that of the lowest, whose sentence they all have.
 *
 * The library never ends the program: errors of MPI are statuses (MPM_E_CALLBACK). After one, processes may
 * wait for each other for ever, and the host ends them, by MPI_Abort(); the last saved state is there to go
 * on from. Where a call of MPI has no communicator, as MPI_Testsome(), some MPI ask the error handler of
 * MPI_COMM_WORLD, which ends the program unless the host has set another one.
 *
 * docs/distributed.md says how the parts work together, and how they are started.
 */
#ifndef MPM_MPI_H
#define MPM_MPI_H

#include <mpi.h>
#include <mpm/mpm.h>

/** Marks every exported function of libmpm-mpi. A host may define it before the first include. */
#ifndef MPM_MPI_API
#if defined(__GNUC__) || defined(__clang__)
#define MPM_MPI_API __attribute__((visibility("default")))
#else
#define MPM_MPI_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** A duplicate of a communicator, with buffers and requests. Serves one thread at a time. */
typedef struct mpm_mpi mpm_mpi;

/**
 * Joins the processes of comm (collective) and sets desc->transport to a transport between them, whose parts
 * are its ranks. It lives until mpm_mpi_close(), which comes after mpm_context_destroy(). desc is one that
 * mpm_context_desc_init() has filled; of it alloc and release are taken for the memory of this library, until
 * it is closed, and error_text and log for the sentence of a failure. On failure *out is NULL and desc
 * unchanged.
 *
 * - MPM_E_ARG: an argument is NULL or MPI_COMM_NULL, comm is an intercommunicator, or desc is of a size that
 *   has no transport yet.
 * - MPM_E_STATE: MPI is not started or ended already; or it has MPI_THREAD_FUNNELED, and this is not the
 *   thread that started it.
 * - MPM_E_UNSUPPORTED: MPI is older than 3.0, its level of threads does not go with concurrency or
 *   parallel_for, or processes differ in version or byte order.
 */
MPM_MPI_API mpm_status mpm_mpi_open(MPI_Comm comm, mpm_context_desc *desc, mpm_mpi **out);

/** Does as mpm_mpi_open() for a communicator of Fortran, or of any language that has its integer. */
MPM_MPI_API mpm_status mpm_mpi_open_f(MPI_Fint comm, mpm_context_desc *desc, mpm_mpi **out);

/** Leaves the processes and frees everything (collective), before MPI_Finalize(). NULL is fine. MPM_E_STATE:
 * an exchange is under way; or MPI has ended, which leaves nothing to keep: memory is freed all the same.
 * After a transport has failed it waits for nobody. */
MPM_MPI_API mpm_status mpm_mpi_close(mpm_mpi *mpi);

/** Gives one sentence on the last call that failed, here or of the transport, with the part that it comes
 * from; "" if there is none, and a sentence that says so if mpi is NULL. Valid until the next call. What the
 * library itself refuses on this part has its own sentence in mpm_last_error(). */
MPM_MPI_API const char *mpm_mpi_last_error(const mpm_mpi *mpi);

/** How files are written; zeros are the defaults. */
typedef struct mpm_mpi_output {
  uint32_t struct_size; /**< sizeof(mpm_mpi_output) of the caller */
  /** How many processes write, 1 to the number of parts; the others give them what they have. 0: one on each
   * machine, as MPI_COMM_TYPE_SHARED finds them. */
  int32_t writers;
  int32_t count;             /**< of fields; 0: every field in use, as for mpm_write_particles() */
  int32_t reserved;          /**< 0 */
  const char *const *fields; /**< [count] names; NULL with count 0 */
} mpm_mpi_output;

/**
 * Writes a set (collective) as VTK poly data in pieces. path ends with .pvtp and is an index; beside it
 * stands a folder of its name without the suffix, with a .vtp for each process that writes. Points are in
 * order of parts, and in each part by ascending id: the field "id" tells which is which. Files take the place
 * of old ones when they are complete, the index last; until then they have the suffix .writing. The folder is
 * to be the same on all machines. output may be NULL for the defaults.
 *
 * Errors are those of mpm_write_particles(); and MPM_E_ARG: path has another suffix, or writers is out of
 * range; MPM_E_UNSUPPORTED: fields that are in use on one part are not on another: name the fields.
 */
MPM_MPI_API mpm_status mpm_mpi_write_particles(mpm_mpi *mpi, const mpm_particles *set, const char *path,
                                               const mpm_mpi_output *output);

/**
 * Writes nodal fields of body 0 (collective) as VTK image data in pieces: path ends with .pvti, and each
 * process that writes has a layer of the box of all active nodes in a .vti. The image is that of
 * mpm_write_grid() on one part: nodes of several parts, which are alike on all of them, are there once, and
 * where no node is active values are zero. With fewer layers of cells than writers some of these have none.
 *
 * Errors are those of mpm_write_grid(), and of mpm_mpi_write_particles(); and MPM_E_UNSUPPORTED with open
 * knots, whose nodes are not evenly spaced: mpm_write_grid() writes those of a part into a .vtr. A successful
 * call changes mpm_last_error() too, which is of no meaning then.
 */
MPM_MPI_API mpm_status mpm_mpi_write_grid(mpm_mpi *mpi, mpm_stepper *stepper, const char *path,
                                          const mpm_mpi_output *output);

/** Writes the state into one file (collective) by MPI-IO: under the name path.writing, which is renamed when
 * all bytes are on disk, so that path holds the old state or the new one. On each part it takes memory for
 * what mpm_state_size() tells. Errors are those of mpm_state_save_file(). */
MPM_MPI_API mpm_status mpm_mpi_save(mpm_mpi *mpi, const mpm_stepper *stepper, const char *path);

/** Replaces the state by that of a file (collective) which any number of processes wrote by mpm_mpi_save(),
 * or one by mpm_state_save_file(). Errors are those of mpm_state_load_file(). */
MPM_MPI_API mpm_status mpm_mpi_load(mpm_mpi *mpi, mpm_stepper *stepper, const char *path);

#ifdef __cplusplus
}
#endif

#endif
