/* statistics_file.c - see statistics_file.h. Nodes stand in the order of the graph, answers in that of their tool.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "util/atomic_file.h"
#include "util/ends_with.h"
#include "output/json_file.h"
#include "util/report.h"
#include "oracle/statistics.h"
#include "output/statistics_file.h"

static double share(uint64_t part, uint64_t whole)
{
    return whole ? 100 * (double)part / (double)whole : 0;
}

static void print_records(FILE *out, const struct statistics *s)
{
    int slot, i;
    for (i = 0; i < STATISTICS_COUNTS; i++)
        if (s->counts[i])
            fprintf(out, "count %-3d %12llu\n", i, (unsigned long long)s->counts[i]);
    for (slot = 0; slot < STATISTICS_SLOTS; slot++) {
        const struct record_statistics *r = &s->records[slot];
        uint64_t all = r->zero;
        for (i = 0; i < STATISTICS_HIGH - STATISTICS_LOW; i++)
            all += r->bins[i];
        if (!all)
            continue;
        fprintf(out, "record %d, %llu values\n", slot, (unsigned long long)all);
        if (r->zero)
            fprintf(out, "  %-24s %12llu %6.2f %%\n", "0", (unsigned long long)r->zero, share(r->zero, all));
        for (i = 0; i < STATISTICS_HIGH - STATISTICS_LOW; i++)
            if (r->bins[i])
                fprintf(out, "  %.4g to %-*.4g %12llu %6.2f %%\n", ldexp(1, STATISTICS_LOW + i), 12,
                        ldexp(1, STATISTICS_LOW + i + 1), (unsigned long long)r->bins[i], share(r->bins[i], all));
    }
}

static void print_text(FILE *out, const struct refiner *refiner, const struct statistics *s)
{
    int i, k;
    fprintf(out, "oracle %s: %llu discussions\n", refiner->oracle, (unsigned long long)(s->node_count ? s->nodes[0].calls : 0));
    for (i = 0; i < s->node_count; i++) {
        const struct node_statistics *n = &s->nodes[i];
        fprintf(out, "%-24s %-20s %12llu%s\n", n->name, n->tool, (unsigned long long)n->calls, n->calls ? "" : "  never asked");
        for (k = 0; k < n->answer_count && n->calls; k++)
            fprintf(out, "  %-22s %-11s -> %-18s %12llu %6.2f %%\n", n->answers[k].name, n->answers[k].kind, n->answers[k].target,
                    (unsigned long long)n->answers[k].count, share(n->answers[k].count, n->calls));
    }
    print_records(out, s);
}

/* A line per answer; counts and histograms follow in the same columns. */
static void print_csv(FILE *out, const struct statistics *s)
{
    int i, k;
    fputs("node,tool,answer,kind,target,count\n", out);
    for (i = 0; i < s->node_count; i++)
        for (k = 0; k < s->nodes[i].answer_count; k++) {
            const struct answer_statistics *a = &s->nodes[i].answers[k];
            fprintf(out, "%s,%s,%s,%s,%s,%llu\n", s->nodes[i].name, s->nodes[i].tool, a->name, a->kind, a->target,
                    (unsigned long long)a->count);
        }
    for (i = 0; i < STATISTICS_COUNTS; i++)
        if (s->counts[i])
            fprintf(out, "count %d,count,,,,%llu\n", i, (unsigned long long)s->counts[i]);
    for (i = 0; i < STATISTICS_SLOTS; i++) {
        if (s->records[i].zero)
            fprintf(out, "record %d,record,0,,,%llu\n", i, (unsigned long long)s->records[i].zero);
        for (k = 0; k < STATISTICS_HIGH - STATISTICS_LOW; k++)
            if (s->records[i].bins[k])
                fprintf(out, "record %d,record,from %.17g,,,%llu\n", i, ldexp(1, STATISTICS_LOW + k),
                        (unsigned long long)s->records[i].bins[k]);
    }
}

static json_t *records_json(const struct statistics *s)
{
    json_t *all = json_array();
    int slot, i;
    for (slot = 0; slot < STATISTICS_SLOTS; slot++) {
        const struct record_statistics *r = &s->records[slot];
        json_t *bins = json_array();
        for (i = 0; i < STATISTICS_HIGH - STATISTICS_LOW; i++)
            if (r->bins[i])
                json_array_append_new(bins, json_pack("{s:f, s:I}", "from", ldexp(1, STATISTICS_LOW + i), "count", (json_int_t)r->bins[i]));
        if (r->zero || json_array_size(bins))
            json_array_append_new(all, json_pack("{s:i, s:I, s:o}", "slot", slot, "zero", (json_int_t)r->zero, "bins", bins));
        else
            json_decref(bins);
    }
    return all;
}

static json_t *statistics_json(const struct refiner *refiner, const struct statistics *s)
{
    json_t *nodes = json_array(), *counts = json_object();
    int i, k;
    for (i = 0; i < s->node_count; i++) {
        const struct node_statistics *n = &s->nodes[i];
        json_t *answers = json_array();
        for (k = 0; k < n->answer_count; k++)
            json_array_append_new(answers, json_pack("{s:s, s:s, s:s, s:I}", "answer", n->answers[k].name, "kind", n->answers[k].kind,
                                                     "target", n->answers[k].target, "count", (json_int_t)n->answers[k].count));
        json_array_append_new(nodes, json_pack("{s:s, s:s, s:I, s:o}", "node", n->name, "tool", n->tool, "calls",
                                               (json_int_t)n->calls, "answers", answers));
    }
    for (i = 0; i < STATISTICS_COUNTS; i++)
        if (s->counts[i]) {
            char name[16];
            snprintf(name, sizeof name, "%d", i);
            json_object_set_new(counts, name, json_integer((json_int_t)s->counts[i]));
        }
    return json_pack("{s:s, s:o, s:o, s:o}", "oracle", refiner->oracle, "nodes", nodes, "counts", counts, "records", records_json(s));
}

static int print_file(const char *path, const struct refiner *refiner, const struct statistics *s)
{
    struct atomic_file file;
    if (atomic_open(&file, path))
        return -1;
    if (ends_with(path, ".csv"))
        print_csv(file.stream, s);
    else
        print_text(file.stream, refiner, s);
    return atomic_commit(&file);
}

int statistics_write(const char *path, const struct refiner *refiner)
{
    struct statistics s;
    int result = 0;
    if (statistics_take(&s, refiner) < 0)
        return report_error(path, 0, "out of memory for the statistics");
    if (strcmp(path, "-") == 0)
        print_text(stdout, refiner, &s);
    else if (ends_with(path, ".json"))
        result = json_file_write(path, statistics_json(refiner, &s));
    else
        result = print_file(path, refiner, &s);
    statistics_free(&s);
    return result;
}
