/* stability_order.c - the order in which the error of a method falls as the method is refined.
 *
 * A cell is run again with more of what the method's error comes from: rays times 4 and 16, a form
 * factor from 4 x 4 and 16 x 16 parts; an oracle's thresholds and smallest part times 4 and 1/4,
 * as sixteenths of those of a few rows would take minutes. Where error = C work^-order, order is
 * the slope of the logarithms; of three points it is the least-squares line's. Errors at rounding
 * say nothing about it and are left out.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "study/stability.h"

enum { LEVELS = 3 };

/* Below these an error is that of the arithmetic, relative: links hold F in single precision (6e-8)
 * and equations are solved to 1e-6 (stability_solve); formulas are in double precision. */
#define ROUNDING_OF_LINKS 1e-6
#define ROUNDING_OF_FORMULAS 1e-12

double stability_slope(int count, const double *work, const double *error, double rounding)
{
    double least = INFINITY, most = 0, n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (int i = 0; i < count; i++) {
        if (!(error[i] > rounding) || isinf(error[i]) || work[i] <= 0)
            continue;
        double u = log(work[i]), v = log(error[i]);
        least = fmin(least, work[i]);
        most = fmax(most, work[i]);
        n++;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    return n >= 2 && most >= 2 * least ? -(n * xy - x * y) / (n * xx - x * x) : NAN;
}

int stability_order(const struct stability_case *c, const struct stability_cell *cell, int threads,
                    const struct stability_trial *first, double *order)
{
    double work[LEVELS] = {first->work}, error[LEVELS] = {first->error};
    double rounding = first->method->kind == BY_ORACLE ? ROUNDING_OF_LINKS : ROUNDING_OF_FORMULAS;
    *order = NAN;
    if (c->limit != CONVERGES || !(first->work > 0) || !(first->error > rounding)
        || isinf(first->error))
        return 0;
    for (int i = 1; i < LEVELS; i++) {
        struct stability_trial trial;
        const struct stability_run how = {threads,
                                          i == 2 && first->method->kind == BY_ORACLE ? -1 : i};
        if (stability_run(c, cell, &how, &trial) < 0)
            return -1;
        work[i] = trial.work;
        error[i] = trial.error;
    }
    *order = stability_slope(LEVELS, work, error, rounding);
    return 0;
}
