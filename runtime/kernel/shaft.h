/* shaft.h - the shaft between two surfaces, and what it says of a face that may stand in it.
 *
 * The shaft is the convex hull of the two ends: the elements' mutually facing parts, moved off
 * their surfaces by host.ray_offset, between which rays are cast. Its facets are the planes of the
 * ends and planes through an edge of one end and the corner of the other that is outermost about
 * that edge; the sides of its box bound it too. Each plane is moved out to the farthest corner, so
 * that rounding makes the shaft larger, never smaller.
 * [Haines & Wallace 1994, for boxes; the hull of two convex polygons: derived here]
 *
 * Precise answers rest on two statements.
 *
 * A face that does not meet the shaft stops no ray. `meets` is 0 when the shaft lies on one side of
 * the face's plane, or holds nothing of the face's polygon, made larger by `grow` all round and
 * above and below. In the first case rays can at most end in that plane, as on a floor that the
 * emitter stands on, or run along it, and that set of rays has measure 0; so an element's own face,
 * faces in its plane and walls that bound both elements stop nothing. But an end that lies flat on
 * a face, less than `margin` away, may be under it for a ray caster: such a face is said to meet.
 *
 * A face that covers the shaft stops all rays. Let the ends lie strictly on either side of its
 * plane. For a fixed point y of one end, c(x, y), where the ray from x meets the plane, is a
 * central projection of x, and such maps convex sets in front of their centre to convex sets: so
 * c(x, y) lies in the hull of the c(x_i, y) over the other end's corners x_i. And so does c(x_i,
 * y), for fixed x_i, in the hull of the c(x_i, y_j). Hence if all c(x_i, y_j) lie in the face,
 * which is convex, so do all c(x, y). They must lie in it by margin |y - x| / (|h(x)| + |h(y)|), h
 * the heights over the plane: rounding of the ray's ends moves c by that factor; the factor is
 * quasi-convex in (x, y), thus largest at corners.
 *
 * `grow` is 32 times what the coordinates lose in single precision, `margin` that or twice that. A
 * shaft within a shaft meets no other face: the hulls are nested, the enlarged faces depend on
 * nothing, and every tolerance changes by some roundings (of large coordinates too) with each split
 * of either element, so that the deeper pair has the stricter one. Hence a list of candidates may
 * be filtered, or made anew, with the same result. A quad bent by more than an eighth of `grow` is
 * taken for the two triangles that a ray caster makes of it.
 * Fails (says that a face meets, or does not cover, though it is not so): corners almost on the
 * line of an edge, where no plane is to be had; bent quads.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_SHAFT_H
#define KERNEL_SHAFT_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/cut.h"
#include "kernel/shaft_pierced.h"
#include "kernel/shaft_planes.h"

enum { SHAFT_DEPTHS = 48 }; /* splits below two faces (tools/can_split.h) */

/* The planes about the edge from a to b of one end: through the outermost corner of the other end
 * in front of the end's own plane, and the outermost one behind it. */
static inline void shaft_edge(struct shaft *shaft, int end, const double a[3], const double b[3])
{
    const double *n = shaft->facing[end], (*corner)[3] = (const double(*)[3])shaft->end[1 - end];
    /* by side: outward and upward of the best so far */
    double e[3], out[3], best[2][2] = {{-1, 0}, {-1, 0}};
    int chosen[2] = {-1, -1};
    sub3(e, b, a);
    cross3(out, e, n);
    for (int i = 0; i < shaft->points[1 - end]; i++) {
        double w[3];
        sub3(w, corner[i], a);
        double outward = dot3(out, w);
        double upward = dot3(n, w);
        int behind = upward < 0;
        double turn = best[behind][0] * upward - best[behind][1] * outward;
        if (behind ? turn > 0 : turn < 0) {
            best[behind][0] = outward;
            best[behind][1] = upward;
            chosen[behind] = i;
        }
    }
    for (int k = 0; k < 2; k++) {
        double w[3], normal[3];
        if (chosen[k] < 0)
            continue;
        sub3(w, corner[chosen[k]], a);
        if (k)
            cross3(normal, w, e);
        else
            cross3(normal, e, w);
        if (dot3(normal, normal) > SHAFT_LINE * dot3(e, e) * dot3(w, w))
            shaft_planes_add(shaft, normal);
    }
}

