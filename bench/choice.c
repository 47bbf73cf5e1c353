#include "choice.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

int32_t bench_chosen(const bench_choice *choice, const char *name) {
  return (!choice->only || strstr(name, choice->only)) &&
         (!choice->exactly || !strcmp(name, choice->exactly));
}

/* As the kernel has it, whatever was asked of the loader. */
int32_t bench_print_library(void) {
  char line[4096];
  const char *path = NULL;
  FILE *maps = fopen("/proc/self/maps", "r");
  while (maps && !path && fgets(line, sizeof line, maps)) {
    line[strcspn(line, "\n")] = 0;
    if (strstr(line, "/libmpm.so")) path = strchr(line, '/');
  }
  if (path) printf("library\t%s\n", path);
  if (!path) fprintf(stderr, "bench: from which file libmpm was loaded is not to be found out\n");
  if (maps) fclose(maps);
  fflush(stdout); /* before processes for the cases come */
  return path != NULL;
}

void bench_print_bare(const char *name, int32_t threads, double figure, uint64_t hash) {
  printf("%s\t%d\t%.6g\t%016" PRIx64 "\n", name, (int)threads, figure, hash);
  fflush(stdout);
}
