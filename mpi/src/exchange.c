/* Exchanges between parts. Known ones are received into memory that was asked for beforehand. In sparse ones
 * each part sends synchronously and takes what comes; when its own messages have been received it enters a
 * barrier, and when all have, nothing is under way any more: Hoefler, Siebert & Lumsdaine 2010, Scalable
 * communication protocols for dynamic sparse data exchange. */
#define _POSIX_C_SOURCE 200809L /* sched_yield() */
#include "handle.h"

#include <sched.h>
#include <stdlib.h>
#include <string.h>

static mpm_status broken(mpm_mpi *m, mpm_status status) {
  m->failed = status;
  return status;
}

static mpm_status check(mpm_mpi *m, int code, const char *call) {
  const mpm_status status = mpmx_mpi(m, code, MPM_E_CALLBACK, call);
  return status ? broken(m, status) : MPM_OK;
}

static MPI_Request *request(const mpmx_exchange *x) {
  return x->requests.data;
}

static mpm_message *message(const mpmx_exchange *x) {
  return x->in.data;
}

/* Where a status says that it has an error: of all that were waited for, what happened to one. */
static mpm_status check_all(mpm_mpi *m, int code, int count, const MPI_Status *status, const char *call) {
  int inner = code;
  if (code == MPI_ERR_IN_STATUS)
    for (int i = 0; i < count; ++i) {
      const int one = status[i].MPI_ERROR;
      if (one == MPI_SUCCESS || one == MPI_ERR_PENDING) continue;
      inner = one;
      break;
    }
  return check(m, inner, call);
}

static void forget_received(mpm_mpi *m) {
  mpmx_exchange *x = &m->exchange;
  for (int32_t i = 0; i < x->count && x->owned; ++i)
    mpmx_free(m, message(x)[i].data, (size_t)message(x)[i].bytes);
  x->count = x->owned = 0;
}

static mpm_status check_send(mpm_mpi *m, int32_t exchange, int32_t count, const mpm_message *out,
                             const int64_t *most) {
  if (m->exchange.kind) return mpmx_fail(m, MPM_E_STATE, "send: the last exchange has not been received");
  if (exchange != MPM_EXCHANGE_KNOWN && exchange != MPM_EXCHANGE_SPARSE)
    return mpmx_fail(m, MPM_E_ARG, "send: exchange is %d, must be 1 or 2", (int)exchange);
  if (count < 0 || count >= m->parts || (count && !out))
    return mpmx_fail(m, MPM_E_ARG, "send: %d messages, or out is NULL", (int)count);
  if (exchange == MPM_EXCHANGE_SPARSE ? most != NULL : count && !most)
    return mpmx_fail(m, MPM_E_ARG, "send: most belongs to known exchanges, and to all of them");
  for (int32_t i = 0; i < count; ++i) {
    const mpm_message *o = &out[i];
    if (o->part < 0 || o->part >= m->parts || o->part == m->part || (i && out[i - 1].part >= o->part))
      return mpmx_fail(m, MPM_E_ARG, "send: message %d is for part %d, of parts in ascending order", (int)i,
                       (int)o->part);
    if (o->bytes < 0 || (o->bytes && !o->data) || (most && most[i] < 0))
      return mpmx_fail(m, MPM_E_ARG, "send: %lld bytes for part %d", (long long)o->bytes, (int)o->part);
  }
  return MPM_OK;
}

static size_t rounded(int64_t bytes) {
  return ((size_t)bytes + MPMX_ALIGNMENT - 1) / MPMX_ALIGNMENT * MPMX_ALIGNMENT;
}

static mpm_status make_room(mpm_mpi *m, int32_t requests, int32_t messages) {
  mpmx_exchange *x = &m->exchange;
  const size_t n = (size_t)requests;
  mpm_status status = mpmx_grow(m, &x->requests, n * sizeof(MPI_Request));
  if (!status) status = mpmx_grow(m, &x->statuses, n * sizeof(MPI_Status));
  if (!status) status = mpmx_grow(m, &x->indices, n * sizeof(int));
  if (!status) status = mpmx_grow(m, &x->in, (size_t)messages * sizeof(mpm_message));
  return status;
}

