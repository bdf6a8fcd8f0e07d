/* error_image.c - see error_image.h.
 *
 * Blue and red of one lightness on both sides of a light grey can be told apart by eyes that see
 * few hues, too; what is beyond the scale is told by its lightness. [ColorBrewer's RdBu, Harrower
 * and Brewer 2003]
 * SPDX-License-Identifier: MIT */
#include "output/error_image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/bitmap_text.h"
#include "output/picture.h"
#include "output/png_file.h"
#include "util/report.h"

/* sRGB: from right to the end of the scale, and beyond it, even steps of the root of the share: few
 * places are off by as much as the scale shows, and those off by a quarter of it want to be seen.
 */
enum { STEPS = 4 };
static const uint8_t too_dark[STEPS + 2][3] = {{247, 247, 247}, {209, 229, 240}, {146, 197, 222},
                                               {67, 147, 195},  {33, 102, 172},  {5, 40, 87}};
static const uint8_t too_bright[STEPS + 2][3] = {{247, 247, 247}, {253, 219, 199}, {244, 165, 130},
                                                 {214, 96, 77},   {178, 24, 43},   {94, 0, 28}};

/* How much of its luminance an unlit place keeps: more than what lies beyond the scale (.024) has
 * of the end's (.127), so that no shadow is taken for it. */
static const double SHADE = 0.45;

/* ---- shares */

static double area_of(const struct solution *s, uint32_t element)
{
    const struct element *e = &s->tree.elements[element];
    if (!is_leaf(e) || is_lamp(&s->surfaces, e->face))
        return 0;
    return e->area * (s->tree.uncovered ? s->tree.uncovered[element] : 1);
}

/* Luminance, W/m2, of what an element truly reflects; lamps have none. */
static double truth_of(const struct solution *s, const double *error, uint32_t element)
{
    uint32_t bands = s->tree.bands;
    return luminance(radiosity_of(s, element), bands)
           - luminance(&error[(size_t)element * bands], bands);
}

double error_image_mean(const struct solution *s, const double *error)
{
    double sum = 0, area = 0;
    for (uint32_t i = 0; i < s->tree.count; i++) {
        double a = area_of(s, i);
        sum += a > 0 ? a * truth_of(s, error, i) : 0;
        area += a;
    }
    return area > 0 ? fmax(sum / area, 0) : 0;
}

double error_image_share(const struct solution *s, const double *error, double mean,
                         uint32_t element)
{
    uint32_t bands = s->tree.bands;
    double off = luminance(&error[(size_t)element * bands], bands);
    double of = fmax(truth_of(s, error, element), ERROR_IMAGE_DARK * mean);
    if (off == 0 || is_lamp(&s->surfaces, s->tree.elements[element].face))
        return 0;
    return of > 0 ? off / of : copysign(INFINITY, off);
}

int error_image_unknown(const struct solution *s, const struct error_seen *seen, uint32_t element)
{
    uint32_t bands = s->tree.bands;
    double limit = luminance(&seen->limit[(size_t)element * bands], bands);
    if (is_lamp(&s->surfaces, s->tree.elements[element].face))
        return 0;
    for (uint32_t k = 0; k < bands; k++)
        if (seen->error[(size_t)element * bands + k] != 0)
            return 0;
    return limit > ERROR_IMAGE_KNOWN * fmax(truth_of(s, seen->error, element), 0);
}

struct part {
    double share, area;
};

/* The largest share first. */
static int by_share(const void *a, const void *b)
{
    double x = ((const struct part *)a)->share, y = ((const struct part *)b)->share;
    return (x < y) - (x > y);
}

/* 1, 2 or 4 times a power of ten, at or above `share` but for rounding. */
static double round_up(double share)
{
    static const double steps[] = {0.01, 0.02, 0.04, 0.1, 0.2, 0.4, 1, 2, 4, 10};
    size_t i = 0;
    while (i + 1 < sizeof steps / sizeof *steps && share > steps[i] * (1 + 1e-9))
        i++;
    return steps[i];
}

double error_image_scale(const struct solution *s, const double *error)
{
    double mean = error_image_mean(s, error), all = 0, above = 0;
    struct part *parts = malloc((s->tree.count + (size_t)1) * sizeof *parts);
    size_t count = 0, i = 0;
    if (!parts)
        return -1;
    for (uint32_t e = 0; e < s->tree.count; e++)
        if (area_of(s, e) > 0) {
            all += area_of(s, e);
            parts[count++] =
                (struct part){fabs(error_image_share(s, error, mean, e)), area_of(s, e)};
        }
    qsort(parts, count, sizeof *parts, by_share);
    while (i < count && (above += parts[i].area) <= 0.01 * all)
        i++;
    double scale = round_up(i < count ? parts[i].share : 0);
    free(parts);
    return scale;
}

