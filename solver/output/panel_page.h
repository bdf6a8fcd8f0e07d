/* panel_page.h - a page for an oracle's parameters: what `radiosity panel` writes.
 * SPDX-License-Identifier: MIT */
#ifndef PANEL_PAGE_H
#define PANEL_PAGE_H

#include <jansson.h>

#include "radiosity.h"

/* Writes a page that needs no other file. The oracle is of RAD_RELEASE_DAG; `named`: what --oracle
 * calls it; `statistics` as graph_svg_write has them, or NULL. Returns 0, or -1 after a message. */
int panel_page_write(const char *path, RadOracle oracle, const char *named,
                     const json_t *statistics);

#endif
