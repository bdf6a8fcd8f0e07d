/* error_summary.c - see error_summary.h. Errors are shares of the reflected light.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include "commands/account_summary.h"
#include "commands/error_summary.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/report.h"

int measured_wants_leaves(const struct options *o)
{
    return o->out || o->image_error;
}

int measured_take(struct measured *m, const struct options *o, RadDevice device,
                  RadSolution solution)
{
    *m = (struct measured){0};
    /* what is written of faces and of the whole alone needs no quarter */
    const struct RadCorrectOptions correct = {.own = !o->out && !o->image && !o->image_error
                                                     && o->errors != ERRORS_ALL};
    if (!o->no_correct) {
        if (radCorrect(solution, &correct, &m->alone) < 0)
            return report_device(device, o->scene);
        m->mended = 1;
    }
    if (!o->no_errors) {
        struct RadReport report;
        radGetReport(solution, &report);
        const struct RadMeasureOptions how = {.surfaces = o->errors != ERRORS_UNSAID
                                                          || RAD_MEASURE_SHARE * (double)report.rays
                                                                 > RAD_MEASURE_SURFACES,
                                              .polygons = !measured_wants_leaves(o)};
        if (radMeasureError(solution, &how, &m->error) < 0)
            return report_device(device, o->scene);
        m->measured = 1;
    }
    return 0;
}

int measured_account(struct measured *m, const struct options *o, RadDevice device,
                     RadSolution solution)
{
    double start = seconds();
    if (radAccountErrors(solution, &o->account, &m->account) < 0)
        return report_device(device, o->scene);
    m->account_seconds = seconds() - start;
    m->accounted = 1;
    return 0;
}

/* of what is emitted: chosen, as large an error would be told, too */
static const double BACKS_TOLD = 0.01;

/* Light that ends where nobody meant it to, as a rule. */
static void warn_of_backs(const struct RadErrorReport *r, const char *where)
{
    if (r->backs > BACKS_TOLD)
        report_warning(where, 0,
                       "%.3g %% of the light ends on black backs, %.3g %% of that on the back of "
                       "face %u: if faces are turned the wrong way, turn them, or take --two-sided",
                       100 * r->backs, 100 * r->back_share, (unsigned)r->back);
}

/* "2.1 % (1.9 to 2.3)", or "at most 1.9 %" where nothing is surely off. */
static void print_share(FILE *out, const struct RadMeasure *m)
{
    if (m->low > 0)
        fprintf(out, "%.2g %% (%.2g to %.2g)", 100 * m->value, 100 * m->low, 100 * m->high);
    else
        fprintf(out, "at most %.2g %%", 100 * m->high);
}

/* Less than that, of all light, is right: rounding, or particles that are scaled to what is known
 * of all light (power_balance.h), may seem surer than it is of use to tell. */
#define RIGHT 1e-4

/* ", 1.2 % too little in all", or ", in all right within 1.2 %" where that says more than the error
 * per face, which the error in all is never above. */
static void print_power(FILE *out, const struct RadErrorReport *r)
{
    const double within = fmax(fmax(-r->power.low, r->power.high), RIGHT);
    const int sure = r->power.low > 0 || r->power.high < 0;
    if (sure && fabs(r->power.value) >= RIGHT)
        fprintf(out, ", %.2g %% too %s in all", 100 * fabs(r->power.value),
                r->power.value < 0 ? "little" : "much");
    else if (within < r->l1_faces.high)
        fprintf(out, ", in all right within %.2g %%", 100 * within);
}

void measured_warn(const struct measured *m, const char *where)
{
    const struct RadMeasure *l1 = &m->error.l1_faces;
    if (m->measured)
        warn_of_backs(&m->error, where);
    if (m->measured && m->error.unseen > 0)
        report_warning(where, 0,
                       "none of %.3g particles was reflected: of what is, nothing is known but "
                       "that it is less than about %.2g W; is a lamp shut in, or turned the wrong "
                       "way?",
                       (double)m->error.particles, m->error.unseen);
    else if (m->measured && l1->value > MEASURED_WARNING)
        report_warning(
            where, 0,
            "reflected light per face is off by %.2g %% (%.2g to %.2g): %s; --image-error FILE.png "
            "shows where",
            100 * l1->value, 100 * l1->low, 100 * l1->high,
            m->mended
                ? "smaller thresholds (--set) or --accuracy bring it down"
                : "leave out --no-correct, which mends it, or take smaller thresholds (--set)");
    else if (m->measured && l1->high > 2 * MEASURED_WARNING)
        report_warning(where, 0,
                       "reflected light per face may be off by as much as %.2g %%: too few "
                       "particles to say",
                       100 * l1->high);
}

