/* cluster_light.c - see cluster_light.h. Invariant: what a face gathers is summed in the order of its clusters' beams from the
 * root down, then its own; so the result does not depend on threads.
 *
 * The two ends of a beam are found in three steps. First the flatter side is the mean of its faces that may turn to the other's centre;
 * then the other is the mean of its faces by what passes between them and that first end; then the flatter side is found anew,
 * likewise. So k(r, s) is not small where what passes is not, though half of a side may lie behind the other's plane.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "cluster_light.h"

#define INVERSE_PI 0.31830988618379067154
#define TINY 1e-15f  /* against division by 0; lengths are at most 1 here */
#define LEAST 1e-30f /* what is less is nothing: 1 over it is still a float */

enum { CHUNK = 64, /* faces that one thread takes at a time */
       ARRAYS = 14 /* of struct cluster_faces, besides what the bands have */ };

static int is_beam(const struct hierarchy *h, const struct link *l)
{
    return !h->elements[l->receiver].vertices || !h->elements[l->emitter].vertices;
}

static void faces_arrays(struct cluster_faces *f, float *at, size_t count, int bands)
{
    int k;
    for (k = 0; k < 3; k++) {
        f->centre[k] = at + (size_t)k * count;
        f->normal[k] = at + (size_t)(3 + k) * count;
        f->sent[k] = at + (size_t)(ARRAYS + (k < bands ? k : 0)) * count;
    }
    for (k = 0; k < 6; k++)
        f->across[k] = at + (size_t)(6 + k) * count;
    f->area = at + 12 * count;
    f->bright = at + 13 * count;
}

static void faces_set(const struct cluster_light *c, struct cluster_faces *f, size_t i, const struct element *e)
{
    double along[3], other[3], square[3] = { 0, 0, 0 }, inverse = 1 / c->unit, p, q, r;
    int k, v;
    sub3(along, e->vertex[1], e->vertex[0]);
    p = length3(along);
    for (k = 0; k < 3; k++)
        along[k] /= p;
    cross3(other, e->normal, along);
    for (v = 0; v < e->vertices; v++) { /* a twelfth of the corners' sum is exact for triangles and parallelograms */
        double w[3], x, y;
        sub3(w, e->vertex[v], e->centre);
        x = dot3(w, along) * inverse;
        y = dot3(w, other) * inverse;
        square[0] += x * x / 12;
        square[1] += x * y / 12;
        square[2] += y * y / 12;
    }
    p = sqrt(square[0]);
    q = square[1] / p;
    r = square[2] - q * q;
    r = r > 0 ? sqrt(r) : 0;
    for (k = 0; k < 3; k++) {
        f->centre[k][i] = (float)((e->centre[k] - c->hierarchy->low[k]) * inverse);
        f->normal[k][i] = (float)e->normal[k];
        f->across[k][i] = (float)(p * along[k] + q * other[k]);
        f->across[3 + k][i] = (float)(r * other[k]);
    }
    f->area[i] = (float)(e->area * inverse * inverse);
    f->bright[i] = f->area[i] * (float)e->radiosity;
}

/* The faces of one end of a link. */
struct side {
    struct cluster_faces faces;
    size_t from, to;
    float part[ARRAYS + 3]; /* room for the only one, when it is a part of a face */
};

static void side_open(const struct cluster_light *c, struct side *side, uint32_t e)
{
    const struct element *x = &c->hierarchy->elements[e];
    if (x->depth == 0) {
        side->faces = c->faces;
        side->from = c->hierarchy->range[e].from;
        side->to = c->hierarchy->range[e].to;
        return;
    }
    faces_arrays(&side->faces, side->part, 1, 3);
    faces_set(c, &side->faces, 0, x);
    side->from = 0;
    side->to = 1;
}

/* max(0, x), without a branch and inlined always: so loops over faces run several at a time. */
TOOL float positive(float x)
{
    return 0.5f * (x + fabsf(x));
}

