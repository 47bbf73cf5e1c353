/* Visits to the blocks with particles, by all tasks. */
#ifndef MPMI_VISIT_H
#define MPMI_VISIT_H

#include "layout/step.h"

typedef struct mpmi_visit {
  int32_t task;
  int64_t block, next; /* next: the one that the task visits after it, or -1 */
} mpmi_visit;
typedef void (*mpmi_visit_fn)(void *user, const mpmi_visit *visit);

typedef void (*mpmi_range_fn)(void *user, int32_t task, const int32_t *block, int64_t count);
/* Visits ranges of blocks, each of one task; for visits to every block that write to no node and keep
 * something from one block to the next. */
mpm_status mpmi_visit_ranges(const mpmi_step *step, int32_t calls_host, mpmi_range_fn visit, void *user);
/* Visits each block once; for visits that write to no node. */
mpm_status mpmi_visit_blocks(const mpmi_step *step, int32_t calls_host, mpmi_visit_fn visit, void *user);
/* Visits blocks colour by colour: those that are visited at the same time share no node of their tiles, so
 * that what is added to nodes is added in one order. */
mpm_status mpmi_visit_colours(const mpmi_step *step, int32_t calls_host, mpmi_visit_fn visit, void *user);
/* Visits the blocks with particles that are marked, by their number; for visits that write to no node. Tasks
 * get equal numbers of them. */
mpm_status mpmi_visit_marked(const mpmi_step *step, const uint8_t *mark, int32_t calls_host,
                             mpmi_visit_fn visit, void *user);
/* Visits those of one colour, which may write to their tiles' nodes. */
mpm_status mpmi_visit_colour(const mpmi_step *step, const uint8_t *mark, int32_t colour, int32_t calls_host,
                             mpmi_visit_fn visit, void *user);
/* Visits marked blocks of other parts, which have guests or nothing. */
mpm_status mpmi_visit_ghosts(const mpmi_step *step, const uint8_t *mark, int32_t calls_host,
                             mpmi_visit_fn visit, void *user);
/* Visits one block after the other, by task 0; for visits that write anywhere. */
void mpmi_visit_in_turn(const mpmi_step *step, mpmi_visit_fn visit, void *user);

#endif