/* One end: p, the part of e that faces the other element, moved off. */
static inline void shaft_end(struct shaft *shaft, int end, const struct polygon *p,
                             const struct element *e, double offset)
{
    for (int k = 0; k < 3; k++) {
        shaft->facing[end][k] = e->normal[k];
        for (int i = 0; i < p->n; i++)
            shaft->end[end][i][k] = p->v[i][k] + offset * e->normal[k];
    }
    shaft->points[end] = p->n;
}

/* Do the parts of e lie in e's plane, so that their shafts lie in its shafts? Not those of a
 * bent quad. */
static inline int shaft_nests(const struct shaft *shaft, const struct element *e)
{
    int nests = 1;
    for (int i = 0; i < e->vertices; i++)
        nests &= fabs(height3(e->vertex[i], e->centre, e->normal)) <= shaft->nests;
    return nests;
}

/* Does any part of e rise above the plane of `other` by more than `limit`? */
static inline int shaft_rises(const struct element *e, const struct element *other, double limit)
{
    int rises = 0;
    for (int i = 0; i < e->vertices; i++)
        rises |= height3(e->vertex[i], other->centre, other->normal) > limit;
    return rises;
}

/* The ends of the shaft between two surfaces and the box around them, but no planes yet. Returns 0,
 * and makes nothing, when no parts of them face each other, as surfaces in one plane do not. */
static inline int shaft_ends(struct shaft *shaft, const struct element *receiver,
                             const struct element *emitter, const struct host *host)
{
    const struct element *r = receiver->id < emitter->id ? receiver : emitter,
                         *s = r == receiver ? emitter : receiver;
    const double offset = host->ray_offset,
                 deep = (r->depth + s->depth) * (1 / (double)SHAFT_DEPTHS);
    double under_r[3], under_s[3];
    struct polygon p, q;
    shaft->planes = 0;
    shaft->margin = offset * (SHAFT_MARGIN - SHAFT_MARGIN_FALL * deep);
    shaft->slack = offset * SHAFT_SLACK * (2 - deep);
    shaft->touch = offset * SHAFT_SLACK * (3 + deep); /* more than slack */
    if (!shaft_rises(r, s, shaft->touch) || !shaft_rises(s, r, shaft->touch))
        return 0;
    /* where one ends in the other's plane, rounding does not cut it */
    for (int k = 0; k < 3; k++) {
        under_r[k] = r->centre[k] - shaft->slack * r->normal[k];
        under_s[k] = s->centre[k] - shaft->slack * s->normal[k];
    }
    polygon_clip(&p, (const double(*)[3])r->vertex, r->vertices, under_s, s->normal);
    polygon_clip(&q, (const double(*)[3])s->vertex, s->vertices, under_r, r->normal);
    if (p.n == 0 || q.n == 0)
        return 0;
    shaft->grow = offset * SHAFT_GROW;
    shaft->nests = shaft->slack * (1 / 256.0); /* less than what it loses by a split */
    shaft->flat = offset * SHAFT_BENT;
    shaft->reach = offset * 0.5;
    shaft_end(shaft, 0, &p, r, offset);
    shaft_end(shaft, 1, &q, s, offset);
    for (int k = 0; k < 3; k++) {
        double low = shaft->end[0][0][k], high = low;
        for (int end = 0; end < 2; end++)
            for (int i = 0; i < shaft->points[end]; i++) {
                double x = shaft->end[end][i][k];
                low = x < low ? x : low;
                high = x > high ? x : high;
            }
        shaft->low[k] = low - shaft->reach;
        shaft->high[k] = high + shaft->reach;
    }
    return 1;
}

