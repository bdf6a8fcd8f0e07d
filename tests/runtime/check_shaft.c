/* check_shaft.c - precise answers of the shaft are true, whatever segment is tried; candidates are
 * the same inherited or found anew; exact visible parts against closed forms.
 *
 * A ray caster in single precision may find a hit where a segment ends within its rounding of a
 * face that it does not cross. Such an end lies less than GRAZE of ray_offset from the face's
 * plane; segments with one are put to the test in double precision alone, and counted.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "visibility/candidates.h"
#include "scene/make_scene.h"
#include "scene/read_scene.h"
#include "visibility/rays.h"
#include "engine/refine.h"
#include "oracles.h"
#include "suite.h"
#include "tools/cluster_visibility.h"
#include "tools/exact_visibility.h"
#include "tools/extinction.h"
#include "tools/presume_visible.h"
#include "tools/feature_size.h"
#include "tools/reference.h"
#include "tools/shaft.h"
#include "tools/support_planes.h"
#include "tools/trace_reference.h"
#include "tools/visibility.h"
#include "util/spared_rays.h"
#include "terms/visibility_error.h"

#define GRAZE (1 / 16.0)

static double random_unit(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * (1 / 9007199254740992.0);
}

static double between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * random_unit(seed);
}

/* ---- scenes */

enum { KINDS = 11, LOADED = 8 };
static const char *const kinds[KINDS] = {
    "room with boxes", "rotated room", "quads",   "triangles", "tiles", "wedges",
    "bent quads",      "far room",     "cornell", "maze_8",    "room"};

/* A closed box that stands on z, front outside. */
static void add_box(struct scene *s, double x, double y, double z, double a, double b, double c)
{
    made_quad(s, 0, x, y, z, 0, b, 0, a, 0, 0);
    made_quad(s, 0, x, y, z + c, a, 0, 0, 0, b, 0);
    made_quad(s, 0, x, y, z, a, 0, 0, 0, 0, c);
    made_quad(s, 0, x, y + b, z, 0, 0, c, a, 0, 0);
    made_quad(s, 0, x, y, z, 0, 0, c, 0, b, 0);
    made_quad(s, 0, x + a, y, z, 0, b, 0, 0, 0, c);
}

static void rotate(struct scene *s, uint64_t *seed)
{
    double turn[3];
    for (int k = 0; k < 3; k++)
        turn[k] = between(seed, 0, 6);
    for (int k = 0; k < 3; k++)
        for (uint32_t i = 0; i < s->face_count; i++)
            for (uint32_t j = 0; j < s->faces[i].vertices; j++) {
                double *v = s->faces[i].vertex[j], a = v[k], b = v[(k + 1) % 3];
                v[k] = cos(turn[k]) * a - sin(turn[k]) * b;
                v[(k + 1) % 3] = sin(turn[k]) * a + cos(turn[k]) * b;
            }
}

static void make(struct scene *s, int kind, uint64_t *seed)
{
    static const uint32_t wall[6] = {0, 0, 0, 0, 0, 0};
    made_open(s);
    made_material(s, 0.5, 1);
    int i, k;
    switch (kind) {
    case 0:
    case 1:
    case 7:
        made_room(s, wall, 4, 5, 3);
        for (i = 0; i < 5; i++) {
            /* One at a time: compilers differ in which argument of a call is computed first. */
            double c = between(seed, 0.1, 1), b = between(seed, 0.1, 1), a = between(seed, 0.1, 1);
            double z = i < 3 ? 0 : between(seed, 0, 2);
            double y = between(seed, 0, 4), x = between(seed, 0, 3);
            add_box(s, x, y, z, a, b, c);
        }
        add_box(s, 0, 0, 0, 0.5, 1, 1); /* flush with two walls and the floor */
        if (kind > 0)
            rotate(s, seed);
        for (i = 0; i < (int)s->face_count && kind == 7; i++)
            for (k = 0; k < 4; k++)
                s->faces[i].vertex[k][0] += 3000; /* a thousand times its size from the origin */
        break;
    case 6: /* as bent as a quad may be that is read in one piece */
        for (i = 0; i < 40; i++) {
            double v[9], p[4][3];
            for (k = 0; k < 9; k++)
                v[k] = k < 3 ? random_unit(seed) : 0.6 * (random_unit(seed) - 0.5);
            for (k = 0; k < 3; k++) {
                p[0][k] = v[k];
                p[1][k] = v[k] + v[3 + k];
                p[3][k] = v[k] + v[6 + k];
                p[2][k] = v[k] + v[3 + k] + v[6 + k] + 5e-5 * (random_unit(seed) - 0.5);
            }
            made_face(s, 0, 4, (const double(*)[3])p);
        }
        break;
    case 2:
        for (i = 0; i < 60; i++) {
            double v[9];
            for (k = 0; k < 9; k++)
                v[k] = k < 3 ? random_unit(seed) : 0.5 * (random_unit(seed) - 0.5);
            if (i % 4 == 0)
                v[2] = 0.25, v[5] = v[8] = 0; /* in the plane z = 1/4 */
            made_quad(s, 0, v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]);
        }
        break;
    case 3:
        for (i = 0; i < 60; i++) {
            double p[3][3];
            for (k = 0; k < 9; k++)
                p[k / 3][k % 3] =
                    k < 3 ? random_unit(seed) : p[0][k % 3] + 0.6 * (random_unit(seed) - 0.5);
            made_face(s, 0, 3, (const double(*)[3])p);
        }
        break;
    /* a tiled box: neighbours in one plane, T-junctions, and walls that stand on the lines
     * between tiles */
    case 4:
        for (i = 0; i < 16; i++) {
            made_quad(s, 0, i % 4, i / 4, 0, 1, 0, 0, 0, 1, 0);
            made_quad(s, 0, i % 4, i / 4, 4, 0, 1, 0, 1, 0, 0);
            made_quad(s, 0, i % 4, 0, i / 4, 0, 0, 1, 1, 0, 0);
            made_quad(s, 0, i % 4, 4, i / 4, 1, 0, 0, 0, 0, 1);
        }
        made_quad(s, 0, 0, 0, 0, 0, 4, 0, 0, 0, 4);
        made_quad(s, 0, 4, 0, 0, 0, 0, 4, 0, 4, 0);
        /* a wall without thickness, both its sides listed */
        made_quad(s, 0, 1, 2, 0, 2, 0, 0, 0, 0, 2);
        made_quad(s, 0, 1, 2, 0, 0, 0, 2, 2, 0, 0);
        s->faces[s->face_count - 1].back = 1;
        s->faces[s->face_count - 1].input = s->faces[s->face_count - 2].input;
        break;
    /* pairs that meet at an edge, at angles down to 6 degrees, and faces that touch their ends */
    default:
        for (i = 0; i < 20; i++) {
            double x = 2 * i, angle = between(seed, 0.1, 3.0);
            made_quad(s, 0, x, 0, 0, 1, 0, 0, 0, 1, 0);
            made_quad(s, 0, x, 0, 0, 0, cos(angle), sin(angle), 1, 0, 0);
            made_quad(s, 0, x, 1, 0, 1, 0, 0, 0, 0, between(seed, -1, 1));
            made_quad(s, 0, x + 1, 0, 0, 0, 1, 0, 0, 0, 1);
            made_quad(s, 0, x, 0, 2, 0, 1, 0, between(seed, 0.5, 1), 0, 0);
        }
        rotate(s, seed);
        break;
    }
}

