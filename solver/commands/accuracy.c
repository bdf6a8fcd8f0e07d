/* accuracy.c - see accuracy.h.
 *
 * Two things bring the error down. Particles mend what elements hold, so they alone bring down the
 * error of faces and of all light together, whatever the links are; finer elements bring down what
 * varies within one. So links come coarse first, and what is dearer waits until a measurement asks
 * for it: the particles are made as many as the last interval says are needed, for noise falls
 * with their square root; and for errors over the surface (L2) the last step of either kind tells
 * which of the two gained more per ray. Each step begins anew, with all its particles: so a few
 * looks, each a small part of what is to come, say how many that is, and mostly one step does. The
 * interval's end counts, not its middle, and each measurement takes particles that nothing else has
 * seen: so when it says that the error is small enough, that is so in 97.5 % of cases.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include "commands/accuracy.h"
#include "util/clock.h"
#include "util/device.h"

/* rays of mending: of a first look; and at the least */
enum { FIRST_LOOK = 1 << 14, FIRST_RAYS = 1 << 16 };

/* One part in so many of these measure; of errors over the surface, of which those that mend know
 * nothing, as many. Measured: .5 % of faces in six scenes take a fifth fewer rays than with as
 * many, and no fewer with an eighth */
enum { MEASURING = 4 };

/* how coarse links are at first, against what is set; and at the finest */
static const double COARSEST = 8, FINEST = 1.0 / 1024;

/* Where no particle of so many rays was reflected, no more are traced: chosen, a few seconds */
static const double UNSEEN_RAYS = 1 << 22;
static const char unseen[] = "seeing nothing that is reflected";

/* of all that is cast: a guard against what would take hours */
static const double ACCURACY_RAYS = 2e10;

/* How large the error may be, by the last measurement. That of faces is also no smaller than what
 * chance leaves of it, whatever a measurement happens to say. */
static double reach(const struct options *o, const struct measured *m)
{
    const struct RadErrorReport *e = &m->error;
    return e->unseen > 0               ? INFINITY
           : o->norm == ACCURACY_POWER ? fmax(fabs(e->power.low), fabs(e->power.high))
           : o->norm == ACCURACY_L2    ? e->l2.high
                                       : fmax(e->l1_faces.high, m->alone.noise.high);
}

struct work {
    struct accuracy *a;
    struct solved *s;
    struct measured *m;
    const struct options *o;
    RadDevice device;
    RadScene scene;
    RadOracle oracle;
    const struct RadSolveOptions *how;
    int thresholds; /* that the oracle has, to be scaled */
    double start;
};

/* Mend by so many rays, and measure by others; or only look. Returns 0, or -1 after a
 * message. */
static int mend_and_measure(struct work *w, uint64_t rays, int look)
{
    const struct RadCorrectOptions correct = {.noise = 1e-9, .rays = rays, .look = look};
    const int surfaces = w->o->norm == ACCURACY_L2;
    const struct RadMeasureOptions measure = {.rays = surfaces ? rays : rays / MEASURING,
                                              .stream = (uint32_t)w->a->measurements++,
                                              .surfaces = surfaces,
                                              .polygons = look || !measured_wants_leaves(w->o)};
    if (radCorrect(w->s->solution, &correct, &w->m->alone) < 0
        || radMeasureError(w->s->solution, &measure, &w->m->error) < 0) {
        solved_close(w->s);
        return report_device(w->device, w->o->scene);
    }
    w->m->mended = w->m->measured = 1;
    w->a->rays += w->m->alone.rays + w->m->error.rays;
    return 0;
}

/* How many rays may be cast yet, by the time that they have taken so far; *why: what ends them. */
static double rays_left(const struct work *w, const char **why)
{
    const double spent = seconds() - w->start, cast = (double)w->a->rays,
                 by_guard = ACCURACY_RAYS - cast,
                 by_time = w->o->limit_seconds > 0
                               ? (w->o->limit_seconds / spent - 1) * fmax(1, cast)
                               : INFINITY;
    *why = by_time < by_guard ? "time (--limit-seconds)" : "the guard on rays";
    return fmin(by_time, by_guard);
}

/* What ends the work before the error is reached; NULL: nothing. A step that would take too long is
 * not begun. */
static const char *limit(const struct work *w, double next_rays)
{
    const char *why;
    return rays_left(w, &why) < next_rays ? why : NULL;
}

/* Of a step that did not reach: the next one takes so many times its rays at the least, and at the
 * most. */
static const double LEAST_MORE = 1.5, MOST_MORE = 16;

/* A look takes at most so many times the rays of the one before, and, if that may be, this share of
 * those to come. */
static const double LOOKS_MORE = 64, LOOKS = 1.0 / 16;

/* Of the rays that are left a step may count on so many: seconds of some rays are longer. Chosen */
static const double SURE_LEFT = 0.8;

/* What a step aims at, of the error that is wanted: from one measurement to another the interval's
 * end differs by a sixth, so that two in seven steps would miss if they aimed at nine tenths, and
 * one in seven does. */
