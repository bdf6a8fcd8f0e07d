/* view.h - where the camera stands.
 * SPDX-License-Identifier: MIT */
#ifndef VIEW_H
#define VIEW_H

#include "output/solution.h"

struct view {
    double eye[3], at[3]; /* m */
    double up[3];         /* all zero: guess from the scene */
    double fov;           /* vertical, degrees */
};

/* Parse "X,Y,Z:X,Y,Z[:FOV]": eye, what is in the middle of the picture, vertical field of view
 * (1 to 170 degrees, 70 when not given). Returns 0, or -1 when it is not that. */
int view_parse(const char *text, struct view *view);

/* A view that shows much of the scene: inside, near a corner, at two thirds of the height, looking
 * to the opposite side. Never from within a solid. Scenes that enclose no space are seen from
 * outside. Returns 0, or -1 when out of memory. */
int view_guess(const struct surfaces *surfaces, struct view *view);

/* Half the height of the picture, 1 m ahead (m). */
double view_half_height(const struct view *view);

/* The camera's frame: unit vectors to the right, up, ahead. Guesses `up` when it is not given, and
 * replaces it when the camera looks along it. */
void view_frame(const struct view *view, const struct surfaces *surfaces, double right[3],
                double up[3], double ahead[3]);

/* The same for the engine; aspect: the picture's width over its height. */
struct RadCamera view_camera(const struct view *view, const struct surfaces *surfaces,
                             double aspect);

/* The axis that points up, 1 (y) or 2 (z): the one that more area is square to, as floors and
 * ceilings are; z when in doubt. */
int view_up_axis(const struct surfaces *surfaces);

#endif
