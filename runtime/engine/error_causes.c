/* error_causes.c - see error_causes.h: what links bring, held against rays that meet the links' own
 * radiosities.
 *
 * A ray from a point x of leaf r, in a direction by the cosine, meets y on leaf s. Of the truth
 * that the links stand for, K B, it is an estimate without bias,
 *     B(x) - E - rho B(y)
 * being what the solution's equation is short of there: all causes together. The ray is known to
 * come by the link (a, b) that has r in a and s in b: pairs are refined from (root, root) on, so
 * there is one or none. Let F* be the exact form factor of the pair, h = 1 where the ray came by
 * this link, else 0, and B_b the mean of B over b, which the link sends. Then
 *     F V B_b - h B(y)  =  h (B_b - B(y))          bright spot: visibility goes with radiosity
 *                        + (F - F*) V B_b          kernel
 *                        + F* V B_b - h B_b        visibility
 * each in the mean over the rays of a. With groups B_b is the mean as the link's kernel sees it, J
 * over the J of a radiosity of 1, and the last two are one: F* is not known. No link: -B(y) is
 * lost. What the operator makes of rows, iteration and contact fill up the rest, leaf by leaf: so
 * causes add up to `together` ray for ray, to rounding.
 *
 * The links of r and of all above it are marked at their emitters while the tree below a face is
 * walked, each link once; from y the way up to the first mark finds the link.
 *
 * Light of emitters is looked for by points on them, too, and what either ray finds counts by the
 * balance heuristic (paths.h): else chance would find small lamps now and then.
 *
 * Points are spread evenly over a line that all leaves lie along, in REPLICATES sets that are
 * shifted at random; place on the leaf and direction follow a Sobol' sequence along it. Sums are
 * made by polygon, and by chunks of polygons in their order: no thread shows.
 *
 * What a difference at x comes to in the power of the whole solution, after all reflections, is
 * 1 + E[rho (1 + E[rho (...)])] times as much, along a path from x: the adjoint, which is the same
 * equation since the kernel is symmetric. One path from each point, independent of what its other
 * rays find, estimates it without bias, of the true surfaces and not of the links.
 *
 * Fails: a polygon of few rays hides its difference in noise (cause_sums.c). What is wrong within a
 * polygon and cancels over it is not told.
 * [derived here; residuals by rays: Lischinski, Tampieri and Greenberg 1993 hold links against
 * finer ones]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/cause_sums.h"
#include "engine/error_causes.h"
#include "engine/push_pull.h"
#include "engine/solve_tracer.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "kernel/leaf_at.h"
#include "kernel/polygon_factor.h"
#include "kernel/surface_point.h"
#include "particles/sobol_sequence.h"
#include "visibility/contact_fraction.h"

enum { CHUNKS = 1024, RAYS_OF_POINT = 2 /* besides the path */ };

struct causes {
    struct solve *solve;
    const struct light_operator *op;
    struct tracer tracer;
    double *gathered;     /* [element * bands + band]: K B of leaves, over whole leaves (W/m2) */
    double *shines;       /* [face * bands + band]: mean B (W/m2), which rays are sent towards by */
    float *of_one;        /* [separable link]: J of a radiosity of 1 */
    double *until;        /* [faces + 1]: running sums of lengths of faces that reflect (m2) */
    double mean;          /* light that they reflect, all bands (W/m2) */
    uint32_t *chunk_face; /* [CHUNKS + 1]: the first face of each chunk */
    uint32_t chunks;
    double spacing; /* m2 of the line between points of a replicate */
    struct sobol_sequence sobol;
    struct {
        double start; /* of the first point, in spacings */
        uint32_t digits[SOBOL_DIMENSIONS];
    } shift[REPLICATES];
    uint64_t stream;
    uint64_t points, done; /* all replicates; for the watch */
    int stopped;
};

/* Which link of the elements from the leaf up sends light of an element, and of which kind: 0:
 * none; 2 (i + 1): link i, of surfaces; 2 (i + 1) + 1: separable link i. */
typedef size_t covering;

struct walk {
    struct causes *causes;
    covering *cover; /* [elements]: by emitter */
    uint32_t top;    /* the cluster down to which links are in cover */
    struct cause_polygon polygon;
    struct cause_sums *sums;
};

/* What the links of a leaf and of all above it bring, all bands (W/m2). */
struct brought {
    double way[RAD_WAYS][3];
    double kernel[RAD_WAYS][3]; /* of it, what would be less were F exact */
};