struct world {
    struct scene scene;
    struct hierarchy h;
    struct rays *rays;
    const struct host *host;
    int loaded;
};

static void start_world(struct world *w, int threads)
{
    double *zero = calloc(w->scene.face_count, sizeof *zero);
    ck_assert_int_eq(hierarchy_build(&w->h, w->scene.faces, w->scene.face_count), 0);
    const char *cause;
    w->rays = rays_open(&w->h, zero, zero, threads, &cause);
    ck_assert_ptr_nonnull(w->rays);
    w->host = rays_host(w->rays);
    free(zero);
}

static void open_world(struct world *w, int kind, uint64_t *seed, double scale)
{
    memset(w, 0, sizeof *w);
    if (kind < LOADED) {
        make(&w->scene, kind, seed);
    } else {
        struct scene_options quiet = {0, 1};
        char path[64];
        snprintf(path, sizeof path, "examples/scenes/%s.obj", kinds[kind]);
        ck_assert_int_eq(scene_read(&w->scene, path, &quiet), 0);
        w->loaded = 1;
    }
    made_scale(&w->scene, scale);
    start_world(w, 2);
}

static void close_world(struct world *w)
{
    rays_close(w->rays);
    hierarchy_free(&w->h);
    if (w->loaded)
        scene_free(&w->scene);
    else
        made_close(&w->scene);
}

/* A random child, made when there is none. */
static uint32_t descend(struct world *w, uint32_t e, uint64_t *seed)
{
    ck_assert_int_eq(hierarchy_split(&w->h, e), 0);
    return w->h.elements[e].child + (uint32_t)(4 * random_unit(seed));
}

static void random_pair(struct world *w, uint64_t *seed, int deepest, uint32_t pair[2])
{
    for (int i = 0; i < 2; i++) {
        pair[i] = w->h.face_element[(uint32_t)(random_unit(seed) * w->h.face_count)];
        for (int n = (int)(random_unit(seed) * (deepest + 1)); n > 0; n--)
            pair[i] = descend(w, pair[i], seed);
    }
}

/* ---- segments */

/* A point of the part of e in front of other's plane, moved off e as rays are; `sharp`: mostly near
 * the border. Returns 0 when it lies behind. Of a bent quad, a point between the corners of that
 * part: it has no plane to be in. */
static int random_point(const struct element *e, const struct element *other, double offset,
                        int sharp, uint64_t *seed, double p[3])
{
    double u[POLYGON_MAX], sum = 0, h = 0, bend = 0;
    for (int i = 0; i < e->vertices; i++)
        bend = fmax(bend, fabs(height3(e->vertex[i], e->centre, e->normal)));
    struct polygon part;
    if (bend > 1e-9 * e->radius) {
        polygon_clip(&part, (const double(*)[3])e->vertex, e->vertices, other->centre,
                     other->normal);
    } else {
        part.n = e->vertices;
        memcpy(part.v, e->vertex, sizeof e->vertex);
    }
    if (part.n == 0)
        return 0;
    for (int i = 0; i < part.n; i++) {
        u[i] = random_unit(seed);
        if (sharp)
            u[i] *= u[i] * u[i] * u[i];
        sum += u[i];
    }
    for (int k = 0; k < 3; k++) {
        p[k] = 0;
        for (int i = 0; i < part.n; i++)
            p[k] += u[i] / sum * part.v[i][k];
    }
    if (!(bend > 1e-9 * e->radius))
        h = height3(p, other->centre, other->normal);
    for (int k = 0; k < 3; k++)
        p[k] += offset * e->normal[k];
    return h >= 0;
}

static int random_segment(const struct world *w, const uint32_t pair[2], int sharp, uint64_t *seed,
                          struct segment *g)
{
    const struct element *r = &w->h.elements[pair[0]], *s = &w->h.elements[pair[1]];
    return random_point(r, s, w->host->ray_offset, sharp, seed, g->from)
           & random_point(s, r, w->host->ray_offset, sharp, seed, g->to);
}

