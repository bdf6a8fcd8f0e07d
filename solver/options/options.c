/* options.c - parse the command line by the table of options, and print --help from it.
 *
 * getopt_long does the parsing; that an option may be abbreviated as long as it is clear is its
 * doing, too.
 * SPDX-License-Identifier: MIT */
#include "options/options.h"

#include <getopt.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options/option_table.h"
#include "output/export.h"
#include "output/hdf5_file.h"
#include "util/array.h"
#include "util/machines.h"
#include "util/near_name.h"
#include "util/report.h"
#include "util/same_file.h"
#include "util/thread_pool.h"

/* what getopt_long returns: a letter, or one of these */
enum { HELP = 256, VERSION, ROWS, OPTIONS_MAX = 64 };

/* ---- help */

/* A line for each study, or for each other command. */
static void print_lines(int studies)
{
    for (int i = 0; i < COMMANDS; i++) {
        const struct command_row *c = &command_rows[i];
        if ((strncmp(c->name, "study", 5) == 0) != studies)
            continue;
        char left[32];
        snprintf(left, sizeof left, "%s %s", c->name, c->argument);
        printf("  %-24s %s\n", left, c->help);
    }
}

static int print_help(void)
{
    printf("usage: radiosity COMMAND [SCENE] [options]\n"
           "Light in a scene of diffuse surfaces, by hierarchical radiosity.\n"
           "\n");
    print_lines(0);
    printf("  study NAME [SCENE]       experiments: see radiosity study --help\n"
           "\n"
           "    radiosity solve room.obj --image room.png\n"
           "\n"
           "SCENE is OBJ+MTL, PLY, STL, OFF, Gmsh .msh, VTK .vtk .vtu .vtp, Nastran .bdf\n"
           ".nas .dat, View3D .vs3, glTF, Collada or what else Assimp reads, in metres. The\n"
           "diffuse colour is the reflectance, the emissive colour the exitance in W/m2.\n"
           "Faces have one side unless the material's name ends in _2s.\n"
           "COMMAND --help tells its options, --help=all all of them; --version the version.\n"
           "Messages go to standard error. Exit status: 0 done; 1 scene, oracle or file at\n"
           "fault; 2 wrong usage; 3 short of what was asked; 130, 143 stopped by a signal.\n");
    return 0;
}

static int print_studies_help(void)
{
    printf("usage: radiosity study NAME [SCENE] [options]\n"
           "\n"
           "Experiments whose table is the result; `radiosity study NAME --help` tells more.\n"
           "\n");
    print_lines(1);
    return 0;
}

/* Its value may be left out. */
static int is_optional(const struct option_row *row)
{
    return row->argument && *row->argument == '[';
}

/* "--name ARGUMENT" or "--name[=ARGUMENT]". Returns its length. */
static int option_text(const struct option_row *row, char text[64])
{
    return snprintf(text, 64, "%s%s%s%s", row->name[1] ? "--" : "-", row->name,
                    row->argument && !is_optional(row) ? " " : "",
                    row->argument ? row->argument : "");
}

/* all: with the rare options. */
static int print_command_help(enum command command, int all)
{
    const struct command_row *c = &command_rows[command];
    int width = 0, rare = 0;
    printf("usage: radiosity %s%s%s%s\n%s", c->name, *c->argument ? " " : "", c->argument,
           command == COMMAND_ORACLES ? "" : " [options]", c->lesson);
    const char *const *names = radGetClusteringNames();
    for (int i = 0; command == COMMAND_CLUSTERING && names[i]; i++)
        printf("  %-6s %s\n", names[i], radGetClusteringDoc(names[i]));
    printf("\n");
    char text[64];
    for (int i = 0; i < option_row_count; i++) {
        const struct option_row *row = &option_rows[i];
        if (!(row->commands >> command & 1))
            continue;
        rare += row->rare;
        int length = row->rare && !all ? 0 : option_text(row, text);
        width = length > width ? length : width;
    }
    for (int i = 0; i < option_row_count; i++) {
        const struct option_row *row = &option_rows[i];
        if (!(row->commands >> command & 1) || (row->rare && !all))
            continue;
        option_text(row, text);
        printf("  %-*s  %s", width, text, row->help);
        printf(row->preset ? " (%s)\n" : "\n", row->preset);
    }
    if (rare && !all)
        printf("  %-*s  %d option%s more\n", width, "--help=all", rare, rare > 1 ? "s" : "");
    printf("%s    %s\n", width ? "\n" : "", c->example);
    return 0;
}

