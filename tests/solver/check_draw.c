/* check_draw.c - the file of solve --statistics against the solve's own account, and the drawing
 * made of it: what it says twice must agree, and what is wrong with either is told.
 * SPDX-License-Identifier: MIT */
#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "command.h"
#include "folder.h"
#include "suite.h"
#include "util/text_file.h"

static char message[4096]; /* what the last run said on stderr */

/* Runs radiosity with these arguments in the environment `before` ("": as it is). Returns its exit
 * status. */
static int run(const char *before, const char *format, ...) __attribute__((format(printf, 2, 3)));
static int run(const char *before, const char *format, ...)
{
    char arguments[2048];
    va_list list;
    va_start(list, format);
    vsnprintf(arguments, sizeof arguments, format, list);
    va_end(list);
    const int status = shell("%s \"$RADIOSITY\" %s 2>%s", before, arguments, in_folder("message"));
    size_t size;
    char *text = text_file_read(in_folder("message"), &size);
    snprintf(message, sizeof message, "%s", text ? text : "");
    free(text);
    return status;
}

static json_int_t whole(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    ck_assert_msg(json_is_integer(value), "no whole number %s", key);
    return json_integer_value(value);
}

static const char *word(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    ck_assert_msg(text != NULL, "no text %s", key);
    return text;
}

static const json_t *find(const json_t *list, const char *key, const char *name)
{
    size_t i;
    json_t *item;
    json_array_foreach(list, i, item)
    {
        if (strcmp(word(item, key), name) == 0)
            return item;
    }
    return NULL;
}

static json_t *load(const char *path)
{
    json_error_t error;
    json_t *document = json_load_file(path, 0, &error);
    ck_assert_msg(document != NULL, "%s:%d: %s", path, error.line, error.text);
    return document;
}

/* room.obj, solved by bf with its statistics, once for all tests. */
static char *solved(void)
{
    if (access(in_folder("bf.json"), R_OK) != 0)
        ck_assert_int_eq(run("",
                             "solve examples/scenes/room.obj --oracle bf --no-errors -q "
                             "--threads 1 --statistics %s --json %s",
                             in_folder("bf.json"), in_folder("solve.json")),
                         0);
    return in_folder("bf.json");
}

/* ---- the file */

static const char *const oracles[] = {"bf", "power"};

