/* group_outline.c - the outline of a group of coplanar faces: a polygon of 3 or 4 corners.
 *
 * What a shaft says of a group it says of the group's outline, and an outline that sticks out of
 * its faces crosses the walls beside them, behind which nothing is clear. So a plane's frame lies
 * along the smallest rectangle around its faces, whatever their own edges are: two triangles of a
 * square have the square. Where the faces do not fill that rectangle, as those of a gable, it is
 * the outline only if the hull's sides, without those of which least is to be seen, leave no
 * smaller one.
 *
 * The faces tile their outline when every edge that no neighbour cancels lies on its sides, so that
 * all of it is covered equally often, and the areas say once.
 *
 * Invariant: a group's faces lie within its outline, to rounding.
 * [derived here; the cancelling of edges is that of winding numbers]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "hierarchy/flat_hull.h"
#include "hierarchy/group_outline.h"
#include "kernel/constants.h"

struct directed { /* an edge, for cancelling, from the smaller of its places */
    uint32_t a, b;
};

int outliner_open(struct outliner *o, const struct hierarchy *plain, double flat)
{
    size_t n = plain->face_count;
    *o = (struct outliner){.plain = plain, .flat = flat};
    o->points = malloc((4 * n + 1) * sizeof *o->points);
    o->hull = malloc((4 * n + 1) * sizeof *o->hull);
    o->edges = malloc((8 * n + 1) * sizeof *o->edges);
    o->corners = malloc((4 * n + 1) * sizeof *o->corners);
    o->place = malloc((4 * n + 1) * sizeof *o->place);
    return o->points && o->hull && o->edges && o->corners && o->place ? 0 : -1;
}

void outliner_close(struct outliner *o)
{
    free(o->points);
    free(o->hull);
    free(o->edges);
    free(o->corners);
    free(o->place);
}

static void in_frame(const struct group_frame *f, const double p[3], double uv[2])
{
    double w[3];
    sub3(w, p, f->origin);
    uv[0] = dot3(w, f->u);
    uv[1] = dot3(w, f->v);
}

static size_t find_hull(struct outliner *o, const struct group_frame *f, struct group_faces faces)
{
    size_t n = 0;
    for (uint32_t i = 0; i < faces.count; i++) {
        const struct element *e = hierarchy_surface(o->plain, faces.face[i]);
        for (int c = 0; c < e->vertices; c++)
            in_frame(f, e->vertex[c], o->points[n++]);
    }
    return flat_hull(o->points, n, o->hull);
}

static double area_of(const struct outliner *o, struct group_faces faces)
{
    double area = 0;
    for (uint32_t i = 0; i < faces.count; i++)
        area += hierarchy_surface(o->plain, faces.face[i])->area;
    return area;
}

/* The second axis, from the normal and the first, which is set upright. */
static void finish_axes(struct group_frame *f)
{
    cross3(f->v, f->n, f->u);
    double size = length3(f->v);
    for (int k = 0; k < 3; k++)
        f->v[k] /= size;
    cross3(f->u, f->v, f->n);
}

/* The plane of them all: of one small face, rounding of its corners would turn far ones out of the
 * plane, behind the walls that they meet. In the sum, what neighbours share cancels. */
static void find_plane(const struct outliner *o, struct group_faces faces, struct group_frame *f)
{
    double n[3] = {0, 0, 0}, at[3] = {0, 0, 0}, area = 0;
    const double *first = hierarchy_surface(o->plain, faces.face[0])->centre;
    for (uint32_t i = 0; i < faces.count; i++) {
        const struct element *e = hierarchy_surface(o->plain, faces.face[i]);
        area += e->area;
        for (int k = 0; k < 3; k++) {
            n[k] += e->area * e->normal[k];
            at[k] += e->area * (e->centre[k] - first[k]);
        }
    }
    double size = length3(n);
    for (int k = 0; k < 3; k++) {
        f->n[k] = n[k] / size;
        f->origin[k] = first[k] + at[k] / area;
    }
}

void group_frame_of(struct outliner *o, struct group_faces faces, struct group_frame *f)
{
    const struct element *e = hierarchy_surface(o->plain, faces.face[0]);
    double best = 0;
    for (uint32_t i = 0; i < faces.count; i++)
        if (hierarchy_surface(o->plain, faces.face[i])->area > e->area * (1 + 1e-9))
            e = hierarchy_surface(o->plain, faces.face[i]);
    find_plane(o, faces, f);
    for (int c = 0; c < e->vertices; c++) { /* along its longest edge for now */
        double edge[3];
        sub3(edge, e->vertex[c + 1 < e->vertices ? c + 1 : 0], e->vertex[c]);
        double size = length3(edge);
        if (size <= best * (1 + 1e-9))
            continue;
        best = size;
        for (int k = 0; k < 3; k++)
            f->u[k] = edge[k] / size;
    }
    finish_axes(f);
    size_t corners = find_hull(o, f, faces);
    if (corners >= 3) {
        double along[2];
        flat_hull_direction((const double(*)[2])o->hull, corners, along);
        for (int k = 0; k < 3; k++)
            f->u[k] = along[0] * f->u[k] + along[1] * f->v[k];
        finish_axes(f);
    }
    double low[2], high[2];
    group_bounds(o, f, faces, low, high);
    f->full = area_of(o, faces) >= (1 - GROUP_GAPS) * (high[0] - low[0]) * (high[1] - low[1]);
}

