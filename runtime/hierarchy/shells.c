/* shells.c - see shells.h.
 *
 * Two polygons that alone share an edge are one piece, and run along it opposite ways when their
 * fronts are on the same side. So a flood over such edges, with the parity of turns on the way,
 * gives each piece two sides; a piece whose every edge is shared by two is a closed shell. What is
 * on the side of less area looks turned; of an open piece only where that is a quarter at the most.
 * A shell all of whose fronts look inwards is a room, but not where it stands empty in another
 * room: light is outside it, so all of it looks turned. Polygons with two sides close shells, but
 * are never turned. Corners are one place when their coordinates are equal.
 * Invariant: side[] of a polygon is its parity to root[], 0 of a root. [Tarjan 1975, union by
 * parity; van Oosterom and Strackee 1983, the solid angle of a triangle]
 * SPDX-License-Identifier: MIT */
#include "hierarchy/shells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "hierarchy/bvh.h"
#include "hierarchy/hierarchy.h"
#include "hierarchy/vector_hash.h"
#include "kernel/constants.h"

/* A step along a polygon's outline, kept at the smaller of its two places. */
struct edge {
    uint32_t other, polygon;
    uint8_t up; /* it runs from the smaller place to the larger */
};

/* What stands at the root of a piece. */
struct piece_sum {
    double area[2], volume; /* by side; of all, as from side 0 */
    double low[3], high[3], middle[3];
    uint32_t corners, last;        /* last: polygon of it */
    uint8_t open, twisted, inside; /* inside: fronts of the larger side look inwards */
};

struct shells {
    const struct RadPolygons *polygons;
    const struct RadMaterial *materials;
    size_t *at;      /* [count + 1]: of each polygon's first index */
    uint32_t *place; /* [position_count] */
    struct edge *edges;
    size_t *start;  /* [position_count]: of each place's edges */
    uint32_t *root; /* [count] */
    uint8_t *side;  /* [count] */
    uint32_t *next; /* [count]: of the same piece; UINT32_MAX ends */
    struct piece_sum *sum;
    /* Of what is asked where a shell looks inwards: the boxes of pieces, and each one's root. */
    struct bvh tree;
    uint32_t *piece;
};

static const double *corner(const struct shells *s, uint32_t polygon, uint32_t i)
{
    return &s->polygons->positions[3 * (size_t)s->polygons->indices[s->at[polygon] + i]];
}

static uint32_t size_of(const struct shells *s, uint32_t polygon)
{
    return (uint32_t)(s->at[polygon + 1] - s->at[polygon]);
}

static int two_sided(const struct shells *s, uint32_t polygon)
{
    return s->materials[s->polygons->materials ? s->polygons->materials[polygon] : 0].two_sided;
}

/* Equal positions are one place, the first of them. Returns 0 or -1. */
static int find_places(struct shells *s)
{
    size_t n = s->polygons->position_count, slots = 16;
    while (slots < 2 * n)
        slots *= 2;
    uint32_t *table = malloc(slots * sizeof *table);
    if (!table)
        return -1;
    memset(table, 0xff, slots * sizeof *table);
    for (size_t i = 0; i < n; i++) {
        const double *p = &s->polygons->positions[3 * i];
        size_t slot = vector_hash(p) & (slots - 1);
        while (table[slot] != UINT32_MAX
               && !vectors_equal(&s->polygons->positions[3 * (size_t)table[slot]], p))
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == UINT32_MAX)
            table[slot] = (uint32_t)i;
        s->place[i] = table[slot];
    }
    free(table);
    return 0;
}

/* The edges of all polygons by their smaller place: count them, then put them there. */
static void find_edges(struct shells *s)
{
    const uint32_t *indices = s->polygons->indices;
    size_t places = s->polygons->position_count;
    for (int put = 0; put < 2; put++) {
        for (uint32_t i = 0; i < s->polygons->count; i++)
            for (uint32_t j = 0, n = size_of(s, i); n > 2 && j < n; j++) {
                uint32_t a = s->place[indices[s->at[i] + j]],
                         b = s->place[indices[s->at[i] + (j + 1 < n ? j + 1 : 0)]];
                if (a == b)
                    continue;
                if (put)
                    s->edges[s->start[a < b ? a : b]++] = (struct edge){a < b ? b : a, i, a < b};
                else
                    s->start[a < b ? a : b]++;
            }
        size_t sum = 0;
        for (size_t p = 0; p < places && !put; p++) { /* counts become starts */
            size_t count = s->start[p];
            s->start[p] = sum;
            sum += count;
        }
    }
}

/* The root of a polygon, which becomes its parent. */
static uint32_t root_of(struct shells *s, uint32_t i)
{
    uint8_t side = 0;
    uint32_t root = i;
    for (; s->root[root] != root; root = s->root[root])
        side ^= s->side[root];
    while (i != root) {
        uint32_t up = s->root[i];
        uint8_t step = s->side[i];
        s->root[i] = root;
        s->side[i] = side;
        side ^= step;
        i = up;
    }
    return root;
}

