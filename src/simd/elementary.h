/* Elementary functions whose bits are the same on every platform: C libraries differ in the last digit of
 * theirs. No number that reaches a state comes from the C library but square roots and what is exact
 * (tests/api/libm.sh lists what is allowed); that holds for callbacks of tests and for parameters of laws as
 * well. Special values are those of C's functions, errno is left alone. Each is within 1 unit in the last
 * place (measured: 0.88). */
#ifndef MPMI_ELEMENTARY_H
#define MPMI_ELEMENTARY_H

double mpmi_exp(double x);
double mpmi_expm1(double x);
double mpmi_ln(double x); /* log(); mpmi_log() is what tells the host */
double mpmi_log1p(double x);
double mpmi_pow(double x, double y);
double mpmi_cbrt(double x);
double mpmi_hypot(double x, double y);

/* Of angles up to 2^20, beyond which they give NaN. */
double mpmi_sin(double x);
double mpmi_cos(double x);
double mpmi_tan(double x);

#endif
