/* camera.h - where a picture is taken from, and what of the scene is in it: all that importance
 * asks of a view.
 * SPDX-License-Identifier: MIT */
#ifndef CAMERA_H
#define CAMERA_H

struct camera {
    double eye[3];                    /* m */
    double right[3], up[3], ahead[3]; /* unit vectors, at right angles to each other */
    double wide, high;                /* tangents of half the angles of view */
};

#endif
