/* Numbers of the rows of several parts, and the lists of those that parts give to each other. */
#include "linalg/rows.h"

#include <stdlib.h>
#include <string.h>

#include "context/transport.h"
#include "linalg/vectors.h"

/* ---- lists of numbers for other parts ------------------------------------------------------------------ */
/* Lists of `width` words each, for any part; in `sent` they stand by part, in the order of adding. */
typedef struct mail {
  int32_t width;
  int64_t count;
  int64_t *sent, *start; /* [count][width], [parts + 1] */
  int64_t arrived_count; /* messages */
  const mpm_message *arrived;
  mpm_message *message; /* [parts] */
} mail;

static mpm_status open_mail(mpm_context *c, int32_t width, int64_t count, mail *of) {
  const int32_t parts = c->transport.parts;
  *of = (mail){.width = width, .count = count};
  of->sent = mpmi_alloc(c, mpmi_bytes(count * width + 1, sizeof *of->sent));
  of->start = mpmi_alloc_zeroed(c, mpmi_bytes(parts + 1, sizeof *of->start));
  of->message = mpmi_alloc(c, mpmi_bytes(parts, sizeof *of->message));
  return of->sent && of->start && of->message ? MPM_OK : MPM_E_NOMEM;
}

static void close_mail(mpm_context *c, mail *of) {
  MPMI_FREE_ARRAY(c, of->sent, of->count * of->width + 1);
  MPMI_FREE_ARRAY(c, of->start, c->transport.parts + 1);
  MPMI_FREE_ARRAY(c, of->message, c->transport.parts);
  *of = (mail){.width = 0};
}

/* Turns numbers of lists by part, in start[1 ...], into where they begin. */
static void begin_mail(const mpm_context *c, mail *of) {
  for (int32_t r = 0; r < c->transport.parts; ++r) of->start[r + 1] += of->start[r];
}

/* Sends the lists, whose ends are in start[0 ...] now, and takes those of others; own ones stay in `sent`. */
static mpm_status deliver(mpm_context *c, mail *of) {
  const int32_t me = c->transport.part;
  int32_t count = 0, arrived = 0;
  for (int32_t r = 0; r < c->transport.parts; ++r) {
    const int64_t from = r ? of->start[r - 1] : 0, words = (of->start[r] - from) * of->width;
    if (r == me || !words) continue;
    of->message[count++] = (mpm_message){
        .part = r, .bytes = words * (int64_t)sizeof(int64_t), .data = of->sent + from * of->width};
  }
  mpm_status status = mpmi_send(c, MPM_EXCHANGE_SPARSE, count, of->message, NULL);
  if (!status) status = mpmi_receive(c, &arrived, &of->arrived);
  of->arrived_count = arrived;
  return status;
}

static int64_t first_of(const mail *of, int32_t part) {
  return part ? of->start[part - 1] : 0;
}

static int64_t lists_in(const mail *of, const mpm_message *in) {
  return in->bytes / (int64_t)sizeof(int64_t) / of->width;
}

/* ---- links --------------------------------------------------------------------------------------------- */
static int64_t packed_length(const mpmi_row_link *link, int32_t block) {
  return (int64_t)link->vectors * block * link->out_count;
}

static void free_link(mpm_context *c, mpmi_row_link *link, int32_t block) {
  const int64_t capacity = link->partner_capacity;
  MPMI_FREE_ARRAY(c, link->part, capacity);
  MPMI_FREE_ARRAY(c, link->out_start, capacity + 1);
  MPMI_FREE_ARRAY(c, link->in_start, capacity + 1);
  MPMI_FREE_ARRAY(c, link->message, capacity);
  MPMI_FREE_ARRAY(c, link->most, capacity);
  MPMI_FREE_ARRAY(c, link->out, link->out_count);
  MPMI_FREE_ARRAY(c, link->in, link->in_count);
  MPMI_FREE_ARRAY(c, link->packed, packed_length(link, block));
  *link = (mpmi_row_link){.partners = 0};
}

/* Makes room for a link over which so many rows go and come by part; [parts] each. Of so many vectors they go
 * at once. */
