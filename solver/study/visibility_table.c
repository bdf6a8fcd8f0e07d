/* visibility_table.c - see visibility_table.h.
 * SPDX-License-Identifier: MIT */
#include "study/visibility_table.h"

#include <stdio.h>

#include "output/chart.h"
#include "util/atomic_file.h"
#include "util/report.h"

static const char *const class_names[CLASSES + 1] = {"none", "partial", "all", "unknown"};

/* What the tool is called. */
static const char *tool_name(const struct visibility_table *t, int tool, char text[24])
{
    if (tool < RAY_TOOLS)
        snprintf(text, 24, "%d rays", t->options->rays[tool]);
    else
        snprintf(text, 24, "%s", tool == TOOL_SHAFT ? "shaft" : "outline");
    return text;
}

/* The tool after `tool` in tables: the numbers of rays that were asked for, then the others.
 * STUDY_TOOLS: there is none. */
static int next_tool(const struct visibility_table *t, int tool)
{
    tool++;
    return tool >= t->options->ray_count && tool < RAY_TOOLS ? RAY_TOOLS : tool;
}

static void print_verdict(const struct verdict *v)
{
    if (v->asked && v->answered > 0)
        printf("   %5.2f [%5.2f, %5.2f]", 100 * v->part, 100 * v->low, 100 * v->high);
    else
        printf("   %5s %16s", "-", "");
}

static void print_rays(const struct visibility_table *t)
{
    const struct options *o = t->options;
    puts("wrong answers in %, [95 % interval]; thresholds of projected area, in units and m2");
    printf("threshold         m2      pairs   tested");
    for (int k = 0; k < o->ray_count; k++)
        printf("   %9d rays       ", o->rays[k]);
    putchar('\n');
    for (int i = 0; i < o->threshold_count; i++) {
        struct verdict v = judge(t->bins, i + 1, 0);
        printf("%9.4g %10.4g %10llu %8llu", o->thresholds[i], o->thresholds[i] * t->unit,
               (unsigned long long)v.pairs, (unsigned long long)v.asked);
        for (int k = 0; k < o->ray_count; k++) {
            v = judge(t->bins, i + 1, k);
            print_verdict(&v);
        }
        putchar('\n');
    }
}

static void print_faces(const struct visibility_table *t)
{
    puts("pairs that the shaft knows for certain, and wrong answers of outlines, in %\n"
         "threshold     tested      shaft known             outlines, or 64 rays");
    for (int i = 0; i < t->options->threshold_count; i++) {
        const struct verdict shaft = judge(t->bins, i + 1, TOOL_SHAFT),
                             outline = judge(t->bins, i + 1, TOOL_OUTLINE);
        printf("%9.4g %10llu %16.2f          ", t->options->thresholds[i],
               (unsigned long long)shaft.asked, 100 * shaft.answered);
        print_verdict(&outline);
        putchar('\n');
    }
}

/* A line per threshold and tool, of all pairs below the threshold; none_as_all: of those that were
 * drawn, the reference said none, the tool all. */
static void print_csv(FILE *out, const struct visibility_table *t)
{
    fputs("threshold,area_m2,tool,pairs,tested,known_percent,wrong,percent,percent_low,"
          "percent_high",
          out);
    for (int a = 0; a < CLASSES; a++)
        for (int b = 0; b <= CLASSES; b++)
            fprintf(out, ",%s_as_%s", class_names[a], class_names[b]);
    fputs(",complete\n", out);
    for (int i = 0; i < t->options->threshold_count; i++)
        for (int k = 0; k < STUDY_TOOLS; k = next_tool(t, k)) {
            const struct verdict v = judge(t->bins, i + 1, k);
            char name[24];
            fprintf(out, "%.9g,%.9g,%s,%llu,%llu,%.9g,%llu,%.9g,%.9g,%.9g",
                    t->options->thresholds[i], t->options->thresholds[i] * t->unit,
                    tool_name(t, k, name), (unsigned long long)v.pairs, (unsigned long long)v.asked,
                    100 * v.answered, (unsigned long long)v.wrong, 100 * v.part, 100 * v.low,
                    100 * v.high);
            for (int a = 0; a < CLASSES; a++)
                for (int b = 0; b <= CLASSES; b++)
                    fprintf(out, ",%llu",
                            (unsigned long long)count_answers(t->bins, i + 1, k, a, b));
            fprintf(out, ",%d\n", !t->partial);
        }
}

int visibility_table_write(const struct visibility_table *t)
{
    struct atomic_file file;
    if (atomic_open(&file, t->options->out))
        return -1;
    print_csv(file.stream, t);
    return atomic_commit(&file);
}

/* ---- the chart */

/* The paper's figure 5: wrong answers against threshold, a curve per number of rays; and one for
 * outlines. */
