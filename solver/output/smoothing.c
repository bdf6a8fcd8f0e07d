/* smoothing.c - see smoothing.h.
 * SPDX-License-Identifier: MIT */
#include "output/smoothing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "kernel/constants.h"
#include "util/array.h"

/* Each by twice the sweeps of the one before, from one on. Neighbourhoods are about as wide as the
 * root of all sweeps, in edges: in the end sixteen. */
enum { LEVELS = 8 };

/* Sweeps that make of squares at vertices a variance: over some twenty of them */
enum { SQUARES = 16 };

/* One neighbour on either side of a vertex, in one line. */
struct line {
    uint32_t a, b;
    double of_a; /* the share of a in the value that is linear between them */
};

/* Of every vertex its lines. */
struct lines {
    uint32_t *first; /* [vertices + 1] */
    struct line *line;
};

/* A side of a leaf, or a part of it, from one vertex to the next; both ways. */
struct edge {
    uint32_t from, to;
};

struct edges {
    struct edge *edge;
    size_t count, capacity;
};

static int push_edge(struct edges *e, const struct vertex_values *v, const double *noise,
                     uint32_t a, uint32_t b, uint32_t middle)
{
    if (middle != NO_VERTEX)
        return push_edge(e, v, noise, a, middle, vertex_values_middle(v, a, middle)) < 0
                       || push_edge(e, v, noise, middle, b, vertex_values_middle(v, middle, b)) < 0
                   ? -1
                   : 0;
    if (isnan(noise[a]) || isnan(noise[b]))
        return 0;
    if (array_reserve(&e->edge, e->count + 2, &e->capacity, sizeof *e->edge) < 0)
        return -1;
    e->edge[e->count++] = (struct edge){a, b};
    e->edge[e->count++] = (struct edge){b, a};
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    const struct edge *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    return x->to < y->to ? -1 : x->to > y->to;
}

/* All between vertices whose noise is known, sorted, each once. Returns 0, or -1. */
static int find_edges(struct edges *e, const struct vertex_values *v, const struct solution *s,
                      const double *noise)
{
    for (uint32_t i = 0; i < s->tree.count; i++) {
        const struct element *leaf = &s->tree.elements[i];
        for (uint32_t j = 0; is_leaf(leaf) && j < leaf->vertices; j++) {
            const size_t at = 4 * (size_t)i;
            const uint32_t a = v->corner[at + j], b = v->corner[at + (j + 1u) % leaf->vertices];
            if (push_edge(e, v, noise, a, b, v->middle[at + j]) < 0)
                return -1;
        }
    }
    if (e->count > 0)
        qsort(e->edge, e->count, sizeof *e->edge, compare_edges);
    size_t kept = 0;
    for (size_t i = 0; i < e->count; i++)
        if (i == 0 || compare_edges(&e->edge[i - 1], &e->edge[i]) != 0)
            e->edge[kept++] = e->edge[i];
    e->count = kept;
    return 0;
}

/* Does one line lead from a over `at` to b? Then *of_a is set. */
static int is_line(const struct vertex_values *v, uint32_t at, uint32_t a, uint32_t b, double *of_a)
{
    double to_a[3], to_b[3];
    sub3(to_a, v->vertices[a].position, v->vertices[at].position);
    sub3(to_b, v->vertices[b].position, v->vertices[at].position);
    const double far_a = length3(to_a), far_b = length3(to_b);
    *of_a = far_b / (far_a + far_b);
    return dot3(to_a, to_b) < -OUTPUT_SAME_LINE * far_a * far_b;
}

/* The lines of all vertices: each edge is in one at the most. Returns 0, or -1. */
static int find_lines(struct lines *l, const struct vertex_values *v, const struct edges *e)
{
    uint32_t count = 0;
    size_t from = 0;
    l->first = malloc(((size_t)v->count + 1) * sizeof *l->first);
    l->line = malloc((e->count / 2 + 1) * sizeof *l->line);
    if (!l->first || !l->line)
        return -1;
    for (uint32_t i = 0; i < v->count; i++) {
        size_t to = from;
        l->first[i] = count;
        while (to < e->count && e->edge[to].from == i)
            to++;
        for (size_t a = from; a < to; a++)
            for (size_t b = a + 1; b < to; b++) {
                struct line line = {e->edge[a].to, e->edge[b].to, 0};
                if (count - l->first[i] < (to - from) / 2
                    && is_line(v, i, line.a, line.b, &line.of_a))
                    l->line[count++] = line;
            }
        from = to;
    }
    l->first[v->count] = count;
    return 0;
}

