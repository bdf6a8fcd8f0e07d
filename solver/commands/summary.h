/* summary.h - what a solve did: a page for people, an object for programs.
 * SPDX-License-Identifier: MIT */
#ifndef SUMMARY_H
#define SUMMARY_H

#include <jansson.h>
#include "commands/accuracy.h"
#include "commands/coarse_first.h"
#include "commands/error_summary.h"
#include "commands/power_promise.h"
#include "options/options.h"
#include "scene/open_scene.h"
#include "util/solved.h"

struct summary {
    const struct options *options;
    const struct open_scene *scene;
    const struct solved *solved;
    RadOracle oracle;
    const struct coarse_first *coarse; /* NULL: --accuracy chose */
    const struct measured *measured;
    const struct power_promise *promise;
    const struct accuracy *accuracy; /* NULL: none was asked for */
    double output_seconds;
    const struct RadRank *ranks; /* [rank_count]; of one process, which are not told of, 1 */
    int rank_count;
};

void summary_print(const struct summary *summary);

/* The caller owns it; NULL when out of memory. */
json_t *summary_json(const struct summary *summary);

#endif
