/* checkpoint.h - `radiosity solve --checkpoint FILE.h5`, `--restart FILE.h5`: a solve between two
 * passes, in a file.
 *
 * After every pass the file is written anew; the one before stays until the new one is whole. It
 * holds the parts of a solution's state (radiosity.h), each a data set, and in attributes at which
 * thresholds they were made. A file that is no good is refused, and stays as it is.
 * SPDX-License-Identifier: MIT */
#ifndef CHECKPOINT_H
#define CHECKPOINT_H

#include "options/options.h"
#include "util/solved.h"

struct checkpoint {
    const char *to, *from; /* files; NULL: none. from becomes NULL once it is taken */
    const char *where;     /* the scene, for messages */
    double scale;          /* of the thresholds, of the solve that goes on */
    int chosen;            /* 1: that is not said by whoever called */
    double rays;           /* cast for the choice so far */
    int passes;            /* that the state taken had; -1: none was taken */
    int dear;              /* 1: a limit is met without a word */
    int quiet, failed;     /* failed: it could not be written, which is told */
};

/* By the options, which are checked. With a file to go on from, look at which scale: then
 * c->scale, chosen and rays are the file's. Returns 0, or -1 after a message. */
int checkpoint_open(struct checkpoint *c, const struct options *o);

/* Make a solution, go on from the file where there is one, and solve, writing checkpoints. Returns
 * 0; -1 after a message, with nothing to close; or 1, the same, where refinement has met a limit
 * and `dear` expects it to. */
int checkpoint_solve(struct checkpoint *c, struct solved *s, RadDevice device, RadScene scene,
                     RadOracle oracle, const struct RadSolveOptions *how);

#endif
