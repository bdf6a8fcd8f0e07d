/* study_visibility.c - `radiosity study visibility`: how often are few rays wrong about visibility?
 *
 * The paper's section 5: a branch before a normal refiner asks visibility tools with few rays about
 * every pair whose projected areas are below a threshold, and holds the answers against a
 * reference. All of that is the graph examples/oracles/tester.dag; here its parameters are set, the
 * counts of its arcs read (reliability.h), and said which tool is good enough for which projected
 * areas. An answer is wrong when it is not the reference's.
 *
 * One solve serves eight thresholds. Between its rounds, when nobody asks the oracle, the counts
 * are read, and the share of pairs that is drawn under a threshold is halved when enough have been;
 * the rounds do not depend on threads or time, so neither do the tables. A run that is stopped, by
 * SIGINT, SIGTERM or --limit-seconds, ends at such a place, too, and what has been counted is a
 * table of the pairs discussed until then: it is printed and written, marked as partial, and the
 * exit status is 130 or 3.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "output/chart.h"
#include "study/reliability.h"
#include "study/study.h"
#include "util/atomic_file.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/open_oracle.h"
#include "util/progress.h"
#include "util/report.h"
#include "util/solved.h"

enum { STOPPED = 130, OUT_OF_TIME = 3 }; /* exit statuses, as of reference and of solve */

static volatile sig_atomic_t stop; /* the signal that asked for it */

static void on_signal(int number)
{
    stop = number;
}

