/* rays.c - the host of a scene: occlusion on Embree, candidates and totals from the hierarchy.
 *
 * Embree works in single precision, so the scene is moved to the origin and scaled by a power of
 * two to a size of about one: a scene in millimetres or kilometres gives the same rays to the bit.
 * Segments start and end a little off their surfaces (host.ray_offset), which no rounding of
 * Embree's robust mode can cross; so no hit needs to be filtered.
 *
 * Rays travel in packets of 16, a call's in their order, and a call's are one pair's. Invariant:
 * what a ray meets must depend on its pair alone, and in a packet it does not: where few rays of a
 * packet are still on their way Embree goes on with each alone, by another test, and a ray that
 * passes an edge within rounding then meets it or not by its companions. Of 40 million rays of
 * five scenes two did, when packets were filled across pairs or sorted. Rays cast alone do not,
 * and take 1.3 to 3 times as long. Nor is there much to win: of pairs with 16 rays full packets
 * take as long, of those with 4 a fifth less; sorted by direction and origin, longer; said to be
 * coherent, longer.
 * SPDX-License-Identifier: MIT */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "visibility/back_faces.h"
#include "visibility/candidates.h"
#include "util/clock.h"
#include "util/embree_memory.h"
#include "util/spared_rays.h"
#include "util/thread_pool.h"
#include "kernel/constants.h"
#include "visibility/rays_within.h"
#include "visibility/standing.h"

/* The call that casts the last of so many rays is timed, and speaks for all of them: a call's
 * chance is its share of the rays, so that what it took per ray, times TIMED, has the right mean. A
 * clock that is read twice a packet takes a tenth of what Embree does. */
enum { PACKET = 16, TIMED = 512 };

/* Counters of a thread, alone on their cache lines. A thread that a program brings itself may have
 * any number, so threads may share a tally; they add to it one at a time. */
struct tally {
    _Atomic uint64_t rays;
    _Atomic uint64_t nanoseconds;
    char pad[112];
};

static uint64_t now(void)
{
    return clock_nanoseconds(CLOCK_MONOTONIC);
}

/* Rays that end at 1 and meet whatever there is. */
#define SIXTEEN(x) \
    { \
        x, x, x, x, x, x, x, x, x, x, x, x, x, x, x, x \
    }
static const struct RTCRay16 whole_segments = {.tfar = SIXTEEN(1), .mask = SIXTEEN(~0u)};

/* Up to PACKET segments in Embree's coordinates, GROUP at a time; what lacks in the last group
 * repeats the first. Embree looks at no ray that is not valid. */
static void fill_packet(const struct rays *rays, int count, const struct segment *segments,
                        struct RTCRay16 *packet)
{
    _Static_assert(sizeof *segments == NUMBERS * sizeof(double), "a segment is its numbers");
    _Static_assert(STEP == GROUP * NUMBERS && PACKET % GROUP == 0, "groups fill a packet");
    struct segment few[GROUP];
    float moved[STEP];
    const double scale = rays->scale;
    for (int first = 0; first < count; first += GROUP) {
        const struct segment *group = &segments[first];
        if (count - first < GROUP) {
            for (int i = 0; i < GROUP; i++)
                few[i] = segments[first + i < count ? first + i : 0];
            group = few;
        }
        const double *number = (const double *)(const void *)group;
        for (int j = 0; j < STEP; j++)
            moved[j] = (float)((number[j] - rays->origins[j]) * scale);
        for (int i = 0; i < GROUP; i++) {
            const float *from = &moved[NUMBERS * i], *to = from + 3;
            packet->org_x[first + i] = from[0];
            packet->org_y[first + i] = from[1];
            packet->org_z[first + i] = from[2];
            packet->dir_x[first + i] = to[0] - from[0];
            packet->dir_y[first + i] = to[1] - from[1];
            packet->dir_z[first + i] = to[2] - from[2];
        }
    }
}

/* Does nothing stand in the way of any of them, for sure? One that may be stopped is cast with all
 * its company: rays of a packet are what they are together. */
static int all_free(const struct rays *rays, int count, const struct segment *segments)
{
    for (int i = 0; i < count; i++)
        if (!free_space_passes(&rays->free, segments[i].from, segments[i].to))
            return 0;
    return 1;
}

static struct tally *own_tally(const struct rays *rays)
{
    return &rays->tallies[thread_pool_number() % rays->threads];
}

