/* near_name.h - the name that somebody may have meant who wrote another.
 * SPDX-License-Identifier: MIT */
#ifndef NEAR_NAME_H
#define NEAR_NAME_H

#include <stddef.h>

struct near_name {
    const char *wanted;
    size_t length;    /* of it, in bytes */
    const char *best; /* of those offered; NULL: none is near enough to be a slip of the fingers */
    size_t changes;   /* that best takes, or is to take fewer */
};

struct near_name near_name(const char *wanted, size_t length);
/* The candidate is kept, not copied. */
void near_name_offer(struct near_name *n, const char *candidate);

#endif