static int is_separable(const struct hierarchy *h, const struct link *l)
{
    return !h->elements[l->receiver].vertices || !h->elements[l->emitter].vertices;
}

static enum RadWay way_of(const struct link *l)
{
    return l->visibility == LINK_VISIBLE ? RAD_WAY_OPEN : RAD_WAY_HALF;
}

/* Mark the emitters of the links of e, or unmark them. */
static void mark_links(struct walk *w, uint32_t e, int marked)
{
    const struct light_operator *op = w->causes->op;
    const struct refinement *r = op->refinement;
    size_t group = op->separable.count ? op->separable.first[e] : 0;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const struct link *l = &r->links[i];
        covering found = 2 * (i + 1);
        if (is_separable(op->hierarchy, l))
            found = 2 * (++group) + 1;
        if (l->visibility > 0)
            w->cover[l->emitter] = marked ? found : 0;
    }
}

static covering find_link(const struct walk *w, uint32_t emitter)
{
    const struct element *elements = w->causes->op->hierarchy->elements;
    while (!w->cover[emitter] && emitter != 0)
        emitter = elements[emitter].parent;
    return w->cover[emitter];
}

static int holds(const struct element *elements, uint32_t cluster, uint32_t e)
{
    while (e != cluster && e != 0)
        e = elements[e].parent;
    return e == cluster;
}

/* Have the links marked of a cluster and of all above it, and no others. */
static void move_to(struct walk *w, uint32_t cluster)
{
    const struct element *elements = w->causes->op->hierarchy->elements;
    for (; !holds(elements, w->top, cluster); w->top = elements[w->top].parent)
        mark_links(w, w->top, 0);
    for (uint32_t e = cluster; e != w->top; e = elements[e].parent)
        mark_links(w, e, 1);
    w->top = cluster;
}

/* Add what the links of surface e bring. */
static void add_links(const struct causes *c, uint32_t e, struct brought *b)
{
    const struct light_operator *op = c->op;
    const struct refinement *r = op->refinement;
    const double *radiosity = c->solve->state.radiosity;
    uint32_t bands = c->tracer.bands;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const struct link *l = &r->links[i];
        if (is_separable(op->hierarchy, l) || l->visibility == 0)
            continue;
        const struct element *elements = op->hierarchy->elements;
        double visible = l->visibility * (1.0 / LINK_VISIBLE),
               exact = polygon_factor(&elements[e], &elements[l->emitter], 0),
               off = (operator_factor(op, i) - exact) * visible;
        for (uint32_t k = 0; k < bands; k++) {
            double sent = radiosity[(size_t)l->emitter * bands + k];
            b->way[way_of(l)][k] += operator_weight(op, i) * sent;
            b->kernel[way_of(l)][k] += off * sent;
        }
    }
    separable_links_gather(&op->separable, (int)bands, e, b->way[RAD_WAY_GROUPS]);
}

/* How long the line is where the surface e lies along it (m2): half of the points are spread by
 * area, half by the light that is reflected. */
static double length_of(const struct causes *c, uint32_t e)
{
    const struct solve *s = c->solve;
    const struct element *x = &s->hierarchy.elements[e];
    uint32_t bands = c->tracer.bands;
    double light = 0;
    for (uint32_t k = 0; k < bands; k++)
        light += s->state.radiosity[(size_t)e * bands + k]
                 - s->problem.exitance[(size_t)x->face * bands + k];
    return 0.5 * x->area
           * (1 + (c->mean > 0 ? s->operator.uncovered[e] * fmax(light, 0) / c->mean : 0));
}

/* ---- one ray */

/* What all rays of a leaf have in common, and where what they find goes. */
struct receiver {
    uint32_t leaf, face;
    double weight;                              /* of a point: m2 that it stands for, in spacings */
    double uncovered, shown[3], reflectance[3]; /* shown: B - E */
    double sum[RAD_CAUSES][3];                  /* what no ray is asked for (W/m2) */
    double grows[3];                            /* of this point: see follow_light */
    double *to[CAUSE_SUMS][3], *after[CAUSE_SUMS]; /* sums of this replicate */
};

static void add(const struct receiver *at, int cause, uint32_t band, double difference)
{
    *at->to[cause][band] += at->weight * difference;
    *at->after[cause] += at->weight * at->grows[band] * difference;
}

