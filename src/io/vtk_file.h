/* VTK files in XML with appended raw data have a head that says where each array begins, and then the
 * arrays as they are. This is what all kinds of data share. */
#ifndef MPMI_VTK_FILE_H
#define MPMI_VTK_FILE_H

#include "io/output.h"
#include "particles/particles.h"

enum { MPMI_VTK_ARRAYS = MPMI_MAX_FIELDS + 3 };

/* This is one array of the file. */
typedef struct mpmi_vtk_array {
  const char *name;
  int32_t field; /* the number by which the writer knows it */
  int32_t type, components;
  int64_t tuples;
} mpmi_vtk_array;

typedef struct mpmi_vtk_file {
  mpm_context *context;
  mpmi_output out;
  int64_t offset; /* place of the next array in the appended data */
  int32_t count;
  mpmi_vtk_array list[MPMI_VTK_ARRAYS];
} mpmi_vtk_file;

/* These calls settle the arrays before the file exists. */
mpm_status mpmi_vtk_check_names(mpm_context *context, int32_t count, const char *const *fields);
void mpmi_vtk_add(mpmi_vtk_file *file, const char *name, int32_t field, int32_t type, int32_t components,
                  int64_t tuples);
/* Does the same for a field that the host names: MPM_E_ARG when it is there already. */
mpm_status mpmi_vtk_add_named(mpmi_vtk_file *file, const char *name, int32_t field, int32_t type,
                              int32_t components, int64_t tuples);
/* Returns 1 when there is an offset for every byte of the arrays. */
int32_t mpmi_vtk_fits(const mpmi_vtk_file *file);

/* The calls come in this order. Between the first two the writer prints tags of its own. */
mpm_status mpmi_vtk_open(mpmi_vtk_file *file, const mpmi_target *to, const char *kind);
void mpmi_vtk_tags(mpmi_vtk_file *file, int32_t begin, int32_t end); /* tags of the arrays [begin, end) */
void mpmi_vtk_start_data(mpmi_vtk_file *file, const char *kind);
void mpmi_vtk_start_array(mpmi_vtk_file *file, const mpmi_vtk_array *array); /* its bytes follow */
mpm_status mpmi_vtk_close(mpmi_vtk_file *file);

#endif
