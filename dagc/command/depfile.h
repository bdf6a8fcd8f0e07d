/* depfile.h - which files the outputs depend on, for make.
 * SPDX-License-Identifier: MIT */
#ifndef DEPFILE_H
#define DEPFILE_H

#include "base/write.h"

/* Fills in outputs[OUTPUT_DEPFILE] (options.h) when it is wanted. */
void dag_emit_depfile(const struct dag *dag, struct output *outputs);

#endif
