# walls.awk - closed scenes as meshers give them, as OBJ: `awk -v SCENE=NAME -v N=8 -f walls.awk`.
#
#   cube_quads        a unit cube, each wall in N x N squares
#   cube_triangles    the same, each square in two triangles
#   sphere_in_box     a sphere of radius .3 in the cube of triangles: an octahedron with N parts along each edge, blown up
#
# Fronts look into the room. Squares come wall by wall, the first side of a wall outside: square i, k of wall w is face
# (w N + i) N + k (cube_factors.awk). Nothing else is said, so all is of one material.
# SPDX-License-Identifier: MIT
function vertex(x, y, z) { printf "v %.9g %.9g %.9g\n", x, y, z }
function wall(ox, oy, oz, ux, uy, uz, vx, vy, vz, i, k, c, s, t) {
    for (i = 0; i < N; i++)
        for (k = 0; k < N; k++) {
            for (c = 0; c < 4; c++) {
                s = (i + (c == 1 || c == 2)) / N
                t = (k + (c > 1)) / N
                vertex(ox + s * ux + t * vx, oy + s * uy + t * vy, oz + s * uz + t * vz)
            }
            print (SCENE == "cube_quads" ? "f -4 -3 -2 -1" : "f -4 -3 -2\nf -4 -2 -1")
        }
}
# The corner of an eighth that lies a, b, c parts off the axes' planes; its signs are sx, sy, sz.
function on_sphere(sx, sy, sz, a, b, c, r) {
    r = .3 / sqrt(a * a + b * b + c * c)
    vertex(.5 + sx * r * a, .5 + sy * r * b, .5 + sz * r * c)
}
# The front of an eighth turns as its signs do.
function triangle(sx, sy, sz, a, b, c, a1, b1, c1, a2, b2, c2) {
    on_sphere(sx, sy, sz, a, b, c)
    on_sphere(sx, sy, sz, a1, b1, c1)
    on_sphere(sx, sy, sz, a2, b2, c2)
    print (sx * sy * sz > 0 ? "f -3 -2 -1" : "f -1 -2 -3")
}
function eighth(sx, sy, sz, a, b, c) {
    for (a = 0; a < N; a++)
        for (b = 0; a + b < N; b++) {
            c = N - a - b
            triangle(sx, sy, sz, a, b, c, a + 1, b, c - 1, a, b + 1, c - 1)
            if (c > 1) triangle(sx, sy, sz, a + 1, b, c - 1, a + 1, b + 1, c - 2, a, b + 1, c - 1)
        }
}
BEGIN {
    wall(0, 0, 0, 1, 0, 0, 0, 1, 0)
    wall(0, 0, 1, 0, 1, 0, 1, 0, 0)
    wall(0, 0, 0, 0, 1, 0, 0, 0, 1)
    wall(1, 0, 0, 0, 0, 1, 0, 1, 0)
    wall(0, 0, 0, 0, 0, 1, 1, 0, 0)
    wall(0, 1, 0, 1, 0, 0, 0, 0, 1)
    if (SCENE == "sphere_in_box")
        for (o = 0; o < 8; o++) eighth(o % 2 ? -1 : 1, int(o / 2) % 2 ? -1 : 1, o < 4 ? 1 : -1)
}
