/* States that were damaged, cut, forged or made up: loaded whole, or refused with a sentence and nothing
 * changed. What was loaded can be stepped, shown and saved again. */
#include "../unit/old_format.h"
#include "change.h"

typedef struct world {
  fuzz_memory memory;
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material[2];
  mpm_particles *set[2];
  mpm_stepper *stepper;
} world;

enum { SETUPS = 12, ROOM = 1 << 20 };

static void build_sets(world *w, int32_t dim, int32_t filled) {
  const mpm_param params[] = {
      {"E", 1e5}, {"nu", 0.3}, {"density", 1e3}, {"yield_stress", 1e3}, {"hardening", 1e3}};
  const double low[2][3] = {{0.3, 0.3, 0.3}, {5.0, 0.3, 0.3}},
               high[2][3] = {{1.6, 1.6, 1.2}, {6.0, 1.0, 0.8}};
  const double speed[2][3] = {{3.0, 1.0, 0.5}, {-3.0, 0.0, 1.0}};
  const int32_t per_cell[] = {2, 2, 2};
  const uint8_t colour[] = {1, 2, 3};
  for (int32_t m = 0; m < 2; ++m) {
    MUST(!mpm_material_create(w->context, m ? "j2" : "neo_hookean", params, m ? 5 : 3, &w->material[m]));
    MUST(!mpm_particles_create(w->context, w->grid, w->material[m], &w->set[m]));
    if (!filled) continue;
    MUST(!mpm_particles_fill_box(w->set[m], low[m], high[m], per_cell, NULL, NULL));
    MUST(!mpm_particles_set_all(w->set[m], "velocity", MPM_F64, dim, speed[m]));
  }
  MUST(!mpm_particles_add_field(w->set[0], "colour", MPM_U8, 3));
  MUST(!mpm_particles_add_field(w->set[1], "grain", MPM_I64, 2));
  if (filled) MUST(!mpm_particles_set_all(w->set[0], "colour", MPM_U8, 3, colour));
}

/* Dimension, transfer, periodic axis, reference positions and number of steps follow from the number. */
static void open_world(world *w, int32_t setup, int32_t filled) {
  const int32_t dim = 1 + setup % 3, kind = setup / 3;
  static const int32_t transfer[] = {MPM_FLIP, MPM_APIC, MPM_APIC_MLS, MPM_FLIP};
  mpm_grid_desc g;
  mpm_stepper_desc s;
  w->context = fuzz_context(&w->memory, 1);
  MUST(!mpm_grid_desc_init(&g, sizeof g));
  g.dim = dim;
  for (int32_t k = 0; k < dim; ++k)
    g.cells[k] = 16 - 4 * k, g.spacing[k] = 0.5, g.periodic[k] = kind == 1 && !k;
  if (kind == 3) g.basis = MPM_LINEAR;
  MUST(!mpm_grid_create(w->context, &g, &w->grid));
  build_sets(w, dim, filled);
  MUST(!mpm_stepper_desc_init(&s, sizeof s));
  s.transfer = transfer[kind];
  s.scheme = kind == 2 ? MPM_MUSL : MPM_USL;
  s.reference_positions = kind == 3;
  s.gravity[0] = 1.0;
  MUST(!mpm_stepper_create(w->context, w->grid, &s, &w->stepper));
  mpm_contact_desc contact;
  MUST(!mpm_contact_desc_init(&contact, sizeof contact));
  contact.friction = 0.2;
  for (int32_t m = 0; m < 2; ++m) MUST(!mpm_stepper_add(w->stepper, w->set[m]));
  if (kind == 1) {
    MUST(!mpm_stepper_set_body(w->stepper, w->set[0], 3));
    MUST(!mpm_stepper_set_contact(w->stepper, 0, 3, &contact));
  }
  for (int32_t face = kind == 1 ? 2 : 0; face < 2 * dim; ++face)
    MUST(!mpm_stepper_set_wall(w->stepper, face, 1 + (setup + face) % 4, 0.3));
  for (int32_t i = 0; i < kind; ++i) MUST(!mpm_step(w->stepper, 1e-3, NULL));
}

