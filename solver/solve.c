/* solve.c - the radiosity iteration over links, and Hanrahan's multigridding around it.
 *
 * A sweep gathers H_r += F V B_s over the links of every element, pushes it down to the leaves, where
 * B = E + rho H, and pulls area means up. A sweep goes through the faces in blocks; within a block all
 * gather first and are updated then, so the result is the same for any number of threads. One block
 * is Jacobi's method, many are Gauss-Seidel's. With rows at most 1 a sweep contracts by rho, the largest reflectance, so
 * the error left is about residual * rho / (1 - rho), which is what the tolerance is held against.
 *
 * Part of a surface may be buried in a solid that stands on it, like the floor under a table leg. It
 * receives nothing and sends nothing; rays know that, but a mean over the whole element would send the missing light
 * a second time less. So B is the mean over the exposed part, and B = E + rho H / exposed, where H stays the mean over all.
 *
 * No point sees more than everything, so the sums of F V over a leaf's links (its row) are at most 1; yet a
 * leaf near an edge, whose ancestors' links bring their mean, can exceed that, and then a bright enough
 * scene gains power in every reflection and the iteration diverges. So rows are capped: a leaf above 1 is scaled to 1
 * and the power that takes away is given to the leaves of the same face between 1/2 and 1, by the room they
 * have. That moves power within a face and makes none; rows below 1/2 are shadow, not error, and
 * stay dark. Where the mean row of a whole face exceeds 1, by the noise of its rays, the cap is that mean (cutting
 * noise on one side would lose power), but at most 1 + (1 - rho) / 2: so the iteration converges whatever
 * the oracle does.
 * [Hanrahan et al. 1991, sections 4 and 5; Arvo et al. 1994, section 5.3 for the bound; cap: derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "solve.h"

#define STALE 0.02
enum { BLOCKS = 16, PASSES = 32, LINKS_WORTH_THREADS = 1 << 16 };

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double largest(const double *v, uint32_t n)
{
    double most = v[0];
    uint32_t i;
    for (i = 1; i < n; i++)
        most = v[i] > most ? v[i] : most;
    return most;
}

/* Room for `count` values in *list. Returns 0, or -1 and *list as it was. */
static int enlarge(double **list, size_t count)
{
    double *moved = realloc(*list, count * sizeof *moved);
    if (!moved)
        return -1;
    *list = moved;
    return 0;
}

/* Give elements made since the last call their parent's radiosity. Returns 0 or -1. */
static int make_room(struct solve *s)
{
    uint32_t count = s->hierarchy.count, b = s->bands, i, k;
    if (count > s->room) {
        size_t room = (size_t)count + count / 4;
        unsigned char *mark;
        if (enlarge(&s->radiosity, room * b) < 0 || enlarge(&s->irradiance, room * b) < 0 || enlarge(&s->row_scale, room) < 0
            || enlarge(&s->row_gift, room) < 0 || enlarge(&s->exposed, room) < 0)
            return -1;
        mark = realloc(s->changed, room);
        if (!mark)
            return -1;
        s->changed = mark;
        s->room = (uint32_t)(room > UINT32_MAX ? UINT32_MAX : room);
    }
    for (i = s->started; i < count; i++) {
        const struct element *e = &s->hierarchy.elements[i];
        for (k = 0; k < b; k++) {
            s->radiosity[(size_t)i * b + k] = e->vertices && e->depth > 0 ? s->radiosity[(size_t)e->parent * b + k] : 0;
            s->irradiance[(size_t)i * b + k] = 0;
        }
        s->exposed[i] = 1;
    }
    s->started = count;
    return 0;
}

/* Which part of each new leaf is exposed; from there up, means. `first`: the first new element. */
static void expose(struct solve *s, uint32_t first)
{
    struct element *elements = s->hierarchy.elements;
    uint32_t count = s->hierarchy.count, i;
    int c;
#pragma omp parallel for schedule(dynamic, 64) num_threads(s->options.threads)
    for (i = first; i < count; i++)
        if (elements[i].vertices && !elements[i].children)
            s->exposed[i] = rays_exposed(s->rays, &elements[i]);
    for (i = count; i-- > 0;) {
        if (!elements[i].children)
            continue;
        s->exposed[i] = 0;
        for (c = 0; c < elements[i].children; c++) {
            uint32_t j = elements[i].child + (uint32_t)c;
            s->exposed[i] += s->exposed[j] * elements[j].area / elements[i].area;
        }
    }
}