static const double AIM = 0.8;

/* Particles until the error is reached or something ends it. The last step is as large as what is
 * left: it mends, though it will not reach. */
static int by_particles(struct work *w)
{
    const double wanted = w->o->accuracy;
    double rays = FIRST_LOOK;
    for (int look = 1;;) {
        const char *why;
        const uint64_t before = w->a->rays;
        if (mend_and_measure(w, (uint64_t)rays, look) < 0)
            return -1;
        const double reached = reach(w->o, w->m);
        if (isinf(reached) && rays >= UNSEEN_RAYS)
            return w->a->why = unseen, 0;
        const double ratio = reached / (AIM * wanted);
        /* how often as many rays there may be, and are to be */
        const double most = SURE_LEFT * rays_left(w, &why) / (double)(w->a->rays - before),
                     times = fmin(ratio * ratio, most);
        if (!look) {
            if (reached <= wanted)
                return w->a->reached = 1, 0;
            if (most < LEAST_MORE)
                return w->a->why = why, 0;
            rays *= fmin(fmax(times, LEAST_MORE), MOST_MORE);
        } else if (times * LOOKS > 1) {
            rays *= fmin(times * LOOKS, LOOKS_MORE);
        } else {
            rays = fmax(rays * times, FIRST_RAYS);
            look = 0;
        }
        if (isinf(reached))
            rays = fmin(rays, UNSEEN_RAYS);
    }
}

static int solve_at(struct work *w, double scale)
{
    *w->m = (struct measured){0};
    if (radScaleOracle(w->oracle, scale) < 0)
        return report_device(w->device, w->o->scene);
    if (solved_open(w->s, w->device, w->o->scene, w->scene, w->oracle, w->how) < 0)
        return -1;
    w->a->scale = scale;
    w->a->solves++;
    w->a->rays += w->s->report.rays;
    return 0;
}

/* Finer links and more particles by turns, whichever gained more per ray when last tried. */
static int by_both(struct work *w)
{
    double wanted = w->o->accuracy, rays = FIRST_RAYS, scale = w->a->scale;
    double gain[2] = {INFINITY, INFINITY}; /* per ray: of particles, of links */
    if (mend_and_measure(w, (uint64_t)rays, 0) < 0)
        return -1;
    for (;;) {
        double before = reach(w->o, w->m), cost = (double)w->a->rays;
        if (before <= wanted)
            return w->a->reached = 1, 0;
        if (isinf(before) && rays >= UNSEEN_RAYS)
            return w->a->why = unseen, 0;
        int links = gain[1] > gain[0] && w->thresholds > 0 && scale > FINEST;
        w->a->why = limit(w, links ? 4 * (double)w->s->report.rays : 8 * rays);
        if (w->a->why)
            return 0;
        if (links) {
            scale /= 2;
            solved_close(w->s);
            if (solve_at(w, scale) < 0)
                return -1;
        } else {
            rays *= 4;
        }
        if (mend_and_measure(w, (uint64_t)rays, 0) < 0)
            return -1;
        gain[links] = log(before / reach(w->o, w->m)) / ((double)w->a->rays - cost);
        if (!(gain[links] > 0))
            gain[links] = 0;
        if (gain[0] == 0 && gain[1] == 0) /* both by chance: try again, the dearer one last */
            gain[!links] = 1e-300;
    }
}

int accuracy_solve(struct accuracy *a, struct solved *s, struct measured *m,
                   const struct options *o, RadDevice device, RadScene scene, RadOracle oracle,
                   const struct RadSolveOptions *how)
{
    struct work w = {a, s, m, o, device, scene, oracle, how, radScaleOracle(oracle, 1), seconds()};
    *a = (struct accuracy){0};
    if (solve_at(&w, w.thresholds > 0 ? COARSEST : 1) < 0)
        return -1;
    int status = o->norm == ACCURACY_L2 ? by_both(&w) : by_particles(&w);
    a->seconds = seconds() - w.start;
    return status;
}

void accuracy_print(const struct accuracy *a, const struct options *o)
{
    printf("accuracy  %.3g %% (%s) %s%s: thresholds times %.3g, %d solve%s, %d measurement%s, "
           "%.3g rays, %.2f s\n",
           100 * o->accuracy, norm_words[o->norm], a->reached ? "kept" : "NOT kept, stopped by ",
           a->reached ? "" : a->why, a->scale, a->solves, a->solves == 1 ? "" : "s",
           a->measurements, a->measurements == 1 ? "" : "s", (double)a->rays, a->seconds);
}

json_t *accuracy_json(const struct accuracy *a, const struct options *o)
{
    return json_pack("{s:f, s:s, s:b, s:s?, s:f, s:i, s:i, s:I, s:f}", "wanted", o->accuracy,
                     "norm", norm_words[o->norm], "reached", a->reached, "stopped_by",
                     a->reached ? NULL : a->why, "thresholds_times", a->scale, "solves", a->solves,
                     "measurements", a->measurements, "rays", (json_int_t)a->rays, "seconds",
                     a->seconds);
}
