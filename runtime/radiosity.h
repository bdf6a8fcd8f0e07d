/* radiosity.h - hierarchical radiosity as a library: scenes and oracles in, light and view factors
 * out.
 *
 * Five opaque handles, in the manner of Embree's API:
 *
 *     RadDevice    threads, errors and progress; owns nothing else
 *     RadScene     faces and materials; after radCommitScene what solutions are made over
 *     RadOracle    a refinement oracle: built in, a .dag file or text, or a compiled refiner
 *     RadSolution  elements, links and radiosities of one scene by one oracle
 *     RadExchange  exchange areas A_i F_ij between the polygons of a scene (view factors)
 *
 * Handles count references: radNew... returns one that you hold, radRetain... adds one,
 * radRelease... gives one up; a handle keeps alive what it was made from. NULL may be released.
 *
 * Errors. No function prints, exits or reads the environment. A function that cannot do its work
 * returns NULL, -1 or 0 as said, and its device remembers the first error since it was last asked
 * (radGetDeviceError) with a sentence that says what is wrong and how to mend it; an error
 * function, where one is set, is told at once.
 *
 * Threads. Any thread of a program may call, also at the same time for different scenes, oracles
 * and solutions; one handle is used by one thread at a time. Work within a call is shared out to
 * RadDeviceOptions.threads threads (OpenMP); results do not depend on how many.
 *
 * Units: metres, watts; exitance E, irradiance H and radiosity B in W/m2, per band; reflectance in
 * [0, 1). One band for grey scenes, else three. Sources: Hanrahan, Salzman and Aupperle 1991;
 * Turbet and Sillion, sections 3 and 4.
 * SPDX-License-Identifier: MIT */
#ifndef RADIOSITY_H
#define RADIOSITY_H

#include <stddef.h>
#include <stdint.h>
#include "oracle.h" /* struct oracle, element, discussion: what compiled refiners and views share */

#if defined __GNUC__
#define RAD_API __attribute__((visibility("default")))
#else
#define RAD_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define RADIOSITY_VERSION "0.2.0"

typedef struct RadDeviceObject *RadDevice;
typedef struct RadSceneObject *RadScene;
typedef struct RadOracleObject *RadOracle;
typedef struct RadSolutionObject *RadSolution;
typedef struct RadExchangeObject *RadExchange;

/* ---- devices */

enum RadError {
    RAD_ERROR_NONE,
    RAD_ERROR_INVALID_ARGUMENT, /* a value that is out of range, a name that nobody has */
    /* a call that comes too early or too late, such as solving an uncommitted scene */
    RAD_ERROR_INVALID_OPERATION,
    RAD_ERROR_INVALID_SCENE,  /* faces or materials that light cannot be computed for */
    RAD_ERROR_INVALID_ORACLE, /* a graph with errors, a refiner of another ABI */
    RAD_ERROR_OUT_OF_MEMORY,
    /* no device of Embree's on this processor, no C compiler for a flat release */
    RAD_ERROR_UNSUPPORTED,
    RAD_ERROR_CANCELLED /* by the progress function */
};

struct RadDeviceOptions {
    int threads;           /* 0: as many as there are processors */
    const char *compiler;  /* C compiler for the flat release of files and texts; NULL: "cc" */
    const char *temporary; /* folder for what it makes; NULL: "/tmp" */
};

/* Told of every error (code) and of every warning (RAD_ERROR_NONE), from the calling thread;
 * `message` is good until it returns. */
typedef void (*RadMessageFunction)(void *user, enum RadError code, const char *message);

/* NULL options: the defaults. Returns NULL when out of memory. */
RAD_API RadDevice radNewDevice(const struct RadDeviceOptions *options);
RAD_API void radRetainDevice(RadDevice device);
RAD_API void radReleaseDevice(RadDevice device);
RAD_API void radSetDeviceMessageFunction(RadDevice device, RadMessageFunction function, void *user);

/* The first error since the last call, and forget it. NULL device: what kept the last
 * radNewDevice of this thread from making one. */
RAD_API enum RadError radGetDeviceError(RadDevice device);
/* Its sentence; "" when there was none. Good until the device's next call. Ask before
 * radGetDeviceError, which forgets. */
