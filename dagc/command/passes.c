/* passes.c - the list of passes, in their order: from sources to graphs that can be emitted.
 *
 * Each pass finds all the errors it can. Those up to the check of graphs run whatever the ones
 * before them found, so that one run tells everything; what follows needs graphs without errors.
 * SPDX-License-Identifier: MIT */
#include "base/internal.h"

struct step {
    void (*run)(struct dag *dag);
    int dump; /* what --dump shows after it (enum pass); -1: nothing */
    int ends; /* with errors so far, this is the last pass */
};

static const struct step on_catalog[] = {
    {dag_resolve_catalog, -1, 0},
    {dag_check_names, -1, 0},
    {dag_check_values, -1, 1},
};

static const struct step on_oracles[] = {
    {NULL, PASS_PARSE, 0},
    {dag_resolve_catalog, -1, 0}, /* what the file declares itself */
    {dag_check_names, -1, 0},
    {dag_replace, -1, 0}, /* what somebody wants otherwise */
    {dag_resolve, -1, 0},
    {dag_check_values, -1, 0},
    {dag_expand, PASS_RESOLVE, 0},
    {dag_check_graph, PASS_CHECK, 1},
    {dag_analyse, PASS_ANALYSE, 1},
    {NULL, PASS_AVAILABILITY, 1}, /* the same graph, shown otherwise */
    {NULL, PASS_WAVES, 1},        /* likewise */
    {dag_fingerprint, -1, 1},
};

/* Reads, parses and takes the steps: 1 when it came to the end of them. */
static int run(struct dag *dag, const struct input *input, enum content content,
               const struct step *steps, size_t count, enum pass stop)
{
    int source = dag_read(dag, input);
    if (source < 0)
        return 0;
    dag_parse(dag, source, content);
    for (size_t i = 0; i < count; i++) {
        if (steps[i].run != NULL)
            steps[i].run(dag);
        if (dag->error_count > 0 ? steps[i].ends : steps[i].dump == (int)stop)
            return 0;
    }
    return 1;
}

#define COUNT(array) (sizeof(array) / sizeof *(array))

void dag_run_passes(struct dag *dag, const struct input *catalog, const struct input *file,
                    enum pass stop)
{
    struct input named = {0};
    const char *path = file != NULL && catalog->bytes == dagc_standard_catalog
                           ? dag_named_catalog(dag, file)
                           : NULL;
    if (path != NULL && dag_open_catalog(dag, path, file->name, &named))
        catalog = &named;      /* else the parser says that it is missing */
    dag->opened = named.owned; /* should memory run out, dag_free frees it */
    int ok = run(dag, catalog, CONTENT_CATALOG, on_catalog, COUNT(on_catalog), PASSES);
    dag->opened = NULL;
    dag_input_close(&named);
    if (ok && file != NULL)
        run(dag, file, CONTENT_ORACLES, on_oracles, COUNT(on_oracles), stop);
}
