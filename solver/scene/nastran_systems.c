/* nastran_systems.c - see nastran_systems.h: what can be placed is, again and again, until all is.
 *
 * Each turn places at least one system, else those that are left need each other. A chain of
 * systems takes a turn for each when it stands in the wrong order; one of more than TURNS is
 * refused, which bounds the work.
 * SPDX-License-Identifier: MIT */
#include "scene/nastran_systems.h"

#include <ctype.h>
#include <math.h>

#include "geometry.h"
#include "util/array.h"
#include "util/report.h"

enum { TURNS = 256 };

enum nastran_added nastran_system_add(struct nastran_systems *all, const struct nastran_system *s)
{
    if (numbered_find(&all->numbers, s->number) != UINT32_MAX)
        return NASTRAN_TWICE;
    if (array_reserve(&all->system, all->systems + 1, &all->system_capacity, sizeof *all->system)
        || numbered_add(&all->numbers, s->number, (uint32_t)all->systems))
        return NASTRAN_FULL;
    all->system[all->systems++] = *s;
    return NASTRAN_DONE;
}

int nastran_point_add(struct nastran_systems *all, const struct nastran_point *p)
{
    if (array_reserve(&all->point, all->points + 1, &all->point_capacity, sizeof *all->point))
        return -1;
    all->point[all->points++] = *p;
    return 0;
}

void nastran_systems_free(struct nastran_systems *all)
{
    free(all->system);
    free(all->point);
    free(all->numbers.entry);
}

/* Coordinates in a system to basic ones, when the system is placed. */
static int to_basic(const struct nastran_systems *all, int64_t number, const double at[3],
                    double to[3])
{
    static const double degree = 0.017453292519943295;
    double local[3] = {at[0], at[1], at[2]};
    if (!number) {
        memcpy(to, local, sizeof local);
        return 1;
    }
    const uint32_t i = numbered_find(&all->numbers, number);
    const struct nastran_system *s = i == UINT32_MAX ? NULL : &all->system[i];
    if (!s || !s->placed)
        return 0;
    const int kind = toupper((unsigned char)s->kind);
    if (kind == 'C') {
        local[0] = at[0] * cos(at[1] * degree);
        local[1] = at[0] * sin(at[1] * degree);
    } else if (kind == 'S') {
        local[0] = at[0] * sin(at[1] * degree) * cos(at[2] * degree);
        local[1] = at[0] * sin(at[1] * degree) * sin(at[2] * degree);
        local[2] = at[0] * cos(at[1] * degree);
    }
    for (int k = 0; k < 3; k++)
        to[k] = s->at[0][k] + local[0] * s->axis[0][k] + local[1] * s->axis[1][k]
                + local[2] * s->axis[2][k];
    return 1;
}

/* A node that is defined. */
static int node_at(const struct mesh *mesh, int64_t number, double to[3])
{
    const uint32_t i = numbered_find(&mesh->nodes, number);
    if (i == UINT32_MAX)
        return 0;
    memcpy(to, &mesh->file->positions[3 * (size_t)i], 3 * sizeof *to);
    return !isnan(to[0]);
}

/* To length 1; 0 when there is none. */
static int normalise(double a[3])
{
    const double length = hypot(hypot(a[0], a[1]), a[2]);
    for (int k = 0; k < 3; k++)
        a[k] /= length;
    return length > 0 && isfinite(length);
}

/* Returns 1 when it is placed, 0 when something is missing, -1 after a message. */
static int place_system(struct nastran_systems *all, struct nastran_system *s,
                        const struct mesh *mesh)
{
    double at[3][3], to_c[3];
    for (int k = 0; k < 3; k++)
        if (!(s->by_grids ? node_at(mesh, s->grid[k], at[k])
                          : to_basic(all, s->within, s->at[k], at[k])))
            return 0;
    for (int k = 0; k < 3; k++) {
        s->axis[2][k] = at[1][k] - at[0][k];
        to_c[k] = at[2][k] - at[0][k];
    }
    int good = normalise(s->axis[2]) && normalise(to_c);
    cross3(s->axis[1], s->axis[2], to_c);
    good = good && normalise(s->axis[1]);
    cross3(s->axis[0], s->axis[1], s->axis[2]);
    if (!good)
        return report_error(mesh->path, s->line,
                            "the three points of coordinate system %lld are in a line; give it a "
                            "plane",
                            (long long)s->number);
    memcpy(s->at, at, sizeof at);
    return s->placed = 1;
}

/* Places what can be placed. Returns how much, -1 after a message. */
static int64_t turn(struct nastran_systems *all, struct mesh *mesh)
{
    int64_t placed = 0;
    for (size_t i = 0; i < all->systems; i++) {
        struct nastran_system *s = &all->system[i];
        const int now = s->placed ? 0 : place_system(all, s, mesh);
        if (now < 0)
            return -1;
        placed += now;
    }
    for (size_t i = 0; i < all->points; i++) {
        struct nastran_point *p = &all->point[i];
        double at[3];
        if (p->placed || !to_basic(all, p->system, p->at, at))
            continue;
        if (mesh_define_node(mesh, p->number, at, p->line))
            return -1;
        p->placed = 1;
        placed++;
    }
    return placed;
}

int nastran_systems_place(struct nastran_systems *all, struct mesh *mesh)
{
    int64_t placed = 1;
    for (size_t i = 0; i < all->points; i++)
        if (all->point[i].by_default)
            all->point[i].system = all->default_system;
    for (int i = 0; i < TURNS && placed > 0; i++)
        placed = turn(all, mesh);
    if (placed < 0)
        return -1;
    for (size_t i = 0; i < all->points; i++)
        if (!all->point[i].placed)
            return report_error(mesh->path, all->point[i].line,
                                "GRID %lld is in coordinate system %lld, which is not there, or "
                                "needs itself; write it into the file",
                                (long long)all->point[i].number, (long long)all->point[i].system);
    return 0;
}
