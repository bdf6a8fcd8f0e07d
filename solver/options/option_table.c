/* option_table.c - see option_table.h: how values are read, then the rows.
 * SPDX-License-Identifier: MIT */
#include "options/option_table.h"
#include "util/array.h"
#include "util/decimal.h"
#include "util/ends_with.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- readers */

static void *field_of(struct options *o, const struct option_row *row)
{
    return (char *)o + row->field;
}

static int read_text(struct options *o, const struct option_row *row, const char *value)
{
    *(const char **)field_of(o, row) = value;
    return 0;
}

/* A file to write; standard output only where several of the file's kinds are texts. */
static int read_output(struct options *o, const struct option_row *row, const char *value)
{
    return strcmp(value, "-") == 0 && !row->standard ? -1 : read_text(o, row, value);
}

static int read_flag(struct options *o, const struct option_row *row, const char *value)
{
    (void)value;
    *(int *)field_of(o, row) = 1;
    return 0;
}

/* A file by how its name ends. */
static int read_ending(struct options *o, const struct option_row *row, const char *value)
{
    const char *const *ending = row->words;
    while (*ending && !ends_with_any_case(value, *ending))
        ending++;
    return *ending ? read_text(o, row, value) : -1;
}

static int read_whole(struct options *o, const struct option_row *row, const char *value)
{
    errno = 0;
    char *end;
    long n = strtol(value, &end, 10);
    if (end == value || *end || errno || n < row->low || n > row->high)
        return -1;
    *(int *)field_of(o, row) = (int)n;
    return 0;
}

static int read_scale(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    char *end;
    o->no_links = strcmp(value, "none") == 0;
    if (o->no_links)
        return 0;
    o->scale = decimal(value, &end);
    return end == value || *end || !(o->scale >= 1e-6 && o->scale <= 1e6) ? -1 : 0;
}

static int read_tolerance(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    char *end;
    o->tolerance = decimal(value, &end);
    o->tolerance_given = 1;
    return end == value || *end || !(o->tolerance > 0 && o->tolerance < 1) ? -1 : 0;
}

/* --errors alone, or --errors=all. */
static int read_errors(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    o->errors = value ? ERRORS_ALL : ERRORS_MEASURED;
    return value && strcmp(value, "all") != 0 ? -1 : 0;
}

/* A share from 0, or with low 1 above it, below 1; or the same in per cent. */
static int read_share(struct options *o, const struct option_row *row, const char *value)
{
    char *end;
    double share = decimal(value, &end);
    int percent = end != value && strcmp(end, "%") == 0;
    share /= percent ? 100 : 1;
    if (end == value || end[percent] || !(share >= 0 && share < 1) || (row->low && !(share > 0)))
        return -1;
    *(double *)field_of(o, row) = share;
    return 0;
}

/* "[l1:|l2:|power:]X[%]": a share of the reflected light. */
static int read_accuracy(struct options *o, const struct option_row *row, const char *value)
{
    o->norm = ACCURACY_L1;
    for (int i = 0; norm_words[i]; i++) {
        size_t length = strlen(norm_words[i]);
        if (strncmp(value, norm_words[i], length) == 0 && value[length] == ':') {
            o->norm = (enum accuracy_norm)i;
            value += length + 1;
            break;
        }
    }
    return read_share(o, row, value);
}

/* KEY=N,KEY=N: fields of struct RadLimits. */
static int read_limits(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    const struct {
        const char *key;
        uint64_t *limit, most;
    } keys[] = {{"depth=", NULL, 250},
                {"elements=", &o->limits.elements, UINT32_MAX},
                {"links=", &o->limits.links, (uint64_t)1 << 53},
                {"pairs=", &o->limits.pairs, (uint64_t)1 << 53},
                {"rounds=", &o->limits.rounds, (uint64_t)1 << 53}};
    for (;;) {
        size_t k = 0, count = sizeof keys / sizeof *keys;
        while (k < count && strncmp(value, keys[k].key, strlen(keys[k].key)) != 0)
            k++;
        char *end;
        double n = k < count ? decimal(value + strlen(keys[k].key), &end) : 0;
        if (!(n >= 1 && n <= (double)keys[k < count ? k : 0].most) || n != (double)(uint64_t)n)
            return -1;
        if (keys[k].limit)
            *keys[k].limit = (uint64_t)n;
        else
            o->limits.depth = (int)n;
        if (*end != ',')
            return *end ? -1 : 0;
        value = end + 1;
    }
}

static int keep_setting(struct options *o, const char *value)
{
    if (array_reserve(&o->settings, (size_t)o->setting_count + 1, &o->setting_capacity,
                      sizeof *o->settings)
        < 0)
        return -1;
    o->settings[o->setting_count++] = (char *)(uintptr_t)value;
    return 0;
}

/* What of it the oracle has no say in is wrong usage; the rest is asked when there is one. */
static int read_setting(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    const char *equals = strchr(value, '=');
    return equals && equals != value ? keep_setting(o, value) : -1;
}

