/* commands.h - what the command line can ask for, one file each. All return the exit status.
 * SPDX-License-Identifier: MIT */
#ifndef COMMANDS_H
#define COMMANDS_H

#include "options.h"
#include "scene.h"

int command_solve(const struct options *options, const struct scene *scene);
int command_compare(const struct options *options, const struct scene *scene);
int command_viewfactors(const struct options *options, const struct scene *scene);

#endif
