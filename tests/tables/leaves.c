/* leaves.c - see leaves.h.
 *
 * Between its corners, some of which lie in the middle of an edge, a leaf has mean value
 * coordinates: linear along edges, so that neighbours agree. [Floater 2003, Mean value coordinates]
 * SPDX-License-Identifier: MIT */
#include "tables/leaves.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "geometry.h"
#include "util/report.h"
#include "util/text_file.h"

/* Of the mesh's largest extent: farther off a leaf's plane or border a point is not on it.
 * Positions are floats, and quads of scenes are bent by up to 5e-5 of their size. */
static const double NEAR = 1e-4;
/* Sine of a turn that rounding to floats makes where an edge goes on. */
static const double STRAIGHT = 0.02;
enum { VOXELS = 96, CORNERS_MAX = 4096 };

/* ---- the file: binary little endian, as is this machine (checked) */

struct property {
    int bytes, band; /* band: of radiosity_K, else -1; -2 to -4: x, y, z */
};

struct reader {
    const char *path, *at, *end;
};

static int size_of(const char *type)
{
    static const struct {
        const char *name;
        int bytes;
    } known[] = {{"float", 4}, {"uchar", 1}, {"uint", 4}, {"int", 4}, {"double", 8}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(type, known[i].name) == 0)
            return known[i].bytes;
    return 0;
}

static int damaged(const struct reader *r)
{
    return report_error(r->path, 0, "not a mesh of `radiosity solve -o FILE.ply`, or cut short");
}

/* The header; properties of vertices, and how many bytes a face has behind its corners. */
static int read_header(struct leaves *m, struct reader *r, struct property p[64], int *properties,
                       int *behind)
{
    int in_face = 0;
    *properties = *behind = 0;
    while (r->at < r->end) {
        char line[256], type[32], name[64];
        const char *stop = memchr(r->at, '\n', (size_t)(r->end - r->at));
        if (!stop)
            break;
        snprintf(line, sizeof line, "%.*s", (int)(stop - r->at), r->at);
        r->at = stop + 1;
        if (strcmp(line, "end_header") == 0)
            return m->vertices && m->polygons && m->bands ? 0 : damaged(r);
        sscanf(line, "element vertex %u", &m->vertices);
        in_face |= sscanf(line, "element face %u", &m->polygons) == 1;
        if (sscanf(line, "property %31s %63s", type, name) != 2 || strcmp(type, "list") == 0)
            continue;
        if (in_face) {
            *behind += size_of(type);
            continue;
        }
        int band = -1;
        if (sscanf(name, "radiosity_%d", &band) == 1)
            m->bands = (uint32_t)band + 1;
        else if (strlen(name) == 1 && strchr("xyz", *name))
            band = -2 - (*name - 'x');
        if (*properties == 64 || m->bands > 3)
            return damaged(r);
        p[(*properties)++] = (struct property){size_of(type), band};
    }
    return damaged(r);
}

static int read_vertices(struct leaves *m, struct reader *r, const struct property *p,
                         int properties)
{
    m->position = malloc(3 * (size_t)m->vertices * sizeof *m->position);
    m->value = calloc((size_t)m->bands * m->vertices, sizeof *m->value);
    if (!m->position || !m->value)
        return report_error(r->path, 0, "out of memory for the mesh");
    for (uint32_t i = 0; i < m->vertices; i++)
        for (int k = 0; k < properties; r->at += p[k++].bytes) {
            float single;
            double value;
            if (r->end - r->at < p[k].bytes)
                return damaged(r);
            if (p[k].band == -1)
                continue;
            if (p[k].bytes == sizeof value) {
                memcpy(&value, r->at, sizeof value);
            } else if (p[k].bytes == sizeof single) {
                memcpy(&single, r->at, sizeof single);
                value = (double)single;
            } else {
                continue;
            }
            if (p[k].band >= 0)
                m->value[(size_t)i * m->bands + (size_t)p[k].band] = value;
            else
                m->position[3 * (size_t)i + (size_t)(-2 - p[k].band)] = value;
        }
    return 0;
}

static int read_polygons(struct leaves *m, struct reader *r, int behind)
{
    size_t room = (size_t)(r->end - r->at) / 4;
    m->corner = malloc((room + 1) * sizeof *m->corner);
    m->start = malloc(((size_t)m->polygons + 1) * sizeof *m->start);
    if (!m->corner || !m->start)
        return report_error(r->path, 0, "out of memory for the mesh");
    uint32_t count, corners = 0;
    for (uint32_t i = 0; i < m->polygons; i++) {
        m->start[i] = corners;
        if (r->end - r->at < 4)
            return damaged(r);
        memcpy(&count, r->at, 4);
        r->at += 4;
        if (count < 3 || count > CORNERS_MAX || (size_t)(r->end - r->at) < 4 * (size_t)count)
            return damaged(r);
        memcpy(&m->corner[corners], r->at, 4 * (size_t)count);
        r->at += 4 * (size_t)count + (size_t)behind;
        for (uint32_t j = 0; j < count; j++)
            if (m->corner[corners++] >= m->vertices)
                return damaged(r);
    }
    m->start[m->polygons] = corners;
    return 0;
}

