/* factor_file.c - the matrix of view factors as text.
 *
 * Rows are written many at a time, each by one thread into a text of its own; the texts go out in
 * order. So the bytes do not depend on the number of threads.
 * [Boisvert, Pozo & Remington 1996, The Matrix Market Exchange Formats]
 * SPDX-License-Identifier: MIT */
#include "output/factor_file.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "output/number_text.h"
#include "util/atomic_file.h"
#include "util/fold.h"
#include "util/report.h"

enum { ENTRY = 2 * (NUMBER_TEXT / 2) + NUMBER_TEXT, TEXT_MOST = 1 << 25 };

struct writer {
    RadExchange exchange;
    uint32_t polygons, count; /* of the matrix, copies and all; rows and columns written */
    enum factor_format format;
    struct label { /* "j," or "j " of each column */
        char text[15];
        unsigned char length;
    } * labels;
    int threads;
    uint32_t batch;       /* rows at a time */
    double *rows;         /* [threads][polygons] */
    char *text;           /* [batch][room] */
    size_t room, *length; /* [batch] */
};

static size_t write_dense(const double *row, uint32_t n, char *text)
{
    char *at = text;
    for (uint32_t j = 0; j < n; j++) {
        if (j)
            *at++ = ',';
        at += number_text(at, row[j]);
    }
    *at++ = '\n';
    return (size_t)(at - text);
}

static size_t write_sparse(const struct writer *w, uint32_t i, const double *row, char *text)
{
    const struct label *own = &w->labels[i];
    char *at = text;
    for (uint32_t j = 0; j < w->count; j++) {
        if (!(row[j] > 0))
            continue;
        memcpy(at, own->text, sizeof own->text);
        at += own->length;
        memcpy(at, w->labels[j].text, sizeof own->text);
        at += w->labels[j].length;
        at += number_text(at, row[j]);
        *at++ = '\n';
    }
    return (size_t)(at - text);
}

/* Row i of the matrix, in the thread's own place. */
static const double *row_of(const struct writer *w, uint32_t i)
{
    double *row = &w->rows[(size_t)omp_get_thread_num() * w->polygons];
    (void)radGetExchangeRow(w->exchange, i, row);
    fold_row(row, w->polygons, w->count);
    return row;
}

static void write_row(const struct writer *w, uint32_t i, uint32_t slot)
{
    const double *row = row_of(w, i);
    char *text = w->text + slot * w->room;
    w->length[slot] =
        w->format == FACTOR_CSV ? write_dense(row, w->count, text) : write_sparse(w, i, row, text);
}

/* Entries that are not 0. */
static uint64_t count_entries(const struct writer *w)
{
    uint64_t count = 0;
#pragma omp parallel for schedule(dynamic, 16) num_threads(w->threads) reduction(+ : count)
    for (uint32_t i = 0; i < w->count; i++) {
        const double *row = row_of(w, i);
        for (uint32_t j = 0; j < w->count; j++)
            count += row[j] > 0;
    }
    return count;
}

static int open_writer(struct writer *w)
{
    uint32_t n = w->count, base = w->format == FACTOR_MTX;
    w->room = (size_t)n * ENTRY + NUMBER_TEXT;
    w->batch = (uint32_t)(TEXT_MOST / w->room);
    if (w->batch < 2 * (uint32_t)w->threads)
        w->batch = 2 * (uint32_t)w->threads;
    if (w->batch > n)
        w->batch = n ? n : 1;
    w->text = malloc(w->batch * w->room);
    w->length = malloc(w->batch * sizeof *w->length);
    w->labels = calloc((size_t)n + 1, sizeof *w->labels);
    w->rows = malloc(((size_t)w->threads * w->polygons + 1) * sizeof *w->rows);
    if (!w->text || !w->length || !w->labels || !w->rows)
        return -1;
    for (uint32_t j = 0; j < n; j++) {
        char text[NUMBER_TEXT];
        int length = number_text_whole(text, j + base);
        memcpy(w->labels[j].text, text, (size_t)length);
        w->labels[j].text[length] = w->format == FACTOR_MTX ? ' ' : ',';
        w->labels[j].length = (unsigned char)(length + 1);
    }
    return 0;
}

static void close_writer(struct writer *w)
{
    free(w->rows);
    free(w->text);
    free(w->length);
    free(w->labels);
}

static void write_matrix(const struct writer *w, FILE *out)
{
    if (w->format == FACTOR_MTX)
        fprintf(out,
                "%%%%MatrixMarket matrix coordinate real general\n"
                "%% view factors F_ij, row i to column j\n%u %u %llu\n",
                w->count, w->count, (unsigned long long)count_entries(w));
    for (uint32_t first = 0; first < w->count; first += w->batch) {
        uint32_t count = w->count - first < w->batch ? w->count - first : w->batch;
#pragma omp parallel for schedule(dynamic, 1) num_threads(w->threads)
        for (uint32_t k = 0; k < count; k++)
            write_row(w, first + k, k);
        for (uint32_t k = 0; k < count; k++)
            fwrite(w->text + k * w->room, 1, w->length[k], out);
    }
}

int factor_file_write(const char *path, enum factor_format format, RadExchange exchange,
                      uint32_t polygons, uint32_t rows, int threads)
{
    struct writer w = {.exchange = exchange,
                       .polygons = polygons,
                       .count = rows,
                       .format = format,
                       .threads = threads};
    struct atomic_file file = {0};
    int status = -1;
    if (open_writer(&w) < 0) {
        report_error(path, 0, "out of memory for the matrix; fewer --threads need less");
    } else if (atomic_open(&file, path) == 0) {
        write_matrix(&w, file.stream);
        status = atomic_commit(&file); /* which finds what fwrite could not write */
    }
    close_writer(&w);
    return status;
}

int factor_file_names(const char *path, const struct surfaces *surfaces)
{
    struct atomic_file file = {0};
    if (atomic_open(&file, path) < 0)
        return -1;
    for (uint32_t i = 0; i < surfaces->polygon_count; i++) {
        const char *name = surfaces->material_names[surfaces->polygon_materials[i]];
        for (; *name; name++)
            fputc((unsigned char)*name < ' ' ? ' ' : *name, file.stream);
        fprintf(file.stream, ".%u\n", i);
    }
    return atomic_commit(&file);
}