/* Does the segment cross a triangle? In double precision; `slack` (m) beyond the border is in. */
static int crosses_triangle(const struct segment *g, const double *a, const double *b,
                            const double *c, double slack, double thin)
{
    const double *v[3] = {a, b, c};
    double e[3], f[3], n[3], p[3];
    sub3(e, b, a);
    sub3(f, c, a);
    cross3(n, e, f);
    double size = length3(n);
    for (int k = 0; k < 3; k++)
        n[k] /= size;
    double from = height3(g->from, a, n);
    double to = height3(g->to, a, n);
    if (!(from > thin && to < -thin) && !(from < -thin && to > thin))
        return 0;
    for (int k = 0; k < 3; k++)
        p[k] = g->from[k] + from / (from - to) * (g->to[k] - g->from[k]);
    for (int i = 0; i < 3; i++) {
        sub3(e, v[(i + 1) % 3], v[i]);
        double side[3];
        cross3(side, n, e);
        if (height3(p, v[i], side) < -slack * length3(side))
            return 0;
    }
    return 1;
}

static int crosses_any(const struct world *w, const struct segment *g, double slack, double thin)
{
    for (uint32_t i = 0; i < w->h.face_count; i++) {
        const struct face *f = &w->h.faces[i];
        const double(*v)[3] = (const double(*)[3])f->vertex;
        if (f->back)
            continue;
        if (f->vertices == 3 ? crosses_triangle(g, v[0], v[1], v[2], slack, thin)
                             : crosses_triangle(g, v[0], v[1], v[3], slack, thin)
                                   || crosses_triangle(g, v[2], v[3], v[1], slack, thin))
            return 1;
    }
    return 0;
}

/* Does an end lie so near to a face's plane that single precision may take it for the other
 * side? */
static int grazes(const struct world *w, const struct segment *g)
{
    for (uint32_t i = 0; i < w->h.face_count; i++) {
        const struct element *e = &w->h.elements[w->h.face_element[i]];
        if (fabs(height3(g->from, e->centre, e->normal)) < GRAZE * w->host->ray_offset
            || fabs(height3(g->to, e->centre, e->normal)) < GRAZE * w->host->ray_offset)
            return 1;
    }
    return 0;
}

static enum shaft_answer ask(const struct world *w, const uint32_t pair[2], struct blockers *list)
{
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = &w->h.elements[pair[0]];
    d.emitter = &w->h.elements[pair[1]];
    d.host = w->host;
    d.blockers = list;
    enum shaft_answer answer = tool_shaft(&d);
    if (answer == SHAFT_VISIBLE || answer == SHAFT_INVISIBLE) {
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_EXACT);
        ck_assert(tool_visibility(&d, 1024)
                  == (answer == SHAFT_VISIBLE ? VISIBILITY_ALL : VISIBILITY_NONE));
        ck_assert(term_visibility_error(&d) == 0);
        /* known so well, it needs no list, but for the pairs below */
        struct blockers none = {0};
        d.blockers = &none;
        ck_assert_int_eq(tool_shaft(&d), answer);
        ck_assert_int_eq(none.known, BLOCKERS_UNKNOWN);
        ck_assert_int_eq(none.wanted, 1);
        ck_assert(!list || !list->wanted);
    } else {
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_ABSENT);
    }
    return answer;
}

/* Nobody may prove a precise answer wrong: not the ray caster, not a test in double precision.
 * And there must be many. */
START_TEST(test_truth)
{
    /* Pairs that face each other: at least so many in a thousand are known to be visible,
     * invisible. */
    static const int least[KINDS][2] = {{400, 15}, {400, 30}, {150, 80}, {120, 60},
                                        {500, 50}, {50, 200}, {80, 0},   {400, 30},
                                        {250, 15}, {50, 250}, {200, 50}};
    enum { BATCH = SEGMENTS_MAX, BATCHES = 4, DOUBLE = 2, WORLDS = 4 };
    const int pairs = thorough() ? 12000 : 3000;
    uint64_t seed = 1 + (uint64_t)_i, segments = 0, grazing[2] = {0, 0};
    int count[4] = {0, 0, 0, 0}, lies = 0, worlds = _i < LOADED ? WORLDS : 1, n, facing = 0;
    for (int world = 0; world < worlds; world++) {
        struct world w;
        open_world(&w, _i, &seed, 1);
        for (int i = 0; i < pairs / worlds; i++) {
            uint32_t pair[2];
            random_pair(&w, &seed, i % 2 ? 3 : 6, pair);
            struct discussion d;
            memset(&d, 0, sizeof d);
            d.receiver = &w.h.elements[pair[0]];
            d.emitter = &w.h.elements[pair[1]];
            d.host = w.host;
            if (tool_support_planes(&d) == SUPPORT_PLANES_AWAY)
                continue;
            facing++;
            enum shaft_answer answer = ask(&w, pair, NULL);
            count[answer]++;
            if (answer != SHAFT_VISIBLE && answer != SHAFT_INVISIBLE)
                continue;
            struct segment g[BATCH];
            int tries;
            for (int batch = 0; batch < BATCHES; batch++) {
                int sharp = batch & 1;
                for (n = tries = 0; n < BATCH && tries < 16 * BATCH; tries++)
                    n += random_segment(&w, pair, sharp, &seed, &g[n]);
                if (n == 0)
                    break;
                uint64_t hit = w.host->occluded(w.host, n, g);
                segments += (uint64_t)n;
                while (n-- > 0) {
                    int met = (int)(hit >> n & 1), wrong = 0;
                    if (answer == SHAFT_VISIBLE) {
                        if (met && grazes(&w, &g[n]))
                            grazing[sharp]++;
                        else
                            wrong = met;
                        if (n < DOUBLE || met)
                            wrong |= crosses_any(&w, &g[n], 0, w.host->ray_offset / 8192);
                    } else {
                        wrong = !met
                                || (n < DOUBLE
                                    && !crosses_any(&w, &g[n], w.host->ray_offset / 8192, 0));
                    }
                    lies += wrong;
                    if (wrong && lies < 5)
                        printf("%s: %s is a lie: elements %u and %u, (%.17g %.17g %.17g) to (%.17g "
                               "%.17g %.17g) met %d\n",
                               kinds[_i], answer == SHAFT_VISIBLE ? "visible" : "invisible",
                               pair[0], pair[1], g[n].from[0], g[n].from[1], g[n].from[2],
                               g[n].to[0], g[n].to[1], g[n].to[2], met);
                }
            }
        }
        close_world(&w);
    }
    printf("%-16s %5d pairs face: %2d %% visible, %2d %% invisible, %2d %% uncertain, %2d %% too "
           "complex; %.2g segments, %llu and %llu grazing, %d lies\n",
           kinds[_i], facing, 100 * count[0] / facing, 100 * count[1] / facing,
           100 * count[2] / facing, 100 * count[3] / facing, (double)segments,
           (unsigned long long)grazing[0], (unsigned long long)grazing[1], lies);
    fflush(stdout);
    ck_assert_int_eq(lies, 0);
    ck_assert_int_ge(1000 * count[SHAFT_VISIBLE], least[_i][0] * facing);
    ck_assert_int_ge(1000 * count[SHAFT_INVISIBLE], least[_i][1] * facing);
    ck_assert(grazing[0] * 50000 <= segments && grazing[1] * 1000 <= segments);
}
END_TEST