static mpm_status start_receives(mpm_mpi *m, int32_t count, const mpm_message *out, const int64_t *most) {
  mpmx_exchange *x = &m->exchange;
  size_t bytes = 0;
  for (int32_t i = 0; i < count; ++i) bytes += rounded(most[i]);
  mpm_status status = mpmx_grow(m, &x->arena, bytes);
  if (status) return broken(m, status);
  unsigned char *to = x->arena.data;
  for (int32_t i = 0; i < count; ++i) {
    message(x)[i] = (mpm_message){.part = out[i].part, .data = to};
    mpmx_type type;
    status = check(m, mpmx_type_make(most[i], &type), "MPI_Type_create_struct");
    if (status) return status;
    status = check(
        m, MPI_Irecv(to, type.count, type.type, out[i].part, MPMX_TAG_KNOWN, m->comm, &request(x)[x->known]),
        "MPI_Irecv");
    mpmx_type_free(&type);
    if (status) return status;
    ++x->known;
    to += rounded(most[i]);
  }
  x->count = count;
  return MPM_OK;
}

static mpm_status start_sends(mpm_mpi *m, int32_t count, const mpm_message *out) {
  mpmx_exchange *x = &m->exchange;
  const int sparse = x->kind == MPM_EXCHANGE_SPARSE;
  const int tag = sparse ? MPMX_TAG_SPARSE + x->parity : MPMX_TAG_KNOWN;
  for (int32_t i = 0; i < count; ++i) {
    mpmx_type type;
    mpm_status status = check(m, mpmx_type_make(out[i].bytes, &type), "MPI_Type_create_struct");
    if (status) return status;
    MPI_Request *one = &request(x)[x->known + x->sends];
    status = check(
        m,
        (sparse ? MPI_Issend : MPI_Isend)(out[i].data, type.count, type.type, out[i].part, tag, m->comm, one),
        "MPI_Isend");
    mpmx_type_free(&type);
    if (status) return status;
    ++x->sends;
  }
  return MPM_OK;
}

mpm_status mpmx_send(void *user, int32_t exchange, int32_t count, const mpm_message *out,
                     const int64_t *most) {
  mpm_mpi *m = user;
  mpmx_exchange *x = &m->exchange;
  if (m->failed) return m->failed;
  mpm_status status = check_send(m, exchange, count, out, most);
  if (status) return status;
  forget_received(m);
  status = make_room(m, 2 * count, exchange == MPM_EXCHANGE_KNOWN ? count : m->parts);
  if (status) return broken(m, status);
  x->kind = exchange;
  x->known = x->sends = 0;
  x->barrier_entered = 0;
  x->finished = exchange == MPM_EXCHANGE_KNOWN && !count;
  x->open = 2 * count;
  x->owned = exchange == MPM_EXCHANGE_SPARSE;
  if (exchange == MPM_EXCHANGE_KNOWN) status = start_receives(m, count, out, most);
  return status ? status : start_sends(m, count, out);
}

/* ---- known */

static mpm_status take_size(mpm_mpi *m, int32_t i, const MPI_Status *status) {
  MPI_Count bytes = 0;
  const mpm_status failed = check(m, MPI_Get_elements_x(status, MPI_BYTE, &bytes), "MPI_Get_elements_x");
  message(&m->exchange)[i].bytes = (int64_t)bytes;
  return failed;
}

/* Takes what has come, with its size: a request that is done is not told of again. MPI_Waitall() would do for
 * the rest, but that of Open MPI 4.1 sometimes waits for ever where a message is in error. */
