/* spared_rays.h - how many segments this thread asked about that no ray was cast for. Whoever
 * counts rays by segments asked takes them off (oracle/counted_host.h). A host that spares none
 * need not know of it.
 * SPDX-License-Identifier: MIT */
#ifndef SPARED_RAYS_H
#define SPARED_RAYS_H

#include <stdint.h>

extern _Thread_local uint64_t spared_rays;

#endif
