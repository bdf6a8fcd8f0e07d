/* spoilt.h - solutions that are off by as much as a test wants, in scenes with a known answer
 * (make_known.h).
 * SPDX-License-Identifier: MIT */
#ifndef SPOILT_H
#define SPOILT_H

#include "runtime/make_known.h"
#include "runtime/make_solve.h"
#include "engine/solve_tracer.h"
#include "particles/power_balance.h"
#include "suite.h"

static inline struct tracer tracer_over(const struct solve *s, int threads)
{
    struct tracer t = solve_tracer(s);
    t.threads = threads;
    ck_assert_int_eq(tracer_open(&t), 0);
    return t;
}

/* particles: of all replicates together. */
static inline void traced(struct tally *y, const struct tracer *t, uint64_t stream, int particles)
{
    ck_assert_int_eq(tally_open(y, t, stream, 1), 0);
    ck_assert_int_eq(tally_trace(y, t, (uint64_t)particles / REPLICATES, NULL), 0);
    power_balance(y, t);
}

struct errors {
    double l1, power;
};

/* True errors of faces, as shares of the reflected light. */
static inline struct errors true_errors(const struct solve *s, const double *truth,
                                        const double *solved)
{
    uint32_t bands = s->problem.bands, values = s->problem.scene->input_count * bands;
    double *off = calloc(values, sizeof *off), all = 0;
    struct errors e = {0, 0};
    for (uint32_t f = 0; f < s->hierarchy.face_count; f++)
        for (uint32_t k = 0; k < bands; k++) {
            uint32_t at = s->hierarchy.face_element[f];
            double a = s->problem.reflectance[f * bands + k] * s->hierarchy.elements[at].area;
            off[s->hierarchy.faces[f].input * bands + k] +=
                a * (solved[at * bands + k] - truth[f * bands + k]);
            all += a * truth[f * bands + k];
        }
    for (uint32_t i = 0; i < values; i++) {
        e.l1 += fabs(off[i]) / all;
        e.power += off[i] / all;
    }
    free(off);
    return e;
}

/* Truth times 1 + d, the sum of |error| about `target` of the reflected light. d: all by chance,
 * one face alone, all alike, or a third of them. */
static inline void spoil(const struct solve *s, const double *truth, double *solved, double target,
                         struct chance *c)
{
    uint32_t bands = s->problem.bands, faces = s->hierarchy.face_count;
    int pattern = (int)(4 * chance_even(c));
    uint32_t one = (uint32_t)(faces * chance_even(c));
    double sign = chance_even(c) < 0.5 ? -1 : 1, l1 = 0, all = 0;
    double *d = calloc(faces, sizeof *d);
    for (uint32_t f = 0; f < faces; f++) {
        double normal = chance_normal(c), third = chance_even(c) < 1 / 3.0 ? normal : 0;
        d[f] = pattern == 0   ? normal
               : pattern == 1 ? (f == one) * sign
               : pattern == 2 ? sign
                              : third;
        for (uint32_t k = 0; k < bands; k++) {
            double reflected = s->problem.reflectance[f * bands + k] * truth[f * bands + k]
                               * hierarchy_surface(&s->hierarchy, f)->area;
            all += reflected;
            l1 += reflected * fabs(d[f]);
        }
    }
    for (uint32_t f = 0; f < faces; f++)
        for (uint32_t k = 0; k < bands; k++)
            solved[s->hierarchy.face_element[f] * bands + k] =
                truth[f * bands + k] * fmax(0, 1 + (l1 > 0 ? d[f] * target * all / l1 : 0));
    free(d);
}

static inline void open_known(struct solve *s, struct scene *scene)
{
    struct solve_options o = quick(1);
    const char *cause;
    ck_assert_int_eq(solve_open(s, scene, &o, &cause), 0);
}

static inline void close_known(struct solve *s, struct scene *scene, struct tracer *t,
                               double *truth, double *solved)
{
    free(solved);
    free(truth);
    tracer_close(t);
    solve_close(s);
    made_close(scene);
}

/* A room of n x n tiles a wall, all with the same H. Returns H by face and band. */
static inline double *tiled_open(struct scene *scene, struct solve *s, int n, struct chance *chance)
{
    double b[3];
    made_open(scene);
    known_materials(scene, chance, b);
    known_room(scene, chance, n, 3, 2, 1.5);
    open_known(s, scene);
    size_t values = (size_t)scene->input_count * scene->bands;
    double *truth = calloc(values, sizeof *truth);
    for (size_t i = 0; i < values; i++)
        truth[i] = b[i % scene->bands];
    return truth;
}

#endif
