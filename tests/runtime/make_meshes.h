/* make_meshes.h - rooms with boxes whose walls are meshed, as meshers mesh them: by triangles,
 * quads or both, turned in space; and their walls as they were before, which a judge can use.
 * SPDX-License-Identifier: MIT */
#ifndef MAKE_MESHES_H
#define MAKE_MESHES_H

#include <math.h>
#include <string.h>
#include "kernel/hash.h"
#include "runtime/room_judge.h"
#include "scene/make_scene.h"

enum { MESH_PATCHES = 128, MESH_BOXES = 4 };
enum mesh_shape { SHAPE_BOX, SHAPE_FIVE_SIDED, SHAPE_L, SHAPE_WINDOW, SHAPE_HEXAGON, SHAPES };
enum mesh_cells { CELLS_QUADS, CELLS_TRIANGLES, CELLS_MIXED, CELLS };

struct mesh_room {
    uint64_t state; /* of chance */
    struct judge_polygon patch[MESH_PATCHES];
    int count;                             /* of patches, */
    int walls;                             /* the first so many of which are the room's */
    double turned[3][3], moved[3], scaled; /* where all of it is put, in the end */
};

static inline double mesh_chance(struct mesh_room *room)
{
    return (double)(hash64(++room->state) >> 11) * 0x1p-53;
}

static inline void mesh_patch(struct mesh_room *room, int n, const double (*v)[3])
{
    struct judge_polygon *p = &room->patch[room->count++];
    p->n = n;
    memcpy(p->v, v, (size_t)n * sizeof *v);
}

/* The rectangle from a part of a wall: a + s u + t v. */
static inline void mesh_part(struct mesh_room *room, const double *a, const double *u,
                             const double *v, const double s[2], const double t[2])
{
    double p[4][3];
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < 3; k++)
            p[c][k] = a[k] + s[c == 1 || c == 2] * u[k] + t[c >= 2] * v[k];
    mesh_patch(room, 4, (const double(*)[3])p);
}

/* A wall over the plan's side from a to b, seen from its left; `window`: with a hole in it. */
static inline void mesh_wall(struct mesh_room *room, const double a[2], const double b[2],
                             double height, int window)
{
    const double o[3] = {a[0], a[1], 0}, u[3] = {b[0] - a[0], b[1] - a[1], 0},
                 v[3] = {0, 0, height};
    const double all[2] = {0, 1}, low[2] = {0, 0.3}, middle[2] = {0.3, 0.8}, high[2] = {0.8, 1};
    if (!window) {
        mesh_part(room, o, u, v, all, all);
        return;
    }
    mesh_part(room, o, u, v, all, low);
    mesh_part(room, o, u, v, all, high);
    mesh_part(room, o, u, v, low, middle);
    mesh_part(room, o, u, v, high, middle);
}

/* Floor and ceiling over some of the plan's corners. */
static inline void mesh_floors(struct mesh_room *room, const double (*plan)[2], const int *corner,
                               int n, double height)
{
    for (int up = 0; up < 2; up++) {
        double p[6][3];
        for (int c = 0; c < n; c++) {
            const double *at = plan[corner[up ? n - 1 - c : c]];
            p[c][0] = at[0];
            p[c][1] = at[1];
            p[c][2] = up ? height : 0;
        }
        mesh_patch(room, n, (const double(*)[3])p);
    }
}

