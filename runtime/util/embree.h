/* embree.h - Embree 4 where it is installed, else 3; EMBREE says which.
 * SPDX-License-Identifier: MIT */
#ifndef EMBREE_H
#define EMBREE_H

#if defined __has_include
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define EMBREE 4
#endif
#endif
#ifndef EMBREE
#include <embree3/rtcore.h>
#define EMBREE 3
#endif

#endif
