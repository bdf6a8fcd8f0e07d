/* emit.h - what the parts of the C emitter share.
 * SPDX-License-Identifier: MIT */
#ifndef EMIT_H
#define EMIT_H

#include "internal.h"

/* The function NAME_refine (emit_flat.c). */
void dag_emit_flat(struct dag *dag, struct text *out, const struct oracle_graph *oracle);

#endif
