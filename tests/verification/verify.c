#include "verify.h"

#include <stdarg.h>
#include <string.h>

static struct {
  const char *name, *out;
  int quick, failed;
} state = {.out = "."};

static void stop(const char *text, const char *detail) {
  fprintf(stderr, "%s: %s%s\n", state.name, text, detail);
  exit(2);
}

void verify_begin(const char *name, int argc, char **argv) {
  state.name = name;
  for (int i = 1; i < argc; ++i) {
    if (!strcmp(argv[i], "--quick"))
      state.quick = 1;
    else if (!strcmp(argv[i], "--out") && i + 1 < argc)
      state.out = argv[++i];
    else
      stop("options are --quick and --out DIR, not ", argv[i]);
  }
}

int verify_quick(void) {
  return state.quick;
}

FILE *verify_csv(const char *name) {
  char path[4096];
  const int length = snprintf(path, sizeof path, "%s/%s.csv", state.out, name);
  FILE *file = length > 0 && (size_t)length < sizeof path ? fopen(path, "w") : NULL;
  if (!file) stop("cannot write ", path);
  return file;
}

void verify_progress(const char *format, ...) {
  va_list arguments;
  char line[256];
  va_start(arguments, format);
  vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  fprintf(stderr, "  %s: %s\n", state.name, line); /* one write, so that lines of two cases do not mix */
}

static void result(const char *what, double value, double low, double high, const char *verdict,
                   const char *source, const char *reason) {
  printf("RESULT %s | %s | %.6g | %g | %g | %s | %s%s%s\n", state.name, what, value, low, high, verdict,
         source, *reason ? "; " : "", reason);
  fflush(stdout);
}

void verify_gate(const char *what, double value, double low, double high, const char *source) {
  const int ok = value >= low && value <= high;
  state.failed += !ok;
  result(what, value, low, high, ok ? "ok" : "FAILED", source, "");
}

void verify_gate_of(const char *name, const char *what, double value, double low, double high,
                    const char *source) {
  char both[160];
  snprintf(both, sizeof both, "%s: %s", name, what);
  verify_gate(both, value, low, high, source);
}

void verify_expected_failure(const char *what, double value, double low, double high, const char *source,
                             const char *reason) {
  const int met = value >= low && value <= high;
  state.failed += met;
  result(what, value, low, high, met ? "MET" : "expected", source, reason);
}

void verify_judge(const char *what, double value, double low, double high, const char *source,
                  const char *reason) {
  if (reason)
    verify_expected_failure(what, value, low, high, source, reason);
  else
    verify_gate(what, value, low, high, source);
}

int verify_end(void) {
  return state.failed != 0;
}

double verify_slope(int32_t n, const double *h, const double *error) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (int32_t i = 0; i < n; ++i) {
    const double lx = log(h[i]), ly = log(error[i]);
    x += lx, y += ly, xx += lx * lx, xy += lx * ly;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

const verify_scheme verify_schemes[VERIFY_SCHEMES] = {
    {MPM_USL, 0, "USL"}, {MPM_USF, 0, "USF"}, {MPM_MUSL, 0, "MUSL"}, {MPM_MUSL, 1, "MUSL projected"}};

double verify_speed_of_sound(double E, double nu, double density) {
  return sqrt(E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) / density);
}

void verify_noise(int64_t n, double range, double *values) {
  uint64_t dice = 88172645463325252u;
  for (int64_t i = 0; i < n; ++i) {
    dice ^= dice << 13;
    dice ^= dice >> 7;
    dice ^= dice << 17;
    values[i] = range * ((double)(dice >> 11) * 0x1p-53 - 0.5);
  }
}

void verify_check(const mpm_context *context, mpm_status status, const char *file, int line) {
  if (!status) return;
  fprintf(stderr, "%s: %s:%d: %s: %s\n", state.name, file, line, mpm_status_name(status),
          mpm_last_error(context));
  exit(2);
}

verify_setup verify_defaults(int32_t dim, int64_t cells, double h) {
  verify_setup setup;
  if (mpm_grid_desc_init(&setup.grid, sizeof setup.grid) ||
      mpm_stepper_desc_init(&setup.stepper, sizeof setup.stepper))
    stop("the library is older than its headers", "");
  setup.grid.dim = dim;
  for (int32_t k = 0; k < dim; ++k) setup.grid.cells[k] = cells, setup.grid.spacing[k] = h;
  return setup;
}