static int same_list(const struct blockers *a, const struct blockers *b)
{
    return a->count == b->count && a->covered == b->covered
           && (a->count > BLOCKERS_MAX
               || memcmp(a->face, b->face, (size_t)a->count * sizeof *a->face) == 0);
}

/* A list that came down from pair to pair is the list made anew, either way round, and so is the
 * answer. What the host lists need not be held against the shaft again (host.exact). */
START_TEST(test_inherited)
{
    enum { DESCENTS = 500, LEVELS = 8 };
    uint64_t seed = 100 + (uint64_t)_i;
    int compared = 0, kept = 0;
    struct world w;
    open_world(&w, _i, &seed, 1);
    for (int i = 0; i < DESCENTS; i++) {
        struct blockers down = {0};
        uint32_t pair[2];
        random_pair(&w, &seed, 0, pair);
        for (int level = 0; level <= LEVELS; level++) {
            struct blockers anew = {0}, back = {0};
            uint32_t turned[2];
            int inherited = down.known == BLOCKERS_INHERITED;
            turned[0] = pair[1];
            turned[1] = pair[0];
            enum shaft_answer answer = ask(&w, pair, &anew);
            ck_assert_int_eq(ask(&w, turned, &back), answer);
            ck_assert_int_eq(ask(&w, pair, &down), answer);
            ck_assert(same_list(&anew, &back) && same_list(&anew, &down));
            struct blockers again = anew;
            if (w.host->exact && anew.count <= BLOCKERS_MAX) {
                again.known = BLOCKERS_INHERITED;
                ck_assert_int_eq(ask(&w, pair, &again), answer);
                ck_assert(same_list(&anew, &again));
            }
            compared += inherited;
            kept += inherited && anew.count > 0;
            down.known = down.handed ? BLOCKERS_INHERITED : BLOCKERS_UNKNOWN;
            int split = (int)(3 * random_unit(&seed));
            if (split != 1)
                pair[0] = descend(&w, pair[0], &seed);
            if (split != 0)
                pair[1] = descend(&w, pair[1], &seed);
        }
    }
    printf("%-16s %d lists inherited, %d of them not empty\n", kinds[_i], compared, kept);
    ck_assert_int_gt(compared, _i == 6 ? -1 : 500); /* bent quads hand nothing on */
    ck_assert_int_gt(kept, _i == 6 ? -1 : 50);
    close_world(&w);
}
END_TEST

/* All lengths times a power of two: the same lists and answers. */
START_TEST(test_scale)
{
    static const int power[2] = {-20, 17};
    for (int k = 0; k < 2; k++) {
        uint64_t seed[2] = {200 + (uint64_t)_i, 200 + (uint64_t)_i};
        struct world w[2];
        open_world(&w[0], _i, &seed[0], 1);
        open_world(&w[1], _i, &seed[1], ldexp(1, power[k]));
        for (int i = 0; i < 700; i++) {
            struct blockers list[2] = {{0}, {0}};
            uint32_t pair[2][2];
            random_pair(&w[0], &seed[0], 4, pair[0]);
            random_pair(&w[1], &seed[1], 4, pair[1]);
            ck_assert_int_eq(ask(&w[0], pair[0], &list[0]), ask(&w[1], pair[1], &list[1]));
            ck_assert(same_list(&list[0], &list[1]));
        }
        close_world(&w[0]);
        close_world(&w[1]);
    }
}
END_TEST

/* ---- through the refinement loop */

static struct refiner *flat_peer(void)
{
    struct refiner *r = oracles_open("tests/runtime/peer.dag", RELEASE_FLAT);
    ck_assert_ptr_nonnull(r);
    return r;
}

/* A refiner that looks at what it is given, and in `forget` mode takes it away. */
struct spy {
    struct refiner *refiner;
    int forget;
    uint64_t inherited;
};

static enum decision spy(const void *state, struct discussion *d)
{
    struct spy *s;
    memcpy(&s, state, sizeof s);
    if (d->blockers->known == BLOCKERS_INHERITED) {
#pragma omp atomic
        s->inherited++;
    }
    if (s->forget)
        d->blockers = NULL;
    return s->refiner->refine(s->refiner->state, d);
}

/* Links, their order and their values are the same whether lists are handed on or not, for any
 * number of threads, interpreted and compiled. */
