/* lapack_library.c - see lapack_library.h. LAPACK_LIBRARY: its name, of the version that the
 * headers are of (Makefile). What is loaded stays.
 * SPDX-License-Identifier: MIT */
#include "util/lapack_library.h"
#include <dlfcn.h>
#include <string.h>

/* A function's address, which POSIX lets pass as an object's and C does not. */
static int find(void *library, const char *name, void *function)
{
    void *symbol = dlsym(library, name);
    memcpy(function, &symbol, sizeof symbol);
    return symbol ? 0 : -1;
}

const char *lapack_load(struct lapack *lapack)
{
    void *library = dlopen(LAPACK_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (!library || find(library, "LAPACKE_dgetrf", &lapack->factor) < 0
        || find(library, "LAPACKE_dgetrs", &lapack->solve) < 0) {
        const char *why = dlerror();
        return why ? why : "out of memory";
    }
    return NULL;
}