/* k(x, s) pi for face i, times unit^2; the mean over the face to second order in its size. */
TOOL float kernel(const struct cluster_faces *f, size_t i, const struct cluster_end *s)
{
    const float *n = s->normal;
    float v[3] = { s->centre[0] - f->centre[0][i], s->centre[1] - f->centre[1][i], s->centre[2] - f->centre[2][i] };
    float near = positive(f->normal[0][i] * v[0] + f->normal[1][i] * v[1] + f->normal[2][i] * v[2]);
    float far = positive(s->shift - (n[0] * v[0] + n[1] * v[1] + n[2] * v[2]));
    float inverse = 1 / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + TINY);
    float p[3] = { f->across[0][i], f->across[1][i], f->across[2][i] }, q[3] = { f->across[3][i], f->across[4][i], f->across[5][i] };
    float pv = p[0] * v[0] + p[1] * v[1] + p[2] * v[2], qv = q[0] * v[0] + q[1] * v[1] + q[2] * v[2];
    float pn = p[0] * n[0] + p[1] * n[1] + p[2] * n[2], qn = q[0] * n[0] + q[1] * n[1] + q[2] * n[2];
    float size = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
    float more = inverse * (12 * inverse * (pv * pv + qv * qv) - 2 * size + 4 * (pn * pv + qn * qv) / (far + TINY));
    return near * far * inverse * inverse * (1 / (1 + positive(-more)) + positive(more)); /* 1 + more, but never below 0 */
}

/* Set *end from the sums of weights, of weighted centres, of weighted normals, and of normals . centres. Returns the sum of
 * weights, 0 where there is no end. */
static float mean_end(struct cluster_end *end, const float sum[8])
{
    float inverse = sum[0] > LEAST ? 1 / sum[0] : 0, length = sqrtf(sum[4] * sum[4] + sum[5] * sum[5] + sum[6] * sum[6]);
    int k;
    end->shift = 0;
    for (k = 0; k < 3; k++) {
        end->centre[k] = sum[1 + k] * inverse;
        end->normal[k] = length > 0 ? sum[4 + k] / length : 0;
        end->shift += end->normal[k] * end->centre[k];
    }
    end->shift -= length > 0 ? sum[7] / length : 0;
    return length > 0 && sum[0] > LEAST ? sum[0] : 0;
}

/* The first end: faces count by weight (max(0, n . u + slope)). */
static float first_end(struct cluster_end *end, const struct side *side, const float *weight, const float towards[3], float slope)
{
    const struct cluster_faces f = side->faces;
    const float u[3] = { towards[0], towards[1], towards[2] };
    float all = 0, x = 0, y = 0, z = 0, nx = 0, ny = 0, nz = 0, plane = 0;
    size_t i;
#pragma omp simd reduction(+ : all, x, y, z, nx, ny, nz, plane)
    for (i = side->from; i < side->to; i++) {
        float w = f.normal[0][i] * u[0] + f.normal[1][i] * u[1] + f.normal[2][i] * u[2] + slope;
        w = positive(w) * weight[i];
        all += w;
        x += w * f.centre[0][i];
        y += w * f.centre[1][i];
        z += w * f.centre[2][i];
        nx += w * f.normal[0][i];
        ny += w * f.normal[1][i];
        nz += w * f.normal[2][i];
        plane += w * (f.normal[0][i] * f.centre[0][i] + f.normal[1][i] * f.centre[1][i] + f.normal[2][i] * f.centre[2][i]);
    }
    return mean_end(end, (const float[8]){ all, x, y, z, nx, ny, nz, plane });
}

