/* picture.c - see picture.h.
 *
 * Nine samples per pixel. Each asks the raster for its face, meets the face's plane, and asks for
 * the colour there; so the cost is that of the samples, whatever the number of leaves.
 * SPDX-License-Identifier: MIT */
#include "output/picture.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "geometry.h"
#include "output/raster.h"
#include "util/report.h"
#include "util/thread_pool.h"

/* samples per pixel side, pixels per meter sample, pixel rows per task */
enum { SIDE = 3, METER = 4, BAND = 4 };

/* A picture in work: what every sample reads, and where it ends. */
struct drawing {
    const struct picture *picture;
    struct raster raster;
    picture_colour colour;
    const void *context;
    uint8_t *rgb;
    atomic_int *failed, *seen; /* seen: does any sample see a face? */
};

/* Half the width of a mesh line on either side of an edge, in samples. */
static const double LINE = 0.5 * SIDE;

/* Dark, yet told from a black face. */
static const double BACKGROUND = 0.015;

/* How much a mesh line covers the sample: its distance in the picture from the leaf's edges. The
 * plane through the eye and an edge is linear in the picture, so no edge needs to be clipped. */
static double line_cover(const struct raster *r, const struct element *leaf,
                         const double direction[3])
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

/* The edge of a leaf over its colour: dark on bright, bright on dark. */
static void draw_line(double colour[3], double cover)
{
    double ink = luminance(colour, 3) > 0.08 ? 0.0 : 0.3;
    for (int k = 0; k < 3; k++)
        colour[k] += 0.6 * cover * (ink - colour[k]);
}

/* What the samples of some rows see. */
struct samples {
    uint32_t *face;
    double *nearness;
    double *light; /* [sample * bands + band], W/m2, where it is gathered; else NULL */
};

static int samples_open(struct samples *s, size_t count, uint32_t gathered)
{
    s->face = malloc((count + 1) * sizeof *s->face);
    s->nearness = malloc((count + 1) * sizeof *s->nearness);
    s->light = gathered ? malloc((count + 1) * gathered * sizeof *s->light) : NULL;
    return s->face && s->nearness && (s->light || !gathered) ? 0 : -1;
}

static void samples_close(struct samples *s)
{
    free(s->face);
    free(s->nearness);
    free(s->light);
}

/* The colour of sample (x, y), which sees that face, lit by `light` unless that is NULL. */
static void shade(const struct drawing *d, uint32_t face, double x, double y, const double *light,
                  double colour[3])
{
    const struct picture *p = d->picture;
    double direction[3], point[3], radiosity[3];
    colour[0] = colour[1] = colour[2] = BACKGROUND;
    if (face == NO_FACE)
        return;
    raster_point(&d->raster, p->solution, face, x, y, direction, point);
    uint32_t leaf = vertex_values_at(p->values, p->solution, face, point, radiosity);
    const struct picture_sample sample = {leaf, light ? light : radiosity, (x + 0.5) / SIDE,
                                          (y + 0.5) / SIDE};
    d->colour(d->context, &sample, colour);
    if (p->mesh)
        draw_line(colour, line_cover(&d->raster, &p->solution->tree.elements[leaf], direction));
}

/* The mean colour of pixel (x, y), whose samples stand in rows that begin with sample row `from`.
 */
static void shade_pixel(const struct drawing *d, const struct samples *s, int from, int x, int y,
                        uint8_t rgb[3])
{
    uint32_t bands = d->picture->solution->tree.bands;
    double sum[3] = {0, 0, 0}, colour[3];
    int seen = 0;
    for (int j = 0; j < SIDE * SIDE; j++) {
        int sx = x * SIDE + j % SIDE, sy = y * SIDE + j / SIDE;
        size_t at = (size_t)(sy - from) * (size_t)d->raster.width + (size_t)sx;
        shade(d, s->face[at], sx, sy, s->light ? &s->light[at * bands] : NULL, colour);
        seen |= s->face[at] != NO_FACE;
        for (int k = 0; k < 3; k++)
            sum[k] += colour[k] / (SIDE * SIDE);
    }
    if (seen && !atomic_load_explicit(d->seen, memory_order_relaxed))
        atomic_store_explicit(d->seen, 1, memory_order_relaxed);
    for (int k = 0; k < 3; k++)
        rgb[k] = srgb_byte(sum[k]);
}

/* Rows [from, to) of pixels into rgb. */
static int draw_rows(const struct drawing *d, int from, int to, uint8_t *rgb)
{
    struct samples samples;
    const struct picture *p = d->picture;
    int failed = samples_open(&samples, (size_t)((to - from) * SIDE) * (size_t)d->raster.width,
                              p->gathering ? p->solution->tree.bands : 0);
    if (!failed) {
        raster_rows(&d->raster, from * SIDE, to * SIDE, samples.face, samples.nearness);
        failed = p->gathering
                 && gathering_rows(p->gathering, &d->raster, p->solution, SIDE, from, to,
                                   samples.face, samples.light)
                        < 0;
    }
    for (int y = from; !failed && y < to; y++)
        for (int x = 0; x < p->width; x++)
            shade_pixel(d, &samples, from * SIDE, x, y,
                        &rgb[((size_t)y * (size_t)p->width + (size_t)x) * 3]);
    samples_close(&samples);
    return failed;
}

/* The picture in w x h samples: what each sees. To be closed and ended in either case. Returns 0 or
 * -1. */
static int rasterize(const struct picture *p, int w, int h, struct raster *r,
                     struct samples *samples)
{
    *r = (struct raster){0};
    if (samples_open(samples, (size_t)w * (size_t)h, 0) < 0
        || raster_begin(r, &p->solution->surfaces, &p->view, w, h, 0) < 0)
        return -1;
    raster_rows(r, 0, h, samples->face, samples->nearness);
    return 0;
}

