/* southwell.h - progressive shooting: what has changed most is sent on first.
 * SPDX-License-Identifier: MIT */
#ifndef SOUTHWELL_H
#define SOUTHWELL_H

#include "engine/transport.h"

struct southwell;

/* For this operator and x's bands. Returns NULL when out of memory. */
struct southwell *southwell_new(const struct light_operator *op, const struct transport *x);

/* Before a Jacobi sweep: what x is now, so that what the sweep changes is known as unshot. */
void southwell_keep(struct southwell *s, const struct light_operator *op,
                    const struct transport *x);

/* After it: shoot, face by face, until what is unshot is so much less as it is to be: `left` says
 * how many times too much it is. Adds to x->sweeps, up to `most`. Returns 0, or -1 when x->watch
 * stops it. */
int southwell_shoot(struct southwell *s, const struct light_operator *op, struct transport *x,
                    double left, int most);

/* After the last sweep of a solve that is cut short: add the ambient estimate of what the unshot
 * light will yet become. */
void southwell_ambient(const struct southwell *s, const struct light_operator *op,
                       struct transport *x);

/* Mean reflectance of all that is uncovered, the band where it is largest: what the ambient
 * estimate takes of light at each reflection. */
double southwell_reflects(const struct light_operator *op, const struct transport *x);

void southwell_free(struct southwell *s);

#endif
