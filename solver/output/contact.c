/* contact.c - see contact.h.
 *
 * A face stands on the surface along a direction d, square to both normals, when the point a little
 * along d and a little up the face lies in it: by OUTPUT_REACH and OUTPUT_RISE times what counts as
 * touching, so that a wall that begins or ends at p leads one way, and one that hangs below the
 * surface no way at all. The surface ends along an edge of one of its faces when no other holds the
 * point a little along and a little beyond.
 * SPDX-License-Identifier: MIT */
#include "output/contact.h"

#include <string.h>

#include "kernel/constants.h"
#include "kernel/hemisphere.h"

/* The faces whose boxes come near the point. */
struct near {
    const struct solution *solution;
    const double *p;
    double reach;
    uint32_t face[CONTACT_FACES];
    int count;
};

static void find_near(struct near *n, const struct element *e)
{
    for (int k = 0; k < 3; k++) {
        double low = e->vertex[0][k], high = low;
        for (int i = 1; i < (e->vertices ? e->vertices : 2); i++) {
            low = fmin(low, e->vertex[i][k]);
            high = fmax(high, e->vertex[i][k]);
        }
        if (n->p[k] < low - n->reach || n->p[k] > high + n->reach)
            return;
    }
    for (uint32_t i = 0; !e->vertices && i < e->children; i++)
        find_near(n, &n->solution->tree.elements[e->child + i]);
    if (e->vertices && n->count < CONTACT_FACES)
        n->face[n->count++] = e->face;
}

/* Does face f with normal n hold q, or come nearer than touch? */
static int in_face(const struct RadFace *f, const double n[3], const double q[3], double touch)
{
    if (fabs(height3(q, f->vertex[0], n)) > touch)
        return 0;
    for (uint32_t i = 0; i < f->vertices; i++) {
        const double *a = f->vertex[i], *b = f->vertex[i + 1 < f->vertices ? i + 1 : 0];
        double e[3], w[3], c[3];
        sub3(e, b, a);
        sub3(w, q, a);
        cross3(c, e, w);
        if (dot3(c, n) < -touch * length3(e))
            return 0;
    }
    return 1;
}

static void add_direction(struct contact *c, const double d[3])
{
    for (int i = 0; i < c->directions; i++)
        if (dot3(c->direction[i], d) > OUTPUT_SAME_LINE)
            return;
    if (c->directions < CONTACT_DIRECTIONS)
        memcpy(c->direction[c->directions++], d, 3 * sizeof *d);
}

static const double *normal_of(const struct solution *solution, uint32_t face)
{
    return element_of_face(solution, face)->normal;
}

/* Face g stands on the surface with that normal. */
static void add_standing(struct contact *c, const struct solution *solution, uint32_t g,
                         const double normal[3], const double p[3], double touch)
{
    const double *n = normal_of(solution, g);
    double along[3], up[3], height = height3(p, solution->surfaces.faces[g].vertex[0], n);
    cross3(along, normal, n);
    double sine = length3(along);
    if (sine < CUT_PARALLEL || fabs(height) > touch)
        return;
    for (int k = 0; k < 3; k++) {
        along[k] /= sine;
        up[k] = (normal[k] - dot3(normal, n) * n[k]) / sine;
    }
    for (int side = 0; side < 2; side++) {
        double q[3];
        for (int k = 0; k < 3; k++) {
            along[k] = -along[k];
            q[k] = p[k] - height * n[k] + touch * (OUTPUT_REACH * along[k] + OUTPUT_RISE * up[k]);
        }
        if (in_face(&solution->surfaces.faces[g], n, q, touch))
            add_direction(c, along);
    }
}

/* The edges of face g, of the surface, beyond which the surface ends. */
static void add_border(struct contact *c, const struct solution *solution, uint32_t g,
                       const double p[3], double touch)
{
    const struct RadFace *f = &solution->surfaces.faces[g];
    const double *n = normal_of(solution, g);
    for (uint32_t i = 0; i < 2 * f->vertices; i++) {
        const double *a = f->vertex[i / 2], *b = f->vertex[i / 2 + 1 < f->vertices ? i / 2 + 1 : 0];
        double e[3], w[3], d[3], out[3], q[3];
        sub3(e, b, a);
        sub3(w, p, a);
        cross3(d, e, w);
        double size = length3(e);
        if (!(size > 0) || length3(d) > touch * size)
            continue;
        cross3(out, e, n);
        sub3(d, i & 1 ? b : a, p);
        double rest = length3(d);
        if ((i & 1 ? dot3(d, e) : -dot3(d, e)) <= 0 || rest <= OUTPUT_REACH * touch)
            continue;
        for (int k = 0; k < 3; k++) {
            d[k] /= rest;
            q[k] = p[k] + touch * (OUTPUT_REACH * d[k] + OUTPUT_RISE * out[k] / size);
        }
        int more = 0;
        for (int j = 0; j < c->faces && !more; j++)
            more = in_face(&solution->surfaces.faces[c->face[j]], normal_of(solution, c->face[j]),
                           q, touch);
        if (!more)
            add_direction(c, d);
    }
}

static double angle(const struct hemisphere *over, const double v[3])
{
    return atan2(dot3(v, over->v), dot3(v, over->u));
}

void contact_at(struct contact *c, const struct solution *solution, uint32_t f, const double p[3],
                double touch)
{
    const double *normal = normal_of(solution, f);
    const struct hemisphere over = hemisphere_over(normal);
    struct near near = {
        .solution = solution, .p = p, .reach = (OUTPUT_REACH + OUTPUT_RISE + 1) * touch};
    find_near(&near, &solution->tree.elements[0]);
    c->faces = c->directions = 0;
    for (int i = 0; i < near.count; i++) {
        const struct RadFace *g = &solution->surfaces.faces[near.face[i]];
        if (g->material == solution->surfaces.faces[f].material
            && dot3(normal_of(solution, near.face[i]), normal) > OUTPUT_SAME_PLANE
            && in_face(g, normal_of(solution, near.face[i]), p, touch))
            c->face[c->faces++] = near.face[i];
        else if (!g->back)
            add_standing(c, solution, near.face[i], normal, p, touch);
    }
    for (int i = 0; i < c->faces; i++)
        add_border(c, solution, c->face[i], p, touch);
    for (int i = 1; i < c->directions; i++)
        for (int j = i; j > 0 && angle(&over, c->direction[j]) < angle(&over, c->direction[j - 1]);
             j--) {
            double keep[3];
            memcpy(keep, c->direction[j], sizeof keep);
            memcpy(c->direction[j], c->direction[j - 1], sizeof keep);
            memcpy(c->direction[j - 1], keep, sizeof keep);
        }
}

int contact_sector(const double normal[3], int count, const double (*direction)[3],
                   const double v[3])
{
    const struct hemisphere over = hemisphere_over(normal);
    double at = angle(&over, v);
    int sector = 0;
    if (count < 2)
        return 0;
    while (sector < count && angle(&over, direction[sector]) <= at)
        sector++;
    return sector % count;
}
