/* commands.h - what the command line can ask for, one file each. All return the exit status;
 * `scene` is the one that the command line names, NULL for commands that take none.
 * SPDX-License-Identifier: MIT */
#ifndef COMMANDS_H
#define COMMANDS_H

#include "options/options.h"
#include "scene/open_scene.h"

/* Behind the name of a reference's output: the file that an unfinished one goes on from. */
#define REFERENCE_STATE ".state"

int command_solve(const struct options *options, const struct open_scene *scene);
int command_compare(const struct options *options, const struct open_scene *scene);
int command_viewfactors(const struct options *options, const struct open_scene *scene);
int command_error(const struct options *options, const struct open_scene *scene);
int command_reference(const struct options *options, const struct open_scene *scene);
int command_tune(const struct options *options, const struct open_scene *scene);
int command_draw(const struct options *options, const struct open_scene *scene);
int command_panel(const struct options *options, const struct open_scene *scene);
int command_explain(const struct options *options, const struct open_scene *scene);
int command_oracles(const struct options *options, const struct open_scene *scene);

#endif
