/* sight_casting.c - what of a convex polygon convex solids hide from one point.
 *
 * The plane of the point and an edge cuts a line out of the polygon's plane. Where one of the
 * edge's two faces looks at the point and the other away, the edge is one of the body's outline,
 * and its line bounds the shadow. So what of the polygon no such line leaves outside is hidden: one
 * convex polygon. It is cut out of the whole edge by edge, so it is closed whatever rounding does
 * to a plane. Shadows that share an edge, as of boxes that stand in a row, are to be told apart:
 * each may be grown, by far less than counts and by more than rounding moves its lines. What
 * rounding may decide is not decided here: of a point in the plane of a face, or within a solid
 * that the plane cuts, and of an edge too short for its distance, the shadow is not told.
 * Invariant: a shadow that counts is some of the polygon, counter-clockwise, and each of its edges
 * knows the line it is of or the polygon's side. [Sutherland & Hodgman 1974 for the cuts; the rest
 * derived here]
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/sight_casting.h"

/* Rounding turns the plane of a point and an edge by so much over the sine of the angle that the
 * edge is seen under; a few units in the last place, chosen. */
static const double ROUNDS = 1e-15;

TOOL void cast_corners(struct casting *c, const struct sight_bodies *b)
{
    const double most = c->most;
    const int corners = b->corners;
    for (int i = 0; i < corners; i += LANES) {
        const double *u = b->corner[0] + i, *v = b->corner[1] + i, *h = b->corner[2] + i;
        int64_t out[LANES]; /* its own: for all that compilers know, c is where b is */
        for (int k = 0; k < LANES; k++)
            out[k] = (int64_t)(h[k] > most) << POLYGON_MAX;
        for (int e = 0; e < POLYGON_MAX; e++) {
            const double p0 = c->side[e][0], p1 = c->side[e][1], p2 = c->side[e][2],
                         p3 = c->side[e][3];
            for (int k = 0; k < LANES; k++)
                out[k] |= (int64_t)(p0 * u[k] + p1 * v[k] + p2 * h[k] > p3) << e;
        }
        for (int k = 0; k < LANES; k++)
            c->out[i + k] = out[k];
    }
}

TOOL void cast_planes(struct casting *c, const struct sight_bodies *b)
{
    const double x = c->from[0], y = c->from[1], z = c->from[2];
    const int planes = b->planes;
    for (int i = 0; i < planes; i += LANES) {
        const double *p0 = b->plane[0] + i, *p1 = b->plane[1] + i, *p2 = b->plane[2] + i,
                     *p3 = b->plane[3] + i;
        double height[LANES];
        for (int k = 0; k < LANES; k++)
            height[k] = p0[k] * x + p1[k] * y + p2[k] * z - p3[k];
        for (int k = 0; k < LANES; k++)
            c->height[i + k] = height[k];
    }
}

TOOL void lines_body(struct casting *c, const struct sight_bodies *b, int first, int edges)
{
    const double x = c->from[0], y = c->from[1], z = c->from[2], rounds = ROUNDS * c->away;
    const int sides = c->sides;
    for (int i = first; i < edges; i += LANES) {
        const double *p0 = b->end[0][0] + i, *p1 = b->end[0][1] + i, *p2 = b->end[0][2] + i,
                     *q0 = b->end[1][0] + i, *q1 = b->end[1][1] + i, *q2 = b->end[1][2] + i;
        double n0[LANES], n1[LANES], at[LANES], moved[LANES];
        int64_t under[LANES] = {0}, over[LANES] = {0};
        for (int k = 0; k < LANES; k++) {
            const double g0 = p0[k] - x, g1 = p1[k] - y, g2 = p2[k] - z, h0 = q0[k] - x,
                         h1 = q1[k] - y, h2 = q2[k] - z;
            n0[k] = g1 * h2 - g2 * h1;
            n1[k] = g2 * h0 - g0 * h2;
            at[k] = n0[k] * x + n1[k] * y + (g0 * h1 - g1 * h0) * z;
            moved[k] = rounds * sqrt((g0 * g0 + g1 * g1 + g2 * g2) * (h0 * h0 + h1 * h1 + h2 * h2));
        }
        for (int e = 0; e < sides; e++) {
            const double u = c->corner[0][e], v = c->corner[1][e];
            for (int k = 0; k < LANES; k++) {
                const double above = n0[k] * u + n1[k] * v - at[k];
                under[k] |= (int64_t)(above < -moved[k]) << e;
                over[k] |= (int64_t)(above > moved[k]) << e;
            }
        }
        for (int k = 0; k < LANES; k++) {
            c->line[0][i + k] = n0[k];
            c->line[1][i + k] = n1[k];
            c->line[2][i + k] = at[k];
            c->line[3][i + k] = moved[k];
            c->under[i + k] = under[k];
            c->over[i + k] = over[k];
        }
    }
}

