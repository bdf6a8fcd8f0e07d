/* sight_cubature.c - what one face exchanges with another past what stands between, integrated over
 * pieces of the one.
 *
 * Of each face only what lies in front of the other's plane takes part. From a piece nothing stands
 * between (then it has the exact factor), or all is hidden, both proved by a shaft; else a rule of
 * points, each of which sees the other face exactly (sight_look.h): it tells which share of what
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
 * at the most (sight_missed.h), down to small pieces; so does a share of what dark pieces might
 * see. Fails: light through gaps between shades that meets no point of a small piece, nor of its
 * rim, nor of any in scenes of many polygons.
 * [globally adaptive cubature: van Dooren & de Ridder 1976; the rest derived here]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/face_rule.h"
#include "engine/sight_cubature.h"
#include "engine/sight_lists.h"
#include "engine/sight_look.h"
#include "engine/sight_missed.h"
#include "engine/sight_near.h"
#include "engine/sight_parts.h"
#include "engine/sight_rays.h"
#include "kernel/constants.h"
#include "kernel/polygon_factor.h"
#include "kernel/shaft.h"

/* RAYS: of a piece with too much between for points. They take as long as finding what that is, and
 * it counts as so many pieces, of which an equal number of rays may be cast. */
enum { QUARTERS = SIGHT_QUARTERS, MANY = SIGHT_LIST + 1, RAYS = 1024, RAYS_COUNT = 16 };

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
    struct sight_ends ends;
    struct sight_look look;
    struct sight_scratch *scratch;
    struct sight_limits limits;
    double least; /* the smaller area (m2) */
    int nodes, roots, heap;
    int cast;             /* of the nodes, by rays */
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

static uint32_t *list_of(const struct looking *l, int at)
{
    return l->scratch->lists + (size_t)at * (size_t)l->scratch->limits.list;
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
            seen[i] = sight_look_from(&l->look, x, e->normal, &whole[i]);
        sum.seen += rule.weight[i] * seen[i] / rule.all;
        sum.whole += rule.weight[i] * whole[i] / rule.all;
    }
    return sum;
}

static double share(struct mean m)
{
    return m.seen > 0 ? fmin(m.seen / m.whole, 1) : 0;
}

/* A piece with more between than points can look past. */
static void by_rays(struct looking *l, struct sight_node *node)
{
    node->by_rays = 1;
    l->cast++;
    node->clear = node->piece.area * polygon_factor(&node->piece, l->ends.to, 1);
    node->points = node->value = sight_rays_leave(
        &node->piece, l->ends.to, rays_host(l->ends.tree->rays), RAYS, node->clear, &node->error);
}

/* What stands between a piece and the other face: of the list or of the whole scene. Of all of the
 * face it is known; when that is little, few pieces would be proved to see all or nothing, and what
 * does not stand before them costs less than looking for what does. */
