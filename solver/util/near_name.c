/* near_name.c - see near_name.h.
 * SPDX-License-Identifier: MIT */
#include "util/near_name.h"

#include <string.h>

enum { MOST = 63 }; /* bytes of a candidate */

/* Changes of one character that make `a` of `b`: insert, leave out, replace. [Levenshtein 1966] */
static size_t distance(const char *a, size_t size, const char *b, size_t length)
{
    size_t row[MOST + 1];
    for (size_t j = 0; j <= length; j++)
        row[j] = j;
    for (size_t i = 0; i < size; i++) {
        size_t before = row[0]++;
        for (size_t j = 0; j < length; j++) {
            size_t replaced = before + (a[i] != b[j]);
            before = row[j + 1];
            size_t shorter = (before < row[j] ? before : row[j]) + 1;
            row[j + 1] = replaced < shorter ? replaced : shorter;
        }
    }
    return row[length];
}

struct near_name near_name(const char *wanted, size_t length)
{
    return (struct near_name){wanted, length, NULL, length / 3 + 2};
}

void near_name_offer(struct near_name *n, const char *candidate)
{
    const size_t length = strlen(candidate),
                 changes = length <= MOST ? distance(n->wanted, n->length, candidate, length)
                                          : n->changes;
    if (changes >= n->changes)
        return;
    n->changes = changes;
    n->best = candidate;
}
