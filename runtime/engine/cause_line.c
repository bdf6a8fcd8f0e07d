/* cause_line.c - see cause_line.h.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/cause_line.h"

/* What a surface reflects, as tables of faces show it: rho H, all bands (W/m2). */
static double shown(const struct solve *s, uint32_t e)
{
    uint32_t bands = s->problem.bands, face = s->hierarchy.elements[e].face;
    double light = 0;
    for (uint32_t k = 0; k < bands; k++)
        light += s->problem.reflectance[(size_t)face * bands + k]
                 * s->state.irradiance[(size_t)e * bands + k];
    return light;
}

double cause_line_length(const struct cause_line *line, uint32_t e)
{
    double light = line->mean > 0 ? fmax(shown(line->solve, e), 0) / line->mean : 1;
    return 0.5 * line->solve->hierarchy.elements[e].area * (1 + light);
}

static void lay_out(struct cause_line *line)
{
    const struct hierarchy *h = &line->solve->hierarchy;
    const double *whitest = line->solve->problem.whitest;
    uint32_t faces = h->face_count, polygons = h->faces[faces - 1].input + 1;
    uint64_t last = UINT64_MAX;
    line->until[0] = 0;
    for (uint32_t i = 0; i < faces; i++) {
        uint32_t input = h->faces[i].input;
        uint64_t chunk =
            polygons > CAUSE_CHUNKS ? (uint64_t)input * CAUSE_CHUNKS / polygons : input;
        if (chunk != last)
            line->chunk[line->chunks++] = i;
        last = chunk;
        double length = whitest[i] > 0 ? cause_line_length(line, h->face_element[i]) : 0;
        line->white += length * whitest[i];
        line->until[i + 1] = line->until[i] + length;
    }
    line->chunk[line->chunks] = faces;
    line->white = line->until[faces] > 0 ? line->white / line->until[faces] : 0;
}

int cause_line_open(struct cause_line *line, const struct solve *s, uint64_t stream)
{
    const struct hierarchy *h = &s->hierarchy;
    double area = 0;
    *line = (struct cause_line){.solve = s,
                                .stream = stream,
                                .until = malloc(((size_t)h->face_count + 1) * sizeof *line->until),
                                .chunk = malloc((CAUSE_CHUNKS + 1) * sizeof *line->chunk)};
    if (!line->until || !line->chunk) {
        cause_line_close(line);
        return -1;
    }
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct element *e = hierarchy_surface(h, i);
        area += s->problem.whitest[i] > 0 ? e->area : 0;
        line->reflected += e->area * shown(s, h->face_element[i]);
    }
    line->mean = area > 0 ? line->reflected / area : 0;
    lay_out(line);
    sobol_sequence_open(&line->sobol);
    for (int r = 0; r < REPLICATES; r++) {
        struct dice dice = dice_of(stream, UINT64_MAX - (uint64_t)r);
        line->shift[r].start = dice_throw(&dice);
        for (int d = 0; d < SOBOL_DIMENSIONS; d++)
            line->shift[r].digits[d] = (uint32_t)(dice_throw(&dice) * 0x1p32);
    }
    return 0;
}

void cause_line_spread(struct cause_line *line, uint64_t points)
{
    line->points = points > REPLICATES ? points : REPLICATES;
    line->spacing =
        line->until[line->solve->hierarchy.face_count] * REPLICATES / (double)line->points;
}

void cause_line_close(struct cause_line *line)
{
    free(line->until);
    free(line->chunk);
    *line = (struct cause_line){0};
}

int cause_line_has_points(const struct cause_line *line, double from, double to)
{
    for (int r = 0; r < REPLICATES; r++)
        if (cause_line_before(line, r, from) < cause_line_before(line, r, to))
            return 1;
    return 0;
}
