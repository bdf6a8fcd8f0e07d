/* reliability.c - see reliability.h.
 *
 * Intervals are Wilson's, at 95 %: p is known from n answers to
 * (p + z^2/2n +- z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n), z = 1.96 [Wilson 1927]. Of strata
 * with weights W and n_s answers each, n is the number of answers of an even sample of the same
 * variance, p (1 - p) / sum W^2 p_s (1 - p_s) / n_s [Kish 1965: the design effect]; in it the p_s
 * are (x_s + 1) / (n_s + 2), so that no stratum without a wrong answer counts as known for certain.
 * They take pairs for independent, which neighbours are not, so they are a lower bound of what is
 * not known.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "study/reliability.h"

/* two-sided, 95 % */
static const double z = 1.959963984540054;

/* A period that drew fewer says little of how many pairs it stands for: it joins its neighbour. */
enum { LEAST = 50 };

/* A sample, and the pairs that it stands for. */
struct stratum {
    double pairs, asked, answered, wrong;
};

static struct stratum stratum_of(const struct period *p, int tool)
{
    struct stratum s = {(double)p->pairs, 0, 0, 0};
    for (int i = 0; i < CLASSES; i++)
        for (int k = 0; k <= CLASSES; k++) {
            double count = (double)p->matrix[tool][i][k];
            s.asked += count;
            s.answered += k == NO_ANSWER ? 0 : count;
            s.wrong += k == NO_ANSWER || k == i ? 0 : count;
        }
    return s;
}

/* The strata of one bin. Returns how many. */
static int strata_of(const struct bin *bin, int tool, struct stratum strata[PERIODS])
{
    int n = 0;
    for (int i = 0; i < bin->count; i++) {
        const struct stratum s = stratum_of(&bin->periods[i], tool);
        if (n && (s.asked < LEAST || strata[n - 1].asked < LEAST)) {
            strata[n - 1].pairs += s.pairs;
            strata[n - 1].asked += s.asked;
            strata[n - 1].answered += s.answered;
            strata[n - 1].wrong += s.wrong;
        } else {
            strata[n++] = s;
        }
    }
    return n;
}

static void wilson(struct verdict *v, double n)
{
    double middle = v->part + z * z / (2 * n);
    double half = z * sqrt(v->part * (1 - v->part) / n + z * z / (4 * n * n));
    v->low = v->wrong ? (middle - half) / (1 + z * z / n) : 0;
    v->high = v->part < 1 ? (middle + half) / (1 + z * z / n) : 1;
}

struct verdict judge(const struct bin *bins, int count, int tool)
{
    struct verdict v = {0, 0, 0, 0, 0, 0, 1};
    double pairs = 0, answered = 0, wrong = 0, smooth = 0, variance = 0;
    for (int b = 0; b < count; b++) {
        struct stratum strata[PERIODS];
        int n = strata_of(&bins[b], tool, strata);
        for (int i = 0; i < n; i++) {
            const struct stratum *s = &strata[i];
            double stands = s->asked > 0 ? s->pairs / s->asked : 0;
            double likely = (s->wrong + 1) / (s->answered + 2);
            v.pairs += (uint64_t)s->pairs;
            v.asked += (uint64_t)s->asked;
            v.wrong += (uint64_t)s->wrong;
            pairs += stands * s->asked;
            answered += stands * s->answered;
            wrong += stands * s->wrong;
            smooth += stands * s->answered * likely;
            variance += stands * stands * s->answered * likely * (1 - likely);
        }
    }
    if (!(answered > 0))
        return v;
    v.answered = answered / pairs;
    v.part = wrong / answered;
    smooth /= answered;
    wilson(&v, smooth * (1 - smooth) * answered * answered / variance);
    return v;
}

uint64_t count_answers(const struct bin *bins, int count, int tool, int truth, int answer)
{
    uint64_t sum = 0;
    for (int b = 0; b < count; b++)
        for (int i = 0; i < bins[b].count; i++)
            sum += bins[b].periods[i].matrix[tool][truth][answer];
    return sum;
}

