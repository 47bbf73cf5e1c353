!> Two elastic disks that collide under a force of the host: the scene that the example of every language makes, with
!! the same bits. It prints the number of particles, the time and the hash of the state.
module pulling
  use mpm
  implicit none
contains
  !> Bends the way of particles: the force is 0.05 x downwards per mass.
  function pull(user, batch, add) bind(c) result(answer)
    type(c_ptr), value :: user
    type(mpm_particle_batch), intent(in) :: batch
    real(c_double), intent(inout) :: add(batch%ld, *)
    integer(c_int32_t) :: answer
    real(c_double), pointer :: position(:, :), mass(:)
    integer(c_int64_t) :: i
    call c_f_pointer(batch%position, position, [int(batch%ld), int(batch%dim)])
    call c_f_pointer(batch%mass, mass, [batch%ld])
    do i = 1, batch%n
      add(i, 2) = add(i, 2) + mass(i) * (-0.05d0 * position(i, 1))
    end do
    answer = merge(MPM_E_ARG, MPM_OK, c_associated(user))
  end function pull
end module pulling

program example
  use mpm
  use mpm_texts
  use pulling
  implicit none
  type(c_ptr) :: context, grid, material, left, right, stepper
  type(mpm_context_desc) :: services
  type(mpm_grid_desc) :: box
  type(mpm_stepper_desc) :: options
  type(mpm_step_info) :: info
  type(mpm_parameters), target :: jelly
  integer(c_int64_t) :: hash
  integer :: step
  character(16) :: digits

  call mpm_init(services)
  services%isa = MPM_ISA_PORTABLE
  services%concurrency = 2
  services%serial_callbacks = 1
  if (mpm_context_create(services, context) /= MPM_OK) error stop "no context"

  call mpm_init(box)
  box%dim = 2
  box%cells(:2) = 40
  box%spacing(:2) = 0.025d0
  call check(mpm_grid_create(context, box, grid))
  jelly = mpm_parameters([character(7) :: "E", "nu", "density"], [1d3, 0.3d0, 1d3])
  call check(mpm_material_create(context, "neo_hookean" // c_null_char, jelly%list(), jelly%size(), material))
  left = disk(0.2d0, 0.5d0)
  right = disk(0.8d0, -0.5d0)
  call mpm_init(options)
  options%scheme = MPM_MUSL
  options%projected_positions = 1
  call check(mpm_stepper_create(context, grid, options, stepper))
  call check(mpm_stepper_add(stepper, left))
  call check(mpm_stepper_add(stepper, right))
  call check(mpm_stepper_set_force(stepper, c_funloc(pull), c_null_ptr))
  do step = 1, 400
    call check(mpm_step(stepper, 2d-3))
  end do

  call mpm_init(info)
  call check(mpm_stepper_info(stepper, info))
  call check(mpm_state_hash(stepper, hash))
  write (digits, '(z16.16)') hash
  print '(a, i0)', "particles ", mpm_particles_count(left) + mpm_particles_count(right)
  print '(a, f8.6)', "time ", info%t
  print '(a)', "hash " // small(digits)

  call check(mpm_stepper_destroy(stepper))
  call check(mpm_particles_destroy(left))
  call check(mpm_particles_destroy(right))
  call check(mpm_material_destroy(material))
  call check(mpm_grid_destroy(grid))
  call check(mpm_context_destroy(context))

contains

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status
    if (status == MPM_OK) return
    print '(a)', mpm_error(context)
    error stop 1
  end subroutine check

  function disk(centre, velocity) result(set)
    real(c_double), intent(in) :: centre, velocity
    type(c_ptr) :: set
    call check(mpm_particles_create(context, grid, material, set))
    call check(mpm_particles_fill_ball(set, [centre, centre], 0.15d0, [2, 2]))
    call check(mpm_particles_set_all(set, "velocity" // c_null_char, MPM_F64, 2, [velocity, velocity]))
  end function disk

  !> Hexadecimal digits in small letters.
  function small(text) result(answer)
    character(*), intent(in) :: text
    character(len(text)) :: answer
    integer :: k
    do k = 1, len(text)
      answer(k:k) = text(k:k)
      if (text(k:k) >= "A") answer(k:k) = achar(iachar(text(k:k)) + 32)
    end do
  end function small

end program example
