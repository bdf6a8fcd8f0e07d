/* allowance.c - error control: the solver tells the oracle how large the error of one link may be at each receiver.
 *
 * A link's share in the error of a radiosity depends on how many others there are and on their signs, so no threshold
 * per link holds an error eps. So the allowance of every face starts at (1 - rho) eps, for what reflection makes of
 * a local error is at most 1 / (1 - rho) of it; after each solve the error of each leaf is estimated (defect.c); where it is
 * above eps the leaf's allowance is divided by 1.4, an element's is the least of its children's, and the links
 * are discussed again: until no estimate is above eps, or nothing can be split.
 *
 * A leaf is given up, and reported, when the links that a guard kept whole are above eps by themselves, as beside
 * an edge that elements share, where F has all values from 0 to 1/2 at every size: lowering its allowance, and with it
 * its ancestors', would split everything else without end. Or when allowance times links is far below eps: then all
 * links together are within eps by the oracle's own measure, and what is left is none that it knows.
 * Unreliable in half shadow, as its estimate is. [Bekaert and Willems 1996; the end: derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/error_control.h"
#include "engine/residual.h"

#define STEP 1.4
#define ENOUGH 0.25 /* of eps: the most that all links of a leaf may bring together before it is given up */

static double parameter(const struct refiner *r, enum catalog_role role)
{
    int i = refiner_find_role(r, role, -1);
    return i < 0 ? 0 : refiner_get(r, i);
}

double allowance_target(const struct refiner *r, const struct host *host)
{
    double absolute = parameter(r, ROLE_ERROR_TOLERANCE);
    double relative = parameter(r, ROLE_RELATIVE_ERROR_TOLERANCE) * host->radiosity;
    return refiner_reads(r, FACT_RECEIVER_ALLOWANCE) ? absolute > relative ? absolute : relative : 0;
}

/* The least of the children's, bottom up, where that is less than what is there. */
static void lift(struct solve *s)
{
    struct element *elements = s->hierarchy.elements;
    uint32_t i;
    int c;
    for (i = s->hierarchy.count; i-- > 0;) /* children follow their parents */
        for (c = 0; c < elements[i].children; c++) {
            const struct element *child = &elements[elements[i].child + (uint32_t)c];
            if (!(child->allowance < elements[i].allowance))
                continue;
            elements[i].allowance = child->allowance;
            s->changed[i] = 1;
        }
}

void allowance_start(struct solve *s, double target)
{
    uint32_t i;
    s->allowance.target = target;
    for (i = 0; i < s->scene->face_count; i++) {
        struct element *e = &s->hierarchy.elements[s->hierarchy.face_element[i]];
        e->allowance = (1 - e->reflectance) * target;
    }
    lift(s);
}

int allowance_estimate(struct solve *s)
{
    struct allowance *a = &s->allowance;
    const struct element *elements = s->hierarchy.elements;
    uint32_t i;
    if (s->hierarchy.count > a->room) {
        size_t room = (size_t)s->hierarchy.count + s->hierarchy.count / 4;
        struct defect *moved = realloc(a->defect, room * sizeof *moved);
        if (!moved)
            return -1;
        a->defect = moved;
        a->room = (uint32_t)(room > UINT32_MAX ? UINT32_MAX : room);
    }
#pragma omp parallel for schedule(dynamic, 16) num_threads(s->options.threads)
    for (i = 0; i < s->hierarchy.count; i++)
        if (elements[i].vertices && !elements[i].children)
            a->defect[i] = defect_leaf(s, i);
    a->largest = a->area = 0;
    for (i = 0; i < s->hierarchy.count; i++) {
        if (!elements[i].vertices || elements[i].children || !(s->exposed[i] > 0))
            continue;
        a->largest = a->defect[i].all > a->largest ? a->defect[i].all : a->largest;
        a->area += a->defect[i].all > a->target ? elements[i].area : 0;
    }
    return 0;
}

uint32_t allowance_lower(struct solve *s)
{
    struct allowance *a = &s->allowance;
    struct element *elements = s->hierarchy.elements;
    uint32_t i, lowered = 0;
    for (i = 0; i < s->hierarchy.count; i++) {
        if (!elements[i].vertices || elements[i].children || !(s->exposed[i] > 0) || !(a->defect[i].all > a->target)
            || a->defect[i].guarded > a->target || elements[i].allowance * a->defect[i].links < ENOUGH * a->target)
            continue;
        elements[i].allowance *= 1 / STEP;
        s->changed[i] = 1;
        lowered++;
    }
    if (lowered)
        lift(s);
    return lowered;
}

void allowance_free(struct solve *s)
{
    free(s->allowance.defect);
}
