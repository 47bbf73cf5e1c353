/* hashes SET [part PART PARTS | [save FOLDER | load FOLDER] NAME ...]: the scenes on an instruction set
 * (portable, baseline, avx2, avx512, neon), one in a line with its hash; of PARTS equal parts the one with
 * number PART, from 0; or the scenes of these names. With "save" they go half-way and leave their states in
 * FOLDER, from where "load" takes them to the end. Ends with 3 where processor or library lack the set. */
#include "scene.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int32_t isa_of(const char *name) {
  if (!strcmp(name, "portable")) return MPM_ISA_PORTABLE;
  static const char *const names[] = {"", "baseline", "avx2", "avx512", "neon"};
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_NEON; ++isa)
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

typedef struct wish {
  errand errand;
  const char *folder; /* of states; NULL: scenes are told as a whole */
  int64_t part, parts;
  int32_t names;
  char **name; /* no names: all scenes */
} wish;

/* 0: the arguments are none that the program knows. */
static int32_t read_arguments(int argc, char **argv, wish *w) {
  *w = (wish){.errand = {.isa = isa_of(argv[1])}, .parts = 1};
  int at = 2;
  if (argc == 5 && !strcmp(argv[2], "part")) {
    w->part = atoi(argv[3]);
    w->parts = atoi(argv[4]);
    at = 5;
  } else if (argc > 4 && (!strcmp(argv[2], "save") || !strcmp(argv[2], "load"))) {
    w->errand.half = argv[2][0] == 's' ? FIRST_HALF : SECOND_HALF;
    w->folder = argv[3];
    at = 4;
  }
  w->name = argv + at;
  w->names = argc - at;
  return w->parts > 0;
}

static int32_t is_wanted(const wish *w, const char *name) {
  int32_t wanted = !w->names;
  for (int32_t k = 0; k < w->names; ++k) wanted |= !strcmp(w->name[k], name);
  return wanted;
}

int main(int argc, char **argv) {
  wish w;
  if (argc < 2 || !read_arguments(argc, argv, &w)) return 1;
  if (!has(w.errand.isa)) return 3;
  int32_t count = 0, told = 0;
  setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* whole lines, where several processes write to one file */
  scene *list = list_scenes(&count);
  for (int64_t i = w.part * count / w.parts; i < (w.part + 1) * count / w.parts; ++i) {
    uint64_t hash = 0;
    char file[512];
    if (!is_wanted(&w, list[i].name)) continue;
    if (w.folder) {
      snprintf(file, sizeof file, "%s/%d.state", w.folder, (int)i);
      w.errand.file = file;
    }
    ++told;
    if (run_scene(&list[i], &w.errand, &hash))
      printf("%s %016" PRIx64 "\n", list[i].name, hash);
    else
      printf("%s failed\n", list[i].name);
  }
  free(list);
  return told < w.names; /* a name that no scene has */
}
