/* exchange_sight.c - the exchange area of two faces past what stands between them.
 *
 * Of each face only what lies in front of the other's plane takes part. The one on which a
 * blocker's shadow moves least from point to point is cut into pieces. From a piece nothing stands
 * between (then it has the exact factor), or all is hidden, both proved by a shaft; else a rule of
 * points, each of which sees the other face exactly (sight_pieces.c): it tells which share of what
 * the piece would exchange with nothing between, which is exact, it does exchange. A piece is held
 * against a rule with points along its rim, since shades as of a sill are seen from there alone,
 * and against its four quarters; these count. Two rules may agree by chance; so what the best
 * quadratic leaves of all points' values counts as well (face_rule.h): a shade's edge is none. And
 * so does what the points' sum is off where nothing stands between, which is known: near a foot
 * most is exchanged where none of them is; and what it is off of faces near the piece, which is
 * known, too (sight_near.h). The piece with the largest error is cut first, until
 * the root of the sum of their squares is small enough or the pieces run out: errors of pieces
 * have either sign. Pieces with more in their shaft than points can look past have 1024 rays each,
 * and are cut too. Invariant: pieces cover the part once; what is proved is not cut; none
 * exchanges more than with nothing between. What shades may be that meet no point counts as error
 * at the most (sight_missed.h), down to small pieces. Fails: light through gaps between shades that
 * meets no point of a piece, nor of its rim.
 * [globally adaptive cubature: van Dooren & de Ridder 1976; the rest derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_sight.h"
#include "engine/face_rule.h"
#include "engine/sight_missed.h"
#include "engine/sight_near.h"
#include "engine/sight_outlines.h"
#include "engine/sight_rays.h"
#include "engine/sight_rims.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "kernel/polygon_factor.h"
#include "kernel/shaft.h"
#include "visibility/candidates.h"

/* RAYS: of a piece with too much between for points. They take as long as finding what that is, and
 * it counts as so many pieces, of which an equal number of rays may be cast. */
enum { QUARTERS = 4, MANY = SIGHT_LIST + 1, RAYS = 1024, RAYS_COUNT = 16 };

struct sight_node {
    struct element piece;
    double clear;                /* with nothing between (m2) */
    double points, value, error; /* by its own points; by its quarters' (m2) */
    double rest;                 /* of what its points and those on its rim see (m2) */
    double unseen;               /* what of `clear` its points do not stand for (m2) */
    int count, quarters; /* how many blockers, 0 when proved, MANY; index of the first quarter */
    int by_rays;         /* 1: as what stands between is too much for points to look past */
    double seen[FACE_RULE], whole[FACE_RULE]; /* of the other face, by the points inside */
};

/* A pair at work. */
struct looking {
    const struct exchange_tree *tree;
    const struct element *from, *to;
    struct sight sight;
    struct sight_scratch *scratch;
    struct sight_limits limits;
    int believes; /* 1: in rules that tell enough */
    int nodes, roots, heap;
    int cast;             /* of the nodes, by rays */
    int by_bodies;        /* 1: what is in scratch->between is in scratch->bodies */
    int joined;           /* 1: a solid that stands on `from` touches `to`, or holds it */
    uint32_t on;          /* the element that `from` is, or is part of */
    int shared;           /* 1: scratch->between is the pair's, and does for all pieces */
    int between_of;       /* else: the node that it is of; -1: of none */
    double value, square; /* of the sum, and of its error (m2, m4) */
    double clear;         /* of the roots (m2) */
};

int sight_scratch_open(struct sight_scratch *scratch, const struct sight_limits *limits)
{
    size_t most = (size_t)limits->pieces;
    scratch->limits = *limits;
    scratch->nodes = malloc(most * sizeof *scratch->nodes);
    scratch->lists = malloc((most * (size_t)limits->list + 1) * sizeof *scratch->lists);
    scratch->heap = malloc(most * sizeof *scratch->heap);
    scratch->between = malloc(sizeof *scratch->between);
    scratch->bodies = malloc(sizeof *scratch->bodies);
    scratch->known = calloc(1, sizeof *scratch->known);
    for (int i = 0; i < 2; i++)
        face_fit_open(&scratch->fit[i], 3 + i);
    return scratch->nodes && scratch->lists && scratch->heap && scratch->between && scratch->bodies
                   && scratch->known
               ? 0
               : -1;
}