/* The weight of child j in the mean radiosity of e: its share of the exposed area, or of all when none is exposed. */
static double share(const struct solve *s, uint32_t j, uint32_t e)
{
    double part = s->hierarchy.elements[j].area / s->hierarchy.elements[e].area;
    return s->exposed[e] > 0 ? part * s->exposed[j] / s->exposed[e] : part;
}

/* Before the first solve the oracles see what the light is likely to be: E + rho H with the mean irradiance. */
static void guess(struct solve *s)
{
    uint32_t i, k;
    for (i = 0; i < s->scene->face_count; i++) {
        struct element *e = &s->hierarchy.elements[s->hierarchy.face_element[i]];
        for (k = 0; k < s->bands; k++) {
            size_t at = (size_t)i * s->bands + k;
            double b = s->exitance[at] + s->reflectance[at] * rays_host(s->rays)->irradiance;
            e->radiosity = b > e->radiosity ? b : e->radiosity;
        }
    }
}

/* Area means of the clusters, and what the oracles see of every element. They see a value that is
 * within STALE of the true one, so that passes end; changed[] marks the elements that they see grow.
 * Children follow their parents. */
static void publish(struct solve *s)
{
    uint32_t b = s->bands, i, k;
    double seen;
    int c;
    for (i = s->hierarchy.count; i-- > 0;) {
        struct element *e = &s->hierarchy.elements[i];
        if (!e->vertices) {
            for (k = 0; k < b; k++)
                s->radiosity[(size_t)i * b + k] = s->irradiance[(size_t)i * b + k] = 0;
            for (c = 0; c < e->children; c++) {
                uint32_t j = e->child + (uint32_t)c;
                double sent = share(s, j, i), received = s->hierarchy.elements[j].area / e->area;
                for (k = 0; k < b; k++) {
                    s->radiosity[(size_t)i * b + k] += sent * s->radiosity[(size_t)j * b + k];
                    s->irradiance[(size_t)i * b + k] += received * s->irradiance[(size_t)j * b + k];
                }
            }
        }
        seen = largest(&s->radiosity[(size_t)i * b], b);
        s->changed[i] = seen > (1 + STALE) * e->radiosity;
        if (s->changed[i] || seen < (1 - STALE) * e->radiosity)
            e->radiosity = seen;
    }
}

static void take_materials(struct solve *s)
{
    const struct scene *scene = s->scene;
    uint32_t i, k;
    for (i = 0; i < scene->face_count; i++) {
        const struct material *m = &scene->materials[scene->faces[i].material];
        for (k = 0; k < s->bands; k++) {
            s->exitance[(size_t)i * s->bands + k] = s->options.unit ? 1 : m->exitance[k];
            s->reflectance[(size_t)i * s->bands + k] = s->options.unit ? 0 : m->reflectance[k];
        }
    }
}

int solve_open(struct solve *s, const struct scene *scene, const struct solve_options *options, const char **cause)
{
    size_t values;
    double *brightest = NULL, *whitest = NULL, start = seconds();
    uint32_t i, k;
    memset(s, 0, sizeof *s);
    *cause = "out of memory";
    s->scene = scene;
    s->options = *options;
    s->bands = options->unit ? 1 : scene->bands;
    values = (size_t)scene->face_count * s->bands;
    if (hierarchy_build(&s->hierarchy, scene->faces, scene->face_count) < 0)
        return -1;
    s->exitance = malloc(values * sizeof *s->exitance);
    s->reflectance = malloc(values * sizeof *s->reflectance);
    brightest = malloc(scene->face_count * sizeof *brightest);
    whitest = malloc(scene->face_count * sizeof *whitest);
    if (!s->exitance || !s->reflectance || !brightest || !whitest || make_room(s) < 0)
        goto fail;
    take_materials(s);
    for (i = 0; options->unit && i < s->hierarchy.count; i++)
        s->hierarchy.elements[i].black = 0;
    for (i = 0; i < scene->face_count; i++) {
        brightest[i] = largest(&s->exitance[(size_t)i * s->bands], s->bands);
        whitest[i] = largest(&s->reflectance[(size_t)i * s->bands], s->bands);
        s->hierarchy.elements[s->hierarchy.face_element[i]].reflectance = whitest[i];
        for (k = 0; k < s->bands; k++)
            s->radiosity[(size_t)s->hierarchy.face_element[i] * s->bands + k] = s->exitance[(size_t)i * s->bands + k];
    }
    publish(s);
    s->rays = rays_open(&s->hierarchy, brightest, whitest, options->threads, cause);
    if (!s->rays)
        goto fail;
    guess(s);
    free(brightest);
    free(whitest);
    s->seconds.build = seconds() - start;
    return 0;
fail:
    free(brightest);
    free(whitest);
    solve_close(s);
    return -1;
}

