/* sight_bodies.c - what a point sees of a convex polygon past convex solids.
 *
 * Each hides one convex polygon of the plane. Nothing is cut out: Lambert's sum goes around what is
 * seen, and that is the rim of the polygon, as far as it lies outside of all shadows, and the rims
 * of shadows, the other way round, as far as they lie in the polygon and outside of the others. How
 * far that is, is an interval of an edge for each shadow. Of a shadow's edges, those that the
 * polygon does not lie on both sides of need not be asked: it is beside one, or within. Shadows
 * that share an edge, as of boxes that stand in a row, are parted by growing each a little more
 * than the one before, by far less than counts and more than rounding moves them: of two edges in
 * one place one is inside of the other's shadow, or both are.
 * Invariant: as sight_pieces.c, but for that.
 * [the rim of a union of convex polygons, edge by edge; derived here]
 * SPDX-License-Identifier: MIT */
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
    *body = (struct sight_body){b->corners, b->planes, b->edges};
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
    return 1;
}

/* ---- shadows, point by point */

/* A shadow's edge through the polygon, from p to q as far as it lies in it; within the shadow, a u
 * + b v <= c. over[]: how far the polygon's corners are outside. */
struct body_line {
    double a, b, c, p[2], q[2], over[POLYGON_MAX];
};

/* A point's shadows that have an edge through the polygon. */
struct casting {
    double from[3], most;               /* the point; how high what casts shadows may be */
    double side[POLYGON_MAX][4];        /* planes from the point through the polygon's sides */
    int64_t out[SIGHT_BODY_CORNERS];    /* of corners: bits of the planes they are outside of */
    double at[2][SIGHT_BODY_CORNERS];   /* shadows, of those between */
    double height[SIGHT_BODY_PLANES];   /* of the point over planes */
    int count, first[SIGHT_BODIES + 1]; /* where their lines begin, and the last one's end */
    struct body_line line[SIGHT_BODY_EDGES]; /* of shadows, one after the other */
    double sum[2];                           /* of the edges that are gone around */
};

enum { OUT_ABOVE = 1 << POLYGON_MAX };

