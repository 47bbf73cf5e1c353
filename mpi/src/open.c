/* Joining and leaving the processes of a communicator. */
#include "handle.h"

#include <stdio.h>
#include <string.h>

#define HAS(desc, field) ((desc)->struct_size >= offsetof(mpm_context_desc, field) + sizeof((desc)->field))

/* What all processes must have alike, compared byte by byte. */
typedef struct identity {
  uint64_t byte_order, pointer, version, headers, message, transport;
} identity;

/* There is no handle yet that could keep a sentence: the host's memory and its log get it. */
static mpm_status tell(const mpm_context_desc *desc, mpm_status status, const char *text) {
  if (HAS(desc, error_bytes) && desc->error_text && desc->error_bytes)
    snprintf(desc->error_text, (size_t)desc->error_bytes, "%s", text);
  if (HAS(desc, log_user) && desc->log) desc->log(desc->log_user, MPM_LOG_WARNING, text);
  return status;
}

static identity identity_here(void) {
  return (identity){.byte_order = 0x0102030405060708u,
                    .pointer = sizeof(void *),
                    .version = mpm_version(),
                    .headers = MPM_VERSION,
                    .message = sizeof(mpm_message),
                    .transport = sizeof(mpm_transport)};
}

static mpm_status check_alike(mpm_mpi *m) {
  const identity here = identity_here();
  identity first = here;
  const mpm_status status =
      mpmx_mpi(m, MPI_Bcast(&first, (int)sizeof first, MPI_BYTE, 0, m->comm), MPM_E_CALLBACK, "MPI_Bcast");
  if (status || !memcmp(&first, &here, sizeof here)) return status;
  if (first.byte_order != here.byte_order || first.pointer != here.pointer)
    return mpmx_fail(m, MPM_E_UNSUPPORTED, "byte order or size of pointers is not that of part 0");
  return mpmx_fail(
      m, MPM_E_UNSUPPORTED,
      "this process runs libmpm 0x%06llx with libmpm-mpi 0x%06llx, part 0 runs 0x%06llx with 0x%06llx",
      (unsigned long long)here.version, (unsigned long long)here.headers, (unsigned long long)first.version,
      (unsigned long long)first.headers);
}

static mpm_status check_version(mpm_mpi *m) {
  int version = 0, minor = 0;
  const mpm_status status = mpmx_mpi(m, MPI_Get_version(&version, &minor), MPM_E_CALLBACK, "MPI_Get_version");
  if (status || version >= 3) return status;
  return mpmx_fail(m, MPM_E_UNSUPPORTED, "MPI is version %d.%d, 3.0 or later is needed", version, minor);
}

static mpm_status check_threads(mpm_mpi *m, const mpm_context_desc *desc) {
  int level = 0, is_main = 0;
  mpm_status status = mpmx_mpi(m, MPI_Query_thread(&level), MPM_E_CALLBACK, "MPI_Query_thread");
  if (!status) status = mpmx_mpi(m, MPI_Is_thread_main(&is_main), MPM_E_CALLBACK, "MPI_Is_thread_main");
  if (status) return status;
  if (level < MPI_THREAD_FUNNELED && (desc->concurrency != 1 || desc->parallel_for))
    return mpmx_fail(
        m, MPM_E_UNSUPPORTED,
        "concurrency is %d%s, but MPI was started for a single thread: let MPI_Init_thread() ask "
        "for MPI_THREAD_FUNNELED",
        (int)desc->concurrency, desc->parallel_for ? " with an executor" : "");
  if (level < MPI_THREAD_SERIALIZED && !is_main)
    return mpmx_fail(m, MPM_E_STATE,
                     "this is not the thread that started MPI, to which its level of threads "
                     "keeps all calls");
  return MPM_OK;
}

/* The error handler of the host's communicator would end the program where duplicating fails. */
static mpm_status duplicate(mpm_mpi *m, MPI_Comm comm) {
  MPI_Errhandler of_host;
  mpm_status status =
      mpmx_mpi(m, MPI_Comm_get_errhandler(comm, &of_host), MPM_E_CALLBACK, "MPI_Comm_get_errhandler");
  if (status) return status;
  MPI_Comm_set_errhandler(comm, MPI_ERRORS_RETURN);
  status = mpmx_mpi(m, MPI_Comm_dup(comm, &m->comm), MPM_E_CALLBACK, "MPI_Comm_dup");
  MPI_Comm_set_errhandler(comm, of_host);
  MPI_Errhandler_free(&of_host);
  if (status) return status;
  status = mpmx_mpi(m, MPI_Comm_set_errhandler(m->comm, MPI_ERRORS_RETURN), MPM_E_CALLBACK,
                    "MPI_Comm_set_errhandler");
  if (status) MPI_Comm_free(&m->comm);
  return status;
}