static mpm_status make_link(mpm_context *c, mpmi_row_link *link, int32_t block, int32_t vectors,
                            const int64_t *out, const int64_t *in) {
  int32_t partners = 0;
  int64_t all_out = 1, all_in = 1;
  for (int32_t r = 0; r < c->transport.parts; ++r) {
    partners += out[r] || in[r];
    all_out += out[r];
    all_in += in[r];
  }
  link->vectors = vectors;
  link->partner_capacity = partners;
  link->out_count = all_out;
  link->in_count = all_in;
  link->part = mpmi_alloc(c, mpmi_bytes(partners, sizeof *link->part));
  link->out_start = mpmi_alloc(c, mpmi_bytes(partners + 1, sizeof *link->out_start));
  link->in_start = mpmi_alloc(c, mpmi_bytes(partners + 1, sizeof *link->in_start));
  link->message = mpmi_alloc(c, mpmi_bytes(partners, sizeof *link->message));
  link->most = mpmi_alloc(c, mpmi_bytes(partners, sizeof *link->most));
  link->out = mpmi_alloc(c, mpmi_bytes(all_out, sizeof *link->out));
  link->in = mpmi_alloc(c, mpmi_bytes(all_in, sizeof *link->in));
  link->packed = mpmi_alloc(c, mpmi_bytes(packed_length(link, block), sizeof *link->packed));
  if (!link->part || !link->out_start || !link->in_start || !link->message || !link->most || !link->out ||
      !link->in || !link->packed)
    return MPM_E_NOMEM;
  link->out_start[0] = link->in_start[0] = 0;
  for (int32_t r = 0; r < c->transport.parts; ++r) {
    if (!out[r] && !in[r]) continue;
    const int32_t k = link->partners++;
    link->part[k] = r;
    link->out_start[k + 1] = link->out_start[k] + out[r];
    link->in_start[k + 1] = link->in_start[k] + in[r];
  }
  return MPM_OK;
}

static int32_t partner_of(const mpmi_row_link *link, int32_t part) {
  int32_t k = 0;
  while (link->part[k] != part) ++k;
  return k;
}

/* ---- numbers ------------------------------------------------------------------------------------------- */
/* A row that has come home to be numbered. */
typedef struct named_row {
  uint64_t key;
  int64_t place, at; /* where its number goes, in the answers */
} named_row;

static int by_name(const void *a, const void *b) {
  const named_row *x = a, *y = b;
  if (x->key != y->key) return x->key < y->key ? -1 : 1;
  return (x->place > y->place) - (x->place < y->place);
}

static void put_name(mail *of, int64_t at, const mpmi_rows_desc *d, int64_t row) {
  memcpy(of->sent + at * of->width, &d->key[row], sizeof(int64_t));
  of->sent[at * of->width + 1] = d->place[row];
}

/* Lists rows with `pick` by the part in `to`. */
static void list_names(const mpmi_rows *rows, const mpmi_rows_desc *d, const int32_t *to, int32_t own,
                       mail *of) {
  for (int64_t r = 0; r < d->count; ++r)
    if (rows->own[r] == own && (own || d->wanted[r])) ++of->start[to[r] + 1];
  begin_mail(rows->context, of);
  for (int64_t r = 0; r < d->count; ++r)
    if (rows->own[r] == own && (own || d->wanted[r])) put_name(of, of->start[to[r]]++, d, r);
}

static int64_t count_names(const mpmi_rows *rows, const mpmi_rows_desc *d, int32_t own) {
  int64_t count = 0;
  for (int64_t r = 0; r < d->count; ++r) count += rows->own[r] == own && (own || d->wanted[r]);
  return count;
}

/* Takes names into the list of those that are numbered here. */
static void take_names(const int64_t *word, int64_t count, int64_t at, named_row *to) {
  for (int64_t i = 0; i < count; ++i) {
    memcpy(&to[i].key, &word[2 * i], sizeof to[i].key);
    to[i].place = word[2 * i + 1];
    to[i].at = at + i;
  }
}

