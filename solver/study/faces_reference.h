/* faces_reference.h - radiosities per face to measure a solution by.
 * SPDX-License-Identifier: MIT */
#ifndef FACES_REFERENCE_H
#define FACES_REFERENCE_H

#include "scene/open_scene.h"

struct faces_reference {
    uint32_t count, bands;
    uint32_t *face; /* [count], rising: of the scene file */
    double *area;   /* [count], m2 */
    double *value;  /* [count * bands]: B, W/m2 */
};

/* Read a table with columns `face`, `area` and `B_0` (`B_1`, `B_2`), others passed over, as `solve
 * --faces` writes it. It may have a sample of the scene's faces, in order. Returns 0, or -1 after a
 * message that names file and line. */
int faces_reference_read(struct faces_reference *r, const char *path,
                         const struct open_scene *scene);

/* sum A |B - B_ref| / sum A B_ref over the table's faces and the bands; NAN when out of memory. */
double faces_reference_error(const struct faces_reference *r, const struct open_scene *scene,
                             RadSolution solution);

void faces_reference_free(struct faces_reference *r);

#endif
