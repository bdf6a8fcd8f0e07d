/* study_stability.c - `radiosity study stability`: run the failure table (stability.h) and print
 * it.
 *
 * On standard output and in Markdown one table per group: rows are cases with their
 * tolerance, columns the methods that the group's cases name, a cell is the measured error with the
 * order in which it falls, and below it, when that is above the tolerance, "fails: why". In CSV one
 * line per cell, with the tolerance, the count and the order.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/stability.h"
#include "study/study.h"
#include "util/atomic_file.h"
#include "util/ends_with.h"
#include "util/report.h"

enum format { PLAIN, MARKDOWN, CSV };
enum { TEXT = 64 }; /* a cell's number */

struct result {
    struct stability_trial trial;
    enum stability_verdict verdict;
    double order; /* of convergence; NAN: has none */
    int run;      /* 0: not asked for */
};

/* Results of one group: [case * STABILITY_CELLS + cell]. */
struct results {
    const struct stability_group *group;
    struct result *result;
};

/* One more cell begins; say so where somebody watches. */
static void announce(int wanted, const struct stability_case *c, const struct stability_cell *cell)
{
    if (wanted)
        fprintf(stderr, "\r%s, %s\033[K", c->name, stability_methods[cell->method].name);
}

static int run_group(struct results *r, const struct options *o)
{
    int watched = !o->quiet && isatty(STDERR_FILENO), status = 0;
    r->result = calloc((size_t)r->group->count * STABILITY_CELLS, sizeof *r->result);
    if (!r->result)
        return report_error("study stability", 0, "out of memory");
    for (int i = 0; i < r->group->count && status == 0; i++) {
        const struct stability_case *c = &r->group->cases[i];
        if (o->only && strcmp(o->only, c->name) != 0)
            continue;
        for (int k = 0; k < STABILITY_CELLS && c->cells[k].method != NO_METHOD && status == 0;
             k++) {
            struct result *result = &r->result[i * STABILITY_CELLS + k];
            announce(watched, c, &c->cells[k]);
            const struct stability_run how = {o->threads, 0};
            status = stability_run(c, &c->cells[k], &how, &result->trial);
            result->verdict = stability_judge(c, &c->cells[k], result->trial.error);
            if (status == 0)
                status =
                    stability_order(c, &c->cells[k], o->threads, &result->trial, &result->order);
            result->run = 1;
        }
        if (status < 0)
            report_error(c->name, 0, "out of memory");
    }
    if (watched)
        fprintf(stderr, "\r\033[K");
    return status;
}

/* An order in two digits; without a sign where it rounds to 0. */
static double rounded(double order)
{
    return round(order * 10) / 10 + 0.0;
}

static void print_error(char text[TEXT], const struct stability_case *c, const struct result *r)
{
    if (isinf(r->trial.error))
        snprintf(text, TEXT, "none"); /* no number came of it, or it grows without end */
    else if (r->trial.error == 0)
        snprintf(text, TEXT, "0");
    else
        snprintf(text, TEXT, "%.2g", r->trial.error);
    size_t n = strlen(text);
    if (c->counted && r->trial.count >= 0)
        n += (size_t)snprintf(text + n, TEXT - n, " (%.0f %s)", r->trial.count, c->counted);
    if (c->limit == CONVERGES && isnan(r->order))
        snprintf(text + n, TEXT - n, " order -");
    else if (c->limit == CONVERGES)
        snprintf(text + n, TEXT - n, " order %.1f", rounded(r->order));
}

static void print_reason(char text[96], const struct stability_case *c,
                         const struct stability_cell *cell, const struct result *r)
{
    switch (r->verdict) {
    case VERDICT_PASSES:
        text[0] = 0;
        break;
    case VERDICT_FAILS_AS_KNOWN:
        snprintf(text, 96, "fails: %s", cell->why);
        break;
    case VERDICT_FAILS:
        snprintf(text, 96, "FAILS: above %.1g", c->tolerance);
        break;
    case VERDICT_CHANGED:
        snprintf(text, 96, "CHANGED: was %.2g to %.2g", cell->low, cell->high);
        break;
    }
}

/* The cell of a case for a method, or -1. */
static int cell_of(const struct stability_case *c, int method)
{
    for (int k = 0; k < STABILITY_CELLS && c->cells[k].method != NO_METHOD; k++)
        if (c->cells[k].method == method)
            return k;
    return -1;
}

/* The error of a case by a method into text and why; "-" where that makes no sense. Returns 0
 * when the case was not run. */
