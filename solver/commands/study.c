/* command_study.c - `radiosity study`: experiments whose table is the result.
 * SPDX-License-Identifier: MIT */
#include "scene/read_scene.h"
#include "commands/commands.h"

int command_study(const struct options *o)
{
    struct scene_options how = { o->two_sided, o->quiet };
    struct scene scene;
    int status;
    if (o->study == STUDY_STABILITY)
        return study_stability(o);
    if (scene_read(&scene, o->scene, &how) < 0)
        return 1;
    status = o->study == STUDY_CLUSTERING ? study_clustering(o, &scene) : study_visibility(o, &scene);
    scene_free(&scene);
    return status;
}
