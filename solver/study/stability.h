/* stability.h - configurations on which radiosity methods are known to fail, each with its right
 * answer.
 *
 * One table (stability_cases.c) serves the tests and `radiosity study stability`. A row is a case:
 * a scene made in memory and a measure of how wrong a method is on it, against a closed form or a
 * condition that must hold. A row has one tolerance, by which every method on it is judged. A cell
 * is a case and a method, with what is expected of it: to stay within the tolerance, or to fail by
 * a known amount for a known reason. Invariant: a failing cell's
 * expected range lies above its tolerance, so a cell cannot hold both ways, and evidence that no
 * longer holds is as loud as a broken method.
 * SPDX-License-Identifier: MIT */
#ifndef STABILITY_H
#define STABILITY_H

#include "study/made_scene.h"
#include "util/solved.h"

/* What a method replaces in the computation of light. */
enum stability_kind {
    BY_FACTOR, /* the form factor of a pair, `number` says which */
    BY_RAYS,   /* the visibility of a pair, by `number` rays or as below */
    BY_ORACLE, /* all: a solution with this oracle and these settings, `number` its closure */
    BY_RULE    /* a rule that only some cases know; they look at the method itself */
};

enum stability_sight { BY_FRONTS = 0, BY_FLOAT = -1, BY_INTEGRAL = -2 };
enum stability_factor {
    FACTOR_KERNEL,
    FACTOR_CULLED,
    FACTOR_DISC,
    FACTOR_POINT,
    FACTOR_POLYGON,
    FACTOR_CONTOUR
};

struct stability_method {
    const char *name;
    const char *what; /* one line */
    enum stability_kind kind;
    int number;
    const char *oracle;
    const char *settings[4]; /* "PARAM=VALUE", NULL ends */
};

/* The columns of the table, in their order: stability_methods.c. */
enum {
    NO_METHOD,
    KERNEL,
    CULLED,
    DISC,
    POINT,
    POLYGON,
    CONTOUR,
    FRONTS,
    FIXED_EPSILON,
    RAYS_4,
    RAYS_16,
    RAYS_64,
    INTEGRAL,
    NORMALISED,
    JACOBI,
    SWEEPS_JACOBI,
    NAIVE_STOP,
    ONE_PLANE,
    L2_NORM,
    LINF_NORM,
    UMBRA,
    CORNERS,
    SAMPLED,
    BOUNDED,
    LARGER,
    LONGER,
    LINF_GAP,
    AREA_GAP,
    BF_1991,
    BF_NODES,
    FF,
    BF,
    BFV,
    RELATIVE,
    GAP,
    SMOOTH,
    VIEWFACTORS,
    DEFAULT,
    UNCUT,
    FINE,
    CLOSED,
    METHODS
};
extern const struct stability_method stability_methods[METHODS];

/* One measurement on its way: what to run, and what came of it. */
struct stability_trial {
    const struct stability_method *method;
    int threads;
    double error;
    double count; /* what it cost, mostly links; negative: not counted */
    int level;    /* how often the method was refined: stability_order */
    double work;  /* what that makes more of: links, rays, or elements of a face; 0: nothing */
};

/* What is expected of a method on a case. */
struct stability_cell {
    int method;       /* NO_METHOD ends the list */
    const char *why;  /* a known failure's reason; NULL: the method must pass */
    double low, high; /* and its error; INFINITY is an error too */
};

enum { STABILITY_CELLS = 12 };

/* Whether the error is that of a number, which falls as a method is refined, or of a condition that
 * holds or does not. */
enum stability_limit { EXACT, CONVERGES };

struct stability_case {
    const char *name;
    const char *what;    /* the configuration */
    const char *right;   /* the right answer */
    const char *measure; /* what the error is */
    const char *counted; /* unit of the trial's count where it is part of the evidence, else NULL */
    /* returns 0, or -1 when it cannot be run (out of memory) */
    int (*run)(struct stability_trial *trial);
    double tolerance; /* the error that still passes, whatever the method */
    enum stability_limit limit;
    struct stability_cell cells[STABILITY_CELLS];
};

struct stability_group {
    const char *title;
    const struct stability_case *cases; /* [count] */
    int count;
};

extern const struct stability_group stability_groups[];
extern const int stability_group_count;

/* What a trial's error means to a cell of a case. */
enum stability_verdict {
    VERDICT_PASSES,
    VERDICT_FAILS_AS_KNOWN,
    VERDICT_FAILS,  /* though it must pass */
    VERDICT_CHANGED /* a known failure no longer is, or is another */
};
enum stability_verdict stability_judge(const struct stability_case *c,
                                       const struct stability_cell *cell, double error);

