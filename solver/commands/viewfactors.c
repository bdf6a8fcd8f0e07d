/* command_viewfactors.c - `radiosity viewfactors`: the matrix of face-to-face view factors.
 *
 * F_ij is the share of what leaves face i evenly that meets face j. A tree of flat groups (factor_tree.c) is refined by the
 * oracle viewfactors with B = 1 on every face; its links become exchange areas of faces (factor_matrix.c). Faces count as in
 * the file: a face with two sides, or cut into parts, is one row, a mean over its parts.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "util/clock.h"
#include "commands/commands.h"
#include "output/factor_file.h"
#include "output/json_file.h"
#include "progress.h"
#include "util/report.h"

/* The tolerance that the oracle's defaults are made for. */
#define MEANT 3e-4
#define NEAR 2.5

struct account {
    double low, high;         /* of all rows' sums */
    uint32_t closed, open, covered; /* rows: that ought to sum to 1; that see the sky, or a black back; that are buried in part */
    double worst, mean;       /* |1 - sum| of the closed ones, before closure */
    double sky_most, sky;     /* what the open ones lack: the most, and the mean over all area */
};

struct work {
    const struct options *o;
    const struct scene *scene;
    struct factor_tree tree;
    struct refinement refinement;
    struct factor_matrix matrix;
    struct factor_closure closure;
    struct factor_sky *sky; /* [inputs] */
    double *sums;           /* [inputs]: of the rows, m2 */
    struct account account;
    struct progress progress;
    struct { double refine, fill, write; } seconds;
};

static void watch(void *context, const struct refinement *r)
{
    struct work *w = context;
    progress_say(&w->progress, "refine round %llu: %.3g pairs (%zu waiting), %.3g links, %.3g rays", (unsigned long long)r->rounds,
                 (double)r->pairs, r->queue_count, (double)r->link_count, (double)rays_count(w->tree.rays).rays);
}

/* Pairs nearer than so many radii are integrated exactly. The error of others falls with the fourth power of distance. */
static double near(const struct options *o)
{
    return fmax(NEAR * pow(MEANT / o->tolerance, 0.25), 1.5);
}

/* The oracle's limits for another tolerance: the error of half shadow falls with what is left to it. */
static struct refiner *oracle(const struct options *o)
{
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    if (!refiner)
        return NULL;
    for (int i = -1; (i = refiner_find_role(refiner, ROLE_SHADOW_TOLERANCE, i)) >= 0;)
        (void)refiner_set(refiner, refiner->parameters[i].name, refiner_get(refiner, i) * o->tolerance / MEANT, NULL);
    if (oracles_set(refiner, o->settings, o->setting_count) < 0) {
        refiner_close(refiner);
        return NULL;
    }
    return refiner;
}

static int refine(struct work *w)
{
    struct refiner *refiner = oracle(w->o);
    int status = -1;
    if (!refiner)
        return -1;
    if (refinement_open(&w->refinement, &w->tree.h, &w->tree.host, refiner, w->o->threads) == 0) {
        w->refinement.watch = watch;
        w->refinement.watch_context = w;
        status = refinement_start(&w->refinement);
    }
    if (status < 0)
        report_error(w->o->scene, 0, "out of memory while refining; a larger --tolerance needs less");
    refiner_close(refiner);
    return status;
}

/* Row sums, and what becomes of the light that rows lack. */
static int take_account(struct work *w)
{
    struct account *a = &w->account;
    uint32_t n = w->scene->input_count, i;
    double *share = malloc((n + 1) * sizeof *share), all = 0;
    w->sums = malloc((n + 1) * sizeof *w->sums);
    w->sky = calloc(n + 1, sizeof *w->sky);
    if (!share || !w->sums || !w->sky) {
        free(share);
        return -1;
    }
    factor_matrix_sums(&w->matrix, NULL, w->sums);
    for (i = 0; i < n; i++)
        share[i] = w->matrix.area[i] > 0 ? w->sums[i] / w->matrix.area[i] : 1;
    factor_sky_ask(w->sky, &w->matrix, share, w->o->factor_closure == FACTOR_CLOSURE_NONE ? w->o->tolerance : 0, w->o->threads);
    a->low = INFINITY;
    for (i = 0; i < n; i++) {
        const struct factor_sky *sky = &w->sky[i];
        double defect = fabs(1 - share[i]);
        if (!(w->matrix.area[i] > 0))
            continue;
        all += w->matrix.area[i];
        a->low = fmin(a->low, share[i]);
        a->high = fmax(a->high, share[i]);
        if (factor_sky_closed(sky)) {
            a->closed++;
            a->mean += defect;
            a->worst = fmax(a->worst, defect);
        } else if (sky->leaves > 0 || sky->lost > 0) {
            double lacks = fmax(1 - share[i] - (double)sky->buried, 0);
            a->open++;
            a->sky += w->matrix.area[i] * lacks;
            a->sky_most = fmax(a->sky_most, lacks);
        } else {
            a->covered++;
        }
    }
    a->mean /= a->closed ? a->closed : 1;
    a->sky /= all > 0 ? all : 1;
    free(share);
    return 0;
}