int option_range(const char *text, double *low, double *high)
{
    char *end, *last;
    *low = decimal(text, &end);
    if (end == text || *end != ':')
        return -1;
    *high = decimal(end + 1, &last);
    return last == end + 1 || *last || !(*low > 0) || !(*high >= *low) || !isfinite(*high) ? -1 : 0;
}

/* NAME or NAME=LOW:HIGH. */
static int read_fitted(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    const char *equals = strchr(value, '=');
    double low, high;
    return *value && (!equals || option_range(equals + 1, &low, &high) == 0)
               ? keep_setting(o, value)
               : -1;
}

static int read_replacement(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    if (array_reserve(&o->replacements, (size_t)o->replacement_count + 1, &o->replacement_capacity,
                      sizeof *o->replacements)
        < 0)
        return -1;
    o->replacements[o->replacement_count++] = (char *)(uintptr_t)value;
    return 0;
}

static int read_plugin(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    if (array_reserve(&o->plugins, (size_t)o->plugin_count + 1, &o->plugin_capacity,
                      sizeof *o->plugins)
        < 0)
        return -1;
    o->plugins[o->plugin_count++] = (char *)(uintptr_t)value;
    return 0;
}

/* The words that a choice is made of. */
static const char *const *words_of(const struct option_row *row)
{
    return row->words ? row->words : radGetClusteringNames();
}

/* The number of the word, or -1. */
static int word_number(const struct option_row *row, const char *value)
{
    const char *const *words = words_of(row);
    for (int i = 0; words[i]; i++)
        if (strcmp(words[i], value) == 0)
            return i;
    return -1;
}

/* These choices are enumerations of other headers, in whose order the words stand. */
static int read_release(struct options *o, const struct option_row *row, const char *value)
{
    int n = word_number(row, value);
    o->release = (enum RadRelease)n;
    o->release_given = 1;
    return n < 0 ? -1 : 0;
}

static int read_closure(struct options *o, const struct option_row *row, const char *value)
{
    int n = word_number(row, value);
    o->closure = (enum RadClosure)n;
    return n < 0 ? -1 : 0;
}

static int read_solver(struct options *o, const struct option_row *row, const char *value)
{
    int n = word_number(row, value);
    o->solver = (enum RadSolver)n;
    return n < 0 ? -1 : 0;
}

static int read_projection(struct options *o, const struct option_row *row, const char *value)
{
    int n = word_number(row, value);
    o->projection = (enum RadProjection)n;
    return n < 0 ? -1 : 0;
}

static int read_basis(struct options *o, const struct option_row *row, const char *value)
{
    int n = word_number(row, value);
    o->basis = (enum RadBasis)n;
    o->basis_given = 1;
    return n < 0 ? -1 : 0;
}

static int read_format(struct options *o, const struct option_row *row, const char *value)
{
    int n = word_number(row, value);
    o->format = (enum factor_format)n;
    o->format_given = 1;
    return n < 0 ? -1 : 0;
}

static int read_by(struct options *o, const struct option_row *row, const char *value)
{
    int n = word_number(row, value);
    o->by = (enum factor_rows)n;
    return n < 0 ? -1 : 0;
}

/* "AXIS=NUMBER" and what follows it, into the next step. Returns NULL when it is not that. */
static const char *read_axis(struct options *o, const char *value, struct copy_step **step)
{
    char *end;
    if (o->copies.count == COPY_STEPS || *value < 'x' || *value > 'z' || value[1] != '=')
        return NULL;
    *step = &o->copies.steps[o->copies.count++];
    (*step)->axis = *value - 'x';
    (*step)->at = decimal(value + 2, &end);
    return end == value + 2 || !(fabs((*step)->at) <= 1e30) ? NULL : end;
}

static int read_mirror(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    struct copy_step *step;
    const char *end = read_axis(o, value, &step);
    return end && !*end ? 0 : -1;
}

static int read_repeat(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    struct copy_step *step;
    const char *from = read_axis(o, value, &step);
    if (!from || *from != ':' || !(step->at > 0))
        return -1;
    char *end;
    long n = strtol(from + 1, &end, 10);
    step->times = n >= 1 && n <= 1000 ? (int)n : 1;
    return end == from + 1 || *end || n < 1 || n > 1000 ? -1 : 0;
}

static int read_cost(struct options *o, const struct option_row *row, const char *value)
{
    o->cost = word_number(row, value);
    return o->cost < 0 ? -1 : 0;
}

static int read_clustering(struct options *o, const struct option_row *row, const char *value)
{
    return word_number(row, value) < 0 ? -1 : read_text(o, row, value);
}

static int read_size(struct options *o, const struct option_row *row, const char *value)
{
    char *end;
    long w = strtol(value, &end, 10), h = *end == 'x' ? strtol(end + 1, &end, 10) : 0;
    (void)row;
    if (*end || w < 1 || h < 1 || w > 16384 || h > 16384)
        return -1;
    o->width = (int)w;
    o->height = (int)h;
    o->size_given = 1;
    return 0;
}