/* The other ends: by weight k(x, other), normals by k / (n . v); `plain`: the other's normal is not to be relied on. */
static float second_end(struct cluster_end *end, const struct side *side, const float *weight, const struct cluster_end *other, int plain)
{
    const struct cluster_faces f = side->faces;
    const struct cluster_end o = *other;
    const float turned = plain ? 0 : 1, round = plain ? 1 : 0;
    float all = 0, x = 0, y = 0, z = 0, nx = 0, ny = 0, nz = 0, plane = 0;
    size_t i;
#pragma omp simd reduction(+ : all, x, y, z, nx, ny, nz, plane)
    for (i = side->from; i < side->to; i++) {
        float v[3] = { o.centre[0] - f.centre[0][i], o.centre[1] - f.centre[1][i], o.centre[2] - f.centre[2][i] };
        float near = f.normal[0][i] * v[0] + f.normal[1][i] * v[1] + f.normal[2][i] * v[2];
        float far = o.shift - (o.normal[0] * v[0] + o.normal[1] * v[1] + o.normal[2] * v[2]);
        float square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2], inverse = 1 / (square + TINY), n, w;
        far = turned * positive(far) + round * square;
        w = weight[i] * far * inverse * inverse * positive(near);
        n = w / (fabsf(near) + TINY);
        all += w;
        x += w * f.centre[0][i];
        y += w * f.centre[1][i];
        z += w * f.centre[2][i];
        nx += n * f.normal[0][i];
        ny += n * f.normal[1][i];
        nz += n * f.normal[2][i];
        plane += n * (f.normal[0][i] * f.centre[0][i] + f.normal[1][i] * f.centre[1][i] + f.normal[2][i] * f.centre[2][i]);
    }
    return mean_end(end, (const float[8]){ all, x, y, z, nx, ny, nz, plane });
}

/* k(r, s) pi unit^2 between two ends. */
static float between(const struct cluster_end *r, const struct cluster_end *s)
{
    float v[3], square, near, far;
    int k;
    for (k = 0; k < 3; k++)
        v[k] = s->centre[k] - r->centre[k];
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    near = r->shift + r->normal[0] * v[0] + r->normal[1] * v[1] + r->normal[2] * v[2];
    far = s->shift - (s->normal[0] * v[0] + s->normal[1] * v[1] + s->normal[2] * v[2]);
    return near > 0 && far > 0 ? near * far / (square * square) : 0;
}

static void beam(const struct cluster_light *c, struct cluster_beam *b, const struct link *l)
{
    const struct element *r = &c->hierarchy->elements[l->receiver], *s = &c->hierarchy->elements[l->emitter];
    struct side of_r, of_s;
    const struct element *flat = r, *round = s;
    double v[3], distance;
    float u[3], slope, passes, turned = 0;
    struct cluster_end first;
    int k, swap = s->vertices || (!r->vertices && s->cone > r->cone);
    memset(b, 0, sizeof *b);
    b->emitter = l->emitter;
    if (swap) {
        flat = s;
        round = r;
    }
    sub3(v, round->centre, flat->centre);
    distance = length3(v);
    for (k = 0; k < 3; k++)
        u[k] = (float)(v[k] / distance);
    slope = (float)((r->radius + s->radius) / distance);
    side_open(c, &of_r, l->receiver);
    side_open(c, &of_s, l->emitter);
    if (swap) {
        if (!(first_end(&first, &of_s, of_s.faces.bright, u, slope) > 0))
            return;
    } else if (!(first_end(&first, &of_r, of_r.faces.area, u, slope) > 0)) {
        return;
    }
    for (k = 0; k < 3; k++)
        turned += first.normal[k] * u[k];
    k = !flat->vertices && turned < 0.3f;
    if (swap ? !(second_end(&b->r, &of_r, of_r.faces.area, &first, k) > 0 && second_end(&b->s, &of_s, of_s.faces.bright, &b->r, 0) > 0)
             : !(second_end(&b->s, &of_s, of_s.faces.bright, &first, k) > 0 && second_end(&b->r, &of_r, of_r.faces.area, &b->s, 0) > 0))
        return;
    passes = between(&b->r, &b->s);
    if (passes > LEAST)
        b->scale = (float)(l->visibility * (1.0 / LINK_VISIBLE) * INVERSE_PI / (double)passes);
}

