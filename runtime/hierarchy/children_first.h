/* children_first.h - a step up the hierarchy: every element once, after its children.
 *
 * Faces, with their parts below them, are shared by threads; clusters follow in the order of their
 * indices, last to first. What an element comes to does not depend on the number of threads as long
 * as the step changes nothing but the element's own, by its children's.
 * SPDX-License-Identifier: MIT */
#ifndef CHILDREN_FIRST_H
#define CHILDREN_FIRST_H

#include "hierarchy/hierarchy.h"

typedef void children_first_work(const void *context, uint32_t element);

void children_first(const struct hierarchy *h, int threads, children_first_work *work,
                    const void *context);
/* The same of some faces alone, where nothing has changed below the others; then clusters. */
void children_first_of(const struct hierarchy *h, int threads, const uint32_t *face, uint32_t count,
                       children_first_work *work, const void *context);
/* The part of it that comes last: clusters. */
void children_first_clusters(const struct hierarchy *h, children_first_work *work,
                             const void *context);

#endif
