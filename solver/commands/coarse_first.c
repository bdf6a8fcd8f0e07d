/* coarse_first.c - see coarse_first.h.
 *
 * Links of error e, point by point, and L rays are worth these only where particles from as many
 * would be farther off: e^2 < s^2 / L, s^2 that of one ray (engine/ray_split.c). So links come
 * coarse first, with thresholds times COARSE, and few particles measure e and s. Finer links, of L'
 * rays and error e', spare s^2 (1 / e'^2 - 1 / e^2) rays. Were it rays that make the error, e^2
 * would fall with 1 / L; where elements make it, it falls more slowly: with L^-.4 on maze_8,
 * office3 and td, whose e^2 halves as L grows six times. Then s^2 ((L' / L)^.4 - 1) / e^2 rays are
 * spared, fewer than L' for every L' where e^2 is above s^2 / (FINER L): particles are the cheaper
 * way, and the coarse links stay. Finer links are solved for anew: what was given up coarsely is
 * not missed then. All follows from counts, so the choice is the same on any machine. [Derived
 * here]
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "commands/checkpoint.h"
#include "commands/coarse_first.h"
#include "commands/thresholds.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/report.h"

static const double COARSE = 16;
static const double FINER = 5.4; /* the least of x / (x^.4 - 1), at x = 3.6 */

static int solve_at(struct coarse_first *c, struct solved *s, RadDevice device, RadScene scene,
                    const struct thresholds *t, double scale, const struct RadSolveOptions *how,
                    struct checkpoint *point)
{
    thresholds_scale(t, scale);
    c->scale = point->scale = scale;
    point->rays = (double)c->rays;
    return checkpoint_solve(point, s, device, scene, t->oracle, how);
}

/* Do finer links pay? Returns 0 or 1, or -1 after a message. */
static int finer_pay(struct coarse_first *c, struct solved *s, RadDevice device, const char *where)
{
    struct RadPlaces p;
    if (radMeasurePlaces(s->solution, 0, &p) < 0)
        return report_device(device, where);
    radGetReport(s->solution, &s->report);
    c->rays += p.rays;
    return p.links * FINER * (double)s->report.rays < p.ray;
}

int coarse_first_solve(struct coarse_first *c, struct solved *s, const struct options *o,
                       RadDevice device, RadScene scene, RadOracle oracle,
                       const struct RadSolveOptions *how)
{
    struct thresholds t;
    struct checkpoint point;
    double start = seconds();
    thresholds_open(&t, oracle);
    *c = (struct coarse_first){.scale = o->scale > 0 ? o->scale : 1};
    const int chosen = !(o->scale > 0) && o->choose_scale && t.count > 0;
    if (checkpoint_open(&point, o) < 0)
        return -1;
    if (point.from && (point.chosen != chosen || (!chosen && point.scale != c->scale)))
        return report_error(point.from, 0,
                            "cannot go on from it: it is of thresholds times %g%s; leave --restart "
                            "out to start anew",
                            point.scale, point.chosen ? ", as measured" : "");
    point.chosen = chosen;
    if (!chosen)
        return solve_at(c, s, device, scene, &t, c->scale, how, &point);
    double solved = start;
    int more = 1;
    if (!point.from || point.scale > 1) {
        if (solve_at(c, s, device, scene, &t, COARSE, how, &point) < 0)
            return -1;
        solved = seconds();
        more = finer_pay(c, s, device, o->scene);
    } else {
        c->rays = (uint64_t)point.rays;
    }
    c->chosen = 1;
    c->seconds = seconds() - (more ? start : solved);
    if (more == 0)
        return 0;
    if (s->solution) {
        c->rays += s->report.rays;
        solved_close(s);
    }
    return more < 0 ? -1 : solve_at(c, s, device, scene, &t, 1, how, &point);
}

void coarse_first_print(const struct coarse_first *c)
{
    if (c->chosen)
        printf("scale     thresholds times %g: %s (%.3g rays and %.2f s to find out)\n", c->scale,
               c->scale > 1 ? "finer links would cost more than the particles they spare"
                            : "coarser ones would cost more particles than they spare",
               (double)c->rays, c->seconds);
}

json_t *coarse_first_json(const struct coarse_first *c)
{
    return json_pack("{s:f, s:b, s:I, s:f}", "thresholds_times", c->scale, "chosen", c->chosen,
                     "rays", (json_int_t)c->rays, "seconds", c->seconds);
}
