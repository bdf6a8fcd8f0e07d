/* solve_contact.c - which share of each element no solid stands on: of leaves by rays, of all above
 * them the mean.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/solve.h"
#include "hierarchy/children_first.h"
#include "util/ranks_loop.h"
#include "util/thread_pool.h"
#include "visibility/contact_fraction.h"

/* New elements, so many from a first one on. */
struct contacts {
    const struct hierarchy *h;
    const struct rays *rays;
    double *uncovered; /* [element] */
    uint32_t first;    /* the first of them */
    int known;         /* those of 1 */
    double *kept;      /* [face]: of whole faces, or NAN; NULL: none is kept */
};

/* Is it known of this element from another solution? */
static int is_kept(const struct contacts *c, const struct element *e)
{
    return c->kept && e->depth == 0 && !isnan(c->kept[e->face]);
}

static void measure_leaves(const void *contacts, size_t from, size_t to)
{
    const struct contacts *c = contacts;
    for (size_t i = c->first + from; i < c->first + to; i++) {
        const struct element *e = &c->h->elements[i];
        if (!e->vertices || e->children || (c->known && c->uncovered[i] >= 1))
            continue;
        c->uncovered[i] = is_kept(c, e) ? c->kept[e->face]
                          : c->h->faces[e->face].light == FACE_DARK
                              ? 0
                              : 1 - contact_fraction(c->rays, c->h, e);
    }
}

static void keep_faces(const struct contacts *c)
{
    const struct hierarchy *h = c->h;
    for (uint32_t i = 0; c->kept && i < h->face_count; i++) {
        const uint32_t element = h->face_element[i];
        if (element >= c->first && !h->elements[element].children)
            c->kept[i] = c->uncovered[element];
    }
}

static void measure_parent(const void *contacts, uint32_t i)
{
    const struct contacts *c = contacts;
    const struct element *elements = c->h->elements, *e = &elements[i];
    double sum = 0;
    for (uint32_t j = e->child; j < e->child + e->children; j++)
        sum += c->uncovered[j] * elements[j].area / e->area;
    if (e->children)
        c->uncovered[i] = sum;
}

/* Of new elements, and of what they are parts of: a pass makes few, and all others stay as they
 * are. Without memory for a list, of all. */
static void measure_parents(const struct contacts *c, int threads)
{
    const struct hierarchy *h = c->h;
    uint32_t count = 0, *face = c->first ? malloc(h->face_count * sizeof *face) : NULL;
    unsigned char *listed = face ? calloc(h->face_count, sizeof *listed) : NULL;
    for (uint32_t i = c->first; listed && i < h->count; i++) {
        const uint32_t f = h->elements[i].face;
        if (!listed[f])
            face[count++] = f;
        listed[f] = 1;
    }
    if (listed)
        children_first_of(h, threads, face, count, measure_parent, c);
    else
        children_first(h, threads, measure_parent, c);
    free(listed);
    free(face);
}

void solve_measure_contact(struct solve *s, uint32_t first, int known)
{
    const struct hierarchy *h = &s->hierarchy;
    const struct problem *p = &s->problem;
    double *uncovered = s->operator.uncovered;
    const struct handed_on *handed = p->options.handed_on;
    const struct contacts contacts = {h,     p->rays, uncovered,
                                      first, known,   handed ? handed->uncovered : NULL};
    if (s->quarters.common) /* here each rank has others */
        thread_pool_run(p->options.threads, h->count - first, 64, measure_leaves, &contacts);
    else
        ranks_loop_run(p->options.ranks, RANKS_VALUES, p->options.threads, h->count - first, 64,
                       measure_leaves, &contacts, uncovered + first, sizeof *uncovered);
    keep_faces(&contacts);
    measure_parents(&contacts, p->options.threads);
}

void solve_average_contact(struct solve *s, uint32_t count)
{
    const struct contacts contacts = {.h = &s->hierarchy, .uncovered = s->operator.uncovered };
    for (uint32_t i = count; i-- > 0;) /* children follow their parents */
        measure_parent(&contacts, i);
}
