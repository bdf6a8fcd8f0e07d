# mpi.sh - what Open MPI's mpirun is told: it may run as root, and more ranks than there are processors, beside other work.
# SPDX-License-Identifier: MIT
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_rmaps_base_oversubscribe=1

value() { # FILE.json KEY: of the outermost object
    sed -n "s/^  \"$2\": \(.*[^,]\),*$/\1/p" "$1" | head -n 1
}
# A B [SHARE]: all numbers of two tables, each but for this share of itself, or else for one in the last of the 12 digits that are
# printed. Tables without a row are not the same.
same_faces() {
    awk -F, -v share="${3:-0}" '
        function last(m) { return m > 0 ? exp(log(10) * (int(log(m) / log(10) + 1000) - 1000 - 11)) : 0 }
        NR == FNR { line[FNR] = $0; n = FNR; next }
        FNR > 1 { k = split(line[FNR], other, ","); if (k != NF) exit 1
                  for (i = 3; i <= NF; i++) { d = $i - other[i]; m = $i < 0 ? -$i : $i
                                              if (d < 0) d = -d
                                              if (d > (share > 0 ? share * m : 1.01 * last(m)) + 1e-300) exit bad = 1 } }
        END { exit bad || n < 2 || FNR != n }' "$1" "$2"
}
