/* area_line.c - see area_line.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "particles/area_line.h"
#include "particles/running_sums.h"

int area_line_open(struct area_line *line, const struct tracer *t)
{
    const struct hierarchy *h = t->hierarchy;
    size_t faces = h->face_count;
    *line = (struct area_line){.face = malloc(faces * sizeof *line->face),
                               .until = malloc(faces * sizeof *line->until),
                               .place = malloc(faces * sizeof *line->place)};
    if (!line->face || !line->until || !line->place) {
        area_line_close(line);
        return -1;
    }
    for (uint32_t i = 0; i < faces; i++) {
        uint32_t face = h->order[i];
        line->place[face] = UINT32_MAX;
        if (!(tracer_reflectance(t, face) > 0))
            continue;
        line->place[face] = line->count;
        line->face[line->count] = face;
        line->until[line->count++] = line->area += tracer_surface(t, face)->area;
    }
    return 0;
}

void area_line_close(struct area_line *line)
{
    free(line->face);
    free(line->until);
    free(line->place);
    *line = (struct area_line){0};
}

/* The 26 bits at every second place, put together; and apart again. */
static uint64_t gather_bits(uint64_t x)
{
    uint64_t out = 0;
    for (int b = 0; b < 26; b++)
        out |= (x >> (2 * b) & 1) << b;
    return out;
}

static uint64_t scatter_bits(uint64_t x)
{
    uint64_t out = 0;
    for (int b = 0; b < 26; b++)
        out |= (x >> b & 1) << (2 * b);
    return out;
}

uint32_t area_line_point(const struct area_line *line, const struct tracer *t, double u,
                         double p[3])
{
    double at = u * line->area;
    uint32_t low = running_sums_find(line->until, line->count, at);
    double before = low ? line->until[low - 1] : 0,
           within = (at - before) / (line->until[low] - before);
    uint64_t code = (uint64_t)(fmin(fmax(within, 0), 1 - 0x1p-52) * 0x1p52);
    tracer_point(t, line->face[low], ((double)gather_bits(code >> 1) + 0.5) * 0x1p-26,
                 ((double)gather_bits(code) + 0.5) * 0x1p-26, p);
    return line->face[low];
}

/* (s, t) of the even point: weights of the corners of the triangle 0, first, first + 1. */
static void even_place(const struct element *e, const double at[3], double *s, double *t)
{
    double share = 1, weight[2] = {0, 0}, whole = 0;
    for (int first = 1; first < e->vertices - 1; first++) {
        double b[3], c[3], x[3], n[3], part[3];
        sub3(b, e->vertex[first], e->vertex[0]);
        sub3(c, e->vertex[first + 1], e->vertex[0]);
        sub3(x, at, e->vertex[0]);
        cross3(n, b, c);
        double square = dot3(n, n);
        cross3(part, x, c);
        weight[0] = dot3(part, n) / square;
        cross3(part, b, x);
        weight[1] = dot3(part, n) / square;
        if (first == 1 && e->vertices == 4)
            share = 0.5 * sqrt(square) / e->area;
        if (first == 2)
            whole = share;
        if (weight[0] >= 0) /* on this side of the diagonal from 0 to first + 1 */
            break;
    }
    weight[0] = fmax(weight[0], 0);
    weight[1] = fmax(weight[1], 0);
    double root = fmin(weight[0] + weight[1], 1);
    *t = root > 0 ? fmin(weight[1] / root, 1) : 0;
    *s = whole > 0 ? whole + (1 - whole) * root * root : share * root * root;
}

double area_line_place(const struct area_line *line, const struct tracer *t, uint32_t face,
                       const double at[3])
{
    uint32_t place = line->place[face];
    if (place == UINT32_MAX)
        return -1;
    double u, v, before = place ? line->until[place - 1] : 0;
    even_place(tracer_surface(t, face), at, &u, &v);
    uint64_t code = scatter_bits((uint64_t)fmin(u * 0x1p26, 0x1p26 - 1)) << 1
                    | scatter_bits((uint64_t)fmin(v * 0x1p26, 0x1p26 - 1));
    return (before + (line->until[place] - before) * (double)code * 0x1p-52) / line->area;
}
