/* check_own_counts.c - counts that a rank has of its own faces alone: as those of a run that has
 * all, told by the same numbers, and what lands on others' faces is written to them.
 *
 * One process stands for a rank that owns all faces, and for the first of two.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdlib.h>
#include "engine/face_error.h"
#include "engine/mend.h"
#include "engine/mend_places.h"
#include "engine/polygon_rows.h"
#include "engine/reflected_light.h"
#include "engine/solve_tracer.h"
#include "particles/landing_mail.h"
#include "particles/power_balance.h"
#include "runtime/make_solve.h"
#include "suite.h"

enum { PARTICLES = 3000 };

/* A room with a lamp, whose leaves have quarters that only their owner would have. */
struct parted {
    struct scene scene;
    struct solve s;
    struct quarters quarters;
    uint16_t *owner;
    size_t stretch[3];
};

/* The first `mine` faces in the tree's order are this rank's. */
static void open_parted(struct parted *x, uint32_t mine)
{
    uint32_t m[6] = {0, 0, 0, 0, 0, 1};
    made_open(&x->scene);
    made_material(&x->scene, 0.6, 0);
    made_material(&x->scene, 0.2, 10);
    made_room(&x->scene, m, 4, 5, 3);
    made_quad(&x->scene, 0, 1, 2, 2.5, 0, 1, 0, 1, 0, 0);
    made_quad(&x->scene, 0, 1, 2, 2.5, 1, 0, 0, 0, 1, 0);
    solve_with(&x->s, &x->scene, "bf_guarded", RELEASE_FLAT, NULL, quick(1));
    struct hierarchy *h = &x->s.hierarchy;
    const uint32_t common = h->count;
    mine = mine < h->face_count ? mine : h->face_count;
    x->owner = calloc(h->face_count, sizeof *x->owner);
    x->stretch[0] = 0;
    x->stretch[1] = mine;
    x->stretch[2] = h->face_count;
    for (uint32_t i = mine; i < h->face_count; i++)
        x->owner[h->order[i]] = 1;
    ck_assert_int_eq(quarters_open(&x->quarters, h), 0);
    for (uint32_t i = 0; i < common; i++)
        if (h->elements[i].vertices && !h->elements[i].children)
            ck_assert_int_eq(quarters_split(&x->quarters, h, i, 1 + 15 * (i % 2),
                                            !x->owner[h->elements[i].face]),
                             0);
    ck_assert_int_eq(quarters_place(&x->quarters, h, x->owner, 2), 0);
    ck_assert_int_eq(solve_make_room(&x->s), 0);
    for (uint32_t i = common; i < h->count; i++)
        x->s.state.irradiance[i] = x->s.state.irradiance[h->elements[i].parent];
}

static void close_parted(struct parted *x)
{
    quarters_close(&x->quarters);
    free(x->owner);
    solve_close(&x->s);
    made_close(&x->scene);
}

static struct tracer trace(const struct parted *x, int own)
{
    struct tracer t = solve_tracer(&x->s);
    t.quarters = own ? &x->quarters : NULL;
    t.owner = x->owner;
    t.stretch = x->stretch;
    ck_assert_int_eq(tracer_open(&t), 0);
    return t;
}

/* With shares by which the operator's faces are this rank's as they are in x. */
static struct light_operator operator_of(const struct parted *x)
{
    struct light_operator op = x->s.operator;
    op.shares.common = x->quarters.common;
    op.shares.owner = x->owner;
    return op;
}

