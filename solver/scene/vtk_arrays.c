/* vtk_arrays.c - see vtk_arrays.h.
 *
 * No length that a file tells is believed before so many bytes are there.
 * SPDX-License-Identifier: MIT */
#include "scene/vtk_arrays.h"

#include <stdio.h>
#include <string.h>
#include <zlib.h>

#include "scene/base64.h"
#include "scene/read_numbers.h"
#include "scene/scene_file.h"
#include "util/array.h"
#include "util/report.h"

static int add_value(struct vtk_arrays *a, struct vtk_values *v, double value)
{
    if (!is_finite_float(value))
        return report_error(a->path, v->line,
                            "an array has a number that is not finite; write finite numbers");
    if (array_reserve(&v->at, v->count + 1, &v->capacity, sizeof *v->at))
        return scene_file_no_memory(a->path);
    v->at[v->count++] = value;
    return 0;
}

int vtk_array_add_text(struct vtk_arrays *a, const char *text, size_t size)
{
    if (array_reserve(&a->text, a->size + size + 1, &a->capacity, 1))
        return scene_file_no_memory(a->path);
    memcpy(a->text + a->size, text, size);
    a->size += size;
    a->text[a->size] = '\0'; /* for strtod */
    return 0;
}

static int read_words(struct vtk_arrays *a, struct vtk_values *v)
{
    const char *from = a->text, *const end = a->text + a->size;
    for (;;) {
        while (from < end && (is_blank(*from) || *from == '\n'))
            from++;
        if (from == end)
            return 0;
        char *stop;
        const double value = strtod(from, &stop);
        if (stop == from || !(stop == end || is_blank(*stop) || *stop == '\n')) {
            const char *word_end = from;
            while (word_end < end && !is_blank(*word_end) && *word_end != '\n')
                word_end++;
            return report_error(a->path, v->line,
                                "'%.*s' is not a number in this array; the file is damaged, export "
                                "it again",
                                quoted_length(from, word_end), from);
        }
        if (add_value(a, v, value))
            return -1;
        from = stop;
    }
}

/* ---- blocks */

static int damaged_blocks(const struct vtk_arrays *a, const struct vtk_values *v)
{
    return report_error(a->path, v->line,
                        "the blocks of a compressed array are not what is counted; the file is cut "
                        "or damaged, export it again");
}

/* One of the lengths before the blocks. */
static uint64_t head(const struct vtk_arrays *a, uint64_t i)
{
    return bytes_number(a->text + i * a->header, a->header, a->big_endian);
}

/* What is compressed in a->text becomes plain there, behind its length, as if it had never been.
 * zlib makes at most 1032 bytes of one, so that no count asks for more memory than it may fill. */
static int inflate_blocks(struct vtk_arrays *a, const struct vtk_values *v)
{
    enum { MOST_OF_ONE = 1032 };
    const size_t word = a->header, bytes = a->size;
    const uint64_t count = head(a, 0);
    if (count && (bytes < 3 * word || count > (bytes - 3 * word) / word))
        return damaged_blocks(a, v);
    const uint64_t size = count ? head(a, 1) : 0, last = count ? head(a, 2) : 0;
    /* of no block VTK tells the size all the same, others do not */
    size_t from = count || bytes == 3 * word ? (3 + (size_t)count) * word : word, to = word;
    size_t room = 0;
    char *plain = NULL;
    int result = array_reserve(&plain, word, &room, 1) ? scene_file_no_memory(a->path) : 0;
    for (uint64_t i = 0, taken; i < count && !result; i++, from += taken) {
        const uint64_t wanted = i + 1 == count && last ? last : size;
        taken = head(a, 3 + i);
        uLongf made = (uLongf)wanted;
        if (taken > bytes - from || wanted / MOST_OF_ONE > taken)
            result = damaged_blocks(a, v);
        else if (array_reserve(&plain, to + (size_t)wanted, &room, 1))
            result = scene_file_no_memory(a->path);
        else if (uncompress((Bytef *)plain + to, &made, (const Bytef *)a->text + from, (uLong)taken)
                     != Z_OK
                 || made != wanted)
            result = damaged_blocks(a, v);
        to += (size_t)wanted;
    }
    if (result || from != bytes) {
        free(plain);
        return result ? result : damaged_blocks(a, v);
    }
    for (size_t k = 0; k < word; k++)
        plain[a->big_endian ? word - 1 - k : k] = (char)((uint64_t)(to - word) >> 8 * k & 0xff);
    free(a->text);
    a->text = plain;
    a->capacity = room;
    a->size = to;
    return 0;
}

/* ---- bytes */