static void close_world(world *w) {
  MUST(!mpm_stepper_destroy(w->stepper));
  for (int32_t m = 0; m < 2; ++m) MUST(!mpm_particles_destroy(w->set[m]));
  for (int32_t m = 0; m < 2; ++m) MUST(!mpm_material_destroy(w->material[m]));
  MUST(!mpm_grid_destroy(w->grid));
  fuzz_close(w->context, &w->memory);
}

static uint64_t hash_of(const world *w) {
  uint64_t hash;
  MUST(!mpm_state_hash(w->stepper, &hash));
  return hash;
}

/* A header that belongs to the contents: without it few bytes would get past the checksum. */
static void seal(uint8_t *state, uint32_t format, int64_t bytes) {
  if (bytes >= (int64_t)sizeof(mpmi_state_header) && bytes % 8 == 0) seal_state(state, format, bytes);
}

/* ---- pieces -------------------------------------------------------------------------------------------- */
/* Makes the state of an empty problem a sorted one without blocks. Returns its bytes. */
static int64_t make_sorted(const world *w, uint8_t *state, int64_t bytes) {
  const int64_t none = 0;
  mpmi_state_numbers numbers;
  memset(&numbers, 0, sizeof numbers);
  mpmi_archive setup, all;
  mpmi_archive_begin(&setup, w->context, MPMI_MEASURE);
  mpmi_state_setup(&setup, w->stepper, MPMI_STATE_FORMAT, NULL);
  mpmi_archive_begin(&all, w->context, MPMI_MEASURE);
  mpmi_state_archive_numbers(&all, MPMI_STATE_FORMAT, &numbers);
  uint8_t *at = state + sizeof(mpmi_state_header) + setup.at;
  memcpy(at + offsetof(mpmi_state_numbers, blocks), &none, sizeof none);
  at += all.at;
  for (int32_t m = 0; m < 2; ++m, at += sizeof(mpmi_state_set_numbers))
    memcpy(at + offsetof(mpmi_state_set_numbers, dirty), &none, sizeof none);
  for (int32_t m = 0; m < 2; ++m, bytes += 8) memcpy(state + bytes, &none, sizeof none);
  return bytes;
}

/* Gives a state an end and the header of a piece; one that is cut or not of whole words stays as it is. */
static int64_t seal_piece(uint8_t *state, int64_t bytes, uint32_t format, int64_t number, int64_t of) {
  if (bytes < (int64_t)sizeof(mpmi_state_header) || bytes % 8) return bytes;
  const mpmi_state_end end = {number, of, 7};
  memcpy(state + bytes, &end, sizeof end);
  bytes += (int64_t)sizeof end;
  seal_state(state, format, bytes);
  memcpy(state, MPMI_PIECE_MAGIC, 8);
  return bytes;
}

/* Loads a state as one of two pieces, of which the other has no particles, or as the only one. */
static mpm_status load_in_pieces(world *w, int32_t setup, const uint8_t *state, int64_t bytes,
                                 uint32_t format, uint32_t how) {
  enum { MORE = 64 };
  const int64_t of = how % 4 ? 2 : 1, second = how % 2;
  uint8_t *piece[2] = {malloc((size_t)bytes + MORE), NULL};
  int64_t length[2] = {bytes, 0};
  memcpy(piece[0], state, (size_t)bytes);
  if (how % 8 != 5) length[0] = seal_piece(piece[0], bytes, format, second && of > 1, of);
  if (of > 1) {
    world empty;
    open_world(&empty, setup, 0);
    MUST(!mpm_state_size(empty.stepper, &length[1]));
    piece[1] = malloc((size_t)length[1] + MORE);
    MUST(!mpm_state_save(empty.stepper, piece[1], length[1]));
    if (how / 4 % 2) length[1] = make_sorted(&empty, piece[1], length[1]);
    length[1] = seal_piece(piece[1], length[1], MPMI_STATE_FORMAT, !second, of);
    close_world(&empty);
  }
  for (int32_t i = 0; i < 2 && piece[i]; ++i) /* reading past the end is noticed */
    piece[i] = realloc(piece[i], (size_t)length[i] + 1);
  const void *given[] = {piece[second && of > 1], piece[!second]};
  const int64_t given_bytes[] = {length[second && of > 1], length[!second]};
  w->memory.calls = 0;
  w->memory.fail_at = how >= 240 ? how - 239 : 0;
  const mpm_status status =
      fuzz_status(w->context, mpm_state_load_pieces(w->stepper, (int32_t)of, given, given_bytes));
  w->memory.fail_at = 0;
  free(piece[0]), free(piece[1]);
  return status;
}

