/* Versioned structs: public structs that begin with struct_size. Later releases append fields, and all-zero
 * bits of an appended field mean what was so before it. So the library meets structs of hosts that are older
 * or newer than itself. */
#ifndef MPMI_STRUCTS_H
#define MPMI_STRUCTS_H

#include <mpm/types.h>

/* One release of a versioned struct. */
typedef struct mpmi_release {
  const char *name; /* of the struct */
  uint32_t bytes;   /* its size in that release */
} mpmi_release;

/* Every release of every versioned struct, of one struct in ascending order. The last entry has no name. */
extern const mpmi_release mpmi_releases[];

/* The place of a field called reserved, in bytes from the beginning of its struct. */
typedef struct mpmi_reserved {
  const char *name; /* of the struct */
  uint32_t at;
} mpmi_reserved;

/* Those of all structs that mpmi_read_struct() reads. The last entry has no name. */
extern const mpmi_reserved mpmi_reserved_fields[];

/* The size of a struct in the first release that has it, below which a host's struct is refused. */
uint32_t mpmi_first_size(const char *name);

/* Reads a struct of the host into `out`, of `known` bytes. Fields that the host's struct does not have become
 * zero. A field that is cut in half by struct_size counts as one that it does not have. Bytes beyond the last
 * whole field that both know must be zero, and so must a field called reserved (MPM_E_UNSUPPORTED). `name` is
 * that of the struct, also for the error text. */
mpm_status mpmi_read_struct(mpm_context *context, const char *name, const void *desc, uint32_t known,
                            void *out);
/* The fields that both know of a struct that was refused with MPM_E_UNSUPPORTED. */
void mpmi_read_known(const char *name, const void *desc, uint32_t known, void *out);
/* Writes `value`, of `known` bytes, to the host's `out` as far as its struct_size, which stays, reaches. What
 * the host's struct has beyond stays as it was. */
mpm_status mpmi_write_struct(mpm_context *context, const char *name, const void *value, uint32_t known,
                             void *out);
/* The check that mpmi_write_struct makes, for calls that must know before they do anything. Nothing in an
 * output is needed, so any size that has room for struct_size will do. */
mpm_status mpmi_check_out_struct(mpm_context *context, const char *name, uint32_t known, const void *out);
/* Fills the host's descriptor of struct_size bytes, and no byte beyond, with the defaults; what it has beyond
 * the fields that the library knows becomes zero. */
mpm_status mpmi_init_struct(const char *name, const void *defaults, uint32_t known, void *out,
                            uint32_t struct_size);

/* These do the same for structs of a table other than mpmi_releases, which have no field called reserved. */
mpm_status mpmi_read_release(const mpmi_release *table, mpm_context *context, const char *name,
                             const void *desc, uint32_t known, void *out);
mpm_status mpmi_init_release(const mpmi_release *table, const char *name, const void *defaults,
                             uint32_t known, void *out, uint32_t struct_size);

#endif
