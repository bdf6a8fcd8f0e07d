/* ambient.c - see ambient.h.
 *
 * In a closed scene with the same irradiance H everywhere, as much is absorbed as is emitted: H sum
 * A (1 - rho) = sum A E. Of an open one it is too much; particles, which come next, say by how
 * much. [Cohen et al. 1988, section 4: the ambient term]
 * SPDX-License-Identifier: MIT */
#include "engine/ambient.h"
#include "hierarchy/children_first.h"

struct following {
    const struct solve *s;
    struct state *state;
};

static void follow(const void *following, uint32_t e)
{
    const struct following *f = following;
    const struct problem *p = &f->s->problem;
    const struct light_operator *op = &f->s->operator;
    const struct element *at = &f->s->hierarchy.elements[e];
    for (uint32_t k = 0; k < p->bands; k++) {
        size_t i = (size_t)e * p->bands + k, of_face = (size_t)at->face * p->bands + k;
        double *B = &f->state->radiosity[i];
        if (at->children) {
            *B = 0;
            for (int c = 0; c < at->children; c++) {
                uint32_t j = at->child + (uint32_t)c;
                *B += operator_share(op, j, e) * f->state->radiosity[(size_t)j * p->bands + k];
            }
        } else {
            *B = op->uncovered[e] > 0
                     ? p->exitance[of_face]
                           + p->reflectance[of_face] * f->state->irradiance[i] / op->uncovered[e]
                     : f->s->state.radiosity[i];
        }
    }
}

void light_follows(const struct solve *s, struct state *state)
{
    const struct following f = {s, state};
    children_first(&s->hierarchy, s->problem.options.threads, follow, &f);
}

void light_of_clusters_follows(const struct solve *s, struct state *state)
{
    const struct following f = {s, state};
    children_first_clusters(&s->hierarchy, follow, &f);
}

struct filling {
    struct solve *s;
    double irradiance[3]; /* [band] (W/m2), of what is bare */
};

static void fill(const void *filling, uint32_t e)
{
    const struct filling *f = filling;
    const struct hierarchy *h = &f->s->hierarchy;
    const struct element *at = &h->elements[e];
    const uint32_t bands = f->s->problem.bands;
    double *H = f->s->state.irradiance;
    for (uint32_t k = 0; k < bands; k++) {
        double sum = 0;
        for (uint32_t j = at->child; j < at->child + at->children; j++)
            sum += h->elements[j].area * H[(size_t)j * bands + k];
        H[(size_t)e * bands + k] =
            at->children ? sum / at->area : f->irradiance[k] * f->s->operator.uncovered[e];
    }
}

void ambient_light(struct solve *s)
{
    const struct problem *p = &s->problem;
    const struct hierarchy *h = &s->hierarchy;
    struct filling f = {.s = s};
    for (uint32_t k = 0; k < p->bands; k++) {
        double emitted = 0, absorbing = 0;
        for (uint32_t i = 0; i < h->face_count; i++) {
            const uint32_t e = h->face_element[i];
            const size_t at = (size_t)i * p->bands + k;
            const double area = h->elements[e].area * s->operator.uncovered[e];
            emitted += area * p->exitance[at];
            absorbing += area * (1 - p->reflectance[at]);
        }
        f.irradiance[k] = absorbing > 0 ? emitted / absorbing : 0;
    }
    children_first(h, p->options.threads, fill, &f);
    light_follows(s, &s->state);
}