/* The bytes in a->text, their length before them. */
static int read_bytes(struct vtk_arrays *a, struct vtk_values *v)
{
    const char *number = strpbrk(a->type, "0123456789");
    const unsigned size = number ? (unsigned)strtoul(number, NULL, 10) / 8 : 0;
    if ((size != 1 && size != 2 && size != 4 && size != 8) || !strchr("FIU", *a->type)
        || (*a->type == 'F' && size < 4))
        return report_error(a->path, v->line, "an array of type '%s'; write Float64 and Int64",
                            a->type);
    if (a->compressed && inflate_blocks(a, v))
        return -1;
    const uint64_t counted = head(a, 0);
    if (counted != a->size - a->header || counted % size)
        return report_error(a->path, v->line,
                            "an array counts %llu bytes of type %s and has %zu; the file is cut or "
                            "damaged, export it again",
                            (unsigned long long)counted, a->type, a->size - a->header);
    for (size_t at = a->header; at < a->size; at += size)
        if (add_value(a, v, typed_number(a->text + at, *a->type, size, a->big_endian)))
            return -1;
    return 0;
}

static int read_base64(struct vtk_arrays *a, struct vtk_values *v)
{
    a->size = from_base64(a->text, a->size);
    return a->size == SIZE_MAX || a->size < a->header
               ? report_error(a->path, v->line,
                              "an array is no base64; the file is cut or damaged, export it again")
               : read_bytes(a, v);
}

/* ---- appended arrays */

static const char *find(const char *from, const char *end, const char *what)
{
    const size_t size = strlen(what);
    while ((from = memchr(from, *what, (size_t)(end - from))) != NULL)
        if ((size_t)(end - from) >= size && memcmp(from, what, size) == 0)
            return from;
        else
            from++;
    return NULL;
}

int vtk_arrays_appended(struct vtk_arrays *a, const char *text, size_t size, size_t *from,
                        size_t *to)
{
    static const char close[] = "</AppendedData";
    const char *const end = text + size, *const tag = find(text, end, "<AppendedData"),
                      *const tag_end = tag ? memchr(tag, '>', (size_t)(end - tag)) : NULL;
    *from = *to = size;
    if (!tag)
        return 0;
    const char *begins = tag_end ? tag_end + 1 : end, *ends = end - (sizeof close - 1);
    while (begins < end && (is_blank(*begins) || *begins == '\n'))
        begins++;
    while (ends > begins && memcmp(ends, close, sizeof close - 1) != 0)
        ends--; /* the last one: bytes before it may look alike */
    if (ends <= begins || *begins != '_')
        return report_error(a->path, 0,
                            "<AppendedData> does not begin with _, or has no end; the file is cut "
                            "or damaged, export it again");
    a->appended = begins + 1;
    a->appended_size = (size_t)(ends - a->appended);
    a->appended_base64 = find(tag, tag_end, "base64") != NULL;
    *from = (size_t)(begins - text);
    *to = (size_t)(ends - text);
    return 0;
}

/* So many bytes of the array, that is more of them, in a->text, from `*at` on. Returns 0, or -1
 * when there are not so many. Lengths and blocks may have been encoded together or each for itself.
 */
static int take_bytes(struct vtk_arrays *a, size_t *at, uint64_t bytes)
{
    while (a->size < bytes) {
        const uint64_t more = bytes - a->size;
        const size_t left = a->appended_size - *at;
        if (more > (a->appended_base64 ? left / 4 * 3 : left))
            return -1;
        const size_t size = a->appended_base64 ? ((size_t)more + 2) / 3 * 4 : (size_t)more,
                     had = a->size;
        if (vtk_array_add_text(a, a->appended + *at, size))
            return -1;
        const size_t got = a->appended_base64 ? from_base64(a->text + had, size) : size;
        if (got == SIZE_MAX || !got)
            return -1;
        a->size = had + got;
        *at += size;
    }
    return 0;
}

static int read_appended(struct vtk_arrays *a, struct vtk_values *v)
{
    const size_t word = a->header;
    int cut = !a->appended || !is_whole(a->offset, (double)a->appended_size + 1);
    size_t at = cut ? 0 : (size_t)a->offset;
    a->size = 0;
    cut = cut || take_bytes(a, &at, word);
    uint64_t bytes = word;
    if (!cut && !a->compressed) {
        const uint64_t counted = head(a, 0);
        cut = counted > a->appended_size || take_bytes(a, &at, bytes += counted);
    } else if (!cut && head(a, 0)) {
        const uint64_t count = head(a, 0);
        cut = count > a->appended_size / word || take_bytes(a, &at, bytes += (2 + count) * word);
        for (uint64_t i = 0; i < count && !cut; i++) {
            const uint64_t taken = head(a, 3 + i);
            bytes += taken;
            cut = taken > a->appended_size || bytes > a->appended_size;
        }
        cut = cut || take_bytes(a, &at, bytes);
    }
    if (cut)
        return report_error(
            a->path, v->line,
            "an appended array of offset %.15g is not all there; the file is cut or "
            "damaged, export it again",
            a->offset);
    a->size = (size_t)bytes; /* of the last letters there may be more */
    return read_bytes(a, v);
}

int vtk_array_read(struct vtk_arrays *a, struct vtk_values *v)
{
    return a->form == VTK_APPENDED ? read_appended(a, v)
           : a->form == VTK_BASE64 ? read_base64(a, v)
                                   : read_words(a, v);
}

void vtk_arrays_free(struct vtk_arrays *a)
{
    free(a->text);
}
