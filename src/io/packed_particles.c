/* Packed particles, for hosts that move them themselves:
 *
 *   header    as that of a state, with another magic and format
 *   setup     dimension, geometry, kind of grid and law, which are compared
 *   numbers   packed_numbers, then that many fields, and with images the periods, which are compared
 *   portions  of MPMI_SELECTED particles each: field by field, component by component
 *
 * They are unpacked into a set of their own, checked as those of a state, and then copied behind the others.
 */
#include "io/byte_order.h"
#include "io/state.h"
#include "particles/add.h"
#include "particles/thermal.h"
#include "particles/values.h"

#include <string.h>

#define PACKED_MAGIC "MPMPARTS"
enum { PACKED_FORMAT = 1 };
static const char packed_name[] = "the buffer"; /* for error texts */

typedef struct packed_numbers {
  int64_t count, fields;
  int64_t has_accelerations; /* they are those of an implicit step, or given by the host */
} packed_numbers;

/* ---- what a buffer consists of ------------------------------------------------------------------------- */
static void archive_packed_setup(mpmi_archive *a, const mpm_particles *set) {
  const mpm_grid_desc *grid = &set->grid->desc;
  mpmi_archive_same_int(a, "dim", grid->dim);
  mpmi_archive_same_int(a, "geometry", grid->geometry);
  mpmi_archive_same_int(a, "total_lagrangian", grid->total_lagrangian);
  mpmi_state_archive_law(a, set->material);
}

/* Images count periods, so that these must be as long. */
static void archive_periods(mpmi_archive *a, const mpm_grid *grid) {
  static const char *const name[] = {"period[0]", "period[1]", "period[2]"};
  for (int32_t k = 0; k < grid->dim; ++k)
    mpmi_archive_same_real(a, name[k], grid->desc.periodic[k] ? grid->upper[k] - grid->desc.origin[k] : 0.0);
}

/* Returns a bit for each field that the set has now. */
static uint64_t fields_in_use(const mpm_particles *set) {
  uint64_t used = 0;
  for (int32_t f = 0; f < set->field_count; ++f)
    if (set->field[f].present) used |= UINT64_C(1) << f;
  return used;
}

static int32_t is_among(uint64_t fields, int32_t f) {
  return (fields >> f & 1) != 0;
}

static int64_t portion_bytes(const mpm_particles *set, uint64_t fields, int64_t n) {
  int64_t bytes = 0;
  for (int32_t f = 0; f < set->field_count; ++f)
    if (is_among(fields, f))
      bytes += set->field[f].components * (((int64_t)mpmi_type_size(set->field[f].type) * n + 7) / 8 * 8);
  return bytes;
}

static int64_t portions_bytes(const mpm_particles *set, uint64_t fields, int64_t n) {
  return n / MPMI_SELECTED * portion_bytes(set, fields, MPMI_SELECTED) +
         portion_bytes(set, fields, n % MPMI_SELECTED);
}

/* ---- packing ------------------------------------------------------------------------------------------- */
static void write_packed_head(mpmi_archive *a, const mpm_particles *set, int64_t n) {
  packed_numbers numbers = {.count = n,
                            .has_accelerations = set->field[MPMI_ACCELERATION].present &&
                                                 !(set->dirty & MPMI_DIRTY_ACCELERATION)};
  for (int32_t f = 0; f < set->field_count; ++f) numbers.fields += set->field[f].present;
  archive_packed_setup(a, set);
  mpmi_archive_words(a, &numbers, sizeof numbers);
  for (int32_t f = 0; f < set->field_count; ++f)
    if (set->field[f].present) mpmi_state_write_field(a, &set->field[f]);
  if (set->field[MPMI_IMAGE].present) archive_periods(a, set->grid);
}

static void write_portions(mpmi_archive *a, const mpm_particles *set, const mpmi_selection *of) {
  int64_t slot[MPMI_SELECTED];
  double row[MPMI_SELECTED];
  for (int64_t begin = 0; begin < of->n; begin += MPMI_SELECTED) {
    const int64_t n = mpmi_selected_slots(set, of, begin, slot);
    for (int32_t f = 0; f < set->field_count; ++f) {
      const mpmi_field *field = &set->field[f];
      const size_t size = mpmi_type_size(field->type);
      for (int32_t c = 0; c < field->components && field->present; ++c) {
        const char *from = (const char *)field->data[0] + (size_t)(c * set->ld) * size;
        for (int64_t i = 0; i < n; ++i)
          memcpy((char *)row + (size_t)i * size, from + (size_t)slot[i] * size, size);
        mpmi_state_archive_row(a, field->type, row, n * (int64_t)size);
      }
    }
  }
}

