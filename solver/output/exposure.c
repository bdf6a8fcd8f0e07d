/* exposure.c - see exposure.h.
 * SPDX-License-Identifier: MIT */
#include "output/exposure.h"

#include <math.h>
#include <stdlib.h>

#include "kernel/constants.h"

double luminance(const double *radiosity, uint32_t bands)
{
    return bands == 1 ? radiosity[0]
                      : 0.2126 * radiosity[0] + 0.7152 * radiosity[1] + 0.0722 * radiosity[2];
}

static int by_luminance(const void *a, const void *b)
{
    double x = ((const struct meter_sample *)a)->luminance,
           y = ((const struct meter_sample *)b)->luminance;
    return (x > y) - (x < y);
}

struct exposure exposure_measure(struct meter_sample *samples, size_t count)
{
    double lit = 0, sum = 0, below = 0, bright = 0;
    if (count)
        qsort(samples, count, sizeof *samples, by_luminance);
    for (size_t i = 0; i < count; i++)
        lit += samples[i].luminance > 0 ? samples[i].weight : 0;
    if (!(lit > 0))
        return (struct exposure){1, 1};
    for (size_t i = 0; i < count && below <= EXPOSURE_BRIGHT * lit; i++)
        if (samples[i].luminance > 0) {
            below += samples[i].weight;
            bright = samples[i].luminance;
        }
    /* Near-black corners would drag the log-mean to nothing. */
    double least = 1e-3 * bright;
    for (size_t i = 0; i < count; i++)
        if (samples[i].luminance > 0)
            sum += samples[i].weight * log(fmax(samples[i].luminance, least));
    struct exposure e = {.scale = EXPOSURE_MIDDLE / exp(sum / lit)};
    e.white = fmin(fmax(1.2 * bright * e.scale, 1), 12);
    return e;
}

void exposure_apply(const struct exposure *exposure, const double *radiosity, uint32_t bands,
                    double colour[3])
{
    double in = luminance(radiosity, bands) * exposure->scale, white = exposure->white;
    double out = in * (1 + in / (white * white)) / (1 + in),
           gain = in > 0 ? out / in * exposure->scale : 0;
    for (uint32_t k = 0; k < 3; k++) {
        double c = radiosity[bands == 1 ? 0 : k] * gain;
        colour[k] = c < 1 ? (c > 0 ? c : 0) : 1;
    }
}

uint8_t srgb_byte(double linear)
{
    double s = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
    return (uint8_t)(fmin(fmax(s, 0), 1) * 255 + 0.5);
}
