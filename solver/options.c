/* options.c - parse the command line. One table holds every option: the parser and the help derive from it.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <limits.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include "util/ends_with.h"
#include "output/export.h"
#include "options.h"
#include "kernel/constants.h"

enum key { ORACLE, RELEASE, SET, CLUSTERS, TOLERANCE, ITERATIONS, JACOBI, CLOSURE, STATISTICS, THREADS, TWO_SIDED, OUT, IMAGE, SIZE, VIEW, MESH,
           FACES, JSON, FORMAT, NAMES, REPEATS, ONLY, REFERENCE, THRESHOLDS, RAYS, CHART, QUIET, HELP, VERSION };

#define CLUSTERING_WORD(constant, name, help) " " #name
#define CLUSTERING_NAMES CLUSTERINGS(CLUSTERING_WORD)

/* solve, compare, viewfactors, study stability, study visibility, study clustering */
enum { S = 1, C = 2, V = 4, FAILURES = 8, SIGHT = 16, TREES = 32, ALL = S | C | V };

static const struct option {
    enum key key;
    const char *name, *argument;
    int commands;
    const char *help;
} table[] = {
    { ORACLE, "--oracle", "NAME|FILE.dag", S | C | TREES, "the refinement oracle (default " DEFAULT_ORACLE "; of `compare` " DEFAULT_BY_HAND ", which has a\n"
      "                             release by hand; see `radiosity oracles`)" },
    { RELEASE, "--release", "flat|dag|hand", S | TREES, "compiled graph (default), interpreted graph, or written by hand (bf, bf_guarded)" },
    { SET, "--set", "PARAM=VALUE", ALL | SIGHT | TREES, "set a parameter of the oracle; may be given many times" },
    { CLUSTERS, "--clusters", "NAME", S, "what groups the faces into clusters (default sah, below 1,000 halves):" CLUSTERING_NAMES },
    { TOLERANCE, "--tolerance", "X", ALL | TREES, "relative error of radiosity that iteration may leave (default 1e-4); viewfactors: the\n"
      "                             error of a row's sum to work for (default 3e-4)" },
    { ITERATIONS, "--iterations", "N", S | C | TREES, "sweeps per solve at the most (default 100000)" },
    { JACOBI, "--jacobi", NULL, S | C, "Jacobi sweeps instead of block Gauss-Seidel" },
    { CLOSURE, "--closure", "none|rows|reciprocal", ALL | TREES, "rows: scale what each element sees to 1 in a closed scene, to at most 1 in an\n"
      "                             open one; power is then no longer exchanged alike both ways (default none);\n"
      "                             reciprocal, of viewfactors: the same, and A_i F_ij stays A_j F_ji" },
    { STATISTICS, "--statistics", "FILE", S, "how often each answer of the oracle's graph was given: text, .csv, .json; - is\n"
      "                             standard output. The graph is interpreted; what it decides is the same" },
    { THREADS, "--threads", "N", ALL | FAILURES | SIGHT | TREES, "threads to use (default: all processors); the result is the same" },
    { TWO_SIDED, "--two-sided", NULL, ALL | SIGHT | TREES, "every face has two sides, not only materials named *_2s" },
    { OUT, "-o", "FILE", S | V | FAILURES | SIGHT | TREES, "solve: the solved mesh, .ply .gltf .glb or .obj; viewfactors: the matrix; study: the table" },
    { IMAGE, "--image", "FILE.png", S, "a picture of the solution" },
    { SIZE, "--size", "WxH", S, "its size in pixels (default 1024x768)" },
    { VIEW, "--view", "X,Y,Z:X,Y,Z[:FOV]", S, "eye, the point looked at, vertical field of view in degrees (70); of the picture,\n"
      "                             and of an oracle that asks what is important to it" },
    { MESH, "--mesh", NULL, S, "draw the edges of the elements over the picture" },
    { FACES, "--faces", "FILE.csv", S, "area means per face of the scene file: E, rho, H, B per band" },
    { FORMAT, "--format", "csv|coo|mtx", V, "of -o: all numbers row by row (default), `i,j,F` lines from 0, or Matrix Market;\n"
      "                             the last two leave out zeros" },
    { NAMES, "--names", "FILE", V, "a name for each row of the matrix, one in a line: material.face" },
    { JSON, "--json", "FILE", ALL, "counts, power, residual, seconds; - is standard output" },
    { REPEATS, "--repeats", "N", C, "timed runs of each release (default 3)" },
    { ONLY, "--only", "CASE", FAILURES | TREES, "one case of `study stability`, or one strategy of `study clustering`" },
    { REFERENCE, "--reference", "FACES.csv", TREES, "radiosities to measure errors by, a table as `solve --faces` writes it" },
    { THRESHOLDS, "--thresholds", "A,B,...", SIGHT, "projected areas below which visibility is tested (2,3,5,7.5,10,15)" },
    { RAYS, "--rays", "N,M,...", SIGHT, "the rays whose answers are held against the reference (4,16,64)" },
    { CHART, "--chart", "FILE", SIGHT | TREES, "a chart of the study, .svg or .png" },
    { QUIET, "-q", NULL, ALL | FAILURES | SIGHT | TREES, "no progress, no summary, no warnings" },
    { HELP, "--help", NULL, ALL | FAILURES | SIGHT | TREES, "this text" },
    { VERSION, "--version", NULL, ALL | FAILURES | SIGHT | TREES, "the version" },
};

