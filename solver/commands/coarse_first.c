/* coarse_first.c - see coarse_first.h.
 *
 * Particles know all light without a link: places to an error t by s^2 / t^2 rays, s^2 that of one
 * ray (engine/ray_split.c), and the means of polygons by some number that no link lowers. What lies
 * between the two is all that links can spare. They cost rays, and discussions and sweeps, which
 * take as long as PAIR rays for each pair discussed. So where that comes to more than a QUARTER of
 * what can be spared before the coarsest links are done, there are none; but for a LITTLE of what
 * polygons take anyway there may be. Scenes whose coarse links are done within FEW pairs are not
 * asked, nor whoever says how to solve for links or wants an account of their errors.
 *
 * Links of error e, point by point, and L rays are worth these only where particles from as many
 * would be farther off: e^2 < s^2 / L. So links come coarse first, with thresholds times COARSE,
 * and few particles measure e and s. Finer links, of L' rays and error e', spare s^2 (1 / e'^2 - 1
 * / e^2) rays. Were it rays that make the error, e^2 would fall with 1 / L; where elements make it,
 * it falls more slowly: with L^-.4 on maze_8, office3 and td, whose e^2 halves as L grows six
 * times. Then s^2 ((L' / L)^.4 - 1) / e^2 rays are spared, fewer than L' for every L' where e^2 is
 * above s^2 / (FINER L): particles are the cheaper way, and the coarse links stay. Finer links are
 * solved for anew: what was given up coarsely is not missed then. All follows from counts, so the
 * choice is the same on any machine, and on any number of them: several do not stop at a limit, for
 * each knows its own pairs alone, but ask afterwards. [Derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include "commands/checkpoint.h"
#include "commands/coarse_first.h"
#include "commands/thresholds.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/machines.h"
#include "util/report.h"

static const double COARSE = 16;
static const double FINER = 5.4; /* the least of x / (x^.4 - 1), at x = 3.6 */
/* rays of particles that take as long as discussing a pair and sweeping over what comes of it:
 * between 2.4 and 5 in scenes of 500 to 15,000 faces */
static const double PAIR = 4;
/* of what could be spared: on td and office3 coarse links spare .4 of it, and leaves that the first
 * particles tell spare some of it, too */
static const double QUARTER = 0.25;
static const double LITTLE = 0.125;
static const double FEW = 1e5; /* pairs: .2 seconds of one processor */

/* What a choice is made for, and where it stands. */
struct choice {
    struct coarse_first *c;
    struct solved *s;
    RadDevice device;
    RadScene scene;
    RadOracle oracle;
    struct RadSolveOptions how;
    struct thresholds thresholds;
    struct checkpoint point;
    int may_be_none;
};

/* Returns 0, 1 where the limit on pairs was met, or -1 after a message. */
static int solve_at(struct choice *x, double scale, double pairs)
{
    struct RadSolveOptions how = x->how;
    const int limited = pairs > 0 && !(how.limits.pairs > 0 && (double)how.limits.pairs <= pairs);
    thresholds_scale(&x->thresholds, scale);
    x->c->scale = x->point.scale = scale;
    x->point.rays = (double)x->c->rays;
    x->point.dear = limited && machines_count() == 1;
    if (x->point.dear)
        how.limits.pairs = (uint64_t)pairs;
    const double start = seconds();
    int status = checkpoint_solve(&x->point, x->s, x->device, x->scene, x->oracle, &how);
    if (status == 0 && limited && (double)x->s->report.pairs > pairs) {
        solved_close(x->s);
        status = 1;
    }
    x->c->seconds += status > 0 ? seconds() - start : 0;
    return status;
}

static int measure(struct choice *x, struct RadPlaces *p)
{
    const double start = seconds();
    if (radMeasurePlaces(x->s->solution, 0, p) < 0)
        return report_device(x->device, x->point.where);
    radGetReport(x->s->solution, &x->s->report);
    x->c->rays += p->rays;
    x->c->seconds += seconds() - start;
    return 0;
}

/* Do finer links pay? Returns 0 or 1, or -1 after a message. */
static int finer_pay(struct choice *x)
{
    struct RadPlaces p;
    if (measure(x, &p) < 0)
        return -1;
    return p.links * FINER * (double)x->s->report.rays < p.ray;
}

/* Solve without links, and find how many pairs links may cost to be tried: *pairs. Returns 0, or -1
 * after a message. */