static void join(struct shells *s, const struct edge *a, const struct edge *b)
{
    uint8_t turn = a->up == b->up;
    uint32_t x = root_of(s, a->polygon), y = root_of(s, b->polygon);
    uint8_t parity = s->side[a->polygon] ^ s->side[b->polygon] ^ turn;
    if (x == y) {
        s->sum[x].twisted |= parity;
        return;
    }
    uint32_t up = x < y ? x : y, down = x < y ? y : x;
    s->root[down] = up;
    s->side[down] = parity;
    s->sum[up].twisted |= s->sum[down].twisted;
}

static int by_other(const void *a, const void *b)
{
    const struct edge *x = a, *y = b;
    return x->other != y->other       ? (x->other > y->other ? 1 : -1)
           : x->polygon != y->polygon ? (x->polygon > y->polygon ? 1 : -1)
                                      : 0;
}

static void join_all(struct shells *s)
{
    size_t from = 0;
    for (size_t p = 0; p < s->polygons->position_count; p++) {
        size_t to = s->start[p]; /* putting has moved each start to its end */
        if (to - from > 1)
            qsort(&s->edges[from], to - from, sizeof *s->edges, by_other);
        while (from < to) {
            size_t end = from + 1;
            while (end < to && s->edges[end].other == s->edges[from].other)
                end++;
            if (end - from == 2 && s->edges[from].polygon != s->edges[from + 1].polygon)
                join(s, &s->edges[from], &s->edges[from + 1]);
            else
                for (size_t k = from; k < end; k++)
                    s->sum[s->edges[k].polygon].open = 1; /* a root's, after add_up */
            from = end;
        }
    }
}

/* Twice the area and six times the volume below a polygon, from a point. */
static void measure(const struct shells *s, uint32_t i, const double from[3], double *area,
                    double *volume)
{
    double sum[3] = {0, 0, 0};
    *volume = 0;
    for (uint32_t j = 1; j + 1 < size_of(s, i); j++) {
        double a[3], b[3], c[3], d[3];
        sub3(a, corner(s, i, j), corner(s, i, 0));
        sub3(b, corner(s, i, j + 1), corner(s, i, 0));
        sub3(d, corner(s, i, 0), from);
        cross3(c, a, b);
        for (int k = 0; k < 3; k++)
            sum[k] += c[k];
        *volume += dot3(c, d);
    }
    *area = length3(sum);
}

/* Sums of pieces, and their polygons in a list. */
static void add_up(struct shells *s)
{
    for (uint32_t i = 0; i < s->polygons->count; i++) {
        uint32_t r = root_of(s, i);
        struct piece_sum *p = &s->sum[r];
        double area, volume;
        s->next[i] = UINT32_MAX;
        if (i == r) { /* the smallest of its piece: it comes first */
            for (int k = 0; k < 3; k++) {
                p->low[k] = INFINITY;
                p->high[k] = -INFINITY;
            }
        } else {
            s->next[p->last] = i;
            p->open |= s->sum[i].open;
        }
        p->last = i;
        for (uint32_t j = 0; j < size_of(s, i); j++, p->corners++)
            for (int k = 0; k < 3; k++) {
                double x = corner(s, i, j)[k];
                p->low[k] = fmin(p->low[k], x);
                p->high[k] = fmax(p->high[k], x);
                p->middle[k] += (x - p->middle[k]) / (p->corners + 1);
            }
        if (size_of(s, i) < 3)
            continue;
        measure(s, i, corner(s, r, 0), &area, &volume);
        p->area[s->side[i]] += two_sided(s, i) ? 0 : area;
        p->volume += s->side[i] ? -volume : volume;
    }
    for (uint32_t i = 0; i < s->polygons->count; i++) {
        struct piece_sum *p = &s->sum[i];
        double all = p->area[0] + p->area[1];
        p->open |= s->root[i] == i && !(fabs(p->volume) > SHELL_THIN * all * sqrt(all));
        p->inside = all > 0 && p->volume * (p->area[1] > p->area[0] ? -1 : 1) < 0;
    }
}

/* Is a piece within a closed shell: its box, and the middle of its corners? The solid angle of
 * the shell from there says so. */
static int is_around(const struct shells *s, uint32_t shell, uint32_t piece)
{
    const struct piece_sum *out = &s->sum[shell], *in = &s->sum[piece];
    const double *point = in->middle;
    double turns = 0;
    for (int k = 0; k < 3; k++)
        if (!(in->low[k] >= out->low[k] && in->high[k] <= out->high[k]))
            return 0;
    for (uint32_t i = shell; i != UINT32_MAX; i = s->next[i])
        for (uint32_t j = 1; j + 1 < size_of(s, i); j++) {
            double v[3][3], c[3], l[3];
            sub3(v[0], corner(s, i, 0), point);
            sub3(v[1], corner(s, i, j), point);
            sub3(v[2], corner(s, i, j + 1), point);
            cross3(c, v[1], v[2]);
            for (int k = 0; k < 3; k++)
                l[k] = length3(v[k]);
            double angle =
                2
                * atan2(dot3(v[0], c), l[0] * l[1] * l[2] + dot3(v[0], v[1]) * l[2]
                                           + dot3(v[1], v[2]) * l[0] + dot3(v[2], v[0]) * l[1]);
            turns += s->side[i] ? -angle : angle;
        }
    return fabs(turns) > 6.283185307179586; /* half of all */
}

