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
#include "commands/coarse_first.h"
#include "commands/thresholds.h"
#include "util/clock.h"
#include "util/device.h"

static const double COARSE = 16;
static const double FINER = 5.4; /* the least of x / (x^.4 - 1), at x = 3.6 */

static int solve_at(struct coarse_first *c, struct solved *s, const struct options *o,
                    RadDevice device, RadScene scene, const struct thresholds *t, double scale,
                    const struct RadSolveOptions *how)
{
    thresholds_scale(t, scale);
    c->scale = scale;
    return solved_open(s, device, o->scene, scene, t->oracle, how);
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
    double start = seconds();
    thresholds_open(&t, oracle);
    *c = (struct coarse_first){.scale = o->scale > 0 ? o->scale : 1};
    if (o->scale > 0 || !o->choose_scale || t.count == 0)
        return solve_at(c, s, o, device, scene, &t, c->scale, how);
    if (solve_at(c, s, o, device, scene, &t, COARSE, how) < 0)
        return -1;
    double solved = seconds();
    int more = finer_pay(c, s, device, o->scene);
    c->chosen = 1;
    c->seconds = seconds() - (more ? start : solved);
    if (more == 0)
        return 0;
    c->rays += s->report.rays;
    solved_close(s);
    return more < 0 ? -1 : solve_at(c, s, o, device, scene, &t, 1, how);
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
