/* greedy.c - see greedy.h.
 *
 * A link keeps what its receiver's cells get from it, as its emitter is now, and as it would be
 * with parts and parts of parts. A split of the receiver then only projects anew. Two splits in a
 * row are tried, too: light that is symmetric about an element's middle has the same mean in all
 * quarters, and a single split of it gains nothing.
 * SPDX-License-Identifier: MIT */
#include "study/greedy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernel/lambert.h"
#include "util/array.h"

/* A square of cells of a face: the first of them, and how many along each side. */
struct square {
    int face, x, y, size;
};

/* Emitter whole, its parts, their parts, its cells: what the receiver's cells get of each, W/m2 of
 * radiosity.
 */
enum { WHOLE, PARTS, PARTS_OF_PARTS, TRUE, SEEN };

struct link {
    struct square r, s;
    double *seen[SEEN]; /* [r.size^2], one block */
    double gain[2];     /* of splitting receiver, emitter: error^p for each link more */
};

struct run {
    const struct greedy *g;
    enum greedy_norm norm;
    int linear, alone;
    struct link *links;
    size_t count, capacity;
    double *wrong[GREEDY_FACES]; /* [cells^2] */
    double *scratch[2];          /* [GREEDY_CELLS^2] */
};

/* ---- geometry and truth */

void greedy_centre(const struct greedy_face *f, int cell, double p[3])
{
    double u = (cell % f->cells + 0.5) / f->cells, v = (cell / f->cells + 0.5) / f->cells;
    for (int k = 0; k < 3; k++)
        p[k] = f->corner[k] + u * f->a[k] + v * f->b[k];
}

static double cell_area(const struct greedy_face *f)
{
    double n[3];
    cross3(n, f->a, f->b);
    return length3(n) / (f->cells * f->cells);
}

static size_t cells_of(const struct greedy_face *f)
{
    return (size_t)f->cells * (size_t)f->cells;
}

static void fill_kernel(const struct greedy_face *r, const struct greedy_face *s, float *kernel)
{
    double n[3];
    cross3(n, r->a, r->b);
    double size = length3(n);
    for (int k = 0; k < 3; k++)
        n[k] /= size;
    int count = s->cells;
    for (int i = 0; i < r->cells * r->cells; i++) {
        double x[3];
        greedy_centre(r, i, x);
        for (int j = 0; j < count * count; j++) {
            static const int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
            double v[4][3];
            for (int c = 0; c < 4; c++)
                for (int k = 0; k < 3; k++)
                    v[c][k] = s->corner[k] + (j % count + corner[c][0]) * s->a[k] / count
                              + (j / count + corner[c][1]) * s->b[k] / count;
            *kernel++ = (float)fmax(0, lambert_sum(x, n, (const double(*)[3])v, 4));
        }
    }
}

/* Sweeps until none changes B by more than a millionth of a millionth of it. */
static void find_radiosity(struct greedy *g)
{
    double change = 1, most = 0;
    while (change > 1e-12 * most) {
        change = most = 0;
        for (int i = 0; i < g->count; i++) {
            const struct greedy_face *f = &g->face[i];
            for (size_t x = 0; x < cells_of(f); x++) {
                double sum = 0;
                for (int j = 0; j < g->count; j++) {
                    size_t n = cells_of(&g->face[j]);
                    for (size_t y = 0; g->kernel[i][j] && y < n; y++)
                        sum += (double)g->kernel[i][j][x * n + y] * g->radiosity[j][y];
                }
                double b = f->exitance + f->rho * sum;
                change = fmax(change, fabs(b - g->radiosity[i][x]));
                most = fmax(most, b);
                g->radiosity[i][x] = b;
            }
        }
    }
}

int greedy_open(struct greedy *g, const struct greedy_face *faces, int count)
{
    *g = (struct greedy){.count = count};
    memcpy(g->face, faces, (size_t)count * sizeof *faces);
    for (int i = 0; i < count; i++) {
        const struct greedy_face *r = &faces[i];
        g->radiosity[i] = calloc(cells_of(r), sizeof *g->radiosity[i]);
        if (!g->radiosity[i])
            return -1;
        for (size_t x = 0; x < cells_of(r); x++)
            g->radiosity[i][x] = r->exitance;
        for (int j = 0; j < count; j++) {
            const struct greedy_face *s = &faces[j];
            if (j == i || !(r->rho > 0) || !(s->rho > 0 || s->exitance > 0))
                continue;
            g->kernel[i][j] = malloc(cells_of(r) * cells_of(s) * sizeof *g->kernel[i][j]);
            if (!g->kernel[i][j])
                return -1;
            fill_kernel(r, s, g->kernel[i][j]);
        }
    }
    find_radiosity(g);
    return 0;
}

void greedy_close(struct greedy *g)
{
    for (int i = 0; i < g->count; i++) {
        free(g->radiosity[i]);
        for (int j = 0; j < g->count; j++)
            free(g->kernel[i][j]);
    }
}