static int cell_texts(const struct results *r, int i, int method, char text[TEXT], char why[96])
{
    const struct stability_case *c = &r->group->cases[i];
    int k = cell_of(c, method);
    const struct result *result = &r->result[i * STABILITY_CELLS + (k < 0 ? 0 : k)];
    why[0] = 0;
    snprintf(text, TEXT, "-");
    if (k < 0 || !result->run)
        return result->run;
    print_error(text, c, result);
    print_reason(why, c, &c->cells[k], result);
    return 1;
}

/* The methods that the group's cases name, and how wide their columns are. */
static int columns(const struct results *r, int method[METHODS], int width[METHODS])
{
    int n = 0;
    for (int m = NO_METHOD + 1; m < METHODS; m++) {
        int used = 0, wide = (int)strlen(stability_methods[m].name);
        for (int i = 0; i < r->group->count; i++) {
            char text[TEXT], why[96];
            if (!cell_texts(r, i, m, text, why) || cell_of(&r->group->cases[i], m) < 0)
                continue;
            used = 1;
            wide = (int)strlen(text) > wide ? (int)strlen(text) : wide;
            wide = (int)strlen(why) > wide ? (int)strlen(why) : wide;
        }
        if (used) {
            method[n] = m;
            width[n++] = wide;
        }
    }
    return n;
}

static void print_plain(FILE *out, const struct results *r)
{
    int method[METHODS], width[METHODS], n = columns(r, method, width);
    if (n == 0)
        return;
    fprintf(out, "%-20s  %-6s", r->group->title, "within");
    for (int k = 0; k < n; k++)
        fprintf(out, "  %-*s", width[k], stability_methods[method[k]].name);
    fputc('\n', out);
    for (int i = 0; i < r->group->count; i++) {
        char text[TEXT], why[96];
        int reasons = 0;
        if (!r->result[i * STABILITY_CELLS].run)
            continue;
        fprintf(out, "%-20s  %-6.2g", r->group->cases[i].name, r->group->cases[i].tolerance);
        for (int k = 0; k < n; k++) {
            (void)cell_texts(r, i, method[k], text, why);
            fprintf(out, "  %-*s", width[k], text);
            reasons |= why[0];
        }
        fputc('\n', out);
        if (!reasons)
            continue;
        fprintf(out, "%-20s  %-6s", "", "");
        for (int k = 0; k < n; k++) {
            (void)cell_texts(r, i, method[k], text, why);
            fprintf(out, "  %-*s", width[k], why);
        }
        fputc('\n', out);
    }
    fputc('\n', out);
}

static void print_markdown(FILE *out, const struct results *r)
{
    int method[METHODS], width[METHODS], n = columns(r, method, width);
    if (n == 0)
        return;
    fprintf(out, "\n## %s\n\n| case | within |", r->group->title);
    for (int k = 0; k < n; k++)
        fprintf(out, " %s |", stability_methods[method[k]].name);
    fprintf(out, "\n|---|---|");
    for (int k = 0; k < n; k++)
        fprintf(out, "---|");
    for (int i = 0; i < r->group->count; i++) {
        if (!r->result[i * STABILITY_CELLS].run)
            continue;
        fprintf(out, "\n| %s | %.2g |", r->group->cases[i].name, r->group->cases[i].tolerance);
        for (int k = 0; k < n; k++) {
            char text[TEXT], why[96];
            (void)cell_texts(r, i, method[k], text, why);
            fprintf(out, " %s%s%s |", text, *why ? " " : "", why);
        }
    }
    fprintf(out, "\n\n");
    for (int i = 0; i < r->group->count; i++)
        if (r->result[i * STABILITY_CELLS].run)
            fprintf(out, "- `%s`: %s. Right: %s. The number: %s.\n", r->group->cases[i].name,
                    r->group->cases[i].what, r->group->cases[i].right, r->group->cases[i].measure);
}

/* One line per cell; texts hold no quotes. */
static void print_csv(FILE *out, const struct results *r)
{
    static const char *const verdict[] = {"passes", "fails", "FAILS", "CHANGED"};
    for (int i = 0; i < r->group->count; i++) {
        const struct stability_case *c = &r->group->cases[i];
        for (int k = 0; k < STABILITY_CELLS && c->cells[k].method != NO_METHOD; k++) {
            const struct result *result = &r->result[i * STABILITY_CELLS + k];
            if (!result->run)
                continue;
            fprintf(out, "%s,%s,\"%s\",%.6g,%.6g,%s,\"%s\",", r->group->title, c->name,
                    stability_methods[c->cells[k].method].name, result->trial.error, c->tolerance,
                    verdict[result->verdict], c->cells[k].why ? c->cells[k].why : "");
            if (result->trial.count >= 0)
                fprintf(out, "%.0f", result->trial.count);
            fprintf(out, ",\"%s\",", c->measure);
            if (!isnan(result->order))
                fprintf(out, "%.3g", result->order);
            fputc('\n', out);
        }
    }
}