enum { OPTIONS = sizeof table / sizeof *table };

/* The options that any of `commands` takes. */
static void print_options(FILE *out, int commands)
{
    int i;
    for (i = 0; i < OPTIONS; i++) {
        const struct option *p = &table[i];
        char left[64];
        if (!(p->commands & commands))
            continue;
        snprintf(left, sizeof left, "%s%s%s", p->name, p->argument ? " " : "", p->argument ? p->argument : "");
        fprintf(out, "  %-26s %s\n", left, p->help);
    }
}

void options_print_study_help(FILE *out)
{
    int i;
    fputs("usage: radiosity study stability [options]         where methods fail, and by how much\n"
          "       radiosity study visibility SCENE [options]  how often few rays are wrong about visibility\n"
          "       radiosity study clustering SCENE [options]  what ways of grouping faces cost and give\n"
          "\n"
          "stability makes small scenes whose answer is known and on which published methods fail: elements that\n"
          "share an edge, slivers, a blocker smaller than the gaps between rays, a bright furnace. Rows are the\n"
          "scenes, columns the methods. A cell is the method's error, or `fails: why` when the error is above the\n"
          "row's tolerance. The default oracle passes every row; that others fail is the finding, so the exit\n"
          "status is 1 only when a method that must pass does not.\n"
          "\n"
          "    radiosity study stability\n"
          "    radiosity study stability --only tiny_blocker\n"
          "    radiosity study stability -o stability.md      # or .csv: every cell with error and tolerance\n"
          "\n"
          "visibility classifies the pairs of a scene by few rays, and again by so many that the answer is\n"
          "trusted, as in section 5 of Turbet and Sillion:\n"
          "\n"
          "    radiosity study visibility examples/scenes/td.obj --thresholds 2,3,5,7.5,10,15 --rays 4,16,64\n"
          "\n"
          "clustering solves a scene once for each strategy of --clusters and compares time, links, rays, memory and\n"
          "error, by the power imbalance or, better, by a reference:\n"
          "\n"
          "    radiosity study clustering examples/scenes/sejour.obj --reference sejour.csv -o table.md   # or .csv\n"
          "\n", out);
    for (i = 0; i < CLUSTERING_COUNT; i++)
        fprintf(out, "    %-8s %s\n", clustering_names[i], clustering_helps[i]);
    fputs("\n", out);
    print_options(out, FAILURES | SIGHT | TREES);
}

void options_print_help(FILE *out)
{
    fputs("usage: radiosity solve SCENE [options]        solve a scene; without options: print a summary\n"
          "       radiosity compare SCENE [options]      run an oracle's releases side by side, " DEFAULT_BY_HAND "'s\n"
          "                                              unless --oracle names another\n"
          "       radiosity viewfactors SCENE [options]  the matrix of face-to-face view factors\n"
          "       radiosity study WORD [SCENE] [options] stability, visibility, clustering: see `radiosity study --help`\n"
          "       radiosity oracles                      list the built-in oracles and their parameters\n"
          "\n"
          "Light in a closed scene of diffuse surfaces, by hierarchical radiosity. SCENE is OBJ+MTL, PLY,\n"
          "glTF, Collada or whatever Assimp reads, in metres; a material's diffuse colour is its reflectance,\n"
          "its emissive colour its exitance in W/m2. Faces have one side unless the material's name ends in\n"
          "_2s. What a solution costs and how good it is, the oracle's parameters decide:\n"
          "\n"
          "    radiosity solve room.obj --image room.png\n"
          "    radiosity solve room.obj --set relative=0.02 --faces room.csv\n"
          "    radiosity solve room.obj --oracle bf --set relative=0 --set epsilon=0.02   # the BF of 1991\n"
          "\n", out);
    print_options(out, ~0);
    fputs("\nMessages go to standard error. Exit status: 0 done, 1 the scene, an oracle or a file is at fault\n"
          "(nothing half-written is left), or compared releases differ; 2 wrong usage.\n", out);
}