/* ---- what is wrong */

/* Returns the exit status. `command`: whose --help tells more, "" for all. */
static int wrong(const char *command, const char *format, ...) PRINTF_LIKE(2, 3);
static int wrong(const char *command, const char *format, ...)
{
    va_list list;
    if (machines_number() > 0) /* rank 0 has the same command line, and says it */
        return 2;
    va_start(list, format);
    fprintf(stderr, "radiosity: error: ");
    vfprintf(stderr, format, list);
    fprintf(stderr, "; see radiosity %s%s--help\n", command, *command ? " " : "");
    va_end(list);
    return 2;
}

/* An option that getopt_long does not know, or knows several of. */
static int wrong_option(enum command command, const char *argument)
{
    const char *name = command_rows[command].name, *word = argument + strspn(argument, "-");
    size_t length = strcspn(word, "=");
    char several[128] = "";
    int others = -1, is_long = argument[1] == '-';
    for (int i = 0; i < option_row_count; i++) {
        const struct option_row *row = &option_rows[i];
        int whole = strlen(row->name) == length;
        if (strncmp(row->name, word, length) != 0 || (row->name[1] != 0) != is_long)
            continue;
        if (row->commands >> command & 1)
            snprintf(several + strlen(several), sizeof several - strlen(several), "%s--%s",
                     *several ? ", " : "", row->name);
        for (int c = 0; c < COMMANDS && whole && others < 0; c++)
            others = row->commands >> c & 1 ? c : -1;
    }
    if (length && *several)
        return wrong(name, "%.*s could be %s", (int)(strcspn(argument, "=")), argument, several);
    if (length && others >= 0)
        return wrong(name, "%s has no option %.*s; %s has", name, (int)(strcspn(argument, "=")),
                     argument, command_rows[others].name);
    struct near_name near = near_name(word, length);
    for (int i = 0; i < option_row_count && is_long; i++)
        if (option_rows[i].commands >> command & 1 && option_rows[i].name[1])
            near_name_offer(&near, option_rows[i].name);
    if (near.best)
        return wrong(name, "unknown option %s (did you mean --%s?)", argument, near.best);
    return wrong(name, "unknown option %s", argument);
}

/* ---- parsing */

/* value NULL: there is none. Returns -1, or the exit status. */
static int read_value(struct options *o, const struct option_row *row, const char *value)
{
    char text[64];
    const char *command = command_rows[o->command].name;
    option_text(row, text);
    text[strcspn(text, " [")] = 0;
    if (row->argument && value && !*value)
        return wrong(command, "%s takes %s, not an empty value", text,
                     is_optional(row) ? option_takes(row) : row->argument);
    if (row->read(o, row, value) < 0)
        return wrong(command, "%s takes %s, not %s", text, option_takes(row), value);
    return -1;
}

/* The command that the arguments begin with. Returns how many of them say it, 0 when none does. */
static int command_of(int count, char **arguments, enum command *command)
{
    for (int i = 0; i < COMMANDS; i++) {
        const char *name = command_rows[i].name, *space = strchr(name, ' ');
        size_t first = space ? (size_t)(space - name) : strlen(name);
        if (strlen(arguments[0]) != first || memcmp(arguments[0], name, first) != 0)
            continue;
        *command = (enum command)i;
        if (!space)
            return 1;
        if (count > 1 && strcmp(arguments[1], space + 1) == 0)
            return 2;
    }
    return 0;
}

#define STUDY "study "

