/* main.c - a program of its own that ships a refiner made by dagc: refiner.c and refiner.h, two
 * files.
 *
 * It refines every pair of patches of its room down to links and prints each decision. The
 * patches are its own; a refiner_element is filled in when a pair is asked about.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "mesh.h"
#include "refiner.h"

static struct refiner_element element_of(const struct patch *p)
{
    struct refiner_element e;
    int i, k;
    memset(&e, 0, sizeof e);
    patch_normal(p, e.normal);
    for (i = 0; i < 4; i++)
        patch_corner(p, i, e.vertex[i]);
    for (k = 0; k < 3; k++)
        e.centre[k] = 0.5 * (e.vertex[0][k] + e.vertex[2][k]);
    e.area = patch_area(p);
    e.radius =
        0.5
        * sqrt(pow(e.vertex[2][0] - e.vertex[0][0], 2) + pow(e.vertex[2][1] - e.vertex[0][1], 2)
               + pow(e.vertex[2][2] - e.vertex[0][2], 2));
    e.radiosity = p->light;
    e.cone = 1;
    e.vertices = 4;
    e.depth = (unsigned char)p->depth;
    e.id = p->number;
    return e;
}

/* Bit i: something stands on segment i. */
static uint64_t occluded(const struct refiner_host *host, int count,
                         const struct refiner_segment *segments)
{
    uint64_t met = 0;
    int i;
    (void)host;
    for (i = 0; i < count; i++)
        if (room_blocks(segments[i].from, segments[i].to))
            met |= (uint64_t)1 << i;
    return met;
}

static void totals(struct refiner_host *host)
{
    double power = 0;
    int i;
    for (i = 0; i < ROOM_PATCHES; i++) {
        host->area += patch_area(&room[i]);
        power += patch_area(&room[i]) * room[i].light;
    }
    host->irradiance = power / host->area;
    host->ray_offset = 1e-6;
    host->flat = 1e-9;
}

struct job {
    struct refiner_host host;
    struct refiner_bf_guarded_parameters parameters;
    long decided[4];
};

static void refine(struct job *job, const struct patch *receiver, const struct patch *emitter)
{
    static const char *const names[] = {"link", "stop", "split receiver", "split emitter"};
    struct refiner_element r = element_of(receiver), s = element_of(emitter);
    struct refiner_discussion d;
    enum refiner_decision decision;
    int i;
    memset(&d, 0, sizeof d);
    d.receiver = &r;
    d.emitter = &s;
    d.host = &job->host;
    decision = refiner_bf_guarded_refine(&job->parameters, &d);
    job->decided[decision]++;
    printf("%u %u %s", receiver->number, emitter->number, names[decision]);
    if (decision == REFINER_DECISION_LINK)
        printf(" F %.17g V %.17g", d.terms.form_factor, d.terms.visibility);
    printf("\n");
    for (i = 0; i < 4; i++)
        if (decision == REFINER_DECISION_SUBDIVIDE_RECEIVER) {
            struct patch child = patch_quarter(receiver, i);
            refine(job, &child, emitter);
        } else if (decision == REFINER_DECISION_SUBDIVIDE_EMITTER) {
            struct patch child = patch_quarter(emitter, i);
            refine(job, receiver, &child);
        }
}

int main(void)
{
    struct job job;
    int i, j;
    memset(&job, 0, sizeof job);
    refiner_host_open(&job.host, occluded, totals);
    refiner_bf_guarded_defaults(&job.parameters);
    job.parameters.min_share = 1e-3; /* a small program for a small room */
    for (i = 0; i < ROOM_PATCHES; i++)
        for (j = 0; j < ROOM_PATCHES; j++)
            if (i != j)
                refine(&job, &room[i], &room[j]);
    printf("links %ld, nothing %ld, splits %ld\n", job.decided[0], job.decided[1],
           job.decided[2] + job.decided[3]);
    return 0;
}
