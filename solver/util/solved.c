/* solved.c - see solved.h.
 * SPDX-License-Identifier: MIT */
#include "util/solved.h"

#include "util/device.h"

int solved_begin(struct solved *s, RadDevice device, const char *where, RadScene scene,
                 RadOracle oracle, const struct RadSolveOptions *how)
{
    *s = (struct solved){.scene = scene, .solution = radNewSolution(scene, oracle, how)};
    if (!s->solution)
        return report_device(device, where);
    radGetElements(s->solution, &s->elements);
    return 0;
}

int solved_finish(struct solved *s, const struct RadSolveOptions *how)
{
    if ((how->unit ? radRefine(s->solution) : radSolve(s->solution)) < 0) {
        solved_close(s);
        return -1;
    }
    radGetElements(s->solution, &s->elements);
    radGetLinks(s->solution, &s->links);
    radGetReport(s->solution, &s->report);
    return 0;
}

int solved_open(struct solved *s, RadDevice device, const char *where, RadScene scene,
                RadOracle oracle, const struct RadSolveOptions *how)
{
    if (solved_begin(s, device, where, scene, oracle, how) < 0)
        return -1;
    return solved_finish(s, how) < 0 ? report_device(device, where) : 0;
}

void solved_close(struct solved *s)
{
    radReleaseSolution(s->solution);
    s->solution = NULL;
}
