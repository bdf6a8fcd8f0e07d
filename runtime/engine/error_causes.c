/* error_causes.c - see error_causes.h: what links bring, held against rays that meet the links' own
 * radiosities.
 *
 * A ray from a point x of leaf r, in a direction by the cosine, meets y on leaf s. Of the truth
 * that the links stand for, K B, it is an estimate without bias,
 *     B(x) - E - rho B(y)
 * being what the solution's equation is short of there: all causes together. The ray is known to
 * come by the link (a, b) that has r in a and s in b: there is one or none (link_cover.h). Let F*
 * be the exact form factor of the pair, h = 1 where the ray came by this link, else 0, and B_b the
 * mean of B over b, which the link sends. Then
 *     F V B_b - h B(y)  =  h (B_b - B(y))          bright spot: visibility goes with radiosity
 *                        + (F - F*) V B_b          kernel
 *                        + F* V B_b - h B_b        visibility
 * each in the mean over the rays of a. With groups B_b is the mean as the link's kernel sees it, J
 * over the J of a radiosity of 1, and the last two are one: F* is not known. No link: -B(y) is
 * lost. What the operator makes of rows, iteration and contact fill up the rest, leaf by leaf: so
 * causes add up to `together` ray for ray, to rounding.
 *
 * A point whose ray meets no front may lie inside a solid (contact_fraction.h): nothing leaves it.
 * A leaf that is taken for covered shows the light that links bring, as tables of faces do, and
 * reflects none; both are contact.
 *
 * Points are spread along a line that all leaves lie on (cause_line.h); sums are made by polygon,
 * and by chunks of polygons in their order: no thread shows.
 *
 * What a difference at x comes to in the power of the whole solution, after all reflections, is
 * 1 + E[rho (1 + E[rho (...)])] times as much, along a path from x: the adjoint, which is the same
 * equation since the kernel is symmetric. One path from each point, independent of what its other
 * rays find, estimates it without bias, of the true surfaces and not of the links. So `together`
 * comes to the solution's error, which tests hold against particles.
 *
 * Fails: a polygon of few rays hides its difference in noise (cause_sums.c). What is wrong within a
 * polygon and cancels over it is not told.
 * [derived here; that residuals carried on make the error: Arvo, Torrance and Smits 1994]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "engine/cause_line.h"
#include "engine/cause_rays.h"
#include "engine/error_causes.h"
#include "engine/push_pull.h"
#include "engine/solve_tracer.h"
#include "kernel/polygon_factor.h"
#include "util/thread_pool.h"

struct causes {
    struct solve *solve;
    struct cause_line line;
    struct cause_rays rays;
    double *gathered;      /* [element * bands + band]: K B of leaves, over whole leaves (W/m2) */
    double *shines;        /* [face * bands + band]: mean B (W/m2) */
    float *of_one;         /* [separable link]: J of a radiosity of 1 */
    _Atomic uint64_t done; /* points, for the watch */
    atomic_int stopped;
};

/* One thread's way through all receivers. */
struct walk {
    struct causes *causes;
    struct link_cover cover;
    struct cause_polygon polygon; /* so far */
    struct cause_sums *sums;
    double passed; /* points, for the watch, that are not yet told of: less than one */
};

/* What the links of a leaf and of all above it bring, all bands (W/m2). */
struct brought {
    double way[RAD_WAYS][3];
    double kernel[RAD_WAYS][3]; /* of it, what would be less were F exact */
};

/* Add what the links of surface e bring. */
static void add_links(const struct causes *c, uint32_t e, struct brought *b)
{
    const struct light_operator *op = &c->solve->operator;
    const struct refinement *r = op->refinement;
    const double *radiosity = c->solve->state.radiosity;
    const struct element *elements = op->hierarchy->elements;
    uint32_t bands = c->rays.tracer.bands;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const struct link *l = &r->links[i];
        if (link_is_separable(op->hierarchy, l) || l->visibility == 0)
            continue;
        double visible = l->visibility * (1.0 / LINK_VISIBLE),
               exact = polygon_factor(&elements[e], &elements[l->emitter], 0),
               off = (operator_factor(op, i) - exact) * visible;
        for (uint32_t k = 0; k < bands; k++) {
            double sent = radiosity[(size_t)l->emitter * bands + k];
            b->way[link_way(l)][k] += operator_weight(op, i) * sent;
            b->kernel[link_way(l)][k] += off * sent;
        }
    }
    separable_links_gather(&op->separable, (int)bands, e, b->way[RAD_WAY_GROUPS]);
}

