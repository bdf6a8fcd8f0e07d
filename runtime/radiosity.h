/* radiosity.h - hierarchical radiosity as a library: scenes and oracles in, light and view factors
 * out.
 *
 * Six opaque handles, in the manner of Embree's API:
 *
 *     RadDevice    threads, errors and progress; owns nothing else
 *     RadScene     faces and materials; after radCommitScene what solutions are made over
 *     RadOracle    a refinement oracle: built in, a .dag file or text, or a compiled refiner
 *     RadSolution  elements, links and radiosities of one scene by one oracle
 *     RadExchange  exchange areas A_i F_ij between the polygons of a scene (view factors)
 *     RadReference what the polygons of a scene radiate, by chance alone, to judge solutions by
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
 * RadDeviceOptions.threads threads: the caller's, and helpers that all devices share, which sleep
 * while there is nothing to do, take no signals and end with the last device. The caller does what
 * no helper has begun, so beside other work threads never cost more than they bring. Results do not
 * depend on how many there are. A program may fork, and have any OpenMP of its own or none.
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
typedef struct RadReferenceObject *RadReference;

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
    RAD_ERROR_CANCELLED, /* by the progress function */
    RAD_ERROR_LIMIT      /* refinement did not end: see struct RadLimits */
};

struct RadDeviceOptions {
    int threads; /* 0: as many as there are processors */
    /* C compiler for the flat release of files and texts, with arguments after blanks, as in
     * "ccache gcc"; NULL: "cc" */
    const char *compiler;
    const char *temporary; /* folder for what it makes; NULL: "/tmp" */
};

/* Told of every error, from the calling thread; `message` is good until it returns. */
typedef void (*RadMessageFunction)(void *user, enum RadError code, const char *message);

/* NULL options: the defaults. Returns NULL when out of memory. */
RAD_API RadDevice radNewDevice(const struct RadDeviceOptions *options);
/* A device over processes that work together: `communicator` is the address of an MPI_Comm, of
 * which it makes its own; MPI_Init_thread(MPI_THREAD_FUNNELED) comes before, MPI_Finalize after the
 * last release. Each process, a rank, makes the same calls with the same arguments, from one
 * thread; each of radNewSolution, radRefine, radStep, radSolve, radSolveScene,
 * radMeasureError, radMeasurePlaces, radCorrect, radNewReference, radTraceReference,
 * radNewExchange, radMultiplyExchange, radGetPointFactors, radGetRanks and radGetExchangeRanks
 * waits for all, and so does this call. Results are the same on all ranks, and the same as of one
 * process: links, counts of particles and view factors to the bit. A rank keeps the links whose
 * receivers it has: radGetLinks lends these; of exchange areas all have all. A progress function
 * may not cancel a solve. What looks at all links at once (Southwell's method, LU, error control,
 * ranked links, enclosing solutions, accounts and causes of errors, traces, statistics) is refused
 * with RAD_ERROR_UNSUPPORTED while there are several ranks. Returns NULL, and
 * radGetDeviceError(NULL) says why: RAD_ERROR_UNSUPPORTED where the library was built without MPI.
 */
RAD_API RadDevice radNewDeviceMPI(const struct RadDeviceOptions *options, const void *communicator);
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
    /* "refine", "solve", "matrix" (of RAD_SOLVER_LU, which says nothing until it is done),
     * "particles", "paths", "account", "causes", "factors", "again" (rows of view factors that do
     * not add up are looked at a second time); "resumed": once, what a run before this one had done
     * (struct RadExchangeState) */
    const char *phase;
    int pass; /* from 1 */
    uint64_t rounds, pairs, waiting, links;
    uint64_t rays; /* of "particles": those that they have taken, about */
    double residual;
    double share; /* of this phase's work that is done, about, 0 to 1; 0 where nobody knows */
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

/* What to do of polygons whose front is on another side than that of their neighbours over edges,
 * or that are a closed room standing empty in another: nothing, find them (RadSceneReport), or
 * besides turn those of closed shells. */
enum RadTurned { RAD_TURNED_IGNORE, RAD_TURNED_FIND, RAD_TURNED_FLIP };

/* Polygons in arrays of the caller's, which must outlive radCommitScene and are not looked at after
 * it. Polygon i has sizes[i] corners (all have `size` when sizes is NULL), whose indices into
 * positions stand one polygon after the other, counter-clockwise seen from the front. Concave and
 * bent polygons are cut into flat convex ones. One whose outline crosses itself is all that the
 * outline goes round, once, with its front where that of its larger part is. Polygons without area,
 * also those of fewer than three corners, are dropped and counted, and keep their place in all
 * lists of polygons. */
struct RadPolygons {
    const double *positions; /* [position_count * 3], m */
    size_t position_count;
    const uint32_t *indices; /* [sum of sizes] */
    const uint32_t *sizes;   /* [count]; those below 3 are polygons without area; or NULL */
    uint32_t size;
    const uint32_t *materials; /* [count], indices of materials; NULL: all have material 0 */
    uint32_t count;
    /* 1: positions have been floats; then what is thinner than these can say has no area */
    int single_precision;
    int as_given; /* 1: quads are taken for flat and convex, and no face is cut where others stand
                     in it; for studies of what comes of it */
    enum RadTurned turned;
    /* 1: faces of a hundredth of the area or more that are six times as long as wide are cut
     * across, as solutions want them; view factors need it not */
    int cut_long;
};

RAD_API RadScene radNewScene(RadDevice device);
RAD_API void radRetainScene(RadScene scene);
RAD_API void radReleaseScene(RadScene scene);

/* Copied. Returns 0, or -1. */
RAD_API int radSetSceneMaterials(RadScene scene, const struct RadMaterial *materials,
                                 uint32_t count);
/* Kept as it is: the arrays are borrowed until the commit. Returns 0, or -1. */
RAD_API int radSetSceneSharedPolygons(RadScene scene, const struct RadPolygons *polygons);
/* Check everything, take off faces what others cover, cut faces where others stand in them. After
 * it the scene does not change. Returns 0, or -1.
 *
 * Polygons that lie on others in one plane, with the same side in front, would take the same light
 * twice. Each side of each place in a plane belongs to one polygon: of those that emit, if any
 * does, the first, else the first; the others lose it, and RadSceneReport counts them. */
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

enum { RAD_OVERLAPS_NAMED = 3, RAD_TURNED_NAMED = 5 };

struct RadSceneReport {
    uint32_t polygons; /* as they were set */
    uint32_t dropped;  /* of them, without area */
    /* of them, whose outline crosses itself; the first */
    uint32_t crossing, crossing_first;
    uint32_t cut, parts; /* faces cut where others stand, or as they are long; into so many */
    uint32_t overlaps;   /* polygons that lay on others in one plane and lost what was covered */
    double overlap_area; /* that they lost, of all their sides (m2) */
    struct RadOverlap {
        uint32_t polygon, on;      /* the polygon that stays */
    } overlap[RAD_OVERLAPS_NAMED]; /* the first of them */
    /* polygons that look turned, if asked for: of closed shells, which RAD_TURNED_FLIP has turned;
     * others; the first of each */
    struct RadTurnedPolygons {
        uint32_t count, polygon[RAD_TURNED_NAMED];
    } turned_closed, turned_open;
    uint32_t faces, materials, bands;
    double area;            /* of all faces, both sides of two-sided ones (m2) */
    double low[3], high[3]; /* their box (m) */
};
/* Of a committed scene. Returns 0, or -1. */
RAD_API int radGetSceneReport(RadScene scene, struct RadSceneReport *report);
/* [RadSceneReport.faces], the scene's own. NULL before the commit. */
RAD_API const struct RadFace *radGetSceneFaces(RadScene scene);
/* One side's area of each polygon (m2), 0 of those that were dropped or covered, of sides covered
 * unequally the mean; [RadSceneReport.polygons], the scene's own. */