static int read_view(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    o->view_given = 1;
    return view_parse(value, &o->view);
}

/* Rising numbers from low to high, parted by commas. Returns how many, or -1. */
static int rising_list(const char *text, double low, double high, double list[STUDY_LIST])
{
    for (int n = 0; n < STUDY_LIST; text++) {
        char *end;
        double x = decimal(text, &end);
        if (end == text || !(x >= low && x <= high) || (n && x <= list[n - 1]))
            return -1;
        list[n++] = x;
        if (!*end)
            return n;
        if (*end != ',')
            return -1;
        text = end;
    }
    return -1;
}

static int read_thresholds(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    o->threshold_count = rising_list(value, 1e-300, 1e300, o->thresholds);
    return o->threshold_count < 0 ? -1 : 0;
}

/* Powers of four: the graph's tools round others up. */
static int read_rays(struct options *o, const struct option_row *row, const char *value)
{
    (void)row;
    double list[STUDY_LIST];
    o->ray_count = rising_list(value, 4, 1024, list);
    for (int i = 0; i < o->ray_count; i++) {
        o->rays[i] = (int)list[i];
        while (list[i] > 1)
            list[i] /= 4;
        if (list[i] < 1)
            return -1;
    }
    return o->ray_count < 0 ? -1 : 0;
}

const char *option_takes(const struct option_row *row)
{
    static char text[256];
    const char *const *word = row->read == read_clustering ? words_of(row) : row->words;
    if (!word)
        return row->takes ? row->takes : row->argument;
    int length = snprintf(text, sizeof text, "%s", row->read == read_ending ? "a file named " : "");
    for (int i = 0; word[i]; i++)
        length += snprintf(text + length, sizeof text - (size_t)length, "%s%s",
                           !i            ? ""
                           : word[i + 1] ? ", "
                                         : " or ",
                           word[i]);
    return text;
}

/* ---- the commands */

