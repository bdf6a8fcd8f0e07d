/* element_names.h - elements by their ways down the tree, as people write them.
 *
 *     12        polygon 12 of the scene, where one face came of it
 *     12.1      the second of the faces that came of it
 *     12b       the far side of a two-sided polygon; 12.1b
 *     12/0/3    of its part 0 the part 3
 *     root/1/0  a cluster
 *
 * Children are counted from 0 in the order of the hierarchy, which is the same in every run.
 * SPDX-License-Identifier: MIT */
#ifndef ELEMENT_NAMES_H
#define ELEMENT_NAMES_H

#include "hierarchy/hierarchy.h"
#include "radiosity.h"

/* Of each face, which of its polygon's faces of the same side it is, from 1; 0: the only one. For
 * free(); NULL: out of memory. */
uint32_t *element_names_parts(const struct face *faces, uint32_t count);

/* Returns 0, or -1: no room. */
int element_name(char *name, size_t size, const struct hierarchy *h, const uint32_t *parts,
                 uint32_t element);

/* Returns 0, or -1 and in `cause` a sentence about what there is. */
int element_find(uint32_t *element, const struct hierarchy *h, const uint32_t *parts,
                 const char *name, char *cause, size_t size);

#endif
