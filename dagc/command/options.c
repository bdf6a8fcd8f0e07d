/* options.c - the command line, its help, and what it may not ask for.
 *
 * The options are the rows of options.def, emits.def and passes.def: parsing and help both read
 * them. Values come as `--name VALUE` or `--name=VALUE`.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "command/options.h"

enum option {
#define OPTION(number, spelling, value, group, help) OPTION_##number,
#include "command/options.def"
#undef OPTION
    OPTIONS
};

enum group { GROUP_WRITES, GROUP_READS, GROUP_FINDS, GROUP_TELLS, GROUPS };
static const char *const group_titles[GROUPS] = {"What it writes", "What it reads", "What it finds",
                                                 "What it tells"};

static const struct {
    const char *spelling, *value, *help;
    enum group group;
} options[OPTIONS] = {
#define OPTION(number, spelling, value, group, help) {spelling, value, help, GROUP_##group},
#include "command/options.def"
#undef OPTION
};

enum source_kind { SOURCE_ORACLES, SOURCE_CATALOG };

static const struct {
    const char *name, *says;
    enum source_kind source;
} emits[EMITS] = {
#define EMIT(number, name, source, says) {name, says, SOURCE_##source},
#include "emit/emits.def"
#undef EMIT
};

static const struct {
    const char *name, *says;
} passes[PASSES] = {
#define PASS(number, name, says) {name, says},
#include "base/passes.def"
#undef PASS
};

int dag_job_is_catalog(const struct job *job)
{
    return emits[job->emit].source == SOURCE_CATALOG || job->skeleton;
}

/* ---- help */

static const char usage[] = "usage: dagc [OPTION]... FILE.dag\n"
                            "       dagc diff [-I DIR] [--catalog FILE] A.dag B.dag\n";

static const char lesson[] =
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
    "                                  both | emitter -> subdivide_emitter; }\n"
    "      node seen   = visibility(rays = 16)  { none -> stop;  partial | all -> form; }\n"
    "      node form   = form_factor() { done -> link; }\n"
    "    }\n"
    "\n"
    "    dagc -o small.c --header small.h small.dag     small_defaults(), small_refine(), "
    "small_oracle\n"
    "    dagc --emit=svg -o small.svg small.dag         a drawing of the graph\n"
    "    dagc --emit=none -Werror small.dag             only look for mistakes, and be strict\n"
    "    dagc --prove small.dag                         does what runs do what it says?\n"
    "\n"
    "Every warning and error shows where it is, the path that proves it, and how to mend it.\n"
    "`dagc diff` says which answers make the oracles of two files decide differently; exit status\n"
    "0: none, 1: some, 2: trouble.\n"
    "\n"
    "The text generated is yours. Messages go to standard error. Exit status: 0 done, 1 errors\n"
    "in the source or in reading and writing, 2 wrong usage; unless it is 0, no output file has\n"
    "been touched.\n";

static void print_option(int option)
{
    const char *value = options[option].value;
    char left[64];
    snprintf(left, sizeof left, "%s%s%s", options[option].spelling,
             *value == '\0' || strcmp(value, "+") == 0 ? ""
             : *value == '+'                           ? " "
             : options[option].spelling[1] == '-'      ? "="
                                                       : " ",
             *value == '+' ? value + 1 : value);
    printf("  %-15s %s\n", left, options[option].help);
    for (int i = 0; option == OPTION_EMIT && i < EMITS; i++)
        printf("                  %-12s %s%s\n", emits[i].name,
               emits[i].source == SOURCE_CATALOG ? "FILE.dag is a catalog: " : "", emits[i].says);
    for (int i = 0; option == OPTION_DUMP && i < PASSES; i++)
        printf("                  %-12s %s\n", passes[i].name, passes[i].says);
}

static void print_help(void)
{
    printf("%s\ndagc compiles refinement oracles, written as decision graphs, to C.\n", usage);
    for (int g = 0; g < GROUPS; g++) {
        printf("\n%s\n", group_titles[g]);
        if (g == GROUP_READS)
            printf("  %-15s %s\n", "FILE.dag", "the source; '-': standard input");
        for (int i = 0; i < OPTIONS; i++)
            if (options[i].group == (enum group)g)
                print_option(i);
    }
    printf("%s", lesson);
}

static void print_warnings(void)
{
    struct warnings plain;
    dag_warnings_default(&plain);
    printf("The warnings, whether they are on, and what each finds:\n\n");
    dag_warnings_list(stdout);
    printf("\n-WNAME gives one, -Wno-NAME does not, -Werror=NAME makes it an error.\n");
}

/* ---- reading it */

static int wrong(const char *what, const char *which)
{
    fprintf(stderr, "dagc: error: %s%s%s\n%sTry 'dagc --help'.\n", what, *which != '\0' ? " " : "",
            which, usage);
    return 2;
}

