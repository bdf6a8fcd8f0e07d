/* sensor_rows.c - see sensor_rows.h: read the sensors, ask the library for some at a time, write.
 * SPDX-License-Identifier: MIT */
#include "commands/sensor_rows.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kernel/hash_bytes.h"
#include "output/json_file.h"
#include "output/json_values.h"
#include "output/number_text.h"
#include "scene/read_numbers.h"
#include "util/array.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/fold.h"
#include "util/machines.h"
#include "util/read_alike.h"
#include "util/text_file.h"

/* VALUES: of rows in memory at a time. TOLD: sensors that the summary names. */
enum { VALUES = 1 << 22, TOLD = 20 };

struct sensors {
    char *text;
    double *position, *normal; /* [3 * count] */
    char **names;              /* [count], owned; NULL: its number */
    double (*ways_out)[2];     /* [count]: to the sky, to backs */
    size_t count, capacity;
};

static void free_sensors(struct sensors *s)
{
    for (size_t i = 0; i < s->count; i++)
        free(s->names[i]);
    free(s->text);
    free(s->position);
    free(s->normal);
    free(s->names);
    free(s->ways_out);
}

/* ---- the file */

static int add_sensor(struct sensors *s, const double value[6], char *name)
{
    size_t n = s->count + 1;
    if (array_reserve_beside(&s->position, n, s->capacity, 3 * sizeof *s->position) < 0
        || array_reserve_beside(&s->normal, n, s->capacity, 3 * sizeof *s->normal) < 0
        || array_reserve_beside(&s->ways_out, n, s->capacity, sizeof *s->ways_out) < 0
        || array_reserve(&s->names, n, &s->capacity, sizeof *s->names) < 0)
        return -1;
    memcpy(&s->position[3 * s->count], value, 3 * sizeof *value);
    memcpy(&s->normal[3 * s->count], value + 3, 3 * sizeof *value);
    s->names[s->count++] = name;
    return 0;
}

/* The rest of the line before a comment, without what would part a table's columns. */
static char *name_of(struct text_lines *t)
{
    char *comment = memchr(t->word_end, '#', (size_t)(t->line_end - t->word_end));
    if (comment)
        t->line_end = comment;
    char *name = rest_of_line(t);
    for (char *c = name; c && *c; c++)
        if (*c == ',' || *c == '"' || (unsigned char)*c < ' ')
            *c = ' ';
    if (name && !*name) {
        free(name);
        name = NULL;
    }
    return name;
}

static int read_line(struct sensors *s, const char *path, struct text_lines *t)
{
    double value[6];
    for (int k = 0; k < 6; k++) {
        if (!next_word(t))
            return report_error(path, t->number,
                                "a sensor has 6 numbers, x y z nx ny nz, here are %d; write a "
                                "position in m and a direction",
                                k);
        if (!word_number(t, &value[k]) || !is_finite_float(value[k]))
            return report_error(path, t->number,
                                "'%.*s' is not a finite number in x y z nx ny nz; write a decimal "
                                "number",
                                quoted_length(t->word, t->word_end), t->word);
    }
    if (!(fabs(value[3]) + fabs(value[4]) + fabs(value[5]) > 0))
        return report_error(
            path, t->number,
            "the direction 0 0 0 looks nowhere; write nx ny nz of any length but 0");
    char *name = name_of(t);
    if (add_sensor(s, value, name) == 0)
        return 0;
    free(name);
    return scene_file_no_memory(path);
}

static int read_sensors(struct sensors *s, const char *path)
{
    size_t size;
    s->text = text_file_need(path, &size);
    if (!s->text)
        return -1;
    struct text_lines t = text_lines(s->text, size);
    while (next_line(&t)) {
        struct text_lines ahead = t;
        if (next_word(&ahead) && read_line(s, path, &t) < 0)
            return -1;
    }
    return s->count ? 0
                    : report_error(path, 0,
                                   "there is no sensor in it; write lines `x y z nx ny nz [name]`");
}

/* ---- what is written */

static void write_name(const struct sensors *s, size_t i, FILE *out)
{
    if (s->names[i])
        fputs(s->names[i], out);
    else
        fprintf(out, "%zu", i);
}

static void write_number(double x, FILE *out)
{
    char text[NUMBER_TEXT];
    fputc(',', out);
    fwrite(text, 1, (size_t)number_text(text, x), out);
}