static uint64_t occluded(const struct host *host, int count, const struct segment *segments)
{
    const struct rays *rays = (const struct rays *)(const void *)host;
    if (all_free(rays, count, segments)) {
        spared_rays += (uint64_t)count;
        return 0;
    }
    struct tally *tally = own_tally(rays);
    uint64_t hits = 0, before = tally->rays, spent = 0;
    tally->rays += (uint64_t)count;
    const int timed = before / TIMED != (before + (uint64_t)count) / TIMED;
    for (int first = 0; first < count; first += PACKET) {
        const int n = count - first < PACKET ? count - first : PACKET;
        _Alignas(64) int valid[PACKET];
        _Alignas(64) struct RTCRay16 packet;
        for (int i = 0; i < PACKET; i++)
            valid[i] = i < n ? -1 : 0;
        packet = whole_segments;
        fill_packet(rays, n, &segments[first], &packet);
        if (timed) { /* less what reading the clock takes */
            uint64_t once = now(), start = now();
            embree_occluded_16(rays->scene, valid, &packet);
            uint64_t end = now(), reading = start - once;
            spent += end - start > reading ? end - start - reading : 0;
        } else {
            embree_occluded_16(rays->scene, valid, &packet);
        }
        for (int i = 0; i < n; i++)
            hits |= (uint64_t)(packet.tfar[i] < 0) << (first + i); /* Embree: -inf when occluded */
    }
    if (timed)
        tally->nanoseconds += spent * TIMED / (uint64_t)count;
    return hits;
}

static const struct hierarchy *hierarchy_of(const struct host *host)
{
    return ((const struct rays *)(const void *)host)->hierarchy;
}

static int candidates(const struct host *host, const struct shaft *shaft, int most, uint32_t *faces)
{
    const struct rays *rays = (const struct rays *)(const void *)host;
    return free_space_is_all(&rays->free)
               ? 0
               : candidates_find(rays->hierarchy, shaft, host->ray_offset, most, faces);
}

static void corners(const struct host *host, uint32_t face, struct polygon *polygon)
{
    candidates_corners(hierarchy_of(host), face, polygon);
}

static double optical_depth(const struct host *host, const struct segment *segment,
                            uint32_t receiver, uint32_t emitter)
{
    return candidates_depth(hierarchy_of(host), segment, receiver, emitter, host->ray_offset);
}

/* The largest power of two not above x > 0. */
static double power_of_two(double x)
{
    int e;
    frexp(x, &e);
    return ldexp(1, e - 1);
}

static void totals(struct rays *rays, const struct hierarchy *h, const double *exitance,
                   const double *reflectance)
{
    double area = 0, emitted = 0, reflected = 0, brightest = 0, whitest = 0, size = 0;
    for (uint32_t i = 0; i < h->face_count; i++) {
        if (h->faces[i].light == FACE_DARK)
            continue;
        double a = hierarchy_surface(h, i)->area;
        area += a;
        emitted += a * exitance[i];
        reflected += a * reflectance[i];
        brightest = exitance[i] > brightest ? exitance[i] : brightest;
        whitest = reflectance[i] > whitest ? reflectance[i] : whitest;
    }
    for (int k = 0; k < 3; k++) {
        double side = h->high[k] - h->low[k];
        rays->origin[k] = 0.5 * (h->low[k] + h->high[k]);
        size = side > size ? side : size;
    }
    for (int i = 0; i < STEP; i++)
        rays->origins[i] = rays->origin[i % 3];
    rays->scale = 1 / power_of_two(size);
    rays->host.occluded = occluded;
    rays->host.candidates = candidates;
    rays->host.exact = 1;
    rays->host.corners = corners;
    rays->host.optical_depth = optical_depth;
    rays->host.area = area;
    rays->host.extent = size;
    rays->host.exitance = brightest;
    rays->host.reflectance = whitest;
    rays->host.mean_reflectance = reflected > 0 ? reflected / area : 1;
    rays->host.faces = h->face_count;
    rays->host.irradiance = area > 0 && area > reflected ? emitted / (area - reflected) : 0;
    rays->host.radiosity = area > 0 ? (emitted + reflected * rays->host.irradiance) / area : 0;
    rays->host.ray_offset = RAY_OFFSET * size;
    rays->host.flat = RAY_FLAT * rays->host.ray_offset;
}

static RTCGeometry faces_geometry(struct rays *rays, const struct hierarchy *h)
{
    RTCGeometry geometry = rtcNewGeometry(rays->device, RTC_GEOMETRY_TYPE_QUAD);
    uint32_t solid = 0, n = 0;
    for (uint32_t i = 0; i < h->face_count; i++)
        solid += (uint32_t)face_shades(&h->faces[i]);
    float *vertices;
    vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                       3 * sizeof *vertices, (size_t)solid * 4);
    unsigned *indices;
    indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                      4 * sizeof *indices, solid);
    rays->face = malloc(solid * sizeof *rays->face);
    rays->behind = malloc(h->face_count * sizeof *rays->behind);
    if (!vertices || !indices || !rays->face || !rays->behind
        || back_faces_find(h, rays->behind) < 0) {
        rtcReleaseGeometry(geometry);
        return NULL;
    }
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct face *f = &h->faces[i];
        if (!face_shades(f))
            continue;
        for (uint32_t j = 0; j < 4; j++) {
            /* a triangle repeats its last corner */
            const double *v = f->vertex[j < f->vertices ? j : f->vertices - 1];
            for (int k = 0; k < 3; k++)
                vertices[12 * (size_t)n + 3 * j + (size_t)k] =
                    (float)((v[k] - rays->origin[k]) * rays->scale);
            indices[4 * (size_t)n + j] = 4 * n + j;
        }
        rays->face[n++] = i;
    }
    rtcCommitGeometry(geometry);
    return geometry;
}

