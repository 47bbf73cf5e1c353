! UMATs of the tests, as their users write them: everything by reference, everything in Cauchy stress.

! Isotropic elasticity; PROPS: E, nu.
subroutine umat_elastic(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
    temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, &
    dfgrd1, noel, npt, layer, kspt, kstep, kinc)
  implicit none
  character(len=80) cmname
  integer ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, i
  double precision stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), &
    drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
    drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), lambda, mu
  mu = props(1) / (2 * (1 + props(2)))
  lambda = 2 * mu * props(2) / (1 - 2 * props(2))
  ddsdde = 0
  ddsdde(1:ndi, 1:ndi) = lambda
  do i = 1, ndi
    ddsdde(i, i) = lambda + 2 * mu
  end do
  do i = ndi + 1, ntens
    ddsdde(i, i) = mu
  end do
  stress = stress + matmul(ddsdde, dstran)
end subroutine

! Von Mises with linear isotropic hardening; PROPS: E, nu, yield stress, hardening. STATEV(1) is the plastic strain.
subroutine umat_j2(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
    dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, &
    noel, npt, layer, kspt, kstep, kinc)
  implicit none
  character(len=80) cmname
  integer ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, i, j
  double precision stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), &
    drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
    drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), mu, lambda, bulk, hardening, mean, q, over, more, keep, bend, &
    n(6)
  mu = props(1) / (2 * (1 + props(2)))
  lambda = 2 * mu * props(2) / (1 - 2 * props(2))
  bulk = lambda + 2 * mu / 3
  hardening = props(4)
  mean = sum(dstran(1:ndi))
  do i = 1, ndi
    stress(i) = stress(i) + lambda * mean + 2 * mu * dstran(i)
  end do
  do i = ndi + 1, ntens
    stress(i) = stress(i) + mu * dstran(i)
  end do
  mean = sum(stress(1:3)) / 3
  n = stress
  n(1:3) = n(1:3) - mean
  q = sqrt(1.5d0 * (sum(n(1:3)**2) + 2 * sum(n(4:6)**2)))
  over = q - props(3) - hardening * statev(1)
  keep = 1
  bend = 0
  if (over > 0) then
    more = over / (3 * mu + hardening)
    statev(1) = statev(1) + more
    keep = 1 - 3 * mu * more / q
    bend = 9 * mu**2 * (1 / (3 * mu + hardening) - more / q)
    stress = keep * n
    stress(1:3) = stress(1:3) + mean
    n = n / q
  end if
  ddsdde = 0
  ddsdde(1:3, 1:3) = bulk - 2 * mu * keep / 3
  do i = 1, 3
    ddsdde(i, i) = ddsdde(i, i) + 2 * mu * keep
    ddsdde(i + 3, i + 3) = mu * keep
  end do
  do j = 1, 6
    do i = 1, 6
      ddsdde(i, j) = ddsdde(i, j) - bend * n(i) * n(j)
    end do
  end do
end subroutine

! Von Mises with linear kinematic hardening (Prager); PROPS: E, nu, yield stress, modulus. STATEV(1:6) is the back
! stress, a tensor that the UMAT turns itself.
subroutine umat_kinematic(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
    temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, &
    dfgrd1, noel, npt, layer, kspt, kstep, kinc)
  implicit none
  character(len=80) cmname
  integer ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, i
  double precision stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), &
    drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
    drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), mu, lambda, mean, q, more, n(6), back(6)
  mu = props(1) / (2 * (1 + props(2)))
  lambda = 2 * mu * props(2) / (1 - 2 * props(2))
  call rotsig(statev, drot, back, 1, ndi, nshr)
  ddsdde = 0
  ddsdde(1:3, 1:3) = lambda
  do i = 1, 3
    ddsdde(i, i) = lambda + 2 * mu
    ddsdde(i + 3, i + 3) = mu
  end do
  stress = stress + matmul(ddsdde, dstran)
  mean = sum(stress(1:3)) / 3
  n = stress - back
  n(1:3) = n(1:3) - mean
  q = sqrt(1.5d0 * (sum(n(1:3)**2) + 2 * sum(n(4:6)**2)))
  if (q > props(3)) then
    more = (q - props(3)) / (3 * mu + props(4))
    n = n / q
    stress = stress - 3 * mu * more * n
    back = back + props(4) * more * n
  end if
  statev(1:6) = back
end subroutine

