# mpi.sh - what Open MPI's mpirun is told: it may run as root, and more ranks than there are processors, beside other work.
# SPDX-License-Identifier: MIT
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_rmaps_base_oversubscribe=1