void sight_scratch_close(struct sight_scratch *scratch)
{
    free(scratch->nodes);
    free(scratch->lists);
    free(scratch->heap);
    free(scratch->between);
    free(scratch->bodies);
    free(scratch->known);
}

/* A piece of e with these corners. */
static void make_piece(struct element *piece, const struct element *e, const double (*v)[3], int n)
{
    double sum[3] = {0, 0, 0}, square = 0;
    *piece = *e;
    piece->vertices = (uint8_t)n;
    piece->area = 0;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            piece->vertex[i][k] = v[i][k];
    for (int i = 2; i < n; i++) {
        double a[3], b[3], c[3];
        sub3(a, v[i - 1], v[0]);
        sub3(b, v[i], v[0]);
        cross3(c, a, b);
        double area = 0.5 * dot3(c, e->normal);
        piece->area += area;
        for (int k = 0; k < 3; k++)
            sum[k] += area * (v[0][k] + v[i - 1][k] + v[i][k]) * (1 / 3.0);
    }
    for (int k = 0; k < 3; k++)
        piece->centre[k] = piece->area > 0 ? sum[k] / piece->area : v[0][k];
    for (int i = 0; i < n; i++) {
        double d[3];
        sub3(d, v[i], piece->centre);
        square = fmax(square, dot3(d, d));
    }
    piece->radius = sqrt(square);
}

/* How far from the middle of its sides a piece is cut, at the most, as a share of them; measured.
 */
static const double OFF_MIDDLE = 0.125;

static void between_at(double out[3], const double a[3], const double b[3], double t)
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] + t * (b[k] - a[k]);
}

/* Quarter q of a piece, cut near the middles of its sides, and nowhere the same: where shades
 * repeat, as those of slats do, quarters of one size would all be off alike. */
static void make_quarter(struct element *out, const struct element *e, int q)
{
    int n = e->vertices;
    const double(*v)[3] = (const double(*)[3])e->vertex;
    double t[4] = {0}, m[4][3], p[4][3], centre[3];
    for (int i = 0; i < n; i++) {
        t[i] = n == 4 && i >= 2
                   ? 1 - t[i - 2]
                   : 0.5 + OFF_MIDDLE * (2 * hash_unit(e->id + (uint64_t)(QUARTERS + i + 1)) - 1);
        between_at(m[i], v[i], v[i + 1 < n ? i + 1 : 0], t[i]);
    }
    between_at(centre, m[0], m[n == 4 ? 2 : 1], t[1]); /* of a quad */
    for (int k = 0; k < 3; k++) {
        if (n == 3) { /* the last one is the middle */
            p[0][k] = q < 3 ? v[q][k] : m[0][k];
            p[1][k] = q < 3 ? m[q][k] : m[1][k];
            p[2][k] = q < 3 ? m[(q + 2) % 3][k] : m[2][k];
        } else {
            p[0][k] = v[q][k];
            p[1][k] = m[q][k];
            p[2][k] = centre[k];
            p[3][k] = m[(q + 3) % 4][k];
        }
    }
    make_piece(out, e, (const double(*)[3])p, n);
    out->id = hash64(e->id + (uint64_t)q + 1);
}

static uint32_t *list_of(const struct looking *l, int at)
{
    return l->scratch->lists + (size_t)at * (size_t)l->scratch->limits.list;
}

/* What stands between, for points to look past it; by solids no more than can be cut out, which a
 * point does that these do not tell. Returns -1 when it is too much. */
static int place_between(struct looking *l)
{
    struct sight_between *b = l->scratch->between;
    l->by_bodies =
        !b->bent && b->faces <= SIGHT_CUT
        && sight_bodies_place(l->scratch->bodies, l->tree, b->list, b->faces, &l->sight.raised);
    return l->by_bodies ? 0 : sight_between_place(b, l->tree, &l->sight);
}

/* What a point sees past what stands between: solids, if they alone do, by the rims of their
 * shadows, unless rounding leaves open where these run. Else outlines save most where faces go on
 * into each other; faces by themselves, and bent ones, are cut out one by one. Many faces leave
 * parts that each meet few of them, and many edges part what is hidden, too. */
