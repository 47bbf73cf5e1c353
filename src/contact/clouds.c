/* Clouds: the particles around the nodes of a meeting. They are found in two passes through the blocks around
 * these nodes, one that counts and one that writes. In each a task has clouds of its own, and goes through
 * all blocks that have particles of these, in the order of colours: so each cloud has one order, whatever the
 * number of tasks is, and no task waits for another where a colour has few blocks.
 *
 * A cloud reaches as far as a spline, whatever the basis is: planes between clouds that end where the linear
 * basis or GIMP does are tilted. */
#include "contact/contact.h"
#include "layout/reached.h"
#include "layout/tasks.h"
#include "layout/tile.h"

#include <math.h>
#include <string.h>

/* The basis by which particles belong to clouds: the grid's own, or the cubic spline in the place of the
 * linear basis and of GIMP, which are too narrow. */
typedef struct cloud_basis {
  int32_t family, width; /* of stencils */
  int32_t spread, below; /* nodes that stencils of one anchor may have, and how many of them lie below it */
} cloud_basis;

static cloud_basis cloud_basis_of(const mpm_grid *grid) {
  if (grid->family == MPMI_FAMILY_BSPLINE1) return (cloud_basis){MPMI_FAMILY_BSPLINE3, 4, 4, 1};
  if (grid->family == MPMI_FAMILY_GIMP) return (cloud_basis){MPMI_FAMILY_BSPLINE3, 4, 5, 2};
  return (cloud_basis){grid->family, grid->width, grid->width, grid->below};
}

typedef struct cloud_job {
  mpmi_contact_search *search;
  cloud_basis basis;
  int32_t fill;
} cloud_job;

/* Clouds [begin, end), those of a task. */
typedef struct cloud_range {
  int64_t begin, end;
} cloud_range;

/* ---- which blocks have particles near these nodes ------------------------------------------------------ */
static void mark_near(const mpmi_contact_search *search, const cloud_basis *basis) {
  const mpmi_blocks *b = &search->step->layout->blocks;
  mpmi_contact_nodes *contact = search->contact;
  const int32_t dim = b->grid->dim, edge = b->edge, low = MPMI_RING + basis->below,
                high = MPMI_RING + basis->spread - 1 - basis->below;
  memset(contact->in_reach, 0, (size_t)b->count);
  for (int64_t i = 0; i < contact->cloud_count; ++i) {
    const int64_t block = contact->cloud[i].slot / b->nodes;
    int64_t place = contact->cloud[i].slot % b->nodes;
    int32_t from[3] = {0, 0, 0}, to[3] = {0, 0, 0}; /* neighbours whose tiles hold the node, by axis */
    for (int32_t k = dim - 1; k >= 0; --k) {
      const int64_t at = place % edge;
      place /= edge;
      from[k] = at < high ? 0 : 1;
      to[k] = at >= edge - low ? 2 : 1;
    }
    for (int32_t x = from[0]; x <= to[0]; ++x)
      for (int32_t y = from[1]; y <= to[1]; ++y)
        for (int32_t z = from[2]; z <= to[2]; ++z) {
          const int32_t n = dim == 1 ? x : dim == 2 ? 3 * x + y : 9 * x + 3 * y + z;
          const int32_t other = b->neighbour[block][n];
          if (other == MPMI_NO_BLOCK) continue;
          if (!contact->in_reach[other]) contact->reached[other].first = (int32_t)i;
          contact->in_reach[other] = 1;
          contact->reached[other].last = (int32_t)i;
        }
  }
}

/* ---- what a block knows of them ------------------------------------------------------------------------ */
/* A task's clouds of the nodes of a tile, or -1, and by the first node of a stencil how many it meets. */
typedef struct cloud_tile {
  int32_t *cloud, *meets, *count; /* count: particles by first node of their stencils, then by node */
  int32_t *before;                /* memory for sums */
  int32_t nodes, any, edge[3];    /* edge: 1 on axes that the grid does not have, which come first */
} cloud_tile;

