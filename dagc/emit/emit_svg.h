/* emit_svg.h - Graphviz draws.
 * SPDX-License-Identifier: MIT */
#ifndef EMIT_SVG_H
#define EMIT_SVG_H

#include "base/internal.h"

/* Replaces a drawing in the language of Graphviz by the SVG that its `dot` makes of it; -1: it
 * could not, and has said why on standard error. */
int dag_draw_svg(struct text *text);

#endif