static double turn(double u)
{
    return u < 0.5 ? u + 0.5 : u - 0.5;
}

/* A ray finds light at point y of a face, and counts as `share` of one. */
static void add_arrival(struct walk *w, const struct receiver *at, uint32_t face, const double y[3],
                        double share)
{
    static const struct {
        enum RadCauseKind bright, visibility;
    } causes[RAD_WAYS] = {{RAD_CAUSE_LOST, RAD_CAUSE_LOST},
                          {RAD_CAUSE_OPEN_BRIGHT, RAD_CAUSE_OPEN_VISIBILITY},
                          {RAD_CAUSE_HALF_BRIGHT, RAD_CAUSE_HALF_VISIBILITY},
                          {RAD_CAUSE_GROUPS_BRIGHT, RAD_CAUSE_GROUPS_REST}};
    const struct causes *c = w->causes;
    const struct separable_links *groups = &c->op->separable;
    const struct hierarchy *h = c->op->hierarchy;
    const uint32_t bands = c->tracer.bands;
    double weight[4];
    uint32_t emitter = leaf_at(h->elements, h->face_element[face], y, weight);
    const double *B = &c->solve->state.radiosity[(size_t)emitter * bands];
    covering found = find_link(w, emitter);
    size_t i = found / 2 - 1;
    const struct link *l = found && !(found & 1) ? &c->op->refinement->links[i] : NULL;
    enum RadWay way = !found ? RAD_WAY_NONE : l ? way_of(l) : RAD_WAY_GROUPS;
    for (uint32_t k = 0; k < bands; k++) {
        double rho = share * at->reflectance[k], mean = 0;
        add(at, CAUSE_ALL, k, -rho * B[k]);
        if (!(at->uncovered > 0)) {
            add(at, RAD_CAUSE_CONTACT, k, -rho * B[k]);
            continue;
        }
        if (l)
            mean = c->solve->state.radiosity[(size_t)l->emitter * bands + k];
        else if (found && c->of_one[i] > 0)
            mean = (double)groups->arrives[i * bands + k] / (double)c->of_one[i];
        add(at, causes[way].bright, k, rho * (mean - B[k]));
        if (way != RAD_WAY_NONE)
            add(at, causes[way].visibility, k, -rho * mean);
        w->sums->rays[way] += at->weight * rho * B[k];
    }
}

/* The balance heuristic's share of light from y of an emitter, found from p, by a ray of either
 * kind; chance: that the emitter is chosen (paths.c). */
static double share_of(const struct element *from, const double p[3], const struct element *emitter,
                       const double y[3], double chance)
{
    double by_cosine = lambert_points(p, from->normal, y, emitter->normal, 0);
    return by_cosine > 0 ? by_cosine / (by_cosine + chance / emitter->area) : 0;
}

/* A ray from p to the emitters. */
static void look_for_light(struct walk *w, const struct receiver *at, const double p[3],
                           const double u[3])
{
    const struct tracer *t = &w->causes->tracer;
    const struct element *from = tracer_surface(t, at->face);
    uint32_t face;
    double chance = light_tree_choose(&t->light_tree, p, from->normal, u[0], &face);
    if (!(chance > 0))
        return;
    const struct element *emitter = tracer_surface(t, face);
    double q[3], y[3], way[3];
    tracer_point(t, face, u[1], u[2], q);
    for (int d = 0; d < 3; d++)
        y[d] = q[d] - rays_host(t->rays)->ray_offset * emitter->normal[d];
    double share = share_of(from, p, emitter, y, chance);
    sub3(way, q, p);
    if (share > 0 && !rays_blocked(t->rays, p, way))
        add_arrival(w, at, face, y, share);
}

/* Set at->grows: by a path from p, what light reflected there comes to after all reflections.
 * Returns its rays. */
static uint64_t follow_light(const struct tracer *t, struct receiver *at, const double p[3],
                             struct dice *dice)
{
    double through[3] = {1, 1, 1}, x[3] = {p[0], p[1], p[2]};
    uint32_t face = at->face;
    for (uint64_t rays = 1;; rays++) {
        double u = dice_throw(dice), v = dice_throw(dice), strongest = 0, left = 0;
        int64_t met = tracer_step(t, face, x, u, v, NULL);
        if (met < 0)
            return rays;
        face = (uint32_t)met;
        for (uint32_t k = 0; k < t->bands; k++) {
            strongest = fmax(strongest, through[k]);
            through[k] *= t->reflectance[(size_t)face * t->bands + k];
            left = fmax(left, through[k]);
            at->grows[k] += through[k];
        }
        if (!(dice_throw(dice) * strongest < left))
            return rays;
        for (uint32_t k = 0; k < t->bands; k++)
            through[k] *= strongest / left;
    }
}

