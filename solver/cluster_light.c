/* cluster_light.c - see cluster_light.h. Invariant: what a face gathers is summed in the order of its own beams,
 * then its clusters' from below; so the result does not depend on threads.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "cluster_light.h"

#define INVERSE_PI 0.31830988618379067154

static int is_beam(const struct hierarchy *h, const struct link *l)
{
    return !h->elements[l->receiver].vertices || !h->elements[l->emitter].vertices;
}

/* The variance of an element's points along v (unit) and in all, by its box as if that were filled evenly (m2). */
static void variances(const struct element *e, const double v[3], double *along, double *whole)
{
    double size;
    int i, k;
    for (k = 0; k < 3; k++) {
        double low = e->vertex[0][k], high = low;
        for (i = 1; i < (e->vertices ? e->vertices : 2); i++) {
            low = e->vertex[i][k] < low ? e->vertex[i][k] : low;
            high = e->vertex[i][k] > high ? e->vertex[i][k] : high;
        }
        size = (high - low) * (high - low) * (1 / 12.0);
        *along += v[k] * v[k] * size;
        *whole += size;
    }
}

/* The mean of cos cos / d^2 over two bodies that face each other differs from the value between their centres by the
 * factor 1 + (3 a - 2 t) / d^2 to second order, a the variance of their points along the line of centres and t across it. Without it
 * walls of many faces that face each other would exchange too much: a furnace gains 2 %. */
static struct cluster_beam beam(const struct hierarchy *h, const struct link *l)
{
    const struct element *r = &h->elements[l->receiver], *s = &h->elements[l->emitter];
    struct cluster_beam b;
    double v[3], square, distance, along = 0, whole = 0, factor;
    int k;
    sub3(v, s->centre, r->centre);
    square = dot3(v, v);
    distance = sqrt(square);
    b.emitter = l->emitter;
    for (k = 0; k < 3; k++) {
        v[k] /= distance;
        b.towards[k] = (float)v[k];
    }
    variances(r, v, &along, &whole);
    variances(s, v, &along, &whole);
    factor = (3 * along - 2 * (whole - along)) / square;
    factor = factor < 0 ? 1 / (1 - factor) : 1 + factor;
    b.weight = (float)(l->visibility * (1.0 / LINK_VISIBLE) * factor / square);
    return b;
}

/* The intensity of emitter s towards the beam's receiver, times the beam's weight. radiosity NULL: B = 1. */
static void bring(const struct cluster_light *c, const struct cluster_beam *b, size_t bands, const double *radiosity, double *to)
{
    const struct hierarchy *h = c->hierarchy;
    const struct element *s = &h->elements[b->emitter];
    double sum[3] = { 0, 0, 0 };
    size_t k, f;
    if (s->vertices) {
        double cosine = -(s->normal[0] * b->towards[0] + s->normal[1] * b->towards[1] + s->normal[2] * b->towards[2]);
        for (k = 0; k < bands && cosine > 0; k++)
            sum[k] = INVERSE_PI * s->area * (radiosity ? radiosity[b->emitter * bands + k] : 1) * cosine;
    } else {
        const double *sent = radiosity ? c->sent : c->area;
        for (f = h->range[b->emitter].from; f < h->range[b->emitter].to; f++) {
            const double *n = &c->normal[3 * f];
            double cosine = -(n[0] * b->towards[0] + n[1] * b->towards[1] + n[2] * b->towards[2]);
            for (k = 0; k < bands && cosine > 0; k++)
                sum[k] += sent[f * bands + k] * cosine;
        }
    }
    for (k = 0; k < bands; k++)
        to[k] = b->weight * sum[k];
}

