/* solved.c - see solved.h.
 * SPDX-License-Identifier: MIT */
#include "util/solved.h"

#include <stdio.h>

#include "util/device.h"
#include "util/report.h"

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
    solved_take(s, s->scene, s->solution);
    return 0;
}

void solved_take(struct solved *s, RadScene scene, RadSolution solution)
{
    *s = (struct solved){.scene = scene, .solution = solution};
    radGetElements(solution, &s->elements);
    radGetLinks(solution, &s->links);
    radGetReport(solution, &s->report);
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

void solved_cause(const struct RadReport *r, char text[SOLVED_CAUSE])
{
    /* Where sweeps were too few, links change for what they left, and more of them come first. */
    if (r->changing && !(r->solved.bound > r->solved.tolerance))
        snprintf(text, SOLVED_CAUSE,
                 "%llu links still change after %d passes; larger thresholds (--set) split less",
                 (unsigned long long)r->changing, r->passes);
    else
        snprintf(text, SOLVED_CAUSE, "allow more --iterations, or loosen --tolerance");
}

int solved_status(const struct RadReport *r, const char *where)
{
    char cause[SOLVED_CAUSE];
    if (r->converged)
        return 0;
    solved_cause(r, cause);
    report_warning(where, 0, "not converged after %d sweeps (residual %.1e): %s", r->iterations,
                   r->residual, cause);
    return 3;
}
