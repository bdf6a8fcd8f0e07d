/* error_image.h - a picture of the measured error: where a solution is too bright or too dark.
 *
 * The colour says by which share of the light that a place truly reflects it is off, lamps' own
 * light left out: blue where it is too dark, red where it is too bright, the darkest blue and red
 * where it is off by more than the scale shows. Where no error stands clear of the measurement's
 * noise it is grey: plain where the light is known to ERROR_IMAGE_KNOWN, hatched where it is not.
 * The light itself is seen faintly below, so that one knows what is where; a scale stands at the
 * lower edge.
 *
 * Places that reflect next to nothing would be off by any share: for colours none counts as darker
 * than ERROR_IMAGE_DARK of the mean. Whether light is known is asked of the place's own.
 * SPDX-License-Identifier: MIT */
#ifndef ERROR_IMAGE_H
#define ERROR_IMAGE_H

#include "output/vertex_values.h"
#include "output/view.h"

/* of the mean radiosity reflected. A tenth of the mean is black to an eye used to the mean: a
 * display that shows it as a hundredth is said to have a poor black */
#define ERROR_IMAGE_DARK 0.1

/* of the light reflected. What a reader may hold every place to; as the line "dim" of the summary
 * does for large faces */
#define ERROR_IMAGE_KNOWN 0.05

/* Of one element: B less the truth, as a share; error: [element * bands + band], W/m2. 0 of lamps.
 * `mean`: error_image_mean's. */
double error_image_share(const struct solution *solution, const double *error, double mean,
                         uint32_t element);

/* The mean radiosity that surfaces other than lamps truly reflect, as luminance, W/m2. */
double error_image_mean(const struct solution *solution, const double *error);

/* The share that the ends of the scale stand for: 1, 2 or 4 times a power of ten, such that a
 * hundredth of the area at the most is off by more; from 1 %, below which an eye sees no
 * difference, to 1000 %. It does not depend on the view. Returns -1 when out of memory. */
double error_image_scale(const struct solution *solution, const double *error);

/* [element * bands + band], W/m2: as radGetElementErrors and radGetElementErrorLimits give them. */
struct error_seen {
    const double *error, *limit;
};

/* Is no error told of an element, and yet its light, however dim, not known to ERROR_IMAGE_KNOWN?
 */
int error_image_unknown(const struct solution *solution, const struct error_seen *seen,
                        uint32_t element);

/* Draw the error; all else as image_write. The scale covers the lower edge; it is left out of a
 * picture too small for it. Returns 0, or -1 after one line on stderr. */
int error_image_write(const char *path, const struct solution *solution,
                      const struct vertex_values *values, const struct error_seen *seen,
                      const struct view *view, int width, int height, int mesh);

#endif
