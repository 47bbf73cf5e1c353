/* What the machine can do at most, measured in the same minute as the library. */
#ifndef BENCH_CEILINGS_H
#define BENCH_CEILINGS_H

/* Fused multiply-adds in double precision on one core, 1e9 operations per second: the best of the widths that
 * the processor has. */
double bench_fma_peak(void);
/* In-place update of an array that no cache holds, on one core, 1e9 bytes read and written per second. */
double bench_update_bandwidth(void);

double bench_seconds(void);
/* Of the processor, in all threads of the process: others that use the machine count less. */
double bench_processor_seconds(void);

#endif
