/* check_group_entries.c - entries of view factors of meshed rooms, one by one, against quadrature
 * that shares nothing with the library (room_judge.h).
 * Rooms of all shapes, walls of few faces and of many, by quads, triangles or both; with boxes, and
 * without. Where nothing stands between, every entry is within the tolerance, of itself or of 1e-4;
 * past something, of itself or of what the library says it works for.
 * Once is enough: it is about numbers; that memory is used well, shorter suites tell.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "engine/exchange.h"
#include "runtime/make_meshes.h"
#include "suite.h"
#include "util/oracles.h"

/* Rooms, and rows of each. */
enum { ROOMS = 8, ROWS = 2, ROOMS_THOROUGH = 60, ROWS_THOROUGH = 6 };

static void open_exchange(struct exchange *x, const struct scene *s, double tolerance)
{
    const char *cause;
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    exchange_set_tolerance(refiner, tolerance);
    const struct exchange_options options = {.tolerance = tolerance, .threads = 1};
    ck_assert_int_eq(exchange_open(x, s, refiner, &options, &cause), 0);
    refiner_close(refiner);
}

static struct judge_polygon polygon_of(const struct face *f)
{
    struct judge_polygon p = {.n = (int)f->vertices};
    memcpy(p.v, f->vertex, f->vertices * sizeof *f->vertex);
    return p;
}

/* Entries of a room that are wrong by more than allowed, past nothing and in half shadow; the worst
 * as a share of that. */
struct verdict {
    long all[2], over[2], above; /* above: what they would exchange in a clear view */
    double worst[2];
    double said; /* the largest error of an entry, as the library estimates it */
};

/* `least`: smaller entries in half shadow are judged by it. */
static void judge_row(const struct mesh_room *room, const struct scene *s, const double *row,
                      uint32_t i, double tolerance, double least, struct verdict *v)
{
    struct judge_polygon a = polygon_of(&s->faces[i]);
    const double area = judge_area(&a);
    for (uint32_t j = 0; j < s->face_count; j++) {
        struct judge_polygon b = polygon_of(&s->faces[j]);
        if (i == j) {
            ck_assert(row[j] == 0);
            continue;
        }
        double enough = 0.1 * tolerance * area * fmax(row[j], 1e-4);
        double clear = judge_pair(&a, &b, NULL, 0, 1e-9, enough) / area,
               right = judge_pair(&a, &b, room->patch, room->count, 1e-9, enough) / area;
        int dim = right < clear * (1 - 1e-9);
        double allowed = tolerance * fmax(right, dim ? least : 1e-4),
               share = fabs(row[j] - right) / allowed;
        v->all[dim] += clear > 0;
        v->over[dim] += share > 1;
        v->worst[dim] = fmax(v->worst[dim], share);
        if (share > 1)
            printf("F_%u,%u is %.9g, not %.9g: %.2f of the tolerance\n", i, j, row[j], right,
                   share);
        v->above += row[j] > clear + tolerance * fmax(clear, 1e-4);
    }
}

static struct verdict judge_room(int number, double tolerance, int rows)
{
    struct mesh_room room;
    struct scene s;
    struct exchange x;
    struct verdict v = {{0}, {0}, 0, {0}, 0};
    mesh_room_make(&room, &s, (uint64_t)number, (enum mesh_shape)(number % SHAPES),
                   (enum mesh_cells)(number % CELLS), number % 4, 2 * pow(125, number % 7 / 6.0));
    open_exchange(&x, &s, tolerance);
    double *row = malloc(s.input_count * sizeof *row);
    for (int r = 0; r < rows; r++) {
        double at = mesh_chance(&room);
        /* in turn of all, and of the last, which are the boxes' */
        uint32_t i = (uint32_t)((r % 2 ? at : 1 - 0.3 * at) * (s.input_count - 1));
        (void)exchange_row(&x, i, row);
        judge_row(&room, &s, row, i, tolerance, x.areas.limits.floor, &v);
    }
    free(row);
    v.said = x.report.entry_error;
    exchange_close(&x);
    made_close(&s);
    if (getenv("TELL"))
        printf("room %d, %u faces: clear %ld, %ld over, worst %.2f; dim %ld, %ld over, worst %.2f; "
               "said %.2g\n",
               number, s.input_count, v.all[0], v.over[0], v.worst[0], v.all[1], v.over[1],
               v.worst[1], v.said);
    return v;
}

