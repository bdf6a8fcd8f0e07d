/* chart.c - see chart.h. gnuplot reads a script, an unnamed temporary file, and writes the picture.
 * SPDX-License-Identifier: MIT */
#include "output/chart.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "util/atomic_file.h"
#include "util/ends_with.h"
#include "util/report.h"
#include "util/run_between.h"

/* Returns 0, or -1 after a message. */
static int draw_from(FILE *script, const char *path)
{
    static const char *const gnuplot[] = {"gnuplot", NULL};
    struct atomic_file file;
    if (atomic_open(&file, path))
        return -1;
    const int status = run_between(gnuplot, script, file.stream);
    if (status == 0 && lseek(fileno(file.stream), 0, SEEK_END) > 0)
        return atomic_commit(&file);
    atomic_discard(&file);
    return report_error(path, 0,
                        status == RUN_NO_PROGRAM
                            ? "gnuplot, which draws it, is not there; install it (package "
                              "gnuplot-nox)"
                            : "gnuplot, which draws it, failed");
}

int chart_draw(const char *path, void (*print)(FILE *script, const void *context),
               const void *context)
{
    FILE *script = tmpfile();
    if (!script)
        return report_error(path, 0, "no temporary file to draw it with: %s; make room in /tmp",
                            strerror(errno));
    fprintf(script, "set terminal %s\n",
            ends_with(path, ".svg") ? "svg size 800,500 dynamic" : "pngcairo size 800,500");
    print(script, context);
    const int failed = draw_from(script, path);
    fclose(script);
    return failed;
}