RAD_API const char *radGetDeviceErrorMessage(RadDevice device);

/* Where long work is. All counts rise; 0 where the phase has none. */
struct RadProgress {
    const char *phase; /* "refine", "solve", "factors" */
    int pass;          /* from 1 */
    uint64_t rounds, pairs, waiting, links, rays;
    double residual;
};
/* Called from the thread that called in, up to some hundred times a second. Return 0 to go on,
 * anything else to cancel: the call then fails with RAD_ERROR_CANCELLED, and its handle may only be
 * released. */
typedef int (*RadProgressFunction)(void *user, const struct RadProgress *progress);
RAD_API void radSetDeviceProgressFunction(RadDevice device, RadProgressFunction function,
                                          void *user);

/* ---- scenes */

struct RadMaterial {
    double reflectance[3]; /* rho per band, 0 <= rho < 1 */
    double exitance[3];    /* E per band, W/m2, 0 <= E */
    int two_sided;         /* 1: both sides reflect and emit; 0: the back is black */
};

enum { RAD_GREY = 1, RAD_COLOUR = 3 };

/* Polygons in arrays of the caller's, which must outlive radCommitScene and are not looked at after
 * it. Polygon i has sizes[i] corners (all have `size` when sizes is NULL), whose indices into
 * positions stand one polygon after the other, counter-clockwise seen from the front. Concave and
 * bent polygons are cut into flat convex ones. Polygons without area, also those of fewer than
 * three corners, are dropped and counted, and keep their place in all lists of polygons. */
struct RadPolygons {
    const double *positions; /* [position_count * 3], m */
    size_t position_count;
    const uint32_t *indices; /* [sum of sizes] */
    const uint32_t *sizes;   /* [count]; those below 3 are polygons without area; or NULL */
    uint32_t size;
    const uint32_t *materials; /* [count], indices of materials; NULL: all have material 0 */
    uint32_t count;
    /* 1: positions have been floats; then what is thinner or bent by less than these can say is
     * taken so */
    int single_precision;
    int as_given; /* 1: quads are taken for flat and convex, and no face is cut where others stand
                     in it; for studies of what comes of it */
};

RAD_API RadScene radNewScene(RadDevice device);
RAD_API void radRetainScene(RadScene scene);
RAD_API void radReleaseScene(RadScene scene);

/* Copied. Returns 0, or -1. */
RAD_API int radSetSceneMaterials(RadScene scene, const struct RadMaterial *materials,
                                 uint32_t count);
/* Kept as it is: the arrays are borrowed until the commit. Returns 0, or -1. */
RAD_API int radSetSceneSharedPolygons(RadScene scene, const struct RadPolygons *polygons);
/* Check everything, cut faces where others stand in them. After it the scene does not change.
 * Returns 0, or -1. */
RAD_API int radCommitScene(RadScene scene);

/* A flat convex face as the engine has it. */
struct RadFace {
    double vertex[4][3]; /* m, counter-clockwise from the front */
    uint32_t vertices;   /* 3 or 4 */
    uint32_t material;
    uint32_t input; /* the polygon that it is, or is part of */
    uint8_t back;   /* 1: the far side of a two-sided face, which stands before it */
    uint8_t black;  /* 1: neither emits nor reflects */
};

struct RadSceneReport {
    uint32_t polygons;   /* as they were set */
    uint32_t dropped;    /* of them, without area */
    uint32_t cut, parts; /* faces cut where others stand in them, and into how many */
    uint32_t faces, materials, bands;
    double area;            /* of all faces, both sides of two-sided ones (m2) */
    double low[3], high[3]; /* their box (m) */
};
/* Of a committed scene. Returns 0, or -1. */
RAD_API int radGetSceneReport(RadScene scene, struct RadSceneReport *report);
/* [RadSceneReport.faces], the scene's own. NULL before the commit. */
RAD_API const struct RadFace *radGetSceneFaces(RadScene scene);
/* One side's area of each polygon (m2), 0 of those that were dropped; [RadSceneReport.polygons],
 * the scene's own. */
RAD_API const double *radGetScenePolygonAreas(RadScene scene);
RAD_API const struct RadMaterial *radGetSceneMaterials(RadScene scene);

