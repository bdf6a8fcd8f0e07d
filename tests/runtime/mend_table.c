/* mend_table.c - what mending by particles is worth: mend_table SCENE REFERENCE RAYS [ORACLE
 * [PARAM=VALUE...]].
 *
 * Solves the scene, mends the solution by about RAYS rays of particles, and prints a row of a table
 * of L1 errors, of the mean light of faces of the file and of leaves, as shares of the reflected
 * light: links alone; particles alone, by the same rays and by those of links besides; both
 * together. All against REFERENCE rays of particles of other random numbers, whose own noise on
 * leaves is printed last: it is part of every error of leaves.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/mend.h"
#include "engine/solve_tracer.h"
#include "runtime/make_solve.h"
#include "scene/read_scene.h"

/* Power of all elements by a tally (W), [element * bands + band]. */
static double *powers(const struct hierarchy *h, const struct tally *tally)
{
    double *power = calloc((size_t)h->count * tally->bands, sizeof *power);
    for (uint32_t e = h->count; power && e-- > 0;) /* children follow their parents */
        for (uint32_t k = 0; k < tally->bands; k++) {
            double *here = &power[(size_t)e * tally->bands + k];
            if (!h->elements[e].children)
                *here = tally_leaf(tally, e, k);
            if (e > 0)
                power[(size_t)h->elements[e].parent * tally->bands + k] += *here;
        }
    return power;
}

struct errors {
    double faces, leaves;
};

/* Of the powers `got` against `truth`. */
static struct errors errors_of(const struct solve *s, const double *got, const double *truth)
{
    const struct hierarchy *h = &s->hierarchy;
    uint32_t bands = s->problem.bands, polygons = s->problem.scene->input_count;
    double *off = calloc((size_t)polygons * bands, sizeof *off), all = 0;
    struct errors sum = {0, 0};
    for (uint32_t e = 0; off && e < h->count; e++)
        for (uint32_t k = 0; k < bands && !h->elements[e].children; k++) {
            uint32_t face = h->elements[e].face;
            double rho = s->problem.reflectance[(size_t)face * bands + k];
            size_t i = (size_t)e * bands + k;
            sum.leaves += rho * fabs(got[i] - truth[i]);
            off[(size_t)h->faces[face].input * bands + k] += rho * (got[i] - truth[i]);
            all += rho * truth[i];
        }
    for (size_t i = 0; off && i < (size_t)polygons * bands; i++)
        sum.faces += fabs(off[i]);
    free(off);
    return (struct errors){sum.faces / all, sum.leaves / all};
}

/* So many rays of a stream. */
static struct tally traced(const struct tracer *t, uint64_t stream, double rays)
{
    struct tally tally;
    if (tally_open(&tally, t, stream, 1) < 0)
        exit(1);
    tally_trace(&tally, t, 64, NULL);
    double more = tally.rays > 0 ? 64 * rays / (double)tally.rays - 64 : 0;
    tally_trace(&tally, t, more > 1 ? (uint64_t)more : 1, NULL);
    return tally;
}

static struct errors by_particles(const struct solve *s, const struct tracer *t, uint64_t stream,
                                  double rays, const double *truth)
{
    struct tally tally = traced(t, stream, rays);
    double *power = powers(&s->hierarchy, &tally);
    struct errors e = errors_of(s, power, truth);
    tally_close(&tally);
    free(power);
    return e;
}

static struct errors by_links(const struct solve *s, const double *irradiance, const double *truth)
{
    size_t values = (size_t)s->hierarchy.count * s->problem.bands;
    double *power = malloc(values * sizeof *power);
    for (size_t i = 0; i < values; i++)
        power[i] = irradiance[i] * s->hierarchy.elements[i / s->problem.bands].area;
    struct errors e = errors_of(s, power, truth);
    free(power);
    return e;
}

int main(int count, char **arguments)
{
    if (count < 4) {
        fprintf(stderr, "usage: mend_table SCENE REFERENCE RAYS [ORACLE [PARAM=VALUE...]]\n");
        return 2;
    }
    const struct scene_options how = {0, 1};
    struct scene scene;
    if (scene_read(&scene, arguments[1], &how) < 0)
        return 1;
    struct solve s;
    struct solve_options options = quick(2);
    options.tolerance = 1e-4;
    struct refiner *oracle = oracles_open(count > 4 ? arguments[4] : "clusters", RELEASE_FLAT);
    const char *cause = "no such oracle or parameter";
    if (!oracle || oracles_set(oracle, arguments + 5, count > 5 ? count - 5 : 0) < 0
        || solve_open(&s, &scene, &options, &cause) < 0 || solve_run(&s, oracle, &cause) < 0) {
        fprintf(stderr, "mend_table: %s\n", cause);
        return 1;
    }
    struct tracer t = solve_tracer(&s);
    if (tracer_open(&t) < 0)
        return 1;
    double reference = atof(arguments[2]), rays = atof(arguments[3]),
           linked = (double)rays_count(s.problem.rays).rays;
    struct tally true_tally = traced(&t, 1000, reference), tally = traced(&t, 0, rays);
    double *truth = powers(&s.hierarchy, &true_tally);
    size_t values = (size_t)s.hierarchy.count * s.problem.bands;
    double *mended = malloc(values * sizeof *mended);
    memcpy(mended, s.state.irradiance, values * sizeof *mended);
    if (mend_irradiance(&s.operator, & tally, mended) < 0)
        return 1;
    struct errors links = by_links(&s, s.state.irradiance, truth),
                  both = by_links(&s, mended, truth), same = by_particles(&s, &t, 1, rays, truth),
                  all = by_particles(&s, &t, 2, rays + linked, truth),
                  noise = by_particles(&s, &t, 3, reference, truth);
    const char *name = strrchr(arguments[1], '/');
    printf("| %s | %.3g + %.3g | %.2f / %.1f | %.2f / %.1f | %.2f / %.1f | %.2f / %.1f | %.2f / "
           "%.1f |\n",
           name ? name + 1 : arguments[1], linked, (double)tally.rays, 100 * links.faces,
           100 * links.leaves, 100 * same.faces, 100 * same.leaves, 100 * all.faces,
           100 * all.leaves, 100 * both.faces, 100 * both.leaves, 100 * noise.faces / sqrt(2),
           100 * noise.leaves / sqrt(2));
    return 0;
}