static void write_row(const struct sensors *s, size_t i, const double *row, uint32_t faces,
                      FILE *out)
{
    write_name(s, i, out);
    write_number(s->ways_out[i][0], out);
    write_number(s->ways_out[i][1], out);
    for (uint32_t j = 0; j < faces; j++)
        write_number(row[j], out);
    fputc('\n', out);
}

/* Ask and write, some sensors at a time; out NULL: nothing is written. Returns 0 or -1. */
static int see(const struct options *o, const struct open_scene *scene, struct sensors *s,
               FILE *out)
{
    size_t width = (size_t)scene->report.polygons + 2, most = VALUES / width + 1;
    most = most < s->count ? most : s->count;
    double *rows = malloc(most * width * sizeof *rows);
    int status = rows ? 0 : scene_file_no_memory(o->scene);
    for (size_t from = 0; from < s->count && status == 0; from += most) {
        size_t count = s->count - from < most ? s->count - from : most;
        status = radGetPointFactors(scene->scene, (uint32_t)count, &s->position[3 * from],
                                    &s->normal[3 * from], rows);
        if (status < 0)
            (void)report_device(scene->device, o->sensor);
        for (size_t i = 0; i < count && status == 0; i++) {
            double *row = rows + i * width;
            memcpy(s->ways_out[from + i], row + width - 2, sizeof *s->ways_out);
            fold_row(row, scene->report.polygons, scene->originals);
            if (out)
                write_row(s, from + i, row, scene->originals, out);
        }
    }
    free(rows);
    return status;
}

static int write_rows(const struct options *o, const struct open_scene *scene, struct sensors *s)
{
    struct atomic_file file = {0};
    const int writes = o->out && machines_number() == 0;
    if (machines_agree(writes && atomic_open(&file, o->out) < 0))
        return -1;
    if (!writes)
        return see(o, scene, s, NULL);
    fprintf(file.stream, "name,sky,back");
    for (uint32_t j = 0; j < scene->originals; j++)
        fprintf(file.stream, ",%u", (unsigned)j);
    fputc('\n', file.stream);
    if (see(o, scene, s, file.stream) == 0)
        return atomic_commit(&file);
    atomic_discard(&file);
    return -1;
}

static void print(const struct open_scene *scene, const struct sensors *s, double time)
{
    printf("faces     %u\nsensors   %zu, %.2f s\n", scene->originals, s->count, time);
    for (size_t i = 0; i < s->count && i < TOLD; i++) {
        printf("          ");
        write_name(s, i, stdout);
        printf(": to sky %.4f %%, to black backs %.4f %%\n", 100 * s->ways_out[i][0],
               100 * s->ways_out[i][1]);
    }
    if (s->count > TOLD)
        printf("          and %zu more\n", s->count - TOLD);
}

static json_t *report_json(const struct options *o, const struct open_scene *scene,
                           const struct sensors *s, double time)
{
    json_t *list = json_array();
    for (size_t i = 0; i < s->count; i++) {
        char number[NUMBER_TEXT];
        snprintf(number, sizeof number, "%zu", i);
        json_array_append_new(list,
                              json_pack("{s:o, s:f, s:f}", "name",
                                        json_text(s->names[i] ? s->names[i] : number), "to_sky",
                                        s->ways_out[i][0], "to_backs", s->ways_out[i][1]));
    }
    return json_pack("{s:o, s:I, s:o, s:f}", "scene", json_text(o->scene), "faces",
                     (json_int_t)scene->originals, "sensors", list, "seconds", time);
}

static uint64_t identity(const struct sensors *s)
{
    const size_t size = 3 * s->count * sizeof *s->position;
    return hash_bytes(hash_bytes(s->count, s->position, size), s->normal, size);
}

int sensor_rows(const struct options *o, const struct open_scene *scene)
{
    struct sensors s = {0};
    double start = seconds();
    int status =
        machines_agree(read_sensors(&s, o->sensor) < 0) || read_alike(o->sensor, identity(&s)) < 0
            ? -1
            : write_rows(o, scene, &s);
    double time = seconds() - start;
    if (status == 0 && !o->quiet && !path_is_stdout(o->json))
        print(scene, &s, time);
    if (status == 0 && o->json && machines_number() == 0)
        status = json_file_write(o->json, report_json(o, scene, &s, time));
    free_sensors(&s);
    return status < 0;
}
