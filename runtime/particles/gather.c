/* gather.c - see gather.h.
 *
 * c = cos cos / (pi d^2) is how densely directions by the cosine find the point y, per area, and
 * d = q / A how densely points on what is bright do, q the chance of the piece (light_tree.h), A
 * its area. With n_c and n_l rays of either kind, each counts what it finds as B(y) c / (n_c c +
 * n_l d).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "kernel/leaf_at.h"
#include "kernel/surface_point.h"
#include "particles/gather.h"
#include "particles/paths.h"

/* Of random numbers: those of no mending, measurement or reference. */
static const uint64_t STREAM = (uint64_t)0x676174 << 40;

static double sum_of(const double *values, uint32_t bands)
{
    double sum = 0;
    for (uint32_t k = 0; k < bands; k++)
        sum += values[k];
    return sum;
}

/* How many times more the leaf reflects than surfaces radiate in the mean. */
static double brightness(const struct gather *g, uint32_t leaf)
{
    uint32_t bands = g->tracer->bands, face = g->tracer->hierarchy->elements[leaf].face;
    double own = sum_of(&g->radiosity[(size_t)leaf * bands], bands)
                 - sum_of(&g->tracer->exitance[(size_t)face * bands], bands);
    return g->mean > 0 ? own / g->mean : 0;
}

/* ---- what is bright */

static int is_lamp(const struct gather *g, uint32_t face)
{
    uint32_t bands = g->tracer->bands;
    return sum_of(&g->tracer->exitance[(size_t)face * bands], bands) > g->mean;
}

/* Lamps are pieces as whole faces: their light is even, and sampling knows their outline. Fills
 * element[] unless NULL; returns how many there are. */
static uint32_t find_pieces(const struct gather *g, uint32_t *element)
{
    const struct hierarchy *h = g->tracer->hierarchy;
    uint32_t count = 0;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        int whole = e->vertices && h->face_element[e->face] == i && is_lamp(g, e->face);
        int leaf =
            e->vertices && !e->children && !is_lamp(g, e->face) && brightness(g, i) > GATHER_BRIGHT;
        if (!whole && !leaf)
            continue;
        if (element)
            element[count] = i;
        count++;
    }
    return count;
}

static void mark_pieces(struct gather *g)
{
    const struct hierarchy *h = g->tracer->hierarchy;
    for (uint32_t i = 0; i < h->count; i++)
        g->piece[i] = NO_PIECE;
    for (uint32_t p = 0; p < g->lights.face_count; p++)
        g->piece[g->lights.face_element[p]] = p;
    for (uint32_t i = 0; i < h->count; i++) /* children follow their parents */
        for (uint32_t c = 0; h->elements[i].vertices && c < h->elements[i].children; c++)
            if (g->piece[i] != NO_PIECE)
                g->piece[h->elements[i].child + c] = g->piece[i];
}

int gather_open(struct gather *g, const struct tracer *t, const double *radiosity,
                const double *gradient)
{
    const struct hierarchy *h = t->hierarchy;
    uint32_t bands = t->bands;
    *g = (struct gather){.tracer = t,
                         .radiosity = radiosity,
                         .gradient = gradient,
                         .mean = sum_of(radiosity, bands)};
    uint32_t count = find_pieces(g, NULL);
    double *shines = malloc(((size_t)count + 1) * bands * sizeof *shines);
    g->lights = (struct hierarchy){.elements = h->elements, .face_count = count};
    g->lights.face_element = malloc((count + (size_t)1) * sizeof *g->lights.face_element);
    g->piece = malloc((h->count + (size_t)1) * sizeof *g->piece);
    int failed = !shines || !g->lights.face_element || !g->piece;
    if (!failed) {
        find_pieces(g, g->lights.face_element);
        mark_pieces(g);
        for (size_t p = 0; p < count; p++)
            for (uint32_t k = 0; k < bands; k++)
                shines[p * bands + k] = radiosity[(size_t)g->lights.face_element[p] * bands + k];
        failed = light_tree_open(&g->tree, &g->lights, shines, bands) < 0;
    }
    free(shines);
    sobol_sequence_open(&g->sobol);
    if (failed)
        gather_close(g);
    return failed ? -1 : 0;
}

void gather_close(struct gather *g)
{
    light_tree_close(&g->tree);
    free(g->lights.face_element);
    free(g->piece);
    *g = (struct gather){0};
}

/* ---- rays */

/* Rays of one point: how many of each kind, and whether they may take a second step. */
struct fan {
    uint32_t face;
    const double *p; /* just in front of the face */
    struct path_rays rays;
    struct dice *dice; /* NULL: none may */
};

static void move_off(const struct gather *g, const double normal[3], double p[3])
{
    double off = rays_host(g->tracer->rays)->ray_offset;
    for (int k = 0; k < 3; k++)
        p[k] += off * normal[k];
}

static void follow(const struct gather *g, const struct fan *fan, const double u[5], double *h);

/* What reaches the point `at` of a leaf, by `count` rays of either kind: H (W/m2). */
static void look_again(const struct gather *g, uint32_t leaf, const double at[3], int count,
                       struct dice *dice, double *h)
{
    const struct element *e = &g->tracer->hierarchy->elements[leaf];
    double p[3] = {at[0], at[1], at[2]};
    move_off(g, e->normal, p);
    const struct fan fan = {e->face, p, {count, g->tree.count > 0 ? count : 0}, NULL};
    for (int i = 0; i < count; i++) {
        double u[5];
        for (int d = 0; d < 5; d++)
            u[d] = dice_throw(dice);
        follow(g, &fan, u, h);
    }
}

