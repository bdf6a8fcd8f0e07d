/* main.c - the command dagc: the list of passes.
 *
 * Exit status: 0 done; 1 the sources have errors, or a file cannot be read or written; 2 the
 * command line is wrong. With a status other than 0 no output file has been touched.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "diff.h"
#include "prove.h"
#include "write.h"

enum emit { EMIT_C, EMIT_NONE, EMIT_CATALOG_H, EMIT_CATALOG_C };

static const char *const emit_names[] = {"c", "none", "catalog-h", "catalog-c"};
enum { EMIT_NAMES = 4 };

struct job {
    const char *input_path, *catalog_path; /* catalog_path NULL: the standard catalog */
    enum emit emit;
    struct emit_options options;
    const char *folders[64];               /* -I */
    int prove, proved;                     /* --prove; what it found */
    struct input input, catalog;
    struct output outputs[2];              /* the C text, the header */
};

static int is_catalog(const struct job *job)
{
    return job->emit == EMIT_CATALOG_H || job->emit == EMIT_CATALOG_C;
}

static void passes(struct dag *dag, void *context)
{
    struct job *job = context;
    struct output *out = &job->outputs[0], *header = &job->outputs[1];

    int catalog = is_catalog(job) ? dag_read(dag, &job->input) : dag_read(dag, &job->catalog);
    if (catalog >= 0) {
        dag_parse(dag, catalog, CONTENT_CATALOG);
        dag_resolve_catalog(dag);
        dag_check_names(dag);
        dag_check_values(dag);
    }
    if (dag->error_count > 0)
        return;
    if (!is_catalog(job)) {
        int file = dag_read(dag, &job->input);
        if (file >= 0) {
            dag_parse(dag, file, CONTENT_ORACLES);
            dag_resolve(dag);
            dag_check_values(dag);
            dag_check_graph(dag);
        }
    }
    if (dag->error_count > 0)
        return;
    dag_fingerprint(dag);
    if (job->prove)
        job->proved = dag_prove(dag, &job->options, stdout);
    else if (job->emit == EMIT_C) {
        const char *slash = header->path == NULL ? NULL : strrchr(header->path, '/');
        const char *name = slash != NULL ? slash + 1 : header->path;
        if (job->options.standalone)
            dag_emit_standalone(dag, &out->text, &header->text, name, &job->options);
        else
            dag_emit_c(dag, &out->text, name == NULL ? NULL : &header->text, name,
                       &job->options);
    } else if (job->emit == EMIT_CATALOG_H)
        dag_emit_catalog_h(dag, &out->text);
    else if (job->emit == EMIT_CATALOG_C)
        dag_emit_catalog_c(dag, &out->text);
}

static int run(struct job *job)
{
    struct dag *dag = dag_new();
    int result = 1;
    dag_input_open(&job->input, job->input_path);
    if (job->catalog_path != NULL)
        dag_input_open(&job->catalog, job->catalog_path);
    else {
        job->catalog.name = "the standard catalog";
        job->catalog.bytes = dagc_standard_catalog;
        job->catalog.length = strlen(dagc_standard_catalog);
    }
    if (dag == NULL || dag_protect(dag, passes, job) != 0)
        fprintf(stderr, "dagc: error: out of memory\n");
    else {
        dag_print_diagnostics(dag, stderr);
        if (dag->error_count == 0)
            result = job->prove ? job->proved != 0 || fflush(stdout) != 0
                                : job->emit != EMIT_NONE && dag_write_outputs(job->outputs, 2) != 0;
    }
    for (int i = 0; i < 2; i++)
        dag_text_free(&job->outputs[i].text);
    dag_input_close(&job->input);
    dag_input_close(&job->catalog);
    dag_free(dag);
    return result;
}

/* ---- the command line */

static const char usage[] =
    "usage: dagc [-o FILE] [--header FILE] [--emit=c|none|catalog-h|catalog-c]\n"
    "            [--catalog FILE] [--version] [--help] FILE.dag\n"
    "       dagc diff [--catalog FILE] A.dag B.dag\n";

