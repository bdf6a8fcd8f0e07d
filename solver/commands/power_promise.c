/* power_promise.c - see power_promise.h.
 *
 * An oracle bounds the error of each link, not what all of them make together: where a wall is
 * bright near a lit edge they have one sign, and in a plain cube add up to seven times what
 * examples/oracles/thermal.dag counts on. Smaller thresholds help little: ten times smaller ones
 * cost seven times the links there and leave two fifths of the error. Particles keep the promise
 * for less, since the power of a whole face is what they know best.
 *
 * So: what the first measurement shows to be kept, is. Else the solution is mended until the noise
 * of that is NOISE of the tolerance, and held against as many other particles. Bands are taken
 * together: when all of them are within the tolerance, each is. [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include "commands/power_promise.h"
#include "util/device.h"
#include "util/report.h"

#define NOISE 0.25 /* of the tolerance: what mending may leave to chance */
#define WIDTH 0.5  /* of the tolerance: what the interval may be wide where nothing is mended */
/* rays, and times those that the solve has cast: more are not traced for a promise */
#define RAYS_MOST (1u << 26)
#define RAYS_SHARE 4.0

static void judge_promise(struct power_promise *p, const struct measured *m)
{
    const double reflected = m->error.reflected;
    if (m->error.unseen > 0) { /* all that might be reflected may be wrong */
        p->value = p->low = 0;
        p->high = m->error.unseen;
        return;
    }
    p->value = m->error.l1_faces.value * reflected;
    p->low = m->error.l1_faces.low * reflected;
    p->high = m->error.l1_faces.high * reflected;
    if (m->mended) /* by luck no measurement makes it less than what mending left to chance */
        p->high = fmax(p->high, m->alone.noise.high * reflected);
}

int power_promise_hold(struct power_promise *p, struct measured *m, const struct options *o,
                       RadDevice device, RadSolution solution)
{
    struct RadReport report;
    radGetReport(solution, &report);
    *p = (struct power_promise){
        .tolerance = report.power_tolerance, .value = -1, .bands = report.bands};
    if (!(p->tolerance > 0) || !m->measured)
        return 0;
    judge_promise(p, m);
    if (p->high <= p->tolerance)
        return 0;
    const double most = fmax(RAYS_MOST, RAYS_SHARE * (double)report.rays);
    struct RadMeasureOptions other = {.stream = 1};
    if (m->mended) {
        const struct RadCorrectOptions better = {
            .noise = fmin(0.5, NOISE * p->tolerance / m->error.reflected), .rays = (uint64_t)most};
        if (radCorrect(solution, &better, &m->alone) < 0)
            return report_device(device, o->scene);
        other.rays = m->alone.rays;
    } else {
        const double times = (p->high - p->low) / (WIDTH * p->tolerance);
        other.rays = (uint64_t)fmin(most, fmax(1, times * times) * (double)m->error.rays);
    }
    if (radMeasureError(solution, &other, &m->error) < 0)
        return report_device(device, o->scene);
    judge_promise(p, m);
    return 0;
}

/* Some band is surely off by more. */
static int is_broken(const struct power_promise *p)
{
    return p->low > p->tolerance * p->bands;
}

void power_promise_warn(const struct power_promise *p, const char *where)
{
    if (!(p->tolerance > 0) || p->value < 0 || p->high <= p->tolerance)
        return;
    const char *together = p->bands > 1 ? ", all bands together" : "";
    if (is_broken(p))
        report_warning(
            where, 0,
            "the oracle promised powers of faces right to %.3g W in all, but they are "
            "off by %.3g to %.3g W%s; allow more watts, or let particles mend it, without "
            "--no-correct",
            p->tolerance, p->low, p->high, together);
    else
        report_warning(where, 0,
                       "the oracle promised powers of faces right to %.3g W in all, which cannot "
                       "be shown: they may be off by %.3g W%s; allow so much",
                       p->tolerance, p->high, together);
}

void power_promise_print(const struct power_promise *p)
{
    if (!(p->tolerance > 0))
        return;
    printf("promise   powers of faces right to %.3g W in all: ", p->tolerance);
    if (p->value < 0)
        printf("not measured\n");
    else if (p->high <= p->tolerance)
        printf("kept, off by at most %.3g W\n", p->high);
    else
        printf("%s, off by %.3g to %.3g W\n", is_broken(p) ? "not kept" : "not shown", p->low,
               p->high);
}

json_t *power_promise_json(const struct power_promise *p)
{
    if (!(p->tolerance > 0))
        return json_null();
    if (p->value < 0)
        return json_pack("{s:f, s:n}", "tolerance", p->tolerance, "value");
    return json_pack("{s:f, s:f, s:f, s:f, s:b}", "tolerance", p->tolerance, "value", p->value,
                     "low", p->low, "high", p->high, "kept", p->high <= p->tolerance);
}
