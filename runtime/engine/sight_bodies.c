/* sight_bodies.c - what a point sees of a convex polygon past convex solids.
 *
 * Each hides one convex polygon of the plane: what of the polygon the planes of the point and its
 * outline's edges leave. These shadows are made edge by edge, so each is closed whatever rounding
 * does to a plane. Their union is not cut out: Lambert's sum goes around what is seen, and that is
 * the rim of the polygon, as far as it is no shadow's, and the rims of shadows, the other way
 * round, as far as they lie in the polygon and outside of the others. How far that is, is an
 * interval of an edge for each shadow. Shadows that share an edge, as of boxes that stand in a row,
 * are parted by growing each more than the one before, by far less than counts and by more than
 * rounding moves their lines: of two edges in one place one is inside of the other's shadow, or
 * both are. What rounding may decide is not decided here: where a point is in the plane of a face,
 * within a solid that the plane cuts, or an edge too short for its distance, and where what was
 * gone around is not closed, the point is not told, and its shadows are to be cut out
 * (sight_pieces.c). Invariant: as sight_pieces.c, but for how far shadows grow. [the rim of a union
 * of convex polygons, edge by edge; Sutherland & Hodgman 1974 for one of them; the rest derived
 * here]
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "engine/sight_bodies.h"

/* ---- corners, planes and edges, once for many points */

static int add_corner(struct sight_bodies *b, const double p[3])
{
    if (b->corners == SIGHT_BODY_CORNERS)
        return -1;
    for (int k = 0; k < 3; k++)
        b->corner[k][b->corners] = p[k];
    return b->corners++;
}

static int add_plane(struct sight_bodies *b, const double plane[4])
{
    if (b->planes == SIGHT_BODY_PLANES)
        return -1;
    for (int k = 0; k < 4; k++)
        b->plane[k][b->planes] = plane[k];
    return b->planes++;
}

/* The plane of a face. */
static int add_plane_of(struct sight_bodies *b, const struct element *e,
                        const struct outline_frame *f)
{
    double p[3],
        plane[4] = {dot3(e->normal, f->u), dot3(e->normal, f->v), dot3(e->normal, f->n), 0};
    sight_in_plane(f, e->vertex[0], p);
    plane[3] = dot3(plane, p);
    return add_plane(b, plane);
}

static int add_edge(struct sight_bodies *b, int from, int to, int left, int right)
{
    if (from < 0 || to < 0 || left < 0 || right < 0 || b->edges == SIGHT_BODY_EDGES)
        return -1;
    for (int k = 0; k < 3; k++) {
        b->end[0][k][b->edges] = b->corner[k][from];
        b->end[1][k][b->edges] = b->corner[k][to];
    }
    b->edge[b->edges++] =
        (struct sight_body_edge){(int16_t)from, (int16_t)to, (int16_t)left, (int16_t)right};
    return 0;
}

/* An edge, unless it is under the plane. */
static int add_upper(struct sight_bodies *b, int from, int to, int left, int right)
{
    return from >= 0 && to >= 0 && b->corner[2][from] < 0 && b->corner[2][to] < 0
               ? 0
               : add_edge(b, from, to, left, right);
}

/* The foot of a face that crosses the plane: what stands on that has an edge there, as if it had a
 * face on the plane that looks down; that one is on its right. corner[n]: the face's. */
static int add_foot(struct sight_bodies *b, const int *corner, int n, int left, int right)
{
    double foot[2][3] = {{0}};
    int ends = 0;
    for (int i = 0; i < n; i++) {
        const int from = corner[i], to = corner[i + 1 < n ? i + 1 : 0];
        const double g = b->corner[2][from], h = b->corner[2][to];
        if ((g > 0) == (h > 0))
            continue;
        for (int k = 0; k < 2; k++)
            foot[h > 0][k] =
                b->corner[k][from] + g / (g - h) * (b->corner[k][to] - b->corner[k][from]);
        ends |= h > 0 ? 2 : 1;
    }
    if (ends != 3)
        return 0;
    const int down = add_corner(b, foot[0]);
    return add_edge(b, down, add_corner(b, foot[1]), left, right);
}