/* The rays of one point, u in [0, 1)^5: one by the cosine, one to the emitters, and a path. */
static void trace(struct walk *w, struct receiver *at, const double u[SOBOL_DIMENSIONS],
                  struct dice *dice)
{
    const struct causes *c = w->causes;
    const struct tracer *t = &c->tracer;
    const struct element *leaf = &c->op->hierarchy->elements[at->leaf];
    double from[3], p[3], y[3];
    surface_even_point(from, leaf, u[0], u[1]);
    for (int d = 0; d < 3; d++)
        p[d] = from[d] += rays_host(t->rays)->ray_offset * leaf->normal[d];
    int64_t met = tracer_step(t, at->face, p, u[2], u[3], y);
    int covered = (met < 0 || at->uncovered < 1) && contact_covers(t->rays, leaf, from);
    double bare = covered ? 0 : 1;
    for (uint32_t k = 0; k < t->bands; k++)
        at->grows[k] = 1;
    w->sums->traced += RAYS_OF_POINT + (covered ? 0 : follow_light(t, at, from, dice));
    for (uint32_t k = 0; k < t->bands; k++) {
        add(at, CAUSE_ALL, k, bare * at->shown[k]);
        add(at, RAD_CAUSE_CONTACT, k,
            (at->uncovered > 0 ? bare - at->uncovered : bare) * at->shown[k]);
    }
    if (covered)
        return;
    if (met >= 0) {
        double share = 1;
        uint32_t face = (uint32_t)met;
        if (t->light_tree.place[face] != UINT32_MAX)
            share = share_of(leaf, from, tracer_surface(t, face), y,
                             light_tree_chance(&t->light_tree, from, leaf->normal, face));
        add_arrival(w, at, face, y, share);
    }
    /* Of a Sobol' sequence with the place, too; that it goes with the direction does no harm:
     * each of the two rays is spread evenly by itself. */
    const double v[3] = {u[4], turn(u[2]), turn(u[3])};
    look_for_light(w, at, from, v);
}

/* ---- one leaf, one face */

/* How many points of a replicate lie before the place on the line. */
static uint64_t points_before(const struct causes *c, int replicate, double place)
{
    return (uint64_t)ceil(fmax(place / c->spacing - c->shift[replicate].start, 0));
}

static void set_receiver(const struct causes *c, struct receiver *at, uint32_t leaf,
                         const struct brought *b)
{
    const struct solve *s = c->solve;
    uint32_t bands = c->tracer.bands;
    memset(at, 0, sizeof *at);
    at->leaf = leaf;
    at->face = s->hierarchy.elements[leaf].face;
    at->uncovered = s->operator.uncovered[leaf];
    for (uint32_t k = 0; k < bands; k++) {
        at->reflectance[k] = s->problem.reflectance[(size_t)at->face * bands + k];
        at->shown[k] = s->state.radiosity[(size_t)leaf * bands + k]
                       - s->problem.exitance[(size_t)at->face * bands + k];
    }
    for (uint32_t k = 0; k < bands && at->uncovered > 0; k++) {
        double rho = at->reflectance[k], gathered = c->gathered[(size_t)leaf * bands + k], all = 0;
        for (int way = RAD_WAY_OPEN; way < RAD_WAYS; way++)
            all += b->way[way][k];
        at->sum[RAD_CAUSE_SOLVER][k] = at->uncovered * at->shown[k] - rho * gathered;
        at->sum[RAD_CAUSE_ROW_CAP][k] = rho * (gathered - all);
        at->sum[RAD_CAUSE_OPEN_KERNEL][k] = rho * b->kernel[RAD_WAY_OPEN][k];
        at->sum[RAD_CAUSE_HALF_KERNEL][k] = rho * b->kernel[RAD_WAY_HALF][k];
        at->sum[RAD_CAUSE_OPEN_VISIBILITY][k] =
            rho * (b->way[RAD_WAY_OPEN][k] - b->kernel[RAD_WAY_OPEN][k]);
        at->sum[RAD_CAUSE_HALF_VISIBILITY][k] =
            rho * (b->way[RAD_WAY_HALF][k] - b->kernel[RAD_WAY_HALF][k]);
        at->sum[RAD_CAUSE_GROUPS_REST][k] = rho * b->way[RAD_WAY_GROUPS][k];
    }
}

