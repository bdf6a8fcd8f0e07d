/* png_file.c - see png_file.h.
 * SPDX-License-Identifier: MIT */
#include "output/png_file.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>

#include "util/atomic_file.h"
#include "util/report.h"

static void write_png(png_structp png, png_bytep data, size_t size)
{
    if (fwrite(data, 1, size, png_get_io_ptr(png)) != size)
        png_error(png, "write");
}

static void flush_png(png_structp png)
{
    (void)png; /* atomic_commit flushes */
}

static void fail_png(png_structp png, png_const_charp message)
{
    (void)message;
    png_longjmp(png, 1);
}

static void no_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

/* Kept apart from its caller, so that the jump finds no variable of ours in a register. */
static int encode(FILE *stream, png_structp png, png_infop info, int width, int height,
                  const uint8_t *rgb)
{
    if (setjmp(png_jmpbuf(png)))
        return -1;
    png_set_write_fn(png, stream, write_png, flush_png);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (int y = 0; y < height; y++)
        png_write_row(png, &rgb[(size_t)y * (size_t)width * 3]);
    png_write_end(png, info);
    return 0;
}

int png_file_write(const char *path, int width, int height, const uint8_t *rgb)
{
    struct atomic_file file;
    if (atomic_open(&file, path))
        return -1;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, fail_png, no_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    int failed = !info || encode(file.stream, png, info, width, height, rgb);
    png_destroy_write_struct(&png, &info);
    if (failed && !ferror(file.stream)) {
        atomic_discard(&file);
        return report_error(path, 0, "cannot encode the picture; is there memory enough?");
    }
    return atomic_commit(&file);
}
