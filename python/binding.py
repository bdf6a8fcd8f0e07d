"""binding.py - the functions and structs of radiosity.h that the package uses, for cffi to compile.

The compiler holds every line against the header: a struct that ends in `...` may have more members, of other
types or in another order it cannot be. So a header that has changed is an error when the package is built, never
a wrong number. cffi gives up the interpreter's lock during each call.
SPDX-License-Identifier: MIT
"""
import os
import subprocess

from cffi import FFI

BUILD = os.environ.get("BUILD", "build")

DECLARATIONS = """
static char *const RADIOSITY_VERSION;
typedef struct RadDeviceObject *RadDevice;
typedef struct RadSceneObject *RadScene;
typedef struct RadOracleObject *RadOracle;
typedef struct RadSolutionObject *RadSolution;
typedef struct RadExchangeObject *RadExchange;

enum RadError { RAD_ERROR_NONE, RAD_ERROR_INVALID_ARGUMENT, RAD_ERROR_INVALID_OPERATION,
                RAD_ERROR_INVALID_SCENE, RAD_ERROR_INVALID_ORACLE, RAD_ERROR_OUT_OF_MEMORY,
                RAD_ERROR_UNSUPPORTED, RAD_ERROR_CANCELLED, RAD_ERROR_LIMIT, ... };
enum RadClosure { RAD_CLOSURE_NONE, RAD_CLOSURE_ROWS, RAD_CLOSURE_RECIPROCAL, ... };
enum RadRelease { RAD_RELEASE_FLAT, RAD_RELEASE_DAG, ... };
enum RadBasis { RAD_BASIS_CONSTANT, RAD_BASIS_LINEAR, ... };

struct RadDeviceOptions { int threads; ...; };
RadDevice radNewDevice(const struct RadDeviceOptions *options);
void radReleaseDevice(RadDevice device);
enum RadError radGetDeviceError(RadDevice device);
const char *radGetDeviceErrorMessage(RadDevice device);

struct RadProgress { const char *phase; int pass; uint64_t rounds, pairs, waiting, links, rays;
                     double residual, share; ...; };
typedef int (*RadProgressFunction)(void *user, const struct RadProgress *progress);
void radSetDeviceProgressFunction(RadDevice device, RadProgressFunction function, void *user);

struct RadMaterial { double reflectance[3]; double exitance[3]; int two_sided; ...; };
struct RadPolygons { const double *positions; size_t position_count; const uint32_t *indices;
                     const uint32_t *sizes; uint32_t size; const uint32_t *materials;
                     uint32_t count; int single_precision; ...; };
RadScene radNewScene(RadDevice device);
void radReleaseScene(RadScene scene);
int radSetSceneMaterials(RadScene scene, const struct RadMaterial *materials, uint32_t count);
int radSetSceneSharedPolygons(RadScene scene, const struct RadPolygons *polygons);
int radCommitScene(RadScene scene);
struct RadSceneReport { uint32_t polygons, dropped, crossing, cut, parts, overlaps;
                        double overlap_area; uint32_t faces, materials, bands; double area;
                        double low[3], high[3]; ...; };
int radGetSceneReport(RadScene scene, struct RadSceneReport *report);
const double *radGetScenePolygonAreas(RadScene scene);

const char *const *radGetOracleNames(void);
const char *radGetDefaultOracle(void);
RadOracle radNewOracle(RadDevice device, const char *name, enum RadRelease release);
RadOracle radLoadOracle(RadDevice device, const char *path, const char *oracle,
                        enum RadRelease release);
void radReleaseOracle(RadOracle oracle);
int radSetOracleParameter(RadOracle oracle, const char *name, double value);

struct RadSolveOptions { double tolerance; int iterations; enum RadClosure closure;
                         enum RadBasis basis; ...; };
RadSolution radNewSolution(RadScene scene, RadOracle oracle, const struct RadSolveOptions *options);
void radReleaseSolution(RadSolution solution);
int radSolve(RadSolution solution);
struct RadChoice { double scale; int no_links; uint64_t rays; double seconds; };
struct RadChoiceOptions { int keep_links; ...; };
RadSolution radSolveScene(RadScene scene, RadOracle oracle, const struct RadSolveOptions *options,
                          const struct RadChoiceOptions *wishes, struct RadChoice *choice);
int radGetPolygonValues(RadSolution solution, uint32_t band, double *radiosity,
                        double *irradiance);
struct RadReport { uint32_t elements, leaves, bands; uint64_t links, pairs, rounds, rays;
                   int passes, iterations, converged; double residual, emitted, absorbed; ...; };
void radGetReport(RadSolution solution, struct RadReport *report);

struct RadMeasure { double value, low, high; };
struct RadMeasureOptions { uint64_t rays; uint32_t stream; int surfaces; ...; };
struct RadErrorReport { struct RadMeasure power, l1_faces, l2, p999, noise; double reflected, unseen;
                        uint32_t worst; double worst_share, worst_sure; uint64_t rays, particles;
                        double seconds; ...; };
int radMeasureError(RadSolution solution, const struct RadMeasureOptions *options,
                    struct RadErrorReport *report);
int radGetPolygonErrors(RadSolution solution, uint32_t band, double *error, double *deviation);
struct RadCorrectOptions { double noise; uint64_t rays; ...; };
int radCorrect(RadSolution solution, const struct RadCorrectOptions *options,
               struct RadErrorReport *alone);

enum RadStateWish { RAD_STATE_NONE, RAD_STATE_SAVE, RAD_STATE_STOP, ... };
struct RadExchangeState { size_t (*read)(void *user, void *bytes, size_t size);
                          enum RadStateWish (*asked)(void *user);
                          int (*write)(void *user, const void *bytes, size_t size);
                          void *user; ...; };
struct RadExchangeOptions { double tolerance; enum RadClosure closure;
                            const struct RadExchangeState *state; ...; };
RadExchange radNewExchange(RadScene scene, RadOracle oracle,
                           const struct RadExchangeOptions *options);
void radReleaseExchange(RadExchange exchange);
double radGetExchangeRow(RadExchange exchange, uint32_t i, double *row);
struct RadExchangeReport { uint64_t links, pairs, rays; double low, high;
                           uint32_t rows_closed, rows_open, rows_backs, rows_covered;
                           double defect_most, defect_mean, worst; uint32_t worst_row;
                           double environment_most, environment_mean, backs_most, backs_mean,
                                  closure_change, closure_left;
                           struct { double refine, fill; } seconds; double entry_error; };
void radGetExchangeReport(RadExchange exchange, struct RadExchangeReport *report);

extern "Python" int radiosity_progress(void *, const struct RadProgress *);
extern "Python" size_t radiosity_state_read(void *, void *, size_t);
extern "Python" enum RadStateWish radiosity_state_asked(void *);
extern "Python" int radiosity_state_write(void *, const void *, size_t);
"""


def engine_libraries():
    """What the archive is linked with: ENGINE_LIBS of the Makefile."""
    compiler = ["CC=" + os.environ["CC"]] if os.environ.get("CC") else []
    command = ["make", "-s", "--no-print-directory", "BUILD=" + BUILD, *compiler, "engine-libraries"]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.split()


binding = FFI()
binding.cdef(DECLARATIONS)
binding.set_source(
    "radiosity._engine",
    "#include <radiosity.h>\n",
    include_dirs=["runtime", os.path.join(BUILD, "gen")],
    extra_objects=[os.path.join(BUILD, "libradiosity.a")],
    depends=["runtime/radiosity.h", os.path.join(BUILD, "libradiosity.a")],
    extra_link_args=engine_libraries(),
)