/* ---- what the library does with a state that it has taken ---------------------------------------------- */
static void use(world *w, int32_t steps) {
  mpm_view view = {.struct_size = sizeof view};
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_advance_desc go;
  double dt;
  for (int32_t m = 0; m < 2; ++m) fuzz_finite(w->set[m]);
  fuzz_status(w->context, mpm_stable_dt(w->stepper, &dt));
  fuzz_status(w->context, mpm_stepper_info(w->stepper, &info));
  for (int32_t i = 0; i < steps; ++i) {
    const uint64_t before = hash_of(w);
    if (fuzz_status(w->context, mpm_step(w->stepper, 1e-3, &info))) MUST(hash_of(w) == before);
    for (int32_t m = 0; m < 2; ++m) fuzz_finite(w->set[m]);
  }
  if (steps < 2) return;
  if (!fuzz_status(w->context, mpm_grid_map(w->stepper, 0, "velocity", MPM_READ, &view)))
    MUST(!mpm_view_release(&view));
  MUST(!mpm_advance_desc_init(&go, sizeof go));
  go.t_end = info.t + 1e-3;
  go.max_steps = 3;
  fuzz_status(w->context, mpm_advance(w->stepper, &go, &info));
  int64_t bytes;
  if (fuzz_status(w->context, mpm_state_size(w->stepper, &bytes))) return;
  void *again = malloc((size_t)bytes);
  const uint64_t hash = hash_of(w);
  if (!fuzz_status(w->context, mpm_state_save(w->stepper, again, bytes))) {
    MUST(mpm_state_load(w->stepper, again, bytes) == MPM_OK); /* what it saves it can load */
    MUST(hash_of(w) == hash);
  }
  free(again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static uint8_t state[ROOM + 256];
  fuzz_input in = {data, data + size};
  world w;
  const int32_t setup = fuzz_below(&in, SETUPS);
  open_world(&w, setup, 1);
  const uint32_t how = fuzz_byte(&in), format = how / 8 % 4 ? MPMI_STATE_FORMAT : 2;
  int64_t bytes;
  if (how % 8 < 6) { /* a state of this setup, changed */
    MUST(!mpm_state_size(w.stepper, &bytes) && bytes < ROOM);
    MUST(!mpm_state_save(w.stepper, state, bytes));
    if (format == 2) bytes = contents_of_format_2(w.stepper, state, bytes);
    while (fuzz_left(&in)) bytes = fuzz_change(&in, state, bytes, ROOM);
  } else { /* the input itself */
    bytes = in.end - in.at;
    memcpy(state, in.at, (size_t)bytes);
  }
  if (how % 8 != 5 && how % 8 != 6) seal(state, format, bytes);
  const uint64_t before = hash_of(&w);
  const int32_t in_pieces = how / 32 % 2;
  mpm_status status;
  if (in_pieces) {
    status = load_in_pieces(&w, setup, state, bytes, format, how);
  } else {
    uint8_t *exact = malloc((size_t)bytes + 1); /* reading past the end is noticed */
    memcpy(exact, state, (size_t)bytes);
    w.memory.calls = 0;
    w.memory.fail_at = how >= 240 ? how - 239 : 0;
    status = fuzz_status(w.context, mpm_state_load(w.stepper, exact, bytes));
    w.memory.fail_at = 0;
    free(exact);
  }
  if (status) {
    MUST(status == MPM_E_FORMAT || status == MPM_E_NOMEM || (in_pieces && status == MPM_E_ARG));
    MUST(hash_of(&w) == before);
  }
  use(&w, status ? 1 : 3);
  close_world(&w);
  return 0;
}
