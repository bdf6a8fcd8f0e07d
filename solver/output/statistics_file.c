/* statistics_file.c - see statistics_file.h. Nodes stand in the order of the graph, answers in that
 * of their tool.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "util/atomic_file.h"
#include "util/ends_with.h"
#include "output/json_file.h"
#include "util/report.h"
#include "output/statistics_file.h"

/* Bin 0 of a histogram holds what is below twice this power of 2. */
enum { LOWEST = -64 };

static double share(uint64_t part, uint64_t whole)
{
    return whole ? 100 * (double)part / (double)whole : 0;
}

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
                    share(s->zero[slot], all));
        for (int i = 0; i < RAD_BINS; i++)
            if (bins[i])
                fprintf(out, "  %.4g to %-*.4g %12llu %6.2f %%\n", ldexp(1, LOWEST + i), 12,
                        ldexp(1, LOWEST + i + 1), (unsigned long long)bins[i], share(bins[i], all));
    }
}

static void print_text(FILE *out, const char *oracle, const struct RadStatistics *s)
{
    fprintf(out, "oracle %s: %llu discussions\n", oracle,
            (unsigned long long)(s->node_count ? s->nodes[0].calls : 0));
    for (int i = 0; i < s->node_count; i++) {
        const struct RadNodeCount *n = &s->nodes[i];
        fprintf(out, "%-24s %-20s %12llu%s\n", n->name, n->tool, (unsigned long long)n->calls,
                n->calls ? "" : "  never asked");
        for (int k = 0; k < n->answer_count && n->calls; k++)
            fprintf(out, "  %-22s %-11s -> %-18s %12llu %6.2f %%\n", n->answers[k].name,
                    n->answers[k].kind, n->answers[k].target,
                    (unsigned long long)n->answers[k].count, share(n->answers[k].count, n->calls));
    }
    print_records(out, s);
}

/* A line per answer; counts and histograms follow in the same columns. */
static void print_csv(FILE *out, const struct RadStatistics *s)
{
    fputs("node,tool,answer,kind,target,count\n", out);
    for (int i = 0; i < s->node_count; i++)
        for (int k = 0; k < s->nodes[i].answer_count; k++) {
            const struct RadAnswerCount *a = &s->nodes[i].answers[k];
            fprintf(out, "%s,%s,%s,%s,%s,%llu\n", s->nodes[i].name, s->nodes[i].tool, a->name,
                    a->kind, a->target, (unsigned long long)a->count);
        }
    for (int i = 0; i < RAD_COUNTS; i++)
        if (s->counts[i])
            fprintf(out, "count %d,count,,,,%llu\n", i, (unsigned long long)s->counts[i]);
    for (int i = 0; i < RAD_RECORDS; i++) {
        if (s->zero[i])
            fprintf(out, "record %d,record,0,,,%llu\n", i, (unsigned long long)s->zero[i]);
        for (int k = 0; k < RAD_BINS; k++)
            if (s->bins[i][k])
                fprintf(out, "record %d,record,from %.17g,,,%llu\n", i, ldexp(1, LOWEST + k),
                        (unsigned long long)s->bins[i][k]);
    }
}

static json_t *records_json(const struct RadStatistics *s)
{
    json_t *all = json_array();
    for (int slot = 0; slot < RAD_RECORDS; slot++) {
        json_t *bins = json_array();
        for (int i = 0; i < RAD_BINS; i++)
            if (s->bins[slot][i])
                json_array_append_new(bins, json_pack("{s:f, s:I}", "from", ldexp(1, LOWEST + i),
                                                      "count", (json_int_t)s->bins[slot][i]));
        if (s->zero[slot] || json_array_size(bins))
            json_array_append_new(all, json_pack("{s:i, s:I, s:o}", "slot", slot, "zero",
                                                 (json_int_t)s->zero[slot], "bins", bins));
        else
            json_decref(bins);
    }
    return all;
}

static json_t *statistics_json(const char *oracle, const struct RadStatistics *s)
{
    json_t *nodes = json_array(), *counts = json_object();
    for (int i = 0; i < s->node_count; i++) {
        const struct RadNodeCount *n = &s->nodes[i];
        json_t *answers = json_array();
        for (int k = 0; k < n->answer_count; k++)
            json_array_append_new(answers, json_pack("{s:s, s:s, s:s, s:I}", "answer",
                                                     n->answers[k].name, "kind", n->answers[k].kind,
                                                     "target", n->answers[k].target, "count",
                                                     (json_int_t)n->answers[k].count));
        json_array_append_new(nodes,
                              json_pack("{s:s, s:s, s:I, s:o}", "node", n->name, "tool", n->tool,
                                        "calls", (json_int_t)n->calls, "answers", answers));
    }
    for (int i = 0; i < RAD_COUNTS; i++)
        if (s->counts[i]) {
            char name[16];
            snprintf(name, sizeof name, "%d", i);
            json_object_set_new(counts, name, json_integer((json_int_t)s->counts[i]));
        }
    return json_pack("{s:s, s:o, s:o, s:o}", "oracle", oracle, "nodes", nodes, "counts", counts,
                     "records", records_json(s));
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

int statistics_write(const char *path, RadOracle oracle)
{
    struct RadOracleReport report;
    radGetOracleReport(oracle, &report);
    struct RadStatistics s;
    if (radGetOracleStatistics(oracle, &s) < 0)
        return report_error(path, 0, "out of memory for the statistics");
    if (strcmp(path, "-") == 0) {
        print_text(stdout, report.name, &s);
        return 0;
    }
    return ends_with(path, ".json") ? json_file_write(path, statistics_json(report.name, &s))
                                    : print_file(path, report.name, &s);
}
