/* coarse_first.c - see coarse_first.h.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "commands/checkpoint.h"
#include "commands/coarse_first.h"
#include "util/device.h"
#include "util/report.h"

static int begin(void *user, RadSolution solution, const struct RadChoice *choice)
{
    struct checkpoint *point = user;
    point->scale = choice->scale;
    point->rays = (double)choice->rays;
    return choice->no_links ? 0 : checkpoint_begin(point, solution);
}

/* Returns 0, or -1 after a message. */
static int choose(struct coarse_first *c, struct solved *s, struct checkpoint *point,
                  RadScene scene, RadOracle oracle, const struct RadSolveOptions *how,
                  int keep_links)
{
    const struct RadChoiceOptions wishes = {
        .keep_links = keep_links, .begin = begin, .user = point};
    RadSolution solution = radSolveScene(scene, oracle, how, &wishes, &c->choice);
    if (!solution)
        return checkpoint_report(point);
    solved_take(s, scene, solution);
    c->chosen = 1;
    return 0;
}

/* With thresholds times c->choice.scale. Returns 0, or -1 after a message. */
static int solve_at(struct coarse_first *c, struct solved *s, struct checkpoint *point,
                    RadScene scene, RadOracle oracle, const struct RadSolveOptions *how)
{
    point->scale = c->choice.scale;
    if (radScaleOracle(oracle, c->choice.scale) < 0)
        return report_device(point->device, point->where);
    if (solved_begin(s, point->device, point->where, scene, oracle, how) < 0)
        return -1;
    if (checkpoint_begin(point, s->solution) < 0) {
        solved_close(s);
        return -1;
    }
    return solved_finish(s, how) < 0 ? checkpoint_report(point) : 0;
}

int coarse_first_solve(struct coarse_first *c, struct solved *s, const struct options *o,
                       RadDevice device, RadScene scene, RadOracle oracle,
                       const struct RadSolveOptions *how)
{
    struct checkpoint point;
    *c = (struct coarse_first){
        .choice = {.scale = o->scale > 0 ? o->scale : 1, .no_links = o->no_links}};
    const int chosen =
        !(o->scale > 0) && !o->no_links && o->choose_scale && radScaleOracle(oracle, 1) > 0;
    if (checkpoint_open(&point, device, o) < 0)
        return -1;
    if (point.from && (point.chosen != chosen || (!chosen && point.scale != c->choice.scale)))
        return report_error(point.from, 0,
                            "cannot go on from it: it is of thresholds times %g%s; leave --restart "
                            "out to start anew",
                            point.scale, point.chosen ? ", as measured" : "");
    point.chosen = chosen;
    if (chosen && !(point.from && point.scale <= 1))
        return choose(c, s, &point, scene, oracle, how, o->errors == ERRORS_ALL);
    c->chosen = chosen;
    c->choice.rays = (uint64_t)(chosen ? point.rays : 0);
    return solve_at(c, s, &point, scene, oracle, how);
}

void coarse_first_print(const struct coarse_first *c)
{
    const struct RadChoice *choice = &c->choice;
    if (choice->no_links && c->chosen)
        printf("scale     no links: they would cost more than the particles they spare (%.3g rays "
               "to find out)\n",
               (double)choice->rays);
    else if (c->chosen)
        printf("scale     thresholds times %g: %s (%.3g rays and %.2f s to find out)\n",
               choice->scale,
               choice->scale > 1 ? "finer links would cost more than the particles they spare"
                                 : "coarser ones would cost more particles than they spare",
               (double)choice->rays, choice->seconds);
}

json_t *coarse_first_json(const struct coarse_first *c)
{
    return json_pack("{s:o, s:b, s:I, s:f}", "thresholds_times",
                     c->choice.no_links ? json_null() : json_real(c->choice.scale), "chosen",
                     c->chosen, "rays", (json_int_t)c->choice.rays, "seconds", c->choice.seconds);
}
