/* sensor_rows.h - `radiosity viewfactors --sensor FILE`: what points see, a row for each.
 *
 * A line of the file is `x y z nx ny nz [name]`: where the sensor is (m), where it looks (any
 * length but 0), and what it is called, else by its number from 0. # begins a comment. The table
 * has a line `name,sky,back,0,1,...` and one per sensor: the share of what would meet it if all
 * were equally bright that comes from outside the scene, that black backs keep away, and that from
 * each face of the scene file.
 * SPDX-License-Identifier: MIT */
#ifndef SENSOR_ROWS_H
#define SENSOR_ROWS_H

#include "options/options.h"
#include "scene/open_scene.h"

/* Returns the exit status. */
int sensor_rows(const struct options *o, const struct open_scene *scene);

#endif
