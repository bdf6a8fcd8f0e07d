/* stability_methods.c - the columns of the failure table.
 * SPDX-License-Identifier: MIT */
#include "stability.h"

const struct stability_method stability_methods[METHODS] = {
    [KERNEL] = { "1/r2", "F = cos cos A / (pi d2) between the centres", BY_FACTOR, FACTOR_KERNEL, NULL, { NULL } },
    [CULLED] = { "culled", "the same, and 0 below 1e-6 per square metre (rpkCpp)", BY_FACTOR, FACTOR_CULLED, NULL, { NULL } },
    [DISC] = { "disc", "F = cos cos A / (pi d2 + A) between the centres [Hanrahan 91]", BY_FACTOR, FACTOR_DISC, NULL, { NULL } },
    [POINT] = { "point", "Lambert's polygon from the receiver's centre", BY_FACTOR, FACTOR_POINT, NULL, { NULL } },
    [POLYGON] = { "polygon", "the level that links carry", BY_FACTOR, FACTOR_POLYGON, NULL, { NULL } },
    [CONTOUR] = { "contour", "the finest level, the contour integral", BY_FACTOR, FACTOR_CONTOUR, NULL, { NULL } },
    [FRONTS] = { "fronts", "64 rays that only fronts of faces stop (rpkCpp)", BY_RAYS, 0, NULL, { NULL } },
    [FIXED_EPSILON] = { "fixed eps", "64 rays in single precision that ignore hits within .1 mm", BY_RAYS, -1, NULL, { NULL } },
    [RAYS_4] = { "4 rays", "visibility by 4 rays per pair", BY_RAYS, 4, NULL, { NULL } },
    [RAYS_16] = { "16 rays", "visibility by 16 rays per pair", BY_RAYS, 16, NULL, { NULL } },
    [RAYS_64] = { "64 rays", "visibility by 64 rays per pair", BY_RAYS, 64, NULL, { NULL } },
    [NORMALISED] = { "normalise", "every row of form factors divided by its sum", BY_RULE, 0, NULL, { NULL } },
    [JACOBI] = { "100 sweeps", "Jacobi's method, 100 sweeps", BY_RULE, 0, NULL, { NULL } },
    [NAIVE_STOP] = { "stop at dB", "sweeps until B changes by less than the tolerance", BY_RULE, 0, NULL, { NULL } },
    [ONE_PLANE] = { "one plane", "a quad taken for flat whatever its corners", BY_RULE, 0, NULL, { NULL } },
    [KEPT] = { "kept", "a face without area kept", BY_RULE, 0, NULL, { NULL } },
    [L2_NORM] = { "L2", "the error's square norm over the receiver", BY_RULE, 2, NULL, { NULL } },
    [LINF_NORM] = { "Linf", "the largest error on the receiver", BY_RULE, 0, NULL, { NULL } },
    [UMBRA] = { "feature", "whether the shadow's core is darker than half (a feature-based measure)", BY_RULE, 0, NULL, { NULL } },
    [BF_1991] = { "BF of 1991", "bf with an absolute threshold", BY_ORACLE, 0, "bf", { "relative=0", "epsilon=0.02", NULL } },
    [BF_NODES] = { "BF, A min", "bf with an absolute smallest area", BY_ORACLE, 0, "bf", { "min_share=0", "min_area=0.001", NULL } },
    [BF] = { "bf", "bf", BY_ORACLE, 0, "bf", { NULL } },
    [VIEWFACTORS] = { "viewfactors", "viewfactors, the oracle of `radiosity viewfactors`", BY_ORACLE, 0, "viewfactors", { NULL } },
    [BF_GUARDED] = { "bf_guarded", "bf_guarded, the default", BY_ORACLE, 0, "bf_guarded", { NULL } },
};
