/* factor_file.c - the matrix of view factors as text, and which format a file has.
 *
 * Rows are written many at a time, each by one thread into a text of its own; the texts go out in
 * order. So the bytes do not depend on the number of threads.
 * [Boisvert, Pozo & Remington 1996, The Matrix Market Exchange Formats; Walton 2002, NISTIR 6925,
 * for View3D; EnergyPlus, Input Output Reference; OpenFOAM, what viewFactorsGen writes]
 * SPDX-License-Identifier: MIT */
#include "output/factor_file.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "output/factor_names.h"
#include "output/factor_npz.h"
#include "output/number_text.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/ends_with.h"
#include "util/report.h"
#include "util/temporary.h"
#include "util/thread_pool.h"

enum { LABEL = 12, TEXT_MOST = 1 << 25 };

struct writer {
    const struct factor_table *table;
    uint32_t count, columns;
    enum factor_format format;
    char **names, *zone; /* energyplus: of rows, and of all */
    struct label {       /* "j," or "j " of each column */
        char text[15];
        unsigned char length;
    } * labels;
    int threads;
    uint32_t batch; /* rows at a time */
    struct factor_reading rows;
    char *text;           /* [batch][room] */
    size_t room, *length; /* [batch] */
};

/* ---- a row as text; each returns how many bytes */

typedef size_t row_text(const struct writer *w, uint32_t i, const double *row, char *text);

static size_t write_dense(const struct writer *w, uint32_t i, const double *row, char *text)
{
    const char between = w->format == FACTOR_CSV ? ',' : ' ';
    char *at = text;
    (void)i;
    for (uint32_t j = 0; j < w->columns; j++) {
        if (j)
            *at++ = between;
        at += number_text(at, row[j]);
    }
    *at++ = '\n';
    return (size_t)(at - text);
}