RAD_API const double *radGetScenePolygonAreas(RadScene scene);
RAD_API const struct RadMaterial *radGetSceneMaterials(RadScene scene);

/* ---- oracles */

enum RadRelease {
    RAD_RELEASE_FLAT, /* compiled C */
    RAD_RELEASE_DAG,  /* the graph, interpreted node by node */
    RAD_RELEASE_HAND, /* what a program has registered by hand */
    RAD_RELEASE_WAVE  /* compiled C over blocks of pairs, all that are at a node at once */
};

/* The built-in oracles' names, NULL-terminated; constant. The default is radGetDefaultOracle(),
 * RAD_DEFAULT_ORACLE when the program was compiled. */
#define RAD_DEFAULT_ORACLE "power"
RAD_API const char *const *radGetOracleNames(void);
RAD_API const char *radGetDefaultOracle(void);
/* The graph of a built-in oracle, as a .dag file has it, with what it imports behind it: it stands
 * alone. Constant; NULL: there is none of that name. */
RAD_API const char *radGetOracleText(const char *name);

/* C functions `double NAME(const struct discussion *d)` (discussion.h) for the `extern NAME` of
 * graphs that are loaded into this device afterwards; the compiled and the interpreted release call
 * the same ones. `path`: a shared object that defines them and
 * `const int radiosity_plugin_abi = RUNTIME_ABI;`, or a C file (its name ends in .c), which is
 * compiled now against the library's own headers. Of plugins that define the same function the last
 * one counts. They are called from many threads at once and may read the pair, the host and the
 * terms that the extern's declaration names, and nothing else. Returns 0, or -1 after an error. */
RAD_API int radLoadPlugin(RadDevice device, const char *path);

/* A built-in oracle, or one that was registered, by name. Returns NULL on error. */
RAD_API RadOracle radNewOracle(RadDevice device, const char *name, enum RadRelease release);
/* A .dag file ("-": standard input), or the text of one under the name `path`; `oracle`: which of
 * the file's, NULL: the only one. FLAT and WAVE need a C compiler and compile it now. */
RAD_API RadOracle radLoadOracle(RadDevice device, const char *path, const char *oracle,
                                enum RadRelease release);
RAD_API RadOracle radParseOracle(RadDevice device, const char *path, const char *text,
                                 const char *oracle, enum RadRelease release);
/* One of the same with nodes that are otherwise than written, for once: `replacements` are
 * [count] texts "NODE = TOOL(...)", which keeps the answers that both tools have, "NODE = TOOL(...)
 * { rules }", or "NODE = ANSWER", which asks nothing and goes where this answer leads. NODE is
 * called as statistics call it, USE__NAME within a branch. `text` NULL: `path` names a file.
 * Messages about replacements name "--replace" as their source. Returns NULL on error. */
RAD_API RadOracle radLoadOracleReplaced(RadDevice device, const char *path, const char *text,
                                        enum RadRelease release, const char *const *replacements,
                                        int count);
/* Calls each(user, path) for every file that a .dag file's graph is made of: itself, what it
 * imports, and its catalog where that is a file; until one call does not return 0. Returns what the
 * last call did; 0 without any when the graph has errors, which radLoadOracle tells. */
RAD_API int radListOracleFiles(const char *path, int (*each)(void *user, const char *path),
                               void *user);
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
    /* the oracle's own; fingerprint: of its graph, in all releases alike, "" when hand-written */
    const char *name, *release, *doc, *fingerprint;
    const struct oracle_parameter *parameters; /* [parameter_count], the oracle's own */
    int parameter_count;
    int reads_importance, reads_tolerance; /* facts that a solver must provide */
    /* [read_count], enum catalog_fact, ascending: all that its arguments read; the oracle's own */
    const int *reads;
    int read_count;
};
RAD_API void radGetOracleReport(RadOracle oracle, struct RadOracleReport *report);
/* The graph of an interpreted oracle as JSON, schema dagc/1 (dagc --emit=json, dagc(1)): nodes,
 * tools, answers, branches, parameters with their defaults. The oracle's own. NULL on error:
 * RAD_RELEASE_DAG only. */
RAD_API const char *radGetOracleGraph(RadOracle oracle);
/* Returns 0, or -1: no such parameter, fixed by the oracle's author, or not in its range. A
 * progress function may set them, and ask for statistics, too: in phase "refine" it is called
 * between rounds, when nobody asks the oracle, and the next round goes by the new value. */
RAD_API int radSetOracleParameter(RadOracle oracle, const char *name, double value);
/* NAN when there is no such parameter. */
RAD_API double radGetOracleParameter(RadOracle oracle, const char *name);
/* All of its thresholds coarser or finer together: parameters with the role of a link's threshold
 * or of a tolerance that is a share become `scale`, above 0, times what was set, and the smallest
 * part as well where that is below 1, all within their ranges; but for what its author has fixed.
 * It is what was set that counts, not the last scale: 1 brings it back. Returns how many are
 * scaled, or -1. */
RAD_API int radScaleOracle(RadOracle oracle, double scale);
/* Ask it once; safe from many threads while no parameter is set. */
RAD_API enum decision radAskOracle(RadOracle oracle, struct discussion *discussion);
/* The same of `count` discussions, which have one host: decisions[i] is that of block[i]. By
 * RAD_RELEASE_WAVE together, by others one after the other. */
RAD_API void radAskOracles(RadOracle oracle, struct discussion *block, int count,
                           enum decision *decisions);

/* What was counted of an interpreted graph, on all threads. Counts are exact. Time is measured in
 * one discussion of RAD_TIMED_EVERY, chosen at random, and scaled by the calls: an estimate.
 * [Turbet & Sillion, section 4.3] */