/* Where the default oracle is above what is allowed, by how much; in one line. */
static void print_default(FILE *out, const struct results *results)
{
    int asked = 0, failing = 0;
    for (int g = 0; g < stability_group_count; g++)
        for (int i = 0; i < results[g].group->count; i++) {
            const struct stability_case *c = &results[g].group->cases[i];
            int k = cell_of(c, DEFAULT);
            const struct result *r = &results[g].result[i * STABILITY_CELLS + (k < 0 ? 0 : k)];
            if (k < 0 || !r->run)
                continue;
            asked++;
            if (r->trial.error <= c->tolerance)
                continue;
            fprintf(out, "%s %s %.2g", failing++ ? "," : "\nThe default oracle fails:", c->name,
                    r->trial.error);
        }
    if (failing)
        fprintf(out, "; %d of its %d rows.\n", failing, asked);
}

static void print_all(FILE *out, const struct results *results, enum format format)
{
    if (format == CSV)
        fprintf(out, "group,case,method,error,tolerance,result,why,count,measure,order\n");
    if (format == MARKDOWN)
        fprintf(out,
                "# Where methods fail\n\nMade by `make stability`, or `radiosity study stability "
                "-o FILE.md`. A cell is the method's error; `fails: why` stands where it is "
                "above what the row allows (`within`), the same for every method; - where "
                "the two have nothing to do with each other.\n\n"
                "`order` is p where the error falls as 1/n^p while the method is refined in "
                "three steps: n is of an oracle the number of links, its thresholds and "
                "smallest part times 4, 1 and 1/4; of visibility by rays, the rays of a "
                "pair, times 1, 4 and 16; of a form factor, the elements of a face, 1, 4 and "
                "16. By least squares of the logarithms; below 0 the error grows. `order -`: "
                "the error is at rounding or without end, or there is nothing to refine. "
                "Rows without orders ask for a condition that holds or does not.\n");
    if (format == MARKDOWN)
        print_default(out, results);
    for (int g = 0; g < stability_group_count; g++)
        (format == CSV        ? print_csv
         : format == MARKDOWN ? print_markdown
                              : print_plain)(out, &results[g]);
}

/* How many cells are not as expected, and how many there are at all. */
static int unexpected(const struct results *results, int *cells, int *failing)
{
    int count = 0;
    *cells = *failing = 0;
    for (int g = 0; g < stability_group_count; g++)
        for (int i = 0; results[g].result && i < results[g].group->count * STABILITY_CELLS; i++)
            if (results[g].result[i].run) {
                enum stability_verdict v = results[g].result[i].verdict;
                ++*cells;
                *failing += v == VERDICT_FAILS_AS_KNOWN;
                count += v == VERDICT_FAILS || v == VERDICT_CHANGED;
            }
    return count;
}

static enum format format_of(const char *path)
{
    return ends_with(path, ".md") ? MARKDOWN : ends_with(path, ".csv") ? CSV : PLAIN;
}

static int find(const char *name)
{
    for (int g = 0; g < stability_group_count; g++)
        for (int i = 0; i < stability_groups[g].count; i++)
            if (strcmp(stability_groups[g].cases[i].name, name) == 0)
                return 0;
    report_error("--only", 0, "no case is called '%s'; the cases are", name);
    for (int g = 0; g < stability_group_count; g++)
        for (int i = 0; i < stability_groups[g].count; i++)
            fprintf(stderr, "  %-20s %s\n", stability_groups[g].cases[i].name,
                    stability_groups[g].cases[i].what);
    return -1;
}

int study_stability(const struct options *o, const struct open_scene *scene)
{
    (void)scene; /* it makes its own */
    int status = 0;
    if (o->only && find(o->only) < 0)
        return 1;
    struct results *results;
    results = calloc((size_t)stability_group_count, sizeof *results);
    if (!results)
        return report_error("study stability", 0, "out of memory") != 0;
    for (int g = 0; g < stability_group_count && status == 0; g++) {
        results[g].group = &stability_groups[g];
        status = run_group(&results[g], o);
    }
    if (status == 0) {
        int cells, failing;
        int wrong = unexpected(results, &cells, &failing);
        if (!o->quiet) {
            print_all(stdout, results, PLAIN);
            print_default(stdout, results);
            printf("%d cells: %d pass, %d fail as they are known to, %d are not as expected\n",
                   cells, cells - failing - wrong, failing, wrong);
        }
        if (o->out) {
            struct atomic_file file;
            status = atomic_open(&file, o->out);
            if (status == 0) {
                print_all(file.stream, results, format_of(o->out));
                status = atomic_commit(&file);
            }
        }
        if (wrong)
            status = -1;
    }
    for (int g = 0; g < stability_group_count; g++)
        free(results[g].result);
    free(results);
    return status < 0;
}