static mpm_status progress_known(mpm_mpi *m) {
  mpmx_exchange *x = &m->exchange;
  MPI_Status *status = x->statuses.data;
  int *index = x->indices.data, done = 0;
  const int code = MPI_Testsome(x->known + x->sends, request(x), &done, index, status);
  if (done == MPI_UNDEFINED) done = 0;
  mpm_status failed = check_all(m, code, done, status, "MPI_Testsome");
  for (int k = 0; k < done && !failed; ++k)
    if (index[k] < x->known) failed = take_size(m, index[k], &status[k]);
  x->open -= done;
  x->finished = !x->open;
  return failed;
}

/* ---- sparse */

static mpm_status take_one(mpm_mpi *m, const MPI_Status *found) {
  mpmx_exchange *x = &m->exchange;
  MPI_Count bytes = 0;
  mpm_status status = check(m, MPI_Get_elements_x(found, MPI_BYTE, &bytes), "MPI_Get_elements_x");
  if (status) return status;
  void *data = mpmx_alloc(m, (size_t)bytes);
  if (!data)
    return broken(m, mpmx_fail(m, MPM_E_NOMEM, "there is no memory for %lld bytes from part %d",
                               (long long)bytes, found->MPI_SOURCE));
  message(x)[x->count++] = (mpm_message){.part = found->MPI_SOURCE, .bytes = (int64_t)bytes, .data = data};
  mpmx_type type;
  status = check(m, mpmx_type_make((int64_t)bytes, &type), "MPI_Type_create_struct");
  if (status) return status;
  status = check(
      m, MPI_Recv(data, type.count, type.type, found->MPI_SOURCE, found->MPI_TAG, m->comm, MPI_STATUS_IGNORE),
      "MPI_Recv");
  mpmx_type_free(&type);
  return status;
}

/* One look at everything: what has come, whether all that this part sent has been received, whether all are
 * there. */
static mpm_status progress_sparse(mpm_mpi *m) {
  mpmx_exchange *x = &m->exchange;
  MPI_Status found;
  int there = 1, done = 0;
  while (there) {
    mpm_status status = check(
        m, MPI_Iprobe(MPI_ANY_SOURCE, MPMX_TAG_SPARSE + x->parity, m->comm, &there, &found), "MPI_Iprobe");
    if (!status && there) status = take_one(m, &found);
    if (status) return status;
  }
  if (x->barrier_entered) {
    const mpm_status status = check(m, MPI_Test(&x->barrier, &done, MPI_STATUS_IGNORE), "MPI_Test");
    x->finished = done;
    return status;
  }
  MPI_Status *all = x->statuses.data;
  mpm_status status =
      check_all(m, MPI_Testall(x->sends, request(x), &done, all), x->sends, all, "MPI_Testall");
  if (status || !done) return status;
  status = check(m, MPI_Ibarrier(m->comm, &x->barrier), "MPI_Ibarrier");
  x->barrier_entered = !status;
  return status;
}

static int by_part(const void *a, const void *b) {
  const mpm_message *m = a, *n = b;
  return (m->part > n->part) - (m->part < n->part);
}

/* ---- both */

static mpm_status progress(mpm_mpi *m) {
  return m->exchange.kind == MPM_EXCHANGE_KNOWN ? progress_known(m) : progress_sparse(m);
}

void mpmx_poll(void *user) {
  mpm_mpi *m = user;
  if (!m->failed && m->exchange.kind && !m->exchange.finished) progress(m);
}

mpm_status mpmx_receive(void *user, int32_t *count, const mpm_message **in) {
  mpm_mpi *m = user;
  mpmx_exchange *x = &m->exchange;
  if (m->failed) return m->failed;
  if (!count || !in) return mpmx_fail(m, MPM_E_ARG, "receive: count or in is NULL");
  if (!x->kind) return mpmx_fail(m, MPM_E_STATE, "receive: nothing was sent before");
  while (!x->finished) {
    const mpm_status status = progress(m);
    if (status) return status;
    /* where there are more processes than processors, those that are waited for want to run */
    if (!x->finished) sched_yield();
  }
  if (x->kind == MPM_EXCHANGE_SPARSE) {
    x->parity ^= 1;
    if (x->count) qsort(x->in.data, (size_t)x->count, sizeof(mpm_message), by_part);
  }
  x->kind = 0;
  *count = x->count;
  *in = x->in.data;
  return MPM_OK;
}

