/* contour_factor.h - the exchange area of two flat convex polygons by the double contour integral,
 *     A_p F_pq = (1 / 2 pi) sum over edges e of p, f of q of  e.f / |e||f|  int int ln |x - y| ds
 *     dt    (m2),
 * nothing between them, each wholly in front of the other. [Sparrow 1963]
 *
 * Of parallel edges the double integral is closed: with offset u along them and h across,
 * differences of
 *     G(u) = (u^2 - h^2)/4 ln(u^2 + h^2) + u h atan(u/h) - 3/4 u^2.
 * Of others the inner integral is closed and the outer one adaptive: five Gauss points on the whole
 * against five on either half. The integrand is smooth but for the points of the outer edge that
 * are nearest to the inner edge's ends and to its line. The edge is cut there first; bisection then
 * closes in on them as on the ends of an interval.
 *
 * Measured against closed forms (tests/runtime/check_closed_forms.c), parallel and perpendicular
 * rectangles with sides and distances from .01 to 100 at random: F is wrong by 3e-10 at the most;
 * 1e-6 relative for slivers 1 : 10,000.
 *
 * Fails: rounding costs as many digits as the ratio of the longest side to the shortest has: 2e-6
 * at 1 : 1,000,000. Not Schroeder and Hanrahan's closed form of the whole [1993]: this is as exact
 * as doubles let it be.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CONTOUR_FACTOR_H
#define KERNEL_CONTOUR_FACTOR_H

#include "discussion.h"
#include "kernel/constants.h"
#include "kernel/lanes.h"
#include "kernel/plain_math.h"

#define CONTOUR_FACTOR_TWO_PI 6.28318530717958647693
enum {
    CONTOUR_FACTOR_DEPTH = 40,
    CONTOUR_FACTOR_PAIRS = POLYGON_MAX * POLYGON_MAX,
    /* five Gauss points on a part and on either half of it, of four parts */
    CONTOUR_FACTOR_PARTS = 12,
    CONTOUR_FACTOR_LINES = 5 * CONTOUR_FACTOR_PARTS + LANES_MOST,
    CONTOUR_FACTOR_SECONDS = 4 * CONTOUR_FACTOR_PAIRS + LANES_MOST
};

/* A polygon's edge. */
struct contour_factor_side {
    const double *from;
    double along[3], unit[3], length;
};

/* Points of the outer edge, s from 0 to 1, and the integral of the logarithm of their distance over
 * the inner one. */
struct contour_factor_lines {
    double s[CONTOUR_FACTOR_LINES], value[CONTOUR_FACTOR_LINES];
};

TOOL void contour_factor_lines_body(const struct contour_factor_side *outer,
                                    const struct contour_factor_side *inner, int count,
                                    struct contour_factor_lines *lines)
{
    const double *p = outer->from, *a = inner->from, *e = outer->along, *u = inner->unit;
    const double p0 = p[0], p1 = p[1], p2 = p[2], a0 = a[0], a1 = a[1], a2 = a[2], e0 = e[0],
                 e1 = e[1], e2 = e[2], u0 = u[0], u1 = u[1], u2 = u[2], length = inner->length;
    for (int i = 0; i < count; i += LANES)
        for (int k = i; k < i + LANES; k++) {
            double s = lines->s[k];
            double w0 = p0 + s * e0 - a0, w1 = p1 + s * e1 - a1, w2 = p2 + s * e2 - a2;
            double c0 = w1 * u2 - w2 * u1, c1 = w2 * u0 - w0 * u2, c2 = w0 * u1 - w1 * u0;
            double x = w0 * u0 + w1 * u1 + w2 * u2, y = length - x;
            double h = sqrt(c0 * c0 + c1 * c1 + c2 * c2);
            double sum = -length;
            sum += 0.5 * y * plain_log(y * y + h * h);
            sum += 0.5 * x * plain_log(x * x + h * h);
            sum += h * plain_angle(h * length, h * h - x * y); /* under which p sees the edge */
            lines->value[k] = sum;
        }
}

/* Of parallel edges: u, h and G(u). */
struct contour_factor_seconds {
    double u[CONTOUR_FACTOR_SECONDS], h[CONTOUR_FACTOR_SECONDS], value[CONTOUR_FACTOR_SECONDS];
};

TOOL void contour_factor_seconds_body(int count, struct contour_factor_seconds *g)
{
    for (int i = 0; i < count; i += LANES)
        for (int k = i; k < i + LANES; k++) {
            double u = fabs(g->u[k]), h = g->h[k];
            g->value[k] = 0.25 * (u * u - h * h) * plain_log(u * u + h * h)
                          + u * h * plain_angle(u, h) - 0.75 * u * u;
        }
}