static const char help[] =
    "\n"
    "dagc compiles refinement oracles, written as decision graphs, to C.\n"
    "\n"
    "  -o FILE         write the C text to FILE; '-' or nothing: standard output\n"
    "  --header FILE   write the declarations to FILE, for the C text to include\n"
    "  --emit=WHAT     c          one flat function per oracle (the default)\n"
    "                  none       nothing: only look for mistakes\n"
    "                  catalog-h  FILE.dag is a catalog: its enums and terms for C\n"
    "                  catalog-c  FILE.dag is a catalog: the interpreter's table of tools\n"
    "  --instrument    add NAME_refine_counted: calls and time per node, answers per arc\n"
    "  --trace         add NAME_refine_traced: a callback after every node\n"
    "  --standalone    write C text and header that need no other file: with the tools they reach\n"
    "  --prefix NAME   what every name in them begins with; else the first oracle's name\n"
    "  -I FOLDER       look here for the headers of tools before those built into dagc\n"
    "  --prove         emit nothing: compile the C text and compare it with the graph, path by path\n"
    "  diff            say which answers make the oracles of two files decide differently;\n"
    "                  exit status 0: none, 1: some, 2: trouble\n"
    "  --catalog FILE  the tools, terms and decisions to use instead of the standard ones\n"
    "  FILE.dag        the source; '-': standard input\n"
    "\n"
    "A graph asks questions; every answer leads to the next node or to a decision:\n"
    "\n"
    "    # small.dag\n"
    "    oracle small \"split by area until a link carries little\" {\n"
    "      param most : ratio = 0.05 in [0, inf] \"share of the mean irradiance\";\n"
    "      start level;\n"
    "      node level  = clusters()  { surfaces -> energy;  apart -> stop;\n"
    "                                  receiver -> subdivide_receiver;\n"
    "                                  emitter -> subdivide_emitter; }\n"
    "      node energy = transfer(relative = most) { dark -> stop;  below -> seen;\n"
    "                                                above -> guard; }\n"
    "      node guard  = can_split(min_share = 1e-5) { neither -> seen;\n"
    "                                  receiver -> subdivide_receiver;\n"
    "                                  otherwise -> subdivide_emitter; }\n"
    "      node seen   = visibility(rays = 16)  { none -> stop;  otherwise -> form; }\n"
    "      node form   = form_factor() { done -> link; }\n"
    "    }\n"
    "\n"
    "    dagc -o small.c --header small.h small.dag\n"
    "\n"
    "gives small_defaults(), small_refine() and small_oracle. The text generated is yours.\n"
    "Messages go to standard error. Exit status: 0 done, 1 errors in the source or in reading\n"
    "and writing, 2 wrong usage; unless it is 0, no output file has been touched.\n";

static int wrong(const char *what, const char *which)
{
    fprintf(stderr, "dagc: error: %s%s%s\n%s", what, *which != '\0' ? " " : "", which, usage);
    return 2;
}

/* `--NAME=VALUE` or `--NAME VALUE`: the value, moving *at past it; NULL: another option. */
static const char *value_of(const char *name, char **arguments, int count, int *at, int *missing)
{
    const char *argument = arguments[*at];
    size_t length = strlen(name);
    if (strncmp(argument, name, length) != 0)
        return NULL;
    if (argument[length] == '=')
        return argument + length + 1;
    if (argument[length] != '\0')
        return NULL;
    if (*at + 1 >= count) {
        *missing = 1;
        return NULL;
    }
    return arguments[++*at];
}

static int set_emit(struct job *job, const char *name)
{
    for (int i = 0; i < EMIT_NAMES; i++)
        if (strcmp(name, emit_names[i]) == 0) {
            job->emit = (enum emit)i;
            return 1;
        }
    return 0;
}

/* Do two paths name one file that exists? "-" names none. */
static int same_file(const char *a, const char *b)
{
    struct stat x, y;
    if (a == NULL || b == NULL)
        return 0;
    if (strcmp(a, b) == 0)
        return 1;
    if (strcmp(a, "-") == 0 || strcmp(b, "-") == 0)
        return 0;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && S_ISREG(x.st_mode) && x.st_dev == y.st_dev &&
           x.st_ino == y.st_ino;
}

/* What no run could mean; NULL: nothing. */
static const char *contradiction(const struct job *job)
{
    const char *out = job->outputs[0].path, *header = job->outputs[1].path;
    int standard_input = strcmp(job->input_path, "-") == 0;
    if (same_file(out, header))
        return "-o and --header name the same file";
    if ((!standard_input && (same_file(out, job->input_path) || same_file(header, job->input_path))) ||
        (job->catalog_path != NULL && (same_file(out, job->catalog_path) ||
                                       same_file(header, job->catalog_path))))
        return "an output would replace an input";
    if (standard_input && job->catalog_path != NULL && strcmp(job->catalog_path, "-") == 0)
        return "the source and the catalog cannot both be standard input";
    if (job->options.standalone && header == NULL)
        return "--standalone needs --header";
    if (is_catalog(job) && (header != NULL || job->catalog_path != NULL))
        return "--header and --catalog mean nothing with a catalog as the source";
    return NULL;
}

