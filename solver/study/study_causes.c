/* study_causes.c - `radiosity study causes`: which light do the links bring wrongly, and why?
 *
 * Each scene is solved by links alone and its links held against rays (radFindCauses). The table
 * has a row for each cause: what links bring of such light and what rays find of it; by how much
 * the cause makes the light of one reflection too much or too little, in all, and as the sum of the
 * modulus over polygons; the same after all reflections, each polygon's part by what it makes of
 * all light; and its share of the sum of that over causes. All causes add up to `together` in all;
 * polygon by polygon they may cancel there. Below stands what particles, which know of no links,
 * measure of the solution: in all the same, but by polygon the error where it ends, not where it
 * begins.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include "output/json_file.h"
#include "output/json_values.h"
#include "study/study.h"
#include "util/device.h"
#include "util/open_oracle.h"
#include "util/progress.h"
#include "util/solved.h"

/* Rows of the table: a way of light before the causes that are its own. */
static const struct {
    const char *name, *key;
    int way, cause; /* or -1 */
} rows[] = {
    {"no link: lost", "lost", RAD_WAY_NONE, RAD_CAUSE_LOST},
    {"links seen whole", "open", RAD_WAY_OPEN, -1},
    {"  bright spots", "open_bright", -1, RAD_CAUSE_OPEN_BRIGHT},
    {"  form factors", "open_kernel", -1, RAD_CAUSE_OPEN_KERNEL},
    {"  visibility", "open_visibility", -1, RAD_CAUSE_OPEN_VISIBILITY},
    {"  spread over receiver", "open_spread", -1, RAD_CAUSE_OPEN_SPREAD},
    {"links in half shadow", "half", RAD_WAY_HALF, -1},
    {"  bright spots", "half_bright", -1, RAD_CAUSE_HALF_BRIGHT},
    {"  form factors", "half_kernel", -1, RAD_CAUSE_HALF_KERNEL},
    {"  visibility", "half_visibility", -1, RAD_CAUSE_HALF_VISIBILITY},
    {"  spread over receiver", "half_spread", -1, RAD_CAUSE_HALF_SPREAD},
    {"links of groups", "groups", RAD_WAY_GROUPS, -1},
    {"  bright spots", "groups_bright", -1, RAD_CAUSE_GROUPS_BRIGHT},
    {"  factors, visibility", "groups_rest", -1, RAD_CAUSE_GROUPS_REST},
    {"  spread over receiver", "groups_spread", -1, RAD_CAUSE_GROUPS_SPREAD},
    {"row sums, cap", "row_cap", -1, RAD_CAUSE_ROW_CAP},
    {"contact", "contact", -1, RAD_CAUSE_CONTACT},
    {"iteration", "solver", -1, RAD_CAUSE_SOLVER},
};
enum { ROW_COUNT = sizeof rows / sizeof *rows };

struct found {
    struct RadCausesReport causes;
    struct RadMeasure power, l1; /* of the solution, by particles, as shares of the same light */
    struct RadReport solve;
};

/* Of the modulus of what is wrong after all reflections. */
static double share_of_cause(const struct RadCausesReport *r, enum RadCauseKind kind)
{
    double sum = 0;
    for (int i = 0; i < RAD_CAUSES; i++)
        sum += r->cause[i].after_l1.value;
    return sum > 0 ? r->cause[kind].after_l1.value / sum : 0;
}

/* ---- the table */

/* "+1.234 +- 0.056 (1.3)": in all, and by polygons. */
static void print_sums(const struct RadMeasure *all, const struct RadMeasure *polygons)
{
    printf("  %+7.3f +- %5.3f %7.3f", 100 * all->value, 50 * (all->high - all->low),
           100 * polygons->value);
}

/* Is there such light, or such an error? */
static int has_row(const struct RadCausesReport *r, int row)
{
    const int way = rows[row].way, cause = rows[row].cause;
    return (way >= 0 && (r->way[way].links > 0 || r->way[way].rays > 0))
           || (cause >= 0 && r->cause[cause].after_l1.value > 0);
}

static void print_row(const struct RadCausesReport *r, int row)
{
    printf("%-22s", rows[row].name);
    if (rows[row].way >= 0)
        printf(" %7.3f %7.3f", 100 * r->way[rows[row].way].links, 100 * r->way[rows[row].way].rays);
    if (rows[row].cause >= 0) {
        const struct RadCause *c = &r->cause[rows[row].cause];
        printf("%*s", rows[row].way < 0 ? 16 : 0, "");
        print_sums(&c->power, &c->l1);
        print_sums(&c->after, &c->after_l1);
        printf(" %4.0f %%", 100 * share_of_cause(r, (enum RadCauseKind)rows[row].cause));
    }
    putchar('\n');
}