/* Nodes against answers, arcs against nodes, decisions and rays against what the solve told. */
START_TEST(test_sums)
{
    ck_assert_int_eq(run("",
                         "solve examples/scenes/room.obj --oracle %s --no-errors -q "
                         "--statistics %s --json %s",
                         oracles[_i], in_folder("s.json"), in_folder("j.json")),
                     0);
    json_t *s = load(in_folder("s.json")), *solve = load(in_folder("j.json")), *node, *answer,
           *pass;
    const json_t *nodes = json_object_get(s, "nodes"), *unused = json_object_get(s, "unused");
    json_t *decided = json_object();
    json_int_t rays = 0;
    double time = 0;
    size_t i, k, dead = 0, silent = 0;
    ck_assert_str_eq(word(s, "schema"), "radiosity-statistics/1");
    ck_assert_str_eq(word(s, "oracle"), oracles[_i]);
    ck_assert_int_eq(whole(json_array_get(nodes, 0), "calls"), whole(solve, "pairs"));
    ck_assert_int_eq(whole(s, "discussions"), whole(solve, "pairs"));
    json_array_foreach(nodes, i, node)
    {
        json_int_t sum = 0, in = i == 0 ? whole(solve, "pairs") : 0;
        json_array_foreach(json_object_get(node, "answers"), k, answer)
        {
            const char *target = word(answer, "target");
            json_int_t count = whole(answer, "count");
            sum += count;
            if (!find(nodes, "node", target) && count)
                json_object_set_new(
                    decided, target,
                    json_integer(json_integer_value(json_object_get(decided, target)) + count));
            if (!count && whole(node, "calls")) {
                const json_t *arcs = json_object_get(unused, "arcs");
                size_t a;
                json_t *arc;
                int told = 0;
                json_array_foreach(arcs, a, arc)
                {
                    told |= strcmp(word(arc, "node"), word(node, "node")) == 0
                            && strcmp(word(arc, "answer"), word(answer, "answer")) == 0;
                }
                ck_assert_msg(told, "%s: %s is not told as unused", word(node, "node"),
                              word(answer, "answer"));
                dead++;
            }
        }
        ck_assert_int_eq(sum, whole(node, "calls"));
        silent += sum == 0;
        for (size_t n = 0; n < json_array_size(nodes); n++) {
            json_array_foreach(json_object_get(json_array_get(nodes, n), "answers"), k, answer)
            {
                if (strcmp(word(answer, "target"), word(node, "node")) == 0)
                    in += whole(answer, "count");
            }
        }
        ck_assert_int_eq(in, sum);
        rays += whole(node, "rays");
        time += json_number_value(json_object_get(node, "seconds_share"));
    }
    ck_assert_uint_eq(json_array_size(json_object_get(unused, "arcs")), dead);
    ck_assert_uint_eq(json_array_size(json_object_get(unused, "nodes")), silent);
    ck_assert_int_eq(rays, whole(solve, "rays"));
    ck_assert_int_eq(rays, whole(s, "rays"));
    ck_assert_double_eq_tol(time, 1, 1e-9);
    ck_assert_msg(json_equal(decided, json_object_get(solve, "decisions")),
                  "decisions are not those of solve --json");

    /* pass by pass, the same again */
    json_int_t discussions = 0, cast = 0;
    json_array_foreach(json_object_get(s, "passes"), i, pass)
    {
        ck_assert_int_eq(whole(pass, "pass"), (json_int_t)i + 1);
        discussions += whole(pass, "discussions");
        cast += whole(pass, "rays");
        json_array_foreach(json_object_get(pass, "nodes"), k, node)
        {
            json_int_t sum = 0;
            for (size_t a = 0; a < json_array_size(json_object_get(node, "answers")); a++)
                sum += whole(json_array_get(json_object_get(node, "answers"), a), "count");
            ck_assert_int_eq(sum, whole(node, "calls"));
        }
    }
    ck_assert_uint_eq(json_array_size(json_object_get(s, "passes")),
                      (size_t)whole(solve, "passes") + 1);
    ck_assert_int_eq(discussions, whole(solve, "pairs"));
    ck_assert_int_eq(cast, rays);
    json_decref(decided);
    json_decref(s);
    json_decref(solve);
}
END_TEST

/* Each step of a path leads to the next; no more discussions went a path than any of its arcs; the
 * first costs the most. */
START_TEST(test_paths)
{
    json_t *s = load(solved()), *path, *step;
    const json_t *nodes = json_object_get(s, "nodes"),
                 *paths = json_object_get(json_object_get(s, "paths"), "most_expensive");
    double last = INFINITY;
    size_t i, k;
    ck_assert_uint_gt(json_array_size(paths), 3);
    json_array_foreach(paths, i, path)
    {
        const char *at = word(json_array_get(nodes, 0), "node");
        json_array_foreach(json_object_get(path, "steps"), k, step)
        {
            ck_assert_str_eq(word(step, "node"), at);
            const json_t *answer = find(json_object_get(find(nodes, "node", at), "answers"),
                                        "answer", word(step, "answer"));
            ck_assert_ptr_nonnull(answer);
            ck_assert_int_le(whole(path, "discussions"), whole(answer, "count"));
            at = word(answer, "target");
        }
        ck_assert_str_eq(word(path, "decision"), at);
        ck_assert_ptr_null(find(nodes, "node", at));
        double seconds = json_number_value(json_object_get(path, "seconds"));
        ck_assert_double_le(seconds, last);
        last = seconds;
    }
    json_decref(s);
}
END_TEST

/* What is counted does not hang on threads. */
START_TEST(test_threads)
{
    ck_assert_int_eq(run("",
                         "solve examples/scenes/room.obj --oracle bf --no-errors -q "
                         "--threads 2 --statistics %s",
                         in_folder("two.json")),
                     0);
    json_t *one = load(solved()), *two = load(in_folder("two.json")), *node;
    size_t i, k;
    json_array_foreach(json_object_get(one, "nodes"), i, node)
    {
        const json_t *other = json_array_get(json_object_get(two, "nodes"), i);
        static const char *const same[] = {"node", "calls", "rays", "terms", "answers"};
        for (k = 0; k < sizeof same / sizeof *same; k++)
            ck_assert_msg(
                json_equal(json_object_get(node, same[k]), json_object_get(other, same[k])),
                "%s: %s differ by threads", word(node, "node"), same[k]);
    }
    json_decref(one);
    json_decref(two);
}
END_TEST

