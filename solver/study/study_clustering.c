/* study_clustering.c - `radiosity study clustering`: which strategy groups faces best?
 *
 * Each strategy of radGetClusteringNames() solves the scene once with the same oracle. A row tells
 * of its tree: clusters, depth, and crossed, the clusters whose boxes a random line through the
 * scene meets, sum of box areas over the root's [Goldsmith and Salmon 1987], which is what searches
 * pay for boxes that are large or overlap. And of the solve: seconds, links, discussions, rays,
 * peak memory, and error: against a reference, sum A |B - B_ref| / sum A B_ref over faces; in any
 * case the power imbalance, which in a closed scene is all error, in an open one also what leaves.
 * Counts are exact; seconds are the machine's.
 * [the comparison, for other oracles: Hasenfratz, Damez, Sillion and Drettakis 1999]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "output/chart.h"
#include "study/faces_reference.h"
#include "study/study.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/clock.h"
#include "util/ends_with.h"
#include "util/open_oracle.h"
#include "util/progress.h"
#include "util/solved.h"

enum { STRATEGIES_MAX = 16 };

struct row {
    const char *strategy;
    uint32_t clusters, depth, elements;
    double crossed;
    /* s: of the clusters alone; of all, by the clock and of all threads */
    double build, clock, cpu;
    double memory;          /* MB */
    uint64_t links, groups; /* groups: links with a cluster at an end */
    uint64_t pairs, rays;
    double imbalance, error;   /* shares; error: NAN without a reference */
    int converged, unfinished; /* solved_status's */
};

struct table {
    const struct options *options;
    struct row row[STRATEGIES_MAX];
    int rows;
};

/* Forget the peak so far, where the system can. */
static void forget_peak(void)
{
    FILE *f = fopen("/proc/self/clear_refs", "w");
    if (!f)
        return;
    fputs("5", f);
    (void)fclose(f);
}

/* Peak of resident memory, MB. */
static double peak(void)
{
    char line[128];
    double most = 0;
    FILE *f = fopen("/proc/self/status", "r");
    while (f && fgets(line, sizeof line, f))
        if (strncmp(line, "VmHWM:", 6) == 0)
            most = strtod(line + 6, NULL) / 1024;
    if (f)
        (void)fclose(f);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return most > 0 ? most : (double)usage.ru_maxrss / 1024;
}

