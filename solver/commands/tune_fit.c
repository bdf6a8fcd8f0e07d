/* tune_fit.c - see tune_fit.h.
 *
 * A scene's price is what it cost, far below the target: a scene that is easier than others shall
 * not pay for them. Far above, the cost is multiplied by a power of error over target, which has to
 * be steep: the first few rays of links buy most of what they ever buy, so that by mild powers the
 * best links are none at all. At the square, the rate of particles, cornell by bf_guarded wants
 * 8,500 rays and 5.4 %, not 7.5 million and 2.2; at the fourth power, the rate at which links bring
 * errors down themselves (their 2.5th to fourth root), panels still wants 48 %. Between, the price
 * turns slowly, (1 + (error / target)^2)^(power / 2): with a corner at the target the fit is where
 * the hardest scene meets it and no other has a say, and without that scene it is elsewhere. The
 * fit makes the mean of the logarithms least, which is the same whatever a scene costs by itself.
 *
 * A place where any scene costs more than GUARD times what it costs at the best place so far is
 * given up, as soon as that is so: what is far too fine would take hours.
 * SPDX-License-Identifier: MIT */
#include "commands/tune_fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "util/array.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/report.h"
#include "util/stop_signal.h"

/* A step is a doubling, and changes a cost by 4 at the most where links go with its square. */
static const double GUARD = 4;

/* Time of a discussion over time of a ray, 1.0 us over 25 ns: least squares over the user seconds
 * of 24 solves, cornell, room and maze_8 by eight oracles, which it meets within 30 %. */
static const double TUNE_PAIR = 40;

double tune_value(const struct tune_parameter *p, int quarters)
{
    char text[32];
    if (quarters == 0)
        return p->value;
    snprintf(text, sizeof text, "%.1e", p->value * exp2((double)quarters / TUNE_QUARTERS));
    return strtod(text, NULL);
}

int tuner_open(struct tuner *t)
{
    t->limit = INFINITY;
    t->defaults = calloc((size_t)t->scene_count, sizeof *t->defaults);
    return t->defaults ? 0 : report_error("tune", 0, "out of memory");
}

void tuner_close(struct tuner *t)
{
    for (size_t i = 0; i < t->point_count; i++)
        free(t->points[i].results);
    free(t->points);
    free(t->defaults);
}

static double cost_of(const struct tuner *t, uint64_t rays, uint64_t links, uint64_t pairs)
{
    return t->cost == TUNE_LINKS  ? (double)links
           : t->cost == TUNE_RAYS ? (double)rays + (double)links
                                  : (double)rays + TUNE_PAIR * (double)pairs;
}

static int told_to_stop(const struct tuner *t)
{
    return stop_signal_came() || (t->deadline > 0 && seconds() > t->deadline);
}

int tune_watch(void *user, const struct RadProgress *at)
{
    struct tuner *t = user;
    progress_say(&t->progress, "%s; %d solves, %.3g rays", t->doing, t->solves, (double)at->rays);
    if (told_to_stop(t)
        || (strcmp(at->phase, "refine") == 0
            && cost_of(t, at->rays, at->links, at->pairs) > t->limit))
        t->cancelled = 1;
    return t->cancelled;
}

/* ---- solving */

/* The point at a place, new or not; -1 after a message. */
static int point_at(struct tuner *t, const int *at)
{
    size_t bytes = (size_t)t->parameter_count * sizeof *at;
    for (size_t i = 0; i < t->point_count; i++)
        if (memcmp(t->points[i].at, at, bytes) == 0)
            return (int)i;
    struct tune_result *results = calloc((size_t)t->scene_count, sizeof *results);
    if (!results
        || array_reserve(&t->points, t->point_count + 1, &t->point_capacity, sizeof *t->points)
               < 0) {
        free(results);
        return report_error("tune", 0, "out of memory for what was solved");
    }
    struct tune_point *p = &t->points[t->point_count++];
    *p = (struct tune_point){.results = results};
    memcpy(p->at, at, bytes);
    return (int)t->point_count - 1;
}

/* Solve a scene with the parameters of a place, at a cost of `limit` at the most. Returns 0, 1 when
 * it was cancelled, -1 after a message. */
static int solve(struct tuner *t, const int *at, int scene, double limit, struct tune_result *r)
{
    struct tune_scene *s = &t->scenes[scene];
    for (int i = 0; i < t->parameter_count; i++)
        if (radSetOracleParameter(t->oracle, t->parameters[i].name,
                                  tune_value(&t->parameters[i], at[i]))
            < 0)
            return report_error("tune", 0,
                                "%s cannot be %g; give it a range, by --param NAME=LOW:HIGH",
                                t->parameters[i].name, tune_value(&t->parameters[i], at[i]));
    t->limit = limit;
    t->cancelled = 0;
    t->solves++;
    const struct RadSolveOptions how = {.basis = t->basis};
    RadSolution solution = radNewSolution(s->scene.scene, t->oracle, &how);
    int status = 0;
    if (!solution || radSolve(solution) < 0)
        status = report_unless_cancelled(s->scene.device, s->scene.path);
    t->limit = INFINITY;
    double error = 0;
    if (status == 0)
        status = tune_scene_error(s, solution, t->target, &error);
    if (status == 0) {
        struct RadReport report;
        radGetReport(solution, &report);
        double cost = fmax(1, cost_of(t, report.rays, report.links, report.pairs));
        *r = (struct tune_result){TUNE_KNOWN, error, cost,
                                  cost * pow(hypot(1, error / t->target), t->power)};
    }
    radReleaseSolution(solution);
    return status;
}

