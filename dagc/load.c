/* load.c - the library's front: a .dag file or text to a checked graph, in one call.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "warn.h"

struct request {
    const char *catalog_name, *catalog;
    struct input file;
    struct warnings warnings;
};

/* The passes up to a checked graph, as in main.c. */
static void load(struct dag *dag, void *context)
{
    const struct request *request = context;
    dag->warnings = &request->warnings;
    int catalog = dag_read_text(dag, request->catalog_name, request->catalog,
                                strlen(request->catalog));
    if (catalog >= 0) {
        dag_parse(dag, catalog, CONTENT_CATALOG);
        dag_resolve_catalog(dag);
        dag_check_names(dag);
        dag_check_values(dag);
    }
    if (dag->error_count > 0)
        return;
    int file = dag_read(dag, &request->file);
    if (file >= 0) {
        dag_parse(dag, file, CONTENT_ORACLES);
        dag_resolve(dag);
        dag_check_values(dag);
        dag_check_graph(dag);
    }
    if (dag->error_count == 0)
        dag_analyse(dag);
    if (dag->error_count == 0)
        dag_fingerprint(dag);
}

static struct dag *run(struct request *request, const char *catalog_name, const char *catalog,
                       FILE *errors)
{
    request->catalog_name = catalog_name != NULL ? catalog_name : "catalog";
    request->catalog = catalog != NULL ? catalog : dagc_standard_catalog;
    struct dag *dag = dag_new();
    int failed = dag == NULL || dag_protect(dag, load, request) != 0;
    if (failed && errors != NULL)
        fprintf(errors, "dagc: error: out of memory\n");
    else if (!failed && errors != NULL)
        dag_print_diagnostics(dag, errors);
    if (failed || dag->error_count > 0) {
        dag_free(dag);
        return NULL;
    }
    dag->warnings = NULL; /* they end with this function */
    return dag;
}

struct dag *dag_load(const char *path, const char *catalog_name, const char *catalog, FILE *errors)
{
    struct request request = {0};
    dag_warnings_quiet(&request.warnings);
    dag_input_open(&request.file, path);
    struct dag *dag = run(&request, catalog_name, catalog, errors);
    dag_input_close(&request.file);
    return dag;
}

struct dag *dag_load_text(const char *name, const char *text, size_t length,
                          const char *catalog_name, const char *catalog, FILE *errors)
{
    return dag_load_switched("", name, text, length, catalog_name, catalog, errors);
}

/* Obeys words such as "no-unused-parameter error"; 0: there is one that is no switch. */
static int obey(struct warnings *warnings, const char *switches, FILE *errors)
{
    char word[64];
    int length;
    for (; sscanf(switches, " %63s%n", word, &length) == 1; switches += length) {
        const char *nearest = NULL;
        if (dag_warnings_switch(warnings, word, &nearest) != NULL) {
            if (errors != NULL)
                fprintf(errors, "dagc: error: no warning is called '%s'\n", word);
            return 0;
        }
    }
    return 1;
}

struct dag *dag_load_switched(const char *switches, const char *name, const char *text,
                              size_t length, const char *catalog_name, const char *catalog,
                              FILE *errors)
{
    struct request request = {0};
    dag_warnings_quiet(&request.warnings);
    if (!obey(&request.warnings, switches, errors))
        return NULL;
    request.file.name = name;
    request.file.bytes = text;
    request.file.length = length;
    return run(&request, catalog_name, catalog, errors);
}

int dag_oracle(const struct dag *dag, const char *name)
{
    if (name != NULL)
        return dag_find(&dag->oracle_names, name);
    return dag->oracle_count == 1 ? 0 : -1;
}