static void load_neighbour(const mpmi_contact_nodes *contact, const mpmi_blocks *b, int64_t block, int32_t n,
                           const mpmi_spans *spans, const cloud_range *own, cloud_tile *tile) {
  const mpmi_span *x = &spans->at[0][n / 9], *y = &spans->at[1][n / 3 % 3], *z = &spans->at[2][n % 3];
  if (!x->length || !y->length || !z->length) return;
  const int64_t first = (int64_t)b->neighbour[block][n] * b->nodes;
  for (int32_t i = 0; i < x->length; ++i)
    for (int32_t j = 0; j < y->length; ++j)
      for (int32_t k = 0; k < z->length; ++k) {
        const int64_t slot =
            first + ((int64_t)(x->block + i) * b->edge + y->block + j) * b->edge + z->block + k;
        const int32_t at = ((x->tile + i) * tile->edge[1] + y->tile + j) * tile->edge[2] + z->tile + k;
        const int32_t cloud = contact->cloud_of[slot];
        if (cloud < own->begin || cloud >= own->end) continue;
        tile->cloud[at] = cloud;
        tile->any = 1;
      }
}

/* Adds the values of n nodes to those of as many others, four at a time. */
static void add_nodes(int32_t n, const int32_t *from, int32_t *to) {
  typedef int32_t four __attribute__((vector_size(16)));
  int32_t i = 0;
  for (; i + 4 <= n; i += 4) {
    four a, b;
    memcpy(&a, from + i, sizeof a);
    memcpy(&b, to + i, sizeof b);
    b += a;
    memcpy(to + i, &b, sizeof b);
  }
  for (; i < n; ++i) to[i] += from[i];
}

/* Adds to the value of each node at which stencils may begin those of the others of its stencil, or with
 * ahead 0 to that of each node those of the nodes at which stencils begin that have it, along one axis after
 * the other. The end of a line goes on in the next one: no stencil begins there, and what stands there does
 * not count. */
static void sum_stencils(const cloud_tile *tile, int32_t width, int32_t ahead, int32_t *value) {
  int32_t stride = 1;
  for (int32_t k = 2; k >= 0; stride *= tile->edge[k--]) {
    if (tile->edge[k] == 1) continue;
    memcpy(tile->before, value, (size_t)tile->nodes * sizeof *value);
    for (int32_t off = stride; off < width * stride; off += stride)
      add_nodes(tile->nodes - off, tile->before + (ahead ? off : 0), value + (ahead ? 0 : off));
  }
}

/* The memory is that of eight values per node of the grid's own tile: it holds the wider one, too. */
static cloud_tile load_tile(const cloud_job *job, int64_t block, const cloud_range *own, double *memory) {
  const mpmi_contact_search *search = job->search;
  const mpmi_blocks *b = &search->step->layout->blocks;
  const mpm_grid *grid = b->grid;
  cloud_tile tile = {.cloud = (int32_t *)(void *)memory, .nodes = 1, .edge = {1, 1, 1}};
  for (int32_t k = 3 - grid->dim; k < 3; ++k)
    tile.nodes *= tile.edge[k] = MPMI_TILE_EDGE(grid->dim, job->basis.spread);
  const int32_t nodes = tile.nodes;
  tile.meets = tile.cloud + nodes;
  tile.count = tile.meets + nodes;
  tile.before = tile.count + nodes;
  for (int32_t i = 0; i < nodes; ++i) tile.cloud[i] = -1;
  const mpmi_spans spans = mpmi_spans_of_stencil(b, block, job->basis.spread, job->basis.below);
  for (int32_t n = 0; n < b->neighbours; ++n)
    load_neighbour(search->contact, b, block, n, &spans, own, &tile);
  if (!tile.any || !job->fill) return tile; /* what is counted where there are no clouds is not asked for */
  for (int32_t i = 0; i < nodes; ++i) tile.meets[i] = tile.cloud[i] >= 0;
  sum_stencils(&tile, job->basis.width, 1, tile.meets);
  return tile;
}

/* Kernels number nodes as in a tile for their width: turns that into places in the tile of `spread`. */
static void spread_nodes(const cloud_basis *basis, int32_t dim, int64_t n, int32_t *node) {
  const int32_t from = MPMI_TILE_EDGE(dim, basis->width), to = MPMI_TILE_EDGE(dim, basis->spread);
  for (int64_t p = 0; p < n && from != to; ++p) {
    int32_t rest = node[p], place = 0;
    for (int32_t k = 0, edge = 1; k < dim; ++k, edge *= to, rest /= from) place += rest % from * edge;
    node[p] = place;
  }
}

/* ---- particles ----------------------------------------------------------------------------------------- */
/* A chunk of a set's particles. */
typedef struct cloud_particles {
  const mpmi_weights *weights, *own; /* own: those of the grid */
  int32_t width;                     /* of the former */
  const cloud_tile *tile;
  int64_t slot; /* of the first of them */
  int32_t member;
  const double *volume, *radius; /* radius: of rings, else NULL */
  const mpm_particles *set;
} cloud_particles;

