/* Particles fill what a mesh encloses: the lattice points that it winds round. */
#include <math.h>

#include "particles/add.h"
#include "particles/mesh.h"

/* Away from the mesh the whole number is that of the point before, which is far less work to know. */
static mpm_status inside_mesh(void *user, int32_t dim, int64_t n, int64_t ld, const double *position,
                              uint8_t *inside) {
  const mpmi_mesh *mesh = user;
  double before[3] = {0.0, 0.0, 0.0}, whole = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    double x[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < dim; ++k) x[k] = position[k * ld + i] * mesh->scale;
    const double holes = mpmi_mesh_holes(mesh, x);
    if (!i || !mpmi_mesh_same_side(mesh, before, x)) whole = mpmi_mesh_winding(mesh, x) - holes;
    inside[i] = fabs(whole + holes) > 0.5;
    for (int32_t k = 0; k < dim; ++k) before[k] = x[k];
  }
  return MPM_OK;
}

static mpm_status check_count(const mpm_particles *set, const char *what, int64_t n) {
  return n >= 1 && n <= INT32_MAX ? MPM_OK
                                  : mpmi_fail(set->context, MPM_E_ARG, "%s is %lld, must be 1 to %d", what,
                                              (long long)n, (int)INT32_MAX);
}

mpm_status mpm_particles_fill_mesh(mpm_particles *particles, int64_t n, const double *position,
                                   int64_t elements, const int64_t *corner, const int32_t *per_cell,
                                   int64_t *first_id, int64_t *count) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_context *c = particles->context;
  const int32_t dim = particles->grid->dim;
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status && dim == 1)
    status = mpmi_fail(c, MPM_E_UNSUPPORTED, "the grid is 1-D, where a mesh encloses nothing: use %s",
                       "mpm_particles_fill_box()");
  if (!status && (!position || !corner || !per_cell))
    status = mpmi_fail(c, MPM_E_ARG, "%s is NULL", !position ? "position" : corner ? "per_cell" : "corner");
  if (!status) status = check_count(particles, "n", n);
  if (!status) status = check_count(particles, "elements", elements);
  if (status) return mpmi_agree(c, status);
  mpmi_mesh mesh;
  status = mpmi_mesh_open(c, dim, n, position, elements, corner, &mesh);
  if (status) return mpmi_agree(c, status);
  double lower[3], upper[3];
  for (int32_t k = 0; k < dim; ++k) {
    lower[k] = mesh.lower[k] / mesh.scale;
    upper[k] = mesh.upper[k] / mesh.scale;
  }
  status = mpmi_fill_part(particles, lower, upper, per_cell, inside_mesh, &mesh, first_id, count);
  mpmi_mesh_close(&mesh);
  return status;
}
