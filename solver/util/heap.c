/* heap.c - see heap.h.
 * SPDX-License-Identifier: MIT */
#include "util/heap.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

void heap_settle(void)
{
#ifdef __GLIBC__
    enum { ARRAYS = 1 << 16, LARGE = 1 << 25 }; /* LARGE: glibc takes no more */
    mallopt(M_MMAP_MAX, ARRAYS);
    mallopt(M_MMAP_THRESHOLD, LARGE);
    mallopt(M_TRIM_THRESHOLD, 2 * LARGE);
#endif
}
