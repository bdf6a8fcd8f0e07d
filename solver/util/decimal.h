/* decimal.h - numbers as people write them: strtod's, but for those in base 16, which .dag files
 * and whole numbers of the command line do not know either. "0x10" may be a slip, or a name.
 * SPDX-License-Identifier: MIT */
#ifndef DECIMAL_H
#define DECIMAL_H

#include <ctype.h>
#include <stdlib.h>

/* As strtod: *end is text where there is no number. */
static inline double decimal(const char *text, char **end)
{
    const char *at = text;
    while (isspace((unsigned char)*at))
        at++;
    at += *at == '+' || *at == '-';
    if (*at == '0' && (at[1] == 'x' || at[1] == 'X')) {
        *end = (char *)text;
        return 0;
    }
    return strtod(text, end);
}

#endif
