/* check_shaft.c - precise answers of the shaft are true, whatever segment is tried; candidates are
 * the same inherited or found anew.
 *
 * A ray caster in single precision may find a hit where a segment ends within its rounding of a
 * face that it does not cross. Such an end lies less than GRAZE of ray_offset from the face's
 * plane; segments with one are put to the test in double precision alone, and counted.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include "engine/refine.h"
#include "oracles.h"
#include "shaft_worlds.h"
#include "terms/visibility_error.h"
#include "tools/shaft.h"
#include "tools/support_planes.h"
#include "tools/visibility.h"
#include "visibility/candidates.h"

#define GRAZE (1 / 16.0)

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
        const struct element *e = hierarchy_surface(&w->h, i);
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
        ck_assert(tool_visibility(&d, 1024, 0)
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
        ck_assert_int_eq(refinement_open(&r, &now->h, rays_host(now->rays), &watched,
                                         limits_complete((struct limits){0}, NULL),
                                         ways[i].threads),
                         0);
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

int main(void)
{
    Suite *suite = suite_create("shaft");
    TCase *c = tcase_create("shaft");
    tcase_set_timeout(c, 120);
    tcase_add_loop_test(c, test_truth, 0, KINDS);
    tcase_add_loop_test(c, test_inherited, 0, KINDS);
    tcase_add_loop_test(c, test_scale, 0, KINDS);
    tcase_add_test(c, test_refined);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
