/* Frozen values of the binary interface: constants, and on LP64 the size of every public struct and the place
 * of every field. What stands here may be added to, never changed: hosts were compiled against it. */
#include <check.h>
#include <stddef.h>

#include <mpm/mpm.h>

#define VALUE(name, value) ck_assert_int_eq(name, value)
#define SIZE(bytes)        ck_assert_uint_eq(sizeof(STRUCT), bytes)
#define AT(offset, field)  ck_assert_uint_eq(offsetof(STRUCT, field), offset)

START_TEST(constants) {
  VALUE(MPM_OK, 0);
  VALUE(MPM_CUT_DT, 1);
  VALUE(MPM_INVERTED, 2);
  VALUE(MPM_NONFINITE, 3);
  VALUE(MPM_NOT_CONVERGED, 4);
  VALUE(MPM_SINGULAR, 5);
  VALUE(MPM_OFF_GRID, 6);
  VALUE(MPM_CANCELLED, 7);
  VALUE(MPM_E_ARG, -1);
  VALUE(MPM_E_NOMEM, -2);
  VALUE(MPM_E_STATE, -3);
  VALUE(MPM_E_CALLBACK, -4);
  VALUE(MPM_E_UNSUPPORTED, -5);
  VALUE(MPM_E_NOT_FOUND, -6);
  VALUE(MPM_E_IO, -7);
  VALUE(MPM_E_FORMAT, -8);
  VALUE(MPM_E_INTERNAL, -99);
  VALUE(MPM_LINEAR, 1);
  VALUE(MPM_BSPLINE2, 2);
  VALUE(MPM_BSPLINE3, 3);
  VALUE(MPM_GIMP, 16);
  VALUE(MPM_UGIMP, 17);
  VALUE(MPM_CPGIMP, 18);
  VALUE(MPM_BOUNDARY_GHOST, 0);
  VALUE(MPM_BOUNDARY_OPEN_KNOT, 1);
  VALUE(MPM_USL, 1);
  VALUE(MPM_USF, 2);
  VALUE(MPM_MUSL, 3);
  VALUE(MPM_NEWMARK, 16);
  VALUE(MPM_FLIP, 1);
  VALUE(MPM_APIC, 2);
  VALUE(MPM_TPIC, 3);
  VALUE(MPM_TFLIP, 4);
  VALUE(MPM_AFLIP, 5);
  VALUE(MPM_XPIC, 6);
  VALUE(MPM_APIC_MLS, 7);
  VALUE(MPM_FMPM, 8);
  VALUE(MPM_ISA_BEST, 0);
  VALUE(MPM_ISA_BASELINE, 1);
  VALUE(MPM_ISA_AVX2, 2);
  VALUE(MPM_ISA_AVX512, 3);
  VALUE(MPM_ISA_NEON, 4);
  VALUE(MPM_ISA_PORTABLE, MPM_ISA_BASELINE);
  VALUE(MPM_LOG_WARNING, 1);
  VALUE(MPM_LOG_INFO, 2);
  VALUE(MPM_LOG_DEBUG, 3);
  VALUE(MPM_LOCKING_NONE, 0);
  VALUE(MPM_LOCKING_CELL_AVERAGE, 1);
  VALUE(MPM_TANGENT_MINOR_SYMMETRIC, 36);
  VALUE(MPM_TANGENT_GENERAL, 81);
  VALUE(MPM_X_MIN, 0);
  VALUE(MPM_X_MAX, 1);
  VALUE(MPM_Y_MIN, 2);
  VALUE(MPM_Y_MAX, 3);
  VALUE(MPM_Z_MIN, 4);
  VALUE(MPM_Z_MAX, 5);
  VALUE(MPM_WALL_NONE, 0);
  VALUE(MPM_WALL_OPEN, 1);
  VALUE(MPM_WALL_FIXED, 2);
  VALUE(MPM_WALL_SLIP, 3);
  VALUE(MPM_WALL_FRICTION, 4);
  VALUE(MPM_WALL_FRICTION_NODES, 5);
  VALUE(MPM_CONTACT_UNILATERAL, 0);
  VALUE(MPM_CONTACT_NONE, 1);
  VALUE(MPM_CONTACT_TIED, 2);
  VALUE(MPM_NORMAL_LOGISTIC, 0);
  VALUE(MPM_NORMAL_DISCRIMINANT, 1);
  VALUE(MPM_NORMAL_GRADIENT, 2);
  VALUE(MPM_NORMAL_FIXED, 3);
  VALUE(MPM_DETECT_DEFAULT, 0);
  VALUE(MPM_DETECT_GAP, 1);
  VALUE(MPM_DETECT_VELOCITY, 2);
  VALUE(MPM_BODY_ANY, -1);
  VALUE(MPM_SHAPE_PLANE, 1);
  VALUE(MPM_SHAPE_SPHERE, 2);
  VALUE(MPM_SHAPE_CYLINDER, 3);
  VALUE(MPM_SHAPE_CAPSULE, 4);
  VALUE(MPM_SHAPE_BOX, 5);
  VALUE(MPM_SHAPE_DISTANCE, 64);
  VALUE(MPM_MOTION_FIXED, 0);
  VALUE(MPM_MOTION_PRESCRIBED, 1);
  VALUE(MPM_MOTION_FREE, 2);
  VALUE(MPM_AFTER_P2G, 1);
  VALUE(MPM_AFTER_FORCES, 2);
  VALUE(MPM_AFTER_VELOCITY, 3);
  VALUE(MPM_READ, 1);
  VALUE(MPM_WRITE, 2);
  VALUE(MPM_F64, 1);
  VALUE(MPM_I64, 2);
  VALUE(MPM_U8, 3);
  VALUE(MPM_BY_ID, 1);
  VALUE(MPM_LIBRARY_ORDER, 2);
  VALUE(MPM_SOLVER_AUTO, 0);
  VALUE(MPM_SOLVER_CG, 1);
  VALUE(MPM_SOLVER_MULTIGRID_CG, 2);
  VALUE(MPM_SOLVER_LDLT, 3);
  VALUE(MPM_SOLVER_GMRES, 4);
  VALUE(MPM_SOLVER_HOST, 100);
  ck_assert_uint_eq(sizeof(mpm_status), 4);
  ck_assert_int_lt((mpm_status)-1, 0);
}
END_TEST

