/* separable_links.c - see separable_links.h. Invariant: what a face gathers is summed in the order
 * of its clusters' links from the root down, then its own; so the result does not depend on
 * threads.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/pivots.h"
#include "engine/separable_links.h"
#include "engine/separable_sums.h"
#include "kernel/lambert.h"
#include "kernel/lanes.h"
#include "util/thread_pool.h"

enum { CHUNK = 64 }; /* faces that one thread takes at a time */

static int is_separable(const struct hierarchy *h, const struct link *l)
{
    return !h->elements[l->receiver].vertices || !h->elements[l->emitter].vertices;
}

static void side_open(const struct separable_links *c, struct separable_side *side, uint32_t e)
{
    const struct hierarchy *h = c->hierarchy;
    if (h->elements[e].depth == 0)
        separable_side_whole(side, &c->faces, h->range[e].from, h->range[e].to);
    else
        separable_side_part(side, &h->elements[e], h->low, c->unit);
}

/* What face i of `faces` takes of the link's J. */
static float taken_by(const struct separable_links *c, const struct separable_faces *faces,
                      size_t i, const struct separable_link *b)
{
    return c->centres ? separable_kernel_at_centre(faces, i, &b->s)
                      : separable_kernel(faces, i, &b->s);
}

static void separate_link(const struct separable_links *c, struct separable_link *b,
                          const struct link *l)
{
    const struct element *elements = c->hierarchy->elements;
    struct separable_side of_r, of_s;
    memset(b, 0, sizeof *b);
    b->emitter = l->emitter;
    side_open(c, &of_r, l->receiver);
    side_open(c, &of_s, l->emitter);
    float passes =
        find_pivots(&b->r, &b->s, &elements[l->receiver], &elements[l->emitter], &of_r, &of_s);
    if (passes > 0)
        b->scale =
            (float)(l->visibility * (1.0 / LINK_VISIBLE) * (1 / LAMBERT_PI) / (double)passes);
    if (elements[l->emitter].depth > 0)
        b->sends = of_s.faces.area[0] * separable_kernel(&of_s.faces, 0, &b->r);
    if (elements[l->receiver].depth > 0)
        b->takes = taken_by(c, &of_r.faces, 0, b);
}

/* J of the link in each band; of a radiosity of 1 when there is none. */
static void send_link(const struct separable_links *c, const struct separable_link *b, int bands,
                      const double *radiosity, float *to)
{
    struct separable_side side;
    float sum[3] = {0, 0, 0};
    if (c->hierarchy->elements[b->emitter].depth > 0) {
        for (int k = 0; k < bands; k++)
            to[k] = b->scale
                    * ((float)(radiosity ? radiosity[(size_t)b->emitter * (size_t)bands + (size_t)k]
                                         : 1)
                       * b->sends);
        return;
    }
    side_open(c, &side, b->emitter);
    const float *const sent[3] = {radiosity ? side.faces.sent[0] : side.faces.area,
                                  side.faces.sent[1], side.faces.sent[2]};
    separable_sum_sent(&(struct separable_sum){.faces = &side.faces,
                                               .pivot = &b->r,
                                               .from = side.from,
                                               .to = side.to,
                                               .bands = bands,
                                               .width = c->width},
                       sent, sum);
    for (int k = 0; k < bands; k++)
        to[k] = b->scale * sum[k];
}

/* Add to `received` what the links of e and of the elements below bring to the faces from .. to
 * - 1. */
static void receive_below(const struct separable_links *c, int bands, uint32_t e, size_t from,
                          size_t to)
{
    const struct hierarchy *h = c->hierarchy;
    const struct element *x = &h->elements[e];
    size_t count = h->face_count;
    from = from > h->range[e].from ? from : h->range[e].from;
    to = to < h->range[e].to ? to : h->range[e].to;
    if (from >= to)
        return;
    for (size_t b = c->first[e]; b < c->first[e + 1]; b++) {
        const struct separable_link *link = &c->links[b];
        const float *arrives = &c->arrives[b * (size_t)bands];
        separable_sum_received(&(struct separable_sum){.faces = &c->faces,
                                                       .pivot = &link->s,
                                                       .from = from,
                                                       .to = to,
                                                       .bands = bands,
                                                       .width = c->width,
                                                       .centres = c->centres},
                               arrives, c->received, count);
    }
    for (int k = 0; k < x->children && !x->vertices; k++)
        receive_below(c, bands, x->child + (uint32_t)k, from, to);
}

