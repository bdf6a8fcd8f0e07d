/* study.h - experiments whose table is the result, one file each. All return the exit status;
 * `scene` is the one that the command line names, NULL for studies that make their own.
 * SPDX-License-Identifier: MIT */
#ifndef STUDY_H
#define STUDY_H

#include "options/options.h"
#include "scene/open_scene.h"

int study_stability(const struct options *options, const struct open_scene *scene);
int study_arvo(const struct options *options, const struct open_scene *scene);
int study_clustering(const struct options *options, const struct open_scene *scene);
int study_form_factors(const struct options *options, const struct open_scene *scene);
int study_causes(const struct options *options, const struct open_scene *scene);
int study_greedy(const struct options *options, const struct open_scene *scene);
int study_visibility(const struct options *options, const struct open_scene *scene);

#endif