/* The argument, behind `first` if that is there, names no command. Returns the exit status. */
static int wrong_command(const char *first, const char *argument)
{
    const size_t prefix = strlen(first);
    struct near_name near = near_name(argument, strlen(argument));
    if (!*first)
        near_name_offer(&near, "study");
    for (int i = 0; i < COMMANDS; i++)
        if (strncmp(command_rows[i].name, first, prefix) == 0)
            near_name_offer(&near, command_rows[i].name + prefix);
    return wrong(*first ? "study" : "", "%s %s%s%s%s",
                 *first ? "there is no study" : "unknown command", argument,
                 near.best ? " (did you mean " : "", near.best ? near.best : "",
                 near.best ? "?)" : "");
}

static int is_help(const char *argument)
{
    return strcmp(argument, "--help") == 0 || strcmp(argument, "--help=all") == 0
           || strcmp(argument, "-h") == 0;
}

/* `help`, of a command where one is named. Returns the exit status. */
static int help_on(int count, char **arguments)
{
    enum command command;
    if (count < 1 || is_help(arguments[0]) || strcmp(arguments[0], "help") == 0)
        return print_help();
    if (command_of(count, arguments, &command))
        return print_command_help(command, 0);
    if (strcmp(arguments[0], "study") != 0)
        return wrong_command("", arguments[0]);
    return count < 2 ? print_studies_help() : wrong_command(STUDY, arguments[1]);
}

/* The arguments name no command. Returns the exit status. */
static int without_command(int count, char **arguments)
{
    if (count < 2 || !*arguments[1])
        return wrong("", "no command is given");
    if (is_help(arguments[1]))
        return print_help();
    if (strcmp(arguments[1], "help") == 0)
        return help_on(count - 2, arguments + 2);
    if (strcmp(arguments[1], "--version") == 0) {
        printf("radiosity %s\n", RADIOSITY_VERSION);
        return 0;
    }
    if (*arguments[1] == '-')
        return wrong("", "a command comes first, not %s", arguments[1]);
    if (strcmp(arguments[1], "study") != 0)
        return wrong_command("", arguments[1]);
    if (count < 3 || !*arguments[2])
        return wrong("study", "study what?");
    return is_help(arguments[2]) ? print_studies_help() : wrong_command(STUDY, arguments[2]);
}

/* The table as getopt_long wants it, for one command. */
static void options_of(enum command command, struct option longs[OPTIONS_MAX],
                       char shorts[OPTIONS_MAX])
{
    int n = 0;
    strcpy(shorts, "-:h"); /* "-": what is no option comes in its order; ":": tell missing values
                              from unknown options */
    for (int i = 0; i < option_row_count; i++) {
        const struct option_row *row = &option_rows[i];
        if (!(row->commands >> command & 1))
            continue;
        if (row->name[1])
            longs[n++] = (struct option){row->name,
                                         is_optional(row) ? optional_argument
                                         : row->argument  ? required_argument
                                                          : no_argument,
                                         NULL, ROWS + i};
        else
            snprintf(shorts + strlen(shorts), 3, "%s%s", row->name, row->argument ? ":" : "");
    }
    longs[n++] = (struct option){"help", optional_argument, NULL, HELP};
    longs[n++] = (struct option){"version", 0, NULL, VERSION};
    longs[n] = (struct option){0};
}

/* The row that getopt_long's number or letter means for the command, or NULL. */
static const struct option_row *row_of(enum command command, int number)
{
    if (number >= ROWS)
        return &option_rows[number - ROWS];
    for (int i = 0; i < option_row_count; i++)
        if (option_rows[i].commands >> command & 1 && !option_rows[i].name[1]
            && option_rows[i].name[0] == number)
            return &option_rows[i];
    return NULL;
}

/* Of a command that takes many. Returns -1 to go on, or the exit status. */
static int add_scene(struct options *o, const char *path)
{
    if (array_reserve(&o->scenes, (size_t)o->scene_count + 1, &o->scene_capacity, sizeof *o->scenes)
        < 0)
        return wrong(command_rows[o->command].name, "out of memory for so many scenes");
    o->scenes[o->scene_count++] = path;
    o->scene = o->scenes[0];
    return -1;
}