/* CSV tells the same counts. */
START_TEST(test_csv)
{
    ck_assert_int_eq(run("",
                         "solve examples/scenes/room.obj --oracle bf --no-errors -q "
                         "--statistics %s",
                         in_folder("bf.csv")),
                     0);
    json_t *s = load(solved());
    FILE *f = fopen(in_folder("bf.csv"), "r");
    char line[4096], name[64], answer[64];
    unsigned long long count;
    int nodes = 0, answers = 0, paths = 0, passes = 0;
    ck_assert_ptr_nonnull(f);
    ck_assert_ptr_nonnull(fgets(line, sizeof line, f));
    ck_assert_str_eq(
        line, "what,pass,node,tool,answer,kind,target,count,share,seconds,mean_seconds,rays\n");
    while (fgets(line, sizeof line, f)) {
        int commas = 0;
        for (const char *c = line; *c; c++)
            commas += *c == ',';
        ck_assert_msg(commas == 11, "%d commas in %s", commas, line);
        if (sscanf(line, "node,0,%63[^,],%*[^,],,,,%llu,", name, &count) == 2) {
            const json_t *node = find(json_object_get(s, "nodes"), "node", name);
            ck_assert_int_eq(whole(node, "calls"), (json_int_t)count);
            nodes++;
        } else if (sscanf(line, "answer,0,%63[^,],%*[^,],%63[^,],%*[^,],%*[^,],%llu,", name, answer,
                          &count)
                   == 3) {
            const json_t *node = find(json_object_get(s, "nodes"), "node", name);
            ck_assert_int_eq(
                whole(find(json_object_get(node, "answers"), "answer", answer), "count"),
                (json_int_t)count);
            answers++;
        }
        paths += strncmp(line, "path,", 5) == 0;
        passes += strncmp(line, "node,1,", 7) == 0;
    }
    fclose(f);
    ck_assert_int_eq(nodes, (int)json_array_size(json_object_get(s, "nodes")));
    ck_assert_int_gt(answers, nodes);
    ck_assert_int_gt(paths, 3);
    ck_assert_int_gt(passes, 3);
    json_decref(s);
}
END_TEST

/* ---- the drawing */

static int count_of(const char *text, const char *part)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, part)); at++)
        count++;
    return count;
}

static char *read_whole(const char *path)
{
    size_t size;
    char *text = text_file_read(path, &size);
    ck_assert_msg(text != NULL, "%s cannot be read", path);
    return text;
}

static int has_dot(void)
{
    return system("dot -V >/dev/null 2>&1") == 0;
}

static void check_xml(const char *path)
{
    char command[700];
    if (system("xmllint --version >/dev/null 2>&1") != 0) {
        printf("skipped: xmllint is not there, drawings are not parsed\n");
        return;
    }
    snprintf(command, sizeof command, "xmllint --noout %s", path);
    ck_assert_int_eq(system(command), 0);
}

/* To each place that a node's answers lead to, a line for each kind of answer, which ends at a
 * thing that is drawn; with statistics dead answers may have their own. */
static void check_ways(const char *svg, const json_t *node, int counted)
{
    const json_t *arcs = json_object_get(node, "arcs");
    char to[256], way[512];
    int lines = 0;
    for (size_t i = 0; i < json_array_size(arcs); i++) {
        const json_t *arc = json_array_get(arcs, i);
        const char *key = json_object_get(arc, "node") ? "node" : "decision";
        if (*key == 'n')
            snprintf(to, sizeof to, "\"node-%s\"", word(arc, key));
        else
            snprintf(to, sizeof to, "\"leaf-%s-%s\"", word(node, "name"), word(arc, key));
        snprintf(way, sizeof way, " data-from=\"node-%s\" data-to=%s>", word(node, "name"), to);
        ck_assert_msg(strstr(svg, way) != NULL, "no line%s", way);
        snprintf(way, sizeof way, " id=%s", to);
        ck_assert_int_eq(count_of(svg, way), 1);
        int first = 1;
        for (size_t k = 0; k < i; k++) {
            const json_t *other = json_array_get(arcs, k);
            first &= !json_equal(json_object_get(arc, key), json_object_get(other, key))
                     || !json_equal(json_object_get(arc, "kind"), json_object_get(other, "kind"));
        }
        lines += first;
    }
    snprintf(way, sizeof way, " data-from=\"node-%s\"", word(node, "name"));
    ck_assert_int_ge(count_of(svg, way), lines);
    ck_assert_int_le(count_of(svg, way), counted ? (int)json_array_size(arcs) : lines);
}

