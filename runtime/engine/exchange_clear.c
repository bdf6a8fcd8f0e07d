/* exchange_clear.c - the exchange areas of pairs of faces that see all of each other.
 *
 * Each pair has Lambert's kernel and its second derivatives at the centroids (kernel/lambert.h),
 * and an estimate of what that leaves out. Where this may be more than is allowed, the kernel is
 * taken at points of both faces, by rules exact to degree 4 and more; where these may not do
 * either, or one face's plane runs through the other, the pair has the contour integral of what is
 * in front (kernel/polygon_factor.h). How near that is depends on how flat the two look from each
 * other: near a plane, what is left out falls with the distance's second power alone.
 * [Taylor's formula; rules: Dunavant 1985, Gauss; the rest derived here]
 * Invariant: none above the smaller area.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_clear.h"
#include "engine/face_rule.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "kernel/lanes.h"
#include "kernel/plane_side.h"
#include "kernel/polygon_factor.h"

/* How large a face's third moments are: 1 of a triangle, 0 of a parallelogram. */
static double lopsided(const struct element *e)
{
    double w[3];
    if (e->vertices != 4)
        return 1;
    for (int k = 0; k < 3; k++)
        w[k] = e->vertex[0][k] - e->vertex[1][k] + e->vertex[2][k] - e->vertex[3][k];
    return fmin(1.5 * length3(w) / e->radius, 1);
}

int exchange_faces_open(struct exchange_faces *p, const struct exchange_tree *t)
{
    uint32_t n = t->h.face_count;
    p->all = malloc((5 + MOMENTS) * (size_t)n * sizeof *p->all);
    p->covered = malloc((size_t)n + 1);
    if (!p->all || !p->covered)
        return -1;
    clear_rules_open(p->rules);
    for (int k = 0; k < 3; k++)
        p->c[k] = p->all + (size_t)k * n;
    p->area = p->all + 3 * (size_t)n;
    p->lopsided = p->all + 4 * (size_t)n;
    for (int k = 0; k < MOMENTS; k++)
        p->moment[k] = p->all + (size_t)(5 + k) * n;
    for (uint32_t i = 0; i < n; i++) {
        const struct element *e = exchange_tree_face(t, i);
        double moment[MOMENTS] = {0};
        /* triangle by triangle: (1/12) sum d d over its corners, and its own centroid's */
        for (int v = 2; v < e->vertices; v++) {
            const double *corner[3] = {e->vertex[0], e->vertex[v - 1], e->vertex[v]};
            double a[3], b[3], c[3], middle[3];
            sub3(a, corner[1], corner[0]);
            sub3(b, corner[2], corner[0]);
            cross3(c, a, b);
            double share = 0.5 * dot3(c, e->normal) / e->area;
            for (int k = 0; k < 3; k++)
                middle[k] = (corner[0][k] + corner[1][k] + corner[2][k]) * (1 / 3.0);
            for (int j = 0; j < 4; j++) {
                double d[3], w = share * (j < 3 ? 1 / 12.0 : 1);
                if (j < 3)
                    sub3(d, corner[j], middle);
                else
                    sub3(d, middle, e->centre);
                for (int k = 0; k < 3; k++)
                    moment[k] += w * d[k] * d[k];
                moment[3] += w * d[0] * d[1];
                moment[4] += w * d[0] * d[2];
                moment[5] += w * d[1] * d[2];
            }
        }
        for (int k = 0; k < 3; k++)
            p->c[k][i] = e->centre[k];
        p->area[i] = e->area;
        p->covered[i] = (unsigned char)bodies_cover(&t->bodies, &t->h, t->h.face_element[e->face]);
        p->lopsided[i] = lopsided(e);
        for (int k = 0; k < MOMENTS; k++)
            p->moment[k][i] = moment[k];
    }
    return 0;
}

void exchange_faces_close(struct exchange_faces *p)
{
    free(p->all);
    free(p->covered);
}

/* Points of a face, for kernels, and how much of it each stands for. */
enum { KERNEL_POINTS = 8 };
struct kernel_rule {
    int count;
    double x[3][KERNEL_POINTS], weight[KERNEL_POINTS];
};

/* What a line of pairs needs of the faces across. */
struct line {
    double shift[3][TILE]; /* M_j n */
    double doubt[TILE];    /* of its pairs, how much of the tolerance the error may be, squared */
    /* whether a part of each is behind the own group's plane: its kernel is not smooth then */
    unsigned char crosses[TILE];
    struct kernel_rule rule[TILE]; /* their points, once asked for */
};

