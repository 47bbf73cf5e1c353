!> What a host in Fortran meets: a law of its own, views, copies, and failures with their sentences.
module host_callbacks
  use mpm
  implicit none
  !> The law's parameters: its user pointer.
  type :: spring
    real(c_double) :: stiffness, density
    integer :: calls = 0
  end type spring
contains
  !> A spring along x, by Cauchy stress.
  function spring_stress(user, batch) bind(c) result(answer)
    type(c_ptr), value :: user
    type(mpm_material_batch), intent(in) :: batch
    integer(c_int32_t) :: answer
    type(spring), pointer :: law
    real(c_double), pointer :: F(:, :), stress(:, :), speed(:)
    call c_f_pointer(user, law)
    call c_f_pointer(batch%F, F, [int(batch%ld), 9])
    call c_f_pointer(batch%stress_new, stress, [int(batch%ld), 6])
    call c_f_pointer(batch%wave_speed, speed, [batch%ld])
    law%calls = law%calls + 1
    stress = 0
    stress(:, 1) = law%stiffness * (F(:, 1) - 1)
    speed = sqrt(law%stiffness / law%density)
    answer = MPM_OK
  end function spring_stress

  !> Sets the flag of release_user.
  subroutine release(user) bind(c)
    type(c_ptr), value :: user
    type(spring), pointer :: law
    call c_f_pointer(user, law)
    law%calls = -1
  end subroutine release

  !> Power that grows with the id.
  function heat_up(user, batch, power) bind(c) result(answer)
    type(c_ptr), value :: user
    type(mpm_particle_batch), intent(in) :: batch
    real(c_double), intent(inout) :: power(*)
    integer(c_int32_t) :: answer
    integer(c_int64_t), pointer :: id(:)
    call c_f_pointer(batch%id, id, [batch%n])
    power(:batch%n) = 2 * id
    answer = merge(MPM_E_ARG, MPM_OK, c_associated(user))
  end function heat_up

  !> Refuses every step.
  function refuse(user, batch, add) bind(c) result(answer)
    type(c_ptr), value :: user
    type(mpm_particle_batch), intent(in) :: batch
    real(c_double), intent(inout) :: add(batch%ld, *)
    integer(c_int32_t) :: answer
    add(1, 1) = 0
    answer = merge(MPM_E_ARG, -7_c_int32_t, c_associated(user))
  end function refuse
end module host_callbacks

