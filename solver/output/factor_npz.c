/* factor_npz.c - see factor_npz.h.
 *
 * Rows are computed three times, for how many entries they have, for columns, and for values: as
 * many numbers as a large matrix has are not kept in memory once more.
 * SPDX-License-Identifier: MIT */
#include "output/factor_npz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/zip_file.h"
#include "util/atomic_file.h"
#include "util/report.h"
#include "util/thread_pool.h"

enum { HEADER = 128, MOST = 1 << 25 };

struct npz {
    const struct factor_table *table;
    struct zip_file zip;
    int threads;
    struct factor_reading rows;
    uint64_t *first; /* [count + 1]: entries before each row */
    uint32_t batch;  /* rows at a time */
    char *packed;    /* [batch][columns] values or columns */
};

/* An array begins: its header, of 128 bytes, in words of Python's. */
static void begin_array(struct npz *p, const char *name, const char *type, const char *shape,
                        uint64_t bytes)
{
    char header[HEADER + 1];
    memset(header, ' ', sizeof header);
    memcpy(header, "\x93NUMPY\x01\x00", 8);
    header[8] = HEADER - 10;
    header[9] = 0;
    int n = snprintf(header + 10, HEADER - 10,
                     "{'descr': '%s', 'fortran_order': False, 'shape': %s, }", type, shape);
    header[10 + n] = ' ';
    header[HEADER - 1] = '\n';
    zip_begin(&p->zip, name, HEADER + bytes);
    zip_write(&p->zip, header, HEADER);
}

/* Numbers of a machine of the other kind go the other way round. */
static const char *type_of(char kind, int size, char type[8])
{
    const uint16_t one = 1;
    snprintf(type, 8, "%c%c%d", *(const unsigned char *)&one ? '<' : '>', kind, size);
    return type;
}

static void write_array(struct npz *p, const char *name, char kind, int size, const void *values,
                        uint64_t count)
{
    char type[8], shape[32];
    snprintf(shape, sizeof shape, "(%llu,)", (unsigned long long)count);
    begin_array(p, name, type_of(kind, size, type), shape, count * (uint64_t)size);
    zip_write(&p->zip, values, (size_t)count * (size_t)size);
}

static void write_names(struct npz *p)
{
    const struct factor_table *t = p->table;
    size_t longest = 1;
    for (uint32_t r = 0; r < t->count; r++)
        longest = strlen(t->names[r]) > longest ? strlen(t->names[r]) : longest;
    char type[32], shape[32], *name = calloc(longest + 1, 1);
    snprintf(type, sizeof type, "|S%zu", longest);
    snprintf(shape, sizeof shape, "(%lu,)", (unsigned long)t->count);
    begin_array(p, "names.npy", type, shape, (uint64_t)longest * t->count);
    p->zip.failed |= !name;
    for (uint32_t r = 0; r < t->count && name; r++) {
        strncpy(name, t->names[r], longest);
        zip_write(&p->zip, name, longest);
    }
    free(name);
}

static void count_rows(const void *context, size_t from, size_t to)
{
    const struct npz *p = context;
    for (size_t r = from; r < to; r++)
        p->first[r + 1] = factor_row_entries(p->table, factor_reading_row(&p->rows, (uint32_t)r));
}

static void count_entries(struct npz *p)
{
    const uint32_t n = p->table->count;
    thread_pool_run(p->threads, n, 16, count_rows, p);
    for (uint32_t r = 0; r < n; r++)
        p->first[r + 1] += p->first[r];
}

/* A row's values, or else its columns, in so many bytes each, at their place in the batch. */
static void pack_row(const struct npz *p, uint32_t r, size_t size, int values, char *to)
{
    const double *row = factor_reading_row(&p->rows, r);
    for (uint32_t j = 0; j < p->table->columns; j++) {
        if (!(row[j] > 0))
            continue;
        const int64_t wide = j;
        const int32_t column = (int32_t)j;
        memcpy(to,
               values      ? (const void *)&row[j]
               : size == 8 ? (const void *)&wide
                           : &column,
               size);
        to += size;
    }
}

