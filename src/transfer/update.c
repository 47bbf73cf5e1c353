/* Nodal velocities: v = p / m, dv = dt f / m, v~ = v + dv (MPoint theory eqs 30-32), on every node as if it
 * were free. Nodes lighter than the cut keep v and lose the force: on the linear basis it stays finite where
 * the mass vanishes. */
#include <float.h>
#include <stdint.h>

#include "simd/vector.h"

MPMI_INLINE int64_t update(int32_t values, double *nodes, int64_t count, double cut, double dt) {
  int64_t active = 0;
  for (int64_t i = 0; i < count; ++i) {
    double *node = nodes + values * i;
    const double mass = node[3], inverse = mass > cut ? 1.0 / mass : 0.0;
    const mpmi_v4 momentum = mpmi_load4(node);
    active += mass > cut;
    mpmi_v4 v = mpmi_scale4(inverse, momentum);
    if (values == 8) {
      const mpmi_v4 dv = mpmi_scale4(dt * inverse, mpmi_load4(node + 4));
      v = mpmi_sum4(v, dv);
      mpmi_store4(node + 4, dv);
    }
    mpmi_store4(node, v);
    if (mass <= cut && mass > DBL_MIN) mpmi_store4(node, mpmi_scale4(1.0 / mass, momentum));
    node[3] = mass;
  }
  return active;
}

int64_t KERNEL(update)(int32_t values, double *nodes, int64_t count, double cut, double dt) {
  return values == 8 ? update(8, nodes, count, cut, dt) : update(4, nodes, count, cut, dt);
}