/* ---- oracles */

enum RadRelease {
    RAD_RELEASE_FLAT, /* compiled C */
    RAD_RELEASE_DAG,  /* the graph, interpreted node by node */
    RAD_RELEASE_HAND  /* what a program has registered by hand */
};

/* The built-in oracles' names, NULL-terminated; constant. The default is radGetDefaultOracle(),
 * RAD_DEFAULT_ORACLE when the program was compiled. */
#define RAD_DEFAULT_ORACLE "clusters"
RAD_API const char *const *radGetOracleNames(void);
RAD_API const char *radGetDefaultOracle(void);

/* A built-in oracle, or one that was registered, by name. Returns NULL on error. */
RAD_API RadOracle radNewOracle(RadDevice device, const char *name, enum RadRelease release);
/* A .dag file ("-": standard input), or the text of one under the name `path`; `oracle`: which of
 * the file's, NULL: the only one. RAD_RELEASE_FLAT needs a C compiler and compiles it now. */
RAD_API RadOracle radLoadOracle(RadDevice device, const char *path, const char *oracle,
                                enum RadRelease release);
RAD_API RadOracle radParseOracle(RadDevice device, const char *path, const char *text,
                                 const char *oracle, enum RadRelease release);
/* A refiner that dagc generated and that the program is linked with, or one written by hand.
 * Borrowed. */
RAD_API RadOracle radNewOracleCompiled(RadDevice device, const struct oracle *oracle,
                                       const char *release);
/* Let radNewOracle find it by name as RAD_RELEASE_HAND. Borrowed. Returns 0, or -1. */
RAD_API int radRegisterOracle(RadDevice device, const struct oracle *oracle);
/* Is there one of that name and release? */
RAD_API int radHasOracle(RadDevice device, const char *name, enum RadRelease release);
RAD_API void radRetainOracle(RadOracle oracle);
RAD_API void radReleaseOracle(RadOracle oracle);

struct RadOracleReport {
    /* the oracle's own; fingerprint "" when interpreted */
    const char *name, *release, *doc, *fingerprint;
    const struct oracle_parameter *parameters; /* [parameter_count], the oracle's own */
    int parameter_count;
    int reads_importance, reads_tolerance; /* facts that a solver must provide */
};
RAD_API void radGetOracleReport(RadOracle oracle, struct RadOracleReport *report);
/* Returns 0, or -1: no such parameter, or not in its range. */
RAD_API int radSetOracleParameter(RadOracle oracle, const char *name, double value);
/* NAN when there is no such parameter. */
RAD_API double radGetOracleParameter(RadOracle oracle, const char *name);
/* Ask it once; safe from many threads while no parameter is set. */
RAD_API enum decision radAskOracle(RadOracle oracle, struct discussion *discussion);

/* How often each node was asked and each answer given, on all threads. RAD_RELEASE_DAG only. */
struct RadAnswerCount {
    const char *name, *kind; /* kind: "precise", "approximate", "other", "command" */
    const char *target;      /* node or decision */
    uint64_t count;
};
struct RadNodeCount {
    const char *name, *tool;
    uint64_t calls;
    const struct RadAnswerCount *answers; /* [answer_count] */
    int answer_count;
};
enum { RAD_COUNTS = 256, RAD_RECORDS = 8, RAD_BINS = 128 };
struct RadStatistics {
    const struct RadNodeCount *nodes; /* [node_count], the start first */
    int node_count;
    const uint64_t *counts; /* [RAD_COUNTS]: of tool count */
    /* Of tool record: histograms of values v > 0 by floor(log2 v) + 64, and how many were not
     * above 0. */
    const uint64_t (*bins)[RAD_BINS]; /* [RAD_RECORDS] */
    const uint64_t *zero;             /* [RAD_RECORDS] */
};
/* From now on count. Returns 0, or -1. */
RAD_API int radCountOracle(RadOracle oracle);
/* What was counted, good until the next call with this oracle. Returns 0, or -1. */
RAD_API int radGetOracleStatistics(RadOracle oracle, struct RadStatistics *statistics);

/* ---- solutions */

