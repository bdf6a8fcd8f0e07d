# box.awk - a box as six faces of an OBJ file, for programs that come behind it: awk -f box.awk -f hanging_boxes.awk.
# SPDX-License-Identifier: MIT
function corner(x, y, z) { printf "v %g %g %g\n", x, y, z; return ++corners }
# The corner (x, y, z) and sides a, b, c; inside: its faces look there.
function box(x, y, z, a, b, c, inside,    at, i, k) {
    k = corners
    for (i = 0; i < 8; i++) corner(x + a * (i % 2), y + b * (int(i / 2) % 2), z + c * int(i / 4))
    split("1 3 4 2 5 6 8 7 1 2 6 5 3 7 8 4 1 5 7 3 2 4 8 6", at, " ")
    for (i = 0; i < 24; i += 4)
        print "f", k + at[i+(inside ? 4 : 1)], k + at[i+(inside ? 3 : 2)], k + at[i+(inside ? 2 : 3)], k + at[i+(inside ? 1 : 4)]
}