static inline void mesh_walls(struct mesh_room *room, enum mesh_shape shape)
{
    double x = 2 + 3 * mesh_chance(room), y = 2 + 2 * mesh_chance(room), z = 2 + mesh_chance(room),
           s = 0.3 + 0.4 * mesh_chance(room), t = 0.3 + 0.4 * mesh_chance(room);
    const double square[4][2] = {{0, 0}, {x, 0}, {x, y}, {0, y}};
    const double five[5][2] = {{0, 0}, {x, 0}, {x, t * y}, {s * x, y}, {0, t * y}};
    const double six[6][2] = {{s, 0}, {x, 0}, {x + t, t * y}, {x, y}, {s, y}, {0, s * y}};
    const double corner[6][2] = {{0, 0}, {x, 0}, {x, t * y}, {s * x, t * y}, {s * x, y}, {0, y}};
    const double(*plan)[2] = shape == SHAPE_FIVE_SIDED ? five
                             : shape == SHAPE_HEXAGON  ? six
                             : shape == SHAPE_L        ? corner
                                                       : square;
    int n = shape == SHAPE_FIVE_SIDED ? 5 : shape == SHAPE_HEXAGON || shape == SHAPE_L ? 6 : 4;
    static const int all[6] = {0, 1, 2, 3, 4, 5}, parts[2][4] = {{0, 1, 2, 3}, {0, 3, 4, 5}};
    for (int i = 0; i < n; i++)
        mesh_wall(room, plan[(i + 1) % n], plan[i], z, shape == SHAPE_WINDOW && i == 1);
    if (shape == SHAPE_L) {
        mesh_floors(room, plan, parts[0], 4, z);
        mesh_floors(room, plan, parts[1], 4, z);
    } else {
        mesh_floors(room, plan, all, n, z);
    }
    room->walls = room->count;
}

/* The box's six sides, from outside. */
static inline void mesh_box_sides(struct mesh_room *room, const double (*corner)[3])
{
    static const int side[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 6; i++) {
        double p[4][3];
        for (int c = 0; c < 4; c++)
            memcpy(p[c], corner[side[i][c]], sizeof p[c]);
        mesh_patch(room, 4, (const double(*)[3])p);
    }
}

/* Boxes that stand free in the room: at a gap from its walls, and from each other. */
static inline void mesh_boxes(struct mesh_room *room, int count)
{
    double middle[MESH_BOXES][3], round[MESH_BOXES];
    for (int i = 0, tries = 0; i < count && tries < 1000; tries++) {
        double half[3], turn = 6.283185307 * mesh_chance(room), corner[8][3];
        int free = 1;
        middle[i][0] = 5 * mesh_chance(room);
        middle[i][1] = 4 * mesh_chance(room);
        middle[i][2] = 2.5 * mesh_chance(room);
        for (int k = 0; k < 3; k++)
            half[k] = 0.05 + 0.4 * mesh_chance(room);
        round[i] = sqrt(judge_dot(half, half));
        for (int c = 0; c < 8; c++) {
            double a = c & 1 ? half[0] : -half[0], b = c & 2 ? half[1] : -half[1];
            corner[c][0] = middle[i][0] + a * cos(turn) - b * sin(turn);
            corner[c][1] = middle[i][1] + a * sin(turn) + b * cos(turn);
            corner[c][2] = middle[i][2] + (c & 4 ? half[2] : -half[2]);
        }
        for (int j = 0; j < i; j++) {
            double d[3] = {middle[i][0] - middle[j][0], middle[i][1] - middle[j][1],
                           middle[i][2] - middle[j][2]};
            free &= sqrt(judge_dot(d, d)) > round[i] + round[j] + 0.02;
        }
        for (int w = 0; w < room->walls && free; w++) {
            double n[3];
            judge_normal(&room->patch[w], n);
            for (int c = 0; c < 8; c++)
                free &= judge_dot(n, corner[c]) - judge_dot(n, room->patch[w].v[0]) > 0.02;
        }
        if (!free)
            continue;
        mesh_box_sides(room, (const double(*)[3])corner);
        i++;
    }
}

static inline void mesh_put(struct mesh_room *room)
{
    double a = 6.283185307 * mesh_chance(room), b = 6.283185307 * mesh_chance(room);
    for (int i = 0; i < room->count; i++)
        for (int c = 0; c < room->patch[i].n; c++) {
            double *p = room->patch[i].v[c];
            double x = p[0] * cos(a) - p[1] * sin(a), y = p[0] * sin(a) + p[1] * cos(a);
            p[0] = x;
            double z = p[2];
            p[1] = y * cos(b) - z * sin(b);
            p[2] = y * sin(b) + z * cos(b);
        }
}

