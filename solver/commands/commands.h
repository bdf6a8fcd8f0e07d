/* commands.h - what the command line can ask for, one file each. All return the exit status.
 * SPDX-License-Identifier: MIT */
#ifndef COMMANDS_H
#define COMMANDS_H

#include "options.h"
#include "hierarchy/scene.h"

int command_solve(const struct options *options, const struct scene *scene);
int command_compare(const struct options *options, const struct scene *scene);
int command_viewfactors(const struct options *options, const struct scene *scene);
int command_study(const struct options *options); /* reads the scene itself, where the study has one */

/* The studies. `options` holds what was asked: see options.h. */
int study_stability(const struct options *options);
int study_clustering(const struct options *options, const struct scene *scene);
int study_visibility(const struct options *options, const struct scene *scene);

#endif
