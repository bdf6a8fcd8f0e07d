/* study_visibility.c - `radiosity study visibility`: how often are few rays wrong about visibility?
 *
 * The paper's section 5: a branch before a normal refiner asks visibility tools with few rays about
 * every pair whose projected areas are below a threshold, and holds the answers against a
 * reference. All of that is the graph examples/oracles/tester.dag; here only its parameters are
 * set, and the counts of its arcs read: the nodes none__first, partial__first and all__first are
 * the first tool's answers where the reference said none, partial and all, and so for second and
 * third. An answer is wrong when it is not the reference's.
 *
 * Intervals are Wilson's, at 95 %: p is known from n answers to
 * (p + z^2/2n +- z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n), z = 1.96 [Wilson 1927]. They take
 * pairs for independent, which neighbours are not, so they are a lower bound of what is not known.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "util/atomic_file.h"
#include "output/chart.h"
#include "study/study.h"
#include "util/device.h"
#include "util/open_oracle.h"
#include "util/solved.h"
#include "util/progress.h"
#include "util/report.h"

enum { TOOLS = 3, CLASSES = 3 }; /* tested by one run of the graph; none, partial, all */

static const char *const class_names[CLASSES] = {"none", "partial", "all"};

/* What one tool answered at one threshold: matrix[reference][answer]. */
struct cell {
    uint64_t matrix[CLASSES][CLASSES];
};

struct table {
    struct cell cells[STUDY_LIST][STUDY_LIST]; /* [threshold][rays] */
    double area[STUDY_LIST];                   /* thresholds in m2 */
};

struct verdict {
    uint64_t asked, wrong;
    double part, low, high; /* wrong / asked, and the interval */
};

static struct verdict judge(const struct cell *c)
{
    const double z = 1.959963984540054;
    struct verdict v = {0, 0, 0, 0, 1};
    for (int i = 0; i < CLASSES; i++)
        for (int k = 0; k < CLASSES; k++) {
            v.asked += c->matrix[i][k];
            v.wrong += i == k ? 0 : c->matrix[i][k];
        }
    if (!v.asked)
        return v;
    double n = (double)v.asked;
    v.part = (double)v.wrong / n;
    double middle = v.part + z * z / (2 * n);
    double half = z * sqrt(v.part * (1 - v.part) / n + z * z / (4 * n * n));
    v.low = v.wrong ? (middle - half) / (1 + z * z / n) : 0;
    v.high = (middle + half) / (1 + z * z / n);
    return v;
}

/* Read the confusion matrix of each tool off the arcs. */
static void read_counts(const struct RadStatistics *s, struct cell *cells, int tools)
{
    static const char *const nodes[TOOLS] = {"first", "second", "third"};
    for (int t = 0; t < tools; t++)
        for (int i = 0; i < CLASSES; i++) {
            char name[32];
            snprintf(name, sizeof name, "%s__%s", class_names[i], nodes[t]);
            for (int n = 0; n < s->node_count; n++)
                for (int k = 0; k < CLASSES && strcmp(s->nodes[n].name, name) == 0; k++)
                    cells[t].matrix[i][k] =
                        s->nodes[n].answers[k].count; /* the tool declares none, partial, all */
        }
}

/* Oracle tester at one threshold with one, two or three numbers of rays. Returns NULL after a
 * message. */
static RadOracle open_tester(RadDevice device, const struct options *o, double threshold,
                             const int *rays, int tools)
{
    char settings[4][64], *all[4];
    snprintf(settings[0], sizeof settings[0], "threshold=%.17g", threshold);
    snprintf(settings[1], sizeof settings[1], "rays_1=%d", rays[0]);
    snprintf(settings[2], sizeof settings[2], "rays_2=%d", rays[tools > 1 ? 1 : 0]);
    snprintf(settings[3], sizeof settings[3], "rays_3=%d", rays[tools - 1]);
    for (int i = 0; i < 4; i++)
        all[i] = settings[i];
    RadOracle oracle = open_oracle(device, "tester", RAD_RELEASE_DAG, all, 4);
    if (!oracle)
        return NULL;
    if (set_oracle(device, oracle, o->settings, o->setting_count) == 0) {
        if (radCountOracle(oracle) == 0)
            return oracle;
        report_device(device, o->scene);
    }
    radReleaseOracle(oracle);
    return NULL;
}

/* One solve with the tester: up to three numbers of rays at one threshold. */
static int run(const struct options *o, const struct open_scene *scene, struct progress *progress,
               double threshold, const int *rays, int tools, struct cell *cells, double *area)
{
    const struct RadSolveOptions how = solve_options(o);
    RadOracle oracle = open_tester(scene->device, o, threshold, rays, tools);
    if (!oracle)
        return -1;
    struct solved s;
    *area = threshold
            * fmax(radGetOracleParameter(oracle, "unit"),
                   radGetOracleParameter(oracle, "unit_share") * scene->report.area);
    int result = solved_open(&s, scene->device, o->scene, scene->scene, oracle, &how);
    progress_end(progress);
    if (result == 0) {
        struct RadStatistics statistics;
        result = radGetOracleStatistics(oracle, &statistics) < 0
                     ? report_device(scene->device, o->scene)
                     : 0;
        if (result == 0)
            read_counts(&statistics, cells, tools);
        solved_close(&s);
    }
    radReleaseOracle(oracle);
    return result;
}