const struct command_row command_rows[COMMANDS] = {
    [COMMAND_SOLVE] =
        {"solve", "SCENE", "light in a scene: summary, picture, mesh, tables",
         "Solve a scene, print a summary, and write the outputs that are asked for.\n",
         "radiosity solve room.obj -o room.glb --image room.png"},
    [COMMAND_COMPARE] =
        {"compare", "SCENE", "the releases of an oracle, side by side",
         "Solve a scene by all releases of an oracle at once: the graph compiled, compiled\n"
         "for pairs in waves, interpreted, and written by hand where it is. Compare every\n"
         "decision and link bit by bit, then time them. Exit status 1: they differ.\n",
         "radiosity compare room.obj --oracle bf --set epsilon=0.02"},
    [COMMAND_VIEWFACTORS] =
        {"viewfactors", "SCENE", "the matrix of view factors between faces",
         "F_ij is the share of what leaves face i evenly that meets face j, occlusion\n"
         "included. Rows and columns are the faces of the scene file, in its order.\n",
         "radiosity viewfactors room.obj -o factors.csv --closure reciprocal"},
    [COMMAND_REFERENCE] =
        {"reference", "SCENE", "what faces radiate, traced to a stated accuracy",
         "Trace what each face radiates, by particles from the emitters and by paths from\n"
         "the faces, until the standard error of a face's light, mean by area, is a given\n"
         "share of the reflected light; then hold the two against each other. Independent\n"
         "of links and oracles: to judge solutions by, with radiosity error. The table has\n"
         "columns face, area, B_k and se_k, the standard error of B_k. A run that is\n"
         "stopped goes on from FILE.csv.state when it is started again; so does one that\n"
         "has seen no light reflected (exit status 3).\n",
         "radiosity reference room.obj -o ref.csv --accuracy 0.5%"},
    [COMMAND_ERROR] =
        {"error", "FACES.csv REF.csv", "how far a table of faces is from a reference",
         "Compare B of each face, as solve --faces wrote it, with a reference: made by\n"
         "radiosity reference, or a finer solve. Errors are shares of the light that the\n"
         "reference reflects, per band and in all: of the power (above 0: too bright), in\n"
         "L1, L2 and Linf; beside them what the reference's noise alone would look like,\n"
         "and the faces that hold most of the error.\n",
         "radiosity error faces.csv ref.csv"},
    [COMMAND_TUNE] =
        {"tune", "ORACLE SCENE...", "fit an oracle's parameters to scenes",
         "Fit thresholds of an oracle, built in or FILE.dag, to scenes: least becomes the\n"
         "mean over scenes of log(cost (1 + (error/E)^2)^(P/2)), the error that of links\n"
         "alone, by faces (L1), against particles. Then each scene is left out, fitted\n"
         "without, and tried, which says how near the shipped values fits shall stay: so\n"
         "that no scene left out needs more than 1.5 times what it needs where used, cost\n"
         "max(1, error/E)^2. Exit status 3: no such fit. Ctrl-C: the best so far.\n",
         "radiosity tune mine.dag room.obj hall.obj shop.obj -o mine.dag"},
    [COMMAND_STABILITY] =
        {"study stability", "", "where methods fail, and by how much",
         "Small scenes whose answer is known and on which published methods fail:\n"
         "elements that share an edge, slivers, a blocker smaller than the gaps between\n"
         "rays, a bright furnace. Rows are the scenes, columns the methods; a cell is the\n"
         "method's error, and `fails: why` when that is above the row's tolerance, one for\n"
         "all methods. `order p`: the error falls as 1/n^p, fitted to three errors; n is\n"
         "the links of an oracle (thresholds times 4, 1 and 1/4), the rays of a pair, or\n"
         "the elements of a face (each times 1, 4 and 16); -: at rounding, or nothing to\n"
         "refine. Last come the rows that the default oracle fails. The exit status is 1\n"
         "when a cell passes or fails otherwise than is known: FAILS or CHANGED.\n",
         "radiosity study stability --only tiny_blocker"},
    [COMMAND_VISIBILITY] =
        {"study visibility", "SCENE", "how often few rays are wrong about visibility",
         "Classify what the pairs of a scene see of each other by few rays, and again by\n"
         "so many that the answer is trusted; then say which tool is good enough for\n"
         "which projected areas. SIGINT leaves partial tables and exit status 130.\n"
         "[Turbet and Sillion, section 5]\n",
         "radiosity study visibility room.obj --rays 4,16,64 --wrong 5%"},
    [COMMAND_CLUSTERING] =
        {"study clustering", "SCENE", "what ways of grouping faces cost and give",
         "Solve a scene once for each way of grouping its faces into clusters, and compare\n"
         "time, links, rays, memory and error:\n",
         "radiosity study clustering room.obj --reference room.csv -o table.md"},
    [COMMAND_FORM_FACTORS] =
        {"study form-factors", "SCENE", "what ways to compute form factors cost and give",
         "Solve a scene once, then compute the form factor of every link by 1/d^2, disc,\n"
         "hemicube, one point, rays, polygon and contour: how far it is off, what that\n"
         "makes of the reflected light, and nanoseconds.\n",
         "radiosity study form-factors room.obj -o table.md --chart chart.svg"},
    [COMMAND_ARVO] =
        {"study arvo", "", "constants against the best there are, in three norms",
         "What constants over n x n elements leave of the light that a square lamp throws\n"
         "on a parallel wall, for n = 1 to 64, in the norms L1, L2 and Linf: the best that\n"
         "constants can do (the lower curve), twice that, Galerkin's projection (means),\n"
         "collocation (centres). Exact to nine digits. [Arvo, Torrance, Smits, figure 4]\n",
         "radiosity study arvo --csv arvo.csv --chart arvo.svg"},
    [COMMAND_CAUSES] =
        {"study causes", "SCENE...", "which light links bring wrongly, and why",
         "Solve scenes by links alone, then hold what the links bring against rays that\n"
         "meet the same radiosities: how far off, in all and per polygon, and by which\n"
         "cause: pairs given up, bright spots, form factors, visibility, row sums. By\n"
         "constants: with slopes a link is nine numbers, and causes mix in each of them.\n",
         "radiosity study causes room.obj cornell.obj --set bend=2e-5"},
    [COMMAND_GREEDY] =
        {"study greedy", "", "an oracle's links against the fewest there need be",
         "Solve scenes without shadows whose light is known: an empty white cube, a lit\n"
         "one, parallel plates, a lamp over a wall. Hold error and links, in L1 and L2, by\n"
         "constants and linear elements, against greedy links: those of which each split\n"
         "was the one that lowered the true error most. `times`: by how much the error\n"
         "is larger with as many links; `links`: how many greedy links reach that\n"
         "error; `floor`: the least that constants over N parts, N large, err by.\n",
         "radiosity study greedy --oracle bf_guarded"},
    [COMMAND_DRAW] =
        {"draw", "ORACLE", "an oracle's graph as a picture, with a solve's heat",
         "Draw the graph of an oracle, built in or FILE.dag: nodes by what they do, arcs\n"
         "by how far an answer can be trusted, branches as boxes. With the statistics\n"
         "of a solve: nodes coloured by time, arcs as wide as they were used, what was\n"
         "never used grey. Graphviz places things (package graphviz).\n",
         "radiosity draw power --statistics room.json -o power.svg"},
    [COMMAND_PANEL] =
        {"panel", "ORACLE", "an oracle's drawing and parameters as a web page",
         "Write one page that needs no network: the graph of an oracle, built in or\n"
         "FILE.dag, and a control for every parameter that its author offers. It gives\n"
         "back the command line, and a parameter file for solve --params. With the\n"
         "statistics of a solve it tells what each node was asked and answered.\n",
         "radiosity panel power --statistics room.json -o panel.html"},
    [COMMAND_ORACLES] = {"oracles", "", "the built-in oracles and their parameters",
                         "List the built-in oracles and the parameters that --set gives them.\n",
                         "radiosity oracles"},
    [COMMAND_EXPLAIN] =
        {"explain", "SCENE", "one discussion of an oracle, node by node",
         "Solve a scene by links, and watch what the oracle says of one pair: RECEIVER\n"
         "gets light from EMITTER. Each node that was asked, with its arguments, the terms\n"
         "it read and wrote, its answer, rays and time; then the decision, and what became\n"
         "of the pair. Elements are 12 (face 12 of the file), 12.0 (a part that it was cut\n"
         "into), 12b (its far side), 12/0/3 (of its quarter 0 the quarter 3), root/1 (a\n"
         "cluster). By points: the pair in which what carries light from there to here was\n"
         "decided. --step reads commands from standard input: help lists them.\n",
         "radiosity explain room.obj --pair 0/0,4/0 --replace 'pair__much=below'"},
};