static int64_t measure_packed(const mpm_particles *set, int64_t n) {
  mpmi_archive a;
  mpmi_archive_begin(&a, set->context, MPMI_MEASURE);
  write_packed_head(&a, set, n);
  return (int64_t)sizeof(mpmi_state_header) + a.at + portions_bytes(set, fields_in_use(set), n);
}

mpm_status mpm_particles_packed_size(const mpm_particles *particles, int64_t n, int64_t *bytes) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  if (!bytes) return mpmi_fail(particles->context, MPM_E_ARG, "bytes is NULL");
  if (n < 0 || n > MPMI_MAX_SLOTS)
    return mpmi_fail(particles->context, MPM_E_ARG, "n is %lld, must be in [0, %lld]", (long long)n,
                     (long long)MPMI_MAX_SLOTS);
  *bytes = measure_packed(particles, n);
  return MPM_OK;
}

mpm_status mpm_particles_pack(const mpm_particles *particles, int64_t n, const int64_t *ids, void *buffer,
                              int64_t capacity) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_particles *set = (mpm_particles *)(uintptr_t)particles; /* what changes are caches */
  const mpmi_selection of = {n, ids, 0};
  mpm_status status = buffer ? MPM_OK : mpmi_fail(set->context, MPM_E_ARG, "buffer is NULL");
  if (!status) status = mpmi_between_steps(set);
  if (!status) status = mpmi_state_settle_set(set, "the set", "packing");
  if (!status) status = mpmi_check_selection(set, &of);
  if (!status && ids) status = mpmi_check_unique(set, n, ids, 0);
  if (status) return status;
  const int64_t bytes = measure_packed(set, n);
  if (capacity < bytes)
    return mpmi_fail(set->context, MPM_E_ARG, "capacity is %lld, but %lld particles take %lld bytes",
                     (long long)capacity, (long long)n, (long long)bytes);
  mpmi_archive a;
  mpmi_archive_begin(&a, set->context, MPMI_TO_MEMORY);
  a.to = (unsigned char *)buffer + sizeof(mpmi_state_header);
  write_packed_head(&a, set, n);
  write_portions(&a, set, &of);
  mpmi_state_header header = {PACKED_MAGIC, MPMI_STATE_BYTE_ORDER, PACKED_FORMAT, bytes,
                              mpmi_checksum_end(&a.checksum)};
  header = mpmi_state_turn_header(header);
  memcpy(buffer, &header, sizeof header);
  return MPM_OK;
}

/* ---- unpacking ----------------------------------------------------------------------------------------- */
static mpm_status check_packed_header(mpm_context *c, const mpmi_state_header *header, int64_t bytes) {
  if (bytes < (int64_t)sizeof *header)
    return mpmi_fail(c, MPM_E_FORMAT, "%lld bytes are too few for packed particles", (long long)bytes);
  if (memcmp(header->magic, PACKED_MAGIC, sizeof header->magic) != 0)
    return mpmi_fail(c, MPM_E_FORMAT, "these are no packed particles of libmpm");
  if (header->byte_order != MPMI_STATE_BYTE_ORDER)
    return mpmi_fail(c, MPM_E_FORMAT, "%s is damaged: its byte order makes no sense", packed_name);
  if (header->format != PACKED_FORMAT)
    return mpmi_fail(c, MPM_E_FORMAT, "%s has format %u: this library knows format %d", packed_name,
                     (unsigned)header->format, (int)PACKED_FORMAT);
  if (header->bytes != bytes)
    return mpmi_fail(c, MPM_E_FORMAT, "%s has %lld bytes, of which there are %lld", packed_name,
                     (long long)header->bytes, (long long)bytes);
  return MPM_OK;
}