static double past_faces(const struct looking *l, const double x[3], const double n[3],
                         double *whole)
{
    struct sight_between *b = l->scratch->between;
    const double up = l->tree->lift;
    if (l->by_bodies) {
        const double seen = sight_rims_past(&l->sight, x, n, up, l->scratch->bodies, whole);
        if (seen >= 0)
            return seen;
        return sight_factor(&l->sight, x, n, up, l->tree, b->list, b->faces, whole);
    }
    /* edges of two faces; measured */
    const int most = b->faces > SIGHT_SHORT && b->faces <= SIGHT_CUT ? 3 : 4;
    return !b->bent && 2 * b->edges <= most * b->faces
               ? sight_past(&l->sight, x, n, up, b, whole)
               : sight_factor(&l->sight, x, n, up, l->tree, b->list, b->faces, whole);
}

/* Faces in the plane of an end stand before nothing there, as rays start beyond them. A solid that
 * joins both ends has one in the plane of each, and from where it stands only its sides would stop
 * what goes through it; so points in it see nothing. */
static double past(const struct looking *l, const double x[3], const double n[3], double *whole)
{
    const double seen = past_faces(l, x, n, whole), up = l->tree->host.ray_offset;
    const double over[3] = {x[0] + up * n[0], x[1] + up * n[1], x[2] + up * n[2]};
    return l->joined && bodies_hold(&l->tree->bodies, &l->tree->h, l->on, over) ? 0 : seen;
}

/* What the points within a piece see of the other face, and would; `rim`: those on its rim. Returns
 * the means over the piece. */
static struct mean {
    double seen, whole;
} by_points(const struct looking *l, const struct element *e, int rim, double *seen, double *whole)
{
    struct face_rule rule;
    struct mean sum = {0, 0};
    face_rule_of(&rule, e, rim);
    for (int i = 0; i < rule.count; i++) {
        const double x[3] = {rule.x[0][i], rule.x[1][i], rule.x[2][i]};
        if (!(rim && e->vertices == 4 && i == FACE_MIDDLE)) /* the middle is seen already */
            seen[i] = past(l, x, e->normal, &whole[i]);
        sum.seen += rule.weight[i] * seen[i] / rule.all;
        sum.whole += rule.weight[i] * whole[i] / rule.all;
    }
    return sum;
}

static double share(struct mean m)
{
    return m.seen > 0 ? fmin(m.seen / m.whole, 1) : 0;
}

/* What so many rays leave of a clear view (m2); *error: the standard error of that. */
static double seen_by_rays(const struct element *r, const struct element *s,
                           const struct exchange_tree *t, int rays, double clear, double *error)
{
    const double share = sight_rays(r, s, rays_host(t->rays), rays, error);
    *error *= clear;
    return clear * share;
}

/* A piece with more between than points can look past. */
static void by_rays(struct looking *l, struct sight_node *node)
{
    node->by_rays = 1;
    l->cast++;
    node->clear = node->piece.area * polygon_factor(&node->piece, l->to, 1);
    node->points = node->value =
        seen_by_rays(&node->piece, l->to, l->tree, RAYS, node->clear, &node->error);
}

/* What stands between a piece and the other face: of the list or of the whole scene. Of all of the
 * face it is known; when that is little, few pieces would be proved to see all or nothing, and what
 * does not stand before them costs less than looking for what does. */
static enum between find_between(struct looking *l, const struct element *piece, int all,
                                 const uint32_t *list, int count)
{
    const struct host *host = &l->tree->host;
    struct sight_between *between = l->scratch->between;
    struct shaft shaft;
    uint32_t own[SIGHT_LIST];
    enum between stands = BETWEEN_SOME;
    if (l->shared)
        return piece->area > 0 ? BETWEEN_SOME : BETWEEN_ALL;
    l->between_of = -1;
    if (!all) {
        if (!(piece->area > 0) || !shaft_open(&shaft, piece, l->to, host))
            return BETWEEN_ALL;
        if (count == MANY) {
            count = host->candidates(host, &shaft, SIGHT_LIST, own);
            if (count == HOST_HIDDEN)
                return BETWEEN_ALL;
            between->faces = MANY;
            if (count > SIGHT_LIST)
                return BETWEEN_MANY;
            sight_list_sort(own, count);
            list = own;
        }
        stands = sight_between_find(between, l->tree, &shaft, list, count, 0);
    }
    return stands == BETWEEN_SOME && place_between(l) < 0 ? BETWEEN_MANY : stands;
}

