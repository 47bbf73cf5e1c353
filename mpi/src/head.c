#include "head.h"

#include <stdlib.h>
#include <string.h>

static mpm_status append(mpm_mpi *m, mpmx_head *head, const char *data, size_t bytes) {
  if (head->used + bytes + 1 > head->room) {
    const size_t room = 2 * (head->used + bytes) + 4096;
    char *text = mpmx_alloc(m, room);
    if (!text) return mpmx_fail(m, MPM_E_NOMEM, "there is no memory for %zu bytes", room);
    if (head->used) memcpy(text, head->text, head->used);
    mpmx_free(m, head->text, head->room);
    head->text = text;
    head->room = room;
  }
  memcpy(head->text + head->used, data, bytes);
  head->used += bytes;
  head->text[head->used] = '\0';
  return MPM_OK;
}

/* The mark may come in two pieces, so it is looked for in what has been put together. */
mpm_status mpmx_head_take(mpm_mpi *m, mpmx_head *head, const void *data, int64_t bytes, int64_t *taken) {
  const size_t before = head->used, mark = strlen(MPMX_DATA_FOLLOW);
  *taken = bytes;
  const mpm_status status = append(m, head, data, (size_t)bytes);
  if (status) return status;
  /* bytes of arrays behind the mark may be zeros, at which a search for a text would end */
  for (size_t i = before < mark ? 0 : before - mark; i + mark <= head->used && !head->whole; ++i) {
    if (memcmp(head->text + i, MPMX_DATA_FOLLOW, mark)) continue;
    *taken = (int64_t)(i + mark - before);
    head->used = i + mark;
    head->text[head->used] = '\0';
    head->whole = 1;
  }
  return MPM_OK;
}

void mpmx_head_free(mpm_mpi *m, mpmx_head *head) {
  mpmx_free(m, head->text, head->room);
  *head = (mpmx_head){0};
}

int32_t mpmx_attribute(const char *element, const char *name, char *value, size_t bytes) {
  const char *end = strchr(element, '>');
  const size_t length = strlen(name);
  for (const char *at = strstr(element, name); at && end && at < end; at = strstr(at + 1, name)) {
    if (at[-1] != ' ' || strncmp(at + length, "=\"", 2)) continue;
    const char *from = at + length + 2, *to = strchr(from, '"');
    if (!to) return 0;
    size_t n = (size_t)(to - from);
    if (n >= bytes) n = bytes - 1;
    memcpy(value, from, n);
    value[n] = '\0';
    return 1;
  }
  return 0;
}

int32_t mpmx_head_next(const char **at, const char *end, mpmx_array *out) {
  const char *element = strstr(*at, "<DataArray ");
  char number[32];
  if (!element || (end && element >= end)) return 0;
  *out = (mpmx_array){0};
  mpmx_attribute(element, "type", out->type, sizeof out->type);
  mpmx_attribute(element, "Name", out->name, sizeof out->name);
  if (mpmx_attribute(element, "NumberOfComponents", number, sizeof number)) out->components = atoi(number);
  if (mpmx_attribute(element, "offset", number, sizeof number)) out->offset = atoll(number);
  out->size = strcmp(out->type, "UInt8") ? 8 : 1;
  *at = element + 1;
  return 1;
}

uint64_t mpmx_head_hash(const mpmx_head *head) {
  uint64_t hash = MPMX_HASH;
  mpmx_array a;
  for (const char *at = head->text; mpmx_head_next(&at, NULL, &a);) {
    hash = mpmx_hash(hash, a.type, strlen(a.type));
    hash = mpmx_hash(hash, a.name, strlen(a.name));
    hash = mpmx_hash(hash, &a.components, sizeof a.components);
  }
  return hash;
}

int64_t mpmx_head_data(const mpmx_head *head, int64_t tuples) {
  int64_t end = 0;
  mpmx_array a;
  for (const char *at = head->text; mpmx_head_next(&at, NULL, &a);)
    end = a.offset + (int64_t)sizeof(uint64_t) + tuples * a.components * a.size;
  return end;
}

void mpmx_head_index(const mpmx_head *head, const char *section, mpmx_file *file) {
  char tag[40];
  snprintf(tag, sizeof tag, "<%s>", section);
  const char *at = strstr(head->text, tag);
  snprintf(tag, sizeof tag, "</%s>", section);
  const char *end = at ? strstr(at, tag) : NULL;
  mpmx_array a;
  mpmx_file_print(file, "    <P%s>\n", section);
  while (end && mpmx_head_next(&at, end, &a))
    mpmx_file_print(file, "      <PDataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\"/>\n", a.type,
                    a.name, (int)a.components);
  mpmx_file_print(file, "    </P%s>\n", section);
}

void mpmx_print_start(mpmx_file *file, const char *kind) {
  const uint16_t one = 1;
  uint8_t first_byte;
  memcpy(&first_byte, &one, 1);
  mpmx_file_print(file,
                  "<?xml version=\"1.0\"?>\n"
                  "<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt64\">\n",
                  kind, first_byte ? "LittleEndian" : "BigEndian");
}

void mpmx_print_source(mpmx_file *file, const mpmx_place *place, int32_t writer, const char *suffix) {
  mpmx_file_print(file, " Source=\"");
  mpmx_file_write(file, place->name, strlen(place->name));
  mpmx_file_write(file, "/", 1);
  mpmx_file_write(file, place->name, strlen(place->name));
  mpmx_file_print(file, "_%d%s\"/>\n", (int)writer, suffix);
}