struct packing {
    const struct npz *npz;
    uint32_t first; /* row of the batch */
    size_t size;
    int values;
};

static void pack_rows(const void *context, size_t from, size_t to)
{
    const struct packing *k = context;
    const struct npz *p = k->npz;
    for (size_t r = k->first + from; r < k->first + to; r++)
        pack_row(p, (uint32_t)r, k->size, k->values,
                 p->packed + (p->first[r] - p->first[k->first]) * k->size);
}

static void write_entries(struct npz *p, size_t size, int values)
{
    const uint32_t n = p->table->count;
    for (uint32_t first = 0; first < n; first += p->batch) {
        const uint32_t end = n - first < p->batch ? n : first + p->batch;
        thread_pool_run(p->threads, end - first, 1, pack_rows,
                        &(struct packing){p, first, size, values});
        zip_write(&p->zip, p->packed, (size_t)(p->first[end] - p->first[first]) * size);
    }
}

/* Indices in 4 bytes where that does, as SciPy has them. */
static void write_pointers(struct npz *p, int size)
{
    const uint32_t n = p->table->count;
    char type[8], shape[32];
    snprintf(shape, sizeof shape, "(%llu,)", (unsigned long long)n + 1);
    begin_array(p, "indptr.npy", type_of('i', size, type), shape,
                (uint64_t)size * ((uint64_t)n + 1));
    for (size_t r = 0; r <= n; r++) {
        const int64_t wide = (int64_t)p->first[r];
        const int32_t narrow = (int32_t)wide;
        zip_write(&p->zip, size == 8 ? (const void *)&wide : &narrow, (size_t)size);
    }
}

static void write_arrays(struct npz *p)
{
    const struct factor_table *t = p->table;
    const int64_t shape[2] = {t->count, t->columns};
    char type[8], count[32];
    count_entries(p);
    const uint64_t entries = p->first[t->count];
    const int size = entries > INT32_MAX ? 8 : 4;
    snprintf(count, sizeof count, "(%llu,)", (unsigned long long)entries);
    begin_array(p, "format.npy", "|S3", "()", 3);
    zip_write(&p->zip, "csr", 3);
    write_array(p, "shape.npy", 'i', 8, shape, 2);
    write_pointers(p, size);
    begin_array(p, "indices.npy", type_of('i', size, type), count, entries * (uint64_t)size);
    write_entries(p, (size_t)size, 0);
    begin_array(p, "data.npy", type_of('f', 8, type), count, entries * 8);
    write_entries(p, 8, 1);
    write_array(p, "areas.npy", 'f', 8, t->areas, t->count);
    write_names(p);
}

static int write_file(struct npz *p, const char *path)
{
    struct atomic_file file = {0};
    if (atomic_open(&file, path) < 0)
        return -1;
    if (!file.temporary) {
        atomic_discard(&file);
        return report_error(path, 0, "an archive cannot go to a pipe or a device; give a file");
    }
    p->zip.stream = file.stream;
    write_arrays(p);
    if (zip_end(&p->zip) && !ferror(file.stream)) { /* else atomic_commit tells */
        atomic_discard(&file);
        return report_error(path, 0,
                            "cannot write the archive: out of memory, or no way back in "
                            "the file; write another format");
    }
    return atomic_commit(&file);
}

int factor_npz_write(const char *path, const struct factor_table *table, int threads)
{
    const uint32_t n = table->count;
    const size_t row = 8 * ((size_t)table->columns + 1);
    struct npz p = {.table = table, .threads = threads};
    p.batch = (uint32_t)(MOST / row) > 2 * (uint32_t)threads ? (uint32_t)(MOST / row)
                                                             : 2 * (uint32_t)threads;
    p.batch = p.batch > n ? n + 1 : p.batch;
    p.packed = malloc(p.batch * row);
    const int failed = factor_reading_open(&p.rows, table, threads);
    p.first = calloc((size_t)n + 1, sizeof *p.first);
    int status =
        p.packed && !failed && p.first
            ? write_file(&p, path)
            : report_error(path, 0, "out of memory for the matrix; fewer --threads need less");
    free(p.packed);
    factor_reading_close(&p.rows);
    free(p.first);
    return status;
}
