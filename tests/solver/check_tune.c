/* check_tune.c - `radiosity tune`: its search against least values known in closed form, graphs
 * with other defaults against the compiler, and its table against solves made one by one.
 * SPDX-License-Identifier: MIT */
#include "suite.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "commands/tune_fit.h"
#include "command.h"
#include "folder.h"
#include "radiosity.h"
#include "util/graph_defaults.h"
#include "util/pattern_search.h"

/* ---- the search */

enum { CALLS = 4096 };

/* A function that notes where it was asked, which must be in range and nowhere twice. */
struct watched {
    double (*f)(const int *at);
    const struct pattern_search *search;
    int calls, stop_at, together; /* stop_at 0: never */
    int at[CALLS][2];
    double least;
};

static int ask(void *user, const int *at, double *value)
{
    struct watched *w = user;
    if (w->stop_at && w->calls + 1 == w->stop_at)
        return -1;
    ck_assert_int_lt(w->calls, CALLS);
    for (int i = 0; i < w->calls; i++)
        ck_assert_msg(w->at[i][0] != at[0] || w->at[i][1] != at[1], "%d, %d asked twice", at[0],
                      at[1]);
    for (int i = 0; i < 2; i++)
        ck_assert_msg(at[i] >= w->search->low[i] && at[i] <= w->search->high[i],
                      "number %d: %d is out of range", i, at[i]);
    memcpy(w->at[w->calls++], at, sizeof w->at[0]);
    *value = w->f(at);
    w->least = fmin(w->least, *value);
    return 0;
}

/* From (x, y), ranges -100 to 100 but for `low` and `high` of both. */
static struct pattern_found look_for(double (*f)(const int *at), int x, int y, int low, int high,
                                     int evaluations, struct watched *w)
{
    const int start[2] = {x, y};
    struct pattern_search s = {.count = 2,
                               .low = {low, low},
                               .high = {high, high},
                               .step = 4,
                               .evaluations = evaluations,
                               .value = ask,
                               .together = w->together,
                               .user = w};
    int stop_at = w->stop_at;
    *w = (struct watched){
        .f = f, .search = &s, .stop_at = stop_at, .together = s.together, .least = INFINITY};
    struct pattern_found found = pattern_search(&s, start);
    ck_assert_int_eq(found.evaluations, w->calls);
    ck_assert_double_eq(found.value, w->least);
    if (w->calls)
        ck_assert_double_eq(found.value, f(found.at));
    return found;
}

static double bowl(const int *at)
{
    return (at[0] - 3.0) * (at[0] - 3.0) + 2 * (at[1] + 5.0) * (at[1] + 5.0);
}

/* Along the diagonal, where neither number alone leads far. */
static double valley(const int *at)
{
    double across = at[0] - at[1], along = at[0] + at[1] - 1800.0;
    return 0.4 * across * across + along * along / 2;
}

static double stairs(const int *at)
{
    return floor(abs(at[0] - 7) / 3.0) + floor(abs(at[1] + 2) / 2.0);
}

/* A bowl of which nothing is known above a line. */
static double fenced(const int *at)
{
    return at[0] + at[1] > 0 ? INFINITY : bowl(at);
}

START_TEST(searches_end_at_the_least_value)
{
    static struct watched w;
    struct pattern_found found = look_for(bowl, 0, 0, -100, 100, 1000, &w);
    ck_assert_int_eq(found.end, PATTERN_FOUND);
    ck_assert(found.at[0] == 3 && found.at[1] == -5 && found.value == 0);

    found = look_for(valley, 0, 0, -1000, 1000, 1000, &w);
    ck_assert_int_eq(found.end, PATTERN_FOUND);
    ck_assert_msg(found.at[0] == 900 && found.at[1] == 900, "%d, %d", found.at[0], found.at[1]);
    /* Steps of 4 alone are 225 along each; moves that are made once more grow. */
    ck_assert_msg(w.calls < 225, "%d looks", w.calls);

    found = look_for(stairs, -40, 40, -100, 100, 1000, &w);
    ck_assert(found.end == PATTERN_FOUND && found.value == 0);

    found = look_for(fenced, -20, -20, -100, 100, 1000, &w);
    ck_assert(found.at[0] == 3 && found.at[1] == -5);
}
END_TEST

