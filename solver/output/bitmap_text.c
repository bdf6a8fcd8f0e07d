/* bitmap_text.c - see bitmap_text.h.
 * SPDX-License-Identifier: MIT */
#include "output/bitmap_text.h"

#include <string.h>

/* A glyph's rows from the top, parted by blanks; '#' is a dot. Tails reach below the seventh. */
static const struct glyph {
    char character;
    const char *rows;
} glyphs[] = {
    {'0', ".###. #...# #..## #.#.# ##..# #...# .###."},
    {'1', ".#. ##. .#. .#. .#. .#. ###"},
    {'2', ".###. #...# ....# ...#. ..#.. .#... #####"},
    {'3', ".###. #...# ....# ..##. ....# #...# .###."},
    {'4', "...#. ..##. .#.#. #..#. ##### ...#. ...#."},
    {'5', "##### #.... ####. ....# ....# #...# .###."},
    {'6', "..##. .#... #.... ####. #...# #...# .###."},
    {'7', "##### ....# ...#. ..#.. ..#.. .#... .#..."},
    {'8', ".###. #...# #...# .###. #...# #...# .###."},
    {'9', ".###. #...# #...# .#### ....# ...#. .##.."},
    {'.', ". . . . . . #"},
    {'%', "##..# ##..# ...#. ..#.. .#... #..## #..##"},
    {'+', "..... ..#.. ..#.. ##### ..#.. ..#.. ....."},
    {'-', ".... .... .... #### .... .... ...."},
    {' ', ".. .. .. .. .. .. .."},
    {'a', ".... .... .##. ...# .### #..# .###"},
    {'b', "#... #... ###. #..# #..# #..# ###."},
    {'d', "...# ...# .### #..# #..# #..# .###"},
    {'g', ".... .... .### #..# #..# #..# .### ...# .##."},
    {'h', "#... #... ###. #..# #..# #..# #..#"},
    {'i', "# . # # # # #"},
    {'k', "#... #... #..# #.#. ##.. #.#. #..#"},
    {'n', ".... .... ###. #..# #..# #..# #..#"},
    {'o', ".... .... .##. #..# #..# #..# .##."},
    {'r', "... ... #.# ##. #.. #.. #.."},
    {'t', ".#. .#. ### .#. .#. .#. .##"},
    {'w', "..... ..... #...# #...# #.#.# #.#.# .#.#."},
};

static const struct glyph *glyph_of(char character)
{
    for (size_t i = 0; i < sizeof glyphs / sizeof *glyphs; i++)
        if (glyphs[i].character == character)
            return &glyphs[i];
    return glyph_of(' ');
}

static int width_of(const struct glyph *g)
{
    return (int)strcspn(g->rows, " ");
}

int bitmap_text_width(const char *text)
{
    int width = 0;
    for (const char *c = text; *c; c++)
        width += width_of(glyph_of(*c)) + (c[1] != 0);
    return width;
}

void bitmap_fill(const struct bitmap *b, int left, int top, int right, int bottom,
                 const uint8_t colour[3])
{
    for (int y = top > 0 ? top : 0; y < bottom && y < b->height; y++)
        for (int x = left > 0 ? left : 0; x < right && x < b->width; x++)
            memcpy(&b->rgb[((size_t)y * (size_t)b->width + (size_t)x) * 3], colour, 3);
}

void bitmap_text(const struct bitmap *b, int x, int y, int zoom, const uint8_t colour[3],
                 const char *text)
{
    for (const char *c = text; *c; c++) {
        const struct glyph *g = glyph_of(*c);
        int width = width_of(g), row = 0, column = 0;
        for (const char *dot = g->rows; *dot; dot++) {
            int left = x + column * zoom, top = y + row * zoom;
            if (*dot == '#')
                bitmap_fill(b, left, top, left + zoom, top + zoom, colour);
            row += *dot == ' ';
            column = *dot == ' ' ? 0 : column + 1;
        }
        x += (width + 1) * zoom;
    }
}
