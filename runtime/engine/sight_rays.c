/* sight_rays.c - see sight_rays.h.
 *
 * Between points that are spread evenly over two faces most of the exchange may pass on very few
 * rays: a small face that stands on a large one sends nearly all to what lies around its foot. So
 * points are spread over the smaller face alone, and rays over the directions in which it sees the
 * other one: each carries the cosine on the smaller face, times the solid angle. Where that is
 * small, all points of the larger face are equally near, and stand for directions; what a spherical
 * triangle is, rounding would decide there.
 *
 * Invariant: the mean of the weights is what is exchanged with nothing between, over the smaller
 * face's area. [spherical triangles: Arvo 1995; solid angles: van Oosterom & Strackee 1983]
 * SPDX-License-Identifier: MIT */
#include "engine/sight_rays.h"
#include "kernel/hash.h"
#include "kernel/samples.h"

_Static_assert(SEGMENTS_MAX == 64, "a word has a bit for each");

/* radii of the larger face: farther off, points on it stand for directions; chosen */
static const double FAR = 4;

/* The larger face as a point sees it: a fan of spherical triangles. */
struct view {
    int parts;
    double corner[POLYGON_MAX][3]; /* directions */
    double until[SAMPLER_PARTS];   /* running sums of solid angles (sr) */
};

static void set_length(double v[3])
{
    const double size = length3(v);
    for (int k = 0; k < 3; k++)
        v[k] = size > 0 ? v[k] / size : 0;
}

/* Returns the solid angle (sr). */
static double view_from(struct view *view, const struct polygon *p, const double x[3])
{
    double all = 0;
    view->parts = p->n - 2;
    for (int i = 0; i < p->n; i++) {
        sub3(view->corner[i], p->v[i], x);
        set_length(view->corner[i]);
    }
    const double *a = view->corner[0];
    for (int i = 0; i < view->parts; i++) {
        const double *b = view->corner[i + 1], *c = view->corner[i + 2];
        double across[3];
        cross3(across, b, c);
        all += 2 * fabs(atan2(dot3(a, across), 1 + dot3(a, b) + dot3(b, c) + dot3(c, a)));
        view->until[i] = all;
    }
    return all;
}

/* What of v is at right angles to the unit vector n, made one. */
static void upright(const double v[3], const double n[3], double out[3])
{
    const double along = dot3(v, n);
    for (int k = 0; k < 3; k++)
        out[k] = v[k] - along * n[k];
    set_length(out);
}

/* cos n + sin m, of a unit vector at right angles. */
static void turn(const double n[3], const double m[3], double cosine, double out[3])
{
    const double c = fmin(fmax(cosine, -1), 1), s = sqrt(1 - c * c);
    for (int k = 0; k < 3; k++)
        out[k] = c * n[k] + s * m[k];
}

/* A direction within the view, evenly spread as u and v are in [0, 1). */
static void direction(const struct view *view, double u, double v, double out[3])
{
    int part = 0;
    const double at = u * view->until[view->parts - 1];
    while (part < view->parts - 1 && at >= view->until[part])
        part++;
    const double before = part > 0 ? view->until[part - 1] : 0, *a = view->corner[0],
                 *b = view->corner[part + 1], *c = view->corner[part + 2];
    double to_b[3], to_c[3], end[3], other[3];
    upright(b, a, to_b);
    upright(c, a, to_c);
    const double cos_a = fmin(fmax(dot3(to_b, to_c), -1), 1), sin_a = sqrt(1 - cos_a * cos_a),
                 cos_c = dot3(a, b), angle = at - before - acos(cos_a), s = sin(angle),
                 t = cos(angle), p = t - cos_a, q = s + sin_a * cos_c;
    turn(a, to_c, ((q * t - p * s) * cos_a - q) / ((q * s + p * t) * sin_a), end);
    upright(end, b, other);
    turn(b, other, 1 - v * (1 - dot3(end, b)), out);
}

/* Sends ray i from its point on the smaller face into the view of the larger one, rather than to
 * the point that it has there. */
static void send(struct samples *x, int i, const struct samples_ends *ends)
{
    const struct polygon *larger = &ends->q.p;
    const double *n = ends->n, *m = ends->m;
    struct view view;
    double from[3], way[3];
    for (int k = 0; k < 3; k++)
        from[k] = x->from[k][i] - ends->ray_offset * n[k];
    const double angle = view_from(&view, larger, from);
    direction(&view, sobol_unit(x->digit[2][i]), sobol_unit(x->digit[3][i]), way);
    const double height = height3(from, larger->v[0], m), towards = -dot3(way, m),
                 cosine = dot3(way, n);
    x->weight[i] = height > 0 && towards > 0 && cosine > 0 ? angle * cosine / LAMBERT_PI : 0;
    for (int k = 0; k < 3 && x->weight[i] > 0; k++)
        x->to[k][i] = from[k] + height / towards * way[k] + ends->ray_offset * m[k];
}

/* What rays carry, and what of that arrives: sums of weights and of their squares. */
struct arrived {
    double all, seen, square_all, square_seen;
};

static void cast(struct arrived *a, const struct host *host, const struct samples *x, int count)
{
    struct segment segments[SEGMENTS_MAX];
    samples_segments(x, count, segments);
    const uint64_t blocked = host->occluded(host, count, segments);
    for (int i = 0; i < count; i++) {
        const double w = x->weight[i], seen = blocked >> i & 1 ? 0 : w;
        a->all += w;
        a->seen += seen;
        a->square_all += w * w;
        a->square_seen += seen * w;
    }
}

double sight_rays(const struct element *r, const struct element *s, const struct host *host,
                  int rays, double *error)
{
    const int first = r->area < s->area || (r->area == s->area && r->id < s->id);
    const struct element *small = first ? r : s, *large = first ? s : r;
    struct samples_ends ends = {
        .n = small->normal, .m = large->normal, .ray_offset = host->ray_offset};
    struct arrived a = {0};
    struct samples x;
    struct sobol net;
    *error = 0;
    sampler_clip(&ends.p, small, large);
    sampler_clip(&ends.q, large, small);
    if (ends.p.p.n == 0 || ends.q.p.n == 0)
        return 0;
    const double far = FAR * large->radius, area = polygon_area(&ends.q.p, large->normal);
    sobol_start(&net, hash64(small->id + hash64(large->id)));
    for (int at = 0; at < rays; at += SEGMENTS_MAX) {
        const int count = rays - at < SEGMENTS_MAX ? rays - at : SEGMENTS_MAX;
        sobol_points(&net, at, count, x.digit);
        samples_make(&x, &ends, count);
        for (int i = 0; i < count; i++) {
            const double away[3] = {x.from[0][i] - large->centre[0],
                                    x.from[1][i] - large->centre[1],
                                    x.from[2][i] - large->centre[2]};
            if (dot3(away, away) > far * far)
                x.weight[i] *= area;
            else
                send(&x, i, &ends);
        }
        cast(&a, host, &x, count);
    }
    if (!(a.all > 0))
        return 0;
    const double v = a.seen / a.all, square = v * v * (a.square_all - a.square_seen)
                                              + (1 - v) * (1 - v) * a.square_seen;
    *error = sqrt(square / (a.all * a.all) + 1.0 / rays / rays); /* one ray might differ */
    return v;
}

double sight_rays_leave(const struct element *r, const struct element *s, const struct host *host,
                        int rays, double clear, double *error)
{
    const double share = sight_rays(r, s, host, rays, error);
    *error *= clear;
    return clear * share;
}
