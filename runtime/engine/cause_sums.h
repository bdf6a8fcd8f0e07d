/* cause_sums.h - differences by cause: added up by polygon, then over polygons, with their noise.
 * SPDX-License-Identifier: MIT */
#ifndef CAUSE_SUMS_H
#define CAUSE_SUMS_H

#include "particles/particles.h"
#include "radiosity.h"

/* The causes, and all of them together, which is measured by itself. */
enum { CAUSE_ALL = RAD_CAUSES, CAUSE_SUMS };

/* Of one polygon: links less rays, by replicate (in units of the caller). */
struct cause_polygon {
    double sum[CAUSE_SUMS][3][REPLICATES]; /* [][band] */
    /* the same, each point's difference times what light grows to from there, all bands; the sum of
     * that growth over points, by their weight, and how many points there are */
    double after[CAUSE_SUMS][REPLICATES], growth[3];
    double weight; /* of all points */
    uint64_t points;
    double last[3]; /* growth at its last point that no solid covers */
};

/* Of many polygons, all bands. */
struct cause_sums {
    double power[CAUSE_SUMS][REPLICATES], l1[CAUSE_SUMS][REPLICATES];
    double after[CAUSE_SUMS][REPLICATES], after_l1[CAUSE_SUMS][REPLICATES];
    uint64_t traced;                        /* rays */
    double links[RAD_WAYS], rays[RAD_WAYS]; /* brought by links of this way; found by rays */
};

/* Add a polygon that is complete, and empty it. */
void cause_sums_add(struct cause_sums *to, struct cause_polygon *polygon, uint32_t bands);
void cause_sums_join(struct cause_sums *to, const struct cause_sums *from);

/* What they come to as shares, where `whole` in units of the caller is 1. */
void cause_sums_report(const struct cause_sums *sums, double whole, struct RadCausesReport *report);

#endif
