/* options.h - the command line of `radiosity`.
 * SPDX-License-Identifier: MIT */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "output/factor_file.h"
#include "util/oracles.h"
#include "engine/solve.h"
#include "output/view.h"

enum command { COMMAND_SOLVE, COMMAND_COMPARE, COMMAND_VIEWFACTORS, COMMAND_ORACLES, COMMAND_STUDY, COMMAND_HELP,
               COMMAND_STUDY_HELP, COMMAND_VERSION };
enum study { STUDY_STABILITY, STUDY_VISIBILITY, STUDY_CLUSTERING };
enum { STUDY_LIST = 32 };

struct options {
    enum command command;
    const char *scene, *oracle;
    enum release release;
    int release_given;
    enum closure closure;
    int clusters; /* 1 + the strategy that builds them; 0: the default */
    const char *statistics; /* NULL: not wanted */
    char **settings; /* [setting_count] "NAME=VALUE", owned */
    int setting_count;
    double tolerance;
    int iterations, threads, jacobi, two_sided, quiet, mesh, repeats;
    const char *out, *image, *faces, *json; /* NULL: not wanted */
    int width, height;
    struct view view;
    int view_given;
    enum factor_format format; /* of COMMAND_VIEWFACTORS, and the rest of this block with it */
    enum factor_closure_kind factor_closure;
    const char *names; /* NULL: not wanted */
    enum study study;       /* of COMMAND_STUDY, and the rest of this block with it */
    const char *only;       /* stability: the case to run; clustering: the strategy; NULL: all */
    const char *chart;      /* visibility, clustering: where the drawing goes; NULL: not wanted */
    const char *reference;  /* clustering: the table of faces to measure by; NULL: none */
    double thresholds[STUDY_LIST]; /* visibility: of projected area, [threshold_count], rising */
    int rays[STUDY_LIST];          /* visibility: how many per pair, [ray_count], rising */
    int threshold_count, ray_count;
};

/* Returns 0, or the exit status 2 after a message on stderr. */
int options_parse(struct options *o, int count, char **arguments);
void options_print_help(FILE *out);
void options_print_study_help(FILE *out);
void options_free(struct options *o);

#endif
