/* cells.c - see cells.h.
 * SPDX-License-Identifier: MIT */
#include "tables/cells.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "geometry.h"
#include "util/array.h"
#include "util/atomic_file.h"

/* Of a polygon's size: a corner farther off the others' plane makes it bent. Scenes keep planes to
 * about 5e-5. */
static const double FLAT = 1e-3;

/* Twice the area vector of a polygon (Newell). */
static void area_vector(double v[3], const struct scene_file *f, const uint32_t *corner,
                        uint32_t count)
{
    v[0] = v[1] = v[2] = 0;
    for (uint32_t i = 2; i < count; i++) {
        double a[3], b[3], c[3];
        const double *origin = &f->positions[3 * (size_t)corner[0]];
        sub3(a, &f->positions[3 * (size_t)corner[i - 1]], origin);
        sub3(b, &f->positions[3 * (size_t)corner[i]], origin);
        cross3(c, a, b);
        for (int k = 0; k < 3; k++)
            v[k] += c[k];
    }
}

/* May it be cut by a grid: a triangle, or a flat convex quad? */
static int can_grid(double corner[4][3], uint32_t count, const double v[3])
{
    double size = sqrt(length3(v)), all = length3(v);
    if (count == 3)
        return 1;
    for (uint32_t i = 0; i < count; i++) {
        double a[3], b[3], c[3];
        sub3(a, corner[(i + 1) % count], corner[i]);
        sub3(b, corner[(i + 2) % count], corner[(i + 1) % count]);
        cross3(c, a, b);
        if (!(dot3(c, v) > 0) || fabs(dot3(b, v)) > FLAT * size * all)
            return 0;
    }
    return count == 4;
}

static double edge(double corner[4][3], int a, int b)
{
    double d[3];
    sub3(d, corner[b], corner[a]);
    return length3(d);
}

/* How many cells of this length (m) along an edge. */
static uint32_t parts(double length, double cell)
{
    double n = round(length / cell);
    return n < 1 ? 1 : n > 10000 ? 10000 : (uint32_t)n;
}

/* The point of a triangle's or quad's grid, by the same arithmetic for all cells that meet there.
 */
static void grid_point(double out[3], double corner[4][3], uint32_t count, double s, double t)
{
    double w[4] = {1 - s - t, s, t, 0};
    if (count == 4) {
        w[0] = (1 - s) * (1 - t);
        w[1] = s * (1 - t);
        w[2] = s * t;
        w[3] = (1 - s) * t;
    }
    for (int k = 0; k < 3; k++) {
        out[k] = 0;
        for (uint32_t i = 0; i < count; i++)
            out[k] += w[i] * corner[i][k];
    }
}

static int add(struct cells *cells, double corner[4][3], uint32_t count, uint32_t polygon,
               const double st[4][2], uint32_t corners)
{
    if (array_reserve(&cells->cell, (size_t)cells->count + 1, &cells->capacity, sizeof *cells->cell)
        < 0)
        return -1;
    struct cell *c = &cells->cell[cells->count++];
    *c = (struct cell){.corners = corners, .polygon = polygon};
    for (uint32_t i = 0; i < corners; i++)
        grid_point(c->corner[i], corner, count, st[i][0], st[i][1]);
    return 0;
}

static int cut_quad(struct cells *cells, double corner[4][3], uint32_t polygon, double side)
{
    uint32_t n = parts((edge(corner, 0, 1) + edge(corner, 3, 2)) / 2, side),
             m = parts((edge(corner, 1, 2) + edge(corner, 0, 3)) / 2, side);
    for (uint32_t j = 0; j < m; j++)
        for (uint32_t i = 0; i < n; i++) {
            double s0 = (double)i / n, s1 = (double)(i + 1) / n, t0 = (double)j / m,
                   t1 = (double)(j + 1) / m;
            const double st[4][2] = {{s0, t0}, {s1, t0}, {s1, t1}, {s0, t1}};
            if (add(cells, corner, 4, polygon, st, 4) < 0)
                return -1;
        }
    return 0;
}