/* One axis of a particle's stencil; an axis that the grid does not have is one node wide. own, g: by the
 * grid's basis; own is w where that finds the clouds. */
typedef struct stencil_axis {
  int32_t width;
  double w[MPMI_MAX_WIDTH], g[MPMI_MAX_WIDTH], other[MPMI_MAX_WIDTH];
  const double *own;
} stencil_axis;

static void find_stencil(const cloud_particles *of, const mpm_grid *grid, int32_t k, int64_t p,
                         stencil_axis *axis) {
  axis->width = k < 0 ? 1 : of->width;
  axis->w[0] = 1.0, axis->g[0] = 0.0;
  axis->own = axis->w;
  if (k < 0) return;
  for (int32_t a = 0; a < of->width; ++a) axis->w[a] = of->weights->w[k][a][p];
  if (of->own == of->weights) {
    for (int32_t a = 0; a < of->width; ++a) axis->g[a] = of->own->g[k][a][p];
    return;
  }
  axis->own = axis->other;
  for (int32_t a = 0; a < MPMI_MAX_WIDTH; ++a) axis->other[a] = axis->g[a] = 0.0;
  const int32_t skipped = (int32_t)rint(of->own->first[k][p] - of->weights->first[k][p]);
  for (int32_t a = 0; a < grid->width; ++a) {
    axis->other[skipped + a] = of->own->w[k][a][p];
    axis->g[skipped + a] = of->own->g[k][a][p];
  }
}

/* Turns a vector sum w G over reference positions, that of the last axes, into that over the present ones: by
 * F^-T. */
static void pull_back(const cloud_particles *of, const mpm_grid *grid, int64_t p, double *gradient) {
  const int32_t dim = grid->dim, first = 3 - dim;
  double inverse[3][3];
  mpmi_inverse_at(of->set, of->slot + p, inverse);
  const double G[3] = {gradient[0], gradient[1], gradient[2]};
  for (int32_t j = 0; j < dim; ++j) {
    gradient[first + j] = 0.0;
    for (int32_t k = 0; k < dim; ++k) gradient[first + j] += G[first + k] * inverse[k][j];
  }
}

/* Each cloud is a place in memory of its own to write to, and is asked for so many entries ahead. */
enum { AHEAD = 8 };

static void add_particle(mpmi_contact_nodes *contact, const cloud_particles *of, const mpm_grid *grid,
                         int64_t p) {
  const cloud_tile *tile = of->tile;
  mpmi_cloud *clouds = contact->cloud;
  mpmi_cloud_entry *entries = contact->entry;
  const uint32_t slot = (uint32_t)(of->slot + p);
  const int32_t first = of->weights->node[p], member = of->member, total = mpmi_is_total_lagrangian(grid);
  double volume = of->volume[of->slot + p];
  /* by their volume rings would turn normals away from the axis */
  if (of->radius && of->radius[of->slot + p] > 0.0) volume /= of->radius[of->slot + p];
  stencil_axis axis[3];
  for (int32_t k = 0; k < 3; ++k) find_stencil(of, grid, k - (3 - grid->dim), p, &axis[k]);
  for (int32_t i = 0; i < axis[0].width; ++i)
    for (int32_t j = 0; j < axis[1].width; ++j) {
      const double w = axis[0].w[i] * axis[1].w[j], own = axis[0].own[i] * axis[1].own[j];
      const double g0 = volume * axis[0].g[i] * axis[1].own[j], g1 = volume * axis[0].own[i] * axis[1].g[j];
      const double g2 = volume * own, share = volume * w;
      const int32_t *cloud = tile->cloud + first + (i * tile->edge[1] + j) * tile->edge[2];
      for (int32_t k = 0; k < axis[2].width; ++k) {
        if (cloud[k] < 0 || !(w * axis[2].w[k] > 0.0)) continue;
        mpmi_cloud *to = &clouds[cloud[k]];
        __builtin_prefetch(&entries[to->first + to->count + AHEAD], 1);
        entries[to->first + to->count++] =
            (mpmi_cloud_entry){.slot = slot, .member = member, .volume = share * axis[2].w[k]};
        /* the last axes are those of the grid */
        if (total) {
          double gradient[3] = {g0 * axis[2].own[k], g1 * axis[2].own[k], g2 * axis[2].g[k]};
          pull_back(of, grid, p, gradient);
          for (int32_t c = 0; c < 3; ++c) to->gradient[c] += gradient[c];
          continue;
        }
        to->gradient[0] += g0 * axis[2].own[k];
        to->gradient[1] += g1 * axis[2].own[k];
        to->gradient[2] += g2 * axis[2].g[k];
      }
    }
}

