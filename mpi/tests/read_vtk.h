/* Reads what the files of VTK in XML hold, for tests: attributes by name, arrays by name and piece. */
#ifndef READ_VTK_H
#define READ_VTK_H

#include <stdint.h>

typedef struct vtk_text {
  char *bytes;
  int64_t count;
  char *data; /* behind the mark of appended data; NULL: there are none */
} vtk_text;

/* Stops the program if the file is not there. */
vtk_text vtk_load(const char *path);
void vtk_drop(vtk_text *text);
/* The n-th element of that name, from 0; NULL: there is none. */
const char *vtk_element(const vtk_text *text, const char *name, int32_t n);
/* The value of an attribute, in memory of its own that the next call takes. */
const char *vtk_attribute(const char *element, const char *name);
/* The first array of that name behind the element: its bytes without their number, and how many. */
const char *vtk_array(const vtk_text *text, const char *element, const char *name, int64_t *bytes);

#endif
