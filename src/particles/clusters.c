#include "particles/clusters.h"

#include <string.h>

/* Stencils with more particles are not looked at: the search takes a time that grows with their square. */
enum { MOST_OF_STENCIL = 128, MOST_STENCILS = 256 };
#define STENCILS(edge, dim) ((dim) == 1 ? (edge) : (dim) == 2 ? (edge) * (edge) : (edge) * (edge) * (edge))
_Static_assert(STENCILS(MPMI_BLOCK_EDGE(1), 1) <= MOST_STENCILS &&
                   STENCILS(MPMI_BLOCK_EDGE(2), 2) <= MOST_STENCILS &&
                   STENCILS(MPMI_BLOCK_EDGE(3), 3) <= MOST_STENCILS,
               "a block has more stencils");

/* Returns which of the stencils of its block the particle in a slot has. */
static int32_t stencil_of(const mpm_particles *set, int64_t slot) {
  const mpm_grid *grid = set->grid;
  const int32_t edge = MPMI_BLOCK_EDGE(grid->dim);
  int32_t stencil = 0;
  for (int32_t k = 0; k < grid->dim; ++k)
    stencil = stencil * edge + mpmi_anchor(grid, k, mpmi_places(set, 0)[k * set->ld + slot]) % edge;
  return stencil;
}

/* Finds the place of each of n coordinates among those that differ. */
static void rank_coordinates(int32_t n, const double *x, int32_t *rank) {
  double distinct[MOST_OF_STENCIL];
  int32_t count = 0;
  for (int32_t i = 0; i < n; ++i) {
    int32_t at = count;
    while (at > 0 && distinct[at - 1] > x[i]) --at;
    if (at > 0 && distinct[at - 1] == x[i]) continue;
    memmove(distinct + at + 1, distinct + at, (size_t)(count++ - at) * sizeof *distinct);
    distinct[at] = x[i];
  }
  for (int32_t i = 0; i < n; ++i)
    for (rank[i] = 0; distinct[rank[i]] < x[i];) ++rank[i];
}

/* A particle of a stencil: the cluster that it would belong to, and its place there, by pairs of neighbouring
 * coordinates. */
typedef struct candidate {
  int32_t cluster, place;
  uint32_t slot;
} candidate;

/* Lists the particles of a stencil by cluster and place. Those that share a place stay in order. */
static void list_candidates(const mpm_particles *set, int32_t n, const uint32_t *slot, candidate *list) {
  int32_t cluster[MOST_OF_STENCIL] = {0}, place[MOST_OF_STENCIL] = {0}, rank[MOST_OF_STENCIL];
  for (int32_t k = 0; k < set->grid->dim; ++k) {
    double x[MOST_OF_STENCIL];
    for (int32_t i = 0; i < n; ++i) x[i] = mpmi_places(set, 0)[k * set->ld + slot[i]];
    rank_coordinates(n, x, rank);
    for (int32_t i = 0; i < n; ++i) {
      cluster[i] = cluster[i] * MOST_OF_STENCIL + rank[i] / 2;
      place[i] = place[i] * 2 + rank[i] % 2;
    }
  }
  for (int32_t i = 0; i < n; ++i) {
    const candidate c = {cluster[i], place[i], slot[i]};
    int32_t at = i;
    for (; at > 0; --at) {
      const candidate *before = &list[at - 1];
      if (before->cluster < c.cluster || (before->cluster == c.cluster && before->place <= c.place)) break;
      list[at] = *before;
    }
    list[at] = c;
  }
}

/* Returns 1 when a cluster begins with the first of n candidates. */
static int32_t begins_cluster(int32_t size, int32_t n, const candidate *list) {
  if (n < size) return 0;
  for (int32_t i = 0; i < size; ++i)
    if (list[i].cluster != list->cluster || list[i].place != i) return 0;
  return 1;
}

void mpmi_clusters_first(const mpm_particles *set, int64_t count, uint32_t *source, uint32_t *room) {
  const int32_t dim = set->grid->dim, size = 1 << dim;
  const int32_t stencils = STENCILS(MPMI_BLOCK_EDGE(dim), dim);
  int64_t end[MOST_STENCILS + 1] = {0};
  for (int64_t i = 0; i < count; ++i) ++end[stencil_of(set, source[i]) + 1];
  for (int32_t c = 0; c < stencils; ++c) end[c + 1] += end[c];
  for (int64_t i = 0; i < count; ++i) room[end[stencil_of(set, source[i])]++] = source[i];
  /* end[c] is that of stencil c now; clusters go back to the front, and what is left moves up in the room */
  int64_t first = 0, rest = 0;
  for (int64_t c = 0, begin = 0; c < stencils; begin = end[c++]) {
    candidate list[MOST_OF_STENCIL];
    const int64_t n = end[c] - begin;
    const int32_t looked_at = n >= size && n <= MOST_OF_STENCIL ? (int32_t)n : 0;
    if (looked_at) list_candidates(set, looked_at, room + begin, list);
    for (int32_t i = 0; i < looked_at;) {
      const int32_t found = begins_cluster(size, looked_at - i, list + i);
      for (int32_t taken = found ? size : 1; taken > 0; --taken, ++i)
        if (found)
          source[first++] = list[i].slot;
        else
          room[rest++] = list[i].slot;
    }
    for (int64_t i = begin + looked_at; i < end[c]; ++i) room[rest++] = room[i];
  }
  if (first) memcpy(source + first, room, (size_t)rest * sizeof *source);
}
