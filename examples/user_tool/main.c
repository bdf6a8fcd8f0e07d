/* main.c - one oracle with a tool and a term of one's own, in both releases over the same pairs.
 *
 * Exit status 0: both decided alike, and their links have the same bits.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>
#include "near_first.h"
#include "oracle/refiner.h"

static uint64_t occluded(const struct host *host, int count, const struct segment *segments)
{
    (void)host;
    (void)count;
    (void)segments;
    return 0; /* nothing stands between */
}

/* A square of side `size` in the plane z, facing up or down. */
static void make_square(struct element *e, double x, double z, double size, double up, uint64_t id)
{
    static const double corner[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    int i;
    memset(e, 0, sizeof *e);
    e->centre[0] = x;
    e->centre[2] = z;
    e->normal[2] = up;
    e->area = size * size;
    e->radius = size * sqrt(0.5);
    e->radiosity = 10;
    e->cone = 1;
    e->id = id;
    e->vertices = 4;
    for (i = 0; i < 4; i++) {
        e->vertex[i][0] = x + size * up * corner[i][0]; /* counter-clockwise from the front */
        e->vertex[i][1] = size * corner[i][1];
        e->vertex[i][2] = z;
    }
}

int main(int count, char **arguments)
{
    struct interpretation how = {0};
    struct messages messages = {0};
    struct refiner *dag, *flat = refiner_compiled(&near_first_oracle, "flat");
    const struct host host = {.occluded = occluded,
                              .area = 6,
                              .extent = 1,
                              .exitance = 1,
                              .irradiance = 4,
                              .radiosity = 1,
                              .importance = 1,
                              .ray_offset = 1e-6,
                              .flat = 1e-9};
    int decided[DECISIONS] = {0}, i, wrong = 0;
    how.path = count > 1 ? arguments[1] : "near_first.dag";
    dag = refiner_interpret(&how, &messages);
    if (!dag || !flat)
        return fprintf(stderr, "%s\n", messages_text(&messages)), 1;
    for (i = 0; i < 2000; i++) {
        struct element receiver, emitter;
        struct discussion a, b;
        enum decision one, two;
        memset(&a, 0, sizeof a);
        a.receiver = &receiver;
        a.emitter = &emitter;
        a.host = &host;
        b = a;
        make_square(&receiver, 0, 0, 1.0 / (1 + i % 7), 1, 1);
        make_square(&emitter, 0.01 * (i % 50), 0.02 + 0.004 * i, 1.0 / (1 + i % 5), -1, 2);
        one = dag->refine(dag->state, &a);
        two = flat->refine(flat->state, &b);
        decided[one]++;
        wrong += one != two;
        if (one == DECISION_LINK && one == two)
            wrong += memcmp(&a.terms.form_factor, &b.terms.form_factor, sizeof(double)) != 0;
    }
    printf("%d pairs: %d links, %d stops, %d splits; the releases differ in %d\n", i,
           decided[DECISION_LINK], decided[DECISION_STOP],
           decided[DECISION_SUBDIVIDE_RECEIVER] + decided[DECISION_SUBDIVIDE_EMITTER], wrong);
    refiner_close(dag);
    refiner_close(flat);
    return wrong != 0;
}
