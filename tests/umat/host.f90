! A host in Fortran: a bar of soil in one dimension with its own UMAT, by an installation of the library.
module mpm
  use iso_c_binding
  implicit none
  type, bind(c) :: umat_desc
    integer(c_int32_t) :: struct_size, nstatv, nprops, dim, serial, kirchhoff, stran, differenced
    real(c_double) :: density
    type(c_ptr) :: props, statev_initial, cmname
    real(c_double) :: wave_modulus, celent, temperature
    type(c_funptr) :: message
    type(c_ptr) :: message_user
  end type
  type, bind(c) :: material_batch
    integer(c_int32_t) :: struct_size, state_count
    integer(c_int64_t) :: n, ld
    real(c_double) :: t, dt
    type(c_ptr) :: id, F, F_inc, L, stress, state, stress_new, state_new, wave_speed, viscosity, energy, position, lookup
  end type
  interface
    integer(c_int32_t) function mpm_context_create(desc, out) bind(c)
      import
      type(c_ptr), value :: desc
      type(c_ptr) :: out
    end function
    integer(c_int32_t) function mpm_context_destroy(context) bind(c)
      import
      type(c_ptr), value :: context
    end function
    integer(c_int32_t) function mpm_material_destroy(material) bind(c)
      import
      type(c_ptr), value :: material
    end function
    integer(c_int32_t) function mpm_umat_desc_init(desc, bytes) bind(c)
      import
      type(umat_desc) :: desc
      integer(c_int32_t), value :: bytes
    end function
    integer(c_int32_t) function mpm_umat_material(context, fn, desc, out) bind(c)
      import
      type(c_ptr), value :: context
      type(c_funptr), value :: fn
      type(umat_desc) :: desc
      type(c_ptr) :: out
    end function
    integer(c_int32_t) function mpm_material_update(material, batch, tangent, symmetric) bind(c)
      import
      type(c_ptr), value :: material, tangent, symmetric
      type(material_batch) :: batch
    end function
  end interface
end module

program host
  use mpm
  implicit none
  external umat_elastic
  type(c_ptr) :: context, material
  type(umat_desc) :: desc
  type(material_batch) :: batch
  real(c_double), target :: props(2) = [1d7, 0.25d0], F(9) = [1.01d0, 0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 0d0, 1d0], &
    stress(6) = 0, state(1) = 0
  real(c_double) :: wanted
  if (mpm_context_create(c_null_ptr, context) /= 0) error stop 'context'
  if (mpm_umat_desc_init(desc, int(c_sizeof(desc), c_int32_t)) /= 0) error stop 'desc'
  desc%density = 2d3
  desc%nprops = 2
  desc%props = c_loc(props)
  if (mpm_umat_material(context, c_funloc(umat_elastic), desc, material) /= 0) error stop 'material'
  batch = material_batch(int(c_sizeof(batch), c_int32_t), 1, 1, 1, 1d0, 1d0, c_null_ptr, c_loc(F), c_loc(F), c_null_ptr, &
    c_loc(stress), c_loc(state), c_loc(stress), c_loc(state), c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr)
  if (mpm_material_update(material, batch, c_null_ptr, c_null_ptr) /= 0) error stop 'update'
  wanted = 1.2d7 * log(1.01d0)
  if (abs(stress(1) - wanted) > 1d-6) error stop 'stress'
  print '(a,f10.2)', 'result: stress', stress(1)
  if (mpm_material_destroy(material) /= 0 .or. mpm_context_destroy(context) /= 0) error stop 'end'
end program
