#include "report.h"

#include <mpm/mpm_umat.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORD = 8, SENTENCE = 512 };

static int trimmed(const char *text, size_t length) {
  while (length && text[length - 1] == ' ') --length;
  return (int)length;
}

void mpmu_report(int lop, const char *text, size_t length, const int *integers, const double *reals,
                 const char *words) {
  char out[SENTENCE];
  const char *kind = lop == 1 ? "" : lop == -1 ? "warning: " : "error: ";
  size_t used = (size_t)snprintf(out, sizeof out, "%s", kind);
  const size_t end = (size_t)trimmed(text, length);
  for (size_t i = 0; i < end && used + 1 < sizeof out; ++i) {
    const char next = text[i] == '%' && i + 1 < end ? text[i + 1] : '\0';
    int more = 1;
    if (next == 'I' || next == 'i')
      more = snprintf(out + used, sizeof out - used, "%d", *integers++), ++i;
    else if (next == 'R' || next == 'r')
      more = snprintf(out + used, sizeof out - used, "%g", *reals++), ++i;
    else if (next == 'S' || next == 's')
      more = snprintf(out + used, sizeof out - used, "%.*s", trimmed(words, WORD), words), words += WORD, ++i;
    else
      out[used] = text[i];
    used += (size_t)more;
  }
  out[used < sizeof out ? used : sizeof out - 1] = '\0';
  mpm_umat_message(out);
  if (lop != -3) return;
  mpm_umat_exit();
  exit(EXIT_FAILURE);
}