static void print_plot(FILE *out, const void *context)
{
    const struct visibility_table *t = context;
    const struct options *o = t->options;
    int drawn = 0, last = 0;
    for (int i = 0; i < o->threshold_count; i++)
        if (judge(t->bins, i + 1, 0).asked) {
            drawn++;
            last = i;
        }
    if (drawn == 1) /* gnuplot warns of a range without width */
        fprintf(out, "set xrange [%.9g:%.9g]\n", 0.9 * o->thresholds[last],
                1.1 * o->thresholds[last]);
    if (t->partial)
        fprintf(out, "set title 'partial: stopped before all pairs were discussed'\n");
    fprintf(out, "set xlabel 'projected area below, units'\nset ylabel 'wrong answers, %%'\nset "
                 "yrange [0:*]\nset key left top\nset grid\n");
    for (int k = 0; k < STUDY_TOOLS; k = next_tool(t, k)) {
        fprintf(out, "$tool%d << EOD\n", k);
        for (int i = 0; i < o->threshold_count; i++) {
            const struct verdict v = judge(t->bins, i + 1, k);
            if (v.asked)
                fprintf(out, "%.9g %.9g %.9g %.9g\n", o->thresholds[i], 100 * v.part, 100 * v.low,
                        100 * v.high);
        }
        fprintf(out, "EOD\n");
    }
    fprintf(out, "plot ");
    for (int k = 0; k < STUDY_TOOLS; k = next_tool(t, k)) {
        char name[24];
        if (k != TOOL_SHAFT)
            fprintf(out, "%s$tool%d with yerrorlines pointtype %d title '%s'", k ? ", " : "", k,
                    k + 4, tool_name(t, k, name));
    }
    fputc('\n', out);
}

int visibility_table_draw(const struct visibility_table *t)
{
    if (!judge(t->bins, t->options->threshold_count, 0).asked)
        return report_error(t->options->chart, 0,
                            "no pair was tested, so there is nothing to draw; raise --thresholds, "
                            "or try a scene of more faces");
    return chart_draw(t->options->chart, print_plot, t);
}

/* ---- which tool for which projected areas */

/* How far the tool is good enough from bin `from` on: the most bins of which, taken together, no
 * more than --wrong of the answers are, by the upper end of the interval, and none of which is
 * surely worse by itself. */
static int good_until(const struct visibility_table *t, int from, int tool)
{
    int until = from;
    for (int i = from; i < t->options->threshold_count; i++) {
        const struct verdict own = judge(&t->bins[i], 1, tool),
                             all = judge(&t->bins[from], i + 1 - from, tool);
        if (own.asked && own.low > t->options->wrong)
            break;
        if (own.asked && all.high <= t->options->wrong)
            until = i + 1;
    }
    return until;
}

/* The cheapest tool that is good enough from bin `from` on, and until which; STUDY_TOOLS: none is.
 */
static int cheapest(const struct visibility_table *t, int from, int *until)
{
    int k = 0;
    for (; k < STUDY_TOOLS; k = next_tool(t, k)) {
        *until = k == TOOL_SHAFT ? from : good_until(t, from, k);
        if (*until > from)
            return k;
    }
    *until = from + 1;
    return k;
}

static void print_band(const struct visibility_table *t, int from, int until, int tool)
{
    const int said = tool < STUDY_TOOLS ? tool : TOOL_OUTLINE;
    const double *threshold = t->options->thresholds;
    const struct verdict v = judge(&t->bins[from], until - from, said);
    char name[24], low[32] = "0";
    if (!v.asked)
        return;
    if (from)
        snprintf(low, sizeof low, "%.4g", threshold[from - 1]);
    printf("  %-8s from %s to %.4g units, %.4g m2: %s%.2f %% of %llu pairs\n",
           tool < STUDY_TOOLS ? tool_name(t, tool, name) : "none", low, threshold[until - 1],
           threshold[until - 1] * t->unit, tool < STUDY_TOOLS ? "" : "by outlines ", 100 * v.part,
           (unsigned long long)v.pairs);
}

/* The cheapest tool that is good enough, from the smallest areas up, and what that is as settings
 * of oracle by_reliability: how far from the smallest areas on so many rays, or fewer, are. */
static void print_choice(const struct visibility_table *t)
{
    static const int known[] = {4, 16, 64};
    double share[3] = {0, 0, 0};
    int good[3] = {1, 1, 1};
    const struct options *o = t->options;
    printf("the cheapest tool with at most %.4g %% wrong answers:\n", 100 * o->wrong);
    for (int from = 0, until; from < o->threshold_count; from = until) {
        int tool = cheapest(t, from, &until), more = until;
        while (tool == STUDY_TOOLS && until < o->threshold_count
               && cheapest(t, until, &more) == STUDY_TOOLS)
            until = more;
        print_band(t, from, until, tool);
        for (int i = 0; i < 3; i++) {
            good[i] &= tool < RAY_TOOLS && o->rays[tool] <= known[i];
            if (good[i])
                share[i] = o->thresholds[until - 1] * t->unit / t->area;
        }
    }
    printf("as settings: --oracle by_reliability --set below_4=%.3g --set below_16=%.3g --set "
           "below_64=%.3g\n",
           share[0], share[1], share[2]);
}

void visibility_table_print(const struct visibility_table *t)
{
    if (t->partial)
        printf("partial: %s after %.0f s, so these are the pairs discussed until then\n",
               t->partial, t->seconds);
    print_rays(t);
    putchar('\n');
    print_faces(t);
    putchar('\n');
    print_choice(t);
}
