/* study_greedy.c - `radiosity study greedy`: error of an oracle's links where light is smooth,
 * against what greedy links make (greedy.h), by constants and by linear elements, and against the
 * least that constants can do (best_squares.h).
 *
 * Four scenes without shadows, whose light is known: an empty white cube, in which one element for
 * each face is exact, the cube lit by its ceiling, two parallel plates, and the lamp over a wall of
 * Arvo, Torrance and Smits. The oracle is solved with its thresholds as they are, and with larger
 * ones. Error is the norm of what is off over the cells of greedy.h, at their centres, as a share
 * of the same norm of the reflected light. Leaves below a cell would be judged by points that lie
 * in them; a cell is smaller than most. In the lit cube the true light itself is off by .02 % of
 * what is reflected: means over its faces are known to seven digits
 * (tests/solver/check_study_greedy.c).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kernel/leaf_at.h"
#include "output/json_file.h"
#include "output/json_values.h"
#include "output/solution.h"
#include "study/best_squares.h"
#include "study/greedy.h"
#include "study/made_scene.h"
#include "study/study.h"
#include "util/device.h"
#include "util/open_oracle.h"
#include "util/progress.h"
#include "util/report.h"
#include "util/solved.h"

enum { SCENES = 4, TIMES = 4, BASES = 2, STEPS_MOST = 1 << 15 };

/* Of the light: greedy links with no more than this are exact, but for rounding. */
static const double EXACT = 1e-6;

static const double times[TIMES] = {64, 16, 4, 1}; /* the thresholds */
static const char *const scene_names[SCENES] = {"empty white cube", "cube lit by its ceiling",
                                                "parallel plates", "lamp over a wall"};
static const char *const basis_names[BASES] = {"constant", "linear"};

struct row {
    size_t links;
    double error[GREEDY_NORMS], greedy[GREEDY_NORMS]; /* shares; greedy: with as many links */
    size_t greedy_links[GREEDY_NORMS];                /* for that error */
};

/* ---- the scenes */