void rays_renew(struct rays *rays, const struct hierarchy *h)
{
    rays->hierarchy = h;
    rays->host.elements = (const struct element *const *)&h->elements;
    rays->host.importance = 1;
    rays->host.impact = 1;
    rays->host.rank = 0;
    memset(rays->tallies, 0, (size_t)rays->threads * sizeof *rays->tallies);
}

struct rays *rays_prepare(const struct hierarchy *h, const double *exitance,
                          const double *reflectance, int threads, const char **cause)
{
    struct rays *rays = calloc(1, sizeof *rays);
    *cause = "out of memory";
    if (!rays)
        return NULL;
    rays->threads = threads;
    rays->tallies = calloc((size_t)threads, sizeof *rays->tallies);
    rays->stood = calloc(h->face_count + (size_t)1, sizeof *rays->stood);
    if (!rays->tallies || !rays->stood) {
        rays_close(rays);
        return NULL;
    }
    rays_renew(rays, h);
    totals(rays, h, exitance, reflectance);
    free_space_find(&rays->free, h, rays->host.flat, 2 * rays->host.ray_offset);
    return rays;
}

int rays_build(struct rays *rays, const char **cause)
{
    const struct hierarchy *h = rays->hierarchy;
    if (rays->scene)
        return 0;
    rays->device = rtcNewDevice(rays->threads == 1 ? "threads=1,set_affinity=0" : NULL);
    if (!rays->device) {
        if (rtcGetDeviceError(NULL) == RTC_ERROR_UNSUPPORTED_CPU)
            *cause = "Embree finds no device on this processor";
        else
            *cause = "out of memory for Embree, which needs 200 MB of address space to begin";
        return -1;
    }
    rays->scene = rtcNewScene(rays->device);
    rtcSetSceneFlags(rays->scene, RTC_SCENE_FLAG_ROBUST | EMBREE_FILTERED);
    rtcSetSceneBuildQuality(rays->scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = faces_geometry(rays, h);
    const int room = embree_has_memory(h->face_count);
    if (geometry) {
        rtcAttachGeometry(rays->scene, geometry);
        rtcReleaseGeometry(geometry);
        if (room)
            rtcCommitScene(rays->scene);
    }
    if (!geometry || !room || rtcGetDeviceError(rays->device) != RTC_ERROR_NONE) {
        *cause = "out of memory for Embree's structure over the scene; fewer faces need less";
        return -1;
    }
    return 0;
}

struct rays *rays_open(const struct hierarchy *h, const double *exitance, const double *reflectance,
                       int threads, const char **cause)
{
    struct rays *rays = rays_prepare(h, exitance, reflectance, threads, cause);
    if (rays && rays_build(rays, cause) < 0) {
        rays_close(rays);
        rays = NULL;
    }
    return rays;
}

int rays_in_the_way(const struct rays *rays)
{
    return !free_space_is_all(&rays->free);
}

void rays_tell_impact(struct rays *rays, double impact)
{
    rays->host.impact = impact;
}

void rays_tell_rank(struct rays *rays, double rank)
{
    rays->host.rank = rank;
}

const struct host *rays_host(const struct rays *rays)
{
    return &rays->host;
}

struct rays_count rays_count(const struct rays *rays)
{
    struct rays_count sum = {0, 0};
    for (int i = 0; i < rays->threads; i++) {
        sum.rays += rays->tallies[i].rays;
        sum.seconds += 1e-9 * (double)rays->tallies[i].nanoseconds;
    }
    return sum;
}

uint64_t rays_count_own(const struct rays *rays)
{
    return own_tally(rays)->rays;
}

int rays_stood_on(const struct rays *rays, uint32_t face)
{
    enum { BARE = 1, STOOD_ON = 2 };
    const struct hierarchy *h = rays->hierarchy;
    int stood = atomic_load_explicit(&rays->stood[face], memory_order_relaxed);
    if (!stood) {
        stood =
            standing_within(h, hierarchy_surface(h, face), rays->host.ray_offset) ? STOOD_ON : BARE;
        atomic_store_explicit(&rays->stood[face], (unsigned char)stood, memory_order_relaxed);
    }
    return stood == STOOD_ON;
}

void rays_close(struct rays *rays)
{
    if (!rays)
        return;
    if (rays->scene)
        rtcReleaseScene(rays->scene);
    if (rays->device)
        rtcReleaseDevice(rays->device);
    free(rays->face);
    free(rays->behind);
    free((void *)rays->stood);
    free(rays->tallies);
    free(rays);
}
