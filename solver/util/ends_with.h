/* ends_with.h - does a text end so? Of file names and of materials.
 * SPDX-License-Identifier: MIT */
#ifndef ENDS_WITH_H
#define ENDS_WITH_H

#include <string.h>
#include <strings.h>

static inline int ends_with(const char *text, const char *end)
{
    size_t n = strlen(text), m = strlen(end);
    return n >= m && strcmp(text + n - m, end) == 0;
}

static inline int ends_with_any_case(const char *text, const char *end)
{
    size_t n = strlen(text), m = strlen(end);
    return n >= m && strcasecmp(text + n - m, end) == 0;
}

#endif