/* What element e gathers over its own links, into irradiance[e]. */
static void gather(struct solve *s, uint32_t e)
{
    const struct refinement *r = &s->refinement;
    size_t i;
    double h[3] = { 0, 0, 0 };
    uint32_t b = s->bands, k;
    for (i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const struct link *l = &r->links[i];
        double weight = (double)l->form_factor * (l->visibility * (1.0 / LINK_VISIBLE));
        const double *from = &s->radiosity[(size_t)l->emitter * b];
        for (k = 0; k < b; k++)
            h[k] += weight * from[k];
    }
    cluster_light_gather(&s->cluster_light, e, h);
    for (k = 0; k < b; k++)
        s->irradiance[(size_t)e * b + k] = h[k];
}

static void gather_below(struct solve *s, uint32_t e)
{
    const struct element *x = &s->hierarchy.elements[e];
    int c;
    gather(s, e);
    for (c = 0; c < x->children; c++)
        gather_below(s, x->child + (uint32_t)c);
}

struct rows;

/* Call visit(context, leaf, sum of F V over its links and its ancestors') for the leaves below e. */
static void visit_rows(struct solve *s, uint32_t e, double above, void (*visit)(struct solve *, uint32_t, double, struct rows *),
                       struct rows *context)
{
    const struct element *x = &s->hierarchy.elements[e];
    const struct refinement *r = &s->refinement;
    size_t i;
    int c;
    double beams[3] = { 0, 0, 0 };
    for (i = r->first_link[e]; i < r->first_link[e + 1]; i++)
        above += (double)r->links[i].form_factor * (r->links[i].visibility * (1.0 / LINK_VISIBLE));
    cluster_light_gather(&s->cluster_light, e, beams);
    above += beams[0];
    for (c = 0; c < x->children; c++)
        visit_rows(s, x->child + (uint32_t)c, above, visit, context);
    if (!x->children)
        visit(s, e, above, context);
}

/* What the rows of one face come to. A row counts per exposed area: what is buried sees nothing. */
struct rows {
    double cap, sum, area; /* sum: of A exposed row (m2); area: of A exposed (m2) */
    double excess, room;   /* above the cap; between ROW_SHADOW of the cap and the cap (m2) */
};
#define ROW_SHADOW 0.5

/* The row of a leaf per exposed area, and that area (m2); 0 when all of it is buried. */
static double exposed_row(const struct solve *s, uint32_t leaf, double row, double *area)
{
    *area = s->hierarchy.elements[leaf].area * s->exposed[leaf];
    return s->exposed[leaf] > 0 ? row / s->exposed[leaf] : 0;
}

static void sum_row(struct solve *s, uint32_t leaf, double row, struct rows *rows)
{
    double area;
    row = exposed_row(s, leaf, row, &area);
    s->leaves++;
    if (!(area > 0))
        return;
    rows->sum += area * row;
    rows->area += area;
    s->row_low = row < s->row_low ? row : s->row_low;
    s->row_high = row > s->row_high ? row : s->row_high;
}

static void weigh_row(struct solve *s, uint32_t leaf, double row, struct rows *rows)
{
    double area;
    row = exposed_row(s, leaf, row, &area);
    if (row > rows->cap)
        rows->excess += area * (row - rows->cap);
    else if (row > ROW_SHADOW * rows->cap)
        rows->room += area * (rows->cap - row);
}

static void cap_row(struct solve *s, uint32_t leaf, double row, struct rows *rows)
{
    double area, most = rows->excess > rows->room ? rows->excess : rows->room;
    row = exposed_row(s, leaf, row, &area);
    s->row_scale[leaf] = row > rows->cap ? rows->cap / row : 1;
    s->row_gift[leaf] = row > ROW_SHADOW * rows->cap && row < rows->cap ? s->exposed[leaf] * (rows->cap - row) / most : 0;
}