void group_bounds(const struct outliner *o, const struct group_frame *f, struct group_faces faces,
                  double low[2], double high[2])
{
    low[0] = low[1] = INFINITY;
    high[0] = high[1] = -INFINITY;
    for (uint32_t i = 0; i < faces.count; i++) {
        const struct element *e = hierarchy_surface(o->plain, faces.face[i]);
        for (int c = 0; c < e->vertices; c++) {
            double uv[2];
            in_frame(f, e->vertex[c], uv);
            for (int k = 0; k < 2; k++) {
                low[k] = uv[k] < low[k] ? uv[k] : low[k];
                high[k] = uv[k] > high[k] ? uv[k] : high[k];
            }
        }
    }
}

void group_outline(struct outliner *o, const struct group_frame *f, struct group_faces faces,
                   struct element *e)
{
    double low[2], high[2];
    group_bounds(o, f, faces, low, high);
    const double rectangle[4][2] = {
        {low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}};
    const double(*corner)[2] = rectangle;
    size_t n = 4;
    if (!f->full) {
        size_t sides = flat_hull_quad(o->hull, find_hull(o, f, faces));
        if ((sides == 3 || sides == 4)
            && flat_area((const double(*)[2])o->hull, sides)
                   < (1 - GROUP_GAPS) * flat_area(rectangle, 4)) {
            corner = (const double(*)[2])o->hull;
            n = sides;
        }
    }
    for (size_t c = 0; c < n; c++)
        for (int k = 0; k < 3; k++)
            e->vertex[c][k] = f->origin[k] + corner[c][0] * f->u[k] + corner[c][1] * f->v[k];
    for (int k = 0; k < 3; k++) {
        e->centre[k] = 0;
        for (size_t c = 0; c < n; c++)
            e->centre[k] += e->vertex[c][k] / (double)n;
        e->normal[k] = f->n[k];
    }
    e->radius = 0;
    for (size_t c = 0; c < n; c++) {
        double away[3];
        sub3(away, e->vertex[c], e->centre);
        e->radius = fmax(e->radius, length3(away));
    }
    e->vertices = (uint8_t)n;
    e->area = area_of(o, faces);
}

/* ---- tiling */

static int compare_edges(const void *a, const void *b)
{
    const struct directed *x = a, *y = b;
    if (x->a != y->a)
        return x->a < y->a ? -1 : 1;
    return (x->b > y->b) - (x->b < y->b);
}

/* Do both ends lie on one side of the outline, to `near`? */
static int on_side(double (*corner)[2], int n, double (*end)[2], double near)
{
    for (int c = 0; c < n; c++) {
        const double *a = corner[c], *b = corner[c + 1 < n ? c + 1 : 0];
        double u = b[0] - a[0], v = b[1] - a[1], least = near * sqrt(u * u + v * v);
        if (fabs(u * (end[0][1] - a[1]) - v * (end[0][0] - a[0])) < least
            && fabs(u * (end[1][1] - a[1]) - v * (end[1][0] - a[0])) < least)
            return 1;
    }
    return 0;
}

/* The outline's corners in its plane. Returns whether the faces have its area. */
static int fills(const struct group_frame *f, const struct element *e, double corner[4][2])
{
    for (int c = 0; c < e->vertices; c++)
        in_frame(f, e->vertex[c], corner[c]);
    const double whole = flat_area((const double(*)[2])corner, e->vertices);
    return fabs(e->area - whole) <= GROUP_GAPS * whole;
}

int group_fills(const struct group_frame *f, const struct element *e)
{
    double corner[4][2];
    return fills(f, e, corner);
}

/* The places of all corners of some faces, one after the other: what is one in the file is one
 * here, whatever its last digit. */
static void find_places(struct outliner *o, struct group_faces faces)
{
    size_t n = 0;
    for (uint32_t i = 0; i < faces.count; i++) {
        const struct element *g = hierarchy_surface(o->plain, faces.face[i]);
        for (int c = 0; c < g->vertices; c++, n++)
            o->corners[n] = (struct corner){g->vertex[c], n};
    }
    places_find(o->corners, n, PLACES_APART * o->flat, o->place);
}

/* Edges run both ways between neighbours: written from the smaller end, with which way in the
 * list's half. */
int group_tiles(struct outliner *o, const struct group_frame *f, struct group_faces faces,
                const struct element *e)
{
    double corner[4][2], near = o->flat;
    size_t count[2] = {0, 0};
    struct directed *half[2] = {o->edges, o->edges + 4 * (size_t)faces.count};
    const uint32_t *place = o->place; /* of the face's corners */
    if (!fills(f, e, corner))
        return 0;
    find_places(o, faces);
    for (uint32_t i = 0; i < faces.count; i++) {
        const struct element *g = hierarchy_surface(o->plain, faces.face[i]);
        for (int c = 0; c < g->vertices; c++) {
            const int next = c + 1 < g->vertices ? c + 1 : 0;
            double end[2][2];
            in_frame(f, g->vertex[c], end[0]);
            in_frame(f, g->vertex[next], end[1]);
            if (place[c] == place[next] || on_side(corner, e->vertices, end, near))
                continue;
            const int turned = place[c] > place[next];
            half[turned][count[turned]++] =
                (struct directed){place[turned ? next : c], place[turned ? c : next]};
        }
        place += g->vertices;
    }
    if (count[0] != count[1])
        return 0;
    for (size_t i = 0; i < 2; i++)
        qsort(half[i], count[i], sizeof **half, compare_edges);
    for (size_t j = 0; j < count[0]; j++)
        if (compare_edges(&half[0][j], &half[1][j]) != 0)
            return 0;
    return 1;
}
