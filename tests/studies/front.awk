# front.awk - of points "x y label", those that no other beats in both: the Pareto front, by growing x. What is equal in x
# and y is there once, the first that came.
# SPDX-License-Identifier: MIT
NF >= 3 && $1 > 0 && $2 > 0 {
    n++
    x[n] = $1 + 0
    y[n] = $2 + 0
    line[n] = $0
    order[n] = n
}
END {
    for (i = 2; i <= n; i++) { # by x, then y; equal ones in the order they came
        at = order[i]
        for (k = i - 1; k > 0 && (x[order[k]] > x[at] || (x[order[k]] == x[at] && y[order[k]] > y[at])); k--)
            order[k + 1] = order[k]
        order[k + 1] = at
    }
    for (i = 1; i <= n; i++)
        if (i == 1 || y[order[i]] < best) {
            best = y[order[i]]
            print line[order[i]]
        }
}