/* ---- the grid */

static const double *position(const struct leaves *m, uint32_t corner)
{
    return &m->position[3 * (size_t)m->corner[corner]];
}

static uint32_t clamped(double x, uint32_t side)
{
    return x <= 0 ? 0 : x >= side ? side - 1 : (uint32_t)x;
}

/* Voxels of polygon i's box. */
static void voxels_of(const struct leaves *m, uint32_t i, double near, uint32_t from[3],
                      uint32_t to[3])
{
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t j = m->start[i]; j < m->start[i + 1]; j++) {
            low = fmin(low, position(m, j)[k]);
            high = fmax(high, position(m, j)[k]);
        }
        from[k] = clamped((low - near - m->low[k]) / m->size, m->side[k]);
        to[k] = clamped((high + near - m->low[k]) / m->size, m->side[k]);
    }
}

/* Count (items NULL), or fill in, what lies in each voxel. */
static void spread(struct leaves *m, double near, uint32_t *count, uint32_t *items)
{
    for (uint32_t i = 0; i < m->polygons; i++) {
        uint32_t from[3], to[3];
        voxels_of(m, i, near, from, to);
        for (uint32_t z = from[2]; z <= to[2]; z++)
            for (uint32_t y = from[1]; y <= to[1]; y++)
                for (uint32_t x = from[0]; x <= to[0]; x++) {
                    size_t at = ((size_t)z * m->side[1] + y) * m->side[0] + x;
                    if (items)
                        items[count[at]] = i;
                    count[at]++;
                }
    }
}

static double extent(const struct leaves *m)
{
    return m->size * VOXELS;
}

/* A leaf is a convex triangle or quad, with other corners in the middle of its edges only. Older
 * commands have written some that are not, by corners of others: those say nothing. */
static int is_leaf_shaped(const struct leaves *m, uint32_t i, const double normal[3])
{
    int turns = 0;
    for (uint32_t j = m->start[i], begin = j, count = m->start[i + 1] - j; j < begin + count; j++) {
        double a[3], b[3], c[3];
        const double *p = position(m, begin + (j + 1 - begin) % count);
        sub3(a, p, position(m, j));
        sub3(b, position(m, begin + (j + 2 - begin) % count), p);
        cross3(c, a, b);
        double sine = dot3(c, normal) / fmax(length3(a) * length3(b), 1e-300);
        if (sine < -STRAIGHT)
            return 0;
        turns += sine > STRAIGHT;
    }
    return turns <= 4;
}

/* The unit normal of polygon i; 0 where it is no leaf. */
static void make_normal(struct leaves *m, uint32_t i)
{
    double n[3] = {0, 0, 0};
    for (uint32_t j = m->start[i] + 2; j < m->start[i + 1]; j++) {
        double a[3], b[3], c[3];
        sub3(a, position(m, j - 1), position(m, m->start[i]));
        sub3(b, position(m, j), position(m, m->start[i]));
        cross3(c, a, b);
        for (int k = 0; k < 3; k++)
            n[k] += c[k];
    }
    double l = length3(n);
    for (int k = 0; k < 3; k++)
        m->normal[i][k] = l > 0 ? n[k] / l : 0;
    if (!is_leaf_shaped(m, i, m->normal[i]))
        memset(m->normal[i], 0, sizeof m->normal[i]);
}

static int make_grid(struct leaves *m, const char *path)
{
    double high[3];
    for (int k = 0; k < 3; k++) {
        m->low[k] = INFINITY;
        high[k] = -INFINITY;
        for (uint32_t i = 0; i < m->vertices; i++) {
            m->low[k] = fmin(m->low[k], m->position[3 * (size_t)i + (size_t)k]);
            high[k] = fmax(high[k], m->position[3 * (size_t)i + (size_t)k]);
        }
        m->size = fmax(m->size, (high[k] - m->low[k]) / VOXELS);
    }
    size_t voxels = 1;
    for (int k = 0; k < 3; k++)
        voxels *= m->side[k] = clamped((high[k] - m->low[k]) / m->size, VOXELS) + 1;
    m->normal = malloc((size_t)m->polygons * sizeof *m->normal);
    m->first = calloc(voxels + 2, sizeof *m->first);
    if (!m->normal || !m->first)
        return report_error(path, 0, "out of memory for the mesh");
    for (uint32_t i = 0; i < m->polygons; i++)
        make_normal(m, i);
    /* first[i + 2] counts, is summed up, and ends as the end of voxel i, where i + 1 begins */
    double near = NEAR * extent(m);
    spread(m, near, m->first + 2, NULL);
    for (size_t i = 2; i < voxels + 2; i++)
        m->first[i] += m->first[i - 1];
    m->item = malloc(((size_t)m->first[voxels + 1] + 1) * sizeof *m->item);
    if (!m->item)
        return report_error(path, 0, "out of memory for the mesh");
    spread(m, near, m->first + 1, m->item);
    return 0;
}