/* What of it child j of e gets. */
static struct brought brought_to(const struct causes *c, uint32_t j, uint32_t e,
                                 const struct brought *all)
{
    struct brought part = *all;
    double bare = operator_bare(&c->solve->operator, j, e);
    for (int way = 0; way < RAD_WAYS; way++)
        for (int k = 0; k < 3; k++) {
            part.way[way][k] *= bare;
            part.kernel[way][k] *= bare;
        }
    return part;
}

/* ---- one leaf */

/* By cause, what no ray is asked for (W/m2). */
static void set_known(const struct causes *c, const struct cause_receiver *at,
                      const struct brought *b, double known[RAD_CAUSES][3])
{
    uint32_t bands = c->rays.tracer.bands;
    memset(known, 0, RAD_CAUSES * sizeof *known);
    for (uint32_t k = 0; k < bands && at->uncovered > 0; k++) {
        const double rho = at->reflectance[k], open = rho * b->way[RAD_WAY_OPEN][k],
                     half = rho * b->way[RAD_WAY_HALF][k], groups = rho * b->way[RAD_WAY_GROUPS][k];
        const double gathered = rho * c->gathered[(size_t)at->leaf * bands + k];
        known[RAD_CAUSE_OPEN_KERNEL][k] = rho * b->kernel[RAD_WAY_OPEN][k];
        known[RAD_CAUSE_HALF_KERNEL][k] = rho * b->kernel[RAD_WAY_HALF][k];
        known[RAD_CAUSE_OPEN_VISIBILITY][k] = open - known[RAD_CAUSE_OPEN_KERNEL][k];
        known[RAD_CAUSE_HALF_VISIBILITY][k] = half - known[RAD_CAUSE_HALF_KERNEL][k];
        known[RAD_CAUSE_GROUPS_REST][k] = groups;
        known[RAD_CAUSE_ROW_CAP][k] = gathered - (open + half + groups);
        known[RAD_CAUSE_SOLVER][k] = at->uncovered * at->shown[k] - gathered;
    }
}

static void set_receiver(const struct causes *c, struct cause_receiver *at, uint32_t leaf)
{
    const struct solve *s = c->solve;
    uint32_t bands = c->rays.tracer.bands;
    memset(at, 0, sizeof *at);
    at->leaf = leaf;
    at->face = s->hierarchy.elements[leaf].face;
    at->uncovered = s->operator.uncovered[leaf];
    for (uint32_t k = 0; k < bands; k++) {
        size_t of_face = (size_t)at->face * bands + k;
        at->reflectance[k] = s->problem.reflectance[of_face];
        at->shown[k] = s->state.radiosity[(size_t)leaf * bands + k] - s->problem.exitance[of_face];
    }
}

/* The points of one replicate on the leaf, `first` to end - 1. */
static void cast_replicate(struct walk *w, struct cause_receiver *at, double known[RAD_CAUSES][3],
                           int r, uint64_t first, uint64_t end)
{
    const struct causes *c = w->causes;
    const double *irradiance = &c->solve->state.irradiance[(size_t)at->leaf * c->rays.tracer.bands];
    double growth[3] = {0, 0, 0}, weight = at->weight * (double)(end - first);
    for (int cause = 0; cause < CAUSE_SUMS; cause++) {
        for (int k = 0; k < 3; k++)
            at->to[cause][k] = &w->polygon.sum[cause][k][r];
        at->after[cause] = &w->polygon.after[cause][r];
    }
    for (uint64_t i = first; i < end; i++) {
        double u[SOBOL_DIMENSIONS];
        struct dice dice = cause_line_point(&c->line, r, i, u);
        w->sums->traced += cause_rays_cast(&c->rays, &w->cover, at, u, &dice);
        for (uint32_t k = 0; k < c->rays.tracer.bands; k++)
            growth[k] += at->weight * at->growth[k];
    }
    for (uint32_t k = 0; k < c->rays.tracer.bands; k++) {
        for (int cause = 0; cause < RAD_CAUSES; cause++) {
            *at->to[cause][k] += weight * known[cause][k];
            *at->after[cause] += growth[k] * known[cause][k];
        }
        /* what is brought to a leaf that is taken for covered is shown, but not reflected */
        double idle = at->uncovered > 0 ? 0 : weight * at->reflectance[k] * irradiance[k];
        *at->to[CAUSE_ALL][k] += idle;
        *at->to[RAD_CAUSE_CONTACT][k] += idle;
        *at->after[CAUSE_ALL] += idle;
        *at->after[RAD_CAUSE_CONTACT] += idle;
        w->polygon.growth[k] += growth[k];
    }
    w->polygon.weight += weight;
    w->polygon.points += end - first;
}