/* Solve a scene unless that is known, or known to be above the limit. Returns 0, 1 when it was
 * stopped, -1 after a message. */
static int result_within(struct tuner *t, const int *at, int scene, double limit,
                         struct tune_result *result)
{
    int index = point_at(t, at);
    if (index < 0)
        return -1;
    struct tune_result *r = &t->points[index].results[scene];
    int status = 0;
    if (r->state == TUNE_UNKNOWN || (r->state == TUNE_OVER && r->cost < limit)) {
        if (told_to_stop(t))
            return 1;
        status = solve(t, at, scene, limit, r);
        if (status == 1 && !told_to_stop(t)) {
            *r = (struct tune_result){.state = TUNE_OVER, .cost = limit};
            status = 0;
        }
    }
    *result = *r;
    return status;
}

int tune_result(struct tuner *t, const int *at, int scene, struct tune_result *result)
{
    return result_within(t, at, scene, INFINITY, result);
}

/* ---- fitting */

int tune_fits(const struct tuner *t)
{
    return t->scene_count > 1 ? t->scene_count + 1 : 1;
}

uint64_t tune_bit(int left_out)
{
    return UINT64_C(1) << (left_out < 62 ? left_out + 1 : 63);
}

int tune_defaults(struct tuner *t)
{
    static const int defaults[PATTERN_NUMBERS];
    for (int s = 0; s < t->scene_count; s++) {
        struct tune_result r;
        snprintf(t->doing, sizeof t->doing, "%.*s with the defaults", t->scenes[s].name_length,
                 t->scenes[s].name);
        int status = tune_result(t, defaults, s, &r);
        if (status)
            return status;
        t->defaults[s] = r.price;
    }
    return 0;
}

struct fit {
    struct tuner *tuner;
    int left_out, looked;
    double best;
    double costs[]; /* [2 * scene_count]: at the best place, INFINITY where none is
                        known; then room for those under way */
};

/* Mean logarithm of the scenes' prices over those of the defaults. A function for pattern_search.
 */
static int mean_price(void *user, const int *at, double *value)
{
    struct fit *f = user;
    struct tuner *t = f->tuner;
    int used = t->scene_count - (f->left_out >= 0);
    double sum = 0, *costs = f->costs + t->scene_count;
    int index = point_at(t, at);
    if (index < 0)
        return t->failed = 1, -1;
    t->points[index].fits |= tune_bit(f->left_out);
    f->looked++;
    for (int s = 0; s < t->scene_count; s++) {
        struct tune_result r;
        if (s == f->left_out)
            continue;
        snprintf(t->doing, sizeof t->doing,
                 "fit %d of %d, place %d, best %.3f of the defaults: %.*s", f->left_out + 2,
                 tune_fits(t), f->looked, exp(f->best), t->scenes[s].name_length,
                 t->scenes[s].name);
        double limit = GUARD * f->costs[s];
        int status = result_within(t, at, s, limit, &r);
        if (status) {
            t->failed |= status < 0;
            return -1;
        }
        if (r.state == TUNE_OVER || r.cost > limit) {
            *value = INFINITY;
            return 0;
        }
        costs[s] = r.cost;
        sum += log(r.price / t->defaults[s]) / used;
    }
    *value = sum;
    if (!(sum < f->best))
        return 0;
    f->best = sum;
    memcpy(f->costs, costs, (size_t)t->scene_count * sizeof *costs);
    return 0;
}

int tune_fit(struct tuner *t, int left_out, struct tune_fit *fit)
{
    struct fit *f = calloc(1, sizeof *f + 2 * (size_t)t->scene_count * sizeof *f->costs);
    if (!f)
        return report_error("tune", 0, "out of memory for a fit");
    *f = (struct fit){.tuner = t, .left_out = left_out, .best = INFINITY};
    for (int s = 0; s < t->scene_count; s++)
        f->costs[s] = INFINITY;
    struct pattern_search search = {.count = t->parameter_count,
                                    .step = TUNE_QUARTERS,
                                    .together = 1,
                                    .evaluations = t->evaluations,
                                    .value = mean_price,
                                    .user = f};
    int start[PATTERN_NUMBERS] = {0};
    for (int i = 0; i < t->parameter_count; i++) {
        const struct tune_parameter *p = &t->parameters[i];
        search.low[i] = p->low;
        search.high[i] = p->high;
        start[i] = p->low > 0 ? p->low : p->high < 0 ? p->high : 0;
    }
    *fit = (struct tune_fit){.left_out = left_out, .found = pattern_search(&search, start)};
    memcpy(fit->at, fit->found.at, sizeof fit->at);
    free(f);
    if (fit->found.end == PATTERN_MEMORY)
        return report_error("tune", 0, "out of memory for the search");
    return t->failed ? -1 : 0;
}
