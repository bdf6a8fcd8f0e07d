/* error.c - `radiosity error FACES.csv REF.csv`: how far a solution's faces are from a reference.
 *
 * Errors are of B - B_ref, told as shares of the reference's reflected light B_ref - E: of B they
 * would seem smaller wherever lamps stand. With A the area of a face,
 *
 *     power  sum A (B - B_ref) / sum A (B_ref - E): above 0, the solution is too bright
 *     L1     sum A |B - B_ref| / sum A |B_ref - E|
 *     L2     root of sum A (B - B_ref)^2 / sum A (B_ref - E)^2
 *     Linf   largest |B - B_ref| / largest |B_ref - E|
 *
 * per band, and over all bands at once. What the reference's own standard errors s would make of
 * these if there were no error: root of sum A^2 s^2 for the power; A s root(2/pi), the mean of
 * what is normal without its sign, summed, for L1; root of sum A s^2 for L2.
 * [the norms: Arvo, Torrance and Smits 1994]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "commands/commands.h"
#include "output/faces_table.h"
#include "output/json_file.h"
#include "output/json_values.h"
#include "util/beside.h"
#include "util/report.h"

/* Areas of one face in two tables may differ by so much (a share): nine digits, and what a face
 * that was cut into parts loses when they are summed. */
static const double AREA_DIFFERS = 1e-6;

/* Sums over faces of one band, or of all. */
struct sums {
    double signed_error, error, square, largest; /* of A e, A |e|, A e^2; |e| (W/m2) */
    double reflected, light, light_square, brightest;
    double power_variance, noise, noise_square; /* of the reference */
};

/* One face of both tables. */
struct pair {
    uint32_t mine, theirs; /* rows of FACES and REF */
    double error;          /* A sum |B - B_ref|, W */
};

struct comparison {
    const struct options *options;
    struct faces_table mine, theirs;
    struct pair *pairs; /* [theirs.count] */
    struct sums bands[3], all;
};

/* ---- do they fit? */

/* Fill pairs. Returns 0, or -1 after a message. */
static int match(struct comparison *c)
{
    const struct faces_table *mine = &c->mine, *theirs = &c->theirs;
    const char *faces = c->options->scene, *reference = c->options->reference;
    if (mine->bands != theirs->bands)
        return report_error(reference, 1, "%u bands of B, but %s has %u; give tables of one scene",
                            (unsigned)theirs->bands, faces, (unsigned)mine->bands);
    if (!mine->exitance && !theirs->exitance)
        return report_error(faces, 1,
                            "the column E_0 is missing, and %s has none either: what is reflected "
                            "is not known; give a table as `radiosity solve --faces` writes it",
                            reference);
    /* A sample of faces has gaps; a table without any that ends early is of something else. */
    if (theirs->face[theirs->count - 1] == theirs->count - 1 && theirs->count < mine->count)
        return report_error(reference, 0,
                            "%u faces, but %s has %u: they are not of one scene, or this one was "
                            "cut short; give tables of one scene",
                            (unsigned)theirs->count, faces, (unsigned)mine->count);
    for (uint32_t i = 0, j = 0; j < theirs->count; j++) {
        while (i < mine->count && mine->face[i] < theirs->face[j])
            i++;
        if (i == mine->count || mine->face[i] != theirs->face[j])
            return report_error(reference, j + 2,
                                "face %u is not in %s, which has %u; give tables of one scene",
                                (unsigned)theirs->face[j], faces, (unsigned)mine->count);
        /* Of a two-sided face a table may count both sides, and another, which does not say how
         * many there are, one: light leaves both. */
        double one = mine->area[i], other = theirs->area[j];
        if (!(fabs(one - other) <= AREA_DIFFERS * other)
            && !(fabs(2 * one - other) <= AREA_DIFFERS * other)
            && !(fabs(one - 2 * other) <= AREA_DIFFERS * one))
            return report_error(reference, j + 2,
                                "face %u has %.9g m2, but in %s %.9g; give tables of one scene",
                                (unsigned)theirs->face[j], other, faces, one);
        theirs->area[j] = fmax(one, other);
        c->pairs[j] = (struct pair){.mine = i, .theirs = j};
    }
    return 0;
}

