/* image.c - see image.h.
 *
 * Colours are averaged after the exposure's curve: a lamp's edge is smooth although the lamp is a
 * hundred times brighter than white.
 * SPDX-License-Identifier: MIT */
#include "output/image.h"

#include <stdlib.h>

#include "output/picture.h"
#include "output/png_file.h"

static uint32_t light(const void *context, uint32_t face, const double point[3], double colour[3])
{
    const struct picture *p = context;
    double radiosity[3];
    uint32_t leaf = vertex_values_at(p->values, p->solution, face, point, radiosity);
    exposure_apply(&p->exposure, radiosity, p->solution->tree.bands, colour);
    return leaf;
}

int image_write(const char *path, const struct solution *solution,
                const struct vertex_values *values, const struct view *view, int width, int height,
                int mesh)
{
    struct picture p;
    if (picture_open(&p, path, solution, values, view, width, height, mesh) < 0)
        return -1;
    uint8_t *rgb = picture_draw(&p, light, &p);
    int result = rgb ? png_file_write(path, width, height, rgb) : -1;
    free(rgb);
    return result;
}
