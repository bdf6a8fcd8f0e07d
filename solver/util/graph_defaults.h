/* graph_defaults.h - other defaults for the parameters of an oracle, in the text of its graph.
 * SPDX-License-Identifier: MIT */
#ifndef GRAPH_DEFAULTS_H
#define GRAPH_DEFAULTS_H

struct graph_default {
    const char *name;
    double value; /* finite, above 0 */
};

enum { GRAPH_NUMBER = 32 }; /* room for a number as it is written here */

/* A value as it is written, in six digits at the most and as dagc reads numbers. */
void graph_number(double value, char text[GRAPH_NUMBER]);

/* `text` with other numbers behind `param NAME : TYPE =`, and all else byte for byte. Returns it,
 * for free(); NULL, and *missing the name that has no such line, or NULL when out of memory. */
char *graph_with_defaults(const char *text, const struct graph_default *defaults, int count,
                          const char **missing);

#endif