/* Half of each vertex is made what its lines say, n numbers to a vertex. to: room for as many. */
static void sweep(const struct lines *l, uint32_t vertices, uint32_t n, double **x, double **to)
{
    for (uint32_t i = 0; i < vertices; i++) {
        const uint32_t first = l->first[i], end = l->first[i + 1];
        const double *own = &(*x)[(size_t)i * n];
        double *mine = &(*to)[(size_t)i * n];
        for (uint32_t k = 0; k < n; k++) {
            double sum = 0;
            for (uint32_t j = first; j < end; j++)
                sum += l->line[j].of_a * (*x)[(size_t)l->line[j].a * n + k]
                       + (1 - l->line[j].of_a) * (*x)[(size_t)l->line[j].b * n + k];
            mine[k] = end > first ? 0.5 * (own[k] + sum / (end - first)) : own[k];
        }
    }
    double *other = *x;
    *x = *to;
    *to = other;
}

/* While levels are gone through. */
struct smoothing {
    struct vertex_values *v;
    struct lines lines;
    double *x, *before, *room; /* [vertices * n]: bands, and noise after them */
    double *squares;           /* [vertices * PAIR]: of what a level takes off: seen, by noise */
};

enum { SEEN, BY_NOISE, PAIR };

static double square_of(const double *now, const double *before, uint32_t count)
{
    double sum = 0;
    for (uint32_t k = 0; k < count; k++)
        sum += before[k] - now[k];
    return sum * sum;
}

/* What the sweeps of a level have taken off, and of noise, as squares at a vertex and round about.
 */
static void find_squares(struct smoothing *s)
{
    const uint32_t bands = s->v->bands, n = bands + 1;
    for (uint32_t i = 0; i < s->v->count; i++) {
        const double *now = &s->x[(size_t)i * n], *before = &s->before[(size_t)i * n];
        s->squares[PAIR * (size_t)i + SEEN] = square_of(now, before, bands);
        s->squares[PAIR * (size_t)i + BY_NOISE] = square_of(&now[bands], &before[bands], 1);
    }
    for (int j = 0; j < SQUARES; j++)
        sweep(&s->lines, s->v->count, PAIR, &s->squares, &s->room);
}

/* Give back of it what stands out of noise. */
static void give_back(const struct smoothing *s)
{
    const uint32_t bands = s->v->bands, n = bands + 1;
    for (uint32_t i = 0; i < s->v->count; i++) {
        const double *square = &s->squares[PAIR * (size_t)i];
        if (!(square[SEEN] > 0))
            continue;
        const double share = fmax(0, 1 - SMOOTHING_THRESHOLD * square[BY_NOISE] / square[SEEN]);
        for (uint32_t k = 0; k < bands; k++)
            s->v->value[(size_t)i * bands + k] +=
                share * (s->before[(size_t)i * n + k] - s->x[(size_t)i * n + k]);
    }
}

static int smoothing_open(struct smoothing *s, const struct solution *solution, const double *noise)
{
    const size_t values = ((size_t)s->v->count + 1) * (s->v->bands + PAIR);
    struct edges e = {NULL, 0, 0};
    const int failed =
        find_edges(&e, s->v, solution, noise) < 0 || find_lines(&s->lines, s->v, &e) < 0;
    free(e.edge);
    s->x = malloc(values * sizeof *s->x);
    s->before = malloc(values * sizeof *s->before);
    s->room = malloc(values * sizeof *s->room);
    s->squares = malloc(values * sizeof *s->squares);
    return failed || !s->x || !s->before || !s->room || !s->squares ? -1 : 0;
}

static void smoothing_close(struct smoothing *s)
{
    free(s->lines.first);
    free(s->lines.line);
    free(s->x);
    free(s->before);
    free(s->room);
    free(s->squares);
}

int smoothing_apply(struct vertex_values *v, const struct solution *solution, const double *noise)
{
    struct smoothing s = {.v = v};
    const uint32_t bands = v->bands, n = bands + 1;
    const int failed = smoothing_open(&s, solution, noise) < 0;
    for (uint32_t i = 0; i < v->count && !failed; i++) {
        double *here = &s.x[(size_t)i * n], *value = &v->value[(size_t)i * bands];
        memcpy(here, value, bands * sizeof *value);
        here[bands] = isnan(noise[i]) ? 0 : noise[i];
        memset(value, 0, bands * sizeof *value);
    }
    for (int level = 0; level < LEVELS && !failed; level++) {
        memcpy(s.before, s.x, (size_t)v->count * n * sizeof *s.x);
        for (int more = 1 << level; more > 0; more--)
            sweep(&s.lines, v->count, n, &s.x, &s.room);
        find_squares(&s);
        give_back(&s);
    }
    for (uint32_t i = 0; i < v->count && !failed; i++)
        for (uint32_t k = 0; k < bands; k++)
            v->value[(size_t)i * bands + k] += s.x[(size_t)i * n + k];
    smoothing_close(&s);
    return failed ? -1 : 0;
}