TOOL void casting_body(struct casting *c, const struct sight_bodies *b)
{
    cast_corners(c, b);
    cast_planes(c, b);
}

#if LANES_CHOSEN
LANES_AVX512 void casting_8(struct casting *c, const struct sight_bodies *b)
{
    casting_body(c, b);
}
LANES_AVX2 void casting_4(struct casting *c, const struct sight_bodies *b)
{
    casting_body(c, b);
}
LANES_AVX512 void lines_8(struct casting *c, const struct sight_bodies *b, int first, int edges)
{
    lines_body(c, b, first, edges);
}
LANES_AVX2 void lines_4(struct casting *c, const struct sight_bodies *b, int first, int edges)
{
    lines_body(c, b, first, edges);
}
#endif

/* How much more than the one before each shadow grows, of how large the polygon is and a hundredth
 * of how far away; chosen. */
static const double GROWS = 1e-10, AWAY = 1e-2;

/* Rounding moves a line by less than so much of what shadows grow, or the point is not told: so two
 * in one place are told apart. Chosen. */
static const double SURE = 0.1;

/* A point nearer to a face's plane than this, of how far off their faces points are, may be on
 * either side of it. One on a face that lies in that plane, as of a floor that solids stand on, is
 * farther: it is off by all of it, less by misfits, SIGHT_MISFITS of which it is at the least. */
static const double NEARLY = 0.5;

/* Sides of the polygon shorter than this, of its size, have no direction to rely on: nothing is
 * beside them. Where its corner is cut off they are as short as rounding. */
static const double SHORT = 1e-6;

void sight_casting_open(struct casting *c, const struct sight_bodies *b,
                        const struct outline_cell *cell, const double from[3], double up)
{
    const double z = from[2];
    double far = 0;
    for (int k = 0; k < 3; k++)
        c->from[k] = from[k];
    c->sides = cell->n;
    c->near = NEARLY * up;
    c->most = z * (1 - OUTLINE_BELOW_EYE);
    c->own = 0;
    for (int i = 0; i < cell->n; i++)
        for (int k = 0; k < 2; k++) {
            const double along = fabs(cell->p[i][k] - cell->p[0][k]);
            c->own = along > c->own ? along : c->own;
            c->corner[k][i] = cell->p[i][k];
        }
    for (int i = 0, j = cell->n - 1; i < cell->n; j = i++) {
        const double g[3] = {cell->p[j][0] - c->from[0], cell->p[j][1] - c->from[1], -z},
                     h[3] = {cell->p[i][0] - c->from[0], cell->p[i][1] - c->from[1], -z},
                     side[2] = {h[0] - g[0], h[1] - g[1]}, square = dot3(h, h);
        far = square > far ? square : far;
        cross3(c->side[i], g, h);
        c->side[i][3] = dot3(c->side[i], c->from);
        if (!(side[0] * side[0] + side[1] * side[1] > SHORT * SHORT * c->own * c->own))
            c->side[i][0] = c->side[i][1] = c->side[i][2] = c->side[i][3] = 0;
    }
    for (int i = cell->n; i < POLYGON_MAX; i++)
        c->side[i][0] = c->side[i][1] = c->side[i][2] = c->side[i][3] = 0;
    c->per = 1 / c->own;
    c->away = sqrt(far);
    c->grow = GROWS * (c->own + AWAY * c->away);
    LANES_RUN(lanes_width(), casting_8, casting_4, casting_body, (c, b));
    c->count = c->first[0] = 0;
}

/* What of a shadow is not outside of a line. over[]: how far its corners are. Returns 0 when that
 * is nothing, -1 when it would have too many corners. */
static int cut_off(struct body_shadow *left, const struct body_shadow *s, const double *over,
                   int by)
{
    int n = 0;
    for (int i = 0; i < s->n; i++) {
        const int next = i + 1 < s->n ? i + 1 : 0, in = !(over[i] > 0);
        if (n + 2 > SHADOW_CORNERS)
            return -1;
        if (in) {
            left->p[n][0] = s->p[i][0];
            left->p[n][1] = s->p[i][1];
            left->by[n++] = s->by[i];
        }
        if (in == !(over[next] > 0))
            continue;
        const double t = over[i] / (over[i] - over[next]);
        for (int k = 0; k < 2; k++)
            left->p[n][k] = s->p[i][k] + t * (s->p[next][k] - s->p[i][k]);
        left->by[n++] = in ? by : s->by[i];
    }
    left->n = n;
    return n > 0;
}

