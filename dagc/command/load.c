/* load.c - the library's front: a .dag file or text to a checked graph, in one call.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "base/warn.h"

struct request {
    struct input catalog, file;
    const char *const *folders;
    int folder_count;
    const char *const *replacements;
    int replacement_count;
    struct warnings warnings;
};

static void load(struct dag *dag, void *context)
{
    const struct request *request = context;
    dag->warnings = &request->warnings;
    dag->folders = request->folders;
    dag->folder_count = request->folder_count;
    dag->replacements = request->replacements;
    dag->replacement_count = request->replacement_count;
    dag_run_passes(dag, &request->catalog, request->file.name != NULL ? &request->file : NULL,
                   PASSES);
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

struct dag *dag_load_with(const char *path, const struct dag_options *options, FILE *errors)
{
    struct request request = {0};
    request.folders = options->folders;
    request.folder_count = options->folder_count;
    request.replacements = options->replacements;
    request.replacement_count = options->replacement_count;
    dag_warnings_quiet(&request.warnings);
    if (options->switches != NULL && !obey(&request.warnings, options->switches, errors))
        return NULL;
    if (options->catalog_path != NULL)
        dag_input_open(&request.catalog, options->catalog_path);
    else {
        const char *text = options->catalog != NULL ? options->catalog : dagc_standard_catalog;
        request.catalog.name = options->catalog_name != NULL ? options->catalog_name : "catalog";
        request.catalog.bytes = text;
        request.catalog.length = strlen(text);
    }
    if (options->text != NULL) {
        request.file.name = path;
        request.file.bytes = options->text;
        request.file.length = options->length;
    } else if (path != NULL)
        dag_input_open(&request.file, path);
    struct dag *dag = dag_new();
    int failed = dag == NULL || dag_protect(dag, load, &request) != 0;
    if (failed && errors != NULL)
        fprintf(errors, "dagc: error: out of memory\n");
    else if (!failed && errors != NULL)
        dag_print_diagnostics(dag, errors);
    if (failed || dag->error_count > 0) {
        dag_free(dag);
        dag = NULL;
    } else {
        dag->warnings = NULL; /* they end with this function */
        dag->folders = NULL;  /* the caller's */
        dag->folder_count = 0;
        dag->replacements = NULL;
        dag->replacement_count = 0;
    }
    dag_input_close(&request.catalog);
    dag_input_close(&request.file);
    return dag;
}

struct dag *dag_load(const char *path, const char *catalog_name, const char *catalog, FILE *errors)
{
    struct dag_options options = {0};
    options.catalog_name = catalog_name;
    options.catalog = catalog;
    return dag_load_with(path, &options, errors);
}

struct dag *dag_load_text(const char *name, const char *text, size_t length,
                          const char *catalog_name, const char *catalog, FILE *errors)
{
    struct dag_options options = {0};
    options.text = text;
    options.length = length;
    options.catalog_name = catalog_name;
    options.catalog = catalog;
    return dag_load_with(name, &options, errors);
}

struct dag *dag_load_switched(const char *switches, const char *name, const char *text,
                              size_t length, const char *catalog_name, const char *catalog,
                              FILE *errors)
{
    struct dag_options options = {0};
    options.switches = switches;
    options.text = text;
    options.length = length;
    options.catalog_name = catalog_name;
    options.catalog = catalog;
    return dag_load_with(name, &options, errors);
}

int dag_oracle(const struct dag *dag, const char *name)
{
    if (name != NULL)
        return dag_find(&dag->oracle_names, name);
    return dag->oracle_count == 1 ? 0 : -1;
}
