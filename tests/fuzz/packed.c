/* Packed particles that were damaged, cut, forged or made up: added whole, or refused with a sentence and
 * nothing changed. What was added can be stepped, and packed again. */
#include "change.h"
#include "io/state.h"

typedef struct world {
  fuzz_memory memory;
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *giver, *taker;
  mpm_stepper *stepper; /* holds the taker */
} world;

enum { SETUPS = 18, ROOM = 1 << 18 };

static mpm_particles *open_set(world *w) {
  mpm_particles *set;
  MUST(!mpm_particles_create(w->context, w->grid, w->material, &set));
  MUST(!mpm_particles_add_field(set, "colour", MPM_U8, 3));
  MUST(!mpm_particles_add_field(set, "grain", MPM_I64, 2));
  return set;
}

/* Dimension, law, kind of grid and what a stepper keeps follow from the number. */
static void open_world(world *w, int32_t setup) {
  static const struct {
    const char *model;
    int32_t count;
    mpm_param param[4];
  } laws[] = {{"j2", 4, {{"density", 1e3}, {"E", 1e5}, {"nu", 0.3}, {"yield_stress", 1e3}}},
              {"neo_hookean", 3, {{"density", 1e3}, {"E", 1e5}, {"nu", 0.3}}},
              {"snow", 3, {{"density", 1e3}, {"E", 1e5}, {"nu", 0.3}}},
              {"drucker_prager", 4, {{"density", 1e3}, {"E", 1e5}, {"nu", 0.3}, {"phi", 30.0}}},
              {"newtonian_fluid", 3, {{"density", 1e3}, {"bulk_modulus", 1e5}, {"viscosity", 1.0}}},
              {"rigid", 1, {{"density", 1e3}}}};
  static const int32_t per_cell[] = {2, 2, 2};
  const int32_t dim = 1 + setup % 3, kind = setup / 3;
  const double low[] = {0.3, 0.3, 0.3}, high[] = {1.0, 1.0, 0.8};
  mpm_grid_desc g;
  mpm_stepper_desc s;
  w->context = fuzz_context(&w->memory, 1);
  MUST(!mpm_grid_desc_init(&g, sizeof g));
  g.dim = dim;
  for (int32_t k = 0; k < dim; ++k) g.cells[k] = 8, g.spacing[k] = 0.25, g.periodic[k] = kind == 1 && !k;
  if (kind == 2 || kind == 3) g.basis = MPM_GIMP;
  g.total_lagrangian = kind == 1 && dim == 3;
  MUST(!mpm_grid_create(w->context, &g, &w->grid));
  MUST(!mpm_material_create(w->context, laws[kind].model, laws[kind].param, laws[kind].count, &w->material));
  w->giver = open_set(w);
  w->taker = open_set(w);
  MUST(!mpm_particles_fill_box(w->giver, low, high, per_cell, NULL, NULL));
  MUST(!mpm_stepper_desc_init(&s, sizeof s));
  s.reference_positions = kind == 0;
  s.locking_remedy = kind == 2 && dim > 1;
  MUST(!mpm_stepper_create(w->context, w->grid, &s, &w->stepper));
  /* the giver has the fields that the stepper keeps, and some that hosts use */
  const double force[] = {1.0, 2.0, 3.0};
  MUST(!mpm_stepper_add(w->stepper, w->giver));
  MUST(!mpm_stepper_add(w->stepper, w->taker));
  if (setup % 2) MUST(!mpm_particles_set_all(w->giver, "applied_force", MPM_F64, dim, force));
}

static void close_world(world *w) {
  MUST(!mpm_stepper_destroy(w->stepper));
  MUST(!mpm_particles_destroy(w->giver) && !mpm_particles_destroy(w->taker));
  MUST(!mpm_material_destroy(w->material));
  MUST(!mpm_grid_destroy(w->grid));
  fuzz_close(w->context, &w->memory);
}