/* The rays of a leaf that lies from .. to along the line (m2). */
static void cast_leaf(struct walk *w, uint32_t leaf, const struct brought *b, double from,
                      double to)
{
    const struct causes *c = w->causes;
    struct cause_receiver at;
    double known[RAD_CAUSES][3], before = w->polygon.weight;
    set_receiver(c, &at, leaf);
    memcpy(at.growth, w->polygon.last, sizeof at.growth);
    set_known(c, &at, b, known);
    at.weight = c->solve->hierarchy.elements[leaf].area / (to - from);
    at.found = w->sums->rays;
    for (int r = 0; r < REPLICATES; r++)
        cast_replicate(w, &at, known, r, cause_line_before(&c->line, r, from),
                       cause_line_before(&c->line, r, to));
    memcpy(w->polygon.last, at.growth, sizeof at.growth);
    for (uint32_t k = 0; k < c->rays.tracer.bands && at.uncovered > 0; k++)
        for (int way = 0; way < RAD_WAYS; way++)
            w->sums->links[way] +=
                (w->polygon.weight - before) * at.reflectance[k] * b->way[way][k];
}

/* ---- all of them */

/* All rays from surface e and its parts; `above`: what the links above it bring. */
static void walk_surface(struct walk *w, uint32_t e, struct brought above, double from, double to)
{
    const struct causes *c = w->causes;
    const struct element *x = &c->solve->hierarchy.elements[e];
    if (!cause_line_has_points(&c->line, from, to))
        return;
    add_links(c, e, &above);
    link_cover_mark(&w->cover, e, 1);
    double whole = 0, part = 0;
    for (int i = 0; i < x->children; i++)
        whole += cause_line_length(&c->line, x->child + (uint32_t)i);
    for (int i = 0; i < x->children; i++) {
        double begin = from + (to - from) * part / whole;
        part += cause_line_length(&c->line, x->child + (uint32_t)i);
        double end = i + 1 < x->children ? from + (to - from) * part / whole : to;
        walk_surface(w, x->child + (uint32_t)i, brought_to(c, x->child + (uint32_t)i, e, &above),
                     begin, end);
    }
    if (!x->children)
        cast_leaf(w, e, &above, from, to);
    link_cover_mark(&w->cover, e, 0);
}

/* Nonzero: stop. By the thread that called in, the work is told of. Faces of less than a point
 * count by their lengths, too. */
static int watch(struct walk *w, double length)
{
    struct causes *c = w->causes;
    w->passed += REPLICATES * length / c->line.spacing;
    const uint64_t points = (uint64_t)w->passed;
    w->passed -= (double)points;
    const uint64_t done = atomic_fetch_add(&c->done, points) + points;
    if (thread_pool_number() == 0) {
        const struct counting counting = {CAUSE_RAYS * done,
                                          fmin((double)done / (double)c->line.points, 1)};
        c->solve->counting = &counting;
        if (!c->stopped && solve_tell(c->solve, "causes"))
            c->stopped = 1;
        c->solve->counting = NULL;
    }
    return c->stopped;
}

static void walk_chunk(struct walk *w, uint32_t chunk)
{
    static const struct brought nothing;
    struct causes *c = w->causes;
    const struct hierarchy *h = &c->solve->hierarchy;
    const double *until = c->line.until;
    for (uint32_t i = c->line.chunk[chunk]; i < c->line.chunk[chunk + 1]; i++) {
        uint32_t e = h->face_element[i];
        if (cause_line_has_points(&c->line, until[i], until[i + 1])) {
            link_cover_move(&w->cover, h->elements[e].parent);
            walk_surface(w, e, nothing, until[i], until[i + 1]);
        }
        if (i + 1 == h->face_count || h->faces[i + 1].input != h->faces[i].input)
            cause_sums_add(w->sums, &w->polygon, c->rays.tracer.bands);
        if (watch(w, until[i + 1] - until[i]))
            return;
    }
}

/* All chunks; each thread has a walk of its own, and each chunk its sums. */
struct walking {
    struct walk *walks;      /* [thread] */
    struct cause_sums *part; /* [chunk] */
};

static void walk_chunks(const void *walking, size_t from, size_t to)
{
    const struct walking *g = walking;
    struct walk *w = &g->walks[thread_pool_number()];
    for (size_t i = from; i < to && !w->causes->stopped; i++) {
        w->sums = &g->part[i];
        walk_chunk(w, (uint32_t)i);
    }
}