static const char in_help[] = "'dagc --help' tells what there is";

/* known: where the names stand, for one that is like none of them. */
static int wrong_name(const char *what, const char *name, const char *nearest, const char *known)
{
    fprintf(stderr, "dagc: error: %s '%s'\n", what, name);
    if (nearest != NULL)
        fprintf(stderr, "    note: did you mean '%s'?\n", nearest);
    else
        fprintf(stderr, "    note: %s\n", known);
    return 2;
}

static int set_emit(struct job *job, const char *name)
{
    struct suggestion suggestion = {name, NULL, 0};
    job->c.cxx = strcmp(name, emits[EMIT_CXX].name) == 0;
    if (job->c.cxx) {
        job->emit = EMIT_C; /* all that belongs to C text belongs to it */
        return -1;
    }
    for (int i = 0; i < EMITS; i++) {
        if (strcmp(name, emits[i].name) == 0) {
            job->emit = (enum emit)i;
            return -1;
        }
        dag_suggest(&suggestion, emits[i].name);
    }
    return wrong_name("--emit does not know", name, suggestion.best, in_help);
}

static int set_dump(struct job *job, const char *name)
{
    struct suggestion suggestion = {name, NULL, 0};
    for (int i = 0; i < PASSES; i++) {
        if (strcmp(name, passes[i].name) == 0) {
            job->stop = (enum pass)i;
            return -1;
        }
        dag_suggest(&suggestion, passes[i].name);
    }
    return wrong_name("--dump knows no pass", name, suggestion.best, in_help);
}

static int set_warning(struct job *job, const char *what)
{
    const char *nearest = NULL;
    if (*what == '\0') {
        print_warnings();
        return 0;
    }
    const char *unknown = dag_warnings_switch(&job->warnings, what, &nearest);
    return unknown == NULL
               ? -1
               : wrong_name("no warning is called", unknown, nearest, "'dagc -W' lists them");
}

/* What there is one of: is it asked for again, and otherwise? */
static int is_second(const struct job *job, enum option option, const char *value)
{
    const char *had = option == OPTION_OUTPUT    ? job->outputs[OUTPUT_TEXT].path
                      : option == OPTION_HEADER  ? job->outputs[OUTPUT_HEADER].path
                      : option == OPTION_DEPFILE ? job->outputs[OUTPUT_DEPFILE].path
                      : option == OPTION_EMIT    ? job->emit_name
                      : option == OPTION_DUMP    ? job->dump_name
                                                 : NULL;
    return had != NULL && strcmp(had, value) != 0;
}

/* -1: go on; else the status to exit with. */
static int set_option(struct job *job, enum option option, const char *value)
{
    switch (option) {
    case OPTION_OUTPUT:
        job->outputs[OUTPUT_TEXT].path = value;
        return -1;
    case OPTION_HEADER:
        job->outputs[OUTPUT_HEADER].path = value;
        return -1;
    case OPTION_DEPFILE:
        job->outputs[OUTPUT_DEPFILE].path = value;
        return -1;
    case OPTION_CATALOG:
        job->catalog_path = value;
        return -1;
    case OPTION_INSTRUMENT:
        job->c.counted = 1;
        return -1;
    case OPTION_TRACE:
        job->c.traced = 1;
        return -1;
    case OPTION_RELEASE:
        job->c.wave = strcmp(value, "wave") == 0;
        return job->c.wave || strcmp(value, "flat") == 0
                   ? -1
                   : wrong("--release takes flat or wave, not", value);
    case OPTION_COPIES:
        job->c.copies = atoi(value);
        if (job->c.copies < 1 || job->c.copies > 64 || strspn(value, "0123456789") != strlen(value))
            return wrong("--copies takes a number from 1 to 64, not", value);
        return -1;
    case OPTION_DIRECTIVES:
        job->c.directives = 1;
        return -1;
    case OPTION_OUTLINE:
        job->c.outline = 1;
        return -1;
    case OPTION_LINES:
        job->c.lines = 1;
        return -1;
    case OPTION_STANDALONE:
        job->c.standalone = 1;
        return -1;
    case OPTION_PREFIX:
        job->c.prefix = value;
        return dag_is_prefix(value) ? -1
                                    : wrong("--prefix takes what can begin a C name, not", value);
    case OPTION_HOST:
        job->host[job->c.host_count++] = value;
        return -1;
    case OPTION_PROFILE:
        job->profile_path = value;
        return -1;
    case OPTION_PROVE:
        job->prove = 1;
        return -1;
    case OPTION_FOLDER:
        job->folders[job->folder_count++] = value;
        return -1;
    case OPTION_EMIT:
        job->emit_name = value;
        return set_emit(job, value);
    case OPTION_DUMP:
        job->dump_name = value;
        return set_dump(job, value);
    case OPTION_WARNING:
        return set_warning(job, value);
    case OPTION_HELP:
        print_help();
        return 0;
    case OPTION_VERSION:
        printf("dagc %s\n", DAGC_VERSION);
        return 0;
    case OPTIONS:
        break;
    }
    return -1;
}