static int wrong(const char *what, const char *which)
{
    fprintf(stderr, "radiosity: error: %s%s%s; see radiosity --help\n", what, *which ? " " : "", which);
    return 2;
}

static int whole_number(const char *text, int low, int high, int *value)
{
    char *end;
    long n;
    errno = 0;
    n = strtol(text, &end, 10);
    if (end == text || *end || errno || n < low || n > high)
        return -1;
    *value = (int)n;
    return 0;
}

/* Rising numbers from low to high, parted by commas. Returns how many, or -1. */
static int rising_list(const char *text, double low, double high, double list[STUDY_LIST])
{
    int n = 0;
    for (;;) {
        char *end;
        double x = strtod(text, &end);
        if (end == text || n == STUDY_LIST || !(x >= low && x <= high) || (n && x <= list[n - 1]))
            return -1;
        list[n++] = x;
        if (!*end)
            return n;
        if (*end != ',')
            return -1;
        text = end + 1;
    }
}

/* The numbers of rays that visibility is asked of; the graph's tools round others up. */
static int power_of_four(double x)
{
    while (x > 1)
        x /= 4;
    return x == 1;
}

static int size(const char *text, int *width, int *height)
{
    char *end;
    long w = strtol(text, &end, 10), h = *end == 'x' ? strtol(end + 1, &end, 10) : 0;
    if (*end || w < 1 || h < 1 || w > 16384 || h > 16384)
        return -1;
    *width = (int)w;
    *height = (int)h;
    return 0;
}

static int take(struct options *o, const struct option *p, char *value)
{
    double list[STUDY_LIST];
    char *end;
    int i;
    switch (p->key) {
    case ORACLE:
        o->oracle = value;
        return 0;
    case RELEASE:
        for (i = 0; i < RELEASES && strcmp(value, release_names[i]) != 0; i++)
            ;
        if (i == RELEASES)
            return wrong("--release knows flat, dag and hand, not", value);
        o->release = (enum release)i;
        o->release_given = 1;
        return 0;
    case SET:
        o->settings[o->setting_count++] = value;
        return 0;
    case CLUSTERS:
        o->clusters = 1 + clustering_of(value);
        return o->clusters < 1 ? wrong("--clusters knows" CLUSTERING_NAMES ", not", value) : 0;
    case TOLERANCE:
        o->tolerance = strtod(value, &end);
        if (end == value || *end || !(o->tolerance > 0) || !(o->tolerance < 1))
            return wrong("--tolerance takes a number above 0 and below 1, not", value);
        return 0;
    case ITERATIONS:
        return whole_number(value, 1, INT_MAX, &o->iterations) < 0 ? wrong("--iterations takes a whole number from 1, not", value) : 0;
    case CLOSURE:
        for (i = 0; i < CLOSURES && strcmp(value, closure_names[i]) != 0; i++)
            ;
        if (i == CLOSURES || (i == CLOSURE_RECIPROCAL && o->command != COMMAND_VIEWFACTORS))
            return wrong(o->command == COMMAND_VIEWFACTORS ? "--closure knows none, rows and reciprocal, not" : "--closure knows none and rows, not", value);
        o->closure = (enum closure)i;
        return 0;
    case FORMAT:
        for (i = 0; i < FACTOR_FORMATS && strcmp(value, factor_format_names[i]) != 0; i++)
            ;
        if (i == FACTOR_FORMATS)
            return wrong("--format knows csv, coo and mtx, not", value);
        o->format = (enum factor_format)i;
        return 0;
    case NAMES:
        o->names = value;
        return 0;
    case STATISTICS:
        o->statistics = value;
        return 0;
    case THREADS:
        return whole_number(value, 1, 1024, &o->threads) < 0 ? wrong("--threads takes a whole number from 1 to 1024, not", value) : 0;
    case REPEATS:
        return whole_number(value, 1, 1000, &o->repeats) < 0 ? wrong("--repeats takes a whole number from 1 to 1000, not", value) : 0;
    case SIZE:
        return size(value, &o->width, &o->height) < 0
                   ? wrong("--size takes WxH, each 1 to 16384, not", value) : 0;
    case VIEW:
        o->view_given = 1;
        return view_parse(value, &o->view) < 0
                   ? wrong("--view takes X,Y,Z:X,Y,Z[:FOV], two different points and 1 to 170 degrees, not", value) : 0;
    case OUT:
        o->out = value;
        return 0;
    case IMAGE:
        o->image = value;
        return 0;
    case FACES:
        o->faces = value;
        return 0;
    case JSON:
        o->json = value;
        return 0;
    case MESH:
        o->mesh = 1;
        return 0;
    case JACOBI:
        o->jacobi = 1;
        return 0;
    case TWO_SIDED:
        o->two_sided = 1;
        return 0;
    case ONLY:
        o->only = value;
        return 0;
    case REFERENCE:
        o->reference = value;
        return 0;
    case CHART:
        o->chart = value;
        return ends_with(value, ".svg") || ends_with(value, ".png") ? 0 : wrong("--chart takes a file named .svg or .png, not", value);
    case THRESHOLDS:
        o->threshold_count = rising_list(value, 1e-300, 1e300, o->thresholds);
        return o->threshold_count < 0 ? wrong("--thresholds takes rising numbers from 1e-300 to 1e300 parted by commas, 32 at the most, not", value) : 0;
    case RAYS:
        o->ray_count = rising_list(value, 4, 1024, list);
        for (i = 0; i < o->ray_count; i++) {
            o->rays[i] = (int)list[i];
            if (!power_of_four(list[i]))
                o->ray_count = -1;
        }
        return o->ray_count < 0 ? wrong("--rays takes some of 4,16,64,256,1024, rising, parted by commas, not", value) : 0;
    case QUIET:
        o->quiet = 1;
        return 0;
    case HELP:
        o->command = o->command == COMMAND_STUDY ? COMMAND_STUDY_HELP : COMMAND_HELP;
        return 0;
    case VERSION:
        o->command = COMMAND_VERSION;
        return 0;
    }
    return 0;
}

