/* ranks_report.h - what each of several processes had and has sent, for people and programs.
 * SPDX-License-Identifier: MIT */
#ifndef RANKS_REPORT_H
#define RANKS_REPORT_H

#include <jansson.h>

#include "radiosity.h"

/* A list of all, null where there is one. */
json_t *ranks_json(const struct RadRank *ranks, int count);

/* A line, where there are several. */
void ranks_print(const struct RadRank *ranks, int count);

#endif