/* Reads the list of fields, and refuses one that the set does not keep now, or needs and does not get. */
static void read_packed_fields(mpmi_archive *a, mpmi_state_set *list, const mpm_particles *set,
                               int64_t count) {
  uint64_t found = 0;
  if (!a->status && (count < 0 || count > MPMI_MAX_FIELDS))
    mpmi_archive_damaged(a, "its list of fields makes no sense");
  for (int64_t i = 0; i < count && !a->status; ++i) mpmi_state_read_field(a, set, list, &found);
  if (!a->status && found != list->present) mpmi_archive_damaged(a, "its list of fields makes no sense");
  for (int32_t f = 0; f < set->field_count && !a->status; ++f) {
    const mpmi_field *field = &set->field[f];
    const int32_t is_kept = f == MPMI_REFERENCE || f == MPMI_DILATION_RATIO; /* as long as a stepper does */
    const int32_t is_needed = f < MPMI_BUILTIN_FIELDS && f != MPMI_IMAGE && f != MPMI_SIZE &&
                              !mpmi_state_may_lack(set->grid, f) && field->present;
    if (is_among(found, f) && is_kept && !field->present)
      a->status = mpmi_state_refuse_field(a, field->name, "is there, but not here");
    else if (!is_among(found, f) && is_needed)
      a->status = mpmi_state_refuse_field(a, field->name, "is here, but not there");
  }
}

static void read_portions(mpmi_archive *a, const mpmi_state_set *list, mpm_particles *fresh) {
  const int64_t n = fresh->count;
  for (int64_t begin = 0; begin < n; begin += MPMI_SELECTED)
    mpmi_state_read_rows(a, list, fresh, begin, n - begin < MPMI_SELECTED ? n - begin : MPMI_SELECTED);
}

/* The host may have another grid, in which these particles have no place. */
static mpm_status check_packed_places(const mpm_particles *fresh) {
  const mpm_grid *grid = fresh->grid;
  const int64_t *id = mpmi_i64(fresh, MPMI_ID, 0);
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double *x = mpmi_places(fresh, 0) + k * fresh->ld;
    for (int64_t s = 0; s < fresh->count; ++s)
      if (!(x[s] >= grid->desc.origin[k] && x[s] <= grid->upper[k]))
        return mpmi_fail(
            fresh->context, MPM_E_ARG,
            "%s of the packed particle with id %lld, component %d, is %.12g: the grid of the set "
            "is [%.12g, %.12g] there",
            fresh->field[mpmi_place_field(grid)].name, (long long)id[s], (int)k, x[s], grid->desc.origin[k],
            grid->upper[k]);
  }
  return MPM_OK;
}

static mpm_status find_next_id(mpmi_archive *a, mpm_particles *fresh) {
  const int64_t *id = mpmi_i64(fresh, MPMI_ID, 0);
  fresh->next_id = 0;
  for (int64_t s = 0; s < fresh->count; ++s) {
    if (id[s] < 0 || id[s] == INT64_MAX) return mpmi_archive_damaged(a, "its ids make no sense");
    if (id[s] >= fresh->next_id) fresh->next_id = id[s] + 1;
  }
  return MPM_OK;
}

/* Fills the set that has no storage yet with n particles. What the archive lacks has the values of new
 * particles. */
static mpm_status read_packed_values(mpmi_archive *a, const mpmi_state_set *list, mpm_particles *fresh,
                                     int64_t n) {
  static const int32_t derived[] = {MPMI_REFERENCE, MPMI_SIZE, MPMI_DILATION_RATIO};
  const int64_t slots = (n + MPMI_PAD - 1) / MPMI_PAD * MPMI_PAD;
  mpm_status status = mpmi_particles_reserve(fresh, slots);
  if (status) return status;
  fresh->slots = slots;
  fresh->count = n;
  mpmi_fill_holes(fresh, 0, 0, slots, fresh->grid->desc.origin);
  mpmi_thermal_start(fresh, 0, n);
  read_portions(a, list, fresh);
  for (size_t i = 0; i < sizeof derived / sizeof *derived && !a->status; ++i)
    if (!is_among(list->present, derived[i])) mpmi_append_default(fresh, derived[i], 0, n);
  if (a->status || (status = find_next_id(a, fresh)) || (status = check_packed_places(fresh)))
    return a->status ? a->status : status;
  mpmi_state_check_set(a, fresh, NULL, NULL);
  return a->status;
}

