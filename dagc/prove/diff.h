/* diff.h - which answers make two oracles decide differently?
 * SPDX-License-Identifier: MIT */
#ifndef DIFF_H
#define DIFF_H

#include "dag.h"

/* Compares the oracles of two files, loaded with the options (whose switches do not count), and
 * prints, for each pair of ways to decide that differ, the questions and answers that lead there.
 * Returns as diff(1) does: 0 the same, 1 different, 2 trouble: a file with errors, tools of their
 * own that differ, or more states than it can look at. */
int dag_diff(const char *a, const char *b, const struct dag_options *options, FILE *out);

/* Of two graphs of one dag, and nothing is printed: 0 the same, 1 different, 2 more states than it
 * can look at. Inside dag_protect. */
int dag_diff_graphs(struct dag *dag, const struct oracle_graph *a, const struct oracle_graph *b);

#endif