/* The arguments of tune: an oracle, then scenes. Returns -1 to go on, or the exit status. */
static int add_oracle_or_scene(struct options *o, const char *path)
{
    if (!*path)
        return wrong("tune", "%s name is empty", o->oracle ? "a scene's" : "the oracle's");
    if (!o->oracle) {
        o->oracle = path;
        return -1;
    }
    for (int i = 0; i < o->scene_count; i++)
        if (same_file(o->scenes[i], path))
            return wrong("tune", "%s is named twice; left out, it would not be unknown", path);
    return add_scene(o, path);
}

/* The argument of draw and panel. Returns -1 to go on, or the exit status. */
static int set_oracle_argument(struct options *o, const char *path)
{
    const char *command = command_rows[o->command].name;
    if (!*path)
        return wrong(command, "the oracle's name is empty");
    if (o->oracle)
        return wrong(command, "more than one oracle: %s", path);
    o->oracle = path;
    return -1;
}

static int set_scene(struct options *o, const char *path)
{
    if (o->command == COMMAND_TUNE)
        return add_oracle_or_scene(o, path);
    const struct command_row *c = &command_rows[o->command];
    if (strcmp(c->argument, "ORACLE") == 0)
        return set_oracle_argument(o, path);
    if (!*c->argument)
        return wrong(c->name, "%s takes no scene, but got %s%s", c->name,
                     *path ? path : "an empty name",
                     o->command == COMMAND_ORACLES
                         ? "; it tells of all oracles, `radiosity draw NAME` shows one"
                         : "");
    int tables = o->command == COMMAND_ERROR;
    if (*path && strstr(c->argument, "..."))
        return add_scene(o, path);
    if (!*path)
        return wrong(c->name, tables ? "a table's name is empty" : "the scene's name is empty");
    if (o->scene && (!tables || o->reference))
        return wrong(c->name, "more than %s: %s", tables ? "two tables" : "one scene", path);
    *(o->scene ? &o->reference : &o->scene) = path;
    return -1;
}

/* What getopt_long found, by its number. Returns -1 to go on, or the exit status. */
static int read_argument(struct options *o, int number, const char *last)
{
    const char *command = command_rows[o->command].name;
    const struct option_row *row =
        row_of(o->command, number == '?' || number == ':' ? optopt : number);
    char letter[3] = {'-', (char)optopt, 0};
    switch (number) {
    case 1:
        return set_scene(o, optarg);
    case 'h':
    case HELP:
        if (number == HELP && optarg && strcmp(optarg, "all") != 0)
            return wrong(command, "--help takes nothing or =all, not %s", optarg);
        return print_command_help(o->command, number == HELP && optarg);
    case VERSION:
        printf("radiosity %s\n", RADIOSITY_VERSION);
        return 0;
    case ':':
        return wrong(command, "a value is missing after %s%s", row->name[1] ? "--" : "-",
                     row->name);
    case '?':
        if (optopt >= HELP)
            return wrong(command, "no value goes with --%.*s", (int)strcspn(last + 2, "="),
                         last + 2);
        return wrong_option(o->command, optopt ? letter : last);
    default:
        return read_value(o, row, optarg);
    }
}

/* Is the linear basis to be had? */
static int may_slope(const struct options *o)
{
    return o->projection == RAD_PROJECTION_GALERKIN
           && (o->solver == RAD_SOLVER_GAUSS_SEIDEL || o->solver == RAD_SOLVER_JACOBI);
}

/* What a command cannot do without. This and what follows return -1, or the exit status after a
 * message. */
