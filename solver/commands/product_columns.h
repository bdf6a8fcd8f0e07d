/* product_columns.h - `radiosity viewfactors --product FILE`: y = F x of given columns, where F
 * would be too large to be written.
 *
 * The file has a line per face of the scene file, in its order: a number for each column, parted by
 * commas or blanks. A first line of names is repeated above the columns of y; # begins a comment.
 * SPDX-License-Identifier: MIT */
#ifndef PRODUCT_COLUMNS_H
#define PRODUCT_COLUMNS_H

#include "options/options.h"
#include "scene/open_scene.h"

struct columns {
    char *text, *head; /* head: in the text; NULL: there is none */
    double *x;         /* [rows][count] */
    size_t rows, capacity;
    uint32_t count;
};

/* Read columns for so many faces. Returns 0, or -1 after a message; free them in either case. */
int columns_read(struct columns *c, const char *path, uint32_t faces);
void columns_free(struct columns *c);

/* Write F times the columns to `path`. Returns 0, or -1 after a message. */
int columns_write_product(const struct columns *c, const char *path, RadExchange exchange,
                          const struct open_scene *scene);

#endif
