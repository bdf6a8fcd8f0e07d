/* power_gap.h - question: may this link falsify the power that faces receive by more than its part of `watts`? W.
 *
 * Asked of every link, all links together stay below `watts`: a link's part is mu watts, with
 *     mu = 1/2 A_r F B_s / (A H) + 1/2 A_r A_s / A^2,
 * A the scene's area and H its mean irradiance. Links cover each pair of points once, so the second terms sum to 1/2 at
 * the most; the first sum to 1/2 times the mean irradiance found over H, the one to expect. Nobody needs to know how many
 * links there will be.
 *
 * What a link does to the mean of B over a face. The link gives the receiver F V B_s all over, where there is B_s F(x) V(x):
 * of the difference g the mean over r counts in full, and that is what the visibility's error makes of it, F sigma_V. The
 * rest of g has no mean. It does harm only by what r sends on: a receiver t gets the integral of g(x) F_xt, which is as
 * large as both g and F_xt vary over r. Likewise the emitter's own variation counts only with that of F over it.
 * So with dr = (F_max - F_min) / (F_max + F_min) over the receiver, ds the same of F_sr over the emitter, both sampled, e_s
 * the spread of B over the emitter, and half of the products that mixed terms make on either side of them,
 *     shape = rho_r A_r F V (B_s (dr^2 + ds^2)/2 + e_s ds)     against mu watts,
 *     noise = rho_r A_r F B_s sigma_V                          against sqrt(mu) `noise`.
 * Rays of different links err independently, so their variances add: sum (sqrt(mu) noise)^2 <= noise^2, a standard
 * deviation. No visibility known: V = 1, and no noise. Shape is asked first. Where the shadow lies within r is no concern
 * of this question: a blurred shadow moves no power between faces at first order. [D: derived here; the norm is that of
 * Arvo, Torrance and Smits 1994, L1, in which reflection amplifies by 1/(1 - rho) at the most]
 * Fails: sampled ranges, and e_s of what has been split so far; sigma_V is statistical; where elements touch, dr
 * does not shrink, and a guard has to end it (such links shrink with their area, so the guard's marks bound what
 * they bring).
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_POWER_GAP_H
#define TOOL_POWER_GAP_H

#include "discussion.h"
#include "terms/form_factor.h"
#include "terms/form_factor_range.h"
#include "terms/visibility_error.h"

static inline double power_gap_relative(const double range[2])
{
    return range[1] > 0 ? (range[1] - range[0]) / (range[1] + range[0]) : 1;
}

/* ds above. */
OUTLINE double power_gap_emitter(const struct element *r, const struct element *s)
{
    double range[2];
    form_factor_range_sample(s, r, range);
    return power_gap_relative(range);
}

TOOL enum power_gap_answer tool_power_gap(struct discussion *d, double watts, double noise)
{
    const struct element *r = d->receiver, *s = d->emitter;
    const struct host *h = d->host;
    double v = 1, sigma = 0, dr, ds, by_r, by_s, part, power, arrives = h->area * h->irradiance;
    power = r->area * s->radiosity * term_form_factor(d, FORM_FACTOR_POLYGON);
    part = 0.5 * (r->area / h->area) * (s->area / h->area);
    if (arrives > 0)
        part += 0.5 * power / arrives;
    if (d->terms.visibility_level > VISIBILITY_ABSENT) {
        v = d->terms.visibility;
        sigma = term_visibility_error(d);
    }
    power *= r->reflectance;
    if (power + r->reflectance * r->area * s->spread * term_form_factor(d, FORM_FACTOR_POLYGON) > part * watts) { /* dr, ds <= 1 */
        dr = power_gap_relative(term_form_factor_range(d, FORM_FACTOR_RANGE_SAMPLED));
        ds = power_gap_emitter(r, s);
        by_r = 0.5 * power * v * dr * dr;
        by_s = 0.5 * power * v * ds * ds + r->reflectance * r->area * s->spread * v * term_form_factor(d, FORM_FACTOR_POLYGON) * ds;
        if (by_r + by_s > part * watts)
            return by_r >= by_s ? POWER_GAP_RECEIVER : POWER_GAP_EMITTER;
    }
    return power * sigma > sqrt(part) * noise ? POWER_GAP_RAYS : POWER_GAP_SMALL;
}

#endif
