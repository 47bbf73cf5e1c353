! A clay that yields without drainage, as a UMAT: von Mises, perfectly plastic, in plane strain of shear strength
! c = PROPS(3) + PROPS(4) depth, where the depth is that of the particle below the surface at y = PROPS(5).
! PROPS(1:2) are Young's modulus and Poisson's ratio; STATEV(1) is the equivalent plastic strain.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
    dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, &
    noel, npt, layer, kspt, kstep, kinc)
  implicit none
  character(len=80) :: cmname
  integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc
  double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), &
    drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), &
    props(nprops), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3)
  double precision :: shear, bulk, strength, mean, q, keep, flow(6)
  integer :: i, j

  shear = props(1) / (2 * (1 + props(2)))
  bulk = props(1) / (3 * (1 - 2 * props(2)))
  strength = sqrt(3d0) * (props(3) + props(4) * max(props(5) - coords(2), 0d0))

  ! the elastic stiffness, and the stress if nothing yields
  ddsdde = 0
  ddsdde(1:3, 1:3) = bulk - 2 * shear / 3
  do i = 1, 3
    ddsdde(i, i) = bulk + 4 * shear / 3
    ddsdde(i + 3, i + 3) = shear
  end do
  stress = stress + matmul(ddsdde, dstran)
  mean = sum(stress(1:3)) / 3
  flow = stress
  flow(1:3) = flow(1:3) - mean
  q = sqrt(1.5d0 * (sum(flow(1:3)**2) + 2 * sum(flow(4:6)**2)))
  if (q <= strength) return

  ! back to the surface, along the deviator; the stiffness is that of this return
  keep = strength / q
  stress = keep * flow
  stress(1:3) = stress(1:3) + mean
  statev(1) = statev(1) + (q - strength) / (3 * shear)
  flow = flow / q
  ddsdde = keep * ddsdde
  ddsdde(1:3, 1:3) = ddsdde(1:3, 1:3) + (1 - keep) * bulk
  do j = 1, 6
    do i = 1, 6
      ddsdde(i, j) = ddsdde(i, j) - keep * 3 * shear * flow(i) * flow(j)
    end do
  end do
end subroutine