#if LANES_CHOSEN
LANES_AVX512 void contour_factor_lines_8(const struct contour_factor_side *outer,
                                         const struct contour_factor_side *inner, int count,
                                         struct contour_factor_lines *lines)
{
    contour_factor_lines_body(outer, inner, count, lines);
}
LANES_AVX2 void contour_factor_lines_4(const struct contour_factor_side *outer,
                                       const struct contour_factor_side *inner, int count,
                                       struct contour_factor_lines *lines)
{
    contour_factor_lines_body(outer, inner, count, lines);
}
LANES_AVX512 void contour_factor_seconds_8(int count, struct contour_factor_seconds *g)
{
    contour_factor_seconds_body(count, g);
}
LANES_AVX2 void contour_factor_seconds_4(int count, struct contour_factor_seconds *g)
{
    contour_factor_seconds_body(count, g);
}
#endif

OUTLINE void contour_factor_lines_at(int width, const struct contour_factor_side *outer,
                                     const struct contour_factor_side *inner, int count,
                                     struct contour_factor_lines *lines)
{
    LANES_RUN(width, contour_factor_lines_8, contour_factor_lines_4, contour_factor_lines_body,
              (outer, inner, count, lines));
}

OUTLINE void contour_factor_seconds_at(int width, int count, struct contour_factor_seconds *g)
{
    LANES_RUN(width, contour_factor_seconds_8, contour_factor_seconds_4,
              contour_factor_seconds_body, (count, g));
}

/* The integral over parts from part[i][0] to part[i][1] of the outer edge, by five points each. */
static inline void contour_factor_gauss(const struct contour_factor_side *outer,
                                        const struct contour_factor_side *inner, int parts,
                                        const double (*part)[2], double *out)
{
    static const double node[5] = {-0.90617984593866399280, -0.53846931010568309104, 0,
                                   0.53846931010568309104, 0.90617984593866399280};
    static const double weight[5] = {0.23692688505618908751, 0.47862867049936646804,
                                     0.56888888888888888889, 0.47862867049936646804,
                                     0.23692688505618908751};
    struct contour_factor_lines lines;
    int count = 0;
    for (int i = 0; i < parts; i++) {
        double middle = 0.5 * (part[i][0] + part[i][1]), half = 0.5 * (part[i][1] - part[i][0]);
        for (int k = 0; k < 5; k++)
            lines.s[count++] = middle + half * node[k];
    }
    for (int k = count; k % LANES; k++)
        lines.s[k] = 0;
    contour_factor_lines_at(lanes_width(), outer, inner, count, &lines);
    for (int i = 0; i < parts; i++) {
        double sum = 0;
        for (int k = 0; k < 5; k++)
            sum += weight[k] * lines.value[5 * i + k];
        out[i] = sum * (0.5 * (part[i][1] - part[i][0]));
    }
}

/* A part of which the integral over the whole is known, and those over its halves: where they do
 * not agree the halves of both are asked. */
static inline double contour_factor_adapt(const struct contour_factor_side *outer,
                                          const struct contour_factor_side *inner, double from,
                                          double to, double whole, const double half[2],
                                          double tolerance, int depth)
{
    if (depth == 0 || fabs(half[0] + half[1] - whole) <= tolerance)
        return half[0] + half[1];
    double middle = 0.5 * (from + to), left = 0.5 * (from + middle), right = 0.5 * (middle + to),
           quarter[4];
    const double part[4][2] = {{from, left}, {left, middle}, {middle, right}, {right, to}};
    contour_factor_gauss(outer, inner, 4, part, quarter);
    return contour_factor_adapt(outer, inner, from, middle, half[0], quarter, tolerance, depth - 1)
           + contour_factor_adapt(outer, inner, middle, to, half[1], quarter + 2, tolerance,
                                  depth - 1);
}

/* int over the outer edge, 0 to 1, against the parallel inner one is
 * (G(u[0]) - G(u[1]) - G(u[2]) + G(u[3])) / what this returns. */
static inline double contour_factor_parallel(const struct contour_factor_side *outer,
                                             const struct contour_factor_side *inner, double u[4],
                                             double h[4])
{
    double w[3], c[3], length = inner->length;
    double along = dot3(outer->along, inner->unit) > 0 ? outer->length : -outer->length;
    sub3(w, outer->from, inner->from);
    cross3(c, w, inner->unit);
    double x = dot3(w, inner->unit);
    u[0] = x + along;
    u[1] = x;
    u[2] = x + along - length;
    u[3] = x - length;
    h[0] = h[1] = h[2] = h[3] = length3(c);
    return along;
}

