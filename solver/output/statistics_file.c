/* statistics_file.c - see statistics_file.h. Nodes stand in the order of the graph, answers in that
 * of their tool.
 * SPDX-License-Identifier: MIT */
#include "output/statistics_file.h"

#include <stdio.h>

#include "output/json_file.h"
#include "output/statistics_json.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/ends_with.h"
#include "util/report.h"

static double percent(uint64_t part, uint64_t whole)
{
    return 100 * share_of((double)part, (double)whole);
}

/* ---- text */

static void print_records(FILE *out, const struct RadStatistics *s)
{
    for (int i = 0; i < RAD_COUNTS; i++)
        if (s->counts[i])
            fprintf(out, "count %-3d %12llu\n", i, (unsigned long long)s->counts[i]);
    for (int slot = 0; slot < RAD_RECORDS; slot++) {
        const uint64_t *bins = s->bins[slot];
        uint64_t all = s->zero[slot];
        for (int i = 0; i < RAD_BINS; i++)
            all += bins[i];
        if (!all)
            continue;
        fprintf(out, "record %d, %llu values\n", slot, (unsigned long long)all);
        if (s->zero[slot])
            fprintf(out, "  %-24s %12llu %6.2f %%\n", "0", (unsigned long long)s->zero[slot],
                    percent(s->zero[slot], all));
        for (int i = 0; i < RAD_BINS; i++)
            if (bins[i])
                fprintf(out, "  %.4g to %-12.4g %12llu %6.2f %%\n", statistics_bin(i),
                        statistics_bin(i + 1), (unsigned long long)bins[i], percent(bins[i], all));
    }
}

static void print_node(FILE *out, const struct RadNodeCount *n, const struct RadStatistics *s)
{
    fprintf(out, "%-24s %-20s %12llu %6.2f %%", n->name, n->tool, (unsigned long long)n->calls,
            percent(n->calls, s->nodes[0].calls));
    if (!n->calls)
        fprintf(out, "  never asked");
    if (n->timed)
        fprintf(out, "  %5.1f %% of the time, %.3g us each",
                100 * share_of(n->seconds, statistics_seconds(s)),
                1e6 * n->seconds / (double)n->calls);
    if (n->rays)
        fprintf(out, ", %llu rays", (unsigned long long)n->rays);
    fputc('\n', out);
    for (int k = 0; k < n->answer_count && n->calls; k++)
        fprintf(out, "  %-22s %-11s -> %-18s %12llu %6.2f %%\n", n->answers[k].name,
                n->answers[k].kind, n->answers[k].target, (unsigned long long)n->answers[k].count,
                percent(n->answers[k].count, n->calls));
    for (int k = 0; k < n->term_count; k++)
        fprintf(out, "  term %-17s %-11s    %-18s %12llu\n", n->terms[k].name, "computed", "",
                (unsigned long long)n->terms[k].count);
}

/* The way of each, a step after the other. */
static void print_paths(FILE *out, const struct RadStatistics *s)
{
    const double all = statistics_seconds(s);
    enum { SHOWN = 3 };
    fprintf(out, "%llu paths were gone; those that took most time:\n",
            (unsigned long long)s->distinct_paths);
    for (int i = 0; i < s->path_count && i < SHOWN; i++) {
        const struct RadPath *p = &s->paths[i];
        fprintf(out, "%d. %llu discussions, %.1f %% of the time\n  ", i + 1,
                (unsigned long long)p->count, 100 * share_of(p->seconds, all));
        for (int k = 0; k < p->length; k++) {
            const struct RadNodeCount *n = &s->nodes[p->nodes[k]];
            const struct RadAnswerCount *a = &n->answers[p->answers[k]];
            fprintf(out, " %s: %s%s", n->name, a->name, k + 1 < p->length ? ";" : "");
        }
        fprintf(out, " -> %s\n", statistics_decision(s, p));
    }
}

static void print_unused(FILE *out, const struct RadStatistics *s)
{
    fputs("never asked:", out);
    for (int i = 0; i < s->node_count; i++)
        if (!s->nodes[i].calls)
            fprintf(out, " %s", s->nodes[i].name);
    fputs("\nnever answered:", out);
    for (int i = 0; i < s->node_count; i++)
        for (int k = 0; s->nodes[i].calls && k < s->nodes[i].answer_count; k++)
            if (!s->nodes[i].answers[k].count)
                fprintf(out, " %s:%s", s->nodes[i].name, s->nodes[i].answers[k].name);
    fputc('\n', out);
}

static void print_passes(FILE *out, const struct RadStatistics *s)
{
    fprintf(out, "pass  discussions         rays      seconds\n");
    for (int i = 0; i < s->pass_count; i++)
        fprintf(out, "%4d %12llu %12llu %12.4g\n", i + 1,
                (unsigned long long)s->passes[i].discussions, (unsigned long long)s->passes[i].rays,
                s->passes[i].seconds);
}

