/* hashes SET [PART PARTS | NAME]: the scenes on an instruction set (baseline, avx2, avx512), one in a line
 * with its hash; of PARTS equal parts the one with number PART, from 0; or the scenes whose line begins with
 * NAME. Ends with 3 where processor or library lack the set. */
#include "scene.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int32_t isa_of(const char *name) {
  static const char *const names[] = {"", "baseline", "avx2", "avx512"};
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_AVX512; ++isa)
    if (!strcmp(name, names[isa])) return isa;
  fprintf(stderr, "there is no instruction set %s\n", name);
  exit(1);
}

static int32_t has(int32_t isa) {
  mpm_context *context;
  mpm_context_desc c;
  mpm_context_desc_init(&c, sizeof c);
  c.isa = isa;
  const mpm_status status = mpm_context_create(&c, &context);
  mpm_context_destroy(context);
  return status != MPM_E_UNSUPPORTED;
}

int main(int argc, char **argv) {
  if (argc < 2 || argc > 4) return 1;
  const int32_t isa = isa_of(argv[1]);
  if (!has(isa)) return 3;
  int32_t count = 0;
  scene *list = list_scenes(&count);
  const char *name = argc == 3 ? argv[2] : "";
  const int64_t part = argc == 4 ? atoi(argv[2]) : 0, parts = argc == 4 ? atoi(argv[3]) : 1;
  if (parts < 1) return 1;
  for (int64_t i = part * count / parts; i < (part + 1) * count / parts; ++i) {
    uint64_t hash = 0;
    if (strncmp(list[i].name, name, strlen(name))) continue;
    if (run_scene(&list[i], isa, &hash))
      printf("%s %016" PRIx64 "\n", list[i].name, hash);
    else
      printf("%s failed\n", list[i].name);
  }
  free(list);
  return 0;
}