/* What was found to stand before a piece is of use to its quarters. Returns how much that is. */
static int keep_list(const struct looking *l, int at)
{
    const struct sight_between *b = l->scratch->between;
    if (b->faces != MANY)
        memcpy(list_of(l, at), b->list, (size_t)b->faces * sizeof *b->list);
    return b->faces;
}

/* So much of what points misjudge of faces near them counts. Measured: with half of it mazes take a
 * seventh more time for no less error, and rows of sheets are off by a fifth less. */
static const double MISJUDGED = 0.25;

/* What of a piece's shade its points do not stand for, as what casts it is near (m2): of what they
 * misjudge of these faces, as much as goes to the other face of all that these take. Small scenes
 * do without: there it costs three times as much, and errors are a sixth of the tolerance anyway.
 */
static double misjudged(const struct looking *l, const struct sight_node *node, struct mean m)
{
    const struct sight_between *b = l->scratch->between;
    const double hidden = node->piece.area * (m.whole - m.seen);
    double sum;
    if (!l->limits.many || !(hidden > 0))
        return 0;
    const double off =
        sight_near(&node->piece, l->tree, b->list, b->faces, l->scratch->known, &sum);
    return MISJUDGED * (hidden < sum ? off * hidden / sum : off);
}

/* What a piece sees, by its own points, past those of the list that stand in its shaft. */
static void measure(struct looking *l, int at, int all, const uint32_t *list, int count)
{
    struct sight_node *node = &l->scratch->nodes[at];
    node->count = node->quarters = node->by_rays = 0;
    node->clear = node->points = node->value = node->error = node->unseen = 0;
    switch (find_between(l, &node->piece, all, list, count)) {
    case BETWEEN_ALL:
        return;
    case BETWEEN_MANY:
        node->count = keep_list(l, at);
        by_rays(l, node);
        return;
    case BETWEEN_NOTHING:
        node->clear = node->piece.area * polygon_factor(&node->piece, l->to, 1);
        node->points = node->value = node->clear;
        return;
    case BETWEEN_SOME:
        node->count = keep_list(l, at);
        l->between_of = at;
        const struct mean m = by_points(l, &node->piece, 0, node->seen, node->whole);
        node->clear = node->piece.area * polygon_factor(&node->piece, l->to, 1);
        node->points = node->value = node->clear * share(m);
        node->unseen = fmax(fabs(node->clear - node->piece.area * m.whole), misjudged(l, node, m));
    }
}

double sight_rest(const struct face_fit *fit, const double *seen, const double *whole, double share,
                  double clear)
{
    double hidden[2 * FACE_RULE], all = 0;
    for (int i = 0; i < fit->count; i++) {
        hidden[i] = seen[i] - share * whole[i];
        all += whole[i] / fit->count;
    }
    return all > 0 ? face_fit_rest(fit, hidden) * clear / all : 0;
}

/* How far a piece's points are from telling its exchange (m2): what the two rules differ by, or
 * what the best quadratic leaves. */
static double rest_of(struct looking *l, struct sight_node *node, double *differ)
{
    double seen[2 * FACE_RULE], whole[2 * FACE_RULE];
    const int inside = face_rule_count(node->piece.vertices, 0);
    memcpy(seen, node->seen, sizeof node->seen);
    memcpy(whole, node->whole, sizeof node->whole);
    seen[inside + FACE_MIDDLE] = seen[FACE_MIDDLE];
    whole[inside + FACE_MIDDLE] = whole[FACE_MIDDLE];
    const struct mean rim = by_points(l, &node->piece, 1, seen + inside, whole + inside);
    *differ = fabs(node->points - node->clear * share(rim));
    return sight_rest(&l->scratch->fit[node->piece.vertices - 3], seen, whole,
                      node->clear > 0 ? node->points / node->clear : 0, node->clear);
}

/* Are there so many pieces left? */
static int has_room(const struct looking *l, int pieces)
{
    return l->nodes + l->cast * (RAYS_COUNT - 1) + pieces <= l->limits.pieces;
}

/* At most what is missed of a piece's shades, where neither its own points nor, if there are any,
 * its quarters' see them; no more than it exchanges (m2). 0 of small pieces. */