/* Adds the counts of the tile to those of the clouds, which may be too large: a particle at the edge of its
 * stencil has no weight there. */
static void add_counts(mpmi_contact_nodes *contact, const cloud_tile *tile, int32_t width) {
  sum_stencils(tile, width, 0, tile->count);
  for (int32_t i = 0; i < tile->nodes; ++i)
    if (tile->cloud[i] >= 0) contact->cloud[tile->cloud[i]].count += tile->count[i];
}

static void visit_block(const cloud_job *job, int64_t task, int64_t block, const cloud_range *clouds) {
  mpmi_contact_search *search = job->search;
  const mpmi_step *step = search->step;
  const mpmi_layout *layout = step->layout;
  const mpm_grid *grid = layout->blocks.grid;
  mpmi_tile_use(grid, step->work->scratch[task].tile, 8);
  const cloud_tile tile = load_tile(job, block, clouds, step->work->scratch[task].tile);
  if (!tile.any) return;
  const int32_t is_own = job->basis.family == grid->family;
  const mpmi_weights_fn find_own = step->settings->kernels->weights[grid->family][grid->dim];
  const mpmi_weights_fn find = step->settings->kernels->weights[job->basis.family][grid->dim];
  mpmi_axis axis[3], own_axis[3];
  mpmi_weights W, own;
  mpmi_block_axes(grid, layout->blocks.coord[block], own_axis);
  for (int32_t k = 0; k < grid->dim; ++k) {
    axis[k] = own_axis[k];
    axis[k].tile_base -= job->basis.below - grid->below; /* the corner of the wider tile */
  }
  memset(tile.count, 0, (size_t)tile.nodes * sizeof *tile.count);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpmi_residents in = mpmi_residents_of(layout, m, block);
    const int64_t begin = in.begin, end = in.end;
    if (begin == end) continue;
    const mpmi_points points = mpmi_points_of(in.set, 0);
    const int64_t *id = mpmi_i64(in.set, MPMI_ID, 0);
    for (int64_t s = begin; s < end; s += MPMI_CHUNK) {
      const int64_t n = end - s < MPMI_CHUNK ? end - s : MPMI_CHUNK;
      const int32_t need = job->fill ? MPMI_NEED_GRADIENT : 0;
      find(axis, is_own ? need : 0, &points, s, n, &W);
      spread_nodes(&job->basis, grid->dim, n, W.node);
      if (need && !is_own) find_own(own_axis, need, &points, s, n, &own);
      const cloud_particles of = {.weights = &W,
                                  .own = is_own ? &W : &own,
                                  .width = job->basis.width,
                                  .tile = &tile,
                                  .slot = s,
                                  .member = in.member,
                                  .volume = mpmi_f64(in.set, MPMI_VOLUME, 0),
                                  .radius =
                                      mpmi_is_axisymmetric(grid) ? mpmi_f64(in.set, MPMI_POSITION, 0) : NULL,
                                  .set = in.set};
      for (int64_t p = 0; p < n; ++p) {
        if (id[s + p] < 0) continue;
        if (!job->fill)
          ++tile.count[W.node[p]];
        else if (tile.meets[W.node[p]])
          add_particle(search->contact, &of, grid, p);
      }
    }
  }
  if (!job->fill) add_counts(search->contact, &tile, job->basis.width);
}