/* The planes, of a shaft that has ends. */
static inline void shaft_close(struct shaft *shaft)
{
    for (int k = 0; k < SHAFT_AXES; k++) {
        double axis[3] = {0, 0, 0};
        axis[k / 2] = k % 2 ? 1 : -1;
        shaft_planes_add(shaft, axis);
    }
    for (int end = 0; end < 2; end++) {
        double back[3];
        for (int k = 0; k < 3; k++)
            back[k] = -shaft->facing[end][k];
        shaft_planes_add(shaft, back);
        for (int i = 0; i < shaft->points[end]; i++)
            shaft_edge(shaft, end, shaft->end[end][i],
                       shaft->end[end][i + 1 < shaft->points[end] ? i + 1 : 0]);
    }
    shaft_planes_place(lanes_width(), shaft);
}

/* The shaft between two surfaces, the same both ways. Returns 0, and makes none, when no parts of
 * them face each other. */
static inline int shaft_open(struct shaft *shaft, const struct element *receiver,
                             const struct element *emitter, const struct host *host)
{
    if (!shaft_ends(shaft, receiver, emitter, host))
        return 0;
    shaft_close(shaft);
    return 1;
}

/* Is a box wholly outside? For hosts that keep their faces in boxes. */
static inline int shaft_misses_box(const struct shaft *shaft, const double low[3],
                                   const double high[3])
{
    for (int k = 0; k < 3; k++)
        if (low[k] > shaft->high[k] || high[k] < shaft->low[k])
            return 1;
    return shaft_planes_miss(lanes_width(), shaft, low, high);
}

/* Unit normal of a face with 3 or 4 corners. Returns 0 when it has no area. */
static inline int shaft_normal(const double (*v)[3], int n, double normal[3])
{
    double a[3], b[3];
    sub3(a, v[n == 4 ? 2 : 1], v[0]);
    sub3(b, v[n == 4 ? 3 : 2], v[n == 4 ? 1 : 0]);
    cross3(normal, a, b);
    double size = length3(normal);
    for (int k = 0; k < 3 && size > 0; k++)
        normal[k] /= size;
    return size > 0;
}

/* Is a quad's fourth corner off the plane that its diagonals span? */
static inline int shaft_bent(const struct shaft *shaft, const double (*v)[3], int n,
                             const double normal[3])
{
    return n == 4 && fabs(height3(v[1], v[0], normal)) > shaft->flat;
}

/* Do the boxes of a polygon and of one end overlap, within the margin? */
static inline int shaft_overlaps(const struct shaft *shaft, int end, const double (*v)[3], int n)
{
    for (int k = 0; k < 3; k++) {
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (int i = 0; i < n; i++) {
            low[0] = v[i][k] < low[0] ? v[i][k] : low[0];
            high[0] = v[i][k] > high[0] ? v[i][k] : high[0];
        }
        for (int i = 0; i < shaft->points[end]; i++) {
            double x = shaft->end[end][i][k];
            low[1] = x < low[1] ? x : low[1];
            high[1] = x > high[1] ? x : high[1];
        }
        if (low[0] > high[1] + shaft->margin || low[1] > high[0] + shaft->margin)
            return 0;
    }
    return 1;
}

/* How a polygon's plane lies to the shaft: 1: all of the shaft is on one side, so that rays can
 * only end in the plane; 0: it crosses; -1: an end lies flat on the polygon. */
static inline int shaft_side(const struct shaft *shaft, const double (*v)[3], int n,
                             const double normal[3])
{
    double low = INFINITY, high = -INFINITY;
    for (int end = 0; end < 2; end++) {
        double nearest = INFINITY;
        for (int i = 0; i < shaft->points[end]; i++) {
            double h = height3(shaft->end[end][i], v[0], normal);
            low = h < low ? h : low;
            high = h > high ? h : high;
            nearest = fabs(h) < nearest ? fabs(h) : nearest;
        }
        if (nearest < shaft->margin) {
            double across[3];
            cross3(across, normal, shaft->facing[end]);
            if (dot3(across, across) < SHAFT_PARALLEL && shaft_overlaps(shaft, end, v, n))
                return -1;
        }
    }
    return low >= -shaft->touch || high <= shaft->touch;
}

