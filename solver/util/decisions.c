/* decisions.c - see decisions.h.
 * SPDX-License-Identifier: MIT */
#include "util/decisions.h"

const char *const decision_names[DECISIONS + 1] = {
    [DECISION_LINK] = "link",
    [DECISION_STOP] = "stop",
    [DECISION_SUBDIVIDE_RECEIVER] = "subdivide_receiver",
    [DECISION_SUBDIVIDE_EMITTER] = "subdivide_emitter",
    [DECISION_SUBDIVIDE_BOTH] = "subdivide_both",
    [DECISION_LINK_CLUSTERS] = "link_clusters"};
