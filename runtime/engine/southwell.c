/* southwell.c - progressive shooting: what has changed most is sent on first.
 *
 * x holds what has arrived; the part of it that has not been sent on yet is unshot. The face with
 * the most unshot power shoots all of it, from each of its elements over the links that go out from
 * there, and is relaxed again when enough has come back: Southwell's method, a face at a time.
 * Links bring light to elements of any size; it waits there (`arrived`) and is pushed down to the
 * leaves only when their face is next to shoot. What is known of a face before that is a bound of
 * its unshot power, the sum of what arrived times the reflectance: the order is chosen by it, and
 * nothing else depends on it. Invariant: x + (K-series of what is unshot or has arrived) is the
 * solution, before and after each shot.
 *
 * Links of clusters join sides, not elements: their light is shot all at once, by
 * separable_links_send, when more of it waits (`afar`) than of all faces.
 *
 * Shots are rounded, and the bound on what is left wants the largest change of a leaf: so Jacobi's
 * sweeps stand between (transport.c), each of which says what is unshot anew.
 *
 * The ambient estimate is what unshot light would become if each reflection spread it evenly over
 * all surfaces: 1 / (1 - mean rho) times it. It says when a rough solve may stop, and brightens a
 * solve that is cut short; no shot knows of it.
 *
 * One after the other, so the result does not depend on threads.
 * [Southwell 1940 for the method; Gortler, Cohen and Slusallek 1994: shooting is that; Cohen, Chen,
 * Wallace and Greenberg 1988 for the ambient estimate; face by face over links: derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/push_pull.h"
#include "engine/southwell.h"

struct southwell {
    uint32_t bands;
    size_t *first,
        *out;        /* links that go out from element e: out[first[e]] .. out[first[e + 1] - 1] */
    double *unshot;  /* [element * bands + band]; between keep and shoot, what x was */
    double *arrived; /* [element * bands + band]: irradiance that is not pushed down yet */
    double *fresh;   /* [element * bands + band]: what it makes of the face at hand */
    double *afar;    /* [element * bands + band]: to be sent over links of clusters; or NULL */
    double reflects; /* mean reflectance, by which that is weighed */
    double power_afar;      /* of it, once reflected (W, all bands) */
    double *power;          /* [face]: at least what is unshot (W, all bands) */
    double waits;           /* all of both (W, all bands) */
    uint32_t *heap, *place; /* faces, the most power first; where each stands */
};

/* Of links between surfaces; others have nothing that goes out alone. */
static int goes_out(const struct light_operator *op, size_t i)
{
    const struct element *elements = op->hierarchy->elements;
    const struct link *l = &op->refinement->links[i];
    return elements[l->receiver].vertices && elements[l->emitter].vertices;
}

static void sort_by_emitter(struct southwell *s, const struct light_operator *op)
{
    const struct refinement *r = op->refinement;
    uint32_t count = op->hierarchy->count;
    memset(s->first, 0, ((size_t)count + 2) * sizeof *s->first);
    for (size_t i = 0; i < r->link_count; i++)
        s->first[r->links[i].emitter + 2] += (size_t)goes_out(op, i);
    for (size_t e = 2; e < (size_t)count + 2; e++)
        s->first[e] += s->first[e - 1];
    for (size_t i = 0; i < r->link_count; i++)
        if (goes_out(op, i))
            s->out[s->first[r->links[i].emitter + 1]++] = i;
}