/* Rows of all leaves: their range, and the factors that cap them. */
static void cap_rows(struct solve *s)
{
    uint32_t i;
    s->leaves = 0;
    s->row_low = INFINITY;
    s->row_high = s->row_excess = 0;
    for (i = 0; i < s->scene->face_count; i++) {
        uint32_t e = s->hierarchy.face_element[i];
        double most = 1 + 0.5 * (1 - largest(&s->reflectance[(size_t)i * s->bands], s->bands));
        struct rows rows = { 1, 0, 0, 0, 0 };
        visit_rows(s, e, 0, sum_row, &rows);
        if (rows.sum > rows.area)
            rows.cap = rows.sum < most * rows.area ? rows.sum / rows.area : most;
        visit_rows(s, e, 0, weigh_row, &rows);
        visit_rows(s, e, 0, cap_row, &rows);
        s->row_excess += rows.excess / rays_host(s->rays)->area;
    }
}

/* Push irradiance down to the leaves and cap it there; removed[band] gathers the power that takes away. */
static void push(struct solve *s, uint32_t e, const double above[3], double removed[3])
{
    const struct element *x = &s->hierarchy.elements[e];
    uint32_t b = s->bands, k;
    double *H = &s->irradiance[(size_t)e * b], h[3];
    int c;
    for (k = 0; k < b; k++)
        h[k] = above[k] + H[k];
    for (c = 0; c < x->children; c++)
        push(s, x->child + (uint32_t)c, h, removed);
    for (k = 0; k < b && !x->children; k++) {
        H[k] = h[k] * s->row_scale[e];
        removed[k] += x->area * (h[k] - H[k]);
    }
}

/* B = E + rho H at the leaves, means above. Returns sum A |dB| over the leaves. */
static double pull(struct solve *s, uint32_t e, const double removed[3])
{
    const struct element *x = &s->hierarchy.elements[e];
    uint32_t b = s->bands, k;
    double *B = &s->radiosity[(size_t)e * b], *H = &s->irradiance[(size_t)e * b], moved = 0;
    int c;
    if (!x->children) {
        const double *E = &s->exitance[(size_t)x->face * b], *rho = &s->reflectance[(size_t)x->face * b];
        for (k = 0; k < b; k++) {
            double exposed = s->exposed[e], next;
            H[k] += removed[k] * s->row_gift[e];
            next = E[k] + (exposed > 0 ? rho[k] * H[k] / exposed : 0);
            moved += x->area * exposed * fabs(next - B[k]);
            B[k] = next;
        }
        return moved;
    }
    for (k = 0; k < b; k++)
        B[k] = H[k] = 0;
    for (c = 0; c < x->children; c++) {
        uint32_t j = x->child + (uint32_t)c;
        double sent = share(s, j, e), received = s->hierarchy.elements[j].area / x->area;
        moved += pull(s, j, removed);
        for (k = 0; k < b; k++) {
            B[k] += sent * s->radiosity[(size_t)j * b + k];
            H[k] += received * s->irradiance[(size_t)j * b + k];
        }
    }
    return moved;
}

/* One sweep over all faces. moved[face] receives sum A |dB|. */
static void sweep(struct solve *s, double *moved)
{
    static const double nothing[3] = { 0, 0, 0 };
    uint32_t faces = s->scene->face_count, blocks = s->options.jacobi ? 1 : faces < BLOCKS ? faces : BLOCKS, block;
    cluster_light_send(&s->cluster_light, s->radiosity);
#pragma omp parallel num_threads(s->options.threads) private(block) if (s->refinement.link_count > LINKS_WORTH_THREADS)
    for (block = 0; block < blocks; block++) {
        uint32_t from = (uint32_t)((uint64_t)faces * block / blocks), to = (uint32_t)((uint64_t)faces * (block + 1) / blocks), i;
#pragma omp for schedule(dynamic, 8)
        for (i = from; i < to; i++)
            gather_below(s, s->hierarchy.face_element[i]);
#pragma omp for schedule(dynamic, 64)
        for (i = from; i < to; i++) {
            double removed[3] = { 0, 0, 0 };
            push(s, s->hierarchy.face_element[i], nothing, removed);
            moved[i] = pull(s, s->hierarchy.face_element[i], removed);
        }
    }
}