/* Numbers what has come home, and answers; the answers stand by part as the names came. */
static mpm_status answer(mpmi_rows *rows, const mail *names, mail *answers, int64_t *first) {
  mpm_context *c = rows->context;
  const int32_t me = c->transport.part, parts = c->transport.parts;
  const int64_t own = names->start[me] - first_of(names, me);
  int64_t count = own;
  for (int64_t i = 0; i < names->arrived_count; ++i) count += lists_in(names, &names->arrived[i]);
  named_row *named = mpmi_alloc(c, mpmi_bytes(count + 1, sizeof *named));
  mpm_status status = named ? open_mail(c, 1, count, answers) : MPM_E_NOMEM;
  if (!(status = mpmi_agree(c, status))) {
    int64_t at = 0;
    answers->start[me + 1] = own;
    for (int64_t i = 0; i < names->arrived_count; ++i)
      answers->start[names->arrived[i].part + 1] = lists_in(names, &names->arrived[i]);
    begin_mail(c, answers);
    take_names(names->sent + 2 * first_of(names, me), own, answers->start[me], named);
    at = own;
    for (int64_t i = 0; i < names->arrived_count; ++i) {
      const mpm_message *in = &names->arrived[i];
      take_names(in->data, lists_in(names, in), answers->start[in->part], named + at);
      at += lists_in(names, in);
    }
    for (int32_t r = 0; r < parts; ++r) answers->start[r] = answers->start[r + 1];
    if (count) qsort(named, (size_t)count, sizeof *named, by_name);
    status = mpmi_gather_parts(c, count, first + 1);
  }
  first[0] = 0;
  for (int32_t r = 0; r < parts && !status; ++r) first[r + 1] += first[r];
  for (int64_t i = 0; i < count && !status; ++i) answers->sent[named[i].at] = first[me] + i;
  MPMI_FREE_ARRAY(c, named, count + 1);
  return status ? status : deliver(c, answers);
}

/* Finds the numbers of own rows; first: [parts + 1] where those that are numbered by each part begin. */
static mpm_status find_numbers(mpmi_rows *rows, const mpmi_rows_desc *d, int64_t *first) {
  mpm_context *c = rows->context;
  const int32_t me = c->transport.part;
  mail names, answers = {.width = 0};
  mpm_status status = mpmi_agree(c, open_mail(c, 2, count_names(rows, d, 1), &names));
  if (!status) {
    list_names(rows, d, d->home, 1, &names);
    status = deliver(c, &names);
  }
  if (!status) status = answer(rows, &names, &answers, first);
  /* answers come in the order of the names, which is that of the rows */
  for (int64_t r = 0, i = 0, k = 0, part = -1; r < d->count && !status; ++r) {
    if (!rows->own[r]) continue;
    if (d->home[r] != part) {
      part = d->home[r];
      i = 0;
      while (part != me && k < answers.arrived_count && answers.arrived[k].part < part) ++k;
    }
    const int64_t *of = part == me ? answers.sent + first_of(&answers, me) : answers.arrived[k].data;
    rows->number[r] = of[i++];
  }
  if (!status) rows->all = first[c->transport.parts];
  close_mail(c, &names);
  close_mail(c, &answers);
  return status;
}

/* ---- values of rows of other parts --------------------------------------------------------------------- */
static int64_t find_row(const mpmi_rows_desc *d, uint64_t key, int64_t place) {
  int64_t low = 0, high = d->count;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    if (d->key[middle] < key || (d->key[middle] == key && d->place[middle] < place))
      low = middle + 1;
    else
      high = middle;
  }
  return low < d->count && d->key[low] == key && d->place[low] == place ? low : -1;
}

/* Counts what is asked of this part and what it asks for, by part; [2][parts]. */
static void count_link(const mpm_context *c, const mail *of, int64_t *asked) {
  const int32_t parts = c->transport.parts;
  memset(asked, 0, (size_t)(2 * parts) * sizeof *asked);
  for (int64_t i = 0; i < of->arrived_count; ++i) asked[of->arrived[i].part] = lists_in(of, &of->arrived[i]);
  for (int32_t r = 0; r < parts; ++r)
    if (r != c->transport.part) asked[parts + r] = of->start[r] - first_of(of, r);
}