/* ---- meshes */

static inline void mesh_corner(const double (*v)[3], int n, double s, double t, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = n == 3 ? v[0][k] + s * (v[1][k] - v[0][k] + t * (v[2][k] - v[1][k]))
                      : (1 - t) * ((1 - s) * v[0][k] + s * v[1][k])
                            + t * ((1 - s) * v[3][k] + s * v[2][k]);
}

static inline void mesh_cell(struct mesh_room *room, struct scene *s, double p[4][3],
                             enum mesh_cells cells)
{
    if (cells == CELLS_QUADS || (cells == CELLS_MIXED && mesh_chance(room) < 0.5)) {
        made_face(s, 0, 4, (const double(*)[3])p);
        return;
    }
    int from = mesh_chance(room) < 0.5;
    for (int half = 0; half < 2; half++) {
        double t[3][3];
        for (int c = 0; c < 3; c++)
            memcpy(t[c], p[(from + (c == 0 ? 0 : c + half)) % 4], sizeof t[c]);
        made_face(s, 0, 3, (const double(*)[3])t);
    }
}

/* A patch of 3 or 4 corners, along x across cells. Of a triangle, strips from its first corner. */
static inline void mesh_grid(struct mesh_room *room, struct scene *s, const double (*v)[3], int n,
                             int along, int across, enum mesh_cells cells)
{
    for (int i = 0; i < along; i++)
        for (int j = 0; j < across; j++) {
            double p[4][3];
            for (int c = 0; c < 4; c++)
                mesh_corner(v, n, (double)(i + (c == 1 || c == 2)) / along,
                            (double)(j + (c >= 2)) / across, p[c]);
            if (n == 3 && i == 0) /* its first side is the corner */
                made_face(s, 0, 3,
                          (const double(*)[3])(double[3][3]){{p[0][0], p[0][1], p[0][2]},
                                                             {p[1][0], p[1][1], p[1][2]},
                                                             {p[2][0], p[2][1], p[2][2]}});
            else
                mesh_cell(room, s, p, cells);
        }
}

static inline double mesh_side(const double *a, const double *b)
{
    double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    return sqrt(judge_dot(d, d));
}

/* About `faces` for the patch. */
static inline void mesh_of_patch(struct mesh_room *room, struct scene *s,
                                 const struct judge_polygon *p, double faces, enum mesh_cells cells)
{
    double v[4][3];
    for (int from = 1; from + 1 < p->n; from += 2) {
        int n = from + 2 < p->n ? 4 : 3;
        memcpy(v[0], p->v[0], sizeof v[0]);
        for (int c = 1; c < n; c++)
            memcpy(v[c], p->v[from + c - 1], sizeof v[c]);
        double u = mesh_side(v[0], v[1]), w = mesh_side(v[1], v[2]),
               side = sqrt(u * w / fmax(1, cells == CELLS_TRIANGLES ? 0.5 * faces : faces));
        mesh_grid(room, s, (const double(*)[3])v, n, (int)fmax(1, u / side + 0.5),
                  (int)fmax(1, w / side + 0.5), cells);
    }
}

/* A random room with so many boxes at most; `faces`: of a wall, about. The scene is opened. */
static inline void mesh_room_make(struct mesh_room *room, struct scene *s, uint64_t seed,
                                  enum mesh_shape shape, enum mesh_cells cells, int boxes,
                                  double faces)
{
    memset(room, 0, sizeof *room);
    room->state = seed << 32;
    mesh_walls(room, shape);
    mesh_boxes(room, boxes);
    mesh_put(room);
    made_open(s);
    made_material(s, 0.5, 0);
    for (int i = 0; i < room->count; i++)
        mesh_of_patch(room, s, &room->patch[i], i < room->walls ? faces : 0.2 * faces, cells);
}

#endif