/* The rays of a leaf that lies from .. to along the line (m2). */
static void trace_leaf(struct walk *w, uint32_t leaf, const struct brought *b, double from,
                       double to)
{
    const struct causes *c = w->causes;
    struct receiver at;
    set_receiver(c, &at, leaf, b);
    at.weight = c->op->hierarchy->elements[leaf].area / (to - from);
    uint64_t points = 0;
    for (int r = 0; r < REPLICATES; r++) {
        uint64_t first = points_before(c, r, from), end = points_before(c, r, to);
        double growth[3] = {0, 0, 0};
        for (int cause = 0; cause < CAUSE_SUMS; cause++)
            for (int k = 0; k < 3; k++) {
                at.to[cause][k] = &w->polygon.sum[cause][k][r];
                at.after[cause] = &w->polygon.after[cause][r];
            }
        for (uint64_t i = first; i < end; i++) {
            double u[SOBOL_DIMENSIONS];
            sobol_sequence_point(&c->sobol, (uint32_t)i, c->shift[r].digits, u);
            struct dice dice = dice_of(c->stream, (uint64_t)r << 32 | i);
            trace(w, &at, u, &dice);
            for (uint32_t k = 0; k < c->tracer.bands; k++)
                growth[k] += at.grows[k];
        }
        for (int cause = 0; cause < RAD_CAUSES; cause++)
            for (uint32_t k = 0; k < c->tracer.bands; k++) {
                *at.to[cause][k] += at.weight * (double)(end - first) * at.sum[cause][k];
                *at.after[cause] += at.weight * growth[k] * at.sum[cause][k];
            }
        for (uint32_t k = 0; k < c->tracer.bands; k++)
            w->polygon.growth[k] += at.weight * growth[k];
        points += end - first;
    }
    w->polygon.points += points;
    w->polygon.weight += at.weight * (double)points;
    for (uint32_t k = 0; k < c->tracer.bands && at.uncovered > 0; k++)
        for (int way = RAD_WAY_OPEN; way < RAD_WAYS; way++)
            w->sums->links[way] += at.weight * (double)points * at.reflectance[k] * b->way[way][k];
}

static int has_points(const struct causes *c, double from, double to)
{
    for (int r = 0; r < REPLICATES; r++)
        if (points_before(c, r, from) < points_before(c, r, to))
            return 1;
    return 0;
}

/* All rays from surface e and its parts; `above`: what the links above it bring. */
static void walk_surface(struct walk *w, uint32_t e, struct brought above, double from, double to)
{
    const struct causes *c = w->causes;
    const struct element *elements = c->op->hierarchy->elements, *x = &elements[e];
    if (!has_points(c, from, to))
        return;
    add_links(c, e, &above);
    mark_links(w, e, 1);
    double whole = 0, part = 0;
    for (int i = 0; i < x->children; i++)
        whole += length_of(c, x->child + (uint32_t)i);
    for (int i = 0; i < x->children; i++) {
        double begin = from + (to - from) * part / whole;
        part += length_of(c, x->child + (uint32_t)i);
        double end = i + 1 < x->children ? from + (to - from) * part / whole : to;
        walk_surface(w, x->child + (uint32_t)i, above, begin, end);
    }
    if (!x->children)
        trace_leaf(w, e, &above, from, to);
    mark_links(w, e, 0);
}

/* Nonzero: stop. By the thread that called in, the work is told of. */
static int watch(struct causes *c, double area)
{
    uint64_t done, points = (uint64_t)(REPLICATES * area / c->spacing);
    int stopped;
#pragma omp atomic capture
    done = c->done += points;
    if (omp_get_thread_num() == 0) {
        const struct counting counting = {RAYS_OF_POINT * done,
                                          fmin((double)done / (double)c->points, 1)};
        c->solve->counting = &counting;
        if (solve_tell(c->solve, "causes")) {
#pragma omp atomic write
            c->stopped = 1;
        }
        c->solve->counting = NULL;
    }
#pragma omp atomic read
    stopped = c->stopped;
    return stopped;
}