/* A group for each node, branch and leaf; what the statistics call unused is grey, and nothing
 * else; twice the same bytes. */
START_TEST(test_drawing)
{
    const char *name = _i == 0 ? "bf" : "power";
    const char *statistics = _i == 0 ? solved() : NULL;
    if (!has_dot()) {
        printf("skipped: Graphviz is not there, nothing is drawn\n");
        return;
    }
    char command[1024];
    snprintf(command, sizeof command, "%s --emit=json -Wno-all examples/oracles/%s.dag > %s",
             getenv("DAGC"), name, in_folder("graph.json"));
    ck_assert_int_eq(system(command), 0);
    json_t *graph = load(in_folder("graph.json")), *s = statistics ? load(statistics) : NULL;
    const json_t *oracle = json_array_get(json_object_get(graph, "oracles"), 0);
    const char *with = statistics ? "--statistics" : "";
    ck_assert_int_eq(run("", "draw %s %s %s -o %s", name, with, statistics ? statistics : "",
                         in_folder("a.svg")),
                     0);
    ck_assert_str_eq(message, "");
    ck_assert_int_eq(run("", "draw %s %s %s -o %s", name, with, statistics ? statistics : "",
                         in_folder("b.svg")),
                     0);
    char *a = read_whole(in_folder("a.svg")), *b = read_whole(in_folder("b.svg"));
    ck_assert_str_eq(a, b);
    check_xml(in_folder("a.svg"));
    const json_t *nodes = json_object_get(oracle, "nodes");
    ck_assert_int_eq(count_of(a, " id=\"node-"), (int)json_array_size(nodes));
    ck_assert_int_eq(count_of(a, "\" id=\"branch-"),
                     (int)json_array_size(json_object_get(oracle, "branches")));
    size_t i;
    json_t *node;
    json_array_foreach(nodes, i, node)
    {
        char id[128];
        snprintf(id, sizeof id, " id=\"node-%s\"", word(node, "name"));
        ck_assert_int_eq(count_of(a, id), 1);
        check_ways(a, node, s != NULL);
    }
    /* drawn without a place, things would stand in the corner */
    ck_assert_int_eq(count_of(a, "M0.0,0.0"), 0);
    ck_assert_ptr_nonnull(strstr(a, "prefers-color-scheme:dark"));
    int dead = count_of(a, " dead\" id=\"arc-");
    if (s) {
        size_t k;
        json_t *answer;
        int groups = 0;
        json_array_foreach(json_object_get(s, "nodes"), i, node)
        {
            char class[128];
            snprintf(class, sizeof class, " unused\" id=\"node-%s\"", word(node, "node"));
            ck_assert_int_eq(count_of(a, class), whole(node, "calls") == 0);
            json_array_foreach(json_object_get(node, "answers"), k, answer)
            {
                char title[256];
                snprintf(title, sizeof title, "%s: %s (%s) leads to %s, %lld of %lld times",
                         word(node, "node"), word(answer, "answer"), word(answer, "kind"),
                         word(answer, "target"), (long long)whole(answer, "count"),
                         (long long)whole(node, "calls"));
                ck_assert_msg(strstr(a, title) != NULL, "not told: %s", title);
                groups += whole(answer, "count") == 0;
            }
        }
        ck_assert_int_gt(dead, 0);
        ck_assert_int_le(dead, groups); /* those of one kind to one place share a line */
        json_decref(s);
    } else {
        ck_assert_int_eq(dead, 0);
        ck_assert_int_eq(count_of(a, " heat0\" id="), 0);
    }
    free(a);
    free(b);
    json_decref(graph);
}
END_TEST