static mpm_status read_packed(mpmi_archive *a, mpm_particles *fresh, const mpm_particles *set,
                              packed_numbers *numbers) {
  mpmi_state_set list = {.field_count = 0};
  archive_packed_setup(a, set);
  mpmi_archive_words(a, numbers, sizeof *numbers);
  read_packed_fields(a, &list, set, numbers->fields);
  if (!a->status && is_among(list.present, MPMI_IMAGE)) archive_periods(a, set->grid);
  if (a->status) return a->status;
  if (numbers->count < 0 || numbers->count > MPMI_MAX_SLOTS ||
      portions_bytes(set, list.present, numbers->count) != a->size - a->at)
    return mpmi_archive_damaged(a, "its numbers make no sense");
  for (int32_t f = 0; f < set->field_count; ++f)
    fresh->field[f].present = set->field[f].present | is_among(list.present, f);
  return numbers->count ? read_packed_values(a, &list, fresh, numbers->count) : MPM_OK;
}

/* Does all that may fail. What becomes present reads as before. */
static mpm_status prepare_to_append(mpm_particles *set, const mpm_particles *fresh) {
  const uint64_t had = fields_in_use(set);
  mpm_status status = mpmi_check_room(set, fresh->count);
  if (!status) status = mpmi_check_unique(set, fresh->count, mpmi_i64(fresh, MPMI_ID, 0), 1);
  if (!status) status = mpmi_append_reserve(set, fresh->count, 0, 0);
  for (int32_t f = 0; f < set->field_count && !status; ++f)
    if (fresh->field[f].present) status = mpmi_field_make_present(set, f);
  for (int32_t f = 0; f < set->field_count && status; ++f)
    if (!is_among(had, f)) mpmi_field_make_absent(set, f);
  return status;
}

static void append_packed(mpm_particles *set, const mpm_particles *fresh, int32_t has_accelerations) {
  const int64_t n = fresh->count, slot = mpmi_append_begin(set, n);
  const double *mass = mpmi_f64(fresh, MPMI_MASS, 0);
  for (int32_t f = 0; f < set->field_count; ++f) {
    const mpmi_field *from = &fresh->field[f];
    const size_t size = mpmi_type_size(from->type);
    for (int32_t c = 0; c < from->components && from->present; ++c)
      memcpy((char *)set->field[f].data[0] + (size_t)(c * set->ld + slot) * size,
             (const char *)from->data[0] + (size_t)(c * fresh->ld) * size, (size_t)n * size);
  }
  for (int64_t s = 0; s < n; ++s)
    if (mass[s] > set->mass_max) set->mass_max = mass[s];
  if (fresh->next_id > set->next_id) set->next_id = fresh->next_id;
  set->count += n;
  set->dirty |= MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS;
  if (!has_accelerations) set->dirty |= MPMI_DIRTY_ACCELERATION;
  mpmi_index_drop(set);
}

static mpm_status unpack_body(mpm_particles *set, const unsigned char *body, int64_t bytes) {
  packed_numbers numbers = {0, 0, 0};
  mpmi_archive a;
  mpm_particles *fresh = mpmi_alloc_zeroed(set->context, sizeof *fresh);
  if (!fresh) return MPM_E_NOMEM;
  mpmi_state_start_set(fresh, set);
  mpmi_archive_begin(&a, set->context, MPMI_FROM_MEMORY);
  a.name = packed_name;
  a.from = body;
  a.size = bytes;
  mpm_status status = read_packed(&a, fresh, set, &numbers);
  if (!status && numbers.count) status = prepare_to_append(set, fresh);
  if (!status && numbers.count) append_packed(set, fresh, numbers.has_accelerations == 1);
  mpmi_state_drop_storage(fresh);
  mpmi_free(set->context, fresh, sizeof *fresh);
  return status;
}

mpm_status mpm_particles_unpack(mpm_particles *particles, const void *buffer, int64_t bytes) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_context *c = particles->context;
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status && !buffer) status = mpmi_fail(c, MPM_E_ARG, "buffer is NULL");
  if (!status && bytes < 0) status = mpmi_fail(c, MPM_E_ARG, "bytes is %lld, must be >= 0", (long long)bytes);
  if (status) return status;
  mpmi_state_header header;
  memset(&header, 0, sizeof header);
  memcpy(&header, buffer, (size_t)bytes < sizeof header ? (size_t)bytes : sizeof header);
  header = mpmi_state_turn_header(header);
  const unsigned char *body = (const unsigned char *)buffer + sizeof header;
  if ((status = check_packed_header(c, &header, bytes)) ||
      (status = mpmi_state_check_sum(c, packed_name, &header, body)))
    return status;
  return unpack_body(particles, body, bytes - (int64_t)sizeof header);
}
