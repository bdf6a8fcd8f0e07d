/* contact.h - what parts a surface at a point: faces that stand on it, and its own border.
 * SPDX-License-Identifier: MIT */
#ifndef CONTACT_H
#define CONTACT_H

#include "output/solution.h"

enum { CONTACT_DIRECTIONS = 8, CONTACT_FACES = 64 };

struct contact {
    /* [faces]: of the surface, one plane and one material, with the point on their border or
     * inside */
    uint32_t face[CONTACT_FACES];
    /* [directions]: unit vectors in the surface, along which it is parted */
    double direction[CONTACT_DIRECTIONS][3];
    int faces, directions;
};

/* What parts the surface that face f is of at the point p. What is nearer than `touch` (m) touches.
 * Directions come in the order of their angles about the normal. Fewer than two part nothing: the
 * surface is connected round the end of a wall. */
void contact_at(struct contact *c, const struct solution *solution, uint32_t f, const double p[3],
                double touch);

/* Which of the parts between `count` such directions the direction v looks into: 0 to count - 1,
 * and 0 when they part nothing. */
int contact_sector(const double normal[3], int count, const double (*direction)[3],
                   const double v[3]);

#endif
