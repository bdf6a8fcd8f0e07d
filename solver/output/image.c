/* image.c - see image.h.
 *
 * Nine samples per pixel. Each asks the raster for its face, meets the face's plane, and goes down
 * to the leaf for its value; so the cost is that of the samples, whatever the number of leaves.
 * Colours are averaged after the exposure's curve: a lamp's edge is smooth although the lamp is a
 * hundred times brighter than white.
 * SPDX-License-Identifier: MIT */
#include "output/image.h"

#include <errno.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "util/atomic_file.h"
#include "output/exposure.h"
#include "geometry.h"
#include "output/raster.h"
#include "util/report.h"

enum { SIDE = 3, METER = 4, BAND = 4 }; /* samples per pixel side, pixels per meter sample, pixel rows per task */

struct picture {
    const struct solution *solution;
    const struct vertex_values *values;
    struct raster raster;
    struct exposure exposure;
    int mesh;
};

/* Half the width of a mesh line on either side of an edge, in samples. */
static const double LINE = 0.5 * SIDE;

/* Dark, yet told from a black face. */
static const double BACKGROUND = 0.015;

static int emits(const struct solution *s, uint32_t face)
{
    const double *e = s->scene->materials[s->scene->faces[face].material].exitance;
    return e[0] > 0 || e[1] > 0 || e[2] > 0;
}

/* Where the ray of sample (x, y) meets a face's plane. */
static void meet(const struct raster *r, const struct element *e, double x, double y, double direction[3], double point[3])
{
    double to[3];
    raster_direction(r, x, y, direction);
    sub3(to, e->vertex[0], r->eye);
    double t = dot3(e->normal, to) / dot3(e->normal, direction);
    for (int k = 0; k < 3; k++)
        point[k] = r->eye[k] + t * direction[k];
}

/* How much a mesh line covers the sample: its distance in the picture from the leaf's edges. The
 * plane through the eye and an edge is linear in the picture, so no edge needs to be clipped. */
static double line_cover(const struct raster *r, const struct element *leaf, const double direction[3])
{
    double nearest = INFINITY, widest = 0;
    for (int i = 0; i < leaf->vertices; i++) {
        double a[3], b[3], n[3];
        sub3(a, leaf->vertex[i], r->eye);
        sub3(b, leaf->vertex[(i + 1) % leaf->vertices], r->eye);
        cross3(n, a, b);
        double slope = hypot(dot3(n, r->step_x), dot3(n, r->step_y));
        double distance = fabs(dot3(n, direction)) / slope;
        nearest = fmin(nearest, distance);
        widest = fmax(widest, distance);
    }
    /* Leaves of a few pixels: fade, or the lines would hide what they divide. */
    double fade = fmin(widest / (3.0 * SIDE), 1), cover = fmin(fmax(LINE - nearest + 0.5, 0), 1);
    return cover * fade;
}

static void shade(const struct picture *p, uint32_t face, double x, double y, double colour[3])
{
    const struct hierarchy *h = p->solution->hierarchy;
    double direction[3], point[3], radiosity[3];
    colour[0] = colour[1] = colour[2] = BACKGROUND;
    if (face == NO_FACE)
        return;
    meet(&p->raster, &h->elements[h->face_element[face]], x, y, direction, point);
    uint32_t leaf = vertex_values_at(p->values, h, face, point, radiosity);
    exposure_apply(&p->exposure, radiosity, p->solution->bands, colour);
    if (p->mesh) {
        double cover = 0.6 * line_cover(&p->raster, &h->elements[leaf], direction);
        /* Dark on bright, bright on dark. */
        double ink = luminance(colour, 3) > 0.08 ? 0.0 : 0.3;
        for (int k = 0; k < 3; k++)
            colour[k] += cover * (ink - colour[k]);
    }
}

/* Rows [from, to) of pixels into rgb. */
static int draw_rows(const struct picture *p, int width, int from, int to, png_byte *rgb)
{
    size_t samples = (size_t)((to - from) * SIDE) * (size_t)p->raster.width;
    uint32_t *face = malloc(samples * sizeof *face);
    double *nearness = malloc(samples * sizeof *nearness);
    if (face && nearness) {
        raster_rows(&p->raster, from * SIDE, to * SIDE, face, nearness);
        for (int y = from; y < to; y++)
            for (int x = 0; x < width; x++) {
                double sum[3] = {0, 0, 0}, colour[3];
                for (int j = 0; j < SIDE * SIDE; j++) {
                    int sx = x * SIDE + j % SIDE, sy = y * SIDE + j / SIDE;
                    shade(p, face[(size_t)(sy - from * SIDE) * (size_t)p->raster.width + (size_t)sx], sx, sy, colour);
                    for (int k = 0; k < 3; k++)
                        sum[k] += colour[k] / (SIDE * SIDE);
                }
                for (int k = 0; k < 3; k++)
                    rgb[((size_t)y * (size_t)width + (size_t)x) * 3 + (size_t)k] = srgb_byte(sum[k]);
            }
    }
    int failed = !face || !nearness;
    free(face);
    free(nearness);
    return failed ? -1 : 0;
}

