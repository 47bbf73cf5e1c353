#include "exact.h"
TCase *patch_case(void) { return tcase_create("patch"); }
