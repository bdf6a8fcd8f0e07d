/* study_form_factors.c - `radiosity study form-factors`: what each way to compute a form factor is
 * off by, and what it costs, over the pairs that an oracle links.
 *
 * The scene is solved once; then the form factor of every link between surfaces is computed by each
 * level of the term, as if nothing stood between, and the light anew over the same links with the
 * same visibility. Rows are the kinds; error, signed and worst tell how far F is from the contour
 * integral (sums over links of A_r |F - F*| and A_r (F - F*) over that of A_r F*; the largest |F -
 * F*|), reflected what that makes of the light (sum over faces of A rho |H - H*| over that of A rho
 * H*), capped what the solve caps off row sums above 1, as a share: much of what 1 / d^2 brings
 * too much never gets through. The contour's own error is told by an integration of another kind,
 * over some of the links. Further tables go by distance of the centres over the sum of the radii.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>
#include "output/chart.h"
#include "study/factor_kinds.h"
#include "study/study.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/ends_with.h"
#include "util/open_oracle.h"

struct table {
    const struct options *options;
    struct factor_kinds kinds;
};

static double share(double part, double whole)
{
    return whole > 0 ? part / whole : 0;
}

static double error_of(const struct factor_tally *t)
{
    return share(t->off, t->exchange);
}

static double nanoseconds(const struct factor_tally *t)
{
    return 1e9 * share(t->seconds, t->evaluations);
}

/* "0-1", "1-2", ... "16-": the bin's distances. */
static const char *bin_name(int bin, char text[16])
{
    const int low = bin ? 1 << (bin - 1) : 0;
    if (bin == BINS - 1)
        snprintf(text, 16, "%d-", low);
    else
        snprintf(text, 16, "%d-%d", low, 1 << bin);
    return text;
}

/* ---- for people */

static void print_heading(FILE *out, const struct table *t, const char *scene)
{
    const struct factor_kinds *k = &t->kinds;
    fprintf(out, "%s, oracle %s, %zu links of surfaces", scene, t->options->oracle, k->links);
    if (k->left_out)
        fprintf(out, " (and %zu of clusters, left out)", k->left_out);
    fprintf(out,
            "; errors are against contour, and contour's against area integration, itself "
            "right to %.1e, over %zu links",
            k->doubt, k->kind[KIND_CONTOUR].tally[BINS].links);
}

static void print_bin_names(FILE *out, const char *what)
{
    char name[16];
    fprintf(out, "\n%-14s", what);
    for (int b = 0; b < BINS; b++)
        fprintf(out, " %9s", bin_name(b, name));
}

static void print_bins(FILE *out, const struct table *t, const char *what,
                       double (*value)(const struct factor_tally *), double unit)
{
    print_bin_names(out, what);
    fputc('\n', out);
    for (int i = 0; i < KINDS; i++) {
        fprintf(out, "%-14s", t->kinds.kind[i].name);
        for (int b = 0; b < BINS; b++) {
            const struct factor_tally *y = &t->kinds.kind[i].tally[b];
            if (y->links)
                fprintf(out, " %9.3g", unit * value(y));
            else
                fprintf(out, " %9s", "-");
        }
        fputc('\n', out);
    }
}

static void print_table(FILE *out, const struct table *t)
{
    print_heading(out, t, t->options->scene);
    fprintf(out, "\n\n%-14s %8s %8s %9s %9s %12s %9s  %s\n", "kind", "ns each", "error %",
            "signed %", "worst F", "reflected %", "capped %", "looks at");
    for (int i = 0; i < KINDS; i++) {
        const struct factor_kind *k = &t->kinds.kind[i];
        const struct factor_tally *all = &k->tally[BINS];
        fprintf(out, "%-14s %8.0f %8.2g %+9.2g %9.2g ", k->name, nanoseconds(all),
                100 * error_of(all), 100 * share(all->excess, all->exchange), all->worst);
        if (i == KIND_CONTOUR)
            fprintf(out, "%12s", "-");
        else
            fprintf(out, "%12.2g", 100 * k->reflected);
        fprintf(out, " %9.2g  %s\n", 100 * k->capped, k->looks_at);
    }
    fputs("\nby distance of the centres over the sum of the radii", out);
    const struct factor_kind *any = &t->kinds.kind[0];
    print_bin_names(out, "");
    fprintf(out, "\n%-14s", "links %");
    for (int b = 0; b < BINS; b++)
        fprintf(out, " %9.3g", 100 * share((double)any->tally[b].links, (double)t->kinds.links));
    fprintf(out, "\n%-14s", "exchange %");
    for (int b = 0; b < BINS; b++)
        fprintf(out, " %9.3g", 100 * share(any->tally[b].exchange, any->tally[BINS].exchange));
    fputc('\n', out);
    print_bins(out, t, "error %", error_of, 100);
    print_bins(out, t, "ns each", nanoseconds, 1);
}

/* ---- files */

/* A line per kind and bin, then one per kind with both distances empty. */
static void print_csv(FILE *out, const struct table *t)
{
    fputs("kind,distance_from,distance_to,links,compared,exchange_m2,error,signed,worst,ns,"
          "reflected,capped,looks_at\n",
          out);
    for (int i = 0; i < KINDS; i++)
        for (int b = 0; b <= BINS; b++) {
            const struct factor_kind *k = &t->kinds.kind[i];
            const struct factor_tally *y = &k->tally[b], *any = &t->kinds.kind[0].tally[b];
            fprintf(out, "%s,", k->name);
            if (b < BINS)
                fprintf(out, "%d", b ? 1 << (b - 1) : 0);
            fputc(',', out);
            if (b < BINS - 1)
                fprintf(out, "%d", 1 << b);
            fprintf(out, ",%zu,%zu,%.9g,%.6g,%.6g,%.6g,%.4g,", any->links, y->links, any->exchange,
                    error_of(y), share(y->excess, y->exchange), y->worst, nanoseconds(y));
            if (b == BINS && i != KIND_CONTOUR)
                fprintf(out, "%.6g", k->reflected);
            fputc(',', out);
            if (b == BINS)
                fprintf(out, "%.6g", k->capped);
            fprintf(out, ",\"%s\"\n", k->looks_at);
        }
}