static mpm_status find_halo(mpmi_rows *rows, const mpmi_rows_desc *d, int64_t *asked) {
  mpm_context *c = rows->context;
  mpmi_row_link *link = &rows->halo;
  mail names;
  free_link(c, link, rows->block);
  mpm_status status = mpmi_agree(c, open_mail(c, 2, count_names(rows, d, 0), &names));
  if (!status) {
    list_names(rows, d, d->owner, 0, &names);
    status = deliver(c, &names);
  }
  if (!status) {
    count_link(c, &names, asked);
    status = make_link(c, link, rows->block, 1, asked, asked + c->transport.parts);
    for (int64_t i = 0; i < names.arrived_count && !status; ++i) {
      const int64_t *word = names.arrived[i].data, count = lists_in(&names, &names.arrived[i]);
      int64_t *to = link->out + link->out_start[partner_of(link, names.arrived[i].part)];
      for (int64_t k = 0; k < count && !status; ++k) {
        uint64_t key;
        memcpy(&key, &word[2 * k], sizeof key);
        to[k] = find_row(d, key, word[2 * k + 1]);
        if (to[k] < 0 || !rows->own[to[k]])
          status = mpmi_fail(c, MPM_E_INTERNAL, "part %d wants a row that is not of part %d",
                             (int)names.arrived[i].part, (int)c->transport.part);
      }
    }
    for (int32_t k = 0; k < link->partners && !status; ++k) {
      int64_t at = link->in_start[k];
      for (int64_t r = 0; r < d->count && at < link->in_start[k + 1]; ++r)
        if (!rows->own[r] && d->wanted[r] && d->owner[r] == link->part[k]) link->in[at++] = r;
    }
    status = mpmi_agree(c, status);
  }
  close_mail(c, &names);
  return status;
}

/* ---- terms of sums ------------------------------------------------------------------------------------- */
/* Returns where the first range begins that does not begin before an item. */
static int64_t next_range(int64_t items, int64_t item) {
  const int64_t size = mpmi_ranges_of(items, items).size;
  const int64_t begin = (item + size - 1) / size * size;
  return begin < items ? begin : items;
}

/* Returns the first row that a part needs whose ranges begin at `row` or later, or for the end the first one
 * that the part before has no need of. */
static int64_t first_needed(const mpmi_rows *rows, int64_t row, int32_t is_end) {
  const int64_t block = rows->block, by_rows = next_range(rows->all, row);
  const int64_t unknown = next_range(rows->all * block, row * block);
  const int64_t by_unknowns = is_end ? (unknown + block - 1) / block : unknown / block;
  return (by_rows < by_unknowns) == is_end ? by_unknowns : by_rows;
}

/* Lists own rows for the parts that add up their terms; with a list only counts them. Rows ascend by
 * number, and so do parts. */
static void list_terms(const mpmi_rows *rows, const int64_t *first, mail *of, int64_t *count) {
  const int32_t parts = rows->context->transport.parts;
  int32_t low = 0;
  for (int64_t r = 0; r < rows->count; ++r) {
    if (!rows->own[r]) continue;
    const int64_t number = rows->number[r];
    while (low < parts && first_needed(rows, first[low + 1], 1) <= number) ++low;
    for (int32_t p = low; p < parts && first_needed(rows, first[p], 0) <= number; ++p) {
      if (first_needed(rows, first[p + 1], 1) <= number) continue;
      if (count)
        ++count[p + 1];
      else
        of->sent[of->start[p]++] = number;
    }
  }
}

