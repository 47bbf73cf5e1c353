/* A set in pieces. The library writes the file of each part through a callback; the first of those who share
 * a writer puts the heads together, with a piece for each part, and then the data one after another, as they
 * come. So nobody holds more than a head and what is under way. */
#include "head.h"

#include <stdlib.h>
#include <string.h>

enum { PIECE = 1 << 16 }; /* what mpm_write_fn gets at most */

typedef struct output {
  mpm_mpi *m;
  mpmx_place place;
  mpmx_file file; /* of a writer */
  mpmx_head head;
  int32_t met, refused; /* 1: all have their heads, or know that some have not; and then go no further */
  mpm_status status;
  int32_t members, member;
  int32_t first, shows;   /* the lowest part that has particles; 1: this part gives a piece */
  int64_t length, passed; /* of the data of this part: all, and those that have gone their way */
  int64_t *sizes;         /* of a writer: [2 members] bytes of head and data of each */
  char *heads;            /* and the heads one after another */
  unsigned char *piece;   /* and what comes from another part */
  int *writes;            /* [parts] number of the file that the part has written; -1: none */
  size_t sizes_bytes, heads_bytes;
} output;

/* Copies the element of a piece, with places in the data that begin `base` bytes later. */
static void copy_piece(mpmx_file *file, const char *head, int64_t base) {
  static const char last[] = "</Piece>\n", offset[] = " offset=\"";
  const char *at = strstr(head, "    <Piece "), *end = at ? strstr(at, last) : NULL;
  if (!end) return;
  end += strlen(last);
  for (const char *next; at < end; at = next) {
    const char *place = strstr(at, offset);
    next = place && place < end ? place + strlen(offset) : end;
    mpmx_file_write(file, at, (size_t)(next - at));
    if (next == end) break;
    mpmx_file_print(file, "%lld", (long long)(atoll(next) + base));
    next += strspn(next, "0123456789");
  }
}

static mpm_status open_file(output *o) {
  int64_t shown = 0;
  for (int32_t i = 0; i < o->members; ++i) shown += o->sizes[2 * i + 1];
  if (!shown) return MPM_OK;
  mpm_status status = mpmx_file_open(o->m, &o->file, o->place.piece);
  if (status) return status;
  mpmx_print_start(&o->file, "PolyData");
  mpmx_file_print(&o->file, "  <PolyData>\n");
  int64_t base = 0;
  const char *head = o->heads;
  for (int32_t i = 0; i < o->members; ++i) {
    copy_piece(&o->file, head, base);
    head += o->sizes[2 * i];
    base += o->sizes[2 * i + 1];
  }
  mpmx_file_print(&o->file, "  </PolyData>\n" MPMX_DATA_FOLLOW);
  return MPM_OK;
}

static mpm_status allocate(output *o) {
  mpm_mpi *m = o->m;
  o->writes = mpmx_alloc(m, (size_t)m->parts * sizeof *o->writes);
  if (!o->writes) return mpmx_fail(m, MPM_E_NOMEM, "there is no memory");
  if (o->member) return MPM_OK;
  o->sizes_bytes = (size_t)o->members * (2 * sizeof *o->sizes + 2 * sizeof(int));
  o->sizes = mpmx_alloc(m, o->sizes_bytes);
  o->piece = mpmx_alloc(m, PIECE);
  return o->sizes && o->piece ? MPM_OK : mpmx_fail(m, MPM_E_NOMEM, "there is no memory");
}