static void print_markdown(FILE *out, const struct table *t)
{
    char name[16];
    fputs("`radiosity study form-factors`: ", out);
    print_heading(out, t, path_name(t->options->scene));
    fputs("\n\n| kind | ns each | error, % | signed, % | worst, F | reflected, % | capped, % | "
          "looks at "
          "|\n|---|---|---|---|---|---|---|---|\n",
          out);
    for (int i = 0; i < KINDS; i++) {
        const struct factor_kind *k = &t->kinds.kind[i];
        const struct factor_tally *all = &k->tally[BINS];
        fprintf(out, "| %s | %.0f | %.2g | %+.2g | %.2g | ", k->name, nanoseconds(all),
                100 * error_of(all), 100 * share(all->excess, all->exchange), all->worst);
        if (i == KIND_CONTOUR)
            fputc('-', out);
        else
            fprintf(out, "%.2g", 100 * k->reflected);
        fprintf(out, " | %.2g | %s |\n", 100 * k->capped, k->looks_at);
    }
    fputs(
        "\nError in % (ns each), by distance of the centres over the sum of the radii\n\n| kind |",
        out);
    for (int b = 0; b < BINS; b++)
        fprintf(out, " %s |", bin_name(b, name));
    fputs("\n|---|---|---|---|---|---|---|\n", out);
    for (int i = 0; i < KINDS; i++) {
        fprintf(out, "| %s |", t->kinds.kind[i].name);
        for (int b = 0; b < BINS; b++) {
            const struct factor_tally *y = &t->kinds.kind[i].tally[b];
            if (y->links)
                fprintf(out, " %.2g (%.0f) |", 100 * error_of(y), nanoseconds(y));
            else
                fputs(" - |", out);
        }
        fputc('\n', out);
    }
}

static int write_table(const char *path, const struct table *t)
{
    struct atomic_file file;
    if (atomic_open(&file, path))
        return -1;
    (ends_with(path, ".md") ? print_markdown : print_csv)(file.stream, t);
    return atomic_commit(&file);
}

/* One curve or point per kind that has an error which a logarithm can show. */
static void plot_kinds(FILE *out, const struct table *t, const char *data, const char *with)
{
    const char *between = "plot ";
    for (int i = 0; i < KINDS; i++)
        if (error_of(&t->kinds.kind[i].tally[BINS]) > 0) {
            fprintf(out, "%s$%s%d with %s linetype %d pointtype %d title '%s'", between, data, i,
                    with, i + 1, i + 4, t->kinds.kind[i].name);
            between = ", ";
        }
    fputc('\n', out);
}

/* Two drawings side by side: error against cost, a point per kind; error against distance, a curve
 * per kind. */
static void print_plot(FILE *out, const void *context)
{
    const struct table *t = context;
    char name[16];
    for (int i = 0; i < KINDS; i++) {
        const struct factor_tally *tally = t->kinds.kind[i].tally;
        fprintf(out, "$cost%d << EOD\n%.6g %.6g\nEOD\n$by%d << EOD\n", i, nanoseconds(&tally[BINS]),
                100 * error_of(&tally[BINS]), i);
        for (int b = 0; b < BINS; b++)
            if (error_of(&tally[b]) > 0)
                fprintf(out, "%d %.6g\n", b, 100 * error_of(&tally[b]));
        fputs("EOD\n", out);
    }
    fputs("set multiplot layout 1,2\nset logscale y\nset format y '%g'\nset grid\nset key below "
          "noenhanced\nset ylabel 'error of form factors, %'\n"
          "set xlabel 'ns each'\nset logscale x\nset format x '10^{%L}'\nset xrange [1:1e6]\n",
          out);
    plot_kinds(out, t, "cost", "points pointsize 1.5");
    fprintf(out,
            "unset logscale x\nset format x\nset xlabel 'distance over sum of radii'\nset xrange "
            "[-0.5:%g]\nset xtics (",
            BINS - 0.5);
    for (int b = 0; b < BINS; b++)
        fprintf(out, "%s'%s' %d", b ? ", " : "", bin_name(b, name), b);
    fputs(")\n", out);
    plot_kinds(out, t, "by", "linespoints");
    fputs("unset multiplot\n", out);
}

int study_form_factors(const struct options *o, const struct open_scene *scene)
{
    const struct RadSolveOptions how = solve_options(o);
    struct table t = {.options = o};
    struct solved s;
    struct progress progress;
    progress_start(&progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, progress_show, &progress);
    RadOracle oracle =
        open_oracle(scene->device, o->oracle, o->release, o->settings, o->setting_count);
    if (!oracle)
        return 1;
    int status = solved_open(&s, scene->device, o->scene, scene->scene, oracle, &how);
    int unfinished = 0;
    if (status == 0) {
        unfinished = solved_status(&s.report, o->scene);
        status = factor_kinds_measure(&t.kinds, &s, scene->device, o->scene, &progress);
        solved_close(&s);
    }
    progress_end(&progress);
    radReleaseOracle(oracle);
    if (status < 0)
        return 1;
    if (!o->quiet)
        print_table(stdout, &t);
    return (o->out && write_table(o->out, &t) < 0)
                   || (o->chart && chart_draw(o->chart, print_plot, &t) < 0)
               ? 1
               : unfinished;
}
