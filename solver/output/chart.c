/* chart.c - see chart.h. gnuplot reads a script, and its picture is read from it.
 * SPDX-License-Identifier: MIT */
#include "output/chart.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "util/atomic_file.h"
#include "util/ends_with.h"
#include "util/report.h"
#include "util/temporary.h"

static void remove_script(const char *script)
{
    temporary_lock();
    unlink(script);
    temporary_forget(script);
    temporary_unlock();
}

int chart_draw(const char *path, void (*print)(FILE *script, const void *context),
               const void *context)
{
    const char *folder = getenv("TMPDIR");
    char script[512], command[600], bytes[4096];
    size_t all = 0;
    snprintf(script, sizeof script, "%s/radiosity-XXXXXX", folder && *folder ? folder : "/tmp");
    temporary_lock();
    int fd = mkstemp(script);
    if (fd >= 0)
        temporary_add(script);
    temporary_unlock();
    FILE *f = fd < 0 ? NULL : fdopen(fd, "w");
    if (!f)
        return report_error(script, 0, "cannot be written");
    fprintf(f, "set terminal %s\n",
            ends_with(path, ".svg") ? "svg size 800,500 dynamic" : "pngcairo size 800,500");
    print(f, context);
    struct atomic_file file;
    if (fclose(f) != 0 || atomic_open(&file, path)) {
        remove_script(script);
        return -1;
    }
    snprintf(command, sizeof command, "gnuplot '%s'", script);
    FILE *picture = popen(command, "r");
    size_t n;
    while (picture && (n = fread(bytes, 1, sizeof bytes, picture)) > 0)
        all += fwrite(bytes, 1, n, file.stream);
    n = picture && pclose(picture) == 0 && all > 0;
    remove_script(script);
    if (n)
        return atomic_commit(&file);
    atomic_discard(&file);
    return report_error(path, 0, "gnuplot, which draws it, is not there or failed");
}
