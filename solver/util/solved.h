/* solved.h - a solution and the views of it that commands and studies read.
 * SPDX-License-Identifier: MIT */
#ifndef SOLVED_H
#define SOLVED_H

#include "radiosity.h"

struct solved {
    RadScene scene; /* kept alive by the solution */
    RadSolution solution;
    struct RadElements elements;
    struct RadLinks links;
    struct RadReport report;
};

/* Make a solution over a committed scene: elements and what answers about rays, without links.
 * Returns 0, or -1 after a message that names `where`, with nothing to close. */
int solved_begin(struct solved *s, RadDevice device, const char *where, RadScene scene,
                 RadOracle oracle, const struct RadSolveOptions *how);

/* Solve it; with how->unit, refine it alone. Returns 0, or -1 after an error of the device, with
 * nothing to close. */
int solved_finish(struct solved *s, const struct RadSolveOptions *how);

/* Make a solution over a committed scene and solve it; with how->unit, refine it alone.
 * Returns 0, or -1 after a message that names `where`, with nothing to close. */
int solved_open(struct solved *s, RadDevice device, const char *where, RadScene scene,
                RadOracle oracle, const struct RadSolveOptions *how);
/* Of a solution that is solved, which is held from now on. */
void solved_take(struct solved *s, RadScene scene, RadSolution solution);
void solved_close(struct solved *s);

/* Why the answer is not converged, and what to do: a phrase. */
enum { SOLVED_CAUSE = 128 };
void solved_cause(const struct RadReport *report, char text[SOLVED_CAUSE]);

/* What the exit status has of it: 0, or of an answer that is not converged 3, after a warning that
 * names `where`, also with -q. */
int solved_status(const struct RadReport *report, const char *where);

#endif
