/* Parts of test_stepper.c. */
#ifndef STEPPER_PARTS_H
#define STEPPER_PARTS_H

#include "body.h"

TCase *stepper_description_case(void);
TCase *stepper_arguments_case(void);
TCase *stepper_staged_case(void);
TCase *stepper_nodes_case(void);
TCase *stepper_advance_case(void);
TCase *stepper_callbacks_case(void);
TCase *stepper_boundary_case(void);
TCase *stepper_material_case(void);

#endif
