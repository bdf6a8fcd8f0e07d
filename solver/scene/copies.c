/* copies.c - see copies.h.
 * SPDX-License-Identifier: MIT */
#include "scene/copies.h"

#include <math.h>

#include "util/report.h"

/* Of coordinates: what is nearer to a plane is on it. MOST: polygons that a scene may become. */
static const double ON_PLANE = 1e-9;
enum { MOST = 1 << 26 };

/* A message's line; 0: the format has none. */
static uint32_t line_of(const struct scene_file *f, uint32_t polygon)
{
    return f->lines ? f->lines[polygon] : 0;
}

/* How far the used positions reach along an axis. */
static double extent(const struct scene_file *f, int axis, double *low)
{
    double high = -INFINITY;
    *low = INFINITY;
    for (size_t i = 0; i < f->index_count; i++) {
        double x = f->positions[3 * (size_t)f->indices[i] + (size_t)axis];
        *low = fmin(*low, x);
        high = fmax(high, x);
    }
    return high - *low;
}

/* All of the scene is on one side of the mirror, and nothing lies in it. */
static int check_mirror(const struct scene_file *f, const char *path, const struct copy_step *s)
{
    double low, size = extent(f, s->axis, &low);
    double on = ON_PLANE * (fabs(low) + size + fabs(s->at));
    int sides = 0;
    size_t at = 0;
    for (uint32_t i = 0; i < f->polygon_count; i++) {
        int here = 0;
        for (uint32_t k = 0; k < f->sizes[i]; k++, at++) {
            double x = f->positions[3 * (size_t)f->indices[at] + (size_t)s->axis] - s->at;
            here |= x > on ? 1 : x < -on ? 2 : 0;
        }
        if (here == 0 && f->sizes[i] > 2)
            return report_error(path, line_of(f, i),
                                "face %u lies in the mirror %c=%g; its image would lie on it: "
                                "leave it out",
                                (unsigned)i, "xyz"[s->axis], s -> at);
        sides |= here;
        if (sides == 3)
            return report_error(
                path, line_of(f, i), "face %u %s the mirror %c=%g; keep what is on one side of it",
                (unsigned)i, here == 3 ? "crosses" : "and others are on both sides of",
                "xyz"[s->axis], s -> at);
    }
    return 0;
}

static int check_period(const struct scene_file *f, const char *path, const struct copy_step *s)
{
    double low, size = extent(f, s->axis, &low);
    if (size <= s->at * (1 + ON_PLANE) + ON_PLANE * fabs(low))
        return 0;
    return report_error(path, 0,
                        "the scene is %g m long in %c, more than its period of %g m, and copies "
                        "would overlap; give a period as long as the scene",
                        size, "xyz"[s->axis], s -> at);
}

/* One copy of the first `count` polygons, of `corners` corners and `positions` positions: moved, or
 * turned inside out by a mirror, whose fronts are its originals'. */
static int add_copy(struct scene_file *f, const struct copy_step *s, double move, uint32_t count,
                    size_t positions)
{
    uint32_t base = (uint32_t)f->position_count;
    if (f->position_count + positions > UINT32_MAX)
        return -1;
    for (size_t i = 0; i < positions; i++) {
        double p[3] = {f->positions[3 * i], f->positions[3 * i + 1], f->positions[3 * i + 2]};
        p[s->axis] = s->times ? p[s->axis] + move : 2 * s->at - p[s->axis];
        if (scene_file_add_position(f, p) < 0)
            return -1;
    }
    size_t at = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t n = f->sizes[i];
        for (uint32_t k = 0; k < n; k++)
            if (scene_file_add_corner(f, base + f->indices[at + (s->times ? k : n - 1 - k)]) < 0)
                return -1;
        at += n;
        if (scene_file_add_polygon(f, n, f->polygon_materials[i], line_of(f, i)) < 0)
            return -1;
    }
    return 0;
}

int copies_add(struct scene_file *f, const char *path, const struct copies *copies)
{
    double all = f->polygon_count;
    for (int c = 0; c < copies->count; c++)
        all *= copies->steps[c].times ? 2.0 * copies->steps[c].times + 1 : 2;
    if (all > MOST)
        return report_error(path, 0,
                            "%u faces would be %.3g with their copies, too many; repeat "
                            "less",
                            (unsigned)f->polygon_count, all);
    for (int c = 0; c < copies->count; c++) {
        const struct copy_step *s = &copies->steps[c];
        const uint32_t count = f->polygon_count;
        const size_t positions = f->position_count;
        if ((s->times ? check_period : check_mirror)(f, path, s) < 0)
            return -1;
        for (int k = -s->times; k <= s->times; k++)
            if ((k != 0 || s->times == 0) && add_copy(f, s, k * s->at, count, positions) < 0)
                return scene_file_no_memory(path);
    }
    return 0;
}
