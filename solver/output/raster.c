/* raster.c - see raster.h.
 * SPDX-License-Identifier: MIT */
#include "output/raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"

static double value(const struct raster_plane *p, double x, double y)
{
    return p->c[0] + p->c[1] * x + p->c[2] * y;
}

/* The function dot(n, direction of (x, y)). */
static struct raster_plane along(const struct raster *r, const double n[3])
{
    return (struct raster_plane){{dot3(n, r->corner), dot3(n, r->step_x), dot3(n, r->step_y)}};
}

/* Samples between low and high along one side of the picture, one to spare. */
static void clip_range(double low, double high, int size, int *from, int *to)
{
    *from = low > 1 ? (low < size ? (int)low - 1 : size) : 0;
    *to = high < size - 1 ? (high > -1 ? (int)high + 2 : 0) : size;
}

/* The box of a face in the picture, of the part that is ahead of the eye by `least`. */
static int bound(const struct raster *r, struct raster_face *f, double (*v)[3], int n,
                 const double frame[3][3], double least)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    double half_x = 1 / length3(r->step_x), half_y = 1 / length3(r->step_y);
    for (int i = 0; i < n; i++) {
        const double *a = v[i], *b = v[(i + 1) % n];
        double za = dot3(a, frame[2]), zb = dot3(b, frame[2]);
        double point[2][3];
        int points = 0;
        if (za >= least)
            memcpy(point[points++], a, sizeof point[0]);
        if ((za < least) != (zb < least)) {
            double t = (least - za) / (zb - za);
            for (int k = 0; k < 3; k++)
                point[points][k] = a[k] + t * (b[k] - a[k]);
            points++;
        }
        for (int j = 0; j < points; j++) {
            double z = fmax(dot3(point[j], frame[2]), least);
            double x = r->width / 2.0 + dot3(point[j], frame[0]) / z * half_x;
            double y = r->height / 2.0 - dot3(point[j], frame[1]) / z * half_y;
            low[0] = fmin(low[0], x);
            high[0] = fmax(high[0], x);
            low[1] = fmin(low[1], y);
            high[1] = fmax(high[1], y);
        }
    }
    if (!(low[0] <= high[0]))
        return 0;
    clip_range(low[0], high[0], r->width, &f->left, &f->right);
    clip_range(low[1], high[1], r->height, &f->top, &f->bottom);
    return f->left < f->right && f->top < f->bottom;
}

static int prepare(const struct raster *r, struct raster_face *f, const struct RadFace *face,
                   const double frame[3][3], double least, int backs)
{
    double v[4][3] = {{0}}, normal[3] = {0, 0, 0};
    int n = (int)face->vertices;
    for (int i = 0; i < n; i++)
        sub3(v[i], face->vertex[i], r->eye);
    for (int i = 2; i < n; i++) {
        double a[3], b[3], c[3];
        sub3(a, v[i - 1], v[0]);
        sub3(b, v[i], v[0]);
        cross3(c, a, b);
        for (int k = 0; k < 3; k++)
            normal[k] += c[k];
    }
    double height = dot3(normal, v[0]);
    f->front = height < 0;
    if (height == 0 || (!f->front && (!backs || face->back)) || !bound(r, f, v, n, frame, least))
        return 0;
    f->edges = n;
    for (int i = 0; i < n; i++) {
        double c[3];
        cross3(c, v[(i + 1) % n], v[i]);
        if (!f->front)
            for (int k = 0; k < 3; k++)
                c[k] = -c[k];
        f->edge[i] = along(r, c);
    }
    for (int k = 0; k < 3; k++)
        normal[k] /= height;
    f->depth = along(r, normal);
    return 1;
}

