/* options.h - the command line of `radiosity`: which command, and what it shall do.
 * SPDX-License-Identifier: MIT */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "radiosity.h"
#include "output/factor_file.h"
#include "output/view.h"
#include "scene/copies.h"

enum command {
    COMMAND_SOLVE,
    COMMAND_COMPARE,
    COMMAND_VIEWFACTORS,
    COMMAND_REFERENCE,
    COMMAND_ERROR,
    COMMAND_TUNE,
    COMMAND_STABILITY,
    COMMAND_VISIBILITY,
    COMMAND_CLUSTERING,
    COMMAND_FORM_FACTORS,
    COMMAND_ARVO,
    COMMAND_CAUSES,
    COMMAND_GREEDY,
    COMMAND_DRAW,
    COMMAND_PANEL,
    COMMAND_ORACLES,
    COMMAND_EXPLAIN,
    COMMANDS
};

/* What enum RadRelease, RadClosure, RadSolver and RadProjection are called; NULL-terminated. */
extern const char *const release_words[], *const closure_words[], *const solver_words[],
                                                                      *const projection_words[];

/* The norms that --accuracy is asked in: of face means, over the surfaces, of all light together.
 */
enum accuracy_norm { ACCURACY_L1, ACCURACY_L2, ACCURACY_POWER };
extern const char *const norm_words[];

/* viewfactors: what a row is. */
enum factor_rows { BY_FACE, BY_MATERIAL, BY_GROUP, BY_OBJECT };
extern const char *const by_words[];

/* What --errors asks for: what is measured; the account by cause, too. */
enum errors_wanted { ERRORS_UNSAID, ERRORS_MEASURED, ERRORS_ALL };

enum { STUDY_LIST = 32, OUTPUTS_MAX = 8 };

/* What a command does not take is zero. Texts are the command line's own; NULL: not given, not
 * wanted. */
struct options {
    enum command command;
    const char *scene;   /* of error: the table of faces to judge; of many: the first */
    const char **scenes; /* [scene_count] of commands that take many, owned; else NULL */
    int scene_count;
    size_t scene_capacity;

    /* How to solve. */
    const char *oracle;
    enum RadRelease release;
    int release_given;
    /* [setting_count] "NAME=VALUE", of tune "NAME" or "NAME=LOW:HIGH"; owned */
    char **settings;
    int setting_count;
    size_t setting_capacity;
    char **replacements; /* [replacement_count] "NODE=TOOL(...)" or "NODE=ANSWER"; owned */
    int replacement_count;
    size_t replacement_capacity;
    char **plugins; /* [plugin_count] files; owned */
    int plugin_count;
    size_t plugin_capacity;
    const char *params;   /* a file of them, which settings go before */
    const char *clusters; /* NULL: the default */
    enum RadClosure closure;
    enum RadBasis basis;
    int basis_given;
    double scale;     /* of the oracle's thresholds; 0: not given */
    int choose_scale; /* it is chosen then; else 1 */
    int no_links;     /* instead: particles alone */
    double tolerance;
    int tolerance_given;
    enum RadSolver solver;
    enum RadProjection projection;
    int iterations, threads, two_sided, quiet;
    int flip_closed; /* of closed shells what looks turned is turned */

    /* How far from the truth. */
    enum errors_wanted errors;
    struct RadAccountOptions account; /* of ERRORS_ALL */
    int no_errors, correct, no_correct;
    double accuracy; /* share of the reflected light; 0: not asked for */
    enum accuracy_norm norm;
    int limit_seconds; /* 0: none */
    struct RadLimits limits;

    /* What to write. */
    const char *image_error, *out, *csv, *faces, *json, *statistics, *names, *chart, *image;
    enum factor_format format;
    int format_given;
    enum factor_rows by;              /* viewfactors */
    int losses;                       /* viewfactors */
    const char *sensor, *product;     /* viewfactors: rows of points, and products, instead */
    const char *resume;               /* viewfactors: where the work stands */
    const char *checkpoint, *restart; /* solve: to be written after passes; to go on from */
    struct copies copies;             /* viewfactors: --mirror, --repeat */
    int width, height, mesh;          /* of the picture */
    int size_given;
    int gather; /* rays per pixel; 0: none; -1, not given: at corners */
    struct view view;
    int view_given;

    /* What to measure. */
    int repeats;                   /* compare */
    const char *only;              /* stability: the case to run; clustering: the strategy */
    const char *reference;         /* clustering, error: the table of faces to measure by */
    double thresholds[STUDY_LIST]; /* visibility: of projected area, [threshold_count], rising */
    int rays[STUDY_LIST];          /* visibility: how many per pair, [ray_count], rising */
    int threshold_count, ray_count;
    double within; /* visibility: half of the interval to work for */
    double wrong;  /* visibility: the share of wrong answers that is good enough */
    double noise;  /* reference: the standard error to reach; tune: the error; a share */
    int evaluations, cost, power; /* tune: of each fit; enum tune_cost; of error over noise */
    int keep;                     /* reference: its state file stays */
    int worst;                    /* error: how many faces to name */
    int samples;                  /* arvo: across the receiver; 0: exactly */
    const char *trace, *where;    /* solve: the file, and which discussions go into it */
    const char *pair, *at;        /* explain: receiver and emitter, by names or points */
    int pass;                     /* explain: as discussed in this one; 0: whenever it was last */
    int step;                     /* explain: by hand */
    int cause_rays;               /* causes: about how many */
};

/* Returns -1 to go on, or the exit status: 0 after --help or --version, 2 after a message on
 * stderr. */
int options_parse(struct options *o, int count, char **arguments);

/* How to solve, as far as the command line says. */
static inline struct RadSolveOptions solve_options(const struct options *o)
{
    return (struct RadSolveOptions){.tolerance = o->tolerance,
                                    .iterations = o->iterations,
                                    .solver = o->solver,
                                    .projection = o->projection,
                                    .closure = o->closure,
                                    .basis = o->basis,
                                    .clustering = o->clusters,
                                    .limits = o->limits,
                                    .no_links = o->no_links};
}

/* The files that shall be written, "-" for standard output among them. Returns how many. */
int options_outputs(const struct options *o, const char *paths[OUTPUTS_MAX]);

void options_free(struct options *o);

#endif
