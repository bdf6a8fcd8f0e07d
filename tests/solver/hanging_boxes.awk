# hanging_boxes.awk - prints an OBJ file: awk -v N=3 -f hanging_boxes.awk >boxes.obj, with materials in boxes.mtl.
# A closed room 6 m wide with 4 N^2 boxes that hang in rows below a small lamp.
# SPDX-License-Identifier: MIT
function corner(x, y, z) { printf "v %g %g %g\n", x, y, z; return ++n }
function box(x, y, z, a, b, c, inside,    i, k) {
    k = n
    for (i = 0; i < 8; i++) corner(x + a * (i % 2), y + b * (int(i / 2) % 2), z + c * int(i / 4))
    split("1 3 4 2 5 6 8 7 1 2 6 5 3 7 8 4 1 5 7 3 2 4 8 6", at, " ")
    for (i = 0; i < 6; i++)
        faces = faces (inside ? sprintf("f %d %d %d %d\n", k + at[4*i+4], k + at[4*i+3], k + at[4*i+2], k + at[4*i+1]) \
                              : sprintf("f %d %d %d %d\n", k + at[4*i+1], k + at[4*i+2], k + at[4*i+3], k + at[4*i+4]))
}
BEGIN {
    box(0, 0, 0, 6, 6, 3, 1)
    for (i = 0; i < N; i++) for (j = 0; j < N; j++) for (l = 0; l < 4; l++)
        box(.3 + i * 5.4 / N, .3 + j * 5.4 / N, .3 + .6 * l, 2.6 / N, 2.6 / N, .3)
    k = n; corner(2.9, 2.9, 2.9); corner(2.9, 3.1, 2.9); corner(3.1, 3.1, 2.9); corner(3.1, 2.9, 2.9)
    printf "mtllib boxes.mtl\nusemtl wall\n%susemtl lamp\nf %d %d %d %d\n", faces, k + 1, k + 2, k + 3, k + 4
}