int raster_begin(struct raster *r, const struct surfaces *surfaces, const struct view *view,
                 int width, int height, int backs)
{
    double frame[3][3], size = 0;
    view_frame(view, surfaces, frame[0], frame[1], frame[2]);
    *r = (struct raster){.width = width, .height = height};
    memcpy(r->eye, view->eye, sizeof r->eye);
    const double step = 2 * view_half_height(view) / height;
    for (int k = 0; k < 3; k++) {
        r->step_x[k] = step * frame[0][k];
        r->step_y[k] = -step * frame[1][k];
        r->corner[k] = frame[2][k] - 0.5 * width * r->step_x[k] - 0.5 * height * r->step_y[k];
    }
    r->faces = malloc(((size_t)surfaces->face_count + 1) * sizeof *r->faces);
    if (!r->faces)
        return -1;
    for (uint32_t i = 0; i < surfaces->face_count; i++)
        for (uint32_t j = 0; j < surfaces->faces[i].vertices; j++)
            for (int k = 0; k < 3; k++)
                size = fmax(size, fabs(surfaces->faces[i].vertex[j][k] - view->eye[k]));
    for (uint32_t i = 0; i < surfaces->face_count; i++) {
        r->faces[r->count].face = i;
        r->count += (uint32_t)prepare(r, &r->faces[r->count], &surfaces->faces[i],
                                      (const double(*)[3])frame, 1e-7 * size, backs);
    }
    return 0;
}

/* What of row y every edge of the face leaves, one sample to spare for rounding. */
static void row_range(const struct raster_face *f, int y, double *low, double *high)
{
    *low = f->left;
    *high = f->right;
    for (int j = 0; j < f->edges; j++) {
        double at_zero = value(&f->edge[j], 0.5, y + 0.5), slope = f->edge[j].c[1];
        if (slope > 0)
            *low = fmax(*low, -at_zero / slope - 1);
        else if (slope < 0)
            *high = fmin(*high, -at_zero / slope + 2);
        else if (at_zero < 0)
            *high = *low;
    }
}

/* Row y of a face into a row of samples, where nothing is nearer. */
static void draw_row(const struct raster_face *f, int y, uint32_t *face, double *nearness)
{
    double low, high;
    row_range(f, y, &low, &high);
    if (!(low < high)) /* an edge along the row is beyond what an int holds */
        return;
    for (int x = (int)low; x < high; x++) {
        int inside = 1;
        for (int j = 0; j < f->edges; j++)
            inside &= value(&f->edge[j], x + 0.5, y + 0.5) >= 0;
        double near = value(&f->depth, x + 0.5, y + 0.5);
        if (inside && near > 0 && (near > nearness[x] || (near == nearness[x] && f->front))) {
            nearness[x] = near;
            face[x] = f->face;
        }
    }
}

void raster_rows(const struct raster *r, int from, int to, uint32_t *face, double *nearness)
{
    size_t width = (size_t)r->width;
    for (size_t i = 0; i < (size_t)(to - from) * width; i++) {
        face[i] = NO_FACE;
        nearness[i] = 0;
    }
    for (uint32_t i = 0; i < r->count; i++) {
        const struct raster_face *f = &r->faces[i];
        int top = f->top > from ? f->top : from, bottom = f->bottom < to ? f->bottom : to;
        for (int y = top; y < bottom; y++)
            draw_row(f, y, &face[(size_t)(y - from) * width],
                     &nearness[(size_t)(y - from) * width]);
    }
}

void raster_direction(const struct raster *r, double x, double y, double direction[3])
{
    for (int k = 0; k < 3; k++)
        direction[k] = r->corner[k] + (x + 0.5) * r->step_x[k] + (y + 0.5) * r->step_y[k];
}

void raster_point(const struct raster *r, const struct solution *s, uint32_t face, double x,
                  double y, double direction[3], double point[3])
{
    const struct element *e = element_of_face(s, face);
    raster_direction(r, x, y, direction);
    double to[3];
    sub3(to, e->vertex[0], r->eye);
    double t = dot3(e->normal, to) / dot3(e->normal, direction);
    for (int k = 0; k < 3; k++)
        point[k] = r->eye[k] + t * direction[k];
}

void raster_end(struct raster *r)
{
    free(r->faces);
    *r = (struct raster){0};
}
