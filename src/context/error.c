/* Texts for people: the last error, the log, and the names that someone may have meant. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "context/context.h"

mpm_status mpmi_fail(mpm_context *context, mpm_status status, const char *format, ...) {
  if (!context) return status;
  /* The text is formatted aside, because the old one may be among the arguments. */
  char text[MPMI_SENTENCE];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  char *to = context->text[context->kept == context->text[0]];
  memcpy(to, text, strlen(text) + 1);
  context->said = to;
  atomic_store(&context->error, to);
  return status;
}

void mpmi_forget(mpm_context *context) {
  if (context->said) atomic_store(&context->error, context->kept);
  context->said = NULL;
}

void mpmi_log(mpm_context *context, int32_t level, const char *format, ...) {
  if (!context->host.log) return;
  char text[MPMI_SENTENCE];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  context->host.log(context->host.log_user, level, text);
  mpmi_environment_mend();
}

const char *mpm_last_error(const mpm_context *context) {
  if (context && context->magic == MPMI_CONTEXT) return atomic_load(&context->error);
  return "there is no context to keep a text: a handle is NULL, destroyed or of another kind; "
         "mpm_status_text() says "
         "what the status means";
}

mpm_status mpm_set_last_error(mpm_context *context, mpm_status status, const char *text) {
  MPMI_ENTER_CONTEXT(context);
  if (status == MPM_OK)
    return mpmi_fail(context, MPM_E_ARG, "mpm_set_last_error: status is MPM_OK, which has no sentence");
  if (!text) return mpmi_fail(context, MPM_E_ARG, "mpm_set_last_error: text is NULL");
  return mpmi_fail(context, status, "%s", text);
}

enum { NAME_MAX_COMPARED = 63, NAMES_LISTED = 3 };

static size_t compared_length(const char *name) {
  size_t n = 0;
  while (n < NAME_MAX_COMPARED && name[n]) n++;
  return n;
}

/* The Levenshtein distance of the first 63 characters, computed in one row of its table. */
static int32_t edit_distance(const char *a, const char *b) {
  size_t na = compared_length(a), nb = compared_length(b);
  int32_t row[NAME_MAX_COMPARED + 1];
  for (size_t j = 0; j <= nb; ++j) row[j] = (int32_t)j;
  for (size_t i = 1; i <= na; ++i) {
    int32_t diagonal = row[0];
    row[0] = (int32_t)i;
    for (size_t j = 1; j <= nb; ++j) {
      int32_t best = diagonal + (a[i - 1] != b[j - 1]);
      if (row[j] + 1 < best) best = row[j] + 1;
      if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
      diagonal = row[j];
      row[j] = best;
    }
  }
  return row[nb];
}

/* A name that contains the other ("fluid" in "newtonian_fluid") is as near as one typing error. */
static int32_t name_distance(const char *wanted, const char *candidate) {
  if (wanted[0] && (strstr(candidate, wanted) || strstr(wanted, candidate))) return 1;
  return edit_distance(wanted, candidate);
}

void mpmi_nearest_names(const char *wanted, const char *const *candidates, int32_t count, char *buffer,
                        size_t capacity) {
  if (!capacity) return;
  buffer[0] = '\0';
  if (!wanted) wanted = "";
  int32_t nearest[NAMES_LISTED], distance[NAMES_LISTED], found = 0;
  for (int32_t i = 0; i < count; ++i) {
    int32_t d = name_distance(wanted, candidates[i]);
    int32_t place = found;
    while (place > 0 && distance[place - 1] > d) place--;
    if (place == NAMES_LISTED) continue;
    if (found < NAMES_LISTED) found++;
    for (int32_t k = found - 1; k > place; --k) {
      nearest[k] = nearest[k - 1];
      distance[k] = distance[k - 1];
    }
    nearest[place] = i;
    distance[place] = d;
  }
  size_t used = 0;
  for (int32_t k = 0; k < found; ++k) {
    const char *name = candidates[nearest[k]], *separator = k ? ", " : "";
    if (used + strlen(separator) + strlen(name) >= capacity) break;
    used += (size_t)snprintf(buffer + used, capacity - used, "%s%s", separator, name);
  }
}

mpm_status mpmi_refuse_name(mpm_context *context, const char *refusal, const char *wanted,
                            const char *const *candidates, int32_t count) {
  char nearest[256];
  mpmi_nearest_names(wanted, candidates, count, nearest, sizeof nearest);
  return mpmi_fail(context, MPM_E_NOT_FOUND, "%s \"%s\"; nearest: %s", refusal, wanted, nearest);
}