/* What all links bring and take while radiosities are as they are. */
struct exchanged {
    const struct separable_links *links;
    int bands;
    const double *radiosity; /* [element * bands + band]; NULL: 1 everywhere */
};

static void receive_faces(const void *exchanged, size_t from, size_t to)
{
    const struct exchanged *x = exchanged;
    const struct separable_links *c = x->links;
    from += c->here.from;
    to += c->here.from;
    for (int k = 0; k < x->bands; k++)
        memset(&c->received[(size_t)k * c->hierarchy->face_count + from], 0,
               (to - from) * sizeof *c->received);
    receive_below(c, x->bands, 0, from, to);
}

static void receive_all(const struct exchanged *x)
{
    const struct face_range here = x->links->here;
    thread_pool_run(x->links->threads, here.to - here.from, CHUNK, receive_faces, x);
}

/* A power of two that is at least the scene's extent. */
static double unit_of(const struct hierarchy *h)
{
    double extent = 0;
    for (int k = 0; k < 3; k++)
        extent = h->high[k] - h->low[k] > extent ? h->high[k] - h->low[k] : extent;
    int exponent;
    frexp(extent, &exponent);
    return ldexp(1, exponent);
}

static void place_faces(const void *links, size_t from, size_t to)
{
    const struct separable_links *c = links;
    const struct hierarchy *h = c->hierarchy;
    for (size_t i = from; i < to; i++) {
        c->place[h->order[i]] = (uint32_t)i;
        c->taken[h->order[i]] = 1;
        separable_faces_set(&c->faces, i, hierarchy_surface(h, h->order[i]), h->low, c->unit);
    }
}

/* Where separable links come from. */
struct separating {
    const struct separable_links *links;
    const struct refinement *r;
};

/* How many each element receives over, into the place behind its own. */
static void count_links(const void *separating, size_t begin, size_t end)
{
    const struct separable_links *c = ((const struct separating *)separating)->links;
    const struct refinement *r = ((const struct separating *)separating)->r;
    for (size_t e = begin; e < end; e++) {
        c->first[e + 1] = 0;
        for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++)
            c->first[e + 1] += (size_t)is_separable(c->hierarchy, &r->links[i]);
    }
}

static void separate_links(const void *separating, size_t begin, size_t end)
{
    const struct separable_links *c = ((const struct separating *)separating)->links;
    const struct refinement *r = ((const struct separating *)separating)->r;
    for (size_t e = begin; e < end; e++) {
        size_t at = c->first[e];
        for (size_t from = r->first_link[e]; from < r->first_link[e + 1]; from++)
            if (is_separable(c->hierarchy, &r->links[from])) {
                separate_link(c, &c->links[at], &r->links[from]);
                send_link(c, &c->links[at], 1, NULL, &c->arrives[at]);
                at++;
            }
    }
}

int separable_links_open(struct separable_links *c, const struct hierarchy *h,
                         const struct refinement *r, int bands, int threads, int centres,
                         struct face_range here)
{
    const struct separating s = {c, r};
    size_t n, faces = h->face_count;
    memset(c, 0, sizeof *c);
    c->hierarchy = h;
    c->threads = threads;
    c->centres = centres;
    c->here = here;
    c->width = lanes_width();
    c->unit = unit_of(h);
    c->elements = h->count;
    c->first = calloc((size_t)h->count + 1, sizeof *c->first);
    if (!c->first)
        return -1;
    thread_pool_run(threads, h->count, 1024, count_links, &s);
    for (uint32_t e = 0; e < h->count; e++)
        c->first[e + 1] += c->first[e];
    c->count = n = c->first[h->count];
    if (n == 0) {
        separable_links_close(c);
        c->hierarchy = h;
        return 0;
    }
    c->links = malloc(n * sizeof *c->links);
    c->arrives = malloc(n * (size_t)bands * sizeof *c->arrives);
    c->received = malloc(faces * (size_t)bands * sizeof *c->received);
    c->place = malloc(faces * sizeof *c->place);
    c->taken = malloc(faces * sizeof *c->taken);
    c->faces.centre[0] =
        calloc((SEPARABLE_ARRAYS + (size_t)bands) * faces + SEPARABLE_SPARE, sizeof(float));
    if (!c->links || !c->arrives || !c->received || !c->place || !c->taken || !c->faces.centre[0]) {
        separable_links_close(c);
        return -1;
    }
    separable_faces_arrays(&c->faces, c->faces.centre[0], faces, bands);
    thread_pool_run(threads, faces, 256, place_faces, c);
    thread_pool_run(threads, h->count, 256, separate_links, &s);
    receive_all(&(struct exchanged){c, 1, NULL});
    return 0;
}

