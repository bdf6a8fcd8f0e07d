/* import_text.c - Assimp's file callbacks over memory.
 *
 * aiImportFileFromMemory would not do: it finds no second file, so a scene loses its materials.
 * SPDX-License-Identifier: MIT */
#include "scene/import_text.h"

#include <stdlib.h>
#include <string.h>

#include <assimp/cfileio.h>
#include <assimp/cimport.h>

#include "util/text_file.h"

struct source {
    const char *path, *text;
    size_t size;
};

struct memory_file {
    struct aiFile file; /* first, so that the one is the other */
    const char *data;
    size_t size, at;
    char *owned;
};

static struct memory_file *memory_file(struct aiFile *file)
{
    return (struct memory_file *)(void *)file;
}

static size_t read_file(struct aiFile *file, char *out, size_t size, size_t count)
{
    struct memory_file *m = memory_file(file);
    size_t whole = size ? (m->size - m->at) / size : 0;
    if (count > whole)
        count = whole;
    if (count)
        memcpy(out, m->data + m->at, size * count);
    m->at += size * count;
    return count;
}

static size_t write_file(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file, (void)data, (void)size, (void)count;
    return 0;
}

static size_t tell_file(struct aiFile *file)
{
    return memory_file(file)->at;
}

static size_t size_file(struct aiFile *file)
{
    return memory_file(file)->size;
}

static enum aiReturn seek_file(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    struct memory_file *m = memory_file(file);
    size_t at = origin == aiOrigin_SET ? offset : origin == aiOrigin_CUR ? m->at + offset : m->size - offset;
    if (at > m->size)
        return aiReturn_FAILURE;
    m->at = at;
    return aiReturn_SUCCESS;
}

static void flush_file(struct aiFile *file)
{
    (void)file;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode)
{
    const struct source *source = (const struct source *)(const void *)io->UserData;
    if (strchr(mode, 'w'))
        return NULL;
    struct memory_file *m = calloc(1, sizeof *m);
    if (!m)
        return NULL;
    if (strcmp(path, source->path) == 0) {
        m->data = source->text;
        m->size = source->size;
    } else if (!(m->data = m->owned = text_file_read(path, &m->size))) {
        free(m);
        return NULL;
    }
    m->file.ReadProc = read_file;
    m->file.WriteProc = write_file;
    m->file.TellProc = tell_file;
    m->file.FileSizeProc = size_file;
    m->file.SeekProc = seek_file;
    m->file.FlushProc = flush_file;
    return &m->file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    if (file)
        free(memory_file(file)->owned);
    free(file);
}

const struct aiScene *import_text(const char *path, const char *text, size_t size)
{
    struct source source = {path, text, size};
    struct aiFileIO io = {open_file, close_file, (aiUserData)(void *)&source};
    return aiImportFileEx(path, 0, &io);
}
