/* body_parts.h - closed shells of faces that are in no body yet, whatever groups these are in.
 * SPDX-License-Identifier: MIT */
#ifndef BODY_PARTS_H
#define BODY_PARTS_H

#include "hierarchy/body_lids.h"

/* While shells are looked for, one after the other. */
struct body_parts {
    const struct hierarchy *h;
    const uint32_t *whose; /* of struct bodies, borrowed */
    unsigned char *met;    /* [built]: of a shell that has been looked at */
    uint32_t *start;       /* [starts]: faces to begin with */
    uint32_t starts, next;
    uint32_t *face; /* of the shell at hand */
    size_t room[2];
    uint32_t side[BODY_FACES]; /* of the shell, the first face of each plane */
};

/* Begins with faces that others lie on: starts is 0 where there are none. Returns 0, or -1 when out
 * of memory; close is fine then too. */
int body_parts_open(struct body_parts *parts, const struct hierarchy *h, const uint32_t *whose);

/* The next shell that bends nowhere in, its faces, sides and free edges. Returns 1; 0 when there is
 * none; -1 when out of memory. */
int body_parts_next(struct body_parts *parts, struct shell *shell);

void body_parts_close(struct body_parts *parts);

#endif
