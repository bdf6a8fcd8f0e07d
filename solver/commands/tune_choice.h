/* tune_choice.h - how near to the shipped values fits stay, as scenes left out say.
 * SPDX-License-Identifier: MIT */
#ifndef TUNE_CHOICE_H
#define TUNE_CHOICE_H

#include "commands/tune_report.h"

/* Solve each scene with what the fit without it would take, for each penalty; then give every fit
 * the place that the best of the holds makes it take. Returns 0, 1 when it was stopped, which
 * leaves the fits where they were, -1 after a message. */
int tune_choose(struct tune_outcome *o);

#endif
