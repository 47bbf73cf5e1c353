/* Versioned structs of older and newer hosts and libraries, on a struct that has had three releases. Memory
 * of structs ends where struct_size says, so that a sanitizer sees every byte that is touched beyond. */
#include <check.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "context/structs.h"
#include "context/context.h"

typedef struct sample {
  uint32_t struct_size;
  int32_t kind;
  double value; /* the last of the first release */
  double appended;
  void (*callback)(void); /* the last of the second */
  int32_t choice;
  int32_t reserved;
} sample;
enum { FIRST = 16, SECOND = 32, THIRD = 40, LONGEST = 56 };
static const mpmi_release first[] = {{"other", 8}, {"sample", FIRST}, {NULL, 0}};
static const mpmi_release third[] = {{"other", 8},       {"sample", FIRST}, {"other", 24},
                                     {"sample", SECOND}, {"sample", THIRD}, {NULL, 0}};

static mpm_context *context;

static void open_context(void) {
  ck_assert_int_eq(mpm_context_create(NULL, &context), MPM_OK);
}

static void close_context(void) {
  ck_assert_int_eq(mpm_context_destroy(context), MPM_OK);
}

/* The fields that a struct of so many bytes has whole. */
static uint32_t whole(uint32_t bytes) {
  return bytes < FIRST ? 0 : bytes < SECOND ? FIRST : bytes < THIRD ? SECOND : THIRD;
}

/* A struct of so many bytes, every byte set up to `set` and zero beyond; to be freed. */
static unsigned char *host_struct(uint32_t bytes, uint32_t set) {
  unsigned char *memory = calloc(bytes, 1);
  ck_assert_ptr_nonnull(memory);
  memset(memory, 0x11, set < bytes ? set : bytes);
  memcpy(memory, &bytes, sizeof bytes);
  return memory;
}

/* A library of the third release reads structs of any size. */
START_TEST(reads) {
  ck_assert_uint_eq(sizeof(sample), THIRD);
  for (uint32_t bytes = sizeof bytes; bytes <= LONGEST; ++bytes) {
    unsigned char *given = host_struct(bytes, whole(bytes));
    sample out;
    memset(&out, 0x77, sizeof out);
    const mpm_status status = mpmi_read_release(third, context, "sample", given, sizeof out, &out);
    ck_assert_int_eq(status, bytes < FIRST ? MPM_E_ARG : MPM_OK);
    if (status) {
      ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "sample: struct_size is"));
      ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "at least 16"));
    } else {
      ck_assert_uint_eq(out.struct_size, sizeof out);
      ck_assert(!memcmp(&out.kind, given + 4, whole(bytes) - 4));
      for (uint32_t i = whole(bytes); i < sizeof out; ++i) ck_assert_uint_eq(((unsigned char *)&out)[i], 0);
    }
    free(given);
  }
}
END_TEST

/* Every byte beyond the last whole field is looked at, be it of a later release or of a field cut in half. */
START_TEST(unknown_fields) {
  for (uint32_t bytes = FIRST; bytes <= LONGEST; ++bytes)
    for (uint32_t set = whole(bytes); set < bytes; ++set) {
      unsigned char *given = host_struct(bytes, whole(bytes));
      sample out = {.value = 3.0};
      given[set] = 0x80;
      ck_assert_int_eq(mpmi_read_release(third, context, "sample", given, sizeof out, &out),
                       MPM_E_UNSUPPORTED);
      ck_assert_ptr_nonnull(strstr(mpm_last_error(context), "sample sets a field"));
      ck_assert(out.value == 3.0); /* a struct that is refused has not been read */
      free(given);
    }
}
END_TEST