/* ---- the options */

enum {
    SOLVE = 1 << COMMAND_SOLVE,
    COMPARE = 1 << COMMAND_COMPARE,
    FACTORS = 1 << COMMAND_VIEWFACTORS,
    REFERENCE = 1 << COMMAND_REFERENCE,
    ERROR = 1 << COMMAND_ERROR,
    TUNE = 1 << COMMAND_TUNE,
    STABILITY = 1 << COMMAND_STABILITY,
    VISIBILITY = 1 << COMMAND_VISIBILITY,
    CLUSTERING = 1 << COMMAND_CLUSTERING,
    FORM_FACTORS = 1 << COMMAND_FORM_FACTORS,
    ARVO = 1 << COMMAND_ARVO,
    CAUSES = 1 << COMMAND_CAUSES,
    GREEDY = 1 << COMMAND_GREEDY,
    DRAW = 1 << COMMAND_DRAW,
    PANEL = 1 << COMMAND_PANEL,
    EXPLAIN = 1 << COMMAND_EXPLAIN,
    MATRICES = SOLVE | COMPARE | CLUSTERING | CAUSES,        /* they solve for radiosities */
    SCENES = MATRICES | FACTORS | VISIBILITY | FORM_FACTORS, /* with an oracle */
    THREADED = SCENES | REFERENCE | TUNE | STABILITY | ARVO | GREEDY | EXPLAIN,
    ALL = THREADED | ERROR
};

const char *const release_words[] = {"flat", "dag", "hand", "wave", NULL};
const char *const norm_words[] = {"l1", "l2", "power", NULL};
static const char *const closures[] = {"none", "rows", NULL};
const char *const closure_words[] = {"none", "rows", "reciprocal", NULL};
const char *const solver_words[] = {"gauss-seidel", "jacobi", "southwell", "lu", "petsc", NULL};
const char *const projection_words[] = {"galerkin", "collocation", NULL};
static const char *const bases[] = {"constant", "linear", NULL};
static const char *const costs[] = {"rays", "links", "time", NULL}; /* enum tune_cost */
static const char *const formats[] = {"csv",    "coo",        "mtx",      "npz",
                                      "view3d", "energyplus", "openfoam", NULL};
const char *const by_words[] = {"face", "material", "group", "object", NULL};
static const char *const checkpoints[] = {".h5", NULL};
static const char *const meshes[] = {".ply", ".gltf", ".glb", ".obj", ".xdmf", NULL};
static const char *const tables[] = {".csv", ".md", NULL};
static const char *const graphs[] = {".dag", NULL};
static const char *const svg[] = {".svg", NULL};
static const char *const pages[] = {".html", NULL};
static const char *const csv[] = {".csv", NULL};
static const char *const pictures[] = {".png", NULL};
static const char *const drawings[] = {".svg", ".png", NULL};

#define IN(member) .field = offsetof(struct options, member)
#define TEXT(member) NULL, .read = read_text, IN(member)
#define FLAG(member) NULL, .read = read_flag, IN(member)
#define WHOLE(member, from, to) .read = read_whole, IN(member), .low = from, .high = to
#define WORD(reader, list) NULL, .read = reader, .words = list
#define OUTPUT(member) NULL, .read = read_output, IN(member), .output = 1
#define STANDARD(member) OUTPUT(member), .standard = 1
#define NAMED(member, endings) NULL, .read = read_ending, IN(member), .words = endings, .output = 1