START_TEST(test_all_own)
{
    struct parted x;
    struct tally whole, own;
    open_parted(&x, UINT32_MAX);
    const struct hierarchy *h = &x.s.hierarchy;
    ck_assert_uint_gt(h->count, x.quarters.common);
    struct tracer of_all = trace(&x, 0), of_own = trace(&x, 1);
    ck_assert_int_eq(tally_open(&whole, &of_all, 1, 1), 0);
    ck_assert_int_eq(tally_open(&own, &of_own, 1, 1), 0);
    for (int i = 1; i < 3; i++) {
        ck_assert_int_eq(tally_trace(&whole, &of_all, (uint64_t)i * PARTICLES, NULL), 0);
        ck_assert_int_eq(tally_trace(&own, &of_own, (uint64_t)i * PARTICLES, NULL), 0);
    }
    power_balance(&whole, &of_all);
    power_balance(&own, &of_own);
    ck_assert(tally_fingerprint(&whole, NULL) == tally_fingerprint(&own, NULL));
    for (uint32_t f = 0; f < h->face_count; f++)
        for (int r = 0; r < REPLICATES; r++)
            ck_assert(tally_face(&whole, r, f, 0) == tally_face(&own, r, f, 0));
    for (uint32_t e = 0; e < h->count; e++)
        ck_assert(tally_leaf(&whole, e, 0) == tally_leaf(&own, e, 0));
    double noise[2];
    ck_assert(reflected_light(&x.s.problem, &whole, &noise[0])
              == reflected_light(&x.s.problem, &own, &noise[1]));
    struct face_error a, b;
    const double *H = x.s.state.irradiance;
    ck_assert_int_eq(face_error_open(&a, &x.s.problem, h, H, &whole), 0);
    ck_assert_int_eq(face_error_open(&b, &x.s.problem, h, H, &own), 0);
    ck_assert(a.l1.value == b.l1.value && a.power.high == b.power.high && a.worst == b.worst
              && a.worst_share == b.worst_share);
    for (uint32_t i = 0; i < a.polygons; i++)
        ck_assert(a.error[i] == b.error[i] && a.deviation[i] == b.deviation[i]);
    face_error_close(&a);
    face_error_close(&b);
    const struct light_operator op = operator_of(&x);
    double *mended[2];
    for (int i = 0; i < 2; i++) {
        mended[i] = malloc(h->count * sizeof *mended[i]);
        memcpy(mended[i], H, h->count * sizeof *mended[i]);
        ck_assert_int_eq(mend_irradiance(i ? &op : &x.s.operator, i ? &own : & whole, mended[i]),
                         0);
    }
    for (uint32_t e = 0; e < h->count; e++)
        ck_assert(mended[0][e] == mended[1][e]);
    free(mended[0]);
    free(mended[1]);
    tally_close(&whole);
    tally_close(&own);
    tracer_close(&of_all);
    tracer_close(&of_own);
    close_parted(&x);
}
END_TEST

START_TEST(test_first_of_two)
{
    enum { MINE = 5 };
    struct parted x;
    struct tally own;
    struct mend_places places;
    struct polygon_rows rows;
    struct mail mail = {0};
    const int64_t w[3] = {1 << 24, 0, 0};
    open_parted(&x, MINE);
    const struct hierarchy *h = &x.s.hierarchy;
    struct tracer t = trace(&x, 1);
    ck_assert_int_eq(tally_open(&own, &t, 1, 1), 0);
    ck_assert_uint_eq(own.held, MINE);
    for (uint32_t i = 0; i < h->face_count; i++) { /* on the face's last quarter */
        uint32_t number = h->face_element[h->order[i]], leaf = number;
        for (; x.quarters.child[number]; number = x.quarters.child[number] + 3)
            leaf = number < x.quarters.common ? number : leaf;
        const uint32_t e = quarters_at_owner(&x.quarters, leaf, number);
        ck_assert_int_eq(tally_holds(&own, h->order[i]), i < MINE);
        if (i < MINE) {
            ck_assert_uint_eq(quarters_number(&x.quarters, e), number);
            ck_assert_uint_eq(h->elements[e].face, h->order[i]);
            tally_count(&own, 2, tally_place(&own, h->order[i]), e, w);
            ck_assert_int_eq(own.element[e], w[0]);
            ck_assert_int_eq(own.face[2 * MINE + i], w[0]);
            continue;
        }
        mail_landing(&mail, &own, 2, h->order[i], e, w);
        ck_assert_uint_eq(mail.count, i - MINE + 1);
        const struct letter *l = &mail.letter[mail.count - 1];
        ck_assert_uint_eq(l->at, e);
        ck_assert(l->owner == 1 && l->replicate == 2 && l->count[0] == w[0]);
    }
    mail_close(&mail, 1);
    /* who mends an element knows of its children, and nobody has all */
    const struct light_operator op = operator_of(&x);
    ck_assert_int_eq(mend_places_open(&places, &op), 0);
    uint32_t here = 0;
    for (uint32_t e = 0; e < h->count; e++) {
        here += mend_is_here(&places, e) ? 1u : 0u;
        ck_assert(!mend_is_here(&places, e) || mend_place(&places, e) < places.count);
        for (uint32_t c = 0; c < h->elements[e].children && mend_is_added(&op, e); c++)
            ck_assert(mend_is_here(&places, h->elements[e].child + c));
    }
    ck_assert_uint_eq(here, places.count);
    ck_assert_uint_lt(here, h->count);
    ck_assert(mend_is_here(&places, 0) && places.told > 0);
    mend_places_close(&places);
    ck_assert_int_eq(polygon_rows_open(&rows, &x.s.problem, h, &own), 0);
    ck_assert_uint_eq(rows.count + rows.several_count, MINE + rows.several_count);
    polygon_rows_close(&rows);
    tally_close(&own);
    tracer_close(&t);
    close_parted(&x);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("own counts");
    TCase *c = tcase_create("own counts");
    tcase_set_timeout(c, 60);
    tcase_add_test(c, test_all_own);
    tcase_add_test(c, test_first_of_two);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
