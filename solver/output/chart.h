/* chart.h - drawings by gnuplot.
 * SPDX-License-Identifier: MIT */
#ifndef CHART_H
#define CHART_H

#include <stdio.h>

/* Draw `path`, .svg or .png: print() writes gnuplot commands after `set terminal`. The picture
 * appears whole or not at all. Returns 0, or -1 after a message. */
int chart_draw(const char *path, void (*print)(FILE *script, const void *context),
               const void *context);

#endif
