/* factor_names.c - see factor_names.h.
 * [EnergyPlus, Input Output Reference: a comma or semicolon ends a field, an exclamation mark
 * starts a comment, names are the same whatever their capitals]
 * SPDX-License-Identifier: MIT */
#include "output/factor_names.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "util/atomic_file.h"
#include "util/csv_text.h"
#include "util/ends_with.h"
#include "util/report.h"

int factor_names_write(const char *path, const struct factor_table *t)
{
    const int table = ends_with(path, ".csv");
    struct atomic_file file = {0};
    if (atomic_open(&file, path) < 0)
        return -1;
    if (table)
        fputs("row,name,area_m2\n", file.stream);
    for (uint32_t r = 0; r < t->count; r++) {
        if (table) {
            fprintf(file.stream, "%lu,", (unsigned long)r);
            write_csv_text(file.stream, t->names[r]);
            fprintf(file.stream, ",%.12g\n", t->areas[r]);
        } else {
            fprintf(file.stream, "%s\n", t->names[r]);
        }
    }
    return atomic_commit(&file);
}

static int by_name(const void *a, const void *b)
{
    const char *const *x = a, *const *y = b;
    return strcasecmp(*x, *y);
}

/* Returns 0, or -1 after a message. */
static int check_different(const char *path, char *const *names, uint32_t count)
{
    const char **sorted = malloc(((size_t)count + 1) * sizeof *sorted);
    int status = sorted ? 0 : report_error(path, 0, "out of memory for the names of rows");
    for (uint32_t r = 0; r < count && sorted; r++)
        sorted[r] = names[r];
    if (sorted)
        qsort(sorted, count, sizeof *sorted, by_name);
    for (uint32_t r = 1; r < count && !status; r++)
        if (strcasecmp(sorted[r - 1], sorted[r]) == 0)
            status = report_error(path, 0,
                                  "two rows would be called '%s', which EnergyPlus cannot tell "
                                  "apart; give these parts other names",
                                  sorted[r]);
    free(sorted);
    return status;
}

char *factor_name_energyplus(const char *name)
{
    char *text = strdup(name);
    for (char *c = text; c && (c = strpbrk(c, ",;!")) != NULL;)
        *c = '_';
    return text;
}

char **factor_names_energyplus(const char *path, const struct factor_table *t)
{
    char **names = calloc((size_t)t->count + 1, sizeof *names);
    int failed = !names;
    for (uint32_t r = 0; r < t->count && !failed; r++) {
        names[r] = factor_name_energyplus(t->names[r]);
        failed = !names[r];
    }
    if (failed)
        report_error(path, 0, "out of memory for the names of rows");
    if (failed || check_different(path, names, t->count)) {
        factor_names_free(names, t->count);
        return NULL;
    }
    return names;
}

void factor_names_free(char **names, uint32_t count)
{
    for (uint32_t r = 0; names && r < count; r++)
        free(names[r]);
    free(names);
}