static void fill(mpm_mpi *m) {
  m->transport = (mpm_transport){.struct_size = sizeof m->transport,
                                 .part = m->part,
                                 .parts = m->parts,
                                 .send = mpmx_send,
                                 .receive = mpmx_receive,
                                 .reduce = mpmx_reduce,
                                 .gather = mpmx_gather,
                                 .poll = mpmx_poll,
                                 .user = m};
}

/* What a process refuses before it has met the others, all of them refuse. */
static mpm_status check_arguments(MPI_Comm comm, const mpm_context_desc *desc) {
  int started = 0, ended = 0, between = 0;
  MPI_Initialized(&started);
  MPI_Finalized(&ended);
  if (!HAS(desc, transport))
    return tell(desc, MPM_E_ARG,
                "mpm_mpi_open: struct_size of desc has no transport: call "
                "mpm_context_desc_init() of libmpm 0.2.0 or later");
  if (!started || ended)
    return tell(desc, MPM_E_STATE,
                started ? "mpm_mpi_open: MPI has ended" : "mpm_mpi_open: MPI is not started");
  if (comm == MPI_COMM_NULL) return tell(desc, MPM_E_ARG, "mpm_mpi_open: comm is MPI_COMM_NULL");
  if (MPI_Comm_test_inter(comm, &between) || between)
    return tell(desc, MPM_E_ARG, "mpm_mpi_open: comm is an intercommunicator");
  return MPM_OK;
}

mpm_status mpm_mpi_open(MPI_Comm comm, mpm_context_desc *desc, mpm_mpi **out) {
  if (out) *out = NULL;
  if (!desc || !out) return MPM_E_ARG;
  mpm_status status = check_arguments(comm, desc);
  if (status) return status;
  mpm_mpi here = {
      .comm = MPI_COMM_NULL, .group = MPI_COMM_NULL, .group_writers = -1, .alloc_user = desc->alloc_user};
  if (desc->alloc && desc->release) here.alloc = desc->alloc, here.release = desc->release;
  MPI_Comm_rank(comm, &here.part);
  MPI_Comm_size(comm, &here.parts);
  status = duplicate(&here, comm);
  if (status) return tell(desc, status, here.text);
  status = check_version(&here);
  if (!status) status = check_threads(&here, desc);
  status = mpmx_agree(&here, status);
  if (!status) status = mpmx_agree(&here, check_alike(&here));
  mpm_mpi *m = status ? NULL : mpmx_alloc(&here, sizeof *m);
  if (!status) status = mpmx_agree(&here, m ? MPM_OK : mpmx_fail(&here, MPM_E_NOMEM, "there is no memory"));
  if (status) {
    mpmx_free(&here, m, sizeof *m);
    MPI_Comm_free(&here.comm);
    return tell(desc, status, here.text);
  }
  *m = here;
  m->text[0] = '\0';
  fill(m);
  desc->transport = &m->transport;
  *out = m;
  return MPM_OK;
}

mpm_status mpm_mpi_open_f(MPI_Fint comm, mpm_context_desc *desc, mpm_mpi **out) {
  int started = 0, ended = 0;
  MPI_Initialized(&started);
  MPI_Finalized(&ended);
  return mpm_mpi_open(started && !ended ? MPI_Comm_f2c(comm) : MPI_COMM_NULL, desc, out);
}

mpm_status mpm_mpi_close(mpm_mpi *m) {
  if (!m) return MPM_OK;
  if (m->exchange.kind && !m->failed)
    return mpmx_fail(m, MPM_E_STATE, "close: the last exchange has not been received");
  int ended = 0;
  MPI_Finalized(&ended);
  mpmx_exchange_free(m);
  /* after a failure others may not come, and freeing a communicator may wait for them */
  mpm_status status = ended ? MPM_E_STATE : MPM_OK;
  if (!ended && !m->failed) {
    if (m->group != MPI_COMM_NULL) MPI_Comm_free(&m->group);
    status = MPI_Comm_free(&m->comm) ? MPM_E_CALLBACK : MPM_OK;
  }
  mpmx_free(m, m, sizeof *m);
  return status;
}

const char *mpm_mpi_last_error(const mpm_mpi *m) {
  return m ? m->text : "there is no mpm_mpi: error_text of the descriptor has the sentence of mpm_mpi_open()";
}
