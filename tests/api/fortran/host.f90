! A Fortran host whose own code is compiled to die of an invalid operation, a division by zero or an overflow. It steps
! explicitly and implicitly, with a callback in Fortran, and finds its traps and its rounding as they were.
module callbacks
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use, intrinsic :: ieee_exceptions
  implicit none
  logical :: halted = .false., called = .false.
contains
  integer(c_int32_t) function force(user, batch, add) bind(c)
    type(c_ptr), value :: user, batch, add
    logical :: halting(3)
    call ieee_get_halting_mode(ieee_usual, halting)
    halted = halted .or. any(halting)
    called = .true.
    force = 0
  end function
end module

program host
  use callbacks
  implicit none
  interface
    integer(c_int32_t) function scene_open(dim, scheme, force, context, stepper) bind(c)
      import
      integer(c_int32_t), value :: dim, scheme
      type(c_funptr), value :: force
      type(c_ptr) :: context, stepper
    end function
    integer(c_int32_t) function mpm_step(stepper, dt, info) bind(c)
      import
      type(c_ptr), value :: stepper, info
      real(c_double), value :: dt
    end function
    integer(c_int32_t) function mpm_state_hash(stepper, hash) bind(c)
      import
      type(c_ptr), value :: stepper
      integer(c_int64_t) :: hash
    end function
  end interface
  integer(c_int32_t), parameter :: schemes(4) = [1, 2, 3, 16]
  integer(c_int64_t) :: hash, wanted
  integer(c_int32_t) :: status
  integer :: dim, s, step, again
  logical :: halting(3)
  type(ieee_round_type) :: rounding
  type(c_ptr) :: context, stepper

  do dim = 1, 3
    do s = 1, 4
      do again = 1, 2
        status = scene_open(int(dim, c_int32_t), schemes(s), c_funloc(force), context, stepper)
        if (again == 2) call ieee_set_rounding_mode(ieee_up)
        do step = 1, 6
          if (status == 0) status = mpm_step(stepper, 1e-4_c_double, c_null_ptr)
        end do
        if (status == 0) status = mpm_state_hash(stepper, hash)
        call ieee_get_rounding_mode(rounding)
        call ieee_set_rounding_mode(ieee_nearest)
        if (status /= 0) stop 'a call failed'
        if (again == 1) wanted = hash
        if (hash /= wanted) stop 'the hash depends on the rounding'
        if (again == 2 .and. rounding /= ieee_up) stop 'the rounding has changed'
        call ieee_get_halting_mode(ieee_usual, halting)
        if (.not. all(halting)) stop 'the traps are gone'
      end do
    end do
  end do
  if (.not. called .or. halted) stop 'callbacks must find no traps'
  print '(a)', 'no exception was raised'
end program
