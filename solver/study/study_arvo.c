/* study_arvo.c - `radiosity study arvo`: what constants over n x n elements leave of the light of a
 * square lamp, for n = 1 to 64 (arvo.h).
 *
 * Whatever projects, no constants are nearer than the best ones: the lower curve. A projection that
 * does not enlarge functions, as Galerkin's mean, stays below twice the lower curve; collocation is
 * none of these in L1 and L2, and leaves the band where a centre lies under the lamp.
 * [Arvo, Torrance and Smits 1994, section 5 and figure 4]
 * SPDX-License-Identifier: MIT */
#include <pthread.h>
#include <stdio.h>
#include "output/chart.h"
#include "study/arvo.h"
#include "study/study.h"
#include "util/atomic_file.h"
#include "util/progress.h"
#include "util/report.h"
#include "util/thread_pool.h"

enum { FINEST = 64 }; /* n x n elements */

static const char *const norm_names[ARVO_NORMS] = {"l1", "l2", "linf"};
static const char *const norm_titles[ARVO_NORMS] = {"L1, W", "L2, W/m", "Linf, W/m2"};
static const char *const projection_names[ARVO_PROJECTIONS] = {"best", "galerkin", "collocation"};

struct measuring {
    const struct options *options;
    struct arvo_errors *errors; /* [FINEST + 1] */
    struct account {
        pthread_mutex_t lock;
        struct progress progress;
        int failed, done;
    } * account;
};

static void measure(const void *context, size_t from, size_t to)
{
    const struct measuring *m = context;
    for (size_t i = from; i < to; i++) {
        /* the finest take longest, so they go first */
        int n = FINEST - (int)i, short_of = 0, samples = m->options->samples;
        if (samples)
            short_of = arvo_sample(&m->errors[n], n, samples) < 0;
        else
            arvo_measure(&m->errors[n], n);
        pthread_mutex_lock(&m->account->lock);
        m->account->failed |= short_of;
        progress_say(&m->account->progress, "%d of %d", ++m->account->done, FINEST);
        pthread_mutex_unlock(&m->account->lock);
    }
}

/* All n at once, each for itself: the same numbers for any number of threads. */
static int measure_all(const struct options *o, struct arvo_errors errors[FINEST + 1])
{
    struct account account = {.lock = PTHREAD_MUTEX_INITIALIZER};
    progress_start(&account.progress, o->quiet);
    thread_pool_run(o->threads, FINEST, 1, measure, &(struct measuring){o, errors, &account});
    progress_end(&account.progress);
    return account.failed ? report_error("study arvo", 0, "out of memory; give fewer --samples")
                          : 0;
}

static double times_best(const struct arvo_errors *e, int norm, enum arvo_projection p)
{
    return e->of[norm][p] / e->of[norm][ARVO_BEST];
}

static void print_row(const struct arvo_errors *e, int n)
{
    printf("%4d", n);
    for (int k = 0; k < ARVO_NORMS; k++) {
        int digits = k == ARVO_LINF ? 4 : 5;
        printf("  ");
        for (int p = 0; p < ARVO_PROJECTIONS; p++)
            printf(" %*.*f", p == ARVO_COLLOCATION && k == ARVO_L1 ? 8 : 7, digits, e->of[k][p]);
        printf("%c", times_best(e, k, ARVO_COLLOCATION) > 2 ? '*' : ' ');
    }
    printf("\n");
}

static void print_table(const struct arvo_errors errors[FINEST + 1])
{
    const struct arvo_errors *f = &errors[1];
    printf("light of a unit square on a parallel one of 10 x 10 m at 1 m, by n x n constants\n"
           "norms of it: L1 %.6f W, L2 %.6f W/m, Linf %.6f W/m2\n",
           f->norm[ARVO_L1], f->norm[ARVO_L2], f->norm[ARVO_LINF]);
    printf("      L1 of the error, W         L2, W/m                    Linf, W/m2\n"
           "   n     best Galerk.  colloc.     best Galerk. colloc.     best Galerk. colloc.\n");
    for (int n = 1; n <= FINEST; n++)
        print_row(&errors[n], n);
    printf("* above twice the best: at n =");
    for (int n = 1; n <= FINEST; n++)
        if (times_best(&errors[n], ARVO_L1, ARVO_COLLOCATION) > 2
            || times_best(&errors[n], ARVO_L2, ARVO_COLLOCATION) > 2)
            printf(" %d", n);
    printf("\n");
}

static int write_csv(const char *path, const struct arvo_errors errors[FINEST + 1])
{
    struct atomic_file file;
    if (atomic_open(&file, path))
        return -1;
    fputs("n,elements", file.stream);
    for (int k = 0; k < ARVO_NORMS; k++) {
        for (int p = 0; p < ARVO_PROJECTIONS; p++)
            fprintf(file.stream, ",%s_%s", norm_names[k], projection_names[p]);
        fprintf(file.stream, ",%s_twice_best,%s_of_f", norm_names[k], norm_names[k]);
    }
    for (int n = 1; n <= FINEST; n++) {
        fprintf(file.stream, "\n%d,%d", n, n * n);
        for (int k = 0; k < ARVO_NORMS; k++) {
            for (int p = 0; p < ARVO_PROJECTIONS; p++)
                fprintf(file.stream, ",%.9f", errors[n].of[k][p]);
            fprintf(file.stream, ",%.9f,%.9f", 2 * errors[n].of[k][ARVO_BEST], errors[n].norm[k]);
        }
    }
    fputc('\n', file.stream);
    return atomic_commit(&file);
}

/* Figure 4: a panel per norm, both axes logarithmic. */
static void print_plot(FILE *out, const void *context)
{
    const struct arvo_errors *errors = context;
    fprintf(out, "set multiplot layout 1,3 title 'n x n constants: norms of the error'\n"
                 "set logscale xy 10\nset xrange [1:64]\nset xtics (1,2,4,8,16,32,64)\n"
                 "set xlabel 'n'\nset grid\nset key left bottom samplen 2 spacing 0.9\n");
    for (int k = 0; k < ARVO_NORMS; k++) {
        fprintf(out, "$panel%d << EOD\n", k);
        for (int n = 1; n <= FINEST; n++)
            fprintf(out, "%d %.9g %.9g %.9g\n", n, errors[n].of[k][ARVO_BEST],
                    errors[n].of[k][ARVO_GALERKIN], errors[n].of[k][ARVO_COLLOCATION]);
        fprintf(out,
                "EOD\nset title '%s'\nplot $panel%d using 1:2 with lines lw 2 lc 1 title 'best',"
                " '' using 1:(2*$2) with lines dt 2 lc 1 title 'twice the best',"
                " '' using 1:3 with lines lw 2 lc 2 title 'Galerkin',"
                " '' using 1:4 with linespoints pt 7 ps 0.4 lc 7 title 'collocation'\n",
                norm_titles[k], k);
    }
    fprintf(out, "unset multiplot\n");
}

int study_arvo(const struct options *o, const struct open_scene *scene)
{
    (void)scene;
    static struct arvo_errors errors[FINEST + 1];
    if (measure_all(o, errors) < 0)
        return 1;
    if (!o->quiet)
        print_table(errors);
    return (o->csv && write_csv(o->csv, errors) < 0)
           || (o->chart && chart_draw(o->chart, print_plot, errors) < 0);
}
