/* options.h - the command line of `radiosity`.
 * SPDX-License-Identifier: MIT */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "oracles.h"
#include "view.h"

enum command { COMMAND_SOLVE, COMMAND_COMPARE, COMMAND_VIEWFACTORS, COMMAND_ORACLES, COMMAND_HELP, COMMAND_VERSION };

struct options {
    enum command command;
    const char *scene, *oracle;
    enum release release;
    char **settings; /* [setting_count] "NAME=VALUE", owned */
    int setting_count;
    double tolerance;
    int iterations, threads, jacobi, two_sided, quiet, mesh, repeats;
    const char *out, *image, *faces, *json; /* NULL: not wanted */
    int width, height;
    struct view view;
    int view_given;
};

/* Returns 0, or the exit status 2 after a message on stderr. */
int options_parse(struct options *o, int count, char **arguments);
void options_print_help(FILE *out);
void options_free(struct options *o);

#endif