int leaves_read(struct leaves *m, const char *path)
{
    *m = (struct leaves){0};
    size_t size;
    char *text = text_file_read(path, &size);
    if (!text)
        return report_error(path, 0, "cannot be read");
    struct reader r = {path, text, text + size};
    struct property p[64];
    int properties, behind,
        failed = read_header(m, &r, p, &properties, &behind) < 0
                 || read_vertices(m, &r, p, properties) < 0 || read_polygons(m, &r, behind) < 0
                 || make_grid(m, path) < 0;
    free(text);
    if (failed)
        leaves_free(m);
    return failed ? -1 : 0;
}

void leaves_free(struct leaves *m)
{
    free(m->position);
    free(m->value);
    free(m->corner);
    free(m->start);
    free(m->normal);
    free(m->first);
    free(m->item);
    *m = (struct leaves){0};
}

/* ---- points */

/* How far point lies within the border of polygon i (m); below 0: outside. */
static double inside(const struct leaves *m, uint32_t i, const double point[3])
{
    double least = INFINITY;
    for (uint32_t j = m->start[i]; j < m->start[i + 1]; j++) {
        double e[3], w[3], c[3];
        sub3(e, position(m, j + 1 < m->start[i + 1] ? j + 1 : m->start[i]), position(m, j));
        sub3(w, point, position(m, j));
        cross3(c, e, w);
        double l = length3(e);
        if (l > 0)
            least = fmin(least, dot3(c, m->normal[i]) / l);
    }
    return least;
}

/* Tangent of half the angle at `point` between corners a and b. */
static double half_angle(const double *point, const double *a, const double *b)
{
    double x[3], y[3], c[3];
    sub3(x, a, point);
    sub3(y, b, point);
    cross3(c, x, y);
    double product = length3(x) * length3(y);
    return length3(c) / fmax(product + dot3(x, y), 1e-12 * product);
}

static void interpolate(const struct leaves *m, uint32_t i, const double point[3], double *value)
{
    uint32_t begin = m->start[i], end = m->start[i + 1];
    double all = 0;
    for (uint32_t k = 0; k < m->bands; k++)
        value[k] = 0;
    for (uint32_t j = begin; j < end; j++) {
        double d[3];
        const double *at = position(m, j);
        sub3(d, at, point);
        if (!(length3(d) > 1e-9 * extent(m))) {
            memcpy(value, &m->value[(size_t)m->corner[j] * m->bands], m->bands * sizeof *value);
            return;
        }
        double weight = (half_angle(point, position(m, j > begin ? j - 1 : end - 1), at)
                         + half_angle(point, at, position(m, j + 1 < end ? j + 1 : begin)))
                        / length3(d);
        all += weight;
        for (uint32_t k = 0; k < m->bands; k++)
            value[k] += weight * m->value[(size_t)m->corner[j] * m->bands + k];
    }
    for (uint32_t k = 0; k < m->bands; k++)
        value[k] /= all;
}

int leaves_at(const struct leaves *m, const double point[3], const double normal[3], double *value)
{
    uint32_t v[3], best = m->polygons;
    double nearest = NEAR * extent(m);
    for (int k = 0; k < 3; k++)
        v[k] = clamped((point[k] - m->low[k]) / m->size, m->side[k]);
    size_t voxel = ((size_t)v[2] * m->side[1] + v[1]) * m->side[0] + v[0];
    for (uint32_t j = m->first[voxel]; j < m->first[voxel + 1]; j++) {
        uint32_t i = m->item[j];
        double d[3];
        if (dot3(m->normal[i], normal) < 0.99)
            continue;
        sub3(d, point, position(m, m->start[i]));
        double off = fmax(fabs(dot3(d, m->normal[i])), -inside(m, i, point));
        if (off < nearest) {
            nearest = off;
            best = i;
        }
    }
    if (best == m->polygons)
        return -1;
    interpolate(m, best, point, value);
    return 0;
}
