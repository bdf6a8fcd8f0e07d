/* atomic_file.c - temporary file beside the output, then rename(2).
 *
 * The temporary file is made by open(2) with mode 0666, not by mkstemp(3) with 0600: so the
 * result has the mode that the user's umask asks for.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* realpath */
#include "util/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "util/report.h"
#include "util/temporary.h"

enum { BUFFER = 1 << 18 }; /* of the C library's 4 KiB each would be a call of the system */

static int fail(struct atomic_file *file, int cause)
{
    if (!file->silent)
        report_error(file->path ? file->path : "output", 0, "cannot write: %s; %s", strerror(cause),
                     cause == ENOENT || cause == ENOTDIR ? "make the folder first"
                     : cause == EISDIR       ? "give the name of a file, not of a folder"
                     : cause == ENAMETOOLONG ? "give it a shorter name"
                     : cause == ENOSPC       ? "free some space or write elsewhere"
                     : cause == EFBIG        ? "allow larger files (ulimit -f) or write elsewhere"
                                             : "choose a place where you may write");
    atomic_discard(file);
    return -1;
}

static FILE *open_temporary(struct atomic_file *file)
{
    size_t size = strlen(file->target) + 40;
    file->temporary = malloc(size);
    if (!file->temporary)
        return NULL;
    for (unsigned attempt = 0; attempt < 1000; attempt++) {
        snprintf(file->temporary, size, "%s.%ld.%u.tmp", file->target, (long)getpid(), attempt);
        temporary_lock();
        int descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        int cause = errno;
        if (descriptor >= 0)
            temporary_add(file->temporary);
        temporary_unlock();
        errno = cause;
        if (descriptor >= 0) {
            FILE *stream = fdopen(descriptor, "wb");
            if (!stream)
                close(descriptor); /* the file goes with atomic_discard */
            return stream;
        }
        if (errno != EEXIST)
            break;
    }
    int cause = errno;
    free(file->temporary);
    file->temporary = NULL; /* there is nothing to unlink */
    errno = cause;
    return NULL;
}

static int open_file(struct atomic_file *file, const char *path, int silent)
{
    *file = (struct atomic_file){.silent = silent};
    file->path = strdup(path);
    if (!file->path)
        return fail(file, ENOMEM);
    struct stat status;
    int exists = stat(path, &status) == 0;
    if (exists && S_ISDIR(status.st_mode))
        return fail(file, EISDIR);
    if (exists && !S_ISREG(status.st_mode)) {
        file->stream = fopen(path, "wb");
    } else {
        file->target = exists ? realpath(path, NULL) : strdup(path);
        if (!file->target)
            return fail(file, errno);
        file->stream = open_temporary(file);
    }
    if (!file->stream)
        return fail(file, errno);
    file->buffer = malloc(BUFFER); /* without one it is slower, no more */
    if (file->buffer)
        setvbuf(file->stream, file->buffer, _IOFBF, BUFFER);
    return 0;
}

int atomic_open(struct atomic_file *file, const char *path)
{
    return open_file(file, path, 0);
}

int atomic_open_silently(struct atomic_file *file, const char *path)
{
    return open_file(file, path, 1);
}

int atomic_check(const char *path)
{
    struct atomic_file file = {0};
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) {
        if (access(path, W_OK) == 0)
            return 0;
        int cause = errno; /* opening a pipe would wait for its reader */
        file.path = strdup(path);
        return fail(&file, cause);
    }
    if (atomic_open(&file, path))
        return -1;
    atomic_discard(&file);
    return 0;
}

int stream_flush(FILE *stream)
{
    if (!ferror(stream))
        return fflush(stream) ? errno : 0;
    /* What errno said of the write that failed, others have written over: another one says it
     * again, by all likelihood. */
    clearerr(stream);
    return (putc('\n', stream) == EOF || fflush(stream)) && errno ? errno : EIO;
}

int atomic_commit(struct atomic_file *file)
{
    /* Errors may show only when the last block leaves the buffer, or at close. */
    int cause = stream_flush(file->stream), failed = cause != 0;
    if (fclose(file->stream) && !failed) {
        failed = 1;
        cause = errno;
    }
    file->stream = NULL;
    temporary_lock();
    if (!failed && file->temporary && rename(file->temporary, file->target)) {
        failed = 1;
        cause = errno;
    }
    if (!failed && file->temporary)
        temporary_forget(file->temporary);
    if (!failed)
        temporary_written();
    temporary_unlock();
    if (failed)
        return fail(file, cause ? cause : EIO);
    free(file->temporary);
    file->temporary = NULL;
    atomic_discard(file);
    return 0;
}

void atomic_discard(struct atomic_file *file)
{
    if (file->stream)
        fclose(file->stream);
    if (file->temporary) {
        temporary_lock();
        unlink(file->temporary);
        temporary_forget(file->temporary);
        temporary_unlock();
    }
    free(file->buffer);
    free(file->temporary);
    free(file->target);
    free(file->path);
    *file = (struct atomic_file){0};
}