struct southwell *southwell_new(const struct light_operator *op, const struct transport *x)
{
    struct southwell *s = calloc(1, sizeof *s);
    size_t elements = op->hierarchy->count, faces = op->hierarchy->face_count,
           values = elements * x->bands;
    if (!s)
        return NULL;
    s->bands = x->bands;
    s->reflects = southwell_reflects(op, x);
    s->first = malloc((elements + 2) * sizeof *s->first);
    s->out = malloc((op->refinement->link_count + 1) * sizeof *s->out);
    s->unshot = malloc(values * sizeof *s->unshot);
    s->arrived = calloc(values, sizeof *s->arrived);
    s->fresh = calloc(values, sizeof *s->fresh);
    s->afar = op->separable.count ? calloc(values, sizeof *s->afar) : NULL;
    s->power = malloc(faces * sizeof *s->power);
    s->heap = malloc(faces * sizeof *s->heap);
    s->place = malloc(faces * sizeof *s->place);
    if (!s->first || !s->out || !s->unshot || !s->arrived || !s->fresh || !s->power || !s->heap
        || !s->place || (op->separable.count && !s->afar)) {
        southwell_free(s);
        return NULL;
    }
    sort_by_emitter(s, op);
    return s;
}

void southwell_keep(struct southwell *s, const struct light_operator *op, const struct transport *x)
{
    memcpy(s->unshot, x->value, (size_t)op->hierarchy->count * s->bands * sizeof *s->unshot);
}

/* ---- the heap of faces */

static void put(struct southwell *s, uint32_t at, uint32_t face)
{
    s->heap[at] = face;
    s->place[face] = at;
}

static void rise(struct southwell *s, uint32_t face)
{
    uint32_t at = s->place[face];
    for (; at > 0 && s->power[s->heap[(at - 1) / 2]] < s->power[face]; at = (at - 1) / 2)
        put(s, at, s->heap[(at - 1) / 2]);
    put(s, at, face);
}

static void sink(struct southwell *s, uint32_t faces, uint32_t face)
{
    uint32_t at = s->place[face];
    for (;;) {
        uint32_t below = 2 * at + 1;
        if (below + 1 < faces && s->power[s->heap[below + 1]] > s->power[s->heap[below]])
            below++;
        if (below >= faces || !(s->power[s->heap[below]] > s->power[face]))
            break;
        put(s, at, s->heap[below]);
        at = below;
    }
    put(s, at, face);
}

/* ---- shots */

/* Light h (W/m2) arrives at element e. */
static void arrive(struct southwell *s, const struct light_operator *op, const struct transport *x,
                   uint32_t e, const double h[3])
{
    const struct element *at = &op->hierarchy->elements[e];
    double power = 0;
    for (uint32_t k = 0; k < s->bands; k++) {
        s->arrived[(size_t)e * s->bands + k] += h[k];
        power += fabs(h[k]) * x->reflectance[(size_t)at->face * s->bands + k];
    }
    s->power[at->face] += power * at->area;
    s->waits += power * at->area;
    rise(s, at->face);
}

/* What arrived at e and its parts is light of x from here on, and unshot. */
static void take_in(struct southwell *s, const struct light_operator *op, const struct transport *x,
                    uint32_t e)
{
    const struct element *at = &op->hierarchy->elements[e];
    for (size_t i = (size_t)e * s->bands; i < ((size_t)e + 1) * s->bands; i++) {
        s->unshot[i] += s->fresh[i];
        x->value[i] += s->fresh[i];
        x->irradiance[i] += s->arrived[i];
        s->arrived[i] = 0;
    }
    for (int c = 0; c < at->children; c++)
        take_in(s, op, x, at->child + (uint32_t)c);
}

/* Send what is unshot of e and its parts. Returns over how many links. */
static size_t send(struct southwell *s, const struct light_operator *op, const struct transport *x,
                   uint32_t e)
{
    const struct element *at = &op->hierarchy->elements[e];
    double *unshot = &s->unshot[(size_t)e * s->bands], h[3];
    size_t links = s->first[e + 1] - s->first[e];
    for (size_t o = s->first[e]; o < s->first[e + 1]; o++) {
        double weight = operator_weight(op, s->out[o]);
        for (uint32_t k = 0; k < s->bands; k++)
            h[k] = weight * unshot[k];
        arrive(s, op, x, op->refinement->links[s->out[o]].receiver, h);
    }
    for (uint32_t k = 0; k < s->bands; k++) {
        if (s->afar)
            s->afar[(size_t)e * s->bands + k] += unshot[k];
        if (s->afar && at->depth == 0) {
            double power = at->area * fabs(unshot[k]) * s->reflects;
            s->power_afar += power;
            s->waits += power;
        }
        unshot[k] = 0;
    }
    for (int c = 0; c < at->children; c++)
        links += send(s, op, x, at->child + (uint32_t)c);
    return links;
}

