/* read_alike.h - that several processes have read the same, of files that each may have of its own.
 *
 * They would go on with different numbers, and end with wrong ones, or wait for each other.
 * SPDX-License-Identifier: MIT */
#ifndef READ_ALIKE_H
#define READ_ALIKE_H

#include "util/machines.h"
#include "util/report.h"

/* hash: of what was read (hash_bytes). Waits for all. Returns 0, or -1 after a message. */
static inline int read_alike(const char *path, uint64_t hash)
{
    if (machines_alike(hash))
        return 0;
    return report_error(path, 0,
                        "the processes have read different files of this name; give all of them "
                        "the same, and what belongs to it");
}

#endif
