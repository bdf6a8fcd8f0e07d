/* loaded_symbol.h - a function of a library that is loaded while running.
 * SPDX-License-Identifier: MIT */
#ifndef LOADED_SYMBOL_H
#define LOADED_SYMBOL_H

#include <dlfcn.h>
#include <string.h>

/* Set *function, a pointer to a function, to the address of `name`, which POSIX lets pass as an
 * object's and C does not. Returns 0, or -1 when the library has none; dlerror says why. */
static inline int loaded_symbol(void *library, const char *name, void *function)
{
    void *symbol = dlsym(library, name);
    memcpy(function, &symbol, sizeof symbol);
    return symbol ? 0 : -1;
}

#endif
