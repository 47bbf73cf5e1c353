#include "read_vtk.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "meet.h"

vtk_text vtk_load(const char *path) {
  vtk_text text = {0};
  FILE *in = fopen(path, "rb");
  if (!in) fprintf(stderr, "%s\n", path);
  MUST(in);
  MUST(!fseek(in, 0, SEEK_END));
  text.count = ftell(in);
  rewind(in);
  text.bytes = malloc((size_t)text.count + 1);
  MUST(text.bytes && fread(text.bytes, 1, (size_t)text.count, in) == (size_t)text.count);
  text.bytes[text.count] = '\0';
  fclose(in);
  static const char mark[] = "<AppendedData encoding=\"raw\">\n_";
  char *found = strstr(text.bytes, mark);
  if (found) text.data = found + strlen(mark);
  return text;
}

void vtk_drop(vtk_text *text) {
  free(text->bytes);
  *text = (vtk_text){0};
}

const char *vtk_element(const vtk_text *text, const char *name, int32_t n) {
  char tag[60];
  snprintf(tag, sizeof tag, "<%s ", name);
  const char *at = strstr(text->bytes, tag);
  for (int32_t i = 0; i < n && at; ++i) at = strstr(at + 1, tag);
  return at;
}

const char *vtk_attribute(const char *element, const char *name) {
  static char value[400];
  char wanted[60];
  snprintf(wanted, sizeof wanted, " %s=\"", name);
  const char *at = strstr(element, wanted);
  MUST(at && at < strchr(element, '>'));
  at += strlen(wanted);
  snprintf(value, sizeof value, "%.*s", (int)strcspn(at, "\""), at);
  return value;
}

const char *vtk_array(const vtk_text *text, const char *element, const char *name, int64_t *bytes) {
  char wanted[100];
  snprintf(wanted, sizeof wanted, " Name=\"%s\" ", name);
  const char *at = strstr(element, wanted);
  MUST(at && text->data);
  while (*at != '<') --at;
  const char *data = text->data + atoll(vtk_attribute(at, "offset"));
  uint64_t count;
  MUST(data + sizeof count <= text->bytes + text->count);
  memcpy(&count, data, sizeof count);
  MUST(data + sizeof count + count <= text->bytes + text->count);
  *bytes = (int64_t)count;
  return data + sizeof count;
}