/* Add to h what leaves the point `at` of a leaf towards the fan's, times `share`. */
static void add_seen(const struct gather *g, const struct fan *fan, uint32_t leaf,
                     const double at[3], double share, double *h)
{
    const struct tracer *t = g->tracer;
    const struct element *e = &t->hierarchy->elements[leaf];
    double way[3], again[3] = {0, 0, 0}, bright = brightness(g, leaf);
    uint32_t bands = t->bands;
    sub3(way, at, fan->p);
    int coarse = fan->dice && (length3(way) < GATHER_NEAR * e->radius || bright > GATHER_BRIGHT);
    if (coarse)
        look_again(g, leaf, at, (int)fmin(fmax(bright, 1), GATHER_AGAIN), fan->dice, again);
    for (uint32_t k = 0; k < bands; k++) {
        size_t i = (size_t)leaf * bands + k, of_face = (size_t)e->face * bands + k;
        double B = g->radiosity[i];
        for (int c = 0; g->gradient && c < 3; c++)
            B += g->gradient[3 * i + (size_t)c] * (at[c] - e->centre[c]);
        if (coarse)
            B = t->exitance[of_face] + t->reflectance[of_face] * again[k];
        h[k] += B > 0 ? share * B : 0;
    }
}

/* The ray towards the point of a bright piece that u[3] stand for. */
static void to_light(const struct gather *g, const struct fan *fan, const double u[3], double *h)
{
    const struct element *elements = g->tracer->hierarchy->elements;
    const double *n = tracer_surface(g->tracer, fan->face)->normal;
    double y[3], to[3], way[3], weight[4];
    uint32_t piece;
    double chance = light_tree_choose(&g->tree, fan->p, n, u[0], &piece);
    if (!(chance > 0))
        return;
    uint32_t element = g->lights.face_element[piece];
    const struct element *e = &elements[element];
    surface_even_point(y, e, u[1], u[2]);
    double by_cosine = tracer_density(g->tracer, fan->face, fan->p, y, e->normal);
    if (!(by_cosine > 0))
        return;
    for (int k = 0; k < 3; k++)
        to[k] = y[k];
    move_off(g, e->normal, to);
    sub3(way, to, fan->p);
    if (!rays_blocked(g->tracer->rays, fan->p, way))
        add_seen(g, fan, leaf_at(elements, element, y, weight), y,
                 path_share(&fan->rays, by_cosine, chance / e->area), h);
}

/* The ray in the direction by the cosine that (u, v) stand for. */
static void onward(const struct gather *g, const struct fan *fan, double u, double v, double *h)
{
    const struct hierarchy *hierarchy = g->tracer->hierarchy;
    const double *n = tracer_surface(g->tracer, fan->face)->normal;
    double q[3] = {fan->p[0], fan->p[1], fan->p[2]}, at[3], weight[4];
    int64_t met = tracer_step(g->tracer, fan->face, q, u, v, at);
    if (met < 0)
        return;
    uint32_t leaf = leaf_at(hierarchy->elements, hierarchy->face_element[met], at, weight);
    uint32_t piece = g->piece[leaf];
    double share = 1 / fan->rays.cosine;
    if (piece != NO_PIECE && fan->rays.light > 0) {
        const struct element *e = &hierarchy->elements[g->lights.face_element[piece]];
        double by_cosine = tracer_density(g->tracer, fan->face, fan->p, at, e->normal);
        share = by_cosine > 0 ? path_share(&fan->rays, by_cosine,
                                           light_tree_chance(&g->tree, fan->p, n, piece) / e->area)
                              : 0;
    }
    add_seen(g, fan, leaf, at, share, h);
}

/* One ray of either kind. */
static void follow(const struct gather *g, const struct fan *fan, const double u[5], double *h)
{
    onward(g, fan, u[0], u[1], h);
    if (fan->rays.light > 0)
        to_light(g, fan, &u[2], h);
}

void gather_radiosity(const struct gather *g, uint32_t face, const double point[3], uint64_t set,
                      uint32_t first, uint32_t count, double *radiosity)
{
    const struct tracer *t = g->tracer;
    uint32_t lights = g->tree.count > 0 ? count / 2 : 0, shift[SOBOL_DIMENSIONS];
    double p[3] = {point[0], point[1], point[2]}, h[3] = {0, 0, 0};
    struct dice of_set = dice_of(STREAM, set);
    struct dice dice = dice_of(STREAM + 1, set + ((uint64_t)first << 40));
    const struct fan fan = {face, p, {count - lights, lights}, &dice};
    for (int d = 0; d < SOBOL_DIMENSIONS; d++)
        shift[d] = (uint32_t)(hash64(of_set.state += HASH_STEP) >> 32);
    move_off(g, tracer_surface(t, face)->normal, p);
    /* Both kinds share a number, so before this point so many are taken. */
    uint32_t before = (uint32_t)((uint64_t)first * (count - lights) / count);
    for (uint32_t i = 0; i < count - lights; i++) {
        /* its first two dimensions are the most even together */
        double u[SOBOL_DIMENSIONS];
        sobol_sequence_point(&g->sobol, before + i, shift, u);
        if (i < lights)
            follow(g, &fan, u, h);
        else
            onward(g, &fan, u[0], u[1], h);
    }
    for (uint32_t k = 0; k < t->bands; k++) {
        size_t at = (size_t)face * t->bands + k;
        radiosity[k] = t->exitance[at] + t->reflectance[at] * h[k];
    }
}
