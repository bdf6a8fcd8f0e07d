# cube_factors.awk - the view factors of a unit cube whose walls are N x N squares (walls.awk's cube_quads), by closed forms, as
# lines `i,j,F`: `awk -v N=8 -f cube_factors.awk`.
#
# Squares of side 1, walls N apart. Two in parallel planes: the second differences of a function of their offsets; two in planes
# that meet at a right angle: of one of the offset along the edge and the distances from it [Ehlert & Smith 1993]. Each case is
# computed once. Rows sum to 1 to the digits that are printed.
# SPDX-License-Identifier: MIT
function abs(x) { return x < 0 ? -x : x }
function weight(d) { return d ? -1 : 2 }
function parallel_part(u, v, p, q) {
    p = sqrt(u * u + N * N)
    q = sqrt(v * v + N * N)
    return v * p * atan2(v, p) + u * q * atan2(u, q) - N * N / 2 * log(u * u + v * v + N * N)
}
function parallel(u, v, i, k, sum) {
    if ((u, v) in facing) return facing[u, v]
    for (i = -1; i <= 1; i++)
        for (k = -1; k <= 1; k++) sum += weight(i) * weight(k) * parallel_part(u + i, v + k)
    return facing[u, v] = sum / TURN
}
function corner_part(d, s, t, c) {
    c = s * s + t * t
    return (c ? d * sqrt(c) * atan2(d, sqrt(c)) : 0) - (c + d * d ? (c - d * d) / 4 * log(c + d * d) : 0)
}
function perpendicular(d, s, t, i, k, l, sum) {
    if ((d, s, t) in meeting) return meeting[d, s, t]
    for (i = -1; i <= 1; i++)
        for (k = 0; k <= 1; k++)
            for (l = 0; l <= 1; l++) sum += weight(i) * (k == l ? 1 : -1) * corner_part(d + i, s + k, t + l)
    return meeting[d, s, t] = sum / TURN
}
BEGIN {
    TURN = 8 * atan2(1, 1)
    # of each wall of walls.awk its normal's axis, on which side, and the axes that i and k count
    split("3 3 1 1 2 2", normal, " ")
    split("0 1 0 1 0 1", side, " ")
    split("1 2 2 3 3 1", first, " ")
    split("2 1 3 2 1 3", second, " ")
    for (w = 1; w <= 6; w++)
        for (i = 0; i < N; i++)
            for (k = 0; k < N; k++) {
                f = ((w - 1) * N + i) * N + k
                wall[f] = w
                at[f, first[w]] = i
                at[f, second[w]] = k
            }
    for (f = 0; f < 6 * N * N; f++)
        for (g = 0; g < 6 * N * N; g++) {
            w = wall[f]
            v = wall[g]
            if (w == v) continue
            if (normal[w] == normal[v]) {
                F = parallel(abs(at[f, first[w]] - at[g, first[w]]), abs(at[f, second[w]] - at[g, second[w]]))
            } else {
                a = normal[w]
                b = normal[v]
                s = side[v] ? N - 1 - at[f, b] : at[f, b]
                t = side[w] ? N - 1 - at[g, a] : at[g, a]
                F = perpendicular(abs(at[f, 6 - a - b] - at[g, 6 - a - b]), s, t)
            }
            printf "%d,%d,%.12g\n", f, g, F
        }
}
