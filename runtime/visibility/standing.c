/* standing.c - see standing.h.
 *
 * Where a solid ends, one of its faces stands. Points of a convex surface that lie inside and
 * outside of solids have such a face between them: it reaches into the flat prism over the surface.
 * A face that stays outside of one of the prism's planes does not, such as a wall along the
 * surface's edge, or what lies behind it. A walk over the clusters finds out whether there is any
 * that does not. [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "geometry.h"
#include "hierarchy/reach.h"
#include "kernel/constants.h"
#include "visibility/standing.h"

/* What lies over e, by planes whose normals point outward, and its box. */
struct prism {
    double on[6][3], normal[6][3];
    int planes;
    uint32_t face; /* of e: a bent one may reach into it, and bounds no solid there */
    double low[3], high[3];
};

static void add_plane(struct prism *p, const double on[3], const double normal[3], double sign)
{
    double length = length3(normal);
    if (!(length > 0)) /* a side as short as nothing */
        return;
    for (int k = 0; k < 3; k++) {
        p->on[p->planes][k] = on[k];
        p->normal[p->planes][k] = sign * normal[k] / length;
    }
    p->planes++;
}

/* From `low` to `height` above e. */
static struct prism prism_over(const struct element *e, double low, double height)
{
    struct prism p = {.face = e->face,
                      .low = {INFINITY, INFINITY, INFINITY},
                      .high = {-INFINITY, -INFINITY, -INFINITY}};
    double foot[3], top[3];
    for (int k = 0; k < 3; k++) {
        foot[k] = e->vertex[0][k] + low * e->normal[k];
        top[k] = e->vertex[0][k] + height * e->normal[k];
    }
    add_plane(&p, foot, e->normal, -1);
    add_plane(&p, top, e->normal, 1);
    for (int i = 0; i < e->vertices; i++) {
        const double *a = e->vertex[i], *b = e->vertex[(i + 1) % e->vertices];
        double side[3], out[3];
        sub3(side, b, a);
        cross3(out, side, e->normal);
        add_plane(&p, a, out, 1);
        for (int k = 0; k < 3; k++) {
            double far = a[k] + height * e->normal[k];
            p.low[k] = fmin(p.low[k], fmin(a[k], far));
            p.high[k] = fmax(p.high[k], fmax(a[k], far));
        }
    }
    return p;
}

/* Does the face stay outside of one of the planes? By `off` it may reach in: rounding moves it. */
static int stays_out(const struct prism *p, const struct element *face, double off)
{
    for (int i = 0; i < p->planes; i++) {
        double high = -INFINITY, low = INFINITY;
        polygon_reach((const double(*)[3])face->vertex, face->vertices, p->on[i], p->normal[i],
                      &high, &low);
        if (low >= -off)
            return 1;
    }
    return 0;
}

/* Does a box? Then all faces in it do: what they may reach in is left for rounding. */
static int box_stays_out(const struct prism *p, const double (*box)[3])
{
    for (int i = 0; i < p->planes; i++) {
        double high, low;
        box_reach(box, p->on[i], p->normal[i], &high, &low);
        if (low >= 0)
            return 1;
    }
    return 0;
}

static int reaches_in(const struct hierarchy *h, const struct prism *p, double off, uint32_t index)
{
    const struct element *e = &h->elements[index];
    if (e->vertices && h->face_element[e->face] == index)
        return e->face != p->face && face_shades(&h->faces[e->face]) && !stays_out(p, e, off);
    for (int k = 0; k < 3 && !e->vertices; k++)
        if (e->vertex[0][k] > p->high[k] || e->vertex[1][k] < p->low[k])
            return 0;
    if (!e->vertices && box_stays_out(p, (const double(*)[3])e->vertex))
        return 0;
    for (uint32_t c = 0; c < e->children; c++)
        if (reaches_in(h, p, off, e->child + c))
            return 1;
    return 0;
}

int standing_may(const struct hierarchy *h, const struct element *e, double off)
{
    const struct prism p = prism_over(e, off, off + STANDING_GAP * e->radius);
    return reaches_in(h, &p, off, 0);
}

int standing_within(const struct hierarchy *h, const struct element *e, double off)
{
    /* what may be there by rounding, a quarter of off, lies below or at the border */
    const struct prism p = prism_over(e, 0.5 * off, 2 * off);
    return reaches_in(h, &p, 0.25 * off, 0);
}