static double missed(const struct looking *l, int at)
{
    const struct sight_node *node = &l->scratch->nodes[at],
                            *quarters = &l->scratch->nodes[node->quarters];
    /* In small scenes a shade has to be seen twice: once may be on its fringe, which does not tell
     * how dark it is between points. In others that takes up to a sixth longer for a tenth less
     * error */
    const int most = l->believes ? SIGHT_MISSED_MANY : SIGHT_MISSED,
              enough = l->limits.many ? 1 : 2;
    struct sight_eyes eyes;
    if (!(node->piece.area * most > l->from->area))
        return 0;
    sight_eyes_open(&eyes, &l->sight, l->tree->lift, enough);
    sight_eyes_add(&eyes, &node->piece);
    for (int q = 0; q < QUARTERS && node->quarters; q++)
        sight_eyes_add(&eyes, &quarters[q].piece);
    return fmin(sight_missed(&eyes, &node->piece, l->to, l->tree, list_of(l, at), node->count,
                             l->scratch->known),
                node->value);
}

/* Hold a piece against its quarters, which count from now on. */
static void divide(struct looking *l, int at)
{
    struct sight_node *nodes = l->scratch->nodes, *node = &nodes[at];
    const double before = node->error;
    double noise = 0;
    if (!has_room(l, QUARTERS * (node->by_rays ? RAYS_COUNT : 1))) {
        if (!node->by_rays) /* the pieces have run out: as far as is known */
            node->error = SIGHT_UNKNOWN * node->points;
        return;
    }
    node->quarters = l->nodes;
    node->value = 0;
    double unseen = 0;
    for (int q = 0; q < QUARTERS; q++) {
        struct sight_node *quarter = &nodes[l->nodes++];
        make_quarter(&quarter->piece, &node->piece, q);
        measure(l, l->nodes - 1, 0, list_of(l, at), node->count);
        node->value += quarter->value;
        unseen += quarter->unseen;
        const double of = quarter->by_rays ? quarter->error : before;
        noise += of * of;
    }
    if (node->by_rays) {
        node->error = sqrt(noise); /* few rays agree by chance, and quarters may be new */
        return;
    }
    node->error =
        fmax(fmax(fabs(node->value - node->points), SIGHT_REST_QUARTERS * node->rest), unseen);
    node->error += missed(l, at);
}

/* Do all points of a piece, which differ from those on its rim by so much, see the same share, all
 * or nothing? */
static int tells_alike(const struct sight_node *node, double differ)
{
    const double rounding = 1e-6 * node->clear;
    return (node->points <= rounding || node->points >= node->clear - rounding)
           && differ <= rounding;
}

/* Hold a piece against its rim and its quarters; in scenes of many faces, whose entries are many,
 * not where its points tell it to its share of what is aimed at, `aim` per area. Also where those
 * inside tell that it has to be cut, its rim is asked: they may agree with its quarters' by chance
 * past a shade that lies along a side, as a seat's on its legs. */
static void compare(struct looking *l, int at, double aim)
{
    struct sight_node *node = &l->scratch->nodes[at];
    double differ;
    if (node->count == 0)
        return;
    if (!node->by_rays && has_room(l, QUARTERS)) {
        if (l->between_of != at)
            (void)find_between(l, &node->piece, 0, list_of(l, at), node->count);
        node->rest = rest_of(l, node, &differ);
        node->error = fmax(SIGHT_REST * fmax(node->rest, differ), node->unseen);
        if (at < l->roots && tells_alike(node, differ))
            node->error = fmax(node->error, SIGHT_ALIKE * node->clear);
        if (node->error <= aim * node->piece.area)
            node->error += missed(l, at);
        if (node->error <= aim * node->piece.area)
            return;
    }
    divide(l, at);
}

/* The heap: the node with the largest error first. */
static void heap_in(struct looking *l, int at)
{
    const struct sight_node *nodes = l->scratch->nodes;
    int *heap = l->scratch->heap, i = l->heap++;
    for (; i > 0 && nodes[heap[(i - 1) / 2]].error < nodes[at].error; i = (i - 1) / 2)
        heap[i] = heap[(i - 1) / 2];
    heap[i] = at;
}