static void print_text(FILE *out, const char *oracle, const struct RadStatistics *s)
{
    fprintf(out, "oracle %s: %llu discussions, %llu rays, %.4g s in its nodes (one in %d timed)\n",
            oracle, (unsigned long long)s->nodes[0].calls, (unsigned long long)statistics_rays(s),
            statistics_seconds(s), RAD_TIMED_EVERY);
    for (int i = 0; i < s->node_count; i++)
        print_node(out, &s->nodes[i], s);
    print_unused(out, s);
    print_paths(out, s);
    print_passes(out, s);
    print_records(out, s);
}

/* ---- CSV: a line per node, answer and term, of all passes together (0) and of each; then paths */

static void print_csv_node(FILE *out, int pass, const struct RadNodeCount *n, uint64_t discussions)
{
    fprintf(out, "node,%d,%s,%s,,,,%llu,%.6g,%.9g,%.9g,%llu\n", pass, n->name, n->tool,
            (unsigned long long)n->calls, share_of((double)n->calls, (double)discussions),
            n->seconds, share_of(n->seconds, (double)n->calls), (unsigned long long)n->rays);
    for (int k = 0; k < n->answer_count; k++) {
        const struct RadAnswerCount *a = &n->answers[k];
        fprintf(out, "answer,%d,%s,%s,%s,%s,%s,%llu,%.6g,,,\n", pass, n->name, n->tool, a->name,
                a->kind, a->target, (unsigned long long)a->count,
                share_of((double)a->count, (double)n->calls));
    }
    for (int k = 0; k < n->term_count; k++)
        fprintf(out, "term,%d,%s,%s,%s,,,%llu,%.6g,,,\n", pass, n->name, n->tool, n->terms[k].name,
                (unsigned long long)n->terms[k].count,
                share_of((double)n->terms[k].count, (double)n->calls));
}

static void print_csv_path(FILE *out, const struct RadPath *p, const struct RadStatistics *s)
{
    fputs("path,0,", out);
    for (int k = 0; k < p->length; k++) {
        const struct RadNodeCount *n = &s->nodes[p->nodes[k]];
        fprintf(out, "%s%s:%s", k ? " " : "", n->name, n->answers[p->answers[k]].name);
    }
    fprintf(out, ",,,,%s,%llu,%.6g,%.9g,%.9g,\n", statistics_decision(s, p),
            (unsigned long long)p->count, share_of((double)p->count, (double)s->nodes[0].calls),
            p->seconds, share_of(p->seconds, (double)p->count));
}

static void print_csv(FILE *out, const struct RadStatistics *s)
{
    fputs("what,pass,node,tool,answer,kind,target,count,share,seconds,mean_seconds,rays\n", out);
    for (int i = 0; i < s->node_count; i++)
        print_csv_node(out, 0, &s->nodes[i], s->nodes[0].calls);
    for (int p = 0; p < s->pass_count; p++)
        for (int i = 0; i < s->node_count; i++)
            if (s->passes[p].nodes[i].calls)
                print_csv_node(out, p + 1, &s->passes[p].nodes[i], s->passes[p].discussions);
    for (int i = 0; i < s->path_count; i++)
        print_csv_path(out, &s->paths[i], s);
    for (int i = 0; i < RAD_COUNTS; i++)
        if (s->counts[i])
            fprintf(out, "count,0,%d,count,,,,%llu,,,,\n", i, (unsigned long long)s->counts[i]);
    for (int i = 0; i < RAD_RECORDS; i++) {
        if (s->zero[i])
            fprintf(out, "record,0,%d,record,0,,,%llu,,,,\n", i, (unsigned long long)s->zero[i]);
        for (int k = 0; k < RAD_BINS; k++)
            if (s->bins[i][k])
                fprintf(out, "record,0,%d,record,from %.17g,,,%llu,,,,\n", i, statistics_bin(k),
                        (unsigned long long)s->bins[i][k]);
    }
}

static int print_file(const char *path, const char *oracle, const struct RadStatistics *s)
{
    struct atomic_file file;
    if (atomic_open(&file, path))
        return -1;
    if (ends_with(path, ".csv"))
        print_csv(file.stream, s);
    else
        print_text(file.stream, oracle, s);
    return atomic_commit(&file);
}

int statistics_write(const char *path, const char *scene, RadOracle oracle)
{
    struct RadOracleReport report;
    radGetOracleReport(oracle, &report);
    struct RadStatistics s;
    if (radGetOracleStatistics(oracle, &s) < 0)
        return report_error(path, 0, "out of memory for the statistics");
    if (path_is_stdout(path)) {
        print_text(stdout, report.name, &s);
        return 0;
    }
    return ends_with(path, ".json") ? json_file_write(path, statistics_json(scene, oracle, &s))
                                    : print_file(path, report.name, &s);
}