/* A valley so narrow that no number alone leads down it. */
static double gorge(const int *at)
{
    return 10 * abs(at[0] - at[1]) + abs(at[0] + at[1] - 1800);
}

START_TEST(numbers_rise_together)
{
    static struct watched w;
    struct pattern_found found = look_for(gorge, 0, 0, -1000, 1000, 1000, &w);
    ck_assert(found.end == PATTERN_FOUND && found.at[0] == 0 && found.at[1] == 0);
    w.together = 1;
    found = look_for(gorge, 0, 0, -1000, 1000, 1000, &w);
    ck_assert_int_eq(found.end, PATTERN_FOUND);
    ck_assert_msg(found.at[0] == 900 && found.at[1] == 900, "%d, %d", found.at[0], found.at[1]);
    found = look_for(bowl, 0, 0, -2, 1, 1000, &w);
    ck_assert(found.at[0] == 1 && found.at[1] == -2);
}
END_TEST

START_TEST(ranges_hold)
{
    static struct watched w;
    struct pattern_found found = look_for(bowl, 0, 0, -2, 1, 1000, &w);
    ck_assert(found.at[0] == 1 && found.at[1] == -2);
    found = look_for(bowl, 5, 5, 5, 5, 1000, &w);
    ck_assert(found.end == PATTERN_FOUND && found.evaluations == 1);
}
END_TEST

START_TEST(searches_can_be_cut_short)
{
    static struct watched w;
    struct pattern_found found = look_for(bowl, 50, 50, -100, 100, 7, &w);
    ck_assert(found.end == PATTERN_SPENT && found.evaluations == 7);
    w.stop_at = 5;
    found = look_for(bowl, 50, 50, -100, 100, 1000, &w);
    ck_assert(found.end == PATTERN_STOPPED && found.evaluations == 4);
    w.stop_at = 1;
    found = look_for(bowl, 50, 49, -100, 100, 1000, &w);
    ck_assert(found.end == PATTERN_STOPPED && isinf(found.value) && found.at[1] == 49);
}
END_TEST

/* ---- values and graphs */

START_TEST(values_have_two_digits)
{
    const struct tune_parameter p = {.name = "x", .value = 0.0123456};
    ck_assert_double_eq(tune_value(&p, 0), 0.0123456);
    for (int q = -24; q <= 24; q++) {
        char text[GRAPH_NUMBER];
        double value = tune_value(&p, q), exact = p.value * exp2(q / 4.0);
        if (q == 0)
            continue;
        graph_number(value, text);
        ck_assert_double_eq(strtod(text, NULL), value);
        ck_assert_msg(fabs(value / exact - 1) <= 0.05, "%d: %g for %g", q, value, exact);
        snprintf(text, sizeof text, "%.1e", value);
        ck_assert_double_eq(strtod(text, NULL), value);
        ck_assert_double_gt(value, tune_value(&p, q - 1));
    }
}
END_TEST

static void becomes(const char *text, const struct graph_default *d, int count, const char *wanted)
{
    const char *missing;
    char *now = graph_with_defaults(text, d, count, &missing);
    ck_assert_ptr_nonnull(now);
    ck_assert_str_eq(now, wanted);
    free(now);
}

