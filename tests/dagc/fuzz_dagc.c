/* fuzz_dagc.c - libFuzzer on the compiler: every pass and every emitter, on sources in memory.
 *
 * An input is a .dag file as those in dagc/ are: the catalog it is compiled under, or that it is
 * one itself, is read off its own `# run:` line. So the golden files are seeds as they stand, and
 * a crash, shortened, is a regression file as it stands. Warnings are all on, so that all analyses
 * run, but errors by nature only, so that what they find is emitted all the same.
 *
 * Behind a line "// header:" an input has a C header: every header that is looked for holds that
 * text then, so that what --standalone takes in is mutated, too.
 *
 * An import must not lead out of the folder: the linker's --wrap=fopen puts a gate before the one
 * function by which the compiler opens files. Run from the top folder (fuzz.sh does).
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "base/warn.h"
#include "emit/skeleton.h"

static const char folder[] = "tests/dagc/";
static const char *const folders[] = {"tests/dagc/imports", "tests/dagc/library"};
static const char *const catalogs[] = {"test_catalog.dag", "analysis_catalog.dag"};
enum { CATALOGS = 2 };

struct run {
    struct input catalog, file;
    struct warnings warnings;
    int is_catalog;
};

static FILE *given; /* a file without a name; the input has a header if header_length > 0 */
static size_t header_length;
static int inside; /* the compiler runs: libFuzzer opens files of its own */

FILE *__real_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode)
{
    if (!inside || *mode == 'w') /* libFuzzer saves an input that crashes; no pass writes files */
        return __real_fopen(path, mode);
    size_t length = strlen(path);
    if (header_length > 0 && length > 2 && strcmp(path + length - 2, ".h") == 0) {
        char name[32]; /* the same file each time, as a path would lead to it */
        snprintf(name, sizeof name, "/proc/self/fd/%d", fileno(given));
        return __real_fopen(name, mode);
    }
    if (strncmp(path, folder, sizeof folder - 1) != 0 || strstr(path, "..") != NULL) {
        errno = ENOENT;
        return NULL;
    }
    return __real_fopen(path, mode);
}

static void emit_catalog(struct dag *dag)
{
    struct text out = {0};
    dag_emit_catalog_h(dag, &out);
    dag_emit_catalog_c(dag, &out);
    dag_emit_catalog_doc(dag, &out);
    for (int i = 0; i < dag->tool_count; i++)
        dag_emit_stub(dag, &out, dag->tools[i].name);
    for (int i = 0; i < dag->term_count; i++)
        dag_emit_stub(dag, &out, dag->terms[i].name);
    dag_text_free(&out);
    for (int cxx = 0; cxx < 2; cxx++) {
        struct skeleton skeleton = {.dag = dag, .catalog = "fuzz.dag", .cxx = cxx};
        dag_emit_skeleton(&skeleton);
        for (int i = 0; i < skeleton.file_count; i++)
            dag_text_free(&skeleton.files[i].text);
    }
}

static void emit_oracles(struct dag *dag)
{
    static const struct emit_options plain,
        watched = {.counted = 1, .traced = 1, .copies = 4, .lines = 1}, outlined = {.outline = 1},
        alone = {.counted = 1,
                 .traced = 1,
                 .lines = 1,
                 .standalone = 1,
                 .prefix = "p",
                 .folders = folders,
                 .folder_count = 2};
    struct text out = {0}, header = {0};
    dag_fingerprint(dag);
    for (int pass = 0; pass < PASSES; pass++)
        dag_emit_text(dag, &out, (enum pass)pass);
    dag_emit_json(dag, &out);
    dag_emit_dot(dag, &out);
    dag_emit_c(dag, &out, NULL, NULL, &plain);
    dag_emit_c(dag, &out, &header, "h.h", &watched);
    dag_emit_c(dag, &out, &header, "h.h", &outlined);
    dag_emit_standalone(dag, &out, &header, "h.h", &alone);
    dag_text_free(&out);
    dag_text_free(&header);
}

