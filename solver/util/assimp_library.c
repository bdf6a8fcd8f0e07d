/* assimp_library.c - see assimp_library.h. ASSIMP_LIBRARY: its name, of the version that the
 * headers are of (Makefile).
 * SPDX-License-Identifier: MIT */
#include "util/assimp_library.h"

#include "util/loaded_symbol.h"
#include "util/report.h"

const struct assimp *assimp_load(const char *path)
{
    static struct assimp assimp;
    int failed = 0;
    if (assimp.aiImportFile)
        return &assimp;
    void *library = dlopen(ASSIMP_LIBRARY, RTLD_NOW | RTLD_LOCAL);
#define ASSIMP_FIND(name) failed |= !library || loaded_symbol(library, #name, &assimp.name);
    ASSIMP_FUNCTIONS(ASSIMP_FIND)
    if (failed) {
        report_error(path, 0,
                     "needs Assimp, which does not load: %s; install it (package libassimp-dev)",
                     dlerror());
        assimp.aiImportFile = NULL;
        return NULL;
    }
    return &assimp;
}