static void walk_chunk(struct walk *w, uint32_t chunk)
{
    static const struct brought nothing;
    struct causes *c = w->causes;
    const struct hierarchy *h = c->op->hierarchy;
    for (uint32_t i = c->chunk_face[chunk]; i < c->chunk_face[chunk + 1]; i++) {
        uint32_t e = h->face_element[i];
        if (c->until[i] < c->until[i + 1] && has_points(c, c->until[i], c->until[i + 1])) {
            move_to(w, h->elements[e].parent);
            walk_surface(w, e, nothing, c->until[i], c->until[i + 1]);
        }
        if (i + 1 == h->face_count || h->faces[i + 1].input != h->faces[i].input)
            cause_sums_add(w->sums, &w->polygon, c->tracer.bands);
        if (watch(c, c->until[i + 1] - c->until[i]))
            return;
    }
}

/* ---- all of it */

/* Where the last pass has changed links, the operator is that of the links before. Returns 0 or -1.
 */
static int renew_operator(struct solve *s)
{
    struct light_operator *op = &s->operator;
    struct row_report rows;
    if (s->report.changing == 0)
        return 0;
    separable_links_close(&op->separable);
    if (separable_links_open(&op->separable, &s->hierarchy, &s->refinement, (int)s->problem.bands,
                             s->problem.options.threads, op->collocated != NULL)
        < 0)
        return -1;
    row_sums_scale(op, &rows);
    return 0;
}

/* K B into c->gathered, by a sweep of Jacobi's over copies; J of a radiosity of 1 before. Returns 0
 * or -1. */
static int gather_all(struct causes *c)
{
    struct solve *s = c->solve;
    const struct light_operator *op = c->op;
    uint32_t bands = s->problem.bands;
    size_t elements = s->hierarchy.count, values = elements * bands;
    double *value = malloc((values + 1) * sizeof *value);
    c->gathered = malloc((values + 1) * sizeof *c->gathered);
    c->of_one = malloc((op->separable.count + 1) * sizeof *c->of_one);
    if (!value || !c->gathered || !c->of_one) {
        free(value);
        return -1;
    }
    for (size_t e = 0; e < elements; e++)
        value[e] = 1;
    separable_links_send(&op->separable, 1, value);
    if (op->separable.count)
        memcpy(c->of_one, op->separable.arrives, op->separable.count * sizeof *c->of_one);
    separable_links_send(&op->separable, (int)bands, s->state.radiosity);
    memcpy(value, s->state.radiosity, values * sizeof *value);
    const struct transport x = {.bands = bands,
                                .value = value,
                                .irradiance = c->gathered,
                                .source = s->problem.exitance,
                                .reflectance = s->problem.reflectance};
#pragma omp parallel num_threads(s->problem.options.threads)
    {
        struct change change;
#pragma omp for schedule(dynamic, 8)
        for (uint32_t i = 0; i < s->hierarchy.face_count; i++)
            face_gather(op, &x, s->hierarchy.face_element[i]);
#pragma omp for schedule(dynamic, 64)
        for (uint32_t i = 0; i < s->hierarchy.face_count; i++)
            face_update(op, &x, s->hierarchy.face_element[i], &change);
    }
    free(value);
    return 0;
}

/* NULL: out of memory. */
static double *face_radiosity(const struct solve *s)
{
    size_t bands = s->problem.bands;
    double *shines = malloc(((size_t)s->hierarchy.face_count * bands + 1) * sizeof *shines);
    for (uint32_t i = 0; shines && i < s->hierarchy.face_count; i++)
        memcpy(&shines[i * bands], &s->state.radiosity[s->hierarchy.face_element[i] * bands],
               bands * sizeof *shines);
    return shines;
}

static double reflected(const struct causes *c)
{
    const struct solve *s = c->solve;
    double sum = 0;
    for (uint32_t i = 0; i < s->hierarchy.face_count; i++) {
        uint32_t e = s->hierarchy.face_element[i];
        for (uint32_t k = 0; k < s->problem.bands; k++)
            sum += s->hierarchy.elements[e].area
                   * s->operator.uncovered[e] *(
                       s->state.radiosity[(size_t)e * s->problem.bands + k]
                       - s->problem.exitance[(size_t)i * s->problem.bands + k]);
    }
    return sum;
}