/* M_i v. */
static void moment_times(const struct exchange_faces *p, uint32_t i, const double v[3],
                         double out[3])
{
    out[0] = p->moment[0][i] * v[0] + p->moment[3][i] * v[1] + p->moment[4][i] * v[2];
    out[1] = p->moment[3][i] * v[0] + p->moment[1][i] * v[1] + p->moment[5][i] * v[2];
    out[2] = p->moment[4][i] * v[0] + p->moment[5][i] * v[1] + p->moment[2][i] * v[2];
}

/* What every face across is to the group whose lines are asked for. */
static void open_line(const struct exchange_faces *p, const struct exchange_pair *pair, int column,
                      struct line *line)
{
    const struct element *own = column ? pair->emitter : pair->receiver;
    const struct face_range range = column ? pair->rows : pair->columns;
    for (uint32_t j = range.from; j < range.to; j++) {
        double shift[3];
        moment_times(p, j, own->normal, shift);
        for (int k = 0; k < 3; k++)
            line->shift[k][j - range.from] = shift[k];
        line->rule[j - range.from].count = 0;
        line->crosses[j - range.from] = (unsigned char)plane_side_behind(
            exchange_tree_face(pair->tree, j), own, pair->tree->host.flat);
    }
}

/* An estimate of the square of what the second order leaves out (unit: pi k, kernel/lambert.h): the
 * next terms of the series, as if their signs did not matter. With v = r.Qr / s^2, w = tr Q / s -
 * v, the variances of what is seen along r and across it over s, the factor s^-2 of the kernel has
 * the terms 35 d^4 along r and 3 d^4 across, 20 d^3 along and 12 d^2 across times d along. Fourth
 * moments of a flat convex face are at most 2.5 squares of its variance, third ones of a triangle
 * .57 powers 3/2. `skew`: |a m.M_i r| + |b n.M_j r|; `shifts`: |M_i m|^2 |M_j n|^2; `rises`:
 * a^2 m.M_i m + b^2 n.M_j n. Of 30,000 random pairs, held against the contour integral, 150 are off
 * by more than it says, none by more than 3 times as much from 1.5 sums of radii on. */
static inline double rest_square(double a, double b, double t, double quad, double trace,
                                 double skew, double shifts, double rises, double lopsided)
{
    double ab = a * b, v = t * t * quad, w = t * trace - v;
    double even = ab * (87 * v * v + 7.5 * w * w), turned = t * skew * (60 * v + 12 * w),
           both = 24 * t, odd = ab * (11.3 * v + 6.8 * w), rise = 5.7 * v + 1.1 * w;
    return t * t * t * t
           * (even * even + turned * turned + both * both * shifts
              + lopsided * (v * odd * odd + rise * rise * rises));
}

/* Of faces that may reach to each other no estimate of the second order says that it does: of two
 * in parallel, a hair apart, all terms are small, and what they exchange is not. */
static const double NEAR_DOUBT = 2;

/* The exchange areas of face i, normal n, with the faces of a range, normal -m; and how far they
 * may be off, as a share of what is allowed, squared. Of two faces they are the same numbers from
 * either: all that is added or multiplied is the same but for its order. */
