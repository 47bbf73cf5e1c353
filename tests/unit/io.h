/* Tests of states and files share two bodies of different laws with fields of the host, which move fast
 * enough to be sorted anew every few steps. */
#ifndef IO_H
#define IO_H

#include "io/state.h"
#include "particles/builtin_fields.h"
#include "world.h"

typedef struct io_setup {
  int32_t dim, transfer, scheme, periodic, concurrency, references, empty;
} io_setup;

io_setup io_plain(int32_t dim);
world_desc io_desc(const io_setup *setup);
void io_open(world *w, const io_setup *setup);
/* Describes the same laws and settings on this grid, without fields, particles and walls. */
world_desc io_bare_desc(const mpm_grid_desc *grid);
/* Opens a world of two particles in corners of a grid of so many cells, so that the last node is not active,
 * and makes a step. */
void io_open_apart(world *w, int32_t dim, int64_t cells);

TCase *io_state_case(void);
TCase *io_unlike_case(void);
TCase *io_damage_case(void);
TCase *io_hash_case(void);
TCase *io_file_case(void);
TCase *io_replace_case(void);
TCase *io_output_case(void);
TCase *io_grid_case(void);
TCase *io_stream_case(void);

#endif