START_TEST(test_refined)
{
    static const struct {
        int flat, threads, forget;
    } ways[] = {
        {0, 1, 0}, {1, 2, 1}, {0, 1, 1}, {1, 2, 0}, {0, 2, 0}, {1, 1, 1},
    };
    struct refinement first = {0};
    struct world w[2];
    for (size_t i = 0; i < (thorough() ? sizeof ways / sizeof *ways : 2); i++) {
        struct spy s = {ways[i].flat ? flat_peer()
                                     : interpreted("tests/runtime/peer.dag", NULL, NULL),
                        ways[i].forget, 0},
                   *at = &s;
        struct refiner watched = {.refine = spy, .state = &at};
        struct world *now = &w[i > 0];
        uint64_t seed = 7;
        ck_assert_ptr_nonnull(s.refiner);
        open_world(now, 10, &seed, 1); /* the room */
        for (uint32_t k = 0; k < now->h.count; k++)
            now->h.elements[k].radiosity = 1;
        struct refinement r;
        ck_assert_int_eq(
            refinement_open(&r, &now->h, rays_host(now->rays), &watched, ways[i].threads), 0);
        ck_assert_int_eq(refinement_start(&r), 0);
        ck_assert_int_gt((int)r.link_count, 10000);
        for (uint32_t k = 1; k < r.pool_count; k++)
            ck_assert_uint_eq(r.pool[k].references, 0); /* every list was released */
        if (i == 0) {
            printf("refined: %zu links from %llu discussions, %llu with an inherited list, %u "
                   "lists at once, %llu rays\n",
                   r.link_count, (unsigned long long)r.pairs, (unsigned long long)s.inherited,
                   r.pool_count, (unsigned long long)rays_count(now->rays).rays);
            fflush(stdout);
            ck_assert(s.inherited * 5 > r.pairs);
            first = r;
        } else {
            ck_assert_uint_eq(r.link_count, first.link_count);
            ck_assert(memcmp(r.links, first.links, r.link_count * sizeof *r.links) == 0);
            refinement_close(&r);
            close_world(now);
        }
        refiner_close(s.refiner);
    }
    refinement_close(&first);
    close_world(&w[0]);
}
END_TEST

/* ---- visibility by parts and by rays */

/* Two unit squares, facing each other across the distance 1, and what a test puts between. */
static void open_squares(struct world *w)
{
    memset(w, 0, sizeof *w);
    made_open(&w->scene);
    made_material(&w->scene, 0.5, 1);
    made_quad(&w->scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&w->scene, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0);
}

static struct discussion discuss_faces(const struct world *w, uint32_t r, uint32_t s)
{
    struct discussion d;
    memset(&d, 0, sizeof d);
    d.receiver = &w->h.elements[w->h.face_element[r]];
    d.emitter = &w->h.elements[w->h.face_element[s]];
    d.host = w->host;
    return d;
}

/* V by the exact tool, both ways; frees the world. */
static double exact(struct world *w, enum exact_visibility_answer *answer)
{
    struct discussion d, back;
    start_world(w, 1);
    d = discuss_faces(w, 0, 1);
    back = discuss_faces(w, 1, 0);
    *answer = tool_exact_visibility(&d);
    ck_assert_int_eq(tool_exact_visibility(&back), *answer);
    ck_assert(d.terms.visibility == back.terms.visibility);
    ck_assert(d.terms.visibility_level
              == (*answer == EXACT_VISIBILITY_TOO_COMPLEX ? VISIBILITY_RAYS_64 : VISIBILITY_EXACT));
    close_world(w);
    return d.terms.visibility;
}

/* By symmetry each quarter of the middle plane hides a quarter of the light, V F = 3/4 F =
 * .1498686718; any partition of it hides all, each part once; two parts of it hide what the two
 * do. */
START_TEST(test_partition)
{
    enum exact_visibility_answer answer;
    uint64_t seed = 3;
    for (int i = 0; i < 4; i++) {
        struct world w;
        open_squares(&w);
        made_quad(&w.scene, 0, i % 2 * 0.5, i / 2 * 0.5, 0.5, 0.5, 0, 0, 0, 0.5, 0);
        ck_assert_double_eq_tol(exact(&w, &answer), 0.75, 1e-6);
        ck_assert_int_eq(answer, EXACT_VISIBILITY_PARTIAL);
        for (int j = 0; j < i; j++) { /* two quarters, side by side or across */
            open_squares(&w);
            made_quad(&w.scene, 0, i % 2 * 0.5, i / 2 * 0.5, 0.5, 0.5, 0, 0, 0, 0.5, 0);
            made_quad(&w.scene, 0, j % 2 * 0.5, j / 2 * 0.5, 0.5, 0, 0.5, 0, 0.5, 0, 0);
            ck_assert_double_eq_tol(exact(&w, &answer), 0.5, 2e-6);
        }
    }
    ck_assert_double_eq_tol(0.75 * 0.1998248956983874, 0.1498686718, 1e-10);
    for (int round = 0; round < 3; round++) {
        double x = between(&seed, 0.1, 0.9), y = between(&seed, 0.1, 0.9), hidden = 0, pair = 0;
        for (int i = 0; i < 4; i++) {
            double a = i % 2 ? x : 0, b = i % 2 ? 1 : x, c = i / 2 ? y : 0, e = i / 2 ? 1 : y;
            struct world w;
            open_squares(&w);
            made_quad(&w.scene, 0, a, c, 0.5, b - a, 0, 0, 0, e - c, 0);
            double v = exact(&w, &answer);
            hidden += 1 - v;
            pair += i < 2 ? 1 - v : 0;
        }
        ck_assert_double_eq_tol(hidden, 1, 2e-6);
        {
            struct world w;
            open_squares(&w);
            made_quad(&w.scene, 0, 0, 0, 0.5, x, 0, 0, 0, y, 0);
            made_quad(&w.scene, 0, x, 0, 0.5, 1 - x, 0, 0, 0, y, 0);
            ck_assert_double_eq_tol(1 - exact(&w, &answer), pair, 2e-6);
        }
    }
    /* the whole plane; a neighbour of it, which only touches the shaft; and nothing */
    for (int i = 0; i < 3; i++) {
        struct world w;
        open_squares(&w);
        if (i < 2)
            made_quad(&w.scene, 0, i, 0, 0.5, 1, 0, 0, 0, 1, 0);
        ck_assert(exact(&w, &answer) == (i > 0));
        ck_assert_int_eq(answer, i ? EXACT_VISIBILITY_ALL : EXACT_VISIBILITY_NONE);
    }
    {
        struct world w;
        open_squares(&w);
        for (int i = 0; i < 3; i++)
            made_quad(&w.scene, 0, 0.3 * i, 0.3, 0.5, 0.2, 0, 0, 0, 0.2, 0);
        (void)exact(&w, &answer);
        ck_assert_int_eq(answer, EXACT_VISIBILITY_TOO_COMPLEX);
    }
}
END_TEST