/* A library of the first release, and hosts of the first and the third. */
START_TEST(older_library) {
  struct {
    uint32_t struct_size;
    int32_t kind;
    double value;
  } out;
  sample host = {.struct_size = FIRST, .kind = 2, .value = 4.0, .choice = 1};
  ck_assert_int_eq(mpmi_read_release(first, context, "sample", &host, sizeof out, &out), MPM_OK);
  ck_assert(out.struct_size == FIRST && out.kind == 2 && out.value == 4.0);
  host.struct_size = sizeof host;
  ck_assert_int_eq(mpmi_read_release(first, context, "sample", &host, sizeof out, &out), MPM_E_UNSUPPORTED);
  host.choice = 0;
  ck_assert_int_eq(mpmi_read_release(first, context, "sample", &host, sizeof out, &out), MPM_OK);
  memset(&host, 0x11, sizeof host);
  out.kind = 7;
  ck_assert_int_eq(mpmi_init_release(first, "sample", &out, sizeof out, &host, sizeof host), MPM_OK);
  ck_assert(host.struct_size == sizeof host && host.kind == 7 && host.value == 4.0);
  ck_assert(host.appended == 0.0 && !host.callback && host.choice == 0 && host.reserved == 0);
}
END_TEST

/* Sizes that no release has are refused where they lie below the first or are none that was ever set. */
START_TEST(bad_sizes) {
  const uint32_t bad[] = {0, 1, 4, FIRST - 1, (1 << 16) + 1, UINT32_MAX};
  sample host = {.kind = 1}, out;
  for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
    host.struct_size = bad[k];
    ck_assert_int_eq(mpmi_read_release(third, context, "sample", &host, sizeof out, &out), MPM_E_ARG);
    ck_assert_int_eq(mpmi_init_release(third, "sample", &out, sizeof out, &host, bad[k]), MPM_E_ARG);
    ck_assert(host.struct_size == bad[k] && host.kind == 1);
  }
  ck_assert_int_eq(mpmi_read_release(third, context, "sample", NULL, sizeof out, &out), MPM_E_ARG);
  ck_assert_int_eq(mpmi_init_release(third, "sample", &out, sizeof out, NULL, THIRD), MPM_E_ARG);
  host.struct_size = sizeof host;
  ck_assert_int_eq(mpmi_read_release(third, context, "no such", &host, sizeof out, &out), MPM_E_ARG);
}
END_TEST

/* The defaults, to a host of any size: no field in half, and not a byte beyond. */
START_TEST(fills) {
  sample defaults;
  memset(&defaults, 0x33, sizeof defaults);
  for (uint32_t bytes = FIRST; bytes <= LONGEST; ++bytes) {
    unsigned char *out = host_struct(bytes, bytes);
    ck_assert_int_eq(mpmi_init_release(third, "sample", &defaults, sizeof defaults, out, bytes), MPM_OK);
    ck_assert(!memcmp(out, &bytes, sizeof bytes));
    for (uint32_t i = sizeof bytes; i < bytes; ++i) ck_assert_uint_eq(out[i], i < whole(bytes) ? 0x33 : 0);
    sample read;
    ck_assert_int_eq(mpmi_read_release(third, context, "sample", out, sizeof read, &read), MPM_OK);
    free(out);
  }
}
END_TEST

/* Outputs end with the host's struct or the library's, and what is beyond stays. */
START_TEST(writes) {
  sample value;
  memset(&value, 0x33, sizeof value);
  for (uint32_t bytes = sizeof bytes; bytes <= LONGEST; ++bytes) {
    unsigned char *out = host_struct(bytes, bytes);
    ck_assert_int_eq(mpmi_check_out_struct(context, "sample", sizeof value, out), MPM_OK);
    ck_assert_int_eq(mpmi_write_struct(context, "sample", &value, sizeof value, out), MPM_OK);
    ck_assert(!memcmp(out, &bytes, sizeof bytes));
    for (uint32_t i = sizeof bytes; i < bytes; ++i) ck_assert_uint_eq(out[i], i < sizeof value ? 0x33 : 0x11);
    free(out);
  }
}
END_TEST

/* The table has every versioned struct: with its size in 0.1.0 as the first, and its present size as the
 * last. */
