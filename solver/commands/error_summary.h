/* error_summary.h - a solution mended and measured by particles, and what is told of it.
 * SPDX-License-Identifier: MIT */
#ifndef ERROR_SUMMARY_H
#define ERROR_SUMMARY_H

#include <jansson.h>
#include "options/options.h"

/* What mending and measuring said. */
struct measured {
    int mended, measured;
    struct RadErrorReport alone; /* of the links, by the particles that mended them */
    struct RadErrorReport error; /* of what is shown, by others */
    int accounted;
    struct RadAccountReport account; /* of what the links alone say, by cause */
    double account_seconds;
};

/* Does what is written show what is measured of leaves? */
int measured_wants_leaves(const struct options *o);

/* Mend and measure as the options say. Returns 0, or -1 after a message. */
int measured_take(struct measured *m, const struct options *o, RadDevice device,
                  RadSolution solution);

/* The account of error by cause. Returns 0, or -1 after a message. */
int measured_account(struct measured *m, const struct options *o, RadDevice device,
                     RadSolution solution);

/* Above this share of the reflected light a warning is given. */
#define MEASURED_WARNING 0.05
/* Warn of a large error. */
void measured_warn(const struct measured *m, const char *where);

/* What the links alone were off by, or where there are none the first few particles, and that was
 * mended; what is left; and how many large faces are too dim to be sure of, if any. */
void measured_print(const struct measured *m, uint32_t polygons, int no_links);

/* What mending and measuring took. */
double measured_seconds(const struct measured *m);

/* Object `error` of the JSON; null when nothing was measured. */
json_t *measured_json(const struct measured *m, uint32_t polygons);
/* Object `correction`; null when nothing was mended. */
json_t *mended_json(const struct measured *m);

#endif
