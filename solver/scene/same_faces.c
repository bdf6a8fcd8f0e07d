/* same_faces.c - see same_faces.h.
 *
 * Faces are sorted by a sum over their corners, which knows no order; those of one sum are
 * compared.
 * SPDX-License-Identifier: MIT */
#include "scene/same_faces.h"

#include <stdlib.h>
#include <string.h>

#include "kernel/hash.h"
#include "util/report.h"

struct key {
    uint64_t sum;
    size_t first; /* of its indices */
    uint32_t polygon;
};

static int compare_keys(const void *a, const void *b)
{
    const struct key *x = a, *y = b;
    if (x->sum != y->sum)
        return x->sum < y->sum ? -1 : 1;
    return (x->polygon > y->polygon) - (x->polygon < y->polygon);
}

static const double *corner(const struct scene_file *f, const struct key *k, uint32_t i)
{
    return &f->positions[3 * (size_t)f->indices[k->first + i % f->sizes[k->polygon]]];
}

static int same_place(const double a[3], const double b[3])
{
    return a[0] <= b[0] && a[0] >= b[0] && a[1] <= b[1] && a[1] >= b[1] && a[2] <= b[2]
           && a[2] >= b[2];
}

static uint64_t corner_sum(const struct scene_file *f, const struct key *k)
{
    uint64_t sum = f->sizes[k->polygon];
    for (uint32_t i = 0; i < f->sizes[k->polygon]; i++) {
        uint64_t h = 0;
        for (int c = 0; c < 3; c++) {
            double x = corner(f, k, i)[c] + 0.0; /* -0 is 0 */
            uint64_t bits;
            memcpy(&bits, &x, sizeof bits);
            h = hash64(h + bits + HASH_STEP);
        }
        sum += h;
    }
    return sum;
}

/* The same ring, in the same sense (step 1) or turned over (step -1)? */
static int same_ring(const struct scene_file *f, const struct key *a, const struct key *b, int over)
{
    uint32_t n = f->sizes[a->polygon];
    for (uint32_t from = 0; from < n; from++) {
        uint32_t i = 0;
        while (i < n && same_place(corner(f, a, i), corner(f, b, over ? from + n - i : from + i)))
            i++;
        if (i == n)
            return 1;
    }
    return 0;
}

static int is_same(const struct scene_file *f, const struct key *a, const struct key *b)
{
    if (f->sizes[a->polygon] != f->sizes[b->polygon])
        return 0;
    int two_sided = f->materials[f->polygon_materials[a->polygon]].two_sided
                    || f->materials[f->polygon_materials[b->polygon]].two_sided;
    return same_ring(f, a, b, 0) || (two_sided && same_ring(f, a, b, 1));
}

int drop_same_faces(struct scene_file *f, const char *path, int quiet)
{
    struct key *keys = malloc(((size_t)f->polygon_count + 1) * sizeof *keys);
    size_t at = 0;
    uint32_t count = 0, dropped = 0, first = 0, stays = 0;
    if (!keys)
        return scene_file_no_memory(path);
    for (uint32_t i = 0; i < f->polygon_count; at += f->sizes[i++])
        if (f->sizes[i] >= 3) {
            keys[count] = (struct key){.first = at, .polygon = i};
            keys[count].sum = corner_sum(f, &keys[count]);
            count++;
        }
    qsort(keys, count, sizeof *keys, compare_keys);
    /* Of a run of one sum, those that stay move to its front. */
    for (uint32_t i = 0, from = 0, kept = 0; i < count; i++) {
        if (!i || keys[i].sum != keys[i - 1].sum)
            from = kept = i;
        uint32_t j = from;
        while (j < kept && !is_same(f, &keys[j], &keys[i]))
            j++;
        if (j == kept) {
            struct key stay = keys[i];
            keys[kept++] = stay;
            continue;
        }
        if (!dropped++ || keys[i].polygon < first) {
            first = keys[i].polygon;
            stays = keys[j].polygon;
        }
        for (uint32_t k = 1; k < f->sizes[keys[i].polygon]; k++)
            f->indices[keys[i].first + k] = f->indices[keys[i].first];
    }
    free(keys);
    if (dropped && !quiet)
        report_warning(path, f->lines[first],
                       "face %u has the corners of face %u, which stays; %u such faces are dropped",
                       (unsigned)first, (unsigned)stays, (unsigned)dropped);
    return 0;
}