static double power_of(enum greedy_norm norm, double x)
{
    return norm == GREEDY_L1 ? fabs(x) : x * x;
}

double greedy_norm_of(const struct greedy *g, double *const *wrong, enum greedy_norm norm)
{
    double sum = 0;
    for (int i = 0; i < g->count; i++)
        for (size_t x = 0; x < cells_of(&g->face[i]); x++)
            sum += cell_area(&g->face[i]) * power_of(norm, wrong[i][x]);
    return norm == GREEDY_L1 ? sum : sqrt(sum);
}

double greedy_reflected(const struct greedy *g, enum greedy_norm norm)
{
    double sum = 0;
    for (int i = 0; i < g->count; i++)
        for (size_t x = 0; x < cells_of(&g->face[i]); x++)
            sum +=
                cell_area(&g->face[i]) * power_of(norm, g->radiosity[i][x] - g->face[i].exitance);
    return norm == GREEDY_L1 ? sum : sqrt(sum);
}

/* ---- projections */

/* The best constant or linear function over each of parts x parts squares of a size x size one,
 * rows of `stride`, in L2. `to` may be `from`. */
static void project(const double *from, double *to, int size, int stride, int parts, int linear)
{
    int n = size / parts;
    for (int part = 0; part < parts * parts; part++) {
        size_t first = (size_t)(part / parts * n) * (size_t)stride + (size_t)(part % parts * n);
        double mean = 0, by_x = 0, by_y = 0, square = 0;
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++) {
                double f = from[first + (size_t)y * (size_t)stride + (size_t)x];
                mean += f;
                by_x += f * (x + 0.5 - 0.5 * n);
                by_y += f * (y + 0.5 - 0.5 * n);
                square += (x + 0.5 - 0.5 * n) * (x + 0.5 - 0.5 * n);
            }
        mean /= n * n;
        by_x = linear && n > 1 ? by_x / square : 0;
        by_y = linear && n > 1 ? by_y / square : 0;
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++)
                to[first + (size_t)y * (size_t)stride + (size_t)x] =
                    mean + by_x * (x + 0.5 - 0.5 * n) + by_y * (y + 0.5 - 0.5 * n);
    }
}

