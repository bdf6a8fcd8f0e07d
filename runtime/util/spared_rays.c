/* spared_rays.c - see spared_rays.h.
 * SPDX-License-Identifier: MIT */
#include "util/spared_rays.h"

_Thread_local uint64_t spared_rays;
