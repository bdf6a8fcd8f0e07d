/* back_faces.c - see back_faces.h.
 *
 * Two one-sided faces back to back, at exactly one place, are how many scenes have a thin panel. A
 * ray meets either of them first, by rounding; so what it meets is told by the side that it comes
 * from. Faces at one place have the same corners: they are found by a sum over corners that no
 * order of corners changes, and then compared.
 * SPDX-License-Identifier: MIT */
#include "visibility/back_faces.h"
#include <stdlib.h>
#include <string.h>
#include "hierarchy/vector_hash.h"

struct stand {
    uint64_t key;
    uint32_t face;
};

static int by_key(const void *a, const void *b)
{
    const struct stand *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return (x->face > y->face) - (x->face < y->face);
}

/* Have both the same corners, in opposite order? */
static int back_to_back(const struct face *a, const struct face *b)
{
    uint32_t n = a->vertices;
    if (b->vertices != n)
        return 0;
    for (uint32_t start = 0; start < n; start++) {
        uint32_t same = 0;
        for (uint32_t i = 0; i < n; i++) {
            const double *v = a->vertex[i], *w = b->vertex[(start + n - i) % n];
            same += v[0] == w[0] && v[1] == w[1] && v[2] == w[2];
        }
        if (same == n)
            return 1;
    }
    return 0;
}

int back_faces_find(const struct hierarchy *h, uint32_t *behind)
{
    struct stand *stands = malloc(h->face_count * sizeof *stands);
    uint32_t count = 0;
    if (!stands)
        return -1;
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct face *f = &h->faces[i];
        int two_sided = f->light == FACE_LIT && face_is_pair(h->faces, h->face_count, i);
        behind[i] = two_sided ? i + 1 : BLACK_BACK;
        if (two_sided || !face_shades(f))
            continue;
        uint64_t key = 0;
        for (uint32_t j = 0; j < f->vertices; j++)
            key += vector_hash(f->vertex[j]);
        stands[count++] = (struct stand){key, i};
    }
    qsort(stands, count, sizeof *stands, by_key);
    for (uint32_t i = 1; i < count; i++) {
        uint32_t a = stands[i - 1].face, b = stands[i].face;
        if (stands[i].key == stands[i - 1].key && back_to_back(&h->faces[a], &h->faces[b])) {
            behind[a] = b;
            behind[b] = a;
        }
    }
    free(stands);
    return 0;
}