/* Sizes first, then heads, which have their ending zeros. */
static mpm_status gather_heads(output *o) {
  mpm_mpi *m = o->m;
  if (!o->shows) o->head.used = 0, o->head.text[0] = '\0';
  const int64_t size[2] = {(int64_t)o->head.used + 1, o->length};
  mpm_status status = mpmx_mpi(m, MPI_Gather(size, 2, MPI_INT64_T, o->sizes, 2, MPI_INT64_T, 0, m->group),
                               MPM_E_CALLBACK, "MPI_Gather");
  int *count = o->member ? NULL : (int *)(o->sizes + 2 * (size_t)o->members),
      *place = count ? count + o->members : NULL;
  if (!status && count) {
    for (int32_t i = 0; i < o->members; ++i) {
      count[i] = (int)o->sizes[2 * i];
      place[i] = (int)o->heads_bytes;
      o->heads_bytes += (size_t)count[i];
    }
    if (o->heads_bytes > INT32_MAX)
      status = mpmx_fail(m, MPM_E_UNSUPPORTED, "%d parts are too many for one writer: ask for more writers",
                         (int)o->members);
    else if (!(o->heads = mpmx_alloc(m, o->heads_bytes)))
      status = mpmx_fail(m, MPM_E_NOMEM, "there is no memory for %zu bytes", o->heads_bytes);
  }
  status = mpmx_agree(m, status);
  if (status) return status;
  return mpmx_mpi(
      m, MPI_Gatherv(o->head.text, (int)size[0], MPI_CHAR, o->heads, count, place, MPI_CHAR, 0, m->group),
      MPM_E_CALLBACK, "MPI_Gatherv");
}

/* Parts with particles must have the same arrays. Those without give no piece, unless nobody has any. */
static mpm_status compare_heads(output *o, int64_t points) {
  mpm_mpi *m = o->m;
  const int64_t hash = (int64_t)(mpmx_head_hash(&o->head) >> 2);
  int64_t most[3] = {INT64_MIN, INT64_MIN, 0};
  if (points) most[0] = hash, most[1] = -hash, most[2] = m->parts - m->part;
  const mpm_status status = mpmx_mpi(m, MPI_Allreduce(MPI_IN_PLACE, most, 3, MPI_INT64_T, MPI_MAX, m->comm),
                                     MPM_E_CALLBACK, "MPI_Allreduce");
  if (status) return status;
  o->first = most[2] ? m->parts - (int32_t)most[2] : 0;
  o->shows = points > 0 || o->first == m->part;
  if (most[2] && most[0] != -most[1])
    return mpmx_fail(m, MPM_E_UNSUPPORTED,
                     "the fields in use differ between the parts: name those that are to be written");
  return MPM_OK;
}

/* Each part comes here once: when it has its head, or has failed before. */
static mpm_status meet(output *o, mpm_status status) {
  mpm_mpi *m = o->m;
  o->met = 1;
  if (!status) status = allocate(o);
  char points[32] = "0";
  if (!status) {
    const char *piece = strstr(o->head.text, "<Piece ");
    if (piece) mpmx_attribute(piece, "NumberOfPoints", points, sizeof points);
    o->length = mpmx_head_data(&o->head, atoll(points));
  }
  status = mpmx_agree(m, status);
  if (!status) status = mpmx_agree(m, compare_heads(o, atoll(points)));
  if (!o->shows) o->length = 0;
  if (!status) status = mpmx_agree(m, gather_heads(o));
  if (!status) status = mpmx_agree(m, o->member ? MPM_OK : open_file(o));
  o->status = status;
  o->refused = status != MPM_OK;
  return status;
}

static mpm_status pass_on(output *o, const unsigned char *data, int64_t bytes) {
  mpm_mpi *m = o->m;
  /* the end of the file is not the data's */
  if (bytes > o->length - o->passed) bytes = o->length - o->passed;
  if (!bytes) return MPM_OK;
  o->passed += bytes;
  if (!o->member) {
    mpmx_file_write(&o->file, data, (size_t)bytes);
    return MPM_OK;
  }
  return mpmx_mpi(m, MPI_Send(data, (int)bytes, MPI_BYTE, 0, MPMX_TAG_STREAM, m->group), MPM_E_CALLBACK,
                  "MPI_Send");
}

static mpm_status take(void *user, const void *data, int64_t bytes) {
  output *o = user;
  const unsigned char *rest = data;
  if (!o->met) {
    int64_t taken;
    mpm_status status = mpmx_head_take(o->m, &o->head, data, bytes, &taken);
    if (!status && !o->head.whole) return MPM_OK;
    status = meet(o, status);
    if (status) return status;
    rest += taken;
    bytes -= taken;
  }
  if (!o->status) o->status = pass_on(o, rest, bytes);
  return o->status;
}