void verify_use(verify_setup *setup, const verify_scheme *scheme, int32_t transfer) {
  setup->stepper.scheme = scheme->scheme;
  setup->stepper.projected_positions = scheme->projected;
  setup->stepper.transfer = transfer;
}

/* In no step of any case contact may give energy; what counts is that before the step. */
static mpm_status look_at_contact(void *user, const mpm_step_info *info) {
  (void)user;
  const double energy = info->kinetic_energy + fabs(info->strain_energy) + fabs(info->external_work_total);
  if (info->contact_dissipation < -1e-12 * energy) stop("contact gives energy", "");
  return MPM_OK;
}

void verify_watch(const verify_world *w) {
  verify_ok(w, mpm_stepper_set_progress(w->stepper, look_at_contact, NULL));
}

void verify_open(verify_world *w, const verify_setup *setup) {
  memset(w, 0, sizeof *w);
  w->dim = setup->grid.dim;
  if (mpm_context_create(NULL, &w->context)) stop("no context", "");
  verify_ok(w, mpm_grid_create(w->context, &setup->grid, &w->grid));
  verify_ok(w, mpm_stepper_create(w->context, w->grid, &setup->stepper, &w->stepper));
  verify_watch(w);
}

mpm_material *verify_material(verify_world *w, const char *model, const mpm_param *params, int32_t count) {
  if (w->materials == VERIFY_MOST) stop("too many laws: ", model);
  mpm_material **material = &w->material[w->materials++];
  verify_ok(w, mpm_material_create(w->context, model, params, count, material));
  return *material;
}

mpm_material *verify_elastic(verify_world *w, const char *model, double E, double nu, double density) {
  const mpm_param params[3] = {{"E", E}, {"nu", nu}, {"density", density}};
  return verify_material(w, model, params, 3);
}

mpm_particles *verify_set(verify_world *w, mpm_material *material) {
  if (w->sets == VERIFY_MOST) stop("too many sets", "");
  mpm_particles **set = &w->set[w->sets++];
  verify_ok(w, mpm_particles_create(w->context, w->grid, material, set));
  verify_ok(w, mpm_stepper_add(w->stepper, *set));
  return *set;
}

mpm_obstacle_desc verify_obstacle_defaults(mpm_contact_desc *contact, int32_t shape, int32_t motion,
                                           double friction, double turn) {
  mpm_obstacle_desc desc;
  if (mpm_contact_desc_init(contact, sizeof *contact) || mpm_obstacle_desc_init(&desc, sizeof desc))
    stop("the library is older than its headers", "");
  contact->friction = friction;
  desc.contact = contact;
  desc.shape = shape;
  desc.motion = motion;
  desc.orientation[0] = cos(0.5 * turn);
  desc.orientation[3] = sin(0.5 * turn);
  return desc;
}

mpm_obstacle *verify_obstacle(verify_world *w, const mpm_obstacle_desc *desc) {
  if (w->obstacles == VERIFY_MOST) stop("too many obstacles", "");
  mpm_obstacle **obstacle = &w->obstacle[w->obstacles++];
  verify_ok(w, mpm_obstacle_create(w->context, desc, obstacle));
  verify_ok(w, mpm_stepper_add_obstacle(w->stepper, *obstacle));
  return *obstacle;
}

void verify_close(verify_world *w) {
  verify_ok(w, mpm_stepper_destroy(w->stepper));
  for (int32_t i = 0; i < w->obstacles; ++i) verify_ok(w, mpm_obstacle_destroy(w->obstacle[i]));
  for (int32_t i = 0; i < w->sets; ++i) verify_ok(w, mpm_particles_destroy(w->set[i]));
  for (int32_t i = 0; i < w->materials; ++i) verify_ok(w, mpm_material_destroy(w->material[i]));
  verify_ok(w, mpm_grid_destroy(w->grid));
  if (mpm_context_destroy(w->context)) stop("the context has objects left", "");
}

double *verify_array(int64_t n) {
  double *values = calloc((size_t)n, sizeof *values);
  if (!values) stop("out of memory", "");
  return values;
}

