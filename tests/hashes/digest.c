/* Hashes of what the library hands out: doubles by their bits, nodes in any order. */
#include "scene.h"

#include <stdlib.h>
#include <string.h>

static uint64_t avalanche(uint64_t x) {
  x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
  return x ^ x >> 31;
}

double noise(uint64_t seed) {
  return (double)(avalanche(seed + UINT64_C(0x9e3779b97f4a7c15)) >> 11) * 0x1p-52 - 1.0;
}

void mix(uint64_t *hash, uint64_t word) {
  *hash = avalanche((*hash ^ avalanche(word)) + UINT64_C(0x9e3779b97f4a7c15));
}

/* Sign and payload of a NaN are the compiler's choice. */
void mix_double(uint64_t *hash, double value) {
  uint64_t bits = UINT64_C(0x7ff8000000000000);
  if (value == value) memcpy(&bits, &value, sizeof bits);
  mix(hash, bits);
}

void mix_info(uint64_t *hash, const mpm_step_info *info) {
  const int64_t whole[] = {
      info->cause, info->callback_status,  info->newton_iterations, info->linear_solver, info->set,
      info->step,  info->active_nodes,     info->removed,           info->resorts,       info->particle,
      info->node,  info->linear_iterations};
  const double real[] = {info->t,
                         info->dt,
                         info->residual,
                         info->dt_suggested,
                         info->kinetic_energy,
                         info->strain_energy,
                         info->external_work,
                         info->dissipation};
  for (size_t i = 0; i < sizeof whole / sizeof *whole; ++i) mix(hash, (uint64_t)whole[i]);
  for (size_t i = 0; i < sizeof real / sizeof *real; ++i) mix_double(hash, real[i]);
  for (int32_t k = 0; k < 3; ++k) {
    mix_double(hash, info->momentum[k]);
    mix_double(hash, info->angular_momentum[k]);
  }
}

/* Of each node a hash; their sum does not know in which order the library lists them, nor which part has
 * them. */
static void mix_nodes(world *w) {
  static const char *const field[] = {"index", "mass", "position", "velocity", "reaction"};
  enum { FIELDS = sizeof field / sizeof *field };
  uint64_t *node = NULL;
  int64_t count = 0, total[2] = {0, 0}; /* nodes of all parts, sum of their hashes */
  mpm_view owned = {.struct_size = sizeof owned};
  for (int32_t f = 0; f < FIELDS; ++f) {
    mpm_view view = {.struct_size = sizeof view};
    must(w, mpm_grid_map(w->stepper, 0, field[f], MPM_READ, &view));
    if (!node) {
      count = view.count;
      node = calloc((size_t)count + 1, sizeof *node);
      if (!node) exit(1);
    }
    for (int64_t i = 0; i < count; ++i)
      for (int32_t c = 0; c < view.components; ++c) {
        const int64_t at = i * view.item_stride + c * view.component_stride;
        if (view.type == MPM_I64)
          mix(&node[i], (uint64_t)((const int64_t *)view.data)[at]);
        else
          mix_double(&node[i], ((const double *)view.data)[at]);
      }
    must(w, mpm_view_release(&view));
  }
  must(w, mpm_grid_map(w->stepper, 0, "owned", MPM_READ, &owned));
  uint64_t sum = 0;
  for (int64_t i = 0; i < count; ++i) {
    const int32_t is_own = ((const uint8_t *)owned.data)[i * owned.item_stride];
    total[0] += is_own;
    if (is_own) sum += node[i];
  }
  must(w, mpm_view_release(&owned));
  free(node);
  memcpy(&total[1], &sum, sizeof sum);
  sum_parts(w, 2, total);
  mix(&w->hash, (uint64_t)total[0]);
  mix(&w->hash, (uint64_t)total[1]);
}

static void mix_force(world *w, const double *force) {
  for (int32_t c = 0; c < w->is->dim; ++c) mix_double(&w->hash, force[c]);
}

void mix_world(world *w) {
  uint64_t state = 0;
  double force[3], residual[64];
  int32_t residuals = 0;
  must(w, mpm_state_hash(w->stepper, &state));
  mix(&w->hash, state);
  for (int32_t face = 0; face < 2 * w->is->dim; ++face) {
    must(w, mpm_stepper_wall_reaction(w->stepper, face, force));
    mix_force(w, force);
  }
  for (int32_t m = 0; m < 2 && w->set[m]; ++m) {
    must(w, mpm_stepper_particles_reaction(w->stepper, w->set[m], force));
    mix_force(w, force);
  }
  must(w, mpm_stepper_residuals(w->stepper, 64, residual, &residuals));
  mix(&w->hash, (uint64_t)residuals);
  for (int32_t i = 0; i < residuals && i < 64; ++i) mix_double(&w->hash, residual[i]);
  mix_nodes(w);
}