static int add_solid(struct sight_bodies *b, const struct exchange_tree *t, const struct body *body,
                     const struct outline_frame *f)
{
    static const double DOWN[4] = {0, 0, 0, 1};
    const struct bodies *all = &t->bodies;
    const int corners = b->corners, planes = b->planes;
    double p[3], low = INFINITY;
    for (int i = 0; i < body->corners; i++) {
        sight_in_plane(f, all->corners[body->corner + (uint32_t)i], p);
        low = p[2] < low ? p[2] : low;
        if (add_corner(b, p) < 0)
            return -1;
    }
    for (int i = 0; i < body->faces; i++)
        if (add_plane_of(b, &t->h.elements[all->faces[body->face + (uint32_t)i]], f) < 0)
            return -1;
    for (int i = 0; i < body->edges; i++) {
        const struct body_edge *e = &all->edges[body->edge + (uint32_t)i];
        if (add_upper(b, corners + e->from, corners + e->to, planes + e->left, planes + e->right)
            < 0)
            return -1;
    }
    b->body[b->count].foot = !(low > 0);
    const int down = low > 0 ? 0 : add_plane(b, DOWN);
    for (int i = 0; i < body->faces && !(low > 0); i++) {
        int corner[4], n = 0;
        for (int k = 0; k < body->edges;
             k++) { /* two of the face's cross the plane, or none does */
            const struct body_edge *e = &all->edges[body->edge + (uint32_t)k];
            const int from = corners + (e->left == i ? e->from : e->to),
                      to = corners + (e->left == i ? e->to : e->from);
            if ((e->left != i && e->right != i)
                || (b->corner[2][from] > 0) == (b->corner[2][to] > 0) || n == 4)
                continue;
            corner[n++] = from;
            corner[n++] = to;
        }
        if (n == 4 && add_foot(b, corner, n, planes + i, down) < 0)
            return -1;
    }
    return 0;
}

/* The next body is made: where the one after it begins. */
static void add_body(struct sight_bodies *b)
{
    struct sight_body *body = &b->body[b->count];
    if (b->edges > body->edge) {
        body = &b->body[++b->count];
    } else { /* all of it is under the plane */
        b->corners = body->corner;
        b->planes = body->plane;
    }
    *body = (struct sight_body){b->corners, b->planes, b->edges, 0};
}

int sight_bodies_place(struct sight_bodies *b, const struct exchange_tree *t, const uint32_t *list,
                       int count, const struct outline_frame *f)
{
    uint32_t met[SIGHT_BODIES];
    int bodies = 0;
    b->count = b->corners = b->planes = b->edges = 0;
    b->body[0] = (struct sight_body){0};
    for (int i = 0; i < count; i++) {
        const uint32_t of = t->bodies.of[list[i]];
        int k = 0;
        while (k < bodies && met[k] != of)
            k++;
        if (of && k < bodies)
            continue;
        if (!of || bodies == SIGHT_BODIES || add_solid(b, t, &t->bodies.body[of - 1], f) < 0)
            return 0;
        add_body(b);
        met[bodies++] = of;
    }
    for (int i = b->corners; i % LANES_MOST; i++) /* computed, not read */
        b->corner[0][i] = b->corner[1][i] = b->corner[2][i] = 0;
    for (int i = b->planes; i % LANES_MOST; i++)
        b->plane[0][i] = b->plane[1][i] = b->plane[2][i] = b->plane[3][i] = 0;
    for (int i = b->edges; i < b->edges + LANES_MOST; i++)
        for (int k = 0; k < 3; k++)
            b->end[0][k][i] = b->end[1][k][i] = 0;
    return 1;
}

/* ---- shadows, point by point */

/* The corners that a shadow may have in the polygon; what has more is cut out face by face. */
enum { SHADOW_CORNERS = 64 };

/* A line: outside of the shadow where a u + b v > c. a, b: of length one. */
struct body_line {
    double a, b, c;
};

/* What of the polygon a body hides: convex, counter-clockwise. by[i]: whose the edge is that
 * begins at corner i: the polygon's side, or POLYGON_MAX and the place of a line. */
struct body_shadow {
    int n, by[SHADOW_CORNERS];
    double p[SHADOW_CORNERS][2];
};