#define STRUCT mpm_param
START_TEST(layout_of_param) {
  SIZE(16);
  AT(0, name);
  AT(8, value);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_view
START_TEST(layout_of_view) {
  SIZE(56);
  AT(0, struct_size);
  AT(4, type);
  AT(8, components);
  AT(12, access);
  AT(16, count);
  AT(24, item_stride);
  AT(32, component_stride);
  AT(40, data);
  AT(48, owner);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_context_desc
START_TEST(layout_of_context_desc) {
  SIZE(96);
  AT(0, struct_size);
  AT(4, concurrency);
  AT(8, isa);
  AT(12, serial_callbacks);
  AT(16, alloc);
  AT(24, release);
  AT(32, alloc_user);
  AT(40, parallel_for);
  AT(48, parallel_user);
  AT(56, log);
  AT(64, log_user);
  AT(72, error_text);
  AT(80, error_bytes);
  AT(88, transport);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_transport
START_TEST(layout_of_transport) {
  SIZE(64);
  AT(0, struct_size);
  AT(4, part);
  AT(8, parts);
  AT(12, reserved);
  AT(16, send);
  AT(24, receive);
  AT(32, reduce);
  AT(40, gather);
  AT(48, poll);
  AT(56, user);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_message
START_TEST(layout_of_message) {
  SIZE(24);
  AT(0, part);
  AT(4, reserved);
  AT(8, bytes);
  AT(16, data);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_parallel_info
START_TEST(layout_of_parallel_info) {
  SIZE(96);
  AT(0, struct_size);
  AT(4, neighbours);
  AT(8, blocks);
  AT(16, boundary);
  AT(24, ghosts);
  AT(32, bytes_nodes);
  AT(40, bytes_moved);
  AT(48, moved);
  AT(56, cuts);
  AT(64, imbalance);
  AT(72, seconds_packing);
  AT(80, seconds_waiting);
  AT(88, seconds_reducing);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_balance_desc
START_TEST(layout_of_balance_desc) {
  SIZE(24);
  AT(0, struct_size);
  AT(4, measure);
  AT(8, limit);
  AT(16, block_weight);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_grid_desc
START_TEST(layout_of_grid_desc) {
  SIZE(120);
  AT(0, struct_size);
  AT(4, dim);
  AT(8, basis);
  AT(12, boundary_basis);
  AT(16, periodic);
  AT(28, geometry);
  AT(32, cells);
  AT(56, origin);
  AT(80, spacing);
  AT(104, smoothing);
  AT(112, total_lagrangian);
  AT(116, reserved);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_material_batch
START_TEST(layout_of_material_batch) {
  SIZE(144);
  AT(0, struct_size);
  AT(4, state_count);
  AT(8, n);
  AT(16, ld);
  AT(24, t);
  AT(32, dt);
  AT(40, id);
  AT(48, F);
  AT(56, F_inc);
  AT(64, L);
  AT(72, stress);
  AT(80, state);
  AT(88, stress_new);
  AT(96, state_new);
  AT(104, wave_speed);
  AT(112, kinematic_viscosity);
  AT(120, energy);
  AT(128, position);
  AT(136, lookup);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_material_desc
START_TEST(layout_of_material_desc) {
  SIZE(64);
  AT(0, struct_size);
  AT(4, state_count);
  AT(8, tangent_form);
  AT(12, reserved);
  AT(16, density);
  AT(24, stress);
  AT(32, tangent);
  AT(40, user);
  AT(48, release_user);
  AT(56, state_initial);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_stepper_desc
START_TEST(layout_of_stepper_desc) {
  SIZE(176);
  AT(0, struct_size);
  AT(4, scheme);
  AT(8, transfer);
  AT(12, xpic_order);
  AT(16, position_order);
  AT(20, locking_remedy);
  AT(24, reference_positions);
  AT(28, quasi_static);
  AT(32, staggered);
  AT(36, boundary_zero_acceleration);
  AT(40, flip);
  AT(48, pic_damping);
  AT(56, gravity);
  AT(80, newmark_beta);
  AT(88, newmark_gamma);
  AT(96, newton_tolerance_displacement);
  AT(104, newton_tolerance_energy);
  AT(112, newton_tolerance_residual);
  AT(120, newton_residual_floor);
  AT(128, newton_max_iterations);
  AT(132, linear_solver);
  AT(136, linear_tolerance);
  AT(144, linear_max_iterations);
  AT(148, projected_positions);
  AT(152, local_damping);
  AT(160, mass_damping);
  AT(168, xpic_every);
  AT(172, reserved);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_step_info
START_TEST(layout_of_step_info) {
  SIZE(248);
  AT(0, struct_size);
  AT(4, cause);
  AT(8, callback_status);
  AT(12, newton_iterations);
  AT(16, linear_solver);
  AT(20, set);
  AT(24, step);
  AT(32, active_nodes);
  AT(40, removed);
  AT(48, resorts);
  AT(56, particle);
  AT(64, node);
  AT(72, linear_iterations);
  AT(80, t);
  AT(88, dt);
  AT(96, dt_suggested);
  AT(104, residual);
  AT(112, kinetic_energy);
  AT(120, strain_energy);
  AT(128, external_work);
  AT(136, dissipation);
  AT(144, momentum);
  AT(168, angular_momentum);
  AT(192, external_work_total);
  AT(200, affine_kinetic_energy);
  AT(208, contact_dissipation);
  AT(216, contact_nodes);
  AT(224, body);
  AT(228, reserved);
  AT(232, damping_dissipation);
  AT(240, damping_dissipation_total);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_contact_desc
START_TEST(layout_of_contact_desc) {
  SIZE(72);
  AT(0, struct_size);
  AT(4, kind);
  AT(8, normal);
  AT(12, detection);
  AT(16, friction);
  AT(24, friction_static);
  AT(32, adhesion);
  AT(40, offset);
  AT(48, direction);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_contact_info
START_TEST(layout_of_contact_info) {
  SIZE(160);
  AT(0, struct_size);
  AT(4, touching);
  AT(8, nodes);
  AT(16, closed);
  AT(24, stuck);
  AT(32, ambiguous);
  AT(40, force);
  AT(64, torque);
  AT(88, normal_force);
  AT(96, area);
  AT(104, pressure_max);
  AT(112, gap);
  AT(120, dissipation);
  AT(128, friction_work);
  AT(136, impulse);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_contact_batch
START_TEST(layout_of_contact_batch) {
  SIZE(96);
  AT(0, struct_size);
  AT(4, dim);
  AT(8, body_a);
  AT(12, body_b);
  AT(16, n);
  AT(24, ld);
  AT(32, t);
  AT(40, dt);
  AT(48, position);
  AT(56, normal);
  AT(64, gap);
  AT(72, area);
  AT(80, slip);
  AT(88, pressure);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_distance_batch
START_TEST(layout_of_distance_batch) {
  SIZE(64);
  AT(0, struct_size);
  AT(4, dim);
  AT(8, n);
  AT(16, ld);
  AT(24, t);
  AT(32, position);
  AT(40, distance);
  AT(48, normal);
  AT(56, velocity);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_obstacle_desc
START_TEST(layout_of_obstacle_desc) {
  SIZE(296);
  AT(0, struct_size);
  AT(4, shape);
  AT(8, motion);
  AT(12, inside);
  AT(16, size);
  AT(40, position);
  AT(64, orientation);
  AT(96, velocity);
  AT(120, angular_velocity);
  AT(144, mass);
  AT(152, inertia);
  AT(224, contact);
  AT(232, distance);
  AT(240, user);
  AT(248, lower);
  AT(272, upper);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_particle_batch
START_TEST(layout_of_particle_batch) {
  SIZE(104);
  AT(0, struct_size);
  AT(4, dim);
  AT(8, n);
  AT(16, ld);
  AT(24, t);
  AT(32, dt);
  AT(40, id);
  AT(48, position);
  AT(56, reference_position);
  AT(64, velocity);
  AT(72, mass);
  AT(80, volume);
  AT(88, particles);
  AT(96, lookup);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_node_batch
START_TEST(layout_of_node_batch) {
  SIZE(80);
  AT(0, struct_size);
  AT(4, dim);
  AT(8, body);
  AT(12, reserved);
  AT(16, n);
  AT(24, ld);
  AT(32, t);
  AT(40, dt);
  AT(48, index);
  AT(56, position);
  AT(64, mass);
  AT(72, owned);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_advance_desc
START_TEST(layout_of_advance_desc) {
  SIZE(56);
  AT(0, struct_size);
  AT(4, max_cuts);
  AT(8, t_end);
  AT(16, cfl);
  AT(24, dt_first);
  AT(32, dt_min);
  AT(40, dt_max);
  AT(48, max_steps);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_profile
START_TEST(layout_of_profile) {
  SIZE(96);
  AT(0, struct_size);
  AT(4, reserved);
  AT(8, sort);
  AT(16, p2g);
  AT(24, grid);
  AT(32, g2p);
  AT(40, law);
  AT(48, assembly);
  AT(56, factor);
  AT(64, solve);
  AT(72, callbacks);
  AT(80, total);
  AT(88, weights);
}
END_TEST
#undef STRUCT

#define STRUCT mpm_operator_info
START_TEST(layout_of_operator_info) {
  SIZE(104);
  AT(0, struct_size);
  AT(4, block);
  AT(8, symmetric);
  AT(12, positive_definite);
  AT(16, rows);
  AT(24, nonzeros);
  AT(32, pattern_id);
  AT(40, ld);
  AT(48, node);
  AT(56, component);
  AT(64, position);
  AT(72, first_row);
  AT(80, owned_rows);
  AT(88, all_rows);
  AT(96, number);
}
END_TEST
#undef STRUCT

TCase *abi_structs_case(void);
Suite *abi_suite(void);
Suite *abi_suite(void) {
  Suite *suite = suite_create("abi");
  TCase *frozen = tcase_create("frozen");
  tcase_add_test(frozen, constants);
  if (sizeof(void *) == 8) {
    tcase_add_test(frozen, layout_of_param);
    tcase_add_test(frozen, layout_of_view);
    tcase_add_test(frozen, layout_of_context_desc);
    tcase_add_test(frozen, layout_of_transport);
    tcase_add_test(frozen, layout_of_message);
    tcase_add_test(frozen, layout_of_parallel_info);
    tcase_add_test(frozen, layout_of_balance_desc);
    tcase_add_test(frozen, layout_of_grid_desc);
    tcase_add_test(frozen, layout_of_material_batch);
    tcase_add_test(frozen, layout_of_material_desc);
    tcase_add_test(frozen, layout_of_stepper_desc);
    tcase_add_test(frozen, layout_of_step_info);
    tcase_add_test(frozen, layout_of_contact_desc);
    tcase_add_test(frozen, layout_of_contact_info);
    tcase_add_test(frozen, layout_of_contact_batch);
    tcase_add_test(frozen, layout_of_distance_batch);
    tcase_add_test(frozen, layout_of_obstacle_desc);
    tcase_add_test(frozen, layout_of_particle_batch);
    tcase_add_test(frozen, layout_of_node_batch);
    tcase_add_test(frozen, layout_of_advance_desc);
    tcase_add_test(frozen, layout_of_profile);
    tcase_add_test(frozen, layout_of_operator_info);
  }
  suite_add_tcase(suite, frozen);
  suite_add_tcase(suite, abi_structs_case());
  return suite;
}
