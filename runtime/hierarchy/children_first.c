/* children_first.c - see children_first.h.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/children_first.h"
#include "util/thread_pool.h"

struct climb {
    const struct hierarchy *h;
    const uint32_t *face; /* NULL: all */
    children_first_work *work;
    const void *context;
};

static void climb_from(const struct climb *c, uint32_t e)
{
    const struct element *at = &c->h->elements[e];
    for (uint32_t j = at->child + at->children; j-- > at->child;)
        climb_from(c, j);
    c->work(c->context, e);
}

static void climb_faces(const void *climb, size_t from, size_t to)
{
    const struct climb *c = climb;
    for (size_t i = from; i < to; i++)
        climb_from(c, c->h->face_element[c->face ? c->face[i] : i]);
}

void children_first_clusters(const struct hierarchy *h, children_first_work *work,
                             const void *context)
{
    for (uint32_t e = h->built; e-- > 0;) /* children follow their parents */
        if (!h->elements[e].vertices)
            work(context, e);
}

void children_first_of(const struct hierarchy *h, int threads, const uint32_t *face, uint32_t count,
                       children_first_work *work, const void *context)
{
    const struct climb c = {h, face, work, context};
    thread_pool_run(threads, count, 16, climb_faces, &c);
    children_first_clusters(h, work, context);
}

void children_first(const struct hierarchy *h, int threads, children_first_work *work,
                    const void *context)
{
    children_first_of(h, threads, NULL, h->face_count, work, context);
}