/* What arrived, as an equation without a source. */
static struct transport step_of(struct southwell *s, const struct transport *x)
{
    return (struct transport){.bands = s->bands,
                              .value = s->fresh,
                              .irradiance = s->arrived,
                              .reflectance = x->reflectance};
}

static size_t shoot_face(struct southwell *s, const struct light_operator *op,
                         const struct transport *x, uint32_t face)
{
    const struct transport step = step_of(s, x);
    uint32_t e = op->hierarchy->face_element[face];
    struct change change;
    face_update(op, &step, e, &change);
    take_in(s, op, x, e);
    s->waits -= s->power[face];
    s->power[face] = 0;
    sink(s, op->hierarchy->face_count, face);
    return send(s, op, x, e) + 1;
}

/* Light of links of clusters arrives at e and its parts. */
static void arrive_from_afar(struct southwell *s, const struct light_operator *op,
                             const struct transport *x, uint32_t e)
{
    const struct element *at = &op->hierarchy->elements[e];
    double h[3] = {0, 0, 0};
    separable_links_gather(&op->separable, (int)s->bands, e, h);
    if (h[0] != 0 || h[1] != 0 || h[2] != 0)
        arrive(s, op, x, e, h);
    for (int c = 0; c < at->children; c++)
        arrive_from_afar(s, op, x, at->child + (uint32_t)c);
}

static size_t shoot_afar(struct southwell *s, const struct light_operator *op,
                         const struct transport *x)
{
    const struct hierarchy *h = op->hierarchy;
    separable_links_send(&op->separable, (int)s->bands, s->afar);
    memset(s->afar, 0, (size_t)h->count * s->bands * sizeof *s->afar);
    s->waits -= s->power_afar;
    s->power_afar = 0;
    for (uint32_t i = 0; i < h->face_count; i++)
        arrive_from_afar(s, op, x, h->face_element[i]);
    return op->separable.count + 1;
}

/* ---- a round of shots, between two sweeps */

/* What the sweep has changed of e and its parts is unshot. Returns its power (W, all bands). */
static double note_unshot(struct southwell *s, const struct light_operator *op,
                          const struct transport *x, uint32_t e)
{
    const struct element *at = &op->hierarchy->elements[e];
    const struct transport step = {.bands = s->bands, .value = s->unshot, .irradiance = s->arrived};
    double power = 0;
    for (int c = 0; c < at->children; c++)
        power += note_unshot(s, op, x, at->child + (uint32_t)c);
    if (at->children) {
        element_average(op, &step, e);
        return power;
    }
    for (size_t i = (size_t)e * s->bands; i < ((size_t)e + 1) * s->bands; i++) {
        s->unshot[i] = x->value[i] - s->unshot[i];
        power += at->area * op->uncovered[e] * fabs(s->unshot[i]);
    }
    return power;
}

/* Power that waits, anew, so that no rounding adds up. */
static double waiting(const struct southwell *s, const struct light_operator *op)
{
    double power = s->power_afar;
    for (uint32_t i = 0; i < op->hierarchy->face_count; i++)
        power += s->power[i];
    return power;
}

/* Shoot until what waits is no more than `share` of what waited at first, or for as long as
 * `sweeps` sweeps take. */
static int shoot(struct southwell *s, const struct light_operator *op, struct transport *x,
                 double share, int sweeps)
{
    const size_t links = op->refinement->link_count + op->hierarchy->face_count;
    const double first = s->waits = waiting(s, op), residual = x->residual;
    int stopped = 0;
    while (s->waits > share * first && sweeps-- > 0 && !stopped) {
        for (size_t taken = 0; taken < links && s->waits > share * first;) {
            uint32_t face = s->heap[0];
            if (!(s->power[face] + s->power_afar > 0))
                break;
            if (s->power_afar > s->waits - s->power_afar)
                taken += shoot_afar(s, op, x);
            else
                taken += shoot_face(s, op, x, face);
        }
        s->waits = waiting(s, op);
        x->residual = residual * (s->waits / first);
        x->sweeps++;
        stopped = x->watch && x->watch(x->watch_context, x);
    }
    return stopped ? -1 : 0;
}