enum RadClosure {
    RAD_CLOSURE_NONE,      /* row sums above 1 are capped, each face keeping its power */
    RAD_CLOSURE_ROWS,      /* rows of a closed scene sum to 1; reciprocity is given up */
    RAD_CLOSURE_RECIPROCAL /* of exchange areas only: rows sum to 1, A_i F_ij = A_j F_ji */
};

struct RadCamera {
    double eye[3];                    /* m */
    double right[3], up[3], ahead[3]; /* unit vectors, at right angles to each other */
    double wide, high;                /* tangents of half the angles of view */
};

enum RadBasis {
    RAD_BASIS_CONSTANT, /* one value per element */
    RAD_BASIS_LINEAR    /* refined as for constants; over the final links, linear in each surface */
};

struct RadSolveOptions {
    double tolerance;        /* relative L1 error of B that iteration may leave; 0: 1e-4 */
    int iterations;          /* sweeps per solve at the most; 0: 100000 */
    int jacobi;              /* 1: Jacobi sweeps instead of block Gauss-Seidel */
    enum RadClosure closure; /* NONE or ROWS */
    /* how faces are grouped, one of radGetClusteringNames(); NULL: the default */
    const char *clustering;
    /* whose picture counts, for oracles that read importance; NULL: all places alike */
    const struct RadCamera *camera;
    int unit; /* 1: every face has B = 1 and stays so: links and rows alone */
    enum RadBasis basis;
};
/* NULL-terminated; constant. */
RAD_API const char *const *radGetClusteringNames(void);
RAD_API const char *radGetClusteringDoc(const char *name);

/* Elements over a committed scene with B = E, no links yet. NULL options: the defaults. */
RAD_API RadSolution radNewSolution(RadScene scene, RadOracle oracle,
                                   const struct RadSolveOptions *options);
RAD_API void radRetainSolution(RadSolution solution);
RAD_API void radReleaseSolution(RadSolution solution);

/* Refine from the root, without solving, once and before radStep. Returns 0, or -1. */
RAD_API int radRefine(RadSolution solution);
/* One pass: refine from the root if nothing has, solve over the links, discuss them again in that
 * light. Returns 1 while links change and passes are left, 0 when done, -1 on error. */
RAD_API int radStep(RadSolution solution);
/* Passes until no link changes. Returns 0, or -1. */
RAD_API int radSolve(RadSolution solution);

/* Area means of one band over each polygon of the scene, both sides of two-sided ones;
 * [RadSceneReport.polygons], the caller's; any may be NULL. B of what is not covered by others, H
 * over all of it. Returns 0, or -1. */
RAD_API int radGetPolygonValues(RadSolution solution, uint32_t band, double *radiosity,
                                double *irradiance);

/* The receiver gathers form_factor * visibility / RAD_LINK_VISIBLE * B of the emitter. */
enum { RAD_LINK_VISIBLE = 1 << 14, RAD_LINK_MARKS = 8 };
struct RadLink {
    uint32_t receiver, emitter; /* elements */
    float form_factor;
    uint16_t visibility;
    /* how well both are known: form factor in the low four bits, visibility in the high ones */
    uint8_t levels;
    uint8_t mark;
};

/* Read-only views of a solution: good until it is stepped or released. All zero where there is
 * none: no links before radRefine or radStep, nothing of a solution that was cancelled. */
struct RadElements {
    /* [count]; 0 is the root; children of one element are neighbours */
    const struct element *elements;
    uint32_t count;
    uint32_t built;               /* of them, clusters and faces; parts of faces follow */
    const uint32_t *face_element; /* [RadSceneReport.faces]: the element that is the whole face */
    uint32_t bands;
    const double *radiosity, *irradiance; /* [element * bands + band]; clusters hold means */
    const double *uncovered; /* [count]: share of the element that no solid stands on */
    /* Of RAD_BASIS_LINEAR, once radSolve or the last radStep is done, else NULL:
     * [(element * bands + band) * 3]. B at point x of a surface is radiosity + gradient . (x -
     * centre), W/m2, and not below 0 where its mean is not; radiosity stays the mean over the
     * element. 0 of clusters and where a solid covers a part. */
    const double *gradient;
};
struct RadLinks {
    const struct RadLink *links; /* [count], by receiver */
    size_t count;
    /* [elements + 1]: those of element e are first[e] .. first[e + 1] - 1 */
    const size_t *first;
};
RAD_API void radGetElements(RadSolution solution, struct RadElements *elements);
RAD_API void radGetLinks(RadSolution solution, struct RadLinks *links);
/* What discussions of two elements of this solution ask: rays, candidates, totals. With it a
 * program can ask an oracle, a term or a tool about a pair of its own choice. Good until the
 * solution is stepped or released; NULL: there is none. */