/* Of one after another, as much as its head has said. Nothing says that it has failed. */
static mpm_status take_others(output *o) {
  mpm_mpi *m = o->m;
  for (int32_t i = 1; i < o->members; ++i)
    for (int64_t got = 0; got < o->sizes[2 * i + 1];) {
      MPI_Status is;
      int n = 0;
      mpm_status status = mpmx_mpi(m, MPI_Recv(o->piece, PIECE, MPI_BYTE, i, MPMX_TAG_STREAM, m->group, &is),
                                   MPM_E_CALLBACK, "MPI_Recv");
      if (!status) status = mpmx_mpi(m, MPI_Get_count(&is, MPI_BYTE, &n), MPM_E_CALLBACK, "MPI_Get_count");
      if (status) return status;
      if (!n) break;
      mpmx_file_write(&o->file, o->piece, (size_t)n);
      got += n;
    }
  return MPM_OK;
}

/* Of those files that there are. */
static mpm_status write_index(output *o, int wrote) {
  mpm_mpi *m = o->m;
  mpmx_file index;
  mpm_status status = mpmx_mpi(m, MPI_Allgather(&wrote, 1, MPI_INT, o->writes, 1, MPI_INT, m->comm),
                               MPM_E_CALLBACK, "MPI_Allgather");
  if (status || m->part != o->first) return status;
  status = mpmx_file_open(m, &index, o->place.index);
  if (status) return status;
  mpmx_print_start(&index, "PPolyData");
  mpmx_file_print(&index, "  <PPolyData GhostLevel=\"0\">\n");
  mpmx_head_index(&o->head, "Points", &index);
  mpmx_head_index(&o->head, "PointData", &index);
  for (int32_t i = 0; i < m->parts; ++i) {
    if (o->writes[i] < 0) continue;
    mpmx_file_print(&index, "    <Piece");
    mpmx_print_source(&index, &o->place, o->writes[i], ".vtp");
  }
  mpmx_file_print(&index, "  </PPolyData>\n</VTKFile>\n");
  return mpmx_file_close(m, &index, 0);
}

static mpm_status write_all(output *o, const mpm_particles *set, const mpm_mpi_output *as) {
  mpm_mpi *m = o->m;
  mpm_status status = mpm_write_particles_to(set, take, o, as->count, as->fields);
  if (status && !o->met) {
    mpmx_fail(m, status, "mpm_write_particles_to: %s, %s", mpm_status_name(status), mpm_status_text(status));
    return meet(o, status);
  }
  if (o->refused) return o->status;
  if (!o->status) o->status = status;
  /* who waits for more hears that none comes */
  if (o->member && o->passed < o->length && o->status)
    MPI_Send(NULL, 0, MPI_BYTE, 0, MPMX_TAG_STREAM, m->group);
  const int wrote = o->file.stream ? m->writer : -1;
  if (o->file.stream) {
    status = take_others(o);
    if (!o->status) o->status = status;
    mpmx_file_print(&o->file, MPMX_DATA_END);
    status = mpmx_file_close(m, &o->file, o->status != MPM_OK);
    if (!o->status) o->status = status;
  }
  status = mpmx_agree(m, o->status);
  return status ? status : mpmx_agree(m, write_index(o, wrote));
}

mpm_status mpm_mpi_write_particles(mpm_mpi *m, const mpm_particles *set, const char *path,
                                   const mpm_mpi_output *given) {
  if (!m) return MPM_E_ARG;
  mpm_mpi_output as;
  output o = {.m = m};
  mpm_status status =
      mpmx_output_begin(m, set ? MPM_OK : mpmx_fail(m, MPM_E_ARG, "set is NULL"), given, path, &as);
  if (!status) status = mpmx_place_make(m, &o.place, path, ".pvtp", ".vtp");
  if (status) return status;
  int members = 0, member = 0;
  MPI_Comm_size(m->group, &members);
  MPI_Comm_rank(m->group, &member);
  o.members = members;
  o.member = member;
  status = write_all(&o, set, &as);
  mpmx_file_close(m, &o.file, 1);
  mpmx_head_free(m, &o.head);
  mpmx_free(m, o.sizes, o.sizes_bytes);
  mpmx_free(m, o.heads, o.heads_bytes);
  mpmx_free(m, o.piece, PIECE);
  mpmx_free(m, o.writes, (size_t)m->parts * sizeof *o.writes);
  mpmx_place_free(m, &o.place);
  return status;
}
