/* study_visibility.c - `radiosity study visibility`.
 * SPDX-License-Identifier: MIT */
#include "commands.h"
#include "report.h"

int study_visibility(const struct options *o, const struct scene *scene)
{
    (void)scene;
    return report_error(o->scene, 0, "the visibility study is not written yet") ? 1 : 0;
}