START_TEST(numbers_alone_change)
{
    const struct graph_default two[] = {{"near", 0.25}, {"far", 1e-7}};
    becomes(
        "# param near : ratio = 7 ;\n"
        "oracle a \"says param near : ratio = 8 \\\" \" {\r\n"
        "  param\tnear# why\n : ratio=3.5e-2 in [0, 1] \"param far : ratio = 2\";\n"
        "  param nearer : ratio = 1; param far : ratio\n=\n1E+3;  node near = far(x = 5) {}\n}",
        two, 2,
        "# param near : ratio = 7 ;\n"
        "oracle a \"says param near : ratio = 8 \\\" \" {\r\n"
        "  param\tnear# why\n : ratio=0.25 in [0, 1] \"param far : ratio = 2\";\n"
        "  param nearer : ratio = 1; param far : ratio\n=\n1e-07;  node near = far(x = 5) {}\n}");
    becomes("param near : ratio = 1", two, 0, "param near : ratio = 1");

    const char *missing = "";
    ck_assert_ptr_null(graph_with_defaults("param near : ratio = 1;", two, 2, &missing));
    ck_assert_str_eq(missing, "far");
    ck_assert_ptr_null(graph_with_defaults("param near : ratio in [0, 1];", two, 1, &missing));
    ck_assert_str_eq(missing, "near");
    ck_assert_ptr_null(graph_with_defaults("", two, 1, &missing));
}
END_TEST

/* Each parameter that could be fitted, of each built-in graph, alone: the new text compiles, has
 * that value, and all others have theirs. */
START_TEST(graphs_still_compile)
{
    RadDevice device = radNewDevice(NULL);
    int changed = 0;
    for (const char *const *name = radGetOracleNames(); *name; name++) {
        const char *text = radGetOracleText(*name), *missing;
        ck_assert_ptr_nonnull(text);
        RadOracle oracle = radNewOracle(device, *name, RAD_RELEASE_FLAT);
        struct RadOracleReport was, is;
        radGetOracleReport(oracle, &was);
        for (int i = 0; i < was.parameter_count; i++) {
            const struct oracle_parameter *p = &was.parameters[i];
            double value = p->value / 2;
            if (p->integer || !(value > 0) || isinf(value) || value < p->low)
                continue;
            const struct graph_default d = {p->name, value};
            char *now = graph_with_defaults(text, &d, 1, &missing);
            ck_assert_ptr_nonnull(now);
            RadOracle made = radParseOracle(device, "now.dag", now, NULL, RAD_RELEASE_DAG);
            ck_assert_msg(made != NULL, "%s: %s", *name, radGetDeviceErrorMessage(device));
            radGetOracleReport(made, &is);
            ck_assert_int_eq(is.parameter_count, was.parameter_count);
            for (int k = 0; k < is.parameter_count; k++)
                ck_assert_msg(is.parameters[k].value == (k == i ? value : was.parameters[k].value),
                              "%s: %s is %g", *name, is.parameters[k].name, is.parameters[k].value);
            changed++;
            radReleaseOracle(made);
            free(now);
        }
        radReleaseOracle(oracle);
    }
    ck_assert_int_ge(changed, 17);
    ck_assert_ptr_null(radGetOracleText("nix"));
    ck_assert_ptr_null(radGetOracleText(NULL));
    radReleaseDevice(device);
}
END_TEST

/* ---- the command, by others */

static json_t *run(int wanted, const char *json, const char *format, ...)
{
    char command[2048];
    va_list list;
    va_start(list, format);
    vsnprintf(command, sizeof command, format, list);
    va_end(list);
    ck_assert_msg(shell("$RADIOSITY %s -q --json %s", command, in_folder(json)) == wanted, "%s",
                  command);
    json_t *value = json_load_file(in_folder(json), 0, NULL);
    ck_assert_msg(value != NULL, "%s left no JSON", command);
    return value;
}

static double number(const json_t *from, const char *a, const char *b)
{
    const json_t *value = json_object_get(from, a);
    value = b ? json_object_get(value, b) : value;
    ck_assert_msg(json_is_number(value), "no %s.%s", a, b ? b : "");
    return json_number_value(value);
}