static void print_row(FILE *out, const struct options *o, const struct table *t, int row)
{
    struct verdict v = judge(&t->cells[row][0]);
    fprintf(out, "%9.4g %10.4g %10llu", o->thresholds[row], t->area[row],
            (unsigned long long)v.asked);
    for (int k = 0; k < o->ray_count; k++) {
        v = judge(&t->cells[row][k]);
        if (v.asked)
            fprintf(out, "   %5.2f [%5.2f, %5.2f]", 100 * v.part, 100 * v.low, 100 * v.high);
        else
            fprintf(out, "   %5s %16s", "-", "");
    }
    fputc('\n', out);
}

static void print_head(FILE *out, const struct options *o)
{
    fprintf(
        out,
        "wrong answers in %%, [95 %% interval]; thresholds of projected area, in units and m2\n");
    fprintf(out, "threshold         m2      pairs");
    for (int k = 0; k < o->ray_count; k++)
        fprintf(out, "   %9d rays       ", o->rays[k]);
    fputc('\n', out);
}

/* A line per threshold and number of rays; none_as_all: the reference said none, the tool all. */
static void print_csv(FILE *out, const struct options *o, const struct table *t)
{
    fputs("threshold,area_m2,rays,pairs,wrong,percent,percent_low,percent_high", out);
    for (int a = 0; a < CLASSES; a++)
        for (int b = 0; b < CLASSES; b++)
            fprintf(out, ",%s_as_%s", class_names[a], class_names[b]);
    fputc('\n', out);
    for (int i = 0; i < o->threshold_count; i++)
        for (int k = 0; k < o->ray_count; k++) {
            const struct verdict v = judge(&t->cells[i][k]);
            fprintf(out, "%.9g,%.9g,%d,%llu,%llu,%.9g,%.9g,%.9g", o->thresholds[i], t->area[i],
                    o->rays[k], (unsigned long long)v.asked, (unsigned long long)v.wrong,
                    100 * v.part, 100 * v.low, 100 * v.high);
            for (int a = 0; a < CLASSES; a++)
                for (int b = 0; b < CLASSES; b++)
                    fprintf(out, ",%llu", (unsigned long long)t->cells[i][k].matrix[a][b]);
            fputc('\n', out);
        }
}

static int write_csv(const char *path, const struct options *o, const struct table *t)
{
    struct atomic_file file;
    if (atomic_open(&file, path))
        return -1;
    print_csv(file.stream, o, t);
    return atomic_commit(&file);
}

struct drawing {
    const struct options *options;
    const struct table *table;
};

/* The paper's figure 5: wrong answers against threshold, a curve per number of rays. */
static void print_plot(FILE *out, const void *context)
{
    const struct options *o = ((const struct drawing *)context)->options;
    const struct table *t = ((const struct drawing *)context)->table;
    int drawn = 0, last = 0;
    for (int i = 0; i < o->threshold_count; i++)
        if (judge(&t->cells[i][0]).asked) {
            drawn++;
            last = i;
        }
    if (drawn == 1) /* gnuplot warns of a range without width */
        fprintf(out, "set xrange [%.9g:%.9g]\n", 0.9 * o->thresholds[last],
                1.1 * o->thresholds[last]);
    fprintf(out, "set xlabel 'projected area below, units'\nset ylabel 'wrong answers, %%'\nset "
                 "yrange [0:*]\nset key left top\nset grid\n");
    for (int k = 0; k < o->ray_count; k++) {
        fprintf(out, "$rays%d << EOD\n", k);
        for (int i = 0; i < o->threshold_count; i++) {
            const struct verdict v = judge(&t->cells[i][k]);
            if (v.asked)
                fprintf(out, "%.9g %.9g %.9g %.9g\n", o->thresholds[i], 100 * v.part, 100 * v.low,
                        100 * v.high);
        }
        fprintf(out, "EOD\n");
    }
    fprintf(out, "plot ");
    for (int k = 0; k < o->ray_count; k++)
        fprintf(out, "%s$rays%d with yerrorlines pointtype %d title '%d rays'", k ? ", " : "", k,
                k + 4, o->rays[k]);
    fputc('\n', out);
}

static int write_chart(const struct options *o, const struct table *t)
{
    const struct drawing d = {o, t};
    int drawn = 0;
    for (int i = 0; i < o->threshold_count; i++)
        drawn += judge(&t->cells[i][0]).asked > 0;
    if (!drawn)
        return report_error(o->chart, 0,
                            "no pair was tested, so there is nothing to draw; raise --thresholds, "
                            "or try a scene of more faces");
    return chart_draw(o->chart, print_plot, &d);
}

int study_visibility(const struct options *o, const struct open_scene *scene)
{
    struct table *t = calloc(1, sizeof *t);
    int status = 1;
    if (!t)
        return report_error(o->scene, 0, "out of memory") ? 1 : 0;
    struct progress progress;
    progress_start(&progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, progress_show, &progress);
    if (!o->quiet)
        print_head(stdout, o);
    for (int i = 0; i < o->threshold_count; i++) {
        for (int k = 0; k < o->ray_count; k += TOOLS)
            if (run(o, scene, &progress, o->thresholds[i], &o->rays[k],
                    o->ray_count - k < TOOLS ? o->ray_count - k : TOOLS, &t->cells[i][k],
                    &t->area[i])
                < 0)
                goto done;
        if (!o->quiet) {
            print_row(stdout, o, t, i);
            fflush(stdout);
        }
    }
    status = (o->out && write_csv(o->out, o, t) < 0) || (o->chart && write_chart(o, t) < 0);
done:
    free(t);
    return status;
}