! Drucker-Prager in Cauchy stress without hardening, with the return to the cone and to its apex. PROPS: E, nu, M, M of
! the plastic potential, k; yield at q = M p + k. STATEV(1) is the plastic shear strain.
subroutine umat_drucker_prager(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, &
    dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, &
    dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc)
  implicit none
  character(len=80) cmname
  integer ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, i, j
  double precision stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), &
    drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
    drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), mu, bulk, p, q, n(6), m, mpsi, k, a, f, more, keep, flow(6), &
    normal(6)
  mu = props(1) / (2 * (1 + props(2)))
  bulk = props(1) / (3 * (1 - 2 * props(2)))
  m = props(3)
  mpsi = props(4)
  k = props(5)
  ddsdde = 0
  ddsdde(1:3, 1:3) = bulk - 2 * mu / 3
  do i = 1, 3
    ddsdde(i, i) = bulk + 4 * mu / 3
    ddsdde(i + 3, i + 3) = mu
  end do
  stress = stress + matmul(ddsdde, dstran)
  p = -sum(stress(1:3)) / 3
  n = stress
  n(1:3) = n(1:3) + p
  q = sqrt(1.5d0 * (sum(n(1:3)**2) + 2 * sum(n(4:6)**2)))
  f = q - m * p - k
  if (f <= 0) return
  a = 3 * mu + bulk * m * mpsi
  more = f / a
  if (q - 3 * mu * more >= 0) then
    keep = 1 - 3 * mu * more / q
    stress = keep * n
    stress(1:3) = stress(1:3) - p - bulk * mpsi * more
    statev(1) = statev(1) + more
    n = n / q
    flow = 3 * mu * n
    flow(1:3) = flow(1:3) + bulk * mpsi
    normal = 3 * mu * n
    normal(1:3) = normal(1:3) + bulk * m
    ddsdde = keep * ddsdde
    ddsdde(1:3, 1:3) = ddsdde(1:3, 1:3) + (1 - keep) * bulk
    do j = 1, 6
      do i = 1, 6
        ddsdde(i, j) = ddsdde(i, j) - flow(i) * normal(j) / a + (1 - keep) * 3 * mu * n(i) * n(j)
      end do
    end do
  else
    stress = 0
    stress(1:3) = k / m
    statev(1) = statev(1) + q / (3 * mu)
    ddsdde = 0
  end if
end subroutine

! Elastic, with a count of its calls in COMMON that it reads, waits and writes back: two calls at once lose some, and
! STATEV(1) says so where another call has written to what is saved.
subroutine umat_common(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
    temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, &
    dfgrd1, noel, npt, layer, kspt, kstep, kinc)
  implicit none
  character(len=80) cmname
  integer ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, i, calls, before
  double precision stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), &
    drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
    drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), waited
  common /kcount/ calls
  double precision, volatile, save :: shared
  before = calls
  shared = dstran(1)
  waited = 0
  do i = 1, 100
    waited = waited + sqrt(dble(i) + shared**2)
  end do
  if (waited < 0 .or. shared /= dstran(1)) statev(1) = statev(1) + 1
  calls = before + 1
  call umat_elastic(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
    dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, &
    noel, npt, layer, kspt, kstep, kinc)
end subroutine

function calls_of_common(reset) bind(c)
  use iso_c_binding
  integer(c_int) calls_of_common
  integer(c_int), value :: reset
  integer calls
  common /kcount/ calls
  calls_of_common = calls
  if (reset /= 0) calls = 0
end function

! Elastic, but for the element NINT(PROPS(4)), where it does what PROPS(3) says from TIME(2) >= PROPS(5) on:
! 1 asks for half of the step, 2 gives a stress that is not a number, 3 a state that is not one, 4 calls XIT, 5 says
! so by STDB_ABQERR first, 6 gives a DDSDDE that is not a number.
subroutine umat_moody(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
    temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, &
    dfgrd1, noel, npt, layer, kspt, kstep, kinc)
  use, intrinsic :: ieee_arithmetic
  implicit none
  character(len=80) cmname
  integer ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc
  double precision stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), &
    drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), &
    drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3), nan
  character(len=8) words(1)
  call umat_elastic(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
    dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, &
    noel, npt, layer, kspt, kstep, kinc)
  if (noel /= nint(props(4)) .or. time(2) < props(5)) return
  nan = ieee_value(nan, ieee_quiet_nan)
  select case (nint(props(3)))
  case (1)
    pnewdt = 0.5d0
  case (2)
    stress(4) = nan
  case (3)
    statev(1) = nan
  case (4)
    call xit
  case (5)
    words(1) = 'SOIL'
    call stdb_abqerr(-3, 'element %I of %S at %R', [noel], [0.25d0], words)
  case (6)
    ddsdde(2, 2) = nan
  end select
end subroutine
