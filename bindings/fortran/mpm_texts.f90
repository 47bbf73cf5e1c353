!> Texts between C and Fortran: what the interfaces of the module mpm leave to c_ptr.
module mpm_texts
  use mpm
  implicit none
  private
  public :: mpm_names, mpm_parameters, mpm_text, mpm_error

  !> Names for C, such as the fields that mpm_write_particles() is to write: pass %pointers() and %size(). A variable of
  !! the type is a target, and lives as long as the pointers are used.
  type :: mpm_names
    character(kind=c_char), allocatable, private :: letters(:)
    integer, allocatable, private :: first(:)
  contains
    procedure :: pointers => names_pointers
    procedure :: size => names_size
  end type mpm_names
  interface mpm_names
    module procedure names_make
  end interface mpm_names

  !> Parameters of a material by name: pass %list() and %size() to mpm_material_create(). A variable of the type is a
  !! target.
  type :: mpm_parameters
    type(mpm_names), private :: names
    real(c_double), allocatable, private :: values(:)
  contains
    procedure :: list => parameters_list
    procedure :: size => parameters_size
  end type mpm_parameters
  interface mpm_parameters
    module procedure parameters_make
  end interface mpm_parameters

  interface
    pure function c_length(text) bind(c, name="strlen")
      import
      type(c_ptr), value :: text
      integer(c_size_t) :: c_length
    end function c_length
  end interface

contains

  !> The text that a pointer of C leads to; empty for NULL.
  function mpm_text(pointer) result(text)
    type(c_ptr), intent(in) :: pointer
    character(:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    integer :: k, n
    n = 0
    if (c_associated(pointer)) n = int(c_length(pointer))
    allocate (character(n) :: text)
    if (n == 0) return
    call c_f_pointer(pointer, letters, [n])
    do k = 1, n
      text(k:k) = letters(k)
    end do
  end function mpm_text

  !> The sentence of mpm_last_error().
  function mpm_error(context) result(text)
    type(c_ptr), intent(in) :: context
    character(:), allocatable :: text
    text = mpm_text(mpm_last_error(context))
  end function mpm_error

  !> Takes the blanks off the ends of names and ends each as C wants it.
  function names_make(names) result(it)
    character(*), intent(in) :: names(:)
    type(mpm_names) :: it
    integer :: at, k, j
    allocate (it%letters(sum(len_trim(names) + 1)), it%first(size(names)))
    at = 1
    do k = 1, size(names)
      it%first(k) = at
      do j = 1, len_trim(names(k))
        it%letters(at) = names(k)(j:j)
        at = at + 1
      end do
      it%letters(at) = c_null_char
      at = at + 1
    end do
  end function names_make

  function names_pointers(it) result(pointers)
    class(mpm_names), intent(in), target :: it
    type(c_ptr) :: pointers(size(it%first))
    integer :: k
    do k = 1, size(it%first)
      pointers(k) = c_loc(it%letters(it%first(k)))
    end do
  end function names_pointers

  integer(c_int32_t) function names_size(it)
    class(mpm_names), intent(in) :: it
    names_size = size(it%first, kind=c_int32_t)
  end function names_size

  function parameters_make(names, values) result(it)
    character(*), intent(in) :: names(:)
    real(c_double), intent(in) :: values(:)
    type(mpm_parameters) :: it
    if (size(names) /= size(values)) error stop "mpm_parameters: there are not as many values as names"
    it%names = mpm_names(names)
    allocate (it%values(size(values)))
    it%values(:) = values
  end function parameters_make

  function parameters_list(it) result(list)
    class(mpm_parameters), intent(in), target :: it
    type(mpm_param) :: list(size(it%values))
    list%name = it%names%pointers()
    list%value = it%values
  end function parameters_list

  integer(c_int32_t) function parameters_size(it)
    class(mpm_parameters), intent(in) :: it
    parameters_size = size(it%values, kind=c_int32_t)
  end function parameters_size

end module mpm_texts