static enum between find_between(struct looking *l, const struct element *piece, int all,
                                 const uint32_t *list, int count)
{
    const struct host *host = &l->ends.tree->host;
    struct sight_between *between = l->scratch->between;
    struct shaft shaft;
    uint32_t own[SIGHT_LIST];
    enum between stands = BETWEEN_SOME;
    if (l->shared)
        return piece->area > 0 ? BETWEEN_SOME : BETWEEN_ALL;
    l->between_of = -1;
    if (!all) {
        if (!(piece->area > 0) || !shaft_open(&shaft, piece, l->ends.to, host))
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
        stands = sight_between_find(between, l->ends.tree, &shaft, list, count, 0);
    }
    return stands == BETWEEN_SOME && sight_look_place(&l->look) < 0 ? BETWEEN_MANY : stands;
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
        sight_near(&node->piece, l->ends.tree, b->list, b->faces, l->scratch->known, &sum);
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
        node->clear = node->piece.area * polygon_factor(&node->piece, l->ends.to, 1);
        node->points = node->value = node->clear;
        return;
    case BETWEEN_SOME:
        node->count = keep_list(l, at);
        l->between_of = at;
        const struct mean m = by_points(l, &node->piece, 0, node->seen, node->whole);
        node->clear = node->piece.area * polygon_factor(&node->piece, l->ends.to, 1);
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
 * its quarters' see them; no more than it exchanges (m2). Where all is dark it is light that may be
 * missed, between two shades: not at the most, but as of SIGHT_ALIKE. 0 of small pieces. */
static double missed(const struct looking *l, int at)
{
    const struct sight_node *node = &l->scratch->nodes[at],
                            *quarters = &l->scratch->nodes[node->quarters];
    /* In small scenes a shade has to be seen twice: once may be on its fringe, which does not tell
     * how dark it is between points. In others that takes up to a sixth longer for a tenth less
     * error */
    const int most = l->ends.believes ? SIGHT_MISSED_MANY : SIGHT_MISSED,
              enough = l->limits.many ? 1 : 2;
    struct sight_eyes eyes;
    if (!l->limits.many && node->count > 1 && !(node->value > SIGHT_ROUNDING * node->clear))
        return node->piece.area * SIGHT_DARK > l->ends.from->area ? SIGHT_ALIKE * node->clear : 0;
    if (!(node->piece.area * most > l->ends.from->area))
        return 0;
    sight_eyes_open(&eyes, &l->look.sight, l->ends.tree->lift, enough);
    sight_eyes_add(&eyes, &node->piece);
    for (int q = 0; q < QUARTERS && node->quarters; q++)
        sight_eyes_add(&eyes, &quarters[q].piece);
    return sight_missed(&eyes, &node->piece, l->ends.to, l->ends.tree, list_of(l, at), node->count,
                        l->scratch->known, node->value);
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
        sight_quarter_make(&quarter->piece, &node->piece, q);
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
    const double rounding = SIGHT_ROUNDING * node->clear;
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

/* A root: a piece with these corners. all: 1: what stands before it is what has been found. */
static void start(struct looking *l, const double (*v)[3], int n, int all)
{
    struct sight_node *node = &l->scratch->nodes[l->nodes];
    sight_piece_make(&node->piece, l->ends.from, v, n);
    measure(l, l->nodes, all, l->ends.list, l->ends.count);
    l->clear += node->clear;
    l->nodes++;
}

/* The pieces of a part, the worst first, until the error is as small as asked for. */
static void integrate(struct looking *l, const struct polygon *part, int all)
{
    const struct sight_limits *limits = &l->limits;
    struct sight_node *nodes = l->scratch->nodes;
    const double(*v)[3] = (const double(*)[3])part->v;
    start(l, v, part->n < 4 ? part->n : 4, all);
    if (part->n == 5) {
        const double rest[3][3] = {
            {v[0][0], v[0][1], v[0][2]}, {v[3][0], v[3][1], v[3][2]}, {v[4][0], v[4][1], v[4][2]}};
        start(l, rest, 3, 0);
    }
    double aim = l->ends.believes
                     ? SIGHT_BELIEVED * limits->tolerance
                           * fmax(nodes[0].points + (l->nodes > 1 ? nodes[1].points : 0),
                                  limits->floor * l->least)
                           / l->ends.from->area
                     : -1;
    l->roots = l->nodes;
    for (int i = 0; i < l->roots; i++) {
        compare(l, i, aim);
        count_in(l, i);
    }
    while (l->heap > 0 && has_room(l, QUARTERS * QUARTERS)
           && !sight_enough(limits, sqrt(fmax(l->square, 0)), l->value, l->least)) {
        int at = heap_out(l), quarters = nodes[at].quarters;
        l->value -= nodes[at].value;
        l->square -= nodes[at].error * nodes[at].error;
        for (int q = 0; q < QUARTERS; q++) {
            compare(l, quarters + q, aim);
            count_in(l, quarters + q);
        }
    }
}

double sight_integrate(const struct sight_ends *ends, struct sight_scratch *scratch, double *error)
{
    const struct exchange_tree *t = ends->tree;
    const struct element *from = ends->from, *to = ends->to;
    const struct sight_between *between = scratch->between;
    struct looking l = {.ends = *ends,
                        .look = {.tree = t,
                                 .between = scratch->between,
                                 .bodies = scratch->bodies,
                                 .on = ends->on,
                                 .joined = ends->joined},
                        .scratch = scratch,
                        .limits = sight_limits_of(&scratch->limits, t, from, to),
                        .least = fmin(from->area, to->area)};
    struct polygon part, seen;
    const int all = sight_part_in_front(&part, from, to, t->host.flat) && ends->found;
    polygon_clip(&seen, (const double(*)[3])to->vertex, to->vertices, from->centre, from->normal);
    *error = 0;
    if (part.n == 0 || seen.n == 0)
        return 0;
    sight_open(&l.look.sight, to, &seen, t->lift);
    /* of bent faces one too many may hide what it does not stand before */
    l.shared = ends->found && !between->bent && between->faces <= SIGHT_SHARED
               && sight_look_place(&l.look) == 0;
    integrate(&l, &part, all);
    *error = sqrt(fmax(l.square, 0));
    const double sum = fmax(l.value, 0);
    return sum > SIGHT_NEARLY_CLEAR * l.clear ? fmin(sum, ends->clear) : sum;
}
