/* assimp_library.h - Assimp, which is loaded when a file is read or written by it.
 *
 * It and what it needs in turn take longer to load than a small scene's view factors to compute.
 * SPDX-License-Identifier: MIT */
#ifndef ASSIMP_LIBRARY_H
#define ASSIMP_LIBRARY_H

#include <assimp/cexport.h>
#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#define ASSIMP_FUNCTIONS(each) \
    each(aiExportSceneEx) each(aiGetErrorString) each(aiGetMaterialColor) \
        each(aiGetMaterialFloatArray) each(aiGetMaterialIntegerArray) each(aiGetMaterialString) \
            each(aiIdentityMatrix4) each(aiImportFile) each(aiIsExtensionSupported) \
                each(aiMatrix4Determinant) each(aiMultiplyMatrix4)
#define ASSIMP_MEMBER(name) __typeof__(name) *name;
struct assimp {
    ASSIMP_FUNCTIONS(ASSIMP_MEMBER)
};

/* Its functions. NULL after a message that names the file. Not for several threads at once. */
const struct assimp *assimp_load(const char *path);

#endif