int southwell_shoot(struct southwell *s, const struct light_operator *op, struct transport *x,
                    double left, int most)
{
    const struct hierarchy *h = op->hierarchy;
    const struct transport step = step_of(s, x);
    struct change change;
    for (uint32_t i = 0; i < h->face_count; i++) {
        s->power[i] = note_unshot(s, op, x, h->face_element[i]);
        put(s, i, i);
        rise(s, i);
    }
    if (shoot(s, op, x, isfinite(left) ? fmin(0.25, 0.5 / left) : 0.25, most - x->sweeps) < 0)
        return -1;
    if (s->power_afar > 0)
        shoot_afar(s, op, x);
    for (uint32_t i = 0; i < h->face_count; i++) { /* what still waits has arrived all the same */
        face_update(op, &step, h->face_element[i], &change);
        take_in(s, op, x, h->face_element[i]);
    }
    return 0;
}

/* ---- the ambient estimate */

/* Sums of A and A rho over what is uncovered. */
static void sum_reflectance(const struct light_operator *op, const struct transport *x,
                            double *area, double rho[3])
{
    const struct hierarchy *h = op->hierarchy;
    *area = rho[0] = rho[1] = rho[2] = 0;
    for (uint32_t i = 0; i < h->face_count; i++) {
        uint32_t e = h->face_element[i];
        double a = h->elements[e].area * op->uncovered[e];
        *area += a;
        for (uint32_t k = 0; k < x->bands; k++)
            rho[k] += a * x->reflectance[(size_t)i * x->bands + k];
    }
}

double southwell_reflects(const struct light_operator *op, const struct transport *x)
{
    double area, rho[3];
    sum_reflectance(op, x, &area, rho);
    return area > 0 ? fmax(rho[0], fmax(rho[1], rho[2])) / area : 0;
}

static void add_ambient(const struct light_operator *op, const struct transport *x, uint32_t e,
                        const double ambient[3])
{
    const struct element *at = &op->hierarchy->elements[e];
    for (int c = 0; c < at->children; c++)
        add_ambient(op, x, at->child + (uint32_t)c, ambient);
    if (at->children)
        element_average(op, x, e);
    for (uint32_t k = 0; k < x->bands && !at->children; k++) {
        size_t i = (size_t)e * x->bands + k;
        x->irradiance[i] += ambient[k] * op->uncovered[e];
        x->value[i] += ambient[k] * x->reflectance[(size_t)at->face * x->bands + k];
    }
}

void southwell_ambient(const struct southwell *s, const struct light_operator *op,
                       struct transport *x)
{
    const struct hierarchy *h = op->hierarchy;
    double area, rho[3], ambient[3] = {0, 0, 0};
    sum_reflectance(op, x, &area, rho);
    for (uint32_t i = 0; i < h->face_count; i++) {
        uint32_t e = h->face_element[i];
        for (uint32_t k = 0; k < x->bands; k++)
            ambient[k] +=
                h->elements[e].area * op->uncovered[e] * s->unshot[(size_t)e * x->bands + k];
    }
    for (uint32_t k = 0; k < x->bands; k++)
        ambient[k] = area > rho[k] ? ambient[k] / (area - rho[k]) : 0;
    for (uint32_t i = 0; i < h->face_count; i++)
        add_ambient(op, x, h->face_element[i], ambient);
}

void southwell_free(struct southwell *s)
{
    if (!s)
        return;
    free(s->first);
    free(s->out);
    free(s->unshot);
    free(s->arrived);
    free(s->fresh);
    free(s->afar);
    free(s->power);
    free(s->heap);
    free(s->place);
    free(s);
}
