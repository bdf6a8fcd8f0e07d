/* shaft.h - the shaft between two surfaces, and what it says of a face that may stand in it.
 *
 * The shaft is the convex hull of the two ends: the elements' mutually facing parts, moved off their surfaces by
 * host.ray_offset, which are just the points between which rays are cast. Its facets are the planes of the
 * ends and planes through an edge of one end and the corner of the other that is outermost about that edge; each is moved
 * out to the farthest corner, so that rounding makes the shaft larger, never smaller.
 * [Haines & Wallace 1994, for boxes; the hull of two convex polygons: derived here]
 *
 * Precise answers rest on two statements.
 *
 * A face that does not meet the shaft stops no ray. `meets` is 0 when nothing of the face's polygon is left within `margin`
 * of all facets, or when the shaft lies on one side of the face's plane. Then rays can at most end in that plane, as
 * on a floor that the emitter stands on, or run along it, and that set of rays has measure 0; so an element's own
 * face, faces in its plane and walls that bound both elements stop nothing. But an end that lies flat on a face, less
 * than `margin` away, may be under it for a ray caster: such a face is said to meet.
 *
 * A face that covers the shaft stops all rays. Let the ends lie strictly on either side of its plane. For a fixed
 * point y of one end, c(x, y), where the ray from x meets the plane, is a central projection of x, and such maps
 * convex sets in front of their centre to convex sets: so c(x, y) lies in the hull of the c(x_i, y) over the other end's
 * corners x_i. And so does c(x_i, y), for fixed x_i, in the hull of the c(x_i, y_j). Hence if all c(x_i, y_j) lie in
 * the face, which is convex, so do all c(x, y). They must lie in it by margin |y - x| / (|h(x)| + |h(y)|), h the heights over
 * the plane: rounding of the ray's ends moves c by that factor; the factor is quasi-convex in (x, y), thus
 * largest at corners.
 *
 * The margin is 32 to 64 times what the coordinates lose in single precision. It shrinks with every split of either
 * element by 64 roundings or more of what is computed here, and `touch` grows likewise: so what does not meet the shaft
 * of a pair, does not meet the shaft of a pair below it, and a list of candidates may be filtered, or made anew, with the same
 * result. A quad bent by more than an eighth of the least margin is taken for the two triangles that a ray caster makes of it.
 * Fails (answers "meets" for nothing): corners on the line of an edge, where no plane is to be had; bent quads.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_SHAFT_H
#define TERM_SHAFT_H

#include "discussion.h"
#include "terms/cut.h"

enum { SHAFT_DEPTHS = 48 }; /* splits below two faces (tools/can_split.h) */

/* Adds the plane with normal n, of any length, at the farthest corner of both ends. */
static inline void shaft_plane(struct shaft *shaft, const double n[3])
{
    double size = length3(n), *normal = shaft->normal[shaft->planes], most = -INFINITY;
    int end, i;
    if (!(size > 0) || shaft->planes == SHAFT_PLANES)
        return;
    for (i = 0; i < 3; i++)
        normal[i] = n[i] / size;
    for (end = 0; end < 2; end++)
        for (i = 0; i < shaft->points[end]; i++) {
            double height = dot3(normal, shaft->end[end][i]);
            most = height > most ? height : most;
        }
    shaft->offset[shaft->planes++] = most;
}

/* The planes about the edge from a to b of one end: through the outermost corner of the other end in front of the end's own
 * plane, and the outermost one behind it. */
static inline void shaft_edge(struct shaft *shaft, int end, const double a[3], const double b[3])
{
    const double *n = shaft->facing[end], (*corner)[3] = (const double (*)[3])shaft->end[1 - end];
    double e[3], out[3], best[2][2] = { { -1, 0 }, { -1, 0 } }; /* by side: outward and upward of the best so far */
    int chosen[2] = { -1, -1 }, i, k;
    sub3(e, b, a);
    cross3(out, e, n);
    for (i = 0; i < shaft->points[1 - end]; i++) {
        double w[3], outward, upward, turn;
        int behind;
        sub3(w, corner[i], a);
        outward = dot3(out, w);
        upward = dot3(n, w);
        behind = upward < 0;
        turn = best[behind][0] * upward - best[behind][1] * outward;
        if (behind ? turn > 0 : turn < 0) {
            best[behind][0] = outward;
            best[behind][1] = upward;
            chosen[behind] = i;
        }
    }
    for (k = 0; k < 2; k++) {
        double w[3], normal[3];
        if (chosen[k] < 0)
            continue;
        sub3(w, corner[chosen[k]], a);
        if (k)
            cross3(normal, w, e);
        else
            cross3(normal, e, w);
        if (dot3(normal, normal) > 1e-14 * dot3(e, e) * dot3(w, w))
            shaft_plane(shaft, normal);
    }
}