static size_t write_sparse(const struct writer *w, uint32_t i, const double *row, char *text)
{
    const struct label *own = &w->labels[i];
    char *at = text;
    for (uint32_t j = 0; j < w->columns; j++) {
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

/* FROM,TO,F, for every pair; the last ends the object. */
static size_t write_energyplus(const struct writer *w, uint32_t i, const double *row, char *text)
{
    const size_t length = strlen(w->names[i]);
    char *at = text;
    for (uint32_t j = 0; j < w->columns; j++) {
        const size_t other = strlen(w->names[j]);
        at = memset(at, ' ', 2);
        at = memcpy(at + 2, w->names[i], length);
        at[length] = ',';
        at = memcpy(at + length + 1, w->names[j], other);
        at[other] = ',';
        at += other + 1;
        at += number_text(at, row[j]);
        *at++ = i + 1 == w->count && j + 1 == w->columns ? ';' : ',';
        *at++ = '\n';
    }
    return (size_t)(at - text);
}

/* "3(.2 .1 .7)", of what is not 0. */
static size_t write_foam(const struct writer *w, const double *row, char *text, int faces)
{
    char *at = text + number_text_whole(text, factor_row_entries(w->table, row)), *first = at;
    for (uint32_t j = 0; j < w->columns; j++) {
        if (!(row[j] > 0))
            continue;
        *at++ = ' ';
        at += faces ? number_text_whole(at, j) : number_text(at, row[j]);
    }
    if (at == first)
        at++;
    *first = '(';
    *at++ = ')';
    *at++ = '\n';
    return (size_t)(at - text);
}

static size_t write_foam_factors(const struct writer *w, uint32_t i, const double *row, char *text)
{
    (void)i;
    return write_foam(w, row, text, 0);
}

static size_t write_foam_faces(const struct writer *w, uint32_t i, const double *row, char *text)
{
    (void)i;
    return write_foam(w, row, text, 1);
}

/* Bytes that a row may take: numbers and what stands beside them. */
static size_t row_room(const struct writer *w)
{
    size_t longest = 0, entry = NUMBER_TEXT + 2 * LABEL;
    for (uint32_t r = 0; w->names && r < w->count; r++)
        longest = strlen(w->names[r]) > longest ? strlen(w->names[r]) : longest;
    return (size_t)w->columns * (entry + 2 * longest) + 2 * NUMBER_TEXT;
}

/* ---- all rows */

struct counting {
    const struct writer *writer;
    atomic_ullong *count;
};

static void count_rows(const void *context, size_t from, size_t to)
{
    const struct counting *c = context;
    for (size_t i = from; i < to; i++)
        atomic_fetch_add(c->count,
                         factor_row_entries(c->writer->table,
                                            factor_reading_row(&c->writer->rows, (uint32_t)i)));
}

/* Entries that are not 0. */
static unsigned long long count_entries(const struct writer *w)
{
    atomic_ullong count = 0;
    thread_pool_run(w->threads, w->count, 16, count_rows, &(struct counting){w, &count});
    return atomic_load(&count);
}

struct text_batch {
    const struct writer *writer;
    row_text *write;
    uint32_t first; /* row */
};

static void write_batch(const void *context, size_t from, size_t to)
{
    const struct text_batch *b = context;
    const struct writer *w = b->writer;
    for (size_t k = from; k < to; k++) {
        const uint32_t i = b->first + (uint32_t)k;
        w->length[k] = b->write(w, i, factor_reading_row(&w->rows, i), w->text + k * w->room);
    }
}

static void write_rows(const struct writer *w, row_text *write, FILE *out)
{
    for (uint32_t first = 0; first < w->count; first += w->batch) {
        uint32_t count = w->count - first < w->batch ? w->count - first : w->batch;
        thread_pool_run(w->threads, count, 1, write_batch, &(struct text_batch){w, write, first});
        for (uint32_t k = 0; k < count; k++)
            fwrite(w->text + k * w->room, 1, w->length[k], out);
    }
}

static int open_writer(struct writer *w)
{
    uint32_t n = w->count, columns = w->columns, base = w->format == FACTOR_MTX;
    w->room = row_room(w);
    w->batch = (uint32_t)(TEXT_MOST / w->room);
    if (w->batch < 2 * (uint32_t)w->threads)
        w->batch = 2 * (uint32_t)w->threads;
    if (w->batch > n)
        w->batch = n ? n : 1;
    w->text = malloc(w->batch * w->room);
    w->length = malloc(w->batch * sizeof *w->length);
    w->labels = calloc((size_t)columns + 1, sizeof *w->labels);
    const int failed = factor_reading_open(&w->rows, w->table, w->threads);
    if (failed || !w->text || !w->length || !w->labels)
        return -1;
    for (uint32_t j = 0; j < columns; j++) {
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
    factor_names_free(w->names, w->count);
    free(w->zone);
    factor_reading_close(&w->rows);
    free(w->text);
    free(w->length);
    free(w->labels);
}

/* ---- the formats */

static void write_line(const double *values, uint32_t count, FILE *out)
{
    for (uint32_t r = 0; r < count; r++)
        fprintf(out, r ? " %.12g" : "%.12g", values[r]);
    fputc('\n', out);
}

/* The header has 30 characters and says: format 0; whether all is closed; emissivities are not in
 * the factors. */
static void write_view3d(const struct writer *w, FILE *out)
{
    struct RadExchangeReport report;
    char header[64];
    radGetExchangeReport(w->table->exchange, &report);
    snprintf(header, sizeof header, "View3D 3.3 0 %d 0 %lu",
             !report.rows_open && !report.rows_backs && !report.rows_covered,
             (unsigned long)w->count);
    fprintf(out, "%-30s\n", header);
    write_line(w->table->areas, w->count, out);
    write_rows(w, write_dense, out);
    write_line(w->table->emissivities, w->count, out);
}

static void write_foam_head(const char *type, const char *name, FILE *out)
{
    fprintf(out,
            "FoamFile\n{\n    version     2.0;\n    format      ascii;\n    class       %s;\n"
            "    location    \"constant\";\n    object      %s;\n}\n\n",
            type, name);
}

static void write_foam_file(const struct writer *w, const char *type, const char *name,
                            row_text *write, FILE *out)
{
    write_foam_head(type, name, out);
    fprintf(out, "%lu\n(\n", (unsigned long)w->count);
    write_rows(w, write, out);
    fputs(")\n", out);
}

/* How many faces there are; which of them go to and come from each process, here all of one; that
 * none is turned on its way, and that nothing is transformed. */
static void write_foam_map(const struct writer *w, FILE *out)
{
    write_foam_head("mapDistribute", FACTOR_MAP, out);
    fprintf(out, "%lu\n", (unsigned long)w->count);
    for (int way = 0; way < 2; way++) {
        fprintf(out, "1(\n%lu(", (unsigned long)w->count);
        for (uint32_t i = 0; i < w->count; i++)
            fprintf(out, i ? " %lu" : "%lu", (unsigned long)i);
        fputs(")\n)\n", out);
    }
    fputs("0 0\n\n0()\n0()\n", out);
}

static void write_text(const struct writer *w, FILE *out)
{
    switch (w->format) {
    case FACTOR_VIEW3D:
        write_view3d(w, out);
        break;
    case FACTOR_ENERGYPLUS:
        fprintf(out, "ZoneProperty:UserViewFactors:BySurfaceName,\n  %s,\n", w->zone);
        write_rows(w, write_energyplus, out);
        break;
    case FACTOR_OPENFOAM:
        write_foam_file(w, "scalarListList", "F", write_foam_factors, out);
        break;
    case FACTOR_MTX:
        fprintf(out,
                "%%%%MatrixMarket matrix coordinate real general\n"
                "%% view factors F_ij, row i to column j\n%u %u %llu\n",
                w->count, w->columns, count_entries(w));
        write_rows(w, write_sparse, out);
        break;
    default:
        write_rows(w, w->format == FACTOR_COO ? write_sparse : write_dense, out);
    }
}

/* Returns 0, or -1 after a message. */
static int open_beside(const char *path, const char *what, struct atomic_file *file)
{
    char *name = path_beside(path, what, strlen(what));
    const int status = name ? atomic_open(file, name)
                            : report_error(path, 0, "out of memory for the name of %s", what);
    free(name);
    return status;
}

static int write_files(const struct writer *w, const char *path)
{
    static const char *const beside[] = {NULL, FACTOR_FACES, FACTOR_MAP};
    struct atomic_file files[3] = {{0}};
    const int count = w->format == FACTOR_OPENFOAM ? 3 : 1;
    int status = atomic_open(&files[0], path), opened = !status;
    for (; opened < count && !status; opened += !status)
        status = open_beside(path, beside[opened], &files[opened]);
    if (!status) {
        write_text(w, files[0].stream);
        if (count > 1) {
            write_foam_file(w, "labelListList", FACTOR_FACES, write_foam_faces, files[1].stream);
            write_foam_map(w, files[2].stream);
        }
    }
    temporary_lock(); /* a signal takes all or none */
    for (int i = 0; i < opened; i++)
        if (status)
            atomic_discard(&files[i]);
        else
            status = atomic_commit(&files[i]); /* which finds what fwrite could not write */
    temporary_unlock();
    return status;
}

enum factor_format factor_format_of(const char *path)
{
    return ends_with(path, ".npz")   ? FACTOR_NPZ
           : ends_with(path, ".mtx") ? FACTOR_MTX
           : ends_with(path, ".idf") ? FACTOR_ENERGYPLUS
                                     : FACTOR_CSV;
}

int factor_format_square(enum factor_format format)
{
    return format == FACTOR_VIEW3D || format == FACTOR_ENERGYPLUS || format == FACTOR_OPENFOAM;
}

int factor_file_write(const char *path, enum factor_format format, const struct factor_table *table,
                      int threads)
{
    struct writer w = {.table = table,
                       .count = table->count,
                       .columns = table->columns,
                       .format = format,
                       .threads = threads};
    int status = -1;
    if (format == FACTOR_NPZ)
        return factor_npz_write(path, table, threads);
    if (format == FACTOR_ENERGYPLUS) {
        w.names = factor_names_energyplus(path, table);
        w.zone = factor_name_energyplus(table->title);
        if (!w.names)
            return free(w.zone), -1;
    }
    if (open_writer(&w) < 0 || (w.names && !w.zone))
        report_error(path, 0, "out of memory for the matrix; fewer --threads need less");
    else
        status = write_files(&w, path);
    close_writer(&w);
    return status;
}
