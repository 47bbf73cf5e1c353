/* What parsers of mpm_mpi.h see of MPI where there is none: two types. No program is compiled with it. */
#ifndef MPI_FOR_PARSERS_H
#define MPI_FOR_PARSERS_H

typedef struct mpi_communicator *MPI_Comm;
typedef int MPI_Fint;

#endif