static void send_faces(const void *exchanged, size_t from, size_t to)
{
    const struct exchanged *x = exchanged;
    const struct hierarchy *h = x->links->hierarchy;
    const struct separable_faces *faces = &x->links->faces;
    for (size_t i = from; i < to; i++) {
        const double *radiosity =
            &x->radiosity[(size_t)h->face_element[h->order[i]] * (size_t)x->bands];
        for (int k = 0; k < x->bands; k++)
            faces->sent[k][i] = faces->area[i] * (float)radiosity[k];
    }
}

static void send_links(const void *exchanged, size_t from, size_t to)
{
    const struct exchanged *x = exchanged;
    const struct separable_links *c = x->links;
    for (size_t i = from; i < to; i++)
        send_link(c, &c->links[i], x->bands, x->radiosity, &c->arrives[i * (size_t)x->bands]);
}

void separable_links_send(const struct separable_links *c, int bands, const double *radiosity)
{
    const struct exchanged x = {c, bands, radiosity};
    if (c->count == 0)
        return;
    thread_pool_run(c->threads, c->hierarchy->face_count, 1024, send_faces, &x);
    thread_pool_run(c->threads, c->count, 256, send_links, &x);
    receive_all(&x);
}

void separable_links_gather(const struct separable_links *c, int bands, uint32_t e, double *h)
{
    const struct element *x = &c->hierarchy->elements[e];
    size_t count = (size_t)bands;
    if (c->count == 0 || e >= c->elements)
        return;
    const double taken = (double)c->taken[x->face];
    if (x->depth == 0) {
        for (size_t k = 0; k < count; k++)
            h[k] += taken * (double)c->received[k * c->hierarchy->face_count + c->place[x->face]];
        return;
    }
    for (size_t b = c->first[e]; b < c->first[e + 1]; b++)
        for (size_t k = 0; k < count; k++)
            h[k] += taken * (double)c->arrives[b * count + k] * (double)c->links[b].takes;
}

double separable_links_row(const struct separable_links *c, uint32_t e)
{
    double row = 0;
    separable_links_gather(c, 1, e, &row);
    return row;
}

void separable_links_weaken(const struct separable_links *c, uint32_t face, double share)
{
    if (c->count > 0)
        c->taken[face] = (float)share;
}

double separable_links_sends(const struct separable_links *c, size_t b, uint32_t e)
{
    const struct element *x = &c->hierarchy->elements[e];
    const struct separable_link *link = &c->links[b];
    if (x->depth == 0) {
        size_t i = c->place[x->face];
        return (double)(link->scale * c->faces.area[i] * separable_kernel(&c->faces, i, &link->r));
    }
    struct separable_side side;
    side_open(c, &side, e);
    return (double)(link->scale * side.faces.area[0] * separable_kernel(&side.faces, 0, &link->r));
}

double separable_links_takes(const struct separable_links *c, size_t b, uint32_t e)
{
    const struct element *x = &c->hierarchy->elements[e];
    const double taken = (double)c->taken[x->face];
    if (x->depth == 0)
        return taken * (double)taken_by(c, &c->faces, c->place[x->face], &c->links[b]);
    struct separable_side side;
    side_open(c, &side, e);
    return taken * (double)taken_by(c, &side.faces, 0, &c->links[b]);
}

double separable_links_at(const struct separable_links *c, const struct separable_link *b,
                          const double x[3], const double n[3])
{
    double v[3], near = 0, far = (double)b->s.shift;
    for (int k = 0; k < 3; k++) {
        v[k] = (double)b->s.centre[k] - (x[k] - c->hierarchy->low[k]) / c->unit;
        near += n[k] * v[k];
        far -= (double)b->s.normal[k] * v[k];
    }
    double square = dot3(v, v);
    return near > 0 && far > 0 ? near * far / (square * square) : 0;
}

void separable_links_close(struct separable_links *c)
{
    free(c->links);
    free(c->first);
    free(c->arrives);
    free(c->received);
    free(c->place);
    free(c->taken);
    free(c->faces.centre[0]);
    memset(c, 0, sizeof *c);
}
