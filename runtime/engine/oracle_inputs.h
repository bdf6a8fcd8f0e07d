/* publish.h - what the oracles see of a solution: radiosity and spread of every element.
 * SPDX-License-Identifier: MIT */
#ifndef PUBLISH_H
#define PUBLISH_H

#include "engine/solve.h"

/* What an oracle sees lags this far behind the truth, so that passes end. */
#define STALE 0.02

/* Area means of the clusters, and radiosity and spread of every element. changed[e] becomes 1 where an oracle sees
 * one of them grow, else 0. */
void publish(struct solve *s);

/* Before the first solve the oracles see what the light is likely to be: E + rho H with the mean irradiance. */
void publish_guess(struct solve *s);

#endif