/* What the receiver's cells reflect of the emitter, projected over parts x parts squares of it. */
static void find_seen(struct run *run, const struct link *l, int parts, double *seen)
{
    const struct greedy *g = run->g;
    const struct greedy_face *r = &g->face[l->r.face], *s = &g->face[l->s.face];
    const double *b = g->radiosity[l->s.face];
    const float *kernel = g->kernel[l->r.face][l->s.face];
    int n = l->s.size;
    double *shown = run->scratch[0];
    for (int y = 0; y < n; y++)
        memcpy(&shown[y * n], &b[(l->s.y + y) * s->cells + l->s.x], (size_t)n * sizeof *shown);
    project(shown, shown, n, n, parts, run->linear);
    for (int i = 0; i < l->r.size * l->r.size; i++) {
        size_t x = (size_t)((l->r.y + i / l->r.size) * r->cells + l->r.x + i % l->r.size);
        double sum = 0;
        for (int j = 0; j < n * n; j++)
            sum += shown[j]
                   * (double)kernel[x * cells_of(s)
                                    + (size_t)((l->s.y + j / n) * s->cells + l->s.x + j % n)];
        seen[i] = r->rho * sum;
    }
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* ---- gains */

/* By how much error^p, of the link alone or of all together, falls when the receiver is cut into
 * parts x parts squares and the emitter is seen as `how`. */
static double fall(struct run *run, const struct link *l, int parts, int how)
{
    const struct greedy_face *f = &run->g->face[l->r.face];
    int n = l->r.size;
    double *now = run->scratch[0], *then = run->scratch[1], sum = 0;
    project(l->seen[WHOLE], now, n, n, 1, run->linear);
    project(l->seen[how], then, n, n, smaller(parts, n), run->linear);
    for (int i = 0; i < n * n; i++) {
        double e = run->alone ? now[i] - l->seen[TRUE][i]
                              : run->wrong[l->r.face][(l->r.y + i / n) * f->cells + l->r.x + i % n];
        sum += power_of(run->norm, e) - power_of(run->norm, e + then[i] - now[i]);
    }
    return sum * cell_area(f);
}

static void find_gains(struct run *run, struct link *l)
{
    double both = l->r.size > 1 && l->s.size > 1 ? fall(run, l, 2, PARTS) / 15 : 0;
    l->gain[0] = l->gain[1] = 0;
    if (l->r.size > 1)
        l->gain[0] = fmax(both, fmax(fall(run, l, 2, WHOLE) / 3, fall(run, l, 4, WHOLE) / 15));
    if (l->s.size > 1)
        l->gain[1] =
            fmax(both, fmax(fall(run, l, 1, PARTS) / 3, fall(run, l, 1, PARTS_OF_PARTS) / 15));
}

static int overlap(const struct square *a, const struct square *b)
{
    return a->face == b->face && a->x < b->x + b->size && b->x < a->x + a->size
           && a->y < b->y + b->size && b->y < a->y + a->size;
}

/* ---- links */

/* What a link brings its receiver, times `sign`, to what is wrong. */
static void bring(struct run *run, const struct link *l, double sign)
{
    const struct greedy_face *f = &run->g->face[l->r.face];
    int n = l->r.size;
    project(l->seen[WHOLE], run->scratch[0], n, n, 1, run->linear);
    for (int i = 0; i < n * n; i++)
        run->wrong[l->r.face][(l->r.y + i / n) * f->cells + l->r.x + i % n] +=
            sign * run->scratch[0][i];
}

/* Add a link, what it brings included. `of`: one of the same emitter whose receiver holds this
 * one's; NULL: none. Returns 0, or -1. */
static int add(struct run *run, struct square r, struct square s, const struct link *of)
{
    size_t n = (size_t)r.size * (size_t)r.size;
    double *block = malloc(SEEN * n * sizeof *block);
    if (!block
        || array_reserve(&run->links, run->count + 1, &run->capacity, sizeof *run->links) < 0) {
        free(block);
        return -1;
    }
    struct link *l = &run->links[run->count++];
    *l = (struct link){.r = r, .s = s};
    for (int how = 0; how < SEEN; how++) {
        l->seen[how] = block + (size_t)how * n;
        if (!of)
            find_seen(run, l, how == TRUE ? s.size : smaller(1 << how, s.size), l->seen[how]);
        else
            for (int y = 0; y < r.size; y++)
                memcpy(&l->seen[how][y * r.size],
                       &of->seen[how][(r.y - of->r.y + y) * of->r.size + r.x - of->r.x],
                       (size_t)r.size * sizeof *block);
    }
    bring(run, l, 1);
    return 0;
}

static struct square part_of(struct square q, int k)
{
    int half = q.size / 2;
    return (struct square){q.face, q.x + (k & 1) * half, q.y + (k >> 1) * half, half};
}

/* Put four links in the place of one. Returns 0, or -1. */
static int split(struct run *run, size_t which, int emitter)
{
    struct link old = run->links[which];
    bring(run, &old, -1);
    run->links[which] = run->links[--run->count];
    int status = 0;
    for (int k = 0; k < 4 && status == 0; k++)
        status = emitter ? add(run, old.r, part_of(old.s, k), NULL)
                         : add(run, part_of(old.r, k), old.s, &old);
    free(old.seen[0]);
    for (size_t i = run->alone ? run->count - 4 : 0; i < run->count && status == 0; i++)
        if (run->alone || overlap(&run->links[i].r, &old.r))
            find_gains(run, &run->links[i]);
    return status;
}

static int begin(struct run *run)
{
    const struct greedy *g = run->g;
    for (int i = 0; i < 2; i++)
        if (!(run->scratch[i] = malloc((size_t)GREEDY_CELLS * GREEDY_CELLS * sizeof(double))))
            return -1;
    for (int i = 0; i < g->count; i++) {
        run->wrong[i] = malloc(cells_of(&g->face[i]) * sizeof(double));
        if (!run->wrong[i])
            return -1;
        for (size_t x = 0; x < cells_of(&g->face[i]); x++)
            run->wrong[i][x] = g->face[i].exitance - g->radiosity[i][x];
    }
    for (int i = 0; i < g->count; i++)
        for (int j = 0; j < g->count; j++)
            if (g->kernel[i][j]
                && add(run, (struct square){i, 0, 0, g->face[i].cells},
                       (struct square){j, 0, 0, g->face[j].cells}, NULL)
                       < 0)
                return -1;
    for (size_t i = 0; i < run->count; i++)
        find_gains(run, &run->links[i]);
    return 0;
}

int greedy_run(const struct greedy *g, enum greedy_norm norm, int linear, int alone, size_t most,
               struct greedy_step *steps)
{
    struct run run = {.g = g, .norm = norm, .linear = linear, .alone = alone};
    int status = begin(&run), count = 0;
    while (status == 0) {
        steps[count++] = (struct greedy_step){run.count, greedy_norm_of(g, run.wrong, norm)};
        size_t best = 0;
        double most_gain = 0;
        int emitter = 0;
        for (size_t i = 0; i < run.count; i++)
            for (int k = 0; k < 2; k++)
                if (run.links[i].gain[k] > most_gain) {
                    most_gain = run.links[i].gain[k];
                    best = i;
                    emitter = k;
                }
        if (!(most_gain > 0) || run.count + 3 > most)
            break;
        status = split(&run, best, emitter);
    }
    for (size_t i = 0; i < run.count; i++)
        free(run.links[i].seen[0]);
    for (int i = 0; i < GREEDY_FACES; i++)
        free(run.wrong[i]);
    free(run.scratch[0]);
    free(run.scratch[1]);
    free(run.links);
    return status < 0 ? -1 : count;
}
