/* light_tree.c - see light_tree.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "geometry.h"
#include "particles/light_tree.h"

/* The sphere around two spheres. */
static void join_spheres(struct light_node *node, const struct light_node *a,
                         const struct light_node *b)
{
    double way[3];
    sub3(way, b->centre, a->centre);
    double distance = length3(way);
    const struct light_node *large = a->radius >= b->radius ? a : b;
    if (distance + fmin(a->radius, b->radius) <= large->radius) {
        memcpy(node->centre, large->centre, sizeof node->centre);
        node->radius = large->radius;
        return;
    }
    node->radius = 0.5 * (distance + a->radius + b->radius);
    for (int k = 0; k < 3; k++)
        node->centre[k] = a->centre[k] + way[k] * (node->radius - a->radius) / distance;
}

/* The cosine of a cone around `axis` that holds a child's. */
static double reach(const double axis[3], const struct light_node *child)
{
    double c = fmin(dot3(axis, child->axis), 1);
    if (child->along <= 0)
        return -1;
    double sine = sqrt(fmax(1 - c * c, 0)), along = c * child->along - sine * child->across;
    return c > 0 ? along : -1;
}

static void join(struct light_node *node, const struct light_node *a, const struct light_node *b)
{
    join_spheres(node, a, b);
    node->power = a->power + b->power;
    for (int k = 0; k < 3; k++)
        node->axis[k] = a->power * a->axis[k] + b->power * b->axis[k];
    double size = length3(node->axis);
    node->along = -1;
    node->across = 0;
    if (!(size > 0))
        return;
    for (int k = 0; k < 3; k++)
        node->axis[k] /= size;
    node->along = fmin(reach(node->axis, a), reach(node->axis, b));
    node->across = sqrt(fmax(1 - node->along * node->along, 0));
}

static uint32_t first_half(uint32_t count)
{
    return count / 2;
}

/* An emitter, and where its centre is along an axis (m). */
struct emitter {
    double along;
    uint32_t face;
};

static int is_before(const struct emitter *a, const struct emitter *b)
{
    return a->along != b->along ? a->along < b->along : a->face < b->face;
}

/* The `half` least of them to the front. [Hoare 1961, Algorithm 65: find] */
static void divide(struct emitter *emitter, uint32_t count, uint32_t half)
{
    int64_t low = 0, high = (int64_t)count - 1;
    while (low < high) {
        struct emitter pivot = emitter[half];
        int64_t i = low, j = high;
        while (i <= j) {
            while (is_before(&emitter[i], &pivot))
                i++;
            while (is_before(&pivot, &emitter[j]))
                j--;
            if (i > j)
                break;
            struct emitter kept = emitter[i];
            emitter[i++] = emitter[j];
            emitter[j--] = kept;
        }
        if (j < (int64_t)half)
            low = i;
        if ((int64_t)half < i)
            high = j;
    }
}

/* Along the axis in which the emitters' centres reach farthest. */
static void halve(struct emitter *emitter, uint32_t count, const struct hierarchy *h)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        const double *centre = hierarchy_surface(h, emitter[i].face)->centre;
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], centre[k]);
            high[k] = fmax(high[k], centre[k]);
        }
    }
    int axis = high[1] - low[1] > high[0] - low[0];
    axis = high[2] - low[2] > high[axis] - low[axis] ? 2 : axis;
    for (uint32_t i = 0; i < count; i++)
        emitter[i].along = hierarchy_surface(h, emitter[i].face)->centre[axis];
    divide(emitter, count, first_half(count));
}

static void build(struct light_tree *tree, const struct hierarchy *h, const double *exitance,
                  uint32_t bands, struct emitter *emitter, uint32_t at, uint32_t from, uint32_t to)
{
    struct light_node *node = &tree->node[at];
    if (to - from == 1) {
        uint32_t face = emitter[from].face;
        const struct element *e = hierarchy_surface(h, face);
        *node = (struct light_node){.radius = e->radius, .along = 1};
        memcpy(node->centre, e->centre, sizeof node->centre);
        memcpy(node->axis, e->normal, sizeof node->axis);
        for (uint32_t k = 0; k < bands; k++)
            node->power += e->area * exitance[(size_t)face * bands + k];
        tree->face[from] = face;
        tree->place[face] = from;
        return;
    }
    uint32_t half = first_half(to - from);
    halve(emitter + from, to - from, h);
    build(tree, h, exitance, bands, emitter, at + 1, from, from + half);
    build(tree, h, exitance, bands, emitter, at + 2 * half, from + half, to);
    join(node, &tree->node[at + 1], &tree->node[at + 2 * half]);
}