START_TEST(table) {
  static const struct {
    const char *name;
    uint32_t first;
    size_t now;
  } known[] = {{"mpm_view", 56, sizeof(mpm_view)},
               {"mpm_context_desc", 72, sizeof(mpm_context_desc)},
               {"mpm_grid_desc", 112, sizeof(mpm_grid_desc)},
               {"mpm_material_batch", 144, sizeof(mpm_material_batch)},
               {"mpm_material_desc", 64, sizeof(mpm_material_desc)},
               {"mpm_stepper_desc", 152, sizeof(mpm_stepper_desc)},
               {"mpm_step_info", 192, sizeof(mpm_step_info)},
               {"mpm_particle_batch", 104, sizeof(mpm_particle_batch)},
               {"mpm_node_batch", 72, sizeof(mpm_node_batch)},
               {"mpm_advance_desc", 56, sizeof(mpm_advance_desc)},
               {"mpm_profile", 96, sizeof(mpm_profile)},
               {"mpm_operator_info", 72, sizeof(mpm_operator_info)},
               {"mpm_contact_desc", 72, sizeof(mpm_contact_desc)},
               {"mpm_contact_info", 160, sizeof(mpm_contact_info)},
               {"mpm_contact_batch", 96, sizeof(mpm_contact_batch)},
               {"mpm_distance_batch", 64, sizeof(mpm_distance_batch)},
               {"mpm_obstacle_desc", 296, sizeof(mpm_obstacle_desc)},
               {"mpm_surface_desc", 120, sizeof(mpm_surface_desc)},
               {"mpm_marker_batch", 88, sizeof(mpm_marker_batch)},
               {"mpm_adaption_desc", 72, sizeof(mpm_adaption_desc)},
               {"mpm_adaption_info", 80, sizeof(mpm_adaption_info)},
               {"mpm_adaption_batch", 56, sizeof(mpm_adaption_batch)},
               {"mpm_heat_desc", 64, sizeof(mpm_heat_desc)},
               {"mpm_heat_info", 176, sizeof(mpm_heat_info)},
               {"mpm_transport", 64, sizeof(mpm_transport)},
               {"mpm_parallel_info", 96, sizeof(mpm_parallel_info)},
               {"mpm_balance_desc", 24, sizeof(mpm_balance_desc)}};
  const size_t count = sizeof known / sizeof *known;
  size_t found = 0;
  for (const mpmi_release *at = mpmi_releases; at->name; ++at) {
    size_t k = 0;
    while (k < count && strcmp(known[k].name, at->name) != 0) ++k;
    ck_assert_uint_lt(k, count);
    if (at->bytes == mpmi_first_size(at->name)) ++found;
  }
  ck_assert_uint_eq(found, count);
  for (size_t k = 0; k < count; ++k) {
    uint32_t last = 0;
    for (const mpmi_release *at = mpmi_releases; at->name; ++at) {
      if (strcmp(known[k].name, at->name) != 0) continue;
      ck_assert_uint_gt(at->bytes, last);
      last = at->bytes;
    }
    ck_assert_uint_eq(last, known[k].now);
    if (sizeof(void *) == 8) ck_assert_uint_eq(mpmi_first_size(known[k].name), known[k].first);
  }
}
END_TEST

static int32_t all_are(const unsigned char *bytes, size_t n, unsigned char value) {
  size_t same = 0;
  while (same < n && bytes[same] == value) ++same;
  return same == n;
}