int cluster_light_open(struct cluster_light *c, const struct hierarchy *h, const struct refinement *r, int bands, int threads)
{
    size_t i, n = 0;
    uint32_t e;
    int k;
    memset(c, 0, sizeof *c);
    c->hierarchy = h;
    c->bands = bands;
    c->threads = threads;
    for (i = 0; i < r->link_count; i++)
        n += (size_t)is_beam(h, &r->links[i]);
    if (n == 0)
        return 0;
    c->elements = h->count;
    c->beams = malloc(n * sizeof *c->beams);
    c->first = malloc(((size_t)h->count + 1) * sizeof *c->first);
    c->arrives = malloc(n * (size_t)bands * sizeof *c->arrives);
    c->normal = malloc((size_t)h->face_count * 3 * sizeof *c->normal);
    c->sent = malloc((size_t)h->face_count * (size_t)bands * sizeof *c->sent);
    c->row = malloc(n * sizeof *c->row);
    c->area = malloc((size_t)h->face_count * sizeof *c->area);
    if (!c->beams || !c->first || !c->arrives || !c->row || !c->area || !c->normal || !c->sent) {
        cluster_light_close(c);
        return -1;
    }
    for (e = 0; e < h->count; e++) {
        c->first[e] = c->count;
        for (i = r->first_link[e]; i < r->first_link[e + 1]; i++)
            if (is_beam(h, &r->links[i]))
                c->beams[c->count++] = beam(h, &r->links[i]);
    }
    c->first[h->count] = c->count;
    for (e = 0; e < h->face_count; e++) {
        const struct element *x = &h->elements[h->face_element[h->order[e]]];
        c->area[e] = INVERSE_PI * x->area;
        for (k = 0; k < 3; k++)
            c->normal[3 * (size_t)e + (size_t)k] = x->normal[k];
    }
#pragma omp parallel for schedule(dynamic, 256) num_threads(threads)
    for (i = 0; i < c->count; i++)
        bring(c, &c->beams[i], 1, NULL, &c->row[i]);
    return 0;
}

void cluster_light_send(const struct cluster_light *c, int bands, const double *radiosity)
{
    const struct hierarchy *h = c->hierarchy;
    size_t n = (size_t)bands, i;
    if (c->count == 0)
        return;
    for (i = 0; i < h->face_count; i++) {
        uint32_t e = h->face_element[h->order[i]];
        size_t k;
        for (k = 0; k < n; k++)
            c->sent[i * n + k] = INVERSE_PI * h->elements[e].area * radiosity[e * n + k];
    }
#pragma omp parallel for schedule(dynamic, 256) num_threads(c->threads)
    for (i = 0; i < c->count; i++)
        bring(c, &c->beams[i], n, radiosity, &c->arrives[i * n]);
}

/* The beams of element e, on a surface with normal n. */
static void add(const struct cluster_light *c, size_t bands, const double *arrives, uint32_t e, const double n[3], double *h)
{
    size_t i, k;
    for (i = c->first[e]; i < c->first[e + 1]; i++) {
        const struct cluster_beam *b = &c->beams[i];
        double cosine = n[0] * b->towards[0] + n[1] * b->towards[1] + n[2] * b->towards[2];
        for (k = 0; k < bands && cosine > 0; k++)
            h[k] += arrives[i * bands + k] * cosine;
    }
}

static void add_all(const struct cluster_light *c, size_t bands, const double *arrives, uint32_t e, double *h)
{
    const struct element *elements = c->hierarchy->elements, *x = &elements[e];
    if (c->count == 0 || e >= c->elements)
        return;
    add(c, bands, arrives, e, x->normal, h);
    if (x->depth > 0)
        return;
    while (e != 0) {
        e = elements[e].parent;
        add(c, bands, arrives, e, x->normal, h);
    }
}

void cluster_light_gather(const struct cluster_light *c, int bands, uint32_t e, double *h)
{
    add_all(c, (size_t)bands, c->arrives, e, h);
}

double cluster_light_row(const struct cluster_light *c, uint32_t e)
{
    double row = 0;
    add_all(c, 1, c->row, e, &row);
    return row;
}

void cluster_light_close(struct cluster_light *c)
{
    free(c->beams);
    free(c->first);
    free(c->arrives);
    free(c->row);
    free(c->area);
    free(c->normal);
    free(c->sent);
    memset(c, 0, sizeof *c);
}