/* A polygon with its edges moved out by `grow`: mitred at right and blunt corners, cut off square
 * at sharp ones, so that it reaches at most sqrt 2 times as far. */
static inline void shaft_enlarge(struct cut *out, const double (*v)[3], int n,
                                 const double normal[3], double grow)
{
    out->n = 0;
    double along[4][3];
    for (int i = 0; i < n; i++) {
        sub3(along[i], v[i + 1 < n ? i + 1 : 0], v[i]);
        double size = length3(along[i]);
        for (int k = 0; k < 3; k++)
            along[i][k] = size > 0 ? along[i][k] / size : 0;
    }
    for (int i = 0; i < n; i++) {
        const double *a = along[i > 0 ? i - 1 : n - 1], *b = along[i];
        double turn = dot3(a, b), x[3], y[3], *p = out->v[out->n];
        cross3(x, a, normal); /* outward */
        cross3(y, b, normal);
        if (turn >= 0) {
            for (int k = 0; k < 3; k++)
                p[k] = v[i][k] + grow / (1 + turn) * (x[k] + y[k]);
            out->n++;
        } else {
            for (int k = 0; k < 3; k++) {
                p[k] = v[i][k] + grow * (x[k] + a[k]);
                p[k + 3] = v[i][k] + grow * (y[k] - b[k]);
            }
            out->n += 2;
        }
    }
}

/* What is left of a polygon, moved by `up` along its normal, within the shaft. Returns 0 when
 * nothing is. */
static inline int shaft_inside(const struct shaft *shaft, uint64_t planes, const struct cut *whole,
                               const double normal[3], double up, struct cut *inside)
{
    static const double origin[3] = {0, 0, 0};
    struct cut part[2];
    int now = 0;
    part[0].n = whole->n;
    for (int i = 0; i < whole->n; i++)
        for (int k = 0; k < 3; k++)
            part[0].v[i][k] = whole->v[i][k] + up * normal[k];
    for (int i = 0; i < shaft->planes && part[now].n > 0; i++)
        if (planes >> i & 1) {
            const double plane[3] = {shaft->normal[0][i], shaft->normal[1][i], shaft->normal[2][i]};
            now ^= !cut_below(&part[now ^ 1], &part[now], origin, plane,
                              shaft->offset[i] + shaft->slack);
        }
    if (inside)
        *inside = part[now];
    return part[now].n > 0;
}

/* Which planes, a bit for each, may cut a polygon that is moved up or down by no more than `grow`?
 * Returns 0 when one of them has all of it outside. */
static inline int shaft_cutting(const struct shaft *shaft, const struct cut *whole,
                                uint64_t *planes)
{
    const double reach = shaft->grow * 1.001; /* more than rounding */
    return shaft_planes_cut(lanes_width(), shaft, shaft->slack, reach, (const double(*)[3])whole->v,
                            whole->n, planes);
}

/* Does one of the planes have all of a polygon outside? Most polygons are, which saves the
 * rest. Two offsets are more than an enlarged polygon or an end's margin
 * reach. */
static inline int shaft_far(const struct shaft *shaft, const double (*v)[3], int n)
{
    const double out = 4 * shaft->reach;
    /* the planes of the axes say so of half of all faces, most often for two comparisons an axis */
    for (int k = 0; k < 3; k++) {
        const double low = -shaft->offset[2 * k] - out, high = shaft->offset[2 * k + 1] + out;
        const int under = (v[0][k] < low), over = (v[0][k] > high);
        int i = 1;
        if (!under && !over)
            continue;
        while (i < n && (under ? v[i][k] < low : v[i][k] > high))
            i++;
        if (i == n)
            return 1;
    }
    return shaft_planes_far(lanes_width(), shaft, out, v, n);
}

