/* write.c - files that appear whole or not at all.
 *
 * Every output is first written, closed and checked under a temporary name in its own folder;
 * only when all of them are there are they renamed. So a full disk, a missing folder or a kill
 * leave the old files as they were. Devices and pipes cannot be renamed over and are written in
 * place, after the rest is safe.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* realpath */

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/tidy.h"
#include "base/write.h"

static int fail(const char *path, int error)
{
    fprintf(stderr, "dagc: error: cannot write %s: %s\n", path, strerror(error));
    return -1;
}

/* A signal's handler may look at it between any two of these. */
static void forget_part(struct output *output)
{
    char *part = output->part;
    output->part = NULL;
    free(part);
}

/* Everything to the stream, which is closed unless it is stdout; 0 or an errno. */
static int write_stream(FILE *file, const struct text *text)
{
    int error = 0;
    errno = 0;
    if ((text->length > 0 && fwrite(text->bytes, 1, text->length, file) != text->length)
        || fflush(file) != 0)
        error = errno != 0 ? errno : EIO;
    if (file != stdout && fclose(file) != 0 && error == 0)
        error = errno != 0 ? errno : EIO;
    return error;
}

/* Where the output goes: sets real, and part when it is to be renamed. */
static int plan(struct output *output)
{
    if (strcmp(output->path, "-") == 0)
        return 0;
    struct stat status;
    int exists = stat(output->path, &status) == 0;
    if (exists && S_ISDIR(status.st_mode))
        return fail(output->path, EISDIR);
    output->real = exists ? realpath(output->path, NULL) : NULL;
    if (output->real == NULL)
        output->real = strdup(output->path);
    if (output->real == NULL)
        return fail(output->path, ENOMEM);
    if (exists && !S_ISREG(status.st_mode))
        return 0;
    size_t length = strlen(output->real);
    char *part = malloc(length + 8);
    if (part == NULL)
        return fail(output->path, ENOMEM);
    memcpy(part, output->real, length);
    memcpy(part + length, ".XXXXXX", 8);
    output->part = part;
    return 0;
}

static int write_part(struct output *output)
{
    int handle = mkstemp(output->part);
    if (handle < 0) {
        int error = errno;
        forget_part(output);
        return fail(output->path, error);
    }
    mode_t mask = umask(0);
    umask(mask);
    int error = fchmod(handle, 0666 & ~mask) != 0 ? errno : 0;
    FILE *file = fdopen(handle, "wb");
    if (file == NULL) {
        error = errno;
        close(handle);
    } else {
        int write_error = write_stream(file, &output->text);
        error = error != 0 ? error : write_error;
    }
    return error != 0 ? fail(output->path, error) : 0;
}

static int write_in_place(const struct output *output)
{
    FILE *file = output->real == NULL ? stdout : fopen(output->real, "wb");
    int error = file == NULL ? errno : write_stream(file, &output->text);
    return error != 0 ? fail(output->real == NULL ? "standard output" : output->path, error) : 0;
}

static int put_in_place(struct output *output)
{
    if (rename(output->part, output->real) != 0)
        return fail(output->path, errno);
    forget_part(output);
    return 0;
}

struct parts {
    const struct output *outputs;
    int count;
};

/* A signal ends us: only temporary files have been written. */
static void remove_parts(const void *of)
{
    const struct parts *parts = of;
    for (int i = 0; i < parts->count; i++)
        if (parts->outputs[i].part != NULL)
            unlink(parts->outputs[i].part);
}

int dag_write_outputs(struct output *outputs, int count)
{
    int result = 0;
    const struct parts parts = {outputs, count};
    struct tidy tidy = {remove_parts, &parts, NULL};
    dag_tidy_push(&tidy);
    for (int i = 0; i < count && result == 0; i++) {
        if (outputs[i].path != NULL && outputs[i].text.failed)
            result = fail(outputs[i].path, ENOMEM);
        else if (outputs[i].path != NULL) {
            result = plan(&outputs[i]);
            if (result == 0 && outputs[i].part != NULL)
                result = write_part(&outputs[i]);
            else
                forget_part(&outputs[i]); /* nothing was made under that name */
        }
    }
    for (int i = 0; i < count && result == 0; i++)
        if (outputs[i].path != NULL && outputs[i].part == NULL)
            result = write_in_place(&outputs[i]);
    dag_tidy_hold(); /* all of them, or none */
    for (int i = 0; i < count && result == 0; i++)
        if (outputs[i].part != NULL)
            result = put_in_place(&outputs[i]);
    for (int i = 0; i < count; i++) {
        if (outputs[i].part != NULL)
            unlink(outputs[i].part);
        forget_part(&outputs[i]);
        free(outputs[i].real);
        outputs[i].real = NULL;
    }
    dag_tidy_pop(&tidy);
    dag_tidy_release();
    return result;
}

int dag_write_ends(void)
{
    return fflush(stdout) != 0 || ferror(stdout) ? fail("standard output", errno) : 0;
}