/* The _init of every descriptor takes its first size and every larger one, and no smaller one. */
START_TEST(init_functions) {
  union {
    uint32_t struct_size;
    unsigned char byte[512];
    mpm_context_desc context;
    mpm_grid_desc grid;
    mpm_material_desc material;
    mpm_stepper_desc stepper;
    mpm_advance_desc advance;
    mpm_contact_desc contact;
    mpm_obstacle_desc obstacle;
    mpm_surface_desc surface;
    mpm_adaption_desc adaption;
    mpm_balance_desc balance;
    mpm_heat_desc heat;
  } d;
#define CHECK_INIT(name, at)                                                                                 \
  for (uint32_t bytes = 0; bytes < sizeof d; ++bytes) {                                                      \
    memset(&d, 0x11, sizeof d);                                                                              \
    const uint32_t least = mpmi_first_size(#name);                                                           \
    ck_assert_int_eq(name##_init(at, bytes), bytes < least ? MPM_E_ARG : MPM_OK);                            \
    if (bytes >= least) ck_assert_uint_eq(d.struct_size, bytes);                                             \
    const uint32_t written = bytes < least ? 0 : bytes;                                                      \
    ck_assert(all_are(d.byte + written, sizeof d - written, 0x11));                                          \
  }                                                                                                          \
  ck_assert_int_eq(name##_init(NULL, 512), MPM_E_ARG)
  CHECK_INIT(mpm_context_desc, &d.context);
  CHECK_INIT(mpm_grid_desc, &d.grid);
  CHECK_INIT(mpm_material_desc, &d.material);
  CHECK_INIT(mpm_stepper_desc, &d.stepper);
  CHECK_INIT(mpm_advance_desc, &d.advance);
  CHECK_INIT(mpm_contact_desc, &d.contact);
  CHECK_INIT(mpm_obstacle_desc, &d.obstacle);
  CHECK_INIT(mpm_surface_desc, &d.surface);
  CHECK_INIT(mpm_adaption_desc, &d.adaption);
  CHECK_INIT(mpm_balance_desc, &d.balance);
  CHECK_INIT(mpm_heat_desc, &d.heat);
}
END_TEST

/* What the host sets a field called reserved to is not ignored, and a struct that ends before it has none. */
START_TEST(reserved_fields) {
  union {
    mpm_transport transport;
    mpm_grid_desc grid;
    mpm_material_desc material;
    mpm_stepper_desc stepper;
    mpm_surface_desc surface;
    mpm_heat_desc heat;
  } d, read;
  int32_t checked = 0;
#define CHECK_RESERVED(name, at)                                                                             \
  memset(&d, 0, sizeof d);                                                                                   \
  (at)->struct_size = (uint32_t)sizeof *(at);                                                                \
  ck_assert_int_eq(mpmi_read_struct(context, #name, at, (uint32_t)sizeof *(at), &read), MPM_OK);             \
  (at)->reserved = -7;                                                                                       \
  ck_assert_int_eq(mpmi_read_struct(context, #name, at, (uint32_t)sizeof *(at), &read), MPM_E_UNSUPPORTED);  \
  ck_assert_ptr_nonnull(strstr(mpm_last_error(context), #name ": reserved is -7, must be 0"));               \
  (at)->struct_size = mpmi_first_size(#name);                                                                \
  ck_assert_int_eq(mpmi_read_struct(context, #name, at, (uint32_t)sizeof *(at), &read),                      \
                   offsetof(name, reserved) < mpmi_first_size(#name) ? MPM_E_UNSUPPORTED : MPM_OK);          \
  ++checked
  CHECK_RESERVED(mpm_transport, &d.transport);
  CHECK_RESERVED(mpm_grid_desc, &d.grid);
  CHECK_RESERVED(mpm_material_desc, &d.material);
  CHECK_RESERVED(mpm_stepper_desc, &d.stepper);
  CHECK_RESERVED(mpm_surface_desc, &d.surface);
  CHECK_RESERVED(mpm_heat_desc, &d.heat);
  int32_t listed = 0;
  while (mpmi_reserved_fields[listed].name) ++listed;
  ck_assert_int_eq(checked, listed);
  mpm_grid *grid = (mpm_grid *)(void *)&d;
  ck_assert_int_eq(mpm_grid_desc_init(&d.grid, sizeof d.grid), MPM_OK);
  d.grid.dim = 1;
  d.grid.cells[0] = 4;
  d.grid.spacing[0] = 0.25;
  d.grid.reserved = 1;
  ck_assert_int_eq(mpm_grid_create(context, &d.grid, &grid), MPM_E_UNSUPPORTED);
  ck_assert_ptr_null(grid);
}
END_TEST

TCase *abi_structs_case(void);
TCase *abi_structs_case(void) {
  TCase *structs = tcase_create("structs");
  tcase_add_checked_fixture(structs, open_context, close_context);
  if (sizeof(void *) == 8) {
    tcase_add_test(structs, reads);
    tcase_add_test(structs, unknown_fields);
    tcase_add_test(structs, older_library);
    tcase_add_test(structs, bad_sizes);
    tcase_add_test(structs, fills);
    tcase_add_test(structs, writes);
  }
  tcase_add_test(structs, table);
  tcase_add_test(structs, init_functions);
  tcase_add_test(structs, reserved_fields);
  return structs;
}
