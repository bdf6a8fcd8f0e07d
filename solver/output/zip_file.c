/* zip_file.c - see zip_file.h.
 * SPDX-License-Identifier: MIT */
#define _FILE_OFFSET_BITS 64
#include "output/zip_file.h"

#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <zlib.h>

enum {
    LOCAL = 30, /* bytes of a file's header, of which the checksum is from 14 on */
    CRC_AT = 14,
    CENTRAL = 46,    /* of its entry in the list at the end */
    WIDE_EXTRA = 20, /* of a header whose sizes take 8 bytes */
    VERSION = 20,
    VERSION_WIDE = 45,
    DATE = 33 /* 1 January 1980: files with the same matrix are the same */
};
static const uint64_t WIDE = 0xffffffff; /* what says: it stands where Zip64 has it */

static size_t put(unsigned char *to, size_t at, uint64_t value, size_t size)
{
    for (size_t i = 0; i < size; i++)
        to[at + i] = (unsigned char)(value >> (8 * i));
    return at + size;
}

static uint64_t narrow(uint64_t value)
{
    return value < WIDE ? value : WIDE;
}

static void write_bytes(struct zip_file *z, const void *bytes, size_t size)
{
    z->failed |= fwrite(bytes, 1, size, z->stream) != size;
}

/* What a header and the list both say of a file, from its version on. */
static size_t put_common(unsigned char *to, size_t at, const struct zip_entry *e, size_t extra)
{
    at = put(to, at, e->size >= WIDE ? VERSION_WIDE : VERSION, 2);
    at = put(to, at, 0, 2); /* flags */
    at = put(to, at, 0, 2); /* stored */
    at = put(to, at, 0, 2); /* midnight */
    at = put(to, at, DATE, 2);
    at = put(to, at, e->crc, 4);
    at = put(to, at, narrow(e->size), 4); /* as stored, and as it is */
    at = put(to, at, narrow(e->size), 4);
    at = put(to, at, strlen(e->name), 2);
    return put(to, at, extra, 2);
}

static void end_last(struct zip_file *z)
{
    if (!z->count || z->failed)
        return;
    unsigned char crc[4];
    const struct zip_entry *e = &z->entries[z->count - 1];
    put(crc, 0, e->crc, sizeof crc);
    z->failed |= fseeko(z->stream, (off_t)(e->at + CRC_AT), SEEK_SET) != 0;
    write_bytes(z, crc, sizeof crc);
    z->failed |= fseeko(z->stream, 0, SEEK_END) != 0;
}

static uint64_t here(struct zip_file *z)
{
    const off_t at = ftello(z->stream);
    z->failed |= at < 0;
    return at < 0 ? 0 : (uint64_t)at;
}

void zip_begin(struct zip_file *z, const char *name, uint64_t size)
{
    end_last(z);
    struct zip_entry *e = &z->entries[z->count++];
    *e = (struct zip_entry){.size = size, .at = here(z), .crc = (uint32_t)crc32(0, NULL, 0)};
    snprintf(e->name, sizeof e->name, "%s", name);
    unsigned char header[LOCAL], extra[WIDE_EXTRA];
    put(header, 0, 0x04034b50, 4);
    put_common(header, 4, e, size >= WIDE ? sizeof extra : 0);
    write_bytes(z, header, sizeof header);
    write_bytes(z, e->name, strlen(e->name));
    if (size >= WIDE) {
        size_t at = put(extra, 0, 1, 2);
        at = put(extra, at, 16, 2);
        put(extra, put(extra, at, size, 8), size, 8);
        write_bytes(z, extra, sizeof extra);
    }
}

void zip_write(struct zip_file *z, const void *bytes, size_t size)
{
    struct zip_entry *e = &z->entries[z->count - 1];
    e->crc = (uint32_t)crc32_z(e->crc, bytes, size);
    write_bytes(z, bytes, size);
}

static void write_central(struct zip_file *z, const struct zip_entry *e)
{
    unsigned char entry[CENTRAL] = {0}, extra[WIDE_EXTRA + 8];
    const int wide = e->size >= WIDE || e->at >= WIDE;
    size_t length = 0;
    if (wide) {
        length = put(extra, 4, 0, 0);
        if (e->size >= WIDE)
            length = put(extra, put(extra, length, e->size, 8), e->size, 8);
        if (e->at >= WIDE)
            length = put(extra, length, e->at, 8);
        put(extra, put(extra, 0, 1, 2), length - 4, 2);
    }
    put(entry, 0, 0x02014b50, 4);
    put(entry, 4, wide ? VERSION_WIDE : VERSION, 2);
    put_common(entry, 6, e, length);
    put(entry, CENTRAL - 4, narrow(e->at), 4);
    write_bytes(z, entry, sizeof entry);
    write_bytes(z, e->name, strlen(e->name));
    write_bytes(z, extra, length);
}

int zip_end(struct zip_file *z)
{
    end_last(z);
    const uint64_t first = here(z);
    for (int i = 0; i < z->count; i++)
        write_central(z, &z->entries[i]);
    const uint64_t end = here(z), count = (uint64_t)z->count;
    if (first >= WIDE) { /* where the list is, and where that is said */
        unsigned char wide[56] = {0}, where[20] = {0};
        put(wide, 0, 0x06064b50, 4);
        put(wide, 4, sizeof wide - 12, 8);
        put(wide, put(wide, 12, VERSION_WIDE, 2), VERSION_WIDE, 2);
        put(wide, put(wide, 24, count, 8), count, 8);
        put(wide, put(wide, 40, end - first, 8), first, 8);
        put(where, 0, 0x07064b50, 4);
        put(where, 8, end, 8);
        put(where, 16, 1, 4);
        write_bytes(z, wide, sizeof wide);
        write_bytes(z, where, sizeof where);
    }
    unsigned char last[22] = {0};
    put(last, 0, 0x06054b50, 4);
    put(last, put(last, 8, count, 2), count, 2);
    put(last, put(last, 12, end - first, 4), narrow(first), 4);
    write_bytes(z, last, sizeof last);
    return z->failed ? -1 : 0;
}