/* One and two tilted blockers anywhere, against 400,000 random segments weighted by what they
 * carry: within four and a half standard deviations (significance 4e-5 for the six cases together;
 * the seed is fixed). */
START_TEST(test_random_parts)
{
    const int segments = thorough() ? 400000 : 100000;
    uint64_t seed = 40 + (uint64_t)_i;
    double p[3][3], all = 0, seen = 0, square[2] = {0, 0};
    struct world w;
    open_squares(&w);
    int f;
    for (f = 0; f <= _i % 2; f++) {
        for (int k = 0; k < 9; k++)
            p[k / 3][k % 3] = between(&seed, 0.1, 0.9);
        made_face(&w.scene, 0, 3, (const double(*)[3])p);
    }
    start_world(&w, 1);
    for (int i = 0; i < segments; i++) {
        struct segment g = {{random_unit(&seed), random_unit(&seed), 0},
                            {random_unit(&seed), random_unit(&seed), 1}};
        double d[3];
        sub3(d, g.to, g.from);
        double weight = 1 / (dot3(d, d) * dot3(d, d));
        all += weight;
        for (f = 2; f < (int)w.scene.face_count; f++)
            if (crosses_triangle(&g, w.scene.faces[f].vertex[0], w.scene.faces[f].vertex[1],
                                 w.scene.faces[f].vertex[2], 0, 0))
                break;
        if (f == (int)w.scene.face_count)
            seen += weight;
        square[f == (int)w.scene.face_count] += weight * weight;
    }
    double v = seen / all; /* of a ratio of sums: sum w^2 (I - V)^2 */
    double error = 4.5 * sqrt(square[1] * (1 - v) * (1 - v) + square[0] * v * v) / all;
    rays_close(w.rays);
    hierarchy_free(&w.h);
    enum exact_visibility_answer answer;
    v = exact(&w, &answer);
    printf("%d blockers: V = %.6f, by segments %.6f +- %.6f\n", 1 + _i % 2, v, seen / all, error);
    ck_assert_int_eq(answer, EXACT_VISIBILITY_PARTIAL);
    ck_assert_double_eq_tol(v, seen / all, error);
}
END_TEST

/* Point values of a penumbra as limits of a tiny receiver: source a unit square at z = 2,
 * occluder of side .75 at z = 1. */
START_TEST(test_penumbra)
{
    static const double at[] = {0.25, 0.5, 0.75, 1, 1.5};
    static const double right[] = {0, 0.0189169153, 0.0337198400, 0.0405845563, 0.0326632655};
    static const int power[] = {0, -20, 17};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        double v[3];
        for (int k = 0; k < 3; k++) {
            const double side = 1e-5;
            struct world w;
            memset(&w, 0, sizeof w);
            made_open(&w.scene);
            made_material(&w.scene, 0.5, 1);
            made_quad(&w.scene, 0, at[i] - side / 2, -side / 2, 0, side, 0, 0, 0, side, 0);
            made_quad(&w.scene, 0, -0.5, -0.5, 2, 0, 1, 0, 1, 0, 0);
            made_quad(&w.scene, 0, -0.375, -0.375, 1, 0.75, 0, 0, 0, 0.75, 0);
            made_scale(&w.scene, ldexp(1, power[k]));
            start_world(&w, 1);
            struct discussion d;
            d = discuss_faces(&w, 0, 1);
            ck_assert(tool_exact_visibility(&d) != EXACT_VISIBILITY_TOO_COMPLEX);
            v[k] = d.terms.visibility * polygon_factor(d.receiver, d.emitter, 1);
            /* the first is where the umbra ends */
            ck_assert_double_eq_tol(v[k], right[i], i ? 1e-9 : 1e-6);
            d = discuss_faces(&w, 0, 1);
            (void)tool_visibility(&d, 1024);
            ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_RAYS_1024);
            ck_assert_double_eq_tol(d.terms.visibility * polygon_factor(d.receiver, d.emitter, 1),
                                    right[i], 1e-3);
            close_world(&w);
        }
        ck_assert(v[1] == v[0] && v[2] == v[0]);
    }
}
END_TEST

