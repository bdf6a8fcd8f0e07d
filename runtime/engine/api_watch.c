/* api_watch.c - watching an oracle think: who is told, which way a discussion took, and what it
 * saw.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "geometry.h"
#include "engine/api.h"
#include "engine/element_names.h"
#include "oracle/follow.h"

/* Can ways through the oracle be told? Returns 0, or -1 after an error. */
static int follow(RadOracle oracle)
{
    struct messages messages = {0};
    int status = follow_open(oracle->refiner, &messages);
    if (status < 0)
        api_fail(oracle->device,
                 messages.cause == MESSAGE_MEMORY ? RAD_ERROR_OUT_OF_MEMORY
                                                  : RAD_ERROR_INVALID_OPERATION,
                 "%s", messages_text(&messages));
    messages_free(&messages);
    return status;
}

int radGetOracleAnswer(RadOracle oracle, int node, int answer, struct RadAnswer *out)
{
    return oracle && out && follow(oracle) == 0 ? follow_answer(out, oracle->refiner, node, answer)
                                                : -1;
}

int radGetOracleWay(RadOracle oracle, uint64_t way, struct RadAnswer *out, int most)
{
    return oracle && (out || most <= 0) && follow(oracle) == 0
               ? follow_way(out, most, oracle->refiner, way)
               : -1;
}

enum decision radAskOracleWay(RadOracle oracle, struct discussion *discussion, uint64_t *way)
{
    return oracle && discussion && way && follow(oracle) == 0
               ? follow_ask(oracle->refiner, discussion, way)
               : DECISION_STOP;
}

int radTraceSolution(RadSolution solution, RadTraceFunction function, void *user)
{
    if (api_not_dead(solution) < 0 || (function && follow(solution->oracle) < 0)
        || (function && api_alone(solution->scene->device, "a trace") < 0))
        return -1;
    struct trace *t = &solution->trace;
    if (function && !t->pairs && !(t->pairs = malloc(REFINEMENT_ROUND * sizeof *t->pairs)))
        return api_fail(solution->scene->device, RAD_ERROR_OUT_OF_MEMORY,
                        "out of memory for a trace");
    t->tell = function;
    t->user = user;
    solution->solve.trace = function ? t : NULL;
    return 0;
}

int radExplain(RadSolution solution, RadOracle oracle, const struct discussion *before,
               struct RadExplanation *explanation)
{
    if (api_not_dead(solution) < 0)
        return -1;
    RadDevice device = solution->scene->device;
    if (api_needs(device, oracle, "radExplain needs an oracle") < 0
        || api_needs(device, before, "radExplain needs a discussion") < 0
        || api_needs(device, before->receiver, "radExplain needs the discussion's receiver") < 0
        || api_needs(device, before->emitter, "radExplain needs the discussion's emitter") < 0
        || api_needs(device, before->host, "radExplain needs the discussion's host") < 0
        || api_needs(device, explanation, "radExplain needs a place") < 0 || follow(oracle) < 0)
        return -1;
    if (explain(&oracle->explained, oracle->refiner, before,
                rays_host(solution->solve.problem.rays))
        < 0)
        return api_fail(oracle->device, RAD_ERROR_OUT_OF_MEMORY, "out of memory to explain");
    *explanation = oracle->explained.shown;
    return 0;
}

/* ---- elements by name */

static int number_parts(RadSolution solution)
{
    const struct hierarchy *h = &solution->solve.hierarchy;
    if (!solution->part)
        solution->part = element_names_parts(h->faces, h->face_count);
    return solution->part ? 0
                          : api_fail(solution->scene->device, RAD_ERROR_OUT_OF_MEMORY,
                                     "out of memory for the names of elements");
}

/* Returns 0, or -1 after an error. */
static int check_element(RadSolution solution, uint32_t element)
{
    const uint32_t count = solution->solve.hierarchy.count;
    return element < count ? 0
                           : api_fail(solution->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                                      "there is no element %u; there are %u, from 0",
                                      (unsigned)element, (unsigned)count);
}

int radGetElementName(RadSolution solution, uint32_t element, char name[RAD_NAME])
{
    if (api_not_dead(solution) < 0
        || api_needs(solution->scene->device, name, "radGetElementName needs a place") < 0
        || check_element(solution, element) < 0 || number_parts(solution) < 0)
        return -1;
    if (element_name(name, RAD_NAME, &solution->solve.hierarchy, solution->part, element) == 0)
        return 0;
    return api_fail(solution->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                    "element %u lies too deep in the tree to have a name", (unsigned)element);
}

int radFindElement(RadSolution solution, const char *name, uint32_t *element)
{
    char cause[RAD_NAME + 160];
    if (api_not_dead(solution) < 0
        || api_needs(solution->scene->device, name, "radFindElement needs a name") < 0
        || api_needs(solution->scene->device, element, "radFindElement needs a place") < 0
        || number_parts(solution) < 0)
        return -1;
    if (element_find(element, &solution->solve.hierarchy, solution->part, name, cause, sizeof cause)
        == 0)
        return 0;
    return api_fail(solution->scene->device, RAD_ERROR_INVALID_ARGUMENT, "%s", cause);
}

int radFindFaceAt(RadSolution solution, const double point[3], uint32_t *element)
{
    if (api_not_dead(solution) < 0
        || api_needs(solution->scene->device, point, "radFindFaceAt needs a point") < 0
        || api_needs(solution->scene->device, element, "radFindFaceAt needs a place") < 0)
        return -1;
    const struct hierarchy *h = &solution->solve.hierarchy;
    double nearest = INFINITY;
    if (!api_place(point))
        return api_fail(solution->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "the point is not finite, or beyond 3.4e38");
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct element *e = hierarchy_surface(h, i);
        const double d = h->faces[i].back
                             ? (double)INFINITY
                             : polygon_distance(point, e->vertex, e->vertices, e->normal);
        if (d < nearest) {
            nearest = d;
            *element = h->face_element[i];
        }
    }
    return isfinite(nearest) ? 0
                             : api_fail(solution->scene->device, RAD_ERROR_INVALID_OPERATION,
                                        "the scene has no faces");
}