START_TEST(test_entries)
{
    struct verdict v = judge_room(_i, 3e-4, thorough() ? ROWS_THOROUGH : ROWS);
    ck_assert_int_gt(v.all[0], 0);
    ck_assert_int_eq(v.over[0], 0);
    ck_assert_int_eq(v.over[1], 0);
    ck_assert_int_eq(v.above, 0);
    /* of no entry is more allowed: what is said is of it and not of the largest near it */
    ck_assert_double_le(v.said, 3e-4);
}
END_TEST

/* 27: faces that the plane of a meshed side runs through were taken as if all of them were in
 * front, and what is behind counted against the rest: entries of 0. 44: single faces far off each
 * other had one point's factor, which is right to 1e-5 only where faces look at each other. */
START_TEST(test_once_wrong)
{
    static const int rooms[] = {27, 44};
    ck_assert_int_eq(judge_room(rooms[_i], 3e-4, thorough() ? ROWS_THOROUGH : ROWS).over[0], 0);
}
END_TEST

/* 18: four points agreed past a shade that only corners of the face see. 52, 58: two rules of a
 * piece agreed by chance, past the edge of a shade. */
START_TEST(test_once_too_sure)
{
    static const int rooms[] = {18, 52, 58};
    const struct verdict v = judge_room(rooms[_i], 3e-4, ROWS_THOROUGH);
    ck_assert_int_eq(v.over[0], 0);
    ck_assert_int_eq(v.over[1], 0);
}
END_TEST

/* The same for other tolerances. */
START_TEST(test_tolerances)
{
    const double tolerance[] = {3e-3, 3e-5};
    ck_assert_int_eq(judge_room(4, tolerance[_i], thorough() ? ROWS_THOROUGH : ROWS).over[0], 0);
}
END_TEST

/* The sides of a box turned about z, seen from inside or from outside. */
static void put_box(struct mesh_room *room, const double from[3], double size, double turn,
                    int inside)
{
    const double x[3] = {size * cos(turn), size * sin(turn), 0},
                 y[3] = {-size * sin(turn), size * cos(turn), 0}, z[3] = {0, 0, size},
                 *edge[3] = {x, y, z}, all[2] = {0, 1};
    for (int k = 0; k < 3; k++)
        for (int far = 0; far < 2; far++) {
            double at[3];
            const double *u = edge[(k + 1) % 3], *v = edge[(k + 2) % 3];
            for (int c = 0; c < 3; c++)
                at[c] = from[c] + far * edge[k][c];
            mesh_part(room, at, far == inside ? v : u, far == inside ? u : v, all, all);
        }
}

static void round_corners(struct scene *s, double unit)
{
    for (uint32_t i = 0; i < s->face_count; i++)
        for (uint32_t c = 0; c < s->faces[i].vertices; c++)
            for (int k = 0; k < 3; k++)
                s->faces[i].vertex[c][k] = rint(s->faces[i].vertex[c][k] / unit) * unit;
}

/* Sides of a box whose corners were rounded are in one another's plane to the last digit only: they
 * were taken for facing each other, behind both, and exchanged light through the box. */
START_TEST(test_rounded_box)
{
    struct mesh_room room = {.count = 0};
    struct scene s;
    struct exchange x;
    double worst = 0;
    put_box(&room, (const double[3]){0, 0, 0}, 1, 0, 1);
    put_box(&room, (const double[3]){.4, .3, .2}, .3, .3, 0);
    made_open(&s);
    made_material(&s, 0.5, 0);
    for (int i = 0; i < room.count; i++)
        mesh_of_patch(&room, &s, &room.patch[i], i < 6 ? 400 : 36, CELLS_QUADS);
    round_corners(&s, 1e-9);
    open_exchange(&x, &s, 3e-4);
    double *row = malloc(s.input_count * sizeof *row);
    for (uint32_t i = 6 * 400; i < s.input_count; i++) {
        double sum = exchange_row(&x, i, row);
        for (uint32_t j = 6 * 400; j < s.input_count; j++)
            ck_assert(row[j] == 0);
        worst = fmax(worst, fabs(sum - 1));
    }
    ck_assert_double_le(worst, 3e-4);
    free(row);
    exchange_close(&x);
    made_close(&s);
}
END_TEST

