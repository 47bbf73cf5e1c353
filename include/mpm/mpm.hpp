/**
 * @file mpm.hpp
 * The C interface from C++17. The wrapper is header-only and consists of nothing but calls of the C
 * interface.
 *
 * @par Errors
 * A call that the library refuses (status < 0) throws mpm::error with the status and the sentence of
 * mpm_last_error(). Steps that are not done and left the state as it was (status > 0) are no errors of the
 * program: step(), advance() and the parts of a step return them as mpm::outcome, which may not be ignored.
 * Every other call throws for any status but MPM_OK. Destructors never throw.
 *
 * @par Lifetimes
 * Wrappers move and do not copy. Each shares ownership of what it was made with: a grid keeps its context, a
 * set its grid and its material, a stepper its grid, its sets, its obstacles and surfaces, a view what it
 * looks into. Wrappers may be destroyed in any order; a C object is destroyed with the last that needs it. An
 * object that was handed to C code by handle() and is in use there outlives its wrapper and is then leaked,
 * not freed under the user.
 *
 * @par Callbacks
 * A callback is any copyable function object, and is kept while it may be called. One that throws stops the
 * call that runs it, with the state as it was, which then throws the same exception; of several exceptions at
 * once it is that of the failure that the library reports, which does not depend on threads. Callbacks marked
 * (mt) in the C headers may run on several threads at once.
 *
 * @par Threads
 * As in C: a context and everything made with it, destructors included, serve one thread at a time.
 */
#ifndef MPM_HPP
#define MPM_HPP

#include <mpm/contact.hpp>
#include <mpm/context.hpp>
#include <mpm/grid.hpp>
#include <mpm/io.hpp>
#include <mpm/material.hpp>
#include <mpm/obstacle.hpp>
#include <mpm/particles.hpp>
#include <mpm/stepper.hpp>
#include <mpm/surface.hpp>
#include <mpm/mpm.h>
#include <mpm/types.hpp>
#include <mpm/view.hpp>

#endif
