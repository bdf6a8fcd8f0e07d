/* factor.c - form factor and visibility for the hand-written releases.
 * SPDX-License-Identifier: MIT */
#include "hand.h"
#include "kernel/plain_math.h"

typedef struct {
    double x, y, z;
} vec;

typedef struct {
    int n;
    vec v[5];
} poly;

static vec load(const double *p)
{
    return (vec){p[0], p[1], p[2]};
}
static vec minus(vec a, vec b)
{
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}
static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static vec lerp(vec a, vec b, double t)
{
    return (vec){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

static vec cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double norm(vec a)
{
    return sqrt(dot(a, a));
}

/* The part of element e in front of the plane of `plane`. */
static void clip(poly *out, const struct element *e, const struct element *plane)
{
    vec on = load(plane->centre), n = load(plane->normal), a = load(e->vertex[e->vertices - 1]);
    double h = dot(n, minus(a, on));
    out->n = 0;
    for (int i = 0; i < e->vertices; i++) {
        vec b = load(e->vertex[i]);
        double g = dot(n, minus(b, on));
        if (((h > 0 && g < 0) || (h < 0 && g > 0)) && out->n < 5)
            out->v[out->n++] = lerp(a, b, h / (h - g));
        if (g >= 0 && out->n < 5)
            out->v[out->n++] = b;
        a = b;
        h = g;
    }
    if (out->n < 3)
        out->n = 0;
}

static double at_point(vec p, vec n, const poly *q)
{
    double sum = 0;
    vec a = minus(q->v[q->n - 1], p);
    for (int i = 0; i < q->n; i++) {
        vec b = minus(q->v[i], p), c = cross(a, b);
        double size = norm(c), angle = plain_angle(size, dot(a, b));
        if (size > 0)
            sum += angle / size * dot(c, n);
        a = b;
    }
    return sum * (-0.5 / 3.14159265358979323846);
}

/* Integral of ln |p - .| along the edge from a, direction u. */
static double along(vec p, vec a, vec u, double length)
{
    vec w = minus(p, a);
    double x = dot(w, u), h = norm(cross(w, u)), y = length - x;
    double far = y * y + h * h, near = x * x + h * h, sum = -length;
    sum += 0.5 * y * plain_log(far);
    sum += 0.5 * x * plain_log(near);
    sum += h * plain_angle(h * length, h * h - x * y);
    return sum;
}

typedef struct {
    vec p, e, a, u;
    double length, tolerance;
} edges;

static double gauss5(const edges *g, double from, double to)
{
    static const double x[5] = {-0.90617984593866399280, -0.53846931010568309104, 0,
                                0.53846931010568309104, 0.90617984593866399280};
    static const double w[5] = {0.23692688505618908751, 0.47862867049936646804,
                                0.56888888888888888889, 0.47862867049936646804,
                                0.23692688505618908751};
    double middle = 0.5 * (from + to), half = 0.5 * (to - from), sum = 0;
    for (int i = 0; i < 5; i++) {
        double s = middle + half * x[i];
        vec p = {g->p.x + s * g->e.x, g->p.y + s * g->e.y, g->p.z + s * g->e.z};
        sum += w[i] * along(p, g->a, g->u, g->length);
    }
    return sum * half;
}

static double adapt(const edges *g, double from, double to, double whole, int depth)
{
    double middle = 0.5 * (from + to), left = gauss5(g, from, middle),
           right = gauss5(g, middle, to);
    if (depth == 0 || fabs(left + right - whole) <= g->tolerance)
        return left + right;
    return adapt(g, from, middle, left, depth - 1) + adapt(g, middle, to, right, depth - 1);
}

/* Twice integrated ln sqrt(u^2 + h^2). */
static double twice_integrated(double u, double h)
{
    u = fabs(u);
    return 0.25 * (u * u - h * h) * plain_log(u * u + h * h) + u * h * plain_angle(u, h)
           - 0.75 * u * u;
}

static double parallel(const edges *g, double size)
{
    vec w = minus(g->p, g->a);
    double x = dot(w, g->u), h = norm(cross(w, g->u)), along = dot(g->e, g->u) > 0 ? size : -size;
    return (twice_integrated(x + along, h) - twice_integrated(x, h)
            - twice_integrated(x + along - g->length, h) + twice_integrated(x - g->length, h))
           / along;
}

/* Cut where the outer edge is nearest to the inner one's ends and to its line. */
static double skew(const edges *g, double size, double sine2)
{
    vec w = minus(g->a, g->p);
    double eu = dot(g->e, g->u), ew = dot(w, g->e), from = 0, sum = 0;
    double cut[4] = {ew / (size * size), (ew + g->length * eu) / (size * size),
                     (ew - eu * dot(w, g->u)) / (size * size * sine2), 1};
    for (int i = 0; i < 4; i++) {
        double to = 1;
        int best = 3;
        for (int k = 0; k < 3; k++) {
            double c = cut[k] > 0 ? cut[k] : 0;
            if (c < to) {
                to = c;
                best = k;
            }
        }
        cut[best] = 1;
        if (to > from)
            sum += adapt(g, from, to, gauss5(g, from, to), 40);
        from = to;
    }
    return sum;
}

static double contour(const poly *p, const poly *q, double area)
{
    double sum = 0;
    for (int i = 0; i < p->n; i++) {
        vec p0 = p->v[i], e = minus(p->v[(i + 1) % p->n], p0);
        double le = norm(e);
        for (int j = 0; j < q->n; j++) {
            vec q0 = q->v[j], f = minus(q->v[(j + 1) % q->n], q0), c = cross(e, f);
            double lf = norm(f), aligned = dot(e, f), sine2 = dot(c, c) / (le * le * lf * lf);
            if (!(fabs(aligned) > 1e-16 * le * lf))
                continue;
            edges g;
            if (le <= lf)
                g = (edges){p0, e, q0, {f.x / lf, f.y / lf, f.z / lf}, lf, 0};
            else
                g = (edges){q0, f, p0, {e.x / le, e.y / le, e.z / le}, le, 0};
            double size = le <= lf ? le : lf;
            g.tolerance = 1e-7 * 6.28318530717958647693 * area * g.length / fabs(aligned);
            if (g.tolerance < 2e-15 * g.length)
                g.tolerance = 2e-15 * g.length;
            sum +=
                aligned / g.length * (sine2 > 1e-26 ? skew(&g, size, sine2) : parallel(&g, size));
        }
    }
    return sum / 6.28318530717958647693;
}

/* Logarithms round alike at every scale when the size is always about one. */
static double contour_at_unit_size(poly *p, poly *q, double radius, double area)
{
    int e;
    frexp(radius, &e);
    double up = ldexp(1, e), down = 1 / up;
    for (int i = 0; i < p->n; i++)
        p->v[i] = (vec){p->v[i].x * down, p->v[i].y * down, p->v[i].z * down};
    for (int i = 0; i < q->n; i++)
        q->v[i] = (vec){q->v[i].x * down, q->v[i].y * down, q->v[i].z * down};
    return contour(p, q, area * down * down) * up * up;
}

/* One orbit of a symmetric triangle rule: three points with barycentric weight w at one corner. */
static double orbit(vec a, vec b, vec c, double w, int points, vec n, const poly *q)
{
    double v = 0.5 * (1 - w), sum = 0;
    vec t[5] = {a, b, c, a, b};
    for (int i = 0; i < points; i++) {
        vec x = {w * t[i].x + v * t[i + 1].x + v * t[i + 2].x,
                 w * t[i].y + v * t[i + 1].y + v * t[i + 2].y,
                 w * t[i].z + v * t[i + 1].z + v * t[i + 2].z};
        sum += at_point(x, n, q);
    }
    return sum;
}

static double over_triangle(vec a, vec b, vec c, vec n, const poly *q, int order)
{
    double twice = dot(cross(minus(b, a), minus(c, a)), n), mean = 0;
    switch (order) {
    case 0:
        mean = orbit(a, b, c, 1 / 3.0, 1, n, q);
        break;
    case 1:
        mean += 1 / 3.0 * orbit(a, b, c, 2 / 3.0, 3, n, q);
        break;
    default:
        mean += 0.10995174365532186764 * orbit(a, b, c, 0.81684757298045851308, 3, n, q);
        mean += 0.22338158967801146570 * orbit(a, b, c, 0.10810301816807022736, 3, n, q);
        break;
    }
    return mean * 0.5 * twice;
}

static double over_quad(const vec v[4], vec n, const poly *q, int order)
{
    static const double x[3][3] = {{0.5},
                                   {0.21132486540518711775, 0.78867513459481288225},
                                   {0.11270166537925831148, 0.5, 0.88729833462074168852}};
    static const double w[3][3] = {{1}, {0.5, 0.5}, {5 / 18.0, 8 / 18.0, 5 / 18.0}};
    double sum = 0;
    for (int i = 0; i <= order; i++) {
        double s = x[order][i];
        vec low = lerp(v[0], v[1], s), high = lerp(v[3], v[2], s), along0 = minus(v[1], v[0]),
            along1 = minus(v[2], v[3]);
        for (int j = 0; j <= order; j++) {
            double t = x[order][j];
            vec ds = {(1 - t) * along0.x + t * along1.x, (1 - t) * along0.y + t * along1.y,
                      (1 - t) * along0.z + t * along1.z};
            double jacobian = dot(cross(ds, minus(high, low)), n);
            sum += w[order][i] * w[order][j] * jacobian * at_point(lerp(low, high, t), n, q);
        }
    }
    return sum;
}

static double over(const poly *p, vec n, const poly *q, int order)
{
    if (p->n == 3)
        return over_triangle(p->v[0], p->v[1], p->v[2], n, q, order);
    double sum = over_quad(p->v, n, q, order);
    if (p->n == 5)
        sum += over_triangle(p->v[0], p->v[3], p->v[4], n, q, order);
    return sum;
}

static double distance_to(vec p, const poly *q, vec normal)
{
    double best = INFINITY;
    int inside = 1;
    for (int i = 0; i < q->n; i++) {
        vec a = q->v[i], e = minus(q->v[(i + 1) % q->n], a), w = minus(p, a);
        if (dot(cross(e, w), normal) >= 0)
            continue;
        inside = 0;
        double ee = dot(e, e), t = ee > 0 ? dot(w, e) / ee : 0;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        w = (vec){w.x - t * e.x, w.y - t * e.y, w.z - t * e.z};
        double d = dot(w, w);
        if (d < best)
            best = d;
    }
    return inside ? fabs(dot(normal, minus(p, q->v[0]))) : sqrt(best);
}

static double highest(const struct element *e, const struct element *plane)
{
    vec on = load(plane->centre), n = load(plane->normal);
    double most = -INFINITY;
    for (int i = 0; i < e->vertices; i++)
        most = fmax(most, dot(n, minus(load(e->vertex[i]), on)));
    return most;
}

/* Coplanar to rounding, or one behind the other. */
static int hidden(const struct element *r, const struct element *s)
{
    vec a = load(r->centre), b = load(s->centre);
    double reach = norm(minus(b, a)) + r->radius + s->radius,
           width = fmin(s->area / s->radius, r->area / r->radius);
    double size =
        reach + (fabs(a.x) + fabs(b.x)) + (fabs(a.y) + fabs(b.y)) + (fabs(a.z) + fabs(b.z));
    double flat = 1 / 562949953421312.0 * size * (1 + reach / width);
    return highest(r, s) <= flat || highest(s, r) <= flat;
}

double hand_form_factor(const struct element *r, const struct element *s)
{
    int r_first = r->radius < s->radius || (r->radius == s->radius && r->id < s->id);
    const struct element *small = r_first ? r : s, *large = r_first ? s : r;
    vec centre = load(small->centre), n = load(small->normal), m = load(large->normal);
    vec away = minus(centre, load(large->centre));
    double distance = norm(away) - large->radius, least = r->area < s->area ? r->area : s->area;
    if (distance > 60 * large->radius) {
        double c = -dot(n, away), k = dot(m, away), square = dot(away, away);
        if (c >= large->radius && k >= small->radius)
            return c * k * s->area / (3.14159265358979323846 * square * square);
    }
    poly p;
    clip(&p, small, large);
    poly q;
    clip(&q, large, small);
    if (p.n == 0 || q.n == 0)
        return 0;
    if (distance < 60 * small->radius)
        distance = distance_to(centre, &q, m);
    double exchange;
    if (distance > 60 * small->radius)
        exchange = over(&p, n, &q, 0);
    else if (distance > 8 * small->radius)
        exchange = over(&p, n, &q, 1);
    else if (distance > 3 * small->radius)
        exchange = over(&p, n, &q, 2);
    else
        exchange = contour_at_unit_size(&p, &q, large->radius, least);
    if (!(exchange > 0 && least > 0) || (exchange < 1e-6 * least && hidden(r, s)))
        return 0;
    return (exchange < least ? exchange : least) / r->area;
}

static uint64_t scramble(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* A polygon prepared for sampling: a parallelogram, or the triangles of its fan. */
typedef struct {
    poly p;
    int flat;
    double area[5], whole;
} sampler;

static void prepare(sampler *f, const struct element *e, const struct element *plane)
{
    vec n = load(e->normal), *v = f->p.v;
    clip(&f->p, e, plane);
    f->flat = 0;
    f->whole = 0;
    if (f->p.n == 4) {
        vec gap = {v[0].x - v[1].x + v[2].x - v[3].x, v[0].y - v[1].y + v[2].y - v[3].y,
                   v[0].z - v[1].z + v[2].z - v[3].z};
        vec size = minus(v[2], v[0]);
        f->flat = dot(gap, gap) <= 1e-12 * dot(size, size);
    }
    for (int i = 2; !f->flat && i < f->p.n; i++) {
        f->area[i] = dot(cross(minus(v[i - 1], v[0]), minus(v[i], v[0])), n);
        f->whole += f->area[i];
    }
}

static vec sample(const sampler *f, double s, double t)
{
    const vec *v = f->p.v;
    int i = 2;
    if (f->flat) {
        vec a = v[0], b = v[1], d = v[3];
        return (vec){a.x + s * (b.x - a.x) + t * (d.x - a.x),
                     a.y + s * (b.y - a.y) + t * (d.y - a.y),
                     a.z + s * (b.z - a.z) + t * (d.z - a.z)};
    }
    s *= f->whole;
    while (i < f->p.n - 1 && s >= f->area[i])
        s -= f->area[i++];
    s = f->area[i] > 0 && s < f->area[i] ? sqrt(s / f->area[i]) : 1;
    vec a = v[0], b = v[i - 1], c = v[i];
    return (vec){a.x + s * (b.x - a.x) + s * t * (c.x - b.x),
                 a.y + s * (b.y - a.y) + s * t * (c.y - b.y),
                 a.z + s * (b.z - a.z) + s * t * (c.z - b.z)};
}

double hand_visibility(const struct element *r, const struct element *s, const struct host *host,
                       int rays)
{
    /* What bit b of the index toggles in each coordinate of the Sobol' point. */
    static const uint32_t toggle[6][4] = {
        {0x80000000, 0x80000000, 0x80000000, 0x80000000},
        {0x40000000, 0xc0000000, 0xc0000000, 0xc0000000},
        {0x20000000, 0xa0000000, 0x60000000, 0x20000000},
        {0x10000000, 0xf0000000, 0x90000000, 0x50000000},
        {0x08000000, 0x88000000, 0xe8000000, 0xf8000000},
        {0x04000000, 0xcc000000, 0x5c000000, 0x74000000},
    };
    if (r->id >= s->id) {
        const struct element *t = r;
        r = s;
        s = t;
    }
    uint64_t h = scramble(r->id + scramble(s->id)), k = scramble(h);
    uint32_t x[4] = {(uint32_t)(h >> 32), (uint32_t)h, (uint32_t)(k >> 32), (uint32_t)k};
    double offset = host->ray_offset, spread = (r->area < s->area ? r->area : s->area) / rays;
    double weight[64], seen = 0, all = 0;
    sampler f;
    prepare(&f, r, s);
    sampler g;
    prepare(&g, s, r);
    if (f.p.n == 0 || g.p.n == 0 || rays < 1)
        return 0;
    struct segment segments[64];
    for (int i = 0; i < rays; i++) {
        if (i > 0) {
            int bit = 0;
            while (!(i >> bit & 1))
                bit++;
            for (int d = 0; d < 4; d++)
                x[d] ^= toggle[bit][d];
        }
        vec a = sample(&f, x[0] * (1 / 4294967296.0), x[1] * (1 / 4294967296.0));
        vec b = sample(&g, x[2] * (1 / 4294967296.0), x[3] * (1 / 4294967296.0));
        vec v = minus(b, a);
        double cos_r = dot(load(r->normal), v), cos_s = -dot(load(s->normal), v),
               square = dot(v, v);
        weight[i] = cos_r > 0 && cos_s > 0
                        ? cos_r * cos_s / (square * (3.14159265358979323846 * square + spread))
                        : 0;
        segments[i] = (struct segment){
            {a.x + offset * r->normal[0], a.y + offset * r->normal[1], a.z + offset * r->normal[2]},
            {b.x + offset * s->normal[0], b.y + offset * s->normal[1],
             b.z + offset * s->normal[2]}};
    }
    uint64_t blocked = host->occluded(host, rays, segments);
    for (int i = 0; i < rays; i++) {
        all += weight[i];
        if ((blocked & (uint64_t)1 << i) == 0)
            seen += weight[i];
    }
    return all > 0 ? seen / all : 0;
}
