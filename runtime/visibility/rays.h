/* rays.h - the host services of a scene: occlusion by Embree, candidates from the clusters, totals
 * for the oracles.
 * SPDX-License-Identifier: MIT */
#ifndef RAYS_H
#define RAYS_H

#include "discussion.h"
#include "hierarchy/hierarchy.h"

struct rays;

/* What the rays have cost so far, all threads together. */
struct rays_count {
    uint64_t rays;
    double seconds; /* inside Embree, summed over threads; by some of the calls */
};

/* Build the occlusion structure over the faces; those that do not shade (hierarchy.h) stand where
 * another does, and every face occludes from both sides. exitance and
 * reflectance: scene totals for host.irradiance, [face_count] largest band each. `threads`: how
 * many threads may ask at once. The hierarchy is borrowed until rays_close; it may be split
 * meanwhile, but not while a discussion goes on. Returns NULL when Embree fails; *cause then names
 * the reason (a constant string). */
struct rays *rays_open(const struct hierarchy *h, const double *exitance, const double *reflectance,
                       int threads, const char **cause);

/* The same without the structure, which takes longer than a matrix of a few hundred faces: until
 * rays_build, hosts answer, and nothing else may be asked of the rays. Where rays_in_the_way, build
 * before any host is asked what occludes. */
struct rays *rays_prepare(const struct hierarchy *h, const double *exitance,
                          const double *reflectance, int threads, const char **cause);
/* Nothing when it is there. Returns 0; -1 when Embree fails, with *cause set. Not while others ask.
 */
int rays_build(struct rays *rays, const char **cause);
/* For a hierarchy that is as theirs was when they were opened: nothing told, no ray counted. */
void rays_renew(struct rays *rays, const struct hierarchy *h);
/* 0: nothing stands between any two surfaces, and no host ever casts a ray. */
int rays_in_the_way(const struct rays *rays);

/* What the ray from a point into a direction (any length) meets first; the sides of a two-sided
 * face are both fronts. The caller keeps the point off the surface it stands on (host.ray_offset).
 * Where it meets something goes to `at`, as well as single precision knows, and the unit normal of
 * the side it meets to `normal`; both may be NULL. Thread-safe. */
enum ray_fate { RAY_LEAVES, RAY_MEETS_FRONT, RAY_MEETS_BACK };
enum ray_fate rays_first(const struct rays *rays, const double from[3], const double direction[3],
                         double at[3], double normal[3]);

/* Of rays from 16 points into one direction, those whose bit is set in `which`: which meet first
 * the back of a face, RAY_MEETS_BACK. Thread-safe. */
unsigned rays_meet_backs(const struct rays *rays, const double from[16][3], unsigned which,
                         const double direction[3]);

/* The face whose front the ray meets first: its index among the hierarchy's faces, the far side's
 * where it comes from behind a two-sided face; RAY_MEETS_NO_FRONT when it leaves the scene, or
 * ray_meets_back of the face whose black back it meets, which is below that. *distance: in lengths
 * of `direction`, as well as single precision knows. Thread-safe; not counted among rays_count. */
enum { RAY_MEETS_NO_FRONT = -1 };
static inline int64_t ray_meets_back(int64_t face)
{
    return RAY_MEETS_NO_FRONT - 1 - face;
}
int64_t rays_meet(const struct rays *rays, const double from[3], const double direction[3],
                  double *distance);
/* From p to where its ray meets e: into the plane of e, which the distance misses by the rounding
 * of single precision. */
static inline void ray_land(double p[3], const double direction[3], double distance,
                            const struct element *e)
{
    for (int k = 0; k < 3; k++)
        p[k] += distance * direction[k];
    const double above = height3(p, e->vertex[0], e->normal);
    for (int k = 0; k < 3; k++)
        p[k] -= above * e->normal[k];
}

/* May something stand on the face (standing_within)? Asked of each once, when it is wanted.
 * Thread-safe. */
int rays_stood_on(const struct rays *rays, uint32_t face);

/* Is the segment from + t direction, 0 < t < 1, blocked? Ends stand off their surfaces, as above.
 * Thread-safe; not counted. */
int rays_blocked(const struct rays *rays, const double from[3], const double direction[3]);

/* The services in the form that a discussion takes. Valid until rays_close. */
const struct host *rays_host(const struct rays *rays);
/* What a solve finds out for the oracles: host.impact, host.rank (W). Not while a discussion goes
 * on. */
void rays_tell_impact(struct rays *rays, double impact);
void rays_tell_rank(struct rays *rays, double rank);
struct rays_count rays_count(const struct rays *rays);
/* Rays that the calling thread has cast. */
uint64_t rays_count_own(const struct rays *rays);
void rays_close(struct rays *rays);

#endif