/* Read the meter through a coarse picture: what is lit by the scene, or the lamps if that is all. */
static int measure(struct picture *p, const struct view *view, int width, int height)
{
    int w = (width + METER - 1) / METER, h = (height + METER - 1) / METER;
    size_t samples = (size_t)w * (size_t)h, count = 0;
    struct meter_sample *meter = malloc(samples * sizeof *meter);
    uint32_t *face = malloc(samples * sizeof *face);
    double *nearness = malloc(samples * sizeof *nearness);
    int failed = !meter || !face || !nearness || raster_begin(&p->raster, p->solution->scene, view, w, h, 0);
    if (!failed)
        raster_rows(&p->raster, 0, h, face, nearness);
    for (int lamps = 0; lamps < 2 && !failed && !count; lamps++)
        for (size_t i = 0; i < samples; i++) {
            double direction[3], point[3], radiosity[3];
            if (face[i] == NO_FACE || emits(p->solution, face[i]) != lamps)
                continue;
            const struct hierarchy *tree = p->solution->hierarchy;
            meet(&p->raster, &tree->elements[tree->face_element[face[i]]], (double)(i % (size_t)w), (double)(i / (size_t)w), direction, point);
            vertex_values_at(p->values, tree, face[i], point, radiosity);
            double l = luminance(radiosity, p->solution->bands);
            if (l > 0)
                meter[count++] = (struct meter_sample){l, 1};
        }
    if (!failed)
        p->exposure = exposure_measure(meter, count);
    raster_end(&p->raster);
    free(meter);
    free(face);
    free(nearness);
    return failed ? -1 : 0;
}

static int draw(struct picture *p, const struct view *view, int width, int height, png_byte *rgb)
{
    int failed = 0;
    if (measure(p, view, width, height) || raster_begin(&p->raster, p->solution->scene, view, width * SIDE, height * SIDE, 0))
        return -1;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic) reduction(| : failed)
#endif
    for (int from = 0; from < height; from += BAND)
        failed |= draw_rows(p, width, from, from + BAND < height ? from + BAND : height, rgb) != 0;
    raster_end(&p->raster);
    return failed ? -1 : 0;
}

static void write_png(png_structp png, png_bytep data, size_t size)
{
    if (fwrite(data, 1, size, png_get_io_ptr(png)) != size)
        png_error(png, "write");
}

static void flush_png(png_structp png)
{
    (void)png; /* atomic_commit flushes */
}

static void silent(png_structp png, png_const_charp message)
{
    (void)message;
    png_longjmp(png, 1);
}

static void no_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

/* Kept apart from its caller, so that the jump finds no variable of ours in a register. */
static int encode(FILE *stream, png_structp png, png_infop info, int width, int height, const png_byte *rgb)
{
    if (setjmp(png_jmpbuf(png)))
        return -1;
    png_set_write_fn(png, stream, write_png, flush_png);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (int y = 0; y < height; y++)
        png_write_row(png, &rgb[(size_t)y * (size_t)width * 3]);
    png_write_end(png, info);
    return 0;
}

static int write_picture(const char *path, int width, int height, const png_byte *rgb)
{
    struct atomic_file file;
    if (atomic_open(&file, path))
        return -1;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, silent, no_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    int failed = !info || encode(file.stream, png, info, width, height, rgb);
    png_destroy_write_struct(&png, &info);
    if (failed && !ferror(file.stream)) {
        atomic_discard(&file);
        return report_error(path, 0, "cannot encode the picture; is there memory enough?");
    }
    return atomic_commit(&file);
}

int image_write(const char *path, const struct solution *solution, const struct vertex_values *values,
                const struct view *view, int width, int height, int mesh)
{
    struct picture p = {.solution = solution, .values = values, .mesh = mesh};
    struct view guessed;
    if (width < 1 || height < 1 || width > 16384 || height > 16384)
        return report_error(path, 0, "a picture of %d x %d; give 1 to 16384 pixels each way", width, height);
    png_byte *rgb = malloc((size_t)width * (size_t)height * 3);
    int result = -1;
    if (!rgb || (!view && view_guess(solution->scene, &guessed)) || draw(&p, view ? view : &guessed, width, height, rgb))
        report_error(path, 0, "out of memory for the picture; ask for a smaller one");
    else
        result = write_picture(path, width, height, rgb);
    free(rgb);
    return result;
}