enum { SCENES = 3 };
static const char *const scenes[SCENES] = {"furnace", "cornell", "furnace_4"};

/* Rays and links of a solve of its own, of which the error that tune told has to be what it
 * measures: its interval holds 95 of 100, and the reference of tune has noise beside it. */
static double cost_alone(int scene, double limit, double told)
{
    json_t *j = run(0, "solve.json",
                    "solve examples/scenes/%s.obj --oracle ff --set limit=%.17g --no-correct",
                    scenes[scene], limit);
    const json_t *l1 = json_object_get(json_object_get(j, "error"), "l1_faces");
    double low = number(l1, "low", NULL), high = number(l1, "high", NULL);
    ck_assert_msg(told > low - 0.005 && told < high + 0.005, "%s at %g: %g, not %g to %g",
                  scenes[scene], limit, told, low, high);
    double cost = number(j, "rays", NULL) + number(j, "links", NULL);
    json_decref(j);
    return cost;
}

/* The same without a look at the error, and each only once. */
static double cost_again(int scene, double limit)
{
    static struct {
        int scene;
        double limit, cost;
    } known[64];
    static int count;
    for (int i = 0; i < count; i++)
        if (known[i].scene == scene && known[i].limit == limit)
            return known[i].cost;
    json_t *j = run(0, "solve.json",
                    "solve examples/scenes/%s.obj --oracle ff --set limit=%.17g --no-correct "
                    "--no-errors",
                    scenes[scene], limit);
    ck_assert_int_lt(count, 64);
    known[count].scene = scene;
    known[count].limit = limit;
    known[count].cost = number(j, "rays", NULL) + number(j, "links", NULL);
    json_decref(j);
    return known[count++].cost;
}

START_TEST(errors_above_the_target_are_dear)
{
    json_t *t = run(0, "dear.json",
                    "tune ff examples/scenes/cornell.obj --error 1%% --power 3 --evaluations 1 "
                    "--param limit=0.2:0.3");
    ck_assert_str_eq(json_string_value(json_object_get(t, "basis")), "linear");
    const json_t *scene = json_array_get(json_object_get(t, "scenes"), 0);
    ck_assert_int_eq((int)json_array_size(json_object_get(t, "folds")), 0);
    ck_assert(json_is_null(json_object_get(t, "worst_ratio")));
    for (int i = 0; i < 2; i++) {
        const json_t *r = json_object_get(scene, i ? "fitted" : "default");
        double error = number(r, "error", NULL), cost = number(r, "cost", NULL);
        ck_assert_double_gt(error, 0.01);
        double limit = i ? number(t, "fitted", "limit") : 0.05;
        ck_assert_double_eq(cost, cost_alone(1, limit, error));
        double dear = pow(1 + error / 0.01 * error / 0.01, 1.5);
        ck_assert_double_eq_tol(number(r, "price", NULL) / (cost * dear), 1, 1e-9);
    }
    ck_assert_double_eq(number(t, "fitted", "limit"), 0.2);
    json_decref(t);
}
END_TEST