/* A point's shadows that have an edge through the polygon. */
struct casting {
    double from[3], most;             /* the point; how high what casts shadows may be */
    double own, per, away;            /* how large the polygon is, 1 / own; how far */
    double size, grow;                /* what is small against: AWAY; GROWS of it */
    int sides;                        /* of the polygon */
    double corner[2][POLYGON_MAX];    /* its */
    double side[POLYGON_MAX][4];      /* planes from the point through its sides */
    int64_t out[SIGHT_BODY_CORNERS];  /* of corners: bits of the planes they are outside of */
    double height[SIGHT_BODY_PLANES]; /* of the point over planes */
    /* of edges: the line that the plane of the point and the edge cuts out of the polygon's, a u +
     * b v - c above on the edge's right; what rounding moves that by; bits of the polygon's corners
     * that are for sure below and above */
    double line[4][SIGHT_BODY_EDGES + LANES_MOST];
    int64_t under[SIGHT_BODY_EDGES + LANES_MOST], over[SIGHT_BODY_EDGES + LANES_MOST];
    int count, first[SIGHT_BODIES + 1]; /* shadows; where their lines begin, and the last's end */
    struct body_shadow shadow[SIGHT_BODIES];
    struct body_line cut[SIGHT_BODY_EDGES];
    double open; /* what is counted where edges end, less where they begin */
};

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

/* A point so near to a face's plane, of that size, may be on either side of it. */
static const double NEARLY = 1e-9;

/* Sides of the polygon shorter than this, of its size, have no direction to rely on: nothing is
 * beside them. Where its corner is cut off they are as short as rounding. */
static const double SHORT = 1e-6;

/* A rim that does not come back to where it began within so much of the polygon's size has lost an
 * edge, or has one too many. */
static const double OPEN = 1e-9;