/* The same as shaft_meets of a flat polygon, whose unit normal is given. */
static inline int shaft_meets_flat(const struct shaft *shaft, const double (*v)[3], int n,
                                   const double normal[3], struct cut *inside)
{
    struct cut large;
    uint64_t planes;
    const int side = shaft_side(shaft, v, n, normal);
    if (side > 0)
        return 0;
    if (!inside && (side < 0 || shaft_pierced(shaft, v, n, normal)))
        return 1;
    shaft_enlarge(&large, v, n, normal, shaft->grow);
    if (side < 0) {
        if (inside)
            *inside = large;
        return 1;
    }
    return shaft_cutting(shaft, &large, &planes)
           && (shaft_inside(shaft, planes, &large, normal, 0, inside)
               || shaft_inside(shaft, planes, &large, normal, shaft->grow, inside)
               || shaft_inside(shaft, planes, &large, normal, -shaft->grow, inside));
}

/* What shaft_meets says, as far as it needs no planes, which cost more to make than this: 1, 0, or
 * -1: not known. What is pierced is not far. */
static inline int shaft_meets_early(const struct shaft *shaft, const double (*v)[3], int n)
{
    double normal[3];
    if (!shaft_normal(v, n, normal))
        return 0;
    if (shaft_bent(shaft, v, n, normal))
        return -1;
    const int side = shaft_side(shaft, v, n, normal);
    if (side > 0)
        return 0;
    return side == 0 && shaft_pierced(shaft, v, n, normal) ? 1 : -1;
}

/* May a face with 3 or 4 corners stop a ray? 0 is precise. What of it may is put in *inside,
 * when that is not NULL. */
static inline int shaft_meets(const struct shaft *shaft, const double (*v)[3], int n,
                              struct cut *inside)
{
    double part[3][3], normal[3];
    if (shaft_far(shaft, v, n) || !shaft_normal(v, n, normal))
        return 0;
    if (!shaft_bent(shaft, v, n, normal))
        return shaft_meets_flat(shaft, v, n, normal, inside);
    for (int i = 0; i < 2; i++) { /* as a ray caster splits it: 0 1 3 and 2 3 1 */
        const int corner[3] = {i ? 2 : 0, i ? 3 : 1, i ? 1 : 3};
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++)
                part[c][k] = v[corner[c]][k];
        if (shaft_normal((const double(*)[3])part, 3, normal)
            && shaft_meets_flat(shaft, (const double(*)[3])part, 3, normal, inside))
            return 1;
    }
    return 0;
}

/* Does a face stop every ray? 1 is precise. */
static inline int shaft_covered(const struct shaft *shaft, const double (*v)[3], int n)
{
    double normal[3], height[2][POLYGON_MAX], steep = 0, side[4][3];
    if (!shaft_normal(v, n, normal) || shaft_bent(shaft, v, n, normal))
        return 0;
    int front = height3(shaft->end[0][0], v[0], normal) > 0;
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < shaft->points[end]; i++) {
            double h = height3(shaft->end[end][i], v[0], normal);
            height[end][i] = end ^ front ? h : -h;
            if (!(height[end][i] > shaft->margin))
                return 0;
        }
    for (int i = 0; i < shaft->points[0]; i++)
        for (int j = 0; j < shaft->points[1]; j++) {
            double ray[3];
            sub3(ray, shaft->end[1][j], shaft->end[0][i]);
            double slope = length3(ray) / (height[0][i] + height[1][j]);
            steep = slope > steep ? slope : steep;
        }
    double room = shaft->margin * steep;
    for (int k = 0; k < n; k++) { /* inward, length 1 */
        double e[3];
        sub3(e, v[k + 1 < n ? k + 1 : 0], v[k]);
        cross3(side[k], normal, e);
        double size = length3(side[k]);
        if (!(size > 0))
            return 0;
        side[k][0] /= size;
        side[k][1] /= size;
        side[k][2] /= size;
    }
    for (int i = 0; i < shaft->points[0]; i++)
        for (int j = 0; j < shaft->points[1]; j++) {
            const double *a = shaft->end[0][i], *b = shaft->end[1][j];
            double t = height[0][i] / (height[0][i] + height[1][j]), c[3];
            for (int k = 0; k < 3; k++)
                c[k] = a[k] + t * (b[k] - a[k]);
            for (int k = 0; k < n; k++)
                if (!(height3(c, v[k], side[k]) > room))
                    return 0;
        }
    return 1;
}

#endif
