/* arvo.h - how far constants over n x n squares are from the light of a square lamp.
 *
 * The experiment of Arvo, Torrance and Smits 1994, their figure 4, in the setting of
 * radiosity's own table of it: a unit square of exitance 1 W/m2 shines on a parallel receiver of
 * 10 x 10 m, 1 m away and centred, which reflects all and sends nothing back. So the function that
 * is approximated is f(x, y) = F, the view factor of the source from a point.
 * SPDX-License-Identifier: MIT */
#ifndef ARVO_H
#define ARVO_H

enum arvo_norm { ARVO_L1, ARVO_L2, ARVO_LINF, ARVO_NORMS };

/* Which constant an element has. BEST: the one that is nearest to f in the norm, which is the
 * median in L1, the mean in L2, the middle of the range in Linf. GALERKIN: the mean, in each.
 * COLLOCATION: f at the element's centre. */
enum arvo_projection { ARVO_BEST, ARVO_GALERKIN, ARVO_COLLOCATION, ARVO_PROJECTIONS };

struct arvo_errors {
    double norm[ARVO_NORMS];                 /* of f itself: W, W/m, W/m2 */
    double of[ARVO_NORMS][ARVO_PROJECTIONS]; /* norms of f less the constants, in the same units */
};

/* The errors with n x n elements, to nine digits or more. */
void arvo_measure(struct arvo_errors *errors, int n);

/* The same from the midpoints of a grid, `samples` (or up to n - 1 more) across the receiver: what
 * a computation by samples makes of L1 and L2. Linf is that of arvo_measure. Returns 0, or -1 when
 * out of memory. */
int arvo_sample(struct arvo_errors *errors, int n, int samples);

#endif
