/* mended_reach.c - see mended_reach.h.
 *
 * Those that measure are a twentieth of those that mend, and their noise is four times as large:
 * alone they say little more than that nothing is wrong by several times what is left. Those that
 * mend know more, and two things of it may be believed though they judge themselves.
 *
 * Power. What they counted of all light is right in the mean, whatever was made of it. So what both
 * counted is weighed by variances. Where the two are farther apart than these allow, some light may
 * be seen by few: then the variance of the mean is larger by the square of how much.
 * [Birge 1932] And as with those that measure (face_error.c) one particle more may have been
 * spared: in a closed room of one reflectance all of them agree, to the last bit, on light of which
 * a crack or a dark patch that none has met takes a part.
 *
 * L1. What mending leaves is an unbiased estimate of risk (mend_risk.c), of large polygons the
 * whole noise of the particles, and the upper end of both is known (mended_error.c). Nothing is
 * believed beyond that, and not that where those that measure are sure of more.
 *
 * [derived here; coverage: tests/runtime/check_measured_error.c]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/mended_error.h"
#include "engine/mended_reach.h"
#include "engine/solve.h"
#include "engine/reflected_light.h"

int mended_reach_find(const struct solve *s, const struct tally *tally, struct mended_reach *reach)
{
    struct face_noise noise;
    struct mended_error left;
    *reach = (struct mended_reach){0, 0, 0, 0};
    if (face_noise_find(&s->problem, &s->hierarchy, s->state.irradiance, tally, &noise) < 0
        || mended_error_find(s, tally, &noise, &left) < 0)
        return -1;
    reach->light = reflected_light(&s->problem, tally, &reach->variance);
    if (!tally->by_paths && tally->particles > 0) { /* of paths the variance has it */
        const double one = reach->light / ((double)tally->particles * REPLICATES);
        reach->variance += one * one;
    }
    if (!(reach->light > 0 && left.most > 0))
        return 0;
    reach->left = left.value;
    reach->l1 = left.most;
    return 0;
}

static struct RadMeasure narrow_power(const struct mended_reach *reach, const struct face_error *f)
{
    const double solved = f->reflected * (1 + f->power.value),
                 deviation = (f->power.high - f->power.value) / REPLICATES_T * f->reflected
                             * f->reflected / solved,
                 own = deviation * deviation, apart = f->reflected - reach->light;
    if (!(own > 0) || !(reach->variance > 0))
        return f->power;
    const double both = own + reach->variance,
                 light = (f->reflected * reach->variance + reach->light * own) / both,
                 variance = own * reach->variance / both * fmax(1, apart * apart / both),
                 value = solved / light - 1,
                 off = REPLICATES_T * sqrt(variance) * solved / (light * light);
    return (struct RadMeasure){value, value - off, value + off};
}

void mended_reach_narrow(const struct mended_reach *reach, struct face_error *f)
{
    if (!(reach->l1 > 0) || !(f->reflected > 0))
        return;
    if (reach->l1 > f->l1.low) {
        f->l1.high = fmin(f->l1.high, reach->l1);
        if (f->l1.value > f->l1.high)
            f->l1.value = fmin(fmax(reach->left, f->l1.low), f->l1.high);
    }
    f->power = narrow_power(reach, f);
    face_error_agree(f);
}