static void print(const struct work *w)
{
    const struct account *a = &w->account;
    printf("faces     %u\n", w->scene->input_count);
    printf("links     %zu for %zu pairs of faces, %.3g rays; refine %.2f s, fill %.2f s, write %.2f s\n", w->matrix.link_count,
           w->matrix.value_count, (double)rays_count(w->tree.rays).rays, w->seconds.refine, w->seconds.fill, w->seconds.write);
    printf("row sums  %.9f to %.9f\n", a->low, a->high);
    if (a->closed)
        printf("defect    |1 - sum| %.2e at the most, %.2e in the mean, of %u rows that see no sky%s\n", a->worst, a->mean, a->closed,
               w->o->factor_closure ? ", before closure" : "");
    if (a->open)
        printf("to sky    %.2f %% of what all faces send; up to %.2f %% of one of %u rows; not normalised away\n", 100 * a->sky, 100 * a->sky_most, a->open);
    if (a->covered)
        printf("covered   %u rows that others stand on: their covered parts see nothing\n", a->covered);
    if (w->o->factor_closure)
        printf("closure   factors changed by up to %.2e%s; defect left %.1e\n", w->closure.most,
               w->closure.both ? ", the same both ways" : "; A_i F_ij is no longer A_j F_ji", w->closure.left);
}

static int report(const struct work *w)
{
    const struct options *o = w->o;
    const struct account *a = &w->account;
    if (!o->quiet && !(o->json && strcmp(o->json, "-") == 0))
        print(w);
    if (!o->quiet && a->worst > o->tolerance)
        report_warning(o->scene, 0, "a row sum is off by %.1e, above the tolerance %.1e; a smaller --tolerance takes longer", a->worst, o->tolerance);
    if (!o->json)
        return 0;
    return json_file_write(o->json, json_pack("{s:s, s:i, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:i, s:i, s:i, s:f, s:f, s:s, s:f, s:f, s:f, s:f, s:f, s:f}",
                           "scene", o->scene, "faces", (int)w->scene->input_count, "links", (json_int_t)w->matrix.link_count,
                           "pairs", (json_int_t)w->matrix.value_count, "rays", (json_int_t)rays_count(w->tree.rays).rays,
                           "row_sum_smallest", a->low, "row_sum_largest", a->high,
                           "row_defect_largest", a->worst, "row_defect_mean", a->mean, "rows_closed", (int)a->closed,
                           "rows_to_sky", (int)a->open, "rows_covered", (int)a->covered, "to_sky_largest", a->sky_most, "to_sky_mean", a->sky,
                           "closure", factor_closure_names[o->factor_closure], "closure_largest_change", w->closure.most,
                           "closure_defect_left", w->closure.left, "seconds", w->seconds.refine + w->seconds.fill + w->seconds.write,
                           "seconds_refine", w->seconds.refine, "seconds_fill", w->seconds.fill, "seconds_write", w->seconds.write));
}

static int run(struct work *w)
{
    const struct options *o = w->o;
    double start = seconds(), now;
    if (refine(w) < 0)
        return -1;
    now = seconds();
    w->seconds.refine = now - start;
    progress_say(&w->progress, "factors of %zu links", w->refinement.link_count);
    if (factor_matrix_open(&w->matrix, &w->tree, w->scene, &w->refinement, near(o), o->threads) < 0 || take_account(w) < 0
        || factor_closure_make(&w->closure, o->factor_closure, &w->matrix, w->sums, w->sky) < 0)
        return report_error(o->scene, 0, "out of memory; a larger --tolerance needs less");
    start = now;
    now = seconds();
    w->seconds.fill = now - start;
    progress_say(&w->progress, "write %u rows", w->scene->input_count);
    if ((o->out && factor_file_write(o->out, o->format, &w->matrix, &w->closure, o->threads) < 0)
        || (o->names && factor_file_names(o->names, w->scene) < 0))
        return -1;
    w->seconds.write = seconds() - now;
    progress_end(&w->progress);
    return report(w);
}

int command_viewfactors(const struct options *o, const struct scene *scene)
{
    struct work w = { .o = o, .scene = scene };
    const char *cause;
    int status;
    if (factor_tree_open(&w.tree, scene->faces, scene->face_count, o->threads, &cause) < 0)
        return report_error(o->scene, 0, "%s", cause), 1;
    progress_start(&w.progress, o->quiet);
    status = run(&w) < 0;
    progress_end(&w.progress);
    free(w.sums);
    free(w.sky);
    factor_closure_free(&w.closure);
    factor_matrix_close(&w.matrix);
    refinement_close(&w.refinement);
    factor_tree_close(&w.tree);
    return status;
}