/* Is the argument this option? Then *value is what was written behind it, NULL: nothing. */
static int matches(const char *argument, int option, const char **value)
{
    size_t length = strlen(options[option].spelling);
    *value = NULL;
    if (strncmp(argument, options[option].spelling, length) != 0)
        return 0;
    if (options[option].value[0] == '+') {
        if (argument[length] != '\0' || options[option].value[1] == '\0')
            *value = argument + length;
    } else if (argument[length] == '=' && options[option].value[0] != '\0')
        *value = argument + length + 1;
    else if (argument[length] != '\0')
        return 0;
    return 1;
}

static int unknown_option(const char *argument)
{
    char word[NAME_MAX_LENGTH + 1];
    struct suggestion suggestion = {word, NULL, 0};
    snprintf(word, sizeof word, "%.*s", (int)strcspn(argument, "="), argument);
    for (int i = 0; i < OPTIONS; i++)
        if (strlen(options[i].spelling) > 2)
            dag_suggest(&suggestion, options[i].spelling);
    if (suggestion.best != NULL)
        return wrong_name("unknown option", argument, suggestion.best, in_help);
    return wrong("unknown option", argument);
}

/* One option, and its value when that is the next argument. */
static int parse_option(struct job *job, int count, char **arguments, int *at)
{
    const char *value;
    for (int i = 0; i < OPTIONS; i++) {
        if (!matches(arguments[*at], i, &value))
            continue;
        if (value == NULL && options[i].value[0] != '\0') {
            if (*at + 1 >= count)
                return wrong("a value is missing after", arguments[*at]);
            value = arguments[++*at];
        }
        if (is_second(job, (enum option)i, value))
            return wrong("there can be only one", options[i].spelling);
        return set_option(job, (enum option)i, value);
    }
    return unknown_option(arguments[*at]);
}

/* ---- what no run could mean */

/* Sets the folder that a path is in; returns the name there, NULL: there is no such folder. */
static const char *place_of(const char *path, struct stat *folder)
{
    const char *slash = strrchr(path, '/');
    char *above = slash == NULL ? strdup(".") : strndup(path, (size_t)(slash - path) + 1);
    int there = above != NULL && stat(above, folder) == 0;
    free(above);
    return !there ? NULL : slash != NULL ? slash + 1 : path;
}

/* Do two paths name one file, or one place where no file is yet? "-" names none. */
static int same_file(const char *a, const char *b)
{
    struct stat x, y;
    if (a == NULL || b == NULL)
        return 0;
    if (strcmp(a, "-") == 0 || strcmp(b, "-") == 0)
        return 0;
    if (strcmp(a, b) == 0)
        return 1;
    int here = stat(a, &x) == 0, there = stat(b, &y) == 0;
    if (here || there)
        return here && there && S_ISREG(x.st_mode) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
    const char *name = place_of(a, &x), *other = place_of(b, &y);
    return name != NULL && other != NULL && strcmp(name, other) == 0 && x.st_dev == y.st_dev
           && x.st_ino == y.st_ino;
}

static int is_standard(const char *path)
{
    return path != NULL && strcmp(path, "-") == 0;
}

