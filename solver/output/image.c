/* image.c - see image.h.
 *
 * Colours are averaged after the exposure's curve: a lamp's edge is smooth although the lamp is a
 * hundred times brighter than white.
 * SPDX-License-Identifier: MIT */
#include "output/image.h"

#include <stdlib.h>

#include "output/picture.h"
#include "output/png_file.h"

static void light(const void *context, const struct picture_sample *at, double colour[3])
{
    const struct picture *p = context;
    exposure_apply(&p->exposure, at->radiosity, p->solution->tree.bands, colour);
}

/* At the corners of what is seen. Returns 0, or -1 after a message. */
static int gather_corners(const struct picture *p, struct vertex_values *values,
                          struct gathering *gathering)
{
    uint8_t *seen = calloc(p->solution->tree.count + (size_t)1, sizeof *seen);
    if (!seen)
        return picture_no_memory(p->path);
    int result = picture_seen(p, seen) < 0 ? -1
                                           : gathering_corners(gathering, values, p->solution, seen,
                                                               (double)p->width * p->height);
    free(seen);
    return result;
}

int image_write(const char *path, const struct solution *solution, struct vertex_values *values,
                const struct view *view, int width, int height, int mesh,
                struct gathering *gathering)
{
    struct picture p;
    if (picture_open(&p, path, solution, values, view, width, height, mesh) < 0)
        return -1;
    if (gathering && gathering->rays > 0)
        p.gathering = gathering;
    else if (gathering && gather_corners(&p, values, gathering) < 0)
        return -1;
    uint8_t *rgb = picture_draw(&p, light, &p);
    int result = rgb ? png_file_write(path, width, height, rgb) : -1;
    free(rgb);
    return result;
}
