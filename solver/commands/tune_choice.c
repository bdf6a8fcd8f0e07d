/* tune_choice.c - see tune_choice.h.
 *
 * The lowest place of a fit is low for its scenes partly by luck: prices are jagged, since rays are
 * cast, and a threshold that hardly matters for these scenes goes wherever their noise leads.
 * Other scenes pay for that. So a place has to earn its distance from the start: a fit takes the
 * place where the mean logarithm of prices and `penalty` times the sum of the squares of what was
 * doubled are least together. Which penalty is the one with which scenes left out fare best: ridge
 * regression with its weight by cross-validation (Stone 1974), over places that were looked at
 * anyway, so that it costs next to nothing. Only a penalty that carries over is taken, with which
 * no scene left out needs more than TUNE_CARRIES times as much as used: else scenes are being
 * learnt by heart, however cheap others are in the mean. An infinite penalty is among them: where
 * nothing carries over, the shipped values stay.
 *
 * A fit without a scene takes only what its own search has looked at: places where other fits have
 * been led by that scene are not its own.
 * SPDX-License-Identifier: MIT */
#include "commands/tune_choice.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Mean logarithm of prices for each squared doubling of a parameter. .01 to .1: a doubling of one
 * has to save 1 to 10 %. */
static const double penalties[TUNE_PENALTIES] = {INFINITY, 0.1, 0.05, 0.03, 0.02, 0.01, 0.003, 0};

/* Sum over parameters of doublings squared. */
static double distance(const struct tuner *t, const int *at)
{
    double sum = 0;
    for (int i = 0; i < t->parameter_count; i++)
        sum += at[i] * at[i] / (double)(TUNE_QUARTERS * TUNE_QUARTERS);
    return sum;
}

/* Mean logarithm of the prices of the scenes of a fit, over those of the start; INFINITY where one
 * is not known. */
static double mean_price(const struct tuner *t, const struct tune_point *p, int left_out)
{
    double mean = 0;
    for (int s = 0; s < t->scene_count; s++)
        if (s != left_out)
            mean += p->results[s].state == TUNE_KNOWN ? log(p->results[s].price / t->defaults[s])
                                                            / (t->scene_count - (left_out >= 0))
                                                      : INFINITY;
    return mean;
}

/* Where the fit goes with this penalty. */
static void adopt(const struct tuner *t, struct tune_fit *f, double penalty)
{
    double least = INFINITY;
    for (size_t i = 0; i < t->point_count; i++) {
        const struct tune_point *p = &t->points[i];
        double far = distance(t, p->at);
        if (f->left_out >= 0 && !(p->fits & tune_bit(f->left_out)))
            continue;
        double value = mean_price(t, p, f->left_out) + (far > 0 ? penalty * far : 0);
        if (!(value < least))
            continue;
        least = value;
        memcpy(f->at, p->at, sizeof f->at);
    }
}

/* Hold each scene with the fit that has not seen it against the same with the others. Returns 0, 1
 * when it was stopped, -1 after a message. */
static int judge(struct tuner *t, struct tune_fold *folds)
{
    int count = t->scene_count;
    for (int s = 0; s < count; s++) {
        struct tune_fold *f = &folds[s];
        f->used_cost = f->used_needs = f->used_error = 0;
        snprintf(t->doing, sizeof t->doing, "%.*s, which was left out", t->scenes[s].name_length,
                 t->scenes[s].name);
        for (int other = 0; other < count; other++) {
            struct tune_result r;
            int status = tune_result(t, folds[other].fit.at, s, &r);
            if (status)
                return status;
            if (other == s) {
                f->left = r;
            } else {
                f->used_cost += log(r.cost) / (count - 1);
                f->used_needs += log(tune_needs(t, &r)) / (count - 1);
                f->used_error += r.error / (count - 1);
            }
        }
        f->used_cost = exp(f->used_cost);
        f->used_needs = exp(f->used_needs);
        f->ratio = tune_needs(t, &f->left) / f->used_needs;
        /* a fit of which no more than its start was looked at says nothing */
        f->known = f->fit.found.evaluations > 1 || f->fit.found.end == PATTERN_FOUND;
    }
    return 0;
}

/* Give all fits what they take with one of the penalties, and judge that. Returns as judge does. */
static int adopt_all(struct tune_outcome *o, int which)
{
    struct tuner *t = o->tuner;
    struct tune_held *h = &o->held[which];
    double mean = 0;
    for (int s = 0; s < o->fold_count; s++)
        adopt(t, &o->folds[s].fit, penalties[which]);
    int status = judge(t, o->folds);
    for (int s = 0; s < o->fold_count && status == 0; s++)
        mean += log(o->folds[s].left.price / t->defaults[s]) / o->fold_count;
    *h = (struct tune_held){penalties[which], exp(mean), tune_worst(o)};
    o->penalty = which;
    return status;
}

/* Does a take the place of b? A fit that carries over that of one that does not. */
static int better(const struct tune_held *a, const struct tune_held *b)
{
    int carries = a->worst <= TUNE_CARRIES, other = b->worst <= TUNE_CARRIES;
    return carries != other ? carries : a->times < b->times;
}

int tune_choose(struct tune_outcome *o)
{
    int best = 0, status = 0;
    for (int h = 0; h < TUNE_PENALTIES && status == 0; h++) {
        status = adopt_all(o, h);
        if (status == 0 && better(&o->held[h], &o->held[best]))
            best = h;
    }
    if (status == 0)
        status = adopt_all(o, best);
    if (status) {
        for (int s = 0; s < o->fold_count; s++) {
            o->folds[s].known = 0;
            memcpy(o->folds[s].fit.at, o->folds[s].fit.found.at, sizeof o->folds[s].fit.at);
        }
        return status;
    }
    adopt(o->tuner, &o->all, penalties[best]);
    o->chosen = 1;
    return 0;
}