/* One end: p, the part of e that faces the other element, moved off. Returns how many edges it has. */
static inline int shaft_end(struct shaft *shaft, int end, const struct polygon *p, const struct element *e, double offset)
{
    double (*v)[3] = shaft->end[end], gap[3];
    int i, k, n = p->n;
    for (k = 0; k < 3; k++) {
        shaft->facing[end][k] = e->normal[k];
        for (i = 0; i < n; i++)
            v[i][k] = p->v[i][k] + offset * e->normal[k];
        gap[k] = n == 4 ? v[0][k] - v[1][k] + v[2][k] - v[3][k] : 0;
    }
    shaft->points[end] = n;
    /* Rays start on the parallelogram of three corners where a quad is nearly one (terms/visibility.h). */
    if (n == 4 && length3(gap) > (1 / 67108864.0) * offset) {
        for (k = 0; k < 3; k++)
            v[4][k] = v[2][k] - gap[k];
        shaft->points[end] = 5;
    }
    return n;
}

/* The shaft between two surfaces, the same both ways. Returns 0, and makes none, when no parts of them face each other. */
static inline int shaft_open(struct shaft *shaft, const struct element *receiver, const struct element *emitter,
                             const struct host *host)
{
    const struct element *r = receiver->id < emitter->id ? receiver : emitter, *s = r == receiver ? emitter : receiver;
    const double offset = host->ray_offset, deep = (r->depth + s->depth) * (1.0 / SHAFT_DEPTHS);
    struct polygon p, q;
    int edges[2], end, i, k;
    polygon_clip(&p, (const double (*)[3])r->vertex, r->vertices, s->centre, s->normal);
    polygon_clip(&q, (const double (*)[3])s->vertex, s->vertices, r->centre, r->normal);
    if (p.n == 0 || q.n == 0)
        return 0;
    shaft->planes = 0;
    shaft->margin = offset * (0.5 - 0.25 * deep);
    shaft->touch = offset * (1 / 16777216.0) * (1 + deep);
    shaft->flat = offset * 0.03125;
    edges[0] = shaft_end(shaft, 0, &p, r, offset);
    edges[1] = shaft_end(shaft, 1, &q, s, offset);
    for (k = 0; k < 3; k++) {
        double low = shaft->end[0][0][k], high = low;
        for (end = 0; end < 2; end++)
            for (i = 0; i < shaft->points[end]; i++) {
                double x = shaft->end[end][i][k];
                low = x < low ? x : low;
                high = x > high ? x : high;
            }
        shaft->low[k] = low - shaft->margin;
        shaft->high[k] = high + shaft->margin;
    }
    for (end = 0; end < 2; end++) {
        double back[3];
        for (k = 0; k < 3; k++)
            back[k] = -shaft->facing[end][k];
        shaft_plane(shaft, back);
        for (i = 0; i < edges[end]; i++)
            shaft_edge(shaft, end, shaft->end[end][i], shaft->end[end][i + 1 < edges[end] ? i + 1 : 0]);
    }
    return 1;
}

/* Is a box wholly outside? For hosts that keep their faces in boxes. */
static inline int shaft_misses_box(const struct shaft *shaft, const double low[3], const double high[3])
{
    int i, k;
    for (k = 0; k < 3; k++)
        if (low[k] > shaft->high[k] || high[k] < shaft->low[k])
            return 1;
    for (i = 0; i < shaft->planes; i++) {
        const double *n = shaft->normal[i];
        double nearest = n[0] * (n[0] > 0 ? low[0] : high[0]) + n[1] * (n[1] > 0 ? low[1] : high[1])
                       + n[2] * (n[2] > 0 ? low[2] : high[2]);
        if (nearest > shaft->offset[i] + shaft->margin)
            return 1;
    }
    return 0;
}

/* Unit normal of a face with 3 or 4 corners. Returns 0 when it has no area. */
static inline int shaft_normal(const double (*v)[3], int n, double normal[3])
{
    double a[3], b[3], size;
    int k;
    sub3(a, v[n == 4 ? 2 : 1], v[0]);
    sub3(b, v[n == 4 ? 3 : 2], v[n == 4 ? 1 : 0]);
    cross3(normal, a, b);
    size = length3(normal);
    for (k = 0; k < 3 && size > 0; k++)
        normal[k] /= size;
    return size > 0;
}

/* Is a quad's fourth corner off the plane that its diagonals span? */
static inline int shaft_bent(const struct shaft *shaft, const double (*v)[3], int n, const double normal[3])
{
    return n == 4 && fabs(height3(v[1], v[0], normal)) > shaft->flat;
}