/* Sums of all chunks into *sums. Returns 0, or -1 when out of memory or stopped. */
static int walk_all(struct causes *c, struct cause_sums *sums)
{
    uint32_t chunks = c->line.chunks;
    int threads = c->rays.tracer.threads, open = 0;
    const struct walking g = {calloc((size_t)threads, sizeof *g.walks),
                              calloc((size_t)chunks + 1, sizeof *g.part)};
    int failed = !g.walks || !g.part;
    for (; !failed && open < threads; open += !failed) {
        g.walks[open].causes = c;
        failed = link_cover_open(&g.walks[open].cover, &c->solve->operator) < 0;
        if (failed)
            link_cover_close(&g.walks[open].cover);
    }
    if (!failed)
        thread_pool_run(threads, chunks, 1, walk_chunks, &g);
    for (uint32_t i = 0; i < chunks && !failed; i++)
        cause_sums_join(sums, &g.part[i]);
    while (open-- > 0)
        link_cover_close(&g.walks[open].cover);
    free(g.walks);
    free(g.part);
    return failed || c->stopped ? -1 : 0;
}

/* ---- what it takes */

/* K B into c->gathered, by a sweep of Jacobi's over copies; J of a radiosity of 1 before. Returns 0
 * or -1. */
static int gather_all(struct causes *c)
{
    struct solve *s = c->solve;
    const struct light_operator *op = &s->operator;
    uint32_t bands = s->problem.bands;
    size_t elements = s->hierarchy.count, values = elements * bands;
    double *value = malloc((values + 1) * sizeof *value);
    struct change *change = malloc(s->hierarchy.face_count * sizeof *change);
    c->gathered = malloc((values + 1) * sizeof *c->gathered);
    c->of_one = malloc((op->separable.count + 1) * sizeof *c->of_one);
    int failed = !value || !change || !c->gathered || !c->of_one;
    if (!failed) {
        for (size_t e = 0; e < elements; e++)
            value[e] = 1;
        separable_links_send(&op->separable, 1, value);
        if (op->separable.count)
            memcpy(c->of_one, op->separable.arrives, op->separable.count * sizeof *c->of_one);
        memcpy(value, s->state.radiosity, values * sizeof *value);
        const struct transport x = {.bands = bands,
                                    .value = value,
                                    .irradiance = c->gathered,
                                    .source = s->problem.exitance,
                                    .reflectance = s->problem.reflectance};
        transport_sweep(op, &x, 1, change, NULL);
    }
    free(value);
    free(change);
    return failed ? -1 : 0;
}

/* Where rays go to: to faces by their mean radiosity. Returns 0, or -1 when out of memory. */
static int open_rays(struct causes *c)
{
    const struct solve *s = c->solve;
    size_t bands = s->problem.bands;
    c->shines = malloc(((size_t)s->hierarchy.face_count * bands + 1) * sizeof *c->shines);
    if (!c->shines)
        return -1;
    for (uint32_t i = 0; i < s->hierarchy.face_count; i++)
        memcpy(&c->shines[i * bands], &s->state.radiosity[s->hierarchy.face_element[i] * bands],
               bands * sizeof *c->shines);
    c->rays = (struct cause_rays){.solve = s, .tracer = solve_tracer(s), .of_one = c->of_one};
    c->rays.tracer.exitance = c->shines;
    return tracer_open(&c->rays.tracer);
}

int error_causes_find(struct solve *s, uint64_t rays, uint64_t stream,
                      struct RadCausesReport *report)
{
    struct causes c = {.solve = s};
    struct cause_sums sums = {0};
    *report = (struct RadCausesReport){.rays = 0};
    struct row_report rows;
    int failed = solve_renew_operator(s, &rows) < 0 || gather_all(&c) < 0 || open_rays(&c) < 0
                 || cause_line_open(&c.line, s, stream) < 0;
    if (!failed) {
        report->reflected = c.line.reflected;
        /* a path has 1 / (1 - rho) rays, about */
        double each = CAUSE_RAYS + 1 / fmax(1 - c.line.white, 0.01);
        cause_line_spread(&c.line, (uint64_t)((double)rays / each));
    }
    if (!failed && c.line.spacing > 0) {
        failed = walk_all(&c, &sums) < 0;
        for (int way = 0; way < RAD_WAYS && !(c.line.reflected > 0); way++)
            report->reflected += sums.rays[way] * c.line.spacing / REPLICATES;
        cause_sums_report(&sums, report->reflected / c.line.spacing, report);
    }
    cause_line_close(&c.line);
    tracer_close(&c.rays.tracer);
    free(c.gathered);
    free(c.shines);
    free(c.of_one);
    return failed ? -1 : 0;
}
