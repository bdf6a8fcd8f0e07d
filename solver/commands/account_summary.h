/* account_summary.h - the account of error by cause: a table for people, an object for programs.
 * SPDX-License-Identifier: MIT */
#ifndef ACCOUNT_SUMMARY_H
#define ACCOUNT_SUMMARY_H

#include <jansson.h>
#include "radiosity.h"

void account_print(const struct RadAccountReport *report);

/* The caller owns it; NULL when out of memory. Bounds that there are none of are null. */
json_t *account_json(const struct RadAccountReport *report);

#endif