static mpm_status find_sums(mpmi_rows *rows, const int64_t *first, int64_t *asked) {
  mpm_context *c = rows->context;
  const int32_t me = c->transport.part, parts = c->transport.parts;
  mpmi_row_link *link = &rows->sums;
  int64_t *count = mpmi_alloc_zeroed(c, mpmi_bytes(parts + 1, sizeof *count)), all = 0;
  mail of = {.width = 0};
  free_link(c, link, rows->block);
  rows->added_from = first[me];
  rows->added_to = first[me + 1];
  rows->first = first_needed(rows, first[me], 0);
  rows->end = first_needed(rows, first[me + 1], 1);
  if (rows->end < rows->first) rows->end = rows->first;
  if (count) list_terms(rows, first, NULL, count);
  for (int32_t r = 0; r < parts && count; ++r) all += count[r + 1];
  mpm_status status = count ? open_mail(c, 1, all, &of) : MPM_E_NOMEM;
  if (!status)
    status =
        MPMI_RESERVE_MORE(c, rows->term, rows->term_capacity, (rows->end - rows->first) * rows->block + 1);
  if (!(status = mpmi_agree(c, status))) {
    memcpy(of.start, count, (size_t)(parts + 1) * sizeof *count);
    begin_mail(c, &of);
    list_terms(rows, first, &of, NULL);
    status = deliver(c, &of);
  }
  if (!status) {
    count_link(c, &of, asked);
    /* here it is rows that are sent, and terms that come */
    status = make_link(c, link, rows->block, MPMI_ROW_SUMS, asked + parts, asked);
    for (int32_t k = 0; k < link->partners && !status; ++k) {
      int64_t at = link->out_start[k], from = first_of(&of, link->part[k]);
      for (int64_t r = 0; r < rows->count && at < link->out_start[k + 1]; ++r)
        if (rows->own[r] && rows->number[r] == of.sent[from]) link->out[at++] = r, ++from;
    }
    for (int64_t i = 0; i < of.arrived_count && !status; ++i) {
      const int64_t *number = of.arrived[i].data, n = lists_in(&of, &of.arrived[i]);
      int64_t *to = link->in + link->in_start[partner_of(link, of.arrived[i].part)];
      for (int64_t k = 0; k < n; ++k) to[k] = number[k] - rows->first;
    }
    status = mpmi_agree(c, status);
  }
  close_mail(c, &of);
  MPMI_FREE_ARRAY(c, count, parts + 1);
  return status;
}

/* ---- all of it ----------------------------------------------------------------------------------------- */
mpm_status mpmi_rows_create(mpm_context *context, int32_t block, mpmi_rows **out) {
  *out = mpmi_alloc_zeroed(context, sizeof **out);
  if (!*out) return MPM_E_NOMEM;
  (*out)->context = context;
  (*out)->block = block;
  return MPM_OK;
}

void mpmi_rows_destroy(mpmi_rows *rows) {
  if (!rows) return;
  mpm_context *c = rows->context;
  free_link(c, &rows->halo, rows->block);
  free_link(c, &rows->sums, rows->block);
  MPMI_FREE_ARRAY(c, rows->own, rows->own_capacity);
  MPMI_FREE_ARRAY(c, rows->number, rows->number_capacity);
  MPMI_FREE_ARRAY(c, rows->term, rows->term_capacity);
  mpmi_free(c, rows, sizeof *rows);
}

mpm_status mpmi_rows_share(mpmi_rows *rows, const mpmi_rows_desc *d, mpm_status status) {
  mpm_context *c = rows->context;
  const int32_t parts = c->transport.parts;
  const size_t bytes = mpmi_bytes(3 * parts + 1, sizeof(int64_t));
  int64_t *first = mpmi_alloc(c, bytes);
  if (!status && !first) status = MPM_E_NOMEM;
  if (!status) status = MPMI_RESERVE_MORE(c, rows->own, rows->own_capacity, d->count + 1);
  if (!status) status = MPMI_RESERVE_MORE(c, rows->number, rows->number_capacity, d->count + 1);
  if (!(status = mpmi_agree(c, status))) {
    rows->count = d->count;
    for (int64_t r = 0; r < d->count; ++r) rows->own[r] = d->owner[r] == c->transport.part;
    status = find_numbers(rows, d, first);
  }
  if (!status) status = find_halo(rows, d, first + parts + 1);
  if (!status) status = find_sums(rows, first, first + parts + 1);
  mpmi_free(c, first, bytes);
  return status;
}