static void print_found(const char *scene, const struct options *o, const struct found *f)
{
    const struct RadCausesReport *r = &f->causes;
    printf("%s, oracle %s: %llu links by %.3g rays, held against %.3g rays\n", scene, o->oracle,
           (unsigned long long)f->solve.links, (double)f->solve.rays, (double)r->rays);
    if (!(r->reflected > 0)) {
        printf("none of what was traced is reflected\n\n");
        return;
    }
    printf("%% of the light that is   links    rays  of one reflection          after all "
           "reflections\n"
           "reflected; +: too much  bring    find  all together    by polygon  all together    by "
           "polygon share\n");
    for (int i = 0; i < ROW_COUNT; i++)
        if (has_row(r, i))
            print_row(r, i);
    printf("%-38s", "together");
    print_sums(&r->together.power, &r->together.l1);
    print_sums(&r->together.after, &r->together.after_l1);
    printf("\n%-64s", "the solution's error, measured by particles");
    print_sums(&f->power, &f->l1);
    printf("\nwithin polygons, the cap moves %.2f %% of the exchange\n\n",
           100 * f->solve.rows.moved);
}

/* ---- JSON */

static json_t *measure_json(const struct RadMeasure *m)
{
    return json_pack("{s:f, s:f, s:f}", "value", m->value, "low", m->low, "high", m->high);
}

static json_t *cause_json(const struct RadCause *c)
{
    return json_pack("{s:o, s:o, s:o, s:o}", "power", measure_json(&c->power), "l1",
                     measure_json(&c->l1), "after", measure_json(&c->after), "after_l1",
                     measure_json(&c->after_l1));
}

static json_t *found_json(const char *scene, const struct options *o, const struct found *f)
{
    const struct RadCausesReport *r = &f->causes;
    json_t *causes = json_object(), *ways = json_object();
    for (int i = 0; i < ROW_COUNT; i++) {
        if (rows[i].way >= 0)
            json_object_set_new(ways, rows[i].key,
                                json_pack("{s:f, s:f}", "links", r->way[rows[i].way].links, "rays",
                                          r->way[rows[i].way].rays));
        if (rows[i].cause >= 0)
            json_object_set_new(causes, rows[i].key, cause_json(&r->cause[rows[i].cause]));
    }
    return json_pack("{s:o, s:o, s:I, s:I, s:I, s:f, s:o, s:o, s:o, s:o, s:o, s:f, s:f}", "scene",
                     json_text(scene), "oracle", json_text(o->oracle), "links",
                     (json_int_t)f->solve.links, "link_rays", (json_int_t)f->solve.rays, "rays",
                     (json_int_t)r->rays, "reflected", r->reflected, "ways", ways, "causes", causes,
                     "together", cause_json(&r->together), "measured_power",
                     measure_json(&f->power), "measured_l1", measure_json(&f->l1), "cap_moves",
                     f->solve.rows.moved, "seconds", r->seconds);
}

/* ---- one scene */

/* A share of what particles count, as one of what the links reflect. */
static struct RadMeasure share_of(const struct RadMeasure *m, double counted, double links)
{
    double part = links > 0 ? counted / links : 0;
    return (struct RadMeasure){part * m->value, part * m->low, part * m->high};
}

static int measure(const struct options *o, RadSolution solution, struct found *f)
{
    const struct RadCausesOptions rays = {.rays = (uint64_t)o->cause_rays};
    const struct RadMeasureOptions particles = {.rays = (uint64_t)o->cause_rays};
    struct RadErrorReport error;
    radGetReport(solution, &f->solve);
    if (radFindCauses(solution, &rays, &f->causes) < 0
        || radMeasureError(solution, &particles, &error) < 0)
        return -1;
    f->power = share_of(&error.power, error.reflected, f->causes.reflected);
    f->l1 = share_of(&error.l1_faces, error.reflected, f->causes.reflected);
    return 0;
}

static int find(const struct options *o, const char *path, struct found *f)
{
    const struct scene_options how = {.two_sided = o->two_sided, .quiet = o->quiet};
    const struct RadSolveOptions solve = solve_options(o);
    struct open_scene scene;
    struct solved s;
    if (open_scene(&scene, path, &how, o->threads) < 0)
        return -1;
    struct progress progress;
    progress_start(&progress, o->quiet);
    radSetDeviceProgressFunction(scene.device, progress_show, &progress);
    RadOracle oracle =
        open_oracle(scene.device, o->oracle, o->release, o->settings, o->setting_count);
    int status = -1;
    if (oracle && solved_open(&s, scene.device, path, scene.scene, oracle, &solve) == 0) {
        status = measure(o, s.solution, f);
        progress_end(&progress);
        if (status < 0)
            report_device(scene.device, path);
        solved_close(&s);
    }
    progress_end(&progress);
    radReleaseOracle(oracle);
    close_scene(&scene);
    return status;
}

int study_causes(const struct options *o, const struct open_scene *none)
{
    json_t *table = o->json ? json_array() : NULL;
    int unfinished = 0;
    (void)none;
    for (int i = 0; i < o->scene_count; i++) {
        struct found f;
        if (find(o, o->scenes[i], &f) < 0) {
            json_decref(table);
            return 1;
        }
        unfinished |= solved_status(&f.solve, o->scenes[i]);
        if (!o->quiet) {
            print_found(o->scenes[i], o, &f);
            fflush(stdout);
        }
        if (o->json)
            json_array_append_new(table, found_json(o->scenes[i], o, &f));
    }
    return o->json && json_file_write(o->json, table) < 0 ? 1 : unfinished;
}