/* What the beam brings in each band: J. */
static void bring(const struct cluster_light *c, const struct cluster_beam *b, int bands, const double *radiosity, float *to)
{
    struct side side;
    float sum[3] = { 0, 0, 0 };
    size_t i;
    int k;
    side_open(c, &side, b->emitter);
    if (c->hierarchy->elements[b->emitter].depth > 0) {
        float value = side.faces.area[0] * kernel(&side.faces, 0, &b->r);
        for (k = 0; k < bands; k++)
            sum[k] = (float)(radiosity ? radiosity[(size_t)b->emitter * (size_t)bands + (size_t)k] : 1) * value;
    } else if (bands == 1) {
        const float *sent = radiosity ? side.faces.sent[0] : side.faces.area;
        float all = 0;
#pragma omp simd reduction(+ : all)
        for (i = side.from; i < side.to; i++)
            all += sent[i] * kernel(&side.faces, i, &b->r);
        sum[0] = all;
    } else {
        const float *red = side.faces.sent[0], *green = side.faces.sent[1], *blue = side.faces.sent[2];
        float x = 0, y = 0, z = 0;
#pragma omp simd reduction(+ : x, y, z)
        for (i = side.from; i < side.to; i++) {
            float value = kernel(&side.faces, i, &b->r);
            x += red[i] * value;
            y += green[i] * value;
            z += blue[i] * value;
        }
        sum[0] = x;
        sum[1] = y;
        sum[2] = z;
    }
    for (k = 0; k < bands; k++)
        to[k] = b->scale * sum[k];
}

/* Add to `received` what the beams of e and of the elements below bring to the faces from .. to - 1. */
static void receive(const struct cluster_light *c, int bands, uint32_t e, size_t from, size_t to)
{
    const struct hierarchy *h = c->hierarchy;
    const struct element *x = &h->elements[e];
    size_t b, i, count = h->face_count;
    int k;
    from = from > h->range[e].from ? from : h->range[e].from;
    to = to < h->range[e].to ? to : h->range[e].to;
    if (from >= to)
        return;
    for (b = c->first[e]; b < c->first[e + 1]; b++) {
        const struct cluster_beam *beam = &c->beams[b];
        const float *arrives = &c->arrives[b * (size_t)bands];
        float value[CHUNK];
#pragma omp simd
        for (i = from; i < to; i++)
            value[i - from] = kernel(&c->faces, i, &beam->s);
        for (k = 0; k < bands; k++) {
            float *received = &c->received[(size_t)k * count];
#pragma omp simd
            for (i = from; i < to; i++)
                received[i] += arrives[k] * value[i - from];
        }
    }
    for (k = 0; k < x->children && !x->vertices; k++)
        receive(c, bands, x->child + (uint32_t)k, from, to);
}

static void receive_all(const struct cluster_light *c, int bands)
{
    size_t count = c->hierarchy->face_count, i;
#pragma omp parallel for schedule(dynamic, 1) num_threads(c->threads)
    for (i = 0; i < count; i += CHUNK) {
        size_t to = i + CHUNK < count ? i + CHUNK : count;
        int k;
        for (k = 0; k < bands; k++)
            memset(&c->received[(size_t)k * count + i], 0, (to - i) * sizeof *c->received);
        receive(c, bands, 0, i, to);
    }
}

/* A power of two that is at least the scene's extent. */
static double unit_of(const struct hierarchy *h)
{
    double extent = 0;
    int k, exponent;
    for (k = 0; k < 3; k++)
        extent = h->high[k] - h->low[k] > extent ? h->high[k] - h->low[k] : extent;
    frexp(extent, &exponent);
    return ldexp(1, exponent);
}