static int solve_without(struct choice *x, double *pairs)
{
    struct RadSolveOptions how = x->how;
    struct RadPlaces p;
    how.no_links = 1;
    if (solved_open(x->s, x->device, x->point.where, x->scene, x->oracle, &how) < 0)
        return -1;
    if (measure(x, &p) < 0) {
        solved_close(x->s);
        return -1;
    }
    const double places = p.ray / (RAD_CORRECT_PLACES * RAD_CORRECT_PLACES),
                 faces = p.face / (RAD_CORRECT_NOISE * RAD_CORRECT_NOISE);
    *pairs = fmax(QUARTER * (places - faces), LITTLE * faces) / PAIR;
    return 0;
}

/* With coarse links, or with none where these cost too much. Returns 0, or -1 after a message. */
static int solve_coarse(struct choice *x)
{
    struct solved without, *with = x->s;
    double pairs;
    int status = solve_at(x, COARSE, x->may_be_none ? FEW : 0);
    if (status <= 0)
        return status;
    x->s = &without;
    status = solve_without(x, &pairs);
    x->s = with;
    if (status < 0)
        return -1;
    status = pairs > FEW ? solve_at(x, COARSE, pairs) : 1;
    if (status <= 0) {
        const struct RadReport *r = &without.report;
        x->c->seconds += r->seconds.build + r->seconds.refine + r->seconds.iterate;
        solved_close(&without);
        return status;
    }
    *with = without;
    x->c->no_links = 1;
    return 0;
}

static int choose(struct choice *x)
{
    struct coarse_first *c = x->c;
    const double start = seconds();
    int more = 1;
    if (!x->point.from || x->point.scale > 1) {
        if (solve_coarse(x) < 0)
            return -1;
        more = c->no_links ? 0 : finer_pay(x);
    } else {
        c->rays = (uint64_t)x->point.rays;
    }
    c->chosen = 1;
    if (more)
        c->seconds = seconds() - start;
    if (more == 0)
        return 0;
    if (x->s->solution) {
        c->rays += x->s->report.rays;
        solved_close(x->s);
    }
    return more < 0 ? -1 : solve_at(x, 1, 0);
}

int coarse_first_solve(struct coarse_first *c, struct solved *s, const struct options *o,
                       RadDevice device, RadScene scene, RadOracle oracle,
                       const struct RadSolveOptions *how)
{
    struct choice x = {
        .c = c, .s = s, .device = device, .scene = scene, .oracle = oracle, .how = *how};
    thresholds_open(&x.thresholds, oracle);
    *c = (struct coarse_first){.scale = o->scale > 0 ? o->scale : 1, .no_links = o->no_links};
    const int chosen = !(o->scale > 0) && !o->no_links && o->choose_scale && x.thresholds.count > 0;
    if (checkpoint_open(&x.point, o) < 0)
        return -1;
    if (x.point.from && (x.point.chosen != chosen || (!chosen && x.point.scale != c->scale)))
        return report_error(x.point.from, 0,
                            "cannot go on from it: it is of thresholds times %g%s; leave --restart "
                            "out to start anew",
                            x.point.scale, x.point.chosen ? ", as measured" : "");
    x.point.chosen = chosen;
    x.may_be_none = o->errors != ERRORS_ALL && o->closure == RAD_CLOSURE_NONE
                    && o->solver == RAD_SOLVER_GAUSS_SEIDEL && !(o->tolerance > 0);
    return chosen ? choose(&x) : solve_at(&x, c->scale, 0);
}

void coarse_first_print(const struct coarse_first *c)
{
    if (c->no_links && c->chosen)
        printf("scale     no links: they would cost more than the particles they spare (%.3g rays "
               "to find out)\n",
               (double)c->rays);
    else if (c->chosen)
        printf("scale     thresholds times %g: %s (%.3g rays and %.2f s to find out)\n", c->scale,
               c->scale > 1 ? "finer links would cost more than the particles they spare"
                            : "coarser ones would cost more particles than they spare",
               (double)c->rays, c->seconds);
}

json_t *coarse_first_json(const struct coarse_first *c)
{
    return json_pack("{s:o, s:b, s:I, s:f}", "thresholds_times",
                     c->no_links ? json_null() : json_real(c->scale), "chosen", c->chosen, "rays",
                     (json_int_t)c->rays, "seconds", c->seconds);
}
