/* zip_file.h - a zip archive of stored files, whose sizes are known before their bytes are.
 *
 * Each file's checksum is written over its header when its bytes are there, so that readers of
 * headers alone find it. Sizes from 4 GB on are written as Zip64 has them, and only those.
 * [PKWARE, APPNOTE.TXT 6.3.9]
 * SPDX-License-Identifier: MIT */
#ifndef ZIP_FILE_H
#define ZIP_FILE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { ZIP_FILES = 8, ZIP_NAME = 32 };

struct zip_file {
    FILE *stream; /* which can be positioned */
    struct zip_entry {
        char name[ZIP_NAME];
        uint64_t size, at; /* of its header */
        uint32_t crc;
    } entries[ZIP_FILES];
    int count, failed;
};

/* A file of `size` bytes begins; the last one ends. */
void zip_begin(struct zip_file *zip, const char *name, uint64_t size);
void zip_write(struct zip_file *zip, const void *bytes, size_t size);
/* Returns 0, or -1 when the stream cannot be written or positioned. */
int zip_end(struct zip_file *zip);

#endif
