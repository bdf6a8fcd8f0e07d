/* wave_times.c - what releases of an oracle take of the same pairs, and what of that is Embree's:
 *
 *     [PAIRS=COUNT] wave_times ORACLE SCENE... [NAME=VALUE...]
 *
 * While a scene is solved, every block of discussions that the engine hands out is held by each
 * release, one after the other, on copies: first the whole block, then those of its pairs that cast
 * no ray. The block's rays are then cast once more, the same in the same order, by nothing but
 * Embree's calls. That is done in TURNS solves; medians count, with the least and the largest. Time
 * is the thread's own, less what reading its clock takes.
 *
 * No release holds the same pairs twice in a row, so that no processor can learn their answers by
 * heart: what goes on in the solve is the interpreter's. Elements are in the caches for all, and
 * each block begins with another release. A decision that differs ends the program with status 1.
 * With PAIRS each solve ends when it has discussed as many.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "engine/solve.h"
#include "oracle/counted_host.h"
#include "scene/read_scene.h"
#include "util/array.h"
#include "util/embree.h"
#include "util/oracles.h"
#include "wave.h"

enum { TURNS = 3, PACKET = 16, PACKETS_MOST = WAVE_PAIRS * 96 };
enum who { HAND, FLAT, WAVE, BARE, ASKED, GOING = ASKED, ALL };
static const char *const names[ASKED] = {"hand", "flat", "wave", "bare Embree"};

/* Some discussions, and what holds them cost. */
struct work {
    double seconds[ASKED][TURNS];
    double pairs, rays; /* of one turn */
};

struct bench {
    struct refiner *by[ALL];
    const struct solve *solve;
    RTCDevice device;
    RTCScene scene;
    double origin[3], scale;
    struct work whole, free_of_rays;
    struct discussion copies[WAVE_PAIRS];
    struct blockers lists[WAVE_PAIRS];
    enum decision decisions[WAVE_PAIRS], wanted[WAVE_PAIRS];
    struct RTCRay16 *packets, *fresh; /* [PACKETS_MOST] */
    int valid[PACKETS_MOST];          /* how many rays */
    int packet_count;
    int different, turn, blocks;
    double clock; /* what reading it takes */
};

static struct bench bench;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- Embree, as rays.c has it */