/* Of other lamps or reflectances, errors are no errors. Says so once. */
static void compare_exitances(const struct comparison *c)
{
    const struct faces_table *mine = &c->mine, *theirs = &c->theirs;
    if (!mine->exitance || !theirs->exitance)
        return;
    for (uint32_t j = 0; j < theirs->count; j++)
        for (uint32_t k = 0; k < theirs->bands; k++) {
            double one = mine->exitance[(size_t)c->pairs[j].mine * mine->bands + k];
            double other = theirs->exitance[(size_t)j * theirs->bands + k];
            if (fabs(one - other) > AREA_DIFFERS * other) {
                report_warning(c->options->reference, j + 2,
                               "face %u emits %.9g W/m2, but in %s %.9g: the lamps differ, not "
                               "only the solutions",
                               (unsigned)theirs->face[j], other, c->options->scene, one);
                return;
            }
        }
}

/* ---- sums */

struct values {
    double area, b, reference, exitance, deviation; /* deviation: of both, where they have one */
};

static struct values values_of(const struct comparison *c, uint32_t at, uint32_t band)
{
    const struct faces_table *mine = &c->mine, *theirs = &c->theirs;
    size_t i = (size_t)c->pairs[at].mine * mine->bands + band;
    size_t j = (size_t)c->pairs[at].theirs * mine->bands + band;
    return (struct values){theirs->area[c->pairs[at].theirs], mine->radiosity[i],
                           theirs->radiosity[j],
                           theirs->exitance ? theirs->exitance[j] : mine->exitance[i],
                           hypot(theirs->deviation ? theirs->deviation[j] : 0,
                                 mine->deviation ? mine->deviation[i] : 0)};
}

static void add(struct sums *s, const struct values *v)
{
    double e = v->b - v->reference, light = v->reference - v->exitance, noise = v->deviation;
    s->signed_error += v->area * e;
    s->error += v->area * fabs(e);
    s->square += v->area * e * e;
    s->largest = v->area > 0 ? fmax(s->largest, fabs(e)) : s->largest;
    s->reflected += v->area * light;
    s->light += v->area * fabs(light);
    s->light_square += v->area * light * light;
    s->brightest = v->area > 0 ? fmax(s->brightest, fabs(light)) : s->brightest;
    s->power_variance += v->area * v->area * noise * noise;
    s->noise += v->area * noise * sqrt(2 / M_PI);
    s->noise_square += v->area * noise * noise;
}

static void sum_up(struct comparison *c)
{
    for (uint32_t i = 0; i < c->theirs.count; i++)
        for (uint32_t k = 0; k < c->theirs.bands; k++) {
            const struct values v = values_of(c, i, k);
            add(&c->bands[k], &v);
            add(&c->all, &v);
            c->pairs[i].error += v.area * fabs(v.b - v.reference);
        }
}

static int by_error(const void *a, const void *b)
{
    const struct pair *x = a, *y = b;
    return x->error != y->error ? (x->error < y->error) - (x->error > y->error)
                                : (x->theirs > y->theirs) - (x->theirs < y->theirs);
}

/* A share, or what stands for none where nothing is reflected. */
static double share(double part, double whole)
{
    return whole > 0 ? part / whole : (double)NAN;
}

enum norm { POWER, L1, L2, LINF, NORMS };
static const char *const norm_names[NORMS] = {"power", "l1_faces", "l2", "linf"};

static double error_share(const struct sums *s, enum norm norm)
{
    switch (norm) {
    case POWER:
        return share(s->signed_error, s->reflected);
    case L1:
        return share(s->error, s->light);
    case L2:
        return sqrt(share(s->square, s->light_square));
    default:
        return share(s->largest, s->brightest);
    }
}

