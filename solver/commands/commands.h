/* commands.h - what the command line can ask for, one file each. All return the exit status.
 * SPDX-License-Identifier: MIT */
#ifndef COMMANDS_H
#define COMMANDS_H

#include "options.h"
#include "engine/solve.h"
#include "hierarchy/scene.h"
#include "util/oracles.h"

int command_solve(const struct options *options);
int command_compare(const struct options *options);
int command_viewfactors(const struct options *options);
int command_stability(const struct options *options);
int command_visibility(const struct options *options);
int command_clustering(const struct options *options);
int command_oracles(const struct options *options);

/* Read the scene that was asked for and run a command on it. */
int with_scene(const struct options *options, int (*run)(const struct options *options, const struct scene *scene));

/* The studies. `options` holds what was asked: see options.h. */
int study_stability(const struct options *options);
int study_clustering(const struct options *options, const struct scene *scene);
int study_visibility(const struct options *options, const struct scene *scene);

#endif
