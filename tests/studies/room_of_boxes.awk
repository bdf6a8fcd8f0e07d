# room_of_boxes.awk - an OBJ scene of about FACES faces, as `awk -v FACES=1000 -v MATERIALS=room.mtl -f room_of_boxes.awk`: a
# room of 10 x 8 x 3 m, half of them in its walls, cut into quads, and half in boxes that stand in a grid, each moved, turned
# and sized at random. The middle of the ceiling shines. The same scene each time; of any number of faces the same room.
# SPDX-License-Identifier: MIT
function random() { # Lehmer's, of which a double holds every product [Park and Miller 1988]
    seed = (16807 * seed) % 2147483647
    return seed / 2147483647
}
function quad(m, a, b, c, d) {
    if (m != material) print "usemtl " m
    material = m
    printf "v %.6f %.6f %.6f\nv %.6f %.6f %.6f\nv %.6f %.6f %.6f\nv %.6f %.6f %.6f\nf -4 -3 -2 -1\n", \
        P[a, 1], P[a, 2], P[a, 3], P[b, 1], P[b, 2], P[b, 3], P[c, 1], P[c, 2], P[c, 3], P[d, 1], P[d, 2], P[d, 3]
}
function point(i, x, y, z) { P[i, 1] = x; P[i, 2] = y; P[i, 3] = z }
# A wall from o along u and v, which turn to its front, in n x m quads.
function wall(name, n, m, ox, oy, oz, ux, uy, uz, vx, vy, vz, i, k, c, s, t) {
    for (i = 0; i < n; i++)
        for (k = 0; k < m; k++) {
            for (c = 0; c < 4; c++) {
                s = (i + (c == 1 || c == 2)) / n
                t = (k + (c > 1)) / m
                point(c, ox + s * ux + t * vx, oy + s * uy + t * vy, oz + s * uz + t * vz)
            }
            s = (i + .5) / n
            t = (k + .5) / m
            quad(name == "ceiling" && s > .35 && s < .65 && t > .35 && t < .65 ? "lamp" : name, 0, 1, 2, 3)
        }
}
function box(x, y, z, r, turn, c, a, q) {
    for (q = 0; q < 8; q++) {
        a = turn + (q % 4) * 1.5707963267948966
        point(q, x + r * cos(a), y + r * sin(a), z + (q < 4 ? -r : r) * .7)
    }
    c = "box_" (1 + int(3 * random()))
    quad(c, 3, 2, 1, 0)
    quad(c, 4, 5, 6, 7)
    for (q = 0; q < 4; q++) quad(c, q, (q + 1) % 4, 4 + (q + 1) % 4, 4 + q)
}
function count(x) { return x < 1 ? 1 : int(x + .5) }
BEGIN {
    seed = 1
    print "newmtl wall\nKd .6 .6 .6\nnewmtl floor\nKd .4 .4 .4\nnewmtl ceiling\nKd .8 .8 .8\nnewmtl lamp\nKd .3 .3 .3\nKe 70 70 70" >MATERIALS
    print "newmtl box_1\nKd .6 .6 .6\nnewmtl box_2\nKd .5 .5 .5\nnewmtl box_3\nKd .3 .3 .3" >MATERIALS
    name = MATERIALS
    sub(/.*\//, "", name)
    print "mtllib " name
    h = sqrt(2 * (10 * 8 + 8 * 3 + 3 * 10) / (FACES / 2))
    x = count(10 / h); y = count(8 / h); z = count(3 / h)
    wall("floor", x, y, 0, 0, 0, 10, 0, 0, 0, 8, 0)
    wall("ceiling", y, x, 0, 0, 3, 0, 8, 0, 10, 0, 0)
    wall("wall", z, x, 0, 0, 0, 0, 0, 3, 10, 0, 0)
    wall("wall", x, z, 0, 8, 0, 10, 0, 0, 0, 0, 3)
    wall("wall", y, z, 0, 0, 0, 0, 8, 0, 0, 0, 3)
    wall("wall", z, y, 10, 0, 0, 0, 0, 3, 0, 8, 0)
    boxes = count(FACES / 12)
    # of a grid of cubes of side g those that are drawn; a box of radius .35 g keeps to its own
    g = (10 * 8 * 2.5 / boxes) ^ (1 / 3) * .95
    for (i = int(10 / g) * int(8 / g) * int(2.5 / g); i < boxes; i = int(10 / g) * int(8 / g) * int(2.5 / g)) g *= .99
    nx = int(10 / g); ny = int(8 / g)
    for (i = 0; i < boxes; i++) {
        r = g * (.2 + .15 * random())
        box(g * (i % nx + .45 + .1 * random()), g * (int(i / nx) % ny + .45 + .1 * random()), \
            .05 + g * (int(i / nx / ny) + .45 + .1 * random()), r, 6.2831853 * random())
    }
}