/* SIGINT and SIGTERM stop it after the round; a second one at once. */
static void watch_signals(void (*handler)(int))
{
    struct sigaction action = {.sa_flags = (int)SA_RESETHAND};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

struct study {
    const struct options *o;
    const struct open_scene *scene;
    struct bin bins[STUDY_LIST]; /* by threshold */
    double unit;                 /* the area unit, m2 */
    struct progress progress;
    double start; /* of the clock, s */
    int status;   /* STOPPED or OUT_OF_TIME: the tables are partial */

    /* The solve that is going on. */
    RadOracle oracle;
    int first, count; /* its thresholds */
    int slot;         /* of the graph's eight, the first one's place, from 0 */
    double tested[BINS_OF_SOLVE];
};

/* ---- a solve with oracle tester */

/* Set one of the parameters NAME_1, NAME_2, ..., the first of which is 0 here. */
static int set_number(struct study *s, const char *name, int i, double value)
{
    char numbered[32];
    snprintf(numbered, sizeof numbered, "%s_%d", name, i + 1);
    return radSetOracleParameter(s->oracle, numbered, value);
}

static double get_tested(struct study *s, int i)
{
    char numbered[32];
    snprintf(numbered, sizeof numbered, "tested_%d", i + 1);
    return radGetOracleParameter(s->oracle, numbered);
}

/* A solve for later thresholds draws none of the pairs below those before, whose place is slot 0.
 * Returns 0, or -1 after a message. */
static int set_tester(struct study *s)
{
    const struct options *o = s->o;
    int status = set_oracle(s->scene->device, s->oracle, o->settings, o->setting_count);
    if (status < 0)
        return -1;
    for (int i = 0; i < s->slot; i++)
        status |= set_number(s, "threshold", i, o->thresholds[s->first - 1])
                  | set_number(s, "tested", i, 0);
    for (int i = s->slot; i < BINS_OF_SOLVE; i++) {
        int given = i - s->slot < s->count;
        s->tested[i] = get_tested(s, i);
        status |= set_number(s, "threshold", i, given ? o->thresholds[s->first + i - s->slot] : 0);
    }
    for (int k = 0; k < RAY_TOOLS; k++)
        status |= set_number(s, "rays", k, o->rays[k < o->ray_count ? k : o->ray_count - 1]);
    return status < 0 ? report_device(s->scene->device, o->scene) : 0;
}

/* Between rounds: halve the share that is drawn of the pairs of which enough have been. */
static int draw_fewer(struct study *s)
{
    struct RadStatistics statistics;
    if (radGetOracleStatistics(s->oracle, &statistics) < 0)
        return -1;
    struct bin *bins = &s->bins[s->first];
    read_bins(bins, s->count, s->slot, &statistics);
    for (int i = 0; i < s->count; i++) {
        if (period_drawn(&bins[i]) < period_length(&bins[i], s->o->ray_count, s->o->within)
            || next_period(&bins[i]) < 0)
            continue;
        s->tested[s->slot + i] /= 2;
        if (set_number(s, "tested", s->slot + i, s->tested[s->slot + i]) < 0)
            return -1;
    }
    return 0;
}

/* The device's progress function. */
static int after_round(void *user, const struct RadProgress *at)
{
    struct study *s = user;
    if (strcmp(at->phase, "refine") == 0 && draw_fewer(s) < 0)
        return -1;
    if (stop)
        s->status = STOPPED;
    else if (s->o->limit_seconds && seconds() - s->start > s->o->limit_seconds)
        s->status = OUT_OF_TIME;
    return s->status ? -1 : progress_show(&s->progress, at);
}

/* Refine from the root, and then as often as is asked for solve, and discuss the links again in
 * that light. Returns 0, or -1 after a message, or without one when s->status says why. */
static int run_passes(struct study *s)
{
    RadDevice device = s->scene->device;
    struct RadSolveOptions how = solve_options(s->o);
    how.iterations = 0; /* the option means passes here */
    struct solved solved;
    if (solved_begin(&solved, device, s->o->scene, s->scene->scene, s->oracle, &how) < 0)
        return -1;
    int more = radRefine(solved.solution) < 0 ? -1 : 1;
    for (int pass = 1; pass < s->o->iterations && more > 0; pass++)
        more = radStep(solved.solution);
    progress_end(&s->progress);
    solved_close(&solved);
    if (more >= 0)
        return 0;
    if (s->status)
        (void)radGetDeviceError(device); /* it was cancelled, and that is no error */
    else
        report_device(device, s->o->scene);
    return -1;
}

/* The solve for the thresholds from s->first on that it has places for. Returns 0, or -1 as
 * run_passes. */
static int run(struct study *s)
{
    s->slot = s->first > 0;
    s->count = s->o->threshold_count - s->first;
    if (s->count > BINS_OF_SOLVE - s->slot)
        s->count = BINS_OF_SOLVE - s->slot;
    for (int i = 0; i < s->count; i++)
        s->bins[s->first + i].count = 1;
    s->oracle = open_oracle(s->scene->device, "tester", RAD_RELEASE_DAG, NULL, 0);
    if (!s->oracle)
        return -1;
    int result = set_tester(s);
    if (result == 0) {
        s->unit = fmax(radGetOracleParameter(s->oracle, "unit"),
                       radGetOracleParameter(s->oracle, "unit_share") * s->scene->report.area);
        result = radCountOracle(s->oracle) < 0 ? report_device(s->scene->device, s->o->scene)
                                               : run_passes(s);
    }
    radReleaseOracle(s->oracle);
    return result;
}

/* ---- tables */

static const char *const class_names[CLASSES + 1] = {"none", "partial", "all", "unknown"};

/* What the tool is called. */
static const char *tool_name(const struct study *s, int tool, char text[24])
{
    if (tool < RAY_TOOLS)
        snprintf(text, 24, "%d rays", s->o->rays[tool]);
    else
        snprintf(text, 24, "%s", tool == TOOL_SHAFT ? "shaft" : "outline");
    return text;
}

/* The tool after `tool` in tables: the numbers of rays that were asked for, then the others.
 * STUDY_TOOLS: there is none. */
static int next_tool(const struct study *s, int tool)
{
    tool++;
    return tool >= s->o->ray_count && tool < RAY_TOOLS ? RAY_TOOLS : tool;
}

static void print_verdict(const struct verdict *v)
{
    if (v->asked && v->answered > 0)
        printf("   %5.2f [%5.2f, %5.2f]", 100 * v->part, 100 * v->low, 100 * v->high);
    else
        printf("   %5s %16s", "-", "");
}

static void print_rays(const struct study *s)
{
    const struct options *o = s->o;
    puts("wrong answers in %, [95 % interval]; thresholds of projected area, in units and m2");
    printf("threshold         m2      pairs   tested");
    for (int k = 0; k < o->ray_count; k++)
        printf("   %9d rays       ", o->rays[k]);
    putchar('\n');
    for (int i = 0; i < o->threshold_count; i++) {
        struct verdict v = judge(s->bins, i + 1, 0);
        printf("%9.4g %10.4g %10llu %8llu", o->thresholds[i], o->thresholds[i] * s->unit,
               (unsigned long long)v.pairs, (unsigned long long)v.asked);
        for (int k = 0; k < o->ray_count; k++) {
            v = judge(s->bins, i + 1, k);
            print_verdict(&v);
        }
        putchar('\n');
    }
}

static void print_faces(const struct study *s)
{
    puts("pairs that the shaft knows for certain, and wrong answers of outlines, in %\n"
         "threshold     tested      shaft known             outlines, or 64 rays");
    for (int i = 0; i < s->o->threshold_count; i++) {
        const struct verdict shaft = judge(s->bins, i + 1, TOOL_SHAFT),
                             outline = judge(s->bins, i + 1, TOOL_OUTLINE);
        printf("%9.4g %10llu %16.2f          ", s->o->thresholds[i],
               (unsigned long long)shaft.asked, 100 * shaft.answered);
        print_verdict(&outline);
        putchar('\n');
    }
}

/* A line per threshold and tool, of all pairs below the threshold; none_as_all: of those that were
 * drawn, the reference said none, the tool all. */
static void print_csv(FILE *out, const struct study *s)
{
    fputs("threshold,area_m2,tool,pairs,tested,known_percent,wrong,percent,percent_low,"
          "percent_high",
          out);
    for (int a = 0; a < CLASSES; a++)
        for (int b = 0; b <= CLASSES; b++)
            fprintf(out, ",%s_as_%s", class_names[a], class_names[b]);
    fputs(",complete\n", out);
    for (int i = 0; i < s->o->threshold_count; i++)
        for (int t = 0; t < STUDY_TOOLS; t = next_tool(s, t)) {
            const struct verdict v = judge(s->bins, i + 1, t);
            char name[24];
            fprintf(out, "%.9g,%.9g,%s,%llu,%llu,%.9g,%llu,%.9g,%.9g,%.9g", s->o->thresholds[i],
                    s->o->thresholds[i] * s->unit, tool_name(s, t, name),
                    (unsigned long long)v.pairs, (unsigned long long)v.asked, 100 * v.answered,
                    (unsigned long long)v.wrong, 100 * v.part, 100 * v.low, 100 * v.high);
            for (int a = 0; a < CLASSES; a++)
                for (int b = 0; b <= CLASSES; b++)
                    fprintf(out, ",%llu",
                            (unsigned long long)count_answers(s->bins, i + 1, t, a, b));
            fprintf(out, ",%d\n", s->status == 0);
        }
}

static int write_csv(const struct study *s)
{
    struct atomic_file file;
    if (atomic_open(&file, s->o->out))
        return -1;
    print_csv(file.stream, s);
    return atomic_commit(&file);
}

/* ---- the chart */

/* The paper's figure 5: wrong answers against threshold, a curve per number of rays; and one for
 * outlines. */
static void print_plot(FILE *out, const void *context)
{
    const struct study *s = context;
    const struct options *o = s->o;
    int drawn = 0, last = 0;
    for (int i = 0; i < o->threshold_count; i++)
        if (judge(s->bins, i + 1, 0).asked) {
            drawn++;
            last = i;
        }
    if (drawn == 1) /* gnuplot warns of a range without width */
        fprintf(out, "set xrange [%.9g:%.9g]\n", 0.9 * o->thresholds[last],
                1.1 * o->thresholds[last]);
    if (s->status)
        fprintf(out, "set title 'partial: stopped before all pairs were discussed'\n");
    fprintf(out, "set xlabel 'projected area below, units'\nset ylabel 'wrong answers, %%'\nset "
                 "yrange [0:*]\nset key left top\nset grid\n");
    for (int t = 0; t < STUDY_TOOLS; t = next_tool(s, t)) {
        fprintf(out, "$tool%d << EOD\n", t);
        for (int i = 0; i < o->threshold_count; i++) {
            const struct verdict v = judge(s->bins, i + 1, t);
            if (v.asked)
                fprintf(out, "%.9g %.9g %.9g %.9g\n", o->thresholds[i], 100 * v.part, 100 * v.low,
                        100 * v.high);
        }
        fprintf(out, "EOD\n");
    }
    fprintf(out, "plot ");
    for (int t = 0; t < STUDY_TOOLS; t = next_tool(s, t)) {
        char name[24];
        if (t != TOOL_SHAFT)
            fprintf(out, "%s$tool%d with yerrorlines pointtype %d title '%s'", t ? ", " : "", t,
                    t + 4, tool_name(s, t, name));
    }
    fputc('\n', out);
}

static int write_chart(const struct study *s)
{
    if (!judge(s->bins, s->o->threshold_count, 0).asked)
        return report_error(s->o->chart, 0,
                            "no pair was tested, so there is nothing to draw; raise --thresholds, "
                            "or try a scene of more faces");
    return chart_draw(s->o->chart, print_plot, s);
}

/* ---- which tool for which projected areas */

/* How far the tool is good enough from bin `from` on: the most bins of which, taken together, no
 * more than --wrong of the answers are, by the upper end of the interval, and none of which is
 * surely worse by itself. */
static int good_until(const struct study *s, int from, int tool)
{
    int until = from;
    for (int i = from; i < s->o->threshold_count; i++) {
        const struct verdict own = judge(&s->bins[i], 1, tool),
                             all = judge(&s->bins[from], i + 1 - from, tool);
        if (own.asked && own.low > s->o->wrong)
            break;
        if (own.asked && all.high <= s->o->wrong)
            until = i + 1;
    }
    return until;
}

/* The cheapest tool that is good enough, from the smallest areas up, and what that is as settings
 * of oracle by_reliability. */
static void print_choice(const struct study *s)
{
    static const int known[] = {4, 16, 64};
    double share[3] = {0, 0, 0}, area = s->scene->report.area;
    const struct options *o = s->o;
    int from = 0;
    printf("good enough, with at most %.4g %% wrong answers:\n", 100 * o->wrong);
    for (int t = 0; t < STUDY_TOOLS; t = next_tool(s, t)) {
        int until = t == TOOL_SHAFT ? from : good_until(s, from, t);
        if (until > from) {
            const struct verdict v = judge(&s->bins[from], until - from, t);
            char name[24];
            printf("  %-8s %s %.4g units, %.4g m2: %.2f %% of %llu pairs\n", tool_name(s, t, name),
                   from ? "from there to" : "below", o->thresholds[until - 1],
                   o->thresholds[until - 1] * s->unit, 100 * v.part, (unsigned long long)v.pairs);
        }
        from = until;
        for (int k = 0; k < 3; k++)
            if (t < RAY_TOOLS && o->rays[t] <= known[k] && from > 0)
                share[k] = o->thresholds[from - 1] * s->unit / area;
    }
    if (from < o->threshold_count)
        printf("  none     %s %.4g units: 64 rays and outlines are wrong more often, or too few "
               "pairs tell\n",
               from ? "above" : "even below", o->thresholds[from ? from - 1 : 0]);
    printf("as settings: --oracle by_reliability --set below_4=%.3g --set below_16=%.3g --set "
           "below_64=%.3g\n",
           share[0], share[1], share[2]);
}

static void print_tables(const struct study *s)
{
    if (s->status)
        printf("partial: %s after %.0f s, so these are the pairs discussed until then\n",
               s->status == STOPPED ? "stopped" : "--limit-seconds came", seconds() - s->start);
    print_rays(s);
    putchar('\n');
    print_faces(s);
    putchar('\n');
    print_choice(s);
}

int study_visibility(const struct options *o, const struct open_scene *scene)
{
    struct study *s = calloc(1, sizeof *s);
    if (!s)
        return report_error(o->scene, 0, "out of memory") ? 1 : 0;
    s->o = o;
    s->scene = scene;
    s->start = seconds();
    progress_start(&s->progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, after_round, s);
    watch_signals(on_signal);
    int failed = 0;
    for (; s->first < o->threshold_count && !failed && !s->status; s->first += s->count)
        failed = run(s) < 0 && !s->status;
    watch_signals(SIG_DFL);
    radSetDeviceProgressFunction(scene->device, NULL, NULL);
    int status = failed ? 1 : s->status;
    if (!failed) {
        if (!o->quiet)
            print_tables(s);
        if ((o->out && write_csv(s) < 0) || (o->chart && write_chart(s) < 0))
            status = 1;
    }
    free(s);
    return status;
}
