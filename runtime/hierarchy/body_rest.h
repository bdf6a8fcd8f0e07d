/* body_rest.h - what lies on what.
 * SPDX-License-Identifier: MIT */
#ifndef BODY_REST_H
#define BODY_REST_H

#include "hierarchy/body_lids.h"

/* May faces below an element cover some of a lid? Not where they are elsewhere, or not in its
 * plane: of a group's that is known but for how far its faces reach off it. */
int body_rest_near(const struct hierarchy *h, const struct element *e, const struct shell_lid *lid);

/* Does a face that looks the other way lie on a lid, but for rounding? */
int body_rest_on_lid(const struct hierarchy *h, const struct shell_lid *lid);

/* The same of an element, a group or a face. */
int body_rest_is_on(const struct hierarchy *h, const struct element *e);

#endif
