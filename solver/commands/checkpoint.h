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
    RadDevice device;
    const char *where; /* the scene, for messages */
    double scale;      /* of the thresholds, of the solve that goes on */
    int chosen;        /* 1: that is not said by whoever called */
    double rays;       /* cast for the choice so far */
    int passes;        /* that the state taken had; -1: none was taken */
    int quiet, failed; /* failed: a file could not be read or written, which is told */
};

/* By the options, which are checked. With a file to go on from, look at which scale: then
 * c->scale, chosen and rays are the file's. Returns 0, or -1 after a message. */
int checkpoint_open(struct checkpoint *c, RadDevice device, const struct options *o);

/* Have a new solution go on from the file where there is one, and write checkpoints as it is
 * solved. Returns 0, or -1 after a message. */
int checkpoint_begin(struct checkpoint *c, RadSolution solution);

/* Say why it was not solved, unless a checkpoint has said so. Returns -1. */
int checkpoint_report(struct checkpoint *c);

#endif