/* More rays, more levels; sigma_V is what the formula says and about what the rays do. */
START_TEST(test_levels)
{
    static const struct {
        int asked, cast;
        enum visibility_level level;
    } way[] = {
        {4, 4, VISIBILITY_RAYS_4},          {5, 16, VISIBILITY_RAYS_16},
        {64, 64, VISIBILITY_RAYS_64},       {65, 256, VISIBILITY_RAYS_256},
        {256, 256, VISIBILITY_RAYS_256},    {1000, 1024, VISIBILITY_RAYS_1024},
        {1024, 1024, VISIBILITY_RAYS_1024},
    };
    struct world w;
    open_squares(&w);
    made_quad(&w.scene, 0, 0.2, 0.1, 0.4, 0.5, 0, 0.2, 0, 0.6, 0);
    enum exact_visibility_answer answer;
    double v = exact(&w, &answer);
    open_squares(&w);
    made_quad(&w.scene, 0, 0.2, 0.1, 0.4, 0.5, 0, 0.2, 0, 0.6, 0);
    start_world(&w, 1);
    for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
        struct discussion d = discuss_faces(&w, 0, 1);
        uint64_t before = rays_count(w.rays).rays;
        ck_assert(term_visibility_error(&d) == 0.5);
        (void)tool_visibility(&d, way[i].asked);
        ck_assert_int_eq((int)(rays_count(w.rays).rays - before), way[i].cast);
        ck_assert_int_eq(d.terms.visibility_level, way[i].level);
        double sigma = term_visibility_error(&d);
        ck_assert_double_eq_tol(
            sigma, sqrt(d.terms.visibility * (1 - d.terms.visibility) / way[i].cast), 1e-15);
        /* a net does better than chance; the pair is fixed */
        ck_assert_double_eq_tol(d.terms.visibility, v, 3 * sigma);
        (void)tool_visibility(&d, 4); /* known better already */
        ck_assert_int_eq((int)(rays_count(w.rays).rays - before), way[i].cast);
        (void)tool_extinction(&d);
        ck_assert_int_eq(d.terms.visibility_level, way[i].level);
    }
    ck_assert(visibility_error_of(1, VISIBILITY_RAYS_16) == 1 / 16.0
              && visibility_error_of(0, VISIBILITY_RAYS_256) == 1 / 256.0);
    ck_assert(visibility_error_of(0.3, VISIBILITY_EXACT) == 0
              && visibility_error_of(0.5, VISIBILITY_EXTINCTION) == 0.5);
    { /* the reference leaves the visibility alone */
        struct discussion d = discuss_faces(&w, 0, 1);
        uint64_t before = rays_count(w.rays).rays;
        (void)tool_visibility(&d, 4);
        (void)tool_trace_reference(&d, 2000);
        ck_assert_int_eq((int)(rays_count(w.rays).rays - before), 4 + 4096);
        ck_assert_int_eq(tool_reference(&d), REFERENCE_PARTIAL);
        ck_assert_double_eq_tol(d.terms.reference, v, 3 * sqrt(v * (1 - v) / 4096));
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_RAYS_4);
        d = discuss_faces(&w, 1, 2); /* nothing between, and no ray */
        before = rays_count(w.rays).rays;
        ck_assert_int_eq(tool_reference(&d), REFERENCE_ALL);
        ck_assert_uint_eq(rays_count(w.rays).rays, before);
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_ABSENT);
    }
    close_world(&w);
}
END_TEST

/* A refiner that opens clusters, casts 16 rays between faces and then does what `state` says. */
static enum decision look(const void *state, struct discussion *d)
{
    const enum decision *then = state;
    if (d->receiver->vertices == 0 || d->emitter->vertices == 0)
        return d->receiver->radius > d->emitter->radius ? DECISION_SUBDIVIDE_RECEIVER
                                                        : DECISION_SUBDIVIDE_EMITTER;
    if (d->receiver == d->emitter || d->receiver->depth + d->emitter->depth > 0)
        return DECISION_STOP;
    (void)tool_visibility(d, 16);
    return *then;
}

/* Be a pair linked or given up: the rays between are cast once for both ways round. */
START_TEST(test_both_ways)
{
    static const enum decision all[] = {DECISION_STOP, DECISION_LINK};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        struct refiner refiner = {.refine = look, .state = &all[i]};
        struct refinement r;
        struct world w;
        open_squares(&w);
        made_quad(&w.scene, 0, 0.2, 0.2, 0.5, 0.5, 0, 0, 0, 0.5, 0);
        start_world(&w, 1);
        int pairs = 0;
        for (uint32_t a = 0; a < w.h.count; a++) /* that rays are cast between, both ways round */
            for (uint32_t b = 0; b < a; b++) {
                struct discussion d = {.receiver = &w.h.elements[a], .emitter = &w.h.elements[b]};
                d.host = w.host;
                if (d.receiver->vertices && d.emitter->vertices) {
                    uint64_t before = rays_count(w.rays).rays;
                    (void)tool_visibility(&d, 16);
                    pairs += rays_count(w.rays).rays > before;
                }
            }
        ck_assert_int_ge(pairs, 2);
        uint64_t before = rays_count(w.rays).rays;
        ck_assert_int_eq(refinement_open(&r, &w.h, w.host, &refiner, 1), 0);
        ck_assert_int_eq(refinement_start(&r), 0);
        ck_assert_uint_eq(rays_count(w.rays).rays - before, 16 * (uint64_t)pairs);
        refinement_close(&r);
        close_world(&w);
    }
}
END_TEST

/* One ray says all or none, the same both ways, and what it says is on the mean what four rays say,
 * which count by what they would carry: over many names of a pair whose nearest parts, which carry
 * the most, do not see each other; of two faces, and of a face and a group. */
START_TEST(test_one_ray)
{
    enum { NAMES = 20000 };
    struct world w;
    memset(&w, 0, sizeof w);
    made_open(&w.scene);
    made_material(&w.scene, 0.5, 1);
    made_quad(&w.scene, 0, 0, 0, 0, 1, 0, 0, 0, 1,
              0); /* a floor, a wall, a board across the edge */
    made_quad(&w.scene, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1);
    made_quad(&w.scene, 0, 0.3, 0, 0.02, -0.28, 0, 0.28, 0, 1, 0);
    for (int i = 0; i < 12; i++) /* tiles above the wall, which the board hides from some */
        made_quad(&w.scene, 0, 0, 0.08 * i, 0.02 + 0.11 * i, 0, 0.06, 0, 0, 0, 0.1);
    start_world(&w, 1);
    uint32_t tile = w.h.face_element[5], group = w.h.elements[tile].parent;
    ck_assert(group > 0 && w.h.elements[group].vertices == 0);
    for (int grouped = 0; grouped < 2; grouped++) {
        struct element r = w.h.elements[w.h.face_element[0]],
                       s = w.h.elements[grouped ? group : w.h.face_element[1]];
        double one = 0, four = 0;
        for (int i = 0; i < NAMES; i++) {
            struct discussion d[3] = {{.receiver = &r, .emitter = &s, .host = w.host},
                                      {.receiver = &s, .emitter = &r, .host = w.host},
                                      {.receiver = &r, .emitter = &s, .host = w.host}};
            r.id = hash64(2 * (uint64_t)i + 1);
            s.id = hash64(2 * (uint64_t)i + 2);
            uint64_t before = rays_count(w.rays).rays + spared_rays;
            for (int k = 0; k < 3; k++)
                grouped ? (void)tool_cluster_visibility(&d[k], k < 2 ? 1 : 4)
                        : (void)tool_visibility(&d[k], k < 2 ? 1 : 4);
            /* what passes the board by takes none */
            ck_assert_uint_eq(rays_count(w.rays).rays + spared_rays - before, 1 + 1 + 4);
            ck_assert_int_eq(d[0].terms.visibility_level, VISIBILITY_RAYS_1);
            ck_assert(d[0].terms.visibility == 0 || d[0].terms.visibility == 1);
            ck_assert(d[1].terms.visibility == d[0].terms.visibility);
            ck_assert(term_visibility_error(&d[0]) == 0.5);
            one += d[0].terms.visibility / NAMES;
            four += d[2].terms.visibility / NAMES;
        }
        printf("one ray: %.4f, four: %.4f\n", one, four);
        ck_assert_double_eq_tol(one, four, 3 * 0.5 / sqrt(NAMES));
        ck_assert(four > 0.2 && four < 0.8);
    }
    close_world(&w);
}
END_TEST

