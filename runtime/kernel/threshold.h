/* threshold.h - the larger of `absolute` and `relative` times the scene's mean, in the unit of
 * both: what most questions hold an error against.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_THRESHOLD_H
#define KERNEL_THRESHOLD_H

static inline double threshold(double absolute, double relative, double mean)
{
    double share = relative * mean;
    return absolute > share ? absolute : share;
}

#endif