const struct option_row option_rows[] = {
    {"oracle", "NAME|FILE.dag", SOLVE | CLUSTERING | CAUSES | GREEDY | EXPLAIN, "power",
     "the refinement oracle", TEXT(oracle)},
    /* Few links, of all sizes and distances, none of clusters. */
    {"oracle", "NAME|FILE.dag", FORM_FACTORS, "ff", "the oracle whose links are measured",
     TEXT(oracle)},
    /* Its release by hand shares no code with the other two; that of the default shares geometry.
     */
    {"oracle", "NAME|FILE.dag", COMPARE, "bf_guarded", "the refinement oracle", TEXT(oracle)},
    {"release", "flat|dag|hand|wave", SOLVE | CLUSTERING | FORM_FACTORS, NULL,
     "compiled, interpreted, written by hand, in blocks (flat)", WORD(read_release, release_words),
     .rare = 1},
    {"plugin", "FILE.c|FILE.so", SOLVE, NULL, "C functions for the oracle's externs; repeatable",
     NULL, .read = read_plugin, .rare = 1},
    {"plugin", "FILE.c|FILE.so",
     COMPARE | CLUSTERING | FORM_FACTORS | CAUSES | GREEDY | TUNE | DRAW | PANEL | EXPLAIN, NULL,
     "C functions for the oracle's externs", NULL, .read = read_plugin},
    {"set", "PARAM=VALUE", SCENES | GREEDY | EXPLAIN, NULL,
     "a parameter of the oracle; may be repeated", NULL, .read = read_setting},
    {"params", "FILE", SOLVE | EXPLAIN, NULL,
     "a file of them, as a panel gives it; --set goes before", TEXT(params), .rare = 1},
    {"param", "NAME[=LOW:HIGH]", TUNE, NULL, "one to fit; or all of role link_threshold",
     "NAME, or NAME=LOW:HIGH with numbers 0 < LOW <= HIGH", .read = read_fitted},
    {"error", "E%", TUNE, "1%", "the error worked for, of the reflected light",
     "a share such as 2% or 0.02, above 0 and below 1", .read = read_share, IN(noise), .low = 1},
    {"power", "P", TUNE, "6", "how steeply errors above E count, see above",
     "a whole number from 1 to 64", WHOLE(power, 1, 64)},
    {"cost", "rays|links|time", TUNE, "rays", "rays + links, links, or rays + 40 per pair",
     WORD(read_cost, costs)},
    {"evaluations", "N", TUNE, "60", "sets of values that each fit may try",
     "a whole number from 1 to 10000", WHOLE(evaluations, 1, 10000)},
    {"limit-seconds", "N", TUNE, NULL, "about when to end, shared out to the fits",
     "a whole number from 1", WHOLE(limit_seconds, 1, INT_MAX)},
    {"clusters", "NAME", SOLVE, NULL, "how faces are grouped; see study clustering --help", NULL,
     .read = read_clustering, IN(clusters), .rare = 1},
    {"scale", "X|none", SOLVE, NULL, "thresholds times X, no links (measured; 1 if any is set)",
     "a number from 1e-6 to 1e6, or none", .read = read_scale, .rare = 1},
    {"tolerance", "X", MATRICES, NULL, "relative error of B that iteration may leave",
     "a number above 0 and below 1", .read = read_tolerance},
    /* Below what the best kinds differ by. */
    {"tolerance", "X", FORM_FACTORS, "1e-9", "relative error of B that iteration may leave",
     "a number above 0 and below 1", .read = read_tolerance},
    {"tolerance", "X", FACTORS, "3e-4", "error of a row's sum to work for",
     "a number above 0 and below 1", .read = read_tolerance},
    {"iterations", "N", MATRICES | FORM_FACTORS, "100000",
     "sweeps of a pass; where they are too few the exit status is 3", "a whole number from 1",
     WHOLE(iterations, 1, INT_MAX), .rare = 1},
    {"solver", "NAME", SOLVE | COMPARE, NULL, "gauss-seidel, jacobi, southwell, lu or petsc",
     WORD(read_solver, solver_words), .rare = 1},
    {"projection", "NAME", SOLVE | COMPARE, NULL, "galerkin (element means) or collocation",
     WORD(read_projection, projection_words), .rare = 1},
    {"closure", "none|rows", MATRICES, NULL, "rows of a closed scene are scaled to 1 (none)",
     WORD(read_closure, closures), .rare = 1},
    {"closure", "none|rows|reciprocal", FACTORS, NULL, "rows of a closed scene sum to 1 (none)",
     WORD(read_closure, closure_words)},
    {"accuracy", "NORM:X%", SOLVE, NULL, "solve until the error is at most X (l1, l2, power)",
     "a share such as 1%, or l2:5% or power:0.5%; above 0 and below 100%", .read = read_accuracy,
     IN(accuracy), .low = 1},
    {"limit-seconds", "N", SOLVE, NULL, "when --accuracy gives up (exit status 3)",
     "a whole number from 1", WHOLE(limit_seconds, 1, INT_MAX), .rare = 1},
    {"limit", "KEY=N,...", MATRICES, NULL, "where refinement gives up (exit status 1)",
     "depth=N, elements=N, links=N, pairs=N, rounds=N, joined by commas; numbers from 1, depth to "
     "250",
     .read = read_limits, IN(limits), .rare = 1},
    {"no-errors", NULL, SOLVE, NULL, "do not measure it", FLAG(no_errors), .rare = 1},
    {"correct", NULL, SOLVE, NULL, "mend the solution by particles; on unless --no-correct",
     FLAG(correct), .rare = 1},
    {"no-correct", NULL, SOLVE, NULL, "what the links alone say, not mended by particles",
     FLAG(no_correct)},
    {"errors", "[=all]", SOLVE, NULL, "how far off light is; all: by cause, with bounds",
     "all, or no value", .read = read_errors},
    {"reflectance-error", "X", SOLVE, NULL, "each rho may be off by X, as 0.02 (--errors=all)",
     "a number from 0, below 1, or percent", .read = read_share, IN(account.reflectance_error),
     .rare = 1},
    {"exitance-error", "X", SOLVE, NULL, "each E may be off by X of itself, as 5%",
     "a number from 0, below 1, or percent", .read = read_share, IN(account.exitance_error),
     .rare = 1},
    {"basis", "constant|linear", SOLVE, NULL, "elements of one value, or with slopes (linear)",
     WORD(read_basis, bases), .rare = 1},
    {"basis", "constant|linear", TUNE, NULL, "elements of one value, or with slopes (linear)",
     WORD(read_basis, bases)},
    {"repeats", "N", COMPARE, "3", "timed runs of each release", "a whole number from 1 to 1000",
     WHOLE(repeats, 1, 1000)},
    {"accuracy", "SHARE", REFERENCE, "0.2%", "the standard error to reach",
     "a share such as 0.2% or 0.002, above 0 and below 1", .read = read_share, IN(noise), .low = 1},
    {"keep", NULL, REFERENCE, NULL, "the state file stays, for a finer run", FLAG(keep)},
    {"worst", "N", ERROR, "10", "faces to name", "a whole number from 0 to 100000",
     WHOLE(worst, 0, 100000)},
    {"only", "CASE", STABILITY, NULL, "one of the scenes", TEXT(only)},
    {"only", "NAME", CLUSTERING, NULL, "one of the ways", NULL, .read = read_clustering, IN(only)},
    {"reference", "FACES.csv", CLUSTERING, NULL, "B to measure errors by, from solve --faces",
     TEXT(reference)},
    {"thresholds", "A,B,...", VISIBILITY, "2,3,5,7.5,10,15", "projected areas below which to ask",
     "rising numbers from 1e-300 to 1e300 parted by commas, 32 at the most",
     .read = read_thresholds},
    {"rays", "N,M,...", VISIBILITY, "4,16,64", "rays held against the reference",
     "some of 4,16,64,256,1024, rising, parted by commas", .read = read_rays},
    {"rays", "N", CAUSES, "4000000", "how many of each scene, about",
     "a whole number from 16 to 2000000000", WHOLE(cause_rays, 16, 2000000000)},
    {"within", "X%", VISIBILITY, "0.5%", "half of the 95 % interval to draw pairs for",
     "a share such as 0.5% or 0.005, above 0 and below 1", .read = read_share, IN(within),
     .low = 1},
    {"wrong", "X%", VISIBILITY, "5%", "wrong answers that are good enough",
     "a share such as 5% or 0.05, above 0 and below 1", .read = read_share, IN(wrong), .low = 1},
    {"iterations", "N", VISIBILITY, "2", "passes of refinement, with a solve between two",
     "a whole number from 1 to 1000", WHOLE(iterations, 1, 1000)},
    {"limit-seconds", "N", VISIBILITY, NULL, "stop then, with partial tables (exit status 3)",
     "a whole number from 1", WHOLE(limit_seconds, 1, INT_MAX)},
    {"samples", "N", ARVO, NULL, "L1 and L2 by midpoints, N across the wall, not exactly",
     "a whole number from 64 to 4096", WHOLE(samples, 64, 4096)},
    {"two-sided", NULL, SCENES | REFERENCE | TUNE | EXPLAIN, NULL,
     "faces have two sides, not only those *_2s", FLAG(two_sided)},
    {"flip-closed", NULL, FACTORS, NULL, "turn faces of closed shells that look turned",
     FLAG(flip_closed)},
    {"threads", "N", THREADED, NULL, "all processors if not given; same result",
     "a whole number from 1 to 1024", WHOLE(threads, 1, 1024)},
    {"o", "FILE", SOLVE, NULL, "the solved mesh: .ply .gltf .glb .obj .xdmf", NAMED(out, meshes)},
    {"o", "FILE", FACTORS, NULL, "the matrix; .mtx .npz .idf: in that format", OUTPUT(out)},
    {"o", "FILE", STABILITY | CLUSTERING | FORM_FACTORS, NULL, "the table, .csv or .md",
     NAMED(out, tables)},
    {"o", "FILE.csv", REFERENCE, NULL, "the table; must be given", NAMED(out, csv)},
    {"o", "FILE.csv", VISIBILITY, NULL, "the table", NAMED(out, csv)},
    {"o", "FILE.dag", TUNE, NULL, "the oracle with these defaults; may be ORACLE itself",
     NAMED(out, graphs)},
    {"o", "FILE.svg", DRAW, NULL, "the drawing; must be given", NAMED(out, svg)},
    {"o", "FILE.html", PANEL, NULL, "the page; must be given", NAMED(out, pages)},
    {"statistics", "FILE.json", DRAW | PANEL, NULL, "what solve --statistics wrote",
     TEXT(statistics)},
    {"format", "NAME", FACTORS, NULL, "csv coo mtx npz view3d energyplus openfoam",
     .takes = "csv, coo, mtx, npz, view3d, energyplus or openfoam", .read = read_format,
     .words = formats},
    {"by", "WHAT", FACTORS, NULL, "rows sum faces: material, group, object (face)",
     .takes = "face, material, group or object", .read = read_by, .words = by_words},
    {"sky", NULL, FACTORS, NULL, "two more columns: to the sky, to backs", FLAG(losses)},
    {"sensor", "FILE", FACTORS, NULL, "rows of points instead: lines x y z nx ny nz", TEXT(sensor)},
    {"product", "FILE", FACTORS, NULL, "F x instead, for columns x: a line per face",
     TEXT(product)},
    {"mirror", "AXIS=X", FACTORS, NULL, "a plane of symmetry, x=0; repeatable",
     "AXIS=X such as x=0; with --repeat, 8 at the most", .read = read_mirror},
    {"repeat", "AXIS=X:N", FACTORS, NULL, "N copies on either side, X m apart; repeatable",
     "AXIS=X:N such as y=2.5:3, X above 0, N 1 to 1000; with --mirror, 8 at the most",
     .read = read_repeat},
    {"names", "FILE", FACTORS, NULL, "a name for each row; .csv: its area, too", OUTPUT(names)},
    {"resume", "FILE", FACTORS, NULL, "stopped, it goes on from there another time",
     OUTPUT(resume)},
    {"checkpoint", "FILE.h5", SOLVE, NULL, "where the work stands, after every pass",
     NAMED(checkpoint, checkpoints), .rare = 1},
    {"restart", "FILE.h5", SOLVE, NULL, "go on from there: the same bits", TEXT(restart),
     .rare = 1},
    {"image", "FILE.png", SOLVE, NULL, "a picture, exposed for what it shows",
     NAMED(image, pictures)},
    {"size", "WxH", SOLVE, "1024x768", "its size in pixels", "WxH, each 1 to 16384",
     .read = read_size},
    {"view", "X,Y,Z:X,Y,Z[:FOV]", SOLVE, NULL, "eye, point looked at, degrees of height (70)",
     "X,Y,Z:X,Y,Z[:FOV], two different points and 1 to 170 degrees", .read = read_view},
    {"gather", "N", SOLVE, NULL, "gather light once more, by N rays per pixel",
     "a whole number from 0 to 1000000", WHOLE(gather, 0, 1000000)},
    {"image-error", "FILE.png", SOLVE, NULL, "the measured error on the surfaces",
     NAMED(image_error, pictures)},
    {"mesh", NULL, SOLVE, NULL, "the elements' edges over the picture", FLAG(mesh)},
    {"csv", "FILE", ARVO, NULL, "the table with nine digits", OUTPUT(csv)},
    {"chart", "FILE", VISIBILITY | CLUSTERING | FORM_FACTORS | ARVO, NULL,
     "a drawing, .svg or .png", NAMED(chart, drawings)},
    {"faces", "FILE.csv", SOLVE, NULL, "E, rho, H, B of each face of the scene file",
     OUTPUT(faces)},
    {"statistics", "FILE", SOLVE, NULL, "answers of the graph: text, .csv, .json; or -",
     STANDARD(statistics), .rare = 1},
    {"json", "FILE",
     SOLVE | COMPARE | FACTORS | REFERENCE | ERROR | CAUSES | GREEDY | TUNE | EXPLAIN, NULL,
     "what the summary says; - is standard output", STANDARD(json)},
    {"replace", "NODE=TOOL(...)", SOLVE | COMPARE, NULL,
     "ask another tool, or NODE=ANSWER: none; repeatable", NULL, .read = read_replacement,
     .rare = 1},
    {"replace", "NODE=TOOL(...)", EXPLAIN, NULL, "ask another tool, or NODE=ANSWER: none", NULL,
     .read = read_replacement},
    {"trace", "FILE", SOLVE, NULL, "each discussion, one line: CSV, or .jsonl", STANDARD(trace),
     .rare = 1},
    {"where", "CONDITION", SOLVE, NULL, "of --trace: \"decision == stop && depth > 2\"",
     TEXT(where), .rare = 1},
    {"pair", "RECEIVER,EMITTER", EXPLAIN, NULL, "two elements by name", TEXT(pair)},
    {"at", "X,Y,Z:X,Y,Z", EXPLAIN, NULL, "a point on the receiver, one on the emitter", TEXT(at)},
    {"pass", "N", EXPLAIN, NULL, "as discussed in pass N; 1: before the first solve",
     "a whole number from 1 to 1000", WHOLE(pass, 1, 1000)},
    {"step", NULL, EXPLAIN, NULL, "go through it by hand", FLAG(step)},
    {"q", NULL, ALL, NULL, "no progress, no summary, grave warnings alone", FLAG(quiet)},
};
const int option_row_count = sizeof option_rows / sizeof *option_rows;
