/* What the programs of the verification share: options of the command line, CSV files, gates, and a world of
 * one context, grid and stepper with a few laws and sets, over the public interface. What the library refuses
 * ends the program with the library's sentence. */
#ifndef VERIFY_H
#define VERIFY_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <mpm/mpm.h>

#define PI 3.14159265358979323846

/* Options: --quick for a variant of seconds, --out DIR for CSV files (default: the working folder). */
void verify_begin(const char *name, int argc, char **argv);
int verify_quick(void);
FILE *verify_csv(const char *name); /* <dir>/<name>.csv, to be closed by the caller */

/* A line of progress for those who wait. */
void verify_progress(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* low <= value <= high or the case fails; either may be infinite. A value that is not a number fails. source:
 * where the gate is from. */
void verify_gate(const char *what, double value, double low, double high, const char *source);
/* The same for "name: what". */
void verify_gate_of(const char *name, const char *what, double value, double low, double high,
                    const char *source);
/* A gate that a correct method does not meet, for the reason given: listed apart, and the case fails once it
 * is met. */
void verify_expected_failure(const char *what, double value, double low, double high, const char *source,
                             const char *reason);
/* The one or the other: the latter where a reason is given. */
void verify_judge(const char *what, double value, double low, double high, const char *source,
                  const char *reason);
int verify_end(void); /* exit status */

/* Order of convergence: slope of log error over log h, by least squares. */
double verify_slope(int32_t n, const double *h, const double *error);

/* The explicit schemes. */
typedef struct verify_scheme {
  int32_t scheme, projected; /* projected_positions */
  const char *name;
} verify_scheme;
enum { VERIFY_USL, VERIFY_USF, VERIFY_MUSL, VERIFY_PROJECTED, VERIFY_SCHEMES };
extern const verify_scheme verify_schemes[VERIFY_SCHEMES];

double verify_speed_of_sound(double E, double nu, double density); /* of compression, without stress */
/* n numbers between -range / 2 and range / 2, the same in every call. */
void verify_noise(int64_t n, double range, double *values);

typedef struct verify_setup {
  mpm_grid_desc grid;
  mpm_stepper_desc stepper;
} verify_setup;

enum { VERIFY_MOST = 8 };
typedef struct verify_world {
  mpm_context *context;
  mpm_grid *grid;
  mpm_stepper *stepper;
  mpm_material *material[VERIFY_MOST];
  mpm_particles *set[VERIFY_MOST];
  mpm_obstacle *obstacle[VERIFY_MOST];
  int32_t materials, sets, obstacles, dim;
} verify_world;

/* The library's defaults on a grid of `cells` cells of edge h along each axis, from the origin. */
verify_setup verify_defaults(int32_t dim, int64_t cells, double h);
void verify_use(verify_setup *setup, const verify_scheme *scheme, int32_t transfer);
void verify_open(verify_world *w, const verify_setup *setup); /* on one thread */
/* Looks at the contact of all steps to come, as verify_open() has it done. */
void verify_watch(const verify_world *w);
mpm_material *verify_material(verify_world *w, const char *model, const mpm_param *params, int32_t count);
mpm_material *verify_elastic(verify_world *w, const char *model, double E, double nu, double density);
mpm_particles *verify_set(verify_world *w, mpm_material *material); /* an empty one, in the stepper */
/* The library's defaults but for shape, motion, friction, and an angle about the third axis. The desc points
 * to `contact`. */
mpm_obstacle_desc verify_obstacle_defaults(mpm_contact_desc *contact, int32_t shape, int32_t motion,
                                           double friction, double turn);
mpm_obstacle *verify_obstacle(verify_world *w, const mpm_obstacle_desc *desc); /* in the stepper */
void verify_close(verify_world *w);

/* Whole field of a set by ascending id, [components][n]; the caller frees it. */
double *verify_get(const verify_world *w, const mpm_particles *set, const char *field, int32_t components);
void verify_put(const verify_world *w, mpm_particles *set, const char *field, int32_t components,
                const double *values);
mpm_step_info verify_info(const verify_world *w);
double *verify_array(int64_t n); /* zeros */
/* A box of particles, as many along each axis of a cell. */
void verify_fill_box(const verify_world *w, mpm_particles *set, const double *lower, const double *upper,
                     int32_t per_cell);
/* A ring of particles in rings, so many layers of them, of exact volume; in 2-D. */
void verify_fill_rings(const verify_world *w, mpm_particles *set, const double *centre, double inner,
                       double outer, int32_t layers);
/* Turns a set about the third axis through the origin, then shifts it. */
void verify_place(const verify_world *w, mpm_particles *set, double turn, const double *by);
mpm_step_info verify_advance(const verify_world *w, double cfl, double t); /* to time t by stable steps */
mpm_step_info verify_step(const verify_world *w, double dt); /* ends the program where contact gives energy */

/* What a collision must keep, from the info of its start and of each step. */
typedef struct verify_laws {
  mpm_step_info first;
  double momentum, energy; /* largest change of momentum, largest energy; over the first */
  double dissipation;      /* least of a step, over the first energy */
} verify_laws;
verify_laws verify_laws_begin(const mpm_step_info *first);
void verify_laws_see(verify_laws *laws, const mpm_step_info *now);
/* Gates: momentum changes by no more than rounding, energy stays below a bound, contact gives none. */
void verify_laws_gates(const char *name, const verify_laws *laws, double rounding, double most_energy);

/* Ends the program unless the call is MPM_OK. */
#define verify_ok(world, call) verify_check((world)->context, (call), __FILE__, __LINE__)
void verify_check(const mpm_context *context, mpm_status status, const char *file, int line);

#endif
