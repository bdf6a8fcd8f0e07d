/* study_stability.c - `radiosity study stability`.
 * SPDX-License-Identifier: MIT */
#include "commands.h"
#include "report.h"

int study_stability(const struct options *o)
{
    (void)o;
    return report_error("study", 0, "the stability study is not written yet") ? 1 : 0;
}
