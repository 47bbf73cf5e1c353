!> What calls and callbacks cost from Fortran: the scene of costs.c.
module functions
  use mpm
  implicit none
  real(c_double), parameter :: mu = 1d3 / 2.6d0, lambda = 300 / (1.3d0 * 0.4d0)
contains
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

  function neo_hookean(user, batch) bind(c) result(answer)
    type(c_ptr), value :: user
    type(mpm_material_batch), intent(in) :: batch
    integer(c_int32_t) :: answer
    real(c_double), pointer :: F(:, :), stress(:, :), speed(:)
    real(c_double) :: J, s, pressure
    integer(c_int64_t) :: p
    integer :: c
    integer, parameter :: row(6) = [0, 3, 6, 0, 3, 0], column(6) = [0, 3, 6, 3, 6, 6]
    call c_f_pointer(batch%F, F, [int(batch%ld), 9])
    call c_f_pointer(batch%stress_new, stress, [int(batch%ld), 6])
    call c_f_pointer(batch%wave_speed, speed, [batch%ld])
    do p = 1, batch%n
      J = (F(p, 1) * F(p, 5) - F(p, 2) * F(p, 4)) * F(p, 9)
      pressure = lambda * log(J) - mu
      do c = 1, 6
        s = mu * (F(p, row(c) + 1) * F(p, column(c) + 1) + F(p, row(c) + 2) * F(p, column(c) + 2) &
            + F(p, row(c) + 3) * F(p, column(c) + 3))
        if (c <= 3) s = s + pressure
        stress(p, c) = s / J
      end do
      speed(p) = 1.16d0
    end do
    answer = merge(MPM_E_ARG, MPM_OK, c_associated(user))
  end function neo_hookean
end module functions

program costs
  use mpm
  use mpm_texts
  use functions
  implicit none
  type(c_ptr) :: steppers(3), sets(3)
  type(mpm_view) :: view
  real(c_double) :: best(5), start
  integer(c_int64_t) :: total
  integer :: k, i, turn

  do k = 1, 3
    call make(k)
  end do
  best = 1
  total = 0
  do k = 1, 200
    start = now()
    do i = 1, 1000
      total = total + mpm_particles_count(sets(1))
    end do
    best(4) = min(best(4), (now() - start) / 1000)
    start = now()
    do i = 1, 100
      call mpm_init(view)
      if (mpm_particles_map(sets(1), "position" // c_null_char, MPM_READ, view) /= MPM_OK) error stop "no view"
      if (mpm_view_release(view) /= MPM_OK) error stop "no end"
    end do
    best(5) = min(best(5), (now() - start) / 100)
  end do
  do turn = 1, 40
    do k = 1, 3
      do i = 1, 5
        start = now()
        if (mpm_step(steppers(k), 1d-4) /= MPM_OK) error stop "no step"
        best(k) = min(best(k), now() - start)
      end do
    end do
  end do
  if (total /= 200000 * mpm_particles_count(sets(1))) error stop "another number"
  print '(i0, a, f0.1, a, f0.0, a, f0.0, a, sp, f0.0, a, f0.0, a)', mpm_particles_count(sets(1)), " particles: count ", &
      1d9 * best(4), " ns, view ", 1d9 * best(5), " ns, step ", 1d6 * best(1), " us, force ", 1d6 * (best(2) - best(1)), &
      " us, law ", 1d6 * (best(3) - best(1)), " us"

contains

  function now() result(seconds)
    real(c_double) :: seconds
    integer(c_int64_t) :: ticks, rate
    call system_clock(ticks, rate)
    seconds = real(ticks, c_double) / real(rate, c_double)
  end function now

  subroutine make(kind)
    integer, intent(in) :: kind
    type(c_ptr) :: context, grid, material
    type(mpm_grid_desc) :: box
    type(mpm_material_desc) :: own
    type(mpm_stepper_desc) :: options
    type(mpm_parameters), target :: jelly
    integer :: step
    if (mpm_context_create(out=context) /= MPM_OK) error stop "no context"
    call mpm_init(box)
    box%dim = 2
    box%cells(:2) = 200
    box%spacing(:2) = 1d0 / 200
    call check(context, mpm_grid_create(context, box, grid))
    if (kind == 3) then
      call mpm_init(own)
      own%density = 1d3
      own%stress = c_funloc(neo_hookean)
      call check(context, mpm_material_create_custom(context, own, material))
    else
      jelly = mpm_parameters([character(7) :: "E", "nu", "density"], [1d3, 0.3d0, 1d3])
      call check(context, mpm_material_create(context, "neo_hookean" // c_null_char, jelly%list(), jelly%size(), material))
    end if
    call check(context, mpm_particles_create(context, grid, material, sets(kind)))
    call check(context, mpm_particles_fill_box(sets(kind), [0.1d0, 0.1d0], [0.45d0, 0.45d0], [2, 2]))
    call mpm_init(options)
    options%transfer = MPM_APIC_MLS
    call check(context, mpm_stepper_create(context, grid, options, steppers(kind)))
    call check(context, mpm_stepper_add(steppers(kind), sets(kind)))
    if (kind == 2) call check(context, mpm_stepper_set_force(steppers(kind), c_funloc(pull), c_null_ptr))
    do step = 1, 20
      call check(context, mpm_step(steppers(kind), 1d-4))
    end do
  end subroutine make

  subroutine check(context, status)
    type(c_ptr), intent(in) :: context
    integer(c_int32_t), intent(in) :: status
    if (status == MPM_OK) return
    print '(a)', mpm_error(context)
    error stop 1
  end subroutine check

end program costs