static int cut_triangle(struct cells *cells, double corner[4][3], uint32_t polygon, double area,
                        double cell)
{
    uint32_t n = parts(sqrt(area), sqrt(cell));
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i + j < n; i++) {
            double s0 = (double)i / n, s1 = (double)(i + 1) / n, t0 = (double)j / n,
                   t1 = (double)(j + 1) / n;
            const double up[4][2] = {{s0, t0}, {s1, t0}, {s0, t1}},
                         down[4][2] = {{s1, t0}, {s1, t1}, {s0, t1}};
            if (add(cells, corner, 3, polygon, up, 3) < 0
                || (i + j + 2 <= n && add(cells, corner, 3, polygon, down, 3) < 0))
                return -1;
        }
    return 0;
}

int cells_cut(struct cells *cells, const struct scene_file *file, double share, double *area)
{
    *cells = (struct cells){0};
    *area = 0;
    double v[3], corner[4][3];
    const uint32_t *at = file->indices;
    for (uint32_t p = 0; p < file->polygon_count; at += file->sizes[p++]) {
        area_vector(v, file, at, file->sizes[p]);
        *area += length3(v) / 2 * (1 + file->materials[file->polygon_materials[p]].two_sided);
    }
    double cell = share * *area;
    at = file->indices;
    for (uint32_t p = 0; p < file->polygon_count; at += file->sizes[p++]) {
        uint32_t count = file->sizes[p];
        int failed;
        area_vector(v, file, at, count);
        for (uint32_t i = 0; i < count && i < 4; i++)
            memcpy(corner[i], &file->positions[3 * (size_t)at[i]], sizeof corner[i]);
        if (count < 3 || count > 4 || !can_grid(corner, count, v))
            failed = add(cells, NULL, 0, p, NULL, 0);
        else
            failed = count == 4 ? cut_quad(cells, corner, p, sqrt(cell))
                                : cut_triangle(cells, corner, p, length3(v) / 2, cell);
        if (failed) {
            cells_free(cells);
            return -1;
        }
    }
    return 0;
}

void cells_free(struct cells *cells)
{
    free(cells->cell);
    *cells = (struct cells){0};
}

static void print_materials(FILE *out, const struct scene_file *f)
{
    for (uint32_t i = 0; i < f->material_count; i++) {
        const double *d = f->materials[i].reflectance, *e = f->materials[i].exitance;
        size_t length = strlen(f->names[i]);
        int named = length > 2 && strcmp(f->names[i] + length - 3, "_2s") == 0;
        fprintf(out, "newmtl m%u%s\nKd %.17g %.17g %.17g\nKe %.17g %.17g %.17g\n", (unsigned)i,
                named || f->materials[i].two_sided ? "_2s" : "", d[0], d[1], d[2], e[0], e[1],
                e[2]);
    }
}

static void print_cells(FILE *out, const struct cells *cells, const struct scene_file *f,
                        const char *materials)
{
    uint32_t current = UINT32_MAX, polygon = 0;
    const uint32_t *at = f->indices;
    fprintf(out, "mtllib %s\n", materials);
    for (uint32_t i = 0; i < cells->count; i++) {
        const struct cell *c = &cells->cell[i];
        for (; polygon < c->polygon; polygon++)
            at += f->sizes[polygon];
        uint32_t count = c->corners ? c->corners : f->sizes[polygon],
                 material = f->polygon_materials[polygon];
        if (material != current)
            fprintf(out, "usemtl m%u%s\n", (unsigned)material,
                    f->materials[material].two_sided ? "_2s" : "");
        current = material;
        for (uint32_t j = 0; j < count; j++) {
            const double *p = c->corners ? c->corner[j] : &f->positions[3 * (size_t)at[j]];
            fprintf(out, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
        }
        fputs("f", out);
        for (uint32_t j = count; j > 0; j--)
            fprintf(out, " -%u", (unsigned)j);
        fputc('\n', out);
    }
}

int cells_write(const struct cells *cells, const struct scene_file *file, const char *path)
{
    char name[2][4096];
    for (int i = 0; i < 2; i++) {
        struct atomic_file out;
        snprintf(name[i], sizeof name[i], "%s.%s", path, i ? "obj" : "mtl");
        if (atomic_open(&out, name[i]) < 0)
            return -1;
        const char *slash = strrchr(name[0], '/');
        if (i)
            print_cells(out.stream, cells, file, slash ? slash + 1 : name[0]);
        else
            print_materials(out.stream, file);
        if (atomic_commit(&out) < 0)
            return -1;
    }
    return 0;
}