double measured_seconds(const struct measured *m)
{
    return (m->mended ? m->alone.seconds : 0) + (m->measured ? m->error.seconds : 0)
           + (m->accounted ? m->account_seconds : 0);
}

/* faces on a line of the summary */
enum { UNSURE_SHOWN = 8 };

/* Large faces that too little light meets for it to be known. */
static void print_unsure(const struct measured *m)
{
    const struct RadErrorReport *r = &m->alone;
    if (!m->mended || r->unsure == 0)
        return;
    printf(
        "dim       %u of %u large faces%s are too dim for their light to be known to 5 %%: %sface",
        (unsigned)r->unsure, (unsigned)r->large, r->gathered > 0 ? " and groups of small ones" : "",
        r->gathered > 0 ? "among them " : "");
    for (uint32_t i = 0; i < r->unsure && i < UNSURE_SHOWN; i++)
        printf("%s %u", i > 0 ? "," : r->unsure > 1 ? "s" : "", (unsigned)r->unsure_named[i]);
    puts(r->unsure > UNSURE_SHOWN ? ", ... (--json has all)" : "");
}

/* Smaller faces that nobody knows, which no figure of all light shows: a room in a landscape. */
static void print_small(const struct measured *m)
{
    const struct RadErrorReport *r = &m->alone;
    if (m->mended && r->small_unsure > 0)
        printf("small     %u face%s of %.3g m2 in all, each below 1 %% of the area, %s not known "
               "to 5 %%\n",
               (unsigned)r->small_unsure, r->small_unsure > 1 ? "s" : "", r->small_area,
               r->small_unsure > 1 ? "are" : "is");
}

/* of a band's own light: as a reader holds every face to, and so many times as of all light */
static const double BAND_TOLD = 0.05, BAND_WORSE = 4;

/* Bands that have too few of the particles for their light to be known. */
static void print_bands(const struct measured *m)
{
    const struct RadErrorReport *r = &m->alone;
    double all = 0;
    for (int k = 0; k < 3; k++)
        all += r->band_light[k] * r->band_noise[k];
    for (int k = 0; k < 3 && m->mended; k++) {
        const double noise = r->band_noise[k];
        if (!(noise > BAND_TOLD && noise > BAND_WORSE * all))
            continue;
        printf("bands     of band %d, %.2g %% of the reflected light, particles know ", k,
               100 * r->band_light[k]);
        if (noise < 0.5)
            printf("faces to %.2g %% only; the rest is as links say\n", 100 * noise);
        else
            puts("next to nothing; it is as links say");
    }
}

/* What nobody knows is not surely wrong: where that are large faces it is said with it. */
static void print_none_wrong(const struct measured *m)
{
    const struct RadErrorReport *r = &m->alone;
    fputs("; no large face is surely wrong", stdout);
    if (m->mended && r->unsure > 0)
        printf(", but %u of %u %s not known", (unsigned)r->unsure, (unsigned)r->large,
               r->unsure > 1 ? "are" : "is");
    putchar('\n');
}

void measured_print(const struct measured *m, uint32_t polygons, int no_links)
{
    const struct RadErrorReport *e = &m->error;
    if (m->mended && m->alone.reflected > 0) {
        printf("mended    by %s (%.3g rays); %s alone are off by ",
               m->alone.by_paths ? "paths" : "particles", (double)m->alone.rays,
               no_links ? "the first few" : "the links");
        print_share(stdout, &m->alone.l1_faces);
        fputs(" per face", stdout);
        print_power(stdout, &m->alone);
        putchar('\n');
    }
    if (!m->measured)
        return;
    if (e->unseen > 0) {
        printf("error     not known: none of %.3g particles was reflected; less than about %.2g W "
               "is\n",
               (double)e->particles, e->unseen);
        print_unsure(m);
        print_small(m);
        return;
    }
    if (!(e->reflected > 0)) {
        printf("error     none: no light is reflected, as no lamp and no face that reflects its "
               "light look at each other\n");
        return;
    }
    fputs("error     reflected light per face: off by ", stdout);
    print_share(stdout, &e->l1_faces);
    /* mending makes nothing worse: where twice as much was known of the links, this is noise */
    if (m->mended && !(e->l1_faces.low > 0) && e->l1_faces.high > 2 * m->alone.l1_faces.high)
        printf(", as far as %.3g %s tell", (double)e->particles,
               e->by_paths ? "paths" : "particles");
    print_power(stdout, e);
    if (e->worst < polygons && e->worst_share > 10) /* a face in the dark: percents say little */
        printf("; worst large face %u: %.3g times as bright as it should be\n", (unsigned)e->worst,
               1 + e->worst_share);
    else if (e->worst < polygons)
        printf("; worst large face %u: %.2g %% too %s, at the least %.2g\n", (unsigned)e->worst,
               100 * fabs(e->worst_share), e->worst_share < 0 ? "dark" : "bright",
               100 * e->worst_sure);
    else
        print_none_wrong(m);
    print_unsure(m);
    print_small(m);
    print_bands(m);
    if (e->backs > 0)
        printf("backs     %.3g %% of the emitted light ends on black backs, %.3g %% of that on the "
               "back of face %u\n",
               100 * e->backs, 100 * e->back_share, (unsigned)e->back);
    if (!(e->l2.high > 0))
        return;
    fputs("surfaces  root mean square off by ", stdout);
    print_share(stdout, &e->l2);
    if (e->p999.low > 0)
        printf("; 99.9 %% of the area by less than %.2g %% (%.2g to %.2g) of the mean\n",
               100 * e->p999.value, 100 * e->p999.low, 100 * e->p999.high);
    else
        printf("; too few rays to say how far single spots are\n");
}

