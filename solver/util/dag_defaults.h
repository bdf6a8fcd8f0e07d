/* dag_defaults.h - other defaults for the parameters of an oracle, in the text of its graph.
 * SPDX-License-Identifier: MIT */
#ifndef DAG_DEFAULTS_H
#define DAG_DEFAULTS_H

struct dag_default {
    const char *name;
    double value; /* finite, above 0 */
};

enum { DAG_NUMBER = 32 }; /* room for a number as it is written here */

/* A value as it is written, in six digits at the most and as `dagc` reads numbers. */
void dag_number(double value, char text[DAG_NUMBER]);

/* `text` with other numbers behind `param NAME : TYPE =`, and all else byte for byte. Returns it,
 * for free(); NULL, and *missing the name that has no such line, or NULL when out of memory. */
char *dag_with_defaults(const char *text, const struct dag_default *defaults, int count,
                        const char **missing);

#endif