/* A wait that gives the processor to others: MPI itself may keep it, and where there are more processes than
 * processors a reduction would take as long as the system lets one of them run. */
static mpm_status wait_for(mpm_mpi *m, int code, MPI_Request *pending, const char *call) {
  mpm_status status = check(m, code, call);
  for (int done = 0; !status && !done;) {
    status = check(m, MPI_Test(pending, &done, MPI_STATUS_IGNORE), call);
    if (!done) sched_yield();
  }
  return status;
}

mpm_status mpmx_reduce(void *user, int32_t op, int64_t count, int64_t *values) {
  mpm_mpi *m = user;
  if (m->failed) return m->failed;
  if (m->exchange.kind) return mpmx_fail(m, MPM_E_STATE, "reduce: the last exchange has not been received");
  if ((op != MPM_REDUCE_MAX && op != MPM_REDUCE_SUM) || count < 0 || (count && !values))
    return mpmx_fail(m, MPM_E_ARG, "reduce: op %d, %lld values, or values is NULL", (int)op,
                     (long long)count);
  /* sums without a sign go round modulo 2^64 */
  for (int64_t done = 0, n; done < count; done += n) {
    n = count - done < MPMX_PIECE ? count - done : MPMX_PIECE;
    MPI_Request pending = MPI_REQUEST_NULL;
    const int code =
        MPI_Iallreduce(MPI_IN_PLACE, values + done, (int)n, op == MPM_REDUCE_SUM ? MPI_UINT64_T : MPI_INT64_T,
                       op == MPM_REDUCE_SUM ? MPI_SUM : MPI_MAX, m->comm, &pending);
    const mpm_status status = wait_for(m, code, &pending, "MPI_Iallreduce");
    if (status) return status;
  }
  return MPM_OK;
}

mpm_status mpmx_gather(void *user, int64_t value, int64_t *all) {
  mpm_mpi *m = user;
  if (m->failed) return m->failed;
  if (m->exchange.kind) return mpmx_fail(m, MPM_E_STATE, "gather: the last exchange has not been received");
  if (!all) return mpmx_fail(m, MPM_E_ARG, "gather: all is NULL");
  MPI_Request pending = MPI_REQUEST_NULL;
  const int code = MPI_Iallgather(&value, 1, MPI_INT64_T, all, 1, MPI_INT64_T, m->comm, &pending);
  return wait_for(m, code, &pending, "MPI_Iallgather");
}

/* Receives can be called off. What is being sent belongs to the library and is left to MPI. */
static void call_off(mpmx_exchange *x) {
  for (int32_t i = 0; i < x->known; ++i) {
    if (request(x)[i] == MPI_REQUEST_NULL) continue;
    MPI_Cancel(&request(x)[i]);
    MPI_Wait(&request(x)[i], MPI_STATUS_IGNORE);
  }
  for (int32_t i = x->known; i < x->known + x->sends; ++i)
    if (request(x)[i] != MPI_REQUEST_NULL) MPI_Request_free(&request(x)[i]);
}

void mpmx_exchange_free(mpm_mpi *m) {
  mpmx_exchange *x = &m->exchange;
  int ended = 0;
  MPI_Finalized(&ended);
  if (x->kind && !ended) call_off(x);
  forget_received(m);
  mpmx_drop(m, &x->requests);
  mpmx_drop(m, &x->statuses);
  mpmx_drop(m, &x->indices);
  mpmx_drop(m, &x->in);
  mpmx_drop(m, &x->arena);
}