TOOL void second_order_body(const struct exchange_faces *p, uint32_t i, const double n[3],
                            struct face_range range, const double m[3], double tolerance,
                            struct line *line, double *restrict out)
{
    const double *restrict x = p->c[0] + range.from, *restrict y = p->c[1] + range.from,
                           *restrict z = p->c[2] + range.from;
    const double *restrict area = p->area + range.from, *restrict xx = p->moment[0] + range.from,
                           *restrict yy = p->moment[1] + range.from,
                           *restrict zz = p->moment[2] + range.from,
                           *restrict xy = p->moment[3] + range.from,
                           *restrict xz = p->moment[4] + range.from,
                           *restrict yz = p->moment[5] + range.from,
                           *restrict lopsided = p->lopsided + range.from;
    const double *restrict sx = line->shift[0], *restrict sy = line->shift[1],
                           *restrict sz = line->shift[2];
    double *restrict doubt = line->doubt;
    const double cx = p->c[0][i], cy = p->c[1][i], cz = p->c[2][i], own_area = p->area[i],
                 own_lopsided = p->lopsided[i];
    const double ixx = p->moment[0][i], iyy = p->moment[1][i], izz = p->moment[2][i],
                 ixy = p->moment[3][i], ixz = p->moment[4][i], iyz = p->moment[5][i], n0 = n[0],
                 n1 = n[1], n2 = n[2], m0 = m[0], m1 = m[1], m2 = m[2];
    double own[3];
    int count = (int)(range.to - range.from);
    moment_times(p, i, m, own);
    const double own_square = dot3(own, own), own_rise = dot3(own, m);
#pragma omp simd
    for (int j = 0; j < count; j++) {
        double r0 = x[j] - cx, r1 = y[j] - cy, r2 = z[j] - cz;
        double qxx = xx[j] + ixx, qyy = yy[j] + iyy, qzz = zz[j] + izz, qxy = xy[j] + ixy,
               qxz = xz[j] + ixz, qyz = yz[j] + iyz;
        double a = n0 * r0 + n1 * r1 + n2 * r2, b = m0 * r0 + m1 * r1 + m2 * r2;
        double t = 1 / (r0 * r0 + r1 * r1 + r2 * r2);
        double quad = qxx * r0 * r0 + qyy * r1 * r1 + qzz * r2 * r2
                      + 2 * (qxy * r0 * r1 + qxz * r0 * r2 + qyz * r1 * r2);
        double trace = qxx + qyy + qzz, skew_i = a * (own[0] * r0 + own[1] * r1 + own[2] * r2),
               skew_j = b * (sx[j] * r0 + sy[j] * r1 + sz[j] * r2);
        double scale = own_area * area[j] * (1 / LAMBERT_PI),
               least = own_area < area[j] ? own_area : area[j],
               e = scale * lambert_second_order(a, b, t, quad, trace, skew_i + skew_j);
        int front = (a > 0) & (b > 0); /* behind each other two signs would cancel */
        double square = sx[j] * sx[j] + sy[j] * sy[j] + sz[j] * sz[j],
               rise = n0 * sx[j] + n1 * sy[j] + n2 * sz[j];
        double most = own_lopsided > lopsided[j] ? own_lopsided : lopsided[j];
        double rest =
            rest_square(a, b, t, quad, trace, fabs(skew_i) + fabs(skew_j), own_square * square,
                        a * a * own_rise + b * b * rise, most * most);
        e = (front & (e > 0)) ? e < least ? e : least : 0;
        double limit = tolerance / CLEAR_REST * (e > SIGHT_FLOOR * least ? e : SIGHT_FLOOR * least);
        double off = scale * scale * rest / (limit * limit);
        off = trace * t > CLEAR_NEAR && off < NEAR_DOUBT ? NEAR_DOUBT : off;
        out[j] = e;
        doubt[j] = front ? off : INFINITY;
    }
}

#if LANES_CHOSEN
LANES_AVX512 void second_order_8(const struct exchange_faces *p, uint32_t i, const double n[3],
                                 struct face_range range, const double m[3], double tolerance,
                                 struct line *line, double *out)
{
    second_order_body(p, i, n, range, m, tolerance, line, out);
}
LANES_AVX2 void second_order_4(const struct exchange_faces *p, uint32_t i, const double n[3],
                               struct face_range range, const double m[3], double tolerance,
                               struct line *line, double *out)
{
    second_order_body(p, i, n, range, m, tolerance, line, out);
}
#endif

static void second_order_row(const struct exchange_faces *p, uint32_t i, const double n[3],
                             struct face_range range, const double m[3], double tolerance,
                             struct line *line, double *out)
{
    LANES_RUN(lanes_width(), second_order_8, second_order_4, second_order_body,
              (p, i, n, range, m, tolerance, line, out));
}

/* ---- pairs that second order may not do for */

