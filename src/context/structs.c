/* Versioned structs of hosts that were compiled against this release, an earlier or a later one: see
 * structs.h. */
#include <stddef.h>
#include <string.h>

#include "context/context.h"
#include "context/structs.h"

/* Every release of every versioned struct: the last field that it had, and its size on LP64. None of these
 * lines ever changes. A release that appends fields to a struct adds a line below that of the struct. */
#define RELEASES(X)                                                                                          \
  X(mpm_view, owner, 56)                                                                                     \
  X(mpm_context_desc, log_user, 72)                                                                          \
  X(mpm_context_desc, transport, 96)                                                                         \
  X(mpm_transport, user, 64)                                                                                 \
  X(mpm_parallel_info, seconds_reducing, 96)                                                                 \
  X(mpm_balance_desc, block_weight, 24)                                                                      \
  X(mpm_grid_desc, smoothing, 112)                                                                           \
  X(mpm_grid_desc, reserved, 120)                                                                            \
  X(mpm_material_batch, lookup, 144)                                                                         \
  X(mpm_material_desc, state_initial, 64)                                                                    \
  X(mpm_stepper_desc, projected_positions, 152)                                                              \
  X(mpm_stepper_desc, reserved, 176)                                                                         \
  X(mpm_step_info, angular_momentum, 192)                                                                    \
  X(mpm_step_info, damping_dissipation_total, 248)                                                           \
  X(mpm_contact_desc, direction, 72)                                                                         \
  X(mpm_contact_info, impulse, 160)                                                                          \
  X(mpm_contact_batch, pressure, 96)                                                                         \
  X(mpm_distance_batch, velocity, 64)                                                                        \
  X(mpm_obstacle_desc, upper, 296)                                                                           \
  X(mpm_surface_desc, modulus, 120)                                                                          \
  X(mpm_marker_batch, velocity, 88)                                                                          \
  X(mpm_adaption_desc, user, 72)                                                                             \
  X(mpm_adaption_info, angular_momentum_loss, 80)                                                            \
  X(mpm_adaption_batch, position, 56)                                                                        \
  X(mpm_heat_desc, user, 64)                                                                                 \
  X(mpm_heat_info, dissipated_total, 176)                                                                    \
  X(mpm_particle_batch, lookup, 104)                                                                         \
  X(mpm_node_batch, mass, 72)                                                                                \
  X(mpm_node_batch, owned, 80)                                                                               \
  X(mpm_advance_desc, max_steps, 56)                                                                         \
  X(mpm_profile, weights, 96)                                                                                \
  X(mpm_operator_info, position, 72)                                                                         \
  X(mpm_operator_info, number, 104)