static int check_needed(const struct options *o, const char *name)
{
    const char *argument = command_rows[o->command].argument;
    if (o->command == COMMAND_ERROR && !o->reference)
        return wrong(name, "two tables are needed, FACES.csv and REF.csv");
    if (o->command == COMMAND_TUNE && !o->scene_count)
        return wrong(name, "%s",
                     o->oracle ? "no scene is given" : "an oracle and scenes are needed");
    if (strcmp(argument, "ORACLE") == 0 && !o->oracle)
        return wrong(name, "no oracle is given");
    if (o->command == COMMAND_DRAW && !o->out)
        return wrong(name, "the drawing's name is missing: -o FILE.svg");
    if (o->command == COMMAND_PANEL && !o->out)
        return wrong(name, "the page's name is missing: -o FILE.html");
    if (*argument && strcmp(argument, "ORACLE") != 0 && !o->scene)
        return wrong(name, "no scene is given");
    if (o->command == COMMAND_REFERENCE && !o->out)
        return wrong(name, "the table's name is missing: -o FILE.csv");
    return -1;
}

/* Who looks at an oracle needs the release that lets him. */
static int check_watching(const struct options *o, const char *name)
{
    if (o->statistics && o->release_given && o->release != RAD_RELEASE_DAG)
        return wrong(
            name,
            "--statistics counts what the interpreted graph does: it takes no --release but dag");
    if (o->trace && o->release_given && o->release != RAD_RELEASE_DAG)
        return wrong(name, "--trace watches the interpreted graph: it takes no --release but dag");
    if (o->trace && (o->statistics || o->accuracy > 0))
        return wrong(name,
                     "--trace is of one refinement, and nothing is counted meanwhile: it "
                     "does not go with %s",
                     o->statistics ? "--statistics" : "--accuracy");
    if (o->where && !o->trace)
        return wrong(name, "--where picks lines of a trace: add --trace FILE");
    if (o->replacement_count && o->release == RAD_RELEASE_HAND)
        return wrong(name, "--replace is of a graph: it takes no --release hand");
    if (o->command == COMMAND_EXPLAIN && !o->pair == !o->at)
        return wrong(name, "%s",
                     o->pair ? "--pair and --at both name a pair: give one"
                             : "which pair? --pair RECEIVER,EMITTER or --at X,Y,Z:X,Y,Z");
    if (o->step && o->json)
        return wrong(name, "--step and --json do not go together");
    return -1;
}

static int check_checkpoints(const struct options *o, const char *name)
{
    const char *kept = o->checkpoint ? "--checkpoint" : o->restart ? "--restart" : NULL;
    if (kept && (o->accuracy > 0 || o->trace || o->statistics))
        return wrong(name, "%s does not go with %s", kept,
                     o->trace        ? "--trace"
                     : o->statistics ? "--statistics"
                                     : "--accuracy");
    const int xdmf = o->command == COMMAND_SOLVE && o->out && export_format(o->out) == EXPORT_XDMF;
    if ((kept || xdmf) && !hdf5_built())
        return wrong(name, "%s: built without HDF5: make HDF5=1, package libhdf5-dev",
                     kept ? kept : o->out);
    return -1;
}

/* Of viewfactors: how the matrix is written. */
static int check_matrix(const struct options *o, const char *name)
{
    if (o->command == COMMAND_VIEWFACTORS && !o->out && !o->sensor && !o->product
        && (o->format_given || o->losses || (o->by != BY_FACE && !o->names && !o->json)))
        return wrong(name, "%s is about the matrix, which is written nowhere: add -o FILE",
                     o->format_given ? "--format"
                     : o->losses     ? "--sky"
                                     : "--by");
    if (o->losses && factor_format_square(o->format))
        return wrong(name, "--sky adds columns, and this format takes a square matrix: csv, "
                           "coo, mtx and npz have room for them");
    if (o->copies.count && o->closure == RAD_CLOSURE_RECIPROCAL)
        return wrong(name, "--closure reciprocal makes one matrix of all faces: it does not go "
                           "with --mirror and --repeat");
    return -1;
}

