/* pivots.c - the two points, with a normal each, between which a separable link's kernel is taken.
 *
 * They are found in three steps. First the flatter side is the mean of its faces that may turn to
 * the other's centre; then the other is the mean of its faces by what passes between them and that
 * first pivot; then the flatter side is found anew, likewise. So k(r, s) is not small where what
 * passes is not, though half of a side may lie behind the other's plane. A receiver's faces count
 * by their areas, an emitter's by what the oracles see them send.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include "engine/pivots.h"
#include "kernel/constants.h"

#define UNDERFLOW 1e-30f /* what is less is nothing: 1 over it is still a float */

/* Set *pivot from the sums of weights, of weighted centres, of weighted normals, and of normals .
 * centres. Returns the sum of weights, 0 where there is no pivot. */
static float mean_pivot(struct pivot *pivot, const float sum[8])
{
    float inverse = sum[0] > UNDERFLOW ? 1 / sum[0] : 0,
          length = sqrtf(sum[4] * sum[4] + sum[5] * sum[5] + sum[6] * sum[6]);
    pivot->shift = 0;
    for (int k = 0; k < 3; k++) {
        pivot->centre[k] = sum[1 + k] * inverse;
        pivot->normal[k] = length > 0 ? sum[4 + k] / length : 0;
        pivot->shift += pivot->normal[k] * pivot->centre[k];
    }
    pivot->shift -= length > 0 ? sum[7] / length : 0;
    return length > 0 && sum[0] > UNDERFLOW ? sum[0] : 0;
}

/* What a face weighs: what it may show in a direction; k(x, other); or that without the other's
 * cosine (PIVOT_RELIABLE). */
enum weighing { SHOWN, PASSING, PASSING_PLAIN };

/* Set *pivot to the mean of a side. SHOWN: `other` is a direction and, as its shift, the sine of an
 * angle about it; faces and normals weigh weight max(0, n . other->normal + other->shift). Else
 * faces weigh weight k(x, other), and normals that over n . v. `how` is a constant in every call,
 * so each is a loop of its own. Returns the sum of weights, 0 where there is no pivot. */
TOOL float find_pivot(struct pivot *pivot, const struct separable_side *side, const float *weight,
                      const struct pivot *other, enum weighing how)
{
    const struct separable_faces f = side->faces;
    const struct pivot o = *other;
    float all = 0, x = 0, y = 0, z = 0, nx = 0, ny = 0, nz = 0, plane = 0;
#pragma omp simd reduction(+ : all, x, y, z, nx, ny, nz, plane)
    for (size_t i = side->from; i < side->to; i++) {
        float w, n;
        if (how == SHOWN) {
            w = f.normal[0][i] * o.normal[0] + f.normal[1][i] * o.normal[1]
                + f.normal[2][i] * o.normal[2] + o.shift;
            w = positive_part(w) * weight[i];
            n = w;
        } else {
            float v[3] = {o.centre[0] - f.centre[0][i], o.centre[1] - f.centre[1][i],
                          o.centre[2] - f.centre[2][i]};
            float near = f.normal[0][i] * v[0] + f.normal[1][i] * v[1] + f.normal[2][i] * v[2];
            float far = o.shift - (o.normal[0] * v[0] + o.normal[1] * v[1] + o.normal[2] * v[2]);
            float square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2],
                  inverse = 1 / (square + SEPARABLE_TINY);
            w = weight[i] * (how == PASSING ? positive_part(far) : square) * inverse * inverse
                * positive_part(near);
            n = w / (fabsf(near) + SEPARABLE_TINY);
        }
        all += w;
        x += w * f.centre[0][i];
        y += w * f.centre[1][i];
        z += w * f.centre[2][i];
        nx += n * f.normal[0][i];
        ny += n * f.normal[1][i];
        nz += n * f.normal[2][i];
        plane += n
                 * (f.normal[0][i] * f.centre[0][i] + f.normal[1][i] * f.centre[1][i]
                    + f.normal[2][i] * f.centre[2][i]);
    }
    return mean_pivot(pivot, (const float[8]){all, x, y, z, nx, ny, nz, plane});
}

/* pi k(r, s) between two pivots. */
static float between(const struct pivot *r, const struct pivot *s)
{
    float v[3];
    for (int k = 0; k < 3; k++)
        v[k] = s->centre[k] - r->centre[k];
    float square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    float near = r->shift + r->normal[0] * v[0] + r->normal[1] * v[1] + r->normal[2] * v[2];
    float far = s->shift - (s->normal[0] * v[0] + s->normal[1] * v[1] + s->normal[2] * v[2]);
    return near > 0 && far > 0 ? near * far / (square * square) : 0;
}

float find_pivots(struct pivot *r, struct pivot *s, const struct element *receiver,
                  const struct element *emitter, const struct separable_side *of_r,
                  const struct separable_side *of_s)
{
    const int emitter_first =
        emitter->vertices || (!receiver->vertices && emitter->cone > receiver->cone);
    const struct element *flat = emitter_first ? emitter : receiver,
                         *round = emitter_first ? receiver : emitter;
    const struct separable_side *of_flat = emitter_first ? of_s : of_r,
                                *of_round = emitter_first ? of_r : of_s;
    const float *flat_weight = emitter_first ? of_s->faces.bright : of_r->faces.area;
    const float *round_weight = emitter_first ? of_r->faces.area : of_s->faces.bright;
    struct pivot first, *flat_pivot = emitter_first ? s : r, *round_pivot = emitter_first ? r : s;
    struct pivot direction = {.centre = {0}};
    double v[3];
    float turned = 0;
    sub3(v, round->centre, flat->centre);
    double distance = length3(v), reach = receiver->radius + emitter->radius;
    /* The nearer the centres, the more alike the faces weigh; at last no float tells them apart. */
    const int apart = distance > (double)FLT_EPSILON * reach;
    for (int k = 0; k < 3; k++)
        direction.normal[k] = apart ? (float)(v[k] / distance) : 0;
    direction.shift = apart ? (float)(reach / distance) : 1;
    if (!(find_pivot(&first, of_flat, flat_weight, &direction, SHOWN) > 0))
        return 0;
    for (int k = 0; k < 3; k++)
        turned += first.normal[k] * direction.normal[k];
    if (!((flat->vertices || (double)turned >= PIVOT_RELIABLE
               ? find_pivot(round_pivot, of_round, round_weight, &first, PASSING)
               : find_pivot(round_pivot, of_round, round_weight, &first, PASSING_PLAIN))
          > 0)
        || !(find_pivot(flat_pivot, of_flat, flat_weight, round_pivot, PASSING) > 0))
        return 0;
    float passes = between(r, s);
    return passes > UNDERFLOW ? passes : 0;
}