/* Does all of the shaft lie on one side of a plane, so that rays can only end there? */
static inline int shaft_beside(const struct shaft *shaft, const double on[3], const double normal[3])
{
    double low = INFINITY, high = -INFINITY;
    int end, i;
    for (end = 0; end < 2; end++) {
        double nearest = INFINITY, across[3];
        for (i = 0; i < shaft->points[end]; i++) {
            double h = height3(shaft->end[end][i], on, normal);
            low = h < low ? h : low;
            high = h > high ? h : high;
            nearest = fabs(h) < nearest ? fabs(h) : nearest;
        }
        cross3(across, normal, shaft->facing[end]);
        if (nearest < shaft->margin && dot3(across, across) < 1 / 1048576.0)
            return 0;
    }
    return low >= -shaft->touch || high <= shaft->touch;
}

/* May a face with 3 or 4 corners stop a ray? 0 is precise. What is left of it within the shaft is put in *inside, when that is not NULL. */
static inline int shaft_meets(const struct shaft *shaft, const double (*v)[3], int n, struct cut *inside)
{
    struct cut part[2];
    double normal[3];
    static const double origin[3] = { 0, 0, 0 };
    int i, k, now = 0;
    if (!shaft_normal(v, n, normal))
        return 0;
    if (shaft_bent(shaft, v, n, normal)) { /* as a ray caster splits it */
        double first[3][3], second[3][3];
        for (k = 0; k < 3; k++) {
            first[0][k] = v[0][k];
            first[1][k] = second[2][k] = v[1][k];
            first[2][k] = second[1][k] = v[3][k];
            second[0][k] = v[2][k];
        }
        for (i = 0; i < 2; i++) {
            const double (*t)[3] = (const double (*)[3])(i ? second : first);
            if (!shaft_normal(t, 3, normal) || shaft_beside(shaft, t[0], normal))
                continue;
            cut_from(&part[0], t, 3);
            now = 0;
            for (k = 0; k < shaft->planes && part[now].n > 0; k++)
                now ^= !cut_below(&part[now ^ 1], &part[now], origin, shaft->normal[k], shaft->offset[k] + shaft->margin);
            if (part[now].n > 0) {
                if (inside)
                    *inside = part[now];
                return 1;
            }
        }
        return 0;
    }
    if (shaft_beside(shaft, v[0], normal))
        return 0;
    cut_from(&part[0], v, n);
    for (i = 0; i < shaft->planes && part[now].n > 0; i++)
        now ^= !cut_below(&part[now ^ 1], &part[now], origin, shaft->normal[i], shaft->offset[i] + shaft->margin);
    if (part[now].n > 0 && inside)
        *inside = part[now];
    return part[now].n > 0;
}

/* Does a face stop every ray? 1 is precise. */
static inline int shaft_covered(const struct shaft *shaft, const double (*v)[3], int n)
{
    double normal[3], height[2][SHAFT_POINTS], steep = 0, side[4][3], room;
    int i, j, k, end, front;
    if (!shaft_normal(v, n, normal) || shaft_bent(shaft, v, n, normal))
        return 0;
    front = height3(shaft->end[0][0], v[0], normal) > 0;
    for (end = 0; end < 2; end++)
        for (i = 0; i < shaft->points[end]; i++) {
            double h = height3(shaft->end[end][i], v[0], normal);
            height[end][i] = end ^ front ? h : -h;
            if (!(height[end][i] > shaft->margin))
                return 0;
        }
    for (i = 0; i < shaft->points[0]; i++)
        for (j = 0; j < shaft->points[1]; j++) {
            double ray[3], slope;
            sub3(ray, shaft->end[1][j], shaft->end[0][i]);
            slope = length3(ray) / (height[0][i] + height[1][j]);
            steep = slope > steep ? slope : steep;
        }
    room = shaft->margin * steep;
    for (k = 0; k < n; k++) { /* inward, length 1 */
        double e[3], size;
        sub3(e, v[k + 1 < n ? k + 1 : 0], v[k]);
        cross3(side[k], normal, e);
        size = length3(side[k]);
        if (!(size > 0))
            return 0;
        side[k][0] /= size;
        side[k][1] /= size;
        side[k][2] /= size;
    }
    for (i = 0; i < shaft->points[0]; i++)
        for (j = 0; j < shaft->points[1]; j++) {
            const double *a = shaft->end[0][i], *b = shaft->end[1][j];
            double t = height[0][i] / (height[0][i] + height[1][j]), c[3];
            for (k = 0; k < 3; k++)
                c[k] = a[k] + t * (b[k] - a[k]);
            for (k = 0; k < n; k++)
                if (!(height3(c, v[k], side[k]) > room))
                    return 0;
        }
    return 1;
}

#endif
