/* error_summary.c - see error_summary.h. Errors are shares of the reflected light.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include "commands/account_summary.h"
#include "commands/error_summary.h"
#include "util/device.h"
#include "util/report.h"

int measured_take(struct measured *m, const struct options *o, RadDevice device,
                  RadSolution solution)
{
    *m = (struct measured){0};
    if (!o->no_correct) {
        if (radCorrect(solution, NULL, &m->alone) < 0)
            return report_device(device, o->scene);
        m->mended = 1;
    }
    if (!o->no_errors) {
        struct RadMeasureOptions how = {0};
        if (radMeasureError(solution, &how, &m->error) < 0)
            return report_device(device, o->scene);
        m->measured = 1;
    }
    return 0;
}

int measured_account(struct measured *m, const struct options *o, RadDevice device,
                     RadSolution solution)
{
    if (radAccountErrors(solution, &o->account, &m->account) < 0)
        return report_device(device, o->scene);
    m->accounted = 1;
    return 0;
}

static const char *direction(double power)
{
    return power < 0 ? "too little" : "too much";
}

void measured_warn(const struct measured *m, const char *where)
{
    const struct RadMeasure *l1 = &m->error.l1_faces;
    if (m->measured && l1->value > MEASURED_WARNING)
        report_warning(where, 0, "reflected light per face is off by %.2g %% (%.2g to %.2g): %s",
                       100 * l1->value, 100 * l1->low, 100 * l1->high,
                       m->mended ? "more particles or smaller thresholds (--accuracy) bring it down"
                                 : "leave out --no-correct, or take smaller thresholds (--set)");
    else if (m->measured && l1->high > 2 * MEASURED_WARNING)
        report_warning(where, 0,
                       "reflected light per face may be off by as much as %.2g %%: too few "
                       "particles to say",
                       100 * l1->high);
}

void measured_print(const struct measured *m, uint32_t polygons)
{
    if (m->mended)
        printf(
            "mended    by %.3g particles (%.3g rays, %.2f s); the links alone are off by %.2g %% "
            "per face (%.2g to %.2g), %.2g %% %s in all\n",
            (double)m->alone.particles, (double)m->alone.rays, m->alone.seconds,
            100 * m->alone.l1_faces.value, 100 * m->alone.l1_faces.low,
            100 * m->alone.l1_faces.high, 100 * fabs(m->alone.power.value),
            direction(m->alone.power.value));
    if (!m->measured)
        return;
    const struct RadErrorReport *e = &m->error;
    if (!(e->reflected > 0)) {
        printf("error     none: no light is reflected\n");
        return;
    }
    if (e->l1_faces.low > 0)
        printf("error     reflected light per face: off by %.2g %% (%.2g to %.2g)",
               100 * e->l1_faces.value, 100 * e->l1_faces.low, 100 * e->l1_faces.high);
    else
        printf("error     reflected light per face: off by at most %.2g %%",
               100 * e->l1_faces.high);
    printf(", %.2g %% %s in all (+-%.2g); ", 100 * fabs(e->power.value), direction(e->power.value),
           50 * (e->power.high - e->power.low));
    if (e->worst < polygons)
        printf("worst large face %u: %.2g %% too %s\n", (unsigned)e->worst,
               100 * fabs(e->worst_share), e->worst_share < 0 ? "dark" : "bright");
    else
        printf("no large face is surely wrong\n");
}

static json_t *measure_json(const struct RadMeasure *m)
{
    return json_pack("{s:f, s:f, s:f}", "value", m->value, "low", m->low, "high", m->high);
}

static json_t *report_json(const struct RadErrorReport *r)
{
    return json_pack("{s:o, s:o, s:I, s:I, s:f, s:f}", "power", measure_json(&r->power), "l1_faces",
                     measure_json(&r->l1_faces), "rays", (json_int_t)r->rays, "particles",
                     (json_int_t)r->particles, "reflected", r->reflected, "seconds", r->seconds);
}

json_t *measured_json(const struct measured *m)
{
    if (!m->measured && !m->accounted)
        return json_null();
    json_t *all = m->measured ? report_json(&m->error) : json_object();
    if (m->accounted)
        json_object_set_new(all, "account", account_json(&m->account));
    return all;
}

json_t *mended_json(const struct measured *m)
{
    return m->mended ? report_json(&m->alone) : json_null();
}