/* 0: run the job; else the status to exit with, 1 standing for "done, 0". */
static int parse_arguments(struct job *job, int count, char **arguments)
{
    int missing = 0, only_files = 0;
    const char *value;
    for (int i = 1; i < count; i++) {
        const char *argument = arguments[i];
        if (only_files || argument[0] != '-' || strcmp(argument, "-") == 0) {
            if (job->input_path != NULL)
                return wrong("more than one source:", argument);
            job->input_path = argument;
        } else if (strcmp(argument, "--") == 0)
            only_files = 1;
        else if (strcmp(argument, "--prove") == 0)
            job->prove = 1;
        else if (strcmp(argument, "--standalone") == 0)
            job->options.standalone = 1;
        else if ((value = value_of("--prefix", arguments, count, &i, &missing)) != NULL)
            job->options.prefix = value;
        else if ((value = value_of("--include", arguments, count, &i, &missing)) != NULL ||
                 (value = value_of("-I", arguments, count, &i, &missing)) != NULL) {
            if (job->options.folder_count == 64)
                return wrong("more than 64 of -I", "");
            job->folders[job->options.folder_count++] = value;
            job->options.folders = job->folders;
        } else if (strcmp(argument, "--instrument") == 0)
            job->options.counted = 1;
        else if (strcmp(argument, "--trace") == 0)
            job->options.traced = 1;
        else if (strcmp(argument, "--help") == 0) {
            printf("%s%s", usage, help);
            return 1;
        } else if (strcmp(argument, "--version") == 0) {
            printf("dagc %s\n", DAGC_VERSION);
            return 1;
        } else if ((value = value_of("-o", arguments, count, &i, &missing)) != NULL)
            job->outputs[0].path = value;
        else if ((value = value_of("--header", arguments, count, &i, &missing)) != NULL)
            job->outputs[1].path = value;
        else if ((value = value_of("--catalog", arguments, count, &i, &missing)) != NULL)
            job->catalog_path = value;
        else if ((value = value_of("--emit", arguments, count, &i, &missing)) != NULL) {
            if (!set_emit(job, value))
                return wrong("--emit knows c, none, catalog-h and catalog-c, not", value);
        } else
            return wrong(missing ? "a value is missing after" : "unknown option", argument);
    }
    if (job->input_path == NULL)
        return wrong("no source is given", "");
    if (job->outputs[0].path == NULL)
        job->outputs[0].path = "-";
    const char *why = contradiction(job);
    return why != NULL ? wrong(why, "") : 0;
}

/* dagc diff [--catalog FILE] A.dag B.dag */
static int command_diff(int count, char **arguments)
{
    const char *files[2] = {NULL, NULL}, *catalog = NULL, *value;
    struct input input = {0};
    int given = 0, missing = 0, result = 2;
    for (int i = 2; i < count; i++) {
        if ((value = value_of("--catalog", arguments, count, &i, &missing)) != NULL)
            catalog = value;
        else if (missing || given == 2 || (arguments[i][0] == '-' && arguments[i][1] != '\0'))
            return wrong("diff takes two files and --catalog FILE, not", arguments[i]);
        else
            files[given++] = arguments[i];
    }
    if (given != 2)
        return wrong("diff takes two files", "");
    if (catalog != NULL)
        dag_input_open(&input, catalog);
    char *text = catalog == NULL || input.error != 0 ? NULL : calloc(1, input.length + 1);
    if (text != NULL && input.length > 0)
        memcpy(text, input.bytes, input.length);
    if (catalog != NULL && text == NULL)
        fprintf(stderr, "dagc: error: cannot read %s: %s\n", catalog,
                strerror(input.error != 0 ? input.error : ENOMEM));
    else
        result = dag_diff(files[0], files[1], catalog, text, stdout);
    free(text);
    dag_input_close(&input);
    return fflush(stdout) != 0 ? 2 : result;
}

int main(int count, char **arguments)
{
    if (count > 1 && strcmp(arguments[1], "diff") == 0)
        return command_diff(count, arguments);
    struct job job = {0};
    int status = parse_arguments(&job, count, arguments);
    if (status == 1)
        return fflush(stdout) != 0;
    return status != 0 ? status : run(&job);
}