static int heap_out(struct looking *l)
{
    const struct sight_node *nodes = l->scratch->nodes;
    int *heap = l->scratch->heap, first = heap[0], last = heap[--l->heap], i = 0;
    for (int next; (next = 2 * i + 1) < l->heap; i = next) {
        if (next + 1 < l->heap && nodes[heap[next + 1]].error > nodes[heap[next]].error)
            next++;
        if (!(nodes[heap[next]].error > nodes[last].error))
            break;
        heap[i] = heap[next];
    }
    heap[i] = last;
    return first;
}

static void count_in(struct looking *l, int at)
{
    const struct sight_node *node = &l->scratch->nodes[at];
    l->value += node->value;
    l->square += node->error * node->error;
    if (node->quarters)
        heap_in(l, at);
}

static void start(struct looking *l, const double (*v)[3], int n, int all, const uint32_t *list,
                  int count)
{
    struct sight_node *node = &l->scratch->nodes[l->nodes];
    make_piece(&node->piece, l->from, v, n);
    measure(l, l->nodes, all, list, count);
    l->clear += node->clear;
    l->nodes++;
}

static double integrate(struct looking *l, const struct polygon *part, int all,
                        const uint32_t *list, int count, double least, double *error)
{
    const struct sight_limits *limits = &l->limits;
    struct sight_node *nodes = l->scratch->nodes;
    const double(*v)[3] = (const double(*)[3])part->v;
    start(l, v, part->n < 4 ? part->n : 4, all, list, count);
    if (part->n == 5) {
        const double rest[3][3] = {
            {v[0][0], v[0][1], v[0][2]}, {v[3][0], v[3][1], v[3][2]}, {v[4][0], v[4][1], v[4][2]}};
        start(l, rest, 3, 0, list, count);
    }
    double aim = l->believes ? SIGHT_BELIEVED * limits->tolerance
                                   * fmax(nodes[0].points + (l->nodes > 1 ? nodes[1].points : 0),
                                          limits->floor * least)
                                   / l->from->area
                             : -1;
    l->roots = l->nodes;
    for (int i = 0; i < l->roots; i++) {
        compare(l, i, aim);
        count_in(l, i);
    }
    while (l->heap > 0 && has_room(l, QUARTERS * QUARTERS)
           && !sight_enough(limits, sqrt(fmax(l->square, 0)), l->value, least)) {
        int at = heap_out(l), quarters = nodes[at].quarters;
        l->value -= nodes[at].value;
        l->square -= nodes[at].error * nodes[at].error;
        for (int q = 0; q < QUARTERS; q++) {
            compare(l, quarters + q, aim);
            count_in(l, quarters + q);
        }
    }
    *error = sqrt(fmax(l->square, 0));
    return fmax(l->value, 0);
}

/* The part of e in front of a plane; corners within `flat` of it lie in it. Where rounding puts the
 * ends of a shared edge on either side, a clip at no distance would add a corner on the edge.
 * Returns 1 when that is all of it. */
static int clip_front(struct polygon *out, const struct element *e, const struct element *plane,
                      double flat)
{
    double h[4];
    int front = 0, behind = 0;
    for (int i = 0; i < e->vertices; i++) {
        h[i] = height3(e->vertex[i], plane->centre, plane->normal);
        if (fabs(h[i]) <= flat)
            h[i] = 0;
        front += h[i] > 0;
        behind += h[i] < 0;
    }
    out->n = front ? polygon_divide(&e->vertex[0][0], e->vertices, 3, h, POLYGON_MAX, &out->v[0][0],
                                    NULL, NULL)
                   : 0;
    if (out->n < 3)
        out->n = 0;
    return !behind;
}

/* How large e looks from the nearest of the faces: seen from another point of e, their shadows move
 * by so much. */
static double sway(const struct element *e, const struct exchange_tree *t, const uint32_t *list,
                   int count)
{
    double least = INFINITY;
    for (int i = 0; i < count; i++) {
        const struct element *face = &t->h.elements[list[i]];
        double apart[3], most = least + face->radius;
        sub3(apart, face->centre, e->centre);
        if (dot3(apart, apart) > most * most) /* all of it is farther */
            continue;
        least = fmin(least, polygon_distance(e->centre, (const double(*)[3])face->vertex,
                                             face->vertices, face->normal));
    }
    return e->radius / (least + e->radius);
}