program host
  use mpm
  use mpm_texts
  use host_callbacks
  implicit none
  type(c_ptr) :: context, grid, material, set, stepper, name, none
  type(mpm_grid_desc) :: box
  type(mpm_material_desc) :: own
  type(mpm_stepper_desc) :: options
  type(mpm_advance_desc) :: run
  type(mpm_step_info) :: info
  type(mpm_view) :: view
  type(mpm_heat_desc) :: warm
  type(spring), target :: law
  type(mpm_parameters), target :: wrong
  type(mpm_names), target :: fields, packed
  real(c_float) :: floats(2, 20)
  real(c_double) :: low, high, start, warmth(20)
  real(c_double), allocatable :: x(:, :)
  real(c_double), pointer :: v(:)
  integer(c_int64_t) :: first, count
  integer(c_int64_t), parameter :: ids(2) = [7_c_int64_t, 3_c_int64_t]
  character(len=:), allocatable :: path

  call is("version", int(mpm_version()), int(MPM_VERSION_OF_MODULE))
  call is("context", mpm_context_create(out=context), MPM_OK)
  call mpm_init(box)
  call is("a box without cells", mpm_grid_create(context, box, none), MPM_E_ARG)
  call says("cells")
  box%dim = 1
  box%cells(1) = 20
  box%spacing(1) = 0.1d0
  call is("grid", mpm_grid_create(context, box, grid), MPM_OK)

  wrong = mpm_parameters([character(8) :: "E", "nu", "densitie"], [1d3, 0.3d0, 1d3])
  call is("a wrong name", mpm_material_create(context, "neo_hookean" // c_null_char, wrong%list(), wrong%size(), none), &
      MPM_E_NOT_FOUND)
  call says("densitie")
  call is("a parameter", mpm_material_model_param("j2" // c_null_char, 0, name, low=low, high=high), MPM_OK)
  call ensure("its name", mpm_text(name) == "E" .and. low >= 0 .and. high > low)

  law = spring(100d0, 1d0)
  call mpm_init(own)
  own%density = law%density
  own%stress = c_funloc(spring_stress)
  own%release_user = c_funloc(release)
  own%user = c_loc(law)
  call is("law", mpm_material_create_custom(context, own, material), MPM_OK)
  call is("set", mpm_particles_create(context, grid, material, set), MPM_OK)
  call is("fill", mpm_particles_fill_box(set, [0.5d0], [1.5d0], [2], first, count), MPM_OK)
  call ensure("twenty particles", first == 0 .and. count == 20 .and. mpm_particles_count(set) == 20)
  call is("two", mpm_particles_add(set, 2_c_int64_t, [0.25d0, 0.3d0], volume=[0.05d0, 0.05d0]), MPM_OK)
  call is("remove", mpm_particles_remove(set, 2_c_int64_t, [20_c_int64_t, 21_c_int64_t]), MPM_OK)

  call mpm_init(view)
  call is("map", mpm_particles_map(set, "velocity" // c_null_char, ior(MPM_READ, MPM_WRITE), view), MPM_OK)
  call c_f_pointer(view%data, v, [view%count])
  call is("stride", int(view%item_stride), 1)
  v = 0.1d0
  call is("release", mpm_view_release(view), MPM_OK)
  call ensure("released", .not. c_associated(view%data))
  allocate (x(20, 1))
  call is("get", mpm_particles_get(set, "velocity" // c_null_char, MPM_F64, 1, 20_c_int64_t, out=x), MPM_OK)
  call ensure("the velocity that was written", all(abs(x - 0.1d0) <= 0))
  deallocate (x)
  allocate (x(2, 1))
  packed = mpm_names([character(9) :: "position", "velocity"])
  call is("some", mpm_particles_get(set, "position" // c_null_char, MPM_F64, 1, 2_c_int64_t, ids, x), MPM_OK)
  call ensure("by id", abs(x(1, 1) - x(2, 1) - 0.2d0) < 1d-12)
  start = x(1, 1)
  call is("floats", mpm_particles_get_f32(set, 2, packed%pointers(), MPM_BY_ID, 20_c_int64_t, floats), MPM_OK)
  call ensure("as floats", all(abs(floats(:, ids + 1) - reshape([real(x(1, 1)), 0.1, real(x(2, 1)), 0.1], [2, 2])) < 1e-6))

  call mpm_init(options)
  call is("stepper", mpm_stepper_create(context, grid, options, stepper), MPM_OK)
  call is("add", mpm_stepper_add(stepper, set), MPM_OK)
  call mpm_init(run)
  run%t_end = 0.5d0
  call mpm_init(info)
  call is("advance", mpm_advance(stepper, run, info), MPM_OK)
  call ensure("the time", abs(info%t - 0.5d0) < 1d-12 .and. law%calls > 0)
  call is("get", mpm_particles_get(set, "position" // c_null_char, MPM_F64, 1, 2_c_int64_t, ids, x), MPM_OK)
  call ensure("the way", abs(x(1, 1) - start - 0.05d0) < 1d-9)

  call mpm_init(warm)
  warm%specific_heat = 2
  warm%source = c_funloc(heat_up)
  call is("heat", mpm_stepper_set_heat(stepper, set, warm), MPM_OK)
  call is("a warm step", mpm_step(stepper, 1d-3, info), MPM_OK)
  call is("temperature", mpm_particles_get(set, "temperature" // c_null_char, MPM_F64, 1, 20_c_int64_t, out=warmth), &
      MPM_OK)
  call ensure("what the source gave", abs(sum(warmth) - 0.190d0) < 1d-12 .and. warmth(20) > warmth(1))
  call is("no heat", mpm_stepper_set_heat(stepper, set), MPM_OK)

  call is("refusing", mpm_stepper_set_force(stepper, c_funloc(refuse), c_null_ptr), MPM_OK)
  call is("refused", mpm_step(stepper, 1d-3, info), MPM_E_CALLBACK)
  call is("the callback's own status", info%callback_status, -7)
  call ensure("a sentence", len(mpm_error(context)) > 0)
  call is("no force", mpm_stepper_set_force(stepper, c_null_funptr, c_null_ptr), MPM_OK)

  path = argument()
  fields = mpm_names([character(9) :: "velocity", "mass"])
  call is("a file", mpm_write_particles(set, path // c_null_char, fields%size(), fields%pointers()), MPM_OK)
  fields = mpm_names(["nonsense"])
  call is("no such field", mpm_write_particles(set, path // c_null_char, fields%size(), fields%pointers()), MPM_E_NOT_FOUND)
  call says("nonsense")

  call is("grid in use", mpm_grid_destroy(grid), MPM_E_STATE)
  call is("stepper", mpm_stepper_destroy(stepper), MPM_OK)
  call is("set", mpm_particles_destroy(set), MPM_OK)
  call is("law", mpm_material_destroy(material), MPM_OK)
  call is("the law was released", law%calls, -1)
  call is("grid", mpm_grid_destroy(grid), MPM_OK)
  call is("context", mpm_context_destroy(context), MPM_OK)
  print '(a)', "the host is content"

contains

  subroutine is(what, value, should)
    character(*), intent(in) :: what
    integer(c_int32_t), intent(in) :: value, should
    if (value == should) return
    print '(a, i0, a, i0)', what // ": ", value, ", not ", should
    print '(a)', mpm_error(context)
    error stop 1
  end subroutine is

  subroutine ensure(what, holds)
    character(*), intent(in) :: what
    logical, intent(in) :: holds
    if (holds) return
    print '(a)', what // " is wrong"
    error stop 1
  end subroutine ensure

  !> Sees that the last error names a word.
  subroutine says(word)
    character(*), intent(in) :: word
    call ensure("'" // word // "' in: " // mpm_error(context), index(mpm_error(context), word) > 0)
  end subroutine says

  function argument() result(text)
    character(:), allocatable :: text
    integer :: n
    call get_command_argument(1, length=n)
    allocate (character(n) :: text)
    call get_command_argument(1, text)
  end function argument

end program host
