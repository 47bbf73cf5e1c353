/**
 * @file mpm.h
 * libmpm, the Material Point Method: all public headers. What stands here holds for all of them.
 *
 * @par Status
 * A call returns 0 if it was done; a value > 0 if it was not done and the state is unchanged (1..5: a smaller
 * dt may cure it); a value < 0 if it was refused or failed. In both cases mpm_last_error() says why, until
 * another call fails; where there is no context to ask, mpm_status_text() does in general. Unless stated
 * otherwise objects are unchanged in the last two cases. A value returned by a callback is passed on in
 * mpm_step_info.callback_status. Every function may return MPM_E_ARG (a NULL that is not allowed, a value out
 * of range, a bad struct_size), MPM_E_NOMEM, MPM_E_UNSUPPORTED (with a sentence that says what to use
 * instead), MPM_E_INTERNAL, and MPM_E_STATE (another call on the context is under way: the call was made from
 * a callback, or from another thread). Declarations name the statuses that mean more.
 *
 * @par Units
 * Any consistent set of units will do. 1-D is uniaxial strain per unit area, 2-D plane strain per unit
 * thickness, a body of revolution per radian (MPM_AXISYMMETRIC), or a sheet in plane stress per thickness at
 * the start (MPM_PLANE_STRESS).
 *
 * @par Structs
 * All public structs but mpm_param begin with struct_size, and later releases only append fields. The default
 * of an appended field is all-zero bits and means what was so before it. Hosts and libraries of different
 * releases work together:
 *
 * @par
 * - Descriptors: the caller sets struct_size = sizeof, or calls the _init. The library reads no further. It
 *   accepts every size from that of the first release on: fields that a smaller struct lacks have their
 *   defaults, and a larger struct is accepted as long as the tail that the library does not know is zero
 *   (MPM_E_UNSUPPORTED otherwise).
 * - Outputs (mpm_step_info, mpm_contact_info, mpm_view, mpm_profile, mpm_operator_info): the caller sets
 *   struct_size = sizeof, and the library writes no further. Fields that it does not know stay as the caller
 *   left them, so zeros are the values to start with.
 * - Batches, and the info of mpm_progress_fn: the library sets struct_size to its own size. A host that uses
 *   a field newer than the oldest library it runs with asks first whether struct_size reaches that far.
 * - Fields called reserved are zero: in what the library writes, and in what it reads, where another value
 *   is MPM_E_UNSUPPORTED, since a later release may have given it a meaning.
 *
 * @par Arrays
 * In callbacks and copies arrays are component-major: component c of item i is data[c * ld + i]. Tensors of
 * 3x3 have component c = 3 * row + column and are full (plane strain: F33 = 1; 1-D: F22 = F33 = 1; laws that
 * keep only the volume, as the fluid does: F = J^(1/3) I). Symmetric ones have xx yy zz xy yz xz. Views show
 * the stored layout, which may be compact: see the table of fields in particles.h. Arguments are read or
 * copied during the call unless stated otherwise; names are zero-terminated. Memory that the library lends
 * stays the library's: the host neither frees it nor keeps it beyond the time that the declaration names.
 *
 * @par Slots
 * Particle arrays in library order contain inert slots (id < 0, mass 0, F = I, position inside the grid) that
 * pad blocks for speed. Reading them and computing on them is harmless; their results are ignored.
 *
 * @par Times
 * A step goes from t_n to t_n+1 = t_n + dt. Positions, masses and nodes in batches are those of t_n; t
 * in a batch is the time for which the value is wanted: t_n for explicit forces, t_n+1 for implicit ones.
 *
 * @par Threads
 * There are no globals. A context and its objects serve one thread at a time; several contexts serve several
 * threads. Callbacks marked (mt) may run on several threads at once when concurrency is not 1 and
 * serial_callbacks is 0; all others, and all of them with serial_callbacks, run on the calling thread. alloc,
 * release and log run on the calling thread only. A callback must not throw or jump out.
 *
 * @par Calls in callbacks
 * While a call on a context or one of its objects is under way, every other is refused with MPM_E_STATE and
 * changes nothing: in callbacks of every kind, alloc, release, log and parallel_for included, and in other
 * threads. Free are mpm_batch_field(), mpm_particles_count(), mpm_context_memory(), mpm_last_error() and, in
 * the callback of mpm_stepper_set_linear_solver() and one at a time, mpm_operator_*; all functions without a
 * handle, such as mpm_version(), mpm_status_name(), mpm_status_text() and the _init of descriptors; and all
 * calls on other contexts.
 *
 * @par Floating-point environment
 * The library computes in the default environment (to nearest, no traps, tiny numbers kept), whatever that of
 * the host is and whenever it was set. A host that traps exceptions is not trapped in a call; rounding and
 * flushing to zero change no status, no bit of a state and no file; and after the call the host has its
 * environment back, with the flags as they were before. The same holds on the threads of a host's executor.
 * Callbacks find the default environment, too, on whatever thread they run, so that their results do not
 * depend on it either. What they leave behind is dropped, flags included: a callback that wants traps sets
 * them when it begins and looks at flags before it returns.
 *
 * @par Results
 * The same binary on the same instruction set gives, for the same input, the same bits: for any number of
 * threads, any executor, any order in which the same ids were added, and across save and load at any step.
 *
 * @par
 * With MPM_ISA_PORTABLE it gives the same bits on every platform as well: processor, byte order, size of
 * pointers, operating system, C library, compiler and its optimisation do not matter, and a state saved on
 * one platform goes on with the same bits on another. That holds for one version of the library, where
 * doubles are those of IEEE 754 with all of their operations rounded to nearest once, the library was
 * compiled without options that let the compiler change results (-ffast-math and its like), and callbacks
 * keep the same rules: of the C library's functions sqrt, fma, floor and their like have the same bits
 * everywhere, exp, sin and pow have not. Sign and payload of values that are not numbers are left open.
 * docs/portability.md lists the platforms on which this is tested.
 *
 * @par Sources
 * Equations are those of Guilkey, An Introduction to the Material Point Method; Guilkey and Weiss, Int. J.
 * Numer. Meth. Engng. 57, 2003; MPoint Theory and Background; Steffen et al., CMES 31(2), 2008; Jiang et al.,
 * ACM Trans. Graph. 34(4), 2015; Hu et al., ACM Trans. Graph. 37(4), 2018; Hammerquist and Nairn, Comput.
 * Methods Appl. Mech. Engrg. 318, 2017.
 */
#ifndef MPM_H
#define MPM_H

#include <mpm/types.h>

#include <mpm/adaption.h>
#include <mpm/contact.h>
#include <mpm/context.h>
#include <mpm/grid.h>
#include <mpm/heat.h>
#include <mpm/io.h>
#include <mpm/material.h>
#include <mpm/obstacle.h>
#include <mpm/operator.h>
#include <mpm/parallel.h>
#include <mpm/particles.h>
#include <mpm/stepper.h>
#include <mpm/surface.h>

#endif
