/* cut_contacts.c - see cut_contacts.h.
 *
 * Parts of one polygon lie side by side and reach into each other's boxes, all of them where they
 * are the slivers of a round one; but they are parallel, and so have no contact. Normals are
 * bounded as places are, so that a walk sees that at once.
 *
 * Invariant: the contacts of a face depend on it and the faces that touch it, not on where these
 * stand in the tree.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/cut_contacts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "hierarchy/bvh.h"
#include "hierarchy/polygon.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "util/array.h"

int cut_frame_of(struct cut_frame *c, const struct face *faces, uint32_t index, int two_sided,
                 double precision)
{
    struct face f = faces[index];
    if (polygon_degenerate(f.vertex, f.vertices, precision))
        return 0;
    *c = (struct cut_frame){.face = &faces[index], .index = index, .two_sided = two_sided};
    c->size = polygon_size(f.vertex, f.vertices);
    polygon_normal(f.vertex, f.vertices, c->normal);
    double largest = 0, longest = 0;
    for (int k = 0; k < 3; k++) {
        c->low[k] = INFINITY;
        c->high[k] = -INFINITY;
        for (uint32_t j = 0; j < f.vertices; j++) {
            c->centre[k] += f.vertex[j][k] / f.vertices;
            c->low[k] = fmin(c->low[k], f.vertex[j][k]);
            c->high[k] = fmax(c->high[k], f.vertex[j][k]);
            largest = fmax(largest, fabs(f.vertex[j][k]));
        }
    }
    c->touch = fmax(CUT_TOUCH * c->size, CUT_TOUCH_ROUNDINGS * precision * largest);
    for (uint32_t j = 0; j < f.vertices; j++) {
        double e[3];
        sub3(e, f.vertex[(j + 1) % f.vertices], f.vertex[j]);
        double length = length3(e);
        if (length > longest + c->touch || !j) { /* the first of those as long */
            longest = length;
            for (int k = 0; k < 3; k++)
                c->u[k] = e[k] / length;
        }
    }
    cross3(c->v, c->normal, c->u);
    return longest > 0;
}

double cut_distance(const struct cut_frame *c, const double p[3], const double direction[3])
{
    double d[3];
    sub3(d, p, c->centre);
    return dot3(d, direction);
}

int cut_parts_polygon(const struct cut_frame *c, const double (*v)[3], uint32_t n,
                      const double across[3], double offset)
{
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < n; i++) {
        double h = cut_distance(c, v[i], across) - offset;
        low = fmin(low, h);
        high = fmax(high, h);
    }
    return low < -CUT_SLIVER * c->size && high > CUT_SLIVER * c->size;
}

/* The points of a face in the plane of the frame: corners that touch it, and where edges cross it.
 * Returns how many; 0 when the face lies on one side, or where the framed face gets no light from
 * it. */
static int plane_points(const struct cut_frame *c, const struct face *f, double point[8][3])
{
    double h[4], low = INFINITY, high = -INFINITY;
    int points = 0;
    for (uint32_t i = 0; i < f->vertices; i++) {
        h[i] = cut_distance(c, f->vertex[i], c->normal);
        if (fabs(h[i]) <= c->touch)
            h[i] = 0;
        low = fmin(low, h[i]);
        high = fmax(high, h[i]);
    }
    /* What lies behind a face that has no far side takes no light from it. */
    if (low > 0 || high < 0 || !(high > 0 || (c->two_sided && low < 0)))
        return 0;
    for (uint32_t i = 0; i < f->vertices; i++) {
        uint32_t j = (i + 1) % f->vertices;
        if (!(h[i] < 0 || h[i] > 0))
            memcpy(point[points++], f->vertex[i], sizeof point[0]);
        if ((h[i] < 0 && h[j] > 0) || (h[i] > 0 && h[j] < 0)) {
            for (int k = 0; k < 3; k++)
                point[points][k] =
                    f->vertex[i][k] + h[i] / (h[i] - h[j]) * (f->vertex[j][k] - f->vertex[i][k]);
            points++;
        }
    }
    return points;
}