/* The option that an argument names; `--name=value` gives its value too. */
static const struct option *find(const char *argument, char **value)
{
    int i;
    *value = NULL;
    for (i = 0; i < OPTIONS; i++) {
        size_t n = strlen(table[i].name);
        if (strncmp(argument, table[i].name, n) != 0)
            continue;
        if (!argument[n])
            return &table[i];
        if (argument[n] == '=' && table[i].name[1] == '-') {
            *value = (char *)argument + n + 1;
            return &table[i];
        }
    }
    if (strcmp(argument, "-h") == 0)
        return find("--help", value);
    return NULL;
}

static int command_of(const char *word, enum command *command)
{
    static const char *const names[] = { "solve", "compare", "viewfactors", "oracles", "study" };
    int i;
    for (i = 0; i < 5; i++)
        if (strcmp(word, names[i]) == 0) {
            *command = (enum command)i;
            return 0;
        }
    return -1;
}

/* `radiosity study WORD`: which study. Returns 0 or the exit status. */
static int study_of(struct options *o, const char *word)
{
    static const char *const names[] = { "stability", "visibility", "clustering" };
    static const double thresholds[] = { 2, 3, 5, 7.5, 10, 15 };
    static const int rays[] = { 4, 16, 64 };
    int i;
    if (!word || !*word)
        return wrong("study what? `radiosity study --help` tells", "");
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        o->command = COMMAND_STUDY_HELP;
        return 0;
    }
    for (i = 0; i < 3 && strcmp(word, names[i]) != 0; i++)
        ;
    if (i == 3)
        return wrong("study knows stability, visibility and clustering, not", word);
    o->study = (enum study)i;
    memcpy(o->thresholds, thresholds, sizeof thresholds);
    memcpy(o->rays, rays, sizeof rays);
    o->threshold_count = sizeof thresholds / sizeof *thresholds;
    o->ray_count = sizeof rays / sizeof *rays;
    return 0;
}

/* The bits of the table's options that go with the command. */
static int takes(const struct options *o)
{
    return o->command < COMMAND_ORACLES ? 1 << o->command
         : o->command != COMMAND_STUDY  ? ~0
         : o->study == STUDY_STABILITY  ? FAILURES
         : o->study == STUDY_CLUSTERING ? TREES : SIGHT;
}

