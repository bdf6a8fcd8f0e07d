/* make_camera.h - a camera of the engine's, z being up.
 * SPDX-License-Identifier: MIT */
#ifndef MAKE_CAMERA_H
#define MAKE_CAMERA_H

#include <math.h>
#include <string.h>
#include "engine/camera.h"
#include "geometry.h"

static inline void made_unit(double v[3])
{
    double length = length3(v);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

/* From `eye` to `at`, which is not straight above or below; fov: the vertical field of view
 * (degrees); aspect: width over height. */
static inline struct camera made_camera(const double eye[3], const double at[3], double fov,
                                        double aspect)
{
    const double z[3] = {0, 0, 1};
    struct camera c;
    memcpy(c.eye, eye, sizeof c.eye);
    sub3(c.ahead, at, eye);
    made_unit(c.ahead);
    cross3(c.right, c.ahead, z);
    made_unit(c.right);
    cross3(c.up, c.right, c.ahead);
    c.high = tan(fov * (0.5 * 3.14159265358979323846 / 180));
    c.wide = c.high * aspect;
    return c;
}

#endif