TOOL void casting_body(struct casting *c, const struct sight_bodies *b)
{
    const double x = c->from[0], y = c->from[1], z = c->from[2], most = c->most;
    const int corners = b->corners, planes = b->planes;
    double at[2][LANES]; /* its own: for all that compilers know, c is where b is */
    for (int i = 0; i < corners; i += LANES) {
        const double *u = b->corner[0] + i, *v = b->corner[1] + i, *h = b->corner[2] + i;
        int64_t out[LANES];
        for (int k = 0; k < LANES; k++)
            out[k] = (int64_t)(h[k] > most) << POLYGON_MAX;
        for (int e = 0; e < POLYGON_MAX; e++) {
            const double p0 = c->side[e][0], p1 = c->side[e][1], p2 = c->side[e][2],
                         p3 = c->side[e][3];
            for (int k = 0; k < LANES; k++)
                out[k] |= (int64_t)(p0 * u[k] + p1 * v[k] + p2 * h[k] > p3) << e;
        }
        for (int k = 0; k < LANES; k++) {
            const double t = z / (z - h[k]);
            at[0][k] = x + t * (u[k] - x);
            at[1][k] = y + t * (v[k] - y);
        }
        for (int k = 0; k < LANES; k++) {
            c->out[i + k] = out[k];
            c->at[0][i + k] = at[0][k];
            c->at[1][i + k] = at[1][k];
        }
    }
    for (int i = 0; i < planes; i += LANES) {
        const double *p0 = b->plane[0] + i, *p1 = b->plane[1] + i, *p2 = b->plane[2] + i,
                     *p3 = b->plane[3] + i;
        for (int k = 0; k < LANES; k++)
            at[0][k] = p0[k] * x + p1[k] * y + p2[k] * z - p3[k];
        for (int k = 0; k < LANES; k++)
            c->height[i + k] = at[0][k];
    }
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
#endif

static void start_casting(struct casting *c, const struct sight_bodies *b,
                          const struct outline_cell *cell)
{
    const double z = c->from[2];
    c->most = z * (1 - OUTLINE_BELOW_EYE);
    for (int i = 0, j = cell->n - 1; i < cell->n; j = i++) {
        const double g[3] = {cell->p[j][0] - c->from[0], cell->p[j][1] - c->from[1], -z},
                     h[3] = {cell->p[i][0] - c->from[0], cell->p[i][1] - c->from[1], -z};
        cross3(c->side[i], g, h);
        c->side[i][3] = dot3(c->side[i], c->from);
    }
    for (int i = cell->n; i < POLYGON_MAX; i++)
        c->side[i][0] = c->side[i][1] = c->side[i][2] = c->side[i][3] = 0;
    LANES_RUN(lanes_width(), casting_8, casting_4, casting_body, (c, b));
    c->count = c->first[0] = 0;
    c->sum[0] = c->sum[1] = 0;
}

/* The end at corner p of an edge to q, or of what of it is between the plane and `most`. */
static void end_of(const struct casting *c, const struct sight_bodies *b, int p, int q,
                   double end[2])
{
    const double z = b->corner[2][p], limit = z < 0 ? 0 : c->most;
    if (z >= 0 && z <= c->most) {
        end[0] = c->at[0][p];
        end[1] = c->at[1][p];
        return;
    }
    const double at = (limit - z) / (b->corner[2][q] - z), t = c->from[2] / (c->from[2] - limit);
    for (int k = 0; k < 2; k++) {
        const double x = b->corner[k][p] + at * (b->corner[k][q] - b->corner[k][p]);
        end[k] = c->from[k] + t * (x - c->from[k]);
    }
}

/* The part of a line that lies in the cell and between the ends of the edge, `to` the second one.
 * Returns 0 when none does. */
static int within(struct body_line *line, const struct outline_cell *cell, const double from[2],
                  double square)
{
    double at[2] = {0, 0}, x[2][2];
    int found = 0;
    for (int i = 0, j = cell->n - 1; i < cell->n && found < 2; j = i++) {
        const double g = line->over[j], h = line->over[i];
        if ((g > 0) == (h > 0))
            continue;
        const double t = g / (g - h);
        for (int k = 0; k < 2; k++)
            x[found][k] = cell->p[j][k] + t * (cell->p[i][k] - cell->p[j][k]);
        at[found] = (x[found][1] - from[1]) * line->a - (x[found][0] - from[0]) * line->b;
        found++;
    }
    if (found < 2)
        return 0;
    const int first = at[1] < at[0];
    const double least = at[first], most = at[!first], low = least > 0 ? least : 0,
                 high = most < square ? most : square;
    if (!(low < high))
        return 0;
    const double each = 1 / (most - least);
    for (int k = 0; k < 2; k++) {
        const double along = (x[!first][k] - x[first][k]) * each;
        line->p[k] = low > least ? x[first][k] + (low - least) * along : x[first][k];
        line->q[k] = high < most ? x[first][k] + (high - least) * along : x[!first][k];
    }
    return 1;
}

/* Edges' shadows shorter than this, of the size that counts, have no direction to rely on. */
static const double SHORT = 1e-9;

/* A point so near to a face's plane, of that size, may be on either side of it. */
static const double NEARLY = 1e-6;

enum sides { SIDES_NONE, SIDES_IN, SIDES_OUT, SIDES_BOTH };

/* An edge's shadow, from p to q, with the body on its left. Returns where the cell's corners are;
 * none: it is too short. */
static enum sides cast_edge(const struct casting *c, const struct sight_bodies *b, int p, int q,
                            const struct outline_cell *cell, double size, struct body_line *line,
                            double from[2], double *square)
{
    double to[2];
    int sides = 0;
    end_of(c, b, p, q, from);
    end_of(c, b, q, p, to);
    line->a = to[1] - from[1];
    line->b = from[0] - to[0];
    line->c = line->a * from[0] + line->b * from[1];
    *square = line->a * line->a + line->b * line->b;
    if (!(*square > SHORT * SHORT * size * size))
        return SIDES_NONE;
    for (int i = 0; i < cell->n; i++) {
        const double h = line->a * cell->p[i][0] + line->b * cell->p[i][1] - line->c;
        line->over[i] = h;
        sides |= (h > 0 ? SIDES_OUT : 0) | (h < 0 ? SIDES_IN : 0);
    }
    return (enum sides)sides;
}

/* The corner at which the outline's edge begins, the body on its left; -1: it is no outline. */
static int begins(const struct casting *c, const struct sight_body_edge *e)
{
    const int left = c->height[e->left] > 0, right = c->height[e->right] > 0;
    return left == right ? -1 : left ? e->from : e->to;
}

/* Does the shadow, no edge of which runs through the cell, cover it? */
static int covers(const struct casting *c, const struct sight_bodies *b,
                  const struct sight_body *body, const struct outline_cell *cell, double size)
{
    int outlines = 0, front = 0;
    for (int i = body->edge; i < body[1].edge; i++) {
        const struct sight_body_edge *e = &b->edge[i];
        const int p = begins(c, e), q = p == e->from ? e->to : e->from;
        struct body_line line;
        double from[2], square, h = 0;
        front |= p >= 0 || c->height[e->left] > 0;
        if (p < 0 || (c->out[p] & c->out[q] & OUT_ABOVE))
            continue;
        const enum sides sides = cast_edge(c, b, p, q, cell, size, &line, from, &square);
        for (int k = 0; k < cell->n && sides == SIDES_BOTH; k++)
            h += line.over[k];
        if (sides == SIDES_OUT || h > 0)
            return 0;
        outlines++;
    }
    return outlines || !front; /* without a front: the point is within */
}

/* A body's shadow, its lines from the last one's end on. Of a convex shadow that has an edge in the
 * cell no other edge tells what of the cell it hides. Returns 1 when it hides all. */
static int cast_body(struct casting *c, const struct sight_bodies *b, const struct sight_body *body,
                     const struct outline_cell *cell, double size, double grow)
{
    int lines = c->first[c->count];
    int64_t out = ~(int64_t)0;
    for (int i = body->corner; i < body[1].corner && out; i++)
        out &= c->out[i];
    if (out) /* all of it is beside a side, or above */
        return 0;
    for (int i = body->plane; i < body[1].plane; i++)
        if (fabs(c->height[i]) < NEARLY * size)
            return -1;
    for (int i = body->edge; i < body[1].edge; i++) {
        const struct sight_body_edge *e = &b->edge[i];
        const int p = begins(c, e), q = p == e->from ? e->to : e->from;
        if (p < 0 || (c->out[p] & c->out[q]))
            continue;
        struct body_line *line = &c->line[lines];
        double from[2], square;
        const enum sides sides = cast_edge(c, b, p, q, cell, size, line, from, &square);
        if (sides == SIDES_OUT)
            return 0;
        if (sides != SIDES_BOTH)
            continue;
        const double more = grow * sqrt(square);
        line->c += more;
        for (int k = 0; k < cell->n; k++)
            line->over[k] -= more;
        lines += within(line, cell, from, square);
    }
    if (lines == c->first[c->count])
        return covers(c, b, body, cell, size);
    c->first[++c->count] = lines;
    return 0;
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
            for (int k = 0; k < 2; k++)
                c->sum[k] += turned ? a[k] - b[k] : b[k] - a[k];
        }
        if (i < parts->count && parts->high[i] > last)
            last = parts->high[i];
    }
}

