/* statistics_json.c - see statistics_json.h. The fields are told in the man page, under STATISTICS;
 * the schema's number grows when one goes or changes its meaning.
 * SPDX-License-Identifier: MIT */
#include "output/statistics_json.h"

#include <stdio.h>

#include "output/json_values.h"

static json_t *whole(uint64_t count)
{
    return json_integer((json_int_t)count);
}

/* Of 4, 8 and 16 pairs. */
static json_t *vectors_json(const struct RadNodeCount *n)
{
    json_t *vectors = json_object();
    for (int k = 0; k < RAD_WIDTHS; k++) {
        char width[8];
        snprintf(width, sizeof width, "%d", 4 << k);
        json_object_set_new(vectors, width, whole(n->vectors[k]));
    }
    return vectors;
}

/* What nodes have in common with the nodes of one pass. */
static json_t *node_json(const struct RadNodeCount *n)
{
    json_t *answers = json_array(), *terms = json_object();
    for (int k = 0; k < n->answer_count; k++) {
        const struct RadAnswerCount *a = &n->answers[k];
        json_array_append_new(answers,
                              json_pack("{s:s, s:s, s:s, s:o}", "answer", a->name, "kind", a->kind,
                                        "target", a->target, "count", whole(a->count)));
    }
    for (int k = 0; k < n->term_count; k++)
        json_object_set_new(terms, n->terms[k].name, whole(n->terms[k].count));
    return json_pack("{s:s, s:s, s:o, s:f, s:o, s:o, s:o, s:o, s:o, s:o}", "node", n->name, "tool",
                     n->tool, "calls", whole(n->calls), "seconds", n->seconds, "timed",
                     whole(n->timed), "rays", whole(n->rays), "lists", whole(n->lists), "vectors",
                     vectors_json(n), "terms", terms, "answers", answers);
}

static json_t *nodes_json(const struct RadStatistics *s)
{
    const double all = statistics_seconds(s);
    json_t *nodes = json_array();
    for (int i = 0; i < s->node_count; i++) {
        const struct RadNodeCount *n = &s->nodes[i];
        json_t *node = node_json(n);
        json_object_set_new(node, "share",
                            json_real(share_of((double)n->calls, (double)s->nodes[0].calls)));
        json_object_set_new(node, "seconds_share", json_real(share_of(n->seconds, all)));
        json_object_set_new(node, "mean_seconds",
                            json_real(share_of(n->seconds, (double)n->calls)));
        json_array_append_new(nodes, node);
    }
    return nodes;
}

/* Of nodes that are never asked, the node alone: that its answers are not given follows. */
static json_t *unused_json(const struct RadStatistics *s)
{
    json_t *nodes = json_array(), *arcs = json_array();
    for (int i = 0; i < s->node_count; i++) {
        const struct RadNodeCount *n = &s->nodes[i];
        if (!n->calls)
            json_array_append_new(nodes, json_string(n->name));
        for (int k = 0; n->calls && k < n->answer_count; k++)
            if (!n->answers[k].count)
                json_array_append_new(
                    arcs, json_pack("{s:s, s:s}", "node", n->name, "answer", n->answers[k].name));
    }
    return json_pack("{s:o, s:o}", "nodes", nodes, "arcs", arcs);
}

static json_t *paths_json(const struct RadStatistics *s)
{
    const double all = statistics_seconds(s);
    json_t *paths = json_array();
    for (int i = 0; i < s->path_count; i++) {
        const struct RadPath *p = &s->paths[i];
        json_t *steps = json_array();
        for (int k = 0; k < p->length; k++) {
            const struct RadNodeCount *n = &s->nodes[p->nodes[k]];
            json_array_append_new(steps, json_pack("{s:s, s:s}", "node", n->name, "answer",
                                                   n->answers[p->answers[k]].name));
        }
        json_array_append_new(paths,
                              json_pack("{s:o, s:f, s:f, s:o, s:s, s:o}", "discussions",
                                        whole(p->count), "seconds", p->seconds, "seconds_share",
                                        share_of(p->seconds, all), "timed", whole(p->timed),
                                        "decision", statistics_decision(s, p), "steps", steps));
    }
    return json_pack("{s:o, s:o}", "distinct", whole(s->distinct_paths), "most_expensive", paths);
}

static json_t *passes_json(const struct RadStatistics *s)
{
    json_t *passes = json_array();
    for (int i = 0; i < s->pass_count; i++) {
        const struct RadPass *p = &s->passes[i];
        json_t *nodes = json_array();
        for (int k = 0; k < s->node_count; k++)
            if (p->nodes[k].calls)
                json_array_append_new(nodes, node_json(&p->nodes[k]));
        json_array_append_new(passes,
                              json_pack("{s:i, s:o, s:f, s:o, s:o}", "pass", i + 1, "discussions",
                                        whole(p->discussions), "seconds", p->seconds, "rays",
                                        whole(p->rays), "nodes", nodes));
    }
    return passes;
}

static json_t *counts_json(const struct RadStatistics *s)
{
    json_t *counts = json_object();
    for (int i = 0; i < RAD_COUNTS; i++)
        if (s->counts[i]) {
            char name[16];
            snprintf(name, sizeof name, "%d", i);
            json_object_set_new(counts, name, whole(s->counts[i]));
        }
    return counts;
}

static json_t *records_json(const struct RadStatistics *s)
{
    json_t *all = json_array();
    for (int slot = 0; slot < RAD_RECORDS; slot++) {
        json_t *bins = json_array();
        for (int i = 0; i < RAD_BINS; i++)
            if (s->bins[slot][i])
                json_array_append_new(bins, json_pack("{s:f, s:o}", "from", statistics_bin(i),
                                                      "count", whole(s->bins[slot][i])));
        if (s->zero[slot] || json_array_size(bins))
            json_array_append_new(all, json_pack("{s:i, s:o, s:o}", "slot", slot, "zero",
                                                 whole(s->zero[slot]), "bins", bins));
        else
            json_decref(bins);
    }
    return all;
}

json_t *statistics_json(const char *scene, RadOracle oracle, const struct RadStatistics *s)
{
    struct RadOracleReport report;
    radGetOracleReport(oracle, &report);
    return json_pack("{s:s, s:s, s:o, s:o, s:o, s:f, s:o, s:i, s:o, s:o, s:o, s:o, s:o, s:o}",
                     "schema", STATISTICS_SCHEMA, "oracle", report.name, "scene", json_text(scene),
                     "parameters", oracle_parameters_json(oracle), "discussions",
                     whole(s->node_count ? s->nodes[0].calls : 0), "seconds", statistics_seconds(s),
                     "rays", whole(statistics_rays(s)), "timed_every", RAD_TIMED_EVERY, "nodes",
                     nodes_json(s), "unused", unused_json(s), "paths", paths_json(s), "passes",
                     passes_json(s), "counts", counts_json(s), "records", records_json(s));
}