static int cube(struct greedy_face *f, int lit)
{
    static const double side[6][3][3] = {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
        {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
        {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}};
    for (int i = 0; i < 6; i++) {
        f[i] = (struct greedy_face){
            .cells = lit ? 32 : 16, .rho = 0.5, .exitance = lit && i != 1 ? 0 : 1};
        memcpy(f[i].corner, side[i][0], sizeof side[i][0]);
        memcpy(f[i].a, side[i][1], sizeof side[i][1]);
        memcpy(f[i].b, side[i][2], sizeof side[i][2]);
    }
    return 6;
}

/* Returns the number of faces. */
static int make(int scene, struct greedy_face f[GREEDY_FACES])
{
    if (scene < 2)
        return cube(f, scene);
    if (scene == 2) {
        f[0] = (struct greedy_face){{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 32, 0.5, 1};
        f[1] = (struct greedy_face){{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 32, 0.5, 1};
        return 2;
    }
    f[0] = (struct greedy_face){{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 512, 0.5, 0};
    f[1] = (struct greedy_face){{-0.5, -0.5, 1}, {0, 1, 0}, {1, 0, 0}, 1, 0, 1};
    return 2;
}

static RadScene commit(RadDevice device, const struct greedy_face *f, int count)
{
    static struct made_scene made;
    made = (struct made_scene){.count = 0};
    for (int i = 0; i < count; i++)
        made_quad(&made, made_material(&made, f[i].rho, f[i].exitance), f[i].corner[0],
                  f[i].corner[1], f[i].corner[2], f[i].a[0], f[i].a[1], f[i].a[2], f[i].b[0],
                  f[i].b[1], f[i].b[2]);
    return made_commit(&made, device, "study greedy");
}

/* ---- the oracle's links */

/* B of a solution less the true one, at the cells' centres. */
static void find_wrong(const struct greedy *g, const struct solution *s, double *const *wrong)
{
    for (uint32_t k = 0; k < s->surfaces.face_count; k++) {
        uint32_t polygon = s->surfaces.faces[k].input;
        const struct greedy_face *f = &g->face[polygon];
        for (int i = 0; i < f->cells * f->cells; i++) {
            double p[3], weight[4];
            greedy_centre(f, i, p);
            uint32_t leaf = leaf_at(s->tree.elements, s->tree.face_element[k], p, weight);
            wrong[polygon][i] = radiosity_at(s, leaf, 0, p) - g->radiosity[polygon][i];
        }
    }
}

/* Returns 0, or -1 after a message. */
static int measure(const struct options *o, const struct greedy *g, RadDevice device,
                   RadScene scene, int basis, double factor, struct row *row)
{
    struct RadSolveOptions how = solve_options(o);
    how.basis = basis ? RAD_BASIS_LINEAR : RAD_BASIS_CONSTANT;
    struct solved s;
    double *wrong[GREEDY_FACES] = {0};
    int status = 0;
    RadOracle oracle =
        open_oracle(device, o->oracle, RAD_RELEASE_FLAT, o->settings, o->setting_count);
    if (!oracle || radScaleOracle(oracle, factor) < 0
        || solved_open(&s, device, "study greedy", scene, oracle, &how) < 0) {
        radReleaseOracle(oracle);
        return -1;
    }
    for (int i = 0; i < g->count && status == 0; i++) {
        wrong[i] = malloc((size_t)(g->face[i].cells * g->face[i].cells) * sizeof(double));
        status = wrong[i] ? 0 : report_error("study greedy", 0, "out of memory");
    }
    if (status == 0) {
        const struct surfaces surfaces = surfaces_of(scene, NULL, NULL);
        const struct solution solution = solution_of(&surfaces, s.solution, o->threads);
        find_wrong(g, &solution, wrong);
        row->links = s.report.links;
        for (int n = 0; n < GREEDY_NORMS; n++)
            row->error[n] = greedy_norm_of(g, wrong, (enum greedy_norm)n)
                            / greedy_reflected(g, (enum greedy_norm)n);
    }
    for (int i = 0; i < g->count; i++)
        free(wrong[i]);
    solved_close(&s);
    radReleaseOracle(oracle);
    return status;
}

/* Greedy links with this error. */
static void compare_step(struct row *row, int norm, size_t links, double error)
{
    size_t *least = &row->greedy_links[norm];
    if (links <= row->links && error < row->greedy[norm])
        row->greedy[norm] = error;
    if (error <= row->error[norm] && (!*least || links < *least))
        *least = links;
}

/* What greedy links make of the rows of a basis. Returns 0, or -1. */
static int compare_with(const struct greedy *g, int basis, struct row row[TIMES])
{
    size_t most = 64;
    for (int k = 0; k < TIMES; k++)
        most = row[k].links > most ? row[k].links : most;
    most = most < STEPS_MOST ? most : STEPS_MOST;
    struct greedy_step *steps = malloc((most / 3 + 1) * sizeof *steps);
    int status = steps ? 0 : -1;
    for (int k = 0; k < TIMES; k++)
        for (int n = 0; n < GREEDY_NORMS; n++) {
            row[k].greedy[n] = row[k].links <= most ? INFINITY : (double)NAN;
            row[k].greedy_links[n] = 0;
        }
    for (int n = 0; n < GREEDY_NORMS && status == 0; n++)
        for (int alone = 0; alone < 2 && status == 0; alone++) {
            int count = greedy_run(g, (enum greedy_norm)n, basis, alone, most, steps);
            status = count < 0 ? -1 : 0;
            for (int i = 0; i < count; i++) {
                double error = steps[i].error / greedy_reflected(g, (enum greedy_norm)n);
                for (int k = 0; k < TIMES; k++)
                    compare_step(&row[k], n, steps[i].links, error);
            }
        }
    free(steps);
    return status;
}

/* `best`: the least error of constants, as a share, times the root of the links. Returns 0, or -1
 * after a message. */
static int measure_scene(const struct options *o, int which, struct row rows[BASES][TIMES],
                         double best[GREEDY_NORMS])
{
    struct greedy_face faces[GREEDY_FACES];
    struct greedy g;
    int count = make(which, faces), status = -1;
    RadDevice device = open_device(o->threads);
    RadScene scene = device ? commit(device, faces, count) : NULL;
    if (scene) {
        status = 0;
        if (greedy_open(&g, faces, count) < 0)
            status = report_error("study greedy", 0, "out of memory for the cells' factors");
        for (int n = 0; n < GREEDY_NORMS && status == 0; n++)
            best[n] =
                best_squares(&g, (enum greedy_norm)n) / greedy_reflected(&g, (enum greedy_norm)n);
        for (int b = 0; b < BASES && status == 0; b++) {
            for (int k = 0; k < TIMES && status == 0; k++)
                status = measure(o, &g, device, scene, b, times[k], &rows[b][k]);
            if (status == 0 && compare_with(&g, b, rows[b]) < 0)
                status = report_error("study greedy", 0, "out of memory for links");
        }
        greedy_close(&g);
    }
    radReleaseScene(scene);
    radReleaseDevice(device);
    return status;
}

/* ---- the table */

static void print_or_dash(int width, int digits, double value, int known)
{
    if (known)
        printf(" %*.*f", width, digits, value);
    else
        printf(" %*s", width, "-");
}

static void print_scene(int scene, const struct row rows[BASES][TIMES],
                        const double best[GREEDY_NORMS])
{
    printf("%s\n%-9s %9s %8s  %8s %8s %7s %7s  %8s %8s %7s %7s\n", scene_names[scene], "basis",
           "threshold", "links", "L1, %", "greedy", "times", "links", "L2, %", "greedy", "times",
           "links");
    for (int b = 0; b < BASES; b++)
        for (int k = 0; k < TIMES; k++) {
            const struct row *r = &rows[b][k];
            printf("%-9s %9g %8zu ", basis_names[b], times[k], r->links);
            for (int n = 0; n < GREEDY_NORMS; n++) {
                printf(" %8.4f", 100 * r->error[n]);
                print_or_dash(8, 4, 100 * r->greedy[n], !isnan(r->greedy[n]));
                print_or_dash(7, 2, r->error[n] / r->greedy[n], r->greedy[n] > EXACT);
                print_or_dash(7, 0, (double)r->greedy_links[n], r->greedy_links[n] > 0);
                putchar(n == 0 ? ' ' : '\n');
            }
        }
    if (best[0] > EXACT)
        printf(
            "%-9s constants over N parts, N large: at least %.3g %% / sqrt N (L1), %.3g %% (L2)\n",
            "floor", 100 * best[0], 100 * best[1]);
    printf("\n");
}

static json_t *scene_json(int scene, const struct row rows[BASES][TIMES],
                          const double best[GREEDY_NORMS])
{
    json_t *list = json_array();
    for (int b = 0; b < BASES; b++)
        for (int k = 0; k < TIMES; k++) {
            const struct row *r = &rows[b][k];
            json_t *shares[GREEDY_NORMS];
            for (int n = 0; n < GREEDY_NORMS; n++)
                shares[n] = json_finite(r->greedy[n]);
            json_array_append_new(
                list, json_pack("{s:s, s:f, s:I, s:f, s:o, s:I, s:f, s:o, s:I}", "basis",
                                basis_names[b], "times", times[k], "links", (json_int_t)r->links,
                                "l1", r->error[0], "greedy_l1", shares[0], "greedy_links_l1",
                                (json_int_t)r->greedy_links[0], "l2", r->error[1], "greedy_l2",
                                shares[1], "greedy_links_l2", (json_int_t)r->greedy_links[1]));
        }
    return json_pack("{s:s, s:f, s:f, s:o}", "scene", scene_names[scene], "floor_l1", best[0],
                     "floor_l2", best[1], "rows", list);
}

int study_greedy(const struct options *o, const struct open_scene *none)
{
    struct row rows[BASES][TIMES];
    double best[GREEDY_NORMS];
    json_t *table = o->json ? json_array() : NULL;
    (void)none;
    for (int i = 0; i < SCENES; i++) {
        struct progress progress;
        progress_start(&progress, o->quiet);
        progress_say(&progress, "%s", scene_names[i]);
        int status = measure_scene(o, i, rows, best);
        progress_end(&progress);
        if (status < 0) {
            json_decref(table);
            return 1;
        }
        if (!o->quiet) {
            print_scene(i, (const struct row(*)[TIMES])rows, best);
            fflush(stdout);
        }
        if (o->json)
            json_array_append_new(table, scene_json(i, (const struct row(*)[TIMES])rows, best));
    }
    return o->json && json_file_write(o->json, table) < 0;
}
