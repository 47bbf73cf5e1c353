/* parts [every MANY SKIP] COUNT [NAME ...]: tells scenes of tests/hashes on one part and on COUNT parts,
 * threads of this process, and compares hashes: of state, reports of all steps, reactions and nodal fields.
 * One scene in a line, with "equal", or "refused" and the library's sentence, or what went wrong; at the end
 * how many of each. All scenes, or every MANY-th of those from number SKIP on, or those of these names. Ends
 * with 1 unless all are equal or refused. */
#include "scene.h"
#include "parts.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FAILED, EQUAL, REFUSED, OTHER, OUTCOMES };

typedef struct telling {
  scene is;
  int32_t told[PARTS_MOST];
  uint64_t hash[PARTS_MOST];
  char refusal[PARTS_MOST][REFUSAL];
} telling;

static void tell_part(int32_t part, const mpm_transport *transport, void *user) {
  telling *t = user;
  const errand how = {.transport = transport, .refusal = t->refusal[part]};
  t->told[part] = run_scene(&t->is, &how, &t->hash[part]);
}

/* By one part: with a transport where its linear solver depends on that. */
static int32_t tell_alone(telling *t, uint64_t *hash, char *refusal) {
  const errand how = {.refusal = refusal};
  parts_plan plan = {.fail_part = 0};
  if (t->is.scheme != MPM_NEWMARK || (t->is.solver != MPM_SOLVER_AUTO && t->is.solver != MPM_SOLVER_GMRES))
    return run_scene(&t->is, &how, hash);
  if (parts_run(1, tell_part, t, &plan)) return 0;
  *hash = t->hash[0];
  return t->told[0];
}

static int32_t compare(telling *t, int32_t parts, char *why, size_t room) {
  uint64_t hash = 0;
  parts_plan plan = {.fail_part = 0};
  why[0] = '\0';
  if (t->is.solver == MPM_SOLVER_HOST) {
    snprintf(why, room, "the host's solver of this scene is for one part");
    return REFUSED;
  }
  char alone[REFUSAL] = "";
  if (!tell_alone(t, &hash, alone)) {
    snprintf(why, room, "one part failed. %s", alone);
    return FAILED;
  }
  if (parts_run(parts, tell_part, t, &plan)) {
    snprintf(why, room, "%s", plan.text);
    return FAILED;
  }
  int32_t told = 0, refused = 0, equal = 0;
  for (int32_t p = 0; p < parts; ++p) {
    told += t->told[p];
    refused += t->refusal[p][0] != '\0';
    equal += t->told[p] && t->hash[p] == hash;
  }
  snprintf(why, room, "%s", t->refusal[0]);
  if (equal == parts) return EQUAL;
  if (refused == parts) return REFUSED;
  return told == parts ? OTHER : FAILED;
}

static int32_t is_named(const scene *is, int32_t count, char **name) {
  int32_t named = !count;
  for (int32_t k = 0; k < count; ++k) named |= !strcmp(name[k], is->name);
  return named;
}

int main(int argc, char **argv) {
  static const char *const outcome[OUTCOMES] = {"failed", "equal", "refused", "other bits"};
  const int32_t picks = argc > 3 && !strcmp(argv[1], "every"), at = picks ? 4 : 1;
  const int32_t every = picks ? atoi(argv[2]) : 1, skip = picks ? atoi(argv[3]) : 0;
  const int32_t parts = argc > at ? atoi(argv[at]) : 0;
  if (parts < 1 || parts > PARTS_MOST || every < 1) {
    fprintf(stderr, "parts [every MANY SKIP] COUNT [NAME ...]\n");
    return 1;
  }
  int32_t count = 0, sum[OUTCOMES] = {0};
  scene *list = list_scenes(&count);
  setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
  for (int32_t i = skip; i < count; i += every) {
    if (!is_named(&list[i], argc - at - 1, argv + at + 1)) continue;
    telling *t = calloc(1, sizeof *t);
    char why[REFUSAL + PARTS_TEXT];
    if (!t) return 1;
    t->is = list[i];
    const int32_t result = compare(t, parts, why, sizeof why);
    ++sum[result];
    printf("%s: %s%s%s\n", list[i].name, outcome[result], why[0] ? ": " : "", why);
    free(t);
  }
  free(list);
  printf("%d parts: %d scenes equal, %d refused, %d with other bits, %d failed\n", (int)parts,
         (int)sum[EQUAL], (int)sum[REFUSED], (int)sum[OTHER], (int)sum[FAILED]);
  return sum[OTHER] || sum[FAILED] || !sum[EQUAL];
}