/* ---- features and fog */

/* Parallel squares on one axis: the answer turns where S + (D / t)(C - S) says. */
START_TEST(test_feature)
{
    uint64_t seed = 77;
    int big = 0;
    for (int i = 0; i < 200; i++) {
        double s = between(&seed, 0.2, 1), c = between(&seed, 0.2, 1), far = between(&seed, 1, 4),
               t = far * between(&seed, 0.2, 0.8);
        double f = s + far / t * (c - s);
        struct world w;
        memset(&w, 0, sizeof w);
        made_open(&w.scene);
        made_material(&w.scene, 0.5, 1);
        made_quad(&w.scene, 0, -2, -2, 0, 4, 0, 0, 0, 4, 0);
        made_quad(&w.scene, 0, -s / 2, -s, far, 0, 2 * s, 0, s, 0, 0); /* twice as long as wide */
        made_quad(&w.scene, 0, -c / 2, -c / 2, far - t, c, 0, 0, 0, c, 0);
        start_world(&w, 1);
        struct discussion d;
        d = discuss_faces(&w, 0, 1);
        if (f > 0) {
            double longest = tool_feature_size(&d, f * 1.2) == FEATURE_SIZE_SMALL,
                   least = tool_feature_size(&d, f * 0.8) == FEATURE_SIZE_BIG;
            ck_assert(longest > 0 && least > 0);
            big++;
        } else {
            ck_assert_int_eq(tool_feature_size(&d, 1e-9), FEATURE_SIZE_SMALL);
        }
        d = discuss_faces(&w, 1, 2); /* nothing between */
        ck_assert_int_eq(tool_feature_size(&d, 0), FEATURE_SIZE_SMALL);
        close_world(&w);
    }
    ck_assert_int_gt(big, 50);
}
END_TEST

/* Extinction against a count of points along the segment, cluster by cluster. */
START_TEST(test_extinction)
{
    uint64_t seed = 9;
    int fog = 0;
    struct world w;
    open_world(&w, 2, &seed, 1);
    for (int i = 0; i < 40; i++) {
        uint32_t pair[2];
        double depth = 0;
        random_pair(&w, &seed, 0, pair);
        struct discussion d;
        memset(&d, 0, sizeof d);
        d.receiver = &w.h.elements[pair[0]];
        d.emitter = &w.h.elements[pair[1]];
        d.host = w.host;
        ck_assert_int_eq(tool_presume_visible(&d), PRESUME_VISIBLE_DONE);
        ck_assert(d.terms.visibility == 1 && d.terms.visibility_level == VISIBILITY_PRESUMED);
        ck_assert_int_eq(tool_extinction(&d), EXTINCTION_DONE); /* better than a presumption */
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_EXTINCTION);
        (void)tool_presume_visible(&d); /* which leaves what is known alone */
        ck_assert_int_eq(d.terms.visibility_level, VISIBILITY_EXTINCTION);
        for (int j = 0; j < (int)w.h.count; j++) {
            const struct element *e = &w.h.elements[j];
            double area = 0, volume = 1, v[3];
            int own = 0, in = 0;
            if (e->vertices)
                continue;
            for (int c = 0; c < e->children; c++) {
                uint32_t x = e->child + (uint32_t)c;
                own |= x == pair[0] || x == pair[1];
                area += w.h.elements[x].vertices ? w.h.elements[x].area : 0;
            }
            if (own || area <= 0)
                continue;
            sub3(v, d.emitter->centre, d.receiver->centre);
            for (int n = 0; n < 10000; n++) {
                int inside = 1;
                for (int k = 0; k < 3; k++) {
                    double x = d.receiver->centre[k] + (n + 0.5) / 10000 * v[k];
                    inside &= x >= e->vertex[0][k] && x <= e->vertex[1][k];
                }
                in += inside;
            }
            for (int k = 0; k < 3; k++)
                volume *= e->vertex[1][k] - e->vertex[0][k];
            if (in)
                depth += area / (4 * volume) * length3(v) * in / 10000;
        }
        fog += depth > 0.1;
        ck_assert_double_eq_tol(d.terms.visibility, exp(-depth), 2e-3);
    }
    ck_assert_int_gt(fog, 5);
    close_world(&w);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("shaft");
    TCase *c = tcase_create("shaft");
    tcase_set_timeout(c, 120);
    tcase_add_loop_test(c, test_truth, 0, KINDS);
    tcase_add_loop_test(c, test_inherited, 0, KINDS);
    tcase_add_loop_test(c, test_scale, 0, KINDS);
    tcase_add_test(c, test_refined);
    tcase_add_test(c, test_partition);
    tcase_add_loop_test(c, test_random_parts, 0, 6);
    tcase_add_test(c, test_penumbra);
    tcase_add_test(c, test_levels);
    tcase_add_test(c, test_both_ways);
    tcase_add_test(c, test_one_ray);
    tcase_add_test(c, test_feature);
    tcase_add_test(c, test_extinction);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
