// Generated from the headers of libmpm by `make api`; not to be edited.
//! Whether structs lie in memory as those of C, and whether the library has every function.
use mpm_sys::*;
use std::mem::{size_of, MaybeUninit};
use std::ptr::addr_of;

fn of(wide: usize, narrow: usize) -> usize {
    if size_of::<usize>() == 8 {
        wide
    } else {
        narrow
    }
}

macro_rules! offset {
    ($type:ty, $field:ident) => {{
        let it = MaybeUninit::<$type>::uninit();
        let base = it.as_ptr();
        // SAFETY: an address is taken, nothing is read.
        unsafe { addr_of!((*base).$field) as usize - base as usize }
    }};
}

#[test]
fn layout_of_mpm_param() {
    assert_eq!(size_of::<mpm_param>(), of(16, 16));
    assert_eq!(offset!(mpm_param, name), of(0, 0));
    assert_eq!(offset!(mpm_param, value), of(8, 8));
}

#[test]
fn layout_of_mpm_view() {
    assert_eq!(size_of::<mpm_view>(), of(56, 48));
    assert_eq!(offset!(mpm_view, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_view, r#type), of(4, 4));
    assert_eq!(offset!(mpm_view, components), of(8, 8));
    assert_eq!(offset!(mpm_view, access), of(12, 12));
    assert_eq!(offset!(mpm_view, count), of(16, 16));
    assert_eq!(offset!(mpm_view, item_stride), of(24, 24));
    assert_eq!(offset!(mpm_view, component_stride), of(32, 32));
    assert_eq!(offset!(mpm_view, data), of(40, 40));
    assert_eq!(offset!(mpm_view, owner), of(48, 44));
}

#[test]
fn layout_of_mpm_message() {
    assert_eq!(size_of::<mpm_message>(), of(24, 24));
    assert_eq!(offset!(mpm_message, part), of(0, 0));
    assert_eq!(offset!(mpm_message, reserved), of(4, 4));
    assert_eq!(offset!(mpm_message, bytes), of(8, 8));
    assert_eq!(offset!(mpm_message, data), of(16, 16));
}

#[test]
fn layout_of_mpm_transport() {
    assert_eq!(size_of::<mpm_transport>(), of(64, 40));
    assert_eq!(offset!(mpm_transport, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_transport, part), of(4, 4));
    assert_eq!(offset!(mpm_transport, parts), of(8, 8));
    assert_eq!(offset!(mpm_transport, reserved), of(12, 12));
    assert_eq!(offset!(mpm_transport, send), of(16, 16));
    assert_eq!(offset!(mpm_transport, receive), of(24, 20));
    assert_eq!(offset!(mpm_transport, reduce), of(32, 24));
    assert_eq!(offset!(mpm_transport, gather), of(40, 28));
    assert_eq!(offset!(mpm_transport, poll), of(48, 32));
    assert_eq!(offset!(mpm_transport, user), of(56, 36));
}

#[test]
fn layout_of_mpm_balance_desc() {
    assert_eq!(size_of::<mpm_balance_desc>(), of(24, 24));
    assert_eq!(offset!(mpm_balance_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_balance_desc, measure), of(4, 4));
    assert_eq!(offset!(mpm_balance_desc, limit), of(8, 8));
    assert_eq!(offset!(mpm_balance_desc, block_weight), of(16, 16));
}

#[test]
fn layout_of_mpm_parallel_info() {
    assert_eq!(size_of::<mpm_parallel_info>(), of(96, 96));
    assert_eq!(offset!(mpm_parallel_info, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_parallel_info, neighbours), of(4, 4));
    assert_eq!(offset!(mpm_parallel_info, blocks), of(8, 8));
    assert_eq!(offset!(mpm_parallel_info, boundary), of(16, 16));
    assert_eq!(offset!(mpm_parallel_info, ghosts), of(24, 24));
    assert_eq!(offset!(mpm_parallel_info, bytes_nodes), of(32, 32));
    assert_eq!(offset!(mpm_parallel_info, bytes_moved), of(40, 40));
    assert_eq!(offset!(mpm_parallel_info, moved), of(48, 48));
    assert_eq!(offset!(mpm_parallel_info, cuts), of(56, 56));
    assert_eq!(offset!(mpm_parallel_info, imbalance), of(64, 64));
    assert_eq!(offset!(mpm_parallel_info, seconds_packing), of(72, 72));
    assert_eq!(offset!(mpm_parallel_info, seconds_waiting), of(80, 80));
    assert_eq!(offset!(mpm_parallel_info, seconds_reducing), of(88, 88));
}

#[test]
fn layout_of_mpm_context_desc() {
    assert_eq!(size_of::<mpm_context_desc>(), of(96, 64));
    assert_eq!(offset!(mpm_context_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_context_desc, concurrency), of(4, 4));
    assert_eq!(offset!(mpm_context_desc, isa), of(8, 8));
    assert_eq!(offset!(mpm_context_desc, serial_callbacks), of(12, 12));
    assert_eq!(offset!(mpm_context_desc, alloc), of(16, 16));
    assert_eq!(offset!(mpm_context_desc, release), of(24, 20));
    assert_eq!(offset!(mpm_context_desc, alloc_user), of(32, 24));
    assert_eq!(offset!(mpm_context_desc, parallel_for), of(40, 28));
    assert_eq!(offset!(mpm_context_desc, parallel_user), of(48, 32));
    assert_eq!(offset!(mpm_context_desc, log), of(56, 36));
    assert_eq!(offset!(mpm_context_desc, log_user), of(64, 40));
    assert_eq!(offset!(mpm_context_desc, error_text), of(72, 44));
    assert_eq!(offset!(mpm_context_desc, error_bytes), of(80, 48));
    assert_eq!(offset!(mpm_context_desc, transport), of(88, 56));
}

#[test]
fn layout_of_mpm_grid_desc() {
    assert_eq!(size_of::<mpm_grid_desc>(), of(120, 120));
    assert_eq!(offset!(mpm_grid_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_grid_desc, dim), of(4, 4));
    assert_eq!(offset!(mpm_grid_desc, basis), of(8, 8));
    assert_eq!(offset!(mpm_grid_desc, boundary_basis), of(12, 12));
    assert_eq!(offset!(mpm_grid_desc, periodic), of(16, 16));
    assert_eq!(offset!(mpm_grid_desc, geometry), of(28, 28));
    assert_eq!(offset!(mpm_grid_desc, cells), of(32, 32));
    assert_eq!(offset!(mpm_grid_desc, origin), of(56, 56));
    assert_eq!(offset!(mpm_grid_desc, spacing), of(80, 80));
    assert_eq!(offset!(mpm_grid_desc, smoothing), of(104, 104));
    assert_eq!(offset!(mpm_grid_desc, total_lagrangian), of(112, 112));
    assert_eq!(offset!(mpm_grid_desc, reserved), of(116, 116));
}

#[test]
fn layout_of_mpm_material_batch() {
    assert_eq!(size_of::<mpm_material_batch>(), of(144, 96));
    assert_eq!(offset!(mpm_material_batch, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_material_batch, state_count), of(4, 4));
    assert_eq!(offset!(mpm_material_batch, n), of(8, 8));
    assert_eq!(offset!(mpm_material_batch, ld), of(16, 16));
    assert_eq!(offset!(mpm_material_batch, t), of(24, 24));
    assert_eq!(offset!(mpm_material_batch, dt), of(32, 32));
    assert_eq!(offset!(mpm_material_batch, id), of(40, 40));
    assert_eq!(offset!(mpm_material_batch, F), of(48, 44));
    assert_eq!(offset!(mpm_material_batch, F_inc), of(56, 48));
    assert_eq!(offset!(mpm_material_batch, L), of(64, 52));
    assert_eq!(offset!(mpm_material_batch, stress), of(72, 56));
    assert_eq!(offset!(mpm_material_batch, state), of(80, 60));
    assert_eq!(offset!(mpm_material_batch, stress_new), of(88, 64));
    assert_eq!(offset!(mpm_material_batch, state_new), of(96, 68));
    assert_eq!(offset!(mpm_material_batch, wave_speed), of(104, 72));
    assert_eq!(offset!(mpm_material_batch, kinematic_viscosity), of(112, 76));
    assert_eq!(offset!(mpm_material_batch, energy), of(120, 80));
    assert_eq!(offset!(mpm_material_batch, position), of(128, 84));
    assert_eq!(offset!(mpm_material_batch, lookup), of(136, 88));
}

#[test]
fn layout_of_mpm_material_desc() {
    assert_eq!(size_of::<mpm_material_desc>(), of(64, 48));
    assert_eq!(offset!(mpm_material_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_material_desc, state_count), of(4, 4));
    assert_eq!(offset!(mpm_material_desc, tangent_form), of(8, 8));
    assert_eq!(offset!(mpm_material_desc, reserved), of(12, 12));
    assert_eq!(offset!(mpm_material_desc, density), of(16, 16));
    assert_eq!(offset!(mpm_material_desc, stress), of(24, 24));
    assert_eq!(offset!(mpm_material_desc, tangent), of(32, 28));
    assert_eq!(offset!(mpm_material_desc, user), of(40, 32));
    assert_eq!(offset!(mpm_material_desc, release_user), of(48, 36));
    assert_eq!(offset!(mpm_material_desc, state_initial), of(56, 40));
}

#[test]
fn layout_of_mpm_operator_info() {
    assert_eq!(size_of::<mpm_operator_info>(), of(104, 96));
    assert_eq!(offset!(mpm_operator_info, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_operator_info, block), of(4, 4));
    assert_eq!(offset!(mpm_operator_info, symmetric), of(8, 8));
    assert_eq!(offset!(mpm_operator_info, positive_definite), of(12, 12));
    assert_eq!(offset!(mpm_operator_info, rows), of(16, 16));
    assert_eq!(offset!(mpm_operator_info, nonzeros), of(24, 24));
    assert_eq!(offset!(mpm_operator_info, pattern_id), of(32, 32));
    assert_eq!(offset!(mpm_operator_info, ld), of(40, 40));
    assert_eq!(offset!(mpm_operator_info, node), of(48, 48));
    assert_eq!(offset!(mpm_operator_info, component), of(56, 52));
    assert_eq!(offset!(mpm_operator_info, position), of(64, 56));
    assert_eq!(offset!(mpm_operator_info, first_row), of(72, 64));
    assert_eq!(offset!(mpm_operator_info, owned_rows), of(80, 72));
    assert_eq!(offset!(mpm_operator_info, all_rows), of(88, 80));
    assert_eq!(offset!(mpm_operator_info, number), of(96, 88));
}

#[test]
fn layout_of_mpm_stepper_desc() {
    assert_eq!(size_of::<mpm_stepper_desc>(), of(176, 176));
    assert_eq!(offset!(mpm_stepper_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_stepper_desc, scheme), of(4, 4));
    assert_eq!(offset!(mpm_stepper_desc, transfer), of(8, 8));
    assert_eq!(offset!(mpm_stepper_desc, xpic_order), of(12, 12));
    assert_eq!(offset!(mpm_stepper_desc, position_order), of(16, 16));
    assert_eq!(offset!(mpm_stepper_desc, locking_remedy), of(20, 20));
    assert_eq!(offset!(mpm_stepper_desc, reference_positions), of(24, 24));
    assert_eq!(offset!(mpm_stepper_desc, quasi_static), of(28, 28));
    assert_eq!(offset!(mpm_stepper_desc, staggered), of(32, 32));
    assert_eq!(offset!(mpm_stepper_desc, boundary_zero_acceleration), of(36, 36));
    assert_eq!(offset!(mpm_stepper_desc, flip), of(40, 40));
    assert_eq!(offset!(mpm_stepper_desc, pic_damping), of(48, 48));
    assert_eq!(offset!(mpm_stepper_desc, gravity), of(56, 56));
    assert_eq!(offset!(mpm_stepper_desc, newmark_beta), of(80, 80));
    assert_eq!(offset!(mpm_stepper_desc, newmark_gamma), of(88, 88));
    assert_eq!(offset!(mpm_stepper_desc, newton_tolerance_displacement), of(96, 96));
    assert_eq!(offset!(mpm_stepper_desc, newton_tolerance_energy), of(104, 104));
    assert_eq!(offset!(mpm_stepper_desc, newton_tolerance_residual), of(112, 112));
    assert_eq!(offset!(mpm_stepper_desc, newton_residual_floor), of(120, 120));
    assert_eq!(offset!(mpm_stepper_desc, newton_max_iterations), of(128, 128));
    assert_eq!(offset!(mpm_stepper_desc, linear_solver), of(132, 132));
    assert_eq!(offset!(mpm_stepper_desc, linear_tolerance), of(136, 136));
    assert_eq!(offset!(mpm_stepper_desc, linear_max_iterations), of(144, 144));
    assert_eq!(offset!(mpm_stepper_desc, projected_positions), of(148, 148));
    assert_eq!(offset!(mpm_stepper_desc, local_damping), of(152, 152));
    assert_eq!(offset!(mpm_stepper_desc, mass_damping), of(160, 160));
    assert_eq!(offset!(mpm_stepper_desc, xpic_every), of(168, 168));
    assert_eq!(offset!(mpm_stepper_desc, reserved), of(172, 172));
}

#[test]
fn layout_of_mpm_step_info() {
    assert_eq!(size_of::<mpm_step_info>(), of(248, 248));
    assert_eq!(offset!(mpm_step_info, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_step_info, cause), of(4, 4));
    assert_eq!(offset!(mpm_step_info, callback_status), of(8, 8));
    assert_eq!(offset!(mpm_step_info, newton_iterations), of(12, 12));
    assert_eq!(offset!(mpm_step_info, linear_solver), of(16, 16));
    assert_eq!(offset!(mpm_step_info, set), of(20, 20));
    assert_eq!(offset!(mpm_step_info, step), of(24, 24));
    assert_eq!(offset!(mpm_step_info, active_nodes), of(32, 32));
    assert_eq!(offset!(mpm_step_info, removed), of(40, 40));
    assert_eq!(offset!(mpm_step_info, resorts), of(48, 48));
    assert_eq!(offset!(mpm_step_info, particle), of(56, 56));
    assert_eq!(offset!(mpm_step_info, node), of(64, 64));
    assert_eq!(offset!(mpm_step_info, linear_iterations), of(72, 72));
    assert_eq!(offset!(mpm_step_info, t), of(80, 80));
    assert_eq!(offset!(mpm_step_info, dt), of(88, 88));
    assert_eq!(offset!(mpm_step_info, dt_suggested), of(96, 96));
    assert_eq!(offset!(mpm_step_info, residual), of(104, 104));
    assert_eq!(offset!(mpm_step_info, kinetic_energy), of(112, 112));
    assert_eq!(offset!(mpm_step_info, strain_energy), of(120, 120));
    assert_eq!(offset!(mpm_step_info, external_work), of(128, 128));
    assert_eq!(offset!(mpm_step_info, dissipation), of(136, 136));
    assert_eq!(offset!(mpm_step_info, momentum), of(144, 144));
    assert_eq!(offset!(mpm_step_info, angular_momentum), of(168, 168));
    assert_eq!(offset!(mpm_step_info, external_work_total), of(192, 192));
    assert_eq!(offset!(mpm_step_info, affine_kinetic_energy), of(200, 200));
    assert_eq!(offset!(mpm_step_info, contact_dissipation), of(208, 208));
    assert_eq!(offset!(mpm_step_info, contact_nodes), of(216, 216));
    assert_eq!(offset!(mpm_step_info, body), of(224, 224));
    assert_eq!(offset!(mpm_step_info, reserved), of(228, 228));
    assert_eq!(offset!(mpm_step_info, damping_dissipation), of(232, 232));
    assert_eq!(offset!(mpm_step_info, damping_dissipation_total), of(240, 240));
}

#[test]
fn layout_of_mpm_particle_batch() {
    assert_eq!(size_of::<mpm_particle_batch>(), of(104, 72));
    assert_eq!(offset!(mpm_particle_batch, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_particle_batch, dim), of(4, 4));
    assert_eq!(offset!(mpm_particle_batch, n), of(8, 8));
    assert_eq!(offset!(mpm_particle_batch, ld), of(16, 16));
    assert_eq!(offset!(mpm_particle_batch, t), of(24, 24));
    assert_eq!(offset!(mpm_particle_batch, dt), of(32, 32));
    assert_eq!(offset!(mpm_particle_batch, id), of(40, 40));
    assert_eq!(offset!(mpm_particle_batch, position), of(48, 44));
    assert_eq!(offset!(mpm_particle_batch, reference_position), of(56, 48));
    assert_eq!(offset!(mpm_particle_batch, velocity), of(64, 52));
    assert_eq!(offset!(mpm_particle_batch, mass), of(72, 56));
    assert_eq!(offset!(mpm_particle_batch, volume), of(80, 60));
    assert_eq!(offset!(mpm_particle_batch, particles), of(88, 64));
    assert_eq!(offset!(mpm_particle_batch, lookup), of(96, 68));
}

#[test]
fn layout_of_mpm_node_batch() {
    assert_eq!(size_of::<mpm_node_batch>(), of(80, 64));
    assert_eq!(offset!(mpm_node_batch, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_node_batch, dim), of(4, 4));
    assert_eq!(offset!(mpm_node_batch, body), of(8, 8));
    assert_eq!(offset!(mpm_node_batch, reserved), of(12, 12));
    assert_eq!(offset!(mpm_node_batch, n), of(16, 16));
    assert_eq!(offset!(mpm_node_batch, ld), of(24, 24));
    assert_eq!(offset!(mpm_node_batch, t), of(32, 32));
    assert_eq!(offset!(mpm_node_batch, dt), of(40, 40));
    assert_eq!(offset!(mpm_node_batch, index), of(48, 48));
    assert_eq!(offset!(mpm_node_batch, position), of(56, 52));
    assert_eq!(offset!(mpm_node_batch, mass), of(64, 56));
    assert_eq!(offset!(mpm_node_batch, owned), of(72, 60));
}

#[test]
fn layout_of_mpm_advance_desc() {
    assert_eq!(size_of::<mpm_advance_desc>(), of(56, 56));
    assert_eq!(offset!(mpm_advance_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_advance_desc, max_cuts), of(4, 4));
    assert_eq!(offset!(mpm_advance_desc, t_end), of(8, 8));
    assert_eq!(offset!(mpm_advance_desc, cfl), of(16, 16));
    assert_eq!(offset!(mpm_advance_desc, dt_first), of(24, 24));
    assert_eq!(offset!(mpm_advance_desc, dt_min), of(32, 32));
    assert_eq!(offset!(mpm_advance_desc, dt_max), of(40, 40));
    assert_eq!(offset!(mpm_advance_desc, max_steps), of(48, 48));
}

#[test]
fn layout_of_mpm_profile() {
    assert_eq!(size_of::<mpm_profile>(), of(96, 96));
    assert_eq!(offset!(mpm_profile, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_profile, reserved), of(4, 4));
    assert_eq!(offset!(mpm_profile, sort), of(8, 8));
    assert_eq!(offset!(mpm_profile, p2g), of(16, 16));
    assert_eq!(offset!(mpm_profile, grid), of(24, 24));
    assert_eq!(offset!(mpm_profile, g2p), of(32, 32));
    assert_eq!(offset!(mpm_profile, law), of(40, 40));
    assert_eq!(offset!(mpm_profile, assembly), of(48, 48));
    assert_eq!(offset!(mpm_profile, factor), of(56, 56));
    assert_eq!(offset!(mpm_profile, solve), of(64, 64));
    assert_eq!(offset!(mpm_profile, callbacks), of(72, 72));
    assert_eq!(offset!(mpm_profile, total), of(80, 80));
    assert_eq!(offset!(mpm_profile, weights), of(88, 88));
}

#[test]
fn layout_of_mpm_contact_desc() {
    assert_eq!(size_of::<mpm_contact_desc>(), of(72, 72));
    assert_eq!(offset!(mpm_contact_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_contact_desc, kind), of(4, 4));
    assert_eq!(offset!(mpm_contact_desc, normal), of(8, 8));
    assert_eq!(offset!(mpm_contact_desc, detection), of(12, 12));
    assert_eq!(offset!(mpm_contact_desc, friction), of(16, 16));
    assert_eq!(offset!(mpm_contact_desc, friction_static), of(24, 24));
    assert_eq!(offset!(mpm_contact_desc, adhesion), of(32, 32));
    assert_eq!(offset!(mpm_contact_desc, offset), of(40, 40));
    assert_eq!(offset!(mpm_contact_desc, direction), of(48, 48));
}

#[test]
fn layout_of_mpm_contact_info() {
    assert_eq!(size_of::<mpm_contact_info>(), of(160, 160));
    assert_eq!(offset!(mpm_contact_info, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_contact_info, touching), of(4, 4));
    assert_eq!(offset!(mpm_contact_info, nodes), of(8, 8));
    assert_eq!(offset!(mpm_contact_info, closed), of(16, 16));
    assert_eq!(offset!(mpm_contact_info, stuck), of(24, 24));
    assert_eq!(offset!(mpm_contact_info, ambiguous), of(32, 32));
    assert_eq!(offset!(mpm_contact_info, force), of(40, 40));
    assert_eq!(offset!(mpm_contact_info, torque), of(64, 64));
    assert_eq!(offset!(mpm_contact_info, normal_force), of(88, 88));
    assert_eq!(offset!(mpm_contact_info, area), of(96, 96));
    assert_eq!(offset!(mpm_contact_info, pressure_max), of(104, 104));
    assert_eq!(offset!(mpm_contact_info, gap), of(112, 112));
    assert_eq!(offset!(mpm_contact_info, dissipation), of(120, 120));
    assert_eq!(offset!(mpm_contact_info, friction_work), of(128, 128));
    assert_eq!(offset!(mpm_contact_info, impulse), of(136, 136));
}

#[test]
fn layout_of_mpm_contact_batch() {
    assert_eq!(size_of::<mpm_contact_batch>(), of(96, 72));
    assert_eq!(offset!(mpm_contact_batch, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_contact_batch, dim), of(4, 4));
    assert_eq!(offset!(mpm_contact_batch, body_a), of(8, 8));
    assert_eq!(offset!(mpm_contact_batch, body_b), of(12, 12));
    assert_eq!(offset!(mpm_contact_batch, n), of(16, 16));
    assert_eq!(offset!(mpm_contact_batch, ld), of(24, 24));
    assert_eq!(offset!(mpm_contact_batch, t), of(32, 32));
    assert_eq!(offset!(mpm_contact_batch, dt), of(40, 40));
    assert_eq!(offset!(mpm_contact_batch, position), of(48, 48));
    assert_eq!(offset!(mpm_contact_batch, normal), of(56, 52));
    assert_eq!(offset!(mpm_contact_batch, gap), of(64, 56));
    assert_eq!(offset!(mpm_contact_batch, area), of(72, 60));
    assert_eq!(offset!(mpm_contact_batch, slip), of(80, 64));
    assert_eq!(offset!(mpm_contact_batch, pressure), of(88, 68));
}

#[test]
fn layout_of_mpm_distance_batch() {
    assert_eq!(size_of::<mpm_distance_batch>(), of(64, 48));
    assert_eq!(offset!(mpm_distance_batch, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_distance_batch, dim), of(4, 4));
    assert_eq!(offset!(mpm_distance_batch, n), of(8, 8));
    assert_eq!(offset!(mpm_distance_batch, ld), of(16, 16));
    assert_eq!(offset!(mpm_distance_batch, t), of(24, 24));
    assert_eq!(offset!(mpm_distance_batch, position), of(32, 32));
    assert_eq!(offset!(mpm_distance_batch, distance), of(40, 36));
    assert_eq!(offset!(mpm_distance_batch, normal), of(48, 40));
    assert_eq!(offset!(mpm_distance_batch, velocity), of(56, 44));
}

#[test]
fn layout_of_mpm_obstacle_desc() {
    assert_eq!(size_of::<mpm_obstacle_desc>(), of(296, 288));
    assert_eq!(offset!(mpm_obstacle_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_obstacle_desc, shape), of(4, 4));
    assert_eq!(offset!(mpm_obstacle_desc, motion), of(8, 8));
    assert_eq!(offset!(mpm_obstacle_desc, inside), of(12, 12));
    assert_eq!(offset!(mpm_obstacle_desc, size), of(16, 16));
    assert_eq!(offset!(mpm_obstacle_desc, position), of(40, 40));
    assert_eq!(offset!(mpm_obstacle_desc, orientation), of(64, 64));
    assert_eq!(offset!(mpm_obstacle_desc, velocity), of(96, 96));
    assert_eq!(offset!(mpm_obstacle_desc, angular_velocity), of(120, 120));
    assert_eq!(offset!(mpm_obstacle_desc, mass), of(144, 144));
    assert_eq!(offset!(mpm_obstacle_desc, inertia), of(152, 152));
    assert_eq!(offset!(mpm_obstacle_desc, contact), of(224, 224));
    assert_eq!(offset!(mpm_obstacle_desc, distance), of(232, 228));
    assert_eq!(offset!(mpm_obstacle_desc, user), of(240, 232));
    assert_eq!(offset!(mpm_obstacle_desc, lower), of(248, 240));
    assert_eq!(offset!(mpm_obstacle_desc, upper), of(272, 264));
}

#[test]
fn layout_of_mpm_surface_desc() {
    assert_eq!(size_of::<mpm_surface_desc>(), of(120, 120));
    assert_eq!(offset!(mpm_surface_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_surface_desc, body), of(4, 4));
    assert_eq!(offset!(mpm_surface_desc, pressure), of(8, 8));
    assert_eq!(offset!(mpm_surface_desc, traction), of(16, 16));
    assert_eq!(offset!(mpm_surface_desc, dead_traction), of(40, 40));
    assert_eq!(offset!(mpm_surface_desc, max_spacing), of(64, 64));
    assert_eq!(offset!(mpm_surface_desc, prescribes), of(72, 72));
    assert_eq!(offset!(mpm_surface_desc, reserved), of(76, 76));
    assert_eq!(offset!(mpm_surface_desc, velocity), of(80, 80));
    assert_eq!(offset!(mpm_surface_desc, penalty), of(104, 104));
    assert_eq!(offset!(mpm_surface_desc, modulus), of(112, 112));
}

#[test]
fn layout_of_mpm_marker_batch() {
    assert_eq!(size_of::<mpm_marker_batch>(), of(88, 64));
    assert_eq!(offset!(mpm_marker_batch, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_marker_batch, dim), of(4, 4));
    assert_eq!(offset!(mpm_marker_batch, n), of(8, 8));
    assert_eq!(offset!(mpm_marker_batch, ld), of(16, 16));
    assert_eq!(offset!(mpm_marker_batch, t), of(24, 24));
    assert_eq!(offset!(mpm_marker_batch, dt), of(32, 32));
    assert_eq!(offset!(mpm_marker_batch, id), of(40, 40));
    assert_eq!(offset!(mpm_marker_batch, position), of(48, 44));
    assert_eq!(offset!(mpm_marker_batch, area), of(56, 48));
    assert_eq!(offset!(mpm_marker_batch, reference_area), of(64, 52));
    assert_eq!(offset!(mpm_marker_batch, displacement), of(72, 56));
    assert_eq!(offset!(mpm_marker_batch, velocity), of(80, 60));
}

#[test]
fn layout_of_mpm_adaption_batch() {
    assert_eq!(size_of::<mpm_adaption_batch>(), of(56, 48));
    assert_eq!(offset!(mpm_adaption_batch, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_adaption_batch, what), of(4, 4));
    assert_eq!(offset!(mpm_adaption_batch, n), of(8, 8));
    assert_eq!(offset!(mpm_adaption_batch, ld), of(16, 16));
    assert_eq!(offset!(mpm_adaption_batch, dim), of(24, 24));
    assert_eq!(offset!(mpm_adaption_batch, reserved), of(28, 28));
    assert_eq!(offset!(mpm_adaption_batch, id), of(32, 32));
    assert_eq!(offset!(mpm_adaption_batch, other), of(40, 36));
    assert_eq!(offset!(mpm_adaption_batch, position), of(48, 40));
}

#[test]
fn layout_of_mpm_adaption_desc() {
    assert_eq!(size_of::<mpm_adaption_desc>(), of(72, 64));
    assert_eq!(offset!(mpm_adaption_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_adaption_desc, every), of(4, 4));
    assert_eq!(offset!(mpm_adaption_desc, split_edge), of(8, 8));
    assert_eq!(offset!(mpm_adaption_desc, least_edge), of(16, 16));
    assert_eq!(offset!(mpm_adaption_desc, min_per_cell), of(24, 24));
    assert_eq!(offset!(mpm_adaption_desc, max_per_cell), of(28, 28));
    assert_eq!(offset!(mpm_adaption_desc, merge_distance), of(32, 32));
    assert_eq!(offset!(mpm_adaption_desc, merge_tolerance), of(40, 40));
    assert_eq!(offset!(mpm_adaption_desc, most_particles), of(48, 48));
    assert_eq!(offset!(mpm_adaption_desc, accept), of(56, 56));
    assert_eq!(offset!(mpm_adaption_desc, user), of(64, 60));
}

#[test]
fn layout_of_mpm_adaption_info() {
    assert_eq!(size_of::<mpm_adaption_info>(), of(80, 80));
    assert_eq!(offset!(mpm_adaption_info, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_adaption_info, reserved), of(4, 4));
    assert_eq!(offset!(mpm_adaption_info, splits), of(8, 8));
    assert_eq!(offset!(mpm_adaption_info, added), of(16, 16));
    assert_eq!(offset!(mpm_adaption_info, merges), of(24, 24));
    assert_eq!(offset!(mpm_adaption_info, kinetic_loss), of(32, 32));
    assert_eq!(offset!(mpm_adaption_info, affine_loss), of(40, 40));
    assert_eq!(offset!(mpm_adaption_info, strain_loss), of(48, 48));
    assert_eq!(offset!(mpm_adaption_info, angular_momentum_loss), of(56, 56));
}

#[test]
fn layout_of_mpm_heat_desc() {
    assert_eq!(size_of::<mpm_heat_desc>(), of(64, 56));
    assert_eq!(offset!(mpm_heat_desc, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_heat_desc, reserved), of(4, 4));
    assert_eq!(offset!(mpm_heat_desc, specific_heat), of(8, 8));
    assert_eq!(offset!(mpm_heat_desc, conductivity), of(16, 16));
    assert_eq!(offset!(mpm_heat_desc, expansion), of(24, 24));
    assert_eq!(offset!(mpm_heat_desc, reference_temperature), of(32, 32));
    assert_eq!(offset!(mpm_heat_desc, dissipated_share), of(40, 40));
    assert_eq!(offset!(mpm_heat_desc, source), of(48, 48));
    assert_eq!(offset!(mpm_heat_desc, user), of(56, 52));
}

#[test]
fn layout_of_mpm_heat_info() {
    assert_eq!(size_of::<mpm_heat_info>(), of(176, 176));
    assert_eq!(offset!(mpm_heat_info, struct_size), of(0, 0));
    assert_eq!(offset!(mpm_heat_info, iterations), of(4, 4));
    assert_eq!(offset!(mpm_heat_info, heat), of(8, 8));
    assert_eq!(offset!(mpm_heat_info, gained), of(16, 16));
    assert_eq!(offset!(mpm_heat_info, walls), of(24, 24));
    assert_eq!(offset!(mpm_heat_info, sources), of(72, 72));
    assert_eq!(offset!(mpm_heat_info, surfaces), of(80, 80));
    assert_eq!(offset!(mpm_heat_info, dissipated), of(88, 88));
    assert_eq!(offset!(mpm_heat_info, gained_total), of(96, 96));
    assert_eq!(offset!(mpm_heat_info, walls_total), of(104, 104));
    assert_eq!(offset!(mpm_heat_info, sources_total), of(152, 152));
    assert_eq!(offset!(mpm_heat_info, surfaces_total), of(160, 160));
    assert_eq!(offset!(mpm_heat_info, dissipated_total), of(168, 168));
}

#[test]
fn functions_are_there() {
    let all = [
        mpm_version as *const (),
        mpm_status_name as *const (),
        mpm_status_text as *const (),
        mpm_view_release as *const (),
        mpm_context_part as *const (),
        mpm_particles_total as *const (),
        mpm_balance_desc_init as *const (),
        mpm_stepper_set_balance as *const (),
        mpm_stepper_parallel_info as *const (),
        mpm_particles_packed_size as *const (),
        mpm_particles_pack as *const (),
        mpm_particles_unpack as *const (),
        mpm_context_desc_init as *const (),
        mpm_context_create as *const (),
        mpm_context_memory as *const (),
        mpm_context_destroy as *const (),
        mpm_last_error as *const (),
        mpm_set_last_error as *const (),
        mpm_grid_desc_init as *const (),
        mpm_grid_create as *const (),
        mpm_grid_destroy as *const (),
        mpm_material_create as *const (),
        mpm_material_model_count as *const (),
        mpm_material_model_name as *const (),
        mpm_material_model_param as *const (),
        mpm_material_state_count as *const (),
        mpm_material_state_name as *const (),
        mpm_batch_field as *const (),
        mpm_material_desc_init as *const (),
        mpm_material_create_custom as *const (),
        mpm_material_update as *const (),
        mpm_material_destroy as *const (),
        mpm_particles_create as *const (),
        mpm_particles_destroy as *const (),
        mpm_particles_add as *const (),
        mpm_particles_fill_box as *const (),
        mpm_particles_fill_ball as *const (),
        mpm_particles_fill as *const (),
        mpm_particles_fill_mesh as *const (),
        mpm_particles_remove as *const (),
        mpm_particles_count as *const (),
        mpm_particles_field_info as *const (),
        mpm_particles_add_field as *const (),
        mpm_particles_set_extensive as *const (),
        mpm_particles_map as *const (),
        mpm_particles_get as *const (),
        mpm_particles_get_f32 as *const (),
        mpm_particles_set as *const (),
        mpm_particles_set_all as *const (),
        mpm_particles_set_geostatic as *const (),
        mpm_particles_reset_reference as *const (),
        mpm_operator_get_info as *const (),
        mpm_operator_apply as *const (),
        mpm_operator_csr as *const (),
        mpm_stepper_desc_init as *const (),
        mpm_stepper_create as *const (),
        mpm_stepper_destroy as *const (),
        mpm_stepper_add as *const (),
        mpm_stepper_remove as *const (),
        mpm_stepper_configure as *const (),
        mpm_stepper_set_time as *const (),
        mpm_stepper_set_motion as *const (),
        mpm_stepper_set_wall as *const (),
        mpm_stepper_set_acceleration as *const (),
        mpm_stepper_set_force as *const (),
        mpm_stepper_set_velocity_bc as *const (),
        mpm_stepper_set_node_hook as *const (),
        mpm_stepper_set_linear_solver as *const (),
        mpm_stepper_set_progress as *const (),
        mpm_stable_dt as *const (),
        mpm_step as *const (),
        mpm_advance_desc_init as *const (),
        mpm_advance as *const (),
        mpm_stepper_profile as *const (),
        mpm_stepper_info as *const (),
        mpm_stepper_residuals as *const (),
        mpm_step_begin as *const (),
        mpm_step_grid as *const (),
        mpm_step_end as *const (),
        mpm_step_abort as *const (),
        mpm_grid_map as *const (),
        mpm_stepper_wall_reaction as *const (),
        mpm_stepper_particles_reaction as *const (),
        mpm_stepper_wall_impulse as *const (),
        mpm_stepper_particles_impulse as *const (),
        mpm_stepper_set_body as *const (),
        mpm_stepper_body as *const (),
        mpm_contact_desc_init as *const (),
        mpm_stepper_set_contact as *const (),
        mpm_stepper_set_friction as *const (),
        mpm_stepper_contact_info as *const (),
        mpm_obstacle_desc_init as *const (),
        mpm_obstacle_create as *const (),
        mpm_obstacle_destroy as *const (),
        mpm_stepper_add_obstacle as *const (),
        mpm_stepper_remove_obstacle as *const (),
        mpm_obstacle_set_motion as *const (),
        mpm_obstacle_set_contact as *const (),
        mpm_obstacle_set_pose as *const (),
        mpm_obstacle_get_pose as *const (),
        mpm_obstacle_set_load as *const (),
        mpm_obstacle_contact_info as *const (),
        mpm_surface_desc_init as *const (),
        mpm_surface_create as *const (),
        mpm_surface_destroy as *const (),
        mpm_surface_configure as *const (),
        mpm_surface_set_traction as *const (),
        mpm_surface_set_velocity as *const (),
        mpm_surface_add as *const (),
        mpm_surface_add_polyline as *const (),
        mpm_surface_add_triangles as *const (),
        mpm_surface_remove as *const (),
        mpm_surface_refine as *const (),
        mpm_surface_count as *const (),
        mpm_surface_get as *const (),
        mpm_surface_set as *const (),
        mpm_stepper_add_surface as *const (),
        mpm_stepper_remove_surface as *const (),
        mpm_stepper_surface_reaction as *const (),
        mpm_stepper_surface_impulse as *const (),
        mpm_adaption_desc_init as *const (),
        mpm_stepper_set_adaption as *const (),
        mpm_stepper_adapt as *const (),
        mpm_stepper_adaption_info as *const (),
        mpm_heat_desc_init as *const (),
        mpm_stepper_set_heat as *const (),
        mpm_stepper_set_conduction as *const (),
        mpm_stepper_set_heat_wall as *const (),
        mpm_surface_set_heat as *const (),
        mpm_stepper_heat_info as *const (),
        mpm_state_size as *const (),
        mpm_state_save as *const (),
        mpm_state_load as *const (),
        mpm_state_load_pieces as *const (),
        mpm_state_save_file as *const (),
        mpm_state_save_to as *const (),
        mpm_state_load_file as *const (),
        mpm_state_hash as *const (),
        mpm_write_particles as *const (),
        mpm_write_particles_to as *const (),
        mpm_write_grid as *const (),
        mpm_write_body_grid as *const (),
        mpm_write_grid_to as *const (),
        mpm_series_open as *const (),
        mpm_series_append as *const (),
        mpm_series_close as *const (),
    ];
    assert!(all.iter().all(|function| !function.is_null()));
}
