/* source.c - bytes from a file, checked to be text.
 *
 * Every source in the dag is UTF-8 without NUL bytes, so that lexer, messages and generated
 * files need not ask again. Characters that reorder the line they stand in (bidirectional
 * controls) are refused: they can make a graph read unlike what it is, and gcc warns of them.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/internal.h"

/* Length of the UTF-8 character at `at`, its number in *code; 0 when it is none. */
static int character(const unsigned char *at, const unsigned char *end, unsigned *code)
{
    static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
    int length = *at < 0x80             ? 1
                 : (*at & 0xe0) == 0xc0 ? 2
                 : (*at & 0xf0) == 0xe0 ? 3
                 : (*at & 0xf8) == 0xf0 ? 4
                                        : 0;
    if (length == 0 || end - at < length)
        return 0;
    *code = length == 1 ? *at : *at & (0x7fu >> length);
    for (int i = 1; i < length; i++) {
        if ((at[i] & 0xc0) != 0x80)
            return 0;
        *code = *code << 6 | (at[i] & 0x3fu);
    }
    if (*code < least[length] || *code > 0x10ffff || (*code >= 0xd800 && *code <= 0xdfff))
        return 0;
    return length;
}

static int reorders(unsigned code)
{
    return (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

/* One error, at the first byte that is no text; then the file is not parsed at all. */
static int check_text(struct dag *dag, int index)
{
    const struct source *source = &dag->sources[index];
    const unsigned char *text = (const unsigned char *)source->text, *end = text + source->length;
    for (const unsigned char *at = text; at < end;) {
        struct where where = {index, (int)(at - text), 1};
        unsigned code = 0;
        int length = character(at, end, &code);
        if (length == 0) {
            dag_error(dag, where, "this byte (0x%02x) is not UTF-8 text", *at);
            return -1;
        }
        if (code == 0) {
            dag_error(dag, where, "a NUL byte: this is not a text file");
            return -1;
        }
        if (reorders(code)) {
            dag_error(dag, where, "U+%04X changes the order in which this line is shown", code);
            dag_note(dag, dag_nowhere, "remove it: what is read must be what is compiled");
            return -1;
        }
        at += length;
    }
    return index;
}

/* So that the line of an offset is found without counting from the start each time. */
static const int *count_lines(struct dag *dag, const struct source *source)
{
    int *lines = dag_alloc(&dag->arena, (size_t)(source->length / LINES_STEP + 1) * sizeof *lines);
    for (int i = 0, count = 0; i <= source->length; i++) {
        if (i % LINES_STEP == 0)
            lines[i / LINES_STEP] = count;
        count += source->text[i] == '\n';
    }
    return lines;
}

static int add_source(struct dag *dag, const char *name)
{
    const char *slash = strrchr(name, '/');
    int index = ADD(dag, sources, source_count);
    struct source *source = &dag->sources[index];
    source->name = dag_copy(&dag->arena, name, strlen(name));
    source->base = slash != NULL ? source->name + (slash + 1 - name) : source->name;
    source->text = "";
    source->importer = dag_nowhere;
    return index;
}

/* The whole stream into input->owned; 0, or what went wrong. */
static int slurp(FILE *file, struct input *input)
{
    size_t capacity = 64 * 1024;
    input->owned = malloc(capacity);
    while (input->owned != NULL) {
        errno = 0;
        input->length += fread(input->owned + input->length, 1, capacity - input->length, file);
        if (ferror(file))
            return errno != 0 ? errno : EIO;
        if (feof(file))
            return 0;
        if (input->length > SOURCE_MAX_LENGTH)
            return EFBIG;
        if (input->length == capacity) {
            char *more = realloc(input->owned, capacity *= 2);
            if (more == NULL)
                return ENOMEM;
            input->owned = more;
        }
    }
    return ENOMEM;
}

void dag_input_open(struct input *input, const char *path)
{
    int standard = strcmp(path, "-") == 0;
    *input =
        (struct input){standard ? "standard input" : path, NULL, NULL, 0, 0, !standard, 0, 0, 0};
    FILE *file = standard ? stdin : fopen(path, "rb");
    if (file == NULL)
        input->error = errno != 0 ? errno : ENOENT;
    else {
        struct stat status;
        if (fstat(fileno(file), &status) == 0) {
            input->device = (uint64_t)status.st_dev;
            input->inode = (uint64_t)status.st_ino;
            input->on_disk = S_ISREG(status.st_mode);
        }
        input->error = slurp(file, input);
        input->bytes = input->owned;
        if (!standard)
            fclose(file);
    }
}

void dag_input_open_named(struct input *input, const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0 || S_ISREG(status.st_mode) || S_ISDIR(status.st_mode))
        dag_input_open(input, path);
    else
        *input = (struct input){.name = path, .error = ENOTSUP};
}

void dag_input_close(struct input *input)
{
    free(input->owned);
    input->owned = NULL;
    input->bytes = NULL;
}

int dag_read(struct dag *dag, const struct input *input)
{
    if (input->error == 0) {
        int count = dag->source_count,
            index = dag_read_text(dag, input->name, input->bytes, input->length);
        if (dag->source_count > count) {
            dag->sources[count].is_file = input->is_file;
            dag->sources[count].device = input->device;
            dag->sources[count].inode = input->inode;
            dag->sources[count].on_disk = (unsigned char)input->on_disk;
        }
        return index;
    }
    dag_error(dag, dag_nowhere, "cannot read %s: %s", input->name, strerror(input->error));
    return -1;
}

int dag_read_text(struct dag *dag, const char *name, const char *text, size_t length)
{
    if (length > SOURCE_MAX_LENGTH) {
        dag_error(dag, dag_nowhere, "cannot read %s: more than %d MB", name,
                  SOURCE_MAX_LENGTH >> 20);
        return -1;
    }
    int index = add_source(dag, name);
    dag->sources[index].text = dag_copy(&dag->arena, text, length);
    dag->sources[index].length = (int)length;
    dag->sources[index].lines = count_lines(dag, &dag->sources[index]);
    dag->sources[index].standard = text == dagc_standard_catalog;
    return check_text(dag, index);
}