/* How far a shadow's corners are outside of a line. Returns whether any is. */
static int lies_over(const struct body_shadow *s, const struct body_line *line, double *over)
{
    int any = 0;
    for (int i = 0; i < s->n; i++) {
        over[i] = line->a * s->p[i][0] + line->b * s->p[i][1] - line->c;
        any |= over[i] > 0;
    }
    return any;
}

/* The line of an edge of the outline; `turned` when it has the body on its right. Returns 0 when
 * rounding may move it as far as shadows grow. */
static int line_of(const struct casting *c, int edge, int turned, double grow,
                   struct body_line *line)
{
    const double a = c->line[0][edge], b = c->line[1][edge], size = sqrt(a * a + b * b),
                 to = (turned ? -1 : 1) / size;
    *line = (struct body_line){to * a, to * b, to * c->line[2][edge] + grow};
    return c->line[3][edge] < SURE * c->grow * size;
}

/* The edges of a body's outline that the polygon lies on both sides of; negative, less 1, with the
 * body on their right. What has no outline, though it has a front, has a plane that rounding
 * turned. */
static enum rest find_outline(const struct casting *c, const struct sight_bodies *b,
                              const struct sight_body *body, int *found, int *count)
{
    const int64_t all = (1 << c->sides) - 1;
    int outlines = 0;
    *count = 0;
    for (int i = body->edge; i < body[1].edge; i++) {
        const int left = c->height[b->edge[i].left] > 0, right = c->height[b->edge[i].right] > 0;
        if (left == right)
            continue;
        const int64_t in = left ? c->under[i] : c->over[i], out = left ? c->over[i] : c->under[i];
        if (out == all)
            return REST_NONE;
        if (in != all)
            found[(*count)++] = left ? i : -i - 1;
        outlines++;
    }
    return outlines < 3 ? REST_UNTOLD : *count > 0 ? REST_SOME : REST_ALL;
}

/* Cuts the last shadow, which is all of the polygon so far, along the body's outline; it counts
 * when some is left. */
static enum rest cut_outline(struct casting *c, const struct sight_bodies *b,
                             const struct sight_body *body, double grow)
{
    struct body_shadow *const keep = &c->shadow[c->count], other, *now = keep, *next = &other;
    int found[SIGHT_BODY_EDGES], count, lines = c->first[c->count];
    double over[SHADOW_CORNERS];
    const enum rest rest = find_outline(c, b, body, found, &count);
    if (rest != REST_SOME)
        return rest;
    for (int i = 0; i < count; i++) {
        struct body_line *line = &c->cut[lines];
        const int turned = found[i] < 0, edge = turned ? -found[i] - 1 : found[i];
        if (!line_of(c, edge, turned, grow, line))
            return REST_UNTOLD;
        if (!lies_over(now, line, over))
            continue;
        const int left = cut_off(next, now, over, POLYGON_MAX + lines++);
        if (left <= 0)
            return left < 0 ? REST_UNTOLD : REST_NONE;
        now = next;
        next = now == keep ? &other : keep;
    }
    if (lines == c->first[c->count])
        return REST_ALL;
    if (now != keep) {
        keep->n = now->n;
        memcpy(keep->p, now->p, (size_t)now->n * sizeof *now->p);
        memcpy(keep->by, now->by, (size_t)now->n * sizeof *now->by);
    }
    c->first[++c->count] = lines;
    return REST_SOME;
}

/* A point within a body sees as much of the polygon as its plane cuts off that. */
enum rest sight_casting_add(struct casting *c, const struct sight_bodies *b,
                            const struct sight_body *body, const struct outline_cell *cell,
                            double grow)
{
    struct body_shadow *s = &c->shadow[c->count];
    int64_t out = ~(int64_t)0;
    int front = 0;
    for (int i = body->corner; i < body[1].corner && out; i++)
        out &= c->out[i];
    if (out) /* all of it is beside a side, or above */
        return REST_NONE;
    for (int i = body->plane; i < body[1].plane; i++) {
        if (fabs(c->height[i]) < c->near)
            return REST_UNTOLD;
        front |= c->height[i] > 0;
    }
    if (!front)
        return body->foot ? REST_UNTOLD : REST_ALL;
    LANES_RUN(lanes_width(), lines_8, lines_4, lines_body, (c, b, body->edge, body[1].edge));
    s->n = cell->n;
    for (int i = 0; i < cell->n; i++) {
        s->p[i][0] = cell->p[i][0];
        s->p[i][1] = cell->p[i][1];
        s->by[i] = i;
    }
    return cut_outline(c, b, body, grow);
}
