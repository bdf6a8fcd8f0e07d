/* material_name.h - names that say what a material reflects and emits, for meshes of this program
 * that are read as scenes and whose format's materials say how to show them:
 *     NAME {rho R G B, E R G B}
 * Names survive other programs; notes beside them (extras of glTF) do not.
 * SPDX-License-Identifier: MIT */
#ifndef MATERIAL_NAME_H
#define MATERIAL_NAME_H

#include "radiosity.h"

/* For free(); NULL when out of memory. */
char *material_name_write(const char *name, const struct RadMaterial *material);

/* Cut the name short and take reflectance and exitance from it. Returns 0 when it is no such name;
 * then nothing changes. */
int material_name_read(char *name, struct RadMaterial *material);

#endif
