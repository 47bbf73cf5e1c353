/* The modulus that bounds explicit steps. */
#ifndef MPMU_MODULUS_H
#define MPMU_MODULUS_H

/* Returns the largest modulus of uniaxial strain, in any direction, or of shear along the axes, of DDSDDE;
 * not a number, where a modulus is none. */
double mpmu_largest_modulus(const double *ddsdde);

#endif
