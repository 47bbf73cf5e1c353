! VUMATs of the tests, in double precision.

! Von Mises with linear isotropic hardening; PROPS: E, nu, yield stress, hardening. The state is the plastic strain. At
! stepTime = 0 it is elastic, as Abaqus wants it.
subroutine vumat_j2(nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, steptime, totaltime, dt, cmname, coordmp, &
    charlength, props, density, straininc, relspininc, tempold, stretchold, defgradold, fieldold, stressold, stateold, &
    enerinternold, enerinelasold, tempnew, stretchnew, defgradnew, fieldnew, stressnew, statenew, enerinternnew, &
    enerinelasnew)
  implicit none
  integer nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, k
  double precision steptime, totaltime, dt, coordmp(nblock, *), charlength(nblock), props(nprops), density(nblock), &
    straininc(nblock, ndir + nshr), relspininc(nblock, nshr), tempold(nblock), stretchold(nblock, ndir + nshr), &
    defgradold(nblock, ndir + 2 * nshr), fieldold(nblock, *), stressold(nblock, ndir + nshr), &
    stateold(nblock, nstatev), enerinternold(nblock), enerinelasold(nblock), tempnew(nblock), &
    stretchnew(nblock, ndir + nshr), defgradnew(nblock, ndir + 2 * nshr), fieldnew(nblock, *), &
    stressnew(nblock, ndir + nshr), statenew(nblock, nstatev), enerinternnew(nblock), enerinelasnew(nblock)
  character(len=80) cmname
  double precision mu, lambda, mean, q, more, s(6)
  mu = props(1) / (2 * (1 + props(2)))
  lambda = 2 * mu * props(2) / (1 - 2 * props(2))
  do k = 1, nblock
    mean = sum(straininc(k, 1:3))
    s = stressold(k, :) + 2 * mu * straininc(k, :)
    s(1:3) = s(1:3) + lambda * mean
    mean = sum(s(1:3)) / 3
    stressnew(k, :) = s
    s(1:3) = s(1:3) - mean
    q = sqrt(1.5d0 * (sum(s(1:3)**2) + 2 * sum(s(4:6)**2)))
    statenew(k, 1) = stateold(k, 1)
    if (steptime > 0 .and. q > props(3) + props(4) * stateold(k, 1)) then
      more = (q - props(3) - props(4) * stateold(k, 1)) / (3 * mu + props(4))
      statenew(k, 1) = stateold(k, 1) + more
      stressnew(k, :) = (1 - 3 * mu * more / q) * s
      stressnew(k, 1:3) = stressnew(k, 1:3) + mean
    end if
  end do
end subroutine

! Neo-Hookean by stretchNew: s = (lambda ln J 1 + mu (U U - 1)) / J as the observer sees it who turns with R; PROPS: E,
! nu. It calls XPLB_EXIT once J is beyond PROPS(3).
subroutine vumat_neo_hookean(nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, steptime, totaltime, dt, cmname, &
    coordmp, charlength, props, density, straininc, relspininc, tempold, stretchold, defgradold, fieldold, stressold, &
    stateold, enerinternold, enerinelasold, tempnew, stretchnew, defgradnew, fieldnew, stressnew, statenew, &
    enerinternnew, enerinelasnew)
  implicit none
  integer nblock, ndir, nshr, nstatev, nfieldv, nprops, lanneal, k
  double precision steptime, totaltime, dt, coordmp(nblock, *), charlength(nblock), props(nprops), density(nblock), &
    straininc(nblock, ndir + nshr), relspininc(nblock, nshr), tempold(nblock), stretchold(nblock, ndir + nshr), &
    defgradold(nblock, ndir + 2 * nshr), fieldold(nblock, *), stressold(nblock, ndir + nshr), &
    stateold(nblock, nstatev), enerinternold(nblock), enerinelasold(nblock), tempnew(nblock), &
    stretchnew(nblock, ndir + nshr), defgradnew(nblock, ndir + 2 * nshr), fieldnew(nblock, *), &
    stressnew(nblock, ndir + nshr), statenew(nblock, nstatev), enerinternnew(nblock), enerinelasnew(nblock)
  character(len=80) cmname
  double precision mu, lambda, j, u(3, 3), b(3, 3)
  mu = props(1) / (2 * (1 + props(2)))
  lambda = 2 * mu * props(2) / (1 - 2 * props(2))
  do k = 1, nblock
    u(1, :) = [stretchnew(k, 1), stretchnew(k, 4), stretchnew(k, 6)]
    u(2, :) = [stretchnew(k, 4), stretchnew(k, 2), stretchnew(k, 5)]
    u(3, :) = [stretchnew(k, 6), stretchnew(k, 5), stretchnew(k, 3)]
    j = u(1, 1) * (u(2, 2) * u(3, 3) - u(2, 3)**2) - u(1, 2) * (u(1, 2) * u(3, 3) - u(2, 3) * u(1, 3)) &
      + u(1, 3) * (u(1, 2) * u(2, 3) - u(2, 2) * u(1, 3))
    if (j > props(3)) call xplb_exit
    b = matmul(u, u)
    stressnew(k, 1:3) = lambda * log(j) + mu * ([b(1, 1), b(2, 2), b(3, 3)] - 1)
    stressnew(k, 4:6) = mu * [b(1, 2), b(2, 3), b(1, 3)]
    stressnew(k, :) = stressnew(k, :) / j
  end do
end subroutine
