/* large_scene.h - question: has the scene so many faces that clusters pay?
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_LARGE_SCENE_H
#define TOOL_LARGE_SCENE_H

#include "discussion.h"

TOOL enum large_scene_answer tool_large_scene(struct discussion *d, int faces)
{
    return d->host->faces >= faces ? LARGE_SCENE_YES : LARGE_SCENE_NO;
}

#endif
