/* A measurement in a process of its own, whose peak of memory is that of the case. */
#ifndef BENCH_PROCESS_H
#define BENCH_PROCESS_H

#include <stddef.h>

typedef void (*bench_fn)(const void *job, void *result);
/* Fills *result of `size` bytes, at most a pipe's worth. 0: the process died. */
int bench_in_process(bench_fn fn, const void *job, void *result, size_t size);
/* Bytes that this process has had at most. */
double bench_peak_bytes(void);

#endif
