/* device.h - the library's device as the command uses it: what it says goes to standard error.
 * SPDX-License-Identifier: MIT */
#ifndef DEVICE_H
#define DEVICE_H

#include "radiosity.h"

/* The hand-written releases that devices opened from now on know: a table that ends with NULL
 * and is borrowed. */
void register_hand_releases(const struct oracle *const *table);

/* The files that devices opened from now on load by radLoadPlugin: [count], borrowed. */
void use_plugins(char *const *paths, int count);

/* Returns NULL after a message. */
RadDevice open_device(int threads);

/* Say what the device's last call could not do, as "where: error: sentence". Returns -1. */
int report_device(RadDevice device, const char *where);

/* The same, but not a word where it was cancelled. Returns 1 then, else -1. */
int report_unless_cancelled(RadDevice device, const char *where);

#endif