RAD_API const struct host *radGetHost(RadSolution solution);

struct RadReport {
    uint32_t elements, leaves, bands;
    uint64_t links, pairs, rounds, rays; /* pairs: discussions held */
    uint64_t marked[RAD_LINK_MARKS];     /* links with each mark; mark 1: a guard kept them whole */
    uint64_t decided[8];                 /* how often each enum decision was taken */
    /* converged: iteration reached its tolerance and no link changes any more */
    int passes, iterations, converged;
    uint64_t changing;        /* links that the last pass changed */
    double residual;          /* of the last sweep: sum A |dB| / sum A B */
    double emitted, absorbed; /* W, all bands */
    /* row sums of leaves before cap or closure */
    struct {
        double low, high, defect_mean, defect_most, blind_area, moved;
    } rows;
    /* under closure: 1 no light leaves the scene, 0 some does, -1 not asked */
    int closed;
    uint64_t closed_rays;
    /* sweeps 0: none was asked for */
    struct {
        int sweeps;
        double largest, mean, seen;
    } importance;
    /* of error control (W/m2, m2); target 0: none */
    struct {
        double target, largest, area;
    } tolerance;
    /* clusters: the tree above the faces, part of build; in_rays: within Embree, mean over
     * threads, part of refine */
    struct {
        double build, refine, iterate, in_rays, clusters;
    } seconds;
    /* of RAD_BASIS_LINEAR; sweeps 0: there is none. limited: links whose slopes were made less, for
     * they brought negative light. Shares of the leaves' area: flat, since a solid covers a part;
     * lowered, slopes made less, since B would fall below 0. seconds: part of iterate */
    struct {
        int sweeps;
        uint64_t limited;
        double flat, lowered, seconds;
    } linear;
};
RAD_API void radGetReport(RadSolution solution, struct RadReport *report);

/* ---- exchange areas */

struct RadExchangeOptions {
    double tolerance; /* error of a row's sum to work for; 0: 3e-4 */
    enum RadClosure closure;
};
/* The built-in oracle viewfactors, its limits made for the tolerance (0: the default). Returns
 * NULL on error. */
RAD_API RadOracle radNewExchangeOracle(RadDevice device, double tolerance);
/* Oracle NULL: the same. Returns NULL on error. */
RAD_API RadExchange radNewExchange(RadScene scene, RadOracle oracle,
                                   const struct RadExchangeOptions *options);
RAD_API void radRetainExchange(RadExchange exchange);
RAD_API void radReleaseExchange(RadExchange exchange);

/* Row i of F_ij: share of what leaves polygon i evenly that meets polygon j;
 * row[RadSceneReport.polygons], the caller's. Safe from many threads at once. Returns its sum, or
 * -1. */
RAD_API double radGetExchangeRow(RadExchange exchange, uint32_t i, double *row);

struct RadExchangeReport {
    uint64_t links, pairs, rays;
    double low, high; /* of all rows' sums, before closure */
    /* that ought to sum to 1; see the environment, or a black back; are covered in part */
    uint32_t rows_closed, rows_open, rows_covered;
    double defect_most, defect_mean; /* |1 - sum| of the closed ones, before closure */
    /* what the open ones lack: the most, and the mean over all area */
    double environment_most, environment_mean;
    /* largest |factor - 1| that a view factor took; largest |1 - sum| left */
    double closure_change, closure_left;
    struct {
        double refine, fill;
    } seconds;
};
RAD_API void radGetExchangeReport(RadExchange exchange, struct RadExchangeReport *report);

#ifdef __cplusplus
}
#endif

#endif
