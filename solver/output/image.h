/* image.h - a picture of a solution, as PNG.
 * SPDX-License-Identifier: MIT */
#ifndef IMAGE_H
#define IMAGE_H

#include "output/gathering.h"
#include "output/vertex_values.h"
#include "output/view.h"

/* Draw the solution seen through `view` (NULL: one is guessed), with interpolated radiosity and
 * automatic exposure; `mesh`: the edges of the leaves over it. Backs of one-sided faces are cut
 * away, so that one can look into a closed room from outside. The file appears whole or not at
 * all. `gathering`: light is gathered at pixels, or at corners into `values`; NULL: interpolated
 * between values as they are. Returns 0, or -1 after one line on stderr. */
int image_write(const char *path, const struct solution *solution, struct vertex_values *values,
                const struct view *view, int width, int height, int mesh,
                struct gathering *gathering);

#endif
