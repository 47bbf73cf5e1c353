/* Nodal velocities: v = p / m, dv = dt f / m, v~ = v + dv (MPoint theory eqs 30-32), on every node as if it
 * were free. Nodes that are not heavier than the second cut keep v, and dv beside it
 * (boundary/light_nodes.c). */
#include <float.h>

#include "simd/vector.h"
#include "transfer/update.h"

MPMI_INLINE mpmi_updated update(int32_t values, double *nodes, int64_t count, const double *cut, double dt) {
  const double mass_cut = cut[0], light_cut = cut[1];
  int64_t active = 0, light = 0;
  for (int64_t i = 0; i < count; ++i) {
    double *node = nodes + values * i;
    const double mass = node[3], inverse = mass > light_cut ? 1.0 / mass : 0.0;
    const mpmi_v4 momentum = mpmi_load4(node);
    active += mass > mass_cut;
    if (mass <= light_cut && mass > DBL_MIN) {
      const double own = 1.0 / mass;
      if (values == 8) mpmi_store4(node + 4, mpmi_scale4(dt * own, mpmi_load4(node + 4)));
      mpmi_store4(node, mpmi_scale4(own, momentum));
      node[3] = mass;
      ++light;
      continue;
    }
    mpmi_v4 v = mpmi_scale4(inverse, momentum);
    if (values == 8) {
      const mpmi_v4 dv = mpmi_scale4(dt * inverse, mpmi_load4(node + 4));
      v = mpmi_sum4(v, dv);
      mpmi_store4(node + 4, dv);
    }
    mpmi_store4(node, v);
    node[3] = mass;
  }
  return (mpmi_updated){active, light};
}

mpmi_updated KERNEL(update)(int32_t values, double *nodes, int64_t count, const double *cut, double dt) {
  return values == 8 ? update(8, nodes, count, cut, dt) : update(4, nodes, count, cut, dt);
}
