# mpi.sh - what Open MPI's mpirun is told: it may run as root, and more ranks than there are processors, beside other work.
# SPDX-License-Identifier: MIT
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_rmaps_base_oversubscribe=1

same_faces() { # A B: all numbers of two tables, but for one in the last of the 12 digits that are printed
    awk -F, 'function last(m) { return m > 0 ? exp(log(10) * (int(log(m) / log(10) + 1000) - 1000 - 11)) : 0 }
             NR == FNR { line[FNR] = $0; n = FNR; next }
             FNR > 1 { k = split(line[FNR], other, ","); if (k != NF) exit 1
                       for (i = 3; i <= NF; i++) { d = $i - other[i]; m = $i < 0 ? -$i : $i
                                                   if (d < 0) d = -d; if (d > 1.01 * last(m) + 1e-300) exit 1 } }
             END { exit FNR != n }' "$1" "$2"
}