#define END(type, last) (offsetof(type, last) + sizeof(((type *)0)->last))
/* Where pointers have 4 bytes, a struct may end with padding. */
#define BYTES(type, last)        ((END(type, last) + _Alignof(type) - 1) / _Alignof(type) * _Alignof(type))
#define ENTRY(type, last, bytes) {#type, BYTES(type, last)},
#define FROZEN(type, last, bytes)                                                                            \
  _Static_assert(sizeof(void *) != 8 || (END(type, last) == (bytes) && sizeof(type) >= (bytes)),             \
                 #type ": a field of a release has moved or gone");
RELEASES(FROZEN)
const mpmi_release mpmi_releases[] = {RELEASES(ENTRY){NULL, 0}};

/* Where the structs that hosts fill have a field called reserved. A release that gives one a meaning, and so
 * another name, takes its line away: it checks the values of that field then. */
#define RESERVED(X)                                                                                          \
  X(mpm_transport)                                                                                           \
  X(mpm_grid_desc)                                                                                           \
  X(mpm_material_desc)                                                                                       \
  X(mpm_stepper_desc)                                                                                        \
  X(mpm_surface_desc)                                                                                        \
  X(mpm_heat_desc)
#define PLACE(type) {#type, (uint32_t)offsetof(type, reserved)},
const mpmi_reserved mpmi_reserved_fields[] = {RESERVED(PLACE){NULL, 0}};

/* No struct of this interface comes near; more is a size that was never set. */
enum { LARGEST_STRUCT = 1 << 16 };

static uint32_t struct_size_of(const void *versioned) {
  uint32_t size;
  memcpy(&size, versioned, sizeof size);
  return size;
}

static uint32_t first_size(const mpmi_release *table, const char *name) {
  while (table->name && strcmp(table->name, name) != 0) ++table;
  return table->bytes;
}

/* The size of the latest release of a struct that is whole within so many bytes; 0 if none is. */
static uint32_t whole_size(const mpmi_release *table, const char *name, uint32_t bytes) {
  uint32_t whole = 0;
  for (; table->name; ++table)
    if (strcmp(table->name, name) == 0 && table->bytes <= bytes) whole = table->bytes;
  return whole;
}

uint32_t mpmi_first_size(const char *name) {
  return first_size(mpmi_releases, name);
}

/* Descriptors have an _init; other structs that hosts fill have none. */
static int32_t has_init(const char *name) {
  const size_t length = strlen(name);
  return length > 5 && strcmp(name + length - 5, "_desc") == 0;
}

static void copy_known(const void *desc, uint32_t whole, uint32_t known, void *out) {
  memset(out, 0, known);
  memcpy(out, desc, whole);
  memcpy(out, &known, sizeof known);
}

mpm_status mpmi_read_release(const mpmi_release *table, mpm_context *context, const char *name,
                             const void *desc, uint32_t known, void *out) {
  if (!desc) return mpmi_fail(context, MPM_E_ARG, "%s is NULL", name);
  const uint32_t given = struct_size_of(desc);
  const uint32_t whole = whole_size(table, name, given < known ? given : known);
  if (!whole || given > LARGEST_STRUCT)
    return mpmi_fail(context, MPM_E_ARG, "%s: struct_size is %u, must be at least %u (%s)", name, given,
                     first_size(table, name),
                     has_init(name) ? "call its _init first"
                                    : "it has no _init: zero it, then set struct_size to its sizeof");
  const unsigned char *bytes = desc;
  for (uint32_t i = whole; i < given; ++i)
    if (bytes[i])
      return mpmi_fail(context, MPM_E_UNSUPPORTED,
                       "%s sets a field that this version of the library does not know (byte %u of %u)", name,
                       i, given);
  copy_known(desc, whole, known, out);
  return MPM_OK;
}

/* What a newer host asks for by a field that is reserved here must not be ignored. */
static mpm_status check_reserved(mpm_context *context, const char *name, const void *given) {
  const mpmi_reserved *field = mpmi_reserved_fields;
  int32_t value = 0;
  while (field->name && strcmp(field->name, name) != 0) ++field;
  if (field->name) memcpy(&value, (const unsigned char *)given + field->at, sizeof value);
  if (!value) return MPM_OK;
  return mpmi_fail(
      context, MPM_E_UNSUPPORTED,
      "%s: reserved is %d, must be 0: this version of the library does not know what it asks for", name,
      (int)value);
}

mpm_status mpmi_read_struct(mpm_context *context, const char *name, const void *desc, uint32_t known,
                            void *out) {
  const mpm_status status = mpmi_read_release(mpmi_releases, context, name, desc, known, out);
  return status ? status : check_reserved(context, name, out);
}

void mpmi_read_known(const char *name, const void *desc, uint32_t known, void *out) {
  const uint32_t given = struct_size_of(desc);
  copy_known(desc, whole_size(mpmi_releases, name, given < known ? given : known), known, out);
}

mpm_status mpmi_check_out_struct(mpm_context *context, const char *name, uint32_t known, const void *out) {
  if (!out) return mpmi_fail(context, MPM_E_ARG, "%s is NULL", name);
  const uint32_t given = struct_size_of(out);
  if (given < sizeof given || given > LARGEST_STRUCT)
    return mpmi_fail(context, MPM_E_ARG, "%s: struct_size is %u, expected %u", name, given, known);
  return MPM_OK;
}

mpm_status mpmi_write_struct(mpm_context *context, const char *name, const void *value, uint32_t known,
                             void *out) {
  const mpm_status status = mpmi_check_out_struct(context, name, known, out);
  if (status) return status;
  const uint32_t given = struct_size_of(out);
  memcpy(out, value, given < known ? given : known);
  memcpy(out, &given, sizeof given);
  return MPM_OK;
}

mpm_status mpmi_init_release(const mpmi_release *table, const char *name, const void *defaults,
                             uint32_t known, void *out, uint32_t struct_size) {
  const uint32_t whole = whole_size(table, name, struct_size < known ? struct_size : known);
  if (!out || !whole || struct_size > LARGEST_STRUCT) return MPM_E_ARG;
  memset(out, 0, struct_size);
  memcpy(out, defaults, whole);
  memcpy(out, &struct_size, sizeof struct_size);
  return MPM_OK;
}

mpm_status mpmi_init_struct(const char *name, const void *defaults, uint32_t known, void *out,
                            uint32_t struct_size) {
  return mpmi_init_release(mpmi_releases, name, defaults, known, out, struct_size);
}
