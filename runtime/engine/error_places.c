/* error_places.c - see error_places.h.
 *
 * What is constant on a leaf is off by half of what it differs from its neighbours, if the truth is
 * smooth: so the detail of a leaf is the mean square of its difference to its parent's children, at
 * their centres. What is linear is off by what it does not foretell of them there.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/error_places.h"
#include "particles/running_sums.h"
#include "kernel/constants.h"
#include "kernel/leaf_at.h"
#include "kernel/surface_point.h"
#include "util/array.h"

/* ---- where light lands */

/* Places on the line that particles meet: at most so many, of at most four times as many rays. */
static uint32_t land(const struct error_places *x, double *place, uint32_t most, uint64_t stream,
                     uint64_t *rays)
{
    const struct tracer *t = x->tracer;
    uint32_t found = 0;
    uint64_t cast = 0;
    for (uint64_t i = 0; found < most && cast < 4 * (uint64_t)most; i++) {
        struct dice dice = dice_of(stream, i);
        double u[5], p[3], at[3];
        for (int d = 0; d < 5; d++)
            u[d] = dice_throw(&dice);
        uint32_t face = lights_choose(&t->lights, u[0]);
        tracer_point(t, face, u[1], u[2], p);
        for (double s = u[3], v = u[4]; found < most;
             s = dice_throw(&dice), v = dice_throw(&dice)) {
            int64_t met = tracer_step(t, face, p, s, v, at);
            cast++;
            if (met < 0)
                break;
            face = (uint32_t)met;
            double rho = 0, where = area_line_place(&x->line, t, face, at);
            for (uint32_t k = 0; k < t->bands; k++)
                rho = fmax(rho, t->reflectance[(size_t)face * t->bands + k]);
            if (where >= 0)
                place[found++] = where;
            if (!(dice_throw(&dice) < rho))
                break;
        }
    }
    *rays += cast;
    return found;
}

static int spread_light(struct error_places *x, uint32_t landings, uint64_t stream, uint64_t *rays)
{
    double *place = malloc((landings + 1) * sizeof *place);
    if (!place)
        return -1;
    uint32_t found = land(x, place, landings, stream, rays), kept = 0;
    qsort(place, found, sizeof *place, compare_numbers);
    for (uint32_t i = ERROR_PLACES_CELL / 2; i < found; i += ERROR_PLACES_CELL)
        place[kept++] = place[i];
    int failed = spread_around(&x->lit, place, NULL, kept, 0);
    free(place);
    return failed;
}

/* ---- where the solution has detail */

static double detail_of(const struct error_places *x, uint32_t leaf)
{
    const struct element *elements = x->tracer->hierarchy->elements,
                         *parent = &elements[elements[leaf].parent];
    uint32_t bands = x->tracer->bands;
    double square = 0;
    if (leaf == 0 || !parent->vertices)
        return 0;
    for (uint32_t c = parent->child; c < parent->child + parent->children; c++)
        for (uint32_t k = 0; k < bands; k++) {
            double off = x->light->mean[(size_t)c * bands + k]
                         - element_light_at(x->light, leaf, k, elements[c].centre);
            square += off * off / parent->children;
        }
    return square;
}

static int spread_detail(struct error_places *x)
{
    const struct hierarchy *h = x->tracer->hierarchy;
    double sum = 0;
    x->detail.leaf = malloc(h->count * sizeof *x->detail.leaf);
    x->detail.until = malloc(h->count * sizeof *x->detail.until);
    x->detail.density = malloc(h->count * sizeof *x->detail.density);
    if (!x->detail.leaf || !x->detail.until || !x->detail.density)
        return -1;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        int counts = !e->children && x->line.place[e->face] != UINT32_MAX;
        x->detail.density[i] = counts ? detail_of(x, i) : 0;
        if (!(x->detail.density[i] > 0))
            continue;
        x->detail.leaf[x->detail.count] = i;
        x->detail.until[x->detail.count++] = sum += x->detail.density[i] * e->area;
    }
    for (uint32_t i = 0; i < x->detail.count; i++)
        x->detail.until[i] /= sum;
    for (uint32_t i = 0; i < h->count && sum > 0; i++)
        x->detail.density[i] *= x->line.area / sum;
    return 0;
}

/* ---- all of them */

int error_places_open(struct error_places *x, const struct tracer *t,
                      const struct element_light *light, uint32_t landings, uint64_t stream,
                      uint64_t *rays)
{
    *x = (struct error_places){.tracer = t, .light = light};
    if (area_line_open(&x->line, t) < 0)
        return -1;
    if (x->line.count == 0 || t->lights.count == 0)
        return 0;
    return spread_light(x, landings, stream, rays) < 0 || spread_detail(x) < 0 ? -1 : 0;
}

void error_places_close(struct error_places *x)
{
    area_line_close(&x->line);
    spread_close(&x->lit);
    spread_close(&x->wrong);
    free(x->detail.leaf);
    free(x->detail.until);
    free(x->detail.density);
    *x = (struct error_places){0};
}

static const struct spread *spread_of(const struct error_places *x, enum error_place density)
{
    return density == PLACES_LIT ? &x->lit : density == PLACES_WRONG ? &x->wrong : &x->even;
}

struct place error_places_draw(const struct error_places *x, enum error_place density, double v,
                               struct dice *dice)
{
    const struct tracer *t = x->tracer;
    const struct element *elements = t->hierarchy->elements;
    struct place out;
    double weight[4];
    if (density != PLACES_DETAIL || x->detail.count == 0) {
        out.u = spread_place(spread_of(x, density), v);
        out.face = area_line_point(&x->line, t, out.u, out.p);
        out.leaf = leaf_at(elements, t->hierarchy->face_element[out.face], out.p, weight);
        return out;
    }
    uint32_t low = running_sums_find(x->detail.until, x->detail.count, v);
    const struct element *e = &elements[x->detail.leaf[low]];
    double before = low ? x->detail.until[low - 1] : 0,
           s = fmin(fmax((v - before) / (x->detail.until[low] - before), 0), 1 - 0x1p-53);
    surface_even_point(out.p, e, s, dice_throw(dice));
    out.face = e->face;
    out.leaf = x->detail.leaf[low];
    out.u = area_line_place(&x->line, t, out.face, out.p);
    for (int k = 0; k < 3; k++)
        out.p[k] += rays_host(t->rays)->ray_offset * e->normal[k];
    return out;
}

double error_places_density(const struct error_places *x, enum error_place density,
                            const struct place *at)
{
    return density == PLACES_DETAIL && x->detail.count > 0
               ? x->detail.density[at->leaf]
               : spread_density(spread_of(x, density), at->u);
}
