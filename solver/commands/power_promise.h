/* power_promise.h - does the light keep what the oracle promised in watts?
 * SPDX-License-Identifier: MIT */
#ifndef POWER_PROMISE_H
#define POWER_PROMISE_H

#include "commands/error_summary.h"

/* What the powers (area times radiosity) of all faces together are wrong by, W. */
struct power_promise {
    double tolerance; /* what was promised, of each band; 0: nothing */
    /* as measured, all bands, with a 95 % interval; value < 0: it is not */
    double value, low, high;
    uint32_t bands;
};

/* Measure, and mend by more particles where those so far do not show the promise kept; *m follows.
 * Returns 0, or -1 after a message. */
int power_promise_hold(struct power_promise *p, struct measured *m, const struct options *o,
                       RadDevice device, RadSolution solution);

/* Warn where the promise is not kept, or nothing shows that it is. */
void power_promise_warn(const struct power_promise *p, const char *where);
void power_promise_print(const struct power_promise *p);
/* Object `promise` of the JSON; null when nothing was promised. */
json_t *power_promise_json(const struct power_promise *p);

#endif
