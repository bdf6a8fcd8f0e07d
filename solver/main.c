/* main.c - the command radiosity: parse the options, see that what shall be written can be, run the command.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "commands/commands.h"
#include "util/atomic_file.h"
#include "util/report.h"

static int (*const commands[COMMANDS])(const struct options *) = {
    [COMMAND_SOLVE] = command_solve,           [COMMAND_COMPARE] = command_compare,
    [COMMAND_VIEWFACTORS] = command_viewfactors, [COMMAND_STABILITY] = command_stability,
    [COMMAND_VISIBILITY] = command_visibility, [COMMAND_CLUSTERING] = command_clustering,
    [COMMAND_ORACLES] = command_oracles,
};

/* What cannot be written is told before the work, not after. Returns 0 or the exit status. */
static int check_outputs(const struct options *o)
{
    const char *paths[OUTPUTS_MAX];
    int count = options_outputs(o, paths);
    for (int i = 0; i < count; i++) {
        int standard = strcmp(paths[i], "-") == 0;
        for (int j = 0; j < i; j++)
            if (strcmp(paths[i], paths[j]) == 0) {
                report_error(standard ? "standard output" : paths[i], 0,
                             "two outputs would go there; give each a file of its own");
                return 2;
            }
        if (!standard && atomic_check(paths[i]) < 0)
            return 1;
    }
    return 0;
}

int main(int count, char **arguments)
{
    struct options o;
    int status = options_parse(&o, count, arguments);
    if (status < 0) {
        status = check_outputs(&o);
        if (status == 0)
            status = commands[o.command](&o);
    }
    options_free(&o);
    return fflush(stdout) != 0 && status == 0 ? 1 : status;
}