/* 10 % is more than any of these is off by, so that what is needed is what it costs. */
START_TEST(tables_are_those_of_single_solves)
{
    const char *how = "tune ff examples/scenes/furnace.obj examples/scenes/cornell.obj "
                      "examples/scenes/furnace_4.obj --error 10% --evaluations 4";
    json_t *t =
        run(0, "one.json", "%s --threads 1 --param limit=0.02:2 -o %s", how, in_folder("ff.dag"));
    const json_t *list = json_object_get(t, "scenes"), *folds = json_object_get(t, "folds");
    double best = number(t, "fitted", "limit"), mean = 0, worst = 0;
    ck_assert_double_gt(best, 0.05); /* its default is finer than 10 % takes */
    ck_assert_int_eq((int)json_array_size(list), SCENES);
    ck_assert_int_eq((int)json_array_size(folds), SCENES);
    for (int s = 0; s < SCENES; s++) {
        const json_t *scene = json_array_get(list, (size_t)s);
        double price[2];
        for (int i = 0; i < 2; i++) {
            const json_t *r = json_object_get(scene, i ? "fitted" : "default");
            double error = number(r, "error", NULL) / 0.1;
            price[i] = number(r, "price", NULL);
            ck_assert_double_lt(error, 1);
            ck_assert_double_eq(number(r, "cost", NULL), cost_again(s, i ? best : 0.05));
            ck_assert_double_eq_tol(price[i] / number(r, "cost", NULL), pow(1 + error * error, 3),
                                    1e-9);
        }
        mean += log(price[1] / price[0]) / SCENES;
    }
    ck_assert_double_eq_tol(exp(mean), number(t, "price_times", NULL), 1e-9);
    ck_assert_double_lt(mean, 0);
    for (int s = 0; s < SCENES; s++) {
        const json_t *mine = json_array_get(folds, (size_t)s);
        double used = 0, left = 0;
        ck_assert_str_eq(json_string_value(json_object_get(mine, "scene")), scenes[s]);
        for (int f = 0; f < SCENES; f++) {
            const json_t *fold = json_array_get(folds, (size_t)f);
            double price = log(cost_again(s, number(fold, "parameters", "limit")));
            *(s == f ? &left : &used) += price / (s == f ? 1 : SCENES - 1);
        }
        ck_assert_double_lt(number(mine, "left_out", "error"), 0.1);
        ck_assert_double_eq_tol(exp(used) / number(mine, "used", "cost"), 1, 1e-9);
        ck_assert_double_eq_tol(exp(left) / number(mine, "left_out", "cost"), 1, 1e-9);
        ck_assert_double_eq_tol(exp(left - used) / number(mine, "ratio", NULL), 1, 1e-9);
        worst = fmax(worst, exp(left - used));
    }
    ck_assert_double_eq_tol(worst, number(t, "worst_ratio", NULL), 1e-9);

    RadDevice device = radNewDevice(NULL);
    RadOracle oracle = radLoadOracle(device, in_folder("ff.dag"), NULL, RAD_RELEASE_DAG);
    ck_assert_double_eq(radGetOracleParameter(oracle, "limit"), best);
    radReleaseOracle(oracle);
    radReleaseDevice(device);

    json_t *two = run(0, "two.json", "%s --threads 2 --param limit=0.02:2", how);
    json_object_del(t, "seconds");
    json_object_del(two, "seconds");
    ck_assert_msg(json_equal(t, two), "two threads tell something else than one");
    json_decref(two);
    json_decref(t);
}
END_TEST

/* Of two scenes, the fit without one is the fit to the other alone: and so are its numbers. A
 * furnace asks for few links and no rays, cornell for many, so that the two differ. 10 %: a fit to
 * the furnace, which any threshold solves, has to do for cornell, too. */
START_TEST(what_is_left_out_is_not_seen)
{
    const char *how = "--error 10% --power 8 --evaluations 9";
    json_t *both = run(0, "both.json", "tune ff examples/scenes/%s.obj examples/scenes/%s.obj %s",
                       scenes[0], scenes[1], how);
    double limit[2];
    for (int s = 0; s < 2; s++) {
        json_t *one = run(0, "alone.json", "tune ff examples/scenes/%s.obj %s", scenes[s], how);
        const json_t *folds = json_object_get(both, "folds");
        const json_t *without = json_array_get(folds, (size_t)!s);
        const json_t *mine = json_array_get(folds, (size_t)s);
        limit[s] = number(one, "fitted", "limit");
        ck_assert_double_eq(limit[s], number(without, "lowest", "limit"));
        const json_t *left = json_object_get(mine, "left_out");
        double used[2] = {number(mine, "used", "cost"), number(mine, "used", "error")};
        double fared[2] = {number(left, "cost", NULL), number(left, "error", NULL)};
        double more = pow(fmax(1, fared[1] / 0.1) / fmax(1, used[1] / 0.1), 2);
        ck_assert_double_eq_tol(
            used[0] / cost_alone(s, number(without, "parameters", "limit"), used[1]), 1, 1e-12);
        ck_assert_double_eq(fared[0], cost_alone(s, number(mine, "parameters", "limit"), fared[1]));
        ck_assert_double_eq_tol(fared[0] / used[0] * more / number(mine, "ratio", NULL), 1, 1e-9);
        json_decref(one);
    }
    ck_assert_double_ne(limit[0], limit[1]);
    ck_assert(json_is_true(json_object_get(both, "carries_over")));
    json_decref(both);
}
END_TEST

