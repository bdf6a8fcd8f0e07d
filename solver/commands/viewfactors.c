/* viewfactors.c - `radiosity viewfactors`: the matrix of face-to-face view factors (engine/exchange.h).
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "util/clock.h"
#include "commands/commands.h"
#include "output/factor_file.h"
#include "output/json_file.h"
#include "progress.h"
#include "util/report.h"

static int show_round(void *context, const struct exchange *x, const char *phase)
{
    const struct refinement *r = &x->refinement;
    if (phase[0] == 'f')
        progress_say(context, "factors of %zu links", r->link_count);
    else
        progress_say(context, "refine round %llu: %.3g pairs (%zu waiting), %.3g links, %.3g rays", (unsigned long long)r->rounds,
                     (double)r->pairs, r->queue_count, (double)r->link_count, (double)rays_count(x->tree.rays).rays);
    return 0;
}

static void print(const struct options *o, const struct scene *scene, const struct exchange_report *r, double write)
{
    printf("faces     %u\n", scene->input_count);
    printf("links     %llu for %llu pairs of faces, %.3g rays; refine %.2f s, fill %.2f s, write %.2f s\n", (unsigned long long)r->links,
           (unsigned long long)r->pairs, (double)r->rays, r->seconds.refine, r->seconds.fill, write);
    printf("row sums  %.9f to %.9f\n", r->low, r->high);
    if (r->rows_closed)
        printf("defect    |1 - sum| %.2e at the most, %.2e in the mean, of %u rows that see no sky%s\n", r->defect_most, r->defect_mean, r->rows_closed,
               o->closure != CLOSURE_NONE ? ", before closure" : "");
    if (r->rows_open)
        printf("to sky    %.2f %% of what all faces send; up to %.2f %% of one of %u rows; not normalised away\n", 100 * r->environment_mean,
               100 * r->environment_most, r->rows_open);
    if (r->rows_covered)
        printf("covered   %u rows that others stand on: their covered parts see nothing\n", r->rows_covered);
    if (o->closure != CLOSURE_NONE)
        printf("closure   factors changed by up to %.2e%s; defect left %.1e\n", r->closure_change,
               o->closure == CLOSURE_RECIPROCAL ? ", the same both ways" : "; A_i F_ij is no longer A_j F_ji", r->closure_left);
}

static int report(const struct options *o, const struct scene *scene, const struct exchange_report *r, double write)
{
    if (!o->quiet && !(o->json && strcmp(o->json, "-") == 0))
        print(o, scene, r, write);
    if (!o->quiet && r->defect_most > o->tolerance)
        report_warning(o->scene, 0, "a row sum is off by %.1e, above the tolerance %.1e; a smaller --tolerance takes longer", r->defect_most, o->tolerance);
    if (!o->json)
        return 0;
    return json_file_write(o->json, json_pack("{s:s, s:i, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:i, s:i, s:i, s:f, s:f, s:s, s:f, s:f, s:f, s:f, s:f, s:f}",
                           "scene", o->scene, "faces", (int)scene->input_count, "links", (json_int_t)r->links,
                           "pairs", (json_int_t)r->pairs, "rays", (json_int_t)r->rays, "row_sum_smallest", r->low, "row_sum_largest", r->high,
                           "row_defect_largest", r->defect_most, "row_defect_mean", r->defect_mean, "rows_closed", (int)r->rows_closed,
                           "rows_to_sky", (int)r->rows_open, "rows_covered", (int)r->rows_covered, "to_sky_largest", r->environment_most,
                           "to_sky_mean", r->environment_mean, "closure", closure_names[o->closure], "closure_largest_change", r->closure_change,
                           "closure_defect_left", r->closure_left, "seconds", r->seconds.refine + r->seconds.fill + write,
                           "seconds_refine", r->seconds.refine, "seconds_fill", r->seconds.fill, "seconds_write", write));
}

static int write_and_report(const struct options *o, const struct scene *scene, const struct exchange *x, struct progress *progress)
{
    double start = seconds();
    progress_say(progress, "write %u rows", scene->input_count);
    if ((o->out && factor_file_write(o->out, o->format, x, o->threads) < 0) || (o->names && factor_file_names(o->names, scene) < 0))
        return -1;
    double write = seconds() - start;
    progress_end(progress);
    return report(o, scene, &x->report, write);
}

int command_viewfactors(const struct options *o, const struct scene *scene)
{
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    struct progress progress;
    struct exchange x;
    const char *cause;
    int status = -1;
    if (!refiner)
        return 1;
    exchange_set_tolerance(refiner, o->tolerance);
    if (oracles_set(refiner, o->settings, o->setting_count) == 0) {
        const struct exchange_options how = { o->tolerance, o->closure, o->threads, show_round, &progress };
        progress_start(&progress, o->quiet);
        if (exchange_open(&x, scene, refiner, &how, &cause) < 0) {
            progress_end(&progress);
            report_error(o->scene, 0, "%s", cause);
        } else {
            status = write_and_report(o, scene, &x, &progress);
            progress_end(&progress);
            exchange_close(&x);
        }
    }
    refiner_close(refiner);
    return status < 0;
}