/* Seven points of a quad. */
static void rule_of_quad(struct kernel_rule *rule, const struct element *e)
{
    /* of a square from -1 to 1 [Radon 1948] */
    static const double point[7][3] = {
        {0, 0, 2 / 7.0},
        {0, 0.96609178307929590, 5 / 63.0},
        {0, -0.96609178307929590, 5 / 63.0},
        {0.77459666924148337704, 0.57735026918962576451, 5 / 36.0},
        {0.77459666924148337704, -0.57735026918962576451, 5 / 36.0},
        {-0.77459666924148337704, 0.57735026918962576451, 5 / 36.0},
        {-0.77459666924148337704, -0.57735026918962576451, 5 / 36.0}};
    const double(*v)[3] = (const double(*)[3])e->vertex;
    rule->count = 7;
    for (int i = 0; i < rule->count; i++) {
        const double a = 0.5 * (1 + point[i][0]), b = 0.5 * (1 + point[i][1]);
        double s[3], t[3], jacobian[3];
        for (int k = 0; k < 3; k++) {
            s[k] = (1 - b) * (v[1][k] - v[0][k]) + b * (v[2][k] - v[3][k]);
            t[k] = (1 - a) * (v[3][k] - v[0][k]) + a * (v[2][k] - v[1][k]);
            rule->x[k][i] = v[0][k] + a * (v[1][k] - v[0][k]) + b * t[k];
        }
        cross3(jacobian, s, t);
        rule->weight[i] = point[i][2] * dot3(jacobian, e->normal) / e->area;
    }
}

static void rule_of_triangle(struct kernel_rule *rule, const struct element *e)
{
    struct face_rule six;
    face_rule_of(&six, e, 0);
    rule->count = six.count;
    for (int i = 0; i < six.count; i++) {
        for (int k = 0; k < 3; k++)
            rule->x[k][i] = six.x[k][i];
        rule->weight[i] = six.weight[i];
    }
}

/* Points of a face, and which share of it each stands for. What is left of the lanes is the first
 * again, and stands for nothing. */
static void rule_of(struct kernel_rule *rule, const struct element *e)
{
    if (e->vertices == 3)
        rule_of_triangle(rule, e);
    else
        rule_of_quad(rule, e);
    for (int i = rule->count; i < KERNEL_POINTS; i++) {
        for (int k = 0; k < 3; k++)
            rule->x[k][i] = rule->x[k][0];
        rule->weight[i] = 0;
    }
}

/* The mean kernel (pi / m2) of the points of two faces with normals n and -m. */
TOOL double rule_kernel_body(const struct kernel_rule *p, const double n[3],
                             const struct kernel_rule *q, const double m[3])
{
    const double n0 = n[0], n1 = n[1], n2 = n[2], m0 = m[0], m1 = m[1], m2 = m[2];
    double part[KERNEL_POINTS] = {0}, sum = 0;
    for (int i = 0; i < p->count; i++) {
        const double x = p->x[0][i], y = p->x[1][i], z = p->x[2][i], weight = p->weight[i];
        for (int j = 0; j < KERNEL_POINTS; j++) {
            const double r0 = q->x[0][j] - x, r1 = q->x[1][j] - y, r2 = q->x[2][j] - z,
                         s = r0 * r0 + r1 * r1 + r2 * r2;
            part[j] +=
                weight * (n0 * r0 + n1 * r1 + n2 * r2) * (m0 * r0 + m1 * r1 + m2 * r2) / (s * s);
        }
    }
    for (int j = 0; j < KERNEL_POINTS; j++)
        sum += q->weight[j] * part[j];
    return sum;
}

#if LANES_CHOSEN
LANES_AVX512 double rule_kernel_8(const struct kernel_rule *p, const double n[3],
                                  const struct kernel_rule *q, const double m[3])
{
    return rule_kernel_body(p, n, q, m);
}
LANES_AVX2 double rule_kernel_4(const struct kernel_rule *p, const double n[3],
                                const struct kernel_rule *q, const double m[3])
{
    return rule_kernel_body(p, n, q, m);
}
#endif

/* The same (1/m2). */
static double rule_kernel(const struct kernel_rule *p, const double n[3],
                          const struct kernel_rule *q, const double m[3])
{
    return LANES_RUN(lanes_width(), rule_kernel_8, rule_kernel_4, rule_kernel_body, (p, n, q, m))
           * (1 / LAMBERT_PI);
}

/* What the rules leave out is of two orders more: as much less than the estimate as all that the
 * faces are wide is less than their distance. [of 15,000 random pairs, 50 are off by more] */
static int rules_do(const struct exchange_faces *p, uint32_t i, uint32_t j, double doubt)
{
    double square = 0, trace = 0;
    for (int k = 0; k < 3; k++) {
        double d = p->c[k][j] - p->c[k][i];
        square += d * d;
        trace += p->moment[k][i] + p->moment[k][j];
    }
    double less = trace / square;
    return less < CLEAR_NEAR && doubt * less * less < 1;
}

/* Is every edge of the one parallel to every edge of the other, or at a right angle? Then the
 * contour integral is closed, and costs less than points. */