double *verify_get(const verify_world *w, const mpm_particles *set, const char *field, int32_t components) {
  const int64_t n = mpm_particles_count(set);
  double *values = verify_array(n * components);
  verify_ok(w, mpm_particles_get(set, field, MPM_F64, components, n, NULL, values));
  return values;
}

void verify_put(const verify_world *w, mpm_particles *set, const char *field, int32_t components,
                const double *values) {
  verify_ok(w, mpm_particles_set(set, field, MPM_F64, components, mpm_particles_count(set), NULL, values));
}

mpm_step_info verify_info(const verify_world *w) {
  mpm_step_info info = {.struct_size = sizeof info};
  verify_ok(w, mpm_stepper_info(w->stepper, &info));
  return info;
}

void verify_fill_box(const verify_world *w, mpm_particles *set, const double *lower, const double *upper,
                     int32_t per_cell) {
  const int32_t n[3] = {per_cell, per_cell, per_cell};
  verify_ok(w, mpm_particles_fill_box(set, lower, upper, n, NULL, NULL));
}

void verify_fill_rings(const verify_world *w, mpm_particles *set, const double *centre, double inner,
                       double outer, int32_t layers) {
  const double width = (outer - inner) / layers;
  for (int32_t k = 0; k < layers; ++k) {
    const double from = inner + k * width, to = from + width, r = 0.5 * (from + to);
    const int32_t n = (int32_t)(2.0 * PI * r / width + 0.5);
    const double volume = PI * (to * to - from * from) / n;
    for (int32_t i = 0; i < n; ++i) {
      const double angle = 2.0 * PI * (i + 0.5) / n,
                   x[2] = {centre[0] + r * cos(angle), centre[1] + r * sin(angle)};
      verify_ok(w, mpm_particles_add(set, 1, x, NULL, &volume, NULL, NULL, NULL));
    }
  }
}

void verify_place(const verify_world *w, mpm_particles *set, double turn, const double *by) {
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", w->dim);
  for (int64_t i = 0; i < n; ++i) {
    if (w->dim > 1) {
      const double a = x[i], b = x[n + i];
      x[i] = cos(turn) * a - sin(turn) * b;
      x[n + i] = sin(turn) * a + cos(turn) * b;
    }
    for (int32_t c = 0; c < w->dim; ++c) x[c * n + i] += by[c];
  }
  verify_put(w, set, "position", w->dim, x);
  free(x);
}

mpm_step_info verify_advance(const verify_world *w, double cfl, double t) {
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_advance_desc go;
  verify_ok(w, mpm_advance_desc_init(&go, sizeof go));
  go.cfl = cfl;
  go.t_end = t;
  verify_ok(w, mpm_advance(w->stepper, &go, &info));
  return info;
}

mpm_step_info verify_step(const verify_world *w, double dt) {
  mpm_step_info info = {.struct_size = sizeof info};
  verify_ok(w, mpm_step(w->stepper, dt, &info));
  return info;
}

verify_laws verify_laws_begin(const mpm_step_info *first) {
  return (verify_laws){.first = *first};
}

void verify_laws_see(verify_laws *laws, const mpm_step_info *now) {
  const double energy = laws->first.kinetic_energy + laws->first.strain_energy;
  double change = 0.0, first = 0.0;
  for (int32_t c = 0; c < 3; ++c) {
    change += pow(now->momentum[c] - laws->first.momentum[c], 2);
    first += pow(laws->first.momentum[c], 2);
  }
  laws->momentum = fmax(laws->momentum, sqrt(change / first));
  laws->energy = fmax(laws->energy, (now->kinetic_energy + now->strain_energy) / energy);
  laws->dissipation = fmin(laws->dissipation, now->contact_dissipation / energy);
}

void verify_laws_gates(const char *name, const verify_laws *laws, double rounding, double most_energy) {
  const char *source = "contact takes energy and never gives any";
  verify_gate_of(name, "largest change of momentum / first", laws->momentum, 0.0, rounding, "conservation");
  verify_gate_of(name, "largest energy / first", laws->energy, 0.0, most_energy, source);
  verify_gate_of(name, "least dissipation of a step / energy", laws->dissipation, -1e-12, 0.0, source);
}