/* How a cell is run. */
struct stability_run {
    int threads;
    int level; /* the method refined so often: thresholds / 4, or rays or elements x 4 each time;
                * negative, for oracles alone: coarsened */
};
/* Run one cell. Returns 0 or -1. */
int stability_run(const struct stability_case *c, const struct stability_cell *cell,
                  const struct stability_run *how, struct stability_trial *trial);

/* The order in which the error of a cell falls: -d log(error) / d log(work), by least squares over
 * three levels; `first` is its trial at level 0. NAN where the error is at rounding or
 * without end, or there is nothing to refine. stability_order.c. Returns 0 or -1. */
int stability_order(const struct stability_case *c, const struct stability_cell *cell, int threads,
                    const struct stability_trial *first, double *order);

/* The least-squares order of [count] errors after so much work each; only errors above `rounding`
 * are asked. NAN when fewer than two are left or the work does not even double between them. */
double stability_slope(int count, const double *work, const double *error, double rounding);

/* The tools of the cases: stability_tools.c. */

/* The form factor of two surfaces by a BY_FACTOR method, nothing between them; from 4^level parts
 * of the one to as many of the other. */
double stability_factor(const struct stability_trial *trial, const struct element *r,
                        const struct element *s);

/* A made scene solved by an oracle: how. */
struct stability_how {
    const char *oracle;
    const char *const *settings; /* "PARAM=VALUE", NULL-terminated */
    int threads;
    struct RadSolveOptions options;
    int level; /* the oracle's thresholds and smallest part are divided by 4^level */
};
/* Returns 0, or -1 with nothing to close. */
int stability_solve_so(struct solved *s, const struct made_scene *made,
                       const struct stability_how *how);

/* Its elements and what answers about rays (radGetHost), without links. Returns 0, or -1 with
 * nothing to close. */
int stability_unsolved(struct solved *s, const struct made_scene *made);

/* Solve a scene with a BY_ORACLE method; `unit`: view factors alone, refined and not solved. Its
 * links are added to trial->work.
 * Returns 0, or -1 with nothing to close. */
int stability_solve(struct solved *s, const struct made_scene *made, struct stability_trial *trial,
                    int unit);

/* A scene, and one number from its solution; `at` is the case's own: a reflectance, a level. */
struct stability_scene {
    void (*make)(struct made_scene *scene, double at); /* into an empty one */
    double (*measure)(const struct solved *s, double at);
};

/* Make it, solve it by a BY_ORACLE method, measure it; trial->count becomes the number of links.
 * Returns 0 or -1. */
int stability_measured(struct stability_trial *trial, const struct stability_scene *scene,
                       double at, double *value);

/* The sum of F over a unit cube's face by a BY_FACTOR method, from one element per face: to the
 * opposite face in [0], to one of the four beside it in [1]. */
void stability_cube_factors(const struct stability_trial *trial, double f[2]);

/* The element that is the whole of a face. */
const struct element *stability_face(const struct solved *s, uint32_t face);

/* The view factor from face i to face j that the links make, and the sum over all j. */
double stability_exchange(const struct solved *s, uint32_t i, uint32_t j);
double stability_row(const struct solved *s, uint32_t i);

/* Means over a face: B, and H over all of it (first band). */
double stability_radiosity(const struct solved *s, uint32_t face);
double stability_irradiance(const struct solved *s, uint32_t face);

/* Two solutions have the same elements and links, to the bit. */
int stability_same_links(const struct solved *a, const struct solved *b);

/* A number in [0, 1) from a seed that moves on. */
double stability_random(unsigned *seed);

/* The cases: each stability_*.c gives its measures. */
/* clang-format off */
#define STABILITY_MEASURES(M) \
    M(shared_edge) M(shared_edge_halved) M(close_parallel) M(half_apart) M(row_sum) M(straddle) \
    M(straddle_children) M(coplanar) M(sliver) M(sliver_standing) M(scale_far) \
    M(degenerate_factor) M(closed_forms) M(tiny_blocker) M(penumbra) M(obstructed) M(thin_wall) \
    M(wall_in_floor) M(far_from_zero) M(furnace_95) M(furnace_98) M(furnace_99) M(furnace_box) \
    M(furnace_L) M(near_white) M(sweeps) M(open_plates) M(plates_profile) M(plates_edge) M(cube) \
    M(cavity) M(sphere) M(hollow_sphere) M(concentric) M(wide_plates) M(brightness) M(scale) \
    M(large_source) M(large_source_split) M(touching_cells) M(touching_plates) \
    M(long_receiver) M(range_centre) \
    M(range_quarter) M(four_shadows) M(bent_quad) M(no_area)
/* clang-format on */
#define M(name) int stability_##name(struct stability_trial *trial);
STABILITY_MEASURES(M)
#undef M

#endif