/* Turned quads whose corners were rounded are bent a little, and have no outlines that could be cut
 * along: whole walls were hidden by what stands beside them, rows lost 2 % and more. Corners are
 * off their planes by a few 1e-4 of a side, and rows by as much along each of four sides. */
START_TEST(test_bent_quads)
{
    for (uint64_t seed = 0; seed < 12; seed++) {
        struct mesh_room room = {.state = seed << 32};
        struct scene s;
        struct exchange x;
        double worst = 0;
        put_box(&room, (const double[3]){0, 0, 0}, 3, 0, 1);
        for (int i = 0; i < room.count; i++)
            for (int c = 0; c < 4; c++)
                room.patch[i].v[c][0] *= 1.7;
        mesh_put(&room);
        made_open(&s);
        made_material(&s, 0.5, 0);
        for (int i = 0; i < room.count; i++)
            mesh_of_patch(&room, &s, &room.patch[i], 4, CELLS_QUADS);
        round_corners(&s, 1e-4);
        open_exchange(&x, &s, 3e-4);
        double *row = malloc(s.input_count * sizeof *row);
        for (uint32_t i = 0; i < s.input_count; i++)
            worst = fmax(worst, fabs(exchange_row(&x, i, row) - 1));
        ck_assert_double_le(worst, 5e-3);
        free(row);
        exchange_close(&x);
        made_close(&s);
    }
}
END_TEST

/* The ends of an edge that two faces share may round to either side of a plane. Here the one that
 * is cut into pieces had a corner more on it, and its pieces lost a sixteenth of it: 8.5 % of F.
 * The third face lies beside the first and hides next to nothing. */
START_TEST(test_shared_edge)
{
    const double v[3][3][3] = {
        {{-1.602, 0.01209, 1.685}, {-1.831, 0.01382, 1.926}, {-1.825, 0.1917, 1.931}},
        {{-1.602, 0.01209, 1.685}, {-2.086, 0.02964, 1.684}, {-1.831, 0.01382, 1.926}},
        {{-1.373, 0.01036, 1.445}, {-1.602, 0.01209, 1.685}, {-1.596, 0.19, 1.69}}};
    struct scene s;
    struct exchange x;
    double row[3];
    made_open(&s);
    made_material(&s, 0.5, 0);
    for (int i = 0; i < 3; i++)
        made_face(&s, 0, 3, v[i]);
    open_exchange(&x, &s, 3e-4);
    (void)exchange_row(&x, 0, row);
    struct judge_polygon a = polygon_of(&s.faces[0]), b = polygon_of(&s.faces[1]);
    double n[3];
    judge_cross(a.v[0], a.v[1], a.v[2], n);
    double area = 0.5 * sqrt(judge_dot(n, n)),
           clear = judge_pair(&a, &b, NULL, 0, 1e-9, 1e-6 * area) / area;
    ck_assert_double_eq_tol(row[1], clear, 3e-4 * clear);
    exchange_close(&x);
    made_close(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("group entries");
    TCase *c = tcase_create("group entries");
    tcase_set_timeout(c, 120);
    tcase_add_loop_test(c, test_entries, 0, thorough() ? ROOMS_THOROUGH : ROOMS);
    tcase_add_loop_test(c, test_once_wrong, 0, 2);
    tcase_add_loop_test(c, test_once_too_sure, 0, 3);
    tcase_add_loop_test(c, test_tolerances, 0, 2);
    tcase_add_test(c, test_rounded_box);
    tcase_add_test(c, test_bent_quads);
    tcase_add_test(c, test_shared_edge);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