uint64_t period_drawn(const struct bin *bin)
{
    return (uint64_t)stratum_of(&bin->periods[bin->count - 1], 0).asked;
}

uint64_t period_length(const struct bin *bin, int rays, double within)
{
    double most = 0;
    for (int t = 0; t < rays; t++) {
        double asked = 0, wrong = 0;
        for (int i = 0; i < bin->count; i++) {
            const struct stratum s = stratum_of(&bin->periods[i], t);
            asked += s.asked;
            wrong += s.wrong;
        }
        double p =
            (wrong + 2) / (asked + 4); /* .5 before anything is known [Agresti, Coull 1998] */
        most = fmax(most, p * (1 - p));
    }
    return (uint64_t)fmax(LEAST, ceil(0.5 * z * z * most / (within * within)));
}

/* ---- counts */

static const char *const class_nodes[CLASSES] = {"none", "partial", "all"};
static const char *const tool_nodes[STUDY_TOOLS] = {"first", "second", "third",  "fourth",
                                                    "fifth", "shaft",  "outline"};
static const char *const too_many = "crowd"; /* the node that answers for outlines */

/* The number of the name, or -1. */
static int number_of(const char *name, const char *const *names, int count)
{
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0)
            return i;
    return -1;
}

/* Which class an answer claims; NO_ANSWER: none. */
static int class_of(const char *answer)
{
    int k = number_of(answer, class_nodes, CLASSES);
    return k >= 0                             ? k
           : strcmp(answer, "visible") == 0   ? CLASSES - 1
           : strcmp(answer, "invisible") == 0 ? 0
                                              : NO_ANSWER;
}

/* Add what the arcs of one node say of a tool, where the reference said `truth`. */
static void add_answers(struct period *to, const struct RadNodeCount *node, int tool, int truth)
{
    for (int k = 0; k < node->answer_count; k++)
        to->matrix[tool][truth][class_of(node->answers[k].name)] += node->answers[k].count;
}

/* Add what one node counts; `name`: without the bin's number, as in none_too__shaft. */
static void add_node(struct period *to, const struct RadNodeCount *node, const char *name)
{
    const char *last = strstr(name, "__");
    if (!last) {
        to->pairs += strcmp(name, "draw") == 0 ? node->calls : 0;
        return;
    }
    char class[16];
    size_t length = strcspn(name, "_");
    snprintf(class, sizeof class, "%.*s", (int)length, name);
    int truth = number_of(class, class_nodes, CLASSES);
    int tool = number_of(last + 2, tool_nodes, STUDY_TOOLS);
    if (truth < 0)
        return;
    if (tool >= 0)
        add_answers(to, node, tool, truth);
    if (strcmp(last + 2, too_many) == 0)
        add_answers(to, node, TOOL_OUTLINE, truth);
}

static void subtract(struct period *from, const struct period *p)
{
    from->pairs -= p->pairs;
    for (int t = 0; t < STUDY_TOOLS; t++)
        for (int i = 0; i < CLASSES; i++)
            for (int k = 0; k <= CLASSES; k++)
                from->matrix[t][i][k] -= p->matrix[t][i][k];
}

void read_bins(struct bin *bins, int count, int slot, const struct RadStatistics *statistics)
{
    struct period all[BINS_OF_SOLVE];
    memset(all, 0, sizeof all);
    for (int n = 0; n < statistics->node_count; n++) {
        const struct RadNodeCount *node = &statistics->nodes[n];
        int number, used = 0;
        if (sscanf(node->name, "below_%d__%n", &number, &used) == 1 && used > 0 && number > slot
            && number <= slot + count)
            add_node(&all[number - 1 - slot], node, node->name + used);
    }
    for (int i = 0; i < count; i++) {
        for (int k = 0; k + 1 < bins[i].count; k++)
            subtract(&all[i], &bins[i].periods[k]);
        bins[i].periods[bins[i].count - 1] = all[i];
    }
}

int next_period(struct bin *bin)
{
    if (bin->count == PERIODS)
        return -1;
    bin->count++;
    return 0;
}
