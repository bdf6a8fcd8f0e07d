/* ambient.h - light where nothing says how it goes: the same irradiance everywhere.
 * SPDX-License-Identifier: MIT */
#ifndef AMBIENT_H
#define AMBIENT_H

#include "engine/solve.h"

/* Fill the solution's radiosities and irradiances. */
void ambient_light(struct solve *s);

/* state->radiosity of all elements from state->irradiance; of what is covered wholly it is that of
 * the links. */
void light_follows(const struct solve *s, struct state *state);
/* Of clusters alone, once faces have theirs. */
void light_of_clusters_follows(const struct solve *s, struct state *state);

#endif