/* The line, its chunks, and where points stand on it. Returns 0 or -1. */
static int lay_out(struct causes *c, uint64_t rays)
{
    const struct hierarchy *h = c->op->hierarchy;
    const struct problem *p = &c->solve->problem;
    uint32_t faces = h->face_count, polygons = h->faces[faces - 1].input + 1;
    c->until = malloc(((size_t)faces + 1) * sizeof *c->until);
    c->chunk_face = malloc((CHUNKS + 1) * sizeof *c->chunk_face);
    if (!c->until || !c->chunk_face)
        return -1;
    double area = 0;
    for (uint32_t i = 0; i < faces; i++)
        area += p->whitest[i] > 0 ? h->elements[h->face_element[i]].area : 0;
    c->mean = area > 0 ? reflected(c) / area : 0;
    c->until[0] = 0;
    c->chunks = 0;
    double white = 0;
    uint64_t chunk = UINT64_MAX;
    for (uint32_t i = 0; i < faces; i++) {
        uint32_t input = h->faces[i].input;
        uint64_t at = polygons > CHUNKS ? (uint64_t)input * CHUNKS / polygons : input;
        if (at != chunk)
            c->chunk_face[c->chunks++] = i;
        chunk = at;
        double length = p->whitest[i] > 0 ? length_of(c, h->face_element[i]) : 0;
        white += length * p->whitest[i];
        c->until[i + 1] = c->until[i] + length;
    }
    c->chunk_face[c->chunks] = faces;
    /* a path has 1 / (1 - rho) rays, about */
    double whole = c->until[faces],
           each = RAYS_OF_POINT + whole / fmax(whole - white, 0.01 * whole);
    c->points = (uint64_t)fmax((double)rays / each, REPLICATES);
    c->spacing = whole * REPLICATES / (double)c->points;
    sobol_sequence_open(&c->sobol);
    for (int r = 0; r < REPLICATES; r++) {
        struct dice dice = dice_of(c->stream, UINT64_MAX - (uint64_t)r);
        c->shift[r].start = dice_throw(&dice);
        for (int d = 0; d < SOBOL_DIMENSIONS; d++)
            c->shift[r].digits[d] = (uint32_t)(dice_throw(&dice) * 0x1p32);
    }
    return 0;
}

/* Sums of all chunks into *sums. Returns 0, or -1 when out of memory or stopped. */
static int walk_all(struct causes *c, struct cause_sums *sums)
{
    struct cause_sums *part = calloc(c->chunks, sizeof *part);
    int failed = !part;
#pragma omp parallel num_threads(c->tracer.threads) if (part)
    {
        struct walk *w = calloc(1, sizeof *w);
        if (w) {
            w->causes = c;
            w->cover = calloc(c->op->hierarchy->count, sizeof *w->cover);
        }
        int ready = part && w && w->cover;
        if (ready)
            mark_links(w, 0, 1);
        else {
#pragma omp atomic write
            failed = 1;
        }
#pragma omp for schedule(dynamic, 1)
        for (uint32_t i = 0; i < c->chunks; i++)
            if (ready) {
                w->sums = &part[i];
                walk_chunk(w, i);
            }
        if (w)
            free(w->cover);
        free(w);
    }
    for (uint32_t i = 0; i < c->chunks && !failed; i++)
        cause_sums_join(sums, &part[i]);
    free(part);
    return failed || c->stopped ? -1 : 0;
}

int error_causes_find(struct solve *s, uint64_t rays, uint64_t stream,
                      struct RadCausesReport *report)
{
    struct causes c = {.solve = s, .op = &s->operator, .tracer = solve_tracer(s), .stream = stream};
    struct cause_sums sums = {0};
    *report = (struct RadCausesReport){.reflected = reflected(&c)};
    c.tracer.exitance = c.shines = face_radiosity(s);
    int failed = !c.shines || tracer_open(&c.tracer) < 0 || renew_operator(s) < 0
                 || gather_all(&c) < 0 || lay_out(&c, rays) < 0
                 || (c.spacing > 0 && walk_all(&c, &sums) < 0);
    if (!failed && c.spacing > 0) {
        cause_sums_report(&sums, report->reflected / c.spacing, report);
    }
    tracer_close(&c.tracer);
    free(c.gathered);
    free(c.shines);
    free(c.of_one);
    free(c.until);
    free(c.chunk_face);
    return failed ? -1 : 0;
}
