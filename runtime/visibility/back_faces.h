/* back_faces.h - what a ray meets that comes from behind a face.
 * SPDX-License-Identifier: MIT */
#ifndef BACK_FACES_H
#define BACK_FACES_H

#include "hierarchy/hierarchy.h"

#define BLACK_BACK UINT32_MAX

/* behind[face_count]: for each face that is not itself a far side: its far side, or the face that
 * stands at the same place with its front the other way, or BLACK_BACK. Returns 0, or -1 when out
 * of memory. */
int back_faces_find(const struct hierarchy *h, uint32_t *behind);

#endif