/* Half of the surface of a cluster's box (m2). */
static double box_area(const struct element *e)
{
    double size[3];
    sub3(size, e->vertex[1], e->vertex[0]);
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

static void describe_tree(struct row *row, const struct RadElements *tree)
{
    const struct element *all = tree->elements;
    double root = box_area(&all[0]);
    for (uint32_t i = 0; i < tree->built; i++)
        if (!all[i].vertices) {
            row->clusters++;
            row->crossed += root > 0 ? box_area(&all[i]) / root : 1;
        }
    /* Elements stand level by level, so the last has the most above it. */
    row->depth = 1;
    for (uint32_t at = tree->built - 1; at != 0; at = all[at].parent)
        row->depth++;
}

static void describe_solution(struct row *row, const struct solved *s)
{
    const struct element *e = s->elements.elements;
    const struct RadReport *r = &s->report;
    row->build = r->seconds.clusters;
    row->elements = r->elements;
    row->links = r->links;
    for (size_t i = 0; i < s->links.count; i++)
        row->groups +=
            !e[s->links.links[i].receiver].vertices || !e[s->links.links[i].emitter].vertices;
    row->pairs = r->pairs;
    row->rays = r->rays;
    row->imbalance = r->emitted > 0 ? (r->emitted - r->absorbed) / r->emitted : 0;
    row->converged = r->converged;
    row->unfinished = solved_status(r, row->strategy);
}

static int run(const struct options *o, const struct open_scene *scene,
               const struct faces_table *reference, struct progress *progress, const char *strategy,
               struct row *row)
{
    struct RadSolveOptions how = solve_options(o);
    RadOracle oracle =
        open_oracle(scene->device, o->oracle, o->release, o->settings, o->setting_count);
    if (!oracle)
        return -1;
    how.clustering = row->strategy = strategy;
    forget_peak();
    double clock = seconds(), cpu = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    struct solved s;
    int status = solved_open(&s, scene->device, o->scene, scene->scene, oracle, &how);
    progress_end(progress);
    radReleaseOracle(oracle);
    if (status < 0)
        return -1;
    row->clock = seconds() - clock;
    row->cpu = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    row->memory = peak();
    describe_tree(row, &s.elements);
    describe_solution(row, &s);
    row->error =
        reference->count ? faces_reference_error(reference, scene, s.solution) : (double)NAN;
    solved_close(&s);
    return 0;
}

/* ---- outputs */

static void print_heading(FILE *out, const struct options *o)
{
    fprintf(out, "%s, oracle %s, %d threads; error of B %s\n", o->scene, o->oracle, o->threads,
            o->reference ? "per face against the reference, relative L1 by area"
                         : "not known without --reference: look at the power imbalance");
}

static void print_head(FILE *out)
{
    fputs("strategy clusters depth crossed  build s   cpu s clock s     links  of groups      "
          "pairs       rays    MB  imbalance  error\n",
          out);
}

static void print_row(FILE *out, const struct row *r)
{
    fprintf(out, "%-8s %8u %5u %7.1f %8.2f %7.2f %7.2f %9llu  %9llu %10llu %10llu %5.0f   %6.2f %%",
            r->strategy, r->clusters, r->depth, r->crossed, r->build, r->cpu, r->clock,
            (unsigned long long)r->links, (unsigned long long)r->groups,
            (unsigned long long)r->pairs, (unsigned long long)r->rays, r->memory,
            100 * r->imbalance);
    if (isnan(r->error))
        fputs("      -", out);
    else
        fprintf(out, " %4.2f %%", 100 * r->error);
    fputs(r->converged ? "\n" : "  not converged\n", out);
}

static void print_csv(FILE *out, const struct table *t)
{
    fputs("strategy,clusters,depth,crossed,build_s,cpu_s,clock_s,elements,links,links_of_groups,"
          "pairs,rays,memory_mb,imbalance,error,converged\n",
          out);
    for (int i = 0; i < t->rows; i++) {
        const struct row *r = &t->row[i];
        fprintf(out, "%s,%u,%u,%.9g,%.4f,%.4f,%.4f,%u,%llu,%llu,%llu,%llu,%.1f,%.9g,", r->strategy,
                r->clusters, r->depth, r->crossed, r->build, r->cpu, r->clock, r->elements,
                (unsigned long long)r->links, (unsigned long long)r->groups,
                (unsigned long long)r->pairs, (unsigned long long)r->rays, r->memory, r->imbalance);
        if (!isnan(r->error))
            fprintf(out, "%.9g", r->error);
        fprintf(out, ",%d\n", r->converged);
    }
}

static void print_markdown(FILE *out, const struct table *t)
{
    const struct options *o = t->options;
    fprintf(out, "`radiosity study clustering %s`, oracle `%s`, %d threads; error of B %s\n\n",
            path_name(o->scene), o->oracle, o->threads,
            o->reference ? "per face against a reference, relative L1 by area"
                         : "not known: no reference was given");
    fputs("| strategy | clusters | depth | crossed | build, s | cpu, s | clock, s | links | of "
          "groups | pairs | rays | MB | imbalance | error |\n"
          "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
          out);
    for (int i = 0; i < t->rows; i++) {
        const struct row *r = &t->row[i];
        fprintf(out,
                "| %s | %u | %u | %.1f | %.2f | %.1f | %.1f | %llu | %llu | %llu | %llu | %.0f | "
                "%.2f %% | ",
                r->strategy, r->clusters, r->depth, r->crossed, r->build, r->cpu, r->clock,
                (unsigned long long)r->links, (unsigned long long)r->groups,
                (unsigned long long)r->pairs, (unsigned long long)r->rays, r->memory,
                100 * r->imbalance);
        if (isnan(r->error))
            fputs("- |\n", out);
        else
            fprintf(out, "%.2f %% |\n", 100 * r->error);
    }
}

static int write_table(const char *path, const struct table *t)
{
    struct atomic_file file;
    if (atomic_open(&file, path))
        return -1;
    if (ends_with(path, ".md"))
        print_markdown(file.stream, t);
    else
        print_csv(file.stream, t);
    return atomic_commit(&file);
}

/* Bars of each measure, the first strategy's being 1. */
static void print_plot(FILE *out, const void *context)
{
    const struct table *t = context;
    const int known = !isnan(t->row[0].error);
    fprintf(out,
            "set style data histogram\nset style histogram clustered gap 1\nset style fill solid "
            "0.8 border -1\n"
            "set ylabel 'times that of %s'\nset yrange [0:*]\nset grid ytics\nset key below "
            "horizontal\n$measures << EOD\nmeasure",
            t->row[0].strategy);
    for (int i = 0; i < t->rows; i++)
        fprintf(out, " %s", t->row[i].strategy);
#define BARS(name, value) \
    fprintf(out, "\n\"" name "\""); \
    for (int i = 0; i < t->rows; i++) { \
        const struct row *r = &t->row[i], *first = &t->row[0]; \
        fprintf(out, " %.6g", \
                (double)first->value > 0 ? (double)r->value / (double)first->value : 0); \
    }
    BARS("cpu time", cpu)
    BARS("links", links)
    BARS("pairs", pairs)
    BARS("rays", rays)
    BARS("memory", memory)
    if (known) {
        BARS("error", error)
    }
#undef BARS
    fprintf(out, "\nEOD\nplot for [i=2:%d] $measures using i:xtic(1) title columnheader(i)\n",
            t->rows + 1);
}

int study_clustering(const struct options *o, const struct open_scene *scene)
{
    struct table t = {.options = o};
    struct faces_table reference = {0};
    int status = 1;
    if (o->reference && faces_reference_read(&reference, o->reference, scene) < 0)
        return 1;
    struct progress progress;
    progress_start(&progress, o->quiet);
    radSetDeviceProgressFunction(scene->device, progress_show, &progress);
    if (!o->quiet) {
        print_heading(stdout, o);
        print_head(stdout);
        fflush(stdout);
    }
    for (const char *const *name = radGetClusteringNames(); *name && t.rows < STRATEGIES_MAX;
         name++) {
        if (o->only && strcmp(o->only, *name) != 0)
            continue;
        if (run(o, scene, &reference, &progress, *name, &t.row[t.rows]) < 0)
            goto done;
        if (!o->quiet) {
            print_row(stdout, &t.row[t.rows]);
            fflush(stdout);
        }
        t.rows++;
    }
    status = (o->out && write_table(o->out, &t) < 0)
             || (o->chart && chart_draw(o->chart, print_plot, &t) < 0);
    for (int i = 0; i < t.rows && status != 1; i++)
        status |= t.row[i].unfinished;
done:
    faces_table_free(&reference);
    return status;
}