/* int over the outer edge, 0 to 1, against the skew inner one; `cross`: the square of the sine. */
static inline double contour_factor_skew(const struct contour_factor_side *outer,
                                         const struct contour_factor_side *inner, double cross,
                                         double tolerance)
{
    const double *e = outer->along, *u = inner->unit;
    double at[5], w[3], sum = 0, eu = dot3(e, u), square = outer->length * outer->length;
    sub3(w, inner->from, outer->from);
    double ew = dot3(w, e);
    at[0] = 0;
    at[1] = ew / square;
    at[2] = (ew + inner->length * eu) / square;
    at[3] = (ew - eu * dot3(w, u)) / (square * cross);
    at[4] = 1;
    for (int i = 1; i < 4; i++) {
        at[i] = at[i] > 0 ? at[i] < 1 ? at[i] : 1 : 0;
        for (int j = i; j > 1 && at[j] < at[j - 1]; j--) {
            double swap = at[j];
            at[j] = at[j - 1];
            at[j - 1] = swap;
        }
    }
    double part[CONTOUR_FACTOR_PARTS][2], value[CONTOUR_FACTOR_PARTS];
    int parts = 0;
    for (int i = 0; i < 4; i++)
        if (at[i + 1] > at[i]) {
            double middle = 0.5 * (at[i] + at[i + 1]);
            part[parts][0] = part[parts + 1][0] = at[i];
            part[parts + 1][1] = part[parts + 2][0] = middle;
            part[parts][1] = part[parts + 2][1] = at[i + 1];
            parts += 3;
        }
    contour_factor_gauss(outer, inner, parts, (const double(*)[2])part, value);
    for (int i = 0; i < parts; i += 3)
        sum += contour_factor_adapt(outer, inner, part[i][0], part[i][1], value[i], value + i + 1,
                                    tolerance, CONTOUR_FACTOR_DEPTH);
    return sum;
}

static inline void contour_factor_sides(struct contour_factor_side *side, const struct polygon *p)
{
    for (int i = 0; i < p->n; i++) {
        sub3(side[i].along, p->v[i + 1 < p->n ? i + 1 : 0], p->v[i]);
        side[i].from = p->v[i];
        side[i].length = length3(side[i].along);
        for (int k = 0; k < 3; k++)
            side[i].unit[k] = side[i].along[k] / side[i].length;
    }
}

/* A_p F_pq of polygons of a size about one; `area`: of the smaller; `error`: of F, by one pair of
 * edges. The shorter edge of each pair is the outer one: along it the inner integral varies
 * least. */
OUTLINE double contour_factor(const struct polygon *p, const struct polygon *q, double area,
                              double error)
{
    struct contour_factor_seconds seconds;
    struct contour_factor_side side[2][POLYGON_MAX];
    double share[CONTOUR_FACTOR_PAIRS], value[CONTOUR_FACTOR_PAIRS], along[CONTOUR_FACTOR_PAIRS];
    int pairs = 0, parallel = 0, which[CONTOUR_FACTOR_PAIRS];
    contour_factor_sides(side[0], p);
    contour_factor_sides(side[1], q);
    for (int i = 0; i < p->n; i++)
        for (int j = 0; j < q->n; j++) {
            const struct contour_factor_side *e = &side[0][i], *f = &side[1][j];
            double c[3], aligned = dot3(e->along, f->along);
            if (!(fabs(aligned) > CONTOUR_FACTOR_PERPENDICULAR * e->length * f->length))
                continue;
            cross3(c, e->along, f->along);
            double cross = dot3(c, c) / (e->length * e->length * f->length * f->length);
            const struct contour_factor_side *outer = e->length <= f->length ? e : f,
                                             *inner = e->length <= f->length ? f : e;
            share[pairs] = aligned / inner->length;
            if (cross > CONTOUR_FACTOR_PARALLEL) {
                double least = error * CONTOUR_FACTOR_TWO_PI * area * inner->length / fabs(aligned);
                if (least < CONTOUR_FACTOR_ROUNDING * inner->length)
                    least = CONTOUR_FACTOR_ROUNDING * inner->length;
                value[pairs] = contour_factor_skew(outer, inner, cross, least);
            } else {
                along[parallel] = contour_factor_parallel(outer, inner, seconds.u + 4 * parallel,
                                                          seconds.h + 4 * parallel);
                which[parallel++] = pairs;
            }
            pairs++;
        }
    for (int k = 4 * parallel; k % LANES; k++)
        seconds.u[k] = seconds.h[k] = 0;
    contour_factor_seconds_at(lanes_width(), 4 * parallel, &seconds);
    for (int k = 0; k < parallel; k++) {
        const double *g = seconds.value + 4 * k;
        value[which[k]] = (g[0] - g[1] - g[2] + g[3]) / along[k];
    }
    double sum = 0;
    for (int k = 0; k < pairs; k++)
        sum += share[k] * value[k];
    return sum / CONTOUR_FACTOR_TWO_PI;
}

#endif