/* Sweeps until the error they leave is below the tolerance. Returns 0 or -1. */
static int iterate(struct solve *s, const char **cause)
{
    uint32_t faces = s->scene->face_count, i, k;
    double *moved = malloc(faces * sizeof *moved), rho = largest(s->reflectance, faces * s->bands);
    int n;
    double *ones = malloc((size_t)s->hierarchy.count * s->bands * sizeof *ones);
    size_t at;
    *cause = "out of memory";
    cluster_light_close(&s->cluster_light);
    if (!moved || !ones
        || cluster_light_open(&s->cluster_light, &s->hierarchy, &s->refinement, (int)s->bands, s->options.threads) < 0) {
        free(moved);
        free(ones);
        return -1;
    }
    for (at = 0; at < (size_t)s->hierarchy.count * s->bands; at++)
        ones[at] = 1;
    cluster_light_send(&s->cluster_light, ones);
    free(ones);
    cap_rows(s);
    s->converged = 0;
    for (n = 0; n < s->options.iterations && !s->converged; n++) {
        double change = 0, power = 0;
        sweep(s, moved);
        s->sweeps++;
        for (i = 0; i < faces; i++) {
            uint32_t e = s->hierarchy.face_element[i];
            change += moved[i];
            for (k = 0; k < s->bands; k++)
                power += s->hierarchy.elements[e].area * s->exposed[e] * s->radiosity[(size_t)e * s->bands + k];
        }
        s->residual = power > 0 ? change / power : 0;
        s->converged = s->residual * rho <= s->options.tolerance * (1 - rho);
        if (s->options.progress)
            s->options.progress(s->options.context, s, "solve");
    }
    free(moved);
    return 0;
}

/* The account of power. */
static void account(struct solve *s)
{
    uint32_t i, k, b = s->bands;
    s->emitted = s->absorbed = 0;
    for (i = 0; i < s->scene->face_count; i++) {
        uint32_t e = s->hierarchy.face_element[i];
        double area = s->hierarchy.elements[e].area;
        for (k = 0; k < b; k++) {
            s->emitted += area * s->exposed[e] * s->exitance[(size_t)i * b + k];
            s->absorbed += area * (1 - s->reflectance[(size_t)i * b + k]) * s->irradiance[(size_t)e * b + k];
        }
    }
}

static void watch(void *context, const struct refinement *refinement)
{
    struct solve *s = context;
    (void)refinement;
    if (s->options.progress)
        s->options.progress(s->options.context, s, "refine");
}

int solve_refine(struct solve *s, const struct refiner *refiner, const char **cause)
{
    double start = seconds();
    *cause = "out of memory while refining; a coarser oracle parameter needs less";
    if (refinement_open(&s->refinement, &s->hierarchy, rays_host(s->rays), refiner, s->options.threads) < 0)
        return -1;
    s->refinement.watch = watch;
    s->refinement.watch_context = s;
    if (refinement_start(&s->refinement) < 0 || refinement_sort(&s->refinement) < 0 || make_room(s) < 0)
        return -1;
    if (!s->options.unit)
        expose(s, 0);
    s->seconds.refine += seconds() - start;
    s->seconds.in_rays = rays_count(s->rays).seconds / s->options.threads;
    return 0;
}

int solve_run(struct solve *s, const struct refiner *refiner, const char **cause)
{
    int64_t changed = 1;
    if (solve_refine(s, refiner, cause) < 0)
        return -1;
    for (s->passes = 0; changed > 0 && s->passes < PASSES; s->passes++) {
        double start = seconds(), middle;
        uint32_t first;
        if (iterate(s, cause) < 0)
            return -1;
        publish(s);
        middle = seconds();
        *cause = "out of memory while refining; a coarser oracle parameter needs less";
        first = s->hierarchy.count;
        changed = refinement_again(&s->refinement, s->changed);
        if (changed < 0 || (changed > 0 && refinement_sort(&s->refinement) < 0) || make_room(s) < 0)
            return -1;
        expose(s, first);
        s->seconds.iterate += middle - start;
        s->seconds.refine += seconds() - middle;
    }
    s->converged = s->converged && changed == 0;
    s->seconds.in_rays = rays_count(s->rays).seconds / s->options.threads;
    account(s);
    return 0;
}

struct solution solve_solution(const struct solve *s)
{
    struct solution view = { s->scene, &s->hierarchy, s->bands, s->radiosity, s->irradiance };
    return view;
}

void solve_close(struct solve *s)
{
    refinement_close(&s->refinement);
    cluster_light_close(&s->cluster_light);
    rays_close(s->rays);
    hierarchy_free(&s->hierarchy);
    free(s->radiosity);
    free(s->irradiance);
    free(s->row_scale);
    free(s->row_gift);
    free(s->exposed);
    free(s->changed);
    free(s->exitance);
    free(s->reflectance);
    memset(s, 0, sizeof *s);
}
