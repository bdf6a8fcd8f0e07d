/* nastran_systems.h - coordinate systems of Nastran, and the points that are given in them.
 *
 * A system is given by three points A, B and C in another (CORD2) or by three points of the mesh
 * (CORD1): A is its origin, z goes to B, and C is in the half plane of z and x. R are rectangular;
 * C cylindrical: r, angle, z; S spherical: r, the angle from z, the angle around z; in degrees.
 * Anything may come before what it needs.
 * [NX Nastran quick reference guide, CORD1C to CORD2S]
 * SPDX-License-Identifier: MIT */
#ifndef NASTRAN_SYSTEMS_H
#define NASTRAN_SYSTEMS_H

#include "scene/mesh_parts.h"

struct nastran_system {
    int64_t number, within, grid[3]; /* within: 0 is the basic one */
    int by_grids, placed;
    char kind;       /* R, C or S, of any case */
    double at[3][3]; /* A, B, C; when it is placed its origin, then its axes below */
    double axis[3][3];
    uint32_t line;
};

struct nastran_point {
    int64_t number, system;
    double at[3];
    uint32_t line;
    char by_default; /* names no system */
    char placed;
};

struct nastran_systems {
    struct nastran_system *system;
    struct nastran_point *point;
    size_t systems, system_capacity, points, point_capacity;
    struct numbered numbers; /* of systems */
    int64_t default_system;  /* of points that name none; GRDSET may come behind them */
};

enum nastran_added { NASTRAN_DONE, NASTRAN_TWICE, NASTRAN_FULL };

enum nastran_added nastran_system_add(struct nastran_systems *all, const struct nastran_system *s);
/* Returns 0, or -1 when out of memory. */
int nastran_point_add(struct nastran_systems *all, const struct nastran_point *p);
/* Defines the mesh's nodes. Returns 0, or -1 after a message. */
int nastran_systems_place(struct nastran_systems *all, struct mesh *mesh);
void nastran_systems_free(struct nastran_systems *all);

#endif
