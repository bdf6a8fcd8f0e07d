/* bitmap_text.h - numbers and the few words of a scale, written into a picture.
 *
 * The characters are drawn as dots, seven rows high and as wide as each needs, and enlarged by
 * whole steps: no font file is needed, and every machine writes the same pixels. There are those
 * that a scale needs and no others.
 * SPDX-License-Identifier: MIT */
#ifndef BITMAP_TEXT_H
#define BITMAP_TEXT_H

#include <stdint.h>

/* Pixels, sRGB, from the top left, [height * width * 3]. */
struct bitmap {
    uint8_t *rgb;
    int width, height;
};

/* In dots: of digits above the line, and of tails below it. */
enum { TEXT_ASCENT = 7, TEXT_DESCENT = 2 };

/* How wide the text is, in dots. */
int bitmap_text_width(const char *text);

/* Write it in a colour, the top left corner of the first digit at (x, y), a dot `zoom` pixels wide.
 * What lies outside the picture is left out; a character that is not known is a gap. */
void bitmap_text(const struct bitmap *b, int x, int y, int zoom, const uint8_t colour[3],
                 const char *text);

/* One colour from (left, top) to (right, bottom), both left out; as far as it is inside. */
void bitmap_fill(const struct bitmap *b, int left, int top, int right, int bottom,
                 const uint8_t colour[3]);

#endif
