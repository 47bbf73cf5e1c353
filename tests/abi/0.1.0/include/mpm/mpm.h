/**
 * @file mpm.h
 * libmpm, the Material Point Method: all public headers. What stands here holds for all headers.
 *
 * @par Status
 * 0 done; > 0 not done, state unchanged (1..5: a smaller dt may cure it); < 0 refused or failed, see
 * mpm_last_error(). Unless stated otherwise the objects are unchanged in either case. A value returned by a
 * callback is passed on in mpm_step_info.callback_status. Every function may return MPM_E_ARG (a NULL that is
 * not allowed, a value out of range, a bad struct_size), MPM_E_NOMEM, MPM_E_UNSUPPORTED (with a sentence that
 * says what to use instead), MPM_E_INTERNAL, and MPM_E_STATE (called from a callback); declarations name the
 * statuses that mean more.
 *
 * @par Units
 * Any consistent set. 1-D is uniaxial strain per unit area, 2-D plane strain per unit thickness.
 *
 * @par Structs
 * The caller sets struct_size = sizeof, or calls the _init; the library reads and writes no further.
 * Fields are only appended, and every appended default is all-zero bits: a library that meets a larger struct
 * accepts it when the unknown tail is zero and returns MPM_E_UNSUPPORTED otherwise. Reserved fields are zero.
 *
 * @par Arrays
 * In callbacks and copies component-major: component c of item i is data[c * ld + i]. Tensors 3x3
 * have c = 3 * row + column and are full (plane strain: F33 = 1; 1-D: F22 = F33 = 1; laws that keep only the
 * volume, as the fluid: F = J^(1/3) I). Symmetric ones: xx yy zz xy yz xz. Views show the stored layout,
 * which may be compact: see the table of fields in particles.h. Arguments are read or copied during the call
 * unless stated otherwise; names are zero-terminated.
 *
 * @par Slots
 * Particle arrays in library order contain inert slots (id < 0, mass 0, F = I, position inside the
 * grid) that pad blocks for speed. Reading or computing on them is harmless; their results are ignored.
 *
 * @par Times
 * A step goes from t_n to t_n+1 = t_n + dt. Positions, masses and nodes in batches are those of t_n; t
 * in a batch is the time for which the value is wanted: t_n for explicit forces, t_n+1 for implicit ones.
 *
 * @par Threads
 * No globals. A context and its objects serve one thread at a time; several contexts serve several
 * threads. Callbacks marked (mt) may run on several threads at once when concurrency is not 1 and
 * serial_callbacks is 0; all others, and all of them with serial_callbacks, run on the calling thread. A
 * callback may call only mpm_operator_*, mpm_batch_field(), mpm_version() and mpm_status_name(); it must not
 * throw or jump out. alloc, release and log run on the calling thread only.
 *
 * @par Results
 * Same binary, same instruction set, same input: same bits, for any number of threads, any executor,
 * any order in which the same ids were added, and across save and load at any step.
 */
#ifndef MPM_H
#define MPM_H

#include <mpm/types.h>

#include <mpm/context.h>
#include <mpm/grid.h>
#include <mpm/io.h>
#include <mpm/material.h>
#include <mpm/particles.h>
#include <mpm/stepper.h>

#endif
