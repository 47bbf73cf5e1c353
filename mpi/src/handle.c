#include "handle.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *mpmx_alloc(mpm_mpi *m, size_t bytes) {
  /* the C library wants a multiple of the alignment */
  const size_t whole = (bytes / MPMX_ALIGNMENT + 1) * MPMX_ALIGNMENT;
  return m->alloc ? m->alloc(m->alloc_user, whole, MPMX_ALIGNMENT) : aligned_alloc(MPMX_ALIGNMENT, whole);
}

void mpmx_free(mpm_mpi *m, void *memory, size_t bytes) {
  if (!memory) return;
  if (m->release)
    m->release(m->alloc_user, memory, (bytes / MPMX_ALIGNMENT + 1) * MPMX_ALIGNMENT, MPMX_ALIGNMENT);
  else
    free(memory);
}

mpm_status mpmx_grow(mpm_mpi *m, mpmx_buffer *buffer, size_t bytes) {
  if (buffer->data && buffer->bytes >= bytes) return MPM_OK;
  mpmx_drop(m, buffer);
  const size_t wanted = bytes + bytes / 4;
  buffer->data = mpmx_alloc(m, wanted);
  if (!buffer->data) return mpmx_fail(m, MPM_E_NOMEM, "there is no memory for %zu bytes", wanted);
  buffer->bytes = wanted;
  return MPM_OK;
}

void mpmx_drop(mpm_mpi *m, mpmx_buffer *buffer) {
  mpmx_free(m, buffer->data, buffer->bytes);
  *buffer = (mpmx_buffer){0};
}

mpm_status mpmx_fail(mpm_mpi *m, mpm_status status, const char *format, ...) {
  const int used = snprintf(m->text, sizeof m->text, "part %d: ", (int)m->part);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(m->text + used, sizeof m->text - (size_t)used, format, arguments);
  va_end(arguments);
  return status;
}

mpm_status mpmx_mpi(mpm_mpi *m, int code, mpm_status status, const char *call) {
  if (code == MPI_SUCCESS) return MPM_OK;
  char said[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  if (MPI_Error_string(code, said, &length)) snprintf(said, sizeof said, "error %d", code);
  return mpmx_fail(m, status, "%s: %.300s", call, said);
}

mpm_status mpmx_agree(mpm_mpi *m, mpm_status status) {
  struct {
    mpm_status status;
    char text[MPMX_TEXT];
  } outcome = {.status = status};
  int first = status ? m->part : m->parts;
  mpm_status failed = mpmx_mpi(m, MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, m->comm),
                               MPM_E_CALLBACK, "MPI_Allreduce");
  if (failed || first == m->parts) return failed;
  memcpy(outcome.text, m->text, sizeof outcome.text);
  failed = mpmx_mpi(m, MPI_Bcast(&outcome, (int)sizeof outcome, MPI_BYTE, first, m->comm), MPM_E_CALLBACK,
                    "MPI_Bcast");
  if (failed) return failed;
  memcpy(m->text, outcome.text, sizeof outcome.text);
  return outcome.status;
}

mpm_status mpmx_agree_on(mpm_mpi *m, mpm_status status, uint64_t number, mpm_status unlike,
                         const char *sentence) {
  status = mpmx_agree(m, status);
  if (status) return status;
  const int64_t plain = (int64_t)(number >> 2);
  int64_t both[2] = {plain, -plain};
  status = mpmx_mpi(m, MPI_Allreduce(MPI_IN_PLACE, both, 2, MPI_INT64_T, MPI_MAX, m->comm), MPM_E_CALLBACK,
                    "MPI_Allreduce");
  if (!status && both[0] != -both[1]) status = mpmx_fail(m, unlike, "%s", sentence);
  return status;
}

uint64_t mpmx_hash(uint64_t hash, const void *data, size_t bytes) {
  const unsigned char *byte = data;
  for (size_t i = 0; i < bytes; ++i) hash = (hash ^ byte[i]) * 0x100000001b3u;
  return (hash ^ bytes) * 0x9e3779b97f4a7c15u;
}

int mpmx_type_make(int64_t bytes, mpmx_type *out) {
  *out = (mpmx_type){.type = MPI_BYTE, .count = (int)bytes};
  if (bytes <= MPMX_PIECE) return MPI_SUCCESS;
  MPI_Datatype piece, pieces;
  int length[] = {1, (int)(bytes % MPMX_PIECE)};
  MPI_Aint place[] = {0, (MPI_Aint)(bytes - bytes % MPMX_PIECE)};
  int code = MPI_Type_contiguous(MPMX_PIECE, MPI_BYTE, &piece);
  if (code) return code;
  code = MPI_Type_contiguous((int)(bytes / MPMX_PIECE), piece, &pieces);
  MPI_Type_free(&piece);
  if (code) return code;
  MPI_Datatype types[] = {pieces, MPI_BYTE};
  code = MPI_Type_create_struct(length[1] ? 2 : 1, length, place, types, &out->type);
  MPI_Type_free(&pieces);
  if (code) return code;
  out->count = out->made = 1;
  code = MPI_Type_commit(&out->type);
  if (code) mpmx_type_free(out);
  return code;
}

void mpmx_type_free(mpmx_type *type) {
  if (type->made) MPI_Type_free(&type->type);
  type->made = 0;
}
