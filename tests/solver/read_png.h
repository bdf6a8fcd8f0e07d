/* read_png.h - a picture that was written, pixel by pixel.
 * SPDX-License-Identifier: MIT */
#ifndef READ_PNG_H
#define READ_PNG_H

#include <check.h>
#include <png.h>
#include <stdlib.h>

struct pixels {
    int width, height;
    unsigned char *rgb; /* the caller's to free */
};

static inline struct pixels load(const char *path)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    ck_assert_int_ne(png_image_begin_read_from_file(&image, path), 0);
    image.format = PNG_FORMAT_RGB;
    struct pixels p = {(int)image.width, (int)image.height, malloc(PNG_IMAGE_SIZE(image))};
    ck_assert_int_ne(png_image_finish_read(&image, NULL, p.rgb, 0, NULL), 0);
    return p;
}

static inline const unsigned char *at(const struct pixels *p, int x, int y)
{
    return &p->rgb[3 * (y * p->width + x)];
}

#endif