/* The contact of a face with the framed one. Returns 1 when there is one, its line inside. */
static int find_contact(const struct cut_frame *c, const struct face *faces, uint32_t face,
                        struct contact *found)
{
    double normal[3], direction[3], across[3], corner[4][3], point[8][3];
    int points = plane_points(c, &faces[face], point), from = 0, to = 0;
    if (points < 2)
        return 0;
    memcpy(corner, faces[face].vertex, sizeof corner);
    polygon_normal(corner, faces[face].vertices, normal);
    cross3(direction, c->normal, normal);
    double sine = length3(direction);
    if (!(sine > CUT_PARALLEL))
        return 0;
    double angle = atan2(dot3(direction, c->v), dot3(direction, c->u));
    /* A line has two directions; keep the one in [0, pi), and lines about 0 together. */
    if (angle < -CUT_SAME_LINE || angle >= LAMBERT_PI - CUT_SAME_LINE) {
        angle += angle < 0 ? LAMBERT_PI : -LAMBERT_PI;
        sine = -sine;
    }
    for (int k = 0; k < 3; k++)
        direction[k] /= sine;
    cross3(across, c->normal, direction);
    for (int i = 1; i < points; i++) {
        double t = cut_distance(c, point[i], direction);
        if (t < cut_distance(c, point[from], direction))
            from = i;
        if (t > cut_distance(c, point[to], direction))
            to = i;
    }
    *found = (struct contact){
        .angle = angle,
        .face = face,
        .from = cut_distance(c, point[from], direction),
        .to = cut_distance(c, point[to], direction),
        .offset =
            0.5 * (cut_distance(c, point[from], across) + cut_distance(c, point[to], across))};
    return found->to - found->from > c->touch
           && cut_parts_polygon(c, (const double(*)[3])c->face->vertex, c->face->vertices, across,
                                found->offset);
}

/* Could something in this box touch the framed face? */
static int box_reaches(const struct cut_frame *c, const double low[3], const double high[3])
{
    double height = 0, half = c->touch;
    for (int k = 0; k < 3; k++) {
        if (low[k] > c->high[k] + c->touch || high[k] < c->low[k] - c->touch)
            return 0;
        height += c->normal[k] * (0.5 * (low[k] + high[k]) - c->centre[k]);
        half += fabs(c->normal[k]) * 0.5 * (high[k] - low[k]);
    }
    return fabs(height) <= half * (1 + 1e-9); /* rounding of the sums */
}

/* Are all normals in the box so near the frame's that planes with them have no line of contact?
 * Half of CUT_PARALLEL leaves room for rounding. */
static int box_is_parallel(const struct cut_frame *c, const struct bounds *normals)
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double off =
            fmax(fabs(normals->low[k] - c->normal[k]), fabs(normals->high[k] - c->normal[k]));
        square += off * off;
    }
    return square <= 0.25 * CUT_PARALLEL * CUT_PARALLEL;
}

/* The tree with all that a walk down it looks at. */
struct contact_tree {
    const struct face *faces;
    const struct bvh *tree;
    const struct bounds *normals;
};

static int collect_below(struct contact_list *list, const struct cut_frame *c,
                         const struct contact_tree *t, uint32_t node)
{
    const struct bvh_node *n = &t->tree->nodes[node];
    const struct bounds *box = &t->tree->boxes[node];
    if (!box_reaches(c, box->low, box->high) || box_is_parallel(c, &t->normals[node]))
        return 0;
    for (uint32_t i = 0; i < n->children; i++)
        if (collect_below(list, c, t, n->child + i) < 0)
            return -1;
    if (n->children)
        return 0;
    uint32_t face = t->tree->order[n->from];
    if (face == c->index || t->faces[face].back)
        return 0;
    if (array_reserve(&list->contacts, list->count + 1, &list->capacity, sizeof *list->contacts)
        < 0)
        return -1;
    list->count += (size_t)find_contact(c, t->faces, face, &list->contacts[list->count]);
    return 0;
}

struct bounds *contacts_normals(const struct face *faces, const struct bvh *tree)
{
    struct bounds *normals = malloc(tree->count * sizeof *normals);
    for (uint32_t i = normals ? tree->count : 0; i-- > 0;) { /* children stand behind parents */
        const struct bvh_node *n = &tree->nodes[i];
        struct bounds *own = &normals[i];
        if (n->children)
            bounds_empty(own);
        else {
            struct face f = faces[tree->order[n->from]];
            polygon_normal(f.vertex, f.vertices, own->low);
            memcpy(own->high, own->low, sizeof own->high);
        }
        for (uint32_t k = 0; k < n->children; k++)
            bounds_add(own, &normals[n->child + k]);
    }
    return normals;
}

int contacts_collect(struct contact_list *list, const struct cut_frame *frame,
                     const struct face *faces, const struct bvh *tree, const struct bounds *normals)
{
    list->count = 0;
    return collect_below(list, frame, &(struct contact_tree){faces, tree, normals}, 0);
}
