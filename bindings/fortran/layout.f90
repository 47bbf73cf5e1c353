! Generated from the headers of libmpm by `make api`; not to be edited.
! Whether types lie in memory as those of C, and whether the library has every function.
program layout
  use mpm
  implicit none
  integer :: wrong
  type(c_ptr) :: pointer
  wrong = 0
  call check_mpm_param()
  call check_mpm_view()
  call check_mpm_context_desc()
  call check_mpm_grid_desc()
  call check_mpm_material_batch()
  call check_mpm_material_desc()
  call check_mpm_operator_info()
  call check_mpm_stepper_desc()
  call check_mpm_step_info()
  call check_mpm_particle_batch()
  call check_mpm_node_batch()
  call check_mpm_advance_desc()
  call check_mpm_profile()
  call check_mpm_contact_desc()
  call check_mpm_contact_info()
  call check_mpm_contact_batch()
  call check_mpm_distance_batch()
  call check_mpm_obstacle_desc()
  call check_functions()
  if (wrong /= 0) error stop 1
  print '(a)', "layouts agree"

contains

  !> The one that holds for pointers of the size that they have here.
  pure integer function of(wide, narrow)
    integer, intent(in) :: wide, narrow
    of = merge(wide, narrow, c_sizeof(pointer) == 8)
  end function of

  subroutine compare(what, is, should)
    character(*), intent(in) :: what
    integer(c_size_t), intent(in) :: is
    integer, intent(in) :: should
    if (is == should) return
    print '(a, i0, a, i0)', what // ": ", is, ", in C ", should
    wrong = wrong + 1
  end subroutine compare

  !> The distance of two addresses.
  integer(c_size_t) function distance(from, to)
    type(c_ptr), intent(in) :: from, to
    distance = int(transfer(to, 0_c_intptr_t) - transfer(from, 0_c_intptr_t), c_size_t)
  end function distance

  subroutine check_mpm_param()
    type(mpm_param), target :: it
    call compare("mpm_param", c_sizeof(it), of(16, 16))
    call compare("mpm_param%name", distance(c_loc(it), c_loc(it%name)), of(0, 0))
    call compare("mpm_param%value", distance(c_loc(it), c_loc(it%value)), of(8, 8))
  end subroutine check_mpm_param

  subroutine check_mpm_view()
    type(mpm_view), target :: it
    call compare("mpm_view", c_sizeof(it), of(56, 48))
    call compare("mpm_view%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_view%type", distance(c_loc(it), c_loc(it%type)), of(4, 4))
    call compare("mpm_view%components", distance(c_loc(it), c_loc(it%components)), of(8, 8))
    call compare("mpm_view%access", distance(c_loc(it), c_loc(it%access)), of(12, 12))
    call compare("mpm_view%count", distance(c_loc(it), c_loc(it%count)), of(16, 16))
    call compare("mpm_view%item_stride", distance(c_loc(it), c_loc(it%item_stride)), of(24, 24))
    call compare("mpm_view%component_stride", distance(c_loc(it), c_loc(it%component_stride)), of(32, 32))
    call compare("mpm_view%data", distance(c_loc(it), c_loc(it%data)), of(40, 40))
    call compare("mpm_view%owner", distance(c_loc(it), c_loc(it%owner)), of(48, 44))
  end subroutine check_mpm_view

  subroutine check_mpm_context_desc()
    type(mpm_context_desc), target :: it
    call compare("mpm_context_desc", c_sizeof(it), of(88, 56))
    call compare("mpm_context_desc%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_context_desc%concurrency", distance(c_loc(it), c_loc(it%concurrency)), of(4, 4))
    call compare("mpm_context_desc%isa", distance(c_loc(it), c_loc(it%isa)), of(8, 8))
    call compare("mpm_context_desc%serial_callbacks", distance(c_loc(it), c_loc(it%serial_callbacks)), of(12, 12))
    call compare("mpm_context_desc%alloc", distance(c_loc(it), c_loc(it%alloc)), of(16, 16))
    call compare("mpm_context_desc%release", distance(c_loc(it), c_loc(it%release)), of(24, 20))
    call compare("mpm_context_desc%alloc_user", distance(c_loc(it), c_loc(it%alloc_user)), of(32, 24))
    call compare("mpm_context_desc%parallel_for", distance(c_loc(it), c_loc(it%parallel_for)), of(40, 28))
    call compare("mpm_context_desc%parallel_user", distance(c_loc(it), c_loc(it%parallel_user)), of(48, 32))
    call compare("mpm_context_desc%log", distance(c_loc(it), c_loc(it%log)), of(56, 36))
    call compare("mpm_context_desc%log_user", distance(c_loc(it), c_loc(it%log_user)), of(64, 40))
    call compare("mpm_context_desc%error_text", distance(c_loc(it), c_loc(it%error_text)), of(72, 44))
    call compare("mpm_context_desc%error_bytes", distance(c_loc(it), c_loc(it%error_bytes)), of(80, 48))
  end subroutine check_mpm_context_desc

  subroutine check_mpm_grid_desc()
    type(mpm_grid_desc), target :: it
    call compare("mpm_grid_desc", c_sizeof(it), of(112, 112))
    call compare("mpm_grid_desc%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_grid_desc%dim", distance(c_loc(it), c_loc(it%dim)), of(4, 4))
    call compare("mpm_grid_desc%basis", distance(c_loc(it), c_loc(it%basis)), of(8, 8))
    call compare("mpm_grid_desc%boundary_basis", distance(c_loc(it), c_loc(it%boundary_basis)), of(12, 12))
    call compare("mpm_grid_desc%periodic", distance(c_loc(it), c_loc(it%periodic)), of(16, 16))
    call compare("mpm_grid_desc%reserved", distance(c_loc(it), c_loc(it%reserved)), of(28, 28))
    call compare("mpm_grid_desc%cells", distance(c_loc(it), c_loc(it%cells)), of(32, 32))
    call compare("mpm_grid_desc%origin", distance(c_loc(it), c_loc(it%origin)), of(56, 56))
    call compare("mpm_grid_desc%spacing", distance(c_loc(it), c_loc(it%spacing)), of(80, 80))
    call compare("mpm_grid_desc%smoothing", distance(c_loc(it), c_loc(it%smoothing)), of(104, 104))
  end subroutine check_mpm_grid_desc

  subroutine check_mpm_material_batch()
    type(mpm_material_batch), target :: it
    call compare("mpm_material_batch", c_sizeof(it), of(144, 96))
    call compare("mpm_material_batch%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_material_batch%state_count", distance(c_loc(it), c_loc(it%state_count)), of(4, 4))
    call compare("mpm_material_batch%n", distance(c_loc(it), c_loc(it%n)), of(8, 8))
    call compare("mpm_material_batch%ld", distance(c_loc(it), c_loc(it%ld)), of(16, 16))
    call compare("mpm_material_batch%t", distance(c_loc(it), c_loc(it%t)), of(24, 24))
    call compare("mpm_material_batch%dt", distance(c_loc(it), c_loc(it%dt)), of(32, 32))
    call compare("mpm_material_batch%id", distance(c_loc(it), c_loc(it%id)), of(40, 40))
    call compare("mpm_material_batch%F", distance(c_loc(it), c_loc(it%F)), of(48, 44))
    call compare("mpm_material_batch%F_inc", distance(c_loc(it), c_loc(it%F_inc)), of(56, 48))
    call compare("mpm_material_batch%L", distance(c_loc(it), c_loc(it%L)), of(64, 52))
    call compare("mpm_material_batch%stress", distance(c_loc(it), c_loc(it%stress)), of(72, 56))
    call compare("mpm_material_batch%state", distance(c_loc(it), c_loc(it%state)), of(80, 60))
    call compare("mpm_material_batch%stress_new", distance(c_loc(it), c_loc(it%stress_new)), of(88, 64))
    call compare("mpm_material_batch%state_new", distance(c_loc(it), c_loc(it%state_new)), of(96, 68))
    call compare("mpm_material_batch%wave_speed", distance(c_loc(it), c_loc(it%wave_speed)), of(104, 72))
    call compare("mpm_material_batch%kinematic_viscosity", distance(c_loc(it), c_loc(it%kinematic_viscosity)), of(112, &
        76))
    call compare("mpm_material_batch%energy", distance(c_loc(it), c_loc(it%energy)), of(120, 80))
    call compare("mpm_material_batch%position", distance(c_loc(it), c_loc(it%position)), of(128, 84))
    call compare("mpm_material_batch%lookup", distance(c_loc(it), c_loc(it%lookup)), of(136, 88))
  end subroutine check_mpm_material_batch

  subroutine check_mpm_material_desc()
    type(mpm_material_desc), target :: it
    call compare("mpm_material_desc", c_sizeof(it), of(64, 48))
    call compare("mpm_material_desc%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_material_desc%state_count", distance(c_loc(it), c_loc(it%state_count)), of(4, 4))
    call compare("mpm_material_desc%tangent_form", distance(c_loc(it), c_loc(it%tangent_form)), of(8, 8))
    call compare("mpm_material_desc%reserved", distance(c_loc(it), c_loc(it%reserved)), of(12, 12))
    call compare("mpm_material_desc%density", distance(c_loc(it), c_loc(it%density)), of(16, 16))
    call compare("mpm_material_desc%stress", distance(c_loc(it), c_loc(it%stress)), of(24, 24))
    call compare("mpm_material_desc%tangent", distance(c_loc(it), c_loc(it%tangent)), of(32, 28))
    call compare("mpm_material_desc%user", distance(c_loc(it), c_loc(it%user)), of(40, 32))
    call compare("mpm_material_desc%release_user", distance(c_loc(it), c_loc(it%release_user)), of(48, 36))
    call compare("mpm_material_desc%state_initial", distance(c_loc(it), c_loc(it%state_initial)), of(56, 40))
  end subroutine check_mpm_material_desc

  subroutine check_mpm_operator_info()
    type(mpm_operator_info), target :: it
    call compare("mpm_operator_info", c_sizeof(it), of(72, 64))
    call compare("mpm_operator_info%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_operator_info%block", distance(c_loc(it), c_loc(it%block)), of(4, 4))
    call compare("mpm_operator_info%symmetric", distance(c_loc(it), c_loc(it%symmetric)), of(8, 8))
    call compare("mpm_operator_info%positive_definite", distance(c_loc(it), c_loc(it%positive_definite)), of(12, 12))
    call compare("mpm_operator_info%rows", distance(c_loc(it), c_loc(it%rows)), of(16, 16))
    call compare("mpm_operator_info%nonzeros", distance(c_loc(it), c_loc(it%nonzeros)), of(24, 24))
    call compare("mpm_operator_info%pattern_id", distance(c_loc(it), c_loc(it%pattern_id)), of(32, 32))
    call compare("mpm_operator_info%ld", distance(c_loc(it), c_loc(it%ld)), of(40, 40))
    call compare("mpm_operator_info%node", distance(c_loc(it), c_loc(it%node)), of(48, 48))
    call compare("mpm_operator_info%component", distance(c_loc(it), c_loc(it%component)), of(56, 52))
    call compare("mpm_operator_info%position", distance(c_loc(it), c_loc(it%position)), of(64, 56))
  end subroutine check_mpm_operator_info

  subroutine check_mpm_stepper_desc()
    type(mpm_stepper_desc), target :: it
    call compare("mpm_stepper_desc", c_sizeof(it), of(176, 176))
    call compare("mpm_stepper_desc%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_stepper_desc%scheme", distance(c_loc(it), c_loc(it%scheme)), of(4, 4))
    call compare("mpm_stepper_desc%transfer", distance(c_loc(it), c_loc(it%transfer)), of(8, 8))
    call compare("mpm_stepper_desc%xpic_order", distance(c_loc(it), c_loc(it%xpic_order)), of(12, 12))
    call compare("mpm_stepper_desc%position_order", distance(c_loc(it), c_loc(it%position_order)), of(16, 16))
    call compare("mpm_stepper_desc%locking_remedy", distance(c_loc(it), c_loc(it%locking_remedy)), of(20, 20))
    call compare("mpm_stepper_desc%reference_positions", distance(c_loc(it), c_loc(it%reference_positions)), of(24, &
        24))
    call compare("mpm_stepper_desc%quasi_static", distance(c_loc(it), c_loc(it%quasi_static)), of(28, 28))
    call compare("mpm_stepper_desc%staggered", distance(c_loc(it), c_loc(it%staggered)), of(32, 32))
    call compare("mpm_stepper_desc%boundary_zero_acceleration", distance(c_loc(it), &
        c_loc(it%boundary_zero_acceleration)), of(36, 36))
    call compare("mpm_stepper_desc%flip", distance(c_loc(it), c_loc(it%flip)), of(40, 40))
    call compare("mpm_stepper_desc%pic_damping", distance(c_loc(it), c_loc(it%pic_damping)), of(48, 48))
    call compare("mpm_stepper_desc%gravity", distance(c_loc(it), c_loc(it%gravity)), of(56, 56))
    call compare("mpm_stepper_desc%newmark_beta", distance(c_loc(it), c_loc(it%newmark_beta)), of(80, 80))
    call compare("mpm_stepper_desc%newmark_gamma", distance(c_loc(it), c_loc(it%newmark_gamma)), of(88, 88))
    call compare("mpm_stepper_desc%newton_tolerance_displacement", distance(c_loc(it), &
        c_loc(it%newton_tolerance_displacement)), of(96, 96))
    call compare("mpm_stepper_desc%newton_tolerance_energy", distance(c_loc(it), c_loc(it%newton_tolerance_energy)), &
        of(104, 104))
    call compare("mpm_stepper_desc%newton_tolerance_residual", distance(c_loc(it), &
        c_loc(it%newton_tolerance_residual)), of(112, 112))
    call compare("mpm_stepper_desc%newton_residual_floor", distance(c_loc(it), c_loc(it%newton_residual_floor)), &
        of(120, 120))
    call compare("mpm_stepper_desc%newton_max_iterations", distance(c_loc(it), c_loc(it%newton_max_iterations)), &
        of(128, 128))
    call compare("mpm_stepper_desc%linear_solver", distance(c_loc(it), c_loc(it%linear_solver)), of(132, 132))
    call compare("mpm_stepper_desc%linear_tolerance", distance(c_loc(it), c_loc(it%linear_tolerance)), of(136, 136))
    call compare("mpm_stepper_desc%linear_max_iterations", distance(c_loc(it), c_loc(it%linear_max_iterations)), &
        of(144, 144))
    call compare("mpm_stepper_desc%projected_positions", distance(c_loc(it), c_loc(it%projected_positions)), of(148, &
        148))
    call compare("mpm_stepper_desc%local_damping", distance(c_loc(it), c_loc(it%local_damping)), of(152, 152))
    call compare("mpm_stepper_desc%mass_damping", distance(c_loc(it), c_loc(it%mass_damping)), of(160, 160))
    call compare("mpm_stepper_desc%xpic_every", distance(c_loc(it), c_loc(it%xpic_every)), of(168, 168))
    call compare("mpm_stepper_desc%reserved", distance(c_loc(it), c_loc(it%reserved)), of(172, 172))
  end subroutine check_mpm_stepper_desc

  subroutine check_mpm_step_info()
    type(mpm_step_info), target :: it
    call compare("mpm_step_info", c_sizeof(it), of(248, 248))
    call compare("mpm_step_info%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_step_info%cause", distance(c_loc(it), c_loc(it%cause)), of(4, 4))
    call compare("mpm_step_info%callback_status", distance(c_loc(it), c_loc(it%callback_status)), of(8, 8))
    call compare("mpm_step_info%newton_iterations", distance(c_loc(it), c_loc(it%newton_iterations)), of(12, 12))
    call compare("mpm_step_info%linear_solver", distance(c_loc(it), c_loc(it%linear_solver)), of(16, 16))
    call compare("mpm_step_info%set", distance(c_loc(it), c_loc(it%set)), of(20, 20))
    call compare("mpm_step_info%step", distance(c_loc(it), c_loc(it%step)), of(24, 24))
    call compare("mpm_step_info%active_nodes", distance(c_loc(it), c_loc(it%active_nodes)), of(32, 32))
    call compare("mpm_step_info%removed", distance(c_loc(it), c_loc(it%removed)), of(40, 40))
    call compare("mpm_step_info%resorts", distance(c_loc(it), c_loc(it%resorts)), of(48, 48))
    call compare("mpm_step_info%particle", distance(c_loc(it), c_loc(it%particle)), of(56, 56))
    call compare("mpm_step_info%node", distance(c_loc(it), c_loc(it%node)), of(64, 64))
    call compare("mpm_step_info%linear_iterations", distance(c_loc(it), c_loc(it%linear_iterations)), of(72, 72))
    call compare("mpm_step_info%t", distance(c_loc(it), c_loc(it%t)), of(80, 80))
    call compare("mpm_step_info%dt", distance(c_loc(it), c_loc(it%dt)), of(88, 88))
    call compare("mpm_step_info%dt_suggested", distance(c_loc(it), c_loc(it%dt_suggested)), of(96, 96))
    call compare("mpm_step_info%residual", distance(c_loc(it), c_loc(it%residual)), of(104, 104))
    call compare("mpm_step_info%kinetic_energy", distance(c_loc(it), c_loc(it%kinetic_energy)), of(112, 112))
    call compare("mpm_step_info%strain_energy", distance(c_loc(it), c_loc(it%strain_energy)), of(120, 120))
    call compare("mpm_step_info%external_work", distance(c_loc(it), c_loc(it%external_work)), of(128, 128))
    call compare("mpm_step_info%dissipation", distance(c_loc(it), c_loc(it%dissipation)), of(136, 136))
    call compare("mpm_step_info%momentum", distance(c_loc(it), c_loc(it%momentum)), of(144, 144))
    call compare("mpm_step_info%angular_momentum", distance(c_loc(it), c_loc(it%angular_momentum)), of(168, 168))
    call compare("mpm_step_info%external_work_total", distance(c_loc(it), c_loc(it%external_work_total)), of(192, &
        192))
    call compare("mpm_step_info%affine_kinetic_energy", distance(c_loc(it), c_loc(it%affine_kinetic_energy)), of(200, &
        200))
    call compare("mpm_step_info%contact_dissipation", distance(c_loc(it), c_loc(it%contact_dissipation)), of(208, &
        208))
    call compare("mpm_step_info%contact_nodes", distance(c_loc(it), c_loc(it%contact_nodes)), of(216, 216))
    call compare("mpm_step_info%body", distance(c_loc(it), c_loc(it%body)), of(224, 224))
    call compare("mpm_step_info%reserved", distance(c_loc(it), c_loc(it%reserved)), of(228, 228))
    call compare("mpm_step_info%damping_dissipation", distance(c_loc(it), c_loc(it%damping_dissipation)), of(232, &
        232))
    call compare("mpm_step_info%damping_dissipation_total", distance(c_loc(it), c_loc(it%damping_dissipation_total)), &
        of(240, 240))
  end subroutine check_mpm_step_info

  subroutine check_mpm_particle_batch()
    type(mpm_particle_batch), target :: it
    call compare("mpm_particle_batch", c_sizeof(it), of(104, 72))
    call compare("mpm_particle_batch%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_particle_batch%dim", distance(c_loc(it), c_loc(it%dim)), of(4, 4))
    call compare("mpm_particle_batch%n", distance(c_loc(it), c_loc(it%n)), of(8, 8))
    call compare("mpm_particle_batch%ld", distance(c_loc(it), c_loc(it%ld)), of(16, 16))
    call compare("mpm_particle_batch%t", distance(c_loc(it), c_loc(it%t)), of(24, 24))
    call compare("mpm_particle_batch%dt", distance(c_loc(it), c_loc(it%dt)), of(32, 32))
    call compare("mpm_particle_batch%id", distance(c_loc(it), c_loc(it%id)), of(40, 40))
    call compare("mpm_particle_batch%position", distance(c_loc(it), c_loc(it%position)), of(48, 44))
    call compare("mpm_particle_batch%reference_position", distance(c_loc(it), c_loc(it%reference_position)), of(56, &
        48))
    call compare("mpm_particle_batch%velocity", distance(c_loc(it), c_loc(it%velocity)), of(64, 52))
    call compare("mpm_particle_batch%mass", distance(c_loc(it), c_loc(it%mass)), of(72, 56))
    call compare("mpm_particle_batch%volume", distance(c_loc(it), c_loc(it%volume)), of(80, 60))
    call compare("mpm_particle_batch%particles", distance(c_loc(it), c_loc(it%particles)), of(88, 64))
    call compare("mpm_particle_batch%lookup", distance(c_loc(it), c_loc(it%lookup)), of(96, 68))
  end subroutine check_mpm_particle_batch

  subroutine check_mpm_node_batch()
    type(mpm_node_batch), target :: it
    call compare("mpm_node_batch", c_sizeof(it), of(72, 64))
    call compare("mpm_node_batch%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_node_batch%dim", distance(c_loc(it), c_loc(it%dim)), of(4, 4))
    call compare("mpm_node_batch%body", distance(c_loc(it), c_loc(it%body)), of(8, 8))
    call compare("mpm_node_batch%reserved", distance(c_loc(it), c_loc(it%reserved)), of(12, 12))
    call compare("mpm_node_batch%n", distance(c_loc(it), c_loc(it%n)), of(16, 16))
    call compare("mpm_node_batch%ld", distance(c_loc(it), c_loc(it%ld)), of(24, 24))
    call compare("mpm_node_batch%t", distance(c_loc(it), c_loc(it%t)), of(32, 32))
    call compare("mpm_node_batch%dt", distance(c_loc(it), c_loc(it%dt)), of(40, 40))
    call compare("mpm_node_batch%index", distance(c_loc(it), c_loc(it%index)), of(48, 48))
    call compare("mpm_node_batch%position", distance(c_loc(it), c_loc(it%position)), of(56, 52))
    call compare("mpm_node_batch%mass", distance(c_loc(it), c_loc(it%mass)), of(64, 56))
  end subroutine check_mpm_node_batch

  subroutine check_mpm_advance_desc()
    type(mpm_advance_desc), target :: it
    call compare("mpm_advance_desc", c_sizeof(it), of(56, 56))
    call compare("mpm_advance_desc%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_advance_desc%max_cuts", distance(c_loc(it), c_loc(it%max_cuts)), of(4, 4))
    call compare("mpm_advance_desc%t_end", distance(c_loc(it), c_loc(it%t_end)), of(8, 8))
    call compare("mpm_advance_desc%cfl", distance(c_loc(it), c_loc(it%cfl)), of(16, 16))
    call compare("mpm_advance_desc%dt_first", distance(c_loc(it), c_loc(it%dt_first)), of(24, 24))
    call compare("mpm_advance_desc%dt_min", distance(c_loc(it), c_loc(it%dt_min)), of(32, 32))
    call compare("mpm_advance_desc%dt_max", distance(c_loc(it), c_loc(it%dt_max)), of(40, 40))
    call compare("mpm_advance_desc%max_steps", distance(c_loc(it), c_loc(it%max_steps)), of(48, 48))
  end subroutine check_mpm_advance_desc

  subroutine check_mpm_profile()
    type(mpm_profile), target :: it
    call compare("mpm_profile", c_sizeof(it), of(96, 96))
    call compare("mpm_profile%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_profile%reserved", distance(c_loc(it), c_loc(it%reserved)), of(4, 4))
    call compare("mpm_profile%sort", distance(c_loc(it), c_loc(it%sort)), of(8, 8))
    call compare("mpm_profile%p2g", distance(c_loc(it), c_loc(it%p2g)), of(16, 16))
    call compare("mpm_profile%grid", distance(c_loc(it), c_loc(it%grid)), of(24, 24))
    call compare("mpm_profile%g2p", distance(c_loc(it), c_loc(it%g2p)), of(32, 32))
    call compare("mpm_profile%law", distance(c_loc(it), c_loc(it%law)), of(40, 40))
    call compare("mpm_profile%assembly", distance(c_loc(it), c_loc(it%assembly)), of(48, 48))
    call compare("mpm_profile%factor", distance(c_loc(it), c_loc(it%factor)), of(56, 56))
    call compare("mpm_profile%solve", distance(c_loc(it), c_loc(it%solve)), of(64, 64))
    call compare("mpm_profile%callbacks", distance(c_loc(it), c_loc(it%callbacks)), of(72, 72))
    call compare("mpm_profile%total", distance(c_loc(it), c_loc(it%total)), of(80, 80))
    call compare("mpm_profile%weights", distance(c_loc(it), c_loc(it%weights)), of(88, 88))
  end subroutine check_mpm_profile

  subroutine check_mpm_contact_desc()
    type(mpm_contact_desc), target :: it
    call compare("mpm_contact_desc", c_sizeof(it), of(72, 72))
    call compare("mpm_contact_desc%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_contact_desc%kind", distance(c_loc(it), c_loc(it%kind)), of(4, 4))
    call compare("mpm_contact_desc%normal", distance(c_loc(it), c_loc(it%normal)), of(8, 8))
    call compare("mpm_contact_desc%detection", distance(c_loc(it), c_loc(it%detection)), of(12, 12))
    call compare("mpm_contact_desc%friction", distance(c_loc(it), c_loc(it%friction)), of(16, 16))
    call compare("mpm_contact_desc%friction_static", distance(c_loc(it), c_loc(it%friction_static)), of(24, 24))
    call compare("mpm_contact_desc%adhesion", distance(c_loc(it), c_loc(it%adhesion)), of(32, 32))
    call compare("mpm_contact_desc%offset", distance(c_loc(it), c_loc(it%offset)), of(40, 40))
    call compare("mpm_contact_desc%direction", distance(c_loc(it), c_loc(it%direction)), of(48, 48))
  end subroutine check_mpm_contact_desc

  subroutine check_mpm_contact_info()
    type(mpm_contact_info), target :: it
    call compare("mpm_contact_info", c_sizeof(it), of(160, 160))
    call compare("mpm_contact_info%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_contact_info%touching", distance(c_loc(it), c_loc(it%touching)), of(4, 4))
    call compare("mpm_contact_info%nodes", distance(c_loc(it), c_loc(it%nodes)), of(8, 8))
    call compare("mpm_contact_info%closed", distance(c_loc(it), c_loc(it%closed)), of(16, 16))
    call compare("mpm_contact_info%stuck", distance(c_loc(it), c_loc(it%stuck)), of(24, 24))
    call compare("mpm_contact_info%ambiguous", distance(c_loc(it), c_loc(it%ambiguous)), of(32, 32))
    call compare("mpm_contact_info%force", distance(c_loc(it), c_loc(it%force)), of(40, 40))
    call compare("mpm_contact_info%torque", distance(c_loc(it), c_loc(it%torque)), of(64, 64))
    call compare("mpm_contact_info%normal_force", distance(c_loc(it), c_loc(it%normal_force)), of(88, 88))
    call compare("mpm_contact_info%area", distance(c_loc(it), c_loc(it%area)), of(96, 96))
    call compare("mpm_contact_info%pressure_max", distance(c_loc(it), c_loc(it%pressure_max)), of(104, 104))
    call compare("mpm_contact_info%gap", distance(c_loc(it), c_loc(it%gap)), of(112, 112))
    call compare("mpm_contact_info%dissipation", distance(c_loc(it), c_loc(it%dissipation)), of(120, 120))
    call compare("mpm_contact_info%friction_work", distance(c_loc(it), c_loc(it%friction_work)), of(128, 128))
    call compare("mpm_contact_info%impulse", distance(c_loc(it), c_loc(it%impulse)), of(136, 136))
  end subroutine check_mpm_contact_info

  subroutine check_mpm_contact_batch()
    type(mpm_contact_batch), target :: it
    call compare("mpm_contact_batch", c_sizeof(it), of(96, 72))
    call compare("mpm_contact_batch%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_contact_batch%dim", distance(c_loc(it), c_loc(it%dim)), of(4, 4))
    call compare("mpm_contact_batch%body_a", distance(c_loc(it), c_loc(it%body_a)), of(8, 8))
    call compare("mpm_contact_batch%body_b", distance(c_loc(it), c_loc(it%body_b)), of(12, 12))
    call compare("mpm_contact_batch%n", distance(c_loc(it), c_loc(it%n)), of(16, 16))
    call compare("mpm_contact_batch%ld", distance(c_loc(it), c_loc(it%ld)), of(24, 24))
    call compare("mpm_contact_batch%t", distance(c_loc(it), c_loc(it%t)), of(32, 32))
    call compare("mpm_contact_batch%dt", distance(c_loc(it), c_loc(it%dt)), of(40, 40))
    call compare("mpm_contact_batch%position", distance(c_loc(it), c_loc(it%position)), of(48, 48))
    call compare("mpm_contact_batch%normal", distance(c_loc(it), c_loc(it%normal)), of(56, 52))
    call compare("mpm_contact_batch%gap", distance(c_loc(it), c_loc(it%gap)), of(64, 56))
    call compare("mpm_contact_batch%area", distance(c_loc(it), c_loc(it%area)), of(72, 60))
    call compare("mpm_contact_batch%slip", distance(c_loc(it), c_loc(it%slip)), of(80, 64))
    call compare("mpm_contact_batch%pressure", distance(c_loc(it), c_loc(it%pressure)), of(88, 68))
  end subroutine check_mpm_contact_batch

  subroutine check_mpm_distance_batch()
    type(mpm_distance_batch), target :: it
    call compare("mpm_distance_batch", c_sizeof(it), of(64, 48))
    call compare("mpm_distance_batch%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_distance_batch%dim", distance(c_loc(it), c_loc(it%dim)), of(4, 4))
    call compare("mpm_distance_batch%n", distance(c_loc(it), c_loc(it%n)), of(8, 8))
    call compare("mpm_distance_batch%ld", distance(c_loc(it), c_loc(it%ld)), of(16, 16))
    call compare("mpm_distance_batch%t", distance(c_loc(it), c_loc(it%t)), of(24, 24))
    call compare("mpm_distance_batch%position", distance(c_loc(it), c_loc(it%position)), of(32, 32))
    call compare("mpm_distance_batch%distance", distance(c_loc(it), c_loc(it%distance)), of(40, 36))
    call compare("mpm_distance_batch%normal", distance(c_loc(it), c_loc(it%normal)), of(48, 40))
    call compare("mpm_distance_batch%velocity", distance(c_loc(it), c_loc(it%velocity)), of(56, 44))
  end subroutine check_mpm_distance_batch

  subroutine check_mpm_obstacle_desc()
    type(mpm_obstacle_desc), target :: it
    call compare("mpm_obstacle_desc", c_sizeof(it), of(296, 288))
    call compare("mpm_obstacle_desc%struct_size", distance(c_loc(it), c_loc(it%struct_size)), of(0, 0))
    call compare("mpm_obstacle_desc%shape", distance(c_loc(it), c_loc(it%shape)), of(4, 4))
    call compare("mpm_obstacle_desc%motion", distance(c_loc(it), c_loc(it%motion)), of(8, 8))
    call compare("mpm_obstacle_desc%inside", distance(c_loc(it), c_loc(it%inside)), of(12, 12))
    call compare("mpm_obstacle_desc%size", distance(c_loc(it), c_loc(it%size)), of(16, 16))
    call compare("mpm_obstacle_desc%position", distance(c_loc(it), c_loc(it%position)), of(40, 40))
    call compare("mpm_obstacle_desc%orientation", distance(c_loc(it), c_loc(it%orientation)), of(64, 64))
    call compare("mpm_obstacle_desc%velocity", distance(c_loc(it), c_loc(it%velocity)), of(96, 96))
    call compare("mpm_obstacle_desc%angular_velocity", distance(c_loc(it), c_loc(it%angular_velocity)), of(120, 120))
    call compare("mpm_obstacle_desc%mass", distance(c_loc(it), c_loc(it%mass)), of(144, 144))
    call compare("mpm_obstacle_desc%inertia", distance(c_loc(it), c_loc(it%inertia)), of(152, 152))
    call compare("mpm_obstacle_desc%contact", distance(c_loc(it), c_loc(it%contact)), of(224, 224))
    call compare("mpm_obstacle_desc%distance", distance(c_loc(it), c_loc(it%distance)), of(232, 228))
    call compare("mpm_obstacle_desc%user", distance(c_loc(it), c_loc(it%user)), of(240, 232))
    call compare("mpm_obstacle_desc%lower", distance(c_loc(it), c_loc(it%lower)), of(248, 240))
    call compare("mpm_obstacle_desc%upper", distance(c_loc(it), c_loc(it%upper)), of(272, 264))
  end subroutine check_mpm_obstacle_desc

  subroutine check_functions()
    type(c_funptr) :: all(107)
    integer :: k
    all(1) = c_funloc(mpm_version)
    all(2) = c_funloc(mpm_status_name)
    all(3) = c_funloc(mpm_status_text)
    all(4) = c_funloc(mpm_view_release)
    all(5) = c_funloc(mpm_context_desc_init)
    all(6) = c_funloc(mpm_context_create)
    all(7) = c_funloc(mpm_context_memory)
    all(8) = c_funloc(mpm_context_destroy)
    all(9) = c_funloc(mpm_last_error)
    all(10) = c_funloc(mpm_set_last_error)
    all(11) = c_funloc(mpm_grid_desc_init)
    all(12) = c_funloc(mpm_grid_create)
    all(13) = c_funloc(mpm_grid_destroy)
    all(14) = c_funloc(mpm_material_create)
    all(15) = c_funloc(mpm_material_model_count)
    all(16) = c_funloc(mpm_material_model_name)
    all(17) = c_funloc(mpm_material_model_param)
    all(18) = c_funloc(mpm_material_state_count)
    all(19) = c_funloc(mpm_material_state_name)
    all(20) = c_funloc(mpm_batch_field)
    all(21) = c_funloc(mpm_material_desc_init)
    all(22) = c_funloc(mpm_material_create_custom)
    all(23) = c_funloc(mpm_material_update)
    all(24) = c_funloc(mpm_material_destroy)
    all(25) = c_funloc(mpm_particles_create)
    all(26) = c_funloc(mpm_particles_destroy)
    all(27) = c_funloc(mpm_particles_add)
    all(28) = c_funloc(mpm_particles_fill_box)
    all(29) = c_funloc(mpm_particles_fill_ball)
    all(30) = c_funloc(mpm_particles_fill)
    all(31) = c_funloc(mpm_particles_remove)
    all(32) = c_funloc(mpm_particles_count)
    all(33) = c_funloc(mpm_particles_field_info)
    all(34) = c_funloc(mpm_particles_add_field)
    all(35) = c_funloc(mpm_particles_map)
    all(36) = c_funloc(mpm_particles_get)
    all(37) = c_funloc(mpm_particles_get_f32)
    all(38) = c_funloc(mpm_particles_set)
    all(39) = c_funloc(mpm_particles_set_all)
    all(40) = c_funloc(mpm_particles_set_geostatic)
    all(41) = c_funloc(mpm_particles_reset_reference)
    all(42) = c_funloc(mpm_operator_get_info)
    all(43) = c_funloc(mpm_operator_apply)
    all(44) = c_funloc(mpm_operator_csr)
    all(45) = c_funloc(mpm_stepper_desc_init)
    all(46) = c_funloc(mpm_stepper_create)
    all(47) = c_funloc(mpm_stepper_destroy)
    all(48) = c_funloc(mpm_stepper_add)
    all(49) = c_funloc(mpm_stepper_remove)
    all(50) = c_funloc(mpm_stepper_configure)
    all(51) = c_funloc(mpm_stepper_set_time)
    all(52) = c_funloc(mpm_stepper_set_motion)
    all(53) = c_funloc(mpm_stepper_set_wall)
    all(54) = c_funloc(mpm_stepper_set_acceleration)
    all(55) = c_funloc(mpm_stepper_set_force)
    all(56) = c_funloc(mpm_stepper_set_velocity_bc)
    all(57) = c_funloc(mpm_stepper_set_node_hook)
    all(58) = c_funloc(mpm_stepper_set_linear_solver)
    all(59) = c_funloc(mpm_stepper_set_progress)
    all(60) = c_funloc(mpm_stable_dt)
    all(61) = c_funloc(mpm_step)
    all(62) = c_funloc(mpm_advance_desc_init)
    all(63) = c_funloc(mpm_advance)
    all(64) = c_funloc(mpm_stepper_profile)
    all(65) = c_funloc(mpm_stepper_info)
    all(66) = c_funloc(mpm_stepper_residuals)
    all(67) = c_funloc(mpm_step_begin)
    all(68) = c_funloc(mpm_step_grid)
    all(69) = c_funloc(mpm_step_end)
    all(70) = c_funloc(mpm_step_abort)
    all(71) = c_funloc(mpm_grid_map)
    all(72) = c_funloc(mpm_stepper_wall_reaction)
    all(73) = c_funloc(mpm_stepper_particles_reaction)
    all(74) = c_funloc(mpm_stepper_wall_impulse)
    all(75) = c_funloc(mpm_stepper_particles_impulse)
    all(76) = c_funloc(mpm_stepper_set_body)
    all(77) = c_funloc(mpm_stepper_body)
    all(78) = c_funloc(mpm_contact_desc_init)
    all(79) = c_funloc(mpm_stepper_set_contact)
    all(80) = c_funloc(mpm_stepper_set_friction)
    all(81) = c_funloc(mpm_stepper_contact_info)
    all(82) = c_funloc(mpm_obstacle_desc_init)
    all(83) = c_funloc(mpm_obstacle_create)
    all(84) = c_funloc(mpm_obstacle_destroy)
    all(85) = c_funloc(mpm_stepper_add_obstacle)
    all(86) = c_funloc(mpm_stepper_remove_obstacle)
    all(87) = c_funloc(mpm_obstacle_set_motion)
    all(88) = c_funloc(mpm_obstacle_set_contact)
    all(89) = c_funloc(mpm_obstacle_set_pose)
    all(90) = c_funloc(mpm_obstacle_get_pose)
    all(91) = c_funloc(mpm_obstacle_set_load)
    all(92) = c_funloc(mpm_obstacle_contact_info)
    all(93) = c_funloc(mpm_state_size)
    all(94) = c_funloc(mpm_state_save)
    all(95) = c_funloc(mpm_state_load)
    all(96) = c_funloc(mpm_state_save_file)
    all(97) = c_funloc(mpm_state_save_to)
    all(98) = c_funloc(mpm_state_load_file)
    all(99) = c_funloc(mpm_state_hash)
    all(100) = c_funloc(mpm_write_particles)
    all(101) = c_funloc(mpm_write_particles_to)
    all(102) = c_funloc(mpm_write_grid)
    all(103) = c_funloc(mpm_write_body_grid)
    all(104) = c_funloc(mpm_write_grid_to)
    all(105) = c_funloc(mpm_series_open)
    all(106) = c_funloc(mpm_series_append)
    all(107) = c_funloc(mpm_series_close)
    do k = 1, size(all)
      if (.not. c_associated(all(k))) error stop "a function is missing"
    end do
  end subroutine check_functions

end program layout
