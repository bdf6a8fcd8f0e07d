/* defect.c - what constants cost: the discretization defect of a leaf.
 *
 * d = rho max_k |sum_l B_s V (F(x_k) - F)| over the leaf's own links l and its ancestors', x_k the leaf's corners and its
 * centre: the irradiance that the links would bring to the point, less what they bring to the whole leaf. Errors of
 * opposite sign cancel as they do in truth, so the sum is taken first and the modulus then.
 * [Bekaert and Willems 1996, equation 11; Arvo et al. 1994, section 5.2: what projection onto constants leaves]
 *
 * Between the points F may range further; and V is the link's, so a shadow's edge that crosses the leaf does not
 * show. Exitance is the same all over a face and adds nothing. Corners are taken 2^-20 of the way to the centre,
 * as in terms/form_factor_range.h: where two elements touch, F has no value at the corner itself.
 *
 * Where a link has a cluster at one end, the emitter is the point with a normal that the link takes it for (cluster_light.h), and
 * what its whole face takes is what the leaf does. The receiver's clusters count, too.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "engine/residual.h"
#include "kernel/point_factor.h"

enum { POINTS = 5 };

/* Add what one link would bring to each point, less what it brings to all. */
static void add_link(const struct solve *s, const struct link *l, const struct element *leaf, double (*x)[3], int count,
                     double sum[POINTS][3])
{
    const struct element *emitter = &s->hierarchy.elements[l->emitter];
    const double *from = &s->radiosity[(size_t)l->emitter * s->bands];
    double visible = l->visibility * (1.0 / LINK_VISIBLE);
    struct polygon q;
    uint32_t k;
    int i;
    point_factor_clip(&q, leaf, emitter);
    for (i = 0; i < count; i++) {
        double off = visible * (point_factor_at(x[i], leaf, emitter, &q) - (double)l->form_factor);
        for (k = 0; k < s->bands; k++)
            sum[i][k] += from[k] * off;
    }
}

/* The same for the beams of element `up`, which is the leaf or holds it, and of which `taker` takes the light: the whole face, or the part
 * of it that has the beams. Returns how many there are. */
static uint32_t add_beams(const struct solve *s, uint32_t up, const struct element *taker, double (*x)[3], int count, double sum[POINTS][3])
{
    const struct cluster_light *light = &s->cluster_light;
    size_t b;
    int i;
    if (light->count == 0 || up >= light->elements)
        return 0;
    for (b = light->first[up]; b < light->first[up + 1]; b++) {
        const struct cluster_beam *beam = &light->beams[b];
        double whole = cluster_light_at(light, beam, taker->centre, taker->normal);
        for (i = 0; i < count; i++) {
            double off = cluster_light_at(light, beam, x[i], taker->normal) - whole;
            uint32_t k;
            for (k = 0; k < s->bands; k++)
                sum[i][k] += light->arrives[b * s->bands + k] * off;
        }
    }
    return (uint32_t)(light->first[up + 1] - light->first[up]);
}

static double largest(const struct solve *s, const struct element *e, double sum[POINTS][3])
{
    const double *rho = &s->reflectance[(size_t)e->face * s->bands];
    double most = 0;
    uint32_t k;
    int i;
    for (i = 0; i <= e->vertices; i++)
        for (k = 0; k < s->bands; k++)
            most = fmax(most, rho[k] * fabs(sum[i][k]));
    return most;
}

struct defect defect_leaf(const struct solve *s, uint32_t leaf)
{
    const struct element *e = &s->hierarchy.elements[leaf], *taker = e;
    const struct refinement *r = &s->refinement;
    double x[POINTS][3], sum[2][POINTS][3]; /* sum[1]: of links that a guard kept whole */
    struct defect result = { 0, 0, 0 };
    uint32_t up = leaf;
    size_t l;
    int i, c;
    memset(sum, 0, sizeof sum);
    for (i = 0; i < e->vertices; i++)
        for (c = 0; c < 3; c++)
            x[i][c] = e->vertex[i][c] + (1 / 1048576.0) * (e->centre[c] - e->vertex[i][c]);
    memcpy(x[i], e->centre, sizeof e->centre);
    for (;; up = s->hierarchy.elements[up].parent) {
        if (s->hierarchy.elements[up].vertices)
            taker = &s->hierarchy.elements[up];
        result.links += add_beams(s, up, taker, x, e->vertices + 1, sum[0]);
        for (l = r->first_link[up]; l < r->first_link[up + 1]; l++) {
            if (!s->hierarchy.elements[r->links[l].receiver].vertices || !s->hierarchy.elements[r->links[l].emitter].vertices)
                continue;
            add_link(s, &r->links[l], e, x, e->vertices + 1, sum[r->links[l].mark == LINK_GUARDED]);
            result.links++;
        }
        if (up == 0)
            break;
    }
    result.guarded = largest(s, e, sum[1]);
    for (i = 0; i <= e->vertices; i++)
        for (c = 0; c < 3; c++)
            sum[0][i][c] += sum[1][i][c];
    result.all = largest(s, e, sum[0]);
    return result;
}
