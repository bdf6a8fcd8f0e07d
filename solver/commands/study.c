/* study.c - the commands that read a scene and hand it on, and the list of oracles.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "commands/commands.h"
#include "scene/read_scene.h"

int with_scene(const struct options *o, int (*run)(const struct options *options, const struct scene *scene))
{
    struct scene_options how = { o->two_sided, o->quiet };
    struct scene scene;
    if (scene_read(&scene, o->scene, &how) < 0)
        return 1;
    int status = run(o, &scene);
    scene_free(&scene);
    return status;
}

int command_stability(const struct options *o)
{
    return study_stability(o);
}

int command_visibility(const struct options *o)
{
    return with_scene(o, study_visibility);
}

int command_clustering(const struct options *o)
{
    return with_scene(o, study_clustering);
}

int command_oracles(const struct options *o)
{
    (void)o;
    oracles_print(stdout);
    return 0;
}