int options_parse(struct options *o, int count, char **arguments)
{
    int i = 2, only_files = 0, status;
    memset(o, 0, sizeof *o);
    o->oracle = DEFAULT_ORACLE;
    o->tolerance = 1e-4;
    o->iterations = 100000;
    o->threads = omp_get_num_procs();
    o->repeats = 3;
    o->width = 1024;
    o->height = 768;
    o->settings = calloc((size_t)count + 1, sizeof *o->settings);
    if (!o->settings)
        return wrong("out of memory", "");
    if (count < 2 || !*arguments[1])
        return wrong("no command is given", "");
    if (arguments[1][0] == '-') {
        char *value;
        const struct option *p = find(arguments[1], &value);
        if (!p || (p->key != HELP && p->key != VERSION))
            return wrong("a command comes first, not", arguments[1]);
        return take(o, p, NULL);
    }
    if (strcmp(arguments[1], "help") == 0) {
        o->command = COMMAND_HELP;
        return 0;
    }
    if (command_of(arguments[1], &o->command) < 0)
        return wrong("unknown command", arguments[1]);
    if (o->command == COMMAND_COMPARE)
        o->oracle = DEFAULT_BY_HAND;
    if (o->command == COMMAND_VIEWFACTORS)
        o->tolerance = EXCHANGE_TOLERANCE;
    if (o->command == COMMAND_STUDY) {
        status = study_of(o, arguments[i]);
        if (status || o->command == COMMAND_STUDY_HELP)
            return status;
        i++;
    }
    for (; i < count; i++) {
        char *value;
        const struct option *p;
        if (only_files || arguments[i][0] != '-' || !arguments[i][1]) {
            if (o->scene)
                return wrong("more than one scene:", arguments[i]);
            if (!*arguments[i])
                return wrong("the scene's name is empty", "");
            o->scene = arguments[i];
            continue;
        }
        if (strcmp(arguments[i], "--") == 0) {
            only_files = 1;
            continue;
        }
        p = find(arguments[i], &value);
        if (!p)
            return wrong("unknown option", arguments[i]);
        if (!(p->commands & takes(o))) {
            char command[64];
            snprintf(command, sizeof command, "%s%s%s has no option", arguments[1], o->command == COMMAND_STUDY ? " " : "",
                     o->command == COMMAND_STUDY ? arguments[2] : "");
            return wrong(command, p->name);
        }
        if (!p->argument && value)
            return wrong("no value goes with", p->name);
        if (p->argument && !value) {
            if (i + 1 >= count)
                return wrong("a value is missing after", p->name);
            value = arguments[++i];
        }
        if (p->argument && !*value) {
            char what[96];
            snprintf(what, sizeof what, "%s takes %s, not an empty value", p->name, p->argument);
            return wrong(what, "");
        }
        status = take(o, p, value);
        if (status)
            return status;
        if (o->command >= COMMAND_HELP)
            return 0;
    }
    if (o->command == COMMAND_ORACLES)
        return o->scene ? wrong("oracles takes no scene, but got", o->scene) : 0;
    if (o->command == COMMAND_STUDY && o->study == STUDY_CLUSTERING && o->only && clustering_of(o->only) < 0)
        return wrong("--only knows" CLUSTERING_NAMES " here, not", o->only);
    if (o->command == COMMAND_STUDY && o->study != STUDY_VISIBILITY && o->out && !ends_with(o->out, ".csv") && !ends_with(o->out, ".md"))
        return wrong("-o takes a file named .csv or .md, not", o->out);
    if (o->command == COMMAND_STUDY && o->study == STUDY_VISIBILITY && o->out && !ends_with(o->out, ".csv"))
        return wrong("-o takes a file named .csv, not", o->out);
    if (o->command == COMMAND_STUDY && o->study == STUDY_STABILITY)
        return o->scene ? wrong("study stability makes its own scenes, but got", o->scene) : 0;
    if (!o->scene)
        return wrong("no scene is given", "");
    if (o->command == COMMAND_SOLVE && o->out && export_format(o->out) == EXPORT_UNKNOWN)
        return wrong("-o takes a file named .ply, .gltf, .glb or .obj, not", o->out);
    if (o->statistics && o->release_given && o->release != RELEASE_DAG)
        return wrong("--statistics counts what the interpreted graph does: it takes no --release but dag, not", release_names[o->release]);
    if (o->statistics)
        o->release = RELEASE_DAG;
    if (o->statistics && o->json && strcmp(o->statistics, "-") == 0 && strcmp(o->json, "-") == 0)
        return wrong("--statistics - and --json - would mix on standard output: give one of them a file", "");
    if (o->mesh && !o->image)
        return wrong("--mesh is for a picture: add --image FILE.png", "");
    return 0;
}

void options_free(struct options *o)
{
    free(o->settings);
    o->settings = NULL;
}