/* Of viewfactors: what is written in place of the matrix. */
static int check_rows_or_columns(const struct options *o, const char *name)
{
    if (o->sensor && (o->format_given || o->closure || o->tolerance_given || o->setting_count))
        return wrong(name, "--sensor writes a table of exact cuts: it does not go with %s",
                     o->format_given      ? "--format"
                     : o->closure         ? "--closure"
                     : o->tolerance_given ? "--tolerance"
                                          : "--set");
    if (o->sensor && o->names)
        return wrong(name, "--sensor's file names the rows itself: it does not go with --names");
    if (o->sensor && o->resume)
        return wrong(name, "--sensor is soon done: it does not go with --resume");
    if (o->product && (!o->out || o->sensor || o->format_given))
        return wrong(name,
                     o->out ? "--product writes columns: it does not go with %s"
                            : "--product needs the name of what it writes: -o FILE%.0s",
                     o->sensor ? "--sensor" : "--format");
    if ((o->sensor || o->product) && o->out && factor_format_of(o->out) != FACTOR_CSV)
        return wrong(name, "%s writes a table as text, and the name %s says matrix: name it .csv",
                     o->sensor ? "--sensor" : "--product", o->out);
    if ((o->sensor || o->product) && (o->by != BY_FACE || o->losses))
        return wrong(name, "%s writes no matrix: it does not go with %s",
                     o->sensor ? "--sensor" : "--product", o->losses ? "--sky" : "--by");
    if (o->product && o->closure == RAD_CLOSURE_RECIPROCAL)
        return wrong(name, "--closure reciprocal needs the whole matrix: it does not go with "
                           "--product");
    return -1;
}

static int check_accuracy(const struct options *o, const char *name)
{
    if (o->accuracy > 0 && (o->no_errors || o->no_correct))
        return wrong(name, "--accuracy mends and measures: it does not go with %s",
                     o->no_errors ? "--no-errors" : "--no-correct");
    if (o->command == COMMAND_SOLVE && o->limit_seconds && !(o->accuracy > 0))
        return wrong(name, "--limit-seconds is of --accuracy: add --accuracy 1%%");
    if ((o->scale > 0 || o->no_links) && o->accuracy > 0)
        return wrong(name, "--accuracy chooses the scale: it does not go with --scale");
    return -1;
}

/* What is about links says nothing where there are none. */
static int check_no_links(const struct options *o, const char *name)
{
    const struct {
        int given;
        const char *option, *does;
    } about[] = {
        {o->errors == ERRORS_ALL, "--errors=all", "accounts for links"},
        {o->closure == RAD_CLOSURE_ROWS, "--closure", "scales what links bring"},
        {o->tolerance_given, "--tolerance", "ends sweeps over links"},
        {o->solver != RAD_SOLVER_GAUSS_SEIDEL, "--solver", "sweeps over links"},
        {o->projection != RAD_PROJECTION_GALERKIN, "--projection", "is of links"},
        {o->oracle && strcmp(o->oracle, RAD_DEFAULT_ORACLE) != 0, "--oracle", "makes links"},
        {o->setting_count > 0, "--set", "is for an oracle, which makes links"},
        {o->params != NULL, "--params", "is for an oracle, which makes links"},
        {o->replacement_count > 0, "--replace", "is for an oracle, which makes links"},
        {o->trace != NULL, "--trace", "watches links being made"},
        {o->statistics != NULL, "--statistics", "counts how links are made"},
        {o->checkpoint != NULL, "--checkpoint", "keeps links"},
        {o->restart != NULL, "--restart", "takes links from a file"}};
    for (size_t i = 0; o->no_links && i < sizeof about / sizeof *about; i++)
        if (about[i].given)
            return wrong(name, "%s %s: it does not go with --scale none", about[i].option,
                         about[i].does);
    return -1;
}

static int check_solver(const struct options *o, const char *name)
{
    if (!radHasSolver(o->solver))
        return wrong(name, "--solver petsc: this command was built without PETSc; build it by "
                           "make PETSC=1, or take another solver");
    if (o->basis == RAD_BASIS_LINEAR && !may_slope(o))
        return wrong(name, "--basis linear goes with --projection galerkin, and with --solver "
                           "gauss-seidel or jacobi");
    return -1;
}

static int check_picture(const struct options *o, const char *name)
{
    if (o->mesh && !o->image && !o->image_error)
        return wrong(name, "--mesh is for a picture: add --image FILE.png or --image-error "
                           "FILE.png");
    if (o->size_given && !o->image && !o->image_error && !o->view_given)
        return wrong(name, "--size is for a picture: add --image FILE.png or --image-error "
                           "FILE.png");
    if (o->gather >= 0 && !o->image)
        return wrong(name, "--gather is for a picture: add --image FILE.png");
    return -1;
}

