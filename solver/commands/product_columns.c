/* product_columns.c - see product_columns.h.
 * SPDX-License-Identifier: MIT */
#include "commands/product_columns.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/number_text.h"
#include "scene/read_numbers.h"
#include "util/array.h"
#include "util/atomic_file.h"
#include "util/device.h"
#include "util/machines.h"
#include "util/text_file.h"

enum { COLUMNS_MOST = 4096 };

void columns_free(struct columns *c)
{
    free(c->text);
    free(c->x);
    *c = (struct columns){0};
}

static int read_row(struct columns *c, const char *path, struct text_lines *t)
{
    double value[COLUMNS_MOST];
    int n = read_numbers(t, path, "a column", COLUMNS_MOST, value);
    if (n < 0)
        return -1;
    if (n > COLUMNS_MOST)
        return report_error(path, t->number, "%d columns; write at most %d", n, COLUMNS_MOST);
    if (c->rows == 0)
        c->count = (uint32_t)n;
    if ((uint32_t)n != c->count)
        return report_error(path, t->number,
                            "%d numbers, but %u in the lines before; write one "
                            "for each column",
                            n, (unsigned)c->count);
    if (array_reserve(&c->x, c->rows + 1, &c->capacity, c->count * sizeof *c->x) < 0)
        return scene_file_no_memory(path);
    memcpy(c->x + c->rows++ * c->count, value, c->count * sizeof *value);
    return 0;
}

/* Commas to blanks. Returns 0, or -1 after a message: of `1,,2` a blank would make two columns. */
static int part_cells(const char *path, struct text_lines *t)
{
    int filled = 0, parted = 0;
    for (char *at = t->line; at <= t->line_end; at++) {
        const int end = at == t->line_end || *at == '#', comma = !end && *at == ',';
        if ((comma || (end && parted)) && !filled)
            return report_error(path, t->number, "an empty cell; write a number between commas");
        if (end)
            break;
        if (comma)
            *at = ' ';
        parted |= comma;
        filled = !comma && (filled || !is_blank(*at));
    }
    return 0;
}

/* A line that does not begin with a number; a comma ends one, too. */
static int is_head(const struct text_lines *t)
{
    struct text_lines ahead = *t;
    double x;
    if (!next_word(&ahead))
        return 0;
    const char *comma = memchr(ahead.word, ',', (size_t)(ahead.word_end - ahead.word));
    if (comma)
        ahead.word_end = ahead.word + (comma - ahead.word);
    return !word_number(&ahead, &x);
}

int columns_read(struct columns *c, const char *path, uint32_t faces)
{
    size_t size;
    int lines = 0;
    *c = (struct columns){.text = text_file_need(path, &size)};
    if (!c->text)
        return -1;
    struct text_lines t = text_lines(c->text, size);
    while (next_line(&t)) {
        struct text_lines ahead = t;
        if (!next_word(&ahead))
            continue;
        if (lines++ == 0 && is_head(&t)) {
            c->head = t.line;
            *t.line_end = 0;
            continue;
        }
        if (part_cells(path, &t) < 0 || read_row(c, path, &t) < 0)
            return -1;
    }
    if (c->rows == faces)
        return 0;
    return report_error(path, 0,
                        "%zu lines of numbers, but the scene has %u faces; write one for "
                        "each, in the scene file's order",
                        c->rows, (unsigned)faces);
}

static int write_rows(const struct columns *c, const char *path, const double *y)
{
    struct atomic_file file = {0};
    if (atomic_open(&file, path) < 0)
        return -1;
    if (c->head)
        fprintf(file.stream, "%s\n", c->head);
    for (size_t k = 0; k < c->rows * c->count; k++) {
        char text[NUMBER_TEXT];
        int length = number_text(text, y[k]);
        fwrite(text, 1, (size_t)length, file.stream);
        fputc((k + 1) % c->count ? ',' : '\n', file.stream);
    }
    return atomic_commit(&file);
}

int columns_write_product(const struct columns *c, const char *path, RadExchange exchange,
                          const struct open_scene *scene)
{
    const size_t size = c->rows * c->count, all = (size_t)scene->report.polygons * c->count;
    double *x = malloc((all + size + 1) * sizeof *x);
    if (!x)
        return scene_file_no_memory(path);
    double *y = x + all;
    for (size_t k = 0; k < all; k++) /* what is sent by a copy is what its original sends */
        x[k] = c->x[k % size];
    int status = radMultiplyExchange(exchange, c->count, x, y);
    if (status < 0)
        (void)report_device(scene->device, path);
    else if (machines_number() == 0)
        status = write_rows(c, path, y);
    free(x);
    return status;
}
