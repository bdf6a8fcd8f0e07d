/* hash_bytes.h - a number of 64 bits that tells one piece of data from another.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_HASH_BYTES_H
#define KERNEL_HASH_BYTES_H

#include <stddef.h>
#include <string.h>
#include "kernel/hash.h"

/* Of so many bytes, behind another hash. */
static inline uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *at = (const unsigned char *)bytes;
    for (; size >= 8; size -= 8, at += 8) {
        uint64_t word;
        memcpy(&word, at, 8);
        hash = hash64(hash + HASH_STEP + word);
    }
    for (; size > 0; size--)
        hash = hash64(hash + HASH_STEP + *at++);
    return hash;
}

#endif
