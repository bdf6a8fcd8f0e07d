/* import_text.h - let Assimp read a file whose text is in memory.
 * SPDX-License-Identifier: MIT */
#ifndef IMPORT_TEXT_H
#define IMPORT_TEXT_H

#include <stddef.h>

struct aiScene;

/* As aiImportFile(path, 0), but `path` itself reads as text[size]; the files it names are read
 * from disk. NULL: see aiGetErrorString. */
const struct aiScene *import_text(const char *path, const char *text, size_t size);

#endif
