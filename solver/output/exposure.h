/* exposure.h - from W/m2 to what a screen can show.
 *
 * Like a camera that meters the scene: the log-mean of what is not a lamp becomes a middle grey, a
 * gentle shoulder keeps the bright parts, lamps go white. The curve acts on the luminance and
 * keeps the hue. [Reinhard et al. 2002, equations 1 to 4]
 * SPDX-License-Identifier: MIT */
#ifndef EXPOSURE_H
#define EXPOSURE_H

#include <stddef.h>
#include <stdint.h>

struct exposure {
    double scale; /* from luminance in W/m2 to the curve's input */
    double white; /* the input that becomes 1 */
};

/* What the meter reads: a luminance, and how much of the picture or surface shows it. */
struct meter_sample {
    double luminance, weight;
};

/* The luminance of a radiosity of 1 or 3 bands. */
double luminance(const double *radiosity, uint32_t bands);

/* Sorts the samples. None, or all black: an exposure that shows black as black. */
struct exposure exposure_measure(struct meter_sample *samples, size_t count);

/* Linear colour, each channel 0 to 1. */
void exposure_apply(const struct exposure *exposure, const double *radiosity, uint32_t bands,
                    double colour[3]);

/* The sRGB transfer function, 0 to 255. [IEC 61966-2-1] */
uint8_t srgb_byte(double linear);

#endif