int cluster_light_open(struct cluster_light *c, const struct hierarchy *h, const struct refinement *r, int bands, int threads)
{
    size_t i, n = 0, faces = h->face_count;
    uint32_t e;
    memset(c, 0, sizeof *c);
    c->hierarchy = h;
    for (i = 0; i < r->link_count; i++)
        n += (size_t)is_beam(h, &r->links[i]);
    if (n == 0)
        return 0;
    c->bands = bands;
    c->threads = threads;
    c->unit = unit_of(h);
    c->elements = h->count;
    c->beams = malloc(n * sizeof *c->beams);
    c->first = malloc(((size_t)h->count + 1) * sizeof *c->first);
    c->arrives = malloc(n * (size_t)bands * sizeof *c->arrives);
    c->received = malloc(faces * (size_t)bands * sizeof *c->received);
    c->place = malloc(faces * sizeof *c->place);
    c->faces.centre[0] = malloc((ARRAYS + (size_t)bands) * faces * sizeof(float));
    if (!c->beams || !c->first || !c->arrives || !c->received || !c->place || !c->faces.centre[0]) {
        cluster_light_close(c);
        return -1;
    }
    faces_arrays(&c->faces, c->faces.centre[0], faces, bands);
    for (e = 0; e < h->count; e++) {
        c->first[e] = c->count;
        for (i = r->first_link[e]; i < r->first_link[e + 1]; i++)
            c->count += (size_t)is_beam(h, &r->links[i]);
    }
    c->first[h->count] = c->count;
    for (i = 0; i < faces; i++) {
        c->place[h->order[i]] = (uint32_t)i;
        faces_set(c, &c->faces, i, &h->elements[h->face_element[h->order[i]]]);
    }
#pragma omp parallel for schedule(dynamic, 256) num_threads(threads)
    for (e = 0; e < h->count; e++) {
        size_t from, at = c->first[e];
        for (from = r->first_link[e]; from < r->first_link[e + 1]; from++)
            if (is_beam(h, &r->links[from])) {
                beam(c, &c->beams[at], &r->links[from]);
                bring(c, &c->beams[at], 1, NULL, &c->arrives[at]);
                at++;
            }
    }
    receive_all(c, 1);
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
                c->faces.sent[k][i] = c->faces.area[i] * (float)radiosity[(size_t)e * (size_t)bands + (size_t)k];
        }
#pragma omp for schedule(dynamic, 256)
        for (i = 0; i < c->count; i++)
            bring(c, &c->beams[i], bands, radiosity, &c->arrives[i * (size_t)bands]);
    }
    receive_all(c, bands);
}

static void add_all(const struct cluster_light *c, size_t bands, uint32_t e, double *h)
{
    const struct element *x = &c->hierarchy->elements[e];
    size_t b, k;
    if (c->count == 0 || e >= c->elements)
        return;
    if (x->depth == 0) {
        for (k = 0; k < bands; k++)
            h[k] += (double)c->received[k * c->hierarchy->face_count + c->place[x->face]];
        return;
    }
    if (c->first[e] < c->first[e + 1]) {
        struct side side;
        side_open(c, &side, e);
        for (b = c->first[e]; b < c->first[e + 1]; b++) {
            double value = (double)kernel(&side.faces, 0, &c->beams[b].s);
            for (k = 0; k < bands; k++)
                h[k] += (double)c->arrives[b * bands + k] * value;
        }
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

double cluster_light_at(const struct cluster_light *c, const struct cluster_beam *b, const double x[3], const double n[3])
{
    double v[3], near = 0, far = (double)b->s.shift, square;
    int k;
    for (k = 0; k < 3; k++) {
        v[k] = (double)b->s.centre[k] - (x[k] - c->hierarchy->low[k]) / c->unit;
        near += n[k] * v[k];
        far -= (double)b->s.normal[k] * v[k];
    }
    square = dot3(v, v);
    return near > 0 && far > 0 ? near * far / (square * square) : 0;
}

void cluster_light_close(struct cluster_light *c)
{
    free(c->beams);
    free(c->first);
    free(c->arrives);
    free(c->received);
    free(c->place);
    free(c->faces.centre[0]);
    memset(c, 0, sizeof *c);
}
