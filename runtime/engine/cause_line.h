/* cause_line.h - points on all surfaces that reflect: laid out along a line, spread evenly over it.
 *
 * Half of the line is shared by area, half by the light that is reflected: so a lampshade, small
 * but bright, has points enough. Faces come in their order, parts of faces as in the tree. Points
 * come in REPLICATES sets that are shifted at random; the place on a leaf, and what else is asked
 * for there, follow a Sobol' sequence along the line.
 *
 * Invariant: points depend on the solution, their number and the stream alone.
 * SPDX-License-Identifier: MIT */
#ifndef CAUSE_LINE_H
#define CAUSE_LINE_H

#include <math.h>
#include "engine/solve.h"
#include "particles/particles.h"
#include "particles/sobol_sequence.h"

enum { CAUSE_CHUNKS = 1024 };

struct cause_line {
    const struct solve *solve; /* borrowed */
    double *until;             /* [faces + 1]: where faces begin and end (m2) */
    uint32_t *chunk;           /* [chunks + 1]: the first face of each; polygons are whole */
    uint32_t chunks;
    double reflected, mean; /* light, all bands: W, W/m2 */
    double white;           /* the largest rho, mean along the line */
    double spacing;         /* between points of a replicate (m2); 0: nothing reflects */
    uint64_t points;        /* all replicates, about */
    uint64_t stream;
    struct sobol_sequence sobol;
    struct {
        double start; /* of the first point, in spacings */
        uint32_t digits[SOBOL_DIMENSIONS];
    } shift[REPLICATES];
};

/* No points yet. Returns 0, or -1 when out of memory. */
int cause_line_open(struct cause_line *line, const struct solve *s, uint64_t stream);
/* About so many points, all replicates together. */
void cause_line_spread(struct cause_line *line, uint64_t points);
void cause_line_close(struct cause_line *line);

/* How long the line is on the surface e (m2). */
double cause_line_length(const struct cause_line *line, uint32_t e);

/* How many points of a replicate lie before a place on the line. */
static inline uint64_t cause_line_before(const struct cause_line *line, int replicate, double place)
{
    return (uint64_t)ceil(fmax(place / line->spacing - line->shift[replicate].start, 0));
}

/* Does any point lie from .. to? */
int cause_line_has_points(const struct cause_line *line, double from, double to);

/* What goes with point i of a replicate: u in [0, 1)^5, and dice. */
static inline struct dice cause_line_point(const struct cause_line *line, int replicate, uint64_t i,
                                           double u[SOBOL_DIMENSIONS])
{
    sobol_sequence_point(&line->sobol, (uint32_t)i, line->shift[replicate].digits, u);
    return dice_of(line->stream, (uint64_t)replicate << 32 | i);
}

#endif
