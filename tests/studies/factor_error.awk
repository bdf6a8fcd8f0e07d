# factor_error.awk - how far a matrix of view factors is off, rows in order at standard input as lines `i,j,F`, from 0:
#
#     awk -v ROWS=384 [-v REFERENCE=right.coo [-v GROUP=2]] -f factor_error.awk <matrix.coo
#
# Prints names and values: row_mean, row_largest, of |1 - sum|; with a REFERENCE entry_mean, the sum of |F - R| over all entries in
# parts of the sum of R, and entry_largest |F - R|. GROUP: so many faces in a row, of equal areas, are one of the reference's. Rows
# count alike in entry_mean.
# SPDX-License-Identifier: MIT
function abs(x) { return x < 0 ? -x : x }
# Adds the entries of row i to sum[], in the reference's columns; `left` waits for its row.
function read_row(i, part) {
    while (more) {
        split(left, part, ",")
        if (part[1] + 0 != i) return
        row += part[3]
        sum[int(part[2] / GROUP)] += part[3] / GROUP
        more = (getline left) > 0
    }
}
function read_reference(i, part) {
    while (more_right) {
        split(right, part, ",")
        if (part[1] + 0 != i) return
        sum[part[2] + 0] -= part[3]
        total += part[3]
        more_right = (getline right <REFERENCE) > 0
    }
}
BEGIN {
    if (!GROUP) GROUP = 1
    more = (getline left) > 0
    if (REFERENCE != "") {
        more_right = (getline right <REFERENCE) > 0
        if (!more_right) { print "factor_error.awk: error: no reference in " REFERENCE >"/dev/stderr"; exit 1 }
    }
    for (i = 0; i < ROWS; i++) {
        row = 0
        read_row(i)
        defect = abs(1 - row)
        mean += defect / ROWS
        if (defect > largest) largest = defect
        if (i % GROUP != GROUP - 1) continue
        if (REFERENCE != "") {
            read_reference((i + 1) / GROUP - 1)
            for (j in sum) {
                off = abs(sum[j])
                all += off
                if (off > most) most = off
            }
        }
        split("", sum)
    }
    if (more) { print "factor_error.awk: error: rows are not in order, or there are more than " ROWS >"/dev/stderr"; exit 1 }
    printf "row_mean %.3g\nrow_largest %.3g\n", mean, largest
    if (REFERENCE != "") printf "entry_mean %.3g\nentry_largest %.3g\n", all / total, most
}
