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

/* The intensity of a group towards -w in each band: sums over the faces in `range`, several at a time. */
static void radiate(const struct cluster_light *c, struct face_range range, const float w[3], int bands, float sum[3])
{
    const float *x = c->normal[0], *y = c->normal[1], *z = c->normal[2];
    float wx = w[0], wy = w[1], wz = w[2];
    size_t f;
    int k;
    for (k = 0; k < bands; k++) {
        const float *sent = c->sent[k];
        float all = 0;
#pragma omp simd reduction(+ : all)
        for (f = range.from; f < range.to; f++) {
            float cosine = -(x[f] * wx + y[f] * wy + z[f] * wz);
            all += sent[f] * (cosine > 0 ? cosine : 0);
        }
        sum[k] = all;
    }
}

/* What the beam brings in each band. */
static void bring(const struct cluster_light *c, const struct cluster_beam *b, int bands, const double *radiosity, float *to)
{
    const struct hierarchy *h = c->hierarchy;
    const struct element *s = &h->elements[b->emitter];
    float sum[3] = { 0, 0, 0 };
    int k;
    if (s->vertices) {
        double cosine = -(s->normal[0] * (double)b->towards[0] + s->normal[1] * (double)b->towards[1]
                          + s->normal[2] * (double)b->towards[2]);
        for (k = 0; k < bands && cosine > 0; k++)
            sum[k] = (float)(INVERSE_PI * s->area * (radiosity ? radiosity[(size_t)b->emitter * (size_t)bands + (size_t)k] : 1) * cosine);
    } else {
        radiate(c, h->range[b->emitter], b->towards, bands, sum);
    }
    for (k = 0; k < bands; k++)
        to[k] = b->weight * sum[k];
}

int cluster_light_open(struct cluster_light *c, const struct hierarchy *h, const struct refinement *r, int bands, int threads)
{
    size_t i, n = 0, faces = h->face_count;
    uint32_t e;
    int k;
    memset(c, 0, sizeof *c);
    c->hierarchy = h;
    for (i = 0; i < r->link_count; i++)
        n += (size_t)is_beam(h, &r->links[i]);
    if (n == 0)
        return 0;
    c->bands = bands;
    c->threads = threads;
    c->elements = h->count;
    c->beams = malloc(n * sizeof *c->beams);
    c->first = malloc(((size_t)h->count + 1) * sizeof *c->first);
    c->arrives = malloc(n * (size_t)bands * sizeof *c->arrives);
    c->normal[0] = malloc(3 * faces * sizeof *c->normal[0]);
    c->sent[0] = malloc((size_t)bands * faces * sizeof *c->sent[0]);
    if (!c->beams || !c->first || !c->arrives || !c->normal[0] || !c->sent[0]) {
        cluster_light_close(c);
        return -1;
    }
    for (k = 1; k < 3; k++)
        c->normal[k] = c->normal[0] + (size_t)k * faces;
    for (k = 1; k < bands; k++)
        c->sent[k] = c->sent[0] + (size_t)k * faces;
    for (e = 0; e < h->count; e++) {
        c->first[e] = c->count;
        for (i = r->first_link[e]; i < r->first_link[e + 1]; i++)
            c->count += (size_t)is_beam(h, &r->links[i]);
    }
    c->first[h->count] = c->count;
    for (i = 0; i < faces; i++) {
        const struct element *x = &h->elements[h->face_element[h->order[i]]];
        c->sent[0][i] = (float)(INVERSE_PI * x->area);
        for (k = 0; k < 3; k++)
            c->normal[k][i] = (float)x->normal[k];
    }
#pragma omp parallel for schedule(dynamic, 256) num_threads(threads)
    for (e = 0; e < h->count; e++) {
        size_t from, at = c->first[e];
        for (from = r->first_link[e]; from < r->first_link[e + 1]; from++)
            if (is_beam(h, &r->links[from])) {
                c->beams[at] = beam(h, &r->links[from]);
                bring(c, &c->beams[at], 1, NULL, &c->arrives[at]);
                at++;
            }
    }
    return 0;
}

void cluster_light_send(const struct cluster_light *c, int bands, const double *radiosity)
{
    const struct hierarchy *h = c->hierarchy;
    size_t i;
    if (c->count == 0)
        return;
#pragma omp parallel num_threads(c->threads)
    {
#pragma omp for schedule(static)
        for (i = 0; i < h->face_count; i++) {
            uint32_t e = h->face_element[h->order[i]];
            int k;
            for (k = 0; k < bands; k++)
                c->sent[k][i] = (float)(INVERSE_PI * h->elements[e].area * radiosity[(size_t)e * (size_t)bands + (size_t)k]);
        }
#pragma omp for schedule(dynamic, 256)
        for (i = 0; i < c->count; i++)
            bring(c, &c->beams[i], bands, radiosity, &c->arrives[i * (size_t)bands]);
    }
}

/* The beams of element e, on a surface with normal n. */
static void add(const struct cluster_light *c, size_t bands, uint32_t e, const double n[3], double *h)
{
    size_t i, k;
    for (i = c->first[e]; i < c->first[e + 1]; i++) {
        const struct cluster_beam *b = &c->beams[i];
        double cosine = n[0] * (double)b->towards[0] + n[1] * (double)b->towards[1] + n[2] * (double)b->towards[2];
        for (k = 0; k < bands && cosine > 0; k++)
            h[k] += (double)c->arrives[i * bands + k] * cosine;
    }
}

static void add_all(const struct cluster_light *c, size_t bands, uint32_t e, double *h)
{
    const struct element *elements = c->hierarchy->elements, *x = &elements[e];
    if (c->count == 0 || e >= c->elements)
        return;
    add(c, bands, e, x->normal, h);
    if (x->depth > 0)
        return;
    while (e != 0) {
        e = elements[e].parent;
        add(c, bands, e, x->normal, h);
    }
}

void cluster_light_gather(const struct cluster_light *c, int bands, uint32_t e, double *h)
{
    add_all(c, (size_t)bands, e, h);
}

double cluster_light_row(const struct cluster_light *c, uint32_t e)
{
    double row = 0;
    add_all(c, 1, e, &row);
    return row;
}

void cluster_light_close(struct cluster_light *c)
{
    free(c->beams);
    free(c->first);
    free(c->arrives);
    free(c->normal[0]);
    free(c->sent[0]);
    memset(c, 0, sizeof *c);
}