static void open_embree(void)
{
    const struct hierarchy *h = &bench.solve->hierarchy;
    double size = 0;
    int exponent;
    for (int k = 0; k < 3; k++) {
        const double side = h->high[k] - h->low[k];
        bench.origin[k] = 0.5 * (h->low[k] + h->high[k]);
        size = side > size ? side : size;
    }
    (void)frexp(size, &exponent);
    bench.scale = ldexp(1, 1 - exponent);
    bench.device = rtcNewDevice("threads=1,set_affinity=0");
    bench.scene = rtcNewScene(bench.device);
    rtcSetSceneFlags(bench.scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(bench.scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(bench.device, RTC_GEOMETRY_TYPE_QUAD);
    size_t n = 0;
    float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                              RTC_FORMAT_FLOAT3, 12, h->face_count * (size_t)4);
    unsigned *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                RTC_FORMAT_UINT4, 16, h->face_count);
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct face *f = h->faces[i].back ? NULL : &h->faces[i]; /* NULL: a mere point */
        for (uint32_t j = 0; j < 4; j++) {
            for (int k = 0; k < 3; k++)
                vertices[12 * n + 3 * j + (size_t)k] =
                    f ? (float)((f->vertex[j < f->vertices ? j : f->vertices - 1][k]
                                 - bench.origin[k])
                                * bench.scale)
                      : 0;
            indices[4 * n + j] = (unsigned)(f ? 4 * n + j : 4 * n);
        }
        n++;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(bench.scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(bench.scene);
}

static void keep_packet(int count, const struct segment *segments)
{
    if (bench.packet_count == PACKETS_MOST) {
        fputs("wave_times: a block casts too many rays\n", stderr);
        exit(2);
    }
    struct RTCRay16 *p = &bench.fresh[bench.packet_count];
    memset(p, 0, sizeof *p);
    for (int i = 0; i < PACKET; i++) {
        const struct segment *s = &segments[i < count ? i : 0];
        float from[3], to[3];
        for (int k = 0; k < 3; k++) {
            from[k] = (float)((s->from[k] - bench.origin[k]) * bench.scale);
            to[k] = (float)((s->to[k] - bench.origin[k]) * bench.scale);
        }
        p->org_x[i] = from[0];
        p->org_y[i] = from[1];
        p->org_z[i] = from[2];
        p->dir_x[i] = to[0] - from[0];
        p->dir_y[i] = to[1] - from[1];
        p->dir_z[i] = to[2] - from[2];
        p->tfar[i] = 1;
        p->mask[i] = ~0u;
    }
    bench.valid[bench.packet_count++] = count;
}

static uint64_t record_rays(const struct host *host, int count, const struct segment *segments)
{
    for (int i = 0; i < count; i += PACKET)
        keep_packet(count - i < PACKET ? count - i : PACKET, segments + i);
    return counted_occluded(host, count, segments);
}

static void cast_bare(void)
{
    for (int i = 0; i < bench.packet_count; i++) {
        _Alignas(64) int valid[PACKET];
        for (int k = 0; k < PACKET; k++)
            valid[k] = k < bench.valid[i] ? -1 : 0;
        embree_occluded_16(bench.scene, valid, &bench.packets[i]);
    }
}

/* ---- blocks */

static void copy_block(const struct discussion *block, int count)
{
    for (int i = 0; i < count; i++) {
        bench.copies[i] = block[i];
        if (block[i].blockers) {
            bench.lists[i] = *block[i].blockers;
            bench.copies[i].blockers = &bench.lists[i];
        }
    }
}

/* The block held once. Returns the seconds. */
static double hold(enum who who, const struct discussion *block, int count)
{
    const struct refiner *r = bench.by[who];
    copy_block(block, count);
    if (who == BARE)
        memcpy(bench.packets, bench.fresh, (size_t)bench.packet_count * sizeof *bench.packets);
    const double began = now();
    if (who == BARE)
        cast_bare();
    else if (who == WAVE)
        r->wave(r->state, bench.copies, count, bench.decisions);
    else
        for (int i = 0; i < count; i++)
            bench.decisions[i] = r->refine(r->state, &bench.copies[i]);
    const double took = now() - began - bench.clock;
    for (int i = 0; who != BARE && i < count; i++)
        bench.different += bench.decisions[i] != bench.wanted[i];
    return took;
}

static void hold_by_all(struct work *work, const struct discussion *block, int count)
{
    for (int k = 0; k < ASKED && count > 0; k++) {
        const enum who who = (enum who)((k + bench.blocks) % ASKED);
        if (bench.by[who] || who == BARE)
            work->seconds[who][bench.turn] += hold(who, block, count);
    }
    work->pairs += count;
}

/* The refiner that the engine sees: all hold the block, the interpreter's goes on. */
static void spy_wave(const void *state, struct discussion *block, int count,
                     enum decision *decisions)
{
    static struct discussion start[WAVE_PAIRS], without[WAVE_PAIRS];
    static struct blockers lists[WAVE_PAIRS], of_without[WAVE_PAIRS];
    static enum decision wanted[WAVE_PAIRS];
    int free_count = 0;
    (void)state;
    if (!bench.scene)
        open_embree();
    bench.packet_count = 0;
    for (int i = 0; i < count; i++) {
        const struct host *host = block[i].host;
        struct counted_host counted;
        start[i] = block[i];
        if (block[i].blockers) {
            lists[i] = *block[i].blockers;
            start[i].blockers = &lists[i];
        }
        counted_host_make(&counted, host, host);
        counted.host.occluded = record_rays;
        block[i].host = &counted.host;
        decisions[i] = bench.by[GOING]->refine(bench.by[GOING]->state, &block[i]);
        block[i].host = host;
        bench.whole.rays += (double)counted.rays;
        if (counted.rays == 0) {
            of_without[free_count] = lists[i];
            without[free_count] = start[i];
            if (start[i].blockers)
                without[free_count].blockers = &of_without[free_count];
            wanted[free_count++] = decisions[i];
        }
    }
    memcpy(bench.wanted, decisions, (size_t)count * sizeof *decisions);
    hold_by_all(&bench.whole, start, count);
    bench.packet_count = 0;
    memcpy(bench.wanted, wanted, sizeof wanted);
    hold_by_all(&bench.free_of_rays, without, free_count);
    bench.blocks++;
}

/* ---- the report */

/* The median of the ratios, the least and the largest. */
static void compare_turns(const double *of, const double *over, double ratio[TURNS])
{
    for (int t = 0; t < TURNS; t++)
        ratio[t] = of[t] / over[t];
    qsort(ratio, TURNS, sizeof *ratio, compare_numbers);
}

static void print_work(const char *scene, const char *what, const struct work *w)
{
    const int over = bench.by[HAND] ? HAND : FLAT;
    for (int who = 0; who < ASKED; who++) {
        double ratio[TURNS], sorted[TURNS];
        if ((!bench.by[who] && who != BARE) || (who == BARE && w->rays <= 0))
            continue;
        memcpy(sorted, w->seconds[who], sizeof sorted);
        qsort(sorted, TURNS, sizeof *sorted, compare_numbers);
        compare_turns(w->seconds[who], w->seconds[over], ratio);
        printf("%-12s %-11s %9.0f  %-11s %7.1f ns each  %.2f of %s (%.2f to %.2f)", scene, what,
               w->pairs / TURNS, names[who], 1e9 * sorted[TURNS / 2] * TURNS / w->pairs,
               ratio[TURNS / 2], names[over], ratio[0], ratio[TURNS - 1]);
        if (w->rays > 0 && who != BARE) {
            compare_turns(w->seconds[who], w->seconds[BARE], ratio);
            printf("  %.2f of bare Embree (%.2f to %.2f)", ratio[TURNS / 2], ratio[0],
                   ratio[TURNS - 1]);
        }
        putchar('\n');
    }
}

static int solve_once(const char *path, const struct scene *scene, const struct refiner *asking)
{
    const char *pairs = getenv("PAIRS");
    const struct solve_options options = {.tolerance = 1e-3,
                                          .iterations = 1000,
                                          .threads = 1,
                                          .limits.pairs = pairs ? strtoull(pairs, NULL, 10) : 0};
    struct solve s;
    const char *cause = "";
    bench.solve = &s;
    bench.scene = NULL;
    bench.blocks = bench.turn;
    if (solve_open(&s, scene, &options, &cause) < 0
        || (solve_run(&s, asking, &cause) < 0 && !(pairs && s.refinement.met))) {
        fprintf(stderr, "wave_times: %s: %s\n", path, cause);
        return 2;
    }
    solve_close(&s);
    if (bench.scene) {
        rtcReleaseScene(bench.scene);
        rtcReleaseDevice(bench.device);
    }
    return 0;
}

static void read_clock(void)
{
    bench.clock = INFINITY;
    for (int i = 0; i < 1000; i++) {
        const double began = now(), took = now() - began;
        bench.clock = took < bench.clock ? took : bench.clock;
    }
}

static int run(const char *oracle, const char *path, char *const *settings, int setting_count)
{
    static const struct {
        enum who who;
        enum release release;
    } opened[] = {
        {HAND, RELEASE_HAND}, {FLAT, RELEASE_FLAT}, {WAVE, RELEASE_WAVE}, {GOING, RELEASE_DAG}};
    const struct scene_options as_written = {.quiet = 1};
    struct scene scene;
    const char *slash = strrchr(path, '/');
    struct RTCRay16 *packets = bench.packets, *fresh = bench.fresh;
    int status = 0;
    memset(&bench, 0, sizeof bench);
    bench.packets = packets;
    bench.fresh = fresh;
    read_clock();
    for (size_t k = 0; k < sizeof opened / sizeof *opened; k++) {
        if (opened[k].who == HAND && !oracles_by_hand(oracle))
            continue;
        struct refiner *r = bench.by[opened[k].who] = oracles_open(oracle, opened[k].release);
        if (!r || oracles_set(r, settings, setting_count) < 0)
            return 2;
    }
    if (scene_read(&scene, path, &as_written) < 0)
        return 2;
    struct refiner asking = *bench.by[WAVE];
    asking.wave = spy_wave;
    for (bench.turn = 0; bench.turn < TURNS && status == 0; bench.turn++)
        status = solve_once(path, &scene, &asking);
    print_work(slash ? slash + 1 : path, "all pairs", &bench.whole);
    print_work(slash ? slash + 1 : path, "no ray cast", &bench.free_of_rays);
    scene_free(&scene);
    for (int k = 0; k < ALL; k++)
        refiner_close(bench.by[k]);
    if (bench.different)
        printf("%d decisions differ\n", bench.different);
    fflush(stdout);
    return status ? status : bench.different > 0;
}

int main(int count, char **argument)
{
    int scenes = 1, result = 0;
    while (scenes + 1 < count && !strchr(argument[scenes + 1], '='))
        scenes++;
    if (scenes < 2) {
        fputs("usage: wave_times ORACLE SCENE... [NAME=VALUE...]\n", stderr);
        return 2;
    }
    bench.packets = aligned_alloc(64, PACKETS_MOST * sizeof *bench.packets);
    bench.fresh = aligned_alloc(64, PACKETS_MOST * sizeof *bench.fresh);
    if (!bench.packets || !bench.fresh)
        return 2;
    for (int i = 2; i <= scenes && result == 0; i++)
        result = run(argument[1], argument[i], argument + scenes + 1, count - scenes - 1);
    free(bench.packets);
    free(bench.fresh);
    return result;
}