/* The penalty is the one with which scenes left out pay least of those that carry over, and what
 * they pay is what is told of each. Held by any, fits lie between where they began and where they
 * ended.
 */
static void check_holds(const json_t *t)
{
    const json_t *holds = json_object_get(t, "penalties"), *folds = json_object_get(t, "folds");
    double least = INFINITY, taken = 0, mean = 0;
    ck_assert_int_gt((int)json_array_size(holds), 2);
    for (size_t i = 0; i < json_array_size(holds); i++) {
        const json_t *h = json_array_get(holds, i);
        double times = number(h, "left_out_times", NULL);
        if (json_is_null(json_object_get(h, "penalty")))
            ck_assert_double_eq(times, 1); /* the start */
        if (number(h, "worst_ratio", NULL) <= 1.5)
            least = fmin(least, times);
        if (json_is_true(json_object_get(h, "taken")))
            taken = times;
    }
    ck_assert_double_eq(taken, least);
    for (int s = 0; s < 2; s++) {
        const json_t *f = json_array_get(folds, (size_t)s);
        const json_t *scene = json_array_get(json_object_get(t, "scenes"), (size_t)s);
        const char *name = json_object_iter_key(json_object_iter(json_object_get(f, "lowest")));
        double start = number(t, "default", name), lowest = number(f, "lowest", name);
        double held = number(f, "parameters", name);
        ck_assert_double_ge(held, fmin(start, lowest));
        ck_assert_double_le(held, fmax(start, lowest));
        mean += log(number(f, "left_out", "price")
                    / number(json_object_get(scene, "default"), "price", NULL))
                / 2;
    }
    ck_assert_double_eq_tol(exp(mean), taken, 1e-9);
}

/* By ff one carries over, by bf none but the start. */
START_TEST(scenes_left_out_say_how_near_fits_stay)
{
    for (int k = 0; k < 2; k++) {
        json_t *t = run(
            k ? 3 : 0, "held.json",
            "tune %s examples/scenes/furnace.obj examples/scenes/cornell.obj %s", k ? "bf" : "ff",
            k ? "--error 8% --power 2 --evaluations 7" : "--error 10% --power 8 --evaluations 9");
        check_holds(t);
        json_decref(t);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("tune");
    TCase *t = tcase_create("tune");
    tcase_add_test(t, searches_end_at_the_least_value);
    tcase_add_test(t, numbers_rise_together);
    tcase_add_test(t, ranges_hold);
    tcase_add_test(t, searches_can_be_cut_short);
    tcase_add_test(t, values_have_two_digits);
    tcase_add_test(t, numbers_alone_change);
    tcase_add_test(t, graphs_still_compile);
    tcase_add_test(t, errors_above_the_target_are_dear);
    tcase_add_test(t, tables_are_those_of_single_solves);
    tcase_add_test(t, what_is_left_out_is_not_seen);
    tcase_add_test(t, scenes_left_out_say_how_near_fits_stay);
    tcase_set_timeout(t, 300);
    suite_add_tcase(suite, t);
    if (folder_make("tune") < 0)
        return 1;
    setenv("OMP_WAIT_POLICY", "passive", 0); /* many short solves beside other suites */
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
