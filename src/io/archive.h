/* An archive is a sequence of bytes with a checksum. One description writes and reads it: every call
 * writes what it is given, or reads it back, as the mode says. Everything starts at a multiple of 8 bytes. */
#ifndef MPMI_ARCHIVE_H
#define MPMI_ARCHIVE_H

#include "io/output.h"

typedef struct mpmi_checksum {
  uint64_t lane[4], words;
} mpmi_checksum;
void mpmi_checksum_begin(mpmi_checksum *sum);
void mpmi_checksum_add(mpmi_checksum *sum, const void *data, int64_t bytes); /* bytes: a multiple of 8 */
uint64_t mpmi_checksum_end(const mpmi_checksum *sum);

enum { MPMI_MEASURE, MPMI_TO_CHECKSUM, MPMI_TO_MEMORY, MPMI_TO_OUTPUT, MPMI_FROM_MEMORY };

typedef struct mpmi_archive {
  mpm_context *context;
  int32_t mode;
  mpm_status status;         /* the first failure, after which nothing more is done */
  int64_t at;                /* bytes written or read so far */
  unsigned char *to;         /* MPMI_TO_MEMORY */
  mpmi_output *output;       /* MPMI_TO_OUTPUT; it keeps its own errors */
  const unsigned char *from; /* MPMI_FROM_MEMORY */
  int64_t size;              /* how many bytes `from` has */
  mpmi_checksum checksum;    /* sum over what was written */
  const char *name;          /* for error texts: "the state" unless the caller says otherwise */
  char where[48];            /* the same: the part under way, "" or ending in a space */
} mpmi_archive;

void mpmi_archive_begin(mpmi_archive *a, mpm_context *context, int32_t mode);
/* Writes `bytes` bytes, filled up to a multiple of 8, or reads them back. */
void mpmi_archive_bytes(mpmi_archive *a, void *data, int64_t bytes);
/* The same of numbers with 8 bytes each, and with 4, which are little-endian in the archive. */
void mpmi_archive_words(mpmi_archive *a, void *data, int64_t bytes);
void mpmi_archive_halves(mpmi_archive *a, void *data, int64_t bytes);
/* Lends the next bytes while reading, or returns NULL after a failure. */
const void *mpmi_archive_take(mpmi_archive *a, int64_t bytes);
/* Writes a value of the setup, or reads it and fails unless it is that of the present setup. */
void mpmi_archive_same_int(mpmi_archive *a, const char *what, int64_t here);
void mpmi_archive_same_real(mpmi_archive *a, const char *what, double here);
void mpmi_archive_same_text(mpmi_archive *a, const char *what,
                            const char *here); /* of at most MPMI_TEXT - 1 characters */
enum { MPMI_TEXT = 48 };
/* Fails with MPM_E_FORMAT and says what is wrong, unless the archive has failed before. */
mpm_status mpmi_archive_damaged(mpmi_archive *a, const char *what);

#endif