int light_tree_open(struct light_tree *tree, const struct hierarchy *h, const double *exitance,
                    uint32_t bands)
{
    struct emitter *emitter = malloc(h->face_count * sizeof *emitter);
    *tree = (struct light_tree){.place = malloc(h->face_count * sizeof *tree->place)};
    for (uint32_t i = 0; emitter && tree->place && i < h->face_count; i++) {
        double whole = 0;
        for (uint32_t k = 0; k < bands; k++)
            whole += exitance[(size_t)i * bands + k];
        tree->place[i] = UINT32_MAX;
        if (whole > 0)
            emitter[tree->count++].face = i;
    }
    tree->face = malloc((tree->count + 1) * sizeof *tree->face);
    tree->node = malloc((2 * (size_t)tree->count + 1) * sizeof *tree->node);
    int failed = !emitter || !tree->place || !tree->face || !tree->node;
    if (failed)
        light_tree_close(tree);
    else if (tree->count > 0)
        build(tree, h, exitance, bands, emitter, 0, 0, tree->count);
    free(emitter);
    return failed ? -1 : 0;
}

void light_tree_close(struct light_tree *tree)
{
    free(tree->node);
    free(tree->face);
    free(tree->place);
    *tree = (struct light_tree){0};
}

/* Cosine of an angle that is reduced by another, to no less than 0: both by cosine and sine. */
static double reduced(double c, double less_cosine, double less_sine)
{
    return c >= less_cosine ? 1 : c * less_cosine + sqrt(fmax(1 - c * c, 0)) * less_sine;
}

/* What a node may send to p, but for a factor and what is in between. */
static double weigh(const struct light_node *node, const double p[3], const double n[3])
{
    double way[3];
    sub3(way, node->centre, p);
    double square = dot3(way, way), radius = node->radius * node->radius;
    if (square <= radius)
        return node->power / radius;
    double distance = sqrt(square), sine = node->radius / distance, cosine = sqrt(1 - sine * sine),
           receives = reduced(dot3(n, way) / distance, cosine, sine), sends = 1;
    if (node->along > 0)
        sends = reduced(reduced(-dot3(node->axis, way) / distance, node->along, node->across),
                        cosine, sine);
    return receives > 0 && sends > 0 ? node->power * receives * sends / square : 0;
}

/* The share of the first of two nodes. Returns it, or -1 when neither may send anything. */
static double first_share(const struct light_node *a, const struct light_node *b, const double p[3],
                          const double n[3])
{
    double first = weigh(a, p, n), second = weigh(b, p, n);
    return first + second > 0 ? first / (first + second) : -1;
}

double light_tree_choose(const struct light_tree *tree, const double p[3], const double n[3],
                         double u, uint32_t *face)
{
    uint32_t at = 0, from = 0, count = tree->count;
    double chance = 1;
    while (count > 1) {
        uint32_t half = first_half(count);
        double share = first_share(&tree->node[at + 1], &tree->node[at + 2 * half], p, n);
        if (share < 0)
            return 0;
        int second = u >= share;
        u = second ? (u - share) / (1 - share) : u / share;
        chance *= second ? 1 - share : share;
        at += second ? 2 * half : 1;
        from += second ? half : 0;
        count = second ? count - half : half;
    }
    *face = tree->face[from];
    return chance;
}

double light_tree_chance(const struct light_tree *tree, const double p[3], const double n[3],
                         uint32_t face)
{
    uint32_t at = 0, from = 0, count = tree->count, place = tree->place[face];
    double chance = place == UINT32_MAX ? 0 : 1;
    while (count > 1 && chance > 0) {
        uint32_t half = first_half(count);
        double share = first_share(&tree->node[at + 1], &tree->node[at + 2 * half], p, n);
        if (share < 0)
            return 0;
        int second = place >= from + half;
        chance *= second ? 1 - share : share;
        at += second ? 2 * half : 1;
        from += second ? half : 0;
        count = second ? count - half : half;
    }
    return chance;
}
