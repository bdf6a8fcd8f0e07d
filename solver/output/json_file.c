/* json_file.c - see json_file.h.
 * SPDX-License-Identifier: MIT */
#include "output/json_file.h"

#include <errno.h>
#include <string.h>

#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/report.h"

static int dump(json_t *value, FILE *stream)
{
    return json_dumpf(value, stream, JSON_INDENT(2) | JSON_PRESERVE_ORDER) < 0
                   || fputc('\n', stream) == EOF
               ? -1
               : 0;
}

int json_file_write(const char *path, json_t *value)
{
    if (!value)
        return report_error(path, 0, "out of memory");
    int result;
    if (path_is_stdout(path)) {
        const int dumped = dump(value, stdout), cause = stream_flush(stdout);
        result = dumped < 0 || cause
                     ? report_error("standard output", 0, "cannot write: %s; write elsewhere",
                                    strerror(cause ? cause : ENOMEM))
                     : 0;
    } else {
        struct atomic_file file;
        result = atomic_open(&file, path);
        if (result == 0) {
            /* a failed write leaves its mark on the stream, for commit to find */
            (void)dump(value, file.stream);
            result = atomic_commit(&file);
        }
    }
    json_decref(value);
    return result;
}