/* B where sample i sees that face. Returns the leaf. */
static uint32_t see(const struct picture *p, const struct raster *r, size_t i, uint32_t face,
                    double radiosity[3])
{
    const size_t w = (size_t)r->width;
    double direction[3], point[3];
    raster_point(r, p->solution, face, (double)(i % w), (double)(i / w), direction, point);
    return vertex_values_at(p->values, p->solution, face, point, radiosity);
}

/* Luminances of what samples see: of lamps, or of all else. Returns how many. */
static size_t read_meter(const struct picture *p, const struct raster *r, const uint32_t *face,
                         int lamps, struct meter_sample *meter)
{
    size_t count = 0, all = (size_t)r->width * (size_t)r->height;
    for (size_t i = 0; i < all; i++) {
        double radiosity[3];
        if (face[i] == NO_FACE || is_lamp(&p->solution->surfaces, face[i]) != lamps)
            continue;
        (void)see(p, r, i, face[i], radiosity);
        double l = luminance(radiosity, p->solution->tree.bands);
        if (l > 0)
            meter[count++] = (struct meter_sample){l, 1};
    }
    return count;
}

static void warn_empty(const struct picture *p)
{
    const struct surfaces *s = &p->solution->surfaces;
    const double *eye = p->view.eye;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < s->face_count; i++)
        for (uint32_t j = 0; j < s->faces[i].vertices; j++)
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], s->faces[i].vertex[j][k]);
                high[k] = fmax(high[k], s->faces[i].vertex[j][k]);
            }
    report_warning(p->path, 0,
                   "no face shows its front to the eye at %.9g,%.9g,%.9g, so the picture is "
                   "empty; the scene reaches from %.9g,%.9g,%.9g to %.9g,%.9g,%.9g: give another "
                   "--view",
                   eye[0], eye[1], eye[2], low[0], low[1], low[2], high[0], high[1], high[2]);
}

/* Expose for what a coarse picture shows: what is lit by the scene, or the lamps if that is all. */
static int measure(struct picture *p)
{
    int w = (p->width + METER - 1) / METER, h = (p->height + METER - 1) / METER;
    size_t count = 0;
    struct meter_sample *meter = malloc((size_t)w * (size_t)h * sizeof *meter);
    struct samples samples;
    struct raster r;
    const int failed = rasterize(p, w, h, &r, &samples) < 0 || !meter;
    for (int lamps = 0; lamps < 2 && !failed && !count; lamps++)
        count = read_meter(p, &r, samples.face, lamps, meter);
    if (!failed)
        p->exposure = exposure_measure(meter, count);
    raster_end(&r);
    free(meter);
    samples_close(&samples);
    return failed ? -1 : 0;
}

static void draw_band(const void *context, size_t from, size_t to)
{
    const struct drawing *d = context;
    if (!atomic_load(d->failed) && draw_rows(d, (int)from, (int)to, d->rgb))
        atomic_store(d->failed, 1);
}

/* Light is gathered on all threads, in one part of the rows after the other; else each part is
 * drawn by one thread. */
static int draw(const struct picture *p, picture_colour colour, const void *context, uint8_t *rgb)
{
    atomic_int failed = 0, seen = 0;
    struct drawing d = {.picture = p,
                        .colour = colour,
                        .context = context,
                        .rgb = rgb,
                        .failed = &failed,
                        .seen = &seen};
    if (raster_begin(&d.raster, &p->solution->surfaces, &p->view, p->width * SIDE, p->height * SIDE,
                     0))
        return -1;
    thread_pool_run(p->gathering ? 1 : p->solution->threads, (size_t)p->height, BAND, draw_band,
                    &d);
    raster_end(&d.raster);
    if (atomic_load(&failed))
        return -1;
    if (!atomic_load(&seen) && !p->solution->quiet)
        warn_empty(p);
    return 0;
}

int picture_no_memory(const char *path)
{
    return report_error(path, 0, "out of memory for the picture; ask for a smaller one");
}

int picture_open(struct picture *p, const char *path, const struct solution *solution,
                 const struct vertex_values *values, const struct view *view, int width, int height,
                 int mesh)
{
    *p = (struct picture){.path = path,
                          .solution = solution,
                          .values = values,
                          .width = width,
                          .height = height,
                          .mesh = mesh};
    if (width < 1 || height < 1 || width > 16384 || height > 16384)
        return report_error(path, 0, "a picture of %d x %d; give 1 to 16384 pixels each way", width,
                            height);
    if (view)
        p->view = *view;
    else if (view_guess(&solution->surfaces, &p->view) < 0)
        return picture_no_memory(path);
    return measure(p) < 0 ? picture_no_memory(path) : 0;
}

int picture_seen(const struct picture *p, uint8_t *seen)
{
    struct samples samples;
    struct raster r;
    const int failed = rasterize(p, p->width, p->height, &r, &samples) < 0;
    const size_t all = (size_t)p->width * (size_t)p->height;
    for (size_t i = 0; i < all && !failed; i++) {
        double radiosity[3];
        if (samples.face[i] != NO_FACE)
            seen[see(p, &r, i, samples.face[i], radiosity)] = 1;
    }
    raster_end(&r);
    samples_close(&samples);
    return failed ? picture_no_memory(p->path) : 0;
}

uint8_t *picture_draw(const struct picture *p, picture_colour colour, const void *context)
{
    uint8_t *rgb = malloc((size_t)p->width * (size_t)p->height * 3);
    if (rgb && draw(p, colour, context, rgb) == 0)
        return rgb;
    free(rgb);
    if (!p->gathering || !p->gathering->failed)
        picture_no_memory(p->path);
    return NULL;
}
