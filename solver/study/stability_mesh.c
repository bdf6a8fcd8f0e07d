/* stability_mesh.c - cases about faces that are not what they should be, as scene files have them.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "study/stability.h"

/* A lamp above a grey floor; between them and beside the lamp is room for more. */
static struct made_scene lamp_and_floor(void)
{
    struct made_scene s = {.count = 0};
    uint32_t grey = made_material(&s, 0.6, 0), lamp = made_material(&s, 0, 10);
    made_quad(&s, lamp, 0.5, 0.5, 2, 0, 1, 0, 1, 0, 0);
    made_quad(&s, grey, 0, 0, 0, 2, 0, 0, 0, 2, 0);
    return s;
}

/* What is asked of the two scenes of a case: B of the first `count` faces, and whether all must
 * be the same to the bit. */
struct comparison {
    const struct made_scene *one, *other;
    uint32_t count;
    int exact;
};

/* The largest relative difference of B; INFINITY where what must be the same is not. */
static double difference(const struct solved *a, const struct solved *b, const struct comparison *c)
{
    double error = c->exact && !stability_same_links(a, b) ? (double)INFINITY : 0;
    for (uint32_t i = 0; i < c->count; i++) {
        double x = stability_radiosity(a, i), y = stability_radiosity(b, i);
        error = fmax(error, isnan(y)   ? (double)INFINITY
                            : x == y   ? 0
                            : c->exact ? (double)INFINITY
                                       : fabs(y / x - 1));
    }
    return error;
}

/* Solve both and compare them; rules that replace the making of faces, and not the oracle, by the
 * default oracle. Returns 0, or -1 with nothing to close. */
static int solve_both(struct stability_trial *trial, const struct comparison *c,
                      struct solved solved[2])
{
    const struct stability_method *m =
        trial->method->kind == BY_ORACLE ? trial->method : &stability_methods[DEFAULT];
    const struct stability_how how = {
        m->oracle, m->settings, trial->threads, {.tolerance = 1e-6}, 0};
    if (stability_solve_so(&solved[0], c->one, &how) < 0)
        return -1;
    if (stability_solve_so(&solved[1], c->other, &how) < 0) {
        solved_close(&solved[0]);
        return -1;
    }
    trial->error = difference(&solved[0], &solved[1], c);
    trial->count = (double)solved[1].links.count;
    return 0;
}

/* A quad with one corner lifted by .6, beside its two triangles; or taken for flat, as the
 * solver believes who says so. */
int stability_bent_quad(struct stability_trial *trial)
{
    static const double corner[4][3] = {{0, 0, 1}, {1, 0, 0.4}, {1, 1, 1}, {0, 1, 0.4}};
    static const double half[2][3][3] = {{{0, 1, 0.4}, {0, 0, 1}, {1, 0, 0.4}},
                                         {{1, 0, 0.4}, {1, 1, 1}, {0, 1, 0.4}}};
    struct made_scene split = lamp_and_floor(), bent = split;
    int one_plane = trial->method == &stability_methods[ONE_PLANE];
    made_face(&split, 0, 3, half[0]);
    made_face(&split, 0, 3, half[1]);
    made_face(&bent, 0, 4, corner);
    bent.as_given = one_plane;
    const struct comparison c = {&split, &bent, one_plane ? 2 : 4, !one_plane};
    struct solved solved[2];
    if (solve_both(trial, &c, solved) < 0)
        return -1;
    solved_close(&solved[0]);
    solved_close(&solved[1]);
    return 0;
}

/* A triangle on a line, and one with two corners in one place, among good faces. */
int stability_no_area(struct stability_trial *trial)
{
    static const double good[3][3] = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}};
    static const double line[3][3] = {{0, 0, 1}, {0.5, 0, 1}, {0.25, 0, 1}};
    static const double twice[3][3] = {{0, 0, 1}, {0, 0, 1}, {1, 0, 1}};
    struct made_scene clean = lamp_and_floor(), dirty = clean;
    struct RadSceneReport one, other;
    made_face(&clean, 0, 3, good);
    made_face(&dirty, 0, 3, line);
    made_face(&dirty, 0, 3, twice);
    made_face(&dirty, 0, 3, good);
    const struct comparison c = {&clean, &dirty, 3, 1};
    struct solved solved[2];
    if (solve_both(trial, &c, solved) < 0)
        return -1;
    if (radGetSceneReport(solved[0].scene, &one) < 0
        || radGetSceneReport(solved[1].scene, &other) < 0 || other.dropped != 2
        || other.faces != one.faces)
        trial->error = INFINITY;
    solved_close(&solved[0]);
    solved_close(&solved[1]);
    return 0;
}