/* The same of the reference's noise alone; NAN of Linf, which depends on the tails. */
static double noise_share(const struct sums *s, enum norm norm)
{
    switch (norm) {
    case POWER:
        return share(sqrt(s->power_variance), s->reflected);
    case L1:
        return share(s->noise, s->light);
    case L2:
        return sqrt(share(s->noise_square, s->light_square));
    default:
        return (double)NAN;
    }
}

/* ---- text */

static void print_share(double value, int sign)
{
    if (isnan(value))
        printf("  %9s", "-");
    else
        printf(sign ? "  %+9.4f" : "  %9.4f", 100 * value);
}

static void print_norms(const char *name, const struct sums *s,
                        double (*of)(const struct sums *s, enum norm norm))
{
    printf("  %-8s", name);
    for (enum norm k = POWER; k < NORMS; k = (enum norm)(k + 1))
        print_share(of(s, k), k == POWER && of == error_share);
    printf("\n");
}

/* The face's light in all bands, and how many standard errors the band that is farthest is off;
 * NAN: not known. */
static double face_values(const struct comparison *c, uint32_t at, struct values *sum)
{
    double far = (double)NAN;
    *sum = values_of(c, at, 0);
    sum->b = sum->reference = 0;
    for (uint32_t k = 0; k < c->theirs.bands; k++) {
        const struct values v = values_of(c, at, k);
        sum->b += v.b;
        sum->reference += v.reference;
        double off = (v.b - v.reference) / v.deviation;
        if (v.deviation > 0 && !(fabs(off) <= fabs(far)))
            far = off;
    }
    return far;
}

static const char *material_of(const struct comparison *c, uint32_t at)
{
    const struct pair *p = &c->pairs[at];
    return c->mine.material     ? c->mine.material[p->mine]
           : c->theirs.material ? c->theirs.material[p->theirs]
                                : "-";
}

static uint32_t worst_count(const struct comparison *c)
{
    uint32_t most = (uint32_t)c->options->worst;
    return most < c->theirs.count ? most : c->theirs.count;
}

static void print_worst(const struct comparison *c)
{
    uint32_t count = worst_count(c);
    if (!count || !(c->all.error > 0))
        return;
    printf("most of the error is on\n    face  material              area, m2        B    B_ref"
           "   of the L1%s\n",
           c->theirs.deviation ? "  std. errors" : "");
    for (uint32_t i = 0; i < count && c->pairs[i].error > 0; i++) {
        struct values v;
        double off = face_values(c, i, &v);
        printf("%8u  %-18.18s %11.4g %8.4g %8.4g %9.1f %%",
               (unsigned)c->theirs.face[c->pairs[i].theirs], material_of(c, i), v.area, v.b,
               v.reference, 100 * c->pairs[i].error / c->all.error);
        if (c->theirs.deviation && isnan(off))
            printf("            -");
        else if (c->theirs.deviation)
            printf("  %+11.1f", off);
        printf("\n");
    }
}

static void print_text(const struct comparison *c)
{
    const struct sums *all = &c->all;
    uint32_t bands = c->theirs.bands;
    double power = error_share(all, POWER);
    printf("%u faces", (unsigned)c->theirs.count);
    if (c->theirs.count < c->mine.count)
        printf(" of %u, those in the reference", (unsigned)c->mine.count);
    printf(", which reflect %.4g W\n", all->reflected);
    if (isnan(power))
        printf("no light is reflected; B is off by %.4g W, %+.4g W in all\n", all->error,
               all->signed_error);
    else
        printf("reflected light per face: off by %.2f %%, %.2f %% too %s in all\n",
               100 * error_share(all, L1), 100 * fabs(power), power < 0 ? "little" : "much");
    printf("  %-8s  %9s  %9s  %9s  %9s\n", "in %", "power", "L1", "L2", "Linf");
    for (uint32_t k = 0; k < bands && bands > 1; k++) {
        char name[16];
        snprintf(name, sizeof name, "band %u", (unsigned)k);
        print_norms(name, &c->bands[k], error_share);
    }
    print_norms("all", all, error_share);
    if (c->theirs.deviation || c->mine.deviation) {
        print_norms("noise", all, noise_share);
        printf("noise: what the standard errors of the reference alone would look like\n");
    } else {
        printf("the reference does not say how exact it is: it has no se_k of B_k, as those of "
               "`radiosity reference` have\n");
    }
    print_worst(c);
}

