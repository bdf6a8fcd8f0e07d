/* main.c - the command radiosity: parse the options, read the scene, run the command.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "scene/read_scene.h"
#include "util/atomic_file.h"
#include "commands/commands.h"
#include "dag.h"
#include "util/oracles.h"
#include "util/report.h"

/* What cannot be written is told before the work, not after. Returns 0 or the exit status. */
static int outputs_checked(const struct options *o)
{
    const char *const paths[] = { o->out, o->image, o->faces, o->json, o->statistics, o->chart };
    enum { PATHS = sizeof paths / sizeof *paths };
    int i, j;
    for (i = 0; i < PATHS; i++) {
        if (!paths[i] || strcmp(paths[i], "-") == 0)
            continue;
        for (j = 0; j < i; j++)
            if (paths[j] && strcmp(paths[i], paths[j]) == 0) {
                report_error(paths[i], 0, "two outputs would go there; give each a file of its own");
                return 2;
            }
        if (atomic_check(paths[i]) < 0)
            return 1;
    }
    return 0;
}

static int run(const struct options *o)
{
    struct scene_options how = { o->two_sided, o->quiet };
    struct scene scene;
    int status;
    if (scene_read(&scene, o->scene, &how) < 0)
        return 1;
    switch (o->command) {
    case COMMAND_COMPARE:
        status = command_compare(o, &scene);
        break;
    case COMMAND_VIEWFACTORS:
        status = command_viewfactors(o, &scene);
        break;
    default:
        status = command_solve(o, &scene);
        break;
    }
    scene_free(&scene);
    return status;
}

int main(int count, char **arguments)
{
    struct options o;
    int status = options_parse(&o, count, arguments);
    if (status == 0)
        status = outputs_checked(&o);
    if (status == 0)
        switch (o.command) {
        case COMMAND_HELP:
            options_print_help(stdout);
            break;
        case COMMAND_STUDY_HELP:
            options_print_study_help(stdout);
            break;
        case COMMAND_STUDY:
            status = command_study(&o);
            break;
        case COMMAND_VERSION:
            printf("radiosity %s\n", DAGC_VERSION);
            break;
        case COMMAND_ORACLES:
            oracles_print(stdout);
            break;
        default:
            status = run(&o);
        }
    options_free(&o);
    return fflush(stdout) != 0 && status == 0 ? 1 : status;
}