/* ---- colours */

/* sRGB of a share, in units of the scale. */
static void hue_of(double share, double rgb[3])
{
    const uint8_t(*ramp)[3] = share < 0 ? too_dark : too_bright;
    double at = sqrt(fmin(fabs(share), 1)) * STEPS;
    int step = fabs(share) > 1 ? STEPS + 1 : at < STEPS ? (int)at : STEPS - 1;
    double t = step > STEPS ? 0 : at - step;
    for (int k = 0; k < 3; k++)
        rgb[k] = (ramp[step][k] + t * (ramp[step > STEPS ? step : step + 1][k] - ramp[step][k]));
}

/* The other way round from srgb_byte. [IEC 61966-2-1] */
static double linear(double byte)
{
    double s = byte / 255;
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

/* In dots: of a hatch's lines, across and down. */
enum { HATCH = 6, HATCH_LINE = 2 };
static const uint8_t hatch_line[3] = {160, 160, 160};

static int is_hatched(double x, double y)
{
    double at = fmod(x + y, HATCH);
    return at < HATCH_LINE;
}

struct error_colours {
    const struct picture *picture;
    const struct error_seen *seen;
    double mean, scale;
    int zoom; /* pixels of a dot */
};

static void error_colour(const void *context, const struct picture_sample *at, double colour[3])
{
    const struct error_colours *c = context;
    const struct picture *p = c->picture;
    double lit[3], rgb[3];
    exposure_apply(&p->exposure, at->radiosity, p->solution->tree.bands, lit);
    double share = error_image_share(p->solution, c->seen->error, c->mean, at->leaf) / c->scale;
    /* The root is about the lightness that an eye sees. */
    double shade = SHADE + (1 - SHADE) * sqrt(luminance(lit, 3));
    hue_of(fabs(share) < 1 + 1e-9 ? fmin(fmax(share, -1), 1) : share, rgb);
    if (error_image_unknown(p->solution, c->seen, at->leaf)
        && is_hatched(at->x / c->zoom, at->y / c->zoom))
        for (int k = 0; k < 3; k++)
            rgb[k] = hatch_line[k];
    for (int k = 0; k < 3; k++)
        colour[k] = shade * linear(rgb[k]);
}

/* ---- the scale */

static void colour_column(const struct bitmap *b, int x, int top, int bottom, double share)
{
    double rgb[3];
    hue_of(share, rgb);
    bitmap_fill(
        b, x, top, x + 1, bottom,
        (const uint8_t[3]){(uint8_t)lrint(rgb[0]), (uint8_t)lrint(rgb[1]), (uint8_t)lrint(rgb[2])});
}

/* Beyond the ends the bar runs out in tips of the colour that stands for more. */
static void draw_bar(const struct bitmap *b, int left, int right, int top, int thick)
{
    int first = left + thick, last = right - thick - 1;
    for (int x = left; x < right; x++) {
        int tip = x < first ? first - x : x > last ? x - last : 0;
        int inset = tip * thick / (2 * (thick + 1));
        double root = 2 * (double)(x - first) / (last - first) - 1;
        colour_column(b, x, top + inset, top + thick - inset, root * fabs(root));
    }
}

/* In dots: the bar's height, and what is left free around bar and text. */
enum { THICK = 6, GAP = 2 };
static const uint8_t white[3] = {255, 255, 255}, black[3] = {20, 20, 20};

/* The longest that fits of "-20% too dark", "-20% dark" and "-20%", so with "too bright". Returns
 * 0 when none does. */
static int scale_words(double scale, int room, char low[32], char high[32])
{
    static const char *const words[][2] = {
        {" too dark", "too bright "}, {" dark", "bright "}, {"", ""}};
    for (int i = 0; i < 3; i++) {
        snprintf(low, 32, "-%g%%%s", 100 * scale, words[i][0]);
        snprintf(high, 32, "%s+%g%%", words[i][1], 100 * scale);
        if (2 * bitmap_text_width(high) + bitmap_text_width("0") + 4 * GAP <= room)
            return 1;
    }
    return 0;
}

static void draw_centred(const struct bitmap *b, int x, int y, int zoom, const char *text)
{
    bitmap_text(b, x - bitmap_text_width(text) * zoom / 2, y, zoom, white, text);
}

static int zoom_of(int width, int height)
{
    int across = width / 400, down = height / 300, zoom = across < down ? across : down;
    return zoom > 1 ? zoom : 1;
}

/* A piece of grey as in the picture, as wide as it is high. */
static void draw_grey(const struct bitmap *b, int left, int top, int zoom, int hatched)
{
    for (int y = 0; y < TEXT_ASCENT; y++)
        for (int x = 0; x < 2 * TEXT_ASCENT; x++)
            bitmap_fill(b, left + x * zoom, top + y * zoom, left + (x + 1) * zoom,
                        top + (y + 1) * zoom,
                        hatched && is_hatched(x, y) ? hatch_line : too_dark[0]);
}

/* What both greys mean, in a row of its own that ends at `bottom`; as many as find room, the
 * hatched one first. */
static void draw_greys(const struct bitmap *b, int bottom, int zoom)
{
    char known[32], unknown[32];
    snprintf(known, sizeof known, "right within %g%%", 100 * ERROR_IMAGE_KNOWN);
    snprintf(unknown, sizeof unknown, "not known to %g%%", 100 * ERROR_IMAGE_KNOWN);
    const int grey = 2 * TEXT_ASCENT + 2 * GAP, tall = GAP + TEXT_ASCENT + TEXT_DESCENT;
    const int first = grey + bitmap_text_width(unknown), second = grey + bitmap_text_width(known);
    int room = b->width / zoom - 2 * GAP, top = bottom - tall * zoom, left = GAP * zoom;
    int right = b->width - (GAP + second) * zoom;
    if (first > room || 4 * (b->height - top) > 3 * b->height)
        return;
    bitmap_fill(b, 0, top, b->width, bottom, black);
    draw_grey(b, left, top + GAP * zoom, zoom, 1);
    bitmap_text(b, left + grey * zoom, top + GAP * zoom, zoom, white, unknown);
    if (first + 4 * GAP + second > room)
        return;
    draw_grey(b, right, top + GAP * zoom, zoom, 0);
    bitmap_text(b, right + grey * zoom, top + GAP * zoom, zoom, white, known);
}

/* Bar and numbers over the lower edge, as large as the picture allows; what finds no room is left
 * out. */
static void draw_scale(const struct bitmap *b, double scale)
{
    char low[32], high[32], text[32];
    const int zoom = zoom_of(b->width, b->height);
    int room = b->width / zoom - 2 * GAP, tall = (4 * GAP + THICK + TEXT_ASCENT) * zoom;
    if (3 * tall > b->height || !scale_words(scale, room, low, high))
        return;
    int top = b->height - tall, line = top + (2 * GAP + THICK) * zoom, left = GAP * zoom;
    int right = b->width - left, middle = b->width / 2;
    int half = (right - left - 2 * THICK * zoom) / 4; /* where the root is 1/2: the share 1/4 */
    int low_width = bitmap_text_width(low) * zoom, high_width = bitmap_text_width(high) * zoom;
    bitmap_fill(b, 0, top, b->width, b->height, black);
    draw_greys(b, top, zoom);
    draw_bar(b, left, right, top + GAP * zoom, THICK * zoom);
    draw_centred(b, left + low_width / 2, line, zoom, low);
    draw_centred(b, middle, line, zoom, "0");
    draw_centred(b, right - (high_width + 1) / 2, line, zoom, high);
    snprintf(text, sizeof text, "+%g%%", 25 * scale);
    if (middle + half + (bitmap_text_width(text) / 2 + 2 * GAP) * zoom > right - high_width)
        return;
    draw_centred(b, middle + half, line, zoom, text);
    *text = '-';
    draw_centred(b, middle - half, line, zoom, text);
}

int error_image_write(const char *path, const struct solution *solution,
                      const struct vertex_values *values, const struct error_seen *seen,
                      const struct view *view, int width, int height, int mesh)
{
    struct picture p;
    if (!seen->error || !seen->limit)
        return report_error(path, 0,
                            "out of memory for the errors of elements; use a coarser solution");
    if (picture_open(&p, path, solution, values, view, width, height, mesh) < 0)
        return -1;
    const struct error_colours c = {&p, seen, error_image_mean(solution, seen->error),
                                    error_image_scale(solution, seen->error),
                                    zoom_of(width, height)};
    if (c.scale < 0)
        return picture_no_memory(path);
    uint8_t *rgb = picture_draw(&p, error_colour, &c);
    if (rgb)
        draw_scale(&(struct bitmap){rgb, width, height}, c.scale);
    int result = rgb ? png_file_write(path, width, height, rgb) : -1;
    free(rgb);
    return result;
}