/* ---- JSON */

static json_t *norms_json(const struct sums *s, double (*of)(const struct sums *s, enum norm norm))
{
    json_t *all = json_object();
    for (enum norm k = POWER; k < NORMS; k = (enum norm)(k + 1))
        json_object_set_new(all, norm_names[k], json_finite(of(s, k)));
    return all;
}

static json_t *worst_json(const struct comparison *c)
{
    json_t *all = json_array();
    for (uint32_t i = 0; i < worst_count(c); i++) {
        json_t *b = json_array(), *reference = json_array(), *far = json_array();
        for (uint32_t k = 0; k < c->theirs.bands; k++) {
            const struct values v = values_of(c, i, k);
            json_array_append_new(b, json_real(v.b));
            json_array_append_new(reference, json_real(v.reference));
            json_array_append_new(far, json_finite((v.b - v.reference) / v.deviation));
        }
        json_array_append_new(all, json_pack("{s:I, s:o, s:f, s:o, s:o, s:o, s:f}", "face",
                                             (json_int_t)c->theirs.face[c->pairs[i].theirs],
                                             "material", json_text(material_of(c, i)), "area",
                                             c->theirs.area[c->pairs[i].theirs], "B", b,
                                             "B_reference", reference, "standard_errors", far,
                                             "error_watts", c->pairs[i].error));
    }
    return all;
}

static json_t *comparison_json(const struct comparison *c)
{
    json_t *bands = json_array();
    for (uint32_t k = 0; k < c->theirs.bands; k++)
        json_array_append_new(bands, norms_json(&c->bands[k], error_share));
    int known = c->theirs.deviation || c->mine.deviation;
    return json_pack(
        "{s:o, s:o, s:I, s:I, s:f, s:f, s:f, s:o, s:o, s:o, s:o}", "table",
        json_text(c->options->scene), "reference", json_text(c->options->reference), "faces",
        (json_int_t)c->mine.count, "compared", (json_int_t)c->theirs.count, "reflected_watts",
        c->all.reflected, "error_watts", c->all.error, "power_watts", c->all.signed_error, "error",
        norms_json(&c->all, error_share), "bands", bands, "noise",
        known ? norms_json(&c->all, noise_share) : json_null(), "worst", worst_json(c));
}

/* Compare what was read. Returns the exit status. */
static int compare_tables(struct comparison *c)
{
    const struct options *o = c->options;
    c->pairs = malloc(((size_t)c->theirs.count + 1) * sizeof *c->pairs);
    if (!c->pairs)
        return report_error(o->reference, 0, "out of memory") ? 1 : 0;
    if (match(c) < 0)
        return 1;
    sum_up(c);
    if (!o->quiet)
        compare_exitances(c);
    qsort(c->pairs, c->theirs.count, sizeof *c->pairs, by_error);
    double noise = noise_share(&c->all, L1), error = error_share(&c->all, L1);
    if (!o->quiet && c->all.noise > 0 && noise > error / 3)
        report_warning(o->reference, 0,
                       "its noise alone looks like %.2g %% of error: it cannot tell much of "
                       "%.2g %%; make it with a finer --accuracy",
                       100 * noise, 100 * error);
    if (!o->quiet && !path_is_stdout(o->json)) /* nothing but JSON goes there then */
        print_text(c);
    return o->json && json_file_write(o->json, comparison_json(c)) < 0;
}

int command_error(const struct options *o, const struct open_scene *scene)
{
    (void)scene;
    struct comparison c = {.options = o};
    if (faces_table_read(&c.mine, o->scene, 0) < 0)
        return 1;
    int status = faces_table_read(&c.theirs, o->reference, 0) < 0 ? 1 : compare_tables(&c);
    faces_table_free(&c.mine);
    faces_table_free(&c.theirs);
    free(c.pairs);
    return status;
}
