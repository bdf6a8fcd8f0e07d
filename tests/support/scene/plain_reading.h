/* plain_reading.h - scene files as one reads them who knows the formats and nothing of the readers:
 * what a file has where it says so plainly.
 *
 * OBJ with its libraries, OFF, PLY and STL, small ones. What a strict reader need not understand
 * (odd numbers, lines of unknown kinds, names with blanks) is UNSURE; what nobody may take for a
 * scene (a vertex that is not there, less than is counted) is DAMAGED.
 * SPDX-License-Identifier: MIT */
#ifndef PLAIN_READING_H
#define PLAIN_READING_H

#include <stdint.h>

enum { PLAIN_CORNERS = 12, PLAIN_FACES = 120, PLAIN_VERTICES = 400 };

struct plain_face {
    double corner[PLAIN_CORNERS][3]; /* as the file has them */
    uint32_t corners;
    double reflectance[3], exitance[3]; /* exitance in W/m2 */
};

struct plain_scene {
    struct plain_face face[PLAIN_FACES];
    uint32_t count;
};

enum plain { UNSURE, PLAIN, DAMAGED };

enum plain plain_reading(struct plain_scene *scene, const char *path);

#endif
