/* lapack_library.c - see lapack_library.h. LAPACK_LIBRARY: its name, of the version that the
 * headers are of (Makefile). What is loaded stays.
 * SPDX-License-Identifier: MIT */
#include "util/lapack_library.h"
#include "util/loaded_symbol.h"

const char *lapack_load(struct lapack *lapack)
{
    void *library = dlopen(LAPACK_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (!library || loaded_symbol(library, "LAPACKE_dgetrf", &lapack->factor) < 0
        || loaded_symbol(library, "LAPACKE_dgetrs", &lapack->solve) < 0) {
        const char *why = dlerror();
        return why ? why : "out of memory";
    }
    return NULL;
}
