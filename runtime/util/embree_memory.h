/* embree_memory.h - is there memory enough for Embree to build something?
 *
 * Where it ends, Embree's threads throw while others still work, and the process is aborted. So it
 * is asked for at once before, in one piece that is given back untouched. Where the system promises
 * more than it has, this finds nothing, as nothing could.
 * SPDX-License-Identifier: MIT */
#ifndef EMBREE_MEMORY_H
#define EMBREE_MEMORY_H

#include <stdlib.h>

/* Bytes, and bytes for each primitive. Measured by VmPeak in /proc/self/status around
 * rtcCommitScene at high quality: 11 MB for 1,000 quadrilaterals; 160 MB for 400,000, the 128 MB
 * among them which glibc reserves for a thread and does without. */
#define EMBREE_ROOM ((size_t)32 << 20)
#define EMBREE_ROOM_EACH ((size_t)512)

static inline int embree_has_memory(size_t primitives)
{
    void *volatile room = malloc(EMBREE_ROOM + EMBREE_ROOM_EACH * primitives);
    free(room);
    return room != NULL;
}

#endif