/* Clouds are as many for each task, or once they are counted have as many particles. */
static int64_t first_of_task(const cloud_job *job, int64_t k) {
  const mpmi_contact_nodes *contact = job->search->contact;
  const int32_t tasks = job->search->step->settings->tasks;
  if (!job->fill || k >= tasks) return contact->cloud_count * k / tasks;
  const int64_t entry = contact->entry_count * k / tasks;
  int64_t low = 0, high = contact->cloud_count;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    if (contact->cloud[middle].first < entry)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static void visit_if_reached(const cloud_job *job, int64_t task, int64_t block, const cloud_range *own) {
  const mpmi_contact_nodes *contact = job->search->contact;
  if (contact->in_reach[block] && contact->reached[block].first < own->end &&
      contact->reached[block].last >= own->begin)
    visit_block(job, task, block, own);
}

/* Tiles of one colour do not meet, so that ghosts may come after the others of their colour. */
static void visit_task(void *data, int64_t k) {
  const cloud_job *job = data;
  const mpmi_layout *layout = job->search->step->layout;
  const mpmi_parts *parts = layout->parts;
  const cloud_range own = {first_of_task(job, k), first_of_task(job, k + 1)};
  for (int32_t c = 0; c < MPMI_COLOURS; ++c) {
    const mpmi_worklist *list = &layout->worklist[1 + c];
    for (int64_t i = 0; i < list->count; ++i) visit_if_reached(job, k, list->block[i], &own);
    for (int64_t g = 0; parts && g < parts->ghost_count; ++g)
      if (mpmi_colour_of(layout->blocks.grid->dim, layout->blocks.coord[parts->ghost[g].block]) == c)
        visit_if_reached(job, k, parts->ghost[g].block, &own);
  }
}

double mpmi_party_radius(const mpmi_layout *layout, const mpmi_contact_nodes *contact,
                         const mpmi_party *party) {
  double sum = 0.0, weight = 0.0;
  if (!mpmi_is_axisymmetric(layout->blocks.grid)) return 1.0;
  for (int64_t i = party->first_cloud; i < party->first_cloud + party->cloud_count; ++i) {
    const mpmi_cloud *cloud = &contact->cloud[contact->cloud[i].source];
    for (int64_t e = cloud->first; e < cloud->first + cloud->count; ++e) {
      const mpmi_cloud_entry *entry = &contact->entry[e];
      const double radius = mpmi_f64(mpmi_resident_set(layout, entry->member), MPMI_POSITION, 0)[entry->slot];
      sum += entry->volume * radius;
      weight += entry->volume;
    }
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

static void find_place(const mpmi_blocks *b, int64_t slot, double *at) {
  int64_t index[3];
  mpmi_blocks_index(b, slot, index);
  for (int32_t k = 0; k < b->grid->dim; ++k) at[k] = mpmi_node_position(b->grid, k, index[k]);
}

void mpmi_contact_position(const mpmi_blocks *b, const mpmi_contact_nodes *contact, int64_t slot,
                           double *at) {
  if (!mpmi_is_total_lagrangian(b->grid)) {
    find_place(b, slot, at);
    return;
  }
  for (int32_t k = 0; k < b->grid->dim; ++k) at[k] = contact->place[slot][k];
}

mpmi_cloud_frame mpmi_cloud_frame_of(const mpmi_blocks *b, const mpmi_cloud *cloud) {
  const mpm_grid *grid = b->grid;
  mpmi_cloud_frame of = {.dim = grid->dim};
  find_place(b, cloud->slot, of.node);
  for (int32_t k = 0; k < grid->dim; ++k) {
    if (grid->desc.periodic[k]) of.period[k] = (double)grid->desc.cells[k] * grid->desc.spacing[k];
    of.scale[k] = cloud->mirrored >> k & 1 ? -grid->inverse_spacing[k] : grid->inverse_spacing[k];
  }
  return of;
}

mpm_status mpmi_clouds_fill(mpmi_contact_search *search) {
  const mpmi_settings *settings = search->step->settings;
  mpm_context *c = settings->context;
  mpmi_contact_nodes *contact = search->contact;
  const int64_t blocks = search->step->layout->blocks.count;
  cloud_job job = {search, cloud_basis_of(search->step->layout->blocks.grid), 0};
  mpm_status status;
  if ((status = MPMI_RESERVE_MORE(c, contact->in_reach, contact->reach_capacity, blocks)) ||
      (status = MPMI_RESERVE_MORE(c, contact->reached, contact->reached_capacity, blocks)))
    return status;
  mark_near(search, &job.basis);
  if ((status = mpmi_run_tasks(settings, 0, settings->tasks, visit_task, &job))) return status;
  contact->entry_count = 0;
  for (int64_t i = 0; i < contact->cloud_count; ++i) {
    contact->cloud[i].first = contact->entry_count; /* images count none */
    contact->entry_count += contact->cloud[i].count;
    contact->cloud[i].count = 0;
  }
  status = MPMI_RESERVE_MORE(c, contact->entry, contact->entry_capacity, contact->entry_count + AHEAD);
  job.fill = 1;
  if (!status) status = mpmi_run_tasks(settings, 0, settings->tasks, visit_task, &job);
  const int32_t unused = 3 - search->step->layout->blocks.grid->dim;
  for (int64_t i = 0; i < contact->cloud_count && unused; ++i)
    for (int32_t k = 0; k < 3; ++k)
      contact->cloud[i].gradient[k] = k + unused < 3 ? contact->cloud[i].gradient[k + unused] : 0.0;
  return status;
}