static int check_errors(const struct options *o, const char *name)
{
    if (o->correct && o->no_correct)
        return wrong(name, "--correct and --no-correct contradict each other");
    if (o->no_errors && (o->errors || o->image_error))
        return wrong(name, "--no-errors and %s contradict each other",
                     o->errors ? "--errors" : "--image-error");
    if (o->errors != ERRORS_ALL
        && (o->account.reflectance_error > 0 || o->account.exitance_error > 0))
        return wrong(name, "--reflectance-error and --exitance-error are for the account of "
                           "error: add --errors=all");
    return -1;
}

/* What follows from other options where it is not given itself. */
static void follow_from_others(struct options *o)
{
    if (o->out && o->command == COMMAND_VIEWFACTORS && !o->format_given)
        o->format = factor_format_of(o->out);
    if ((o->statistics || o->trace) && !o->release_given)
        o->release = RAD_RELEASE_DAG;
    if ((o->command == COMMAND_SOLVE || o->command == COMMAND_TUNE) && !o->basis_given
        && may_slope(o))
        o->basis = RAD_BASIS_LINEAR;
    o->choose_scale = o->command == COMMAND_SOLVE && strcmp(o->oracle, RAD_DEFAULT_ORACLE) == 0
                      && !o->setting_count && !o->params && !o->replacement_count && !o->trace
                      && !o->statistics && !o->no_correct && !(o->accuracy > 0)
                      && o->basis == RAD_BASIS_LINEAR;
}

/* What no option says by itself. Returns -1, or the exit status. */
static int check_together(struct options *o)
{
    static int (*const checks[])(const struct options *, const char *) = {
        check_needed,   check_watching, check_checkpoints, check_matrix,  check_rows_or_columns,
        check_accuracy, check_no_links, check_solver,      check_picture, check_errors};
    int status = -1;
    follow_from_others(o);
    for (size_t i = 0; i < sizeof checks / sizeof *checks && status < 0; i++)
        status = checks[i](o, command_rows[o->command].name);
    return status;
}

int options_parse(struct options *o, int count, char **arguments)
{
    int status = -1;
    memset(o, 0, sizeof *o);
    o->threads = thread_pool_processors();
    o->gather = -1;
    int words = count > 1 ? command_of(count - 1, arguments + 1, &o->command) : 0;
    if (!words)
        return without_command(count, arguments);
    for (int i = 0; i < option_row_count && status < 0; i++)
        if (option_rows[i].commands >> o->command & 1 && option_rows[i].preset)
            status = read_value(o, &option_rows[i], option_rows[i].preset);
    o->size_given = o->tolerance_given = 0;
    struct option longs[OPTIONS_MAX];
    char shorts[OPTIONS_MAX];
    options_of(o->command, longs, shorts);
    count -= words;
    arguments += words;
    optind = 1;
    opterr = 0;
    int number;
    while (status < 0 && (number = getopt_long(count, arguments, shorts, longs, NULL)) != -1)
        status = read_argument(o, number, arguments[optind - 1]);
    for (; status < 0 && optind < count; optind++)
        status = set_scene(o, arguments[optind]);
    return status < 0 ? check_together(o) : status;
}

int options_outputs(const struct options *o, const char *paths[OUTPUTS_MAX])
{
    int n = 0;
    for (int i = 0; i < option_row_count; i++)
        if (option_rows[i].output && option_rows[i].commands >> o->command & 1) {
            paths[n] = *(const char *const *)(const void *)((const char *)o + option_rows[i].field);
            n += paths[n] != NULL;
        }
    return n;
}

void options_free(struct options *o)
{
    free(o->settings);
    free(o->scenes);
    free(o->replacements);
    free(o->plugins);
    o->replacements = NULL;
    o->plugins = NULL;
    o->settings = NULL;
    o->scenes = NULL;
}
