/* assimp_library.c - see assimp_library.h. ASSIMP_LIBRARY: its name, of the version that the
 * headers are of (Makefile).
 * SPDX-License-Identifier: MIT */
#include "util/assimp_library.h"

#include <dlfcn.h>
#include <string.h>

#include "util/report.h"

/* A function's address, which POSIX lets pass as an object's and C does not. */
static int find(void *library, const char *name, void *function)
{
    void *symbol = dlsym(library, name);
    memcpy(function, &symbol, sizeof symbol);
    return symbol ? 0 : -1;
}

const struct assimp *assimp_load(const char *path)
{
    static struct assimp assimp;
    int failed = 0;
    if (assimp.aiImportFile)
        return &assimp;
    void *library = dlopen(ASSIMP_LIBRARY, RTLD_NOW | RTLD_LOCAL);
#define ASSIMP_FIND(name) failed |= !library || find(library, #name, &assimp.name);
    ASSIMP_FUNCTIONS(ASSIMP_FIND)
    if (failed) {
        report_error(path, 0, "needs Assimp, which does not load: %s", dlerror());
        assimp.aiImportFile = NULL;
        return NULL;
    }
    return &assimp;
}
