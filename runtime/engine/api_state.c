/* api_state.c - solutions put down between two passes, and gone on with.
 * SPDX-License-Identifier: MIT */
#include "engine/api.h"

int radGetSolutionState(RadSolution solution, struct RadStatePart part[RAD_STATE_PARTS])
{
    const char *cause;
    if (api_not_dead(solution) < 0
        || api_needs(solution->scene->device, part, "radGetSolutionState needs a place") < 0)
        return -1;
    RadDevice device = solution->scene->device;
    if (!solution->solve.refinement.hierarchy || solution->done)
        return api_fail(device, RAD_ERROR_INVALID_OPERATION,
                        "a solution has a state between two passes: after radRefine or a radStep "
                        "that says that there is more to do");
    const char *refusal = solve_state_refusal(&solution->solve);
    if (refusal)
        return api_fail(device, RAD_ERROR_UNSUPPORTED, "%s", refusal);
    if (solve_state_make(&solution->state, &solution->solve, part, &cause) < 0)
        return api_fail(device, api_cause(cause), "%s", cause);
    return 0;
}

int radSetSolutionState(RadSolution solution, const struct RadStatePart part[RAD_STATE_PARTS])
{
    const char *cause;
    int refused;
    if (api_not_dead(solution) < 0
        || api_needs(solution->scene->device, part, "radSetSolutionState needs a state") < 0)
        return -1;
    RadDevice device = solution->scene->device;
    if (solution->solve.refinement.hierarchy)
        return api_fail(device, RAD_ERROR_INVALID_OPERATION,
                        "radSetSolutionState is for a new solution, before radRefine");
    if (solve_state_take(&solution->solve, solution->oracle->refiner, part, &refused, &cause) == 0)
        return 0;
    solution->dead = 1;
    return api_fail(device, refused ? RAD_ERROR_INVALID_ARGUMENT : api_cause(cause), "%s", cause);
}

static int call_between(void *context)
{
    RadSolution solution = context;
    const int stop = solution->between(solution->between_user, solution);
    solve_state_free(&solution->state);
    solution->between_stopped = stop != 0;
    return stop;
}

void radSetSolutionPassFunction(RadSolution solution, RadPassFunction function, void *user)
{
    if (!solution)
        return;
    solution->between = function;
    solution->between_user = user;
    solution->solve.between = function ? call_between : NULL;
    solution->solve.between_context = solution;
}
