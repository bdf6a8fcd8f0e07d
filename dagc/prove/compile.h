/* compile.h - C text to a loaded library: the one place that runs the C compiler.
 * SPDX-License-Identifier: MIT */
#ifndef COMPILE_H
#define COMPILE_H

#include "dag.h"

/* A file for the compiler, under the name that an #include has: "tools/larger.h". */
struct c_file {
    const char *name, *text;
    size_t length;
};

/* Compiles those whose names end in .c, which may include the others, and loads what comes of it:
 * dlopen's handle, or NULL with the cause in `message`, a sentence and below it what the compiler
 * printed. `flags` ends with NULL. Prints nothing and leaves no file. */
void *dag_compile(const struct c_file *files, int count, const char *const *flags,
                  const struct dag_compiler *compiler, char *message, size_t size);

#endif