static int is_shell(const struct shells *s, uint32_t i)
{
    return s->root[i] == i && !s->sum[i].open && !s->sum[i].twisted;
}

/* Does a room hold a piece, and does another room hold it? */
struct neighbours {
    int holds, held;
};

/* The same of the pieces below a node. */
static void look_around(const struct shells *s, uint32_t room, uint32_t node, struct neighbours *n)
{
    const struct piece_sum *p = &s->sum[room];
    const struct bounds *box = &s->tree.boxes[node];
    const struct bvh_node *at = &s->tree.nodes[node];
    for (int k = 0; k < 3; k++)
        if (box->low[k] > p->high[k] || box->high[k] < p->low[k])
            return;
    for (uint32_t i = 0; i < at->children && !n->holds; i++)
        look_around(s, room, at->child + i, n);
    if (at->children)
        return;
    uint32_t other = s->piece[s->tree.order[at->from]];
    if (other == room)
        return;
    n->holds = is_around(s, room, other);
    n->held = n->held || (is_shell(s, other) && s->sum[other].inside && is_around(s, other, room));
}

/* Does a room stand empty in another? Then light is outside it. */
static int is_inside_out(const struct shells *s, uint32_t room)
{
    struct neighbours n = {0};
    look_around(s, room, 0, &n);
    return n.held && !n.holds;
}

/* The tree over the boxes of all pieces: there a face is a diagonal. Returns 0 or -1. */
static int find_boxes(struct shells *s)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->polygons->count; i++)
        n += s->root[i] == i && s->sum[i].corners;
    struct face *boxes = calloc((size_t)n + 1, sizeof *boxes);
    s->piece = malloc(((size_t)n + 1) * sizeof *s->piece);
    if (!boxes || !s->piece) {
        free(boxes);
        return -1;
    }
    n = 0;
    for (uint32_t i = 0; i < s->polygons->count; i++) {
        if (s->root[i] != i || !s->sum[i].corners)
            continue;
        memcpy(boxes[n].vertex[0], s->sum[i].low, sizeof boxes[n].vertex[0]);
        memcpy(boxes[n].vertex[1], s->sum[i].high, sizeof boxes[n].vertex[1]);
        boxes[n].vertices = 2;
        s->piece[n++] = i;
    }
    int result = bvh_build(&s->tree, boxes, n, CLUSTERING_SAH, 1);
    free(boxes);
    return result;
}

/* Returns 0 or -1. */
static int judge(struct shells *s, uint8_t *turned)
{
    for (uint32_t r = 0; r < s->polygons->count; r++) {
        const struct piece_sum *p = &s->sum[r];
        uint8_t right = p->area[1] > p->area[0];
        int shell = is_shell(s, r);
        if (s->root[r] != r || p->twisted
            || (!shell && !(p->area[!right] <= SHELL_FEW * (p->area[0] + p->area[1]))))
            continue;
        if (shell && p->inside && !s->piece && find_boxes(s) < 0)
            return -1;
        right ^= shell && p->inside && is_inside_out(s, r);
        for (uint32_t i = r; i != UINT32_MAX; i = s->next[i])
            if (!two_sided(s, i) && s->side[i] != right)
                turned[i] = shell ? TURNED_CLOSED : TURNED_OPEN;
    }
    return 0;
}

int shells_find(const struct RadPolygons *polygons, const struct RadMaterial *materials,
                uint8_t *turned)
{
    uint32_t n = polygons->count;
    struct shells s = {.polygons = polygons,
                       .materials = materials,
                       .at = malloc(((size_t)n + 1) * sizeof *s.at),
                       .place = malloc((polygons->position_count + 1) * sizeof *s.place),
                       .start = calloc(polygons->position_count + 1, sizeof *s.start),
                       .root = malloc(((size_t)n + 1) * sizeof *s.root),
                       .side = calloc((size_t)n + 1, 1),
                       .next = malloc(((size_t)n + 1) * sizeof *s.next),
                       .sum = calloc((size_t)n + 1, sizeof *s.sum)};
    int failed = !s.at || !s.place || !s.start || !s.root || !s.side || !s.next || !s.sum;
    memset(turned, TURNED_NOT, n);
    if (!failed) {
        s.at[0] = 0;
        for (uint32_t i = 0; i < n; i++) {
            s.at[i + 1] = s.at[i] + (polygons->sizes ? polygons->sizes[i] : polygons->size);
            s.root[i] = i;
        }
        s.edges = malloc((s.at[n] + 1) * sizeof *s.edges);
        failed = !s.edges || find_places(&s) < 0;
    }
    if (!failed) {
        find_edges(&s);
        join_all(&s);
        add_up(&s);
        failed = judge(&s, turned) < 0;
    }
    bvh_free(&s.tree);
    free(s.piece);
    free(s.at);
    free(s.place);
    free(s.edges);
    free(s.start);
    free(s.root);
    free(s.side);
    free(s.next);
    free(s.sum);
    return failed ? -1 : 0;
}