/* null: nothing is known. */
static json_t *measure_json(const struct RadMeasure *m)
{
    if (isinf(m->high))
        return json_null();
    return json_pack("{s:f, s:f, s:f}", "value", m->value, "low", m->low, "high", m->high);
}

/* Of what was measured only where it was asked for. */
static json_t *surface_json(const struct RadMeasure *m)
{
    return m->high > 0 ? measure_json(m) : json_null();
}

static json_t *report_json(const struct RadErrorReport *r)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:I, s:I, s:b, s:f, s:f}", "power",
                     measure_json(&r->power), "l1_faces", measure_json(&r->l1_faces), "l2",
                     surface_json(&r->l2), "p999", surface_json(&r->p999), "rays",
                     (json_int_t)r->rays, "particles", (json_int_t)r->particles, "by_paths",
                     (int)r->by_paths, "reflected", r->reflected, "seconds", r->seconds);
}

/* null: no back is met. */
static json_t *backs_json(const struct RadErrorReport *r)
{
    if (!(r->backs > 0))
        return json_null();
    return json_pack("{s:f, s:I, s:f}", "share", r->backs, "face", (json_int_t)r->back,
                     "share_of_that", r->back_share);
}

/* What chance leaves of each band. */
static json_t *bands_json(const struct RadErrorReport *r)
{
    json_t *all = json_array();
    int bands = 3;
    while (bands > 0 && !(r->band_light[bands - 1] > 0))
        bands--;
    for (int k = 0; k < bands; k++)
        json_array_append_new(
            all, json_pack("{s:f, s:f}", "light", r->band_light[k], "noise", r->band_noise[k]));
    return all;
}

/* The large face that is most surely wrong; null: none is. */
static json_t *worst_json(const struct RadErrorReport *r, uint32_t polygons)
{
    if (r->worst >= polygons)
        return json_null();
    return json_pack("{s:I, s:f, s:f}", "face", (json_int_t)r->worst, "share", r->worst_share,
                     "at_least", r->worst_sure);
}

json_t *measured_json(const struct measured *m, uint32_t polygons)
{
    if (!m->measured && !m->accounted)
        return json_null();
    json_t *all = m->measured ? report_json(&m->error) : json_object();
    if (m->measured) {
        json_object_set_new(all, "worst", worst_json(&m->error, polygons));
        json_object_set_new(all, "backs", backs_json(&m->error));
    }
    if (m->accounted)
        json_object_set_new(all, "account", account_json(&m->account));
    return all;
}

/* The large faces that are not known. */
static json_t *unsure_json(const struct RadErrorReport *r)
{
    json_t *faces = json_array();
    for (uint32_t i = 0; i < r->unsure && i < RAD_UNSURE_NAMED; i++)
        json_array_append_new(faces, json_integer(r->unsure_named[i]));
    return faces;
}

json_t *mended_json(const struct measured *m)
{
    if (!m->mended)
        return json_null();
    json_t *all = report_json(&m->alone);
    json_object_set_new(all, "bands", bands_json(&m->alone));
    json_object_set_new(all, "large_faces", json_integer(m->alone.large));
    json_object_set_new(all, "large_groups", json_integer(m->alone.gathered));
    json_object_set_new(all, "large_faces_unsure", json_integer(m->alone.unsure));
    json_object_set_new(all, "first_unsure", unsure_json(&m->alone));
    json_object_set_new(all, "small_faces_unsure", json_integer(m->alone.small_unsure));
    json_object_set_new(all, "small_faces_unsure_area", json_real(m->alone.small_area));
    return all;
}