/* What is seen of the polygon's own edge, from corner j to i. */
static void add_own(struct sight_eye *eye, struct casting *c, const struct outline_cell *cell,
                    int j, int i)
{
    struct hidden_parts parts;
    parts.count = 0;
    for (int s = 0; s < c->count; s++) {
        double low = 0, high = 1;
        for (int k = c->first[s]; k < c->first[s + 1] && low < high; k++)
            narrow(c->line[k].over[j], c->line[k].over[i], &low, &high);
        add_hidden(&parts, low, high);
    }
    add_rest(eye, c, cell->p[j], cell->p[i], &parts, 0);
}

/* What is seen beside the edge of shadow `own`. */
static void add_shadow(struct sight_eye *eye, struct casting *c, int own,
                       const struct body_line *line)
{
    struct hidden_parts parts;
    parts.count = 0; /* no more of it is read */
    const double *p = line->p, *q = line->q;
    for (int s = 0; s < c->count; s++) {
        double low = 0, high = s == own ? 0 : 1;
        for (int k = c->first[s]; k < c->first[s + 1] && low < high; k++) {
            const struct body_line *other = &c->line[k];
            narrow(other->a * p[0] + other->b * p[1] - other->c,
                   other->a * q[0] + other->b * q[1] - other->c, &low, &high);
        }
        add_hidden(&parts, low, high);
    }
    add_rest(eye, c, p, q, &parts, 1);
}

/* How much more than the one before each shadow grows, of how large the polygon is and a hundredth
 * of how far away; chosen: rounding moves shadows a tenth of that and less. */
static const double GROWS = 1e-11, AWAY = 1e-2;
/* A rim that does not come back to where it began within so much has lost an edge, or has one too
 * many. */
static const double OPEN = 1e-8;

double sight_bodies_past(const struct sight *sight, const double x[3], const double n[3], double up,
                         const struct sight_bodies *bodies, double *whole)
{
    const struct outline_cell *cell = &sight->cell;
    struct casting c;
    struct sight_eye eye;
    double from[3], size = 0;
    for (int k = 0; k < 3; k++)
        from[k] = x[k] + up * n[k];
    sight_eye_open(&eye, sight, x, n);
    sight_in_plane(&sight->raised, from, c.from);
    *whole = 0;
    if (!(eye.height > 0) || !(c.from[2] > 0))
        return 0;
    for (int i = 0; i < cell->n; i++)
        for (int k = 0; k < 2; k++)
            size = fabs(cell->p[i][k]) > size ? fabs(cell->p[i][k]) : size;
    size += AWAY * (fabs(c.from[0]) + fabs(c.from[1]) + c.from[2]);
    start_casting(&c, bodies, cell);
    for (int i = 0; i < bodies->count; i++) {
        const int all = cast_body(&c, bodies, &bodies->body[i], cell, size, GROWS * size * (i + 1));
        if (all)
            return all < 0 ? -1 : sight_eye_factor(&eye, whole);
    }
    if (c.count == 0) {
        (void)sight_eye_factor(&eye, whole);
        return *whole;
    }
    for (int i = 0, j = cell->n - 1; i < cell->n; j = i++)
        add_own(&eye, &c, cell, j, i);
    for (int s = 0; s < c.count; s++)
        for (int i = c.first[s]; i < c.first[s + 1]; i++)
            add_shadow(&eye, &c, s, &c.line[i]);
    const double seen = sight_eye_factor(&eye, whole);
    if (fabs(c.sum[0]) + fabs(c.sum[1]) > OPEN * size)
        return -1;
    return seen < *whole ? seen : *whole;
}