struct RadAnswerCount {
    const char *name, *kind; /* kind: "precise", "approximate", "other", "command" */
    const char *target;      /* node or decision */
    uint64_t count;
};
enum { RAD_WIDTHS = 3 };
struct RadTermCount {
    const char *name;
    uint64_t count; /* how often the node brought the term to a better level than it had */
};
struct RadNodeCount {
    const char *name, *tool;
    uint64_t calls;
    const struct RadAnswerCount *answers; /* [answer_count] */
    int answer_count;
    uint64_t timed; /* calls whose time was measured */
    double seconds; /* of all calls, arguments included, in all threads together; 0: none timed */
    uint64_t rays;  /* that it cast, by the host's `occluded` */
    const struct RadTermCount *terms; /* [term_count], those that it computed at least once */
    int term_count;
    /* What a release in waves finds here: lists of up to 256 pairs, and the vectors of 4, 8 and 16
     * pairs that they fill, the last of a list in part. 0: pairs were asked one by one. */
    uint64_t lists, vectors[RAD_WIDTHS];
};
/* A way through the graph that discussions went: nodes[i] gave answers[i]. */
struct RadPath {
    const int *nodes, *answers; /* [length], in RadStatistics.nodes and their answers */
    int length;
    uint64_t count, timed; /* discussions that went it; of them, timed */
    double seconds;        /* of all of them; 0: none timed */
};
/* Rounds between two solves: what was counted in them. */
struct RadPass {
    uint64_t discussions, rays;
    double seconds;
    const struct RadNodeCount *nodes; /* [RadStatistics.node_count] */
};
enum { RAD_COUNTS = 256, RAD_RECORDS = 8, RAD_BINS = 128, RAD_PATHS = 16, RAD_TIMED_EVERY = 128 };
struct RadStatistics {
    const struct RadNodeCount *nodes; /* [node_count], the start first */
    int node_count;
    const uint64_t *counts; /* [RAD_COUNTS]: of tool count */
    /* Of tool record: histograms of values v > 0 by floor(log2 v) + 64, and how many were not
     * above 0. */
    const uint64_t (*bins)[RAD_BINS]; /* [RAD_RECORDS] */
    const uint64_t *zero;             /* [RAD_RECORDS] */
    const struct RadPass *passes;     /* [pass_count], those that are over */
    int pass_count;
    /* The paths that took most time, at most RAD_PATHS, the longest first; how many were gone at
     * all. A graph of 2^64 paths or more has none told. */
    const struct RadPath *paths;
    int path_count;
    uint64_t distinct_paths;
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

/* How the equations that the links stand for are solved; all to the same answer. */
enum RadSolver {
    RAD_SOLVER_GAUSS_SEIDEL, /* in blocks of faces; of slow sweeps the limit is guessed */
    RAD_SOLVER_JACOBI,
    /* progressive shooting: the most unshot power first. A solve that `iterations` cut short has
     * the ambient estimate of Cohen et al. 1988 added; no other is changed by it */
    RAD_SOLVER_SOUTHWELL,
    /* a dense matrix, by LAPACKE; RAD_LU_LEAVES at the most. While links change much, and so
     * solves need be rough only, Gauss-Seidel; LAPACK decides the last bits */
    RAD_SOLVER_LU,
    /* PETSc's Krylov methods on the matrix of links, GMRES unless its options (PETSC_OPTIONS)
     * name another, then sweeps, which say that the tolerance is reached. While links change much
     * Gauss-Seidel, as with LU. On any number of ranks, and by GMRES, Bi-CGStab and others that
     * take plain dot products, to the same bits. Only where the library was built with PETSc, which
     * begins then unless the program has begun it, and ends with MPI; the calls of all threads are
     * made one after the other */
    RAD_SOLVER_PETSC
};
enum { RAD_LU_LEAVES = 5000 };

/* 1: this library has the solver; 0: it was built without, or there is none such. */
RAD_API int radHasSolver(enum RadSolver solver);

/* What an element keeps of the irradiance on it. */
enum RadProjection {
    RAD_PROJECTION_GALERKIN, /* its mean */
    /* its value at the centre: links between surfaces have the form factor from there. RadLink's
     * stays the mean, which oracles decide by. [Arvo et al. 1994, section 4.2] */
    RAD_PROJECTION_COLLOCATION
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

/* Where refinement ends with RAD_ERROR_LIMIT: an oracle need not end, and what it has left by then
 * is no answer. The message says what was reached and, of an oracle with a graph, which node
 * decides most of the last subdivisions. 0: the default, which no oracle meets that ends (16
 * splits; 2 million parts of faces more than twice the links and stops; what half of the memory
 * holds; 1e11 discussions, 1e7 rounds). Of several ranks `pairs` is the limit of all together, the
 * others of each. A solution that was refused can only be released. */
struct RadLimits {
    int depth;                     /* splits below a face, at most 250 */
    uint64_t elements;             /* parts of faces */
    uint64_t links, pairs, rounds; /* pairs: discussions. Over all passes of the solution */
};

struct RadSolveOptions {
    /* Relative L1 error of B that iteration may leave; 0: a tenth of what constants on the leaves
     * leave of it, estimated, within 1e-4 and 1e-3 (RadReport.solved says what it came to).
     * [Arvo et al. 1994, section 6.3] */
    double tolerance;
    int iterations; /* sweeps per solve at the most; 0: 100000 */
    enum RadSolver solver;
    enum RadProjection projection;
    enum RadClosure closure; /* NONE or ROWS */
    /* how faces are grouped, one of radGetClusteringNames(); NULL: the default */
    const char *clustering;
    /* whose picture counts, for oracles that read importance; NULL: all places alike */
    const struct RadCamera *camera;
    int unit; /* 1: every face has B = 1 and stays so: links and rows alone */
    enum RadBasis basis;
    struct RadLimits limits;
    /* 1: nothing is discussed, no links are made: every surface receives the mean irradiance, what
     * emitters send out over what surfaces absorb at one reflection, and radCorrect has particles
     * measure all light. [Cohen et al. 1988, the ambient term] */
    int no_links;
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

/* How many links there are, of one oracle. */
struct RadChoice {
    double scale;   /* of the oracle's thresholds, as radScaleOracle has it */
    int no_links;   /* 1: none, as RadSolveOptions has it; then scale means nothing */
    uint64_t rays;  /* of measuring, and of solutions that were given up */
    double seconds; /* for these */
};
/* Told of each solution that is tried, before it is solved, and of its links. Return 0 to go on,
 * anything else to give up: RAD_ERROR_CANCELLED. Those that are not chosen may be retained, but are
 * empty then, as one that was cancelled. */
typedef int (*RadTryFunction)(void *user, RadSolution solution, const struct RadChoice *choice);
struct RadChoiceOptions {
    int keep_links; /* 1: there shall be some, whatever they cost */
    RadTryFunction begin;
    void *user;
};

/* Make a solution and solve it over as many links as pay, for radCorrect to mend: none, coarse
 * ones, or those that the oracle asks for as it is set, whichever leaves least to do for links and
 * particles together (engine/api_choice.c). None only where the basis is linear and nothing is
 * said of closure, solver and tolerance. What is chosen follows from counts, not from time: it is
 * the same for any number of threads and ranks. The oracle's thresholds are left scaled so. NULL
 * options, wishes: the defaults; NULL choice: nobody asks. Returns the solution, or NULL. */
RAD_API RadSolution radSolveScene(RadScene scene, RadOracle oracle,
                                  const struct RadSolveOptions *options,
                                  const struct RadChoiceOptions *wishes, struct RadChoice *choice);

/* Area means of one band over each polygon of the scene, both sides of two-sided ones, a dark one
 * with 0 (W/m2); [RadSceneReport.polygons], the caller's; any may be NULL. B of what is not covered
 * by others, H over all of it. Returns 0, or -1. */
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
    /* [element * bands + band] (W/m2); clusters hold means */
    const double *radiosity, *irradiance;
    /* [count]: share of the element that no solid stands on; 0 of a side that no light comes to, as
     * the inside of a solid */
    const double *uncovered;
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
/* Give the links other form factors, [RadLinks.count] in their order, each from 0 and finite, and
 * solve over them: no link is discussed again, visibility stays, and radStep and radSolve find
 * nothing left to do. For studies of what form factors are worth; those of links with a cluster at
 * an end are not looked at. After radRefine, radStep or radSolve. Returns 0, or -1. */
RAD_API int radSolveWithFactors(RadSolution solution, const float *form_factors);
/* What discussions of two elements of this solution ask: rays, candidates, totals. With it a
 * program can ask an oracle, a term or a tool about a pair of its own choice. Good until the
 * solution is stepped or released; NULL: there is none. */
RAD_API const struct host *radGetHost(RadSolution solution);

struct RadReport {
    uint32_t elements, leaves, bands;
    uint64_t links, pairs, rounds, rays; /* pairs: discussions held */
    uint64_t marked[RAD_LINK_MARKS];     /* links with each mark; mark 1: a guard kept them whole */
    uint64_t marked_elements[RAD_LINK_MARKS]; /* elements with each mark, [0] without */
    uint64_t decided[8];                      /* how often each enum decision was taken */
    /* a sum over all links, and over all counts of particles since the last radCorrect (0: none):
     * equal where all of them are equal to the bit */
    uint64_t link_fingerprint, particle_fingerprint;
    /* converged: iteration reached its tolerance, or came as near as last digits let it, and no
     * link changes any more; with linear elements at most one in a thousand does */
    int passes, iterations, converged;
    enum RadSolver solver;
    enum RadProjection projection;
    uint64_t changing;        /* links that the last pass changed */
    double residual;          /* of the last sweep: sum A |dB| / sum A B */
    double emitted, absorbed; /* W, all bands */
    /* of the last solve: the bound on what iteration left of B, relative in L1, the tolerance that
     * was held against; and what constants leave (estimated, the same unit), 0 where the tolerance
     * was given or nothing came near it */
    struct {
        double bound, tolerance, variation;
    } solved;
    /* row sums of leaves before cap or closure, per uncovered area: the smallest and the largest;
     * |row - 1|, its mean by uncovered area and the largest; uncovered leaves without any link
     * (m2); what the cap or closure took, sum of A (row - 1) over rows above 1, over the scene's
     * area */
    struct {
        double low, high, defect_mean, defect_most, blind_area, moved;
    } rows;
    /* under closure: 1 no light leaves the scene, 0 some does, -1 not asked */
    int closed;
    uint64_t closed_rays;
    /* of a view, or, for oracles that compare errors in watts, of all surfaces alike: the largest
     * of a leaf, and the mean by area; seen: area in the picture (m2). sweeps 0: none was asked
     * for */
    struct {
        int sweeps;
        double largest, mean, seen;
    } importance;
    /* two solutions that enclose the true one, W: sum of area times radiosity over all surfaces and
     * bands; solves 0: none were asked for. True for oracles that drop no pair which exchanges
     * light, as `bracket` does not */
    struct {
        int solves;
        double lower, upper;
    } bracket;
    /* where links are ranked (asked: 1), W: error times impact of all links together, and of the
     * worst that can still be split */
    struct {
        int asked;
        double all, worst;
    } ranking;
    /* of error control (W/m2, m2); target 0: none */
    struct {
        double target, largest, area;
    } tolerance;
    /* W: what the oracle promises that the powers (area times radiosity) of all faces together are
     * wrong by at the most, in each band; 0: nothing. Only a measurement tells whether they are:
     * radMeasureError */
    double power_tolerance;
    /* s. clusters: the tree above the faces, part of build; in_rays: within Embree, mean over
     * threads, part of refine, by one call in about 512 rays */
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

/* What each rank has and has done (radNewDeviceMPI). Bytes are those sent: of what all are told, to
 * each of the others. */
enum RadTraffic {
    RAD_TRAFFIC_SPLITS,    /* which elements passes have split */
    RAD_TRAFFIC_LINKS,     /* links to the owners of their receivers, and who needs which emitter */
    RAD_TRAFFIC_SWEEPS,    /* radiosities of emitters, while sweeps go on */
    RAD_TRAFFIC_VALUES,    /* what all elements have, after a solve; factors of pairs */
    RAD_TRAFFIC_PARTICLES, /* counts of particles and paths */
    RAD_TRAFFIC_PAIRS,     /* what came of pairs that are dealt out, of view factors */
    RAD_TRAFFICS
};
struct RadRank {
    uint64_t links, pairs, rays; /* kept; discussed; cast by these discussions */
    uint64_t faces, ghosts;      /* owned; elements of others that its links take light from */
    uint64_t named;              /* of what links name: elements of others, and clusters */
    uint64_t elements;           /* that it has had at once, at the most */
    uint64_t sent[RAD_TRAFFICS]; /* bytes */
    double memory;               /* the most that the process has held, bytes */
    double seconds;              /* of processors, that the process has taken */
};
/* Into ranks[most], in their order. Returns how many there are; 0 on error. */
RAD_API int radGetRanks(RadSolution solution, struct RadRank *ranks, int most);
/* The same of exchange areas (below): all ranks have all links; pairs, of polygons, and rays are
 * those that the rank itself has worked out; there are no faces and ghosts. */
RAD_API int radGetExchangeRanks(RadExchange exchange, struct RadRank *ranks, int most);

/* ---- solutions put down between two passes */

/* What it takes to go on with a solve another day: parts, each a table of `rows` by `columns`. What
 * goes on from them ends with the same bits as what was never put down, on any number of threads
 * and ranks, whatever number made them. They are of one scene, oracle with its parameters, and
 * options but limits; of this version of the library, and of machines with this one's order of
 * bytes. */
enum {
    RAD_STATE_HEAD, /* counts, and hashes of all */
    RAD_STATE_SPLIT,
    RAD_STATE_MARK,
    RAD_STATE_SEEN,
    RAD_STATE_UNCOVERED,
    RAD_STATE_RADIOSITY,
    RAD_STATE_IRRADIANCE,
    RAD_STATE_LINK, /* of several ranks each has rows of its own; the other parts all have alike */
    RAD_STATE_PARTS
};
enum RadStateType {
    RAD_STATE_OF_LONGS,   /* uint64_t */
    RAD_STATE_OF_WORDS,   /* uint32_t */
    RAD_STATE_OF_NUMBERS, /* double */
    RAD_STATE_OF_LINKS    /* struct RadLink */
};
struct RadStatePart {
    const char *name; /* a word of small letters */
    enum RadStateType type;
    uint64_t rows, columns;
    const void *data;
};
/* Lent until the solution goes on or is released. Between two passes: from a RadPassFunction, or
 * after radRefine or a radStep that says that there is more to do. Of oracles that read importance
 * or tolerance, rank links or enclose the solution there is none (RAD_ERROR_UNSUPPORTED). By all
 * ranks. Returns 0, or -1. */
RAD_API int radGetSolutionState(RadSolution solution, struct RadStatePart part[RAD_STATE_PARTS]);
/* Bring a new solution there, before anything else; radStep and radSolve go on. The parts are the
 * caller's; of several ranks each gives all of them but links, of which each gives some. Returns 0,
 * or -1: RAD_ERROR_INVALID_ARGUMENT where they are damaged or of other work; the message says why,
 * as in "it is damaged". Then the solution may only be released. */
RAD_API int radSetSolutionState(RadSolution solution,
                                const struct RadStatePart part[RAD_STATE_PARTS]);
/* Called by radSolve when a pass is over and another follows, from the thread that called in.
 * Return 0 to go on, anything else to cancel: radSolve fails with RAD_ERROR_CANCELLED. */
typedef int (*RadPassFunction)(void *user, RadSolution solution);
RAD_API void radSetSolutionPassFunction(RadSolution solution, RadPassFunction function, void *user);

/* ---- how far from the truth */

/* A share of the reflected light (0.021: 2.1 %), and its 95 % interval. */
struct RadMeasure {
    double value, low, high;
};

struct RadMeasureOptions {
    /* how many to cast, about; 0: RAD_MEASURE_SHARE of what the solution has cast and
     * RAD_MEASURE_MENDED of what mending has, RAD_MEASURE_PATHS of it where paths have mended,
     * whose noise falls faster than with the root of their number, and no fewer than
     * RAD_MEASURE_LEAST, RAD_MEASURE_SURFACES where surfaces are asked for, and RAD_MEASURE_POLYGON
     * for each polygon */
    uint64_t rays;
    /* which random numbers, 0 to 2^31: measurements of different ones are independent of each
     * other, and all of what a solution is mended with */
    uint32_t stream;
    /* 1: the errors over the surfaces, l2 and p999, too */
    int surfaces;
    /* 1: of polygons and all light alone, a fifth faster: radGetElementErrors may give nothing */
    int polygons;
};
#define RAD_MEASURE_SHARE 0.01
#define RAD_MEASURE_MENDED 0.05
#define RAD_MEASURE_PATHS 0.2
#define RAD_MEASURE_LEAST (1u << 15)
#define RAD_MEASURE_SURFACES 250000u
#define RAD_MEASURE_POLYGON 16u

/* As many as there can be: each has more than a hundredth of what reflects. */
enum { RAD_UNSURE_NAMED = 100 };
/* Errors are those of the light that is reflected, B - E: to E nothing can be wrong. */
struct RadErrorReport {
    struct RadMeasure power; /* of all light together; positive: the solution is too bright */
    /* sum over polygons and bands of the modulus; no less than what of power is sure */
    struct RadMeasure l1_faces;
    /* over the surfaces, of what RadMeasureOptions.surfaces asked for, slopes included: root of
     * the integral of the squared error over that of (B - E)^2; and what 99.9 % of the area is
     * below, over the area mean of B - E */
    struct RadMeasure l2, p999;
    /* the L1 error per polygon that these particles, by chance, have themselves: what is left of it
     * in what is mended with them */
    struct RadMeasure noise;
    double reflected; /* light reflected, as counted, all bands (W) */
    /* where no particle was reflected, though some may be: no more than that is (W, 95 %). Nothing
     * is known of errors then: l1_faces.high and power.high are INFINITY, power.low -INFINITY.
     * Else 0 */
    double unseen;
    /* by band: its share of the light that the solution reflects, and noise.value of it as a share
     * of the band's own light: a band with few of the watts is known by few particles, or by none
     * (1), and `noise` does not show it. Of radCorrect: what all that mended know, split particles
     * as well */
    double band_light[3], band_noise[3];
    /* of polygons above a hundredth of what reflects, the one that is most surely wrong, and by
     * which share of what it reflects, as measured, and at the least; RadSceneReport.polygons: none
     * is, surely. The share is the largest of many, and so rather too large; its sign is sure. */
    uint32_t worst;
    double worst_share, worst_sure;
    /* light that ends on black backs, as counted by particles (by paths: 0), a share of what is
     * emitted; of the polygon that takes most of it the share of that, and which it is;
     * RadSceneReport.polygons: none. Much of it where faces are turned the wrong way. */
    double backs, back_share;
    uint32_t back;
    /* of radCorrect alone: polygons that reflect and have above a hundredth of the area of all that
     * do, and groups of smaller ones that have, as the tiles of a wall (`gathered`); and how many
     * of both are so dim that, mended, their light is not known to 5 % (two standard errors):
     * those, groups by a polygon of them */
    uint32_t large, gathered, unsure, unsure_named[RAD_UNSURE_NAMED];
    /* and of polygons that are no larger than that how many are not known to 5 %, neither by what
     * was counted on them, nor by paths, nor by what mending is thought to leave of their error;
     * and the area of these together (m2) */
    uint32_t small_unsure;
    double small_area;
    uint64_t rays, particles; /* that measuring took; no part of RadReport.rays */
    /* 1: `particles` are paths from polygons: where these tell polygons at a far lower price, as
     * under a sky, they mend and measure (engine/path_mending.c) */
    uint32_t by_paths;
    double seconds;
};
/* Measure how far the solution, mended or not, is from the truth, by particles traced from the
 * emitters that no part of it comes from: unbiased whatever oracle and links are, with the noise
 * of chance, which the intervals tell. Of a mended solution the intervals of power and l1_faces
 * are narrowed by what the particles that mended it say (engine/mended_reach.c). NULL options: the
 * defaults. The same figures for any number of threads. Returns 0, or -1.
 * [Pattanaik and Mudur 1992; engine/face_error.c] */
RAD_API int radMeasureError(RadSolution solution, const struct RadMeasureOptions *options,
                            struct RadErrorReport *report);

/* Of the last measurement: the mean B of each polygon less the truth, and the standard error of
 * that (W/m2), in one band; [RadSceneReport.polygons], the caller's; either may be NULL. B is
 * E + rho H, H the mean over both sides. Returns 0, or -1: nothing has been measured. */
RAD_API int radGetPolygonErrors(RadSolution solution, uint32_t band, double *error,
                                double *deviation);
/* The mean B of each leaf less the truth where that stands clear of noise, 0 where it does not and
 * of all other elements: [element * bands + band], W/m2. What a leaf's own particles do not tell is
 * told by the smallest part of its face around it that is surely off by another share; in 95 of 100
 * measurements of a solution that is right all are 0. The solution's own until it is measured again
 * or stepped; NULL: nothing has been measured of leaves, or there is no memory for it.
 * [engine/element_error.c] */
RAD_API const double *radGetElementErrors(RadSolution solution);
/* The same of what the modulus of that difference is below, in 95 of 100 leaves: the mean over such
 * a part, or over what else there is of the polygon, and two standard errors of it. So an error of
 * 0 with a limit near B is not known, one with a small limit is none. */
RAD_API const double *radGetElementErrorLimits(RadSolution solution);

struct RadCorrectOptions {
    /* particles are traced until their noise in the L1 error of polygons is below this share of the
     * reflected light; 0: RAD_CORRECT_NOISE, or, with `rays` 0, from RAD_CORRECT_PLAIN rays on
     * until what mending leaves of that error is below RAD_CORRECT_LEFT, by its upper end
     * (engine/mended_error.c) */
    double noise;
    /* or until about so many rays are cast. 0: as many as bring the error on places of 1e-4 of the
     * scene's area to RAD_CORRECT_PLACES, root mean square as in RadPlaces, and on until the noise
     * is as small as that; no fewer than RAD_CORRECT_LEAST. No more than RAD_CORRECT_MOST,
     * RAD_CORRECT_OF_ONE for each polygon up to RAD_CORRECT_OF_ALL, or what the solution has cast,
     * whichever is the most. Nor do they end before all reflected light has a standard error below
     * RAD_CORRECT_POWER, so that its sum is right within a hundredth in 99 of 100 */
    uint64_t rays;
    /* 1: where there are several ranks the quarters of leaves may stay with the rank that owns
     * their face: memory for all of them is most of what a solution takes. Then radGetElements
     * shows, of leaves of other ranks, the whole, radGetElementErrors nothing, and links are not
     * stepped on from there; until surfaces are measured, which all quarters are needed for */
    int own;
    /* 1: a look, to learn what so many rays would leave: polygons that are too dim for particles
     * are not asked by paths, which may take many times as many rays */
    int look;
};
#define RAD_CORRECT_NOISE 0.0065
#define RAD_CORRECT_LEFT 0.0085
#define RAD_CORRECT_POWER 0.0039
#define RAD_CORRECT_PLAIN (1u << 20)
#define RAD_CORRECT_PLACES 0.065
#define RAD_CORRECT_LEAST (1u << 17)
#define RAD_CORRECT_MOST (1u << 24)
#define RAD_CORRECT_OF_ONE 6400u
#define RAD_CORRECT_OF_ALL (1u << 26)

/* How far links are off, point by point: squared errors on places of about 1e-4 of the scene's
 * area, each as a share of the light that falls there, the places weighed by that light. */
struct RadPlaces {
    double links;     /* of links; by chance it may come out below 0 */
    double deviation; /* standard deviation of that */
    double ray;       /* of particles of one ray; of r rays a share 1 / r of it */
    double face;      /* the same in the L1 error of polygons, if noise were chance alone */
    uint64_t rays;    /* that told it */
};
#define RAD_PLACES_SHARE 0.1
#define RAD_PLACES_LEAST (1u << 15)

/* Measure that of the links, by about so many rays (0: RAD_PLACES_SHARE of what the solution has
 * cast, and no fewer than RAD_PLACES_LEAST). Links of l rays and an error^2 of e, and r rays of
 * particles, together have 1 / (1 / e + r / ray): engine/ray_split.c. The solution stays as it is.
 * places may be NULL. Returns 0, or -1. */
RAD_API int radMeasurePlaces(RadSolution solution, uint64_t rays, struct RadPlaces *places);

/* Mend the solution: add to each element what particles see of its error, level by level from the
 * root down, as far as it stands out of their noise (engine/mend.c). From then on elements,
 * polygons and pictures show mended values, B = E + rho H in all of them; links stay as they are,
 * and radStep goes on from what they say. Leaves of a linear solution on which many particles are
 * to land are quartered, and stay so where that tells more than the leaf's own slope does
 * (engine/detail.c): what radGetElements gave before is no longer valid. The mean of polygons above
 * a hundredth of the area that too few particles meet is told by paths from them, too, and where
 * these do not know it either by particles that are split where light, or light of a band, is dim:
 * by at most as many rays besides as mending would have taken without links and as links have
 * spared of these, and as many again where that makes surer what is known, within the most that
 * mending may take; and by what is left of 1.5 million in all.
 * Smaller polygons are told by paths, as far as some of these are left (engine/dim_faces.c). Where
 * paths from polygons tell them for less than half of the rays, they mend in place of particles,
 * and measure (engine/path_mending.c).
 * *alone, which may be NULL: the error of the links alone, by the same particles or paths; its rays
 * are what mending took. NULL options: the defaults. Returns 0, or -1. */
RAD_API int radCorrect(RadSolution solution, const struct RadCorrectOptions *options,
                       struct RadErrorReport *alone);

/* ---- which light links bring wrongly, and why */

/* How light came from one leaf to another, or would have had to. */
enum RadWay {
    RAD_WAY_NONE,   /* no link covers the two: they were given up as hidden, or as too dark */
    RAD_WAY_OPEN,   /* by a link between surfaces that was found all visible */
    RAD_WAY_HALF,   /* by one that was found visible in part */
    RAD_WAY_GROUPS, /* by one that has a cluster at an end */
    RAD_WAYS
};

/* What links bring less what rays find, part by part: for each leaf the parts add up. */
enum RadCauseKind {
    RAD_CAUSE_LOST, /* light that no link stands for */
    /* RAD_WAY_OPEN. bright: visibility goes with radiosity, so that the mean over the emitter is
     * not what is seen of it; kernel: the link's form factor, which is not exact; visibility: that
     * of the link, which is not what rays find; spread: the mean over the receiver, as the light
     * reaches parts of it from which it goes on better or worse: bright, the other way round. Over
     * a polygon it cancels, after more reflections it does not */
    RAD_CAUSE_OPEN_BRIGHT,
    RAD_CAUSE_OPEN_KERNEL,
    RAD_CAUSE_OPEN_VISIBILITY,
    RAD_CAUSE_OPEN_SPREAD,
    RAD_CAUSE_HALF_BRIGHT, /* RAD_WAY_HALF, the same */
    RAD_CAUSE_HALF_KERNEL,
    RAD_CAUSE_HALF_VISIBILITY,
    RAD_CAUSE_HALF_SPREAD,
    RAD_CAUSE_GROUPS_BRIGHT, /* RAD_WAY_GROUPS: the same, the mean over the whole group */
    RAD_CAUSE_GROUPS_REST,   /* the separable form factor and the one visibility of all pairs */
    RAD_CAUSE_GROUPS_SPREAD,
    RAD_CAUSE_ROW_CAP, /* what was done about row sums, cap or closure */
    RAD_CAUSE_CONTACT, /* how much of a leaf solids are taken to cover */
    RAD_CAUSE_SOLVER,  /* where iteration stopped */
    RAD_CAUSES
};

struct RadCausesOptions {
    uint64_t rays;   /* about so many; 0: RAD_CAUSES_RAYS. At most 2^32 */
    uint32_t stream; /* which random numbers */
};
#define RAD_CAUSES_RAYS (1u << 22)

/* Shares of the light that the links' solution reflects. */
struct RadCause {
    struct RadMeasure power; /* positive: the links bring too much */
    /* sum over polygons and bands of the modulus, as far as it stands out of the rays' noise; no
     * less than |power| */
    struct RadMeasure l1;
    /* what that comes to in the power of the solution, after all reflections; and the sum of the
     * modulus of what each polygon's error comes to */
    struct RadMeasure after, after_l1;
};

/* power and l1 are of one reflection: what the links make of their own radiosities, less what is
 * right for these. */
struct RadCausesReport {
    struct RadCause cause[RAD_CAUSES];
    /* measured by itself, without asking for links: B - E - rho B(where a ray ends). It is the sum
     * of all causes, in power and for each polygon */
    struct RadCause together;
    struct {
        double links, rays; /* reflected light that these links bring; that rays find to come so */
    } way[RAD_WAYS];
    /* light that the links' solution reflects, all bands (W); where it is none, that it should */
    double reflected;
    uint64_t rays;
    double seconds;
};
/* Find out what the links bring wrongly, by rays from points spread over the surfaces that reflect
 * in directions by the cosine: each meets a radiosity of the links' solution, and the link between
 * the two leaves tells by which way that should have come. Of the links alone, also when the
 * solution is mended; of constants (RAD_BASIS_CONSTANT). NULL options: the defaults. The same
 * figures for any number of threads. Progress is told of, phase "causes". Returns 0, or -1.
 * [engine/error_causes.c] */
RAD_API int radFindCauses(RadSolution solution, const struct RadCausesOptions *options,
                          struct RadCausesReport *report);

/* ---- light at points */

/* A point of a face, and how many rays gather light there. */
struct RadGatherPoint {
    uint32_t face;      /* of radGetSceneFaces */
    double position[3]; /* m, on the face; refused where the scene's size from it */
    /* Points of one set share one sequence of directions, spread evenly over all of them: this one
     * takes numbers first .. first + rays - 1, below 2^32. Sets of other numbers are independent */
    uint64_t set;
    uint32_t first, rays;
};

/* Gather the light that the solution, mended or not, sends to points: B = E + rho H per band
 * (W/m2), H from what of the solution each point sees, by `rays` rays from it, half of them towards
 * emitters that are brighter than the scene is in the mean; rays that end very near go on by two
 * more. What elements cannot hold, a shadow's edge within one, is resolved; the error of the
 * solution itself is left, reflected once. Noise falls as rays grow in number; where all is equally
 * bright there is none. radiosity: [point * bands + band], the caller's. On all threads, and the
 * same for any number of them; no progress is told: give it points in parts of some thousands.
 * After radSolve or radStep. Returns 0, or -1. [Reichert 1992; particles/gather.h] */
RAD_API int radGather(RadSolution solution, const struct RadGatherPoint *points, size_t count,
                      double *radiosity);

/* ---- the account of error, by cause */

/* [Arvo, Torrance and Smits 1994] What may be wrong with B, as a function over the surfaces. */
enum RadErrorCategory {
    RAD_CATEGORY_BOUNDARY,       /* E and rho are not quite those that were given */
    RAD_CATEGORY_DISCRETIZATION, /* B is taken for constant over each leaf, and over emitters */
    /* computation: */
    RAD_CATEGORY_FORM_FACTOR, /* quadrature */
    RAD_CATEGORY_VISIBILITY,  /* rays */
    RAD_CATEGORY_ROW_CAP,     /* what was done about row sums, cap or closure */
    RAD_CATEGORY_SOLVER,      /* where iteration stopped */
    RAD_CATEGORY_TOGETHER,    /* all, boundary data included */
    RAD_CATEGORIES
};

struct RadErrorNorms {
    double l1;   /* integral of the modulus, W, summed over bands */
    double l2;   /* root of the integral of the square, W/m2 m, summed over bands */
    double linf; /* largest modulus, W/m2 */
};

struct RadAccountOptions {
    double reflectance_error; /* each rho may be off by so much, absolute: 0.02 is two hundredths */
    double exitance_error;    /* each E may be off by so much of itself: 0.05 is five hundredths */
    int estimates_only;       /* 1: no bounds, which cost most; they are INFINITY then */
};

/* Estimates are what the links and a few points of each leaf make likely: discretization, form
 * factor and visibility before they are reflected on (signs differ, so that they cancel when they
 * are gathered again), the others after all reflections; together: as of independent causes, but
 * for discretization, cap and solver, whose signs are known and which mend each other, and no more
 * than the bound, where there is one. They cannot know of light that no link stands for, nor of
 * what links between groups lose.
 *
 * All are of one value per element. Of RAD_BASIS_LINEAR they are what the same links would leave
 * without slopes; radMeasureError knows slopes.
 *
 * Bounds hold for certain, after all reflections, for every point of every surface: proved by
 * ranges of form factors and by shafts, never by rays (engine/light_ranges.h). Discretization: were
 * the links' visibilities right; what form factors, cap and solver have done is in it. Visibility:
 * what knowing no more of it than is proved adds to that, point by point. Form factor, cap, solver:
 * of each by itself. Boundary: how far the true solution may move. Together: of all, less than the
 * sum. */
struct RadAccountReport {
    struct RadErrorNorms estimate[RAD_CATEGORIES], bound[RAD_CATEGORIES];
    struct RadErrorNorms reflected; /* norms of B - E: what the errors are shares of */
    /* norms of the operator K that was solved with, by the largest row and the largest column
     * (before the cap); columns NAN where groups are linked */
    double kappa_inf, kappa_1;
    double reflectance; /* the largest rho: bounds the norms of the true one */
    /* of the inverse of 1 - K by rows: 1 / (1 - kappa_inf), INFINITY where that says nothing; and
     * found by one more solve */
    double inverse_bound, inverse_found;
    double defect_mean, defect_most, blind_area; /* of rows before the cap: |1 - sum|; m2 */
    uint64_t guarded;                            /* links that a guard kept whole */
    /* 1: there are bounds. 0: none were asked for, or there are more ranges than fit */
    int bounded;
    int without_slopes; /* 1: the solution has slopes, which the account leaves out */
    uint64_t ranges;
    double visible; /* share of them, by what they carry, of which it is proved that nothing is
                       between */
    double closed;  /* share of the area that was proved to see surfaces alone */
    double seconds;
};

/* After radSolve or radStep. NULL options: E and rho are exact. Progress is told of, phase
 * "account"; cancelled by it, the solution stays good. Returns 0, or -1. */
RAD_API int radAccountErrors(RadSolution solution, const struct RadAccountOptions *options,
                             struct RadAccountReport *report);

/* ---- watching an oracle think: RAD_RELEASE_DAG only */

/* An answer that a node of the graph may give. Names are the oracle's. */
struct RadAnswer {
    int node_number, answer_number; /* from 0: nodes in topological order, the start first */
    const char *node, *tool, *doc;  /* doc: what the tool asks */
    const char *answer, *kind;      /* as in struct RadAnswerCount */
    const char *target;             /* node or decision */
};
/* Returns 0; -1: there is none of that number, or the oracle is no interpreted graph. */
RAD_API int radGetOracleAnswer(RadOracle oracle, int node, int answer, struct RadAnswer *out);
/* The answers on a way through the graph, at most `most` of them. Returns how many there are, or
 * -1: there is no such way. */
RAD_API int radGetOracleWay(RadOracle oracle, uint64_t way, struct RadAnswer *out, int most);

/* radAskOracle; *way gets the way that it took. Safe from many threads once radGetOracleWay has
 * been called: with no room for answers it only makes ready. */
RAD_API enum decision radAskOracleWay(RadOracle oracle, struct discussion *discussion,
                                      uint64_t *way);

/* One discussion of a refinement. */
struct RadTraced {
    int pass;       /* 1: before the first solve */
    uint64_t round; /* from 1, over all passes */
    /* elements, as they are numbered until the pass ends: then those that it has split off are
     * numbered anew, by what is split alone; element.id stays */
    uint32_t receiver, emitter;
    /* The pair as the oracle saw it, with what was known already. Good until the function returns;
     * a copy of it and of what it points to can be held again by radExplain */
    const struct discussion *before;
    enum decision decision;
    uint64_t way;  /* through the graph, for radGetOracleWay */
    uint32_t rays; /* that it cast */
    /* at its end; levels as the catalog counts them, 0: not known */
    double form_factor, visibility;
    unsigned char form_factor_level, visibility_level;
};
/* Called from the thread that called in, in the order of the pairs, which is the same for any
 * number of threads. Return 0 to go on, anything else to cancel. */
typedef int (*RadTraceFunction)(void *user, const struct RadTraced *traced);
/* Be told of every discussion from now on; NULL: no more. Before radRefine, radStep or radSolve.
 * Answers are not counted meanwhile (radCountOracle). Returns 0, or -1. */
RAD_API int radTraceSolution(RadSolution solution, RadTraceFunction function, void *user);

/* A value in the data manager. */
struct RadTerm {
    const char *name, *doc, *unit;
    const char *level;             /* "" of terms without levels; NULL: not known */
    int level_number, level_count; /* 1 the coarsest, level_count the most precise; 0: not known */
    int level_before;              /* of the node */
    int reads, writes;             /* by the catalog: the node, its arguments included */
    int changed;                   /* the node has changed it */
    int size;                      /* numbers in value */
    double value[3];
};
struct RadArgument {
    const char *name, *unit, *doc;
    double value;
    int computed; /* from this pair; else it is the same in all discussions */
};
/* A node that was asked. */
struct RadAsked {
    const char *node, *tool, *doc, *answer, *kind, *target; /* as in struct RadAnswer */
    const struct RadArgument *arguments;                    /* [argument_count] */
    int argument_count;
    const struct RadTerm *terms; /* [term_count]: those it reads, writes or has changed */
    int term_count;
    uint64_t rays;
    double seconds; /* the shortest of some times that it was asked */
};
struct RadExplanation {
    const struct RadAsked *asked; /* [asked_count], the start first */
    int asked_count;
    enum decision decision;
    const char *decision_name, *decision_doc;
    uint64_t way, rays;
    double seconds;              /* sum over the nodes */
    const struct RadTerm *terms; /* [term_count]: what is known at the end */
    int term_count;
};
/* Hold a discussion, node by node, by any interpreted oracle: that of the solution or another. Its
 * elements, terms, list and the numbers of its host are those of `before`, rays and shafts are of
 * the solution's scene; what clusters hold is looked at as it is now. Nothing is changed. The
 * explanation is good until the next call with this oracle. Returns 0, or -1. */
RAD_API int radExplain(RadSolution solution, RadOracle oracle, const struct discussion *before,
                       struct RadExplanation *explanation);

/* Elements by their ways down the tree. "12": polygon 12, where it is one face; "12.0", "12.1": the
 * faces that it became; "12b": the far side of a two-sided one; "12/0/3": of its part 0 the part 3;
 * "root", "root/1": clusters. Of a scene that is grouped in the same way a name means the same
 * place in every run. */
enum { RAD_NAME = 256 }; /* room for any name */
RAD_API int radGetElementName(RadSolution solution, uint32_t element, char name[RAD_NAME]);
/* Returns 0, or -1 with a message that says what there is. */
RAD_API int radFindElement(RadSolution solution, const char *name, uint32_t *element);
/* The face that is nearest to a point (m), of two-sided ones the front; of faces at the same
 * distance the first. Returns 0, or -1. */
RAD_API int radFindFaceAt(RadSolution solution, const double point[3], uint32_t *element);

/* ---- exchange areas */

/* Long work, put down and gone on with another day. What goes on from a state ends with the same
 * bits as what was never put down, on any number of threads. A state is of one scene, oracle,
 * tolerance, `rows` and `stream` (closure and `keep` may be others), of this version of the library
 * and of machines with this one's order of bytes. It takes about 8 bytes per pair of polygons in
 * half shadow, 16 per link, and as much again while it is kept in a file that is replaced; no
 * memory. Answers that an oracle counts are those of the last run alone. All functions are called
 * from the calling thread and may not call this library's with handles of the same device. Of
 * several ranks (radNewDeviceMPI) rank 0's are called, the others' may be NULL; the state is the
 * same, and passes between any numbers of them. */
enum RadStateWish {
    RAD_STATE_NONE, /* go on */
    RAD_STATE_SAVE, /* write the state, and go on */
    RAD_STATE_STOP  /* write it, and fail with RAD_ERROR_CANCELLED */
};
struct RadExchangeState {
    /* The next `size` bytes, 1 or more, of the state to go on from. Returns how many there were:
     * fewer at its end. NULL: there is none, begin. One that is damaged, cut short, or not of this
     * work is refused with RAD_ERROR_INVALID_ARGUMENT; the message says why, as in "it is damaged".
     */
    size_t (*read)(void *user, void *bytes, size_t size);
    /* Asked wherever the work can be put down: between rounds of refinement, about every half
     * second while values are computed, and once when all are. NULL: nobody wants one. */
    enum RadStateWish (*asked)(void *user);
    /* The next bytes of the state that was asked for; (NULL, 0) behind the last of them. Return 0,
     * or anything else to have no more of it. Where it is not called with NULL, there is no whole
     * state. NULL: nothing is written. */
    int (*write)(void *user, const void *bytes, size_t size);
    void *user;
};

struct RadExchangeOptions {
    /* error to work for; 0: 3e-4. Of a row's sum; and of entries, as a share of the entry, or,
     * where that is smaller, of 1e-4 (in half shadow in scenes of more than 24 polygons: of four
     * over the root of the number of faces that they are cut into) */
    double tolerance;
    enum RadClosure closure;
    /* only the first so many rows are asked for, as of a scene whose other polygons are copies; the
     * report is of them. 0: all */
    uint32_t rows;
    /* 1: no matrix is kept, memory is that of polygons and links: products can be asked for, rows
     * cannot, closure is none or rows, and rows that do not add up are not looked at again */
    int stream;
    /* bytes: what groups of polygons in clear view of each other exchange is kept as far as that
     * goes, and beyond it computed anew for each row and product, to the same bits. 0: 512 MiB */
    size_t keep;
    const struct RadExchangeState *state; /* NULL: it is done in one go. Borrowed for the call */
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
 * row[RadSceneReport.polygons], the caller's. Of faces that see all of each other it is good to
 * 1e-8. Safe from many threads at once. Returns its sum, or -1. Of a stream, and beyond the rows
 * asked for, there is none. */
RAD_API double radGetExchangeRow(RadExchange exchange, uint32_t i, double *row);

/* Shares of what polygon i sends that meet no front: what leaves the scene, what meets the black
 * backs of one-sided polygons, what comes from parts that others stand on. With the sum of row i
 * they make 1 where there is such a loss; 0 where the row lacks less than the tolerance and nobody
 * asked. Returns 0, or -1. */
struct RadExchangeLoss {
    double sky, backs, covered;
};
RAD_API int radGetExchangeLoss(RadExchange exchange, uint32_t i, struct RadExchangeLoss *loss);

/* y = F x, after closure: x[polygons][columns], y[rows][columns], the caller's. Of a stream, what
 * pairs exchange is computed anew. Returns 0, or -1. */
RAD_API int radMultiplyExchange(RadExchange exchange, uint32_t columns, const double *x, double *y);

struct RadExchangeReport {
    uint64_t links, pairs, rays;
    double low, high; /* of all rows' sums, before closure; 0 without rows that have area */
    /* that ought to sum to 1; see the environment; a black back; are covered in part (some are of
     * several of the last three) */
    uint32_t rows_closed, rows_open, rows_backs, rows_covered;
    double defect_most, defect_mean; /* |1 - sum| of the closed ones, before closure */
    double worst;                    /* the same, and what others have above 1; of which row */
    uint32_t worst_row;
    /* what goes to the environment and to backs: the most of a row, and the mean over all area */
    double environment_most, environment_mean, backs_most, backs_mean;
    /* largest |factor - 1| that a view factor took; largest |1 - sum| left */
    double closure_change, closure_left;
    struct {
        double refine, fill;
    } seconds;
    double entry_error; /* the largest estimated of any F_ij in half shadow, before closure */
};
RAD_API void radGetExchangeReport(RadExchange exchange, struct RadExchangeReport *report);

/* What points with normals, such as sensors, see, what stands between included: by cuts, nothing
 * sampled. position[3 * count] in m, normal[3 * count], not 0. row[count * (polygons + 2)], the
 * caller's: of each point the share of what meets it, if all were equally bright, that comes from
 * each polygon, then that from outside the scene, then that which black backs keep away; in all 1.
 * A polygon that the point lies on is not seen and hides nothing. Needs a committed scene, no
 * exchange. Returns 0, or -1. */
RAD_API int radGetPointFactors(RadScene scene, uint32_t count, const double *position,
                               const double *normal, double *row);

/* ---- references */

/* Two ways of which neither knows of links, elements or form factors: particles from the emitters,
 * which survive with the reflectance and are counted where they land, and paths from points spread
 * over the polygons, which look for emitters at each turn [Pattanaik and Mudur 1992; Veach and
 * Guibas 1995]. Both are right in the mean, and their noise is known. BOTH weights them by it. */
enum RadMethod { RAD_METHOD_PARTICLES, RAD_METHOD_PATHS, RAD_METHOD_BOTH, RAD_METHODS };

/* Of a committed scene, nothing traced yet. Returns NULL on error. */
RAD_API RadReference radNewReference(RadScene scene);
RAD_API void radRetainReference(RadReference reference);
RAD_API void radReleaseReference(RadReference reference);

/* Trace on by PARTICLES or PATHS until there are `count` in all, or a few more: particles come in
 * sixteen sets, and a polygon that reflects has 64 paths at least. Nothing where there are as many.
 * The same bits for any number of threads, and, in the same calls, whether it was saved and loaded
 * between them or not. Progress tells as `waiting` the thousandths of the call that are left.
 * Returns 0, or -1. */
RAD_API int radTraceReference(RadReference reference, enum RadMethod method, uint64_t count);

/* Area means of B over each polygon, both sides of two-sided ones, in one band, and one standard
 * error of each (W/m2), INFINITY where the method has traced nothing; [RadSceneReport.polygons],
 * the caller's; either may be NULL. 0 of polygons without area. Returns 0, or -1. */
RAD_API int radGetReferenceValues(RadReference reference, enum RadMethod method, uint32_t band,
                                  double *radiosity, double *deviation);

/* Hold a solution of the same scene, mended or not, against the particles of a reference, as
 * radMeasureError does against particles of its own: power, l1_faces, noise, reflected, unseen,
 * bands, worst, worst_share and worst_sure; rays are those of the reference. What
 * radGetPolygonErrors tells stays. Many solutions are best judged by one reference: its noise is
 * the same for all. Returns 0, or -1. */
RAD_API int radMeasureErrorBy(RadSolution solution, RadReference reference,
                              struct RadErrorReport *report);

struct RadReferenceReport {
    uint64_t traced[2], rays[2]; /* particles, paths, and the rays for them */
    double emitted, reflected;   /* W, all bands; reflected by both */
    /* where nothing was seen to be reflected: no more than that is (W, 95 %); 0: nothing is */
    double unseen;
    /* standard errors of B, mean by area, as shares of the reflected light: by particles, by paths,
     * by both; 0 where nothing is reflected, INFINITY where nothing is known: not traced, or unseen
     * above 0 */
    double noise[RAD_METHODS];
    /* light reflected by particles less by paths, and one standard error of that, as shares; 0 and
     * INFINITY unless both are traced */
    double difference, deviation;
    /* squares of their differences over those expected, mean over polygons and bands that both
     * know well: about 1 where only chance parts them; from so many */
    double chi_square;
    uint64_t compared;
};
/* Returns 0, or -1. */
RAD_API int radGetReferenceReport(RadReference reference, struct RadReferenceReport *report);

/* All that has been traced, to go on with another day. Returns how many bytes it takes; writes them
 * where there is room for `size`. For this machine's order of bytes and this library's version. */
RAD_API size_t radSaveReference(RadReference reference, void *bytes, size_t size);
/* Back to what was saved of the same scene, byte for byte. Returns 0, or -1: it is of another
 * scene, or damaged, and nothing has changed. */
RAD_API int radLoadReference(RadReference reference, const void *bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