/* ---- what is wrong */

static void write_text(const char *path, const char *text, size_t length)
{
    FILE *f = fopen(path, "w");
    ck_assert_ptr_nonnull(f);
    fwrite(text, 1, length, f);
    fclose(f);
}

/* The statistics with one text replaced, or cut before it where `by` is NULL: what draw says. */
static void refused(const char *what, const char *by, const char *says)
{
    char *text = read_whole(solved()), *at = strstr(text, what), *path = in_folder("wrong.json");
    ck_assert_msg(at != NULL, "no %s in the statistics", what);
    FILE *f = fopen(path, "w");
    ck_assert_ptr_nonnull(f);
    fwrite(text, 1, (size_t)(at - text), f);
    if (by)
        fprintf(f, "%s%s", by, at + strlen(what));
    fclose(f);
    free(text);
    unlink(in_folder("none.svg"));
    ck_assert_int_eq(run("", "draw bf --statistics %s -o %s", path, in_folder("none.svg")), 1);
    ck_assert_msg(strstr(message, says) != NULL, "not '%s' but: %s", says, message);
    ck_assert_int_eq(access(in_folder("none.svg"), F_OK), -1);
}

START_TEST(test_damaged)
{
    refused("\"unused\"", NULL, "wrong.json:");
    refused("\"unused\"", NULL, ": error: not JSON");
    refused("radiosity-statistics/1", "radiosity-statistics/7", "schema radiosity-statistics/7");
    refused("\"schema\"", "\"scheme\"", "no \"schema\"");
    refused("\"calls\":", "\"called\":", "\"calls\" is not a number from 0");
    refused("\"tool\": \"clusters\"", "\"tool\": \"larger\"", "the graph has changed since");
    refused("\"oracle\": \"bf\"", "\"oracle\": \"gap\"", "of the oracle gap, not of bf");
    refused("\"answers\":", "\"replies\":", "\"answers\" is not a list");
    write_text(in_folder("wrong.json"), "[1]", 3);
    ck_assert_int_eq(
        run("", "draw bf --statistics %s -o %s", in_folder("wrong.json"), in_folder("none.svg")),
        1);
    ck_assert_ptr_nonnull(strstr(message, "no \"schema\""));
    ck_assert_int_eq(
        run("", "draw bf --statistics %s -o %s", in_folder("missing.json"), in_folder("none.svg")),
        1);
    ck_assert_ptr_nonnull(strstr(message, "missing.json: error: cannot read: No such file"));
}
END_TEST

START_TEST(test_without_graphviz)
{
    ck_assert_int_eq(run("PATH=/nowhere", "draw bf -o %s", in_folder("none.svg")), 1);
    ck_assert_ptr_nonnull(strstr(message, "package graphviz"));
    ck_assert_int_eq(access(in_folder("none.svg"), F_OK), -1);
    ck_assert_int_eq(run("", "draw bf"), 2);
    ck_assert_ptr_nonnull(strstr(message, "-o FILE.svg"));
    ck_assert_int_eq(run("", "draw -o %s", in_folder("none.svg")), 2);
    ck_assert_ptr_nonnull(strstr(message, "no oracle is given"));
    ck_assert_int_eq(run("", "draw bg -o %s", in_folder("none.svg")), 1);
    ck_assert_ptr_nonnull(strstr(message, "no such oracle"));
}
END_TEST

int main(void)
{
    if (folder_make("draw") < 0)
        return EXIT_FAILURE;
    Suite *suite = suite_create("draw");
    TCase *c = tcase_create("draw");
    tcase_set_timeout(c, 300);
    tcase_add_loop_test(c, test_sums, 0, 2);
    tcase_add_test(c, test_paths);
    tcase_add_test(c, test_threads);
    tcase_add_test(c, test_csv);
    tcase_add_loop_test(c, test_drawing, 0, 2);
    tcase_add_test(c, test_damaged);
    tcase_add_test(c, test_without_graphviz);
    suite_add_tcase(suite, c);
    int failed = suite_failures(suite);
    folder_remove();
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
