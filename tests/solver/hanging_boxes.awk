# hanging_boxes.awk - prints an OBJ file: awk -v N=3 -f box.awk -f hanging_boxes.awk >boxes.obj, with materials in boxes.mtl.
# A closed room 6 m wide with 4 N^2 boxes that hang in rows below a small lamp.
# SPDX-License-Identifier: MIT
BEGIN {
    print "mtllib boxes.mtl\nusemtl wall"
    box(0, 0, 0, 6, 6, 3, 1)
    for (i = 0; i < N; i++) for (j = 0; j < N; j++) for (l = 0; l < 4; l++)
        box(.3 + i * 5.4 / N, .3 + j * 5.4 / N, .3 + .6 * l, 2.6 / N, 2.6 / N, .3)
    k = corners; corner(2.9, 2.9, 2.9); corner(2.9, 3.1, 2.9); corner(3.1, 3.1, 2.9); corner(3.1, 2.9, 2.9)
    printf "usemtl lamp\nf %d %d %d %d\n", k + 1, k + 2, k + 3, k + 4
}