/* All particles of a set, to be freed. */
static uint8_t *pack(const world *w, const mpm_particles *set, int64_t n, const int64_t *ids,
                     int64_t *bytes) {
  MUST(!mpm_particles_packed_size(set, n, bytes));
  uint8_t *packed = malloc((size_t)*bytes);
  MUST(!fuzz_status(w->context, mpm_particles_pack(set, n, ids, packed, *bytes)));
  return packed;
}

/* A header that belongs to the contents: without it few bytes would get past the checksum. */
static void seal(uint8_t *data, int64_t bytes) {
  mpmi_state_header header;
  mpmi_checksum sum;
  if (bytes < (int64_t)sizeof header || bytes % 8) return;
  memcpy(&header, data, sizeof header);
  header = mpmi_state_turn_header(header);
  mpmi_checksum_begin(&sum);
  mpmi_checksum_add(&sum, data + sizeof header, bytes - (int64_t)sizeof header);
  header.bytes = bytes;
  header.checksum = mpmi_checksum_end(&sum);
  header = mpmi_state_turn_header(header);
  memcpy(data, &header, sizeof header);
}

/* What the library does with particles that it has taken. */
static void use(world *w) {
  int64_t bytes, again_bytes, n = mpm_particles_count(w->taker);
  mpm_step_info info = {.struct_size = sizeof info};
  fuzz_finite(w->taker);
  uint8_t *all = pack(w, w->taker, n, NULL, &bytes);
  int64_t *ids = malloc(sizeof *ids * (size_t)(n + 1));
  MUST(!mpm_particles_get(w->taker, "id", MPM_I64, 1, n, NULL, ids));
  MUST(!mpm_particles_remove(w->taker, n, ids));
  MUST(!mpm_particles_unpack(w->taker, all, bytes));
  uint8_t *again = pack(w, w->taker, n, NULL, &again_bytes);
  MUST(bytes == again_bytes && !memcmp(all, again, (size_t)bytes));
  for (int32_t i = 0; i < 2; ++i) fuzz_status(w->context, mpm_step(w->stepper, 1e-4, &info));
  fuzz_finite(w->taker);
  free(all), free(again), free(ids);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static uint8_t packed[ROOM + 256];
  fuzz_input in = {data, data + size};
  world w;
  open_world(&w, fuzz_below(&in, SETUPS));
  const uint32_t how = fuzz_byte(&in);
  int64_t bytes, was_bytes, is_bytes, ids[] = {0, 3, 1};
  if (how % 8 < 6) { /* particles of this law, changed */
    uint8_t *good = pack(&w, w.giver, 1 + how / 8 % 3, ids, &bytes);
    MUST(bytes < ROOM);
    memcpy(packed, good, (size_t)bytes);
    free(good);
    while (fuzz_left(&in)) bytes = fuzz_change(&in, packed, bytes, ROOM);
  } else { /* the input itself */
    bytes = in.end - in.at;
    memcpy(packed, in.at, (size_t)bytes);
  }
  if (how % 8 != 5 && how % 8 != 6) seal(packed, bytes);
  uint8_t *exact = malloc((size_t)bytes + 1); /* reading past the end is noticed */
  memcpy(exact, packed, (size_t)bytes);
  uint8_t *was = pack(&w, w.taker, 0, ids, &was_bytes);
  w.memory.calls = 0;
  w.memory.fail_at = how >= 216 ? how - 215 : 0;
  const mpm_status status = fuzz_status(w.context, mpm_particles_unpack(w.taker, exact, bytes));
  w.memory.fail_at = 0;
  free(exact);
  if (status) {
    MUST(status == MPM_E_FORMAT || status == MPM_E_ARG || status == MPM_E_NOMEM);
    MUST(mpm_particles_count(w.taker) == 0);
    uint8_t *is = pack(&w, w.taker, 0, ids, &is_bytes); /* the same fields are in use */
    MUST(was_bytes == is_bytes && !memcmp(was, is, (size_t)is_bytes));
    free(is);
  }
  free(was);
  use(&w);
  close_world(&w);
  return 0;
}