/* So many rays of a pair, in a scene of many polygons, whose clear view is no more than this share
 * of the error that is allowed: what they leave open is 1/8 of that view at the most, as a standard
 * error. Chosen: a 30th of what is allowed. */
enum { FAINT_RAYS = 16 };
static const double FAINT = 0.25;

/* Most pairs of a large scene exchange next to nothing, and have the most between them. */
static int is_faint(const struct sight_limits *limits, double clear, double least)
{
    return clear <= FAINT * limits->tolerance * limits->floor * least;
}

/* Of faces that differ by so much in area the points are on the smaller one: of a large face few
 * see any of it through a slot, and of it all see some of the large one. Measured: 4 to 16 do for
 * fins, 64 is too much, and where all is alike in size shadows that sway less tell more. */
static const double SMALLER = 16;

/* How near two planes are to be one, by offsets of rays: ends are moved off by one, and what is
 * nearer stands before nothing. */
static const double JOINED = 4;

double sight_pair(const struct element *r, const struct element *s, const struct exchange_tree *t,
                  const struct sight_list *among, struct sight_scratch *scratch, int again,
                  double *error)
{
    const int believes = scratch->limits.many && !again;
    double least = fmin(r->area, s->area);
    const struct host *host = &t->host;
    const uint32_t on_r = t->h.face_element[r->face], on_s = t->h.face_element[s->face];
    uint32_t own[SIGHT_LIST];
    struct shaft shaft;
    *error = 0;
    if (bodies_cover(&t->bodies, &t->h, on_r) || bodies_cover(&t->bodies, &t->h, on_s)
        || !shaft_open(&shaft, r, s, host))
        return 0;
    int count = among ? sight_list_near(among, t, &shaft, own)
                      : host->candidates(host, &shaft, SIGHT_LIST, own);
    if (count == HOST_HIDDEN)
        return 0;
    const double clear = fmin(r->area * polygon_factor(r, s, 1), least);
    if (count == 0)
        return clear;
    if (believes && is_faint(&scratch->limits, clear, least))
        return seen_by_rays(r, s, t, FAINT_RAYS, clear, error);
    int many = count > SIGHT_LIST; /* the larger one is cut: shafts shrink most */
    if (!many && !among)
        sight_list_sort(own, count);
    const enum between stands =
        many ? BETWEEN_MANY : sight_between_find(scratch->between, t, &shaft, own, count, 1);
    if (stands == BETWEEN_ALL)
        return 0;
    if (stands == BETWEEN_NOTHING)
        return clear;
    const int apart = r->area * SMALLER < s->area || s->area * SMALLER < r->area;
    double sway_r = many ? -r->radius : sway(r, t, own, count),
           sway_s = many ? -s->radius : sway(s, t, own, count);
    int from_r = apart ? r->area < s->area : sway_r < sway_s || (sway_r == sway_s && r->id < s->id);
    const double near = JOINED * host->ray_offset;
    const int joins_r = bodies_join(&t->bodies, &t->h, on_r, s, near),
              joins_s = bodies_join(&t->bodies, &t->h, on_s, r, near);
    if (joins_r != joins_s)
        from_r = joins_r;
    struct looking l = {.tree = t,
                        .from = from_r ? r : s,
                        .to = from_r ? s : r,
                        .joined = joins_r || joins_s,
                        .on = from_r ? on_r : on_s,
                        .scratch = scratch,
                        .limits = sight_limits_of(&scratch->limits, t, r, s),
                        .believes = believes};
    struct polygon part, seen;
    const int all = clip_front(&part, l.from, l.to, host->flat) && stands == BETWEEN_SOME;
    polygon_clip(&seen, (const double(*)[3])l.to->vertex, l.to->vertices, l.from->centre,
                 l.from->normal);
    if (part.n == 0 || seen.n == 0)
        return 0;
    sight_open(&l.sight, l.to, &seen, t->lift);
    /* of bent faces one too many may hide what it does not stand before */
    l.shared = stands == BETWEEN_SOME && !scratch->between->bent
               && scratch->between->faces <= SIGHT_SHARED && place_between(&l) == 0;
    double sum = integrate(&l, &part, all, own, many ? MANY : count, least, error);
    if (!(sum > SIGHT_NEARLY_CLEAR * l.clear))
        return sum;
    return fmin(sum, clear);
}