/* NULL: nothing. */
static const char *contradiction(const struct job *job)
{
    const char *header = job->outputs[OUTPUT_HEADER].path, *out = job->outputs[OUTPUT_TEXT].path;
    const char *depfile = job->outputs[OUTPUT_DEPFILE].path;
    for (int i = 0; i < OUTPUTS; i++) {
        const char *path = job->outputs[i].path;
        for (int k = 0; k < i; k++)
            if (same_file(path, job->outputs[k].path)
                || (is_standard(path) && is_standard(job->outputs[k].path)))
                return "two outputs name the same file";
        if ((!is_standard(job->input_path) && same_file(path, job->input_path))
            || (job->catalog_path != NULL && same_file(path, job->catalog_path))
            || (job->profile_path != NULL && same_file(path, job->profile_path)))
            return "an output would replace an input";
    }
    if (is_standard(job->input_path) && is_standard(job->catalog_path))
        return "the source and the catalog cannot both be standard input";
    if (dag_job_is_catalog(job) && (header != NULL || job->catalog_path != NULL))
        return "--header and --catalog mean nothing with a catalog as the source";
    if ((job->c.counted || job->c.traced || job->c.lines || job->c.standalone || job->prove
         || job->c.copies || job->c.directives || job->c.outline || job->c.wave)
        && (job->emit != EMIT_C || job->stop != PASSES))
        return "--instrument, --trace, --release=wave, --copies, --outline, --lines, "
               "--line-directives, --standalone and --prove belong to C text";
    if (job->profile_path != NULL
        && (dag_job_is_catalog(job) || (job->stop != PASSES && job->stop < PASS_ANALYSE)))
        return "--profile belongs to an analysed oracle";
    if (job->profile_path != NULL && (job->prove || job->c.outline))
        return "--profile changes the graph: have it written by --emit=text, then --prove or "
               "--outline that";
    if (job->c.outline && job->c.copies > 1)
        return "--outline makes the text shorter, --copies longer: take one";
    if (job->prove && (job->c.standalone || header != NULL || depfile != NULL || !is_standard(out)))
        return "--prove writes nothing";
    if (job->c.standalone && header == NULL)
        return "--standalone needs --header";
    if (job->c.prefix != NULL && !job->c.standalone)
        return "--prefix belongs to --standalone";
    if (job->c.host_count > 0 && !job->c.standalone)
        return "--host belongs to --standalone";
    if (header != NULL && (job->emit != EMIT_C || job->stop != PASSES))
        return "--header belongs to C text";
    if ((job->emit == EMIT_STUB || job->emit == EMIT_STUB_CXX)
        && (job->stop != PASSES || depfile != NULL))
        return "--dump and --depfile mean nothing with --emit=stub";
    if (dag_job_is_catalog(job) && job->stop != PASSES)
        return "--dump shows oracles, not a catalog";
    if (job->emit_name != NULL && job->stop != PASSES)
        return "--dump stops before there is anything to --emit: take one";
    if (depfile != NULL && is_standard(out) && (header == NULL || is_standard(header)))
        return "--depfile needs an output file: -o FILE";
    return NULL;
}

static int has_cxx_name(const char *path)
{
    static const char *const ends[] = {".cpp", ".cc", ".cxx"};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        size_t length = strlen(path), end = strlen(ends[i]);
        if (length > end && strcmp(path + length - end, ends[i]) == 0)
            return 1;
    }
    return 0;
}

int dag_parse_arguments(struct job *job, int count, char **arguments)
{
    int only_files = 0;
    job->stop = PASSES;
    dag_warnings_default(&job->warnings);
    for (int i = 1; i < count; i++) {
        const char *argument = arguments[i];
        if (only_files || argument[0] != '-' || strcmp(argument, "-") == 0) {
            if (job->input_path != NULL)
                return wrong("more than one source:", argument);
            job->input_path = argument;
        } else if (strcmp(argument, "--") == 0)
            only_files = 1;
        else {
            int status = parse_option(job, count, arguments, &i);
            if (status >= 0)
                return status;
        }
    }
    if (job->input_path == NULL)
        return wrong("no source is given", "");
    if (job->outputs[OUTPUT_TEXT].path == NULL)
        job->outputs[OUTPUT_TEXT].path = "-";
    job->c.folders = job->folders;
    job->c.folder_count = job->folder_count;
    job->c.host = job->host;
    size_t length = strlen(job->input_path);
    if (job->emit == EMIT_STUB || job->emit == EMIT_STUB_CXX)
        job->skeleton = strchr(job->input_path, '/') != NULL
                        || (length > 4 && strcmp(job->input_path + length - 4, ".dag") == 0);
    if (job->emit == EMIT_STUB_CXX && !job->skeleton)
        return wrong("--emit=stub-c++ takes a catalog, not", job->input_path);
    if (job->emit == EMIT_C && has_cxx_name(job->outputs[OUTPUT_TEXT].path))
        job->c.cxx = 1;
    const char *why = contradiction(job);
    return why != NULL ? wrong(why, "") : -1;
}

int dag_parse_diff(struct job *job, int count, char **arguments)
{
    int only_files = 0;
    for (int i = 2; i < count; i++) {
        const char *argument = arguments[i];
        if (only_files || argument[0] != '-' || strcmp(argument, "-") == 0) {
            if (job->second_path != NULL)
                return wrong("diff takes two files, not also", argument);
            *(job->input_path == NULL ? &job->input_path : &job->second_path) = argument;
        } else if (strcmp(argument, "--") == 0)
            only_files = 1;
        else {
            const char *value;
            if (!matches(argument, OPTION_CATALOG, &value)
                && !matches(argument, OPTION_FOLDER, &value)
                && !matches(argument, OPTION_HELP, &value))
                return wrong("diff does not know", argument);
            int status = parse_option(job, count, arguments, &i);
            if (status >= 0)
                return status;
        }
    }
    if (job->second_path == NULL)
        return wrong("diff takes two files", "");
    if (is_standard(job->catalog_path) /* each of the two reads it */
        || (is_standard(job->input_path) && is_standard(job->second_path)))
        return wrong("of what diff reads, only one of the two files can be standard input", "");
    return -1;
}