static int is_closed(const struct element *a, const struct element *b)
{
    for (int i = 0; i < a->vertices; i++)
        for (int j = 0; j < b->vertices; j++) {
            double u[3], v[3], c[3];
            sub3(u, a->vertex[i + 1 < a->vertices ? i + 1 : 0], a->vertex[i]);
            sub3(v, b->vertex[j + 1 < b->vertices ? j + 1 : 0], b->vertex[j]);
            cross3(c, u, v);
            const double along = dot3(u, v), sizes = dot3(u, u) * dot3(v, v);
            if (along * along > CONTOUR_FACTOR_PERPENDICULAR * CONTOUR_FACTOR_PERPENDICULAR * sizes
                && dot3(c, c) > CONTOUR_FACTOR_PARALLEL * sizes)
                return 0;
        }
    return 1;
}

/* What two faces exchange that are too near each other for their kernels' mean. `smooth`: each lies
 * in front of the other. */
static double near_area(const struct exchange_faces *p, const struct element *a,
                        const struct element *b, double tolerance, int smooth)
{
    const double least = SIGHT_FLOOR * fmin(a->area, b->area);
    if (smooth && !is_closed(a, b)) {
        double error, e = clear_points(p->rules, a, b, &error);
        if (CLEAR_POINTS_REST * error <= tolerance * fmax(e, least))
            return e;
    }
    return a->area * polygon_factor_within(a, b, 1, tolerance * SIGHT_FLOOR / CLEAR_REST);
}

int clear_meet(const struct exchange_tree *t, const struct element *a, const struct element *b)
{
    return bodies_meet(&t->bodies, &t->h, t->h.face_element[a->face], t->h.face_element[b->face]);
}

/* The line of the face at place i, `line` with the shifts of the faces across. */
static void make_line(const struct exchange_faces *p, const struct exchange_pair *pair,
                      double tolerance, uint32_t i, int column, struct line *line, double *out)
{
    const struct element *r = pair->receiver, *s = pair->emitter, *own = column ? s : r,
                         *other = column ? r : s;
    const struct face_range range = column ? pair->rows : pair->columns;
    const double turned[3] = {-other->normal[0], -other->normal[1], -other->normal[2]},
                 m[3] = {-s->normal[0], -s->normal[1], -s->normal[2]};
    if (p->covered[i]) {
        memset(out, 0, (range.to - range.from) * sizeof *out);
        return;
    }
    const int cut =
        plane_side_behind(exchange_tree_face(pair->tree, i), other, pair->tree->host.flat);
    struct kernel_rule rule = {.count = 0};
    second_order_row(p, i, own->normal, range, turned, tolerance, line, out);
    for (uint32_t j = range.from; j < range.to; j++) {
        double doubt =
                   cut || line->crosses[j - range.from] ? INFINITY : line->doubt[j - range.from],
               e;
        if (!(doubt > 1))
            continue;
        const struct element *a = exchange_tree_face(pair->tree, column ? j : i),
                             *b = exchange_tree_face(pair->tree, column ? i : j);
        if (rules_do(p, i, j, doubt)) {
            struct kernel_rule *across = &line->rule[j - range.from];
            if (rule.count == 0)
                rule_of(&rule, column ? b : a);
            if (across->count == 0)
                rule_of(across, column ? a : b);
            e = a->area * b->area
                * rule_kernel(column ? across : &rule, r->normal, column ? &rule : across, m);
        } else {
            e = clear_meet(pair->tree, a, b) ? 0 : near_area(p, a, b, tolerance, doubt < INFINITY);
        }
        out[j - range.from] = e > 0 ? fmin(e, fmin(a->area, b->area)) : 0;
    }
    for (uint32_t j = range.from; j < range.to; j++)
        if (p->covered[j])
            out[j - range.from] = 0;
}

void clear_line(const struct exchange_faces *p, const struct exchange_pair *pair, double tolerance,
                uint32_t place, int column, double *out)
{
    struct line line;
    open_line(p, pair, column, &line);
    make_line(p, pair, tolerance, place, column, &line, out);
}

void clear_block(const struct exchange_faces *p, const struct exchange_pair *pair, double tolerance,
                 double *out)
{
    struct line line;
    open_line(p, pair, 0, &line);
    for (uint32_t i = pair->rows.from; i < pair->rows.to; i++) {
        make_line(p, pair, tolerance, i, 0, &line, out);
        out += pair->columns.to - pair->columns.from;
    }
}