/* As main.c has them. */
static void passes(struct dag *dag, void *context)
{
    struct run *run = context;
    dag->warnings = &run->warnings;
    dag->folders = folders;
    dag->folder_count = 2;
    int catalog = dag_read(dag, run->is_catalog ? &run->file : &run->catalog);
    if (catalog >= 0) {
        dag_parse(dag, catalog, CONTENT_CATALOG);
        dag_resolve_catalog(dag);
        dag_check_names(dag);
        dag_check_values(dag);
    }
    if (run->is_catalog || dag->error_count > 0) {
        if (dag->error_count == 0)
            emit_catalog(dag);
        return;
    }
    int file = dag_read(dag, &run->file);
    if (file < 0)
        return;
    dag_parse(dag, file, CONTENT_ORACLES);
    dag_resolve_catalog(dag);
    dag_check_names(dag);
    dag_resolve(dag);
    dag_check_values(dag);
    dag_expand(dag);
    dag_check_graph(dag);
    if (dag->error_count == 0)
        dag_analyse(dag);
    if (dag->error_count == 0)
        emit_oracles(dag);
}

/* Cuts the header off the input. */
static void take_header(char *text)
{
    static const char mark[] = "\n// header:\n";
    char *found = strstr(text, mark);
    header_length = 0;
    if (found == NULL)
        return;
    const char *begins = found + sizeof mark - 1;
    header_length = strlen(begins);
    if (given == NULL && (given = tmpfile()) == NULL)
        abort();
    rewind(given);
    if (fwrite(begins, 1, header_length, given) != header_length || fflush(given) != 0
        || ftruncate(fileno(given), (off_t)header_length) != 0)
        abort();
    found[1] = '\0';
}

/* The text behind the last "# run:", or "". */
static const char *run_line(const char *text)
{
    const char *found = "";
    for (const char *at = text; (at = strstr(at, "# run:")) != NULL; at++)
        found = at;
    return found;
}

static void choose(struct run *run, const char *text)
{
    const char *arguments = run_line(text);
    size_t length = strcspn(arguments, "\n");
    const char *emit = strstr(arguments, "--emit=catalog");
    run->is_catalog = emit != NULL && (size_t)(emit - arguments) < length;
    run->catalog.name = "the standard catalog";
    run->catalog.bytes = dagc_standard_catalog;
    run->catalog.length = strlen(dagc_standard_catalog);
    for (int i = 0; i < CATALOGS; i++) {
        static struct input kept[CATALOGS]; /* each read once */
        const char *named = strstr(arguments, catalogs[i]);
        if (named == NULL || (size_t)(named - arguments) >= length)
            continue;
        if (kept[i].bytes == NULL) {
            char path[64];
            snprintf(path, sizeof path, "%s%s", folder, catalogs[i]);
            dag_input_open(&kept[i], path);
            if (kept[i].error != 0) {
                fprintf(stderr, "cannot read %s: run from the top folder\n", path);
                exit(2);
            }
        }
        run->catalog = kept[i];
        run->catalog.name = catalogs[i];
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static FILE *sink;
    struct run run = {0};
    char *text = malloc(size + 1);
    struct dag *dag = dag_new();
    if (sink == NULL)
        sink = fopen("/dev/null", "w");
    if (text == NULL || dag == NULL || sink == NULL)
        abort();
    memcpy(text, data, size);
    text[size] = '\0';
    take_header(text);
    choose(&run, text);
    run.file.name = "tests/dagc/fuzz.dag"; /* what it imports is looked for there */
    run.file.bytes = text;
    run.file.length = header_length > 0 ? strlen(text) : size;
    dag_warnings_default(&run.warnings);
    const char *nearest;
    dag_warnings_switch(&run.warnings, "all", &nearest);
    dag_warnings_switch(&run.warnings, "no-error=missing-term", &nearest);
    dag_warnings_switch(&run.warnings, "no-error=unguarded-split", &nearest);
    inside = 1;
    if (dag_protect(dag, passes, &run) != 0)
        abort(); /* out of memory: no input of this size may need so much */
    inside = 0;
    dag_print_diagnostics(dag, sink);
    dag_free(dag);
    free(text);
    return 0;
}
