/* thresholds.c - see thresholds.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "commands/thresholds.h"

static int is_scaled(const struct oracle_parameter *p)
{
    return !p->fixed
           && (p->role == ROLE_LINK_THRESHOLD || p->role == ROLE_SMALLEST_PART
               || p->role == ROLE_RELATIVE_ERROR_TOLERANCE
               || p->role == ROLE_RELATIVE_POWER_TOLERANCE);
}

void thresholds_open(struct thresholds *t, RadOracle oracle)
{
    struct RadOracleReport report;
    radGetOracleReport(oracle, &report);
    *t = (struct thresholds){.oracle = oracle};
    for (int i = 0; i < report.parameter_count && t->count < THRESHOLDS; i++) {
        const struct oracle_parameter *p = &report.parameters[i];
        if (is_scaled(p))
            t->of[t->count++] = (struct threshold){p->name, radGetOracleParameter(oracle, p->name),
                                                   p->low, p->high, p->role == ROLE_SMALLEST_PART};
    }
}

void thresholds_scale(const struct thresholds *t, double scale)
{
    for (int i = 0; i < t->count; i++) {
        double value = t->of[i].value * (t->of[i].part ? fmin(scale, 1) : scale);
        radSetOracleParameter(t->oracle, t->of[i].name,
                              fmin(fmax(value, t->of[i].low), t->of[i].high));
    }
}