static void start_casting(struct casting *c, const struct sight_bodies *b,
                          const struct outline_cell *cell)
{
    const double z = c->from[2];
    double far = 0;
    c->sides = cell->n;
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
    c->size = c->own + AWAY * c->away;
    c->grow = GROWS * c->size;
    LANES_RUN(lanes_width(), casting_8, casting_4, casting_body, (c, b));
    c->count = c->first[0] = 0;
    c->open = 0;
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

/* What of the polygon a body hides. */
enum rest { REST_UNTOLD, REST_NONE, REST_ALL, REST_SOME };

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

/* A body's shadow: what of the polygon all edges of its outline leave. A point within a body sees
 * as much of the polygon as its plane cuts off that. */
static enum rest cast_body(struct casting *c, const struct sight_bodies *b,
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
        if (fabs(c->height[i]) < NEARLY * c->size)
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

/* What of an edge lies outside of shadows: intervals of it that do not, in their order. */
struct hidden_parts {
    int count;
    double low[SIGHT_BODIES], high[SIGHT_BODIES];
};

/* Narrows what of an edge is within a shadow, by how far its ends are outside of a line. */
static void narrow(double g, double h, double *low, double *high)
{
    if (g > 0) {
        const double t = h > 0 ? 1 : g / (g - h);
        *low = t > *low ? t : *low;
    } else if (h > 0) {
        const double t = g / (g - h);
        *high = t < *high ? t : *high;
    }
}

static void add_hidden(struct hidden_parts *parts, double low, double high)
{
    int at = parts->count;
    if (!(low < high))
        return;
    for (; at > 0 && parts->low[at - 1] > low; at--) {
        parts->low[at] = parts->low[at - 1];
        parts->high[at] = parts->high[at - 1];
    }
    parts->low[at] = low;
    parts->high[at] = high;
    parts->count++;
}

/* Counts a corner of the rim. What is counted where edges begin and where they end is the same,
 * when they go around, whatever it is. If it were the place alone, two edges that are wrong could
 * make up for each other, being as long; of this, which is curved and along no axis of theirs, only
 * by chance. */
static inline double count_corner(const struct casting *c, const double p[2])
{
    const double u = (p[0] - c->corner[0][0]) * c->per, v = (p[1] - c->corner[1][0]) * c->per;
    return u * (1 + u * (0.61 + v)) + v * (0.43 + v * (0.74 + u));
}

/* Adds what is left of the edge from p to q; turned: from q to p. */
static void add_rest(struct sight_eye *eye, struct casting *c, const double p[2], const double q[2],
                     const struct hidden_parts *parts, int turned)
{
    double last = 0;
    for (int i = 0; i <= parts->count; i++) {
        const double end = i < parts->count ? parts->low[i] : 1;
        if (end > last) {
            double a[2], b[2];
            for (int k = 0; k < 2; k++) {
                a[k] = last > 0 ? p[k] + last * (q[k] - p[k]) : p[k];
                b[k] = end < 1 ? p[k] + end * (q[k] - p[k]) : q[k];
            }
            sight_eye_edge(eye, turned ? b : a, turned ? a : b);
            const double count = count_corner(c, b) - count_corner(c, a);
            c->open += turned ? -count : count;
        }
        if (i < parts->count && parts->high[i] > last)
            last = parts->high[i];
    }
}

/* Where on the edge from p to q a point of it is. */
static double place_on(const double p[2], const double q[2], const double x[2])
{
    const double u = q[0] - p[0], v = q[1] - p[1];
    return ((x[0] - p[0]) * u + (x[1] - p[1]) * v) / (u * u + v * v);
}

/* What is seen of the polygon's own side i. */
static void add_own(struct sight_eye *eye, struct casting *c, const struct outline_cell *cell,
                    int i)
{
    struct hidden_parts parts;
    const double *p = cell->p[i], *q = cell->p[i + 1 < cell->n ? i + 1 : 0];
    parts.count = 0;
    for (int s = 0; s < c->count; s++) {
        const struct body_shadow *shadow = &c->shadow[s];
        double low = 1, high = 0;
        for (int k = 0; k < shadow->n; k++)
            if (shadow->by[k] == i) {
                const double t0 = place_on(p, q, shadow->p[k]),
                             t1 = place_on(p, q, shadow->p[k + 1 < shadow->n ? k + 1 : 0]);
                low = t0 < low ? t0 : low;
                high = t1 > high ? t1 : high;
            }
        add_hidden(&parts, low, high);
    }
    add_rest(eye, c, p, q, &parts, 0);
}

/* What is seen beside an edge from p to q of shadow `own`. */
static void add_shadow(struct sight_eye *eye, struct casting *c, int own, const double p[2],
                       const double q[2])
{
    struct hidden_parts parts;
    parts.count = 0; /* no more of it is read */
    for (int s = 0; s < c->count; s++) {
        double low = 0, high = s == own ? 0 : 1;
        for (int k = c->first[s]; k < c->first[s + 1] && low < high; k++) {
            const struct body_line *other = &c->cut[k];
            narrow(other->a * p[0] + other->b * p[1] - other->c,
                   other->a * q[0] + other->b * q[1] - other->c, &low, &high);
        }
        add_hidden(&parts, low, high);
    }
    add_rest(eye, c, p, q, &parts, 1);
}

double sight_bodies_past(const struct sight *sight, const double x[3], const double n[3], double up,
                         const struct sight_bodies *bodies, double *whole)
{
    const struct outline_cell *cell = &sight->cell;
    struct casting c;
    struct sight_eye eye;
    double from[3];
    for (int k = 0; k < 3; k++)
        from[k] = x[k] + up * n[k];
    sight_eye_open(&eye, sight, x, n);
    sight_in_plane(&sight->raised, from, c.from);
    *whole = 0;
    if (!(eye.height > 0) || !(c.from[2] > 0))
        return 0;
    start_casting(&c, bodies, cell);
    for (int i = 0; i < bodies->count; i++) {
        const enum rest rest = cast_body(&c, bodies, &bodies->body[i], cell, c.grow * (i + 1));
        if (rest == REST_UNTOLD)
            return -1;
        if (rest == REST_ALL)
            return sight_eye_factor(&eye, whole);
    }
    if (c.count == 0) {
        (void)sight_eye_factor(&eye, whole);
        return *whole;
    }
    for (int i = 0; i < cell->n; i++)
        add_own(&eye, &c, cell, i);
    for (int s = 0; s < c.count; s++)
        for (int i = 0; i < c.shadow[s].n; i++)
            if (c.shadow[s].by[i] >= POLYGON_MAX)
                add_shadow(&eye, &c, s, c.shadow[s].p[i],
                           c.shadow[s].p[i + 1 < c.shadow[s].n ? i + 1 : 0]);
    const double seen = sight_eye_factor(&eye, whole);
    if (!(fabs(c.open) <= OPEN))
        return -1;
    return seen < *whole ? seen : *whole;
}
